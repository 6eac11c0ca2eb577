"""Forks, threads of Python and sub-interpreters, beside the worker threads that batches share."""

import importlib.util
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


def test_threads_of_python_share_objects():
    """Formulas, motions and algebras hold no state; steps of one stepper follow each other."""
    formula, algebra = ph.formula("a b + exp(a ∧ b)"), ph.algebra(4, 1)
    rng = np.random.default_rng(3)
    a, b = ph.vector(rng.standard_normal((2, 2000, 3)))
    many = algebra.random(50, rng=rng)
    inertia = ph.Inertia.from_principal_moments(1, 1.5, 2)
    motion = ph.FreeMotion(inertia, ph.Rotor.identity(), [0.3, 2, 0.1])

    def results(_):
        state = motion.at(np.linspace(0, 9, 3000))
        return [
            x.components.tobytes() for x in (formula(a=a, b=b), many * many, state.rotor, state.omega_body)
        ]

    expected = results(0)
    stepper = ph.Stepper(inertia, ph.State(ph.Rotor.identity(), [0.3, 2, 0.1]))
    with ThreadPoolExecutor(8) as pool:
        assert all(found == expected for found in pool.map(results, range(24)))
        list(pool.map(lambda _: stepper.step(2.0**-7), range(64)))
    assert stepper.time == 0.5


NESTED = """
import sys
import polhode as ph
try:
    import _interpreters as interpreters
except ImportError:
    import _xxsubinterpreters as interpreters
own = interpreters.create()
code = f"import sys; sys.path[:] = {sys.path!r}; import polhode"
try:
    run = getattr(interpreters, "exec", interpreters.run_string)
    failed = run(own, code)
    print(getattr(failed, "formatted", failed))
except interpreters.RunFailedError as error:
    print(error)
interpreters.destroy(own)
print(ph.e1 * ph.e2)
"""


@pytest.mark.skipif(
    not any(map(importlib.util.find_spec, ("_interpreters", "_xxsubinterpreters"))),
    reason="this Python has no module for sub-interpreters",
)
def test_sub_interpreters_get_an_import_error():
    done = processes.run([sys.executable, "-W", "ignore", "-c", NESTED])
    assert done.returncode == 0, done.stderr
    error, product = done.stdout.splitlines()
    assert "ImportError" in error
    assert product == "e1∧e2"
