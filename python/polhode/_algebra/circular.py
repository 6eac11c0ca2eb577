"""Sine, cosine, tangent and their hyperbolic forms of values of any algebra, and the outer exponential."""

from __future__ import annotations

import functools
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _generic, _native
from polhode._algebra.coefficients import kind_of
from polhode._algebra.functions import require_in_range
from polhode._algebra.grades import over_grades
from polhode._algebra.masking import Errors, masked
from polhode._support.arrays import is_complex, is_float

if TYPE_CHECKING:
    from polhode._algebra.algebra import Algebra
    from polhode._algebra.multivector import Multivector

Pair = tuple["Multivector", "Multivector"]

# Of cosh √y and sinh √y / √y for |y| <= 1/4: the first term left out is 2⁻¹⁶/16! < 1e-18.
_COSH = [1 / math.factorial(2 * k) for k in range(8)]
_SINHC = [1 / math.factorial(2 * k + 1) for k in range(8)]
# Halvings of a value traced by JAX, as for exp: Σ|m| up to 2¹¹.
_TRACED_HALVINGS = 12


def sin(value: Multivector) -> Multivector:
    """``sin A = A − A³/3! + …``; `cos` and the others have series of their own, too.

    Of any value in any algebra, accurate near 0. If the part V of A without its scalar squares to a number,
    as a vector and a bivector of 3-d space do, it is a closed form; exact and symbolic coefficients outside
    3-d space need one. While JAX traces, values with ``Σ|a| > 2048`` of another form give NaN.

    Examples
    --------
    >>> (np.pi / 6 * ph.e1).sin()
    0.5 e1
    """
    return _pair("sin", value, -1)[1]


def cos(value: Multivector) -> Multivector:
    """``cos A = 1 − A²/2! + …``; ``cos²A + sin²A = 1``. See `sin`.

    Examples
    --------
    >>> (np.pi / 3 * ph.e1).cos()
    0.5
    """
    return _pair("cos", value, -1)[0]


def tan(value: Multivector, *, errors: Errors = "raise") -> Multivector:
    """``sin A (cos A)⁻¹``; a ValueError, or with ``errors="mask"`` NaN, where cos A has no inverse.

    Examples
    --------
    >>> ph.scalar(np.pi / 4).tan()
    1
    """
    return _ratio("tan", value, -1, errors)


def sinh(value: Multivector) -> Multivector:
    """``sinh A = A + A³/3! + …``, ``½(e^A − e^−A)`` without its cancellation. See `sin`.

    Examples
    --------
    >>> (ph.e1 * np.log(2)).sinh()  # e1² = 1
    0.75 e1
    """
    return _pair("sinh", value, 1)[1]


def cosh(value: Multivector) -> Multivector:
    """``cosh A = 1 + A²/2! + …``, ``½(e^A + e^−A)``. See `sin`.

    Examples
    --------
    >>> c, s = ph.e1.cosh(), ph.e1.sinh()
    >>> bool((c * c - s * s).is_close(1))
    True
    """
    return _pair("cosh", value, 1)[0]


def tanh(value: Multivector, *, errors: Errors = "raise") -> Multivector:
    """``sinh A (cosh A)⁻¹``; errors as of `tan`. See `sin`.

    Examples
    --------
    >>> (ph.e1 * np.log(2)).tanh()
    0.6 e1
    """
    return _ratio("tanh", value, 1, errors)


def outer_exp(value: Multivector) -> Multivector:
    """Return the outer exponential ``1 + A + A∧A/2! + …``, a finite sum for A without a scalar.

    A scalar part s gives a factor ``e^s``. Of a bivector B it is proportional to a versor of size
    ``√(1 + |B|²)`` (in 3-d space): the Cayley form of a rotor.

    Examples
    --------
    >>> (3 * ph.e1 ^ ph.e2).outer_exp()
    1 + 3 e1∧e2
    """
    rest = value.grade(*[k for k in value.grades if k]) if value._mask != 1 else None
    total = _one(value)
    if rest is not None:
        term, lowest = rest, min(rest.grades)
        for k in range(2, value.algebra.dimension // lowest + 2):
            total = total + term
            term = term.wedge(rest) / k
    return total * value.grade(0).exp() if value._mask & 1 else total


def _one(value: Multivector) -> Multivector:
    """Return the scalar 1 in the algebra, batch shape and coefficients of a value."""
    first = value._data[..., :1]
    one = np.ones_like(first) if is_float(first) else first * 0 + 1
    return _native.Multivector._of(one, 1, value.algebra)


def _ratio(name: str, value: Multivector, sign: int, errors: Errors) -> Multivector:
    if errors != "raise":
        return masked(errors, lambda rows: _ratio(name, rows, sign, "raise"), (value, 1))
    cosine, sine = _pair(name, value, sign)
    try:
        return sine * cosine.inverse()
    except ValueError as error:
        raise ValueError(f"{name} has no value where the cosine has no inverse: {error}") from None


def _pair(name: str, value: Multivector, sign: int) -> Pair:
    """Return ``cosh A, sinh A`` for the sign 1, ``cos A, sin A`` for −1."""
    kind = kind_of(value._data)
    if kind.exact:
        return _exact(name, value, sign)
    single = {np.dtype(np.float32): np.float64, np.dtype(np.complex64): np.complex128}
    wide = single.get(value.dtype) if isinstance(value._data, np.ndarray) else None
    given = value.astype(wide) if wide else value
    kind.require_finite([given._data[..., k] for k in range(given._data.shape[-1])])
    with np.errstate(all="ignore"):
        squares = None if is_complex(value._data) else _squares(value.algebra, value._mask)
        pair = _series(kind, given, sign) if squares is None else _closed(kind, given, sign, squares)
    if wide:
        pair = (pair[0].astype(value.dtype), pair[1].astype(value.dtype))
    for part in pair:
        require_in_range(name, part, value)
    return pair


@functools.cache
def _squares(algebra: Algebra, mask: int) -> tuple[int, ...] | None:
    """Return the squares of the basis elements of some grades, 1 aside, if they anticommute; else None.

    The square of every sum of these is then a number.
    """
    blades, signs = algebra._blades(), algebra._reverse_squares(mask)
    held = [(blades[i][0], int(sign)) for i, sign in zip(algebra._indices(mask), signs, strict=True) if i]
    for k, (a, _) in enumerate(held):
        for b, _ in held[:k]:
            if (a.bit_count() * b.bit_count() - (a & b).bit_count()) % 2 == 0:
                return None
    return tuple(-sign if bits.bit_count() % 4 in (2, 3) else sign for bits, sign in held)


def _scalar_and_rest(value: Multivector) -> tuple[Any, list[Any]]:
    """Return the scalar component, None if it is not held, and the others."""
    parts = [value._data[..., k] for k in range(value._data.shape[-1])]
    return (parts[0], parts[1:]) if value._mask & 1 else (None, parts)


def _joined(
    value: Multivector, kind: Any, sign: int, scalars: tuple[Any, Any] | None, functions: tuple[Any, Any]
) -> Pair:
    """Return the pair of ``s + V`` from cosine and sine of s, and ``cosh √u``, ``sinh √u / √u``.

    u is V², for the sign −1 its negative.
    """
    (c, q), (_, rest) = functions, _scalar_and_rest(value)
    of = functools.partial(_native.Multivector._of, algebra=value.algebra)
    if scalars is None:
        return of(c[..., None], 1), of(kind.stack([q * x for x in rest]), value._mask)
    cosine, sine = scalars
    even = kind.stack([cosine * c, *(sign * sine * q * x for x in rest)])
    return of(even, value._mask), of(kind.stack([sine * c, *(cosine * q * x for x in rest)]), value._mask)


# --- floats


def _closed(d: Any, value: Multivector, sign: int, squares: tuple[int, ...]) -> Pair:
    s, rest = _scalar_and_rest(value)
    scale = d.scale_of_large(rest) if rest else s * 0.0 + 1.0
    scaled = scale * 0.0
    for square, x in zip(squares, rest, strict=True):
        scaled = scaled + sign * square * (x / scale) * (x / scale)
    u = scaled * scale * scale
    small, turns = d.abs(u) < 1, u < 0
    near = d.where(small, u, 0.0)
    x = scale * d.sqrt(d.where(small, 1.0, d.abs(scaled)))
    boost, turn = d.where(turns, 1.0, x), d.where(turns, x, 1.0)
    c = d.where(turns, d.cos(turn), d.cosh(boost))
    q = d.where(turns, d.sin(turn) / turn, d.sinh(boost) / boost)
    smooth = _generic.g3_smooth
    functions = (
        d.where(small, smooth.horner(smooth.COSH, near), c),
        d.where(small, smooth.horner(smooth.SINHC, near), q),
    )
    scalars = None if s is None else (d.cosh(s), d.sinh(s)) if sign > 0 else (d.cos(s), d.sin(s))
    return _joined(value, d, sign, scalars, functions)


def _series(d: Any, value: Multivector, sign: int) -> Pair:
    """Sum the series of ``A/2ᵏ`` and double it k times: ``cosh 2x = cosh²x + sinh²x``."""
    algebra = value.algebra
    null = algebra._null_counts()
    # Scaling null generators is an automorphism; then a large translation costs the rotation no digits.
    factors = _generic.algebras.null_factors(d, null, value.dense(), 1.0)
    x = _scaled(value, factors)
    size = d.xp.sum(d.xp.abs(d.constant(x._data)), axis=-1)[..., None]
    halvings = _TRACED_HALVINGS
    if d.is_concrete(size):
        halvings = max(0, math.frexp(float(d.xp.max(size)) if math.prod(size.shape) else 0.0)[1] + 1)
    halved = [size > 2.0 ** (k - 1) for k in range(halvings)]
    data = x._data
    for halve in halved:
        data = d.where(halve, 0.5 * data, data)
    x = x._like(data)
    y = sign * (x * x)
    powers = [_one(value), y, y * y]
    powers += [powers[2] * y, powers[2] * powers[2]]
    c, s = _sum(_COSH, powers), x * _sum(_SINHC, powers)
    for halve in halved:
        doubled = c * c + sign * (s * s), 2 * (s * c)
        c, s = _chosen(d, halve, doubled[0], c), _chosen(d, halve, doubled[1], s)
    if not d.is_concrete(size):
        known = d.where(size <= 2.0 ** (halvings - 1), 1.0, math.nan)
        c, s = c._like(c._data * known), s._like(s._data * known)
    return _scaled(c, 1 / factors), _scaled(s, 1 / factors)


def _scaled(value: Multivector, factors: Any) -> Multivector:
    """Return the value times factors of all basis elements (..., 2ⁿ), or of one for all."""
    if factors.shape[-1] == 1:
        return value._like(value._data * factors)
    return value._like(value._data * factors[..., value.algebra._indices(value._mask)])


def _sum(coefficients: list[float], powers: list[Multivector]) -> Multivector:
    """Return the sum over the powers 0 to 7 of y, from its powers 0 to 4 (Paterson and Stockmeyer)."""
    low, high = (
        sum((c * power for c, power in zip(block[1:], powers[1:4], strict=True)), block[0] * powers[0])
        for block in (coefficients[:4], coefficients[4:])
    )
    return low + powers[4] * high


def _chosen(d: Any, where: Any, new: Multivector, old: Multivector) -> Multivector:
    mask = new._mask | old._mask
    data = d.where(where, over_grades(new, mask), over_grades(old, mask))
    return _native.Multivector._of(data, mask, new.algebra)


# --- exact and symbolic coefficients


def _exact(name: str, value: Multivector, sign: int) -> Pair:
    """Return the closed form where V² is a number; other values of 3-d space by exponentials."""
    exact = _generic.exact
    rest = value - value.grade(0)
    square = rest * rest
    others = (square - square.grade(0))._data
    if not all(exact.is_zero(x) for x in others.flat):
        if value.algebra.signature != (3, 0, 0):
            raise TypeError(
                f"{name} of exact or symbolic coefficients needs a multivector whose non-scalar part squares "
                f"to a number outside 3-d space; convert it with .astype(float)"
            )
        factor = value.algebra.I if sign < 0 else value.algebra.scalar(1.0)  # I² = −1, and I commutes
        plus, minus = (factor * value).exp(), (-factor * value).exp()
        return (plus + minus) / 2, (plus - minus) / 2 * ~factor
    s, _ = _scalar_and_rest(value)
    kinds = ("cosh", "sinh") if sign > 0 else ("cos", "sin")
    scalars = None if s is None else tuple(_each(functools.partial(exact.call, f), s) for f in kinds)
    u = sign * square.grade(0)._data[..., 0]
    functions = _each(_cosine, u), _each(_sine_over_root, u)
    return _joined(value, kind_of(value._data), sign, scalars, functions)


def _each(f: Any, x: Any) -> Any:
    return np.asarray(np.frompyfunc(f, 1, 1)(x), dtype=object)


def _cosine(u: Any) -> Any:
    """``cosh √u``."""
    if _generic.exact.is_zero(u):
        return 1
    name, root = _root(u)
    return _generic.exact.call("cos" if name == "sin" else "cosh", root)


def _sine_over_root(u: Any) -> Any:
    """``sinh √u / √u``."""
    if _generic.exact.is_zero(u):
        return 1
    name, root = _root(u)
    return _generic.exact.divide(_generic.exact.call(name, root), root)


def _root(u: Any) -> tuple[str, Any]:
    """Return the sine to use for u, and ``√|u|``."""
    exact, free_root = _generic.exact, _generic.g3_exact.free_root
    turns = u.is_nonpositive if exact.is_symbolic(u) else u < 0
    return ("sin", free_root(-u)) if turns else ("sinh", free_root(u))
