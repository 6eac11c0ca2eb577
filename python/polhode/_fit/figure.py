"""The figure of the residuals of a fit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from polhode._figures.palette import AXES, BLACK, PLANES, SPACE_AXES
from polhode._figures.style import Figure, drawing, dress, time_unit

if TYPE_CHECKING:
    from polhode._fit.result import Fit

_LABELS = {"attitude": SPACE_AXES, "rates": PLANES}


@drawing(7, 4.2, "Residuals of the fit")
def residual_figure(figure: Figure, fit: Fit) -> str:
    """Draw the residuals of attitudes and rates over time, in standard deviations."""
    times, residuals = fit.times, fit.residuals
    panels = [figure.add_subplot()] if len(times) == 1 else list(figure.subplots(len(times), 1, sharex=True))
    seconds, unit = time_unit(np.concatenate(list(times.values())))
    for axes, (name, t) in zip(panels, times.items(), strict=True):
        dress(axes)
        axes.axhspan(-1, 1, color=BLACK, alpha=0.06, lw=0)
        axes.axhline(0, color=BLACK, lw=0.5)
        for column, label, colour in zip(residuals[name].T, _LABELS[name], AXES, strict=True):
            axes.plot(t / seconds, column, ".", ms=3, color=colour, label=label)
        axes.set_ylabel(f"residual of {name},\nstandard deviations")
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    panels[-1].set_xlabel(f"time, {unit}")
    if fit.chi2_reduced is None:
        return "Measured minus computed values. Standard deviations are estimated from these residuals."
    return f"Measured minus computed values. Reduced chi-square {fit.chi2_reduced:.3g}."
