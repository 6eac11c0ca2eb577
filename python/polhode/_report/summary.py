"""Summary of a run as numbers for programs; `polhode._report.text` prints it."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode._mechanics.bodies import Inertia
from polhode._mechanics.trajectory import Trajectory
from polhode._scene.scene import Scene
from polhode.torque import Torque


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
        "mass": scene.body.mass if scene.tells_mass else None,
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
