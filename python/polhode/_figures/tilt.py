"""Locus and phase portrait of an axis: its path on the unit sphere; its angle against its rate."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode._algebra.constructors import bivector, vector
from polhode._figures.palette import BLACK, OTHERS, SPACE_AXES, TRACE
from polhode._figures.spheres import path_figure
from polhode._figures.style import NEW, Axes, Figure, Sheet, drawing, dress, mark
from polhode._mechanics.closed_forms import LagrangeTop
from polhode._mechanics.smooth import samples
from polhode._mechanics.trajectory import Trajectory
from polhode._report.motion_parameters import long_axis, main_axis
from polhode._support.arrays import Array

# Numbers of tilts and rates of the grid for curves of equal energy.
_GRID = (321, 241)
# Margin of a phase portrait beyond the tilts of the motion: a fraction of their span, at least this in rad.
_BEYOND, _LEAST = 0.35, 1e-5
# A tilt that changes by less than this, in rad/s, is constant.
_STILL = 1e-9


def locus_figure(trajectory: Trajectory, c: Array, view: Any = None, sheet: Sheet = NEW) -> Figure:
    """Draw the path of the axis from the fixed point to the centre of mass, and the bounds of its tilt."""
    axis = c / np.linalg.norm(c)
    path = samples(trajectory).rotor(vector(axis)).components
    top = _lagrange(trajectory, c)
    caption = (
        "Path on the unit sphere of the axis from the fixed point to the centre of mass, in space axes "
        "$e_k$, from the dot on; gravity is along $-e_3$. "
    )
    if top is None:
        low, high = (float(x) for x in np.degrees([_tilt(path).min(), _tilt(path).max()]))
        bounds = (np.radians(low), np.radians(high))
        caption += f"Black: the least and largest tilt reached, {low:.5g}° and {high:.5g}°. "
    else:
        about = top.describe()
        bounds = (about["tilt_min"], about["tilt_max"])
        low, high = (float(x) for x in np.degrees(bounds))
        caption += f"Black: the bounds of its tilt, {low:.5g}° and {high:.5g}°. "
    return path_figure.on(sheet, trajectory, path, caption + "Dashed: behind.", SPACE_AXES, bounds, view)


@drawing(5.2, 4.6, "Phase portrait")
def top_figure(figure: Figure, trajectory: Trajectory, c: Array) -> str:
    """Draw the tilt of a top's axis against its rate, among curves of equal energy with the same momenta."""
    theta, rate = _tilt_and_rate(trajectory, c / np.linalg.norm(c))
    axes = _portrait(figure, r"tilt $\theta$, degrees", r"$\dot{\theta}$, degrees/s")
    top = _lagrange(trajectory, c)
    caption = (
        r"Tilt $\theta$ from $e_3$ (up) of the axis from the fixed point to the centre of mass, and its rate"
    )
    if top is None:
        _draw(axes, theta, rate)
        return caption + ", from the dot on."
    about, fastest = top.describe(), float(np.nanmax(np.abs(rate), initial=0.0))
    if fastest <= _STILL and not about["precession_rate"]:
        _draw(axes, theta, np.nan_to_num(rate))
        return caption + ": the axis stands still."
    _draw_energy(axes, trajectory, c, about, fastest)
    _draw(axes, theta, rate)
    for bound in (about["tilt_min"], about["tilt_max"]):
        axes.axvline(np.degrees(bound), color=BLACK, lw=0.8, ls=(0, (4, 2)), zorder=1)
    return caption + (
        f", from the dot on. Black: the curve of its energy, {about['energy']:.5g} J; grey: others "
        f"with the same momentum about $e_3$, {about['vertical_momentum']:.5g} kg m²/s, and about the axis, "
        f"{about['axial_momentum']:.5g} kg m²/s. Dashed: the bounds of the tilt."
    )


@drawing(5.2, 4.6, "Phase portrait")
def satellite_figure(figure: Figure, trajectory: Trajectory) -> str:
    """Draw the angle of a satellite's long axis from up, in the orbit plane, against its rate."""
    along, _, up = long_axis(trajectory).T
    angle = np.unwrap(np.arctan2(along, up))
    rate = _rate_of(angle, trajectory.time)
    turns = 2 * np.pi * np.round(angle / (2 * np.pi))
    jumps = np.flatnonzero(np.diff(turns)) + 1
    axes = _portrait(figure, "angle from up, forward along the orbit, degrees", "its rate, degrees/s")
    _draw(axes, np.insert(angle - turns, jumps, np.nan), np.insert(rate, jumps, np.nan))
    return (
        "The angle of the axis of least moment from up in the orbit plane, from the dot on. Its rate is from "
        "finite differences between output times."
    )


@drawing(5.2, 4.6, "Phase portrait")
def angle_figure(figure: Figure, trajectory: Trajectory) -> str:
    """Draw the angle from e3 of the main axis of rotation, against its rate."""
    number, axis = main_axis(trajectory)
    axes = _portrait(
        figure,
        rf"angle $\theta$ of principal axis {number} from $e_3$, degrees",
        r"$\dot{\theta}$, degrees/s",
    )
    _draw(axes, *_tilt_and_rate(trajectory, axis))
    return f"The angle from $e_3$ of the main axis of rotation, $f_{number}$, from the dot on."


def _rate_of(angle: Array, time: Array) -> Array:
    """Return the rate of an angle (n,) by finite differences; equal times have equal rates."""
    moments, first, which = np.unique(time, return_index=True, return_inverse=True)
    if len(moments) < 2:
        return np.zeros_like(angle)
    rate: Array = np.gradient(angle[first], moments)[which]
    return rate


def _portrait(figure: Figure, angle: str, rate: str) -> Axes:
    """Return axes with these labels and a line at rate 0."""
    axes: Axes = figure.add_subplot(xlabel=angle, ylabel=rate)
    dress(axes)
    axes.axhline(0, color=BLACK, lw=0.5, zorder=1)
    return axes


def _draw(axes: Axes, angle: Array, rate: Array) -> None:
    """Draw a curve, given in rad and rad/s, in degrees."""
    x, y = np.degrees(angle), np.degrees(rate)
    axes.plot(x, y, color=TRACE, lw=1.3, zorder=3)
    mark(axes, (x[0], y[0]), TRACE)


def _lagrange(trajectory: Trajectory, c: Array) -> LagrangeTop | None:
    """Return the motion in closed form; None if the body is not symmetric about c."""
    try:
        return LagrangeTop(trajectory.inertia, trajectory.rotor[0], trajectory.omega_body[0], c)
    except ValueError:
        return None


def _tilt(path: Array) -> Array:
    """Return the angles (n,) of directions (n, 3) from e3."""
    angles: Array = np.arctan2(np.hypot(path[:, 0], path[:, 1]), path[:, 2])
    return angles


def _tilt_and_rate(trajectory: Trajectory, axis: Array) -> tuple[Array, Array]:
    """Return the angle from e3 of a direction n fixed in the body (3,) and its rate, by n' = n·Ω_S (4.4)."""
    states = samples(trajectory)
    n = states.rotor(vector(axis))
    moving = n.dot(states.rotor(states.omega_body)).components
    path = n.components
    across = np.hypot(path[:, 0], path[:, 1])
    # cos θ = n·e3, so −sin θ θ' = n'·e3. The rate of an upright axis has no sign: it is NaN.
    rate = np.full(len(across), np.nan)
    np.divide(-moving[:, 2], across, out=rate, where=across > 1e-9)
    return _tilt(path), rate


def _draw_energy(axes: Axes, trajectory: Trajectory, c: Array, about: dict[str, Any], fastest: float) -> None:
    """Draw curves of equal energy with the momenta of this motion about up and about its axis."""
    low, high = about["tilt_min"], about["tilt_max"]
    beyond = max(_BEYOND * (high - low), _LEAST)
    theta = np.linspace(max(low - beyond, 1e-4), min(high + beyond, np.pi - 1e-4), _GRID[0])
    reach = 1.45 * fastest if fastest > _STILL else beyond * about["precession_rate"]
    rate = np.linspace(-abs(reach), abs(reach), _GRID[1])
    energy = _energy(trajectory, c, about, theta, rate[:, np.newaxis])
    least, present = float(energy.min()), about["energy"]
    span = max(present - least, 1e-12 * abs(present))
    others = least + span * np.array([0.2, 0.6, 1.5, 2.1, 2.8, 3.6])
    x, y = np.degrees(theta), np.degrees(rate)
    axes.contour(x, y, energy, levels=others, colors=OTHERS, linewidths=0.8, zorder=1)
    axes.contour(x, y, energy, levels=[present], colors=BLACK, linewidths=2.6, zorder=2)
    axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))


def _energy(trajectory: Trajectory, c: Array, about: dict[str, Any], theta: Array, rate: Array) -> Array:
    """Return the energy of tops with these tilts and rates of the axis, and the momenta of this motion.

    In body axes: a along the axis, n along the line of nodes, w = a × n. Up is cos θ a + sin θ w. L has the
    given component along a, a component along w that gives the momentum about up, and I(θ' n).
    """
    size = float(np.linalg.norm(c))
    a = c / size
    n = np.cross(a, np.eye(3)[np.argmin(np.abs(a))])
    n /= np.linalg.norm(n)
    w = np.cross(a, n)
    theta, rate = np.broadcast_arrays(theta, rate)
    side = (about["vertical_momentum"] - about["axial_momentum"] * np.cos(theta)) / np.sin(theta)
    momentum = about["axial_momentum"] * a + side[..., np.newaxis] * w
    momentum = momentum + trajectory.inertia(bivector(rate[..., np.newaxis] * n)).components
    omega = trajectory.inertia.inverse(bivector(momentum)).components
    energy: Array = 0.5 * (omega * momentum).sum(axis=-1) + size * np.cos(theta)
    return energy
