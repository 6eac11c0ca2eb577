"""Events: times against closed forms, completeness, and terminal events."""

import math

import mpmath
import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, EPS, METHODS, R0, START, moments, random_walk

E = ph.event
IDENTITY = ph.Rotor.identity()
BALL = ph.Body.sphere(0.5, mass=2.0)
G = 9.81


def ball(position=(0, 0, 0), velocity=(0, 0, 0), omega=(0, 0, 0)):
    return ph.State(IDENTITY, omega, ph.vector(position), ph.vector(velocity))


# --- times in closed form


@pytest.mark.parametrize("method", ["auto", "kahan_li8", "dop853"])
def test_a_t_handle_flips_every_half_period(method):
    """Between zeros of the middle component of ω lie 2K/λ."""
    rate = np.array([0.01, 1.0, 0.01])
    state = ph.State(IDENTITY, rate)
    half = ph.FreeMotion(ASYMMETRIC, state.rotor, state.omega_body).describe()["flip_time"]
    event = E.spin(ph.e3 ^ ph.e1)
    motion = ph.simulate(ASYMMETRIC, state, [-150.0, 200.0], method=method, events=event, rtol=1e-8)
    (flips,) = motion.events
    times = np.sort(flips.time)
    assert len(times) == 18
    # λ times the time is log(4/k') and k' is 0.01: errors of energy and momentum count 10⁴ times, roundings
    # of steps among them.
    steps = motion.certificate.steps
    estimate = (motion.certificate.error_estimate or 0.0) + random_walk(steps)
    tolerance = 4 * EPS * 200 + 1e4 * (estimate if steps else 0.0)
    np.testing.assert_allclose(np.diff(times), half, rtol=0, atol=tolerance)
    assert np.all(np.diff(flips.rising[flips.time > 0].astype(int)) != 0)
    assert np.abs(flips.omega_body.components[:, 1]).max() <= tolerance


def test_a_pendulum_passes_its_lowest_point_at_quarters_of_its_period():
    """From rest at the angle a: at (2n + 1) K(sin ½a)/w, w² = c/i."""
    c, angle = 3.0, 2.5
    inertia = moments(2, 1.5, 1)
    quarter = float(mpmath.ellipk(mpmath.sin(mpmath.mpf(angle) / 2) ** 2)) / math.sqrt(c / 2)
    # Turned by the angle about e1 from hanging: the centre of mass along e3 of the body hangs down.
    hanging = ph.Rotor.from_plane_angle(ph.e2 ^ ph.e3, np.pi + angle)
    motion = ph.simulate(
        inertia,
        ph.State(hanging, [0, 0, 0]),
        [30.0],
        ph.torque.heavy([0, 0, c]),
        events=[E.plane(ph.e3, ph.e2), E.spin(ph.e2 ^ ph.e3)],
    )
    lowest, turning = motion.events
    count = len(lowest)
    assert count == int((30.0 / quarter + 1) // 2)
    tolerance = 30 * motion.certificate.error_estimate
    np.testing.assert_allclose(lowest.time, quarter * (2 * np.arange(count) + 1), rtol=0, atol=tolerance)
    expected = quarter * 2 * np.arange(1, len(turning) + 1)
    np.testing.assert_allclose(turning.time, expected, rtol=0, atol=tolerance)
    assert list(lowest.rising) == [k % 2 == (0 if lowest.rising[0] else 1) for k in range(count)]


def test_a_lagrange_top_turns_every_half_nutation():
    """u = cos θ turns where ``u' = 0``: ``u' = ((R e3 ~R)·Ω_S)·e3`` but for the sign."""
    inertia, c = moments(1, 1, 0.5), [0, 0, 2.0]
    state = ph.State(ph.Rotor.from_components([4, 2, 1, 0]), [0.25, -0.5, 6])
    top = ph.LagrangeTop(inertia, state.rotor, state.omega_body, c).describe()
    events = [
        E.formula("((R e3 ~R)·Ω_S)·e3"),
        E.angle(ph.e3, ph.e3, 0.5 * (top["tilt_min"] + top["tilt_max"])),
    ]
    motion = ph.simulate(inertia, state, [-20.0, 40.0], ph.torque.heavy(c), events=events)
    assert motion.certificate.method == "exact"
    turns, _ = motion.events
    times = np.sort(turns.time)
    half = 0.5 * top["nutation_period"]
    # It starts at a turn, which does not count.
    assert len(times) == int(40 / half) + int(20 / half) == 43
    times = np.sort(np.append(times, 0.0))
    # u'' is 0.2 and u' is known to 6 rad/s times a few ulp.
    np.testing.assert_allclose(np.diff(times), half, rtol=0, atol=6 / 0.2 * 32 * EPS)
    tilt = np.arccos((turns.rotor(ph.e3) | ph.e3).components[:, 0])
    ends = np.array([top["tilt_min"], top["tilt_max"]])
    assert np.abs(tilt[:, None] - ends).min(axis=1).max() <= 32 * EPS


def test_two_close_crossings_of_an_angle_are_found():
    """Two crossings as close as √ε, which samples 0.2 rad apart miss."""
    inertia, c = moments(1, 1, 0.5), [0, 0, 2.0]
    state = ph.State(ph.Rotor.from_components([4, 2, 1, 0]), [0.25, -0.5, 6])
    top = ph.LagrangeTop(inertia, state.rotor, state.omega_body, c).describe()
    whole = top["nutation_period"]
    for method in ("auto", "rkn6", "dop853"):
        for depth in (1e-4, 1e-6):
            events = [
                E.angle(ph.e3, ph.e3, top["tilt_min"] + depth, direction=1),
                E.angle(ph.e3, ph.e3, top["tilt_min"] + depth),
                E.angle(ph.e3, ph.e3, top["tilt_min"] - depth),
                E.angle(ph.e3, ph.e3, top["tilt_max"] - depth),
                E.angle(ph.e3, ph.e3, top["tilt_max"] + depth),
            ]
            motion = ph.simulate(
                inertia, state, [10 * whole], ph.torque.heavy(c), method=method, events=events
            )
            assert [len(event) for event in motion.events] == [10, 20, 0, 20, 0]


def test_a_damped_sphere_reaches_a_rate_at_its_time():
    """``|ω| = ω0 exp(−g t)``; the sphere of a quadratic damper ``ω0/(1 + k ω0 t/i)``."""
    sphere, g, rate = moments(2, 2, 2), 0.25, 8.0
    state = ph.State(IDENTITY, [0, 0, rate])
    event = E.spin(ph.e1 ^ ph.e2, 1.0)
    motion = ph.simulate(sphere, state, [30.0], ph.torque.damping(g), events=event)
    assert motion.events[0].time[0] == pytest.approx(math.log(8) / g, rel=8 * EPS)
    motion = ph.simulate(sphere, state, [30.0], ph.torque.quadratic_damping(0.5), events=event)
    (time,) = motion.events[0].time
    assert time == pytest.approx(2 * (1 - 1 / rate) / 0.5, rel=10 * motion.certificate.error_estimate)


@pytest.mark.parametrize("torque", [None, ph.torque.constant_space([0.5, 0, 0])], ids=["exact", "stepped"])
@pytest.mark.parametrize("below", [1e-9, 1e-3, 1.0, 5.0])
def test_a_ball_passes_a_height_twice(torque, below):
    """At any distance below its top, without rotation: at ``v/g ± √(2d/g)``."""
    top = 10.0**2 / (2 * G)
    motion = ph.simulate(
        BALL,
        ball(velocity=[1, 0, 10.0]),
        [3.0],
        torque,
        [0, 0, -2.0 * G],
        events=[E.position(ph.e3, top - below), E.position(ph.e3, top + below), E.formula("v·e3")],
    )
    passed, missed, highest = motion.events
    apart = math.sqrt(2 * below / G)
    expected = [10 / G - apart, 10 / G + apart]
    # The height is known to an ulp of its terms, ten metres, and divided by the speed g √(2d/g).
    np.testing.assert_allclose(passed.time, expected, rtol=0, atol=8 * EPS + 8 * 10 * EPS / (G * apart))
    assert list(passed.rising) == [True, False]
    assert len(missed) == 0
    assert highest.time == pytest.approx([10 / G], rel=4 * EPS)


def test_a_planet_passes_its_apsides_and_nodes():
    """``x·v = 0`` every half period; the nodes are there, too, as the axis of the apsides is level."""
    mu, e = 2.0, 0.6
    period = 2 * math.pi / math.sqrt(mu)
    speed = math.sqrt(mu * (1 + e) / (1 - e))
    state = ball([1 - e, 0, 0], [0, 0.6 * speed, 0.8 * speed])
    events = [E.formula("x·v"), E.position(ph.e3)]
    motion = ph.simulate(BALL, state, [5.25 * period], force=ph.force.central(mu), events=events)
    tolerance = 1000 * motion.certificate.error_estimate
    for event in motion.events:
        # It is already there at time 0.
        np.testing.assert_allclose(event.time, 0.5 * period * np.arange(1, 11), rtol=0, atol=tolerance)


# --- completeness


FORMULAS = ["(R e1 ~R)·e3 - 0.3", "Ω_B·(e2e3) + 0.2", "(R e1 ~R)·e2 (R e2 ~R)·e3", "norm(Ω_S) - 1.16"]


@pytest.mark.parametrize(
    ("method", "torque", "step"),
    [
        ("auto", None, None),
        *[(method, None, {2: 0.05, 4: 0.125}.get(METHODS[method], 0.5)) for method in METHODS],
        ("auto", ph.torque.heavy([0.5, 0.25, 1.0]), None),
        ("dop853", ph.torque.heavy([0.5, 0.25, 1.0]), None),
    ],
)
def test_events_agree_with_dense_sampling(method, torque, step):
    """Changes of sign between 40,000 samples are the events."""
    times = [-15.0, 25.0]
    events = [E.formula(text) for text in FORMULAS]
    motion = ph.simulate(ASYMMETRIC, START, times, torque, method=method, step=step, events=events)
    t = np.linspace(*times, 40001)
    seen = ph.simulate(ASYMMETRIC, START, t, torque, method="dop853" if torque else "auto")
    R, B = seen.rotor, seen.omega_body
    for text, event in zip(FORMULAS, motion.events, strict=True):
        values = ph.evaluate(text, R=R, Ω_B=B, Ω_S=R(B)).components[:, 0]
        changes = np.flatnonzero(np.sign(values[:-1]) != np.sign(values[1:]))
        found = np.sort(event.time)
        assert len(found) == len(changes) > 3
        # The methods' own errors with such steps, much less than the time between two events.
        slack = {2: 0.2, 4: 0.1, 6: 1e-2, 8: 1e-3}[METHODS[method]] if step else 1e-9
        assert np.all((found >= t[changes] - slack) & (found <= t[changes + 1] + slack))


def test_events_do_not_depend_on_body_axes():
    turn = ph.Rotor.from_components([1, 2, 3, 4])
    body = ph.Body(1.0, ASYMMETRIC)
    there = ph.State(START.rotor * ~turn, turn(START.omega_body))

    def events(axes):
        return [
            E.plane(axes(ph.e1), ph.e3),
            E.angle(axes(ph.e2), ph.e1, 1.0),
            E.spin(axes(ph.e2 ^ ph.e3), -0.2),
            E.formula("(R a ~R)·e3 + Ω_B·B + 1", a=axes(ph.e1), B=axes(ph.e1 ^ ph.e2)),
            E.formula("L·(e1e2) + Ω_B·I(Ω_B) L_B·B + 2.5", B=axes(ph.e1 ^ ph.e2)),
            E.function(lambda t, R, B, x, v: (R(axes(ph.e1)) | ph.e3) + (B | axes(ph.e1 ^ ph.e2)) + 1),
        ]

    one = ph.simulate(body, START, [20.0], events=events(lambda a: a))
    other = ph.simulate(body.moved(turn), there, [20.0], events=events(turn))
    for a, b in zip(one.events, other.events, strict=True):
        np.testing.assert_allclose(b.time, a.time, rtol=0, atol=2e-13)
        assert np.array_equal(a.rising, b.rising)
    for event in (one.events[3], other.events[3]):
        assert len(event) > 2
    np.testing.assert_allclose(one.events[3].time, one.events[5].time, rtol=0, atol=1e-13)


def test_a_zero_at_the_start_is_not_an_event():
    motion = ph.simulate(BALL, ball(velocity=[1, 0, 0]), [-1.0, 1.0], events=E.position(ph.e1, terminal=True))
    assert len(motion.events[0]) == 0
    assert len(motion.time) == 2


@pytest.mark.parametrize("method", ["auto", "kahan_li8", "dop853"])
def test_an_event_at_an_output_time_is_found_once(method):
    motion = ph.simulate(
        BALL,
        ball(velocity=[1, 0, 0], omega=[0, 0, 1]),
        [0.5, 1.0, 1.0, 1.5, 2.0],
        method=method,
        events=[E.position(ph.e1, 1.0), E.position(ph.e1, 2.0)],
    )
    assert list(motion.events[0].time) == [1.0]
    assert list(motion.events[1].time) == [2.0]


def test_several_events_in_one_step_come_in_order():
    events = [E.position(ph.e1, x) for x in (0.75, 0.25, 0.5)]
    events += [E.position(ph.e1, 0.6, terminal=True)]
    motion = ph.simulate(BALL, ball(velocity=[1, 0, 0]), [10.0], events=events)
    assert [list(event.time) for event in motion.events] == [[], [0.25], [0.5], [pytest.approx(0.6)]]
    which, _, _ = motion._motion.events()
    assert which == [1, 2, 3]


def test_across_a_break_of_a_table():
    """The torque of a sphere rises to a corner and falls: ω is two parabolas, through 1 at the corner."""
    law = ph.torque.tabulated([0, 1, 3], [[0, 0, 0], [0, 0, 2], [0, 0, -2]])
    sphere, state = moments(1, 1, 1), ph.State(IDENTITY, [0, 0, 0])
    events = [E.spin(ph.e1 ^ ph.e2, rate) for rate in (1.0, 0.25, 1.75)]
    motion = ph.simulate(sphere, state, [3.0], law, events=events)
    # ω = t² up to 1, and then 1 + 2(t−1) − (t−1)²; whether it is 1 at the end, at 3, depends on rounding.
    expected = [[1.0], [0.5], [1.5, 2.5]]
    for event, times in zip(motion.events, expected, strict=True):
        np.testing.assert_allclose(event.time[: len(times)], times, rtol=0, atol=1e-9)


# --- ends


def test_a_terminal_event_ends_its_side_of_time():
    times = [-3.0, -2.0, -0.5, 0.0, 0.5, 2.0, 3.0]
    state = ball(velocity=[1, 0, 0])
    event = E.position(ph.e1, 1.0, terminal=True)
    motion = ph.simulate(BALL, state, times, events=event)
    assert list(motion.time) == [-3.0, -2.0, -0.5, 0.0, 0.5]
    motion = ph.simulate(BALL, state, times, events=E.position(ph.e1, -1.0, terminal=True))
    assert list(motion.time) == [-0.5, 0.0, 0.5, 2.0, 3.0]
    assert list(motion.events[0].time) == [-1.0]
    # Followed back in time it falls through −1.
    assert list(motion.events[0].rising) == [False]
    both = ph.simulate(BALL, state, times, events=[event, E.position(ph.e1, -1.0, terminal=True)])
    assert list(both.time) == [-0.5, 0.0, 0.5]


def test_the_output_at_the_end_belongs_to_the_motion():
    motion = ph.simulate(
        BALL, ball(velocity=[1, 0, 0]), [0.5, 1.0, 1.5], events=E.position(ph.e1, 1.0, terminal=True)
    )
    assert list(motion.time) == [0.5, 1.0]


@pytest.mark.parametrize("method", ["kahan_li8", "dop853", "rk4"])
def test_the_end_is_as_accurate_as_outputs_are(method):
    """Though no output time comes before it, by which to measure the error."""
    inertia, torque = moments(1, 2, 2.5), ph.torque.heavy([0.5, 0.25, 1.0])
    event = E.angle(ph.e3, ph.e1, 0.6, terminal=True)
    given = {"times": [50.0], "torque": torque, "events": event}
    motion = ph.simulate(inertia, START, method=method, rtol=1e-9, **given)
    best = ph.simulate(inertia, START, method="kahan_li8", step=1 / 256, **given)
    assert len(motion.time) == len(best.time) == 0
    assert motion.certificate.error_estimate <= 1e-9
    assert motion.events[0].time[0] == pytest.approx(best.events[0].time[0], rel=0, abs=1e-8)


def test_directions_select_crossings():
    state = ph.State(R0, [0.25, -0.5, 1.0])
    both, rising, falling = (
        ph.simulate(ASYMMETRIC, state, [-9.0, 30.0], events=E.plane(ph.e1, ph.e3, direction=way)).events[0]
        for way in (0, 1, -1)
    )
    assert np.array_equal(both.time[both.rising], rising.time)
    assert np.array_equal(both.time[~both.rising], falling.time)
    assert len(rising) > 2
    assert np.all(rising.rising)
    assert not np.any(falling.rising)


@pytest.mark.parametrize("rate", [3, 30, 100, 300])
def test_formulas_of_time_that_oscillate_faster_than_the_body_lose_no_crossing(rate):
    ball = ph.Inertia.from_principal_moments(1, 1, 1)
    start = ph.State(ph.Rotor.identity(), [0, 0, 0.5])
    waves = ph.event.formula("sin(w t)", w=rate)
    found = ph.simulate(ball, start, [10.0], events=waves).events[0]
    expected = np.arange(1, int(10 * rate / np.pi) + 1) * np.pi / rate
    np.testing.assert_allclose(found.time, expected, rtol=1e-14, atol=1e-14)
    assert not found.rising[::2].any()
    assert found.rising[1::2].all()
