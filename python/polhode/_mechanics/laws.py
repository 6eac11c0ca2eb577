"""Arguments of laws and events: checks, formulas, and text."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

from polhode._algebra.coefficients import known_floats
from polhode._algebra.linear_map import LinearMap
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._formula.arguments import narrowed
from polhode._formula.errors import FormulaError, check_encoding
from polhode._mechanics.parameters import check_finite
from polhode._support.arrays import as_float, as_floats

T = TypeVar("T")


def finite(value: float, name: str) -> float:
    if not np.isfinite(value):
        raise ValueError(f"{name} is {value}; it must be finite")
    return value


def number(value: Any, name: str) -> float:
    return finite(as_float(value, name), name)


def one_of(words: Sequence[str], value: str, name: str) -> str:
    """Return a value that is one of these words; a ValueError for others."""
    if value not in words:
        raise ValueError(f"{name} must be {' or '.join(map(repr, words))}, got {value!r}")
    return value


def formula_value(value: Any, name: str, batches: bool = False) -> Any:
    """Return a value for a formula: a finite multivector over float64, a linear map or a number.

    Multivectors are single ones unless `batches` are taken. Values and maps are of 3-d space.
    """
    if isinstance(value, Multivector | LinearMap) and value.algebra.signature != (3, 0, 0):
        kind = "linear map" if isinstance(value, LinearMap) else "value"
        raise TypeError(
            f"{name} is a {kind} of {value.algebra}; the formulas of laws take those of 3-d space"
        )
    if isinstance(value, LinearMap):
        return value
    if not isinstance(value, Multivector):
        one = as_floats(value, name)
        if one.ndim:
            raise TypeError(
                f"{name} is an array of shape {one.shape}; wrap components with ph.vector or ph.bivector"
                f"{', a batch of numbers with ph.scalar' if batches else ''}"
            )
        return finite(float(one), name)
    if value.shape and not batches:
        raise ValueError(f"{name} must be a single value, got batch shape {value.shape}")
    data = known_floats(value._data, name)
    if value.shape:
        check_finite(data, name)
    elif not np.isfinite(data).all():
        raise ValueError(f"{name} is {value}; it must be finite")
    return Rotor._from_rows(data) if isinstance(value, Rotor) else Multivector._of(data, value._mask)


def law_of_formula(
    make: Callable[[tuple[tuple[str, Any], ...]], T],
    text: str,
    values: dict[str, Any],
    batches: bool = False,
) -> T:
    """Return the law that `make` returns for checked values of the names; these may be `batches`."""
    if not isinstance(text, str):
        raise TypeError(f"a formula must be a string, got {type(text).__name__}")
    check_encoding(text)
    given = {name: formula_value(value, name, batches) for name, value in values.items()}
    try:
        return make(tuple(given.items()))
    except FormulaError:
        # As in formulas elsewhere, a single value without a scalar part, such as e1*e2, counts as a bivector.
        given = {name: narrowed(value) for name, value in given.items()}
    return make(tuple(given.items()))


def function_of(f: Any, *arguments: str) -> Any:
    """Return a function that takes these arguments by place; a TypeError for others."""
    names = f"{', '.join(arguments[:-1])} and {arguments[-1]}"
    if not callable(f) or isinstance(f, Multivector):
        raise TypeError(f"expected a function of {names}, got {type(f).__name__}")
    try:
        inspect.signature(f).bind(*arguments)
    except TypeError:
        label = getattr(f, "__name__", type(f).__name__)
        raise TypeError(f"the function is called with {names}, which {label} does not take") from None
    except ValueError:  # a compiled function without a signature
        pass
    return f


def shown(name: str, arguments: Iterable[Any], named: Mapping[str, Any], form: str = "") -> str:
    """Return the call of a constructor as text, its numbers in a format."""
    texts = [_text(x, form) for x in arguments] + [f"{key}={_text(x, form)}" for key, x in named.items()]
    return f"{name}({', '.join(texts)})"


def _text(x: Any, form: str) -> str:
    if isinstance(x, tuple):
        return "[" + ", ".join(_text(one, form) for one in x) + "]"
    if isinstance(x, str):
        return repr(x)
    if isinstance(x, float):
        return format(x, form)
    # A function by its name; a map by what it does.
    return str(x) if isinstance(x, LinearMap) else str(getattr(x, "__name__", x))
