"""Angular velocities of a tumbling body from the periods of its light curve."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

from polhode._algebra.constructors import bivector
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.bodies import Body
from polhode._mechanics.free_motion import FreeMotion
from polhode._mechanics.inertia import Inertia
from polhode._support.arrays import Array, as_components, as_float, at_index, first_index, power_of_two
from polhode._support.calls import explains_calls

Mode = Literal["long", "short"]
# Halvings of the interval of the wobble: its angle to rounding.
_HALVINGS = 52
# Part of the interval that is left out at both ends, where the periods are not defined.
_EDGE = 1e-7


@explains_calls
def omega_from_periods(
    moments: Any, rotation_period: float, precession_period: float, *, mode: Mode
) -> Multivector:
    """Return the angular velocity with which a free body has these periods, for any number of bodies.

    A light curve of a tumbling asteroid has two periods: of the rotation about the body's own axis and of
    the precession of this axis about the angular momentum. Two periods do not determine a body: they leave
    the family of moment ratios for which the result is finite, each with one angular velocity.

    Parameters
    ----------
    moments
        Principal moments (..., 3) about e1, e2, e3 in any unit; only their ratios count.
    rotation_period
        Period in s of the angular velocity in the body, ``period`` of `FreeMotion.describe`.
    precession_period
        Mean period in s of a turn of the attitude about the angular momentum, ``precession_period`` of
        `FreeMotion.describe`.
    mode
        ``"long"``: the angular momentum circles the axis of the smallest moment in the body; ``"short"``:
        that of the largest.

    Returns
    -------
    Bivectors (...) in body axes in rad/s, at a time when the component about the middle axis is 0; NaN where
    the body has no such motion, as a ball, which does not precess. The ratio of the periods grows with the
    wobble, so that there is at most one.

    Raises
    ------
    ValueError
        If a period is not positive and finite, no body has the moments, or the mode is neither.

    Examples
    --------
    Toutatis turns about its long axis in 5.41 days, and this axis precesses in 7.35 days:

    >>> day = 86400.0
    >>> omega = ph.omega_from_periods([3.09, 3.22, 1], 5.41 * day, 7.35 * day, mode="long")
    >>> facts = ph.describe_free(ph.Inertia.from_principal_moments(3.09, 3.22, 1), omega)
    >>> round(facts["period"] / day, 3), round(facts["precession_period"] / day, 3)
    (5.41, 7.35)
    """
    if isinstance(moments, Body | Inertia):
        path = "inertia.principal_moments" if isinstance(moments, Body) else "principal_moments"
        raise TypeError(f"moments must be three numbers, got {type(moments).__name__}; give its .{path}")
    rows = as_components(moments, 3, "moments")
    periods = {"rotation_period": rotation_period, "precession_period": precession_period}
    for name, period in periods.items():
        if not 0 < as_float(period, name) < np.inf:
            raise ValueError(f"{name} must be positive and finite, got {period}")
    if mode not in ("long", "short"):
        raise ValueError(f"mode must be 'long' or 'short', got {mode!r}")
    flat = rows.reshape(-1, 3)
    _require_positive(rows)
    bodies = _bodies(flat, rows.shape[:-1])
    # Only ratios matter from here; divided by powers of two, reciprocals do not overflow.
    flat = flat / power_of_two(flat, -1)
    order = np.argsort(flat, axis=1)
    order = order if mode == "long" else order[:, ::-1]
    near, middle, far = np.take_along_axis(flat, order, axis=1).T
    # On the separatrix, 2E = L²/middle.
    with np.errstate(divide="ignore", invalid="ignore"):
        edge = np.arctan(np.sqrt(np.maximum((1 / near - 1 / middle) / (1 / middle - 1 / far), 0.0)))
    edge[near == far] = 0.0  # a ball, which rotates steadily and has no periods
    low, high = _EDGE * edge, (1 - _EDGE) * edge
    wanted = rotation_period / precession_period
    outside = ~((_ratio(bodies, flat, order, low) <= wanted) & (_ratio(bodies, flat, order, high) >= wanted))
    for _ in range(_HALVINGS):
        angle = 0.5 * (low + high)
        is_low = _ratio(bodies, flat, order, angle) < wanted
        low, high = np.where(is_low, angle, low), np.where(is_low, high, angle)
    omega = _omega(flat, order, angle)
    omega *= (_periods(bodies, omega)[0] / rotation_period)[:, np.newaxis]
    omega[outside] = np.nan
    return bivector(omega.reshape(rows.shape))


def _require_positive(rows: Array) -> None:
    """Raise a ValueError for a moment 0: a rod or a point has no motion with these periods."""
    if (rows == 0).any():
        *batch, k = first_index(rows == 0)
        raise ValueError(f"moments{at_index(tuple(batch))}: i{k + 1} is 0; all three must be positive")


def _bodies(flat: Array, shape: tuple[int, ...]) -> Any:
    """Return the inertias (n,); a ValueError with the batch index of moments that no body has."""
    found = np.empty(len(flat), dtype=object)
    for k, row in enumerate(flat.tolist()):
        try:
            found[k] = Inertia.from_principal_moments(*row)
        except ValueError as error:
            index = tuple(int(i) for i in np.unravel_index(k, shape)) if shape else ()
            raise ValueError(f"moments{at_index(index)}: {error}") from None
    return found


def _omega(flat: Array, order: Any, angle: Array) -> Array:
    """Return angular velocities (n, 3) for unit momenta at this angle from the axis that is encircled."""
    momenta = np.zeros_like(flat)
    n = np.arange(len(flat))
    momenta[n, order[:, 0]], momenta[n, order[:, 2]] = np.cos(angle), np.sin(angle)
    return momenta / flat


def _periods(bodies: Any, omega: Array) -> tuple[Array, Array]:
    """Return the periods (n,) of the angular velocity and of the precession; NaN where there is none."""
    if not len(omega):
        return np.empty(0), np.empty(0)
    found = FreeMotion(bodies, Rotor.identity(), omega).describe()
    return found["period"], found["precession_period"]


def _ratio(bodies: Any, flat: Array, order: Any, angle: Array) -> Array:
    rotation, precession = _periods(bodies, _omega(flat, order, angle))
    return np.asarray(rotation / precession)
