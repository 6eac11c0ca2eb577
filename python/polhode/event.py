"""Events for `polhode.simulate` to look for: moments at which a quantity of the motion passes zero.

Each is found to rounding by root finding along the motion, which is looked at every 0.2 rad that the body
turns, at every step and in its middle, and where the values hint at a short visit to the other side. A
quantity that only touches zero does not pass it, and one that is zero at the start has not passed it there.
What changes much faster than the body turns, as a formula may, can pass zero unseen: a shorter `step` sees
it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.constructors import as_point
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.laws import bivector_of, function_of, law_of_formula, number, shown, three


@dataclass(frozen=True, repr=False)
class Event:
    """What to look for; made by the functions of this module.

    Events are values: equal where their arguments are, and pickled by them.
    """

    law: _native.Event

    @property
    def name(self) -> str:
        """What it looks for, without the direction."""
        return _shown(self.law.name, self.law.arguments[2:], {})

    def __repr__(self) -> str:
        direction, terminal, *arguments = self.law.arguments
        named: dict[str, Any] = {"direction": direction} if direction else {}
        if terminal:
            named["terminal"] = terminal
        return _shown(self.law.name, arguments, named)


def angle(body: Any, space: Any, angle: float, *, direction: int = 0, terminal: bool = False) -> Event:
    """Look for the angle between a direction of the body and one of space, in rad, to be reached.

    Parameters
    ----------
    body, space
        Directions, vectors or (3,), in body axes and in space axes; their sizes are ignored.
    angle
        From 0 to π. The angle of an axis that only touches it, as at 0 and π, does not pass it.
    direction
        1: only where the axis comes nearer to `space` (the cosine rises), −1: only where it goes away, 0:
        both. Of a motion that is followed back in time from its start, as it is followed.
    terminal
        Whether the motion ends there: later output times are left out.
    """
    value = number(angle, "angle")
    if not 0 <= value <= np.pi:
        raise ValueError(f"angle is {value}; it must be from 0 to π")
    return _event("angle", direction, terminal, _direction(body, "body"), _direction(space, "space"), value)


def plane(body: Any, normal: Any, *, direction: int = 0, terminal: bool = False) -> Event:
    """Look for a direction of the body to cross the plane of space through the origin with this normal.

    `body` and `normal` are vectors or (3,); `direction` is 1 for crossings to the side of the normal; the
    rest as `angle`.
    """
    return _event("plane", direction, terminal, _direction(body, "body"), _direction(normal, "normal"))


def spin(plane: Any, rate: float = 0.0, *, direction: int = 0, terminal: bool = False) -> Event:
    """Look for the angular velocity in a plane of the body, a bivector or (3,), to pass a rate in rad/s.

    The component of ω along the plane's axis, so that ``spin(e3*e1)`` finds the flips of a T-handle about e2.
    """
    components = np.array(bivector_of(plane, "the plane"))
    return _event("spin", direction, terminal, _unit(components, "the plane"), number(rate, "rate"))


def position(normal: Any, distance: float = 0.0, *, direction: int = 0, terminal: bool = False) -> Event:
    """Look for the centre of mass to cross the plane ``x·n = distance`` of space, n the unit normal, in m."""
    along, level = _direction(normal, "normal"), number(distance, "distance")
    return _event("position", direction, terminal, along, level)


def formula(text: str, /, *, direction: int = 0, terminal: bool = False, **values: Any) -> Event:
    """Look for a formula in the handout's notation to pass zero: ``formula("x·e3 - h", h=2)``.

    The formula is read and checked at once: its value must be a scalar. The motion gives the names of
    `polhode.force.formula`: ``R``, ``t``, ``x``, ``v``, ``Ω_B``, ``Ω_S``, ``m`` and others; `values` are
    single multivectors, rotors, linear maps and numbers for other names. `direction` is 1 where the value
    rises; the rest as `angle`. A FormulaError tells what is no formula, or no scalar, and where.
    """
    return law_of_formula(lambda given: _event("formula", direction, terminal, text, given), text, values)


def function(
    f: Callable[[float, Rotor, Multivector, Multivector, Multivector], Any],
    *,
    direction: int = 0,
    terminal: bool = False,
) -> Event:
    """Look for the value of a Python function to pass zero: ``f(t, rotor, omega_body, position, velocity)``.

    It is called with the time in s, the rotor from body axes to space, the angular velocity in body axes, a
    bivector, and the position and the velocity of the centre of mass, vectors in space, and returns a number.
    What it raises, `simulate` raises. The rest as `angle`.
    """
    given = function_of(f, "t, rotor, omega_body, position and velocity")
    return _event("function", direction, terminal, given)


def _event(name: str, direction: int, terminal: bool, *arguments: Any) -> Event:
    if direction not in (-1, 0, 1):
        raise ValueError(f"direction is {direction!r}; it must be 1 (rising), -1 (falling) or 0 (both)")
    return Event(_native.Event(name, int(direction), bool(terminal), *arguments))


def _direction(value: Any, name: str) -> tuple[float, ...]:
    return _unit(np.array(three(as_point(value, name), name)), name)


def _unit(components: Any, name: str) -> tuple[float, ...]:
    size = np.linalg.norm(components)
    if not (np.isfinite(size) and size > 0):
        raise ValueError(f"{name} is {components.tolist()}; it must be finite and not zero")
    return tuple((components / size).tolist())


def _shown(name: str, arguments: Iterable[Any], named: Mapping[str, Any]) -> str:
    if name == "formula":
        text, values = arguments
        return shown(name, [text], {**named, **dict(values)})
    return shown(name, arguments, named, "g")
