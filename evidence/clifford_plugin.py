"""Pytest plugin: in clifford's own tests, the values of clifford compute with Polhode.

clifford keeps its names, its order of coefficients and its arrays; every product, sum, involution, dual,
inverse and function of a value, and every function of a layout on coefficients, is that of Polhode.
"""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable, Iterator
from numbers import Number
from typing import Any

import clifford
import numpy as np
import pytest
from clifford import _mvarray
from numba.core.errors import TypingError

import polhode as ph
from peer_tests import MISSING

MultiVector, Layout = clifford.MultiVector, clifford.Layout
MAX_GENERATORS = 8
computed = 0


@functools.cache
def _basis(sig: tuple[int, ...], bitmaps: tuple[int, ...]) -> tuple[ph.Algebra, Any, Any]:
    """Return our algebra, and the place and the sign there of each of clifford's basis blades."""
    if len(sig) > MAX_GENERATORS:
        pytest.skip(f"{MISSING}algebras of more than {MAX_GENERATORS} generators")
    algebra = ph.algebra(sig.count(1), sig.count(-1), sig.count(0))
    squares = sorted(range(len(sig)), key=lambda k: (1, -1, 0).index(sig[k]))
    generators = {k: algebra.basis_vectors[place] for place, k in enumerate(squares)}
    rows = []
    for bits in bitmaps:
        blade = algebra.scalar(1.0)
        for k in range(len(sig)):
            blade = blade ^ generators[k] if bits >> k & 1 else blade
        rows.append(blade.dense())
    places = np.argmax(np.abs(rows), axis=1)
    return algebra, places, np.array([row[place] for row, place in zip(rows, places, strict=True)])


def ours(layout: Any, value: Any) -> Any:
    """Return Polhode's multivector of an array of coefficients in clifford's order."""
    global computed
    computed += 1
    order = layout._basis_blade_order.index_to_bitmap
    algebra, places, signs = _basis(tuple(int(x) for x in layout.sig), tuple(int(b) for b in order))
    array = np.asarray(value)
    numbers = np.zeros((*array.shape[:-1], algebra.size), dtype=np.result_type(array, np.float32))
    numbers[..., places] = array * signs.astype(numbers.real.dtype)
    return algebra.multivector(numbers)


def theirs(layout: Any, value: Any) -> Any:
    """Return the coefficients of a multivector in clifford's order."""
    order = layout._basis_blade_order.index_to_bitmap
    _, places, signs = _basis(tuple(int(x) for x in layout.sig), tuple(int(b) for b in order))
    numbers = value.dense()
    return numbers[..., places] * signs.astype(numbers.real.dtype)


def _value(self: Any) -> Any:
    return ours(self.layout, self.value)


def _new(self: Any, value: Any) -> Any:
    return self._newMV(theirs(self.layout, value))


def _dot(a: Any, b: Any) -> Any:
    """Return Hestenes's inner product, which leaves out scalars."""
    return (a - a.grade(0)) | (b - b.grade(0))


def _inverse(a: Any) -> Any:
    return a.inverse()


def _dual(a: Any) -> Any:
    return a.right_complement() if a.algebra.signature[2] else a.dual()


def _oriented(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function for clifford's pseudoscalar: null generators come first there, and last in ours."""

    def oriented(a: Any, *others: Any) -> Any:
        p, q, r = a.algebra.signature
        return -function(a, *others) if r * (p + q) % 2 else function(a, *others)

    return oriented


def _part(parity: int) -> Callable[[Any], Any]:
    return lambda a: a.grade(*range(parity, a.algebra.dimension + 1, 2))


OPERATORS: dict[str, Callable[[Any, Any], Any]] = {
    "__add__": lambda a, b: a + b,
    "__radd__": lambda a, b: b + a,
    "__sub__": lambda a, b: a - b,
    "__rsub__": lambda a, b: b - a,
    "__mul__": lambda a, b: a * b,
    "__rmul__": lambda a, b: b * a,
    "__truediv__": lambda a, b: a / b,
    "__rtruediv__": lambda a, b: b / a,
    "__xor__": lambda a, b: a ^ b,
    "__rxor__": lambda a, b: b ^ a,
    "__or__": _dot,
    "__ror__": lambda a, b: _dot(b, a),
    "__and__": _oriented(lambda a, b: a & b),
    "vee": _oriented(lambda a, b: a.vee(b)),
    "lc": lambda a, b: a.left_contraction(b),
    "__lshift__": lambda a, b: a << b,
    "commutator": lambda a, b: a.commutator(b),
    "x": lambda a, b: a.commutator(b),
    "anticommutator": lambda a, b: a.anticommutator(b),
    "project": lambda a, b: b.project(a),
    "join": lambda a, b: a.join(b),
    "meet": lambda a, b: a.meet(b),
}
UNARY: dict[str, Callable[[Any], Any]] = {
    "__neg__": lambda a: -a,
    "adjoint": lambda a: ~a,
    "__invert__": lambda a: ~a,
    "gradeInvol": lambda a: a.grade_involution(),
    "conjugate": lambda a: a.clifford_conjugate(),
    "right_complement": _oriented(lambda a: a.right_complement()),
    "left_complement": _oriented(lambda a: a.left_complement()),
    **dict.fromkeys(("inv", "leftLaInv", "leftInv", "rightInv"), _inverse),
    **dict.fromkeys(("hitzer_inverse", "shirokov_inverse"), _inverse),
    "normal": lambda a: a / a.norm(),
    "exp": lambda a: a.exp(),
    **{name: lambda a, name=name: getattr(a, name)() for name in ("sin", "cos", "tan")},
    **{name: lambda a, name=name: getattr(a, name)() for name in ("sinh", "cosh", "tanh")},
}
# Functions of a layout, of arrays of coefficients.
FUNCTIONS: dict[str, Callable[..., Any]] = {
    "gmt_func": lambda a, b: a * b,
    "omt_func": lambda a, b: a ^ b,
    "imt_func": _dot,
    "lcmt_func": lambda a, b: a.left_contraction(b),
    "vee_func": _oriented(lambda a, b: a.vee(b)),
    "adjoint_func": lambda a: ~a,
    "dual_func": _oriented(_dual),
    "inv_func": _inverse,
    "left_complement_func": _oriented(lambda a: a.left_complement()),
    "right_complement_func": _oriented(lambda a: a.right_complement()),
}


def _operator(name: str, function: Callable[[Any, Any], Any]) -> Callable[..., Any]:
    original = getattr(MultiVector, name)

    @functools.wraps(original)
    def method(self: Any, other: Any, *rest: Any) -> Any:
        right, known = self._checkOther(other)  # a number becomes a scalar
        if not known or rest:
            return original(self, other, *rest)
        number = name == "__truediv__" and isinstance(other, Number)
        return _new(self, function(_value(self), other if number else _value(right)))

    return method


def _function(function: Callable[..., Any]) -> property:
    return property(lambda self: lambda *values: theirs(self, function(*(ours(self, v) for v in values))))


def _grades(self: Any, grade: Any, *others: Any) -> Any:
    if isinstance(grade, MultiVector):
        return grade.project(self)
    dimension = self.layout.dims
    return _new(self, _value(self).grade(*(k for k in (grade, *others) if k <= dimension)))


def _power(self: Any, exponent: Any) -> Any:
    if not isinstance(exponent, (int, float)) or abs(round(exponent) - exponent) > clifford.eps():
        raise ValueError("the exponent must be a whole number")
    return _new(self, _value(self) ** round(exponent))


def _factors(self: Any) -> tuple[list[Any], Any]:
    if not self.isBlade():
        raise ValueError("self is not a blade")
    factors = _value(self).grade(*self.grades()).factor()
    scale = factors[0].norm()
    return [_new(self, factor) for factor in (factors[0] / scale, *factors[1:])], scale


def _attach() -> None:
    for name, binary in OPERATORS.items():
        setattr(MultiVector, name, _operator(name, binary))
    for name, unary in UNARY.items():
        setattr(MultiVector, name, lambda self, unary=unary: _new(self, unary(_value(self))))
    for name, function in FUNCTIONS.items():
        setattr(Layout, name, _function(function))
    MultiVector.even = property(lambda self: _new(self, _part(0)(_value(self))))
    MultiVector.odd = property(lambda self: _new(self, _part(1)(_value(self))))
    MultiVector.dual = lambda self, blade=None: _new(
        self, _oriented(_dual)(_value(self)) if blade is None else _value(self) / _value(blade)
    )
    MultiVector.mag2 = lambda self: (~_value(self) * _value(self)).dense()[0]
    MultiVector.__abs__ = lambda self: np.sqrt(abs(self.mag2()))
    MultiVector.__call__ = _grades
    MultiVector.__pow__ = _power
    MultiVector.__rpow__ = lambda self, base: _new(self, base ** _value(self))
    MultiVector.factorise = _factors
    for name in ("dual", "normal", "__call__"):  # of arrays
        setattr(_mvarray, f"{name.strip('_')}_array", np.vectorize(getattr(MultiVector, name)))


_attach()
warnings.simplefilter("ignore")


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: Any) -> Iterator[None]:
    """Do not count a test that reaches nothing of ours, or that compiles code for clifford's own values."""
    outcome: Any = yield
    report = outcome.get_result()
    if report.when != "call" or report.skipped:
        return
    if call.excinfo is not None and call.excinfo.errisinstance(TypingError):
        reason = "values in code compiled by Numba"
    elif computed == item.stash[_BEFORE]:
        reason = "tests of names, storage and printing"
    else:
        return
    report.outcome, report.longrepr = "skipped", (str(item.path), 0, MISSING + reason)


_BEFORE = pytest.StashKey[int]()


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Remember how much was computed before the test and its fixtures."""
    item.stash[_BEFORE] = computed
