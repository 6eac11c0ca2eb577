"""What is kept of an ensemble's bodies while blocks pass by, for its summary and its figures."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.constructors import vector
from polhode._algebra.rotor import Rotor
from polhode._figures.style import main_axis
from polhode._mechanics.free_motion import FreeMotion
from polhode._mechanics.result import Failure
from polhode._mechanics.trajectory import Trajectory
from polhode._report.describe import kind_of, orbit_of, weight
from polhode._scene.scene import Scene
from polhode._support.arrays import Array

# Numbers of each body at each time, in single precision: seven digits are more than a quantile has.
SERIES = ("from_nominal", "tilt", "rate")
# Numbers of each body.
ENDS = ("energy", "angular_momentum")
PERIODS = ("period", "precession_period")

# Of what is passing by: the results, what is made of them, and what is being written. Bytes of the figures.
_PASSING, _FIGURES = 4, 100 << 20


class Gathered:
    """What the bodies of a scene do, beside the one from which they differ.

    Attributes
    ----------
    scene, nominal
        The scene, and the motion of its own body.
    axis, axis_name
        A direction fixed in the body (3,) that is watched, and what it is.
    tilt_name
        From what the axis is tilted.
    complete
        How many bodies there are yet; arrays have them first.
    series
        By name (number, n) in single precision: ``from_nominal``, the angle in rad between the attitude and
        that of `nominal`; ``tilt``, that of the axis from L, the vertical or up; ``rate``, ``|Ω|`` in rad/s.
    directions
        The axis in space (number, 3, 3) at the three times `shown`: the first, the middle and the last.
    bodies
        By name (number,): energy and ``|L|`` at the start and at the end, and of free bodies the period of Ω
        in the body and that of the precession; NaN where there is none.
    regimes
        How many free bodies there are in each.
    methods
        How many bodies were followed by each method.
    steps
        Of each body, (number,).
    error_estimates, norm_drifts
        Of each body (number,), NaN where there is none.
    drifts
        By name (number,), NaN where a body does not conserve it or failed.
    failures
        The bodies that could not be followed to the end; ``index`` is their number.
    """

    def __init__(self, scene: Scene, nominal: Trajectory) -> None:
        assert scene.ensemble is not None
        self.scene, self.nominal = scene, nominal
        self.axis, self.axis_name = watched_axis(scene, nominal)
        self._reference, self.tilt_name = _reference(scene, nominal)
        self.complete = 0
        number, n = scene.ensemble.number, len(scene.times)
        self.series = {name: np.empty((number, n), np.float32) for name in SERIES}
        self.shown = (0, n // 2, n - 1)
        self.directions = np.empty((number, 3, 3), np.float32)
        names = [f"{name}_{end}" for name in ENDS for end in ("start", "end")] + list(PERIODS)
        self.bodies = {name: np.full(number, np.nan) for name in names}
        self.regimes: Counter[str] = Counter()
        self.methods: Counter[str] = Counter()
        self.steps = np.zeros(number, np.int64)
        self.error_estimates, self.norm_drifts = np.full(number, np.nan), np.full(number, np.nan)
        self.drifts: dict[str, Array] = {}
        self.failures: list[Failure] = []

    @staticmethod
    def bytes_wanted(scene: Scene) -> int:
        """The memory that a run takes: what is kept of all bodies, and the blocks that pass by."""
        assert scene.ensemble is not None
        number, n = scene.ensemble.number, len(scene.times)
        kept = 4 * (len(SERIES) * n + 9) + 8 * (2 * len(ENDS) + len(PERIODS) + 3 + 4)
        return _FIGURES + number * kept + _PASSING * scene.block * (scene.result_bytes // number + 1000)

    def add(self, rows: slice, trajectory: Trajectory) -> None:
        """Take in the motions of the bodies that follow those before."""
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
        if kind_of(self.scene) == "free":
            self._describe(rows, trajectory)
        self._certify(rows, trajectory)
        self.complete = rows.stop

    def _describe(self, rows: slice, trajectory: Trajectory) -> None:
        """Tell of free motions what their starts tell."""
        starts = trajectory.omega_body._data[:, 0]
        known = np.flatnonzero(np.isfinite(starts).all(axis=-1))
        each = isinstance(trajectory.inertia, np.ndarray)
        told = FreeMotion(
            trajectory.inertia[known] if each else trajectory.inertia,
            Rotor._from_rows(np.ascontiguousarray(trajectory.rotor._data[known, 0])),
            starts[known],
        ).describe()
        for name in PERIODS:
            self.bodies[name][rows.start + known] = np.abs(told[name])
        self.regimes.update(told["regime"].tolist())

    def _certify(self, rows: slice, trajectory: Trajectory) -> None:
        proof = trajectory.certificate
        for method in np.broadcast_to(proof.method, len(trajectory))[trajectory.ok].tolist():
            self.methods[method] += 1
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
    """Return a direction fixed in the body (3,) by which its motion is known, and what it is."""
    if scene.held and (c := weight(scene.torque)).any():
        return c / np.linalg.norm(c), "the line from the fixed point to the centre of mass"
    if kind_of(scene) == "satellite":
        moments = nominal.inertia.principal_moments
        k = int(np.argmin(moments))
        frame: Array = nominal.inertia.principal_frame.to_matrix()
        return frame[:, k], f"the axis of the least moment (principal axis {k + 1})"
    number, axis = main_axis(nominal)
    moments = nominal.inertia.principal_moments
    long = number - 1 == int(np.argmin(moments)) and np.sum(moments == moments.min()) == 1
    return axis, f"the long axis (principal axis {number})" if long else f"principal axis {number}"


def _reference(scene: Scene, nominal: Trajectory) -> tuple[Array | None, str]:
    """Return from which directions (n, 3) the axis is tilted, None for each body's own L; and their name."""
    if scene.held:
        return np.array([[0.0, 0.0, 1.0]]), "the vertical"
    if kind_of(scene) == "satellite":
        up = _native.orbit_directions(*orbit_of(scene.torque), np.ascontiguousarray(nominal.time))
        return up, "up"
    return None, "L"


def _angle(a: Any, b: Any) -> Array:
    """Return the angles between vectors (..., 3); NaN where one of them is 0."""
    angle = np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1))
    return np.where((a != 0).any(axis=-1) & (b != 0).any(axis=-1), angle, np.nan)
