"""Choice of the arithmetic for given arrays: `of` returns a `Numeric` or an `Exact`."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode._generic.exact import Exact, is_coefficient, is_multiprecision
from polhode._generic.numeric import Numeric
from polhode._support.arrays import leaves
from polhode._support.extras import optional

Coefficients = Numeric | Exact

_FLOAT64 = np.dtype(np.float64)

# Libraries whose arrays need array-api-compat to follow the standard.
_THROUGH_COMPAT = ("torch", "cupy", "dask", "ndonnx", "sparse")


def of(*values: Any) -> Coefficients:
    """Return the arithmetic of these arrays, numbers and nested lists together.

    Floats in NumPy arrays and Python numbers combine with everything. Exact coefficients (arrays of objects,
    Fractions, SymPy expressions) combine with these only, and so do the arrays of each other library; any
    other mix is a TypeError. NumPy alone gives NumPy with float64, or complex numbers if some array has them.
    """
    if all(_is_plain(value) for value in values):
        return Numeric(np, _FLOAT64)
    exact: list[Any] = []
    foreign: list[Any] = []
    native: list[Any] = []
    for leaf in leaves(values):
        if _is_exact(leaf):
            exact.append(leaf)
        elif _namespace(leaf) is not None:
            foreign.append(leaf)
        elif isinstance(leaf, np.ndarray | np.generic | complex):
            native.append(leaf)
    dtype = _complex_dtype(native)
    if dtype is not None and (exact or foreign):
        other = f"exact coefficients ({_example(exact[0])})" if exact else f"{_library(foreign[0])} arrays"
        raise TypeError(f"{other} and complex numbers do not mix; convert one of them first")
    if not foreign:
        return Exact(_context(exact)) if exact else Numeric(np, dtype or _FLOAT64)
    names = list(dict.fromkeys(map(_library, foreign)))
    if exact or len(names) > 1:
        other = f"exact coefficients ({_example(exact[0])})" if exact else f"{names[1]} arrays"
        raise TypeError(f"{names[0]} arrays and {other} do not mix; convert one of them first")
    return _numeric(foreign)


def _is_plain(x: Any) -> bool:
    """Whether this is an array of floats or a number, by far the most frequent coefficients."""
    kind = type(x)
    return x.dtype.char in "df" if kind is np.ndarray else kind is float or kind is int


def _complex_dtype(arrays: list[Any]) -> Any:
    """Return complex64 or complex128, the type of NumPy arrays together; None if all are real."""
    if all(np.iscomplexobj(array) is False for array in arrays):
        return None
    wide = any(np.result_type(array) not in (np.float32, np.complex64) for array in arrays)
    return np.dtype(np.complex128 if wide else np.complex64)


def _numeric(arrays: list[Any]) -> Numeric:
    """Return the arithmetic of arrays of one library, in their common floating type."""
    xp = _namespace(arrays[0])
    floating = []
    for array in arrays:
        if xp.isdtype(array.dtype, "real floating"):
            floating.append(array.dtype)
        elif not xp.isdtype(array.dtype, "integral"):
            raise TypeError(f"coefficients are real numbers (int or float), got dtype {array.dtype}")
    dtype = xp.result_type(*floating) if floating else None
    # JAX places arrays itself; a traced array has no device.
    device = None if _library(arrays[0]) == "jax" else getattr(arrays[0], "device", None)
    return Numeric(xp, dtype, device)


def _is_exact(x: Any) -> bool:
    return is_coefficient(x) or (isinstance(x, np.ndarray) and x.dtype == object)


def _library(array: Any) -> str:
    """Return the name of the library of an array; JAX's arrays and tracers are of jax or jaxlib."""
    name = type(array).__module__.partition(".")[0]
    return "jax" if name == "jaxlib" else name


def _namespace(array: Any) -> Any:
    """Return the namespace of an array of another library than NumPy; None for anything else."""
    if isinstance(array, np.ndarray | np.generic):
        return None
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    if _library(array) in _THROUGH_COMPAT and hasattr(array, "dtype"):
        what = f"computing with {_library(array)} arrays"
        return optional("array_api_compat", "array-api", what).array_namespace(array)
    return None


def _context(exact: list[Any]) -> Any:
    """Return the mpmath context of the first multiprecision number; None if there is none."""
    for x in exact:
        for element in x.flat if isinstance(x, np.ndarray) else (x,):
            if is_multiprecision(element):
                return element.context
    return None


def _example(x: Any) -> str:
    element = x.flat[0] if isinstance(x, np.ndarray) and x.size else x
    return type(element).__name__
