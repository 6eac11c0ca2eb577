"""Complex conjugates, real and imaginary parts of coefficients."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from polhode import _generic
from polhode._algebra.coefficients import duplicate, kind_of
from polhode._support.arrays import is_complex

if TYPE_CHECKING:
    from polhode._algebra.multivector import Multivector

V = TypeVar("V", bound="Multivector")


def conj(value: V) -> V:
    """Return the value with complex conjugate coefficients; the basis elements stay.

    It is neither the reverse nor `clifford_conjugate`. The Hermitian conjugate of 3-d space is ``~A.conj()``.

    Examples
    --------
    >>> ((1 + 2j) * ph.e1).conj()
    (1-2j) e1
    """
    return _mapped(value, np.conj, lambda x: x.conjugate(), lambda x: x)


def real(value: V) -> V:
    """The value with the real parts of the coefficients.

    Examples
    --------
    >>> ((1 + 2j) * ph.e1).real
    e1
    """
    return _mapped(value, np.real, lambda x: _part("re", x), lambda x: x)


def imag(value: Multivector) -> Multivector:
    """The value with the imaginary parts of the coefficients, 0 for real ones.

    Examples
    --------
    >>> ((1 + 2j) * ph.e1).imag
    2 e1
    """
    plain = value.grade(*value.grades)  # not a rotor
    return _mapped(plain, np.imag, lambda x: _part("im", x), lambda x: kind_of(x).zeros_like(x))


def _mapped(
    value: V, of_complex: Callable[..., Any], of_object: Callable[..., Any], of_real: Callable[..., Any]
) -> V:
    data = value._data
    if is_complex(data):
        return value._like(duplicate(of_complex(data)))
    if isinstance(data, np.ndarray) and data.dtype == object:
        return value._like(np.asarray(np.frompyfunc(of_object, 1, 1)(data), dtype=object))
    changed = of_real(data)
    return value if changed is data else value._like(changed)


def _part(name: str, x: Any) -> Any:
    """Return the real or imaginary part, "re" or "im", of a number or an expression."""
    if _generic.exact.is_symbolic(x):
        return getattr(sys.modules["sympy"], name)(x)
    return x if name == "re" else 0
