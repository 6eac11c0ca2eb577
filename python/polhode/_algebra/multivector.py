"""`Multivector`, the type of all values: multivectors with leading batch axes."""

from __future__ import annotations

import operator
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NoReturn, Self, overload

import numpy as np

from polhode import _native
from polhode._algebra import blade_names as _blade_names
from polhode._algebra import circular as _circular
from polhode._algebra import comparison as _comparison
from polhode._algebra import conjugates as _conjugates
from polhode._algebra import frames as _frames
from polhode._algebra import functions as _functions
from polhode._algebra import grades as _grades
from polhode._algebra import products as _products
from polhode._algebra import subspaces as _subspaces
from polhode._algebra import symbols as _symbols
from polhode._algebra import ufuncs as _ufuncs
from polhode._algebra import versors as _versors
from polhode._algebra.coefficients import as_coefficients
from polhode._algebra.foreign_values import has_reflected, is_foreign
from polhode._algebra.masking import masked
from polhode._algebra.native import joins
from polhode._algebra.products import coerced, is_sequence, product
from polhode._support import foreign_names as _foreign_names
from polhode._support.arrays import Shape, copied, index_message
from polhode._support.calls import explains_calls

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from polhode._algebra.algebra import Algebra


@joins(_native.Multivector)
class Multivector(_native.Multivector):
    """An element of a geometric algebra, or an array of them. Immutable.

    The basis of 3-d space is ``1, e1, e2, e3, e2e3, e3e1, e1e2, I`` in this order, ``I = e1e2e3``; for other
    algebras see `algebra`. Only the grades present are stored: a vector has 3 components, a product
    of two vectors 4 (scalar and bivector). Batch axes lead, components are the last axis, and batches
    broadcast as in NumPy.

    Coefficients are float64, float32, complex128 or complex64; whole numbers and fractions, kept exact; SymPy
    expressions; or arrays of JAX or any other array-API library.

    ``A*B`` is the geometric product, ``A^B`` the wedge, ``A|B`` the dot (the lowest grade,
    ``abs(r - s)``), ``A&B`` the regressive product `vee`, ``V>>A`` the action ``V(A)`` of a versor, ``~A``
    the reverse. Numbers and arrays act as scalars, an array as a batch.

    Python binds ``^``, ``|``, ``&`` and ``>>`` looser than ``+`` and ``*``: ``1 ^ e1 + e2`` means
    ``1 ^ (e1 + e2)``, and ``e1 | e2 * e1`` means ``e1 | (e2 * e1)``. On paper they bind tighter than
    the product. Put brackets around them, or use the named methods ``A.wedge(B)`` and ``A.dot(B)``.

    Created by `scalar`, `vector`, `bivector`, `trivector` and `multivector`, not directly.

    Examples
    --------
    The product of two vectors has a scalar and a bivector, their dot and their wedge:

    >>> a, b = ph.vector([1, 2, 0]), ph.vector([0, 3, 0])
    >>> a * b
    6 + 3 e1∧e2
    >>> a | b, a ^ b
    (6, 3 e1∧e2)
    >>> (a * b).grade(2).dual()
    3 e3

    Vectors have inverses, bivectors square to a negative number, and their exponentials are rotors:

    >>> b.inverse()
    0.33333333 e2
    >>> (ph.e1 ^ ph.e2) * (ph.e1 ^ ph.e2)
    -1
    >>> (-np.pi / 6 * (ph.e1 ^ ph.e2)).exp()
    0.8660254 - 0.5 e1∧e2

    Components have names; batches broadcast:

    >>> print(a["e2"])
    2.0
    >>> ph.vector([[1, 0, 0], [0, 1, 0]]) ^ ph.e3
    Multivector of shape (2,):
    [-e3∧e1,
     e2∧e3]
    """

    __slots__ = ()
    __array_ufunc__ = _ufuncs.Override()
    __pandas_priority__ = 5000  # above its own types, so that they leave operators to values
    variable = _ufuncs.OperandOfXarray("variable", "x.values")
    __sympy__ = False  # and so do SymPy expressions, without converting it
    __hash__ = None  # type: ignore[assignment]  # equality is by value, over arrays

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"multivectors are immutable; cannot set {name!r}")

    def __reduce__(self) -> tuple[Any, ...]:
        data = np.array(self._data) if isinstance(self._data, np.ndarray) else self._data
        return _rebuild, (type(self), data, self._mask, self.algebra)

    def __copy__(self) -> Multivector:
        return self

    def __deepcopy__(self, _memo: object) -> Multivector:
        return self

    # --- contents

    @property
    def grades(self) -> tuple[int, ...]:
        """The grades present, e.g. ``(0, 2)``.

        Examples
        --------
        >>> (ph.e1 * (ph.e1 + ph.e2)).grades
        (0, 2)
        """
        return tuple(k for k in range(self._mask.bit_length()) if self._mask >> k & 1)

    @property
    def components(self) -> NDArray[Any]:
        """Components of the grades present, in basis order: shape ``(*shape, K)``.

        A copy at each access: changing it does not change the value. In a loop over a large batch keep it in
        a variable. Arrays of other libraries are not copied.

        Examples
        --------
        >>> ph.vector([1, 2, 3]).components
        array([1., 2., 3.])
        >>> (2 + (ph.e1 ^ ph.e2)).components
        array([2., 0., 0., 1.])
        """
        data: NDArray[Any] = self._data
        return data if self._is_one else copied(data)

    def dense(self) -> NDArray[Any]:
        """Return all components in basis order, zeros where grades are absent: shape ``(*shape, 2**n)``.

        Examples
        --------
        >>> (2 + (ph.e1 ^ ph.e2)).dense()
        array([2., 0., 0., 0., 0., 0., 1., 0.])
        """
        data: NDArray[Any] = self._with_grades(self.algebra._all)
        return data

    @property
    def shape(self) -> Shape:
        """Shape of the batch; ``()`` for a single value.

        Examples
        --------
        >>> ph.vector(np.ones((5, 4, 3))).shape
        (5, 4)
        """
        return () if self._is_one else tuple(self._data.shape[:-1])

    @property
    def dtype(self) -> Any:
        """The dtype of the components: float or complex, object (exact, symbolic), or another library's."""
        return self._data.dtype

    def _grade(self, *grades: int) -> Multivector:
        """Return the part of these grades, for values that the native method does not cover."""
        return self._part(_grades.mask_of(self.algebra, grades))

    def astype(self, dtype: Any) -> Self:
        """Return the value with components of another type: ``np.float32``, ``float``, ``complex``.

        Examples
        --------
        >>> ph.e1.astype(np.float32).dtype
        dtype('float32')
        """
        return self._like(as_coefficients(self._data, "a component", dtype, complex_too=True))

    real = property(_conjugates.real)
    imag = property(_conjugates.imag)
    conj = _conjugates.conj

    map = _grades.mapped
    diff = _symbols.diff
    subs = _symbols.subs
    simplify = _symbols.simplify

    __dir__ = _foreign_names.listed

    def __bool__(self) -> bool:
        raise TypeError("a multivector has no truth value; compare it with == or is_close")

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError("a single multivector has no length; only batches have")
        return self.shape[0]

    @overload
    def __getitem__(self, index: str) -> Any: ...

    @overload
    def __getitem__(self, index: Any) -> Self: ...

    def __getitem__(self, index: Any) -> Any:
        """Return values of a batch by NumPy's indices, or a component by name.

        ``a["e12"]`` is a number, or an array of the batch shape, 0 for a grade not held. ``e12``, ``e1e2``,
        ``e1^e2`` and ``e1∧e2`` are the same, and ``a["e21"]`` is ``-a["e12"]``. The scalar is ``"1"``, the
        pseudoscalar ``"I"``.
        """
        if isinstance(index, str):
            return _blade_names.component(self, index)
        parts = index if isinstance(index, tuple) else (index,)
        # The Ellipsis keeps the index off the component axis.
        rest: tuple[Any, ...] = () if any(part is Ellipsis for part in parts) else (Ellipsis,)
        try:
            if not isinstance(self._data, np.ndarray):
                _grades.check_index(self.shape, parts)
            picked = self._data[(*parts, *rest, slice(None))]
        except IndexError as error:
            if self.shape:
                raise IndexError(index_message(error, self.shape, parts)) from None
            raise IndexError(
                f"a single value has no batch to index, got [{index!r}]; its numbers are .components or "
                '["e12"], its part of grade k is .grade(k)'
            ) from None
        return self._like(picked)

    def __setitem__(self, index: Any, value: object) -> NoReturn:
        raise TypeError(
            "multivectors are immutable; change an array, c = A.components, and make a new value of it, as "
            "by ph.vector(c)"
        )

    def __iter__(self) -> Iterator[Self]:
        if not self.shape:
            raise TypeError("a single multivector has no length and no items; its numbers are .components")
        return (self[i] for i in range(len(self)))

    reshape = _grades.reshaped
    sum = _grades.summed
    mean = explains_calls(weights="ph.mean(R, weights) for rotors, (A * w).sum() / w.sum() for others")(
        _grades.averaged
    )

    def __float__(self) -> float:
        """Return a single scalar as a float; other grades must be absent or exactly 0."""
        if (number := _native.number_of(self)) is not None:
            return number
        if self.shape or not self._mask & 1 or self._held() & ~1:
            raise TypeError(
                f"only a single scalar converts to float, got grades {self.grades} and shape {self.shape}; "
                "use .grade(0) or .components"
            )
        if self._data.dtype.kind == "c":
            raise TypeError(f"the scalar {self} is complex; use complex(value), or float(value.real)")
        return float(self._data[0])

    def __complex__(self) -> complex:
        if self._mask != 1 or self.shape:
            raise TypeError(
                f"only a single scalar converts to complex, got grades {self.grades} and shape {self.shape}; "
                "use .grade(0) or .components"
            )
        return complex(self._data[0])

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        """Return the components of a value of one grade, as a copy; a TypeError for several grades."""
        if len(self.grades) != 1:
            raise TypeError(
                f"a value of the grades {self.grades} does not convert to an array; use .components for "
                f"these grades, or .dense() for all {self.algebra.size} components"
            )
        if copy is False:
            raise ValueError("the array of a multivector is a copy; use np.asarray(value) without copy=False")
        return np.array(self._data, dtype)

    def __array_function__(self, function: Any, *_: object) -> Any:
        # Otherwise np.array_equal is False, and the errors of other functions do not help.
        remedy = _ufuncs.remedy_of(function.__name__, "use their methods or their .components")
        module = function.__module__.replace("numpy", "np", 1)
        raise TypeError(f"{module}.{function.__name__} does not accept multivectors; {remedy}")

    def __repr__(self) -> str:
        from polhode._algebra import format as _format

        return _format.value(type(self).__name__, self._data, self.algebra._names(self._mask))

    def __format__(self, spec: str) -> str:
        """Return the text with each component in this format: ``f"{a:.3f}"``."""
        from polhode._algebra import format as _format

        return _format.value(type(self).__name__, self._data, self.algebra._names(self._mask), spec)

    def _repr_latex_(self) -> str | None:
        from polhode._algebra import format as _format

        return _format.latex(type(self).__name__, self._data, self.algebra._names(self._mask))

    def _latex(self, printer: Any = None, *_: Any, **__: Any) -> str:
        """Return LaTeX without dollar signs, for ``sympy.latex``: its printer writes the coefficients."""
        from polhode._algebra import format as _format

        names = self.algebra._names(self._mask)
        show = getattr(printer, "_print", None)
        return _format.bare_latex(type(self).__name__, self._data, names, show) or rf"\text{{{self!r}}}"

    # --- helpers of methods

    def _like(self, data: Any) -> Self:
        """Return a value of the same kind and grades."""
        return self._of(data, self._mask, self.algebra)  # type: ignore[return-value]

    @staticmethod
    def _restored(data: Any, mask: int, algebra: Algebra) -> Multivector:
        return Multivector._of(data, mask, algebra)

    def _part(self, mask: int) -> Multivector:
        return self._of(self._with_grades(mask), mask, self.algebra)

    _with_grades = _grades.with_grades
    _held = _grades.held

    # --- sums and scaling, called by native operators

    def _add(self, other: Any) -> Multivector:
        return _grades.linear(self, other, operator.add)  # type: ignore[no-any-return]

    def _subtract(self, other: Any) -> Multivector:
        return _grades.linear(self, other, operator.sub)  # type: ignore[no-any-return]

    def _subtract_from(self, other: Any) -> Multivector:
        return _grades.linear(-self, other, operator.add)  # type: ignore[no-any-return]

    def _negated(self) -> Multivector:
        return self._like(-self._data)

    def __pos__(self) -> Self:
        return self

    _divide = _functions.divided

    def __rtruediv__(self, other: Any) -> Multivector:
        dividend = coerced(other, self)
        return NotImplemented if dividend is None else dividend * self.inverse()

    # --- products, called by native operators

    # These methods have docstrings, with a warning, which operators of a native type cannot have.
    __xor__ = _native.Multivector._xor
    __or__ = _native.Multivector._or

    def _product(self, name: str, other: Any) -> Multivector:
        right = coerced(other, self)
        return NotImplemented if right is None else product(name, self, right)

    def _product_from(self, name: str, other: Any) -> Multivector:
        left = coerced(other, self)
        return NotImplemented if left is None else product(name, left, self)

    def _named(self, name: str, other: Any, out: Any) -> Multivector:
        right = coerced(other, self)
        if right is None:
            raise TypeError(f"{name} needs a multivector, a number or an array, got {type(other).__name__}")
        return product(name, self, right, out)

    anticommutator = _products.anticommutator

    def __matmul__(self, other: Any) -> Any:
        if has_reflected(other, "__rmatmul__"):
            return NotImplemented
        raise TypeError(
            "@ is the product of matrices; write A * B for the geometric product and that of rotors, R(a) to "
            "turn a"
        )

    def __rmatmul__(self, other: Any) -> NoReturn:
        raise TypeError(
            "@ is the product of matrices; for a matrix M and a vector a write ph.vector(M @ a.components)"
        )

    __pow__ = _functions.power
    __rpow__ = _functions.power_of
    if TYPE_CHECKING:

        def __call__(self, X: Multivector, /) -> Multivector: ...

    else:
        __call__ = _versors.act
    __rshift__ = _versors.sandwich
    __lshift__ = _versors.unshifted

    # --- involutions

    def _reversed(self) -> Multivector:
        return _grades.signed(self, lambda k: k % 4 in (2, 3))

    def grade_involution(self) -> Multivector:
        """Reverse the sign of odd grades.

        Examples
        --------
        >>> (1 + ph.e1 + (ph.e1 ^ ph.e2) + ph.I).grade_involution()
        1 - e1 + e1∧e2 - I
        """
        return _grades.signed(self, lambda k: k % 2 == 1)

    def clifford_conjugate(self) -> Multivector:
        """Reverse and grade involution: the sign of grades 1, 2, 5, 6 is reversed.

        Examples
        --------
        >>> (1 + ph.e1 + (ph.e1 ^ ph.e2) + ph.I).clifford_conjugate()
        1 - e1 - e1∧e2 + I
        """
        return _grades.signed(self, lambda k: k % 4 in (1, 2))

    def dual(self) -> Multivector:
        """``A I⁻¹``: the dual of a bivector of 3-d space is its axial vector, ``dual(e1∧e2) = e3``.

        A TypeError where I has no inverse, as in Cl(3,0,1); use `right_complement` there.

        Examples
        --------
        >>> (ph.e1 ^ ph.e2).dual()
        e3
        >>> ph.e3.dual()
        -e1∧e2
        """
        return self * _functions.as_precise(self.algebra._inverse_of_I(), self)

    def undual(self) -> Multivector:
        """``A I``, the inverse of `dual`.

        Examples
        --------
        >>> ph.e3.undual()
        e1∧e2
        >>> ph.e3.undual().dual()
        e3
        """
        self.algebra._inverse_of_I()
        return self * _functions.as_precise(self.algebra.I, self)

    # --- subspaces

    right_complement = _subspaces.right_complement
    left_complement = _subspaces.left_complement
    vee = _subspaces.vee
    __and__, __rand__ = _subspaces.regressive, _subspaces.regressive_from
    join = _subspaces.join
    meet = _subspaces.meet
    project = _subspaces.project
    reject = _subspaces.reject
    reflect = _subspaces.reflect
    factor = _frames.factor

    # --- norms

    norm_squared = _functions.norm_squared
    norm = __abs__ = _functions.norm
    normalized = _functions.normalized

    # --- functions; with errors="mask", rows without a value are NaN: see `is_finite`

    def _masked(self, function: str, errors: str) -> Any:
        """Return ``inverse``, ``exp``, ``log`` or ``sqrt`` with these errors, for the native methods."""
        return masked(errors, operator.methodcaller(function), (self, 1))

    # Called by native methods.
    def _function(self, name: str) -> Multivector:
        return _functions.exp(self) if name == "exp" else _functions.function(name, self)

    sin, cos, tan = _circular.sin, _circular.cos, _circular.tan
    sinh, cosh, tanh = _circular.sinh, _circular.cosh, _circular.tanh
    outer_exp = _circular.outer_exp

    # --- comparison, called by native operators

    def _equals(self, other: object) -> Any:
        if is_foreign(other) or is_sequence(other):  # not equal to any, as of numbers and other types
            return NotImplemented
        right = coerced(other, self)
        return NotImplemented if right is None else _comparison.equal(self, right)

    def _differs(self, other: object) -> Any:
        same = self._equals(other)
        if same is NotImplemented:
            return same
        return not same if isinstance(same, bool) else ~same

    is_close = _comparison.is_close
    is_finite = _comparison.is_finite


def _rebuild(cls: type[Multivector], data: Any, mask: int, algebra: Algebra) -> Multivector:
    return cls._restored(data, mask, algebra)
