"""Components of G3 by grade: ``1 | e1 e2 e3 | e2e3 e3e1 e1e2 | I``, only those of the grades held.

Grades are the bits of a mask. The complex numbers ``x + yI`` are the centre of G3.
"""

from __future__ import annotations

import operator
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from polhode._generic.coefficients import Coefficients
from polhode._generic.compiled import compiled
from polhode._generic.numeric import Array

SCALAR, VECTOR, BIVECTOR, TRIVECTOR = 0b0001, 0b0010, 0b0100, 0b1000
EVEN, ALL = 0b0101, 0b1111

_BLADES = {SCALAR: (0,), VECTOR: (1, 2, 3), BIVECTOR: (4, 5, 6), TRIVECTOR: (7,)}

# Grades closed under products: two that square to a number, and what commutes.
_CLOSED = (EVEN, SCALAR | VECTOR, SCALAR | TRIVECTOR)
# Inverse: M̄ times a number, where M M̄ has no trivector part.
_INVERTED = (
    *(SCALAR, VECTOR, BIVECTOR, TRIVECTOR, SCALAR | VECTOR, EVEN),
    *(VECTOR | TRIVECTOR, BIVECTOR | TRIVECTOR, SCALAR | TRIVECTOR),
)


def indices(mask: int) -> list[int]:
    """Return the places of the grades among the eight components."""
    return [i for grade, blades in _BLADES.items() if mask & grade for i in blades]


def grades_of(function: str, mask: int) -> int:
    """Return the grades that the values of `inverse`, `exp`, `log` or `sqrt` may hold."""
    if function == "exp" and mask == SCALAR:
        return SCALAR
    closed = {"inverse": _INVERTED, "exp": _CLOSED, "log": (EVEN,), "sqrt": (EVEN,)}[function]
    return next((grades for grades in closed if not mask & ~grades), ALL)


def eight(d: Coefficients, data: Array, mask: int) -> list[Array]:
    """Return all eight components, exact zeros for the grades not held."""
    place = {i: k for k, i in enumerate(indices(mask))}
    zero = d.zeros(tuple(data.shape[:-1]))
    return [data[..., place[i]] if i in place else zero for i in range(8)]


def of_eight(d: Coefficients, components: list[Array], mask: int) -> Array:
    """Return the array of the components of these grades."""
    return d.stack([components[i] for i in indices(mask)])


@compiled
def rearranged(
    d: Coefficients, data: Array, places: Sequence[int | None], signs: Sequence[float] | None = None
) -> Array:
    """Return the components at these places, zeros for None, those with a negative sign negated."""
    zero = d.zeros_like(data[..., 0]) if None in places else None
    parts: list[Any] = [zero if k is None else data[..., k] for k in places]
    if signs is not None:
        parts = [x if sign > 0 else -x for x, sign in zip(parts, signs, strict=True)]
    return d.stack(parts)


# --- the centre


@dataclass(frozen=True, slots=True)
class Complex:
    """``re + im I``, an element of the centre of G3: I commutes with everything and squares to −1."""

    re: Any
    im: Any

    def __add__(self, other: Complex) -> Complex:
        return Complex(self.re + other.re, self.im + other.im)

    def __sub__(self, other: Complex) -> Complex:
        return Complex(self.re - other.re, self.im - other.im)

    def __neg__(self) -> Complex:
        return Complex(-self.re, -self.im)

    def __mul__(self, other: Complex) -> Complex:
        re, im = self.re, self.im
        return Complex(re * other.re - im * other.im, re * other.im + im * other.re)

    def times(self, number: Any) -> Complex:
        """Return both parts times a number."""
        return Complex(self.re * number, self.im * number)

    def square(self) -> Any:
        """``|z|²``."""
        return self.re * self.re + self.im * self.im

    def over(self, other: Complex, divide: Any = operator.truediv) -> Complex:
        """Return the quotient; `divide` divides the parts."""
        size = other.square()
        numerator = self * Complex(other.re, -other.im)
        return Complex(divide(numerator.re, size), divide(numerator.im, size))


def split(m: list[Any]) -> tuple[Complex, Complex]:
    """Return ζ and w of ``M = ζ + V``, ``V = a + B``: ``w = V² = a² + B² + 2 a∧B`` is complex as well."""
    a, b = m[1:4], m[4:7]
    square = a[0] * a[0] + a[1] * a[1] + a[2] * a[2] - (b[0] * b[0] + b[1] * b[1] + b[2] * b[2])
    wedge = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return Complex(m[0], m[7]), Complex(square, wedge + wedge)


def join(c: Complex, m: list[Any], q: Complex) -> list[Any]:
    """``c + V q`` for complex c and q, V being the vector and bivector part of m; ``a I`` is a bivector."""
    vector = [a * q.re - b * q.im for a, b in zip(m[1:4], m[4:7], strict=True)]
    bivector = [b * q.re + a * q.im for a, b in zip(m[1:4], m[4:7], strict=True)]
    return [c.re, *vector, *bivector, c.im]
