"""The summary of an ensemble's run as numbers for programs."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._report.describe import kind_of
from polhode._report.ensemble.collect import ENDS, PERIODS, Gathered
from polhode._report.ensemble.quantiles import LEVELS, first_above, quantiles
from polhode._report.summary import body_of, torques_of
from polhode._support.arrays import Array

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Angles in rad that the attitude passes when nothing can be foretold within them.
_HORIZONS = (np.radians(10), np.radians(90))
# How many failures are told one by one, and of how many times the attitude is told.
_TOLD, _TIMES = 5, 6


def summary(gathered: Gathered) -> dict[str, Any]:
    """Return the summary in SI units; everything in it is a number, text, None, a list or a dict.

    Quantiles are lists of five, at `LEVELS`, over the bodies that there is a number of.
    """
    scene, nominal = gathered.scene, gathered.nominal
    assert scene.ensemble is not None
    kind = kind_of(scene)
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
            "regimes": dict(gathered.regimes.most_common()),
            "from_nominal": _over_time(gathered, "from_nominal"),
            "horizons": _horizons(gathered),
            "axis": gathered.axis_name,
            "tilt_from": gathered.tilt_name,
            "tilt": _ends(gathered, "tilt"),
            "rate": _ends(gathered, "rate"),
            **{name: _of_bodies(gathered.bodies[name]) for name in PERIODS if kind == "free"},
            **{name: _changes(gathered, name) for name in ENDS},
        },
        "conserved": {name: _worst(drift) for name, drift in gathered.drifts.items()},
        "run": _run(gathered),
        "failures": {
            "count": len(gathered.failures),
            "first": [
                {"body": failure.index[0], "time": failure.time, "message": failure.message}
                for failure in gathered.failures[:_TOLD]
            ],
        },
    }


def _of_bodies(values: NDArray[Any]) -> list[float] | None:
    """Return the quantiles of a number of each body; None if there is none."""
    found = quantiles(values)
    return found.tolist() if np.isfinite(found).all() else None


def _over_time(gathered: Gathered, name: str) -> list[dict[str, Any]]:
    """Return the quantiles at a few times, the first and the last among them."""
    times = gathered.scene.times
    picked = np.unique(np.linspace(0, len(times) - 1, _TIMES).round().astype(int))
    series = gathered.series[name]
    return [{"time": float(times[k]), "quantiles": _of_bodies(series[:, k])} for k in picked]


def _ends(gathered: Gathered, name: str) -> dict[str, list[float] | None]:
    series = gathered.series[name]
    return {"start": _of_bodies(series[:, 0]), "end": _of_bodies(series[:, -1])}


def _changes(gathered: Gathered, name: str) -> dict[str, list[float] | None]:
    return {end: _of_bodies(gathered.bodies[f"{name}_{end}"]) for end in ("start", "end")}


def _horizons(gathered: Gathered) -> list[dict[str, Any]]:
    """Return until when 95 % of the bodies are within an angle of the nominal one; None to the end."""
    highest = quantiles(gathered.series["from_nominal"])[-1]
    return [
        {"angle": float(angle), "time": first_above(gathered.scene.elapsed, highest, angle)}
        for angle in _HORIZONS
    ]


def _worst(drift: Array) -> dict[str, Any]:
    """Return the largest drift and the number of its body; None where no body has one."""
    known = np.flatnonzero(~np.isnan(drift))
    if not known.size:
        return {"bodies": 0, "worst": None, "body": None}
    body = int(known[np.argmax(drift[known])])
    return {"bodies": int(known.size), "worst": float(drift[body]), "body": body}


def _run(gathered: Gathered) -> dict[str, Any]:
    scene = gathered.scene
    columns = [gathered.norm_drifts, *gathered.drifts.values()]
    worst = [entry["worst"] for entry in map(_worst, columns) if entry["worst"] is not None]
    estimates = gathered.error_estimates[~np.isnan(gathered.error_estimates)]
    return {
        "methods": dict(Counter(gathered.methods).most_common()),
        "steps": int(gathered.steps.sum()),
        "error_estimate": float(estimates.max()) if estimates.size else None,
        "rotor_norm_drift": _worst(gathered.norm_drifts)["worst"],
        "duration": float(scene.elapsed[-1]),
        "samples": len(scene.times),
        "drift_bound": scene.drift_bound,
        # None if no body was followed to the end.
        "drift_within_bound": all(drift <= scene.drift_bound for drift in worst) if worst else None,
        "memory": Gathered.bytes_wanted(scene),
    }
