"""Blades as subspaces: complements, the regressive product, join and meet."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _native
from polhode._algebra.coefficients import taken
from polhode._algebra.grades import over_grades, with_signs
from polhode._algebra.products import coerced, common_algebra
from polhode._support.arrays import common_batch, is_float

if TYPE_CHECKING:
    from polhode._algebra.multivector import Multivector


def complement(value: Multivector, right: bool) -> Multivector:
    """Return the right or left complement: a permutation of the components, with signs."""
    algebra, n = value.algebra, value.algebra.dimension
    mask = sum(1 << n - k for k in value.grades)
    images = algebra._complement(right)
    source = {images[i][0]: (place, images[i][1]) for place, i in enumerate(algebra._indices(value._mask))}
    places, signs = zip(*(source[i] for i in algebra._indices(mask)), strict=True)
    return value._of(with_signs(taken(value._data, list(places)), signs), mask, algebra)


def regressive(left: Multivector, other: Any) -> Multivector:
    """``A∨B``."""
    right = coerced(other, left)
    if right is None:
        raise TypeError(f"vee needs a multivector, a number or an array, got {type(other).__name__}")
    return left.right_complement().wedge(right.right_complement()).left_complement()


def joined(left: Multivector, right: Multivector, name: str) -> Multivector:
    """Return the join or the meet of blades of one grade each."""
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
