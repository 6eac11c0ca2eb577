"""Steps of motions in principal axes: splittings into exact turns and kicks, and Runge–Kutta.

Splittings step as in `crates/rigid/src/methods/splitting`, which derives them. The turns are about the axes
of the smallest and the largest moment. Which those are is known when the program runs, not when it is
compiled, so a motion is stepped over renamed axes: with the smallest first and the largest last, and every
bivector negated where that order is odd, so that products of renamed values are renamed products. Renaming
is exact.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import pairwise
from typing import Any, NamedTuple

from polhode.jax._components import (
    Four,
    Three,
    compose,
    cosine_and_sinc,
    cross,
    dot,
    exponential,
    minus,
    normalized,
    plus,
    renormalized,
    reverse,
    times,
    turned,
    twice_the_rate,
)
from polhode.jax._laws import Gyrostat, Phase, Torque
from polhode.jax._library import Array, jnp, lax

Seven = tuple[Array, ...]

# γ_1 … up to the middle one, as in crates/rigid/src/methods/splitting/sequences.rs; the rest mirrors them.
COMPOSITIONS = {
    "strang": [1.0],
    "yoshida4": [1.3512071919596576, -1.7024143839193153],
    "yoshida6": [0.7845136104775573, 0.23557321335935813, -1.177679984178871, 1.3151863206839112],
    "kahan_li6": [
        0.3921614440073141,
        0.33259913678935944,
        -0.7062461725576394,
        0.0822135962935508,
        0.7985439909348299,
    ],
    "kahan_li8": [
        0.13020248308889008,
        0.5611629817751084,
        -0.3894749626448473,
        0.1588419065551556,
        -0.3959038941332376,
        0.1845396409783157,
        0.25837438768632204,
        0.2950117236093103,
        -0.6055085338300345,
    ],
}
METHODS = (*COMPOSITIONS, "rk4")


def stepper(method: str, body: Gyrostat, torque: Torque, table: Array) -> Any:
    """Return the stepper with the coefficients of `table_of`."""
    return RungeKutta(body, torque) if method == "rk4" else Splitting(method, body, torque, table)


def table_of(method: str) -> list[float]:
    """Return the coefficients of the stages of a method."""
    return [] if method == "rk4" else [x for stage in stages(method) for x in stage]


def stages(name: str) -> list[tuple[float, float]]:
    """Return alternating kicks and drifts; adjacent half kicks are merged, the first kick is the last too."""
    half = COMPOSITIONS[name]
    drifts = half + half[-2::-1]
    kicks = [0.5 * drifts[0]] + [0.5 * a + 0.5 * b for a, b in pairwise(drifts)]
    return list(zip(kicks, drifts, strict=True))


class Axes(NamedTuple):
    """The axes of the smallest, middle and largest moment, as masks of e1, e2, e3; the sign of the order."""

    small: Three
    middle: Three
    large: Three
    sign: Array

    @staticmethod
    def of(moments: Three) -> Axes:
        """Order the axes by moments; of equal moments the first counts as smaller."""
        i, j, k = moments
        small1 = (i <= j) & (i <= k)
        small2 = ~small1 & (j <= k)
        large3 = (k >= j) & (k >= i)
        large2 = ~large3 & (j >= i)
        small = small1, small2, ~(small1 | small2)
        large = ~(large2 | large3), large2, large3
        middle = tuple(~(a | b) for a, b in zip(small, large, strict=True))
        even = (small[0] & large[2]) | (small[1] & large[0]) | (small[2] & large[1])
        return Axes(small, middle, large, jnp.where(even, 1.0, -1.0).astype(i.dtype))

    def pick(self, x: Three) -> Three:
        """Return the three numbers in the order of the axes."""

        def one(mask: Three) -> Array:
            return jnp.where(mask[0], x[0], jnp.where(mask[1], x[1], x[2]))

        return one(self.small), one(self.middle), one(self.large)

    def renamed(self, b: Three) -> Three:
        """Return a bivector over the renamed axes."""
        return times(self.pick(b), self.sign)

    def placed(self, x: Three) -> Three:
        """Return three numbers in the order of the axes as those of e1, e2, e3."""

        def one(k: int) -> Array:
            return jnp.where(self.small[k], x[0], jnp.where(self.middle[k], x[1], x[2]))

        return one(0), one(1), one(2)

    def restored(self, b: Three) -> Three:
        """Return the bivector over e1, e2, e3."""
        return times(self.placed(b), self.sign)

    def renamed_rotor(self, r: Four) -> Four:
        """Return a rotor over the renamed axes."""
        return r[0], *self.renamed(r[1:])

    def restored_rotor(self, r: Four) -> Four:
        """Return the rotor over e1, e2, e3."""
        return r[0], *self.restored(r[1:])


class Splitting:
    """A body and laws that do not depend on the angular velocity, stepped by one of `COMPOSITIONS`.

    Phases are over the renamed axes; laws take and return values over e1, e2, e3. `table` has the numbers of
    the `stages` once more, one after the other, as the program reads them: several stages are a loop, which
    compiles sooner than their steps side by side.
    """

    def __init__(self, name: str, body: Gyrostat, torque: Torque, table: Array) -> None:
        self.body, self.torque, self.damping = body, torque, torque.damping()
        self.stages, self.table = stages(name), table
        self.axes = Axes.of(body.moments)
        small, middle, large = self.axes.pick(body.moments)
        reciprocals = self.axes.pick(body.reciprocals)
        self.over_middle = reciprocals[1]
        # 1/i_k − 1/i_p, without subtracting nearly equal quotients.
        self.kappa = (
            (middle - small) * reciprocals[1] * reciprocals[0],
            (middle - large) * reciprocals[1] * reciprocals[2],
        )
        self.wheel = None if body.wheel is None else self.axes.renamed(body.wheel)
        self.turning = None if body.wheel is None else self.axes.renamed(body.omega((0.0, 0.0, 0.0)))

    def start(self, rotor: Four, omega: Three, time: Array) -> Phase:
        """Return the initial state."""
        momentum = self.axes.renamed(self.body.momentum(omega))
        return Phase(self.axes.renamed_rotor(rotor), momentum, time)

    def rotor(self, phase: Phase) -> Four:
        """Return the rotor over e1, e2, e3."""
        return self.axes.restored_rotor(phase.rotor)

    def omega(self, phase: Phase) -> Three:
        """Return the angular velocity over e1, e2, e3."""
        return self.body.omega(self.axes.restored(phase.momentum))

    def fixed(self, start: Phase) -> Three | None:
        """Return L in space if the laws conserve it."""
        return turned(start.rotor, start.momentum) if self.torque.turns_nothing else None

    def step(self, fixed: Three | None, phase: Phase, h: Array) -> Phase:
        """Take a step of length h, then correct the rounding of |R| and of a constant L."""
        start = phase.time
        acting = self.torque.within(start + 0.5 * h)
        if fixed is not None:
            phase = self._turn_about_momentum(phase, h)
            phase = self._stages(phase, h, lambda phase, _, drift: self._turn_about_axes(phase, drift))
        else:
            phase = self._stages(phase, h, partial(self._kick_and_drift, acting))
            phase = self._kick(acting, phase, self.stages[0][0] * h)
        phase = Phase(renormalized(phase.rotor), phase.momentum, start + h)
        return phase if fixed is None else _restored(phase, fixed)

    def _stages(self, phase: Phase, h: Array, stage: Callable[..., Phase]) -> Phase:
        if len(self.stages) == 1:
            ((kick, drift),) = self.stages
            return stage(phase, kick * h, drift * h)

        def one(k: Array, phase: Phase) -> Phase:
            return stage(phase, self.table[2 * k] * h, self.table[2 * k + 1] * h)

        return lax.fori_loop(0, len(self.stages), one, phase)  # type: ignore[no-any-return]

    def _kick_and_drift(self, acting: Torque, phase: Phase, kick: Array, drift: Array) -> Phase:
        phase = self._turn_about_momentum(self._kick(acting, phase, kick), drift)
        phase = self._turn_about_axes(phase, drift)
        return phase._replace(time=phase.time + drift)

    def _kick(self, acting: Torque, phase: Phase, h: Array) -> Phase:
        """``m' = N − g (m − h)`` for a time: ``(m − h) e^(−gt) + N (1 − e^(−gt))/g``."""
        momentum, impulse = phase.momentum, h
        given = Phase(self.rotor(phase), self.axes.restored(momentum), phase.time)
        torque = self.axes.renamed(acting.value(self.body, given))
        if self.damping is not None:
            decay = -self.damping * h
            ratio = _expm1_ratio(decay)
            carried = momentum if self.wheel is None else minus(momentum, self.wheel)
            momentum, impulse = plus(momentum, times(carried, ratio * decay)), h * ratio
        return phase._replace(momentum=plus(momentum, times(torque, impulse)))

    def _turn_about_momentum(self, phase: Phase, h: Array) -> Phase:
        """``R ← R exp(−½ h m/i_p)``, which commutes with the other turns."""
        half = 0.5 * h * self.over_middle
        cos, sinc = cosine_and_sinc(half * half * dot(phase.momentum, phase.momentum))
        return phase._replace(rotor=compose(phase.rotor, (cos, *times(phase.momentum, -half * sinc))))

    def _turn_about_axes(self, phase: Phase, h: Array) -> Phase:
        """Turns a–b–a, with that of a wheel in their middle."""
        r, m, half = phase.rotor, phase.momentum, 0.5 * h
        r, m = _turn_first(r, m, 0.5 * self.kappa[0] * m[0] * half)
        if self.turning is None:
            r, m = _turn_last(r, m, 0.5 * self.kappa[1] * m[2] * h)
        else:
            r, m = _turn_last(r, m, 0.5 * self.kappa[1] * m[2] * half)
            q = exponential(times(self.turning, -half))
            r, m = compose(r, q), turned(reverse(q), m)
            r, m = _turn_last(r, m, 0.5 * self.kappa[1] * m[2] * half)
        r, m = _turn_first(r, m, 0.5 * self.kappa[0] * m[0] * half)
        return phase._replace(rotor=r, momentum=m)


def _turn_first(r: Four, m: Three, half: Array) -> tuple[Four, Three]:
    """``R ← R q``, ``m ← ~q m q`` with ``q = exp(−half I e1)``, written out."""
    cos, sinc = cosine_and_sinc(half * half)
    sin = half * sinc
    s, x, y, z = r
    # Add the turn to m: rounded cosines and sines would scale it by the same factor in every step.
    versine, sine = 2.0 * sin * sin, 2.0 * sin * cos
    _, a, b = m
    return (
        (s * cos + x * sin, x * cos - s * sin, y * cos + z * sin, z * cos - y * sin),
        (m[0], a + (sine * b - versine * a), b - (sine * a + versine * b)),
    )


def _turn_last(r: Four, m: Three, half: Array) -> tuple[Four, Three]:
    """The same about e3."""
    s, x, y, z = r
    (s, z, x, y), (c, a, b) = _turn_first((s, z, x, y), (m[2], m[0], m[1]), half)
    return (s, x, y, z), (a, b, c)


def _restored(phase: Phase, fixed: Three) -> Phase:
    """Correct |m| and the direction of ``R m ~R`` for the rounding of a free step, to first order."""
    size = dot(fixed, fixed)
    still = size == 0
    over_size = jnp.where(still, 0.0, 1.0 / jnp.where(still, 1.0, size))
    missing = 0.5 * over_size * (size - dot(phase.momentum, phase.momentum))
    momentum = plus(phase.momentum, times(phase.momentum, missing))
    wandered = turned(phase.rotor, momentum)
    x, y, z = times(cross(wandered, fixed), -0.5 * over_size)
    return Phase(compose((jnp.ones_like(x), x, y, z), phase.rotor), momentum, phase.time)


def _expm1_ratio(x: Array) -> Array:
    """``(eˣ − 1)/x``, with its derivatives near 0."""
    near = jnp.abs(x) < 1e-2
    small, large = jnp.where(near, x, 0.0), jnp.where(near, 1.0, x)
    series = 1.0
    for k in range(9, 1, -1):
        series = 1.0 + small / k * series
    return jnp.where(near, series, jnp.expm1(large) / large)


# --- Runge–Kutta


class Point(NamedTuple):
    """Rotor and angular velocity at a time."""

    rotor: Four
    spin: Three
    time: Array


class RungeKutta:
    """A body and its laws, stepped by the classical method on the rotor and the angular velocity.

    ``R' = −½ R Ω_B`` and Euler's equations (handout eq. 4.13, 4.21). After each step R is corrected to norm
    1, to third order in ``|R|² − 1``, which is all that the step does to stay on the group: it needs no sine,
    no root and no branch. Rotors of the result have norm 1.
    """

    def __init__(self, body: Gyrostat, torque: Torque) -> None:
        self.body, self.torque = body, torque

    def start(self, rotor: Four, omega: Three, time: Array) -> Point:
        """Return the initial state."""
        return Point(rotor, omega, time)

    def rotor(self, point: Point) -> Four:
        """Return the rotor, which a step too long leaves beside norm 1."""
        return normalized(point.rotor)

    def omega(self, point: Point) -> Three:
        """Return the angular velocity."""
        return point.spin

    def fixed(self, start: Point) -> None:
        """Return None: the method conserves nothing exactly."""

    def step(self, fixed: None, point: Point, h: Array) -> Point:
        """Take a step of length h."""
        t = point.time
        state = (*point.rotor, *point.spin)
        acting = self.torque.within(t + 0.5 * h)
        middle, half, sixth = t + 0.5 * h, 0.5 * h, h * (1 / 6)
        # Each slope enters the sum at once, so that few numbers are in registers.
        k = self._slope(acting, state, t)
        total = _moved(state, k, sixth)
        k = self._slope(acting, _moved(state, k, half), middle)
        total = _moved(total, k, 2.0 * sixth)
        k = self._slope(acting, _moved(state, k, half), middle)
        total = _moved(total, k, 2.0 * sixth)
        k = self._slope(acting, _moved(state, k, h), t + h)
        total = _moved(total, k, sixth)
        s, x, y, z, p, q, r = total
        return Point(renormalized((s, x, y, z)), (p, q, r), t + h)

    def _slope(self, acting: Torque, state: Seven, time: Array) -> Seven:
        """Return ``2 R'`` and ``Ω'``."""
        s, x, y, z, p, q, r = state
        rotor, omega = (s, x, y, z), (p, q, r)
        torque = None
        if not self.torque.turns_nothing:
            torque = acting.exerted(self.body, Phase(rotor, self.body.momentum(omega), time))
        return (*twice_the_rate(rotor, omega), *self.body.rate(omega, torque))


def _moved(state: Seven, slope: Seven, h: Array) -> Seven:
    """Return the state after a time h with a slope of `_slope`."""
    lengths = (0.5 * h,) * 4 + (h,) * 3
    s, x, y, z, p, q, r = (a + k * b for a, b, k in zip(state, slope, lengths, strict=True))
    return s, x, y, z, p, q, r
