"""`State`: attitude, angular velocity, position and velocity of a body at a time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._algebra.coefficients import known_floats
from polhode._algebra.constructors import as_bivectors, as_vectors, bivector, vector
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor, check_rotor
from polhode._mechanics.foreign_tables import STATE
from polhode._mechanics.parameters import common
from polhode._support.arrays import Array, Shape, as_floats, batch_index, frozen
from polhode._support.calls import explains_calls_of
from polhode._support.foreign_names import ListsOwnNames, with_foreign_names

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from polhode._algebra.transform import RigidTransform

_ORIGIN = vector([0.0, 0.0, 0.0])


@with_foreign_names(STATE)
@explains_calls_of
@dataclass(frozen=True, eq=False, init=False)
class State(metaclass=ListsOwnNames):
    """State of a body at a time, or of a batch of bodies, whose shapes broadcast.

    ``a == b`` is a bool: whether the shapes and all numbers are equal. ``state[i]`` indexes the batch as in
    NumPy.

    Attributes
    ----------
    rotor
        From body axes to space axes.
    omega_body
        Angular velocity in body axes, a bivector in rad/s, or an array (..., 3) of its components
        ``(e2e3, e3e1, e1e2)``, which equal those of the axial vector.
    position, velocity
        Of the centre of mass in space, vectors in m and m/s.
    time
        Time in s, a float or an array (...): the start time of `simulate`.

    Parameters
    ----------
    rotor, omega_body, position, velocity, time
        The attributes. Position, velocity and time default to 0.
    omega_space
        Angular velocity in space axes, instead of `omega_body`.

    Examples
    --------
    A body that has turned by 90° from e1 to e2 rotates in its own plane e2e3, which in space is e3e1:

    >>> turned = ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, np.pi / 2)
    >>> state = ph.State(turned, omega_body=[1, 0, 0])
    >>> state.omega_body
    e2∧e3
    >>> bool(state.omega_space.is_close(ph.e3 ^ ph.e1))
    True

    Many bodies that start at different rates are one state:

    >>> ph.State(turned, [[1, 0, 0], [2, 0, 0], [3, 0, 0]]).shape
    (3,)
    """

    rotor: Rotor
    omega_body: Multivector
    position: Multivector
    velocity: Multivector
    time: float | Array

    def __init__(
        self,
        rotor: Rotor,
        omega_body: Multivector | ArrayLike | None = None,
        position: Multivector | ArrayLike = 0,
        velocity: Multivector | ArrayLike = 0,
        *,
        time: ArrayLike = 0.0,
        omega_space: Multivector | ArrayLike | None = None,
    ) -> None:
        check_rotor(rotor, "rotor")
        if (omega_body is None) == (omega_space is None):
            raise TypeError("give either omega_body or omega_space, the angular velocity in rad/s")
        if not isinstance(rotor._data, np.ndarray):
            rotor = Rotor._from_rows(known_floats(rotor._data, "the rotor"))
        if omega_space is not None:
            omega_body = (~rotor)(angular_velocity(omega_space))
        # A frozen dataclass does not allow assignment to attributes.
        self.__dict__.update(
            rotor=rotor,
            omega_body=angular_velocity(omega_body),
            position=_place(position, "position"),
            velocity=_place(velocity, "velocity"),
            time=_time(time),
        )

    @classmethod
    def _at_origin(cls, rotor: Rotor, omega_body: Multivector, time: Any) -> State:
        """Return a state at rest in the origin, without checking the values."""
        self = object.__new__(cls)
        # Four times faster than object.__setattr__, and a quarter faster than one update.
        values = self.__dict__
        values["rotor"] = rotor
        values["omega_body"] = omega_body
        values["position"] = values["velocity"] = _ORIGIN
        values["time"] = time if type(time) is float else _time(time)
        return self

    @classmethod
    def _of(
        cls, rotor: Rotor, omega_body: Multivector, position: Multivector, velocity: Multivector, time: float
    ) -> State:
        """Return a state without checking the values."""
        self = object.__new__(cls)
        self.__dict__.update(
            rotor=rotor, omega_body=omega_body, position=position, velocity=velocity, time=time
        )
        return self

    @property
    def shape(self) -> Shape:
        """Shape of the batch; ``()`` for one state."""
        return common(self._shapes(), "a state")

    @property
    def omega_space(self) -> Multivector:
        """Angular velocity in space axes, a bivector in rad/s."""
        return self.rotor(self.omega_body)

    @property
    def transform(self) -> RigidTransform:
        """The displacement ``y = R x ~R + x0`` from body axes to space, with x0 the position (eq. 4.1)."""
        from polhode._algebra.transform import RigidTransform

        return RigidTransform(self.rotor, self.position)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, State):
            return NotImplemented
        if self.shape != other.shape:
            return False
        names = ("rotor", "omega_body", "position", "velocity", "time")
        return all(np.all(getattr(self, name) == getattr(other, name)) for name in names)

    __hash__ = None  # type: ignore[assignment]  # equality is by value, over arrays

    def __getitem__(self, index: Any) -> State:
        shape = self.shape
        parts, rows = batch_index(index, shape)

        def picked(value: Multivector) -> Array:
            components = value.components
            return np.ascontiguousarray(np.broadcast_to(components, (*shape, components.shape[-1]))[rows])

        return State(
            Rotor._from_rows(picked(self.rotor)),
            bivector(picked(self.omega_body)),
            vector(picked(self.position)),
            vector(picked(self.velocity)),
            time=np.broadcast_to(self.time, shape)[parts],
        )

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError("a single state has no length; only batches have")
        return self.shape[0]

    def __bool__(self) -> bool:
        return True

    def __iter__(self) -> Iterator[State]:
        return (self[i] for i in range(len(self)))

    def _shapes(self) -> dict[str, Shape]:
        """Return the batch shapes, by the names used in error messages."""
        return {
            "the rotor": self.rotor.shape,
            "the angular velocity": self.omega_body.shape,
            "the position": self.position.shape,
            "the velocity": self.velocity.shape,
            "the time": np.shape(self.time),
        }


def require_single_state(state: State) -> None:
    """Raise a TypeError for anything but a state, a ValueError for a batch of them."""
    if not isinstance(state, State):
        raise TypeError(f"state must be a State, got {type(state).__name__}")
    if state.shape:
        raise ValueError(f"the state must be a single one, got batch {state.shape}")


def angular_velocity(value: Any) -> Multivector:
    """Return bivectors from bivectors, or from an array (..., 3)."""
    return bivector(as_bivectors(value, "the angular velocity"))


def _place(value: Any, name: str) -> Multivector:
    zero = not isinstance(value, Multivector) and np.ndim(value) == 0 and value == 0
    return _ORIGIN if zero else vector(as_vectors(value, name))


def _time(value: Any) -> float | Array:
    if type(value) is float:
        return value
    times = as_floats(value, "time")
    return frozen(times.copy()) if times.ndim else float(times)
