"""Norms, powers, inverses, exponentials, logarithms and roots of values."""

from __future__ import annotations

import math
import operator
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _generic, _native
from polhode._algebra import grades as _parts
from polhode._algebra import motors as _motors
from polhode._algebra.coefficients import common, kind_of, number_like, taken
from polhode._algebra.masking import Errors, masked
from polhode._algebra.products import coerced
from polhode._support.arrays import (
    Array,
    at_index,
    common_batch,
    first_index,
    is_complex,
    is_float,
    mapped,
    new,
)

if TYPE_CHECKING:
    from polhode._algebra.multivector import Multivector

Signs = np.ndarray[Any, np.dtype[np.int8]]

_BIVECTOR, _EVEN = 0b0100, 0b0101
_ODD = 0b010101010


def divided(value: Multivector, other: Any) -> Multivector:
    """Return ``A/s``, or ``A/B = A B⁻¹``."""
    divisor = coerced(other, value)
    if divisor is None:
        return NotImplemented  # type: ignore[no-any-return]
    if divisor._mask != 1:
        return value * divisor.inverse()
    if isinstance(divisor._data, np.ndarray):
        zero = divisor._data[..., 0] == 0
        if np.any(zero):
            raise ZeroDivisionError(f"division of a multivector by zero{at_index(first_index(zero))}")
    common_batch(value.shape, divisor.shape)
    a, b = common(value._data, divisor._data)
    with np.errstate(over="ignore", invalid="ignore"):
        quotient = a / b if is_float(a) else kind_of(a, b).divide(a, b)
    return _native.Multivector._of(quotient, value._mask, value.algebra)


def power(value: Multivector, n: Any) -> Multivector:
    """Return a power: an integer one of any value, negative ones through the inverse.

    Of even values, such as motors, also ``exp(n log A)`` for any real n or array of them.
    """
    try:
        exponent = operator.index(n)
    except TypeError:
        if value._held() & _ODD or isinstance(n, str | bytes | complex | type(None)):
            raise TypeError(
                f"a multivector has integer powers, and real ones if it is even; got {n!r}; write "
                "(n * A.log()).exp() for others"
            ) from None
        logarithm: Multivector = value.log() * number_like(n, "the power", value._data)
        found: Multivector = logarithm.exp()
        return found
    base = value.inverse() if exponent < 0 else value
    exponent = abs(exponent)
    if exponent == 0:
        first = value._data[..., :1]
        one = np.ones_like(first) if is_float(first) else kind_of(first).zeros_like(first) + 1
        return _native.Multivector._of(one, 1, value.algebra)
    result: Multivector | None = None
    while True:
        if exponent & 1:
            result = base if result is None else result * base
        exponent >>= 1
        if not exponent:
            return result  # type: ignore[return-value]
        base = base * base


def power_of(value: Multivector, base: Any) -> Multivector:
    """``base**A = exp(A log base)`` for a number base > 0, so ``math.e**B`` is ``exp B``."""
    if not isinstance(base, int | float | np.integer | np.floating):
        return NotImplemented  # type: ignore[no-any-return]
    if not base > 0:
        raise ValueError(f"the base of a power of a multivector must be > 0, got {base}")
    found: Multivector = (value * math.log(base)).exp()
    return found


def as_precise(value: Multivector, like: Multivector) -> Multivector:
    """Convert a value of float64 to single precision if the other has it."""
    if like._is_one or not isinstance(like._data, np.ndarray):
        return value
    return value.astype(np.float32) if like._data.dtype in (np.float32, np.complex64) else value


def norm_squared(value: Multivector) -> Any:
    """Return ``⟨A ~A⟩``, of the batch shape; in 3-d space the sum of the squared components.

    Of complex coefficients the real ``⟨A ~A*⟩``, with the complex conjugate: squared magnitudes. For the
    complex number without it see ``A.scalar_product(~A)``.

    Examples
    --------
    >>> print(ph.vector([3, 4, 0]).norm_squared())
    25.0
    """
    if (found := _native.norm_squared(value)) is not None:
        return np.float64(found) if isinstance(found, float) else found
    data, signs = value._data, value.algebra._reverse_squares(value._mask)
    if is_float(data) or is_complex(data):
        with np.errstate(over="ignore"):
            counted, signs = _counted(data, signs)
            return (kind_of(counted).squared(counted) * signs).sum(axis=-1)[()]
    kind = kind_of(data)
    if not kind.exact and min(signs) > 0:
        return _generic.functions.norm_squared(kind, data)
    square = value.scalar_product(~value)._data[..., 0]
    return square[()] if isinstance(square, np.ndarray) else square


def norm(value: Multivector) -> Any:
    """Return ``√⟨A ~A⟩`` without intermediate overflow: a float, or an array of the batch shape.

    Where squares may be negative, ``√abs⟨A ~A⟩``. Of complex coefficients, the norm of their magnitudes. The
    norm has no derivative at zero; JAX gives 0 there. Use `norm_squared` to differentiate the square.

    Examples
    --------
    >>> print(ph.vector([3, 4, 0]).norm())
    5.0
    >>> print((2 * ph.e1 ^ 3 * ph.e2).norm())
    6.0
    """
    if (found := _native.norm_of(value)) is not None:
        return np.float64(found) if isinstance(found, float) else found
    single = _native.unit_and_size(value)
    if single is not None:
        return np.float64(single[0] * single[1])
    data, signs = _real(value._data), value.algebra._reverse_squares(value._mask)
    if not is_float(data):
        kind = kind_of(data)
        return _generic.functions.norm(kind, data) if min(signs) > 0 else kind.sqrt(abs(norm_squared(value)))
    if min(signs) > 0 and len(signs) <= 8:
        return mapped(_native.norm, data)[..., 0][()]
    unit, size = _unit_and_size(data, value)
    with np.errstate(over="ignore"):
        return (size * unit)[..., 0][()]


def _real(data: Any) -> Any:
    """Return complex components as their magnitudes."""
    return np.abs(data) if is_complex(data) else data


def _counted(data: Array, signs: Signs) -> tuple[Array, Signs]:
    """Return the components that count in the norm, those with ``E ~E`` not 0, and these signs."""
    if signs.all():
        return data, signs
    # In C order, as sums depend on the order of memory.
    return np.ascontiguousarray(data[..., signs != 0]), signs[signs != 0]


def _unit_and_size(data: Array, value: Multivector) -> tuple[Array, Array]:
    """Return the largest magnitude of the components that count, and the norm in units of it."""
    found = mapped(lambda rows: _native.units_and_sizes(value.algebra, value._mask, rows), data)
    return found[..., :1], found[..., 1:]


def normalized(value: Multivector, *, errors: Errors = "raise") -> Multivector:
    """Return ``A/|A|``; a ValueError for zero and non-finite values, or with ``errors="mask"`` NaN there.

    Even values of Cl(3,0,1) with scalars and bivectors, such as motors, are divided by the dual number
    ``√(M ~M)``, so that the result is a motor, with ``M ~M = 1``.

    Examples
    --------
    >>> ph.vector([3, 4, 0]).normalized()
    0.6 e1 + 0.8 e2
    """
    if errors != "raise":
        return masked(errors, normalized, (value, 1))
    if (found := _native.normalized(value)) is not None:
        return found
    if value._mask & _EVEN != _EVEN or not _motors.is_motor(value):
        return _over_norm(value)
    unit = _motors.normalized(value)
    return _motors.without_excess(_over_norm(value)) if unit is None else unit


def _over_norm(value: Multivector) -> Multivector:
    single = _native.unit_and_size(value)
    if single is not None and single[1] > _cancelled(float):
        return value / single[0] / single[1]
    data, signs = value._data, value.algebra._reverse_squares(value._mask)
    if not is_float(data) and not is_complex(data):
        if min(signs) > 0:
            return value._like(_generic.functions.normalized(kind_of(data), data))
        divisor = coerced(norm(value), value)
        assert divisor is not None  # a norm is a coefficient
        return value / divisor
    # Scaling by the largest component first keeps subnormal values accurate.
    unit, size = _unit_and_size(_real(data), value)
    usable = np.isfinite(data).all(axis=-1) & (size > _cancelled(data.dtype))[..., 0]
    _require(usable, "has no direction (norm {})", value)
    return value._like(data / unit / size)


def _cancelled(dtype: Any) -> float:
    """Return the norm in units of the largest component up to which it is rounding, where squares cancel."""
    return 8 * float(np.finfo(dtype).eps)


def _require(ok: Any, what: str, value: Multivector) -> None:
    """Raise a ValueError that names the first batch index where `ok` is false, and the norm there."""
    if np.all(ok):
        return
    index = first_index(~np.asarray(ok))
    raise ValueError(f"the multivector{at_index(index)} {what.format(np.asarray(norm(value))[index])}")


def require_in_range(name: str, result: Multivector, value: Multivector) -> None:
    """Raise a ValueError, with the batch index, where a function of the value overflows."""
    if is_float(result._data) or is_complex(result._data):
        _require_finite(name, result._data, value)
    else:
        _generic.numeric.require_in_range(kind_of(result._data), result._data)


def _require_finite(name: str, result: Array, value: Multivector) -> None:
    in_range = np.isfinite(result).all(axis=-1)
    _require(in_range, f"of norm {{}} has no {name} in the range of {result.dtype}; scale it", value)


def function(name: str, value: Multivector) -> Multivector:
    """Return inverse, exp, log or sqrt: in the compiled core for floats, else by the generic formulas."""
    algebra, data = value.algebra, value._data
    if is_float(data):
        mask, single = algebra._grades_of_function(name, value._mask), data.dtype == np.float32
        motor = _motors.of_floats(name, value, mask)
        if motor is not None:
            if single:  # rounded to float32 after the core has looked
                _require_finite(name, motor._data, value)
            return motor

        def native(rows: Array) -> Array:
            return _native.function(algebra, name, rows, single)[..., algebra._indices(mask)]

        result = mapped(native, _parts.over_grades(value, algebra._all))
        _require_finite(name, result, value)
    elif algebra.signature == (3, 0, 0) and not is_complex(data):
        result, mask = getattr(_generic.functions, name)(kind_of(data), data, value._mask)
    else:
        result, mask = _generic_function(name, value)
    return _native.Multivector._of(result, mask, algebra)


def _generic_function(name: str, value: Multivector) -> tuple[Any, int]:
    """Return a function of complex or generic coefficients."""
    algebra = value.algebra
    if name != "inverse" and _motors.is_motor(value) and not is_complex(value._data):
        mask = algebra._grades_of_function(name, value._mask)
        return _motors.function(name, value, mask)._data, mask
    if name not in ("inverse", "exp"):
        if is_complex(value._data):
            raise TypeError(
                f"{name} of complex coefficients is not available, only exp and inverse; a value without an "
                "imaginary part has the one of its .real"
            )
        raise TypeError(
            f"{name} in {algebra} needs NumPy floats, got {type(value._data).__name__} of {value.dtype}; "
            "convert exact numbers with .astype(float), other arrays with np.asarray(A.components)"
        )
    mask, everything = algebra._grades_of_function(name, value._mask), algebra._all
    terms, _ = algebra._terms("geometric", everything, everything)
    full = _parts.over_grades(value, everything)
    null = algebra._null_counts()
    if name == "exp":
        rows = _generic.algebras.exp(kind_of(full), terms, algebra._indices(value._mask), full, null)
    else:
        rows = _generic.algebras.inverse(kind_of(full), terms, algebra.dimension, full, null)
    return taken(rows, algebra._indices(mask)), mask


def exp(value: Multivector) -> Multivector:
    """Return ``exp A``; a rotor if A is a real bivector of 3-d space."""
    data, in_space = value._data, value.algebra.signature == (3, 0, 0)
    if value._mask == _BIVECTOR and in_space and is_float(data):
        rotors = new((*value.shape, 4), data.dtype)
        _native.rotor_exp(data, rotors)
        return _native.Rotor._from_rows(rotors)
    result = function("exp", value)
    real_rotor = result._mask == _EVEN and in_space and not is_complex(data)
    if real_rotor and not value._held() & ~_BIVECTOR:
        return _native.Rotor._from_rows(result._data)
    return result
