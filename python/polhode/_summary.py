"""What a physicist wants to know of a run: as numbers for programs, and as a page for people."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode._arrays import Array
from polhode._free_motion import SymmetricTop, describe_free
from polhode._scene import Scene
from polhode._trajectory import Trajectory
from polhode._values import vector

# Within this of each other two moments are equal for the purpose of words: that of a real body's data.
_NEARLY = 1e-6

# An angle that grows by less than this between samples, in rad, is followed without doubt.
_FOLLOWED = 2.0

_SECONDS = ((120.0, 1.0, "s"), (7200.0, 60.0, "min"), (172800.0, 3600.0, "h"), (6e7, 86400.0, "d"))


def summary(scene: Scene, trajectory: Trajectory) -> dict[str, Any]:
    """Return the summary in SI units; everything in it is a number, text, None, a list or a dict."""
    moments = trajectory.inertia.principal_moments
    proof = trajectory.certificate
    result: dict[str, Any] = {
        "title": trajectory.attributes["title"],
        "scene": str(scene.path),
        "body": {
            "mass": scene.body.mass if scene.tells_mass else None,
            "center_of_mass": scene.body.center_of_mass.components.tolist(),
            "principal_moments": moments.tolist(),
            "moment_ratios": (np.sort(moments) / moments.min()).tolist(),
            "principal_axes": trajectory.inertia.principal_frame.to_matrix().T.tolist(),
        },
        "motion": _free_motion(scene, trajectory)
        if scene.weight is None
        else _heavy_motion(scene.weight, scene, trajectory),
        "conserved": {
            name: {"value": value, "drift": proof.drift[name]} for name, value in proof.conserved.items()
        },
        "run": {
            "method": proof.method,
            "step": proof.step,
            "steps": proof.steps,
            "error_estimate": proof.error_estimate,
            "rotor_norm_drift": proof.norm_drift,
            "duration": float(scene.times[-1]),
            "samples": len(scene.times),
            "drift_bound": scene.drift_bound,
            "drift_within_bound": bool(proof.worst <= scene.drift_bound),
        },
    }
    return result


def _free_motion(scene: Scene, trajectory: Trajectory) -> dict[str, Any]:
    motion = describe_free(trajectory.inertia, scene.state.omega_body)
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
    exact = top.at(trajectory.time)
    motion["closed_form"] = {
        "largest_rotor_difference": float(np.max((exact.rotor - trajectory.rotor).norm())),
        "largest_omega_difference": float(np.max((exact.omega_body - trajectory.omega_body).norm())),
    }
    return motion


def _reversals(trajectory: Trajectory) -> dict[str, Any] | None:
    """Count sign changes of the spin about the axis of the middle moment, and their mean distance."""
    middle = int(np.argsort(trajectory.inertia.principal_moments, kind="stable")[1])
    spin = (~trajectory.inertia.principal_frame)(trajectory.omega_body).components[:, middle]
    at = np.flatnonzero(np.sign(spin[:-1]) * np.sign(spin[1:]) < 0)
    if at.size < 2:
        return None
    t, before, after = trajectory.time, spin[at], spin[at + 1]
    moments = t[at] + (t[at + 1] - t[at]) * before / (before - after)
    return {"count": int(at.size), "mean_interval": float(np.diff(moments).mean())}


def _heavy_motion(c: Array, scene: Scene, trajectory: Trajectory) -> dict[str, Any]:
    """Tell how the line from the fixed point to the centre of mass moves, and the fast top's precession."""
    motion: dict[str, Any] = {"kind": "heavy", "regime": "heavy body about a fixed point"}
    size = float(np.linalg.norm(c))
    motion["mgl"] = size
    if size == 0:
        return motion
    axis = c / size
    path = trajectory.rotor(vector(axis)).components
    tilt = np.arctan2(np.hypot(path[:, 0], path[:, 1]), path[:, 2])
    motion["tilt_min"], motion["tilt_max"] = float(tilt.min()), float(tilt.max())
    motion["precession_rate"] = _precession_rate(trajectory, path)
    matrix = trajectory.inertia.matrix
    along = float(axis @ matrix @ axis)
    if _is_symmetric_about(matrix, axis):
        motion["regime"] = "symmetric top under gravity"
        spin = float(axis @ scene.state.omega_body.components)
        motion["spin"] = spin
        motion["fast_top_precession_rate"] = size / (along * spin) if spin else None
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
    return float((azimuth[-1] - azimuth[0]) / trajectory.time[-1])


def _is_symmetric_about(matrix: Array, axis: Array) -> bool:
    """Whether the inertia looks the same after any turn about the axis."""
    scale = float(np.abs(matrix).max())
    across = matrix - np.outer(axis, axis) * float(axis @ matrix @ axis)
    equal = 0.5 * np.trace(across) * (np.eye(3) - np.outer(axis, axis))
    return bool(np.abs(across - equal).max() <= _NEARLY * scale)


# --- as a page


def as_text(summary: dict[str, Any], columns: int = 18) -> str:
    """Return the summary as a page for a terminal."""
    body, motion, run = summary["body"], summary["motion"], summary["run"]
    lines = ["".join(c if c.isprintable() else "\ufffd" for c in summary["title"]), ""]

    def section(name: str) -> None:
        lines.append(name)

    def row(name: str, value: str) -> None:
        lines.append(f"  {name:<{columns}}{value}")

    section("Body")
    row(
        "mass",
        "not given, and free motion ignores it" if body["mass"] is None else f"{_number(body['mass'])} kg",
    )
    row("centre of mass", f"{_three(body['center_of_mass'])} m")
    about = " about the fixed point" if motion["kind"] == "heavy" else ""
    row("principal moments", f"{_three(body['principal_moments'])} kg m²{about}")
    row("their ratios", " : ".join(f"{x:.4g}" for x in body["moment_ratios"]))
    section("Motion")
    (_heavy_rows if motion["kind"] == "heavy" else _free_rows)(motion, row)
    section("Conserved")
    for name, entry in summary["conserved"].items():
        label, unit = _QUANTITIES[name]
        row(label, f"{_number(entry['value'], 10)} {unit}, drift {entry['drift']:.1e}")
    row("|R| − 1", f"{run['rotor_norm_drift']:.1e}")
    section("Run")
    row("duration", f"{_time(run['duration'])}, {run['samples']} output times")
    if run["method"] == "exact":
        row("method", "exact solution in elliptic functions")
    else:
        row("method", f"{run['method']}, {run['steps']} steps of at most {_number(run['step'])} s")
    if run["error_estimate"] is not None:
        row("error estimate", f"{run['error_estimate']:.1e} in attitude and relative rate")
    if not run["drift_within_bound"]:
        row("FAILED", f"a conserved quantity drifted by more than {run['drift_bound']:g}")
    return "\n".join(lines)


_QUANTITIES = {
    "energy": ("energy", "J"),
    "angular_momentum": ("|L|", "kg m²/s"),
    "vertical_angular_momentum": ("L about e3", "kg m²/s"),
    "axial_angular_momentum": ("L about the field", "kg m²/s"),
    "spin_angular_momentum": ("L about the body's axis", "kg m²/s"),
    "kovalevskaya_integral": ("Kovalevskaya's K", "rad⁴/s⁴"),
    "goryachev_chaplygin_integral": ("Goryachev, Chaplygin", "rad³/s³"),
    "jacobi_integral": ("Jacobi's integral", "J"),
}


def _free_rows(motion: dict[str, Any], row: Any) -> None:
    axis = motion["axis"]
    words = {
        "short-axis mode": f"short-axis mode: ω circles axis {axis}, that of the largest moment",
        "long-axis mode": f"long-axis mode: ω circles axis {axis}, that of the smallest moment",
    }
    row("regime", words.get(motion["regime"], motion["regime"]))
    if motion["period"] is not None:
        row("modulus k", _number(motion["modulus"], 10))
        row("period of ω", f"{_time(motion['period'])} in the body")
        row("precession", f"{_time(motion['precession_period'])} for one turn about L, on average")
    if motion["flip_time"] is not None and motion["modulus"] > 0.9:
        text = f"every {_time(motion['flip_time'])} about the middle axis (half a period)"
        found = motion["reversals"]
        if found:
            text += f"; seen: {found['count']}, every {_time(found['mean_interval'])}"
        row("flips", text)
    if "closed_form" in motion:
        difference = motion["closed_form"]["largest_rotor_difference"]
        row("closed form", f"handout eq. (4.35): the rotor differs by at most {difference:.1e}")


def _heavy_rows(motion: dict[str, Any], row: Any) -> None:
    row("regime", motion["regime"])
    row("m g l", f"{_number(motion['mgl'])} N m")
    if "precession_rate" not in motion:
        return
    degrees = [np.degrees(motion[key]) for key in ("tilt_min", "tilt_max")]
    row("tilt from up", f"{degrees[0]:.6g}° to {degrees[1]:.6g}°")
    rate, fast = motion["precession_rate"], motion.get("fast_top_precession_rate")
    if rate is None:
        row("precession", "not followed: the output times are too far apart")
    else:
        row("precession", f"{_number(rate)} rad/s on average")
    if fast is not None:
        off = "" if rate is None else f"; the average is off by {rate / fast - 1:+.2e}"
        row("fast-top formula", f"{_number(fast)} rad/s, m g l/(i3 ω3){off}")


def _number(x: float, digits: int = 6) -> str:
    return f"{x:.{digits}g}"


def _three(values: list[float]) -> str:
    """Return three components; what is rounding beside the largest reads 0."""
    floor = 1e-12 * max(abs(x) for x in values)
    return ", ".join(_number(x if abs(x) > floor else 0.0) for x in values)


def _time(seconds: float) -> str:
    for below, unit, name in _SECONDS:
        if abs(seconds) < below:
            return f"{_number(seconds / unit)} {name}"
    return f"{_number(seconds / (365.25 * 86400))} yr"
