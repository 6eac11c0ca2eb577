"""Trajectories as xarray datasets, and netCDF files."""

from __future__ import annotations

import io
import json
import math
import os
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _native
from polhode._algebra.constructors import bivector, vector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.inertia import Inertia, matrices
from polhode._mechanics.result import Certificate, Crossings
from polhode._mechanics.trajectory import Trajectory
from polhode._report.summary import QUANTITIES
from polhode._support import memory
from polhode._support.arrays import Array
from polhode._support.extras import optional

if TYPE_CHECKING:
    import xarray

CONVENTIONS = (
    "Right-handed e1, e2, e3; I = e1e2e3. Rotor R = exp(-B theta/2) turns body axes to space axes, "
    "actively: a_space = R a_body ~R. Quaternion [w, x, y, z] is Hamilton's and active; "
    "R = w - x e2e3 - y e3e1 - z e1e2. Bivectors (angular velocity, angular momentum) are given by the "
    "components of their axial vectors, "
    "(e2e3, e3e1, e1e2) = (x, y, z). R' = -1/2 Omega_space R = -1/2 R Omega_body. "
    "omega_body is in body axes, momentum_space in space axes."
)


# Global attributes of the CF conventions, where a motion has none of these names. Without dates, so that the
# file of a motion is always the same.
CF = {
    "Conventions": "CF-1.11",
    "title": "Motion of a rigid body",
    "history": f"written by polhode {_native.__version__}",
}

# Dimensions, unit and description of the quantities of a motion.
MOTION: dict[str, tuple[tuple[str, ...], str, str]] = {
    "attitude": (("quaternion",), "1", "attitude, body to space"),
    "omega_body": (("axis",), "rad/s", "angular velocity in body axes"),
    "momentum_space": (("axis",), "kg m^2/s", "angular momentum in space axes"),
    "position": (("axis",), "m", "centre of mass in space"),
    "velocity": (("axis",), "m/s", "velocity of the centre of mass"),
    "energy": ((), "J", "rotational kinetic and potential energy"),
    "inertia": (("axis", "inertia_column"), "kg m^2", "inertia matrix in body axes"),
}

# Numbers in a dimension of a quantity.
_SIZES = {"quaternion": 4, "axis": 3, "inertia_column": 3}
# Deflate, which compresses best, makes a variable at most this many times smaller.
_DEFLATED = 1100
_SMALL = 1 << 26  # bytes

# Powers in units, as UDUNITS reads them.
_POWERS = str.maketrans({"²": "^2", "³": "^3", "⁴": "^4"})


def components(states: Trajectory | Crossings, name: str) -> Array:
    """Return the components (..., m) of a quantity of states."""
    if name == "attitude":
        return np.asarray(states.rotor.to_quaternion(order="wxyz"))
    x = getattr(states, name)
    return np.asarray(getattr(x, "_data", x))


def to_xarray(trajectory: Trajectory) -> xarray.Dataset:
    """Return a dataset with dimensions time, quaternion and axis, units and conventions.

    A batch has the first dimension `body`, its batch axes flattened.
    """
    xr = optional("xarray", "io", "labelled data")
    shape, count = trajectory.shape, math.prod(trajectory.shape)
    variables = {}
    for name in list(MOTION)[:-1]:
        values = components(trajectory, name)
        flat = values.reshape(count, *values.shape[len(shape) :]) if shape else values
        variables[name] = _quantity(name, ("body", "time") if shape else ("time",), flat)
    speeds = trajectory.wheel_speed
    if speeds.shape[-1]:
        flat = speeds.reshape(count, *speeds.shape[-2:]) if shape else speeds
        variables["wheel_speed"] = wheels_of(("body", "time") if shape else ("time",), flat)
    if isinstance(trajectory.inertia, np.ndarray):
        variables["inertia"] = _quantity("inertia", ("body",), matrices(trajectory.inertia.flat))
    else:
        variables["inertia"] = _quantity("inertia", (), trajectory.inertia.matrix)
    coordinates = _coordinates(trajectory.time)
    if trajectory.events:
        variables |= _events(trajectory.events)
    if shape:
        coordinates["body"] = np.arange(count)
        variables |= _bodies(trajectory)
    dataset: xarray.Dataset = xr.Dataset(variables, coordinates, CF | attributes_of(trajectory))
    return dataset


def wheels_of(over: tuple[str, ...], speeds: Any) -> Any:
    """Return the variable of the speeds of reaction wheels."""
    return _variable((*over, "wheel"), speeds, "rad/s", "speed of reaction wheels relative to the body")


def _coordinates(time: Any) -> dict[str, Any]:
    return {
        "time": ("time", time, {"units": "s", "long_name": "time", "axis": "T"}),
        "quaternion": ["w", "x", "y", "z"],
        "axis": ["x", "y", "z"],
        "inertia_column": ["x", "y", "z"],
    }


def _variable(dims: tuple[str, ...], data: Any, units: str, text: str) -> Any:
    return (dims, np.array(data), {"units": units, "long_name": text})


def _quantity(name: str, over: tuple[str, ...], data: Any) -> Any:
    dims, units, text = MOTION[name]
    return _variable((*over, *dims), data, units, text)


def _bodies(trajectory: Trajectory) -> dict[str, Any]:
    """Return certificate and failure of each body of a batch."""
    proof = trajectory.certificate
    failed = np.full(trajectory.shape, np.nan)
    messages = np.full(trajectory.shape, "", dtype=object)
    for failure in trajectory.failures:
        failed[failure.index], messages[failure.index] = failure.time, failure.message
    columns: dict[str, tuple[Any, str, str]] = {
        "step": (proof.step, "s", "longest step"),
        "steps": (proof.steps, "1", "steps of all passes"),
        "evaluations": (proof.evaluations, "1", "evaluations of the torque"),
        "error_estimate": (proof.error_estimate, "1", "estimate of the relative error"),
        "rotor_norm_drift": (proof.norm_drift, "1", "largest abs(|R| - 1)"),
        "failure_time": (failed, "s", "time up to which a failed body was computed"),
    }
    for name, start in proof.conserved.items():
        unit = QUANTITIES[name][1].translate(_POWERS)
        columns[f"{name}_start"] = (start, unit, f"{name} at the start")
        columns[f"{name}_drift"] = (proof.drift[name], "1", f"largest relative change of the {name}")
    texts = {"failure": (messages, "error of a failed body")}
    if not isinstance(proof.method, str):
        texts["method"] = (proof.method.astype(object), "method")
    along = ("body",)
    return {
        **{name: _variable(along, np.ravel(x), units, text) for name, (x, units, text) in columns.items()},
        **{name: (along, x.ravel(), {"long_name": text}) for name, (x, text) in texts.items()},
    }


def _events(events: tuple[Crossings, ...]) -> dict[str, Any]:
    """Return all events in one dimension."""
    along = ("event",)
    names = np.array([event.name for event in events for _ in event.time], dtype=object)
    times, rising = (
        np.concatenate([getattr(event, name) for event in events]) for name in ("time", "rising")
    )
    return {
        "event_name": (along, names, {"long_name": "name of the event"}),
        "event_time": _variable(along, times, "s", "time of the event"),
        "event_rising": _variable(along, rising, "1", "whether the event function was rising"),
        **{
            f"event_{name}": _quantity(name, along, np.concatenate([components(x, name) for x in events]))
            for name in ("attitude", "omega_body", "position", "velocity")
        },
    }


def require_libraries() -> None:
    """Raise an ImportError if libraries for netCDF files are missing."""
    optional("xarray", "io", "labelled data")
    optional("h5netcdf", "io", "a netCDF file")


def netcdf(trajectory: Trajectory) -> bytes:
    """Return the content of a netCDF4 file."""
    require_libraries()
    return _bytes_of(to_xarray(trajectory))


def encoded(time: Any, variables: dict[str, Any], attributes: dict[str, Any]) -> bytes:
    """Return the content of a netCDF4 file of some quantities of a motion."""
    xr = optional("xarray", "io", "labelled data")
    used = {dim for dims, *_ in variables.values() for dim in dims}
    coordinates = {name: x for name, x in _coordinates(time).items() if name in used}
    return _bytes_of(xr.Dataset(variables, coordinates, CF | attributes))


def of_fixed_size(attributes: Mapping[str, Any]) -> dict[str, Any]:
    """Return attributes with texts as the fixed-size strings of netCDF-C.

    The strings of variable size that h5netcdf writes lie in a heap of the file, and HDF5 2.0.0 searches some
    damaged heaps without end.
    """
    library = optional("h5py", "io", "a netCDF file")

    def fixed(text: str) -> Any:
        # With a null at the end: readers take one byte alone for a character, not for a text.
        content = text.encode()
        return np.array(content, library.string_dtype("utf-8", len(content) + 1))

    return {name: fixed(x) if isinstance(x, str) else x for name, x in attributes.items()}


def _bytes_of(dataset: xarray.Dataset) -> bytes:
    buffer = io.BytesIO()
    dataset = dataset.assign_attrs(of_fixed_size(dataset.attrs))
    dataset.to_netcdf(buffer, engine="h5netcdf", encoding={"time": {"_FillValue": None}})
    return buffer.getvalue()


def origin() -> dict[str, Any]:
    """Return the attributes that any file of a motion has."""
    return {"conventions": CONVENTIONS, "source": f"polhode {_native.__version__}"}


def attributes_of(trajectory: Trajectory) -> dict[str, Any]:
    """Return attributes: flat text and numbers, which every netCDF reader shows."""
    proof = trajectory.certificate
    attributes = origin()
    if isinstance(proof.method, str):
        attributes["method"] = proof.method
    if trajectory.shape:
        attributes["batch_shape"] = list(trajectory.shape)
    else:
        attributes |= {
            "step_s": proof.step,
            "steps": proof.steps,
            "evaluations": proof.evaluations,
            "conserved": json.dumps(proof.conserved),
            "drift": json.dumps({**proof.drift, "rotor_norm": proof.norm_drift}),
        }
        if proof.error_estimate is not None:
            attributes["error_estimate"] = proof.error_estimate
        if proof.warnings:
            attributes["warnings"] = json.dumps(list(proof.warnings))
    return {**attributes, **trajectory.attributes}


# --- reading

# Libraries raise any of these for a damaged file or store.
DAMAGED = (OSError, RuntimeError, LookupError, MemoryError, TypeError, ValueError)
# Foreign files may have any size: nothing else is read.
_READ = {"time", "wheel_speed", *MOTION}
# Attributes written here or by the library; all others are the user's.
_OWN = {
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
    fields, attributes = _content(path)
    if "attitude" in fields and "inertia" not in fields:
        raise ValueError(
            f"{path} has no inertia, which a motion needs: it is a table of attitudes, as of a CSV or AEM "
            f"file; ph.io.read_netcdf({os.fspath(path)!r}).trajectory(body).save('FILE.nc') writes a motion "
            "of a body"
        )
    try:
        require_shapes(fields["time"], {name: fields[name] for name in MOTION if name != "inertia"})
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
        )
    except KeyError as error:
        raise ValueError(f"{path} is not a motion that polhode wrote: {error} is missing") from None
    except (IndexError, TypeError, ValueError) as error:
        raise ValueError(f"{path} is not a motion that polhode wrote: {error}") from error


def of_user(attributes: dict[str, Any]) -> dict[str, Any]:
    """Return the attributes of a file that are not written here, such as a title that the motion had."""
    return {
        name: x
        for name, x in attributes.items()
        if name not in _OWN
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


def shape_of(name: str) -> tuple[int, ...]:
    """Return the shape of a quantity at one time."""
    return tuple(_SIZES[dim] for dim in MOTION[name][0])


def values(name: str, variable: Any, body: int | None = None) -> Any:
    """Return the values of a variable of an HDF5 file or a Zarr store, or those of one body.

    A ValueError if these are not real numbers, but for the variables of events; if the file declares values
    that it does not hold, which could fill any memory; and if there is no such body. A MemoryError if the
    values do not fit into memory.
    """
    if not hasattr(variable, "dtype"):
        raise ValueError(f"{name!r} is not a variable")
    if name in _READ and variable.dtype.kind not in "fiu":
        raise ValueError(f"{name!r} must hold real numbers, got the type {variable.dtype}")
    if body is not None and not body < (variable.shape or (0,))[0]:
        raise ValueError(f"{name!r} has no values of body {body}, got the shape {variable.shape}")
    size = variable.dtype.itemsize * math.prod(variable.shape if body is None else variable.shape[1:])
    memory.require(size, f"the values of {name!r}")
    if hasattr(variable, "id") and size > max(_SMALL, _DEFLATED * variable.id.get_storage_size()):
        raise ValueError(
            f"{name!r} has the shape {variable.shape}, but its values are missing; write the file again"
        )
    if body is not None:
        return variable[body]
    return variable.asstr()[...] if variable.dtype.kind == "O" else variable[...]


def _content(path: str | os.PathLike[str]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the arrays and the attributes of a file."""
    library = optional("h5py", "io", "a netCDF file")
    if not os.path.exists(path):
        raise FileNotFoundError(f"{path}: no such file")
    if not os.path.isfile(path):
        raise OSError(f"{path}: not a regular file")
    if not os.access(path, os.R_OK):
        raise PermissionError(f"{os.fsdecode(path)}: no permission to read it")
    try:
        with library.File(path, "r") as file:
            attributes = {name: attribute(x) for name, x in file.attrs.items()}
            many = "batch_shape" in attributes or "body" in file
            names = [] if many else [name for name in file if name in _READ or name.startswith("event_")]
            fields = {name: values(name, file[name]) for name in names}
    except DAMAGED as error:
        others = os.fsdecode(path).lower().endswith((".csv", ".parquet", ".aem", ".bc"))
        remedy = "; use polhode.io.read" if others else ""
        raise OSError(f"{path} cannot be read as a netCDF file: {error}{remedy}") from error
    if many:
        raise ValueError(
            f"{path} holds a batch of bodies; read it with xarray.open_dataset, or take one body: "
            f"polhode convert {path} one.nc --body 0"
        )
    return fields, attributes


def attribute(x: Any) -> Any:
    """Return an attribute; numbers are arrays of one element in the file, and texts may be bytes."""
    if isinstance(x, bytes):
        return x.decode()
    return x.item() if isinstance(x, np.ndarray) and x.size == 1 else x


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
