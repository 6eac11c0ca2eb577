"""States, and free motion in closed form."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _native
from polhode._arrays import Array, as_floats
from polhode._bodies import Inertia
from polhode._multivector import Multivector
from polhode._rotor import Rotor
from polhode._values import as_bivectors, as_vectors, bivector, vector

if TYPE_CHECKING:
    pass


@dataclass(frozen=True, eq=False)
class State:
    """A body's state: attitude, rotation, place.

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

    def __post_init__(self) -> None:
        if not isinstance(self.rotor, Rotor):
            raise TypeError(
                f"rotor must be a Rotor, got {type(self.rotor).__name__}; see Rotor.from_components"
            )
        object.__setattr__(self, "omega_body", _angular_velocity(self.omega_body))
        for name in ("position", "velocity"):
            value = getattr(self, name)
            zero = not isinstance(value, Multivector) and np.ndim(value) == 0 and value == 0
            object.__setattr__(self, name, vector(np.zeros(3) if zero else as_vectors(value, name)))


class FreeMotion:
    """The torque-free motion of any body, exact at any time.

    Jacobi's solution: the rotor is four theta series and one uniform turn about L, the angular velocity
    three elliptic functions. Their phases are reduced in twice the precision, so that the error is rounding
    at t = 1e12 as at t = 1, near the separatrix as far from it. The rotor is continuous in time on the
    double cover.
    """

    _solution = staticmethod(_native.free_motion)

    def __init__(self, inertia: Inertia, rotor: Rotor, omega_body: Any) -> None:
        if not isinstance(inertia, Inertia):
            raise TypeError(f"inertia must be an Inertia, got {type(inertia).__name__}; see Body.inertia")
        self._start = _single(State(rotor, omega_body))
        self._inertia = inertia
        self.at(0.0)

    def at(self, t: Any) -> State:
        """Return the state at time t in s; an array of times gives a state of that batch shape."""
        times = as_floats(t, "time")
        start = self._start
        rotors, omegas = self._solution(
            self._inertia._core, start.rotor._data, start.omega_body._data, np.ravel(times)
        )
        return State(
            Rotor._from_rows(rotors.reshape(*times.shape, 4)),
            bivector(omegas.reshape(*times.shape, 3), copy=False),
        )

    def describe(self) -> dict[str, Any]:
        """Say what the invariants tell: regime, modulus, energy, |L|, periods and flip time in s."""
        return describe_free(self._inertia, self._start.omega_body)


class SymmetricTop(FreeMotion):
    """The free top with two equal moments, by handout eq. (4.35).

    ``R(t) = exp(−½Ω_l t) R(0) exp(−½Ω_r t)``, ``Ω_l = L/i1``, ``Ω_r = ((i1 − i3)/i1) ω3 I e3`` with the
    symmetry axis e3 of the body, or whichever it is. A ValueError if all three moments differ. The rates are
    rounded, so the error grows with the angle turned; that of `FreeMotion` does not.
    """

    _solution = staticmethod(_native.symmetric_top)


def describe_free(inertia: Inertia, omega_body: Any) -> dict[str, Any]:
    """Say what the invariants of a free motion tell: regime, modulus, energy, |L|, periods in s."""
    if not isinstance(inertia, Inertia):
        raise TypeError(f"inertia must be an Inertia, got {type(inertia).__name__}; see Body.inertia")
    omega = _angular_velocity(omega_body)
    if omega.shape:
        raise ValueError(f"the angular velocity must be a single one, got batch shape {omega.shape}")
    return _native.describe_free(inertia._core, omega._data)


def _finite(components: Array, what: str) -> Array:
    if not np.isfinite(components).all():
        raise ValueError(f"{what} is {components.tolist()}; it must be finite")
    return components


def _angular_velocity(value: Any) -> Multivector:
    return bivector(as_bivectors(value, "the angular velocity"))


def _single(state: State) -> State:
    if not isinstance(state, State):
        raise TypeError(f"state must be a State, got {type(state).__name__}")
    shapes = (state.rotor.shape, state.omega_body.shape, state.position.shape, state.velocity.shape)
    if any(shapes):
        raise ValueError(f"the state must be a single one, got batch shapes {shapes}")
    for name in ("position", "velocity"):
        _finite(getattr(state, name).components, f"the {name}")
    _finite(state.omega_body.components, "the angular velocity")
    return state
