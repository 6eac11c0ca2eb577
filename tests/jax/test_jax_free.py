"""The exact free flow under JAX: the same states, and derivatives, where formulas are singular too."""

import numpy as np
import pytest

import polhode as ph

jax = pytest.importorskip("jax")
jnp = jax.numpy

EPS = np.finfo(float).eps
MOMENTS, ROTOR, OMEGA = (
    np.array([1.0, 2.0, 3.0]),
    np.array([0.8, -0.4, 0.2, 0.4]),
    np.array([0.25, -0.5, 1.0]),
)
TIMES = np.array([0.0, 1e-3, 1.0, -7.5, 300.0])
# Bodies and starts at which formulas divide zero by zero.
SINGULAR = {
    "rest": ([1, 2, 3], [0, 0, 0]),
    "steady": ([1, 2, 3], [0, 0, 2]),
    "unstable": ([1, 2, 3], [0, 2, 0]),
    "small wobble": ([1, 2, 3], [1e-9, 0, 1]),
    "separatrix": ([2, 3, 8], [4, 0.3, np.sqrt(0.8)]),
    "symmetric": ([2, 2, 3], [0.25, -0.5, 1]),
    "symmetric, across": ([2, 2, 3], [0.25, -0.5, 0]),
    "sphere": ([2, 2, 2], [0.25, -0.5, 1]),
}


def seven(moments, rotor, omega, t, method="native"):
    return jnp.concatenate(ph.jax.free(moments, rotor, omega, t, method=method), axis=-1)


_forward = jax.jit(jax.jacfwd(seven, (0, 1, 2, 3)))
_reverse = jax.jit(jax.jacrev(seven, (0, 1, 2, 3)))


def states_of(motion, times):
    state = motion.at(times)
    return np.concatenate([state.rotor.components, state.omega_body.components], axis=-1)


def motion_of(moments, rotor, omega):
    inertia = ph.Inertia.from_principal_moments(*map(float, moments))
    return ph.FreeMotion(inertia, ph.Rotor.from_components(np.asarray(rotor)), np.asarray(omega, dtype=float))


def test_it_is_the_compiled_flow_to_the_last_bit():
    found = jax.jit(seven)(MOMENTS, ROTOR, OMEGA, TIMES)
    assert np.array_equal(found, states_of(motion_of(MOMENTS, ROTOR, OMEGA), TIMES))


def test_batches_times_and_vmap():
    rng = np.random.default_rng(0)
    omegas, times = rng.normal(size=(3, 1, 3)), rng.normal(size=(2, 4))
    rotor, omega = ph.jax.free(MOMENTS, np.stack([ROTOR, -ROTOR]), omegas, times)
    assert rotor.shape == (3, 2, 2, 4, 4)
    assert omega.shape == (3, 2, 2, 4, 3)
    assert np.array_equal(rotor[:, 1], -rotor[:, 0])
    # Each body at times of its own is one call.
    calls = []

    def flow(omega, t):
        calls.append(1)
        return seven(MOMENTS, ROTOR, omega, t)

    found = jax.vmap(flow)(omegas[:2, 0], times)
    expected = [seven(MOMENTS, ROTOR, w, t) for w, t in zip(omegas[:, 0], times, strict=False)]
    assert np.array_equal(found, expected)
    assert len(calls) == 1


def test_axes_of_a_body_that_are_not_principal():
    inertia = ph.Inertia.from_matrix([[2, 0.1, 0], [0.1, 3, 0.2], [0, 0.2, 4]])
    motion = ph.FreeMotion(inertia, ph.Rotor.from_components(ROTOR), OMEGA)
    found = seven(inertia, ph.Rotor.from_components(ROTOR), ph.bivector(OMEGA), TIMES)
    assert np.abs(found - states_of(motion, TIMES)).max() < 8 * EPS


def test_motions_that_do_not_exist_are_nan():
    for moments, rotor, omega, t in (
        ([1, 0, 3], ROTOR, OMEGA, 1.0),
        (MOMENTS, 0 * ROTOR, OMEGA, 1.0),
        (MOMENTS, ROTOR, [np.inf, 0, 0], 1.0),
        (MOMENTS, ROTOR, OMEGA, np.nan),
        (MOMENTS, ROTOR, OMEGA, 1e30),
    ):
        assert np.isnan(seven(np.array(moments, dtype=float), rotor, np.array(omega), t)).all()


# --- derivatives


def test_derivatives_are_those_of_the_closed_form():
    exact = motion_of(MOMENTS, ROTOR, OMEGA).derivatives(20.0)
    by_moments, by_rotor, by_omega, by_time = _forward(MOMENTS, ROTOR, OMEGA, 20.0)
    assert (
        np.abs(by_moments - np.concatenate([exact.d_rotor_d_moments, exact.d_omega_d_moments])).max() < 1e-13
    )
    assert np.abs(by_omega - np.concatenate([exact.d_rotor_d_omega, exact.d_omega_d_omega])).max() < 1e-13
    assert np.abs(by_time - np.concatenate([exact.d_rotor_dt, exact.d_omega_dt])).max() < 1e-14
    # exp(−½ε) R: the tangent −½ ε R of the start.
    start = ph.Rotor.from_components(ROTOR)
    for k, epsilon in enumerate(np.eye(3)):
        tangent = (-0.5 * (ph.bivector(epsilon) * start)).components
        assert np.abs(by_rotor[:4] @ tangent - exact.d_rotor_d_attitude[:, k]).max() < 8 * EPS
    assert np.abs(by_rotor @ ROTOR).max() < 8 * EPS  # nothing along the rotor
    assert np.array_equal(by_rotor[4:], np.zeros((3, 4)))


@pytest.mark.parametrize("scale", [1.0, 3.0])
def test_derivatives_hold_for_rotors_of_any_norm(scale):
    at = [MOMENTS, scale * ROTOR, OMEGA, np.array(20.0)]
    for k, slope in enumerate(_forward(*at)):
        for j, unit in enumerate(np.eye(at[k].size).reshape(-1, *at[k].shape)):
            sides = [seven(*at[:k], at[k] + h * unit, *at[k + 1 :]) for h in (1e-5, -1e-5)]
            difference = (sides[0] - sides[1]) / 2e-5
            assert np.abs(difference - np.reshape(slope, (7, -1))[:, j]).max() < 3e-7


@pytest.mark.parametrize("name", SINGULAR)
def test_derivatives_where_formulas_are_singular(name):
    at = [*(np.array(x, dtype=float) for x in SINGULAR[name]), np.array(0.5)]
    at.insert(1, ROTOR)
    slopes = _forward(*at)
    for slope, back in zip(slopes, _reverse(*at), strict=True):
        assert np.isfinite(slope).all()
        assert np.allclose(slope, back, rtol=0, atol=1e-13)
    for k in (0, 2):
        for j, unit in enumerate(np.eye(3)):
            sides = [seven(*at[:k], at[k] + h * unit, *at[k + 1 :]) for h in (1e-5, -1e-5)]
            # A central difference is off by h² times the third derivative, below 100 here, and by rounding/h.
            assert np.abs((sides[0] - sides[1]) / 2e-5 - slopes[k][:, j]).max() < 2e-8


def test_batches_of_gradients():
    omegas = np.random.default_rng(1).normal(size=(5, 3))

    def total(omega):
        return (seven(MOMENTS, ROTOR, omega, TIMES) ** 3).sum()

    found = jax.jit(jax.vmap(jax.grad(total)))(omegas)
    whole = jax.grad(lambda omegas: (seven(MOMENTS, ROTOR, omegas, TIMES) ** 3).sum())(omegas)
    assert np.allclose(found, whole, rtol=1e-13, atol=1e-11)


def test_second_derivatives_name_the_remedy():
    with pytest.raises(NotImplementedError, match='method="jax"'):
        jax.hessian(lambda t: seven(MOMENTS, ROTOR, OMEGA, t)[0])(1.0)


# --- in JAX alone


def _bodies(n):
    rng = np.random.default_rng(2)
    x = rng.uniform(0.05, 1, size=(n, 3))
    return x.sum(-1, keepdims=True) - x, rng.normal(size=(n, 4)), rng.normal(size=(n, 3))


_alone = jax.jit(lambda *at: seven(*at, method="jax"))


def test_series_in_jax_agree():
    cases = [np.array([case[k] for case in SINGULAR.values()], dtype=float) for k in (0, 1)]
    moments, rotors, omegas = _bodies(400)
    moments, rotors = np.concatenate([cases[0], moments]), np.concatenate([rotors[: len(SINGULAR)], rotors])
    omegas = np.concatenate([cases[1], omegas])
    times = np.array([0.0, 1e-3, 1.0, -3.0])
    difference = np.abs(_alone(moments, rotors, omegas, times) - seven(moments, rotors, omegas, times))
    bound = np.full(len(moments), 32 * EPS)
    # Near the separatrix the rounding of a start grows as e^(λt), λ being 4 there.
    bound[list(SINGULAR).index("separatrix")] = 1e4 * EPS
    assert (difference.max((1, 2)) < bound).all()
    # Phases are rounded, by half a unit for each radian, of which there are 1e4 times a few.
    late = moments, rotors, omegas, np.array([1e4, -1e4, 1.1e4, 0.9e4])
    apart = np.abs(_alone(*late) - seven(*late)).max((1, 2))
    assert np.median(apart) < 0.5 * EPS * 1e4 * 4
    moments[5, 1] = 0.0
    assert np.isnan(_alone(moments, rotors, omegas, times)[5]).all()


def test_single_precision():
    with jax.enable_x64(False):
        for method, bound in (("native", 1), ("jax", 64)):
            found = seven(MOMENTS, ROTOR, OMEGA, 3.0, method)
            assert found.dtype == np.float32
            exact = states_of(motion_of(MOMENTS, ROTOR, OMEGA), 3.0)
            assert np.abs(found - exact).max() < bound * np.finfo(np.float32).eps


def test_methods_have_names():
    with pytest.raises(ValueError, match="unknown method 'exact', expected one of native, jax"):
        seven(MOMENTS, ROTOR, OMEGA, 1.0, "exact")
