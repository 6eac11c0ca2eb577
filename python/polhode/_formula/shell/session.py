"""Sessions of formulas for the shell, the prompt and notebooks; the core reads their lines."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

import numpy as np

from polhode import _native
from polhode._formula.agreement import Agreement
from polhode._formula.formula import Formula, FormulaError, formula

FUNCTIONS = (
    *("commutator", "cos", "cross", "dot", "dual", "exp", "inverse", "left_contraction", "log", "norm"),
    *("reverse", "right_contraction", "sin", "sqrt", "tan", "undual", "wedge"),
)

T = TypeVar("T")

_LET = re.compile(r"let\s+")


class LineError(Exception):
    """An error in a line, with its place in characters."""

    def __init__(self, message: str, start: int, end: int) -> None:
        super().__init__(message)
        self.message, self.start, self.end = message, start, end

    def shown(self, source: str, number: int, line: str) -> str:
        """Return it as compilers show it: ``source:line:column: error: …``, the line, and a caret."""
        return _native.diagnostic(source, number, line, self.start, self.end, self.message)


@dataclass(frozen=True)
class Answer:
    """The outcome of a line: its value, and the name that got it, if any.

    A definition of a function has no value. `note` is a remark for the user, or empty.
    """

    value: Any = None
    name: str | None = None
    formula: Formula | None = None
    given: Mapping[str, Any] = field(default_factory=dict)
    note: str = ""

    def spelled(self, style: str) -> str:
        """Return the formula in the canonical spelling of a style, "unicode", "ascii" or "latex"."""
        assert self.formula is not None
        return self.formula.spelled(style, **self.given)


class Session:
    """Names with values and functions, which lines of formulas use and define.

    Units are read where a name gets a value, ``θ = 90 deg``, and nowhere else: in a formula ``m`` is a name.
    ``_`` is the last value.

    Attributes
    ----------
    only_finite
        Whether an infinite value or NaN is an error.
    values
        By canonical name.
    functions
        Head and body, ``("V(x)", "½ x·x")``, by canonical name. They take precedence over values.
    """

    def __init__(self, only_finite: bool) -> None:
        self.only_finite = only_finite
        self.values: dict[str, Any] = {}
        self.functions: dict[str, tuple[str, str]] = {}
        self._last: Any = None

    @property
    def names(self) -> list[str]:
        """The names of values and functions."""
        return sorted({*self.values, *self.functions})

    def run(self, line: str, start: int = 0, assigns: bool | None = None) -> Answer:
        """Return the outcome of ``line[start:]``: ``name = …`` and ``f(x) = …`` assign, else it is a formula.

        `assigns` says which it is, such as False for ``a = b``, an equation.

        Raises
        ------
        LineError
            If the line is invalid or has no value.
        """
        read = self._line(line, start, assigns)
        if read.name and read.function:
            self._define(read, read.name, read.function)
            return Answer(name=read.name)
        answer = self._answer(read)
        if read.name is None:
            return answer
        if isinstance(answer.value, Agreement):
            raise LineError(*read.error(_native.EQUATION_AS_VALUE))
        note = self._note(read.name) if assigns is None else ""
        self.values[read.name] = answer.value
        self.functions.pop(read.name, None)
        return replace(answer, name=read.name, note=note)

    def about(self, line: str, start: int, what: Callable[..., T]) -> T:
        """Return the result of `what` for the formula ``line[start:]`` and the values of names."""
        read = self._line(line, start, False)
        parsed, given = self._parsed(read)
        try:
            return what(parsed, **given)
        except FormulaError as error:
            raise _placed(read, error) from None

    def forget(self, name: str) -> None:
        """Remove a name; a LookupError if this is not possible, with the reason."""
        key = canonical(name) or name
        if key not in self.names:
            raise LookupError(f"`{name}` has no value")
        values = {other: value for other, value in self.values.items() if other != key}
        functions = {other: function for other, function in self.functions.items() if other != key}
        try:
            _check(functions, values)
        except FormulaError as error:
            raise LookupError(f"`{name}` is used in the definition `{error.text.strip()}`") from None
        self.values, self.functions = values, functions

    # --- how

    def _line(self, line: str, start: int, assigns: bool | None) -> _native.Line:
        try:
            return _native.Line(line, start, assigns, set(self.names))
        except ValueError as error:
            raise LineError(*error.args) from None

    def _parsed(self, read: _native.Line) -> tuple[Formula, dict[str, Any]]:
        given = _given(self.functions, self.values)
        if read.uses_last:
            if self._last is None:
                raise LineError(*read.error(_native.NO_LAST_VALUE))
            given[_native.LAST_VALUE] = self._last
        try:
            return formula(read.text, define=dict(self.functions.values())), given
        except FormulaError as error:
            raise _placed(read, error) from None

    def _answer(self, read: _native.Line) -> Answer:
        parsed, given = self._parsed(read)
        try:
            value = parsed(given)
        except FormulaError as error:
            raise _placed(read, error) from None
        except (ValueError, TypeError, ArithmeticError, MemoryError) as error:
            raise LineError(*read.error(str(error) or "out of memory")) from None
        if self.only_finite and not _is_finite(value):
            raise LineError(*read.error(_native.NOT_FINITE))
        if not isinstance(value, Agreement):
            self._last = value
        return Answer(value, None, parsed, given)

    def _note(self, name: str) -> str:
        """Return a remark on a new name whose letters have values: `aB = …` may be meant as an equation."""
        if name in self.names or not name.isalpha():
            return ""
        try:
            tree = formula(name).tree(**_given(self.functions, self.values))
        except (FormulaError, TypeError):
            return ""
        if tree["kind"] != "product":
            return ""
        return (
            f"`{name}` is now one name, not the product `{' '.join(name)}`; `{' '.join(name)} == …` compares"
        )

    def _define(self, read: _native.Line, name: str, head: str) -> None:
        """Define a function, whose other names must have values."""
        functions = {**self.functions, name: (head, read.text)}
        try:
            _check(functions, self.values)
        except FormulaError as error:
            raise _placed(read, error) from None
        self.functions = functions


def _placed(read: _native.Line, error: FormulaError) -> LineError:
    return LineError(*read.place(error.message, error.text, error.span))


def _check(functions: dict[str, tuple[str, str]], values: Mapping[str, Any]) -> None:
    """Raise a FormulaError unless all names in the functions have values."""
    formula("0", define=dict(functions.values()))(_given(functions, values))


def _given(functions: dict[str, tuple[str, str]], values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in values.items() if name not in functions}


def canonical(name: str) -> str | None:
    """Return the canonical spelling of a name, ``a1`` for ``a_1``; None if it is not a name."""
    return _native.canonical(name.strip())


def after_let(line: str) -> int:
    """Return where the assignment begins in ``let name = …``; 0 without ``let``."""
    let = _LET.match(line)
    return let.end() if let else 0


def without_comment(line: str) -> str:
    """Return a line without its comment, ``# …``, and the spaces around it."""
    return line.partition("#")[0].strip()


def _is_finite(value: Any) -> bool:
    """Whether all numbers of a value or an agreement are finite."""
    numbers = (value.residual, value.size) if isinstance(value, Agreement) else (value.components,)
    return all(bool(np.all(np.isfinite(x))) for x in numbers)


def text_of(value: Any) -> str:
    """Return a value in the notation of formulas, or whether the sides of an equation agree."""
    if not isinstance(value, Agreement):
        return repr(value)
    return f"{str(bool(value)).lower()}, residual {value.residual:.2g} of terms of size {value.size:.2g}"
