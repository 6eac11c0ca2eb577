"""Section 4 of the handout, equation by equation, on bodies that move.

The motions are simulated; derivatives are central differences over nine points, so that an equation is
tested against what the body does and not against itself.
"""

import numpy as np
import pytest

import polhode as ph
from polhode import I, e1, e2, e3

# f' = Σ c_k (f(kh) − f(−kh)) / h + O(h⁸): with h = 1/64 and rates about 1, (1/64)⁸/630 is below rounding.
H = 1 / 64
WEIGHTS = np.array([4 / 5, -1 / 5, 4 / 105, -1 / 280])
EPS = np.finfo(float).eps
# A difference divides roundings of a few 1e-16, one for each of the points, by H.
DERIVATIVE = 64 * EPS / H
ROUNDING = 64 * EPS

MASSES = np.array([1.0, 2.0, 0.5, 1.5, 0.75, 1.25])
POINTS = np.random.default_rng(41).normal(size=(6, 3))
POINTS = POINTS - MASSES @ POINTS / MASSES.sum()
BODY = ph.Body.from_points(MASSES, POINTS)
RADII = ph.vector(POINTS)
SHIFT = np.array([3.0, -1.0, 2.0])
START = ph.State(
    ph.Rotor.from_components([4, -2, 1, 2]),
    ph.bivector([0.25, -0.5, 1.0]),
    position=ph.vector([1.0, -2.0, 0.5]),
    velocity=ph.vector([0.3, 0.1, -0.2]),
)
GRAVITY = ph.torque.heavy([0.5, 0.25, 1.0])


def around(t):
    """The nine times about t, H apart."""
    return t + H * np.arange(-4, 5)


def moving(times, torque=None, body=None, state=START, **options):
    """A motion whose steps are too short to show: order 8 and steps of H/2."""
    if body is None:
        # The weight acts beside the centre of mass of these points: what moves is an inertia about the pivot.
        body = BODY.inertia if torque else BODY
    return ph.simulate(body, state, times, torque, step=H / 2, **options)


def stepped(t):
    """Rounding after stepping to t: four deviations of a random one, EPS/2, from each of 51 turns a step."""
    return 2 * EPS * np.sqrt(51 * t / (H / 2))


def rate(values):
    """The derivative at the middle of nine equidistant values (9, ...)."""
    values = np.asarray(values)
    return sum(c * (values[4 + k] - values[4 - k]) for k, c in enumerate(WEIGHTS, start=1)) / H


def even(c4):
    """An even multivector, not of norm 1, from its components."""
    return ph.scalar(c4[..., 0]) + ph.bivector(c4[..., 1:])


def assert_equal(a, b, tolerance=ROUNDING):
    difference = np.max((a - b).norm())
    assert difference <= tolerance * max(1.0, np.max(b.norm())), (
        f"{a!r} is not {b!r}, off by {difference:.1e}"
    )


TORQUES = pytest.mark.parametrize("torque", [None, GRAVITY], ids=["free", "heavy"])


class Moment:
    """Quantities at one time of a motion, with their rates."""

    def __init__(self, torque=None, t=1.5, **options):
        motion = moving(around(t), torque, **options)
        self.R = motion.rotor[4]
        self.R_rate = even(rate(motion.rotor.components))
        self.reverse_rate = even(rate((~motion.rotor).components))
        self.body = motion.omega_body[4]
        self.body_rate = ph.bivector(rate(motion.omega_body.components))
        self.space = self.R(self.body)
        self.L = motion.momentum_space[4]
        self.L_rate = ph.bivector(rate(motion.momentum_space.components))
        self.I = motion.inertia


# --- points and frames of a moving body


def test_eq_4_1_points_of_a_moving_body():
    """y(t) = R x ~R + x0: distances stay, and x0 is the centre of mass, moved by the force alone."""
    force, t = np.array([0.4, -0.2, 0.1]), np.linspace(0, 5, 11)
    motion = moving(t, force=force)
    y = motion.rotor[:, np.newaxis](RADII) + motion.position[:, np.newaxis]
    assert y.shape == (11, 6)
    between = y.components[:, :, np.newaxis] - y.components[:, np.newaxis]
    distances = np.linalg.norm(between, axis=-1)
    expected = np.linalg.norm(POINTS[:, np.newaxis] - POINTS, axis=-1)
    np.testing.assert_allclose(distances, np.broadcast_to(expected, distances.shape), rtol=0, atol=ROUNDING)
    center = np.einsum("k,nkx->nx", MASSES, y.components) / MASSES.sum()
    x0 = [1.0, -2.0, 0.5] + np.outer(t, [0.3, 0.1, -0.2]) + np.outer(t**2, force) / (2 * MASSES.sum())
    np.testing.assert_allclose(center, x0, rtol=0, atol=ROUNDING)


def test_eq_4_2_the_body_frame():
    """f_k = R e_k ~R is right-handed and orthonormal, the columns of the attitude matrix."""
    R = Moment().R
    f = [(R * e * ~R).grade(1) for e in (e1, e2, e3)]
    gram = np.array([[float(a.dot(b)) for a in f] for b in f])
    np.testing.assert_allclose(gram, np.eye(3), rtol=0, atol=ROUNDING)
    assert_equal(f[0] * f[1] * f[2], I)
    np.testing.assert_allclose(
        np.stack([x.components for x in f], axis=1), R.to_matrix(), rtol=0, atol=ROUNDING
    )


@TORQUES
def test_eq_4_3_and_4_4_the_frame_turns_with_the_angular_velocity(torque):
    """f_k' = ω x f_k = −I ω∧f_k = (−Iω)·f_k, with Ω_S = Iω."""
    motion = moving(around(1.5), torque)
    space = motion.rotor[4](motion.omega_body[4])
    omega = space.dual()
    assert_equal(I * omega, space)
    for e in (e1, e2, e3):
        f = motion.rotor(e)
        f_rate, f = ph.vector(rate(f.components)), f[4]
        assert_equal(ph.cross(omega, f), f_rate, DERIVATIVE)
        assert_equal(-I * omega.wedge(f), f_rate, DERIVATIVE)
        assert_equal((-I * omega).dot(f), f_rate, DERIVATIVE)


def test_eq_4_4_the_sense_of_a_spin():
    """ω = e3 is Ω_S = e1∧e2, and takes e1 towards e2."""
    body = ph.Body.sphere(1.0, mass=1.0)
    quarter = moving([np.pi / 2], body=body, state=ph.State(ph.Rotor.identity(), e3.undual()))
    assert_equal(quarter.omega_body[0], e1.wedge(e2))
    assert_equal(quarter.rotor[0](e1), e2)


@TORQUES
def test_eq_4_5_to_4_9_the_rate_of_the_rotor_is_a_bivector(torque):
    """R' ~R = −R (~R)' is a pure bivector and f_k' = (2R'~R)·f_k, hence 2R'~R = −Ω_S."""
    m = Moment(torque)
    product = m.R_rate * ~m.R
    assert abs(float(product.grade(0))) <= DERIVATIVE
    assert_equal(product, -(m.R * m.reverse_rate), DERIVATIVE)
    assert_equal(2 * product, -m.space, DERIVATIVE)
    for e in (e1, e2, e3):
        f_rate = m.R_rate * e * ~m.R + m.R * e * m.reverse_rate
        assert_equal((2 * product).grade(2).dot(m.R(e)), f_rate, DERIVATIVE)


@TORQUES
def test_eq_4_10_rate_of_the_rotor(torque):
    """R' = −½ Ω_S R."""
    m = Moment(torque)
    assert_equal(m.R_rate, -0.5 * m.space * m.R, DERIVATIVE)


@TORQUES
def test_eq_4_11_rate_of_the_reverse(torque):
    """(~R)' = ½ ~R Ω_S."""
    m = Moment(torque)
    assert_equal(m.reverse_rate, 0.5 * ~m.R * m.space, DERIVATIVE)


@TORQUES
def test_eq_4_12_angular_velocity_in_body_and_space(torque):
    """Ω_S = R Ω_B ~R, where Ω_S is found from the points of the body: Σ m y∧y' = Σ m y∧(y·Ω_S)."""
    motion = moving(around(1.5), torque)
    y = motion.rotor[:, np.newaxis](RADII).components
    v, y = rate(y), y[4]
    # y' = ω x y for all points: the axial vector by least squares.
    rows = np.concatenate([-np.cross(np.eye(3), point).T for point in y])
    omega = np.linalg.lstsq(rows, -v.ravel(), rcond=None)[0]
    assert_equal(motion.rotor[4](motion.omega_body[4]), ph.bivector(omega), 4 * DERIVATIVE)


@TORQUES
def test_eq_4_13_rate_of_the_rotor_in_the_body(torque):
    """R' = −½ R Ω_B and (~R)' = ½ Ω_B ~R."""
    m = Moment(torque)
    assert_equal(m.R_rate, -0.5 * m.R * m.body, DERIVATIVE)
    assert_equal(m.reverse_rate, 0.5 * m.body * ~m.R, DERIVATIVE)


@pytest.mark.parametrize("moments", [(2, 2, 2), (1, 2, 3)], ids=["sphere", "principal axis"])
def test_eq_4_14_constant_angular_velocity(moments):
    """Ω_S constant: R(t) = e^(−Ω_S t/2) R(0); beyond a full turn too."""
    R0 = START.rotor
    omega = ph.bivector([0, 0, 1.25] if moments == (1, 2, 3) else [0.5, -0.25, 1.0])
    space, t = R0(omega), np.linspace(0, 12, 13)
    motion = moving(t, body=ph.Inertia.from_principal_moments(*moments), state=ph.State(R0, omega))
    expected = (-0.5 * space * t).exp() * R0
    assert_equal(motion.rotor, expected, 15 * stepped(12))
    constant = ph.bivector(np.tile(space.components, (13, 1)))
    assert_equal(motion.rotor(motion.omega_body), constant, stepped(12))


# --- mass, velocity, momentum


def test_eq_4_15_mass_and_centre():
    """Σ m_k = m, and Σ m_k x_k = 0 about the centre of mass."""
    shifted = ph.Body.from_points(MASSES, POINTS + SHIFT)
    assert shifted.mass == pytest.approx(MASSES.sum(), rel=ROUNDING)
    assert_equal(shifted.center_of_mass, ph.vector(SHIFT))
    from_center = POINTS + SHIFT - shifted.center_of_mass.components
    assert np.abs(MASSES @ from_center).max() <= ROUNDING


@TORQUES
def test_eq_4_16_velocity_of_a_point(torque):
    """v(t) = R (x·Ω_B) ~R + v0."""
    motion = moving(around(1.5), torque)
    y = motion.rotor[:, np.newaxis](RADII) + motion.position[:, np.newaxis]
    v = ph.vector(rate(y.components))
    R, v0 = motion.rotor[4], motion.velocity[4]
    assert_equal(v, R(RADII.dot(motion.omega_body[4])) + v0, 2 * DERIVATIVE)


@TORQUES
def test_eq_4_17_and_4_19_angular_momentum(torque):
    """L = Σ m (y − x0)∧v = R I(Ω_B) ~R."""
    motion = moving(around(1.5), torque, body=BODY.inertia if torque else BODY)
    y = motion.rotor[:, np.newaxis](RADII) + motion.position[:, np.newaxis]
    v = ph.vector(rate(y.components))
    terms = (y[4] - motion.position[4]).wedge(v).components
    L = ph.bivector(MASSES @ terms)
    R, body = motion.rotor[4], motion.omega_body[4]
    assert_equal(motion.momentum_space[4], L, 8 * DERIVATIVE)
    assert_equal(motion.momentum_space[4], R * BODY.inertia(body) * ~R)


def test_eq_4_18_the_inertia_map():
    """I(B) = Σ m x∧(x·B), a linear, symmetric, positive map of bivectors to bivectors."""
    J = BODY.inertia
    A, B = ph.bivector([0.3, -1.0, 0.7]), ph.bivector([-0.2, 0.4, 1.1])
    for plane in (A, B):
        terms = RADII.wedge(RADII.dot(plane)).components
        assert J(plane).grades == (2,)
        assert_equal(J(plane), ph.bivector(MASSES @ terms))
    assert_equal(J(2.0 * A - 3.0 * B), 2.0 * J(A) - 3.0 * J(B))
    assert float(A.scalar_product(J(B))) == pytest.approx(float(J(A).scalar_product(B)), rel=ROUNDING)
    planes = ph.bivector(np.random.default_rng(0).normal(size=(100, 3)))
    # −A·I(A) = ω·I(ω), twice the kinetic energy.
    assert np.all(-planes.scalar_product(J(planes)).components > 0)
    assert np.any(J(A).wedge(A.dual()).norm() < J(A).norm() * A.norm() * 0.999), "in general another plane"


# --- dynamics


def test_eq_4_20_torque_is_the_rate_of_angular_momentum():
    """L' = T, with the torque bivector of the weight, T = (R a)∧(−m g e3), m g a = c."""
    m = Moment(GRAVITY, body=BODY.inertia)
    arm = m.R(ph.vector([0.5, 0.25, 1.0]))
    assert_equal(m.L_rate, arm.wedge(-e3), 8 * DERIVATIVE)


@TORQUES
def test_eq_4_20_the_torque_in_the_body(torque):
    """R [I(Ω_B') − Ω_B × I(Ω_B)] ~R = T."""
    m = Moment(torque, body=BODY.inertia)
    T = m.R(ph.vector([0.5, 0.25, 1.0])).wedge(-e3) if torque else ph.bivector([0, 0, 0])
    left = m.R(m.I(m.body_rate) - m.body.commutator(m.I(m.body)))
    assert_equal(left, T, 16 * DERIVATIVE)


def test_eq_4_22_no_torque():
    """I(Ω_B') = Ω_B × I(Ω_B), and L is constant."""
    m = Moment()
    assert m.body_rate.norm() > 0.1
    assert_equal(m.I(m.body_rate), m.body.commutator(m.I(m.body)), 16 * DERIVATIVE)
    assert_equal(m.L, START.rotor(m.I(START.omega_body)))


def test_eq_4_23_and_4_24_the_principal_frame():
    """Ω_B = Σ ω_k I e_k, Ω_S = Σ ω_k I f_k, I(Ω_B) = Σ i_k ω_k I e_k in the principal frame."""
    m = Moment()
    F, moments = m.I.principal_frame, m.I.principal_moments
    principal = [F(e) for e in (e1, e2, e3)]
    omega = [float(m.body.dual().dot(axis)) for axis in principal]
    assert_equal(sum(w * I * axis for w, axis in zip(omega, principal, strict=True)), m.body)
    assert_equal(sum(w * I * m.R(axis) for w, axis in zip(omega, principal, strict=True)), m.space)
    momentum = sum(i * w * I * axis for i, w, axis in zip(moments, omega, principal, strict=True))
    assert_equal(momentum, m.I(m.body))


def test_eq_4_24_euler_equations():
    """i1 ω1' = (i2 − i3) ω2 ω3 and cyclic."""
    J = ph.Inertia.from_principal_moments(1, 2, 2.5)
    m = Moment(body=J)
    (i1, i2, i3), (w1, w2, w3) = J.principal_moments, m.body.components
    expected = [(i2 - i3) * w2 * w3, (i3 - i1) * w3 * w1, (i1 - i2) * w1 * w2]
    np.testing.assert_allclose(
        J.principal_moments * m.body_rate.components, expected, rtol=0, atol=4 * DERIVATIVE
    )


# --- the symmetric top

SYMMETRIC = pytest.mark.parametrize(("i1", "i3"), [(1.0, 1.75), (2.0, 0.5)], ids=["oblate", "prolate"])


def top_of(i1, i3):
    return ph.SymmetricTop(ph.Inertia.from_principal_moments(i1, i1, i3), START.rotor, START.omega_body)


def moment_of_top(i1, i3, t=1.5):
    """A moment of the closed form: J, R, Ω_B and their rates."""
    states = top_of(i1, i3).at(around(t))
    J = ph.Inertia.from_principal_moments(i1, i1, i3)
    rates = even(rate(states.rotor.components)), ph.bivector(rate(states.omega_body.components))
    return J, states.rotor[4], states.omega_body[4], *rates


@SYMMETRIC
def test_eq_4_25_inertia_of_the_symmetric_top(i1, i3):
    """I(B) = i1 B + (i3 − i1)(B∧e3) e3."""
    J = ph.Inertia.from_principal_moments(i1, i1, i3)
    B = ph.bivector(np.random.default_rng(1).normal(size=(20, 3)))
    assert_equal(J(B), i1 * B + (i3 - i1) * B.wedge(e3) * e3)


def test_eq_4_27_commutator_with_a_dual():
    """B × (Ia) = −a∧(IB)."""
    rng = np.random.default_rng(2)
    B, a = ph.bivector(rng.normal(size=(20, 3))), ph.vector(rng.normal(size=(20, 3)))
    assert_equal(B.commutator(I * a), -a.wedge((I * B).grade(1)))


@SYMMETRIC
def test_eq_4_28_rate_of_the_symmetric_top(i1, i3):
    """I(Ω_B') = −(i3 − i1) e3∧[(Ω_B∧e3) Ω_B]."""
    J, _, body, _, body_rate = moment_of_top(i1, i3)
    assert body_rate.norm() > 0.1
    right = -(i3 - i1) * e3.wedge((body.wedge(e3) * body).grade(1))
    assert_equal(J(body_rate), right, 8 * DERIVATIVE)


@SYMMETRIC
def test_eq_4_29_the_spin_is_constant(i1, i3):
    """e3∧I(Ω_B') = 0, so ω3 is constant: in the closed form and in the simulation."""
    J, _, _, _, body_rate = moment_of_top(i1, i3)
    assert e3.wedge(J(body_rate)).norm() <= DERIVATIVE
    t = np.linspace(0, 50, 26)
    for omega in (top_of(i1, i3).at(t).omega_body, moving(t, body=J).omega_body):
        np.testing.assert_allclose(omega.components[:, 2], 1.0, rtol=0, atol=stepped(50))


@SYMMETRIC
def test_eq_4_30_angular_velocity_from_momentum(i1, i3):
    """i1 Ω_B = I(Ω_B) + (i1 − i3) ω3 I e3."""
    J, _, body, _, _ = moment_of_top(i1, i3)
    w3 = body.components[2]
    assert_equal(i1 * body, J(body) + (i1 - i3) * w3 * I * e3)


@SYMMETRIC
def test_eq_4_31_and_4_32_angular_velocity_in_space(i1, i3):
    """Ω_S = L/i1 + ((i1 − i3)/i1) ω3 R I e3 ~R, with Ω_S from the rate of the rotor."""
    J, R, body, R_rate, _ = moment_of_top(i1, i3)
    w3 = body.components[2]
    space = -2 * R_rate * ~R
    L = START.rotor(J(START.omega_body))
    assert_equal(space, L / i1 + (i1 - i3) / i1 * w3 * R * I * e3 * ~R, 8 * DERIVATIVE)


@SYMMETRIC
def test_eq_4_33_the_two_rates_are_constant(i1, i3):
    """Ω_l = L/i1 and Ω_r = ((i1 − i3)/i1) ω3 I e3 at all times."""
    states = top_of(i1, i3).at(np.linspace(-20, 20, 41))
    J = ph.Inertia.from_principal_moments(i1, i1, i3)
    left = states.rotor(J(states.omega_body)) / i1
    assert_equal(left, ph.bivector(np.tile(left[20].components, (41, 1))))
    w3 = states.omega_body.components[:, 2]
    np.testing.assert_allclose((i1 - i3) / i1 * w3, (i1 - i3) / i1, rtol=ROUNDING)


@SYMMETRIC
def test_eq_4_33_the_top_exposes_both_rates(i1, i3):
    """`omega_l` and `omega_r`, the same from any state of the motion."""
    top, J = top_of(i1, i3), ph.Inertia.from_principal_moments(i1, i1, i3)
    assert top.omega_l.grades == top.omega_r.grades == (2,)
    assert_equal(top.omega_l, START.rotor(J(START.omega_body)) / i1)
    assert_equal(top.omega_r, (i1 - i3) / i1 * START.omega_body.components[2] * I * e3)
    for t in (-20.0, 0.3, 20.0):
        state = top.at(t)
        again = ph.SymmetricTop(J, state.rotor, state.omega_body)
        # Angles up to 40 carry their relative rounding.
        assert_equal(again.omega_l, top.omega_l, 40 * EPS)
        assert_equal(again.omega_r, top.omega_r, 40 * EPS)


@SYMMETRIC
def test_eq_4_34_and_4_35_by_the_rates_of_the_top(i1, i3):
    """R' = −½ Ω_l R − ½ R Ω_r, Ω_S = Ω_l + R Ω_r ~R (4.31), and R(t) from the two exponentials."""
    top, (_, R, body, R_rate, _) = top_of(i1, i3), moment_of_top(i1, i3)
    assert_equal(R_rate, -0.5 * top.omega_l * R - 0.5 * R * top.omega_r, DERIVATIVE)
    assert_equal(R(body), top.omega_l + R(top.omega_r), 20 * EPS)
    t = np.linspace(-10, 10, 21)
    expected = (-0.5 * top.omega_l * t).exp() * START.rotor * (-0.5 * top.omega_r * t).exp()
    assert_equal(top.at(t).rotor, expected, 20 * EPS)


@SYMMETRIC
def test_eq_4_34_rate_of_the_rotor_of_the_top(i1, i3):
    """R' = −½ Ω_l R − ½ R Ω_r."""
    J, R, body, R_rate, _ = moment_of_top(i1, i3)
    left = R(J(body)) / i1
    right = (i1 - i3) / i1 * body.components[2] * I * e3
    assert_equal(R_rate, -0.5 * left * R - 0.5 * R * right, DERIVATIVE)


@SYMMETRIC
def test_eq_4_35_the_rotor_of_the_top(i1, i3):
    """R(t) = exp(−½Ω_l t) R(0) exp(−½Ω_r t): `SymmetricTop`, by hand, and stepped."""
    J, t = ph.Inertia.from_principal_moments(i1, i1, i3), np.linspace(-10, 10, 21)
    left = START.rotor(J(START.omega_body)) / i1
    right = ((i1 - i3) / i1 * START.omega_body.components[2] * I * e3).grade(2)
    expected = (-0.5 * left * t).exp() * START.rotor * (-0.5 * right * t).exp()
    # Angles up to 20 carry their relative rounding.
    assert_equal(top_of(i1, i3).at(t).rotor, expected, 20 * EPS)
    assert_equal(moving(t, body=J).rotor, expected, 20 * stepped(10))


def test_a_symmetric_top_is_shown_by_its_own_name():
    top = ph.SymmetricTop(ph.Inertia.from_principal_moments(1, 1, 2), ph.Rotor.identity(), [0.1, 0.2, 3])
    assert str(top).startswith("SymmetricTop(symmetric top, ")
