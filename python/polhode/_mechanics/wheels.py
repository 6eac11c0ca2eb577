"""Arguments of reaction wheels."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode._algebra.constructors import as_bivectors, as_vectors
from polhode._mechanics.parameters import check_finite
from polhode._support.arrays import Array, as_floats

Rows = tuple[tuple[float, ...], ...]


def wheel_arguments(
    axes: Any,
    inertias: Any,
    torques: Any,
    times: Any,
    speeds: Any,
    omega_body: Any,
    max_torque: Any,
    max_speed: Any,
) -> tuple[Any, ...]:
    """Return the arguments of `polhode.torque.reaction_wheels`, checked, in the order of the core."""
    rows = as_vectors(axes, "axes")
    if rows.ndim != 2 or not len(rows):
        raise ValueError(f"axes needs a vector for each wheel, of shape (k, 3), got shape {rows.shape}")
    check_finite(rows, "an axis")
    for k, row in enumerate(rows.tolist()):
        if not any(row):
            raise ValueError(f"axes[{k}] is zero; it must be a direction")
    count = len(rows)
    when = as_floats(0.0 if times is None else times, "times").reshape(
        -1 if times is None else np.shape(times)
    )
    if when.ndim != 1 or not when.size:
        raise ValueError(f"times must have shape (n,), got {when.shape}")
    check_finite(when[:, np.newaxis], "a time of times")
    return (
        tuple(map(tuple, rows.tolist())),
        _each(inertias, "inertias", count, positive=True),
        _each(max_torque, "max_torque", count, positive=True, infinite=True),
        _each(max_speed, "max_speed", count, positive=True, infinite=True),
        _each(speeds, "speeds", count),
        _omega(omega_body),
        tuple(when.tolist()),
        _commands(torques, None if times is None else when.size, count),
    )


def _each(
    value: Any, name: str, count: int, *, positive: bool = False, infinite: bool = False
) -> tuple[float, ...]:
    """Return a number for each wheel."""
    array = as_floats(value, name)
    if array.shape not in ((), (count,)):
        raise ValueError(
            f"{name} must be a number or of shape ({count},), one for each wheel, got {array.shape}"
        )
    numbers: list[float] = np.broadcast_to(array, (count,)).tolist()
    for k, x in enumerate(numbers):
        place = f"{name}[{k}]" if array.ndim else name
        if not np.isfinite(x) and not (infinite and x == np.inf):
            raise ValueError(f"{place} is {x}; it must be finite")
        if positive and not x > 0:
            raise ValueError(f"{place} is {x}; it must be positive")
    return tuple(numbers)


def _omega(omega_body: Any) -> tuple[float, ...]:
    if omega_body is None:
        return (0.0, 0.0, 0.0)
    row = as_bivectors(omega_body, "omega_body")
    if row.shape != (3,):
        raise ValueError(f"omega_body must be a single bivector, got shape {row.shape}")
    check_finite(row, "omega_body")
    return tuple(row.tolist())


def _commands(torques: Any, times: int | None, count: int) -> Rows:
    """Return a row of torques for each time."""
    array = as_floats(torques, "torques")
    wanted: tuple[tuple[int, ...], ...] = ((), (count,)) if times is None else ((times, count),)
    if array.shape not in wanted:
        raise ValueError(
            f"torques must be a number or of shape ({count},) without times, got shape {array.shape}"
            if times is None
            else f"torques must be of shape ({times}, {count}), a row for each time, got {array.shape}"
        )
    rows: Array = np.broadcast_to(array, (times or 1, count))
    check_finite(rows, "a row of torques")
    return tuple(map(tuple, rows.tolist()))
