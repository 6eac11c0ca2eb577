"""Values of formulas: by the compiled core for floats, else step by step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.algebra import algebra as algebra_of
from polhode._algebra.coefficients import kind_of
from polhode._algebra.multivector import Multivector
from polhode._algebra.products import result_array
from polhode._algebra.rotor import Rotor
from polhode._formula.agreement import agreement
from polhode._formula.arguments import Given, compiled, given
from polhode._formula.interpreter import Walk, steps_of
from polhode._support.arrays import is_float, rows

_G3 = algebra_of(3)


def called(core: _native.Formula, arguments: tuple[Any, ...], named: dict[str, Any] | None) -> Any:
    """Return the value of a formula over values of any kind; the binding calls this."""
    if len(arguments) > 1 or (arguments and core.arguments and not isinstance(arguments[0], Mapping)):
        raise TypeError(_misfit(core, len(arguments)))
    named = named or {}
    program, known = compiled(core, given(core, arguments[0] if arguments else None, named))
    is_value = "out" in program.names or "out" in core.arguments
    return evaluated(core.text, program, known, None if is_value else named.get("out"))


def _misfit(core: _native.Formula, count: int) -> str:
    if core.arguments:
        names = ", ".join(core.arguments)
        return f"this formula takes {len(core.arguments)} values by position ({names}), got {count}"
    return (
        f"a formula takes keywords and at most one mapping of values, got {count} values by position; name "
        'these when the formula is made: ph.formula(text, arguments="R x Ω")'
    )


def evaluated(text: str, program: _native.Program, known: Given, out: Any = None) -> Any:
    """Return the value of a program for values of its kinds, or write it to `out`."""
    inputs = known.inputs(program)
    kind = program.value_type
    if kind is not None:
        data = [x._data if isinstance(x, Multivector) else x for x in inputs]
        # In other algebras single precision is rounded after each step, as by the operators.
        if all(map(is_float, data)) and (known.algebra is _G3 or all(x.dtype == np.float64 for x in data)):
            value = _run(program, kind, data, known.algebra, out)
            if value is not None:
                return value
    walk = Walk(text, steps_of(program), inputs, known.algebra)
    if len(program.results[0]) == 1:
        return walk.last() if out is None else _written(walk.last(), inputs, out)
    if out is not None:
        raise TypeError("the value of an equation is an Agreement, not an array; omit out")
    if not inputs and known.algebra is _G3:  # constants alone are compared exactly
        walk.kind = kind_of(np.empty(0, dtype=object))
    return agreement(walk, program)


def _run(
    program: _native.Program, kind: tuple[int, int, bool], data: list[Any], algebra: Any, out: Any
) -> Multivector | None:
    """Return the value by the compiled core; None if a row has no value in another algebra than 3-d space."""
    mask, size, unit = kind
    dtypes, shapes = {x.dtype for x in data}, {x.shape[:-1] for x in data}
    dtype = dtypes.pop() if len(dtypes) == 1 else np.dtype(np.float64)  # the higher of two precisions
    batch = shapes.pop() if len(shapes) == 1 else np.broadcast_shapes(*shapes)
    result = result_array((*batch, size), dtype, tuple(data), out)
    if not program.run([rows(x.astype(dtype, copy=False), batch) for x in data], result):
        return None
    return Rotor._from_rows(result) if unit else Multivector._of(result, mask, algebra)


def _written(value: Multivector, inputs: list[Any], out: Any) -> Multivector:
    """Return the value, written to `out`."""
    if not is_float(value._data):
        raise TypeError(f"out needs values of NumPy floats, got {value.dtype}; omit out")
    data = tuple(x._data if isinstance(x, Multivector) else x for x in inputs)
    result = result_array(value._data.shape, value.dtype, data, out)
    result[...] = value._data
    if isinstance(value, Rotor):
        return Rotor._from_rows(result)
    return Multivector._of(result, value._mask, value.algebra)
