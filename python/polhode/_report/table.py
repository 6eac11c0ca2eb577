"""Motions as tables: columns of numbers, pandas data frames, CSV and Parquet files."""

from __future__ import annotations

import io
import json
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._mechanics.trajectory import Trajectory
from polhode._report.netcdf import MOTION, attributes_of, components
from polhode._support.arrays import Array
from polhode._support.extras import optional

if TYPE_CHECKING:
    import pandas

# Names of the components along each dimension.
_LABELS = {"quaternion": "wxyz", "axis": "xyz"}
# Rows of a CSV file that are converted to text at once.
_BLOCK = 4096


# Quantities with a row for each time.
ALONG_TIME = {name: facts for name, facts in MOTION.items() if name != "inertia"}


def columns_of(name: str) -> tuple[str, ...]:
    """Return the names of the columns of a quantity."""
    dims = ALONG_TIME[name][0]
    return tuple(f"{name}_{label}" for label in _LABELS[dims[0]]) if dims else (name,)


# Unit of each column; the index is `time` in s, of a batch `body` and `time`.
UNITS = {column: unit for name, (_, unit, _) in ALONG_TIME.items() for column in columns_of(name)}

# Name of the first column of a CSV file without some of the columns. Readers of CSV files drop the quotes;
# they distinguish a file of Polhode from a table of measured attitudes with the same columns.
PARTIAL = '"time"'


def units_of(trajectory: Trajectory) -> dict[str, str]:
    """Return the unit of each column of a motion; the speeds of reaction wheels follow the others."""
    wheels = trajectory.wheel_speed.shape[-1]
    return UNITS | {f"wheel_speed_{k}": "rad/s" for k in range(wheels)}


def values_of(trajectory: Trajectory) -> Array:
    """Return the columns of a motion (rows, columns); of a batch body after body, in C order."""
    shape = (*trajectory.shape, len(trajectory.time))
    parts = [components(trajectory, name).reshape(*shape, len(columns_of(name))) for name in ALONG_TIME]
    parts.append(trajectory.wheel_speed)
    return np.concatenate(parts, axis=-1).reshape(math.prod(shape), len(units_of(trajectory)))


def to_dataframe(trajectory: Trajectory) -> pandas.DataFrame:
    """Return a data frame, as `Trajectory.to_dataframe`."""
    pd = optional("pandas", "pandas", "a data frame")
    if trajectory.shape:
        bodies = range(math.prod(trajectory.shape))
        index = pd.MultiIndex.from_product([bodies, trajectory.time], names=["body", "time"])
    else:
        index = pd.Index(trajectory.time, name="time")
    units = units_of(trajectory)
    frame: pandas.DataFrame = pd.DataFrame(values_of(trajectory), index, list(units))
    attributes = {name: _plain(x) for name, x in attributes_of(trajectory).items()}
    frame.attrs |= {**attributes, "units": {"time": "s", **units}}
    return frame


def _plain(x: Any) -> Any:
    """Return numbers and arrays of NumPy as numbers and lists, which JSON can hold."""
    return x.tolist() if isinstance(x, np.ndarray | np.generic) else x


def header(many: bool) -> str:
    """Return the first line of a CSV file, of one body or of a batch, without wheels."""
    return ",".join([*(["body"] if many else []), "time", *UNITS])


def is_own_header(line: str) -> bool:
    """Whether the first line of a CSV file is one of Polhode's: of a motion, or of a part of its columns."""
    names = line.partition(",wheel_speed_0")[0]
    if names in (header(False), header(True)):
        return True
    first, *others = names.split(",")
    return first == PARTIAL and {*others} <= {*UNITS}


def csv(trajectory: Trajectory) -> bytes:
    """Return the content of a CSV file: each number as the shortest text that reads back to its bits."""
    values, n = values_of(trajectory), len(trajectory.time)
    times = [repr(t) for t in trajectory.time.tolist()]
    many = bool(trajectory.shape)
    text = io.StringIO()
    text.write(",".join([header(many), *list(units_of(trajectory))[len(UNITS) :]]) + "\n")
    for start in range(0, len(values), _BLOCK):
        for k, row in enumerate(values[start : start + _BLOCK].tolist(), start):
            labels = f"{k // n},{times[k % n]}" if many else times[k]
            text.write(f"{labels},{','.join(map(repr, row))}\n")
    return text.getvalue().encode()


def parquet(trajectory: Trajectory) -> bytes:
    """Return the content of a Parquet file: the data frame with its units and attributes."""
    require_parquet()
    frame = to_dataframe(trajectory)
    for name, x in frame.attrs.items():
        try:
            json.dumps(x)
        except TypeError:
            raise TypeError(
                f"attributes[{name!r}] of the motion is {type(x).__name__}; a Parquet file takes text, "
                "numbers and lists of them: convert it, or remove it"
            ) from None
    content: Any = frame.to_parquet(engine="pyarrow")
    return bytes(content)


def require_parquet() -> None:
    """Raise an ImportError if libraries for Parquet files are missing."""
    optional("pandas", "parquet", "a Parquet file")
    optional("pyarrow.parquet", "parquet", "a Parquet file")
