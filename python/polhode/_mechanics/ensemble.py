"""Ensembles: broadcast inputs and collect results."""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.parameters import Batch, check_finite
from polhode._mechanics.result import Certificate, Failure
from polhode._mechanics.state import State
from polhode._mechanics.trajectory import Drift, Trajectory
from polhode._support import memory
from polhode._support.arrays import Array, Shape, frozen

# Of a point: rotor, angular velocity, momentum and energy; with forces, position and velocity.
_BYTES_OF_POINT = 8 * (4 + 3 + 3 + 1)
_BYTES_OF_CENTER = 8 * (3 + 3)
# Of a body: its inertia and start, and its part of the certificate.
_BYTES_OF_BODY = 800

# The longest step in s, the maximum number of steps of a pass, and times at which steps end.
StepLimits = tuple[float | None, float | None, list[float]]

_VECTOR, _BIVECTOR = 0b0010, 0b0100
_NOWHERE: Any = (None, None)


@dataclass(frozen=True, eq=False)
class Results:
    """Bodies at times (n,), whose results become a trajectory; their batch shapes broadcast to `shape`.

    `inertias` is an array of objects (...), `start_times` (...), `positions` and `velocities` (..., 3).
    """

    shape: Shape
    inertias: Any
    start_times: Array
    positions: Array
    velocities: Array
    times: Array
    method: str

    def trajectory(self, arrays: list[Array], summary: dict[str, Any]) -> Trajectory:
        """Return the trajectory from the arrays of the core (bodies, n, components) and its summary."""
        n = len(self.times)
        arrays = [frozen(x.reshape(*self.shape, *x.shape[1:])[..., :n, :]) for x in arrays]
        return self._trajectory(arrays, self._certificate(summary), self._failures(summary))

    def empty(self, forced: bool) -> Trajectory:
        """Return the trajectory of no bodies."""
        sizes = (4, 3, 3, 1, 3, 3) if forced else (4, 3, 3, 1)
        arrays = [frozen(np.zeros((*self.shape, len(self.times), size))) for size in sizes]
        none = np.zeros(self.shape)
        whole = none.astype(int)
        certificate = Certificate(self.method, none, whole, whole, none, {}, {}, none)
        return self._trajectory(arrays, certificate, ())

    def _trajectory(
        self, arrays: list[Array], certificate: Certificate, failures: tuple[Failure, ...]
    ) -> Trajectory:
        rotors, omegas, momenta, energies, *centers = arrays
        inertias = self.inertias
        # Without forces they are computed on access.
        position, velocity = [Multivector._of(rows, _VECTOR) for rows in centers] or _NOWHERE
        return Trajectory(
            frozen(self.times.copy()),
            Rotor._from_rows(rotors),
            Multivector._of(omegas, _BIVECTOR),
            Multivector._of(momenta, _BIVECTOR),
            energies[..., 0],
            position,
            velocity,
            np.broadcast_to(inertias, self.shape) if inertias.ndim else inertias[()],
            certificate,
            failures=failures,
            _drift=None if centers else self._drift(),
        )

    def _drift(self) -> Drift:
        centers = (np.broadcast_to(x, (*self.shape, 3)) for x in (self.positions, self.velocities))
        return Drift(np.broadcast_to(self.start_times, self.shape), *centers)

    def _certificate(self, summary: dict[str, Any]) -> Certificate:
        """Return the certificate of all bodies, without drifts and errors for those that failed."""
        names, codes = summary["methods"]
        failed = np.zeros(len(codes), bool)
        failed[summary["failed"]] = True
        some_failed = bool(summary["failed"])

        def column(numbers: Array) -> Array:
            return frozen(numbers.reshape(self.shape))

        def finished(numbers: Array) -> Array:
            return column(np.where(failed, np.nan, numbers) if some_failed else numbers)

        # A body that failed before a method was chosen has the given one.
        names = np.array([name or self.method for name in names])
        used = np.flatnonzero(np.bincount(codes[~failed] if some_failed and not failed.all() else codes))
        return Certificate(
            str(names[used[0]]) if len(used) == 1 else column(names[codes]),
            column(summary["step"]),
            column(summary["steps"]),
            column(summary["evaluations"]),
            finished(summary["error_estimate"]),
            {name: column(numbers) for name, numbers in summary["conserved"].items()},
            {name: finished(numbers) for name, numbers in summary["drift"].items()},
            finished(summary["norm_drift"]),
            tuple(summary["warnings"]),
        )

    def _failures(self, summary: dict[str, Any]) -> tuple[Failure, ...]:
        if not summary["failed"]:
            return ()
        indices = np.stack(np.unravel_index(summary["failed"], self.shape), axis=-1).tolist()
        rows = zip(indices, summary["failure_times"], summary["messages"], strict=True)
        return tuple(Failure(tuple(index), time, message) for index, time, message in rows)


@dataclass(frozen=True, eq=False)
class Ensemble(Results):
    """Bodies with their starts, torques and forces.

    `rotors` (..., 4), `omegas` (..., 3), `masses` (...), NaN where unknown; laws and forces may be batches.
    """

    rotors: Array
    omegas: Array
    masses: Array
    laws: tuple[_native.Law, ...]
    forces: tuple[_native.Force, ...]
    step: float | None
    rtol: float | None
    limits: StepLimits

    @property
    def bodies(self) -> int:
        return math.prod(self.shape)

    @property
    def wheels(self) -> tuple[_native.Law, ...]:
        """The laws of wheels with motors."""
        return tuple(law for law in self.laws if law.name == "reaction_wheels")

    @property
    def bytes(self) -> int:
        """Memory for the results and for the computation."""
        return _bytes(self.bodies, len(self.times), bool(self.forces))

    def block(self, rows: slice) -> Ensemble:
        """Return the bodies of some rows of the first batch axis."""
        n = len(self.shape)

        def own(name: str, components: int = 1) -> Any:
            array = getattr(self, name)
            return array[rows] if array.ndim - components == n and array.shape[0] > 1 else array

        def law(one: Any) -> Any:
            if len(one.shape) < n or one.shape[0] == 1:
                return one
            return type(one)(one.name, *(_rows_of(argument, rows) for argument in one.arguments))

        return replace(
            self,
            shape=(len(range(*rows.indices(self.shape[0]))), *self.shape[1:]),
            laws=tuple(map(law, self.laws)),
            forces=tuple(map(law, self.forces)),
            **{name: own(name, 0) for name in ("inertias", "start_times", "masses")},
            **{name: own(name) for name in ("rotors", "omegas", "positions", "velocities")},
        )

    def run(self, threads: int | None, progress: Callable[[int, float], object] | None) -> Trajectory:
        """Return the motions; a MemoryError, raised first, if they would not fit into memory."""
        require(self.bodies, len(self.times), bool(self.forces))
        if not self.bodies:
            return self.empty(bool(self.forces))
        # The core needs at least one time.
        times = self.times if len(self.times) else self.start_times.ravel()[:1]
        centers = np.concatenate(np.broadcast_arrays(self.positions, self.velocities), axis=-1)
        arrays, summary = _native.simulate_many(
            self.shape,
            (self.inertias.ravel().tolist(), self.inertias.shape),
            np.ascontiguousarray(self.start_times),
            self.rotors,
            self.omegas,
            list(self.laws),
            np.ascontiguousarray(centers),
            self.masses,
            list(self.forces),
            times,
            self.method,
            self.step,
            self.rtol,
            self.limits,
            threads,
            progress,
        )
        trajectory = self.trajectory(arrays, summary)
        if self.wheels:
            trajectory = replace(trajectory, _wheels=self.wheels)
        warn_of(trajectory.certificate)
        return trajectory


def _rows_of(argument: Any, rows: slice) -> Any:
    """Return an argument of a law for some rows; formulas have pairs of names and values."""
    if isinstance(argument, Batch):
        return argument[rows]
    if isinstance(argument, tuple) and any(isinstance(x, tuple) and len(x) == 2 for x in argument):
        return tuple((name, _rows_of(value, rows)) for name, value in argument)
    return argument


def require(bodies: int, times: int, forced: bool) -> None:
    """Raise a MemoryError if the motions would not fit into memory."""
    memory.require(
        _bytes(bodies, times, forced),
        f"the motions of {bodies} bodies at {times} times",
        "use fewer times, or ph.simulate_blocks",
    )


def _bytes(bodies: int, times: int, forced: bool) -> int:
    point = _BYTES_OF_POINT + (_BYTES_OF_CENTER if forced else 0)
    return bodies * (point * times + _BYTES_OF_BODY)


# --- inputs


def warn_of(certificate: Certificate) -> None:
    """Issue the warnings of the certificate at the line that called the package."""
    frame, level = sys._getframe(), 1
    while frame.f_back and frame.f_globals.get("__name__", "").partition(".")[0] == "polhode":
        frame, level = frame.f_back, level + 1
    for warning in certificate.warnings:
        warnings.warn(warning, RuntimeWarning, stacklevel=level)


def check_state(state: State) -> None:
    """Raise an error unless the numbers of a state are finite."""
    if not isinstance(state, State):
        raise TypeError(
            f"state must be a State, got {type(state).__name__}; write State(rotor, omega_body), with arrays "
            "for many bodies"
        )
    for name in ("position", "velocity"):
        check_finite(getattr(state, name)._data, f"the {name}")
    check_finite(state.omega_body._data, "the angular velocity")
    check_finite(np.asarray(state.time)[..., np.newaxis], "the time of the state")
