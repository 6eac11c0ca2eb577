"""The values of the algebra: multivectors with leading batch axes."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _format, _native
from polhode._arrays import Array, Shape, as_floats, common_batch, frozen, rows

if TYPE_CHECKING:
    from polhode._rotor import Rotor

_SCALAR, _VECTOR, _BIVECTOR, _TRIVECTOR = 0b0001, 0b0010, 0b0100, 0b1000
_EVEN, _ALL = 0b0101, 0b1111
_GRADE_OF = np.array([0, 1, 1, 1, 2, 2, 2, 3])
_INDICES = [_native.component_indices(mask) for mask in range(16)]


class Multivector:
    """An element of the geometric algebra of 3-d space, or an array of them. Immutable.

    The basis is ``1, e1, e2, e3, e2e3, e3e1, e1e2, I`` in this order, ``I = e1e2e3``. Only the grades
    present are stored: a vector has 3 components, a product of two vectors 4 (scalar and bivector).
    Batch axes lead, components are the last axis, and batches broadcast as in NumPy.

    ``A*B`` is the geometric product, ``A^B`` the wedge, ``A|B`` the dot (the lowest grade,
    ``abs(r - s)``), ``~A`` the reverse. Numbers and NumPy arrays act as scalars, an array as a batch.

    Python binds ``^`` and ``|`` *looser* than ``+`` and ``*``: ``1 ^ e1 + e2`` means ``1 ^ (e1 + e2)``,
    and ``e1 | e2 * e1`` means ``e1 | (e2 * e1)``. On paper they bind tighter than the product. Put
    brackets around them, or use the named methods ``A.wedge(B)`` and ``A.dot(B)``.

    Made by `scalar`, `vector`, `bivector`, `trivector` and `multivector`, not directly.
    """

    __slots__ = ("_data", "_mask")
    __array_ufunc__ = None  # NumPy arrays leave mixed operations to this class
    __hash__ = None  # type: ignore[assignment]  # equality is by value, over arrays

    _data: Array
    _mask: int

    def __init__(self, *_: object) -> None:
        raise TypeError(
            f"{type(self).__name__} is not made directly; use ph.vector, ph.bivector, ph.multivector, "
            "or one of the Rotor.from_… constructors"
        )

    @classmethod
    def _of(cls, data: Array, mask: int) -> Multivector:
        """Wrap an array (..., K) that nobody else writes to; K components of the grades in `mask`.

        The kernels read rows, so the array is brought into C order if it is not.
        """
        self = object.__new__(cls)
        object.__setattr__(self, "_data", frozen(np.ascontiguousarray(data)))
        object.__setattr__(self, "_mask", mask)
        return self

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"multivectors are immutable; cannot set {name!r}")

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuild, (type(self), np.array(self._data), self._mask)

    # --- what it holds

    @property
    def grades(self) -> tuple[int, ...]:
        """The grades it may hold, e.g. ``(0, 2)``."""
        return tuple(k for k in range(4) if self._mask >> k & 1)

    @property
    def components(self) -> Array:
        """Components of the grades present, in basis order: shape ``(*shape, K)``, read-only."""
        return self._data

    @property
    def shape(self) -> Shape:
        """Shape of the batch; ``()`` for a single value."""
        return self._data.shape[:-1]

    @property
    def dtype(self) -> np.dtype[np.float64]:
        """The components' type, float64."""
        return self._data.dtype

    def grade(self, k: int) -> Multivector:
        """Return the part of grade k (0 to 3); zero if it holds none."""
        if operator.index(k) not in range(4):
            raise ValueError(f"3-d space has grades 0 to 3, got {k}")
        return Multivector._of(self._with_grades(1 << k), 1 << k)

    def __bool__(self) -> bool:
        raise TypeError("a multivector is neither true nor false; compare it with == or is_close")

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError("a single multivector has no length; only batches have")
        return self.shape[0]

    def __getitem__(self, index: Any) -> Multivector:
        parts = index if isinstance(index, tuple) else (index,)
        # The Ellipsis keeps the index off the component axis.
        rest: tuple[Any, ...] = () if any(part is Ellipsis for part in parts) else (Ellipsis,)
        try:
            picked = self._data[(*parts, *rest, slice(None))]
        except IndexError as error:
            raise IndexError(f"{error} (batch shape {self.shape})") from None
        return self._of(picked, self._mask)

    def __iter__(self) -> Iterator[Multivector]:
        return (self[i] for i in range(len(self)))

    def __float__(self) -> float:
        if self._mask != _SCALAR or self.shape:
            raise TypeError(
                f"only a single scalar becomes a float; this has grades {self.grades} and shape "
                f"{self.shape}; take .grade(0) or .components"
            )
        return float(self._data[0])

    def __repr__(self) -> str:
        return _format.value(type(self).__name__, self._data, _INDICES[self._mask])

    # --- sums and scaling

    def _with_grades(self, mask: int) -> Array:
        """Return the components of the grades in `mask`, zeros for those not held: a new array."""
        if mask == self._mask:
            return np.array(self._data)
        full = np.zeros((*self.shape, 8))
        full[..., _INDICES[self._mask]] = self._data
        return np.ascontiguousarray(full[..., _INDICES[mask]])

    def _held(self) -> int:
        """Return the grades, as bits, in which some component is not zero."""
        nonzero = (self._data != 0).reshape(-1, self._data.shape[-1]).any(axis=0)
        return int(np.bitwise_or.reduce(1 << _GRADE_OF[_INDICES[self._mask]][nonzero], initial=0))

    def _linear(self, other: Any, combine: Any) -> Any:
        """Add or subtract, over the grades of both."""
        other = _coerced(other)
        if other is None:
            return NotImplemented
        mask = self._mask | other._mask
        with np.errstate(over="ignore", invalid="ignore"):  # IEEE, as in the products
            return Multivector._of(combine(self._with_grades(mask), other._with_grades(mask)), mask)

    def __add__(self, other: Any) -> Multivector:
        return self._linear(other, np.add)  # type: ignore[no-any-return]

    def __radd__(self, other: Any) -> Multivector:
        return self._linear(other, np.add)  # type: ignore[no-any-return]

    def __sub__(self, other: Any) -> Multivector:
        return self._linear(other, np.subtract)  # type: ignore[no-any-return]

    def __rsub__(self, other: Any) -> Multivector:
        return (-self)._linear(other, np.add)  # type: ignore[no-any-return]

    def __neg__(self) -> Multivector:
        return self._of(-self._data, self._mask)

    def __pos__(self) -> Multivector:
        return self

    def __truediv__(self, other: Any) -> Multivector:
        """``A/s``, and ``A/B = A B⁻¹``."""
        divisor = _coerced(other)
        if divisor is None:
            return NotImplemented
        if divisor._mask != _SCALAR:
            return self * divisor.inverse()
        if not divisor._data.all():
            index = tuple(int(i) for i in np.argwhere(divisor._data[..., 0] == 0)[0])
            raise ZeroDivisionError(
                "division of a multivector by zero" + (f" at index {index}" if index else "")
            )
        with np.errstate(over="ignore", invalid="ignore"):
            return Multivector._of(self._data / divisor._data, self._mask)

    def __rtruediv__(self, other: Any) -> Multivector:
        dividend = _coerced(other)
        return NotImplemented if dividend is None else dividend * self.inverse()

    # --- products

    def _product(self, name: str, other: Any) -> Multivector:
        right = _coerced(other)
        if right is None:
            return NotImplemented  # type: ignore[no-any-return]
        batch = common_batch(self.shape, right.shape)
        left_rows, right_rows = rows(self._data, batch), rows(right._data, batch)
        count = math.prod(batch)
        data, mask = _native.product(name, left_rows, self._mask, right_rows, right._mask, count)
        return Multivector._of(data.reshape(*batch, data.shape[-1]), mask)

    def _named(self, name: str, other: Any) -> Multivector:
        result = self._product(name, other)
        if result is NotImplemented:
            raise TypeError(f"{name} needs a multivector, a number or an array, got {type(other).__name__}")
        return result

    def __mul__(self, other: Any) -> Multivector:
        return self._product("geometric", other)

    def __rmul__(self, other: Any) -> Multivector:
        left = _coerced(other)
        return NotImplemented if left is None else left._product("geometric", self)

    def __xor__(self, other: Any) -> Multivector:
        """``A^B``, the wedge. Binds looser than ``+``: bracket it, or call `wedge`."""
        return self._product("wedge", other)

    def __rxor__(self, other: Any) -> Multivector:
        left = _coerced(other)
        return NotImplemented if left is None else left._product("wedge", self)

    def __or__(self, other: Any) -> Multivector:
        """``A|B``, the dot. Binds looser than ``+``: bracket it, or call `dot`."""
        return self._product("dot", other)

    def __ror__(self, other: Any) -> Multivector:
        left = _coerced(other)
        return NotImplemented if left is None else left._product("dot", self)

    def wedge(self, other: Any) -> Multivector:
        """``A∧B``, the highest grade r + s of the product (handout eq. 1.10)."""
        return self._named("wedge", other)

    def dot(self, other: Any) -> Multivector:
        """``A·B``, the lowest grade abs(r − s) of the product, scalars included: ``3·a = 3a``."""
        return self._named("dot", other)

    def commutator(self, other: Any) -> Multivector:
        """``A×B = ½(AB − BA)``; not the vector cross product, which is `cross`."""
        return self._named("commutator", other)

    def left_contraction(self, other: Any) -> Multivector:
        """``A⌋B``, grade s − r; zero where r > s."""
        return self._named("left_contraction", other)

    def right_contraction(self, other: Any) -> Multivector:
        """``A⌊B``, grade r − s; zero where r < s."""
        return self._named("right_contraction", other)

    def scalar_product(self, other: Any) -> Multivector:
        """``⟨AB⟩``, grade 0."""
        return self._named("scalar", other)

    def __pow__(self, n: Any) -> Multivector:
        """Integer powers, negative ones through the inverse."""
        try:
            exponent = operator.index(n)
        except TypeError:
            raise TypeError(
                f"a multivector has integer powers, got {n!r}; write (n * A.log()).exp() for others"
            ) from None
        base = self.inverse() if exponent < 0 else self
        exponent = abs(exponent)
        if exponent == 0:
            return scalar(np.ones(self.shape))
        power: Multivector | None = None
        while True:
            if exponent & 1:
                power = base if power is None else power * base
            exponent >>= 1
            if not exponent:
                return power  # type: ignore[return-value]
            base = base * base

    # --- involutions

    def _signed(self, negative: tuple[int, ...]) -> Multivector:
        grades = _GRADE_OF[_INDICES[self._mask]]
        return self._of(np.where(np.isin(grades, negative), -self._data, self._data), self._mask)

    def reverse(self) -> Multivector:
        """``~A``: reverses the order of all products; grades 2 and 3 change sign (handout eq. 1.28)."""
        return self._signed((2, 3))

    def __invert__(self) -> Multivector:
        return self.reverse()

    def grade_involution(self) -> Multivector:
        """Odd grades change sign."""
        return Multivector._signed(self, (1, 3))

    def clifford_conjugate(self) -> Multivector:
        """Reverse and grade involution: grades 1 and 2 change sign."""
        return self._signed((1, 2))

    def dual(self) -> Multivector:
        """``A I⁻¹``: the dual of a bivector is its axial vector, ``dual(e1∧e2) = e3``."""
        return self * -_I

    def undual(self) -> Multivector:
        """``A I``, the inverse of `dual`."""
        return self * _I

    # --- sizes

    def norm_squared(self) -> Any:
        """``⟨A ~A⟩``, the sum of the squared components (infinite beyond 1e308): of the batch shape."""
        with np.errstate(over="ignore"):
            return np.square(self._data).sum(axis=-1)[()]

    def norm(self) -> Any:
        """``√⟨A ~A⟩`` without overflow on the way: a float, or an array of the batch shape."""
        return _native.norm(self._with_grades(_ALL))[..., 0][()]

    def normalized(self) -> Multivector:
        """``A/|A|``; zero and non-finite values are an error."""
        # Scaling by the largest component first keeps subnormal values accurate.
        largest = np.abs(self._data).max(axis=-1, keepdims=True)
        _require(
            np.isfinite(largest[..., 0]) & (largest[..., 0] > 0), "has no direction (norm {})", self.norm()
        )
        scaled = self._data / largest
        return self._of(scaled / np.linalg.norm(scaled, axis=-1, keepdims=True), self._mask)

    # --- functions

    def _function(self, name: str) -> Multivector:
        full, mask = _native.function(name, self._with_grades(_ALL), self._mask)
        return Multivector._of(full[..., _INDICES[mask]], mask)

    def inverse(self) -> Multivector:
        """``A⁻¹``. A ValueError, with the batch index, where A is singular to rounding (``1 + e1``)."""
        return self._function("inverse")

    def exp(self) -> Multivector | Rotor:
        """``exp A``; of a bivector it is a `Rotor`, ``exp(−Bθ/2)`` turning by θ in the plane B.

        A value such as ``e1*e2``, whose scalar is exactly 0, counts as a bivector.
        """
        result = self._function("exp")
        if result._mask != _EVEN or self._held() & ~_BIVECTOR:
            return result
        from polhode._rotor import Rotor

        return Rotor._of(result._data, _EVEN)

    def log(self) -> Multivector:
        """Return a logarithm: ``exp(log A) = A``.

        Even elements (scalar and bivector) have an even one, so that ``log(−1) = π e1∧e2``; others the
        principal one. A ValueError, with the batch index, where A is singular.
        """
        return self._function("log")

    def sqrt(self) -> Multivector:
        """Return a square root; of an even element the half-way one, ``√(−1) = e1∧e2``."""
        return self._function("sqrt")

    # --- geometry

    def project(self, blade: Multivector) -> Multivector:
        """Return the part in the subspace of `blade`: ``(A⌋B) B⁻¹`` (a∥ of handout eq. 1.7)."""
        if not isinstance(blade, Multivector) or blade._held().bit_count() > 1:
            raise TypeError(f"the subspace must be a value of one grade, such as e1 or e1^e2, got {blade!r}")
        unit = blade.normalized()  # so that nothing overflows
        projected = self.left_contraction(unit) * unit.inverse()
        return Multivector._of(projected._with_grades(self._mask), self._mask)

    def reject(self, blade: Multivector) -> Multivector:
        """Return the part perpendicular to the subspace of `blade`: A minus its projection."""
        return self - self.project(blade)

    def reflect(self, n: Multivector) -> Multivector:
        """Return the value in the mirror perpendicular to the vector n: ``−n a n⁻¹`` for a vector a.

        ``n X̂ n⁻¹`` for any X, with X̂ its grade involution, so that mirrors respect ``∧``: scalars stay, I
        changes sign. The mirror that is the plane of a bivector B has the normal ``B.dual()``.
        """
        from polhode._geometry import reflected

        return reflected(self, n)

    # --- comparison

    def __eq__(self, other: object) -> Any:
        """Exact equality of all components: a bool, or an array of the batch shape."""
        right = _coerced(other)
        if right is None:
            return NotImplemented
        mask = self._mask | right._mask
        return (self._with_grades(mask) == right._with_grades(mask)).all(axis=-1)[()]

    def __ne__(self, other: object) -> Any:
        equal = self.__eq__(other)
        return equal if equal is NotImplemented else np.logical_not(equal)[()]

    def is_close(self, other: Any, rtol: float = 1e-9, atol: float = 0.0) -> Any:
        """Whether ``|A − B| <= max(rtol · max(|A|, |B|), atol)``: a bool, or an array of the batch shape."""
        right = _coerced(other)
        if right is None:
            raise TypeError(f"cannot compare a multivector with {type(other).__name__}")
        if np.any(np.less(rtol, 0)) or np.any(np.less(atol, 0)):
            raise ValueError(f"rtol and atol must not be negative, got {rtol} and {atol}")
        mask = self._mask | right._mask
        a, b = np.broadcast_arrays(self._with_grades(mask), right._with_grades(mask))
        # Measured in units of the largest component, so that nothing overflows.
        unit = np.maximum(np.abs(a), np.abs(b)).max(axis=-1, keepdims=True)
        unit = np.where(np.isfinite(unit) & (unit > 0), unit, 1.0)
        with np.errstate(invalid="ignore"):  # inf − inf and NaN are not close
            a, b = a / unit, b / unit
            distance = np.linalg.norm(a - b, axis=-1)
            size = np.maximum(np.linalg.norm(a, axis=-1), np.linalg.norm(b, axis=-1))
            close = np.isfinite(size) & (distance <= np.maximum(rtol * size, atol / unit[..., 0]))
        return np.logical_or(close, self == right)[()]


def _rebuild(cls: type[Multivector], data: Array, mask: int) -> Multivector:
    """Restore a pickled value."""
    return cls._of(data, mask)


def _coerced(value: Any) -> Multivector | None:
    """Return a multivector; a number or numeric array becomes scalars; None for anything else."""
    if isinstance(value, Multivector):
        return value
    if isinstance(value, bool):
        return None
    if isinstance(value, int | float) or (
        isinstance(value, np.ndarray | np.number) and value.dtype.kind in "iuf"
    ):
        return scalar(value)
    return None


def _require(ok: Any, what: str, value: Any) -> None:
    """Raise a ValueError that names the first batch index where `ok` is false, and the value there."""
    if np.all(ok):
        return
    index = tuple(int(i) for i in np.argwhere(~np.asarray(ok))[0])
    place = f"the multivector at index {index}" if index else "the multivector"
    raise ValueError(f"{place} {what.format(np.asarray(value)[index])}")


def scalar(a: Any) -> Multivector:
    """Scalars from numbers; an array of shape S is a batch of shape S."""
    return Multivector._of(np.array(as_floats(a, "scalar"))[..., np.newaxis], _SCALAR)


_I = Multivector._of(np.ones(1), _TRIVECTOR)
