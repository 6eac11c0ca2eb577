"""Ensembles of scenes: bodies drawn at random."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from polhode import _native
from polhode._algebra.constructors import bivector, vector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.bodies import Inertia
from polhode._mechanics.state import State
from polhode._support.arrays import Array

DrawnLaw = _native.Law | tuple[str, tuple[Array, ...]]
Drawn = tuple[State, tuple[Inertia, ...], tuple[DrawnLaw, ...]]


@dataclass(frozen=True, eq=False)
class EnsembleSpec:
    """The table `[ensemble]` of a scene: number of bodies, seed, and what varies.

    Attributes
    ----------
    number
        Number of bodies.
    seed
        Random seed.
    varied
        Distribution of each varied quantity, in words and SI units, by its name in `[ensemble]`.
    """

    number: int
    seed: int
    varied: Mapping[str, str]
    _core: _native.Scene = field(repr=False)

    @staticmethod
    def _of(core: _native.Scene) -> EnsembleSpec | None:
        """Return the ensemble of a scene; None without one."""
        if (found := core.ensemble()) is None:
            return None
        number, seed, varied = found
        words = {name: _words(form, widths, unit) for name, form, widths, unit in varied}
        return EnsembleSpec(number, seed, MappingProxyType(words), core)

    def draw(self, first: int = 0, count: int | None = None) -> Drawn:
        """Return `count` bodies from number `first` on; all remaining ones if `count` is None.

        A body depends on the seed and its number only, not on `first`, `count` or other varied quantities.

        Returns
        -------
        state
            Their states at the start, a batch of shape (count,).
        inertias
            The inertia of each body, or one for all; about the fixed point if there is one.
        laws
            The torque laws, as in `Scene.torque`: a law if it is the same for all bodies; else its name and
            its arguments, arrays (count,) or (count, m).

        Raises
        ------
        ValueError
            If the range is out of bounds or empty.
        """
        count = self.number - first if count is None else count
        if first < 0 or count < 0:
            raise ValueError(f"first and count must not be negative, got first = {first}, count = {count}")
        rotors, omegas, positions, velocities, inertias, laws = self._core.draw(first, count)
        center = vector(positions), vector(velocities)
        time = self._core.fields()["time"]
        state = State(Rotor._from_rows(rotors), bivector(omegas), *center, time=time)
        return state, tuple(map(Inertia, inertias)), tuple(laws)

    def laws(self, first: int, count: int) -> tuple[DrawnLaw, ...]:
        """Return the torque laws of some bodies, as `draw` does."""
        return tuple(self._core.draw(first, count)[5])


def _words(form: str, widths: list[float], unit: str) -> str:
    """Return a distribution in words: ``normal, 0.0349066 rad``."""
    if form == "alike":
        return "uniform"
    numbers = [f"{width:g}" for width in (widths[:1] if len(set(widths)) == 1 else widths)]
    size = numbers[0] if len(numbers) == 1 else f"({', '.join(numbers)})"
    return f"{form}, {size}" + (f" {unit}" if unit and form != "relative" else "")
