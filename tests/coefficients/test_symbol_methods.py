"""Methods of SymPy on values: derivatives, substitution, simplification, LaTeX."""

from fractions import Fraction

import jax.numpy as jnp
import numpy as np
import pytest
import sympy

import polhode as ph
from polhode import I, e1, e2, e3

x, y, t = sympy.symbols("x y t", real=True)


def test_derivatives():
    A = x**2 * e1 + x * y * (e1 ^ e2) + 3 * I
    assert A.diff(x) == 2 * x * e1 + y * (e1 ^ e2)
    assert A.diff(x, 2) == 2 * e1
    assert A.diff(x, y) == e1 ^ e2
    assert A.diff(t) == 0
    assert A.diff(x).grades == A.grades
    many = ph.stack([x * e1, x**3 * e2])
    assert np.all(many.diff(x) == ph.stack([e1, 3 * x**2 * e2]))


def test_the_derivative_of_a_rotor_is_the_angular_velocity():
    R = ph.Rotor.from_plane_angle(e1 ^ e2, t**2)
    rate = R.diff(t)
    assert not isinstance(rate, ph.Rotor)
    # R' = −½ Ω R with Ω = 2t e1∧e2.
    assert rate.simplify() == (-t * (e1 ^ e2) * R).simplify()


def test_substitution():
    A = x * e1 + y * e2 + 2 * e3
    assert A.subs(x, 3) == 3 * e1 + y * e2 + 2 * e3
    assert A.subs([(x, 1), (y, sympy.Rational(1, 2))]).astype(float).components.tolist() == [1.0, 0.5, 2.0]
    assert A.subs(x, 1).subs(y, 2).subs(t, 5) == e1 + 2 * e2 + 2 * e3
    R = ph.Rotor.from_plane_angle(e1 ^ e2, t).subs(t, sympy.pi / 2)
    assert isinstance(R, ph.Rotor)
    assert R(e1) == e2


def test_simplification():
    A = (sympy.sin(x) ** 2 + sympy.cos(x) ** 2) * e1 + (x - x) * e2
    assert A.simplify()["e1"] == 1
    R = ph.Rotor.from_plane_angle(e1 ^ e2, t)
    assert isinstance(R.simplify(), ph.Rotor)
    assert R(e1).simplify() == sympy.cos(t) * e1 + sympy.sin(t) * e2
    assert (x**2 * e1 / x).simplify(ratio=1) == x * e1


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        (e1, "float64"),
        (ph.vector(np.ones(3, np.float32)), "float32"),
        (Fraction(1, 3) * e1 + Fraction(1, 2) * (e2 + e3), "Fraction"),
        (ph.vector(jnp.ones(3)), "float32|float64"),
    ],
)
@pytest.mark.parametrize("call", ["diff", "subs", "simplify"])
def test_other_coefficients_are_errors(call, value, kind):
    arguments = {"diff": (x,), "subs": (x, 1), "simplify": ()}[call]
    with pytest.raises(
        TypeError, match=rf"{call} needs coefficients that are SymPy expressions, got ({kind})"
    ):
        getattr(value, call)(*arguments)


def test_latex_of_sympy():
    A = x**2 * e1 + e2 / 2
    assert f"${sympy.latex(A)}$" == A._repr_latex_()
    assert sympy.latex(2 * e1 - 0.5 * (e1 ^ e2)) == r"2 e_{1} - 0.5\,e_{1}{\wedge}e_{2}"
    assert sympy.latex([x, e1]) == r"\left[ x, \  e_{1}\right]"
    assert r"\begin{array}" in sympy.latex(ph.stack([e1, e2]))


def test_latex_in_containers_of_sympy():
    A = x**2 * e1 + y / 2 * (e1 ^ e2)
    alone = sympy.latex(A)
    assert alone == r"x^{2} e_{1} + \frac{y}{2}\,e_{1}{\wedge}e_{2}"
    for container in ([x, A], (A, [A, x]), {x: A}, sympy.Tuple(x, A)):
        text = sympy.latex(container)
        assert alone in text
        assert "$" not in text
    # The settings of the printer hold for the coefficients.
    assert sympy.latex([A], symbol_names={x: "x_0"}, fold_short_frac=True) == (
        r"\left[ x_0^{2} e_{1} + y / 2\,e_{1}{\wedge}e_{2}\right]"
    )
    assert sympy.latex(A, mode="equation") == rf"\begin{{equation}}{alone}\end{{equation}}"
    motor = x * ph.algebra(3, 0, 1).basis_vectors[3]
    assert sympy.latex([motor]) == r"\left[ x e_{4}\right]"


def test_rotors_and_batches_of_symbols():
    R = ph.Rotor.from_plane_angle(e1 ^ e2, t)
    many = ph.stack([R, R * R])
    turned = many.subs(t, sympy.pi).simplify()
    assert isinstance(turned, ph.Rotor)
    assert np.all(turned == ph.stack([-(e1 ^ e2), ph.scalar(-1)]))
    rates = many.diff(t)
    assert type(rates) is ph.Multivector
    assert rates.shape == (2,)
    # R' = −½ Ω R with Ω = e1∧e2 for the first, 2 e1∧e2 for the second.
    expected = ph.stack([-(e1 ^ e2) * R / 2, -(e1 ^ e2) * (R * R)])
    assert np.all((rates - expected).simplify() == 0)
    assert (R.diff(t, 2) + R / 4).simplify() == 0
    assert (many.simplify() * many.reshape(2, 1)).shape == (2, 2)
    assert r"\cos{\left(t \right)}" in sympy.latex([many.simplify()])
    assert sympy.latex({x: R}).startswith(r"\left\{ x : \cos")
