"""Figures on a convex surface: the polhode on its ellipsoid, the path of an axis on the unit sphere."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._arrays import Array
from polhode._extras import optional
from polhode._plot import _AXES, _BLACK, _ORANGE, new_figure, require_times
from polhode._values import vector

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from polhode._trajectory import Trajectory

_FAINT = "#B8B8B8"


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


def polhode_figure(trajectory: Trajectory, wheel: Array | None = None) -> Figure:
    """Draw the polhode on the inertia ellipsoid ``Σ i_k ω_k² = 2E`` of the start, among its neighbours.

    Components are about the principal axes. Where the curve is behind the ellipsoid it is faint. Of a body
    that loses energy it is drawn as if it had that of the start. A wheel's momentum (3,) in body axes
    makes other neighbours.
    """
    require_times(trajectory)
    figure = new_figure(6.4, 6.4)
    axes = figure.add_subplot()
    moments = trajectory.inertia.principal_moments
    omega = (~trajectory.inertia.principal_frame)(trajectory.omega_body).components
    energies = 0.5 * (moments * omega**2).sum(axis=1)
    energy = float(energies[0])
    if energy == 0:
        axes.set_axis_off()
        axes.text(0.5, 0.5, "At rest: no polhode", ha="center", transform=axes.transAxes)
        return figure
    omega = omega * np.sqrt(energy / np.maximum(energies, np.finfo(float).tiny))[:, np.newaxis]
    semi_axes = np.sqrt(2 * energy / moments)
    view = _View()
    axes.fill(*view.silhouette(semi_axes).T, facecolor="#F4F6F8", edgecolor=_BLACK, lw=0.9, zorder=0)
    family = _polhode_family(moments, energy)
    if wheel is not None:
        h = (~trajectory.inertia.principal_frame)(vector(wheel)).components
        family = _wheel_family(moments, energy, h)
    for curve in family:
        view.curve(axes, curve, curve * moments, color=_FAINT, lw=0.8)
    for curve in _separatrix(moments, energy) if wheel is None else []:
        view.curve(axes, curve, curve * moments, color=_BLACK, lw=0.9, alpha=0.7)
    view.curve(axes, omega, omega * moments, color=_ORANGE, lw=2.0)
    start = view.project(omega[:1])[0]
    hidden = (omega[0] * moments) @ view.toward < 0
    axes.plot(*start, "o", color=_ORANGE, ms=6, mec="white", mew=0.8, zorder=5, alpha=0.4 if hidden else 1.0)
    _finish(axes, view, semi_axes, ("axis 1", "axis 2", "axis 3"))
    figure.suptitle(trajectory.attributes.get("title", "Polhode"))
    others = "\nGrey: other motions of the same energy."
    if wheel is None:
        others += " Black: the separatrix between turning\nabout the longest and the shortest axis."
    slowed = " (as it slows, drawn larger)" if energies.min() < 0.999 * energy else ""
    figure.supxlabel(
        f"Angular velocity in principal axes (moments {', '.join(f'{i:.4g}' for i in moments)} kg m²),\n"
        f"on the ellipsoid of its energy: orange, from the dot{slowed}.{others}",
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


def _wheel_family(moments: Array, energy: float, h: Array) -> list[Array]:
    """Return polhodes of one energy with a wheel of momentum h: where ``|I(ω) + h|`` has one size.

    Level curves over azimuth and height on the sphere ``u_k = ω_k √i_k``, ``|u|² = 2E``.
    """
    contour = optional("contourpy", "plot", "a figure").contour_generator

    def rates(azimuth: Array, height: Array) -> Array:
        across = np.sqrt(1 - height**2)
        u = np.stack([across * np.cos(azimuth), across * np.sin(azimuth), height], axis=-1)
        return np.asarray(np.sqrt(2 * energy / moments) * u)

    azimuth, height = np.meshgrid(
        np.linspace(-np.pi, np.pi, 181), np.sin(np.linspace(-1, 1, 121) * np.pi / 2)
    )
    sizes = np.linalg.norm(rates(azimuth, height) * moments + h, axis=-1)
    levels = sizes.min() + (sizes.max() - sizes.min()) * np.linspace(0.04, 0.96, 12)
    lines = contour(azimuth, height, sizes)
    return [rates(line[:, 0], np.clip(line[:, 1], -1, 1)) for level in levels for line in lines.lines(level)]


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
    require_times(trajectory)
    path = trajectory.rotor(vector(axis / np.linalg.norm(axis))).components
    caption = f"Path of {name} on the unit sphere of space axes (dot: start)."
    return _path_figure(trajectory, path, caption, ("e1", "e2", "e3"))


def orbit_figure(trajectory: Trajectory, path: Array, name: str) -> Figure:
    """Draw the path on the unit sphere of a direction (n, 3) given along the orbit, on its normal, and up."""
    require_times(trajectory)
    caption = (
        f"Path of {name} as seen on the orbit: up is away from the planet,\nalong is flight (dot: start)."
    )
    return _path_figure(trajectory, path, caption, ("along", "normal", "up"))


def _path_figure(trajectory: Trajectory, path: Array, caption: str, names: tuple[str, str, str]) -> Figure:
    figure = new_figure(6.4, 6.4)
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
    view.curve(axes, path, path, color=_ORANGE, lw=1.6)
    axes.plot(*view.project(path[:1])[0], "o", color=_ORANGE, ms=6, mec="white", mew=0.8, zorder=5)
    _finish(axes, view, sphere, names)
    figure.suptitle(trajectory.attributes.get("title", "Path of the axis"))
    figure.supxlabel(caption, fontsize=9)
    return figure
