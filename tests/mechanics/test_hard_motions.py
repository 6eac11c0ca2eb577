"""Difficult motions: strong damping, springs past half a turn, wheels at rest, chaos, close times."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import polhode as ph

BODY = ph.Inertia.from_principal_moments(1, 2, 2.5)
ROTOR = ph.Rotor.from_rotation_vector([0.4, -0.9, 0.3])


@pytest.mark.parametrize("g", [50.0, 1e4, 1e9])
def test_a_strongly_damped_body_stops_at_the_free_attitude_of_one_over_g(g: float) -> None:
    found = ph.simulate(BODY, ph.State(ROTOR, ph.bivector([0.3, 1.2, 0.7])), [100.0], ph.torque.damping(g))
    expected = ph.FreeMotion(BODY, ROTOR, [0.3, 1.2, 0.7]).at(1 / g).rotor
    assert found.certificate.method == "exact"
    np.testing.assert_allclose(found.rotor.components[-1], expected.components, rtol=0, atol=4e-16)
    assert np.abs(found.omega_body.components).max() < 1e-300


def test_before_the_horizon_of_a_growing_spin_is_an_error() -> None:
    with pytest.raises(ValueError, match=r"times\[0\] = -1"):
        ph.simulate(BODY, ph.State(ROTOR, ph.bivector([0.3, 1.2, 0.7])), [-1.0, 1.0], ph.torque.damping(1e4))


def test_a_damped_body_needs_a_finite_spin() -> None:
    with pytest.raises(ValueError, match="angular velocity is inf"):
        ph.DampedTop(BODY, ROTOR, [np.inf, 0, 0], 0.1)


def test_a_spring_may_be_turned_past_half_a_turn() -> None:
    # About a principal axis: θ'' = −k θ from rest attitude at ω0 > π√k; at π the torque turns round, so the
    # motion repeats after half the swing: sin(√k t) ω0/√k up to π, then its mirror image.
    k, spin = 1.0, 5.0
    half = np.arcsin(np.pi * np.sqrt(k) / spin) / np.sqrt(k)
    times = np.array([0.5 * half, 1.5 * half, 2 * half, 4 * half])
    sphere = ph.Inertia.from_principal_moments(1, 1, 1)
    state = ph.State(ph.Rotor.identity(), ph.bivector([0, 0, spin]))
    found = ph.simulate(sphere, state, times, ph.torque.torsion_spring(k), rtol=1e-9)
    first = spin / np.sqrt(k) * np.sin(np.sqrt(k) * 0.5 * half)
    angles = np.array([first, 2 * np.pi - first, 2 * np.pi, 4 * np.pi])
    expected = np.stack([np.cos(angles / 2), 0 * angles, 0 * angles, -np.sin(angles / 2)], axis=-1)
    np.testing.assert_allclose(found.rotor.components, expected, rtol=0, atol=1e-8)
    assert found.certificate.drift["energy"] < 1e-8


def test_a_swing_below_half_a_turn_keeps_its_energy() -> None:
    state = ph.State(ph.Rotor.identity(), ph.bivector([0.3, 0.2, 0.5]))
    found = ph.simulate(BODY, state, [100.0], ph.torque.torsion_spring(1.0))
    assert found.certificate.method == "kahan_li8"


@pytest.mark.parametrize("damping", [0.0, 0.1])
def test_a_wheel_leaves_a_body_at_rest(damping: float) -> None:
    law = ph.torque.gyrostat([1.0, 2.0, 3.0]) + ph.torque.viscous_damping(damping)
    found = ph.simulate(BODY, ph.State(ROTOR, ph.bivector([0.0, 0.0, 0.0])), [10.0], law)
    np.testing.assert_allclose(found.omega_body.components, 0, atol=1e-12)


def test_chaos_is_reported() -> None:
    state = ph.State(ph.Rotor.identity(), ph.bivector([0.1, 0.2, 0.5]))
    with pytest.raises(ValueError, match=r"differ completely.*a shorter time"):
        ph.simulate(BODY, state, [500.0], ph.torque.heavy([1.0, 0.2, 0.3]))


def test_the_default_tolerance_allows_for_rounding() -> None:
    state = ph.State(ph.Rotor.identity(), ph.bivector([0.1, 0.2, 1.0]))
    found = ph.simulate(BODY, state, [1e4], ph.torque.gravity_gradient(0.1, 0.3))
    assert found.certificate.error_estimate is not None
    assert 1e-10 < found.certificate.error_estimate < 1e-6


def test_output_times_may_be_adjacent_floats() -> None:
    times = [1.0, np.nextafter(1.0, 2), 100.0, np.nextafter(100.0, 200), 101.0]
    found = ph.simulate(
        BODY, ph.State(ROTOR, ph.bivector([0.1, 0.2, 1.0])), times, ph.torque.viscous_damping(0.1)
    )
    gap = np.abs(np.diff(found.rotor.components, axis=0)).max(axis=1)
    assert gap[0] < 1e-15
    assert gap[2] < 1e-14


@pytest.mark.parametrize("text", ["A", "sin(3 t)/norm(sin(3 t) + 0.01 e1) A"])
@pytest.mark.parametrize("bodies", [BODY, [BODY]])
def test_the_first_output_time_may_be_adjacent_to_the_start(text, bodies) -> None:
    law = ph.torque.formula(text, A=ph.e1 ^ ph.e2)
    times = [np.nextafter(100.0, 200), 100.5, np.nextafter(100.5, 200), 101.0]
    state = ph.State(ROTOR, ph.bivector([0.1, 0.2, 1.0]), time=100.0)
    found = ph.simulate(bodies, state, times, law, method="dop853")
    rotors = found.rotor.components.reshape(4, 4)
    assert np.abs(rotors[0] - ROTOR.components).max() < 1e-13
    assert np.abs(rotors[2] - rotors[1]).max() < 1e-13
    assert np.all(found.certificate.error_estimate < 1e-10)


@pytest.mark.parametrize(
    "solution",
    [
        ph.LagrangeTop(ph.Inertia.from_principal_moments(1, 1, 2), ROTOR, [1, 2, 3], [0, 0, 1]),
        ph.DampedTop(BODY, ROTOR, [1, 2, 3], 0.1),
        ph.LarmorSphere(ph.Inertia.from_principal_moments(1, 1, 1), ROTOR, [1, 2, 3], [0, 0, 1]),
    ],
)
def test_closed_forms_have_a_repr_and_can_be_pickled(solution: ph.DampedTop) -> None:
    same = pickle.loads(pickle.dumps(solution))
    assert repr(same) == repr(solution)
    assert "moments" in repr(solution)
    np.testing.assert_array_equal(same.at(2.0).rotor.components, solution.at(2.0).rotor.components)


def test_a_pickled_trajectory_keeps_its_states() -> None:
    law = ph.torque.heavy([1.0, 0.2, 0.3])
    found = ph.simulate(BODY, ph.State(ROTOR, ph.bivector([1, 2, 3])), [1.0, 2.0], law)
    same = pickle.loads(pickle.dumps(found))
    np.testing.assert_array_equal(same.rotor.components, found.rotor.components)
    assert same.certificate == found.certificate
    with pytest.raises(ValueError, match="unpickled"):
        same.at(1.5)


def test_the_module_of_torques_lists_laws() -> None:
    assert {"heavy", "Torque", "tabulated"} <= set(dir(ph.torque))
    assert "np" not in dir(ph.torque)
