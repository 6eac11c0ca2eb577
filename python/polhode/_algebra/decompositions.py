"""Eigenvectors, singular values and the polar form of linear maps in a Euclidean metric."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from polhode._algebra.rotor import Rotor
from polhode._support.arrays import Array, at_index, first_index

if TYPE_CHECKING:
    from polhode._algebra.linear_map import LinearMap
    from polhode._algebra.multivector import Multivector

# Relative asymmetry that may be rounding: a sum or product of matrices rounds a few dozen times.
_ROUNDING = 64 * np.finfo(float).eps

# In this order the planes of 3-d space are those of the axes.
_PAIRS_OF_THREE = ((1, 2), (2, 0), (0, 1))


def eigenvectors(F: LinearMap) -> tuple[Multivector, Array]:
    """Return unit eigenvectors (..., n) and eigenvalues (..., n) of a symmetric map of vectors.

    The eigenvalues ascend; the vectors are perpendicular and right-handed, ``a1 a2 … an = I``. The metric
    must be Euclidean; in others symmetric maps may have complex eigenvalues.

    Examples
    --------
    >>> F = ph.LinearMap.from_matrix([[2, 1, 0], [1, 2, 0], [0, 0, 5]])
    >>> vectors, factors = F.eigenvectors()
    >>> factors.round(12)
    array([1., 3., 5.])
    >>> F(vectors).is_close(factors * vectors)
    array([ True,  True,  True])
    """
    if F.grade == 2:
        raise ValueError("a map of bivectors has no eigenvectors; see eigenplanes")
    factors, axes = _principal_axes(F, "eigenvectors")
    return F.algebra.vector(axes), factors


def eigenplanes(F: LinearMap) -> tuple[Multivector, Array]:
    """Return unit bivectors (..., K) that a symmetric map only scales, and their eigenvalues (..., K).

    K is 3 in 3-d space. The eigenvalues ascend. For a map of vectors they are the products of two eigenvalues
    of vectors. The metric must be Euclidean.

    Examples
    --------
    >>> planes, factors = ph.LinearMap.from_matrix(np.diag([1, 2, 3])).eigenplanes()
    >>> factors
    array([2., 3., 6.])
    """
    stretch, axes = _principal_axes(F, "eigenplanes")
    if F.grade == 2:
        return F.algebra.bivector(axes), stretch
    n = F.algebra.dimension
    pairs = _PAIRS_OF_THREE if n == 3 else tuple(combinations(range(n), 2))
    with np.errstate(over="ignore"):  # IEEE, as in the products
        factors = np.stack([stretch[..., i] * stretch[..., j] for i, j in pairs], axis=-1)
    order = np.argsort(factors, axis=-1, kind="stable")
    planes = np.take_along_axis(axes if n == 3 else _planes(F, axes), order[..., np.newaxis], axis=-2)
    return F.algebra.bivector(planes), np.take_along_axis(factors, order, axis=-1)


def _planes(F: LinearMap, axes: Array) -> Array:
    """Return the components (..., K, K) of the planes of two axes each."""
    vectors = [F.algebra.vector(axes[..., i, :]) for i in range(F.algebra.dimension)]
    return np.stack([a.wedge(b).components for a, b in combinations(vectors, 2)], axis=-2)


def _principal_axes(F: LinearMap, name: str) -> tuple[Array, Array]:
    """Return eigenvalues (..., K), rising, and right-handed eigenvectors as rows (..., K, K)."""
    _require_euclidean(F, name, "np.linalg.eig(F.matrix) returns complex ones")
    matrix = F.matrix
    transposed = np.swapaxes(matrix, -1, -2)
    skew = np.abs(matrix - transposed).max(axis=(-2, -1))
    asymmetric = skew > _ROUNDING * np.abs(matrix).max(axis=(-2, -1))
    if asymmetric.any():
        index = first_index(asymmetric)
        raise ValueError(
            f"the map{at_index(index)} is not symmetric: it differs from adjoint() by {skew[index]:.3g}; "
            "take symmetric_part(), svd(), or for a rotation Rotor.from_matrix(F.matrix).plane_angle()"
        )
    factors, columns = np.linalg.eigh(0.5 * matrix + 0.5 * transposed)
    columns[..., -1] *= np.sign(np.linalg.det(columns))[..., np.newaxis]
    return factors, np.swapaxes(columns, -1, -2)


def svd(F: LinearMap) -> tuple[Multivector, Array, Multivector]:
    """Return unit values u (..., K), singular values s (..., K) and unit values v: ``F(v_k) = s_k u_k``.

    ``F(a) = Σ s_k (a·v_k) u_k`` for a map of vectors, K their dimension. The singular values descend, as
    in NumPy, and are not negative; the u are perpendicular, and so are the v, in either orientation. For a
    map of bivectors u and v are bivectors. The metric must be Euclidean.

    Examples
    --------
    >>> u, s, v = ph.LinearMap.from_matrix(np.diag([1, 2, 3])).svd()
    >>> s
    array([3., 2., 1.])
    """
    _require_euclidean(F, "svd", "np.linalg.svd(F.matrix) measures components")
    u, sizes, rows = np.linalg.svd(F.matrix)
    k_vector, grade = F.algebra.k_vector, F.grade
    return k_vector(grade, np.swapaxes(u, -1, -2)), sizes, k_vector(grade, rows)


def polar(F: LinearMap) -> tuple[Rotor, LinearMap]:
    """Return the rotor R and the symmetric map S with ``F(X) = R(S(X))``: first a stretch, then a rotation.

    Of maps of 3-d space, as ``scipy.linalg.polar``. R is the rotation nearest to F, and S squared
    ``F.adjoint() * F``. A ValueError, with the batch index, for a map that changes orientation
    (``det F < 0``), such as a reflection; ``-F`` has a polar form then. Of a map with an image of less than
    two dimensions R is one of many.

    Examples
    --------
    A stretch along e1, then a quarter turn:

    >>> F = ph.LinearMap.from_matrix([[0, -1, 0], [2, 0, 0], [0, 0, 1]])
    >>> R, S = F.polar()
    >>> print(np.degrees(R.angle).round(6))
    90.0
    >>> S.matrix.round(6) + 0
    array([[2., 0., 0.],
           [0., 1., 0.],
           [0., 0., 1.]])
    """
    if F.algebra.signature != (3, 0, 0):
        raise ValueError(f"polar needs a map of 3-d space, got one of {F.algebra}; svd() is for any Cl(n)")
    u, sizes, rows = np.linalg.svd(F.matrix)
    sign = np.sign(np.linalg.det(u @ rows))
    mirrored = (sign < 0) & (sizes[..., 2] > 4 * np.finfo(float).eps * sizes[..., 0])
    if mirrored.any():
        index = first_index(mirrored)
        raise ValueError(
            f"the map{at_index(index)} changes orientation, its determinant is {np.prod(-sizes[index]):.6g}; "
            "no rotor does: take the polar form of -F"
        )
    # Where F is singular the sign of the last axis is free.
    u[..., 2] *= sign[..., np.newaxis]
    sizes[..., 2] *= sign
    stretch = np.swapaxes(rows, -1, -2) @ (sizes[..., np.newaxis] * rows)
    symmetric = 0.5 * stretch + 0.5 * np.swapaxes(stretch, -1, -2)
    return Rotor.from_matrix(u @ rows), F._with(symmetric)


def _require_euclidean(F: LinearMap, name: str, remedy: str) -> None:
    _, q, r = F.algebra.signature
    if q or r:
        raise ValueError(f"{name} needs a Euclidean metric, got a map of {F.algebra}; {remedy}")
