"""Style of the figures: fonts, titles, captions, units and files."""

from __future__ import annotations

import functools
import io
import textwrap
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Concatenate, Generic, ParamSpec, cast

import numpy as np

from polhode._mechanics.trajectory import Trajectory
from polhode._support.arrays import Array
from polhode._support.extras import optional

if TYPE_CHECKING:
    from matplotlib.axes import Axes as Axes
    from matplotlib.figure import Figure as Figure
else:
    Axes = Figure = Any  # Matplotlib is imported when a figure is drawn.

P = ParamSpec("P")

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

# SVG has text as outlines, because few readers have a font with ∧ and ₁. PDF has text, in a font type that
# journals accept.
_AS_FILES = {"svg.fonttype": "path", "svg.hashsalt": "polhode", "pdf.fonttype": 42}
_UNDATED: dict[str, dict[str, Any]] = {
    "svg": {"Date": None},
    "pdf": {"CreationDate": None},
    "png": {"Software": "Polhode"},
}

# (longest duration to show in a unit, seconds in the unit, its name)
_TIME_UNITS = ((300.0, 1.0, "s"), (18e3, 60.0, "min"), (432e3, 3600.0, "h"), (1.3e8, 86400.0, "d"))


plotting = functools.partial(optional, extra="plot", what="a figure")


class Drawing(Generic[P]):
    """A function that draws on an empty figure and returns its caption, made to return the figure.

    The figure has the style of this package whatever the user's settings are. Its title is that of the motion
    in the first argument, if it has one.
    """

    def __init__(
        self, draw: Callable[Concatenate[Figure, P], str], size: tuple[float, float], title: str
    ) -> None:
        self._draw, self._size, self._title = draw, size, title
        functools.update_wrapper(self, draw)

    def __call__(self, *arguments: P.args, **named: P.kwargs) -> Figure:
        return self.on(None, *arguments, **named)

    def on(self, axes: Axes | None, /, *arguments: P.args, **named: P.kwargs) -> Figure:
        """Draw on axes of the caller's, without title and caption; None for a new figure."""
        subject = arguments[0]
        if isinstance(subject, Trajectory):
            require_times(subject)
        with plotting("matplotlib").rc_context(_LOOK):
            if axes is not None:
                panel: Any = _FigureOf(axes)
                self._draw(panel, *arguments, **named)
                return cast("Figure", axes.figure)
            width = self._size[0]
            figure = new_figure(*self._size)
            caption = self._draw(figure, *arguments, **named)
            lines = int(_TITLE_LETTERS * width), int(_CAPTION_LETTERS * width)
            figure.suptitle(textwrap.fill(title_of(subject, self._title), lines[0]), parse_math=False)
            if caption:
                figure.supxlabel(textwrap.fill(caption, lines[1]), fontsize=8)
            return figure


def drawing(
    width: float, height: float, title: str
) -> Callable[[Callable[Concatenate[Figure, P], str]], Drawing[P]]:
    """Decorate a function that draws on an empty figure, in inches, and returns its caption."""
    return lambda draw: Drawing(draw, (width, height), title)


class _FigureOf:
    """The caller's axes in place of a figure with one panel."""

    def __init__(self, axes: Axes) -> None:
        self._axes = axes

    def add_subplot(self, **labels: str) -> Axes:
        self._axes.set(**labels)
        return self._axes


def new_figure(width: float, height: float) -> Figure:
    figure: Figure = plotting("matplotlib.figure").Figure(figsize=(width, height), layout="constrained")
    return figure


def encoded(figure: Figure, form: str, dpi: int = 200) -> bytes:
    """Return a figure as the bytes of a file; equal figures give equal bytes."""
    buffer = io.BytesIO()
    with plotting("matplotlib").rc_context(_AS_FILES):
        figure.savefig(buffer, format=form, dpi=dpi, metadata=_UNDATED[form])
    return buffer.getvalue()


def as_png(figure: Figure) -> bytes:
    """Return the figure as a PNG file for a screen."""
    return encoded(figure, "png", 160)


def dress(axes: Axes) -> None:
    """Set grid, ticks and spines of axes with scales."""
    axes.grid(alpha=0.25, lw=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=8.5, width=0.6)
    axes.spines[["top", "right"]].set_visible(False)


def at_rest(axes: Axes, what: str) -> str:
    """Draw that a body at rest has no such curve; return an empty caption."""
    axes.set_axis_off()
    axes.text(0.5, 0.5, f"At rest: no {what}", ha="center", transform=axes.transAxes)
    return ""


def mark(axes: Axes, point: Any, colour: str) -> None:
    """Draw the dot at the start of a curve."""
    axes.plot(*point, "o", color=colour, ms=6, mec="white", mew=0.8, zorder=5)


def halo(width: float) -> Any:
    """Return a white outline of letters."""
    return plotting("matplotlib.patheffects").withStroke(linewidth=width, foreground="white")


def title_of(subject: object, otherwise: str) -> str:
    """Return the title of a motion; else the other one."""
    attributes = subject.attributes if isinstance(subject, Trajectory) else {}
    title: str = attributes.get("title", otherwise)
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
