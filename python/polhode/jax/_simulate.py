"""Motion by equal steps under JAX."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from polhode import torque as native
from polhode._mechanics.bodies import Body
from polhode._mechanics.body_arrays import bodies_of, inertia_of
from polhode.jax import torque as laws
from polhode.jax._arguments import Start, start
from polhode.jax._components import Four, Three, joined, normalized, split
from polhode.jax._laws import Function, Gyrostat, Phase, Torque, weight
from polhode.jax._library import Array, jax, jnp, lax
from polhode.jax._steppers import METHODS, stepper, table_of
from polhode.jax._steps import ways


def simulate(
    inertia: Any,
    rotor: Any,
    omega_body: Any,
    times: Any,
    torque: Any = None,
    method: str = "kahan_li8",
    *,
    step: float | None = None,
    steps: int | None = None,
    start_time: Any = 0.0,
) -> tuple[Array, Array]:
    """Return rotors (..., n, 4) and angular velocities in body axes (..., n, 3) at n times.

    For ``jit``, ``vmap``, ``jacfwd`` and ``grad``, with respect to moments, start, parameters of the torque,
    and with `steps` the times and the start time. It takes the steps of the methods of `polhode.simulate`,
    and agrees with them to rounding. ``grad`` stores one state per step and computes each step twice.

    Parameters
    ----------
    inertia
        Principal moments (..., 3) in kg m² about the body axes e1, e2, e3; an `Inertia`; or a `Body`, which
        moves about its centre of mass, under `heavy` about the origin of its axes, and under
        `polhode.torque.gravity` about the pivot.
    rotor
        From body axes to space at the start: a `Rotor`, or its components (..., 4), which are divided by
        their norm.
    omega_body
        Angular velocity in body axes at the start, a bivector or (..., 3), in rad/s. Batches broadcast.
    times
        Output times (n,) in s, not decreasing; those before the start are reached by
        integrating backwards.
    torque
        A law of `polhode.jax.torque`, a sum of them, a law of `polhode.torque`, or a function as for
        `polhode.jax.torque.function`; None for free motion.
    method
        A splitting, for torques that depend on attitude and time: ``"strang"`` (order 2), ``"yoshida4"``,
        ``"yoshida6"``, ``"kahan_li6"``, ``"kahan_li8"``; or the classical ``"rk4"``, for any torque.
    step, steps
        The longest step in s, shortened so that steps end at the output times; or the number of steps
        between two output times, with which the times may be traced.
    start_time
        The time of the initial state in s, on the clock of `times` and of the torque; one for all bodies.

    Raises
    ------
    ValueError
        For invalid shapes, times and methods. Values are not checked, because they may be traced: where the
        motion does not exist, as for a moment of 0, the result is NaN.
    """
    given, force = prepared(inertia, rotor, omega_body, torque, method)
    begin, both = ways(times, step, steps, force, start_time)
    # A function may close over tracers, which must not enter the compilation cache.
    closed = any(isinstance(law, Function) and law.partial is None for law in force.laws)
    targets = [(way.targets, way.counts) for way, _ in both]
    places = [np.array(way.places[::-1] if backwards else way.places, np.int32) for way, backwards in both]
    kinds = tuple((way.most, way.even) for way, _ in both)
    run = _both_ways if closed else _compiled_ways
    rotors, omegas = run(given, force, targets, places, begin, method=method, kinds=kinds)
    return rotors, omegas


def prepared(inertia: Any, rotor: Any, omega_body: Any, torque: Any, method: str) -> tuple[Start, Torque]:
    """Return bodies, initial states and torque in principal axes; raise if the method does not fit."""
    if isinstance(inertia, Body) and isinstance(torque, native.Torque):
        bodies, torque = torque._about_pivot(bodies_of(inertia))
        inertia = bodies[()]
    force = laws.of(torque)
    _check(method, force)
    if isinstance(inertia, Body):
        _check_weights(inertia, force)
    given = start(inertia_of(inertia, force.holds), rotor, omega_body)
    return given, force if given.frame is None else force.in_axes(given.frame)


def _check_weights(body: Body, torque: Torque) -> None:
    """Raise for weights that do not point along the centre of mass, unless they are traced."""
    for (c,) in torque.arguments_of(weight):
        if not any(isinstance(x, jax.core.Tracer) for x in c):
            native.heavy(np.stack(c, axis=-1))._about_pivot(bodies_of(body))


def _both_ways(
    given: Start,
    torque: Torque,
    targets: list[tuple[Array, Array]],
    places: list[Array],
    begin: Array,
    *,
    method: str,
    kinds: tuple[tuple[int, bool], ...],
) -> tuple[Array, Array]:
    """Return the states at the output times in body axes: back from the start, then forth."""
    parts = []
    for (to, counts), where, (most, even) in zip(targets, places, kinds, strict=True):
        found = simulate_principal(given, torque, to, counts, begin, method=method, most=most, even=even)
        parts.append([x[..., where, :] for x in found])
    return given.in_body_axes(*(jnp.concatenate(x, axis=-2) for x in zip(*parts, strict=True)))


_compiled_ways = jax.jit(_both_ways, static_argnames=("method", "kinds"))


def simulate_principal(
    given: Start,
    torque: Torque,
    targets: Array,
    counts: Array,
    begin: Array,
    *,
    method: str,
    most: int,
    even: bool,
) -> tuple[Array, Array]:
    """Return the states at the start and at the targets, in principal axes."""
    dtype = given.rotor.dtype
    torque = jax.tree.map(lambda x: jnp.asarray(x, dtype), torque)
    table = jnp.array(table_of(method), dtype)
    moves = stepper(method, Gyrostat.of(split(given.moments), torque.wheel()), torque, table)
    point = moves.start(*_batched(given, torque, moves.body), jnp.asarray(begin, dtype))
    fixed = moves.fixed(point)
    # Recompute the intermediate values of a step for gradients instead of storing them.
    step = jax.checkpoint(partial(moves.step, fixed), prevent_cse=False)

    def interval(point: Any, target: Any) -> Any:
        to, count = target
        begin, span = point.time, to - point.time

        def go(point: Any, i: Array) -> Any:
            after = jnp.where(i + 1 == count, to, begin + span * ((i + 1) / count).astype(dtype))
            # The difference of rounded times, so that the steps add up to the time.
            return step(point, after - point.time)._replace(time=after)

        def one(point: Any, i: Array) -> Any:
            if even:
                return go(point, i), None
            return lax.cond(i < count, go, lambda point, _: point, point, i), None

        point = lax.scan(one, point, jnp.arange(most))[0]
        return point, (moves.rotor(point), moves.omega(point))

    first = moves.rotor(point), moves.omega(point)
    rows = lax.scan(interval, point, (jnp.asarray(targets, dtype), jnp.asarray(counts)))[1]
    all_rows = jax.tree.map(lambda x, y: jnp.concatenate([x[None], y]), first, rows)
    rotors, omegas = (jnp.moveaxis(joined(x), 0, -2) for x in all_rows)
    return rotors, omegas


def _batched(given: Start, torque: Torque, body: Gyrostat) -> tuple[Four, Three]:
    """Return rotor and angular velocity, broadcast to the batch of the bodies and of the torque."""
    rotor, omega = normalized(split(given.rotor)), split(given.omega)

    def first(rotor: Four, omega: Three) -> Three:
        return torque.exerted(body, Phase(rotor, body.momentum(omega), jnp.zeros((), given.rotor.dtype)))

    shapes = [x.shape for x in jax.eval_shape(first, rotor, omega)]
    batch = jnp.broadcast_shapes(given.batch(), *shapes)
    return tuple(jnp.broadcast_to(x, batch) for x in rotor), tuple(jnp.broadcast_to(x, batch) for x in omega)


def _check(method: str, torque: Torque) -> None:
    if method not in METHODS:
        raise ValueError(f"unknown method {method!r}, expected one of {', '.join(METHODS)}")
    if method != "rk4" and torque.depends_on_rate:
        raise ValueError(
            f"{method} kicks at fixed attitude, but a torque depends on the angular velocity; use rk4"
        )
