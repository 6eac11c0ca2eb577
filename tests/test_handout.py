"""Every numbered equation of the handout that the algebra alone can say, by its number.

Integer components make float arithmetic exact, so most equations hold with `==`. Where exponentials
enter, EPS counts roundings: a rotor's components carry about 2 eps, a product of it with a vector sums
four terms and is done twice, so |error| <= 2·(2 + 4) eps |a|; 16 eps is asked.
"""

from itertools import permutations, product

import numpy as np
import pytest

import polhode as ph
from naive import magnitude
from polhode import I, e1, e2, e3

EPS = 2.0**-52
BASIS = (e1, e2, e3)
e12, e23, e31 = e1 * e2, e2 * e3, e3 * e1
B1, B2, B3 = e23, e31, e12

ANGLES = [0.0, 1e-9, 0.3, np.pi / 2, 2.5, np.pi, 4.0, 2 * np.pi, -1.7, 9.0]


def integers(shape, seed):
    return np.random.default_rng(seed).integers(-9, 10, shape).astype(float)


# Fifty random vectors or bivectors with whole components, as a batch: equations hold for all at once.
a, b, c, x = (ph.vector(integers((50, 3), seed)) for seed in (1, 2, 3, 4))
A, B = ph.bivector(integers((50, 3), 5)), ph.bivector(integers((50, 3), 6))
M, N = ph.multivector(integers((50, 8), 7)), ph.multivector(integers((50, 8), 8))


def same(left, right):
    """Exactly equal, everywhere in the batch."""
    return bool(np.all(left == right))


def close(left, right, size=1.0, count=16):
    """Equal to `count` roundings of values of this size."""
    return bool(np.all(magnitude(left - right) <= count * EPS * size))


def epsilon(i, j, k):
    """ε_ijk for indices from 0."""
    return (i - j) * (j - k) * (k - i) // 2


def rotor(plane, angle):
    """e^(−Bθ/2) straight from the exponential."""
    return (plane * (-angle / 2)).grade(2).exp()


# --- 1: the algebra


def test_basis_of_eight_elements_graded_1_3_3_1():
    elements = [ph.scalar(1.0), e1, e2, e3, e23, e31, e12, e1 * e2 * e3]
    table = np.array(
        [sum((m.grade(k) for k in range(4)), ph.multivector([0.0] * 8)).components for m in elements]
    )
    assert np.array_equal(table, np.eye(8))
    assert [len(ph.multivector([1.0] * 8).grade(k).components) for k in range(4)] == [1, 3, 3, 1]


def test_eq_1_1_bivector_times_vector_is_the_volume():
    assert same(e1.wedge(e2) * e3, e1 * e2 * e3)


def test_eq_1_2_wedge_is_associative():
    assert same(a.wedge(b).wedge(c), a.wedge(b.wedge(c)))


def test_eq_1_3_wedge_of_vectors_is_antisymmetric():
    assert same(a.wedge(b).wedge(c), -b.wedge(a).wedge(c))
    assert same(a.wedge(b).wedge(c), c.wedge(a).wedge(b))


def test_eq_1_5_basis_bivectors_square_to_minus_one():
    for plane in (e12, e23, e31):
        assert plane * plane == -1


def test_eq_1_6_unit_bivector_turns_vectors_in_its_plane():
    assert e1 * e1.wedge(e2) == e2
    assert e2 * e1.wedge(e2) == -e1


def test_eq_1_7_vector_splits_into_parallel_and_perpendicular():
    plane = e12 * 3
    parallel, perpendicular = a.project(plane), a.reject(plane)
    assert same(parallel + perpendicular, a)
    assert same(parallel.wedge(plane), 0)
    assert same(perpendicular.dot(plane), 0)


def test_eq_1_8_parallel_part_times_the_plane_is_a_vector():
    parallel = 3 * e1 + 4 * e2
    b_in_plane = 8 * e1 - 6 * e2  # perpendicular to it
    plane = parallel.wedge(b_in_plane)
    assert parallel * plane == 25 * b_in_plane
    assert (parallel * plane).grade(3) == 0


def test_eq_1_9_perpendicular_part_times_the_plane_is_a_trivector():
    parallel, b_in_plane, perpendicular = 3 * e1 + 4 * e2, 8 * e1 - 6 * e2, 5 * e3
    plane = parallel.wedge(b_in_plane)
    assert perpendicular * plane == perpendicular.wedge(parallel).wedge(b_in_plane)
    assert (perpendicular * plane).grade(1) == 0


def test_eq_1_10_vector_times_bivector_is_dot_plus_wedge():
    assert same(a * B, a.dot(B) + a.wedge(B))
    assert a.dot(B).grades == (1,)
    assert a.wedge(B).grades == (3,)


@pytest.mark.parametrize(("r", "s"), list(product(range(4), repeat=2)))
def test_eq_1_10_dot_is_the_lowest_grade_wedge_the_highest(r, s):
    full = M.grade(r) * N.grade(s)
    assert same(M.grade(r).dot(N.grade(s)), full.grade(abs(r - s)))
    assert same(M.grade(r).wedge(N.grade(s)), full.grade(r + s) if r + s <= 3 else 0)


def test_eq_1_11_dot_with_a_bivector_is_antisymmetric():
    assert same(a.dot(B), -B.dot(a))


def test_eq_1_12_wedge_with_a_bivector_is_symmetric():
    assert same(a.wedge(B), B.wedge(a))


def test_eq_1_13_dot_and_wedge_from_products():
    assert same(a.dot(B), (a * B - B * a) / 2)
    assert same(a.wedge(B), (a * B + B * a) / 2)


def test_eq_1_14_product_of_two_planes():
    assert e1.wedge(e2) * e2.wedge(e3) == e1 * e3


def test_eq_1_15_planes_do_not_commute():
    assert e2.wedge(e3) * e1.wedge(e2) == -(e1 * e3)


def test_eq_1_16_basis_bivectors_are_the_dual_basis():
    assert [list(p.grade(2).components) for p in (B1, B2, B3)] == [[1, 0, 0], [0, 1, 0], [0, 0, 1]]


def test_eq_1_17_commutators_of_the_basis_bivectors():
    planes = (B1, B2, B3)
    for i, j in product(range(3), repeat=2):
        expected = sum((-2 * epsilon(i, j, k) * planes[k] for k in range(3)), ph.scalar(0.0))
        assert planes[i] * planes[j] - planes[j] * planes[i] == expected
        assert 2 * planes[i].commutator(planes[j]) == expected


def test_quaternion_units_are_minus_the_basis_bivectors():
    i, j, k = -B1, -B2, -B3
    for unit in (i, j, k):
        assert unit * unit == -1
    assert i * j == k
    assert j * k == i
    assert k * i == j
    assert i * j * k == -1


def test_basis_bivectors_themselves_multiply_the_other_way():
    assert B1 * B2 == -B3
    assert B1 * B2 * B3 == 1


def test_quaternion_and_its_rotor():
    # A unit quaternion with exact components: (1 + 1 + 1 + 1)/4 = 1.
    w, i, j, k = 0.5, -0.5, 0.5, 0.5
    expected = w - i * B1 - j * B2 - k * B3
    assert ph.Rotor.from_quaternion([w, i, j, k], order="wxyz") == expected
    assert ph.Rotor.from_quaternion([i, j, k, w], order="xyzw") == expected


def test_quaternion_product_is_the_rotor_product():
    # Hamilton's rule, written out; 1/2 and signs keep it exact.
    p, q = np.array([0.5, 0.5, -0.5, 0.5]), np.array([0.5, -0.5, -0.5, -0.5])
    w, v, t, u = p[0], p[1:], q[0], q[1:]
    pq = [w * t - v @ u, *(w * u + t * v + np.cross(v, u))]
    rotors = [ph.Rotor.from_quaternion(value, order="wxyz") for value in (p, q, pq)]
    assert rotors[0] * rotors[1] == rotors[2]


def test_eq_1_18_and_1_22_pseudoscalar():
    assert e1 * e2 * e3 == I
    assert I * I == -1


def test_eq_1_18_right_handed_frames_have_volume_plus_I():
    for i, j, k in permutations(range(3)):
        assert BASIS[i] * BASIS[j] * BASIS[k] == epsilon(i, j, k) * I


def test_eq_1_19_vector_times_pseudoscalar_is_the_perpendicular_plane():
    assert e1 * I == e23
    assert I * e1 == e23


def test_eq_1_20_duality():
    assert e12 == I * e3
    assert e23 == I * e1
    assert e31 == I * e2


def test_dual_and_undual_have_the_signs_of_the_axial_vector():
    for plane, axis in zip((B1, B2, B3), BASIS, strict=True):
        assert plane.dual() == axis
        assert axis.undual() == plane
        assert axis.dual() == -plane
    assert same(M.dual(), M * -I)
    assert same(M.undual(), M * I)
    assert same(a.wedge(b).dual(), ph.cross(a, b))


def test_eq_1_21_pseudoscalar_commutes_and_product_is_the_dot():
    assert same(a * I, I * a)
    assert same(a * I, a.dot(I))


def test_pseudoscalar_commutes_with_everything():
    assert same(M * I, I * M)


def test_in_two_dimensions_the_pseudoscalar_anticommutes_with_vectors():
    in_plane = a.project(e12)
    assert same(in_plane * e12, -(e12 * in_plane))


def test_eq_1_23_pseudoscalar_times_plane():
    assert I * e1.wedge(e2) == -e3


def test_eq_1_24_cross_product():
    assert same(ph.cross(a, b), -I * a.wedge(b))
    assert np.array_equal(ph.cross(a, b).components, np.cross(a.components, b.components))


def test_eq_1_25_reverse_of_a_plane():
    assert ~e12 == -e12
    assert ~(e1 * e2) == e2 * e1


def test_eq_1_26_reverse_of_the_pseudoscalar():
    assert ~I == -I
    assert ~(e1 * e2 * e3) == e3 * e2 * e1


def test_eq_1_27_and_1_28_reverse_of_a_general_element():
    parts = [M.grade(k) for k in range(4)]
    assert same(M, parts[0] + parts[1] + parts[2] + parts[3])
    assert same(~M, parts[0] + parts[1] - parts[2] - parts[3])
    assert same(~(M * N), ~N * ~M)


def test_eq_1_29_pauli_algebra_of_the_basis():
    for i, j in product(range(3), repeat=2):
        expected = sum((epsilon(i, j, k) * (I * BASIS[k]) for k in range(3)), ph.scalar(float(i == j)))
        assert BASIS[i] * BASIS[j] == expected


def test_eq_1_29_pauli_matrices_represent_the_algebra():
    sigma = [np.array(m) for m in ([[0, 1], [1, 0]], [[0, -1j], [1j, 0]], [[1, 0], [0, -1]])]
    for vector, matrix in zip(BASIS, sigma, strict=True):
        assert np.array_equal(ph.to_pauli(vector), matrix)
    assert np.array_equal(ph.to_pauli(I), 1j * np.eye(2))
    assert np.array_equal(ph.to_pauli(M * N), ph.to_pauli(M) @ ph.to_pauli(N))


def test_eq_1_29_pauli_matrices_are_faithful():
    assert same(ph.from_pauli(ph.to_pauli(M)), M)


# --- 2: rotations


@pytest.mark.parametrize("angle", ANGLES)
def test_eq_2_1_rotation_in_a_plane_three_ways(angle):
    in_plane = a.project(e12)
    one_sided = (e12.grade(2) * -angle).exp()
    half = rotor(e12, angle)
    size = magnitude(in_plane)
    assert close(one_sided * in_plane, in_plane * ~one_sided, size)
    assert close(one_sided * in_plane, half * in_plane * ~half, size)
    u, v, _ = in_plane.components.T
    turned = np.stack(
        [u * np.cos(angle) - v * np.sin(angle), u * np.sin(angle) + v * np.cos(angle), 0 * u], axis=-1
    )
    assert close(half * in_plane * ~half, ph.vector(turned), size)


@pytest.mark.parametrize("angle", ANGLES)
def test_eq_2_2_the_plane_commutes_with_its_normal(angle):
    one_sided = (e12.grade(2) * -angle).exp()
    assert same(one_sided * e3, e3 * one_sided)


@pytest.mark.parametrize("angle", ANGLES)
def test_eq_2_3_only_the_two_sided_form_keeps_the_normal(angle):
    half = rotor(e12, angle)
    assert close(half * e3 * ~half, e3)
    one_sided = half * half
    # |e^(−Bθ) e3 − e3| = |e^(−Bθ) − 1| = 2 |sin θ/2|.
    moved = magnitude(one_sided * e3 - e3)
    assert abs(moved - 2 * abs(np.sin(angle / 2))) <= 16 * EPS


def rodrigues(axis, angle, v):
    """The axis–angle formula of the textbooks, right-handed about a unit axis."""
    along = np.sum(axis * v, axis=-1, keepdims=True) * axis
    return along + (v - along) * np.cos(angle) + np.cross(axis, v) * np.sin(angle)


@pytest.mark.parametrize("angle", ANGLES)
def test_eq_2_4_rotor_turns_by_the_angle_in_the_sense_of_the_plane(angle):
    plane = ph.bivector([2.0, -1.0, 2.0]) / 3
    assert close(plane * plane, -1)
    R = rotor(plane, angle)
    expected = ph.vector(rodrigues(plane.dual().components, angle, a.components))
    assert close(R * a * ~R, expected, magnitude(a))
    assert close(R(a), expected, magnitude(a))
    assert close(ph.Rotor.from_plane_angle(5 * plane, angle), R)


def test_eq_2_4_sense_quarter_turn_in_e12_takes_e1_to_e2():
    R = rotor(e1.wedge(e2), np.pi / 2)
    assert close(R(e1), e2)
    assert close(R(e2), -e1)


def test_eq_2_5_rotors_are_unit_and_even():
    R = ph.Rotor.random((50,), 9)
    assert R.grades == (0, 2)
    assert close(R * ~R, 1)
    assert close(~R * R, 1)
    assert R.components.shape == (50, 4)  # four numbers, one constraint


def test_eq_2_5_bivectors_give_all_three_degrees_of_freedom():
    R = ph.Rotor.random((50,), 10)
    assert close(R.log().exp(), R)
    assert R.log().grades == (2,)


def test_eq_2_6_bivectors_turn_by_the_same_formula():
    R = ph.Rotor.random((50,), 11)
    size = magnitude(a) * magnitude(b)
    assert close(R * a.wedge(b) * ~R, R(a).wedge(R(b)), size, 32)
    assert close(R(a.wedge(b)), R(a).wedge(R(b)), size, 32)


def test_eq_2_6_every_multivector_turns_by_the_same_formula():
    R = ph.Rotor.random((50,), 12)
    assert close(R(M * N), R(M) * R(N), magnitude(M) * magnitude(N), 64)
    assert close(R(M), R * M * ~R, magnitude(M))


# --- 3: angular momentum


def test_eq_3_1_angular_momentum_vector_is_the_dual():
    assert same(x.wedge(a).dual(), ph.cross(x, a))
    assert np.array_equal(x.wedge(a).components, np.cross(x.components, a.components))


def test_eq_3_2_angular_momentum_is_a_bivector_also_in_the_plane():
    position, momentum = 2 * e1 + 3 * e2, -1 * e1 + 4 * e2
    assert position.wedge(momentum).grades == (2,)
    assert position.wedge(momentum) == 11 * e12


# --- 4: kinematics
#
# Exact instants: any even element with whole components stands for R, as long as only R' = −½ Ω_S R
# enters; where ~R R = 1 matters, R = (3 − 4 e1e2)/5-like rotors would round, so R is kept unnormalised
# and n = R ~R carried along.

R_whole = ph.scalar(integers((50,), 20)) + ph.bivector(integers((50, 3), 21))
N_WHOLE = np.sum(R_whole.components**2, axis=-1)  # R ~R
omega_space_times_n = R_whole * A * ~R_whole  # n Ω_S, with Ω_B = A


def moving(t):
    """A tumbling rotor R(t) = e^(−P t/2) e^(−Q t/2): the product of two steady turns."""
    P, Q = ph.bivector([0.3, -1.1, 0.7]), ph.bivector([-0.8, 0.2, 1.3])
    t = np.asarray(t, dtype=float)
    return (P * (-t / 2)).exp() * (Q * (-t / 2)).exp()


def omega_space(t):
    """Its space angular velocity: P + e^(−P t/2) Q e^(P t/2), from R' = −½ P R − ½ R Q and (4.10)."""
    P, Q = ph.bivector([0.3, -1.1, 0.7]), ph.bivector([-0.8, 0.2, 1.3])
    return P + (P * (-t / 2)).exp()(Q)


STEP = 2.0**-10


def rate(f, t):
    """f'(t) by Richardson's extrapolation of central differences."""

    def central(h):
        return (f(t + h) - f(t - h)) / (2 * h)

    return (4 * central(STEP) - central(2 * STEP)) / 3


# Its error: truncation 4 h⁴ |f⁽⁵⁾|/120, where each derivative brings at most |Ω| < 1.4 + 1.6 = 3, so
# 3⁵ · 4/120 h⁴ = 8 h⁴; and rounding, a few eps in each f, over h: 4 · 8 eps/h.
RATE_ERROR = 8 * STEP**4 + 32 * EPS / STEP

TIMES = [0.0, 0.7, 2.0, 5.5]


def test_eq_4_1_rigid_displacement_keeps_distances_and_handedness():
    R, x0 = ph.Rotor.random((50,), 22), ph.vector([10.0, -3.0, 5.0])

    def y(point):
        return R(point) + x0

    size = magnitude(a) + magnitude(b) + magnitude(c) + magnitude(x0)
    assert np.all(abs(magnitude(y(a) - y(b)) - magnitude(a - b)) <= 16 * EPS * size)
    before = (a - x).wedge(b - x).wedge(c - x)
    after = (y(a) - y(x)).wedge(y(b) - y(x)).wedge(y(c) - y(x))
    assert close(before, after, (size + magnitude(x)) ** 3, 64)


def test_eq_4_2_body_frame_is_orthonormal_and_right_handed():
    R = ph.Rotor.random((50,), 23)
    f = [R * e * ~R for e in BASIS]
    for i, j in product(range(3), repeat=2):
        assert close(f[i].grade(1).dot(f[j].grade(1)), float(i == j), 1, 32)
    assert close(f[0] * f[1] * f[2], I, 1, 48)


def test_eq_4_3_velocity_of_the_frame_is_omega_cross_f():
    for t in TIMES:
        omega = omega_space(t).dual()
        for e in BASIS:
            velocity = rate(lambda s, e=e: moving(s)(e), t)
            assert magnitude(velocity - ph.cross(omega, moving(t)(e))) <= RATE_ERROR


def test_eq_4_4_omega_cross_f_as_bivector():
    omega, f = a, b
    assert same(ph.cross(omega, f), -I * omega.wedge(f))
    assert same(ph.cross(omega, f), (-I * omega).dot(f))


def test_eq_4_4_spin_about_e3_is_plus_e12():
    assert I * e3 == e1.wedge(e2)
    assert e3.undual() == e1.wedge(e2)


def test_eq_4_5_rate_of_the_frame_from_the_rotor():
    for t in TIMES:
        R, R_dot = moving(t), rate(moving, t)
        for e in BASIS:
            direct = rate(lambda s, e=e: moving(s)(e), t)
            by_product_rule = R_dot * e * ~R + R * e * ~R_dot
            assert magnitude(direct - by_product_rule) <= 3 * RATE_ERROR


def test_eq_4_6_rate_of_the_unit_constraint():
    for t in TIMES:
        R, R_dot = moving(t), rate(moving, t)
        assert magnitude(R_dot * ~R + R * ~R_dot) <= 2 * RATE_ERROR


def test_eq_4_7_R_dot_R_reverse_is_minus_its_reverse():
    # For R' = −½ Ω_S R exactly: R' ~R = −½ n Ω_S and R (~R)' = +½ n Ω_S.
    R_dot = -R_whole * A / 2
    assert same(R_dot * ~R_whole, -(R_whole * ~R_dot))
    assert same(~(R_dot * ~R_whole), R_whole * ~R_dot)


def test_eq_4_8_R_dot_R_reverse_is_a_pure_bivector():
    R_dot = -R_whole * A / 2
    assert same((R_dot * ~R_whole).grade(0), 0)
    assert same(R_dot * ~R_whole, (R_dot * ~R_whole).grade(2))


def test_eq_4_9_frame_rate_is_2_R_dot_R_reverse_dot_f():
    R_dot = -R_whole * A / 2
    twice = (2 * R_dot * ~R_whole).grade(2)  # n times 2 R' ~R of the unit rotor
    for e in BASIS:
        f = (R_whole * e * ~R_whole).grade(1)  # n f
        f_dot = (R_dot * e * ~R_whole + R_whole * e * ~R_dot).grade(1)  # n f'
        assert same(N_WHOLE * f_dot, twice.dot(f))
    assert same(twice, -omega_space_times_n)


def test_eq_4_10_rotor_equation():
    for t in TIMES:
        assert magnitude(rate(moving, t) + omega_space(t) * moving(t) / 2) <= RATE_ERROR


def test_eq_4_11_rotor_equation_of_the_reverse():
    for t in TIMES:
        assert magnitude(rate(lambda s: ~moving(s), t) - ~moving(t) * omega_space(t) / 2) <= RATE_ERROR


def test_eq_4_12_space_and_body_angular_velocity():
    for t in TIMES:
        R = moving(t)
        body = (~R)(omega_space(t))
        assert close(R * body * ~R, omega_space(t), 3, 32)
        assert magnitude(rate(moving, t) + R * body / 2) <= RATE_ERROR


def test_eq_4_13_three_forms_of_the_rotor_equation():
    # −½ Ω_S R = −½ R Ω_B and (~R)' = ½ Ω_B ~R, exactly, with n Ω_S = R Ω_B ~R.
    n = N_WHOLE
    assert same(omega_space_times_n * R_whole, n * (R_whole * A))
    assert same(~(-R_whole * A / 2), A * ~R_whole / 2)
    assert same(~R_whole * omega_space_times_n, n * (A * ~R_whole))


def test_eq_4_14_constant_angular_velocity():
    omega, start = ph.bivector([0.5, -1.2, 0.9]), ph.Rotor.random((), 24)

    def R(t):
        return (omega * (-t / 2)).exp() * start

    assert close(R(0.0), start)
    for t in TIMES:
        assert magnitude(rate(R, t) + omega * R(t) / 2) <= RATE_ERROR


# --- 4: dynamics, of point masses


MASSES = [2.0, 1.0, 3.0, 1.0, 4.0]
POINTS = [ph.vector(p) for p in integers((5, 3), 30)]


def inertia(plane, masses=MASSES, points=POINTS):
    """I(B) = Σ m x∧(x·B), (4.18) for point masses."""
    return sum(
        (m * p.wedge(p.dot(plane)) for m, p in zip(masses, points, strict=True)),
        ph.bivector([0.0, 0.0, 0.0]),
    )


# Pairs of unit masses at ±h_k e_k: principal moments i_k = 2 (h_i² + h_j²), here 26, 20, 10.
HALVES = (1.0, 2.0, 3.0)
PRINCIPAL_POINTS = [s * h * e for h, e in zip(HALVES, BASIS, strict=True) for s in (1, -1)]
MOMENTS = (26.0, 20.0, 10.0)

# A symmetric top: i1 = i2 = 2 (1 + 9) = 20, i3 = 2 (1 + 1) = 4.
TOP_POINTS = [s * h * e for h, e in zip((1.0, 1.0, 3.0), BASIS, strict=True) for s in (1, -1)]
TOP_I1, TOP_I3 = 20.0, 4.0


def principal_inertia(plane):
    return inertia(plane, [1.0] * 6, PRINCIPAL_POINTS)


def top_inertia(plane):
    return inertia(plane, [1.0] * 6, TOP_POINTS)


def test_eq_4_18_inertia_maps_bivectors_to_bivectors_linearly():
    assert inertia(A).grades == (2,)
    assert same(inertia(2 * A - 3 * B), 2 * inertia(A) - 3 * inertia(B))


def test_eq_4_18_inertia_is_symmetric():
    assert same(A.dot(inertia(B)), inertia(A).dot(B))


def test_eq_4_18_inertia_is_positive():
    form = -A.dot(inertia(A)).grade(0).components[..., 0]  # −A·I(A) = Σ m |x·A|²
    assert np.all(
        form
        == sum(m * np.sum(p.dot(A).components ** 2, axis=-1) for m, p in zip(MASSES, POINTS, strict=True))
    )
    assert np.all((form > 0) | (magnitude(A) == 0))


def test_eq_4_18_agrees_with_the_inertia_matrix_of_the_textbooks():
    xyz = np.array([p.components for p in POINTS])
    J = sum(m * ((p @ p) * np.eye(3) - np.outer(p, p)) for m, p in zip(MASSES, xyz, strict=True))
    assert np.array_equal(inertia(A).components, A.components @ J.T)


def test_eq_4_20_rate_of_angular_momentum_is_the_torque():
    # L = R J ~R with J = I(Ω_B); by (4.13) L' = R [J' − Ω_B × J] ~R, exactly.
    J, J_dot = inertia(A), inertia(B)  # Ω_B = A and Ω_B' = B at this instant
    R, R_dot = R_whole, -R_whole * A / 2
    L_dot = R_dot * J * ~R + R * J_dot * ~R + R * J * ~R_dot
    assert same(L_dot, R * (J_dot - A.commutator(J)) * ~R)


def test_eq_4_21_commutator():
    assert same(A.commutator(B), (A * B - B * A) / 2)
    assert A.commutator(B).grades == (2,)
    assert np.array_equal(A.commutator(B).dual().components, -np.cross(A.components, B.components))


def test_eq_4_22_torque_free_equation_keeps_the_momentum():
    # Ω_B' chosen so that I(Ω_B') = Ω_B × I(Ω_B): then L' = 0 exactly.
    J = inertia(A)
    J_dot = A.commutator(J)
    R, R_dot = R_whole, -R_whole * A / 2
    assert same(R_dot * J * ~R + R * J_dot * ~R + R * J * ~R_dot, 0)


def test_eq_4_23_angular_velocity_along_the_principal_axes():
    # n Ω_S = Σ ω_k I (n f_k).
    omega = A.components
    in_body = sum((omega[:, k] * (I * e) for k, e in enumerate(BASIS)), ph.bivector([0.0, 0.0, 0.0]))
    assert same(in_body, A)
    f = [R_whole * e * ~R_whole for e in BASIS]
    in_space = sum((omega[:, k] * (I * f[k]) for k in range(3)), ph.bivector([0.0, 0.0, 0.0]))
    assert same(in_space, omega_space_times_n)


def test_eq_4_24_principal_moments_and_euler_equations():
    omega = A.components
    expected = sum((MOMENTS[k] * omega[:, k] * (I * BASIS[k]) for k in range(3)), ph.bivector([0.0] * 3))
    assert same(principal_inertia(A), expected)
    rates = A.commutator(principal_inertia(A)).components  # i_k ω_k'
    i1, i2, i3 = MOMENTS
    w1, w2, w3 = omega.T
    euler = np.stack([(i2 - i3) * w2 * w3, (i3 - i1) * w3 * w1, (i1 - i2) * w1 * w2], axis=-1)
    assert np.array_equal(rates, euler)


def test_eq_4_25_symmetric_top():
    assert same(top_inertia(A), TOP_I1 * A + (TOP_I3 - TOP_I1) * (A.wedge(e3) * e3))


def test_eq_4_26_commutator_with_a_dual_vector():
    assert same(B.commutator(I * a), -a.wedge(I * B))


def test_eq_4_27_commutator_of_the_top():
    # Ω × I(Ω) = (i3 − i1) Ω × [(Ω∧e3) e3]: the part along Ω drops out.
    volume = A.wedge(e3)
    assert same(A.commutator(top_inertia(A)), (TOP_I3 - TOP_I1) * A.commutator(volume * e3))


def test_eq_4_28_euler_equation_of_the_top():
    right = -(TOP_I3 - TOP_I1) * e3.wedge(A.wedge(e3) * A)
    assert same(A.commutator(top_inertia(A)), right)
