"""Formulas over rows in other algebras than 3-d space have the bits of the operators, in one pass."""

import numpy as np
import pytest

import polhode as ph

RNG = np.random.default_rng(5)
ALGEBRAS = [(2,), (3, 0, 1), (4, 1), (1, 3), (6,)]

# The formula, and the same by operators of even A, vectors a and b, full M and N, and scalars s.
FORMULAS = {
    "A a ~A": lambda A, a, b, M, N, s: A * a * ~A,
    "~A b a A": lambda A, a, b, M, N, s: ~A * (b * a) * A,
    "M N - N M": lambda A, a, b, M, N, s: M * N - N * M,
    "⟨M N⟩_{0,2}": lambda A, a, b, M, N, s: (M * N).grade(0, 2),
    "~M a + ~M ~N": lambda A, a, b, M, N, s: ~M * a + ~M * ~N,
    "a∧b + a·b - ½ s A": lambda A, a, b, M, N, s: a.wedge(b) + a.dot(b) - 0.5 * s * A,
    "(A×M - A⌋M)/s + π e12": lambda A, a, b, M, N, s: (
        (A.commutator(M) - A.left_contraction(M)) / s + np.pi * A.algebra.blades["e12"]
    ),
    "-a² + ⟨M⟩_1 b": lambda A, a, b, M, N, s: -(a * a) + M.grade(1) * b,
}


def random(space, grades, shape):
    size = int(np.isin(space._grade_of, grades).sum())
    mask = sum(1 << k for k in grades)
    return ph.Multivector._of(RNG.normal(size=(*shape, size)), mask, space)


def values(space, shapes):
    n = space.dimension
    every, even = range(n + 1), range(0, n + 1, 2)
    grades = {"A": even, "a": [1], "b": [1], "M": every, "N": every, "s": [0]}
    shapes = [shapes[i % len(shapes)] for i in range(len(grades))]
    return {
        name: random(space, list(k), shape) for (name, k), shape in zip(grades.items(), shapes, strict=True)
    }


def require_equal(got, expected):
    """Equal bits; grades that the formula knows to vanish are rounding in the operators."""
    assert got.shape == expected.shape
    assert np.array_equal(got.components, expected._with_grades(got._mask))
    rest = expected - expected.grade(*got.grades)
    assert np.all(np.abs(rest.dense()) <= 1e-12 * (1 + np.abs(expected.dense()).max()))


@pytest.mark.parametrize("shapes", [[()], [(3,)], [(40,)], [(211,), ()], [(3, 1), (4,)], [(0,)]], ids=str)
@pytest.mark.parametrize("text", FORMULAS)
@pytest.mark.parametrize("algebra", ALGEBRAS, ids=str)
def test_bits_of_the_operators(algebra, text, shapes):
    given = values(ph.algebra(*algebra), shapes)
    shape = np.broadcast_shapes(*(x.shape for name, x in given.items() if name in text))
    expected = FORMULAS[text](**given)
    if 0 in shape:
        assert ph.evaluate(text, given).shape == ph.evaluate(text, **given).shape == shape
        return
    # Keywords alone are read by the core.
    for got in (ph.evaluate(text, given), ph.evaluate(text, **given)):
        require_equal(got, expected)
        assert got.algebra is given["A"].algebra


@pytest.mark.parametrize("threads", ["1", "3"])
def test_bits_do_not_depend_on_threads(threads, monkeypatch):
    """Nor on pieces between signals, and results beyond the caches."""
    space = ph.algebra(3, 0, 1)
    A, a = random(space, [0, 2, 4], (200_000,)), random(space, [1], (200_000,))
    monkeypatch.setenv("POLHODE_NUM_THREADS", threads)
    turned = ph.evaluate("A a ~A", A=A, a=a)
    for rows in (slice(None, None, 977), slice(131_000, 131_200)):
        require_equal(turned[rows], A[rows] * a[rows] * ~A[rows])


def test_single_precision_is_rounded_as_by_operators():
    space = ph.algebra(4, 1)
    A, a = (random(space, grades, (50,)).astype(np.float32) for grades in ([0, 2, 4], [1]))
    turned = ph.evaluate("A a ~A", A=A, a=a)
    assert turned.dtype == np.float32
    assert np.array_equal(turned.components, (A * a * ~A)._with_grades(turned._mask))


def test_rows_without_a_value_are_named():
    space = ph.algebra(3, 0, 1)
    a = random(space, [1], (2, 60))
    s = np.ones((2, 60))
    s[1, 33] = 0
    with pytest.raises(ph.FormulaError, match=r"division of a multivector by zero.*1, 33"):
        ph.evaluate("a/s + a", a=a, s=ph.Multivector._of(s[..., None], 1, space))
    ph.evaluate("a/s + a", a=a[0], s=s[0])


def test_values_of_other_algebras_are_refused_or_ignored():
    a, b = (random(ph.algebra(*signature), [1], (9,)) for signature in [(3, 0, 1), (4, 1)])
    with pytest.raises(TypeError, match="values must be of one algebra"):
        ph.evaluate("a b", a=a, b=b)
    assert np.all(ph.evaluate("2 a", a=a, b=b) == 2 * a)
    assert ph.evaluate("2 s", s=1.5, a=a).algebra is ph.algebra(3)
    with pytest.raises(TypeError, match="values must be of one algebra"):
        ph.formula("2 a", algebra=ph.algebra(4, 1))(a=a)


def test_functions_work_as_before():
    space = ph.algebra(3, 0, 1)
    B, a = random(space, [2], (5,)), random(space, [1], (5,))
    expected = B.exp() * a * ~B.exp()
    turned = ph.evaluate("exp(B) a ~exp(B)", B=B, a=a)
    assert np.array_equal(turned.components, expected._with_grades(turned._mask))
