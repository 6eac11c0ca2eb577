"""Formulas in the notation of the handout, compiled once and called on values of any kind."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from polhode import _native
from polhode._algebra.algebra import Algebra
from polhode._algebra.native import joins
from polhode._formula.agreement import Agreement
from polhode._formula.arguments import kinds_of
from polhode._formula.errors import FormulaError, check_encoding
from polhode._formula.evaluation import called
from polhode._formula.interpreter import Step, steps_of

__all__ = ["Agreement", "Formula", "FormulaError", "evaluate", "formula"]

_LANGUAGES = ("python", "c", "rust", "glsl")


@joins(_native.FormulaCaller)
class Formula(_native.FormulaCaller):
    """A formula as written on paper: ``f = ph.formula("R (x·Ω) ~R")``, then ``f(R=R, x=x, Ω=Ω)``.

    Juxtaposition is the geometric product; ``∧`` (``^``), ``·`` (``|``) and ``×``, the commutator, bind
    tighter than it. One-letter names may run together: ``RaR̃`` is ``R a ~R``.

    Call it with values by name, as keywords or, for names such as ``R'`` and ``a∥``, in a mapping; or by
    position, in the order of `arguments` if the formula was made with these. Values are
    multivectors, rotors, linear maps, numbers, and arrays as batches of numbers. Batches broadcast,
    coefficients are of any kind, and grades are checked before anything is computed. Names that the formula
    does not use are ignored, but for ``out``: an array that receives the components of the value. The value
    of an equation is an `Agreement`.

    Create it with `formula`. Formulas of the same text, algebra, definitions and arguments are equal.

    Examples
    --------
    >>> f = ph.formula("(a∧b)·c")
    >>> f(a=ph.e1, b=ph.e2, c=ph.vector([2, 3, 4]))
    3 e1 - 2 e2
    >>> f(a=ph.e1, b=ph.e2, c=ph.vector([[1, 0, 0], [0, 1, 0]]))
    Multivector of shape (2,):
    [-e2,
     e1]
    >>> f.grades(a=1, b=1, c=1)
    (1,)
    """

    @property
    def text(self) -> str:
        """The text as it was given.

        Examples
        --------
        >>> ph.formula("R x ~R").text
        'R x ~R'
        """
        return self._core.text

    @property
    def arguments(self) -> tuple[str, ...]:
        """The names of the values that a call takes by position; empty if it takes values by name only.

        Examples
        --------
        >>> ph.formula("R x ~R", arguments="R x").arguments
        ('R', 'x')
        """
        return tuple(self._core.arguments)

    def __str__(self) -> str:
        """The formula in canonical spelling."""
        return self.spelled("unicode")

    @property
    def ascii(self) -> str:
        """The formula in ASCII spelling; names stay as they are.

        Examples
        --------
        >>> ph.formula("½ a∧b").ascii
        '1/2 a^b'
        """
        return self.spelled("ascii")

    @property
    def latex(self) -> str:
        r"""The formula in LaTeX, for math mode.

        Examples
        --------
        >>> print(ph.formula("R x ~R").latex)
        R x \tilde{R}
        """
        return self.spelled("latex")

    def _repr_latex_(self) -> str:
        return f"${self.latex}$"

    # --- before evaluation

    def spelled(self, style: str, /, **kinds: Any) -> str:
        """Return the formula in canonical spelling, "unicode", "ascii" or "latex".

        `kinds`, as for `tree`, distinguish adjacent names from one long name. By default a word is one name.

        Examples
        --------
        >>> ph.formula("ab").spelled("unicode")
        'ab'
        >>> ph.formula("ab").spelled("unicode", a=1, b=1)
        'a b'
        """
        return self._core.spelled(style, *kinds_of(self._core.algebra, kinds))

    def tree(self, /, **kinds: Any) -> dict[str, Any]:
        """Return the syntax tree: nested dictionaries of kind, text, span (in characters), grades, children.

        `kinds` are the kinds of the names: one or several grades, ``a=1, M=(0, 2)``; ``R="rotor"``;
        ``inertia="map of bivectors"``, ``"map of vectors"``; or a value. Without any, each word is one name
        of a value of any grades.

        Examples
        --------
        >>> tree = ph.formula("a∧b").tree(a=1, b=1)
        >>> tree["kind"], tree["grades"], [child["text"] for child in tree["children"]]
        ('wedge', (2,), ['a', 'b'])
        """
        algebra, items = kinds_of(self._core.algebra, kinds)
        return self._core.tree(algebra, items)

    def grades(self, /, **kinds: Any) -> tuple[int, ...]:
        """Return the grades of the value for names of these kinds, as for `tree`.

        Examples
        --------
        >>> ph.formula("a b").grades(a=1, b=1)
        (0, 2)
        >>> ph.formula("R a ~R").grades(R="rotor", a=1)
        (1,)
        """
        program = self._program(kinds)
        masks = [step[3] for step in program.steps]
        mask = 0
        for sides in program.results:
            for side in sides:
                mask |= masks[side]
        return tuple(k for k in range(mask.bit_length()) if mask >> k & 1)

    def steps(self, /, **kinds: Any) -> list[str]:
        """Return the steps of the computation for names of these kinds, as for `tree`.

        Examples
        --------
        >>> for step in ph.formula("a·b + a∧b").steps(a=1, b=1):
        ...     print(step)
        #1 = dot(a, b): grade 0, for a·b
        #2 = wedge(a, b): grade 2, for a∧b
        #3 = add(#1, #2): grade 0, 2, for a·b + a∧b
        """
        program = self._program(kinds)
        return _described(self.text, steps_of(program), program.names)

    def code(self, language: str, function: str = "formula", /, **kinds: Any) -> str:
        """Return the source of a function that computes the formula, for names of these kinds.

        A comment in the source gives the arguments, in the order of `kinds`, and the components of each:
        scalars are numbers, other values arrays as `Multivector.components`, linear maps matrices by rows. A
        scalar result is returned; other results are returned as an array, or in C and GLSL written to the
        last argument. Equal parts are computed once.

        Functions become those of the language, without the special cases of Polhode: division by zero and
        the root or logarithm of a negative number give NaN or infinity, that of the rotor −1 gives 0.
        Functions of multivectors are written out where they have a formula in numbers: exp of values whose
        square is a number, log and sqrt of rotors, inverses in at most five dimensions.

        Parameters
        ----------
        language
            ``"python"`` (NumPy, also for batches), ``"c"`` (C99, double), ``"rust"`` (f64), ``"glsl"`` (GLSL
            ES 3.00, float), or ``"latex"``: the formula itself, for math mode.
        function
            The name of the function.
        kinds
            The kinds of the names, as for `tree`. Unused names are not arguments.

        Raises
        ------
        ValueError
            If the language is unknown or the name cannot be that of a function.
        FormulaError
            If grades do not fit; for an equation, and for a function without a formula in numbers.

        Examples
        --------
        >>> source = ph.formula("a·b").code("c", "dot", a=1, b=1)
        >>> print(source[source.index("double dot") :])
        double dot(const double a[3], const double b[3]) {
            const double t1 = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            return t1;
        }
        """
        if language == "latex":
            return self.spelled("latex", **kinds)
        if language not in _LANGUAGES:
            known = ", ".join(map(repr, _LANGUAGES))
            raise ValueError(f"language must be one of {known}, 'latex', got {language!r}")
        if not isinstance(function, str):
            raise TypeError(f"the name of the function must be a string, got {type(function).__name__}")
        return self._core.code(language, function, *kinds_of(self._core.algebra, kinds))

    def _program(self, kinds: dict[str, Any]) -> _native.Program:
        algebra, items = kinds_of(self._core.algebra, kinds)
        return self._core.program(algebra, items)

    # --- derivatives

    def grad(self, *names: str) -> Callable[..., Any]:
        """Return a function for the gradients of a scalar formula with respect to these names, by JAX.

        It takes values as the formula does. The gradient with respect to a name has the grades of its value;
        its components are the derivatives with respect to those of the value. Several names give a tuple.
        NumPy arrays give float64 NumPy arrays; JAX arrays, also traced ones, give JAX arrays.
        Each row of a batch has its own gradient.

        Examples
        --------
        >>> energy = ph.formula("½ k x·x")
        >>> energy.grad("x")(k=3, x=ph.vector([1, 2, 0]))
        3 e1 + 6 e2
        """
        from polhode._formula.gradient import gradient

        return gradient(self._core, names)

    def __repr__(self) -> str:
        arguments = f", arguments={self.arguments!r}" if self.arguments else ""
        return f"ph.formula({self.text!r}{arguments})"

    def _key(self) -> tuple[Any, ...]:
        return self.text, self._core.algebra, tuple(self._core.definitions), self.arguments

    def __eq__(self, other: object) -> bool:
        return self._key() == other._key() if isinstance(other, Formula) else NotImplemented

    def __hash__(self) -> int:
        return hash((self.text, tuple(self._core.definitions), self.arguments))

    def __reduce__(self) -> tuple[Any, ...]:
        text, algebra, definitions, arguments = self._key()
        return formula, (text, algebra, dict(definitions), arguments)


def formula(
    text: str,
    algebra: Algebra | None = None,
    define: Mapping[str, str] | None = None,
    arguments: str | Iterable[str] = (),
) -> Formula:
    """Return a formula, ready to be called on values.

    Parameters
    ----------
    text
        The formula, such as ``"R v ~R + (a∧b)·c"``, or an equation, ``"~R R = 1"``.
    algebra
        The algebra of the values; by default it is taken from the values of each call.
    define
        Values and functions defined by formulas, ``{"c": "0.1 e3", "V(x)": "½ x·x"}``; each may use those
        before it.
    arguments
        Names of values that a call takes by position, in this order: ``("R", "x", "Ω")`` or ``"R x Ω"``. Each
        value can also be given by name.

    Raises
    ------
    FormulaError
        If the text is not a formula.
    TypeError
        If a name in `arguments` is not one, or occurs twice.

    Examples
    --------
    >>> rotated = ph.formula("R x ~R", arguments="R x")
    >>> R = ph.Rotor.from_axis_angle(ph.e3, 60, degrees=True)
    >>> rotated(R, ph.e1)
    0.5 e1 + 0.8660254 e2

    Values that stay the same can be part of the formula:

    >>> energy = ph.formula("½ m v·v + V(x)", define={"V(x)": "9.81 x·e3"})
    >>> print(energy(m=2, v=ph.vector([3, 0, 4]), x=ph.e3))
    34.81
    """
    if not isinstance(text, str):
        raise TypeError(f"a formula must be a string, got {type(text).__name__}")
    check_encoding(text)
    if algebra is not None and not isinstance(algebra, Algebra):
        raise TypeError(f"algebra must be a ph.algebra(…), got {type(algebra).__name__}")
    if define is not None and not isinstance(define, Mapping):
        raise TypeError(f'define must be a mapping such as {{"V(x)": "½ x·x"}}, got {type(define).__name__}')
    definitions = list((define or {}).items())
    for definition in definitions:
        if not all(isinstance(part, str) for part in definition):
            raise TypeError(f"define must map strings to strings, got {definition[0]!r}: {definition[1]!r}")
    names = arguments.replace(",", " ").split() if isinstance(arguments, str) else list(arguments)
    if not all(isinstance(name, str) for name in names):
        raise TypeError(f'arguments must be names such as "R x Ω" or ("R", "x", "Ω"), got {arguments!r}')
    return Formula(_native.Formula(text, algebra, definitions, names))


def evaluate(
    text: str,
    values: Mapping[str, Any] | None = None,
    /,
    *,
    define: Mapping[str, str] | None = None,
    **named: Any,
) -> Any:
    """Return the value of a formula: ``ph.evaluate("-I a∧b", a=a, b=b)``. See `Formula`.

    `define` defines functions and names by formulas, as for `formula`.

    Examples
    --------
    >>> a, b = ph.vector([1, 0, 0]), ph.vector([1, 2, 0])
    >>> ph.evaluate("a∧b", a=a, b=b)
    2 e1∧e2
    >>> ph.evaluate("-I a∧b", a=a, b=b)
    2 e3
    >>> bool(ph.evaluate("a b = a·b + a∧b", a=a, b=b))
    True
    >>> ph.evaluate("V(a + b) - V(a)", a=a, b=b, define={"V(x)": "½ x·x"})
    3.5
    """
    found = _compiled(text) if isinstance(text, str) and define is None else formula(text, define=define)
    return found(*(() if values is None else (values,)), **named)


@functools.lru_cache(maxsize=256)
def _compiled(text: str) -> Formula:
    return formula(text)


_native.register("call_formula", called)


def _described(text: str, steps: list[Step], names: list[str]) -> list[str]:
    """Return the steps, one line each, with inputs and constants in place."""
    shown: list[str] = []
    lines: list[str] = []
    for step in steps:
        place = text[slice(*step.span)]
        if step.name in ("input", "constant", "pi"):
            shown.append(names[step.detail] if step.name == "input" else place)
            continue
        operands = [shown[i] for i in step.operands]
        if step.name == "power":
            operands.append(str(step.detail))
        name = step.detail if step.name == "product" else step.name
        if step.name == "map":
            name = names[step.detail]
        grades = ", ".join(str(k) for k in range(step.mask.bit_length()) if step.mask >> k & 1)
        shown.append(f"#{len(lines) + 1}")
        done = f"{name}({', '.join(operands)})"
        lines.append(f"{shown[-1]} = {done}: {'rotor' if step.unit else f'grade {grades}'}, for {place}")
    return lines
