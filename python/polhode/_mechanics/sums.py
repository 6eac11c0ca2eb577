"""Sums and multiples of laws."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from numbers import Real
from typing import Any, ClassVar, NoReturn, Self, TypeVar

from polhode import _native
from polhode._algebra.foreign_values import has_reflected
from polhode._algebra.multivector import Multivector
from polhode._mechanics.parameters import Batch, common
from polhode._support.arrays import Shape, as_components

CONSTANT_TORQUE = "for a constant torque write constant_body(N) or constant_space(N)"

L = TypeVar("L", _native.Law, _native.Force)


@dataclass(frozen=True, repr=False)
class Sum:
    """A sum of laws; laws are immutable values: equal if their arguments are equal, hashable, picklable."""

    laws: tuple[Any, ...]
    # An array does not add a law to each of its elements.
    __array_ufunc__ = None
    # Remedy for other summands: what to write for a constant.
    _constant: ClassVar[str] = ""

    def __add__(self, other: Self) -> Self:
        if isinstance(other, type(self)):
            return type(self)(self.laws + other.laws)
        return self if _is_zero(other) else self._refuse_sum(other, "__radd__")

    def __radd__(self, other: int) -> Self:
        """``0 + law``, so that ``sum(laws)`` works."""
        return self if _is_zero(other) else self._refuse_sum(other)

    def __sub__(self, other: Self) -> Self:
        if isinstance(other, type(self)):
            return self + other._scaled(-1.0, "subtracted")
        return self if _is_zero(other) else self._refuse_sum(other, "__rsub__")

    def __rsub__(self, other: int) -> Self:
        return -self if _is_zero(other) else self._refuse_sum(other)

    def __neg__(self) -> Self:
        return -1.0 * self

    def __mul__(self, factor: float) -> Self:
        number = self._number(factor, "multiplied")
        return self._scaled(number, f"multiplied by {number:g}")

    def __rmul__(self, factor: float) -> Self:
        return self * factor

    def __truediv__(self, divisor: float) -> Self:
        number = self._number(divisor, "divided")
        if number == 0:
            raise ZeroDivisionError(f"a {type(self).__name__} cannot be divided by 0")
        if not math.isfinite(1.0 / number):
            raise ValueError(
                f"a {type(self).__name__} cannot be divided by {number}, whose reciprocal is not finite"
            )
        return self._scaled(1.0 / number, f"divided by {number:g}")

    def __matmul__(self, other: object) -> NoReturn:
        raise TypeError("laws are joined by +; write law1 + law2")

    @property
    def shape(self) -> Shape:
        """Shape of the batch of bodies that the arguments describe; ``()`` for a single body."""
        shapes: dict[str, Shape] = {}
        numbers: Counter[str] = Counter()
        for law in self.laws:
            numbers[law.name] += 1
            number = numbers[law.name]
            shapes[law.name if number == 1 else f"{law.name} ({number})"] = law.shape
        return common(shapes, "the laws")

    def _scaled(self, factor: float, done: str) -> Self:
        """Return the laws multiplied by a number; `done` is what an error says cannot be done to them."""
        return type(self)(tuple(self._multiple(law, factor, done) for law in self.laws))

    def _multiple(self, law: Any, factor: float, done: str) -> Any:
        """Return a law multiplied by a number."""
        raise TypeError(f"a {self._name()} cannot be {done}; change its parameters, as in damping(2 * g)")

    def _number(self, value: Any, done: str) -> float:
        """Return a finite factor or divisor; a TypeError for anything but a real number."""
        if isinstance(value, Multivector) and value.grades == (0,) and not value.shape:
            value = float(value)
        if not isinstance(value, Real):
            remedy = (
                "join laws by +" if isinstance(value, Sum) else "for many bodies give arrays of parameters"
            )
            name = type(self).__name__
            raise TypeError(f"a {name} is {done} by one number, got {type(value).__name__}; {remedy}")
        try:
            number = float(value)
        except OverflowError:  # an integer or a fraction
            number = math.inf
        if not math.isfinite(number):
            raise ValueError(f"a {type(self).__name__} cannot be {done} by {number}; give a finite number")
        return number

    def _refuse_sum(self, other: Any, reflected: str = "") -> Any:
        """Raise a TypeError for another summand, unless its class defines the `reflected` operator."""
        if reflected and has_reflected(other, reflected):
            return NotImplemented
        if isinstance(other, Sum):
            if type(other).__name__ == type(self).__name__:
                raise TypeError(
                    f"cannot add a {self._name()} and a {other._name()}; use the laws of one of these modules"
                )
            raise TypeError("cannot add a torque and a force; pass them as torque= and force=")
        is_function = callable(other) and not isinstance(other, Multivector)
        name, remedy = type(self).__name__, "write function(f)" if is_function else self._constant
        raise TypeError(
            f"a {name} can only be added to a {name}, got {type(other).__name__}{remedy and f'; {remedy}'}"
        )

    def _name(self) -> str:
        """Return the name of the class, with that of its public module."""
        return f"{type(self).__module__.replace('._laws', '.torque')}.{type(self).__name__}"


def require_single(law: Sum) -> None:
    """Raise a ValueError for laws of a batch of bodies, naming the parameter that is a batch."""
    if law.shape:
        first = next(one for one in law.laws if one.shape)
        raise ValueError(
            f"the {type(law).__name__.lower()} must be that of a single body, got batch shape {law.shape}: "
            f"an array of numbers in {first.name} is one for each body"
        )


def _is_zero(value: object) -> bool:
    return isinstance(value, int) and value == 0


def multiple(law: L, factor: float, linear: tuple[int, ...], done: str) -> L:
    """Return a law of the core that exerts `factor` times as much; it is `linear` in these arguments.

    `done` is what an error says cannot be done to the law, such as ``"multiplied by 2"``.
    """
    if law.name == "formula":
        text, *rest = law.arguments
        sign = "-" if factor == -1 else f"{factor!r} "
        return type(law)("formula", f"{sign}({text})", *rest)
    if law.name == "function":
        f, *rest = law.arguments
        return type(law)("function", Multiple.of(f, factor), *rest)
    if not linear:
        raise TypeError(
            f"{law.name} cannot be {done}: it is not proportional to any of its parameters; change them, or "
            "write the law as a formula"
        )
    arguments = list(law.arguments)
    for k in linear:
        arguments[k] = _times(arguments[k], factor)
    try:
        return type(law)(law.name, *arguments)
    except ValueError as error:
        remedy = "; a formula takes any sign" if factor < 0 else ""
        raise ValueError(f"{law.name} cannot be {done}: {error}{remedy}") from None


def _times(argument: Any, factor: float) -> Any:
    """Return the numbers of an argument, or of a batch or a table, times a number."""
    if isinstance(argument, Batch):
        return Batch(factor * argument.rows + 0.0, argument.like)
    if isinstance(argument, tuple):
        return tuple(_times(x, factor) for x in argument)
    return factor * argument + 0.0  # no zero is negative


@dataclass(frozen=True, repr=False)
class Multiple:
    """A Python function of a law times a number: picklable if the function is."""

    f: Callable[..., Any]
    factor: float

    @staticmethod
    def of(f: Callable[..., Any], factor: float) -> Multiple:
        """Return the multiple of a function, which may be a multiple itself."""
        return Multiple(f.f, f.factor * factor) if isinstance(f, Multiple) else Multiple(f, factor)

    def __call__(self, *arguments: Any) -> Any:
        value = self.f(*arguments)
        if isinstance(value, Multivector):
            return self.factor * value
        try:
            return self.factor * as_components(value, 3, "the value")
        except (TypeError, ValueError):
            return value  # which the core reports

    def __repr__(self) -> str:
        return f"{self.factor!r} * {getattr(self.f, '__name__', self.f)}"
