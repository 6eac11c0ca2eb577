"""Involutions, norms, inverses, powers, projections and Pauli matrices of multivectors."""

import numpy as np
import pytest

import naive
import polhode as ph
from naive import GRADE_SETS, eight_of, magnitude, of_package, ph_value
from polhode import I, e1, e2, e3
from values import EPS, SHAPES, a_value, fraction_of, nonzero, numbers

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


# --- norms


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


def test_norm_of_non_finite_values():
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
def test_normalizing_zero_and_non_finite_values_raises(bad):
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
    # A large first component avoids null elements.
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
def test_functions_of_non_finite_values_name_the_index(name, bad, grades):
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
    assert np.all(A.astype(complex) ** 0 == 1)
    assert np.all(A.map(lambda c: c.astype(int).astype(object)) ** 0 == 1)


def test_negative_powers_use_the_inverse():
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


def test_projection_onto_zero_raises():
    with pytest.raises(ValueError, match="no direction"):
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
def test_from_pauli_rejects_other_arguments(bad):
    with pytest.raises(ValueError, match="from_pauli needs numeric matrices"):
        ph.from_pauli(bad)
