"""Motion: simulation, and the trajectory that comes out."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _native
from polhode._arrays import Array, as_float, as_floats, frozen
from polhode._bodies import Body, Inertia
from polhode._multivector import Multivector
from polhode._rotor import Rotor
from polhode._state import State, single
from polhode._values import as_point, bivector, vector
from polhode.torque import Torque

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

METHODS: tuple[str, ...] = ("auto", "exact", *_native.methods())


@dataclass(frozen=True, eq=False)
class Trajectory:
    """A motion at n times.

    Attributes
    ----------
    time
        Times in s, (n,).
    rotor
        Rotors from body axes to space axes, batch (n,), continuous in time on the double cover.
    omega_body
        Angular velocities in body axes, bivectors in rad/s, batch (n,).
    momentum_space
        Angular momenta in space axes, bivectors in kg m²/s, batch (n,).
    energy
        Kinetic energy of rotation plus potential energy of gravity, in J, (n,).
    position, velocity
        Of the centre of mass (of the fixed point, where there is one), vectors in m and m/s, batch (n,).
    inertia
        The inertia that ruled the motion.
    certificate
        How the run was made and what it conserved.
    attributes
        Text and numbers to be written with the data: title, scene, version.
    """

    time: Array
    rotor: Rotor
    omega_body: Multivector
    momentum_space: Multivector
    energy: Array
    position: Multivector
    velocity: Multivector
    inertia: Inertia
    certificate: Certificate
    attributes: dict[str, Any] = field(default_factory=dict)

    def to_xarray(self) -> xarray.Dataset:
        """Return an `xarray.Dataset` with labelled dimensions, units and the conventions."""
        from polhode._io import to_xarray

        return to_xarray(self)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a netCDF file, whole or not at all: an older file stays until the new one is complete."""
        from polhode._files import write_atomically
        from polhode._io import netcdf

        write_atomically({Path(path): netcdf(self)})

    def plot(self) -> Figure:
        """Draw angular velocity, attitude and conserved quantities over time; a matplotlib figure."""
        from polhode._plot import motion_figure

        return motion_figure(self)

    def __repr__(self) -> str:
        n = len(self.time)
        span = f", t = {self.time[0]:.6g} … {self.time[-1]:.6g} s" if n else ""
        return f"Trajectory({n} times{span}, {self.certificate.method})"


@dataclass(frozen=True)
class Certificate:
    """How a run was made, and how far it went astray in what the law conserves.

    Attributes
    ----------
    method, step, steps
        The method's name (``exact`` for the exact solution), its longest step in s, and the steps of all
        passes.
    error_estimate
        Estimate of the relative error in rotor and angular velocity, from two passes; None for a step
        that was given.
    conserved
        Each conserved quantity's initial value in SI.
    drift
        Its largest change over the run, relative to the terms that make it up.
    norm_drift
        Largest ``abs(|R| − 1)``.
    """

    method: str
    step: float
    steps: int
    error_estimate: float | None
    conserved: dict[str, float]
    drift: dict[str, float]
    norm_drift: float

    @property
    def worst(self) -> float:
        """The largest drift of all."""
        return max([self.norm_drift, *self.drift.values()])


def simulate(
    body: Body | Inertia,
    state: State,
    times: Any,
    torque: Torque | None = None,
    force: Any = None,
    method: str = "auto",
    rtol: float | None = None,
    atol: float | None = None,
    step: float | None = None,
    *,
    progress: Callable[[int, float], object] | None = None,
) -> Trajectory:
    """Return the motion of a body at given times: exact if it is free, else by steps that keep |R|.

    Parameters
    ----------
    body
        A `Body` or its `Inertia` in kg m². With `ph.torque.heavy` a body is held at the origin of its
        axes, and an inertia is that about the fixed point.
    state
        The state at time 0.
    times
        Output times in s, (n,), not decreasing, of either sign.
    torque
        A law of `polhode.torque`, or a sum of them; None for free motion.
    force
        A constant force in space on the centre of mass, a vector or (3,) in N; it needs a `Body`.
    method
        ``"auto"``: ``"exact"``, as `FreeMotion`, for a free body without a `step`; else the last of
        ``strang`` (order 2), ``yoshida4``, ``kahan_li6``, ``kahan_li8``, symmetric compositions of exact
        turns and kicks.
    rtol, atol
        Without a `step`, it is halved until two runs differ by less than the larger of the two: in the
        rotor, and in the angular velocity relative to its largest size. With neither given the aim is
        1e-10; where rounding, magnified by the motion, allows only up to 1e-6, that is accepted and the
        certificate tells the estimate.
    step
        A fixed step in s; shortened a little so that steps end on the output times.
    progress
        Called now and then with the pass (from 1) and the fraction of it done. Ctrl-C stops the run.

    Raises
    ------
    ValueError
        For input that is not usable, or a tolerance that was not reached.
    """
    if torque is not None and not isinstance(torque, Torque):
        raise TypeError(
            f"torque must be a law of polhode.torque, such as heavy(c), got {type(torque).__name__}"
        )
    if progress is not None and not callable(progress):
        raise TypeError(f"progress must be callable, got {type(progress).__name__}")
    if method not in METHODS:
        raise ValueError(f"unknown method {method!r}, expected one of {', '.join(METHODS)}")
    if method == "exact" and (torque is not None or step is not None):
        raise ValueError('method "exact" is for free motion without a step; leave it out for others')
    start = single(state)
    mass = body.mass if isinstance(body, Body) else None
    inertia = _ruling_inertia(body, torque)
    when = np.atleast_1d(as_floats(times, "times"))
    if when.ndim != 1:
        raise ValueError(f"times must be one-dimensional, got shape {when.shape}")
    acceleration = _acceleration(force, mass)
    if _is_held(torque) and acceleration.any():
        raise ValueError("with ph.torque.heavy the body is held at a fixed point: no force moves it")
    rotors, omegas, momenta, energies, certificate = _native.simulate(
        inertia._core,
        start.rotor._data,
        start.omega_body._data,
        list(torque.laws) if torque else [],
        np.ascontiguousarray(when),
        "auto" if method == "exact" else method,
        None if step is None else as_float(step, "step"),
        _tolerance(rtol, atol),
        progress,
    )
    # x0(t) of handout eq. (4.1), under a constant force.
    x, v, t = start.position.components, start.velocity.components, when[:, np.newaxis]
    with np.errstate(over="ignore"):  # t² may overflow where no force needs it
        place = x + v * t + 0.5 * acceleration * t**2 if acceleration.any() else x + v * t
    return Trajectory(
        time=frozen(when.copy()),
        rotor=Rotor._from_rows(rotors),
        omega_body=bivector(omegas, copy=False),
        momentum_space=bivector(momenta, copy=False),
        energy=frozen(energies),
        position=vector(place),
        velocity=vector(v + acceleration * t),
        inertia=inertia,
        certificate=Certificate(**certificate),
    )


def _tolerance(rtol: float | None, atol: float | None) -> float | None:
    """Both measure the same scaled difference, so the larger one rules."""
    given = {name: as_float(x, name) for name, x in (("rtol", rtol), ("atol", atol)) if x is not None}
    for name, x in given.items():
        if not (x > 0 and np.isfinite(x)):
            raise ValueError(f"{name} is {x}; it must be positive and finite")
    return max(given.values(), default=None)


def _ruling_inertia(body: Body | Inertia, torque: Torque | None) -> Inertia:
    if isinstance(body, Inertia):
        return body
    if not isinstance(body, Body):
        raise TypeError(f"body must be a Body or an Inertia, got {type(body).__name__}")
    return body.inertia_about(0) if _is_held(torque) else body.inertia


def _is_held(torque: Torque | None) -> bool:
    """Whether the body is held at a fixed point, the origin of its axes."""
    return torque is not None and any(name == "heavy" for name, _ in torque.laws)


def _acceleration(force: Any, mass: float | None) -> Array:
    if force is None:
        return np.zeros(3)
    if mass is None:
        raise TypeError("a force needs a Body, whose mass it moves; got an Inertia")
    return as_point(force, "the force") / mass
