"""A block of a store: computed and written by this process."""

from __future__ import annotations

from polhode._report.ensemble.reduced import reduction_of
from polhode._report.ensemble.store import EnsembleStore
from polhode._scene.scene import Scene
from polhode._support.blocks import Report


def compute_block(
    store: EnsembleStore, scene: Scene, index: int, progress: Report | None, threads: int | None
) -> None:
    """Compute a block and write it."""
    assert scene.ensemble is not None
    rows = store.rows(index)
    if scene.ensemble.keep:
        store.write(index, scene, reduction_of(scene).block(rows, progress, threads))
    else:
        store.write(index, scene, scene._drawn(rows, progress, threads))
