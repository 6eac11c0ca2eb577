"""Runs that fill the Zarr store of an ensemble, begin or continue it."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

from polhode import _native
from polhode._report.ensemble.block import compute_block
from polhode._report.ensemble.cluster import ClusterError, check_address, compute_on, connected
from polhode._report.ensemble.layout import Variable
from polhode._report.ensemble.netcdf import bytes_of_file
from polhode._report.ensemble.reduced import ReducedBlock, over_bodies, reduction_of
from polhode._report.ensemble.store import EnsembleStore
from polhode._scene.scene import Scene
from polhode._support import memory
from polhode._support.blocks import Report, part_of
from polhode._support.counts import counted
from polhode._support.files import check_target
from polhode._support.locks import LockedError


class InterruptedRunError(KeyboardInterrupt):
    """A run was interrupted, and its store has the blocks that were complete."""


def fill(
    scene: Scene,
    path: str | os.PathLike[str],
    *,
    resume: bool = False,
    bodies: tuple[int, int] | None = None,
    cluster: str | None = None,
    replace: bool = False,
    progress: Report | None = None,
    threads: int | None = None,
) -> EnsembleStore:
    """Compute the blocks of a store that are missing or corrupt, and return it; arguments as for `Scene.run`.

    `replace` removes an existing store first.
    """
    if cluster is not None:
        check_address(cluster)
        if not scene.path.is_file():
            raise ValueError(
                f"workers of a cluster read the scene from its file, and {scene.path} does not exist: save it"
            )
    store = _opened(scene, Path(path), resume or bodies is not None, replace, bodies)
    blocks = store.blocks_of(bodies)
    try:
        with store.locked(blocks):
            store.mend(scene)
            if cluster is None:
                _compute(store, scene, blocks, progress, threads)
            else:
                with connected(cluster) as client:
                    compute_on(client, store, scene, blocks, progress, threads)
            store.finish(lambda: over_all(store, scene))
    except KeyboardInterrupt:
        raise InterruptedRunError(f"interrupted; {_kept(store)}") from None
    except LockedError:
        raise
    except ClusterError as error:
        raise ClusterError(f"{error}; {_kept(store)}") from error
    except OSError as error:
        why = error.strerror or error
        raise OSError(f"cannot write {store.path}: {why}; {_kept(store)}") from error
    return store


def over_all(store: EnsembleStore, scene: Scene) -> Iterator[Variable]:
    """Yield the variables that follow from the counts of all blocks."""
    assert scene.ensemble is not None
    if "quantiles" in scene.ensemble.keep:
        counts = _native.BinCounts(len(scene.times))
        for index in range(store.blocks):
            ReducedBlock.add_counts(store.counts_of(index), counts)
        yield from over_bodies(reduction_of(scene), counts)


def _opened(
    scene: Scene, path: Path, resume: bool, replace: bool, bodies: tuple[int, int] | None
) -> EnsembleStore:
    """Return the store at a path, a new one if there is none."""
    require_ensemble(scene, path, bodies)
    if not EnsembleStore.exists(path):
        if os.path.lexists(path):
            raise FileExistsError(f"{path} exists and is not a store of polhode: choose another name")
        check_target(path)
        _require_room(scene, path)
        return _created(path, scene)
    store = EnsembleStore.open(path)
    if replace:
        beside = tempfile.TemporaryDirectory(prefix=f".{path.name}.", dir=path.parent)
        with store.locked(range(store.blocks)), beside as folder:
            os.rename(path, Path(folder) / "old")  # a kill leaves the old store whole or none
        return _created(path, scene)
    if not resume:
        raise FileExistsError(f"{path} exists: continue it with resume (--resume), or choose another name")
    store.require(scene)
    return store


def require_ensemble(scene: Scene, path: Path, bodies: tuple[int, int] | None) -> None:
    """Raise a ValueError if a scene has no ensemble, or not these bodies."""
    if scene.ensemble is None:
        raise ValueError(f"{path}: a store holds an ensemble; this scene has no table [ensemble]")
    number = scene.ensemble.number
    first, end = bodies or (0, number)
    if not 0 <= first < end <= number:
        raise ValueError(f"range {first}:{end} of bodies is out of bounds for {counted(number, 'body')}")


def _created(path: Path, scene: Scene) -> EnsembleStore:
    try:
        return EnsembleStore.create(path, scene)
    except OSError as error:
        raise OSError(f"cannot write {path}: {error.strerror or error}") from error


def _require_room(scene: Scene, path: Path) -> None:
    """Raise an error if the disk is too small for the store."""
    wanted, free = bytes_of_file(scene), shutil.disk_usage(path.parent).free
    if wanted > free:
        raise OSError(
            f"{path} needs {memory.size(wanted)}; its disk has {memory.size(free)} free: "
            "take fewer bodies or fewer times"
        )


def _compute(
    store: EnsembleStore, scene: Scene, blocks: range, progress: Report | None, threads: int | None
) -> None:
    """Compute blocks one after the other; each is checked when its turn comes."""
    for index in blocks:
        if store.state(index) != "done":
            report = part_of(progress, index - blocks.start, 1, len(blocks))
            compute_block(store, scene, index, report, threads)
        if progress is not None:
            progress(1, (index + 1 - blocks.start) / len(blocks))


def _kept(store: EnsembleStore) -> str:
    """Return a message after an interrupt: the state of the store, and how to continue."""
    complete = sum(mark["bodies"][1] - mark["bodies"][0] for mark in store.marks())
    return f"{store.path} has {complete} of {counted(store.number, 'body')}; continue with resume (--resume)"
