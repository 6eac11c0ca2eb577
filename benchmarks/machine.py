"""Describe the machine, its memory bandwidth and the versions of the libraries."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from time import perf_counter

import numpy as np

import polhode as ph
from contest import Pace

PEERS = [
    "numpy",
    "scipy",
    "clifford",
    "kingdon",
    "galaga",
    "gasparse",
    "numpy-quaternion",
    "numba",
    "jax",
    "diffrax",
    "mujoco",
]

ROOT = Path(__file__).parent.parent
PINS = Path("/proc/self/task").is_dir() and hasattr(os, "sched_setaffinity")  # see `on_one_core`


def describe() -> dict[str, str]:
    """Return the facts that the times depend on, as text by name."""
    load = ", ".join(f"{x:.2f}" for x in os.getloadavg()) if hasattr(os, "getloadavg") else "unknown"
    return {
        "date": datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        "commit": commit(),
        "processor": processor(),
        "cores": f"{cores()} of {os.cpu_count()} usable",
        "memory": memory(),
        "load before": load,
        "system": platform.platform(),
        "Python": f"{platform.python_implementation()} {platform.python_version()}",
    }


def cores() -> int:
    """Return the number of cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def on_one_core() -> Iterator[None]:
    """Pin all present and future threads of this process to one core."""
    allowed = os.sched_getaffinity(0)
    _pin({min(allowed)})
    numba = sys.modules.get("numba")
    threads = numba.get_num_threads() if numba else 0
    if numba:  # otherwise it divides the rows among as many threads as before
        numba.set_num_threads(1)
    try:
        yield
    finally:
        if numba:
            numba.set_num_threads(threads)
        _pin(allowed)


def _pin(cores: set[int]) -> None:
    for thread in Path("/proc/self/task").iterdir():
        with suppress(ProcessLookupError):  # the thread has ended
            os.sched_setaffinity(int(thread.name), cores)


def processor() -> str:
    """Return the processor's name."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return f"{names[0] if names else platform.processor()} ({platform.machine()})"


def memory() -> str:
    """Return the size of the main memory."""
    try:
        return f"{os.sysconf('SC_PHYS_PAGES') * os.sysconf('SC_PAGE_SIZE') / 2**30:.1f} GiB"
    except (AttributeError, ValueError, OSError):
        return "unknown"


def commit() -> str:
    """Return the short commit, with ``-dirty`` for a changed tree; ``unknown`` outside a repository."""
    command = ["git", "describe", "--always", "--dirty", "--exclude=*"]
    try:
        return subprocess.run(
            command, cwd=ROOT, capture_output=True, text=True, timeout=60, check=True
        ).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        return "unknown"


def versions() -> dict[str, str]:
    """Return each library's version; a dash for one that is not installed."""
    found = {"polhode": ph.__version__}
    for library in PEERS:
        try:
            found[library] = version(library)
        except PackageNotFoundError:
            found[library] = "–"
    return found


def copy_bandwidth(threads: int, pace: Pace) -> float:
    """Return the bytes per second that NumPy's copy of large arrays reads and writes, on some cores."""
    size = 64 * 2**20 // 8  # 64 MiB for each core and direction, larger than any cache
    pairs = [(np.ones(size), np.ones(size)) for _ in range(threads)]
    best = np.inf
    with ThreadPoolExecutor(threads) as pool:
        for _ in range(3 * pace.rounds):
            start = perf_counter()
            list(pool.map(lambda pair: np.copyto(*pair), pairs))
            best = min(best, perf_counter() - start)
    return 2 * 8 * size * threads / best
