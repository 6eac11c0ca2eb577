"""The herpolhode: the path of the angular velocity in the invariable plane."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from polhode._algebra.constructors import e3
from polhode._algebra.rotor import Rotor
from polhode._figures.style import (
    _BLACK,
    HERPOLHODE,
    MOMENTUM,
    dress,
    entitle,
    explain,
    in_our_look,
    new_figure,
    title_of,
    told_in_powers,
)
from polhode._mechanics.free_motion import FreeMotion
from polhode._mechanics.smooth import rotor_at, samples
from polhode._report.text import time as told_time

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from polhode._mechanics.trajectory import Trajectory

# Points of a period in which the least and the largest distance from L are looked for.
_POINTS = 4097
# Two circles whose radii differ by less than this share are drawn as one.
_ALIKE = 1e-4


@in_our_look
def herpolhode_figure(trajectory: Trajectory) -> Figure:
    """Draw ω of a free body in the plane across L in which it stays, between its two circles."""
    figure = new_figure(5.2, 5.9)
    axes = figure.add_subplot()
    entitle(figure, title_of(trajectory, "Herpolhode"))
    momentum = trajectory.momentum_space[0]
    if not float(momentum.norm()):
        axes.set_axis_off()
        axes.text(0.5, 0.5, "At rest: no herpolhode", ha="center", transform=axes.transAxes)
        return figure
    # Turned so that L lies along the third axis; its plane then has the first two.
    into_plane = ~Rotor.from_vectors(e3, momentum.dual().normalized())
    path = samples(trajectory)
    omega = into_plane(path.rotor(path.omega_body)).components
    free = FreeMotion(trajectory.inertia, rotor_at(trajectory, 0), trajectory.omega_body[0])
    around = into_plane(free.herpolhode(_POINTS)).components
    power, per_second = told_in_powers(around[:, :2], "rad/s")
    omega, around = omega / power, around / power
    radii = np.hypot(around[:, 0], around[:, 1])
    least, largest = float(radii.min()), float(radii.max())
    _draw_annulus(axes, least, largest)
    turns = float(np.abs(np.diff(np.unwrap(np.arctan2(omega[:, 1], omega[:, 0])))).sum()) / (2 * np.pi)
    crowded = turns > 15 or 0.85 * largest < least < (1 - _ALIKE) * largest
    axes.plot(omega[:, 0], omega[:, 1], color=HERPOLHODE, lw=0.7 if crowded else 1.4, zorder=3)
    axes.plot(*omega[0, :2], "o", color=HERPOLHODE, ms=6, mec="white", mew=0.8, zorder=5)
    axes.plot(0, 0, "+", color=MOMENTUM, ms=10, mew=1.8, zorder=6)
    axes.annotate("L", (0, 0), xytext=(6, 5), textcoords="offset points", color=MOMENTUM, zorder=6)
    dress(axes)
    axes.set_aspect("equal")
    reach = 1.08 * largest if largest > 1e-9 * float(np.abs(omega).max()) else float(np.abs(omega).max())
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach))
    axes.set_xlabel(f"ω along g₁, {per_second}")
    axes.set_ylabel(f"ω along g₂, {per_second}")
    explain(figure, _told(free, power * float(omega[0, 2]), power * least, power * largest))
    return figure


def _draw_annulus(axes: Axes, least: float, largest: float) -> None:
    s = np.linspace(0, 2 * np.pi, 361)
    circle = np.stack([np.cos(s), np.sin(s)])
    axes.fill(*(largest * circle), facecolor="#EAF5F1", edgecolor="none", zorder=0)
    axes.fill(*(least * circle), facecolor="white", edgecolor="none", zorder=0)
    for radius in (least, largest) if largest > (1 + _ALIKE) * least else (largest,):
        axes.plot(*(radius * circle), color=_BLACK, lw=0.8, ls=(0, (4, 2)), zorder=2)


def _told(free: FreeMotion, distance: float, least: float, largest: float) -> str:
    period = free.describe()["period"]
    told = (
        "The angular velocity ω_S = −I Ω_S in space, from the dot. It stays in the "
        f"invariable plane, across L at {abs(distance):.5g} rad/s = 2E/|L| from the fixed "
        "origin; g₁∧g₂ is the plane and sense of L."
    )
    if largest > (1 + _ALIKE) * least:
        told += f" Dashed: its least and largest distance from L, {least:.4g} and {largest:.4g} rad/s"
        told += f", each passed twice in a period of {told_time(period, 4)}." if period else "."
    elif largest > 1e-9 * abs(distance):
        told += f" Dashed: its distance from L, {largest:.4g} rad/s, is always the same."
    else:
        told += " The turning is steady: it stays in one point."
    return told
