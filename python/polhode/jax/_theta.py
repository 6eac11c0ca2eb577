"""The exact free flow in JAX alone; `crates/rigid/src/exact/free/mod.rs` has the derivation.

Both forms of the series are computed for each body; its nome selects one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from polhode.jax._components import (
    Four,
    Three,
    compose,
    dot,
    horner,
    joined,
    normalized,
    reverse,
    split,
    times,
)
from polhode.jax._library import Array, jax, jnp
from polhode.jax._orbit_of_free import Orbit

Waves = tuple[Four, Three, tuple[Array]]

# u over the turns on the separatrix: an upper bound.
_NEVER = 2.0**70
# The largest nome for the trigonometric series.
_LARGEST_NOME = 0.2
# Polynomials that all fulfil p_(n+1) = 2x p_n − p_(n−1), by that at −1 in powers of x: T, U, V and W.
_T, _U, _V, _W = [0, 1], [0, 0], [1, 0], [-1, 0]


def flow(moments: Array, rotor: Array, omega: Array, time: Array) -> tuple[Array, Array]:
    """Rotors (..., m, 4) and angular velocities (..., m, 3) of bodies (...), each at its times (..., m)."""
    i, r, w = (tuple(x[..., None] for x in split(y)) for y in (moments, rotor, omega))
    known = (i[0] > 0) & (i[1] > 0) & (i[2] > 0) & jnp.isfinite(sum(i) + sum(r) + sum(w))
    size, scale = _power_of_two(i), _power_of_two(w)
    i, w = tuple(x / size for x in i), tuple(x / scale for x in w)
    tumbles = known & _tumbles(i, w)
    turn, spin = _steady(_without_slopes(w, i, jnp.where(tumbles, 1.0, jnp.nan)), time * scale)
    # Where it is steady, substitute any tumbling motion.
    some = [jnp.where(tumbles, x, k) for k, x in zip((1.0, 2.0, 3.0), i, strict=True)]
    rates = [jnp.where(tumbles, x, 1.0) for x in w]
    tumbled, spins = _tumbling(Orbit.of(tuple(some), tuple(rates)), time * scale)
    turn = tuple(jnp.where(tumbles, x, y) for x, y in zip(tumbled, turn, strict=True))
    spin = tuple(jnp.where(tumbles, x, y) for x, y in zip(spins, spin, strict=True))
    found = joined(compose(normalized(r), turn)), joined(times(spin, scale))
    rotors, omegas = (jnp.where(known[..., None], x, jnp.nan) for x in found)
    return rotors, omegas


def _power_of_two(components: tuple[Array, ...]) -> Array:
    """The power of two next below the largest magnitude; 1 for zeros."""
    largest = jnp.maximum(jnp.maximum(abs(components[0]), abs(components[1])), abs(components[2]))
    usable = (largest > 0) & jnp.isfinite(largest)
    exponent = jnp.floor(jnp.log2(jnp.where(usable, largest, 1.0)))
    return jnp.ldexp(jnp.ones_like(largest), exponent.astype(jnp.int32))


def _tumbles(i: Any, w: Any) -> Array:
    """Whether ``I(Ω)`` is not parallel to Ω."""
    tiny = float(jnp.finfo(i[0].dtype).tiny) ** 0.45
    turning = [abs((i[(k + 1) % 3] - i[(k + 2) % 3]) * w[(k + 1) % 3] * w[(k + 2) % 3]) for k in range(3)]
    return (turning[0] > tiny) | (turning[1] > tiny) | (turning[2] > tiny)


def _steady(w: Any, time: Array) -> tuple[Four, Three]:
    """``exp(−½ Ω t)``."""
    square = dot(w, w)
    still = square == 0
    size = jnp.sqrt(jnp.where(still, 1.0, square))
    sin, cos = _sin_cos(jnp.where(still, 0.0, size * time * (0.25 / math.pi)))
    x, y, z = times(w, -1.0 / size)
    zero = jnp.zeros_like(time)
    return (cos, sin * x, sin * y, sin * z), (w[0] + zero, w[1] + zero, w[2] + zero)


@jax.custom_jvp
def _without_slopes(w: Any, i: Any, factor: Array) -> Any:
    """Return w with NaN derivatives: neighbours of a steady motion are not steady."""
    return w


@_without_slopes.defjvp
def _without_slopes_jvp(primals: Any, tangents: Any) -> Any:
    w, _, factor = primals
    change = sum(tangents[0]) + sum(tangents[1])
    return w, tuple(change * factor for _ in w)


def _sin_cos(turns: Array) -> tuple[Array, Array]:
    angle = (turns - jnp.round(turns)) * (2.0 * math.pi)
    return jnp.sin(angle), jnp.cos(angle)


def _tumbling(orbit: Orbit, time: Array) -> tuple[Four, Three]:
    """``~W(0) W(t)`` and the angular velocity."""
    # The start is the first of the times.
    z, functions = _states(orbit, jnp.concatenate([jnp.zeros_like(time[..., :1]), time], axis=-1))
    rotor = normalized(_in_axes(orbit, z))
    first, rotor = (tuple(x[..., part] for x in rotor) for part in (slice(1), slice(1, None)))
    parts = tuple(x * f[..., 1:] for x, f in zip(orbit.amplitudes, functions, strict=True))
    return compose(reverse(first), rotor), orbit.order.placed(parts)


def _in_axes(orbit: Orbit, z: Four) -> Four:
    """Compose quaternion units, the negatives of the planes of (e1, e2, d)."""
    planes = tuple(-sign * x for sign, x in zip(orbit.signs, z[1:], strict=True))
    return z[0], *orbit.order.placed(planes)


def _states(orbit: Orbit, time: Array) -> tuple[Four, Three]:
    """``exp(½νt) Z`` up to its norm, and cn, sn and dn."""
    other, mean = orbit.other, orbit.mean
    whole, rest = orbit.start
    per_u = jnp.where(orbit.on_separatrix, 1.0 / _NEVER, mean * (0.5 / math.pi))
    turns = jnp.where(orbit.on_separatrix, 0.0, 0.25 * whole) + (rest * per_u + orbit.rate * per_u * time)
    turns = turns - jnp.round(turns)
    nome = jnp.where(other > 0, jnp.exp(-math.pi * mean / jnp.where(other > 0, other, 1.0)), 0.0)
    circular = (nome <= _LARGEST_NOME) & ~orbit.on_separatrix
    rho = jnp.where(circular, jnp.exp(-orbit.rest_of_eta * mean), 0.0)
    near = _trigonometric(jnp.where(circular, nome, 0.0), rho, orbit.s, *_sin_cos(turns))
    gamma = jnp.where(circular, 0.0, 0.5 * orbit.eta * other)
    border = jnp.where(circular, 1.0, 0.25 * math.pi * other / mean)
    border = jnp.where(orbit.on_separatrix, _NEVER / 8.0, border)
    ahead = jnp.where(orbit.on_separatrix, 0.0, orbit.s * gamma / math.pi)
    far = _hyperbolic(border, gamma, orbit.s, turns, ahead)
    z, functions, (ahead,) = (
        tuple(jnp.where(circular, x, y) for x, y in zip(near[part], far[part], strict=True))
        for part in range(3)
    )
    sin, cos = _sin_cos(orbit.precession * time * (0.25 / math.pi) + ahead)
    turned = (
        cos * z[0] - sin * z[3],
        cos * z[1] - sin * z[2],
        cos * z[2] + sin * z[1],
        cos * z[3] + sin * z[0],
    )
    return turned, functions


# --- theta series in q and in q', as in `crates/rigid/src/exact/free/series.rs`


def _polynomial(count: int, harmonic: Callable[[int], Array], before: list[int]) -> list[Array]:
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


def _trigonometric(q: Array, rho: Array, s: Array, sin: Array, cos: Array) -> Waves:
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
        horner(_polynomial(4, lambda n: even(n, 1.0), _T), x),
        sin * horner(_polynomial(4, lambda n: s * odd(n, 1.0), _W), x),
        cos * horner(_polynomial(4, lambda n: -odd(n, -1.0), _V), x),
        2.0 * sin * cos * horner(_polynomial(3, lambda n: s * even(n + 1, -1.0), _U), x),
    )
    series = (
        _polynomial(5, lambda n: q ** (n * n + n), _V),
        _polynomial(5, lambda n: _sign(n) * q ** (n * n + n), _W),
        _polynomial(5, squares, _T),
    )
    under = _polynomial(5, lambda n: _sign(n) * squares(n), _T)
    # Factors for which cn 0, sn K and dn 0 are 1.
    units = tuple(horner(under, at) / horner(c, at) for c, at in zip(series, (1.0, -1.0, 1.0), strict=True))
    parts = tuple(u * horner(c, x) / horner(under, x) for u, c in zip(units, series, strict=True))
    return z, (cos * parts[0], sin * parts[1], parts[2]), (jnp.zeros_like(sin),)


def _hyperbolic(border: Array, gamma: Array, s: Array, turns: Array, ahead: Array) -> Waves:
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

    def wave(sign: Callable[[int], Array], of: Callable[[Array], Array], before: list[int]) -> Array:
        return horner(
            _polynomial(4, lambda n: sign(n) * root ** (n * n + n) * of((2 * n + 1) * gamma), before), c
        )

    z = (
        cosh * wave(lambda n: 1.0, jnp.cos, _V),
        odd * sinh * wave(lambda n: s * _sign(n), jnp.cos, _W),
        odd * cosh * wave(lambda n: -_sign(n), jnp.sin, _V),
        sinh * wave(lambda n: -s, jnp.sin, _W),
    )

    def pronics(n: int) -> Array:
        return nome ** (n * n + n)

    def squares(n: int) -> Array:
        return jnp.ones_like(nome) if n == 0 else 2.0 * nome ** (n * n)

    # θ4(2ix|q') without the factor that vanishes at ±X: 1 − 2q'³ cosh 4x and 1 − 2q'⁵ cosh 4x.
    third, fifth = 2.0 * nome**3, 2.0 * nome**5
    cosine = [jnp.ones_like(nome), -(third + fifth), third * fifth]
    sine = _polynomial(4, lambda n: _sign(n) * pronics(n), _W)
    even, under = _polynomial(4, squares, _T), _polynomial(4, pronics, _V)
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
