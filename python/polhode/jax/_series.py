"""Theta series of free motions in q and in q', as in `crates/rigid/src/exact/free/series.rs`, over arrays."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from polhode.jax._components import Four, Three, horner
from polhode.jax._library import jnp

Array = Any
Waves = tuple[Four, Three, tuple[Array]]

# The largest nome for the trigonometric series.
LARGEST_NOME = 0.2
# Polynomials that all fulfil p_(n+1) = 2x p_n − p_(n−1), by that at −1 in powers of x: T, U, V and W.
_T, _U, _V, _W = [0, 1], [0, 0], [1, 0], [-1, 0]


def polynomial(count: int, harmonic: Callable[[int], Array], before: list[int]) -> list[Array]:
    """Return ``Σ h_n p_n(x)`` in powers of x, with ``p_0 = 1`` and p_(−1) as given."""
    previous = before + [0] * (count - 2) if count > 1 else before[:1]
    p = [1] + [0] * (count - 1)
    total: list[Array] = [0.0] * count
    for n in range(count):
        h = harmonic(n)
        total = [t + h * c if c else t for t, c in zip(total, p, strict=True)]
        previous, p = p, [2 * c - d for c, d in zip([0, *p[:-1]], previous, strict=True)]
    return total


def _sign(n: int) -> float:
    return -1.0 if n % 2 else 1.0


def circular(q: Array, rho: Array, s: Array, sin: Array, cos: Array) -> Waves:
    """From the nome, ``ρ = exp(−π(K' − η)/2K)``, and the sine and cosine of v."""
    other = jnp.where(rho > 0, q / jnp.where(rho > 0, rho, 1.0), 0.0)

    def even(n: int, sign: float) -> Array:
        if n == 0:
            return jnp.ones_like(q)
        return _sign(n) * q ** (2 * n * n - n) * (rho ** (2 * n) + sign * other ** (2 * n))

    def odd(n: int, sign: float) -> Array:
        return _sign(n) * q ** (2 * n * n + n) * (rho ** (2 * n + 1) + sign * other ** (2 * n + 1))

    def squares(n: int) -> Array:
        return jnp.ones_like(q) if n == 0 else 2.0 * q ** (n * n)

    # cos 2v, from the smaller of the two.
    x = 1.0 - 2.0 * (sin * sin)
    z = (
        horner(polynomial(4, lambda n: even(n, 1.0), _T), x),
        sin * horner(polynomial(4, lambda n: s * odd(n, 1.0), _W), x),
        cos * horner(polynomial(4, lambda n: -odd(n, -1.0), _V), x),
        2.0 * sin * cos * horner(polynomial(3, lambda n: s * even(n + 1, -1.0), _U), x),
    )
    series = (
        polynomial(5, lambda n: q ** (n * n + n), _V),
        polynomial(5, lambda n: _sign(n) * q ** (n * n + n), _W),
        polynomial(5, squares, _T),
    )
    under = polynomial(5, lambda n: _sign(n) * squares(n), _T)
    # Factors for which cn 0, sn K and dn 0 are 1.
    units = tuple(horner(under, at) / horner(c, at) for c, at in zip(series, (1.0, -1.0, 1.0), strict=True))
    parts = tuple(u * horner(c, x) / horner(under, x) for u, c in zip(units, series, strict=True))
    return z, (cos * parts[0], sin * parts[1], parts[2]), (jnp.zeros_like(sin),)


def hyperbolic(border: Array, gamma: Array, s: Array, turns: Array, ahead: Array) -> Waves:
    """From X, ``γ = πη/4K'`` and v in turns, within [−½, ½]; `ahead` is sγ/π, and 0 on the separatrix."""
    most = 352.0 if jnp.finfo(turns.dtype).bits == 64 else 43.0
    nome, root = jnp.exp(-4.0 * border), jnp.exp(-2.0 * border)

    # Half periods, f = v/π in [−½, ½].
    whole = jnp.where(turns > 0.25, 1.0, jnp.where(turns < -0.25, -1.0, 0.0))
    f = 2.0 * turns - whole
    odd, side = 1.0 - 2.0 * jnp.abs(whole), jnp.copysign(1.0, f)
    near = jnp.minimum(4.0 * border * jnp.abs(f), most)
    far = 8.0 * border * jnp.maximum(0.5 - jnp.abs(f), 0.0)
    # e^{−2|x|} and less 1; 1 − e^{−4(X − |x|)}. All in units of ½ e^{|x|}.
    g, m, last = jnp.exp(-near), jnp.expm1(-near), -jnp.expm1(-far)
    c = 0.5 * (g + 1.0 / g)
    cosh, sinh = 1.0 + g, -m * side
    z = (
        cosh * horner(polynomial(4, lambda n: root ** (n * n + n) * jnp.cos((2 * n + 1) * gamma), _V), c),
        odd
        * sinh
        * horner(
            polynomial(4, lambda n: s * _sign(n) * root ** (n * n + n) * jnp.cos((2 * n + 1) * gamma), _W), c
        ),
        odd
        * cosh
        * horner(
            polynomial(4, lambda n: -_sign(n) * root ** (n * n + n) * jnp.sin((2 * n + 1) * gamma), _V), c
        ),
        sinh
        * horner(polynomial(4, lambda n: -s * root ** (n * n + n) * jnp.sin((2 * n + 1) * gamma), _W), c),
    )

    def pronics(n: int) -> Array:
        return nome ** (n * n + n)

    def squares(n: int) -> Array:
        return jnp.ones_like(nome) if n == 0 else 2.0 * nome ** (n * n)

    # θ4(2ix|q') without the factor that vanishes at ±X: 1 − 2q'³ cosh 4x and 1 − 2q'⁵ cosh 4x.
    third, fifth = 2.0 * nome**3, 2.0 * nome**5
    cosine = [jnp.ones_like(nome), -(third + fifth), third * fifth]
    sine = polynomial(4, lambda n: _sign(n) * pronics(n), _W)
    even, under = polynomial(4, squares, _T), polynomial(4, pronics, _V)
    y, square = 2.0 * (c * c) - 1.0, g * g
    units = _units(border, nome, cosine, sine, even, under, most)
    below = (1.0 + square) * horner(under, y)
    functions = (
        odd * (2.0 * g) * (last * (1.0 - nome * square)) * horner(cosine, y) * units[0] / below,
        odd * side * (-m * (1.0 + g)) * horner(sine, y) * units[1] / below,
        (2.0 * g) * horner(even, y) * units[2] / below,
    )
    return z, functions, (ahead * f,)


def _units(
    border: Array, nome: Array, cosine: Any, sine: Any, even: Any, under: Any, most: float
) -> tuple[Array, ...]:
    """Return the factors for which cn 0 and dn 0 are 1, and sn is 1 at X, where dn = k'."""
    at_0 = horner(under, 1.0)
    double = 2.0 * jnp.minimum(border, 0.5 * most)
    g, y = jnp.exp(-double), jnp.cosh(2.0 * double)
    sinh = (1.0 - g * g) / (1.0 + g * g) * horner(sine, y)
    less = (1.0 - nome) * (1.0 - nome)
    return at_0 / horner(cosine, 1.0) / less, horner(under, y) / sinh, at_0 / horner(even, 1.0)
