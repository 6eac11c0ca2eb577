"""Many free bodies side by side: every state has the bits of one body at one time, whatever stands beside it."""

import json

import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, EPS, R0, REFERENCE, moments
from polhode import _free_motion, _memory

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


def picked(motions, indices):
    """Some bodies of a batch of one axis, as a batch of their own."""
    return motions[np.asarray(indices)]


@pytest.mark.parametrize("count", [1, 2, 15, 16, 17, 100, 1023, 1024, 1025, 2100])
def test_regimes_side_by_side(count):
    rng = np.random.default_rng(count)
    together, alone = mixed(count, rng)
    times = rng.uniform(-1e6, 1e6, count)
    paired, common = together.at_each(times), together.at(12.5)
    assert paired.rotor.shape == common.omega_body.shape == (count,)
    for k in rng.permutation(count)[:300]:
        assert_alone(paired, int(k), alone[k], times[k])
        assert_alone(common, int(k), alone[k], 12.5)


@pytest.mark.parametrize("each", [2, 7, 47, 48, 65])
def test_many_times_of_each(each):
    rng = np.random.default_rng(each)
    together, alone = mixed(150, rng)
    times = rng.uniform(-1e6, 1e6, (150, each))
    columns = ph.FreeMotion.__getitem__(together, (slice(None), np.newaxis))
    own, common = columns.at_each(times), together.at(times[3])
    assert own.rotor.shape == common.rotor.shape == (150, each)
    assert_same(together.at_each(times.T).rotor.shape and together.at_each(times.T[:1]), columns[:, 0].at_each(times.T[:1]))
    for k, j in zip(rng.integers(0, 150, 300), rng.integers(0, each, 300), strict=True):
        assert_alone(own, (int(k), int(j)), alone[k], times[k, j])
        assert_alone(common, (int(k), int(j)), alone[k], times[3, j])


def test_order_and_neighbours_do_not_matter():
    rng = np.random.default_rng(5)
    together, _ = mixed(1500, rng)
    times = rng.uniform(-1e3, 1e3, 1500)
    states = together.at_each(times)
    order = rng.permutation(1500)
    shuffled = picked(together, order).at_each(times[order])
    assert_same(shuffled, ph.State(states.rotor[order], states.omega_body[order]))
    few = rng.permutation(1500)[:37]
    assert_same(picked(together, few).at_each(times[few]), ph.State(states.rotor[few], states.omega_body[few]))
