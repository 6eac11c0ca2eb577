"""The kernel of `advance`: the steps of `simulate`, in blocks of bodies."""

import numpy as np
import pytest

import polhode as ph

jax = pytest.importorskip("jax")
from polhode.jax._fused import fused  # noqa: E402

jnp = jax.numpy
laws = ph.jax.torque

# More than a block, and no whole number of them.
BODIES, STEPS = 150, 12
EPS = np.finfo(float).eps
RNG = np.random.default_rng(0)
MOMENTS, ROTORS = RNG.uniform(2, 3, size=(BODIES, 3)), RNG.normal(size=(BODIES, 4))
OMEGAS = RNG.normal(size=(BODIES, 3))
HEAVY = [0.3, -0.2, 1.0]


@pytest.mark.parametrize(
    ("method", "dtype", "torque"),
    [
        pytest.param("rk4", "float64", HEAVY, marks=pytest.mark.slow),
        ("strang", "float32", HEAVY),
        ("kahan_li8", "float64", None),
    ],
)
def test_the_kernel_takes_the_steps_of_simulate(method, dtype, torque):
    law = None if torque is None else laws.heavy(np.array(torque, dtype)) + laws.damping(0.1)
    bodies = (x.astype(dtype) for x in (MOMENTS, ROTORS, OMEGAS))
    call = [*bodies, 1.5, law, method]
    found = ph.jax.advance(*call, steps=STEPS, kernel=True)
    times = np.array([1.5])
    expected = [x[:, 0] for x in ph.jax.simulate(*call[:3], times, law, method, steps=STEPS)]
    # The same operations in the same order; only what compilers fuse differs, by a rounding now and then.
    for a, b in zip(found, expected, strict=True):
        assert a.dtype == dtype
        assert a.shape == b.shape
        assert np.abs(a - b).max() < 4 * STEPS * np.finfo(dtype).eps


@pytest.mark.parametrize("method", ["rk4", pytest.param("strang", marks=pytest.mark.slow)])
def test_the_kernel_starts_at_any_time(method):
    law = laws.gravity_gradient(0.7, 0.3)
    call = MOMENTS, ROTORS, OMEGAS, 1.5, law, method
    found = ph.jax.advance(*call, steps=STEPS, kernel=True, start_time=0.4)
    looped = ph.jax.advance(*call, steps=STEPS, kernel=False, start_time=0.4)
    bodies = ph.State(ph.Rotor.from_components(ROTORS), OMEGAS, time=0.4)
    inertias = [ph.Inertia.from_principal_moments(*row) for row in MOMENTS]
    native = ph.torque.gravity_gradient(0.7, 0.3)
    expected = ph.simulate(inertias, bodies, [1.5], native, method=method, step=1.1 / STEPS).final
    for a, b in zip(found, looped, strict=True):
        assert np.abs(a - b).max() < 4 * STEPS * EPS
    assert np.abs(found[0] - expected.rotor.components).max() < 40 * STEPS * EPS
    assert np.abs(found[1] - expected.omega_body.components).max() < 40 * STEPS * EPS


def test_it_has_the_derivatives_of_the_steps():
    def end(c):
        call = MOMENTS[0], ROTORS[0], OMEGAS[0], 0.3, laws.heavy(c), "rk4"
        return ph.jax.advance(*call, steps=2, kernel=True)[0]

    c, direction, h = jnp.array(HEAVY), jnp.array([1.0, -2.0, 0.5]), 1e-5
    slope = jax.jvp(end, (c,), (direction,))[1]
    assert np.abs(slope - (end(c + h * direction) - end(c - h * direction)) / (2 * h)).max() < 1e-9


@pytest.mark.parametrize("method", ["rk4", pytest.param("kahan_li8", marks=pytest.mark.slow)])
def test_it_is_a_kernel_for_a_gpu(method, monkeypatch):
    """It is lowered to Triton code, which needs no GPU; whether a GPU runs it is not tested."""
    monkeypatch.setattr(jax, "default_backend", lambda: "gpu")

    def moved(omegas):
        return ph.jax.advance(MOMENTS, ROTORS, omegas, 1.5, laws.heavy(HEAVY), method, steps=STEPS)

    lowered = jax.jit(moved).trace(OMEGAS).lower(lowering_platforms=("cuda",))
    text = lowered.as_text()
    assert text.count("custom_call @__gpu$xla.gpu.triton") == 1
    assert "fma.rn.f64" in text


def test_products_are_joined_to_their_sums():
    seen = []

    def multiply_add(a, b, c, signs):
        seen.append("".join(signs))
        product, c = (x if sign == "+" else -x for x, sign in zip((a * b, c), signs, strict=True))
        return product + c

    @jax.custom_vjp
    def twice(x):
        return x * 2.0

    twice.defvjp(lambda x: (twice(x), None), lambda _, change: (2.0 * change,))

    def step(state, h):
        x, y = state
        y = twice(y) * 0.5
        # A scan with outputs is evaluated as it is.
        x = x + jax.lax.scan(lambda z, _: (z, z), x, None, length=2)[1][0] - x
        kept = x * y
        x, y = x * h + y, 2.0 - y * kept
        x = x * y - y * h
        return jax.lax.fori_loop(0, 3, lambda i, z: z * h - y, x) + kept, jnp.where(x > 0, y * y, kept)

    x, h = np.linspace(-1, 2, 8), 0.25
    found = jax.jit(fused(step, multiply_add))((x, x + 1), h)
    for a, b in zip(found, step((x, x + 1), h), strict=True):
        assert np.abs(a - b).max() < 8 * EPS
    # h is one number for all bodies: products with it are of the shape of the bodies, and join.
    assert sorted(seen) == ["++", "+-", "-+", "-+"]


def test_unsupported_arguments_of_the_kernel_raise():
    law = laws.tabulated([0, 2], np.zeros((2, 3)))
    with pytest.raises(ValueError, match="does not support torques by tables, formulas and functions"):
        ph.jax.advance(MOMENTS, ROTORS, OMEGAS, 1.5, law, steps=2, kernel=True)
    with pytest.raises(ValueError, match=r"steps is 1.5; it must be a positive integer"):
        ph.jax.advance(MOMENTS, ROTORS, OMEGAS, 1.5, steps=1.5)
