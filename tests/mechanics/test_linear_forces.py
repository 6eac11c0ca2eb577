"""The centre of mass under constant forces, drag and springs is in closed form."""

import itertools

import mpmath
import numpy as np
import pytest

import polhode as ph
from motions import EPS, R0

F = ph.force
M = 2.0
BODY = ph.Body.box([1, 2, 3], mass=M)
X, V = np.array([1.0, 2.0, 3.0]), np.array([-1.0, 0.5, 0.25])
START = ph.State(R0, [0.25, -0.5, 1.0], position=X, velocity=V)
FORCE, ANCHOR = np.array([0.5, 0.0, -3.0]), np.array([0.5, -1.0, 2.0])


def linear(drag, stiffness):
    return F.constant(FORCE) + F.drag(drag) + F.spring(stiffness, ANCHOR)


def reference(drag, stiffness, t):
    """Position and velocity at a time, by the roots of the characteristic polynomial with 80 digits."""
    with mpmath.workdps(80):
        t, half, k = mpmath.mpf(t), mpmath.mpf(drag) / M / 2, mpmath.mpf(stiffness) / M
        root = mpmath.sqrt(mpmath.mpc(half**2 - k))
        upper, lower = mpmath.exp((root - half) * t), mpmath.exp((-root - half) * t)
        if root == 0:
            s, ds = t * upper, upper * (1 - half * t)
        else:
            s = (upper - lower) / (2 * root)
            ds = ((root - half) * upper + (root + half) * lower) / (2 * root)
        resting = (t - s) / (2 * half) if half else t**2 / 2
        q = (1 - ds - 2 * half * s) / k if k else resting
        ends = []
        for x, v, f, a in zip(X, V, FORCE, ANCHOR, strict=True):
            pull = mpmath.mpf(f) / M - k * (mpmath.mpf(x) - mpmath.mpf(a))
            ends.append([mpmath.re(x + v * s + pull * q), mpmath.re(v * ds + pull * s)])
        return np.array(ends).T


# None, weak, oscillating, critical within a few roundings, strong and stiff; and of the other sign.
CRITICAL = [(4.0, 2.0 * (1 + d)) for d in (0.0, EPS, -4 * EPS, 1e-12, -1e-9, 1e-5, -0.03)]
LAWS = [*itertools.product([0.0, 1e-9, 0.5, 30.0, 1e9], [0.0, 1e-12, 3.0, 1e4]), *CRITICAL]
GROWING = [(-0.5, 0.0), (0.0, -3.0), (0.5, -3.0), (-0.5, 3.0), (-4.0, 2.0), (-30.0, -1e-3)]


@pytest.mark.parametrize(("drag", "stiffness"), [*LAWS, *GROWING])
def test_motion_agrees_with_80_digits(drag, stiffness):
    """A few roundings of the largest position and velocity on the way."""
    fastest = max(abs(drag) / M, np.sqrt(abs(stiffness) / M), 1e-3)
    # About the longest time of the series too.
    times = np.array([0.01, 0.3, 1.99, 2.0, 2.01, 5.0, 20.0]) / fastest
    times = np.sort([*times, *(-times[:5])])
    motion = ph.simulate(BODY, START, times, force=linear(drag, stiffness))
    assert motion.certificate.method == "exact"
    for side in (times < 0, times > 0):
        place, speed = np.linalg.norm(X) + np.linalg.norm(ANCHOR), np.linalg.norm(V)
        for k in sorted(np.flatnonzero(side), key=lambda k: abs(times[k])):
            x, v = reference(drag, stiffness, times[k])
            place = max(place, float(max(map(abs, x))), speed * min(abs(times[k]), 1 / fastest))
            speed = max(speed, float(max(map(abs, v))))
            apart = float(max(abs(x - motion.position.components[k])))
            assert apart <= 16 * EPS * place, (times[k], apart / place / EPS)
            # A force f over the time 1/λ of a decay, each a rounding.
            size = speed + fastest * place * min(fastest * abs(times[k]), 1)
            apart = float(max(abs(v - motion.velocity.components[k])))
            assert apart <= 16 * EPS * size, (times[k], apart / size / EPS)


@pytest.mark.parametrize("t", [1e6, 1e12])
def test_phase_of_a_spring_is_kept(t):
    motion = ph.simulate(BODY, START, [t], force=linear(0.0, 3.0))
    x, v = reference(0.0, 3.0, t)
    assert float(max(abs(x - motion.position.components[0]))) <= 32 * EPS
    assert float(max(abs(v - motion.velocity.components[0]))) <= 32 * EPS


@pytest.mark.parametrize("drag", [0.5, 1e9])
@pytest.mark.parametrize(
    "torque",
    [ph.torque.damping(0.5), ph.torque.constant_space([0, 0.25, 0.5]), ph.torque.viscous_damping(0.1)],
    ids=["exact", "splitting", "dop853"],
)
def test_torques_do_not_change_it(torque, drag):
    times = np.linspace(0, 4, 11)
    alone = ph.simulate(BODY, START, times, force=linear(drag, 3.0))
    turning = ph.simulate(BODY, START, times, torque, linear(drag, 3.0))
    assert np.array_equal(alone.position.components, turning.position.components)
    assert np.array_equal(alone.velocity.components, turning.velocity.components)
    assert turning.certificate.steps < 1000


def test_growth_beyond_the_range_of_numbers_is_an_error():
    with pytest.raises(ValueError, match="infinite at t = 2"):
        ph.simulate(BODY, START, [2000.0], force=F.drag(-2))
    states = ph.State(ph.Rotor.identity(2), np.ones((2, 3)), velocity=ph.vector([[0, 0, 0], V]))
    motion = ph.simulate(BODY, states, [1.0, 2000.0], force=F.drag(-2))
    assert motion.ok.tolist() == [True, False]


@pytest.mark.parametrize(
    "how", [{}, {"method": "rk4", "step": 0.125}, {"torque": ph.torque.viscous_damping(0.1)}]
)
def test_bodies_of_a_batch_move_as_alone(how):
    rng = np.random.default_rng(5)
    places, speeds = rng.normal(size=(2, 20, 3))
    bodies = [ph.Body(mass, BODY.inertia) for mass in rng.uniform(0.1, 3, 20)]
    states = ph.State(R0, np.ones((20, 3)), position=ph.vector(places), velocity=ph.vector(speeds), time=0.5)
    times = [-1.0, 0.7, 3.0]
    motion = ph.simulate(bodies, states, times, force=linear(0.5, 2.0), **how)
    for k in (0, 19):
        one = ph.State(R0, np.ones(3), position=places[k], velocity=speeds[k], time=0.5)
        alone = ph.simulate(bodies[k], one, times, force=linear(0.5, 2.0), **how)
        assert np.array_equal(motion[k].position.components, alone.position.components)
        assert np.array_equal(motion[k].velocity.components, alone.velocity.components)


@pytest.mark.parametrize("batch", [(), (9,)])
def test_steppers_follow_it(batch):
    state = ph.State(
        ph.Rotor.identity(batch), np.ones((*batch, 3)), position=ph.vector(X), velocity=ph.vector(V)
    )
    stepper = ph.Stepper(BODY, state, force=linear(0.5, 3.0), method="rk4")
    for _ in range(8):
        found = stepper.step(0.25)
    x, v = reference(0.5, 3.0, 2.0)
    # Eight steps of a few roundings.
    assert np.abs(found.position.components - x.astype(float)).max() <= 64 * EPS
    assert np.abs(found.velocity.components - v.astype(float)).max() <= 64 * EPS


def test_events_of_a_fast_spring_on_a_slow_body():
    """The body turns by 1e-3 rad while it passes the anchor 64 times, every π √(m/k)."""
    state = ph.State(R0, [0, 0, 1e-4], position=[1, 0, 0])
    passed = ph.event.formula("x·e1")
    rate = 20.0
    motion = ph.simulate(BODY, state, [10.0], force=F.spring(M * rate**2), events=passed)
    expected = np.pi / rate * (np.arange(64) + 0.5)
    found = motion.events[0].time
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_events_of_a_stiff_drag():
    """It sinks with the speed F/k at once, and reaches −1 m at 2 s."""
    passed = ph.event.position(ph.e3, -1.0)
    state = ph.State(R0, [0, 0, 1e-3], velocity=[0, 0, 1])
    for torque in (None, ph.torque.viscous_damping(0.1)):
        motion = ph.simulate(BODY, state, [10.0], torque, -5e8 * ph.e3 + F.drag(1e9), events=passed)
        np.testing.assert_allclose(motion.events[0].time, [2.0], rtol=1e-8)
        assert motion.certificate.steps < 1000


def test_events_of_a_decaying_oscillation():
    """Every π/ω, down to the smallest numbers."""
    drag, stiffness, end = 50.0, 800.0, 20.0
    state = ph.State(R0, [0, 0, 1e-3], position=[1, 0, 0])
    omega = np.sqrt(stiffness / M - (drag / M / 2) ** 2)
    first = np.pi - np.arctan(omega / (drag / M / 2))
    for torque in (None, ph.torque.viscous_damping(0.1)):
        force = F.drag(drag) + F.spring(stiffness)
        motion = ph.simulate(BODY, state, [end], torque, force, events=ph.event.position(ph.e1))
        expected = (first + np.pi * np.arange(200)) / omega
        np.testing.assert_allclose(motion.events[0].time, expected[expected < end], rtol=1e-11)


def test_events_do_not_shorten_a_given_step():
    state = ph.State(R0, [0, 0, 1e-3], position=[1, 0, 0])
    passed = ph.event.position(ph.e1)
    motion = ph.simulate(BODY, state, [10.0], None, F.spring(800), method="rk4", step=0.5, events=passed)
    assert motion.certificate.step == 0.5
    np.testing.assert_allclose(motion.events[0].time, np.pi / 20 * (np.arange(64) + 0.5), rtol=1e-12)


def test_a_phase_beyond_double_precision_is_an_error():
    for torque in (None, ph.torque.viscous_damping(0.1)):
        with pytest.raises(ValueError, match=r"times\[1\] = 1e3 s .* phase of the motion"):
            ph.simulate(BODY, START, [0.0, 1e3], torque, F.spring(2e40))


def test_a_body_at_rest_at_its_anchor_stays():
    anchor = np.array([1e7 / 3, -2e-9, 1e20 / 7])
    state = ph.State(R0, [0, 0, 1], position=anchor)
    motion = ph.simulate(BODY, state, [0.1, 7.0], force=F.spring(7.146e7, anchor))
    assert np.array_equal(motion.position.components, [anchor, anchor])
    assert not motion.velocity.components.any()


def test_a_stepper_raises_where_the_centre_becomes_infinite():
    stepper = ph.Stepper(BODY, START, force=F.drag(-2e4))
    with pytest.raises(ValueError, match=r"infinite at t = 0\.5"):
        stepper.step(0.5)
    assert stepper.state == START


@pytest.mark.parametrize(
    "how", [{}, {"torque": ph.torque.viscous_damping(0.1)}, {"method": "rk4", "step": 5.0}]
)
def test_events_of_a_slow_turn_after_a_fast_decay(how):
    """It rises to (v + w)/γ − w t, and passes the level on both sides of the top, long after the start."""
    gamma, w, v = 5.0, 0.01, 10.0
    state = ph.State(R0, [0, 0, 1e-4], velocity=[0, 0, v])
    passed = ph.event.position(ph.e3, 1.98)
    force = F.drag(gamma * M) - w * gamma * M * ph.e3
    found = ph.simulate(BODY, state, [5.0], force=force, events=passed, **how).events[0]

    def above(t):
        return (v + w) / gamma * -mpmath.expm1(-gamma * t) - w * t - mpmath.mpf("1.98")

    with mpmath.workdps(30):
        expected = [float(mpmath.findroot(above, guess)) for guess in (1.0, 2.1)]
    np.testing.assert_allclose(found.time, expected, rtol=1e-10)
    assert found.rising.tolist() == [True, False]


def test_events_of_an_oscillation_that_ends():
    """Nothing is left of it after 1,500 decays, nor of a growth that starts from nothing."""
    passed = ph.event.position(ph.e1, -0.1)
    swinging = ph.State(R0, [0, 0, 1e-3], position=[1, 0, 0])
    motion = ph.simulate(BODY, swinging, [1e7], force=F.spring(1e6) + F.drag(1e3), events=passed)
    assert len(motion.events[0].time) == 2
    resting = ph.State(R0, [0, 0, 1])
    assert not len(ph.simulate(BODY, resting, [100.0], force=F.drag(-1e7), events=passed).events[0].time)


def test_too_many_oscillations_are_an_error():
    state = ph.State(R0, [0, 0, 1e-3], position=[1, 0, 0])
    with pytest.raises(ValueError, match="more than max_steps = 1e8"):
        ph.simulate(BODY, state, [1e4], force=F.spring(1e9), events=ph.event.position(ph.e1))


def test_springs_with_one_anchor_keep_a_body_there():
    anchor = np.array([1e7 / 3, -2e-9, 1e5 / 7])
    state = ph.State(R0, [0, 0, 1], position=anchor)
    motion = ph.simulate(BODY, state, [7.0], force=F.spring(0.1, anchor) + F.spring(0.2, anchor))
    assert np.array_equal(motion.position.components, [anchor])
    ends = [F.spring(0.5, [1, 2, 3]) + F.spring(1.5, [0, -1, 4]), F.spring(2.0, [0.25, -0.25, 3.75])]
    one, other = (ph.simulate(BODY, START, [2.0], force=force).position.components for force in ends)
    np.testing.assert_allclose(one, other, rtol=0, atol=32 * EPS)
    ends = [F.spring(0.5, [1, 2, 3]) + F.spring(-0.5, [0, -1, 4]), F.constant([0.5, 1.5, -0.5])]
    one, other = (ph.simulate(BODY, START, [2.0], force=force).position.components for force in ends)
    np.testing.assert_allclose(one, other, rtol=0, atol=32 * EPS)
