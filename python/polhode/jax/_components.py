"""Rotors, vectors and bivectors as tuples of components, each an array of any shape.

A batch of bodies is one array per component, which compilers run in SIMD lanes or GPU threads. Each step is
the same code for one body, for a batch, under ``vmap`` and inside a kernel. The components of a bivector are
those of its axial vector; sums are in the order of the compiled core, so that both round alike.
"""

from __future__ import annotations

import math

from polhode.jax._library import Array, jnp, lax

Three = tuple[Array, Array, Array]
Four = tuple[Array, Array, Array, Array]

# cos √z and sin √z/√z in z up to (π/2)²: the first omitted terms are below 1e-18, in single precision 1e-8.
_COS, _SINC = ([(-1) ** k / math.factorial(2 * k + odd) for k in range(12 - odd)] for odd in (0, 1))
_SINGLE_TERMS = 7
# π in three parts, the first two of 33 bits, so that their products with small whole numbers are exact.
_PI = (3.1415926534682512, 1.2154201012607932e-10, 4.044532497591901e-21)


def split(x: Array) -> tuple[Array, ...]:
    """Return the components of the last axis."""
    return tuple(x[..., k] for k in range(x.shape[-1]))


def joined(components: tuple[Array, ...]) -> Array:
    """Stack broadcast components along the last axis."""
    return jnp.stack(jnp.broadcast_arrays(*components), axis=-1)


def horner(coefficients: list[float], x: Array) -> Array:
    """``Σ c_k x^k``."""
    total = coefficients[-1]
    for c in reversed(coefficients[:-1]):
        total = total * x + c
    return total


# --- vectors and bivectors


def plus(a: Three, b: Three) -> Three:
    """``a + b``."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def minus(a: Three, b: Three) -> Three:
    """``a − b``."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def times(a: Three, s: Array) -> Three:
    """``s a``."""
    return a[0] * s, a[1] * s, a[2] * s


def along(factors: Three, a: Three) -> Three:
    """Multiply each component by its own factor."""
    return factors[0] * a[0], factors[1] * a[1], factors[2] * a[2]


def dot(a: Three, b: Three) -> Array:
    """The sum of the products of components."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Three, b: Three) -> Three:
    """The components of ``a∧b`` of vectors; of axial vectors those of ``−A×B``."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def length(a: Three) -> Array:
    """``|a|``; its derivative at 0 is 0."""
    square = dot(a, a)
    zero = square == 0
    return jnp.where(zero, 0.0, jnp.sqrt(jnp.where(zero, 1.0, square)))


# --- rotors


def reverse(r: Four) -> Four:
    """``~R``."""
    return r[0], -r[1], -r[2], -r[3]


def compose(r: Four, q: Four) -> Four:
    """``R q``."""
    s, t, a, b = r[0], q[0], r[1:], q[1:]
    turned = minus(plus(times(b, s), times(a, t)), cross(a, b))
    return s * t - dot(a, b), *turned


def twice_the_rate(r: Four, omega: Three) -> Four:
    """``−R Ω``, which is ``2 R'``."""
    s, x, y, z = r
    a, b, c = omega
    return (
        x * a + y * b + z * c,
        (y * c - z * b) - s * a,
        (z * a - x * c) - s * b,
        (x * b - y * a) - s * c,
    )


def turned(r: Four, v: Three) -> Three:
    """``R v ~R``, of a vector or a bivector."""
    q = -r[1], -r[2], -r[3]
    t = times(cross(q, v), 2.0)
    return plus(plus(v, times(t, r[0])), cross(q, t))


def normalized(r: Four) -> Four:
    """``R/|R|``."""
    factor = lax.rsqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3])
    return r[0] * factor, r[1] * factor, r[2] * factor, r[3] * factor


def renormalized(r: Four) -> Four:
    """``R/|R|`` to third order in ``|R|² − 1``.

    The correction is added: factors just below and above 1 round differently, so that |R| would drift.
    """
    excess = (r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]) - 1.0
    missing = excess * (excess * 0.375 - 0.5)
    return r[0] + r[0] * missing, r[1] + r[1] * missing, r[2] + r[2] * missing, r[3] + r[3] * missing


def exponential(b: Three) -> Four:
    """``exp(B)``."""
    cos, sinc = cosine_and_sinc(dot(b, b))
    return cos, *times(b, sinc)


def cosine_and_sinc(square: Array) -> tuple[Array, Array]:
    """``cos x`` and ``sin x/x`` of ``x² = square``, to a few roundings, with derivatives also at 0.

    ``x = nπ + r`` with ``|r| <= π/2``, and series in r², which is x² itself where n = 0: there is no root
    then, and no branch for lanes to wait for. The turns of steps are short, so that n is 0 for nearly all.
    The reciprocal root serves for both x and the quotient, because GPUs have neither roots nor quotients.
    """
    short = square < 2.4
    reciprocal = lax.rsqrt(jnp.where(short, 1.0, square))
    x = jnp.where(short, 1.0, square) * reciprocal
    n = jnp.where(short, 0.0, jnp.floor(x * (1 / math.pi) + 0.5))
    r = ((x - n * _PI[0]) - n * _PI[1]) - n * _PI[2]
    z = jnp.where(short, square, r * r)
    sign = 1.0 - 2.0 * (n - 2.0 * jnp.floor(0.5 * n))
    terms = len(_COS) if square.dtype == "float64" else _SINGLE_TERMS
    cos, sinc = sign * horner(_COS[:terms], z), sign * horner(_SINC[:terms], z)
    return cos, jnp.where(short, sinc, sinc * (r * reciprocal))
