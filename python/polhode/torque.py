"""Torque laws for `polhode.simulate`: values that say what turns the body.

Laws add up: ``ph.torque.heavy(c) + ph.torque.damping(g)``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from polhode._arrays import Array, as_float
from polhode._values import as_bivectors, as_vectors


@dataclass(frozen=True)
class Torque:
    """A sum of laws; made by the functions of this module."""

    laws: tuple[tuple[str, tuple[float, ...]], ...]

    def __add__(self, other: Torque) -> Torque:
        if not isinstance(other, Torque):
            return NotImplemented
        return Torque(self.laws + other.laws)

    def __radd__(self, other: object) -> Torque:
        """``0 + torque``, so that ``sum(torques)`` works."""
        return self if other == 0 else NotImplemented


def heavy(c: Any) -> Torque:
    """Uniform gravity along −e3 on a body held at a fixed point, the origin of its axes.

    ``V = c·γ`` with ``γ = ~R e3 R``; ``c = m g (centre of mass)`` in body axes, a vector or (3,) in N m.
    The inertia that counts is that about the fixed point: an `Inertia` is taken as such, a `Body` is
    taken about the origin of its axes.
    """
    return Torque((("heavy", _three(as_vectors(c, "c"), "c")),))


def gravity_gradient(n: float) -> Torque:
    """Return the gradient of a planet's field on a circular orbit of rate n (rad/s) in the plane e1e2.

    With ``u = cos(nt) e1 + sin(nt) e2`` from planet to body, the axial vector of the torque is
    ``3n² u x I(u)``.
    """
    return Torque((("gravity_gradient", (as_float(n, "n"),)),))


def damping(g: float) -> Torque:
    """Return the torque ``−g L``, g in 1/s: spin dies away as ``exp(−g t)``."""
    return Torque((("damping", (as_float(g, "g"),)),))


def constant_body(N: Any) -> Torque:
    """Return a torque bivector N constant in body axes; a bivector or (3,) in N m."""
    return Torque((("constant_body", _three(as_bivectors(N, "N"), "N")),))


def constant_space(N: Any) -> Torque:
    """Return a torque bivector N constant in space; a bivector or (3,) in N m."""
    return Torque((("constant_space", _three(as_bivectors(N, "N"), "N")),))


def _three(components: Array, name: str) -> tuple[float, ...]:
    if components.shape != (3,):
        raise ValueError(f"{name} must be a single value, got shape {components.shape}")
    return tuple(components.tolist())
