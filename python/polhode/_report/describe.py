"""What can be said of a motion: its kind by the torques that act, then its regime, periods and bounds."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.constructors import vector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.closed_forms import LagrangeTop
from polhode._mechanics.free_motion import SymmetricTop, describe_free
from polhode._mechanics.problem import Problem
from polhode._mechanics.trajectory import Trajectory
from polhode._scene.scene import Scene
from polhode._support.arrays import Array
from polhode.torque import Torque

# An angle that grows by less than this between samples, in rad, is followed without doubt.
_FOLLOWED = 2.0


def kind_of(scene: Scene | Problem) -> str:
    """Return the kind of motion, by the laws that turn the body."""
    names = _turning(scene)
    if "gravity_gradient" in names:
        return "satellite"
    kinds = {"heavy": "heavy", "gyrostat": "gyrostat", "damping": "damped"}
    return kinds.get(names.pop(), "torqued") if len(names) == 1 else "torqued" if names else "free"


def _turning(scene: Scene | Problem) -> set[str]:
    """Return the names of what turns the body: torque laws, and a thrust with a place where it acts."""
    laws = scene.torque.laws if scene.torque else ()
    pushes = scene.force.laws if scene.force else ()
    thrusts = {law.name for law in pushes if law.name == "thrust" and len(law.arguments) == 2}
    return {law.name for law in laws} | thrusts


def weight(torque: Torque | None) -> Array:
    """Return ``c = m g (centre of mass)`` (3,) of a held body, in N m."""
    return _sum_of("heavy", torque)


def wheel(torque: Torque | None) -> Array:
    """Return the momentum of all wheels (3,) in body axes, in kg m²/s."""
    return _sum_of("gyrostat", torque)


def orbit_of(torque: Torque | None) -> tuple[float, float, float]:
    """Return mean motion, eccentricity and mean anomaly of a satellite's orbit."""
    laws = torque.laws if torque else ()
    rate, eccentricity, anomaly = next(law.arguments for law in laws if law.name == "gravity_gradient")
    return rate, eccentricity, anomaly


def _sum_of(name: str, torque: Torque | None) -> Array:
    laws = torque.laws if torque else ()
    total: Array = np.sum([law.arguments[0] for law in laws if law.name == name], axis=0)
    return total


# Heavy bodies that have an integral of their own, by its name.
_INTEGRABLE = {
    "kovalevskaya_integral": "Kovalevskaya's top",
    "goryachev_chaplygin_integral": "Goryachev's and Chaplygin's top",
}


def describe(scene: Scene, trajectory: Trajectory) -> dict[str, Any]:
    """Return what is known of a motion in SI units; its ``kind`` says which keys there are."""
    laws = scene.torque.laws if scene.torque else ()
    match kind_of(scene):
        case "free":
            motion = _free(scene, trajectory)
        case "heavy":
            motion = _heavy(weight(scene.torque), scene, trajectory)
        case "gyrostat":
            motion = _gyrostat(wheel(scene.torque), trajectory)
        case "damped":
            motion = _damped(float(_sum_of("damping", scene.torque)), scene, trajectory)
        case "satellite":
            motion = _satellite(orbit_of(scene.torque), trajectory)
        case _:
            motion = {"kind": "torqued", "regime": "under torque"}
    targets = [law.arguments[-1] for law in laws if law.name in ("pd_control", "torsion_spring")]
    if targets:
        motion["from_target"] = _distances(np.array(targets[0]), trajectory)
    if _turning(scene) - {"heavy", "gyrostat"}:
        motion["changes"] = {
            "rate": _ends(np.linalg.norm(trajectory.omega_body.components, axis=1)),
            "angular_momentum": _ends(np.linalg.norm(trajectory.momentum_space.components, axis=1)),
        }
    if scene.force is not None or np.any(scene.state.velocity.components):
        for name in ("position", "velocity"):
            rows = getattr(trajectory, name).components
            motion[name] = {"start": rows[0].tolist(), "end": rows[-1].tolist()}
    return motion


def _ends(values: Array) -> dict[str, float]:
    return {"start": float(values[0]), "end": float(values[-1])}


def _range(values: Array) -> list[float]:
    return [float(values.min()), float(values.max())]


# --- without a torque


def _free(scene: Scene, trajectory: Trajectory) -> dict[str, Any]:
    motion = _described(scene, trajectory)
    motion["kind"] = "free"
    flip = motion["flip_time"]
    sampled = flip is not None and float(np.diff(trajectory.time).max()) < 0.25 * flip
    motion["reversals"] = _reversals(trajectory) if sampled else None
    if trajectory.certificate.method == "exact":
        return motion
    try:
        top = SymmetricTop(trajectory.inertia, scene.state.rotor, scene.state.omega_body)
    except ValueError:
        return motion
    exact = top.at(trajectory.time - scene.state.time)
    motion["closed_form"] = {
        "largest_rotor_difference": float(np.max((exact.rotor - trajectory.rotor).norm())),
        "largest_omega_difference": float(np.max((exact.omega_body - trajectory.omega_body).norm())),
    }
    return motion


def _described(scene: Scene, trajectory: Trajectory) -> dict[str, Any]:
    """What the invariants at the start tell; of a symmetric top its wobbles per turn about its axis too."""
    motion = describe_free(trajectory.inertia, scene.state.omega_body)
    if motion["regime"].startswith("symmetric") and motion["precession_rate"] is not None:
        spin = (~trajectory.inertia.principal_frame)(scene.state.omega_body).components[motion["axis"] - 1]
        motion["wobbles_per_turn"] = abs(motion["precession_rate"] / float(spin)) if spin else None
    return motion


def _reversals(trajectory: Trajectory) -> dict[str, Any] | None:
    """Count sign changes of the spin about the axis of the middle moment, and their mean distance."""
    middle = int(np.argsort(trajectory.inertia.principal_moments, kind="stable")[1])
    spin = (~trajectory.inertia.principal_frame)(trajectory.omega_body).components[:, middle]
    moments = _crossings(trajectory.time, spin)
    if moments.size < 2:
        return None
    return {"count": int(moments.size), "mean_interval": float(np.diff(moments).mean())}


def _crossings(t: Array, values: Array) -> Array:
    """Return the times at which values change their sign, by straight lines between samples."""
    at = np.flatnonzero(np.sign(values[:-1]) * np.sign(values[1:]) < 0)
    before, after = values[at], values[at + 1]
    crossings: Array = t[at] + (t[at + 1] - t[at]) * before / (before - after)
    return crossings


def _gyrostat(h: Array, trajectory: Trajectory) -> dict[str, Any]:
    """Tell how far L, seen from the body, goes from the axis of the wheel."""
    motion: dict[str, Any] = {"kind": "gyrostat", "regime": "body with a wheel, no torque from outside"}
    size = float(np.linalg.norm(h))
    motion["wheel"] = [float(x) for x in h]
    momentum = (~trajectory.rotor)(trajectory.momentum_space).components
    motion["momentum_size"] = float(np.linalg.norm(momentum[0]))
    if size:
        across = np.linalg.norm(np.cross(momentum, h / size), axis=1)
        motion["from_wheel"] = _range(np.arctan2(across, momentum @ (h / size)))
    return motion


def _damped(g: float, scene: Scene, trajectory: Trajectory) -> dict[str, Any]:
    """Tell of the free motion at the start, which goes on in the time ``(1 − e^(−gt))/g``."""
    motion = _described(scene, trajectory)
    return {
        **motion,
        "kind": "damped",
        "damping": float(g),
        "halved_after": float(np.log(2) / g) if g else None,
    }


# --- about a fixed point


def _heavy(c: Array, scene: Scene, trajectory: Trajectory) -> dict[str, Any]:
    """Tell how the line from the fixed point to the centre of mass moves."""
    motion: dict[str, Any] = {"kind": "heavy", "regime": "heavy body about a fixed point"}
    size = float(np.linalg.norm(c))
    motion["mgl"] = size
    for integral, name in _INTEGRABLE.items():
        if integral in trajectory.certificate.conserved:
            motion["regime"] = f"{name} about a fixed point"
    if size == 0:
        return motion
    try:
        top = LagrangeTop(trajectory.inertia, scene.state.rotor, scene.state.omega_body, c)
    except ValueError:
        path = trajectory.rotor(vector(c / size)).components
        tilt = np.arctan2(np.hypot(path[:, 0], path[:, 1]), path[:, 2])
        motion["tilt_min"], motion["tilt_max"] = _range(tilt)
        motion["precession_rate"] = _precession_rate(trajectory, path)
        return motion
    motion.update(top.describe())
    motion["kind"] = "lagrange"
    spin = float(c / size @ scene.state.omega_body.components)
    motion["spin"] = spin
    motion["fast_top_precession_rate"] = size / motion["axial_momentum"] if motion["axial_momentum"] else None
    return motion


def _precession_rate(trajectory: Trajectory, path: Array) -> float | None:
    """Return the mean rate of a path's azimuth; None if the samples are too far apart to follow it."""
    spin = trajectory.rotor(trajectory.omega_body).components
    across = np.maximum(np.hypot(path[:, 0], path[:, 1]), np.finfo(float).tiny)
    # The azimuth's rate is at most the speed ω x n of the direction over its distance from the vertical.
    fastest = float((np.linalg.norm(np.cross(spin, path), axis=1) / across).max())
    if fastest * float(np.diff(trajectory.time).max()) > _FOLLOWED:
        return None
    azimuth = np.unwrap(np.arctan2(path[:, 1], path[:, 0]))
    return float((azimuth[-1] - azimuth[0]) / np.ptp(trajectory.time))


# --- on an orbit


def long_axis(orbit: tuple[float, float, float], trajectory: Trajectory) -> Array:
    """Return the axis of the least moment (n, 3): along the orbit, on its normal e3, up from the planet."""
    up = _native.orbit_directions(*orbit, np.ascontiguousarray(trajectory.time))
    normal = np.broadcast_to([0.0, 0.0, 1.0], up.shape)
    axes = np.stack([np.cross(normal, up), normal, up], axis=1)
    direction: Array = np.einsum("nij,nj->ni", axes, _principal_direction(trajectory, 0))
    return direction


def _principal_direction(trajectory: Trajectory, k: int) -> Array:
    """Return the direction in space (n, 3) of the principal axis of the k-th smallest moment."""
    inertia = trajectory.inertia
    axis = int(np.argsort(inertia.principal_moments, kind="stable")[k])
    return np.array(trajectory.rotor(vector(inertia.principal_frame.to_matrix()[:, axis])).components)


def _satellite(orbit: tuple[float, float, float], trajectory: Trajectory) -> dict[str, Any]:
    """Tell how the axes of the least and the largest moment swing about the vertical and the normal.

    Small swings in the plane of a circular orbit, with the axes of the moments a < b < c up, along the
    orbit and on its normal, follow ``θ'' = −3 n² (b − a)/c θ``.
    """
    along, across, up = long_axis(orbit, trajectory).T
    x, y, z = _principal_direction(trajectory, 2).T
    bound = bool((np.sign(up) == np.sign(up[0])).all())
    rate, (a, b, c) = abs(orbit[0]), np.sort(trajectory.inertia.principal_moments)
    swings = _crossings(trajectory.time, along * np.sign(up)) if bound else np.empty(0)
    stiffness = 3 * (b - a) / c
    small = float(2 * np.pi / (rate * np.sqrt(stiffness))) if rate and stiffness else None
    return {
        "kind": "satellite",
        "regime": "librating about the vertical" if bound else "turning over, not held by the gradient",
        "orbital_period": 2 * np.pi / rate if rate else None,
        "eccentricity": orbit[1],
        "from_vertical": _range(np.arctan2(np.hypot(along, across), np.abs(up))),
        "from_normal": _range(np.arctan2(np.hypot(x, y), np.abs(z))),
        "libration_period": 2 * float(np.diff(swings).mean()) if swings.size > 2 else None,
        "small_libration_period": small,
    }


# --- towards an attitude


def _distances(target: Array, trajectory: Trajectory) -> dict[str, float]:
    """Return the angle between the attitude and the target, at the start and at the end."""
    turn = ((~Rotor._from_rows(target)) * trajectory.rotor).components
    return _ends(2 * np.arctan2(np.linalg.norm(turn[:, 1:], axis=1), np.abs(turn[:, 0])))
