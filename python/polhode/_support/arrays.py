"""Convert arguments to arrays of float64, and arrays to rows for the compiled core."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from polhode import _native
from polhode._support.memory import require_array

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
else:
    Array = np.ndarray
Shape = tuple[int, ...]
T = TypeVar("T")

_FLOATS = (np.dtype(np.float64), np.dtype(np.float32))
_DRAWN = 1 << 20  # random numbers: some 10 ms
_LARGE = 1 << 20  # bytes; the allocator reuses smaller blocks itself


def as_floats(values: Any, what: str) -> Array:
    """Convert real numbers of any kind to float64; a TypeError for anything else."""
    refuse_multivectors(values, what)
    refuse_masked(values, what)
    if isinstance(values, list | tuple):
        for item in values:
            if isinstance(item, np.ndarray):
                require_broadcast(item, what)
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise TypeError(f"{what} must be an array of real numbers; the rows have unequal lengths") from error
    except TypeError as error:
        if type(error).__name__ == "TracerArrayConversionError":
            raise TypeError(
                f"{what} must be known numbers, but JAX traces it, for jit, grad or vmap; use ph.jax there"
            ) from None
        raise
    except RuntimeError:
        if not any(type(leaf).__module__.partition(".")[0] == "torch" for leaf in leaves(values)):
            raise
        raise TypeError(
            f"{what} must be known numbers, but torch records it, for a gradient or vmap; pass x.detach() if "
            "it has a gradient, or use ph.jax for derivatives of motions"
        ) from None
    if array.dtype == object and all(isinstance(x, int | float) for x in array.flat):
        try:  # integers beyond 64 bits
            array = array.astype(np.float64)
        except OverflowError as error:
            raise ValueError(f"{what} has an integer beyond the range of float64 (1.8e308)") from error
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{what} must be real numbers (int or float), got {_not_numbers(values, array)}")
    require_broadcast(array, what)
    return in_aligned_memory(array.astype(np.float64, copy=False))


def _not_numbers(values: Any, array: Array) -> str:
    """Return the words for what is not numbers: the first of such items with its index, or their type."""
    if isinstance(values, str | bytes):
        return f"the text {values!r}"
    if array.dtype.kind in "OUS":
        items = np.array(values, object) if isinstance(values, list | tuple) else array
        for index, item in np.ndenumerate(items):
            if not isinstance(item, int | float | np.number):
                found = "None" if item is None else f"a {type(item).__name__}"
                found = f"the text {str(item)!r}" if isinstance(item, str) else found
                return f"{found} at index {index}" if index else found
    return f"dtype {array.dtype}"


def require_broadcast(array: Array, what: str) -> None:
    """Raise a MemoryError if the rows of a broadcast array, which share memory, would not fit into memory."""
    if 0 in array.strides:
        require_array(array.shape, f"the numbers of {what}")


def refuse_masked(values: Any, what: str) -> None:
    """Raise a TypeError for a masked array, of which NumPy would take the masked values, too."""
    if isinstance(values, np.ndarray) and hasattr(values, "mask"):
        raise TypeError(f"{what} is a masked array; fill it or pass its compressed values")


def in_aligned_memory(array: Array) -> Array:
    """Return the array, or a copy if its memory is not aligned, as of a field of a packed record."""
    return array if array.flags.aligned else array.copy()


def refuse_multivectors(values: Any, what: str) -> None:
    """Raise a TypeError for a multivector or a list of them, which NumPy would convert to components."""
    nested = isinstance(values, list | tuple)
    if any(isinstance(leaf, _native.Multivector) for leaf in (leaves(values) if nested else (values,))):
        kind = "a list with a multivector" if nested else "a multivector"
        raise TypeError(f"{what} must be real numbers, got {kind}; pass its .components")


def leaves(value: Any) -> Iterator[Any]:
    """Yield the items of nested lists and tuples."""
    if isinstance(value, list | tuple):
        for item in value:
            yield from leaves(item)
    else:
        yield value


def as_float(value: Any, what: str) -> float:
    """Convert one real number; a TypeError for anything else."""
    if isinstance(value, str):
        raise TypeError(f"{what} must be a number in SI units, got the text {value!r}")
    array = as_floats(value, what)
    if array.ndim:
        raise TypeError(f"{what} must be one number, got shape {array.shape}")
    return float(array)


def output_times(times: Any) -> Array:
    """Return times (n,); a ValueError for a single number, which could be meant as a duration."""
    array = as_floats(times, "times")
    check_line(array.shape, times)
    return array


def check_line(shape: Shape, times: Any) -> None:
    """Raise a ValueError unless the shape is (n,)."""
    if not shape:
        raise ValueError(
            f"times must be an array of output times, got the number {times}; give [T] for the state at time "
            "T alone, or np.linspace(0, T, n) for the motion up to T"
        )
    if len(shape) != 1:
        raise ValueError(f"times must be one-dimensional, got shape {shape}")


def as_count(value: Any, what: str) -> int:
    """Convert a whole number; a TypeError for anything else."""
    try:
        return operator.index(value)
    except TypeError:
        raise TypeError(f"{what} must be a whole number, got {type(value).__name__}") from None


def require_components(shape: Any, size: int, what: str) -> None:
    """Raise a ValueError, which explains columns, unless the last axis has this many components."""
    if not shape or shape[-1] != size:
        remedy = remedy_for_columns(shape, size)
        raise ValueError(f"{what} needs {size} components in the last axis, got shape {tuple(shape)}{remedy}")


def remedy_for_columns(shape: Any, size: int) -> str:
    """Return the end of an error for an array of this shape with this many numbers in columns."""
    if len(shape) != 2 or shape[0] != size:
        return ""
    return "; write np.ravel(x) for a column x" if shape[1] == 1 else "; write x.T for columns x"


def as_components(values: Any, size: int, what: str) -> Array:
    """Return a read-only, contiguous copy of shape (..., size)."""
    array = as_floats(values, what)
    require_components(array.shape, size, what)
    require_array(array.shape, f"the numbers of {what}")
    return frozen(np.array(array, order="C"))


def is_float(data: Any) -> bool:
    """Whether this is a NumPy array of float64 or float32, which the compiled core accepts."""
    return isinstance(data, np.ndarray) and data.dtype in _FLOATS


def is_complex(data: Any) -> bool:
    """Whether this is a NumPy array of complex numbers."""
    return isinstance(data, np.ndarray) and data.dtype.kind == "c"


def mapped(f: Callable[[Array], Array], data: Any) -> Any:
    """Return f of the rows, computed in float64 and rounded to their type."""
    result = f(np.ascontiguousarray(data, dtype=np.float64))
    if data.dtype == result.dtype:
        return result
    with np.errstate(over="ignore"):
        return result.astype(data.dtype, copy=False)


def power_of_two(array: Array, axis: int | tuple[int, ...]) -> Array:
    """Return the power of two below the largest magnitude, with the axes kept; 1 if that is 0 or not finite.

    A division by it rounds nothing, and sums of squares of the quotients neither overflow nor vanish.
    """
    largest = np.abs(array).max(axis=axis, keepdims=True, initial=0.0)
    exponents = np.frexp(np.where((largest > 0) & np.isfinite(largest), largest, 1.0))[1] - 1
    return np.asarray(np.ldexp(np.ones((), largest.dtype), exponents))


def lengths(array: Array, axis: int | tuple[int, ...] = -1) -> Array:
    """Return ``√Σx²`` over some axes, without overflow or underflow on the way."""
    scale = power_of_two(array, axis)
    with np.errstate(over="ignore"):
        return np.asarray(np.sqrt(np.square(array / scale).sum(axis=axis)) * scale.squeeze(axis))


def new(shape: Shape, dtype: Any) -> Array:
    """Return an uninitialized array; a large one takes memory from a pool."""
    wanted = np.dtype(dtype)
    size = math.prod(shape)
    if size * wanted.itemsize < _LARGE:
        return np.empty(shape, wanted)
    memory = _native.buffer(size * wanted.itemsize)
    return np.frombuffer(memory, wanted, size).reshape(shape)


def normal_numbers(shape: Shape, rng: np.random.Generator | int | None, what: str) -> Array:
    """Return random numbers of the standard normal distribution; `what` has them, for errors."""
    require_array(shape, what)
    try:
        generator, numbers = np.random.default_rng(rng), np.empty(shape)
    except TypeError:
        key = type(rng).__module__.startswith("jax")
        found = (
            "a key of JAX; pass its normal numbers (..., 4) to Rotor.from_components" if key else repr(rng)
        )
        raise TypeError(f"rng must be a NumPy generator, a whole number or None, got {found}") from None
    except ValueError:
        raise ValueError(f"rng must be a NumPy generator, a whole number >= 0 or None, got {rng!r}") from None
    line = numbers.reshape(-1)
    for first in range(0, line.size, _DRAWN):  # Ctrl-C stops between them
        generator.standard_normal(out=line[first : first + _DRAWN])
    return numbers


def frozen(array: Array) -> Array:
    """Return the array, marked read-only."""
    array.flags.writeable = False
    return array


def copied(value: Any) -> Any:
    """Return a copy of a NumPy array, which the caller may change.

    Of a dictionary, return a dictionary of copies; anything else unchanged.
    """
    if isinstance(value, dict):
        return {name: copied(x) for name, x in value.items()}
    if not isinstance(value, np.ndarray):
        return value
    if value.nbytes < _LARGE or value.dtype == object:
        return value.copy()
    copy = new(value.shape, value.dtype)
    np.copyto(copy, value)
    return copy


def hands_out_copies(*names: str) -> Callable[[type[T]], type[T]]:
    """Make these fields of a frozen dataclass, by default all, return copies of the arrays they hold."""

    def copying(name: str) -> property:
        return property(lambda self: copied(vars(self)[name]), lambda self, x: vars(self).update({name: x}))

    def with_copies(cls: type[T]) -> type[T]:
        for name in names or cls.__annotations__:
            setattr(cls, name, copying(name))
        return cls

    return with_copies


def first_index(where: Any) -> tuple[int, ...]:
    """Return the index of the first true element."""
    return tuple(int(i) for i in np.argwhere(where)[0])


def at_index(index: tuple[int, ...]) -> str:
    """Return `` at index …`` for a message; nothing for a single value."""
    return f" at index {index}" if index else ""


def rows(data: Array, batch: Shape) -> Array:
    """Return data in C order: one row of components, or one for each value of the batch."""
    size = data.shape[-1]
    if data.size != size and data.shape[:-1] != batch:
        require_array((*batch, size), "operands")
        data = np.broadcast_to(data, (*batch, size))
    return np.ascontiguousarray(data)


def common_batch(*shapes: Shape) -> Shape:
    """Return the shape that batches broadcast to; a ValueError that names their shapes if they do not."""
    first = shapes[0]
    if all(shape == first for shape in shapes):
        return first
    try:
        return np.broadcast_shapes(*shapes)
    except ValueError:
        listed = ", ".join(map(str, shapes[:-1]))
        raise ValueError(
            f"the batch shapes {listed} and {shapes[-1]} do not broadcast: lengths must be equal or 1; write "
            "A[:, None] to combine each item of A with all others, ph.vector(x) for an array x of components"
        ) from None


def batch_shape(shape: Any) -> Shape:
    """Return a batch shape from a length or a sequence of lengths."""
    try:
        lengths = (shape,) if hasattr(shape, "__index__") else tuple(shape)
        found = tuple(map(operator.index, lengths))
    except TypeError as error:
        raise TypeError(f"a batch shape is a whole number or a tuple of them, got {shape!r}") from error
    if any(length < 0 for length in found):
        raise ValueError(f"the lengths of a batch shape must be >= 0, got {shape!r}")
    return found


def index_message(error: IndexError, shape: Shape, index: tuple[Any, ...]) -> str:
    """Return the message for an index that NumPy rejects, which counts the axis of components too."""
    text = str(error)
    if text.startswith("too many indices"):
        text = f"too many indices for the batch axes: {len(index)}"
    return f"{text} (batch shape {shape})"


def batch_index(index: Any, shape: Shape) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    """Return an index of NumPy over a batch as a tuple, and one that leaves a last axis."""
    parts = index if isinstance(index, tuple) else (index,)
    try:
        np.broadcast_to(np.False_, shape)[parts]
    except IndexError as error:
        raise IndexError(index_message(error, shape, parts)) from None
    return parts, (*parts, slice(None)) if any(part is Ellipsis for part in parts) else parts


def joined(*parts: Array) -> Array:
    """Broadcast the batches together and concatenate the components in the last axis."""
    if len(parts) == 1:
        return np.ascontiguousarray(parts[0])
    batch = common_batch(*(part.shape[:-1] for part in parts))
    require_array((*batch, sum(part.shape[-1] for part in parts)), "operands")
    wide = [np.broadcast_to(part, (*batch, part.shape[-1])) for part in parts]
    return np.ascontiguousarray(np.concatenate(wide, axis=-1))
