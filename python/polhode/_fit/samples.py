"""Measured attitudes and rates: checked times, values and standard deviations."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from polhode._algebra.constructors import as_bivectors
from polhode._algebra.interpolation import increasing_times
from polhode._algebra.rates import rates_from_attitude
from polhode._algebra.rotor import Rotor
from polhode._support.arrays import Array, as_floats, at_index, first_index

# Variance of a third difference of white noise, relative to that of the noise.
_THIRD = 20.0
# Least noise that is assumed, relative to the values: far above the rounding of the model.
_LARGEST = 1e75  # whose fourth powers floating point still holds
_LEAST = 1e-10


@dataclass(frozen=True, eq=False)
class Samples:
    """Measurements at n times: rotors, or rates (n, 3); `sigma` (n, 3) is assumed if it was not given.

    `least` is the least noise that is assumed in that case, 0 if `sigma` was given.
    """

    times: Array
    values: Any
    rates: Array
    sigma: Array
    is_known: bool
    least: float

    def __len__(self) -> int:
        return len(self.times)

    def before(self, end: float, most: int | None = None) -> Samples:
        """Return the samples up to a time, about `most` of them, equally spaced."""
        n = int(np.searchsorted(self.times, end, side="right"))
        some = slice(0, n, 1 if most is None else max(1, n // most))
        return Samples(
            self.times[some],
            self.values[some],
            self.rates[some],
            self.sigma[some],
            self.is_known,
            self.least,
        )

    def turn(self) -> Array:
        """Return the angle (n,) in rad through which the body has turned, from the first time on."""
        speed = np.linalg.norm(self.rates, axis=1)
        steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(self.times)
        return np.concatenate([[0.0], np.cumsum(steps)])


def attitudes_of(given: Any, sigma: Any) -> Samples | None:
    """Return the samples of ``attitude=(times, rotors)``."""
    if given is None:
        return None
    times, rotors = _pair(given, "attitude", "(times, rotors)")
    if not isinstance(rotors, Rotor):
        raise TypeError(
            f"attitude needs Rotors at the times, got {type(rotors).__name__}; "
            "see Rotor.from_quaternion, from_matrix, from_scipy"
        )
    if len(rotors.shape) != 1 or rotors.shape[0] < 3:
        raise ValueError(f"attitude needs rotors (n,), n >= 3, got shape {rotors.shape}")
    components = _finite(rotors.astype(float).components, "attitude")
    knots = increasing_times(times, len(components), "attitude")
    _in_range(knots, "times")
    rates = rates_from_attitude(knots, rotors).components
    steps = (rotors[1:] * ~rotors[:-1]).to_rotation_vector()
    return Samples(knots, rotors, rates, *_deviations(sigma, "sigma_attitude", steps, len(knots), 0.5))


def rates_of(given: Any, sigma: Any) -> Samples | None:
    """Return the samples of ``rates=(times, omega_body)``."""
    if given is None:
        return None
    times, omega = _pair(given, "rates", "(times, omega_body)")
    values = _finite(as_bivectors(omega, "the array of rates"), "rates")
    if values.ndim != 2 or len(values) < 3:
        raise ValueError(f"rates need angular velocities (n, 3), n >= 3, got shape {values.shape}")
    knots = increasing_times(times, len(values), "rate")
    _in_range(knots, "times")
    _in_range(values, "rates")
    return Samples(knots, values, values, *_deviations(sigma, "sigma_rates", values, len(knots), 1.0))


def _pair(given: Any, name: str, form: str) -> tuple[Any, Any]:
    if not isinstance(given, tuple | list) or len(given) != 2:
        raise TypeError(f"{name} must be a pair {form}, got {type(given).__name__}")
    return given[0], given[1]


def _finite(values: Array, name: str) -> Array:
    wrong = ~np.isfinite(values)
    if wrong.any():
        place = first_index(wrong)[:-1]
        row = values[place].tolist()
        raise ValueError(f"{name} must be finite, got {row}{at_index(place)}; remove such samples")
    return values


def _in_range(values: Array, name: str) -> None:
    """Raise a ValueError for numbers whose squares floating point cannot hold."""
    largest = np.abs(values).max(initial=0.0)
    if largest > _LARGEST or 0 < largest < 1 / _LARGEST:
        raise ValueError(f"{name} are as large as {largest:.3g}, beyond the range of a fit; check the units")


def _deviations(sigma: Any, name: str, values: Array, count: int, share: float) -> tuple[Array, bool, float]:
    """Return standard deviations (n, 3), whether they are known, and the least that is assumed.

    Without `sigma` they are those of the noise in values (m, 3): third differences of a smooth curve are
    small, so that they show the noise. `share` is the variance of a measurement relative to that of a value.
    """
    if sigma is None:
        size = float(np.sqrt(np.mean(values**2))) or 1.0
        wobble = np.diff(values, 3, axis=0) if len(values) > 3 else values
        noise = float(np.sqrt(np.mean(wobble**2) * share / _THIRD))
        least = _LEAST * size
        return np.full((count, 3), max(noise, least)), False, least
    given = as_floats(sigma, name)
    rows = given[:, np.newaxis] if given.ndim == 1 and given.shape == (count,) != (3,) else given
    try:
        result = np.array(np.broadcast_to(rows, (count, 3)))
    except ValueError:
        raise ValueError(
            f"{name} must be a number, three for the axes, or rows ({count},) or ({count}, 3), "
            f"got shape {given.shape}"
        ) from None
    wrong = ~(np.isfinite(result) & (result > 0))
    if wrong.any():
        place = first_index(wrong)
        where = at_index(place[: rows.ndim]) if rows.ndim and len(rows) == count else ""
        raise ValueError(f"{name} must be positive and finite, got {float(result[place])}{where}")
    return result, True, 0.0
