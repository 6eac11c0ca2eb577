"""docs/translations.md as data, and the values of other libraries as numbers over our basis."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import polhode as ph
from naive import eight_of

PAGE = (Path(__file__).parents[2] / "docs/translations.md").read_text()

# Index in our basis of a blade, as the bits of its vectors, and its sign: e13 = −e3e1.
PLACES = {0b000: 0, 0b001: 1, 0b010: 2, 0b100: 3, 0b110: 4, 0b101: 5, 0b011: 6, 0b111: 7}
SIGNS = {bits: -1 if bits == 0b101 else 1 for bits in PLACES}
CANONICAL = [0b000, 0b001, 0b010, 0b100, 0b011, 0b101, 0b110, 0b111]


@dataclass(frozen=True)
class Line:
    """A line of a table: the equation `theirs = ours`; `theirs` is None if they lack it."""

    operation: str
    theirs: str | None
    ours: str


def code(text, place=0):
    """A Python block, by default the first."""
    return re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)[place]


def lines(text):
    """The lines of the table below its head."""
    rows = [line for line in text.splitlines() if line.startswith("|")][2:]
    for row in rows:
        # A bar within an expression is written \|.
        cells = [cell.strip().replace(r"\|", "|") for cell in re.split(r"(?<!\\)\|", row)[1:-1]]
        operation, theirs, ours, _ = cells
        yield Line(operation, None if theirs == "–" else expression(theirs), expression(ours))


def expression(cell):
    """The text between the backticks, which enclose the whole cell."""
    return re.fullmatch(r"`([^`]*)`", cell)[1]


INTRODUCTION, *REST = re.split(r"^## ", PAGE, flags=re.MULTILINE)
SECTIONS = {section.splitlines()[0]: section for section in REST}
TABLES = {library: list(lines(section)) for library, section in SECTIONS.items()}


def over_our_basis(coefficients):
    """Components (..., 8) from a mapping of blades to numbers or batches."""
    eight = [0.0] * 8
    for bits, x in coefficients.items():
        eight[PLACES[bits]] = SIGNS[bits] * np.asarray(x, dtype=float)
    return np.stack(np.broadcast_arrays(*eight), axis=-1)


def quaternion_as_rotor(wxyz):
    """Components (..., 8) of w − x e2e3 − y e3e1 − z e1e2."""
    w, x, y, z = np.moveaxis(wxyz, -1, 0)
    return over_our_basis({0b000: w, 0b110: -x, 0b101: y, 0b011: -z})


def numbers(value):
    """Components (..., 8) of a multivector or quaternion of any of the libraries, or the array that it is."""
    library = type(value).__module__.partition(".")[0]
    if isinstance(value, ph.Multivector):
        return eight_of(value)
    if library == "clifford":
        return over_our_basis(dict(zip(CANONICAL, np.moveaxis(value.value, -1, 0), strict=True)))
    if library == "kingdon":
        return over_our_basis(dict(value.items()))
    if library == "galgebra":
        coefficients = [x for grade in range(4) for x in value.grade(grade).get_coefs(grade)]
        return over_our_basis(dict(zip(CANONICAL, coefficients, strict=True)))
    if library == "galaga":
        return over_our_basis(dict(enumerate(value.data)))
    if library == "scipy":
        return quaternion_as_rotor(value.as_quat(scalar_first=True))
    if library == "quaternion" or getattr(value, "dtype", None) == "quaternion":
        import quaternion

        return quaternion_as_rotor(quaternion.as_float_array(value))
    return np.asarray(value, dtype=float)
