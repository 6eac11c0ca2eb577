"""Format the times as tables and as JSON."""

from __future__ import annotations

import json
from typing import Any

from contest import OUR_CALLS, OUR_CALLS_INTO, OURS, Row

UNITS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3}
COLUMNS = [
    OURS,
    OUR_CALLS,
    OUR_CALLS_INTO,
    "clifford",
    "kingdon",
    "kingdon, numba",
    "galaga",
    "gasparse",
    "SciPy",
    "numpy-quaternion",
    "numba",
    "NumPy",
    "JAX",
    "MuJoCo",
    "MuJoCo, rollout",
    "Pauli",
]
LEGEND = """\
Time per result, the best of several runs in turns; all libraries gave the same results before. "memory" is
the time to move the inputs and outputs at the speed of NumPy's copy on all cores; "peer/ours" is the time of
the fastest other library over ours, marked "behind" below 1. "calls" are our separate calls. numba, NumPy
and JAX are formulas written by hand; Pauli is the same with 2×2 complex matrices. A dash means that a library
lacks the operation; see the notes."""


def figure(value: float | None) -> str:
    """Format with three digits and without an exponent."""
    return "–" if value is None else f"{value:.0f}" if value >= 99.95 else f"{value:#.3g}".rstrip(".")


def aligned(lines: list[list[str]]) -> str:
    """Format lines of cells, the first line the header, as a Markdown table; the first column is text."""
    widths = [max(len(line[k]) for line in lines) for k in range(len(lines[0]))]
    rule = ["-" * widths[0], *("-" * (width - 1) + ":" for width in widths[1:])]
    body = [lines[0], rule, *lines[1:]]
    padded = [
        [
            line[0].ljust(widths[0]),
            *(cell.rjust(width) for cell, width in zip(line[1:], widths[1:], strict=True)),
        ]
        for line in body
    ]
    return "\n".join(f"| {' | '.join(line)} |" for line in padded)


def section(title: str, rows: list[Row], bandwidth: float) -> str:
    """Return a table with a column for each library that has an entry."""
    held = [column for column in COLUMNS if column == OURS or any(column in row.seconds for row in rows)]
    limited = any(row.traffic for row in rows)
    lines = [["", "unit", *held, *(["memory"] if limited else []), "peer/ours", "goal"]]
    for row in rows:
        unit = UNITS[row.unit]
        figures = [figure(row.seconds[name] / unit if name in row.seconds else None) for name in held]
        memory = [figure(row.traffic / bandwidth / unit or None)] if limited else []
        lines.append([row.what, row.unit, *figures, *memory, ratio(row), row.goal or "–"])
    return f"## {title}\n\n{aligned(lines)}\n{notes(rows)}"


def ratio(row: Row) -> str:
    """Format the time of the fastest other library over ours, with a mark where it is faster."""
    ahead = row.ahead()
    if ahead is None:
        return "–"
    return f"behind {figure(ahead)}×" if ahead < 1 else f"{figure(ahead)}×"


def notes(rows: list[Row]) -> str:
    """Return the list of missing entries with their reasons."""
    found: dict[tuple[str, str], list[str]] = {}
    for row in rows:
        for library, note in row.notes.items():
            found.setdefault((library, note), []).append(row.what)
    lines = [f"- {library}: {note} ({'; '.join(whats)})" for (library, note), whats in found.items()]
    return "\n" + "\n".join(lines) + "\n" if lines else ""


def matrices(rows: list[Row]) -> str:
    """Compare Pauli matrices with the algebra; the handout says that they are usually slower."""
    both = [row for row in rows if {OURS, "Pauli"} <= row.seconds.keys()]
    ratios = [[row.what, f"{figure(row.seconds['Pauli'] / row.seconds[OURS])}×"] for row in both]
    return f"## The matrix method\n\n{aligned([['', 'time over ours'], *ratios])}\n"


def spellings(rows: list[Row]) -> str:
    """Return a table of the expressions."""
    lines = [["", "library", "expression", "results"]]
    for row in rows:
        lines += [
            [row.what, name, f"`{entry.code}`", str(entry.count)] for name, entry in row.entries.items()
        ]
    return aligned(lines)


def facts(pairs: dict[str, str]) -> str:
    """Names and values, a line each."""
    return "\n".join(f"- {name}: {value}" for name, value in pairs.items())


def data(about: dict[str, Any], sections: dict[str, list[Row]]) -> bytes:
    """Everything as JSON, times in seconds per result."""
    rows = [
        {
            "section": title,
            "what": row.what,
            "goal": row.goal,
            "count": row.count,
            "traffic": row.traffic,
            "seconds": row.seconds,
            "expressions": {name: entry.code for name, entry in row.entries.items()},
            "notes": row.notes,
        }
        for title, rows in sections.items()
        for row in rows
    ]
    return (json.dumps({**about, "rows": rows}, ensure_ascii=False, indent=1) + "\n").encode()
