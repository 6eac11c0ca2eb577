"""Figures over time: rates, attitude and drift; conserved quantities."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode._algebra.constructors import vector
from polhode._figures.palette import AXES, BLACK, MOMENTUM, ORANGE, PLANES, SPACE_AXES
from polhode._figures.style import Axes, Figure, drawing, dress, scaled_unit, time_unit
from polhode._mechanics.trajectory import Trajectory
from polhode._report.motion_parameters import main_axis
from polhode._report.summary import QUANTITIES
from polhode._support.arrays import Array

# More turns than this would fill a figure as a solid block.
_TURNS_SEEN = 100
# Relative variation below which a curve would be a flat line.
_VISIBLE = 1e-3


@drawing(7, 6.6, "Angular velocity and attitude")
def motion_figure(figure: Figure, trajectory: Trajectory) -> str:
    """Draw angular velocity in the body and attitude over time, and energy and |L| where they vary."""
    sizes = _varying_sizes(trajectory)
    count = 3 if sizes else 2
    panels = figure.subplots(count, 1, sharex=True, height_ratios=(3, 3, 2)[:count])
    power, per_second = scaled_unit(trajectory.omega_body.components, "rad/s")
    t = _time_axis(figure, panels, trajectory)
    _draw_components(panels[0], t, trajectory.omega_body.components / power, PLANES)
    panels[0].set_ylabel(f"angular velocity in\nthe body $\\Omega_B$, {per_second}")
    _draw_attitude(panels[1], trajectory, t)
    if sizes:
        _draw_sizes(panels[2], sizes, t)
    for axes in panels:
        _put_legend_above(axes)
    return (
        r"$\Omega_B$: components in the planes of body axes, coloured as the axis perpendicular to each. "
        r"Rotor: $a' = R a \tilde{R}$ takes body axes to space axes, $\dot{R} = -\frac{1}{2} R\,\Omega_B$. "
        + _conserved(trajectory)
    )


@drawing(7, 3.35, "Conserved quantities")
def drift_figure(figure: Figure, trajectory: Trajectory) -> str:
    """Draw energy and |L| where they vary, then the change of conserved quantities and of the rotor norm."""
    proof, sizes = trajectory.certificate, _varying_sizes(trajectory)
    unchanged = [QUANTITIES[name][0] for name, values in trajectory.drifts().items() if not values.any()]
    drifts = {name: values for name, values in trajectory.drifts().items() if values.any()}
    ratios = [*([1.6] if sizes else []), *[1.0] * (len(drifts) + 1)]
    figure.set_figheight(1.25 + 1.05 * sum(ratios))
    panels = tuple(figure.subplots(len(ratios), 1, sharex=True, height_ratios=ratios, squeeze=False)[:, 0])
    t = _time_axis(figure, panels, trajectory)
    if sizes:
        _draw_sizes(panels[0], sizes, t)
        _put_legend_above(panels[0])
    for axes, (name, values) in zip(panels[bool(sizes) : -1], drifts.items(), strict=True):
        label, unit = QUANTITIES[name]
        start = f"{proof.conserved[name]:.6g}".replace("-", "\N{MINUS SIGN}")
        _draw_change(axes, t, values, f"{label}, {start} {unit} at the start", ORANGE)
    _draw_change(
        panels[-1], t, np.asarray(trajectory.rotor.norm()) - 1, "norm of the rotor, $|R| - 1$", BLACK
    )
    caption = "Changes since the start, relative to the size of the terms of each quantity. "
    if unchanged:
        caption += f"Without any change: {', '.join(unchanged)}. "
    if proof.method == "exact":
        return caption + "The motion is exact."
    error = "" if proof.error_estimate is None else f", estimated error {proof.error_estimate:.1g}"
    return caption + f"Method {proof.method}, steps of at most {proof.step:.3g} s{error}."


def _put_legend_above(axes: Axes) -> None:
    """Put the legend above axes in one row, which fits the column of a journal."""
    place: dict[str, Any] = {"loc": "lower left", "bbox_to_anchor": (0, 1), "borderaxespad": 0.2}
    axes.legend(**place, ncols=4, frameon=False, handlelength=1.2, handletextpad=0.4, columnspacing=1.0)


def _time_axis(figure: Figure, panels: tuple[Axes, ...], trajectory: Trajectory) -> Array:
    """Label the common axis of the panels; return the output times in its unit."""
    seconds, unit = time_unit(trajectory.time)
    for axes in panels:
        dress(axes)
        axes.margins(x=0)
    panels[-1].set_xlabel(f"time, {unit}")
    figure.align_ylabels()
    return np.asarray(trajectory.time / seconds)


def _draw_components(axes: Axes, t: Array, values: Array, names: tuple[str, ...]) -> None:
    """Draw values (n, m) over time; the last three in the colours of the axes."""
    for column, name, colour in zip(values.T, names, (BLACK, *AXES)[-len(names) :], strict=True):
        axes.plot(t, column, color=colour, lw=1.2, label=name)


def _draw_attitude(axes: Axes, trajectory: Trajectory, t: Array) -> None:
    """Draw the rotor, or for a fast spinning body the direction of its spin axis."""
    rates = (~trajectory.inertia.principal_frame)(trajectory.omega_body).components
    speed = np.linalg.norm(rates, axis=1)
    turns = float(np.abs(np.diff(trajectory.time) * 0.5 * (speed[1:] + speed[:-1])).sum()) / (2 * np.pi)
    if turns <= _TURNS_SEEN:
        _draw_components(axes, t, trajectory.rotor.components, ("1", *PLANES))
        axes.set_ylabel("attitude rotor $R$\n(body to space)")
    else:
        number, axis = main_axis(trajectory)
        _draw_components(axes, t, trajectory.rotor(vector(axis)).components, SPACE_AXES)
        axes.set_ylabel(f"direction in space\nof principal axis {number}")
    axes.set_ylim(-1.08, 1.08)


def _varying_sizes(trajectory: Trajectory) -> dict[str, Array]:
    """Return those of energy and |L| that vary visibly, by their names in `QUANTITIES`."""
    sizes = {"energy": trajectory.energy, "angular_momentum": np.asarray(trajectory.momentum_space.norm())}
    return {
        name: values for name, values in sizes.items() if np.ptp(values) > _VISIBLE * np.abs(values).max()
    }


def _draw_sizes(axes: Axes, sizes: dict[str, Array], t: Array) -> None:
    """Draw energy and |L|, each divided by its largest value."""
    dashes: dict[str, Any] = {"energy": "-", "angular_momentum": (0, (5, 2))}
    for name, values in sizes.items():
        (label, unit), largest = QUANTITIES[name], float(np.abs(values).max())
        scaled = values / largest if largest else values
        colour = {"energy": BLACK, "angular_momentum": MOMENTUM}[name]
        axes.plot(t, scaled, color=colour, lw=1.3, ls=dashes[name], label=f"{label} / {largest:.5g} {unit}")
    axes.ticklabel_format(axis="y", useOffset=False)
    axes.set_ylabel("relative to\nthe maximum")


def _conserved(trajectory: Trajectory) -> str:
    """Return what is conserved, and how well, as a sentence of the caption."""
    kept = [
        QUANTITIES[name][0] + (f" to {np.abs(values).max():.0e}" if values.any() else " exactly")
        for name, values in trajectory.drifts().items()
    ]
    return f"Conserved, relative: {', '.join(kept)}." if kept else ""


def _draw_change(axes: Axes, t: Array, values: Array, name: str, colour: str) -> None:
    """Draw changes divided by a power of ten."""
    exponent = _exponent(float(np.abs(values).max()))
    scaled = values / 10.0**exponent
    axes.axhline(0, color=BLACK, lw=0.5)
    axes.plot(t, scaled, color=colour, lw=0.8)
    reach = 1.15 * max(float(np.abs(scaled).max()), 1.0)
    axes.set_ylim(-reach, reach)
    axes.set_ylabel(f"$10^{{{exponent}}}$")
    axes.set_title(name, loc="left", pad=3)


def _exponent(largest: float) -> int:
    return int(np.floor(np.log10(largest))) if largest > 0 else -16
