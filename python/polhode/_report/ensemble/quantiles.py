"""Quantiles over the bodies of an ensemble."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._support.arrays import Array

if TYPE_CHECKING:
    from numpy.typing import NDArray

LEVELS = (0.05, 0.25, 0.5, 0.75, 0.95)


def quantiles(values: NDArray[Any]) -> Array:
    """Return the quantiles (5, ...) of values (bodies, ...) at `LEVELS`.

    NaN, such as of failed bodies, is ignored; quantiles of nothing else are NaN.
    """
    columns = values.reshape(len(values), -1)
    found = np.stack([_of_column(columns[:, k]) for k in range(columns.shape[1])], axis=-1)
    return found.reshape(len(LEVELS), *values.shape[1:])


def _of_column(column: NDArray[Any]) -> Array:
    known = column[~np.isnan(column)].astype(np.float64)
    return np.quantile(known, LEVELS) if known.size else np.full(len(LEVELS), np.nan)


def first_above(times: Array, values: Array, bound: float) -> float | None:
    """Return the time at which values first pass a bound, interpolated linearly; None if they do not."""
    above = np.flatnonzero(values > bound)
    if not above.size:
        return None
    k = int(above[0])
    if k == 0:
        return float(times[0])
    share = (bound - values[k - 1]) / (values[k] - values[k - 1])
    return float(times[k - 1] + share * (times[k] - times[k - 1]))
