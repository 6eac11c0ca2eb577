"""Every equation of the handout holds as written there, and fails with a sign or a factor changed.

Sides over floats agree within the equation's tolerance in each of 10,000 rows, fractions are equal, and the
difference of symbolic sides vanishes identically.
"""

from functools import cache

import numpy as np
import pytest

import polhode as ph
from handout_equations import EQUATIONS, KINDS
from handout_values import ROWS, Numbers

CASES = [
    pytest.param(equation, kind, id=f"{equation.number}: {equation.text}, {kind}")
    for equation in EQUATIONS
    for kind in KINDS
]


@cache
def names_of(make, kind):
    return make(Numbers(kind))


@pytest.mark.parametrize(("equation", "kind"), CASES)
def test_the_equation_holds(equation, kind):
    agreement = ph.evaluate(equation.text, names_of(equation.names, kind))
    assert agreement
    if kind == "Fraction" and equation.exact:
        assert agreement.residual == 0


@pytest.mark.parametrize(("equation", "kind"), CASES)
def test_a_wrong_version_does_not(equation, kind):
    assert not np.any(ph.evaluate(equation.wrong, names_of(equation.names, kind)).holds)


def test_a_batch_is_compared_row_by_row():
    a, b = ph.vector(np.ones((ROWS, 3))), ph.vector(np.arange(3.0 * ROWS).reshape(ROWS, 3))
    agreement = ph.evaluate("a∧b = 0", a=a, b=a + b * (np.arange(ROWS) == 7.0).astype(float))
    assert not agreement
    assert list(np.flatnonzero(~agreement.holds)) == [7]
