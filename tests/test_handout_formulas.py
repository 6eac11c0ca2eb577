"""Every equation of the handout, typed as it stands there, is true; and a sign or a factor away it is not.

Of floats the sides agree to the equation's own tolerance, in every one of 10,000 rows; fractions are equal
and symbols vanish identically.
"""

from functools import cache

import pytest

import polhode as ph
from handout_equations import EQUATIONS, KINDS
from handout_values import ROWS, Numbers

CASES = [
    pytest.param(equation, kind, id=f"{equation.number}: {equation.text}, {kind}")
    for equation in EQUATIONS
    for kind in equation.kinds
]


@cache
def names_of(make, kind):
    return make(Numbers(kind))


@pytest.mark.parametrize(("equation", "kind"), CASES)
def test_the_equation_holds(equation, kind):
    agreement = ph.evaluate(equation.text, names_of(equation.names, kind))
    assert agreement
    if kind == "Fraction":
        assert agreement.rtol == 0


@pytest.mark.parametrize(("equation", "kind"), CASES)
def test_a_wrong_version_does_not(equation, kind):
    assert not ph.evaluate(equation.wrong, names_of(equation.names, kind))


def test_a_batch_is_told_row_by_row():
    names = names_of(EQUATIONS[1].names, "batch")
    assert ph.evaluate("(a∧b)∧c = a∧(b∧c)", names).holds.shape == (ROWS,)
    assert not ph.evaluate("(a∧b)∧c = a∧(c∧b)", names).holds.any()


def test_the_four_kinds_are_evaluated():
    for number in {equation.number for equation in EQUATIONS} - {"2.2", "2.3", "4.14", "4.35"}:
        kinds = {kind for equation in EQUATIONS if equation.number == number for kind in equation.kinds}
        assert kinds == set(KINDS), number
