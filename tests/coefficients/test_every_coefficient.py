"""Laws of the algebra over every kind of coefficients; results keep the kind."""

from fractions import Fraction

import numpy as np
import pytest
import sympy
from hypothesis import given

import polhode as ph
from kinds import EXACT, ROUNDING, VARIANTS_SLOW, Kind, halves, kinds
from naive import GRADE_SETS
from polhode import I, e1, e2, e3
from polhode import strategies as ga

kind = kinds()
FLOATS = Kind("float64")


def vector(A):
    return A.grade(1)


def plane(A):
    return A.grade(2)


# Each returns two sides that are equal for all multivectors A, B, C; J is I in their precision.
POLYNOMIAL = {
    "the product is associative": lambda A, B, C, J: (A * (B * C), (A * B) * C),
    "and distributes from the left": lambda A, B, C, J: (A * (B + C), A * B + A * C),
    "and from the right": lambda A, B, C, J: ((A - B) * C, A * C - B * C),
    "wedge is associative": lambda A, B, C, J: (A.wedge(B.wedge(C)), A.wedge(B).wedge(C)),
    "vee is associative": lambda A, B, C, J: (A.vee(B.vee(C)), A.vee(B).vee(C)),
    "numbers commute": lambda A, B, C, J: (A * 3 * B, 3 * (A * B)),
    "reverse of a product": lambda A, B, C, J: (~(A * B), ~B * ~A),
    "reverse twice": lambda A, B, C, J: (~~A, A),
    "grade involution of a product": lambda A, B, C, J: (
        (A * B).grade_involution(),
        A.grade_involution() * B.grade_involution(),
    ),
    "Clifford conjugate": lambda A, B, C, J: (A.clifford_conjugate(), (~A).grade_involution()),
    "sum of the grades": lambda A, B, C, J: (A.grade(0) + A.grade(1) + A.grade(2) + A.grade(3), A),
    "commutator": lambda A, B, C, J: (2 * A.commutator(B), A * B - B * A),
    "commutator as a derivation": lambda A, B, C, J: (
        A.commutator(B * C),
        A.commutator(B) * C + B * A.commutator(C),
    ),
    "Jacobi": lambda A, B, C, J: (
        A.commutator(B.commutator(C)) + B.commutator(C.commutator(A)),
        -C.commutator(A.commutator(B)),
    ),
    "scalar product": lambda A, B, C, J: (A.scalar_product(B), (A * B).grade(0)),
    "scalar product commutes": lambda A, B, C, J: (A.scalar_product(B), B.scalar_product(A)),
    "norm squared": lambda A, B, C, J: (
        0 * A.grade(0) + A.norm_squared(),
        A.scalar_product(~A),
    ),
    "contraction of a wedge": lambda A, B, C, J: (
        A.wedge(B).left_contraction(C),
        A.left_contraction(B.left_contraction(C)),
    ),
    "contractions from both sides": lambda A, B, C, J: (
        A.left_contraction(B).right_contraction(C),
        A.left_contraction(B.right_contraction(C)),
    ),
    "contractions reversed": lambda A, B, C, J: (~A.left_contraction(B), (~B).right_contraction(~A)),
    "wedge and contraction are dual": lambda A, B, C, J: (A.wedge(B).dual(), A.left_contraction(B.dual())),
    "dual and undual": lambda A, B, C, J: (A.dual().undual(), A),
    "complements": lambda A, B, C, J: (A.left_complement().right_complement(), A),
    "complement of vee": lambda A, B, C, J: (
        A.vee(B).right_complement(),
        A.right_complement().wedge(B.right_complement()),
    ),
    "square and cube": lambda A, B, C, J: (A**2 * A, A**3),
    "vector into a product": lambda A, B, C, J: (
        vector(A).left_contraction(B * C),
        vector(A).left_contraction(B) * C + B.grade_involution() * vector(A).left_contraction(C),
    ),
    "vector times anything": lambda A, B, C, J: (
        vector(A) * B,
        vector(A).left_contraction(B) + vector(A).wedge(B),
    ),
    "eq 1.13": lambda A, B, C, J: (2 * vector(A).dot(plane(B)), vector(A) * plane(B) - plane(B) * vector(A)),
    "eq 1.21": lambda A, B, C, J: (A * J, J * A),
    "eq 1.24": lambda A, B, C, J: (ph.cross(vector(A), vector(B)), -J * vector(A).wedge(vector(B))),
    "Lagrange": lambda A, B, C, J: (
        vector(A).wedge(vector(B)).dot(plane(C)),
        vector(A).dot(vector(B).dot(plane(C))),
    ),
    "difference": lambda A, B, C, J: (A - (A - B), B),
    "minus": lambda A, B, C, J: (-A, 0 - A),
    "halves": lambda A, B, C, J: (A / 2 + A / 2, A),
}


@pytest.mark.parametrize("kind", VARIANTS_SLOW, indirect=True)
@pytest.mark.parametrize("law", POLYNOMIAL)
@pytest.mark.parametrize("shapes", [((), (), ()), ((2, 1), (3,), ())], ids=["single", "batches"])
def test_polynomial_law(kind, law, shapes):
    values = [kind.random(seed, shape) for seed, shape in enumerate(shapes)]
    left, right = kind.evaluate(POLYNOMIAL[law], *values, kind.own(I))
    assert kind.equal(left, right)
    assert kind.holds(left)
    assert kind.holds(right)


OPERATIONS = {
    "negative": lambda A, u: -A,
    "reverse": lambda A, u: ~A,
    "grade_involution": lambda A, u: A.grade_involution(),
    "clifford_conjugate": lambda A, u: A.clifford_conjugate(),
    "grade": lambda A, u: A.grade(1),
    "dual": lambda A, u: A.dual(),
    "undual": lambda A, u: A.undual(),
    "complement": lambda A, u: A.right_complement(),
    "square": lambda A, u: A * A,
    "wedge": lambda A, u: A.wedge(u),
    "times a basis vector": lambda A, u: A * u,
    "basis vector times": lambda A, u: u * A,
    "plus one": lambda A, u: A + 1,
    "one minus": lambda A, u: 1 - A,
    "twice": lambda A, u: 2 * A,
    "half": lambda A, u: A / 2,
    "zeroth power": lambda A, u: A**0,
    "scalar product": lambda A, u: A.scalar_product(A),
    "of a batch": lambda A, u: ph.stack([A, A])[1],
    "joined": lambda A, u: ph.concatenate([A[None], A[None]]),
    "indexed": lambda A, u: A[None, ..., None][0],
    "reshaped": lambda A, u: A.reshape(1, -1),
}


@pytest.mark.parametrize("kind", VARIANTS_SLOW, indirect=True)
@pytest.mark.parametrize("grades", [(1,), (0, 2), (0, 1, 2, 3)], ids=str)
@pytest.mark.parametrize("name", OPERATIONS)
def test_results_keep_the_kind_and_the_grades_of_floats(kind, name, grades):
    numbers = halves((8,), 7)
    result = kind.evaluate(OPERATIONS[name], kind.value(numbers, grades), kind.own(e2))
    assert type(result) is ph.Multivector
    assert kind.holds(result)
    floats = OPERATIONS[name](FLOATS.value(numbers, grades), e2)
    assert result.grades == floats.grades
    assert result.shape == floats.shape


@pytest.mark.parametrize("grades", GRADE_SETS, ids=str)
def test_products_are_those_of_floats(kind, grades):
    """Numbers that all kinds hold exactly; products of floats are compared with the oracle elsewhere."""
    numbers = [halves((8,), seed) for seed in (8, 9)]
    if kind.name == "sympy":
        pytest.skip("symbols have no numbers")
    A, B = (kind.value(n, grades) for n in numbers)
    a, b = (FLOATS.value(np.array(kind.floats(kind.array(n))), grades) for n in numbers)
    for name in ("geometric_product", "wedge", "dot", "left_contraction", "right_contraction", "commutator"):
        got, expected = getattr(A, name)(B), getattr(a, name)(b)
        assert got.grades == expected.grades
        # Thirds are rounded in floats: a few roundings of sums of 8 products below 81.
        assert np.allclose(kind.floats(got.components), expected.components, rtol=0, atol=1e-12)


# --- inverses


@pytest.mark.parametrize("kind", EXACT, indirect=True)
@pytest.mark.parametrize("grades", GRADE_SETS, ids=str)
def test_exact_inverses_are_exact(kind, grades):
    A = kind.random(3, (2,), grades)
    inverse = A.inverse()
    assert kind.equal(A * inverse, 1)
    assert kind.equal(inverse * A, 1)
    assert kind.holds(inverse) or kind.name == "int"
    assert kind.equal(A / A, 1)
    assert kind.equal(A**-2 * A**2, 1)


@pytest.mark.parametrize("grades", [(1,), (2,), (3,), (0, 2), (0, 1), (1, 3)], ids=str)
def test_inverses_of_symbols_are_exact(grades):
    symbols = np.array(sympy.symbols("a:8", real=True), dtype=object)
    place = {0: [0], 1: [1, 2, 3], 2: [4, 5, 6], 3: [7]}
    A = ph.multivector(
        [symbols[i] if any(i in place[k] for k in grades) else sympy.Integer(0) for i in range(8)]
    )
    A = sum((A.grade(k) for k in grades), ph.scalar(0))
    assert (A * A.inverse()).map(sympy.simplify) == 1


@pytest.mark.slow
@pytest.mark.parametrize("kind", [*ROUNDING, "mpmath"], indirect=True)
@pytest.mark.parametrize("grades", GRADE_SETS, ids=str)
def test_inverses_to_rounding(kind, grades):
    A = kind.random(3, (4,), grades)
    inverse = kind.evaluate(lambda A: A.inverse(), A)
    assert kind.holds(inverse)
    condition = np.linalg.norm(kind.floats(A.components), axis=-1) * np.linalg.norm(
        kind.floats(inverse.components), axis=-1
    )
    # Its determinant sums about 16 products; its relative error is that times the condition, twice.
    assert np.all(
        np.linalg.norm(kind.floats((A * inverse - 1).components), axis=-1) <= 32 * kind.eps * condition**2
    )


@pytest.mark.parametrize("kind", [k for k in (*ROUNDING, *EXACT) if k != "jax-jit"], indirect=True)
def test_singular_values_have_no_inverse(kind):
    numbers = np.zeros((3, 8), dtype=int)
    numbers[:, 0] = 2
    numbers[1, 1] = 2
    A = kind.value(np.frompyfunc(lambda n: halves((), 1) * 0 + n, 1, 1)(numbers))
    with pytest.raises(ValueError, match=r"index (\(1,\)|\(1\))?.*(singular|no inverse)"):
        A.inverse()


# --- rotors, exp and log


@pytest.mark.slow
@pytest.mark.parametrize("kind", [*ROUNDING, "mpmath"], indirect=True)
def test_exp_and_log_of_bivectors(kind):
    B = kind.random(4, (5,), (2,)) / 8  # |B| < π, the range of log
    R = kind.evaluate(lambda B: B.exp(), B)
    assert type(R) is ph.Rotor
    assert kind.holds(R)
    assert kind.near(R * ~R, 1)
    log = kind.evaluate(lambda R: R.log(), R)
    assert kind.holds(log)
    assert kind.near(log, B, 16, 2)
    series = sum((B**k / float(np.prod(np.arange(1.0, k + 1))) for k in range(1, 30)), ph.scalar(1))
    assert kind.near(R, series, 32, np.e)


@pytest.mark.slow
@pytest.mark.parametrize("kind", [*ROUNDING, "mpmath"], indirect=True)
def test_a_rotor_acts_as_its_two_sided_product(kind):
    B, X = kind.random(5, (4, 1), (2,)), kind.random(6, (3,))
    R = (B / 8).exp()
    size = 9 * 8**0.5
    assert kind.near(kind.evaluate(lambda R, X: R(X), R, X), R * X * ~R, 32, size)
    assert kind.holds(R(X))
    for single in (kind.own(e1), kind.own(I), X.grade(2)):
        assert kind.holds(R(single))
    S = (kind.random(7, (3,), (2,)) / 4).exp()
    both = kind.evaluate(lambda R, S: S * R, R, S)
    assert type(both) is ph.Rotor
    assert kind.holds(both)
    assert kind.near(both(X), S(R(X)), 64, size)
    assert kind.near(both * ~both, 1)
    assert kind.near(R(X * X), R(X) * R(X), 128, size**2)


@pytest.mark.parametrize("kind", ["fraction", "int", "sympy-numbers"], indirect=True)
def test_rational_rotors_are_exact(kind):
    """Quadruples of whole numbers whose squares add up to a square: 1² + 2² + 2² + 4² = 5²."""
    rows = np.frompyfunc(lambda n: halves((), 1) * 0 + n, 1, 1)(
        np.array([[1, 2, 2, 4], [2, 4, 5, 6], [4, 2, 2, 1], [-1, 1, 1, -1]])
    )
    c = kind.array(rows)
    R = ph.Rotor.from_components(c)
    X = kind.random(8, (4,))
    assert kind.equal(R * ~R, 1)
    assert kind.equal(R(X), R * X * ~R)
    assert kind.equal((R * R)(X), R(R(X)))
    assert kind.equal(~R, R.inverse())
    S = ph.Rotor.from_matrix(R.to_matrix())
    assert kind.equal(S(X), R(X))
    for order in ("wxyz", "xyzw"):
        assert kind.equal(ph.Rotor.from_quaternion(R.to_quaternion(order=order), order=order), R)
    assert kind.equal(R**3, R * R * R)
    assert kind.equal(R**-2, ~R * ~R)
    assert kind.equal(R**0, 1)
    for value in (R, R(X), R * R, S, R**3, ~R, R**-1):
        assert all(not isinstance(x, float) for x in value.components.flat)


@pytest.mark.parametrize("kind", [*ROUNDING, "mpmath"], indirect=True)
def test_converters_of_rotors(kind):
    R = (kind.random(9, (2, 3), (2,)) / 8).exp()
    matrix = kind.evaluate(lambda R: R.to_matrix(), R)
    assert tuple(matrix.shape) == (2, 3, 3, 3)
    assert kind.is_own(matrix)
    again = kind.evaluate(ph.Rotor.from_matrix, matrix)
    assert type(again) is ph.Rotor
    assert kind.holds(again)
    assert kind.near(again(e1 + e2 * 2), R(e1 + e2 * 2), 64)
    for order in ("wxyz", "xyzw"):
        q = R.to_quaternion(order=order)
        assert kind.is_own(q)
        assert kind.near(ph.Rotor.from_quaternion(q, order=order), R, 4)
    assert kind.near(ph.Rotor.from_rotation_vector(R.to_rotation_vector())(e3), R(e3), 32)
    plane, angle = R.plane_angle()
    assert kind.holds(plane)
    assert kind.near(ph.Rotor.from_plane_angle(plane, angle), R, 32)
    assert kind.near(
        ph.Rotor.from_vectors(kind.random(1, (), (1,)), e1)(kind.random(1, (), (1,))).wedge(e1), 0, 32, 16
    )


def test_a_symbolic_rotor_satisfies_rodrigues_formula():
    theta = sympy.Symbol("theta", real=True)
    R = ph.Rotor.from_plane_angle(e1.wedge(e2), theta)
    assert (R * ~R).map(sympy.simplify) == 1
    assert R(e1).map(sympy.simplify) == sympy.cos(theta) * e1 + sympy.sin(theta) * e2
    assert R(e3).map(sympy.simplify) == e3
    assert (R(e1) - R * e1 * ~R).map(sympy.simplify) == 0
    quarter = ph.Rotor.from_plane_angle(e1.wedge(e2), sympy.pi / 2)
    assert quarter(e1) == e2
    assert (R**2 - R * R).map(sympy.simplify) == 0


def test_functions_of_the_kind(kind):
    """Norms and unit values: numbers of the kind for single values, of its arrays for batches."""
    for shape in ((), (3,)):
        A = kind.random(11, shape, (1, 2))
        size, square = A.norm(), A.norm_squared()
        if kind.name.startswith(("jax", "array")):
            assert kind.is_own(size)
            assert tuple(size.shape) == shape
        else:
            assert isinstance(size, np.ndarray) == bool(shape)
            assert isinstance(square, np.ndarray) == bool(shape)
        if kind.name not in ("sympy", "sympy-numbers"):
            assert np.allclose(kind.floats(size) ** 2, kind.floats(square), rtol=8 * kind.eps, atol=0)
            assert kind.near(A.normalized() * ph.scalar(size), A, 8, 40)
        if kind.name not in ("int", "fraction"):
            assert kind.holds(A.normalized())
            assert kind.holds(0 * A + square)
            assert kind.holds(0 * A + size)


def test_comparison(kind):
    A = kind.random(12, (2, 3))
    same = A == A
    assert np.asarray(same).dtype == bool
    assert np.asarray(same).shape == (2, 3)
    assert np.all(np.asarray(same))
    assert not np.any(np.asarray(A != A))
    assert not np.any(np.asarray(A + 1 == A))
    assert not np.any(np.asarray(kind.own(e1) == A))
    if kind.name != "sympy":
        assert np.all(np.asarray(A.is_close(A, rtol=0)))
        assert np.all(np.asarray(A.is_close(A * (1 + 4 * kind.eps), rtol=8 * kind.eps)))
        assert not np.any(np.asarray(A.is_close(2 * A)))


def test_text(kind):
    zero = kind.value(halves((8,), 1) * 0)
    assert repr(zero) == "0"
    assert repr(zero + 1 + 2 * e1).startswith("1")
    assert "e1" in repr(kind.random(1))
    batch = repr(kind.random(1, (9,)))
    assert batch.startswith("Multivector of shape (9,):")
    assert "…" in batch


def test_indexing_matches_numpy(kind):
    numbers = halves((2, 3, 8), 13)
    A = kind.value(numbers)
    for index in (0, -1, (1, 2), slice(1, None), (..., 0), (None, 1), (slice(None), slice(0, 3, 2)), ()):
        parts = index if isinstance(index, tuple) else (index,)
        rest = () if Ellipsis in parts else (Ellipsis,)
        expected = kind.value(numbers[(*parts, *rest, slice(None))])
        picked = A[index]
        assert picked.shape == expected.shape
        assert kind.holds(picked)
        assert kind.equal(picked, expected)
    assert [row.shape for row in A] == [(3,), (3,)]
    for index in (2, -3, (0, 3), (0, 0, 0), (slice(None), 7)):
        with pytest.raises(IndexError, match=r"batch shape \(2, 3\)"):
            A[index]


def test_batches_that_do_not_broadcast_are_errors(kind):
    A, B = kind.random(1, (2,)), kind.random(2, (3,))
    for operate in (lambda: A * B, lambda: A + B, lambda: A.wedge(B), lambda: A == B):
        with pytest.raises(
            ValueError, match=r"batch shapes \(2,\) and \(3,\) do not broadcast: .* A\[:, None\]"
        ):
            operate()
    assert (A[:, None] * B).shape == (2, 3)


@pytest.mark.parametrize("shape", [(0,), (2, 0)])
def test_empty_batches(kind, shape):
    A, B = kind.random(1, shape), kind.random(2)
    for name in ("__mul__", "wedge", "__add__", "__sub__", "scalar_product", "vee"):
        result = getattr(A, name)(B)
        assert result.shape == shape
        assert kind.holds(result)
    assert A.grade(2).exp().shape == shape
    assert A.grade(1).inverse().shape == shape
    assert tuple(np.shape(A.norm())) == shape


@pytest.mark.parametrize("kind", ["jax", "array-api-strict"], indirect=True)
@pytest.mark.parametrize("exact", [Fraction(1, 3), sympy.Rational(1, 3), sympy.Symbol("x")], ids=str)
def test_exact_numbers_and_other_libraries_do_not_mix(kind, exact):
    A, B = kind.random(1), ph.scalar(exact)
    for operate in (lambda: A * B, lambda: B + A, lambda: A == B, lambda: ph.stack([A, B])):
        with pytest.raises(TypeError, match="do not mix"):
            operate()


@pytest.mark.parametrize("kind", ["jax", "array-api-strict"], indirect=True)
def test_large_whole_numbers_are_rounded_beside_floats(kind):
    a = ph.vector(kind.array([1.0, 2.0, 3.0]))
    for number in (10**20, -(2**53) - 1, np.array(2**53 + 1)):
        for product in (number * a, a * number):
            assert np.all(np.asarray(product.components) == np.asarray((float(number) * a).components))
    with pytest.raises(ValueError, match="beyond the range of float64"):
        10**400 * a


@pytest.mark.parametrize("kind", ROUNDING, indirect=True)
def test_is_close_at_the_ends_of_the_range(kind):
    A = kind.random(14, (2,))
    for size in (2.0**100, 2.0**-100):  # their squares are beyond the range of single precision
        large = A * size
        assert np.all(np.asarray(large.is_close(large * (1 + 4 * kind.eps), rtol=8 * kind.eps)))
        assert not np.any(np.asarray(large.is_close(1.01 * large, rtol=1e-3)))
        assert not np.any(np.asarray(large.is_close(-large)))
    assert np.all(np.asarray((A * 2.0**-120).is_close(0 * A, atol=1e-6)))
    infinite = A * float("inf")
    assert not np.any(np.asarray(infinite.is_close(A)))
    assert not np.any(np.asarray((A * float("nan")).is_close(A, atol=float("inf"))))


def exactly(A):
    """The same value with fractions for coefficients: floats are dyadic fractions."""
    return ph.Multivector._of(np.frompyfunc(Fraction, 1, 1)(A.components), A._mask, A.algebra)


@pytest.mark.parametrize("name", ["geometric_product", "wedge", "dot", "commutator", "left_contraction"])
@given(A=ga.multivectors(shape=(2,)), B=ga.multivectors())
def test_products_of_floats_are_the_exact_ones_rounded(name, A, B):
    got, exact = getattr(A, name)(B), getattr(exactly(A), name)(exactly(B))
    assert got.grades == exact.grades
    # Each of at most 8 terms is rounded in its product and in 7 sums; a commutator has them twice.
    bound = 16 * 2.0**-53 * np.prod([np.abs(M.components).sum(axis=-1).max() for M in (A, B)])
    assert np.abs((exactly(got) - exact).components.astype(float)).max() <= bound


@given(R=ga.rotors(near_singular=True), a=ga.vectors())
def test_turns_of_floats_are_the_exact_ones_rounded(R, a):
    exact = exactly(R)
    turned = exact * exactly(a) * ~exact
    assert turned.grade(3) == 0
    # The rotor's norm may be off by a rounding, and R a ~R sums 4 terms twice.
    bound = 16 * 2.0**-53 * a.norm()
    assert np.linalg.norm((exactly(R(a)) - turned.grade(1)).components.astype(float)) <= bound
