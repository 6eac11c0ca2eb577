"""A block of a store: computed and written by this process."""

from __future__ import annotations

from collections.abc import Callable

from polhode._report.ensemble.store import EnsembleStore
from polhode._scene.scene import Scene

Report = Callable[[int, float], object]


def compute_block(
    store: EnsembleStore, scene: Scene, index: int, progress: Report | None, threads: int | None
) -> None:
    """Compute a block and write it."""
    store.write(index, scene, scene._drawn(store.rows(index), progress, threads))
