"""Gradients of formulas by JAX."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.coefficients import register_pytrees
from polhode._algebra.linear_map import LinearMap
from polhode._algebra.multivector import Multivector
from polhode._formula.arguments import Given, compiled, given
from polhode._formula.interpreter import Walk, steps_of
from polhode._support.arrays import is_float
from polhode._support.extras import optional


def gradient(core: _native.Formula, names: tuple[str, ...]) -> Callable[..., Any]:
    """Return a function for the gradients of a scalar formula with respect to some names."""
    if not names or not all(isinstance(name, str) for name in names):
        raise TypeError(f'grad expects names to differentiate by, as in f.grad("x"), got {names!r}')
    if len({_native.canonical(name) for name in names}) < len(names):
        raise TypeError(f"names in grad must differ, got {names!r}")
    jax = optional("jax", "jax", "the gradient of a formula")
    register_pytrees()

    def gradients(values: Mapping[str, Any] | None = None, /, **named: Any) -> Any:
        program, known = compiled(core, given(core, values, named))
        _require_scalar(program)
        places = [_place(known, name) for name in names]
        data = [x._data if isinstance(x, Multivector) else x.matrix for x in known.values]
        if any(x.dtype == object for x in data):
            raise TypeError("gradients need floats; convert exact numbers with .astype(float)")
        if not all(map(is_float, data)):
            return _shaped(names, _by_jax(jax, core.text, program, known, places))
        with _doubles(jax):
            double = Given(known.algebra, known.kinds, [_of_jax(jax, x) for x in known.values], {})
            found = _by_jax(jax, core.text, program, double, places)
            return _shaped(names, [x._like(np.asarray(x._data, dtype=np.float64)) for x in found])

    return gradients


def _by_jax(
    jax: Any, text: str, program: _native.Program, known: Given, places: list[int]
) -> list[Multivector]:
    """Return the gradients of the sum over all rows, which are those of each row."""
    steps = steps_of(program)
    chosen: list[Any] = [known.values[i] for i in places]

    def total(data: list[Any]) -> Any:
        values = list(known.values)
        for i, value, x in zip(places, chosen, data, strict=True):
            values[i] = value._like(x)
        inputs = Given(known.algebra, known.kinds, values, {}).inputs(program)
        result = Walk(text, steps, inputs, known.algebra).last()
        for i, value in zip(places, chosen, strict=True):
            if value.shape != result.shape:
                raise ValueError(
                    f"{known.kinds[i][0]} must have a row for each row of the formula, of shape "
                    f"{result.shape}, got shape {value.shape}; or take gradients under jax.vmap"
                )
        return result._data.sum()

    slopes = jax.grad(total)([value._data for value in chosen])
    return [Multivector._of(x, value._mask, value.algebra) for x, value in zip(slopes, chosen, strict=True)]


def _doubles(jax: Any) -> Any:
    if hasattr(jax, "enable_x64"):
        return jax.enable_x64(True)
    return optional("jax.experimental", "jax", "the gradient of a formula").enable_x64()


def _of_jax(jax: Any, value: Any) -> Any:
    """Return a value over NumPy floats as float64 of JAX; linear maps are unchanged."""
    if isinstance(value, LinearMap):
        return value
    return value._like(jax.numpy.asarray(value._data, dtype="float64"))


def _place(known: Given, name: str) -> int:
    wanted = _native.canonical(name)
    for i, ((other, *_), value) in enumerate(zip(known.kinds, known.values, strict=True)):
        if _native.canonical(other) == wanted:
            if isinstance(value, LinearMap):
                raise TypeError(f"cannot differentiate by {name}: it is a linear map")
            return i
    raise TypeError(f"cannot differentiate by {name}: no value with this name was given")


def _require_scalar(program: _native.Program) -> None:
    (sides, *others) = program.results
    if others or len(sides) > 1:
        raise TypeError("an equation has no gradient; differentiate the squared difference of its sides")
    mask = program.steps[sides[0]][3]
    if mask != 1:
        grades = tuple(k for k in range(mask.bit_length()) if mask >> k & 1)
        raise TypeError(f"gradients need a scalar formula, got grades {grades}; take ⟨…⟩ or norm(…)")


def _shaped(names: tuple[str, ...], found: list[Multivector]) -> Any:
    return found[0] if len(names) == 1 else tuple(found)
