"""Oracle: the algebra of 3-d space, written as plainly as possible.

A blade is the tuple of its generators in rising order, `(1, 3)` for e1e3; a multivector is a dict from
blades to coefficients of any kind of number. It shares nothing with the package but the component order.
"""

from fractions import Fraction
from itertools import product as pairs

import numpy as np

import polhode as ph

# 1, e1, e2, e3, e2e3, e3e1, e1e2, I: the package's basis, generators as written (e3e1 is not rising).
BASIS = ((), (1,), (2,), (3,), (2, 3), (3, 1), (1, 2), (1, 2, 3))
GRADES = (0, 1, 2, 3)
GRADE_SETS = [tuple(k for k in GRADES if mask >> k & 1) for mask in range(1, 16)]


def sort_generators(generators):
    """Return the sign and the blade of a product of generators.

    Different neighbours anticommute, equal ones are 1: swap and delete until the list rises.
    """
    sign, rest = 1, list(generators)
    i = 0
    while i + 1 < len(rest):
        if rest[i] == rest[i + 1]:
            del rest[i : i + 2]
            i = 0
        elif rest[i] > rest[i + 1]:
            rest[i], rest[i + 1] = rest[i + 1], rest[i]
            sign = -sign
            i = 0
        else:
            i += 1
    return sign, tuple(rest)


def add(A, B):
    return {blade: A.get(blade, 0) + B.get(blade, 0) for blade in {*A, *B}}


def scale(s, A):
    return {blade: s * x for blade, x in A.items()}


def subtract(A, B):
    return add(A, scale(-1, B))


def grade(A, k):
    return {blade: x for blade, x in A.items() if len(blade) == k}


def geometric(A, B):
    total = {}
    for (a, x), (b, y) in pairs(A.items(), B.items()):
        sign, blade = sort_generators(a + b)
        total = add(total, {blade: sign * x * y})
    return total


def by_grades(A, B, grade_of_product):
    """Sum over r and s of the part of grade `grade_of_product(r, s)` of A_r B_s."""
    total = {}
    for r, s in pairs(GRADES, GRADES):
        part = geometric(grade(A, r), grade(B, s))
        total = add(total, grade(part, grade_of_product(r, s)))
    return total


def wedge(A, B):
    return by_grades(A, B, lambda r, s: r + s)


def dot(A, B):
    return by_grades(A, B, lambda r, s: abs(r - s))


def left_contraction(A, B):
    return by_grades(A, B, lambda r, s: s - r)


def right_contraction(A, B):
    return by_grades(A, B, lambda r, s: r - s)


def scalar_product(A, B):
    return grade(geometric(A, B), 0)


def commutator(A, B):
    return scale(Fraction(1, 2), subtract(geometric(A, B), geometric(B, A)))


# By the names the package gives them.
PRODUCTS = {
    "wedge": wedge,
    "dot": dot,
    "commutator": commutator,
    "left_contraction": left_contraction,
    "right_contraction": right_contraction,
    "scalar_product": scalar_product,
}


def reverse(A):
    """Every blade written backwards."""
    total = {}
    for blade, x in A.items():
        sign, same = sort_generators(blade[::-1])
        total[same] = sign * x
    return total


def grade_involution(A):
    """Every generator with the other sign."""
    return {blade: (-1) ** len(blade) * x for blade, x in A.items()}


def clifford_conjugate(A):
    return reverse(grade_involution(A))


I = {(1, 2, 3): 1}  # noqa: E741  # the handout's name


def dual(A):
    """A I⁻¹, where I⁻¹ = −I."""
    return geometric(A, scale(-1, I))


def undual(A):
    return geometric(A, I)


# --- to and from the package


def of_components(components):
    """From eight numbers in the package's order."""
    total = {}
    for generators, x in zip(BASIS, components, strict=True):
        sign, blade = sort_generators(generators)
        total[blade] = sign * x
    return total


def components(A):
    """Eight numbers in the package's order."""
    return [sign * A.get(blade, 0) for sign, blade in map(sort_generators, BASIS)]


def of_package(M):
    """A single value of the package, its floats as exact fractions."""
    eight = [x for k in GRADES for x in M.grade(k).components]
    return of_components([Fraction(float(x)) for x in eight])


def to_package(A, grades=GRADES):
    """The package's value with the grades given, of numbers that floats hold exactly."""
    eight = [float(x) for x in components(A)]
    return ph_value(np.array(eight), grades)


def ph_value(eight, grades=GRADES):
    """The package's value from components (..., 8), holding exactly the grades given."""
    parts = {
        0: lambda: ph.scalar(eight[..., 0]),
        1: lambda: ph.vector(eight[..., 1:4]),
        2: lambda: ph.bivector(eight[..., 4:7]),
        3: lambda: ph.trivector(eight[..., 7]),
    }
    first, *others = [parts[k]() for k in grades]
    return sum(others, first)


def eight_of(M):
    """Components (..., 8) of the package's value, zeros for grades it does not hold."""
    return np.concatenate([M.grade(k).components for k in GRADES], axis=-1)


def magnitude(M):
    """√(sum of squares) of the package's values, by NumPy."""
    return np.linalg.norm(M.components, axis=-1)
