"""Checks of what a foreign file states of its variables: units, packing, axes and order of components."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode._report.netcdf import MOTION
from polhode._support.arrays import Array

# Dimensions of each quantity at one time, and its unit.
_STATED = {
    **{name: (dims, unit) for name, (dims, unit, _) in MOTION.items()},
    "time": ((), "s"),
    "wheel_speed": (("wheel",), "rad/s"),
}
# Attributes of CF for numbers that are not the values themselves.
_PACKED = {"scale_factor": 1.0, "add_offset": 0.0}
_ABSENT = ("_FillValue", "missing_value")
# Names of the components, which other programs can put in another order.
LABELS = {"quaternion": ["w", "x", "y", "z"], "axis": ["x", "y", "z"]}


class LabelError(ValueError):
    """A file that states another meaning of its numbers than that of a motion."""


def require_labels(name: str, variable: Any) -> None:
    """Raise a LabelError unless a variable states the unit and the axes of its quantity, or neither."""
    dims, unit = _STATED[name]
    stated = attribute(variable.attrs.get("units", unit))
    if stated != unit:
        raise LabelError(f"{name!r} has the unit {stated!r}; convert its values to {unit!r}")
    for key, neutral in _PACKED.items():
        if (value := attribute(variable.attrs.get(key, neutral))) != neutral:
            raise LabelError(f"{name!r} is packed with {key} {value}; write its values as floats")
    found = _dimensions(variable)
    if dims and "time" in found and found[-1] == "time":
        raise LabelError(
            f"{name!r} has the dimensions {', '.join(map(str, found))}; transpose it to time, {dims[0]}"
        )


def require_present(name: str, variable: Any, values: Array) -> None:
    """Raise a LabelError if values are those that the variable states for missing ones."""
    for key in _ABSENT:
        absent = attribute(variable.attrs.get(key))
        if isinstance(absent, int | float) and (at := np.argwhere(values == absent)).size:
            place = ", ".join(map(str, at[0]))
            raise LabelError(f"{name!r} has the missing value {absent} at index {place}; remove such rows")


def require_order(group: Any) -> None:
    """Raise a LabelError if a file lists the components of quaternions or vectors in another order."""
    for name, wanted in LABELS.items():
        if name not in group or getattr(group[name], "shape", None) != (len(wanted),):
            continue
        found = _texts(group[name])
        if found and found != wanted:
            raise LabelError(
                f"{name!r} has the order {', '.join(found)}; reorder the components to {', '.join(wanted)}"
            )


def attribute(x: Any) -> Any:
    """Return an attribute; numbers are arrays of one element in the file, and texts may be bytes."""
    if isinstance(x, bytes):
        return x.decode()
    return x.item() if isinstance(x, np.ndarray | np.generic) and x.size == 1 else x


def _dimensions(variable: Any) -> list[Any]:
    """Return the names of the dimensions of a variable, as far as they are known."""
    if not hasattr(variable, "dims"):  # of a Zarr store
        names = getattr(variable.metadata, "dimension_names", None)
        return list(names or variable.attrs.get("_ARRAY_DIMENSIONS", ()))
    return [(dim[0].name or "").removeprefix("/") if len(dim) else "" for dim in variable.dims]


def _texts(variable: Any) -> list[str]:
    """Return texts; none if the variable has numbers."""
    values = variable[...].tolist()
    texts = [x.decode() if isinstance(x, bytes) else x for x in values]
    return texts if all(isinstance(x, str) for x in texts) else []
