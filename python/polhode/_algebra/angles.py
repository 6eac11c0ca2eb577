"""Angles in radians and degrees."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from polhode._algebra.coefficients import kind_of
from polhode._generic import exact

DEGREE = math.pi / 180


def in_degrees(degrees: Any) -> bool:
    """Return whether angles are in degrees; a TypeError unless the argument is True or False, or 1 or 0.

    Functions that take less than a microsecond test for False themselves.
    """
    if degrees is True or degrees is False:
        return degrees
    if isinstance(degrees, bool | np.bool_ | int | np.integer) and degrees in (0, 1):
        return bool(degrees)
    raise TypeError(f"degrees must be True or False, got {degrees!r}")


def to_radians(angles: Any) -> Any:
    """Convert angles in degrees to radians."""
    d = kind_of(angles)
    if isinstance(d, exact.Exact):
        return np.frompyfunc(lambda x: exact.divide(x * exact.pi_like(x, d.pi), 180), 1, 1)(angles)
    return angles * DEGREE


def to_degrees(angles: Any) -> Any:
    """Convert angles in radians to degrees."""
    d = kind_of(angles)
    if isinstance(d, exact.Exact):
        return np.frompyfunc(lambda x: 180 * x / exact.pi_like(x, d.pi), 1, 1)(angles)
    return angles * (180 / math.pi)
