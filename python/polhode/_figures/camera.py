"""Orthographic views of curves on convex surfaces, for plots."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from polhode._figures.palette import BLACK
from polhode._figures.style import Axes
from polhode._support.arrays import Array, as_floats

# Default direction of view: azimuth from e1 towards e2 and elevation above e1∧e2, in degrees.
DEFAULT = (35.0, 22.0)

_SHADE = "#F4F6F8"
_HIDDEN = {"alpha": 0.45, "ls": (0, (2.5, 2.0)), "zorder": 1, "label": None, "dash_capstyle": "butt"}


class View:
    """Orthographic view from an azimuth and elevation in degrees; e3 is up."""

    def __init__(self, azimuth: float = DEFAULT[0], elevation: float = DEFAULT[1]) -> None:
        a, e = np.radians([azimuth, elevation])
        self.toward = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        self.basis = np.stack([right, np.cross(self.toward, right)])

    def project(self, points: Array) -> Array:
        """Return the image coordinates (..., 2) of points (..., 3)."""
        flat: Array = points @ self.basis.T
        return flat

    def curve(self, axes: Axes, points: Array, normals: Array, **style: Any) -> None:
        """Draw a curve on a convex surface: solid in front, dashed and pale behind.

        Both parts end where the curve crosses the outline.
        """
        facing = normals @ self.toward
        points, facing = _with_crossings(points, facing)
        flat = self.project(points)
        front = np.where((facing >= 0)[:, np.newaxis], flat, np.nan)
        back = np.where((facing <= 0)[:, np.newaxis], flat, np.nan)
        alpha = style.pop("alpha", 1.0)
        width = 0.75 * style.get("lw", 1.0)
        axes.plot(*back.T, **{**style, **_HIDDEN, "alpha": _HIDDEN["alpha"] * alpha, "lw": width})
        axes.plot(*front.T, alpha=alpha, zorder=3, **style)

    def dot(self, axes: Axes, point: Array, normal: Array, **style: Any) -> None:
        """Mark a point on a convex surface, hollow if it is behind."""
        hidden = float(normal @ self.toward) < 0
        look = {"ms": 6, "mec": "white", "mew": 0.8, "zorder": 5, **style}
        if hidden:
            look |= {"mfc": "white", "mec": style["color"], "mew": 1.2, "alpha": 0.6, "zorder": 2}
        axes.plot(*self.project(point), "o", **look)

    def silhouette(self, semi_axes: Array) -> Array:
        """Return the outline (n, 2) of an ellipsoid, where its normal is perpendicular to the view."""
        # The surface point is S u with |u| = 1 and normal S⁻¹ u: perpendicular when u ⟂ S⁻¹ toward.
        n = self.toward / semi_axes
        first = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
        first /= np.linalg.norm(first)
        second = np.cross(n, first) / np.linalg.norm(n)
        s = np.linspace(0, 2 * np.pi, 361)[:, np.newaxis]
        return self.project(semi_axes * (np.cos(s) * first + np.sin(s) * second))

    def ellipsoid(self, axes: Axes, semi_axes: Array) -> None:
        """Draw an ellipsoid, below the curves on it."""
        outline = self.silhouette(semi_axes)
        axes.fill(*outline.T, facecolor=_SHADE, edgecolor=BLACK, lw=0.9, zorder=0)

    def finish(self, axes: Axes, semi_axes: Array, names: Sequence[str], colours: Sequence[str]) -> None:
        """Draw the positive half of each axis outside the ellipsoid, and set the limits."""
        reach = 0.35 * float(np.max(semi_axes))
        room = [self.silhouette(semi_axes)]
        for k, (name, colour) in enumerate(zip(names, colours, strict=True)):
            unit = np.eye(3)[k]
            hidden = float(self.toward[k]) < 0
            start, end = self.project(np.stack([unit * semi_axes[k], unit * (semi_axes[k] + reach)]))
            label = end + 0.25 * reach * (end - start) / max(float(np.linalg.norm(end - start)), 1e-12)
            arrow = {"arrowstyle": "-|>", "color": colour, "lw": 1.4, "shrinkA": 0, "shrinkB": 0}
            # Below the ellipsoid, whose fill covers the part inside its outline.
            axes.annotate("", xy=end, xytext=start, arrowprops=arrow, zorder=-1 if hidden else 4)
            axes.text(label[0], label[1], name, color=colour, ha="center", va="center", zorder=5)
            room.append(label[np.newaxis])
        frame_picture(axes, np.concatenate(room), 0.25 * reach)


def frame_picture(axes: Axes, points: Array, margin: float) -> None:
    """Set limits around points (n, 2), with equal scales and without axes."""
    low, high = points.min(axis=0) - margin, points.max(axis=0) + margin
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")
    axes.set_axis_off()


def view_of(view: Any) -> View:
    """Return the view that a caller asks for, see `angles_of`; the default one for None."""
    return View(*(angles_of(view) or DEFAULT))


def angles_of(view: Any) -> tuple[float, float] | None:
    """Return azimuth and elevation in degrees, or None for None; a ValueError for anything else."""
    if view is None:
        return None
    angles = as_floats(view, "view")
    if angles.shape != (2,) or not np.isfinite(angles).all():
        raise ValueError(f"view is {view!r}; it must be azimuth and elevation in degrees, such as (35, 22)")
    return float(angles[0]), float(angles[1])


def _with_crossings(points: Array, facing: Array) -> tuple[Array, Array]:
    """Insert the points where `facing` changes its sign, with 0 there."""
    at = np.flatnonzero(facing[:-1] * facing[1:] < 0)
    share = (facing[at] / (facing[at] - facing[at + 1]))[:, np.newaxis]
    crossings = points[at] + share * (points[at + 1] - points[at])
    return np.insert(points, at + 1, crossings, axis=0), np.insert(facing, at + 1, 0.0)
