"""Motions in closed form of one body or a batch: their states at any time, indexing, copies."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from polhode import _native
from polhode._algebra.coefficients import known_floats
from polhode._algebra.constructors import bivector
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor, check_rotor
from polhode._mechanics.body_arrays import objects_of
from polhode._mechanics.foreign_tables import CLOSED_FORM
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.state import State, angular_velocity
from polhode._support.arrays import Array, Shape, as_floats, batch_index
from polhode._support.foreign_names import ListsOwnNames, with_foreign_names
from polhode._support.memory import require

if TYPE_CHECKING:
    from polhode import _outputs

_STATE = 7 * 8  # bytes
_BODY = 1000  # upper bound of the bytes of a motion in a batch
_MANY = 64  # number of bodies that fills the SIMD lanes


@with_foreign_names(CLOSED_FORM)
class ClosedForm(metaclass=ListsOwnNames):
    """Motion of a body, or of a batch of bodies, in closed form."""

    _core: _native.ClosedForm
    _inertia: Any  # an Inertia, or an array of them of the batch's shape

    if TYPE_CHECKING:

        def __init__(self, inertia: Any, rotor: Rotor, omega_body: Any, *law: Any) -> None: ...

        view = _outputs.view_of

    @property
    def shape(self) -> Shape:
        """Shape of the batch of bodies; ``()`` for one."""
        return self._core.shape

    def __getitem__(self, index: Any) -> Self:
        parts, _ = batch_index(index, self.shape)
        numbers = np.arange(int(np.prod(self.shape))).reshape(self.shape)
        return self._picked(numbers[parts], self._rows())

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError("a single motion has no length; only batches have")
        return self.shape[0]

    def __iter__(self) -> Iterator[Self]:
        numbers = np.arange(len(self) * int(np.prod(self.shape[1:])))
        given = self._rows()
        return (self._picked(rows, given) for rows in numbers.reshape(self.shape))

    def _rows(self) -> tuple[Array, ...]:
        """Return rotors, angular velocities and numbers of the law, one row for each body."""
        return *self._core.starts(), self._core.parameters()

    def _picked(self, rows: Any, given: tuple[Array, ...]) -> Self:
        inertia = self._inertia if isinstance(self._inertia, Inertia) else self._inertia.ravel()[rows]
        return type(self)(inertia, *_start_and_law(*(numbers[rows] for numbers in given)))

    def _arguments(self) -> tuple[Any, ...]:
        """Return the arguments that give the same motions."""
        given = (numbers.reshape(*self.shape, numbers.shape[-1]) for numbers in self._rows())
        return self._inertia, *_start_and_law(*given)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self._arguments()

    def __repr__(self) -> str:
        if self.shape:
            return f"{type(self).__name__}(batch {self.shape})"
        inertia, rotor, omega_body, *law = self._arguments()
        numbers = "".join(f", {np.asarray(x).tolist()}" for x in law)
        return f"{type(self).__name__}({inertia!r}, rotor={rotor}, omega_body={omega_body}{numbers})"

    def _columns(self, described: dict[str, Any]) -> dict[str, Any]:
        """Return a description with the columns of a batch as arrays of its shape."""
        if not self.shape:
            return described
        return {name: np.asarray(column).reshape(self.shape) for name, column in described.items()}

    def at(self, t: Any) -> State:
        """Return the states of all bodies at all times t in s, of batch shape ``m.shape + t.shape``.

        Each has the same bits as a single motion at a single time. A ValueError for times that are not
        finite, or so large that the phase is lost to rounding (1e17 turns); a MemoryError if the states
        would not fit into memory.

        Examples
        --------
        >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
        >>> motion = ph.FreeMotion(ball, ph.Rotor.identity(), [0, 0, np.pi])
        >>> bool(motion.at(0.5).rotor(ph.e1).is_close(ph.e2))  # a quarter turn from e1 to e2
        True
        >>> motion.at(np.linspace(0, 1, 5)).shape
        (5,)
        """
        once = self._core.once(t)
        if once is not None:
            return State._at_origin(once[0], once[1], t)
        times = as_floats(t, "time")
        shape = self.shape + times.shape
        require(_STATE * math.prod(shape), f"states of batch shape {shape}")
        rotors, omegas = self._core.at(np.ravel(times))
        return State._at_origin(Rotor._from_rows(rotors.reshape(*shape, 4)), bivectors(omegas, shape), times)

    def at_each(self, t: Any) -> State:
        """Return the state of each body at its own time or times t in s.

        Times broadcast with the batch of bodies, to the batch shape of the state: bodies (N,) and times (N,)
        give (N,), one time for each body; times (T, N), or bodies (N, 1) and times (N, T), give T for each.
        Each state has the same bits as a single motion at a single time. Errors as in `at`, and a ValueError
        if the shapes do not broadcast.

        Examples
        --------
        >>> book = ph.Inertia.from_principal_moments(1, 2, 3)
        >>> bodies = ph.FreeMotion(book, ph.Rotor.identity(), [[0, 0, 1], [0, 0, 2]])
        >>> bodies.at([0, 1, 2]).shape  # each body at all times
        (2, 3)
        >>> turned = bodies.at_each([np.pi, np.pi / 2])  # each at its own
        >>> turned.rotor(ph.e1).is_close(-ph.e1)  # half a turn
        array([ True,  True])
        """
        times = as_floats(t, "time")
        try:
            shape = np.broadcast_shapes(self.shape, times.shape)
        except ValueError:
            raise ValueError(
                f"times of shape {times.shape} do not broadcast with bodies of batch shape {self.shape}; "
                "`at` evaluates every body at all times"
            ) from None
        order, each = _order(self.shape, shape)
        # The times, and a copy of the states where they are reordered.
        size = 8 + _STATE * (1 if order == tuple(range(len(shape))) else 2)
        require(size * math.prod(shape), f"states of batch shape {shape}")
        self._check_each(times, shape)
        computed = np.broadcast_to(times, shape).transpose(order)
        rotors, omegas = self._core.at_each(computed.ravel(), each)
        back = (*np.argsort(order), len(order))
        rows = np.ascontiguousarray(rotors.reshape(*computed.shape, 4).transpose(back))
        rates = np.ascontiguousarray(omegas.reshape(*computed.shape, 3).transpose(back))
        return State._at_origin(Rotor._from_rows(rows), bivectors(rates, shape), times)

    def _check_each(self, times: Array, shape: Shape) -> None:
        """Raise a ValueError unless the times are finite and within the horizons of their bodies."""
        back, ahead = self._core.horizon
        within = not math.prod(shape) or (times.min() >= -back and times.max() <= ahead)
        if within and np.isfinite(times).all():
            return
        for index in np.argwhere(~np.isfinite(times)):
            raise ValueError(f"time {times[tuple(index)]} at index {_index(index)} is not finite")
        horizons = np.broadcast_to(self._core.horizons().reshape(*self.shape, 2), (*shape, 2))
        horizons = np.where(times > 0, horizons[..., 1], horizons[..., 0])
        for index in np.argwhere(np.abs(times) > horizons):
            own = index[len(shape) - len(self.shape) :]
            body = _index(np.minimum(own, np.array(self.shape) - 1))
            time, horizon = np.broadcast_to(times, shape)[tuple(index)], horizons[tuple(index)]
            raise ValueError(
                f"at index {_index(index)}: time {time:g} s of body {body} is beyond {horizon:.1e} s, "
                "where the phase of the rotation is lost to rounding; use times closer to 0"
            )


def given(
    inertia: Any,
    rotor: Any,
    omega_body: Any,
    law: Array | None = None,
    name: str = "",
    remedy: str = "Body.inertia",
) -> tuple[tuple[Any, ...], Any]:
    """Return the arguments of the core, arrays broadcast to one batch shape, and the inertias.

    The numbers `law` (..., k) of the torque have a name for errors.
    """
    remedies = f"; see {remedy} and Inertia.from_matrix"
    inertias = objects_of(inertia, (Inertia,), "inertia must be an Inertia", remedies)
    check_rotor(rotor, "rotor")
    rows = [known_floats(rotor._data, "the rotor"), angular_velocity(omega_body)._data]
    names = ["the inertia", "the rotor", "the angular velocity"]
    if law is not None:
        rows, names = [*rows, law], [*names, name]
    shapes = [inertias.shape, *(numbers.shape[:-1] for numbers in rows)]
    if not any(shapes):
        # Broadcasting a single body would take as long as its solution.
        return ([inertias[()]], *map(np.ascontiguousarray, rows)), inertias[()]
    try:
        shape = np.broadcast_shapes(*shapes)
    except ValueError:
        listed = [f"{shape} of {name}" for shape, name in zip(shapes, names, strict=True)]
        raise ValueError(
            f"the batch shapes {', '.join(listed[:-1])} and {listed[-1]} do not broadcast together"
        ) from None
    require(_BODY * math.prod(shape), f"the motions of a batch of shape {shape}")
    one = not inertias.shape
    if not one:
        inertias = np.broadcast_to(inertias, shape)
    broadcast = (np.broadcast_to(x, (*shape, x.shape[-1])) for x in rows)
    arguments = (inertias.ravel().tolist(), *map(np.ascontiguousarray, broadcast))
    return arguments, inertias[()] if one else inertias


def bivectors(numbers: Array, shape: Shape) -> Multivector:
    """Return the bivectors of a batch shape with these components."""
    return bivector(numbers.reshape(*shape, 3), copy=False)


def _start_and_law(rotors: Array, omegas: Array, law: Array) -> tuple[Any, ...]:
    """Return rotor, angular velocity and the argument of the law, if it has one, from their components."""
    start = Rotor._from_rows(rotors), bivector(omegas)
    if not law.shape[-1]:
        return start
    return *start, law[..., 0] if law.shape[-1] == 1 else law


def _order(bodies: Shape, shape: Shape) -> tuple[Shape, int]:
    """Return the order of axes in which the states are computed, and the number of times per body.

    The core computes bodies in SIMD lanes: each body should come with all of its times, and the bodies should
    repeat only if there are many.
    """
    own = (1,) * (len(shape) - len(bodies)) + bodies
    axes = [k for k, length in enumerate(own) if length != 1]
    if not axes:
        return tuple(range(len(shape))), math.prod(shape)
    first, end = axes[0], axes[-1] + 1
    are_together = math.prod(shape[first:end]) == math.prod(bodies)
    if are_together and (math.prod(bodies) >= _MANY or math.prod(shape[:first]) == 1):
        return tuple(range(len(shape))), math.prod(shape[end:])
    times = [k for k, length in enumerate(own) if length == 1]
    return (*axes, *times), math.prod(shape[k] for k in times)


def _index(index: Any) -> Shape:
    return tuple(int(k) for k in index)
