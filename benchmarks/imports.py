"""Import time in a new interpreter, without that of NumPy, with bytecode, as pip leaves it."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
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
            # Without the cache, an environment that writes no bytecode would compile the sources each time.
            with tempfile.TemporaryDirectory() as cache:
                _seconds(module, cache)
                row.seconds[library] = min(_seconds(module, cache) for _ in range(pace.rounds))
    yield row


def _seconds(module: str, cache: str) -> float:
    environment = os.environ | {"PYTHONPYCACHEPREFIX": cache, "PYTHONDONTWRITEBYTECODE": ""}
    program = [sys.executable, "-c", PROGRAM.format(module)]
    done = subprocess.run(program, env=environment, capture_output=True, text=True, timeout=300, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr.strip().splitlines()[-1])
    return float(done.stdout)
