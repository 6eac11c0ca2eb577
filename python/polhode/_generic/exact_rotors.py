"""Rotors of exact, symbolic or multiprecision components, one row at a time; formulas as in `rotors`."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from polhode._generic.closed_forms import length, log_even, unit_row
from polhode._generic.exact import atan2, call, divide, is_symbolic, is_zero, sqrt

Row = list[Any]


def unit(c: Row) -> Row:
    """Components of norm 1."""
    if all(is_zero(x) for x in c):
        raise ValueError("all components are zero, which is no rotor; give the identity as 1, 0, 0, 0")
    return unit_row(c)


def unit_plane(b: Row) -> Row:
    """A bivector of size 1."""
    if all(is_zero(x) for x in b):
        raise ValueError("a bivector of zero size spans no plane; give a nonzero one")
    return unit_row(b)


def from_vectors(pair: Row) -> Row:
    """``R ∝ |a||b| + b a``, which is ``(a + b) a`` for unit vectors; opposite ones as in `rotors`."""
    a, b = pair[:3], pair[3:]
    size = sqrt(_dot(a, a) * _dot(b, b))
    if is_zero(size):
        raise ValueError("a vector of zero length has no direction; give a nonzero one")
    rotor = [size + _dot(b, a), *_cross(b, a)]
    if not all(is_zero(x) for x in rotor):
        return unit_row(rotor)
    farthest = _smallest(a)
    axis = [int(i == farthest) for i in range(3)]
    return unit_row([0, *_cross(axis, a)])


def _smallest(a: Row) -> int:
    """Where the smallest component is; among symbols, where a zero is, else the first."""
    if any(map(is_symbolic, a)):
        return next((i for i, x in enumerate(a) if is_zero(x)), 0)
    return min(range(3), key=lambda i: abs(a[i]))


def from_matrix(nine: Row) -> Row:
    """By Shepperd's method, from the largest of four squares; with symbols from the first that is not 0."""
    m = [nine[:3], nine[3:6], nine[6:]]
    for i, x in enumerate(m):
        for j, y in enumerate(m):
            if not _is_one_or_zero(_dot(x, y), int(i == j)):
                raise ValueError("not a rotation matrix: M Mᵀ is not 1; orthogonalize it first")
    if not _is_one_or_zero(_dot(m[0], _cross(m[1], m[2])), 1):
        raise ValueError("the matrix has determinant −1, a reflection; a rotation has +1; flip an axis")
    squared, candidates = shepperd(m)
    if any(map(is_symbolic, squared)):
        best = next(c for size, c in zip(squared, candidates, strict=True) if not is_zero(size))
        return unit_row(best)
    best = max(zip(squared, candidates, strict=True), key=lambda pair: pair[0])[1]
    return unit_row([-x for x in best] if best[0] < 0 else best)


def _is_one_or_zero(x: Any, target: int) -> bool:
    """Exactly; to 1e-4 for what was rounded."""
    if is_symbolic(x) or isinstance(x, int | Fraction):
        return is_zero(x - target)
    return bool(abs(x - target) <= 1e-4)


def shepperd(m: list[Row]) -> tuple[Row, list[Row]]:
    """Of a rotation matrix ``4s², 4x², 4y², 4z²``, and for each the rotor times 4 × that component."""
    (a, b, c) = m
    trace = a[0] + b[1] + c[2]
    squared = [1 + trace, 1 + 2 * a[0] - trace, 1 + 2 * b[1] - trace, 1 + 2 * c[2] - trace]
    p, q, r = b[2] - c[1], c[0] - a[2], a[1] - b[0]  # of the bivector, which is minus the quaternion's axis
    u, v, w = c[1] + b[2], a[2] + c[0], b[0] + a[1]
    rotors = [
        [squared[0], p, q, r],
        [p, squared[1], w, v],
        [q, w, squared[2], u],
        [r, v, u, squared[3]],
    ]
    return squared, rotors


def to_rotation_vector(r: Row) -> Row:
    """``−2 B/|B| artan(|B|/s)``, which is the shorter way round for s of either sign."""
    s, b = r[0], r[1:]
    size = length(b)
    if is_zero(size):
        return [0, 0, 0]
    angle = atan2(size, 0) if is_zero(s) else call("atan", divide(size, s))
    return [divide(-2 * angle * x, size) for x in b]


def plane_angle(r: Row) -> Row:
    """The unit plane and the angle; for R = ±1 the plane is e1∧e2."""
    s, b = r[0], r[1:]
    size = abs(length(b))
    plane = [0, 0, 1] if is_zero(size) else [divide(-x, size) for x in b]
    return [*plane, 2 * atan2(size, s)]


def log(r: Row) -> Row:
    """The bivector whose exp is R."""
    return log_even([r[0], 0, 0, 0, *r[1:], 0])[4:7]


def _dot(a: Row, b: Row) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Row, b: Row) -> Row:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
