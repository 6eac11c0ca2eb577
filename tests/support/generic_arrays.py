"""Arrays for tests of the generic algebra, and products as lists of terms by an oracle."""

from fractions import Fraction
from functools import cache

import numpy as np
import pytest

import naive
import polhode as ph
from polhode._generic import coefficients, layout

MASKS = range(1, 16)
EPS = 2.0**-52


@cache
def geometric_terms(mask_a=15, mask_b=15):
    """The geometric product of G3 over the components of these grades, onto all eight."""
    place = {naive.sort_generators(b)[1]: (k, naive.sort_generators(b)[0]) for k, b in enumerate(naive.BASIS)}
    terms = []
    for i, a in enumerate(layout.indices(mask_a)):
        for j, b in enumerate(layout.indices(mask_b)):
            sign, blade = naive.sort_generators(naive.BASIS[a] + naive.BASIS[b])
            k, orientation = place[blade]
            terms.append((i, j, k, sign * orientation))
    return terms


@cache
def signature_terms(p, q, r):
    """The geometric product over the blades in the order of their bits, generators squaring to 1, −1, 0."""
    squares = [1] * p + [-1] * q + [0] * r
    terms = []
    for a in range(1 << len(squares)):
        for b in range(1 << len(squares)):
            sign = 1
            for k, square in enumerate(squares):
                if b >> k & 1:
                    sign *= (-1) ** (a >> (k + 1)).bit_count() * (square if a >> k & 1 else 1)
            if sign:
                terms.append((a, b, a ^ b, sign))
    return terms


def exact(values):
    """An array of objects."""
    array = np.empty(np.shape(values), dtype=object)
    array[...] = values
    return array


def fractions(shape, seed):
    """Small fractions, no component 0."""
    rng = np.random.default_rng(seed)
    tops, bottoms = 2 * rng.integers(-4, 4, shape) + 1, rng.integers(1, 5, shape)
    return np.frompyfunc(lambda a, b: Fraction(int(a), int(b)), 2, 1)(tops, bottoms)


def as_jax(values):
    return pytest.importorskip("jax.numpy").asarray(values)


def as_strict(values):
    return pytest.importorskip("array_api_strict").asarray(values)


FLOATING = {"numpy": np.asarray, "jax": as_jax, "array-api-strict": as_strict}


@pytest.fixture(params=FLOATING)
def floating(request):
    """A function that makes arrays of a library of floats; JAX with 64 bits."""
    if request.param != "jax":
        yield FLOATING[request.param]
        return
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        yield as_jax


def native(name, data, mask):
    """The compiled core's value of a function."""
    full = np.zeros((*data.shape[:-1], 8))
    full[..., layout.indices(mask)] = data
    value = getattr(ph.Multivector._of(full[..., layout.indices(mask)], mask), name)()
    return value.components, value._mask


def multiplied(d, a, mask_a, b, mask_b):
    """The geometric product of values of these grades, all eight components."""
    from polhode._generic.products import product

    return product(d, geometric_terms(mask_a, mask_b), 8, a, b)


def eight_of(data, mask):
    """All eight components of NumPy data."""
    full = np.zeros((*data.shape[:-1], 8), dtype=data.dtype)
    full[..., layout.indices(mask)] = data
    return full


def difference(a, b):
    """|a − b| over components, as float64."""
    return np.linalg.norm(np.asarray(a, dtype=float) - np.asarray(b, dtype=float), axis=-1)


def one_of(like):
    """The number 1 as eight components, for each of a batch."""
    one = np.zeros(like.shape)
    one[..., 0] = 1
    return one


of = coefficients.of
