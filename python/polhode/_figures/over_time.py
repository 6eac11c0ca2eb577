"""Figures over time: rates, attitude and drift; conserved quantities."""

from __future__ import annotations

import numpy as np

from polhode._algebra.constructors import vector
from polhode._figures.palette import AXES, BLACK, BLUE, GREEN, ORANGE, PLANES, SPACE_AXES
from polhode._figures.style import Axes, Figure, drawing, dress, scaled_unit, time_unit
from polhode._mechanics.trajectory import Trajectory
from polhode._report.describe import main_axis
from polhode._report.summary import QUANTITIES
from polhode._support.arrays import Array

# More turns than this would fill a figure as a solid block.
_TURNS_SEEN = 100


@drawing(7, 6.6, "Motion of a rigid body")
def motion_figure(figure: Figure, trajectory: Trajectory) -> str:
    """Draw angular velocity in the body, attitude, and the drift of conserved quantities over time."""
    panels = rates, attitude, drift = figure.subplots(3, 1, sharex=True, height_ratios=(3, 3, 2))
    power, per_second = scaled_unit(trajectory.omega_body.components, "rad/s")
    t = _time_axis(figure, panels, trajectory)
    _draw_components(rates, t, trajectory.omega_body.components / power, PLANES)
    rates.set_ylabel(f"angular velocity in\nthe body Ω_B, {per_second}")
    _draw_attitude(attitude, trajectory, t)
    _draw_drift(drift, trajectory, t)
    for axes in panels:
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return (
        "Ω_B: components in the planes of body axes, coloured as the axis perpendicular to each. "
        "Rotor: a' = R a ~R takes body axes to space axes, R' = −½ R Ω_B."
    )


@drawing(7, 3.35, "Conserved quantities")
def drift_figure(figure: Figure, trajectory: Trajectory) -> str:
    """Draw energy and momentum, then the change of each conserved quantity and of the rotor norm."""
    drifts, proof = trajectory.drifts(), trajectory.certificate
    figure.set_figheight(2.3 + 1.05 * (len(drifts) + 1))
    panels = figure.subplots(len(drifts) + 2, 1, sharex=True, height_ratios=(1.6, *[1.0] * (len(drifts) + 1)))
    t = _time_axis(figure, panels, trajectory)
    _draw_sizes(panels[0], trajectory, t)
    for axes, (name, values) in zip(panels[1:-1], drifts.items(), strict=True):
        label, unit = QUANTITIES[name]
        _draw_change(axes, t, values, f"{label}, {proof.conserved[name]:.6g} {unit} at the start", ORANGE)
    _draw_change(panels[-1], t, np.asarray(trajectory.rotor.norm()) - 1, "norm of the rotor, |R| − 1", BLACK)
    caption = "Changes since the start, relative to the size of the terms of each quantity. "
    if proof.method == "exact":
        return caption + "The motion is exact."
    error = "" if proof.error_estimate is None else f", estimated error {proof.error_estimate:.1g}"
    return caption + f"Method {proof.method}, steps of at most {proof.step:.3g} s{error}."


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
        axes.set_ylabel("attitude rotor R\n(body to space)")
    else:
        number, axis = main_axis(trajectory)
        _draw_components(axes, t, trajectory.rotor(vector(axis)).components, SPACE_AXES)
        axes.set_ylabel(f"direction in space\nof principal axis {number}")
    axes.set_ylim(-1.08, 1.08)


def _draw_drift(axes: Axes, trajectory: Trajectory, t: Array) -> None:
    """Draw relative changes of conserved quantities over a power of ten; |L| if none is conserved."""
    series = {QUANTITIES[name][0]: values for name, values in trajectory.drifts().items()}
    if not series:
        axes.plot(t, np.linalg.norm(trajectory.momentum_space.components, axis=1), color=BLUE, label="|L|")
        axes.set_ylim(bottom=0.0)
        axes.set_ylabel("angular momentum,\nkg m²/s")
        return
    largest = max(float(np.abs(values).max()) for values in series.values())
    exponent = _exponent(largest)
    for (name, values), colour in zip(series.items(), (BLUE, ORANGE, GREEN, BLACK), strict=False):
        axes.plot(t, values / 10.0**exponent, color=colour, lw=1.0, label=name)
    if largest == 0:
        axes.set_ylim(-1.5, 1.5)
    axes.set_ylabel(f"relative drift,\n$10^{{{exponent}}}$")


def _draw_sizes(axes: Axes, trajectory: Trajectory, t: Array) -> None:
    """Draw energy and |L|, each divided by its largest value, on a scale that includes zero."""
    momentum = np.asarray(trajectory.momentum_space.norm())
    for values, name, unit, colour, dashes in (
        (trajectory.energy, "energy", "J", ORANGE, "-"),
        (momentum, "|L|", "kg m²/s", BLUE, (0, (5, 2))),
    ):
        largest = float(np.abs(values).max())
        scaled = values / largest if largest else values
        axes.plot(t, scaled, color=colour, lw=1.3, ls=dashes, label=f"{name} / {largest:.5g} {unit}")
    low = min(0.0, float(trajectory.energy.min() / max(np.abs(trajectory.energy).max(), 1e-300)))
    axes.set_ylim(1.1 * low, 1.1)
    axes.set_ylabel("relative to\nthe maximum")
    axes.legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=2, frameon=False, borderaxespad=0.2)


def _draw_change(axes: Axes, t: Array, values: Array, name: str, colour: str) -> None:
    """Draw changes divided by a power of ten."""
    exponent = _exponent(float(np.abs(values).max()))
    scaled = values / 10.0**exponent
    axes.axhline(0, color=BLACK, lw=0.5)
    axes.plot(t, scaled, color=colour, lw=0.8)
    reach = 1.15 * max(float(np.abs(scaled).max()), 1.0)
    axes.set_ylim(-reach, reach)
    axes.set_ylabel(f"$10^{{{exponent}}}$")
    axes.set_title(name, loc="left", fontsize=8.5, pad=3)


def _exponent(largest: float) -> int:
    return int(np.floor(np.log10(largest))) if largest > 0 else -16
