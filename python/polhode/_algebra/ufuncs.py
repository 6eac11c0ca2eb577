"""NumPy's universal functions of values, and operands of pandas and xarray.

``np.exp(A)`` is ``A.exp()``, an array times a value a product.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from polhode import _native
from polhode._algebra.foreign_values import LABELLED
from polhode._support.foreign_names import ForeignName

if TYPE_CHECKING:
    from polhode._algebra.multivector import Multivector

# Functions of one value, and the methods that compute them.
_METHODS = {
    **{getattr(np, name): name for name in ("exp", "log", "sqrt", "sin", "cos", "tan")},
    **{getattr(np, name): name for name in ("sinh", "cosh", "tanh")},
    np.absolute: "norm",
    np.conjugate: "conj",
    np.negative: "__neg__",
    np.positive: "__pos__",
    np.reciprocal: "inverse",
}

# Operators, and those of a right operand.
_OPERATORS = {
    np.add: ("__add__", "__radd__"),
    np.subtract: ("__sub__", "__rsub__"),
    np.multiply: ("__mul__", "__rmul__"),
    np.true_divide: ("__truediv__", "__rtruediv__"),
    np.bitwise_xor: ("__xor__", "__rxor__"),
    np.bitwise_or: ("__or__", "__ror__"),
    np.equal: ("__eq__", "__eq__"),
    np.not_equal: ("__ne__", "__ne__"),
    np.power: ("__pow__", "__rpow__"),
}


# Functions of arrays that have another name for values, and what to write.
_OURS = {
    "allclose": "np.all(A.is_close(B))",
    **dict.fromkeys(("append", "concatenate", "hstack", "vstack"), "ph.concatenate([A, B])"),
    **dict.fromkeys(("arccos", "arctan2"), "ph.Rotor.from_vectors(a, b).angle for the angle between vectors"),
    "array_equal": "np.all(A == B)",
    "clip": "np.clip(A.components, x, y)",
    "copy": "A, which is immutable",
    "cross": "ph.cross(a, b)",
    **{name: f"np.{name}(A.components)" for name in ("deg2rad", "degrees", "rad2deg", "radians")},
    "diff": "A[1:] - A[:-1]",
    "dot": "A.dot(B)",
    "expand_dims": "A[None]",
    "flip": "A[::-1]",
    "inner": "A.dot(B)",
    "inv": "A.inverse()",
    "isclose": "A.is_close(B)",
    "isfinite": "A.is_finite()",
    "isinf": "A.is_finite()",
    "isnan": "A.is_finite()",
    "matmul": "R * S for rotors, ph.vector(M @ a.components) for a matrix M",
    "mean": "A.mean()",
    "ndim": "len(A.shape)",
    "norm": "A.norm()",
    **dict.fromkeys(
        ("cumprod", "multiply.accumulate"), "ph.stack(list(itertools.accumulate(R, operator.mul)))"
    ),
    **dict.fromkeys(("multiply.reduce", "prod"), "functools.reduce(operator.mul, R)"),
    "ravel": "A.reshape(-1)",
    "repeat": "A[np.repeat(np.arange(len(A)), k)]",
    **dict.fromkeys(("reshape", "squeeze"), "A.reshape(shape)"),
    "round": "A.map(np.round)",
    "shape": "A.shape",
    "size": "math.prod(A.shape)",
    "square": "A * A",
    "stack": "ph.stack([A, B])",
    "sum": "A.sum()",
    "take": "A[[0, 1]]",
    "vdot": "A.scalar_product(B)",
    "where": "A.algebra.multivector(np.where(c[..., None], A.dense(), B.dense()))",
}


class Override:
    """The attribute ``__array_ufunc__``: the function for NumPy, which asks the type, None on values.

    Other libraries (CuPy, Dask) ask the value, and leave operators to it where it has None.
    """

    def __get__(self, value: Any, owner: Any = None) -> Any:
        return applied if value is None else None


def applied(_value: Multivector, function: Any, method: str, *inputs: Any, **options: Any) -> Any:
    """Return a universal function of values; a TypeError, with the remedy, if it is not one of values."""
    if method == "__call__" and not options:
        names = _OPERATORS.get(function)
        if names is not None:
            left, right = inputs
            if isinstance(left, _native.Multivector):
                result = getattr(left, names[0])(right)
            else:
                result = getattr(right, names[1], _refused)(left)
            if result is not NotImplemented:
                return result
        elif function in _METHODS:
            return getattr(inputs[0], _METHODS[function])()
    name = function.__name__ if method == "__call__" else f"{function.__name__}.{method}"
    what = "these operands with out" if "out" in options else "these operands"
    remedy = remedy_of(name, "use the operators and methods of multivectors, or NumPy on their .components")
    raise TypeError(f"np.{name} does not accept {what}; {remedy}")


def remedy_of(function: str, others: str) -> str:
    """Return what to write instead of a function of NumPy, and what else can be used."""
    return f"write {_OURS[function]}, or {others}" if function in _OURS else others


# The attribute ``variable``, which xarray reads of an operand beside a DataArray or Dataset. There it is a
# TypeError, which no default hides: xarray would wrap the product of its numbers and the value.
class OperandOfXarray(ForeignName):
    __slots__ = ("__doc__",)

    def __get__(self, value: Any, owner: Any = None) -> NoReturn:
        reader = sys._getframe(1).f_globals.get("__name__", "")
        if value is not None and reader.startswith("xarray."):
            raise TypeError(LABELLED.format("arrays of xarray"))
        raise AttributeError(f"{(owner or type(value)).__name__!r} object has no attribute {self.name!r}")


def _refused(_: Any) -> Any:
    return NotImplemented
