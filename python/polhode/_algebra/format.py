"""Text and LaTeX of values: ``2 e1 + 3 e2∧e3``, in the notation of formulas."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from polhode._generic.exact import is_symbolic

_SHOWN = 6
_NEW_LINE = r" \\ "
_SIGN = re.compile(r"^(.?[<>=^])?[-+ ]")  # of a format, after the alignment


class _Notation(NamedTuple):
    """The sign and magnitude of a coefficient, the space before a blade and the blade, an ellipsis."""

    coefficient: Callable[[Any], tuple[bool, str]]
    blade: Callable[[str], tuple[str, str]]
    more: str


def value(name: str, data: Any, blades: Sequence[str], spec: str = "") -> str:
    """Return the ``repr``: the value, or the first and last values of a batch.

    `spec` is a format of the components. Without one, floats have as many significant digits as NumPy's
    option `precision`, by default 8; with its option `suppress`, as many decimals and no exponents.
    """
    batch = tuple(data.shape[:-1])
    array = _numbers(data)
    if array is None:
        basis = ", ".join(blade or "1" for blade in blades)
        return f"{name} of shape {batch} over ({basis}):\n{data!r}"
    notation = _in_format(spec) if spec else _TEXT
    if not batch:
        return _sum(array, blades, notation)
    lines = ",\n ".join(_shown(array, 1, lambda row: _sum(row, blades, notation), notation.more))
    return f"{name} of shape {batch}:\n[{lines}]"


def latex(
    name: str, data: Any, blades: Sequence[str], show: Callable[[Any], str] | None = None
) -> str | None:
    """Return LaTeX for notebooks; None, so that the text is shown, if the values are not known.

    `show` writes expressions, by default as ``sympy.latex`` does.
    """
    array = _numbers(data)
    if array is None:
        return None
    notation = _LATEX._replace(coefficient=lambda x: _sign_and_latex(x, show))
    return _displayed(name, array, 1, lambda row: _sum(row, blades, notation))


def bare_latex(
    name: str, data: Any, blades: Sequence[str], show: Callable[[Any], str] | None = None
) -> str | None:
    """Return LaTeX without dollar signs; None if the values are not known."""
    text = latex(name, data, blades, show)
    return None if text is None else text.strip("$")


def matrix_latex(name: str, matrices: Any) -> str:
    """Return LaTeX of matrices (..., 3, 3) for notebooks."""

    def one(matrix: Any) -> str:
        lines = [" & ".join(_signed_latex(x) for x in line) for line in matrix]
        return rf"\begin{{pmatrix}} {_NEW_LINE.join(lines)} \end{{pmatrix}}"

    return _displayed(name, matrices, 2, one)


def _numbers(data: Any) -> Any:
    """Return a NumPy array; None for traced and lazy arrays, whose values are not known."""
    try:
        return np.asarray(data).reshape(data.shape)
    except Exception:  # each library has its own error
        return None


def _shown(array: Any, axes: int, write: Callable[[Any], str], more: str) -> list[str]:
    """Return lines of the first and last values of a batch, of `axes` axes each."""
    return first_and_last(array.reshape(-1, *array.shape[-axes:]), write, more)


def first_and_last(values: Any, write: Callable[[Any], str], more: str = "…") -> list[str]:
    """Return lines of the first and last of many values, or of all if they are few."""
    count = len(values)
    lines = [write(values[i]) for i in range(count if count <= _SHOWN else _SHOWN - 1)]
    return [*lines, more, write(values[count - 1])] if count > _SHOWN else lines


def _displayed(name: str, array: Any, axes: int, write: Callable[[Any], str]) -> str:
    """Return LaTeX of one value, or of a batch: its shape and its first and last values."""
    batch = array.shape[:-axes]
    if not batch:
        return f"${write(array)}$"
    lines = [rf"\text{{{name} of shape }} {batch}", *_shown(array, axes, write, _LATEX.more)]
    return rf"$$\begin{{array}}{{l}} {_NEW_LINE.join(lines)} \end{{array}}$$"


def _sum(components: Any, blades: Sequence[str], notation: _Notation) -> str:
    """Return one value as a sum of its nonzero terms."""
    text = ""
    for x, blade in zip(components, blades, strict=True):
        if _is_zero(x):
            continue
        negative, size = notation.coefficient(x)
        if size == "0":  # rounded
            continue
        space, element = notation.blade(blade)
        term = size if not blade else element if size == "1" else size + space + element
        if text:
            text += f" - {term}" if negative else f" + {term}"
        else:
            text = f"-{term}" if negative else term
    return text or notation.coefficient(0.0)[1]


def _is_zero(x: Any) -> bool:
    return bool(x == 0)


# --- text


def _sign_and_size(x: Any) -> tuple[bool, str]:
    """Return the sign and magnitude of a number or an expression; a sum is bracketed."""
    if isinstance(x, float | np.floating):
        return bool(x < 0), _digits(abs(float(x)))
    if isinstance(x, complex | np.complexfloating):
        return _complex(complex(x), "{}{}{}j", _digits)
    text = str(x)
    if is_symbolic(x):  # whole powers are x^2 and x^-2 in formulas
        text = re.sub(r"\*\*(?:(\d+)(?![.\d])|\((-\d+)\))", r"^\1\2", text)
    if " " in text:
        return False, f"({text})"
    return text.startswith("-"), text.lstrip("+-")


def _complex(x: complex, form: str, write: Callable[[float], str]) -> tuple[bool, str]:
    """Return the sign and magnitude of a real or imaginary number; other complex ones in brackets."""
    if x.imag == 0:
        return bool(x.real < 0), write(abs(x.real))
    if x.real == 0:
        return bool(x.imag < 0), form.format("", "", write(abs(x.imag)))
    signs = "-" if x.real < 0 else "", "-" if x.imag < 0 else "+"
    return False, "(" + form.format(signs[0] + write(abs(x.real)), signs[1], write(abs(x.imag))) + ")"


def _digits(x: float) -> str:
    """Return a magnitude in NumPy's options for printing."""
    options: dict[str, Any] = {**np.get_printoptions()}
    precision = options["precision"]
    if options["suppress"] and math.isfinite(x):
        text = f"{x:.{precision}f}"
        return text.rstrip("0").rstrip(".") if "." in text else text
    return f"{x:.{precision}g}"


def _in_format(spec: str) -> _Notation:
    """Return a notation with components in a format; its sign is the one between the terms."""
    unsigned = _SIGN.sub(r"\1", spec)

    def coefficient(x: Any) -> tuple[bool, str]:
        try:
            if isinstance(x, complex | np.complexfloating):
                return _complex(complex(x), "{}{}{}j", lambda part: format(part, unsigned))
            number = x if isinstance(x, int | float | np.floating) else float(x)
        except TypeError:
            raise TypeError(f"the format {spec!r} needs numbers, got the component {x}; use str") from None
        return bool(number < 0), format(abs(number), unsigned)

    return _Notation(coefficient, _TEXT.blade, _TEXT.more)


_TEXT = _Notation(_sign_and_size, lambda blade: (" ", blade), "…")


# --- LaTeX


def _sign_and_latex(x: Any, show: Callable[[Any], str] | None = None) -> tuple[bool, str]:
    """Return the sign and magnitude in LaTeX; a sum is bracketed."""
    if is_symbolic(x):
        return _symbolic_latex(x, show)
    if isinstance(x, complex | np.complexfloating):
        negative, size = _complex(complex(x), "{}{}{} i", lambda part: _sign_and_latex(part)[1])
        return negative, rf"\left{size[:-1]}\right)" if size.startswith("(") else size
    negative, size = _sign_and_size(x)
    if isinstance(x, Fraction) and x.denominator != 1:
        return negative, rf"\frac{{{abs(x.numerator)}}}{{{x.denominator}}}"
    if size in ("inf", "nan"):
        return negative, r"\infty" if size == "inf" else r"\mathrm{NaN}"
    digits, _, exponent = size.partition("e")
    if not exponent:
        return negative, size
    power = f"10^{{{int(exponent)}}}"
    return negative, power if digits == "1" else rf"{digits} {{\times}} {power}"


def _symbolic_latex(x: Any, show: Callable[[Any], str] | None) -> tuple[bool, str]:
    import sympy

    show = show or sympy.latex
    if x.is_Add or x.is_Piecewise:
        return False, rf"\left({show(x)}\right)"
    negative = x.could_extract_minus_sign()
    return negative, show(-x if negative else x)


def _signed_latex(x: Any) -> str:
    negative, size = _sign_and_latex(x)
    return f"-{size}" if negative else size


def _blade_latex(blade: str) -> tuple[str, str]:
    """Return the space before a blade and its LaTeX; a wedge is set tighter than the product."""
    space = r"\," if "∧" in blade else " "
    return space, re.sub(r"(\d)", r"_{\1}", blade).replace("∧", r"{\wedge}")


_LATEX = _Notation(_sign_and_latex, _blade_latex, r"\vdots")
