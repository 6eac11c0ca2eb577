"""Vectors of Euclidean space as arguments of plane-based and conformal algebras."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any

from polhode._algebra.coefficients import as_coefficients, duplicate, kind_of
from polhode._algebra.multivector import Multivector
from polhode._support.arrays import require_components

if TYPE_CHECKING:
    from polhode._algebra.algebra import Algebra

_VECTOR = 0b10


def vector_in(space: Algebra, x: Any, what: str) -> Multivector:
    """Return a vector of Euclidean space from one, or from an array (..., n) of components."""
    if not isinstance(x, Multivector):
        data = as_coefficients(x, what)
        require_components(data.shape, space.dimension, what)
        return Multivector._of(duplicate(data), _VECTOR, space)
    if x.algebra is not space:
        raise TypeError(f"{what} must be a vector of {space} or an array, got a value of {x.algebra}")
    if x._held() & ~_VECTOR:
        remedy = "; write B.dual()" if x.grades == (2,) and space.signature == (3, 0, 0) else ""
        raise TypeError(f"{what} must be a vector, got {x!r}, which has other grades{remedy}")
    return x if x._mask == _VECTOR else x._part(_VECTOR)


def unit_in(space: Algebra, x: Any, what: str) -> Multivector:
    """Return `vector_in` divided by its norm; a ValueError, with the batch index, for zero."""
    v = vector_in(space, x, what)
    try:
        return v.normalized()
    except ValueError as error:
        raise ValueError(f"{what} is not a direction: {error}") from None


def position_in(algebra: Any, point: Any, what: str) -> Multivector:
    """Return the position of a point: one of the plane-based or conformal algebra, a vector or an array."""
    if isinstance(point, Multivector) and point.algebra == algebra:
        position: Multivector = algebra.down(point)
        return position
    return vector_in(algebra._space, point, what)


def point_and_unit(algebra: Any, point: Any, through: Any, direction: Any) -> tuple[Multivector, Multivector]:
    """Return a point of a line and its unit direction, to the point `through` or along `direction`."""
    if (through is None) == (direction is None):
        raise TypeError("a line needs a point, and either the point `through` or a `direction`")
    start = position_in(algebra, point, "the point")
    if direction is not None:
        return start, unit_in(algebra._space, direction, "the direction")
    way = position_in(algebra, through, "the point through") - start
    return start, unit_in(algebra._space, way, "the vector to the point `through`")


def columns(value: Multivector) -> list[Any]:
    """Return the components of the grades held, one by one."""
    return [value._data[..., k] for k in range(value._data.shape[-1])]


def require(ok: Any, like: Multivector, message: str) -> None:
    """Raise a ValueError with the first batch index where `ok` is known to be false."""
    kind_of(like._data).require(ok, message)


def require_value(algebra: Algebra, X: Any, what: str, grades: tuple[int, ...] | None = None) -> Multivector:
    """Return a value of the algebra that holds only these grades; a TypeError for others."""
    if not isinstance(X, Multivector) or X.algebra is not algebra:
        got = f"a value of {X.algebra}" if isinstance(X, Multivector) else type(X).__name__
        raise TypeError(f"{what} must be a value of {algebra}, got {got}")
    if grades is None:
        return X
    mask = sum(1 << k for k in grades)
    if X._held() & ~mask:
        names = " or ".join(map(str, grades))
        raise TypeError(f"{what} must be of grade {names} in {algebra}, got the grades {X.grades}")
    return X if X._mask == mask else X._part(mask)


def dimension_of(n: Any, most: int, name: str) -> int:
    """Return the dimension of Euclidean space, a whole number from 1 to `most`."""
    if not hasattr(n, "__index__") or isinstance(n, bool):
        raise TypeError(f"{name} needs the dimension of space, as in {name}(3), got {n!r}")
    if operator.index(n) not in range(1, most + 1):
        raise ValueError(f"{name} needs a dimension from 1 to {most}, got {n}")
    return operator.index(n)
