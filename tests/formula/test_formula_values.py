"""Names and values given to formulas, and the errors in them."""

import pickle
from fractions import Fraction

import numpy as np
import pytest

import polhode as ph
from polhode import e1, e2, e3
from samples import random_rotors

RNG = np.random.default_rng(7)

# --- names


def test_accents_are_composed_or_combining():
    for text in ("ẋ", "x\u0307"):
        assert ph.evaluate(text, ẋ=2.0) == ph.evaluate(text, {"x\u0307": 2.0}) == 2
        assert ph.formula(text).latex == r"\dot{x}"


def test_names_that_are_not_identifiers():
    R, Ω = random_rotors(()), e1.wedge(e2)
    values = {"R'": Ω * R / 2, "a∥": e1, "a⊥": e3, "Ω_B": Ω}
    assert ph.evaluate("R' + a∥ + a⊥ Ω_B", values).is_close(Ω * R / 2 + e1 + e3 * Ω)
    assert ph.evaluate("R(0) e1", {"R(0)": R}) == R * e1


def test_unused_names_may_have_any_value():
    f = ph.formula("a b")
    other = ph.algebra(3, 0, 1).basis_vectors[0]
    environment = {"a": e1, "b": e2, "count": 3.0, "__name__": "x", "path": "here", "motor": other}
    assert f(environment) == f(**environment) == ph.evaluate("a b", **environment) == e1 * e2
    assert f(a=e1, b=e2, ab="text", m=None) == e1 * e2
    assert ph.evaluate("norm(a)", a=e1, m=other, n=len) == 1


def test_single_values_count_by_their_nonzero_grades():
    inertia = ph.Inertia.from_principal_moments(1, 2, 3)
    B = e1 * e2 + 2 * (e2 * e3)
    assert B.grades == (0, 2)
    assert ph.evaluate("inertia(B)", inertia=inertia, B=B) == inertia(B)
    assert ph.evaluate("sin(s)", s=e1 * (2 * e1)) == ph.evaluate("sin(2)")
    with pytest.raises(ph.FormulaError, match=r"needs a bivector \(grade 2\); this has grades 0, 2"):
        ph.evaluate("inertia(B)", inertia=inertia, B=B + 1)


def test_values_are_given_by_keyword_or_mapping():
    f = ph.formula("a b")
    assert f(a=e1, b=e2) == f({"a": e1}, b=e2) == f({"a": e1, "b": e2}) == f(b=e2, a=e1) == e1 * e2
    with pytest.raises(TypeError, match="c is a str"):
        ph.evaluate("a b c", a=e1, b=e2, c="3")
    with pytest.raises(TypeError, match=r"'a' is given both"):
        f({"a": e1, "b": e2}, a=e1)
    with pytest.raises(TypeError, match=r'"a_1" and "a1" are the same name'):
        ph.evaluate("a1", a_1=e1, a1=e1)
    with pytest.raises(TypeError, match=r'"a b" is not a name'):
        f({"a": e1, "b": e2, "a b": e3})
    with pytest.raises(TypeError, match=r"at most one mapping .* arguments="):
        f(e1, e2)
    with pytest.raises(TypeError, match="as a mapping by name, got Multivector"):
        f(e1)


@pytest.mark.parametrize("arguments", ["R a b", "R, a, b", ("R", "a", "b"), iter(["R", "a", "b"])])
def test_values_are_given_by_position(arguments):
    R, batch = ph.Rotor.from_plane_angle(e1 ^ e2, 1.0), ph.vector([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
    f = ph.formula("R a ~R + b", arguments=arguments)
    assert f.arguments == ("R", "a", "b")
    for a, b in ((e1, e2), (batch, e2), (e1, 2.5), (sympy_vector(), e2)):
        expected = ph.evaluate("R a ~R + b", R=R, a=a, b=b)
        for _ in range(2):  # the second call is cached
            for value in (f(R, a, b), f(R, a, b=b), f(R, b=b, a=a), f({"R": R, "a": a, "b": b})):
                assert np.all(value == expected)
            for value in (f.__call__(R, a, b), *map(f, [R], [a], [b]), f(R=R, a=a, b=b)):
                assert np.all(value == expected)


def test_calls_alternate_between_single_values_and_batches():
    """A call is recognized by names and kinds, whether values are single, batches or arrays of numbers."""
    f = ph.formula("s a∧b")
    a, b, many = ph.vector([1.0, 2.0, 3.0]), ph.vector([0.5, 0.0, 2.0]), ph.vector(RNG.normal(size=(4, 1, 3)))
    others = [ph.vector(RNG.normal(size=shape)) for shape in ((4, 1, 3), (5, 3), (0, 3), (4, 5, 3))]
    for _ in range(3):
        for x in (a, many):
            for y in (b, *others):
                for s in (2.0, 3, RNG.normal(size=(4, 1)), ph.scalar(0.5)):
                    found, expected = f(s=s, a=x, b=y).components, (s * x.wedge(y)).components
                    assert found.shape == expected.shape
                    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-14)


def sympy_vector():
    x = pytest.importorskip("sympy").Symbol("x")
    return x * ph.multivector([0, 1, 0, 0, 0, 0, 0, 0])


def test_wrong_positions_are_errors():
    f = ph.formula("a b", arguments="a b")
    with pytest.raises(TypeError, match=r"takes 2 values by position \(a, b\), got 3"):
        f(e1, e2, e3)
    with pytest.raises(TypeError, match=r'"a" is given both by position and by name'):
        f(e1, a=e2)
    with pytest.raises(ph.FormulaError, match="`b` has no value"):
        f(e1)
    with pytest.raises(TypeError, match="a is a str"):
        f("3", e2)
    with pytest.raises(TypeError, match=r'"a1" and "a_1" are the same name'):
        ph.formula("a1", arguments="a1 a_1")
    for name in ("2", "__name__", "a-b"):
        with pytest.raises(TypeError, match="is not a name in formulas"):
            ph.formula("a", arguments=[name])
    with pytest.raises(TypeError, match=r"arguments must be names"):
        ph.formula("a", arguments=[1])


def test_an_x_between_factors_is_probably_a_cross_product():
    with pytest.raises(ph.FormulaError, match="Write the cross product as `a ⨯ b`"):
        ph.evaluate("a x b", a=e1, b=e2)
    with pytest.raises(ph.FormulaError) as caught:
        ph.evaluate("x + a", a=e1)
    assert "cross" not in str(caught.value)


def test_arguments_are_part_of_a_formula():
    f = ph.formula("a b", arguments="b a")
    assert f(e1, e2) == e2 * e1
    assert f != ph.formula("a b")
    assert f == pickle.loads(pickle.dumps(f)) == ph.formula("a b", arguments=("b", "a"))
    assert hash(f) == hash(ph.formula("a b", arguments=("b", "a")))
    assert repr(f) == "ph.formula('a b', arguments=('b', 'a'))"


def test_invalid_values_are_named():
    f = ph.formula("a")
    with pytest.raises(TypeError, match="a is an array of bool"):
        f(a=np.array([True]))
    with pytest.raises(TypeError, match="must be strings, got 1"):
        f({1: e1})
    for value, remedy in [
        ([1.0, 2.0, 3.0], "ph.vector"),
        (lambda x: x, "linear maps"),
        ("e1", "a multivector, a linear map"),
        (True, "a multivector"),
        (None, "a multivector"),
    ]:
        with pytest.raises(TypeError, match=rf"a is a \w+; .*{remedy}"):
            f(a=value)


# --- errors in values


def test_errors_name_the_row_and_the_place():
    with pytest.raises(ph.FormulaError) as caught:
        ph.evaluate("2 + 1/s", s=np.array([[1.0, 2.0], [0.0, 1.0]]))
    assert caught.value.message.startswith("at index (1, 0): division by zero")
    assert (caught.value.text, caught.value.span) == ("2 + 1/s", (4, 7))
    assert str(caught.value).endswith("1 | 2 + 1/s\n  |     ^^^")
    assert isinstance(caught.value, ValueError)
    again = pickle.loads(pickle.dumps(caught.value))
    assert (str(again), again.span) == (str(caught.value), (4, 7))


@pytest.mark.parametrize("zero", [0.0, np.zeros(3), Fraction(0)])
def test_division_by_zero(zero):
    with pytest.raises(ph.FormulaError, match="division"):
        ph.evaluate("e1/s", s=zero)


def test_values_that_are_not_finite():
    for algebra in (ph.algebra(3), ph.algebra(4, 1)):
        for bad in (np.nan, np.inf):
            s = algebra.scalar(np.array([1.0, bad]))
            with pytest.raises(ph.FormulaError, match=r"at index \(1,\): .*NaN or infinite"):
                ph.evaluate("1 + sin(s)", s=s)
            assert ph.evaluate("1 + s", s=s).components[0] == 2


def test_singular_values():
    for text in ("A⁻¹", "log(A)"):
        with pytest.raises(ph.FormulaError, match=r"singular[^$]*\^"):
            ph.evaluate(text, A=1 + e1)
        rows = ph.multivector(np.tile((2 + e1)._with_grades(15), (20_000, 1)))
        rows = ph.concatenate([rows, ph.stack([1 + e1])])
        with pytest.raises(ph.FormulaError, match=r"at index \(20000,\): "):
            ph.evaluate(text, A=rows)


def test_wrong_grades_are_found_before_values():
    with pytest.raises(ph.FormulaError, match="number"):
        ph.formula("sin(a)")(a=e1)
    with pytest.raises(ph.FormulaError, match="number"):
        ph.formula("sin(a)").grades(a=1)
    with pytest.raises(ph.FormulaError):
        ph.formula("inertia(a)").grades(a=1, inertia="map of bivectors")


def test_wrong_texts_are_found_at_once():
    for text in ("a +", "(a", "a·b∧c", "", "a $ b"):
        with pytest.raises(ph.FormulaError):
            ph.formula(text)
    with pytest.raises(ph.FormulaError):
        ph.formula("V(x)", define={"V(x)": "x +"})
    with pytest.raises(TypeError, match="must be a string"):
        ph.formula(3)
    with pytest.raises(TypeError, match="algebra"):
        ph.formula("a", algebra="G3")
    with pytest.raises(TypeError, match="string, got list"):
        ph.evaluate(["a"])
    with pytest.raises(TypeError, match="define must be a mapping"):
        ph.formula("V(a)", define="V(x) = x")
    with pytest.raises(TypeError, match="'c': 2"):
        ph.formula("c", define={"c": 2})


def test_batches_that_do_not_broadcast_are_named():
    u, v = ph.vector(np.ones((3, 3))), ph.vector(np.ones((4, 3)))
    for text in ("u v", "u v = 1", "u + v = v"):
        with pytest.raises(ValueError, match=r"do not broadcast: u \(3,\), v \(4,\)"):
            ph.evaluate(text, u=u, v=v)


# --- arrays for the value


def test_values_are_written_to_out():
    f = ph.formula("R v ~R + (a∧b)·c", arguments="R v")
    values = {"R": random_rotors((70,)), **{name: ph.vector(RNG.normal(size=(70, 3))) for name in "vabc"}}
    out = np.zeros((70, 3))
    result = f(**values, out=out)
    assert np.shares_memory(result._data, out)
    assert result.grades == (1,)
    np.testing.assert_array_equal(out, f(**values).components)
    out[:] = 0
    R, v = values.pop("R"), values.pop("v")
    f(R, v, **values, out=out)
    np.testing.assert_array_equal(out, f(R, v, **values).components)


@pytest.mark.parametrize(
    ("text", "values", "shape"),
    [
        ("a·b", {"a": ph.vector(RNG.normal(size=(5, 3))), "b": e1}, (5, 1)),  # also a batch of scalars
        ("a b", {"a": e1, "b": e2}, (4,)),
        ("exp(a)", {"a": ph.pga(3).bivector(RNG.normal(size=(5, 6)))}, (5, 8)),
        ("exp(B)", {"B": ph.bivector(RNG.normal(size=(2, 3, 3)))}, (2, 3, 4)),
    ],
)
def test_out_holds_values_of_all_kinds(text, values, shape):
    out = np.full(shape, 7.0)
    result = ph.formula(text)(**values, out=out)
    expected = ph.formula(text)(**values)
    assert type(result) is type(expected)
    assert result.grades == expected.grades
    np.testing.assert_array_equal(out, expected.components)


def test_a_value_may_be_named_out():
    assert ph.formula("2 out")(out=e1) == 2 * e1
    np.testing.assert_array_equal(ph.formula("2 out")(out=np.array([1.0, 2.0])).components, [[2], [4]])
    unused = np.zeros(3)
    assert ph.formula("2 a", arguments="a out")(e1, unused) == 2 * e1
    assert not unused.any()


def test_wrong_out_is_refused():
    f, a = ph.formula("2 a"), ph.vector(np.ones((4, 3)))
    with pytest.raises(
        ValueError, match=r"out must be float64 of shape \(4, 3\), got float64 of shape \(3, 3\)"
    ):
        f(a=a, out=np.empty((3, 3)))
    with pytest.raises(TypeError, match="out must be a NumPy array, got list"):
        f(a=a, out=[])
    with pytest.raises(TypeError, match="an Agreement, not an array; omit out"):
        ph.formula("a = a")(a=a, out=np.empty((4, 3)))
    with pytest.raises(TypeError, match="out needs values of NumPy floats, got object"):
        f(a=ph.vector([Fraction(1), 0, 0]), out=np.empty(3))
    memory = np.ones((4, 3))
    with pytest.raises(ValueError, match="out overlaps an operand"):
        f(a=ph.vector(memory, copy=False), out=memory)
