"""Results and copies that do not fit into memory are refused before they are allocated."""

import numpy as np
import pytest

import algebra_calls
import mechanics_calls
import polhode as ph
from polhode._support import memory

CALLS = algebra_calls.CALLS | mechanics_calls.CALLS
HUGE = 10**12


@pytest.fixture(autouse=True)
def _little_memory(tmp_path, monkeypatch):
    """A machine with 1 GB of free memory."""
    (tmp_path / "meminfo").write_text("MemAvailable: 1000000 kB\n")
    monkeypatch.setattr(memory, "_PROC", str(tmp_path))
    monkeypatch.setattr(memory, "_CGROUP", str(tmp_path))


@pytest.mark.parametrize("name", CALLS)
def test_huge_batches(name):
    """Arrays of 10^12 rows that share memory: an error of the shape, or of the memory they would need."""
    call = CALLS[name]
    for place, array in enumerate(call.arrays):
        huge = np.broadcast_to(array, (HUGE, *array.shape))
        try:
            call.f(*call.arrays[:place], huge, *call.arrays[place + 1 :])
        except MemoryError as error:
            if " are free" not in str(error):  # NumPy's own, which trusts the promises of the system
                raise
        except (ValueError, TypeError):
            pass
        else:
            pytest.fail(f"argument {place}: no error")


MADE = {
    "Rotor.random": lambda: ph.Rotor.random(HUGE),
    "Rotor.identity": lambda: ph.Rotor.identity(HUGE),
    "RigidTransform.identity": lambda: ph.RigidTransform.identity(HUGE),
    "LinearMap.identity": lambda: ph.LinearMap.identity(HUGE),
    "Algebra.random": lambda: ph.algebra(4).random(HUGE),
    "product of a row and a column": lambda: (
        ph.vector(np.ones((10**5, 1, 3))) * ph.vector(np.ones((1, 10**5, 3)))
    ),
    "sum of a row and a column": lambda: (
        ph.vector(np.ones((10**5, 1, 3))) + ph.vector(np.ones((1, 10**5, 3)))
    ),
    "rotor of a row and a column": lambda: ph.Rotor.from_plane_angle(
        np.ones((10**5, 1, 3)), np.ones((1, 10**5))
    ),
    "FreeMotion.polhode": lambda: free().polhode(HUGE),
    "FreeMotion.herpolhode": lambda: free().herpolhode(HUGE),
    "states of many bodies at many times": lambda: free((3000,)).at(np.ones(10**5)),
    "simulate": lambda: ph.simulate(free.inertia, started(3000), np.arange(10.0**4)),
    "Stepper": lambda: ph.Stepper(free.inertia, started(HUGE)),
    "a formula of a row and a column": lambda: ph.evaluate(
        "a b", a=ph.vector(np.ones((10**5, 1, 3))), b=ph.vector(np.ones((1, 10**5, 3)))
    ),
}


def started(count):
    return ph.State(ph.Rotor.identity(), np.broadcast_to([0.1, 2.0, 0.1], (count, 3)))


def free(shape=()):
    return ph.FreeMotion(free.inertia, ph.Rotor.identity(), np.broadcast_to([0.1, 2.0, 0.1], (*shape, 3)))


free.inertia = ph.Inertia.from_principal_moments(1, 1.5, 2)


@pytest.mark.parametrize("name", MADE)
def test_large_results(name):
    with pytest.raises(MemoryError, match=r"take .* are free"):
        MADE[name]()
