"""Rotors: norm, action, composition, conversions and their sense, powers; over batches."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import polhode as ph
from naive import GRADE_SETS, magnitude, ph_value
from polhode import e1, e2, e3
from samples import EPS, PAIRS_OF_SHAPES, SHAPES, close, e12, random_rotors, rotors, same

# --- rotors


def random_values(grades, shape, seed=2):
    return ph_value(np.random.default_rng(seed).standard_normal((*shape, 8)), grades)


@pytest.mark.parametrize("shape", SHAPES)
def test_rotors_are_unit(shape):
    for R in (
        random_rotors(shape),
        ph.Rotor.identity(shape),
        ph.Rotor.from_rotation_vector(np.random.default_rng(3).standard_normal((*shape, 3))),
        ph.Rotor.from_components(1e200 * np.random.default_rng(4).standard_normal((*shape, 4))),
        random_rotors(shape) * random_rotors(shape, 5),
    ):
        assert R.shape == shape
        assert isinstance(R, ph.Rotor)
        assert R.grades == (0, 2)
        assert np.all(abs(magnitude(R) - 1) <= 6 * EPS)
        assert close(R * ~R, 1, 8)
        assert same(R.inverse(), ~R)


def test_a_long_product_of_rotors_drifts_by_its_roundings():
    R, step, count = (
        ph.Rotor.identity(),
        ph.Rotor.from_plane_angle(ph.bivector([1.0, 2.0, -2.0]), 0.1),
        10_000,
    )
    for _ in range(count):
        R = R * step
    # Each product of unit rotors sums four terms, and the step's own norm is off by at most 2 eps: 4 eps.
    assert abs(magnitude(R) - 1) <= 4 * count * EPS
    exact = ph.Rotor.from_plane_angle(ph.bivector([1.0, 2.0, -2.0]), 0.1 * count)
    assert close(R, exact, 4 * count)
    # Its action is still that of a unit rotor.
    assert abs(magnitude(R(e1)) - 1) <= 16 * EPS


@pytest.mark.parametrize(("left", "right"), PAIRS_OF_SHAPES)
@pytest.mark.parametrize("grades", GRADE_SETS)
def test_rotor_acts_on_any_grade_as_R_X_reverse_R(grades, left, right):
    R, X = random_rotors(left), random_values(grades, right)
    turned = R(X)
    assert turned.grades == X.grades
    assert turned.shape == np.broadcast_shapes(left, right)
    # Two products of four terms a component either way: 16 roundings each.
    assert close(turned, R * X * ~R, 32, magnitude(X).max(initial=0))
    assert same(R.apply(X), turned)


@pytest.mark.parametrize(("left", "right"), PAIRS_OF_SHAPES)
def test_composition_applies_the_right_rotor_first(left, right):
    S, R, X = random_rotors(left), random_rotors(right, 6), random_values((0, 1, 2, 3), ())
    SR = S * R
    assert isinstance(SR, ph.Rotor)
    assert SR.shape == np.broadcast_shapes(left, right)
    assert close(SR(X), S(R(X)), 64, magnitude(X))


@pytest.mark.parametrize("shape", SHAPES)
def test_matrices_are_a_homomorphism(shape):
    S, R, x = random_rotors(shape), random_rotors(shape, 7), random_values((1,), shape)
    assert S.to_matrix().shape == (*shape, 3, 3)
    product = S.to_matrix() @ R.to_matrix()
    assert np.all(abs((S * R).to_matrix() - product) <= 32 * EPS)
    turned = np.einsum("...ij,...j->...i", R.to_matrix(), x.components)
    assert np.all(abs(R(x).components - turned) <= 32 * EPS * magnitude(x)[..., None])
    assert np.all(abs((~R).to_matrix() - R.to_matrix().swapaxes(-1, -2)) <= 8 * EPS)


@pytest.mark.parametrize("shape", SHAPES)
def test_conversions_return_to_the_rotor(shape):
    R = random_rotors(shape, 8)
    positive = ph.Rotor.from_components(R.components * np.sign(R.components[..., :1]))
    for back in (
        ph.Rotor.from_quaternion(R.to_quaternion(order="wxyz"), order="wxyz"),
        ph.Rotor.from_quaternion(R.to_quaternion(order="xyzw"), order="xyzw"),
        ph.Rotor.from_components(R.components),
        ph.Rotor.from_plane_angle(*R.plane_angle()),
        R.log().exp(),
    ):
        assert back.shape == shape
        assert close(back, R, 16)
    for back in (
        ph.Rotor.from_matrix(R.to_matrix()),
        ph.Rotor.from_rotation_vector(R.to_rotation_vector()),
    ):
        assert back.shape == shape
        assert close(back, positive, 32)


@pytest.mark.parametrize("shape", SHAPES)
def test_scipy_agrees(shape):
    R, x = random_rotors(shape, 9), random_values((1,), (), 10)
    flat = ph.Rotor.from_components(R.components.reshape(-1, 4))
    scipys = flat.to_scipy()
    assert np.all(abs(scipys.as_matrix() - flat.to_matrix()) <= 16 * EPS)
    turned = scipys.apply(np.array(x.components))  # SciPy rejects read-only arrays
    assert np.all(abs(turned - flat(x).components) <= 32 * EPS * magnitude(x))
    assert np.all(abs(scipys.as_rotvec() - flat.to_rotation_vector()) <= 32 * EPS * np.pi)
    assert close(ph.Rotor.from_scipy(scipys), flat, 4)
    first, second = flat[0], ph.Rotor.random((), 11)
    composed = (second.to_scipy() * first.to_scipy()).as_matrix()
    assert np.all(abs((second * first).to_matrix() - composed) <= 32 * EPS)


# A quarter turn about z takes x to y: checks the sense, which a round trip does not.
QUARTER = np.sqrt(0.5)
QUARTER_TURNS = {
    "plane and angle": lambda: ph.Rotor.from_plane_angle(e12, np.pi / 2),
    "exp": lambda: (-np.pi / 4 * e12).exp(),
    "wxyz": lambda: ph.Rotor.from_quaternion([QUARTER, 0, 0, QUARTER], order="wxyz"),
    "xyzw": lambda: ph.Rotor.from_quaternion([0, 0, QUARTER, QUARTER], order="xyzw"),
    "components": lambda: ph.Rotor.from_components([QUARTER, 0, 0, -QUARTER]),
    "matrix": lambda: ph.Rotor.from_matrix([[0, -1, 0], [1, 0, 0], [0, 0, 1]]),
    "vectors": lambda: ph.Rotor.from_vectors(3 * e1, 0.1 * e2),
    "rotation vector": lambda: ph.Rotor.from_rotation_vector([0, 0, np.pi / 2]),
    "rotation vector as a vector": lambda: ph.Rotor.from_rotation_vector(np.pi / 2 * e3),
    "scipy": lambda: ph.Rotor.from_scipy(Rotation.from_euler("z", 90, degrees=True)),
    "half of a half turn": lambda: ph.Rotor.from_plane_angle(e12, np.pi).sqrt(),
    "power": lambda: ph.Rotor.from_plane_angle(e12, np.pi / 6) ** 3,
}


@pytest.mark.parametrize("name", QUARTER_TURNS)
def test_a_quarter_turn_about_z_takes_x_to_y(name):
    R = QUARTER_TURNS[name]()
    assert close(R(e1), e2, 8)
    assert close(R(e2), -e1, 8)
    assert close(R(e3), e3, 8)
    assert np.all(abs(R.to_matrix() - [[0, -1, 0], [1, 0, 0], [0, 0, 1]]) <= 8 * EPS)
    assert np.all(abs(R.to_rotation_vector() - [0, 0, np.pi / 2]) <= 8 * EPS)
    assert np.all(abs(R.to_quaternion(order="wxyz") - [QUARTER, 0, 0, QUARTER]) <= 8 * EPS)
    assert np.all(abs(R.to_quaternion(order="xyzw") - [0, 0, QUARTER, QUARTER]) <= 8 * EPS)
    assert np.all(abs(R.to_scipy().apply([1, 0, 0]) - [0, 1, 0]) <= 8 * EPS)
    plane, angle = R.plane_angle()
    assert close(plane, e12, 8)
    assert abs(angle - np.pi / 2) <= 8 * EPS


def test_turns_about_the_other_axes_and_their_order():
    about_x = ph.Rotor.from_quaternion([QUARTER, QUARTER, 0, 0], order="wxyz")
    about_y = ph.Rotor.from_quaternion([QUARTER, 0, QUARTER, 0], order="wxyz")
    assert close(about_x(e2), e3, 8)
    assert close(about_y(e3), e1, 8)
    # First about x, then about y: e2 -> e3 -> e1.
    assert close((about_y * about_x)(e2), e1, 16)
    assert close((about_x * about_y)(e2), e3, 16)


@pytest.mark.parametrize("order", ["wzyx", "WXYZ", "", None, 4, ("w", "x", "y", "z"), "hamilton"])
def test_invalid_quaternion_orders_raise(order):
    with pytest.raises(ValueError, match="order must be"):
        ph.Rotor.from_quaternion([1, 0, 0, 0], order=order)
    with pytest.raises(ValueError, match="order must be"):
        ph.Rotor.identity().to_quaternion(order=order)


def test_the_quaternion_order_is_required():
    with pytest.raises(TypeError, match="order"):
        ph.Rotor.from_quaternion([1, 0, 0, 0])
    with pytest.raises(TypeError, match="order"):
        ph.Rotor.identity().to_quaternion()


# --- powers and kinds


@given(rotors, st.floats(-3, 3), st.floats(-3, 3))
def test_powers_of_rotors(R, s, t):
    # A power is exp of a multiple of log R, at most 6π: its rounding moves the rotor by 6π · 4 eps.
    assert close(R**s * R**t, R ** (s + t), 128)
    assert isinstance(R**s, ph.Rotor)


@given(rotors)
def test_special_powers_of_rotors(R):
    assert same(R**0, 1)
    assert close(R**1, R, 16)
    assert close(R**-1, ~R, 16)
    assert close(R**2, R * R, 32)
    assert close(R.sqrt() * R.sqrt(), R, 32)
    assert close(R**0.5, R.sqrt(), 4)


def test_powers_over_batches():
    R = random_rotors((3, 1, 2), 15)
    assert (R ** np.linspace(0, 1, 4)[:, None]).shape == (3, 4, 2)
    assert (random_rotors((), 16) ** np.arange(5)).shape == (5,)
    one = ph.Rotor.identity((3,))
    assert same(one**2, one)


def test_operations_that_return_rotors():
    R, S = random_rotors((), 17), random_rotors((), 18)
    for value in (R * S, ~R, -R, R.inverse(), R**2, R.sqrt(), R.normalized(), R.grade_involution(), R / S):
        assert isinstance(value, ph.Rotor)
    for value in (2 * R, R * 2, R + S, R - S, R / 2, R * e1, R.log(), R.dual(), R.grade(2), R.exp(), R(e1)):
        assert type(value) is ph.Multivector
    assert isinstance(R(S), ph.Rotor)


@pytest.mark.parametrize("points", [np.ones(3), np.ones((2, 3)), [1, 2, 3], 2.0], ids=repr)
@pytest.mark.parametrize("shape", [(), (2,)])
def test_rotors_reject_other_types(points, shape):
    # The numbers of an array of points would be scalars, which rotations do not change.
    remedy = r"acts on multivectors, got .*wrap arrays with ph\.vector: R\(ph\.vector\(x\)\)\.components$"
    for turn in (random_rotors(shape), random_rotors(shape).apply):
        with pytest.raises(TypeError, match=remedy):
            turn(points)


def test_random_rotors_are_uniform_and_repeatable():
    R = ph.Rotor.random((20_000,), 19)
    assert same(R, ph.Rotor.random(20_000, np.random.default_rng(19)))
    # Uniform on the sphere S³: components have mean 0, variance 1/4, and the mean of 20000 a deviation
    # of 0.5/√20000 = 0.0035; five of those.
    assert np.all(abs(R.components.mean(axis=0)) < 5 * 0.0035)
    covariance = R.components.T @ R.components / 20_000
    assert np.all(abs(covariance - np.eye(4) / 4) < 5 * 0.0035)
    # Rotated vectors cover the sphere: mean 0, variance 1/3 in each direction.
    assert np.all(abs(R(e1).components.mean(axis=0)) < 5 * 0.0041)


@pytest.mark.parametrize(
    "combine",
    [
        lambda R, S: R * S,
        lambda R, S: R(ph.vector(np.ones((*S.shape, 3)))),
        lambda R, S: R.distance(S),
        lambda R, S: ph.slerp(R, S, 0.5),
        lambda R, S: R ** np.ones(S.shape),
        lambda R, S: R / np.ones(S.shape),
        lambda R, S: R == S,
        lambda R, S: R.is_close(S),
        lambda R, S: (R * 2).exp(errors="mask") + S,
        lambda R, S: ph.RigidTransform(R) * ph.RigidTransform(S),
        lambda R, S: ph.RigidTransform(R) ** np.ones(S.shape),
        lambda R, S: ph.Rotor.from_axis_angle(np.ones((*R.shape, 3)), np.ones(S.shape)),
    ],
)
def test_batches_that_do_not_broadcast_are_named(combine):
    R = ph.Rotor.random(12, rng=1)
    with pytest.raises(ValueError, match=r"the batch shapes \(4,\) and \(3,\) do not broadcast"):
        combine(R[:4], R[:3])
