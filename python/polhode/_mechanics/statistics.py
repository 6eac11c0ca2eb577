"""`Moments`: running mean, variance and extremes of blocks of numbers, which are not kept."""

from __future__ import annotations

import operator
from typing import Any

import numpy as np

from polhode._algebra.multivector import Multivector
from polhode._support.arrays import Array, as_floats


class Moments:
    """Running mean, variance and extremes over one axis of successive arrays.

    ``Moments().add(values)`` of arrays (bodies, n, ...) gives arrays (n, ...): at each time, over all bodies.
    Blocks are merged by the formulas of Chan, Golub and LeVeque, which are accurate where the mean is large
    compared with the deviation; ``a + b`` merges two. NaN, as for failed bodies, is only counted in
    `missing`.

    Parameters
    ----------
    axis
        Axis of `values` to reduce.
    """

    __slots__ = ("_axis", "_count", "_maximum", "_mean", "_minimum", "_missing", "_squares")
    _count: Array | None
    _missing: Array
    _mean: Array
    _squares: Array
    _minimum: Array
    _maximum: Array

    def __init__(self, axis: int = 0) -> None:
        self._axis = operator.index(axis)
        self._count = None

    def add(self, values: Any) -> Moments:
        """Add values, an array or a multivector (its components), and return self.

        A ValueError if the shape without the axis differs from that of the values added before.
        """
        array = as_floats(values._data if isinstance(values, Multivector) else values, "values")
        if not -array.ndim <= self._axis < array.ndim:
            raise ValueError(f"values of shape {array.shape} have no axis {self._axis}")
        self._merge(_of(array, self._axis))
        return self

    def __add__(self, other: Moments) -> Moments:
        if not isinstance(other, Moments):
            return NotImplemented
        both = Moments(self._axis)
        for one in (self, other):
            if one._count is not None:
                both._merge(one)
        return both

    def _merge(self, other: Moments) -> None:
        if self._count is None:
            for name in self.__slots__[1:]:
                setattr(self, name, getattr(other, name))
            return
        if self._count.shape != other.count.shape:
            raise ValueError(
                f"cannot merge moments of shape {other.count.shape} into shape {self._count.shape}"
            )
        # Chan: M2 = M2a + M2b + δ² na nb / n, δ the difference of the means.
        count = self._count + other.count
        share = other.count / np.maximum(count, 1)
        with np.errstate(invalid="ignore", over="ignore"):  # infinite values have no deviation
            change = other._mean - self._mean
            self._squares = self._squares + other._squares + change * change * self._count * share
            mean = np.where(share == 1, other._mean, self._mean + change * share)
            self._mean = np.where(np.isfinite(change), mean, self._mean + other._mean)
        self._count, self._missing = count, self._missing + other._missing
        self._minimum = np.fmin(self._minimum, other._minimum)
        self._maximum = np.fmax(self._maximum, other._maximum)

    @property
    def count(self) -> Array:
        """Number of values added, without NaN."""
        return self._result("_count")

    @property
    def missing(self) -> Array:
        """Number of NaN values."""
        return self._result("_missing")

    @property
    def mean(self) -> Array:
        """The mean; NaN where no value was added."""
        return self._result("_mean", empty=np.nan)

    @property
    def variance(self) -> Array:
        """The mean square of the deviation from the mean, as `numpy.var`."""
        variance = self._result("_squares", empty=np.nan) / np.maximum(self.count, 1)
        return np.asarray(variance)

    @property
    def std(self) -> Array:
        """The square root of the variance."""
        return np.asarray(np.sqrt(self.variance))

    @property
    def minimum(self) -> Array:
        """The minimum; NaN where no value was added."""
        return self._result("_minimum")

    @property
    def maximum(self) -> Array:
        """The maximum; NaN where no value was added."""
        return self._result("_maximum")

    def _result(self, name: str, empty: float | None = None) -> Array:
        if self._count is None:
            raise ValueError("no values were added; call add first")
        array = np.array(getattr(self, name))
        return array if empty is None else np.where(self._count == 0, empty, array)

    def __repr__(self) -> str:
        if self._count is None:
            return "Moments(empty)"
        most = int(self._count.max(initial=0))
        return f"Moments(of {most}, shape {self._count.shape}, {int(self._missing.sum())} missing)"


def _of(array: Array, axis: int) -> Moments:
    """Return the moments of one array."""
    one = Moments(axis)
    known = ~np.isnan(array)
    count = known.sum(axis=axis)
    size = np.maximum(count, 1)
    with np.errstate(invalid="ignore", over="ignore"):
        mean = np.sum(array, axis=axis, where=known) / size
        apart = array - np.expand_dims(mean, axis)
        # The sum of the deviations, which rounding of the mean leaves nonzero.
        rest = np.sum(apart, axis=axis, where=known)
        one._squares = np.sum(apart * apart, axis=axis, where=known) - rest * rest / size
    one._count, one._mean, one._missing = count, mean, array.shape[axis] - count
    one._minimum = np.fmin.reduce(array, axis=axis, initial=np.nan)
    one._maximum = np.fmax.reduce(array, axis=axis, initial=np.nan)
    return one
