"""Sections 1 and 2 of the handout over floats, fractions, symbols, multiprecision numbers and JAX arrays.

The equations of `test_handout_algebra` and `test_handout_rotations`, which use floats.
"""

from fractions import Fraction
from itertools import permutations, product

import numpy as np
import pytest
import sympy

import polhode as ph
from kinds import halves, kinds

pytestmark = pytest.mark.slow  # the same laws as in other files, over more algebras and coefficients

kind = kinds("float64", "float32", "int", "fraction", "sympy", "mpmath", "jax", "jax-jit", "array-api-strict")
TURNING = ("float64", "float32", "mpmath", "jax", "jax-jit", "array-api-strict")
turning = pytest.mark.parametrize("kind", TURNING, indirect=True)


@pytest.fixture
def basis(kind):
    """e1, e2, e3 with coefficients of the kind; SymPy numbers for symbols."""
    rows = np.frompyfunc(lambda x: Fraction(int(x)), 1, 1)(np.eye(3, dtype=int))
    if kind.name == "int":
        rows = rows / 2  # that kind doubles
    if kind.name == "fraction":
        rows = rows * 3  # and that one takes thirds
    return [ph.vector(kind.array(row)) for row in rows]


@pytest.fixture
def vectors(kind):
    return [kind.random(seed, (4,), (1,)) for seed in (1, 2, 3)]


@pytest.fixture
def planes(kind):
    return [kind.random(seed, (4,), (2,)) for seed in (4, 5)]


@pytest.fixture
def holds(kind):
    """Check that both sides of an equation, functions of the values, are equal and of the kind."""

    def check(equation, *values):
        left, right = kind.evaluate(equation, *values)
        assert kind.equal(left, right)
        assert kind.holds(left)

    return check


def epsilon(i, j, k):
    return (i - j) * (j - k) * (k - i) // 2


# --- 1, the algebra


def test_eq_1_1_bivector_times_vector_is_the_volume(holds, basis):
    holds(lambda a, b, c: (a.wedge(b) * c, a * b * c), *basis)


def test_eq_1_2_and_1_3_wedges_of_vectors(holds, vectors):
    holds(lambda a, b, c: (a.wedge(b).wedge(c), a.wedge(b.wedge(c))), *vectors)
    holds(lambda a, b, c: (a.wedge(b).wedge(c), -b.wedge(a).wedge(c)), *vectors)
    holds(lambda a, b, c: (a.wedge(b).wedge(c), c.wedge(a).wedge(b)), *vectors)


def test_eq_1_5_basis_bivectors_square_to_minus_one(holds, basis):
    for a, b in permutations(basis, 2):
        holds(lambda a, b: ((a * b) ** 2, -(a * a)), a, b)


def test_eq_1_6_unit_bivector_turns_vectors_in_its_plane(holds, basis):
    for a, b in permutations(basis, 2):
        holds(lambda a, b: (a * a.wedge(b), b), a, b)


@pytest.mark.parametrize("kind", ["int", "fraction", "sympy-numbers"], indirect=True)
def test_eq_1_7_to_1_9_parallel_and_perpendicular_parts(kind, vectors, planes):
    """Exact, as the plane's inverse is."""
    for a, plane in product(vectors, planes):
        parallel, perpendicular = a.project(plane), a.reject(plane)
        assert kind.equal(parallel + perpendicular, a)
        assert kind.equal(parallel.wedge(plane), 0)
        assert kind.equal(perpendicular.dot(plane), 0)
        b = parallel.dot(plane) / parallel.norm_squared()  # plane = a∥∧b, b ⟂ a∥
        assert kind.equal(parallel.wedge(b), plane)
        assert kind.equal(parallel * plane, parallel**2 * b)
        assert kind.equal(perpendicular * plane, perpendicular.wedge(parallel).wedge(b))


def test_eq_1_10_to_1_13_vector_and_bivector(holds, vectors, planes):
    a, B = vectors[0], planes[0]
    holds(lambda a, B: (a * B, a.dot(B) + a.wedge(B)), a, B)
    holds(lambda a, B: (a.dot(B), -B.dot(a)), a, B)
    holds(lambda a, B: (a.wedge(B), B.wedge(a)), a, B)
    holds(lambda a, B: (2 * a.dot(B), a * B - B * a), a, B)
    holds(lambda a, B: (2 * a.wedge(B), a * B + B * a), a, B)


@pytest.mark.parametrize(("r", "s"), list(product(range(4), repeat=2)))
def test_eq_1_10_dot_is_the_lowest_grade_wedge_the_highest(holds, kind, r, s):
    A, B = kind.random(7, (), (r,)), kind.random(8, (), (s,))
    holds(lambda A, B: (A.dot(B), (A * B).grade(abs(r - s))), A, B)
    if r + s <= 3:
        holds(lambda A, B: (A.wedge(B), (A * B).grade(r + s)), A, B)
    else:
        holds(lambda A, B: (A.wedge(B), 0 * (A * B)), A, B)


def test_eq_1_14_to_1_17_products_of_planes(holds, basis):
    e1, e2, e3 = basis
    holds(lambda a, b, c: (a.wedge(b) * b.wedge(c), a * c), e1, e2, e3)
    holds(lambda a, b, c: (b.wedge(c) * a.wedge(b), -(a * c)), e1, e2, e3)
    B = [e2 * e3, e3 * e1, e1 * e2]
    for i, j in product(range(3), repeat=2):
        k = 3 - i - j if i != j else 0
        factor = -2 * epsilon(i, j, k) if i != j else 0
        holds(lambda a, b, c, f=factor: (a * b - b * a, f * c), B[i], B[j], B[k])


def test_quaternions_are_minus_the_basis_bivectors(holds, basis):
    e1, e2, e3 = basis
    i, j, k = -(e2 * e3), -(e3 * e1), -(e1 * e2)
    holds(lambda i, j, k: (i * j, k), i, j, k)
    holds(lambda i, j, k: (i * j * k, i * i), i, j, k)
    holds(lambda i, j, k: (k * k, j * j), i, j, k)


def test_eq_1_18_to_1_23_the_pseudoscalar(holds, kind, basis):
    e1, e2, e3 = basis
    M = kind.random(9)
    holds(lambda a, b, c: ((a * b * c) ** 2, -(a**2)), e1, e2, e3)
    holds(lambda a, b, c: (a * (a * b * c), b * c), e1, e2, e3)
    holds(lambda a, b, c: ((a * b * c) * c, a * b), e1, e2, e3)
    holds(lambda a, b, c: ((a * b * c) * a.wedge(b), -c), e1, e2, e3)
    holds(lambda M, a, b, c: (M * (a * b * c), (a * b * c) * M), M, e1, e2, e3)
    holds(lambda M, a, b, c: (M.undual(), M * (a * b * c)), M, e1, e2, e3)
    holds(lambda M, a, b, c: (M.grade(1).dot(a * b * c), M.grade(1) * (a * b * c)), M, e1, e2, e3)


def test_eq_1_24_cross_product(holds, vectors, basis):
    a, b, _ = vectors
    holds(lambda a, b, e1, e2, e3: (ph.cross(a, b), -(e1 * e2 * e3) * a.wedge(b)), a, b, *basis)
    holds(lambda a, b, e1, e2, e3: (ph.cross(a, b), a.wedge(b).dual()), a, b, *basis)


def test_eq_1_25_to_1_28_reverse(holds, kind, vectors):
    holds(lambda a, b, c: (~(a * b * c), c * b * a), *vectors)
    M, N = kind.random(10), kind.random(11)
    holds(lambda M: (~M, M.grade(0) + M.grade(1) - M.grade(2) - M.grade(3)), M)
    holds(lambda M, N: (~(M * N), ~N * ~M), M, N)


def test_eq_1_29_pauli_algebra(holds, basis):
    e1, e2, e3 = basis
    for i, j in product(range(3), repeat=2):
        if i == j:
            holds(lambda a, b: (a * a, b * b), basis[i], basis[(i + 1) % 3])
        else:
            k = 3 - i - j
            sign = epsilon(i, j, k)
            holds(
                lambda a, b, c, e1, e2, e3, s=sign: (a * b, s * (e1 * e2 * e3 * c)),
                *(basis[i], basis[j], basis[k], e1, e2, e3),
            )


@pytest.mark.parametrize("kind", ["float64", "float32", "int", "jax", "array-api-strict"], indirect=True)
def test_eq_1_29_pauli_matrices(kind):
    M, N = kind.random(12), kind.random(13)
    assert np.array_equal(ph.to_pauli(M * N), ph.to_pauli(M) @ ph.to_pauli(N))
    assert np.array_equal(kind.floats(M.components), ph.from_pauli(ph.to_pauli(M)).components)


# --- 2, rotations. Angles and planes of the kind; a result of two products of four terms: 16 roundings.

ANGLES = [Fraction(0), Fraction(1, 10**9), Fraction(3, 10), Fraction(5, 2), Fraction(4), Fraction(-17, 10)]


def rotor(kind, plane, angle):
    return kind.evaluate(lambda B: (B * (-float(angle) / 2)).exp(), plane)


@turning
@pytest.mark.parametrize("angle", ANGLES)
def test_eq_2_1_to_2_3_one_and_two_sided(kind, basis, angle):
    e1, e2, e3 = basis
    R = rotor(kind, e1.wedge(e2), angle)
    one_sided = rotor(kind, e1.wedge(e2), 2 * angle)
    a = 3 * e1 - 4 * e2
    assert kind.near(one_sided * a, a * ~one_sided, 16, 5)
    assert kind.near(one_sided * a, R * a * ~R, 16, 5)
    assert kind.near(one_sided * e3, e3 * one_sided)
    assert kind.near(R * e3 * ~R, e3)
    assert kind.holds(R * a * ~R)


@turning
@pytest.mark.parametrize("angle", ANGLES)
def test_eq_2_4_turns_by_the_angle_in_the_sense_of_the_plane(kind, basis, angle):
    e1, e2, _ = basis
    R = rotor(kind, e1.wedge(e2), angle)
    assert type(R) is ph.Rotor
    c, s = float(np.cos(float(angle))), float(np.sin(float(angle)))
    assert kind.near(R(e1), c * e1 + s * e2)
    assert kind.near(R(e2), c * e2 - s * e1)
    assert kind.holds(R(e1))


@turning
def test_eq_2_5_and_2_6_rotors_are_unit_and_turn_everything(kind):
    R = rotor(kind, kind.random(14, (5,), (2,)) / 4, Fraction(1))
    M, N = kind.random(15, (5,)), kind.random(16, (5,))
    assert R.grades == (0, 2)
    assert kind.near(R * ~R, 1)
    assert kind.near(~R * R, 1)
    size = 9.0 * 8**0.5
    assert kind.near(R(M), R * M * ~R, 32, size)
    assert kind.near(R(M * N), R(M) * R(N), 128, size**2)
    assert kind.near(R(M.grade(1).wedge(N.grade(1))), R(M.grade(1)).wedge(R(N.grade(1))), 64, size**2)


@pytest.mark.parametrize("kind", ["fraction", "sympy-numbers"], indirect=True)
def test_eq_2_4_to_2_6_with_rational_rotors(kind):
    """From two reflections, ``R = b a/(|a| |b|)``, exact where the lengths are whole."""
    a, b = ph.vector([Fraction(1), 2, 2]), ph.vector([Fraction(2), 3, 6])
    R = ph.Rotor.from_components((b * a).components)
    M, N = kind.random(17), kind.random(18)
    assert R * ~R == 1
    assert kind.equal(R(M), R * M * ~R)
    assert kind.equal(R(M * N), R(M) * R(N))
    # Twice the angle from a to b: â goes to its reflection in b̂.
    assert R(a / 3) == b * a * b / (49 * 3)


def test_eq_2_1_to_2_6_with_symbols():
    theta = sympy.Symbol("theta", real=True)
    x = sympy.symbols("x1:4", real=True)
    e1, e2, e3 = ph.e1, ph.e2, ph.e3
    R = ((e1 ^ e2) * (-theta / 2)).exp()
    assert type(R) is ph.Rotor
    assert (R * ~R).map(sympy.simplify) == 1
    a = ph.vector(x)
    c, s = sympy.cos(theta), sympy.sin(theta)
    expected = ph.vector([c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]])
    assert (R(a) - expected).map(sympy.simplify) == 0
    assert (R * a * ~R - expected).map(sympy.simplify) == 0
    one_sided = ((e1 ^ e2) * -theta).exp()
    in_plane = ph.vector([x[0], x[1], sympy.Integer(0)])
    assert (one_sided * in_plane - in_plane * ~one_sided).map(sympy.simplify) == 0
    assert (one_sided * e3 - e3 * one_sided).map(sympy.simplify) == 0
    b = ph.vector(sympy.symbols("y1:4", real=True))
    assert (R(a ^ b) - (R(a) ^ R(b))).map(sympy.simplify) == 0


def test_eq_4_10_the_derivative_of_a_rotor_with_jax():
    """``R' = −½ Ω R`` for ``R = exp(−Ω t/2)``, by automatic differentiation."""
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        jnp = jax.numpy
        omega = ph.bivector(jnp.asarray([0.3, -0.4, 1.2]))
        rate = jax.jacfwd(lambda t: (omega * (-t / 2)).exp().components)(0.7)
        R = (omega * -0.35).exp()
        assert np.allclose(rate, (-0.5 * omega * R).components, rtol=0, atol=8 * 2.0**-52)


def test_halves_are_exact_in_all_kinds():
    assert set(np.unique(2 * halves((1000,), 1))) == {*range(-9, 0), *range(1, 10)}
