"""Torque laws for `polhode.simulate`.

Laws add up and are multiplied by numbers: ``ph.torque.heavy(c) + 2 * ph.torque.damping(g)``. The torque is a
bivector, whose components ``(e2e3, e3e1, e1e2)`` are those of the axial vector. R is the rotor from body
axes to space, ``Ω_B`` the angular velocity in body axes.

Arguments may be batches of any shape, with a value for each of many bodies that `simulate` moves at once: an
array of numbers, or batched vectors, bivectors and rotors. Tables and Python functions are shared by all
bodies.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._algebra.constructors import as_bivectors
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.body_arrays import bodies_of, has
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.laws import function_of, law_of_formula, one_of
from polhode._mechanics.orbits import DipoleField, KeplerOrbit, dipole_field
from polhode._mechanics.parameters import named_together, numbers, numbers_of, vectors
from polhode._mechanics.registry import FRAMES, INTERPOLATIONS
from polhode._mechanics.torques import Torque, native_torque, torque_of
from polhode._mechanics.wheels import wheel_arguments
from polhode._support.arrays import as_floats
from polhode._support.calls import explains_calls
from polhode._support.package_names import missing_law

__all__ = [
    "KeplerOrbit",
    "Torque",
    "constant_body",
    "constant_space",
    "damping",
    "dipole_field",
    "formula",
    "function",
    "gravity",
    "gravity_gradient",
    "gyrostat",
    "heavy",
    "larmor",
    "magnetic",
    "pd_control",
    "quadratic_damping",
    "radiation_pressure",
    "reaction_wheels",
    "tabulated",
    "torsion_spring",
    "viscous_damping",
]


# Names that are not ours, and what to write instead.
_FOREIGN = {
    "constant": "torque.constant_body(F), or of space torque.constant_space(F)",
    **dict.fromkeys(("control", "controller", "PD", "pd", "pid"), "torque.pd_control(kp, kd)"),
    **dict.fromkeys(("drag", "friction", "viscous"), "torque.viscous_damping(d)"),
    **dict.fromkeys(("momentum_wheel", "wheel"), "torque.gyrostat(h)"),
    **dict.fromkeys(("solar_pressure", "srp"), "torque.radiation_pressure(area, offset, sun)"),
    "spring": "torque.torsion_spring(k)",
    **dict.fromkeys(("from_table", "interpolated", "table"), "torque.tabulated(times, torques)"),
    **dict.fromkeys(("thrust", "thruster"), "force.thrust(F, at=x)"),
}


def __dir__() -> list[str]:
    return __all__


if not TYPE_CHECKING:

    def __getattr__(name: str) -> None:
        raise missing_law("torque", name, _FOREIGN)


# --- fields


@explains_calls
def gravity(body: Any, g: Any = 9.81, pivot: Any = (0.0, 0.0, 0.0)) -> Torque:
    """Return the torque of uniform gravity along −e3 on a body held at a pivot.

    ``V = c·γ`` with ``γ = ~R e3 R``, torque ``γ∧c`` in body axes, ``c = m g (centre of mass − pivot)``.
    `simulate` then uses the inertia about the pivot, and the position of a state is that of the pivot: the
    centre of mass is at ``position + R (centre of mass − pivot) ~R``.

    Parameters
    ----------
    body
        A `Body`, or a nested sequence or array of them, (...).
    g
        The acceleration in m/s², (...), a number or one for each body; not a vector.
    pivot
        The fixed point in body axes, a vector or (..., 3) in m; by default the origin of these axes.

    Raises
    ------
    TypeError
        For an `Inertia`, which has no mass; see `heavy`.

    Examples
    --------
    The weight of a level bar that is held by one end exerts the torque ``m g l/2``:

    >>> bar = ph.Body.box([2, 0.1, 0.1], mass=3)
    >>> law = ph.torque.gravity(bar, g=10, pivot=[-1, 0, 0])
    >>> law.at(bar, ph.State(ph.Rotor.identity(), [0, 0, 0]))
    30 e3∧e1

    A pendulum that is let go at 90° takes 1.18034 times as long for a swing as at small angles:

    >>> bob = ph.Body.sphere(0.01, mass=1).moved(position=[0, 0, -1])
    >>> level, low = (ph.Rotor.from_plane_angle(ph.e2 ^ ph.e3, angle) for angle in (np.pi / 2, 1e-4))
    >>> starts = [ph.State(rotor, [0, 0, 0]) for rotor in (level, low)]
    >>> down, weight = ph.event.plane(ph.e3, ph.e2), ph.torque.gravity(bob)
    >>> swings = [ph.simulate(bob, start, [5.0], weight, events=down) for start in starts]
    >>> slow, fast = (np.diff(swing.events[0].time)[0] for swing in swings)
    >>> print(f"{slow / fast:.5f}")
    1.18034
    """
    acceleration = numbers(g, "g")
    values = numbers_of(acceleration)
    # Of three bodies with these values, two would have no weight.
    if values.shape == (3, 1) and np.count_nonzero(values) == 1:
        raise ValueError(f"g must be a number, as gravity acts along −e3, got the vector {g}; write g=9.81")
    bodies = bodies_of(body)
    if has(Inertia, bodies):
        raise TypeError("gravity needs a Body, which has a mass, got an Inertia; see ph.torque.heavy(c)")
    masses = np.array([one.mass for one in bodies.flat]).reshape(bodies.shape)
    centers = np.array([one._core.center_of_mass() for one in bodies.flat]).reshape(*bodies.shape, 3)
    return native_torque(
        "gravity",
        acceleration,
        numbers(masses, "the mass"),
        vectors(centers, "the centre of mass"),
        vectors(pivot, "the pivot"),
    )


@explains_calls
def heavy(c: Any) -> Torque:
    """Return the torque of uniform gravity along −e3 on a body held at the origin of its axes.

    ``V = c·γ`` with ``γ = ~R e3 R``, torque ``γ∧c`` in body axes; ``c = m g (centre of mass)`` in body
    axes, a vector, (3,) or (..., 3) in N m. The motion follows from the inertia about the fixed point: an
    `Inertia` is used as it is, that of a `Body` is taken about the origin of its axes, and `simulate` raises
    if its centre of mass does not lie along c. `gravity` finds both from a body.

    Examples
    --------
    The axis of a fast gyroscope goes round the vertical at about ``c/L3``, here 3/200 rad/s:

    >>> inertia = ph.Inertia.from_principal_moments(2, 2, 1)
    >>> tilted = ph.State(ph.Rotor.from_plane_angle(ph.e2 ^ ph.e3, 1.0), [0, 0, 200])
    >>> motion = ph.simulate(inertia, tilted, np.linspace(0, 10, 101), ph.torque.heavy([0, 0, 3]))
    >>> x, y, _ = motion.rotor(ph.e3).components.T
    >>> turn = np.unwrap(np.arctan2(y, x))
    >>> print(f"{(turn[-1] - turn[0]) / 10:.3f}")
    0.015
    """
    return torque_of("heavy", c)


@explains_calls
def gravity_gradient(rate: Any, eccentricity: Any = 0.0, mean_anomaly: Any = 0.0) -> Torque:
    """Return the torque of a planet's gravity gradient on a Kepler orbit in the plane e1e2 of space.

    With u the direction from planet to body, ``u = cos f e1 + sin f e2``, the axial vector of the torque is
    ``3n² (a/r)³ u x I(u)``, ``a/r = (1 + e cos f)/(1 − e²)``. The true anomaly f follows from the mean
    anomaly ``M = n t + M0`` by Kepler's equation ``M = E − e sin E``, solved to rounding; the product
    ``n t`` is kept in double-double precision, so that no digits are lost after many orbits. The orbit is
    given: it does not follow a position that forces change.

    Parameters
    ----------
    rate
        The mean motion n in rad/s; or a `KeplerOrbit`, without the other arguments.
    eccentricity
        e, at least 0 and below 1.
    mean_anomaly
        M0 in rad, that at time 0; the periapsis lies on e1.

    Examples
    --------
    A thin rod that points to the planet swings √3 times an orbit; half a swing takes ``π/(√3 n)``:

    >>> rod = ph.Inertia.from_principal_moments(1e-6, 1, 1)
    >>> start = ph.State(ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, 1e-4), [0, 0, 1])
    >>> down = ph.event.formula("(~R (cos(t) e1 + sin(t) e2) R)·e2")
    >>> swing = ph.simulate(rod, start, [10.0], ph.torque.gravity_gradient(1.0), events=down)
    >>> np.diff(swing.events[0].time).round(2)  # π/√3 = 1.81
    array([1.81, 1.81, 1.81, 1.81, 1.81])
    """
    if isinstance(rate, KeplerOrbit):
        if np.any(eccentricity) or np.any(mean_anomaly):
            raise TypeError("an orbit has its own eccentricity and mean anomaly; leave these arguments out")
        rate, eccentricity, mean_anomaly = rate.rate, rate.eccentricity, rate.mean_anomaly
    return torque_of("gravity_gradient", rate, eccentricity, mean_anomaly)


@explains_calls
def magnetic(dipole: Any, field: Any, orbit: KeplerOrbit | None = None) -> Torque:
    """Return the torque on a dipole of the body in a magnetic field, constant in space or along an orbit.

    ``V = −m·(~R B R)``, with the axial torque ``m x ~R B R`` in body axes.

    Parameters
    ----------
    dipole
        m, a vector or (..., 3) in body axes in A m²; along an orbit a single one.
    field
        B, a vector or (..., 3) in space in T; with an orbit `dipole_field`, or a function ``f(t, position)``
        of the time in s and of the position relative to the planet, a vector in m, that returns B.
    orbit
        The `KeplerOrbit` along which the field is met. The energy of a motion is then without V, which
        depends on time.

    Examples
    --------
    A dipole along e1 is turned towards the field along e3, that is in the plane ``e1∧e3 = −e3∧e1``:

    >>> inertia = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> state = ph.State(ph.Rotor.identity(), [0, 0, 0])
    >>> ph.torque.magnetic([0.2, 0, 0], [0, 0, 50e-6]).at(inertia, state)
    -1e-05 e3∧e1
    """
    if orbit is None:
        if callable(field) and not isinstance(field, Multivector):
            raise TypeError(
                "a field that is a function needs an orbit; give orbit=ph.torque.KeplerOrbit(...)"
            )
        return torque_of("magnetic", dipole, field)
    if not isinstance(orbit, KeplerOrbit):
        raise TypeError(f"orbit must be a KeplerOrbit, got {type(orbit).__name__}")
    own = vectors(dipole, "dipole")
    if not isinstance(own, tuple):
        raise ValueError(f"along an orbit the dipole must be a single vector, got batch shape {own.shape}")
    met = field.moment if isinstance(field, DipoleField) else function_of(field, "t", "position")
    return native_torque("magnetic_on_orbit", own, orbit._numbers, met)


@explains_calls
def larmor(b: Any) -> Torque:
    """Return the torque with the axial vector ``L x b`` in space; b is a vector, (3,) or (..., 3), in rad/s.

    L is the angular momentum in space, that of a `gyrostat` included; it turns about b at the rate ``−|b|``.

    Examples
    --------
    The angular momentum turns backwards about b, at 1 rad/s where ``|b|`` is 1 rad/s:

    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> start = ph.State(ph.Rotor.identity(), [1, 0, 0])
    >>> motion = ph.simulate(ball, start, [1.0], ph.torque.larmor([0, 0, 1]))
    >>> motion.momentum_space[-1].components[:2].round(4)  # cos 1, −sin 1
    array([ 0.5403, -0.8415])
    """
    return torque_of("larmor", b)


@explains_calls
def radiation_pressure(
    area: Any, offset: Any, sun: Any, coefficient: Any = 1.0, pressure: Any = 4.56e-6
) -> Torque:
    """Return the torque of sunlight on a sphere whose centre is not the centre of mass.

    The "cannonball" model: with s the unit vector to the Sun, light exerts the force ``F = −C P A s`` at the
    centre of pressure c at any attitude. The torque in body axes is ``c∧(~R F R)``, its potential
    ``V = −c·(~R F R)`` (Montenbruck & Gill, Satellite Orbits, sec. 3.4). For plates write a `formula`.

    Parameters
    ----------
    area
        The cross-section A in m², (...), not negative.
    offset
        The centre of pressure c from the centre of mass, a vector or (..., 3) in body axes in m.
    sun
        The direction to the Sun, a vector or (..., 3) in space; its size is ignored.
    coefficient
        The radiation pressure coefficient C, (...): 1 if all light is absorbed.
    pressure
        The pressure P of sunlight in N/m², (...); by default that at 1 au.

    Examples
    --------
    Light from e1 on 20 m², whose centre is 0.5 m from the centre of mass along e3, turns e3 away:

    >>> law = ph.torque.radiation_pressure(20, offset=[0, 0, 0.5], sun=[1, 0, 0])
    >>> inertia = ph.Inertia.from_principal_moments(10, 10, 10)
    >>> law.at(inertia, ph.State(ph.Rotor.identity(), [0, 0, 0]))
    -4.56e-05 e3∧e1
    """
    return torque_of("radiation_pressure", area, offset, sun, coefficient, pressure)


# --- springs, dampers, control


@explains_calls
def damping(g: Any) -> Torque:
    """Return the torque ``−g I(Ω_B)``, g in 1/s, (...): alone, it lets the spin decay as ``exp(−g t)``.

    A negative g drives the body: the spin grows. Rotation about all axes is damped alike; `viscous_damping`
    has a gain for each body axis. Three numbers are those of three bodies.

    Examples
    --------
    >>> inertia = ph.Inertia.from_principal_moments(1, 2, 3)
    >>> start = ph.State(ph.Rotor.identity(), [0, 0, 1])
    >>> motion = ph.simulate(inertia, start, [0, 1, 2], ph.torque.damping(0.5))
    >>> motion.omega_body["e12"].round(4)  # exp(-0.5 t)
    array([1.    , 0.6065, 0.3679])
    """
    return torque_of("damping", g)


@explains_calls
def viscous_damping(d: Any) -> Torque:
    """Return the torque ``−d Ω_B``, d >= 0 in N m s: a number, or three gains along the body axes.

    Three numbers ``[a, b, c]`` are the gains of a single body. A batch of gains is (..., 3), one of numbers
    (..., 1): for three bodies with a number each write ``[[a], [b], [c]]``, or ``d[:, None]`` of an array.

    Examples
    --------
    The rate about an axis decays as ``exp(−d t/i)``:

    >>> ball = ph.Inertia.from_principal_moments(2, 2, 2)
    >>> start = ph.State(ph.Rotor.identity(), [0, 0, 1])
    >>> motion = ph.simulate(ball, start, [0, 1, 2], ph.torque.viscous_damping(1))
    >>> motion.omega_body["e12"].round(4)  # exp(-t/2)
    array([1.    , 0.6065, 0.3679])
    """
    return torque_of("viscous_damping", d)


@explains_calls
def quadratic_damping(k: Any) -> Torque:
    """Return the torque ``−k |Ω_B| Ω_B``, as for fast rotation in air; k >= 0 in N m s².

    Examples
    --------
    The rate decays as ``1/(1 + k t/i)`` from 1 rad/s on:

    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> start = ph.State(ph.Rotor.identity(), [0, 0, 1])
    >>> motion = ph.simulate(ball, start, [0, 1, 3], ph.torque.quadratic_damping(1))
    >>> motion.omega_body["e12"].round(6)
    array([1.  , 0.5 , 0.25])
    """
    return torque_of("quadratic_damping", k)


@explains_calls
def torsion_spring(stiffness: Any, rest: Rotor | None = None) -> Torque:
    """Return the torque ``−k Θ`` of ``V = ½ k |Θ|²``, with Θ the rotation from the rest attitude.

    ``R = rest exp(−½Θ)``, ``|Θ| <= π``: R and −R are the same attitude, and the shorter rotation counts. At
    ``|Θ| = π`` both directions are equally short: the torque is discontinuous there, V is continuous.

    Parameters
    ----------
    stiffness
        k in N m per rad; a negative one turns the body away from the rest attitude.
    rest
        The attitude without torque, a rotor from body axes to space, or a batch; None for the identity.

    Examples
    --------
    A ball on a spring swings with the period ``2π √(i/k)``; after half of it, it is on the other side:

    >>> ball = ph.Inertia.from_principal_moments(4, 4, 4)
    >>> start = ph.State(ph.Rotor.from_rotation_vector([0, 0, 0.3]), [0, 0, 0])
    >>> swing = ph.simulate(ball, start, [2 * np.pi], ph.torque.torsion_spring(1))
    >>> round(float(swing.rotor[-1].to_rotation_vector()[2]), 6)
    -0.3
    """
    return torque_of("torsion_spring", stiffness, rest)


@explains_calls
def pd_control(kp: Any, kd: Any, target: Rotor | None = None) -> Torque:
    """Return the torque ``−kp Θ − kd Ω_B`` of a controller that brings the body to rest at an attitude.

    ``R = target exp(−½Θ)``, ``|Θ| <= π``, as for `torsion_spring`.

    Parameters
    ----------
    kp, kd
        Gains >= 0 in N m per rad and in N m s: numbers, or three along the body axes, as for
        `viscous_damping`.
    target
        The attitude to reach, a rotor from body axes to space, or a batch; None for the identity.

    Examples
    --------
    With ``kd = 2 √(kp i)`` the angle decays as ``(1 + ω t) exp(−ω t)``, without a swing:

    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> start = ph.State(ph.Rotor.from_rotation_vector([0, 0, 1]), [0, 0, 0])
    >>> motion = ph.simulate(ball, start, [0, 1, 5], ph.torque.pd_control(kp=1, kd=2))
    >>> motion.rotor.to_rotation_vector()[:, 2].round(4)
    array([1.    , 0.7358, 0.0404])
    """
    return torque_of("pd_control", kp, kd, target)


@explains_calls
def gyrostat(h: Any) -> Torque:
    """Return a wheel in the body that spins at a constant rate.

    Its momentum h relative to the body is a bivector, (3,) or (..., 3), in body axes in kg m²/s; the inertia
    of the body includes the wheel. The total momentum is ``L = R (I(Ω_B) + h) ~R``. No external torque acts,
    but the wheel resists being turned.

    Examples
    --------
    Rotation about the middle axis is unstable, and a wheel along this axis stabilises it:

    >>> book = ph.Inertia.from_principal_moments(1, 2, 3)
    >>> start = ph.State(ph.Rotor.identity(), [1e-3, 1, 1e-3])
    >>> for wheel in ([0, 0, 0], [0, 5, 0]):
    ...     motion = ph.simulate(book, start, np.linspace(0, 50, 501), ph.torque.gyrostat(wheel))
    ...     print(f"{motion.omega_body['e31'].min():.2f} rad/s")
    -1.00 rad/s
    1.00 rad/s
    """
    return torque_of("gyrostat", h)


@explains_calls
def reaction_wheels(
    axes: Any,
    inertias: Any,
    torques: Any = 0.0,
    *,
    times: Any = None,
    speeds: Any = 0.0,
    omega_body: Any = None,
    max_torque: Any = np.inf,
    max_speed: Any = np.inf,
) -> Torque:
    """Return the reaction of k wheels with motors, whose axes are fixed in the body.

    A motor that accelerates its wheel with the torque u turns the body by −u about the axis. With the moment
    J of a wheel about its axis a and its speed Ω relative to the body, its momentum ``H = J (Ω + a·ω)`` about
    its axis changes as ``H' = u``. The inertia of the body includes the wheels, as for `gyrostat`; the
    momentum of all is ``L = R ((I − Σ J a aᵀ) ω + Σ H a) ~R``. Motions have the speeds as
    ``trajectory.wheel_speed``.

    The torques depend on time alone, so that H is piecewise linear in time and exact, also where a motor
    or a wheel reaches its limit. ``dop853``, the method by default, carries L: without other torques L is
    constant to rounding. For ``rk4`` and ``midpoint`` it is as accurate as the method. `Stepper` takes
    commands at each step, for torques that depend on the state.

    Parameters
    ----------
    axes
        The axes in body axes, vectors or (k, 3); their size is ignored.
    inertias
        J in kg m², (k,), or one for all.
    torques
        The commanded torques u in N m: (k,), or one for all, for ever; or with `times` rows (n, k), held from
        each time to the next, the last for ever. Before the first time the motors are off.
    times
        In s, (n,), increasing; by default the time 0.
    speeds, omega_body
        The speeds Ω in rad/s, (k,), or one for all, at the first time, and the angular velocity of the body
        to which they are relative, a bivector or (3,); by default that of a body at rest.
    max_torque
        The largest torque of each motor in N m, (k,), or one for all: a command beyond it is cut.
    max_speed
        The largest speed in space ``|Ω + a·ω|`` in rad/s, (k,), or one for all: a motor exerts no torque
        beyond it. The speed relative to the body differs from it by the rate of the body about the axis.

    Raises
    ------
    ValueError
        For invalid numbers, and in `simulate` for wheels with larger moments than the body, and together with
        `damping`, `larmor` and formulas of L or ``I(…)``.

    Examples
    --------
    A motor that drives its wheel with 0.1 N m for 10 s turns the body the other way:

    >>> wheel = ph.torque.reaction_wheels([[0, 0, 1]], inertias=0.01, torques=0.1)
    >>> satellite = ph.Inertia.from_principal_moments(2, 2, 2)
    >>> motion = ph.simulate(satellite, ph.State(ph.Rotor.identity(), [0, 0, 0]), [10.0], wheel)
    >>> round(float(motion.omega_body[-1]["e12"]), 4)  # −1 N m s over 1.99 kg m²
    -0.5025
    >>> motion.wheel_momentum[-1].round(9)
    array([1.])
    """
    given = wheel_arguments(axes, inertias, torques, times, speeds, omega_body, max_torque, max_speed)
    return native_torque("reaction_wheels", *given)


# --- given values


@explains_calls
def constant_body(N: Any) -> Torque:
    """Return a torque N that is constant in body axes, a bivector, (3,) or (..., 3) in N m.

    Examples
    --------
    A torque of 2 N m spins a moment of 4 kg m² up at 0.5 rad/s²:

    >>> ball = ph.Inertia.from_principal_moments(4, 4, 4)
    >>> still = ph.State(ph.Rotor.identity(), [0, 0, 0])
    >>> motion = ph.simulate(ball, still, [0, 1, 2], ph.torque.constant_body([0, 0, 2]))
    >>> motion.omega_body["e12"].round(9)
    array([0. , 0.5, 1. ])
    """
    return torque_of("constant_body", N)


@explains_calls
def constant_space(N: Any) -> Torque:
    """Return a torque N that is constant in space axes, a bivector, (3,) or (..., 3) in N m.

    Examples
    --------
    The angular momentum in space grows by N t, however the body turns:

    >>> book = ph.Inertia.from_principal_moments(1, 2, 3)
    >>> start = ph.State(ph.Rotor.identity(), [0, 0, 1])
    >>> motion = ph.simulate(book, start, [0, 1, 2], ph.torque.constant_space([0.5, 0, 0]))
    >>> motion.momentum_space["e23"].round(9)
    array([0. , 0.5, 1. ])
    """
    return torque_of("constant_space", N)


@explains_calls
def tabulated(times: Any, torques: Any, frame: str = "body", kind: str = "linear") -> Torque:
    """Return a torque interpolated in a table of times.

    Parameters
    ----------
    times
        In s, (n,), increasing, at least two. A motion that leaves the range from the first to the last
        raises.
    torques
        Bivectors of batch (n,), or (n, 3), in N m.
    frame
        The axes of their components, ``"body"`` or ``"space"``.
    kind
        As in SciPy's ``interp1d``: ``"linear"``; ``"cubic"`` for the cubic spline with "not a knot" ends,
        which is a parabola for three rows; or ``"previous"``, held from each time to the next, as a computer
        that controls a satellite does. Then the torque jumps at the times, the steps of a run end there, and
        the last row only ends the table.

    Examples
    --------
    A thruster that fires from 1 s to 2 s:

    >>> law = ph.torque.tabulated([0, 1, 2, 3], [[0, 0, x] for x in (0, 4, 0, 0)], kind="previous")
    >>> ball = ph.Inertia.from_principal_moments(4, 4, 4)
    >>> motion = ph.simulate(ball, ph.State(ph.Rotor.identity(), [0, 0, 0]), [0, 1, 1.5, 2, 3], law)
    >>> motion.omega_body["e12"].round(9)
    array([0. , 0. , 0.5, 1. , 1. ])
    """
    when, rows = as_floats(times, "times"), as_bivectors(torques, "torques")
    if when.ndim != 1 or rows.shape != (when.size, 3):
        raise ValueError(
            f"times of shape (n,) need torques of shape (n, 3), got shapes {when.shape} and {rows.shape}"
        )
    table = tuple(when.tolist()), tuple(map(tuple, rows.tolist()))
    return native_torque(
        "tabulated", *table, one_of(FRAMES, frame, "frame"), one_of(INTERPOLATIONS, kind, "kind")
    )


@explains_calls
def formula(text: str, /, *, frame: str = "body", **values: Any) -> Torque:
    """Return the torque of a formula in the handout's notation: ``formula("-c ∧ (~R e3 R)", c=c)``.

    The formula is checked at once: its value must be a bivector. An axial vector v is the bivector ``I v``.
    The motion defines

    - ``R``, the rotor from body axes to space, and ``t``, the time in s,
    - ``Ω_B`` and ``Ω_S`` (or ``Omega_B``, ``Omega_S``), the angular velocity in body axes and in space,
      bivectors in rad/s; ``Ω`` is that in the axes of `frame`,
    - ``L`` and ``L_B``, the angular momentum in space and in body axes, bivectors in kg m²/s, that of a
      `gyrostat` included,
    - ``I(…)``, the inertia map of the body on bivectors in body axes. Elsewhere ``I`` is the pseudoscalar;
      write ``(…) I`` for the bivector of a vector in brackets,
    - ``x`` and ``v``, the position and the velocity of the centre of mass, vectors in space in m and m/s,
      and ``m``, the mass in kg, unless `values` has values of these names.

    For a body held at a point, give `simulate` its inertia about that point, ``body.inertia_about(0)``.

    Parameters
    ----------
    text
        The formula, in N m.
    frame
        The axes of its value, ``"body"`` or ``"space"``.
    values
        Values of the other names: multivectors and rotors, single or batched, numbers, single linear maps.
        Write a batch of numbers as `ph.scalar`.

    Raises
    ------
    FormulaError
        If the text is not a formula or its value is not a bivector, with the place. If the formula has no
        value at some point of a motion, `simulate` raises and names the part of the formula.

    Examples
    --------
    The law `heavy` as a formula:

    >>> c = ph.vector([0, 0, 3])
    >>> weight = ph.torque.formula("-c ∧ (~R e3 R)", c=c)
    >>> inertia = ph.Inertia.from_principal_moments(2, 2, 1)
    >>> state = ph.State(ph.Rotor.from_plane_angle(ph.e2 ^ ph.e3, 1.0), [0, 0, 20])
    >>> bool(weight.at(inertia, state).is_close(ph.torque.heavy(c).at(inertia, state)))
    True
    """
    axes = one_of(FRAMES, frame, "frame")

    def law(given: tuple[tuple[str, Any], ...]) -> Torque:
        return native_torque("formula", text, axes, named_together(given))

    return law_of_formula(law, text, values, batches=True)


@explains_calls
def function(f: Callable[..., Any], *, center: bool = False) -> Torque:
    """Return the torque of a Python function ``f(t, rotor, omega_body)``.

    Its arguments are the time in s, the rotor from body axes to space, and the angular velocity in body
    axes, a bivector; it returns the torque in body axes in N m, a bivector or (3,). Its exceptions pass
    through `simulate`. It is about ten times slower than a `formula`; the law can be pickled if f can.

    Parameters
    ----------
    f
        The function.
    center
        Whether to call ``f(t, rotor, omega_body, position, velocity)``, with the position and the velocity of
        the centre of mass, vectors in space in m and m/s.

    Examples
    --------
    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> start = ph.State(ph.Rotor.identity(), [0, 0, 1])
    >>> law = ph.torque.function(lambda t, rotor, omega_body: -0.5 * omega_body)
    >>> motion = ph.simulate(ball, start, [0, 1, 2], law)
    >>> motion.omega_body["e12"].round(4)  # exp(-0.5 t)
    array([1.    , 0.6065, 0.3679])
    """
    if not isinstance(center, bool):
        raise TypeError(f"center must be True or False, got {center!r}")
    place = ("position", "velocity") if center else ()
    return native_torque("function", function_of(f, "t", "rotor", "omega_body", *place), center)
