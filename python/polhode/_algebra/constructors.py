"""Values of 3-d space: constructors, axial vectors and Pauli matrices."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.algebra import algebra
from polhode._algebra.coefficients import as_coefficients, known_floats
from polhode._algebra.grades import with_grades
from polhode._algebra.multivector import Multivector
from polhode._algebra.products import coerced
from polhode._support.arrays import Array, as_components, mapped
from polhode._support.calls import takes_components
from polhode._support.memory import require_array

_G3 = algebra(3)
_KINDS = ("scalar", "vector", "bivector", "trivector")
_ALL = 0b1111


def scalar(a: Any, *, dtype: Any = None) -> Multivector:
    """Create scalars from numbers; an array of shape S is a batch of shape S.

    Examples
    --------
    >>> ph.scalar([1, 2]) * ph.e1
    Multivector of shape (2,):
    [e1,
     2 e1]
    """
    return _G3.scalar(a, dtype=dtype)


@takes_components
def vector(xyz: Any, *, dtype: Any = None, copy: bool = True) -> Multivector:
    """Create vectors ``x e1 + y e2 + z e3`` from an array (..., 3).

    Real numbers become float64, complex ones complex128, float32 and complex64 are kept; fractions, SymPy
    expressions, integers beyond 2⁵³ and arrays of objects stay exact; arrays of JAX and other libraries keep
    their type. `dtype` converts (``np.float32``, ``float``, ``complex``, or ``object`` for exact integers).
    ``copy=False`` makes a read-only view of floats in C order.

    Examples
    --------
    >>> a = ph.vector([3, 4, 0])
    >>> a * a
    25
    >>> ph.vector([[1, 0, 0], [3, 4, 0]]).norm()
    array([1., 5.])
    """
    return _G3._wrapped(xyz, "vector", 3, 0b0010, dtype, copy)


@takes_components
def bivector(c3: Any, *, dtype: Any = None, copy: bool = True) -> Multivector:
    """Create bivectors ``x e2∧e3 + y e3∧e1 + z e1∧e2`` from an array (..., 3).

    The components are those of the axial vector, ``x e1 + y e2 + z e3``. `dtype` and `copy` as in `vector`.

    Examples
    --------
    >>> ph.bivector([0, 0, 2])
    2 e1∧e2
    >>> ph.bivector([0, 0, 2]) == (2 * ph.e1).wedge(ph.e2)
    True
    """
    return _G3._wrapped(c3, "bivector", 3, 0b0100, dtype, copy)


def trivector(b: Any, *, dtype: Any = None) -> Multivector:
    """Create trivectors ``b I`` from numbers; an array of shape S is a batch of shape S.

    Examples
    --------
    >>> ph.trivector(2)
    2 I
    >>> ph.e1 ^ ph.e2 ^ ph.e3
    I
    """
    return _G3._single(b, "trivector", 3, dtype)


@takes_components
def multivector(c8: Any, *, dtype: Any = None, copy: bool = True) -> Multivector:
    """Create multivectors from an array (..., 8) over ``1, e1, e2, e3, e2e3, e3e1, e1e2, I``.

    `dtype` and `copy` as in `vector`.

    Examples
    --------
    >>> M = ph.multivector([1, 0, 0, 3, 0, 0, 2, 0])
    >>> M
    1 + 3 e3 + 2 e1∧e2
    >>> M.grade(2)
    2 e1∧e2
    """
    return _G3._wrapped(c8, "multivector", 8, _ALL, dtype, copy)


def cross(a: Multivector, b: Multivector) -> Multivector:
    """Return the cross product ``a x b = −I a∧b`` of vectors (handout eq. 1.24); batches broadcast.

    A TypeError for values of other grades, and for arrays, which `vector` wraps.

    Examples
    --------
    The torque of a force of 10 N along e2 at an arm of 0.5 m along e1, in N m:

    >>> ph.cross(0.5 * ph.e1, 10 * ph.e2)
    5 e3
    """
    return one_grade(a, 1, "the left factor").wedge(one_grade(b, 1, "the right factor")).dual()


def axial(B: Any) -> Multivector:
    """Return the axial vectors ``B I⁻¹`` of bivectors, values or an array (..., 3).

    ``axial(e1∧e2) = e3``, ``axial(a∧b) = a x b`` (handout eq. 1.20, 1.24). The components are the same.

    Examples
    --------
    >>> ph.axial(ph.e1 ^ ph.e2)
    e3
    >>> ph.axial([1, 2, 3]) == ph.vector([1, 2, 3])
    True
    """
    return one_grade(B, 2, "the plane").dual() if isinstance(B, Multivector) else vector(B)


def from_axial(v: Any) -> Multivector:
    """Return the bivectors ``I v`` of axial vectors, values or an array (..., 3).

    The plane perpendicular to v, in its right-handed sense, as ``Ω = I ω`` (handout eq. 4.4).

    Examples
    --------
    The angular velocity ω = 2 e3, and the velocity ``x·Ω`` that it gives to the point x = e1:

    >>> Omega = ph.from_axial([0, 0, 2])
    >>> Omega
    2 e1∧e2
    >>> ph.e1 | Omega
    2 e2
    """
    return one_grade(v, 1, "the axial vector").undual() if isinstance(v, Multivector) else bivector(v)


def split(x: Multivector, blade: Multivector) -> tuple[Multivector, Multivector]:
    """Return the parts of x in the subspace of `blade` and perpendicular to it: a∥ and a⊥ of eq. 1.7.

    ``(x.project(blade), x.reject(blade))``; they add up to x, but for rounding.

    Examples
    --------
    >>> parallel, perpendicular = ph.split(ph.vector([1, 2, 3]), ph.e1 ^ ph.e2)
    >>> parallel, perpendicular
    (e1 + 2 e2, 3 e3)
    """
    if not isinstance(x, Multivector):
        raise TypeError(f"split needs a multivector, got {type(x).__name__}; wrap arrays with ph.vector")
    parallel = x.project(blade)
    return parallel, x - parallel


def to_pauli(M: Any) -> np.ndarray[Any, np.dtype[np.complex128]]:
    """Return the 2×2 complex matrices of M: ``e_k ↦ σ_k``, ``I ↦ i``; shape (..., 2, 2).

    M has real coefficients: with complex ones, I and i would have the same matrix.

    Examples
    --------
    >>> ph.to_pauli(ph.e2)
    array([[0.+0.j, 0.-1.j],
           [0.+1.j, 0.+0.j]])
    """
    value = coerced(M)
    if value is None:
        raise TypeError(f"to_pauli needs a multivector, got {type(M).__name__}")
    eight = _of_3d(value, "to_pauli")._with_grades(_ALL)
    numbers: Array = mapped(_native.to_pauli, as_coefficients(np.asarray(eight), "a component", float))
    return numbers.reshape(*value.shape, 2, 2, 2).view(np.complex128)[..., 0]


def from_pauli(matrices: Any) -> Multivector:
    """Return the multivectors of 2×2 complex matrices, shape (..., 2, 2); the inverse of `to_pauli`.

    Examples
    --------
    >>> ph.from_pauli([[0, 1], [1, 0]])
    e1
    >>> ph.from_pauli(ph.to_pauli(ph.e1) @ ph.to_pauli(ph.e2))
    e1∧e2
    """
    p = np.asarray(matrices)
    if p.dtype.kind not in "iufc" or p.shape[-2:] != (2, 2):
        raise ValueError(f"from_pauli needs numeric matrices of shape (..., 2, 2), got {p.dtype} {p.shape}")
    require_array(p.shape, "the matrices", 16)
    numbers = np.ascontiguousarray(p, dtype=np.complex128).view(np.float64).reshape(*p.shape[:-2], 8)
    return Multivector._of(_native.from_pauli(numbers), _ALL)


def one_grade(value: Any, grade: int, what: str) -> Multivector:
    """Return a value of 3-d space with a single grade; the others must be absent or exactly zero."""
    if not isinstance(value, Multivector):
        raise TypeError(
            f"{what} must be a {_KINDS[grade]}, got {type(value).__name__}; use ph.{_KINDS[grade]}"
        )
    _of_3d(value, what)
    if value._mask == 1 << grade:
        return value
    if value._held() & ~(1 << grade):
        duals = {1: "; write B.dual()", 2: "; write a.undual()"}
        remedy = duals.get(grade, "") if value.grades == (3 - grade,) else ""
        raise TypeError(f"{what} must be a {_KINDS[grade]}, got {value!r}, which has other grades{remedy}")
    return Multivector._of(with_grades(value, 1 << grade), 1 << grade)


def pure(value: Any, grade: int, what: str) -> Array:
    """Return the components of a value of one grade, as NumPy's float64."""
    return known_floats(one_grade(value, grade, what)._data, what)


def _of_3d(value: Multivector, what: str) -> Multivector:
    if value.algebra is not _G3:
        raise TypeError(f"{what} must be a value of 3-d space, got one of {value.algebra}")
    return value


def as_vectors(values: Any, what: str) -> Array:
    """Return components (..., 3) from an array or a vector."""
    return pure(values, 1, what) if isinstance(values, Multivector) else as_components(values, 3, what)


def as_points(values: Any, what: str) -> Array:
    """Return components (..., 3) from a vector, an array, or 0."""
    if is_zero(values):
        return np.zeros(3)
    return as_vectors(values, what)


def is_zero(value: Any) -> bool:
    """Whether a value is the single number 0, which stands for the vector 0."""
    others = isinstance(value, Multivector | list | tuple)
    return not others and np.ndim(value) == 0 and bool(np.all(value == 0))


def as_point(value: Any, what: str) -> Array:
    """Return the components (3,) of a single finite vector, from a vector, an array, or 0."""
    components = as_points(value, what)
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


_native.register("as_vectors", as_vectors)
_native.register("as_bivectors", as_bivectors)
