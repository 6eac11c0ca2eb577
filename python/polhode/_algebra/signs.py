"""Signs of rotors: choice between R and −R, which are the same rotation."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _native
from polhode._algebra.coefficients import kind_of
from polhode._support.arrays import is_float

if TYPE_CHECKING:
    from polhode._algebra.rotor import Rotor

# Rounding errors in a sum of four products of rounded numbers.
_HALF_TURN = 4


def canonical(R: Rotor) -> Rotor:
    """Return R or −R: the one of a turn of at most π, with a scalar part >= 0.

    Of half turns, the one whose first nonzero component of ``(e2e3, e3e1, e1e2)`` is negative: the quaternion
    of the same rotation then has a positive one, as in SciPy. Expressions whose sign is not known count as
    positive.

    Examples
    --------
    >>> R = ph.Rotor.from_axis_angle(ph.e3, 240, degrees=True)
    >>> R
    -0.5 - 0.8660254 e1∧e2
    >>> R.canonical()
    0.5 + 0.8660254 e1∧e2
    """
    if (found := _native.rotor_canonical(R)) is not None:
        return found
    data, kind = R._data, kind_of(R._data)
    if kind.exact:
        rows = data.reshape(-1, 4)
        flip = np.array([_flips_exact(row) for row in rows], bool).reshape(data.shape[:-1])
        return _native.Rotor._from_rows(np.where(flip[..., np.newaxis], -data, data))
    s, x, y, z = (data[..., k] for k in range(4))
    flip = (s < 0) | ((s == 0) & ((x > 0) | ((x == 0) & ((y > 0) | ((y == 0) & (z > 0))))))
    return _flipped(R, flip)


def continuous(R: Rotor, axis: int = 0) -> Rotor:
    """Return a row of rotors with signs such that neighbours along a batch axis are close, as in a motion.

    Each has the sign nearer to the one before it; the first is unchanged. Neighbours half a turn apart, to
    rounding, keep their signs relative to each other. A ValueError for a single rotor and an axis out of
    range.

    Examples
    --------
    >>> R = ph.Rotor.from_axis_angle(ph.e3, [0, 100, 200, 300], degrees=True).canonical()
    >>> R["1"].round(3)
    array([1.   , 0.643, 0.174, 0.866])
    >>> R.continuous()["1"].round(3)
    array([ 1.   ,  0.643, -0.174, -0.866])
    """
    count = len(R.shape)
    place = operator.index(axis)
    if not -count <= place < count:
        what = "a single rotor" if not count else f"rotors of batch shape {R.shape}"
        raise ValueError(f"axis {axis} is out of range for {what}")
    data, place = R._data, place % count
    before, after = ((slice(None),) * place + (part, ...) for part in (slice(None, -1), slice(1, None)))
    if data.dtype == object:
        data = R.astype(float)._data  # to find the signs
    xp = kind_of(data).xp
    apart = xp.sum(data[before] * data[after], axis=-1) < -half_turn(data)
    # Whole numbers of changes of sign, from the first rotor on.
    first = data[(slice(None),) * place + (slice(0, 1), ..., 0)] * 0
    changes = xp.concat([first, xp.where(apart, first + 1, first)], axis=place)
    total = np.cumsum(changes, axis=place) if xp is np else xp.cumulative_sum(changes, axis=place)
    return _flipped(R, total % 2 == 1)


def half_turn(components: Any) -> float:
    """Return the rounding error of the scalar part of ``~R S`` for attitudes half a turn apart.

    It is a sum of four products of rounded components, whose magnitudes add up to at most 1.
    """
    eps = float(np.finfo(components.dtype).eps) if is_float(components) else kind_of(components).eps
    return _HALF_TURN * float(eps)


def _flipped(R: Rotor, flip: Any) -> Rotor:
    data = R._data
    chosen = np if isinstance(data, np.ndarray) else kind_of(data).xp
    return _native.Rotor._from_rows(chosen.where(flip[..., None], -data, data))


def _flips_exact(row: Any) -> bool:
    from polhode._generic.exact import is_symbolic

    for k, x in enumerate(row):
        wanted = -1 if k else 1
        if is_symbolic(x):
            if x.is_zero:
                continue
            return bool(x.is_negative) if wanted == 1 else bool(x.is_positive)
        if x != 0:
            return bool(x * wanted < 0)
    return False
