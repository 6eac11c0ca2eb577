"""Text of values, which formulas parse, and LaTeX for notebooks."""

import pydoc
import sys
from fractions import Fraction

import mpmath
import numpy as np
import pytest
import sympy

import polhode as ph
import processes
from polhode import I, e1, e2, e3

x, y = sympy.symbols("x y", positive=True)
PGA = ph.algebra(3, 0, 1)
n1, n2, n3, n0 = PGA.basis_vectors

SINGLE = [
    (2 * e1 + 3 * e2 * e3, "2 e1 + 3 e2∧e3", r"2 e_{1} + 3\,e_{2}{\wedge}e_{3}"),
    (-e1 - I, "-e1 - I", r"-e_{1} - I"),
    (0 * e1, "0", "0"),
    (ph.scalar(-1.0), "-1", "-1"),
    (ph.Rotor.identity(), "1", "1"),
    (1 / 3 + e1, "0.33333333 + e1", r"0.33333333 + e_{1}"),
    (1e-5 * e1 - 1e20 * e2, "1e-05 e1 - 1e+20 e2", r"10^{-5} e_{1} - 10^{20} e_{2}"),
    (-6.02214076e23 * I, "-6.0221408e+23 I", r"-6.0221408 {\times} 10^{23} I"),
    (
        ph.vector([np.nan, np.inf, -np.inf]),
        "nan e1 + inf e2 - inf e3",
        r"\mathrm{NaN} e_{1} + \infty e_{2} - \infty e_{3}",
    ),
    (ph.vector(np.float32([0.1, 0, 0])), "0.1 e1", r"0.1 e_{1}"),
    (
        ph.vector([Fraction(1, 3), Fraction(-2, 7), 0]),
        "1/3 e1 - 2/7 e2",
        r"\frac{1}{3} e_{1} - \frac{2}{7} e_{2}",
    ),
    (ph.scalar(10**20) + Fraction(4, 2) * e1, f"1{'0' * 20} + 2 e1", rf"1{'0' * 20} + 2 e_{{1}}"),
    (ph.vector([x, -y, x - y]), "x e1 - y e2 + (x - y) e3", r"x e_{1} - y e_{2} + \left(x - y\right) e_{3}"),
    (ph.scalar(x + y), "(x + y)", r"\left(x + y\right)"),
    (
        ph.bivector([x**2, -(x**-2), sympy.Rational(1, 2)]),
        "x^2 e2∧e3 - 1/x^2 e3∧e1 + 1/2 e1∧e2",
        r"x^{2}\,e_{2}{\wedge}e_{3} - \frac{1}{x^{2}}\,e_{3}{\wedge}e_{1} + \frac{1}{2}\,e_{1}{\wedge}e_{2}",
    ),
    (ph.vector([x**-2, sympy.sqrt(x), 0]), "x^-2 e1 + sqrt(x) e2", r"\frac{1}{x^{2}} e_{1} + \sqrt{x} e_{2}"),
    (ph.scalar(sympy.cos(x / 2)), "cos(x/2)", r"\cos{\left(\frac{x}{2} \right)}"),
    (
        ph.vector([mpmath.mpf(10) ** -30, mpmath.inf, mpmath.mpf("0.5")]),
        "1.0e-30 e1 + inf e2 + 0.5 e3",
        r"1.0 {\times} 10^{-30} e_{1} + \infty e_{2} + 0.5 e_{3}",
    ),
    (2 * n1 * n0 - n2 * n3, "2 e1∧e4 - e2∧e3", r"2\,e_{1}{\wedge}e_{4} - e_{2}{\wedge}e_{3}"),
    (n1 * n2 * n3, "e1∧e2∧e3", r"e_{1}{\wedge}e_{2}{\wedge}e_{3}"),
]


@pytest.mark.parametrize(("value", "text", "latex"), SINGLE, ids=[text for _, text, _ in SINGLE])
def test_single_values_as_text_and_in_latex(value, text, latex):
    assert repr(value) == text
    assert value._repr_latex_() == f"${latex}$"


@pytest.mark.parametrize("value", [value for value, _, _ in SINGLE], ids=[text for _, text, _ in SINGLE])
def test_matplotlib_reads_the_latex(value):
    mathtext = pytest.importorskip("matplotlib.mathtext")
    assert mathtext.MathTextParser("path").parse(value._repr_latex_()).width > 0


READABLE = [(value, text) for value, text, _ in SINGLE if not {"nan", "inf"} & set(text.split())]


@pytest.mark.parametrize(("value", "text"), READABLE, ids=[text for _, text in READABLE])
def test_formulas_read_the_text_back(value, text):
    read = ph.formula(text, algebra=value.algebra)({"x": x, "y": y})
    if {"x", "y"} & set(text):
        assert (read - value).map(sympy.simplify) == 0
    else:  # eight digits
        assert read.is_close(value.astype(float), rtol=1e-7)


@pytest.mark.parametrize(
    "value", [2 * e1 + 3 * e2 * e3, -e1 - I, 0.3 - 1.5e-7 * e3 * e1, 1e20 * I, 0 * e1, 3 - e1], ids=repr
)
def test_latex_of_a_value_is_that_of_its_formula(value):
    assert value._repr_latex_() == f"${ph.formula(repr(value)).latex}$"


def test_batches_in_latex_are_the_first_and_last_values_in_lines():
    few = ph.vector([[[1, 0, 0]], [[0, -2, 0]]])
    assert few._repr_latex_() == (
        r"$$\begin{array}{l} \text{Multivector of shape } (2, 1) \\ e_{1} \\ -2 e_{2} \end{array}$$"
    )
    many = ph.scalar(np.arange(10_000.0))
    assert many._repr_latex_() == (
        r"$$\begin{array}{l} \text{Multivector of shape } (10000,) "
        r"\\ 0 \\ 1 \\ 2 \\ 3 \\ 4 \\ \vdots \\ 9999 \end{array}$$"
    )
    none = ph.Rotor.identity((0,))
    assert none._repr_latex_() == r"$$\begin{array}{l} \text{Rotor of shape } (0,) \end{array}$$"


def test_linear_maps_in_latex_are_their_matrices():
    rows = [[1, 0, -2.5], [0, 1e-7, 0], [0, 0, 3]]
    matrix = r"\begin{pmatrix} 1 & 0 & -2.5 \\ 0 & 10^{-7} & 0 \\ 0 & 0 & 3 \end{pmatrix}"
    assert ph.LinearMap.from_matrix(rows)._repr_latex_() == f"${matrix}$"
    two = ph.LinearMap.from_matrix([rows, rows], grade=2)._repr_latex_()
    assert two == (
        rf"$$\begin{{array}}{{l}} \text{{LinearMap of bivectors of shape }} (2,) \\ {matrix} \\ {matrix} "
        r"\end{array}$$"
    )


def test_values_without_known_numbers_have_no_latex():
    jax = pytest.importorskip("jax")
    seen = []

    def f(components):
        seen.append(ph.vector(components)._repr_latex_())
        return components

    jax.jit(f)(jax.numpy.ones(3))
    assert seen == [None]
    assert ph.vector(jax.numpy.asarray([1, 0, 2]))._repr_latex_() == r"$e_{1} + 2 e_{3}$"


def test_printing_does_not_import_libraries():
    program = (
        "import sys, polhode as ph; (2 * ph.e1)._repr_latex_(), repr(ph.e1); "
        "assert not {'sympy', 'IPython', 'matplotlib'} & set(sys.modules)"
    )
    processes.run([sys.executable, "-c", program], check=True)


@pytest.mark.parametrize("kind", [ph.Multivector, ph.Rotor])
@pytest.mark.parametrize(
    ("name", "tight", "method"), [("__xor__", "(a + b) ^ c", "wedge"), ("__or__", "(a + b) | c", "dot")]
)
def test_help_warns_of_operator_precedence(kind, name, tight, method):
    shown = pydoc.plain(pydoc.render_doc(getattr(kind, name)))
    assert "Python binds" in shown
    assert "looser" in shown
    assert tight in shown
    assert f"A.{method}(B)" in shown


def test_operator_precedence_is_as_documented():
    """The examples in the docstrings of ``^`` and ``|``."""
    a, b, c, B = e1 + 2 * e2, e2 - e3, 3 * e1 + e3, 2 * e2 * e3
    assert (a + b ^ c) == (a + b) ^ c != a + (b ^ c)
    assert (I * a ^ b) == (I * a) ^ b != I * (a ^ b)
    assert (a + b | c) == (a + b) | c != a + (b | c)
    assert (a | B * c) == a | (B * c) != (a | B) * c


def test_operators_defer_to_other_types():
    class Other:
        def __rxor__(self, left):
            return "mine"

        __ror__ = __rxor__

    for value in (e1, ph.vector(np.ones((2, 3))), ph.Rotor.identity()):
        assert value ^ Other() == "mine"
        assert value | Other() == "mine"
        with pytest.raises(TypeError, match="unsupported operand"):
            value ^ "text"
    assert 2 ^ e1 == 2 * e1 == e1 | 2
