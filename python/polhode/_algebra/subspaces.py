"""Blades as subspaces: complements, join and meet, projections and reflections."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _native
from polhode._algebra.coefficients import taken
from polhode._algebra.grades import over_grades, with_signs
from polhode._algebra.products import coerced, common_algebra, product
from polhode._support.arrays import common_batch, is_float, power_of_two

if TYPE_CHECKING:
    from polhode._algebra.multivector import Multivector


def right_complement(value: Multivector) -> Multivector:
    """Return the rest of the space: linear, ``E ∧ rc(E) = I`` for basis elements E.

    Needs no metric, so it also exists where I has no inverse.

    Examples
    --------
    >>> ph.e1.right_complement()
    e2∧e3
    >>> ph.e1 ^ ph.e1.right_complement()
    I
    """
    return _complement(value, right=True)


def left_complement(value: Multivector) -> Multivector:
    """Return the inverse of `right_complement`: ``lc(E) ∧ E = I`` for basis elements E.

    Examples
    --------
    >>> (ph.e1 ^ ph.e2).right_complement().left_complement()
    e1∧e2
    """
    return _complement(value, right=False)


def _complement(value: Multivector, right: bool) -> Multivector:
    """Permute the components, with signs."""
    algebra = value.algebra
    mask, places, signs = algebra._complement(value._mask, right)
    return value._of(with_signs(taken(value._data, places), signs), mask, algebra)


def vee(left: Multivector, other: Any) -> Multivector:
    """Return ``A∨B``, the regressive product: the wedge of complements, ``rc(A∨B) = rc(A) ∧ rc(B)``.

    Of grade r + s − n: the intersection of two blades that span the whole space.

    Examples
    --------
    Two planes meet in a line:

    >>> (ph.e1 ^ ph.e2).vee(ph.e2 ^ ph.e3)
    e2
    """
    right = coerced(other, left)
    if right is None:
        raise TypeError(f"vee needs a multivector, a number or an array, got {type(other).__name__}")
    return product("vee", left, right)


def regressive(left: Multivector, right: Any) -> Multivector:
    """``A & B``, the regressive product `vee`; Python binds ``&`` looser than ``+`` and ``*``."""
    return NotImplemented if coerced(right, left) is None else vee(left, right)


def regressive_from(right: Multivector, left: Any) -> Multivector:
    """``A & B`` for a number or an array A."""
    number = coerced(left, right)
    return NotImplemented if number is None else vee(number, right)


def join(value: Multivector, other: Multivector) -> Multivector:
    """Return the unit blade of the smallest subspace that contains both blades.

    Directions within 1e-10 (in single precision 3e-5) of a subspace count as lying in it. Components are
    compared as lengths, the basis vectors as orthonormal, in any metric. For the sign see `meet`. A
    ValueError for a value that is not a blade.

    Examples
    --------
    >>> ph.e1.join(ph.e1 + 2 * ph.e2)
    e1∧e2
    """
    return _join_or_meet(value, other, "join")


def meet(value: Multivector, other: Multivector) -> Multivector:
    """Return the unit blade of the intersection of both blades; the scalar 1 where it is {0}.

    Join J and meet M are oriented together: with ``A = A'∧M`` and ``B = M∧B'``, ``J = A'∧M∧B'``. The
    signs are:

    - if A and B have only 0 in common: ``M = 1``, and J has the sign of ``A∧B``;
    - if A contains B: ``J = A``, ``M = B``, divided by their norms; if only B contains A, the reverse;
    - otherwise the first of the largest components of J is positive. So if the two span the whole space,
      ``J = I``, and M has the sign of ``A∨B``; in the first two cases it may not.

    Tolerance as for `join`.

    Examples
    --------
    >>> (ph.e1 ^ ph.e2).meet(ph.e2 ^ ph.e3)
    e2
    """
    return _join_or_meet(value, other, "meet")


def _join_or_meet(left: Multivector, right: Multivector, name: str) -> Multivector:
    if not isinstance(right, _native.Multivector):
        raise TypeError(f"{name} needs blades, got {type(right).__name__}")
    algebra = common_algebra(left, right)
    if not (is_float(left._data) and is_float(right._data)):
        raise TypeError(
            f"{name} needs NumPy floats, got {left.dtype} and {right.dtype}; convert exact numbers with "
            ".astype(float), other arrays with np.asarray(A.components)"
        )
    batch = common_batch(left.shape, right.shape)
    everything = algebra._all
    a, b = (
        np.ascontiguousarray(
            np.broadcast_to(over_grades(value, everything), (*batch, algebra.size)), dtype=np.float64
        )
        for value in (left, right)
    )
    dtype = np.result_type(left._data, right._data)
    single = np.float32 in (left._data.dtype, right._data.dtype)
    result = left._of(_native.subspaces(algebra, name, a, b, single), everything, algebra)
    return result._part(result._held() or 1).astype(dtype)


def project(value: Multivector, blade: Multivector) -> Multivector:
    """Return the part in the subspace of `blade`: ``(A⌋B) B⁻¹``, over the grades of A (a∥ of eq. 1.7).

    Examples
    --------
    >>> ph.vector([1, 2, 3]).project(ph.e1 ^ ph.e2)
    e1 + 2 e2
    """
    one_grade = isinstance(blade, _native.Multivector) and (
        blade._mask.bit_count() == 1 or blade._held().bit_count() <= 1
    )
    if not one_grade:
        raise TypeError(f"the subspace must be a value of one grade, such as e1 or e1^e2, got {blade!r}")
    unit = blade.normalized() if is_float(blade._data) else blade  # so that nothing overflows
    return (value.left_contraction(unit) * unit.inverse())._part(value._mask)


def reject(value: Multivector, blade: Multivector) -> Multivector:
    """Return the part perpendicular to the subspace of `blade`: A minus its projection.

    Examples
    --------
    >>> ph.vector([1, 2, 3]).reject(ph.e1 ^ ph.e2)
    3 e3
    """
    return value - value.project(blade)


def reflect(value: Multivector, n: Multivector) -> Multivector:
    """Return the reflection in the plane perpendicular to the vector n: ``−n a n⁻¹`` for a vector a.

    ``n X̂ n⁻¹`` for any X, with X̂ its grade involution, so that reflections respect ``∧``: scalars stay, I
    changes sign. The plane of a bivector B has the normal ``B.dual()``.

    Examples
    --------
    >>> ph.vector([1, 2, 3]).reflect(ph.e3)
    e1 + 2 e2 - 3 e3
    """
    if not isinstance(n, _native.Multivector) or any(np.any(n.grade(k) != 0) for k in n.grades if k != 1):
        raise TypeError(f"a mirror is given by its normal, a vector; for a plane B use B.dual(); got {n!r}")
    normal = n.grade(1)
    if is_float(normal._data):  # so that nothing overflows
        normal = normal._like(normal._data / power_of_two(normal._data, -1))
    # n⁻¹∧(n⌋X) is the part of X that contains n, and the one that changes sign.
    mirrored = value - 2 * normal.inverse().wedge(normal.left_contraction(value))
    first, *others = [mirrored.grade(k) for k in value.grades]
    return sum(others, start=first)
