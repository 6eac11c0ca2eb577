"""`Moments`: running mean, variance and extremes of blocks of numbers, which are not kept."""

from __future__ import annotations

import operator
from typing import Any, NamedTuple

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

    Examples
    --------
    The arrays are not kept; NaN is only counted:

    >>> found = ph.Moments()
    >>> _ = found.add([1, 2, 3]).add([4, 5, np.nan])
    >>> float(found.mean), float(found.variance), int(found.missing)
    (3.0, 2.0, 1)

    The mean over bodies at each time:

    >>> rates = [[0, 1, 2], [0, 3, 6]]  # of two bodies at three times
    >>> ph.Moments().add(rates).mean
    array([0., 2., 4.])
    """

    __slots__ = ("_axis", "_found")
    _found: _Found | None

    def __init__(self, axis: int = 0) -> None:
        self._axis, self._found = operator.index(axis), None

    def add(self, values: Any) -> Moments:
        """Add values, an array or a multivector (its components), and return self.

        A ValueError if the shape without the axis differs from that of the values added before.

        Examples
        --------
        >>> float(ph.Moments().add([1, 2]).add([6]).mean)
        3.0
        """
        array = as_floats(values._data if isinstance(values, Multivector) else values, "values")
        if not -array.ndim <= self._axis < array.ndim:
            raise ValueError(f"values of shape {array.shape} have no axis {self._axis}")
        self._found = _merged(self._found, _of(array, self._axis))
        return self

    def __add__(self, other: Moments) -> Moments:
        if not isinstance(other, Moments):
            return NotImplemented
        both = Moments(self._axis)
        both._found = _merged(self._found, other._found)
        return both

    @property
    def count(self) -> Array:
        """Number of values added, without NaN."""
        return np.array(self._known().number)

    @property
    def missing(self) -> Array:
        """Number of NaN values."""
        return np.array(self._known().missing)

    @property
    def mean(self) -> Array:
        """The mean; NaN where no value was added."""
        found = self._known()
        return np.where(found.number == 0, np.nan, found.mean)

    @property
    def variance(self) -> Array:
        """The mean square of the deviation from the mean, as `numpy.var`."""
        found = self._known()
        squares = np.where(found.number == 0, np.nan, found.squares)
        return np.asarray(squares / np.maximum(found.number, 1))

    @property
    def std(self) -> Array:
        """The square root of the variance."""
        return np.asarray(np.sqrt(self.variance))

    @property
    def minimum(self) -> Array:
        """The minimum; NaN where no value was added."""
        return np.array(self._known().minimum)

    @property
    def maximum(self) -> Array:
        """The maximum; NaN where no value was added."""
        return np.array(self._known().maximum)

    def _known(self) -> _Found:
        if self._found is None:
            raise ValueError("no values were added; call add first")
        return self._found

    def __repr__(self) -> str:
        if self._found is None:
            return "Moments(empty)"
        count, missing = self._found.number, int(self._found.missing.sum())
        return f"Moments(of {int(count.max(initial=0))}, shape {count.shape}, {missing} missing)"


class _Found(NamedTuple):
    """Moments of the values so far; `squares` is the sum of the squared deviations from the mean."""

    number: Array
    missing: Array
    mean: Array
    squares: Array
    minimum: Array
    maximum: Array


def _merged(a: _Found | None, b: _Found | None) -> _Found | None:
    if a is None or b is None:
        return b if a is None else a
    if a.number.shape != b.number.shape:
        raise ValueError(f"cannot merge moments of shape {b.number.shape} into shape {a.number.shape}")
    # Chan: M2 = M2a + M2b + δ² na nb / n, δ the difference of the means.
    count = a.number + b.number
    share = b.number / np.maximum(count, 1)
    with np.errstate(invalid="ignore", over="ignore"):  # infinite values have no deviation
        change = b.mean - a.mean
        squares = a.squares + b.squares + change * change * a.number * share
        mean = np.where(share == 1, b.mean, a.mean + change * share)
        mean = np.where(np.isfinite(change), mean, a.mean * (1 - share) + b.mean * share)
    extremes = np.fmin(a.minimum, b.minimum), np.fmax(a.maximum, b.maximum)
    return _Found(count, a.missing + b.missing, mean, squares, *extremes)


def _of(array: Array, axis: int) -> _Found:
    known = ~np.isnan(array)
    count = known.sum(axis=axis)
    size = np.maximum(count, 1)
    with np.errstate(invalid="ignore", over="ignore"):
        mean = np.sum(array, axis=axis, where=known) / size
        apart = array - np.expand_dims(mean, axis)
        # The sum of the deviations, which rounding of the mean leaves nonzero.
        rest = np.sum(apart, axis=axis, where=known)
        squares = np.sum(apart * apart, axis=axis, where=known) - rest * rest / size
    extremes = (f.reduce(array, axis=axis, initial=np.nan) for f in (np.fmin, np.fmax))
    return _Found(count, array.shape[axis] - count, mean, squares, *extremes)
