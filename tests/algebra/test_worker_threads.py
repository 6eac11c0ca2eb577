"""Batches share worker threads that wait between calls: forks, threads of Python, the end of the program."""

import os
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import polhode as ph
import processes

ROWS = 200_000

FORKED = """
import os
import numpy as np
import polhode as ph

a, b = ph.vector(np.random.default_rng(1).standard_normal((2, 200_000, 3)))
expected = a.wedge(b).components.tobytes()
child = os.fork()
same = all(a.wedge(b).components.tobytes() == expected for _ in range(5))
if child == 0:
    os._exit(0 if same else 1)
_, status = os.waitpid(child, 0)
raise SystemExit(not same or status != 0)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the system has no fork")
def test_a_forked_process_has_workers_of_its_own():
    environment = {**os.environ, "POLHODE_NUM_THREADS": "3"}
    done = processes.run([sys.executable, "-W", "ignore", "-c", FORKED], env=environment)
    assert done.returncode == 0, done.stderr


def test_threads_of_python_share_the_workers(monkeypatch):
    rng = np.random.default_rng(2)
    S, R = ph.Rotor.random((2, ROWS), rng)
    v = ph.vector(rng.standard_normal((ROWS, 3)))
    monkeypatch.setenv("POLHODE_NUM_THREADS", "1")
    expected = (S * R)(v).components
    monkeypatch.setenv("POLHODE_NUM_THREADS", "3")
    with ThreadPoolExecutor(4) as pool:
        for result in pool.map(lambda _: (S * R)(v).components, range(12)):
            np.testing.assert_array_equal(result, expected)
