"""Whether the sides of an equation agree, and how far they are apart."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from polhode._algebra.coefficients import namespace
from polhode._algebra.multivector import Multivector
from polhode._formula.interpreter import Step, Walk
from polhode._generic.exact import is_multiprecision, is_zero, sqrt
from polhode._generic.numeric import Numeric, components
from polhode._support.arrays import is_float
from polhode._support.extras import register_pytree

_SINGLE = 2.0**-23


class Agreement:
    """What an equation evaluates to: whether its sides agree, row by row.

    They agree where ``residual <= rtol * size``; ``bool()`` tells whether they do in all rows. Exact numbers
    must be equal, and the difference of symbolic sides must vanish identically.

    Attributes
    ----------
    residual
        ``|lhs − rhs|``, the size of the components ``√Σ c²``: a float, or an array of the batch shape. Of
        several pairs of sides, as in an equation in free indices, that which is worst beside its size.
    size
        Of the terms that make up the sides: of a sum the sum of its terms' sizes, of a product that of one
        factor's terms times the size of the other. So ``a∧b + b∧a = 0`` is measured by ``2|a||b|``. None for
        symbols.
    rtol
        1e-9 for float64, as in `is_close`; 1e-4 for float32; 0 for exact numbers and symbols. `within` takes
        another.
    """

    __slots__ = ("residual", "rtol", "size")

    def __init__(self, residual: Any, size: Any, rtol: float) -> None:
        self.residual, self.size, self.rtol = residual, size, rtol

    @property
    def holds(self) -> Any:
        """Whether the sides agree: a bool, or an array of the batch shape."""
        if self.rtol == 0 or self.size is None:
            return np.equal(self.residual, 0).astype(bool)[()]
        return (self.residual <= self.rtol * self.size) & (self.size < math.inf)

    def within(self, rtol: float) -> Agreement:
        """Return the same with another relative tolerance."""
        if not 0 <= rtol < math.inf:
            raise ValueError(f"rtol must be a finite number from 0 on, got {rtol!r}")
        if self.size is None:
            raise TypeError("symbols agree identically or not; substitute numbers to compare to a tolerance")
        return Agreement(self.residual, self.size, rtol)

    def __bool__(self) -> bool:
        holds = self.holds
        return bool(namespace(self.residual).all(holds) if getattr(holds, "ndim", 0) else holds)

    def __repr__(self) -> str:
        try:
            holds = np.asarray(self.holds)
            residual = np.asarray(self.residual)
            size = None if self.size is None else np.asarray(self.size)
        except Exception:  # traced or lazy arrays have no numbers to show; each library has its own error
            return f"Agreement(residual {self.residual!r}, size {self.size!r}, rtol {self.rtol:g})"
        return f"Agreement({_told(holds, residual, size)}, rtol {self.rtol:g})"


def _told(holds: Any, residual: Any, size: Any) -> str:
    """Return in how many rows the sides agree, and the residual of the worst."""
    if not holds.size:
        return "no rows"
    if size is None:
        worst = int(np.argmin(holds))
        beside = ""
    else:
        with np.errstate(divide="ignore", invalid="ignore"):
            worst = int(np.argmax(np.where(residual == 0, 0, residual / size)))
        beside = f" beside terms of size {size.flat[worst]:.3g}"
    number = residual.flat[worst]
    shown = f"residual {number:.3g}" if isinstance(number, float) else f"residual {number}"
    if not holds.ndim:
        return f"{'holds' if holds else 'does not hold'}, {shown}{beside}"
    index = tuple(int(i) for i in np.unravel_index(worst, holds.shape))
    rows = f"all {holds.size}" if holds.all() else f"{holds.sum()} of {holds.size}"
    return f"holds in {rows} rows, largest {shown}{beside} at index {index}"


# --- how it is found


def agreement(walk: Walk, groups: Sequence[Sequence[int]]) -> Agreement:
    """Return the agreement of the steps that are sides of an equation, group by group."""
    sides = {i for group in groups for i in group}
    values: dict[int, Multivector] = {}
    sizes: list[Any] = []
    for number, (step, operands, value) in enumerate(walk):
        if not walk.symbolic:
            sizes.append(_size(walk, step, operands, value, [sizes[i] for i in step.operands]))
        if number in sides:
            values[number] = value
    pairs = [(group[0], other) for group in groups for other in group[1:]]
    differences = [(values[a] - values[b])._data for a, b in pairs]
    if walk.symbolic:
        return Agreement(_first([_symbolic_residual(d) for d in differences]), None, 0.0)
    xp, kind = _floats(walk)
    found = [
        xp.broadcast_arrays(_residual(walk, d), xp.maximum(sizes[a], sizes[b]))
        for d, (a, b) in zip(differences, pairs, strict=True)
    ]
    residual, size = _worst(kind, [(r, s) for r, s in found])
    if kind.native:
        residual, size = residual[()], size[()]
    register_pytree(Agreement, _flattened, _restored)
    return Agreement(residual, size, _rtol(walk, differences))


def _flattened(found: Agreement) -> tuple[tuple[Any, Any], float]:
    return (found.residual, found.size), found.rtol


def _restored(rtol: float, leaves: Iterable[Any]) -> Agreement:
    residual, size = leaves
    return Agreement(residual, size, rtol)


def _floats(walk: Walk) -> tuple[Any, Numeric]:
    """Return the namespace and the arithmetic of sizes, which are floats: of NumPy for exact numbers."""
    kind = Numeric(np) if walk.kind.exact or walk.kind.native else walk.kind
    return kind.xp, kind


def _rtol(walk: Walk, differences: list[Any]) -> float:
    """As `is_close`; a formula has at most 10,000 steps, and 64 roundings in each of them make 1.4e-10.

    Multiprecision has as many digits in reserve; single precision, half as long, has three.
    """
    if not walk.kind.exact:
        return 1e-4 if walk.kind.eps >= _SINGLE else 1e-9
    rounded = [x for data in differences for x in data.flat if isinstance(x, float) or is_multiprecision(x)]
    return 1e-9 / 2.0**-52 * walk.kind.eps if rounded else 0.0


def _worst(kind: Numeric, pairs: list[tuple[Any, Any]]) -> tuple[Any, Any]:
    """Return the residual that is largest beside its size, and that size."""
    (residual, size), *others = pairs
    for r, s in others:
        worse = (r * size > residual * s) | ((s == 0) & (r > 0)) | (r != r)
        residual, size = kind.where(worse, r, residual), kind.where(worse, s, size)
    return residual, size


def _first(residuals: list[Any]) -> Any:
    """Return the first that is not 0, row by row."""
    found, *others = residuals
    for other in others:
        found = np.where(np.equal(found, 0).astype(bool), other, found)
    return found[()]


def _symbolic_residual(data: Any) -> Any:
    """Return 0 for a difference that vanishes identically, row by row; else its size."""
    result = np.zeros(data.shape[:-1], dtype=object)
    for index in np.ndindex(result.shape):
        row = [x for x in map(_without_floats, data[index]) if not is_zero(x)]
        if row:
            result[index] = sqrt(sum(x * x for x in row))
    return result


def _without_floats(x: Any) -> Any:
    """Return an expression in which each float is the ratio that it is, so that digits are not cut off."""
    sympy = sys.modules["sympy"]
    if not isinstance(x, sympy.Expr):
        return x
    return x.xreplace({number: sympy.Rational(number) for number in x.atoms(sympy.Float)})


def _residual(walk: Walk, data: Any) -> Any:
    """Return the size of a difference; of exact numbers that are not equal, never 0."""
    size = _length(walk, data)
    if not walk.kind.exact:
        return size
    return np.where((data != 0).any(axis=-1) & (size == 0), math.ulp(0.0), size)


# --- the size of terms


def _length(walk: Walk, data: Any) -> Any:
    """``√Σ c²``, as floats."""
    _, kind = _floats(walk)
    if walk.kind.exact and not is_float(data):
        data = np.frompyfunc(_float, 1, 1)(data).astype(np.float64)
    return kind.length(components(kind.asarray(data)))


def _float(x: Any) -> float:
    try:
        return float(x)
    except OverflowError:
        return math.inf


def _size(walk: Walk, step: Step, operands: tuple[Multivector, ...], value: Multivector, s: list[Any]) -> Any:
    """Return the size of the terms that make up a step: its rounding is a few ulps of that.

    Functions stretch the rounding of their argument by their derivative.
    """
    rule = _RULES.get(step.name)
    if rule is not None:
        return rule(*s)
    if step.name == "map":
        return s[0] * _length(walk, walk.inputs[step.detail])
    xp, _ = _floats(walk)
    if step.name in _BILINEAR:
        return _BILINEAR[step.name](xp, *(_length(walk, x._data) for x in operands), *s)
    size = _length(walk, value._data)
    if step.name in _PERIODIC:
        # Up to where the tolerance is a thousandth; beyond it would hide any difference.
        most = 10.0 if not walk.kind.exact and walk.kind.eps >= _SINGLE else 1e6
        turned = s[0] * abs(step.detail) if step.name == "power" else s[0]
        return _PERIODIC[step.name](size, xp.minimum(turned, xp.full_like(turned, most)))
    if step.name in _STRETCHED:
        return _STRETCHED[step.name](size, _length(walk, operands[-1]._data), *s)
    return size


_RULES: dict[str, Callable[..., Any]] = {
    "add": lambda s, t: s + t,
    "subtract": lambda s, t: s + t,
    "negate": lambda s: s,
    "reverse": lambda s: s,
    "part": lambda s: s,
    "dual": lambda s: s,
    "undual": lambda s: s,
    "norm": lambda s: s,
}

# From the sizes of the two operands, and those of their terms: to first order, AB changes by A dB + dA B.
_BILINEAR: dict[str, Callable[..., Any]] = {
    "product": lambda xp, a, b, s, t: xp.maximum(a * t, s * b),
    "compose": lambda xp, a, b, s, t: xp.maximum(a * t, s * b),
    "turn": lambda xp, a, b, s, t: xp.maximum(a * a * t, a * s * b),
    "divide": lambda xp, a, b, s, t: xp.maximum(s / b, a / b * (t / b)),
}

# From the size of the value, that of the last operand, and those of the operands' terms.
_STRETCHED: dict[str, Callable[..., Any]] = {
    "inverse": lambda v, a, s: v * (v * s),
    "log": lambda v, a, s: v + s / a,
    "sqrt": lambda v, a, s: v * (1 + s / (a + (a == 0))),
}

# From the size of the value, and that of the terms of the argument.
_PERIODIC: dict[str, Callable[..., Any]] = {
    "power": lambda v, s: v + s,
    "exp": lambda v, s: v * (1 + s),
    "sin": lambda v, s: v + s,
    "cos": lambda v, s: v + s,
    "tan": lambda v, s: v + s * (1 + v * v),
}
