"""Calls, operators and values of other libraries: the errors name ours, and other types are not equal."""

import operator
import re

import numpy as np
import pytest
import sympy
from scipy.spatial import transform as scipys

import polhode as ph
from polhode import RigidTransform, Rotor, e1, e2, e3

V, PLANE, SPHERES = ph.vector(np.eye(3)), ph.pga(3), ph.cga(3)
BOX, START = ph.Body.box([1, 2, 3], mass=1), ph.State(Rotor.random(rng=1), [0, 0, 1], [1, 2, 3])
R, T, A = Rotor.random(rng=1), RigidTransform(Rotor.random(rng=2), [1, 2, 3]), ph.algebra(3)
TWO, PATH = RigidTransform.stack([T, T]), ph.RotorSpline([0, 1, 2], Rotor.random(3, rng=3))
TAKE_THREE = [ph.vector, ph.left_jacobian, Rotor.from_mrp, Rotor.from_rotation_vector, T.apply]
OPERATORS = [getattr(operator, name) for name in ("add", "sub", "mul", "truediv", "xor", "or_", "and_")]
TURN, MOVE = scipys.Rotation.identity(), scipys.RigidTransform.identity()


@pytest.mark.parametrize(
    ("call", "ours"),
    [
        (lambda: ph.vector(1, 2, 3), "ph.vector([1, 2, 3])"),
        (lambda: ph.multivector(e12=3), '3 * ph.algebra(3).blades["e12"]'),
        (lambda: A.vector(e1=1, e3=2), '1 * A.blades["e1"] + 2 * A.blades["e3"]'),
        (lambda: PLANE.point(1, 2, 3), "A.point([1, 2, 3])"),
        (lambda: SPHERES.up(1.5, 2), "A.up([1.5, 2])"),
        (lambda: ph.bivector([1, 2, 3], dtyp=float), "dtype="),
        (lambda: R.magnitude(degrees=True), "np.degrees(R.angle)"),
        (lambda: V.mean(weights=[1, 2, 3]), "ph.mean(R, weights) for rotors"),
        (lambda: PATH(0.5, 1), "spline.omega_body(t) for order 1"),
        (lambda: PATH(0.5, order=2), "spline.alpha_body(t) for order 2"),
        (lambda: ph.align(V, V, return_sensitivity=True), "ph.align(a, b).covariance"),
        (lambda: ph.mean(R, weight=[1]), "weights="),
        (lambda: A.random(seed=1), "rng="),
        (lambda: ph.stack([e1, e2], dim=0), "its arguments are (values, axis=0)"),
        (lambda: ph.attitude_from_rates(t=[0, 1], omega_body=V), "times="),
        (lambda: RigidTransform(rotation=R), "rotor="),
        (lambda: ph.algebra(signature=[1, 1, 1]), "write ph.algebra(p, q, r), with the numbers of"),
        (lambda: ph.algebra([1, 1, 1]), "got [1, 1, 1]; write ph.algebra(p, q, r)"),
        (lambda: A.vector("x"), "sympy.symbols"),
        (lambda: Rotor.from_axis_angle(e3, theta=1), "write angle="),
        (lambda: Rotor.from_plane_angle(e1 ^ e2, angle=1), "write theta="),
        (lambda: Rotor.from_euler("ZYX", 0.1, 0.2, 0.3), "pass numbers as one list, [0.1, 0.2, 0.3]"),
        (lambda: RigidTransform(R, 1, 2, 3), "pass numbers as one list, [1, 2, 3]"),
        (lambda: RigidTransform([1, 2, 3], R), "write RigidTransform(R, x)"),
        (lambda: R.to_quaternion("xyzw"), "takes 0 positional arguments but 1 was given; its"),
        (lambda: np.where(True, e1, e2), "A.algebra.multivector(np.where("),
        (lambda: R.to_euler(degrees=True), "its arguments are (seq, degrees=False)"),
        (lambda: ph.omega_from_periods([1, 2, 3], 4, 5), "with mode='long' or 'short'"),
        (lambda: e1(), "V(X) moves the multivector X"),
        (lambda: Rotor.exp(e1), "Rotor.from_rotation_vector(v)"),
        (lambda: Rotor.exp([0, 0, 1]), "Rotor.from_rotation_vector(v)"),
        (lambda: T >> e1, "T.apply(x)"),
        (lambda: ph.RotorSpline([0, 1], [T, T]), "RotorSpline(times, T.rotor)"),
        (lambda: ph.stack([START, START]), "stack([x.rotor for x in states])"),
        *((lambda f=f: f([1, 2, 3], e1), "ph.vector(x)") for f in OPERATORS),
        *((lambda f=f: f(V, (1, 2, 3)), "ph.vector(x)") for f in OPERATORS),
        (lambda: e1.dot([1, 2, 3]), "ph.vector(x)"),
        (lambda: e1 << e2, "A.left_contraction(B)"),
        (lambda: Rotor.from_rotation_vector(e1 ^ e2), "B.dual()"),
        (lambda: Rotor.from_plane_angle(e3, 1), "a.undual()"),
        (lambda: RigidTransform(np.eye(3), [1, 2, 3]), "Rotor.from_matrix(M)"),
        (lambda: RigidTransform.from_rotation(np.eye(3)), "Rotor.from_matrix(M)"),
        (lambda: RigidTransform.from_components(R, [1, 2, 3]), "RigidTransform(R, x)"),
        (lambda: RigidTransform.from_components([1, 2, 3], np.eye(3)), "Rotor.from_matrix(M)"),
        (lambda: Rotor.from_matrix(np.eye(3), assume_valid=True), "write nearest="),
        *((lambda x=x: BOX.inertia @ x, "write F(X)") for x in (np.ones(3), [1, 2, 3], e1 ^ e2)),
        *((lambda x=x: x * BOX.inertia, "write F(X)") for x in ([1, 2, 3], e1 ^ e2)),
        (lambda: np.eye(3) @ BOX.inertia, "F.matrix @ x"),
        (lambda: ph.FreeMotion(np.eye(3), R, [0, 0, 1]), "Inertia.from_matrix"),
        (lambda: ph.simulate(np.eye(3), START, [1]), "got an array of float64; for principal moments"),
        (lambda: SPHERES.rotor(e1 ^ e2, 0.3), "A.rotor(ph.Rotor.from_plane_angle(B, angle))"),
        (lambda: SPHERES.circle([0, 0, 0], e1 ^ e2, 1), "write B.dual()"),
        (lambda: T.apply(e1 ^ e2), "write B.dual()"),
        (lambda: R @ R, "A * B"),
        (lambda: np.eye(3) @ R, "ph.vector(M @ a.components)"),
        (lambda: np.cross(e1, e2), "ph.cross(a, b)"),
        (lambda: np.isnan(e1), "A.is_finite()"),
        (lambda: list(e1), ".components"),
        (lambda: V.__setitem__(0, e1), "immutable; change an array, c = A.components"),
        (lambda: TWO.__setitem__(0, T), "immutable; join parts with RigidTransform.concatenate"),
        (lambda: R * TURN, "Rotor.from_scipy(x)"),
        (lambda: TURN * R, "Rotor.from_scipy(x)"),
        (lambda: ph.mean([TURN, TURN]), "Rotor.from_scipy(x)"),
        (lambda: R.distance(T), "T.rotor"),
        (lambda: ph.mean(TWO), "T.mean()"),
        (lambda: ph.slerp(T, T, 0.5), "S.interpolate(T, t)"),
        (lambda: ph.stack([T, T]), "RigidTransform.stack([S, T])"),
        (lambda: ph.stack(TWO), "RigidTransform.stack([S, T])"),
        (lambda: ph.concatenate([TWO, TWO]), "RigidTransform.concatenate([S, T])"),
        (lambda: T @ T, "S * T"),
        (lambda: T * R, "S * RigidTransform.from_rotation(R)"),
        (lambda: R * T, "RigidTransform.from_rotation(R) * T"),
        (lambda: np.eye(4) @ T, "RigidTransform.from_matrix(M) * T"),
        (lambda: T * MOVE, "RigidTransform.from_scipy(x)"),
        (lambda: MOVE * T, "RigidTransform.from_scipy(x)"),
        *((lambda x=x: T * x, "T.apply(x)") for x in (e1, [1, 2, 3], np.ones(3))),
        (lambda: np.ones(3) * T, "T.apply(x)"),
        (lambda: T.is_close(np.eye(4)), "RigidTransform.from_matrix(M)"),
        (lambda: T.interpolate(R, 0.5), "RigidTransform.from_rotation(R)"),
        (lambda: RigidTransform.concatenate([T, np.eye(4)]), "RigidTransform.from_matrix(M)"),
        (lambda: RigidTransform.stack([T, R]), "RigidTransform.from_rotation(R)"),
        (lambda: RigidTransform(np.eye(4)), "RigidTransform.from_matrix"),
        (lambda: T["x"], "T.translation[name]"),
        (lambda: list(T), ".as_components()"),
        (lambda: dict(zip(("layout", "blades"), A, strict=True)), "write A.blades for its basis"),
        (lambda: Rotor.random(rng="a"), "rng must be a NumPy generator, a whole number or None"),
    ],
)
def test_calls_and_operators_of_other_libraries_name_ours(call, ours):
    with pytest.raises(TypeError, match=re.escape(ours)):
        call()


@pytest.mark.parametrize(
    ("call", "ours"),
    [
        (lambda: ph.align([1, 0, 0], [0, 1, 0]), "Rotor.from_vectors(a, b)"),
        (lambda: Rotor.from_matrix(2 * np.eye(3)), "nearest=True"),
        (lambda: RigidTransform.from_matrix(np.diag([2, 2, 2, 1])), "nearest=True"),
        (lambda: Rotor.from_euler("sxyz", [1, 2, 3]), "write 'xyz'"),
        (lambda: Rotor.from_euler([1, 2, 3], "zyx"), "it is text, such as 'ZYX', before the angles"),
        (lambda: R.to_euler("rzyx"), "write 'ZYX'"),
        (lambda: T[0], ".rotor and .translation"),
        *((lambda f=f: f(np.ones((3, 1))), "got shape (3, 1); write np.ravel(x)") for f in TAKE_THREE),
        *((lambda f=f: f(np.ones((3, 5))), "got shape (3, 5); write x.T for columns x") for f in TAKE_THREE),
        (lambda: ph.vector(sympy.Matrix([1, sympy.Symbol("x"), 3])), "write np.ravel(x) for a column x"),
        (lambda: V[0, 1], "too many indices for the batch axes: 2 (batch shape (3,))"),
        (lambda: Rotor.from_matrix(np.eye(4)), "RigidTransform.from_matrix(M)"),
        (lambda: RigidTransform.from_matrix(np.eye(3)), "RigidTransform(Rotor.from_matrix(M), x)"),
        (lambda: R.reduce(TURN), "Rotor.from_scipy(x)"),
        (lambda: Rotor.from_axis_angle(0.3, [0, 0, 1]), "write Rotor.from_axis_angle([0, 0, 1], 0.3)"),
        (lambda: ph.mean(Rotor.random(0)), "got a batch of shape (0,)"),
        (lambda: ph.mean(np.eye(4)), "see Rotor.from_quaternion"),
        (lambda: Rotor.random(-1), "must be >= 0, got -1"),
        (lambda: (e1 ^ e2).to_matrix(), "Rotor.from_multivector(A).to_matrix"),
        (lambda: T.to_motor().apply(e1), "RigidTransform.from_motor(A)"),
        (lambda: A.blades.e12, 'blades["e12"]'),
    ],
)
def test_values_of_other_libraries_name_ours(call, ours):
    with pytest.raises((ValueError, IndexError, AttributeError), match=re.escape(ours)):
        call()


def test_lists_are_not_equal_to_values():
    assert e1 != [1, 0, 0]
    assert e1 in [[1, 0, 0], e1]


def test_types_of_users_shift_values():
    class Shifted:
        def __rlshift__(self, left):
            return "<<"

    assert e1 << Shifted() == "<<"


def test_a_transform_joins_to_itself():
    assert (RigidTransform.concatenate(TWO) == TWO).all()
    assert RigidTransform.concatenate(T) == T


def test_values_of_other_types_are_not_equal():
    one, other = Rotor.identity(), scipys.Rotation.identity()
    assert one != other
    assert one in [other, one]
    assert RigidTransform() != other


class Reflected:
    """A type that defines operators with values at its left."""

    def __rmul__(self, other):
        return "*"

    def __rmatmul__(self, other):
        return "@"


@pytest.mark.parametrize("value", [RigidTransform(), e1, Rotor.identity()])
def test_operators_of_other_types_are_asked(value):
    assert (value * Reflected(), value @ Reflected()) == ("*", "@")


def test_parts_of_a_single_transform_are_indexed_as_rotors_are():
    one = RigidTransform()
    assert (one[None].shape, one[...].shape, one[()].shape) == ((1,), (), ())


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ph.vector([1, 2, 3], "float32"), "its arguments are (xyz, *, dtype"),
        (lambda: ph.vector(*np.ones((3, 5))), "ph.vector(np.stack([x, y, …], axis=-1))"),
        (lambda: ph.multivector(e1=2, s=3), "no argument 'e1'"),
    ],
)
def test_components_are_not_guessed(call, message):
    with pytest.raises(TypeError, match=re.escape(message)):
        call()
