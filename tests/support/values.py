"""Values of every shape and grade, with whole components, and their exact equals of the oracle."""

from fractions import Fraction

import numpy as np

from naive import of_package, ph_value

EPS = 2.0**-52
SHAPES = [(), (1,), (3,), (0,), (2, 1, 3)]


def numbers(shape, seed):
    """Whole components, small enough that sums of their products are exact."""
    return np.random.default_rng(seed).integers(-9, 10, shape).astype(float)


def a_value(grades, seed, shape=()):
    return ph_value(numbers((*shape, 8), seed), grades)


def fraction_of(M):
    return {blade: x for blade, x in of_package(M).items() if x != 0}


def nonzero(A):
    return {blade: Fraction(x) for blade, x in A.items() if x != 0}
