"""Fixtures that tests share, and settings of the libraries that they use."""

import itertools
import os
import sys
from pathlib import Path

import pytest
from hypothesis import settings

from command_line import SCENE
from viewers import SCRIPT

ROOT = Path(__file__).parents[1]

# clifford spends seconds to compile its products on first use; interpreted, they give the same numbers.
os.environ.setdefault("NUMBA_DISABLE_JIT", "1")

# JAX compiles each program once: the file cache serves all workers, child processes and later runs.
os.environ.setdefault("JAX_COMPILATION_CACHE_DIR", str(ROOT / "build/jax"))
os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS", "0")
os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_ENTRY_SIZE_BYTES", "-1")

# Property tests draw the same examples on every run.
settings.register_profile("polhode", derandomize=True, database=None, deadline=None, max_examples=60)
settings.load_profile("polhode")


def pytest_collection_modifyitems(items):
    """Spread the modules that wait for a browser among the others, which compute meanwhile."""
    modules = [list(tests) for _, tests in itertools.groupby(items, key=lambda item: item.path)]
    waiting = [tests for tests in modules if tests[0].path.parent.name == "viewer"]
    others = [tests for tests in modules if tests[0].path.parent.name != "viewer"]
    places = {}
    for group in (waiting, others):
        starts = itertools.accumulate(map(len, group), initial=0)
        total = max(sum(map(len, group)), 1)
        places |= {tests[0].path: start / total for tests, start in zip(group, starts, strict=False)}
    modules.sort(key=lambda tests: places[tests[0].path])
    items[:] = [test for tests in modules for test in tests]


@pytest.fixture
def scene(tmp_path):
    """Path of a scene that runs in milliseconds."""
    path = tmp_path / "small.toml"
    path.write_text(SCENE)
    return path


@pytest.fixture
def bundle(tmp_path_factory, monkeypatch):
    """Path of a short script that replaces the viewer's bundle."""
    from polhode._viewer import html

    path = tmp_path_factory.mktemp("viewer") / "viewer.js"
    path.write_text(SCRIPT)
    monkeypatch.setattr(html, "_BUNDLE", path)
    return path


@pytest.fixture(autouse=True, scope="module")
def _clear_jax_caches():
    """Release the programs that a module compiled: thousands of them fill gigabytes."""
    yield
    if "jax" in sys.modules:
        sys.modules["jax"].clear_caches()
