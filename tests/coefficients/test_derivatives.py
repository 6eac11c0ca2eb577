"""JAX: derivatives of the functions of G3 and of rotors, above all where naive formulas divide 0 by 0."""

from functools import cache

import numpy as np
import pytest

import polhode as ph
from generic_arrays import EPS, eight_of, multiplied, native, of
from polhode._generic import functions, layout, rotors

pytestmark = pytest.mark.slow  # the same laws as in other files, over more algebras and coefficients

jax = pytest.importorskip("jax")
jnp = jax.numpy

SCALAR, VECTOR, BIVECTOR, EVEN, ALL = 1, 2, 4, 5, 15


def slow(*values):
    """Parameters of tests that compile for seconds and resemble others."""
    return [pytest.param(value, marks=pytest.mark.slow) for value in values]


@pytest.fixture(autouse=True)
def _doubles():
    with jax.enable_x64(True):
        yield


# Cached, so that JAX compiles each function and derivative once for all tests of this file.
@cache
def function(name, mask):
    """The function on single values, of its own components, compiled."""
    return jax.jit(lambda m: getattr(functions, name)(of(m), m, mask)[0])


@cache
def forward(f):
    return jax.jit(jax.jacfwd(f))


@cache
def backward(f):
    return jax.jit(jax.jacrev(f))


@cache
def second(f):
    return jax.jit(jax.jacfwd(jax.jacfwd(f)))


@cache
def second_of_log_part(mask):
    """The second derivative of the first component of log."""
    return second(lambda m: function("log", mask)(m)[0])


def close(got, expected, count=16):
    return np.all(abs(np.asarray(got) - expected) <= count * EPS * (1 + np.abs(expected)))


# --- at singular points of the formulas


@pytest.mark.parametrize("mask", [BIVECTOR, ALL, *slow(0b0010, 0b0110)])
def test_exp_at_zero(mask):
    size = len(layout.indices(mask))
    exp, zero = function("exp", mask), jnp.zeros(size)
    grades = layout.grades_of("exp", mask)
    held = [layout.indices(grades).index(i) for i in layout.indices(mask)]
    for jacobian in (forward(exp)(zero), backward(exp)(zero)):
        assert close(jacobian, np.eye(jacobian.shape[0])[:, held])
    # exp M = 1 + M + M²/2: the scalar part of M² is Σ ± m².
    signs = np.array([1, 1, 1, 1, -1, -1, -1, -1])[layout.indices(mask)]
    assert close(second(lambda m: exp(m)[0])(zero), np.diag(signs))


@pytest.mark.parametrize("mask", [EVEN, *slow(ALL)])
@pytest.mark.parametrize("s", [1.0, -1.0])
def test_log_and_sqrt_at_one_and_minus_one(mask, s):
    indices = layout.indices(mask)
    one = jnp.zeros(len(indices)).at[0].set(s)
    for jacobian in (forward, backward):
        # About 1, log(1 + x) = x − x²/2; about −1 the half turn stays: log(−1 + x) = π e12 − x.
        assert close(jacobian(function("log", mask))(one), s * np.eye(len(indices)))
        root = np.asarray(jacobian(function("sqrt", mask))(one))
        assert np.isfinite(root).all()
        if s > 0:
            assert close(root, np.eye(len(indices)) / 2)
    curvature = second_of_log_part(mask)(one)
    signs = np.array([-1, -1, -1, -1, 1, 1, 1, 1])[indices]
    assert close(curvature, np.diag(signs))
    if mask == EVEN:  # compiling it for all grades takes long
        assert np.isfinite(second(lambda m: function("sqrt", mask)(m).sum())(one)).all()


def test_sizes_at_zero():
    zero = jnp.zeros(3)
    norm = jax.jit(lambda m: functions.norm(of(m), m))
    assert close(jax.grad(norm)(zero), np.zeros(3))
    assert close(second(norm)(zero), np.zeros((3, 3)))
    assert close(jax.grad(norm)(jnp.asarray([3.0, 0, 4.0])), [0.6, 0, 0.8])
    assert close(second(norm)(jnp.asarray([2.0, 0, 0])), np.diag([0, 0.5, 0.5]))


@pytest.mark.parametrize("s", [1.0, -1.0])
def test_rotors_at_one_and_minus_one(s):
    one = jnp.asarray([s, 0.0, 0, 0])
    d = of(one)
    for jacobian in (forward, backward):
        assert close(jacobian(lambda r: rotors.log(d, r))(one), s * np.eye(4)[1:])
        assert close(jacobian(lambda r: rotors.to_rotation_vector(d, r))(one), -2 * s * np.eye(4)[1:])
        # exp(n log R) for R = 1 + B is 1 + nB.
        power = jacobian(lambda r: rotors.power(d, r, 0.5))(one)
        assert np.isfinite(np.asarray(power)).all()
        if s > 0:
            assert close(power[1:], 0.5 * np.eye(4)[1:])
        for part in jacobian(lambda r: rotors.plane_angle(d, r))(one):
            assert np.isfinite(np.asarray(part)).all()
    turned = backward(lambda r: rotors.apply(d, r, jnp.asarray([1.0, 0, 0]), VECTOR))(one)
    assert close(turned[:, 3], [0, -2 * s, 0])  # (s + β e12) e1 (s − β e12) = e1 − 2sβ e2 to first order
    assert np.isfinite(second(lambda r: rotors.log(d, r)[0])(one)).all()


def test_constructors_at_no_turn_and_at_half_turns():
    zero, x = jnp.zeros(3), jnp.asarray([1.0, 0, 0])
    d = of(zero)
    assert close(backward(lambda v: rotors.from_rotation_vector(d, v))(zero), -0.5 * np.eye(4)[:, 1:])
    same = backward(lambda b: rotors.from_vectors(d, x, b))(x)
    # Towards e2 the angle grows by 1 per unit: R = 1 − (db/2) e12.
    assert close(same[:, 1], [0, 0, 0, -0.5])
    assert np.isfinite(np.asarray(backward(lambda b: rotors.from_vectors(d, x, b))(-x))).all()
    matrix = backward(lambda m: rotors.from_matrix(d, m))(jnp.eye(3))
    assert np.isfinite(np.asarray(matrix)).all()
    angle = forward(lambda a: rotors.from_plane_angle(d, jnp.asarray([0, 0, 2.0]), a))(jnp.asarray(0.0))
    assert close(angle, [0, 0, 0, -0.5])


# --- everywhere


@pytest.mark.parametrize("name", ["inverse", "exp", "log", "sqrt"])
@pytest.mark.parametrize("mask", [EVEN, ALL, *slow(0b0011, 0b1001)])
def test_derivatives_are_those_of_the_core_by_differences(name, mask):
    indices = layout.indices(mask)
    rng = np.random.default_rng(mask)
    points = rng.standard_normal((12, len(indices)))
    points[:, 0] += np.where(points[:, 0] < 0, -2, 2) if mask == EVEN else 3
    directions = rng.standard_normal(points.shape)
    f = function(name, mask)
    slopes = jax.jit(jax.vmap(lambda m, v: jax.jvp(f, (m,), (v,))[1]))(points, directions)
    h = 2.0**-18
    ahead, behind = (native(name, points + step * directions, mask)[0] for step in (h, -h))
    # Central differences: h²/6 of the third derivative, some hundred times |f| here, and 8 eps |f|/h.
    size = 1 + np.abs(ahead).max() + np.abs(np.asarray(slopes)).max()
    assert np.all(abs((ahead - behind) / (2 * h) - slopes) <= (100 * h * h + 8 * EPS / h) * size * 10)


@pytest.mark.parametrize("name", ["exp", "log", *slow("inverse", "sqrt")])
def test_compiled_and_mapped_values_are_those_computed_at_once(name):
    points = np.random.default_rng(5).standard_normal((10, 8)) + 4 * np.eye(8)[0]
    f = function(name, ALL)
    at_once = np.asarray(f(jnp.asarray(points)))
    for values in (jax.jit(f)(points), jax.vmap(f)(points), jax.jit(jax.vmap(f))(points)):
        assert np.all(abs(np.asarray(values) - at_once) <= 8 * EPS * np.abs(at_once).max())


def test_undefined_values_are_not_finite_while_traced():
    singular = jnp.asarray([1.0, 1, 0, 0, 0, 0, 0, 0])
    for name in ("inverse", "log"):
        assert not np.isfinite(jax.jit(function(name, ALL))(singular)).all()
    assert not np.isfinite(jax.jit(function("exp", SCALAR))(jnp.asarray([1000.0]))).all()
    assert np.isnan(jax.jit(lambda m: functions.normalized(of(m), m))(jnp.zeros(3))).all()
    assert np.isnan(jax.jit(lambda m: rotors.from_components(of(m), m))(jnp.zeros(4))).all()


SMOOTH_AT_ZERO = {
    "rotation vector": (3, lambda v: ph.Rotor.from_rotation_vector(v)),
    "bivector": (3, lambda v: ph.bivector(v).exp()),
    "multivector": (8, lambda v: ph.multivector(v).exp()),
    "cosine": (3, lambda v: ph.bivector(v).cos()),
    "spacetime": (6, lambda v: ph.algebra(1, 3).bivector(v).exp()),
    "vector of spacetime": (4, lambda v: ph.algebra(1, 3).vector(v).exp()),
    "motor": (6, lambda v: ph.algebra(3, 0, 1).bivector(v).exp()),
}


@pytest.mark.parametrize("name", SMOOTH_AT_ZERO)
def test_second_derivatives_where_squares_vanish(name):
    size, f = SMOOTH_AT_ZERO[name]

    def number(v):
        data = f(v).dense()
        return data @ jnp.arange(1.0, data.shape[-1] + 1)

    hessian = jax.jit(jax.hessian(number))
    expected = hessian(jnp.zeros(size))
    direction = np.linspace(-1, 1.3, size)
    for length in (1e-30, 1e-160, 1e-300):
        np.testing.assert_allclose(hessian(jnp.asarray(length * direction)), expected, rtol=0, atol=64 * EPS)


def test_float32_derivatives_stay_float32():
    one = jnp.asarray([1.0, 0, 0, 0], dtype="float32")
    jacobian = backward(function("log", EVEN))(one)
    assert jacobian.dtype == np.float32
    assert np.array_equal(jacobian, np.eye(4))


def test_a_gradient_through_a_chain_of_turns():
    """The turn that takes e1 to a target, by gradient descent from the identity."""
    target = np.array([0.0, 0.6, 0.8])

    def distance(B):
        d = of(B)
        R, _ = functions.exp(d, B, BIVECTOR)
        return ((rotors.apply(d, R, jnp.asarray([1.0, 0, 0]), VECTOR) - target) ** 2).sum()

    step, B = jax.jit(jax.grad(distance)), jnp.zeros(3)
    for _ in range(200):
        B = B - 0.1 * step(B)
    assert distance(B) < 1e-12
    R, _ = functions.exp(of(B), B, BIVECTOR)
    unit = multiplied(of(B), R, EVEN, rotors.to_quaternion(of(B), R), EVEN)
    assert close(unit, eight_of(np.eye(4)[0], EVEN))
