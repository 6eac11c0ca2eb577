"""Torque laws as pytrees, with their parameters as leaves for differentiation and mapping.

They compute what `crates/rigid/src/laws/torque/mod.rs` does, in the same order: the torque in principal axes,
without damping ``−g I(Ω)`` and the reaction of a wheel, which steps add. A law without a class here is
computed by its formula in the registry of laws.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from typing import Any, TypeVar, dataclass_transform

from polhode._generic.g3_smooth import log_even
from polhode._generic.numeric import Numeric
from polhode.jax._components import (
    Four,
    Three,
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
from polhode.jax._library import jax, jnp
from polhode.jax._phase import Gyrostat, Phase

Array = Any
T = TypeVar("T")


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

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        """Return the torque in principal axes."""
        raise NotImplementedError


class DependsOnRate(Law):
    """A law whose torque depends on the angular velocity."""

    @property
    def depends_on_rate(self) -> bool:
        """True."""
        return True


def zero(phase: Phase) -> Three:
    """Return a zero torque."""
    none = jnp.zeros_like(phase.momentum[0])
    return none, none, none


@pytree
class Heavy(Law):
    """``γ∧c``."""

    c: Three

    def in_axes(self, frame: Four) -> Law:
        return Heavy(turned(reverse(frame), self.c))

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        return cross(phase.vertical(), self.c)


@pytree
class ConstantBody(Law):
    """N in body axes."""

    N: Three

    def in_axes(self, frame: Four) -> Law:
        return ConstantBody(turned(reverse(frame), self.N))

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        return plus(zero(phase), self.N)


@pytree
class ConstantSpace(Law):
    """N in space."""

    N: Three

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        return turned(reverse(phase.rotor), self.N)


@pytree
class Magnetic(Law):
    """``m∧b``, b the field in the body."""

    dipole: Three
    B: Three

    def in_axes(self, frame: Four) -> Law:
        return replace(self, dipole=turned(reverse(frame), self.dipole))

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        return cross(self.dipole, turned(reverse(phase.rotor), self.B))


@pytree
class Larmor(DependsOnRate):
    """``L x b``."""

    b: Three

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        return cross(phase.momentum, turned(reverse(phase.rotor), self.b))


@pytree
class TorsionSpring(Law):
    """``−k Θ``."""

    k: Array
    rest: Four

    def in_axes(self, frame: Four) -> Law:
        return replace(self, rest=compose(self.rest, frame))

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        return times(turn_from(self.rest, phase.rotor), -self.k)


@pytree
class Control(Law):
    """``−kp Θ − kd Ω``, with gains along the body axes; `frame` is the rotor from principal to body axes."""

    kp: Three
    kd: Three
    target: Four
    frame: Four | None
    damped: bool = static()

    @property
    def depends_on_rate(self) -> bool:
        return self.damped

    def in_axes(self, frame: Four) -> Law:
        return replace(self, target=compose(self.target, frame), frame=frame)

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        pull = along(self.kp, self.frame, turn_from(self.target, phase.rotor))
        if self.damped:
            pull = plus(pull, along(self.kd, self.frame, body.omega(phase.momentum)))
        return times(pull, -1.0)


@pytree
class Damping(Law):
    """``−g I(Ω)``, which steps add."""

    g: Array

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        return zero(phase)


@pytree
class ViscousDamping(DependsOnRate):
    """``−d Ω``."""

    d: Three
    frame: Four | None

    def in_axes(self, frame: Four) -> Law:
        return replace(self, frame=frame)

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        return times(along(self.d, self.frame, body.omega(phase.momentum)), -1.0)


@pytree
class QuadraticDamping(DependsOnRate):
    """``−k |Ω| Ω``."""

    k: Array

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        omega = body.omega(phase.momentum)
        return times(omega, -self.k * length(omega))


@pytree
class Wheel(Law):
    """A wheel, a part of the body."""

    h: Three

    def in_axes(self, frame: Four) -> Law:
        return Wheel(turned(reverse(frame), self.h))

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        return zero(phase)


@pytree
class Function(DependsOnRate):
    """``f(t, rotor, omega_body)`` of arrays: a function, or a ``jax.tree_util.Partial`` with leaves."""

    f: Callable[..., Any] | None = static()
    partial: Any
    frame: Four | None

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


def along(gains: Three, frame: Four | None, b: Three) -> Three:
    """Multiply by gains along the body axes."""
    if frame is not None:
        b = turned(frame, b)
    b = b[0] * gains[0], b[1] * gains[1], b[2] * gains[2]
    return b if frame is None else turned(reverse(frame), b)


def turn_from(rest: Four, rotor: Four) -> Three:
    """``Θ`` with ``R = rest exp(−½Θ)`` and ``|Θ| <= π``, differentiable at 0."""
    s, x, y, z = compose(reverse(rest), rotor)
    sign = jnp.where(s < 0, -1.0, 1.0)
    s, x, y, z = s * sign, x * sign, y * sign, z * sign
    log = log_even(Numeric(jnp, s.dtype), [s, *[jnp.zeros_like(s)] * 3, x, y, z, jnp.zeros_like(s)])
    return times((log[4], log[5], log[6]), -2.0)


@pytree
class Torque:
    """A sum of laws, returned by the functions of `polhode.jax.torque`: a pytree of their parameters."""

    laws: tuple[Any, ...]

    def __add__(self, other: Torque) -> Torque:
        return Torque(self.laws + other.laws) if isinstance(other, Torque) else NotImplemented

    def __radd__(self, other: object) -> Torque:
        return self if other == 0 else NotImplemented

    @property
    def depends_on_rate(self) -> bool:
        """Whether a law depends on the angular velocity."""
        return any(law.depends_on_rate for law in self.laws)

    @property
    def turns_nothing(self) -> bool:
        """Whether L is constant in space: no laws, or wheels alone."""
        return all(isinstance(law, Wheel) for law in self.laws)

    @property
    def holds(self) -> bool:
        """Whether a law holds the body at the origin of its axes."""
        return any(isinstance(law, Heavy) for law in self.laws)

    def in_axes(self, frame: Four) -> Torque:
        """Return the same laws in other body axes."""
        return Torque(tuple(law.in_axes(frame) for law in self.laws))

    def wheel(self) -> Three | None:
        """Return the total momentum of the wheels; None without one."""
        wheels = [law.h for law in self.laws if isinstance(law, Wheel)]
        return None if not wheels else tuple(sum(h) for h in zip(*wheels, strict=True))

    def damping(self) -> Array | None:
        """Return the g of damping ``−g I(Ω)``; None without damping."""
        rates = [law.g for law in self.laws if isinstance(law, Damping)]
        return sum(rates[1:], rates[0]) if rates else None

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        """Return the torque of all laws, without damping and wheels."""
        total = zero(phase)
        for law in self.laws:
            if not isinstance(law, Damping | Wheel):
                total = plus(total, law.value(body, phase))
        return total

    def exerted(self, body: Gyrostat, phase: Phase) -> Three:
        """Return the torque of all laws, damping included."""
        total, g = self.value(body, phase), self.damping()
        if g is None:
            return total
        return minus(total, times(body.carried(body.omega(phase.momentum)), g))
