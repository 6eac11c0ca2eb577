"""Cost of an ensemble's body by number of bodies and by output: none, netCDF file, Zarr store."""

from __future__ import annotations

import resource
import shutil
import tempfile
from collections.abc import Callable
from dataclasses import asdict, dataclass
from io import BytesIO
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

import polhode as ph
from contest import Pace
from polhode._cli.ensemble import run
from report import aligned, figure

TITLE = "Ensembles: cost of files"
SAMPLES = 11
ROUNDS = 3
LEGEND = f"""\
CPU time, user and system, on one thread in µs for each body, at {SAMPLES} output times, median of {ROUNDS}.
`motion` is the computation alone (`Scene.run_blocks`), `summary` that of `polhode run` without an output,
`netCDF` that of `polhode run -o a.nc`, and `Zarr` that of `scene.run(store="a.zarr")`, which has no summary.
`np.save` writes the numbers of attitudes and angular velocities, as these two do, and nothing else."""

EXACT = """\
[body]
moments = [1, 2, 3]
[initial]
spin = {{ vector = [0.01, 1, 0.01] }}
[ensemble]
number = {number}
seed = 5
attitude = "uniform"
spin = {{ direction = "uniform", relative = 0.1 }}
moments = {{ relative = 0.05 }}
[run]
duration = "10 s"
samples = {samples}
"""
LAWS = "[torque]\ndamping = 0.2\nmagnetic = {{ dipole = [1, 0, 0], field = [0, 1, 2] }}\n[ensemble]"
SCENES = {"free, exact": EXACT, "damped, stepped": EXACT.replace("[ensemble]", LAWS)}


def _motion(scene: ph.Scene, _: Path) -> None:
    for _ in scene.run_blocks(threads=1):
        pass


def _numbers(scene: ph.Scene, folder: Path) -> None:
    assert scene.ensemble is not None
    np.save(folder / "a.npy", np.ones((scene.ensemble.number, len(scene.times), 4 + 3)))


OUTPUTS: dict[str, Callable[[ph.Scene, Path], object]] = {
    "motion": _motion,
    "summary": lambda scene, _: run(scene, [], 1, {}, quiet=True),
    "netCDF": lambda scene, folder: run(scene, [folder / "a.nc"], 1, {}, quiet=True),
    "Zarr": lambda scene, folder: scene.run(store=folder / "a.zarr", threads=1).close(),
    "np.save": _numbers,
}


@dataclass(frozen=True)
class Point:
    """A measurement: the scene, number of bodies, and CPU time of a body in µs by output."""

    scene: str
    bodies: int
    microseconds: dict[str, float]


def points(pace: Pace) -> list[Point]:
    """Measure all points, from 1000 bodies on, that do not exceed the time limit of the pace."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for name, text in SCENES.items():
            _measured(text, 10, Path(folder), 1)  # imports the libraries
            for number in (1000, 10_000, 100_000, 1_000_000):
                costs = _measured(text, number, Path(folder), ROUNDS)
                found.append(Point(name, number, costs))
                if 10 * number * max(costs.values()) > 1e6 * pace.limit:
                    break
    return found


def _measured(text: str, number: int, folder: Path, rounds: int) -> dict[str, float]:
    """Return the CPU time of a body in µs by output."""
    (folder / "a.toml").write_text(text.format(number=number, samples=SAMPLES))
    scene, times = ph.Scene.read(folder / "a.toml"), {name: [] for name in OUTPUTS}
    for _ in range(rounds):
        for name, work in OUTPUTS.items():
            # One folder for each run: disks are slow to use again what was just deleted.
            own = Path(tempfile.mkdtemp(dir=folder))
            start = _cpu()
            work(scene, own)
            times[name].append(_cpu() - start)
    for path in folder.iterdir():
        if path.is_dir():
            shutil.rmtree(path)
    return {name: 1e6 * median(spent) / number for name, spent in times.items()}


def _cpu() -> float:
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def section(found: list[Point]) -> str:
    """Return the table."""
    lines = [["motion", "bodies", *(f"{name}, µs" for name in OUTPUTS), "Zarr / summary"]]
    for p in found:
        ratio = p.microseconds["Zarr"] / p.microseconds["summary"]
        lines.append([p.scene, str(p.bodies), *(figure(x) for x in p.microseconds.values()), f"{ratio:.2f}"])
    return f"## {TITLE}\n\n{LEGEND}\n\n{aligned(lines)}\n"


def data(found: list[Point]) -> list[dict[str, Any]]:
    """Return the points for JSON."""
    return [asdict(point) for point in found]


def plot(found: list[Point]) -> bytes | None:
    """Plot the cost of a body against the number of bodies as a PNG; None without matplotlib."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        return None
    drawing = Figure(figsize=(10, 4.2), layout="constrained")
    for axes, name in zip(drawing.subplots(1, len(SCENES)), SCENES, strict=True):
        chosen = [p for p in found if p.scene == name]
        for output in OUTPUTS:
            axes.loglog(
                [p.bodies for p in chosen], [p.microseconds[output] for p in chosen], "o-", label=output
            )
        axes.set(xlabel="number of bodies", ylabel="CPU time, µs per body", title=name)
        axes.grid(alpha=0.3, which="both")
        axes.legend()
    file = BytesIO()
    drawing.savefig(file, format="png", dpi=110)
    return file.getvalue()
