"""Reading measured data from CSV files, with the line and column of every mistake."""

from __future__ import annotations

import csv
import io
import math
import os
import re
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from polhode._report.table import columns_of
from polhode._support.arrays import Array
from polhode._support.counts import counted
from polhode._support.file_kinds import is_comment, names_in_comment, require_csv, separator_of
from polhode._support.files import UnreadableError, contents

RATES, QUATERNION = ("t", "wx", "wy", "wz"), ("t", "qw", "qx", "qy", "qz")
BOTH = RATES + QUATERNION[1:]
# Names of the same columns in the tables of motions that Polhode writes: in s and rad/s.
OF_MOTION = tuple(
    ("time", *(column for name in names for column in columns_of(name)))
    for names in (("omega_body", "attitude"), ("omega_body",), ("attitude",))
)
# Number of names, of a time and its values, for each kind of data.
KINDS = {len(RATES): ("rates",), len(QUATERNION): ("attitude",), len(BOTH): ("rates", "attitude")}
# Start of a time stamp, as 2026-01-31T12:00:00.
_DATE = re.compile(r"\d{4}-\d\d-\d\d|\d\d?:\d\d")
# Least number of rows of each kind.
FEWEST = 3
# Greatest difference from 1 of the norm of a quaternion: that of components with two decimals is below it.
_OFF = 0.02


@dataclass(frozen=True)
class Table:
    """Columns of a file: times (n,) and values (n, 3) or (n, 4), in the units of the file.

    `of_motion` is whether their names are those of `OF_MOTION`, which mean s and rad/s.
    """

    times: Array
    values: Array
    of_motion: bool


def read_tables(path: Path, names: tuple[str, ...] | None) -> dict[str, Table]:
    """Return the tables ``"rates"``, ``"attitude"`` or both of a file; ``-`` is standard input.

    Names of the columns are those of `RATES`, `QUATERNION` or `BOTH`, or as many others; None for these or
    those of `OF_MOTION`. The first line has the names, which may be quoted, separated as the numbers below:
    by commas, or else by semicolons or tabs. Numbers may be quoted. Empty lines and lines that begin with #
    are skipped. In a file of both kinds a row may have empty fields for one of them.

    Raises
    ------
    UnreadableError
        With file, line and column, for a name that is missing, a field that is not a finite number, a
        quaternion whose norm is not 1, a line with another number of fields, times that do not increase, and
        too few rows; with the file if it cannot be read.
    """
    path, lines = _lines(path)
    rows = [(k, x) for k, x in enumerate(lines, 1) if not is_comment(x)]
    if not rows:
        raise UnreadableError(f"{path}: error: the file is empty; its first line has names of columns")
    separator = separator_of(rows[0][1])
    header = _header(f"{path}:{rows[0][0]}:1: error:", rows[0][1], separator, lines[: rows[0][0] - 1])
    names = names or _default(path, rows[0][0], header)
    places = _places(f"{path}:{rows[0][0]}:1: error:", names, header)
    kinds = KINDS[len(names)]
    columns = dict(zip(kinds, (places[1:4], places[4:]) if len(kinds) > 1 else (places[1:],), strict=True))
    found: dict[str, list[tuple[int, list[float]]]] = {kind: [] for kind in kinds}
    for line, text in rows[1:]:
        fields = text.split(separator)
        if len(fields) != len(header):
            raise UnreadableError(
                f"{path}:{line}:1: error: {counted(len(fields), 'field')}, "
                f"but {len(header)} columns are named"
            )
        for kind, own in columns.items():
            if len(kinds) == 1 or any(_unquoted(fields[place]) for place in own):
                found[kind].append((line, _numbers(path, line, fields, [places[0], *own])))
    for kind, numbers in found.items():
        if len(numbers) < FEWEST:
            raise UnreadableError(
                f"{path}:{rows[-1][0]}:1: error: the file ends after {counted(len(numbers), 'row')} of "
                f"{kind}; a fit needs at least {FEWEST}"
            )
    of_motion = names in OF_MOTION
    return {kind: _table(path, own, len(columns[kind]) + 1, of_motion) for kind, own in found.items()}


def _lines(path: Path) -> tuple[Path, list[str]]:
    """Return the lines of a file, and its name in messages; ``-`` is standard input."""
    try:
        if path == Path("-"):
            path = Path("<stdin>")
            content = _standard_input()
        else:
            require_csv(path)
            content = contents(path, copies=4)
        return path, io.StringIO(content.decode("utf-8-sig"), newline=None).read().split("\n")
    except OSError as error:
        remedy = "; give the path of a CSV file" if os.path.isdir(path) else ""
        raise UnreadableError(f"{path}: error: {(error.strerror or str(error)).lower()}{remedy}") from None
    except UnicodeDecodeError as error:
        raise UnreadableError(
            f"{path}: error: not UTF-8 text from byte {error.start} on; save the data as CSV in UTF-8"
        ) from None


def _header(prefix: str, text: str, separator: str, before: list[str]) -> list[str]:
    """Return the names of the columns in the first line after the comments `before`.

    `prefix` begins the messages of errors.
    """
    try:
        fields = next(csv.reader([text], delimiter=separator, skipinitialspace=True))
    except csv.Error as error:
        raise UnreadableError(f"{prefix} not names of columns: {error}; write them as t,wx,wy,wz") from None
    header = [x.strip() for x in fields]
    if len(header) == 1 and len(header[0].split()) >= len(RATES):
        raise UnreadableError(
            f"{prefix} the columns are separated by spaces; separate names and numbers by commas, "
            "semicolons or tabs"
        )
    if all(_is_number(x) for x in header):
        remedy = names_in_comment(before, text, separator)
        raise UnreadableError(
            f"{prefix} the first line has numbers; it must have the names of the columns{remedy}"
        )
    return header


def _places(prefix: str, names: tuple[str, ...], header: list[str]) -> list[int]:
    """Return the places of the names in the header, in which each occurs once."""
    for name in names:
        if header.count(name) != 1:
            problem = f"{header.count(name)} columns are named" if name in header else "there is no column"
            raise UnreadableError(
                f"{prefix} {problem} {name!r} among {', '.join(header)}; give the names with --columns"
            )
    return [header.index(name) for name in names]


def _standard_input() -> bytes:
    if sys.stdin is None:
        raise OSError("standard input is closed; give the path of a file")
    return sys.stdin.buffer.read()


def _default(path: Path, line: int, header: list[str]) -> tuple[str, ...]:
    """Return `BOTH`, `RATES`, `QUATERNION` or those of `OF_MOTION`, whichever the file has."""
    for names in (BOTH, RATES, QUATERNION, *OF_MOTION):
        if set(names) <= set(header):
            if names in OF_MOTION and "body" in header:
                raise UnreadableError(
                    f"{path}:{line}:1: error: the table has a batch of bodies; write one of them to a file "
                    f"of its own with `polhode convert {path} FILE.csv --body N`"
                )
            return names
    raise UnreadableError(
        f"{path}:{line}:1: error: the columns {', '.join(header)} have neither rates t,wx,wy,wz nor "
        "t,qw,qx,qy,qz, nor those of a motion that polhode wrote; give the names with --columns"
    )


def _numbers(path: Path, line: int, fields: list[str], places: list[int]) -> list[float]:
    """Return the numbers at these places of a line."""
    numbers = []
    for place in places:
        field = _unquoted(fields[place])
        value = _number(field)
        if not math.isfinite(value):
            problem = f"{field!r} is not a finite number" if field else "the field is empty"
            if _is_number(field.replace(",", ".")):
                remedy = "write a decimal point"
            elif place == places[0] and _DATE.match(field):
                remedy = "write times as numbers, such as seconds since the first row"
            else:
                remedy = "remove the row"
            raise UnreadableError(f"{path}:{line}:{_column(fields, place)}: error: {problem}; {remedy}")
        numbers.append(value)
    if len(places) == len(QUATERNION) and not abs((norm := math.hypot(*numbers[1:])) - 1) < _OFF:
        raise UnreadableError(
            f"{path}:{line}:{_column(fields, places[1])}: error: the quaternion must have norm 1, got "
            f"{norm:.6g}; check the columns, or remove the row"
        )
    return numbers


def _unquoted(field: str) -> str:
    """Return a field without spaces around it and the quotes of tables that quote all fields."""
    field = field.strip()
    return field[1:-1].strip() if len(field) > 1 and field[0] == field[-1] == '"' else field


def _is_number(text: str) -> bool:
    return math.isfinite(_number(text))


def _number(text: str) -> float:
    """Return the number that a text is; NaN for other text, and for 1_000, as Python writes it."""
    try:
        return float(text) if text.isascii() and "_" not in text else math.nan
    except ValueError:
        return math.nan


def _column(fields: list[str], place: int) -> int:
    """Return the column, from 1, at which the text of a field begins."""
    before = sum(len(x) + 1 for x in fields[:place])
    return before + len(fields[place]) - len(fields[place].lstrip()) + 1


def _table(path: Path, rows: list[tuple[int, list[float]]], width: int, of_motion: bool) -> Table:
    numbers = np.array([row for _, row in rows]).reshape(-1, width)
    _check_order(path, [line for line, _ in rows], numbers[:, 0])
    return Table(numbers[:, 0], numbers[:, 1:], of_motion)


def _check_order(path: Path, lines: list[int], times: Array) -> None:
    rising = np.diff(times) > 0
    if not rising.all():
        k = int(np.argmin(rising))
        remedy = "remove samples that repeat" if times[k + 1] == times[k] else "sort the rows by time"
        raise UnreadableError(
            f"{path}:{lines[k + 1]}:1: error: times must increase, but {times[k + 1]:.12g} follows "
            f"{times[k]:.12g}; {remedy}"
        )
