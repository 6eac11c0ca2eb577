"""Factors of blades, and reciprocal frames."""

from __future__ import annotations

import functools
import operator
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _generic, _native
from polhode._algebra.blade_names import generators_of
from polhode._algebra.coefficients import kind_of
from polhode._algebra.masking import Errors, masked
from polhode._algebra.products import common_algebra
from polhode._support.arrays import Array, at_index, first_index, is_float, power_of_two
from polhode._support.calls import explains_calls

if TYPE_CHECKING:
    from polhode._algebra.multivector import Multivector

# Relative size of what may be rounding in a blade computed from others; in single precision its root.
_ROUNDING = 1e-10


def factor(blade: Multivector, *, errors: Errors = "raise") -> tuple[Multivector, ...]:
    """Return k orthogonal vectors whose product is this blade of grade k >= 1, ``B = a1 a2 … ak``.

    The first has the size and sign of B; the others have components with ``Σ c² = 1``, in any metric. In a
    Euclidean metric they are projections of the basis vectors of the largest component of B, made orthogonal
    in this order: of ``3 e1∧e2`` they are ``3 e1`` and ``e2``. Batches give batches. A ValueError, with the
    batch index, for zero and for a value that is not a blade, such as ``e1∧e2 + e3∧e4``; with
    ``errors="mask"`` NaN there.

    Examples
    --------
    >>> B = ph.vector([1, 2, 3]) ^ ph.vector([4, 5, 6])
    >>> a, b = B.factor()
    >>> bool((a * b).is_close(B))
    True
    """
    data, algebra = blade._data, blade.algebra
    held = blade._held() or blade._mask
    if held.bit_count() != 1 or held == 1:
        raise ValueError(f"factor needs a blade of one grade >= 1, got a value of the grades {blade.grades}")
    if not is_float(data):
        raise TypeError(
            f"factor needs NumPy floats, got {blade.dtype}; convert exact numbers with .astype(float), other "
            "arrays with np.asarray(A.components)"
        )
    k = held.bit_length() - 1
    if errors != "raise":
        return masked(errors, factor, (blade.grade(k), 1))
    part = blade.grade(k).astype(float)
    rows: Array = np.asarray(part)
    size = np.abs(rows).max(axis=-1, keepdims=True, initial=0)
    _require(np.isfinite(size[..., 0]) & (size[..., 0] > 0), "is zero or not finite; a blade is neither")
    rows = rows / size
    axes = _orthogonal(_spanned(rows, part, k), np.array(algebra._squares(), dtype=float))
    factors = [algebra.vector(axes[..., i]) for i in range(k)]
    product = functools.reduce(operator.xor, factors)
    unit = np.asarray(product)
    scale = (rows * unit).sum(axis=-1, keepdims=True)
    tolerance = _ROUNDING if data.dtype == np.float64 else _ROUNDING**0.5
    near = np.abs(rows - scale * unit).max(axis=-1) <= tolerance
    _require(near, "is not a blade, the wedge of vectors; a sum of blades has no factors")
    factors[0] = algebra.vector(axes[..., 0] * scale * size)
    return tuple(one.astype(data.dtype) for one in factors)


def _require(ok: Any, what: str) -> None:
    if not np.all(ok):
        raise ValueError(f"the value{at_index(first_index(~np.asarray(ok)))} {what}")


def _spanned(rows: Array, blade: Multivector, k: int) -> Array:
    """Return orthonormal columns (..., n, k) that span the blade, close to the axes of its largest component.

    The vectors of the blade are those with ``x∧B = 0``: the right singular vectors of the k smallest singular
    values of this map.
    """
    algebra, n = blade.algebra, blade.algebra.dimension
    unit = blade._like(rows)
    if k == n:
        span = np.broadcast_to(np.eye(n), (*rows.shape[:-1], n, n))
    else:
        images = [np.asarray(e.wedge(unit).grade(k + 1)) for e in algebra.basis_vectors]
        span = np.swapaxes(np.linalg.svd(np.stack(images, axis=-1))[2][..., n - k :, :], -1, -2)
    largest = np.abs(rows).argmax(axis=-1)
    generators = np.array([generators_of(*algebra._blades()[i]) for i in algebra._indices(1 << k)])[largest]
    # The projections of these axes on the span, as columns; their triangular factor has a positive diagonal.
    axes = np.swapaxes(np.take_along_axis(span, generators[..., np.newaxis], axis=-2), -1, -2)
    q, r = np.linalg.qr(span @ axes)
    signs = np.where(np.diagonal(r, axis1=-2, axis2=-1) < 0, -1.0, 1.0)
    orthonormal: Array = q * signs[..., np.newaxis, :]
    return orthonormal


def _orthogonal(axes: Array, metric: Array) -> Array:
    """Return columns of the same span that are also orthogonal in the metric, given by squares."""
    if (metric == 1).all():
        return axes
    gram = np.swapaxes(axes, -1, -2) @ (metric[:, np.newaxis] * axes)
    off = gram * (1 - np.eye(gram.shape[-1]))
    turned = axes @ np.linalg.eigh(gram)[1]
    return np.where(
        (np.abs(off).max(axis=(-2, -1), initial=0) == 0)[..., np.newaxis, np.newaxis], axes, turned
    )


@explains_calls
def reciprocal_frame(vectors: Sequence[Multivector]) -> tuple[Multivector, ...]:
    """Return the reciprocal vectors ``b^i`` of vectors ``b_j``: ``b^i·b_j`` is 1 for i = j, else 0.

    They lie in the span of the k given vectors, k at most the dimension, of any algebra and coefficients:
    ``b^i = (−1)^(i−1) (b_1∧…∧b_(i−1)∧b_(i+1)∧…∧b_k) (b_1∧…∧b_k)⁻¹``. `vectors` is a sequence of them, whose
    batches broadcast, or a batch (k,). The components of a vector in the frame are ``a·b^i``. A ValueError
    where the vectors are linearly dependent, or span a blade without an inverse.

    Examples
    --------
    >>> b1, b2 = ph.e1, ph.e1 + 2 * ph.e2
    >>> r1, r2 = ph.reciprocal_frame([b1, b2])
    >>> r1 | b1, r1 | b2
    (1, 0)
    >>> a = 5 * b1 + 7 * b2
    >>> a | r1, a | r2
    (5, 7)
    """
    frame = list(vectors)
    for i, b in enumerate(frame):
        if not isinstance(b, _native.Multivector) or b._held() & ~0b10:
            got = type(b).__name__ if not isinstance(b, _native.Multivector) else repr(b)
            raise TypeError(f"a frame is made of vectors; item {i} is {got}; wrap arrays with ph.vector")
        common_algebra(frame[0], b)
    if not frame:
        raise ValueError("a frame needs at least one vector")
    frame = [b.grade(1) for b in frame]
    # By powers of two, which round nothing, so that the volume neither overflows nor vanishes.
    sizes = [power_of_two(b._data, -1)[..., 0] if is_float(b._data) else 1 for b in frame]
    frame = [b / size if is_float(b._data) else b for b, size in zip(frame, sizes, strict=True)]
    if len(frame) > frame[0].algebra.dimension:
        raise ValueError(
            f"{len(frame)} vectors of {frame[0].algebra} are linearly dependent; a frame has at most "
            f"{frame[0].algebra.dimension}"
        )
    volume = functools.reduce(operator.xor, frame)
    square = volume.scalar_product(~volume)
    _require_volume(square, frame)
    inverse = ~volume / square
    one = square.algebra.scalar(1.0)
    found = []
    for i in range(len(frame)):
        rest = functools.reduce(operator.xor, frame[:i] + frame[i + 1 :], one)
        reciprocal = ((-1) ** i * rest * inverse).grade(1)
        found.append(reciprocal / sizes[i] if is_float(reciprocal._data) else reciprocal)
    return tuple(found)


def _require_volume(square: Multivector, frame: list[Multivector]) -> None:
    """Raise a ValueError where the volume is 0 beside the product of the lengths of the vectors."""
    data = square._data[..., 0]
    kind = kind_of(data)
    if kind.exact:
        zero = np.frompyfunc(_generic.exact.is_zero, 1, 1)(data)
        ok: Any = np.logical_not(np.asarray(zero, dtype=bool))
    else:
        lengths = [kind.xp.sum(kind.squared(b._data), axis=-1) for b in frame]
        # Rounding of the volume is some eps of the product of lengths, so of its square eps².
        ok = kind.abs(data) > (64 * kind.eps) ** 2 * functools.reduce(operator.mul, lengths)
        if not kind.is_concrete(ok):
            return
    if not np.all(np.asarray(ok)):
        index = at_index(first_index(~np.asarray(ok)))
        raise ValueError(f"the vectors{index} are linearly dependent, or their blade has no inverse")
