"""Euler angles, by the names SciPy gives them: lower-case axes stay in space, upper-case ones turn along."""

from __future__ import annotations

import itertools
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._arrays import Array, as_floats

if TYPE_CHECKING:
    from polhode._rotor import Rotor

# cos(θ2/2) or sin(θ2/2) below this is rounding of the quaternion.
_LOCK = 4 * np.finfo(float).eps


def rotation_vectors(seq: str, angles: Any, degrees: bool) -> list[Array]:
    """Return the rotation vectors (..., 3) of the turns in space, the first to be made first.

    Turns about axes that turn along are the same turns about fixed axes in the opposite order.
    """
    axes = _axes(seq, (1, 2, 3))
    theta = np.atleast_1d(as_floats(angles, "angles"))
    if theta.shape[-1] != len(seq):
        raise ValueError(
            f"the sequence {seq!r} needs {len(seq)} angles in the last axis, got shape {theta.shape}"
        )
    if degrees:
        theta = np.deg2rad(theta)
    turns = [theta[..., k, np.newaxis] * np.eye(3)[axis] for k, axis in enumerate(axes)]
    return turns[::-1] if seq.isupper() else turns


def to_euler(R: Rotor, seq: str, degrees: bool) -> Array:
    """Return the three angles (..., 3) of R.

    In quaternions, whose units e_i, e_j, e_k are those of the axes, a turn about i, then j, then i again is
    ``q = q_i(θ3) q_j(θ2) q_i(θ1)``. Because ``q_i(θ) e_j = e_j q_i(−θ)``, its parts are
    ``(q_0, q_i) = cos(θ2/2) (cos, sin)((θ3 + θ1)/2)`` and
    ``(q_j, ε q_k) = sin(θ2/2) (cos, sin)((θ3 − θ1)/2)``, with ε = ±1 as i, j, k are right- or left-handed
    (Bernardes & Viollet, PLoS ONE 17 (2022)).

    Where the three axes i, j, k differ, a quarter turn back about j carries i to ±k: ``q_j(π/2) q`` is such
    a product, of the angles θ1, θ2 + π/2 and ε θ3.
    """
    axes = _axes(seq, (3,))
    turning = seq.isupper()
    i, j, third = axes[::-1] if turning else axes
    k = 3 - i - j
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    proper: Any = R if third == i else type(R).from_rotation_vector(np.pi / 2 * np.eye(3)[j]) * R
    q = proper.astype(float).to_quaternion(order="wxyz")
    a, b, c, d = q[..., 0], q[..., 1 + i], q[..., 1 + j], sign * q[..., 1 + k]
    cosine, sine = np.hypot(a, b), np.hypot(c, d)
    half_sum, half_difference = np.arctan2(b, a), np.arctan2(d, c)
    # In gimbal lock one of them is free: it is taken so that the angle named last vanishes.
    free = 1.0 if turning else -1.0
    half_sum = np.where(cosine <= _LOCK, free * half_difference, half_sum)
    half_difference = np.where(sine <= _LOCK, free * half_sum, half_difference)
    first, last = _wrapped(half_sum - half_difference), _wrapped(half_sum + half_difference)
    middle = 2 * np.arctan2(sine, cosine)
    if third != i:
        middle, last = middle - np.pi / 2, sign * last
    angles = np.stack([last, middle, first] if turning else [first, middle, last], axis=-1)
    return np.rad2deg(angles) if degrees else angles


def _wrapped(angle: Array) -> Array:
    """Return angles within two turns of 0 in [−π, π]."""
    return np.where(np.abs(angle) > np.pi, angle - np.copysign(2 * np.pi, angle), angle)


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
