"""Outermorphisms: matrices of the action of a linear map of vectors on all grades."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from polhode._algebra.coefficients import kind_of
from polhode._support.arrays import Array

if TYPE_CHECKING:
    from polhode._algebra.algebra import Algebra
    from polhode._algebra.multivector import Multivector


def compound(algebra: Algebra, matrix: Array, grade: int) -> Array:
    """Return the matrices (..., K, K) of the action on a grade >= 1 of matrices (..., n, n) of vectors.

    The columns are the images ``F(a)∧F(b)∧…`` of the basis elements. Of whole numbers they are exact.
    """
    vectors = [algebra.vector(matrix[..., k]) for k in range(algebra.dimension)]
    images: dict[tuple[int, ...], Multivector] = {(k,): image for k, image in enumerate(vectors)}

    def image(generators: tuple[int, ...]) -> Multivector:
        if generators not in images:
            images[generators] = image(generators[:-1]).wedge(vectors[generators[-1]])
        return images[generators]

    blades = algebra._blades()
    columns = [image(_generators(*blades[i])).components for i in algebra._indices(1 << grade)]
    return np.stack(columns, axis=-1)


def outermorphism(algebra: Algebra, matrix: Array) -> Array:
    """Return the matrices (..., 2ⁿ, 2ⁿ) of the action on all components."""
    whole = np.zeros((*matrix.shape[:-2], algebra.size, algebra.size))
    whole[..., 0, 0] = 1.0
    for grade in range(1, algebra.dimension + 1):
        places = algebra._indices(1 << grade)
        whole[..., np.array(places)[:, np.newaxis], places] = compound(algebra, matrix, grade)
    return whole


def times(matrix: Array, components: Array) -> Array:
    """Return the matrices times the components, by IEEE rules as in the products."""
    with np.errstate(over="ignore", invalid="ignore"):
        factor = matrix if isinstance(components, np.ndarray) else kind_of(components).asarray(matrix)
        product: Array = (factor @ components[..., np.newaxis])[..., 0]
    return product


def _generators(bits: int, sign: int) -> tuple[int, ...]:
    """Return the generators of a basis element, in its order."""
    rising = tuple(i for i in range(bits.bit_length()) if bits >> i & 1)
    return rising if sign > 0 else rising[::-1]
