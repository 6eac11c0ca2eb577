"""Conversion of bodies, rotors and angular velocities to arrays of components."""

from __future__ import annotations

from typing import Any, NamedTuple

from polhode._algebra.constructors import one_grade
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.bodies import Body
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.state import State
from polhode._support.arrays import refuse_multivectors, require_components
from polhode.jax._components import Four, compose, joined, reverse, split, turned
from polhode.jax._library import Array, jnp


class Start(NamedTuple):
    """Bodies and initial states in principal axes, each of its own batch; the rotor has any norm."""

    moments: Array
    rotor: Array
    omega: Array
    frame: Four | None

    def batch(self) -> tuple[int, ...]:
        """Return the shape that all batches broadcast to."""
        shapes = [x.shape[:-1] for x in (self.moments, self.rotor, self.omega)]
        try:
            return jnp.broadcast_shapes(*shapes)  # type: ignore[no-any-return]
        except ValueError:
            raise ValueError(
                f"the batch shapes {shapes[0]} of the moments, {shapes[1]} of the rotor and {shapes[2]} of "
                "the angular velocity do not broadcast together"
            ) from None

    def in_body_axes(self, rotor: Array, omega: Array) -> tuple[Array, Array]:
        """Return states in body axes from those in principal axes."""
        if self.frame is None:
            return rotor, omega
        r, w = split(rotor), split(omega)
        turned_back: Four = compose(r, reverse(self.frame))
        return joined(turned_back), joined(turned(self.frame, w))


def start(inertia: Any, rotor: Any, omega_body: Any) -> Start:
    """Return bodies and initial states from the arguments of the functions of this package."""
    moments, frame = _body(inertia)
    r = rows(rotor, 4, "the rotor")
    w = rows(omega_body, 3, "the angular velocity", grade=2)
    dtype = jnp.result_type(moments, r, w)
    moments, r, w = (x.astype(dtype) for x in (moments, r, w))
    if frame is not None:
        frame = tuple(jnp.asarray(x, dtype) for x in frame)
        assert frame is not None
        r = joined(compose(split(r), frame))
        w = joined(turned(reverse(frame), split(w)))
    return Start(moments, r, w, frame)


def _body(inertia: Any) -> tuple[Array, Four | None]:
    """Return principal moments and the rotor from principal to body axes, None for the identity."""
    if isinstance(inertia, Body):
        raise TypeError("inertia must be principal moments or an Inertia, got a Body; write body.inertia")
    if isinstance(inertia, Inertia):
        frame = tuple(inertia.principal_frame.components.tolist())
        moments = jnp.asarray(inertia.principal_moments)
        return moments, None if frame == (1.0, 0.0, 0.0, 0.0) else frame
    return rows(inertia, 3, "inertia: principal moments, or an Inertia,"), None


def as_array(value: Any, what: str) -> Array:
    """Return an array of floats from real numbers or a rotor; a TypeError for others."""
    if isinstance(value, State):
        raise TypeError(f"{what} must not be a State; pass state.rotor and state.omega_body as two arguments")
    numbers = value._data if isinstance(value, Rotor) else value
    refuse_multivectors(numbers, what)
    try:
        array = jnp.asarray(numbers)
    except (TypeError, ValueError):
        raise TypeError(f"{what} must be real numbers, got {value!r}") from None
    if jnp.issubdtype(array.dtype, jnp.complexfloating):
        raise TypeError(f"{what} must be real numbers, got {value!r}")
    return array if jnp.issubdtype(array.dtype, jnp.floating) else array.astype(jnp.result_type(float))


def rows(value: Any, size: int, what: str, grade: int | None = None) -> Array:
    """Return an array of floats (..., size) from numbers, a rotor, or a multivector of this grade."""
    if grade is not None and isinstance(value, Multivector):
        value = one_grade(value, grade, what)._data
    array = as_array(value, what)
    require_components(array.shape, size, what)
    return array
