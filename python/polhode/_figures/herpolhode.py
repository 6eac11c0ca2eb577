"""Herpolhode figure: the path of the angular velocity in the invariable plane."""

from __future__ import annotations

import numpy as np

from polhode._algebra.constructors import e3
from polhode._algebra.rotor import Rotor
from polhode._figures.palette import BLACK, HERPOLHODE, MOMENTUM
from polhode._figures.style import Axes, Figure, at_rest, drawing, dress, halo, mark, scaled_unit
from polhode._mechanics.free_motion import FreeMotion
from polhode._mechanics.smooth import samples
from polhode._mechanics.trajectory import Trajectory
from polhode._report.summary import time as time_text

# Samples of a period from which the least and largest distance from $L$ are found.
_POINTS = 4097
# Circles whose radii differ by less than this fraction are drawn as one.
_EQUAL = 1e-4


@drawing(5.2, 5.9, "Herpolhode")
def herpolhode_figure(figure: Figure, trajectory: Trajectory) -> str:
    """Draw ω of a free body in the invariable plane, which is perpendicular to L, between its two circles."""
    axes = figure.add_subplot()
    momentum = trajectory.momentum_space[0]
    if not float(momentum.norm()):
        return at_rest(axes, "herpolhode")
    # Into axes with L along the third one: the invariable plane is spanned by the first two.
    into_plane = ~Rotor.from_vectors(e3, momentum.dual().normalized())
    path = samples(trajectory)
    omega = into_plane(path.rotor(path.omega_body)).components
    free = FreeMotion(trajectory.inertia, trajectory.rotor[0], trajectory.omega_body[0])
    around = into_plane(free.herpolhode(_POINTS)).components
    power, per_second = scaled_unit(around[:, :2], "rad/s")
    omega, around = omega / power, around / power
    radii = np.hypot(around[:, 0], around[:, 1])
    least, largest = float(radii.min()), float(radii.max())
    _draw_annulus(axes, least, largest)
    turns = float(np.abs(np.diff(np.unwrap(np.arctan2(omega[:, 1], omega[:, 0])))).sum()) / (2 * np.pi)
    crowded = turns > 15 or 0.85 * largest < least < (1 - _EQUAL) * largest
    axes.plot(omega[:, 0], omega[:, 1], color=HERPOLHODE, lw=0.7 if crowded else 1.4, zorder=3)
    mark(axes, omega[0, :2], HERPOLHODE)
    axes.plot(0, 0, "+", color=MOMENTUM, ms=10, mew=1.8, zorder=6)
    label = axes.annotate("$L$", (0, 0), xytext=(6, 5), textcoords="offset points", color=MOMENTUM, zorder=6)
    label.set_path_effects([halo(3)])
    dress(axes)
    axes.set_aspect("equal")
    reach = 1.08 * largest if largest > 1e-9 * float(np.abs(omega).max()) else float(np.abs(omega).max())
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach))
    axes.set(xlabel=rf"$\omega$ along $g_1$, {per_second}", ylabel=rf"$\omega$ along $g_2$, {per_second}")
    return _caption(free, power * float(omega[0, 2]), power * least, power * largest)


def _draw_annulus(axes: Axes, least: float, largest: float) -> None:
    s = np.linspace(0, 2 * np.pi, 361)
    circle = np.stack([np.cos(s), np.sin(s)])
    axes.fill(*(largest * circle), facecolor="#F8F2E4", edgecolor="none", zorder=0)
    axes.fill(*(least * circle), facecolor="white", edgecolor="none", zorder=0)
    for radius in (least, largest) if largest > (1 + _EQUAL) * least else (largest,):
        axes.plot(*(radius * circle), color=BLACK, lw=0.8, ls=(0, (4, 2)), zorder=2)


def _caption(free: FreeMotion, distance: float, least: float, largest: float) -> str:
    period = free.describe()["period"]
    caption = (
        r"The angular velocity $\omega_S = -I\,\Omega_S$ in space, from the dot on. It stays in the "
        f"invariable plane, perpendicular to $L$ at a distance of {abs(distance):.5g} rad/s, $2E/|L|$, from "
        r"the fixed origin; $g_1\wedge g_2$ has the plane and sense of $L$."
    )
    if largest > (1 + _EQUAL) * least:
        caption += f" Dashed: its least and largest distance from $L$, {least:.4g} and {largest:.4g} rad/s"
        caption += f", each reached twice in a period of {time_text(period, 4)}." if period else "."
    elif largest > 1e-9 * abs(distance):
        caption += f" Dashed: its distance from $L$, {largest:.4g} rad/s, is constant."
    else:
        caption += " The rotation is steady: $\\omega$ is constant."
    return caption
