"""Derivatives through whole motions, by every array argument; where formulas are singular too."""

import numpy as np
import pytest

import polhode as ph

jax = pytest.importorskip("jax")
jnp = jax.numpy
laws = ph.jax.torque

ROTOR, OMEGA = np.array([0.8, -0.4, 0.2, 0.4]), np.array([0.5, 0.25, 1.0])
STEPS, TIME = 16, 0.8


def seven(law, method, moments, rotor, omega):
    found = ph.jax.simulate(moments, rotor, omega, [TIME], law, method, steps=STEPS)
    return jnp.concatenate([x[0] for x in found])


def attitude(p):
    """Laws of the attitude with parameters p (9,); the spring at rest at the start."""
    return (
        laws.heavy(p[:3])
        + laws.damping(p[3])
        + laws.torsion_spring(p[4], ROTOR)
        + laws.gyrostat(p[5:8])
        + laws.gravity_gradient(p[8])
    )


def rate(p):
    """Laws of the rate of turning with parameters p (9,)."""
    return (
        laws.viscous_damping(p[:3])
        + laws.quadratic_damping(p[3])
        + laws.pd_control(p[4], p[5], ROTOR)
        + laws.larmor(p[6:])
    )


# Moments and angular velocities: all different; equal ones, at rest, and without any turn.
PLACES = {
    "any": ([1.5, 2.0, 2.5], OMEGA, 0.3),
    "symmetric": ([2.0, 2.0, 3.0], OMEGA, 0.3),
    "sphere": ([2.0, 2.0, 2.0], [0.0, 0.0, 1.0], 0.3),
    "nothing moves": ([1.5, 2.0, 2.5], [0.0, 0.0, 0.0], 0.0),
}


@pytest.mark.slow
@pytest.mark.parametrize(("make", "method"), [(attitude, "strang"), (rate, "rk4")])
def test_derivatives_are_slopes(make, method):
    def motion(x):
        return seven(make(x[10:]), method, x[:3], x[3:7], x[7:10])

    points = np.array([np.concatenate([i, ROTOR, w, np.full(9, p)]) for i, w, p in PLACES.values()])
    slopes = jax.jit(jax.vmap(jax.jacfwd(motion)))(points)
    assert np.isfinite(slopes).all()
    h = 1e-5
    around = points[:, None, None, :] + h * np.array([[1.0], [-1.0]])[:, None] * np.eye(19)
    states = jax.jit(jax.vmap(motion))(around.reshape(-1, 19)).reshape(len(points), 2, 19, 7)
    # A central difference is off by h² times the third derivative and by rounding/h.
    differences = (states[:, 0] - states[:, 1]) / (2 * h)
    error = np.abs(np.swapaxes(differences, 1, 2) - slopes)
    for k, name in enumerate(PLACES):
        # Where nothing moves the loss has a kink in the size of a vector: |x| x, off by h.
        bound = 2 * h if name == "nothing moves" else 1e-8
        assert error[k].max() < bound, name


def test_gradients_in_reverse_are_slopes():
    def loss(c, g):
        law = laws.heavy(c) + laws.damping(g)
        rotor, omega = ph.jax.simulate([1.5, 2.0, 2.5], ROTOR, OMEGA, [0.4, TIME], law, "strang", steps=8)
        return (rotor[..., 0] ** 2).sum() + (omega**2).sum()

    at = np.array([0.3, -0.1, 1.0]), np.array(0.1)
    by_c, by_g = jax.jit(jax.grad(loss, (0, 1)))(*at)
    value, h = jax.jit(loss), 1e-5
    for k, unit in enumerate(np.eye(3)):
        assert (
            abs(by_c[k] - (value(at[0] + h * unit, at[1]) - value(at[0] - h * unit, at[1])) / (2 * h)) < 1e-8
        )
    assert abs(by_g - (value(at[0], at[1] + h) - value(at[0], at[1] - h)) / (2 * h)) < 1e-8


def test_a_function_may_close_over_traced_values():
    def loss(k):
        spring = ph.jax.simulate(
            [1.5, 2.0, 2.5], ROTOR, OMEGA, [TIME], lambda t, R, w: -k * w, "rk4", steps=4
        )
        return spring[1].sum()

    found = jax.jvp(loss, (0.3,), (1.0,))[1]
    assert abs(found - (loss(0.3 + 1e-5) - loss(0.3 - 1e-5)) / 2e-5) < 1e-8


@pytest.mark.slow
def test_tables_and_formulas_have_derivatives():
    times, rows = [0.0, 0.2, 0.5, 0.9, 1.0], np.random.default_rng(0).normal(size=(5, 3))

    def loss(rows, k):
        law = laws.tabulated(times, rows, kind="cubic") + laws.formula("k (R e1 ~R) ∧ e3", k=k, frame="space")
        return ph.jax.simulate([1.5, 2.0, 2.5], ROTOR, OMEGA, [TIME], law, "strang", step=0.1)[1].sum()

    direction = np.random.default_rng(1).normal(size=(5, 3))
    slope = jax.jvp(loss, (rows, 0.5), (direction, 1.0))[1]
    ahead, back = (loss(rows + h * direction, 0.5 + h) for h in (1e-5, -1e-5))
    assert abs(slope - (ahead - back) / 2e-5) < 1e-8


def test_times_have_derivatives():
    def end(time):
        rotor, omega = ph.jax.simulate([1.5, 2, 2.5], ROTOR, OMEGA, time[None], method="rk4", steps=20)
        return jnp.concatenate([rotor[0], omega[0]])

    slope = jax.jacfwd(end)(jnp.asarray(TIME))
    inertia = ph.Inertia.from_principal_moments(1.5, 2, 2.5)
    exact = ph.FreeMotion(inertia, ph.Rotor.from_components(ROTOR), OMEGA).derivatives(TIME)
    # The method's own slope differs by its error, of order 4 in steps of 0.04.
    assert np.abs(slope - np.concatenate([exact.d_rotor_dt, exact.d_omega_dt])).max() < 1e-6


def test_a_motion_outside_jit_is_one_program():
    moments, law = np.array([1.0, 2.0, 3.0]), laws.heavy([0.1, 0.0, 1.0])

    def back_and_forth(omega):
        return ph.jax.simulate(moments, ROTOR, omega, [-0.5, 0.0, 0.3, 0.3, 0.8], law, "strang", step=0.1)

    motions = (
        lambda omega: ph.jax.free(moments, ROTOR, omega, [0.0, 0.3]),
        back_and_forth,
        lambda omega: ph.jax.advance(moments, ROTOR, omega, TIME, law, "rk4", steps=4, kernel=False),
    )
    for motion in motions:
        started = [equation.primitive.name for equation in jax.make_jaxpr(motion)(OMEGA).jaxpr.eqns]
        assert started.count("jit") == 1
        assert len(started) <= 2  # `advance` joins the two times
