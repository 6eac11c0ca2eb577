"""inverse and exp in any signature, over floating-point arrays and fractions."""

import numpy as np
import pytest

import polhode as ph
from generic_arrays import EPS, difference, floating, fractions, native, of, one_of, signature_terms
from polhode._generic import algebras
from polhode._generic.exact import Exact
from polhode._generic.products import product

pytestmark = pytest.mark.slow  # the same laws as in other files, over more algebras and coefficients

__all__ = ["floating"]
SIGNATURES = [
    (0, 0, 0),
    (1, 0, 0),
    (0, 1, 0),
    (0, 0, 1),
    (2, 0, 0),
    (1, 1, 0),
    (3, 0, 0),
    (1, 1, 1),
    (4, 0, 0),
]
SIGNATURES += [(1, 3, 0), (3, 0, 1), (2, 2, 0)]
LARGE = [(4, 1, 0), (3, 0, 2)]


def sparse(seed, generators, size=3):
    """Fractions in a few components: exact products of dense ones in 32 components take long."""
    data = fractions((size, 1 << generators), seed)
    if generators > 3:
        data[:, np.random.default_rng(seed).permutation(1 << generators)[6:]] = 0
    data[:, 0] += 6
    return data


@pytest.mark.parametrize("signature", SIGNATURES)
def test_inverses_of_fractions_are_exact(signature):
    n, terms = sum(signature), signature_terms(*signature)
    data = sparse(n, n)
    d = of(data)
    inverse = algebras.inverse(d, terms, n, data)
    for one in (product(d, terms, 1 << n, data, inverse), product(d, terms, 1 << n, inverse, data)):
        assert np.array_equal(one, one_of(one))


@pytest.mark.parametrize("signature", [(2, 0, 0), (3, 0, 0), (3, 0, 1), (1, 3, 0), (4, 1, 0)])
def test_inverses_of_floats(signature, floating):
    n, terms = sum(signature), signature_terms(*signature)
    data = np.random.default_rng(n).standard_normal((4, 1 << n))
    data[:, 0] += 2.0**n
    for scale in (1e-200, 1.0, 1e200):
        x = floating(scale * data)
        inverse = np.asarray(algebras.inverse(of(x), terms, n, x)) * scale
        one = product(of(1.0), terms, 1 << n, data, inverse)
        # Newton's last step rounds 2ⁿ products of each component, |M||M⁻¹| being below 8 here.
        assert np.all(difference(one, one_of(one)) <= 8 * 2.0**n * EPS)


def test_singular_values_are_errors_with_the_index(floating):
    terms = signature_terms(1, 1, 1)
    for value in ([1.0, 1, 0, 0, 0, 0, 0, 0], [0, 1, 1, 0, 0, 0, 0, 0], [0, 0, 0, 0, 1, 0, 0, 0], [0.0] * 8):
        data = np.stack([np.eye(8)[0], value])
        x = floating(data)
        with pytest.raises(ValueError, match=r"at index \(1,\): no inverse"):
            algebras.inverse(of(x), terms, 3, x)
        d = Exact()
        with pytest.raises(ValueError, match=r"at index \(1,\): no inverse"):
            algebras.inverse(d, terms, 3, d.asarray(data))


def series(terms, m):
    """exp by its power series."""
    total = power = np.eye(m.size)[0]
    for k in range(1, 60):
        power = product(of(1.0), terms, m.size, power, m) / k
        total = total + power
    return total


@pytest.mark.parametrize("signature", [(1, 0, 0), (2, 0, 0), (1, 1, 1), (1, 3, 0), (3, 0, 1)])
@pytest.mark.parametrize("size", [0.0, 1e-3, 0.3, 3.0])
def test_exp_against_its_series(signature, size, floating):
    n, terms = sum(signature), signature_terms(*signature)
    rng = np.random.default_rng(n)
    grades = np.array([i.bit_count() for i in range(1 << n)])
    for held in ({0, 1}, {1}, {2}, {0, 2}, set(range(n + 1))):
        data = size * rng.standard_normal(1 << n) * np.isin(grades, list(held))
        x = floating(data)
        blades = [i for i in range(1 << n) if grades[i] in held]
        got = algebras.exp(of(x), terms, blades, x)
        norm = abs(data).sum()
        # 60 terms below e^|M| each, and the squarings double the rounding error, up to 4|M| in all.
        assert difference(got, series(terms, data)) <= 64 * EPS * (1 + 4 * norm) * np.exp(norm)


def test_exp_of_three_dimensions_is_that_of_the_core(floating):
    terms = signature_terms(3, 0, 0)
    order = [0, 1, 2, 4, 6, 5, 3, 7]  # 1, e1, e2, e3, e2e3, e1e3, e1e2, I
    signs = np.array([1, 1, 1, 1, 1, -1, 1, 1])
    full = np.random.default_rng(1).standard_normal((20, 8))
    data = np.zeros((20, 8))
    data[:, order] = full * signs
    x = floating(data)
    got = np.asarray(algebras.exp(of(x), terms, range(8), x))[:, order] * signs
    expected, _ = native("exp", full, 15)
    size = abs(full).sum(axis=-1)
    assert np.all(difference(got, expected) <= 32 * EPS * size * np.exp(np.linalg.norm(full, axis=-1)))


@pytest.mark.parametrize("size", [1e160, 1e3, 1.0, 1e-160])
def test_turns_of_any_size_have_size_1(size, floating):
    data = np.zeros(8)
    data[[3, 5, 6]] = size * np.array([0.48, -0.6, 0.64])
    x = floating(data)
    got = np.asarray(algebras.exp(of(x), signature_terms(3, 0, 0), [3, 5, 6], x))
    assert abs(np.linalg.norm(got) - 1) <= 4 * EPS


def test_boosts_with_scalars(floating):
    x = floating(np.array([-800.0, 800.0]))
    assert difference(algebras.exp(of(x), signature_terms(1, 0, 0), [0, 1], x), [0.5, 0.5]) <= 4 * EPS
    big = floating(np.array([0.0, 800.0]))
    with pytest.raises(ValueError, match="beyond the range"):
        algebras.exp(of(big), signature_terms(1, 0, 0), [1], big)
    bad = floating(np.array([[0.0, 1.0], [0, np.inf]]))
    with pytest.raises(ValueError, match=r"at index \(1,\): a component is NaN"):
        algebras.exp(of(bad), signature_terms(1, 0, 0), [1], bad)


@pytest.mark.parametrize("signature", LARGE)
def test_traced_by_jax(signature):
    jax = pytest.importorskip("jax")
    n, terms = sum(signature), signature_terms(*signature)
    data = 0.1 * np.random.default_rng(n).standard_normal((3, 1 << n))
    data[:, 0] += 1
    with jax.enable_x64(True):
        d = of(jax.numpy.ones(1))
        x = jax.numpy.asarray(data)
        traced = jax.jit(lambda m: algebras.exp(d, terms, range(1 << n), m))
        size = abs(data).sum()
        for scale in (1.0, 10.0):
            here = algebras.exp(d, terms, range(1 << n), scale * x)
            assert np.all(
                difference(traced(scale * x), here) <= 64 * EPS * size * np.exp(scale * abs(data).sum(-1))
            )
        assert np.isnan(traced(1e4 * x)).all()
        inverse = jax.jit(lambda m: algebras.inverse(d, terms, n, m))(x)
        one = product(d, terms, 1 << n, x, inverse)
        assert np.all(difference(one, one_of(one)) <= 64 * 2.0**n * EPS)


def test_derivatives_of_exp_leave_simple_bivectors():
    """d/dε exp(e12 + ε e34) at 0 is e34 exp(e12), which has a part in e1234."""
    jax = pytest.importorskip("jax")
    terms = signature_terms(4, 0, 0)
    with jax.enable_x64(True):
        d = of(jax.numpy.ones(1))
        basis = jax.numpy.eye(16)
        bivectors = [i for i in range(16) if i.bit_count() == 2]
        exp = jax.jit(lambda m: algebras.exp(d, terms, bivectors, m))
        _, slope = jax.jvp(exp, (basis[3],), (basis[12],))
        assert difference(slope, np.cos(1) * np.eye(16)[12] + np.sin(1) * np.eye(16)[15]) <= 16 * EPS
        # A closed form is differentiable at 0, and twice.
        zero = jax.numpy.zeros(16)
        closed = jax.jit(lambda m: algebras.exp(d, terms, [1, 2, 4, 8], m))
        assert difference(jax.jacfwd(closed)(zero)[:, 1], np.eye(16)[1]) == 0
        twice = np.asarray(jax.hessian(lambda m: closed(m)[0])(zero))
        assert np.allclose(twice[1, 1], 1, rtol=0, atol=4 * EPS)
        assert np.isfinite(twice).all()


@pytest.mark.parametrize("signature", [(3, 0, 1), (2, 0, 2), (1, 3, 1)])
def test_large_translations_keep_the_accuracy_of_turns(signature):
    """Without scaled null generators, as in the core, 1e6 costs six digits and 1e150 is out of range."""
    A = ph.algebra(*signature)
    n, r = A.dimension, signature[2]
    null = np.array([bits >> (n - r) != 0 for bits, _ in A._blades()])
    grade = np.array([bits.bit_count() for bits, _ in A._blades()])
    strict = pytest.importorskip("array_api_strict")
    for far in (1.0, 1e6, 1e150):
        b = np.random.default_rng(1).standard_normal((30, n * (n - 1) // 2))
        b = b * np.where(null[grade == 2], far ** (1 / r), 1.0)
        motor, expected = A.bivector(strict.asarray(b)).exp(), A.bivector(b).exp()
        even = null[grade % 2 == 0]
        for got, other in ((motor, expected), (motor.inverse(), expected.inverse())):
            error, size = abs(np.asarray(got.components) - other.components), abs(other.components)
            # Halvings and the powers of boosts below e^4 magnify a few roundings, and in each part alone.
            for part in (even, ~even):
                assert np.all(error[:, part].max(axis=-1) <= 4096 * EPS * size[:, part].max(axis=-1))
