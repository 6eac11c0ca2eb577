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
