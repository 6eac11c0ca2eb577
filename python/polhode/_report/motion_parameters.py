"""Parameters of the torques and axes of a motion, for figures and reports."""

from __future__ import annotations

import numpy as np

from polhode._mechanics.trajectory import Trajectory
from polhode._support.arrays import Array
from polhode.torque import Torque


def weight(torque: Torque | None) -> Array:
    """Return ``c = m g (centre of mass)`` (3,) of a held body, in N m."""
    return _sum_of("heavy", torque)


def wheel(torque: Torque | None) -> Array:
    """Return the momentum of all wheels (3,) in body axes, in kg m²/s."""
    return _sum_of("gyrostat", torque)


def main_axis(trajectory: Trajectory) -> tuple[int, Array]:
    """Return the number of the principal axis about which the body mostly turns, and its direction (3,)."""
    rates = (~trajectory.inertia.principal_frame)(trajectory.omega_body).components
    k = int(np.argmax(np.abs(rates).mean(axis=0)))
    return k + 1, trajectory.inertia.principal_frame.to_matrix()[:, k]


def orbit_of(torque: Torque | None) -> tuple[float, float, float]:
    """Return mean motion, eccentricity and mean anomaly of a satellite's orbit."""
    laws = torque.laws if torque else ()
    rate, eccentricity, anomaly = next(law.arguments for law in laws if law.name == "gravity_gradient")
    return rate, eccentricity, anomaly


def _sum_of(name: str, torque: Torque | None) -> Array:
    laws = torque.laws if torque else ()
    total: Array = np.sum([law.arguments[0] for law in laws if law.name == name], axis=0)
    return total


def long_axis(trajectory: Trajectory) -> Array:
    """Return the axis of the least moment (n, 3): along the orbit, on its normal e3, up from the planet."""
    axis = None if trajectory._motion is None else trajectory._motion.long_axis()
    assert axis is not None
    return axis
