"""Functions of JAX arrays are compiled once for each shape, and raise the errors of their conditions."""

from __future__ import annotations

import numpy as np
import pytest

import polhode as ph
from polhode._generic.compiled import _program

jax = pytest.importorskip("jax")
jnp = pytest.importorskip("jax.numpy")


@pytest.fixture(autouse=True)
def double_precision():
    with jax.enable_x64(True):
        yield


def test_same_shape_compiles_once():
    rotors = ph.Rotor.from_components(jnp.asarray(ph.Rotor.random(3, rng=1).components))
    rotors * rotors
    before = _program.cache_info()
    again = rotors * rotors * rotors
    after = _program.cache_info()
    assert after.misses == before.misses
    assert after.hits > before.hits
    np.testing.assert_allclose(
        again.components, (ph.Rotor.random(3, rng=1) ** 3).components, rtol=0, atol=1e-15
    )


def test_errors_name_the_first_row_of_the_first_condition_that_fails():
    matrices = np.tile(np.eye(3), (4, 1, 1))
    matrices[2, 0, 0] = -1
    with pytest.raises(ValueError, match=r"at index \(2,\): the matrix has determinant −1"):
        ph.Rotor.from_matrix(jnp.asarray(matrices))
    matrices[1, 0, 0] = np.nan
    with pytest.raises(ValueError, match=r"at index \(1,\): a component is NaN or infinite"):
        ph.Rotor.from_matrix(jnp.asarray(matrices))


def test_values_that_are_not_arrays_are_kept():
    value = ph.multivector(jnp.asarray(np.arange(1.0, 9)))
    inverse = value.inverse()
    assert inverse.grades == value.grades
    np.testing.assert_allclose((value * inverse).components, [1, 0, 0, 0, 0, 0, 0, 0], atol=1e-14)


def primitives(function, *arguments):
    """Return the names of the primitives that JAX starts one by one."""
    return [equation.primitive.name for equation in jax.make_jaxpr(function)(*arguments).jaxpr.eqns]


def test_an_operation_is_one_primitive_under_transformations():
    v, w = jnp.asarray([0.3, -0.2, 0.5]), ph.vector(jnp.asarray([1.0, 2.0, 3.0]))
    functions = (
        lambda x: (ph.vector(x) * w).components,
        lambda x: ph.bivector(x).exp().components,
        lambda x: ph.Rotor.from_rotation_vector(x).components,
    )
    for function in functions:
        assert len(primitives(function, v)) == 1
        # The value, its linear part, and whatever adds up constants.
        assert len(primitives(lambda x, f=function: jax.vjp(f, x)[0], v)) == 1
        assert len(primitives(lambda x, f=function: jax.vjp(f, x)[1](jnp.ones_like(f(x))), v)) <= 5


def test_functions_of_values_are_a_few_primitives():
    one, other = jnp.asarray([0.3, -0.2, 0.5]), jnp.asarray([1.0, 2.0, 3.0])
    plane = jnp.asarray(np.linspace(0.1, 0.6, 6))
    A, spacetime = ph.algebra(3, 0, 1), ph.algebra(1, 3)
    counts = [
        (1, lambda x: (~ph.Rotor.from_rotation_vector(x)).components),
        (1, lambda x: ph.vector(x).norm_squared()),
        (1, lambda x: (ph.vector(x) + ph.bivector(other)).components),
        (2, lambda x: ph.Rotor.from_rotation_vector(x).angle),
        (2, lambda x: ph.Rotor.from_rotation_vector(x).to_euler("xyz")),
        (2, lambda x: (ph.vector(x) * ph.vector(other)).grade(2).components),
    ]
    for most, function in counts:
        assert len(primitives(function, one)) <= most + 2
    for function in (
        lambda x: A.bivector(x).exp().log().components,
        lambda x: ph.screw_parameters(A.bivector(x).exp()).axis.components,
        lambda x: spacetime.bivector(x).exp().components,
        lambda x: (1 + A.bivector(x)).inverse().components,
    ):
        assert len(primitives(function, plane)) <= 5


def test_derivatives_outside_jit_are_those_inside():
    v, w = jnp.asarray([[0.3, -0.2, 0.5], [0.0, 0.0, 0.0]]), ph.vector(jnp.asarray([1.0, 2.0, 3.0]))

    def height(x):
        R = ph.bivector(x).exp()
        return (R * R).components[..., 1].sum() + R(w).components[..., 2].sum()

    outside, inside = jax.grad(height)(v), jax.jit(jax.grad(height))(v)
    np.testing.assert_allclose(outside, inside, rtol=0, atol=1e-14)
    np.testing.assert_allclose(jax.jacfwd(height)(v), inside, rtol=0, atol=1e-14)
    rows = jax.vmap(height)(v)
    np.testing.assert_allclose(rows.sum(), height(v), rtol=0, atol=1e-14)


def test_errors_are_raised_under_grad():
    matrices = np.tile(np.eye(3), (3, 1, 1))
    matrices[1, 0, 0] = -1
    with pytest.raises(ValueError, match=r"at index \(1,\): the matrix has determinant −1"):
        jax.grad(lambda m: ph.Rotor.from_matrix(m).components.sum())(jnp.asarray(matrices))
    with pytest.raises(ValueError, match=r"at index \(1,\): the matrix has determinant −1"):
        jax.jvp(lambda m: ph.Rotor.from_matrix(m).components, (matrices,), (matrices,))
