"""Simulation: a body, its start, its torques and forces, to a motion at given times."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

import numpy as np

from polhode import _native
from polhode import force as forces
from polhode._algebra.coefficients import as_coefficients
from polhode._algebra.constructors import as_point, vector
from polhode._algebra.multivector import Multivector
from polhode._mechanics.bodies import Body, Inertia, bodies_of, mapped_objects
from polhode._mechanics.ensemble import Ensemble, StepLimits, check_state, shape_of, warn_of
from polhode._mechanics.state import State
from polhode._mechanics.trajectory import Trajectory
from polhode._scene.writer import Problem
from polhode._support.arrays import as_count, as_float, as_floats, output_times
from polhode.event import Event
from polhode.force import Force
from polhode.torque import Torque, constant_body, function, settled

# Bytes of the results in a block, where nobody says how long it is to be.
_BLOCK = 32 << 20

METHODS: tuple[str, ...] = ("auto", "exact", *_native.methods())


def simulate(
    body: Any,
    state: State,
    times: Any,
    torque: Torque | Callable[..., Any] | None = None,
    force: Any = None,
    method: str = "auto",
    rtol: float | None = None,
    atol: float | None = None,
    step: float | None = None,
    *,
    max_step: float | None = None,
    max_steps: float | None = None,
    breaks: Any = (),
    events: Event | Sequence[Event] = (),
    threads: int | None = None,
    progress: Callable[[int, float], object] | None = None,
) -> Trajectory:
    """Return the motion of a body at given times: exact where it is known, else by steps that keep |R|.

    Or the motions of many: bodies, states and what a torque law is given may be batches, whose shapes
    broadcast together. Each body moves as it would alone, and one that fails does not stop the others: see
    ``trajectory.failures``.

    Parameters
    ----------
    body
        A `Body` or its `Inertia` in kg m². `ph.torque.gravity` holds a body at its pivot, `ph.torque.heavy`
        at the origin of its axes; an inertia is then that about the fixed point, which is also what position
        and velocity of the state are those of. Or a nested sequence or array of them, (...).
    state
        The state at the start, ``state.time``; rotor, angular velocity, position, velocity and time may be
        batches, (...).
    times
        Output times in s, (n,), not decreasing, on the same clock as ``state.time`` and what laws call t:
        ``[60.0]`` for one, ``np.linspace(0, 60, 601)`` for a motion of 60 s. Those before the start are
        reached by going backwards.
    torque
        A law of `polhode.torque`, a sum of them, or a function as for `polhode.torque.function`; None for
        free motion. Its numbers may be batches, (...).
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
        ``kahan_li6``, ``rk4``. A batch without a `step` is ``exact`` where known, else ``dop853``, each body
        by its own steps. Where `dop853` would need steps far shorter than the motion itself, as under strong
        damping, ``"auto"`` takes ``midpoint``.
    rtol, atol
        Without a `step`, runs with ever shorter steps until the estimated error of the last is less than the
        larger of the two: in the rotor; in the angular velocity, relative to its largest size or, if that is
        larger, to the rate √(N/i) at which the torque N makes the largest moment i swing; and so for the
        centre of mass, where forces move it; at output times and events. The estimate includes the rounding
        that the motion magnifies, which is measured. Nothing is returned whose estimate exceeds the
        tolerance. With neither given the aim is 1e-10; where rounding allows only up to 1e-6, that is
        accepted and the certificate has the estimate.
    step
        A fixed step in s; shortened a little so that steps end on the output times. A law that changes too
        fast for it is reported as a `RuntimeWarning`.
    max_step
        The longest step in s. Laws that depend on time are sampled at 4096 times beforehand, and steps
        shorten where they change; a push that lasts less than 1/4096 of the run needs `max_step` or `breaks`.
    max_steps
        How many steps a pass may take; 1e8 by default, 1e10 where a `step` is given. A run that is foreseen
        to exceed it is refused.
    breaks
        Times in s, (k,), at which steps end: where a law jumps, or before and after a short push.
    events
        What to look for on the way, from `polhode.event`: one or several; found in ``trajectory.events``.
        Not for a batch.
    threads
        How many threads share the bodies of a batch; None for ``POLHODE_NUM_THREADS``, or all cores. The
        results have the same bits for any.
    progress
        Called now and then with the pass (from 1) and the fraction of it done. Ctrl-C stops the run.

    Raises
    ------
    ValueError
        For input that is not usable, a tolerance that was not reached, or too many steps; in a batch, for
        what no body could be followed with.
    MemoryError
        If the results of a batch do not fit into memory: before anything is computed.
    """
    limits = _limits(max_step, max_steps, breaks)
    given = _given(body, state, times, torque, force, method, rtol, atol, step, limits)
    check_progress(progress)
    looked_for = _events(events)
    count = checked_threads(threads)
    if given.shape:
        if looked_for:
            raise ValueError(
                f"events are looked for in the motion of one body, this is a batch of shape {given.shape}; "
                "simulate each body whose events are wanted alone"
            )
        return given.run(count, progress)
    inertia = given.inertias[()]
    motion = _native.simulate(
        inertia._core,
        float(given.start_times),
        given.rotors,
        given.omegas,
        list(given.laws),
        np.concatenate([given.places, given.velocities]),
        float(given.masses),
        list(given.forces),
        given.times,
        given.method,
        given.step,
        given.rtol,
        given.limits,
        [event.law for event in looked_for],
        progress,
    )
    bodies, law = settled(bodies_of(body), as_torque(torque))
    problem = Problem(
        bodies[()],
        state,
        law,
        None if force is None else as_force(force),
        given.times,
        given.method,
        given.step,
        given.rtol,
        given.limits,
    )
    trajectory = Trajectory._of(motion, inertia, [event.name for event in looked_for], problem)
    warn_of(trajectory.certificate)
    return trajectory


def simulate_blocks(
    body: Any,
    state: State,
    times: Any,
    torque: Torque | Callable[..., Any] | None = None,
    force: Any = None,
    method: str = "auto",
    rtol: float | None = None,
    atol: float | None = None,
    step: float | None = None,
    *,
    max_step: float | None = None,
    max_steps: float | None = None,
    breaks: Any = (),
    block: int | None = None,
    threads: int | None = None,
    progress: Callable[[int, float], object] | None = None,
) -> Iterator[tuple[slice, Trajectory]]:
    """Yield the motions of a batch in blocks, so that all together need not fit into memory.

    Each block is a slice of the first batch axis and the `Trajectory` of these bodies: the same bits as in
    ``simulate(…)[slice]``. What is wanted of a block is taken in the loop, such as `Moments`::

        spins = ph.Moments()
        for rows, motion in ph.simulate_blocks(body, state, times, torque):
            spins.add(motion.omega_body.norm())

    Parameters
    ----------
    block
        How many rows of the first axis a block has; None for some 32 MB of results.
    progress
        Called now and then with 1 and the fraction of all blocks that is done. Ctrl-C stops the run.

    The others, and the errors, are those of `simulate`: at once where arguments do not fit together, and else
    with the first block.
    """
    limits = _limits(max_step, max_steps, breaks)
    given = _given(body, state, times, torque, force, method, rtol, atol, step, limits)
    check_progress(progress)
    if not given.shape:
        raise ValueError("simulate_blocks is for a batch of bodies, this is one; use simulate")
    if block is not None and as_count(block, "block") < 1:
        raise ValueError(f"block is {block}; it must be 1 or more")
    checked_threads(threads)
    rows = given.shape[0]
    size = block or max(1, _BLOCK * rows // max(given.bytes, 1))
    return _blocks(given, [slice(i, min(i + size, rows)) for i in range(0, rows, size)], threads, progress)


def _blocks(
    given: Ensemble,
    blocks: list[slice],
    threads: int | None,
    progress: Callable[[int, float], object] | None,
) -> Iterator[tuple[slice, Trajectory]]:
    count = checked_threads(threads)
    for rows in blocks:

        def of_all(number: int, fraction: float, rows: slice = rows) -> None:
            done = rows.start + fraction * (rows.stop - rows.start)
            if progress is not None:
                progress(number, done / given.shape[0])

        yield rows, given.block(rows).run(count, of_all if progress else None)


def _given(
    body: Any,
    state: State,
    times: Any,
    torque: Any,
    force: Any,
    method: str,
    rtol: float | None,
    atol: float | None,
    step: float | None,
    limits: StepLimits,
) -> Ensemble:
    """Return what is to be simulated, checked."""
    bodies, torque = settled(bodies_of(body), as_torque(torque))
    if method not in METHODS:
        raise ValueError(f"unknown method {method!r}, expected one of {', '.join(METHODS)}")
    check_state(state)
    when = output_times(times)
    pushes, thrust = _forces(force, bodies)
    held = torque is not None and torque.holds
    if held and pushes:
        raise ValueError("gravity and heavy of ph.torque hold the body at a fixed point: no force moves it")
    if thrust is not None:
        torque = thrust if torque is None else torque + thrust
    masses = [one.mass if isinstance(one, Body) else math.nan for one in bodies.flat]
    return Ensemble(
        shape_of(bodies, state, torque.shape if torque else ()),
        mapped_objects(lambda one: _ruling_inertia(one, held), bodies),
        np.array(state.time),
        as_coefficients(state.rotor._data, "the rotor", float),
        state.omega_body._data,
        state.position._data,
        state.velocity._data,
        np.array(masses).reshape(bodies.shape),
        torque.laws if torque else (),
        tuple(pushes),
        np.ascontiguousarray(when),
        method,
        None if step is None else as_float(step, "step"),
        _tolerance(rtol, atol),
        limits,
    )


def _limits(max_step: Any, max_steps: Any, breaks: Any) -> StepLimits:
    """Return what bounds the steps, checked as far as the core does not."""
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
        raise ValueError(f"threads is {threads}; it must be 1 or more")
    return None if threads is None else min(as_count(threads, "threads"), 1024)


def as_torque(torque: Any) -> Torque | None:
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


def _ruling_inertia(body: Body | Inertia, held: bool) -> Inertia:
    """About the fixed point, the origin of the body's axes, where the body is held."""
    if isinstance(body, Inertia):
        return body
    return body.inertia_about(0) if held else body.inertia


def _forces(force: Any, bodies: Any) -> tuple[list[_native.Force], Torque | None]:
    """Return the forces, and the torque of thrusts that act beside the centre of mass."""
    if force is None:
        return [], None
    if Inertia in {*map(type, bodies.flat)}:
        raise TypeError("a force needs a Body, whose mass it moves; got an Inertia")
    law = as_force(force)
    thrusts = [law.arguments for law in law.laws if law.name == "thrust" and len(law.arguments) == 2]
    if not thrusts:
        return list(law.laws), None
    rows = [body._core.center_of_mass() for body in bodies.flat]
    centers = vector(np.array(rows).reshape(*bodies.shape, 3))
    torques = [constant_body((vector(at) - centers) ^ vector(F)) for F, at in thrusts]
    return list(law.laws), sum(torques[1:], torques[0])


def as_force(force: Any) -> Force:
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
