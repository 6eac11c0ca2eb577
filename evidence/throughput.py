"""Throughput of batches: values per second of each operation and library."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import cycle
from typing import Any

from matplotlib.figure import Figure

SECTION, OURS = "Batches", "polhode"
COLORS = ("#1f77b4", "#ff7f0e", "#2ca02c", "#9467bd", "#17becf", "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22")
CAPTION = (
    "Throughput of batches on all cores: values per second, further right is faster. The tables below have "
    "the times and the expressions. The grey line is the speed of a copy of the operands and results in "
    "memory, which a batch that is already in a cache exceeds."
)


def plot(rows: Iterable[Mapping[str, Any]], bandwidth: float) -> Figure:
    """Plot the rows of the batches, a line each; `bandwidth` in bytes per second."""
    batches = [row for row in rows if row["section"] == SECTION]
    libraries = sorted({name for row in batches for name in row["seconds"]} - {OURS})
    looks = dict(zip(libraries, cycle(zip("sD^v<>Ph*", COLORS, strict=True)), strict=False))
    drawing = Figure(figsize=(9, 1.2 + 0.42 * len(batches)), layout="constrained")
    axes = drawing.subplots()
    for line, row in enumerate(batches):
        axes.axhline(line, color="#8883", linewidth=0.7, zorder=0)
        if row["traffic"]:
            axes.plot([bandwidth / row["traffic"]] * 2, [line - 0.4, line + 0.4], color="#888")
    for name in [*libraries, OURS]:
        seconds = [(row["seconds"].get(name), line) for line, row in enumerate(batches)]
        places = [(1 / time, line) for time, line in seconds if time]
        marker, color = ("o", "#c62828") if name == OURS else looks[name]
        look = {"marker": marker, "color": color, "ms": 8 if name == OURS else 5}
        axes.plot(*zip(*places, strict=True), linestyle="none", label=name, **look)
    axes.set(xscale="log", xlabel="values per second", ylim=(len(batches) - 0.5, -0.5))
    axes.set_yticks(range(len(batches)), [row["what"] for row in batches])
    axes.legend(fontsize=8, ncols=1, loc="center left", bbox_to_anchor=(1.01, 0.5))
    return drawing
