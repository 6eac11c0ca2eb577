"""Style of the figures: fonts, titles, captions, units and files."""

from __future__ import annotations

import functools
import io
import re
import textwrap
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Concatenate, Generic, NamedTuple, ParamSpec, cast

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

# Sizes other than that of the font are relative to it.
_LOOK = {
    "font.size": 9.0,
    "axes.titlesize": "medium",
    "axes.labelsize": "medium",
    "xtick.labelsize": "medium",
    "ytick.labelsize": "medium",
    "legend.fontsize": "medium",
    "figure.titlesize": "large",
    "axes.linewidth": 0.7,
    "lines.solid_joinstyle": "round",
}
# Journals ask for letters of at least 7 points at the printed size.
_LEAST_FONT = 7.0
# Letters per inch and point of size: a letter is about 0.58 times as wide as the font is high.
_LETTERS = 124.0
_INCHES = {"mm": 1 / 25.4, "cm": 1 / 2.54, "in": 1.0}
_LEAST_WIDTH, _LARGEST_WIDTH = 1.5, 40.0
# Spaces at which no line ends: around an equals sign, after a number and inside units.
_UNIT = r"(?:kg m²(?:/s)?|N m|rad/s|degrees|J|m|kg|s|min|h|d|yr)(?![\w²/])"
_BOUND = re.compile(rf" (?==)|(?<==) |(?<=\d) (?={_UNIT})|(?<=kg) (?=m²)|(?<=N) (?=m\b)")
# Mathematics in a text of Matplotlib.
_FORMULA = r"(?<!\\)\$[^$]+\$"

# SVG has text as outlines, because few readers have a font with ∧ and ₁. PDF has text, in a font type that
# journals accept.
_AS_FILES = {"svg.fonttype": "path", "svg.hashsalt": "polhode", "pdf.fonttype": 42}
_UNDATED: dict[str, dict[str, Any]] = {
    "svg": {"Date": None, "Creator": "Polhode"},
    "pdf": {"CreationDate": None, "Creator": "Polhode"},
    "png": {"Software": "Polhode"},
}

# (longest duration to show in a unit, seconds in the unit, its name)
_TIME_UNITS = ((300.0, 1.0, "s"), (18e3, 60.0, "min"), (432e3, 3600.0, "h"), (1.3e8, 86400.0, "d"))


plotting = functools.partial(optional, extra="plot", what="a figure")


class Sheet(NamedTuple):
    """What a figure is drawn on.

    Attributes
    ----------
    axes
        Axes of the caller's, which get no title and no caption; None for a new figure.
    caption
        Whether a new figure has its caption.
    width
        Width of a new figure in inches; None for the width it is designed for.
    """

    axes: Axes | None = None
    caption: bool = True
    width: float | None = None


# A new figure with its caption, of the width it is designed for.
NEW = Sheet()


def width_of(width: Any) -> float | None:
    """Return a width such as ``"85mm"``, or a number of inches, in inches; None for None."""
    if width is None:
        return None
    match = re.fullmatch(r"\s*([0-9.]+)\s*(mm|cm|in)\s*", width) if isinstance(width, str) else None
    try:
        inches = float(match[1]) * _INCHES[match[2]] if match else float(width)
    except (TypeError, ValueError):
        message = f"width is {width!r}; it must be a length such as '85mm', '18cm' or '3.4in', or inches"
        raise ValueError(message) from None
    if not _LEAST_WIDTH <= inches <= _LARGEST_WIDTH:
        raise ValueError(f"width {width!r} must be from {_LEAST_WIDTH} to {_LARGEST_WIDTH} inches")
    return inches


class Drawing(Generic[P]):
    """A function that draws on an empty figure and returns its caption, made to return the figure.

    The settings of Matplotlib that the caller has changed, such as fonts, are kept; others are those of this
    package. The title is that of the motion in the first argument, if it has one, and the kind of figure.
    """

    def __init__(
        self, draw: Callable[Concatenate[Figure, P], str], size: tuple[float, float], title: str
    ) -> None:
        self._draw, self._size, self._title = draw, size, title
        functools.update_wrapper(self, draw)

    def __call__(self, *arguments: P.args, **named: P.kwargs) -> Figure:
        return self.on(NEW, *arguments, **named)

    def on(self, sheet: Sheet, /, *arguments: P.args, **named: P.kwargs) -> Figure:
        """Draw on a sheet."""
        subject = arguments[0]
        if isinstance(subject, Trajectory):
            require_times(subject)
        scale = 1.0 if sheet.width is None else sheet.width / self._size[0]
        with plotting("matplotlib").rc_context(_look(scale)):
            if sheet.axes is not None:
                panel: Any = _FigureOf(sheet.axes)
                self._draw(panel, *arguments, **named)
                return cast("Figure", sheet.axes.figure)
            # A narrow figure keeps more of its height, for its letters do not shrink as it does.
            width, height = scale * self._size[0], scale**0.75 * self._size[1]
            figure = new_figure(width, height)
            caption = self._draw(figure, *arguments, **named)
            size = plotting("matplotlib").rcParams["font.size"]
            figure.suptitle(wrapped(title_of(subject, self._title), width, 1.2 * size))
            for axes in figure.axes:
                for line in axes.lines:
                    line.set_linewidth(min(scale, 1.0) ** 0.5 * line.get_linewidth())
            if caption and sheet.caption:
                figure.supxlabel(wrapped(caption, width, 0.9 * size), fontsize=0.9 * size)
            return figure


def _look(scale: float) -> dict[str, Any]:
    """Return the settings of this package that the caller has not changed from Matplotlib's defaults."""
    matplotlib = plotting("matplotlib")
    now, default = matplotlib.rcParams, matplotlib.rcParamsDefault
    look = _LOOK | {"font.size": max(_LEAST_FONT, 9.0 * min(scale, 1.0))}
    return {name: value for name, value in look.items() if now[name] == default[name]}


def wrapped(text: str, width: float, size: float) -> str:
    """Return a text in lines of a width in inches, for letters of this size in points.

    A formula between dollar signs stays whole; its length is that of its symbols. Numbers keep their units.
    """
    formulas = re.findall(_FORMULA, text)
    lengths = [
        len(re.sub(r"\\[a-zA-Z]+", "x", re.sub(r"[${}_^]|\\[,;]", "", formula))) for formula in formulas
    ]
    # While the lines are found, letters of a private plane of Unicode stand for the formulas.
    stand_ins = iter(lengths)
    filled = re.sub(_FORMULA, lambda _: "\ue000" * max(next(stand_ins), 1), text)
    # A line ends at spaces of ASCII only.
    lines = textwrap.fill(
        _BOUND.sub("\N{NO-BREAK SPACE}", filled),
        int(_LETTERS * width / size),
        break_long_words=False,
        break_on_hyphens=False,
    )
    back = iter(formulas)
    return re.sub("\ue000+", lambda _: next(back), lines).replace("\N{NO-BREAK SPACE}", " ")


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
    axes.tick_params(width=0.6)
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


def title_of(subject: object, kind: str) -> str:
    """Return the title of a figure: that of the motion, if it has one, and the kind of figure."""
    title = subject.attributes.get("title") if isinstance(subject, Trajectory) else None
    if title is None:
        return kind
    return str(title).replace("$", r"\$") + ": " + kind[0].lower() + kind[1:]


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
