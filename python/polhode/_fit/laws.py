"""Fitted parameters of torque laws: names, units and bounds, and the torque of their values."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from polhode import torque as laws_of_torque
from polhode._algebra.constructors import bivector, scalar, vector
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.registry import TORQUES
from polhode._mechanics.state import State
from polhode._support.arrays import Array
from polhode.torque import Torque

_NUMBERS = {"scalar": 1, "gains": 3, "vector": 3, "bivector": 3}
# Sizes of parameters by their unit, as powers of moment of inertia and of angular velocity.
_POWERS = {
    "1/s": (0, 1),
    "rad/s": (0, 1),
    "N m": (1, 2),
    "N m s": (1, 1),
    "N m s^2": (1, 0),
    "kg m^2/s": (1, 1),
}
# A body and states at which torques are compared: any without symmetry.
_MOMENTS = (1.0, 1.7, 2.3)
_TURNS = ((0.3, -0.8, 0.5), (1.9, 0.4, -1.1), (-0.6, 1.3, 2.0))
_RATE = (0.7, -1.1, 0.9)
_SAME = 1e-12  # relative difference of torques that are equal up to rounding


@dataclass(frozen=True, eq=False)
class Argument:
    """An argument of a law that is fitted: its place in the torque, component names, and start values."""

    law: int
    place: int | str  # number among the arguments of the law, or name of a value of a formula
    kind: str  # as in the registry
    names: tuple[str, ...]
    unit: str
    values: Array
    least: float = -np.inf

    def __len__(self) -> int:
        return len(self.names)


@dataclass(frozen=True, eq=False)
class Laws:
    """A torque, and those of its arguments that are fitted."""

    torque: Torque
    arguments: tuple[Argument, ...]

    @property
    def size(self) -> int:
        """Number of parameters."""
        return sum(map(len, self.arguments))

    @property
    def names(self) -> list[str]:
        """Names of the parameters."""
        return [name for x in self.arguments for name in x.names]

    def units(self, scaling: Array | None) -> list[str]:
        """Return the units; those relative to the largest moment have it as a denominator."""
        units = [x.unit.replace("^2", "²") for x in self.arguments for _ in x.names]
        if scaling is None:
            return units
        return [f"{x} / (kg m²)".strip() if p else x for x, p in zip(units, scaling, strict=True)]

    @property
    def values(self) -> Array:
        """Start values (q,)."""
        return np.concatenate([np.empty(0), *(x.values for x in self.arguments)])

    @property
    def least(self) -> Array:
        """Lower bounds (q,)."""
        return np.repeat([x.least for x in self.arguments], [len(x) for x in self.arguments])

    def sizes(self, values: Array, moment: float, rate: float, turn: float) -> Array:
        """Return sizes (q,): the value of the argument, or if larger what turns the body by a radian."""
        found: list[float] = []
        for x, part in zip(self.arguments, self._parts(values), strict=True):
            a, b = _POWERS.get(x.unit, (0, 0))
            natural = moment**a * rate**b / (1 + turn) if x.unit in _POWERS else 0.0
            found += [max(float(np.linalg.norm(part)), natural) or 1.0] * len(x)
        return np.array(found)

    def with_values(self, values: Array) -> Torque:
        """Return the torque with these values (..., q) of the parameters, a batch (...)."""
        new: dict[int, dict[int | str, Any]] = {}
        for x, part in zip(self.arguments, self._parts(values), strict=True):
            new.setdefault(x.law, {})[x.place] = _argument(x.kind, part)
        laws = [_with(law, new[k]).laws[0] if k in new else law for k, law in enumerate(self.torque.laws)]
        return Torque(tuple(laws))

    def _parts(self, values: Array) -> Iterator[Array]:
        """Yield the values (..., n) of each argument."""
        begin = 0
        for x in self.arguments:
            yield values[..., begin : begin + len(x)]
            begin += len(x)

    def depends_on_attitude(self, start: float) -> bool:
        """Return whether the torque in the body depends on the attitude."""
        torque = self._at_test_values()
        seen = [_torque(torque, _MOMENTS, turn, start) for turn in _TURNS]
        return any(not _is_close(x, seen[0]) for x in seen)

    def scaling(self, start: float) -> Array | None:
        """Return powers (q,) of the moments, by which the parameters scale without a change of the motion.

        Powers are 0 or 1. None if there are none: then the scale of the moments changes the motion.
        """
        torque, powers = self._at_test_values(), []
        for k, law in enumerate(torque.laws):
            own = [x for x in self.arguments if x.law == k]
            choices = itertools.product((1, 0), repeat=len(own))
            found = next((p for p in choices if _scales(law, own, p, start)), None)
            if found is None:
                return None
            powers += [float(p) for p, x in zip(found, own, strict=True) for _ in x.names]
        return np.array(powers)

    def strength(self, start: float, rotor: Rotor | None, rates: Array) -> float:
        """Return the rms of the torque in N m at these rates (n, 3), of a body with moments of 1 kg m²."""
        torque, attitude = self.with_values(self.values), Rotor.identity() if rotor is None else rotor
        ball = Inertia.from_principal_moments(1, 1, 1)
        some = rates[:: max(1, len(rates) // 20)]
        seen = [torque.at(ball, State(attitude, bivector(x)), start).components for x in some]
        return float(np.sqrt(3 * np.mean(np.square(seen)))) or 1.0

    def _at_test_values(self) -> Torque:
        """Return the torque at values that are not 0, where each of them has an effect."""
        return self.with_values(np.linspace(0.3, 0.6, self.size))


def laws_of(torque: Any, free: Any) -> Laws:
    """Return the checked torque and the arguments that `free` names: of laws, or ``law.argument``."""
    if isinstance(free, str) or not isinstance(free, Iterable):
        raise TypeError(f"free must be a sequence of names, such as ('heavy',), got {free!r}")
    names = list(free)
    if torque is None:
        if names:
            raise ValueError(f"free names parameters of a torque, {names}; give the torque with start values")
        return Laws(Torque(()), ())
    if not isinstance(torque, Torque):
        torque = laws_of_torque.function(torque)
    if torque.shape:
        raise ValueError(f"the torque must be that of a single body, got batch shape {torque.shape}")
    if any(law.name == "gravity" for law in torque.laws):
        raise ValueError(
            "gravity takes the mass and centre of a known body; give ph.torque.heavy(c), c = m g times the "
            "centre of mass relative to the fixed point"
        )
    known = {label: x for k in range(len(torque.laws)) for label, x in _arguments(torque, k)}
    chosen: list[Argument] = []
    for name in names:
        own = [x for label, x in known.items() if label == name or label.partition(".")[0] == name]
        if not own:
            raise ValueError(
                f"free has {name!r}, which is not among the parameters of the torque: "
                f"{', '.join(known) or 'none of its laws can be fitted'}"
            )
        if any(x in chosen for x in own):
            raise ValueError(f"free has {name!r}, which is named twice")
        chosen += own
    order = list(known.values())
    return Laws(torque, tuple(sorted(chosen, key=order.index)))


def _arguments(torque: Torque, k: int) -> Iterator[tuple[str, Argument]]:
    """Yield the arguments of law number k that can be fitted, with their names."""
    law = torque.laws[k]
    same = [i for i, other in enumerate(torque.laws) if other.name == law.name]
    title = law.name if len(same) == 1 else f"{law.name}[{same.index(k)}]"
    if law.name == "formula":
        for name, value in law.arguments[2]:
            if kind := _kind(value):
                rows = np.atleast_1d(np.array(value.components if kind != "scalar" else float(value), float))
                yield f"{title}.{name}", Argument(k, name, kind, _names(title, name, len(rows)), "", rows)
        return
    entry = TORQUES.get(law.name)
    if entry is None or any(x.shape not in (*_NUMBERS, "rotor") for x in entry.arguments):
        return
    for place, (about, value) in enumerate(zip(entry.arguments, law.arguments, strict=True)):
        if about.shape == "rotor":
            continue
        rows = np.atleast_1d(np.array(value, float))
        if about.shape == "gains" and (rows == rows[0]).all():
            rows = rows[:1]
        names = _names(title, about.name, len(rows))
        least = 0.0 if _rejects(law, place, about.shape, -np.ones_like(rows)) else -np.inf
        yield f"{title}.{about.name}", Argument(k, place, about.shape, names, about.unit, rows, least)


def _kind(value: Any) -> str | None:
    """Return the kind of a value of a formula; None if it is not a number, vector or bivector."""
    if isinstance(value, float):
        return "scalar"
    if not isinstance(value, Multivector) or isinstance(value, Rotor):
        return None
    kinds = {0: "scalar", 1: "vector", 2: "bivector"}
    return kinds.get(value.grades[0]) if len(value.grades) == 1 else None


def _names(title: str, name: str, count: int) -> tuple[str, ...]:
    return (f"{title}.{name}",) if count == 1 else tuple(f"{title}.{name}_{k + 1}" for k in range(count))


def _argument(kind: str, rows: Array) -> Any:
    """Return an argument of a law from its numbers (..., n)."""
    if kind == "bivector":
        return bivector(rows)
    if kind == "vector":
        return vector(rows)
    if kind == "gains":
        return rows if rows.ndim > 1 or len(rows) > 1 else float(rows[0])
    return rows[..., 0] if rows.ndim > 1 else float(rows[0])


def _with(law: Any, new: dict[int | str, Any]) -> Torque:
    """Return the law with new values of some arguments."""
    if law.name == "formula":
        text, frame, values = law.arguments
        given = {name: new.get(name, value) for name, value in values}
        given = {name: scalar(x) if isinstance(x, np.ndarray) else x for name, x in given.items()}
        return laws_of_torque.formula(text, frame=frame, **given)
    values = []
    for place, (about, value) in enumerate(zip(TORQUES[law.name].arguments, law.arguments, strict=True)):
        old = Rotor._from_rows(np.array(value)) if about.shape == "rotor" else value
        values.append(new.get(place, old))
    torque: Torque = getattr(laws_of_torque, law.name)(*values)
    return torque


def _rejects(law: Any, place: int, kind: str, rows: Array) -> bool:
    """Return whether an argument of a law must not have these values."""
    try:
        _with(law, {place: _argument(kind, rows)})
    except ValueError:
        return True
    return False


def _torque(torque: Torque, moments: Any, turn: Any, time: float) -> Array:
    state = State(Rotor.from_rotation_vector(turn), bivector(_RATE))
    return torque.at(Inertia.from_principal_moments(*moments), state, time).components


def _scales(law: Any, own: list[Argument], powers: tuple[int, ...], time: float) -> bool:
    """Return whether the torque doubles if the moments do, and the arguments with power 1."""
    values = [np.linspace(0.3, 0.6, len(x)) + 0.1 * k for k, x in enumerate(own)]

    def torque(factor: float) -> Torque:
        new = {x.place: _argument(x.kind, v * factor**p) for x, v, p in zip(own, values, powers, strict=True)}
        return _with(law, new) if new else Torque((law,))

    doubled = np.array(_MOMENTS) * 2
    try:
        return all(
            _is_close(_torque(torque(2), doubled, turn, time), 2 * _torque(torque(1), _MOMENTS, turn, time))
            for turn in _TURNS
        )
    except ValueError:
        return False


def _is_close(a: Array, b: Array) -> bool:
    return bool(np.abs(a - b).max() <= _SAME * max(np.abs(a).max(), np.abs(b).max()))
