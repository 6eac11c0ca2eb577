"""Values with arrays of other libraries as arguments of bodies and motions."""

import numpy as np
import pytest

import polhode as ph
from polhode._generic.numeric import Numeric
from polhode._support.arrays import as_floats

INERTIA = ph.Inertia.from_matrix([[2.0, 0.1, 0.2], [0.1, 3.0, -0.3], [0.2, -0.3, 2.5]])
NUMBERS = [0.5, 2.0, -0.25]  # exact in single precision


@pytest.fixture(params=["jax.numpy", "array_api_strict"])
def array(request):
    return pytest.importorskip(request.param).asarray(NUMBERS)


def test_motions_take_them_as_numpy_floats(array):
    turn, theirs = (ph.Rotor.from_rotation_vector(x) for x in (NUMBERS, array))
    law, same = (
        ph.torque.heavy(ph.vector(x)) + ph.torque.formula("k a", k=1, a=ph.bivector(x))
        for x in (NUMBERS, array)
    )
    expected = ph.simulate(INERTIA, ph.State(turn, NUMBERS), [0, 1], law).final
    found = ph.simulate(INERTIA, ph.State(theirs, ph.bivector(array)), [0, 1], same).final
    assert isinstance(found.rotor.components, np.ndarray)
    # The rotor alone is rounded to single precision, by JAX.
    assert found.rotor.distance(expected.rotor) < 1e-5
    assert (found.omega_body - expected.omega_body).norm() < 1e-5
    free = ph.FreeMotion(INERTIA, theirs, ph.bivector(array)).at(2.0)
    assert free.rotor.distance(ph.FreeMotion(INERTIA, turn, NUMBERS).at(2.0).rotor) < 1e-5


def test_torques_and_bodies_take_them(array):
    state = ph.State(ph.Rotor.identity(), NUMBERS)
    stepped = [ph.Stepper(INERTIA, state).step(0.1, torque=ph.bivector(x)) for x in (NUMBERS, array)]
    assert stepped[0] == stepped[1]
    runs = [
        ph.simulate(INERTIA, state, [1.0], lambda *_, x=x: ph.bivector(x)).final for x in (NUMBERS, array)
    ]
    assert runs[0] == runs[1]
    box = ph.Body.box([1, 2, 3], mass=1)
    turned = box.moved(ph.Rotor.from_rotation_vector(array), position=ph.vector(array))
    assert turned.center_of_mass == ph.vector(NUMBERS)
    assert np.isclose(np.trace(turned.inertia.matrix), np.trace(box.inertia.matrix))


def test_linear_maps_keep_their_type(array):
    B = ph.bivector(array)
    for found in (
        INERTIA(B),
        INERTIA.inverse(INERTIA(B)),
        ph.LinearMap.from_matrix(INERTIA.matrix)(ph.vector(array)),
    ):
        assert type(found.components) is type(array)
        assert found.components.dtype == array.dtype
    assert np.allclose(np.asarray(INERTIA(B).components), INERTIA.matrix @ NUMBERS, rtol=1e-6)
    assert np.allclose(np.asarray(INERTIA.inverse(INERTIA(B)).components), NUMBERS, rtol=1e-6)


def test_inertias_have_derivatives():
    jax = pytest.importorskip("jax")
    slopes = jax.jacobian(lambda x: INERTIA(ph.bivector(x)).components)(jax.numpy.asarray(NUMBERS))
    assert np.allclose(slopes, INERTIA.matrix, rtol=1e-6)


def test_traced_values_name_the_jax_module():
    jax = pytest.importorskip("jax")

    def final(x):
        return ph.simulate(
            INERTIA, ph.State(ph.Rotor.identity(), ph.bivector(x)), [1.0]
        ).final.omega_body.components

    with pytest.raises(TypeError, match=r"the angular velocity must be known numbers.*use ph\.jax"):
        jax.grad(lambda x: final(x)[0])(jax.numpy.asarray(NUMBERS))
    with pytest.raises(TypeError, match=r"the rotor must be known numbers.*use ph\.jax"):
        jax.jit(lambda x: ph.State(ph.Rotor.from_rotation_vector(x), [0, 0, 1]).time)(
            jax.numpy.asarray(NUMBERS)
        )


class _Recorded:
    """A tensor of torch that requires a gradient, or is mapped by vmap, as far as its errors go."""

    def __array__(self, *_, **__):
        raise RuntimeError(
            "Can't call numpy() on Tensor that requires grad. Use tensor.detach().numpy() instead."
        )

    def any(self):
        return self

    def __bool__(self):
        raise RuntimeError(
            "vmap: It looks like you're attempting to use a Tensor in data-dependent control flow"
        )


_Recorded.__module__ = "torch"


def test_values_that_torch_records_are_unknown():
    with pytest.raises(
        TypeError, match=r"rates must be known numbers, but torch records it.*x\.detach\(\).*ph\.jax"
    ):
        as_floats(_Recorded(), "rates")
    strict = pytest.importorskip("array_api_strict")
    kind = Numeric(strict, strict.float64)
    assert not kind.is_concrete(_Recorded())
    assert kind.is_concrete(strict.asarray(True))
