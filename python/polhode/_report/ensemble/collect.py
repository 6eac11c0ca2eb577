"""Records of an ensemble's bodies, collected block by block for summary and figures; their quantiles."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.constructors import vector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.free_motion import FreeMotion
from polhode._mechanics.result import Failure
from polhode._mechanics.trajectory import Trajectory
from polhode._report.motion_parameters import main_axis, orbit_of, weight
from polhode._scene.scene import Scene
from polhode._support.arrays import Array

LEVELS = (0.05, 0.25, 0.5, 0.75, 0.95)

# Per body and time, in single precision: quantiles need fewer than seven digits.
SERIES = ("from_nominal", "tilt", "rate")
# Per body.
ENDS = ("energy", "angular_momentum")
PERIODS = ("period", "precession_period")
# Name of the deviation of |R| from 1 among drifts.
NORM = "rotor_norm"

# Copies of a block in memory at a time (results, derived arrays, file buffers), and bytes of the figures.
_PASSING, _FIGURES = 4, 100 << 20


class EnsembleRecords:
    """Records of the bodies of a scene's ensemble and of the nominal body; NaN where undefined."""

    def __init__(self, scene: Scene, nominal: Trajectory) -> None:
        assert scene.ensemble is not None
        number, n = scene.ensemble.number, len(scene.times)
        # The motion of the scene's own body.
        self.scene, self.nominal = scene, nominal
        # A direction fixed in the body (3,), and the direction from which its tilt is measured.
        self.axis, self.axis_name = watched_axis(scene, nominal)
        self._reference, self.tilt_name = tilt_reference(scene, nominal)
        # Number of bodies recorded so far, the first rows of arrays.
        self.complete = 0
        # (number, n): the angle in rad between the attitude and that of `nominal`; the tilt of the axis in
        # rad from L, the vertical or up; |Ω| in rad/s.
        self.series = {name: np.empty((number, n), np.float32) for name in SERIES}
        # The axis in space at the first, the middle and the last time.
        self.shown = (0, n // 2, n - 1)
        self.directions = np.empty((number, 3, 3), np.float32)
        # Energy and |L| at both ends; of free bodies the periods of Ω in the body and of the precession.
        names = [f"{name}_{end}" for name in ENDS for end in ("start", "end")]
        self.bodies = {name: np.full(number, np.nan) for name in (*names, *PERIODS)}
        # Number of free bodies in each regime, and of bodies computed by each method.
        self.regimes: Counter[str] = Counter()
        self.methods: Counter[str] = Counter()
        self.steps = np.zeros(number, np.int64)
        self.error_estimates, self.norm_drifts = np.full(number, np.nan), np.full(number, np.nan)
        # By name; NaN if a body does not conserve the quantity or failed.
        self.drifts: dict[str, Array] = {}
        # Their `index` is the number of the body.
        self.failures: list[Failure] = []

    @staticmethod
    def bytes_wanted(scene: Scene) -> int:
        """Return the memory of a run in bytes: records of all bodies, and the current block."""
        assert scene.ensemble is not None
        number, n = scene.ensemble.number, len(scene.times)
        kept = 4 * (len(SERIES) * n + 9) + 8 * (2 * len(ENDS) + len(PERIODS) + 3 + 4)
        return _FIGURES + number * kept + _PASSING * scene.block * (scene.result_bytes // number + 1000)

    def blocks(self, progress: Any, threads: int | None) -> Iterator[tuple[slice, Trajectory]]:
        """Yield the motions of the bodies in blocks, for `add`."""
        return self.scene.run_blocks(progress=progress, threads=threads)

    def quantiles(self, name: str, k: int | None = None) -> Array:
        """Return the quantiles (5, ...) at `LEVELS` of a series, at one or all times, or of a number."""
        if name in self.series:
            values = self.series[name]
            return quantiles(values if k is None else values[:, k])
        return quantiles(self.bodies[name])

    def worst(self) -> dict[str, dict[str, Any]]:
        """Return the largest drift of each quantity, and of the norm of the rotor, with its body."""
        return {name: worst_of(drift) for name, drift in (*self.drifts.items(), (NORM, self.norm_drifts))}

    @property
    def error_estimate(self) -> float | None:
        """The largest of all error estimates; None if no body has one."""
        known = self.error_estimates[~np.isnan(self.error_estimates)]
        return float(known.max()) if known.size else None

    @property
    def total_steps(self) -> int:
        """Number of steps of the bodies recorded so far."""
        return int(self.steps[: self.complete].sum())

    def add(self, rows: slice, trajectory: Trajectory) -> None:
        """Record the motions of the next bodies."""
        turns = (trajectory.rotor * ~self.nominal.rotor)._data
        self.series["from_nominal"][rows] = 2 * np.arctan2(
            np.linalg.norm(turns[..., 1:], axis=-1), np.abs(turns[..., 0])
        )
        momenta = trajectory.momentum_space._data
        path = trajectory.rotor(vector(self.axis)).components
        self.series["tilt"][rows] = _angle(path, momenta if self._reference is None else self._reference)
        self.series["rate"][rows] = np.linalg.norm(trajectory.omega_body._data, axis=-1)
        self.directions[rows] = path[:, self.shown]
        for end, k in (("start", 0), ("end", -1)):
            self.bodies[f"energy_{end}"][rows] = trajectory.energy[:, k]
            self.bodies[f"angular_momentum_{end}"][rows] = np.linalg.norm(momenta[:, k], axis=-1)
        if self.scene.kind == "free":
            self._describe(rows, trajectory)
        self._certify(rows, trajectory)
        self.complete = rows.stop

    def _describe(self, rows: slice, trajectory: Trajectory) -> None:
        """Record regimes and periods of free motions."""
        starts = trajectory.omega_body._data[:, 0]
        known = np.flatnonzero(np.isfinite(starts).all(axis=-1))
        each = isinstance(trajectory.inertia, np.ndarray)
        described = FreeMotion(
            trajectory.inertia[known] if each else trajectory.inertia,
            Rotor._from_rows(np.ascontiguousarray(trajectory.rotor._data[known, 0])),
            starts[known],
        ).describe()
        for name in PERIODS:
            self.bodies[name][rows.start + known] = np.abs(described[name])
        self.regimes.update(described["regime"].tolist())

    def _certify(self, rows: slice, trajectory: Trajectory) -> None:
        proof = trajectory.certificate
        self.methods.update(np.broadcast_to(proof.method, len(trajectory))[trajectory.ok].tolist())
        self.steps[rows] = proof.steps
        self.error_estimates[rows], self.norm_drifts[rows] = proof.error_estimate, proof.norm_drift
        for name, drift in proof.drift.items():
            column = self.drifts.setdefault(name, np.full(len(self.steps), np.nan))
            column[rows] = np.where(np.isnan(proof.conserved[name]), np.nan, drift)
        self.failures += [
            Failure((rows.start + failure.index[0],), failure.time, failure.message)
            for failure in trajectory.failures
        ]


def watched_axis(scene: Scene, nominal: Trajectory) -> tuple[Array, str]:
    """Return the direction fixed in the body (3,) that figures show, and its name."""
    if scene.held and (c := weight(scene.torque)).any():
        return c / np.linalg.norm(c), "the line from the fixed point to the centre of mass"
    moments = nominal.inertia.principal_moments
    if scene.kind == "satellite":
        k = int(np.argmin(moments))
        frame: Array = nominal.inertia.principal_frame.to_matrix()
        return frame[:, k], f"the axis of the least moment (principal axis {k + 1})"
    number, axis = main_axis(nominal)
    long = number - 1 == int(np.argmin(moments)) and np.sum(moments == moments.min()) == 1
    return axis, f"the long axis (principal axis {number})" if long else f"principal axis {number}"


def tilt_reference(scene: Scene, nominal: Trajectory) -> tuple[Array | None, str]:
    """Return the directions (n, 3) from which tilt is measured, None for each body's L, and their name."""
    if scene.held:
        return np.array([[0.0, 0.0, 1.0]]), "the vertical"
    if scene.kind == "satellite":
        up = _native.orbit_directions(*orbit_of(scene.torque), np.ascontiguousarray(nominal.time))
        return up, "up"
    return None, "L"


def _angle(a: Any, b: Any) -> Array:
    """Return the angles between vectors (..., 3); NaN if one of them is 0."""
    angle = np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1))
    return np.where((a != 0).any(axis=-1) & (b != 0).any(axis=-1), angle, np.nan)


def quantiles(values: Any) -> Array:
    """Return the quantiles (5, ...) of values (bodies, ...) at `LEVELS`.

    NaN, such as of failed bodies, is ignored; quantiles of nothing else are NaN.
    """
    columns = [column[~np.isnan(column)].astype(np.float64) for column in values.reshape(len(values), -1).T]
    none = np.full(len(LEVELS), np.nan)
    found = [np.quantile(known, LEVELS) if known.size else none for known in columns]
    return np.stack(found, axis=-1).reshape(len(LEVELS), *values.shape[1:])


def worst_of(drift: Array) -> dict[str, Any]:
    """Return the largest drift and the number of its body; None if no body has one."""
    known = np.flatnonzero(~np.isnan(drift))
    if not known.size:
        return {"bodies": 0, "worst": None, "body": None}
    body = int(known[np.argmax(drift[known])])
    return {"bodies": int(known.size), "worst": float(drift[body]), "body": body}


def first_above(times: Array, values: Array, bound: float) -> float | None:
    """Return the time at which values first pass a bound, interpolated linearly; None if they do not."""
    above = np.flatnonzero(values > bound)
    if not above.size:
        return None
    k = int(above[0])
    if k == 0:
        return float(times[0])
    share = (bound - values[k - 1]) / (values[k] - values[k - 1])
    return float(times[k - 1] + share * (times[k] - times[k - 1]))
