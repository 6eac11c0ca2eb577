"""Summary of a run: as numbers for programs, and as text for a terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

import numpy as np

from polhode._mechanics.inertia import Inertia
from polhode._mechanics.registry import TORQUES
from polhode._mechanics.trajectory import Trajectory
from polhode._scene.scene import Scene
from polhode._support.counts import counted
from polhode.torque import Torque

# Width of the names of rows.
_COLUMNS = 17

# Name and value.
Row = tuple[str, str]

# (upper bound in s, unit in s, name of the unit)
_SECONDS = ((120.0, 1.0, "s"), (7200.0, 60.0, "min"), (172800.0, 3600.0, "h"), (6e7, 86400.0, "d"))

QUANTITIES = {
    "energy": ("energy", "J"),
    "angular_momentum": ("|L|", "kg m²/s"),
    "vertical_angular_momentum": ("L about e3", "kg m²/s"),
    "axial_angular_momentum": ("L about the field", "kg m²/s"),
    "spin_angular_momentum": ("L about its axis", "kg m²/s"),
    "kovalevskaya_integral": ("Kovalevskaya's K", "rad⁴/s⁴"),
    "goryachev_chaplygin_integral": ("Goryachev's G", "rad³/s³"),
    "jacobi_integral": ("Jacobi's integral", "J"),
}


def summary(scene: Scene, trajectory: Trajectory) -> dict[str, Any]:
    """Return the summary in SI units, of values that JSON can hold."""
    assert trajectory._motion is not None
    proof = trajectory.certificate
    drifts = (proof.norm_drift, *proof.drift.values())
    return {
        "title": trajectory.attributes["title"],
        "scene": str(scene.path),
        "body": body_of(scene, trajectory.inertia),
        "torques": torques_of(scene),
        "forces": [] if scene.force is None else repr(scene.force).split(" + "),
        "motion": trajectory._motion.describe(),
        "conserved": {
            name: {"value": value, "drift": proof.drift[name]} for name, value in proof.conserved.items()
        },
        "run": {
            "method": proof.method,
            "step": proof.step,
            "steps": proof.steps,
            "evaluations": proof.evaluations,
            "error_estimate": proof.error_estimate,
            "rotor_norm_drift": proof.norm_drift,
            "duration": float(scene.elapsed[-1]),
            "samples": len(scene.times),
            "drift_bound": scene.drift_bound,
            # Not by max(), which may lose a NaN.
            "drift_within_bound": all(drift <= scene.drift_bound for drift in drifts),
        },
    }


def body_of(scene: Scene, inertia: Inertia) -> dict[str, Any]:
    """Return the body, with the inertia that determines its motion."""
    moments = inertia.principal_moments
    return {
        "mass": scene.body.mass if scene.has_mass else None,
        "center_of_mass": scene.body.center_of_mass.components.tolist(),
        "held": scene.held,
        "principal_moments": moments.tolist(),
        "moment_ratios": (np.sort(moments) / moments.min()).tolist(),
        "principal_axes": inertia.principal_frame.to_matrix().T.tolist(),
    }


def torques_of(scene: Scene) -> list[dict[str, Any]]:
    """Return each law: name in `polhode.torque`, call, arguments, and formula as in the scene."""
    laws = scene.torque.laws if scene.torque else ()
    return [
        {
            "law": law.name,
            "call": repr(Torque((law,))),
            "arguments": [_plain(argument) for argument in law.arguments],
            "formula": formula,
        }
        for law, formula in zip(laws, scene.formulas, strict=True)
    ]


def _plain(argument: Any) -> Any:
    """Return an argument of a law as a value that JSON can hold."""
    if isinstance(argument, tuple):
        return [_plain(x) for x in argument]
    return argument if isinstance(argument, (str, float)) else str(argument)


# --- as text


def as_text(summary: dict[str, Any]) -> str:
    """Return the summary as a page for a terminal."""
    motion = summary["motion"]
    sections = {
        "Body": body_rows(summary["body"]),
        "Torques and forces": law_rows(summary),
        "Motion": [*_KINDS[motion["kind"]](motion), *_changes(motion)],
        "Conserved": _conserved(summary),
        "Run": _run(summary["run"], motion["kind"]),
    }
    return page(summary["title"], sections, _COLUMNS)


def page(title: str, sections: Mapping[str, Iterable[Row]], width: int) -> str:
    """Return a page of sections, without those that have no rows; `width` is that of the names of rows.

    Control characters in the title are replaced.
    """
    lines = ["".join(c if c.isprintable() else "\ufffd" for c in title), ""]
    for heading, rows in sections.items():
        if written := [f"  {name:<{width}} {value}" for name, value in rows]:
            lines += [heading, *written]
    return "\n".join(lines)


def body_rows(body: dict[str, Any]) -> Iterator[Row]:
    """Yield the rows of the body."""
    mass = body["mass"]
    yield "mass", "not given; the motion does not depend on it" if mass is None else f"{number(mass)} kg"
    yield "centre of mass", f"{_listed(body['center_of_mass'])} m"
    about = " about the fixed point" if body["held"] else ""
    yield "principal moments", f"{_listed(body['principal_moments'])} kg m²{about}"
    yield "moment ratios", " : ".join(f"{x:.4g}" for x in body["moment_ratios"])


def law_rows(summary: dict[str, Any]) -> Iterator[Row]:
    """Yield the torques and forces."""
    for law in summary["torques"]:
        yield _law(law)
    for force in summary["forces"]:
        yield "force", force


def _law(law: dict[str, Any]) -> Row:
    """Return the name and the arguments of a torque law; a formula as it stands in the scene."""
    name, arguments = law["law"], law["arguments"]
    if name == "formula":
        return f"torque_{arguments[1]}", " ".join(law["formula"].split())
    if name not in TORQUES or name == "tabulated":
        return name, law["call"].partition("(")[2].removesuffix(")")
    texts = []
    for argument, value in zip(TORQUES[name].arguments, arguments, strict=True):
        equal = argument.shape == "gains" and len(set(value)) == 1
        text = number(value[0] if equal else value) if equal or argument.shape == "scalar" else _listed(value)
        unit = "" if argument.unit == "1" else " " + argument.unit.replace("^2", "²")
        texts.append(f"{argument.name} = {text}{unit}")
    return name, "; ".join(texts)


def _conserved(summary: dict[str, Any]) -> Iterator[Row]:
    for name, entry in summary["conserved"].items():
        label, unit = QUANTITIES[name]
        yield label, f"{number(entry['value'], 10)} {unit}, drift {entry['drift']:.1e}"
    yield "|R| − 1", f"{summary['run']['rotor_norm_drift']:.1e}"


def _run(run: dict[str, Any], kind: str) -> Iterator[Row]:
    yield "duration", f"{time(run['duration'])}, {counted(run['samples'], 'output time')}"
    if run["method"] == "exact":
        elliptic = kind in ("free", "damped", "lagrange")
        yield "method", "exact solution in elliptic functions" if elliptic else "exact solution"
    else:
        yield "method", f"{run['method']}, {run['steps']} steps of at most {number(run['step'])} s"
        yield "evaluations", f"{run['evaluations']} of the torque"
    if run["error_estimate"] is not None:
        yield "error estimate", f"{run['error_estimate']:.1e} in attitude and relative rate"
    if not run["drift_within_bound"]:
        yield "FAILED", f"a conserved quantity drifted by more than {run['drift_bound']:g}"


# --- the kinds of motion


def _free(motion: dict[str, Any]) -> Iterator[Row]:
    axis = motion["axis"]
    words = {
        "short-axis mode": f"short-axis mode: ω circles axis {axis}, the axis of the largest moment",
        "long-axis mode": f"long-axis mode: ω circles axis {axis}, the axis of the smallest moment",
    }
    yield "regime", words.get(motion["regime"], motion["regime"])
    periodic = motion["period"] is not None
    if periodic:
        yield "modulus k", number(motion["modulus"], 10)
        yield "period of ω", f"{time(motion['period'])} in the body"
        yield "precession", f"{time(motion['precession_period'])} per turn about L, on average"
        turns = motion["phase_per_period"] / (2 * np.pi)
        yield "phase", f"{number(turns, 8)} turns about L per period"
    if motion.get("wobbles_per_turn") is not None:
        yield "wobbles", f"{number(motion['wobbles_per_turn'], 8)} per turn about axis {axis}"
    if periodic:
        yield "angle to L", f"{_angles(motion['wobble_min'], motion['wobble_max'])} from axis {axis}"
    if motion["wobble_period"] is not None:
        yield "small wobbles", f"period {time(motion['wobble_period'])}"
    if motion["flip_time"] is not None and motion["modulus"] > 0.9:
        text = f"every {time(motion['flip_time'])} about the middle axis (half a period)"
        if found := motion.get("reversals"):
            text += f"; {found['count']} in this run, every {time(found['mean_interval'])}"
        yield "flips", text
    if "closed_form" in motion:
        difference = motion["closed_form"]["largest_rotor_difference"]
        yield "closed form", f"handout eq. (4.35): the rotor differs by at most {difference:.1e}"


def _damped(motion: dict[str, Any]) -> Iterator[Row]:
    if (after := motion["halved_after"]) is not None:
        yield "damping", "free motion, slowed exponentially"
        yield "half-life of ω", time(after)
    elif (after := motion["doubled_after"]) is not None:
        yield "damping", "negative: free motion, sped up exponentially"
        yield "doubling time of ω", time(after)
    else:
        yield "damping", "none: the rates g add up to 0"
    yield from _free(motion)
    if motion["period"] is not None:
        yield "", "(periods at the initial rate)"


def _gyrostat(motion: dict[str, Any]) -> Iterator[Row]:
    yield "regime", motion["regime"]
    share = np.linalg.norm(motion["wheel"]) / motion["momentum_size"] if motion["momentum_size"] else 0.0
    if share:
        yield "wheel", f"{number(100 * share, 4)} % of |L|"
    if "from_wheel" in motion:
        yield "angle to L", f"{_angles(*motion['from_wheel'])} from the wheel's axis"


def _lagrange(motion: dict[str, Any]) -> Iterator[Row]:
    yield "regime", f"symmetric top under gravity, {motion['regime']}"
    yield from _tilt(motion)
    if motion["nutation_period"] is not None:
        yield "nutation period", time(motion["nutation_period"])
    if motion["precession_rate"] is not None:
        yield (
            "precession",
            f"{number(motion['precession_rate'])} rad/s on average, "
            f"{time(abs(motion['precession_period']))} per turn",
        )
        if (fast := motion["fast_top_precession_rate"]) is not None:
            off = motion["precession_rate"] / fast - 1
            yield (
                "fast-top formula",
                f"{number(fast)} rad/s, m g l/(i3 ω3); the average differs by {off:+.2e}",
            )
    stable = "stable" if motion["sleeps"] else "unstable"
    yield (
        "upright",
        f"{stable} at the spin {number(motion['spin'])} rad/s; "
        f"critical spin {number(motion['critical_spin'])} rad/s",
    )


def _heavy(motion: dict[str, Any]) -> Iterator[Row]:
    yield "regime", motion["regime"]
    if "tilt_min" not in motion:
        yield "", "held at its centre of mass"
        return
    yield from _tilt(motion)
    rate = motion["precession_rate"]
    if rate is None:
        yield "precession", "unknown: the output times are too far apart"
    else:
        yield "precession", f"{number(rate)} rad/s on average"


def _tilt(motion: dict[str, Any]) -> Iterator[Row]:
    yield "m g l", f"{number(motion['mgl'])} N m"
    yield "tilt", f"{_angles(motion['tilt_min'], motion['tilt_max'])} from the vertical"


def _satellite(motion: dict[str, Any]) -> Iterator[Row]:
    yield "regime", motion["regime"]
    if motion["orbital_period"] is not None:
        yield "orbit", f"{time(motion['orbital_period'])}, eccentricity {number(motion['eccentricity'])}"
    yield "long axis", f"{_angles(*motion['from_vertical'])} from the vertical"
    yield "short axis", f"{_angles(*motion['from_normal'])} from the orbit's normal"
    if motion["libration_period"] is not None:
        yield "libration", f"{time(motion['libration_period'])} per swing in the orbit plane, on average"
    if motion["small_libration_period"] is not None:
        yield "small librations", f"period {time(motion['small_libration_period'])} in the orbit plane"


_KINDS: dict[str, Callable[[dict[str, Any]], Iterable[Row]]] = {
    "free": _free,
    "damped": _damped,
    "gyrostat": _gyrostat,
    "lagrange": _lagrange,
    "heavy": _heavy,
    "satellite": _satellite,
    "torqued": lambda motion: [("regime", motion["regime"])],
}


def _changes(motion: dict[str, Any]) -> Iterator[Row]:
    """Yield rate, momentum, attitude and position at the start and at the end."""
    for key, name, unit in (("rate", "|ω|", "rad/s"), ("angular_momentum", "|L|", "kg m²/s")):
        if "changes" in motion:
            ends = motion["changes"][key]
            yield name, f"{number(ends['start'])} {unit} at the start, {number(ends['end'])} at the end"
    if "from_target" in motion:
        degrees = [f"{number(float(np.degrees(motion['from_target'][k])))}°" for k in ("start", "end")]
        yield "from the target", f"{degrees[0]} at the start, {degrees[1]} at the end"
    for key, unit in (("position", "m"), ("velocity", "m/s")):
        if key in motion:
            yield key, f"({_listed(motion[key]['start'])}) to ({_listed(motion[key]['end'])}) {unit}"


# --- numbers


def number(x: float, digits: int = 6) -> str:
    """Return a number rounded to significant digits."""
    return f"{x:.{digits}g}"


def _listed(values: list[float]) -> str:
    """Return components; those below 1e-12 of the largest as 0."""
    floor = 1e-12 * max(abs(x) for x in values)
    return ", ".join(number(x if abs(x) > floor else 0.0) for x in values)


def _angles(low: float, high: float) -> str:
    """Return a range of angles in degrees; one angle if both print alike."""
    first, last = (f"{np.degrees(x):.6g}°" for x in (low, high))
    return first if first == last else f"{first} to {last}"


def time(seconds: float, digits: int = 6) -> str:
    """Return a time in s, min, h, d or yr."""
    for below, unit, name in _SECONDS:
        if abs(seconds) < below:
            return f"{number(seconds / unit, digits)} {name}"
    return f"{number(seconds / (365.25 * 86400), digits)} yr"
