"""What a simulation gives: states at and between its output times, its events and its certificate."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _native
from polhode._arrays import Array, as_floats, frozen
from polhode._bodies import Inertia
from polhode._multivector import Multivector
from polhode._rotor import Rotor
from polhode._state import State
from polhode._values import bivector, vector

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure


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
        Angular momenta in space axes, those of wheels included, bivectors in kg m²/s, batch (n,).
    energy
        Kinetic energy of rotation plus the potential energy of the torques that have one, in J, (n,).
    position, velocity
        Of the centre of mass (of the fixed point, where there is one), vectors in m and m/s, batch (n,).
    inertia
        The inertia that ruled the motion.
    certificate
        How the run was made and what it conserved.
    events
        For each event that was asked for, when and where it happened.
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
    events: tuple[Crossings, ...] = ()
    attributes: dict[str, Any] = field(default_factory=dict)
    _motion: _native.Motion | None = field(default=None, repr=False)

    @staticmethod
    def _of(
        motion: _native.Motion, inertia: Inertia, certificate: Certificate, names: Sequence[str]
    ) -> Trajectory:
        which, rising, points = motion.events()
        happened = _Points.of(points)
        chosen = [
            np.array([k for k, event in enumerate(which) if event == i], int) for i in range(len(names))
        ]
        ways = np.array(rising, bool)
        events = (happened.crossings(name, k, ways[k]) for name, k in zip(names, chosen, strict=True))
        at = _Points.of(motion.states())
        return Trajectory(
            at.time,
            at.rotor,
            at.omega_body,
            at.momentum_space,
            at.energy,
            at.position,
            at.velocity,
            inertia,
            certificate,
            tuple(events),
            _motion=motion,
        )

    def at(self, t: Any) -> State:
        """Return the state at any time t in s between the first and the last; an array gives a batch.

        The first and the last are those of the output times, of the start at time 0 and of the events.

        In closed form where the motion has one, else by the same method and the same steps from the nearest
        output time before, so that it is as accurate as the states at the output times. A ValueError outside.
        """
        if self._motion is None:
            raise ValueError(
                "this trajectory was read or unpickled, not made by simulate: it has no states but its own"
            )
        times = as_floats(t, "time")
        found = _Points.of(self._motion.at(np.ascontiguousarray(times.ravel())))
        shape = times.shape
        return State(
            Rotor._from_rows(found.rotor.components.reshape(*shape, 4)),
            bivector(found.omega_body.components.reshape(*shape, 3)),
            vector(found.position.components.reshape(*shape, 3)),
            vector(found.velocity.components.reshape(*shape, 3)),
        )

    def drifts(self) -> dict[str, Array]:
        """Return each conserved quantity's change since time 0, relative as in the certificate, (n,) each."""
        return dict(self._motion.drifts()) if self._motion is not None else {}

    def __getstate__(self) -> dict[str, Any]:
        """What is pickled: all but the motion between the output times."""
        return self.__dict__ | {"_motion": None}

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
    method, step, steps, evaluations
        The method's name (``exact`` for the exact solution), its longest step in s, and the steps and the
        evaluations of the torque of all passes.
    error_estimate
        Cautious estimate of the relative error in rotor and angular velocity, from the last two passes; None
        for a step that was given.
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
    evaluations: int
    error_estimate: float | None
    conserved: dict[str, float]
    drift: dict[str, float]
    norm_drift: float

    @property
    def worst(self) -> float:
        """The largest drift of all."""
        return max([self.norm_drift, *self.drift.values()])


@dataclass(frozen=True, eq=False)
class Crossings:
    """When and where an event happened, m times, in the order in which they were met: by `abs(time)`.

    Attributes
    ----------
    name
        What the event is called.
    time
        Times in s, (m,).
    rising
        Whether the quantity passed zero from below, in the direction in which time was followed, (m,).
    rotor, omega_body, position, velocity
        The states there, as in `Trajectory`, batch (m,).
    """

    name: str
    time: Array
    rising: Array
    rotor: Rotor
    omega_body: Multivector
    position: Multivector
    velocity: Multivector

    def __len__(self) -> int:
        return len(self.time)


@dataclass(frozen=True, eq=False)
class _Points:
    """The arrays of the core, as values."""

    time: Array
    rotor: Rotor
    omega_body: Multivector
    momentum_space: Multivector
    energy: Array
    position: Multivector
    velocity: Multivector

    @staticmethod
    def of(points: Sequence[Array]) -> _Points:
        time, rotor, omega, momentum, energy, position, velocity = points
        return _Points(
            frozen(time),
            Rotor._from_rows(rotor),
            bivector(omega, copy=False),
            bivector(momentum, copy=False),
            frozen(energy),
            vector(position, copy=False),
            vector(velocity, copy=False),
        )

    def crossings(self, name: str, chosen: Array, rising: Array) -> Crossings:
        return Crossings(
            name,
            frozen(self.time[chosen]),
            frozen(rising),
            Rotor._from_rows(self.rotor.components[chosen]),
            self.omega_body[chosen],
            self.position[chosen],
            self.velocity[chosen],
        )
