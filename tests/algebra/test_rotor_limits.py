"""Limits of rotors: turns near 0, π and 2π, extreme norms, invalid arguments."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import polhode as ph
from naive import magnitude
from polhode import e1, e2, e3
from samples import EPS, PAIRS_OF_SHAPES, angles, close, directions, e12, random_rotors, unit


@given(directions, angles)
@example(np.array([0.0, 0.0, 1.0]), 2 * np.pi)
@example(np.array([1.0, 0.0, 0.0]), np.pi)
def test_plane_and_angle_over_the_double_cover(n, angle):
    R = ph.Rotor.from_plane_angle(ph.bivector(n), angle)
    # Sine, cosine and three products: the half-angle's rounding is eps/2 · |θ|/2.
    assert close(R, np.cos(angle / 2) - np.sin(angle / 2) * ph.bivector(n), 4)
    plane, theta = R.plane_angle()
    assert 0 <= theta <= 2 * np.pi
    assert abs(magnitude(plane) - 1) <= 4 * EPS
    assert close(ph.Rotor.from_plane_angle(plane, theta), R, 8)
    if 1e-15 < angle < 2 * np.pi - 1e-14:
        # The plane is scaled by sin(θ/2): rounding relative to it.
        assert abs(theta - angle) <= 8 * EPS
        assert close(plane, ph.bivector(n), 16)


@given(directions, angles)
def test_log_over_the_double_cover(n, angle):
    R = ph.Rotor.from_plane_angle(ph.bivector(n), angle)
    B = R.log()
    assert B.grades == (2,)
    assert magnitude(B) <= np.pi * (1 + 2 * EPS)
    assert close(B.exp(), R, 16)
    if abs(angle) < 2 * np.pi - 1e-12:
        assert close(B, -angle / 2 * ph.bivector(n), 16, np.pi)


def test_log_of_one_and_minus_one():
    one = ph.Rotor.identity()
    assert one.log() == 0
    assert (-one).log() == np.pi * e12
    assert close((-one).log().exp(), -one, 4)
    plane, angle = one.plane_angle()
    assert plane == e12
    assert angle == 0
    plane, angle = (-one).plane_angle()
    assert plane == e12
    assert angle == 2 * np.pi
    assert isinstance(-one, ph.Rotor)


@pytest.mark.parametrize("exponent", [*range(-320, -1, 20), -8, -4, -2])
def test_tiny_turns_keep_their_relative_accuracy(exponent):
    v = 10.0**exponent * np.array([0.6, 0.0, -0.8])
    R = ph.Rotor.from_rotation_vector(v)
    # Halving a subnormal rounds it to the spacing 5e-324.
    allowed = 8 * EPS * np.abs(v) + 4 * 5e-324
    assert np.all(abs(R.to_rotation_vector() - v) <= allowed)
    assert np.all(abs(R.log().components + v / 2) <= allowed)


@given(directions, st.floats(0, 2 * np.pi))
def test_rotation_vectors(n, angle):
    R = ph.Rotor.from_rotation_vector(angle * n)
    assert close(R, ph.Rotor.from_plane_angle(ph.bivector(n), angle), 16)
    back = R.to_rotation_vector()
    assert np.linalg.norm(back) <= np.pi * (1 + 2 * EPS)
    # The shorter way round: the angle, or 2π less about the same axis.
    shorter = angle if angle <= np.pi else angle - 2 * np.pi
    either = [
        np.linalg.norm(back - s * shorter * n) for s in ((1, -1) if abs(angle - np.pi) < 1e-14 else (1,))
    ]
    assert min(either) <= 32 * EPS * np.pi


@given(directions, angles)
def test_from_matrix_near_half_turns(n, angle):
    R = ph.Rotor.from_plane_angle(ph.bivector(n), angle)
    back = ph.Rotor.from_matrix(R.to_matrix())
    assert back.components[0] >= 0
    assert min(magnitude(back - R), magnitude(back + R)) <= 16 * EPS
    assert np.all(abs(back.to_matrix() - R.to_matrix()) <= 32 * EPS)


@pytest.mark.parametrize("diagonal", [(1, -1, -1), (-1, 1, -1), (-1, -1, 1), (1, 1, 1)])
def test_from_matrix_of_exact_half_turns(diagonal):
    R = ph.Rotor.from_matrix(np.diag(diagonal))
    assert np.array_equal(R.to_matrix(), np.diag(diagonal))


@pytest.mark.parametrize("axis", range(3))
def test_matrices_of_quarter_turns_have_exact_zeros(axis):
    """On the diagonal, equal squares of the rotor's components are subtracted."""
    components = np.zeros(4)
    components[[0, axis + 1]] = np.sqrt(0.5)
    matrix = ph.Rotor.from_components(components).to_matrix()
    assert np.array_equal(np.round(matrix) == 0, matrix == 0)


def test_from_matrix_takes_the_nearest_rotation():
    R, noise = random_rotors((20,), 12), np.random.default_rng(13).uniform(-1, 1, (20, 3, 3))
    m = R.to_matrix() + 1e-5 * noise
    u, _, vt = np.linalg.svd(m)  # the orthogonal polar factor
    assert np.all(abs(ph.Rotor.from_matrix(m).to_matrix() - u @ vt) <= 32 * EPS)


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        (-np.eye(3), "determinant −1"),
        (np.diag([1.0, 1.0, -1.0]), "determinant −1"),
        (1.001 * np.eye(3), "not a rotation matrix"),
        (np.zeros((3, 3)), "not a rotation matrix"),
        (np.full((3, 3), np.nan), "NaN or infinite"),
        (np.full((3, 3), 1e200), "not a rotation matrix"),
    ],
)
def test_from_matrix_rejects_other_matrices(bad, message):
    with pytest.raises(ValueError, match=message):
        ph.Rotor.from_matrix(bad)
    batch = np.broadcast_to(np.eye(3), (2, 2, 3, 3)).copy()
    batch[1, 0] = bad
    with pytest.raises(ValueError, match=rf"at index \(1, 0\): .*{message}"):
        ph.Rotor.from_matrix(batch)


@pytest.mark.parametrize("shape", [(3,), (9,), (2, 2), (3, 4), (4, 3), ()])
def test_from_matrix_rejects_other_shapes(shape):
    with pytest.raises(ValueError, match=r"shape \(\.\.\., 3, 3\)"):
        ph.Rotor.from_matrix(np.ones(shape))


@given(directions, directions, st.floats(1e-3, 1e3))
def test_from_vectors(a, b, length):
    R = ph.Rotor.from_vectors(ph.vector(a), ph.vector(length * b))
    assert close(R(ph.vector(a)), ph.vector(b), 16)
    # The short way, in the plane of both: the normal stays.
    assert R.components[0] >= -4 * EPS
    normal = np.cross(a, b)
    if np.linalg.norm(normal) > 1e-3:
        assert close(R(ph.vector(normal)), ph.vector(normal), 32)


@given(directions, directions, st.integers(-17, -1))
def test_from_vectors_nearly_opposite(a, other, exponent):
    # b is close to −a.
    b = unit(-a + 10.0**exponent * other)
    R = ph.Rotor.from_vectors(ph.vector(a), ph.vector(b))
    assert abs(magnitude(R) - 1) <= 4 * EPS
    assert close(R(ph.vector(a)), ph.vector(b), 16)


@given(directions)
def test_from_vectors_exactly_opposite_and_equal(a):
    R = ph.Rotor.from_vectors(ph.vector(a), ph.vector(-a))
    assert close(R(ph.vector(a)), ph.vector(-a), 16)
    assert close(ph.Rotor.from_vectors(ph.vector(a), ph.vector(a)), 1, 4)


@pytest.mark.parametrize("scale", [5e-324, 1e-310, 1e-200, 1e200, 1e308])
def test_constructors_ignore_extreme_norms(scale):
    assert close(ph.Rotor.from_vectors(scale * e1, scale * e2), ph.Rotor.from_vectors(e1, e2), 4)
    assert close(
        ph.Rotor.from_plane_angle(ph.bivector([0, 0, scale]), 1.0), ph.Rotor.from_plane_angle(e12, 1.0), 4
    )
    assert close(ph.Rotor.from_components([scale, 0, 0, -scale]), (1 - e12) / np.sqrt(2), 4)
    assert close(ph.Rotor.from_quaternion([scale, 0, 0, scale], order="wxyz"), (1 - e12) / np.sqrt(2), 4)


@pytest.mark.parametrize("bad", [0.0, np.nan, np.inf])
def test_constructors_reject_zero_and_non_finite_values(bad):
    four, three = np.ones((2, 4)), np.ones((2, 3))
    four[1], three[1] = bad, bad
    ones = ph.vector(np.ones((2, 3)))
    for make in (
        lambda: ph.Rotor.from_components(four),
        lambda: ph.Rotor.from_quaternion(four, order="xyzw"),
        lambda: ph.Rotor.from_plane_angle(ph.bivector(three), 1.0),
        lambda: ph.Rotor.from_vectors(ph.vector(three), ones),
        lambda: ph.Rotor.from_vectors(ones, ph.vector(three)),
    ):
        with pytest.raises(ValueError, match=r"at index \(1,\): "):
            make()


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_angles_must_be_finite(bad):
    for make in (
        lambda: ph.Rotor.from_plane_angle(e12, np.array([1.0, bad])),
        lambda: ph.Rotor.from_rotation_vector([[1.0, 0, 0], [0, bad, 0]]),
    ):
        with pytest.raises(ValueError, match=r"at index \(1,\): a component is NaN or infinite"):
            make()


@pytest.mark.parametrize("make", [
    lambda: ph.Rotor.from_plane_angle(e3, 1.0),
    lambda: ph.Rotor.from_plane_angle(1 + e1 * e2, 1.0),
    lambda: ph.Rotor.from_plane_angle("xyz", 1.0),
    lambda: ph.Rotor.from_plane_angle([0, e1, 1], 1.0),
    lambda: ph.Rotor.from_plane_angle(e12, "1"),
    lambda: ph.Rotor.from_vectors(e12, e1),
    lambda: ph.Rotor.from_vectors(e1, [1, 0, "0"]),
    lambda: ph.Rotor.from_vectors(e1, [e1, e2, e3]),
    lambda: ph.Rotor.from_rotation_vector(e12),
    lambda: ph.Rotor.from_components([1j, 0, 0, 0]),
    lambda: ph.Rotor.from_matrix([["a"] * 3] * 3),
    lambda: ph.Rotor.identity()([1, 0, 0]) and None,
    lambda: ph.Rotor.identity()("x"),
    lambda: ph.Rotor.identity() ** "2",
])  # fmt: skip
def test_wrong_kinds_are_type_errors(make):
    with pytest.raises(TypeError):
        make()


def test_lists_and_arrays_are_vectors_and_planes():
    quarter = ph.Rotor.from_plane_angle(e12, np.pi / 2)
    assert ph.Rotor.from_plane_angle([0, 0, 1], np.pi / 2) == quarter
    assert ph.Rotor.from_vectors([1, 0, 0], [0, 1, 0]) == ph.Rotor.from_vectors(e1, e2)
    assert ph.Rotor.from_vectors(e1, np.eye(3)).shape == (3,)
    for make in (
        lambda x: ph.Rotor.from_plane_angle(x, 1.0),
        lambda x: ph.Rotor.from_vectors(e1, x),
        ph.Rotor.from_rotation_vector,
    ):
        for wrong in ([1, 0], 3.0, np.zeros((3, 2))):
            with pytest.raises(ValueError, match="needs 3 components in the last axis, got shape"):
                make(wrong)
    # Numbers are scalars in products, so a rotor does not act on them.
    with pytest.raises(TypeError, match=r"wrap arrays with ph\.vector"):
        quarter([1, 0, 0])


@pytest.mark.parametrize(("left", "right"), PAIRS_OF_SHAPES)
def test_constructors_broadcast(left, right):
    batch = np.broadcast_shapes(left, right)
    rng = np.random.default_rng(14)
    a, b, angle = rng.standard_normal((*left, 3)), rng.standard_normal((*right, 3)), rng.uniform(-6, 6, right)
    from_vectors = ph.Rotor.from_vectors(ph.vector(a), ph.vector(b))
    from_plane = ph.Rotor.from_plane_angle(ph.bivector(a), angle)
    assert from_vectors.shape == from_plane.shape == batch
    a_all, b_all = np.broadcast_to(a, (*batch, 3)), np.broadcast_to(b, (*batch, 3))
    angle_all = np.broadcast_to(angle, batch)
    for index in np.ndindex(*batch):
        one = ph.Rotor.from_vectors(ph.vector(a_all[index]), ph.vector(b_all[index]))
        assert from_vectors[index] == one
        assert from_plane[index] == ph.Rotor.from_plane_angle(ph.bivector(a_all[index]), angle_all[index])
