"""Values from numbers, and numbers from values: the constructors of the algebra, and its Pauli matrices."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode import _native
from polhode._arrays import Array, as_components, as_floats
from polhode._multivector import (
    _ALL,
    _BIVECTOR,
    _TRIVECTOR,
    _VECTOR,
    Multivector,
    _coerced,
)

_KINDS = ("scalar", "vector", "bivector", "trivector")


def vector(xyz: Any) -> Multivector:
    """Vectors ``x e1 + y e2 + z e3`` from an array (..., 3)."""
    return Multivector._of(as_components(xyz, 3, "vector"), _VECTOR)


def bivector(c3: Any) -> Multivector:
    """Bivectors ``x e2∧e3 + y e3∧e1 + z e1∧e2`` from an array (..., 3): components of the axial vector."""
    return Multivector._of(as_components(c3, 3, "bivector"), _BIVECTOR)


def trivector(b: Any) -> Multivector:
    """Trivectors ``b I`` from numbers; an array of shape S is a batch of shape S."""
    return Multivector._of(np.array(as_floats(b, "trivector"))[..., np.newaxis], _TRIVECTOR)


def multivector(c8: Any) -> Multivector:
    """Multivectors from an array (..., 8) over ``1, e1, e2, e3, e2e3, e3e1, e1e2, I``."""
    return Multivector._of(as_components(c8, 8, "multivector"), _ALL)


def cross(a: Multivector, b: Multivector) -> Multivector:
    """Vector cross product ``a x b = −I a∧b`` (handout eq. 1.24)."""
    left, right = vector(pure(a, 1, "the left factor")), vector(pure(b, 1, "the right factor"))
    return left.wedge(right).dual()


def to_pauli(M: Any) -> np.ndarray[Any, np.dtype[np.complex128]]:
    """Return the 2×2 complex matrices of M: ``e_k ↦ σ_k``, ``I ↦ i``; shape (..., 2, 2)."""
    value = _coerced(M)
    if value is None:
        raise TypeError(f"to_pauli needs a multivector, got {type(M).__name__}")
    numbers = _native.to_pauli(value._with_grades(_ALL))
    return numbers.reshape(*value.shape, 2, 2, 2).view(np.complex128)[..., 0]


def from_pauli(matrices: Any) -> Multivector:
    """Return the multivectors of 2×2 complex matrices, shape (..., 2, 2); the inverse of `to_pauli`."""
    p = np.asarray(matrices)
    if p.dtype.kind not in "iufc" or p.shape[-2:] != (2, 2):
        raise ValueError(f"from_pauli needs numeric matrices of shape (..., 2, 2), got {p.dtype} {p.shape}")
    numbers = np.ascontiguousarray(p, dtype=np.complex128).view(np.float64).reshape(*p.shape[:-2], 8)
    return Multivector._of(_native.from_pauli(numbers), _ALL)


def pure(value: Any, grade: int, what: str) -> Array:
    """Return the components of a value of one grade; the others must be absent or exactly zero."""
    if not isinstance(value, Multivector):
        raise TypeError(
            f"{what} must be a {_KINDS[grade]}, got {type(value).__name__}; see ph.{_KINDS[grade]}"
        )
    if value._held() & ~(1 << grade):
        raise TypeError(f"{what} must be a {_KINDS[grade]}, got {value!r}, which holds other grades")
    return value._data if value._mask == 1 << grade else value._with_grades(1 << grade)


def as_vectors(values: Any, what: str) -> Array:
    """Return components (..., 3) from an array or a vector."""
    return pure(values, 1, what) if isinstance(values, Multivector) else as_components(values, 3, what)


def as_point(value: Any, what: str) -> Array:
    """Return the components (3,) of a single finite vector, from a vector, an array, or 0."""
    if not isinstance(value, Multivector) and np.ndim(value) == 0 and np.all(value == 0):
        return np.zeros(3)
    components = as_vectors(value, what)
    if components.shape != (3,):
        raise ValueError(f"{what} must be a single vector, got shape {components.shape}")
    if not np.isfinite(components).all():
        raise ValueError(f"{what} is {components.tolist()}; it must be finite")
    return components


def as_bivectors(values: Any, what: str) -> Array:
    """Return components (..., 3) over (e2e3, e3e1, e1e2) from an array or a bivector."""
    return pure(values, 2, what) if isinstance(values, Multivector) else as_components(values, 3, what)


e1 = vector([1.0, 0.0, 0.0])
e2 = vector([0.0, 1.0, 0.0])
e3 = vector([0.0, 0.0, 1.0])
I = trivector(1.0)  # noqa: E741  # the handout's name
