"""The scene of a motion: the body, its frame and that of space, Ω and L as oriented discs, and a trace."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._algebra.constructors import e1, e2, e3, vector
from polhode._algebra.rotor import Rotor
from polhode._figures.camera import view_of
from polhode._figures.painter import Disc, Painter
from polhode._figures.shapes import cone, surface_of
from polhode._figures.solid import Solid, rgb
from polhode._figures.style import (
    _AXES,
    _BLACK,
    BODY_AXES,
    MOMENTUM,
    OMEGA,
    SPACE_AXES,
    TRACE,
    WEIGHT,
    entitle,
    explain,
    in_our_look,
    main_axis,
    new_figure,
    time_unit,
    title_of,
)
from polhode._mechanics.smooth import Samples, rotor_at, samples, states_at
from polhode._report.describe import weight
from polhode._support.arrays import Array, as_float
from polhode._support.extras import optional

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from polhode._algebra.multivector import Multivector
    from polhode._mechanics.trajectory import Trajectory

# The picture, from left to right and from below upwards.
_ROOM = (-1.95, 1.95), (-1.65, 1.95)
# Sizes over the largest distance of a point of the body from the origin.
_DISCS, _BODY_FRAME, _SPACE_FRAME = (1.32, 1.12), 1.5, 1.78
# The pieces of the trace.
_STRETCH = 0.025
# The length of the arrow of the weight; radius and height of the stand under a fixed point.
_WEIGHT, _STAND = 0.6, (0.13, 0.42)
# The longest trace, in stretches.
_LONGEST = 4000
_WHITE = np.ones(3)


class Stage:
    """What is drawn of a motion at any of its times, prepared once."""

    def __init__(self, trajectory: Trajectory, view: Any = None) -> None:
        self.trajectory = trajectory
        self.view = view_of(view)
        self.surface = surface_of(trajectory)
        vertices, faces, tints, center, _ = self.surface
        size = float(np.linalg.norm([*vertices, center], axis=1).max())
        self.solid, self.center = Solid(vertices / size, faces, tints), center / size
        setting = trajectory._origin
        self.held = setting is not None and setting.held
        self.weight = weight(setting.torque) if setting is not None and setting.held else np.zeros(3)
        self.traced, self.traced_name = self._traced()
        path = samples(trajectory)
        self.path_times, self.path = self._trace(path)
        lowest = path.rotor(vector(self.center)).components[:, 2].min()
        self.stands = bool(lowest > -0.5 * np.linalg.norm(self.center))
        self.fastest = float(np.asarray(trajectory.omega_body.norm()).max())
        self.most_momentum = float(np.asarray(trajectory.momentum_space.norm()).max())

    def _traced(self) -> tuple[Array, str]:
        """Return the point of the body (3,), in the picture's scale, whose path is drawn, and its name."""
        if self.weight.any():
            axis, name = self.weight / np.linalg.norm(self.weight), "the axis to the centre of mass"
        else:
            number, axis = main_axis(self.trajectory)
            name = f"principal axis {number}"
        k = int(np.argmax(np.abs(axis)))
        if abs(axis[k]) > 0.9999:
            axis, name = np.eye(3)[k] * (np.sign(axis[k]) if self.weight.any() else 1.0), BODY_AXES[k]
        return _BODY_FRAME * axis, name

    def _trace(self, path: Samples) -> tuple[Array, Array]:
        """Return the times (n,) and places (n, 3) of the traced point, as far apart as can be seen."""
        places = path.rotor(vector(self.traced)).components
        lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))])
        stretch = _STRETCH * _BODY_FRAME
        steps = np.flatnonzero(np.diff(np.floor(lengths / stretch), prepend=-1.0))
        return path.time[steps], places[steps]

    def draw(self, axes: Axes, time: float, tail: float = np.inf) -> None:
        """Draw the scene at a time, with the trace of the `tail` seconds before it."""
        state = states_at(self.trajectory, np.array([time]))
        rotor = Rotor._from_rows(state.rotor.components[0])
        omega = rotor(state.omega_body[0])
        momentum = rotor(self.trajectory.inertia(state.omega_body[0])) + self._wheel(rotor)
        painter = Painter(self.view)
        self.solid.paint(painter, rotor)
        frame = rotor.to_matrix().T
        for k in range(3):
            painter.arrow(np.zeros(3), _SPACE_FRAME * np.eye(3)[k], rgb(_BLACK), 0.9, 0.1)
            # A little nearer than an axis of space in the same place.
            lift = 0.02 * self.view.toward
            painter.arrow(lift, lift + _BODY_FRAME * frame[k], rgb(_AXES[k]), 1.9, 0.13)
        self._paint_trace(painter, rotor, time, tail)
        labels = [(_SPACE_FRAME * np.eye(3)[k], SPACE_AXES[k], _BLACK) for k in range(3)]
        labels += [(_BODY_FRAME * frame[k], BODY_AXES[k], _AXES[k]) for k in range(3)]
        for value, most, size, colour, name, arrows in (
            (momentum, self.most_momentum, _DISCS[0], MOMENTUM, "L", 3),
            (omega, self.fastest, _DISCS[1], OMEGA, "Ω", 4),
        ):
            if (disc := oriented(value, most, size, colour, arrows)) is not None:
                painter.discs.append(disc)
                labels.append((self._label_of(disc, name), name, colour))
        if self.held:
            self._paint_held(painter, rotor)
        painter.draw(axes)
        axes.set(xlim=_ROOM[0], ylim=_ROOM[1])
        axes.set_aspect("equal")
        axes.set_axis_off()
        self._write_labels(axes, labels)

    def _wheel(self, rotor: Rotor) -> Multivector:
        """Return the momentum of wheels in space: of them L has more than the body's own."""
        start = self.trajectory
        turned_back = (~rotor_at(start, 0))(start.momentum_space[0])
        wheel: Multivector = turned_back - start.inertia(start.omega_body[0])
        return rotor(wheel)

    def _paint_trace(self, painter: Painter, rotor: Rotor, time: float, tail: float) -> None:
        """Add the path of the traced point up to now, paler the longer ago."""
        first, last = np.searchsorted(self.path_times, [time - tail, time])
        first = max(int(first), int(last) - _LONGEST)
        now = rotor(vector(self.traced)).components
        places = np.concatenate([self.path[first:last], now[np.newaxis]])
        if len(places) > 1:
            age = np.linspace(1, 0, len(places) - 1)[:, np.newaxis]
            colours = rgb(TRACE) + 0.72 * age**1.5 * (_WHITE - rgb(TRACE))
            # Where it comes back to a place, what is later lies upon what is older.
            lift = 0.02 * np.linspace(0, 1, len(places))[:, np.newaxis] * self.view.toward
            painter.line(places + lift, colours, 1.3, 2 * _STRETCH * _BODY_FRAME)

    def _paint_held(self, painter: Painter, rotor: Rotor) -> None:
        """Add the stand under the fixed point, and the arm to the centre of mass with its weight.

        A body that hangs down would pass through the stand: it has none.
        """
        if self.stands:
            vertices, faces = cone(*_STAND)
            Solid(vertices - [0, 0, _STAND[1]], faces).paint(painter, Rotor.identity())
        place = rotor(vector(self.center)).components
        if self.center.any():
            painter.line(np.stack([np.zeros(3), place]), rgb(WEIGHT), 2.2, _STRETCH)
        if self.weight.any():
            painter.arrow(place, place - np.array([0, 0, _WEIGHT]), rgb(WEIGHT), 1.6, 0.12)

    def _label_of(self, disc: Disc, name: str) -> Array:
        """Return where a disc's name stands: L outside of its rim on the left, Ω inside on the right."""
        angles = np.linspace(0, 2 * np.pi, 73)
        flat = self.view.project(disc.rim(angles))
        best = int(np.argmax(flat @ ([1.0, -0.4] if name == "Ω" else [-1.0, 0.9])))
        return disc.rim(angles[best]) * (0.72 if name == "Ω" else 1.0)

    def _write_labels(self, axes: Axes, labels: list[tuple[Array, str, str]]) -> None:
        """Write names a little outside of their places, and away from each other."""
        halo = [
            optional("matplotlib.patheffects", "plot", "a figure").withStroke(
                linewidth=2.2, foreground="white"
            )
        ]
        flat = self.view.project(np.array([place for place, _, _ in labels]))
        sizes = np.maximum(np.linalg.norm(flat, axis=1, keepdims=True), 1e-9)
        # Beyond the tips; those of the body's frame also beside, for it may cover the frame of space.
        out = flat / sizes
        beside = np.stack([-out[:, 1], out[:, 0]], axis=1) * np.where(out[:, :1] >= 0, 1, -1)
        of_body = np.array([name in BODY_AXES for _, name, _ in labels])[:, np.newaxis]
        flat = flat + np.where(of_body, 0.08 * out + 0.09 * beside, 0.12 * out)
        for _ in range(30):
            apart = flat[:, np.newaxis] - flat
            distance = np.linalg.norm(apart, axis=-1)
            np.fill_diagonal(distance, np.inf)
            push = (
                np.maximum(0.17 - distance, 0)[..., np.newaxis]
                * apart
                / np.maximum(distance, 1e-3)[..., np.newaxis]
            )
            if not push.any():
                break
            flat = (
                flat + 0.5 * push.sum(axis=1) + 1e-3 * np.arange(len(flat))[:, np.newaxis] * push.any(axis=1)
            )
        for (x, y), (_, name, colour) in zip(flat, labels, strict=True):
            axes.text(
                x, y, name, color=colour, ha="center", va="center", fontsize=10, zorder=40, path_effects=halo
            )

    def told(self) -> str:
        """Return what the caption of a still says of what is drawn."""
        about = "the fixed point" if self.held else "the centre of mass"
        text = (
            f"The body ({self.surface.told}) about {about}, its frame fₖ = R eₖ ~R, thin the space axes eₖ. "
            "Discs: Ω_S and L, in their planes and sense, of areas in proportion to their sizes, |Ω| at most "
            f"{self.fastest:.4g} rad/s, |L| {self.most_momentum:.4g} kg m²/s. "
            f"Line: the path of {self.traced_name}, paler the longer ago."
        )
        return text + (" Grey arrow: the weight at the centre of mass." if self.weight.any() else "")


def oriented(value: Multivector, most: float, radius: float, colour: str, arrows: int) -> Disc | None:
    """Return a bivector as a disc whose area is that share of the largest one's; None for zero."""
    size = float(value.norm())
    if not size > 1e-12 * most:
        return None
    turn = Rotor.from_vectors(e3, value.dual() / size)
    first, second = turn(e1).components, turn(e2).components
    return Disc(first, second, radius * float(np.sqrt(size / most)), colour, arrows)


@in_our_look
def scene_figure(trajectory: Trajectory, view: Any = None, time: float | None = None) -> Figure:
    """Draw the scene at a time in s, the last one if none is given."""
    when = checked_time(trajectory, time)
    stage = Stage(trajectory, view)
    figure = new_figure(5.2, 5.6)
    axes = figure.add_subplot()
    stage.draw(axes, when)
    seconds, unit = time_unit(trajectory.time)
    axes.text(0.02, 0.98, f"t = {when / seconds:.4g} {unit}", transform=axes.transAxes, va="top")
    entitle(figure, title_of(trajectory, "Motion of a rigid body"))
    explain(figure, stage.told())
    return figure


def checked_time(trajectory: Trajectory, time: float | None) -> float:
    """Return the time, the last one for None; a ValueError outside of those of the motion."""
    first, last = float(trajectory.time.min()), float(trajectory.time.max())
    when = last if time is None else as_float(time, "time")
    if not first <= when <= last:
        raise ValueError(f"time is {when:.6g} s; the motion goes from {first:.6g} s to {last:.6g} s")
    return when
