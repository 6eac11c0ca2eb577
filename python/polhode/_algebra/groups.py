"""Finite groups of rotations, and reduction by symmetries, as in SciPy."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._algebra.foreign_values import remedy_for
from polhode._algebra.grades import concatenate
from polhode._algebra.signs import canonical
from polhode._support.arrays import Array, is_float

if TYPE_CHECKING:
    from polhode._algebra.rotor import Rotor
else:  # the same type; `polhode._algebra.rotor` adds its methods
    from polhode._native import Rotor

_BLOCK = 1 << 20  # scores at a time


def group(name: str, axis: str = "z") -> Rotor:
    """Return a group of rotations as a batch of rotors (n,), named as by SciPy's ``create_group``.

    ``"T"``, ``"O"`` and ``"I"``: rotations of a tetrahedron (12), an octahedron or cube (24), an icosahedron
    (60), with the axes of space as two- or fourfold axes; ``"C4"``: cyclic (n = 4), about `axis`, "x", "y" or
    "z"; ``"D4"``: dihedral (2n), with half turns about axes perpendicular to it, among them the next one in
    the order x, y, z, x. The identity comes first. Scalar parts are >= 0.

    The order of the others is not SciPy's.

    Examples
    --------
    >>> ph.Rotor.group("O").shape
    (24,)
    >>> np.degrees(ph.Rotor.group("C4").angle).round(6)
    array([  0.,  90., 180.,  90.])
    """
    match = re.fullmatch(r"([CD])([1-9]\d*)|[TOI]", name) if isinstance(name, str) else None
    if match is None:
        raise ValueError(f'a group is "I", "O", "T", "C<n>" or "D<n>" with n >= 1, got {name!r}')
    place = "xyz".find(axis.lower()) if isinstance(axis, str) and len(axis) == 1 else -1
    if place < 0:
        raise ValueError(f'axis must be "x", "y" or "z", got {axis!r}')
    if match[1] is None:
        return canonical(_of_a_solid(name))
    axes, count = np.eye(3), int(match[2])
    turns = Rotor.from_axis_angle(axes[place], 2 * math.pi * np.arange(count) / count)
    if match[1] == "D":
        turns = concatenate([turns, turns * Rotor.from_axis_angle(axes[(place + 1) % 3], math.pi)])
    return canonical(turns)


def _of_a_solid(name: str) -> Rotor:
    """Return T, or the products of its elements with the powers of one rotation of the larger group."""
    thirds = [[1.0, x, y, z] for x in (1, -1) for y in (1, -1) for z in (1, -1)]
    tetrahedral = Rotor.from_components([*np.eye(4).tolist(), *thirds])
    if name == "T":
        return tetrahedral
    if name == "O":
        powers = Rotor.from_axis_angle([0, 0, 1], math.pi / 2 * np.arange(2))
    else:
        golden = (1 + math.sqrt(5)) / 2
        powers = Rotor.from_axis_angle([golden, 0, 1], 2 * math.pi / 5 * np.arange(5))
    return (powers[:, None] * tetrahedral).reshape(-1)


def reduce(
    R: Rotor, left: Rotor | None = None, right: Rotor | None = None, return_indices: bool = False
) -> Any:
    """Return the rotors ``l R r`` of the smallest angle, for l and r of two groups: SciPy's ``reduce``.

    For symmetries `right` of a body and `left` of its surroundings, equivalent attitudes have the same
    reduced angle: the misorientation of crystals. The scalar part of the result is >= 0. Of several equal
    angles, to rounding, any may be taken.

    Parameters
    ----------
    left, right
        Batches of rotors (m,) and (k,), such as ``Rotor.group("O")``; the identity by default.
    return_indices
        Whether to return ``(reduced, left_index, right_index)``, with arrays of R's batch shape of
        the places of the elements used (None for a group not given).

    Examples
    --------
    A cube looks the same after a quarter turn, so a turn of 100° looks like one of 10°:

    >>> R = ph.Rotor.from_axis_angle(ph.e3, 100, degrees=True)
    >>> reduced = R.reduce(right=ph.Rotor.group("O"))
    >>> print(np.degrees(reduced.angle).round(6))
    10.0
    """
    groups = [_checked(value, what) for value, what in ((left, "left"), (right, "right"))]
    if not all(is_float(value._data) for value in (R, *groups)):
        raise TypeError("reduce needs NumPy floats; convert other rotors with .astype(float) or np.asarray")
    first, last = groups
    # The scalar part of l R r is that of R (r l), the scalar product with the reverse of r l.
    both = (~(last * first[:, None])).reshape(-1)._data.T
    rows = R._data.reshape(-1, 4)
    step = max(1, _BLOCK // both.shape[1])
    best: Array = np.concatenate(
        [np.zeros(0, int)]
        + [np.argmax(np.abs(rows[k : k + step] @ both), axis=-1) for k in range(0, len(rows), step)]
    )
    i, j = (index.reshape(R.shape) for index in np.divmod(best, len(last)))
    reduced = canonical(first[i] * R * last[j]).astype(R.dtype)
    if not return_indices:
        return reduced
    return reduced, None if left is None else i[()], None if right is None else j[()]


def _checked(value: Rotor | None, what: str) -> Rotor:
    if value is None:
        return Rotor.identity(1)
    if not isinstance(value, Rotor) or len(value.shape) > 1 or not value.reshape(-1).shape[0]:
        found = f"rotors of batch shape {value.shape}" if isinstance(value, Rotor) else type(value).__name__
        message = f'{what} must be rotors (n,), n > 0, such as Rotor.group("O"); got {found}'
        raise ValueError(message + remedy_for(value))
    return value.reshape(-1)
