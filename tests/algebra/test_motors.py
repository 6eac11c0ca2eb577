"""Motors of Cl(3,0,1): screws, powers, interpolation, normalization, adjoint matrices, actions on batches."""

import math

import mpmath
import numpy as np
import pytest

import polhode as ph
from polhode import RigidTransform, Rotor, e3
from polhode._algebra.motors import columns, of_columns

EPS = np.finfo(float).eps
A = ph.algebra(3, 0, 1)
N = A.basis_vectors[3]


def point(x):
    """The point x: the intersection of the planes e_k = x_k."""
    x = np.asarray(x, float)
    a, b, c = A.basis_vectors[:3]
    return (a * b * c - x[..., 0] * (b * c * N) - x[..., 1] * (c * a * N) - x[..., 2] * (a * b * N)).grade(3)


def transforms(shape, seed=1, size=1.0):
    rng = np.random.default_rng(seed)
    return RigidTransform(Rotor.random(shape, rng=rng), size * rng.standard_normal((*shape, 3)))


def near(left, right, count=32, size=1.0):
    difference = np.abs((left - right).dense()).max()
    return bool(difference <= count * EPS * size)


# --- actions


def test_points_directions_and_planes_move_as_the_transform_says():
    """Active, from the left: ``M X ~M`` is the moved point, as a rotor acts."""
    T = transforms(())
    M, x, u = T.to_motor(), np.array([1.0, -2.0, 0.5]), np.array([0.0, 0.6, 0.8])
    assert near(M(point(x)), point(T.apply(x)), 32, 8)
    assert near(M * point(x) * ~M, point(T.apply(x)), 32, 8)
    direction = point(u) - point(np.zeros(3))  # an ideal point: it turns, but does not move
    turned = T.rotor(ph.vector(u)).components
    assert near(M(direction), point(turned) - point(np.zeros(3)))
    shift = RigidTransform(translation=[1, 2, 3]).to_motor()
    assert shift(direction) == direction
    assert shift(point([0, 0, 0])) == point([1, 2, 3])
    plane = A.vector([*u, -1.0])  # u·x = 1, one unit from the origin on the side to which u points
    assert near(shift(plane), A.vector([*u, -1.0 - u @ [1, 2, 3]]), 8)
    first, second = transforms((2,), seed=2)
    both = second.to_motor() * first.to_motor()  # the right one first
    assert near(both(point(x)), point(second.apply(first.apply(x))), 64, 8)


@pytest.mark.parametrize(
    ("motors", "points", "result"),
    [((), (7,), (7,)), ((5,), (), (5,)), ((5, 1), (7,), (5, 7)), ((3, 1, 2), (4, 1), (3, 4, 2))],
)
def test_batches_of_motors_act_on_batches_of_points(motors, points, result):
    T, x = transforms(motors), np.random.default_rng(3).standard_normal((*points, 3))
    moved = T.to_motor()(point(x))
    assert moved.shape == result
    assert moved.grades == (3,)
    expected = point(T.apply(x))
    assert np.all(np.abs((moved - expected).components) <= 64 * EPS)


def test_reflections_act_on_batches():
    mirrors = A.vector([[1.0, 0, 0, -1.0], [0, 1.0, 0, 0]])  # x = 1 and y = 0
    # A point is a trivector, whose sign a reflection changes: the same point.
    images = -mirrors(point([3.0, 2.0, 1.0]))
    assert near(images[0], point([-1.0, 2.0, 1.0]))
    assert near(images[1], point([3.0, -2.0, 1.0]))


# --- functions


def screw_bivector(coords):
    """−½ I3 ω + ½ v n of exponential coordinates."""
    w, v = np.split(-0.5 * np.asarray(coords, float), 2, axis=-1)
    return A.bivector(
        np.stack([w[..., 2], -w[..., 1], -v[..., 0], w[..., 0], -v[..., 1], -v[..., 2]], axis=-1)
    )


def screw_matrix(coords):
    """The matrix exponential of a twist, in 40 digits."""
    with mpmath.workdps(40):
        a, b, c, x, y, z = (mpmath.mpf(float(k)) for k in coords)
        found = mpmath.expm(mpmath.matrix([[0, -c, b, x], [c, 0, -a, y], [-b, a, 0, z], [0, 0, 0, 0]]))
        return np.array(found.tolist(), float)


# No turn, tiny and ordinary ones, turns near half a turn and beyond, pure translations.
TWISTS = np.array(
    [
        [0, 0, 0, 0, 0, 0],
        [0, 0, 0, 1, -2, 3],
        [1e-300, 0, 0, 1, 2, 3],
        [1e-9, -2e-9, 1e-9, 1, 2, 3],
        [0.3, -0.2, 0.1, 1, 2, 3],
        [0, 0, 3.14159265, 1, 2, 3],
        [2.0, 2.0, 2.0, 1, -1, 1e-3],
        [0, 0, 5.0, 0, 0, 1],
    ]
)


def test_the_convention_of_screws():
    for coords in TWISTS:
        M = screw_bivector(coords).exp()
        T = RigidTransform.from_motor(M)
        np.testing.assert_allclose(T.as_matrix(), screw_matrix(coords), rtol=0, atol=64 * EPS)


@pytest.mark.parametrize("t", [0, 0.25, 1.0, -0.5, 2.5, np.linspace(-1, 1, 8)])
def test_powers_are_parts_of_the_screw(t):
    M = screw_bivector(TWISTS).exp()
    expected = screw_bivector(TWISTS * np.reshape(t, (-1, 1))).exp()
    found = M**t
    assert found.shape == (8,)
    # The logarithm of a turn by 5, a rotor's angle of 2.5, magnifies the rounding of M some ten times.
    assert near(found, expected, 256, 4)


def test_powers_of_other_versors_and_whole_ones():
    M = transforms((4,)).to_motor()
    assert near(M**2, M * M)
    assert near((M**0.5) ** 2, M, 64)
    assert near(M**0.5, M.sqrt(), 64)
    assert near(M**-1.0, ~M, 64)
    B = ph.algebra(4, 1).bivector(0.1 * np.random.default_rng(4).standard_normal(10))
    assert near(B.exp() ** 0.3, (0.3 * B).exp(), 256)
    assert near((2.0 * M) ** 0.5, 2**0.5 * M**0.5, 64)
    even = 3.0 + 4.0 * (ph.e1 ^ ph.e2)
    assert (even**0.5).is_close(even.sqrt(), rtol=8 * EPS)
    with pytest.raises(TypeError, match=r"integer powers, and real ones if it is even; got 0\.5"):
        N**0.5
    with pytest.raises(TypeError, match="got 'x'"):
        M ** "x"


def test_slerp_is_a_screw():
    first, second = transforms((6,), seed=5), transforms((6,), seed=6)
    t = np.linspace(0, 1, 5)[:, None]
    path = ph.slerp(first.to_motor(), second.to_motor(), t)
    assert path.shape == (5, 6)
    expected = first.interpolate(second, t)
    found = RigidTransform.from_motor(path)
    np.testing.assert_allclose(found.as_matrix(), expected.as_matrix(), rtol=0, atol=256 * EPS)
    assert np.all(path[0] == first.to_motor())
    # The short way round for either sign.
    again = ph.slerp(-first.to_motor(), second.to_motor(), t)
    assert near(again, -path, 256)
    with pytest.raises(
        TypeError, match="slerp needs rotors, or motors and other even versors, got the grades"
    ):
        ph.slerp(first.to_motor(), N, 0.5)
    with pytest.raises(TypeError, match="got list"):
        ph.slerp([1, 2], N, 0.5)


# --- normalization


def test_motors_are_divided_by_a_dual_number():
    M = transforms((5,)).to_motor()
    assert near(M.normalized(), M, 16)
    J = A.I
    scaled = M * (3.0 + 0.7 * J)  # every even element is a motor times a dual number
    assert near(scaled.normalized(), M, 16)
    noisy = M + 1e-3 * A.multivector(np.random.default_rng(7).standard_normal((5, 16))).grade(0, 2, 4)
    unit = noisy.normalized()
    assert near(unit * ~unit, A.scalar(1.0), 16)
    assert np.all(np.abs((unit - M).dense()) < 0.02)
    # For noisy ones log and conversion do the same.
    assert near(unit.log().exp(), unit, 64)
    translation = 1 + 0.5 * (A.basis_vectors[0] ^ N)
    assert translation.normalized() == translation
    with pytest.raises(ValueError, match=r"at index \(1,\) has no direction"):
        ph.stack([1 + N * A.basis_vectors[0], 0 * J + N * A.basis_vectors[0]]).normalized()


def test_other_values_are_divided_by_their_norm():
    line = A.bivector([3.0, 0, 1.0, 0, 0, 4.0])
    assert line.normalized() == line / 3
    plane = A.vector([3.0, 4.0, 0.0, 7.0])
    assert plane.normalized().is_close(plane / 5, rtol=4 * EPS)


# --- screws


def test_screw_parameters_restore_the_transform():
    T = transforms((50,), seed=8)
    screw = T.screw_parameters()
    axis, origin = screw.axis.components, screw.point.components
    assert np.all((screw.angle >= 0) & (screw.angle <= np.pi))
    assert np.all(np.abs((axis * origin).sum(axis=-1)) <= 64 * EPS * (1 + np.abs(origin).max()))
    turn = Rotor.from_axis_angle(axis, screw.angle)
    # x ↦ p + R (x − p) + d u; the point is as far as the translation over the angle.
    moved = screw.point - turn(screw.point) + screw.axis * screw.distance
    size = 1 + np.abs(origin).max(axis=-1)
    assert np.all((moved - T.translation).norm() <= 64 * EPS * size)
    assert np.all(turn.distance(T.rotor) <= 16 * EPS)
    again = ph.screw_parameters(-T.to_motor())
    for x, y in zip(again, screw, strict=True):
        assert np.all(np.abs(np.asarray(x) - np.asarray(y)) <= 64 * EPS * size.max())
    np.testing.assert_array_equal(screw.moment.components, ph.cross(screw.point, screw.axis).components)
    np.testing.assert_array_equal(screw.pitch, screw.distance / screw.angle)


def test_the_screw_of_a_bolt():
    """A quarter turn about the vertical axis through (1, 0, 0), and 3 up."""
    to_axis = RigidTransform(translation=[1, 0, 0])
    bolt = RigidTransform(Rotor.from_axis_angle(e3, np.pi / 2), [0, 0, 3])
    axis, origin, angle, distance = (to_axis * bolt * to_axis.inv()).screw_parameters()
    assert axis.is_close(e3, atol=4 * EPS)
    assert origin.is_close(ph.e1, atol=8 * EPS)
    assert abs(angle - np.pi / 2) <= 4 * EPS
    assert abs(distance - 3) <= 8 * EPS


def test_translations_have_no_angle():
    screw = RigidTransform(translation=[0, 0, -2]).screw_parameters()
    assert screw.axis == -e3
    assert screw.point == 0
    assert (screw.angle, screw.distance) == (0, 2)
    assert screw.pitch == np.inf
    nothing = RigidTransform().screw_parameters()
    assert nothing.axis == e3
    assert (nothing.angle, nothing.distance) == (0, 0)
    assert np.isnan(nothing.pitch)


def test_adjoint_matrices_move_twists():
    T = transforms((4,), seed=9)
    coords = np.random.default_rng(10).standard_normal((4, 6))
    M = T.to_motor()
    found = (T.adjoint() @ coords[..., None])[..., 0]
    assert near(screw_bivector(found), M * screw_bivector(coords) * ~M, 64, 8)
    R, x0 = T.rotor.to_matrix(), T.translation.components
    hat = np.cross(np.eye(3), x0[..., None, :])  # rows e_k × x0, so that hat @ y is x0 × y
    expected = np.block([[R, np.zeros((4, 3, 3))], [hat @ R, R]])
    np.testing.assert_allclose(T.adjoint(), expected, rtol=0, atol=32 * EPS)
    # A homomorphism, and conjugation of transforms.
    other = T[::-1]
    np.testing.assert_allclose((T * other).adjoint(), T.adjoint() @ other.adjoint(), rtol=0, atol=64 * EPS)
    moved = T * RigidTransform.from_exp_coords(0.1 * coords) * T.inv()
    np.testing.assert_allclose(moved.as_exp_coords(), 0.1 * found, rtol=0, atol=64 * EPS)
    np.testing.assert_array_equal(ph.adjoint_matrix(M), T.adjoint())


def test_screws_of_single_precision():
    T, eps = transforms((50,), seed=0), float(np.finfo(np.float32).eps)
    M, expected = T.to_motor().astype(np.float32), ph.screw_parameters(T)
    found = ph.screw_parameters(M)
    assert found.point.dtype == found.angle.dtype == found.distance.dtype == np.float32
    # A motor rounded by eps is off by some eps over its angle, here 0.1 or more.
    assert expected.angle.min() > 0.1
    np.testing.assert_allclose(found.angle, expected.angle, rtol=0, atol=16 * eps)
    for ours, exact in ((found.point, expected.point), (found.distance, expected.distance)):
        ours, exact = (np.asarray(x) for x in (ours, exact))
        np.testing.assert_allclose(ours, exact, rtol=0, atol=160 * eps * (1 + np.abs(exact).max()))
    matrices = ph.adjoint_matrix(M)
    assert matrices.dtype == np.float32
    np.testing.assert_allclose(matrices, T.adjoint(), rtol=0, atol=64 * eps)
    with pytest.raises(ValueError, match="not a motor"):
        ph.adjoint_matrix(M + np.float32(0.01) * M.algebra.I)


def test_velocities_in_space_are_those_of_the_body_moved():
    """The twist of M(t) in space is the adjoint of that in the body, by differences."""
    T, h = transforms((), seed=11), 1e-5
    twist = np.array([0.3, -0.2, 0.5, 1.0, 2.0, -1.0])
    ahead, behind = (T * RigidTransform.from_exp_coords(s * h * twist) for s in (1, -1))
    rate = (ahead * T.inv()).as_exp_coords() / (2 * h) - (behind * T.inv()).as_exp_coords() / (2 * h)
    np.testing.assert_allclose(T.adjoint() @ twist, rate, rtol=0, atol=1e-9)


def test_other_values_have_no_screw():
    for f in (ph.screw_parameters, ph.adjoint_matrix):
        with pytest.raises(TypeError, match=rf"{f.__name__} needs a motor, .*got e3"):
            f(e3)
        with pytest.raises(TypeError, match="got ndarray"):
            f(np.eye(4))
        with pytest.raises(ValueError, match=r"at index \(1,\): not a motor"):
            f(ph.stack([1 + 0 * A.I, 1 + A.I + 0 * A.I]))


def test_motors_of_other_algebras_are_refused():
    with pytest.raises(ValueError, match=r"signature \(3, 0, 1\), got Cl\(4,1\)"):
        RigidTransform().to_motor(ph.algebra(4, 1))


def test_the_null_vector_may_come_first():
    P, T = ph.pga(3), transforms((3,), seed=12)
    M = T.to_motor(P)
    assert M.algebra is P
    null, *others = P.basis_vectors
    a, b, c = others
    x = np.array([1.0, -2.0, 0.5])
    at = (a * b * c - x[0] * b * c * null - x[1] * c * a * null - x[2] * a * b * null).grade(3)
    y = T.apply(x)
    for k in range(3):
        p = y[k]
        moved = (a * b * c - p[0] * b * c * null - p[1] * c * a * null - p[2] * a * b * null).grade(3)
        assert near(M[k](at), moved, 64, 8)
    assert np.all(RigidTransform.from_motor(M).is_close(T, rtol=64 * EPS, atol=64 * EPS))
    for x, y in zip(ph.screw_parameters(M), T.screw_parameters(), strict=True):
        np.testing.assert_array_equal(np.asarray(x), np.asarray(y))
    np.testing.assert_array_equal(ph.adjoint_matrix(M), T.adjoint())
    assert near(M**0.5 * M**0.5, M, 64)


@pytest.mark.parametrize("factor", [1e-200, 1e-161, 1e-158, 1e200])
@pytest.mark.parametrize("shape", [(), (2,)])
def test_motors_of_any_size_are_transforms(factor, shape):
    T = RigidTransform(ph.Rotor.random(shape, rng=1), [1.0, 2.0, 3.0])
    found = RigidTransform.from_motor(factor * T.to_motor())
    assert np.all(found.is_close(T, rtol=8 * EPS, atol=8 * EPS))


@pytest.mark.parametrize("factor", [0.0, math.inf, math.nan])
def test_motors_without_a_rotation_are_refused(factor):
    M = ph.stack([RigidTransform.identity().to_motor(), factor * RigidTransform.identity().to_motor()])
    with pytest.raises(
        ValueError, match=r"at index \(1,\): the rotation part of a motor must be finite and not 0"
    ):
        RigidTransform.from_motor(M)


@pytest.mark.parametrize("angle", [1e-3, 0.3, 3.1, 40.0, 9.9e5, 1.1e6, 1e20, 1e300])
@pytest.mark.parametrize("far", [1e-200, 1.0, 1e9, 1e200])
@pytest.mark.parametrize("A", [ph.pga(), ph.algebra(3, 0, 1)], ids=str)
def test_exponentials_against_60_digits(A, far, angle):
    """``cos Θ + C sin Θ/Θ`` of dual numbers, of bivectors of any size."""
    rng = np.random.default_rng(3)
    b, v = rng.normal(size=(2, 3))
    b *= angle / np.linalg.norm(b)
    v *= far
    found = columns(of_columns(A, [np.float64(x) for x in (0, *b, *v, 0)]).grade(2).exp())
    with mpmath.workdps(700):
        b, v = ([mpmath.mpf(float(x)) for x in row] for row in (b, v))
        square = mpmath.fsum(x * x for x in b)
        theta, along = mpmath.sqrt(square), mpmath.fsum(x * y for x, y in zip(b, v, strict=True))
        cosine, sinc = mpmath.cos(theta), mpmath.sin(theta) / theta
        slope = (cosine - sinc) / square
        moved = [sinc * y + along * slope * x for x, y in zip(b, v, strict=True)]
        expected = [float(x) for x in (cosine, *(sinc * x for x in b), *moved, sinc * along)]
    np.testing.assert_allclose(found[:4], expected[:4], rtol=2 * EPS, atol=0)
    np.testing.assert_allclose(found[4:], expected[4:], rtol=0, atol=8 * EPS * far)


@pytest.mark.parametrize("A", [ph.algebra(4), ph.algebra(1, 3), ph.cga()], ids=str)
def test_angles_beyond_the_precision_of_other_algebras(A):
    a, b = A.basis_vectors[1:3]
    plane = a * b
    assert (1e15 * plane).exp().is_finite()
    with pytest.raises(ValueError, match=r"exceeds 2\^52"):
        (1e16 * plane).exp()
