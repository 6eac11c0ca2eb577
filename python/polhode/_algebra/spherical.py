"""Directions by longitude and latitude."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from polhode._algebra.angles import in_degrees, to_degrees, to_radians
from polhode._algebra.coefficients import as_coefficients, kind_of, require_real
from polhode._algebra.constructors import one_grade, vector
from polhode._algebra.multivector import Multivector
from polhode._generic import exact
from polhode._generic.exact import Exact, by_rows
from polhode._generic.numeric import Numeric, components
from polhode._support.arrays import is_float
from polhode._support.calls import explains_calls

# Latitudes beyond a right angle by less than this are rounding of 90°.
_ROUNDING = 1e-5


@explains_calls
def direction(longitude: Any, latitude: Any, degrees: bool = False) -> Multivector:
    """Return the unit vectors ``cos β cos λ e1 + cos β sin λ e2 + sin β e3`` of a longitude λ and latitude β.

    The longitude counts from e1 towards e2, the latitude from the plane e1e2 towards e3: ecliptic longitude
    and latitude, right ascension and declination, or those of a planet, as the axes are.

    Parameters
    ----------
    longitude, latitude
        Angles (...) in radians, or degrees; batch shapes broadcast. Latitudes lie in [−π/2, π/2].

    Raises
    ------
    ValueError
        For a latitude beyond a right angle, and angles that are not finite, with the batch index.

    Examples
    --------
    The pole of Vesta, at right ascension 309.03° and declination 42.23°:

    >>> ph.direction(309.03, 42.23, degrees=True)
    0.46628327 e1 - 0.57519582 e2 + 0.67210838 e3
    """
    lon, lat = as_coefficients(longitude, "longitude"), as_coefficients(latitude, "latitude")
    if in_degrees(degrees):
        lon, lat = to_radians(lon), to_radians(lat)
    d = kind_of(lon, lat)
    if isinstance(d, Exact):
        return vector(by_rows(_exact_direction, d.stack([d.asarray(lon), d.asarray(lat)]), range(3)))
    lon, lat = d.asarray(lon), d.asarray(lat)
    d.require(d.xp.isfinite(lon), "the longitude is NaN or infinite; remove such values first")
    d.require(
        d.xp.abs(lat) <= math.pi / 2 + _ROUNDING,
        "a latitude must lie in [-90, 90] degrees, or [-π/2, π/2] rad; the longitude comes first, and angles "
        "in degrees need degrees=True",
    )
    across = d.xp.cos(lat)
    return vector(d.stack([across * d.xp.cos(lon), across * d.xp.sin(lon), d.xp.sin(lat)]))


@explains_calls
def longitude_latitude(a: Any, degrees: bool = False) -> tuple[Any, Any]:
    """Return the longitudes in [0, 2π) and latitudes in [−π/2, π/2] of vectors, as `direction` takes them.

    At the poles the longitude is 0.

    Parameters
    ----------
    a
        Vectors, or an array (..., 3); their length is ignored.

    Returns
    -------
    Two arrays (...) in radians, or degrees; floats for one vector.

    Raises
    ------
    ValueError
        For a vector that is zero or not finite, with its batch index.

    Examples
    --------
    Where the angular momentum of a tumbling body points:

    >>> body = ph.Inertia.from_principal_moments(3.09, 3.22, 1)
    >>> L = body(ph.bivector([20.7, 31.3, 98.0]))
    >>> longitude, latitude = ph.longitude_latitude(L.dual(), degrees=True)
    >>> print(longitude.round(3), latitude.round(3))
    57.599 39.385
    """
    given = one_grade(a, 1, "the direction") if isinstance(a, Multivector) else vector(a)
    require_real(given._data, "vectors")
    d = Numeric(np, given._data.dtype) if is_float(given._data) else kind_of(given._data)
    if isinstance(d, Exact):
        found = by_rows(lambda q: _exact_angles(d, q), given._data, range(2))
        lon, lat = found[..., 0], found[..., 1]
    else:
        x, y, z = components(given._data)
        size = d.length([x, y, z])
        d.require(
            (size > 0) & d.xp.isfinite(size),
            "a vector that is zero or not finite has no longitude; remove it first",
        )
        lon, lat = d.atan2(y, x), d.atan2(z, d.length([x, y]))
        lon = d.where(lon < 0, lon + 2 * math.pi, lon)
        lon = d.where(lon < 2 * math.pi, lon, 0.0)  # a sum may round to a whole turn
    lon, lat = (to_degrees(lon), to_degrees(lat)) if in_degrees(degrees) else (lon, lat)
    return tuple(x[()] if isinstance(x, np.ndarray) else x for x in (lon, lat))  # type: ignore[return-value]


def _exact_direction(angles: list[Any]) -> list[Any]:
    lon, lat = angles
    across = exact.call("cos", lat)
    return [across * exact.call("cos", lon), across * exact.call("sin", lon), exact.call("sin", lat)]


def _exact_angles(d: Exact, vector: list[Any]) -> list[Any]:
    x, y, z = vector
    across = exact.sqrt(x * x + y * y)
    if exact.is_zero(across):
        if exact.is_zero(z):
            raise ValueError("a zero vector has no longitude; remove it first")
        return [0, exact.divide(exact.pi_like(z, d.pi), 2) * (1 if z > 0 else -1)]
    lon = exact.atan2(y, x)
    if not exact.is_symbolic(lon) and lon < 0:
        lon = lon + 2 * exact.pi_like(lon, d.pi)
    return [lon, exact.atan2(z, across)]
