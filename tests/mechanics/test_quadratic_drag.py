"""Throws against quadratic drag, against the closed form."""

import numpy as np
import pytest

import polhode as ph


def fallen(v0, k, g, t):
    """Height and velocity at t of a body of 1 kg thrown upwards under gravity g and the drag k |v| v."""
    fastest = np.sqrt(g / k)
    up = np.arctan(v0 / fastest) * fastest / g
    highest = fastest**2 / g * np.log1p((v0 / fastest) ** 2) / 2
    return highest - fastest**2 / g * np.log(np.cosh(g * (t - up) / fastest))


@pytest.mark.parametrize("law", ["named", "formula", "function"])
def test_trial_steps_may_lead_out_of_the_domain_of_a_force(law):
    """The first step may be so long that quadratic drag overflows in it; it is shortened then."""
    forces = {
        "named": ph.force.constant([0, 0, -10]) + ph.force.quadratic_drag(0.5),
        "formula": ph.force.formula("-10 e3 - 0.5 norm(v) v"),
        "function": ph.force.function(lambda t, x, v, R: -10 * ph.e3 - 0.5 * v.norm() * v),
    }
    body = ph.Body.sphere(0.1, mass=1)
    for v0 in (5.0, 16.0, 60.0):
        up = ph.State(ph.Rotor.identity(), [0, 0, 0], position=[0, 0, 0], velocity=[0, 0, v0])
        motion = ph.simulate(body, up, [3], force=forces[law])
        height = fallen(v0, 0.5, 10, 3)
        farthest = max(abs(height), np.log1p(0.5 * v0**2 / 10))  # the height of return
        assert abs(motion.position.components[-1, 2] - height) <= 1e-10 * farthest


def test_a_force_without_a_value_is_still_an_error():
    body = ph.Body.sphere(0.1, mass=1)
    start = ph.State(ph.Rotor.identity(), [0, 0, 0], position=[0, 0, 0], velocity=[1, 0, 0])
    ends = ph.force.function(lambda t, x, v, R: [0, 0, np.nan if t > 2 else -1])
    with pytest.raises(ValueError, match=r"the force that the function returned is .*NaN.*must be finite"):
        ph.simulate(body, start, [3], force=ends)


def test_estimates_where_the_speed_passes_through_zero():
    """|v| v has a kink at rest, where sweeps may agree by chance."""
    body = ph.Body.sphere(0.1, mass=1)
    v0 = np.linspace(5, 30, 60)
    still = np.zeros_like(v0)
    up = ph.State(
        ph.Rotor.identity(),
        [0, 0, 0],
        position=[0, 0, 0],
        velocity=np.stack([still, still, v0], axis=-1),
    )
    law = ph.force.constant([0, 0, -10]) + ph.force.quadratic_drag(0.5)
    for rtol in (1e-4, 1e-7, 1e-9):
        motion = ph.simulate(body, up, [3], force=law, rtol=rtol)
        heights = fallen(v0, 0.5, 10, 3)
        scale = np.maximum(np.abs(heights), v0**2 / 20)
        errors = np.abs(motion.position.components[..., 2].ravel() - heights) / scale
        estimates = np.ravel(motion.certificate.error_estimate)
        assert (errors / estimates).max() < 3
