"""Samples of values and rotors in all batch shapes, near-singular ones among them.

Whole components make the polynomial laws exact. Where rounding enters, the allowance is a count of
roundings times EPS times the size of what is summed; the count is stated where it is used.
"""

import numpy as np
from hypothesis import strategies as st

import polhode as ph
from naive import GRADE_SETS, magnitude, ph_value
from polhode import e1, e2

EPS = 2.0**-52
SHAPES = [(), (1,), (3, 1, 2)]
e12 = e1.wedge(e2)

whole = st.integers(-9, 9).map(float)
wholes8 = st.lists(whole, min_size=8, max_size=8).map(np.array)
wholes3 = st.lists(whole, min_size=3, max_size=3).map(np.array)
grade_sets = st.sampled_from(GRADE_SETS)
values = st.builds(ph_value, wholes8, grade_sets)
vectors = st.builds(ph.vector, wholes3)
bivectors = st.builds(ph.bivector, wholes3)

real = st.floats(-10, 10, allow_subnormal=False)
angles = st.one_of(
    st.floats(-7, 7),
    # Near 0, π and 2π, from both sides, at every distance.
    st.builds(
        lambda around, sign, exponent: around + sign * 10.0**exponent,
        st.sampled_from([0.0, np.pi, 2 * np.pi, -np.pi]),
        st.sampled_from([-1, 0, 1]),
        st.integers(-18, -1),
    ),
)


def unit(numbers):
    return numbers / np.linalg.norm(numbers)


directions = (
    st.lists(st.one_of(whole, st.floats(-1, 1), st.just(1e-17)), min_size=3, max_size=3)
    .map(np.array)
    .filter(lambda v: np.linalg.norm(v) > 1e-3)
    .map(unit)
)
rotors = st.builds(lambda n, angle: ph.Rotor.from_plane_angle(ph.bivector(n), angle), directions, angles)


def same(left, right):
    return bool(np.all(left == right))


def close(left, right, count, size=1.0):
    return bool(np.all(magnitude(left - right) <= count * EPS * size))


def random_rotors(shape, seed=1):
    """Attitudes over the whole double cover."""
    return ph.Rotor.random(shape, seed)


PAIRS_OF_SHAPES = [
    ((), ()),
    ((1,), ()),
    ((), (1,)),
    ((3, 1, 2), ()),
    ((3, 1, 2), (4, 1)),
    ((3, 1, 2), (3, 1, 2)),
]
