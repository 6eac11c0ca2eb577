"""Events for `polhode.simulate` to look for: moments at which a quantity of the motion passes a level.

Each is found to rounding by root finding along the motion. Two that are closer in time than the body needs to
turn by 0.2 rad may be missed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from polhode import _native
from polhode._arrays import as_float
from polhode._values import as_bivectors, as_point


@dataclass(frozen=True)
class Event:
    """What to look for; made by the functions of this module."""

    name: str
    _core: _native.Event


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
        both.
    terminal
        Whether the motion ends there: later output times are left out.
    """
    value = as_float(angle, "angle")
    if not 0 <= value <= np.pi:
        raise ValueError(f"angle is {value}; it must be from 0 to π")
    a, n = _direction(body, "body"), _direction(space, "space")
    # The cosine of ½π is 0, not its rounding.
    level = 0.0 if value == 0.5 * np.pi else float(np.cos(value))
    core = _native.Event.axis(a, n, level, _way(direction), bool(terminal))
    return Event(f"angle({_text(a)}, {_text(n)}, {value:g})", core)


def plane(body: Any, normal: Any, *, direction: int = 0, terminal: bool = False) -> Event:
    """Look for a direction of the body to cross the plane of space through the origin with this normal.

    `body` and `normal` are vectors or (3,); `direction` is 1 for crossings to the side of the normal; the
    rest as `angle`.
    """
    a, n = _direction(body, "body"), _direction(normal, "normal")
    core = _native.Event.axis(a, n, 0.0, _way(direction), bool(terminal))
    return Event(f"plane({_text(a)}, {_text(n)})", core)


def spin(plane: Any, rate: float = 0.0, *, direction: int = 0, terminal: bool = False) -> Event:
    """Look for the angular velocity in a plane of the body, a bivector or (3,), to pass a rate in rad/s.

    The component of ω along the plane's axis, so that ``spin(e3*e1)`` finds the flips of a T-handle about e2.
    """
    components = np.ascontiguousarray(as_bivectors(plane, "the plane"), float)
    size = np.linalg.norm(components)
    if components.shape != (3,) or not (np.isfinite(size) and size > 0):
        raise ValueError(f"the plane is {components.tolist()}; it must be a single bivector that is not zero")
    components = components / size
    level = _level(rate, "rate")
    core = _native.Event.spin(components, level, _way(direction), bool(terminal))
    return Event(f"spin({_text(components)}, {level:g})", core)


def position(normal: Any, distance: float = 0.0, *, direction: int = 0, terminal: bool = False) -> Event:
    """Look for the centre of mass to cross the plane ``x·n = distance`` of space, n the unit normal, in m."""
    n = _direction(normal, "normal")
    level = _level(distance, "distance")
    core = _native.Event.position(n, level, _way(direction), bool(terminal))
    return Event(f"position({_text(n)}, {level:g})", core)


def _direction(value: Any, name: str) -> Any:
    components = as_point(value, name)
    size = np.linalg.norm(components)
    if not (np.isfinite(size) and size > 0):
        raise ValueError(f"{name} is {components.tolist()}; it must be finite and not zero")
    return components / size


def _level(x: Any, name: str) -> float:
    value = as_float(x, name)
    if not np.isfinite(value):
        raise ValueError(f"{name} is {value}; it must be finite")
    return value


def _way(direction: int) -> int:
    if direction not in (-1, 0, 1):
        raise ValueError(f"direction is {direction!r}; it must be 1 (rising), -1 (falling) or 0 (both)")
    return int(direction)


def _text(components: Any) -> str:
    return "[" + ", ".join(f"{x:g}" for x in components) + "]"
