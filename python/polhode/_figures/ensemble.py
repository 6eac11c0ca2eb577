"""Figures of an ensemble: the spread of its motions over time, and directions of an axis in space."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode._algebra.constructors import vector
from polhode._figures.palette import BLACK, BLUE, ORANGE
from polhode._figures.style import Axes, Figure, halo, new_figure, plotting, time_unit
from polhode._report.ensemble.collect import EnsembleRecords, first_above
from polhode._report.ensemble.reduced import ReducedRecords
from polhode._report.summary import time as time_text
from polhode._support.arrays import Array

_WIDE, _NARROW = "#CFE3F1", "#86BBDD"

# Width in rad of the smoothing kernel; cells that directions are binned in, and cells that are drawn.
_WIDTH = np.radians(4.0)
_COUNTED, _DRAWN = (180, 90), (240, 120)
# Cells per batch of kernels: about 30 MB.
_AT_ONCE = 256
# Directions with a larger cosine count as parallel.
_ALONG = 0.999
# Labels of points above this latitude, in rad, are put below.
_HIGH = np.radians(70)
# Range of the colours: density relative to a uniform distribution.
_FAINTEST, _DENSEST = 0.03, 100.0


def fan_figure(records: EnsembleRecords | ReducedRecords) -> Figure:
    """Draw bands of quantiles over time.

    From the top: the angle of the attitude from that of the nominal body, the tilt of an axis, and the rate.
    """
    figure = new_figure(8, 8)
    panels = figure.subplots(3, 1, sharex=True, height_ratios=(3, 2, 2))
    times, scale = _scale(records.scene.elapsed)
    seconds, unit = time_unit(np.sqrt(times[0] * times[-1]) if scale == "log" else times)
    labels = {
        "from_nominal": "attitude, from that of the\nnominal body, degrees",
        "tilt": f"tilt of the axis\nfrom {records.tilt_name}, degrees",
        "rate": "angular velocity |Ω|,\nrad/s",
    }
    for axes, (name, label) in zip(panels, labels.items(), strict=True):
        bands = records.quantiles(name)[:, -len(times) :]
        _fan(axes, times / seconds, bands if name == "rate" else 180 / np.pi * bands)
        axes.set(xscale=scale, ylabel=label)
        axes.grid(alpha=0.25, lw=0.6)
        axes.margins(x=0)
    _horizons(panels[0], records, seconds)
    panels[1].ticklabel_format(axis="y", useOffset=False)
    panels[0].legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    panels[-1].set_xlabel(f"time, {unit}")
    figure.align_ylabels()
    figure.suptitle(records.scene.name)
    figure.supxlabel(f"Quantiles over {_counted(records)}; the axis: {records.axis_name}.", fontsize=9)
    return figure


def _scale(times: Array) -> tuple[Array, str]:
    """Return the times to draw and the scale; a logarithmic one leaves out the start."""
    if len(times) > 3 and times[-1] - times[-2] > 2 * (times[2] - times[1]):
        return times[1:], "log"
    return times, "linear"


def _fan(axes: Axes, t: Array, bands: Array) -> None:
    low, lower, median, upper, high = bands
    axes.fill_between(t, low, high, color=_WIDE, lw=0, label="5 to 95 %")
    axes.fill_between(t, lower, upper, color=_NARROW, lw=0, label="25 to 75 %")
    axes.plot(t, median, color=BLUE, lw=1.4, label="median")


def _horizons(axes: Axes, records: EnsembleRecords | ReducedRecords, seconds: float) -> None:
    """Mark where the 95 % quantile of the angle exceeds 10° and 90°."""
    highest = records.quantiles("from_nominal")[-1]
    axes.set_ylim(0, 185)
    axes.set_yticks(range(0, 181, 45))
    for angle in (10, 90):
        moment = first_above(records.scene.elapsed, highest, np.radians(angle))
        if not moment:
            continue
        # On the left, above the bands, if there is room.
        left = axes.transLimits.transform(axes.transScale.transform((moment / seconds, angle)))[0] > 0.35
        axes.plot(moment / seconds, angle, "o", color=ORANGE, ms=5, mec="white", mew=0.8, zorder=5)
        axes.annotate(
            f"95 % within {angle}° for {time_text(moment, 3)}",
            (moment / seconds, angle),
            xytext=(-7, 7) if left else (9, 0),
            textcoords="offset points",
            ha="right" if left else "left",
            va="baseline" if left else "center",
            color=ORANGE,
            fontsize=9,
            bbox={"fc": "white", "ec": "none", "alpha": 0.0 if left else 0.75, "pad": 1.5},
        )


def _counted(records: EnsembleRecords | ReducedRecords) -> str:
    finished = records.complete - len(records.failures)
    without = f" ({len(records.failures)} failed on the way)" if records.failures else ""
    counted = f"{finished:,}".replace(",", "\u2009")
    return f"{counted} {'body' if finished == 1 else 'bodies'}{without}"


def directions_figure(records: EnsembleRecords) -> Figure:
    """Draw equal-area maps of the directions of the axis in space at three times.

    Each is centred on the reference of the tilt, L of the nominal body or e3; else on e1.
    """
    figure = new_figure(11, 3.5)
    middle, name = _middle(records)
    frame = _frame(middle)
    panels = figure.subplots(1, 3, subplot_kw={"projection": "hammer"})
    times = records.scene.elapsed
    drawn: Any = None
    for k, axes in enumerate(panels):
        directions = records.directions[:, k].astype(float)
        drawn = _map(axes, directions[np.isfinite(directions).all(axis=1)] @ frame.T)
        when = float(times[records.shown[k]])
        axes.set_title("at the start" if when == 0 else f"after {time_text(when, 3)}", fontsize=11)
        _mark(axes, records, frame, records.shown[k])
    bar = figure.colorbar(
        drawn, ax=list(panels), orientation="horizontal", shrink=0.4, aspect=40, pad=0.03, extend="both"
    )
    bar.set_label("density, relative to a uniform distribution", fontsize=9)
    figure.suptitle(records.scene.name)
    figure.supxlabel(
        f"Directions of {records.axis_name} in space, of {_counted(records)}, smoothed over "
        f"{np.degrees(_WIDTH):.0f}°; ring: the nominal body.\n"
        f"The sphere of space axes from outside, in equal areas, centred on {name}; "
        f"{'e2' if abs(frame[0, 2]) > _ALONG else 'e3'} is up.",
        fontsize=9,
    )
    return figure


def _middle(records: EnsembleRecords) -> tuple[Array, str]:
    """Return the direction on which the maps are centred, and its name."""
    momentum = records.nominal.momentum_space.components[0]
    size = float(np.linalg.norm(momentum))
    if records.tilt_name == "L" and size > 0:
        return momentum / size, "the momentum L of the nominal body"
    if records.tilt_name == "the vertical":
        return np.array([0.0, 0.0, 1.0]), "e3"
    return np.array([1.0, 0.0, 0.0]), "e1"


def _frame(middle: Array) -> Array:
    """Return the rotation (3, 3) that puts a direction in the middle and e3 above it; above e3 itself e2."""
    up = np.array([0.0, 1.0, 0.0]) if abs(middle[2]) > _ALONG else np.array([0.0, 0.0, 1.0])
    up = up - (up @ middle) * middle
    up = up / np.linalg.norm(up)
    return np.stack([middle, np.cross(up, middle), up])


def _map(axes: Axes, directions: Array) -> Any:
    longitude, latitude = np.meshgrid(
        np.linspace(-np.pi, np.pi, _DRAWN[0] + 1), np.linspace(-np.pi / 2, np.pi / 2, _DRAWN[1] + 1)
    )
    density = _density(directions, _unit_vectors(longitude, latitude))
    colours = plotting("matplotlib").colormaps["YlGnBu"].with_extremes(under="white")
    scale = plotting("matplotlib.colors").LogNorm(_FAINTEST, _DENSEST)
    positive = np.maximum(density, np.finfo(float).tiny)
    look = {"cmap": colours, "norm": scale, "shading": "gouraud", "rasterized": True}
    drawn = axes.pcolormesh(longitude, latitude, positive, **look)
    axes.grid(color=BLACK, alpha=0.25, lw=0.5)
    axes.set_xticks(np.radians([-120, -60, 0, 60, 120]), [])
    axes.set_yticks(np.radians([-60, -30, 0, 30, 60]), [])
    return drawn


def _mark(axes: Axes, records: EnsembleRecords, frame: Array, k: int) -> None:
    """Mark the axis of the nominal body and the axes of space."""
    path = records.nominal.rotor(vector(records.axis)).components[k]
    axes.plot(*_angles(frame @ path), "o", mfc="none", mec=ORANGE, mew=1.4, ms=9, zorder=5)
    for name, direction in zip(("e1", "e2", "e3"), frame.T, strict=True):
        place = _angles(direction)
        axes.plot(*place, "o", color=BLACK, ms=3.5, mec="white", mew=0.6, zorder=4)
        offset = (7, -10) if place[1] > _HIGH else (7, 4)
        look: Any = {"fontsize": 8, "zorder": 6, "path_effects": [halo(2)]}
        axes.annotate(name, place, xytext=offset, textcoords="offset points", **look)


def _unit_vectors(longitude: Array, latitude: Array) -> Array:
    across = np.cos(latitude)
    return np.stack([across * np.cos(longitude), across * np.sin(longitude), np.sin(latitude)], axis=-1)


def _angles(direction: Array) -> tuple[Any, Any]:
    """Return longitudes and latitudes of directions (..., 3)."""
    x, y, z = np.moveaxis(direction, -1, 0)
    return np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))


def _density(directions: Array, points: Array) -> Array:
    """Return the density of directions (n, 3) at points (..., 3) of the sphere; a uniform one is 1.

    A sum of kernels ``exp(κ(cos θ − 1))``, κ = 1/width², each with the integral ``2π(1 − exp(−2κ))/κ``.
    Directions in one cell of a fine grid, much smaller than the width, are replaced by their mean.
    """
    longitude, latitude = _angles(directions)
    columns = ((longitude / (2 * np.pi) + 0.5) * _COUNTED[0]).astype(int) % _COUNTED[0]
    rows = np.minimum(((latitude / np.pi + 0.5) * _COUNTED[1]).astype(int), _COUNTED[1] - 1)
    cells, which, counts = np.unique(rows * _COUNTED[0] + columns, return_inverse=True, return_counts=True)
    means = np.stack([np.bincount(which, directions[:, k], len(cells)) for k in range(3)], axis=-1)
    means = means / np.linalg.norm(means, axis=-1, keepdims=True)
    sharpness = 1 / _WIDTH**2
    flat = points.reshape(-1, 3).astype(np.float32)
    total = np.zeros(len(flat))
    for start in range(0, len(cells), _AT_ONCE):
        some = slice(start, start + _AT_ONCE)
        near = flat @ means[some].T.astype(np.float32)
        total += np.exp(np.float32(sharpness) * (near - 1)) @ counts[some].astype(np.float32)
    size = (1 - np.exp(-2 * sharpness)) / (2 * sharpness)
    density: Array = total / (max(len(directions), 1) * size)
    return density.reshape(points.shape[:-1])
