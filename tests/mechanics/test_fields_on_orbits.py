"""Fields along a Kepler orbit: the dipole of a planet, functions of the position, the gradient."""

import pickle

import mpmath
import numpy as np
import pytest
from scipy.optimize import brentq

import polhode as ph
from motions import EPS, R0

T = ph.torque
ORBIT = T.KeplerOrbit(7.2e6, 0.15, 0.4)
MOMENT = np.array([1e22, 2e22, -7.5e22])
BODY = ph.Inertia.from_matrix([[2.0, 0.1, 0.2], [0.1, 3.0, -0.3], [0.2, -0.3, 2.5]])
STATE = ph.State(R0, [0.01, -0.02, 0.015])


def place(orbit, t):
    """Kepler's equation by bisection."""
    mean = orbit.rate * t + orbit.mean_anomaly
    e = orbit.eccentricity
    E = brentq(lambda x: x - e * np.sin(x) - mean, mean - 1, mean + 1, xtol=1e-15)
    return orbit.semi_major_axis * np.array([np.cos(E) - e, np.sqrt(1 - e * e) * np.sin(E), 0])


def test_positions_are_those_of_kepler():
    times = np.array([[0.0, 100.0], [2000.0, -700.0]])
    found = ORBIT.position(times).components
    expected = [[place(ORBIT, t) for t in row] for row in times]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-14 * ORBIT.semi_major_axis * 10)
    circle = T.KeplerOrbit(7e6)
    assert (circle.position(0.0).components == [7e6, 0, 0]).all()
    np.testing.assert_allclose(circle.position(300.0).components, place(circle, 300.0), rtol=0, atol=1e-7)
    assert ORBIT.rate == pytest.approx(np.sqrt(ORBIT.mu / ORBIT.semi_major_axis**3), rel=4 * EPS)
    assert ORBIT.period == pytest.approx(2 * np.pi / ORBIT.rate, rel=4 * EPS)


@pytest.mark.parametrize("eccentricity", [0.0, 0.15, 0.9, 1 - 1e-6])
def test_velocities_have_the_energy_and_the_angular_momentum_of_the_orbit(eccentricity):
    orbit = T.KeplerOrbit(7.2e6, eccentricity, 0.4)
    a, mu = orbit.semi_major_axis, orbit.mu
    times = np.linspace(-1, 2, 50).reshape(2, 25) * orbit.period
    x, v = orbit.position(times).components, orbit.velocity(times).components
    r = np.linalg.norm(x, axis=-1)
    # Relative to the kinetic energy, which is much larger than the energy near the periapsis.
    np.testing.assert_allclose((v**2).sum(axis=-1), mu * (2 / r - 1 / a), rtol=1e-9)
    swept = np.cross(x, v)
    assert not swept[..., :2].any()
    np.testing.assert_allclose(swept[..., 2], np.sqrt(mu * a * (1 - eccentricity**2)), rtol=1e-9)
    assert orbit.velocity(0.0).shape == ()


@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-10, 1e-14])
@pytest.mark.parametrize("share", [0.01, 0.3, 0.45, 0.49])
def test_velocities_far_out_on_a_long_ellipse(gap, share):
    orbit = T.KeplerOrbit(1e7, 1 - gap)
    t = share * orbit.period
    with mpmath.workdps(40):
        e = mpmath.mpf(orbit.eccentricity)
        n = mpmath.sqrt(mpmath.mpf(orbit.mu) / mpmath.mpf(1e7) ** 3)
        E = mpmath.findroot(lambda E: E - e * mpmath.sin(E) - n * t, (0, mpmath.pi), solver="anderson")
        speed = n * mpmath.mpf(1e7) / (1 - e * mpmath.cos(E))
        expected = [-speed * mpmath.sin(E), speed * mpmath.sqrt(1 - e**2) * mpmath.cos(E)]
    x, y, _ = orbit.velocity(t).components
    # A rounding of the time changes the velocity by 1e-14 of it near the apoapsis.
    assert mpmath.hypot(x - expected[0], y - expected[1]) <= 1e-13 * mpmath.hypot(*expected)


def test_an_orbit_with_another_eccentricity_is_an_error():
    for own in ({"eccentricity": 0.5}, {"mean_anomaly": [1.0, 2.0]}):
        with pytest.raises(TypeError, match="leave these arguments out"):
            T.gravity_gradient(ORBIT, **own)


def test_the_field_of_a_dipole_is_a_gradient():
    # B = −∇φ with φ = μ0/4π M·x/r³, by central differences of step h: errors of (h/r)² and of rounding r/h.
    field = T.dipole_field(MOMENT)
    x, h = np.array([3e6, -5e6, 4e6]), 100.0

    def potential(y):
        return 1e-7 * MOMENT @ y / np.linalg.norm(y) ** 3

    expected = [-(potential(x + h * e) - potential(x - h * e)) / (2 * h) for e in np.eye(3)]
    np.testing.assert_allclose(
        field(0.0, x).components, expected, rtol=0, atol=1e-8 * np.linalg.norm(expected)
    )
    many = field(0.0, np.stack([x, 2 * x])).components
    np.testing.assert_allclose(many[0], 8 * many[1], rtol=8 * EPS)


def test_the_torque_is_that_of_the_field_at_the_place():
    dipole, field = [0.3, -1.0, 2.0], T.dipole_field(MOMENT)
    law = T.magnetic(dipole, field, orbit=ORBIT)
    for t in (0.0, 500.0, 3000.0):
        constant = T.magnetic(dipole, field(t, place(ORBIT, t)))
        expected = constant.at(BODY, STATE, t).components
        size = np.linalg.norm(expected)
        np.testing.assert_allclose(law.at(BODY, STATE, t).components, expected, rtol=0, atol=1e-13 * size)


def test_functions_of_the_position_are_fields():
    field = T.dipole_field(MOMENT)
    seen = []

    def own(t, position):
        seen.append((t, position))
        return field(t, position).components

    times = [0.0, 30.0, 60.0]
    dipole = [30.0, -100.0, 20.0]
    known = ph.simulate(BODY, STATE, times, T.magnetic(dipole, field, ORBIT) + T.gravity_gradient(ORBIT))
    found = ph.simulate(BODY, STATE, times, T.magnetic(dipole, own, ORBIT) + T.gravity_gradient(ORBIT))
    np.testing.assert_array_equal(found.rotor.components, known.rotor.components)
    t, position = seen[-1]
    np.testing.assert_array_equal(position.components, ORBIT.position(t).components)
    # The field of a short way is nearly constant: the motion differs by the way, 60 s * 1e-3 rad/s.
    still = ph.simulate(BODY, STATE, times, T.magnetic(dipole, field(0, ORBIT.position(0.0))))
    assert 1e-9 < float((still.rotor[-1] - known.rotor[-1]).norm()) < 0.1


def test_the_gradient_takes_the_orbit():
    assert T.gravity_gradient(ORBIT) == T.gravity_gradient(ORBIT.rate, 0.15, 0.4)


def test_a_stepper_and_a_batch_meet_the_field():
    law = T.magnetic([30.0, -100.0, 20.0], T.dipole_field(MOMENT), ORBIT)
    motion = ph.simulate(BODY, STATE, [10.0], law, rtol=1e-11)
    stepper = ph.Stepper(BODY, STATE, law, step=0.5)
    assert float((stepper.step(10.0).omega_body - motion.omega_body[0]).norm()) <= 1e-9
    many = ph.simulate(BODY, ph.State(R0, np.stack([STATE.omega_body.components] * 2)), [10.0], law)
    assert float(np.max((many.omega_body[:, 0] - motion.omega_body[0]).norm())) <= 1e-9


def test_laws_are_values():
    law = T.magnetic([1, 2, 3], T.dipole_field(MOMENT), ORBIT)
    assert law == T.magnetic([1, 2, 3], T.dipole_field(MOMENT), T.KeplerOrbit(7.2e6, 0.15, 0.4))
    assert pickle.loads(pickle.dumps(law)) == law
    assert "dipole_field" in repr(law)
    assert "KeplerOrbit(semi_major_axis=7200000.0" in repr(law)


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda: T.KeplerOrbit(-1.0), ValueError, "semi_major_axis is -1; it must be positive"),
        (lambda: T.KeplerOrbit(500e3), ValueError, "semi_major_axis is 500000 m, inside the Earth"),
        (lambda: T.KeplerOrbit(altitude=500e3), TypeError, "its arguments are"),
        (lambda: T.gravity_gradient(altitude=500e3), TypeError, "its arguments are"),
        (lambda: T.KeplerOrbit(7e6, 1.0), ValueError, "eccentricity is 1"),
        (lambda: T.KeplerOrbit(7e6, mu=np.inf), ValueError, "mu is inf"),
        (lambda: T.KeplerOrbit([7e6, 8e6]), TypeError, "semi_major_axis"),
        (lambda: T.KeplerOrbit(7e6, 0.1, "pi"), TypeError, "mean_anomaly"),
        (lambda: T.magnetic([1, 0, 0], T.dipole_field(MOMENT)), TypeError, "needs an orbit"),
        (lambda: T.magnetic([1, 0, 0], lambda t, x: x), TypeError, "needs an orbit"),
        (lambda: T.magnetic([1, 0, 0], [0, 0, 1], ORBIT), TypeError, "function of t and position"),
        (
            lambda: T.magnetic([1, 0, 0], T.dipole_field(MOMENT), 7e6),
            TypeError,
            "must be a KeplerOrbit, got float",
        ),
        (lambda: T.magnetic(np.eye(3), T.dipole_field(MOMENT), ORBIT), ValueError, "single vector"),
        (lambda: T.dipole_field(np.eye(3)), ValueError, "single vector"),
    ],
)
def test_invalid_input_raises(make, error, message):
    with pytest.raises(error, match=message):
        make()


def test_an_exception_of_a_field_passes_through():
    def broken(t, position):
        raise RuntimeError("no model there")

    with pytest.raises(RuntimeError, match="no model there"):
        ph.simulate(BODY, STATE, [1.0], T.magnetic([1, 0, 0], broken, ORBIT))
