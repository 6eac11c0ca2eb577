"""The command ``polhode demo``: a T-handle in free flight."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._cli.common import DRIFTED, OK, add_command, add_folder
from polhode._support.arrays import Array

if TYPE_CHECKING:
    from polhode._mechanics.trajectory import Trajectory
    from polhode._scene.scene import Scene

NAME = "t-handle"
_WIDTH, _HEIGHT = 72, 9


def add(commands: Any) -> None:
    """Add the command to those of `polhode`."""
    demo = add_command(
        commands,
        "demo",
        _run,
        help="run an example: print a summary and a sketch, write a page and figures",
        description="Run a T-handle in free flight: print its summary and a sketch, and write "
        "t-handle.html, a page that shows it in a browser. With matplotlib it also writes figures.",
    )
    add_folder(demo, "files")


def _run(options: argparse.Namespace) -> int:
    from polhode._cli.examples import examples
    from polhode._report.summary import summary
    from polhode._report.text import as_text
    from polhode._scene.scene import Scene
    from polhode._support.files import check_target, write_atomically

    folder = Path(options.output)
    check_target(folder / f"{NAME}.html")
    scene = Scene.read(examples()[NAME])
    trajectory = scene.run()
    result = summary(scene, trajectory)
    print(as_text(result), "", *_sketch(trajectory), "", sep="\n")
    written, missing = _contents(scene, trajectory, folder)
    write_atomically(written)
    print(*missing, *(["Written"] if written else []), *(f"  {path}" for path in written), sep="\n")
    return OK if result["run"]["drift_within_bound"] else DRIFTED


def _contents(scene: Scene, trajectory: Trajectory, folder: Path) -> tuple[dict[Path, bytes], list[str]]:
    """Return the contents of the files by path, and messages about missing libraries."""
    from polhode._viewer.server import motion_page

    contents: dict[Path, bytes] = {}
    missing = []
    try:
        contents[folder / f"{NAME}.html"] = motion_page(trajectory)
    except FileNotFoundError as error:
        missing.append(f"No page: {error}.")
    try:
        from polhode._figures.registry import pictures

        names = (f"{NAME}-motion.png", f"{NAME}-polhode.png")
        contents |= {folder / name: x for name, x in zip(names, pictures(scene, trajectory), strict=True)}
    except ImportError as error:
        missing.append(f"No figures: {error}.")
    return contents, missing


def _sketch(trajectory: Trajectory) -> list[str]:
    """Return a plot of the angular velocity about the stem over time, as lines of text."""
    values = trajectory.omega_body.components[:, 1]
    labels = {
        0: f"{abs(values).max():.3g} rad/s",
        _HEIGHT // 2: "0",
        _HEIGHT - 1: f"-{abs(values).max():.3g}",
    }
    return [
        "Angular velocity about the stem: it changes sign at each flip",
        *(f"{labels.get(k, ''):>10} |{row}" for k, row in enumerate(_rows(values))),
        f"{'':>10} +{'-' * _WIDTH}",
        f"{'':>12}0{f'{trajectory.time[-1]:g} s':>{_WIDTH - 1}}",
    ]


def _rows(values: Array) -> list[str]:
    """Return the rows of a plot of values as text; 0 is in the middle row."""
    marks = np.full((_HEIGHT, _WIDTH), " ")
    scaled = np.rint((1 - values / abs(values).max()) / 2 * (_HEIGHT - 1)).astype(int)
    for column, part in enumerate(np.array_split(scaled, _WIDTH)):
        marks[part.min() : part.max() + 1, column] = "*"
    return ["".join(row).rstrip() for row in marks]
