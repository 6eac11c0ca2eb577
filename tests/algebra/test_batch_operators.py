"""Operators of batches in the core have the values of the Python half, bit for bit."""

import operator

import numpy as np
import pytest

import polhode as ph

RNG = np.random.default_rng(20)
PGA = ph.algebra(3, 0, 1)
PRODUCTS = {"geometric": operator.mul, "wedge": operator.xor, "dot": operator.or_}
SPECIAL = np.array([0.0, -0.0, 1e-320, 1e300, np.inf, -np.inf, np.nan, 1.0])


def numbers(*shape):
    """Return numbers of which some are not finite or near the ends of the range."""
    drawn = RNG.normal(size=shape)
    drawn.flat[: SPECIAL.size] = np.resize(SPECIAL, min(SPECIAL.size, drawn.size))
    return drawn


def values(shape):
    with np.errstate(all="ignore"):
        return [
            ph.vector(numbers(*shape, 3)),
            ph.bivector(numbers(*shape, 3)),
            ph.multivector(numbers(*shape, 8)),
            ph.Rotor.random(shape, rng=1),
        ]


def agree(found, expected):
    """Assert that two values are the same: type, grades, algebra, and bits except those of NaN."""
    assert type(found) is type(expected)
    assert (found.grades, found.algebra, found.shape) == (expected.grades, expected.algebra, expected.shape)
    a, b = found.components, expected.components
    np.testing.assert_array_equal(a, b)
    np.testing.assert_array_equal(np.signbit(a)[~np.isnan(a)], np.signbit(b)[~np.isnan(b)])
    assert not found._data.flags.writeable


@pytest.mark.parametrize("shape", [(1,), (7,), (2, 3), (0,), (40, 50)])
@pytest.mark.parametrize("name", PRODUCTS)
def test_products_of_batches(name, shape):
    others = [*values(shape), ph.vector([1, 2, 3]), ph.Rotor.random(rng=2), ph.I, 2, -0.5, numbers(*shape)]
    for a in values(shape):
        for b in others:
            with np.errstate(all="ignore"):
                agree(PRODUCTS[name](a, b), a._product(name, b))
                if not isinstance(b, np.ndarray):  # NumPy asks for its own product first
                    agree(PRODUCTS[name](b, a), a._product_from(name, b))


@pytest.mark.parametrize("shape", [(1,), (2, 3), (0,), (40, 50)])
def test_sums_and_signs_of_batches(shape):
    for a, b in zip(values(shape), values(shape), strict=True):
        agree(a + b, a._add(b))
        agree(a - b, a._subtract(b))
        agree(-a, a._negated())
        agree(~a, a._reversed())
        with np.errstate(all="ignore"):
            agree(a / 3, a._divide(3))
    with pytest.raises(ZeroDivisionError):
        ph.vector(np.ones((2, 3))) / 0


@pytest.mark.parametrize("shape", [(1,), (2, 3), (0,), (40, 50)])
def test_turned_batches(shape):
    with np.errstate(all="ignore"):
        for rotor in (ph.Rotor.random(shape, rng=3), ph.Rotor.random(rng=4)):
            for x in [*values(shape), ph.vector([1, 2, 3]), ph.Rotor.random(rng=5)]:
                if rotor.shape or x.shape:
                    agree(rotor(x), rotor._turn(x))


def test_batches_of_another_algebra():
    a, b = (PGA.multivector(numbers(5, 16)) for _ in range(2))
    one = PGA.multivector(RNG.normal(size=16))
    for name, product in PRODUCTS.items():
        for x, y in ((a, b), (a, one), (one, b), (a, 2.0)):
            with np.errstate(all="ignore"):
                agree(product(x, y), x._product(name, y))
    agree(-a, a._negated())
    agree(~a, a._reversed())
    with pytest.raises(TypeError, match="different algebras"):
        a * ph.vector(np.ones((5, 3)))


def test_batches_of_several_shapes_broadcast():
    a, b = ph.vector(RNG.normal(size=(4, 1, 3))), ph.vector(RNG.normal(size=(5, 3)))
    assert (a * b).shape == (a + b).shape == (4, 5)
    with pytest.raises(ValueError, match="shape"):
        a[:, 0] * b


def test_changes_to_an_array_do_not_change_a_result():
    scales = np.array([1.0, 2.0])
    product = ph.vector(np.ones((2, 3))) * scales
    scales[:] = 0
    np.testing.assert_array_equal(product.components, [[1, 1, 1], [2, 2, 2]])
