"""Parts along and across, mirrors, axial vectors, and how far attitudes are apart."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._algebra.coefficients import kind_of
from polhode._algebra.constructors import bivector, one_grade, vector
from polhode._algebra.multivector import Multivector

if TYPE_CHECKING:
    from polhode._algebra.rotor import Rotor


def split(x: Multivector, blade: Multivector) -> tuple[Multivector, Multivector]:
    """Return the parts of x in the subspace of `blade` and perpendicular to it: a∥ and a⊥ of eq. 1.7.

    ``(x.project(blade), x.reject(blade))``; the two add to x, to its rounding.
    """
    if not isinstance(x, Multivector):
        raise TypeError(f"split needs a multivector, got {type(x).__name__}; wrap arrays with ph.vector")
    parallel = x.project(blade)
    return parallel, x - parallel


def reflected(X: Multivector, n: Multivector) -> Multivector:
    """Return X in the mirror perpendicular to n; the body of `Multivector.reflect`.

    ``n⁻¹∧(n⌋X)`` is the part of X that contains n, and the one that changes sign.
    """
    if not isinstance(n, Multivector) or any(np.any(n.grade(k) != 0) for k in n.grades if k != 1):
        raise TypeError(f"a mirror is given by its normal, a vector; of a plane B it is B.dual(); got {n!r}")
    normal = n.grade(1)
    mirrored = X - 2 * normal.inverse().wedge(normal.left_contraction(X))
    first, *others = [mirrored.grade(k) for k in X.grades]
    return sum(others, start=first)


def axial(B: Any) -> Multivector:
    """Return the axial vectors ``B I⁻¹`` of bivectors, which are values or an array (..., 3).

    ``axial(e1∧e2) = e3``, ``axial(a∧b) = a x b`` (handout eq. 1.20, 1.24). The components are the same.
    """
    return one_grade(B, 2, "the plane").dual() if isinstance(B, Multivector) else vector(B)


def from_axial(v: Any) -> Multivector:
    """Return the bivectors ``I v`` of axial vectors, which are values or an array (..., 3).

    The plane perpendicular to v, in its right-handed sense, as ``Ω = I ω`` (handout eq. 4.4).
    """
    return one_grade(v, 1, "the axial vector").undual() if isinstance(v, Multivector) else bivector(v)


def distance(R: Rotor, S: Rotor) -> Any:
    """Return the angle in [0, π] of the turn from one attitude to the other; the body of `Rotor.distance`.

    Half of it has cosine and sine ``|⟨~R S⟩|`` and ``|⟨~R S⟩₂|``. The latter is also ``|⟨~R (S ∓ R)⟩₂|``,
    since ``~R R`` is a scalar; and between close attitudes that difference has no rounding.
    """
    if not isinstance(S, type(R)):
        raise TypeError(f"distance goes between rotors, got {type(S).__name__}")
    kind = kind_of(R._data, S._data)
    if not (kind.native or kind.exact):  # arrays of another library stay theirs, with their derivatives
        return _foreign_distance(kind, R, S)
    one, other = R.astype(float), S.astype(float)
    cosine = (~one).scalar_product(other).components[..., 0]
    nearer = other * np.where(cosine < 0, -1.0, 1.0)
    sine = (~one * (nearer - one)).grade(2).norm()
    return (2 * np.arctan2(sine, np.abs(cosine)))[()]


def _foreign_distance(kind: Any, R: Rotor, S: Rotor) -> Any:
    cosine = (~R).scalar_product(S).components[..., 0]
    nearer = S * kind.where(cosine < 0, kind.zeros_like(cosine) - 1.0, 1.0)
    sine = (~R * (nearer - R)).grade(2).norm()
    return 2.0 * kind.atan2(sine, abs(cosine))
