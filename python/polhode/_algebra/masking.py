"""`errors="mask"`: NaN in the rows of a batch for which a function has no value."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Literal, TypeVar

import numpy as np

from polhode import _native
from polhode._algebra.coefficients import as_coefficients
from polhode._support.arrays import common_batch, is_float

Errors = Literal["raise", "mask"]
# An argument, and how many of its last axes belong to one value; those of a multivector are known.
Operand = tuple[Any, int]
T = TypeVar("T")


def masked(errors: str, f: Callable[..., T], *operands: Operand) -> T:
    """Return f of the operands, whose batch shapes broadcast, with NaN where f raises a ValueError.

    The other rows have the same bits as without the bad ones. f returns a multivector, an array, or a tuple
    of them. Rows that are not finite are not passed to f. The bad ones are found by halving, with some log n
    calls for each. A TypeError unless the operands are NumPy floats; a ValueError for another word than
    "mask", and for shapes of single values that f refuses.
    """
    if errors != "mask":
        raise ValueError(f'errors must be "raise" or "mask", got {errors!r}')
    given = [
        (value if _is_value(value) else as_coefficients(value, "an argument"), k) for value, k in operands
    ]
    data = [value._data if _is_value(value) else value for value, _ in given]
    for x in data:
        if not is_float(x):
            raise TypeError(
                f'errors="mask" needs NumPy floats, got {type(x).__name__} of {x.dtype}; convert them first'
            )
    shapes = [value.shape if _is_value(value) else value.shape[: value.ndim - k] for value, k in given]
    batch = common_batch(*shapes)
    count = math.prod(batch)
    rows = [
        np.broadcast_to(x, (*batch, *x.shape[len(shape) :])).reshape(count, *x.shape[len(shape) :])
        for x, shape in zip(data, shapes, strict=True)
    ]

    def of(places: Any) -> Any:
        parts = (np.ascontiguousarray(x[places]) for x in rows)
        return f(*(v._like(x) if _is_value(v) else x for (v, _), x in zip(given, parts, strict=True)))

    empty = of(slice(0, 0))  # raises the errors that are not of single rows
    found: list[tuple[Any, Any]] = []
    finite = np.ones(count, bool)
    for x in rows:
        finite &= np.isfinite(x.reshape(count, -1)).all(axis=-1)
    _collect(of, np.flatnonzero(finite), found)
    result: T = _spread(empty, found, batch, count)
    return result


def _collect(of: Callable[[Any], Any], places: Any, found: list[tuple[Any, Any]]) -> None:
    """Append the places of good rows and their results."""
    if not len(places):
        return
    try:
        found.append((places, of(places)))
    except ValueError:
        if len(places) > 1:
            middle = len(places) // 2
            _collect(of, places[:middle], found)
            _collect(of, places[middle:], found)


def _spread(empty: Any, found: list[tuple[Any, Any]], batch: tuple[int, ...], count: int) -> Any:
    """Return the results in one batch, NaN elsewhere."""
    if isinstance(empty, tuple):
        parts = [
            _spread(part, [(places, result[k]) for places, result in found], batch, count)
            for k, part in enumerate(empty)
        ]
        return empty._make(parts) if hasattr(empty, "_make") else tuple(parts)
    # A function may return rotors for some rows, and other values for others.
    results = [result for _, result in found]
    like = next(
        (one for one in results if not isinstance(one, _native.Rotor)), results[0] if results else empty
    )
    row = (like._data if _is_value(like) else like).shape[1:]
    dtype = like.dtype if np.dtype(like.dtype).kind == "f" else np.dtype(float)
    data = np.full((count, *row), math.nan, dtype)
    for places, result in found:
        data[places] = result._data if _is_value(result) else result
    data = data.reshape((*batch, *row))
    return like._like(data) if _is_value(like) else data[()]


def _is_value(x: Any) -> bool:
    return isinstance(x, _native.Multivector)
