"""The centre of G3: elements ``x + yI`` commute with everything and multiply as complex numbers.

A central element is a pair of arrays, or of numbers. Derivatives are finite wherever the functions have
them: a branch that is not taken is computed at a harmless place, for ``0 · ∞`` is not 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from polhode._generic.numeric import Numeric


@dataclass(frozen=True, slots=True)
class Central:
    """``re + im I``."""

    re: Any
    im: Any

    def __add__(self, other: Central) -> Central:
        return Central(self.re + other.re, self.im + other.im)

    def __sub__(self, other: Central) -> Central:
        return Central(self.re - other.re, self.im - other.im)

    def __neg__(self) -> Central:
        return Central(-self.re, -self.im)

    def __mul__(self, other: Central) -> Central:
        re, im = self.re, self.im
        return Central(re * other.re - im * other.im, re * other.im + im * other.re)

    def times(self, number: Any) -> Central:
        """Both parts times a number."""
        return Central(self.re * number, self.im * number)

    def square(self) -> Any:
        """``|z|²``."""
        return self.re * self.re + self.im * self.im

    def over(self, other: Central, divide: Any) -> Central:
        """The quotient by another, of numbers that divide by `divide`."""
        size = other.square()
        numerator = self * Central(other.re, -other.im)
        return Central(divide(numerator.re, size), divide(numerator.im, size))


def choose(d: Numeric, condition: Any, x: Central | float, y: Central | float) -> Central:
    """Take x where the condition holds, else y; real numbers count as central."""
    x, y = (z if isinstance(z, Central) else Central(z, 0.0) for z in (x, y))
    return Central(d.where(condition, x.re, y.re), d.where(condition, x.im, y.im))


def series(d: Numeric, coefficients: Sequence[float], z: Central) -> Central:
    """``Σ c_k z^k``, by Horner's rule."""
    total = Central(d.zeros_like(z.re), d.zeros_like(z.im))
    for c in reversed(coefficients):
        total = total * z
        total = Central(total.re + c, total.im)
    return total


def exp(d: Numeric, z: Central) -> Central:
    """``eᶻ``."""
    return Central(d.cos(z.im), d.sin(z.im)).times(d.exp(z.re))


def log(d: Numeric, z: Central) -> Central:
    """Principal value, imaginary part in [−π, π]; z is not 0."""
    return Central(0.5 * d.log(z.square()), d.atan2(z.im, z.re))


def sqrt(d: Numeric, z: Central) -> Central:
    """Principal value, real part >= 0, and 0 at 0. The larger part is a sum, so neither part cancels."""
    zero = z.square() == 0
    safe = choose(d, zero, 1.0, z)
    positive = d.where(safe.re < 0, -safe.re, safe.re)
    large = d.sqrt(0.5 * (d.sqrt(safe.square()) + positive))
    small = 0.5 * safe.im / large
    sign = d.where(safe.im < 0, -1.0, 1.0)
    root = choose(d, safe.re < 0, Central(sign * small, sign * large), Central(large, small))
    return choose(d, zero, 0.0, root)
