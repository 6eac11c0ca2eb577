"""Arrays of a Zarr store: their metadata, and chunks of numbers as files."""

from __future__ import annotations

import contextlib
import functools
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from polhode._report.ensemble.layout import Variable
from polhode._support.arrays import Array
from polhode._support.checksums import PIECE, checksum
from polhode._support.extras import optional

META = "zarr.json"


def zarr() -> Any:
    """Return the library."""
    return optional("zarr", "zarr", "a Zarr store")


@contextlib.contextmanager
def new_group(folder: Path) -> Iterator[Any]:
    """Yield a new group, whose files are written to a folder at the end.

    Until then it is in memory: the library writes files in threads of its own, and after an error in one of
    them the others would go on in a folder that its owner removes.
    """
    files: dict[str, Any] = {}
    yield _group(files)
    for name, content in files.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content.as_numpy_array())


def _group(files: dict[str, Any]) -> Any:
    """Return a new group, whose files become items of a dict."""
    return zarr().open_group(zarr().storage.MemoryStore(files), mode="w", zarr_format=3)


def new_array(
    group: Any, variable: Variable, shape: tuple[int, ...], chunks: tuple[int, ...], dims: tuple[str, ...]
) -> Any:
    """Return a new array for the values of a variable."""
    attributes = {name: x.tolist() if isinstance(x, np.ndarray) else x for name, x in variable.labels.items()}
    return _new(group, variable.name, shape, chunks, np.asarray(variable.values).dtype, dims, attributes)


def _new(
    group: Any,
    name: str,
    shape: tuple[int, ...],
    chunks: tuple[int, ...],
    dtype: np.dtype[Any],
    dims: tuple[str, ...],
    attributes: dict[str, Any],
) -> Any:
    return group.create_array(
        name,
        shape=shape,
        chunks=chunks,
        dtype=dtype,
        dimension_names=dims,
        fill_value=_fill(dtype),
        # Files without folders: on many disks a folder costs more than the numbers of a block.
        chunk_key_encoding={"name": "default", "separator": "."},
        compressors=None,  # the last digits do not compress, and bytes must not depend on a library's version
        attributes=attributes,
    )


def write_labels(group: Any, name: str, texts: list[str], dim: str, attributes: dict[str, Any]) -> None:
    """Write an array of texts."""
    count = (len(texts),)
    array = group.create_array(
        name,
        shape=count,
        chunks=count,
        dtype=str,
        compressors=None,
        dimension_names=(dim,),
        chunk_key_encoding={"name": "default", "separator": "."},
        attributes=attributes,
    )
    array[:] = np.array(texts, dtype=object)


def metadata_of(variable: Variable, number: int, block: int) -> bytes:
    """Return the metadata of the array of a variable over `number` bodies, as the library writes it."""
    labels = {name: x.tolist() if isinstance(x, np.ndarray) else x for name, x in variable.labels.items()}
    sizes, dims = variable.values.shape[1:], ("body", *variable.dims)
    return _metadata(
        variable.name, (number, *sizes), (block, *sizes), variable.values.dtype, dims, json.dumps(labels)
    )


@functools.lru_cache(maxsize=256)
def _metadata(
    name: str,
    shape: tuple[int, ...],
    chunks: tuple[int, ...],
    dtype: np.dtype[Any],
    dims: tuple[str, ...],
    labels: str,
) -> bytes:
    files: dict[str, Any] = {}
    _new(_group(files), name, shape, chunks, dtype, dims, json.loads(labels))
    return bytes(files[f"{name}/{META}"].to_bytes())


def chunk_of(variable: Variable, index: int) -> str:
    """Return the file of the chunk of a block, in the store."""
    return f"{variable.name}/{'.'.join(['c', str(index), *['0'] * (variable.values.ndim - 1)])}"


def write_chunk(path: str, block: int, values: Array) -> str:
    """Write the chunk of a block, and return its checksum."""
    with open(path, "xb") as file:

        def written() -> Iterator[memoryview]:
            for piece in _pieces(block, values):
                file.write(piece)
                yield piece

        return checksum(written())


def _pieces(block: int, values: Array) -> Iterator[memoryview]:
    """Yield the numbers of a chunk in C order, little-endian, the last chunk filled up."""
    dtype = values.dtype.newbyteorder("<")
    rows = max(1, PIECE * len(values) // max(values.nbytes, 1))
    missing = (block - len(values), *values.shape[1:])
    for part in (values, np.full(missing, _fill(dtype), dtype)):
        for start in range(0, len(part), rows):
            yield np.ascontiguousarray(part[start : start + rows], dtype).data.cast("B")


def _fill(dtype: np.dtype[Any]) -> float | int:
    """Return the value of numbers that are not written: NaN, or -1."""
    return np.nan if dtype.kind == "f" else -1
