"""Constants of free motions, as in `crates/rigid/src/exact/free/orbit.rs`, over arrays of bodies."""

from __future__ import annotations

from typing import Any, NamedTuple

from polhode.jax._components import Three, dot
from polhode.jax._elliptic import argument, first_kind, mean, mean_and_sum
from polhode.jax._library import jnp
from polhode.jax._splitting import Axes

Array = Any


class Encircled(NamedTuple):
    """The order of the axes: a, b the middle one, and c, which the polhode encircles; s = sign(c − a)."""

    axes: Axes
    short: Array

    def pick(self, x: Three) -> Three:
        """Return three numbers in the order a, b, c."""
        small, middle, large = self.axes.pick(x)
        return self._turned((small, middle, large))

    def restored(self, x: Three) -> Three:
        """Return three numbers of a, b, c in the order of the body's axes."""
        small, middle, large = self._turned(x)
        masks = zip(self.axes.small, self.axes.middle, strict=True)
        one, two, three = (jnp.where(a, small, jnp.where(b, middle, large)) for a, b in masks)
        return one, two, three

    def _turned(self, x: Three) -> Three:
        a, b, c = x
        return jnp.where(self.short, a, c), b, jnp.where(self.short, c, a)


class Orbit(NamedTuple):
    """Constants of motions that are not steady; see `orbit.rs` for the names."""

    order: Encircled
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
        order = Encircled(axes, d >= 0)
        (a, b, c), (wa, wb, wc) = order.pick(moments), order.pick(omega)
        ab, ac, bc = jnp.abs(b - a), jnp.abs(c - a), jnp.abs(c - b)
        p = a * ac * (wa * wa) + b * bc * (wb * wb)
        q = b * ab * (wb * wb) + c * ac * (wc * wc)
        m = a * wa, b * wb, c * wc
        g2 = dot(m, m)
        s = jnp.where(order.short, 1.0, -1.0).astype(a.dtype)

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
        return mean(jnp.sqrt(self.k2))
