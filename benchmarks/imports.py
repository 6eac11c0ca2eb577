"""Import time in a new interpreter, without that of NumPy."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from importlib.util import find_spec

import numpy as np

from contest import Pace, Row

MODULES = {
    "polhode": "polhode",
    "clifford": "clifford.g3",
    "kingdon": "kingdon",
    "galaga": "galaga",
    "gasparse": "gasparse",
    "SciPy": "scipy.spatial.transform",
    "numpy-quaternion": "quaternion",
    "numba": "numba",
    "JAX": "jax.numpy",
}

PROGRAM = "import numpy, time; start = time.perf_counter(); import {}; print(time.perf_counter() - start)"


def rows(_: np.random.Generator, pace: Pace) -> Iterator[Row]:
    """Yield the row."""
    row = Row("import", goal="15 ms", unit="ms")
    for library, module in MODULES.items():
        with row.peer(library):
            if find_spec(module.partition(".")[0]) is None:
                raise ModuleNotFoundError(f"No module named {module!r}")
            row.seconds[library] = min(_seconds(module) for _ in range(pace.rounds))
    yield row


def _seconds(module: str) -> float:
    program = [sys.executable, "-c", PROGRAM.format(module)]
    done = subprocess.run(program, capture_output=True, text=True, timeout=300, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr.strip().splitlines()[-1])
    return float(done.stdout)
