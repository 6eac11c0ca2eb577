"""The motion of a fit under torques at the times of its data, with derivatives by central differences."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode._algebra.constructors import bivector
from polhode._algebra.rotor import Rotor
from polhode._fit.laws import Laws
from polhode._fit.parameters import Layout, Parameters
from polhode._mechanics.simulate import simulate
from polhode._mechanics.state import State
from polhode._support.arrays import Array

# Tolerance of the integration; its error at output times is of about this size.
_TOLERANCE = 1e-12
# Change of the motion, in rad, between the two points of a difference. The error of a derivative relative to
# its largest value is about _CHANGE²/24 of truncation and _TOLERANCE/_CHANGE of the integration, less than
# 1e-8 together. Steps are corrected once if a change is not within these factors: the error is up to 1e-6.
_CHANGE, _WITHIN = 2e-4, (0.005, 20.0)
_LARGEST = 1e6  # factor of a correction


class TorquedFlow:
    """Attitudes and angular velocities of the axes of the data; times count from `start` on its clock."""

    precision = 1e-7

    def __init__(self, layout: Layout, laws: Laws, start: float) -> None:
        self._layout, self._laws, self._start = layout, laws, start

    def states(self, at: Parameters, of_attitudes: Array, of_rates: Array) -> tuple[Rotor, Array]:
        """Return rotors (n,) and angular velocities (m, 3) at the times; a ValueError if the run fails."""
        rotors, rates = self._batch([at], of_attitudes, of_rates)
        return rotors[0], rates[0]

    def derivatives(self, at: Parameters, of_attitudes: Array, of_rates: Array) -> tuple[Array, Array, Array]:
        """Return turns in space axes (n, 3, k), and those of the rates (m, 3, k) and (m, 3) by time.

        The 2k motions of a difference are one batch. Their steps follow from the change of the motion.
        """
        rate = float(np.linalg.norm(at.omega)) or 1.0
        times = np.concatenate([of_attitudes, of_rates])
        turn = rate * float(np.ptp(times))
        steps = 0.5 * _CHANGE * self._sizes(at, rate, turn)
        turns, rates = self._differences(at, steps, of_attitudes, of_rates)
        change = np.maximum(_largest(turns), _largest(rates) / rate)
        factors = np.clip(_CHANGE / np.maximum(change, _CHANGE / _LARGEST), 1 / _LARGEST, _LARGEST)
        if ((factors * _WITHIN[0] > 1) | (factors * _WITHIN[1] < 1)).any():
            steps = steps * factors
            turns, rates = self._differences(at, steps, of_attitudes, of_rates)
        return turns / (2 * steps), rates / (2 * steps), self._by_time(at, of_rates, rate)

    def _sizes(self, at: Parameters, rate: float, turn: float) -> Array:
        sizes, of = np.ones(self._layout.motion), self._layout.places
        sizes[of["omega"]] = rate
        sizes[of["torque"]] = self._laws.sizes(at.torque, np.exp(at.scale), rate, turn)
        return sizes

    def _differences(self, at: Parameters, steps: Array, of_attitudes: Array, of_rates: Array) -> Any:
        """Return the changes of attitudes (n, 3, k) and rates (m, 3, k) between −steps and steps."""
        rows = np.concatenate([np.diag(steps), -np.diag(steps)])
        # At a lower bound of a parameter the pair is moved up: an error of first order in the small step.
        of = self._layout.places["torque"]
        raised = np.maximum(self._laws.least - (at.torque - steps[of]), 0.0)
        for k, lift in enumerate(raised):
            rows[[of.start + k, len(steps) + of.start + k], of.start + k] += lift
        points = [self._layout.moved(at, row) for row in rows]
        rotors, rates = self._batch(points, of_attitudes, of_rates)
        k = len(steps)
        turns = (rotors[:k] * ~rotors[k:]).to_rotation_vector()
        return np.moveaxis(turns, 0, -1), np.moveaxis(rates[:k] - rates[k:], 0, -1)

    def _by_time(self, at: Parameters, of_rates: Array, rate: float) -> Array:
        """Return derivatives (m, 3) of the rates by time."""
        if not self._layout.offset:
            return np.zeros((len(of_rates), 3))
        h = 0.5 * _CHANGE / rate
        none = np.empty(0)
        (ahead,), (behind,) = (self._batch([at], none, of_rates + s)[1] for s in (h, -h))
        return np.asarray((ahead - behind) / (2 * h))

    def _batch(self, points: list[Parameters], of_attitudes: Array, of_rates: Array) -> tuple[Rotor, Array]:
        """Return rotors (k, n) and angular velocities (k, m, 3) of these points."""
        wanted = np.concatenate([of_attitudes, of_rates])
        times, places = np.unique(wanted, return_inverse=True)
        bodies: Any = np.empty(len(points), dtype=object)
        bodies[:] = [x.inertia for x in points]
        rotors = [(Rotor.identity() if x.rotor is None else x.rotor).components for x in points]
        state = State(
            Rotor._from_rows(np.array(rotors)),
            bivector(np.array([x.omega for x in points])),
            time=self._start,
        )
        # Rounding may leave a parameter below its bound.
        values = np.maximum([x.torque for x in points], self._laws.least)
        torque = self._laws.with_values(values)
        motion = simulate(
            bodies, state, times + self._start, torque, method="dop853", rtol=_TOLERANCE, atol=_TOLERANCE
        )
        if motion.failures:
            raise ValueError(f"a motion of the search fails: {motion.failures[0].message}")
        n = len(of_attitudes)
        return motion.rotor[:, places[:n]], motion.omega_body[:, places[n:]].components


def _largest(changes: Array) -> Array:
    """Return the largest components (k,) of changes (n, 3, k)."""
    return np.abs(changes).max(axis=(0, 1)) if len(changes) else np.zeros(changes.shape[-1])
