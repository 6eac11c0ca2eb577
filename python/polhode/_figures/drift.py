"""Drift figure: conserved quantities and their changes over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from polhode._figures.style import (
    _BLACK,
    _BLUE,
    _ORANGE,
    dress,
    entitle,
    explain,
    in_our_look,
    new_figure,
    time_unit,
    title_of,
)
from polhode._report.text import QUANTITIES
from polhode._support.arrays import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from polhode._mechanics.trajectory import Trajectory


@in_our_look
def drift_figure(trajectory: Trajectory) -> Figure:
    """Draw energy and momentum, then the change of each conserved quantity and of the rotor norm."""
    drifts = trajectory.drifts()
    figure = new_figure(7, 2.3 + 1.05 * (len(drifts) + 1))
    panels = figure.subplots(len(drifts) + 2, 1, sharex=True, height_ratios=(1.6, *[1.0] * (len(drifts) + 1)))
    seconds, unit = time_unit(trajectory.time)
    t = trajectory.time / seconds
    _draw_sizes(panels[0], trajectory, t)
    for axes, (name, values) in zip(panels[1:-1], drifts.items(), strict=True):
        label, unit_of_it = QUANTITIES[name]
        start = trajectory.certificate.conserved[name]
        _draw_change(axes, t, values, f"{label}, {start:.6g} {unit_of_it} at the start", _ORANGE)
    _draw_change(panels[-1], t, np.asarray(trajectory.rotor.norm()) - 1, "norm of the rotor, |R| − 1", _BLACK)
    panels[-1].set_xlabel(f"time, {unit}")
    for axes in panels:
        dress(axes)
        axes.margins(x=0)
    figure.align_ylabels()
    entitle(figure, title_of(trajectory, "Conserved quantities"))
    explain(figure, _caption(trajectory))
    return figure


def _draw_sizes(axes: Axes, trajectory: Trajectory, t: Array) -> None:
    """Draw energy and |L|, each divided by its largest value, on a scale that includes zero."""
    momentum = np.asarray(trajectory.momentum_space.norm())
    for values, name, unit, colour, dashes in (
        (trajectory.energy, "energy", "J", _ORANGE, "-"),
        (momentum, "|L|", "kg m²/s", _BLUE, (0, (5, 2))),
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
    largest = float(np.abs(values).max())
    exponent = int(np.floor(np.log10(largest))) if largest > 0 else -16
    scaled = values / 10.0**exponent
    axes.axhline(0, color=_BLACK, lw=0.5)
    axes.plot(t, scaled, color=colour, lw=0.8)
    reach = 1.15 * max(float(np.abs(scaled).max()), 1.0)
    axes.set_ylim(-reach, reach)
    axes.set_ylabel(f"$10^{{{exponent}}}$")
    axes.set_title(name, loc="left", fontsize=8.5, pad=3)


def _caption(trajectory: Trajectory) -> str:
    certificate = trajectory.certificate
    caption = "Changes since the start, relative to the size of the terms of each quantity. "
    if certificate.method == "exact":
        return caption + "The motion is exact."
    estimate = certificate.error_estimate
    error = "" if estimate is None else f", estimated error {estimate:.1g}"
    return caption + f"Method {certificate.method}, steps of at most {certificate.step:.3g} s{error}."
