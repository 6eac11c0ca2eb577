"""What is told of a run besides its states: its certificate, its events, its failures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.state import State
from polhode._support.arrays import Array, hands_out_copies


@hands_out_copies(
    "method", "step", "steps", "evaluations", "error_estimate", "conserved", "drift", "norm_drift"
)
@dataclass(frozen=True)
class Certificate:
    """How a run was made, and how far it went astray in what the law conserves.

    Of a batch of bodies all numbers are arrays of its shape; the method is a name where all bodies that were
    followed to the end have the same, else an array of names. For bodies that failed, the error estimate and
    the drifts are NaN.

    Attributes
    ----------
    method, step, steps, evaluations
        The method's name (``exact`` for the exact solution), its longest step in s, and the steps and the
        evaluations of the torque of all passes.
    error_estimate
        Cautious estimate of the relative error in rotor and angular velocity: truncation, from the last two
        passes, and the rounding that the motion magnifies, measured by passes with added noise; of the exact
        solution, what it neglects where moments that differ by rounding count as equal, else None. None for
        a step that was given; NaN in a batch.
    conserved
        Each conserved quantity's initial value in SI; NaN for a body of a batch that does not conserve it.
    drift
        Its largest change over the run, relative to the terms that make it up.
    norm_drift
        Largest ``abs(|R| − 1)``.
    warnings
        What the numbers do not show, such as a law that changes too fast for a fixed step.
    """

    method: Any
    step: Any
    steps: Any
    evaluations: Any
    error_estimate: Any
    conserved: dict[str, Any]
    drift: dict[str, Any]
    norm_drift: Any
    warnings: Sequence[str] = ()

    @property
    def worst(self) -> float:
        """The largest drift of all, over the bodies that were followed to the end; NaN if none was."""
        if not np.ndim(self.norm_drift):
            return float(max([self.norm_drift, *self.drift.values()]))
        finished = ~np.isnan(self.norm_drift)
        if not finished.any():
            return np.nan
        drifts = self.drift
        told = ((drifts[name], finished & ~np.isnan(start)) for name, start in self.conserved.items())
        columns = [(self.norm_drift, finished), *told]
        return float(np.max([np.max(drift, where=where, initial=0.0) for drift, where in columns]))

    def _of(self, index: tuple[Any, ...]) -> Certificate:
        """Return that of some bodies of a batch."""

        def picked(numbers: Any) -> Any:
            found = np.asarray(numbers[index])
            return found if found.ndim else found.item()

        conserved, drifts = self.conserved, self.drift
        kept = [name for name, start in conserved.items() if not np.all(np.isnan(start[index]))]
        estimate = picked(self.error_estimate)
        return Certificate(
            self.method if isinstance(self.method, str) else picked(self.method),
            picked(self.step),
            picked(self.steps),
            picked(self.evaluations),
            None if np.ndim(estimate) == 0 and np.isnan(estimate) else estimate,
            {name: picked(conserved[name]) for name in kept},
            {name: picked(drifts[name]) for name in kept},
            picked(self.norm_drift),
            self.warnings,
        )


@dataclass(frozen=True)
class Failure:
    """A body of a batch that could not be followed to the end.

    Attributes
    ----------
    index
        Its place in the batch.
    time
        Up to when it was followed, in s.
    message
        Why no further.
    """

    index: tuple[int, ...]
    time: float
    message: str

    def __str__(self) -> str:
        return f"at index {self.index} after {self.time:.6g} s: {self.message}"


@hands_out_copies("time", "rising")
@dataclass(frozen=True, eq=False)
class Crossings:
    """When and where an event happened, m times, in the order in which they were met: by `abs(time)`.

    Attributes
    ----------
    name
        What the event is called.
    time
        Times in s, (m,).
    rising
        Whether the quantity passed zero from below, in the direction in which time was followed, (m,).
    rotor, omega_body, position, velocity
        The states there, as in `Trajectory`, batch (m,).
    """

    name: str
    time: Array
    rising: Array
    rotor: Rotor
    omega_body: Multivector
    position: Multivector
    velocity: Multivector

    def __len__(self) -> int:
        return len(self.time)

    @property
    def states(self) -> State:
        """The states there, a batch (m,), from which `simulate` goes on."""
        return State(self.rotor, self.omega_body, self.position, self.velocity, time=self.time)
