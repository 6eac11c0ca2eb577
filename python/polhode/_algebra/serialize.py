"""Conversion of values to and from dictionaries that JSON can hold."""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.algebra import Algebra, algebra
from polhode._algebra.cga import cga
from polhode._algebra.coefficients import as_coefficients
from polhode._algebra.multivector import Multivector
from polhode._algebra.pga import pga
from polhode._algebra.rotor import Rotor
from polhode._support.arrays import is_complex, is_float

_KEYS = {"algebra", "grades", "rotor", "shape", "dtype", "components"}
_DTYPES = {
    "float64": np.float64,
    "float32": np.float32,
    "complex128": np.complex128,
    "complex64": np.complex64,
    "object": object,
}


def to_dict(value: Multivector) -> dict[str, Any]:
    """Return a value as a dictionary that JSON can hold; `from_dict` restores it, bit for bit.

    Its fields are the algebra, the grades, whether the value is a rotor, the batch shape, the dtype, and the
    components as nested lists. The algebra is a signature ``[p, q, r]``, or a name such as ``"pga(3)"``. A
    fraction is text, ``"1/3"``, a complex number a pair ``[re, im]``. A TypeError for symbolic coefficients;
    arrays of other libraries are restored as NumPy floats.

    Examples
    --------
    >>> fields = ph.to_dict(2 * ph.e1)
    >>> fields["grades"], fields["components"]
    ([1], [2.0, 0.0, 0.0])
    """
    if not isinstance(value, _native.Multivector):
        raise TypeError(f"to_dict needs a multivector, got {type(value).__name__}")
    data = np.asarray(value._data)
    plain = np.stack([data.real, data.imag], axis=-1) if is_complex(data) else data
    return {
        "algebra": value.algebra._key(),
        "grades": list(value.grades),
        "rotor": isinstance(value, Rotor),
        "shape": list(value.shape),
        "dtype": data.dtype.name,
        "components": np.frompyfunc(_plain, 1, 1)(data).tolist() if data.dtype == object else plain.tolist(),
    }


def _plain(x: Any) -> Any:
    if isinstance(x, Fraction):
        return str(x)
    if isinstance(x, int | float):
        return x
    raise TypeError(f"a component is {x!r} ({type(x).__name__}), which JSON cannot hold")


def from_dict(fields: Mapping[str, Any]) -> Multivector:
    """Restore a value from the fields of `to_dict`; a ValueError for fields that are missing or wrong.

    Examples
    --------
    >>> import json
    >>> text = json.dumps(ph.to_dict(ph.e1 + 2 * ph.e2))
    >>> ph.from_dict(json.loads(text))
    e1 + 2 e2
    """
    missing = _KEYS - set(fields)
    if missing:
        raise ValueError(f"a value needs the fields {sorted(_KEYS)}; missing: {sorted(missing)}")
    try:
        return _restored(fields)
    except (TypeError, ArithmeticError) as error:
        raise ValueError(f"invalid fields of a value: {error}") from error


def _restored(fields: Mapping[str, Any]) -> Multivector:
    space, grades = _algebra_of(fields["algebra"]), list(fields["grades"])
    if not grades or grades != sorted(set(grades)) or not set(grades) <= set(range(space.dimension + 1)):
        raise ValueError(f"grades must rise from 0 to at most {space.dimension}, got {grades}")
    mask = sum(1 << k for k in grades)
    if fields["dtype"] not in _DTYPES:
        raise ValueError(f"dtype must be one of {', '.join(_DTYPES)}, got {fields['dtype']!r}")
    numbers = np.asarray(np.frompyfunc(_number, 1, 1)(np.array(fields["components"], dtype=object)))
    if fields["dtype"] in ("complex128", "complex64"):
        numbers = _complex(numbers)
    shape = (*map(operator.index, fields["shape"]), len(space._indices(mask)))
    if numbers.size != math.prod(shape):
        raise ValueError(f"grades {grades} and shape {fields['shape']} do not fit {numbers.size} components")
    dtype = _DTYPES[fields["dtype"]]
    data = as_coefficients(numbers, "a component", dtype, complex_too=True).reshape(shape)
    if not isinstance(fields["rotor"], bool):
        raise ValueError(f"rotor must be true or false, got {fields['rotor']!r}")
    if not fields["rotor"]:
        return Multivector._of(data, mask, space)
    if space is not algebra(3) or grades != [0, 2]:
        raise ValueError(f"a rotor must have algebra Cl(3) and grades [0, 2], got {space} with {grades}")
    unit = Rotor.from_components(data)
    # Dividing by a norm that is 1 but for rounding would change the last bits.
    rounding = 32 * np.finfo(data.dtype if is_float(data) else float).eps
    same = unit.is_close(Multivector._of(data, mask), rtol=rounding)
    return Rotor._from_rows(data) if np.all(same) else unit


def _algebra_of(key: Any) -> Algebra:
    """Return the algebra of a signature, or of a name such as ``"pga(3)"``."""
    if isinstance(key, str):
        named = re.fullmatch(r"(pga|cga)\((\d)\)", key)
        if not named:
            raise ValueError(f'an algebra is three counts (p, q, r), "pga(n)" or "cga(n)", got {key!r}')
        return {"pga": pga, "cga": cga}[named[1]](int(named[2]))
    signature = list(key)
    if len(signature) != 3:
        raise ValueError(f"an algebra is three counts (p, q, r), got {signature}")
    return algebra(*signature)


def _complex(pairs: Any) -> Any:
    """Return complex numbers of pairs in the last axis."""
    if not pairs.shape or pairs.shape[-1] != 2:
        raise ValueError(f"complex components are pairs [re, im], got shape {pairs.shape}")
    parts = pairs.astype(float)
    return parts[..., 0] + 1j * parts[..., 1]


def _number(x: Any) -> Any:
    return Fraction(x) if isinstance(x, str) else x
