"""Forces on the centre of mass for `polhode.simulate`: ``x' = v``, ``v' = F/m``, the x0 of handout eq. (4.1).

Forces add up: ``ph.force.constant([0, 0, -9.81]) + ph.force.drag(0.1)``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from polhode import _native
from polhode._arrays import Array, as_float
from polhode._values import as_point


@dataclass(frozen=True)
class Force:
    """A sum of forces; made by the functions of this module."""

    _laws: tuple[_native.Force, ...]
    _named: tuple[str, ...]
    # Body forces with the points at which they act, for their torque.
    _thrusts: tuple[tuple[tuple[float, ...], tuple[float, ...]], ...] = ()

    def __add__(self, other: Force) -> Force:
        if not isinstance(other, Force):
            return NotImplemented
        return Force(self._laws + other._laws, self._named + other._named, self._thrusts + other._thrusts)

    def __radd__(self, other: object) -> Force:
        """``0 + force``, so that ``sum(forces)`` works."""
        return self if other == 0 else NotImplemented

    def __repr__(self) -> str:
        return " + ".join(self._named)


def constant(F: Any) -> Force:
    """Return a force constant in space, a vector or (3,) in N."""
    components = _three(F, "F")
    return Force((_native.Force.constant(components),), (f"constant({components.tolist()})",))


def thrust(F: Any, at: Any = None) -> Force:
    """Return a force constant in body axes, a vector or (3,) in N, such as a thruster's.

    With `at`, the point of the body where it acts (in body axes, m), it exerts the torque ``(at − c)∧F``
    about the centre of mass c too; without, it acts at the centre of mass.
    """
    components = _three(F, "F")
    law = _native.Force.body(components)
    if at is None:
        return Force((law,), (f"thrust({components.tolist()})",))
    place = _three(at, "at")
    name = f"thrust({components.tolist()}, at={place.tolist()})"
    return Force((law,), (name,), ((tuple(components.tolist()), tuple(place.tolist())),))


def drag(k: float) -> Force:
    """Return ``−k v``, k in N s/m."""
    k = _finite(k, "k")
    return Force((_native.Force.drag(k),), (f"drag({k})",))


def quadratic_drag(k: float) -> Force:
    """Return ``−k |v| v``, k in N s²/m²."""
    k = _finite(k, "k")
    return Force((_native.Force.quadratic_drag(k),), (f"quadratic_drag({k})",))


def spring(k: float, anchor: Any = 0) -> Force:
    """Return ``−k (x − anchor)``, k in N/m, the anchor a point in space in m."""
    k, place = _finite(k, "k"), _three(anchor, "anchor")
    return Force((_native.Force.spring(k, place),), (f"spring({k}, {place.tolist()})",))


def central(mu: float) -> Force:
    """Return ``−μ m x/|x|³``: attraction by a centre at the origin of space, μ = G M in m³/s²."""
    mu = _finite(mu, "mu")
    return Force((_native.Force.central(mu),), (f"central({mu})",))


def _three(value: Any, name: str) -> Array:
    return as_point(value, f"the force's {name}")


def _finite(x: float, name: str) -> float:
    value = as_float(x, name)
    if value - value != 0:
        raise ValueError(f"{name} is {value}; it must be finite")
    return value
