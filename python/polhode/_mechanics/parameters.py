"""Arguments of laws: numbers shared by all bodies, or a row for each body of a batch."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.coefficients import known_floats
from polhode._algebra.constructors import as_bivectors, as_vectors
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor, check_rotor
from polhode._support.arrays import Array, Shape, as_floats, first_index, frozen
from polhode._support.memory import require_array

_BYTES = 400  # of the law of a body in the core


class Batch:
    """A row of numbers for each body of a batch, (*shape, k); equal if the numbers are equal.

    `like` is a single multivector of the same kind for a formula, else 1.0.
    """

    __slots__ = ("like", "rows")

    def __init__(self, rows: Array, like: Any = 1.0) -> None:
        rows = np.asarray(rows)
        require_array(rows.shape[:-1], "the parameters of a batch", _BYTES)
        self.rows, self.like = frozen(np.array(rows, dtype=float, order="C")), like

    @property
    def shape(self) -> Shape:
        """Shape of the batch of bodies."""
        return self.rows.shape[:-1]

    def __getitem__(self, index: slice) -> Batch:
        return Batch(self.rows[index], self.like)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Batch):
            return NotImplemented
        return self._kind() == other._kind() and np.array_equal(self.rows, other.rows)

    def __hash__(self) -> int:
        return hash((self.rows.shape, self.rows.tobytes()))

    def __reduce__(self) -> tuple[Any, ...]:
        return Batch, (self.rows, self.like)

    def __repr__(self) -> str:
        return f"batch {self.shape}"

    def _kind(self) -> tuple[Any, ...]:
        return type(self.like), getattr(self.like, "grades", None)


_native.register("Batch", Batch)


def numbers_of(argument: Any) -> Array:
    """Return the numbers (..., k) of an argument of a law; (1,) for a number."""
    return argument.rows if isinstance(argument, Batch) else np.atleast_1d(np.array(argument, float))


def numbers(value: Any, name: str) -> float | Batch:
    """Return a finite number, or a batch from an array."""
    array = as_floats(value, name)
    check_finite(array[..., np.newaxis], name)
    return Batch(array[..., np.newaxis]) if array.ndim else float(array)


def vectors(value: Any, name: str) -> tuple[float, ...] | Batch:
    """Return three finite numbers, or a batch, from vectors or an array (..., 3)."""
    return rows(as_vectors(value, name), name)


def bivectors(value: Any, name: str) -> tuple[float, ...] | Batch:
    """Return three finite numbers, or a batch, from bivectors or an array (..., 3)."""
    return rows(as_bivectors(value, name), name)


def rotors(value: Rotor | None, name: str) -> tuple[float, ...] | Batch:
    """Return the components of a rotor, or a batch of them; for None those of the identity."""
    if value is None:
        return (1.0, 0.0, 0.0, 0.0)
    check_rotor(value, name)
    return rows(known_floats(value._data, name), name)


def gains(value: Any, name: str) -> tuple[float, ...] | Batch:
    """Return three finite numbers from a number or three, or a batch from (..., 3) or (..., 1)."""
    array = as_floats(value, name)
    if array.shape[-1:] not in ((), (3,)) and not (array.ndim > 1 and array.shape[-1] == 1):
        remedy = f"; for a number of each body write {name}[:, None]" if array.ndim == 1 else ""
        raise ValueError(
            f"{name} must be a number or three along the body axes, or a batch (..., 3) of them or (..., 1), "
            f"got shape {array.shape}{remedy}"
        )
    return rows(np.broadcast_to(array, (*array.shape[:-1], 3)), name)


def rows(components: Array, name: str) -> tuple[float, ...] | Batch:
    """Return components as a tuple, or a batch of them; they must be finite."""
    check_finite(components, name)
    return Batch(components) if components.ndim > 1 else tuple(components.tolist())


# The conversion of an argument, given with its name, by its shape in the registry.
CONVERSIONS: dict[str, Callable[[Any, str], Any]] = {
    "scalar": numbers,
    "vector": vectors,
    "bivector": bivectors,
    "gains": gains,
    "rotor": rotors,
}


def check_finite(components: Array, what: str) -> None:
    """Raise a ValueError with the first row, and its index, that is not finite."""
    wrong = ~np.isfinite(components)
    if wrong.any():
        index = first_index(wrong)[:-1]
        row = components[index].tolist()
        value = row[0] if len(row) == 1 else row
        raise ValueError(f"{place(index)}{what} is {value}; it must be finite")


def place(index: tuple[int, ...]) -> str:
    """Return ``at index (2,): ``, or nothing for a single value."""
    return f"at index {index}: " if index else ""


def together(arguments: Sequence[Any], law: str, names: Sequence[str] = ()) -> tuple[Any, ...]:
    """Return arguments of a law, whose batches are broadcast to one shape; errors have their `names`."""
    labels = [*names, *(f"argument {k + 1}" for k in range(len(names), len(arguments)))]
    shapes = {label: x.shape for label, x in zip(labels, arguments, strict=False) if isinstance(x, Batch)}
    shape = common(shapes, law)
    return tuple(_broadcast(x, shape) if isinstance(x, Batch) else x for x in arguments)


def _broadcast(batch: Batch, shape: Shape) -> Batch:
    if batch.shape == shape:
        return batch
    return Batch(np.broadcast_to(batch.rows, (*shape, batch.rows.shape[-1])), batch.like)


def named_together(given: tuple[tuple[str, Any], ...]) -> tuple[tuple[str, Any], ...]:
    """Return the values of names in a formula, with batches broadcast to one shape."""
    many = {name: x for name, x in given if isinstance(x, Multivector) and x.shape}
    shape = common({f"`{name}`": x.shape for name, x in many.items()}, "the formula")
    return tuple((name, _broadcast(_of_values(x), shape) if name in many else x) for name, x in given)


def _of_values(values: Multivector) -> Batch:
    data = known_floats(values._data, "a value")
    if isinstance(values, Rotor):
        return Batch(data, Rotor.identity())
    return Batch(data, Multivector._of(np.ones(data.shape[-1]), values._mask))


def common(shapes: Mapping[str, Shape], what: str) -> Shape:
    """Return the shape to which batches broadcast, or raise a ValueError with their shapes."""
    first, *others = shapes.values() or [()]
    if all(shape == first for shape in others):
        return first
    try:
        return np.broadcast_shapes(first, *others)
    except ValueError:
        listed = ", ".join(f"{shape} of {name}" for name, shape in shapes.items() if shape)
        raise ValueError(f"the batch shapes of {what} do not broadcast together: {listed}") from None
