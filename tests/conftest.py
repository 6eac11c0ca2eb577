"""A small scene, a small viewer; and property tests that are the same on every run, each by itself."""

import os
import sys

import pytest
from hypothesis import settings

from command_line import SCENE
from viewers import SCRIPT

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


@pytest.fixture
def bundle(tmp_path_factory, monkeypatch):
    """The path of a small script, which stands for the viewer's."""
    from polhode._viewer import html

    path = tmp_path_factory.mktemp("viewer") / "viewer.js"
    path.write_text(SCRIPT)
    monkeypatch.setattr(html, "_BUNDLE", path)
    return path


@pytest.fixture(autouse=True, scope="module")
def _forget_what_jax_compiled():
    """Thousands of small programs otherwise fill gigabytes."""
    yield
    if "jax" in sys.modules:
        sys.modules["jax"].clear_caches()
