"""The fuzz targets in Python can be imported, and accept the files that they begin with and broken ones."""

import random

import pytest

pytest.importorskip("h5py")
pytest.importorskip("pyarrow")
pytest.importorskip("zarr")

from readers import TARGETS


@pytest.mark.parametrize("name", TARGETS)
def test_files_to_begin_with_and_broken_ones(name):
    target, numbers = TARGETS[name], random.Random(1)
    for content in target.corpus()[:4]:
        target.check(content)
        broken = bytearray(content)
        for _ in range(4):
            broken[numbers.randrange(len(broken))] ^= 1 << numbers.randrange(8)
            target.check(bytes(broken))
        target.check(content[: len(content) // 2])
