"""Figures for paper: rates and attitude over time, the polhode on its ellipsoid, the path of an axis."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._arrays import Array
from polhode._extras import optional
from polhode._values import vector

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from polhode._trajectory import Trajectory

# Okabe and Ito's palette, told apart by colour-blind readers too.
_BLUE, _ORANGE, _GREEN, _BLACK = "#0072B2", "#D55E00", "#009E73", "#222222"
_AXES = (_BLUE, _ORANGE, _GREEN)
_FAINT = "#B8B8B8"

# More turns than this in one figure are a solid block.
_TURNS_SEEN = 100

# (longest duration that reads well, seconds in the unit, its name)
_TIME_UNITS = ((300.0, 1.0, "s"), (18e3, 60.0, "min"), (432e3, 3600.0, "h"), (1e9, 86400.0, "d"))


def _figure(width: float, height: float) -> Figure:
    figure: Figure = optional("matplotlib.figure", "plot", "a figure").Figure(
        figsize=(width, height), layout="constrained"
    )
    return figure


def as_png(figure: Figure) -> bytes:
    """Return the figure as a PNG file."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=160)
    return buffer.getvalue()


def _require_times(trajectory: Trajectory) -> None:
    if not len(trajectory.time):
        raise ValueError("the motion has no output times, so there is nothing to draw")


def _time_unit(trajectory: Trajectory) -> tuple[float, str]:
    span = float(np.abs(trajectory.time).max(initial=0.0))
    for longest, seconds, name in _TIME_UNITS:
        if span <= longest:
            return seconds, name
    return 365.25 * 86400.0, "yr"


def motion_figure(trajectory: Trajectory) -> Figure:
    """Draw angular velocity in the body, attitude, and what was conserved, over time."""
    _require_times(trajectory)
    figure = _figure(8, 7.5)
    rates, attitude, drift = figure.subplots(3, 1, sharex=True, height_ratios=(3, 3, 2))
    seconds, unit = _time_unit(trajectory)
    t = trajectory.time / seconds
    for k, (plane, colour) in enumerate(zip(("e2∧e3", "e3∧e1", "e1∧e2"), _AXES, strict=True)):
        rates.plot(t, trajectory.omega_body.components[:, k], color=colour, lw=1.2, label=plane)
    rates.set_ylabel("angular velocity\nin the body, rad/s")
    _draw_attitude(attitude, trajectory, t)
    _draw_drift(drift, trajectory, t)
    drift.set_xlabel(f"time, {unit}")
    for axes in (rates, attitude, drift):
        axes.grid(alpha=0.25, lw=0.6)
        axes.margins(x=0)
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    figure.align_ylabels()
    figure.suptitle(trajectory.attributes.get("title", "Motion of a rigid body"))
    return figure


def _draw_attitude(axes: Axes, trajectory: Trajectory, t: Array) -> None:
    """Draw the rotor; of a body that spins too often to be seen, the direction of the axis it spins about."""
    rates = (~trajectory.inertia.principal_frame)(trajectory.omega_body).components
    speed = np.linalg.norm(rates, axis=1)
    turns = float(np.abs(np.diff(trajectory.time) * 0.5 * (speed[1:] + speed[:-1])).sum()) / (2 * np.pi)
    if turns <= _TURNS_SEEN:
        parts = ("1", "e2∧e3", "e3∧e1", "e1∧e2")
        for k, (part, colour) in enumerate(zip(parts, (_BLACK, *_AXES), strict=True)):
            axes.plot(t, trajectory.rotor.components[:, k], color=colour, lw=1.2, label=part)
        axes.set_ylabel("attitude rotor R\n(body to space)")
    else:
        k = int(np.argmax(np.abs(rates).mean(axis=0)))
        axis = vector(trajectory.inertia.principal_frame.to_matrix()[:, k])
        path = trajectory.rotor(axis).components
        for j, (name, colour) in enumerate(zip(("e1", "e2", "e3"), _AXES, strict=True)):
            axes.plot(t, path[:, j], color=colour, lw=1.2, label=name)
        axes.set_ylabel(f"direction in space\nof principal axis {k + 1}")
    axes.set_ylim(-1.08, 1.08)


def _draw_drift(axes: Axes, trajectory: Trajectory, t: Array) -> None:
    """Draw relative changes since the first output, in units of 1e-16."""
    momentum = trajectory.momentum_space.components
    conserved = trajectory.certificate.conserved
    series = {}
    if "energy" in conserved:
        scale = max(float(np.abs(trajectory.energy).max(initial=0.0)), np.finfo(float).tiny)
        series["energy"] = (trajectory.energy - trajectory.energy[0]) / scale
    if "angular_momentum" in conserved:
        size = np.linalg.norm(momentum, axis=1)
        series["|L|"] = (size - size[0]) / max(size[0], np.finfo(float).tiny)
    if "vertical_angular_momentum" in conserved:
        size = max(float(np.linalg.norm(momentum, axis=1).max()), np.finfo(float).tiny)
        series["L about e3"] = (momentum[:, 2] - momentum[0, 2]) / size
    exponent = -16
    largest = max((float(np.abs(values).max()) for values in series.values()), default=0.0)
    if largest > 0:
        exponent = int(np.floor(np.log10(largest)))
    for (name, values), colour in zip(series.items(), (_BLUE, _ORANGE), strict=False):
        axes.plot(t, values / 10.0**exponent, color=colour, lw=1.0, label=name)
    axes.set_ylabel(f"relative drift,\n$10^{{{exponent}}}$")


class _View:
    """An orthographic look from a direction, so that what is hidden behind a convex body is known."""

    def __init__(self, azimuth: float = 35.0, elevation: float = 22.0) -> None:
        a, e = np.radians([azimuth, elevation])
        self.toward = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        self.basis = np.stack([right, np.cross(self.toward, right)])

    def project(self, points: Array) -> Array:
        """Return the picture's coordinates (n, 2) of points (n, 3)."""
        flat: Array = points @ self.basis.T
        return flat

    def curve(self, axes: Axes, points: Array, normals: Array, **style: Any) -> None:
        """Draw a curve on a convex surface: solid where its outward normal faces us, faint behind."""
        facing = normals @ self.toward >= 0
        flat = self.project(points)
        front = np.where(facing[:, np.newaxis], flat, np.nan)
        # The hidden part keeps the points next to a visible one, so that the two halves meet.
        keep = ~facing
        keep[1:] |= ~facing[:-1]
        keep[:-1] |= ~facing[1:]
        back = np.where(keep[:, np.newaxis], flat, np.nan)
        alpha = style.pop("alpha", 1.0)
        axes.plot(*back.T, alpha=0.25 * alpha, zorder=1, **{**style, "label": None, "ls": (0, (2, 2))})
        axes.plot(*front.T, alpha=alpha, zorder=3, **style)

    def silhouette(self, semi_axes: Array) -> Array:
        """Return the outline (n, 2) of an ellipsoid: where its normal is perpendicular to our gaze."""
        # The surface point is S u with |u| = 1 and normal S⁻¹ u: perpendicular when u ⟂ S⁻¹ toward.
        n = self.toward / semi_axes
        first = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
        first /= np.linalg.norm(first)
        second = np.cross(n, first) / np.linalg.norm(n)
        s = np.linspace(0, 2 * np.pi, 361)[:, np.newaxis]
        return self.project(semi_axes * (np.cos(s) * first + np.sin(s) * second))


def _finish(axes: Axes, view: _View, semi_axes: Array, names: tuple[str, str, str]) -> None:
    """Draw the half of each axis that sticks out of the ellipsoid, and make room for it."""
    reach = 0.35 * float(np.max(semi_axes))
    room = [view.silhouette(semi_axes)]
    for k, (name, colour) in enumerate(zip(names, _AXES, strict=True)):
        unit = np.eye(3)[k]
        start, end = view.project(np.stack([unit * semi_axes[k], unit * (semi_axes[k] + reach)]))
        label = end + 0.25 * reach * (end - start) / max(float(np.linalg.norm(end - start)), 1e-12)
        arrow = {"arrowstyle": "-|>", "color": colour, "lw": 1.4, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", xy=end, xytext=start, arrowprops=arrow, zorder=4)
        axes.text(label[0], label[1], name, color=colour, ha="center", va="center", zorder=5)
        room.append(label[np.newaxis])
    points = np.concatenate(room)
    margin = 0.25 * reach
    low, high = points.min(axis=0) - margin, points.max(axis=0) + margin
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")
    axes.set_axis_off()


def polhode_figure(trajectory: Trajectory) -> Figure:
    """Draw the polhode of a free motion on the inertia ellipsoid ``Σ i_k ω_k² = 2E``, among its neighbours.

    Components are about the principal axes. Where the curve is behind the ellipsoid it is faint.
    """
    _require_times(trajectory)
    figure = _figure(6.4, 6.4)
    axes = figure.add_subplot()
    moments = trajectory.inertia.principal_moments
    omega = (~trajectory.inertia.principal_frame)(trajectory.omega_body).components
    energy = 0.5 * float((moments * omega[0] ** 2).sum())
    if energy == 0:
        axes.set_axis_off()
        axes.text(0.5, 0.5, "At rest: no polhode", ha="center", transform=axes.transAxes)
        return figure
    semi_axes = np.sqrt(2 * energy / moments)
    view = _View()
    axes.fill(*view.silhouette(semi_axes).T, facecolor="#F4F6F8", edgecolor=_BLACK, lw=0.9, zorder=0)
    for curve in _polhode_family(moments, energy):
        view.curve(axes, curve, curve * moments, color=_FAINT, lw=0.8)
    for curve in _separatrix(moments, energy):
        view.curve(axes, curve, curve * moments, color=_BLACK, lw=0.9, alpha=0.7)
    view.curve(axes, omega, omega * moments, color=_ORANGE, lw=2.0)
    start = view.project(omega[:1])[0]
    hidden = (omega[0] * moments) @ view.toward < 0
    axes.plot(*start, "o", color=_ORANGE, ms=6, mec="white", mew=0.8, zorder=5, alpha=0.4 if hidden else 1.0)
    _finish(axes, view, semi_axes, ("axis 1", "axis 2", "axis 3"))
    figure.suptitle(trajectory.attributes.get("title", "Polhode"))
    figure.supxlabel(
        f"Angular velocity in principal axes (moments {', '.join(f'{i:.4g}' for i in moments)} kg m²),\n"
        "on the ellipsoid of its energy: orange, from the dot. Grey: other motions of the same energy.\n"
        "Black: the separatrix between turning about the longest and the shortest axis.",
        fontsize=9,
    )
    return figure


def _polhode_family(moments: Array, energy: float) -> list[Array]:
    """Return polhodes of one energy around the axes of least and greatest moment.

    With ``u_k = ω_k √i_k`` on the sphere ``|u|² = 2E``, ``Σ (i_c − i_k) u_k² = 2E i_c − G²`` is an
    ellipse in the plane of the other two axes; it is centred on axis c.
    """
    order = np.argsort(moments, kind="stable")
    if moments[order[0]] == moments[order[2]]:
        return []
    s = np.linspace(0, 2 * np.pi, 241)
    curves = []
    for c, middle, other in ((order[2], order[1], order[0]), (order[0], order[1], order[2])):
        to_middle, to_other = abs(moments[c] - moments[middle]), abs(moments[c] - moments[other])
        if to_middle == 0:
            continue
        for fraction in (0.1, 0.35, 0.7):
            size = 2 * energy * to_middle * fraction
            u = np.zeros((s.size, 3))
            u[:, middle] = np.sqrt(size / to_middle) * np.cos(s)
            u[:, other] = np.sqrt(size / to_other) * np.sin(s)
            u[:, c] = np.sqrt(np.maximum(2 * energy - u[:, middle] ** 2 - u[:, other] ** 2, 0.0))
            curves += [u / np.sqrt(moments), -u / np.sqrt(moments)]
    return curves


def _separatrix(moments: Array, energy: float) -> list[Array]:
    """Return the two great circles of u where ``G² = 2E i_mid``."""
    low, middle, high = np.argsort(moments, kind="stable")
    below, above = moments[middle] - moments[low], moments[high] - moments[middle]
    if below <= 0 or above <= 0:
        return []
    s = np.linspace(0, 2 * np.pi, 361)
    curves = []
    for sign in (1.0, -1.0):
        u = np.zeros((s.size, 3))
        u[:, middle] = np.sin(s)
        u[:, low] = np.cos(s) * np.sqrt(above / (above + below))
        u[:, high] = sign * np.cos(s) * np.sqrt(below / (above + below))
        curves.append(np.sqrt(2 * energy / moments) * u)
    return curves


def axis_figure(trajectory: Trajectory, axis: Array, name: str) -> Figure:
    """Draw the path on the unit sphere of a direction fixed in the body (3,); e3 of space is up."""
    _require_times(trajectory)
    figure = _figure(6.4, 6.4)
    axes = figure.add_subplot()
    view = _View()
    sphere = np.ones(3)
    axes.fill(*view.silhouette(sphere).T, facecolor="#F4F6F8", edgecolor=_BLACK, lw=0.9, zorder=0)
    s = np.linspace(0, 2 * np.pi, 241)
    for height in np.radians([-60, -30, 0, 30, 60]):
        circle = np.stack(
            [np.cos(height) * np.cos(s), np.cos(height) * np.sin(s), np.full_like(s, np.sin(height))], axis=1
        )
        view.curve(axes, circle, circle, color=_FAINT, lw=0.7)
    path = trajectory.rotor(vector(axis / np.linalg.norm(axis))).components
    view.curve(axes, path, path, color=_ORANGE, lw=1.6)
    axes.plot(*view.project(path[:1])[0], "o", color=_ORANGE, ms=6, mec="white", mew=0.8, zorder=5)
    _finish(axes, view, sphere, ("e1", "e2", "e3"))
    figure.suptitle(trajectory.attributes.get("title", "Path of the axis"))
    figure.supxlabel(f"Path of {name} on the unit sphere of space axes (dot: start).", fontsize=9)
    return figure
