"""Torques that a table holds from each time to the next: steps end at the jumps, each on its own side."""

import numpy as np
import pytest
from scipy.interpolate import interp1d

import polhode as ph
from motions import EPS, R0

BODY = ph.Inertia.from_matrix([[2.0, 0.1, 0.2], [0.1, 3.0, -0.3], [0.2, -0.3, 2.5]])
START = ph.State(R0, [0.3, -0.5, 1.0])
# Binary fractions, so that the sums of a loop are these times.
DT = 0.125
TIMES = DT * np.arange(17)
ROWS = np.random.default_rng(3).standard_normal((17, 3))
# The stages of yoshida4 lie beyond both ends of a step.
METHODS = ["rk4", "dop853", "strang", "yoshida4", "kahan_li8", "midpoint", "dmv"]


def held(times=TIMES, rows=ROWS, frame="body"):
    return ph.torque.tabulated(times, rows, frame, kind="previous")


def difference(a, b):
    return max(float(np.max((a.rotor - b.rotor).norm())), float(np.max((a.omega_body - b.omega_body).norm())))


def piecewise(body, state, times, rows=ROWS, law=ph.torque.constant_body, **options):
    """The states at the times of a table, by a run for each of its rows."""
    states = []
    for time, row in zip(times[1:], rows, strict=False):
        state = ph.simulate(body, state, [time], law(row), **options).final
        states.append(state)
    return states


def test_the_torque_is_that_of_scipy():
    law, expected = held(), interp1d(TIMES, ROWS, kind="previous", axis=0)
    for t in [*TIMES, *(TIMES[:-1] + 0.3 * DT), *np.nextafter(TIMES[1:], 0)]:
        # Rounded by the turn to the principal axes and back.
        np.testing.assert_allclose(law.at(BODY, START, t).components, expected(t), rtol=0, atol=20 * EPS)
    with pytest.raises(ValueError, match=r"spans 0 s to 2 s"):
        law.at(BODY, START, 2.01)
    assert "kind='previous'" in repr(law)


@pytest.mark.parametrize("frame", ["body", "space"])
@pytest.mark.parametrize("method", METHODS)
def test_the_motion_is_that_of_a_loop_that_holds_each_torque(method, frame):
    loop = ph.Stepper(BODY, START, method=method)
    states = [loop.step(DT, torque=row, frame=frame) for row in ROWS[:-1]]
    motion = ph.simulate(BODY, START, TIMES[1:], held(frame=frame), method=method, step=DT)
    assert motion.certificate.steps == len(states)
    for k, state in enumerate(states):
        found = ph.State(motion.rotor[k], motion.omega_body[k], time=motion.time[k])
        # Each of sixteen steps rounds by a few ulps; the solver of the midpoint rule by some dozens.
        assert difference(found, state) <= (2000 if method in ("midpoint", "dmv") else 200) * EPS


@pytest.mark.parametrize("backwards", [False, True])
def test_about_one_axis_it_is_the_closed_form(backwards):
    # The rate is linear and the angle quadratic between the times; the start lies between two of them.
    inertia, rate, begin = ph.Inertia.from_principal_moments(3, 2, 4), 0.7, 0.9
    rows = np.array([2.0, -1.0, 0.0, 3.0, 5.0])
    times = np.array([0.0, 0.5, 0.75, 1.5, 2.0])
    law = held(times, np.stack([0 * rows, 0 * rows, rows], axis=1))
    when = np.linspace(0.0, begin, 7) if backwards else np.linspace(begin, 2.0, 7)
    state = ph.State(ph.Rotor.identity(), [0, 0, rate], time=begin)
    motion = ph.simulate(inertia, state, when, law)
    # Integrals of the piecewise constant acceleration and of the piecewise linear rate.
    speeds = np.concatenate([[0], np.cumsum(rows[:-1] / 4 * np.diff(times))])

    def speed(t):
        return np.interp(t, times, speeds)

    def angle(t):
        knots = np.unique([0.0, *times[times < t], t])
        return float(np.sum(0.5 * (speed(knots[1:]) + speed(knots[:-1])) * np.diff(knots)))

    omega = rate + speed(when) - speed(begin)
    turned = np.array(
        [rate * (t - begin) + angle(t) - angle(begin) - speed(begin) * (t - begin) for t in when]
    )
    np.testing.assert_allclose(motion.omega_body.components[:, 2], omega, atol=20 * EPS, rtol=0)
    expected = ph.Rotor.from_rotation_vector(np.stack([0 * turned, 0 * turned, turned], axis=1))
    assert float(np.max((motion.rotor - expected).norm())) <= 50 * EPS


def test_free_pieces_are_the_closed_form():
    law = held([0.0, 1.0, 2.0], np.array([[0, 0, 0.0], [0.4, -0.2, 0.1], [0, 0, 0]]))
    motion = ph.simulate(BODY, START, [0.4, 1.0], law)
    free = ph.FreeMotion(BODY, R0, START.omega_body)
    for k, t in enumerate(motion.time):
        assert difference(free.at(t), ph.State(motion.rotor[k], motion.omega_body[k])) <= 1e-12


@pytest.mark.parametrize(("method", "order"), [("strang", 2), ("rk4", 4), ("kahan_li6", 6), ("dop853", 8)])
def test_methods_keep_their_order(method, order):
    # Steps across a jump would have order 1. Times that no equal step meets.
    times = np.array([0.0, 0.3, 1.1, 1.7, 3.1])
    law = held(times, 4 * ROWS[:5])
    exact = piecewise(BODY, START, times, 4 * ROWS, rtol=1e-12)[-1]
    errors = [
        difference(ph.simulate(BODY, START, [3.1], law, method=method, step=step).final, exact)
        for step in (0.1, 0.05)
    ]
    # Errors beyond the leading one change the slope by some tenths.
    assert np.log2(errors[0] / errors[1]) > order - 0.6


def test_the_error_estimate_is_honest():
    times = np.array([0.0, 0.3, 1.1, 1.7, 3.1, 9.0])
    exact = piecewise(BODY, START, times, 4 * ROWS, rtol=1e-12)
    for rtol in (1e-6, 1e-9):
        motion = ph.simulate(BODY, START, times[1:], held(times, 4 * ROWS[:6]), rtol=rtol)
        fastest = float(np.max(motion.omega_body.norm()))
        for k, state in enumerate(exact):
            turn = float((motion.rotor[k] - state.rotor).norm())
            spin = float((motion.omega_body[k] - state.omega_body).norm()) / fastest
            assert max(turn, spin) <= motion.certificate.error_estimate <= rtol


@pytest.mark.parametrize("options", [{}, {"method": "rk4", "step": 0.05}, {"method": "strang", "step": 0.05}])
def test_batches_move_as_single_bodies(options):
    when = np.array([0.2, 0.25, 1.0, 2.0])
    spins = np.random.default_rng(5).standard_normal((5, 3))
    many = ph.simulate(BODY, ph.State(R0, spins), when, held(), **options)
    assert many.ok.all()
    for k, spin in enumerate(spins):
        one = ph.simulate(BODY, ph.State(R0, spin), when, held(), **options)
        # Equal steps agree to rounding, others to the tolerance.
        bound = 1000 * EPS if options else 1e-9
        assert float(np.max((many.rotor[k] - one.rotor).norm())) <= bound
        assert float(np.max((many.omega_body[k] - one.omega_body).norm())) <= bound


@pytest.mark.parametrize("bodies", [1, 3])
def test_a_stepper_ends_its_steps_at_the_jumps(bodies):
    # Three steps across sixteen jumps.
    start = START if bodies == 1 else ph.State(R0, np.tile(START.omega_body.components, (bodies, 1)))
    stepper = ph.Stepper(BODY, start, held(), step=DT / 8)
    motion = ph.simulate(BODY, START, [0.7, 1.4, 2.0], held(), method="rk4", step=DT / 8)
    for k, dt in enumerate([0.7, 0.7, 0.6]):
        found = stepper.step(dt)
        assert float(np.max((found.rotor - motion.rotor[k]).norm())) <= 1e-8
        assert float(np.max((found.omega_body - motion.omega_body[k]).norm())) <= 1e-8


def test_an_event_after_a_jump_is_found_where_the_closed_form_has_it():
    # At rest up to 0.5, then the rate is t - 0.5.
    inertia = ph.Inertia.from_principal_moments(1, 1, 1)
    law = held([0.0, 0.5, 2.0], [[0, 0, 0], [0, 0, 1], [0, 0, 0]])
    event = ph.event.spin(ph.e1 ^ ph.e2, 0.25)
    motion = ph.simulate(inertia, ph.State(ph.Rotor.identity(), [0, 0, 0]), [2.0], law, events=event)
    np.testing.assert_allclose(motion.events[0].time, [0.75], atol=1e-12, rtol=0)
