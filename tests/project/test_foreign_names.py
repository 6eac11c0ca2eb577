"""Names and calls of other libraries are errors, and what these tell to write works."""

import functools
import itertools
import math
import operator
import re
import rlcompleter

import numpy as np
import pytest
import quaternion
import sympy
from scipy.spatial import transform as scipys

import polhode as ph
from polhode import I, RigidTransform, Rotor, e1, e2, e3
from polhode._algebra import foreign_tables, ufuncs
from polhode._mechanics import foreign_tables as names_of_motions
from polhode._support import package_names

# --- what the tables tell to write

x = sympy.Symbol("x")
TURNS = Rotor.random(3, rng=6)
V, PLANE, SPHERES = ph.vector(np.eye(3)), ph.pga(3), ph.cga(3)
BASE = {
    "np": np,
    "ph": ph,
    "functools": functools,
    "math": math,
    "itertools": itertools,
    "operator": operator,
    "sympy": sympy,
    "Rotor": Rotor,
    "RigidTransform": RigidTransform,
    "a": V,
    "b": Rotor.random(rng=4)(V),
    "A": 1 + e1 + I,
    "B": e1 ^ e2,
    "R": Rotor.random(rng=1),
    "S": Rotor.random(rng=2),
    "T": RigidTransform(Rotor.random(rng=3), e1),
    "theta": 0.3,
    "t": 0.5,
    "seq": "zyx",
    "name": "C3",
    "M": np.eye(3),
    "angles": [0.1, 0.2, 0.3],
    "q": [1, 0, 0, 0],
    "v": [1, 2, 3],
    "w": [3, -1, 2],
    "z": np.exp(1j * np.array([0.1, 0.2, 0.3])),
    "shape": (),
    "eps": 0.1,
    "axes": np.eye(3),
    "order": "e",
    "rtol": 0.1,
    "atol": 0.1,
    "x": [1, 2, 3],
    "xi": np.ones(6),
    "k": 1,
    "c": np.array([True, False, True]),
    "phi": 0.4,
    "H": np.eye(4),
    "D": [1, 0, 0, 0, 0, 0, 0, 0],
    "P": SPHERES.up([1, 2, 3]),
    "times": [0, 1],
    "U": RigidTransform(Rotor.random(rng=5), e2),
    "omega": np.zeros((2, 3)),
}
OF_PLANES = {
    "A": PLANE,
    "P": PLANE.point([1, 2, 3]),
    "Q": PLANE.point([0, 0, 1]),
    "θ": 0.3,
    "t": [1, 2, 3],
    "L": PLANE.line([0, 0, 0], [1, 0, 0]),
    "X": PLANE.plane([1, 0, 0]),
    "Y": PLANE.plane([0, 1, 0]),
}
OF_SPHERES = {
    "A": SPHERES,
    "P": SPHERES.up([1, 0, 0]),
    "Q": SPHERES.up([0, 1, 0]),
    "t": [1, 2, 3],
    "X": SPHERES.up([1, 0, 0]),
    "Y": SPHERES.line([0, 0, 0], [1, 0, 0]),
}
TABLES = {
    "MULTIVECTOR": (BASE["A"], {"P": OF_PLANES["P"]}),
    "ROTOR": (BASE["R"], {}),
    "PARTS_OF_ROTORS": (BASE["R"], {}),
    "TRANSFORM": (BASE["T"], {"S": RigidTransform(), "shape": (1,)}),
    "SPLINE": (spline := ph.RotorSpline([0, 1], Rotor.random(2, rng=6)), {"spline": spline}),
    "ALGEBRA": (ph.algebra(3), {"A": ph.algebra(3), "components": np.ones(3), "X": e1, "Y": e2}),
    "PGA": (PLANE, OF_PLANES),
    "CGA": (SPHERES, OF_SPHERES),
}
# Expressions that need a value of another kind.
OTHERS = {
    "astype(float)": {"value": sympy.Integer(2) * e1},
    "continuous()": {"value": Rotor.random(3, rng=1)},
    "factor()": {"value": e1 ^ e2},
    "reshape(-1)": {"value": V},
    "functools.reduce(operator.mul, R)": {"R": Rotor.random(3, rng=1)},
    "functools.reduce(operator.mul, T)": {"T": RigidTransform(Rotor.random(3, rng=1), e1)},
    "reshape(shape)": {"shape": ()},
    "k_vector(3, components)": {"components": np.ones(1)},
    "map(sympy.expand)": {"value": x * e1},
    "map(lambda c: sympy.integrate(c, x))": {"value": x * e1, "x": x},
    "map(lambda c: sympy.collect(c, x))": {"value": x * e1, "x": x},
    "ph.align([ph.e3, ph.e2], [a, b], weights=[np.inf, 1]).rotor": {"a": e1, "b": e2},
    "ph.concatenate([R, S])": {"R": Rotor.random(2, rng=1), "S": Rotor.random(3, rng=2)},
    **{
        f"multivector(components){part}": {"components": np.ones(8)}
        for part in ("", ".grade(0, 2)", ".grade(1, 3)")
    },
}


def expressions(text):
    """The expressions of a remedy, without the words after them."""
    for part in re.split(r",? or (?=[\w(~\"]+)", text):
        yield re.split(r", (?:which|the|as|with)\b| for | of | itself", part)[0]


def evaluated(text, names):
    """The value of an expression, or of the attribute or call of a value that it is."""
    first = re.match(r"[~(-]*(\w+)", text)[1]
    return eval(text if first in {*names, "len", "dict", "not", "float"} else f"value.{text}", dict(names))


REMEDIES = [
    pytest.param(table, name, text, id=f"{table}-{name}-{text}")
    for table in TABLES
    for name, remedy in vars(foreign_tables)[table].items()
    if table == "ALGEBRA" or name not in foreign_tables.ALGEBRA
    for text in expressions(remedy)
]


@pytest.mark.parametrize(("table", "name", "text"), REMEDIES)
def test_the_error_of_a_name_tells_what_works(table, name, text):
    value, names = TABLES[table]
    with pytest.raises(AttributeError, match=f"has no attribute '{name}'; write .*{re.escape(text)}"):
        getattr(value, name)
    evaluated(text, BASE | {"value": value} | names | OTHERS.get(text, {}))


FUNCTIONS = [
    pytest.param(text, names, id=f"{name}-{text}")
    for table, names in (
        (package_names.WRITE, {}),
        (ufuncs._OURS, {"A": V, "B": V, "R": TURNS, "shape": (1, 3), "x": 0, "y": 1}),
    )
    for name, remedy in table.items()
    for text in expressions(remedy)
]


@pytest.mark.parametrize(("text", "names"), FUNCTIONS)
def test_the_error_of_a_function_tells_what_works(text, names):
    eval(text, BASE | names | OTHERS.get(text, {}))


@pytest.mark.parametrize("turned", [1, -1])
@pytest.mark.parametrize("kind", ["rotation", "rotor"])
@pytest.mark.parametrize("metric", ["chordal", "intrinsic"])
def test_distances_are_those_of_numpy_quaternion(kind, metric, turned):
    """A rotor and its opposite have a distance, but not their rotations."""
    name, pair = f"{kind}_{metric}_distance", {"R": BASE["R"], "S": BASE["S"] if turned > 0 else -BASE["S"]}
    theirs = getattr(quaternion, name)(*(R.to_numpy_quaternion() for R in pair.values()))
    assert eval(package_names.WRITE[name], BASE | pair) == pytest.approx(theirs, rel=1e-12)


def test_expressions_for_names_of_the_package_are_shown():
    for name, ours in package_names.WRITE.items():
        with pytest.raises(AttributeError, match=f"has no attribute '{name}'; write {re.escape(ours)}$"):
            getattr(ph, name)


@pytest.mark.parametrize("name", package_names.SEE)
def test_names_of_the_package_are_seen(name):
    for ours in re.split(", | and ", package_names.SEE[name]):
        assert callable(eval(f"ph.{ours}"))
    with pytest.raises(AttributeError, match=r"; see polhode\."):
        getattr(ph, name)
    with pytest.raises(ImportError, match=f"^cannot import name '{name}' from 'polhode'; see polhode"):
        exec(f"from polhode import {name}")
    assert not hasattr(ph, name)


@pytest.mark.parametrize("module", [ph.torque, ph.force, ph.event])
def test_the_error_of_a_law_tells_what_works(module):
    laws = {"kp": 1, "kd": 1, "d": 1, "h": [1, 0, 0], "k": 1, "mu": 1, "F": [1, 0, 0], "m": 1}
    laws |= {"area": 1, "offset": [1, 0, 0], "sun": [0, 0, 1]}
    laws |= {"times": [0, 1], "torques": np.zeros((2, 3))}
    for name, ours in module._FOREIGN.items():
        with pytest.raises(AttributeError, match=f"'{name}'; write ph.{re.escape(ours)}$"):
            getattr(module, name)
        for text in re.split(", or of (?:a centre|space) ", ours):
            eval(f"ph.{text}", BASE | laws)
    assert not hasattr(module, "nothing")


BOX, START = ph.Body.box([1, 2, 3], mass=1), ph.State(BASE["R"], [0, 0, 1], [1, 2, 3])
MOVING = {
    "STATE": START,
    "CLOSED_FORM": ph.FreeMotion(BOX.inertia, BASE["R"], [0, 0, 1]),
    "TRAJECTORY": ph.simulate(BOX, START, [0, 1]),
    "STEPPER": ph.Stepper(BOX, START),
    "HISTORY": ph.io.AttitudeHistory.of(ph.simulate(BOX, START, [0, 1])),
}


@pytest.mark.parametrize(
    ("table", "name"),
    [
        ("STATE", "q"),
        ("STATE", "R"),
        ("CLOSED_FORM", "rotor"),
        ("CLOSED_FORM", "omega"),
        ("CLOSED_FORM", "sol"),
        ("TRAJECTORY", "sol"),
        ("STEPPER", "qpos"),
        ("STEPPER", "qvel"),
        ("STEPPER", "wheel_speeds"),
        ("HISTORY", "omega"),
    ],
)
def test_the_error_of_a_motion_tells_what_works(table, name):
    ours = vars(names_of_motions)[table][name]
    with pytest.raises(AttributeError, match=f"'{name}'; write {re.escape(ours)}$"):
        getattr(MOVING[table], name)
    for text in re.split(r", and ", ours):
        eval(f"value.{text}", {"value": MOVING[table], "t": 0.5})


# --- calls and operators

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
        (lambda: ph.vector(sympy.Matrix([1, x, 3])), "write np.ravel(x) for a column x"),
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


def test_blades_are_found_by_any_name():
    blades = ph.cga().blades
    for name in ("e12", "e1∧e2", "e21", "einf"):
        assert name in blades
        assert blades.get(name) == blades[name]
    assert "e7" not in blades
    assert blades.get("e7", 3) == 3


def test_a_transform_joins_to_itself():
    assert (RigidTransform.concatenate(TWO) == TWO).all()
    assert RigidTransform.concatenate(T) == T


def test_names_are_completed_at_the_prompt():
    """The prompt of Python reads every attribute, and only ignores those that do not exist."""
    completer = rlcompleter.Completer({"A": ph.e1})
    assert completer.complete("A.compon", 0) == "A.components"
    assert completer.complete("A.", 0)
    assert not hasattr(ph.e1, "variable")


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
