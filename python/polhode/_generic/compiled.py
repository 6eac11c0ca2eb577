"""Functions of JAX arrays compiled once for each shape, and kept.

Outside `jit` JAX starts every primitive by itself, at some 50 µs each; a product of rotors has two hundred.
Compiled together they start once. Under `grad`, `jvp` and `vmap` outside `jit` a compiled function is one
primitive as well: its derivative, transpose and batched form are compiled once for each shape, too.

The derivative computes intermediate values again instead of storing them: each value stored between the two
programs costs JAX some 50 µs, and much memory for a large batch. Within one program XLA finds common
expressions, so that nothing is computed twice.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

from polhode._generic.numeric import Array, Numeric

# Programs kept: a function for given shapes, types and other arguments.
_KEPT = 1024

F = TypeVar("F", bound=Callable[..., Any])


class _Taken(NamedTuple):
    """In place of an array among the arguments: what a program depends on of it."""

    shape: tuple[int, ...]
    dtype: Any
    weak: bool


def compiled(function: F) -> F:
    """Compile a function of an arithmetic, arrays and hashable values when the arrays are JAX's.

    It may call `require`: the conditions are computed with the values, and those of known values raise after.
    Functions that look at values themselves cannot be compiled.
    """

    @functools.wraps(function)
    def call(d: Any, *arguments: Any) -> Any:
        if not isinstance(d, Numeric) or d.required is not None or not d.is_jax:
            return function(d, *arguments)
        arrays = [x for x in arguments if hasattr(x, "dtype")]
        program = _program(function, d.dtype, tuple(map(_description, arguments)))
        outputs, fine, conditions = program.run(arrays)
        if fine is not None and d.is_concrete(fine) and not fine:
            for condition, message in zip(conditions, program.messages, strict=True):
                d.require(condition, message)
        return program.restored(outputs)

    return call  # type: ignore[return-value]


def _description(argument: Any) -> Any:
    if hasattr(argument, "dtype"):
        return _Taken(argument.shape, argument.dtype, getattr(argument, "weak_type", False))
    return tuple(argument) if isinstance(argument, list) else argument


class _Program:
    """One compiled function, with the messages of its conditions and the values that are not arrays."""

    def __init__(self, function: Callable[..., Any], dtype: Any, arguments: tuple[Any, ...]) -> None:
        self.function, self.dtype, self.arguments = function, dtype, arguments
        self.messages: list[str] = []
        jax = sys.modules["jax"]
        self.run = jax.jit(jax.checkpoint(self._trace, prevent_cse=False))

    def _trace(self, arrays: list[Array]) -> tuple[list[Array], Any, list[Array]]:
        jax = sys.modules["jax"]
        d = Numeric(jax.numpy, self.dtype)
        d.required = []
        given = iter(arrays)
        result = self.function(d, *(next(given) if isinstance(x, _Taken) else x for x in self.arguments))
        leaves, self._tree = jax.tree_util.tree_flatten(result)
        self._fixed = [None if hasattr(x, "dtype") else x for x in leaves]
        self.messages = [message for _, message in d.required]
        conditions = [condition for condition, _ in d.required]
        fine = None
        for condition in conditions:
            here = jax.numpy.all(condition)
            fine = here if fine is None else fine & here
        return [x for x in leaves if hasattr(x, "dtype")], fine, conditions

    def restored(self, outputs: list[Array]) -> Any:
        """Return the result of the function from its arrays."""
        computed = iter(outputs)
        leaves = [next(computed) if x is None else x for x in self._fixed]
        return sys.modules["jax"].tree_util.tree_unflatten(self._tree, leaves)


@functools.lru_cache(maxsize=_KEPT)
def _program(function: Callable[..., Any], dtype: Any, arguments: tuple[Any, ...]) -> _Program:
    return _Program(function, dtype, arguments)
