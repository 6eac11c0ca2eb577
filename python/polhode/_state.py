"""States of a body: attitude, rotation, place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._multivector import Multivector
from polhode._rotor import Rotor
from polhode._values import as_bivectors, as_vectors, bivector, vector

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

_ORIGIN = vector([0.0, 0.0, 0.0])


@dataclass(frozen=True, eq=False)
class State:
    """A body's state: attitude, rotation, place; or those of a batch of bodies, whose shapes broadcast.

    Attributes
    ----------
    rotor
        From body axes to space axes.
    omega_body
        Angular velocity in body axes, a bivector in rad/s; an array (..., 3) of its components
        ``(e2e3, e3e1, e1e2)``, which are those of the axial vector, is taken too.
    position, velocity
        Of the centre of mass in space, vectors in m and m/s.
    """

    rotor: Rotor
    omega_body: Multivector
    position: Multivector = 0  # type: ignore[assignment]
    velocity: Multivector = 0  # type: ignore[assignment]

    if TYPE_CHECKING:  # what is taken, beside what is kept

        def __init__(
            self,
            rotor: Rotor,
            omega_body: Multivector | ArrayLike,
            position: Multivector | ArrayLike = 0,
            velocity: Multivector | ArrayLike = 0,
        ) -> None: ...

    def __post_init__(self) -> None:
        if not isinstance(self.rotor, Rotor):
            raise TypeError(
                f"rotor must be a Rotor, got {type(self.rotor).__name__}; see Rotor.from_components"
            )
        object.__setattr__(self, "omega_body", angular_velocity(self.omega_body))
        for name in ("position", "velocity"):
            value = getattr(self, name)
            zero = not isinstance(value, Multivector) and np.ndim(value) == 0 and value == 0
            object.__setattr__(self, name, _ORIGIN if zero else vector(as_vectors(value, name)))

    @classmethod
    def _at_origin(cls, rotor: Rotor, omega_body: Multivector) -> State:
        """Return the state of values that need no check, at rest in the origin."""
        self = object.__new__(cls)
        # A frozen instance's own dictionary: four times as fast as object.__setattr__.
        self.__dict__.update(rotor=rotor, omega_body=omega_body, position=_ORIGIN, velocity=_ORIGIN)
        return self


def angular_velocity(value: Any) -> Multivector:
    """Return bivectors from bivectors, or from an array (..., 3)."""
    return bivector(as_bivectors(value, "the angular velocity"))
