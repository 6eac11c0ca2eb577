"""Linear maps of vectors, extended to all grades as outermorphisms, and of bivectors."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.constructors import bivector, e1, e2, e3, pure, scalar, trivector, vector
from polhode._algebra.multivector import Multivector
from polhode._support.arrays import Array, Shape, as_floats, at_index, first_index, frozen

_NAMES = {1: "vectors", 2: "bivectors"}

# Relative asymmetry that may be rounding: a sum or product of matrices rounds a few dozen times.
_ROUNDING = 64 * np.finfo(float).eps


class LinearMap:
    """A linear map F of vectors to vectors or of bivectors to bivectors, or an array of them. Immutable.

    A map of vectors (`grade` 1) acts on every multivector, as the outermorphism
    ``F(a∧b) = F(a)∧F(b)``, ``F(1) = 1``, ``F(I) = det F · I``. One of bivectors (`grade` 2) acts on bivectors
    only; the inertia of a body (handout eq. 4.18) is one.

    ``F*G`` applies G first; if one of them maps bivectors, so does the product. An outermorphism is not
    linear in F, ``(F + G)(a∧b)`` is not ``F(a∧b) + G(a∧b)``, so maps have no sum: add their matrices.

    Created by `from_matrix` and `from_function`.
    """

    __slots__ = ("_grade", "_matrix")
    _grade: int
    _matrix: Array
    __array_ufunc__ = None  # an array times a map is an error, not an array of errors
    __hash__ = None  # type: ignore[assignment]  # equality is by value, over arrays

    def __init__(self, *_: object) -> None:
        raise TypeError("LinearMap has no constructor; use LinearMap.from_matrix or LinearMap.from_function")

    # --- constructors

    @staticmethod
    def from_matrix(m: Any, grade: int = 1) -> LinearMap:
        """From matrices (..., 3, 3) whose columns are the images of e1, e2, e3, or of e2e3, e3e1, e1e2."""
        matrix = np.array(as_floats(m, "the matrix of a linear map"))
        if matrix.shape[-2:] != (3, 3):
            raise ValueError(f"the matrix of a linear map must have shape (..., 3, 3), got {matrix.shape}")
        if not np.isfinite(matrix).all():
            index = first_index(~np.isfinite(matrix))
            raise ValueError(f"matrix entry {index} of a linear map must be finite, got {matrix[index]}")
        self = object.__new__(LinearMap)
        self._matrix, self._grade = frozen(matrix), _checked(grade)
        return self

    @staticmethod
    def from_function(f: Callable[[Multivector], Multivector], grade: int = 1) -> LinearMap:
        """From a function on vectors, or for grade 2 on bivectors: a rotor, ``lambda a: a.project(plane)``.

        It is called with the three basis values, and with a fourth to check that it is linear; a ValueError
        if it is not.
        """
        basis = [e1, e2, e3] if _checked(grade) == 1 else [e1.undual(), e2.undual(), e3.undual()]
        images = [pure(f(b), grade, "the image") for b in basis]
        F = LinearMap.from_matrix(np.stack(np.broadcast_arrays(*images), axis=-1), grade)
        probe = 0.6 * basis[0] - 1.7 * basis[1] + 2.3 * basis[2]
        image, size = f(probe), np.linalg.norm(F.matrix, axis=(-2, -1))
        if not np.all(image.is_close(F(probe), rtol=0, atol=1e-9 * size)):
            raise ValueError(
                f"the function is not linear: it maps {probe!r} to {image!r}, not to {F(probe)!r}"
            )
        return F

    # --- matrices

    @property
    def grade(self) -> int:
        """1 for a map of vectors, 2 for one of bivectors."""
        return self._grade

    @property
    def matrix(self) -> Array:
        """The matrices (..., 3, 3) over e1, e2, e3, or for grade 2 over e2e3, e3e1, e1e2."""
        return self._matrix.copy()

    @property
    def shape(self) -> Shape:
        """Shape of the batch; ``()`` for a single map."""
        return self.matrix.shape[:-2]

    @property
    def bivector_matrix(self) -> Array:
        """The matrices (..., 3, 3) of the action on bivectors; for a map of vectors, that of its cofactors.

        The columns are the images ``F(e2)∧F(e3)``, ``F(e3)∧F(e1)``, ``F(e1)∧F(e2)``.
        """
        if self.grade == 2:
            return self.matrix
        x, y, z = self._images()
        return np.stack([p.wedge(q).components for p, q in ((y, z), (z, x), (x, y))], axis=-1)

    @property
    def determinant(self) -> Any:
        """The factor by which the map scales volumes, ``F(I) = det F · I``: a float, or an array.

        For a map of bivectors, the determinant of its matrix.
        """
        x, y, z = self._images()
        return x.wedge(y).wedge(z).components[..., 0][()]

    def __call__(self, X: Any) -> Multivector:
        """``F(X)``, in float64; batches broadcast."""
        if not isinstance(X, Multivector):
            name = type(X).__name__
            raise TypeError(f"a linear map acts on multivectors, got {name}; wrap arrays with ph.vector")
        if self.grade == 2:
            return bivector(_times(self.matrix, pure(X, 2, "the argument of a map of bivectors")))
        if X.algebra is not e1.algebra:
            raise TypeError(f"a linear map acts on values of 3-d space, got one of {X.algebra}")
        first, *others = [self._part(X.astype(float), k) for k in X.grades]
        return sum(others, start=first)

    def _part(self, X: Multivector, k: int) -> Multivector:
        components = X.grade(k).components
        if k == 0:
            return scalar(components[..., 0]).wedge(np.ones(self.shape))
        if k == 1:
            return vector(_times(self.matrix, components))
        if k == 2:
            return bivector(_times(self.bivector_matrix, components))
        return trivector(components[..., 0]).wedge(self.determinant)

    def _images(self) -> list[Multivector]:
        return [vector(self.matrix[..., k]) for k in range(3)]

    # --- algebra

    def __mul__(self, other: LinearMap) -> LinearMap:
        """``F*G`` applies G first: ``(F*G)(X) = F(G(X))``."""
        if not isinstance(other, LinearMap):
            return NotImplemented
        if self.grade == other.grade == 1:
            return LinearMap.from_matrix(self.matrix @ other.matrix)
        return LinearMap.from_matrix(self.bivector_matrix @ other.bivector_matrix, grade=2)

    def adjoint(self) -> LinearMap:
        """Return the adjoint map, ``F(a)·b = a·adj(F)(b)``: the transposed matrix."""
        return LinearMap.from_matrix(np.swapaxes(self.matrix, -1, -2), self.grade)

    def inverse(self) -> LinearMap:
        """Return the inverse map, which is also ``A ↦ I adj(F)(I⁻¹ A) / det F``.

        A ValueError, with the batch index, where the map is singular to rounding.
        """
        sizes = np.linalg.svd(self.matrix, compute_uv=False)
        singular = sizes[..., 2] <= 4 * np.finfo(float).eps * sizes[..., 0]
        if singular.any():
            index = first_index(singular)
            raise ValueError(
                f"the map{at_index(index)} has no inverse: its singular values are {sizes[index].tolist()}"
            )
        return LinearMap.from_matrix(np.linalg.inv(self.matrix), self.grade)

    def symmetric_part(self) -> LinearMap:
        """Return ``½ (F + adj F)``, as maps of vectors or, for grade 2, of bivectors."""
        return LinearMap.from_matrix(0.5 * self.matrix + 0.5 * self.adjoint().matrix, self.grade)

    def antisymmetric_part(self) -> LinearMap:
        """Return ``½ (F − adj F)``; of vectors, it is ``a ↦ a·B`` for a bivector B."""
        return LinearMap.from_matrix(0.5 * self.matrix - 0.5 * self.adjoint().matrix, self.grade)

    # --- eigenvalues

    def eigenvectors(self) -> tuple[Multivector, Array]:
        """Return unit eigenvectors (..., 3) and eigenvalues (..., 3) of a symmetric map of vectors.

        The eigenvalues rise; the vectors are perpendicular and right-handed, ``a1 a2 a3 = I``.
        """
        if self.grade == 2:
            raise ValueError("a map of bivectors has no eigenvectors; see eigenplanes")
        factors, axes = self._principal_axes()
        return vector(axes), factors

    def eigenplanes(self) -> tuple[Multivector, Array]:
        """Return unit bivectors (..., 3) that a symmetric map only scales, and their eigenvalues (..., 3).

        The eigenvalues rise. For a map of vectors they are the products of two eigenvalues of vectors.
        """
        stretch, axes = self._principal_axes()
        if self.grade == 2:
            return bivector(axes), stretch
        factors = np.stack([stretch[..., i] * stretch[..., j] for i, j in ((1, 2), (2, 0), (0, 1))], axis=-1)
        order = np.argsort(factors, axis=-1, kind="stable")
        planes = np.take_along_axis(axes, order[..., np.newaxis], axis=-2)
        return bivector(planes), np.take_along_axis(factors, order, axis=-1)

    def _principal_axes(self) -> tuple[Array, Array]:
        """Return eigenvalues (..., 3), rising, and right-handed eigenvectors as rows (..., 3, 3)."""
        transposed = np.swapaxes(self.matrix, -1, -2)
        skew = np.abs(self.matrix - transposed).max(axis=(-2, -1))
        asymmetric = skew > _ROUNDING * np.abs(self.matrix).max(axis=(-2, -1))
        if asymmetric.any():
            index = first_index(asymmetric)
            raise ValueError(
                f"the map{at_index(index)} is not symmetric: it differs from adjoint() by {skew[index]:.3g}; "
                "take symmetric_part(), or for a rotation Rotor.from_matrix(F.matrix).plane_angle()"
            )
        factors, columns = np.linalg.eigh(0.5 * self.matrix + 0.5 * transposed)
        columns[..., 2] *= np.sign(np.linalg.det(columns))[..., np.newaxis]
        return factors, np.swapaxes(columns, -1, -2)

    # --- comparison

    def __eq__(self, other: object) -> Any:
        """Exact equality of grade and matrix: a bool, or an array of the batch shape."""
        if not isinstance(other, LinearMap):
            return NotImplemented
        return ((self.matrix == other.matrix) & (self.grade == other.grade)).all(axis=(-2, -1))[()]

    def __ne__(self, other: object) -> Any:
        equal = self.__eq__(other)
        return equal if equal is NotImplemented else np.logical_not(equal)[()]

    def is_close(self, other: Any, rtol: float = 1e-9, atol: float = 0.0) -> Any:
        """Whether ``|F − G| <= max(rtol · max(|F|, |G|), atol)``, |F|² the sum of the squared entries."""
        if not isinstance(other, LinearMap) or other.grade != self.grade:
            raise TypeError(f"is_close needs another map of {_NAMES[self.grade]}, got {other!r}")
        a, b = np.broadcast_arrays(self.matrix, other.matrix)
        distance, p, q = (np.linalg.norm(m, axis=(-2, -1)) for m in (a - b, a, b))
        return (distance <= np.maximum(rtol * np.maximum(p, q), atol))[()]

    def __repr__(self) -> str:
        batch = f", shape {self.shape}" if self.shape else ""
        return f"LinearMap of {_NAMES[self.grade]}{batch}, matrix\n{self.matrix!r}"

    def _repr_latex_(self) -> str:
        from polhode._algebra import format as _format

        return _format.matrix_latex(f"{type(self).__name__} of {_NAMES[self.grade]}", self.matrix)

    def __reduce__(self) -> tuple[Any, ...]:
        return LinearMap.from_matrix, (np.array(self.matrix), self.grade)


def _checked(grade: int) -> int:
    if grade not in _NAMES:
        raise ValueError(f"a linear map takes vectors (grade 1) or bivectors (grade 2), got grade {grade!r}")
    return grade


def _times(matrix: Array, components: Array) -> Array:
    with np.errstate(over="ignore", invalid="ignore"):  # IEEE, as in the products
        product: Array = (matrix @ components[..., np.newaxis])[..., 0]
    return product


_native.register("LinearMap", LinearMap)
