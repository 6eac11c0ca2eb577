"""Names of the handout and batches of values, shared by its tests.

Integer components make float arithmetic exact, so most equations hold with `==`. Where exponentials
enter, EPS counts roundings: a rotor's components carry about 2 eps, a product of it with a vector sums
four terms and is done twice, so |error| <= 2·(2 + 4) eps |a|; 16 eps is asked.
"""

import numpy as np

import polhode as ph
from naive import magnitude
from polhode import e1, e2, e3

EPS = 2.0**-52
BASIS = (e1, e2, e3)
e12, e23, e31 = e1 * e2, e2 * e3, e3 * e1
B1, B2, B3 = e23, e31, e12


def integers(shape, seed):
    return np.random.default_rng(seed).integers(-9, 10, shape).astype(float)


# Fifty random vectors or bivectors with whole components, as a batch: equations hold for all at once.
a, b, c, x = (ph.vector(integers((50, 3), seed)) for seed in (1, 2, 3, 4))
A, B = ph.bivector(integers((50, 3), 5)), ph.bivector(integers((50, 3), 6))
M, N = ph.multivector(integers((50, 8), 7)), ph.multivector(integers((50, 8), 8))


def same(left, right):
    """Exactly equal, everywhere in the batch."""
    return bool(np.all(left == right))


def close(left, right, size=1.0, count=16):
    """Equal to `count` roundings of values of this size."""
    return bool(np.all(magnitude(left - right) <= count * EPS * size))
