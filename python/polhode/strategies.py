"""Hypothesis strategies: values of the algebra and rotors, for property tests of your own code.

>>> from hypothesis import given
>>> from polhode import strategies as ga
>>> @given(ga.rotors(), ga.vectors())
... def test_turning_keeps_lengths(R, a):
...     assert abs(R(a).norm() - a.norm()) <= 8e-16 * a.norm()

Examples shrink to few nonzero components and small whole numbers, rotors to simple angles in coordinate
planes. Components come from `floats`, a strategy of finite floats; by default of moderate size, so that
products neither overflow nor underflow. The batch `shape` is fixed, or drawn from a strategy such as
`batch_shapes`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from polhode._algebra.algebra import Algebra, algebra
from polhode._algebra.constructors import bivector
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._support.arrays import Array, Shape, batch_shape
from polhode._support.extras import optional

st = optional("hypothesis.strategies", "hypothesis", "polhode.strategies")

__all__ = [
    "angles",
    "batch_shapes",
    "bivectors",
    "components",
    "multivectors",
    "rotors",
    "scalars",
    "trivectors",
    "vectors",
]

# A strategy of Hypothesis; docstrings give the type of its values in brackets.
Strategy = Any

_SIZE = 1e6


def __dir__() -> list[str]:
    return __all__


def components(bound: float = _SIZE) -> Strategy:
    """Floats [float] of size at most `bound`; 0, or of size at least 1/bound; whole numbers often."""
    if not 1 <= bound < math.inf:
        raise ValueError(f"bound must be finite and >= 1, got {bound}")
    whole = st.integers(-min(9, int(bound)), min(9, int(bound))).map(float)
    return st.one_of(whole, st.floats(1 / bound, bound), st.floats(-bound, -1 / bound))


def angles() -> Strategy:
    """Angles [float] in [−2π, 2π]: 0 first, then multiples of π/2, near multiples of π, and any."""
    simple = st.sampled_from([0.0, *(sign * k * math.pi / 2 for k in range(1, 5) for sign in (1, -1))])
    return st.one_of(simple, _near_singular(), st.floats(-2 * math.pi, 2 * math.pi))


def _near_singular() -> Strategy:
    """Angles [float] at distances of 1e-18 to 0.1 from 0, ±π and 2π, where logarithms are singular."""
    around = st.sampled_from([0.0, math.pi, 2 * math.pi, -math.pi])
    distance = st.builds(lambda sign, k: sign * 10.0**-k, st.sampled_from([1, -1]), st.integers(1, 18))
    return st.builds(
        lambda angle, step: float(np.clip(angle + step, -2 * math.pi, 2 * math.pi)), around, distance
    )


def batch_shapes(max_dims: int = 2, max_side: int = 3, min_side: int = 0) -> Strategy:
    """Batch shapes [tuple of int]: ``()`` first, empty batches among them."""
    return st.lists(st.integers(min_side, max_side), max_size=max_dims).map(tuple)


def multivectors(
    grades: Iterable[int] | None = None,
    algebra: Algebra | None = None,
    shape: Any = (),
    floats: Strategy | None = None,
) -> Strategy:
    """Values [Multivector] of the given grades; by default the grades are drawn, too."""
    space = _space(algebra)
    everything = range(space.dimension + 1)
    if grades is None:
        held = st.sets(st.sampled_from(everything), min_size=1).map(sorted)
    else:
        wanted = sorted(set(grades))
        if not wanted or not set(wanted) <= set(everything):
            raise ValueError(f"{space} has grades 0 to {space.dimension}, got {wanted}")
        held = st.just(wanted)
    numbers = components() if floats is None else floats

    def of(drawn: tuple[list[int], Shape]) -> Strategy:
        mask = sum(1 << k for k in drawn[0])
        rows = _arrays((*drawn[1], len(space._indices(mask))), numbers)
        return rows.map(lambda data: Multivector._of(data, mask, space))

    return st.tuples(held, _shapes(shape)).flatmap(of)


def scalars(algebra: Algebra | None = None, shape: Any = (), floats: Strategy | None = None) -> Strategy:
    """Scalars [Multivector], of grade 0."""
    return multivectors((0,), algebra, shape, floats)


def vectors(algebra: Algebra | None = None, shape: Any = (), floats: Strategy | None = None) -> Strategy:
    """Vectors [Multivector], of grade 1."""
    return multivectors((1,), algebra, shape, floats)


def bivectors(algebra: Algebra | None = None, shape: Any = (), floats: Strategy | None = None) -> Strategy:
    """Bivectors [Multivector], of grade 2."""
    return multivectors((2,), algebra, shape, floats)


def trivectors(algebra: Algebra | None = None, shape: Any = (), floats: Strategy | None = None) -> Strategy:
    """Trivectors [Multivector], of grade 3."""
    return multivectors((3,), algebra, shape, floats)


def rotors(shape: Any = (), near_singular: bool = False) -> Strategy:
    """Rotors [Rotor], the identity first; with `near_singular` only angles at or near 0, π or 2π."""
    turns = _near_singular() if near_singular else angles()

    def of(lengths: Shape) -> Strategy:
        planes = _arrays((*lengths, 3), components(10.0)).map(_directions)
        return st.builds(_turned, planes, _arrays(lengths, turns))

    return _shapes(shape).flatmap(of)


def _turned(plane: Array, angle: Array) -> Rotor:
    return Rotor.from_plane_angle(bivector(plane), angle)


def _directions(planes: Array) -> Array:
    """Return the planes, e1e2 instead of zero."""
    return np.where(np.any(planes != 0, axis=-1, keepdims=True), planes, [0.0, 0.0, 1.0])


def _arrays(shape: Shape, numbers: Strategy) -> Strategy:
    count = math.prod(shape)
    return st.lists(numbers, min_size=count, max_size=count).map(
        lambda x: np.array(x, dtype=float).reshape(shape)
    )


def _shapes(shape: Any) -> Strategy:
    """Return a strategy of shapes from a shape or such a strategy."""
    return shape if isinstance(shape, st.SearchStrategy) else st.just(batch_shape(shape))


def _space(given: Algebra | None) -> Algebra:
    return algebra(3) if given is None else given
