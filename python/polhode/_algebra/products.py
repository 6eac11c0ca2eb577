"""Products of any two values: broadcasting, output arrays, any coefficients."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _generic, _native
from polhode._algebra.coefficients import kind_of, scalars
from polhode._support.arrays import Array, Shape, common_batch, is_float, new, rows

if TYPE_CHECKING:
    from polhode._algebra.multivector import Multivector


def product(name: str, left: Multivector, right: Multivector, out: Any = None) -> Multivector:
    """Return a named product, or write it to `out` and return a view of `out`."""
    algebra = common_algebra(left, right)
    mask, size = algebra._result(name, left._mask, right._mask)
    a, b = left._data, right._data
    rotors = name == "geometric" and isinstance(left, _native.Rotor) and isinstance(right, _native.Rotor)
    if not (is_float(a) and is_float(b)):
        if out is not None:
            raise TypeError(f"out needs factors of floats, got {left.dtype} and {right.dtype}")
        common_batch(left.shape, right.shape)
        terms, _ = algebra._terms(name, left._mask, right._mask)
        kind = kind_of(a, b)
        with np.errstate(over="ignore", invalid="ignore"):  # IEEE, as in the core
            result = _generic.products.product(kind, terms, size, kind.factor(a), kind.factor(b))
        if rotors:
            return _native.Rotor._from_rows(_generic.rotors.from_components(kind, result))
        return _native.Multivector._of(result, mask, algebra)
    batch, a, b = aligned(a, b)
    result = result_array((*batch, size), a.dtype, (a, b), out)
    if rotors:
        _native.rotor_compose(a, b, result)
        return _native.Rotor._from_rows(result)
    _native.product(algebra, name, a, left._mask, b, right._mask, result)
    return _native.Multivector._of(result, mask, algebra)


def anticommutator(value: Multivector, other: Any) -> Multivector:
    """``½(AB + BA)``: of two vectors their dot. With `commutator` it adds up to ``AB``.

    Examples
    --------
    >>> a, b = ph.vector([1, 2, 0]), ph.vector([0, 3, 0])
    >>> a.anticommutator(b), a.commutator(b)
    (6, 3 e1∧e2)
    """
    right = coerced(other, value)
    if right is None:
        raise TypeError(
            f"anticommutator needs a multivector, a number or an array, got {type(other).__name__}"
        )
    n, mask = common_algebra(value, right).dimension, 0
    for r in value.grades:
        for s in right.grades:
            # The reverse of the part of grade k of AB is ± that of BA.
            parts = range(abs(r - s), min(r + s, 2 * n - r - s) + 1, 2)
            mask |= sum(1 << k for k in parts if (_turns(r) + _turns(s) + _turns(k)) % 2 == 0)
    total = (value * right + right * value) / 2
    return total._part(mask) if mask else total._part(1)


def _turns(grade: int) -> int:
    """Return the number of swaps in the reverse of a blade."""
    return grade * (grade - 1) // 2


def aligned(a: Array, b: Array) -> tuple[Shape, Array, Array]:
    """Return the common batch shape of two arrays of floats, and their rows in the precision of both."""
    batch, dtype = common_batch(a.shape[:-1], b.shape[:-1]), np.result_type(a, b)
    return batch, rows(a.astype(dtype, copy=False), batch), rows(b.astype(dtype, copy=False), batch)


def result_array(shape: Shape, dtype: Any, operands: tuple[Array, ...], out: Any) -> Array:
    """Return a new array for a result, or a view of `out`; an error if `out` cannot hold it."""
    if out is None:
        return new(shape, dtype)
    if not isinstance(out, np.ndarray):
        raise TypeError(f"out must be a NumPy array, got {type(out).__name__}")
    if out.shape != shape or out.dtype != dtype:
        raise ValueError(f"out must be {dtype} of shape {shape}, got {out.dtype} of shape {out.shape}")
    if not (out.flags.c_contiguous and out.flags.writeable):
        raise ValueError("out must be writable and in C order")
    if any(np.may_share_memory(out, operand) for operand in operands):
        raise ValueError("out overlaps an operand; pass a separate array")
    return out.view()


def common_algebra(left: Multivector, right: Multivector) -> Any:
    """Return the algebra of both; a TypeError if they differ."""
    algebra = left.algebra
    if algebra is not right.algebra:
        larger = [known for known in (algebra, right.algebra) if hasattr(known, "embed")]
        remedy = f"; convert one with ph.{larger[0]}.embed" if larger else ""
        raise TypeError(f"the values belong to different algebras, {algebra} and {right.algebra}{remedy}")
    return algebra


def is_sequence(value: Any) -> bool:
    """Whether a value is a list or tuple, and no type of a user that is derived from them."""
    return type(value) in (list, tuple)


def coerced(value: Any, like: Multivector | None = None) -> Multivector | None:
    """Convert to a multivector: a number or an array becomes scalars of the algebra of `like`; else None.

    A TypeError for a list or tuple, which could be components, numbers of a batch or values.
    """
    if isinstance(value, _native.Multivector):
        return value  # type: ignore[return-value]
    data = scalars(value, like._data if like is not None else None)
    if data is None:
        if is_sequence(value):
            raise TypeError(
                f"a {type(value).__name__} is not a multivector; write ph.vector(x) for components, "
                "ph.stack(x) for a batch of values, np.array(x) for a batch of numbers"
            )
        return None
    return _native.Multivector._of(data, 1, like.algebra if like is not None else None)
