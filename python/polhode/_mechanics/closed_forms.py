"""Closed-form motions with torque: `LagrangeTop`, `DampedTop`, `LarmorSphere`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from polhode import _native
from polhode._algebra.constructors import as_point, bivector
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.bodies import Inertia
from polhode._mechanics.state import State
from polhode._support.arrays import Array, as_float, as_floats

if TYPE_CHECKING:
    from polhode import _outputs


class _Solution(Protocol):
    def at(self, times: Array) -> tuple[Array, Array]: ...


class ClosedForm:
    """A solution with its inertia, rotor and angular velocity at time 0, and parameter of the torque."""

    _solution: _Solution
    _given: tuple[Inertia, Rotor, Multivector, Any]

    def _solve(self, core: Any, inertia: Inertia, start: State, parameter: Any) -> None:
        self._solution = core(inertia._core, start.rotor._data, start.omega_body._data, parameter)
        self._given = inertia, start.rotor, start.omega_body, parameter

    def at(self, t: Any) -> State:
        """Return the state at time t in s; an array of times gives a state of that batch shape."""
        times = as_floats(t, "time")
        rotors, omegas = self._solution.at(np.ravel(times))
        return State(
            Rotor._from_rows(rotors.reshape(*times.shape, 4)),
            bivector(omegas.reshape(*times.shape, 3), copy=False),
            time=times,
        )

    if TYPE_CHECKING:
        view = _outputs.view_of

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self._given

    def __repr__(self) -> str:
        inertia, rotor, omega_body, torque = self._given
        if isinstance(torque, np.ndarray):
            torque = torque.tolist()
        return f"{type(self).__name__}({inertia!r}, rotor={rotor}, omega_body={omega_body}, {torque})"


class LagrangeTop(ClosedForm):
    """The heavy symmetric top, exact at any time (Klein & Sommerfeld; Whittaker §72).

    The body is fixed at the origin of its axes under gravity along −e3: ``V = c·γ``, ``γ = ~R e3 R``, the
    torque of `ph.torque.heavy`. Two principal moments are equal and ``c`` is along the axis of symmetry,
    which may be any principal axis. Both Cayley–Klein parameters of the rotor are theta functions times
    uniform phases, reduced in double-double arithmetic: the error stays at rounding level at any time up to t
    = 1e12, also near the separatrix. The rotor is continuous in time on the double cover.

    Any tilt from the vertical is resolved, down to the smallest float; near the unstable upright, a tilt θ
    and its rate have a relative error of about ``ln(8/θ)`` roundings. Transverse moments with a relative
    difference d <= 1.8e-15 count as equal, and ``c`` may be off the axis by an angle d <= 1.4e-14. This
    neglects an angle of about ``d ω t``, ω the largest rate, which grows as an unstable top falls; `simulate`
    reports it as the error estimate.

    Parameters
    ----------
    inertia
        About the fixed point, in body axes, kg m².
    rotor
        At time 0, from body axes to space.
    omega_body
        At time 0, a bivector or (3,) in rad/s.
    c
        ``m g (centre of mass)`` in body axes, a vector or (3,) in N m.

    Raises
    ------
    ValueError
        If all moments differ, one is zero, or ``c`` is off the axis; if a number is not finite; if the
        solution does not reproduce the start or conserve the energy.
    """

    _solution: _native.LagrangeTop

    def __init__(self, inertia: Inertia, rotor: Rotor, omega_body: Any, c: Any) -> None:
        start = _start(inertia, rotor, omega_body, "Body.inertia_about(pivot)")
        self._solve(_native.LagrangeTop, inertia, start, as_point(c, "c"))

    def describe(self) -> dict[str, Any]:
        """Return the regime, periods and invariants of the motion.

        The axis is the axis of symmetry, towards the centre of mass. ``regime``; ``tilt_min``, ``tilt_max``,
        its angles from the vertical in rad; ``nutation_period`` in s; ``precession_rate`` and
        ``spin_rate``, the mean rates of φ about e3 and of ψ about the axis in rad/s, ``precession_period``;
        ``modulus`` of the elliptic functions; ``energy`` in J, ``axial_momentum`` L3 and
        ``vertical_momentum`` Lz in kg m²/s; ``critical_spin = 2 √(|c| i1)/i3`` in rad/s and ``sleeps``,
        whether a top with this spin is stable upright. A period is None where the motion does not repeat.
        """
        return self._solution.describe()


class DampedTop(ClosedForm):
    """Any body with the torque ``N = −g L``, exact at any time.

    The motion is that of the free body at time ``τ = (1 − e^(−gt))/g``, with its angular velocity times
    ``e^(−gt)``; g is in 1/s, of either sign. τ is computed in double-double arithmetic. A ValueError if a
    principal moment is zero or a number is not finite.
    """

    def __init__(self, inertia: Inertia, rotor: Rotor, omega_body: Any, g: float) -> None:
        self._solve(_native.DampedTop, inertia, _start(inertia, rotor, omega_body), as_float(g, "g"))


class LarmorSphere(ClosedForm):
    """A sphere with the axial torque ``N = L x b``, exact at any time: a spin in a uniform field.

    ``b``, a vector or (3,) in rad/s, is fixed in space: ``R(t) = exp(½ I b t) exp(−½ I (ω + b) t) R(0)`` with
    the angular velocity ω in space at time 0. Both phases are reduced in double-double arithmetic, so the
    error does not grow with time. Moments with a relative difference d <= 1.8e-15 count as equal; this
    neglects an angle of about ``d |ω| t``, which `simulate` reports as the error estimate. A ValueError if
    the moments differ by more or a number is not finite.
    """

    def __init__(self, inertia: Inertia, rotor: Rotor, omega_body: Any, b: Any) -> None:
        self._solve(_native.LarmorSphere, inertia, _start(inertia, rotor, omega_body), as_point(b, "b"))


def _start(inertia: Inertia, rotor: Rotor, omega_body: Any, remedy: str = "Body.inertia") -> State:
    if not isinstance(inertia, Inertia):
        raise TypeError(f"inertia must be an Inertia, got {type(inertia).__name__}; see {remedy}")
    start = State(rotor, omega_body)
    if start.rotor.shape or start.omega_body.shape:
        shapes = (start.rotor.shape, start.omega_body.shape)
        raise ValueError(f"rotor and omega_body must be single values, got batch shapes {shapes}")
    return start
