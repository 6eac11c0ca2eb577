"""Interpolation of rotors: slerp and splines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, overload

import numpy as np

from polhode import _generic, _native
from polhode._algebra.coefficients import foreign_kind, kind_of, number_like
from polhode._algebra.constructors import bivector
from polhode._algebra.foreign_tables import SPLINE
from polhode._algebra.foreign_values import remedy_for
from polhode._algebra.grades import stack
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._algebra.signs import half_turn
from polhode._support.arrays import Array, as_floats, at_index, first_index, frozen, is_float, power_of_two
from polhode._support.calls import explains_calls, explains_calls_of
from polhode._support.foreign_names import with_foreign_names


@overload
def slerp(R: Rotor, S: Rotor, t: Any) -> Rotor: ...


@overload
def slerp(R: Multivector, S: Multivector, t: Any) -> Multivector: ...


def slerp(R: Any, S: Any, t: Any) -> Any:
    """Return the rotor a fraction t (an array broadcasts) of the way from R to S, at constant rate.

    The shorter way round: ``R (~R S)^t``, with the sign of S that makes it so: t = 0 gives R, t = 1 gives S
    or −S. If the attitudes are half a turn apart, to rounding, both ways are equally long and S keeps its
    sign: R to S and R to −S go opposite ways round.

    Of motors of ``ph.algebra(3, 0, 1)`` the motor, along the screw from one to the other, a turn of at most
    π; of other even versors ``R (R⁻¹ S)^t``, whose norms are interpolated as well.

    Examples
    --------
    A third of the way through a turn of 90°:

    >>> R, S = ph.Rotor.identity(), ph.Rotor.from_axis_angle(ph.e3, 90, degrees=True)
    >>> print(np.degrees(ph.slerp(R, S, 1 / 3).angle).round(6))
    30.0
    >>> ph.slerp(R, S, [0, 0.5, 1]).shape
    (3,)
    """
    if not (isinstance(R, Rotor) and isinstance(S, Rotor)):
        return _slerp_of_versors(R, S, t)
    if (found := _native.slerp_between(R, S, t)) is not None:
        return found
    data = R._data, S._data
    if not all(map(is_float, data)) and kind_of(*data).is_jax:
        fraction = number_like(t, "the fraction of the way", R._data)
        kind = kind_of(*data, fraction)
        first, last, share = map(kind.asarray, (*data, fraction))
        return Rotor._from_rows(_generic.rotors.slerp(kind, first, last, share, half_turn(R._data)))
    step = (~R * S)._data
    return R * Rotor.from_components(_shorter(step, step[..., :1])) ** t


def _slerp_of_versors(R: Any, S: Any, t: Any) -> Any:
    for value in (R, S):
        if not isinstance(value, Multivector) or any(k % 2 for k in value.grades):
            found = f"the grades {value.grades}" if isinstance(value, Multivector) else type(value).__name__
            remedy = remedy_for(value, "S.interpolate(T, t)")
            raise TypeError(f"slerp needs rotors, or motors and other even versors, got {found}{remedy}")
    step = ~R * S / (R * ~R).grade(0)
    shorter = step._like(_shorter(step._data, step.grade(0)._data))
    return R * shorter**t


def _shorter(step: Any, scalar: Any) -> Any:
    """Return components, reversed in sign where the scalar part is negative, beyond rounding."""
    kind = kind_of(step)
    if kind.exact:
        negative = np.frompyfunc(lambda x: _is_negative(x, -half_turn(step)), 1, 1)(scalar)
        return np.where(negative.astype(bool), -step, step)
    return kind.xp.where(scalar < -half_turn(step), -step, step)


def _is_negative(x: Any, bound: float) -> bool:
    """Whether a number is less than the bound, or an expression is known to be negative."""
    return bool(x.is_negative) if _generic.exact.is_symbolic(x) else bool(x < bound)


@explains_calls_of
@with_foreign_names(SPLINE)
class RotorSpline:
    """Cubic spline through the attitudes of `rotors` (n,) at increasing `times` (n,), n >= 2.

    The cubic spline ``s(t)`` of the rotors' components, divided by its norm: ``R(t) = s/|s|``. Rotor,
    angular velocity and angular acceleration are continuous. The spline of ``S R`` or ``R S``, for a fixed S,
    is S times that of R, and the spline of reversed times is the same path. The error between close rotors is
    of the order of the fourth power of their distance, that of the rate of the third.

    Each rotor first takes the sign nearer to the one before it, so that the path goes the short way round and
    stays on one sheet of the double cover; it begins at ``rotors[0]``. Neighbours half a turn apart keep
    their signs, as in `slerp`. At each end the first two intervals share one cubic ("not a knot"); three
    rotors give a parabola, two a line, along which the rate is not constant, unlike `slerp`. A steady turn is
    approximated, not reproduced. A ValueError if the times are so uneven that the path could swing far from
    its rotors.

    Times beyond the first and last are an error; with `extrapolate` the path goes on there at the constant
    angular velocity of that end.

    Examples
    --------
    A turn about e3 that speeds up, ``θ = t²/2``, given at 21 times:

    >>> times = np.linspace(0, 2, 21)
    >>> spline = ph.RotorSpline(times, ph.Rotor.from_axis_angle(ph.e3, times**2 / 2))
    >>> print(spline(1.05).angle.round(5), 1.05**2 / 2)
    0.55125 0.55125
    >>> print(spline.omega_body(1.05)["e12"].round(3), spline.alpha_body(1.05)["e12"].round(2))
    1.05 1.0
    """

    __slots__ = ("_extrapolate", "_slopes", "_times", "_values")

    def __init__(self, times: Any, rotors: Rotor | Sequence[Rotor], *, extrapolate: bool = False) -> None:
        if isinstance(times[0] if isinstance(times, list | tuple) and times else times, Rotor):
            raise TypeError("the times of a spline come first: RotorSpline(times, rotors)")
        listed = isinstance(rotors, list | tuple) and rotors
        spline = "RotorSpline(times, T.rotor), and interpolate T.translation, for transforms T"
        if remedy := remedy_for(rotors[0] if listed else rotors, spline):
            kind = type(rotors[0] if listed else rotors).__name__
            raise TypeError(f"a spline needs rotors, got {kind}{remedy}")
        if not isinstance(rotors, Multivector) and isinstance(rotors, list | tuple) and rotors:
            rotors = stack(rotors)
        if not isinstance(rotors, Rotor) or len(rotors.shape) != 1 or rotors.shape[0] < 2:
            found = f"shape {rotors.shape}" if isinstance(rotors, Rotor) else f"{rotors!r:.80}"
            raise ValueError(f"a spline needs a batch of rotors of shape (n,), n >= 2, got {found}")
        if not is_float(rotors._data) or foreign_kind(times) is not None:
            raise TypeError(
                "a spline needs NumPy floats; convert exact numbers with .astype(float), the arrays of other "
                "libraries with np.asarray(rotors.components)"
            )
        knots = increasing_times(times, len(rotors), "rotor")
        self._extrapolate = bool(extrapolate)
        self._times = frozen(knots)
        self._values = frozen(rotors.astype(float).continuous()._data)
        self._slopes = frozen(spline_slopes(knots, self._values))
        _require_near(knots, self._values, self._slopes)

    @property
    def times(self) -> Array:
        """The times (n,) of the rotors."""
        return self._times.copy()

    @property
    def rotors(self) -> Rotor:
        """The rotors (n,), with the signs that they have on the path.

        Examples
        --------
        The last rotor takes the sign nearer to the first:

        >>> R = ph.Rotor.from_axis_angle(ph.e3, [0, 60], degrees=True)
        >>> spline = ph.RotorSpline([0, 1], [R[0], -R[1]])
        >>> bool((spline.rotors == R).all())
        True
        """
        return Rotor.from_components(self._values)

    @explains_calls(order="spline.omega_body(t) for order 1, spline.alpha_body(t) for order 2")
    def __call__(self, t: Any) -> Rotor:
        """Return the rotors at the times t (...)."""
        s, rate, _, beyond = self._at(t)
        path = Rotor.from_components(s)
        if not beyond.any():
            return path
        further: Rotor = path * (_omega(s, rate) * (-0.5 * beyond)).exp()
        return further

    def omega_body(self, t: Any) -> Multivector:
        """Return the angular velocity at the times t, a bivector in body axes, in rad per unit of time.

        Examples
        --------
        >>> times = np.linspace(0, 2, 21)
        >>> spline = ph.RotorSpline(times, ph.Rotor.from_axis_angle(ph.e3, 3 * times))
        >>> spline.omega_body([0.25, 1.25])["e12"].round(2)
        array([3., 3.])
        """
        s, rate, _, _ = self._at(t)
        return _omega(s, rate)

    def alpha_body(self, t: Any) -> Multivector:
        """Return the angular acceleration at the times t: the rate of `omega_body`, a bivector in body axes.

        It is continuous, of second order in the distance of the rotors, and 0 beyond the ends.

        Examples
        --------
        >>> times = np.linspace(0, 2, 21)
        >>> spline = ph.RotorSpline(times, ph.Rotor.from_axis_angle(ph.e3, times**2))
        >>> print(spline.alpha_body(1.0)["e12"].round(1))
        2.0
        """
        s, rate, bend, beyond = self._at(t)
        # (<~s s'>₂)' = <~s s''>₂, since ~s' s' is a scalar.
        growth = 2 * (s * rate).sum(axis=-1) / (s * s).sum(axis=-1)
        alpha: Multivector = (_omega(s, bend) - _omega(s, rate) * growth) * np.where(beyond == 0, 1.0, 0.0)
        return alpha

    def __repr__(self) -> str:
        first, last = self._times[[0, -1]]
        return f"RotorSpline({len(self._times)} rotors, times {first:.8g} to {last:.8g})"

    def _at(self, t: Any) -> tuple[Array, Array, Array, Array]:
        """Return s, its first and second derivative at t or the nearest end, and the time beyond this end."""
        when = as_floats(t, "the time")
        first, last = self._times[[0, -1]]
        outside = ~((when >= first) & (when <= last))
        unusable = ~np.isfinite(when) if self._extrapolate else outside
        if unusable.any():
            index = first_index(unusable)
            message = (
                f"the time{at_index(index)} is {when[index]:g}; the spline goes from {first:g} to {last:g}"
            )
            raise ValueError(message + ("" if self._extrapolate else " (extrapolate=True goes on beyond)"))
        given, when = when, np.clip(when, first, last)
        k = np.clip(np.searchsorted(self._times, when, side="right") - 1, 0, len(self._times) - 2)
        step = (self._times[k + 1] - self._times[k])[..., np.newaxis]
        u = ((when - self._times[k])[..., np.newaxis]) / step
        a, b = self._values[k], self._values[k + 1]
        # The slopes beyond that of the chord, at either end.
        p, q = step * self._slopes[k] - (b - a), step * self._slopes[k + 1] - (b - a)
        s = (1 - u) * a + u * b + u * (1 - u) * ((1 - u) * p - u * q)
        rate = (b - a + (1 - u) * (1 - 3 * u) * p + u * (3 * u - 2) * q) / step
        with np.errstate(over="ignore"):
            bend = ((6 * u - 4) * p + (6 * u - 2) * q) / step / step
        return s, rate, bend, given - when


def _omega(s: Array, rate: Array) -> Multivector:
    """Return the angular velocity of ``R = s/|s|`` where s has this rate.

    ``~s s' = ½(|s|²)' + |s|² ~R R'``, and ``Ω_B = −2 ~R R'`` (handout eq. 4.13).
    """
    even = bivector(rate[..., 1:]) + rate[..., 0]
    size: Array = np.linalg.norm(s, axis=-1)
    return (~Rotor.from_components(s) * even).grade(2) * (-2 / size)


def increasing_times(times: Any, count: int, what: str) -> Array:
    """Return the times (count,) of samples; a ValueError unless they are finite and increase."""
    knots = np.array(as_floats(times, "times"))
    if knots.shape != (count,):
        raise ValueError(f"times must be {count} numbers, one for each {what}, got shape {knots.shape}")
    if not np.isfinite(knots).all():
        i = int(np.argmin(np.isfinite(knots)))
        raise ValueError(f"times must be finite, but the time at index {i} is {knots[i]:g}")
    rising = np.diff(knots) > 0
    if not rising.all():
        i = int(np.argmin(rising))
        raise ValueError(f"times must increase, but {knots[i]:g} at index {i} precedes {knots[i + 1]:g}")
    return knots


def _require_near(x: Array, y: Array, slopes: Array) -> None:
    """Raise a ValueError if the spline may come near 0, where it has no direction.

    A cubic lies in the convex hull of its Bézier points: its ends a, b and the points a third of the end
    slopes away from them. The ends project to √½ or more on the direction of ``a + b``. If the other two
    points project to 0.1 or more, so does the whole curve.
    """
    step = np.diff(x)[:, np.newaxis]
    a, b = y[:-1], y[1:]
    middle = (a + b) / np.linalg.norm(a + b, axis=-1, keepdims=True)
    along = [np.sum(middle * c, axis=-1) for c in (a + step * slopes[:-1] / 3, b - step * slopes[1:] / 3)]
    far = ~(np.minimum(*along) >= 0.1)
    if far.any():
        i = int(np.argmax(far))
        raise ValueError(
            f"from {x[i]:g} to {x[i + 1]:g} a smooth path would swing far from the rotors at both times; "
            "give more of them there, at more even times"
        )


def spline_slopes(x: Array, y: Array) -> Array:
    """Return the slopes (n, m) at x (n,) of the not-a-knot cubic spline through y (n, m).

    With steps h and slopes of chords c, the second derivative is continuous if the slopes d satisfy
    ``h_k d_{k-1} + 2 (h_{k-1} + h_k) d_k + h_{k-1} d_{k+1} = 3 (h_k c_{k-1} + h_{k-1} c_k)``, the third one
    at x_1 if ``h_1 d_0 + (h_0 + h_1) d_1`` has the value of `_edge`. This eliminates d_0 from the first
    equation, which remains diagonally dominant; likewise at the other end.
    """
    # By a power of two, which rounds nothing: products of steps neither overflow nor vanish.
    scale = power_of_two(np.diff(x), -1)
    slopes = _scaled_slopes(np.diff(x)[:, np.newaxis] / scale, y)
    with np.errstate(over="ignore"):
        return slopes / scale


def _scaled_slopes(h: Array, y: Array) -> Array:
    """Return the slopes for steps h (n − 1, 1) of size 1."""
    c = np.diff(y, axis=0) / h
    if len(y) == 2:
        return np.concatenate([c, c])
    before, after = h[:-1], h[1:]
    both = before + after
    right = 3 * (after * c[:-1] + before * c[1:])
    if len(y) == 3:
        inner = right / (3 * both)
    else:
        diagonal = 2 * both
        first = _edge(h[0], h[1], c[0], c[1])
        last = _edge(h[-1], h[-2], c[-1], c[-2])
        diagonal[[0, -1]] -= both[[0, -1]]
        right[0] -= first
        right[-1] -= last
        inner = _tridiagonal(after, diagonal, before, right)
    d_first = (_edge(h[0], h[1], c[0], c[1]) - both[0] * inner[0]) / h[1]
    d_last = (_edge(h[-1], h[-2], c[-1], c[-2]) - both[-1] * inner[-1]) / h[-2]
    return np.concatenate([d_first[np.newaxis], inner, d_last[np.newaxis]])


def _edge(h0: Array, h1: Array, c0: Array, c1: Array) -> Array:
    """Return ``h1 d0 + (h0 + h1) d1`` where one cubic spans the first two steps."""
    edge: Array = ((3 * h0 + 2 * h1) * h1 * c0 + h0**2 * c1) / (h0 + h1)
    return edge


def _tridiagonal(lower: Array, diagonal: Array, upper: Array, right: Array) -> Array:
    """Solve ``lower x_{k-1} + diagonal x_k + upper x_{k+1} = right`` by cyclic reduction.

    The first number of `lower` and the last of `upper` are not used. The even equations eliminate the
    neighbours of each odd one, which leaves half as many; stable for diagonally dominant rows.
    """
    n = len(diagonal)
    if n == 1:
        return right / diagonal
    low, high = lower[1::2] / diagonal[:-1:2], np.zeros_like(diagonal[1::2])
    after = diagonal[2::2]
    high[: len(after)] = upper[1 : 2 * len(after) : 2] / after

    def following(values: Array) -> Array:
        """Return the even rows from the second on, zero where an odd row is the last."""
        padded = np.zeros_like(values[1::2])
        padded[: len(after)] = values[2::2]
        return padded

    odd = _tridiagonal(
        -low * lower[:-1:2],
        diagonal[1::2] - low * upper[:-1:2] - high * following(lower),
        -high * following(upper),
        right[1::2] - low * right[:-1:2] - high * following(right),
    )
    x = np.empty_like(right)
    x[1::2] = odd
    left, beyond = np.zeros_like(right[::2]), np.zeros_like(right[::2])
    left[1:] = odd[: len(left) - 1]
    beyond[: len(odd)] = odd
    x[::2] = (right[::2] - lower[::2] * left - upper[::2] * beyond) / diagonal[::2]
    return x
