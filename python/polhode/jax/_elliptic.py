"""Elliptic integrals of arrays, in a fixed number of steps, as in `crates/rigid/src/numerics/elliptic.rs`."""

from __future__ import annotations

from typing import Any

from polhode.jax._library import jnp, lax

Array = Any

# Means converge quadratically, from k' = 1e-16 in 9 steps; duplication reduces differences by 4 in a step,
# after some steps that bring the arguments to one size.
_MEANS, _DUPLICATIONS = 12, 20


def r_f(x: Array, y: Array, z: Array) -> Array:
    """``½ ∫₀^∞ dt / √((t+x)(t+y)(t+z))``; arguments >= 0, at most one 0."""

    def twice(_: Array, at: tuple[Array, ...]) -> tuple[Array, ...]:
        x, y, z = map(jnp.sqrt, at)
        shift = x * y + x * z + y * z
        return tuple(0.25 * (a + shift) for a in at)

    x, y, z = lax.fori_loop(0, _DUPLICATIONS, twice, tuple(jnp.broadcast_arrays(x, y, z)))
    mean = (x + y + z) / 3.0
    dx, dy = (mean - x) / mean, (mean - y) / mean
    dz = -dx - dy
    e2, e3 = dx * dy - dz * dz, dx * dy * dz
    return (1.0 - e2 / 10.0 + e3 / 14.0) / jnp.sqrt(mean)


def first_kind(square: tuple[Array, Array], k2: Array) -> Array:
    """Return F(φ, k') of ``sin² φ``, ``cos² φ`` and k²; infinite for φ = π/2 and k = 0."""
    sin2, cos2 = square
    delta2 = cos2 + k2 * sin2
    none = delta2 == 0
    found = jnp.sqrt(sin2) * r_f(cos2, jnp.where(none, 1.0, delta2), jnp.ones_like(delta2))
    return jnp.where(none, jnp.inf, found)


def mean(g: Array) -> Array:
    """Return the arithmetic-geometric mean of 1 and a number in [0, 1]."""

    def step(_: Array, at: tuple[Array, Array]) -> tuple[Array, Array]:
        a, g = at
        return 0.5 * (a + g), jnp.sqrt(a * g)

    return jnp.where(
        g > 0, lax.fori_loop(0, _MEANS, step, (jnp.ones_like(g), jnp.where(g > 0, g, 1.0)))[0], 0.0
    )


def mean_and_sum(kc: Array, p2: Array) -> tuple[Array, Array]:
    """``M = AGM(1, k')`` and ``Σ Q_n``, of which ``Π(n) − K = (K/2) (n/(1 − n)) Σ Q_n``; ``p² = 1 − n``."""

    def step(_: Array, at: tuple[Array, ...]) -> tuple[Array, ...]:
        a, g, p, term, total = at
        product = a * g
        whole = p * p + product
        term, total = 0.5 * term * (p * p - product) / whole, total + term
        return 0.5 * (a + g), jnp.sqrt(product), whole / (2.0 * p), term, total

    one = jnp.ones_like(kc)
    a, _, _, term, total = lax.fori_loop(0, _MEANS, step, (one, kc, jnp.sqrt(p2), one, jnp.zeros_like(kc)))
    return a, total + term


def argument(cn: Array, sn: Array, kc: Array) -> tuple[Array, Array]:
    """Return the u in [−2K, 2K] with given cn u and sn u, up to a factor: K's, and a rest of K/2 at most.

    Where k' = 0 all is rest.
    """
    near = cn * cn >= kc * (sn * sn)
    # Beyond K/2 tan am(u − K) = −cn u / (k' sn u).
    whole = jnp.where(near, jnp.where(cn < 0, 2.0, 0.0), jnp.copysign(1.0, sn))
    sin = jnp.where(near, jnp.copysign(sn, sn * cn), jnp.copysign(cn, -cn * sn))
    cos = jnp.where(near, jnp.abs(cn), kc * jnp.abs(sn))
    size = jnp.sqrt(cos * cos + sin * sin)
    sin, cos = sin / size, cos / size
    rest = sin * r_f(cos * cos, cos * cos + (kc * sin) * (kc * sin), jnp.ones_like(cos))
    return whole, jnp.where(kc == 0, jnp.arcsinh(sin / jnp.where(cos == 0, 1.0, cos)), rest)
