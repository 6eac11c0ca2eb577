"""The command ``polhode demo``: the T-handle in free flight, its page and its pictures."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._support.arrays import Array

if TYPE_CHECKING:
    from polhode._mechanics.trajectory import Trajectory
    from polhode._scene.scene import Scene

NAME = "t-handle"
_WIDTH, _HEIGHT = 72, 9


def add(commands: Any) -> None:
    """Add the command to those of `polhode`."""
    demo = commands.add_parser(
        "demo",
        help="run the T-handle, sketch it here, and write its page and pictures",
        description="Run a T-handle in free flight: print its summary and a sketch, and write "
        "t-handle.html, a page that shows it in any browser. With matplotlib it also writes pictures.",
    )
    demo.add_argument(
        "-o",
        "--output",
        metavar="FOLDER",
        default=".",
        help="write into this folder; the current one if left out",
    )
    demo.set_defaults(command=_run)


def _run(options: argparse.Namespace) -> int:
    from polhode._cli.examples import examples
    from polhode._cli.main import DRIFTED, OK
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
    written, missing = _made(scene, trajectory, folder)
    write_atomically(written)
    print(*missing, *(["Written"] if written else []), *(f"  {path}" for path in written), sep="\n")
    return OK if result["run"]["drift_within_bound"] else DRIFTED


def _made(scene: Scene, trajectory: Trajectory, folder: Path) -> tuple[dict[Path, bytes], list[str]]:
    """Return the contents of the files that can be written here, and what to install for the others."""
    from polhode._viewer.server import motion_page

    made: dict[Path, bytes] = {}
    missing = []
    try:
        made[folder / f"{NAME}.html"] = motion_page(trajectory)
    except FileNotFoundError as error:
        missing.append(f"No page: {error}.")
    try:
        from polhode._figures.registry import characteristic_figure
        from polhode._figures.style import as_png, motion_figure

        made[folder / f"{NAME}-motion.png"] = as_png(motion_figure(trajectory))
        made[folder / f"{NAME}-polhode.png"] = as_png(characteristic_figure(scene, trajectory))
    except ImportError as error:
        missing.append(f"No pictures: {error}.")
    return made, missing


def _sketch(trajectory: Trajectory) -> list[str]:
    """Return lines of text that draw the angular velocity about the stem over time."""
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
    """Return rows of text, 0 in the middle one; each column has a mark wherever its part of the values is."""
    marks = np.full((_HEIGHT, _WIDTH), " ")
    scaled = np.rint((1 - values / abs(values).max()) / 2 * (_HEIGHT - 1)).astype(int)
    for column, part in enumerate(np.array_split(scaled, _WIDTH)):
        marks[part.min() : part.max() + 1, column] = "*"
    return ["".join(row).rstrip() for row in marks]
