"""exp, log, sqrt and screws of motors, over arrays of any coefficients.

With the null vector n and ``J = e1e2e3 n``, an even element is ``s + I3 b + m n + p J`` for ``I3 = e1e2e3``.
Data are arrays (..., 8) of ``s, b, m, p``: components over ``1``, ``(e2e3, e3e1, e1e2)``,
``(e1n, e2n, e3n)`` and ``J``. The number ``ε = −J`` has ε² = 0 and commutes with even elements, and
``m n = ε I3 m``. So a motor is a rotor whose components are dual numbers, ``(s − εp) + I3 (b + εm)``, and
every function f(x) of numbers continues to ``f(x + εy) = f(x) + ε y f'(x)`` (Study; Clifford, 1873).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from polhode._generic.coefficients import Coefficients
from polhode._generic.compiled import compiled
from polhode._generic.exact import atan2, by_rows, call, divide, is_rounding, is_symbolic, is_zero
from polhode._generic.exact import sqrt as root_of
from polhode._generic.g3_exact import free_root, length, log_length
from polhode._generic.g3_smooth import cos_sinc, horner
from polhode._generic.numeric import Array, Numeric, components, require_in_range, squares
from polhode._generic.rotors import to_matrix

Parts = list[Any]

# (cos θ − sin θ / θ)/θ² in −θ² for θ < 1: the first term left out is 22/23! < 1e-21.
_SLOPE = [-2 * (k + 1) / math.factorial(2 * k + 3) for k in range(10)]
# artan(t)/t in −t², and (1 − artan(t)/t)/t², for t² < 1/16: the first terms left out are below 16⁻¹³/27.
_NEAR = 1 / 16
_ARTANC = [1 / (2 * k + 1) for k in range(13)]
_REST = [1 / (2 * k + 3) for k in range(13)]

_E12 = [0.0, 0.0, 1.0]  # the plane taken where the value determines none

_SINGULAR = "not a motor: the components without null vector are zero"
_NO_MOTOR = "not a motor: M ~M is not a number; divide it by its norm with normalized()"


# --- layout

# Where the eight components stand among the even elements of an algebra, each with its sign.
Order = tuple[tuple[int, int], ...]
_IN_ORDER: Order = tuple((k, 1) for k in range(8))


@compiled
def function(
    d: Coefficients, name: str, data: Array, grades: tuple[int, ...], order: Order, kept: tuple[int, ...]
) -> Array:
    """Return `exp`, `log` or `sqrt` of the components of an algebra, of grades among 0, 2 and 4.

    The result has the components of the grades kept, in the same order.
    """
    sizes = {0: 1, 2: 6, 4: 1}
    blocks, at = {}, 0
    for grade in grades:
        blocks[grade] = data[..., at : at + sizes[grade]]
        at += sizes[grade]
    zero = d.zeros(tuple(data.shape[:-1]))
    zeros = {grade: d.stack([zero] * size) for grade, size in sizes.items() if grade not in blocks}
    even = d.concat([{**blocks, **zeros}[grade] for grade in sizes], axis=-1)
    result = {"exp": exp, "log": log, "sqrt": sqrt}[name](d, even, order)
    ends = {0: (0, 1), 2: (1, 7), 4: (7, 8)}
    return d.concat([result[..., slice(*ends[grade])] for grade in kept], axis=-1)


class _Even:
    """An even element over floats: ``s``, its bivector (..., 6) and ``p``, the last with the sign of J.

    Bivectors remain one array: XLA computes the factors of an array once for each row (see `Numeric.once`).
    """

    def __init__(self, d: Numeric, data: Array, order: Order) -> None:
        self.d, self.order = d, order
        self.s, self.bivector = data[..., 0], data[..., 1:7]
        self.p = order[7][1] * data[..., 7]

    def parts(self, bivector: Array) -> tuple[Parts, Parts]:
        """Return b and m of a bivector ``I3 b + m n``."""
        found = [sign * bivector[..., k - 1] for k, sign in self.order[1:7]]
        return found[:3], found[3:]

    def of_parts(self, b: Parts, m: Parts) -> Array:
        """Return the bivector ``I3 b + m n``."""
        at = {k: sign * x for (k, sign), x in zip(self.order[1:7], [*b, *m], strict=True)}
        return self.d.stack([at[k] for k in range(1, 7)])

    def moved(self, b: Parts) -> Array:
        """Return ``b n = ε I3 b``."""
        return self.of_parts([self.d.zeros_like(b[0])] * 3, b)

    def joined(self, s: Array, bivector: Array, p: Array) -> Array:
        """Return the array of an even element."""
        return self.d.concat([s[..., None], bivector, self.order[7][1] * p[..., None]], axis=-1)


def _by_rows(function: Callable[[Parts], Parts], data: Array, order: Order) -> Array:
    """Apply a function of exact components ``s, b, m, p`` to each row."""

    def ordered(row: Parts) -> Parts:
        result = function([sign * row[k] for k, sign in order])
        at = {k: sign * x for (k, sign), x in zip(order, result, strict=True)}
        return [at[k] for k in range(8)]

    return by_rows(ordered, data)


# --- exp


@compiled
def exp(d: Coefficients, data: Array, order: Order = _IN_ORDER) -> Array:
    """``exp M`` of even elements: of the bivector ``I3 β + v n`` a motor, ``cos Θ + C sin Θ/Θ``.

    C is ``I3 (β + εv)`` and ``Θ² = −C² = β² + 2ε β·v``.
    """
    if not isinstance(d, Numeric):
        return _by_rows(_exact_exp, data, order)
    d.require_finite(components(data))
    even = _Even(d, data, order)
    beta, v = even.parts(even.bivector)
    cosine, sine = cos_sinc(d, beta)
    scale = d.scale_of_large(beta)
    scaled = squares(d, [x / scale for x in beta])
    square = scaled * scale * scale
    small = square < 1
    near, far = d.where(small, square, 0.0), d.where(small, 1.0, square)
    # (cos θ − sin θ/θ)/θ², see `_exp_parts`; then e^s (1 + pJ), see `_times_dual`.
    slope = d.where(small, horner(_SLOPE, -near), cosine - sine) / far
    along = _dot(beta, v)
    across = along * slope - even.p * sine
    turned = sine[..., None] * even.bivector + across[..., None] * even.moved(beta)
    result = even.joined(cosine, turned, sine * along + even.p * cosine)
    result = d.exp(even.s)[..., None] * result
    require_in_range(d, result)
    return result


def _exp_parts(cosine: Any, sine: Any, slope: Any, beta: Parts, v: Parts) -> Parts:
    """Return cos Θ and ``C sin Θ/Θ``, from cos θ, ``sin θ/θ`` and ``(cos θ − sin θ/θ)/θ²``."""
    along = _dot(beta, v)
    turned = [sine * x for x in beta]
    moved = [sine * y + along * slope * x for x, y in zip(beta, v, strict=True)]
    return [cosine, *turned, *moved, sine * along]


def _times_dual(factor: Any, p: Any, parts: Parts) -> Parts:
    """Return ``f (1 + pJ)`` times an even element."""
    s, b, m, q = _split(parts)
    moved = [y - p * x for x, y in zip(b, m, strict=True)]
    return [factor * x for x in (s, *b, *moved, q + p * s)]


def _exact_exp(row: Parts) -> Parts:
    s, beta, v, p = _split(row)
    if all(map(is_zero, beta)):
        cosine, sine, slope = 1, 1, 0  # the last has the factor β
    else:
        size = free_root(_dot(beta, beta))
        cosine, sine = call("cos", size), divide(call("sin", size), size)
        slope = divide(cosine - sine, size * size)
    return _times_dual(call("exp", s), p, _exp_parts(cosine, sine, slope, beta, v))


# --- log


@compiled
def log(d: Coefficients, data: Array, order: Order = _IN_ORDER) -> Array:
    """``ln|M|`` and the bivector B with ``exp B = M/|M|``, of positive multiples of motors.

    ``B = I3 (b + εm) Θ/sin Θ`` for ``cos Θ = s − εp``, with θ in [0, π]; at ``s < 0``, b = 0 in the plane
    perpendicular to m, or e1e2. Derivatives are finite everywhere else. A ValueError where ``M ~M`` is not a
    number to half of the digits; a smaller difference is removed as in `normalized`.
    """
    if not isinstance(d, Numeric):
        return _by_rows(_exact_log, data, order)
    d.require_finite(components(data))
    even = _Even(d, data, order)
    size = _size(d, [even.s, *even.parts(even.bivector)[0]])
    s, p, bivector = even.s / size, even.p / size, even.bivector / size[..., None]
    b, m = even.parts(bivector)
    excess = _excess(d, s, b, m, p)
    p = p + excess * s
    bivector = bivector - excess[..., None] * even.moved(b)
    sine_squared = squares(d, b)
    near = (sine_squared < _NEAR * s * s) & (s > 0)
    safe = d.where(near, s, 1.0)
    u = d.where(near, sine_squared, 0.0) / (safe * safe)
    # Θ/sin Θ and its rate, (1 − θ cot θ)/sin²θ in p.
    length_of_b = d.length(b)
    beyond = ~near & (length_of_b > 0)
    sine = d.where(beyond, length_of_b, 1.0)
    angle = d.atan2(sine, d.where(beyond, s, 1.0))
    factor = d.where(near, horner(_ARTANC, -u), angle) / d.where(near, safe, sine)
    # p times the rate, divided by sin θ once more below; with series by 1.
    rate = d.where(near, horner(_REST, -u), 1 - s * factor) / d.where(near, safe * safe, sine)
    across = even.moved(even.parts(bivector / sine[..., None])[0])
    # M = −(1 − m n): half a turn of the spinor in a plane that commutes with the translation.
    turned = ~near & ~beyond
    plane = d.direction([d.where(turned, x, y) for x, y in zip(m, _E12, strict=True)], _E12)
    half = even.of_parts([math.pi * n for n in plane], [d.zeros_like(s)] * 3)
    found = factor[..., None] * bivector + (p * rate)[..., None] * across
    found = d.where(turned[..., None], half - bivector, found)
    result = even.joined(d.log(size), found, d.zeros_like(s))
    require_in_range(d, result)
    return result


def _exact_log(row: Parts) -> Parts:
    s, b, m, p = _split(row)
    size = length(b)
    if is_zero(size) and is_zero(s):
        raise ValueError(_SINGULAR)
    if not is_rounding(_dot(b, m) - s * p, 1e-8):
        raise ValueError(_NO_MOTOR)
    angle = atan2(size, s)
    if is_zero(size):
        along = length(m)
        plane = [0, 0, 1] if is_zero(along) else [divide(x, along) for x in m]
        beta, v = [angle * n for n in plane], [divide(y, s) for y in m]
    else:
        factor = divide(angle, size)
        rate = divide(p * (1 - s * factor), size * size)
        beta = [factor * x for x in b]
        v = [factor * y + rate * x for x, y in zip(b, m, strict=True)]
    return [log_length(s, size), *beta, *v, 0]


@compiled
def sqrt(d: Coefficients, data: Array, order: Order = _IN_ORDER) -> Array:
    """``√|M| exp(B/2)`` for the logarithm ``ln|M| + B``."""
    logarithm = log(d, data, order)
    if not isinstance(d, Numeric):
        return exp(d, d.divide(logarithm, 2), order)
    # XLA computes cheap operations again for each use, but divisions by what it does not know only once.
    two = d.where(d.isfinite(data[..., :1]), 2.0, math.nan)
    return exp(d, logarithm / two, order)


# --- screws


@compiled
def screw(d: Coefficients, data: Array) -> tuple[Array, Array, Any, Any]:
    """Return axis (..., 3), its point nearest to the origin (..., 3), angle in [0, π] and distance.

    A motor is ``exp(I3 β + v n)``: it turns by ``ω = −2β`` and moves the origin with the velocity 2v. The
    axis without a turn is that of the translation, without either e3; its point is then the origin.
    """
    if not isinstance(d, Numeric):
        rows = by_rows(_exact_screw, data)
        return rows[..., :3], rows[..., 3:6], rows[..., 6][()], rows[..., 7][()]
    logarithm = log(d, d.where(data[..., :1] < 0, -data, data))
    _, beta, v, _ = _split([2.0 * x for x in components(logarithm)])
    angle = d.length(beta)
    turns = angle > 0
    axis = d.direction([d.where(turns, -x, y) for x, y in zip(beta, v, strict=True)], _E12)
    safe = d.where(turns, angle, 1.0)
    point = [d.where(turns, x / safe, 0.0) for x in _cross(axis, v)]
    return d.stack(axis), d.stack(point), angle, _dot(axis, v)


def _exact_screw(row: Parts) -> Parts:
    if not is_symbolic(row[0]) and row[0] < 0:
        row = [-x for x in row]
    _, beta, v, _ = _split([2 * x for x in _exact_log(row)])
    angle = abs(length(beta))
    if is_zero(angle):
        distance = abs(length(v))
        axis = [0, 0, 1] if is_zero(distance) else [divide(x, distance) for x in v]
        return [*axis, 0, 0, 0, 0, distance]
    axis = [divide(-x, angle) for x in beta]
    return [*axis, *(divide(x, angle) for x in _cross(axis, v)), angle, _dot(axis, v)]


@compiled
def adjoint(d: Coefficients, data: Array) -> Array:
    """Return matrices (..., 6, 6) of ``M X ~M`` on screws ``X = −½ I3 ω + ½ v n``, in the order ω, v.

    The blocks are ``[[R, 0], [[x]ₓ R, R]]`` with the rotation R and the translation x,
    ``½ x = s m + p b + m × b``.
    """
    parts = components(data)
    if isinstance(d, Numeric):
        s, b, m, p = _unit(d, parts)
    else:
        s, b, m, p = _split(components(by_rows(_exact_unit, data)))
    moved = [2 * (s * y + p * x + z) for x, y, z in zip(b, m, _cross(m, b), strict=True)]
    turn = to_matrix(d, d.stack([s, *b]))
    columns = [[turn[..., i, j] for i in range(3)] for j in range(3)]
    crossed = [_cross(moved, column) for column in columns]
    zero = d.zeros_like(s)
    rows = [[columns[j][i] for j in range(3)] + [zero] * 3 for i in range(3)]
    rows += [[crossed[j][i] for j in range(3)] + [columns[j][i] for j in range(3)] for i in range(3)]
    flat = d.stack([x for row in rows for x in row])
    return d.reshape(flat, (*flat.shape[:-1], 6, 6))


# --- helpers


def _split(parts: Parts) -> tuple[Any, Parts, Parts, Any]:
    """Return s, b, m and p."""
    return parts[0], parts[1:4], parts[4:7], parts[7]


def _unit(d: Numeric, parts: Parts) -> tuple[Any, Parts, Parts, Any]:
    """Return the motor divided by the dual number ``√(M ~M)``.

    ``M ~M = s² + b² + 2ε δ`` with ``δ = b·m − sp``, which of a motor is 0.
    """
    size = _size(d, parts[:4])
    s, b, m, p = _split([x / size for x in parts])
    excess = _excess(d, s, b, m, p)
    return s, b, [y - excess * x for x, y in zip(b, m, strict=True)], p + excess * s


def _size(d: Numeric, rotor: Parts) -> Array:
    """Return ``√(s² + b²)``, NaN where it is 0."""
    size = d.length(rotor)
    d.require(size > 0, _SINGULAR)
    return d.once(d.where(size > 0, size, math.nan))


def _excess(d: Numeric, s: Array, b: Parts, m: Parts, p: Array) -> Array:
    """Return δ, which of a motor is rounding."""
    d.require_finite([*m, p])
    excess = d.once(_dot(b, m) - s * p)
    d.require(d.abs(excess) <= d.eps**0.5 * (1 + d.length([*m, p])), _NO_MOTOR)
    return excess


def _exact_unit(row: Parts) -> Parts:
    s, b, m, p = _split(row)
    if not is_rounding(_dot(b, m) - s * p, 1e-8):
        raise ValueError(_NO_MOTOR)
    square = s * s + _dot(b, b)
    if is_zero(square):
        raise ValueError(_SINGULAR)
    norm = 1 if is_zero(square - 1) else root_of(square)
    return [divide(x, norm) for x in row]


def _dot(a: Parts, b: Parts) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Parts, b: Parts) -> Parts:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
