"""Components of motors, the even elements of algebras of three positive generators and a null one."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _generic, _native
from polhode._algebra.coefficients import kind_of
from polhode._algebra.grades import over_grades, with_grades
from polhode._support.arrays import common_batch, is_float, new

if TYPE_CHECKING:
    from polhode._algebra.algebra import Algebra
    from polhode._algebra.multivector import Multivector

EVEN = 0b10101
_BIVECTOR = 0b100
# One basis element: its place among all, and the sign with which it stands there.
Place = tuple[int, int]


@functools.cache
def places(algebra: Algebra) -> tuple[Place, ...] | None:
    """Return where an algebra has ``1, e2e3, e3e1, e1e2, e1n, e2n, e3n, e1e2e3n``, n being its null vector.

    None if its generators are not three of square 1 and one of square 0, in any order.
    """
    vectors = [(float(e.norm_squared()), e) for e in algebra.basis_vectors]
    if sorted(square for square, _ in vectors) != [0.0, 1.0, 1.0, 1.0]:
        return None
    null = next(e for square, e in vectors if square == 0)
    a, b, c = (e for square, e in vectors if square == 1)
    elements = (algebra.scalar(1.0), b * c, c * a, a * b, a * null, b * null, c * null, a * b * c * null)
    found = []
    for element in elements:
        row = element.dense()
        k = int(np.flatnonzero(row)[0])
        found.append((k, int(row[k])))
    return tuple(found)


def is_motor(value: Any) -> bool:
    """Whether this is an even element of an algebra that has motors, by the grades that it holds."""
    return (
        isinstance(value, _native.Multivector)
        and not value._mask & ~EVEN
        and places(value.algebra) is not None
    )


def columns(value: Multivector) -> list[Any]:
    """Return the eight components (...) of an even element in the order of `places`."""
    data, algebra = with_grades(value, EVEN), value.algebra
    place = {index: k for k, index in enumerate(algebra._indices(EVEN))}
    return [data[..., place[k]] * sign for k, sign in places(algebra) or ()]


def rows(value: Multivector) -> Any:
    """Return the components (..., 8) of an even element in the order of `places`."""
    algebra = value.algebra
    held = {index: k for k, index in enumerate(algebra._indices(value._mask))}
    where, signs = zip(*(places(algebra) or ()), strict=True)
    return _generic.layout.rearranged(kind_of(value._data), value._data, [held.get(k) for k in where], signs)


def of_columns(algebra: Algebra, parts: list[Any], mask: int = EVEN) -> Multivector:
    """Return the element with these components in the order of `places`, over the grades in the mask."""
    if mask == EVEN and all(is_float(x) or isinstance(x, np.float64 | np.float32) for x in parts):
        shape = common_batch(*(part.shape for part in parts))
        found = new((*shape, len(parts)), np.result_type(*parts))
        for (index, sign), part in zip(_order(algebra), parts, strict=True):
            np.multiply(part, sign, out=found[..., index])
        return _native.Multivector._of(found, EVEN, algebra)
    at = {index: sign * part for (index, sign), part in zip(places(algebra) or (), parts, strict=True)}
    data = kind_of(*parts).stack([at[index] for index in algebra._indices(mask)])
    return _native.Multivector._of(data, mask, algebra)


def function(name: str, value: Multivector, mask: int) -> Multivector:
    """Return exp, log or sqrt of an even element of any coefficients, over the grades in the mask."""
    algebra, kind = value.algebra, kind_of(value._data)
    held, kept = (tuple(k for k in (0, 2, 4) if grades >> k & 1) for grades in (value._mask, mask))
    data = kind.asarray(value._data)
    rows = _generic.motors.function(kind, name, data, held, _order(algebra), kept)
    return _native.Multivector._of(rows, mask, algebra)


@functools.cache
def _order(algebra: Algebra) -> tuple[Place, ...]:
    """Return `places` among the even elements instead of all."""
    place = {index: k for k, index in enumerate(algebra._indices(EVEN))}
    return tuple((place[index], sign) for index, sign in places(algebra) or ())


def of_floats(name: str, value: Multivector, mask: int) -> Multivector | None:
    """Return a function of floats in the core over the grades in the mask, None unless of motors there."""
    exp = name == "exp"
    if not is_motor(value) or (exp and value._mask != _BIVECTOR):
        return None
    data = over_grades(value, _BIVECTOR if exp else EVEN)
    rows = new((*value.shape, 8), data.dtype)
    _native.motor_function(value.algebra, name, data, rows)
    result = _native.Multivector._of(rows, EVEN, value.algebra)
    return _native.Multivector._of(over_grades(result, mask), mask, value.algebra)


def normalized(value: Multivector) -> Multivector | None:
    """Return floats divided by the dual number ``√(M ~M)``, None where that has no finite value."""
    single: Multivector | None = _native.normalized_motor(value)
    if single is not None or not is_float(value._data):
        return single
    data = over_grades(value, EVEN)
    rows = new((*value.shape, 8), data.dtype)
    try:
        _native.motor_normalize(value.algebra, data, rows)
    except ValueError:
        return None
    return _native.Multivector._of(rows, EVEN, value.algebra)


def without_excess(unit: Multivector) -> Multivector:
    """Return an even element of norm 1 divided by the dual number ``√(M ~M)``.

    ``M ~M = 1 + δJ`` for the pseudoscalar J, whose square is 0; the inverse root is ``1 − ½ δJ``.
    """
    return unit - unit * (unit * ~unit).grade(4) / 2
