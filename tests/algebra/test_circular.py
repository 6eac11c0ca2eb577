"""Circular and hyperbolic functions of values, the outer exponential, and means of batches."""

import math
from fractions import Fraction

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import scipy.linalg
import sympy

import polhode as ph
from polhode import I, e1, e2
from values import EPS

NAMES = ["sin", "cos", "tan", "sinh", "cosh", "tanh"]
SIGNATURES = [(2,), (3,), (4,), (1, 3), (3, 0, 1), (4, 1), (0, 3)]
GRADES = [(1,), (2,), (0, 1), (0, 2), (1, 2), None]


def some(signature, grades, scale, shape=(), seed=50):
    A = ph.algebra(*signature)
    M = A.multivector(scale * np.random.default_rng(seed).normal(size=(*shape, A.size)) / A.size**0.5)
    return M if grades is None else M.grade(*grades)


def matrix_of(X):
    """The matrix of multiplication by X from the left, whose first column is X."""
    return np.stack([(X * b).dense() for b in X.algebra.blades.values()], axis=-1)


@pytest.mark.parametrize("signature", SIGNATURES)
@pytest.mark.parametrize("grades", GRADES)
def test_functions_are_those_of_the_matrices(signature, grades):
    for scale in (0.3, 3.0, 20.0):
        X = some(signature, grades, scale)
        L = matrix_of(X)
        for name, peer in (
            ("sin", scipy.linalg.sinm),
            ("cos", scipy.linalg.cosm),
            ("sinh", scipy.linalg.sinhm),
            ("cosh", scipy.linalg.coshm),
        ):
            expected = peer(L)[:, 0]
            # SciPy's exponential squares six times and cancels: its results err by some 200 EPS.
            bound = 400 * EPS * (1 + scale) * np.abs(peer(L)).max()
            assert np.abs(getattr(X, name)().dense() - expected).max() <= bound, (name, scale)


@pytest.mark.parametrize("signature", SIGNATURES)
@pytest.mark.parametrize("grades", GRADES)
def test_near_zero_no_digits_are_lost(signature, grades):
    # The next terms are below 1e-27 of the first.
    X = some(signature, grades, 1e-14)
    for name in ("sin", "tan", "sinh", "tanh"):
        assert getattr(X, name)().is_close(X, rtol=8 * EPS), name
    for name, sign in (("cos", -1), ("cosh", 1)):
        assert (getattr(X, name)() - 1).is_close(sign * X * X / 2, atol=EPS), name
    zero = 0 * X
    assert zero.sin() == zero.tanh() == 0
    assert zero.cos() == zero.cosh() == 1


@pytest.mark.parametrize("signature", SIGNATURES)
def test_identities(signature):
    X = some(signature, None, 1.0, (7,))
    assert np.all((X.cosh() + X.sinh()).is_close(X.exp(), rtol=200 * EPS))
    assert np.all((X.cos() ** 2 + X.sin() ** 2).is_close(1, atol=1e-13))
    assert np.all((X.cosh() ** 2 - X.sinh() ** 2).is_close(1, atol=1e-12))
    assert np.all((X.tan() * X.cos()).is_close(X.sin(), rtol=1e-11))
    assert np.all((X.tanh() * X.cosh()).is_close(X.sinh(), rtol=1e-11))


@pytest.mark.parametrize("name", NAMES)
def test_numbers_vectors_and_planes_in_closed_form(name):
    f = getattr(math, name)
    of_plane = {"sin": math.sinh, "cos": math.cosh, "sinh": math.sin, "cosh": math.cos}
    for x in (-2.5, -1e-9, 0.3, 40.0):
        assert float(getattr(ph.scalar(x), name)()) == pytest.approx(f(x), rel=16 * EPS)
        a = ph.vector([0.6, 0, 0.8])  # a² = 1
        of_vector = getattr(x * a, name)()
        even = name in ("cos", "cosh")
        assert of_vector.is_close(f(x) if even else f(x) * a, rtol=16 * EPS)
        if name in of_plane:
            g, B = of_plane[name](x), e1 ^ e2  # B² = −1
            assert getattr(x * B, name)().is_close(g if even else g * B, rtol=16 * EPS)
    assert e1.cos().grades == (0,)
    assert e1.sin().grades == (1,)


def test_batches_have_the_bits_of_single_values():
    for X in (some((3,), None, 3.0, (4, 2)), some((4, 1), (1, 2), 5.0, (3,)), some((3,), (0, 2), 3.0, (5,))):
        for name in NAMES:
            batch = getattr(X, name)()
            for index in np.ndindex(X.shape):
                assert batch[index] == getattr(X[index], name)()
    assert ph.vector(np.zeros((0, 3))).sin().shape == (0,)


def test_a_large_translation_costs_the_turn_no_digits():
    A = ph.algebra(3, 0, 1)
    turn, shift = 0.7 * A.blades["e12"], A.blades["e34"]
    far = (turn + 1e9 * shift).sin()
    # B = turn + shift in perpendicular planes: the parts without e4 are those of the turn alone.
    assert far["e12"] == pytest.approx(math.sinh(0.7), rel=8 * EPS)
    assert far["e34"] == pytest.approx(1e9 * math.cosh(0.7), rel=8 * EPS)


def test_single_precision_is_kept():
    X = some((3,), None, 1.0, (3,)).astype(np.float32)
    for name in NAMES:
        found = getattr(X, name)()
        assert found.dtype == np.float32
        assert np.all(found.is_close(getattr(X.astype(float), name)(), rtol=1e-6))


def test_symbols_and_exact_numbers():
    t = sympy.Symbol("t", positive=True)
    assert (t * e1).sin() == sympy.sin(t) * e1
    assert (t * (e1 ^ e2)).cosh() == sympy.cos(t)
    assert (t * (e1 ^ e2)).sin() == sympy.sinh(t) * (e1 ^ e2)
    assert sympy.simplify((t * e1 + sympy.Integer(1)).cos()["1"] - sympy.cos(t) * sympy.cos(1)) == 0
    mixed = (t * e1 + (e1 ^ e2)).sin()
    floats = (0.5 * e1 + (e1 ^ e2)).sin()
    assert [float(sympy.re(sympy.sympify(x).subs(t, 0.5).evalf())) for x in mixed.dense()] == pytest.approx(
        list(floats.dense()), abs=1e-14
    )
    # Values whose square is not a number, by exponentials in 3-d space only.
    for name in NAMES:
        exact = getattr(sympy.Rational(1, 2) * e1 + sympy.Rational(1, 3) * I, name)()
        assert exact.astype(float).is_close(getattr(e1 / 2 + I / 3, name)(), atol=16 * EPS), name
    B = ph.algebra(4).bivector([1, 0, 0, 0, 0, 1], dtype=object)
    with pytest.raises(TypeError, match=r"outside 3-d space; convert it with .astype\(float\)"):
        B.cosh()
    assert ph.vector([0, 0, 0], dtype=object).cos() == 1
    assert (Fraction(1, 2) * e1).sinh()["e1"] == math.sinh(0.5)
    # A vector of any algebra squares to a number, here to t².
    assert (t * ph.algebra(4).basis_vectors[2]).cosh() == sympy.cosh(t)
    assert (Fraction(1, 2) * e1).sin()["e1"] == math.sin(0.5)
    A = ph.algebra(4)
    with pytest.raises(TypeError, match=r"squares to a number.*astype\(float\)"):
        (A.blades["e12"] * t + A.blades["e34"]).sin()


def test_derivatives_under_jax():
    with jax.enable_x64(True):
        for make in (ph.vector, ph.bivector):
            J = jax.jacobian(lambda c, make=make: make(c).sin().components)
            assert np.allclose(J(jnp.zeros(3)), np.eye(3), atol=1e-15)
        for name in ("tan", "sinh"):
            f = lambda c, name=name: getattr(ph.vector(c), name)().dense()  # noqa: E731
            assert np.allclose(jax.jit(f)(jnp.ones(3)), f(np.ones(3)), rtol=0, atol=1e-14)
        # A bivector of four dimensions has no closed form.
        A, c = ph.algebra(4), np.linspace(-1.0, 1.0, 6)
        g = lambda c: A.bivector(c).cos().dense()  # noqa: E731
        step = 1e-6 * np.cos(np.arange(6.0))
        found = jax.jvp(g, (jnp.asarray(c),), (jnp.asarray(step),))
        assert np.allclose(found[0], g(c), rtol=0, atol=1e-14)
        # Central differences err by a third derivative times 1e-18, and by the rounding of values of size 3.
        assert np.allclose(found[1], (g(c + step) - g(c - step)) / 2, rtol=0, atol=1e-14)


def test_errors_of_functions():
    for name in NAMES:
        with pytest.raises(ValueError, match="NaN or infinite"):
            getattr(ph.vector([[0.0, 0, 0], [np.nan, 0, 0]]), name)()
    with pytest.raises(
        ValueError, match=r"at index \(1,\) of norm 800.* has no sinh in the range of float64"
    ):
        ph.vector([[1.0, 0, 0], [800, 0, 0]]).sinh()
    # Eigenvalues ±iπ/2 of I π/2 are zeros of cosh.
    with pytest.raises(ValueError, match="tanh has no value where the cosine has no inverse"):
        (Fraction(0) * I + e1 * 0 + sympy.pi / 2 * I).tanh()


# --- the outer exponential


def test_the_outer_exponential_is_its_sum():
    for signature in SIGNATURES:
        for grades in GRADES:
            X = some(signature, grades, 1.0, (3,))
            rest = X - X.grade(0)
            total = term = 1 + 0 * rest
            for k in range(1, sum(signature) + 1):
                term = term.wedge(rest) / k
                total = total + term
            assert np.all(X.outer_exp().is_close(total * X.grade(0).exp(), rtol=64 * EPS))
    assert (0 * e1).outer_exp() == 1
    assert ph.scalar(2.0).outer_exp() == ph.scalar(2.0).exp()


def test_the_outer_exponential_of_a_plane_is_a_rotor_by_its_tangent():
    angle = 0.8
    U = (math.tan(angle / 2) * (e2 ^ e1)).outer_exp()
    R = ph.Rotor.from_plane_angle(e1 ^ e2, angle)
    assert U.normalized().is_close(R, rtol=4 * EPS)
    x = sympy.Symbol("x")
    assert (x * e1 + e2).outer_exp() == 1 + x * e1 + e2


# --- means


def test_means_of_batches():
    A = ph.multivector(np.random.default_rng(51).normal(size=(4, 3, 8)))
    assert A.mean().is_close(A.sum() / 12, rtol=EPS)
    assert np.all(A.mean(0).is_close(ph.multivector(A.components.mean(axis=0)), rtol=8 * EPS))
    assert A.mean(axis=(0, 1)).shape == ()
    assert A.mean(-1).shape == (4,)
    assert e1.mean() == e1
    assert ph.vector([[1, 2, 3], [2, 2, 2]], dtype=object).mean()["e1"] == Fraction(3, 2)
    with pytest.raises(ValueError, match="at least one value"):
        ph.vector(np.zeros((0, 3))).mean()
    with pytest.raises(ValueError, match="batch axis 2 is out of range"):
        A.mean(2)


def test_rotors_have_a_mean_of_their_own():
    R = ph.Rotor.random(5, rng=1)
    with pytest.raises(TypeError, match=r"use ph\.mean\(R\)"):
        R.mean()
    assert np.array_equal((R.sum() / 5).components, R.components.sum(axis=0) / 5)
