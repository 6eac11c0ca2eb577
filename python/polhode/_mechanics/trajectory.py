"""`Trajectory`: states at and between output times, events and certificate of a simulation."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from polhode import _native
from polhode._algebra.constructors import bivector, vector
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.foreign_tables import TRAJECTORY
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.result import Certificate, Crossings, Failure
from polhode._mechanics.state import State
from polhode._support.arrays import Array, Shape, as_floats, batch_index, frozen, hands_out_copies
from polhode._support.calls import created_by
from polhode._support.foreign_names import ListsOwnNames, with_foreign_names
from polhode._support.memory import require_array

if TYPE_CHECKING:
    from polhode import _outputs
    from polhode._mechanics.problem import Problem
    from polhode._scene.scene import Scene


# Bytes of a point of a single motion: in the core, and its copies.
BYTES_OF_POINT = 400


@with_foreign_names(TRAJECTORY)
@created_by("ph.simulate, or ph.Trajectory.read(path) for a file")
@hands_out_copies("time", "energy")
@dataclass(frozen=True, eq=False)
class Trajectory(metaclass=ListsOwnNames):
    """The motion of a body at n times, or the motions of a batch of bodies at the same times.

    For a batch all values have the shape ``(*shape, n)``; ``trajectory[i]`` indexes the batch as in NumPy.

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
        Of the centre of mass, or of the fixed point if there is one, vectors in m and m/s, batch (n,).
    inertia
        The `Inertia` used; an array of the batch's shape if bodies have their own.
    certificate
        How the run was computed, and its drift in conserved quantities.
    events
        Occurrences of each event.
    failures
        The bodies of a batch that failed. With equal steps, their values are NaN from the failure on;
        otherwise all are NaN, because no pass was confirmed. Without forces, `position` and `velocity` are
        always given.
    attributes
        Text and numbers saved with the data: title, scene, version.

    Examples
    --------
    A spinning ball that is damped loses its energy as ``exp(−2 g t)``:

    >>> ball = ph.Inertia.from_principal_moments(2, 2, 2)
    >>> start = ph.State(ph.Rotor.identity(), [0, 0, 1])
    >>> motion = ph.simulate(ball, start, [0, 1, 2], ph.torque.damping(0.5))
    >>> motion
    Trajectory(3 times, t = 0 … 2 s, exact)
    >>> motion.energy.round(4)
    array([1.    , 0.3679, 0.1353])
    >>> motion.omega_body[1].components.round(4)  # exp(-0.5)
    array([0.    , 0.    , 0.6065])
    >>> motion.at(0.5).time  # between the output times
    0.5
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
    # Of a batch without forces: positions and velocities are computed on access.
    _drift: Drift | None = field(default=None, repr=False)
    # Wheels with motors, shared by all bodies.
    _wheels: tuple[_native.Law, ...] = field(default=(), repr=False)
    # Of a motion read from a file: the speeds of its wheels (n, k), if it has any.
    _speeds: Array | None = field(default=None, repr=False)
    # Of one body: the scene or problem that was solved.
    _origin: Scene | Problem | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        if self._drift is not None:
            del self.__dict__["position"], self.__dict__["velocity"]

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            drift = self.__dict__.get("_drift")
            if drift is None or name not in ("position", "velocity"):
                hint = f"; write {TRAJECTORY[name]}" if name in TRAJECTORY else ""
                raise AttributeError(f"a Trajectory has no attribute {name!r}{hint}")
            return getattr(drift, name)(self.time)

    @staticmethod
    def _of(
        motion: _native.Motion,
        inertia: Inertia,
        names: Sequence[str],
        origin: Scene | Problem,
        wheels: tuple[_native.Law, ...] = (),
    ) -> Trajectory:
        return Trajectory(
            *_Points.of(motion.states()),
            inertia,
            Certificate(**motion.certificate()),
            Trajectory._events(motion, names) if names else (),
            _motion=motion,
            _wheels=wheels,
            _origin=origin,
        )

    @staticmethod
    def _events(motion: _native.Motion, names: Sequence[str]) -> tuple[Crossings, ...]:
        which, rising, points = motion.events()
        happened = _Points.of(points)
        ways = np.array(rising, bool)
        chosen = (np.flatnonzero(np.array(which, int) == i) for i in range(len(names)))
        return tuple(happened.crossings(name, k, ways[k]) for name, k in zip(names, chosen, strict=True))

    @property
    def shape(self) -> Shape:
        """Shape of the batch of bodies; ``()`` for one."""
        return self.rotor.shape[:-1]

    @property
    def ok(self) -> Any:
        """Whether a body finished: a bool, or an array of the batch's shape."""
        ok = np.ones(self.shape, bool)
        for failure in self.failures:
            ok[failure.index] = False
        return ok if self.shape else bool(ok)

    @property
    def omega_space(self) -> Multivector:
        """Angular velocities in space axes, ``Ω_S = R Ω_B ~R`` (eq. 4.12), bivectors in rad/s, batch (n,)."""
        return self.rotor(self.omega_body)

    @property
    def momentum_body(self) -> Multivector:
        """Angular momenta in body axes, ``~R L R``, bivectors in kg m²/s, batch (n,).

        Those of wheels are included, as in `momentum_space`: ``I(Ω_B)`` is the part of the body.
        """
        return (~self.rotor)(self.momentum_space)

    @property
    def wheel_speed(self) -> Array:
        """Speeds Ω of the reaction wheels relative to the body, (n, k) in rad/s, in the order of the laws.

        Tables and files have them too. Without `polhode.torque.reaction_wheels` k is 0.
        """
        return self._of_wheels(1) if self._speeds is None else self._speeds.copy()

    @property
    def wheel_momentum(self) -> Array:
        """Momenta ``H = J (Ω + a·ω)`` of the reaction wheels about their axes, (n, k) in kg m²/s.

        For a motion read from a file, which has no inertias of wheels, k is 0.
        """
        return self._of_wheels(0)

    def _of_wheels(self, which: int) -> Array:
        shape = self.omega_body.shape
        if not self._wheels:
            return np.zeros((*shape, 0))
        omegas = np.ascontiguousarray(self.omega_body._data)
        times = np.ascontiguousarray(np.broadcast_to(self.time, shape).ravel())
        found = [law.wheels(times, omegas.reshape(-1, 3)) for law in self._wheels]
        parts = [numbers[which].reshape(*shape, -1) for numbers in found if numbers is not None]
        return np.concatenate(parts, axis=-1)

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError("the trajectory of one body has no length; use len(trajectory.time)")
        return self.shape[0]

    def __bool__(self) -> bool:
        return True

    def __iter__(self) -> Iterator[Trajectory]:
        return (self[i] for i in range(len(self)))

    def __getitem__(self, index: Any) -> Trajectory:
        """Return the motions of some bodies of a batch, by an index of NumPy over the batch's axes."""
        try:
            parts, rows = batch_index(index, self.shape)
        except IndexError as error:
            remedy = "" if self.shape else "; the state at a time t of one motion is at(t)"
            raise IndexError(f"{error}{remedy}") from None
        drift = None if self._drift is None else self._drift[parts]
        center: list[Any] = [None, None] if drift else [self.position[rows], self.velocity[rows]]
        return replace(
            self,
            rotor=self.rotor[rows],
            omega_body=self.omega_body[rows],
            momentum_space=self.momentum_space[rows],
            energy=self.energy[rows],
            position=center[0],
            velocity=center[1],
            _drift=drift,
            inertia=self.inertia if isinstance(self.inertia, Inertia) else self.inertia[parts],
            certificate=self.certificate._of(parts),
            failures=self._failures_at(parts),
            attributes=dict(self.attributes),
        )

    def _failures_at(self, index: tuple[Any, ...]) -> tuple[Failure, ...]:
        """Return the failures among the picked bodies, with their new indices."""
        if not self.failures:
            return ()
        which = np.full(self.shape, -1)
        for k, failure in enumerate(self.failures):
            which[failure.index] = k
        picked = np.asarray(which[index])
        places = zip(np.argwhere(picked >= 0).tolist(), picked[picked >= 0].tolist(), strict=True)
        return tuple(replace(self.failures[k], index=tuple(place)) for place, k in places)

    def _require_one(self, what: str, *, alone: bool = False) -> None:
        """Raise a ValueError for a batch; `alone` if a body picked from a batch is not enough either."""
        if self.shape:
            first = ", ".join("0" for _ in self.shape)
            remedy = "simulate that body alone" if alone else f"pick one of them, as in trajectory[{first}]"
            raise ValueError(f"{what} is for one body, got a batch of shape {self.shape}; {remedy}")

    def at(self, t: Any) -> State:
        """Return the state at a time t in s within the motion; an array of times gives a batch.

        The motion extends over the output times, the start and the events. The state is computed in closed
        form if there is one, else by the same method and steps from the nearest output time before, so it is
        as accurate as the states at the output times. A ValueError outside, and for a batch of bodies.

        Examples
        --------
        >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
        >>> motion = ph.simulate(ball, ph.State(ph.Rotor.identity(), [0, 0, np.pi]), [0, 1])
        >>> bool(motion.at(0.5).rotor(ph.e1).is_close(ph.e2))  # a quarter turn from e1 to e2
        True
        >>> motion.at([0.1, 0.2, 0.3]).shape
        (3,)
        """
        self._require_one("at", alone=True)
        if self._motion is None:
            if self.certificate.method == "samples":
                raise ValueError(
                    "a trajectory made of an AttitudeHistory has no states between its times; "
                    "ph.RotorSpline(m.time, m.rotor) interpolates the attitudes of a trajectory m"
                )
            raise ValueError(
                "a trajectory picked from a batch, read or unpickled has no states between its times; "
                "simulate the body alone"
            )
        times = as_floats(t, "time")
        require_array(times.shape, "states at times", BYTES_OF_POINT)
        found = _Points.of(self._motion.at(np.ascontiguousarray(times.ravel())))
        parts = found.omega_body, found.position, found.velocity
        return State(found.rotor.reshape(times.shape), *(x.reshape(times.shape) for x in parts), time=times)

    @property
    def final(self) -> State:
        """The state at the last output time, from which `simulate` can continue; for a batch, of all bodies.

        A ValueError without output times. An event that ended the motion is later.
        """
        if not len(self.time):
            raise ValueError("the motion has no output times, so it has no final state")
        last = (x[..., -1] for x in (self.omega_body, self.position, self.velocity))
        return State(self.rotor[..., -1], *last, time=float(self.time[-1]))

    def drifts(self) -> dict[str, Array]:
        """Return the change of each conserved quantity since the start, (n,), relative as in the certificate.

        A ValueError for a batch.

        Examples
        --------
        >>> book = ph.Inertia.from_principal_moments(1, 2, 3)
        >>> start = ph.State(ph.Rotor.identity(), [0.1, 1, 0])
        >>> motion = ph.simulate(book, start, np.linspace(0, 10, 11), method="rk4", step=0.1)
        >>> drift = motion.drifts()
        >>> sorted(drift)
        ['angular_momentum', 'energy']
        >>> drift["energy"].shape, float(drift["energy"][0])
        ((11,), 0.0)
        """
        self._require_one("drifts", alone=True)
        return dict(self._motion.drifts()) if self._motion is not None else {}

    def __getstate__(self) -> dict[str, Any]:
        """Return what is pickled: all but the motion between the output times and its problem."""
        return self.__dict__ | {"_motion": None, "_origin": None}

    if TYPE_CHECKING:
        to_xarray, to_dataframe, save = _outputs.to_xarray, _outputs.to_dataframe, _outputs.save
        plot, film, _repr_html_ = _outputs.plot, _outputs.film, _outputs._repr_html_
        view, read = _outputs.view_of, staticmethod(_outputs.read)

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
    """Uniform motion of centres of mass: start times (*shape), positions and velocities (*shape, 3)."""

    start_times: Array
    positions: Array
    velocities: Array

    def __getitem__(self, index: tuple[Any, ...]) -> Drift:
        rest: tuple[Any, ...] = (slice(None),) if any(part is Ellipsis for part in index) else ()
        return Drift(
            np.asarray(self.start_times[index]),
            self.positions[(*index, *rest)],
            self.velocities[(*index, *rest)],
        )

    def position(self, times: Array) -> Multivector:
        """Return the positions at times (n,), vectors of batch (*shape, n)."""
        elapsed = (times - self.start_times[..., np.newaxis])[..., np.newaxis]
        return vector(self.positions[..., np.newaxis, :] + self._rates(times) * elapsed)

    def velocity(self, times: Array) -> Multivector:
        """Return the velocities, constant in time."""
        return vector(self._rates(times))

    def _rates(self, times: Array) -> Array:
        rates = self.velocities[..., np.newaxis, :]
        return np.broadcast_to(rates, (*rates.shape[:-2], len(times), 3))


class _Points(NamedTuple):
    """Arrays of the core as values."""

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

    def crossings(self, name: str, chosen: Any, rising: Array) -> Crossings:
        return Crossings(
            name,
            frozen(self.time[chosen]),
            frozen(rising),
            self.rotor[chosen],
            self.omega_body[chosen],
            self.position[chosen],
            self.velocity[chosen],
        )
