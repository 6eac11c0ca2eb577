"""NetCDF file of an ensemble, written block by block."""

from __future__ import annotations

from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np

from polhode import _native
from polhode._mechanics.registry import TORQUES
from polhode._mechanics.result import Failure
from polhode._mechanics.trajectory import Trajectory
from polhode._report.netcdf import CONVENTIONS
from polhode._scene.scene import Scene
from polhode._support.arrays import Array
from polhode._support.extras import optional

# Bytes of a chunk, the unit of reading and writing.
_CHUNK = 1 << 20


def bytes_of_file(scene: Scene) -> int:
    """Return the approximate size in bytes of the file of a scene's ensemble."""
    assert scene.ensemble is not None
    numbers = 4 + 3 + (scene.kind != "free") + 6 * (scene.force is not None)
    return scene.ensemble.number * 8 * (numbers * len(scene.times) + 30)


class EnsembleFile:
    """A netCDF file with a dimension `body` that grows.

    Constant and redundant data are not written at every time: momentum and energy of free bodies are written
    once for each body, momenta of others not at all (``L = R I(Ω) ~R``, plus the wheels'), positions only if
    forces move the bodies. The first time is that of the start.
    """

    def __init__(self, path: Path, scene: Scene) -> None:
        assert scene.ensemble is not None
        self._scene, self._ensemble = scene, scene.ensemble
        self._file = optional("h5netcdf", "io", "a netCDF file").File(path, "w")
        self._text = optional("h5py", "io", "a netCDF file").string_dtype()
        self._methods: list[str] = []
        self._failures: list[Failure] = []
        self._complete = 0
        self._begin()

    def __enter__(self) -> EnsembleFile:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._file.close()

    def _begin(self) -> None:
        """Write dimensions, coordinates and attributes."""
        times = self._scene.times
        self._file.dimensions = {"time": len(times), "quaternion": 4, "axis": 3, "axis_": 3, "body": None}
        self._write("time", ("time",), times, "s", "time", axis="T")
        for name, labels in (("quaternion", "wxyz"), ("axis", "xyz"), ("axis_", "xyz")):
            variable = self._file.create_variable(name, (name,), self._text)
            variable[:] = np.array(list(labels), dtype=object)
        if "moments" not in self._ensemble.varied:
            body = self._scene.body
            inertia = body.inertia_about(0) if self._scene.held else body.inertia
            self._write("inertia", ("axis", "axis_"), inertia.matrix, "kg m^2", "inertia matrix in body axes")
        varied = "; ".join(f"{name}: {how}" for name, how in self._ensemble.varied.items())
        self._file.attrs.update(
            {
                "conventions": CONVENTIONS,
                "source": f"polhode {_native.__version__}",
                "title": self._scene.name,
                "scene": self._scene.text,
                "seed": np.uint64(self._ensemble.seed),
                "number": self._ensemble.number,
                "varied": varied,
            }
        )

    def _write(
        self, name: str, dims: tuple[str, ...], values: Any, units: str, text: str, **attributes: Any
    ) -> None:
        """Write a variable of fixed size."""
        variable = self._file.create_variable(name, dims, np.asarray(values).dtype)
        variable[...] = values
        variable.attrs.update({"units": units, "long_name": text, **attributes})

    def add(self, rows: slice, trajectory: Trajectory) -> None:
        """Write the next bodies."""
        self._file.resize_dimension("body", rows.stop)
        self._grow(rows, "body", (), np.arange(rows.start, rows.stop), "1", "number of the body")
        self._motions(rows, trajectory)
        self._proofs(rows, trajectory)
        if any(name.startswith(("torque.", "gravity.")) for name in self._ensemble.varied):
            self._laws(rows)
        self._failures += [
            Failure((rows.start + failure.index[0],), failure.time, failure.message)
            for failure in trajectory.failures
        ]
        self._complete = rows.stop

    def _grow(
        self, rows: slice, name: str, dims: tuple[str, ...], values: Any, units: str, text: str
    ) -> None:
        """Write some bodies' rows of a variable; earlier rows of a new variable are NaN."""
        variable = self._file.variables.get(name)
        if variable is None:
            shape = [self._file.dimensions[dim].size for dim in dims]
            size = int(np.prod(shape, initial=values.dtype.itemsize))
            chunk = max(1, min(_CHUNK // max(size, 1), self._ensemble.number))
            fill = {"fillvalue": np.nan} if values.dtype.kind == "f" else {}
            variable = self._file.create_variable(
                name, ("body", *dims), values.dtype, chunks=(chunk, *shape), **fill
            )
            variable.attrs.update({"units": units, "long_name": text})
        variable[rows] = values

    def _motions(self, rows: slice, trajectory: Trajectory) -> None:
        quaternions = trajectory.rotor.to_quaternion(order="wxyz")
        self._grow(rows, "attitude", ("time", "quaternion"), quaternions, "1", "attitude, body to space")
        omegas = trajectory.omega_body._data
        self._grow(rows, "omega_body", ("time", "axis"), omegas, "rad/s", "angular velocity in body axes")
        energy = "rotational kinetic and potential energy"
        if self._scene.kind == "free":
            momenta = trajectory.momentum_space._data[:, 0]
            text = "angular momentum in space axes, constant"
            self._grow(rows, "momentum_space", ("axis",), momenta, "kg m^2/s", text)
            self._grow(rows, "energy", (), trajectory.energy[:, 0], "J", f"{energy}, constant")
        else:
            self._grow(rows, "energy", ("time",), trajectory.energy, "J", energy)
        self._centers(rows, trajectory)
        if "moments" in self._ensemble.varied:
            inertias = np.broadcast_to(trajectory.inertia, len(trajectory))
            matrices = np.array([inertia.matrix for inertia in inertias])
            text = "inertia matrix in body axes"
            self._grow(rows, "inertia", ("axis", "axis_"), matrices, "kg m^2", text)

    def _centers(self, rows: slice, trajectory: Trajectory) -> None:
        """Write positions and velocities of the centres of mass; without forces those at the start."""
        if not (self._scene.force is not None or self._moves):
            return
        for name, units, text in (
            ("position", "m", "centre of mass in space"),
            ("velocity", "m/s", "velocity of the centre of mass"),
        ):
            values = getattr(trajectory, name)._data
            if self._scene.force is not None:
                self._grow(rows, name, ("time", "axis"), values, units, text)
            else:
                self._grow(rows, name, ("axis",), values[:, 0], units, f"{text} at the start")

    @property
    def _moves(self) -> bool:
        state = self._scene.state
        given = np.any(state.position._data) or np.any(state.velocity._data)
        return bool(given) or not {"position", "velocity"}.isdisjoint(self._ensemble.varied)

    def _proofs(self, rows: slice, trajectory: Trajectory) -> None:
        proof = trajectory.certificate
        names = np.broadcast_to(proof.method, len(trajectory)).tolist()
        self._methods += sorted({*names} - {*self._methods})
        codes = np.array([self._methods.index(name) for name in names], np.int8)
        self._grow(rows, "method", (), codes, "1", "method")
        self._grow(rows, "step", (), proof.step, "s", "longest step, 0 without steps")
        self._grow(rows, "steps", (), proof.steps, "1", "number of steps")
        text = "cautious estimate of the relative error in rotor and angular velocity"
        self._grow(rows, "error_estimate", (), proof.error_estimate, "1", text)
        self._grow(rows, "rotor_norm_drift", (), proof.norm_drift, "1", "largest deviation of |R| from 1")
        for name, drift in proof.drift.items():
            known = np.where(np.isnan(proof.conserved[name]), np.nan, drift)
            text = f"largest relative change of {name.replace('_', ' ')}"
            self._grow(rows, f"{name}_drift", (), known, "1", text)
        self._grow(rows, "failed", (), (~trajectory.ok).astype(np.int8), "1", "1 if the body failed")
        times = np.full(len(trajectory), np.nan)
        for failure in trajectory.failures:
            times[failure.index] = failure.time
        self._grow(rows, "failure_time", (), times, "s", "time up to which a failed body was computed")

    def _laws(self, rows: slice) -> None:
        """Write the drawn parameters of torque laws."""
        for law in self._ensemble.draw(rows.start, rows.stop - rows.start)[2]:
            if isinstance(law, _native.Law):
                continue
            name, arguments = law
            for argument, values in zip(TORQUES[name].arguments, arguments, strict=True):
                dims = () if values.ndim == 1 else ("axis" if values.shape[1] == 3 else "quaternion",)
                text = f"parameter of the torque law {name}, as drawn"
                label = "_".join(filter(None, (name, argument.field)))
                self._grow(rows, label, dims, _wxyz(values), argument.unit, text)

    def end(self) -> None:
        """Write failures and the names of methods, after the last body or an interrupt."""
        attributes = self._file.variables["method"].attrs
        attributes["flag_values"] = np.arange(len(self._methods), dtype=np.int8)
        attributes["flag_meanings"] = " ".join(self._methods)
        failed = self._file.variables["failed"].attrs
        failed["flag_values"], failed["flag_meanings"] = np.array([0, 1], np.int8), "complete failed"
        if self._failures:
            self._file.dimensions["failure"] = len(self._failures)
            bodies = np.array([failure.index[0] for failure in self._failures])
            self._write("failure_body", ("failure",), bodies, "1", "number of a failed body")
            messages = self._file.create_variable("failure_message", ("failure",), self._text)
            messages[:] = np.array([failure.message for failure in self._failures], dtype=object)
            messages.attrs["long_name"] = "error of a failed body"
        self._file.attrs["bodies_complete"] = self._complete


def _wxyz(values: Array) -> Array:
    """Return rotors as quaternions, and vectors unchanged."""
    return values * np.array([1.0, -1.0, -1.0, -1.0]) if values.ndim == 2 and values.shape[1] == 4 else values
