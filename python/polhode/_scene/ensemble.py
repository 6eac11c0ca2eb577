"""Ensembles of scenes: bodies drawn at random, about given points."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from polhode import _native
from polhode._algebra.constructors import bivector, vector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.state import State
from polhode._scene.drawn import law_of_bodies
from polhode._support.arrays import Array
from polhode._support.counts import counted
from polhode.torque import Torque

DrawnLaw = _native.Law | tuple[str, tuple[Any, ...]]
Drawn = tuple[State, tuple[Inertia, ...], Torque | None]


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
        What varies, in words and SI units: the distribution of each random quantity by its name in
        `[ensemble]`, and the number of values of a grid, list or table by their path in the scene.
    keep
        What is kept of each motion instead of the motion, see `Scene.reduce`; empty if the motions are kept.
    points
        Number of points of the grid, list or table; None without. Body i is at point ``i % points``.
    table_sha256
        SHA-256 of the content of the table (of a Parquet file's numbers as CSV); None without.
    """

    number: int
    seed: int
    varied: Mapping[str, str]
    points: int | None
    table_sha256: str | None
    _core: _native.Scene = field(repr=False)
    keep: tuple[str, ...] = ()

    @staticmethod
    def _of(core: _native.Scene, table_sha256: str | None = None) -> EnsembleSpec | None:
        """Return the ensemble of a scene; None without one."""
        if (found := core.ensemble()) is None:
            return None
        number, seed, varied, points = found
        words = {}
        if points is not None:
            form, _, paths = points
            words = {path: f"{form}, {count} value{'s' * (count > 1)}" for path, count in paths}
        for name, form, widths, unit in varied:
            own = _words(form, widths, unit)
            words[name] = f"{words[name]}; {own}" if name in words else own
        count = None if points is None else points[1]
        kept = tuple(core.ensemble_keep())
        return EnsembleSpec(number, seed, MappingProxyType(words), count, table_sha256, core, kept)

    @property
    def drawn(self) -> bool:
        """Whether quantities are drawn at random, from the seed; else all come from a grid, list or table."""
        found = self._core.ensemble()
        return found is not None and bool(found[2])

    def _varies(self, *places: str) -> bool:
        """Whether one of these quantities or tables of the scene varies, or a value in it."""
        return any(
            name == place or name.startswith((f"{place}.", f"{place}["))
            for name in self.varied
            for place in places
        )

    def given(self, first: int = 0, count: int | None = None) -> dict[str, Array | list[str]]:
        """Return the values that the grid, list or table gives to `count` bodies from number `first` on.

        Returns
        -------
        dict
            For each path in the scene an array (count,) or (count, m): quantities with units in SI units,
            other numbers as in the file. If a value is not a number or an array of them, the text of each;
            that of a string, such as a formula, without its quotes.

        Raises
        ------
        ValueError
            If the range is out of bounds or empty.
        """
        return {path: values for path, values, _ in self._given(first, self._count(first, count))}

    def _given(self, first: int, count: int) -> list[tuple[str, Array | list[str], str]]:
        """Return the paths, values and units of `given`."""
        return self._core.given(first, count)

    def _count(self, first: int, count: int | None) -> int:
        """Return the number of bodies in a range, if it is within bounds."""
        count = self.number - first if count is None else count
        if first < 0 or count < 0:
            raise ValueError(f"first and count must not be negative, got first = {first}, count = {count}")
        if count == 0 or first + count > self.number:
            raise ValueError(
                f"range {first}..{first + count} is out of bounds for {counted(self.number, 'body')}"
            )
        return count

    def draw(self, first: int = 0, count: int | None = None) -> Drawn:
        """Return `count` bodies from number `first` on; all remaining ones if `count` is None.

        A body depends on its point, the seed and its number only, not on `first`, `count` or other varied
        quantities.

        Returns
        -------
        state
            Their states at the start, a batch of shape (count,).
        inertias
            The inertia of each body, or one for all; about the fixed point if there is one.
        torque
            Their torque for `polhode.simulate`, in which laws that differ between the bodies are batches
            (count,); None without. Forces are not drawn: they are in `Scene.force`.

        Raises
        ------
        ValueError
            If the range is out of bounds or empty, or if names in a formula have values of other grades for
            other bodies.

        Examples
        --------
        The motion of body 7 alone, a batch (1,)::

            state, inertias, torque = scene.ensemble.draw(7, 1)
            motion = ph.simulate(inertias, state, scene.times, torque)
        """
        count = self._count(first, count)
        rotors, omegas, positions, velocities, inertias, laws = self._core.draw(first, count)
        center = vector(positions), vector(velocities)
        time = self._core.fields()["time"]
        state = State(Rotor._from_rows(rotors), bivector(omegas), *center, time=time)
        torque = Torque(tuple(map(law_of_bodies, laws))) if laws else None
        return state, tuple(map(Inertia, inertias)), torque

    def laws(self, first: int = 0, count: int | None = None) -> tuple[DrawnLaw, ...]:
        """Return the torque laws of `count` bodies from number `first` on, in the order of the scene.

        A law that is the same for all bodies; else its name and its arguments, arrays (count,) or (count, m),
        or for a formula the law of each body.
        """
        return tuple(self._core.draw(first, self._count(first, count))[5])


def _words(form: str, widths: list[float], unit: str) -> str:
    """Return a distribution in words: ``normal, 0.0349066 rad``."""
    if form == "alike":
        return "uniform"
    numbers = [f"{width:g}" for width in (widths[:1] if len(set(widths)) == 1 else widths)]
    size = numbers[0] if len(numbers) == 1 else f"({', '.join(numbers)})"
    return f"{form}, {size}" + (f" {unit}" if unit and form != "relative" else "")
