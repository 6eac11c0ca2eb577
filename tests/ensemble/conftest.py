"""A small ensemble and its store, once for each module."""

import pytest

import polhode as ph
from stores import TEXT, content


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with the scene ``a.toml``."""
    path = tmp_path_factory.mktemp("stores")
    (path / "a.toml").write_text(TEXT)
    return path


@pytest.fixture(scope="module")
def serial(folder):
    """The content of a store that was filled in one go, ``serial.zarr``."""
    ph.Scene.read(folder / "a.toml").run(store=folder / "serial.zarr", threads=1).close()
    return content(folder / "serial.zarr")
