"""Directions by longitude and latitude."""

from fractions import Fraction

import numpy as np
import pytest

import polhode as ph
from polhode import e1, e2, e3

LON = np.array([[0.0], [90.0], [180.0], [359.999]])
LAT = np.array([-89.0, -30.0, 0.0, 60.0])


def test_axes_are_at_their_places():
    assert ph.direction(0, 0) == e1
    assert ph.direction(90, 0, degrees=True).is_close(e2, atol=1e-15)
    assert ph.direction(123, 90, degrees=True).is_close(e3, atol=1e-15)
    assert ph.longitude_latitude(-e2, degrees=True) == (270.0, 0.0)
    assert ph.longitude_latitude(-3 * e3, degrees=True) == (0.0, -90.0)


def test_the_direction_is_that_of_turns_about_two_axes():
    turned = ph.Rotor.from_euler("ZY", np.stack(np.broadcast_arrays(LON, -LAT), axis=-1), degrees=True)(e1)
    assert ph.direction(LON, LAT, degrees=True).is_close(turned, atol=1e-15).all()


def test_angles_and_lengths_are_read_back():
    longitude, latitude = ph.longitude_latitude(1e200 * ph.direction(LON, LAT, degrees=True), degrees=True)
    np.testing.assert_allclose(longitude, np.broadcast_to(LON, (4, 4)), rtol=0, atol=1e-12)
    np.testing.assert_allclose(latitude, np.broadcast_to(LAT, (4, 4)), rtol=0, atol=1e-12)
    assert ph.longitude_latitude([1, -1e-300, 0]) == (0.0, 0.0)  # never a whole turn
    assert ph.longitude_latitude(np.float32([1, 1, 1]))[0].dtype == np.float32


def test_exact_numbers_and_symbols():
    sympy = pytest.importorskip("sympy")
    b, t = sympy.symbols("b t", real=True)
    assert ph.direction(t, b).components.tolist() == [
        sympy.cos(b) * sympy.cos(t),
        sympy.cos(b) * sympy.sin(t),
        sympy.sin(b),
    ]
    assert ph.longitude_latitude(ph.vector([0, sympy.Integer(-1), 1]))[1] == sympy.pi / 4
    found = ph.longitude_latitude([Fraction(1), -1, 0], degrees=True)
    assert [float(x) for x in found] == [315.0, 0.0]
    with pytest.raises(ValueError, match="zero vector has no longitude"):
        ph.longitude_latitude([Fraction(0), 0, 0])


def test_gradients():
    jax = pytest.importorskip("jax")
    slope = jax.grad(lambda x: ph.direction(x, 0.3).components[1])(0.2)
    assert abs(float(slope) - np.cos(0.3) * np.cos(0.2)) < 1e-6
    turned = jax.jit(jax.grad(lambda v: ph.longitude_latitude(v)[0]))(jax.numpy.array([1.0, 2.0, 3.0]))
    np.testing.assert_allclose(turned, [-0.4, 0.2, 0], atol=1e-6)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ph.direction([10, 20], [0, 91], degrees=True), r"at index \(1,\): a latitude must lie in"),
        (lambda: ph.direction(3, 42.2), "angles in degrees need degrees=True"),
        (lambda: ph.direction(np.nan, 0), "the longitude is NaN or infinite"),
        (
            lambda: ph.longitude_latitude([[1, 0, 0], [0, 0, 0]]),
            r"\(1,\): a vector that is zero or",
        ),
    ],
)
def test_values_without_a_direction(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_bivectors_are_not_directions():
    with pytest.raises(TypeError, match=r"must be a vector, got e1∧e2, .*; write B\.dual"):
        ph.longitude_latitude(e1 ^ e2)
