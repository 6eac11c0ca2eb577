"""Attitudes from parameters and back: single values and a hundred, where most time is that of the call."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

import peers
import polhode as ph
from contest import Pace, Read, Row

COUNTS = (1, 100)


class Task(NamedTuple):
    """The same task in several libraries, where R and S are their rotations."""

    what: str
    ours: str
    scipy: str
    quaternion: str = ""


def _same(x: Any) -> Any:
    return x


def _rotors(found: Any) -> Any:
    """Matrices of rotors or Rotations, which do not depend on signs."""
    return found.to_matrix() if isinstance(found, ph.Rotor) else found.as_matrix()


TASKS: tuple[tuple[Task, Read], ...] = (
    (Task("rotor from axis and angle", "new.from_axis_angle(n, theta)", "new.from_rotvec(v)"), _rotors),
    (Task("rotor from Euler angles", "new.from_euler('zyx', e)", "new.from_euler('zyx', e)"), _rotors),
    (Task("rotor from a matrix", "new.from_matrix(m)", "new.from_matrix(m)"), _rotors),
    (Task("rotor from a quaternion", "new.from_quaternion(q, order='xyzw')", "new.from_quat(q)"), _rotors),
    (Task("matrix", "R.to_matrix()", "R.as_matrix()", "read(R)"), _same),
    (Task("Euler angles", "R.to_euler('zyx')", "R.as_euler('zyx')"), _same),
    (Task("quaternion", "R.canonical().to_quaternion(order='xyzw')", "R.as_quat(canonical=True)"), _same),
    (Task("rotation vector", "R.to_rotation_vector()", "R.as_rotvec()"), _same),
    (Task("angle", "R.angle", "R.magnitude()"), _same),
    (Task("angle between two", "R.distance(S)", "(R.inv() * S).magnitude()"), _same),
    (Task("half the turn", "R ** 0.5", "R ** 0.5"), _rotors),
)


def rows(rng: np.random.Generator, _: Pace) -> Iterator[Row]:
    """Yield all tasks for each number of values."""
    for count in COUNTS:
        for task, read in TASKS:
            yield row(rng, count, task, read)


def row(rng: np.random.Generator, count: int, task: Task, read: Read) -> Row:
    """Return a task for some values; the time is for each."""
    shape = () if count == 1 else (count,)
    made = Row(task.what if count == 1 else f"{task.what}, of {count}", count=count)
    R, S = ph.Rotor.random(shape, rng).canonical(), ph.Rotor.random(shape, rng)
    axis, theta = np.array(rng.standard_normal((*shape, 3))), rng.uniform(0, 3, shape)
    axis /= np.linalg.norm(axis, axis=-1, keepdims=True)
    given = {
        "n": axis,
        "theta": theta if count > 1 else float(theta),
        "v": axis * np.expand_dims(theta, -1),
        "e": R.to_euler("zyx"),
        "m": R.to_matrix(),
        "q": R.to_quaternion(order="xyzw"),
    }
    made.enter("polhode", task.ours, {"new": ph.Rotor, "R": R, "S": S, **given}, read)
    with made.peer("SciPy"):
        from scipy.spatial.transform import Rotation

        made.enter(
            "SciPy", task.scipy, {"new": Rotation, "R": R.to_scipy(), "S": S.to_scipy(), **given}, read
        )
    if task.quaternion:
        with made.peer("numpy-quaternion"):
            from quaternion import as_rotation_matrix

            names = {"R": peers.quaternion(R), "read": as_rotation_matrix}
            made.enter("numpy-quaternion", task.quaternion, names, read)
    return made
