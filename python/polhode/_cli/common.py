"""Exit codes, types of arguments, and the progress bar of the commands."""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from polhode._native import SceneError
from polhode._support.file_kinds import require_scene
from polhode._support.files import check_target, form_of

if TYPE_CHECKING:
    from polhode._scene.scene import Scene
    from polhode._support.blocks import Report

OK, FAILED, BAD_INPUT, DRIFTED, INTERRUPTED, TERMINATED = 0, 1, 3, 4, 130, 143

# Name of standard input in messages; bytes that are read from it, more than a scene may have.
_STDIN, _LARGEST = "<stdin>", 10_000_001


class CommandParser(argparse.ArgumentParser):
    """Parser of a command whose options may also stand between its arguments."""

    _is_retry = False

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse as argparse does, and once more if it leaves arguments that follow an option."""
        found = super().parse_known_args(args, namespace)
        extras = found[1]
        if self._is_retry or not extras or any(x.startswith("-") and x != "-" for x in extras):
            return found
        self._is_retry = True
        try:
            return self.parse_known_intermixed_args(args, namespace)
        finally:
            self._is_retry = False


def add_command(
    commands: Any, name: str, run: Callable[[argparse.Namespace], int], **words: str
) -> argparse.ArgumentParser:
    """Add a command to those of `polhode`; `run` finds its parser in the options."""
    parser: argparse.ArgumentParser = commands.add_parser(name, **words)
    parser.set_defaults(command=run, parser=parser)
    return parser


def add_folder(parser: argparse.ArgumentParser, what: str) -> None:
    """Add the option of a folder to write to."""
    words = f"folder for the {what}, created if missing, default the current one"
    parser.add_argument("-o", "--output", metavar="FOLDER", default=".", help=words)


def create_folder(path: Path) -> Path:
    """Return a folder to write to, created if it is missing; an OSError if this is not possible."""
    if path.exists() and not path.is_dir():
        raise NotADirectoryError(f"{path} is not a folder; choose another one with -o")
    path.mkdir(parents=True, exist_ok=True)
    return path


def file_name(what: str) -> Callable[[str], str]:
    """Return an argparse type that checks the suffix of a file to be written."""

    def checked(name: str) -> str:
        try:
            form_of(name, what)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None
        return name

    return checked


def whole_number(what: str, least: int, most: float) -> Callable[[str], int]:
    """Return an argparse type for integers in a range."""

    def checked(text: str) -> int:
        if not (text.isascii() and text.isdigit() and least <= int(text) <= most):
            bounds = f"of at least {least}" if most == math.inf else f"from {least} to {most}"
            raise argparse.ArgumentTypeError(f"{what} must be an integer {bounds}, got {text!r}")
        return int(text)

    return checked


def read_scene(name: str) -> Scene:
    """Read a scene file; ``-`` is standard input, whose mesh is relative to the current folder.

    Raises
    ------
    SceneError
        As `Scene.read`; places in standard input have the file name ``<stdin>``. Of a file of another kind
        it says what that is.
    """
    from polhode._scene.scene import Scene

    if name != "-":
        require_scene(name)
        return Scene.read(name)
    from polhode._viewer.document import of_text, scene_of

    if sys.stdin is None:
        raise OSError("standard input is closed; give the path of a scene file")
    try:
        text = sys.stdin.buffer.read(_LARGEST).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise SceneError(f"{_STDIN}: error: not UTF-8 text from byte {error.start} on") from None
    return scene_of(of_text(text, Path(_STDIN)))


def add_amount(parser: argparse.ArgumentParser, what: str) -> None:
    """Add the options of what is printed."""
    amount = parser.add_mutually_exclusive_group()
    amount.add_argument("--json", action="store_true", help=f"print {what}")
    amount.add_argument("--quiet", action="store_true", help="print errors and warnings only")


def add_force(parser: argparse.ArgumentParser) -> None:
    """Add the option that overwrites files of others."""
    words = "overwrite existing files even if polhode did not write them"
    parser.add_argument("--force", action="store_true", help=words)


def check_written(paths: Iterable[Path], force: bool) -> None:
    """Raise an OSError if a file cannot be written, or without `force` if it is not polhode's own."""
    from polhode._report.output import require_own

    for path in paths:
        check_target(path)
        if not force:
            require_own(path)


@contextmanager
def progress(name: str, quiet: bool = False) -> Iterator[Report | None]:
    """Show a progress bar of a name on standard error, if that is a terminal; a pass of 0 is not shown."""
    from polhode._support.extras import progress_bar

    if quiet or (shown := progress_bar("{task.percentage:>3.0f} %")) is None:
        yield None
        return
    with shown as bar:
        task = bar.add_task(name, total=1.0)

        def report(number: int, fraction: float) -> None:
            bar.update(task, description=f"{name}, pass {number}" if number else name, completed=fraction)

        yield report


@contextmanager
def progress_of_bodies(
    name: str, number: int, quiet: bool = False, steps: Callable[[], int] = lambda: 0
) -> Iterator[Report | None]:
    """Show a progress bar of bodies on standard error, with their rate and that of the `steps` so far."""
    from polhode._support.extras import progress_bar

    shown = progress_bar("{task.completed:.0f} of {task.total:.0f} bodies, {task.fields[rate]}")
    if shown is None or quiet:
        yield None
        return
    begin = time.monotonic()
    with shown as bar:
        task = bar.add_task(name, total=number, rate="…")

        def report(_: int, fraction: float) -> None:
            seconds = max(time.monotonic() - begin, 1e-3)
            rate = f"{fraction * number / seconds:.3g} bodies/s"
            if done := steps():
                rate += f", {done / seconds:.3g} body-steps/s"
            bar.update(task, completed=fraction * number, rate=rate)

        yield report


def positive(text: str, wanted: str) -> float:
    """Return the positive finite number that an option was given; the error begins with what is wanted."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{wanted}, got {text!r}")
    return value
