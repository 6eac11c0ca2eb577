"""What a simulation gives: states at and between its output times, its events and its certificate."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _native
from polhode._algebra.constructors import bivector, vector
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.bodies import Inertia
from polhode._mechanics.result import Certificate, Crossings, Failure
from polhode._mechanics.state import State
from polhode._support.arrays import Array, Shape, as_floats, frozen, hands_out_copies

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

    from polhode._scene.scene import Scene
    from polhode._scene.writer import Problem
    from polhode._viewer.widget import Viewer


@hands_out_copies("time", "energy")
@dataclass(frozen=True, eq=False)
class Trajectory:
    """A motion at n times, or those of a batch of bodies at the same times.

    Of a batch all values have the shape ``(*shape, n)``, and ``trajectory[i]`` is one motion, or fewer.

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
        The inertia that ruled the motion; where bodies have their own an array of them, of the batch's shape.
    certificate
        How the run was made and what it conserved.
    events
        For each event that was asked for, when and where it happened.
    failures
        The bodies of a batch that could not be followed to the end. Their values are NaN from there on, with
        equal steps side by side, and else all of them, for no pass was confirmed; but for `position` and
        `velocity` without forces, which are known all the same.
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
    inertia: Any  # an Inertia, or an array of them
    certificate: Certificate
    events: tuple[Crossings, ...] = ()
    failures: tuple[Failure, ...] = ()
    attributes: dict[str, Any] = field(default_factory=dict)
    _motion: _native.Motion | None = field(default=None, repr=False)
    # Of a batch that no force moves: places and velocities are found when they are asked for.
    _drift: Drift | None = field(default=None, repr=False)
    # Of one body: what was run, or asked for.
    _origin: Scene | Problem | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        if self._drift is not None:
            del self.__dict__["position"], self.__dict__["velocity"]

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            drift = self.__dict__.get("_drift")
            if drift is None or name not in ("position", "velocity"):
                raise AttributeError(f"a Trajectory has no attribute {name!r}")
            return getattr(drift, name)(self.time)

    @staticmethod
    def _of(
        motion: _native.Motion,
        inertia: Inertia,
        names: Sequence[str],
        origin: Scene | Problem,
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
            Certificate(**motion.certificate()),
            tuple(events),
            _motion=motion,
            _origin=origin,
        )

    @property
    def shape(self) -> Shape:
        """Shape of the batch of bodies; ``()`` for one."""
        return self.rotor.shape[:-1]

    @property
    def ok(self) -> Any:
        """Whether a body was followed to the end: a bool, or an array of the batch's shape."""
        ok = np.ones(self.shape, bool)
        for failure in self.failures:
            ok[failure.index] = False
        return ok if self.shape else bool(ok)

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError(
                "the trajectory of one body has no length; its times are n = len(trajectory.time)"
            )
        return self.shape[0]

    def __bool__(self) -> bool:
        return True

    def __iter__(self) -> Iterator[Trajectory]:
        return (self[i] for i in range(len(self)))

    def __getitem__(self, index: Any) -> Trajectory:
        """Return the motions of some bodies of a batch, by an index of NumPy over the batch's axes."""
        parts = index if isinstance(index, tuple) else (index,)
        try:
            picked = np.broadcast_to(np.False_, self.shape)[parts].shape
        except IndexError as error:
            raise IndexError(f"{error} (batch shape {self.shape})") from None
        # The index is to stay off the axis of time.
        rows = (*parts, slice(None)) if any(part is Ellipsis for part in parts) else parts
        drift = None if self._drift is None else self._drift[parts]
        center: list[Any] = [None, None] if drift else [self.position[rows], self.velocity[rows]]
        return replace(
            self,
            rotor=Rotor._from_rows(self.rotor[rows]._data),
            omega_body=self.omega_body[rows],
            momentum_space=self.momentum_space[rows],
            energy=self.energy[rows],
            position=center[0],
            velocity=center[1],
            _drift=drift,
            inertia=self.inertia if isinstance(self.inertia, Inertia) else self.inertia[parts],
            certificate=self.certificate._of(parts),
            failures=self._failures_at(parts, picked),
            attributes=dict(self.attributes),
        )

    def _failures_at(self, index: tuple[Any, ...], shape: Shape) -> tuple[Failure, ...]:
        """Return the failures among picked bodies, by their places among them."""
        if not self.failures:
            return ()
        which = np.full(self.shape, -1)
        for k, failure in enumerate(self.failures):
            which[failure.index] = k
        picked = np.asarray(which[index])
        places = zip(np.argwhere(picked >= 0).tolist(), picked[picked >= 0].tolist(), strict=True)
        return tuple(replace(self.failures[k], index=tuple(place)) for place, k in places)

    def _require_one(self, what: str, *, alone: bool = False) -> None:
        """Raise a ValueError for a batch; `alone` where one picked from a batch does not serve either."""
        if self.shape:
            first = ", ".join("0" for _ in self.shape)
            remedy = "simulate that body alone" if alone else f"pick one of them, as in trajectory[{first}]"
            raise ValueError(f"{what} is for one body, this is a batch of shape {self.shape}; {remedy}")

    def at(self, t: Any) -> State:
        """Return the state at any time t in s between the first and the last; an array gives a batch.

        The first and the last are those of the output times, of the start and of the events. The time of the
        state is t.

        In closed form where the motion has one, else by the same method and the same steps from the nearest
        output time before, so that it is as accurate as the states at the output times. A ValueError outside,
        and for a batch of bodies.
        """
        self._require_one("at", alone=True)
        if self._motion is None:
            raise ValueError(
                "this trajectory was picked from a batch, read or unpickled: it has no states but its own; "
                "simulate the body alone"
            )
        times = as_floats(t, "time")
        found = _Points.of(self._motion.at(np.ascontiguousarray(times.ravel())))
        shape = times.shape
        return State(
            Rotor._from_rows(found.rotor._data.reshape(*shape, 4)),
            bivector(found.omega_body._data.reshape(*shape, 3)),
            vector(found.position._data.reshape(*shape, 3)),
            vector(found.velocity._data.reshape(*shape, 3)),
            time=times,
        )

    @property
    def final(self) -> State:
        """The state at the last output time, from which `simulate` goes on; of a batch, those of all bodies.

        A ValueError where there are no output times. An event that ended the motion lies after it.
        """
        if not len(self.time):
            raise ValueError("there is no last state: the motion has no output times")
        return State(
            Rotor._from_rows(np.ascontiguousarray(self.rotor._data[..., -1, :])),
            bivector(self.omega_body._data[..., -1, :]),
            vector(self.position._data[..., -1, :]),
            vector(self.velocity._data[..., -1, :]),
            time=float(self.time[-1]),
        )

    def drifts(self) -> dict[str, Array]:
        """Return each conserved quantity's change since the start, relative as in the certificate, (n,) each.

        Of one body; a ValueError for a batch.
        """
        self._require_one("drifts", alone=True)
        return dict(self._motion.drifts()) if self._motion is not None else {}

    def __getstate__(self) -> dict[str, Any]:
        """What is pickled: all but the motion between the output times, and what was asked for."""
        return self.__dict__ | {"_motion": None, "_origin": None}

    def to_xarray(self) -> xarray.Dataset:
        """Return an `xarray.Dataset` with labelled dimensions, units and the conventions.

        Of a batch the dimension `body` counts the bodies in C order; the attribute `batch_shape` tells the
        shape.
        """
        from polhode._report.netcdf import to_xarray

        return to_xarray(self)

    @staticmethod
    def read(path: str | os.PathLike[str]) -> Trajectory:
        """Read the motion of one body from a netCDF file that `save` or ``polhode run -o`` wrote.

        All numbers are those that were written, to the last bit; between its times it is no longer known. A
        ValueError for the file of a batch, which xarray reads, and for one that is not ours; an OSError for
        one that cannot be read.
        """
        from polhode._report.netcdf import read

        return read(path)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a netCDF file, whole or not at all: an older file stays until the new one is complete.

        Raises
        ------
        ValueError
            If the suffix of the path is not ``.nc``.
        """
        from polhode._report.netcdf import netcdf
        from polhode._support.files import form_of, write_atomically

        form_of(path, "a motion")
        write_atomically({Path(path): netcdf(self)})

    def plot(self, kind: str = "motion", *, view: Any = None, time: float | None = None) -> Figure:
        """Return a matplotlib figure for paper, of one body.

        Parameters
        ----------
        kind
            ``"motion"``, angular velocity, attitude and drift over time; ``"polhode"`` on its ellipsoid;
            ``"herpolhode"`` in the invariable plane; ``"locus"``, the path of a top's axis; ``"drift"`` of
            what is conserved; ``"phase"``, the phase portrait; ``"scene"``, the body and its bivectors.
        view
            Azimuth and elevation in degrees from which to look at what has depth; None for the usual ones.
        time
            Of the scene, in s; None for the last one.

        Raises
        ------
        ValueError
            For a batch, a kind that does not fit the motion, or too few output times.
        """
        self._require_one("plot")
        from polhode._figures.registry import figure

        return figure(self, kind, view, time)

    def film(
        self,
        path: str | os.PathLike[str],
        *,
        seconds: float = 12.0,
        fps: float = 25.0,
        size: tuple[int, int] | None = None,
        view: Any = None,
        progress: Callable[[float], object] | None = None,
    ) -> None:
        """Write a film of the scene of one body, whole or not at all: FILE.mp4, by ffmpeg, or FILE.gif.

        Parameters
        ----------
        seconds, fps
            How long the film takes for the whole motion, and its pictures in a second.
        size
            Width and height in pixels; None for (1280, 720), of a GIF (640, 360).
        view
            As for `plot`.
        progress
            Called now and then with the fraction done.

        Raises
        ------
        ValueError
            For a batch, another name of file, too few output times, or a film of no pictures.
        OSError
            Without ffmpeg, or where the file cannot be written; an older file stays.

        Warns
        -----
        UserWarning
            If the body turns by more than a quarter turn from one picture to the next, so that it seems to
            turn otherwise; with the speed up to which the film shows the motion as it is.
        """
        self._require_one("film")
        from polhode._figures.film import write

        write(self, Path(path), seconds, fps, size, view, progress)

    def view(self) -> Viewer:
        """Show the motion in a notebook, as `polhode.view` does.

        Of one body; a ValueError for a batch.
        """
        from polhode._viewer.notebook import view

        return view(self)

    def __repr__(self) -> str:
        n = len(self.time)
        span = f", t = {self.time[0]:.6g} … {self.time[-1]:.6g} s" if n else ""
        method = self.certificate.method
        named = method if isinstance(method, str) else f"{len(np.unique(method[self.ok]))} methods"
        bodies = f"bodies {self.shape}, " if self.shape else ""
        failed = f"; {len(self.failures)} failed, the first {self.failures[0]}" if self.failures else ""
        return f"Trajectory({bodies}{n} times{span}, {named}{failed})"


@dataclass(frozen=True, eq=False)
class Drift:
    """The uniform motion of centres of mass from their starts: times (*shape), the others (*shape, 3)."""

    start_times: Array
    places: Array
    velocities: Array

    def __getitem__(self, index: tuple[Any, ...]) -> Drift:
        rest: tuple[Any, ...] = (slice(None),) if any(part is Ellipsis for part in index) else ()
        return Drift(
            np.asarray(self.start_times[index]),
            self.places[(*index, *rest)],
            self.velocities[(*index, *rest)],
        )

    def position(self, times: Array) -> Multivector:
        """Places at times (n,), vectors of batch (*shape, n)."""
        elapsed = (times - self.start_times[..., np.newaxis])[..., np.newaxis]
        return vector(self.places[..., np.newaxis, :] + self._rates(times) * elapsed)

    def velocity(self, times: Array) -> Multivector:
        """The velocities, at each time the same."""
        return vector(self._rates(times))

    def _rates(self, times: Array) -> Array:
        rates = self.velocities[..., np.newaxis, :]
        return np.broadcast_to(rates, (*rates.shape[:-2], len(times), 3))


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
            Rotor._from_rows(self.rotor._data[chosen]),
            self.omega_body[chosen],
            self.position[chosen],
            self.velocity[chosen],
        )
