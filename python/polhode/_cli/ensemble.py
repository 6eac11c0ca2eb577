"""Run of an ensemble by the command: bodies block by block to file, page and figures."""

from __future__ import annotations

import contextlib
import shutil
from collections.abc import Mapping
from pathlib import Path

from polhode._cli.common import progress_of_bodies
from polhode._cli.interrupts import uninterruptible
from polhode._mechanics.trajectory import Trajectory
from polhode._report.ensemble.collect import EnsembleRecords
from polhode._report.ensemble.netcdf import EnsembleFile, bytes_of_file
from polhode._report.ensemble.reduced import ReducedRecords
from polhode._scene.scene import Scene
from polhode._support import memory as _memory
from polhode._support.files import naming, unfinished, write_atomically

Records = EnsembleRecords | ReducedRecords


class InterruptedRunError(KeyboardInterrupt):
    """A run was interrupted, and its file has the bodies that were complete."""


def run(
    scene: Scene, targets: list[Path], threads: int | None, pages: Mapping[Path, bytes], quiet: bool = False
) -> Records:
    """Run all bodies and write them and the figures to the targets, if any, and the pages.

    A quiet run shows no progress bar.

    Raises
    ------
    MemoryError, OSError
        If memory or disk are too small; raised before the run.
    InterruptedRunError
        If Ctrl-C stopped the run after some bodies were complete, and there are targets.
    """
    require_room(scene, targets)
    records = _kind(scene)(scene, _nominal(scene))
    if not targets:
        _run_bodies(records, None, threads, quiet)
        write_atomically(pages)
        return records
    with unfinished(targets[0]) as part:
        with naming(targets[0]):
            stopped = _stopped(part, records, threads, quiet)
        with uninterruptible():
            _write(targets, part, records, stopped, pages)
    return records


def _kind(scene: Scene) -> type[Records]:
    assert scene.ensemble is not None
    return ReducedRecords if scene.ensemble.keep else EnsembleRecords


def _stopped(part: Path, records: Records, threads: int | None, quiet: bool) -> bool:
    """Run all bodies into a file; return whether Ctrl-C stopped the run after some bodies."""
    with contextlib.ExitStack() as opened:
        # HDF5 may swallow an interrupt while it creates a file.
        with uninterruptible():
            file = opened.enter_context(contextlib.closing(EnsembleFile(part, records.scene)))
        stopped = False
        try:
            _run_bodies(records, file, threads, quiet)
        except KeyboardInterrupt:
            if not records.complete:
                raise
            stopped = True
        with uninterruptible():
            file.end(records)
    return stopped


def _nominal(scene: Scene) -> Trajectory:
    """Return the motion of the nominal body."""
    try:
        return scene.alone().run()
    except ValueError as error:
        raise ValueError(f"the nominal body failed: {error}") from error


def _run_bodies(records: Records, file: EnsembleFile | None, threads: int | None, quiet: bool) -> None:
    scene = records.scene
    assert scene.ensemble is not None
    shown = progress_of_bodies(scene.path.name, scene.ensemble.number, quiet, lambda: records.total_steps)
    with shown as report:
        for rows, motions in records.blocks(report, threads):
            # A block is recorded as a whole.
            with uninterruptible():
                if file is not None:
                    file.add(rows, motions)
                records.add(rows, motions)  # type: ignore[arg-type]  # of its own blocks


def _write(
    targets: list[Path], part: Path, records: Records, stopped: bool, pages: Mapping[Path, bytes]
) -> None:
    """Write the files; of an interrupted run the data alone."""
    assert records.scene.ensemble is not None
    if stopped:
        write_atomically({targets[0]: part})
        raise InterruptedRunError(
            f"interrupted; {targets[0]} has the bodies that were complete, "
            f"{records.complete} of {records.scene.ensemble.number}"
        )
    contents: dict[Path, bytes | Path] = {targets[0]: part, **pages}
    if targets[1:]:
        from polhode._figures.ensemble import directions_figure, fan_figure
        from polhode._figures.style import as_png

        figures = [as_png(fan_figure(records))]
        if isinstance(records, EnsembleRecords):
            figures.append(as_png(directions_figure(records)))
        contents |= zip(targets[1:], figures, strict=True)
    write_atomically(contents)


def require_room(scene: Scene, targets: list[Path]) -> None:
    """Raise an error if memory or disk are too small for a run."""
    assert scene.ensemble is not None
    what = f"the {scene.ensemble.number} bodies of this scene at {len(scene.times)} times"
    remedy = "take fewer bodies or fewer times"
    _memory.require(_kind(scene).bytes_wanted(scene), what, remedy)
    if targets:
        wanted, free = bytes_of_file(scene), shutil.disk_usage(targets[0].parent).free
        if wanted > free:
            room = f"{_memory.size(wanted)}; its disk has {_memory.size(free)} free"
            raise OSError(f"{targets[0]} needs {room}: {remedy}")
