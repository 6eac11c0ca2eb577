"""Layout of an ensemble's data: variables, dimensions and attributes, shared by its files."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from polhode import _native
from polhode._mechanics.inertia import matrices
from polhode._mechanics.registry import TORQUES
from polhode._mechanics.trajectory import Trajectory
from polhode._report.netcdf import CF, CONVENTIONS, MOTION, components
from polhode._scene.scene import Scene
from polhode._support.arrays import Array

# Coordinates that are names of components.
LABELS = {"quaternion": "wxyz", "axis": "xyz", "inertia_column": "xyz"}

# What the inertia depends on.
_INERTIAS = ("moments", "body", "gravity.pivot", "define")


@dataclass(frozen=True)
class Variable:
    """A variable: its dimensions, without `body`, its values, unit and description."""

    name: str
    dims: tuple[str, ...]
    values: Any
    units: str
    text: str
    attributes: dict[str, Any] = field(default_factory=dict)

    @property
    def labels(self) -> dict[str, Any]:
        """The attributes in the file."""
        units = {"units": self.units} if self.units else {}
        return {**units, "long_name": self.text, **self.attributes}


class EnsembleLayout:
    """The variables of a scene's ensemble.

    Constant and redundant data are not written at every time: momentum and energy of free bodies are written
    once for each body, momenta of others not at all (``L = R I(Ω) ~R``, plus the wheels'), positions only if
    forces move the bodies. The first time is that of the start.
    """

    def __init__(self, scene: Scene) -> None:
        assert scene.ensemble is not None
        self._scene, self._ensemble = scene, scene.ensemble
        # What to add to the description of quantities that are written once for each body; None for others.
        self._notes: dict[str, str | None] = {"attitude": None, "omega_body": None, "energy": None}
        self._notes |= self._constant()

    def _constant(self) -> dict[str, str | None]:
        """Return the notes of momenta, energies, positions and velocities."""
        state, given = self._scene.state, {"position", "velocity"}
        notes: dict[str, str | None] = {}
        if self._scene.kind == "free":
            notes = {"momentum_space": ", constant", "energy": ", constant"}
        if self._scene.force is not None:
            return notes | dict.fromkeys(sorted(given))
        moves = np.any(state.position._data) or np.any(state.velocity._data)
        if moves or self._ensemble._varies(*given, *(f"initial.{name}" for name in given), "define"):
            notes |= dict.fromkeys(sorted(given), " at the start")
        return notes

    def attributes(self) -> dict[str, Any]:
        """Return the attributes of the data: text and numbers."""
        return {
            **CF,
            "conventions": CONVENTIONS,
            "source": f"polhode {_native.__version__}",
            "title": self._scene.name,
            "scene": self._scene.text,
            "seed": np.uint64(self._ensemble.seed),
            "number": self._ensemble.number,
            "varied": "; ".join(f"{name}: {how}" for name, how in self._ensemble.varied.items()),
            **({} if self._ensemble.table_sha256 is None else {"table_sha256": self._ensemble.table_sha256}),
        }

    def shared(self) -> Iterator[Variable]:
        """Yield the variables that all bodies share, without the labels."""
        yield Variable("time", ("time",), self._scene.times, "s", "time", {"axis": "T"})
        if not self._ensemble._varies(*_INERTIAS):
            body = self._scene.body
            inertia = body.inertia_about(0) if self._scene.held else body.inertia
            dims, units, text = MOTION["inertia"]
            yield Variable("inertia", dims, inertia.matrix, units, text)

    def of_bodies(self, rows: slice, trajectory: Any) -> Iterator[Variable]:
        """Yield the variables of a trajectory of some bodies, without method and number of the body."""
        for name, note in self._notes.items():
            dims, units, text = MOTION[name]
            values = components(trajectory, name)
            if note is None:
                yield Variable(name, ("time", *dims), values, units, text)
            else:
                yield Variable(name, dims, values[:, 0], units, text + note)
        if self._ensemble._varies(*_INERTIAS):
            inertias = np.broadcast_to(trajectory.inertia, len(trajectory))
            dims, units, text = MOTION["inertia"]
            yield Variable("inertia", dims, matrices(inertias), units, text)
        yield from _proofs(trajectory)
        if self._ensemble._varies("torque", "gravity", "body", "define"):
            yield from self._laws(rows)
        if self._ensemble.points is not None:
            yield from self._points(rows, self._ensemble.points)

    def _laws(self, rows: slice) -> Iterator[Variable]:
        """Yield the drawn parameters of torque laws."""
        for law in self._ensemble.laws(rows.start, rows.stop - rows.start):
            if isinstance(law, _native.Law):
                continue
            name, arguments = law
            if name == "formula":
                continue
            for argument, values in zip(TORQUES[name].arguments, arguments, strict=True):
                dims = () if values.ndim == 1 else ("axis" if values.shape[1] == 3 else "quaternion",)
                text = f"parameter of the torque law {name}, as drawn"
                label = "_".join(filter(None, (name, argument.field)))
                yield Variable(label, dims, _wxyz(values), argument.unit, text)

    def _points(self, rows: slice, number: int) -> Iterator[Variable]:
        """Yield the points of bodies, and the numbers in the scene that they replace."""
        points = np.arange(rows.start, rows.stop) % number
        yield Variable("point", (), points, "1", "number of the point of the grid, list or table")
        for path, values, unit in self._ensemble._given(rows.start, rows.stop - rows.start):
            if isinstance(values, list):
                continue
            name, text = re.sub(r"\W+", "_", path).strip("_"), f"{path}, as given"
            if values.ndim == 1 or values.shape[1] == 3:
                yield Variable(name, ("axis",) * (values.ndim - 1), values, unit, text)
                continue
            for index, column in enumerate(values.T):
                yield Variable(f"{name}_{index}", (), column.copy(), unit, f"{path}[{index}], as given")


def failures(found: list[tuple[int, str]]) -> tuple[Variable, tuple[str, list[str], str]]:
    """Return the numbers of failed bodies, and name, values and description of the messages."""
    bodies = np.array([body for body, _ in found])
    numbers = Variable("failure_body", ("failure",), bodies, "1", "number of a failed body")
    return numbers, ("failure_message", [message for _, message in found], "error of a failed body")


def flags(meanings: list[str], first: int = 0) -> dict[str, Any]:
    """Return the attributes of codes first, first + 1, ..."""
    values = np.arange(first, first + len(meanings), dtype=np.int8)
    return {"flag_values": values, "flag_meanings": " ".join(meanings)}


def _proofs(trajectory: Trajectory) -> Iterator[Variable]:
    """Yield how the bodies were computed."""
    proof = trajectory.certificate
    times = np.full(len(trajectory), np.nan)
    for failure in trajectory.failures:
        times[failure.index] = failure.time
    error = "cautious estimate of the relative error in rotor and angular velocity"
    columns: dict[str, tuple[Any, str, str]] = {
        "step": (proof.step, "s", "longest step, 0 without steps"),
        "steps": (proof.steps, "1", "number of steps"),
        "error_estimate": (proof.error_estimate, "1", error),
        "rotor_norm_drift": (proof.norm_drift, "1", "largest deviation of |R| from 1"),
        "failed": ((~trajectory.ok).astype(np.int8), "1", "1 if the body failed"),
        "failure_time": (times, "s", "time up to which a failed body was computed"),
    }
    for name, drift in proof.drift.items():
        known = np.where(np.isnan(proof.conserved[name]), np.nan, drift)
        columns[f"{name}_drift"] = (known, "1", f"largest relative change of {name.replace('_', ' ')}")
    for name, (values, units, text) in columns.items():
        meanings = flags(["complete", "failed"]) if name == "failed" else {}
        yield Variable(name, (), values, units, text, meanings)


def _wxyz(values: Array) -> Array:
    """Return rotors as quaternions, and vectors unchanged."""
    return values * np.array([1.0, -1.0, -1.0, -1.0]) if values.ndim == 2 and values.shape[1] == 4 else values
