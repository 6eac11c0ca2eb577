"""Results of a run besides its states: `Certificate`, `Crossings`, `Failure`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.foreign_tables import CROSSINGS
from polhode._mechanics.state import State
from polhode._support.arrays import Array, hands_out_copies
from polhode._support.foreign_names import ListsOwnNames, with_foreign_names


@hands_out_copies()
@dataclass(frozen=True)
class Certificate:
    """How a run was computed, and its drift in conserved quantities.

    For a batch of bodies all numbers are arrays of its shape; the method is one name if all bodies that
    finished have the same, else an array of names. For failed bodies, the error estimate and the drifts are
    NaN.

    Attributes
    ----------
    method, step, steps, evaluations
        Name of the method (``exact`` for the exact solution), longest step in s, and number of steps and of
        torque evaluations in all passes.
    error_estimate
        Conservative estimate of the relative error in rotor and angular velocity: truncation, from the last
        two passes, plus the rounding amplified by the motion, measured by passes with added noise. For the
        exact solution, the error of treating moments that differ by rounding as equal, else None. None for
        a given step; NaN in a batch.
    conserved
        Initial value of each conserved quantity in SI; NaN for a body of a batch that does not conserve it.
    drift
        Largest change of each over the run, relative to the size of its terms.
    norm_drift
        Largest ``abs(|R| − 1)``.
    warnings
        Warnings, such as a law that changes too fast for a fixed step.

    Examples
    --------
    >>> book = ph.Inertia.from_principal_moments(1, 2, 3)
    >>> start = ph.State(ph.Rotor.identity(), [0.1, 1, 0])
    >>> found = ph.simulate(book, start, [10.0], method="rk4", step=0.1).certificate
    >>> found.method, found.steps
    ('rk4', 100)
    >>> sorted(found.conserved)
    ['angular_momentum', 'energy']
    >>> found.conserved["energy"]  # ½ (1·0.1² + 2·1²) J
    1.005
    >>> found.worst < 1e-4
    True
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
        """The largest of all drifts, over the bodies that finished; NaN if none did."""
        if not np.ndim(self.norm_drift):
            return float(max([self.norm_drift, *self.drift.values()]))
        finished = ~np.isnan(self.norm_drift)
        if not finished.any():
            return np.nan
        drifts = self.drift
        largest = ((drifts[name], finished & ~np.isnan(start)) for name, start in self.conserved.items())
        columns = [(self.norm_drift, finished), *largest]
        return float(np.max([np.max(drift, where=where, initial=0.0) for drift, where in columns]))

    def _of(self, index: tuple[Any, ...]) -> Certificate:
        def picked(numbers: Any) -> Any:
            found = np.asarray(numbers[index])
            return found if found.ndim else found.item()

        conserved, drifts = self.conserved, self.drift
        kept = [name for name, start in conserved.items() if not np.all(np.isnan(start[index]))]
        estimate = picked(self.error_estimate)
        return replace(
            self,
            method=self.method if isinstance(self.method, str) else picked(self.method),
            error_estimate=None if np.ndim(estimate) == 0 and np.isnan(estimate) else estimate,
            conserved={name: picked(conserved[name]) for name in kept},
            drift={name: picked(drifts[name]) for name in kept},
            **{name: picked(getattr(self, name)) for name in ("step", "steps", "evaluations", "norm_drift")},
        )


@dataclass(frozen=True)
class Failure:
    """A body of a batch whose motion could not be computed to the end.

    Attributes
    ----------
    index
        Index in the batch.
    time
        Time up to which it was computed, in s.
    message
        The error.

    Examples
    --------
    Of three bodies, the last turns too fast for the step:

    >>> book = ph.Inertia.from_principal_moments(1, 2, 3)
    >>> starts = ph.State(ph.Rotor.identity(), [[0, 0, 1], [0, 1, 0.1], [0, 0.1, 1e4]])
    >>> motions = ph.simulate(book, starts, [1.0], method="rk4", step=0.1)
    >>> motions.ok
    array([ True,  True, False])
    >>> motions.failures[0].index
    (2,)
    """

    index: tuple[int, ...]
    time: float
    message: str

    def __str__(self) -> str:
        return f"at index {self.index} after {self.time:.6g} s: {self.message}"


@with_foreign_names(CROSSINGS)
@hands_out_copies("time", "rising")
@dataclass(frozen=True, eq=False)
class Crossings(metaclass=ListsOwnNames):
    """Times and states of the m occurrences of an event, by increasing distance in time from the start.

    Attributes
    ----------
    name
        Name of the event.
    time
        Times in s, (m,).
    rising
        Whether the quantity passed zero from below, in the direction of integration, (m,).
    rotor, omega_body, position, velocity
        The states at these times, as in `Trajectory`, batch (m,).

    Examples
    --------
    A ball that is thrown up at 9.81 m/s reaches 2 m and comes back through it:

    >>> ball = ph.Body.sphere(0.05, mass=0.5)
    >>> thrown = ph.State(ph.Rotor.identity(), [0, 0, 1], velocity=[0, 0, 9.81])
    >>> level = ph.event.position(ph.e3, 2)
    >>> fall = ph.simulate(ball, thrown, [2.0], force=[0, 0, -0.5 * 9.81], events=level)
    >>> passed = fall.events[0]
    >>> passed.rising
    array([ True, False])
    >>> round(float(passed.time.mean()), 9)  # half way, the ball is at its highest point
    1.0
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
        """The states at these times, a batch (m,), from which `simulate` can continue."""
        return State(self.rotor, self.omega_body, self.position, self.velocity, time=self.time)
