"""Convert arguments to arrays of coefficients: floats, exact numbers, expressions, arrays of any library."""

from __future__ import annotations

import sys
from numbers import Real
from typing import Any

import numpy as np

from polhode import _generic, _native
from polhode._algebra.foreign_values import refuse_operand
from polhode._support.arrays import (
    Array,
    as_floats,
    in_aligned_memory,
    is_complex,
    is_float,
    leaves,
    refuse_masked,
    refuse_multivectors,
    require_broadcast,
)
from polhode._support.extras import register_pytree

_COMPLEX = (np.dtype(np.complex128), np.dtype(np.complex64))
_PLAIN = {int, float, bool, complex, str, bytes, type(None)}


def as_coefficients(values: Any, what: str, dtype: Any = None, *, complex_too: bool = False) -> Any:
    """Convert values to an array of coefficients, of floats if these are exact.

    NumPy's float32 and float64 are unchanged. Other real numbers become float64, but integers that float64
    cannot hold stay exact, as do arrays of objects, fractions and expressions. Arrays of other libraries are
    unchanged. `dtype` converts: ``float``, ``np.float32``, or ``object`` for exact numbers. Complex numbers
    raise a TypeError unless the caller takes them, with `complex_too`.
    """
    if isinstance(values, _native.Multivector):
        raise TypeError(f"{what} must be real numbers, got a multivector; pass its .components")
    if dtype is not None:
        return _converted(values, what, dtype, complex_too)
    refuse_masked(values, what)
    if is_float(values):
        require_broadcast(values, what)
        return in_aligned_memory(values)
    if isinstance(values, list | tuple):
        strange = [leaf for leaf in leaves(values) if type(leaf) not in _PLAIN]
        if strange:
            refuse_multivectors(strange, what)
        special = any(not isinstance(leaf, np.ndarray | np.generic) for leaf in strange)
    else:
        special = type(values) not in _PLAIN and not isinstance(values, np.ndarray | np.generic)
    if special:
        kind = kind_of(values)
        if not kind.native:
            register_pytrees()
            return kind.asarray(values)
    array = _as_array(values, what)
    if isinstance(values, str) and all(map(str.isidentifier, values.replace(",", " ").split() or [values])):
        raise TypeError(
            f"{what} must be real numbers, got the text {values!r}; "
            f"for symbols pass sympy.symbols({values!r})"
        )
    # A list that mixes floats with integers is not exact.
    if array.dtype == object and (
        isinstance(values, np.ndarray) or not any(isinstance(x, float) for x in array.flat)
    ):
        return _exact(array, what)
    if array.dtype.kind in "iu" and not _fits_floats(array):
        return _exact(array.astype(object), what)
    if complex_too and is_complex(array):
        return array if array.dtype == np.complex64 else array.astype(np.complex128, copy=False)
    return array if is_float(array) else as_floats(array, what)


def require_real(data: Any, what: str) -> None:
    """Raise a TypeError for complex coefficients."""
    if is_complex(data):
        raise TypeError(f"{what} must be real, got {data.dtype}; take .real or .imag of the value")


def namespace(array: Any) -> Any:
    """Return the namespace of an array; NumPy for exact coefficients."""
    kind = kind_of(array)
    return np if kind.exact else kind.xp


def kind_of(*values: Any) -> Any:
    """Return the arithmetic of arrays, not all of NumPy floats."""
    return _generic.coefficients.of(*values)


def duplicate(array: Any) -> Any:
    """Return a copy; JAX arrays, which are immutable, are returned as they are."""
    if isinstance(array, np.ndarray):
        return np.array(array, order="C")
    # Other libraries differentiate a product, but not a copy.
    return array if namespace(array).__name__ == "jax.numpy" else array * 1


def reshaped(array: Any, shape: tuple[int, ...]) -> Any:
    """Return the same elements in another shape."""
    return array.reshape(shape) if isinstance(array, np.ndarray) else kind_of(array).reshape(array, shape)


def known_floats(values: Any, what: str) -> Array:
    """Convert coefficients of any kind to NumPy's float64; a TypeError while JAX or torch trace them."""
    if isinstance(values, np.ndarray):
        return as_coefficients(values, what, float)  # type: ignore[no-any-return]
    return as_floats(values, what)


def taken(array: Any, places: list[int]) -> Any:
    """Return some components, in this order."""
    if isinstance(array, np.ndarray):
        return np.take(array, places, axis=-1)  # in C order, unlike array[..., places]
    return _generic.layout.rearranged(kind_of(array), array, places)


def register_pytrees() -> None:
    """Register values as pytrees of JAX, if it has been imported."""
    register_pytree(
        _native.Multivector,
        lambda value: ((value._data,), (value._mask, value.algebra)),
        lambda kind, leaves: _native.Multivector._of(next(iter(leaves)), *kind),
    )
    register_pytree(
        _native.Rotor,
        lambda rotor: ((rotor._data,), None),
        lambda _, leaves: _native.Rotor._from_rows(next(iter(leaves))),
    )


if "jax" in sys.modules:
    register_pytrees()


def scalars(value: Any, like: Any) -> Any:
    """Convert a number or an array to coefficients (…, 1) beside those of `like`; None for anything else."""
    if isinstance(value, bool | np.bool_ | list | tuple | str | bytes):
        return None
    floating = like is not None and like.dtype != object
    if type(value) in (int, float) and floating:
        number = as_floats(value, "scalar")[np.newaxis]
        if is_complex(like):
            return number.astype(np.finfo(like.dtype).dtype)
        return number.astype(like.dtype) if is_float(like) else number  # float32 stays float32
    if isinstance(value, complex):
        single = isinstance(like, np.ndarray) and like.dtype in (np.float32, np.complex64)
        return np.array([value], np.complex64 if single and type(value) is complex else np.complex128)
    if type(value) is int and like is not None and like.dtype == object:
        return np.array([value], dtype=object)  # exact, even if a float could hold it, such as 2**60
    if isinstance(value, np.ndarray | np.number):
        if value.dtype.kind not in "iufcO":
            return None
        if value.dtype.kind in "iu" and floating:  # rounded, not exact
            numbers = as_floats(value, "scalar")[..., None]
            # As in NumPy, int8 and int16 keep float32.
            single = is_float(like) and np.result_type(like, value) == np.float32
            return numbers.astype(np.float32) if single else numbers
    elif not isinstance(value, Real):
        refuse_operand(value)
        if foreign_kind(value) is None:
            return None
    return as_coefficients(value, "scalar", complex_too=True)[..., None]


def number_like(value: Any, what: str, like: Any) -> Any:
    """Convert a value to coefficients (…); Python numbers take the precision of `like` if it has floats."""
    if is_float(like) and type(value) in (int, float):
        return as_floats(value, what).astype(like.dtype)
    if type(value) is int and isinstance(like, np.ndarray) and like.dtype == object:
        return np.array(value, dtype=object)
    return as_coefficients(value, what)


def foreign_kind(value: Any) -> Any:
    """Return the arithmetic of a value that NumPy floats cannot hold; None for numbers and NumPy arrays."""
    try:
        kind = kind_of(value)
    except TypeError:
        return None
    return None if kind.native else kind


def common(*arrays: Any) -> tuple[Any, ...]:
    """Convert arrays to coefficients of one kind; NumPy itself promotes float32 to float64."""
    if all(is_float(array) for array in arrays):
        return arrays
    kind = kind_of(*arrays)
    return tuple(kind.asarray(array) for array in arrays)


def _exact(array: Any, what: str) -> Any:
    """Return an array of objects; a TypeError unless each is a number or an expression."""
    try:
        return kind_of(array).asarray(array)
    except TypeError as error:
        raise TypeError(f"{what} must be real numbers or expressions: {error}") from None


def _as_array(values: Any, what: str) -> Any:
    try:
        return np.asarray(values)
    except ValueError as error:
        raise TypeError(f"{what} must be an array of numbers; the rows have unequal lengths") from error
    except TypeError as error:
        raise TypeError(f"{what} must be real numbers: {error}") from error


def _fits_floats(array: Any) -> bool:
    """Whether float64 holds all these integers exactly."""
    if not array.size or max(-int(array.min()), int(array.max())) <= 1 << 53:
        return True
    return all(int(float(x)) == x for x in map(int, array.flat))


def _converted(values: Any, what: str, dtype: Any, complex_too: bool) -> Any:
    given = as_coefficients(values, what, complex_too=True)
    if not isinstance(given, np.ndarray):
        return _converted_foreign(given, what, dtype)
    wanted = np.dtype(dtype)
    if wanted.kind != "c":
        require_real(given, what)
    if wanted.kind == "O":
        # Whole floats become integers, so that results stay exact.
        return kind_of(np.empty(0, dtype=object)).asarray(given)
    if wanted not in (np.float64, np.float32) and not (complex_too and wanted in _COMPLEX):
        raise TypeError(f"coefficients are float64, float32, complex128, complex64 or object, got {wanted}")
    try:
        with np.errstate(over="ignore"):  # IEEE, as in the products
            return given.astype(wanted, copy=False)
    except (TypeError, OverflowError) as error:
        raise TypeError(f"{what} cannot be converted to {wanted}: {error}") from error


def _converted_foreign(given: Any, what: str, dtype: Any) -> Any:
    """Convert an array of another library to one of its floating types, also given by NumPy's name."""
    xp = namespace(given)
    try:
        wanted = getattr(xp, np.dtype(dtype).name, None)
    except TypeError:  # a type of the library itself
        wanted = dtype
    if wanted is None or not xp.isdtype(wanted, "real floating"):
        raise TypeError(
            f"{what} of type {type(given).__name__} of {xp.__name__} cannot be converted to {dtype}"
        )
    return xp.astype(given, wanted)
