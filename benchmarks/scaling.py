"""Cost of a body in an ensemble by number of bodies, steps and cores; growth of memory."""

from __future__ import annotations

import resource
from collections.abc import Callable
from dataclasses import asdict, dataclass
from io import BytesIO
from time import perf_counter
from typing import Any

import numpy as np

import machine
import polhode as ph
from contest import Pace
from report import aligned, figure

TITLE = "Ensembles: cost of a body"
MOMENTS = (1.0, 2.0, 2.5)
STEP = 0.01
WORK = 20_000_000  # largest number of body-steps of a measurement
LEGEND = """\
Time of `ph.simulate` with one output time, divided by bodies × steps. With few of them it is the cost of the
call, with many that of the arithmetic. The speed-up is the time on one thread over that on all cores."""


@dataclass(frozen=True)
class Point:
    """A measurement: the varied quantity, bodies, steps, ns per body-step, and growth of memory in MB."""

    what: str
    bodies: int
    steps: int
    nanoseconds: float
    megabytes: float


def _cost(work: Callable[[], Any], count: int, pace: Pace) -> float:
    """Return the best time in ns, divided by `count`."""
    best, begin = np.inf, perf_counter()
    for turn in range(pace.rounds):
        if turn and perf_counter() - begin > 10 * pace.span:
            break
        start = perf_counter()
        work()
        best = min(best, perf_counter() - start)
    return 1e9 * best / count


def _stepped(what: str, bodies: int, steps: int, pace: Pace, **options: Any) -> Point:
    rng = np.random.default_rng(1)
    body = ph.Inertia.from_principal_moments(*MOMENTS)
    states = ph.State(ph.Rotor.random(bodies, rng=rng), rng.normal(size=(bodies, 3)))
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    def work() -> Any:
        return ph.simulate(body, states, [steps * STEP], method="rk4", step=STEP, **options)

    cost = _cost(work, bodies * steps, pace)
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    return Point(what, bodies, steps, cost, grown / 1024)


def points(pace: Pace) -> list[Point]:
    """Measure all points; fewer at the quick pace."""
    most = 6 if pace.batch >= 1_000_000 else 4
    counts = [10**k for k in range(most + 1)]
    found = []
    for bodies in counts:
        steps = max(min(1000, WORK // bodies), 10)
        found.append(_stepped("bodies", bodies, steps, pace))
    for steps in counts[1:]:
        found.append(_stepped("steps", min(1024, max(WORK // steps, 16)), steps, pace))
    for threads in sorted({1, machine.cores()}):
        found.append(_stepped(f"{threads} threads", 4096, WORK // 4096, pace, threads=threads))
    return found


def section(found: list[Point]) -> str:
    """Return the table."""
    lines = [["varied", "bodies", "steps", "ns per body-step", "M body-steps/s", "memory growth, MB"]]
    for p in found:
        rate = 1e3 / p.nanoseconds
        lines.append(
            [p.what, str(p.bodies), str(p.steps), figure(p.nanoseconds), figure(rate), figure(p.megabytes)]
        )
    by_threads = [p.nanoseconds for p in found if p.what.endswith("threads")]
    note = f"\nSpeed-up on {machine.cores()} cores: {by_threads[0] / by_threads[-1]:.2f}\n"
    return f"## {TITLE}\n\n{LEGEND}\n\n{aligned(lines)}\n{note}"


def data(found: list[Point]) -> list[dict[str, Any]]:
    """Return the points for JSON."""
    return [asdict(point) for point in found]


def plot(found: list[Point]) -> bytes | None:
    """Plot the cost against bodies and against steps as a PNG; None without matplotlib."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        return None
    drawing = Figure(figsize=(10, 4.2), layout="constrained")
    for axes, what in zip(drawing.subplots(1, 2, sharey=True), ("bodies", "steps"), strict=True):
        chosen = [p for p in found if p.what == what]
        axes.loglog(
            [getattr(p, what) for p in chosen], [p.nanoseconds for p in chosen], "o-", color="tab:red"
        )
        for p in chosen:
            other = f"{p.steps} steps" if what == "bodies" else f"{p.bodies} bodies"
            axes.annotate(
                other, (getattr(p, what), p.nanoseconds), (4, 6), textcoords="offset points", fontsize=7
            )
        axes.set(xlabel=f"number of {what}", ylabel="ns per body-step", title=f"rk4, free bodies, by {what}")
        axes.grid(alpha=0.3, which="both")
        axes.margins(x=0.2, y=0.15)  # for the labels of the points
        axes.label_outer()
    file = BytesIO()
    drawing.savefig(file, format="png", dpi=110)
    return file.getvalue()
