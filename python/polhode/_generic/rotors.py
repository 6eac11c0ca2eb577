"""Rotors over arrays of any coefficients: components (..., 4) over ``(1, e2e3, e3e1, e1e2)``.

`R = exp(−Bθ/2)` turns by θ in the plane and sense of B. With ``q = −b`` for the bivector part b, ``(s, q)``
is the quaternion. Derivatives are finite at R = ±1, too; there the plane of the turn is taken as e1∧e2.
Functions ``_exact_…`` take one row of exact components.
"""

from __future__ import annotations

import math
import operator
from typing import Any

import numpy as np

from polhode._generic import functions, g3_exact
from polhode._generic.coefficients import Coefficients
from polhode._generic.compiled import compiled
from polhode._generic.exact import atan2, by_rows, call, divide, is_rounding, is_symbolic, is_zero, sqrt
from polhode._generic.layout import BIVECTOR, EVEN, eight, indices
from polhode._generic.numeric import Array, Numeric, components, squares

Parts = list[Any]

_E12 = [0.0, 0.0, 1.0]

# How far a matrix may be from a rotation: max |M Mᵀ − 1|.
_MATRIX_TOLERANCE = 1e-4

_NO_ROTOR = "all components are zero, which is not a rotor; give the identity as 1, 0, 0, 0"
_NO_DIRECTION = "a vector of zero length has no direction; give a nonzero one"
_NOT_A_ROTATION = "not a rotation matrix: M Mᵀ is not 1{}; orthogonalize it first"
_REFLECTION = "the matrix has determinant −1, a reflection; a rotation has +1; flip an axis"


# --- constructors


@compiled
def from_components(d: Coefficients, c4: Array) -> Array:
    """From components (..., 4), divided by their norm."""
    return d.stack(_unit(d, c4, _NO_ROTOR))


@compiled
def from_plane_angle(d: Coefficients, plane: Array, angle: Array) -> Array:
    """``exp(−Bθ/2)`` for planes (..., 3), whose size is ignored, and angles (...)."""
    unit = _unit(d, plane, "a bivector of zero size spans no plane; give a nonzero one")
    half = d.divide(angle, 2)
    sin = d.sin(half)
    return d.stack([d.cos(half), *(-(sin * x) for x in unit)])


@compiled
def from_rotation_vector(d: Coefficients, v: Array) -> Array:
    """From vectors (..., 3) along the axis whose length is the angle."""
    rotor, _ = functions.exp(d, d.divide(-v, 2), BIVECTOR)
    return rotor


@compiled
def from_quaternion(d: Coefficients, wxyz: Array) -> Array:
    """From quaternions (..., 4) in the order w, x, y, z, divided by their norm."""
    return from_components(d, to_quaternion(d, wxyz))


@compiled
def from_vectors(d: Coefficients, a: Array, b: Array) -> Array:
    """Turn the directions of a (..., 3) to those of b the short way.

    For unit vectors ``c = a + b`` halves the angle, and ``R = ĉ a`` reflects twice. Near a half turn c is a
    small difference: taking out its rounding along ``a − b``, to which it is perpendicular, keeps its
    direction exact. At a half turn the plane goes through the basis vector farthest from a.
    """
    if not isinstance(d, Numeric):
        a, b = np.broadcast_arrays(a, b)
        return by_rows(_exact_from_vectors, d.stack([*components(a), *components(b)]), range(4))
    a, b = _unit(d, a, _NO_DIRECTION), _unit(d, b, _NO_DIRECTION)
    c, difference = ([f(x, y) for x, y in zip(a, b, strict=True)] for f in (operator.add, operator.sub))
    size = squares(d, difference)
    wide = size > 1
    excess = d.where(wide, _dot(c, difference), 0.0) / d.where(wide, size, 1.0)
    c = [x - excess * y for x, y in zip(c, difference, strict=True)]
    axis = _farthest(d, a)
    along = _dot(axis, a)
    opposite = squares(d, c) < d.eps**2
    c = [d.where(opposite, n - x * along, y) for n, x, y in zip(axis, a, c, strict=True)]
    c = d.direction(c, [math.nan] * 3)
    return d.stack(d.direction([_dot(c, a), *_cross(c, a)], [math.nan] * 4))


def _exact_from_vectors(pair: Parts) -> Parts:
    """``R ∝ |a||b| + b a``, which is ``(a + b) a`` for unit vectors; opposite ones as in `from_vectors`."""
    a, b = pair[:3], pair[3:]
    size = sqrt(_dot(a, a) * _dot(b, b))
    if is_zero(size):
        raise ValueError(_NO_DIRECTION)
    rotor = [size + _dot(b, a), *_cross(b, a)]
    if not all(is_zero(x) for x in rotor):
        return g3_exact.unit(rotor)
    farthest = _smallest(a)
    axis = [int(i == farthest) for i in range(3)]
    return g3_exact.unit([0, *_cross(axis, a)])


def _smallest(a: Parts) -> int:
    """Return the place of the smallest component; among symbols, of a zero, else the first."""
    if any(map(is_symbolic, a)):
        return next((i for i, x in enumerate(a) if is_zero(x)), 0)
    return min(range(3), key=lambda i: abs(a[i]))


@compiled
def from_matrix(d: Coefficients, m: Array) -> Array:
    """From rotation matrices (..., 3, 3), or the nearest to what is one within 1e-4; scalar part >= 0."""
    if not isinstance(d, Numeric):
        nine = d.reshape(m, (*m.shape[:-2], 9))
        return by_rows(_exact_from_matrix, nine, range(4))
    with np.errstate(all="ignore"):
        rows = [[m[..., i, j] for j in range(3)] for i in range(3)]
        d.require_finite([x for row in rows for x in row])
        for i, x in enumerate(rows):
            for j, y in enumerate(rows):
                near = d.abs(_dot(x, y) - float(i == j)) <= _MATRIX_TOLERANCE
                d.require(near, _NOT_A_ROTATION.format(" within 1e-4"))
        d.require(_dot(rows[0], _cross(rows[1], rows[2])) > 0, _REFLECTION)
        for _ in range(3):
            rows = _nearer_rotation(rows)
        return d.stack(d.direction(_largest_candidate(d, rows), [math.nan] * 4))


def _nearer_rotation(rows: list[Parts]) -> list[Parts]:
    """Newton's step ``½(X + X⁻ᵀ)`` to the orthogonal polar factor: X⁻ᵀ has cross products as rows."""
    cofactor = [_cross(rows[(i + 1) % 3], rows[(i + 2) % 3]) for i in range(3)]
    determinant = _dot(rows[0], cofactor[0])
    # Divided last, because XLA computes cheaper operations again for each use: in three nested steps each
    # component of the matrix a thousand times.
    twice = 2 * determinant
    return [
        [(x * determinant + y) / twice for x, y in zip(row, other, strict=True)]
        for row, other in zip(rows, cofactor, strict=True)
    ]


def _largest_candidate(d: Numeric, m: list[Parts]) -> Parts:
    """Return the candidate with the largest divisor; scalar part >= 0, not normalized."""
    squared, candidates = _shepperd(m)
    best, largest = candidates[0], squared[0]
    for size, candidate in zip(squared[1:], candidates[1:], strict=True):
        larger = size > largest
        best = [d.where(larger, x, y) for x, y in zip(candidate, best, strict=True)]
        largest = d.where(larger, size, largest)
    sign = d.where(best[0] < 0, -1.0, 1.0)
    return [sign * x for x in best]


def _exact_from_matrix(nine: Parts) -> Parts:
    """From the candidate with the largest divisor; among symbols, from the first that is not 0."""
    m = [nine[:3], nine[3:6], nine[6:]]
    for i, x in enumerate(m):
        for j, y in enumerate(m):
            if not is_rounding(_dot(x, y) - int(i == j), _MATRIX_TOLERANCE):
                raise ValueError(_NOT_A_ROTATION.format(""))
    if not is_rounding(_dot(m[0], _cross(m[1], m[2])) - 1, _MATRIX_TOLERANCE):
        raise ValueError(_REFLECTION)
    squared, candidates = _shepperd(m)
    if any(map(is_symbolic, squared)):
        best = next(c for size, c in zip(squared, candidates, strict=True) if not is_zero(size))
        return g3_exact.unit(best)
    best = max(zip(squared, candidates, strict=True), key=lambda pair: pair[0])[1]
    return g3_exact.unit([-x for x in best] if best[0] < 0 else best)


def _shepperd(m: list[Parts]) -> tuple[Parts, list[Parts]]:
    """Return Shepperd's four candidates for the rotor of a matrix, and their squared divisors.

    The divisors are 4s, 4x, 4y, 4z for the rotor's components; the largest is at least 2.
    """
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


# --- converters


@compiled
def to_quaternion(d: Coefficients, r: Array) -> Array:
    """Return quaternions (..., 4) in the order w, x, y, z, Hamilton's and active."""
    s, x, y, z = components(r)
    return d.stack([s, -x, -y, -z])


@compiled
def to_matrix(d: Coefficients, r: Array) -> Array:
    """Return rotation matrices (..., 3, 3) acting on columns."""
    parts = components(r)
    if isinstance(d, Numeric):
        nine = d.stack(_entries(*parts))
    else:
        # Expressions of cosines and sines simplify better in this form.
        columns = [_turn(parts, [int(i == j) for i in range(3)]) for j in range(3)]
        nine = d.stack([columns[j][i] for i in range(3) for j in range(3)])
    return d.reshape(nine, (*nine.shape[:-1], 3, 3))


def _entries(s: Array, x: Array, y: Array, z: Array) -> list[Array]:
    """Return the matrix row by row; quarter turns have exact zeros."""
    ss, xx, yy, zz = s * s, x * x, y * y, z * z
    return [
        (ss + xx) - (yy + zz),
        2 * (x * y + s * z),
        2 * (x * z - s * y),
        2 * (x * y - s * z),
        (ss + yy) - (xx + zz),
        2 * (y * z + s * x),
        2 * (x * z + s * y),
        2 * (y * z - s * x),
        (ss + zz) - (xx + yy),
    ]


@compiled
def to_rotation_vector(d: Coefficients, r: Array) -> Array:
    """Return vectors (..., 3) along the axis whose length is the angle, at most π."""
    if not isinstance(d, Numeric):
        return by_rows(_exact_rotation_vector, r, range(3))
    return -2.0 * log(d, d.where(r[..., :1] < 0, -r, r))


def _exact_rotation_vector(r: Parts) -> Parts:
    """``−2 B/|B| artan(|B|/s)``: the shorter way round for either sign of s."""
    s, b = r[0], r[1:]
    size = g3_exact.length(b)
    if is_zero(size):
        return [0, 0, 0]
    angle = atan2(size, 0) if is_zero(s) else call("atan", divide(size, s))
    return [divide(-2 * angle * x, size) for x in b]


@compiled
def plane_angle(d: Coefficients, r: Array) -> tuple[Array, Array]:
    """Return unit planes (..., 3) and angles (...) in [0, 2π]; for R = ±1 the plane is e1∧e2."""
    if not isinstance(d, Numeric):
        pairs = by_rows(_exact_plane_angle, r)
        return pairs[..., :3], pairs[..., 3][()]
    s, *b = components(r)
    with np.errstate(all="ignore"):
        plane = d.direction([-x for x in b], _E12)
        return d.stack(plane), 2.0 * d.atan2(d.length(b), s)


def _exact_plane_angle(r: Parts) -> Parts:
    s, b = r[0], r[1:]
    size = abs(g3_exact.length(b))
    plane = [0, 0, 1] if is_zero(size) else [divide(-x, size) for x in b]
    return [*plane, 2 * atan2(size, s)]


@compiled
def angle(d: Coefficients, r: Array) -> Any:
    """Return the angles (...) in [0, π] of rotors (..., 4)."""
    if isinstance(d, Numeric):
        s, *b = components(r)
        return 2.0 * d.atan2(d.length(b), d.abs(s))
    return by_rows(lambda row: [2 * atan2(abs(g3_exact.length(row[1:])), abs(row[0]))], r, range(1))[..., 0][
        ()
    ]


@compiled
def log(d: Coefficients, r: Array) -> Array:
    """Return the bivectors (..., 3) of size at most π whose exp is R."""
    return functions.log(d, r, EVEN)[0][..., 1:]


@compiled
def power(d: Coefficients, r: Array, n: Any) -> Array:
    """``exp(n log R)`` for numbers n (...); whole powers of exact rotors by products."""
    if d.exact and isinstance(n, int):
        return _whole_power(d, r, n)
    turn = log(d, r)
    return functions.exp(d, d.stack([n * x for x in components(turn)]), BIVECTOR)[0]


def _whole_power(d: Coefficients, r: Array, n: int) -> Array:
    base = r if n >= 0 else to_quaternion(d, r)
    one = d.zeros(tuple(r.shape[:-1]))
    result = d.stack([one + 1, one, one, one])
    for bit in bin(abs(n))[2:]:
        result = multiply(d, result, result)
        result = multiply(d, result, base) if bit == "1" else result
    return result


@compiled
def slerp(d: Numeric, r: Array, s: Array, t: Array, half_turn: float) -> Array:
    """``R (~R S)^t`` the shorter way, with the sign of S kept for steps of half a turn to rounding."""
    step = from_components(d, multiply(d, to_quaternion(d, r), s))
    step = from_components(d, d.where(step[..., :1] < -half_turn, -step, step))
    return from_components(d, multiply(d, r, power(d, step, t)))


# --- action


@compiled
def multiply(d: Coefficients, left: Array, right: Array) -> Array:
    """``S R``, not normalized: turns by R first."""
    s, *a = components(left)
    t, *b = components(right)
    plane = [s * y + t * x - z for x, y, z in zip(a, b, _cross(a, b), strict=True)]
    return d.stack([s * t - _dot(a, b), *plane])


@compiled
def apply(d: Coefficients, r: Array, data: Array, mask: int) -> Array:
    """``R X ~R`` for the components (..., K) of the grades in the mask; scalars and trivectors stay."""
    rotor, m = components(r), eight(d, data, mask)
    turned = [m[0], *_turn(rotor, m[1:4]), *_turn(rotor, m[4:7]), m[7]]
    batch = np.broadcast_shapes(tuple(r.shape[:-1]), tuple(data.shape[:-1]))
    return d.stack([turned[i] + d.zeros(batch) for i in indices(mask)])


def _turn(rotor: Parts, a: Parts) -> Parts:
    """``R a ~R = a + s t + q x t`` with ``t = 2 q x a``; bivectors turn as their duals do."""
    s, q = rotor[0], [-x for x in rotor[1:]]
    t = [2 * x for x in _cross(q, a)]
    return [x + s * y + z for x, y, z in zip(a, t, _cross(q, t), strict=True)]


# --- vectors as lists of components


def _unit(d: Coefficients, data: Array, message: str) -> Parts:
    """Return the components divided by their norm; a ValueError where it is 0."""
    if not isinstance(d, Numeric):
        return components(by_rows(lambda row: g3_exact.unit(row, message), data))
    with np.errstate(all="ignore"):
        parts = components(data)
        d.require_finite(parts)
        d.require(d.length(parts) > 0, message)
        return d.direction(parts, [math.nan] * len(parts))


def _farthest(d: Numeric, a: Parts) -> Parts:
    """Return the basis vector along which a has its smallest component."""
    x, y, z = map(d.abs, a)
    first = (x <= y) & (x <= z)
    second = ~first & (y <= z)
    chosen = first, second, ~(first | second)
    return [d.where(here, d.zeros_like(x) + 1.0, 0.0) for here in chosen]


def _dot(a: Parts, b: Parts) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Parts, b: Parts) -> Parts:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
