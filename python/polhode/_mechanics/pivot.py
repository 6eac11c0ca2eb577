"""Bodies held at a pivot under gravity: their axes, and the moment of the weight."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode import _native
from polhode._mechanics.bodies import Body
from polhode._mechanics.body_arrays import has, mapped_objects
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.parameters import Batch, common, numbers_of, place
from polhode._support.arrays import Array, first_index

Laws = tuple[_native.Law, ...]

# Laws that hold the body at a point: `heavy` at the origin of its axes, `gravity` at a given pivot.
HOLDING = ("gravity", "heavy")


def about_pivot(bodies: Any, laws: Laws) -> tuple[Any, Laws]:
    """Return bodies in axes whose origin is the fixed point, and the laws with `gravity` as `heavy` about it.

    `bodies` is an array of objects, each a `Body`, or an `Inertia` about the fixed point. A ValueError if
    laws hold the body at different points, if gravity was made for another body, or if c of `heavy` does not
    point along the centre of mass.
    """
    held = [law for law in laws if law.name in HOLDING]
    if not held:
        return bodies, laws
    points = [numbers_of(law.arguments[3]) if law.name == "gravity" else np.zeros(3) for law in held]
    for point in points[1:]:
        if (points[0] != point).any():
            raise ValueError(
                f"the laws hold the body at different points, {_text(points[0])} and {_text(point)} m; give "
                "all of them the same pivot (that of heavy is the origin of the body axes)"
            )
    for law in held:
        check = _check_body if law.name == "gravity" else _check_weight
        check(bodies, law)
    return _moved(bodies, points[0]), tuple(_as_heavy(law) if law.name == "gravity" else law for law in laws)


def _text(points: Array) -> str:
    return str(points.tolist() if points.ndim == 1 else f"a batch {points.shape[:-1]}")


def _moved(bodies: Any, pivot: Array) -> Any:
    """Return the bodies in parallel axes with the origin at the pivot (..., 3)."""
    if not pivot.any() or not has(Body, bodies):
        return bodies
    shape = common({"the body": bodies.shape, "the pivot": pivot.shape[:-1]}, "body and pivot")
    shifts = iter(-np.broadcast_to(pivot, (*shape, 3)).reshape(-1, 3))

    def moved(body: Any) -> Any:
        shift = next(shifts)
        return body.moved(position=shift) if isinstance(body, Body) else body

    return mapped_objects(moved, np.broadcast_to(bodies, shape))


def _as_heavy(law: _native.Law) -> _native.Law:
    moments = law.weight_moments()
    assert moments is not None
    c = Batch(moments.reshape(*law.shape, 3)) if law.shape else tuple(moments[0].tolist())
    return _native.Law("heavy", c)


def _check_body(bodies: Any, law: _native.Law) -> None:
    """Raise if gravity was made for another body."""
    mass, center = map(numbers_of, law.arguments[1:3])
    rows = np.concatenate(np.broadcast_arrays(mass, center[..., :1], center[..., 1:2], center[..., 2:]), -1)
    own = np.array([_numbers(body) for body in bodies.flat]).reshape(*bodies.shape, 4)
    common({"the body": bodies.shape, "gravity": rows.shape[:-1]}, "body and torque")
    other = ((own != rows) & ~np.isnan(own)).any(axis=-1)
    if other.any():
        index = first_index(other)
        (m, *x), (n, *y) = (np.broadcast_to(a, (*other.shape, 4))[index].tolist() for a in (rows, own))
        raise ValueError(
            f"{place(index)}gravity was made for a body of {m} kg with the centre of mass at {x} m, this "
            f"body has {n} kg at {y} m; call ph.torque.gravity with this body"
        )


def _numbers(body: Body | Inertia) -> list[float]:
    """Return mass and centre of mass; NaN for an inertia."""
    if isinstance(body, Inertia):
        return [np.nan] * 4
    return [body.mass, *body._core.center_of_mass().tolist()]


def _check_weight(bodies: Any, law: _native.Law) -> None:
    """Raise if c of `heavy` does not point along the centre of mass, where that is known."""
    if not has(Body, bodies):
        return
    c = numbers_of(law.arguments[0])
    shape = common({"the body": bodies.shape, "c": c.shape[:-1]}, "body and torque")
    if not any(isinstance(body, Body) for body in bodies.flat):
        return
    c = np.broadcast_to(c, (*shape, 3))
    first = len(shape) - bodies.ndim
    for index in np.ndindex(bodies.shape):
        body = bodies[index]
        if not isinstance(body, Body):
            continue
        # Along axes of length 1 the body meets all c.
        chosen = (slice(None) if n == 1 else i for n, i in zip(bodies.shape, index, strict=True))
        own = c[(Ellipsis, *chosen, slice(None))]
        wrong = body._core.other_weight(np.ascontiguousarray(own).reshape(-1, 3))
        if wrong is None:
            continue
        met = [int(i) for i in np.unravel_index(wrong, own.shape[:-1])] if own.ndim > 1 else []
        lead, rest = met[:first], iter(met[first:])
        where = *lead, *(next(rest) if n == 1 else i for n, i in zip(bodies.shape, index, strict=True))
        raise ValueError(
            f"{place(where)}c of heavy is {c[where].tolist()} N m, but m g (centre of mass) points along the "
            f"centre of mass, which is at {body._core.center_of_mass().tolist()} m from the fixed point; use "
            "ph.torque.gravity(body, g, pivot), or give the inertia about the fixed point instead of the body"
        )
