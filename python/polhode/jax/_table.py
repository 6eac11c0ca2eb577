"""Torques interpolated in a table of times, as in `crates/rigid/src/laws/torque/table.rs`."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from polhode.jax._components import Four, Three, joined, reverse, split, turned
from polhode.jax._laws import Gyrostat, Law, Phase, pytree, static
from polhode.jax._library import Array, jnp, lax


@pytree
class Table(Law):
    """Rows of torques and of the slopes of their spline; NaN outside the times.

    Rows that are `held` from each time to the next jump there: the row of a step is that of its middle.
    """

    torques: Array
    slopes: Array | None
    times: tuple[float, ...] = static()
    frame: str = static()
    held: bool = static(default=False)

    def in_axes(self, frame: Four) -> Law:
        if self.frame == "space":
            return self
        back = reverse(frame)
        torques = joined(turned(back, split(self.torques)))
        slopes = None if self.slopes is None else joined(turned(back, split(self.slopes)))
        return replace(self, torques=torques, slopes=slopes)

    def within(self, middle: Array) -> Law:
        if not self.held:
            return self
        return _Row(self._at(middle), self.frame)

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        return _in_body(split(self._at(phase.time)), self.frame, phase)

    def _at(self, time: Array) -> Array:
        times = jnp.asarray(self.times, time.dtype)
        first, last = self.times[0], self.times[-1]
        # A step to the last time may end a rounding after it.
        rounding = 4.0 * jnp.finfo(time.dtype).eps * max(abs(first), abs(last))
        inside = (time >= first - rounding) & (time <= last + rounding)
        time = jnp.clip(time, first, last)
        i = jnp.clip(jnp.searchsorted(times, time, side="right"), 1, len(self.times) - 1) - 1
        if self.held:
            row = self.torques[jnp.where(time >= last, len(self.times) - 1, i)]
            return jnp.where(inside[..., None], row, jnp.nan)
        h = times[i + 1] - times[i]
        x = ((time - times[i]) / h)[..., None]
        a, b = self.torques[i], self.torques[i + 1]
        steep = b - a
        # From the nearer end, so that the rows are reproduced exactly.
        line = jnp.where(x < 0.5, a + steep * x, b - steep * (1.0 - x))
        if self.slopes is not None:
            # The cubic Hermite polynomial: the line, and the differences of both slopes from its own.
            h = h[..., None]
            p, q = self.slopes[i] * h - steep, self.slopes[i + 1] * h - steep
            line = line + (p * (1.0 - x) - q * x) * (x * (1.0 - x))
        return jnp.where(inside[..., None], line, jnp.nan)


@pytree
class _Row(Law):
    """A row of a table, held over a step."""

    torque: Array
    frame: str = static()

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        return _in_body(split(self.torque), self.frame, phase)


def _in_body(torque: Three, frame: str, phase: Phase) -> Three:
    return torque if frame == "body" else turned(reverse(phase.rotor), torque)


def spline_slopes(times: Any, torques: Array) -> Array:
    """Return the slopes (n, 3) of the spline with "not a knot" ends; of three rows, of their parabola.

    The equations are those of `table.rs`; the matrix does not depend on the torques.
    """
    n, h = len(times), np.diff(times)
    mean = (torques[1:] - torques[:-1]) / h[:, None]
    if n == 3:
        bend = (mean[1] - mean[0]) / (h[0] + h[1])
        return jnp.stack([mean[0] - bend * h[0], mean[0] + bend * h[0], mean[1] + bend * h[1]])
    inner = 3.0 * (mean[:-1] * h[1:, None] + mean[1:] * h[:-1, None])
    (a, b), (c, d) = h[:2], h[:-3:-1]
    first = (mean[0] * ((3 * a + 2 * b) * b) + mean[1] * a**2) / (a + b)
    last = (mean[-1] * ((3 * c + 2 * d) * d) + mean[-2] * c**2) / (c + d)
    right = jnp.concatenate([first[None], inner, last[None]])
    lower = np.concatenate([[0.0], h[1:], [c + d]])
    diagonal = np.concatenate([[b], 2 * (h[:-1] + h[1:]), [d]])
    upper = np.concatenate([[a + b], h[:-1], [0.0]])
    bands = (jnp.asarray(band, right.dtype) for band in (lower, diagonal, upper))
    return lax.linalg.tridiagonal_solve(*bands, right)
