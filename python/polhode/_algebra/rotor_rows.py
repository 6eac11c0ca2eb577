"""Rows of components of rotors and their parameters, and functions of them."""

from __future__ import annotations

from typing import Any

from polhode import _generic, _native
from polhode._algebra.coefficients import as_coefficients, kind_of
from polhode._algebra.constructors import one_grade
from polhode._algebra.multivector import Multivector
from polhode._support.arrays import is_complex, is_float, joined, mapped, require_components


def components(values: Any, size: int, what: str) -> Any:
    data = as_coefficients(values, what)
    require_components(data.shape, size, what)
    return data


def triples(value: Any, grade: int, what: str) -> Any:
    """Return the components (..., 3) of a value of this grade, or of an array or list of them."""
    return (
        one_grade(value, grade, what)._data if isinstance(value, Multivector) else components(value, 3, what)
    )


def computed(name: str, *operands: Any) -> Any:
    """Apply a function of rotors; batches broadcast. In the compiled core for floats, else generic."""
    if all(map(is_float, operands)):
        return mapped(getattr(_native, f"rotor_{name}"), joined(*operands))
    if any(map(is_complex, operands)):
        raise TypeError(
            "rotors have real coefficients, got complex ones; take .real, or exp of a multivector"
        )
    kind = kind_of(*operands)
    return getattr(_generic.rotors, name)(kind, *map(kind.asarray, operands))
