"""Dense samples of a trajectory, for smooth curves."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._support.arrays import Array

if TYPE_CHECKING:
    from polhode._mechanics.trajectory import Trajectory

# Largest turn between samples, in rad, and maximum number of samples, which takes precedence.
_TURN, _MOST = 0.08, 20_000


class Samples(NamedTuple):
    """Times (n,) in s, rotors and angular velocities in body axes (n,)."""

    time: Array
    rotor: Rotor
    omega_body: Multivector


def samples(trajectory: Trajectory) -> Samples:
    """Return the states at the output times, and between them where these are far apart."""
    time = trajectory.time
    given = Samples(time, trajectory.rotor, trajectory.omega_body)
    if trajectory._motion is None or len(time) < 2:
        return given
    speed = trajectory.omega_body.norm()
    steps = np.diff(time)
    turns = np.maximum(speed[1:], speed[:-1]) * steps
    most = max(1, _MOST // len(steps))
    parts = np.clip(np.ceil(turns / _TURN), 1, most).astype(int)
    if parts.max() == 1:
        return given
    starts = np.repeat(time[:-1], parts)
    within = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
    times = np.append(starts + within * np.repeat(steps / parts, parts), time[-1])
    state = trajectory.at(times)
    return Samples(times, state.rotor, state.omega_body)
