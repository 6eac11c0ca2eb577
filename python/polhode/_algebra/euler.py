"""Euler angles, named as in SciPy: lower-case axes are fixed in space, upper-case axes turn with the body.

In quaternions, whose units e_i, e_j, e_k are those of the axes, a turn about i, then j, then i again is
``q = q_i(θ3) q_j(θ2) q_i(θ1)``. Because ``q_i(θ) e_j = e_j q_i(−θ)``, its parts are the complex numbers
``q_0 + i q_i = cos(θ2/2) exp(i(θ3 + θ1)/2)`` and ``q_j + i ε q_k = sin(θ2/2) exp(i(θ3 − θ1)/2)``, with ε = ±1
as i, j, k are right- or left-handed (Bernardes & Viollet, PLoS ONE 17 (2022)). Their product has the angle
θ3, the product of the first and the conjugate of the second θ1.

Where the three axes i, j, k differ, a quarter turn about j, ``(1 + e_j) q/√2``, carries i to ±k: it is such a
product, of the angles θ1, θ2 + π/2 and ε θ3.
"""

from __future__ import annotations

import itertools
import math
import re
from typing import Any

import numpy as np

from polhode._algebra.coefficients import kind_of
from polhode._generic import exact
from polhode._generic.compiled import compiled
from polhode._generic.exact import Exact, by_rows
from polhode._generic.numeric import Numeric, components
from polhode._support.arrays import is_float, remedy_for_columns

Parts = list[Any]

# A cosine or sine of θ2/2 below this many roundings is rounding of the quaternion.
_LOCK = 4


def axes_of(seq: str, lengths: tuple[int, ...]) -> list[int]:
    """Return the axes of a sequence, numbered from 0; a ValueError if it is not one of these lengths."""
    valid = isinstance(seq, str) and re.fullmatch("[xyz]+|[XYZ]+", seq)
    if not valid or len(seq) not in lengths or any(a == b for a, b in itertools.pairwise(seq)):
        count = "three" if lengths == (3,) else "one to three"
        raise ValueError(
            f"a sequence of Euler angles is {count} of x, y, z (fixed axes) or of X, Y, Z (body axes), "
            f"neighbours different; got {seq!r}{_lettered(seq)}"
        )
    return ["xyz".index(letter) for letter in seq.lower()]


def require_angles(seq: str, shape: Any) -> None:
    """Raise a ValueError unless the last axis has an angle for each axis of the sequence."""
    count = len(seq)
    if shape[-1] == count:
        return
    remedy = (
        remedy_for_columns(shape, count) if count > 1 else "; write x[..., None] for an array x of angles"
    )
    raise ValueError(
        f"sequence {seq!r} needs {count} angle{'s' if count > 1 else ''} in the last axis, got shape "
        f"{tuple(shape)}{remedy}"
    )


def _lettered(seq: object) -> str:
    """Return the remedy for a sequence of other libraries: ``321`` of aerospace, ``rzyx`` of transforms3d."""
    text = str(seq)
    if text.lower() in ("rpy", "ypr"):
        ours = "xyz" if text.lower() == "rpy" else "ZYX"
        return f"; write {ours!r} for {'roll, pitch, yaw' if ours == 'xyz' else 'yaw, pitch, roll'}"
    if re.fullmatch("[123]{1,3}", text):
        return f"; write {text.translate(str.maketrans('123', 'XYZ'))!r} for turns about body axes"
    if re.fullmatch("s[xyz]{3}", text):
        return f"; write {text[1:]!r} for turns about fixed axes"
    if re.fullmatch("r[xyz]{3}", text):
        return f"; write {text[1:].upper()!r} for turns about body axes"
    return "" if isinstance(seq, str) else "; it is text, such as 'ZYX', before the angles"


def angles_of(wxyz: Any, seq: str) -> Any:
    """Return the angles (..., 3) about the axes `seq` of quaternions (..., 4).

    In gimbal lock, where only the sum or difference of the outer angles is known, the one named last is 0.
    """
    axes, turning = axes_of(seq, (3,)), seq.isupper()
    d = Numeric(np, wxyz.dtype) if is_float(wxyz) else kind_of(wxyz)
    if isinstance(d, Exact):
        return by_rows(lambda q: _exact_angles(d, q, axes, turning), wxyz, range(3))
    return _angles(d, wxyz, axes, turning)


@compiled
def _angles(d: Numeric, wxyz: Any, axes: list[int], turning: bool) -> Any:
    (a, b, c, e), sign = _two_numbers(components(wxyz), list(axes), turning)
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


def _exact_angles(d: Exact, q: Parts, axes: list[int], turning: bool) -> Parts:
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
        middle, last = middle - exact.divide(exact.pi_like(middle, d.pi), 2), sign * last
    return [last, middle, first] if turning else [first, middle, last]


def _two_numbers(q: Parts, axes: list[int], turning: bool) -> tuple[Parts, int | None]:
    """Return the real and imaginary parts of both complex numbers, and ε where the three axes differ."""
    i, j, third = axes[::-1] if turning else axes
    k = 3 - i - j
    sign = 1 if (j - i) % 3 == 1 else -1
    a, b, c, e = q[0], q[1 + i], q[1 + j], sign * q[1 + k]
    return ([a, b, c, e], None) if third == i else ([a - c, b + e, c + a, e - b], sign)
