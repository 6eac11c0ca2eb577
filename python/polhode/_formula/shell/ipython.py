"""The IPython magics ``%ga`` and ``%%ga``: formulas over the names of a notebook."""

from __future__ import annotations

import numbers
import re
import sys
import unicodedata
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.linear_map import LinearMap
from polhode._formula.shell.session import FUNCTIONS, Answer, LineError, Session, canonical, without_comment

_CALLS = re.compile(rf"\b({'|'.join(FUNCTIONS)})\s*\(")


class NotebookError(ValueError):
    """An error in a line of formulas; notebooks show it without a traceback."""

    def _render_traceback_(self) -> list[str]:
        return str(self).splitlines()


def spelled(text: str, everything: dict[str, Any]) -> dict[str, str]:
    """Return the names of a notebook that a text may use, by their spelling in formulas.

    A formula that contains all letters of a name may use it. Arrays, and any values where there are several
    algebras, are given only to such formulas.
    """
    usable = {name: value for name, value in everything.items() if _is_usable(value)}
    algebras = {own for value in usable.values() if (own := _algebra(value))}
    letters = set(unicodedata.normalize("NFKD", _CALLS.sub("(", text)))
    found: dict[str, str] = {}
    for name, value in usable.items():
        occurs = all(c in letters for c in unicodedata.normalize("NFKD", name) if c.isalpha())
        single = getattr(value, "shape", ()) == ()
        spelling = canonical(name) if occurs or (single and len(algebras) < 2) else None
        if spelling and (spelling == name or spelling not in found):
            found[spelling] = name
    return found


def _is_usable(value: Any) -> bool:
    if isinstance(value, np.ndarray):
        return value.dtype.kind in "iufcO"
    if isinstance(value, _native.Multivector | LinearMap):
        return True
    if isinstance(value, numbers.Complex):
        return value is not True and value is not False
    sympy = sys.modules.get("sympy")
    return hasattr(value, "__array_namespace__") or (sympy is not None and isinstance(value, sympy.Expr))


def _algebra(value: Any) -> Any:
    """Return the algebra of a value, None without one."""
    return value.algebra if isinstance(value, _native.Multivector | LinearMap) else None


def magic(everything: dict[str, Any]) -> Any:
    """Return the function of ``%ga`` and ``%%ga`` for a notebook with these names."""
    session = Session(only_finite=False)

    def run(text: str) -> Answer:
        bodies = " ".join(body for _, body in session.functions.values())
        called = spelled(f"{text} {bodies}", everything)
        session.values = {spelling: everything[name] for spelling, name in called.items()}
        answer = session.run(text)
        if answer.name and answer.value is not None:
            everything[called.get(answer.name, answer.name)] = answer.value
        return answer

    def ga(line: str, cell: str | None = None) -> Any:
        """Evaluate formulas, one on each line, and display the value of the last.

        ``name = …`` assigns to a name of the notebook, with units if needed (``θ = 90 deg``), and
        ``f(x) = …`` defines a function for later lines. ``lhs == rhs`` compares; ``#`` begins a comment.
        """
        value = None
        # The line of the magic itself is line 1 of a cell.
        for number, text in enumerate([line, *(cell or "").splitlines()], 1):
            text = without_comment(text)
            try:
                answer = run(text) if text else None
            except LineError as mistake:
                raise NotebookError(mistake.shown("%ga", number, text)) from None
            if answer and answer.note:
                print(answer.note)
            if answer and answer.name is None:
                value = answer.value
        return value

    return ga


def load(shell: Any) -> None:
    """Register the magics in an IPython shell."""
    shell.register_magic_function(magic(shell.user_ns), magic_kind="line_cell", magic_name="ga")
