"""Laws of the algebra over all kinds of values, exact because the components are whole."""

import numpy as np
import pytest
from hypothesis import given

import polhode as ph
from naive import GRADE_SETS, eight_of, magnitude, ph_value
from polhode import I
from samples import SHAPES, bivectors, close, same, values, vectors, whole


@given(values, values, values)
def test_products_are_associative(A, B, C):
    assert same((A * B) * C, A * (B * C))
    assert same(A.wedge(B).wedge(C), A.wedge(B.wedge(C)))


@given(values, values, values, whole)
def test_products_are_linear(A, B, C, s):
    for multiply in (
        lambda X, Y: X * Y,
        lambda X, Y: X.wedge(Y),
        lambda X, Y: X.dot(Y),
        lambda X, Y: X.commutator(Y),
        lambda X, Y: X.left_contraction(Y),
        lambda X, Y: X.right_contraction(Y),
        lambda X, Y: X.scalar_product(Y),
    ):
        assert same(multiply(A, B + s * C), multiply(A, B) + s * multiply(A, C))
        assert same(multiply(B + s * C, A), multiply(B, A) + s * multiply(C, A))


@given(values, values, values)
def test_contractions(A, B, C):
    # (A∧B)⌋C = A⌋(B⌋C), A⌋(B⌊C) = (A⌋B)⌊C, and the mirror image by reversion.
    assert same(A.wedge(B).left_contraction(C), A.left_contraction(B.left_contraction(C)))
    assert same(
        A.left_contraction(B.right_contraction(C)),
        A.left_contraction(B).right_contraction(C),
    )
    assert same(~A.left_contraction(B), (~B).right_contraction(~A))


@given(values, values, values)
def test_contraction_is_adjoint_to_the_wedge(A, B, C):
    # ⟨(A∧B) C⟩ = ⟨A (B⌋C)⟩.
    assert same(A.wedge(B).scalar_product(C), A.scalar_product(B.left_contraction(C)))


@given(vectors, values, values)
def test_contraction_with_a_vector_is_a_derivation(a, B, C):
    left = a.left_contraction(B.wedge(C))
    assert same(left, a.left_contraction(B).wedge(C) + B.grade_involution().wedge(a.left_contraction(C)))
    whole_product = a.left_contraction(B * C)
    assert same(whole_product, a.left_contraction(B) * C + B.grade_involution() * a.left_contraction(C))


@given(vectors, values)
def test_vector_times_anything_is_contraction_plus_wedge(a, B):
    assert same(a * B, a.left_contraction(B) + a.wedge(B))
    assert same(B * a, B.right_contraction(a) + B.wedge(a))


@given(values, values)
def test_involutions_of_products(A, B):
    assert same(~(A * B), ~B * ~A)
    assert same((A * B).grade_involution(), A.grade_involution() * B.grade_involution())
    assert same((A * B).clifford_conjugate(), B.clifford_conjugate() * A.clifford_conjugate())
    assert same((~A).grade_involution(), A.clifford_conjugate())
    assert same(~~A, A)


@given(values, values, values)
def test_commutator_is_a_derivation_and_obeys_jacobi(A, B, C):
    # Twice each commutator, so that halves stay whole.
    def bracket(X, Y):
        return 2 * X.commutator(Y)

    assert same(bracket(A, B), A * B - B * A)
    assert same(bracket(A, B * C), bracket(A, B) * C + B * bracket(A, C))
    jacobi = bracket(A, bracket(B, C)) + bracket(B, bracket(C, A)) + bracket(C, bracket(A, B))
    assert same(jacobi, 0)


@given(bivectors, values)
def test_commutator_with_a_bivector_keeps_grades(B, A):
    for k in A.grades:
        part = B.commutator(A.grade(k))
        assert same(part, part.grade(k))


@given(values)
def test_norm_is_positive_and_the_scalar_part(A):
    assert same(A.scalar_product(~A), A.norm_squared())
    assert A.norm_squared() >= 0


@given(vectors, values)
def test_norm_of_a_product_with_a_vector(a, B):
    assert (a * B).norm_squared() == a.norm_squared() * B.norm_squared()


@given(values, bivectors, whole)
def test_norm_of_a_product_with_a_multiple_of_a_rotor(A, B, s):
    R = s + B
    assert (R * A).norm_squared() == R.norm_squared() * A.norm_squared()


@given(vectors, vectors, vectors)
def test_dual_of_a_wedge_is_the_cross_product(a, b, c):
    assert same(a.wedge(b).dual(), ph.cross(a, b))
    # a x (b x c) = b (a·c) − c (a·b); a·(b x c) I = a∧b∧c.
    assert same(ph.cross(a, ph.cross(b, c)), b * a.dot(c) - c * a.dot(b))
    assert same(a.dot(ph.cross(b, c)) * I, a.wedge(b).wedge(c))


@given(values, values)
def test_duality_exchanges_wedge_and_contraction(A, B):
    assert same(A.wedge(B).dual(), A.left_contraction(B.dual()))
    assert same(A.left_contraction(B).undual(), A.wedge(B.undual()))


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("grades", GRADE_SETS)
def test_grades_of_products_lose_no_component(grades, shape):
    rng = np.random.default_rng(1)
    eight = rng.integers(-9, 10, (*shape, 8)).astype(float)
    A = ph_value(eight, grades)
    full = ph.multivector(eight_of(A))
    B = ph.multivector(rng.integers(-9, 10, (*shape, 8)).astype(float))
    for s in GRADE_SETS:
        part = ph_value(eight_of(B), s)
        assert same(A * part, full * ph.multivector(eight_of(part)))
    small, small_full = A / 16, full / 16
    assert close(small.exp(), small_full.exp(), 32, np.exp(magnitude(small)))
