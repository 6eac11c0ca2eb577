"""Gravity gradient on a Kepler orbit, as in `crates/rigid/src/laws/torque/orbit.rs`."""

from __future__ import annotations

import math

from polhode.jax._components import Three, cross, horner, times
from polhode.jax._laws import At
from polhode.jax._library import Array, jnp, lax

# 2π in two parts, the first of 33 bits: its product with a number of turns is exact.
_TWO_PI = (6.2831853069365025, 2.4308402025215864e-10)
# (x − sin x)/x³ in x².
_LESS_SINE = [(-1) ** k / math.factorial(2 * k + 3) for k in range(11)]
# Newton's steps from above to the root of Kepler's equation, up to e = 1 − 1e-12.
_STEPS = 12


def tide(at: At, n: Array, eccentricity: Array, mean_anomaly: Array) -> Three:
    """``3n² (a/r)³ u∧I(u)``, u the direction from planet to body."""
    # n t + M0 less whole turns, in [−π, π].
    mean = n * at.phase.time + mean_anomaly
    turns = lax.stop_gradient(jnp.floor(mean * (0.5 / math.pi) + 0.5))
    u, nearness = _place((mean - turns * _TWO_PI[0]) - turns * _TWO_PI[1], eccentricity)
    u = at.in_body(u)
    return times(cross(u, at.body.carried(u)), 3.0 * n * n * nearness)


def _place(mean: Array, e: Array) -> tuple[Three, Array]:
    """The direction from planet to body, and ``(a/r)³``; both differences by the small ``1 − cos E``."""
    anomaly = eccentric_anomaly(mean, e)
    sine = jnp.sin(0.5 * anomaly)
    versine = 2.0 * sine * sine
    distance = (1.0 - e) + e * versine
    along, across = (1.0 - e) - versine, jnp.sqrt((1.0 - e) * (1.0 + e)) * jnp.sin(anomaly)
    u = along / distance, across / distance, jnp.zeros_like(along)
    return u, 1.0 / (distance * distance * distance)


def eccentric_anomaly(mean: Array, e: Array) -> Array:
    """Kepler's equation ``M = E − e sin E`` for ``|M| <= π``, with its derivatives.

    Newton's steps fall from above to the root, which lies below ``M + e``, below ``M/(1−e)``, and below
    ``(π² M/e)^(1/3)``. No derivative is taken of them: one more step from the root has those of the root.
    """
    sign = lax.stop_gradient(jnp.where(mean < 0, -1.0, 1.0))
    m, held = mean * sign, lax.stop_gradient(e)
    known = lax.stop_gradient(m)
    bound = jnp.cbrt(math.pi**2 * known / jnp.where(held > 0, held, 1.0))
    first = jnp.minimum(jnp.minimum(known + held, known / (1.0 - held)), math.pi)
    first = jnp.where(held > 0, jnp.minimum(first, bound), first)
    root = lax.stop_gradient(
        lax.fori_loop(0, _STEPS, lambda _, E: jnp.minimum(E, _next(E, known, held)), first)
    )
    return sign * _next(root, m, e)


def _next(E: Array, m: Array, e: Array) -> Array:
    excess = (1.0 - e) * E + e * _less_its_sine(E) - m
    half = jnp.sin(0.5 * E)
    return E - excess / ((1.0 - e) + 2.0 * e * half * half)


def _less_its_sine(x: Array) -> Array:
    """``x − sin x`` for x in [0, π], by its series where the difference would cancel."""
    near = x < 1.0
    small = jnp.where(near, x, 0.0)
    return jnp.where(near, small * small * small * horner(_LESS_SINE, small * small), x - jnp.sin(x))
