"""Registry of the kinds of figures of a motion; writing figures to files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from polhode._figures.camera import angles_of
from polhode._figures.film import scene_figure
from polhode._figures.herpolhode import herpolhode_figure
from polhode._figures.over_time import drift_figure, motion_figure
from polhode._figures.phase_portrait import phase_figure
from polhode._figures.spheres import axis_figure, path_figure, polhode_figure
from polhode._figures.style import Figure, Sheet, as_png, encoded, require_times
from polhode._figures.tilt import angle_figure, locus_figure, satellite_figure, top_figure
from polhode._mechanics.trajectory import Trajectory
from polhode._report.motion_parameters import long_axis, main_axis, weight, wheel
from polhode._scene.scene import Scene
from polhode._support.arrays import Array
from polhode._support.extras import optional
from polhode._support.files import form_of, write_atomically

# Kinds of figures.
KINDS = ("motion", "polhode", "herpolhode", "locus", "drift", "phase", "scene")
# Kinds of motion whose angular velocity stays on an ellipsoid in the body.
ON_ELLIPSOID = ("free", "damped", "gyrostat")
# Kinds of figures that have a direction of view.
_WITH_VIEW = ("polhode", "locus", "phase", "scene")


def figure(
    trajectory: Trajectory, kind: str, sheet: Sheet, view: Any = None, time: float | None = None
) -> Figure:
    """Return a figure of one body; see `Trajectory.plot`."""
    check(kind, view, time)
    _check_axes(sheet.axes)
    require_times(trajectory)
    match kind:
        case "motion":
            _require_no_axes(sheet, kind)
            return motion_figure.on(sheet, trajectory)
        case "polhode":
            return _polhode(trajectory, view, sheet)
        case "herpolhode":
            return _herpolhode(trajectory, sheet)
        case "locus":
            return locus_figure(trajectory, _weight(trajectory, kind), view, sheet)
        case "drift":
            _require_no_axes(sheet, kind)
            return drift_figure.on(sheet, trajectory)
        case "phase":
            return _phase(trajectory, view, sheet)
        case _:
            return scene_figure.on(sheet, trajectory, view, time)


def _check_axes(ax: Any) -> None:
    """Raise an error unless this is None or plane axes of matplotlib."""
    if ax is None:
        return
    if not isinstance(ax, optional("matplotlib.axes", "plot", "a figure").Axes):
        raise TypeError(f"ax must be axes of matplotlib, got {type(ax).__name__}; see matplotlib's subplots")
    if ax.name != "rectilinear":
        raise ValueError(f"ax has the projection {ax.name!r}; figures are drawn on plane axes")


def _require_no_axes(sheet: Sheet, kind: str) -> None:
    if sheet.axes is not None:
        raise ValueError(
            f"kind {kind!r} of this motion has several panels and cannot be drawn on one axes: call plot "
            "without ax; polhode, herpolhode, locus, scene, and phase of a body under torque have one panel"
        )


def check(kind: str, view: Any, time: float | None) -> None:
    """Raise a ValueError for arguments that no motion allows."""
    if kind not in KINDS:
        raise ValueError(f"unknown kind of figure {kind!r}, expected one of {', '.join(KINDS)}")
    if view is not None and kind not in _WITH_VIEW:
        raise ValueError(f"view is for the kinds {', '.join(_WITH_VIEW)}, not for {kind!r}")
    if time is not None and kind != "scene":
        raise ValueError(f"time is for the kind 'scene', not for {kind!r}")
    angles_of(view)
    if kind == "scene":
        optional("playwright", "film", "a figure of kind 'scene'")


def characteristic_figure(scene: Scene, trajectory: Trajectory) -> Figure:
    """Return the figure typical of the kind of motion: the polhode, or the path of an axis."""
    kind = scene.kind
    if kind in ON_ELLIPSOID:
        return polhode_figure(trajectory, wheel(scene.torque) if kind == "gyrostat" else None)
    if kind == "satellite":
        caption = (
            "Path of the axis of the least moment in orbit axes, from the dot on: up is away from the "
            "planet, along is the direction of flight. Dashed: behind."
        )
        return path_figure(trajectory, long_axis(trajectory), caption, ("along", "normal", "up"))
    if scene.held and (c := weight(scene.torque)).any():
        return axis_figure(trajectory, c, "the line from the fixed point to the centre of mass")
    number, axis = main_axis(trajectory)
    return axis_figure(trajectory, axis, f"principal axis {number}")


def pictures(scene: Scene, trajectory: Trajectory) -> tuple[bytes, bytes]:
    """Return the PNGs of a run: the motion, and its characteristic figure."""
    return as_png(motion_figure(trajectory)), as_png(characteristic_figure(scene, trajectory))


def write(figure: Figure, path: Path) -> None:
    """Write a figure, whole or not at all."""
    write_atomically({path: encoded(figure, form_of(path, "a figure"))})


def _polhode(trajectory: Trajectory, view: Any, sheet: Sheet) -> Figure:
    kind = _kind(trajectory)
    if kind not in ON_ELLIPSOID:
        raise ValueError(
            "kind 'polhode' is for bodies whose Ω stays on an ellipsoid: free, damped in proportion to L, "
            f"or with a wheel; {_acting(trajectory)}"
        )
    return polhode_figure.on(sheet, trajectory, _wheel(trajectory) if kind == "gyrostat" else None, view)


def _herpolhode(trajectory: Trajectory, sheet: Sheet) -> Figure:
    if _kind(trajectory) != "free":
        raise ValueError(
            "kind 'herpolhode' is for free bodies, whose Ω stays in an invariable plane; "
            + _acting(trajectory)
        )
    _require_path(trajectory, "herpolhode")
    return herpolhode_figure.on(sheet, trajectory)


def _phase(trajectory: Trajectory, view: Any, sheet: Sheet) -> Figure:
    _require_path(trajectory, "phase")
    kind = _kind(trajectory)
    if kind in ON_ELLIPSOID:
        _require_no_axes(sheet, "phase")
        return phase_figure.on(sheet, trajectory, _wheel(trajectory), view)
    if view is not None:
        raise ValueError("view is for the phase portraits of bodies without torque, not for this one")
    if kind == "heavy":
        return top_figure.on(sheet, trajectory, _weight(trajectory, "phase"))
    return (satellite_figure if kind == "satellite" else angle_figure).on(sheet, trajectory)


# --- what acts on the body


def _kind(trajectory: Trajectory) -> str:
    """Return the kind of motion from what acted, or if that is unknown from what was conserved."""
    if trajectory._motion is not None:
        return trajectory._motion.kind
    if "angular_momentum" not in trajectory.certificate.conserved:
        return "unknown"
    return "gyrostat" if _wheel(trajectory).any() else "free"


def _wheel(trajectory: Trajectory) -> Array:
    """Return the momentum of wheels (3,) in body axes: L minus that of the body."""
    if trajectory._origin is not None:
        return np.zeros(3) + wheel(trajectory._origin.torque)
    momentum = (~trajectory.rotor)(trajectory.momentum_space).components
    h: Array = (momentum - trajectory.inertia(trajectory.omega_body).components).mean(axis=0)
    return h if np.linalg.norm(h) > 1e-9 * np.abs(momentum).max(initial=0.0) else np.zeros(3)


def _weight(trajectory: Trajectory, kind: str) -> Array:
    """Return m g times the centre of mass (3,) in body axes; a ValueError without gravity."""
    setting = trajectory._origin
    c = None if setting is None or not setting.held else weight(setting.torque)
    if c is None or not c.any():
        raise ValueError(
            f"kind {kind!r} is for a body held at a fixed point under gravity (ph.torque.heavy, or "
            f"[gravity] in a scene); {_acting(trajectory)}"
        )
    _require_path(trajectory, kind)
    return c


def _acting(trajectory: Trajectory) -> str:
    """Return what acts on the body, for an error message."""
    setting = trajectory._origin
    if setting is None and trajectory.certificate.method == "samples":
        return "the torque on this one is unknown, because its attitudes are from a table"
    if setting is None:
        return (
            "the torque on this one is unknown, because it was picked from a batch or unpickled: "
            "simulate the body alone"
        )
    if setting.torque is None:
        return "no torque acts on this one"
    return f"this one is under {', '.join(law.name for law in setting.torque.laws)}"


def _require_path(trajectory: Trajectory, kind: str) -> None:
    n = len(trajectory.time)
    if n < 2:
        raise ValueError(f"kind {kind!r} draws a path and needs 2 output times or more; this motion has {n}")
