"""Bodies in principal axes and states of their motion, in components."""

from __future__ import annotations

from typing import Any, NamedTuple

from polhode.jax._components import Four, Three, cross, minus, plus

Array = Any


class Phase(NamedTuple):
    """A state in principal axes: rotor R to space, momentum with that of a wheel, time in s."""

    rotor: Four
    momentum: Three
    time: Array

    def vertical(self) -> Three:
        """``γ = ~R e3 R``: the vertical in body axes."""
        s, x, y, z = self.rotor
        return 2.0 * (x * z + s * y), 2.0 * (y * z - s * x), s * s + z * z - (x * x + y * y)


class Gyrostat(NamedTuple):
    """Principal moments, and the momentum h of a wheel relative to the body (None without a wheel)."""

    moments: Three
    wheel: Three | None = None

    def carried(self, omega: Three) -> Three:
        """``I(Ω)``."""
        i = self.moments
        return i[0] * omega[0], i[1] * omega[1], i[2] * omega[2]

    def momentum(self, omega: Three) -> Three:
        """``m = I(Ω) + h``."""
        carried = self.carried(omega)
        return carried if self.wheel is None else plus(carried, self.wheel)

    def omega(self, momentum: Three) -> Three:
        """``Ω = I⁻¹(m − h)``."""
        i, m = self.moments, momentum
        if self.wheel is not None:
            m = minus(m, self.wheel)
        return m[0] / i[0], m[1] / i[1], m[2] / i[2]

    def rate(self, omega: Three, torque: Three) -> Three:
        """``Ω'`` by Euler's equations, handout eq. (4.21)."""
        i, turned = self.moments, cross(self.momentum(omega), omega)
        total = plus(turned, torque)
        return total[0] / i[0], total[1] / i[1], total[2] / i[2]
