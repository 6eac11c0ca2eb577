"""Blocks of a store computed by the workers of a Dask cluster."""

from __future__ import annotations

import contextlib
import functools
import json
import logging
import os
from collections.abc import Iterator
from concurrent.futures import CancelledError
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from polhode._report.ensemble.block import compute_block
from polhode._report.ensemble.store import EnsembleStore, StoreError
from polhode._scene.scene import Scene
from polhode._support.blocks import Report
from polhode._support.extras import optional

# Seconds to wait for a scheduler.
_TIMEOUT = 30


class ClusterError(OSError):
    """A cluster cannot be used or was lost."""


def check_address(address: str) -> None:
    """Raise an error if an address has a wrong number of processes, or is the path of a missing file."""
    name, colon, count = address.partition(":")
    if not address or (
        name == "local" and colon and not (count.isascii() and count.isdigit() and int(count))
    ):
        raise ValueError(
            f"a cluster is local, local:N with N processes, the address of a scheduler or the path of its "
            f"scheduler.json, got {address!r}"
        )
    optional("distributed", "cluster", "a run on a cluster")
    if address.endswith(".json"):
        _check_file(address)


def _check_file(path: str) -> None:
    """Raise a ClusterError unless a file is one that a scheduler of Dask writes."""
    if not os.path.isfile(path):
        raise ClusterError(f"no cluster at {path}: no such file")
    try:
        found = json.loads(Path(path).read_bytes())
    except (OSError, ValueError):
        found = None
    if not isinstance(found, dict) or not isinstance(found.get("address"), str):
        raise ClusterError(
            f"no cluster at {path}: not the file of a scheduler; `dask scheduler --scheduler-file {path}` "
            "writes it"
        )


@contextlib.contextmanager
def connected(address: str) -> Iterator[Any]:
    """Yield a client of the cluster at an address, which ``local`` and ``local:N`` start and end.

    Raises
    ------
    ClusterError
        If it cannot be reached.
    """
    library = optional("distributed", "cluster", "a run on a cluster")
    name, _, count = address.partition(":")
    with contextlib.ExitStack() as opened:
        try:
            if name == "local":
                cluster = library.LocalCluster(
                    n_workers=int(count or os.cpu_count() or 1),
                    threads_per_worker=1,
                    processes=True,
                    dashboard_address=None,
                    # Dask serves HTTP without a dashboard too, on port 8787 if none is given.
                    scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},
                    silence_logs=logging.CRITICAL,
                )
                opened.enter_context(cluster)
                client = library.Client(cluster)
            elif address.endswith(".json"):
                client = library.Client(scheduler_file=address, timeout=_TIMEOUT)
            else:
                client = library.Client(address, timeout=_TIMEOUT)
        except OSError as error:
            raise ClusterError(f"no cluster at {address}: {error}") from error
        except ValueError as error:
            words = f"not an address such as tcp://10.0.0.1:8786 ({error})"
            raise ClusterError(f"no cluster at {address}: {words}") from error
        except MemoryError as error:  # Dask takes the answer of another server for the size of a message
            raise ClusterError(
                f"no cluster at {address}: a program answers there, but it is not a scheduler of Dask"
            ) from error
        opened.enter_context(client)
        yield client


def compute_on(
    client: Any,
    store: EnsembleStore,
    scene: Scene,
    blocks: range,
    progress: Report | None,
    threads: int | None,
) -> None:
    """Compute the blocks that are not done as tasks of a cluster.

    Dask starts the block of a lost worker again, on another one.

    Raises
    ------
    ClusterError
        If the cluster is lost, or a block ends several workers.
    StoreError, OSError
        Of a worker: of another version, without the scene, or that cannot write.
    """
    library = optional("distributed", "cluster", "a run on a cluster")
    tasks = {}
    for index in (index for index in blocks if store.state(index) != "done"):
        given = (str(store.path.absolute()), str(scene.path.absolute()), scene.times, index, threads or 1)
        tasks[client.submit(_task, *given, pure=False)] = index
    done = len(blocks) - len(tasks)
    for future in library.as_completed(tasks):
        rows = store.rows(tasks[future])
        try:
            future.result()
        except library.KilledWorker as error:
            raise ClusterError(f"bodies {rows.start}:{rows.stop} ended several workers: {error}") from error
        except (CancelledError, library.CancelledError) as error:
            raise ClusterError(f"the connection to the cluster was lost: {error}") from error
        done += 1
        if progress is not None:
            progress(1, done / len(blocks))


def _task(store: str, scene: str, times: Any, index: int, threads: int) -> None:
    """Compute a block in a worker."""
    place = optional("distributed", "cluster", "a run on a cluster").get_worker().address
    problem = None
    try:
        given = _scene(scene, np.asarray(times).tobytes())
        opened = EnsembleStore.open(Path(store))
        opened.require(given)
    except (ValueError, OSError) as error:
        problem = str(error)
    if problem is not None:
        # Not in the handler: Dask sends the context of an error too, and a SceneError cannot be pickled.
        raise StoreError(f"worker {place}: {problem}")
    compute_block(opened, given, index, None, threads)


@functools.lru_cache(maxsize=4)
def _scene(path: str, times: bytes) -> Scene:
    return replace(Scene.read(path), times=np.frombuffer(times))
