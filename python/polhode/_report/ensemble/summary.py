"""Summary of an ensemble's run: as numbers for programs, and as text for a terminal."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from polhode._report.ensemble.collect import ENDS, LEVELS, NORM, PERIODS, SERIES, EnsembleRecords, first_above
from polhode._report.ensemble.reduced import ReducedRecords
from polhode._report.summary import (
    QUANTITIES,
    Row,
    body_of,
    body_rows,
    law_rows,
    number,
    page,
    time,
    torques_of,
)
from polhode._support.counts import counted
from polhode._support.memory import size

# Angles in rad from the nominal attitude up to which it predicts the others.
_HORIZONS = (np.radians(10), np.radians(90))
# Number of failures, and of times, in the summary.
_TOLD, _TIMES = 5, 6
# Widths of names and quantiles in the text.
_NAMES, _CELLS = 21, 11


Records = EnsembleRecords | ReducedRecords


def summary(records: Records) -> dict[str, Any]:
    """Return the summary in SI units, of values that JSON can hold.

    Quantiles are lists of five, at `LEVELS`, over the bodies that have the number.
    """
    scene, nominal = records.scene, records.nominal
    assert scene.ensemble is not None
    kind = scene.kind
    return {
        "title": scene.name,
        "scene": str(scene.path),
        "ensemble": {
            "number": scene.ensemble.number,
            "seed": scene.ensemble.seed,
            "drawn": scene.ensemble.drawn,
            "varied": dict(scene.ensemble.varied),
            **({} if scene.ensemble.points is None else {"points": scene.ensemble.points}),
            "levels": list(LEVELS),
            "keep": list(scene.ensemble.keep),
        },
        "body": body_of(scene, nominal.inertia),
        "torques": torques_of(scene),
        "forces": [] if scene.force is None else repr(scene.force).split(" + "),
        "motion": {
            "kind": kind,
            "regimes": dict(records.regimes.most_common()),
            "from_nominal": _over_time(records, "from_nominal"),
            "horizons": _horizons(records),
            "axis": records.axis_name,
            "tilt_from": records.tilt_name,
            "tilt": _ends(records, "tilt"),
            "rate": _ends(records, "rate"),
            **{name: _of_bodies(records, name) for name in PERIODS if kind == "free"},
            **{name: _ends(records, name) for name in ENDS},
        },
        "conserved": {name: found for name, found in records.worst().items() if name != NORM},
        "run": _run(records),
        "failures": {
            "count": len(records.failures),
            "first": [
                {"body": failure.index[0], "time": failure.time, "message": failure.message}
                for failure in records.failures[:_TOLD]
            ],
        },
    }


def _of_bodies(records: Records, name: str, k: int | None = None) -> list[float] | None:
    """Return the quantiles over bodies, of a series at the time k; None if no body has a number."""
    found = records.quantiles(name, k)
    return found.tolist() if np.isfinite(found).all() else None


def _over_time(records: Records, name: str) -> list[dict[str, Any]]:
    """Return the quantiles at a few times, including the first and the last."""
    times = records.scene.times
    picked = np.unique(np.linspace(0, len(times) - 1, _TIMES).round().astype(int))
    return [{"time": float(times[k]), "quantiles": _of_bodies(records, name, int(k))} for k in picked]


def _ends(records: Records, name: str) -> dict[str, list[float] | None]:
    """Return the quantiles at the start and at the end."""
    if name in SERIES:
        return {end: _of_bodies(records, name, k) for end, k in (("start", 0), ("end", -1))}
    return {end: _of_bodies(records, f"{name}_{end}") for end in ("start", "end")}


def _horizons(records: Records) -> list[dict[str, Any]]:
    """Return when fewer than 95 % of the bodies are within an angle of the nominal one; None if never."""
    highest = records.quantiles("from_nominal")[-1]
    return [
        {"angle": float(angle), "time": first_above(records.scene.elapsed, highest, angle)}
        for angle in _HORIZONS
    ]


def _run(records: Records) -> dict[str, Any]:
    scene, drifts = records.scene, records.worst()
    worst = [entry["worst"] for entry in drifts.values() if entry["worst"] is not None]
    return {
        "methods": dict(Counter(records.methods).most_common()),
        "steps": records.total_steps,
        "error_estimate": records.error_estimate,
        "rotor_norm_drift": drifts[NORM]["worst"],
        "duration": float(scene.elapsed[-1]),
        "samples": len(scene.times),
        "drift_bound": scene.drift_bound,
        # None if all bodies failed.
        "drift_within_bound": all(drift <= scene.drift_bound for drift in worst) if worst else None,
        "memory": records.bytes_wanted(scene),
    }


# --- as text


def as_text(summary: dict[str, Any]) -> str:
    """Return the summary as a page for a terminal."""
    motion, failures, number = summary["motion"], summary["failures"], summary["ensemble"]["number"]
    some = failures["count"] > 0
    cells = "".join(f"{name:>{_CELLS}}" for name in ("5 %", "25 %", "median", "75 %", "95 %"))
    over = "Over the finished" if some else "Over the bodies"
    sections = {
        "Ensemble": _drawn(summary["ensemble"]),
        "Body": body_rows(summary["body"]),
        "Torques and forces": law_rows(summary),
        "Motion": _motion(motion, number, "those that finished" if some else "the bodies"),
        f"{over:<{_NAMES + 2}} {cells}": _quantiles(motion),
        "Conserved": _conserved(summary),
        "Run": [*_run_rows(summary["run"]), *_failures(failures, number)],
    }
    return page(summary["title"], sections, _NAMES)


def _drawn(ensemble: dict[str, Any]) -> Iterator[Row]:
    points = f" at {ensemble['points']} points" if "points" in ensemble else ""
    drawn = f", drawn from seed {ensemble['seed']}" if ensemble["drawn"] else ""
    yield "bodies", f"{ensemble['number']}{points}{drawn}"
    yield from ensemble["varied"].items()
    if not ensemble["varied"]:
        yield "", "identical: [ensemble] varies nothing"
    if ensemble["keep"]:
        yield "kept", f"{', '.join(ensemble['keep'])}"
        yield "", f"quantiles below have a relative error of up to {ReducedRecords.resolution:.1g}"


def _motion(motion: dict[str, Any], bodies: int, who: str) -> Iterator[Row]:
    for regime, count in motion["regimes"].items():
        yield "regime", f"{regime}: {count} of {counted(bodies, 'body')}"
    for entry in motion["horizons"]:
        until = "to the end" if entry["time"] is None else f"for {time(entry['time'], 4)}"
        words = f"95 % of {who}, {until}, of the nominal one"
        none = "fewer than 95 % from the start"
        yield f"within {np.degrees(entry['angle']):g}°", none if entry["time"] == 0 else words


def _quantiles(motion: dict[str, Any]) -> Iterator[Row]:
    """Yield names and five quantiles; dashes without any."""

    def five(name: str, values: list[float] | None, text: Callable[[float], str] = _five_digits) -> Row:
        cells = ["–"] * 5 if values is None else map(text, values)
        return name, "".join(f"{cell:>{_CELLS}}" for cell in cells)

    for k, entry in enumerate(motion["from_nominal"]):
        name = "attitude off by" if k == 0 else ""
        yield five(f"{name:<15}{time(entry['time'], 3):>6}", entry["quantiles"], _degrees)
    for end in ("start", "end"):
        yield five(f"tilt, {end}", motion["tilt"][end], _degrees)
    for end in ("start", "end"):
        yield five(f"|Ω|, rad/s, {end}", motion["rate"][end])
    for key, name in (("period", "period P_ψ"), ("precession_period", "precession P_φ")):
        if key in motion:
            yield five(name, motion[key], lambda seconds: time(seconds, 5))
    for key, name in (("energy", "energy, J"), ("angular_momentum", "|L|, kg m²/s")):
        # Free bodies conserve both.
        for end in ("start",) if motion["kind"] == "free" else ("start", "end"):
            yield five(f"{name}, {end}", motion[key][end])
    yield "", f"tilt: of {motion['axis']} from {motion['tilt_from']}"


def _degrees(x: float) -> str:
    # Angles of equal attitudes differ from 0 by rounding.
    return f"{np.degrees(x) if abs(x) > 1e-14 else 0.0:.4g}°"


def _five_digits(x: float) -> str:
    return number(x, 5)


def _conserved(summary: dict[str, Any]) -> Iterator[Row]:
    for name, entry in summary["conserved"].items():
        if entry["bodies"]:
            yield QUANTITIES[name][0], f"drift at most {entry['worst']:.1e}, that of body {entry['body']}"
    if (drift := summary["run"]["rotor_norm_drift"]) is not None:
        yield "|R| − 1", f"at most {drift:.1e}"


def _run_rows(run: dict[str, Any]) -> Iterator[Row]:
    yield "duration", f"{time(run['duration'])}, {counted(run['samples'], 'output time')}"
    for method, count in run["methods"].items():
        words = "exact solution" if method == "exact" else method
        yield "method", f"{words}: {counted(count, 'body')}" if len(run["methods"]) > 1 else words
    if run["steps"]:
        yield "steps", f"{run['steps']} of all bodies"
    if run["error_estimate"] is not None:
        yield "error estimate", f"at most {run['error_estimate']:.1e} in attitude and relative rate"
    yield "memory", f"{size(run['memory'])} estimated"
    if run["drift_within_bound"] is False:
        yield "FAILED", f"a conserved quantity drifted by more than {run['drift_bound']:g}"


def _failures(failures: dict[str, Any], bodies: int) -> Iterator[Row]:
    if not failures["count"]:
        return
    yield "FAILED", f"{failures['count']} of {counted(bodies, 'body')} failed before the end"
    for one in failures["first"]:
        yield "", f"body {one['body']}, after {number(one['time'])} s: {one['message']}"
    if failures["count"] > len(failures["first"]):
        yield "", f"and {failures['count'] - len(failures['first'])} more"
