"""Kinds of coefficients for tests of the same laws.

All numbers are halves of small whole numbers, so that sums of triple products are exact in every kind, also
in single precision, and polynomial laws hold with `==`. A kind makes values of such numbers, evaluates
functions of them in its way (JAX also compiled), tells whether results are of its own type, and how close
they must be where there is rounding.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import polhode as ph
from naive import GRADES

SIZES = {0: 1, 1: 3, 2: 3, 3: 1}


def halves(shape, seed):
    """Small whole numbers over 2, none of them 0, as an array of fractions."""
    rng = np.random.default_rng(seed)
    numbers = rng.integers(1, 10, shape) * rng.choice([-1, 1], shape)
    return np.frompyfunc(lambda n: Fraction(int(n), 2), 1, 1)(numbers) if shape else Fraction(int(numbers), 2)


@dataclass(frozen=True)
class Kind:
    """Floats of NumPy; the base class of the other kinds."""

    name: str
    dtype: Any = np.float64
    eps: float = 2.0**-52
    exact: bool = False

    def array(self, numbers):
        return np.asarray(numbers, dtype=self.dtype)

    def evaluate(self, f, *values):
        return f(*values)

    def is_own(self, data):
        return type(data) is np.ndarray and data.dtype == self.dtype

    def floats(self, data):
        """The values as float64."""
        return np.asarray(data, dtype=np.float64)

    def equal(self, x, y):
        return bool(np.all(np.asarray(x == y)))

    # --- the same for all

    def value(self, numbers, grades=GRADES):
        """The value of the components (..., 8) that are of the grades given."""
        place = {0: [0], 1: [1, 2, 3], 2: [4, 5, 6], 3: [7]}
        data = self.array(numbers[..., [i for k in grades for i in place[k]]])
        return ph.Multivector._of(data, sum(1 << k for k in grades), ph.algebra(3))

    def random(self, seed, shape=(), grades=GRADES):
        return self.value(halves((*shape, 8), seed), grades)

    def own(self, value):
        """A basis element, for floats of NumPy in the kind's precision: products are as precise as both."""
        return value.astype(np.float32) if self.dtype == np.float32 else value

    def holds(self, value):
        """Whether a value is of this kind."""
        return self.is_own(value.components)

    def near(self, left, right, count=16, size=1.0):
        """Equal to `count` roundings of numbers of this size."""
        difference = self.floats((left - right).components)
        return bool(np.all(np.linalg.norm(difference, axis=-1) <= count * self.eps * size))


@dataclass(frozen=True)
class Objects(Kind):
    """NumPy arrays of Python objects of some types."""

    types: tuple[Any, ...] = (int,)
    make: Any = int
    dtype: Any = object
    exact: bool = True

    def array(self, numbers):
        made = np.empty(np.shape(numbers), dtype=object)
        made[...] = np.frompyfunc(self.make, 1, 1)(numbers)
        return made

    def is_own(self, data):
        return data.dtype == object and all(isinstance(x, self.types) for x in data.flat)


@dataclass(frozen=True)
class Symbols(Objects):
    """Half of the components SymPy symbols, the others rational; results are compared expanded."""

    def equal(self, x, y):
        import sympy

        different = (ph.scalar(0) + (x - y)).components
        return all(sympy.expand(d) == 0 for d in different.flat)


@dataclass(frozen=True)
class Library(Kind):
    """Arrays of another library."""

    module: Any = None
    single: bool = False
    compiled: bool = False

    def array(self, numbers):
        dtype = self.module.float32 if self.single else self.module.float64
        return self.module.asarray(np.asarray(numbers, dtype=np.float64), dtype=dtype)

    def evaluate(self, f, *values):
        if not self.compiled:
            return f(*values)
        import jax

        return jax.jit(f)(*values)

    def is_own(self, data):
        dtype = self.module.float32 if self.single else self.module.float64
        return type(data).__module__.partition(".")[0] in self._names() and data.dtype == dtype

    def _names(self):
        return ("jax", "jaxlib") if "jax" in self.module.__name__ else (self.module.__name__,)


def _symbols():
    sympy = pytest.importorskip("sympy")
    names = {}

    def make(x):
        n = 2 * x
        if n % 2:  # odd halves become symbols, one for each number
            return names.setdefault(x, sympy.Symbol(f"x{len(names)}", real=True))
        return sympy.Rational(x.numerator, x.denominator)

    return Symbols("sympy", types=(sympy.Expr, int), make=make)


def _numbers_of_sympy():
    sympy = pytest.importorskip("sympy")
    return Objects(
        "sympy-numbers", types=(sympy.Expr, int), make=lambda x: sympy.Rational(x.numerator, x.denominator)
    )


def _multiprecision():
    mpmath = pytest.importorskip("mpmath")
    own = mpmath.mpf
    return Objects("mpmath", types=(own, int), make=lambda x: own(x.numerator) / x.denominator, exact=False)


def _jax(**options):
    jnp = pytest.importorskip("jax.numpy")
    ph.scalar(jnp.asarray(1.0))  # also registers values made without the constructors
    return Library("jax", module=jnp, **options)


def _strict(**options):
    return Library("array-api-strict", module=pytest.importorskip("array_api_strict"), **options)


_SINGLE = {"eps": 2.0**-23, "single": True}
_MAKERS = {
    "float64": lambda: Kind("float64"),
    "float32": lambda: Kind("float32", np.float32, 2.0**-23),
    "int": lambda: Objects("int", types=(int, Fraction), make=lambda x: int(2 * x)),
    "fraction": lambda: Objects("fraction", types=(int, Fraction), make=lambda x: x / 3),
    "sympy": _symbols,
    "sympy-numbers": _numbers_of_sympy,
    "mpmath": _multiprecision,
    "jax": _jax,
    "jax-jit": lambda: _jax(compiled=True),
    "jax-float32": lambda: _jax(**_SINGLE),
    "array-api-strict": _strict,
    "array-api-strict-float32": lambda: _strict(**_SINGLE),
}


def kinds(*names):
    """A fixture over the kinds of these names, or over all. JAX has 64 bits."""

    @pytest.fixture(params=names or _MAKERS, name="kind")
    def kind(request):
        if not request.param.startswith("jax"):
            yield _MAKERS[request.param]()
            return
        jax = pytest.importorskip("jax")
        with jax.enable_x64(True):
            yield _MAKERS[request.param]()

    return kind


# For tests with hundreds of cases: these kinds resemble others, and shorter tests have them too.
_VARIANTS = ("sympy-numbers", "jax-jit", "jax-float32", "array-api-strict-float32")
VARIANTS_SLOW = [pytest.param(name, marks=pytest.mark.slow if name in _VARIANTS else ()) for name in _MAKERS]
ROUNDING = (
    "float64",
    "float32",
    "jax",
    "jax-jit",
    "jax-float32",
    "array-api-strict",
    "array-api-strict-float32",
)
EXACT = ("int", "fraction", "sympy-numbers")
