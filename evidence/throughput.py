"""Throughput of batches: values per second of each operation and library."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from matplotlib.figure import Figure

SECTION, OURS = "Batches", "polhode"
CAPTION = (
    "Throughput of batches on all cores: values per second, further right is faster. The tables below have "
    "the times and the expressions. The grey line is the limit of memory: moving the operands and results at "
    "the speed of a copy."
)


def plot(rows: Iterable[Mapping[str, Any]], bandwidth: float) -> Figure:
    """Plot the rows of the batches, a line each; `bandwidth` in bytes per second."""
    batches = [row for row in rows if row["section"] == SECTION]
    libraries = sorted({name for row in batches for name in row["seconds"]} - {OURS})
    looks = dict(zip(libraries, "sD^v<>Ph*X", strict=False))
    drawing = Figure(figsize=(9, 1.2 + 0.42 * len(batches)), layout="constrained")
    axes = drawing.subplots()
    for line, row in enumerate(batches):
        axes.axhline(line, color="#8883", linewidth=0.7, zorder=0)
        if row["traffic"]:
            axes.plot([bandwidth / row["traffic"]] * 2, [line - 0.4, line + 0.4], color="#888")
    for name in [*libraries, OURS]:
        places = [
            (1 / row["seconds"][name], line) for line, row in enumerate(batches) if name in row["seconds"]
        ]
        look = (
            {"marker": "o", "ms": 8, "color": "#c62828"} if name == OURS else {"marker": looks[name], "ms": 5}
        )
        axes.plot(*zip(*places, strict=True), linestyle="none", label=name, **look)
    axes.set(xscale="log", xlabel="values per second", ylim=(len(batches) - 0.5, -0.5))
    axes.set_yticks(range(len(batches)), [row["what"] for row in batches])
    axes.legend(fontsize=8, ncols=1, loc="center left", bbox_to_anchor=(1.01, 0.5))
    return drawing
