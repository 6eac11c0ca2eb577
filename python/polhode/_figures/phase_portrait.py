"""Phase portraits of torque-free bodies: motions of one |L| on the momentum sphere."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from polhode._algebra.constructors import bivector
from polhode._algebra.rotor import Rotor
from polhode._figures.camera import View, view_of
from polhode._figures.style import (
    _AXES,
    _BLACK,
    OTHERS,
    POLHODE,
    dress,
    entitle,
    explain,
    in_our_look,
    new_figure,
    title_of,
)
from polhode._mechanics.free_motion import FreeMotion
from polhode._mechanics.smooth import samples
from polhode._support.arrays import Array
from polhode._support.extras import optional

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from polhode._mechanics.trajectory import Trajectory

# Starts of the neighbouring motions: angles in rad from an axis of extreme moment towards the middle one.
_STARTS = np.radians([15, 35, 55, 75])
_POINTS = 241
# Relative difference of moments that counts as rounding.
_EQUAL = 1e-9


class _Axes(NamedTuple):
    """Numbers (from 0) of principal axes: in the middle of the map, to the right of it, and above."""

    center: int
    right: int
    up: int
    # 1 or −1: the half of the central axis that the motion is about.
    sign: float


@in_our_look
def phase_figure(trajectory: Trajectory, wheel: Array, view: Any = None) -> Figure:
    """Draw L/|L| in principal axes, on the sphere and on its equal-area map.

    L/|L| of a damped body stays on the curve of the free one. With a wheel of momentum (3,) in body axes the
    neighbours are those with the same wheel.
    """
    moments = trajectory.inertia.principal_moments
    to_principal = ~trajectory.inertia.principal_frame
    momentum = to_principal(trajectory.inertia(samples(trajectory).omega_body) + bivector(wheel)).components
    size = np.linalg.norm(momentum, axis=1)
    figure = new_figure(7, 4.1)
    entitle(figure, title_of(trajectory, "Phase portrait"))
    if not size.all():
        axes = figure.add_subplot()
        axes.set_axis_off()
        axes.text(0.5, 0.5, "At rest: no phase portrait", ha="center", transform=axes.transAxes)
        return figure
    path = momentum / size[:, np.newaxis]
    chosen = _chosen_axes(moments, path)
    h = to_principal(bivector(wheel)).components / size[0]
    with_wheel = bool(np.any(h))
    family = _family_with_wheel(moments, h, chosen) if with_wheel else _family(moments)
    divides = [] if with_wheel else _separatrix(moments)
    sphere, flat = figure.subplots(1, 2, width_ratios=(1, 1.25))
    _draw_sphere(sphere, _view(view, chosen), path, family, divides)
    _draw_map(flat, chosen, path, family, divides)
    explain(figure, _caption(moments, with_wheel, bool(family), bool(divides)))
    return figure


def _chosen_axes(moments: Array, path: Array) -> _Axes:
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
    return _Axes(center, right, up, 1.0 if path[:, center].mean() >= 0 else -1.0)


def _view(view: Any, chosen: _Axes) -> View:
    """Return the view, by default at the axis in the middle from slightly right and above."""
    if view is not None:
        return view_of(view)
    gaze = np.zeros(3)
    gaze[chosen.center], gaze[chosen.right], gaze[chosen.up] = chosen.sign, 0.55, 0.4
    x, y, z = gaze
    return View(float(np.degrees(np.arctan2(y, x))), float(np.degrees(np.arctan2(z, np.hypot(x, y)))))


def _family(moments: Array) -> list[Array]:
    """Return L/|L| (n, 3) of other free motions, about both ends of the axes of extreme moments."""
    order = [int(k) for k in np.argsort(moments, kind="stable")]
    low, middle, high = order
    if moments[high] - moments[low] <= _EQUAL * moments[high]:
        return []
    starts = []
    for axis, other in ((low, middle), (high, middle)):
        # An axis with the same moment as the middle one: rotation about it is steady.
        if abs(moments[axis] - moments[other]) <= _EQUAL * moments[high]:
            continue
        for angle in _STARTS:
            for sign in (1.0, -1.0):
                momentum = np.zeros(3)
                momentum[axis], momentum[other] = sign * np.cos(angle), np.sin(angle)
                starts.append(momentum)
    free = FreeMotion(_principal(moments), Rotor.identity(), bivector(np.array(starts) / moments))
    return list(free.polhode(_POINTS).components * moments)


def _principal(moments: Array) -> Any:
    from polhode._mechanics.bodies import Inertia

    return Inertia.from_principal_moments(*(float(i) for i in moments))


def _separatrix(moments: Array) -> list[Array]:
    """Return the two great circles (n, 3) on which the energy is that of rotation about the middle axis.

    There ``L_low² (1/i_low − 1/i_mid) = L_high² (1/i_mid − 1/i_high)``.
    """
    low, middle, high = np.argsort(moments, kind="stable")
    below = 1 / moments[low] - 1 / moments[middle]
    above = 1 / moments[middle] - 1 / moments[high]
    if min(below, above) <= _EQUAL / moments[high]:
        return []
    s = np.linspace(0, 2 * np.pi, _POINTS)
    circles = []
    for sign in (1.0, -1.0):
        circle = np.zeros((s.size, 3))
        circle[:, middle] = np.sin(s)
        circle[:, low] = np.cos(s) * np.sqrt(above / (above + below))
        circle[:, high] = sign * np.cos(s) * np.sqrt(below / (above + below))
        circles.append(circle)
    return circles


def _family_with_wheel(moments: Array, h: Array, chosen: _Axes) -> list[Array]:
    """Return L/|L| of other motions with the wheel: curves of equal energy of the body."""
    contours = optional("contourpy", "plot", "a figure").contour_generator
    azimuth, height = np.meshgrid(
        np.linspace(-np.pi, np.pi, 241), np.sin(np.linspace(-1, 1, 161) * np.pi / 2)
    )
    momentum = _on_sphere(azimuth, height, chosen)
    omega = _principal(moments).inverse(bivector(momentum - h)).components
    energy = 0.5 * (omega * (momentum - h)).sum(axis=-1)
    levels = np.quantile(energy, np.linspace(0.03, 0.97, 12))
    lines = contours(azimuth, height, energy)
    return [
        _on_sphere(line[:, 0], np.clip(line[:, 1], -1, 1), chosen)
        for level in levels
        for line in lines.lines(level)
    ]


def _on_sphere(azimuth: Array, height: Array, chosen: _Axes) -> Array:
    """Return the directions (..., 3) at azimuths and heights of the map."""
    directions = np.empty((*np.shape(azimuth), 3))
    across = np.sqrt(1 - height**2)
    directions[..., chosen.center] = chosen.sign * across * np.cos(azimuth)
    directions[..., chosen.right] = across * np.sin(azimuth)
    directions[..., chosen.up] = height
    return directions


def _draw_sphere(axes: Axes, look: View, path: Array, family: list[Array], divides: list[Array]) -> None:
    look.ellipsoid(axes, np.ones(3))
    for curve in family:
        look.curve(axes, curve, curve, color=OTHERS, lw=0.8)
    for curve in divides:
        look.curve(axes, curve, curve, color=_BLACK, lw=0.9)
    look.curve(axes, path, path, color=POLHODE, lw=2.0)
    look.dot(axes, path[0], path[0], color=POLHODE)
    look.finish(axes, np.ones(3), ("L₁", "L₂", "L₃"), _AXES)


def _draw_map(axes: Axes, chosen: _Axes, path: Array, family: list[Array], divides: list[Array]) -> None:
    for curve in family:
        _draw_on_map(axes, curve, chosen, color=OTHERS, lw=0.8, zorder=1)
    for curve in divides:
        _draw_on_map(axes, curve, chosen, color=_BLACK, lw=0.9, zorder=2)
    _draw_on_map(axes, path, chosen, color=POLHODE, lw=2.0, zorder=3)
    azimuth, height = _on_map(path[:1], chosen)
    axes.plot(np.degrees(azimuth), height, "o", color=POLHODE, ms=6, mec="white", mew=0.8, zorder=5)
    _name_axes(axes, chosen)
    dress(axes)
    axes.grid(visible=False)
    axes.set(xlim=(-180, 180), ylim=(-1, 1), xticks=range(-180, 181, 90))
    center, right, up = (f"e{'₁₂₃'[k]}" for k in chosen[:3])
    sign = "−" if chosen.sign < 0 else ""
    axes.set_xlabel(f"azimuth of L from {sign}{center} towards {right}, degrees")
    axes.set_ylabel(f"L along {up}, over |L|")
    axes.spines[["top", "right"]].set_visible(True)


def _draw_on_map(axes: Axes, curve: Array, chosen: _Axes, **style: Any) -> None:
    """Draw a curve (n, 3), repeated by whole turns where it crosses the edge."""
    azimuth, height = _on_map(curve, chosen)
    azimuth = np.degrees(np.unwrap(azimuth))
    first = np.floor((azimuth.min() + 180) / 360)
    last = np.floor((azimuth.max() + 180) / 360)
    for turn in np.arange(first, last + 1):
        axes.plot(azimuth - 360 * turn, height, **style)


def _on_map(points: Array, chosen: _Axes) -> tuple[Array, Array]:
    return np.arctan2(points[:, chosen.right], chosen.sign * points[:, chosen.center]), points[:, chosen.up]


def _name_axes(axes: Axes, chosen: _Axes) -> None:
    """Mark the ends of the two axes on the equator."""
    for k, sign, azimuths in (
        (chosen.center, chosen.sign, (0,)),
        (chosen.center, -chosen.sign, (-180, 180)),
        (chosen.right, 1.0, (90,)),
        (chosen.right, -1.0, (-90,)),
    ):
        for azimuth in azimuths:
            axes.plot(azimuth, 0, ".", color=_AXES[k], ms=5, zorder=4, clip_on=False)
            name = f"{'−' if sign < 0 else ''}e{'₁₂₃'[k]}"
            beside = {-180: ("left", 5), 180: ("right", -5)}.get(azimuth, ("center", 0))
            axes.annotate(
                name, (azimuth, 0), xytext=(beside[1], 6), textcoords="offset points",
                ha=beside[0], color=_AXES[k], fontsize=8.5, zorder=6,
                bbox={"fc": "white", "ec": "none", "alpha": 0.7, "pad": 0.6},
            )  # fmt: skip


def _caption(moments: Array, with_wheel: bool, family: bool, divides: bool) -> str:
    caption = (
        "Thick: L in the body, L_B = Σ Lₖ I eₖ about principal axes eₖ, over |L|, from the dot on; "
        f"moments {', '.join(f'{i:.4g}' for i in moments)} kg m². "
    )
    if family:
        caption += f"Grey: other motions of this |L|{' with this wheel' if with_wheel else ''}. "
    if divides:
        caption += "Black: the separatrix through both ends of the axis of the middle moment. "
    if not family:
        caption += "All moments are equal: L is constant. "
    return caption + "Left: the sphere (dashed: behind). Right: its equal-area map."
