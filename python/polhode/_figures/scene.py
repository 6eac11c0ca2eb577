"""The body and its bivectors at one time, as a figure."""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from polhode._figures.camera import angles_of
from polhode._figures.style import Figure, drawing, plotting, time_unit
from polhode._mechanics.trajectory import Trajectory
from polhode._support.arrays import as_float
from polhode._viewer.capture import studio

# Of the picture, in pixels.
_SIZE = (1920, 1080)

_CAPTION = (
    "Arrows: body axes fₖ = R eₖ ~R; dashed: space axes eₖ. Discs: Ω and L in space, in their planes and "
    "senses, with areas proportional to |Ω| and |L|. Lines: the path of a body axis in space (pink) and of Ω "
    "in the body (ochre); they fade with time."
)


@drawing(7, 4.75, "Motion of a rigid body")
def scene_figure(figure: Figure, trajectory: Trajectory, view: Any = None, time: float | None = None) -> str:
    """Draw the scene at a time in s, the last one if none is given, as the viewer draws it."""
    when = _checked_time(trajectory, time)
    with studio(trajectory, np.array([when]), _SIZE, angles_of(view), "a figure of kind 'scene'") as taken:
        picture = taken.capture(when)
    axes = figure.add_subplot()
    axes.imshow(plotting("matplotlib.image").imread(io.BytesIO(picture), format="png"))
    axes.set_axis_off()
    seconds, unit = time_unit(trajectory.time)
    axes.text(0.01, 0.97, f"t = {when / seconds:.4g} {unit}", transform=axes.transAxes, va="top")
    held = trajectory._origin is not None and trajectory._origin.held
    return _CAPTION + " mg: the weight at the centre of mass." * held


def _checked_time(trajectory: Trajectory, time: float | None) -> float:
    """Return the time, the last one for None; a ValueError outside of those of the motion."""
    first, last = float(trajectory.time.min()), float(trajectory.time.max())
    when = last if time is None else as_float(time, "time")
    if not first <= when <= last:
        raise ValueError(f"time is {when:.6g} s; the motion goes from {first:.6g} s to {last:.6g} s")
    return when
