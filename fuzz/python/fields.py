"""Files of motions, sound as files, in which the bytes of the fuzzer replace variables and attributes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

# Larger than any memory; the file stores nothing of it.
_GIANT = 1 << 44
_ODD: tuple[Any, ...] = (
    np.float64(1.0),
    np.zeros(0),
    np.zeros(3),
    np.zeros((3, 4)),
    np.zeros((2, 3, 4)),
    np.zeros((4, 3)),
    np.full((2, 3, 3), np.inf),
    np.full(3, np.nan),
    np.arange(3),
    np.arange(3)[::-1].astype(np.int8),
    np.array([True, False, True]),
    np.zeros((3, 4), complex),
    np.array(["a", "b", "c"], object),
    np.array("text", object),
    np.array([b"\xff", b"x"]),
    np.array([(1, 2.0)], [("a", "i4"), ("b", "f8")]),
    np.float32([[1, 0, 0, 0]] * 3),
    np.uint64([0, 1, 2**64 - 1]),
    np.array([[1.0, 0, 0, 0]] * 3),
    np.eye(3),
)
_TEXTS = ("", "{", "[]", "{}", "null", '{"rotor_norm": "x"}', '{"energy": [1]}', "é", "[[1, 2]]", "1e999")


def netcdf(content: bytes, path: Path, seed: bytes) -> None:
    """Write a netCDF file: of each three bytes the first chooses a name, the others what becomes of it."""
    path.write_bytes(seed)
    with h5py.File(path, "r+") as file:
        names = [
            *sorted(file),
            *(f"@{name}" for name in sorted(file.attrs)),
            "body",
            "wheel_speed",
            "event_name",
        ]
        for which, what, value in zip(content[::3], content[1::3], content[2::3], strict=False):
            name = names[which % len(names)]
            if name.startswith("@"):
                _change_attribute(file, name[1:], what, value)
            else:
                _change_variable(file, name, what, value)


def _change_attribute(file: Any, name: str, what: int, value: int) -> None:
    file.attrs.pop(name, None)
    if what % 3 == 1:
        file.attrs[name] = _TEXTS[value % len(_TEXTS)]
    elif what % 3 == 2:
        odd = np.asarray(_ODD[value % len(_ODD)])
        file.attrs[name] = str(odd) if odd.dtype.kind == "O" else odd


def _change_variable(file: Any, name: str, what: int, value: int) -> None:
    if name in file:
        del file[name]
    match what % 8:
        case 0:
            return
        case 1:
            file.create_group(name)
        case 2:
            shape = ((_GIANT,), (_GIANT >> 8, 4), (3, _GIANT, 4))[value % 3]
            file.create_dataset(name, shape, "f8", chunks=True)
        case 3:
            file[name] = h5py.SoftLink(f"/{name}")
        case _:
            odd = np.asarray(_ODD[value % len(_ODD)])
            kind = h5py.string_dtype() if odd.dtype.kind == "O" else odd.dtype
            file.create_dataset(name, data=odd, dtype=kind)


def parquet(content: bytes, path: Path, seed: bytes) -> None:
    """Write a Parquet file: of each three bytes the first chooses a column, the others what becomes of it."""
    table = pq.read_table(pa.BufferReader(seed))
    columns = dict(zip(table.column_names, table.columns, strict=True))
    names, metadata = [*columns, "wheel_speed_0", "body", "other", ""], dict(table.schema.metadata or {})
    for which, what, value in zip(content[::3], content[1::3], content[2::3], strict=False):
        name = names[which % len(names)]
        if what % 5 == 0:
            columns.pop(name, None)
        elif what % 5 == 1:
            metadata[b"PANDAS_ATTRS"] = _TEXTS[value % len(_TEXTS)].encode()
        else:
            columns[name] = _column(value, table.num_rows)
    pq.write_table(pa.table(columns).replace_schema_metadata(metadata), path)


def _column(value: int, rows: int) -> Any:
    """Return a column of as many rows as the others, of a type that is not that of numbers."""
    values = (
        1,
        -1,
        2**63 - 1,
        True,
        "x",
        "1",
        None,
        [1.0, 2.0],
        {"a": 1},
        float("nan"),
        float("inf"),
        b"\xff",
        1e300,
    )
    return pa.array([values[value % len(values)]] * rows)
