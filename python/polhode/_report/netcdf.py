"""Trajectories as xarray datasets, and netCDF files."""

from __future__ import annotations

import io
import json
import math
import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _native
from polhode._support.extras import optional

if TYPE_CHECKING:
    import xarray

    from polhode._mechanics.result import Crossings
    from polhode._mechanics.trajectory import Trajectory

CONVENTIONS = (
    "Right-handed e1, e2, e3; I = e1e2e3. Rotor R = exp(-B theta/2) turns body axes to space axes, "
    "actively: a_space = R a_body ~R. Quaternion [w, x, y, z] is Hamilton's and active; "
    "R = w - x e2e3 - y e3e1 - z e1e2. Bivectors (angular velocity, angular momentum) are given by the "
    "components of their axial vectors, "
    "(e2e3, e3e1, e1e2) = (x, y, z). R' = -1/2 Omega_space R = -1/2 R Omega_body. "
    "omega_body is in body axes, momentum_space in space axes."
)


def to_xarray(trajectory: Trajectory) -> xarray.Dataset:
    """Return a dataset with dimensions time, quaternion and axis, units and conventions.

    A batch has the first dimension `body`, its batch axes flattened.
    """
    xr = optional("xarray", "io", "labelled data")
    body = ("body",) if trajectory.shape else ()
    count = math.prod(trajectory.shape)

    def variable(dims: tuple[str, ...], data: Any, units: str, text: str) -> Any:
        return (dims, np.array(data), {"units": units, "long_name": text})

    def moving(dims: tuple[str, ...], data: Any, units: str, text: str) -> Any:
        array = np.asarray(data)
        flat = array.reshape(count, *array.shape[len(trajectory.shape) :]) if body else array
        return variable((*body, "time", *dims), flat, units, text)

    along, axes = (), ("axis",)
    omega, momentum = trajectory.omega_body._data, trajectory.momentum_space._data
    variables = {
        "attitude": moving(
            ("quaternion",), trajectory.rotor.to_quaternion(order="wxyz"), "1", "attitude, body to space"
        ),
        "omega_body": moving(axes, omega, "rad/s", "angular velocity in body axes"),
        "momentum_space": moving(axes, momentum, "kg m^2/s", "angular momentum in space axes"),
        "position": moving(axes, trajectory.position._data, "m", "centre of mass in space"),
        "velocity": moving(axes, trajectory.velocity._data, "m/s", "velocity of the centre of mass"),
        "energy": moving(along, trajectory.energy, "J", "rotational kinetic and potential energy"),
        "inertia": _inertia(trajectory, variable),
    }
    coordinates: dict[str, Any] = {
        "time": ("time", trajectory.time, {"units": "s", "long_name": "time", "axis": "T"}),
        "quaternion": ["w", "x", "y", "z"],
        "axis": ["x", "y", "z"],
        "axis_": ["x", "y", "z"],
    }
    if trajectory.events:
        variables |= _events(trajectory, variable)
    if trajectory.shape:
        coordinates["body"] = np.arange(count)
        variables |= _bodies(trajectory, variable)
    dataset: xarray.Dataset = xr.Dataset(variables, coordinates, _attributes(trajectory))
    return dataset


def _inertia(trajectory: Trajectory, variable: Callable[..., Any]) -> Any:
    one, own = ("axis", "axis_"), trajectory.inertia
    text = "inertia matrix in body axes"
    if not isinstance(own, np.ndarray):
        return variable(one, own.matrix, "kg m^2", text)
    matrices = np.array([inertia.matrix for inertia in own.flat]).reshape(own.size, 3, 3)
    return variable(("body", *one), matrices, "kg m^2", text)


def _bodies(trajectory: Trajectory, variable: Callable[..., Any]) -> dict[str, Any]:
    """Return certificate and failure of each body of a batch."""
    proof, along = trajectory.certificate, ("body",)

    def column(numbers: Any, units: str, text: str) -> Any:
        return variable(along, np.ravel(numbers), units, text)

    failed = np.full(trajectory.shape, np.nan)
    messages = np.full(trajectory.shape, "", dtype=object)
    for failure in trajectory.failures:
        failed[failure.index], messages[failure.index] = failure.time, failure.message
    columns = {
        "step": column(proof.step, "s", "longest step"),
        "steps": column(proof.steps, "1", "steps of all passes"),
        "evaluations": column(proof.evaluations, "1", "evaluations of the torque"),
        "error_estimate": column(proof.error_estimate, "1", "estimate of the relative error"),
        "rotor_norm_drift": column(proof.norm_drift, "1", "largest abs(|R| - 1)"),
        "failure_time": column(failed, "s", "time up to which a failed body was computed"),
        "failure": (along, messages.ravel(), {"long_name": "error of a failed body"}),
    }
    if not isinstance(proof.method, str):
        names = proof.method.astype(object).ravel()
        columns["method"] = (along, names, {"long_name": "method"})
    for name, start in proof.conserved.items():
        columns[f"{name}_start"] = column(start, "SI", f"{name} at the start")
        columns[f"{name}_drift"] = column(proof.drift[name], "1", f"largest relative change of the {name}")
    return columns


def _events(trajectory: Trajectory, variable: Callable[..., Any]) -> dict[str, Any]:
    """Return all events in one dimension."""
    events, along, axes = trajectory.events, ("event",), ("event", "axis")

    def joined(part: Callable[[Crossings], Any]) -> Any:
        return np.concatenate([part(event) for event in events])

    names = np.array([event.name for event in events for _ in event.time], dtype=object)
    attitude = joined(lambda event: event.rotor.to_quaternion(order="wxyz"))
    omega = joined(lambda event: event.omega_body._data)
    return {
        "event_name": (along, names, {"long_name": "name of the event"}),
        "event_time": variable(along, joined(lambda event: event.time), "s", "time of the event"),
        "event_rising": variable(
            along, joined(lambda event: event.rising), "1", "whether the event function was rising"
        ),
        "event_attitude": variable(("event", "quaternion"), attitude, "1", "attitude, body to space"),
        "event_omega_body": variable(axes, omega, "rad/s", "angular velocity in body axes"),
        "event_position": variable(
            axes, joined(lambda event: event.position._data), "m", "centre of mass in space"
        ),
        "event_velocity": variable(
            axes, joined(lambda event: event.velocity._data), "m/s", "velocity of the centre of mass"
        ),
    }


def require_libraries() -> None:
    """Raise an ImportError if libraries for netCDF files are missing."""
    optional("xarray", "io", "labelled data")
    optional("h5netcdf", "io", "a netCDF file")


def netcdf(trajectory: Trajectory) -> bytes:
    """Return the content of a netCDF4 file."""
    require_libraries()
    dataset = to_xarray(trajectory)
    buffer = io.BytesIO()
    dataset.to_netcdf(buffer, engine="h5netcdf", encoding={"time": {"_FillValue": None}})
    return buffer.getvalue()


def _attributes(trajectory: Trajectory) -> dict[str, Any]:
    """Return attributes: flat text and numbers, which every netCDF reader shows."""
    proof = trajectory.certificate
    attributes: dict[str, Any] = {
        "conventions": CONVENTIONS,
        "source": f"polhode {_native.__version__}",
    }
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

# Foreign files may have any size: nothing else is read.
_READ = {"time", "attitude", "omega_body", "momentum_space", "energy", "position", "velocity", "inertia"}
# Attributes written here or by the library; all others are the user's.
_OWN = {
    *("conventions", "source", "method", "step_s", "steps", "evaluations", "conserved", "drift"),
    *("error_estimate", "warnings", "_NCProperties"),
}


def read(path: str | os.PathLike[str]) -> Trajectory:
    """Return the motion in a netCDF file, as `Trajectory.read`."""
    from polhode._algebra.constructors import bivector, vector
    from polhode._mechanics.bodies import Inertia
    from polhode._mechanics.trajectory import Trajectory

    fields, attributes = _content(path)
    try:
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
            attributes={name: x for name, x in attributes.items() if name not in _OWN},
        )
    except KeyError as error:
        raise ValueError(f"{path} is not a motion that polhode wrote: {error} is missing") from None
    except (TypeError, ValueError) as error:
        raise ValueError(f"{path} is not a motion that polhode wrote: {error}") from error


def _content(path: str | os.PathLike[str]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the arrays and the attributes of a file."""
    library = optional("h5py", "io", "a netCDF file")
    if not os.path.exists(path):
        raise FileNotFoundError(f"{path}: no such file")
    if not os.path.isfile(path):
        raise OSError(f"{path}: not a regular file")
    try:
        with library.File(path, "r") as file:
            attributes = {name: _attribute(x) for name, x in file.attrs.items()}
            many = "batch_shape" in attributes or "body" in file
            names = [] if many else [name for name in file if name in _READ or name.startswith("event_")]
            fields = {name: _array(name, file[name]) for name in names}
    except (OSError, RuntimeError, KeyError, TypeError, ValueError) as error:
        # The library raises any of these for a damaged file.
        raise OSError(f"{path} cannot be read as a netCDF file: {error}") from error
    if many:
        raise ValueError(f"{path} holds a batch of bodies; read it with xarray.open_dataset")
    return fields, attributes


def _attribute(x: Any) -> Any:
    """Return an attribute; numbers are arrays of one element in the file."""
    return x.item() if isinstance(x, np.ndarray) and x.size == 1 else x


def _array(name: str, variable: Any) -> Any:
    if not hasattr(variable, "dtype"):
        raise OSError(f"`{name}` is not a variable")
    return variable.asstr()[...] if variable.dtype.kind == "O" else variable[...]


def _rotors(quaternions: Any) -> Any:
    """Return the rotors of quaternions wxyz: three signs change, without rounding."""
    from polhode._algebra.rotor import Rotor

    return Rotor._from_rows(np.ascontiguousarray(quaternions * [1.0, -1.0, -1.0, -1.0]))


def _certificate(attributes: dict[str, Any]) -> Any:
    from polhode._mechanics.result import Certificate

    drift = json.loads(attributes["drift"])
    norm_drift = drift.pop("rotor_norm")
    return Certificate(
        attributes["method"],
        attributes["step_s"],
        attributes["steps"],
        attributes.get("evaluations"),
        attributes.get("error_estimate"),
        json.loads(attributes["conserved"]),
        drift,
        norm_drift,
        tuple(json.loads(attributes.get("warnings", "[]"))),
    )


def _crossings(fields: dict[str, Any]) -> tuple[Crossings, ...]:
    """Return the events, grouped by name."""
    from polhode._algebra.constructors import bivector, vector
    from polhode._mechanics.result import Crossings

    if "event_name" not in fields:
        return ()
    names = fields["event_name"]
    found = []
    for name in dict.fromkeys(names):
        at = names == name
        found.append(
            Crossings(
                name,
                fields["event_time"][at],
                fields["event_rising"][at].astype(bool),
                _rotors(fields["event_attitude"][at]),
                bivector(fields["event_omega_body"][at]),
                vector(fields["event_position"][at]),
                vector(fields["event_velocity"][at]),
            )
        )
    return tuple(found)
