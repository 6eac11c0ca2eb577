"""Reading of motions from netCDF files, with checks of foreign files."""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from polhode._algebra.constructors import bivector, vector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.result import Certificate, Crossings
from polhode._mechanics.trajectory import Trajectory
from polhode._report.hdf5_heaps import require_sound_heaps
from polhode._report.netcdf import CF, MOTION
from polhode._report.netcdf_labels import (
    LabelError,
    attribute,
    require_labels,
    require_order,
    require_present,
)
from polhode._support import memory
from polhode._support.arrays import Array
from polhode._support.extras import optional

# Numbers in a dimension of a quantity.
_SIZES = {"quaternion": 4, "axis": 3, "inertia_column": 3}
# Deflate, which compresses best, makes a variable at most this many times smaller.
_DEFLATED = 1100
_SMALL = 1 << 26  # bytes

# Largest deviation of the norm of a quaternion from 1; numbers in files may have few digits.
_OFF = 1e-3

# Libraries raise any of these for a damaged file or store.
DAMAGED = (OSError, RuntimeError, LookupError, MemoryError, TypeError, ValueError)
# Foreign files may have any size: nothing else is read.
_READ = {"time", "wheel_speed", *MOTION}
# Attributes that polhode or the library writes; all others are the user's.
OWN = {
    *(
        "Conventions",
        "conventions",
        "source",
        "method",
        "step_s",
        "steps",
        "evaluations",
        "conserved",
        "drift",
    ),
    *("error_estimate", "warnings", "_NCProperties"),
}


def read(path: str | os.PathLike[str]) -> Trajectory:
    """Return the motion in a netCDF file, as `Trajectory.read`."""
    fields, attributes = content(path)
    if "attitude" in fields and "inertia" not in fields:
        raise ValueError(
            f"{path}: has no inertia, which a motion needs: it is a table of attitudes, as of a CSV or AEM "
            f"file; polhode convert {path} FILE.nc --scene SCENE.toml writes the motion of the scene's body"
        )
    try:
        parts = {name: fields[name] for name in MOTION if name != "inertia"}
        require_shapes(fields["time"], parts)
        _require_states(fields["time"], parts)
        return Trajectory(
            fields["time"],
            _rotors(fields["attitude"]),
            bivector(fields["omega_body"]),
            bivector(fields["momentum_space"]),
            fields["energy"],
            vector(fields["position"]),
            vector(fields["velocity"]),
            Inertia.from_matrix(fields["inertia"]),
            _certificate(attributes),
            _crossings(fields),
            attributes=of_user(attributes),
            _speeds=_speeds(fields),
        )
    except KeyError as error:
        raise ValueError(f"{path}: is not a motion that polhode wrote: {error} is missing") from None
    except (IndexError, TypeError, ValueError) as error:
        raise ValueError(f"{path}: is not a motion that polhode wrote: {error}") from error


def of_user(attributes: dict[str, Any]) -> dict[str, Any]:
    """Return the attributes of a file that polhode does not write, such as a title that the motion had."""
    return {
        name: x
        for name, x in attributes.items()
        if name not in OWN
        and not (name == "title" and str(x) == CF["title"])
        and not (name == "history" and re.fullmatch("written by polhode .*", str(x)))
    }


def require_shapes(time: Array, parts: Mapping[str, Array]) -> None:
    """Raise a ValueError unless the times are a row, and each quantity has a row for each time."""
    if time.ndim != 1:
        raise ValueError(f"time must have shape (n,), got {time.shape}")
    for name, x in parts.items():
        expected = (len(time), *shape_of(name))
        if x.shape != expected:
            raise ValueError(f"{name} must have shape {expected}, a row for each time, got {x.shape}")


def not_unit(quaternions: Array) -> tuple[int, float] | None:
    """Return the first row of quaternions whose norm is not 1, and the norm; None if there is none."""
    with np.errstate(over="ignore"):  # an infinite norm is not 1
        norms = np.linalg.norm(quaternions, axis=-1)
    wrong = np.flatnonzero(~(np.abs(norms - 1) < _OFF))
    return (int(wrong[0]), float(norms[wrong[0]])) if len(wrong) else None


def _require_states(time: Array, parts: Mapping[str, Array]) -> None:
    """Raise a ValueError unless times increase, all numbers are finite and the attitudes are rotations."""
    for name, x in {"time": time, **parts}.items():
        if len(odd := np.argwhere(~np.isfinite(x))):
            raise ValueError(f"{name} must be finite, got {x[tuple(odd[0])]} at row {odd[0][0]}")
    if len(fallen := np.flatnonzero(np.diff(time) <= 0)):
        k = int(fallen[0]) + 1
        raise ValueError(f"times must increase, got {time[k]} s after {time[k - 1]} s at row {k}")
    if wrong := not_unit(parts["attitude"]):
        raise ValueError(f"attitude must be unit quaternions, got norm {wrong[1]:.6g} at row {wrong[0]}")


def _speeds(fields: Mapping[str, Any]) -> Array | None:
    """Return the speeds of wheels (n, k); None without wheels."""
    if "wheel_speed" not in fields:
        return None
    found = np.asarray(fields["wheel_speed"], float)
    if found.ndim != 2 or len(found) != len(fields["time"]):
        raise ValueError(
            f"wheel_speed must have shape ({len(fields['time'])}, k), a row for each time, got {found.shape}"
        )
    if len(odd := np.argwhere(~np.isfinite(found))):
        raise ValueError(f"wheel_speed must be finite, got {found[tuple(odd[0])]} at row {odd[0][0]}")
    return found


def shape_of(name: str) -> tuple[int, ...]:
    """Return the shape of a quantity at one time."""
    return tuple(_SIZES[dim] for dim in MOTION[name][0])


def values(name: str, variable: Any, body: int | None = None) -> Any:
    """Return the values of a variable of an HDF5 file or a Zarr store, or those of one body.

    A ValueError if these are not real numbers, but for the variables of events; if the file states another
    unit, or values that are missing or packed; if it declares values that it does not hold, which could fill
    any memory; and if there is no such body. A MemoryError if the values do not fit into memory.
    """
    if not hasattr(variable, "dtype"):
        raise ValueError(f"{name!r} is not a variable")
    if name in _READ and variable.dtype.kind not in "fiu":
        raise ValueError(f"{name!r} must hold real numbers, got the type {variable.dtype}")
    if name in _READ:
        require_labels(name, variable)
    if body is not None and not body < (variable.shape or (0,))[0]:
        raise ValueError(f"{name!r} has no values of body {body}, got the shape {variable.shape}")
    size = variable.dtype.itemsize * math.prod(variable.shape if body is None else variable.shape[1:])
    memory.require(size, f"the values of {name!r}")
    if hasattr(variable, "id") and size > max(_SMALL, _DEFLATED * variable.id.get_storage_size()):
        raise ValueError(
            f"{name!r} has the shape {variable.shape}, but its values are missing; write the file again"
        )
    if variable.dtype.kind == "O":
        return variable.asstr()[...]
    found = variable[...] if body is None else variable[body]
    if name not in _READ:
        return found
    require_present(name, variable, found)
    return np.asarray(found, float)


def content(path: str | os.PathLike[str]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the arrays and the attributes of a file."""
    library = optional("h5py", "io", "a netCDF file")
    if not os.path.lexists(path):
        raise FileNotFoundError(f"{path}: no such file")
    if not os.path.isfile(path):
        raise OSError(f"{path}: not a regular file")
    if not os.access(path, os.R_OK):
        raise PermissionError(f"{os.fsdecode(path)}: no permission to read it")
    try:
        require_sound_heaps(path)
        with library.File(path, "r") as file:
            attributes = {name: attribute(x) for name, x in file.attrs.items()}
            require_order(file)
            many = "batch_shape" in attributes or "body" in file
            names = [] if many else [name for name in file if name in _READ or name.startswith("event_")]
            fields = {name: values(name, file[name]) for name in names}
    except LabelError as error:
        raise LabelError(f"{path}: {error}") from None
    except DAMAGED as error:
        others = os.fsdecode(path).lower().endswith((".csv", ".parquet", ".aem", ".bc"))
        remedy = "; use polhode.io.read" if others else ""
        raise OSError(f"{path}: cannot be read as a netCDF file: {error}{remedy}") from error
    if many:
        raise ValueError(
            f"{path}: holds a batch of bodies; read it with xarray.open_dataset, or take one body: "
            f"polhode convert {path} one.nc --body 0"
        )
    return fields, attributes


def _rotors(quaternions: Any) -> Any:
    """Return the rotors of quaternions wxyz: three signs change, without rounding."""
    return Rotor._from_rows(np.ascontiguousarray(quaternions * [1.0, -1.0, -1.0, -1.0]))


def _certificate(attributes: dict[str, Any]) -> Any:
    drift, conserved = (_object(attributes, name) for name in ("drift", "conserved"))
    norm_drift = drift.pop("rotor_norm")
    return Certificate(
        attributes["method"],
        attributes["step_s"],
        attributes["steps"],
        attributes.get("evaluations"),
        attributes.get("error_estimate"),
        conserved,
        drift,
        norm_drift,
        tuple(json.loads(attributes.get("warnings", "[]"))),
    )


def _object(attributes: dict[str, Any], name: str) -> dict[str, float]:
    found = json.loads(attributes[name])
    if not isinstance(found, dict) or not all(isinstance(x, int | float) for x in found.values()):
        raise ValueError(f"the attribute {name!r} must be numbers by name, as JSON, got {attributes[name]!r}")
    return found


def _crossings(fields: dict[str, Any]) -> tuple[Crossings, ...]:
    """Return the events, grouped by name."""
    if "event_name" not in fields:
        return ()
    names = fields["event_name"]
    rows = [(name, names == name) for name in dict.fromkeys(names)]
    return tuple(
        Crossings(
            name,
            fields["event_time"][at],
            fields["event_rising"][at].astype(bool),
            _rotors(fields["event_attitude"][at]),
            bivector(fields["event_omega_body"][at]),
            vector(fields["event_position"][at]),
            vector(fields["event_velocity"][at]),
        )
        for name, at in rows
    )
