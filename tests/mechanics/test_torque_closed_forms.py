"""Torque laws with motions in closed form: DOP853 on Euler's equations with `Torque.at`.

The integration errs by some 1e-13 of a turn for each radian turned, and the bounds are 100 times that.
"""

import json

import numpy as np
import pytest

import polhode as ph
from motions import R0, REFERENCE, START, moments

T = ph.torque
E3 = ph.e1 ^ ph.e2
CASES = {case["name"]: case for case in json.loads(REFERENCE.read_text())["torqued"]}


def integrated(inertia, state, times, law):
    """Return rotor components and angular velocities, by the method that is chosen for the law."""
    motion = ph.simulate(inertia, state, times, law, rtol=1e-11)
    return motion.rotor.components, motion.omega_body.components


def agree(found, expected, turned):
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-11 * (1 + turned))


def reference(name, law, until):
    """The 40-digit motion of a reference case up to a time."""
    case = CASES[name]
    number = lambda row: [float(x) for x in row]  # noqa: E731
    results = [result for result in case["results"] if float(result["t"]) <= until]
    times = [float(result["t"]) for result in results]
    rotors = np.array([number(result["R"]) for result in results])
    omegas = np.array([number(result["omega"]) for result in results])
    start = (case["R0"], case["omega0"]) if "R0" in case else (rotors[0], omegas[0])
    state = ph.State(ph.Rotor.from_components(number(start[0])), number(start[1]))
    found = integrated(moments(*number(case["inertia"])), state, times, law)
    agree(found, (rotors, omegas), times[-1] * np.linalg.norm(omegas, axis=1).max())


def test_the_larmor_torque_on_a_sphere():
    reference("sphere_larmor", T.larmor([0.125, 0.5, 1.0]), 10)
    in_formula = T.formula("dual(L) ∧ b", frame="space", b=ph.vector([0.125, 0.5, 1.0]))
    reference("sphere_larmor", in_formula, 10)


def test_damping_of_any_body():
    reference("isotropic_damping", T.damping(0.125), 10)
    reference("isotropic_damping", T.formula("−g L", g=0.125, frame="space"), 10)


def test_the_manufactured_precession():
    params = {key: float(value) for key, value in CASES["manufactured_steady_precession"]["params"].items()}
    g = "⟨exp(½ s t e1e2) k exp(−½ s t e1e2)⟩_1"
    law = T.formula(
        f"I(−ν s {g}·(e1e2) I) + I(ν {g} I + s e1e2) × (ν {g} I + s e1e2)",
        s=params["s"],
        k=ph.vector([0, np.sin(params["theta"]), np.cos(params["theta"])]),
        ν=params["nu"],
    )
    reference("manufactured_steady_precession", law, 10)


TIMES = np.linspace(0, 6, 7)
AXIS = ph.bivector([0.6, 0.0, -0.8])


def about_an_axis(angles, rates):
    """Return rotors and angular velocities of turns about AXIS."""
    half = np.asarray(angles)[:, np.newaxis] / 2
    return np.hstack([np.cos(half), -np.sin(half) * AXIS.components]), np.outer(rates, AXIS.components)


def test_quadratic_damping_of_a_sphere():
    """`i ω' = −k ω²`: ω = ω0/(1 + k ω0 t/i), and the angle is `ln(1 + k ω0 t/i) i/k`."""
    i, k, w = 2.0, 0.5, 3.0
    law = T.quadratic_damping(k)
    found = integrated(moments(i, i, i), ph.State(ph.Rotor.identity(), w * AXIS), TIMES, law)
    growth = 1 + k * w * TIMES / i
    agree(found, about_an_axis(np.log(growth) * i / k, w / growth), 10)


def test_viscous_damping_about_principal_axes():
    """About each principal axis `i ω' = −d ω`."""
    i, d, w = [1.0, 2.0, 2.5], [0.5, 0.25, 1.0], 2.0
    for axis in range(3):
        omega = np.zeros(3)
        omega[axis] = w
        _, found = integrated(moments(*i), ph.State(R0, omega), TIMES, T.viscous_damping(d))
        expected = np.zeros((7, 3))
        expected[:, axis] = w * np.exp(-d[axis] / i[axis] * TIMES)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-10)


def test_a_torsion_pendulum():
    """`i θ'' = −k θ` from rest at 3 rad: θ = 3 cos √(k/i) t, as long as |θ| < π."""
    i, k = 2.0, 1.5
    rate = np.sqrt(k / i)
    start = ph.Rotor.from_plane_angle(AXIS, 3.0)
    found = integrated(moments(i, i, i), ph.State(R0 * start, 0 * AXIS), TIMES, T.torsion_spring(k, R0))
    angles = 3 * np.cos(rate * TIMES)
    rotors, omegas = about_an_axis(angles, -3 * rate * np.sin(rate * TIMES))
    rotors = (R0 * ph.Rotor.from_components(rotors)).components
    agree(found, (rotors, omegas), 10)


def test_control_is_a_damped_oscillator():
    """`i θ'' = −kp θ − kd θ'`: θ = e^(−st) (θ0 cos wt + (s θ0/w) sin wt), s = kd/2i, w² = kp/i − s²."""
    i, kp, kd, angle = 2.0, 3.0, 1.0, 2.5
    s = kd / (2 * i)
    w = np.sqrt(kp / i - s * s)
    decay, cos, sin = np.exp(-s * TIMES), np.cos(w * TIMES), np.sin(w * TIMES)
    state = ph.State(ph.Rotor.from_plane_angle(AXIS, angle), 0 * AXIS)
    found = integrated(moments(i, i, i), state, TIMES, T.pd_control(kp, kd))
    angles = angle * decay * (cos + s / w * sin)
    agree(found, about_an_axis(angles, -angle * decay * (s * s / w + w) * sin), 10)


def test_control_brings_any_body_to_its_target():
    """V = ½ kp·Θ² and the spin die away: after 60 s the slowest mode has fallen by e^(−15)."""
    target = ph.Rotor.from_components([1, 0.2, 0.3, -0.1])
    law = T.pd_control(2.0, [1.0, 1.5, 2.0], target)
    rotors, omegas = integrated(moments(1, 2, 2.5), START, np.array([60.0]), law)
    assert abs(abs(ph.Rotor.from_components(rotors[0]).components @ target.components) - 1) < 1e-6
    assert np.linalg.norm(omegas) < 1e-3


def test_a_symmetric_body_with_a_wheel_on_its_axis():
    """`L = i1 Ω_B + ((i3 − i1) ω3 + h) I e3`: handout eq. (4.35) with Ω_r = ((i1 − i3) ω3 − h) I e3 / i1."""
    i1, i3, h = 1.5, 0.5, 2.0
    inertia, w3 = moments(i1, i1, i3), START.omega_body.components[2]
    L = R0(inertia(START.omega_body) + h * E3)
    right = ((i1 - i3) * w3 - h) / i1 * E3
    rotors = [((-t / (2 * i1) * L).exp() * R0 * (-t / 2 * right).exp()).components for t in TIMES]
    omegas = [(~ph.Rotor.from_components(R))(L).components for R in rotors]
    omegas = (np.array(omegas) - [0, 0, h]) / [i1, i1, i3]
    agree(integrated(inertia, START, TIMES, T.gyrostat(h * E3)), (np.array(rotors), omegas), 10)


def test_a_dipole_swings_as_a_pendulum():
    """In the plane of dipole and field, `i θ'' = −m B sin θ`; the energy gives the rate at the bottom."""
    m, B, i, angle = 0.5, 2.0, 1.5, 1.0
    state = ph.State(ph.Rotor.from_plane_angle(E3, angle), [0, 0, 0])
    law = T.magnetic(m * ph.e1, B * ph.e1)
    from scipy.special import ellipk

    quarter = ellipk(np.sin(angle / 2) ** 2) / np.sqrt(m * B / i)
    rotors, omegas = integrated(moments(1, 2, i), state, np.array([quarter, 2 * quarter]), law)
    np.testing.assert_allclose(rotors[0], [1, 0, 0, 0], atol=1e-11)
    np.testing.assert_allclose(omegas[0], [0, 0, -np.sqrt(2 * m * B * (1 - np.cos(angle)) / i)], atol=1e-11)
    assert ph.Rotor.from_components(rotors[1]).is_close(~state.rotor, rtol=1e-11)


@pytest.mark.parametrize("frame", ["body", "space"])
def test_a_table_turns_a_sphere_as_its_integral_says(frame):
    """`i ω' = N(t)` about a fixed axis, N the parabola of three rows: ω = ∫N/i."""
    times, rows = [0.0, 2.0, 6.0], np.outer([1.0, -0.5, 0.25], AXIS.components)
    law = T.tabulated(times, rows, frame=frame, kind="cubic")
    fit = np.polyfit(times, [1.0, -0.5, 0.25], 2)
    rate = np.polyint(fit) / 2.0
    angle = np.polyint(rate)
    found = integrated(moments(2, 2, 2), ph.State(ph.Rotor.identity(), 0 * AXIS), TIMES, law)
    agree(found, about_an_axis(np.polyval(angle, TIMES), np.polyval(rate, TIMES)), 10)
