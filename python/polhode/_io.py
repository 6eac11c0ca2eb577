"""Trajectories as labelled data, and as netCDF files."""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _native
from polhode._extras import optional

if TYPE_CHECKING:
    import xarray

    from polhode._trajectory import Crossings, Trajectory

CONVENTIONS = (
    "Right-handed e1, e2, e3; I = e1e2e3. Rotor R = exp(-B theta/2) turns body axes to space axes, "
    "actively: a_space = R a_body ~R. Quaternion [w, x, y, z] is Hamilton's and active; "
    "R = w - x e2e3 - y e3e1 - z e1e2. Bivectors (angular velocity, angular momentum) are given by the "
    "components of their axial vectors, "
    "(e2e3, e3e1, e1e2) = (x, y, z). R' = -1/2 Omega_space R = -1/2 R Omega_body. "
    "omega_body is in body axes, momentum_space in space axes."
)


def to_xarray(trajectory: Trajectory) -> xarray.Dataset:
    """Return a dataset with dimensions time, quaternion and axis, units and conventions."""
    xr = optional("xarray", "io", "labelled data")

    def variable(dims: tuple[str, ...], data: Any, units: str, text: str) -> Any:
        return (dims, np.array(data), {"units": units, "long_name": text})

    along, axes = ("time",), ("time", "axis")
    variables = {
        "attitude": variable(
            ("time", "quaternion"),
            trajectory.rotor.to_quaternion(order="wxyz"),
            "1",
            "attitude, body to space",
        ),
        "omega_body": variable(
            axes, trajectory.omega_body.components, "rad/s", "angular velocity in body axes"
        ),
        "momentum_space": variable(
            axes, trajectory.momentum_space.components, "kg m^2/s", "angular momentum in space axes"
        ),
        "position": variable(axes, trajectory.position.components, "m", "centre of mass in space"),
        "velocity": variable(axes, trajectory.velocity.components, "m/s", "velocity of the centre of mass"),
        "energy": variable(along, trajectory.energy, "J", "rotational kinetic and potential energy"),
        "inertia": variable(
            ("axis", "axis_"), trajectory.inertia.matrix, "kg m^2", "inertia matrix in body axes"
        ),
    }
    coordinates = {
        "time": ("time", trajectory.time, {"units": "s", "long_name": "time", "axis": "T"}),
        "quaternion": ["w", "x", "y", "z"],
        "axis": ["x", "y", "z"],
        "axis_": ["x", "y", "z"],
    }
    if trajectory.events:
        variables |= _events(trajectory, variable)
    dataset: xarray.Dataset = xr.Dataset(variables, coordinates, _attributes(trajectory))
    return dataset


def _events(trajectory: Trajectory, variable: Callable[..., Any]) -> dict[str, Any]:
    """Return what happened, one event after the other."""
    events, along, axes = trajectory.events, ("event",), ("event", "axis")

    def joined(part: Callable[[Crossings], Any]) -> Any:
        return np.concatenate([part(event) for event in events])

    names = np.array([event.name for event in events for _ in event.time], dtype=object)
    attitude = joined(lambda event: event.rotor.to_quaternion(order="wxyz"))
    omega = joined(lambda event: event.omega_body.components)
    return {
        "event_name": (along, names, {"long_name": "what passed zero"}),
        "event_time": variable(along, joined(lambda event: event.time), "s", "time of the event"),
        "event_rising": variable(along, joined(lambda event: event.rising), "1", "whether it rose"),
        "event_attitude": variable(("event", "quaternion"), attitude, "1", "attitude, body to space"),
        "event_omega_body": variable(axes, omega, "rad/s", "angular velocity in body axes"),
        "event_position": variable(
            axes, joined(lambda event: event.position.components), "m", "centre of mass in space"
        ),
        "event_velocity": variable(
            axes, joined(lambda event: event.velocity.components), "m/s", "velocity of the centre of mass"
        ),
    }


def require_libraries() -> None:
    """Raise an ImportError now if a netCDF file could not be written later."""
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
    """Flat text and numbers, which every netCDF reader shows."""
    proof = trajectory.certificate
    attributes: dict[str, Any] = {
        "conventions": CONVENTIONS,
        "source": f"polhode {_native.__version__}",
        "method": proof.method,
        "step_s": proof.step,
        "steps": proof.steps,
        "conserved": json.dumps(proof.conserved),
        "drift": json.dumps({**proof.drift, "rotor_norm": proof.norm_drift}),
    }
    if proof.error_estimate is not None:
        attributes["error_estimate"] = proof.error_estimate
    return {**attributes, **trajectory.attributes}
