"""Registry of laws: names, arguments and formulas of torques and forces, from the core."""

from __future__ import annotations

from dataclasses import dataclass

from polhode import _native


@dataclass(frozen=True)
class Argument:
    """An argument of a law.

    Attributes
    ----------
    name
        Its name in Python and in the formula.
    field
        Its field in the table of the law in a scene; empty where the law is this value alone.
    unit
        SI, ``"1"`` for pure numbers.
    shape
        ``"scalar"``, ``"vector"``, ``"bivector"``, ``"gains"`` (a number or three along the body axes),
        ``"rotor"``, ``"numbers"``, ``"bivectors"`` or ``"word"``.
    default
        Its numbers where it is left out; None where it must be given.
    words
        The values of a word.
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
