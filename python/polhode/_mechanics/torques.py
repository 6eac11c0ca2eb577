"""Torque: a sum of torque laws, with its values, multiples and text."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.constructors import bivector
from polhode._algebra.multivector import Multivector
from polhode._mechanics.bodies import Body
from polhode._mechanics.body_arrays import bodies_of, inertia_of
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.laws import finite, shown
from polhode._mechanics.orbits import DipoleField
from polhode._mechanics.parameters import CONVERSIONS, together
from polhode._mechanics.pivot import HOLDING, about_pivot
from polhode._mechanics.registry import TORQUES
from polhode._mechanics.state import State, require_single_state
from polhode._mechanics.sums import CONSTANT_TORQUE, Sum, multiple, require_single
from polhode._support.arrays import as_float

# Laws that are not proportional to any of their arguments.
_NONLINEAR = ("gravity_gradient", "reaction_wheels")


@dataclass(frozen=True, repr=False)
class Torque(Sum):
    """A sum of torque laws, returned by the functions of `polhode.torque`.

    Laws are immutable values: equal if their arguments are equal, hashable, and picklable.

    Examples
    --------
    Laws add up; each has the value of its arguments:

    >>> law = ph.torque.heavy([0, 0, 2]) + ph.torque.damping(0.5)
    >>> law
    heavy([0.0, 0.0, 2.0]) + damping(0.5)
    >>> law.holds  # a point of the body is fixed
    True
    >>> law == ph.torque.heavy([0, 0, 2]) + ph.torque.damping(0.5)
    True

    A number times a law multiplies what it exerts; the result is a law with other arguments:

    >>> 2 * law - ph.torque.damping(0.25)
    heavy([0.0, 0.0, 4.0]) + damping(1.0) + damping(-0.25)
    """

    laws: tuple[_native.Law, ...]
    _constant = CONSTANT_TORQUE

    def _multiple(self, law: _native.Law, factor: float, done: str) -> _native.Law:
        return multiple(law, factor, _linear(law.name), done)

    def __repr__(self) -> str:
        return " + ".join(map(_text, self.laws)) or "Torque(())"

    @property
    def holds(self) -> bool:
        """Whether a law holds the body at a fixed point, as `gravity` and `heavy` do."""
        return any(law.name in HOLDING for law in self.laws)

    def at(self, inertia: Inertia | Body, state: State, t: float | None = None) -> Multivector:
        """Return the torque T in body axes at a single state and time: ``I(Ω_B') − Ω_B × I(Ω_B) = T``.

        This is the right side of handout eq. (4.21) in body axes, in N m; for a `gyrostat` it is the
        reaction of the wheel to being turned, for `reaction_wheels` their torque on a body whose inertia is
        without their moments about their axes. The inertia is about the centre of mass, or about the fixed
        point if a law holds the body; from a `Body` the right one is taken, and the mass. The time t is in s,
        by default that of the state.

        Examples
        --------
        Damping at the rate 0.5/s is ``−0.5 I(Ω_B)``:

        >>> inertia = ph.Inertia.from_principal_moments(1, 2, 3)
        >>> state = ph.State(ph.Rotor.identity(), [0, 0, 4])
        >>> ph.torque.damping(0.5).at(inertia, state)
        -6 e1∧e2
        """
        require_single(self)
        if not isinstance(inertia, Inertia | Body):
            raise TypeError(f"inertia must be an Inertia or a Body, got {type(inertia).__name__}")
        require_single_state(state)
        bodies, torque = self._about_pivot(bodies_of(inertia))
        body = inertia_of(bodies[()], self.holds)
        rotor, omega = state.rotor._data, state.omega_body._data
        time = finite(as_float(state.time if t is None else t, "t"), "t")
        center = np.concatenate([state.position.components, state.velocity.components])
        mass = inertia.mass if isinstance(inertia, Body) else math.nan
        laws = list(torque.laws)
        return bivector(_native.torque_at(laws, body._core, rotor, omega, (center, mass), time))

    def _about_pivot(self, bodies: Any) -> tuple[Any, Torque]:
        """Return the bodies in axes whose origin is the fixed point, if there is one, and the laws there."""
        bodies, laws = about_pivot(bodies, self.laws)
        return bodies, Torque(laws)


Torque.__module__ = "polhode.torque"  # its public module, which pickles and texts name


def torque_of(name: str, *values: Any) -> Torque:
    """Return the law of the registry with these values for its arguments."""
    entries = TORQUES[name].arguments
    arguments = [CONVERSIONS[x.shape](value, x.name) for x, value in zip(entries, values, strict=True)]
    return native_torque(name, *arguments, names=[x.name for x in entries])


def native_torque(name: str, *arguments: Any, names: Sequence[str] = ()) -> Torque:
    """Return a law of the core with converted arguments, whose batches are broadcast to one shape."""
    return Torque((_native.Law(name, *together(arguments, name, names)),))


def _linear(name: str) -> tuple[int, ...]:
    """Return the places of the arguments in which a law is linear: its gains, its table, else the first."""
    if name in _NONLINEAR:
        return ()
    arguments = TORQUES[name].arguments if name in TORQUES else ()
    return tuple(k for k, x in enumerate(arguments) if x.shape in ("gains", "bivectors")) or (0,)


def _text(law: _native.Law) -> str:
    if law.name == "tabulated":
        times, _, frame, kind = law.arguments
        return f"tabulated({len(times)} rows, {times[0]:.6g} s to {times[-1]:.6g} s, {frame=}, {kind=})"
    if law.name == "reaction_wheels":
        return f"reaction_wheels({len(law.arguments[0])} wheels, {len(law.arguments[6])} rows of torques)"
    if law.name == "magnetic_on_orbit":
        dipole, orbit, met = law.arguments
        field = DipoleField(met) if isinstance(met, tuple) else met
        numbers = zip(("semi_major_axis", "eccentricity", "mean_anomaly", "mu"), orbit, strict=True)
        text = ", ".join(f"{name}={x!r}" for name, x in numbers)  # also of a scene's orbit inside the Earth
        return f"{shown('magnetic', [dipole, field], {})[:-1]}, orbit=KeplerOrbit({text}))"
    if law.name == "gravity":
        g, mass, center, pivot = law.arguments
        return shown("gravity", [], {"mass": mass, "center_of_mass": center, "g": g, "pivot": pivot})
    if law.name == "formula":
        text, frame, values = law.arguments
        named = {"frame": frame} if frame != "body" else {}
        return shown("formula", [text], {**named, **dict(values)})
    if law.name == "function":
        f, center = law.arguments
        return shown("function", [f], {"center": True} if center else {})
    return shown(law.name, law.arguments, {})
