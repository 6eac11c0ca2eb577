"""Forces that depend on time are sampled before a run, as torques are."""

import numpy as np
import pytest

import polhode as ph

BALL = ph.Body.sphere(0.1, mass=1)
REST = ph.State(ph.Rotor.identity(), [0, 0, 0])
SLOW = ph.State(ph.Rotor.identity(), [0, 0, 0.01])
WIDTH, AREA = 0.1, 0.4
HEIGHT = AREA / (WIDTH * np.sqrt(np.pi))  # of a Gaussian pulse in N, with its impulse AREA in N s


@pytest.mark.parametrize("start", [REST, SLOW])
@pytest.mark.parametrize("direction", [1, -1])
def test_a_short_pulse_of_a_formula_is_not_missed(start, direction):
    push = ph.force.formula("A exp(-((t-P)/s)²) e1", A=HEIGHT, P=37.0 * direction, s=WIDTH)
    moved = ph.simulate(BALL, start, [100.0 * direction], force=push)
    error = np.abs(moved.velocity.components[-1] - [AREA * direction, 0, 0]).max()
    assert error <= 1e-10
    assert error <= 3 * moved.certificate.error_estimate * AREA


def test_a_short_pulse_of_a_function_is_not_missed():
    push = ph.force.function(lambda t, x, v, R: HEIGHT * np.exp(-(((t - 37.0) / WIDTH) ** 2)) * ph.e1)
    moved = ph.simulate(BALL, SLOW, [100.0], force=push)
    assert np.abs(moved.velocity.components[-1] - [AREA, 0, 0]).max() <= 1e-10


def test_a_pulse_is_not_missed_in_a_batch():
    push = ph.force.formula("A exp(-((t-P)/s)²) e1", A=HEIGHT, P=37.0, s=WIDTH)
    starts = ph.State(ph.Rotor.identity(), [[0, 0, 0.01], [0, 0, 0.02]])
    moved = ph.simulate(BALL, starts, [100.0], force=push)
    assert np.abs(moved.velocity.components[:, -1] - [AREA, 0, 0]).max() <= 1e-10


@pytest.mark.parametrize(("k", "end", "number"), [(6.57, 0.5, 1000), (3.0, 2.0, 20)])
@pytest.mark.parametrize("rtol", [1e-4, 1e-6, 1e-10])
def test_estimates_of_forces_with_kinks_are_not_far_below_the_error(k, end, number, rtol):
    times = np.linspace(0, end, number + 1)
    push = ph.force.formula("norm(sin(k t) e1) e1", k=k)
    moved = ph.simulate(BALL, REST, times, force=push, method="dop853", rtol=rtol)
    # The integral of |sin(k t)|: 2 for each half turn.
    halves, rest = np.divmod(k * times, np.pi)
    speed = (2 * halves + 1 - np.cos(rest)) / k
    error = np.abs(moved.velocity["e1"] - speed).max() / speed.max()
    assert error <= rtol
    assert error <= 3 * moved.certificate.error_estimate


def test_a_force_that_is_too_fast_for_a_step_is_reported():
    push = ph.force.formula("sin(100 t) e1")
    with pytest.warns(RuntimeWarning, match=r"the force `sin\(100 t\) e1` changes too fast for step = 0.1 s"):
        ph.simulate(BALL, SLOW, [10.0], force=push, method="rk4", step=0.1)


@pytest.mark.parametrize("method", ["rk4", "strang", "midpoint"])
def test_a_stepper_takes_as_many_steps_as_a_simulation(method):
    """3 · 0.2 is rounded up, which does not add a step."""
    inertia, start = ph.Inertia.from_principal_moments(1, 2, 3), ph.State(ph.Rotor.identity(), [1, 0.3, 2])
    law, dt = ph.torque.heavy([0, 0.2, 1]), 3 * 0.2
    whole = ph.simulate(inertia, start, [dt], law, method=method, step=0.2)
    stepped = ph.Stepper(inertia, start, law, method=method, step=0.2).step(dt)
    assert whole.certificate.steps == 3
    assert np.abs(whole.omega_body.components[-1] - stepped.omega_body.components).max() <= 1e-14
    two = ph.State(start.rotor, [[1, 0.3, 2]] * 2)
    many = ph.simulate(inertia, two, [dt], law, method=method, step=0.2)
    assert np.abs(many.omega_body.components[:, -1] - stepped.omega_body.components).max() <= 1e-14


def test_a_body_at_rest_begins_to_move_when_its_force_starts():
    """Errors of its first steps are relative to the speed that the force causes, not to the speed so far."""
    body = ph.Body.sphere(0.1, mass=2)
    still = ph.State(ph.Rotor.identity(), [0, 0, 0], position=[0, 0, 0], velocity=[0, 0, 0])
    late = 7.123456
    switched = ph.force.function(lambda t, x, v, R: [float(t > late), 0, 0])
    ramp = ph.force.formula("(norm(t - s) + t - s)/2 e1", s=late)
    for breaks in ([late], []):
        motion = ph.simulate(body, still, [5, 10], force=switched, breaks=breaks)
        reached = motion.position.components[:, 0]
        assert reached[0] == 0
        assert abs(reached[1] - (10 - late) ** 2 / 4) <= 3 * motion.certificate.error_estimate * reached[1]
        motion = ph.simulate(body, still, [5, 10], force=ramp, breaks=breaks)
        reached = motion.position.components[:, 0]
        assert abs(reached[1] - (10 - late) ** 3 / 12) <= 3 * motion.certificate.error_estimate * reached[1]
    begun = ph.State(ph.Rotor.identity(), [0, 0, 0], time=1e6, position=[0, 0, 0], velocity=[0, 0, 0])
    motion = ph.simulate(body, begun, [1e6 + 2], force=ph.force.formula("(t - s) e1", s=1e6))
    assert motion.position.components[-1, 0] == pytest.approx(2**3 / 12, rel=1e-9)
