"""Euler angles of rotors over arrays of any coefficients.

In quaternions, whose units e_i, e_j, e_k are those of the axes, a turn about i, then j, then i again is
``q = q_i(θ3) q_j(θ2) q_i(θ1)``. Because ``q_i(θ) e_j = e_j q_i(−θ)``, its parts are the complex numbers
``q_0 + i q_i = cos(θ2/2) exp(i(θ3 + θ1)/2)`` and ``q_j + i ε q_k = sin(θ2/2) exp(i(θ3 − θ1)/2)``, with ε = ±1
as i, j, k are right- or left-handed (Bernardes & Viollet, PLoS ONE 17 (2022)). Their product has the angle
θ3, the product of the first and the conjugate of the second θ1.

Where the three axes i, j, k differ, a quarter turn about j, ``(1 + e_j) q/√2``, carries i to ±k: it is such a
product, of the angles θ1, θ2 + π/2 and ε θ3.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from polhode._generic import exact
from polhode._generic.coefficients import Coefficients
from polhode._generic.exact import Exact
from polhode._generic.functions import by_rows, components
from polhode._generic.numeric import Numeric

Array = Any
Parts = list[Any]

# A cosine or sine of θ2/2 below this many roundings is rounding of the quaternion.
_LOCK = 4


def to_radians(d: Coefficients, angles: Array) -> Array:
    """Angles in degrees as radians."""
    if isinstance(d, Numeric):
        return angles * (math.pi / 180)
    return _by_elements(lambda x: exact.divide(x * exact.pi_beside(x, d.pi), 180), angles)


def to_degrees(d: Coefficients, angles: Array) -> Array:
    """Angles in radians as degrees."""
    if isinstance(d, Numeric):
        return angles * (180 / math.pi)
    return _by_elements(lambda x: 180 * x / exact.pi_beside(x, d.pi), angles)


def _by_elements(function: Any, angles: Array) -> Array:
    return np.frompyfunc(function, 1, 1)(angles)


def to_euler(d: Coefficients, wxyz: Array, axes: tuple[int, int, int], turning: bool) -> Array:
    """Angles (..., 3) of quaternions (..., 4) about the axes, numbered from 0; `turning` if they turn along.

    In gimbal lock, where only the sum or difference of the outer angles is known, the one named last is 0.
    """
    if isinstance(d, Exact):
        return by_rows(lambda q: _angles_of_row(d, q, axes, turning), wxyz, [0, 1, 2])
    (a, b, c, e), sign = _two_numbers(components(wxyz), axes, turning)
    # Equal to the other, or to its conjugate, the number in lock gives 0 for the angle named last.
    with np.errstate(all="ignore"):
        cosine, sine = d.length([a, b]), d.length([c, e])
        free = 1.0 if turning else -1.0
        locked = cosine <= _LOCK * d.eps
        a, b = d.where(locked, c, a), d.where(locked, free * e, b)
        locked = sine <= _LOCK * d.eps
        c, e = d.where(locked, a, c), d.where(locked, free * b, e)
        middle = 2.0 * d.atan2(sine, cosine)
        first, last = d.atan2(b * c - a * e, a * c + b * e), d.atan2(b * c + a * e, a * c - b * e)
    if sign is not None:
        middle, last = middle - 0.5 * math.pi, sign * last
    return d.stack([last, middle, first] if turning else [first, middle, last])


def _angles_of_row(d: Exact, q: Parts, axes: tuple[int, int, int], turning: bool) -> Parts:
    """Return the angles of one quaternion of exact, symbolic or multiprecision components."""
    (a, b, c, e), sign = _two_numbers(q, axes, turning)
    cosine, sine = (exact.sqrt(x * x + y * y) for x, y in ((a, b), (c, e)))
    free = 1 if turning else -1
    if exact.is_rounding(cosine, _LOCK * d.eps):
        a, b = c, free * e
    elif exact.is_rounding(sine, _LOCK * d.eps):
        c, e = a, free * b
    middle = 2 * exact.atan2(sine, cosine)
    first, last = exact.atan2(b * c - a * e, a * c + b * e), exact.atan2(b * c + a * e, a * c - b * e)
    if sign is not None:
        middle, last = middle - exact.divide(exact.pi_beside(middle, d.pi), 2), sign * last
    return [last, middle, first] if turning else [first, middle, last]


def _two_numbers(q: Parts, axes: tuple[int, int, int], turning: bool) -> tuple[Parts, int | None]:
    """Return the real and imaginary parts of both complex numbers, and ε where the three axes differ."""
    i, j, third = axes[::-1] if turning else axes
    k = 3 - i - j
    sign = 1 if (j - i) % 3 == 1 else -1
    a, b, c, e = q[0], q[1 + i], q[1 + j], sign * q[1 + k]
    return ([a, b, c, e], None) if third == i else ([a - c, b + e, c + a, e - b], sign)
