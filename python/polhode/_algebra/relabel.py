"""Values of one algebra as values of another that has the same generators under other names."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._algebra.blade_names import generators_of
from polhode._algebra.coefficients import kind_of
from polhode._algebra.multivector import Multivector
from polhode._support.arrays import is_float

if TYPE_CHECKING:
    from polhode._algebra.algebra import Algebra


def embedded(X: Any, target: Algebra, places: Mapping[Algebra, Sequence[int]]) -> Multivector:
    """Return a value of one of these algebras, or of the target itself, in the target."""
    if not isinstance(X, Multivector):
        raise TypeError(f"embed needs a multivector, got {type(X).__name__}")
    if X.algebra is target:
        return X
    if X.algebra not in places:
        known = " or ".join(map(str, places))
        raise TypeError(f"{target} contains values of {known}, got one of {X.algebra}")
    return relabelled(X, target, places[X.algebra])


def relabelled(value: Multivector, target: Algebra, places: Sequence[int | None]) -> Multivector:
    """Return the value with generator i of its algebra replaced by generator ``places[i]`` of the target.

    Basis elements with a generator that has no place are dropped, as are grades that the target lacks.
    """
    data, mask = value._data, value._mask & target._all or 1
    size, columns = _columns(value.algebra, value._mask, target, tuple(places))
    if is_float(data):
        rows = np.zeros((*data.shape[:-1], size), dtype=data.dtype)
        for column, (k, sign) in columns.items():
            rows[..., column] = sign * data[..., k]
        return Multivector._of(rows, mask, target)
    kind = kind_of(data)
    zero = kind.zeros_like(data[..., 0])
    parts = [zero] * size
    for column, (k, sign) in columns.items():
        parts[column] = data[..., k] if sign > 0 else -data[..., k]
    return Multivector._of(kind.stack(parts), mask, target)


@functools.cache
def _columns(
    source: Algebra, mask: int, target: Algebra, places: tuple[int | None, ...]
) -> tuple[int, dict[int, tuple[int, int]]]:
    """Return the number of components of the relabelled value, and which become some of them, with signs."""
    wanted = target._indices(mask & target._all or 1)
    where = {bits: (index, sign) for index, (bits, sign) in enumerate(target._blades())}
    columns: dict[int, tuple[int, int]] = {}
    for k, element in enumerate(source._indices(mask)):
        moved = [places[i] for i in generators_of(*source._blades()[element])]
        found = [place for place in moved if place is not None]
        if len(found) < len(moved):
            continue
        swaps = sum(a > b for i, a in enumerate(found) for b in found[i + 1 :])
        index, sign = where[sum(1 << place for place in found)]
        columns[wanted.index(index)] = k, -sign if swaps % 2 else sign
    return len(wanted), columns
