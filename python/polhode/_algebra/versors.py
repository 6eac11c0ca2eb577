"""Action of versors, products of vectors that have an inverse, on values."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _generic, _native
from polhode._algebra.coefficients import kind_of
from polhode._algebra.foreign_values import has_reflected
from polhode._algebra.products import aligned, common_algebra
from polhode._support.arrays import at_index, first_index, is_float, new, power_of_two

if TYPE_CHECKING:
    from polhode._algebra.multivector import Multivector

_EVEN, _ODD = 0b101010101, 0b010101010
_REMEDY = "only rotors and versors, products of invertible vectors, act on values; for a product write A * X"


def act(V: Multivector, X: Multivector | None = None) -> Multivector:
    """``V X V⁻¹`` for a versor V, a product of vectors: ``(b*a)(x)`` turns by twice the angle from a to b.

    Of an odd number of vectors ``V X̂ V⁻¹``, with X̂ the grade involution, as in `reflect`. V has any length,
    batches broadcast. A TypeError for a V that is not a versor to half of its digits.
    """
    single = _native.versor_action(V, X)
    if single is not None:
        return single
    if X is None:
        raise TypeError(
            "V(X) moves the multivector X by the versor V, got no X; the numbers of V are V.components"
        )
    if not isinstance(X, _native.Multivector):
        raise TypeError(
            f"a versor acts on multivectors, got {type(X).__name__}; wrap arrays with ph.vector, for a "
            "product with numbers write *, for the part of grade k .grade(k)"
        )
    common_algebra(V, X)
    mixed = V._mask & _EVEN and V._mask & _ODD
    held = V._held() if mixed else V._mask
    if held & _EVEN and held & _ODD:
        raise TypeError(f"a value with the even and odd grades {V.grades} is not a versor; {_REMEDY}")
    if mixed:
        V = V._part(V._mask & (_ODD if held & _ODD else _EVEN))
    if is_float(V._data) and is_float(X._data):
        batch, v, x = aligned(V._data, X._data)
        moved = new((*batch, x.shape[-1]), v.dtype)
        if _native.versor_apply(V.algebra, v, V._mask, bool(held & _ODD), x, X._mask, moved):
            return X._like(moved)
    if is_float(V._data):
        V = _of_moderate_size(V)
    reverse = ~V
    square = V * reverse
    _require_number(square, V)
    if V.algebra.dimension > 5:  # below, V ~V is a number for versors only
        _require_vectors(V, reverse)
    mirrored = X.grade_involution() if held & _ODD else X
    turned: Multivector = V * mirrored * (reverse / square.grade(0))
    return X._like(turned._with_grades(X._mask))


def sandwich(V: Multivector, X: Multivector) -> Multivector:
    """``V >> X``, the action ``V(X)`` of a rotor or a versor. It binds looser than ``+`` and ``*``."""
    if not isinstance(X, _native.Multivector):
        return NotImplemented
    return V(X)


def unshifted(A: Multivector, B: Any) -> Any:
    """Raise the TypeError for ``A << B``, which other libraries have for different products."""
    if has_reflected(B, "__rlshift__"):
        return NotImplemented
    raise TypeError(
        "<< is not an operator of multivectors; write A.left_contraction(B), as in clifford, or "
        "A.anticommutator(B), as in galgebra"
    )


def _of_moderate_size(V: Multivector) -> Multivector:
    """Return floats divided by powers of two where the squares of components would over- or underflow."""
    scale, limits = power_of_two(V._data, -1), np.finfo(V._data.dtype)
    extreme = (scale < limits.tiny**0.4) | (scale > limits.max**0.4)
    return V._like(V._data / np.where(extreme, scale, np.ones_like(scale))) if extreme.any() else V


def _require_number(square: Multivector, V: Multivector) -> None:
    """Raise a TypeError unless ``V ~V`` is a number other than 0."""
    scalar, rest = square.grade(0)._data[..., 0], square - square.grade(0)
    ok = small(rest._data, V) & ~small(scalar[..., None], V, digits=0.9)
    if _fails(ok):
        index = first_index(~np.asarray(ok))
        raise TypeError(
            f"V ~V must be a number other than 0{at_index(index)}, got {square[index]}; {_REMEDY}"
        )


def _require_vectors(V: Multivector, reverse: Multivector) -> None:
    """Raise a TypeError unless ``V a ~V`` is a vector for each basis vector a."""
    for a in V.algebra.basis_vectors:
        image = V * a * reverse
        if _fails(small((image - image.grade(1))._data, V)):
            raise TypeError(f"V ~V is a number, but V a ~V is not a vector for a = {a}; {_REMEDY}")


def _fails(ok: Any) -> bool:
    """Whether a condition is known to fail for some value; not while values are traced."""
    concrete = isinstance(ok, np.ndarray | np.bool_) or kind_of(ok * 1.0).is_concrete(ok)
    return concrete and not bool(np.all(np.asarray(ok)))


def small(data: Any, V: Multivector, digits: float = 0.5) -> Any:
    """Whether components are 0 to this part of the digits, beside the squares of those of V."""
    kind = kind_of(data, V._data)
    if kind.exact:
        bounds = np.empty((*V._data.shape[:-1], 1), dtype=object)
        for index in np.ndindex(bounds.shape[:-1]):
            bounds[index] = _generic.exact.rounding(V._data[index], digits)
        return np.frompyfunc(_generic.exact.is_rounding, 2, 1)(data, bounds).astype(bool).all(axis=-1)
    with np.errstate(over="ignore"):
        eps = float(np.finfo(V._data.dtype).eps) if is_float(V._data) else kind.eps
        bound = eps**digits * kind.xp.sum(kind.squared(V._data), axis=-1)
    return kind.xp.all(kind.xp.abs(data) <= bound[..., None], axis=-1)
