"""Batches of free motions equal single motions."""

import copy
import pickle

import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, R0, moments

BODIES = [moments(1, 2, 3), moments(2, 2, 1), moments(2, 2, 2), moments(1, 2, 2.25)]
OMEGAS = ph.bivector([[0.25, -0.5, 1], [0.5, -0.25, 1], [0.5, 0.25, 1], [0.375, 0.5, 0.5]])
TIMES = np.array([[0.0, -7.5, 1e6], [0.25, 3.0, 100.0]])


def assert_same(state, other):
    assert np.array_equal(state.rotor.components, other.rotor.components)
    assert np.array_equal(state.omega_body.components, other.omega_body.components)


def test_bodies_by_times():
    motions = ph.FreeMotion(BODIES, R0, OMEGAS)
    assert motions.shape == (4,)
    states = motions.at(TIMES)
    assert states.rotor.shape == states.omega_body.shape == (4, 2, 3)
    for k, body in enumerate(BODIES):
        one = ph.FreeMotion(body, R0, OMEGAS[k])
        assert_same(one.at(TIMES), motions[k].at(TIMES))
        for index in np.ndindex(TIMES.shape):
            state = one.at(float(TIMES[index]))
            assert state.rotor == states.rotor[k, *index]
            assert state.omega_body == states.omega_body[k, *index]
    assert motions.at(2.0).rotor.shape == (4,)
    assert motions.at(2.0).rotor[3] == ph.FreeMotion(BODIES[3], R0, OMEGAS[3]).at(2.0).rotor


def test_batches_broadcast():
    rotors = ph.Rotor.random((3, 1), rng=2)
    motions = ph.FreeMotion(BODIES, rotors, OMEGAS)
    assert motions.shape == (3, 4)
    assert len(motions) == 3
    state = motions.at([1.0, 2.0])
    assert state.rotor.shape == (3, 4, 2)
    assert_same(motions[2, 1].at(2.0), ph.FreeMotion(BODIES[1], rotors[2, 0], OMEGAS[1]).at(2.0))
    assert motions[:, 1].shape == (3,)
    assert [row.shape for row in motions] == [(4,)] * 3
    table = np.array([[BODIES[0]], [BODIES[1]]], dtype=object)
    assert ph.FreeMotion(table, R0, OMEGAS).shape == (2, 4)
    nested = [[BODIES[0]] * 4, [BODIES[1]] * 4]
    assert_same(ph.FreeMotion(nested, R0, OMEGAS).at(3.0), ph.FreeMotion(table, R0, OMEGAS).at(3.0))
    assert ph.FreeMotion(ASYMMETRIC, R0, np.ones((5, 3))).shape == (5,)
    assert ph.FreeMotion([ASYMMETRIC], R0, [0, 0, 1]).shape == (1,)


def test_empty_batches():
    none = ph.FreeMotion(ASYMMETRIC, R0, np.zeros((0, 3)))
    assert none.at([1.0, 2.0]).rotor.shape == (0, 2)
    assert none.describe()["regime"].shape == (0,)
    assert none.polhode(5).shape == (0, 5)
    assert none.derivatives(1.0).d_rotor_d_omega.shape == (0, 4, 3)
    assert ph.FreeMotion(BODIES, R0, OMEGAS).at(np.zeros((0, 2))).rotor.shape == (4, 0, 2)


@pytest.mark.parametrize(("bodies", "times"), [(20_000, 1), (2_500, 5), (300, 70), (3, 9_001)])
def test_results_do_not_depend_on_threads(monkeypatch, bodies, times):
    rng = np.random.default_rng(bodies)
    inertias = [moments(1, 1 + x, 1.5 + x / 2) for x in rng.uniform(0, 1, 7)]
    inertias = [inertias[k % 7] for k in range(bodies)]
    rotors, omegas = ph.Rotor.random(bodies, rng=rng), rng.normal(size=(bodies, 3))
    t = rng.uniform(-1e6, 1e6, times)
    monkeypatch.setenv("POLHODE_NUM_THREADS", "1")
    alone = ph.FreeMotion(inertias, rotors, omegas)
    states, changes = alone.at(t), alone[:200].derivatives(t[:70])
    monkeypatch.setenv("POLHODE_NUM_THREADS", "3")
    shared = ph.FreeMotion(inertias, rotors, omegas)
    assert_same(shared.at(t), states)
    assert np.array_equal(shared[:200].derivatives(t[:70]).d_rotor_d_moments, changes.d_rotor_d_moments)
    for k in rng.integers(0, bodies, 20):
        one = ph.FreeMotion(inertias[k], rotors[k], omegas[k])
        for j in rng.integers(0, times, 3):
            assert one.at(t[j]).rotor == states.rotor[k, j]
            assert one.at(t[j]).omega_body == states.omega_body[k, j]


def test_descriptions_are_arrays():
    motions = ph.FreeMotion([BODIES, BODIES], R0, OMEGAS)
    facts = motions.describe()
    for index in np.ndindex(2, 4):
        for name, value in motions[index].describe().items():
            found = facts[name][index]
            assert np.isnan(found) if value is None else found == value, name
    assert list(facts["regime"][0]) == [
        "short-axis mode",
        "symmetric top, regular precession",
        "steady rotation about a fixed axis",
        "separatrix",
    ]


def test_curves_and_derivatives_of_batches():
    motions = ph.FreeMotion(BODIES, R0, OMEGAS)
    polhodes, herpolhodes = motions.polhode(9), motions.herpolhode(9, 2.5)
    changes = motions.derivatives(TIMES[:, :2])
    assert changes.d_omega_dt.shape == (4, 2, 2, 3)
    for k, one in enumerate(motions):
        assert np.array_equal(one.polhode(9).components, polhodes[k].components)
        assert np.array_equal(one.herpolhode(9, 2.5).components, herpolhodes[k].components)
        own = one.derivatives(TIMES[1, 1])
        for name in vars(own):
            assert np.array_equal(getattr(own, name), getattr(changes, name)[k, 1, 1]), name


@pytest.mark.parametrize("motion", [
    ph.FreeMotion(BODIES, R0, OMEGAS),
    ph.FreeMotion(ASYMMETRIC, R0, OMEGAS),
    ph.FreeMotion(ASYMMETRIC, R0, [1, 2, 3]),
    ph.SymmetricTop(moments(1, 1, 2), R0, [1, 2, 3]),
])  # fmt: skip
def test_motions_can_be_pickled(motion):
    for other in (pickle.loads(pickle.dumps(motion)), copy.deepcopy(motion), copy.copy(motion)):
        assert type(other) is type(motion)
        assert other.shape == motion.shape
        assert_same(other.at(12.5), motion.at(12.5))


def test_other_dtypes_are_accepted():
    expected = ph.FreeMotion(ASYMMETRIC, R0, [1.0, 2.0, 3.0]).at(1.5)
    for omega in ([1, 2, 3], (1, 2, 3), np.array([1, 2, 3]), ph.bivector([1, 2, 3], dtype=object)):
        assert_same(ph.FreeMotion(ASYMMETRIC, R0, omega).at(1.5), expected)
    strided = np.array([[1.0, 0], [2, 0], [3, 0]])[:, 0]
    assert_same(ph.FreeMotion(ASYMMETRIC, R0, strided).at(np.float64(1.5)), expected)


def test_errors_name_the_index():
    rates = np.ones((2, 3, 3))
    rates[1, 2, 0] = np.nan
    with pytest.raises(ValueError, match=r"at index \(1, 2\): the angular velocity is \[NaN.*must be finite"):
        ph.FreeMotion(ASYMMETRIC, R0, rates)
    thin = ph.Inertia.from_principal_moments(1, 1, 0)
    with pytest.raises(ValueError, match=r"at index \(2,\): principal moments 1, 1, 0"):
        ph.FreeMotion([ASYMMETRIC, ASYMMETRIC, thin], R0, [0, 0, 1])
    with pytest.raises(ValueError, match=r"^principal moments 1, 1, 0"):
        ph.FreeMotion(thin, R0, [0, 0, 1])
    with pytest.raises(TypeError, match=r"at index \(1,\): inertia must be an Inertia, got float"):
        ph.FreeMotion([ASYMMETRIC, 1.0], R0, [0, 0, 1])
    with pytest.raises(ValueError, match="do not broadcast"):
        ph.FreeMotion(BODIES, R0, np.ones((3, 3)))
    motions = ph.FreeMotion(ASYMMETRIC, R0, [[0, 0, 1], [0, 0, 1e6]])
    with pytest.raises(ValueError, match=r"at index \(1,\): times\[2\] = 1e15 s is beyond"):
        motions.at([0.0, 1.0, 1e15])
    with pytest.raises(ValueError, match="time inf at index 1"):
        motions.at([0.0, np.inf])
    with pytest.raises(IndexError, match=r"batch shape \(2,\)"):
        motions[2]
    with pytest.raises(IndexError):
        motions[0][0]
    with pytest.raises(TypeError, match="no length"):
        len(motions[0])
    with pytest.raises(ValueError, match="one body, got batch"):
        ph.SymmetricTop(moments(1, 1, 2), R0, np.ones((2, 3)))
