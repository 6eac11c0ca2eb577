"""Agreement of the sides of an equation, for any coefficients; the core has the rules."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.coefficients import namespace
from polhode._algebra.multivector import Multivector
from polhode._formula.interpreter import Walk
from polhode._generic.exact import is_multiprecision, is_zero, sqrt
from polhode._generic.numeric import Numeric, components
from polhode._support.arrays import is_complex, is_float
from polhode._support.extras import register_pytree


class Agreement:
    """The value of an equation: whether its sides agree, row by row.

    They agree where ``residual <= rtol * size``; ``bool()`` is true if they agree in all rows. Exact numbers
    must be equal, and the difference of symbolic sides must vanish identically.

    Attributes
    ----------
    residual
        ``|lhs − rhs|``, the norm of the components ``√Σ c²``: a float, or an array of the batch shape. Of
        several pairs of sides, as in an equation in free indices, the largest relative to its size.
    size
        The size of the terms that make up the sides: of a sum the sum of its terms' sizes, of a product the
        size of one factor's terms times the norm of the other. So ``a∧b + b∧a = 0`` is compared with
        ``2|a||b|``. None for symbols.
    rtol
        1e-9 for float64, as in `is_close`; 1e-4 for float32; 0 for exact numbers and symbols. `within`
        changes it.

    Examples
    --------
    >>> a, b = ph.vector([0.1, 0.2, 0.3]), ph.vector([0.4, 0.5, 0.6])
    >>> bool(ph.evaluate("a b = a·b + a∧b", a=a, b=b))
    True
    >>> ph.evaluate("a b = b a", a=ph.e1, b=ph.e1 + 2 * ph.e2)
    Agreement(does not hold, residual 4 of terms of size 2.24, rtol 1e-09)
    """

    __slots__ = ("residual", "rtol", "size")

    def __init__(self, residual: Any, size: Any, rtol: float) -> None:
        self.residual, self.size, self.rtol = residual, size, rtol

    @property
    def holds(self) -> Any:
        """Whether the sides agree: a bool, or an array of the batch shape.

        Examples
        --------
        >>> a = ph.vector([[1, 0, 0], [0, 2, 0]])
        >>> ph.evaluate("a a = 1", a=a).holds
        array([ True, False])
        """
        if self.rtol == 0 or self.size is None:
            return np.equal(self.residual, 0).astype(bool)[()]
        return (self.residual <= self.rtol * self.size) & (self.size < math.inf)

    def within(self, rtol: float) -> Agreement:
        """Return the same with another relative tolerance.

        Examples
        --------
        >>> rounded = ph.evaluate("x = y", x=1.0, y=1.001)
        >>> bool(rounded), bool(rounded.within(0.01))
        (False, True)
        """
        if not 0 <= rtol < math.inf:
            raise ValueError(f"rtol must be finite and not negative, got {rtol!r}")
        if self.size is None:
            raise TypeError("symbols agree identically or not at all; substitute numbers to use a tolerance")
        return Agreement(self.residual, self.size, rtol)

    def __bool__(self) -> bool:
        holds = self.holds
        return bool(namespace(self.residual).all(holds) if getattr(holds, "ndim", 0) else holds)

    def __repr__(self) -> str:
        try:
            holds = np.asarray(self.holds)
            residual = np.asarray(self.residual)
            size = None if self.size is None else np.asarray(self.size)
        except Exception:  # traced or lazy arrays have no numbers; each library raises its own error
            return f"Agreement(residual {self.residual!r}, size {self.size!r}, rtol {self.rtol:g})"
        return f"Agreement({_summary(holds, residual, size)}, rtol {self.rtol:g})"


def _summary(holds: Any, residual: Any, size: Any) -> str:
    """Return the number of rows in which the sides agree, and the largest relative residual."""
    if not holds.size:
        return "no rows"
    if size is None:
        worst = int(np.argmin(holds))
        beside = ""
    else:
        with np.errstate(divide="ignore", invalid="ignore"):
            worst = int(np.argmax(np.where(residual == 0, 0, residual / size)))
        beside = f" of terms of size {size.flat[worst]:.3g}"
    number = residual.flat[worst]
    shown = f"residual {number:.3g}" if isinstance(number, float) else f"residual {number}"
    if not holds.ndim:
        return f"{'holds' if holds else 'does not hold'}, {shown}{beside}"
    index = tuple(int(i) for i in np.unravel_index(worst, holds.shape))
    rows = f"all {holds.size}" if holds.all() else f"{holds.sum()} of {holds.size}"
    return f"holds in {rows} rows, largest {shown}{beside} at index {index}"


@np.errstate(over="ignore", invalid="ignore")  # IEEE, as in the products
def agreement(walk: Walk, program: _native.Program) -> Agreement:
    """Return the agreement of the sides of an equation."""
    groups = program.results
    sides = {i for group in groups for i in group}
    values: dict[int, Multivector] = {}
    sizes: list[tuple[Any, Any]] = []  # of each step the norm, and the size of its terms
    for number, (step, _, value) in enumerate(walk):
        if not walk.symbolic:
            length = _length(walk, value._data)
            of = _length(walk, walk.inputs[step.detail]) if step.name == "map" else length
            operands = [sizes[i] for i in step.operands]
            size = program.term_size(number, of, operands, walk.kind.eps, _floats(walk).xp)
            sizes.append((length, size))
        if number in sides:
            values[number] = value
    pairs = [(group[0], other) for group in groups for other in group[1:]]
    differences = [(values[a] - values[b])._data for a, b in pairs]
    if walk.symbolic:
        return Agreement(_first([_symbolic_residual(d) for d in differences]), None, 0.0)
    kind = _floats(walk)
    found = [
        kind.xp.broadcast_arrays(_residual(walk, d), kind.xp.maximum(sizes[a][1], sizes[b][1]))
        for d, (a, b) in zip(differences, pairs, strict=True)
    ]
    residual, size = _worst(kind, found)
    if kind.native:
        residual, size = residual[()], size[()]
    register_pytree(Agreement, lambda of: ((of.residual, of.size), of.rtol), _restored)
    return Agreement(residual, size, _rtol(walk, differences))


def _restored(rtol: float, leaves: Iterable[Any]) -> Agreement:
    residual, size = leaves
    return Agreement(residual, size, rtol)


def _floats(walk: Walk) -> Numeric:
    """Return the arithmetic of sizes, which are floats; NumPy's for exact numbers."""
    return Numeric(np) if walk.kind.exact or walk.kind.native else walk.kind


def _rtol(walk: Walk, differences: list[Any]) -> float:
    """Return the tolerance of floats; 0 for exact numbers that were not rounded."""
    rounded = not walk.kind.exact or any(
        isinstance(x, float) or is_multiprecision(x) for data in differences for x in data.flat
    )
    return _native.agreement_tolerance(walk.kind.eps) if rounded else 0.0


def _worst(kind: Numeric, pairs: list[Any]) -> tuple[Any, Any]:
    """Return the residual that is largest relative to its size, and that size."""
    (residual, size), *others = pairs
    for r, s in others:
        worse = (r * size > residual * s) | ((s == 0) & (r > 0)) | (r != r)
        residual, size = kind.where(worse, r, residual), kind.where(worse, s, size)
    return residual, size


def _first(residuals: list[Any]) -> Any:
    """Return the first nonzero residual, row by row."""
    found, *others = residuals
    for other in others:
        found = np.where(np.equal(found, 0).astype(bool), other, found)
    return found[()]


def _symbolic_residual(data: Any) -> Any:
    """Return the norm of a difference, row by row; 0 if it vanishes identically."""
    result = np.zeros(data.shape[:-1], dtype=object)
    for index in np.ndindex(result.shape):
        row = [x for x in map(_without_floats, data[index]) if not is_zero(x)]
        if row:
            result[index] = sqrt(sum(x * x for x in row))
    return result


def _without_floats(x: Any) -> Any:
    """Return an expression with floats as exact ratios, so that no digits are lost."""
    sympy = sys.modules["sympy"]
    if not isinstance(x, sympy.Expr):
        return x
    return x.xreplace({number: sympy.Rational(number) for number in x.atoms(sympy.Float)})


def _residual(walk: Walk, data: Any) -> Any:
    """Return the norm of a difference; never 0 for exact numbers that differ."""
    size = _length(walk, data)
    if not walk.kind.exact:
        return size
    return np.where((data != 0).any(axis=-1) & (size == 0), math.ulp(0.0), size)


def _length(walk: Walk, data: Any) -> Any:
    """``√Σ c²``, as floats."""
    kind = _floats(walk)
    if walk.kind.exact and not is_float(data):
        data = np.frompyfunc(_float, 1, 1)(data).astype(np.float64)
    return kind.length(components(kind.asarray(np.abs(data) if is_complex(data) else data)))


def _float(x: Any) -> float:
    try:
        return float(x)
    except OverflowError:
        return math.inf
