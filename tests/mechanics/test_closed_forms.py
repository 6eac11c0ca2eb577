"""Motion under torques and forces against closed forms."""

import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, EPS, R0, START, apart, moments, random_walk


def test_damping_is_free_motion_in_slower_time():
    """N = −g L: the free top at τ = (1 − e^(−gt))/g, with ω scaled by e^(−gt)."""
    g, t = 0.25, np.linspace(0, 20, 41)
    damped = ph.simulate(ASYMMETRIC, START, t, ph.torque.damping(g), step=1 / 64)
    free = ph.simulate(ASYMMETRIC, START, -np.expm1(-g * t) / g, step=1 / 64)
    slow = np.exp(-g * t)[:, np.newaxis]
    tolerance = 20 * random_walk(64 * 20)
    np.testing.assert_allclose(damped.rotor.components, free.rotor.components, rtol=0, atol=tolerance)
    np.testing.assert_allclose(
        damped.omega_body.components, free.omega_body.components * slow, rtol=0, atol=tolerance
    )
    assert damped.certificate.drift == {}


def test_a_torque_along_a_principal_axis():
    """Spin about e3 with N = ν e1∧e2: ω3 = ω0 + νt/i3, angle ω0 t + νt²/2i3; in body and space axes alike."""
    t = np.linspace(0, 10, 11)
    start = ph.State(ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, 0.5), [0, 0, 0.5])
    angle = 0.5 + 0.5 * t + 0.25 * t**2 / 6
    for law in (ph.torque.constant_body, ph.torque.constant_space):
        motion = ph.simulate(ASYMMETRIC, start, t, law(0.25 * (ph.e1 ^ ph.e2)), step=1 / 64)
        expected = [np.cos(angle / 2), 0 * t, 0 * t, -np.sin(angle / 2)]
        tolerance = 20 * random_walk(640)
        np.testing.assert_allclose(motion.rotor.components.T, expected, rtol=0, atol=tolerance)
        np.testing.assert_allclose(
            motion.omega_body.components[:, 2], 0.5 + 0.25 * t / 3, rtol=0, atol=random_walk(640)
        )
        np.testing.assert_array_equal(motion.omega_body.components[:, :2], 0)


def test_a_torque_constant_in_space_adds_to_L():
    """L = L0 + N t for any body."""
    t, N = np.linspace(-5, 5, 21), np.array([0.3, -0.2, 0.1])
    motion = ph.simulate(ASYMMETRIC, START, t, ph.torque.constant_space(N), step=1 / 64)
    L0 = START.rotor(ASYMMETRIC(START.omega_body)).components
    expected = L0 + np.outer(t, N)
    np.testing.assert_allclose(motion.momentum_space.components, expected, rtol=0, atol=4 * random_walk(640))


def test_a_torque_constant_in_a_sphere_adds_to_its_rate():
    """I(Ω_B') = N: Ω_B of a sphere grows linearly."""
    t, N = np.linspace(-5, 5, 21), np.array([0.3, -0.2, 0.1])
    motion = ph.simulate(moments(2, 2, 2), START, t, ph.torque.constant_body(N), step=1 / 64)
    expected = START.omega_body.components + np.outer(t, N) / 2
    np.testing.assert_allclose(motion.omega_body.components, expected, rtol=0, atol=4 * random_walk(640))


def test_laws_add_up():
    """L' = N − g L: L = L0 e^(−gt) + N (1 − e^(−gt))/g."""
    g, t, N = 0.5, np.linspace(0, 5, 11), ph.bivector([0.3, -0.2, 0.1])
    law = ph.torque.constant_space(N) + ph.torque.damping(g)
    motion = ph.simulate(ASYMMETRIC, START, t, law, rtol=1e-11)
    L0 = START.rotor(ASYMMETRIC(START.omega_body)).components
    decay = np.exp(-g * t)[:, np.newaxis]
    expected = L0 * decay + N.components * (1 - decay) / g
    np.testing.assert_allclose(motion.momentum_space.components, expected, rtol=0, atol=1e-10)
    with pytest.raises(TypeError):
        law + 1


def test_a_weightless_heavy_top_is_free():
    t = np.linspace(0, 5, 11)
    free = ph.simulate(ASYMMETRIC, START, t, step=1 / 64)
    held = ph.simulate(ASYMMETRIC, START, t, ph.torque.heavy([0, 0, 0]), step=1 / 64)
    assert apart(held, free.rotor.components, free.omega_body.components) <= 5 * random_walk(320)


def test_a_body_under_gravity_turns_about_the_origin_of_its_axes():
    """A pendulum of small swing: ω² = m g l/I, with I about the point it hangs from, (3/2) g/l for a rod."""
    g, length = 9.81, 0.5
    rod = ph.Body.cylinder(0.05, length, mass=2.0).moved(position=[0, 0, -length / 2])
    tilt = 1e-5
    start = ph.State(ph.Rotor.from_plane_angle(ph.e2 ^ ph.e3, tilt), [0, 0, 0])
    t = np.linspace(0, 3, 61)
    law = ph.torque.heavy(rod.mass * g * rod.center_of_mass)
    motion = ph.simulate(rod, start, t, law)
    swing = motion.rotor.to_rotation_vector()[:, 0]
    rate = np.sqrt(rod.mass * g * length / 2 / rod.inertia_about([0, 0, 0]).matrix[0, 0])
    # I/(m l²) = 1/3 + r²/4l², with r = l/10.
    assert rate == pytest.approx(np.sqrt(g / 2 / length / (1 / 3 + 1 / 400)), rel=8 * EPS)
    # The rate changes by tilt²/16 with the amplitude, which is nothing; the angle is twice the rotor's,
    # and that is good to 1e-10.
    tolerance = 2e-10
    np.testing.assert_allclose(swing, tilt * np.cos(rate * t), rtol=0, atol=tolerance)


def test_a_force_moves_the_centre_of_mass_alone():
    body, t = ph.Body.box([1, 2, 3], mass=4.0), np.array([-1.0, 0.0, 2.0])
    state = ph.State(R0, [0.25, -0.5, 1.0], position=[1, 2, 3], velocity=ph.vector([0, 1, 0]))
    motion = ph.simulate(body, state, t, force=ph.vector([8.0, 0, -4.0]))
    np.testing.assert_array_equal(motion.position.components, [[2, 1, 2.5], [1, 2, 3], [5, 4, 1]])
    np.testing.assert_array_equal(motion.velocity.components, [[-2, 1, 1], [0, 1, 0], [4, 1, -2]])
    free = ph.simulate(body, ph.State(R0, [0.25, -0.5, 1.0]), t)
    assert np.all(motion.rotor == free.rotor)
    assert np.all(free.position.components == 0)
    with pytest.raises(TypeError, match="Body"):
        ph.simulate(ASYMMETRIC, state, t, force=[1, 0, 0])
