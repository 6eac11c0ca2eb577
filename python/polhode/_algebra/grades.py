"""Grades of values: selection, signs and sums; shapes of batches."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from polhode import _generic, _native
from polhode._algebra.coefficients import as_coefficients, common, duplicate, kind_of, namespace
from polhode._algebra.coefficients import reshaped as coefficients_reshaped
from polhode._algebra.foreign_values import remedy_for
from polhode._algebra.products import coerced, common_algebra
from polhode._support.arrays import Shape, common_batch, is_float, new
from polhode._support.calls import explains_calls
from polhode._support.memory import require_array

if TYPE_CHECKING:
    from polhode._algebra.algebra import Algebra
    from polhode._algebra.multivector import Multivector

V = TypeVar("V", bound="Multivector")

# Up to this many numbers NumPy multiplies faster than a call of the core takes.
_FEW = 256


def mask_of(algebra: Algebra, grades: Sequence[int]) -> int:
    """Return these grades as bits; an error for one that the algebra does not have."""
    n, mask = algebra.dimension, 0
    for k in grades:
        if not hasattr(k, "__index__"):
            raise TypeError(f"grades are whole numbers, as in grade(1, 3), got {k!r}")
        if operator.index(k) not in range(n + 1):
            space = "3-d space" if algebra.signature == (3, 0, 0) else str(algebra)
            raise ValueError(f"{space} has grades 0 to {n}, got {k}")
        mask |= 1 << operator.index(k)
    if not mask:
        raise TypeError("grade needs at least one grade, as in grade(1, 3)")
    return mask


def with_grades(value: Multivector, mask: int) -> Any:
    """Return the components of the grades in `mask`, zeros for those not held: a new array."""
    data = value._data
    if mask == value._mask:
        return np.array(data) if isinstance(data, np.ndarray) else data
    algebra = value.algebra
    if is_float(data):
        (_, own), (count, new) = algebra._places(value._mask), algebra._places(mask)
        shape = (*data.shape[:-1], count)
        require_array(shape, "values", data.itemsize)
        found = np.zeros(shape, dtype=data.dtype)
        for k in own.keys() & new.keys():
            found[..., new[k]] = data[..., own[k]]
        return found
    held, wanted = algebra._indices(value._mask), algebra._indices(mask)
    place = {index: k for k, index in enumerate(held)}
    return _generic.layout.rearranged(kind_of(data), data, [place.get(i) for i in wanted])


def over_grades(value: Multivector, mask: int) -> Any:
    """Return the components of the grades in `mask`, read-only: a copy only if grades are missing."""
    return value._data if value._mask == mask else with_grades(value, mask)


def held(value: Multivector) -> int:
    """Return the grades, as bits, with a nonzero component; all of them if that is not known."""
    data = value._data
    if not isinstance(data, np.ndarray):
        return value._mask
    nonzero = (data != 0).reshape(-1, data.shape[-1]).any(axis=0)
    grades = value.algebra._grade_of[value.algebra._indices(value._mask)]
    return int(np.bitwise_or.reduce(1 << grades[nonzero.astype(bool)], initial=0))


def linear(left: Multivector, right: Any, combine: Callable[[Any, Any], Any]) -> Any:
    """Add or subtract, over the grades of both."""
    other = coerced(right, left)
    if other is None:
        return NotImplemented
    algebra = common_algebra(left, other)
    mask = left._mask | other._mask
    a, b = common(over_grades(left, mask), over_grades(other, mask))
    if a.shape != b.shape:
        batch = common_batch(left.shape, other.shape)
        if is_float(a):
            require_array((*batch, a.shape[-1]), "values", a.itemsize)
    with np.errstate(over="ignore", invalid="ignore"):  # IEEE, as in the products
        return _native.Multivector._of(combine(a, b), mask, algebra)


def signed(value: Multivector, negative: Callable[[int], bool]) -> Multivector:
    """Return the value with the sign of some grades reversed."""
    grades = value.algebra._grade_of[value.algebra._indices(value._mask)]
    return value._like(with_signs(value._data, [-1 if negative(int(k)) else 1 for k in grades]))


def with_signs(data: Any, signs: Sequence[float]) -> Any:
    """Return the components times these signs."""
    if is_float(data):
        factors = np.array(signs, dtype=data.dtype)
        if data.size < _FEW:
            return data * factors
        result = new(data.shape, data.dtype)
        _native.with_signs(data.reshape(-1, len(signs)), factors, result.reshape(-1, len(signs)))
        return result
    return _generic.layout.rearranged(kind_of(data), data, range(len(signs)), tuple(signs))


def mapped(value: Multivector, f: Callable[[Any], Any]) -> Multivector:
    """Return the value with each component changed by f, such as ``sympy.simplify``; never a rotor.

    Components of dtype object are passed one by one, others as one array.

    Examples
    --------
    >>> ph.vector([1.2, -3.7, 0.1]).map(np.round)
    e1 - 4 e2
    """
    data = value._data
    changed = np.frompyfunc(f, 1, 1)(data) if data.dtype == object else f(data)
    if getattr(changed, "shape", None) != data.shape:
        raise TypeError(f"the function must return one component for each, got {type(changed).__name__}")
    changed = as_coefficients(changed, "what the function returns", complex_too=True)
    own = duplicate(changed)  # f may keep its array
    return _native.Multivector._of(own, value._mask, value.algebra)


def check_index(shape: Shape, index: tuple[Any, ...]) -> None:
    """Raise an IndexError for a plain index out of range, which JAX would clip to the last one."""
    if all(part is None or part is Ellipsis or isinstance(part, int | np.integer | slice) for part in index):
        np.broadcast_to(np.int8(0), shape)[index]


def reshaped(value: V, *shape: Any) -> V:
    """Return a batch of another shape; one length may be −1. ``reshape(2, 3)`` or ``reshape((2, 3))``.

    Examples
    --------
    >>> ph.vector(np.ones((6, 3))).reshape(2, -1).shape
    (2, 3)
    """
    if len(shape) == 1 and not hasattr(shape[0], "__index__"):
        shape = tuple(shape[0])
    lengths = [operator.index(length) for length in shape]
    data, count = value._data, math.prod(value.shape)
    known = math.prod(length for length in lengths if length != -1)
    if lengths.count(-1) == 1 and known and count % known == 0:
        lengths[lengths.index(-1)] = count // known
    if -1 in lengths or math.prod(lengths) != count:
        raise ValueError(f"a batch of shape {value.shape} cannot be reshaped to {tuple(lengths)}")
    return value._like(coefficients_reshaped(data, (*lengths, data.shape[-1])))


@explains_calls
def stack(values: Iterable[V], axis: int = 0) -> V:
    """Join values of equal batch shape along a new batch axis; rotors give rotors.

    Values of different grades are joined over the grades of all. `axis` counts batch axes.

    Examples
    --------
    >>> axes = ph.stack([ph.e1, ph.e2, ph.e3])
    >>> axes.shape
    (3,)
    >>> axes | ph.vector([1, 2, 3])
    Multivector of shape (3,):
    [1,
     2,
     3]
    """
    parts, shapes, build = _unified(values, "stack")
    if len(shapes) > 1:
        raise ValueError(f"stack needs values of one batch shape, got {_listed(shapes)}")
    axis = _batch_axis(axis, len(next(iter(shapes))) + 1)
    return build(namespace(parts[0]).stack(parts, axis=axis))  # type: ignore[return-value]


def summed(value: Multivector, axis: int | tuple[int, ...] | None = None) -> Multivector:
    """Return the sum of a batch over some of its axes, or all; a sum of rotors is not a rotor.

    Examples
    --------
    >>> ph.vector([[1, 0, 0], [0, 2, 0]]).sum()
    e1 + 2 e2
    """
    count = len(value.shape)
    chosen = tuple(range(count)) if axis is None else axis if isinstance(axis, tuple) else (axis,)
    axes = tuple(_batch_axis(k, count) for k in chosen)
    total = namespace(value._data).sum(value._data, axis=axes)
    return _native.Multivector._of(total, value._mask, value.algebra)


def averaged(value: Multivector, axis: int | tuple[int, ...] | None = None) -> Multivector:
    """Return the mean of a batch over some of its axes, or all. Of rotors a TypeError: see `ph.mean`.

    Examples
    --------
    >>> ph.vector([[1, 0, 0], [0, 2, 0]]).mean()
    0.5 e1 + e2
    """
    if isinstance(value, _native.Rotor):
        raise TypeError("the mean of components is not a rotor; use ph.mean(R) for the mean attitude")
    total = summed(value, axis)
    count = math.prod(value.shape) // (math.prod(total.shape) or 1)
    if not math.prod(value.shape):
        raise ValueError(f"mean needs at least one value, got a batch of shape {value.shape}")
    return total / count


@explains_calls
def concatenate(values: Iterable[V], axis: int = 0) -> V:
    """Join batches along an existing batch axis; rotors give rotors. `axis` counts batch axes.

    Examples
    --------
    >>> two = ph.vector([[1, 0, 0], [0, 1, 0]])
    >>> ph.concatenate([two, 10 * two])["e1"]
    array([ 1.,  0., 10.,  0.])
    """
    parts, shapes, build = _unified(values, "concatenate")
    dimensions = {len(shape) for shape in shapes}
    if dimensions == {0}:
        raise ValueError("concatenate joins batches, got single values; join them with ph.stack")
    if len(dimensions) > 1:
        raise ValueError(f"concatenate needs equal numbers of batch axes, got shapes {_listed(shapes)}")
    axis = _batch_axis(axis, dimensions.pop())
    if len({shape[:axis] + shape[axis + 1 :] for shape in shapes}) > 1:
        raise ValueError(f"the batch shapes must agree except in axis {axis}, got {_listed(shapes)}")
    return build(namespace(parts[0]).concat(parts, axis=axis))  # type: ignore[return-value]


def _listed(shapes: Iterable[Shape]) -> str:
    return " and ".join(str(shape) for shape in sorted(shapes, key=str))


def _batch_axis(axis: int, count: int) -> int:
    place = operator.index(axis)
    if not -count <= place < count:
        raise ValueError(f"batch axis {axis} is out of range for {count} batch axes")
    return place % count


def _unified(
    values: Iterable[Multivector], name: str
) -> tuple[list[Any], set[Shape], Callable[[Any], Multivector]]:
    """Return components over the grades of all values, their batch shapes, and the type's constructor."""
    given: Any = values
    if isinstance(values, _native.Multivector) and not given.shape:
        raise TypeError(f"{name} takes a list of values, as in {name}([a, b]), got the single value {values}")
    of_transforms = f"RigidTransform.{name}([S, T])"
    if remedy := remedy_for(given, of_transforms):
        raise TypeError(f"{name} joins multivectors, got {type(values).__name__}{remedy}")
    items: list[Any] = list(values)
    for i, item in enumerate(items):
        if not isinstance(item, _native.Multivector):
            remedy = remedy_for(item, of_transforms)
            if hasattr(item, "omega_body"):  # a State or a Trajectory
                remedy = f"; write {name}([x.rotor for x in states]), and so omega_body and others"
            raise TypeError(f"{name} joins multivectors; item {i} is {type(item).__name__}{remedy}")
    if not items:
        raise ValueError(f"{name} needs at least one value")
    algebra, mask = items[0].algebra, 0
    for item in items:
        common_algebra(items[0], item)
        mask |= item._mask
    parts = list(common(*(over_grades(item, mask) for item in items)))
    if all(isinstance(item, _native.Rotor) for item in items):
        return parts, {item.shape for item in items}, _native.Rotor._from_rows
    return parts, {item.shape for item in items}, lambda data: _native.Multivector._of(data, mask, algebra)
