"""The exact free flow in JAX alone; `crates/rigid/src/exact/free/mod.rs` has the derivation.

Both forms of the series are computed for each body; its nome selects one.
"""

from __future__ import annotations

import math
from typing import Any

from polhode.jax import _series as series
from polhode.jax._components import Four, Three, compose, dot, joined, normalized, reverse, split, times
from polhode.jax._library import jax, jnp
from polhode.jax._orbit_of_free import Orbit

Array = Any

# u over the turns on the separatrix: an upper bound.
_NEVER = 2.0**70


def flow(moments: Array, rotor: Array, omega: Array, time: Array) -> tuple[Array, Array]:
    """Rotors (..., m, 4) and angular velocities (..., m, 3) of bodies (...), each at its times (..., m)."""
    i, r, w = (tuple(x[..., None] for x in split(y)) for y in (moments, rotor, omega))
    known = (i[0] > 0) & (i[1] > 0) & (i[2] > 0) & jnp.isfinite(sum(i) + sum(r) + sum(w))
    size, scale = _power_of_two(i), _power_of_two(w)
    i, w = tuple(x / size for x in i), tuple(x / scale for x in w)
    tumbles = known & _tumbles(i, w)
    turn, spin = _steady(_without_slopes(w, i, jnp.where(tumbles, 1.0, jnp.nan)), time * scale)
    # Where it is steady, substitute any tumbling motion.
    some = [jnp.where(tumbles, x, k) for k, x in zip((1.0, 2.0, 3.0), i, strict=True)]
    rates = [jnp.where(tumbles, x, 1.0) for x in w]
    tumbled, spins = _tumbling(Orbit.of(tuple(some), tuple(rates)), time * scale)
    turn = tuple(jnp.where(tumbles, x, y) for x, y in zip(tumbled, turn, strict=True))
    spin = tuple(jnp.where(tumbles, x, y) for x, y in zip(spins, spin, strict=True))
    found = joined(compose(normalized(r), turn)), joined(times(spin, scale))
    rotors, omegas = (jnp.where(known[..., None], x, jnp.nan) for x in found)
    return rotors, omegas


def _power_of_two(components: tuple[Array, ...]) -> Array:
    """The power of two next below the largest magnitude; 1 for zeros."""
    largest = jnp.maximum(jnp.maximum(abs(components[0]), abs(components[1])), abs(components[2]))
    usable = (largest > 0) & jnp.isfinite(largest)
    exponent = jnp.floor(jnp.log2(jnp.where(usable, largest, 1.0)))
    return jnp.ldexp(jnp.ones_like(largest), exponent.astype(jnp.int32))


def _tumbles(i: Any, w: Any) -> Array:
    """Whether ``I(Ω)`` is not parallel to Ω."""
    tiny = float(jnp.finfo(i[0].dtype).tiny) ** 0.45
    turning = [abs((i[(k + 1) % 3] - i[(k + 2) % 3]) * w[(k + 1) % 3] * w[(k + 2) % 3]) for k in range(3)]
    return (turning[0] > tiny) | (turning[1] > tiny) | (turning[2] > tiny)


def _steady(w: Any, time: Array) -> tuple[Four, Three]:
    """``exp(−½ Ω t)``."""
    square = dot(w, w)
    still = square == 0
    size = jnp.sqrt(jnp.where(still, 1.0, square))
    sin, cos = _sin_cos(jnp.where(still, 0.0, size * time * (0.25 / math.pi)))
    x, y, z = times(w, -1.0 / size)
    zero = jnp.zeros_like(time)
    return (cos, sin * x, sin * y, sin * z), (w[0] + zero, w[1] + zero, w[2] + zero)


@jax.custom_jvp
def _without_slopes(w: Any, i: Any, factor: Array) -> Any:
    """Return w with NaN derivatives: neighbours of a steady motion are not steady."""
    return w


@_without_slopes.defjvp
def _without_slopes_jvp(primals: Any, tangents: Any) -> Any:
    w, _, factor = primals
    change = sum(tangents[0]) + sum(tangents[1])
    return w, tuple(change * factor for _ in w)


def _sin_cos(turns: Array) -> tuple[Array, Array]:
    angle = (turns - jnp.round(turns)) * (2.0 * math.pi)
    return jnp.sin(angle), jnp.cos(angle)


def _tumbling(orbit: Orbit, time: Array) -> tuple[Four, Three]:
    """``~W(0) W(t)`` and the angular velocity."""
    # The start is the first of the times.
    z, functions = _states(orbit, jnp.concatenate([jnp.zeros_like(time[..., :1]), time], axis=-1))
    rotor = normalized(_in_axes(orbit, z))
    first, rotor = (tuple(x[..., part] for x in rotor) for part in (slice(1), slice(1, None)))
    parts = tuple(x * f[..., 1:] for x, f in zip(orbit.amplitudes, functions, strict=True))
    return compose(reverse(first), rotor), orbit.order.restored(parts)


def _in_axes(orbit: Orbit, z: Four) -> Four:
    """Compose quaternion units, the negatives of the planes of (e1, e2, d)."""
    planes = tuple(-sign * x for sign, x in zip(orbit.signs, z[1:], strict=True))
    return z[0], *orbit.order.restored(planes)


def _states(orbit: Orbit, time: Array) -> tuple[Four, Three]:
    """``exp(½νt) Z`` up to its norm, and cn, sn and dn."""
    other, mean = orbit.other, orbit.mean
    whole, rest = orbit.start
    per_u = jnp.where(orbit.on_separatrix, 1.0 / _NEVER, mean * (0.5 / math.pi))
    turns = jnp.where(orbit.on_separatrix, 0.0, 0.25 * whole) + (rest * per_u + orbit.rate * per_u * time)
    turns = turns - jnp.round(turns)
    nome = jnp.where(other > 0, jnp.exp(-math.pi * mean / jnp.where(other > 0, other, 1.0)), 0.0)
    circular = (nome <= series.LARGEST_NOME) & ~orbit.on_separatrix
    rho = jnp.where(circular, jnp.exp(-orbit.rest_of_eta * mean), 0.0)
    near = series.circular(jnp.where(circular, nome, 0.0), rho, orbit.s, *_sin_cos(turns))
    gamma = jnp.where(circular, 0.0, 0.5 * orbit.eta * other)
    border = jnp.where(circular, 1.0, 0.25 * math.pi * other / mean)
    border = jnp.where(orbit.on_separatrix, _NEVER / 8.0, border)
    ahead = jnp.where(orbit.on_separatrix, 0.0, orbit.s * gamma / math.pi)
    far = series.hyperbolic(border, gamma, orbit.s, turns, ahead)
    z, functions, (ahead,) = (
        tuple(jnp.where(circular, x, y) for x, y in zip(near[part], far[part], strict=True))
        for part in range(3)
    )
    sin, cos = _sin_cos(orbit.precession * time * (0.25 / math.pi) + ahead)
    turned = (
        cos * z[0] - sin * z[3],
        cos * z[1] - sin * z[2],
        cos * z[2] + sin * z[1],
        cos * z[3] + sin * z[0],
    )
    return turned, functions
