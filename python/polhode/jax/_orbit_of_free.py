"""Constants of free motions, as in `crates/rigid/src/exact/free/orbit.rs`, over arrays of bodies."""

from __future__ import annotations

from typing import NamedTuple

from polhode.jax._components import Three, dot
from polhode.jax._library import Array, jnp, lax
from polhode.jax._steppers import Axes

# Means converge quadratically, from k' = 1e-16 in 9 steps; duplication reduces differences by 4 in a step,
# after some steps that bring the arguments to one size.
_MEANS, _DUPLICATIONS = 12, 20


class Orbit(NamedTuple):
    """Constants of motions that are not steady; see `orbit.rs` for the names.

    `order` has the axes a, b the middle one, and c, which the polhode encircles; s = sign(c − a).
    """

    order: Axes
    s: Array
    signs: Three
    amplitudes: Three
    rate: Array
    k2: Array
    kc: Array
    precession: Array
    mean: Array
    on_separatrix: Array
    start: tuple[Array, Array]
    eta: Array
    rest_of_eta: Array

    @staticmethod
    def of(moments: Three, omega: Three) -> Orbit:
        """Return those of principal moments and angular velocities that are not steady."""
        axes = Axes.of(moments)
        (small, b, large), (w_small, _, w_large) = axes.pick(moments), axes.pick(omega)
        d = large * (large - b) * (w_large * w_large) - small * (b - small) * (w_small * w_small)
        short = d >= 0
        a_axis, c_axis = (
            tuple(jnp.where(short, x, y) for x, y in zip(*pair, strict=True))
            for pair in ((axes.small, axes.large), (axes.large, axes.small))
        )
        order = axes._replace(small=a_axis, large=c_axis)
        (a, b, c), (wa, wb, wc) = order.pick(moments), order.pick(omega)
        ab, ac, bc = jnp.abs(b - a), jnp.abs(c - a), jnp.abs(c - b)
        p = a * ac * (wa * wa) + b * bc * (wb * wb)
        q = b * ab * (wb * wb) + c * ac * (wc * wc)
        m = a * wa, b * wb, c * wc
        g2 = dot(m, m)
        s = jnp.where(short, 1.0, -1.0).astype(a.dtype)

        bcq = bc * q
        rate = jnp.sqrt(bcq / (a * b * c))
        on_separatrix = d == 0
        kc = jnp.sqrt(ac * jnp.abs(d) / bcq)
        k2 = jnp.minimum(ab * p / bcq, 1.0)

        side = jnp.copysign(1.0, wc)
        # cn keeps its sign on the separatrix.
        half_turn = jnp.where(on_separatrix, jnp.copysign(1.0, wa), 1.0)
        signs = half_turn, half_turn * side * axes.sign * s, side
        sizes = jnp.sqrt(p / (a * ac)), jnp.sqrt(p / (b * bc)), jnp.sqrt(q / (c * ac))
        amplitudes = signs[0] * sizes[0], signs[1] * s * sizes[1], signs[2] * sizes[2]

        g = jnp.sqrt(g2)
        minus_n = c * ab / (a * bc)
        first = minus_n * minus_n <= k2
        p2 = jnp.where(first, b * ac / (a * bc), ac * g2 / (c * q))
        average, total = mean_and_sum(jnp.where(on_separatrix, 1.0, kc), p2)
        slow = g / a - s * (g * ab * total / (2.0 * a * b) + rate * average)
        precession = jnp.where(first, slow, g / c + s * p * total / (2.0 * c * g))
        whole, other = b * ac, ac * g2
        return Orbit(
            order,
            s,
            signs,
            amplitudes,
            rate,
            k2,
            kc,
            jnp.where(on_separatrix, g / b, precession),
            average,
            on_separatrix,
            argument(wa / amplitudes[0], wb / amplitudes[1], kc),
            first_kind((a * bc / whole, c * ab / whole), k2),
            first_kind((c * q / other, a * p / other), k2),
        )

    @property
    def other(self) -> Array:
        """``AGM(1, k) = π/2K'``."""
        return agm(jnp.sqrt(self.k2))


# --- elliptic integrals of arrays, in a fixed number of steps, as in `numerics/elliptic.rs`


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


def agm(g: Array) -> Array:
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
