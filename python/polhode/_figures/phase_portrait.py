"""Phase portraits of torque-free bodies: motions of one |L| on the momentum sphere."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode._algebra.constructors import bivector
from polhode._figures.camera import View, view_of
from polhode._figures.palette import AXES, POLHODE
from polhode._figures.spheres import _EQUAL, Frame, Portrait, family, level_curves, separatrix
from polhode._figures.style import Axes, Figure, at_rest, drawing, dress, mark
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.smooth import samples
from polhode._mechanics.trajectory import Trajectory
from polhode._support.arrays import Array

# Starts of the neighbouring motions: angles in rad from an axis of extreme moment towards the middle one.
_STARTS = np.radians([15, 35, 55, 75])


@drawing(7, 4.1, "Phase portrait")
def phase_figure(figure: Figure, trajectory: Trajectory, wheel: Array, view: Any = None) -> str:
    """Draw L/|L| in principal axes, on the sphere and on its equal-area map.

    L/|L| of a damped body stays on the curve of the free one. With a wheel of momentum (3,) in body axes the
    neighbours are those with the same wheel.
    """
    moments = trajectory.inertia.principal_moments
    to_principal = ~trajectory.inertia.principal_frame
    momentum = to_principal(trajectory.inertia(samples(trajectory).omega_body) + bivector(wheel)).components
    size = np.linalg.norm(momentum, axis=1)
    if not size.all():
        return at_rest(figure.add_subplot(), "phase portrait")
    path = momentum / size[:, np.newaxis]
    frame = _chosen_frame(moments, path)
    h = to_principal(bivector(wheel)).components / size[0]
    with_wheel = bool(np.any(h))
    shown = Portrait(path, *(_with_wheel(moments, h, frame) if with_wheel else _without_wheel(moments)))
    sphere, flat = figure.subplots(1, 2, width_ratios=(1, 1.25))
    shown.draw(sphere, _view(view, frame), np.ones(3), 1.0, ("$L_1$", "$L_2$", "$L_3$"))
    _draw_map(flat, frame, shown)
    caption = (
        r"Thick: $L$ in the body, $L_B = \Sigma\,L_k\,I e_k$ about principal axes $e_k$, over $|L|$, from "
        f"the dot on; moments {', '.join(f'{i:.4g}' for i in moments)} kg m². "
    )
    if shown.family:
        caption += f"Grey: other motions of this $|L|${' with this wheel' if with_wheel else ''}. "
    if shown.divides:
        caption += "Black: the separatrix through both ends of the axis of the middle moment. "
    if not shown.family:
        caption += "All moments are equal: $L$ is constant. "
    start = f"{'-' if frame.sign < 0 else ''}e_{frame.center + 1}"
    return caption + (
        "Left: the sphere (dashed: behind). Right: its equal-area map; the azimuth is from "
        f"${start}$ towards $e_{frame.right + 1}$."
    )


def _chosen_frame(moments: Array, path: Array) -> Frame:
    """Put the extreme axis that L circles in the middle of the map, and the other extreme one at the top.

    The axis of a symmetric body is at the top.
    """
    low, middle, high = (int(k) for k in np.argsort(moments, kind="stable"))
    if moments[middle] - moments[low] <= _EQUAL * moments[high]:
        center, up = low, high
    elif moments[high] - moments[middle] <= _EQUAL * moments[high]:
        center, up = high, low
    else:
        # The axis whose component stays farther from zero; on the separatrix, that of the larger component.
        center = max((low, high), key=lambda k: (np.abs(path[:, k]).min(), np.abs(path[:, k]).max()))
        up = high if center == low else low
    right = ({0, 1, 2} - {center, up}).pop()
    return Frame(center, right, up, 1.0 if path[:, center].mean() >= 0 else -1.0)


def _view(view: Any, frame: Frame) -> View:
    """Return the view, by default at the axis in the middle from slightly right and above."""
    if view is not None:
        return view_of(view)
    gaze = np.zeros(3)
    gaze[frame.center], gaze[frame.right], gaze[frame.up] = frame.sign, 0.55, 0.4
    x, y, z = gaze
    return View(float(np.degrees(np.arctan2(y, x))), float(np.degrees(np.arctan2(z, np.hypot(x, y)))))


def _without_wheel(moments: Array) -> tuple[list[Array], list[Array]]:
    """Return L/|L| (n, 3) of other free motions, and the separatrix: curves of equal ``Σ u_k² / i_k``."""
    return family(-1 / moments, (np.sin(_STARTS) ** 2).tolist()), separatrix(-1 / moments)


def _with_wheel(moments: Array, h: Array, frame: Frame) -> tuple[list[Array], list[Array]]:
    """Return L/|L| (n, 3) of other motions with the wheel, curves of equal energy of the body."""
    inertia = Inertia.from_principal_moments(*moments.tolist())

    def energy(u: Array) -> Array:
        omega = inertia.inverse(bivector(u - h)).components
        return np.asarray(0.5 * (omega * (u - h)).sum(axis=-1))

    return level_curves(energy, lambda found: np.quantile(found, np.linspace(0.03, 0.97, 12)), frame), []


def _draw_map(axes: Axes, frame: Frame, shown: Portrait) -> None:
    for curve, style in shown.styled():
        _draw_on_map(axes, curve, frame, **style)
    azimuth, height = _on_map(shown.path[:1], frame)
    mark(axes, (np.degrees(azimuth), height), POLHODE)
    _name_axes(axes, frame)
    dress(axes)
    axes.grid(visible=False)
    axes.set(xlim=(-180, 180), ylim=(-1, 1), xticks=range(-180, 181, 90))
    axes.set_xlabel("azimuth of $L$, degrees")
    axes.set_ylabel(f"$L$ along $e_{frame.up + 1}$, over $|L|$")
    axes.spines[["top", "right"]].set_visible(True)


def _draw_on_map(axes: Axes, curve: Array, frame: Frame, **style: Any) -> None:
    """Draw a curve (n, 3), repeated by whole turns where it crosses the edge."""
    azimuth, height = _on_map(curve, frame)
    azimuth = np.degrees(np.unwrap(azimuth))
    first = np.floor((azimuth.min() + 180) / 360)
    last = np.floor((azimuth.max() + 180) / 360)
    for turn in np.arange(first, last + 1):
        axes.plot(azimuth - 360 * turn, height, **style)


def _on_map(points: Array, frame: Frame) -> tuple[Array, Array]:
    return np.arctan2(points[:, frame.right], frame.sign * points[:, frame.center]), points[:, frame.up]


def _name_axes(axes: Axes, frame: Frame) -> None:
    """Mark the ends of the two axes on the equator."""
    for k, sign, azimuth, side, offset in (
        (frame.center, frame.sign, 0, "center", 0),
        (frame.center, -frame.sign, -180, "left", 5),
        (frame.center, -frame.sign, 180, "right", -5),
        (frame.right, 1.0, 90, "center", 0),
        (frame.right, -1.0, -90, "center", 0),
    ):
        axes.plot(azimuth, 0, ".", color=AXES[k], ms=5, zorder=4, clip_on=False)
        axes.annotate(
            f"${'-' if sign < 0 else ''}e_{k + 1}$", (azimuth, 0), xytext=(offset, 6), ha=side,
            textcoords="offset points", color=AXES[k], fontsize="medium", zorder=6,
            bbox={"fc": "white", "ec": "none", "alpha": 0.7, "pad": 0.6},
        )  # fmt: skip
