"""Formulas under JAX: compiled, mapped, and their gradients."""

import numpy as np
import pytest

import polhode as ph
from polhode import e1, e2, e3
from samples import EPS, random_rotors

jax = pytest.importorskip("jax")
jnp = jax.numpy
RNG = np.random.default_rng(5)


@pytest.fixture
def _doubles():
    with jax.enable_x64(True):
        yield


def vectors(*shape):
    return ph.vector(RNG.standard_normal((*shape, 3)))


def test_gradients_of_known_formulas():
    a, b = vectors(), vectors()
    assert ph.formula("½ x·x").grad("x")(x=a).is_close(a)
    gradients = ph.formula("a·b").grad("a", "b")(a=a, b=b)
    assert gradients[0].is_close(b)
    assert gradients[1].is_close(a)
    B = ph.bivector(RNG.standard_normal(3))
    slope = ph.formula("⟨B B⟩ + s").grad("B")(B=B, s=2.0)
    assert slope.is_close(-2 * B)
    assert slope.grades == (2,)
    assert isinstance(slope.components, np.ndarray)
    assert slope.dtype == np.float64
    assert float(ph.formula("s³").grad("s")(s=2.0)) == pytest.approx(12, rel=1e-15)


def test_gradients_agree_with_differences():
    text = "norm(R a ~R + b)² + ⟨exp(B) a b⟩ + sin(s) a·b"
    values = {
        "R": random_rotors(()),
        "a": vectors(),
        "b": vectors(),
        "B": ph.bivector([0.1, 0.7, -0.3]),
        "s": 0.4,
    }
    f = ph.formula(text)
    slopes = dict(zip("aBs", f.grad("a", "B", "s")(values), strict=True))
    h = 2.0**-17
    for name, basis in {"a": (e1, e2, e3), "B": (e2 * e3, e3 * e1, e1 * e2), "s": (1.0,)}.items():
        for k, direction in enumerate(basis):
            ahead, behind = (float(f({**values, name: values[name] + s * h * direction})) for s in (1, -1))
            # Central differences: h² of a third derivative of size 10, and 8 eps f/h.
            assert abs((ahead - behind) / (2 * h) - slopes[name].components[k]) <= 20 * h * h + 80 * EPS / h


def test_each_row_of_a_batch_has_its_gradient():
    x, k = vectors(5), RNG.standard_normal(5)
    slopes = ph.formula("½ k x·x").grad("x")(x=x, k=k)
    assert slopes.shape == (5,)
    assert np.all((slopes - k * x).norm() <= 8 * EPS * 3)
    with pytest.raises(ValueError, match=r"shape \(5,\)"):
        ph.formula("½ k x·x").grad("x")(x=x[0], k=k)


def test_gradients_through_linear_maps_and_definitions():
    F = ph.LinearMap.from_matrix(RNG.standard_normal((3, 3)))
    a = vectors()
    slope = ph.formula("½ F(a)·a").grad("a")(F=F, a=a)
    assert slope.is_close(F.symmetric_part()(a), rtol=1e-14)
    f = ph.formula("V(x)", define={"V(x)": "½ x² + e1·x"})
    assert f.grad("x")(x=a).is_close(a + e1)


def test_formulas_without_a_gradient():
    with pytest.raises(TypeError, match=r"grades \(1,\)"):
        ph.formula("2 a").grad("a")(a=e1)
    with pytest.raises(TypeError, match="equation"):
        ph.formula("a = a").grad("a")(a=e1)
    with pytest.raises(TypeError, match="by b: no value with this name"):
        ph.formula("a²").grad("b")(a=e1)
    with pytest.raises(TypeError, match="by F: it is a linear map"):
        ph.formula("F(a)·a").grad("F")(F=ph.LinearMap.from_matrix(np.eye(3)), a=e1)
    with pytest.raises(TypeError, match="names"):
        ph.formula("a²").grad()
    with pytest.raises(TypeError, match="must differ"):
        ph.formula("a1²").grad("a1", "a_1")
    with pytest.raises(TypeError, match="floats"):
        ph.formula("a²").grad("a")(a=ph.vector([1, 2, 3], dtype=object))


@pytest.mark.usefixtures("_doubles")
def test_compiled_and_mapped():
    f = ph.formula("R a ~R + log(R)·a + 2 s a")
    R, a, s = random_rotors((4,)), vectors(4), RNG.standard_normal(4)
    expected = f(R=R, a=a, s=s)
    own = (
        ph.Rotor.from_components(jnp.asarray(R.components)),
        ph.vector(jnp.asarray(a.components)),
        jnp.asarray(s),
    )
    for g in (
        lambda R, a, s: f(R=R, a=a, s=s),
        jax.jit(lambda R, a, s: f(R=R, a=a, s=s)),
        jax.vmap(lambda R, a, s: f(R=R, a=a, s=s)),
        jax.jit(jax.vmap(lambda R, a, s: f(R=R, a=a, s=s))),
    ):
        got = g(*own)
        assert np.all(abs(np.asarray(got.components) - expected.components) <= 32 * EPS * 20)


@pytest.mark.usefixtures("_doubles")
def test_gradients_of_arrays_of_jax_are_theirs():
    f = ph.formula("½ x·x")
    x = ph.vector(jnp.asarray([1.0, 2.0, 3.0]))
    slope = f.grad("x")(x=x)
    assert isinstance(slope.components, jax.Array)
    assert np.array_equal(slope.components, [1.0, 2.0, 3.0])
    compiled = jax.jit(lambda x: f.grad("x")(x=x))(x)
    assert np.array_equal(compiled.components, [1.0, 2.0, 3.0])
    batch = ph.vector(jnp.asarray(RNG.standard_normal((4, 3))))
    mapped = jax.vmap(lambda x: f.grad("x")(x=x))(batch)
    assert np.array_equal(mapped.components, batch.components)
    # jax.grad of the formula itself has the same form.
    direct = jax.grad(lambda x: f(x=x).components[0])(x)
    assert np.array_equal(direct.components, slope.components)


@pytest.mark.usefixtures("_doubles")
def test_equations_are_traced():
    f = ph.formula("a b = a·b + a∧b")
    a, b = (ph.vector(jnp.asarray(x)) for x in ([1.0, 2, 3], [0.5, 0, 1]))
    assert bool(jax.jit(lambda a, b: f(a=a, b=b).holds)(a, b))
    assert not bool(jax.jit(lambda a, b: ph.evaluate("a b = b a", a=a, b=b).holds)(a, b))
    agreement = jax.jit(f)(a=a, b=b)
    assert isinstance(agreement, ph.Agreement)
    assert agreement
    assert agreement.rtol == 1e-9
    with pytest.raises(jax.errors.TracerBoolConversionError):
        jax.jit(lambda a, b: bool(f(a=a, b=b)))(a, b)
