"""Our motions against the 40-digit reference motions, row by row."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

import machine
import polhode as ph

TABLE = machine.ROOT / "tests" / "reference" / "motion_cases.json"
# The prescribed motion that one case has as its solution has no law in the table.
WITHOUT_LAW = ("manufactured_steady_precession",)
# Cases with numbers that are not floats.
DECIMAL = ("dzhanibekov_001", "toutatis")


@dataclass(frozen=True)
class Outcome:
    """Errors |R − R_true| of the unit rotor with its sign and |ω − ω_true|/|ω_true|, and our estimate."""

    case: str
    time: float
    method: str
    rotor: float
    omega: float
    estimate: float | None
    note: str = ""

    @property
    def is_honest(self) -> bool:
        """Whether the estimate, or the rounding promised without one, is not smaller than the error.

        Without an estimate the motion is exact but for rounding, of the start too, whose decimal numbers are
        not all floats: 1e-14 and, per unit of time, a rounding.
        """
        promised = 0.0 if self.estimate is None else self.estimate
        return self.rotor <= 2 * promised + 1e-14 + 2.0**-52 * abs(self.time)


def outcomes() -> Iterator[Outcome]:
    """Yield the outcome of each row of the table, by the methods that `simulate` chooses."""
    table = json.loads(TABLE.read_text())
    for kind in ("free_top", "torqued", "real_world"):
        for case in table[kind]:
            if case["name"] not in WITHOUT_LAW:
                yield from (_outcome(case, result) for result in case["results"])


def _outcome(case: dict[str, Any], result: dict[str, Any]) -> Outcome:
    name, time = case["name"], float(result["t"])
    inertia = ph.Inertia.from_principal_moments(*_floats(case["inertia"]))
    state = ph.State(ph.Rotor.from_components(_floats(case["R0"])), _floats(case["omega0"]))
    rotor, omega = (np.array([np.longdouble(x) for x in result[key]]) for key in ("R", "omega"))
    try:
        motion = ph.simulate(inertia, state, [time], law(case))
    except ValueError as error:
        return Outcome(name, time, "refused", np.nan, np.nan, None, str(error))
    found = motion.rotor.components[-1], motion.omega_body.components[-1]
    return Outcome(
        name,
        time,
        motion.certificate.method,
        float(np.linalg.norm(found[0] - rotor)),
        float(np.linalg.norm(found[1] - omega) / np.linalg.norm(omega)),
        motion.certificate.error_estimate,
    )


def law(case: dict[str, Any]) -> Any:
    """Return the torque law of a case; None without torque."""
    given = case.get("params", case)
    if "c" in given:
        return ph.torque.heavy(_floats(given["c"]))
    if "b" in given:
        return ph.torque.larmor(_floats(given["b"]))
    if "g" in given:
        return ph.torque.damping(float(given["g"]))
    if "n" in given and "params" in case:
        return ph.torque.gravity_gradient(float(given["n"]))
    return None


def _floats(numbers: list[str]) -> list[float]:
    return [float(x) for x in numbers]
