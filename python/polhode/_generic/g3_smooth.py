"""Functions of G3 over floating-point arrays, without branches on values and with derivatives.

``M = ζ + V``, V² = w; ζ and w are complex numbers ``x + yI`` (`layout.Complex`), and V behaves like a number
with the two values ±√w. With ``λ± = ζ ± √w``, for any analytic f,

    f(M) = (f(λ+) + f(λ−))/2 + V (f(λ+) − f(λ−))/(2√w).

Both quotients are analytic in w, but √w is not: near w = 0 they are series in w, and derivatives of all
orders are those of the series. Even elements ``s + B`` have logarithms and roots of their own, which are
even as well, and cover both sheets of the rotations: ``log(−1) = π e1e2``.

Derivatives are finite wherever the functions have them: a branch that is not taken is evaluated at a harmless
argument, because ``0 · ∞`` is not 0.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from polhode._generic.layout import EVEN, Complex, join, split
from polhode._generic.numeric import Numeric, squares

Components = list[Any]

# cosh √w and sinh √w / √w for |w| < 1: the first terms left out are 1/22! and 1/23!.
COSH = [1 / math.factorial(2 * k) for k in range(11)]
SINHC = [1 / math.factorial(2 * k + 1) for k in range(11)]
# artanh(z)/z in u = z² for |u| < 1/16: the first term left out is 16⁻¹³/27 < 1e-17.
_NEAR = 1 / 16
_ARTANHC = [1 / (2 * k + 1) for k in range(13)]

_E12 = [0.0, 0.0, 1.0]  # the plane taken where the value determines none


def horner(coefficients: list[float], x: Any) -> Any:
    """``Σ c_k x^k`` of real numbers."""
    total = x * 0.0 + coefficients[-1]
    for c in reversed(coefficients[:-1]):
        total = total * x + c
    return total


def singular(d: Numeric) -> float:
    """Return the size relative to the summands below which a difference is rounding."""
    return 8 * d.eps


# --- complex numbers ``x + yI``


def choose(d: Numeric, condition: Any, x: Complex | float, y: Complex | float) -> Complex:
    """Take x where the condition holds, else y; real numbers count as complex."""
    x, y = (z if isinstance(z, Complex) else Complex(z, 0.0) for z in (x, y))
    return Complex(d.where(condition, x.re, y.re), d.where(condition, x.im, y.im))


def series(d: Numeric, coefficients: Sequence[float], z: Complex) -> Complex:
    """``Σ c_k z^k``, by Horner's rule."""
    total = Complex(d.zeros_like(z.re), d.zeros_like(z.im))
    for c in reversed(coefficients):
        total = total * z
        total = Complex(total.re + c, total.im)
    return total


def complex_exp(d: Numeric, z: Complex) -> Complex:
    """``eᶻ``."""
    return Complex(d.cos(z.im), d.sin(z.im)).times(d.exp(z.re))


def complex_log(d: Numeric, z: Complex) -> Complex:
    """Principal value, imaginary part in [−π, π]; z is not 0."""
    return Complex(0.5 * d.log(z.square()), d.atan2(z.im, z.re))


def complex_sqrt(d: Numeric, z: Complex) -> Complex:
    """Principal value, real part >= 0, and 0 at 0. The larger part is a sum, so neither part cancels."""
    zero = z.square() == 0
    safe = choose(d, zero, 1.0, z)
    positive = d.where(safe.re < 0, -safe.re, safe.re)
    large = d.sqrt(0.5 * (d.sqrt(safe.square()) + positive))
    small = 0.5 * safe.im / large
    sign = d.where(safe.im < 0, -1.0, 1.0)
    root = choose(d, safe.re < 0, Complex(sign * small, sign * large), Complex(large, small))
    return choose(d, zero, 0.0, root)


# --- inverse and exp


def inverse(d: Numeric, m: Components, _: int) -> Components:
    """``(ζ − V)/(ζ² − w)``; a ValueError where an eigenvalue is zero to rounding."""
    scale = d.scale(m)
    m = [x / scale for x in m]
    zeta, w = split(m)
    determinant = zeta * zeta - w
    size = determinant.square()
    regular = d.sqrt(size) / squares(d, m) > singular(d)
    d.require(regular, "no inverse: the multivector is singular to rounding")
    reciprocal = Complex(determinant.re / size, -determinant.im / size)
    return [x / scale for x in join(zeta * reciprocal, m, -reciprocal)]


def exp(d: Numeric, m: Components, mask: int) -> Components:
    """``e^ζ (cosh √w + V sinh √w / √w)``."""
    if not mask & ~EVEN:
        cos, sinc = cos_sinc(d, m[4:7])
        size = d.exp(m[0])
        return [size * cos, *m[1:4], *(size * (sinc * b) for b in m[4:7]), m[7]]
    scale = d.scale_of_large(m[1:7])
    zeta, scaled = Complex(m[0], m[7]), split([x / scale for x in m])[1]
    w = scaled.times(scale).times(scale)
    small = w.square() < 1
    near = choose(d, small, w, 0.0)
    factor = complex_exp(d, zeta)
    root = complex_sqrt(d, choose(d, small, 1.0, scaled)).times(scale)
    # The exponents are added first: e^(ζ ± √w) may exist where cosh √w does not.
    plus, minus = (complex_exp(d, z).times(0.5) for z in (zeta + root, zeta - root))
    c = choose(d, small, factor * series(d, COSH, near), plus + minus)
    q = choose(d, small, factor * series(d, SINHC, near), (plus - minus).over(root))
    return join(c, m, q)


def cos_sinc(d: Numeric, b: Components) -> tuple[Any, Any]:
    """``cos|B|`` and ``sin|B|/|B|``."""
    scale = d.scale_of_large(b)
    scaled = squares(d, [x / scale for x in b])
    square = scaled * scale * scale
    small = square < 1
    near = d.where(small, -square, 0.0)
    size = scale * d.sqrt(d.where(small, 1.0, scaled))
    cos = d.once(d.where(small, horner(COSH, near), d.cos(size)))
    return cos, d.where(small, horner(SINHC, near), d.sin(size)) / d.where(small, 1.0, size)


# --- log


def log(d: Numeric, m: Components, mask: int) -> Components:
    """A logarithm; a ValueError where an eigenvalue is zero to rounding."""
    if not mask & ~EVEN:
        return log_even(d, m)
    scale = d.scale(m)
    m = [x / scale for x in m]
    zeta, w = split(m)
    turned = _is_negative(d, m)
    near, root = _near_and_root(d, zeta, w)
    plus, minus = zeta + root, zeta - root
    smallest = d.where(plus.square() < minus.square(), plus.square(), minus.square())
    size = squares(d, m)
    d.require(smallest > (singular(d) ** 2) * size, "no logarithm: the multivector is singular to rounding")

    # Near w = 0, on one side of the cut: ½ log λ+λ− = log ζ + ½ log(1 − u), and 2 artanh(√w/ζ)/2√w.
    safe, reciprocal, u = _near_quotients(d, near, zeta, w)
    rest = complex_log(d, Complex(1.0 - u.re, -u.im)).times(0.5)
    mean_near = complex_log(d, choose(d, turned, -safe, safe)) + rest
    quotient_near = series(d, _ARTANHC, u) * reciprocal
    plus, minus = choose(d, near, 4.0, plus), choose(d, near, 2.0, minus)
    root = choose(d, near, 1.0, root)
    log_plus, log_minus = complex_log(d, plus), complex_log(d, minus)
    mean = choose(d, near, mean_near, (log_plus + log_minus).times(0.5))
    quotient = choose(d, near, quotient_near, (log_plus - log_minus).times(0.5).over(root))

    result = join(mean, m, quotient)
    result[0] = result[0] + d.log(scale)
    result[6] = result[6] + d.where(turned, math.pi, 0.0)
    return result


def log_even(d: Numeric, m: Components) -> Components:
    """``log|M| + B/|B| · atan2(|B|, s)``; at ``−|s|``, where B is 0, ``π e1e2``.

    With t = |B|/s small it is ``B artan(t)/(t s)``, analytic at B = 0 as well, plus a half turn where s < 0.
    """
    scale = d.scale([m[0], *m[4:7]])
    s, b = m[0] / scale, [x / scale for x in m[4:7]]
    square = squares(d, b)
    d.require(s * s + square > 0, "no logarithm: the multivector is singular to rounding")
    near = square < _NEAR * s * s
    safe = d.where(near, s, 1.0)
    u = d.where(near, square, 0.0) / (safe * safe)
    quotient = horner(_ARTANHC, -u) / safe
    half_turn = d.where(s < 0, math.pi, 0.0)
    size, direction = d.length(b), d.direction(b, _E12)
    angle = d.atan2(d.where(near, 1.0, size), d.where(near, 1.0, s))
    plane = [
        d.where(near, x * quotient + half_turn * n, angle * n) for x, n in zip(b, direction, strict=True)
    ]
    return [d.log(scale) + d.log(d.sqrt(s * s + square)), *m[1:4], *plane, m[7]]


# --- sqrt


def sqrt(d: Numeric, m: Components, mask: int) -> Components:
    """A square root; a ValueError where the two eigenvalues' roots cancel."""
    if not mask & ~EVEN:
        return _sqrt_even(d, m)
    scale = d.scale(m)
    size = d.sqrt(scale)
    m = [x / scale for x in m]
    zeta, w = split(m)
    turned = _is_negative(d, m)
    zero = squares(d, m) == 0
    near, root = _near_and_root(d, zeta, w)

    # Near w = 0, on one side of the cut: √λ+ + √λ− = 2 √ζ √((1 + √(1 − u))/2), analytic in u = w/ζ².
    safe, _, u = _near_quotients(d, near, zeta, w)
    inner = complex_sqrt(d, Complex(1.0 - u.re, -u.im))
    sum_near = complex_sqrt(d, safe) * complex_sqrt(d, Complex(2.0 + 2.0 * inner.re, 2.0 * inner.im))
    plus, minus = (complex_sqrt(d, choose(d, near, 1.0, z)) for z in (zeta + root, zeta - root))
    sum_far, difference = plus + minus, plus - minus
    # Across the cut the sum cancels; λ+ − λ− = 2√w does not, unless w or V is rounding.
    across = sum_far.square() < 0.25 * difference.square()
    quotient = choose(d, across, root.times(2), 1.0).over(choose(d, across, difference, 1.0))
    sum_far = choose(d, across, quotient, sum_far)
    total = choose(d, near, sum_near, sum_far)
    regular = total.square() > singular(d) * d.sqrt(squares(d, m))
    size_of_v = squares(d, m[1:7])
    regular = regular | across & (w.square() > (singular(d) * size_of_v) ** 2) & (w.square() > d.eps**4)
    d.require(regular | zero, "no square root: the multivector is singular to rounding")

    safe_total = choose(d, zero, 1.0, total)
    one = Complex(d.where(zero, 0.0, 1.0), d.zeros_like(safe_total.im))
    result = join(total.times(0.5), m, one.over(safe_total))
    # √−s = √s e1e2 where the value has no other plane.
    half_turn = d.sqrt(d.where(turned, -m[0], 1.0))
    result = [d.where(turned, 0.0, x) for x in result]
    result[6] = d.where(turned, half_turn, result[6])
    return [x * size for x in result]


def _sqrt_even(d: Numeric, m: Components) -> Components:
    """``√|M|`` times the half-way rotor: ``√(s + B) = r + B/2r`` with ``r² = (|M| + s)/2``.

    For s < 0 that sum cancels; it is then ``|B|/2r + r B/|B|`` with ``r² = (|M| − s)/2``.
    """
    scale = d.scale([m[0], *m[4:7]])
    s, b = m[0] / scale, [x / scale for x in m[4:7]]
    square = s * s + squares(d, b)
    zero = square == 0
    half = d.sqrt(d.where(zero, 1.0, 0.5 * (d.sqrt(d.where(zero, 1.0, square)) + d.abs(s))))
    size, direction = d.length(b, b[2]), d.direction(b, _E12)
    root = d.sqrt(scale)
    even = [d.where(s < 0, 0.5 * size / half, half)]
    even += [d.where(s < 0, half * n, 0.5 * x / half) for x, n in zip(b, direction, strict=True)]
    s, *plane = [d.where(zero, 0.0, x * root) for x in even]
    return [s, *m[1:4], *plane, m[7]]


# --- where the series hold


def _near_and_root(d: Numeric, zeta: Complex, w: Complex) -> tuple[Any, Complex]:
    """Return whether ``|w| < |ζ|²/16`` with λ± on one side of the cut along the negative axis, and √w."""
    root = complex_sqrt(d, w)
    plus, minus = zeta + root, zeta - root
    turn = d.atan2(plus.im, plus.re) - d.atan2(minus.im, minus.re)
    small = w.square() < (_NEAR * zeta.square()) * (_NEAR * zeta.square())
    return small & ((d.abs(turn) < math.pi) | (w.square() == 0)), root


def _near_quotients(d: Numeric, near: Any, zeta: Complex, w: Complex) -> tuple[Complex, Complex, Complex]:
    """Return ζ, 1/ζ and ``u = w/ζ²`` where the series hold, 1, 1 and 0 elsewhere."""
    safe = choose(d, near, zeta, 1.0)
    reciprocal = Complex(safe.re * 0.0 + 1.0, safe.im * 0.0).over(safe)
    return safe, reciprocal, choose(d, near, w, 0.0) * reciprocal * reciprocal


def _is_negative(d: Numeric, m: Components) -> Any:
    """Whether the value is a negative number, without a bivector part."""
    negative = m[0] < 0
    for x in m[1:]:
        negative = negative & (x == 0)
    return negative
