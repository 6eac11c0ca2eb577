"""Interpreter of formula programs, for values that the compiled core does not evaluate."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from polhode import _native
from polhode._algebra.coefficients import common, kind_of
from polhode._algebra.multivector import Multivector
from polhode._algebra.products import product
from polhode._algebra.rotor import Rotor
from polhode._formula.errors import FormulaError
from polhode._generic.exact import divide, is_symbolic
from polhode._generic.numeric import Numeric
from polhode._support.arrays import is_complex, is_float


class Step(NamedTuple):
    """An operation on earlier steps, `operands`; `detail` is its constant, input or power.

    Its value has the grades `mask`, as bits, and is a rotor if `unit`; `span` is its place in the text.
    """

    name: str
    operands: tuple[int, ...]
    detail: Any
    mask: int
    unit: bool
    span: tuple[int, int]


def steps_of(program: _native.Program) -> list[Step]:
    return [Step(*step) for step in program.steps]


class Walk:
    """The values of all steps of a program, in order. Errors have a place in the text.

    `inputs` are multivectors, and of maps the matrices (..., 9) and determinants (..., 1).
    """

    def __init__(self, text: str, steps: Sequence[Step], inputs: Sequence[Any], algebra: Any) -> None:
        self.text, self.steps, self.inputs, self.algebra = text, steps, inputs, algebra
        arrays = [x._data if isinstance(x, Multivector) else x for x in inputs]
        if all(map(is_float, arrays)):
            self.kind: Any = Numeric(np, np.result_type(*arrays) if arrays else np.dtype(np.float64))
        else:
            self.kind = kind_of(*arrays)
        self.symbolic = self.kind.exact and any(is_symbolic(x) for array in arrays for x in array.flat)

    def __iter__(self) -> Iterator[tuple[Step, tuple[Multivector, ...], Multivector]]:
        """Yield each step with its operands and its value."""
        done: list[Any] = []
        last = {i: number for number, step in enumerate(self.steps) for i in step.operands}
        for number, step in enumerate(self.steps):
            operands = tuple(done[i] for i in step.operands)
            done.append(self._value(step, operands))
            yield step, operands, done[-1]
            for i in step.operands:  # free large batches after their last use
                if last[i] == number:
                    done[i] = None

    def last(self) -> Multivector:
        """Return the value of the last step."""
        *_, (_, _, value) = self
        return value

    def _value(self, step: Step, operands: tuple[Multivector, ...]) -> Multivector:
        try:
            return _typed(_STEPS[step.name](self, step, *operands), step)
        except (ValueError, ZeroDivisionError, TypeError) as error:
            if type(error).__module__ != "builtins":  # an error of a tracing library
                raise
            raise FormulaError(str(error), self.text, step.span) from error

    def of(self, components: Sequence[Any], mask: int) -> Multivector:
        """Return a value with these components, as coefficients of the inputs' kind."""
        data = self.kind.asarray(components if self.kind.exact else np.array(components, dtype=np.float64))
        return Multivector._of(data, mask, self.algebra)

    def scalars(self, numbers: Any) -> Multivector:
        """Return a batch of numbers as scalars."""
        return Multivector._of(self.kind.asarray(numbers)[..., None], 1, self.algebra)

    def number(self, value: float, ratio: tuple[int, int] | None) -> Any:
        """Return a constant; an exact one among exact values."""
        if not self.kind.exact:
            return value
        if ratio is None:
            raise ValueError(
                "constants in a formula are exact only up to 2⁵³ and as ratios of such numbers; "
                "give this one by name to compute exactly"
            )
        return sys.modules["sympy"].Rational(*ratio) if self.symbolic else divide(*ratio)


def _typed(value: Multivector, step: Step) -> Multivector:
    """Return a value with the grades and the type of the step."""
    if value._mask != step.mask:
        value = value._part(step.mask)
    if isinstance(value, Rotor) == step.unit or is_complex(value._data):  # rotors are real
        return value
    return Rotor._from_rows(value._data) if step.unit else value._part(step.mask)


def _constant(walk: Walk, step: Step) -> Multivector:
    value, ratio, blade = step.detail
    number = walk.number(value, ratio)
    return walk.of([number if i == blade else 0 for i in walk.algebra._indices(step.mask)], step.mask)


def _pi(walk: Walk, step: Step) -> Multivector:
    """Return π; as a symbol among symbols."""
    return walk.of([sys.modules["sympy"].pi if walk.symbolic else walk.kind.pi], step.mask)


def _map(walk: Walk, step: Step, argument: Multivector) -> Multivector:
    """Return the matrix of a linear map times the components; of a trivector, its determinant."""
    matrix, x = common(walk.inputs[step.detail], argument._data)
    with np.errstate(over="ignore", invalid="ignore"):  # IEEE, as in the products
        if x.shape[-1] == 1:
            return Multivector._of(x * matrix, step.mask)
        rows = [sum(matrix[..., 3 * i + j] * x[..., j] for j in range(3)) for i in range(3)]
        return Multivector._of(walk.kind.stack(rows), step.mask)


def _of_scalars(walk: Walk, step: Step, a: Multivector) -> Multivector:
    x = walk.kind.asarray(a._data)[..., 0]
    if not walk.kind.exact:
        walk.kind.require_finite([x])
    return walk.scalars(getattr(walk.kind, step.name)(x))


_STEPS: dict[str, Callable[..., Multivector]] = {
    "input": lambda walk, step: walk.inputs[step.detail],
    "constant": _constant,
    "pi": _pi,
    "add": lambda _, __, a, b: a + b,
    "subtract": lambda _, __, a, b: a - b,
    "negate": lambda _, __, a: -a,
    "product": lambda _, step, a, b: product(step.detail, a, b),
    "compose": lambda _, __, a, b: a * b,
    "turn": lambda _, __, rotor, x: rotor(x),
    "divide": lambda _, __, a, s: a / s,
    "reverse": lambda _, __, a: ~a,
    "part": lambda _, __, a: a,
    "dual": lambda _, __, a: a.dual(),
    "undual": lambda _, __, a: a.undual(),
    "exp": lambda _, __, a: a.exp(),
    "log": lambda _, __, a: a.log(),
    "sqrt": lambda _, __, a: a.sqrt(),
    "inverse": lambda _, __, a: a.inverse(),
    "power": lambda _, step, rotor: rotor**step.detail,
    "norm": lambda walk, _, a: walk.scalars(a.norm()),
    "sin": _of_scalars,
    "cos": _of_scalars,
    "tan": _of_scalars,
    "map": _map,
}
