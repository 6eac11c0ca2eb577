"""Geometric algebras of any signature: basis, constructors and tables."""

from __future__ import annotations

import functools
import math
import operator
import re
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, NoReturn

import numpy as np

from polhode import _native
from polhode._algebra.blade_names import Blades, generators_of
from polhode._algebra.coefficients import as_coefficients, duplicate
from polhode._algebra.foreign_tables import ALGEBRA
from polhode._algebra.grades import mask_of
from polhode._algebra.multivector import Multivector
from polhode._algebra.native import joins
from polhode._support.arrays import Shape, batch_shape, normal_numbers, require_components
from polhode._support.calls import explains_calls, takes_components

_COUNTS = "ph.algebra(p, q, r), with the numbers of generators of square +1, -1 and 0"


def no_constructor(kind: type, remedy: str) -> TypeError:
    """Return the error for a call of a class of algebras.

    Each algebra exists once, because values of two equal Algebra objects would not mix.
    """
    return TypeError(f"{kind.__name__} has no public constructor; write {remedy}")


@joins(_native.Algebra)
class Algebra(_native.Algebra):
    """The geometric algebra Cl(p, q, r): p generators square to +1, q to −1, r to 0, in this order.

    Created by `algebra`, `pga` and `cga`. The basis is ordered by grade, then by rising generators
    (``e1e2, e1e3, …``); with three generators the bivectors are ``e2e3, e3e1, e1e2``. `pga` has the generator
    e0 and a basis of its own. `I` is the product of all generators.

    Examples
    --------
    Space-time, with the time e1 and three axes of negative square:

    >>> A = ph.algebra(1, 3)
    >>> t, x, y, z = A.basis_vectors
    >>> t * t, x * x, t * x + x * t
    (1, -1, 0)

    A boost to the velocity 0.6, in units of that of light:

    >>> boost = (np.arctanh(0.6) / 2 * (x ^ t)).exp()
    >>> boost(t)
    1.25 e1 + 0.75 e2
    """

    __slots__ = ()

    def __iter__(self) -> NoReturn:
        raise TypeError("an algebra has no items; write A.blades for its basis, A.basis_vectors for vectors")

    # What other libraries call them, and what to write.
    _foreign_names: ClassVar[Mapping[str, str]] = ALGEBRA

    def __init__(self, *_signature: Any, **_named: Any) -> None:
        raise no_constructor(type(self), "algebra(p, q, r), pga(n) or cga(n)")

    def __repr__(self) -> str:
        p, q, r = self.signature
        return f"Cl({p},{q},{r})" if r else f"Cl({p},{q})" if q else f"Cl({p})"

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            ours = f'blades["{name}"]' if re.fullmatch(r"e\d+", name) else self._foreign_names.get(name)
            remedy = f"; write {ours}" if ours else ""
            raise AttributeError(f"{self!r} has no attribute {name!r}{remedy}")

    def __reduce__(self) -> tuple[Any, ...]:
        return algebra, self.signature

    def _key(self) -> Any:
        """Return what `to_dict` writes: a list of three counts, or a name."""
        return list(self.signature)

    @property
    @functools.cache  # noqa: B019  # algebras live as long as the process
    def dimension(self) -> int:
        """Number of generators.

        Examples
        --------
        >>> ph.algebra(1, 3).dimension
        4
        """
        return sum(self.signature)

    @property
    def size(self) -> int:
        """Number of basis elements, ``2**dimension``.

        Examples
        --------
        >>> ph.algebra(1, 3).size
        16
        """
        return 1 << self.dimension

    @property
    def basis_vectors(self) -> tuple[Multivector, ...]:
        """The generators in their order, e1 first; of `pga` e0.

        Examples
        --------
        >>> ph.algebra(2).basis_vectors
        (e1, e2)
        """
        return self._generators()

    @property
    def blades(self) -> dict[str, Multivector]:
        """The basis elements by name, such as ``"e1∧e2"``; the scalar is ``"1"``.

        ``"e12"``, ``"e1e2"`` and ``"e1^e2"`` name the same element, ``"e21"`` its negative.

        Examples
        --------
        >>> list(ph.algebra(3).blades)
        ['1', 'e1', 'e2', 'e3', 'e2∧e3', 'e3∧e1', 'e1∧e2', 'I']
        >>> ph.algebra(3).blades["e21"]
        -e1∧e2
        """
        names = self._names(self._all)
        elements = {
            name or "1": self.multivector(row)._part(1 << int(k))
            for name, row, k in zip(names, np.eye(self.size), self._grade_of, strict=True)
        }
        return Blades(self, elements)

    @property
    def I(self) -> Multivector:  # noqa: E743  # the handout's name
        """The pseudoscalar, the product of all generators.

        Examples
        --------
        >>> I = ph.algebra(2).I
        >>> I * I
        -1
        """
        return self.pseudoscalar(1.0)

    # --- constructors

    def scalar(self, x: Any, *, dtype: Any = None) -> Multivector:
        """Create scalars from numbers; an array of shape S is a batch of shape S.

        Examples
        --------
        >>> ph.algebra(2).scalar(3)
        3
        """
        return self._single(x, "scalar", 0, dtype)

    @takes_components
    def vector(self, components: Any, *, dtype: Any = None, copy: bool = True) -> Multivector:
        """Create vectors from an array (..., n) over the generators.

        Examples
        --------
        >>> ph.algebra(4).vector([1, 2, 3, 4])
        e1 + 2 e2 + 3 e3 + 4 e4
        """
        return self._of_grade(components, "vector", 1, dtype, copy)

    @takes_components
    def bivector(self, components: Any, *, dtype: Any = None, copy: bool = True) -> Multivector:
        """Create bivectors from an array (..., n(n−1)/2) over the basis bivectors in their order.

        Examples
        --------
        >>> ph.algebra(4).bivector([1, 0, 0, 0, 0, 2])
        e1∧e2 + 2 e3∧e4
        """
        return self._of_grade(components, "bivector", 2, dtype, copy)

    @explains_calls
    def k_vector(self, k: int, components: Any, *, dtype: Any = None, copy: bool = True) -> Multivector:
        """Create values of grade k from an array (..., n over k).

        Examples
        --------
        >>> ph.algebra(4).k_vector(3, [1, 0, 0, 0])
        e1∧e2∧e3
        """
        if operator.index(k) not in range(self.dimension + 1):
            raise ValueError(f"{self} has grades 0 to {self.dimension}, got {k}")
        return self._of_grade(components, f"{k}-vector", k, dtype, copy)

    def pseudoscalar(self, x: Any, *, dtype: Any = None) -> Multivector:
        """Create multiples of I from numbers; an array of shape S is a batch of shape S.

        Examples
        --------
        >>> ph.algebra(4).pseudoscalar(2)
        2 I
        """
        return self._single(x, "pseudoscalar", self.dimension, dtype)

    @takes_components
    def multivector(self, components: Any, *, dtype: Any = None, copy: bool = True) -> Multivector:
        """Create multivectors from an array (..., 2**n) over the whole basis.

        Examples
        --------
        >>> ph.algebra(2).multivector([1, 2, 3, 4])
        1 + 2 e1 + 3 e2 + 4 I
        """
        return self._wrapped(components, "multivector", self.size, self._all, dtype, copy)

    @explains_calls
    def random(
        self,
        shape: int | Shape = (),
        *,
        grades: int | Iterable[int] | None = None,
        rng: np.random.Generator | int | None = None,
    ) -> Multivector:
        """Return values with independent components of the standard normal distribution.

        Parameters
        ----------
        shape
            The batch shape.
        grades
            A grade or several; all by default.
        rng
            A NumPy generator or a seed.

        Examples
        --------
        >>> ph.algebra(3).random(5, grades=(0, 2), rng=0).shape
        (5,)
        """
        wanted = range(self.dimension + 1) if grades is None else grades
        mask = mask_of(self, tuple(wanted) if isinstance(wanted, Iterable) else (wanted,))
        numbers = normal_numbers((*batch_shape(shape), len(self._indices(mask))), rng, "values")
        return Multivector._of(numbers, mask, self)

    def _single(self, x: Any, what: str, grade: int, dtype: Any) -> Multivector:
        data = as_coefficients(x, what, dtype, complex_too=True)
        return Multivector._of(duplicate(data)[..., None], 1 << grade, self)

    def _of_grade(self, components: Any, what: str, k: int, dtype: Any, copy: bool) -> Multivector:
        if k > self.dimension:
            raise ValueError(f"{self} has grades 0 to {self.dimension}; it has no {what}")
        return self._wrapped(components, what, math.comb(self.dimension, k), 1 << k, dtype, copy)

    def _wrapped(
        self, components: Any, what: str, size: int, mask: int, dtype: Any, copy: bool
    ) -> Multivector:
        if dtype is None and self.signature == (3, 0, 0):
            value = Multivector._of_numbers(components, mask)
            if value is not None:
                return value
        data = as_coefficients(components, what, dtype, complex_too=True)
        require_components(data.shape, size, what)
        if copy:
            data = duplicate(data)
        elif isinstance(data, np.ndarray):
            data = data.view()
        return Multivector._of(data, mask, self)

    # --- tables that values use

    @functools.cache  # noqa: B019
    def _generators(self) -> tuple[Multivector, ...]:
        return tuple(self.vector(row) for row in np.eye(self.dimension))

    @property
    def _all(self) -> int:
        """All grades, as bits."""
        return (1 << self.dimension + 1) - 1

    @property
    @functools.cache  # noqa: B019  # algebras live as long as the process
    def _grade_of(self) -> np.ndarray[Any, np.dtype[np.int64]]:
        return np.array([bits.bit_count() for bits, _ in self._blades()])

    @functools.cache  # noqa: B019
    def _names(self, mask: int) -> tuple[str, ...]:
        """Return the names of the basis elements of some grades; that of the scalar is empty."""
        blades = self._blades()
        return tuple(self._name(*blades[i]) for i in self._indices(mask))

    def _name(self, bits: int, sign: int) -> str:
        if bits.bit_count() == self.dimension > 1:
            return "I"
        return "∧".join(f"e{i + self._first()}" for i in generators_of(bits, sign))

    @functools.cache  # noqa: B019
    def _null_counts(self) -> list[int]:
        """Return the number of generators of square 0 in each basis element."""
        null = sum(1 << i for i, square in enumerate(self._squares()) if square == 0)
        return [(bits & null).bit_count() for bits, _ in self._blades()]

    def _named(self) -> dict[str, Multivector]:
        """Return values that have names besides the basis elements."""
        return {}

    @functools.cache  # noqa: B019
    def _reverse_squares(self, mask: int) -> np.ndarray[Any, np.dtype[np.int8]]:
        """Return ``E ~E`` of the basis elements of some grades: 1, −1 or 0, as int8 so that float32 stays."""
        return np.array(self._squares_of(mask), np.int8)

    @functools.cache  # noqa: B019
    def _places(self, mask: int) -> tuple[int, dict[int, slice]]:
        """Return the number of components of the grades in `mask`, and where those of each grade are."""
        places, first = {}, 0
        for k in range(self.dimension + 1):
            if mask >> k & 1:
                places[k] = slice(first, first + math.comb(self.dimension, k))
                first = places[k].stop
        return first, places

    @functools.cache  # noqa: B019
    def _complement(self, mask: int, right: bool) -> tuple[int, list[int], list[float]]:
        """Return the grades of the right or left complement of values that hold the grades in `mask`.

        And for each of its components the place of the one that becomes it, and the sign.
        """
        images = self._right_complement()
        source = (
            {image: (i, sign) for i, (image, sign) in enumerate(images)} if right else dict(enumerate(images))
        )
        grades = sum(1 << self.dimension - k for k in range(self.dimension + 1) if mask >> k & 1)
        place = {i: k for k, i in enumerate(self._indices(mask))}
        found = [source[i] for i in self._indices(grades)]
        return grades, [place[i] for i, _ in found], [sign for _, sign in found]

    @functools.cache  # noqa: B019
    def _inverse_of_I(self) -> Multivector:
        square = float((self.I * self.I).grade(0))
        if not square:
            raise TypeError(
                f"I has no inverse in {self}, whose metric is degenerate; use right_complement for dual"
            )
        return self.I / square


@explains_calls(**dict.fromkeys(("signature", "sig", "metric", "g"), _COUNTS))
def algebra(p: int, q: int = 0, r: int = 0) -> Algebra:
    """Return the algebra Cl(p, q, r) of at most 8 generators: the same object for the same signature.

    ``algebra(3)`` is the algebra of 3-d space, to which `vector`, `e1` and the others belong;
    ``algebra(3, 0, 1)`` the plane-based algebra of Euclidean space, with the null generator ``e4`` last;
    ``algebra(4, 1)`` the conformal algebra; ``algebra(1, 3)`` the algebra of space-time. `pga` and `cga` are
    the plane-based and the conformal algebra with points, lines, planes and spheres.

    Examples
    --------
    >>> ph.algebra(3, 0, 1)
    Cl(3,0,1)
    >>> ph.e1.algebra is ph.algebra(3)
    True

    The complex numbers, with one generator of square −1:

    >>> i = ph.algebra(0, 1).I
    >>> (2 + 3 * i) * (2 - 3 * i)
    13
    """
    for count in (p, q, r):
        if not hasattr(count, "__index__"):
            raise TypeError(
                f"the signature needs three whole numbers, as in algebra(3, 0, 1), got {count!r}; write "
                f"{_COUNTS}"
            )
        if isinstance(count, bool) or operator.index(count) < 0:
            raise ValueError(f"the signature needs three counts >= 0, got {p}, {q}, {r}")
    if p + q + r > 8:
        raise ValueError(f"an algebra has at most 8 generators, got {p} + {q} + {r}")
    return _algebra(operator.index(p), operator.index(q), operator.index(r))


@functools.cache
def _algebra(p: int, q: int, r: int) -> Algebra:
    if (p, q, r) == (3, 0, 0):
        return _native.g3()
    return Algebra.__new__(Algebra, p, q, r)
