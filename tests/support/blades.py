"""Oracle: products of blades in any signature, written as plainly as possible.

A blade is a set of generators, the bits of a number, in rising order. It shares nothing with the package but
the order of the components: by grade, then by rising generators; e2e3, e3e1, e1e2 where there are three.
"""

from itertools import combinations
from math import comb

import numpy as np

SIGNATURES = [
    (0, 0, 0),
    (1, 0, 0),
    (2, 0, 0),
    (3, 0, 0),
    (3, 0, 1),
    (4, 1, 0),
    (1, 3, 0),
    (0, 2, 0),
    (0, 3, 0),
    (0, 0, 2),
    (1, 1, 1),
    (2, 0, 1),
    (0, 1, 3),
    (6, 0, 0),
]
LARGE = [(8, 0, 0), (4, 4, 0), (5, 1, 2)]


def squares(signature):
    p, q, r = signature
    return [1] * p + [-1] * q + [0] * r


def basis(n):
    """The generators of each component, as written."""
    if n == 3:
        return [(), (1,), (2,), (3,), (2, 3), (3, 1), (1, 2), (1, 2, 3)]
    return [rising for k in range(n + 1) for rising in combinations(range(1, n + 1), k)]


def sorted_sign(generators, metric):
    """Sign (or 0) and set of a product of generators: swap neighbours until they rise, square equal ones."""
    sign, rest, i = 1, list(generators), 0
    while i + 1 < len(rest):
        if rest[i] == rest[i + 1]:
            sign *= metric[rest[i] - 1]
            del rest[i : i + 2]
            i = max(i - 1, 0)
        elif rest[i] > rest[i + 1]:
            rest[i], rest[i + 1], sign, i = rest[i + 1], rest[i], -sign, max(i - 1, 0)
        else:
            i += 1
    return sign, tuple(rest)


KEEP = {
    "geometric_product": lambda r, s, k: True,
    "wedge": lambda r, s, k: k == r + s,
    "dot": lambda r, s, k: k == abs(r - s),
    "left_contraction": lambda r, s, k: k == s - r,
    "right_contraction": lambda r, s, k: k == r - s,
    "scalar_product": lambda r, s, k: k == 0,
}


def terms(signature):
    """All (i, j, k, sign, grades) with ``E_i E_j = sign E_k``, sign not 0."""
    metric, blades = squares(signature), basis(sum(signature))
    place = {}
    for k, blade in enumerate(blades):
        orientation, rising = sorted_sign(blade, metric)
        place[rising] = k, orientation
    table = []
    for i, a in enumerate(blades):
        for j, b in enumerate(blades):
            sign, rising = sorted_sign(a + b, metric)
            if sign:
                k, orientation = place[rising]
                table.append((i, j, k, sign * orientation, (len(a), len(b), len(rising))))
    return table


def product(name, table, a, b):
    """A product of components (..., 2ⁿ)."""
    result = np.zeros(np.broadcast_shapes(a.shape, b.shape))
    for i, j, k, sign, grades in table:
        if KEEP[name](*grades):
            result[..., k] += sign * a[..., i] * b[..., j]
    return result


def places(n, grades):
    """The places of the components of these grades."""
    return [k for k, blade in enumerate(basis(n)) if len(blade) in grades]


def numbers(shape, seed):
    """Whole components, so that sums of products are exact."""
    return np.random.default_rng(seed).integers(-9, 10, shape).astype(float)


def full(M):
    """All components, zeros for grades that are not held."""
    n = M.algebra.dimension
    data = np.zeros((*M.shape, 2**n))
    data[..., places(n, M.grades)] = M.components
    return data


def sizes(n):
    return [comb(n, k) for k in range(n + 1)]
