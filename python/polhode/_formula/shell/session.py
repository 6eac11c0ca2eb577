"""Formulas line by line, and the names they give values to: for the shell, the prompt and notebooks."""

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

# `_` alone: neither a subscript, `a_1`, nor the grade of a part, `⟨M⟩_2`.
_LAST = re.compile("(?<![\\w\u0300-\u036f⟩〉>})\\]'′’∥⊥])_(?![\\w{])")
_LAST_NAME = "last_value"
_CALL = re.compile(r"([^()]+)\(([^()]*)\)")


class LineError(Exception):
    """What is wrong with a line, and where in it, in characters."""

    def __init__(self, message: str, start: int, end: int) -> None:
        super().__init__(message)
        self.message, self.start, self.end = message, start, end

    def shown(self, source: str, number: int, line: str) -> str:
        """Return it as compilers show it: ``source:line:column: error: …``, the line, and a caret."""
        return _native.diagnostic(source, number, line, self.start, self.end, self.message)


@dataclass(frozen=True)
class Answer:
    """What a line came to: the value of a formula, and the name that got it, if one did.

    Where a function was defined there is no value.
    """

    value: Any = None
    name: str | None = None
    formula: Formula | None = None
    given: Mapping[str, Any] = field(default_factory=dict)

    def spelled(self, style: str) -> str:
        """Return the formula in the canonical spelling of a style, "unicode", "ascii" or "latex"."""
        assert self.formula is not None
        return self.formula.spelled(style, **self.given)


class Session:
    """Names with values, and functions, which lines of formulas use and add to.

    Units are read where a name gets a value, ``θ = 90 deg``, and nowhere else: in a formula ``m`` is a name.
    ``_`` stands for the last value.

    Attributes
    ----------
    only_finite
        Whether a value that is infinite or NaN is a mistake.
    values
        By canonical name.
    functions
        Head and body, ``("V(x)", "½ x·x")``, by canonical name. They come before values of the same name.
    """

    def __init__(self, only_finite: bool) -> None:
        self.only_finite = only_finite
        self.values: dict[str, Any] = {}
        self.functions: dict[str, tuple[str, str]] = {}
        self._last: Any = None

    @property
    def names(self) -> list[str]:
        """What has a value or is a function."""
        return sorted({*self.values, *self.functions})

    def run(self, line: str) -> Answer:
        """Return what a line comes to: ``name = …`` and ``f(x) = …`` assign, all else is a formula.

        What is wrong with it is a LineError.
        """
        return self.assign(line) if assigns(line) else self.evaluate(line)

    def evaluate(self, line: str, start: int = 0) -> Answer:
        """Return the value of the formula ``line[start:]``."""
        return self._answer(_Source(line, start))

    def assign(self, line: str, start: int = 0) -> Answer:
        """Give a value to the name before the first ``=`` of ``line[start:]``, or define a function."""
        written, sign, _ = line[start:].partition("=")
        head, body = written.strip(), start + len(written) + len(sign)
        function, name = called(head), canonical(head)
        if not sign or not (function or name):
            problem = f"`{head}` is no name" if sign else "expected `name = value`"
            first = start + len(written) - len(written.lstrip())
            names = "names are letters with subscripts and primes, `Ω_B`, `R'`, or words"
            raise LineError(f"{problem}; {names}", first, first + len(head))
        parameters = head.removesuffix(")").partition("(")[2].split(",") if function else []
        source = _Source(line, body, self._quantities(line, body, parameters))
        if function:
            self._define(function, head, source)
            return Answer(name=function)
        answer = self._answer(source)
        if isinstance(answer.value, Agreement):
            raise source.mistake(f"an equation is no value for `{head}`; compare with `==`")
        self.values[str(name)] = answer.value
        self.functions.pop(str(name), None)
        return replace(answer, name=name)

    def about(self, line: str, start: int, what: Callable[..., T]) -> T:
        """Return what `what` makes of the formula ``line[start:]`` and of the values of names."""
        source = _Source(line, start)
        read, given = self._read(source)
        try:
            return what(read, **given)
        except FormulaError as error:
            raise source.mistake_of(error) from None

    def forget(self, name: str) -> None:
        """Take its value or its formula from a name; a LookupError says why not."""
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

    def _read(self, source: _Source) -> tuple[Formula, dict[str, Any]]:
        given = _given(self.functions, self.values)
        if source.uses_last:
            if self._last is None:
                raise source.mistake("`_` is the last value; there is none yet")
            given[_LAST_NAME] = self._last
        try:
            return formula(source.text, define=dict(self.functions.values())), given
        except FormulaError as error:
            raise source.mistake_of(error) from None

    def _answer(self, source: _Source) -> Answer:
        read, given = self._read(source)
        try:
            value = read(given)
        except FormulaError as error:
            raise source.mistake_of(error) from None
        except (ValueError, TypeError, ArithmeticError, MemoryError) as error:
            raise source.mistake(str(error) or "out of memory") from None
        if self.only_finite and not _is_finite(value):
            raise source.mistake("the value is beyond the range of floating point, about 1.8e308")
        if not isinstance(value, Agreement):
            self._last = value
        return Answer(value, None, read, given)

    def _define(self, name: str, head: str, source: _Source) -> None:
        """Define a function, whose other names must have values."""
        functions = {**self.functions, name: (head, source.text)}
        place = source.line.index(head)
        try:
            _check(functions, self.values)
        except FormulaError as error:
            if canonical(error.text[slice(*error.span)]) == name:
                raise source.mistake(f"`{name}` would call itself; formulas have no recursion") from None
            if error.text == head:
                raise LineError(error.message, place, place + len(head)) from None
            raise source.mistake_of(error) from None
        self.functions = functions

    def _quantities(self, line: str, start: int, parameters: list[str]) -> list[tuple[int, int, float]]:
        names = {*self.names, *(canonical(name) or name for name in parameters)}
        try:
            found = _native.quantities(line[start:], names)
        except ValueError as error:
            message, first, last = error.args
            raise LineError(message, start + first, start + last) from None
        return [(start + first, start + last, value) for first, last, value in found]


def _check(functions: dict[str, tuple[str, str]], values: Mapping[str, Any]) -> None:
    """Raise a FormulaError unless the functions are functions of these values."""
    formula("0", define=dict(functions.values()))(_given(functions, values))


def _given(functions: dict[str, tuple[str, str]], values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in values.items() if name not in functions}


class _Source:
    """The formula ``line[start:]`` as it is read, with numbers for quantities, and where it comes from."""

    def __init__(self, line: str, start: int, quantities: list[tuple[int, int, float]] | None = None) -> None:
        self.line, self.has_units = line, quantities is not None
        replaced = [(first, last, f"({value!r})") for first, last, value in quantities or []]
        last_values = [(*match.span(), _LAST_NAME) for match in _LAST.finditer(line, start)]
        self.uses_last = bool(last_values)
        pieces: list[str] = []
        self.places: list[tuple[int, int]] = []  # of each character, in the line
        at = start
        for first, last, text in [*sorted(replaced + last_values), (len(line), len(line), "")]:
            pieces += [line[at:first], text]
            self.places += [(i, i + 1) for i in range(at, first)] + [(first, last)] * len(text)
            at = last
        self.text = "".join(pieces)
        self.whole = (len(line) - len(line[start:].lstrip()), len(line.rstrip()))

    def mistake(self, message: str) -> LineError:
        """Return what is wrong with all of it."""
        return LineError(message, *self.whole)

    def mistake_of(self, error: FormulaError) -> LineError:
        """Return an error with its place in the line."""
        if error.text != self.text:
            return self.mistake(f"{error.message}, in the definition `{error.text}`")
        start, end = error.span
        if start >= len(self.places):
            return LineError(error.message, self.whole[1], self.whole[1])
        first, last = self.places[start]
        last = self.places[end - 1][1] if end > start else last
        return LineError(error.message + self._about_units(error.message, first, last), first, last)

    def _about_units(self, message: str, start: int, end: int) -> str:
        """Return what to say where a word that has no value may be a unit."""
        word, after_number = self.line[start:end], self.line[:start].rstrip()[-1:].isnumeric()
        if not (word.isalpha() and "has no value" in message and (unit := _native.near_unit(word))):
            return ""
        if unit == word and self.has_units:
            return f". The unit `{unit}` stands right after a number, as in `0.5 {unit}`"
        if not after_number:
            return ""
        if unit == word:
            return f". Units are read where a name gets a value, as in `x = 2 {word}`"
        return f". Is the unit `{unit}` meant?" if self.has_units else ""


def assigns(line: str) -> bool:
    """Whether a line gives a value to a name, ``a = …`` or ``V(x) = …``; if not it is a formula."""
    head, sign, rest = line.partition("=")
    head = head.strip()
    return bool(sign and not rest.startswith("=") and (called(head) or canonical(head)))


def called(head: str) -> str | None:
    """Return the canonical name of the function in ``V(x)``, all of whose arguments are names."""
    match = _CALL.fullmatch(head)
    if match is None or not all(canonical(name) for name in match[2].split(",")):
        return None
    return canonical(match[1])


def canonical(name: str) -> str | None:
    """Return the one spelling of a name, ``a1`` for ``a_1``; None if it is no name."""
    return _native.canonical(name.strip())


def without_comment(line: str) -> str:
    """Return a line without what follows ``#`` and without spaces around it."""
    return line.partition("#")[0].strip()


def _is_finite(value: Any) -> bool:
    """Whether the numbers of a value or an agreement are numbers, not the infinity or NaN of an overflow."""
    numbers = (value.residual, value.size) if isinstance(value, Agreement) else (value.components,)
    return all(bool(np.all(np.isfinite(x))) for x in numbers)


def told(value: Any) -> str:
    """Return a value as it stands on paper, or whether the sides of an equation agree."""
    if not isinstance(value, Agreement):
        return repr(value)
    return f"{str(bool(value)).lower()}, residual {value.residual:.2g} of terms of size {value.size:.2g}"
