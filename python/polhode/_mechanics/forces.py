"""Force: a sum of forces on the centre of mass, with its values, multiples and text."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.constructors import as_points, vector
from polhode._algebra.multivector import Multivector
from polhode._mechanics.bodies import Body
from polhode._mechanics.laws import finite, shown
from polhode._mechanics.parameters import CONVERSIONS, Batch, rows, together
from polhode._mechanics.registry import FORCES
from polhode._mechanics.state import State, require_single_state
from polhode._mechanics.sums import Sum, multiple, require_single
from polhode._support.arrays import Array, as_float

# What counts as a constant force in a sum.
_VECTORS = (Multivector, np.ndarray)


@dataclass(frozen=True, repr=False)
class Force(Sum):
    """A sum of forces, returned by the functions of `polhode.force`.

    Forces are immutable values: equal if their arguments are equal, hashable, and picklable.

    Examples
    --------
    Forces add up, and a vector is a constant force in N:

    >>> ph.force.constant([0, 0, -9.81]) + ph.force.drag(0.1)
    constant([0.0, 0.0, -9.81]) + drag(0.1)
    >>> ph.force.drag(0.1) - 9.81 * ph.e3
    drag(0.1) + constant([0.0, 0.0, -9.81])

    A number times a force is a force with other arguments:

    >>> 2 * ph.force.drag(0.1)
    drag(0.2)
    """

    laws: tuple[_native.Force, ...]
    _constant = "for a constant force write constant(F) or a vector"

    def __add__(self, other: Force | Multivector | Array) -> Force:
        return super().__add__(force_of("constant", other) if isinstance(other, _VECTORS) else other)

    def __radd__(self, other: int | Multivector | Array) -> Force:
        return force_of("constant", other) + self if isinstance(other, _VECTORS) else super().__radd__(other)

    def __sub__(self, other: Force | Multivector | Array) -> Force:
        return super().__sub__(force_of("constant", other) if isinstance(other, _VECTORS) else other)

    def __rsub__(self, other: int | Multivector | Array) -> Force:
        return force_of("constant", other) - self if isinstance(other, _VECTORS) else super().__rsub__(other)

    def _multiple(self, law: _native.Force, factor: float, done: str) -> _native.Force:
        return multiple(law, factor, (0,), done)

    def at(self, body: Body, state: State, t: float | None = None) -> Multivector:
        """Return the force at a single state and time, a vector in space in N.

        In formulas, L excludes the momentum of `gyrostat` wheels. The time t is in s, by default that of the
        state.

        Examples
        --------
        Weight and drag of a ball that moves at 2 m/s along e1:

        >>> ball = ph.Body.sphere(0.1, mass=0.5)
        >>> state = ph.State(ph.Rotor.identity(), [0, 0, 0], velocity=[2, 0, 0])
        >>> (ph.force.constant([0, 0, -5]) + ph.force.drag(0.1)).at(ball, state)
        -0.2 e1 - 5 e3
        """
        # Here, for simulations need not import formulas.
        from polhode._mechanics.force_values import names_of_motion, value_of

        require_single(self)
        if not isinstance(body, Body):
            raise TypeError(f"a force needs a Body, which has a mass, got {type(body).__name__}")
        require_single_state(state)
        motion = names_of_motion(body, state, finite(as_float(state.time if t is None else t, "t"), "t"))
        return sum((value_of(law, motion) for law in self.laws), vector([0.0, 0.0, 0.0]))

    def __repr__(self) -> str:
        return " + ".join(map(_text, self.laws)) or "Force(())"


Force.__module__ = "polhode.force"  # its public module, which pickles and texts name


def force_of(name: str, *values: Any) -> Force:
    """Return the force of the registry with these values for its first arguments."""
    entries = FORCES[name].arguments
    arguments = [_CONVERSIONS[x.shape](value, x.name) for x, value in zip(entries, values, strict=False)]
    return native_force(name, *arguments, names=[x.name for x in entries])


def native_force(name: str, *arguments: Any, names: Sequence[str] = ()) -> Force:
    """Return a force of the core with converted arguments, whose batches are broadcast to one shape."""
    return Force((_native.Force(name, *together(arguments, name, names)),))


def _points(value: Any, name: str) -> tuple[float, ...] | Batch:
    return rows(as_points(value, f"the force's {name}"), f"the force's {name}")


_CONVERSIONS = {**CONVERSIONS, "vector": _points}


def _text(law: _native.Force) -> str:
    if law.name == "formula":
        text, values = law.arguments
        return shown("formula", [text], dict(values))
    if law.name == "thrust" and len(law.arguments) == 2:
        F, at = law.arguments
        return shown("thrust", [F], {"at": at})
    if law.name == "function":
        f, omega_body = law.arguments
        return shown("function", [f], {"omega_body": True} if omega_body else {})
    return shown(law.name, law.arguments, {})
