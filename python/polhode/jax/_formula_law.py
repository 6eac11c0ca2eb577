"""Torque laws given by formulas, evaluated over JAX arrays."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.algebra import algebra
from polhode._algebra.constructors import bivector, scalar
from polhode._algebra.linear_map import LinearMap
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._formula.arguments import narrowed
from polhode._formula.errors import FormulaError
from polhode._formula.formula import formula
from polhode._formula.interpreter import Walk, steps_of
from polhode.jax._components import Four, Three, compose, joined, reverse, split, turned
from polhode.jax._laws import Gyrostat, Law, Phase, pytree, static
from polhode.jax._library import jnp

_VALUE, _ROTOR, _MAP = 0, 1, 2
_SCALAR, _BIVECTOR, _EVEN = 0b0001, 0b0100, 0b0101
_RATES = {"Ω_B": "body", "Omega_B": "body", "Ω_S": "space", "Omega_S": "space", "L": "L", "L_B": "L_B"}
_GIVEN = [
    ("R", _EVEN, _ROTOR),
    ("t", _SCALAR, _VALUE),
    ("I", 2, _MAP),
    *((name, _BIVECTOR, _VALUE) for name in (*_RATES, "Ω", "Omega")),
]


@pytree
class Formula(Law):
    """A formula in the names of the motion and given values, which are JAX pytrees."""

    values: dict[str, Any]
    frame: Four | None
    text: str = static()
    axes: str = static()

    @property
    def depends_on_rate(self) -> bool:
        return any(name in _RATES or name in ("Ω", "Omega") for name in self._names())

    def in_axes(self, frame: Four) -> Law:
        return replace(self, frame=frame)

    def value(self, body: Gyrostat, phase: Phase) -> Three:
        inputs = [self._input(name, body, phase) for name in self._names()]
        found = split(Walk(self.text, steps_of(self._program()), inputs, algebra(3)).last()._data)
        if self.axes == "space":
            return turned(reverse(phase.rotor), found)
        return found if self.frame is None else turned(reverse(self.frame), found)

    def checked(self) -> Formula:
        """Return the law with values of the required grades; raise a `FormulaError` if it is not a torque."""
        try:
            self._program()
        except FormulaError:
            # As in formulas elsewhere, a single value without a scalar part counts as a bivector.
            law = replace(self, values={name: _narrowed(x) for name, x in self.values.items()})
            law._program()
            return law
        return self

    def _program(self) -> _native.Program:
        kinds = [
            (name, x._mask, _ROTOR if isinstance(x, Rotor) else _VALUE) for name, x in self.values.items()
        ]
        program = formula(self.text)._core.program(algebra(3), [*_GIVEN, *kinds])
        (sides, *others) = program.results
        if others or len(sides) > 1 or program.steps[sides[0]][3] != _BIVECTOR:
            span = program.steps[sides[0]][5]
            raise FormulaError("a torque must be a bivector (grade 2), such as `a∧b`", self.text, span)
        return program

    def _names(self) -> list[str]:
        names = [name for name, *_ in _GIVEN] + list(self.values)
        return [names[place] for place, *_ in self._program().inputs]

    def _input(self, name: str, body: Gyrostat, phase: Phase) -> Any:
        """Return the value of a name at a state; for the inertia its matrix (..., 9)."""
        if name in self.values:
            return self.values[name]
        if name == "t":
            return scalar(phase.time)
        if name == "R":
            rotor = phase.rotor if self.frame is None else compose(phase.rotor, reverse(self.frame))
            return Rotor._from_rows(joined(rotor))
        if name == "I":
            return self._inertia(body)
        which = _RATES.get(name, self.axes)
        plane = phase.momentum if which.startswith("L") else body.omega(phase.momentum)
        if which in ("space", "L"):
            plane = turned(phase.rotor, plane)
        elif self.frame is not None:
            plane = turned(self.frame, plane)
        return bivector(joined(plane))

    def _inertia(self, body: Gyrostat) -> Any:
        """``I(B) = F I₀(~F B F) ~F``, by its columns."""
        columns = []
        for k in range(3):
            plane: Any = tuple(jnp.where(k == j, jnp.ones_like(i), 0.0) for j, i in enumerate(body.moments))
            if self.frame is None:
                columns.append(body.carried(plane))
            else:
                columns.append(turned(self.frame, body.carried(turned(reverse(self.frame), plane))))
        return joined(tuple(columns[n % 3][n // 3] for n in range(9)))


def value_of(value: Any, name: str) -> Multivector:
    """Return a multivector over JAX arrays for a formula, from a multivector or numbers."""
    if isinstance(value, LinearMap):
        raise TypeError(f"{name} is a linear map; formulas under JAX take multivectors, rotors and numbers")
    if isinstance(value, Multivector):
        return value._like(jnp.asarray(value._data))
    return scalar(jnp.asarray(value, dtype=jnp.result_type(float)))


def _narrowed(value: Multivector) -> Multivector:
    try:
        data = np.asarray(value._data)
    except Exception:  # a traced array has no values
        return value
    if isinstance(value, Rotor):
        return value
    found = narrowed(Multivector._of(data, value._mask))
    return Multivector._of(jnp.asarray(found._data), found._mask)
