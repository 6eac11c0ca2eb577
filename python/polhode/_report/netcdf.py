"""Trajectories as xarray datasets, and netCDF files."""

from __future__ import annotations

import io
import json
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _native
from polhode._mechanics.inertia import matrices
from polhode._mechanics.result import Crossings
from polhode._mechanics.trajectory import Trajectory
from polhode._report.summary import QUANTITIES
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
        variables[name] = quantity(name, ("body", "time") if shape else ("time",), flat)
    speeds = trajectory.wheel_speed
    if speeds.shape[-1]:
        flat = speeds.reshape(count, *speeds.shape[-2:]) if shape else speeds
        variables["wheel_speed"] = wheels_of(("body", "time") if shape else ("time",), flat)
    if isinstance(trajectory.inertia, np.ndarray):
        variables["inertia"] = quantity("inertia", ("body",), matrices(trajectory.inertia.flat))
    else:
        variables["inertia"] = quantity("inertia", (), trajectory.inertia.matrix)
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


def quantity(name: str, over: tuple[str, ...], data: Any) -> Any:
    """Return the variable of a quantity of `MOTION`, with dimensions `over` before its own."""
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
            f"event_{name}": quantity(name, along, np.concatenate([components(x, name) for x in events]))
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
