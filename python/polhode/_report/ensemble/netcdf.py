"""NetCDF file of an ensemble, written block by block."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from polhode import _native
from polhode._mechanics.registry import TORQUES
from polhode._mechanics.trajectory import Trajectory
from polhode._report.ensemble.collect import EnsembleRecords
from polhode._report.netcdf import CF, CONVENTIONS, MOTION, components
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
        # What to add to the description of quantities that are written once for each body; None for others.
        self._notes: dict[str, str | None] = {"attitude": None, "omega_body": None, "energy": None}
        self._notes |= self._constant()
        self._begin()

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _constant(self) -> dict[str, str | None]:
        """Return the notes of momenta, energies, positions and velocities."""
        state, given = self._scene.state, {"position", "velocity"}
        notes: dict[str, str | None] = {}
        if self._scene.kind == "free":
            notes = {"momentum_space": ", constant", "energy": ", constant"}
        if self._scene.force is not None:
            return notes | dict.fromkeys(sorted(given))
        moves = np.any(state.position._data) or np.any(state.velocity._data)
        if moves or not given.isdisjoint(self._ensemble.varied):
            notes |= dict.fromkeys(sorted(given), " at the start")
        return notes

    def _begin(self) -> None:
        """Write dimensions, coordinates and attributes."""
        times, varied = self._scene.times, self._ensemble.varied
        self._file.dimensions = {
            "time": len(times),
            "quaternion": 4,
            "axis": 3,
            "inertia_column": 3,
            "body": None,
        }
        self._write("time", ("time",), times, "s", "time", axis="T")
        for name, labels in (("quaternion", "wxyz"), ("axis", "xyz"), ("inertia_column", "xyz")):
            variable = self._file.create_variable(name, (name,), self._text)
            variable[:] = np.array(list(labels), dtype=object)
        if "moments" not in varied:
            body = self._scene.body
            inertia = body.inertia_about(0) if self._scene.held else body.inertia
            dims, units, text = MOTION["inertia"]
            self._write("inertia", dims, inertia.matrix, units, text)
        self._file.attrs.update(
            {
                **CF,
                "conventions": CONVENTIONS,
                "source": f"polhode {_native.__version__}",
                "title": self._scene.name,
                "scene": self._scene.text,
                "seed": np.uint64(self._ensemble.seed),
                "number": self._ensemble.number,
                "varied": "; ".join(f"{name}: {how}" for name, how in varied.items()),
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
        for name, note in self._notes.items():
            dims, units, text = MOTION[name]
            values = components(trajectory, name)
            if note is None:
                self._grow(rows, name, ("time", *dims), values, units, text)
            else:
                self._grow(rows, name, dims, values[:, 0], units, text + note)
        if "moments" in self._ensemble.varied:
            inertias = np.broadcast_to(trajectory.inertia, len(trajectory))
            dims, units, text = MOTION["inertia"]
            self._grow(rows, "inertia", dims, np.array([x.matrix for x in inertias]), units, text)
        self._proofs(rows, trajectory)
        if any(name.startswith(("torque.", "gravity.")) for name in self._ensemble.varied):
            self._laws(rows)

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

    def _proofs(self, rows: slice, trajectory: Trajectory) -> None:
        proof = trajectory.certificate
        names = np.broadcast_to(proof.method, len(trajectory)).tolist()
        self._methods += sorted({*names} - {*self._methods})
        times = np.full(len(trajectory), np.nan)
        for failure in trajectory.failures:
            times[failure.index] = failure.time
        error = "cautious estimate of the relative error in rotor and angular velocity"
        columns: dict[str, tuple[Any, str, str]] = {
            "method": (np.array([self._methods.index(name) for name in names], np.int8), "1", "method"),
            "step": (proof.step, "s", "longest step, 0 without steps"),
            "steps": (proof.steps, "1", "number of steps"),
            "error_estimate": (proof.error_estimate, "1", error),
            "rotor_norm_drift": (proof.norm_drift, "1", "largest deviation of |R| from 1"),
            "failed": ((~trajectory.ok).astype(np.int8), "1", "1 if the body failed"),
            "failure_time": (times, "s", "time up to which a failed body was computed"),
        }
        for name, drift in proof.drift.items():
            known = np.where(np.isnan(proof.conserved[name]), np.nan, drift)
            text = f"largest relative change of {name.replace('_', ' ')}"
            columns[f"{name}_drift"] = (known, "1", text)
        for name, (values, units, text) in columns.items():
            self._grow(rows, name, (), values, units, text)

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

    def end(self, records: EnsembleRecords) -> None:
        """Write failures and the names of methods, after the last body or an interrupt."""
        self._file.variables["method"].attrs.update(_flags(self._methods))
        self._file.variables["failed"].attrs.update(_flags(["complete", "failed"]))
        if records.failures:
            self._file.dimensions["failure"] = len(records.failures)
            bodies = np.array([failure.index[0] for failure in records.failures])
            self._write("failure_body", ("failure",), bodies, "1", "number of a failed body")
            messages = self._file.create_variable("failure_message", ("failure",), self._text)
            messages[:] = np.array([failure.message for failure in records.failures], dtype=object)
            messages.attrs["long_name"] = "error of a failed body"
        self._file.attrs["bodies_complete"] = records.complete


def _flags(meanings: list[str]) -> dict[str, Any]:
    """Return the attributes of codes 0, 1, ..."""
    return {"flag_values": np.arange(len(meanings), dtype=np.int8), "flag_meanings": " ".join(meanings)}


def _wxyz(values: Array) -> Array:
    """Return rotors as quaternions, and vectors unchanged."""
    return values * np.array([1.0, -1.0, -1.0, -1.0]) if values.ndim == 2 and values.shape[1] == 4 else values
