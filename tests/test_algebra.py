"""Every product, involution and function of multivectors against the naive oracle; and how values behave."""

import copy
import pickle
from fractions import Fraction
from itertools import product

import numpy as np
import pytest

import naive
import polhode as ph
from naive import GRADE_SETS, PRODUCTS, eight_of, magnitude, of_package, ph_value
from polhode import I, e1, e2, e3

EPS = 2.0**-52
SHAPES = [(), (1,), (3,), (0,), (2, 1, 3)]
GRADE_PAIRS = list(product(GRADE_SETS, repeat=2))


def numbers(shape, seed):
    """Whole components, small enough that sums of their products are exact."""
    return np.random.default_rng(seed).integers(-9, 10, shape).astype(float)


def a_value(grades, seed, shape=()):
    return ph_value(numbers((*shape, 8), seed), grades)


def fraction_of(M):
    return {blade: x for blade, x in of_package(M).items() if x != 0}


def nonzero(A):
    return {blade: Fraction(x) for blade, x in A.items() if x != 0}


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
        with pytest.raises(ValueError, match="shape mismatch"):
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


@pytest.mark.parametrize("other", ["2", None, 1j, [1, 2], (1.0,), True, {}, object()])
def test_other_things_are_no_multivectors(other):
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


# --- operators of one value


UNARY = {
    "reverse": (lambda A: A.reverse(), naive.reverse),
    "~": (lambda A: ~A, naive.reverse),
    "grade_involution": (lambda A: A.grade_involution(), naive.grade_involution),
    "clifford_conjugate": (lambda A: A.clifford_conjugate(), naive.clifford_conjugate),
    "dual": (lambda A: A.dual(), naive.dual),
    "undual": (lambda A: A.undual(), naive.undual),
}


@pytest.mark.parametrize("name", UNARY)
def test_involutions_and_duals_equal_the_oracle(name):
    of_value, of_dict = UNARY[name]
    for seed, grades in enumerate(GRADE_SETS):
        A = a_value(grades, seed)
        assert fraction_of(of_value(A)) == nonzero(of_dict(of_package(A)))
        batch = a_value(grades, seed, (2, 1, 3))
        assert np.array_equal(eight_of(of_value(batch))[1, 0, 2], eight_of(of_value(batch[1, 0, 2])))


def test_involutions_keep_the_grades():
    for grades in GRADE_SETS:
        A = a_value(grades, 1)
        assert (~A).grades == A.grade_involution().grades == A.clifford_conjugate().grades == grades
        assert A.dual().grades == A.undual().grades == tuple(sorted(3 - k for k in grades))


def test_dual_and_undual_are_inverse():
    A = a_value((0, 1, 2, 3), 2, (3,))
    assert np.all(A.dual().undual() == A)
    assert np.all(A.undual().dual() == A)


def test_grade_parts():
    A = a_value((0, 1, 2, 3), 3)
    eight = eight_of(A)
    for k, part in enumerate((eight[:1], eight[1:4], eight[4:7], eight[7:])):
        assert A.grade(k).grades == (k,)
        assert np.array_equal(A.grade(k).components, part)
    assert e1.grade(2) == 0
    assert e1.grade(2).grades == (2,)


@pytest.mark.parametrize("k", [-1, 4, 100])
def test_grades_beyond_3_are_an_error(k):
    with pytest.raises(ValueError, match=f"grades 0 to 3, got {k}"):
        e1.grade(k)


# --- sizes


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("grades", GRADE_SETS)
def test_norms_of_batches(grades, shape):
    A = a_value(grades, 4, shape)
    squares = np.sum(eight_of(A) ** 2, axis=-1)
    assert np.array_equal(A.norm_squared(), squares)
    assert np.array_equal(A.norm(), np.sqrt(squares))  # whole squares: one rounding
    assert np.shape(A.norm()) == shape


def test_norm_is_the_scalar_part_with_the_reverse():
    A = a_value((0, 1, 2, 3), 5)
    assert A.norm_squared() == float((A * ~A).grade(0))


@pytest.mark.parametrize("scale", [2.0**-1070, 2.0**-600, 1.0, 2.0**600, 2.0**1020])
def test_norm_neither_overflows_nor_underflows(scale):
    assert ph.vector([3 * scale, 4 * scale, 0]).norm() == 5 * scale
    assert ph.multivector([scale * x for x in (1, 1, 1, 1, 2, 2, 2, 0)]).norm() == 4 * scale


def test_norm_of_the_non_finite():
    assert ph.vector([np.inf, 1, 1]).norm() == np.inf
    assert np.isnan(ph.vector([np.nan, 1, 1]).norm())


@pytest.mark.parametrize("scale", [5e-324, 1e-310, 1e-160, 1.0, 1e160, 1e306])
@pytest.mark.parametrize("shape", [(), (3,), (2, 1, 3)])
def test_normalized(scale, shape):
    whole = 2 * numbers((*shape, 8), 6) + 1
    components = scale * whole
    unit = ph.multivector(components).normalized()
    assert unit.shape == shape
    # Division by the largest component, squares, their sum, root, division: < 4 roundings.
    assert np.all(abs(magnitude(unit) - 1) <= 4 * EPS)
    exact = components / scale  # the components as they were rounded, scaled back; whole at 5e-324
    direction = exact / np.linalg.norm(exact, axis=-1, keepdims=True)
    assert np.all(abs(eight_of(unit) - direction) <= 8 * EPS)


@pytest.mark.parametrize("bad", [0.0, np.nan, np.inf])
def test_normalizing_what_has_no_direction(bad):
    with pytest.raises(ValueError, match="has no direction"):
        ph.vector([bad, 0, 0]).normalized()
    values = np.ones((2, 3, 3))
    values[1, 2] = [bad, 0, 0]
    with pytest.raises(ValueError, match=r"at index \(1, 2\)"):
        ph.vector(values).normalized()


# --- inverse, powers, division


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("grades", GRADE_SETS)
def test_inverse(grades, shape):
    # A large first component keeps away from null elements.
    eight = numbers((*shape, 8), 7)
    lead = {0: 0, 1: 1, 2: 4, 3: 7}[grades[0]]
    eight[..., lead] += 40
    A = ph_value(eight, grades)
    inverse = A.inverse()
    assert inverse.shape == shape
    # Some dozen operations on each of eight terms, magnified by |A||A⁻¹|, which is below 4 here.
    for one in (A * inverse, inverse * A):
        assert np.all(magnitude(one - 1) <= 128 * EPS)


@pytest.mark.parametrize("scale", [1e-300, 1e-160, 1e160, 1e300])
def test_inverse_at_the_ends_of_the_range(scale):
    A = ph.multivector(scale * np.array([3.0, 1, -2, 1, 0.5, 0, 1, 2]))
    expected = ph.multivector([3.0, 1, -2, 1, 0.5, 0, 1, 2]).inverse()
    assert magnitude(A.inverse() * scale - expected) <= 16 * EPS * magnitude(expected)


def test_inverse_beyond_the_range_is_an_error():
    with pytest.raises(ValueError, match="beyond the range"):
        ph.vector([5e-324, 0, 0]).inverse()


SINGULAR = [0 * e1, 1 + e1, 1 - e3, e1 + e1 * e2, e1 * e2 + I, 3 * (1 + (3 * e1 + 4 * e2) / 5)]


@pytest.mark.parametrize("A", SINGULAR, ids=str)
def test_singular_values_have_no_inverse(A):
    for operate in (lambda: A.inverse(), lambda: A**-1, lambda: 1 / A, lambda: e1 / A):
        if A.grades == (0,):
            continue
        with pytest.raises(ValueError, match="no inverse"):
            operate()


@pytest.mark.parametrize("A", SINGULAR[1:], ids=str)
def test_the_error_of_a_singular_inverse_names_the_index(A):
    shift = np.array([[20.0, 20.0, 20.0], [30.0, 30.0, 0.0]])  # the last one stays singular
    with pytest.raises(ValueError, match=r"at index \(1, 2\): no inverse"):
        (A + shift).inverse()


@pytest.mark.parametrize("name", ["inverse", "exp", "log", "sqrt"])
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("grades", GRADE_SETS)
def test_functions_of_the_non_finite_are_errors_with_the_index(name, bad, grades):
    eight = np.ones((4, 8))
    eight[:, 0] = 20
    lead = {0: 0, 1: 1, 2: 4, 3: 7}[grades[0]]
    eight[2, lead] = bad
    with pytest.raises(ValueError, match=r"at index \(2,\): a component is NaN or infinite"):
        getattr(ph_value(eight, grades), name)()
    with pytest.raises(ValueError, match=r"^a component is NaN or infinite"):
        getattr(ph_value(eight[2], grades), name)()


@pytest.mark.parametrize("grades", GRADE_SETS)
@pytest.mark.parametrize("n", range(6))
def test_whole_powers_are_repeated_products(n, grades):
    A = a_value(grades, 8)
    expected = {(): 1}
    for _ in range(n):
        expected = naive.geometric(expected, of_package(A))
    assert fraction_of(A**n) == nonzero(expected)
    assert fraction_of(A ** np.int64(n)) == nonzero(expected)


def test_powers_of_batches():
    A = a_value((0, 1), 9, (2, 3))
    assert np.all(A**3 == A * A * A)
    assert (A**0).shape == (2, 3)
    assert np.all(A**0 == 1)


def test_negative_powers_go_through_the_inverse():
    A = 2 + e1  # inverse (2 − e1)/3
    assert (A**-2).is_close((5 - 4 * e1) / 9, rtol=16 * EPS)
    assert (2 * e1) ** -1 == e1 / 2
    assert (2 * e1) ** -3 == e1 / 8


@pytest.mark.parametrize("n", [0.5, 2.0, "2", None, 1j])
def test_other_powers_are_errors(n):
    with pytest.raises(TypeError, match="integer powers"):
        e1**n


def test_division_by_multivectors():
    assert e1 * e2 / e2 == e1
    assert I / I == 1
    assert (6 * e1) / (2 * e2) == 3 * e1 * e2
    A, B = a_value((0, 1, 2, 3), 10), 30 + a_value((1, 2), 11)
    assert (A / B * B).is_close(A, rtol=64 * EPS)


@pytest.mark.parametrize("zero", [0, 0.0, np.float64(0), ph.scalar(0.0)])
def test_division_by_zero(zero):
    with pytest.raises(ZeroDivisionError, match="division of a multivector by zero"):
        e1 / zero


def test_division_by_an_array_with_a_zero_names_the_index():
    with pytest.raises(ZeroDivisionError, match=r"\(1,\)"):
        e1 / np.array([1.0, 0.0, 2.0])


# --- geometry


def test_project_and_reject():
    a = ph.vector(numbers((50, 3), 12))
    plane, line = 2 * e1 * e2, 4 * e3
    for blade in (plane.grade(2), line, I, ph.scalar(3.0)):
        parallel, perpendicular = a.project(blade), a.reject(blade)
        assert parallel.grades == (1,)
        assert np.all(parallel + perpendicular == a)
        assert np.all(parallel.wedge(blade).grades == (0,)) or np.all(parallel.wedge(blade) == 0)
        assert np.all(perpendicular.left_contraction(blade) == 0)
        assert np.all(parallel.project(blade) == parallel)
    assert np.array_equal(a.project(plane.grade(2)).components, a.components * [1, 1, 0])
    assert np.array_equal(a.project(line).components, a.components * [0, 0, 1])
    assert np.all(a.project(I) == a)


def test_projection_of_a_bivector_onto_a_plane():
    B = ph.bivector([3.0, 5.0, 7.0])
    assert B.project((e1 * e2).grade(2)) == 7 * e1 * e2
    assert B.reject((e1 * e2).grade(2)) == 3 * e2 * e3 + 5 * e3 * e1


def test_projection_onto_a_tilted_plane():
    a, n = ph.vector(numbers((50, 3), 13)), ph.vector([2.0, -3.0, 6.0])  # |n| = 7
    along = a.components @ n.components
    expected = a.components - along[:, None] * n.components / 49
    # Contraction, inverse and product: three sums of three terms.
    assert np.all(magnitude(a.project(n.undual()) - ph.vector(expected)) <= 16 * EPS * magnitude(a))


def test_projection_onto_nothing_is_an_error():
    with pytest.raises(ValueError, match="no inverse"):
        e1.project(0 * e2)


def test_cross_product():
    a, b = numbers((4, 1, 3), 14), numbers((5, 3), 15)
    assert np.array_equal(ph.cross(ph.vector(a), ph.vector(b)).components, np.cross(a, b))
    assert ph.cross(e1, e2) == e3
    assert ph.cross(e1, e2).grades == (1,)
    for bad in (e1 * e2, 2.0, I, np.ones(3)):
        with pytest.raises(TypeError, match="factor must be a vector"):
            ph.cross(e1, bad)


@pytest.mark.parametrize("shape", SHAPES)
def test_pauli_matrices_are_a_homomorphism(shape):
    A, B = a_value((0, 1, 2, 3), 16, shape), a_value((0, 1, 2, 3), 17, shape)
    PA, PB = ph.to_pauli(A), ph.to_pauli(B)
    assert PA.shape == (*shape, 2, 2)
    assert PA.dtype == np.complex128
    assert np.array_equal(ph.to_pauli(A * B), PA @ PB)
    assert np.array_equal(ph.to_pauli(A + B), PA + PB)
    assert np.array_equal(ph.to_pauli(~A), PA.conj().swapaxes(-1, -2))
    assert np.all(ph.from_pauli(PA) == A)
    assert np.all(ph.from_pauli(PA @ PB) == A * B)


def test_from_pauli_of_any_matrix():
    whole = numbers((6, 2, 2, 2), 18)
    matrices = whole[..., 0] + 1j * whole[..., 1]
    assert np.array_equal(ph.to_pauli(ph.from_pauli(matrices)), matrices)
    assert ph.from_pauli([[1, 0], [0, 1]]) == 1
    assert ph.from_pauli([[1, 0], [0, -1]]) == e3


@pytest.mark.parametrize(
    "bad", [np.ones((3, 3)), np.ones(4), 1.0, [["a", "b"], ["c", "d"]], np.eye(2, dtype=bool)]
)
def test_from_pauli_refuses_other_things(bad):
    with pytest.raises(ValueError, match="from_pauli needs numeric matrices"):
        ph.from_pauli(bad)


# --- comparison


def test_equality_is_exact_and_over_all_grades():
    assert e1 == ph.multivector([0, 1, 0, 0, 0, 0, 0, 0])
    assert e1 != e1 * (1 + EPS)
    assert (e1 == e2) == np.False_
    assert 0 * e1 == 0 * I
    assert ph.scalar(0.0) == ph.scalar(-0.0)
    assert ph.vector([np.nan, 0, 0]) != ph.vector([np.nan, 0, 0])
    assert e1 * e2 == ph.bivector([0, 0, 1])


def test_equality_of_batches():
    A = ph.vector([[1, 0, 0], [0, 1, 0]])
    assert np.array_equal(e1 == A, [True, False])
    assert np.array_equal(e1 != A, [False, True])
    assert np.array_equal(e1 == A, [True, False])


def test_is_close_is_relative_to_the_larger_norm():
    assert (e1 * (1 + 0.9e-9)).is_close(e1)
    assert not (e1 * (1 + 1.1e-9)).is_close(e1)
    # |A − B| = 1e-12 in a component that is zero in one of them; the norm is 1.
    assert (e1 + 1e-12 * e2).is_close(e1)
    assert (e1 + 1e-12 * I).is_close(e1)
    assert not (1e-12 * e2).is_close(0)  # relative to itself it is far
    assert (1e-12 * e2).is_close(0, atol=1e-11)
    assert ph.scalar(0.0).is_close(0)
    assert not (2 * e1).is_close(e1, rtol=0.49)
    assert (2 * e1).is_close(e1, rtol=0.5)
    assert (1e-300 * e1).is_close(1e-300 * e1 * (1 + 1e-10))


def test_is_close_of_batches_and_the_non_finite():
    A = ph.vector([[1, 0, 0], [np.nan, 0, 0], [np.inf, 0, 0], [-np.inf, 0, 0]])
    assert np.array_equal(A.is_close(A), [True, False, True, True])
    assert np.array_equal(A.is_close(-A), [False, False, False, False])
    assert np.array_equal(A.is_close(e1, atol=np.inf), [True, False, False, False])


def test_is_close_at_the_end_of_the_range():
    big = 1.7e308
    assert not ph.vector([big, big, 0]).is_close(ph.vector([big, 0.9 * big, 0]))
    assert not ph.vector([big, 0, 0]).is_close(ph.vector([-big, 0, 0]))


def test_is_close_of_other_things_is_an_error():
    with pytest.raises(TypeError, match="cannot compare a multivector with str"):
        e1.is_close("e1")


# --- batches as sequences


def test_indexing():
    eight = numbers((2, 3, 4, 8), 19)
    A = ph.multivector(eight)
    mask = eight[..., 0] > 0
    for index in [
        0,
        -1,
        (1, 2),
        (1, 2, 3),
        slice(None, None, 2),
        (slice(None), 1),
        (..., 0),
        (0, ..., 1),
        None,
        (slice(None), None, 2),
        [1, 0, 1],
        (slice(None), [0, 2]),
        (..., [3, 1]),
        ([0, 1], slice(None), [2, 3]),
        np.array([[0, 1], [1, 0]]),
        mask,
        (slice(None), slice(None, None, -1)),
        (),
        ...,
    ]:
        parts = index if isinstance(index, tuple) else (index,)
        full = parts if any(part is Ellipsis for part in parts) else (*parts, Ellipsis)
        expected = eight[(*full, slice(None))]
        picked = A[index]
        assert picked.shape == expected.shape[:-1]
        assert np.array_equal(eight_of(picked), expected)


@pytest.mark.parametrize(
    "index",
    [
        (slice(None), [0, 2]),
        (..., [1, 0]),
        (slice(None), slice(None, None, -1)),
        ([1, 0], slice(None)),
        (..., 1),
    ],
    ids=str,
)
@pytest.mark.parametrize("grades", GRADE_SETS)
def test_what_is_picked_computes_like_any_other(index, grades):
    # Whatever the memory order of the selection.
    eight = numbers((2, 3, 8), 20)
    eight[..., 0] += 40
    A = ph_value(eight, grades)[index]
    fresh = ph_value(np.ascontiguousarray(eight[(*index, slice(None))]), grades)
    assert np.all(fresh == A)
    assert np.array_equal(A.norm(), fresh.norm())
    assert np.all(fresh * fresh == A * A)
    assert np.all(A.exp() == fresh.exp())
    assert np.all((A + 50).inverse() == (fresh + 50).inverse())
    assert np.array_equal(ph.to_pauli(A), ph.to_pauli(fresh))
    R = ph.Rotor.random(A.shape, 1)
    assert np.all(R(A) == R(fresh))
    last, fresh_last = A[(-1,) * len(A.shape)], fresh[(-1,) * len(A.shape)]
    assert last * last == fresh_last * fresh_last
    assert last.dual() == fresh_last.dual()
    a, b = A.grade(1), fresh.grade(1)
    B = ph.bivector(np.ones(3))
    assert np.all(ph.Rotor.from_vectors(a + e1 * 40, e2) == ph.Rotor.from_vectors(b + e1 * 40, e2))
    angle = A.grade(0).components[..., 0]
    assert np.all(ph.Rotor.from_plane_angle(B, angle) == ph.Rotor.from_plane_angle(B, angle.copy()))


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("grades", GRADE_SETS)
@pytest.mark.parametrize("name", ["exp", "inverse", "log", "sqrt", "norm", "normalized", "__neg__"])
def test_functions_of_a_batch_are_those_of_its_values(name, grades, order):
    eight = numbers((2, 3, 8), 21) / 8
    eight[..., 0] += 5
    A = ph_value(np.array(eight, order=order), grades)
    if name in ("inverse", "log", "sqrt") and 0 not in grades and len(grades) > 1:
        A = A + 5  # away from null elements
    batch = getattr(A, name)()
    for index in np.ndindex(2, 3):
        single = getattr(A[index], name)()
        assert np.all(batch[index] == single), index


def test_indexing_errors_name_the_batch_shape():
    A = ph.vector(np.zeros((2, 3, 3)))
    for index in [2, (0, 3), (0, 0, 0), "x", 1.5]:
        with pytest.raises(IndexError, match=r"batch shape \(2, 3\)"):
            A[index]
    with pytest.raises(IndexError, match=r"batch shape \(\)"):
        e1[0]


def test_iteration_and_length():
    A = ph.vector(numbers((3, 2, 3), 22))
    assert len(A) == 3
    items = list(A)
    assert len(items) == 3
    assert all(np.all(item == A[i]) and item.shape == (2,) for i, item in enumerate(items))
    assert len(ph.vector(np.zeros((0, 3)))) == 0
    assert list(ph.vector(np.zeros((0, 3)))) == []
    for operate in (lambda: len(e1), lambda: list(e1)):
        with pytest.raises(TypeError, match="no length"):
            operate()


def test_items_of_rotors_are_rotors():
    R = ph.Rotor.random((3,), 1)
    assert isinstance(R[0], ph.Rotor)
    assert all(isinstance(item, ph.Rotor) for item in R)


def test_float_of_a_scalar():
    assert float(ph.scalar(2.5)) == 2.5
    for value in (e1, ph.scalar([1.0, 2.0]), 1 + e1, ph.multivector([1.0, 0, 0, 0, 0, 0, 0, 0])):
        with pytest.raises(TypeError, match="only a single scalar becomes a float"):
            float(value)


# --- copies and immutability


@pytest.mark.parametrize(
    "A", [e1, 2 + e1 * e2, ph.vector(np.ones((2, 3))), ph.Rotor.random((2,), 2)], ids=repr
)
def test_pickle_and_copy(A):
    for twin in (
        *(pickle.loads(pickle.dumps(A, protocol)) for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1)),
        copy.copy(A),
        copy.deepcopy(A),
    ):
        assert type(twin) is type(A)
        assert twin.grades == A.grades
        assert np.all(twin == A)
        assert not twin.components.flags.writeable


def test_values_are_immutable():
    A = ph.vector(np.ones((2, 3)))
    with pytest.raises(AttributeError, match="immutable"):
        A.shape = (3,)
    with pytest.raises(AttributeError, match="immutable"):
        A.e4 = 1
    with pytest.raises(ValueError, match="read-only"):
        A.components[0] = 5
    with pytest.raises(TypeError):
        A[0] = e1
    with pytest.raises(ValueError, match="read-only"):
        A[0].components[0] = 5


def test_values_do_not_share_the_callers_array():
    numbers_in = np.ones((2, 3))
    A, s, R = ph.vector(numbers_in), ph.scalar(numbers_in), ph.Rotor.from_components(np.ones((2, 4)))
    numbers_in[:] = 7
    assert numbers_in.flags.writeable
    assert np.all(ph.vector([1, 1, 1]) == A)
    assert np.all(s == 1)
    assert not R.components.flags.writeable


def test_in_place_operators_make_new_values():
    value = before = e1
    value += e2
    assert before == e1
    assert value == e1 + e2
    array = np.array([1.0, 2.0])
    with pytest.raises(TypeError):  # it would have to become a multivector in place
        array += value


def test_multivectors_have_no_hash_and_no_constructor():
    with pytest.raises(TypeError, match="unhashable"):
        hash(e1)
    with pytest.raises(TypeError, match=r"use ph\.vector"):
        ph.Multivector()
    with pytest.raises(TypeError, match="Rotor is not made directly"):
        ph.Rotor([1, 0, 0, 0])


# --- text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (2 * e1 + 3 * e2 * e3, "2 e1 + 3 e2∧e3"),
        (e1, "e1"),
        (-e1, "-e1"),
        (e1 - e2, "e1 - e2"),
        (-1 - I, "-1 - I"),
        (ph.scalar(1.0), "1"),
        (ph.scalar(-2.5), "-2.5"),
        (0 * e1, "0"),
        (-0.0 * e1, "0"),
        (
            ph.multivector([1, 2, 3, 4, 5, 6, 7, 8]),
            "1 + 2 e1 + 3 e2 + 4 e3 + 5 e2∧e3 + 6 e3∧e1 + 7 e1∧e2 + 8 I",
        ),
        (-0.5 * e3 * e1 + 1e-20 * I, "-0.5 e3∧e1 + 1e-20 I"),
        (ph.scalar(1 / 3) - 2e10 / 3 * e1, "0.33333333 - 6.6666667e+09 e1"),
        (ph.vector([np.nan, np.inf, -np.inf]), "nan e1 + inf e2 - inf e3"),
        (ph.Rotor.identity(), "1"),
        (ph.vector([[1, 0, 0], [0, -2, 0]]), "Multivector of shape (2,):\n[e1,\n -2 e2]"),
        (ph.vector(np.zeros((0, 3))), "Multivector of shape (0,):\n[]"),
        (ph.scalar(np.arange(6.0)), "Multivector of shape (6,):\n[0,\n 1,\n 2,\n 3,\n 4,\n 5]"),
        (ph.scalar(np.arange(9.0)), "Multivector of shape (9,):\n[0,\n 1,\n 2,\n 3,\n 4,\n …,\n 8]"),
        (ph.scalar(np.ones((2, 1))), "Multivector of shape (2, 1):\n[1,\n 1]"),
        (ph.Rotor.identity((2,)), "Rotor of shape (2,):\n[1,\n 1]"),
    ],
    ids=repr,
)
def test_repr(value, text):
    assert repr(value) == text
    assert str(value) == text


# --- what the constructors take


def test_constructors_and_their_shapes():
    for make, size, grades in [
        (ph.vector, 3, (1,)),
        (ph.bivector, 3, (2,)),
        (ph.multivector, 8, (0, 1, 2, 3)),
    ]:
        for shape in SHAPES:
            value = make(np.ones((*shape, size), dtype=np.int16))
            assert value.shape == shape
            assert value.grades == grades
            assert value.components.shape == (*shape, size)
            assert value.dtype == np.float64
    for make, grades in [(ph.scalar, (0,)), (ph.trivector, (3,))]:
        for shape in SHAPES:
            value = make(np.ones(shape))
            assert value.shape == shape
            assert value.grades == grades
            assert value.components.shape == (*shape, 1)


@pytest.mark.parametrize(
    ("make", "size"), [(ph.vector, 3), (ph.bivector, 3), (ph.multivector, 8), (ph.Rotor.from_components, 4)]
)
def test_wrong_shapes_are_errors(make, size):
    for shape in [(), (size + 1,), (size - 1,), (0,), (size, 1), (2, size + 1)]:
        with pytest.raises(ValueError, match=rf"needs {size} components in the last axis, got shape"):
            make(np.ones(shape))


@pytest.mark.parametrize("make", [ph.scalar, ph.vector, ph.bivector, ph.trivector, ph.multivector])
@pytest.mark.parametrize(
    "bad",
    [
        np.ones(8) * 1j,
        np.ones(8, dtype=bool),
        np.array([None] * 8),
        ["a", "b", "c"],
        "abc",
        None,
        np.array(["2020-01-01"], dtype="datetime64[D]"),
        [e1, e2, e3],
        e1,
    ],
    ids=lambda bad: type(bad).__name__ + getattr(bad, "dtype", np.dtype(object)).str,
)
def test_wrong_types_are_errors(make, bad):
    with pytest.raises(TypeError, match="must be real numbers"):
        make(bad)


def test_ragged_lists_are_errors():
    with pytest.raises(TypeError, match="unequal lengths"):
        ph.vector([[1, 2, 3], [1, 2]])


def test_fortran_ordered_and_strided_input():
    table = numbers((5, 6), 23)
    for array in (np.asfortranarray(table[:, :3]), table[:, ::2], table.T[:3].T, table[::-1, 3:]):
        value = ph.vector(array)
        assert np.array_equal(value.components, array)
        assert np.array_equal((value * 1).components, array)
        assert np.array_equal(value.norm(), np.sqrt(np.sum(array**2, axis=-1)))
