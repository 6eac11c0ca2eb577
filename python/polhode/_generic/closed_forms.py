"""exp, log and sqrt of G3 for one multivector of exact, symbolic or multiprecision components.

The formulas are those of `smooth`, for `M = ζ + V`, V² = w; an element at hand can be looked at, so there are
no series. A root of w enters evenly: either will do.
"""

from __future__ import annotations

import sys
from typing import Any

from polhode._generic.central import Central
from polhode._generic.exact import (
    atan2,
    call,
    divide,
    is_finite,
    is_symbolic,
    is_zero,
    sqrt,
)
from polhode._generic.layout import join, split

Row = list[Any]


def exp_row(m: Row) -> Row:
    """``e^ζ (cosh √w + V sinh √w / √w)``."""
    zeta, w = split(m)
    root = _simple_root(m, w)
    factor = Central(call("cos", zeta.im), call("sin", zeta.im)).times(call("exp", zeta.re))
    cosh = Central(call("cosh", root.re) * call("cos", root.im), call("sinh", root.re) * call("sin", root.im))
    sinh = Central(call("sinh", root.re) * call("cos", root.im), call("cosh", root.re) * call("sin", root.im))
    sinhc = Central(1, 0) if _vanishes(root) else _over(sinh, root)
    return join(factor * cosh, m, factor * sinhc)


def log_row(m: Row) -> Row:
    """A logarithm: even for even elements, else the principal one."""
    zeta, w = split(m)
    if _is_even(m):
        return log_even(m)
    root = _simple_root(m, w)
    plus, minus = zeta + root, zeta - root
    if _vanishes(plus) or _vanishes(minus):
        raise ValueError("no logarithm: the multivector is singular")
    log_plus, log_minus = _log(plus), _log(minus)
    mean = _half(log_plus + log_minus)
    quotient = _inverse(zeta) if _vanishes(root) else _over(_half(log_plus - log_minus), root)
    return join(mean, m, quotient)


def log_even(m: Row) -> Row:
    """``log|M| + B/|B| · atan2(|B|, s)``; of a number, whose plane is any, in e1e2."""
    s, b = m[0], m[4:7]
    size = length(b)
    if is_zero(size) and is_zero(s):
        raise ValueError("no logarithm: the multivector is singular")
    plane = [0, 0, 1] if is_zero(size) else [divide(x, size) for x in b]
    angle = atan2(size, s)
    return [_log_length(s, size), 0, 0, 0, *(angle * x for x in plane), 0]


def sqrt_row(m: Row) -> Row:
    """A square root: even for even elements, else the principal one."""
    zeta, w = split(m)
    if _is_even(m):
        return _sqrt_even(m)
    root = _simple_root(m, w)
    total = _sqrt(zeta + root) + _sqrt(zeta - root)
    if _vanishes(total):
        raise ValueError("no square root: the multivector is singular")
    return join(_half(total), m, _inverse(total))


def _sqrt_even(m: Row) -> Row:
    """``√(s + B) = c + B/2c`` with ``c = √((|M| + s)/2)``; of a negative number in e1e2.

    Where s < 0 the sum may cancel; then ``|B|/2c + c B/|B|`` with ``c = √((|M| − s)/2)``.
    """
    s, b = m[0], m[4:7]
    size = length(b)
    if is_zero(size):
        half = _sqrt(Central(s, 0))
        return [half.re, 0, 0, 0, 0, 0, half.im, 0]
    norm = sqrt(s * s + size * size)
    if not is_symbolic(s) and s < 0:
        size = abs(size)
        c = sqrt(divide(norm - s, 2))
        return [divide(size, 2 * c), 0, 0, 0, *(divide(c * x, size) for x in b), 0]
    c = sqrt(divide(norm + s, 2))
    return [c, 0, 0, 0, *(divide(x, 2 * c) for x in b), 0]


def inverse_row(m: Row) -> Row:
    """``(ζ − V)/(ζ² − w)``."""
    zeta, w = split(m)
    determinant = zeta * zeta - w
    if _vanishes(determinant):
        raise ValueError("no inverse: the multivector is singular")
    reciprocal = _inverse(determinant)
    return join(zeta * reciprocal, m, -reciprocal)


def unit_row(m: Row) -> Row:
    """The row divided by its length; as it is where that proves to be 1."""
    square = sum(x * x for x in m)
    if is_zero(square):
        raise ValueError("the multivector has no direction (norm 0)")
    if is_zero(square - 1):
        return m
    norm = sqrt(square)
    return [divide(x, norm) for x in m]


# --- central elements


def _over(x: Central, y: Central) -> Central:
    """``x/y``; by a number that is real or imaginary without squaring it."""
    if is_zero(y.im):
        return Central(divide(x.re, y.re), divide(x.im, y.re))
    if is_zero(y.re):
        return Central(divide(x.im, y.im), divide(-x.re, y.im))
    return x.over(y, divide)


def _inverse(z: Central) -> Central:
    return _over(Central(1, 0), z)


def _half(z: Central) -> Central:
    return Central(divide(z.re, 2), divide(z.im, 2))


def _vanishes(z: Central) -> bool:
    return is_zero(z.re) and is_zero(z.im)


def _log(z: Central) -> Central:
    return Central(_log_length(z.re, z.im), atan2(z.im, z.re))


def _log_length(x: Any, y: Any) -> Any:
    """``log √(x² + y²)``."""
    if is_zero(x) or is_zero(y):
        return call("log", abs(x if is_zero(y) else y))
    return divide(call("log", x * x + y * y), 2)


def _sqrt(z: Central) -> Central:
    """Principal value. A real number of unknown sign has ``√((|x| + x)/2) + I √((|x| − x)/2)``."""
    x, y = z.re, z.im
    if is_zero(y):
        return Central(sqrt(divide(abs(x) + x, 2)), sqrt(divide(abs(x) - x, 2)))
    size = sqrt(x * x + y * y)
    if not is_symbolic(x) and not is_symbolic(y) and x < 0:
        large = sqrt(divide(size - x, 2))
        sign = -1 if y < 0 else 1
        return Central(divide(sign * y, 2 * large), sign * large)
    large = sqrt(divide(size + x, 2))
    return Central(large, divide(y, 2 * large))


# --- vectors and bivectors


def _is_even(m: Row) -> bool:
    return all(is_zero(m[i]) for i in (1, 2, 3, 7))


def _single(components: Row) -> Any:
    """Return the one component that is not 0, with its sign; None if there are others."""
    present = [x for x in components if not is_zero(x)]
    return present[0] if len(present) == 1 else None


def length(b: Row) -> Any:
    """``√Σb²``, or the only component that is not 0: its sign cancels where the length divides b."""
    single = _single(b)
    return sqrt(sum(x * x for x in b)) if single is None else single


def _simple_root(m: Row, w: Central) -> Central:
    """A root of w: x for ``V = x e1``, xI for ``V = x e1e2``; symbols give their roots freely, √θ² = θ."""
    single = _single(m[1:7])
    if single is not None:
        return Central(0, single) if all(is_zero(a) for a in m[1:4]) else Central(single, 0)
    if not is_zero(w.im):
        return _sqrt(w)
    bivector = all(is_zero(a) for a in m[1:4])
    if bivector or not (is_symbolic(w.re) or w.re >= 0):
        return Central(0, free_root(-w.re))
    return Central(free_root(w.re), 0)


def free_root(x: Any) -> Any:
    """A root of x of either sign."""
    root = sqrt(x)
    return sys.modules["sympy"].powdenest(root, force=True) if is_symbolic(root) else root


def require_finite(m: Row) -> None:
    """Raise a ValueError where some component is NaN or infinite."""
    if not all(map(is_finite, m)):
        raise ValueError("a component is NaN or infinite; remove such values first")
