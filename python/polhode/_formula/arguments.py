"""Arguments of formulas: values by name, and their kinds."""

from __future__ import annotations

import operator
import unicodedata
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.algebra import algebra as algebra_of
from polhode._algebra.coefficients import scalars
from polhode._algebra.linear_map import LinearMap
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._formula.errors import FormulaError
from polhode._support.arrays import is_float

# A name, grades as bits, and whether it is a value, a rotor, or a linear map of these grades.
Kind = tuple[str, int, int]

_VALUE, _ROTOR, _MAP = 0, 1, 2
_WORDS = {
    "scalar": (0b0001, _VALUE),
    "vector": (0b0010, _VALUE),
    "bivector": (0b0100, _VALUE),
    "trivector": (0b1000, _VALUE),
    "rotor": (0b0101, _ROTOR),
    "map of vectors": (1, _MAP),
    "map of bivectors": (2, _MAP),
}


@dataclass(frozen=True)
class Given:
    """The algebra of all values, their kinds, and the values: multivectors, linear maps, Python numbers.

    Values that no formula accepts are in `refused`, each with its error.
    """

    algebra: Any
    kinds: list[Kind]
    values: list[Any]
    refused: dict[str, TypeError]

    def inputs(self, program: _native.Program) -> list[Any]:
        """Return the inputs of a program: values; for maps, matrices (..., 9), determinants (..., 1)."""
        self._require_one_shape(program)
        return [self._input(self.values[place], kind, grade) for place, kind, grade in program.inputs]

    def narrowed(self) -> Given:
        """Return the same with single values reduced to their nonzero grades."""
        values = [value if _batch(value) else narrowed(value) for value in self.values]
        kinds = [(name, *_kind(value)) for (name, _, _), value in zip(self.kinds, values, strict=True)]
        return Given(self.algebra, kinds, values, self.refused)

    def with_scalars(self, program: _native.Program) -> Given:
        """Return the same with Python numbers as scalars, in the precision of the values in use."""
        used = [self.values[place] for place, _, _ in program.inputs]
        data = [value._data for value in used if isinstance(value, Multivector)]
        data += [value.matrix for value in used if isinstance(value, LinearMap)]
        if data and all(map(is_float, data)):
            like: Any = np.empty(0, np.result_type(*data))
        else:
            like = next((x for x in data if not is_float(x)), None)
        values = [
            value if isinstance(value, Multivector | LinearMap) else self._scalar(value, like)
            for value in self.values
        ]
        return Given(self.algebra, self.kinds, values, self.refused)

    def _scalar(self, number: float, like: Any) -> Multivector:
        return Multivector._of(scalars(number, like), 1, self.algebra)

    def _require_one_shape(self, program: _native.Program) -> None:
        used = dict.fromkeys(place for place, _, _ in program.inputs)
        shapes = {self.kinds[place][0]: _batch(self.values[place]) for place in used}
        try:
            np.broadcast_shapes(*shapes.values())
        except ValueError:
            shown = ", ".join(f"{name} {shape}" for name, shape in shapes.items() if shape)
            raise ValueError(f"shapes of values do not broadcast: {shown}") from None

    def _input(self, value: Any, kind: str, grade: int) -> Any:
        if kind == "value":
            return value
        if kind == "determinant":
            return np.asarray(value.determinant)[..., np.newaxis]
        matrix = value.matrix if grade == 1 else value.bivector_matrix
        return matrix.reshape(*matrix.shape[:-2], 9)


def _batch(value: Any) -> tuple[int, ...]:
    return value.shape if isinstance(value, Multivector | LinearMap) else ()


def given(core: _native.Formula, values: Mapping[str, Any] | None, named: dict[str, Any]) -> Given:
    """Return the values by name. An unusable value is an error only if the formula uses it."""
    everything = _together(values, named)
    algebra, owner = _main_algebra(core, everything)
    everything = {**_named(algebra, everything.values()), **everything}
    known: dict[str, Any] = {}
    refused: dict[str, TypeError] = {}
    for name, value in everything.items():
        try:
            known[name] = _value(name, value, algebra, owner)
        except TypeError as error:
            refused[name] = error
    kinds = [(name, *_kind(value)) for name, value in known.items()]
    return Given(algebra, kinds, list(known.values()), refused)


def _named(algebra: Any, values: Iterable[Any]) -> dict[str, Multivector]:
    """Return the values that have names in the algebra; exact ones beside exact values."""
    named: dict[str, Multivector] = algebra._named()
    if named and any(isinstance(value, Multivector) and value.dtype == object for value in values):
        return {name: algebra.vector([Fraction(x) for x in v.components]) for name, v in named.items()}
    return named


def compiled(core: _native.Formula, known: Given) -> tuple[_native.Program, Given]:
    """Return the program for the values, and the values as it takes them."""
    try:
        program = core.program(known.algebra, known.kinds)
    except FormulaError as error:
        wanted = _native.canonical(error.text[slice(*error.span)])
        for name, reason in known.refused.items():
            if wanted is not None and _native.canonical(name) == wanted:
                raise reason from None
        # As in methods, a single value with a zero scalar part, such as e1*e2, counts as a bivector.
        known = known.narrowed()
        program = core.program(known.algebra, known.kinds)
    return program, known.with_scalars(program)


def _main_algebra(core: _native.Formula, values: dict[str, Any]) -> tuple[Any, str]:
    """Return the algebra of the first value that the text may use, or 3-d space; and whose it is."""
    if core.algebra is not None:
        return core.algebra, "the formula"
    letters = _folded("".join([core.text, *(body for _, body in core.definitions)]))
    for name, value in values.items():
        if isinstance(value, Multivector | LinearMap) and _may_have(letters, name):
            return _algebra_of(value), name
    return algebra_of(3), "the formula"


def _folded(text: str) -> set[str]:
    """Return the characters of a text, without their style (bold, italic, ...)."""
    return set(unicodedata.normalize("NFKD", text))


def _may_have(letters: set[str], name: str) -> bool:
    """Whether a text of these letters may contain a name; subscripts have several spellings."""
    return {c for c in _folded(name.partition("(")[0].partition("_")[0]) if c.isalpha()} <= letters


def narrowed(value: Any) -> Any:
    """Return a value reduced to its nonzero grades; a rotor and what is not a multivector unchanged."""
    if not isinstance(value, Multivector) or isinstance(value, Rotor):
        return value
    held = value._held()
    return value if held in (0, value._mask) else value._part(held)


def kinds_of(algebra: Any, kinds: dict[str, Any]) -> tuple[Any, list[Kind]]:
    """Return the algebra and the kinds of names, given as values or described."""
    values = {name: kind for name, kind in kinds.items() if isinstance(kind, Multivector)}
    algebra = _common_algebra(algebra, values)
    kinds = {**algebra._named(), **kinds} if kinds else kinds  # without any, names are open
    return algebra, [(name, *_described(name, kind, algebra)) for name, kind in kinds.items()]


def _described(name: str, kind: Any, algebra: Any) -> tuple[int, int]:
    if isinstance(kind, Multivector | LinearMap):
        return _kind(kind)
    if isinstance(kind, str):
        if kind not in _WORDS:
            raise ValueError(f"{name} is {kind!r}, expected grades or one of {', '.join(map(repr, _WORDS))}")
        return _WORDS[kind]
    if isinstance(kind, float | np.ndarray | np.number):
        return 0b0001, _VALUE
    mask, n = 0, algebra.dimension
    for k in kind if isinstance(kind, Iterable) else (kind,):
        try:
            grade = operator.index(k)
        except TypeError:
            raise TypeError(f"{name} is a {type(k).__name__}, expected grades, such as 1 or (0, 2)") from None
        if grade not in range(n + 1):
            raise ValueError(f"{name} has grade {grade}, but {algebra} has grades 0 to {n}")
        mask |= 1 << grade
    if not mask:
        raise ValueError(f"{name} has no grades; zero is a scalar, of grade 0")
    return mask, _VALUE


def _kind(value: Any) -> tuple[int, int]:
    if isinstance(value, LinearMap):
        return value.grade, _MAP
    if not isinstance(value, Multivector):
        return 0b0001, _VALUE
    return value._mask, _ROTOR if isinstance(value, Rotor) else _VALUE


def _together(values: Mapping[str, Any] | None, named: dict[str, Any]) -> dict[str, Any]:
    if values is None:
        return named
    if not isinstance(values, Mapping):
        raise TypeError(f"expected values as keywords or as a mapping by name, got {type(values).__name__}")
    for name in values:
        if not isinstance(name, str):
            raise TypeError(f"names of values must be strings, got {name!r}")
    twice = [name for name in values if name in named]
    if twice:
        raise TypeError(f"{twice[0]!r} is given both in the mapping and as a keyword")
    return {**values, **named}


def _algebra_of(value: Multivector | LinearMap) -> Any:
    """Return the algebra of a value."""
    return value.algebra


def _require_algebra(name: str, value: Multivector | LinearMap, algebra: Any, owner: str) -> None:
    own = _algebra_of(value)
    if own is not algebra:
        raise TypeError(f"values must be of one algebra, got {owner} of {algebra} and {name} of {own}")


def _common_algebra(algebra: Any, values: dict[str, Multivector]) -> Any:
    owner = "the formula"
    for name, value in values.items():
        if algebra is None:
            algebra, owner = _algebra_of(value), name
        _require_algebra(name, value, algebra, owner)
    return algebra_of(3) if algebra is None else algebra


def _value(name: str, value: Any, algebra: Any, owner: str) -> Any:
    if isinstance(value, Multivector | LinearMap):
        _require_algebra(name, value, algebra, owner)
        if isinstance(value, LinearMap) and algebra is not algebra_of(3):
            raise TypeError(
                f"{name} is a linear map of {algebra}; formulas call those of 3-d space: apply it first and "
                "pass its value by name"
            )
        return value
    if type(value) in (int, float):
        return value
    data = scalars(value, None)
    if data is not None:
        return Multivector._of(data, 1, algebra)
    remedy = "expected a multivector, a linear map, a number, or an array as a batch of numbers"
    if callable(value):
        remedy = "formulas call linear maps (ph.LinearMap.from_function) and functions given by `define`"
    elif isinstance(value, list | tuple):
        remedy = "wrap components with ph.vector, a batch of numbers with np.array"
    kind = f"an array of {value.dtype}" if isinstance(value, np.ndarray) else f"a {type(value).__name__}"
    raise TypeError(f"{name} is {kind}; {remedy}")
