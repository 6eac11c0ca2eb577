"""Left and right Jacobians of the exponential map, against series, differences of rotors and symbols."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given

import polhode as ph
from polhode import Rotor, e1, e2
from samples import EPS, SHAPES, angles, directions


def series(v, sign=1):
    """``Σ [v]ₓᵏ/(k + 1)!`` in 50 digits."""
    with mpmath.workdps(50):
        a, b, c = (sign * mpmath.mpf(float(x)) for x in v)
        cross = mpmath.matrix([[0, -c, b], [c, 0, -a], [-b, a, 0]])
        term, total = mpmath.eye(3), mpmath.eye(3)
        for k in range(1, 120):
            term = term * cross / (k + 1)
            total += term
        return total


def numbers(matrix):
    return np.array(matrix.tolist(), float)


@given(directions, angles)
def test_jacobians_are_their_series(n, angle):
    v = n * angle
    left, right = ph.left_jacobian(v), ph.right_jacobian(v)
    # Entries are sums of products of a handful of numbers below 1.
    np.testing.assert_allclose(left, numbers(series(v)), rtol=0, atol=8 * EPS)
    np.testing.assert_allclose(right, numbers(series(v, -1)), rtol=0, atol=8 * EPS)
    np.testing.assert_array_equal(right, ph.left_jacobian(-v))
    np.testing.assert_allclose(right, left.T, rtol=0, atol=2 * EPS)


@given(directions, angles)
def test_inverses(n, angle):
    v = n * angle
    away = abs(abs(float(np.linalg.norm(v))) - 2 * np.pi)
    if away < 1e-12:
        return
    with mpmath.workdps(50):
        expected = numbers(mpmath.inverse(series(v)))
    # The size near a full turn is 2π over the distance from it, of which the rounding of v is EPS times 2π.
    size = 1 + 7 / away
    found = ph.left_jacobian(v, inverse=True)
    np.testing.assert_allclose(found, expected, rtol=0, atol=8 * EPS * size * (1 + 7 / away))
    if away > 0.1:
        np.testing.assert_allclose(ph.right_jacobian(v, inverse=True), expected.T, rtol=0, atol=1000 * EPS)


@pytest.mark.parametrize("size", [0.0, 1e-200, 1e-8, 0.5, 0.999999, 1.0, 2.0, np.pi, 5.0, 6.2])
def test_jacobians_are_those_of_rotors(size):
    v = size * np.array([1.0, -2.0, 2.0]) / 3
    h, R = 1e-6, Rotor.from_rotation_vector(v)
    for k, step in enumerate(h * np.eye(3)):
        ahead, behind = (Rotor.from_rotation_vector(v + s * step) for s in (1, -1))
        left = (ahead * ~behind).to_rotation_vector() / (2 * h)
        right = (~behind * ahead).to_rotation_vector() / (2 * h)
        # Central differences err by h² and by rounding over h.
        np.testing.assert_allclose(ph.left_jacobian(v)[:, k], left, rtol=0, atol=1e-9)
        np.testing.assert_allclose(ph.right_jacobian(v)[:, k], right, rtol=0, atol=1e-9)
    # R carries body axes to space axes.
    np.testing.assert_allclose(
        R.to_matrix() @ ph.right_jacobian(v), ph.left_jacobian(v), rtol=0, atol=8 * EPS
    )


@pytest.mark.parametrize("shape", SHAPES)
def test_batches_and_values(shape):
    v = np.random.default_rng(1).standard_normal((*shape, 3))
    found = ph.left_jacobian(v)
    assert found.shape == (*shape, 3, 3)
    np.testing.assert_array_equal(ph.left_jacobian(ph.vector(v)), found)
    np.testing.assert_array_equal(ph.left_jacobian(ph.bivector(v)), found)
    np.testing.assert_array_equal(ph.left_jacobian(v.tolist()), found)
    single = ph.right_jacobian(v.astype(np.float32))
    assert single.dtype == np.float32
    np.testing.assert_allclose(single, ph.right_jacobian(v), rtol=0, atol=1e-5)


# --- screws


def series_of_screws(x):
    """``Σ adᵏ/(k + 1)!`` in 60 digits for the matrix ad of the commutator with a screw, and its inverse."""
    with mpmath.workdps(60):
        turn, shift = (
            [[0, -c, b], [c, 0, -a], [-b, a, 0]]
            for a, b, c in (map(mpmath.mpf, x[:3]), map(mpmath.mpf, x[3:]))
        )
        rows = [[*row, 0, 0, 0] for row in turn] + [[*s, *t] for s, t in zip(shift, turn, strict=True)]
        ad = mpmath.matrix(rows)
        term, total = mpmath.eye(6), mpmath.eye(6)
        for k in range(1, 150):
            term = term * ad / (k + 1)
            total += term
        return numbers(total), numbers(mpmath.inverse(total))


@pytest.mark.parametrize("angle", [0.0, 1e-200, 1e-8, 0.5, 1.9999999, 2.0, 3.0, np.pi, 5.0, 6.2, 12.0])
def test_jacobians_of_screws_are_their_series(angle):
    x = np.array([1.0, -2.0, 2.0, 3.0, 1.0, -0.5])
    x[:3] *= angle / 3
    expected, inverse = series_of_screws(x)
    # Entries are sums of products of a handful of numbers below 4.
    np.testing.assert_allclose(ph.left_jacobian(x), expected, rtol=0, atol=16 * EPS)
    away = min(abs(angle - 2 * np.pi * k) for k in (1, 2))
    tolerance = 16 * EPS * np.abs(inverse).max() * (1 + 7 / away)
    np.testing.assert_allclose(ph.left_jacobian(x, inverse=True), inverse, rtol=0, atol=tolerance)
    np.testing.assert_array_equal(ph.right_jacobian(x), ph.left_jacobian(-x))


def test_jacobians_of_screws_are_those_of_transforms():
    x = np.random.default_rng(1).standard_normal((2, 3, 6))
    left, right = ph.left_jacobian(x), ph.right_jacobian(x)
    assert left.shape == (2, 3, 6, 6)
    T, h = ph.RigidTransform.exp, 1e-6
    for k, step in enumerate(h * np.eye(6)):
        ahead, behind = T(x + step), T(x - step)
        # Central differences err by h² and by rounding over h.
        found = (ahead * behind.inverse()).log() / (2 * h)
        np.testing.assert_allclose(left[..., k], found, rtol=0, atol=1e-8)
        found = (behind.inverse() * ahead).log() / (2 * h)
        np.testing.assert_allclose(right[..., k], found, rtol=0, atol=1e-8)
    # The adjoint carries twists of the body to space.
    np.testing.assert_allclose(T(x).adjoint() @ right, left, rtol=0, atol=64 * EPS)


def test_screws_of_large_and_non_finite_numbers():
    assert np.isfinite(ph.left_jacobian([1e200, 0, 0, 1, 2, 3])).all()
    with pytest.raises(ValueError, match=r"at index \(1,\): a component is NaN or infinite"):
        ph.left_jacobian([[0.0] * 6, [0.0] * 5 + [np.inf]])
    with pytest.raises(ValueError, match="does not exist at a full turn"):
        ph.left_jacobian([0, 0, 2 * np.pi, 1, 2, 3], inverse=True)
    with pytest.raises(ValueError, match=r"3 components in the last axis, got shape \(4,\)"):
        ph.right_jacobian([0, 0, 0, 1])


def test_screws_of_symbols():
    sympy = pytest.importorskip("sympy")
    x = [0, 0, sympy.Symbol("t", positive=True), 1, 0, 2]
    found = sympy.lambdify("t", sympy.Matrix(ph.left_jacobian(x)))(0.7)
    np.testing.assert_allclose(found, ph.left_jacobian([0, 0, 0.7, 1, 0, 2]), rtol=0, atol=8 * EPS)
    exact = ph.left_jacobian([sympy.Integer(k) for k in (0, 0, 0, 1, 2, 3)])
    assert exact[3, 1] == sympy.Rational(-3, 2)


@pytest.mark.parametrize("size", [Fraction(1, 10**6), Fraction(1, 2), Fraction(3)])
def test_screws_of_numbers_of_other_types(size):
    x = [size, size, -size, Fraction(1), Fraction(2), Fraction(3)]
    expected, _ = series_of_screws(np.array(x, float))
    np.testing.assert_allclose(ph.left_jacobian(x).astype(float), expected, rtol=0, atol=16 * EPS)
    with mpmath.workdps(40):
        digits = [mpmath.mpf(float(c)) for c in x]
        fine = ph.left_jacobian(digits)
        # J x = x, for x commutes with itself.
        assert max(abs(fine @ digits - digits)) < mpmath.mpf(10) ** -36
        np.testing.assert_allclose(fine.astype(float), expected, rtol=0, atol=EPS)


def test_screws_of_jax():
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        jnp = jax.numpy
        x = np.array([0.3, -1.0, 2.0, 1.0, 2.0, 3.0])
        np.testing.assert_allclose(
            ph.left_jacobian(jnp.asarray(x)), ph.left_jacobian(x), rtol=0, atol=8 * EPS
        )

        def along(t):
            return ph.left_jacobian(t * jnp.asarray([0.0, 0.0, 1.0, 1.0, 0.0, 0.0]))[3:, :3]

        # The block is ½[v]ₓ + ([ω]ₓ[v]ₓ + [v]ₓ[ω]ₓ)/6 + …, with both proportional to t: derivatives at 0.
        slope = jax.jacfwd(along)
        np.testing.assert_allclose(slope(0.0)[2, 1], 0.5, rtol=0, atol=EPS)
        np.testing.assert_allclose(jax.jacfwd(slope)(0.0)[0, 2], 1 / 3, rtol=0, atol=4 * EPS)


# --- errors and other coefficients


def test_wrong_arguments_raise():
    with pytest.raises(
        ValueError, match=r"at index \(1,\): the inverse Jacobian does not exist at a full turn"
    ):
        ph.left_jacobian([[1, 0, 0], [0, 0, 2 * np.pi]], inverse=True)
    with pytest.raises(ValueError, match=r"3 components in the last axis, got shape \(2,\)"):
        ph.left_jacobian([1, 2])
    with pytest.raises(ValueError, match="NaN or infinite"):
        ph.right_jacobian([np.nan, 0, 0])
    with pytest.raises(TypeError, match="a vector or a bivector of 3-d space"):
        ph.left_jacobian(1 + (e1 ^ e2))


def test_symbols():
    sympy = pytest.importorskip("sympy")
    t = sympy.Symbol("t", positive=True)
    found = sympy.Matrix(ph.left_jacobian([0, 0, t]))
    expected = sympy.Matrix(
        [
            [sympy.sin(t) / t, (sympy.cos(t) - 1) / t, 0],
            [(1 - sympy.cos(t)) / t, sympy.sin(t) / t, 0],
            [0, 0, 1],
        ]
    )
    assert sympy.simplify(found - expected) == sympy.zeros(3)
    inverse = sympy.Matrix(ph.left_jacobian([0, 0, t], inverse=True))
    assert sympy.simplify(inverse * found) == sympy.eye(3)
    assert (ph.right_jacobian([sympy.Integer(0)] * 3).astype(float) == np.eye(3)).all()


def test_jax():
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        jnp = jax.numpy
        v = jnp.asarray([0.3, -1.0, 2.0])
        np.testing.assert_allclose(ph.left_jacobian(v), ph.left_jacobian(np.asarray(v)), rtol=0, atol=4 * EPS)

        def along(t):
            return ph.left_jacobian(t * jnp.asarray([0.0, 0.0, 1.0]))[:2, 0]

        # J = 1 + ½[v]ₓ + (1/6)[v]ₓ² + …: derivatives at 0.
        slope = jax.jacfwd(along)
        first, second = jax.jit(lambda t: (slope(t), jax.jacfwd(slope)(t)))(0.0)
        np.testing.assert_allclose(first, [0, 0.5], rtol=0, atol=EPS)
        np.testing.assert_allclose(second, [-1 / 3, 0], rtol=0, atol=4 * EPS)
