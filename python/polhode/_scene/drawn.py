"""Torque laws of drawn bodies as laws of a batch."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode import _native, torque
from polhode._algebra.constructors import scalar
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.parameters import Batch


def law_of_bodies(law: _native.Law | tuple[str, tuple[Any, ...]]) -> _native.Law:
    """Return a drawn law, as of `EnsembleSpec.laws`, with a row of its arguments for each body."""
    if isinstance(law, _native.Law):
        return law
    name, arguments = law
    if name == "formula":
        return _formula(arguments)
    rows = (x if x.ndim > 1 else x[:, np.newaxis] for x in arguments)
    return _native.Law(name, *map(Batch, rows))


def _formula(laws: tuple[_native.Law, ...]) -> _native.Law:
    """Return the formula of all bodies, whose laws differ in the values of its names."""
    text, frame, known = laws[0].arguments
    each = [dict(law.arguments[2]) for law in laws]
    values = {name: _together(name, [own[name] for own in each]) for name, _ in known}
    (law,) = torque.formula(text, frame=frame, **values).laws
    return law


def _together(name: str, values: list[Any]) -> Any:
    """Return the value of a name if it is the same for all bodies, else a batch of the values."""
    first = values[0]
    if all(type(x) is float for x in values):
        return first if values.count(first) == len(values) else scalar(np.array(values))
    kinds = {(type(x), x._mask if isinstance(x, Multivector) else None) for x in values}
    if len(kinds) > 1:
        raise ValueError(
            f"the value of `{name}` in a formula has other grades for other bodies; draw them one by one"
        )
    data = np.stack([x._data for x in values])
    return Rotor._from_rows(data) if isinstance(first, Rotor) else Multivector._of(data, first._mask)
