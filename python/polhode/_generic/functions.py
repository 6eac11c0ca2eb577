"""inverse, exp, log, sqrt and sizes of G3 over arrays of any coefficients.

Data are arrays (..., K) of the components of the grades in a mask (see `layout`); a function returns the data
and the mask of its value, the grades being those of the compiled core. What has no value is a ValueError
with the batch index; while values are unknown (traced by JAX, in a Dask graph) it is NaN or infinite instead.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from polhode._generic import closed_forms, smooth
from polhode._generic.central import Central
from polhode._generic.coefficients import Coefficients
from polhode._generic.layout import ALL, eight, grades_of, indices, join, of_eight, split
from polhode._generic.numeric import Numeric, squares

Array = Any
Value = tuple[Array, int]

_SMOOTH = {"exp": smooth.exp, "log": smooth.log, "sqrt": smooth.sqrt}
_CLOSED = {"exp": closed_forms.exp_row, "log": closed_forms.log_row, "sqrt": closed_forms.sqrt_row}


def exp(d: Coefficients, data: Array, mask: int) -> Value:
    """``exp M``."""
    return _function(d, "exp", data, mask)


def log(d: Coefficients, data: Array, mask: int) -> Value:
    """A logarithm: of an even element an even one, ``log(−1) = π e1∧e2``; else the principal one."""
    return _function(d, "log", data, mask)


def sqrt(d: Coefficients, data: Array, mask: int) -> Value:
    """A square root: of an even element an even one, ``√(−1) = e1∧e2``; else the principal one."""
    return _function(d, "sqrt", data, mask)


def _function(d: Coefficients, name: str, data: Array, mask: int) -> Value:
    result = grades_of(name, mask)
    if isinstance(d, Numeric):
        with np.errstate(all="ignore"):  # NumPy, also beneath other libraries; what matters is checked
            m = eight(d, data, mask)
            d.require_finite(m)
            values = of_eight(d, _SMOOTH[name](d, m, mask), result)
            require_in_range(d, values)
        return values, result
    return by_rows(_CLOSED[name], of_eight(d, eight(d, data, mask), ALL), indices(result)), result


def by_rows(function: Callable[[list[Any]], list[Any]], data: Array, wanted: list[int]) -> Array:
    """Apply a function to each row of exact elements, and keep the elements wanted of its value.

    Its errors are told with the batch index.
    """
    result = np.empty((*data.shape[:-1], len(wanted)), dtype=object)
    for index in np.ndindex(data.shape[:-1]):
        row = list(data[index])
        try:
            closed_forms.require_finite(row)
            values = function(row)
        except ValueError as error:
            raise ValueError(f"at index {index}: {error}" if index else str(error)) from None
        for k, i in enumerate(wanted):
            result[(*index, k)] = values[i]
    return result


# --- inverse


def inverse(d: Coefficients, data: Array, mask: int) -> Value:
    """``M⁻¹ = M̄ (M M̄)⁻¹``: with the Clifford conjugate ``M̄ = ζ − V`` the product ``M M̄ = ζ² − w`` is central.

    Exact for exact coefficients.
    """
    result = grades_of("inverse", mask)
    if not isinstance(d, Numeric):
        m = of_eight(d, eight(d, data, mask), ALL)
        return by_rows(closed_forms.inverse_row, m, indices(result)), result
    with np.errstate(all="ignore"):
        m = eight(d, data, mask)
        d.require_finite(m)
        scale = d.scale(m)
        m = [x / scale for x in m]
        zeta, w = split(m)
        determinant = zeta * zeta - w
        ratio = d.sqrt(determinant.square()) / squares(d, m)
        regular = ratio > smooth.singular(d)
        d.require(regular, "no inverse: the multivector is singular to rounding")
        reciprocal = Central(
            d.divide(determinant.re, determinant.square()), d.divide(-determinant.im, determinant.square())
        )
        values = join(zeta * reciprocal, m, -reciprocal)
        inverted = of_eight(d, [x / scale for x in values], result)
        require_in_range(d, inverted)
    return inverted, result


# --- sizes


def norm_squared(d: Coefficients, data: Array) -> Array:
    """``⟨A ~A⟩``, the sum of the squared components."""
    return squares(d, components(data))


def norm(d: Coefficients, data: Array) -> Array:
    """``√⟨A ~A⟩``; at 0, where it has no derivative, that is 0."""
    if isinstance(d, Numeric):
        with np.errstate(all="ignore"):
            return d.length(components(data))
    return d.sqrt(norm_squared(d, data))


def normalized(d: Coefficients, data: Array) -> Array:
    """``A/|A|``; a ValueError where A is zero or not finite."""
    if isinstance(d, Numeric):
        with np.errstate(all="ignore"):
            parts = components(data)
            largest = d.length(parts)
            d.require((largest > 0) & (largest < math.inf), "the multivector has no direction")
            return d.stack(d.direction(parts, [math.nan] * len(parts)))
    return by_rows(closed_forms.unit_row, data, list(range(data.shape[-1])))


def components(data: Array) -> list[Array]:
    """Return the components, taken apart."""
    return [data[..., i] for i in range(data.shape[-1])]


def require_in_range(d: Numeric, values: Array) -> None:
    """Raise a ValueError where a value is not finite."""
    finite = d.xp.all(d.xp.isfinite(values), axis=-1)
    d.require(finite, "the result is beyond the range of floating point; scale the argument down")
