"""Work-precision diagrams of motion: error of the final attitude against CPU time.

Every tool goes from time 0 to the end at several settings. The error is |R − R_true| of unit rotors, half the
angle in radians. Our sign must be right; for other libraries the sign of the rotor does not count.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field
from io import BytesIO
from itertools import cycle
from time import process_time
from typing import Any

import numpy as np

import machine
import polhode as ph
import truth
from contest import OURS, Pace, noted
from integrators import PATIENCE, TOOLS, Setting
from report import aligned, figure
from truth import Top

TITLE = "Motion: work and precision"
FREE = Top("Free top", (1, 2, 3), (0, 0, 0), (0.01, 1, 0.01), (1, 0, 0, 0))
LAGRANGE = Top("Lagrange top", (1, 1, 0.5), (0, 0, 2), (0.25, -0.5, 6), (4, 2, 1, 0))
KOVALEVSKAYA = Top("Kovalevskaya top", (2, 2, 1), (1, 0, 0), (0.5, -0.25, 1.5), (4, 1, -2, 1))
TOPS = (FREE, LAGRANGE, KOVALEVSKAYA)
SHORT, LONG = 100.0, 10_000.0
GOAL = 100
RIVAL = "SciPy"
OTHERS = ("black", "tab:green", "tab:cyan")  # colours of the other tools
REFERENCES = machine.ROOT / "tests" / "reference" / "motion_cases.json"
BITS = np.finfo(np.longdouble).nmant + 1
LEGEND = f"""\
One motion from 0 to t. The error is |R − R_true| of the rotor at t, half the angle in radians; the CPU time
is that of the process, the best of several runs. Tolerances are relative and absolute; h is a fixed step.
R_true comes from Taylor series in numbers of {BITS} bits; for the free top beyond t = {SHORT:g} from a table
of 40 digits where there is one (its 0.01 differs from the double by 5e-15), else from our closed form."""


@dataclass(frozen=True)
class Mark:
    """A tool at one setting: final error, CPU time in s, number of steps (0 for a closed form)."""

    tool: str
    setting: str
    error: float
    seconds: float
    steps: int

    @property
    def kind(self) -> tuple[str, str]:
        """The tool and its method."""
        return self.tool, self.setting.partition(",")[0]


@dataclass
class Panel:
    """All tools for one top and one final time, with notes on missing entries."""

    top: Top
    time: float
    marks: list[Mark] = field(default_factory=list)
    notes: dict[str, str] = field(default_factory=dict)

    @property
    def title(self) -> str:
        """The top and the final time."""
        return f"{self.top.name}, t = {self.time:g}"


def panels(
    pace: Pace, tops: tuple[Top, ...] = TOPS, times: tuple[float, ...] = (SHORT, LONG)
) -> Iterator[Panel]:
    """Yield a panel for each top and time, in increasing order of time."""
    true = true_rotors(pace, tops, times)
    for top in tops:
        notes: dict[str, str] = {}
        rates: dict[Setting, float] = {}  # known CPU seconds per unit of time
        for tool, build in TOOLS.items():
            with noted(notes, tool):
                rates |= dict.fromkeys(build(top, notes), 0.0)
        for time in times:
            panel = Panel(top, time, notes=dict(notes))
            if (top, time) in true:
                fast = [each for each in rates if rates[each] * time <= pace.limit * each.patience]
                slow = [f"{each.tool} {each.label}" for each in rates if each not in fast]
                if slow:
                    panel.notes[f"more than {pace.limit:g} s a run"] = "; ".join(slow)
                best = _measured(fast, time, true[top, time], panel.notes, pace)
                rates = {setting: mark.seconds / time for setting, mark in best.items()}
                panel.marks = list(best.values())
            else:
                panel.notes = {"skipped": "the reference motion takes too long"}
            yield panel


def _measured(
    settings: list[Setting], time: float, true: Any, notes: dict[str, str], pace: Pace
) -> dict[Setting, Mark]:
    """Run all settings in turns and keep the best times; long runs are repeated less often."""
    best: dict[Setting, Mark] = {}
    for turn in range(pace.rounds):
        again = [setting for setting, mark in best.items() if (turn + 1) * mark.seconds < 3 * pace.span]
        for setting in again if turn else settings:
            with noted(notes, f"{setting.tool} {setting.label}"):
                mark = _run(setting, time, true, pace.span / 20)
                best[setting] = min(mark, best.get(setting, mark), key=lambda mark: mark.seconds)
    return best


def _run(setting: Setting, time: float, true: Any, span: float) -> Mark:
    """Run once, or repeatedly for `span` seconds: the first of short runs starts with cold caches."""
    best, begin = np.inf, process_time()
    while best == np.inf or process_time() - begin < span:
        start = process_time()
        rotor, steps = setting.solve(time)
        best = min(best, process_time() - start)
    signs = (1,) if setting.tool == OURS else (1, -1)
    error = min(float(np.linalg.norm(rotor - sign * true)) for sign in signs)
    return Mark(setting.tool, setting.label, error, best, steps)


def true_rotors(pace: Pace, tops: tuple[Top, ...], times: tuple[float, ...]) -> dict[tuple[Top, float], Any]:
    """Return the reference rotors by top and time, except those that take too long.

    For the heavy tops at the long time, the series with steps of 1/2 and of 1/4 agree to 5e-13. Near its
    separatrix the free top amplifies even this rounding to 1e-11; there the closed form is more accurate, and
    tables of 40 digits are the most accurate.
    """
    found = {}
    free, heavy = ([top for top in tops if any(top.c) == held] for held in (False, True))
    near = [time for time in times if time <= SHORT]
    far = [time for time in times if time * truth.SECONDS <= PATIENCE * pace.limit]
    for group, asked in ((free, near), (heavy, far)):
        if group:
            for time, rotors in zip(asked, truth.rotors(group, asked), strict=True):
                found |= {(top, time): rotor for top, rotor in zip(group, rotors, strict=True)}
    return found | {(top, time): _free_rotor(top, time) for top in free for time in times if time > SHORT}


def _free_rotor(top: Top, time: float) -> Any:
    """Return a free top's rotor from the table of reference motions, else from our closed form."""
    for case in json.loads(REFERENCES.read_text())["free_top"]:
        given = (case["inertia"], case["omega0"], case["R0"])
        if [tuple(map(float, x)) for x in given] != [top.moments, top.omega, top.rotor]:
            continue
        for result in case["results"]:
            if float(result["t"]) == time:
                return np.array([np.longdouble(x) for x in result["R"]])
    start = ph.Rotor.from_components(np.array(top.rotor, dtype=float))
    body = ph.Inertia.from_principal_moments(*top.moments)
    return ph.FreeMotion(body, start, np.array(top.omega)).at(time).rotor.components


def ahead(panel: Panel) -> list[tuple[Mark, Mark, float]]:
    """For each SciPy run return it, our fastest run of at most its error, and the ratio of the times."""
    found = []
    for rival in panel.marks:
        ours = [mark for mark in panel.marks if mark.tool == OURS and mark.error <= rival.error]
        if rival.tool == RIVAL and ours:
            best = min(ours, key=lambda mark: mark.seconds)
            found.append((rival, best, rival.seconds / best.seconds))
    return found


def section(found: list[Panel]) -> str:
    """Return a table, the comparison with SciPy and the notes for each panel."""
    parts = [f"## {TITLE}", LEGEND]
    for panel in found:
        lines = [["tool", "setting", "error", "CPU ms", "steps"]]
        for m in panel.marks:
            lines.append([m.tool, m.setting, f"{m.error:.1e}", figure(1e3 * m.seconds), str(m.steps or "–")])
        rivals = [
            f"{figure(ratio)}× ({rival.setting.rpartition(' ')[2]}; {best.setting})"
            for rival, best, ratio in ahead(panel)
        ]
        notes = [f"- {name}: {note}" for name, note in panel.notes.items()]
        if rivals:
            what = "CPU time of DOP853 / ours at the same error or better"
            notes.insert(0, f"- {what}: {', '.join(rivals)}; goal {GOAL}×")
        tables = [aligned(lines), "\n".join(notes)] if panel.marks else ["\n".join(notes)]
        parts += [f"### {panel.title}", *(table for table in tables if table)]
    return "\n\n".join(parts) + "\n"


def data(found: list[Panel]) -> list[dict[str, Any]]:
    """Return the panels for JSON, times in seconds."""
    return [asdict(panel) for panel in found]


def _colours(kinds: list[tuple[str, str]]) -> dict[tuple[str, str], Any]:
    """Return a colour for each method of ours, from violet to orange, and one for each other tool."""
    from matplotlib import colormaps

    others = dict(zip((tool for tool in TOOLS if tool != OURS), OTHERS, strict=True))
    ours = [kind for kind in kinds if kind[0] == OURS]
    shades = dict(zip(ours, colormaps["plasma"](np.linspace(0.0, 0.85, len(ours))), strict=True))
    return {kind: shades[kind] if kind in shades else others[kind[0]] for kind in kinds}


def plot(found: list[Panel]) -> bytes | None:
    """Plot error against CPU time as a PNG, one plot for each panel; None without matplotlib."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        return None
    found = [panel for panel in found if panel.marks]
    columns = min(2, len(found))
    rows = -(-len(found) // columns)
    drawing = Figure(figsize=(6.5 * columns, 4.2 * rows), layout="constrained")
    kinds = list(dict.fromkeys(mark.kind for panel in found for mark in panel.marks))
    colours = _colours(kinds)
    lines = {}
    for panel, axes in zip(found, drawing.subplots(rows, columns, squeeze=False).flat, strict=False):
        for kind, shape in zip(kinds, cycle("os^vD<>Pp*Xhd"), strict=False):
            marks = [mark for mark in panel.marks if mark.kind == kind]
            x, y = [mark.seconds for mark in marks], [max(mark.error, 1e-17) for mark in marks]
            look = {"marker": shape, "ms": 5, "lw": 1 if kind[0] == OURS else 2, "color": colours[kind]}
            if marks:
                (lines[kind],) = axes.loglog(x, y, label=" ".join(kind), alpha=0.8, **look)
        axes.set(title=panel.title, xlabel="CPU time in s", ylabel="|R − R_true|")
        axes.grid(alpha=0.3)
    shown = [lines[kind] for kind in kinds]
    drawing.legend(handles=shown, loc="outside lower center", ncols=5, fontsize=8)
    file = BytesIO()
    drawing.savefig(file, format="png", dpi=110)
    return file.getvalue()
