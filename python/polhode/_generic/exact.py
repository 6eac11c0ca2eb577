"""Arithmetic of Python objects: int, Fraction, SymPy expressions, mpmath numbers, and floats among them.

Exact stays exact: ``1/2`` is a Fraction, ``√(9/4)`` is ``3/2``, ``cos 0`` is 1. Without an exact value, the
function of the element's own library is used: SymPy's, mpmath's at its precision, else `math`.
"""

from __future__ import annotations

import functools
import math
import sys
from collections.abc import Callable, Sequence
from fractions import Fraction
from numbers import Rational
from typing import Any

import numpy as np

from polhode._support.arrays import at_index, first_index

Array = Any

_EPS = 2.0**-52
_WHOLE = 2.0**53  # larger floats are whole because they are rounded


def is_symbolic(x: Any) -> bool:
    """Whether x is a SymPy expression. Does not import SymPy: before its import there are none."""
    sympy = sys.modules.get("sympy")
    return sympy is not None and isinstance(x, sympy.Expr)


def is_multiprecision(x: Any) -> bool:
    """Whether x is a real number of mpmath."""
    mpmath = sys.modules.get("mpmath")
    return mpmath is not None and isinstance(x, mpmath.mpf)


def is_coefficient(x: Any) -> bool:
    """Whether x is a number or expression that an array of floats cannot hold."""
    return isinstance(x, Fraction) or is_symbolic(x) or is_multiprecision(x)


def checked(x: Any, index: tuple[int, ...] = ()) -> Any:
    """Return the element as one of the supported types; a TypeError if it is of none."""
    if is_symbolic(x) or is_multiprecision(x) or type(x) in (int, float, Fraction):
        return x
    if isinstance(x, bool | np.bool_):
        pass  # probably a mask passed by mistake
    elif isinstance(x, Rational):
        return divide(int(x.numerator), int(x.denominator))
    elif isinstance(x, float | np.floating):
        return float(x)
    raise TypeError(
        f"the coefficient{at_index(index)} is {x!r} ({type(x).__name__}); "
        "coefficients are int, float, Fraction, SymPy expressions or mpmath.mpf"
    )


def met(x: float) -> Any:
    """Convert a float that is combined with exact coefficients: a whole one becomes an integer."""
    return int(x) if x.is_integer() and abs(x) <= _WHOLE else x


# --- elements


def _library(*elements: Any) -> Any:
    """Return the module with the functions of these elements: sympy, an mpmath context, or math."""
    if any(map(is_symbolic, elements)):
        return sys.modules["sympy"]
    for x in elements:
        if is_multiprecision(x):
            return x.context
    return math


# The values that stay exact.
_AT_ZERO = {"sin": 0, "cos": 1, "tan": 0, "exp": 1, "sinh": 0, "cosh": 1, "atan": 0}


def call(name: str, x: Any) -> Any:
    """``sin``, ``cos``, ``tan``, ``sinh``, ``cosh``, ``atan``, ``exp`` or ``log`` of an element."""
    if name in _AT_ZERO and not is_symbolic(x) and x == 0:
        return _AT_ZERO[name]
    if name == "log" and isinstance(x, Rational) and x == 1:
        return 0
    try:
        return getattr(_library(x), name)(x)
    except OverflowError:
        raise ValueError(f"{name}({x}) is beyond the range of floating point (1.8e308)") from None


def atan2(y: Any, x: Any) -> Any:
    """Return the angle of the point (x, y); exactly 0 on the positive axis."""
    if isinstance(x, int | Fraction) and isinstance(y, int | Fraction) and y == 0 < x:
        return 0
    return _library(x, y).atan2(y, x)


def sqrt(x: Any) -> Any:
    """``√x``: exact for the squares of rational numbers and in SymPy."""
    if isinstance(x, int | Fraction) and x >= 0:
        top, bottom = math.isqrt(x.numerator), math.isqrt(x.denominator)
        if top * top == x.numerator and bottom * bottom == x.denominator:
            return divide(top, bottom)
    return _library(x).sqrt(x)


def divide(x: Any, y: Any) -> Any:
    """``x/y``; the quotient of whole numbers and fractions is an int or a Fraction."""
    if isinstance(x, int | Fraction) and isinstance(y, int | Fraction):
        quotient = Fraction(x) / y
        return quotient.numerator if quotient.denominator == 1 else quotient
    return x / y


def is_zero(x: Any) -> bool:
    """Whether x is 0; an expression such as ``1 − sin² − cos²`` is evaluated at points to find out."""
    if not is_symbolic(x):
        return bool(x == 0)
    if x.is_zero is not None or x.is_number:
        return x.is_zero is True or (x.is_zero is None and _is_tiny(x))
    return _is_tiny(x.subs(_point(x, 1))) and _is_tiny(x.subs(_point(x, -1)))


def may_be_positive(x: Any) -> bool:
    """Whether x is a positive number, or an expression that SymPy does not know to be zero or negative."""
    return x.is_positive is not False if is_symbolic(x) else bool(x > 0)


def is_negative(x: Any) -> bool:
    """Whether x is a negative number, or an expression that SymPy knows to be negative."""
    return x.is_negative is True if is_symbolic(x) else bool(x < 0)


def _is_tiny(number: Any) -> bool:
    """Whether an expression is 0 to 20 digits; one that has no numerical value is not."""
    value = number.evalf(30)
    return bool(value.is_number and abs(value) < 1e-20)


def _point(x: Any, sign: int) -> dict[Any, Any]:
    """Return arbitrary values for the symbols and unknown functions in x, of this sign where it is allowed.

    An expression that vanishes at two such points is taken as 0; simplifying it could take minutes.
    """
    sympy = sys.modules["sympy"]
    unknown = x.atoms(sympy.core.function.AppliedUndef, sympy.Derivative) | x.free_symbols
    values = {}
    for k, symbol in enumerate(sorted(unknown, key=str)):
        size = sympy.Rational(sympy.prime(k + 20), 97)
        values[symbol] = size if symbol.is_nonnegative else -size if symbol.is_nonpositive else sign * size
    return values


def is_rounding(x: Any, tolerance: float) -> bool:
    """Whether x is 0; of a float or a multiprecision number, whether it is no larger than the tolerance."""
    if is_symbolic(x) or isinstance(x, int | Fraction):
        return is_zero(x)
    return bool(abs(x) <= tolerance)


def rounding(elements: Sequence[Any], digits: float) -> Any:
    """Return this part of the digits of ``Σx²``: of floats and multiprecision numbers; 0 if all are exact."""
    known = [x for x in elements if not is_symbolic(x)]
    rounded = [x for x in known if not isinstance(x, int | Fraction)]
    if not rounded:
        return 0
    eps = max(x.context.eps if is_multiprecision(x) else _EPS for x in rounded)
    return eps**digits * sum(x * x for x in known)


def pi_like(x: Any, pi: Any) -> Any:
    """Return SymPy's π if x is an expression, else the number given."""
    return sys.modules["sympy"].pi if is_symbolic(x) else pi


def is_finite(x: Any) -> bool:
    """Whether x is not NaN or infinite; expressions are finite unless SymPy knows otherwise."""
    if is_symbolic(x):
        return x.is_finite is not False and x is not sys.modules["sympy"].nan
    return isinstance(x, int | Fraction) or bool(_library(x).isfinite(x))


class Exact:
    """Arithmetic of NumPy arrays of Python objects."""

    exact = True
    is_jax = False
    native = False
    divide = np.frompyfunc(divide, 2, 1)
    sqrt = np.frompyfunc(sqrt, 1, 1)
    sin, cos, tan = (np.frompyfunc(functools.partial(call, name), 1, 1) for name in ("sin", "cos", "tan"))

    def __init__(self, context: Any = None) -> None:
        self._context = context  # of mpmath, if its numbers are among the elements

    @property
    def eps(self) -> float:
        """The spacing of rounded numbers at 1."""
        return 2.0**-52 if self._context is None else float(self._context.eps)

    @property
    def pi(self) -> Any:
        """π, to the precision of the mpmath context if there is one."""
        return math.pi if self._context is None else +self._context.pi

    def asarray(self, values: Any) -> Array:
        """Convert numbers, expressions, nested lists and arrays to an array of objects; check every element.

        Whole floats of a float array become integers, so that ``Fraction(1, 3) * e1`` stays exact; other
        floats turn results into floats, as everywhere in Python.
        """
        given = np.asarray(values) if isinstance(values, np.ndarray) else np.array(values, dtype=object)
        if given.dtype.kind in "iuf":
            elements = [self._element(met(float(x))) for x in given.flat]
        else:
            where = np.ndindex(given.shape)
            elements = [self._element(checked(x, i)) for x, i in zip(given.flat, where, strict=True)]
        array = np.empty(given.shape, dtype=object)
        array.reshape(-1)[:] = elements
        return array

    def _element(self, x: Any) -> Any:
        """Convert rational numbers among mpmath numbers, whose subtraction does not accept fractions."""
        if self._context is None or not isinstance(x, int | Fraction) or x == 0:
            return x
        return self._context.mpf(x.numerator) / x.denominator

    factor = asarray

    def zeros(self, shape: tuple[int, ...]) -> Array:
        """Return exact zeros of this shape."""
        return np.zeros(shape, dtype=int).astype(object)

    def zeros_like(self, x: Array) -> Array:
        """Return exact zeros in the shape of x."""
        return self.zeros(np.shape(x))

    def stack(self, components: list[Array]) -> Array:
        """Broadcast the components together and lay them along a new last axis."""
        batch = np.broadcast_shapes(*map(np.shape, components))
        stacked = np.empty((*batch, len(components)), dtype=object)
        for i, component in enumerate(components):
            stacked[..., i] = component
        return stacked

    def concat(self, arrays: list[Array], axis: int) -> Array:
        """Join arrays along an axis."""
        return np.concatenate(arrays, axis=axis)

    def reshape(self, x: Array, shape: tuple[int, ...]) -> Array:
        """Return the elements in another shape."""
        return np.reshape(x, shape)

    def is_concrete(self, _: Array) -> bool:
        """Whether values are known: always."""
        return True

    def require(self, ok: Array, message: str) -> None:
        """Raise a ValueError, with the first index where `ok` is false."""
        if np.all(ok):
            return
        index = first_index(~np.asarray(ok))
        raise ValueError(f"at index {index}: {message}" if index else message)


def by_rows(f: Callable[[list[Any]], list[Any]], data: Array, places: Sequence[int] | None = None) -> Array:
    """Apply f to each row of elements; keep the elements of its value at these places, by default as many.

    An error gains the batch index.
    """
    wanted = range(data.shape[-1]) if places is None else places
    result = np.empty((*data.shape[:-1], len(wanted)), dtype=object)
    for index in np.ndindex(data.shape[:-1]):
        row = list(data[index])
        try:
            if not all(map(is_finite, row)):
                raise ValueError("a component is NaN or infinite; remove such values first")
            values = f(row)
        except ValueError as error:
            raise ValueError(f"at index {index}: {error}" if index else str(error)) from None
        for k, i in enumerate(wanted):
            result[(*index, k)] = values[i]
    return result
