"""Table of a motion for notebooks."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape

import numpy as np

from polhode._mechanics.trajectory import Trajectory
from polhode._report.summary import Row, number


def as_html(trajectory: Trajectory) -> str:
    """Return a table of shape, times, regime and certificate, as HTML."""
    title = str(trajectory.attributes.get("title", "Trajectory"))
    rows = "".join(
        f'<tr><th style="text-align: left">{escape(name)}</th>'
        f'<td style="text-align: left">{escape(value)}</td></tr>'
        for name, value in _rows(trajectory)
    )
    return f"<table><caption>{escape(title)}</caption><tbody>{rows}</tbody></table>"


def _rows(trajectory: Trajectory) -> Iterator[Row]:
    times, proof = trajectory.time, trajectory.certificate
    if trajectory.shape:
        yield "bodies", " × ".join(map(str, trajectory.shape))
    span = f", from {number(times[0])} s to {number(times[-1])} s" if len(times) else ""
    yield "output times", f"{len(times)}{span}"
    if trajectory._motion is not None and (regime := trajectory._motion.describe().get("regime")):
        yield "regime", regime
    yield "method", _method(trajectory)
    if proof.error_estimate is not None and np.any(np.isfinite(proof.error_estimate)):
        yield "error estimate", f"{np.nanmax(proof.error_estimate):.1e}"
    if not np.isnan(proof.worst):
        names = ", ".join([*proof.conserved, "rotor norm"]).replace("_", " ")
        yield "largest drift", f"{proof.worst:.1e} of {names}"
    for event in trajectory.events:
        yield f"event {event.name}", str(len(event))
    if trajectory.failures:
        yield "failed", f"{len(trajectory.failures)}, the first {trajectory.failures[0]}"
    for warning in proof.warnings:
        yield "warning", warning


def _method(trajectory: Trajectory) -> str:
    proof = trajectory.certificate
    if not isinstance(proof.method, str):
        return ", ".join(map(str, np.unique(proof.method[trajectory.ok])))
    if proof.method == "exact":
        return "exact"
    longest = np.max(proof.step, initial=0.0, where=~np.isnan(proof.step))
    return f"{proof.method}, {np.sum(proof.steps)} steps of at most {number(float(longest))} s"
