"""Style of the figures; the motion figure: rates, attitude and drift over time."""

from __future__ import annotations

import functools
import io
import textwrap
from collections.abc import Callable
from typing import TYPE_CHECKING, ParamSpec

import numpy as np

from polhode._algebra.constructors import vector
from polhode._report.describe import main_axis
from polhode._report.text import QUANTITIES
from polhode._support.arrays import Array
from polhode._support.extras import optional

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from polhode._mechanics.trajectory import Trajectory

P = ParamSpec("P")

# Okabe and Ito's palette, safe for colour-blind readers; the same as in viewer/src/palette.ts.
_BLUE, _ORANGE, _GREEN, _BLACK = "#0072B2", "#D55E00", "#009E73", "#222222"
_AXES = (_BLUE, _ORANGE, _GREEN)
OMEGA, MOMENTUM, TRACE, POLHODE, HERPOLHODE = _ORANGE, _BLUE, "#CC79A7", "#B07A00", _GREEN
FAINT, WEIGHT = "#8A94A3", "#5B6675"
# Neighbouring motions.
OTHERS = "#B8B8B8"

# Labels of planes and axes.
PLANES = ("e₂∧e₃", "e₃∧e₁", "e₁∧e₂")
SPACE_AXES = ("e₁", "e₂", "e₃")

# For a figure as wide as two columns of a journal.
_LOOK = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.labelsize": 9.0,
    "axes.titlesize": 9.5,
    "figure.titlesize": 11.0,
    "legend.fontsize": 8.5,
    "axes.linewidth": 0.7,
    "axes.unicode_minus": True,
    "lines.solid_joinstyle": "round",
    "text.usetex": False,
    "path.simplify": True,
}
# Letters per inch of the caption and of the title.
_CAPTION_LETTERS, _TITLE_LETTERS = 15.5, 11.0

# More turns than this would fill a figure as a solid block.
_TURNS_SEEN = 100

# (longest duration to show in a unit, seconds in the unit, its name)
_TIME_UNITS = ((300.0, 1.0, "s"), (18e3, 60.0, "min"), (432e3, 3600.0, "h"), (1.3e8, 86400.0, "d"))


def in_our_look(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Draw in the style of this package, whatever the user's matplotlib settings are."""

    @functools.wraps(draw)
    def drawn(*arguments: P.args, **named: P.kwargs) -> Figure:
        with optional("matplotlib", "plot", "a figure").rc_context(_LOOK):
            return draw(*arguments, **named)

    return drawn


def new_figure(width: float, height: float) -> Figure:
    figure: Figure = optional("matplotlib.figure", "plot", "a figure").Figure(
        figsize=(width, height), layout="constrained"
    )
    return figure


def as_png(figure: Figure) -> bytes:
    """Return the figure as a PNG file."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=160)
    return buffer.getvalue()


def entitle(figure: Figure, title: str) -> None:
    """Set the title, wrapped to the width of the figure."""
    lines = textwrap.fill(title, int(_TITLE_LETTERS * figure.get_figwidth()))
    figure.suptitle(lines, parse_math=False)


def explain(figure: Figure, text: str) -> None:
    """Set the caption below, wrapped to the width of the figure."""
    width = int(_CAPTION_LETTERS * figure.get_figwidth())
    figure.supxlabel(textwrap.fill(text, width), fontsize=8)


def dress(axes: Axes) -> None:
    """Set grid, ticks and spines of axes with scales."""
    axes.grid(alpha=0.25, lw=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=8.5, width=0.6)
    axes.spines[["top", "right"]].set_visible(False)


def title_of(trajectory: Trajectory, otherwise: str) -> str:
    title: str = trajectory.attributes.get("title", otherwise)
    return title


def require_times(trajectory: Trajectory) -> None:
    if not len(trajectory.time):
        raise ValueError("the motion has no output times: there is nothing to draw")


def time_unit(times: Array) -> tuple[float, str]:
    """Return a unit for times, as its seconds and its name."""
    span = float(np.abs(times).max(initial=0.0))
    for longest, seconds, name in _TIME_UNITS:
        if span <= longest:
            return seconds, name
    return 365.25 * 86400.0, "yr"


def scaled_unit(values: Array, unit: str) -> tuple[float, str]:
    """Return a power of ten to divide values by, and the unit with it."""
    largest = float(np.nanmax(np.abs(values), initial=0.0))
    if largest == 0 or 0.01 <= largest < 1e4:
        return 1.0, unit
    exponent = int(np.floor(np.log10(largest)))
    return 10.0**exponent, f"$10^{{{exponent}}}$ {unit}"


@in_our_look
def motion_figure(trajectory: Trajectory) -> Figure:
    """Draw angular velocity in the body, attitude, and the drift of conserved quantities over time."""
    require_times(trajectory)
    figure = new_figure(7, 6.6)
    rates, attitude, drift = figure.subplots(3, 1, sharex=True, height_ratios=(3, 3, 2))
    seconds, unit = time_unit(trajectory.time)
    t = trajectory.time / seconds
    power, per_second = scaled_unit(trajectory.omega_body.components, "rad/s")
    for k, (plane, colour) in enumerate(zip(PLANES, _AXES, strict=True)):
        rates.plot(t, trajectory.omega_body.components[:, k] / power, color=colour, lw=1.2, label=plane)
    rates.set_ylabel(f"angular velocity in\nthe body Ω_B, {per_second}")
    _draw_attitude(attitude, trajectory, t)
    _draw_drift(drift, trajectory, t)
    drift.set_xlabel(f"time, {unit}")
    for axes in (rates, attitude, drift):
        dress(axes)
        axes.margins(x=0)
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    figure.align_ylabels()
    entitle(figure, title_of(trajectory, "Motion of a rigid body"))
    explain(
        figure,
        "Ω_B: components in the planes of body axes, coloured as the axis perpendicular to each. "
        "Rotor: a' = R a ~R takes body axes to space axes, R' = −½ R Ω_B.",
    )
    return figure


def _draw_attitude(axes: Axes, trajectory: Trajectory, t: Array) -> None:
    """Draw the rotor, or for a fast spinning body the direction of its spin axis."""
    rates = (~trajectory.inertia.principal_frame)(trajectory.omega_body).components
    speed = np.linalg.norm(rates, axis=1)
    turns = float(np.abs(np.diff(trajectory.time) * 0.5 * (speed[1:] + speed[:-1])).sum()) / (2 * np.pi)
    if turns <= _TURNS_SEEN:
        parts = ("1", *PLANES)
        for k, (part, colour) in enumerate(zip(parts, (_BLACK, *_AXES), strict=True)):
            axes.plot(t, trajectory.rotor.components[:, k], color=colour, lw=1.2, label=part)
        axes.set_ylabel("attitude rotor R\n(body to space)")
    else:
        number, axis = main_axis(trajectory)
        path = trajectory.rotor(vector(axis)).components
        for j, (name, colour) in enumerate(zip(SPACE_AXES, _AXES, strict=True)):
            axes.plot(t, path[:, j], color=colour, lw=1.2, label=name)
        axes.set_ylabel(f"direction in space\nof principal axis {number}")
    axes.set_ylim(-1.08, 1.08)


def _draw_drift(axes: Axes, trajectory: Trajectory, t: Array) -> None:
    """Draw relative changes of conserved quantities over a power of ten; |L| if none is conserved."""
    series = {QUANTITIES[name][0]: values for name, values in trajectory.drifts().items()}
    if not series:
        axes.plot(t, np.linalg.norm(trajectory.momentum_space.components, axis=1), color=_BLUE, label="|L|")
        axes.set_ylim(bottom=0.0)
        axes.set_ylabel("angular momentum,\nkg m²/s")
        return
    exponent = -16
    largest = max(float(np.abs(values).max()) for values in series.values())
    if largest > 0:
        exponent = int(np.floor(np.log10(largest)))
    for (name, values), colour in zip(series.items(), (_BLUE, _ORANGE, _GREEN, _BLACK), strict=False):
        axes.plot(t, values / 10.0**exponent, color=colour, lw=1.0, label=name)
    if largest == 0:
        axes.set_ylim(-1.5, 1.5)
    axes.set_ylabel(f"relative drift,\n$10^{{{exponent}}}$")
