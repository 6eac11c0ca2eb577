"""The equations of the handout: the tests of each, and the page on which it stands.

All of it is read from the files of the tests and of the pages, so that a list of them cannot be out of date.
"""

import ast
import re
from functools import cache
from pathlib import Path
from typing import NamedTuple

FORMULAS = "tests/support/handout_equations.py"
# The numbers of the handout's equations, section by section.
NUMBERS = [
    f"{section}.{k}" for section, last in ((1, 29), (2, 6), (3, 2), (4, 35)) for k in range(1, last + 1)
]
_NUMBERED = re.compile(r"eq_((?:\d+_\d+)(?:_(?:to|and)_\d+_\d+)*)")
_EQUATION = re.compile(r"^```\{equation\} (.*)\n((?:.*\n)*?)```", re.MULTILINE)


class NumberedTest(NamedTuple):
    """A test of an equation: its name, file, lines, and text."""

    name: str
    path: str
    first: int
    last: int
    source: str


class Formula(NamedTuple):
    """A line of the handout, which tests evaluate, with its place."""

    text: str
    path: str
    line: int


class Shown(NamedTuple):
    """An equation on a page: its numbers and its lines."""

    page: str
    numbers: tuple[str, ...]
    lines: tuple[str, ...]


def numbers_in(name: str) -> list[str]:
    """Return the numbers of equations in the name of a test, such as ``test_eq_4_5_to_4_9_…``."""
    match = _NUMBERED.search(name)
    if match is None:
        return []
    found: list[str] = []
    for joint, section, k in re.findall(r"(to|and|)_?(\d+)_(\d+)", match[1]):
        if joint == "to":
            start = int(found[-1].split(".")[1]) + 1
            found += [f"{section}.{n}" for n in range(start, int(k))]
        found.append(f"{section}.{k}")
    return found


@cache
def tests_of_equations(root: Path) -> dict[str, list[NumberedTest]]:
    """Return the tests of each equation by its number."""
    found: dict[str, list[NumberedTest]] = {}
    for path in sorted((root / "tests").rglob("test_*.py")):
        text = path.read_text()
        if "def test_eq_" not in text:
            continue
        lines = text.splitlines()
        for node in ast.parse(text).body:
            if not isinstance(node, ast.FunctionDef) or not node.name.startswith("test_eq_"):
                continue
            first = min([node.lineno, *(mark.lineno for mark in node.decorator_list)])
            last = node.end_lineno or first
            source = "\n".join(lines[first - 1 : last])
            test = NumberedTest(node.name, path.relative_to(root).as_posix(), first, last, source)
            for number in numbers_in(node.name):
                found.setdefault(number, []).append(test)
    return found


@cache
def formulas_of_equations(root: Path) -> dict[str, list[Formula]]:
    """Return the lines by which each equation is tested as a formula."""
    found: dict[str, list[Formula]] = {}
    for node in ast.walk(ast.parse((root / FORMULAS).read_text())):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "Equation":
            numbers, text = (ast.literal_eval(argument) for argument in node.args[:2])
            for number in numbers.split(", "):
                formulas = found.setdefault(number, [])
                if text not in [formula.text for formula in formulas]:
                    formulas.append(Formula(text, FORMULAS, node.lineno))
    return found


@cache
def shown_equations(docs: Path) -> list[Shown]:
    """Return the equations of the handout's pages, in the order of the pages in their index."""
    found = []
    for page in pages(docs):
        for numbers, lines in _EQUATION.findall((docs / f"{page}.md").read_text()):
            found.append(Shown(page, tuple(numbers.split(", ")), tuple(lines.splitlines())))
    return found


def pages(docs: Path) -> list[str]:
    """Return the pages of the handout in order, as names from the folder of the guides."""
    index = (docs / "handout/index.md").read_text()
    toctree = re.search(r"^```\{toctree\}\n(.*?)```", index, re.MULTILINE | re.DOTALL)
    assert toctree is not None
    return [f"handout/{line}" for line in toctree[1].split("\n") if line and not line.startswith(":")]


def anchor(number: str) -> str:
    """Return the anchor of an equation on its page."""
    return "eq-" + number.replace(".", "-")
