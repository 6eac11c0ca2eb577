"""`simulate`: times, steps, tolerances, invalid arguments, progress and interrupts."""

import signal
import sys
import time

import numpy as np
import pytest

import polhode as ph
import processes
from motions import ASYMMETRIC, EPS, METHODS, R0, SLOPES, START, STEPS, apart, random_walk

# --- times


def test_backward_and_forward_are_one_motion():
    """From the state at −T forward to +T is the motion itself."""
    t = np.linspace(-5, 5, 21)
    motion = ph.simulate(ASYMMETRIC, START, t, step=1 / 64)
    assert motion.rotor[10].is_close(R0, rtol=2 * EPS)
    early = ph.State(motion.rotor[0], motion.omega_body[0])
    again = ph.simulate(ASYMMETRIC, early, t + 5, step=1 / 64)
    assert apart(again, motion.rotor.components, motion.omega_body.components) <= 20 * random_walk(640)


@pytest.mark.parametrize("torque", [None, ph.torque.heavy([0.5, 0.25, 1.0])], ids=["free", "heavy"])
def test_output_times_do_not_change_the_motion(torque):
    """Times that start late, come in pairs, single and negative give the states they give alone."""
    at = [-3.0, -0.5, 0.0, 0.0, 2.5, 7.0, 7.0]
    together = ph.simulate(ASYMMETRIC, START, at, torque, method=STEPS)
    assert np.all(together.time == at)
    assert together.rotor[2] == together.rotor[3]
    assert together.rotor[5] == together.rotor[6]
    for k, t in enumerate(at):
        alone = ph.simulate(ASYMMETRIC, START, [t], torque, method=STEPS)
        assert alone.time.shape == (1,)
        rotors, omegas = together.rotor.components[[k]], together.omega_body.components[[k]]
        estimates = together.certificate.error_estimate + alone.certificate.error_estimate
        assert apart(alone, rotors, omegas) <= estimates + 50 * random_walk(300)


def test_output_times_do_not_change_the_exact_motion():
    at = [-3.0, -0.5, 0.0, 0.0, 2.5, 7.0, 7.0]
    together = ph.simulate(ASYMMETRIC, START, at)
    for k, t in enumerate(at):
        alone = ph.simulate(ASYMMETRIC, START, [t])
        assert alone.rotor[0] == together.rotor[k]
        assert alone.omega_body[0] == together.omega_body[k]


def test_no_times_make_an_empty_motion():
    motion = ph.simulate(ASYMMETRIC, START, [])
    assert motion.rotor.shape == (0,)
    assert motion.energy.shape == motion.time.shape == (0,)
    assert motion.momentum_space.shape == motion.position.shape == (0,)
    assert motion.to_xarray().sizes["time"] == 0
    assert "0 times" in repr(motion)


def test_the_state_at_time_zero_is_the_one_given():
    for method in METHODS:
        motion = ph.simulate(ASYMMETRIC, START, [0.0], method=method)
        assert motion.rotor[0].is_close(R0, rtol=2 * EPS)
        assert motion.omega_body[0] == START.omega_body
    # The exact solution goes through its elliptic functions and back.
    motion = ph.simulate(ASYMMETRIC, START, [0.0])
    assert motion.rotor[0].is_close(R0, rtol=8 * EPS)
    assert motion.omega_body[0].is_close(START.omega_body, rtol=8 * EPS)


def test_a_body_at_rest_stays():
    motion = ph.simulate(ASYMMETRIC, ph.State(R0, [0, 0, 0]), [0.0, 1e6])
    assert np.all(motion.rotor.is_close(R0, rtol=2 * EPS))
    assert np.all(motion.omega_body.components == 0)
    assert motion.certificate.worst <= 2 * EPS


def test_exactly_on_the_unstable_axis_it_stays():
    for method in ("auto", STEPS):
        state = ph.State(R0, [0, 1.0, 0])
        motion = ph.simulate(ASYMMETRIC, state, np.linspace(0, 1000, 11), method=method)
        np.testing.assert_array_equal(motion.omega_body.components, np.tile([0, 1.0, 0], (11, 1)))


def test_the_rotor_is_continuous_on_the_double_cover():
    """After one turn of 2π it is −R; no output jumps by more than the turn between, |ΔR| <= ωΔt/2."""
    t = np.linspace(0, 50, 2001)
    for torque, method in ((None, "auto"), (None, STEPS), (ph.torque.heavy([0.5, 0.25, 1.0]), STEPS)):
        motion = ph.simulate(ASYMMETRIC, START, t, torque, method=method)
        jumps = np.linalg.norm(np.diff(motion.rotor.components, axis=0), axis=1)
        fastest = motion.omega_body.norm().max()
        assert jumps.max() <= 0.5 * fastest * (t[1] - t[0]) * (1 + 1e-9)
    turn = ph.simulate(ASYMMETRIC, ph.State(R0, [0, 0, 1.0]), [2 * np.pi, 4 * np.pi])
    assert turn.rotor[0].is_close(-R0, rtol=1e-12)
    assert turn.rotor[1].is_close(R0, rtol=1e-12)


def test_the_inertia_may_be_in_any_axes():
    """A body turned in its axes moves alike, seen from the turned axes."""
    F, t = ph.Rotor.from_components([1, 2, 3, 4]), np.linspace(0, 5, 11)
    body = ph.Body(1.0, ASYMMETRIC)
    straight = ph.simulate(body, START, t, ph.torque.constant_body([0.1, 0.2, 0.3]), step=1 / 64)
    law = ph.torque.constant_body(F(ph.bivector([0.1, 0.2, 0.3])))
    turned = ph.simulate(body.moved(F), ph.State(R0 * ~F, F(START.omega_body)), t, law, step=1 / 64)
    np.testing.assert_allclose(
        (turned.rotor * F).components, straight.rotor.components, rtol=0, atol=20 * random_walk(320)
    )


def test_a_given_step_is_kept_and_an_estimate_is_not_claimed():
    motion = ph.simulate(ASYMMETRIC, START, [1.0, 2.05], step=0.1)
    assert motion.certificate.step == pytest.approx(0.1)
    # The steps' ends are rounded times near 2.
    assert motion.certificate.step <= 0.1 + 2 * EPS
    assert motion.certificate.steps == 10 + 11
    assert motion.certificate.error_estimate is None


@pytest.mark.parametrize("rtol", [1e-4, 1e-8, 1e-11])
def test_a_tolerance_is_met(rtol):
    inertia, state, torque, _ = SLOPES["heavy"]
    t = np.linspace(0, 20, 11)
    motion = ph.simulate(inertia, state, t, torque, rtol=rtol)
    exact = ph.simulate(inertia, state, t, torque, step=1 / 128)
    assert apart(motion, exact.rotor.components, exact.omega_body.components) <= rtol
    assert motion.certificate.error_estimate <= rtol
    assert (
        ph.simulate(inertia, state, t, torque, rtol=1e-13, atol=rtol).certificate.step
        == motion.certificate.step
    )


# --- refusals

BOX = ph.Body.box([1, 2, 3], mass=1.0)


@pytest.mark.parametrize(
    ("change", "parts"),
    [
        ({"step": 0.0}, ["step", "0", "positive"]),
        ({"step": -0.1}, ["step", "-0.1"]),
        ({"step": np.nan}, ["step", "NaN"]),
        ({"step": 1e-300}, ["steps", "longer step"]),
        ({"rtol": 0.0}, ["rtol", "0", "between 0 and 1"]),
        ({"rtol": -1e-6}, ["rtol", "-"]),
        ({"rtol": 1.0}, ["rtol", "1.0", "between 0 and 1"]),
        ({"atol": 2}, ["atol", "2", "between 0 and 1"]),
        ({"rtol": -1.0, "atol": 1e-6}, ["rtol", "-1"]),
        ({"atol": -1.0, "rtol": 1e-6}, ["atol", "-1"]),
        ({"times": [0.0, np.nan]}, ["times[1]", "NaN"]),
        ({"times": [0.0, np.inf]}, ["times[1]", "inf"]),
        ({"times": [0.0, 2.0, 1.0]}, ["times[2]", "1", "decrease"]),
        ({"times": [[0.0, 1.0]]}, ["one-dimensional", "(1, 2)"]),
        ({"times": 60}, ["times", "60", "[T]", "np.linspace(0, T, n)"]),
        ({"times": np.float64(60)}, ["times", "60", "[T]"]),
        ({"method": "euler"}, ["'euler'", "kahan_li8"]),
        ({"rtol": 1e-17, "method": STEPS}, ["rtol = 1.0e-17", "not reached", "rtol >="]),
        ({"body": ph.Body.rod(1.0, mass=1.0)}, ["0 kg m²", "thickness"]),
        ({"state": ph.State(R0, [0, np.nan, 1])}, ["angular velocity", "nan"]),
        ({"state": ph.State(R0, [[0, 0, 1], [0, np.inf, 0]])}, ["index (1,)", "angular velocity", "inf"]),
        ({"times": [-np.inf, 0.0]}, ["times[0]", "-inf"]),
        ({"method": "exact", "step": 0.1}, ["exact", "closed form"]),
        ({"method": "exact", "torque": ph.torque.gravity_gradient(1.0)}, ["exact", "closed form"]),
        ({"state": ph.State(R0, [0, 0, 1], velocity=[np.nan, 0, 0])}, ["velocity"]),
        ({"force": [0, np.nan, 0]}, ["force"]),
    ],
    ids=lambda value: "-".join(value) if isinstance(value, dict) else "",
)
def test_unusable_values_are_refused(change, parts):
    arguments = {"body": BOX, "state": START, "times": [0.0, 1.0], **change}
    with pytest.raises(ValueError) as error:
        ph.simulate(**arguments)
    for part in parts:
        assert part in str(error.value)


@pytest.mark.parametrize(
    "change",
    [
        {"body": np.eye(3)},
        {"state": (R0, [0, 0, 1])},
        {"times": ["now"]},
        {"times": None},
        {"torque": "heavy"},
        {"torque": ph.torque.heavy},
        {"force": ph.e1 ^ ph.e2},
        {"force": "down"},
        {"progress": 3},
        {"events": 3},
        {"events": [ph.event.plane]},
        {"body": BOX.inertia, "force": [0, 0, 1]},
    ],
    ids=lambda change: "-".join(change),
)
def test_wrong_types_are_type_errors(change):
    arguments = {"body": BOX, "state": START, "times": [0.0, 1.0], **change}
    with pytest.raises(TypeError):
        ph.simulate(**arguments)


def test_states_and_laws_refuse_wrong_grades():
    with pytest.raises(TypeError, match="bivector"):
        ph.State(R0, ph.e3)
    with pytest.raises(TypeError, match="rotor"):
        ph.State([1, 0, 0, 0], [0, 0, 1])
    with pytest.raises(TypeError):
        ph.State(R0, [0, 0, 1], position=ph.e1 ^ ph.e2)
    with pytest.raises(ValueError, match="3"):
        ph.State(R0, [0, 1])
    with pytest.raises(TypeError, match="vector"):
        ph.torque.heavy(ph.e1 ^ ph.e2)
    with pytest.raises(TypeError, match="bivector"):
        ph.torque.constant_space(ph.e1)
    with pytest.raises(ValueError, match="3"):
        ph.torque.constant_body(np.eye(2))


def test_nan_is_rejected():
    with pytest.raises(ValueError):
        ph.describe_free(ASYMMETRIC, [np.nan, 0, 0])
    with pytest.raises(TypeError):
        ph.describe_free(ASYMMETRIC, ph.e3)


# --- long runs


def test_progress_rises_from_pass_to_pass():
    seen = []
    ph.simulate(ASYMMETRIC, START, [4000.0], step=0.02, progress=lambda *at: seen.append(at))
    assert len(seen) >= 3
    assert {number for number, _ in seen} == {1}
    fractions = [fraction for _, fraction in seen]
    assert fractions == sorted(set(fractions))
    assert 0 < fractions[0] < fractions[-1] <= 1
    passes = []
    ph.simulate(ASYMMETRIC, START, [10000.0], method=STEPS, rtol=1e-9, progress=lambda *at: passes.append(at))
    assert passes == sorted(passes)
    assert passes[-1][0] >= 2


def test_progress_rises_over_both_signs_of_time():
    seen = []
    ph.simulate(ASYMMETRIC, START, [-3000.0, 3000.0], step=0.005, progress=lambda *at: seen.append(at[1]))
    assert seen == sorted(seen)
    assert seen[-1] > 0.6


def test_exceptions_of_progress_propagate():
    class EnoughError(Exception):
        pass

    def report(number, fraction):
        raise EnoughError(number)

    with pytest.raises(EnoughError):
        ph.simulate(ASYMMETRIC, START, [1e6], step=1e-3, progress=report)


def test_ctrl_c_stops_a_run():
    program = (
        "import polhode as ph; print('go', flush=True)\n"
        "ph.simulate(ph.Inertia.from_principal_moments(1, 2, 3),"
        "ph.State(ph.Rotor.identity(), [0, 1, 1]), [1e6], step=1e-3)"
    )
    with processes.start([sys.executable, "-c", program]) as process:
        assert process.stdout.readline() == "go\n"
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate()
    assert "KeyboardInterrupt" in errors
    assert process.returncode != 0
