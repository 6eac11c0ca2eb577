"""Products and sums against the naive oracle, over grades and shapes; numbers as scalars."""

from itertools import product

import numpy as np
import pytest

import naive
import polhode as ph
from naive import GRADE_SETS, PRODUCTS, eight_of, of_package
from polhode import e1
from values import SHAPES, a_value, fraction_of, nonzero

GRADE_PAIRS = list(product(GRADE_SETS, repeat=2))


def grades_of(product_of, r, s):
    """The grades of the oracle's product of blades of these grades, over all pairs of blades."""
    found = set()
    for a, b in product(naive.BASIS, naive.BASIS):
        if len(a) in r and len(b) in s:
            result = product_of({tuple(sorted(a)): 1}, {tuple(sorted(b)): 1})
            found |= {len(blade) for blade, x in result.items() if x != 0}
    return tuple(sorted(found)) or (0,)


NAMED = {name: (lambda A, B, name=name: getattr(A, name)(B), oracle) for name, oracle in PRODUCTS.items()}
OPERATORS = {
    "*": (lambda A, B: A * B, naive.geometric),
    "^": (lambda A, B: A ^ B, naive.wedge),
    "|": (lambda A, B: A | B, naive.dot),
}
ALL_PRODUCTS = NAMED | OPERATORS


# --- products


@pytest.mark.parametrize("signature", [(3, 0, 0), (1, 0, 0), (1, 3, 0), (3, 0, 1), (2, 2, 1)])
def test_the_anticommutator_is_the_rest_of_the_product(signature):
    algebra = ph.algebra(*signature)
    rng = np.random.default_rng(1)
    A, B = (algebra.multivector(rng.integers(-4, 5, (5, algebra.size)).astype(float)) for _ in range(2))
    assert np.all(A.anticommutator(B) == (A * B + B * A) / 2)
    assert np.all(A.anticommutator(B) + A.commutator(B) == A * B)
    for r, s in product(range(algebra.dimension + 1), repeat=2):
        P, Q = A.grade(r), B.grade(s)
        found = P.anticommutator(Q)
        assert np.all(found == (P * Q + Q * P) / 2)
        # The grades of the product are those of both parts.
        assert set(found.grades) | set(P.commutator(Q).grades) | {0} >= set((P * Q).grades)
    assert np.all(A.anticommutator(2) == 2 * A)


def test_anticommutators_of_vectors_and_planes():
    a, b = ph.vector([1, 2, 3]), ph.vector([3, 1, 0])
    assert a.anticommutator(b).grades == (0,)
    assert a.anticommutator(b) == a.dot(b)
    assert e1.anticommutator(ph.I) == ph.bivector([1, 0, 0])
    assert a.astype(object).anticommutator(b.astype(object)) == 5
    # In the plane I anticommutes with vectors: no grade is left, and the result is the number 0.
    plane = ph.algebra(2)
    none = plane.vector([3, 4]).anticommutator(plane.I)
    assert none.grades == (0,)
    assert none == 0
    with pytest.raises(TypeError, match="anticommutator needs a multivector"):
        a.anticommutator("b")


@pytest.mark.parametrize("name", ALL_PRODUCTS)
def test_products_of_all_grades_equal_the_oracle(name):
    of_package_values, of_dicts = ALL_PRODUCTS[name]
    for seed, (r, s) in enumerate(GRADE_PAIRS):
        A, B = a_value(r, 2 * seed), a_value(s, 2 * seed + 1)
        result = of_package_values(A, B)
        assert fraction_of(result) == nonzero(of_dicts(of_package(A), of_package(B))), (r, s)


@pytest.mark.parametrize("name", ALL_PRODUCTS)
def test_grades_follow_the_product_table(name):
    of_package_values, of_dicts = ALL_PRODUCTS[name]
    single = {(r, s): grades_of(of_dicts, (r,), (s,)) for r, s in product(range(4), repeat=2)}
    vanishing = {pair for pair in single if not any_product(of_dicts, pair)}
    for r, s in GRADE_PAIRS:
        present = {k for pair in product(r, s) if pair not in vanishing for k in single[pair]}
        expected = tuple(sorted(present)) or (0,)
        assert of_package_values(a_value(r, 1), a_value(s, 2)).grades == expected, (r, s)


def any_product(of_dicts, pair):
    """Whether some product of blades of these two grades is not zero."""
    blades = [tuple(sorted(blade)) for blade in naive.BASIS]
    left, right = ([blade for blade in blades if len(blade) == k] for k in pair)
    return any(any(of_dicts({a: 1}, {b: 1}).values()) for a, b in product(left, right))


@pytest.mark.parametrize(("left", "right"), list(product(SHAPES, repeat=2)))
@pytest.mark.parametrize("name", ALL_PRODUCTS)
def test_products_broadcast(name, left, right):
    of_values, _ = ALL_PRODUCTS[name]
    A, B = a_value((0, 1, 2), 3, left), a_value((1, 3), 4, right)
    try:
        batch = np.broadcast_shapes(left, right)
    except ValueError:
        with pytest.raises(ValueError, match="do not broadcast"):
            of_values(A, B)
        return
    result = of_values(A, B)
    assert result.shape == batch
    assert result.components.shape[:-1] == batch
    a8, b8 = (np.broadcast_to(eight_of(M), (*batch, 8)) for M in (A, B))
    for index in np.ndindex(*batch):
        assert result[index] == of_values(ph.multivector(a8[index]), ph.multivector(b8[index]))


@pytest.mark.parametrize("rows", [2, 31, 32, 33, 65])
def test_products_of_long_batches(rows):
    A, B = a_value((0, 1, 2, 3), 5, (rows,)), a_value((0, 1, 2, 3), 6, (rows,))
    result = A * B
    for i in range(rows):
        assert fraction_of(result[i]) == nonzero(naive.geometric(of_package(A[i]), of_package(B[i])))


@pytest.mark.parametrize(("left", "right"), list(product(SHAPES, repeat=2)))
def test_sums_broadcast(left, right):
    A, B = a_value((0, 1, 2), 3, left), a_value((1, 3), 4, right)
    try:
        batch = np.broadcast_shapes(left, right)
    except ValueError:
        for operate in (lambda: A + B, lambda: A - B, lambda: A == B, lambda: A.is_close(B)):
            with pytest.raises(ValueError, match=r"broadcast|shape"):
                operate()
        return
    assert np.array_equal(eight_of(A + B), eight_of(A) + eight_of(B))
    assert np.array_equal(eight_of(A - B), eight_of(A) - eight_of(B))
    assert (A + B).shape == batch
    assert np.shape(A == B) == np.shape(A.is_close(B)) == batch


def test_sums_of_all_grades():
    for r, s in GRADE_PAIRS:
        A, B = a_value(r, 7), a_value(s, 8)
        assert (A + B).grades == (A - B).grades == tuple(sorted({*r, *s}))
        assert np.array_equal(eight_of(A + B), eight_of(A) + eight_of(B))
        assert np.array_equal(eight_of(A - B), eight_of(A) - eight_of(B))
        assert np.array_equal(eight_of(-A), -eight_of(A))
        assert +A == A


# --- numbers on either side


@pytest.mark.parametrize(
    "number", [3, -2.5, np.float64(3), np.float32(0.5), np.int8(-3), np.uint64(7), np.array(2.0), np.array(5)]
)
def test_numbers_are_scalars_on_either_side(number):
    A, s = a_value((0, 1, 2, 3), 9), float(number)
    eight = eight_of(A)
    scalar = np.array([s, 0, 0, 0, 0, 0, 0, 0])
    for result, expected in [
        (number * A, s * eight),
        (A * number, s * eight),
        (number + A, scalar + eight),
        (A + number, scalar + eight),
        (number - A, scalar - eight),
        (A - number, eight - scalar),
        (A / number, eight / s),
        (number ^ A, s * eight),
        (A ^ number, s * eight),
        (number | A, s * eight),
        (A | number, s * eight),
        (A.wedge(number), s * eight),
        (A.dot(number), s * eight),
    ]:
        assert isinstance(result, ph.Multivector)
        assert np.array_equal(eight_of(result), expected)
    assert A.commutator(number) == 0
    assert ph.scalar(s) == number
    assert number == ph.scalar(s)


@pytest.mark.parametrize("dtype", [np.int32, np.float32, np.float64, np.uint8])
def test_arrays_are_batches_of_scalars_on_either_side(dtype):
    array = np.array([[1, 2, 3], [4, 5, 6]], dtype=dtype)
    A = a_value((0, 1, 2, 3), 10)
    expected = array[..., None] * eight_of(A)
    for result in (array * A, A * array, array ^ A, A ^ array, array | A, A | array):
        assert result.shape == (2, 3)
        assert np.array_equal(eight_of(result), expected)
    assert np.array_equal(eight_of(array + A), eight_of(A + array))
    assert np.array_equal(eight_of(array - A), -eight_of(A - array))
    assert np.array_equal(eight_of(A / array), eight_of(A) / array[..., None])


def test_a_number_over_a_multivector_is_its_inverse_scaled():
    assert 6 / (2 * e1) == 3 * e1
    assert np.array([2.0, 4.0])[1] / (2 * e1) == 2 * e1
    assert np.all(np.array([2.0, 4.0]) / (2 * e1) == ph.vector([[1, 0, 0], [2, 0, 0]]))


def test_whole_numbers_of_any_size_are_scalars():
    assert 10**20 * e1 == ph.vector([1e20, 0, 0])
    assert e1 * 2**70 == ph.vector([2.0**70, 0, 0])


@pytest.mark.parametrize("other", ["2", None, [1, 2], (1.0,), True, {}, object()])
def test_invalid_operands_raise(other):
    for operate in (
        lambda: e1 * other,
        lambda: other * e1,
        lambda: e1 + other,
        lambda: other - e1,
        lambda: e1 ^ other,
        lambda: other | e1,
        lambda: e1 / other,
        lambda: e1.wedge(other),
        lambda: e1.commutator(other),
        lambda: e1.is_close(other),
        lambda: ph.to_pauli(other),
    ):
        with pytest.raises(TypeError):
            operate()
    assert (e1 == other) is False
    assert (e1 != other) is True
