"""Arguments of `simulate` and `Stepper`: checks, and the ensemble of bodies that they describe."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from polhode import _native
from polhode import force as forces
from polhode._algebra.coefficients import as_coefficients
from polhode._algebra.constructors import vector
from polhode._algebra.multivector import Multivector
from polhode._mechanics.bodies import Body
from polhode._mechanics.body_arrays import bodies_of, has, inertia_of, mapped_objects
from polhode._mechanics.ensemble import Ensemble, StepLimits, check_state
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.parameters import common, numbers_of
from polhode._mechanics.state import State
from polhode._mechanics.sums import CONSTANT_TORQUE, Sum
from polhode._support.arrays import as_count, as_float, as_floats, output_times
from polhode.event import Event
from polhode.force import Force
from polhode.torque import Torque, constant_body, function

METHODS: tuple[str, ...] = ("auto", "exact", *_native.methods())


def about_fixed_point(body: Any, torque: Any) -> tuple[Any, Torque | None]:
    """Return the bodies in an object array, and the torque; both about the fixed point if there is one."""
    bodies, law = bodies_of(body), as_torque(torque)
    return (bodies, None) if law is None else law._about_pivot(bodies)


def ensemble_of(
    bodies: Any,
    state: State,
    times: Any,
    torque: Torque | None,
    force: Any,
    method: str,
    rtol: float | None,
    atol: float | None,
    step: float | None,
    limits: StepLimits,
) -> Ensemble:
    """Return the checked arguments, with one entry per body where they are batches.

    `bodies` and `torque` are those of `about_fixed_point`.
    """
    if method not in METHODS:
        raise ValueError(f"unknown method {method!r}, expected one of {', '.join(METHODS)}")
    check_state(state)
    when = output_times(times)
    pushes, thrust = _forces(force, bodies)
    held = torque is not None and torque.holds
    if held and pushes.laws:
        raise ValueError("ph.torque.gravity and heavy fix a point of the body; leave force out")
    if thrust is not None:
        torque = thrust if torque is None else torque + thrust
    shapes = {
        "the body": bodies.shape,
        **state._shapes(),
        "the torque": torque.shape if torque else (),
        "the force": pushes.shape,
    }
    masses = np.array(math.nan)
    if has(Body, bodies):
        rows = [one.mass if isinstance(one, Body) else math.nan for one in bodies.flat]
        masses = np.array(rows).reshape(bodies.shape)
        bodies = mapped_objects(lambda one: inertia_of(one, held), bodies)
    return Ensemble(
        common(shapes, "body, state, torque and force"),
        bodies,
        np.array(state.time),
        state.position._data,
        state.velocity._data,
        np.ascontiguousarray(when),
        method,
        as_coefficients(state.rotor._data, "the rotor", float),
        state.omega_body._data,
        masses,
        torque.laws if torque else (),
        pushes.laws,
        None if step is None else as_float(step, "step"),
        _tolerance(rtol, atol),
        limits,
    )


def step_limits(max_step: Any, max_steps: Any, breaks: Any) -> StepLimits:
    """Return the limits of steps, with the checks that the core does not make."""
    times = as_floats(breaks, "breaks")
    if times.ndim != 1:
        raise ValueError(f"breaks must be one-dimensional, got shape {times.shape}")
    return (
        None if max_step is None else as_float(max_step, "max_step"),
        None if max_steps is None else as_float(max_steps, "max_steps"),
        times.tolist(),
    )


def check_progress(progress: Any) -> None:
    if progress is not None and not callable(progress):
        raise TypeError(f"progress must be callable, got {type(progress).__name__}")


def checked_threads(threads: Any) -> int | None:
    if threads is not None and as_count(threads, "threads") < 1:
        raise ValueError(f"threads must be at least 1, got {threads}")
    return None if threads is None else min(as_count(threads, "threads"), 1024)


def as_torque(torque: Any) -> Torque | None:
    if torque is None or isinstance(torque, Torque):
        return torque
    # A constructor of laws, given without its arguments, is callable too.
    own = getattr(torque, "__module__", None) == function.__module__
    if callable(torque) and not own and not isinstance(torque, Multivector):
        return function(torque)
    remedy = "give a force as force=" if isinstance(torque, Force) else CONSTANT_TORQUE
    raise TypeError(
        f"torque must be a law of polhode.torque, such as heavy(c), got {type(torque).__name__}; {remedy}"
    )


def _tolerance(rtol: float | None, atol: float | None) -> float | None:
    """Return the larger of the two, which measure the same scaled difference."""
    given = {name: as_float(x, name) for name, x in (("rtol", rtol), ("atol", atol)) if x is not None}
    for name, x in given.items():
        if not 0 < x < 1:
            raise ValueError(f"{name} must be between 0 and 1, such as 1e-10, got {x}")
    return max(given.values(), default=None)


def _forces(force: Any, bodies: Any) -> tuple[Force, Torque | None]:
    """Return the forces, and the torque of thrusts that act away from the centre of mass."""
    if force is None:
        return Force(()), None
    if has(Inertia, bodies):
        raise TypeError("a force needs a Body, which has a mass, got an Inertia")
    law = as_force(force)
    common({"the body": bodies.shape, "the force": law.shape}, "body and force")
    thrusts = [law.arguments for law in law.laws if law.name == "thrust" and len(law.arguments) == 2]
    if not thrusts:
        return law, None
    rows = [body._core.center_of_mass() for body in bodies.flat]
    centers = vector(np.array(rows).reshape(*bodies.shape, 3))
    pairs = [(vector(numbers_of(F)), vector(numbers_of(at))) for F, at in thrusts]
    torques = [constant_body((at - centers) ^ F) for F, at in pairs]
    return law, sum(torques[1:], torques[0])


def as_force(force: Any) -> Force:
    if isinstance(force, Force):
        return force
    # A constructor of forces, given without its arguments, is callable too.
    if callable(force) and not isinstance(force, Multivector):
        if getattr(force, "__module__", None) == forces.__name__:
            raise TypeError(f"force must be a law of polhode.force, such as drag(k), got {force.__name__}")
        return forces.function(force)
    given = force if isinstance(force, list | tuple) else [force]
    if any(isinstance(one, Sum) for one in given):
        remedy = "add forces with +; for many bodies give arrays of parameters, such as drag([1, 2])"
        if isinstance(force, Torque):
            remedy = "give a torque as torque="
        raise TypeError(f"force must be a law of polhode.force, got {type(force).__name__}; {remedy}")
    return forces.constant(force)


def checked_events(events: Event | Sequence[Event]) -> list[Event]:
    if isinstance(events, Event):
        return [events]
    if not isinstance(events, Iterable):
        raise TypeError(f"events must be one or several events of polhode.event, got {events!r}")
    found = list(events)
    for k, event in enumerate(found):
        if not isinstance(event, Event):
            raise TypeError(
                f"events[{k}] must be an event of polhode.event, such as plane(e3, e3), got {event!r}"
                f"{'; write event.function(f) for a function f of the state' if callable(event) else ''}"
            )
    return found
