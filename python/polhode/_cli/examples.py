"""The example scenes of the package, and the commands ``polhode demo`` and ``polhode examples``."""

from __future__ import annotations

import argparse
import difflib
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._cli.common import DRIFTED, OK, add_command, add_folder, add_force, check_written, create_folder
from polhode._support.arrays import Array
from polhode._support.file_kinds import EXAMPLES
from polhode._support.files import write_atomically

if TYPE_CHECKING:
    from polhode._mechanics.trajectory import Trajectory
    from polhode._scene.scene import Scene

NAME = "t-handle"
_PAGE, _FIGURES = f"{NAME}.html", (f"{NAME}-motion.png", f"{NAME}-polhode.png")
_WIDTH, _HEIGHT = 72, 9


def add(commands: Any) -> None:
    """Add both commands to those of `polhode`."""
    demo = add_command(
        commands,
        "demo",
        _demo,
        help="run an example: print a summary and a sketch, write a page and figures",
        description="Run a T-handle in free flight: print its summary and a sketch, and write "
        "t-handle.html, a page that shows it in a browser. With matplotlib it also writes figures.",
    )
    add_folder(demo, "files")
    add_force(demo)

    words = "List the example scenes and lessons, or copy the named ones. Existing files are not replaced."
    parser = add_command(
        commands, "examples", _run, help="list or copy the example scenes and lessons", description=words
    )
    parser.add_argument("names", metavar="NAME", nargs="*", help="name of an example; without one, list all")
    add_folder(parser, "copies")


def examples() -> dict[str, Path]:
    """Return the scene files of the examples by name; a FileNotFoundError if there are none."""
    if not (found := {path.stem: path for path in sorted(EXAMPLES.glob("*.toml"))}):
        raise FileNotFoundError(
            f"{EXAMPLES} has no examples: polhode was installed without them; install a wheel, or copy them "
            "from the folder examples/ of the source repository"
        )
    return found


def lessons() -> dict[str, Path]:
    """Return the files of the lessons by name."""
    return {path.stem: path for path in sorted((EXAMPLES / "lessons").glob("*.md"))}


def _run(options: argparse.Namespace) -> int:
    known = examples() | lessons()
    if not options.names:
        width = max(map(len, known))
        print("\n".join(f"{name:<{width}}  {_title(path)}" for name, path in known.items()))
        return 0
    names = [name.removesuffix(".toml").removesuffix(".md") for name in options.names]
    for name in names:
        if name not in known:
            close = difflib.get_close_matches(name, known, n=1)
            hint = f"did you mean {close[0]}?" if close else "`polhode examples` lists them"
            options.parser.error(f"unknown example {name!r}; {hint}")
    files = [file for name in dict.fromkeys(names) for file in _files(known[name])]
    copied = _copy(files, Path(options.output))
    print("Written", *(f"  {path}" for path in copied), sep="\n")
    run = "" if copied[0].suffix == ".md" else f"`polhode run {copied[0]}` or "
    print(f"Try {run}`polhode view {copied[0]}`.")
    return 0


def _content(path: Path) -> dict[str, Any]:
    return tomllib.loads(path.read_text(encoding="utf-8"))


def _title(path: Path) -> str:
    if path.suffix == ".toml":
        return str(_content(path)["title"])
    line = next(line for line in path.read_text(encoding="utf-8").splitlines() if line.startswith("title:"))
    return f"Lesson: {line.removeprefix('title:').strip().strip(chr(34))}"


def _files(scene: Path) -> list[Path]:
    """Return a lesson, or a scene file and its mesh file, if it has one."""
    if scene.suffix == ".md":
        return [scene]
    mesh = _content(scene)["body"].get("mesh")
    return [scene] if mesh is None else [scene, scene.with_name(mesh)]


def _copy(files: list[Path], folder: Path) -> list[Path]:
    """Copy files into a folder, all or none, and return the copies; an OSError if one exists."""
    targets = {folder / file.name: file.read_bytes() for file in files}
    for path in targets:
        if path.exists() or path.is_symlink():
            raise FileExistsError(f"{path} exists; move it, or choose another folder with -o")
    create_folder(folder)
    write_atomically(targets)
    return list(targets)


# --- the demonstration


def _demo(options: argparse.Namespace) -> int:
    from polhode._report.summary import as_text, summary
    from polhode._scene.scene import Scene

    folder = create_folder(Path(options.output))
    check_written([folder / name for name in (_PAGE, *_FIGURES)], options.force)
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
        contents[folder / _PAGE] = motion_page(trajectory)
    except FileNotFoundError as error:
        missing.append(f"No page: {error}.")
    try:
        from polhode._figures.registry import pictures

        drawn = pictures(scene, trajectory)
        contents |= {folder / name: x for name, x in zip(_FIGURES, drawn, strict=True)}
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
