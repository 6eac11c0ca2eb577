"""`Trajectory.at` between the output times, against motions with outputs there."""

import pickle
import sys

import numpy as np
import pytest

import polhode as ph
import processes
from motions import ASYMMETRIC, EPS, METHODS, R0, SLOPES, START, moments, random_walk

BODY = ph.Body.box([1, 2, 3], mass=2.0)
MOVING = ph.State(R0, [0.25, -0.5, 1.0], ph.vector([1, 2, 0]), ph.vector([0, 0.5, 0.25]))
TIMES = np.array([-4.0, -1.0, -1.0, 0.5, 3.0, 7.0])
GRAVITY = ph.torque.gravity_gradient(0.5)
TABLE = ph.torque.tabulated(
    [-5, -2.5, 0.25, 2, 8], [[0.1, 0, 0], [0, 0.2, 0], [0.3, 0, -0.1], [0, 0, 0.2], [0.1, 0.1, 0]]
)


def between(seed=1, count=40):
    """Random times in any order, and the ends."""
    return np.append(np.random.default_rng(seed).uniform(-4, 7, count), [-4, -1, 0, 0.5, 7])


def compare(found, motion, tolerance):
    """The largest difference from a motion at those times, as its certificate measures it."""
    turn = np.linalg.norm(found.rotor.components - motion.rotor.components, axis=-1).max()
    assert turn <= tolerance
    for name in ("omega_body", "position", "velocity"):
        a, b = getattr(found, name).components, getattr(motion, name).components
        assert np.abs(a - b).max() <= tolerance * max(np.abs(b).max(), 1e-300)


@pytest.mark.parametrize(
    "given",
    [
        {},
        {"torque": ph.torque.damping(0.1)},
        {"torque": ph.torque.constant_space([0.1, 0.2, 0])},
        {"torque": GRAVITY},
        {"torque": TABLE},
        {"torque": ph.torque.viscous_damping(0.02)},
        {"force": [0, 0, -19.62]},
        {"torque": GRAVITY, "force": [0, 0, -19.62]},
        {"force": ph.force.spring(3.0) + ph.force.thrust([0.5, 0, 0], at=[0, 0.1, 0])},
        {"force": ph.force.formula("-k x + R e1 ~R", k=2.0), "torque": TABLE},
        {"force": ph.force.central(2.0), "rtol": 1e-7},
    ],
    ids=lambda given: " ".join(map(str, given.values())) or "free",
)
def test_it_agrees_with_outputs_there(given):
    motion = ph.simulate(BODY, MOVING, TIMES, **given)
    t = between()
    order = np.argsort(t)
    direct = ph.simulate(BODY, MOVING, t[order], **given)
    found = motion.at(t)
    assert found.rotor.shape == t.shape
    estimate = (motion.certificate.error_estimate or 0) + (direct.certificate.error_estimate or 0)
    back = np.argsort(order)
    sorted_back = ph.State(
        direct.rotor[back], direct.omega_body[back], direct.position[back], direct.velocity[back]
    )
    compare(found, sorted_back, estimate + 50 * random_walk(200))
    if motion.certificate.method == "exact":
        assert np.array_equal(found.rotor.components, sorted_back.rotor.components)


@pytest.mark.parametrize("method", METHODS)
def test_every_method_continues_from_the_nearest_output(method):
    """With steps no longer than the run's: the error of the method, measured with half the step."""
    inertia, state, torque, _ = SLOPES["heavy"]
    step = 1 / 256 if METHODS[method] < 4 else 1 / 32
    motion = ph.simulate(inertia, state, TIMES, torque, method=method, step=step)
    t = np.sort(between())
    direct = ph.simulate(inertia, state, t, torque, method=method, step=step)
    half = ph.simulate(inertia, state, t, torque, method=method, step=step / 2)
    error = np.linalg.norm((direct.rotor.components - half.rotor.components), axis=-1).max()
    compare(motion.at(t), half, 4 * error + 1e-11)


@pytest.mark.parametrize("method", ["auto", "kahan_li8", "dop853"])
def test_at_the_output_times_it_is_the_outputs(method):
    inertia, state, torque, _ = SLOPES["heavy"]
    motion = ph.simulate(inertia, state, TIMES, torque, method=method)
    found = motion.at(TIMES)
    assert np.array_equal(found.rotor.components, motion.rotor.components)
    assert np.array_equal(found.omega_body.components, motion.omega_body.components)
    start = motion.at(0.0)
    assert start.rotor.shape == ()
    assert start.rotor.is_close(state.rotor, rtol=4 * EPS)


def test_shapes_are_kept():
    motion = ph.simulate(ASYMMETRIC, START, [5.0])
    t = np.linspace(0, 5, 6).reshape(2, 3)
    found = motion.at(t)
    assert found.rotor.shape == found.omega_body.shape == found.position.shape == (2, 3)
    assert found.rotor[1, 2] == motion.at(5.0).rotor
    assert motion.at(np.zeros((0, 3))).rotor.shape == (0, 3)


@pytest.mark.parametrize("torque", [None, ph.torque.heavy([0.5, 0.25, 1.0])], ids=["exact", "stepped"])
def test_it_reaches_the_event_that_ended_the_motion(torque):
    inertia = moments(1, 2, 2.5)
    event = ph.event.plane(ph.e1, ph.e3, terminal=True)
    motion = ph.simulate(inertia, START, [-20.0, 0.25, 20.0], torque, events=event)
    ends = np.sort(motion.events[0].time)
    assert list(motion.time) == [0.25]
    assert ends[0] < 0 < 0.25 < ends[1]
    free = ph.simulate(inertia, START, [-20.0, 20.0], torque)
    t = np.linspace(*ends, 31)
    tolerance = 1e-13 if torque is None else 40 * (2 * EPS + free.certificate.error_estimate) + 1e-9
    compare(motion.at(t), free.at(t), tolerance)
    last = motion.at(ends)
    assert np.abs((last.rotor(ph.e1) | ph.e3).components).max() <= 1e-9
    for beyond in (ends[0] - 1e-9, ends[1] + 1e-9):
        with pytest.raises(ValueError, match="outside the computed motion"):
            motion.at(beyond)


@pytest.mark.parametrize("torque", [None, GRAVITY], ids=["exact", "stepped"])
def test_without_outputs_the_start_is_known(torque):
    motion = ph.simulate(ASYMMETRIC, START, [], torque)
    assert motion.at(0.0).rotor.is_close(R0, rtol=8 * EPS)
    with pytest.raises(ValueError, match=r"times\[0\] = 1 is outside .*, 0 s to 0 s"):
        motion.at(1.0)


@pytest.mark.parametrize(
    ("t", "parts"),
    [
        (5.5, ["times[0] = 5.5", "-1 s to 5 s", "simulate"]),
        ([0.0, -1.5], ["times[1] = -1.5"]),
        (np.nan, ["NaN", "not finite"]),
        ([0.0, np.inf], ["inf", "1"]),
    ],
)
def test_times_outside_the_motion_raise(t, parts):
    motion = ph.simulate(ASYMMETRIC, START, [-1.0, 5.0])
    with pytest.raises(ValueError) as error:
        motion.at(t)
    for part in parts:
        assert part in str(error.value)


def test_exceptions_of_a_law_propagate():
    class OwnError(Exception):
        pass

    armed = []

    def push(t, position, velocity, rotor):
        if armed:
            raise OwnError(t)
        return -position

    motion = ph.simulate(BODY, MOVING, [5.0], force=push)
    armed.append(True)
    with pytest.raises(OwnError):
        motion.at(2.0)


def test_an_unpickled_motion_has_its_methods_in_a_new_process():
    motion = ph.simulate(BODY, START, [0.0, 1.0])
    read = "import pickle, sys; motion = pickle.load(sys.stdin.buffer); print(motion.view, motion.save)"
    run = [sys.executable, "-c", read]
    done = processes.run(run, input=pickle.dumps(motion), encoding=None)
    assert b"save" in done.stdout


def test_names_of_other_libraries_are_errors_that_name_ours():
    motion = ph.simulate(BODY, START, [0.0, 1.0])
    for name, ours in (
        ("t", "time"),
        ("attitude", "rotor"),
        ("omega", "omega_body"),
        ("to_pandas", "to_dataframe"),
    ):
        with pytest.raises(AttributeError, match=f"no attribute '{name}'; write {ours}"):
            getattr(motion, name)
    with pytest.raises(IndexError, match=r"of one motion is at\(t\)"):
        motion[0]
    with pytest.raises(TypeError, match="for a constant torque write constant_body"):
        ph.simulate(BODY, START, [1.0], torque=[0, 0, 1])
    with pytest.raises(TypeError, match=r"see Rotor\.from_quaternion"):
        ph.State([1, 0, 0, 0], [0, 0, 1])
    with pytest.raises(TypeError, match=r"use Inertia\.from_principal_moments"):
        ph.Inertia(1, 2, 3)
    with pytest.raises(TypeError, match=r"see Inertia\.from_principal_moments, from_matrix"):
        ph.Body(1.0, np.eye(3))
