"""Jacobians of the exponential map of rotations, over arrays of any coefficients.

On the plane of a rotation vector v = θn the left Jacobian is the complex number ``(exp(iθ) − 1)/(iθ)``, which
is ``s exp(iθ/2)`` with ``s = sin(θ/2)/(θ/2)``; along n it is 1. So it is s times the rotation by v/2, plus
``(1 − s) n nᵀ``, without differences of nearly equal numbers.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from polhode._generic import rotors
from polhode._generic.coefficients import Coefficients
from polhode._generic.compiled import compiled
from polhode._generic.exact import by_rows, call, divide, is_zero, sqrt
from polhode._generic.g3_smooth import horner
from polhode._generic.numeric import Array, Numeric, components, squares

Parts = list[Any]

# s and (1 − s)/θ² in (θ/2)², for θ < 1: the first terms left out are below 4⁻¹⁰/21! and 4⁻⁹/21!.
_SINE = [(-1) ** k / math.factorial(2 * k + 1) for k in range(10)]
_REST = [(-1) ** k / (4 * math.factorial(2 * k + 3)) for k in range(9)]

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


def _nonzero(s: Array) -> Array:
    return np.array([not is_zero(x) for x in np.ravel(s)], bool).reshape(np.shape(s))
