"""Bodies on a torsion spring that turn over: the torque jumps at half a turn."""

import math

import numpy as np
import pytest

import polhode as ph

METHODS = ["auto", "rk4", "rkn6", "kahan_li8", "midpoint"]


def turned_over(angle, rate, swing, time):
    """The angle in (-pi, pi] on a spring with this swing rate, piece by piece between half turns."""
    while True:
        amplitude = math.hypot(angle, rate / swing)
        phase = math.atan2(angle, rate / swing)
        ahead = math.inf
        if amplitude > math.pi:
            edge = math.asin(math.pi / amplitude)
            ahead = min((edge - phase) % (2 * math.pi), (math.pi + edge - phase) % (2 * math.pi)) / swing
        piece = min(time, ahead)
        cos, sin = math.cos(swing * piece), math.sin(swing * piece)
        angle, rate = angle * cos + rate / swing * sin, rate * cos - angle * swing * sin
        if ahead >= time:
            return angle
        time -= piece
        angle = -math.copysign(math.pi, angle)


def sphere(rng):
    """A sphere that turns over: the arguments of a run, its axis, and the angles at its times."""
    moment, stiffness = 10 ** rng.uniform(-1, 1, 2)
    swing = math.sqrt(stiffness / moment)
    angle, rate = rng.uniform(-3, 3), swing * rng.uniform(1.2, 4) * math.pi * rng.choice([-1, 1])
    times = np.sort(rng.uniform(0, rng.uniform(1, 6) / swing, rng.integers(1, 8)))
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    inertia = ph.Inertia.from_principal_moments(moment, moment, moment)
    start = ph.State(ph.Rotor.from_rotation_vector(angle * axis), rate * axis)
    angles = np.array([turned_over(angle, rate, swing, time) for time in times])
    return (inertia, start, times, ph.torque.torsion_spring(stiffness)), axis, angles


@pytest.mark.parametrize("method", METHODS)
def test_estimates_include_the_errors_of_steps_across_a_jump(method):
    """Before, two sweeps of equal steps could agree by chance, with errors of hundreds of estimates."""
    reached = 0
    for seed in range(12):
        rng = np.random.default_rng(seed)
        arguments, axis, angles = sphere(rng)
        rtol = 10 ** rng.uniform(-4, -1.5)
        try:
            motion = ph.simulate(*arguments, method=method, rtol=rtol, max_steps=1e5)
        except ValueError:  # not reached, or in too many steps
            continue
        reached += 1
        exact = ph.Rotor.from_rotation_vector(angles[:, np.newaxis] * axis)
        error = (~exact * motion.rotor).angle.max() / 2
        assert error <= motion.certificate.error_estimate, f"seed {seed}, rtol {rtol:.1e}"
    assert reached >= 2


def test_adaptive_steps_lead_across_jumps_at_small_tolerances():
    """Steps shorten up to the spacing of times, where the error of a step across the jump is negligible."""
    for seed in range(12):
        arguments, axis, angles = sphere(np.random.default_rng(seed))
        motion = ph.simulate(*arguments, rtol=1e-9)
        exact = ph.Rotor.from_rotation_vector(angles[:, np.newaxis] * axis)
        assert (~exact * motion.rotor).angle.max() / 2 <= motion.certificate.error_estimate <= 1e-9
