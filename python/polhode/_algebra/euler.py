"""Euler angles, by the names SciPy gives them: lower-case axes stay in space, upper-case ones turn along."""

from __future__ import annotations

import itertools
import re
from typing import Any

import numpy as np

from polhode import _generic
from polhode._algebra.coefficients import as_coefficients, kind_of
from polhode._algebra.constructors import bivector
from polhode._algebra.rotor import Rotor
from polhode._support.arrays import is_float

# e2e3, e3e1 and e1e2, the planes of turns about e1, e2 and e3.
_PLANES = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0])


def from_euler(seq: str, angles: Any, degrees: bool) -> Rotor:
    """Return the product of the turns about each axis.

    Turns about axes that turn along are the same turns about fixed axes in the opposite order.
    """
    axes = _axes(seq, (1, 2, 3))
    theta = as_coefficients(angles, "angles")
    if not theta.shape:
        theta = theta[None]
    if theta.shape[-1] != len(seq):
        raise ValueError(
            f"the sequence {seq!r} needs {len(seq)} angles in the last axis, got shape {tuple(theta.shape)}"
        )
    if degrees:
        theta = _generic.euler.to_radians(kind_of(theta), theta)
    turns: list[Any] = [
        Rotor.from_plane_angle(bivector(_PLANES[axis]), theta[..., k]) for k, axis in enumerate(axes)
    ]
    total, *others = turns[::-1] if seq.isupper() else turns
    for turn in others:
        total = turn * total
    result: Rotor = total.astype(theta.dtype) if is_float(theta) else total
    return result


def to_euler(R: Rotor, seq: str, degrees: bool) -> Any:
    """Return the three angles (..., 3) of R."""
    i, j, k = _axes(seq, (3,))
    q = R.to_quaternion(order="wxyz")
    kind = _generic.numeric.Numeric(np, q.dtype) if is_float(q) else kind_of(q)
    angles = _generic.euler.to_euler(kind, q, (i, j, k), seq.isupper())
    return _generic.euler.to_degrees(kind, angles) if degrees else angles


def _axes(seq: str, lengths: tuple[int, ...]) -> list[int]:
    """Return the numbers of the axes, after a check of their names."""
    valid = isinstance(seq, str) and re.fullmatch("[xyz]+|[XYZ]+", seq)
    if not valid or len(seq) not in lengths or any(a == b for a, b in itertools.pairwise(seq)):
        count = "three" if lengths == (3,) else "one to three"
        raise ValueError(
            f"a sequence of Euler angles is {count} of x, y, z (fixed axes) or of X, Y, Z (axes that turn "
            f"along), no two neighbours alike; got {seq!r}"
        )
    return ["xyz".index(letter) for letter in seq.lower()]
