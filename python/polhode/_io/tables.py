"""CSV and Parquet files of attitudes and motions read, these and netCDF files written, by column."""

from __future__ import annotations

import csv
import io
import json
import math
import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from polhode._algebra.constructors import bivector, vector
from polhode._algebra.rotor import Rotor
from polhode._io.history import AttitudeHistory, FileError, RowError, checked_body, require_file
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.robots.document import Source
from polhode._mechanics.trajectory import Trajectory
from polhode._report import netcdf, netcdf_reading, table
from polhode._report.output import encoded
from polhode._report.table import ALONG_TIME, UNITS, columns_of
from polhode._support.arrays import Array
from polhode._support.calls import explains_calls
from polhode._support.extras import optional
from polhode._support.file_kinds import is_comment, names_in_comment, separator_of
from polhode._support.files import contents, write_atomically


@explains_calls
def read_csv(path: str | os.PathLike[str], *, body: int | None = None) -> AttitudeHistory:
    """Read the attitudes of one body from a CSV file with the columns that `Trajectory.save` writes.

    Columns are found by name, in any order: ``time`` and ``attitude_w``, ``_x``, ``_y``, ``_z`` are needed,
    the others may be missing, and unknown ones are an error. They are separated by commas, or else by
    semicolons or tabs, as in the first line. Empty lines and lines that begin with # are skipped. Every
    number that was saved is read to the same bits.

    Parameters
    ----------
    body
        Number of the body, for the file of a batch.

    Raises
    ------
    ValueError
        With file, line and column, for a file that is not such a table.
    FileNotFoundError
        If there is no such file.

    Examples
    --------
    A table of attitudes with the columns that are needed:

    >>> text = '''time,attitude_w,attitude_x,attitude_y,attitude_z
    ... 0,1,0,0,0
    ... 1,0,0,0,1
    ... '''
    >>> with open("turn.csv", "w") as file:
    ...     _ = file.write(text)
    >>> history = ph.io.read_csv("turn.csv")
    >>> history.rotor[1](ph.e1)  # half a turn about e3
    -e1
    """
    name, body = os.fsdecode(path), checked_body(body)
    source = Source(name, io.StringIO(_text(path, name), newline=None).read().split("\n"))
    begin = next((k for k, x in enumerate(source.lines) if not is_comment(x)), None)
    if begin is None:
        raise FileError(f"{name}: error: the file is empty; its first line must name the columns")
    separator = separator_of(source.lines[begin])
    rows = _rows(source, separator)
    first, names = next(rows)
    header = [word.strip() for word in names]
    _check_names(source, separator, first, header)
    numbers: list[list[float]] = []
    lines: list[int] = []
    for line, row in rows:
        if len(row) != len(header):
            words = f"expected {len(header)} numbers as in line {first}, got {len(row)}"
            raise FileError(source.error(line, 0, words))
        numbers.append([_number(source, separator, line, row, k) for k in range(len(row))])
        lines.append(line)
    found = np.array(numbers).reshape(len(numbers), len(header))
    columns = dict(zip(header, found.T, strict=True))
    if len(columns) < len(header):
        twice = next(x for x in header if header.count(x) > 1)
        raise FileError(source.error(first, 0, f"column {twice!r} appears more than once"))
    if "body" in columns:
        lines = [line for line, number in zip(lines, columns["body"], strict=True) if number == body]
    try:
        return _history(columns, body, {})
    except RowError as error:
        line, place = lines[error.row], header.index(error.column)
        raise FileError(source.error(line, _start(source, separator, line, place), error.words)) from None
    except (TypeError, ValueError) as error:
        raise FileError(source.error(first, 0, str(error))) from None


@explains_calls
def read_parquet(path: str | os.PathLike[str], *, body: int | None = None) -> AttitudeHistory:
    """Read the attitudes of one body from a Parquet file with the columns that `Trajectory.save` writes.

    As `read_csv`; the attributes of the file are read, too.

    Raises
    ------
    ImportError
        Without the libraries: ``pip install 'polhode[parquet]'``.

    Examples
    --------
    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> motion = ph.simulate(ball, ph.State(ph.Rotor.identity(), [0, 0, 1]), [0, 1, 2])
    >>> motion.save("ball.parquet")
    >>> ph.io.read_parquet("ball.parquet").omega_body["e12"]
    array([1., 1., 1.])
    """
    name, body = os.fsdecode(path), checked_body(body)
    table.require_parquet()
    content = _content(path)
    library = optional("pyarrow.parquet", "parquet", "a Parquet file")
    try:
        found = library.read_table(io.BytesIO(content))
        columns = {x: np.asarray(found[x].to_numpy(), float) for x in found.column_names}
        kept = (found.schema.metadata or {}).get(b"PANDAS_ATTRS", b"{}")
        stated = json.loads(kept)
        if not isinstance(stated, dict):
            raise ValueError(f"PANDAS_ATTRS must be attributes by name, as JSON, got {kept[:40]!r}")
        attributes = {x: y for x, y in stated.items() if x not in _OWN}
    except netcdf_reading.DAMAGED as error:
        raise FileError(f"{name}: error: cannot be read as a Parquet file of numbers: {error}") from None
    try:
        _require_units(columns, stated.get("units"))
        return _history(columns, body, attributes)
    except (TypeError, ValueError) as error:
        raise FileError(f"{name}: error: {error}") from None


def write_table(motion: Trajectory | AttitudeHistory, path: str | os.PathLike[str], form: str) -> None:
    """Write a motion as netCDF, CSV or Parquet (form ``"nc"``, ``"csv"``, ``"parquet"``), atomically."""
    if isinstance(motion, Trajectory):
        content = encoded(motion, form)
    else:
        content = {"nc": _netcdf, "csv": _csv, "parquet": _parquet}[form](motion)
    write_atomically({Path(path): content})


# --- reading

_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")

# Attributes of a file that describe how a trajectory was computed.
_OWN = {*netcdf_reading.OWN, "units", "batch_shape"}


def _require_units(columns: dict[str, Array], stated: Any) -> None:
    """Raise a ValueError if columns have other units than those of a motion."""
    for name, unit in stated.items() if isinstance(stated, dict) else ():
        expected = "rad/s" if name.startswith("wheel_speed_") else {"time": "s", **UNITS}.get(name, unit)
        if name in columns and unit != expected:
            raise ValueError(f"column {name!r} has the unit {unit!r}; convert its values to {expected!r}")


def _content(path: str | os.PathLike[str]) -> bytes:
    require_file(path)
    return contents(path, copies=4)


def _text(path: str | os.PathLike[str], name: str) -> str:
    content = _content(path)
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise FileError(
            f"{name}: error: not UTF-8 text from byte {error.start} on; save the table as CSV in UTF-8"
        ) from None
    if (at := content.find(0)) >= 0:  # as in UTF-16 without a mark
        raise FileError(f"{name}: error: byte {at} is zero, not text; save the table as CSV in UTF-8")
    return text


def _rows(source: Source, separator: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the fields of each row, and the number of its line; comments and empty lines are skipped."""
    lines = ("" if is_comment(line) else line for line in source.lines)
    rows = csv.reader(lines, delimiter=separator)
    try:
        for row in rows:
            if row:
                yield rows.line_num, row
    except csv.Error as error:
        raise FileError(source.error(rows.line_num, 0, f"not a row of numbers: {error}")) from None


def _check_names(source: Source, separator: str, line: int, header: list[str]) -> None:
    """Raise a FileError if the first row has no names, or one column of numbers has none."""
    if all(_NUMBER.fullmatch(word) for word in header):
        text, before = source.lines[line - 1], source.lines[: line - 1]
        remedy = names_in_comment(before, text, separator)
        raise FileError(source.error(line, 0, f"expected the names of the columns, got numbers{remedy}"))
    if header.count("") == 1 and header[0] == "":
        words = "the first column has no name; write a data frame of pandas with index=False"
        raise FileError(source.error(line, 0, words))


def _number(source: Source, separator: str, line: int, row: list[str], k: int) -> float:
    word = row[k].strip()
    try:
        value = float(word) if word.isascii() and "_" not in word else None
    except ValueError:
        value = None
    if value is None or math.isinf(value):
        problem = f"{row[k]!r} is not a finite number" if word else "the field is empty"
        raise FileError(
            source.error(line, _start(source, separator, line, k), f"{problem}; correct it or remove the row")
        )
    return value


def _start(source: Source, separator: str, line: int, k: int) -> int:
    """Return the number of characters before a field of a line."""
    return sum(len(x) + 1 for x in source.lines[line - 1].split(separator)[:k])


def _history(columns: dict[str, Array], body: int | None, attributes: dict[str, Any]) -> AttitudeHistory:
    if "body" in columns:
        bodies = columns.pop("body")
        if body is None:
            raise ValueError("the file holds a batch of bodies; choose one by its number, as in body=0")
        which = bodies == body
        if not which.any():
            raise ValueError(f"the file has no body {body}; it has {bodies.min():.0f} to {bodies.max():.0f}")
        columns = {name: x[which] for name, x in columns.items()}
    elif body is not None:
        raise ValueError(f"the file holds one body; leave out body={body}")
    wheels = sorted((x for x in columns if x.startswith("wheel_speed_")), key=lambda x: (len(x), x))
    known = {"time", *wheels, *UNITS}
    if unknown := [x for x in columns if x not in known]:
        raise ValueError(
            f"column {unknown[0]!r} is not known; rename or remove it. Known are {', '.join(known_columns())}"
        )
    for needed in ("time", *columns_of("attitude")):
        if needed not in columns:
            raise ValueError(f"the file has no column {needed!r}; it needs time and attitude_w, _x, _y, _z")
    parts = {}
    for name in ALONG_TIME:
        present = [x for x in columns_of(name) if x in columns]
        if present and len(present) < len(columns_of(name)):
            raise ValueError(
                f"the columns of {name} must be {', '.join(columns_of(name))}, got {', '.join(present)} only"
            )
        if present:
            values = np.stack([columns[x] for x in present], axis=-1)
            parts[name] = values if ALONG_TIME[name][0] else values[:, 0]
    speeds = np.stack([columns[x] for x in wheels], axis=-1) if wheels else None
    return of_parts(columns["time"], parts, speeds, attributes)


def known_columns() -> list[str]:
    """Return the names of the columns."""
    return ["time", *UNITS, "wheel_speed_0, ..."]


def of_parts(
    time: Array,
    parts: dict[str, Array],
    wheels: Array | None,
    attributes: dict[str, Any],
    inertia: Array | None = None,
) -> AttitudeHistory:
    """Return the history with these components, attitudes as quaternions w, x, y, z."""
    netcdf_reading.require_shapes(time, parts)
    quaternions = np.asarray(parts["attitude"], float)
    if wrong := netcdf_reading.not_unit(quaternions):
        k, norm = wrong
        raise RowError(f"attitude must be unit quaternions, got norm {norm:.6g}", k, "attitude_w")
    grades = {"omega_body": bivector, "momentum_space": bivector, "position": vector, "velocity": vector}
    found = {name: make(np.ascontiguousarray(parts[name])) for name, make in grades.items() if name in parts}
    rotor = Rotor._from_rows(np.ascontiguousarray(quaternions * [1.0, -1.0, -1.0, -1.0]))
    return AttitudeHistory(
        time,
        rotor,
        **found,
        energy=parts.get("energy"),
        wheel_speed=wheels,
        attributes=attributes,
        inertia=None if inertia is None else Inertia.from_matrix(inertia),
    )


# --- writing


def _parts(history: AttitudeHistory) -> dict[str, Array]:
    """Return the components of the known quantities."""
    parts = {"attitude": np.asarray(history.rotor.to_quaternion(order="wxyz"))}
    for name in list(ALONG_TIME)[1:]:
        values = getattr(history, name)
        if values is not None:
            parts[name] = np.asarray(getattr(values, "components", values))
    return parts


def _columns(history: AttitudeHistory) -> dict[str, Array]:
    """Return the columns of the known quantities, without the times."""
    columns: dict[str, Array] = {}
    for name, values in _parts(history).items():
        names = columns_of(name)
        columns |= dict(zip(names, values.reshape(len(history), len(names)).T, strict=True))
    if history.wheel_speed is not None:
        columns |= {f"wheel_speed_{k}": x for k, x in enumerate(history.wheel_speed.T)}
    return columns


def _csv(history: AttitudeHistory) -> bytes:
    columns = {"time": history.time, **_columns(history)}
    rows = np.stack(list(columns.values()), axis=-1).tolist()
    names = [table.PARTIAL, *list(columns)[1:]]
    return "\n".join([",".join(names), *(",".join(map(repr, row)) for row in rows), ""]).encode()


def _parquet(history: AttitudeHistory) -> bytes:
    table.require_parquet()
    pd = optional("pandas", "parquet", "a Parquet file")
    columns = _columns(history)
    frame = pd.DataFrame(columns, pd.Index(history.time, name="time"))
    units = {name: "rad/s" if name.startswith("wheel") else UNITS[name] for name in columns}
    plain = {name: table._plain(x) for name, x in _attributes(history).items()}
    frame.attrs |= {**plain, "units": {"time": "s", **units}}
    return bytes(frame.to_parquet(engine="pyarrow"))


def _netcdf(history: AttitudeHistory) -> bytes:
    netcdf.require_libraries()
    variables = {name: netcdf.quantity(name, ("time",), x) for name, x in _parts(history).items()}
    if history.wheel_speed is not None:
        variables["wheel_speed"] = netcdf.wheels_of(("time",), history.wheel_speed)
    if history.inertia is not None:
        variables["inertia"] = netcdf.quantity("inertia", (), history.inertia.matrix)
    return netcdf.encoded(history.time, variables, _attributes(history))


def _attributes(history: AttitudeHistory) -> dict[str, Any]:
    return {**netcdf.origin(), **history.attributes}
