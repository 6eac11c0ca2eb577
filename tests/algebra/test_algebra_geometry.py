"""Uses of other signatures: motions, circles, space-time, quaternions, exterior calculus."""

import numpy as np
import pytest

import polhode as ph

EPS = 2.0**-52
PGA, CGA, SPACETIME = ph.algebra(3, 0, 1), ph.algebra(4, 1), ph.algebra(1, 3)


def near(A, B, count=16, size=1.0):
    difference = A - B
    return bool(np.all(np.linalg.norm(difference.components, axis=-1) <= count * EPS * size))


# --- Cl(3,0,1), planes and motions: the plane n·x = d is n − d e4, a point the wedge of three planes


def plane(normal, distance):
    return PGA.vector([*normal, -distance])


def point(x):
    return plane([1, 0, 0], x[0]) ^ plane([0, 1, 0], x[1]) ^ plane([0, 0, 1], x[2])


def translation(t):
    """``exp(½ t e4)``: ``T n ~T = n − (t·n) e4`` moves each plane n by t·n."""
    return ((PGA.vector([*t, 0]) ^ PGA.basis_vectors[3]) / 2).exp()


def test_a_translation_moves_points():
    x, t = np.array([1.0, 2.0, 3.0]), np.array([4.0, -6.0, 8.0])
    T = translation(t)
    assert 1 + (PGA.vector([*t, 0]) ^ PGA.basis_vectors[3]) / 2 == T
    assert T * point(x) * ~T == point(x + t)
    assert T * ~T == 1
    assert translation(-t) == ~T
    assert T * translation([1, 1, 1]) == translation(t + 1)
    assert T * plane([0, 0, 1], 3) * ~T == plane([0, 0, 1], 11)
    assert T.log() == (PGA.vector([*t, 0]) ^ PGA.basis_vectors[3]) / 2


def test_a_rotor_turns_points_about_the_origin():
    e1, e2, _, _ = PGA.basis_vectors
    for angle in (0.0, 1e-9, 0.3, np.pi / 2, 3.0):
        R = ((e1 ^ e2) * (-angle / 2)).exp()
        c, s = np.cos(angle), np.sin(angle)
        assert near(R * point([1, 2, 3]) * ~R, point([c - 2 * s, s + 2 * c, 3]), 32, 4)


def test_log_of_a_motor_is_its_screw():
    rng = np.random.default_rng(1)
    for scale in (1e-12, 1e-4, 1.0):
        B = PGA.bivector(scale * rng.standard_normal((50, 6)) / 2)
        M = B.exp()
        assert M.grades == (0, 2, 4)
        assert near(M * ~M, 1, 32)
        # log divides by the angle; the pitch loses as many digits as the angle is small.
        assert near(M.log(), B, 64, scale)
        assert near(M.log().exp(), M, 64)


def test_motions_compose_and_keep_distances():
    rng = np.random.default_rng(2)
    M, N = (PGA.bivector(rng.standard_normal(6)).exp() for _ in range(2))
    P, Q = point([1.0, 2, 3]), point([-1.0, 0, 2])
    moved = (M * N) * P * ~(M * N)
    assert near(moved, M * (N * P * ~N) * ~M, 64, 10)
    # |P∨Q| is the distance of unit points.
    assert abs((P.vee(Q)).norm() - 3) <= 8 * EPS
    distance = (M * P * ~M).vee(M * Q * ~M).norm()
    assert abs(distance - 3) <= 256 * EPS


def test_planes_meet_in_lines_and_points_join_in_lines():
    x_axis = plane([0, 1, 0], 0) ^ plane([0, 0, 1], 0)
    P, Q = point([0, 0, 0]), point([1, 0, 0])
    assert P.vee(Q) in (x_axis, -x_axis)
    assert x_axis.meet(x_axis) in (x_axis, -x_axis)
    on_it = plane([0, 1, 1], 0)
    # The plane contains the line: their join in this algebra of planes is the line itself.
    assert x_axis.wedge(on_it) == 0
    assert x_axis.join(plane([1, 0, 0], 2)).grades == (3,)


def test_null_bivectors_have_exponentials_of_two_terms():
    for A in (PGA, ph.algebra(0, 0, 2), ph.algebra(2, 0, 2)):
        n = A.dimension
        null = A.basis_vectors[n - 1] ^ A.basis_vectors[0]
        assert null * null == 0
        assert (3 * null).exp() == 1 + 3 * null
        assert (1 + 3 * null).log() == 3 * null
        assert null.exp() * null.exp() == (2 * null).exp()


# --- Cl(4,1), points as null vectors: X·Y = −½ |x − y|²


def conformal(x):
    e4, e5 = CGA.basis_vectors[3:]
    origin, infinity = (e5 - e4) / 2, e4 + e5
    return CGA.vector([*x, 0, 0]) + (np.dot(x, x) / 2) * infinity + origin


def test_inner_products_of_conformal_points_are_distances():
    rng = np.random.default_rng(3)
    infinity = CGA.vector([0, 0, 0, 1, 1])
    for x, y in rng.integers(-9, 10, (20, 2, 3)).astype(float):
        X, Y = conformal(x), conformal(y)
        assert X * X == 0
        assert X.scalar_product(Y) == -np.dot(x - y, x - y) / 2
        assert X.scalar_product(infinity) == -1


def test_conformal_motions():
    infinity = CGA.vector([0, 0, 0, 1, 1])
    t = np.array([2.0, -4.0, 6.0])
    T = (-CGA.vector([*t, 0, 0]) * infinity / 2).grade(2).exp()
    assert T * conformal([1.0, 2, 3]) * ~T == conformal(np.array([1.0, 2, 3]) + t)
    D = (np.log(3) / 2 * CGA.blades["e4∧e5"]).exp()  # of the boost in e4e5: a dilation by 3 or 1/3
    moved = D * conformal([1.0, 2, 3]) * ~D
    moved = moved / -float(moved.scalar_product(infinity))
    assert (
        min(np.linalg.norm((moved - conformal(np.array([1.0, 2, 3]) * k)).components) for k in (3, 1 / 3))
        < 1e-12
    )
    # A circle is the wedge of three points; a fourth lies on it where the wedge with it vanishes.
    circle = conformal([1.0, 0, 0]) ^ conformal([0.0, 1, 0]) ^ conformal([-1.0, 0, 0])
    assert (circle ^ conformal([0.0, -1, 0])) == 0
    assert (circle ^ conformal([0.0, 0, 1])) != 0


# --- Cl(1,3), space-time


def test_dirac_matrices_anticommute_to_the_metric():
    metric = [1, -1, -1, -1]
    gamma = SPACETIME.basis_vectors
    for i, a in enumerate(gamma):
        for j, b in enumerate(gamma):
            assert a * b + b * a == 2 * metric[i] * (i == j)


def test_relative_vectors_are_the_algebra_of_space():
    """σ_k = γ_k γ_0 multiply as e1, e2, e3 do."""
    g0, *rest = SPACETIME.basis_vectors
    sigma = [g * g0 for g in rest]
    for i, a in enumerate(sigma):
        assert a * a == 1
        for b in sigma[i + 1 :]:
            assert a * b == -(b * a)
    assert sigma[0] * sigma[1] * sigma[2] == SPACETIME.I
    assert SPACETIME.I * SPACETIME.I == -1


@pytest.mark.parametrize("rapidity", [0.0, 1e-9, 0.4, 3.0, -7.0])
def test_boosts_add_rapidities(rapidity):
    g0, g1, _, _ = SPACETIME.basis_vectors
    boost = ((g0 * g1) * (-rapidity / 2)).exp()
    c, s = np.cosh(rapidity), np.sinh(rapidity)
    assert near(boost * g0 * ~boost, c * g0 + s * g1, 32, c)
    again = ((g0 * g1) * (-0.3)).exp()
    assert near(boost * again, ((g0 * g1) * (-rapidity / 2 - 0.3)).exp(), 32, 2 * c)
    # The rapidity loses digits as cosh and sinh approach each other.
    assert near(boost.log(), (g0 * g1).grade(2) * (-rapidity / 2), 32, 2 * c)


def test_lorentz_rotors_keep_intervals():
    rng = np.random.default_rng(4)
    R = SPACETIME.bivector(rng.standard_normal((20, 6)) / 2).exp()
    x = SPACETIME.vector(rng.standard_normal((20, 4)))
    y = R * x * ~R
    size = (np.linalg.norm(R.components, axis=-1) ** 2 * np.linalg.norm(x.components, axis=-1)) ** 2
    assert np.all(np.abs((x * x - y * y).grade(0).components[:, 0]) <= 64 * EPS * size)
    assert np.all(np.linalg.norm(y.grade(3).components, axis=-1) <= 64 * EPS * size)


# --- small algebras


def test_quaternions_and_complex_numbers():
    i, j = ph.algebra(0, 2).basis_vectors
    k = i * j
    assert [u * u for u in (i, j, k)] == [-1, -1, -1]
    assert i * j * k == -1
    (u,) = ph.algebra(0, 1).basis_vectors
    assert near((0.7 * u).exp(), np.cos(0.7) + np.sin(0.7) * u)
    assert near((3 + 4 * u).inverse(), (3 - 4 * u) / 25)


def test_split_complex_and_dual_numbers():
    (h,) = ph.algebra(1).basis_vectors
    assert near((0.7 * h).exp(), np.cosh(0.7) + np.sinh(0.7) * h)
    (d,) = ph.algebra(0, 0, 1).basis_vectors
    assert (5 * d).exp() == 1 + 5 * d
    # Dual numbers differentiate: f(3 + d) = f(3) + f'(3) d, here of x³.
    assert (3 + d) ** 3 == 27 + 27 * d
    assert (2 + d).inverse() == 0.5 - 0.25 * d


def test_the_plane():
    A = ph.algebra(2)
    e1, e2 = A.basis_vectors
    turned = ((e1 ^ e2) * -0.25).exp()
    assert near(turned * e1 * ~turned, np.cos(0.5) * e1 + np.sin(0.5) * e2)
    assert A.I * e1 == -(e1 * A.I)  # it anticommutes with vectors in even dimensions
    assert not isinstance(turned, ph.Rotor)


@pytest.mark.parametrize(
    "A", [PGA, CGA, SPACETIME, ph.algebra(2), ph.algebra(1, 1), ph.algebra(4, 4)], ids=repr
)
def test_singular_values_have_no_inverse(A):
    e1 = A.basis_vectors[0]
    for value in (1 + e1, 1 - e1, A.scalar(0), 1 + e1 * (1 - 2**-53)):
        with pytest.raises(ValueError, match=r"no inverse: .*singular"):
            value.inverse()
    batch = ph.stack([A.scalar(1.0) + 0 * e1, 1 + e1])
    with pytest.raises(ValueError, match=r"index (\(1,\)|1)"):
        batch.inverse()
    with pytest.raises(ValueError, match="no inverse"):
        1 / (1 + e1)


def test_null_values_have_neither_inverse_nor_norm():
    e4 = PGA.basis_vectors[3]
    assert e4.norm() == 0
    with pytest.raises(ValueError, match="no inverse"):
        e4.inverse()
    with pytest.raises(ValueError, match="has no direction"):
        e4.normalized()
    light = SPACETIME.vector([1, 1, 0, 0])
    assert light.norm_squared() == 0
    with pytest.raises(ValueError, match="no inverse"):
        light.inverse()


def test_null_directions_do_not_count_in_norms():
    for far in (1e200, 1e-200, np.inf):
        assert PGA.vector([3, 4, 0, far]).norm() == 5
        assert PGA.vector([3, 4, 0, far]).norm_squared() == 25
        assert PGA.vector([[3e-170, 4e-170, 0, far]]).norm() == 5e-170
    unit = PGA.vector([3e-10, 4e-10, 0, 1e10]).normalized()
    assert near(unit, PGA.vector([0.6, 0.8, 0, 2e19]), 4, 2e19)
    assert near(unit.right_complement().left_complement(), unit, 1)
    with pytest.raises(ValueError, match="has no direction"):
        PGA.vector([3, 4, 0, np.inf]).normalized()
    assert np.isnan(PGA.vector([np.nan, 4, 0, 1]).norm())


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("name", ["inverse", "exp", "log"])
def test_functions_of_non_finite_values_raise(bad, name):
    with pytest.raises(ValueError, match="NaN or infinite"):
        getattr(CGA.scalar(1.0) + CGA.bivector([bad] + [0.0] * 9), name)()
