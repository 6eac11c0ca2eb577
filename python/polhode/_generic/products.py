"""Products of multivectors as lists of terms, over arrays of any coefficients.

A term ``(i, j, k, sign)`` adds ``sign · a_i · b_j`` to component k of the result. Every product of every
algebra is such a list.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from polhode._generic.coefficients import Coefficients
from polhode._generic.compiled import compiled
from polhode._generic.numeric import Array

Term = tuple[int, int, int, int]

# Up to this number, terms are written out as sums of component products, which compilers fuse; beyond, they
# are gathered by index, so that the traced program does not grow with the algebra.
_WRITTEN_OUT = 128


@compiled
def product(d: Coefficients, terms: Sequence[Term], count: int, a: Array, b: Array) -> Array:
    """Return the product of a (..., K) and b (..., L), batches broadcasting, with `count` components."""
    if d.exact or len(terms) <= _WRITTEN_OUT:
        return _written_out(d, terms, count, a, b)
    return _gathered(d, terms, count, a, b)


def _written_out(d: Coefficients, terms: Sequence[Term], count: int, a: Array, b: Array) -> Array:
    sums: list[Any] = [None] * count
    for i, j, k, sign in terms:
        part = a[..., i] * b[..., j]
        if sums[k] is None:
            sums[k] = part if sign > 0 else -part
        else:
            sums[k] = sums[k] + part if sign > 0 else sums[k] - part
    batch = np.broadcast_shapes(tuple(a.shape[:-1]), tuple(b.shape[:-1]))
    return d.stack([d.zeros(batch) if total is None else total for total in sums])


def _gathered(d: Any, terms: Sequence[Term], count: int, a: Array, b: Array) -> Array:
    """Return ``Σ_t sign · a[left] · b[right]``, with the terms of each component along a last axis."""
    rows: list[list[Term]] = [[] for _ in range(count)]
    for term in terms:
        rows[term[2]].append(term)
    width = max(map(len, rows))
    left, right = (np.zeros((count, width), dtype=np.int64) for _ in range(2))
    signs = np.zeros((count, width))
    for k, row in enumerate(rows):
        for t, (i, j, _, sign) in enumerate(row):
            left[k, t], right[k, t], signs[k, t] = i, j, sign
    signs_here = d.asarray(signs)
    parts = _taken(d, a, left) * _taken(d, b, right) * signs_here
    # Padding is replaced by 0, not multiplied by 0, which would keep infinities.
    return d.xp.sum(d.where(signs_here == 0, 0.0, parts), axis=-1)


def _taken(d: Any, x: Array, where: np.ndarray[Any, np.dtype[np.int64]]) -> Array:
    device = {} if not hasattr(x, "device") or d.is_jax else {"device": x.device}
    indices = d.xp.asarray(where.reshape(-1), **device)
    taken = d.xp.take(x, indices, axis=-1)
    return d.xp.reshape(taken, (*x.shape[:-1], *where.shape))
