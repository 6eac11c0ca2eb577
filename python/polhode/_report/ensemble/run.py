"""The command's run of an ensemble: its bodies block by block into the file, the page and the figures."""

from __future__ import annotations

import contextlib
import shutil
import signal
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import FrameType
from typing import Any

from polhode._mechanics.trajectory import Trajectory
from polhode._report.ensemble.collect import Gathered
from polhode._report.ensemble.netcdf import EnsembleFile, bytes_of_file
from polhode._scene.scene import Scene
from polhode._support import memory as _memory
from polhode._support.extras import progress_bar
from polhode._support.files import unfinished, write_atomically


class InterruptedRunError(KeyboardInterrupt):
    """A run was stopped, and its file has the bodies that were complete; the message says so."""


def run(
    scene: Scene, targets: list[Path], threads: int | None, pages: Mapping[Path, bytes] | None = None
) -> Gathered:
    """Run all bodies and write them and the figures to the targets, if there are any, and pages beside them.

    Raises
    ------
    MemoryError, OSError
        If memory or the disk cannot hold what the run would need: before it begins.
    InterruptedRunError
        If it was stopped by Ctrl-C when some bodies were complete, and there are targets.
    """
    require_room(scene, targets)
    gathered = Gathered(scene, _nominal(scene))
    with contextlib.ExitStack() as stack:
        part = stack.enter_context(unfinished(targets[0])) if targets else None
        stopped = False
        with contextlib.nullcontext() if part is None else EnsembleFile(part, scene) as file:
            try:
                _run_bodies(gathered, file, threads)
            except KeyboardInterrupt:
                if file is None or not gathered.complete:
                    raise
                stopped = True
            with _uninterrupted():
                if file is not None:
                    file.end()
        if part is not None:
            with _uninterrupted():
                _write(targets, part, gathered, stopped, pages or {})
        elif pages:
            write_atomically(pages)
    return gathered


def _nominal(scene: Scene) -> Trajectory:
    """Return the motion of the scene's own body, from which all others are measured."""
    try:
        return scene.alone().run()
    except ValueError as error:
        raise ValueError(f"the body from which the others differ cannot be followed: {error}") from error


def _run_bodies(gathered: Gathered, file: EnsembleFile | None, threads: int | None) -> None:
    with _progress(gathered) as report:
        for rows, trajectory in gathered.scene.run_blocks(progress=report, threads=threads):
            # A block is taken in whole or not at all.
            with _uninterrupted():
                if file is not None:
                    file.add(rows, trajectory)
                gathered.add(rows, trajectory)


def _write(
    targets: list[Path], part: Path, gathered: Gathered, stopped: bool, pages: Mapping[Path, bytes]
) -> None:
    """Let the files take their names; of a run that was stopped the data alone."""
    assert gathered.scene.ensemble is not None
    if stopped:
        write_atomically({targets[0]: part})
        raise InterruptedRunError(
            f"interrupted; {targets[0]} has the bodies that were complete, "
            f"{gathered.complete} of {gathered.scene.ensemble.number}"
        )
    from polhode._figures.ensemble import directions_figure, fan_figure
    from polhode._figures.style import as_png

    figures = (as_png(fan_figure(gathered)), as_png(directions_figure(gathered)))
    write_atomically({**dict(zip(targets, (part, *figures), strict=True)), **pages})


def require_room(scene: Scene, targets: list[Path]) -> None:
    """Raise an error with the numbers if memory or the disk cannot hold what a run needs."""
    assert scene.ensemble is not None
    what = f"the {scene.ensemble.number} bodies of this scene at {len(scene.times)} times"
    remedy = "take fewer bodies or fewer times"
    _memory.require(Gathered.bytes_wanted(scene), what, remedy)
    if targets:
        wanted, free = bytes_of_file(scene), shutil.disk_usage(targets[0].parent).free
        if wanted > free:
            told = f"{_memory.size(wanted)}; {_memory.size(free)} are free on its disk"
            raise OSError(f"{targets[0]} would take {told}: {remedy}")


@contextlib.contextmanager
def _uninterrupted() -> Iterator[None]:
    """Let Ctrl-C wait until what is inside is done."""
    waiting: list[int] = []

    def remember(number: int, _: FrameType | None) -> None:
        waiting.append(number)

    before = signal.signal(signal.SIGINT, remember)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
    if waiting:
        raise KeyboardInterrupt


@contextlib.contextmanager
def _progress(gathered: Gathered) -> Iterator[Callable[[int, float], Any] | None]:
    """Show on standard error, if a terminal, how many bodies are done, how fast, and the time left."""
    shown = progress_bar("{task.completed:.0f} of {task.total:.0f} bodies, {task.fields[rate]}")
    if shown is None:
        yield None
        return
    assert gathered.scene.ensemble is not None
    number, begin = gathered.scene.ensemble.number, time.monotonic()
    with shown as bar:
        task = bar.add_task(gathered.scene.path.name, total=number, rate="…")

        def report(_: int, fraction: float) -> None:
            seconds = max(time.monotonic() - begin, 1e-3)
            rate = f"{fraction * number / seconds:.3g} bodies/s"
            if steps := int(gathered.steps[: gathered.complete].sum()):
                rate += f", {steps / seconds:.3g} body-steps/s"
            bar.update(task, completed=fraction * number, rate=rate)

        yield report
