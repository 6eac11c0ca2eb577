"""Arithmetic of numbers, arrays and values of different kinds, on either side."""

import copy
import operator
from decimal import Decimal
from fractions import Fraction

import mpmath
import numpy as np
import pytest
import sympy

import polhode as ph
from polhode import I, e1, e2, e3

F = Fraction
x = sympy.Symbol("x", real=True)
OPERATORS = [operator.mul, operator.xor, operator.or_, operator.add, operator.sub]
both_ways = pytest.mark.parametrize("operate", [*OPERATORS, operator.truediv])


def types(M):
    return {type(c) for c in M.components.flat}


# --- numbers of Python and NumPy


@pytest.mark.parametrize(
    "number",
    [2, 2.5, np.float64(2.5), np.int64(2), np.uint8(2), np.int8(-2), np.array(2.5), np.array(2)],
    ids=repr,
)
@both_ways
def test_numbers_on_either_side(number, operate):
    for A in (e1 + 2 * I, ph.vector(np.ones((2, 3))), ph.Rotor.identity()):
        expected = operate(A, ph.scalar(float(number)))
        assert np.all(operate(A, number) == expected)
        assert operate(A, number).dtype == np.float64
        if operate is operator.truediv and 0 not in A.inverse().grades:
            continue
        assert np.all(operate(number, A) == operate(ph.scalar(float(number)), A))


@pytest.mark.parametrize(
    "array",
    [np.array([1.0, 2.0]), np.array([1, 2]), np.array([1, 2], np.int8), np.arange(6.0).reshape(2, 1, 3)],
)
@pytest.mark.parametrize("operate", OPERATORS)
def test_arrays_are_batches_of_scalars_on_either_side(array, operate):
    s = ph.scalar(array.astype(float))
    for A in (e1 + I, 2 * e1 * e2):
        assert np.all(operate(array, A) == operate(s, A))
        assert np.all(operate(A, array) == operate(A, s))
        assert operate(array, A).shape == array.shape
        assert np.array_equal(array == A, s == A)


def test_small_integers_do_not_overflow():
    a = ph.vector(np.array([100, 100, 100], np.int8))
    assert a * a == 30_000
    assert np.array([100], np.int8) * (100 * e1) == ph.vector([[10_000, 0, 0]])
    assert ph.scalar(np.uint8(255)) + np.uint8(255) == 510
    assert -ph.scalar(np.uint8(1)) == -1


def test_integers_beside_floats_become_floats():
    big = 2**53 + 1
    for number in (big, np.int64(big), np.array(big), np.array([big])):
        for result in (number * e1, e1 * number, e1 + number, number - e1):
            assert result.dtype == np.float64
    assert np.all(np.array([big]) * e1 == float(big) * e1)
    # Without floats they are exact.
    assert ph.scalar(big).dtype == object
    assert ph.vector(np.array([2**64 - 1, 0, 0], np.uint64)) == (2**64 - 1) * ph.vector(
        [1, 0, 0], dtype=object
    )
    with pytest.raises(ValueError, match="integer beyond the range of float64"):
        e1 * 10**400
    with pytest.raises(ValueError, match="integer beyond the range of float64"):
        10**400 * e1


def test_single_precision_is_promoted_as_in_numpy():
    a = ph.vector(np.array([1, 2, 3], np.float32))
    for number in (2, 2.5, np.float32(2)):
        for result in (number * a, a * number, a / number, a + number, number - a, a ^ number, number / a):
            assert result.dtype == np.float32
    for number in (np.float64(2), np.array([2.0]), e1, ph.scalar(2.0)):
        assert (a * number).dtype == np.float64
        assert (number * a).dtype == np.float64
    assert ph.scalar(np.float32(0.1)).dtype == np.float32
    assert (np.float32(0.5) * e1).dtype == np.float64
    for same in (
        a.dual(),
        a.undual(),
        ph.cross(a, a),
        a.normalized(),
        a.inverse(),
        a.exp(),
        a.project(a),
        a.vee(a),
    ):
        assert same.dtype == np.float32
    for size in (a.norm(), a.norm_squared(), ph.stack([a, a]).norm()):
        assert size.dtype == np.float32


def test_functions_beyond_single_precision_are_errors():
    a = ph.vector(np.array([[1, 0, 0], [1e-45, 0, 0]], np.float32))
    with pytest.raises(
        ValueError, match=r"index \(1,\) of norm 1.4\d*e-45 has no inverse in the range of float32"
    ):
        a.inverse()
    with pytest.raises(ValueError, match="has no exp in the range of float32"):
        ph.scalar(np.float32(100)).exp()
    largest = ph.vector(np.array([3e38, 3e38, 0], np.float32))
    assert largest.norm() == np.inf  # as sums and products are
    assert largest.normalized().dtype == np.float32


def test_numbers_of_python_do_not_raise_the_precision_of_rotors():
    plane = (e1 ^ e2).astype(np.float32)
    R = ph.Rotor.from_plane_angle(plane, 0.5)
    for value in (
        R,
        R**2,
        R**0.5,
        R.sqrt(),
        ph.slerp(R, R * R, 0.5),
        ph.stack([R, R]) ** 2,
        R.log(),
        R.inverse(),
    ):
        assert value.dtype == np.float32
    assert (R ** np.float64(2)).dtype == np.float64
    assert (R ** np.array([1.0, 2.0])).dtype == np.float64


def test_changed_components_are_coefficients():
    a = ph.vector([1.5, 2.5, -3.5])
    assert a.map(lambda c: c.astype(int)).dtype == np.float64
    assert a.map(lambda c: c.astype(np.float16)).dtype == np.float64
    assert a.map(lambda c: c.astype(np.float32)).dtype == np.float32
    assert types(a.map(lambda c: c.astype(int).astype(object))) == {int}
    for bad in (
        lambda c: c > 0,
        lambda c: c.astype(str),
        lambda c: None,
        lambda c: c[:2],
        float,
    ):
        with pytest.raises(TypeError):
            a.map(bad)
    with pytest.raises(TypeError, match="coefficient at index"):
        a.astype(object).map(str)


def test_short_integers_of_numpy_keep_single_precision():
    a = ph.vector(np.array([1, 2, 3], np.float32))
    for number in (np.int8(2), np.uint16(2), np.array([2, 3], np.int16)):
        for result in (number * a, a * number, a + number, a - number):
            assert result.dtype == np.float32
    assert (np.int32(2) * a).dtype == (np.int8(2) * e1).dtype == np.float64
    assert np.int8(2) * a == 2 * a


def test_overflow_of_single_precision_warns():
    a = ph.vector(np.array([1, 2, 3], np.float32))
    with pytest.warns(RuntimeWarning, match="overflow"):
        assert np.isinf((a * 1e300).components).all()


@pytest.mark.parametrize(
    "bad",
    [
        True,
        np.True_,
        "2",
        b"2",
        None,
        [1, 2],
        (1.0,),
        {1: 2},
        Decimal(1),
        object(),
        mpmath.mpc(1, 2),
        np.ones(2, bool),
        np.array(["a"]),
        np.array([None]),
        np.array([Decimal(1)]),
        np.array(["2020-01-01"], "M8[D]"),
        float,
        np.float64,
        e1.dot,
        range(3),
        slice(1),
        np.array([object()]),
    ],
    ids=lambda value: type(value).__name__,
)
@pytest.mark.parametrize("operate", [*OPERATORS, operator.truediv])
def test_other_types_raise_on_either_side(bad, operate):
    for A in (e1, ph.vector(np.ones((2, 3))), ph.vector([F(1, 2), 0, 0]), ph.algebra(2).scalar(1)):
        with pytest.raises(TypeError):
            operate(A, bad)
        with pytest.raises(TypeError):
            operate(bad, A)


@pytest.mark.parametrize(
    "bad", [np.ma.array([1.0, 2, 3], mask=[0, 1, 0]), np.ma.array([[1.0, 2, 3]])], ids=repr
)
def test_masked_arrays_raise(bad):
    with pytest.raises(TypeError, match="masked array; fill it"):
        ph.vector(bad)
    with pytest.raises(TypeError):
        bad[..., 0] * e1


# --- exact numbers


def test_fractions_stay_exact_from_either_side():
    third = F(1, 3)
    for value in (third * e1, e1 * third, e1 / 3 * 0 + third * e1, e1 / F(3), third ^ e1, e1 | third):
        assert value == ph.vector([third, 0, 0])
        assert types(value) <= {int, F}
    for value in (
        third + e1,
        e1 + third,
        third - -e1,
        third / e1 * (e1 * third * e1) * 3 * 1 + e1 - third + third,
    ):
        assert types(value) <= {int, F}
    assert types(F(2) / ph.vector([F(1), F(2), 0])) <= {int, F}
    assert third * e1 * (3 * e1) == 1
    assert types(np.int64(2) * (third * e1)) <= {int, F}
    assert types(np.array([1, 2]) * (third * e1)) <= {int, F}
    assert types(third * ph.vector(np.ones((2, 3)))) <= {int, F}
    assert types(np.array([F(1, 2), F(1, 3)]) * e1) <= {int, F}


def test_whole_numbers_are_exact_on_request():
    a = ph.vector([1, 2, 3], dtype=object)
    assert types(a) == {int}
    assert types(e1.astype(object)) == {int}
    assert types(a * a) == {int}
    assert types(a**9) == {int}
    assert a / 7 * 7 == a
    assert types(a / 7) <= {int, F}
    assert types(a.inverse()) <= {int, F}
    assert a * a.inverse() == 1
    assert types(ph.vector([0.5, 2, 3], dtype=object)) == {float, int}
    assert 10**40 * a * a == 14 * 10**40


def test_exact_numbers_with_other_floats_are_floats():
    assert 0.1 * (F(1, 3) * e1) == 0.1 * F(1, 3) * e1
    assert types(0.1 * ph.vector([F(1, 3)] * 3)) == {float}
    assert types(ph.vector(np.array([0.1, 0, 0], np.float32)) + F(1, 3) * e1) <= {float, int, F}


def test_equality_of_exact_and_float():
    assert ph.vector([F(1, 2), 0, 0]) == e1 / 2
    assert ph.vector([F(1, 3), 0, 0]) != e1 / 3
    assert ph.scalar(2**53 + 1) != ph.scalar(float(2**53))
    assert ph.scalar(F(1, 3)).is_close(1 / 3)
    assert not ph.scalar(F(1, 3)).is_close(0.3333)


def test_sizes_of_exact_values_are_numbers():
    a = ph.vector([F(3), F(4), 0])
    assert a.norm() == 5
    assert isinstance(a.norm(), int | F)
    assert isinstance(a.norm_squared(), int | F)
    assert ph.vector([F(1), F(1), 0]).norm() == 2**0.5
    assert a.normalized() == ph.vector([F(3, 5), F(4, 5), 0])
    assert isinstance(ph.Rotor.from_components([F(1), 0, 0, F(1)]).plane_angle()[1], float)


def test_division_by_an_exact_zero():
    for zero in (F(0), 0 * x, np.array([F(0)]), ph.scalar(F(0))):
        with pytest.raises(ZeroDivisionError, match="multivector by zero"):
            e1 / zero


# --- SymPy and mpmath


@pytest.mark.parametrize(
    "expression",
    [x, x + 1, 2 * x, x**2, sympy.sin(x), sympy.pi, sympy.Integer(3), sympy.Rational(1, 3), sympy.Float(0.5)],
)
@both_ways
def test_expressions_on_either_side(expression, operate):
    for A in (e1 + I, ph.vector(np.ones((2, 3))), ph.vector([x, 1, 2])):
        assert np.all(operate(A, expression) == operate(A, ph.scalar(expression)))
        left, right = operate(expression, A), operate(ph.scalar(expression), A)
        assert np.all((left - right).map(sympy.simplify) == 0)
        assert left.dtype == object


def test_expressions_and_values_compare_from_either_side():
    assert x != e1
    assert e1 != x
    assert x == ph.scalar(x)
    assert ph.scalar(x) == x
    assert sympy.Integer(1) == ph.scalar(1)
    for one in (sympy.Integer(1), sympy.Float(1), sympy.pi):
        assert one != e1


def test_multiprecision_numbers_keep_their_digits():
    with mpmath.workdps(40):
        third = mpmath.mpf(1) / 3
        for value in (third * e1, e1 * third, third * ph.vector([F(1), 0, 0]), third * (e1 * 3) / 3):
            assert value.components[0] == third
        assert (third + e1).grade(0) == third
        R = ph.Rotor.from_plane_angle(e1 ^ e2, third)
        assert abs(R(e1).components[0] - mpmath.cos(third)) < mpmath.mpf(10) ** -39
        assert abs((R * ~R).grade(0).components[0] - 1) < mpmath.mpf(10) ** -39


# --- JAX


@pytest.fixture
def jnp():
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        yield jax.numpy


@both_ways
def test_jax_arrays_on_either_side(jnp, operate):
    array = jnp.asarray([1.0, 2.0])
    for A in (e1 + 2 * I, ph.vector(np.ones((2, 3))), ph.vector(jnp.ones((2, 3)))):
        for left, right in ((array, A), (A, array)):
            result = operate(left, right)
            assert isinstance(result.components, type(array))
            plain = [
                np.asarray(v) if v is array else ph.Multivector._of(np.asarray(v.components), v._mask)
                for v in (left, right)
            ]
            assert np.allclose(
                np.asarray(result.components), operate(*plain).components, rtol=1e-15, atol=1e-15
            )
    assert isinstance(array == ph.scalar(1.0), type(array))


def test_jax_keeps_its_default_precision():
    jnp = pytest.importorskip("jax.numpy")
    a = ph.vector(jnp.asarray([1.0, 2.0, 3.0]))
    for value in (
        a,
        a * e1,
        e1 * a,
        np.ones(2) * a,
        a * np.float64(2),
        2 * a,
        ph.scalar(1.0) + a,
        a.dual(),
        a.exp(),
    ):
        assert value.dtype == np.float32


def test_traced_values_have_a_repr(jnp):
    import jax

    text = repr(jax.eval_shape(lambda v: v * v, ph.vector(jnp.ones((2, 3)))))
    assert text.startswith("Multivector of shape (2,) over (1, e2∧e3, e3∧e1, e1∧e2):\nShapeDtypeStruct")


def test_values_pass_through_the_transformations_of_jax(jnp):
    import jax

    def energy(a):
        return (a * a).grade(0).components[0] + a.norm()

    a = ph.vector(jnp.asarray([1.0, 2.0, 2.0]))
    gradient = jax.grad(energy)(a)
    assert isinstance(gradient, ph.Multivector)
    assert np.allclose(gradient.components, 2 * a.components + a.components / 3)
    many = ph.vector(jnp.ones((4, 3)))
    assert jax.vmap(lambda v: v * e1)(many).shape == (4,)
    R = jax.jit(lambda B: B.exp())(ph.bivector(jnp.asarray([0.0, 0.0, 0.1])))
    assert type(R) is ph.Rotor
    assert type(jax.jit(lambda R, S, t: ph.slerp(R, S, t))(R, R * R, 0.5)) is ph.Rotor
    C = ph.algebra(3, 0, 1)
    moved = jax.jit(lambda B: B.exp())(C.bivector(jnp.asarray([0.1] * 6)))
    assert moved.algebra is C


def test_dask_arrays_stay_lazy_and_give_the_same():
    da = pytest.importorskip("dask.array")
    numbers = np.arange(12.0).reshape(4, 3) + 1
    lazy, plain = ph.vector(da.from_array(numbers, chunks=(2, 3))), ph.vector(numbers)
    for operate in (
        lambda a: a * e1,
        lambda a: e1 + a,
        lambda a: a / a.norm(),
        lambda a: a.inverse(),
        lambda a: (a / 9).dual().exp(),
        lambda a: (a / 9).dual().exp()(a),
        lambda a: a.reshape(2, 2)[1],
    ):
        got, expected = operate(lazy), operate(plain)
        assert type(got) is type(expected)
        assert isinstance(got.components, da.Array)
        # Different formulas of as many roundings, of numbers below 12·|a|.
        assert np.allclose(np.asarray(got.components), expected.components, rtol=0, atol=64 * 2.0**-52 * 12)


# --- aliasing


def test_values_do_not_share_the_arrays_of_other_libraries():
    strict = pytest.importorskip("array_api_strict")
    array = strict.asarray([1.0, -0.0, 3.0])
    values = [ph.vector(array), ph.scalar(array), ph.multivector(strict.ones(8))]
    array[0] = 9.0
    assert repr(values[0]) == "e1 + 3 e3"
    assert np.signbit(np.asarray(values[0].components)[1])
    assert float(values[1].components[0, 0]) == 1


def test_operations_do_not_change_their_operands():
    arrays = [np.arange(1.0, 9.0), np.array([F(1, k) for k in range(1, 9)], dtype=object)]
    for array in arrays:
        A = ph.multivector(array)
        before, kept = copy.deepcopy(array), A.components.copy()
        for operate in (
            lambda A: A + e1,
            lambda A: A * A,
            lambda A: -A,
            lambda A: ~A,
            lambda A: A.inverse(),
            lambda A: A.grade(1).exp(),
            lambda A: A.map(lambda c: c * 2),
            lambda A: A.astype(float),
            lambda A: A.normalized(),
            lambda A: A[None],
            lambda A: A / 3,
        ):
            result = operate(A)
            assert result.components is not array
            result.components[...] = 0
            assert result.components is not array
        assert np.array_equal(array, before)
        assert np.array_equal(A.components, kept)
    assert (e1, e2, e3) == (ph.vector([1, 0, 0]), ph.vector([0, 1, 0]), ph.vector([0, 0, 1]))


# --- arrays with labels


@pytest.mark.parametrize("library", ["pandas", "xarray"])
@pytest.mark.parametrize("value", [e1, 1 + e1, ph.Rotor.identity(), ph.vector(np.eye(3))], ids=repr)
@pytest.mark.parametrize("operate", [*OPERATORS, operator.truediv, operator.eq])
def test_arrays_with_labels_are_no_operands(operate, value, library):
    module = pytest.importorskip(library)
    make = {"pandas": ("Series", "DataFrame", "Index"), "xarray": ("DataArray",)}[library]
    for labelled in (getattr(module, kind)([1.0, 2.0, 3.0]) for kind in make):
        for operands in ((value, labelled), (labelled, value)):
            with pytest.raises(TypeError, match=r"does not combine with .*pass its numbers, x\.values"):
                operate(*operands)
