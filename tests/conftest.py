"""A small scene; and property tests that are the same on every run, each derived from the test itself."""

import os
import sys

import pytest
from hypothesis import settings

from command_line import SCENE

# clifford compiles its products when it is first used, for seconds; interpreted they are the same.
os.environ.setdefault("NUMBA_DISABLE_JIT", "1")

settings.register_profile("polhode", derandomize=True, database=None, deadline=None, max_examples=60)
settings.load_profile("polhode")


@pytest.fixture
def scene(tmp_path):
    """The path of a scene that runs in no time."""
    path = tmp_path / "small.toml"
    path.write_text(SCENE)
    return path


@pytest.fixture(autouse=True, scope="module")
def _forget_what_jax_compiled():
    """Thousands of small programs otherwise fill gigabytes."""
    yield
    if "jax" in sys.modules:
        sys.modules["jax"].clear_caches()
