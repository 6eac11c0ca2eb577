"""Linear maps of vectors, extended to all grades as outermorphisms, and of bivectors."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NoReturn

import numpy as np

from polhode import _native
from polhode._algebra import decompositions as _decompositions
from polhode._algebra.algebra import Algebra
from polhode._algebra.coefficients import as_coefficients
from polhode._algebra.constructors import e1, one_grade
from polhode._algebra.foreign_values import has_reflected
from polhode._algebra.grades import with_grades
from polhode._algebra.multivector import Multivector
from polhode._algebra.outermorphism import compound, outermorphism, times
from polhode._support.arrays import (
    Array,
    Shape,
    as_floats,
    at_index,
    batch_shape,
    first_index,
    frozen,
    is_complex,
    lengths,
    power_of_two,
)

_NAMES = {1: "vectors", 2: "bivectors"}
_G3 = e1.algebra


class LinearMap:
    """A linear map F of vectors to vectors or of bivectors to bivectors, or an array of them. Immutable.

    A map of vectors (`grade` 1) acts on every multivector of its algebra, as the outermorphism
    ``F(a∧b) = F(a)∧F(b)``, ``F(1) = 1``, ``F(I) = det F · I``. One of bivectors (`grade` 2) acts on bivectors
    only; the inertia of a body (handout eq. 4.18) is one.

    ``F*G`` and ``F @ G`` apply G first; in 3-d space a product of a map of vectors and one of bivectors maps
    bivectors. ``F + G`` and ``2*F`` are sums and multiples of the maps of vectors (or bivectors), whose
    outermorphism is not the sum: ``(F + G)(a) = F(a) + G(a)`` for vectors a, but not for ``a∧b``. An array
    scales as a batch.

    Created by `from_matrix`, `from_function` and `identity`.

    Examples
    --------
    A stretch by 1, 2 and 3 along the axes scales planes by 2, 3 and 6, and volumes by 6:

    >>> F = ph.LinearMap.from_matrix(np.diag([1, 2, 3]))
    >>> F(ph.e1 + ph.e2)
    e1 + 2 e2
    >>> F(ph.e1 ^ ph.e2), F(ph.I)
    (2 e1∧e2, 6 I)
    >>> (F * F)(ph.e3)
    9 e3
    """

    __slots__ = ("_algebra", "_grade", "_matrix")
    _algebra: Algebra
    _grade: int
    _matrix: Array
    __array_ufunc__ = None  # NumPy arrays defer to this class
    __hash__ = None  # type: ignore[assignment]  # equality is by value, over arrays

    def __init__(self, *_: object) -> None:
        raise TypeError("LinearMap has no constructor; use LinearMap.from_matrix or LinearMap.from_function")

    # --- constructors

    @staticmethod
    def from_matrix(m: Any, grade: int = 1, *, algebra: Algebra | None = None) -> LinearMap:
        """From matrices whose columns are the images of the basis vectors, or for grade 2 basis bivectors.

        Of shape (..., 3, 3) over e1, e2, e3, or over e2e3, e3e1, e1e2; in another `algebra` (..., K, K) over
        its K basis elements of the grade.

        Examples
        --------
        >>> F = ph.LinearMap.from_matrix([[1, 5, 0], [0, 1, 0], [0, 0, 1]])
        >>> F(ph.e2)
        5 e1 + e2
        """
        own, size = _space(algebra, grade)
        matrix = np.array(as_floats(m, "the matrix of a linear map"))
        if matrix.shape[-2:] != (size, size):
            of = "" if own is _G3 else f" of {_NAMES[grade]} of {own}"
            raise ValueError(
                f"the matrix of a linear map{of} must have shape (..., {size}, {size}), got {matrix.shape}"
            )
        if not np.isfinite(matrix).all():
            index = first_index(~np.isfinite(matrix))
            raise ValueError(f"matrix entry {index} of a linear map must be finite, got {matrix[index]}")
        self = object.__new__(LinearMap)
        self._matrix, self._grade, self._algebra = frozen(matrix), grade, own
        return self

    @staticmethod
    def from_function(
        f: Callable[[Multivector], Multivector], grade: int = 1, *, algebra: Algebra | None = None
    ) -> LinearMap:
        """From a function on vectors, or for grade 2 on bivectors: a rotor, ``lambda a: a.project(plane)``.

        It is called with the basis values of the algebra, by default of 3-d space, and with another to check
        that it is linear; a ValueError if it is not. Versors of other algebras are such functions, too.

        Examples
        --------
        >>> F = ph.LinearMap.from_function(lambda a: a.project(ph.e1 ^ ph.e2))
        >>> F.matrix
        array([[1., 0., 0.],
               [0., 1., 0.],
               [0., 0., 0.]])
        """
        own, size = _space(algebra, grade)
        if not callable(f):
            raise TypeError(f"f must be a function of a multivector, got {type(f).__name__}")
        images = [_components(f(own.k_vector(grade, row)), own, grade, "the image") for row in np.eye(size)]
        F = LinearMap.from_matrix(np.stack(np.broadcast_arrays(*images), axis=-1), grade, algebra=own)
        numbers = np.array([(-1.0) ** k * (0.6 + 0.85 * k) for k in range(size)])
        probe = own.k_vector(grade, numbers)
        bound: Any = 1e-9 * np.linalg.norm(numbers) * lengths(F.matrix, (-2, -1))
        image = f(probe)
        if not np.all(image.is_close(F(probe), rtol=0, atol=bound)):
            raise ValueError(
                f"the function is not linear: it maps {probe!r} to {image!r}, not to {F(probe)!r}"
            )
        return F

    @staticmethod
    def identity(shape: int | Shape = (), *, grade: int = 1, algebra: Algebra | None = None) -> LinearMap:
        """Return the identity map, or a batch of it of this shape.

        Examples
        --------
        >>> ph.LinearMap.identity()(ph.e1 + ph.I)
        e1 + I
        """
        own, size = _space(algebra, grade)
        matrix = np.broadcast_to(np.eye(size), (*batch_shape(shape), size, size))
        return LinearMap.from_matrix(matrix, grade, algebra=own)

    # --- matrices

    @property
    def algebra(self) -> Algebra:
        """The algebra of the values it maps."""
        return self._algebra

    @property
    def grade(self) -> int:
        """1 for a map of vectors, 2 for one of bivectors."""
        return self._grade

    @property
    def matrix(self) -> Array:
        """The matrices (..., 3, 3) over e1, e2, e3, or for grade 2 over e2e3, e3e1, e1e2.

        In other algebras (..., K, K) over the K basis elements of the grade, in their order.

        Examples
        --------
        >>> ph.LinearMap.from_function(lambda a: a.reflect(ph.e3)).matrix
        array([[ 1.,  0.,  0.],
               [ 0.,  1.,  0.],
               [ 0.,  0., -1.]])
        """
        return self._matrix.copy()

    @property
    def shape(self) -> Shape:
        """Shape of the batch; ``()`` for a single map."""
        return self.matrix.shape[:-2]

    @property
    def bivector_matrix(self) -> Array:
        """The matrices of the action on bivectors; for a map of vectors of 3-d space, that of its cofactors.

        Of shape (..., 3, 3) in 3-d space; the columns are ``F(e2)∧F(e3)``, ``F(e3)∧F(e1)``, ``F(e1)∧F(e2)``.

        Examples
        --------
        >>> ph.LinearMap.from_matrix(np.diag([1, 2, 3])).bivector_matrix
        array([[6., 0., 0.],
               [0., 3., 0.],
               [0., 0., 2.]])
        """
        return self.matrix if self.grade == 2 else compound(self.algebra, self.matrix, 2)

    @property
    def outermorphism_matrix(self) -> Array:
        """The matrices (..., 2**n, 2**n) of the action of a map of vectors on all components, `dense`.

        Examples
        --------
        >>> ph.LinearMap.from_matrix(np.diag([1, 2, 3])).outermorphism_matrix.diagonal()
        array([1., 1., 2., 3., 6., 3., 2., 6.])
        """
        if self.grade == 2:
            raise TypeError("a map of bivectors has no outermorphism; see its matrix")
        return outermorphism(self.algebra, self.matrix)

    @property
    def determinant(self) -> Any:
        """The factor by which the map scales volumes, ``F(I) = det F · I``: a float, or an array.

        For a map of bivectors, the determinant of its matrix.

        Examples
        --------
        >>> print(ph.LinearMap.from_matrix(np.diag([1, 2, 3])).determinant)
        6.0
        """
        n, matrix = self.algebra.dimension, self.matrix
        if matrix.shape[-1] != n:
            return np.linalg.det(matrix)
        # Columns in units of powers of two, so that no product on the way overflows or vanishes.
        units = power_of_two(matrix, -2)
        powers = np.sum(np.frexp(units)[1] - 1, axis=(-2, -1))
        with np.errstate(over="ignore"):
            return np.ldexp(compound(self.algebra, matrix / units, n)[..., 0, 0], powers)[()]

    def trace(self) -> Any:
        """Return the trace of the matrix, ``Σ e^k·F(e_k)``: a float, or an array of the batch shape.

        Examples
        --------
        >>> print(ph.LinearMap.from_matrix(np.diag([1, 2, 3])).trace())
        6.0
        """
        return np.trace(self.matrix, axis1=-2, axis2=-1)[()]

    def __call__(self, X: Any) -> Multivector:
        """``F(X)``; batches broadcast. Of complex X, ``F(X.real) + i F(X.imag)``.

        NumPy's results are float64. Arrays of other libraries keep their type, and derivatives pass through.
        """
        if not isinstance(X, Multivector):
            name = type(X).__name__
            raise TypeError(f"a linear map acts on multivectors, got {name}; wrap arrays with ph.vector")
        if is_complex(X._data):
            return self(X.real) + 1j * self(X.imag)
        if self.grade == 2:
            components = _components(X, self.algebra, 2, "the argument of a map of bivectors")
            return self.algebra.bivector(times(self.matrix, components))
        if X.algebra is not self.algebra:
            own = "3-d space" if self.algebra is _G3 else self.algebra
            raise TypeError(f"this linear map acts on values of {own}, got one of {X.algebra}")
        given = X.astype(float) if isinstance(X._data, np.ndarray) else X
        first, *others = [self._part(given, k) for k in given.grades]
        return sum(others, start=first)

    def _part(self, X: Multivector, k: int) -> Multivector:
        components, own = X.grade(k)._data, self.algebra
        if k == 0:
            return own.scalar(components[..., 0]).wedge(np.ones(self.shape))
        if k == 1:
            return own.vector(times(self.matrix, components))
        if k == own.dimension:
            return own.pseudoscalar(components[..., 0]).wedge(self.determinant)
        return own.k_vector(k, times(compound(own, self.matrix, k), components))

    # --- algebra

    def __mul__(self, other: Any) -> LinearMap:
        """``F*G`` applies G first, ``(F*G)(X) = F(G(X))``; ``F*2`` is a multiple."""
        return self.__matmul__(other) if isinstance(other, LinearMap) else self._scaled(other)

    def __rmul__(self, other: Any) -> LinearMap:
        return self._scaled(other)

    def __matmul__(self, other: Any) -> LinearMap:
        """``F @ G`` applies G first: ``(F @ G)(X) = F(G(X))``."""
        if has_reflected(other, "__rmatmul__"):
            return NotImplemented
        if not isinstance(other, LinearMap):
            _refuse_factor(other)
        self._require_algebra(other)
        if self.grade == other.grade:
            return self._with(self.matrix @ other.matrix)
        return LinearMap.from_matrix(
            self.bivector_matrix @ other.bivector_matrix, grade=2, algebra=self.algebra
        )

    def __rmatmul__(self, other: Any) -> NoReturn:
        _refuse_factor(other)

    def _scaled(self, factor: Any) -> LinearMap:
        if isinstance(factor, Multivector | list | tuple):
            _refuse_factor(factor)
        if not _is_number(factor):
            return NotImplemented  # type: ignore[no-any-return]
        size = as_floats(factor, "the factor of a linear map")
        return self._with(size[..., np.newaxis, np.newaxis] * self.matrix)

    def __truediv__(self, divisor: Any) -> LinearMap:
        if not _is_number(divisor):
            return NotImplemented
        size = as_floats(divisor, "the divisor of a linear map")
        if np.any(size == 0):
            raise ZeroDivisionError(f"division of a linear map by zero{at_index(first_index(size == 0))}")
        return self._with(self.matrix / size[..., np.newaxis, np.newaxis])

    def __add__(self, other: Any) -> LinearMap:
        """``(F + G)(a) = F(a) + G(a)`` for vectors a, or for maps of bivectors for bivectors."""
        if not isinstance(other, LinearMap):
            return NotImplemented
        self._require_addend(other)
        return self._with(self.matrix + other.matrix)

    def __sub__(self, other: Any) -> LinearMap:
        if not isinstance(other, LinearMap):
            return NotImplemented
        self._require_addend(other)
        return self._with(self.matrix - other.matrix)

    def __neg__(self) -> LinearMap:
        return self._with(-self.matrix)

    def __pos__(self) -> LinearMap:
        return self

    def _with(self, matrix: Any) -> LinearMap:
        """Return a map of the same grade and algebra."""
        return LinearMap.from_matrix(matrix, self.grade, algebra=self.algebra)

    def _require_algebra(self, other: LinearMap) -> None:
        if other.algebra is not self.algebra:
            raise TypeError(f"the maps belong to different algebras, {self.algebra} and {other.algebra}")

    def _require_addend(self, other: LinearMap) -> None:
        self._require_algebra(other)
        if other.grade != self.grade:
            raise TypeError("a map of vectors and a map of bivectors have no sum; add their bivector_matrix")

    def adjoint(self) -> LinearMap:
        """Return the adjoint map, ``F(a)·b = a·adj(F)(b)``: in 3-d space the transposed matrix.

        In an indefinite metric ``η Fᵀ η``, with the squares of the basis elements in η. A ValueError in a
        degenerate metric, where the equation does not determine it.

        Examples
        --------
        >>> F = ph.LinearMap.from_matrix([[1, 5, 0], [0, 1, 0], [0, 0, 1]])
        >>> a, b = ph.vector([1, 2, 3]), ph.vector([4, 5, 6])
        >>> F(a) | b, a | F.adjoint()(b)
        (72, 72)
        """
        transposed: Array = np.swapaxes(self.matrix, -1, -2)
        _, q, r = self.algebra.signature
        if r:
            raise ValueError(
                f"a map of {self.algebra} has no adjoint, because its metric is degenerate; the dual map has "
                "the transposed matrix"
            )
        if q:
            squares: Array = self.algebra._reverse_squares(1 << self.grade).astype(np.float64)
            transposed = squares[:, np.newaxis] * transposed * squares
        return self._with(transposed)

    def inverse(self) -> LinearMap:
        """Return the inverse map, which is also ``A ↦ I adj(F)(I⁻¹ A) / det F``.

        A ValueError, with the batch index, where the map is singular to rounding.

        Examples
        --------
        >>> F = ph.LinearMap.from_matrix(np.diag([1, 2, 4]))
        >>> F.inverse()(ph.vector([1, 1, 1]))
        e1 + 0.5 e2 + 0.25 e3
        """
        sizes = np.linalg.svd(self.matrix, compute_uv=False)
        singular = sizes[..., -1] <= 4 * np.finfo(float).eps * sizes[..., 0]
        if singular.any():
            index = first_index(singular)
            raise ValueError(
                f"the map{at_index(index)} has no inverse: its singular values are {sizes[index].tolist()}"
            )
        return self._with(np.linalg.inv(self.matrix))

    def symmetric_part(self) -> LinearMap:
        """Return ``½ (F + adj F)``, as maps of vectors or, for grade 2, of bivectors.

        Examples
        --------
        >>> ph.LinearMap.from_matrix([[1, 4, 0], [0, 2, 0], [0, 0, 3]]).symmetric_part().matrix
        array([[1., 2., 0.],
               [2., 2., 0.],
               [0., 0., 3.]])
        """
        return self._with(0.5 * self.matrix + 0.5 * self.adjoint().matrix)

    def antisymmetric_part(self) -> LinearMap:
        """Return ``½ (F − adj F)``; of vectors, it is ``a ↦ a·B`` for a bivector B.

        Examples
        --------
        Of the velocities ``v = x·Ω`` of a spinning body, and a stretch, only the spin is left:

        >>> Omega = 3 * ph.e1 ^ ph.e2
        >>> F = ph.LinearMap.from_function(lambda x: (x | Omega) + 2 * x)
        >>> F.antisymmetric_part()(ph.e1), ph.e1 | Omega
        (3 e2, 3 e2)
        """
        return self._with(0.5 * self.matrix - 0.5 * self.adjoint().matrix)

    eigenvectors = _decompositions.eigenvectors
    eigenplanes = _decompositions.eigenplanes
    svd = _decompositions.svd
    polar = _decompositions.polar

    # --- comparison

    def __eq__(self, other: object) -> Any:
        """Exact equality of algebra, grade and matrix: a bool, or an array of the batch shape."""
        if not isinstance(other, LinearMap):
            return NotImplemented
        if self.grade != other.grade or self.algebra is not other.algebra:
            return np.zeros(np.broadcast_shapes(self.shape, other.shape), dtype=bool)[()]
        return (self.matrix == other.matrix).all(axis=(-2, -1))[()]

    def __ne__(self, other: object) -> Any:
        equal = self.__eq__(other)
        return equal if equal is NotImplemented else np.logical_not(equal)[()]

    def is_close(self, other: Any, rtol: float = 1e-9, atol: float = 0.0) -> Any:
        """Whether ``|F − G| <= max(rtol · max(|F|, |G|), atol)``, |F|² the sum of the squared entries.

        Examples
        --------
        >>> F = ph.LinearMap.from_matrix(np.diag([0.1, 0.2, 0.3]))
        >>> bool((F + 2 * F).is_close(3 * F))
        True
        """
        if not isinstance(other, LinearMap) or other.grade != self.grade:
            raise TypeError(f"is_close needs another map of {_NAMES[self.grade]}, got {other!r}")
        self._require_algebra(other)
        a, b = np.broadcast_arrays(self.matrix, other.matrix)
        # A quarter, so that the difference of the largest numbers does not overflow.
        distance, p, q = (lengths(m, (-2, -1)) for m in (0.25 * a - 0.25 * b, 0.25 * a, 0.25 * b))
        return (distance <= np.maximum(rtol * np.maximum(p, q), 0.25 * atol))[()]

    def _described(self) -> str:
        of = "" if self.algebra is _G3 else f" of {self.algebra}"
        return f"LinearMap of {_NAMES[self.grade]}{of}"

    def __repr__(self) -> str:
        batch = f", shape {self.shape}" if self.shape else ""
        return f"{self._described()}{batch}, matrix\n{self.matrix!r}"

    def _repr_latex_(self) -> str:
        from polhode._algebra import format as _format

        return _format.matrix_latex(f"{type(self).__name__} of {_NAMES[self.grade]}", self.matrix)

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (np.array(self.matrix), self.grade, self.algebra)


def _refuse_factor(other: Any) -> NoReturn:
    raise TypeError(
        f"a linear map is joined to maps and multiplied by numbers, not by a {type(other).__name__}; write "
        "F(X) for a multivector X, F.matrix @ x for an array x of components"
    )


def _is_number(x: Any) -> bool:
    """Whether x may scale a map: a number, or an array as a batch."""
    return type(x) in (int, float) or isinstance(x, np.ndarray | np.number)


def _restored(matrix: Array, grade: int, algebra: Algebra) -> LinearMap:
    return LinearMap.from_matrix(matrix, grade, algebra=algebra)


def _space(algebra: Any, grade: int) -> tuple[Algebra, int]:
    """Return the algebra, 3-d space for None, and the number of its basis elements of the grade."""
    own = _G3 if algebra is None else algebra
    if not isinstance(own, Algebra):
        raise TypeError(f"the algebra must be one of ph.algebra(p, q, r), got {type(own).__name__}")
    if grade not in _NAMES:
        raise ValueError(f"a linear map takes vectors (grade 1) or bivectors (grade 2), got grade {grade!r}")
    if own.dimension < grade:
        raise ValueError(f"{own} has no {_NAMES[grade]} that a linear map could take")
    return own, math.comb(own.dimension, grade)


def _components(value: Any, algebra: Algebra, grade: int, what: str) -> Array:
    """Return the components of a value of the algebra with a single grade, as float64 if they are NumPy's."""
    if algebra is _G3:
        return _floats(one_grade(value, grade, what)._data, what)
    if not isinstance(value, Multivector) or value.algebra is not algebra:
        got = value.algebra if isinstance(value, Multivector) else type(value).__name__
        raise TypeError(f"{what} must be a value of {algebra}, got {got}")
    if value._held() & ~(1 << grade):
        raise TypeError(f"{what} must be of grade {grade}, got {value!r}, which has other grades")
    return _floats(with_grades(value, 1 << grade), what)


def _floats(data: Any, what: str) -> Array:
    if not isinstance(data, np.ndarray):
        return data  # type: ignore[no-any-return]  # of another library
    return as_coefficients(data, what, float)  # type: ignore[no-any-return]


class _OfSpace(type):
    def __instancecheck__(cls, value: object) -> bool:
        return isinstance(value, LinearMap) and value.algebra is _G3


class _MapOfSpace(metaclass=_OfSpace):
    """The type of maps of 3-d space, the only ones that compiled formulas call."""


_native.register("LinearMap", _MapOfSpace)
