"""`AttitudeHistory`: attitudes at given times, with the other quantities that a file has."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from polhode._algebra.constructors import vector
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.bodies import Body
from polhode._mechanics.foreign_tables import HISTORY
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.result import Certificate
from polhode._mechanics.trajectory import Trajectory
from polhode._report.table import columns_of
from polhode._support.arrays import Array, as_count, as_floats
from polhode._support.foreign_names import ListsOwnNames, with_foreign_names


class FileError(ValueError):
    """A mistake in a file, with its place.

    Examples
    --------
    >>> with open("note.csv", "w") as file:
    ...     _ = file.write("time,attitude_w")
    >>> try:
    ...     ph.io.read_csv("note.csv")
    ... except ph.io.FileError as error:
    ...     print(str(error).splitlines()[0])  # the next ones show the place
    note.csv:1:1: error: the file has no column 'attitude_x'; it needs time and attitude_w, _x, _y, _z
    """


class RowError(ValueError):
    """A mistake at a time of a history: what is wrong, the row from 0, and the first column it is in."""

    def __init__(self, words: str, row: int, column: str) -> None:
        super().__init__(f"{words} at row {row}")
        self.words, self.row, self.column = words, row, column


def checked_body(body: Any) -> int | None:
    """Return the number of a body, or None; a TypeError for anything else."""
    return None if body is None else as_count(body, "body")


def require_file(path: str | os.PathLike[str]) -> None:
    """Raise a FileNotFoundError for a path without a file, and a FileError for one of another kind."""
    name = os.fsdecode(path)
    if not os.path.lexists(path):
        raise FileNotFoundError(f"{name}: no such file")
    if not os.path.isfile(path):
        raise FileError(f"{name}: error: not a regular file; give the path of a file")


# The optional quantities, and their grades.
_OPTIONAL = {"omega_body": 2, "momentum_space": 2, "position": 1, "velocity": 1}


@with_foreign_names(HISTORY)
@dataclass(frozen=True, eq=False)
class AttitudeHistory(metaclass=ListsOwnNames):
    """Attitudes of one body at n times, with the other quantities that a file has.

    A quantity that is not known is None; nothing is made up for it.

    Attributes
    ----------
    time
        Strictly increasing times in s since ``attributes["epoch"]``, if there is one, (n,).
    rotor
        Rotors from body axes to space axes, batch (n,).
    omega_body, momentum_space, energy, position, velocity
        As in `polhode.Trajectory`, or None.
    wheel_speed
        Speeds of reaction wheels in rad/s, (n, k), or None.
    attributes
        Text and numbers. Those that have a meaning in CCSDS files: ``epoch`` and ``time_system``,
        ``reference_frame`` (the space axes) and ``body_frame``, ``object_name``, ``object_id``,
        ``center_name``, ``interpolation_method`` and ``interpolation_degree``.
    inertia
        The inertia that determines the motion, as that of a trajectory, or None.

    Raises
    ------
    TypeError, ValueError
        For shapes that do not fit, numbers that are not finite, and times that do not increase.

    Examples
    --------
    >>> times = np.linspace(0, 2, 5)
    >>> rotors = ph.Rotor.from_rotation_vector(times[:, np.newaxis] * [0, 0, 0.5])
    >>> history = ph.io.AttitudeHistory(times, rotors, attributes={"object_name": "CURLEW"})
    >>> history
    AttitudeHistory(5 times, t = 0 … 2 s, rotor)
    """

    time: Array
    rotor: Rotor
    omega_body: Multivector | None = None
    momentum_space: Multivector | None = None
    energy: Array | None = None
    position: Multivector | None = None
    velocity: Multivector | None = None
    wheel_speed: Array | None = None
    attributes: dict[str, Any] = field(default_factory=dict)
    inertia: Inertia | None = None

    def __post_init__(self) -> None:
        time = np.array(as_floats(self.time, "time"))
        object.__setattr__(self, "time", time)
        if time.ndim != 1:
            raise ValueError(f"time must have shape (n,), got {time.shape}")
        if len(odd := np.flatnonzero(~np.isfinite(time))):
            raise RowError(f"times must be finite, got {time[odd[0]]}", int(odd[0]), "time")
        if len(fallen := np.flatnonzero(np.diff(time) <= 0)):
            k = int(fallen[0]) + 1
            raise RowError(f"times must increase, got {time[k]} s after {time[k - 1]} s", k, "time")
        if not isinstance(self.rotor, Rotor):
            raise TypeError(f"rotor must be a Rotor, got {type(self.rotor).__name__}")
        for name in ("rotor", *_OPTIONAL):
            values = getattr(self, name)
            if values is None:
                continue
            if name != "rotor" and (
                not isinstance(values, Multivector) or values.grades != (_OPTIONAL[name],)
            ):
                kind = "bivectors" if _OPTIONAL[name] == 2 else "vectors"
                raise TypeError(f"{name} must be {kind}, got {values!r:.80}")
            if values.shape != time.shape:
                raise ValueError(f"{name} must have shape {time.shape} as the times, got {values.shape}")
            rows = values.components
            if not np.isfinite(rows).all():
                k, part = (int(x) for x in np.argwhere(~np.isfinite(rows))[0])
                column = columns_of("attitude" if name == "rotor" else name)[part]
                raise RowError(f"{name} must be finite, got {rows[k, part]}", k, column)
        for name, ndim in (("energy", 1), ("wheel_speed", 2)):
            values = getattr(self, name)
            if values is not None and (np.ndim(values) != ndim or len(values) != len(time)):
                shape = "(n,)" if ndim == 1 else "(n, k)"
                raise ValueError(
                    f"{name} must have shape {shape} for n = {len(time)}, got {np.shape(values)}"
                )
            if values is not None and not np.isfinite(values).all():
                place = tuple(int(x) for x in np.argwhere(~np.isfinite(values))[0])
                column = "_".join([name, *(str(k) for k in place[1:])])
                raise RowError(f"{name} must be finite, got {values[place]}", place[0], column)

    def __len__(self) -> int:
        return len(self.time)

    def __repr__(self) -> str:
        known = [name for name in (*_OPTIONAL, "energy") if getattr(self, name) is not None]
        n = len(self.time)
        span = f", t = {self.time[0]:.6g} … {self.time[-1]:.6g} s" if n else ""
        return f"AttitudeHistory({n} times{span}, {', '.join(['rotor', *known])})"

    @staticmethod
    def of(motion: Trajectory | AttitudeHistory) -> AttitudeHistory:
        """Return the history of the motion of one body; a ValueError for a batch.

        Examples
        --------
        >>> ball = ph.Inertia.from_principal_moments(2, 2, 2)
        >>> motion = ph.simulate(ball, ph.State(ph.Rotor.identity(), [0, 0, 1]), [0, 1, 2])
        >>> ph.io.AttitudeHistory.of(motion)
        AttitudeHistory(3 times, t = 0 … 2 s, rotor, omega_body, momentum_space, position, velocity, energy)
        """
        if isinstance(motion, AttitudeHistory):
            return motion
        if not isinstance(motion, Trajectory):
            raise TypeError(f"expected a Trajectory or an AttitudeHistory, got {type(motion).__name__}")
        motion._require_one("a file of attitudes")
        wheels = motion.wheel_speed
        return AttitudeHistory(
            motion.time,
            motion.rotor,
            motion.omega_body,
            motion.momentum_space,
            motion.energy,
            motion.position,
            motion.velocity,
            wheels if wheels.shape[-1] else None,
            dict(motion.attributes),
            motion.inertia if isinstance(motion.inertia, Inertia) else None,
        )

    def trajectory(self, body: Body | Inertia) -> Trajectory:
        """Return a `Trajectory` of a body with this history.

        Quantities that are not known follow from those that are: ``L = R I(Ω_B) ~R`` and the kinetic energy
        ``½ Ω_B·I(Ω_B)`` of rotation, without wheels and potentials; position and velocity are zero. The
        inertia is used as it is, that of a `Body` about its centre of mass. As for a trajectory read from a
        file, there are no states between its times.

        Raises
        ------
        ValueError
            Without angular velocities; `polhode.rates_from_attitude` estimates them from the attitudes.

        Examples
        --------
        >>> ball = ph.Inertia.from_principal_moments(2, 2, 2)
        >>> motion = ph.simulate(ball, ph.State(ph.Rotor.identity(), [0, 0, 1]), [0, 1, 2])
        >>> ph.io.AttitudeHistory.of(motion).trajectory(ball).energy
        array([1., 1., 1.])
        """
        inertia = body.inertia if isinstance(body, Body) else body
        if not isinstance(inertia, Inertia):
            raise TypeError(f"body must be a Body or an Inertia, got {type(body).__name__}")
        omega = self.omega_body
        if omega is None:
            raise ValueError(
                "the history has no angular velocity; estimate it with ph.rates_from_attitude(time, rotor), "
                "or write QUATERNION/ANGVEL"
            )
        momentum = inertia(omega)
        rates = np.asarray(omega.components)
        kinetic = 0.5 * np.einsum("ni,ni->n", rates, np.asarray(momentum.components))
        still = np.zeros((len(self), 3))
        norms = np.linalg.norm(self.rotor.components, axis=-1)
        return Trajectory(
            self.time,
            self.rotor,
            omega,
            self.rotor(momentum) if self.momentum_space is None else self.momentum_space,
            kinetic if self.energy is None else self.energy,
            vector(still) if self.position is None else self.position,
            vector(still) if self.velocity is None else self.velocity,
            inertia,
            Certificate(
                "samples",
                float(np.max(np.diff(self.time), initial=0.0)),
                max(len(self) - 1, 0),
                0,
                None,
                {},
                {},
                float(np.max(np.abs(norms - 1), initial=0.0)),
            ),
            attributes=dict(self.attributes),
        )


def continuous(quaternions: Array) -> Array:
    """Return quaternions with signs such that neighbours differ by less than half a turn."""
    turned = np.einsum("ni,ni->n", quaternions[1:], quaternions[:-1]) < 0
    signs = np.concatenate([[1.0], np.cumprod(np.where(turned, -1.0, 1.0))])
    return np.asarray(quaternions * signs[:, np.newaxis])
