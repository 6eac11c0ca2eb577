"""Start times: a motion continued from any of its states is the motion itself."""

import json

import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, EPS, METHODS, R0, START, apart, moments, random_walk
from polhode._support.packing import unpacked
from polhode._viewer.document import document

BODY = ph.Body(2.0, ASYMMETRIC, [0.0, 0.0, 0.0])
MOVING = ph.State(R0, [0.25, -0.5, 1.0], [1, 2, 0], [0, 0.5, 0.25])
SYMMETRIC = moments(1, 1, 0.5)
SPHERE = moments(2, 2, 2)
ROWS = [[0.1, 0, 0], [0, 0.2, 0], [0.3, 0, -0.1], [0, 0, 0.2], [0.1, 0.1, 0]]
TABLE_TIMES = [-4, -2.5, 0.25, 2, 8]


def pushed(t, rotor, omega):
    """A torque that depends on all arguments of a Python function."""
    return 0.5 * np.sin(2 * t) * ph.bivector([1, 0, 0.5]) - 0.1 * omega


def driven(t, position, velocity, rotor):
    """A force that depends on time and position."""
    return ph.vector([np.cos(t), 0, 0]) - position


def law(inertia=ASYMMETRIC, torque=None, **others):
    return {"body": inertia, "torque": torque, **others}


GIVEN = {
    "formula": law(torque=ph.torque.formula("sin(2 t) (e12 + 1/2 e23)")),
    "formula in space": law(torque=ph.torque.formula("cos(t) e12 - 1/10 Ω", frame="space")),
    "table": law(torque=ph.torque.tabulated(TABLE_TIMES, ROWS)),
    "spline in space": law(torque=ph.torque.tabulated(TABLE_TIMES, ROWS, "space", "cubic")),
    "circular orbit": law(torque=ph.torque.gravity_gradient(1.25)),
    "elliptic orbit": law(torque=ph.torque.gravity_gradient(1.25, 0.4, 0.5)),
    "function": law(torque=pushed),
    "heavy": law(torque=ph.torque.heavy([0.5, 0.25, 1.0])),
    "gyrostat": law(torque=ph.torque.gyrostat([0.1, 0.2, 0.3])),
    "constant and orbit": law(torque=ph.torque.constant_space([0.1, 0, 0]) + ph.torque.gravity_gradient(1)),
    "free": law(),
    "Lagrange": law(SYMMETRIC, ph.torque.heavy([0, 0, 2])),
    "damping": law(torque=ph.torque.damping(0.25)),
    "larmor": law(SPHERE, ph.torque.larmor([0.3, -0.2, 0.5])),
    "falling": law(BODY, force=[0, 0, -19.62]),
    "formula of a force": law(BODY, force=ph.force.formula("-x + sin(t) e1")),
    "function of a force": law(BODY, force=driven),
    "force and table": law(BODY, ph.torque.tabulated(TABLE_TIMES, ROWS), force=ph.force.spring(2.0)),
}
EXACT = ("free", "Lagrange", "damping", "larmor", "falling")
TIMES = np.array([-3.0, -0.5, 1.25, 2.0, 5.0])


def differences(a, b):
    """The largest difference of two batches of states, each part relative to its largest size."""
    worst = np.abs(a.rotor.components - b.rotor.components).max()
    for name in ("omega_body", "position", "velocity"):
        p, q = getattr(a, name).components, getattr(b, name).components
        worst = max(worst, np.abs(p - q).max() / max(np.abs(q).max(), 1.0))
    return worst


def states(motion):
    return ph.State(motion.rotor, motion.omega_body, motion.position, motion.velocity, time=motion.time)


def tolerance(*motions):
    """Ten times the sum of the estimates, because an error at the start grows; and rounding."""
    estimates = sum(motion.certificate.error_estimate or 0.0 for motion in motions)
    # In closed form some 20 roundings, which eight seconds of turning at 1 rad/s magnify as many times.
    return 10 * estimates + 200 * EPS


@pytest.mark.parametrize("name", GIVEN)
@pytest.mark.parametrize("at", [0.7, -1.5, 5.0])
def test_a_motion_continued_from_any_state_is_the_motion(name, at):
    given = dict(GIVEN[name])
    body = given.pop("body")
    whole = ph.simulate(body, MOVING, TIMES, **given)
    start = whole.at(at)
    assert start.time == at
    rest = ph.simulate(body, start, TIMES, **given)
    assert (whole.certificate.method == "exact") == (name in EXACT)
    assert rest.certificate.method == whole.certificate.method
    assert (rest.time == TIMES).all()
    assert differences(states(rest), states(whole)) <= tolerance(whole, rest)
    t = np.linspace(-3, 5, 9)
    found = rest.at(t)
    assert (found.time == t).all()
    assert differences(found, whole.at(t)) <= tolerance(whole, rest)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", ["circular orbit", "table", "heavy", "constant and orbit"])
def test_continued_runs_take_the_same_steps(method, name):
    """Steps from an output time on are the steps of the whole run, to the rounding of their times."""
    inertia = SYMMETRIC if method == "rkn6" else ASYMMETRIC
    torque, step = GIVEN[name]["torque"], 1 / 64
    whole = ph.simulate(inertia, START, TIMES, torque, method=method, step=step)
    for k, t in enumerate(TIMES):
        rest = ph.simulate(inertia, whole.at(t), [t, 5.0] if t < 5 else [t], torque, method=method, step=step)
        rotors, omegas = whole.rotor.components[[k, -1]], whole.omega_body.components[[k, -1]]
        n = len(rest.time)
        # Iterations of the implicit methods end at 1e-14 or so in each step.
        solved = 1e-13 if method in ("midpoint", "dmv") else 0.0
        if t >= 0:
            assert apart(rest, rotors[:n], omegas[:n]) <= 20 * random_walk(512, method) + 512 * solved


@pytest.mark.parametrize("count", [3, 20], ids=["few lanes", "many lanes"])
@pytest.mark.parametrize("how", [{}, {"step": 1 / 64}, {"method": "rk4", "step": 1 / 64}], ids=str)
@pytest.mark.parametrize("name", GIVEN)
def test_each_body_of_a_batch_starts_at_its_own_time(name, how, count):
    if how and "function" in name and count > 3:
        pytest.skip("Python functions are slow, and called for one body at a time")
    given = dict(GIVEN[name])
    body = given.pop("body")
    whole = ph.simulate(body, MOVING, TIMES, **given)
    starts = whole.at(np.linspace(-3, 5, count))
    assert starts.shape == (count,)
    batch = ph.simulate(body, starts, TIMES, **given, **how)
    assert batch.ok.all()
    # Equal steps of 1/64 s make some 1e-5 by a method of order 4, and else less than the tolerance does.
    bound = 4e-5 if "method" in how else 1e-8
    for one in batch:
        assert differences(states(one), states(whole)) <= bound
    assert batch.final.shape == (count,)
    assert differences(batch.final, whole.final) <= bound


def test_a_time_for_each_body_goes_with_blocks_and_picks():
    law = GIVEN["formula"]["torque"]
    starts = ph.simulate(ASYMMETRIC, START, [-3.0, 5.0], law).at(np.linspace(-3, 5, 10).reshape(5, 2))
    whole = ph.simulate(ASYMMETRIC, starts, TIMES, law)
    for rows, block in ph.simulate_blocks(ASYMMETRIC, starts, TIMES, law, block=2):
        assert (block.omega_body == whole[rows].omega_body).all()
        assert (block.position == whole[rows].position).all()


def test_bodies_that_no_force_moves_drift_from_their_own_starts():
    starts = ph.FreeMotion(ASYMMETRIC, R0, [0.25, -0.5, 1]).at([1.0, 2.0])
    starts = ph.State(starts.rotor, starts.omega_body, [1, 0, 0], [[1, 0, 0], [0, 1, 0]], time=starts.time)
    motion = ph.simulate(ASYMMETRIC, starts, [0.0, 2.0])
    expected = [[[0, 0, 0], [2, 0, 0]], [[1, -2, 0], [1, 0, 0]]]
    np.testing.assert_array_equal(motion.position.components, expected)
    np.testing.assert_array_equal(motion[1].position.components, expected[1])
    np.testing.assert_array_equal(motion[..., 1].position.components, expected[1])


def test_the_clock_does_not_restart():
    """``ω' = sin t`` from rest at time 0: ``ω = 1 − cos t``."""
    torque = ph.torque.formula("sin(t) e12")
    rest = ph.State(ph.Rotor.identity(), [0, 0, 0])
    whole = ph.simulate(SPHERE, rest, [1.0, 2.0], torque)
    again = ph.simulate(SPHERE, whole.at(1.0), [2.0], torque)
    exact = (1 - np.cos(2)) / 2
    for motion in (whole, again):
        # The tolerance is 1e-10.
        assert motion.final.omega_body.components[2] == pytest.approx(exact, abs=1e-10)


def test_a_start_at_time_0_changes_no_bit():
    torque = GIVEN["formula"]["torque"]
    for state in (START, ph.State(START.rotor, START.omega_body, time=-0.0)):
        motion = ph.simulate(ASYMMETRIC, state, TIMES, torque)
        expected = ph.simulate(ASYMMETRIC, ph.State(START.rotor, START.omega_body), TIMES, torque)
        assert (motion.omega_body == expected.omega_body).all()


def test_a_torque_is_evaluated_at_the_time_of_the_state():
    for name in ("formula", "elliptic orbit", "table"):
        torque, state = GIVEN[name]["torque"], ph.State(R0, [0.25, -0.5, 1.0], time=0.75)
        assert torque.at(ASYMMETRIC, state) == torque.at(ASYMMETRIC, START, 0.75)
        assert torque.at(ASYMMETRIC, state, 0.0) == torque.at(ASYMMETRIC, START)


# --- closed forms


def test_states_of_closed_forms_have_their_times():
    given = ASYMMETRIC, R0, [0.25, -0.5, 1.0]
    many = ph.FreeMotion([ASYMMETRIC, SPHERE], R0, [0.25, -0.5, 1.0])
    top = ph.LagrangeTop(SYMMETRIC, R0, [0.25, -0.5, 1.0], [0, 0, 2])
    sphere = ph.LarmorSphere(SPHERE, R0, [0.25, -0.5, 1.0], [0, 0, 2])
    symmetric = ph.SymmetricTop(SYMMETRIC, R0, [0.25, -0.5, 1.0])
    for motion in (ph.FreeMotion(*given), ph.DampedTop(*given, 0.25), top, sphere, symmetric):
        assert motion.at(2).time == 2.0
        assert (motion.at([1, 3.0]).time == [1, 3]).all()
    assert many.at([1, 2.0, 3]).shape == (2, 3)
    assert (many.at([1, 2.0, 3])[1].time == [1, 2, 3]).all()
    assert (many.at_each([1, 2.0]).time == [1, 2]).all()


@pytest.mark.parametrize("count", [None, 20], ids=["one", "batch"])
def test_a_late_start_costs_no_digits(count):
    """The difference of two times is rounded, to 6e-9 s here; the motion knows it exactly."""
    start, end, spin = 0.1, 1e8, 10.0
    shape = () if count is None else (count,)
    state = ph.State(ph.Rotor.identity(shape), np.broadcast_to([0, 0, spin], (*shape, 3)), time=start)
    found = ph.simulate(ASYMMETRIC, state, [end]).final
    # 1e8 less the double nearest to 0.1: exactly by its integral and fractional parts.
    turn = ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, -spin * start)
    expected = ph.FreeMotion(ASYMMETRIC, turn, [0, 0, spin]).at(end).rotor
    # The horizon of the phases allows 4 roundings; the angle at the start has one.
    assert np.max((found.rotor - expected).norm()) <= 8 * EPS


def test_times_beyond_the_horizon_count_from_the_start():
    state = ph.State(R0, [0.25, -0.5, 1.0], time=3e17)
    ph.simulate(ASYMMETRIC, state, [3.1e17])
    with pytest.raises(ValueError, match=r"times\[0\] = 0e0 s is beyond .* s from the start at 3\d* s"):
        ph.simulate(ASYMMETRIC, ph.State(R0, [25, -50, 100.0], time=3e17), [0.0])


# --- events


def test_events_are_met_at_their_own_times():
    """A spin that is zero at the start does not cross zero there, at any start time."""
    torque = ph.torque.formula("cos(t) e12")
    spin = ph.event.spin(ph.e1 ^ ph.e2)
    rest = ph.State(ph.Rotor.identity(), [0, 0, 0])
    for begin, expected in ((0.0, [np.pi, 2 * np.pi]), (np.pi, [2 * np.pi, 3 * np.pi])):
        state = ph.State(rest.rotor, rest.omega_body, time=begin)
        (met,) = ph.simulate(SPHERE, state, [begin + 7.0], torque, events=spin).events
        np.testing.assert_allclose(met.time, expected, rtol=0, atol=1e-9)
        assert met.states.shape == (2,)
        assert met.states[1].time == met.time[1]


def test_a_motion_ended_by_an_event_can_be_continued():
    torque, inertia = GIVEN["formula"]["torque"], ASYMMETRIC
    event = ph.event.spin(ph.e3 ^ ph.e1, terminal=True)
    whole = ph.simulate(inertia, START, [5.0], torque)
    first = ph.simulate(inertia, START, [5.0], torque, events=event)
    rest = ph.simulate(inertia, first.events[0].states[0], [5.0], torque)
    assert first.events[0].time[0] > 0
    assert differences(rest.final, whole.final) <= tolerance(whole, first, rest)


# --- states


def test_states_compare_by_value():
    state = ph.State(R0, [0.25, -0.5, 1.0], time=2)
    assert state.time == 2.0
    assert isinstance(state.time, float)
    assert state == ph.State(R0, ph.bivector([0.25, -0.5, 1.0]), [0, 0, 0], time=2.0)
    others = [
        ph.State(R0, [0.25, -0.5, 1.0]),
        ph.State(-R0, [0.25, -0.5, 1.0], time=2),
        ph.State(R0, [0.25, -0.5, 1.5], time=2),
        ph.State(R0, [0.25, -0.5, 1.0], [0, 0, 1], time=2),
        ph.State(R0, [0.25, -0.5, 1.0], velocity=[0, 0, 1], time=2),
        ph.State(R0, [0.25, -0.5, 1.0], time=[2.0]),
    ]
    for other in others:
        assert (state == other) is False
        assert (state != other) is True
    assert state != 2.0
    with pytest.raises(TypeError, match="unhashable"):
        hash(state)


def test_a_batch_of_states_is_indexed():
    rotors = ph.Rotor.random((2, 3), 1)
    states = ph.State(rotors, [0.25, -0.5, 1.0], time=[1.0, 2.0, 3.0])
    assert states.shape == (2, 3)
    assert len(states) == 2
    one = states[1, 2]
    assert one == ph.State(rotors[1, 2], [0.25, -0.5, 1.0], time=3.0)
    assert isinstance(one.time, float)
    assert states[..., 0].shape == (2,)
    assert states[0] == next(iter(states))
    assert [state.shape for state in states] == [(3,), (3,)]
    assert states[:, 1:] == ph.State(rotors[:, 1:], [0.25, -0.5, 1.0], time=[2.0, 3.0])
    with pytest.raises(IndexError, match=r"batch shape \(2, 3\)"):
        states[2]
    with pytest.raises(TypeError, match="single state has no length"):
        len(one)
    assert one


def test_the_angular_velocity_may_be_given_in_space():
    state = ph.State(R0, omega_space=[0.25, -0.5, 1.0])
    assert R0(state.omega_body).is_close(ph.bivector([0.25, -0.5, 1.0]), rtol=4 * EPS)
    assert state.omega_space.is_close(ph.bivector([0.25, -0.5, 1.0]), rtol=4 * EPS)
    for given in ({}, {"omega_body": [0, 0, 1], "omega_space": [0, 0, 1]}):
        with pytest.raises(TypeError, match="either omega_body or omega_space"):
            ph.State(R0, **given)


def test_the_last_state_is_that_at_the_last_time():
    motion = ph.simulate(ASYMMETRIC, START, TIMES)
    assert motion.final == motion.at(5.0)
    with pytest.raises(ValueError, match="no output times"):
        ph.simulate(ASYMMETRIC, START, []).final  # noqa: B018


@pytest.mark.parametrize("time", [np.nan, np.inf])
def test_a_start_needs_a_time(time):
    with pytest.raises(ValueError, match=f"the time of the state is {time}; it must be finite"):
        ph.simulate(ASYMMETRIC, ph.State(R0, [0, 0, 1], time=time), [1.0])
    with pytest.raises(ValueError, match=r"at index \(1,\): the time of the state"):
        ph.simulate(ASYMMETRIC, ph.State(R0, [0, 0, 1], time=[0, time]), [1.0])


def test_shapes_of_times_that_do_not_fit_are_named():
    state = ph.State(ph.Rotor.random((2,), 1), [0, 0, 1], time=[0, 1, 2.0])
    with pytest.raises(ValueError, match=r"\(2,\) of the rotor, \(3,\) of the time"):
        ph.simulate(ASYMMETRIC, state, [1.0])


# --- files


def test_a_motion_read_from_a_file_can_be_continued(tmp_path):
    torque = GIVEN["formula"]["torque"]
    whole = ph.simulate(ASYMMETRIC, START, [2.0, 5.0], torque)
    half = ph.simulate(ASYMMETRIC, START, [1.0, 2.0], torque)
    half.save(tmp_path / "half.nc")
    read = ph.Trajectory.read(tmp_path / "half.nc").final
    assert read == half.final
    rest = ph.simulate(ASYMMETRIC, read, [5.0], torque)
    assert differences(rest.final, whole.final) <= tolerance(whole, half, rest)


SCENE = """
[body]
moments = [1, 2, 3]
[initial]
spin = { bivector = [0.25, -0.5, 1.0] }
time = "0.5 min"
[torque]
torque_body = "sin(2*t) e1e2"
[run]
duration = 5
samples = 3
"""


def test_a_scene_has_a_start_time(tmp_path):
    path = tmp_path / "late.toml"
    path.write_text(SCENE, encoding="utf-8")
    scene = ph.Scene.read(path)
    assert scene.state.time == 30.0
    np.testing.assert_array_equal(scene.times, [30.0, 32.5, 35.0])
    np.testing.assert_array_equal(scene.elapsed, [0, 2.5, 5.0])
    motion = scene.run()
    torque = ph.torque.formula("sin(2*t) e1e2")
    expected = ph.simulate(ASYMMETRIC, scene.state, scene.times, torque)
    assert motion.final == expected.final
    path.write_text(SCENE + "[ensemble]\nnumber = 3\nspin = { relative = 0.1 }\n", encoding="utf-8")
    scene = ph.Scene.read(path)
    state, inertias, _ = scene.ensemble.draw()
    assert state.time == 30.0
    batch = scene.run()
    for one, start in zip(batch, state, strict=True):
        alone = ph.simulate(inertias[0], start, scene.times, torque)
        # Both have the default tolerance, 1e-10.
        assert differences(one.final, alone.final) <= 1e-9


@pytest.mark.parametrize("time", ['"3 m"', "nan", '"abc"'])
def test_a_scene_with_a_wrong_time_is_refused(time, tmp_path):
    path = tmp_path / "late.toml"
    path.write_text(SCENE.replace('"0.5 min"', time), encoding="utf-8")
    with pytest.raises(ph.SceneError, match=r"late\.toml:6:8"):
        ph.Scene.read(path)


def test_a_motion_is_written_as_the_scene_that_starts_there(tmp_path):
    torque = GIVEN["table"]["torque"]
    state = ph.State(R0, [0.25, -0.5, 1.0], time=-1.5)
    motion = ph.simulate(ASYMMETRIC, state, [-2.0, 1.0, 3.0], torque)
    shown = document(motion)
    path = tmp_path / "motion.toml"
    path.write_text(shown["scene"], encoding="utf-8")
    scene = ph.Scene.read(path)
    assert scene.state == state
    np.testing.assert_array_equal(scene.times, [-1.5, 0.75, 3.0])
    about = json.loads(shown["recorded"]["about"])
    assert about["start"]["time"] == -1.5
    assert about["duration"] == 4.5
    rows = np.frombuffer(unpacked(shown["recorded"]["rows"])).reshape(-1, 24)
    assert rows[[0, -1], 0].tolist() == [-1.5, 3.0]
    np.testing.assert_array_equal(rows[0, 1:5], R0.components)
    with pytest.raises(
        ValueError, match=r"needs an output time after the start of the motion, -1.5 s; this one has none"
    ):
        document(ph.simulate(ASYMMETRIC, state, [-2.0], torque))
