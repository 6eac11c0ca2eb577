"""Arithmetic of floating-point arrays of any library that follows the array API standard."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from typing import Any

import numpy as np

from polhode._support.arrays import as_floats

Array = Any


class Numeric:
    """Arithmetic of the arrays of one namespace: NumPy, JAX, torch, CuPy, Dask or any other of the standard.

    All arrays of a computation have one floating type: float32 stays float32. Only functions of the
    standard are used, those not defined here (`sqrt`, `sin`, `reshape` ...) directly. Components are never
    assigned to: they are separated, and stacked again. NumPy's arrays may be complex.
    """

    exact = False
    pi = math.pi

    def __init__(self, xp: Any, dtype: Any = None, device: Any = None) -> None:
        self.xp = xp
        self.dtype = xp.asarray(1.0).dtype if dtype is None else dtype
        self.is_jax = xp.__name__ == "jax.numpy"
        self.is_complex = xp is np and np.dtype(self.dtype).kind == "c"
        self.real_dtype = np.finfo(self.dtype).dtype if self.is_complex else self.dtype
        self.placed = {} if device is None else {"device": device}
        # While a function is compiled: what `require` was given, to be checked when values are known.
        self.required: list[tuple[Array, str]] | None = None

    def __getattr__(self, name: str) -> Any:
        return getattr(self.xp, name)

    @property
    def native(self) -> bool:
        """Whether these are NumPy's arrays, whose float64 the compiled core takes."""
        return self.xp is np

    @property
    def eps(self) -> float:
        """The spacing of numbers at 1."""
        return float(self.xp.finfo(self.dtype).eps)

    # --- arrays

    def asarray(self, values: Any) -> Array:
        """Convert numbers, nested lists and arrays to one array of this kind."""
        if isinstance(values, list | tuple):
            parts = self.xp.broadcast_arrays(*(self.asarray(value) for value in values))
            return self.xp.stack(list(parts), axis=0)
        if self.is_complex:
            return np.asarray(values, dtype=self.dtype)
        if isinstance(values, np.ndarray | np.generic | int | float) or not hasattr(values, "dtype"):
            floats = np.array(as_floats(values, "coefficients"))  # a copy, which others may keep and write to
            return self.xp.asarray(floats, dtype=self.dtype, **self.placed)
        return values if values.dtype == self.dtype else self.xp.astype(values, self.dtype)

    def factor(self, values: Array) -> Array:
        """Convert an array for a product; compiled programs of JAX take NumPy's as they are, sooner."""
        if self.is_jax and isinstance(values, np.ndarray) and values.dtype.kind == "f":
            return np.asarray(values, dtype=self.dtype)
        return self.asarray(values)

    def zeros(self, shape: tuple[int, ...]) -> Array:
        """Return zeros of this shape."""
        return self.xp.zeros(shape, dtype=self.dtype, **self.placed)

    def stack(self, components: list[Array]) -> Array:
        """Broadcast the components together and lay them along a new last axis."""
        return self.xp.stack(list(self.xp.broadcast_arrays(*components)), axis=-1)

    def is_concrete(self, x: Array) -> bool:
        """Whether values are known: not while JAX traces, nor in a Dask graph, nor under `vmap` of torch."""
        library = type(x).__module__.partition(".")[0]
        if library == "dask":
            return False
        if library == "torch":
            return _has_values(x)
        jax = sys.modules.get("jax")
        return jax is None or not isinstance(x, jax.core.Tracer)

    def constant(self, x: Array) -> Array:
        """Return the same values as constants, with respect to which no derivative is taken."""
        if self.is_jax:
            return sys.modules["jax"].lax.stop_gradient(x)
        return x.detach() if hasattr(x, "detach") else x

    def folded(self, step: Callable[[Array, Any], Array], x: Array, values: list[float]) -> Array:
        """Apply a step to x for each of the values in turn; JAX compiles the step once."""
        if self.is_jax:
            inputs = self.xp.asarray(values, dtype=self.dtype)
            return sys.modules["jax"].lax.scan(lambda x, value: (step(x, value), None), x, inputs)[0]
        for value in values:
            x = step(x, value)
        return x

    # --- elementwise

    def where(self, condition: Array, x: Any, y: Any) -> Array:
        """Take x where the condition holds, else y; either may be a number."""
        return self.xp.where(condition, self._full(x), self._full(y))

    def _full(self, x: Any) -> Array:
        if isinstance(x, int | float):
            return self.xp.asarray(x, dtype=self.real_dtype, **self.placed)
        return x

    def abs(self, x: Array) -> Array:
        """``|x|``, of derivative 1 at 0."""
        if self.is_complex:
            return self.xp.abs(x)
        return self.xp.where(x < 0, -x, x)

    def squared(self, x: Array) -> Array:
        """``|x|²``."""
        return np.square(x.real) + np.square(x.imag) if self.is_complex else x * x

    def divide(self, x: Array, y: Array) -> Array:
        """``x/y``."""
        return x / y

    def atan2(self, y: Array, x: Array) -> Array:
        """Return the angle of the point (x, y), in [−π, π]."""
        return self.xp.atan2(*self.xp.broadcast_arrays(y, x))

    def once(self, x: Array) -> Array:
        """Return x itself, which XLA computes once for each row, not for each component of a result.

        In a program that it compiles, XLA repeats cheap operations for each use, and all operations for each
        component that `stack` writes; but not a quotient that is broadcast along the last axis.
        """
        return x / self.where(x == x, 1.0, math.nan) if self.is_jax else x

    # --- sizes

    def scale(self, components: list[Array]) -> Array:
        """Return a divisor with which fourth powers neither overflow nor vanish: 1 wherever they do not.

        Results are homogeneous in the quotients, so the divisor counts as a constant for derivatives.
        """
        largest = self.largest(components)
        info = self.xp.finfo(self.dtype)
        bound = 2.0 ** (int(math.log2(float(info.max))) // 10)
        usual = (largest >= 1 / bound) & (largest <= bound)
        usable = (largest > 0) & (largest <= float(info.max))
        return self.where(usable & ~usual, largest, self.xp.ones_like(largest))

    def scale_of_large(self, components: list[Array]) -> Array:
        """Return `scale`, but 1 for small components, of functions in whose series their squares may vanish.

        Squares of a small scale vanish too, and second derivatives with them.
        """
        scale = self.scale(components)
        return self.where(scale < 1, 1.0, scale)

    def largest(self, components: list[Array]) -> Array:
        """Return the largest magnitude, as a constant."""
        largest = self.xp.abs(self.constant(components[0]))
        for x in components[1:]:
            largest = self.xp.maximum(largest, self.xp.abs(self.constant(x)))
        return largest

    def length(self, components: list[Array], at_zero: Array | None = None) -> Array:
        """``√Σx²`` without overflow; its derivative at 0, where it has none, is 0, or that of `at_zero`."""
        scale = self.scale(components)
        square = squares(self, [x / scale for x in components])
        zero = square == 0
        root = scale * self.xp.sqrt(self.where(zero, 1.0, square))
        return self.where(zero, 0.0 if at_zero is None else at_zero, root)

    def direction(self, components: list[Array], default: list[float]) -> list[Array]:
        """Return the components divided by their length; where that is 0, the constant default."""
        scale = self.scale(components)
        scaled = [x / scale for x in components]
        square = squares(self, scaled)
        zero = square == 0
        root = self.xp.sqrt(self.where(zero, 1.0, square))
        return [self.where(zero, d, x / root) for x, d in zip(scaled, default, strict=True)]

    # --- errors

    def require(self, ok: Array, message: str) -> None:
        """Raise a ValueError, with the first index where `ok` is false; nothing while values are unknown."""
        if self.required is not None:
            self.required.append((ok, message))
            return
        if not self.is_concrete(ok) or bool(self.xp.all(ok)):
            return
        if ok.ndim == 0:
            raise ValueError(message)
        index = tuple(int(i[0]) for i in self.xp.nonzero(~ok))
        raise ValueError(f"at index {index}: {message}")

    def require_finite(self, components: list[Array]) -> None:
        """Raise a ValueError where some component is NaN or infinite."""
        ok = self.xp.isfinite(components[0])
        for x in components[1:]:
            ok = ok & self.xp.isfinite(x)
        self.require(ok, "a component is NaN or infinite; remove such values first")


def _has_values(tensor: Any) -> bool:
    try:
        bool(tensor.any())
    except RuntimeError as error:  # under vmap, also inside grad; torch has no public function that says so
        if "vmap" not in str(error):
            raise
        return False
    return True


def components(data: Array) -> list[Array]:
    """Return the components as a list."""
    return [data[..., i] for i in range(data.shape[-1])]


def require_in_range(d: Numeric, values: Array) -> None:
    """Raise a ValueError where a value is not finite."""
    finite = d.xp.all(d.xp.isfinite(values), axis=-1)
    d.require(finite, "the result is beyond the range of floating point; scale the argument down")


def squares(d: Any, components: list[Array]) -> Array:
    """``Σx²``."""
    total = components[0] * components[0]
    for x in components[1:]:
        total = total + x * x
    return total
