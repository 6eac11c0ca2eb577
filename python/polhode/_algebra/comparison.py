"""Exact and approximate equality of values."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _generic, _native
from polhode._algebra.coefficients import common, namespace
from polhode._algebra.grades import over_grades
from polhode._algebra.products import coerced, common_algebra
from polhode._support.arrays import common_batch, is_complex

if TYPE_CHECKING:
    from polhode._algebra.multivector import Multivector


def equal(a: Multivector, b: Multivector) -> Any:
    """Whether all components are equal: a bool, or an array of the batch shape."""
    if a.algebra is not b.algebra:
        return False
    left, right = _same_grades(a, b)
    same: Any = left == right
    if isinstance(left, np.ndarray):
        result: Any = np.asarray(same, dtype=bool).all(axis=-1)
        return result[()]
    return namespace(left).all(same, axis=-1)


def is_close(a: Multivector, other: Any, rtol: float = 1e-9, atol: float = 0.0) -> Any:
    """Whether ``|A − B| <= max(rtol · max(|A|, |B|), atol)``: a bool, or an array of the batch shape.

    Sizes are those of the components, ``√Σ c²``.

    Examples
    --------
    >>> 0.1 * ph.e1 + 0.2 * ph.e1 == 0.3 * ph.e1
    False
    >>> bool((0.1 * ph.e1 + 0.2 * ph.e1).is_close(0.3 * ph.e1))
    True
    """
    if type(rtol) is float and type(atol) is float and rtol >= 0 <= atol:
        near = _native.are_close(a, other, rtol, atol)
        if near is not None:
            return np.bool_(near)
    b = coerced(other, a)
    if b is None:
        raise TypeError(f"cannot compare a multivector with {type(other).__name__}")
    common_algebra(a, b)
    if np.any(np.less(rtol, 0)) or np.any(np.less(atol, 0)):
        raise ValueError(f"rtol and atol must not be negative, got {rtol} and {atol}")
    left, right = _same_grades(a, b)
    if left.dtype == object:
        left, right = _as_floats(left), _as_floats(right)
    xp = namespace(left)
    # Measured in units of the largest component, so that nothing overflows.
    unit = xp.max(xp.maximum(xp.abs(left), xp.abs(right)), axis=-1, keepdims=True)
    unit = xp.where(xp.isfinite(unit) & (unit > 0), unit, xp.ones_like(unit))
    with np.errstate(over="ignore", invalid="ignore"):  # inf − inf and NaN are not close
        left, right = left / unit, right / unit
        size = xp.maximum(_length(xp, left), _length(xp, right))
        near = _length(xp, left - right) <= xp.maximum(rtol * size, atol / unit[..., 0])
        near = xp.isfinite(size) & near
    result = xp.logical_or(near, equal(a, b))
    return result[()] if isinstance(result, np.ndarray) else result


def is_finite(value: Multivector) -> Any:
    """Whether no component is NaN or infinite: a bool, or an array of the batch shape.

    It finds the rows without a value in results with ``errors="mask"``.

    Examples
    --------
    >>> ph.vector([[1, 2, 3], [1, np.nan, 3]]).is_finite()
    array([ True, False])
    """
    data = value._data
    if data.dtype == object:
        result: Any = np.frompyfunc(_generic.exact.is_finite, 1, 1)(data).astype(bool).all(axis=-1)
        return result[()]
    xp = namespace(data)
    finite = xp.all(xp.isfinite(data), axis=-1)
    return finite[()] if isinstance(finite, np.ndarray) else finite


def _length(xp: Any, x: Any) -> Any:
    size = np.abs(x) if is_complex(x) else x
    return xp.sqrt(xp.sum(size * size, axis=-1))


def _same_grades(a: Multivector, b: Multivector) -> tuple[Any, Any]:
    common_batch(a.shape, b.shape)
    mask = a._mask | b._mask
    left, right = common(over_grades(a, mask), over_grades(b, mask))
    return left, right


def _as_floats(data: Any) -> Any:
    try:
        return data.astype(np.float64)
    except TypeError:
        raise TypeError(
            "is_close needs numbers; simplify the difference of symbolic values and compare it with =="
        ) from None
    except OverflowError:
        raise ValueError("is_close needs numbers within 1.8e308; compare exact ones with ==") from None
