"""Left and right Jacobians of the exponential map, against series, differences of rotors and symbols."""

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
