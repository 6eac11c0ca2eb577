"""Inverse and exp in algebras of any signature, over arrays of any coefficients.

An algebra of n generators is its geometric product, a list of terms over all 2ⁿ blades (see `products`), of
which the first is the scalar 1. Data are arrays (..., 2ⁿ).
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from polhode._generic.coefficients import Coefficients
from polhode._generic.compiled import compiled
from polhode._generic.exact import by_rows, call, divide, is_symbolic, is_zero
from polhode._generic.g3_exact import free_root
from polhode._generic.g3_smooth import COSH, SINHC, horner
from polhode._generic.numeric import Array, Numeric, components, require_in_range
from polhode._generic.products import Term, product

# exp's series for |M| <= 1/2: the first term left out is 2⁻¹⁶/16! < 1e-18.
_TAYLOR = [1 / math.factorial(k) for k in range(16)]
# Halvings of an argument of unknown size: |M| up to 2¹¹.
_TRACED_HALVINGS = 12
_STEP_OF_HALVINGS = 4
# A product with the inverse this far from 1: only three digits are left.
_RESIDUAL = 2.0**-10


# --- inverse


@compiled
def inverse(
    d: Coefficients, terms: Sequence[Term], generators: int, data: Array, null: Sequence[int] = ()
) -> Array:
    """``U⁻¹``, exact for exact coefficients; a ValueError with the batch index where there is none.

    `null` counts the generators of square 0 in each blade, where there are any.

    By Faddeev and LeVerrier's recursion for the characteristic polynomial, whose trace is N times the
    scalar part for matrices of size ``N = 2^⌈n/2⌉`` (Shirokov, Comput. Appl. Math. 40 (2021)):

        U_k = U A_(k−1),   C_k = N/k ⟨U_k⟩,   A_k = U_k − C_k,   A_0 = 1,

    ends in ``U A_(N−1) = ⟨U_N⟩``, a number. The only divisions are by whole numbers and, at the end, by this
    number. These are identities between polynomials in the squares of the generators, so generators may
    square to 0 as well.
    """
    if isinstance(d, Numeric):
        with np.errstate(all="ignore"):
            regular = [data[..., i] for i in range(data.shape[-1]) if not null or null[i] == 0]
            largest = d.largest(regular)
            factors = null_factors(d, null, data, d.where(largest > 0, largest, 1.0))
            result = _refined_inverse(d, terms, generators, data * factors) / factors
            require_in_range(d, result)
            return result
    adjugate, determinant = _adjugate(d, terms, generators, data)
    singular = np.frompyfunc(is_zero, 1, 1)(determinant)
    d.require(np.logical_not(np.asarray(singular, dtype=bool)), "no inverse: the multivector is singular")
    return d.divide(adjugate, np.asarray(determinant, dtype=object)[..., None])


def _adjugate(d: Coefficients, terms: Sequence[Term], generators: int, u: Array) -> tuple[Array, Array]:
    """Return ``A_(N−1)`` and ``⟨U_N⟩``."""
    size, count = 2 ** ((generators + 1) // 2), u.shape[-1]
    adjugate = _number(d, u, 1)
    for k in range(1, size):
        power = product(d, terms, count, u, adjugate)
        trace = d.divide(size * power[..., 0], k)
        adjugate = d.stack([power[..., 0] - trace, *components(power)[1:]])
    return adjugate, product(d, terms, count, u, adjugate)[..., 0]


def _refined_inverse(d: Numeric, terms: Sequence[Term], generators: int, data: Array) -> Array:
    """Return the inverse; Newton's step ``X(2 − UX)`` restores the digits that the recursion loses."""
    d.require_finite(components(data))
    scale = d.scale(components(data))[..., None]
    u, count = data / scale, data.shape[-1]
    adjugate, determinant = _adjugate(d, terms, generators, u)
    x, one = adjugate / determinant[..., None], _number(d, u, 1)
    for _ in range(2):
        x = product(d, terms, count, x, 2.0 * one - product(d, terms, count, u, x))
    residual = d.xp.max(d.xp.abs(product(d, terms, count, u, x) - one), axis=-1)
    d.require(residual <= _RESIDUAL, "no inverse: the multivector is singular to rounding")
    return x / scale


def _number(d: Coefficients, like: Array, value: int) -> Array:
    """Return a number as a multivector of the shape of another."""
    zero = d.zeros_like(like[..., 0])
    return d.stack([zero + value] + [zero] * (like.shape[-1] - 1))


def null_factors(d: Numeric, null: Sequence[int], data: Array, size: Any) -> Array:
    """Return factors of the components (..., 2ⁿ) that scale those with generators of square 0 down to a size.

    Scaling these generators is an automorphism. With it, large translations do not swamp the rotations beside
    them, nor do they need more halvings of an exponent.
    """
    root = d.zeros_like(d.xp.abs(data[..., 0])) + 1.0
    if not any(null):
        return root[..., None]
    for i, count in enumerate(null):
        if count:
            ratio = d.xp.abs(d.constant(data[..., i])) / size
            root = d.xp.maximum(root, ratio if count == 1 else ratio ** (1 / count))
    exponent = d.xp.ceil(d.xp.log2(d.where(d.xp.isfinite(root), root, 1.0)))
    # The factor of a blade with all of them must stay in range, too.
    most = 0.875 * math.log2(float(d.xp.finfo(d.dtype).max)) // max(null)
    factor = 2.0 ** -d.where(exponent > most, most, exponent)
    powers = [d.zeros_like(factor) + 1.0]
    for _ in range(max(null)):
        powers.append(powers[-1] * factor)
    return d.stack([powers[count] for count in null])


# --- exp


def exp(
    d: Coefficients, terms: Sequence[Term], held: Sequence[int], data: Array, null: Sequence[int] = ()
) -> Array:
    """``exp M``; `held` are the blades of M, its other components are 0; `null` as in `inverse`.

    If all blades held (but 1) anticommute, as those of vectors, the square of their sum is a number and the
    result a closed form. Otherwise the series is summed after halving, and squared back; exact and symbolic
    values must have such a square by their components, else a TypeError.

    A value that only happens to have such a square, like a simple bivector in four dimensions, takes the
    series as well, because derivatives lead away from such values. Values traced by JAX are computed up to
    ``Σ|m| = 2048``; beyond, NaN. Components with generators of square 0 may have any size.
    """
    if not isinstance(d, Numeric):
        return by_rows(functools.partial(_exp_row, terms), data)
    with np.errstate(all="ignore"):
        if _anticommute(terms, [i for i in held if i != 0]):
            return _simple_exp(d, terms, data)
        halvings = _halvings(d, _size(d, data, null))
        return _series_exp(d, terms, data, null, halvings)


def _anticommute(terms: Sequence[Term], held: list[int]) -> bool:
    signs = {(i, j): sign for i, j, _, sign in terms}
    return all(signs.get((i, j), 0) == -signs.get((j, i), 0) for i in held for j in held if i < j)


@compiled
def _simple_exp(d: Numeric, terms: Sequence[Term], data: Array) -> Array:
    d.require_finite(components(data))
    result = _complex_exp(d, terms, data) if d.is_complex else _closed_exp(d, terms, data)
    require_in_range(d, result)
    return result


def _closed_exp(d: Numeric, terms: Sequence[Term], m: Array) -> Array:
    """``e^s (cosh √w + V sinh √w / √w)`` for a number ``V² = w``: boost (w > 0), shift or turn (w < 0)."""
    s, *v = components(m)
    scale = d.scale_of_large(v) if v else d.zeros_like(s) + 1.0
    scaled = d.zeros_like(s)
    for i, j, k, sign in terms:
        if i == j != 0 and k == 0:
            scaled = scaled + sign * (v[i - 1] / scale) * (v[i - 1] / scale)
    w = scaled * scale * scale
    small, turns = d.abs(w) < 1, w < 0
    near = d.where(small, w, 0.0)
    x = scale * d.sqrt(d.where(small, 1.0, d.abs(scaled)))
    # For a boost x is an exponent; exponents are added first, because their sum may be small.
    boost, turn = d.where(turns, 1.0, x), d.where(turns, x, 1.0)
    plus, minus = 0.5 * d.exp(s + boost), 0.5 * d.exp(s - boost)
    factor = d.exp(d.where(small | turns, s, 0.0))
    cosh = d.where(turns, factor * d.cos(turn), plus + minus)
    sinhc = d.where(turns, factor * d.sin(turn) / turn, (plus - minus) / boost)
    c = d.where(small, factor * horner(COSH, near), cosh)
    q = d.where(small, factor * horner(SINHC, near), sinhc)
    return d.stack([c, *(q * component for component in v)])


def _complex_exp(d: Numeric, terms: Sequence[Term], m: Array) -> Array:
    """``e^s (cosh z + V sinh z / z)`` for ``V² = z²``; even in z, so that either root will do."""
    s, *v = components(m)
    w = d.zeros_like(s)
    for i, j, k, sign in terms:
        if i == j != 0 and k == 0:
            w = w + sign * v[i - 1] * v[i - 1]
    small = d.abs(w) < 1
    near, z = d.where(small, w, 0.0), d.sqrt(d.where(small, 1.0, w))
    # Exponents are added first, because their sum may be small.
    plus, minus = 0.5 * d.exp(s + z), 0.5 * d.exp(s - z)
    factor = d.exp(s)
    c = d.where(small, factor * horner(COSH, near), plus + minus)
    q = d.where(small, factor * horner(SINHC, near), (plus - minus) / z)
    return d.stack([c, *(q * component for component in v)])


@compiled
def _size(d: Numeric, data: Array, null: Sequence[int]) -> Array:
    """Return ``Σ|m|`` with generators of square 0 scaled down, as constants."""
    d.require_finite(components(data))
    return _sum_of(d, data * null_factors(d, null, data, 1.0))


def _sum_of(d: Numeric, m: Array) -> Array:
    return d.xp.sum(d.xp.abs(d.constant(m)), axis=-1)[..., None]


def _halvings(d: Numeric, size: Array) -> int:
    """Return the number of halvings after which the largest value is at most 1/2."""
    if not d.is_concrete(size):
        return _TRACED_HALVINGS
    largest = float(d.xp.max(size)) if math.prod(size.shape) else 0.0
    needed = max(0, math.frexp(largest)[1] + 1)
    # Fewer programs for JAX to compile: halvings that no value needs change none.
    return -(-needed // _STEP_OF_HALVINGS) * _STEP_OF_HALVINGS if d.is_jax else needed


@compiled
def _series_exp(d: Numeric, terms: Sequence[Term], data: Array, null: Sequence[int], halvings: int) -> Array:
    """Sum the series of M/2ᵏ and square it k times; k <= `halvings` depends on the size of each value."""
    factors = null_factors(d, null, data, 1.0)
    m = data * factors
    size = _sum_of(d, m)
    bounds = [2.0 ** (k - 1) for k in range(halvings)]
    x = m
    for bound in bounds:
        x = d.where(size > bound, 0.5 * x, x)

    def squared(result: Array, bound: Any) -> Array:
        return d.where(size > bound, product(d, terms, m.shape[-1], result, result), result)

    result = d.folded(squared, _taylor(d, terms, x), bounds)
    result = d.where(size <= 2.0 ** (halvings - 1), result, math.nan) / factors
    require_in_range(d, result)
    return result


def _taylor(d: Numeric, terms: Sequence[Term], x: Array) -> Array:
    """Sum sixteen terms with six products: four blocks of four in powers of x⁴ (Paterson and Stockmeyer)."""
    count = x.shape[-1]
    powers = [_number(d, x, 1), x]
    for _ in range(3):
        powers.append(product(d, terms, count, powers[-1], x))
    total = d.zeros_like(x)
    for block in (3, 2, 1, 0):
        if block < 3:
            total = product(d, terms, count, total, powers[4])
        for k in range(4):
            total = total + _TAYLOR[4 * block + k] * powers[k]
    return total


def _exp_row(terms: Sequence[Term], m: list[Any]) -> list[Any]:
    """Return the closed form for exact components whose non-scalar part squares to a number."""
    s, v = m[0], [0, *m[1:]]
    square: list[Any] = [0] * len(m)
    for i, j, k, sign in terms:
        square[k] = square[k] + sign * v[i] * v[j]
    if not all(is_zero(x) for x in square[1:]):
        raise TypeError(
            "exp of exact or symbolic coefficients needs a multivector whose non-scalar part squares to a "
            "number; split it into commuting parts, or convert it to floats"
        )
    w = square[0]
    if is_zero(w):
        cosh, sinhc = 1, 1
    elif w.is_nonpositive if is_symbolic(w) else w < 0:
        root = free_root(-w)
        cosh, sinhc = call("cos", root), divide(call("sin", root), root)
    else:
        root = free_root(w)
        cosh, sinhc = call("cosh", root), divide(call("sinh", root), root)
    factor = call("exp", s)
    return [factor * cosh, *(factor * sinhc * x for x in v[1:])]
