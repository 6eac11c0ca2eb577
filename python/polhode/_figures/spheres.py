"""Polhodes on the inertia ellipsoid, paths of axes on the unit sphere, and families of level curves."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from polhode._algebra.constructors import vector
from polhode._figures.camera import View, view_of
from polhode._figures.palette import AXES, BLACK, OTHERS, POLHODE, SPACE_AXES, TRACE
from polhode._figures.style import Axes, Figure, at_rest, drawing, plotting, require_times
from polhode._mechanics.smooth import samples
from polhode._mechanics.trajectory import Trajectory
from polhode._support.arrays import Array

# Points of curves from formulas.
_POINTS = 361
# Relative difference of weights that counts as rounding.
_EQUAL = 1e-9


class Frame(NamedTuple):
    """Numbers (from 0) of axes: in the middle of a map of the sphere, to the right of it, and above."""

    center: int
    right: int
    up: int
    # 1 or −1: the half of the central axis that is in the middle.
    sign: float = 1.0

    def directions(self, azimuth: Array, height: Array) -> Array:
        """Return the unit vectors (..., 3) at azimuths and heights of the map."""
        u = np.empty((*np.shape(azimuth), 3))
        across = np.sqrt(1 - height**2)
        u[..., self.center] = self.sign * across * np.cos(azimuth)
        u[..., self.right] = across * np.sin(azimuth)
        u[..., self.up] = height
        return u


# --- level curves of Σ w_k u_k² and of other functions on the unit sphere


def family(weights: Array, fractions: Sequence[float]) -> list[Array]:
    """Return level curves (n, 3) of ``Σ w_k u_k²`` about both ends of the axes of extreme weights.

    They cross the plane of such an axis c and the middle one at ``u_mid² = fraction``. ``Σ (w_c − w_k) u_k²``
    is constant, so each is an ellipse in the plane of the other two axes, centred on axis c.
    """
    low, middle, high = np.argsort(weights, kind="stable")
    s = np.linspace(0, 2 * np.pi, _POINTS)
    curves = []
    for c, other in ((high, low), (low, high)):
        to_middle, to_other = abs(weights[c] - weights[middle]), abs(weights[c] - weights[other])
        if to_middle <= _EQUAL * np.abs(weights).max():
            continue
        for fraction in fractions:
            u = np.zeros((s.size, 3))
            u[:, middle] = np.sqrt(fraction) * np.cos(s)
            u[:, other] = np.sqrt(fraction * to_middle / to_other) * np.sin(s)
            u[:, c] = np.sqrt(np.maximum(1 - u[:, middle] ** 2 - u[:, other] ** 2, 0.0))
            curves += [u, -u]
    return curves


def separatrix(weights: Array) -> list[Array]:
    """Return the two great circles (n, 3) where ``Σ w_k u_k²`` is the middle weight."""
    low, middle, high = np.argsort(weights, kind="stable")
    below, above = weights[middle] - weights[low], weights[high] - weights[middle]
    if min(below, above) <= _EQUAL * np.abs(weights).max():
        return []
    s = np.linspace(0, 2 * np.pi, _POINTS)
    circles = []
    for sign in (1.0, -1.0):
        u = np.zeros((s.size, 3))
        u[:, middle] = np.sin(s)
        u[:, low] = np.cos(s) * np.sqrt(above / (above + below))
        u[:, high] = sign * np.cos(s) * np.sqrt(below / (above + below))
        circles.append(u)
    return circles


def level_curves(
    values: Callable[[Array], Array], levels: Callable[[Array], Array], frame: Frame
) -> list[Array]:
    """Return curves (n, 3) where a function of directions has the levels that its values on a grid give."""
    azimuth, height = np.meshgrid(
        np.linspace(-np.pi, np.pi, 241), np.sin(np.linspace(-1, 1, 161) * np.pi / 2)
    )
    found = values(frame.directions(azimuth, height))
    lines = plotting("contourpy").contour_generator(azimuth, height, found)
    return [
        frame.directions(line[:, 0], np.clip(line[:, 1], -1, 1))
        for level in levels(found)
        for line in lines.lines(level)
    ]


class Portrait(NamedTuple):
    """Curves (n, 3): the path of a motion, those of neighbours, and the separatrix."""

    path: Array
    family: list[Array]
    divides: list[Array]

    def styled(self) -> list[tuple[Array, dict[str, Any]]]:
        """Return each curve with its style, the lowest first."""
        return [
            *((curve, {"color": OTHERS, "lw": 0.8}) for curve in self.family),
            *((curve, {"color": BLACK, "lw": 0.9}) for curve in self.divides),
            (self.path, {"color": POLHODE, "lw": 2.0}),
        ]

    def draw(self, axes: Axes, look: View, weights: Array, level: float, names: tuple[str, ...]) -> None:
        """Draw the curves on the ellipsoid ``Σ w_k x_k² = level``."""
        semi_axes = np.sqrt(level / weights)
        look.ellipsoid(axes, semi_axes)
        for curve, style in self.styled():
            look.curve(axes, curve, curve * weights, **style)
        look.dot(axes, self.path[0], self.path[0] * weights, color=POLHODE)
        look.finish(axes, semi_axes, names, AXES)


@drawing(5.2, 5.6, "Polhode")
def polhode_figure(
    figure: Figure, trajectory: Trajectory, wheel: Array | None = None, view: Any = None
) -> str:
    """Draw the polhode on the inertia ellipsoid ``Σ i_k ω_k² = 2E`` of the start, among its neighbours.

    Components are about the principal axes; parts behind the ellipsoid are dashed and pale. The polhode of a
    body that loses energy is scaled to the energy of the start. With a wheel of momentum (3,) in body axes,
    the neighbours are those with the same wheel.
    """
    axes = figure.add_subplot()
    moments = trajectory.inertia.principal_moments
    to_principal = ~trajectory.inertia.principal_frame
    omega = to_principal(samples(trajectory).omega_body).components
    energies = 0.5 * (moments * omega**2).sum(axis=1)
    energy = float(energies[0])
    if energy == 0:
        return at_rest(axes, "polhode")
    omega = omega * np.sqrt(energy / np.maximum(energies, np.finfo(float).tiny))[:, np.newaxis]
    # ω_k = u_k √(2E / i_k) with u on the unit sphere, where |L|² = 2E Σ i_k u_k².
    semi_axes = np.sqrt(2 * energy / moments)
    if wheel is None:
        others, divides = family(moments, (0.1, 0.35, 0.7)), separatrix(moments)
    else:
        h, divides = to_principal(vector(wheel)).components, []
        others = level_curves(
            lambda u: np.asarray(np.linalg.norm(semi_axes * u * moments + h, axis=-1)),
            lambda sizes: sizes.min() + np.ptp(sizes) * np.linspace(0.04, 0.96, 12),
            Frame(0, 1, 2),
        )
    shown = Portrait(omega, [semi_axes * u for u in others], [semi_axes * u for u in divides])
    shown.draw(axes, view_of(view), moments, 2 * energy, (r"$\omega_1$", r"$\omega_2$", r"$\omega_3$"))
    slowed = " (scaled up as the body slows)" if energies.min() < 0.999 * energy else ""
    caption = (
        r"Thick: the angular velocity $\Omega_B = \Sigma\,\omega_k\,I e_k$ about principal axes $e_k$, from "
        rf"the dot on{slowed}, on the ellipsoid $\Sigma\,i_k\,\omega_k^2 = 2E$ with $i_k$ = "
        f"{', '.join(f'{i:.4g}' for i in moments)} kg m², $E$ = {energy:.4g} J. "
    )
    if others:
        caption += "Grey: other motions of this energy. "
    if divides:
        caption += "Black: the separatrix between rotation about the axes of least and greatest moment. "
    return caption + "Dashed: behind."


def axis_figure(trajectory: Trajectory, axis: Array, name: str) -> Figure:
    """Draw the path on the unit sphere of a direction fixed in the body (3,); e3 of space is up."""
    require_times(trajectory)
    path = samples(trajectory).rotor(vector(axis / np.linalg.norm(axis))).components
    caption = f"Path of {name} on the unit sphere of space axes $e_k$, from the dot on. Dashed: behind."
    return path_figure(trajectory, path, caption, SPACE_AXES)


@drawing(5.2, 5.6, "Path of the axis")
def path_figure(
    figure: Figure,
    trajectory: Trajectory,
    path: Array,
    caption: str,
    names: tuple[str, str, str],
    bounds: tuple[float, ...] = (),
    view: Any = None,
) -> str:
    """Draw a path (n, 3) on the unit sphere; `bounds`, angles from the third axis in rad, are marked."""
    axes = figure.add_subplot()
    look, sphere = view_of(view), np.ones(3)
    look.ellipsoid(axes, sphere)
    parallels = [(angle, OTHERS, 0.6) for angle in np.radians([30, 60, 90, 120, 150])]
    for angle, colour, width in (*parallels, *((bound, BLACK, 1.0) for bound in bounds)):
        height = np.full(_POINTS, np.cos(angle))
        circle = Frame(0, 1, 2).directions(np.linspace(0, 2 * np.pi, _POINTS), height)
        look.curve(axes, circle, circle, color=colour, lw=width)
    look.curve(axes, path, path, color=TRACE, lw=1.5)
    look.dot(axes, path[0], path[0], color=TRACE)
    look.finish(axes, sphere, names, (BLACK, BLACK, BLACK))
    return caption
