"""Methods of SymPy for values with its expressions as coefficients."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from polhode import _generic, _native

if TYPE_CHECKING:
    from polhode._algebra.multivector import Multivector

V = TypeVar("V", bound="Multivector")


def diff(value: Multivector, *symbols: Any) -> Multivector:
    """Return the derivative of SymPy coefficients, with the arguments of ``sympy.diff``: ``A.diff(t, 2)``.

    That of a rotor is not a rotor. A TypeError for other coefficients: those of JAX have ``jax.jvp``.

    Examples
    --------
    >>> import sympy
    >>> t = sympy.Symbol("t")
    >>> ph.vector([t**2, 3 * t, 1]).diff(t)
    2*t e1 + 3 e2
    """
    data = _mapped(value, "diff", lambda x: x.diff(*symbols))
    return _native.Multivector._of(data, value._mask, value.algebra)


def subs(value: V, *replaced: Any) -> V:
    """Return the value with symbols replaced, with the arguments of ``sympy.subs``.

    ``A.subs(t, 2)``, ``A.subs({t: 2, m: 1})``. The coefficients stay SymPy's; ``.astype(float)`` converts
    numbers. A TypeError for coefficients without expressions.

    Examples
    --------
    >>> import sympy
    >>> t = sympy.Symbol("t")
    >>> ph.vector([t**2, 3 * t, 1]).subs(t, 2)
    4 e1 + 6 e2 + e3
    """
    return value._like(_mapped(value, "subs", lambda x: x.subs(*replaced)))


def simplify(value: V, **options: Any) -> V:
    """Return the value with each coefficient simplified by ``sympy.simplify``, to which options are passed.

    A TypeError for coefficients without expressions.

    Examples
    --------
    >>> import sympy
    >>> t = sympy.Symbol("t", real=True)
    >>> R = ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, t)
    >>> R(ph.e1).simplify()
    cos(t) e1 + sin(t) e2
    """
    return value._like(_mapped(value, "simplify", lambda x: x.simplify(**options)))


def _mapped(value: Multivector, name: str, f: Callable[[Any], Any]) -> Any:
    """Return the components, as SymPy's, with f of each."""
    data = value._data
    if data.dtype != object or not any(map(_generic.exact.is_symbolic, data.flat)):
        kind = type(data.flat[0]).__name__ if data.dtype == object and data.size else data.dtype
        raise TypeError(f"{name} needs coefficients that are SymPy expressions, got {kind}")
    import sympy

    return np.asarray(np.frompyfunc(lambda x: f(sympy.sympify(x)), 1, 1)(data), dtype=object)
