"""Simulation: a body, its start, its torques and forces, to a motion at given times."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from polhode import _native
from polhode import force as forces
from polhode._arrays import as_float, as_floats
from polhode._bodies import Body, Inertia
from polhode._multivector import Multivector
from polhode._state import State, single
from polhode._trajectory import Certificate, Trajectory
from polhode._values import as_point, vector
from polhode.event import Event
from polhode.force import Force
from polhode.torque import Torque, constant_body, function

METHODS: tuple[str, ...] = ("auto", "exact", *_native.methods())


def simulate(
    body: Body | Inertia,
    state: State,
    times: Any,
    torque: Torque | Callable[..., Any] | None = None,
    force: Any = None,
    method: str = "auto",
    rtol: float | None = None,
    atol: float | None = None,
    step: float | None = None,
    *,
    events: Event | Sequence[Event] = (),
    progress: Callable[[int, float], object] | None = None,
) -> Trajectory:
    """Return the motion of a body at given times: exact where it is known, else by steps that keep |R|.

    Parameters
    ----------
    body
        A `Body` or its `Inertia` in kg m². With `ph.torque.heavy` a body is held at the origin of its
        axes, and an inertia is that about the fixed point.
    state
        The state at time 0.
    times
        Output times in s, (n,), not decreasing, of either sign.
    torque
        A law of `polhode.torque`, a sum of them, or a function as for `polhode.torque.function`; None for
        free motion.
    force
        What moves the centre of mass: a law of `polhode.force`, a sum of them, a vector or (3,) in N for a
        constant force in space, or a function as for `polhode.force.function`. It needs a `Body`.
    method
        ``"auto"``: ``"exact"`` where the motion has a closed form and no `step` is given (free bodies,
        symmetric ones under `heavy` along their axis, damping alone, spheres under `larmor`, and constant
        forces); for torques that depend on attitude and time, symmetric splittings, which keep the energy of
        long runs: ``rkn6`` for symmetric bodies and ``kahan_li8`` for others; for torques that depend on the
        rate of turning, and for forces, ``dop853``, a Runge–Kutta method of order 8 on the group of rotors
        that adapts its steps. Or one of these by name, or ``strang`` (order 2), ``yoshida4``, ``yoshida6``,
        ``kahan_li6``, ``rk4``.
    rtol, atol
        Without a `step`, runs with ever shorter steps until the estimated error of the last is less than the
        larger of the two: in the rotor, in the angular velocity relative to its largest size, and so for the
        centre of mass, where forces move it; at output times and events. With neither given the aim is
        1e-10; where rounding, magnified by the motion, allows only up to 1e-6, that is accepted and the
        certificate tells the estimate.
    step
        A fixed step in s; shortened a little so that steps end on the output times.
    events
        What to look for on the way, from `polhode.event`: one or several; found in ``trajectory.events``.
    progress
        Called now and then with the pass (from 1) and the fraction of it done. Ctrl-C stops the run.

    Raises
    ------
    ValueError
        For input that is not usable, or a tolerance that was not reached.
    """
    torque = _torque(torque)
    if progress is not None and not callable(progress):
        raise TypeError(f"progress must be callable, got {type(progress).__name__}")
    if method not in METHODS:
        raise ValueError(f"unknown method {method!r}, expected one of {', '.join(METHODS)}")
    start = single(state)
    mass = body.mass if isinstance(body, Body) else None
    inertia = _ruling_inertia(body, torque)
    when = np.atleast_1d(as_floats(times, "times"))
    if when.ndim != 1:
        raise ValueError(f"times must be one-dimensional, got shape {when.shape}")
    pushes, thrust = _forces(force, body)
    if _is_held(torque) and pushes:
        raise ValueError("with ph.torque.heavy the body is held at a fixed point: no force moves it")
    if thrust is not None:
        torque = thrust if torque is None else torque + thrust
    looked_for = _events(events)
    motion = _native.simulate(
        inertia._core,
        start.rotor._data,
        start.omega_body._data,
        list(torque.laws) if torque else [],
        np.concatenate([start.position.components, start.velocity.components]),
        math.nan if mass is None else mass,
        pushes,
        np.ascontiguousarray(when),
        method,
        None if step is None else as_float(step, "step"),
        _tolerance(rtol, atol),
        [event.law for event in looked_for],
        progress,
    )
    certificate = Certificate(**motion.certificate())
    return Trajectory._of(motion, inertia, certificate, [event.name for event in looked_for])


def _torque(torque: Any) -> Torque | None:
    if torque is None or isinstance(torque, Torque):
        return torque
    # A maker of laws, given without its arguments, is callable too.
    if callable(torque) and getattr(torque, "__module__", None) != function.__module__:
        return function(torque)
    raise TypeError(f"torque must be a law of polhode.torque, such as heavy(c), got {type(torque).__name__}")


def _tolerance(rtol: float | None, atol: float | None) -> float | None:
    """Both measure the same scaled difference, so the larger one rules."""
    given = {name: as_float(x, name) for name, x in (("rtol", rtol), ("atol", atol)) if x is not None}
    for name, x in given.items():
        if not (x > 0 and np.isfinite(x)):
            raise ValueError(f"{name} is {x}; it must be positive and finite")
    return max(given.values(), default=None)


def _ruling_inertia(body: Body | Inertia, torque: Torque | None) -> Inertia:
    if isinstance(body, Inertia):
        return body
    if not isinstance(body, Body):
        raise TypeError(f"body must be a Body or an Inertia, got {type(body).__name__}")
    return body.inertia_about(0) if _is_held(torque) else body.inertia


def _is_held(torque: Torque | None) -> bool:
    """Whether the body is held at a fixed point, the origin of its axes."""
    return torque is not None and torque.holds


def _forces(force: Any, body: Body | Inertia) -> tuple[list[_native.Force], Torque | None]:
    """Return the forces, and the torque of thrusts that act beside the centre of mass."""
    if force is None:
        return [], None
    if not isinstance(body, Body):
        raise TypeError("a force needs a Body, whose mass it moves; got an Inertia")
    law = _force(force)
    thrusts = [law.arguments for law in law.laws if law.name == "thrust" and len(law.arguments) == 2]
    torques = [constant_body((vector(at) - body.center_of_mass) ^ vector(F)) for F, at in thrusts]
    return list(law.laws), sum(torques[1:], torques[0]) if torques else None


def _force(force: Any) -> Force:
    if isinstance(force, Force):
        return force
    # A maker of forces, given without its arguments, is callable too.
    if callable(force) and not isinstance(force, Multivector):
        if getattr(force, "__module__", None) == forces.__name__:
            raise TypeError(f"force must be a law of polhode.force, such as drag(k), got {force.__name__}")
        return forces.function(force)
    return forces.constant(as_point(force, "the force"))


def _events(events: Event | Sequence[Event]) -> list[Event]:
    if isinstance(events, Event):
        return [events]
    if not isinstance(events, Iterable):
        raise TypeError(f"events must be made by polhode.event, one or several, got {events!r}")
    found = list(events)
    for k, event in enumerate(found):
        if not isinstance(event, Event):
            raise TypeError(
                f"events[{k}] must be made by polhode.event, such as plane(e3, e3), got {event!r}"
            )
    return found
