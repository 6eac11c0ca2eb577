"""Torque laws as pytrees, with their parameters as leaves for differentiation and mapping.

They compute what `crates/rigid/src/laws/torque/mod.rs` does, in the same order: the torque in principal axes,
without damping ``−g I(Ω)`` and the reaction of a wheel, which steps add. A law without a function here is
computed by its formula in the registry of laws.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from typing import Any, NamedTuple, TypeVar, dataclass_transform

from polhode._generic.g3_smooth import log_even
from polhode._generic.numeric import Numeric
from polhode._mechanics.sums import CONSTANT_TORQUE, Sum
from polhode.jax._components import (
    Four,
    Three,
    along,
    compose,
    cross,
    joined,
    length,
    minus,
    plus,
    reverse,
    split,
    times,
    turned,
)
from polhode.jax._library import Array, jax, jnp

T = TypeVar("T")


# --- bodies and states


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
    """A body: principal moments, and the momentum h of a wheel relative to the body (None without a wheel).

    Quotients of the moments are computed once, because one costs a processor as much as ten products:
    ``1/i1`` and ``(i2 − i3)/i1`` with those of the other axes.
    """

    moments: Three
    reciprocals: Three
    differences: Three
    wheel: Three | None

    @staticmethod
    def of(moments: Three, wheel: Three | None) -> Gyrostat:
        """Return the body."""
        i, j, k = moments
        reciprocals = 1.0 / i, 1.0 / j, 1.0 / k
        return Gyrostat(moments, reciprocals, along(reciprocals, (j - k, k - i, i - j)), wheel)

    def carried(self, omega: Three) -> Three:
        """``I(Ω)``."""
        return along(self.moments, omega)

    def momentum(self, omega: Three) -> Three:
        """``m = I(Ω) + h``."""
        carried = self.carried(omega)
        return carried if self.wheel is None else plus(carried, self.wheel)

    def omega(self, momentum: Three) -> Three:
        """``Ω = I⁻¹(m − h)``."""
        carried = momentum if self.wheel is None else minus(momentum, self.wheel)
        return along(self.reciprocals, carried)

    def rate(self, omega: Three, torque: Three | None) -> Three:
        """``Ω'`` by Euler's equations, handout eq. (4.21): ``i1 Ω1' = (i2 − i3) Ω2 Ω3 + N1``."""
        p, q, r = omega
        rate = along(self.differences, (q * r, r * p, p * q))
        if self.wheel is not None:
            reaction = cross(self.wheel, omega)
            torque = reaction if torque is None else plus(torque, reaction)
        return rate if torque is None else plus(rate, along(self.reciprocals, torque))


# --- laws


def static(**options: Any) -> Any:
    """Declare a static field: JAX compiles for each of its values."""
    return field(metadata={"static": True}, **options)


@dataclass_transform(frozen_default=True, field_specifiers=(static,))
def pytree(cls: type[T]) -> type[T]:
    """Return the class as a frozen dataclass and a pytree, with its parameters as leaves."""
    frozen: Any = dataclass(frozen=True)(cls)
    names: dict[bool, list[str]] = {True: [], False: []}
    for one in fields(frozen):
        names[one.metadata.get("static", False)].append(one.name)
    jax.tree_util.register_dataclass(frozen, names[False], names[True])
    return cls


class Law:
    """A torque law; by default it depends on attitude and time alone."""

    @property
    def depends_on_rate(self) -> bool:
        """Whether the torque depends on the angular velocity: a kick at fixed attitude is not exact."""
        return False

    def in_axes(self, frame: Four) -> Law:
        """Return the same law in body axes turned by a rotor: ``x' = ~F x F``."""
        return self

    def within(self, middle: Array) -> Law:
        """Return the law as it acts in a step with this middle; a law that jumps in time is held."""
        return self

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        """Return the torque in principal axes."""
        raise NotImplementedError


def zero(phase: Phase) -> Three:
    """Return a zero torque."""
    none = jnp.zeros_like(phase.momentum[0])
    return none, none, none


class At(NamedTuple):
    """A body at a phase; `frame` is the rotor from principal to body axes, where gains need it."""

    body: Gyrostat
    phase: Phase
    frame: Four | None

    @property
    def omega(self) -> Three:
        """The angular velocity."""
        return self.body.omega(self.phase.momentum)

    def in_body(self, v: Three) -> Three:
        """Return a vector given in space."""
        return turned(reverse(self.phase.rotor), v)

    def along(self, gains: Three, b: Three) -> Three:
        """Multiply by gains along the body axes."""
        if self.frame is not None:
            b = turned(self.frame, b)
        b = along(gains, b)
        return b if self.frame is None else turned(reverse(self.frame), b)


@pytree
class Kernel(Law):
    """A law whose torque is a function of `At` and its arguments.

    `kinds` says how arguments change with the body axes: ``"body"``, a vector in them, ``"rotor"`` from them
    to space, ``"gains"`` along the given axes; others do not.
    """

    f: Callable[..., Three] = static()
    arguments: tuple[Any, ...]
    kinds: tuple[str, ...] = static()
    rate: bool = static()
    frame: Four | None

    @property
    def depends_on_rate(self) -> bool:
        return self.rate

    def in_axes(self, frame: Four) -> Law:
        changed: dict[str, Any] = {
            "body": lambda v: turned(reverse(frame), v),
            "rotor": lambda r: compose(r, frame),
        }
        arguments = zip(self.kinds, self.arguments, strict=True)
        return replace(
            self,
            arguments=tuple(changed[kind](x) if kind in changed else x for kind, x in arguments),
            frame=frame if "gains" in self.kinds else None,
        )

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        return self.f(At(body, phase, self.frame), *self.arguments)


def kernel(f: Callable[..., Three], *kinds: str, rate: bool = False) -> Callable[..., Kernel]:
    """Return the constructor of a law from arguments of these kinds; `rate` as `Law.depends_on_rate`."""
    return lambda *arguments: Kernel(f=f, arguments=arguments, kinds=kinds, rate=rate, frame=None)


def weight(at: At, c: Three) -> Three:
    """``γ∧c``."""
    return cross(at.phase.vertical(), c)


def fixed_in_body(at: At, N: Three) -> Three:
    """N in body axes."""
    return plus(zero(at.phase), N)


def fixed_in_space(at: At, N: Three) -> Three:
    """N in space."""
    return at.in_body(N)


def dipole(at: At, m: Three, B: Three) -> Three:
    """``m∧b``, b the field in the body."""
    return cross(m, at.in_body(B))


def precession(at: At, b: Three) -> Three:
    """``L x b``."""
    return cross(at.phase.momentum, at.in_body(b))


def stiffness(at: At, k: Array, rest: Four) -> Three:
    """``−k Θ``."""
    return times(turn_from(rest, at.phase.rotor), -k)


def undamped_control(at: At, kp: Three, kd: Three, target: Four) -> Three:
    """``−kp Θ``."""
    return times(at.along(kp, turn_from(target, at.phase.rotor)), -1.0)


def control(at: At, kp: Three, kd: Three, target: Four) -> Three:
    """``−kp Θ − kd Ω``."""
    pull = at.along(kp, turn_from(target, at.phase.rotor))
    return times(plus(pull, at.along(kd, at.omega)), -1.0)


def viscous(at: At, d: Three) -> Three:
    """``−d Ω``."""
    return times(at.along(d, at.omega), -1.0)


def quadratic(at: At, k: Array) -> Three:
    """``−k |Ω| Ω``."""
    omega = at.omega
    return times(omega, -k * length(omega))


def damped_momentum(at: At, g: Array) -> Three:
    """``−g I(Ω)``, which steps add."""
    return zero(at.phase)


def wheel(at: At, h: Three) -> Three:
    """The reaction of a wheel, a part of the body, which steps add."""
    return zero(at.phase)


@pytree
class Function(Law):
    """``f(t, rotor, omega_body)`` of arrays: a function, or a ``jax.tree_util.Partial`` with leaves."""

    f: Callable[..., Any] | None = static()
    partial: Any
    frame: Four | None

    @property
    def depends_on_rate(self) -> bool:
        return True

    def in_axes(self, frame: Four) -> Law:
        return replace(self, frame=frame)

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        rotor, omega = phase.rotor, body.omega(phase.momentum)
        if self.frame is not None:
            rotor, omega = compose(rotor, reverse(self.frame)), turned(self.frame, omega)
        f: Any = self.f if self.partial is None else self.partial
        torque = split(jnp.asarray(f(phase.time, joined(rotor), joined(omega))))
        if len(torque) != 3:
            raise ValueError(
                f"the function must return a torque of 3 components in its last axis, got {len(torque)}"
            )
        return torque if self.frame is None else turned(reverse(self.frame), torque)


def turn_from(rest: Four, rotor: Four) -> Three:
    """``Θ`` with ``R = rest exp(−½Θ)`` and ``|Θ| <= π``, differentiable at 0."""
    s, x, y, z = compose(reverse(rest), rotor)
    sign = jnp.where(s < 0, -1.0, 1.0)
    s, x, y, z = s * sign, x * sign, y * sign, z * sign
    log = log_even(Numeric(jnp, s.dtype), [s, *[jnp.zeros_like(s)] * 3, x, y, z, jnp.zeros_like(s)])
    return times((log[4], log[5], log[6]), -2.0)


@pytree
class Torque(Sum):
    """A sum of laws, returned by the functions of `polhode.jax.torque`: a pytree of their parameters."""

    laws: tuple[Any, ...]
    _constant = CONSTANT_TORQUE

    @property
    def depends_on_rate(self) -> bool:
        """Whether a law depends on the angular velocity."""
        return any(law.depends_on_rate for law in self.laws)

    def arguments_of(self, f: Callable[..., Three]) -> list[tuple[Any, ...]]:
        """Return the arguments of the laws with this function."""
        return [law.arguments for law in self.laws if isinstance(law, Kernel) and law.f is f]

    @property
    def turns_nothing(self) -> bool:
        """Whether L is constant in space: no laws, or wheels alone."""
        return len(self.arguments_of(wheel)) == len(self.laws)

    @property
    def holds(self) -> bool:
        """Whether a law holds the body at the origin of its axes."""
        return bool(self.arguments_of(weight))

    def in_axes(self, frame: Four) -> Torque:
        return Torque(tuple(law.in_axes(frame) for law in self.laws))

    def within(self, middle: Array) -> Torque:
        """Return the torque as it acts in a step with this middle."""
        return Torque(tuple(law.within(middle) for law in self.laws))

    def wheel(self) -> Three | None:
        """Return the total momentum of the wheels; None without one."""
        wheels = [h for (h,) in self.arguments_of(wheel)]
        return None if not wheels else tuple(sum(h) for h in zip(*wheels, strict=True))

    def damping(self) -> Array | None:
        """Return the g of damping ``−g I(Ω)``; None without damping."""
        rates = [g for (g,) in self.arguments_of(damped_momentum)]
        return sum(rates[1:], rates[0]) if rates else None

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        """Return the torque of all laws, without damping and wheels."""
        total = zero(phase)
        for law in self.laws:
            if not (isinstance(law, Kernel) and law.f in (damped_momentum, wheel)):
                total = plus(total, law.value(body, phase))
        return total

    def exerted(self, body: Gyrostat, phase: Phase) -> Three:
        """Return the torque of all laws, damping included."""
        total, g = self.value(body, phase), self.damping()
        if g is None:
            return total
        return minus(total, times(body.carried(body.omega(phase.momentum)), g))
