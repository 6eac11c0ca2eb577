"""Summary of an ensemble's run as numbers for programs."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._report.ensemble.collect import ENDS, PERIODS, EnsembleRecords
from polhode._report.ensemble.quantiles import LEVELS, first_above, quantiles
from polhode._report.summary import body_of, torques_of
from polhode._support.arrays import Array

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Angles in rad from the nominal attitude up to which it predicts the others.
_HORIZONS = (np.radians(10), np.radians(90))
# Number of failures, and of times, in the summary.
_TOLD, _TIMES = 5, 6


def summary(records: EnsembleRecords) -> dict[str, Any]:
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
            "varied": dict(scene.ensemble.varied),
            "levels": list(LEVELS),
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
            **{name: _of_bodies(records.bodies[name]) for name in PERIODS if kind == "free"},
            **{name: _changes(records, name) for name in ENDS},
        },
        "conserved": {name: _worst(drift) for name, drift in records.drifts.items()},
        "run": _run(records),
        "failures": {
            "count": len(records.failures),
            "first": [
                {"body": failure.index[0], "time": failure.time, "message": failure.message}
                for failure in records.failures[:_TOLD]
            ],
        },
    }


def _of_bodies(values: NDArray[Any]) -> list[float] | None:
    """Return the quantiles over bodies; None if no body has a number."""
    found = quantiles(values)
    return found.tolist() if np.isfinite(found).all() else None


def _over_time(records: EnsembleRecords, name: str) -> list[dict[str, Any]]:
    """Return the quantiles at a few times, including the first and the last."""
    times = records.scene.times
    picked = np.unique(np.linspace(0, len(times) - 1, _TIMES).round().astype(int))
    series = records.series[name]
    return [{"time": float(times[k]), "quantiles": _of_bodies(series[:, k])} for k in picked]


def _ends(records: EnsembleRecords, name: str) -> dict[str, list[float] | None]:
    series = records.series[name]
    return {"start": _of_bodies(series[:, 0]), "end": _of_bodies(series[:, -1])}


def _changes(records: EnsembleRecords, name: str) -> dict[str, list[float] | None]:
    return {end: _of_bodies(records.bodies[f"{name}_{end}"]) for end in ("start", "end")}


def _horizons(records: EnsembleRecords) -> list[dict[str, Any]]:
    """Return when fewer than 95 % of the bodies are within an angle of the nominal one; None if never."""
    highest = quantiles(records.series["from_nominal"])[-1]
    return [
        {"angle": float(angle), "time": first_above(records.scene.elapsed, highest, angle)}
        for angle in _HORIZONS
    ]


def _worst(drift: Array) -> dict[str, Any]:
    """Return the largest drift and the number of its body; None if no body has one."""
    known = np.flatnonzero(~np.isnan(drift))
    if not known.size:
        return {"bodies": 0, "worst": None, "body": None}
    body = int(known[np.argmax(drift[known])])
    return {"bodies": int(known.size), "worst": float(drift[body]), "body": body}


def _run(records: EnsembleRecords) -> dict[str, Any]:
    scene = records.scene
    columns = [records.norm_drifts, *records.drifts.values()]
    worst = [entry["worst"] for entry in map(_worst, columns) if entry["worst"] is not None]
    estimates = records.error_estimates[~np.isnan(records.error_estimates)]
    return {
        "methods": dict(Counter(records.methods).most_common()),
        "steps": int(records.steps.sum()),
        "error_estimate": float(estimates.max()) if estimates.size else None,
        "rotor_norm_drift": _worst(records.norm_drifts)["worst"],
        "duration": float(scene.elapsed[-1]),
        "samples": len(scene.times),
        "drift_bound": scene.drift_bound,
        # None if all bodies failed.
        "drift_within_bound": all(drift <= scene.drift_bound for drift in worst) if worst else None,
        "memory": EnsembleRecords.bytes_wanted(scene),
    }
