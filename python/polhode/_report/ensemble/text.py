"""Summary of an ensemble's run as text for a terminal."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from polhode._report.text import QUANTITIES, Row, body_rows, law_rows, number, printable, time
from polhode._support.memory import size

# Widths of names and quantiles.
_NAMES, _CELLS = 22, 11


def as_text(summary: dict[str, Any]) -> str:
    """Return the summary as a page for a terminal."""
    motion = summary["motion"]
    lines = [printable(summary["title"]), ""]

    def row(name: str, value: str) -> None:
        lines.append(f"  {name:<{_NAMES - 1}} {value}")

    lines.append("Ensemble")
    _drawn(summary["ensemble"], row)
    lines.append("Body")
    body_rows(summary["body"], row)
    if summary["torques"] or summary["forces"]:
        lines.append("Torques and forces")
        law_rows(summary, row)
    lines.append("Motion")
    who = "those that finished" if summary["failures"]["count"] else "the bodies"
    _motion(motion, summary["ensemble"]["number"], who, row)
    cells = "".join(f"{name:>{_CELLS}}" for name in ("5 %", "25 %", "median", "75 %", "95 %"))
    over = "Over the finished" if summary["failures"]["count"] else "Over the bodies"
    lines.append(f"{over:<{_NAMES + 1}} {cells}")
    _quantiles(motion, row)
    lines.append("Conserved")
    for name, entry in summary["conserved"].items():
        if entry["bodies"]:
            worst = f"drift at most {entry['worst']:.1e}, that of body {entry['body']}"
            row(QUANTITIES[name][0], worst)
    if (drift := summary["run"]["rotor_norm_drift"]) is not None:
        row("|R| − 1", f"at most {drift:.1e}")
    lines.append("Run")
    _run(summary["run"], row)
    _failures(summary["failures"], summary["ensemble"]["number"], row)
    return "\n".join(lines)


def _drawn(ensemble: dict[str, Any], row: Row) -> None:
    row("bodies", f"{ensemble['number']}, drawn from seed {ensemble['seed']}")
    for name, how in ensemble["varied"].items():
        row(name, how)
    if not ensemble["varied"]:
        row("", "identical: [ensemble] varies nothing")


def _motion(motion: dict[str, Any], bodies: int, who: str, row: Row) -> None:
    for regime, count in motion["regimes"].items():
        row("regime", f"{regime}: {count} of {bodies} bodies")
    for entry in motion["horizons"]:
        until = "to the end" if entry["time"] is None else f"for {time(entry['time'], 4)}"
        words = f"95 % of {who}, {until}, of the nominal one"
        row(
            f"within {np.degrees(entry['angle']):g}°",
            words if entry["time"] != 0 else "fewer than 95 % from the start",
        )


def _quantiles(motion: dict[str, Any], row: Row) -> None:
    for k, entry in enumerate(motion["from_nominal"]):
        name = "attitude off by" if k == 0 else ""
        _five(f"{name:<15}{time(entry['time'], 3):>6}", entry["quantiles"], _degrees, row)
    for end in ("start", "end"):
        _five(f"tilt, {end}", motion["tilt"][end], _degrees, row)
    for end in ("start", "end"):
        _five(f"|Ω|, rad/s, {end}", motion["rate"][end], _five_digits, row)
    for key, name in (("period", "period P_ψ"), ("precession_period", "precession P_φ")):
        if key in motion:
            _five(name, motion[key], _short_time, row)
    for key, name in (("energy", "energy, J"), ("angular_momentum", "|L|, kg m²/s")):
        # Free bodies conserve both.
        for end in ("start",) if motion["kind"] == "free" else ("start", "end"):
            _five(f"{name}, {end}", motion[key][end], _five_digits, row)
    row("", f"tilt: of {motion['axis']} from {motion['tilt_from']}")


def _five(name: str, values: list[float] | None, text: Callable[[float], str], row: Row) -> None:
    """Print five quantiles; dashes without any."""
    cells = ["–"] * 5 if values is None else [text(x) for x in values]
    row(name, "".join(f"{cell:>{_CELLS}}" for cell in cells))


def _degrees(x: float) -> str:
    return f"{np.degrees(x):.4g}°"


def _five_digits(x: float) -> str:
    return number(x, 5)


def _short_time(x: float) -> str:
    return time(x, 5)


def _run(run: dict[str, Any], row: Row) -> None:
    row("duration", f"{time(run['duration'])}, {run['samples']} output times")
    for method, count in run["methods"].items():
        words = "exact solution" if method == "exact" else method
        row("method", f"{words}: {count} bodies" if len(run["methods"]) > 1 else words)
    if run["steps"]:
        row("steps", f"{run['steps']} of all bodies")
    if run["error_estimate"] is not None:
        row("error estimate", f"at most {run['error_estimate']:.1e} in attitude and relative rate")
    row("memory", f"{size(run['memory'])} estimated")
    if run["drift_within_bound"] is False:
        row("FAILED", f"a conserved quantity drifted by more than {run['drift_bound']:g}")


def _failures(failures: dict[str, Any], bodies: int, row: Row) -> None:
    if not failures["count"]:
        return
    row("FAILED", f"{failures['count']} of {bodies} bodies failed before the end")
    for one in failures["first"]:
        row("", f"body {one['body']}, after {number(one['time'])} s: {one['message']}")
    if failures["count"] > len(failures["first"]):
        row("", f"and {failures['count'] - len(failures['first'])} more")
