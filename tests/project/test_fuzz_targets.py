"""The fuzz targets in Python accept whole and broken files; those in Rust have files to begin with."""

import random

import pytest

pytest.importorskip("h5py")
pytest.importorskip("pyarrow")
pytest.importorskip("spiceypy")
pytest.importorskip("zarr")

import polhode as ph
import seeds
from readers import TARGETS


@pytest.mark.parametrize("name", TARGETS)
def test_files_to_begin_with_and_broken_ones(name):
    target, numbers = TARGETS[name], random.Random(1)
    for content in target.corpus()[:6]:
        target.check(content)
        broken = bytearray(content)
        # Broken bytes of other formats can end the process, or not return, in libraries of others.
        for _ in range(4 if target.suffix in ("aem", "csv", "xml") else 0):
            broken[numbers.randrange(len(broken))] ^= 1 << numbers.randrange(8)
            target.check(bytes(broken))
        target.check(content[: len(content) // 2])


def test_the_targets_in_rust_have_files_to_begin_with(tmp_path):
    assert all(len(contents) > 5 for contents in seeds.corpora().values())
    for content in seeds.meshes():
        path = tmp_path / f"part.{('stl', 'obj', 'ply')[content[0]]}"
        path.write_bytes(content[1:])
        assert ph.Body.from_mesh(path, density=1).mass == 36_000
