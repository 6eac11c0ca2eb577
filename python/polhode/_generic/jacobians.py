"""Jacobians of the exponential maps of rotations and screws, over arrays of any coefficients.

On the plane of a rotation vector v = θn the left Jacobian is the complex number ``(exp(iθ) − 1)/(iθ)``, which
is ``s exp(iθ/2)`` with ``s = sin(θ/2)/(θ/2)``; along n it is 1. So it is s times the rotation by v/2, plus
``(1 − s) n nᵀ``, without differences of nearly equal numbers.

The exponential coordinates of a screw are a rotation vector of dual numbers, ``ω + εv`` with ε² = 0. So its
left Jacobian is ``J(ω + εv) = J(ω) + εQ``, where Q is the derivative of J at ω along v, and the matrix of
A + εB is ``[[A, 0], [B, A]]``.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from polhode._generic import rotors
from polhode._generic.coefficients import Coefficients
from polhode._generic.compiled import compiled
from polhode._generic.exact import by_rows, call, divide, is_multiprecision, is_symbolic, is_zero, sqrt
from polhode._generic.g3_smooth import horner
from polhode._generic.numeric import Array, Numeric, components, squares

Parts = list[Any]

# s and (1 − s)/θ² in (θ/2)², for θ < 1: the first terms left out are below 4⁻¹⁰/21! and 4⁻⁹/21!.
_SINE = [(-1) ** k / math.factorial(2 * k + 1) for k in range(10)]
_REST = [(-1) ** k / (4 * math.factorial(2 * k + 3)) for k in range(9)]

# (1 − cos θ)/θ² and (θ − sin θ)/θ³, and their derivatives by θ²/2, in θ² < 4: the first terms left out are
# below 4¹⁷/34!.
_TERMS = range(17)
_FIRST = [(-1) ** k / math.factorial(2 * k + 2) for k in _TERMS]
_SECOND = [(-1) ** k / math.factorial(2 * k + 3) for k in _TERMS]
_FIRST_SLOPE = [2 * (k + 1) * -((-1) ** k) / math.factorial(2 * k + 4) for k in _TERMS]
_SECOND_SLOPE = [2 * (k + 1) * -((-1) ** k) / math.factorial(2 * k + 5) for k in _TERMS]

_FULL_TURN = "the inverse Jacobian does not exist at a full turn; reduce the angle to less than 2π"


@compiled
def left(d: Coefficients, v: Array, inverse: bool) -> Array:
    """Return the left Jacobians (..., 3, 3) of rotation vectors (..., 3), or their inverses."""
    s, rest, scaled = _factors(d, v)
    if inverse:
        nonzero = d.abs(s) > 2 * d.eps if isinstance(d, Numeric) else _nonzero(s)
        d.require(nonzero[..., 0], _FULL_TURN)
        s, rest = d.divide(1, s), d.divide(-rest, s)
    half = rotors.from_rotation_vector(d, d.divide(-v if inverse else v, 2))
    turn = rotors.to_matrix(d, half)
    dyad = scaled[..., :, None] * scaled[..., None, :]
    return s[..., None] * turn + rest[..., None] * dyad


def _factors(d: Coefficients, v: Array) -> tuple[Array, Array, Array]:
    """Return ``s = sin(θ/2)/(θ/2)`` and ``(1 − s)/θ²``, of shape (..., 1), and v.

    From θ = 1 on, ``1 − s`` and ``v/θ`` instead, so that large angles do not overflow.
    """
    if not isinstance(d, Numeric):
        pairs = by_rows(_exact_factors, v, range(2))
        return pairs[..., :1], pairs[..., 1:], v
    parts = components(v)
    d.require_finite(parts)
    with np.errstate(all="ignore"):
        square = squares(d, parts)
        near = square < 1
        quarter = d.where(near, 0.25 * square, 0.0)
        angle = d.where(near, 1.0, d.length(parts))
        half = 0.5 * angle
        sine = d.where(near, horner(_SINE, quarter), d.sin(half) / half)
        rest = d.where(near, horner(_REST, quarter), 1 - sine)
    return sine[..., None], rest[..., None], v / angle[..., None]


def _exact_factors(v: Parts) -> Parts:
    square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    if is_zero(square):
        return [1, divide(1, 24)]
    half = divide(sqrt(square), 2)
    sine = divide(call("sin", half), half)
    return [sine, divide(1 - sine, square)]


# --- screws


@compiled
def left_of_screws(d: Coefficients, screws: Array, inverse: bool) -> Array:
    """Return the left Jacobians (..., 6, 6) of screws (..., 6), a rotation vector ω and a velocity v."""
    if isinstance(d, Numeric):
        d.require_finite(components(screws))
    omega, velocity = screws[..., :3], screws[..., 3:]
    turning = left(d, omega, inverse)
    with np.errstate(all="ignore"):
        change = _derivative(d, omega, velocity)
        if inverse:
            change = -(turning @ change @ turning)
    above = d.concat([turning, d.zeros_like(turning)], axis=-1)
    return d.concat([above, d.concat([change, turning], axis=-1)], axis=-2)


def _derivative(d: Coefficients, omega: Array, velocity: Array) -> Array:
    """Return the derivative of ``J = 1 + a [ω]ₓ + b [ω]ₓ²`` along v, for a, b as functions of θ²."""
    factors, scaled = _slopes(d, omega)
    a, b, a_slope, b_slope = (factors[..., k, None, None] for k in range(4))
    turn, shift = _cross(d, scaled), _cross(d, velocity)
    along = _dot(d, scaled, velocity)
    mixed = shift @ turn + turn @ shift
    return a * shift + b * mixed + along * (a_slope * turn + b_slope * (turn @ turn))


def _slopes(d: Coefficients, omega: Array) -> tuple[Array, Array]:
    """Return a, b and their derivatives by θ²/2, (..., 4), and ω.

    From θ = 2 on, times 1, θ, θ² and θ³, and ω/θ instead, so that large angles do not overflow.
    """
    if not isinstance(d, Numeric):
        return by_rows(_exact_slopes, omega, range(4)), omega
    parts = components(omega)
    square = squares(d, parts)
    near = square < 4
    small = d.where(near, square, 0.0)
    angle = d.where(near, 2.0, d.length(parts))
    half, sine = d.sin(0.5 * angle), d.sin(angle) / angle
    a, b = 2 * half * half / angle / angle, (1 - sine) / angle
    far = [a, b, sine - 2 * a, angle * a - 3 * b]
    series = [horner(x, small) for x in (_FIRST, _SECOND, _FIRST_SLOPE, _SECOND_SLOPE)]
    factors = [d.where(near, x, y) for x, y in zip(series, far, strict=True)]
    return d.stack(factors), omega / d.where(near, 1.0, angle)[..., None]


def _exact_slopes(v: Parts) -> Parts:
    square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    if is_zero(square):
        return [divide(1, 2), divide(1, 6), divide(-1, 12), divide(-1, 60)]
    if not is_symbolic(square) and square < 4:
        return [_series(square if is_multiprecision(square) else float(square), k) for k in range(4)]
    angle = sqrt(square)
    a = divide(1 - call("cos", angle), square)
    b = divide(angle - call("sin", angle), square * angle)
    return [a, b, divide(divide(call("sin", angle), angle) - 2 * a, square), divide(a - 3 * b, square)]


def _series(square: Any, which: int) -> Any:
    """Return a, b or one of their derivatives by θ²/2, summed in the precision of θ²."""
    order, derived = 2 + which % 2, which >= 2
    total, power, k = 0 * square, 0 * square + (-2 if derived else 1), 0
    while total + (term := power * (k + 1) ** derived / math.factorial(order + 2 * (k + derived))) != total:
        total, power, k = total + term, -power * square, k + 1
    return total


def _cross(d: Coefficients, v: Array) -> Array:
    """Return the matrices (..., 3, 3) of the cross product with v."""
    x, y, z = components(v)
    zero = d.zeros_like(x)
    nine = d.stack([zero, -z, y, z, zero, -x, -y, x, zero])
    return d.reshape(nine, (*nine.shape[:-1], 3, 3))


def _dot(d: Coefficients, v: Array, w: Array) -> Array:
    """Return the products (..., 1, 1) of vectors."""
    total = sum(x * y for x, y in zip(components(v), components(w), strict=True))
    return d.stack([total])[..., None]


def _nonzero(s: Array) -> Array:
    return np.array([not is_zero(x) for x in np.ravel(s)], bool).reshape(np.shape(s))
