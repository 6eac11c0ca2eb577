"""Public names: ``dir`` and ``__all__`` of the modules, and ``python -m polhode``."""

import importlib
import sys

import pytest

import polhode as ph
import processes
from command_line import polhode

MODULES = ["torque", "force", "event", "io", "strategies", "jax", "jax.torque"]


@pytest.mark.parametrize("name", MODULES)
def test_modules_list_what_they_define(name):
    module = importlib.import_module(f"polhode.{name}")
    assert dir(module) == sorted(module.__all__)
    assert all(hasattr(module, public) for public in module.__all__)


def test_the_package_lists_public_names_only():
    assert dir(ph) == sorted({*ph.__all__, "__version__", "jax"})
    assert not [name for name in dir(ph) if name.startswith("_") and name != "__version__"]


def test_the_package_runs_as_the_command():
    done = processes.run([sys.executable, "-m", "polhode", "eval", "e1 e2"])
    assert done.returncode == 0, done.stderr
    assert done.stdout == polhode("eval", "e1 e2").stdout
    wrong = processes.run([sys.executable, "-m", "polhode", "nonsense"])
    assert wrong.returncode == 2
    assert wrong.stderr.startswith("usage: polhode")
