"""The bodies of a scene's ensemble, drawn at random."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from polhode import _native
from polhode._algebra.constructors import bivector, vector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.bodies import Inertia
from polhode._mechanics.parameters import Batch
from polhode._mechanics.state import State
from polhode._support.arrays import Array
from polhode.torque import Torque

DrawnLaw = _native.Law | tuple[str, tuple[Array, ...]]
Drawn = tuple[State, tuple[Inertia, ...], tuple[DrawnLaw, ...]]


@dataclass(frozen=True, eq=False)
class EnsembleSpec:
    """How many bodies a scene has, and in what they differ.

    Attributes
    ----------
    number
        How many bodies.
    seed
        What all that is random follows from.
    varied
        What differs, by its name in `[ensemble]`, and how, in words and SI units.
    """

    number: int
    seed: int
    varied: Mapping[str, str]
    _draws: _native.Draws = field(repr=False)

    @staticmethod
    def _of(draws: _native.Draws) -> EnsembleSpec:
        varied = {name: _words(form, widths, unit) for name, form, widths, unit in draws.varied()}
        return EnsembleSpec(draws.number(), draws.seed(), MappingProxyType(varied), draws)

    def draw(self, first: int = 0, count: int | None = None) -> Drawn:
        """Return bodies from number `first` on, all that follow if `count` is None.

        A body depends on the seed and its number alone: not on how many there are, how many are asked for, or
        what else differs.

        Returns
        -------
        state
            Their states at the start, a batch of shape (count,).
        inertias
            The inertia of each, or the one that all have, about the fixed point if there is one.
        laws
            What turns them, as in `Scene.torque`: a law where all have the same, as a single body has; else
            its name and its arguments, arrays (count,) or (count, m).

        Raises
        ------
        ValueError
            If there are not so many bodies, or none is asked for.
        """
        count = self.number - first if count is None else count
        if first < 0 or count < 0:
            raise ValueError(f"first = {first} and count = {count} must not be negative; see number")
        rotors, omegas, positions, velocities, inertias, laws = self._draws.draw(first, count)
        places, rates = vector(positions), vector(velocities)
        time = self._draws.time()
        state = State(Rotor._from_rows(rotors), bivector(omegas), places, rates, time=time)
        return state, tuple(map(Inertia, inertias)), tuple(laws)


def torque_of(laws: tuple[DrawnLaw, ...]) -> Torque | None:
    """Return the torque that drawn laws make, a batch where bodies differ in it; None without a law."""
    return Torque(tuple(map(_law, laws))) if laws else None


def _law(drawn: DrawnLaw) -> _native.Law:
    if isinstance(drawn, _native.Law):
        return drawn
    name, arguments = drawn
    # A number of each body is a row of one.
    rows = (x if x.ndim > 1 else x[:, np.newaxis] for x in arguments)
    return _native.Law(name, *map(Batch, rows))


def _words(form: str, widths: list[float], unit: str) -> str:
    """Return how something spreads: ``normal, 0.0349066 rad``."""
    if form == "alike":
        return "uniform"
    numbers = [f"{width:g}" for width in (widths[:1] if len(set(widths)) == 1 else widths)]
    size = numbers[0] if len(numbers) == 1 else f"({', '.join(numbers)})"
    return f"{form}, {size}" + (f" {unit}" if unit and form != "relative" else "")
