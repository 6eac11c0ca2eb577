"""Polhodes on the inertia ellipsoid, and paths of axes on the unit sphere."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._algebra.constructors import vector
from polhode._figures.camera import view_of
from polhode._figures.style import (
    _AXES,
    _BLACK,
    OTHERS,
    POLHODE,
    SPACE_AXES,
    TRACE,
    entitle,
    explain,
    in_our_look,
    new_figure,
    require_times,
    title_of,
)
from polhode._mechanics.smooth import samples
from polhode._support.arrays import Array
from polhode._support.extras import optional

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from polhode._mechanics.trajectory import Trajectory

# Points of curves from formulas.
_POINTS = 361


@in_our_look
def polhode_figure(trajectory: Trajectory, wheel: Array | None = None, view: Any = None) -> Figure:
    """Draw the polhode on the inertia ellipsoid ``Σ i_k ω_k² = 2E`` of the start, among its neighbours.

    Components are about the principal axes; parts behind the ellipsoid are dashed and pale. The polhode of a
    body that loses energy is scaled to the energy of the start. With a wheel of momentum (3,) in body axes,
    the neighbours are those with the same wheel.
    """
    require_times(trajectory)
    figure = new_figure(5.2, 5.6)
    axes = figure.add_subplot()
    entitle(figure, title_of(trajectory, "Polhode"))
    moments = trajectory.inertia.principal_moments
    to_principal = ~trajectory.inertia.principal_frame
    omega = to_principal(samples(trajectory).omega_body).components
    energies = 0.5 * (moments * omega**2).sum(axis=1)
    energy = float(energies[0])
    if energy == 0:
        axes.set_axis_off()
        axes.text(0.5, 0.5, "At rest: no polhode", ha="center", transform=axes.transAxes)
        return figure
    omega = omega * np.sqrt(energy / np.maximum(energies, np.finfo(float).tiny))[:, np.newaxis]
    semi_axes = np.sqrt(2 * energy / moments)
    look = view_of(view)
    look.ellipsoid(axes, semi_axes)
    if wheel is None:
        family, divides = _polhode_family(moments, energy), _separatrix(moments, energy)
    else:
        family, divides = _wheel_family(moments, energy, to_principal(vector(wheel)).components), []
    for curve in family:
        look.curve(axes, curve, curve * moments, color=OTHERS, lw=0.8)
    for curve in divides:
        look.curve(axes, curve, curve * moments, color=_BLACK, lw=0.9)
    look.curve(axes, omega, omega * moments, color=POLHODE, lw=2.0)
    look.dot(axes, omega[0], omega[0] * moments, color=POLHODE)
    look.finish(axes, semi_axes, ("ω₁", "ω₂", "ω₃"), _AXES)
    explain(figure, _polhode_caption(moments, energies, bool(family), bool(divides)))
    return figure


def _polhode_caption(moments: Array, energies: Array, family: bool, divides: bool) -> str:
    slowed = " (scaled up as the body slows)" if energies.min() < 0.999 * energies[0] else ""
    caption = (
        "Thick: the angular velocity Ω_B = Σ ωₖ I eₖ about principal axes eₖ, from the dot on"
        f"{slowed}, on the ellipsoid i₁ω₁² + i₂ω₂² + i₃ω₃² = 2E with i = "
        f"{', '.join(f'{i:.4g}' for i in moments)} kg m², E = {energies[0]:.4g} J. "
    )
    if family:
        caption += "Grey: other motions of this energy. "
    if divides:
        caption += "Black: the separatrix between rotation about the axes of least and greatest moment. "
    return caption + "Dashed: behind."


def _polhode_family(moments: Array, energy: float) -> list[Array]:
    """Return polhodes of one energy around the axes of least and greatest moment.

    With ``u_k = ω_k √i_k`` on the sphere ``|u|² = 2E``, ``Σ (i_c − i_k) u_k² = 2E i_c − G²`` is an
    ellipse in the plane of the other two axes; it is centred on axis c.
    """
    order = np.argsort(moments, kind="stable")
    if moments[order[0]] == moments[order[2]]:
        return []
    s = np.linspace(0, 2 * np.pi, _POINTS)
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
    """Return polhodes of one energy with a wheel of momentum h: level curves of ``|I(ω) + h|``.

    They are taken over azimuth and height on the sphere ``u_k = ω_k √i_k``, ``|u|² = 2E``.
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
    s = np.linspace(0, 2 * np.pi, _POINTS)
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
    path = samples(trajectory).rotor(vector(axis / np.linalg.norm(axis))).components
    caption = f"Path of {name} on the unit sphere of space axes eₖ, from the dot on. Dashed: behind."
    return path_figure(trajectory, path, caption, SPACE_AXES)


def orbit_figure(trajectory: Trajectory, path: Array, name: str) -> Figure:
    """Draw the path on the unit sphere of a direction (n, 3) in orbit axes: along, normal, up."""
    require_times(trajectory)
    caption = (
        f"Path of {name} in orbit axes, from the dot on: up is away from the planet, along is the direction "
        "of flight. Dashed: behind."
    )
    return path_figure(trajectory, path, caption, ("along", "normal", "up"))


@in_our_look
def path_figure(
    trajectory: Trajectory,
    path: Array,
    caption: str,
    names: tuple[str, str, str],
    bounds: tuple[float, ...] = (),
    view: Any = None,
) -> Figure:
    """Draw a path (n, 3) on the unit sphere; `bounds`, angles from the third axis in rad, are marked."""
    figure = new_figure(5.2, 5.6)
    axes = figure.add_subplot()
    look = view_of(view)
    sphere = np.ones(3)
    look.ellipsoid(axes, sphere)
    for angle in np.radians([30, 60, 90, 120, 150]):
        look.curve(axes, *_parallel(angle), color=OTHERS, lw=0.6)
    for angle in bounds:
        look.curve(axes, *_parallel(angle), color=_BLACK, lw=1.0)
    look.curve(axes, path, path, color=TRACE, lw=1.5)
    look.dot(axes, path[0], path[0], color=TRACE)
    look.finish(axes, sphere, names, (_BLACK, _BLACK, _BLACK))
    entitle(figure, title_of(trajectory, "Path of the axis"))
    explain(figure, caption)
    return figure


def _parallel(angle: float) -> tuple[Array, Array]:
    """Return the circle (n, 3) of the unit sphere at an angle from the third axis, and its normals."""
    s = np.linspace(0, 2 * np.pi, _POINTS)
    across, up = np.sin(angle), np.full_like(s, np.cos(angle))
    circle = np.stack([across * np.cos(s), across * np.sin(s), up], axis=1)
    return circle, circle
