"""The classical Runge–Kutta method on the rotor and the angular velocity in principal axes.

``R' = −½ R Ω_B`` and Euler's equations (handout eq. 4.13, 4.21); after each step R is divided by its norm,
which is all that the step does to stay on the group. It needs no sine, no root but one, and no branch.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from polhode.jax._components import Four, Three, normalized, rotor_rate
from polhode.jax._laws import Gyrostat, Phase, Torque

Array = Any
Seven = tuple[Array, ...]


class Point(NamedTuple):
    """Rotor and angular velocity at a time."""

    rotor: Four
    spin: Three
    time: Array


class RungeKutta:
    """A body and its laws."""

    def __init__(self, body: Gyrostat, torque: Torque) -> None:
        self.body, self.torque = body, torque

    def start(self, rotor: Four, omega: Three, time: Array) -> Point:
        """Return the initial state."""
        return Point(rotor, omega, time)

    def omega(self, point: Point) -> Three:
        """Return the angular velocity."""
        return point.spin

    def fixed(self, start: Point) -> None:
        """Return None: the method conserves nothing exactly."""

    def step(self, fixed: None, point: Point, h: Array) -> Point:
        """Take a step of length h."""
        t = point.time
        state = (*point.rotor, *point.spin)
        k1 = self._slope(state, t)
        k2 = self._slope(_moved(state, k1, 0.5 * h), t + 0.5 * h)
        k3 = self._slope(_moved(state, k2, 0.5 * h), t + 0.5 * h)
        k4 = self._slope(_moved(state, k3, h), t + h)
        mean = tuple((a + d) + 2.0 * (b + c) for a, b, c, d in zip(k1, k2, k3, k4, strict=True))
        s, x, y, z, p, q, r = _moved(state, mean, h / 6.0)
        return Point(normalized((s, x, y, z)), (p, q, r), t + h)

    def _slope(self, state: Seven, time: Array) -> Seven:
        s, x, y, z, p, q, r = state
        rotor, omega = (s, x, y, z), (p, q, r)
        torque = self.torque.exerted(self.body, Phase(rotor, self.body.momentum(omega), time))
        return (*rotor_rate(rotor, omega), *self.body.rate(omega, torque))


def _moved(state: Seven, slope: Seven, h: Array) -> Seven:
    return tuple(a + h * b for a, b in zip(state, slope, strict=True))
