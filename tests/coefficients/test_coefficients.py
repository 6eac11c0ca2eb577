"""Choice of arithmetic, exactness, products over any coefficients, JAX pytrees."""

import math
import sys
from fractions import Fraction

import mpmath
import numpy as np
import pytest

import naive
import polhode as ph
import processes
from generic_arrays import MASKS, exact, floating, fractions, geometric_terms, of, signature_terms
from polhode._generic import exact as elements
from polhode._generic import layout
from polhode._generic.exact import Exact
from polhode._generic.numeric import Numeric
from polhode._generic.products import product
from polhode._support.extras import register_pytree

__all__ = ["floating"]
F = Fraction


# --- which arithmetic


def test_numpy_and_python_numbers_are_native():
    for values in ((1.0,), (np.ones(3), 2), ([1, 2.0, [3]],), (np.float32(1),), ()):
        assert of(*values).native


def test_exact_coefficients_combine_with_floats():
    sympy = pytest.importorskip("sympy")
    for values in (
        (F(1, 2),),
        (exact([1, 2]),),
        (sympy.Symbol("x"), np.ones(3)),
        ([1, F(1)],),
        (mpmath.mpf(1),),
    ):
        assert isinstance(of(*values), Exact)


def test_other_libraries_combine_with_numpy(floating):
    array = floating(np.ones(3))
    for values in ((array,), (np.ones(3), array), ([array[0], 1.0, array[2]],), (array, 2)):
        d = of(*values)
        assert isinstance(d, Numeric)
        joined = d.asarray(np.arange(3.0))
        assert type(joined) is type(array)
    together = of(array).asarray([array[0], 2.0, array[1] * 3])
    assert together.shape == (3,)
    assert np.array_equal(np.asarray(together), [1, 2, 3])


def test_libraries_do_not_mix():
    jnp = pytest.importorskip("jax.numpy")
    strict = pytest.importorskip("array_api_strict")
    with pytest.raises(TypeError, match="jax arrays and array_api_strict arrays do not mix"):
        of(jnp.ones(3), strict.ones(3))
    for other in (F(1, 2), exact([F(1, 2)])):
        with pytest.raises(TypeError, match=r"jax arrays and exact coefficients \(Fraction\) do not mix"):
            of(jnp.ones(3), other)


def test_the_missing_extra_is_named(monkeypatch):
    """Arrays such as torch's, which need array-api-compat."""
    tensor = type("Tensor", (), {"__module__": "torch", "dtype": None})()
    monkeypatch.setitem(sys.modules, "array_api_compat", None)
    with pytest.raises(
        ImportError, match=r"torch arrays needs array_api_compat: pip install 'polhode\[array-api\]'"
    ):
        of(tensor)


def test_float32_stays_float32():
    jax = pytest.importorskip("jax")
    strict = pytest.importorskip("array_api_strict")
    with jax.enable_x64(True):
        for array in (jax.numpy.ones(3, dtype="float32"), strict.ones(3, dtype=strict.float32)):
            d = of(array, np.ones(3), 1.0)
            assert (d.asarray(np.ones(3)) * array).dtype == array.dtype
            assert d.eps == 2.0**-23
        both = of(jax.numpy.ones(3, dtype="float32"), jax.numpy.ones(3, dtype="float64"))
        assert both.asarray(jax.numpy.ones(3, dtype="float32")).dtype == np.float64


def test_whole_numbers_become_floats(floating):
    array = floating(np.arange(3))
    assert of(array).asarray(array).dtype in (of(array).dtype,)
    assert of(array).xp.isdtype(of(array).dtype, "real floating")


def test_complex_numbers_raise():
    jnp = pytest.importorskip("jax.numpy")
    with pytest.raises(TypeError, match=r"real numbers .* got dtype complex64"):
        of(jnp.ones(3, dtype="complex64"))


def test_sympy_and_jax_are_not_imported():
    code = (
        "import sys; from fractions import Fraction as F;"
        "from polhode._generic import coefficients, functions;"
        "d = coefficients.of(F(1, 2)); functions.exp(d, d.asarray([0, 0, F(1, 2)]), 4);"
        "assert not {'sympy', 'jax', 'mpmath', 'array_api_compat'} & set(sys.modules)"
    )
    processes.run([sys.executable, "-c", code], check=True)


# --- exact elements


@pytest.mark.parametrize("bad", ["x", None, True, 1j, object(), np.bool_(True), [1]])
def test_other_elements_raise_with_their_index(bad):
    array = exact([[F(1), 2], [3, 4]])
    array[1, 0] = bad
    with pytest.raises(TypeError, match=r"coefficient at index \(1, 0\) is .*Fraction, SymPy"):
        Exact().asarray(array)


def test_whole_floats_beside_exact_coefficients_are_integers():
    d = Exact()
    met = d.asarray(np.array([1.0, -0.0, 0.5, 2.0**60, np.inf]))
    assert [type(x) for x in met] == [int, int, float, float, float]
    assert [type(x) for x in d.asarray(np.arange(2))] == [int, int]
    given = d.asarray(exact([1.0, np.float64(2.0), np.int64(3), F(4)]))
    assert [type(x) for x in given] == [float, float, int, F]


@pytest.mark.parametrize("x", [F(9, 4), 0, 1, F(1, 100), 10**40, F(10**60, 9)])
def test_roots_of_squares_are_exact(x):
    root = elements.sqrt(x)
    assert root * root == x
    assert isinstance(root, int | F)


def test_functions_are_exact_where_possible():
    assert [elements.call(name, 0) for name in ("sin", "cos", "exp", "sinh", "cosh", "atan")] == [
        0,
        1,
        1,
        0,
        1,
        0,
    ]
    assert all(isinstance(elements.call(n, F(0)), int) for n in ("sin", "cos", "exp"))
    assert elements.call("log", F(1)) == 0
    assert elements.atan2(0, F(1, 3)) == 0
    assert elements.atan2(0, -1) == math.pi
    assert elements.sqrt(2) == math.sqrt(2)
    assert elements.call("cos", F(1, 2)) == math.cos(0.5)
    assert elements.divide(6, 3) == 2
    assert isinstance(elements.divide(6, 3), int)
    assert elements.divide(1, 3) == F(1, 3)
    with pytest.raises(ValueError, match="beyond the range"):
        elements.call("exp", 1000)


def test_functions_of_symbols_are_symbols():
    sympy = pytest.importorskip("sympy")
    x = sympy.Symbol("x", positive=True)
    assert elements.call("cos", x) == sympy.cos(x)
    assert elements.sqrt(x**2) == x
    assert elements.atan2(0, x) == 0
    assert elements.atan2(sympy.Integer(0), -1) == sympy.pi
    assert elements.is_zero(sympy.sin(x) ** 2 + sympy.cos(x) ** 2 - 1)
    assert not elements.is_zero(x)
    assert not elements.is_finite(sympy.nan)
    assert not elements.is_finite(sympy.oo)


def test_functions_of_multiprecision_numbers_keep_their_precision():
    with mpmath.workdps(50):
        x = mpmath.mpf(2)
        assert elements.sqrt(x) ** 2 - 2 < mpmath.mpf(10) ** -49
        d = of(x, F(1, 3))
        third = d.asarray([F(1, 3), 1])[0]
        assert abs(3 * third - 1) < mpmath.mpf(10) ** -49
        assert abs(d.asarray([F(1, 3)])[0] - x) > 1  # fractions beside multiprecision numbers are converted


# --- products


@pytest.mark.parametrize("shapes", [((), ()), ((2, 1), (3,)), ((0,), ()), ((1,), (4, 1))])
def test_products_equal_the_oracle(floating, shapes):
    rng = np.random.default_rng(1)
    for mask_a in MASKS:
        for mask_b in (0b0010, 0b0101, 0b1111):
            a, b = (
                rng.integers(-9, 10, (*shape, len(layout.indices(mask)))).astype(float)
                for shape, mask in zip(shapes, (mask_a, mask_b), strict=True)
            )
            x, y = floating(a), floating(b)
            got = product(of(x, y), geometric_terms(mask_a, mask_b), 8, x, y)
            batch = np.broadcast_shapes(*shapes)
            assert got.shape == (*batch, 8)
            rows = [np.ascontiguousarray(np.broadcast_to(v, (*batch, v.shape[-1]))) for v in (a, b)]
            core = ph.Multivector._of(rows[0], mask_a) * ph.Multivector._of(rows[1], mask_b)
            data, mask = core.components, core._mask
            expected = np.zeros((*batch, 8))
            expected[..., layout.indices(mask)] = data.reshape(*batch, data.shape[-1])
            assert np.array_equal(np.asarray(got), expected)


def test_products_of_fractions_are_exact():
    a, b = fractions((5, 8), 2), fractions((5, 8), 3)
    got = product(of(a, b), geometric_terms(), 8, a, b)
    for x, y, z in zip(a, b, got, strict=True):
        assert list(z) == naive.components(naive.geometric(naive.of_components(x), naive.of_components(y)))


def test_products_of_large_algebras_give_the_same_numbers(floating):
    terms, rng = signature_terms(4, 1, 0), np.random.default_rng(4)
    a, b = (rng.integers(-9, 10, (3, 32)).astype(float) for _ in range(2))
    expected = np.zeros((3, 32))
    for i, j, k, sign in terms:
        expected[:, k] += sign * a[:, i] * b[:, j]
    x, y = floating(a), floating(b)
    assert np.array_equal(np.asarray(product(of(x), terms, 32, x, y)), expected)
    assert np.array_equal(np.asarray(product(of(x), terms, 32, x[0, ...], y)[0, ...]), expected[0])


def test_padding_does_not_contribute(floating):
    """With generators that square to 0 components have different numbers of terms."""
    terms = signature_terms(3, 0, 2)
    a, b = np.zeros(32), np.ones(32)
    a[0] = np.inf
    x, y = floating(a), floating(b)
    with np.errstate(invalid="ignore"):
        got = np.asarray(product(of(x), terms, 32, x, y))
        expected = np.zeros(32)
        for i, j, k, sign in terms:
            expected[k] += sign * a[i] * b[j]
    assert np.array_equal(got, expected, equal_nan=True)


def test_an_empty_product_is_zero(floating):
    x = floating(np.ones((2, 1)))
    assert np.array_equal(np.asarray(product(of(x), [], 3, x, x)), np.zeros((2, 3)))


# --- pytrees


def test_pytrees_are_registered_once_and_take_any_leaves():
    jax = pytest.importorskip("jax")

    class Held:
        def __init__(self, data, mask):
            self.data, self.mask = data, mask

    def register():
        register_pytree(Held, lambda v: ((v.data,), v.mask), lambda mask, leaves: Held(*leaves, mask))

    register()
    register()
    doubled = jax.jit(lambda v: Held(2 * v.data, v.mask))(Held(jax.numpy.ones(3), 2))
    assert doubled.mask == 2
    assert np.array_equal(doubled.data, [2, 2, 2])
    mapped = jax.vmap(lambda v: Held(v.data.sum(), 1))(Held(jax.numpy.ones((4, 3)), 2))
    assert np.array_equal(mapped.data, [3, 3, 3, 3])
    gradient = jax.grad(lambda v: (v.data**2).sum())(Held(jax.numpy.ones(3), 2))
    assert isinstance(gradient, Held)
    assert jax.tree_util.tree_map(lambda _: None, gradient).data is None


def test_transforms_are_pytrees_of_their_rotors_and_translations():
    jax = pytest.importorskip("jax")
    T = ph.RigidTransform(ph.Rotor.random(4, rng=0), [1.0, 2.0, 3.0])
    leaves, kind = jax.tree.flatten(T)
    assert [leaf.shape for leaf in leaves] == [(4, 4), (4, 3)]
    assert (jax.tree.unflatten(kind, leaves) == T).all()
    # JAX passes leaves of its own.
    none = jax.tree.map(lambda _: None, T)
    assert none.rotor._data is None
    assert none.translation._data is None
    with jax.enable_x64(True):
        S, x = T[::-1], ph.vector([0.5, -1.0, 2.0])
        product = jax.jit(lambda S, T: S * T.inv())(S, T)
        assert isinstance(product, ph.RigidTransform)
        assert np.all(product.is_close(S * T.inv(), atol=1e-14))
        moved = jax.vmap(lambda S, x: S.apply(x), (0, None))(S, x)
        assert np.all(moved.is_close(S.apply(x), rtol=1e-14))
        each = jax.vmap(lambda S, T: (S * T) ** 0.5)(S, T)
        assert each.shape == (4,)
        assert np.all(each.is_close((S * T) ** 0.5, atol=1e-13))
        slope = jax.grad(lambda T: T.apply(x)["e2"])(T[0])
        assert np.allclose(slope.translation.components, [0, 1, 0])


def test_register_pytree_without_jax_does_nothing(monkeypatch):
    monkeypatch.setitem(sys.modules, "jax", None)
    register_pytree(type("Other", (), {}), None, None)
