"""Batches of heavy tops, damped bodies and spheres in a field equal single motions, also in ensembles."""

import copy
import pickle

import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, EPS, R0, moments

TIMES = np.array([[0.0, -7.5, 1e6], [0.25, 3.0, 100.0]])
TOPS = [moments(1, 1, 0.5), moments(1, 1, 0.5), moments(1, 1, 0.5), moments(1.5, 1, 1)]
# Waves, a fall from near the upright, the separatrix of the pendulum, and turning about e1.
HALVES = np.array([0.25, 5e-5, 0.5 * np.pi, 0.15])
ROTORS = ph.Rotor.from_components(
    np.stack([np.cos(HALVES).round(15), -np.sin(HALVES), 0 * HALVES, 0 * HALVES], axis=-1)
)
OMEGAS = np.array([[0.25, -0.5, 8], [0, 0, 1.0], [2.0, 0, 0], [4.0, 0.5, -0.5]])
C = np.array([[0, 0, 2.0], [0, 0, 2.0], [0, 0, 1.0], [-2.0, 0, 0]])
BODIES = [ASYMMETRIC, moments(2, 2, 1), moments(2, 2, 2), moments(1, 2, 2.25)]
G = np.array([0.3, -1e-6, 0.0, 1e-9])
SPHERE = moments(2, 2, 2)
B = np.array([[0, 0, 0.5], [1.0, 2, 3], [0, 0, 0], [-1, 0.5, 0]])

LAWS = {
    "heavy": (ph.LagrangeTop, TOPS, ROTORS, OMEGAS, C, ph.torque.heavy),
    "damped": (ph.DampedTop, BODIES, ROTORS, OMEGAS, G, ph.torque.damping),
    "larmor": (ph.LarmorSphere, [SPHERE] * 4, ROTORS, OMEGAS, B, ph.torque.larmor),
}
every_law = pytest.mark.parametrize("law", LAWS)


def single(law, k):
    kind, bodies, rotors, omegas, numbers, _ = LAWS[law]
    return kind(bodies[k], rotors[k], omegas[k], numbers[k])


def batch(law):
    kind, *arguments, _ = LAWS[law]
    return kind(*arguments)


def assert_same(state, other):
    assert np.array_equal(state.rotor.components, other.rotor.components)
    assert np.array_equal(state.omega_body.components, other.omega_body.components)


@every_law
def test_bodies_by_times(law):
    motions, many = batch(law), np.linspace(-20, 20, 60)
    assert motions.shape == (4,)
    assert len(motions) == 4
    states, long = motions.at(TIMES), motions.at(many)
    assert states.rotor.shape == states.omega_body.shape == (4, 2, 3)
    for k in range(4):
        one = single(law, k)
        assert_same(one.at(TIMES), motions[k].at(TIMES))
        assert_same(one.at(TIMES), states[k])
        assert_same(one.at(many), long[k])
        for index in np.ndindex(TIMES.shape):
            assert one.at(float(TIMES[index])).rotor == states.rotor[k, *index]
    assert [motion.at(2.0).rotor.shape for motion in motions] == [()] * 4


@every_law
def test_own_times(law):
    motions, times = batch(law), np.array([0.5, -2.0, 30.0, 7.25])
    assert_same(motions.at_each(times)[2], single(law, 2).at(30.0))
    each = motions.at_each(np.stack([times, 2 * times]))
    assert each.shape == (2, 4)
    assert_same(each[1, 3], single(law, 3).at(14.5))
    with pytest.raises(ValueError, match=r"of shape \(3,\) do not broadcast"):
        motions.at_each([1.0, 2.0, 3.0])
    with pytest.raises(ValueError, match=r"time inf at index \(1,\) is not finite"):
        motions.at_each([0, np.inf, 0, 0])


@every_law
def test_many_bodies_in_lanes(law):
    kind, bodies, rotors, omegas, numbers, _ = LAWS[law]
    order = np.arange(2500) % 4
    inertias = np.array(bodies, dtype=object)[order]
    many = kind(inertias, rotors[order], omegas[order], numbers[order])
    four = batch(law)
    for t in (0.0, 3.5):
        assert_same(many.at(t), four.at(t)[order])
    times = np.linspace(0, 10, 2500)
    assert_same(many.at_each(times)[2001], single(law, 2001 % 4).at(times[2001]))


@every_law
def test_batches_broadcast(law):
    kind, bodies, _, omegas, numbers, _ = LAWS[law]
    rotors = ph.Rotor.random((3, 1), rng=2)
    motions = kind(bodies, rotors, omegas, numbers)
    assert motions.shape == motions.at(1.0).rotor.shape == (3, 4)
    assert_same(motions[2, 1].at(2.0), kind(bodies[1], rotors[2, 0], omegas[1], numbers[1]).at(2.0))
    assert motions[:, 1].shape == (3,)
    assert kind(bodies[0], R0, omegas[0], numbers[:1]).shape == (1,)
    none = kind(bodies[0], R0, np.zeros((0, 3)), numbers[0])
    assert none.at([1.0, 2.0]).rotor.shape == (0, 2)
    with pytest.raises(ValueError, match=r"\(4,\) of the inertia, \(5,\) of the rotor.*do not broadcast"):
        kind(bodies, ph.Rotor.identity((5,)), omegas[0], numbers[0])
    with pytest.raises(TypeError, match="single motion has no length"):
        len(single(law, 0))
    with pytest.raises(MemoryError):
        motions.at(np.broadcast_to(0.0, (1 << 40,)))


@every_law
def test_batches_are_copied_and_named(law):
    for motions in (batch(law), batch(law)[:0], single(law, 1)):
        same = pickle.loads(pickle.dumps(motions))
        assert same.shape == motions.shape
        assert_same(same.at(2.5), motions.at(2.5))
        assert_same(copy.copy(motions).at(2.5), motions.at(2.5))
        assert repr(same) == repr(motions)
    assert repr(batch(law)) == f"{type(batch(law)).__name__}(batch (4,))"
    with pytest.raises(ValueError, match="batch of shape"):
        batch(law).view()


def test_tops_are_described_in_columns():
    found = batch("heavy").describe()
    for k in range(4):
        alone = single("heavy", k).describe()
        assert found.keys() == alone.keys()
        for name, value in alone.items():
            column = found[name][k]
            assert column == value or (value is None and np.isnan(column))
    assert found["regime"].tolist()[2] == "separatrix"
    assert batch("heavy")[:0].describe()["regime"].shape == (0,)


def test_errors_have_the_place_of_the_body():
    with pytest.raises(ValueError, match=r"at index \(1,\): .*all differ"):
        ph.LagrangeTop([TOPS[0], ASYMMETRIC], R0, [0, 0, 1], [0, 0, 1])
    with pytest.raises(ValueError, match=r"at index \(2,\): .*not along the axis"):
        ph.LagrangeTop(TOPS[0], R0, [0, 0, 1], [[0, 0, 1], [0, 0, 2], [0.1, 0, 1]])
    with pytest.raises(ValueError, match=r"at index \(1,\): c is \[0.0, 0.0, nan\]; it must be finite"):
        ph.LagrangeTop(TOPS[0], R0, [0, 0, 1], [[0, 0, 1], [0, 0, np.nan]])
    with pytest.raises(ValueError, match=r"at index \(1, 0\): .*angular velocity"):
        ph.DampedTop(ASYMMETRIC, R0, [[[0, 0, 1]], [[0, np.inf, 1]]], 0.1)
    with pytest.raises(ValueError, match=r"at index \(1,\): the damping g is NaN"):
        ph.DampedTop(ASYMMETRIC, R0, [0, 0, 1], [0.5, np.nan])
    with pytest.raises(ValueError, match=r"at index \(1,\): .*not a sphere"):
        ph.LarmorSphere([SPHERE, ASYMMETRIC], R0, [0, 0, 1], [0, 0, 1])
    with pytest.raises(TypeError, match=r"at index \(1,\): inertia must be an Inertia, got int"):
        ph.LarmorSphere([SPHERE, 2], R0, [0, 0, 1], [0, 0, 1])


def test_horizons_have_two_sides():
    motions = ph.DampedTop(ASYMMETRIC, R0, [0.5, 1, 0.25], [0.125, -0.125])
    # The first decays forwards, the second backwards.
    assert np.abs(motions.at_each([1e9, -1e9]).omega_body.components).max() < 1e-300
    with pytest.raises(ValueError, match=r"at index \(1,\): time 1e\+09 s of body \(1,\) is beyond"):
        motions.at_each([1e9, 1e9])
    with pytest.raises(ValueError, match=r"at index \(0,\): .*times\[0\] = -1.*is beyond"):
        motions.at(-1e9)
    with pytest.raises(ValueError, match=r"at index \(1,\): .*is beyond"):
        motions.at([0.0, 1e9])


@every_law
@pytest.mark.parametrize("start", [0.0, 0.1])
def test_ensembles_take_the_closed_form_of_a_single_body(law, start):
    _, bodies, rotors, omegas, numbers, torque = LAWS[law]
    times = np.linspace(0, 5, 40)
    found = ph.simulate(bodies, ph.State(rotors, omegas, time=start), times, torque(numbers))
    assert found.certificate.method == "exact"
    for k, body in enumerate(bodies):
        state = ph.State(rotors[k], omegas[k], time=start)
        alone = ph.simulate(body, state, times, torque(numbers[k]))
        assert_same(found[k], alone)
        own, one = found[k].certificate, alone.certificate
        assert (own.method, own.steps, own.error_estimate) == (one.method, 0, one.error_estimate)
        assert own.drift.keys() == one.drift.keys()
        assert own.norm_drift == one.norm_drift
        assert np.abs(found[k].energy - alone.energy).max() <= 64 * EPS * np.abs(alone.energy).max()


def test_ensembles_report_what_the_closed_form_neglects():
    bodies = [moments(2, 2, 2 * (1 + 4 * EPS)), SPHERE]
    found = ph.simulate(bodies, ph.State(R0, [0.5, 1, 0.25]), [1e8], ph.torque.larmor([0.1, 0.5, 1.0]))
    estimates = found.certificate.error_estimate
    assert estimates[0] > 1e-8
    assert np.isnan(estimates[1])
    # A tolerance below it leads to steps, which may be refused.
    state, law = ph.State(R0, [0.5, 1, 0.25]), ph.torque.larmor([0.1, 0.5, 1])
    strict = ph.simulate(bodies, state, [0.5, 4], law, rtol=3e-15)
    assert [failure.index for failure in strict.failures] == [(0,)]
    assert "halving the step" in strict.failures[0].message
    assert_same(strict[1], ph.simulate(SPHERE, state, [0.5, 4], law))
