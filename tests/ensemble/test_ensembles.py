"""Batches of free motions have the bits of single motions at single times."""

import json
import signal

import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, EPS, R0, REFERENCE, moments
from polhode._support import memory

# On the separatrix exactly: 2E i2 = G² with i = 1, 2, 2.25.
SEPARATRIX = [0.375, 0.5, 0.5]
REGIMES = {
    "rest": (ASYMMETRIC, [0, 0, 0]),
    "steady": (ASYMMETRIC, [0, -2.0, 0]),
    "sphere": (moments(2, 2, 2), [1.0, 2, 3]),
    "prolate": (moments(2, 2, 1), [0.5, -0.25, 1.0]),
    "oblate": (moments(1, 2, 2), [0.5, -0.25, 1.0]),
    "nearly symmetric": (moments(1, 1 + 4 * EPS, 2), [0.5, -0.25, 1.0]),
    "short axis": (ASYMMETRIC, [0.25, -0.5, 1.0]),
    "long axis": (ASYMMETRIC, [1.0, 0.5, -0.25]),
    "separatrix": (moments(1, 2, 2.25), SEPARATRIX),
    "just outside": (moments(1, 2, 2.25), [0.375, 0.5, 0.5 * (1 + 1e-15)]),
    "just inside": (moments(1, 2, 2.25), [0.375 * (1 + 1e-15), 0.5, 0.5]),
    "middle axis": (ASYMMETRIC, [1e-9, 1.0, 1e-9]),
    "needle": (moments(1, 1, 1e-9), [1e-3, 2e-3, 5.0]),
    "asymmetric needle": (moments(1, 1.01, 0.0101), [1e-3, 2e-3, 5.0]),
    "fast": (ASYMMETRIC, [2e10, -1e10, 3e10]),
    "slow": (ASYMMETRIC, [2e-200, -1e-200, 3e-200]),
    "turned": (ph.Inertia.from_matrix([[2, 0.3, 0.1], [0.3, 3, -0.2], [0.1, -0.2, 3.5]]), [0.25, -0.5, 1]),
}


def mixed(count, rng):
    """Bodies of all regimes in disorder, attitudes at random; and the motion of each alone."""
    picked = rng.permutation(np.arange(count) % len(REGIMES))
    cases = list(REGIMES.values())
    inertias, omegas = ([cases[k][part] for k in picked] for part in (0, 1))
    rotors = ph.Rotor.random(count, rng=rng)
    together = ph.FreeMotion(inertias, rotors, np.array(omegas, dtype=float))
    alone = [ph.FreeMotion(*one) for one in zip(inertias, rotors, omegas, strict=True)]
    return together, alone


def assert_alone(states, index, motion, t):
    state = motion.at(float(t))
    assert states.rotor[index] == state.rotor, index
    assert states.omega_body[index] == state.omega_body, index


def assert_same(state, other):
    assert np.array_equal(state.rotor.components, other.rotor.components)
    assert np.array_equal(state.omega_body.components, other.omega_body.components)


@pytest.mark.parametrize("count", [1, 2, 15, 16, 17, 100, 1023, 1024, 1025, 2100])
def test_regimes_in_lanes(count):
    rng = np.random.default_rng(count)
    together, alone = mixed(count, rng)
    times = rng.uniform(-1e6, 1e6, count)
    paired, common = together.at_each(times), together.at(12.5)
    assert paired.rotor.shape == common.omega_body.shape == (count,)
    for k in rng.permutation(count)[:300]:
        assert_alone(paired, int(k), alone[k], times[k])
        assert_alone(common, int(k), alone[k], 12.5)


@pytest.mark.parametrize("each", [1, 2, 7, 47, 48, 65])
@pytest.mark.parametrize("bodies", [3, 150])
def test_many_times_of_each(bodies, each):
    rng = np.random.default_rng(each)
    together, alone = mixed(bodies, rng)
    times = rng.uniform(-1e6, 1e6, (bodies, each))
    own, common = together[:, np.newaxis].at_each(times), together.at(times[-1])
    assert own.rotor.shape == common.rotor.shape == (bodies, each)
    turned = together.at_each(times.T)
    assert np.array_equal(turned.rotor.components.swapaxes(0, 1), own.rotor.components)
    assert np.array_equal(turned.omega_body.components.swapaxes(0, 1), own.omega_body.components)
    for k, j in zip(rng.integers(0, bodies, 200), rng.integers(0, each, 200), strict=True):
        assert_alone(own, (int(k), int(j)), alone[k], times[k, j])
        assert_alone(common, (int(k), int(j)), alone[k], times[-1, j])


@pytest.mark.parametrize(
    ("bodies", "times"),
    [
        ((), ()),
        ((), (5,)),
        ((1,), (5, 1)),
        ((70,), ()),
        ((70,), (1,)),
        ((70,), (3, 70)),
        ((70,), (2, 3, 1)),
        ((4,), (2, 3, 4)),
        ((2, 1), (3,)),
        ((70, 1), (2, 1, 3)),
        ((2, 1, 3), (5, 2, 4, 1)),
        ((2, 1, 3, 1), (4, 1, 2)),
        ((0,), (4, 1)),
        ((3,), (0, 1)),
        ((0, 1), (5,)),
    ],
)
def test_times_broadcast_with_bodies(bodies, times):
    rng = np.random.default_rng(3)
    rates = rng.normal(size=(*bodies, 3))
    motions = ph.FreeMotion(ASYMMETRIC, R0, rates)
    t = rng.uniform(-1e3, 1e3, times)
    states = motions.at_each(t)
    shape = np.broadcast_shapes(bodies, times)
    assert states.rotor.shape == states.omega_body.shape == shape
    every_rate, every_time = np.broadcast_to(rates, (*shape, 3)), np.broadcast_to(t, shape)
    for index in np.ndindex(shape):
        alone = ph.FreeMotion(ASYMMETRIC, R0, every_rate[index])
        assert_alone(states, index, alone, every_time[index])


def test_order_and_neighbours_do_not_matter():
    rng = np.random.default_rng(5)
    together, _ = mixed(1500, rng)
    times = rng.uniform(-1e3, 1e3, 1500)
    states = together.at_each(times)
    for chosen in (rng.permutation(1500), rng.permutation(1500)[:37]):
        found = together[chosen].at_each(times[chosen])
        assert_same(found, ph.State(states.rotor[chosen], states.omega_body[chosen]))


@pytest.mark.parametrize(("bodies", "each"), [(20_000, 1), (5_000, 4), (300, 70), (3, 9_001)])
def test_results_do_not_depend_on_threads(monkeypatch, bodies, each):
    rng = np.random.default_rng(bodies)
    together, _ = mixed(bodies, rng)
    times = rng.uniform(-1e6, 1e6, (bodies, each))
    columns = together[:, np.newaxis]
    found = []
    for threads in ("1", "3"):
        monkeypatch.setenv("POLHODE_NUM_THREADS", threads)
        found.append((columns.at_each(times), together.at(times[0]), together.at_each(times.T)))
    for one, three in zip(*found, strict=True):
        assert_same(one, three)


def test_reference_motions_in_a_batch():
    """Error 5e-15 as of each alone, all together and each at its own times."""
    cases = json.loads(REFERENCE.read_text())["free_top"]

    def numbers(lists):
        return np.array([[float(x) for x in texts] for texts in lists])

    copies = 7
    inertias = [moments(*i) for i in numbers(case["inertia"] for case in cases)]
    rotors = ph.Rotor.from_components(np.tile(numbers(case["R0"] for case in cases), (copies, 1)))
    omegas = np.tile(numbers(case["omega0"] for case in cases), (copies, 1))
    motions = ph.FreeMotion(copies * inertias, rotors, omegas)
    most = max(len(case["results"]) for case in cases)
    results = [case["results"] + (most - len(case["results"])) * [case["results"][-1]] for case in cases]
    times = np.tile([[float(result["t"]) for result in row] for row in results], (copies, 1))
    states = motions[:, np.newaxis].at_each(times)
    for k, (case, row) in enumerate(zip(copies * cases, copies * results, strict=True)):
        # As of single motions: an input that is not a binary number shifts the flips.
        slack = 1e-16 * times[k] if "001" in case["name"] else 0 * times[k]
        R, omega = (numbers(result[key] for result in row) for key in ("R", "omega"))
        size = np.maximum(np.abs(omega).max(axis=-1), 1e-300)
        assert (np.abs(states.rotor[k].components - R).max(axis=-1) <= 5e-15 + slack).all(), case["name"]
        wrong = np.abs(states.omega_body[k].components - omega).max(axis=-1) / size
        assert (wrong <= 5e-15 + slack).all(), case["name"]


def test_times_beyond_the_horizon_are_rejected():
    motions = ph.FreeMotion(ASYMMETRIC, R0, [[[0, 0, 1], [0, 0, 1e6]], [[0, 0, 1], [0, 0, 1]]])
    with pytest.raises(ValueError, match=r"shape \(3,\) do not broadcast with bodies .* \(2, 2\)"):
        motions.at_each([1.0, 2, 3])
    with pytest.raises(
        ValueError, match=r"at index \(1, 0, 1\): time 1e\+15 s of body \(0, 1\) is beyond 1.3e\+12"
    ):
        motions.at_each(np.reshape([1e15, 0, 1e15, 1e15], (2, 1, 2)) * np.reshape([0, 1], (2, 1, 1)))
    # Bodies that turn more slowly have a later horizon.
    times = np.array([[1e15, 1e9], [1e15, 1e15]])
    assert motions.at_each(times).rotor[1, 0] == motions[1, 0].at(1e15).rotor
    with pytest.raises(ValueError, match=r"time nan at index \(1, 0\) is not finite"):
        motions.at_each([[0, 1], [np.nan, 2]])
    with pytest.raises(TypeError, match="time must be real"):
        motions.at_each("now")


def test_too_many_states_are_refused_before_any_is_computed(monkeypatch):
    motions = ph.FreeMotion(ASYMMETRIC, R0, np.ones((1000, 3)))
    monkeypatch.setattr(memory, "available", lambda: 10**8)
    t = np.zeros(10_000)
    with pytest.raises(
        MemoryError, match=r"states of batch shape \(1000, 10000\) take 560 MB; 100 MB are free"
    ):
        motions.at(t)
    with pytest.raises(MemoryError, match=r"\(10000, 1000\) take 640 MB; 100 MB are free"):
        motions.at_each(t[:, np.newaxis])
    with pytest.raises(MemoryError, match=r"derivatives of batch shape \(1000, 10000\)"):
        motions.derivatives(t)
    with pytest.raises(MemoryError, match=r"motions of a batch of shape \(1000, 1000\) take 1 GB"):
        ph.FreeMotion(ASYMMETRIC, R0, np.broadcast_to(np.ones(3), (1000, 1000, 3)))
    monkeypatch.setattr(memory, "available", lambda: None)
    assert motions.at(t[:100]).rotor.shape == (1000, 100)


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs timers")
def test_an_interrupt_stops_the_states(monkeypatch):
    monkeypatch.setenv("POLHODE_NUM_THREADS", "1")
    # An interrupt while Python opens a file leaves it open, with a warning.
    monkeypatch.setattr(memory, "available", lambda: None)
    motions, times = ph.FreeMotion(ASYMMETRIC, R0, np.ones((1000, 3))), np.arange(10_000.0)

    def interrupt(*_):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        signal.setitimer(signal.ITIMER_REAL, 1e-3)
        with pytest.raises(KeyboardInterrupt):
            motions.at(times)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_batch_methods_equal_those_of_single_motions():
    """Other results equal those of a single motion."""
    together, alone = mixed(40, np.random.default_rng(7))
    facts, curves, changes = together.describe(), together.polhode(5), together.derivatives(3.0)
    for k, (motion, same) in enumerate(zip(together, alone, strict=True)):
        one = same.describe()
        assert facts["regime"][k] == motion.describe()["regime"] == one["regime"]
        assert facts["energy"][k] == one["energy"]
        assert np.array_equal(curves[k].components, same.polhode(5).components)
        assert np.array_equal(changes.d_rotor_d_omega[k], same.derivatives(3.0).d_rotor_d_omega)
