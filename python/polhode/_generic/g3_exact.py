"""Functions of G3 for one multivector of exact, symbolic or multiprecision components.

The formulas are those of `g3_smooth`, for `M = ζ + V`, V² = w. A value can be inspected here, so there are no
series. The functions are even in the root of w: either root will do.
"""

from __future__ import annotations

import sys
from typing import Any

from polhode._generic.exact import atan2, call, divide, is_symbolic, is_zero
from polhode._generic.exact import sqrt as root_of
from polhode._generic.layout import Complex, join, split

Row = list[Any]


def exp(m: Row) -> Row:
    """``e^ζ (cosh √w + V sinh √w / √w)``."""
    zeta, w = split(m)
    root = _simple_root(m, w)
    factor = Complex(call("cos", zeta.im), call("sin", zeta.im)).times(call("exp", zeta.re))
    cosh = Complex(call("cosh", root.re) * call("cos", root.im), call("sinh", root.re) * call("sin", root.im))
    sinh = Complex(call("sinh", root.re) * call("cos", root.im), call("cosh", root.re) * call("sin", root.im))
    sinhc = Complex(1, 0) if _vanishes(root) else _over(sinh, root)
    return join(factor * cosh, m, factor * sinhc)


def log(m: Row) -> Row:
    """A logarithm: even for even elements, else the principal one."""
    if _is_even(m):
        return _log_even(m)
    zeta, w = split(m)
    root = _simple_root(m, w)
    plus, minus = zeta + root, zeta - root
    if _vanishes(plus) or _vanishes(minus):
        raise ValueError("no logarithm: the multivector is singular")
    log_plus, log_minus = _log(plus), _log(minus)
    mean = _half(log_plus + log_minus)
    quotient = _inverse(zeta) if _vanishes(root) else _over(_half(log_plus - log_minus), root)
    return join(mean, m, quotient)


def _log_even(m: Row) -> Row:
    """``log|M| + B/|B| · atan2(|B|, s)``; of a number, whose plane is any, in e1e2."""
    s, b = m[0], m[4:7]
    size = length(b)
    if is_zero(size) and is_zero(s):
        raise ValueError("no logarithm: the multivector is singular")
    plane = [0, 0, 1] if is_zero(size) else [divide(x, size) for x in b]
    angle = atan2(size, s)
    return [log_length(s, size), 0, 0, 0, *(angle * x for x in plane), 0]


def sqrt(m: Row) -> Row:
    """A square root: even for even elements, else the principal one."""
    if _is_even(m):
        return _sqrt_even(m)
    zeta, w = split(m)
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
        half = _sqrt(Complex(s, 0))
        return [half.re, 0, 0, 0, 0, 0, half.im, 0]
    norm = root_of(s * s + size * size)
    if not is_symbolic(s) and s < 0:
        size = abs(size)
        c = root_of(divide(norm - s, 2))
        return [divide(size, 2 * c), 0, 0, 0, *(divide(c * x, size) for x in b), 0]
    c = root_of(divide(norm + s, 2))
    return [c, 0, 0, 0, *(divide(x, 2 * c) for x in b), 0]


def inverse(m: Row) -> Row:
    """``(ζ − V)/(ζ² − w)``."""
    zeta, w = split(m)
    determinant = zeta * zeta - w
    if _vanishes(determinant):
        raise ValueError("no inverse: the multivector is singular")
    reciprocal = _inverse(determinant)
    return join(zeta * reciprocal, m, -reciprocal)


def unit(m: Row, message: str = "the multivector has no direction (norm 0)") -> Row:
    """Return the row divided by its norm, unchanged if that proves to be 1; a ValueError if it is 0."""
    square = sum(x * x for x in m)
    if is_zero(square):
        raise ValueError(message)
    if is_zero(square - 1):
        return m
    norm = root_of(square)
    return [divide(x, norm) for x in m]


# --- complex numbers ``x + yI``


def _over(x: Complex, y: Complex) -> Complex:
    """``x/y``; by a number that is real or imaginary without squaring it."""
    if is_zero(y.im):
        return Complex(divide(x.re, y.re), divide(x.im, y.re))
    if is_zero(y.re):
        return Complex(divide(x.im, y.im), divide(-x.re, y.im))
    return x.over(y, divide)


def _inverse(z: Complex) -> Complex:
    return _over(Complex(1, 0), z)


def _half(z: Complex) -> Complex:
    return Complex(divide(z.re, 2), divide(z.im, 2))


def _vanishes(z: Complex) -> bool:
    return is_zero(z.re) and is_zero(z.im)


def _log(z: Complex) -> Complex:
    return Complex(log_length(z.re, z.im), atan2(z.im, z.re))


def log_length(x: Any, y: Any) -> Any:
    """``log √(x² + y²)``."""
    if is_zero(x) or is_zero(y):
        return call("log", abs(x if is_zero(y) else y))
    return divide(call("log", x * x + y * y), 2)


def _sqrt(z: Complex) -> Complex:
    """Principal value. A real number of unknown sign has ``√((|x| + x)/2) + I √((|x| − x)/2)``."""
    x, y = z.re, z.im
    if is_zero(y):
        return Complex(root_of(divide(abs(x) + x, 2)), root_of(divide(abs(x) - x, 2)))
    size = root_of(x * x + y * y)
    if not is_symbolic(x) and not is_symbolic(y) and x < 0:
        large = root_of(divide(size - x, 2))
        sign = -1 if y < 0 else 1
        return Complex(divide(sign * y, 2 * large), sign * large)
    large = root_of(divide(size + x, 2))
    return Complex(large, divide(y, 2 * large))


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
    return root_of(sum(x * x for x in b)) if single is None else single


def _simple_root(m: Row, w: Complex) -> Complex:
    """A root of w: x for ``V = x e1``, xI for ``V = x e1e2``; symbols give their roots freely, √θ² = θ."""
    single = _single(m[1:7])
    if single is not None:
        return Complex(0, single) if all(is_zero(a) for a in m[1:4]) else Complex(single, 0)
    if not is_zero(w.im):
        return _sqrt(w)
    bivector = all(is_zero(a) for a in m[1:4])
    if bivector or not (is_symbolic(w.re) or w.re >= 0):
        return Complex(0, free_root(-w.re))
    return Complex(free_root(w.re), 0)


def free_root(x: Any) -> Any:
    """A root of x of either sign."""
    root = root_of(x)
    return sys.modules["sympy"].powdenest(root, force=True) if is_symbolic(root) else root
