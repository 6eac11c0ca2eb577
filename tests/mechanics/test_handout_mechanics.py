"""Sections 3 and 4 of the handout, as far as the algebra alone expresses them, by number."""

from itertools import product

import numpy as np

import polhode as ph
from handout import BASIS, EPS, A, B, a, b, c, close, e12, integers, same, x
from naive import magnitude
from polhode import I, e1, e2, e3

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


def test_eq_4_3_omega_cross_f_as_bivector():
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


def test_eq_4_7_R_dot_R_reverse_is_a_pure_bivector():
    R_dot = -R_whole * A / 2
    assert same((R_dot * ~R_whole).grade(0), 0)
    assert same(R_dot * ~R_whole, (R_dot * ~R_whole).grade(2))


def test_eq_4_8_and_4_9_frame_rate_is_2_R_dot_R_reverse_dot_f():
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


def test_eq_4_27_commutator_with_a_dual_vector():
    assert same(B.commutator(I * a), -a.wedge(I * B))


def test_eq_4_26_commutator_of_the_top():
    # Ω × I(Ω) = (i3 − i1) Ω × [(Ω∧e3) e3]: the part along Ω drops out.
    volume = A.wedge(e3)
    assert same(A.commutator(top_inertia(A)), (TOP_I3 - TOP_I1) * A.commutator(volume * e3))


def test_eq_4_28_euler_equation_of_the_top():
    right = -(TOP_I3 - TOP_I1) * e3.wedge(A.wedge(e3) * A)
    assert same(A.commutator(top_inertia(A)), right)
