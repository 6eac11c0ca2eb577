"""Registry of laws: names, arguments and formulas of torques and forces, from the core."""

from __future__ import annotations

from dataclasses import dataclass

from polhode import _native


@dataclass(frozen=True)
class Argument:
    """An argument of a law: its name in Python and in the formula, and its SI unit, ``"1"`` for pure numbers.

    `field` is its field in the table of the law in a scene, empty where the law is this value alone. The
    shape is ``"scalar"``, ``"vector"``, ``"bivector"``, ``"gains"`` (a number or three along the body axes),
    ``"rotor"``, ``"numbers"``, ``"bivectors"`` or ``"word"``, one of `words`. The default is None where the
    argument must be given.
    """

    name: str
    field: str
    unit: str
    shape: str
    default: list[float] | None
    words: list[str]


@dataclass(frozen=True)
class Entry:
    """A law: its name, its label on the page, its formula and its arguments."""

    name: str
    label: str
    formula: str
    arguments: tuple[Argument, ...]


TORQUES, FORCES = (
    {
        name: Entry(name, label, formula, tuple(Argument(*one) for one in arguments))
        for name, label, formula, arguments in table
    }
    for table in _native.law_registry()
)


def _words(name: str) -> tuple[str, ...]:
    return next(tuple(x.words) for x in TORQUES["tabulated"].arguments if x.name == name)


# Axes of components, and kinds of interpolation in a table.
FRAMES, INTERPOLATIONS = _words("frame"), _words("kind")
