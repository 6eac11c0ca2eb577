"""Events for `polhode.simulate`: times at which a quantity of the motion crosses zero.

The quantity is sampled at every step and its midpoint, every 0.2 rad of rotation or of an oscillation of the
centre of mass, and where its values suggest a short excursion to the other sign; each crossing is then
located to rounding by root finding. A quantity that only touches zero does not cross it, and a zero at the
start is not a crossing. A formula that oscillates with the time itself is sampled four times in its shortest
half period, if that is longer than 1/2000 of the run. A faster one, and a Python function that changes much
faster than the body moves, can cross zero twice between samples: use a shorter `max_step`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _native
from polhode._algebra.constructors import as_bivectors, as_point
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.laws import function_of, law_of_formula, number, shown
from polhode._mechanics.parameters import check_finite
from polhode._support.arrays import power_of_two
from polhode._support.calls import explains_calls
from polhode._support.package_names import missing_law

__all__ = ["Event", "angle", "formula", "function", "plane", "position", "spin"]


@dataclass(frozen=True, repr=False)
class Event:
    """An event, returned by the functions of this module.

    Events are immutable values: equal if their arguments are equal, hashable, and picklable.

    Examples
    --------
    The motion of a ball at 1 rad/s ends after a quarter turn, where e1 crosses the plane e2e3:

    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> side = ph.event.plane(ph.e1, ph.e1, terminal=True)
    >>> side
    plane([1, 0, 0], [1, 0, 0], terminal=True)
    >>> start = ph.State(ph.Rotor.identity(), [0, 0, 1])
    >>> motion = ph.simulate(ball, start, np.arange(5.0), events=side)
    >>> motion.time, motion.events[0].time.round(6)
    (array([0., 1.]), array([1.570796]))
    """

    law: _native.Event

    @property
    def name(self) -> str:
        """Its quantity, without the direction."""
        return _shown(self.law.name, self.law.arguments[2:], {})

    def __repr__(self) -> str:
        direction, terminal, *arguments = self.law.arguments
        named: dict[str, Any] = {"direction": direction} if direction else {}
        if terminal:
            named["terminal"] = terminal
        return _shown(self.law.name, arguments, named)


# Names that are not ours, and what to write instead.
_FOREIGN = dict.fromkeys(("contact", "ground", "height"), "event.position(ph.e3, terminal=True)")


def __dir__() -> list[str]:
    return __all__


if not TYPE_CHECKING:

    def __getattr__(name: str) -> None:
        raise missing_law("event", name, _FOREIGN, "events")


@explains_calls
def angle(body: Any, space: Any, angle: float, *, direction: int = 0, terminal: bool = False) -> Event:
    """Return the event that the angle between a direction of the body and one of space is reached.

    Parameters
    ----------
    body, space
        Directions, vectors or (3,), in body axes and in space axes; their sizes are ignored.
    angle
        In rad, from 0 to π. An axis that only touches the angle, as at 0 and π, does not cross it.
    direction
        1 for crossings towards `space` (the cosine rises), −1 for crossings away from it, 0 for both. For a
        motion computed backwards from its start, in the direction of the computation.
    terminal
        Whether the motion ends there: later output times are omitted.

    Examples
    --------
    An axis that turns at 1 rad/s is 60° from its start after π/3 s, and again before it returns:

    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> start = ph.State(ph.Rotor.identity(), [0, 0, 1])
    >>> far = ph.event.angle(ph.e1, ph.e1, np.pi / 3)
    >>> ph.simulate(ball, start, [6.0], events=far).events[0].time.round(4)  # π/3, 2π − π/3
    array([1.0472, 5.236 ])
    """
    value = number(angle, "angle")
    if not 0 <= value <= np.pi:
        raise ValueError(f"angle is {value}; it must be from 0 to π")
    return _event("angle", direction, terminal, _direction(body, "body"), _direction(space, "space"), value)


@explains_calls
def plane(body: Any, normal: Any, *, direction: int = 0, terminal: bool = False) -> Event:
    """Return the event that a direction of the body crosses the plane of space with this normal.

    The plane passes through the origin; `body` and `normal` are vectors or (3,). `direction` is 1 for
    crossings to the side of the normal; the rest as for `angle`.

    Examples
    --------
    An axis that turns at π rad/s crosses the plane e2e3 each second:

    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> start = ph.State(ph.Rotor.identity(), [0, 0, np.pi])
    >>> motion = ph.simulate(ball, start, [4.0], events=ph.event.plane(ph.e1, ph.e1))
    >>> motion.events[0].time.round(9), motion.events[0].rising
    (array([0.5, 1.5, 2.5, 3.5]), array([False,  True, False,  True]))
    """
    return _event("plane", direction, terminal, _direction(body, "body"), _direction(normal, "normal"))


@explains_calls
def spin(plane: Any, rate: float = 0.0, *, direction: int = 0, terminal: bool = False) -> Event:
    """Return the event that the spin in a plane of the body, a bivector or (3,), crosses a rate in rad/s.

    The spin is the component of ω along the axis of the plane: ``spin(e3*e1)`` finds the flips of a T-handle
    about e2.

    Examples
    --------
    The flips of a T-handle, which is spun about its middle axis, follow at equal times:

    >>> handle = ph.Inertia.from_principal_moments(1.755e-4, 2.354e-4, 3.930e-4)
    >>> start = ph.State(ph.Rotor.identity(), [0.3, 10 * np.pi, 0.3])
    >>> flips = ph.simulate(handle, start, [4.0], events=ph.event.spin(ph.e3 ^ ph.e1)).events[0]
    >>> np.diff(flips.time).round(3)
    array([0.9, 0.9, 0.9])
    """
    components = as_bivectors(plane, "the plane")
    if components.shape != (3,):
        raise ValueError(f"the plane must be a single value, got shape {components.shape}")
    check_finite(components, "the plane")
    return _event("spin", direction, terminal, _unit(components, "the plane"), number(rate, "rate"))


@explains_calls
def position(normal: Any, distance: float = 0.0, *, direction: int = 0, terminal: bool = False) -> Event:
    """Return the event that the centre of mass crosses ``x·n = distance`` (m), with n the unit normal.

    Examples
    --------
    A ball that falls 5 m at 10 m/s² reaches the ground after 1 s:

    >>> ball = ph.Body.sphere(0.1, mass=1)
    >>> start = ph.State(ph.Rotor.identity(), [0, 0, 0], position=[0, 0, 5])
    >>> ground = ph.event.position(ph.e3, terminal=True)
    >>> ph.simulate(ball, start, [2.0], force=[0, 0, -10], events=ground).events[0].time.round(9)
    array([1.])
    """
    along, level = _direction(normal, "normal"), number(distance, "distance")
    return _event("position", direction, terminal, along, level)


@explains_calls
def formula(text: str, /, *, direction: int = 0, terminal: bool = False, **values: Any) -> Event:
    """Return the event that a formula in the handout's notation crosses zero: ``formula("x·e3 - h", h=2)``.

    The formula is checked at once: its value must be a scalar. The motion defines the names of
    `polhode.force.formula`: ``R``, ``t``, ``x``, ``v``, ``Ω_B``, ``Ω_S``, ``m`` and others; `values` are
    single multivectors, rotors, linear maps and numbers for other names. `direction` is 1 for rising values;
    the rest as for `angle`. A FormulaError gives the place of what is not a formula or not a scalar.

    Examples
    --------
    A ball that falls at 10 m/s² reaches 3 m/s after 0.3 s:

    >>> ball = ph.Body.sphere(0.1, mass=1)
    >>> still = ph.State(ph.Rotor.identity(), [0, 0, 0])
    >>> fast = ph.event.formula("norm(v) - limit", limit=3)
    >>> ph.simulate(ball, still, [1.0], force=[0, 0, -10], events=fast).events[0].time.round(9)
    array([0.3])
    """
    return law_of_formula(lambda given: _event("formula", direction, terminal, text, given), text, values)


@explains_calls
def function(
    f: Callable[[float, Rotor, Multivector, Multivector, Multivector], Any],
    *,
    direction: int = 0,
    terminal: bool = False,
) -> Event:
    """Return the event that a Python function ``f(t, rotor, omega_body, position, velocity)`` crosses zero.

    Its arguments are the time in s, the rotor from body axes to space, the angular velocity in body axes, a
    bivector, and the position and the velocity of the centre of mass, vectors in space; it returns a number.
    Its exceptions pass through `simulate`. The rest as for `angle`.

    Examples
    --------
    >>> def halved(t, rotor, omega_body, position, velocity):
    ...     return omega_body.norm() - 0.5
    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> start = ph.State(ph.Rotor.identity(), [0, 0, 1])
    >>> event = ph.event.function(halved)
    >>> motion = ph.simulate(ball, start, [2.0], ph.torque.damping(1), events=event)
    >>> motion.events[0].time.round(4)  # ln 2
    array([0.6931])
    """
    given = function_of(f, "t", "rotor", "omega_body", "position", "velocity")
    return _event("function", direction, terminal, given)


def _event(name: str, direction: int, terminal: bool, *arguments: Any) -> Event:
    if direction not in (-1, 0, 1):
        raise ValueError(f"direction is {direction!r}; it must be 1 (rising), -1 (falling) or 0 (both)")
    return Event(_native.Event(name, int(direction), bool(terminal), *arguments))


def _direction(value: Any, name: str) -> tuple[float, ...]:
    return _unit(as_point(value, name), name)


def _unit(components: Any, name: str) -> tuple[float, ...]:
    if not (np.isfinite(components).all() and components.any()):
        raise ValueError(f"{name} is {components.tolist()}; it must be finite and not zero")
    scaled = components / power_of_two(components, -1)
    return tuple((scaled / np.linalg.norm(scaled)).tolist())


def _shown(name: str, arguments: Iterable[Any], named: Mapping[str, Any]) -> str:
    if name == "formula":
        text, values = arguments
        return shown(name, [text], {**named, **dict(values)})
    return shown(name, arguments, named, "g")
