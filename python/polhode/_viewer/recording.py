"""Recorded motions for the viewer: rows of states, and a description.

Their formats are `State` and `About` in `viewer/src/core/core.ts`.
"""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np

from polhode._algebra.constructors import bivector, vector
from polhode._algebra.interpolation import slerp
from polhode._algebra.rotor import Rotor
from polhode._mechanics.bodies import Body
from polhode._mechanics.problem import Problem
from polhode._mechanics.state import State
from polhode._mechanics.trajectory import Trajectory, _Points
from polhode._scene.scene import Scene
from polhode._support.arrays import Array
from polhode._support.packing import packed, unpacked

# Numbers in a row.
_ROW = 24
# A body turns by less than this between rows, in rad, up to the maximum number of rows.
_TURN = 0.2
_MOST_ROWS = 20_000
# Samples from which the largest rate is found.
_RATE_SAMPLES = 101


def recorded(
    trajectory: Trajectory, origin: Scene | Problem | None, mesh: bool, times: Array | None = None
) -> dict[str, str]:
    """Return the recorded motion of one body, as the page needs it to show the motion without solving it.

    It has at most 20,000 rows, evenly chosen from the output times. If the motion has states between these,
    rows are added: at `times` (n,), and wherever the body turns far from one row to the next. `origin` is the
    problem that was solved, if it is known; `mesh`, whether the document has the mesh of its scene. A
    ValueError if the motion has no time after its start, or numbers that are not finite.
    """
    points = _points(trajectory, origin, np.empty(0) if times is None else times)
    rows = _rows(points)
    if not (finite := np.isfinite(rows).all(axis=1)).all():
        when = points.time[np.argmin(finite)]
        raise ValueError(f"the viewer needs finite numbers; this motion has others at t = {when:g} s")
    about = _about(trajectory, origin, points, mesh)
    return {"about": json.dumps(about, allow_nan=False), "rows": packed(rows.astype("<f8").tobytes())}


def state_at(given: dict[str, str], time: float) -> State:
    """Return the state of a recorded motion at a time in s, as the page shows it.

    Between rows the rotor is interpolated by slerp and everything else linearly, as in the page. Times before
    the first and after the last row give their states.
    """
    rows = np.frombuffer(unpacked(given["rows"]), "<f8").reshape(-1, _ROW)
    times = rows[:, 0]
    when = min(max(time, float(times[0])), float(times[-1]))
    k = max(int(np.searchsorted(times, when, side="right")) - 1, 0)
    after = min(k + 1, len(rows) - 1)
    part = (when - times[k]) / (times[after] - times[k]) if after > k else 0.0
    row = rows[k] + part * (rows[after] - rows[k])
    rotor = slerp(Rotor.from_components(rows[k, 1:5]), Rotor.from_components(rows[after, 1:5]), part)
    return State(rotor, bivector(row[5:8]), vector(row[18:21]), vector(row[21:24]), time=when)


def _points(trajectory: Trajectory, origin: Scene | Problem | None, more: Array) -> _Points:
    """Return the recorded states, from the start on, or from the first state if the start is not known.

    `more` are additional times (n,).
    """
    times = trajectory.time
    first = float(origin.state.time) if origin is not None else float(times[0]) if len(times) else 0.0
    first = float(min([first, *more]))
    last = float(times[-1]) if len(times) else first
    if last <= first:
        raise ValueError(
            f"the viewer needs an output time after the start of the motion, {first:g} s; this one has none"
        )
    if trajectory._motion is not None:
        some = _Points.of(trajectory._motion.at(np.linspace(first, last, _RATE_SAMPLES)))
        rate = float(np.max([some.omega_body.norm().max(), trajectory.omega_body.norm().max()]))
        met = np.unique(np.append(times[times >= first], first))
        met = met[_evenly(len(met))]
        intervals = len(met) - 1
        # Equal parts of each interval, so that the output times are among them.
        parts = min(math.ceil(rate * (last - first) / _TURN / intervals), (_MOST_ROWS - 1) // intervals)
        if parts > 1 or times[0] != first or len(more):
            parts = max(parts, 1)
            closer = np.interp(np.arange(intervals * parts + 1) / parts, np.arange(intervals + 1), met)
            return _Points.of(trajectory._motion.at(np.union1d(closer, more)))
    # Output times may be equal, and before the start.
    rising = np.flatnonzero((np.diff(times, prepend=-np.inf) > 0) & (times >= first))
    if len(rising) < 2:
        raise ValueError(f"the viewer needs two output times or more from {first:g} s on")
    kept = rising[_evenly(len(rising))]
    return _Points(*(getattr(trajectory, name)[kept] for name in _Points._fields))


def _evenly(count: int) -> Any:
    """Return evenly spaced indices below `count`, at most the maximum number of rows, with both ends."""
    return np.linspace(0, count - 1, min(_MOST_ROWS, count)).round().astype(int)


def _rows(points: _Points) -> Array:
    """Return the rows of `State`, (n, 24)."""
    rotor, omega, momentum = points.rotor, points.omega_body, points.momentum_space
    before = (rotor, omega, rotor(omega), (~rotor)(momentum), momentum)
    columns = [
        points.time[:, np.newaxis],
        *(x.components for x in before),
        points.energy[:, np.newaxis],
        *(x.components for x in (points.position, points.velocity)),
    ]
    return np.concatenate(columns, axis=1)


def _about(
    trajectory: Trajectory, origin: Scene | Problem | None, points: _Points, mesh: bool
) -> dict[str, Any]:
    """Return the description `About` of the recorded states."""
    proof, inertia = trajectory.certificate, trajectory.inertia
    # A file may have been read that does not have the start.
    known = origin is not None and origin.state.time == points.time[0]
    rotor = origin.state.rotor if origin and known else points.rotor[0]
    omega_body = origin.state.omega_body if origin and known else points.omega_body[0]
    return {
        "title": origin.title if isinstance(origin, Scene) else trajectory.attributes.get("title"),
        "caption": origin.caption if isinstance(origin, Scene) else None,
        "body": {
            **_body(origin),
            "moments": inertia.principal_moments.tolist(),
            "frame": inertia.principal_frame.components.tolist(),
            "mesh": mesh,
        },
        **_facts(trajectory, origin),
        "laws": _laws(origin),
        "start": {
            "rotor": rotor.components.tolist(),
            "omega_body": omega_body.components.tolist(),
            "time": float(points.time[0]),
        },
        "duration": float(points.time[-1] - points.time[0]),
        "samples": len(trajectory.time),
        "method": "recorded",
        "exact": False,
        "horizon": None,
        "steps": int(proof.steps),
        "error_estimate": proof.error_estimate,
        "conserved": [
            {"name": name, "value": value, "drift": proof.drift[name]}
            for name, value in proof.conserved.items()
        ],
        "norm_drift": proof.norm_drift,
        "ensemble": None,
        "events": [
            {"name": event.name, "time": float(time)} for event in trajectory.events for time in event.time
        ],
    }


def _facts(trajectory: Trajectory, origin: Scene | Problem | None) -> dict[str, Any]:
    """Return what is known from the start."""
    if isinstance(origin, Scene):
        return origin._core.facts()
    if trajectory._motion is not None:
        return trajectory._motion.facts()
    return {"held": False, "heavy": None, "free": None, "top": None}


def _body(origin: Scene | Problem | None) -> dict[str, Any]:
    """Return mass, centre of mass and solid, if they are known."""
    zero = [0.0] * 3
    if origin is None or not isinstance(origin.body, Body):
        return {"mass": None, "center_of_mass": zero, "solid": None, "solid_at": zero}
    body, scene = origin.body, origin if isinstance(origin, Scene) else None
    return {
        "mass": body.mass if scene is None or scene.has_mass else None,
        "center_of_mass": body.center_of_mass.components.tolist(),
        "solid": scene.solid if scene else None,
        "solid_at": scene.shift.tolist() if scene else zero,
    }


def _laws(origin: Scene | Problem | None) -> list[dict[str, Any]]:
    """Return each law: the name of its field in a scene, and its formula or its numbers."""
    if isinstance(origin, Scene):
        return origin._core.laws()
    laws = () if origin is None or origin.torque is None else origin.torque.laws
    return [law.facts() for law in laws]
