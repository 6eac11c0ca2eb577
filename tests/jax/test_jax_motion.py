"""Motion by steps under JAX: the steps of the compiled core, for laws, methods and batches."""

import sys

import numpy as np
import pytest

import polhode as ph
import processes

jax = pytest.importorskip("jax")
jnp = jax.numpy

EPS = np.finfo(float).eps
INERTIA = ph.Inertia.from_matrix([[2, 0.1, 0], [0.1, 3, 0.2], [0, 0.2, 4]])
MOMENTS = [2.0, 3.0, 4.0]
R0, OMEGA = ph.Rotor.from_components([4, 1, -2, 1]), np.array([0.5, 0.25, 3.0])
STATE = ph.State(R0, OMEGA)
ROWS = np.random.default_rng(0).normal(size=(5, 3))
ATTITUDE = {
    "heavy": ph.torque.heavy([0.5, 0.25, 1.0]),
    "gravity gradient": ph.torque.gravity_gradient(1.25),
    "gravity gradient, ellipse": ph.torque.gravity_gradient(1.25, 0.4, 0.5),
    "constant_body": ph.torque.constant_body([0.1, 0.2, 0.3]),
    "constant_space": ph.torque.constant_space([0.1, 0.2, 0.3]),
    "magnetic": ph.torque.magnetic([1, 0.2, 0.3], [0.3, 0.1, 0.4]),
    "torsion_spring": ph.torque.torsion_spring(0.5, ph.Rotor.from_components([1, 2, 0, 0])),
    "radiation_pressure": ph.torque.radiation_pressure(2.0, [0.3, -0.7, 0.2], [0.2, -0.4, 1.1], 1.5, 0.25),
    "damping": ph.torque.damping(0.25),
    "gyrostat": ph.torque.gyrostat([0.1, 0.2, 0.3]),
    "tabulated": ph.torque.tabulated([-1, 1.5, 3, 3.5, 5], ROWS),
    "spline": ph.torque.tabulated([-1, 1.5, 3, 3.5, 5], ROWS, "space", "cubic"),
    "parabola": ph.torque.tabulated([-1, 1.5, 5], ROWS[:3], "body", "cubic"),
    "held": ph.torque.tabulated([-1, 1.5, 3, 3.5, 5], ROWS, "space", "previous"),
    "formula": ph.torque.formula(
        "-c ∧ (~R e3 R) + k t I(B)", c=0.3 * ph.e1 + 2 * ph.e3, k=0.1, B=ph.I * ph.e2
    ),
}
RATE = {
    "larmor": ph.torque.larmor([0.1, -0.2, 0.3]),
    "viscous_damping": ph.torque.viscous_damping([0.1, 0.2, 0.3]),
    "quadratic_damping": ph.torque.quadratic_damping(0.1),
    "pd_control": ph.torque.pd_control([1, 2, 3], [0.1, 0.2, 0.3], ph.Rotor.from_components([2, 0, 1, 1])),
    "formula of rates": ph.torque.formula("⟨L_B Ω_B⟩_2 + norm(Ω) L - k Ω_S", frame="space", k=2),
}
TIMES = np.array([-0.7, 0.0, 0.0, 0.3, 1.7, 4.0])
STEP = 0.05
# Steps to the last time: the bounds allow a unit in the last place for each, some for those of many stages.
COUNT = 80


def apart(found, expected):
    """The largest difference in units of the last place, of the angular velocity relative to its size."""
    rotor, omega = found
    spin = np.abs(omega - expected.omega_body.components).max() / np.abs(expected.omega_body.components).max()
    return max(np.abs(rotor - expected.rotor.components).max(), spin) / EPS


@pytest.mark.parametrize("name", [*ATTITUDE, *RATE])
def test_torques_are_those_of_the_laws(name):
    law = {**ATTITUDE, **RATE}[name]
    # Nothing but wheels leaves the whole turn to Euler's equations: one tiny step gives the torque.
    h = 2.0**-20
    state = ph.State(R0, OMEGA)
    torque = law.at(INERTIA, state)
    turned = ph.bivector(OMEGA).commutator(INERTIA(ph.bivector(OMEGA)))
    expected = INERTIA.inverse(torque + turned).components
    with jax.disable_jit():
        ahead, back = (
            np.asarray(ph.jax.simulate(INERTIA, R0, OMEGA, [t], law, "rk4", steps=1)[1][0]) for t in (h, -h)
        )
    assert np.abs((ahead - back) / (2 * h) - expected).max() < 1e-8


def test_motion_under_many_laws_is_that_of_the_compiled_steps():
    names = (
        "heavy",
        "gravity gradient, ellipse",
        "torsion_spring",
        "damping",
        "gyrostat",
        "tabulated",
        "formula",
    )
    law = sum(ATTITUDE[name] for name in names)
    expected = ph.simulate(INERTIA, ph.State(R0, OMEGA), [0.3, 1.7, 4.0], law, method="strang", step=STEP)
    found = ph.jax.simulate(INERTIA, R0, OMEGA, [0.3, 1.7, 4.0], law, "strang", step=STEP)
    assert apart(found, expected) < COUNT


def test_times_on_both_sides_of_the_start():
    law = ATTITUDE["heavy"]
    expected = ph.simulate(INERTIA, ph.State(R0, OMEGA), TIMES, law, method="strang", step=STEP)
    found = ph.jax.simulate(INERTIA, R0, OMEGA, TIMES, law, "strang", step=STEP)
    assert apart(found, expected) < COUNT


@pytest.mark.slow
@pytest.mark.parametrize(
    ("method", "name"),
    [
        ("rk4", "gravity gradient, ellipse"),
        ("rk4", "formula"),
        ("strang", "tabulated"),
        *(
            pytest.param(*case, marks=pytest.mark.slow)
            for case in (
                ("rk4", "tabulated"),
                ("rk4", "spline"),
                ("strang", "gravity gradient, ellipse"),
                ("strang", "spline"),
                ("strang", "formula"),
            )
        ),
    ],
)
def test_a_motion_starts_at_the_time_of_the_state(method, name):
    law, state = ATTITUDE[name], ph.State(R0, OMEGA, time=0.5)
    expected = ph.simulate(INERTIA, state, TIMES, law, method=method, step=STEP)
    found = ph.jax.simulate(INERTIA, R0, OMEGA, TIMES, law, method, step=STEP, start_time=0.5)
    assert apart(found, expected) < 3 * COUNT
    if name in ("tabulated", "spline"):
        # Steps stop at the rows of a table, but where the start is traced.
        return
    # A traced start has one way, forth.
    later = jax.jit(
        lambda t: ph.jax.simulate(INERTIA, R0, OMEGA, TIMES[3:], law, method, steps=20, start_time=t)
    )
    known = ph.jax.simulate(INERTIA, R0, OMEGA, TIMES[3:], law, method, steps=20, start_time=0.25)
    for a, b in zip(later(0.25), known, strict=True):
        assert np.abs(a - b).max() < 4 * COUNT * EPS


@pytest.mark.parametrize("method", ["rk4", "strang"])
def test_steps_end_at_the_jumps_of_a_held_torque(method):
    # Both sides of the start; 1.5, 3 and 3.5 lie between output times.
    law = ATTITUDE["held"] + ATTITUDE["damping"]
    expected = ph.simulate(INERTIA, ph.State(R0, OMEGA), TIMES, law, method=method, step=STEP)
    found = ph.jax.simulate(INERTIA, R0, OMEGA, TIMES, law, method, step=STEP)
    assert apart(found, expected) < 4 * COUNT


@pytest.mark.slow
def test_a_motion_can_be_continued():
    law = ATTITUDE["formula"]
    whole = ph.jax.simulate(INERTIA, R0, OMEGA, [1.0, 2.0], law, step=STEP)
    start = whole[0][0], whole[1][0]
    rest = ph.jax.simulate(INERTIA, *start, [2.0], law, step=STEP, start_time=1.0)
    for a, b in zip(rest, whole, strict=True):
        assert np.abs(a[0] - b[1]).max() < 4 * COUNT * EPS
    # The end is a function of the start time too: -d/dt of both ends together.
    end = jax.jit(
        lambda t: ph.jax.simulate(INERTIA, R0, OMEGA, jnp.array([2.0]), law, steps=20, start_time=t)[1][0]
    )
    slope, h = jax.jacfwd(end)(1.0), 1e-5
    assert np.abs(slope - (end(1 + h) - end(1 - h)) / (2 * h)).max() < 1e-8


@pytest.mark.parametrize("time", [np.nan, np.inf])
def test_a_start_needs_a_time(time):
    with pytest.raises(ValueError, match=f"start_time is {time}; it must be finite"):
        ph.jax.simulate(INERTIA, R0, OMEGA, [1.0], step=STEP, start_time=time)


def test_compositions_under_torque_and_damping_are_those_of_the_compiled_steps():
    law = ATTITUDE["heavy"] + ATTITUDE["damping"] + ATTITUDE["gyrostat"]
    expected = ph.simulate(INERTIA, ph.State(R0, OMEGA), [4.0], law, method="kahan_li8", step=STEP)
    found = ph.jax.simulate(INERTIA, R0, OMEGA, [4.0], law, "kahan_li8", step=STEP)
    assert apart(found, expected) < 4 * COUNT


@pytest.mark.parametrize(
    "method", ["kahan_li6", *(pytest.param(name, marks=pytest.mark.slow) for name in ("strang", "yoshida6"))]
)
def test_free_motion_is_that_of_the_compiled_steps(method):
    state = ph.State(R0, OMEGA)
    inertia = ph.Inertia.from_principal_moments(*MOMENTS)
    expected = ph.simulate(inertia, state, [1.0, 3.0], method=method, step=STEP)
    found = ph.jax.simulate(MOMENTS, R0, OMEGA, [1.0, 3.0], method=method, step=STEP)
    assert apart(found, expected) < COUNT


def test_all_orders_of_moments_and_equal_ones():
    orders = [
        [2, 3, 4],
        [3, 2, 4],
        [4, 3, 2],
        [2, 4, 3],
        [3, 4, 2],
        [4, 2, 3],
        [2, 2, 3],
        [3, 2, 2],
        [2, 2, 2],
    ]
    law = ATTITUDE["heavy"] + ATTITUDE["gyrostat"]
    found = ph.jax.simulate(orders, R0, OMEGA, [2.0], law, "yoshida4", step=STEP)
    for k, moments in enumerate(orders):
        inertia = ph.Inertia.from_principal_moments(*moments)
        expected = ph.simulate(inertia, ph.State(R0, OMEGA), [2.0], law, method="yoshida4", step=STEP)
        assert apart([x[k] for x in found], expected) < 3 * COUNT


def test_runge_kutta_is_the_classical_one():
    law, count, h = np.array([0.5, 0.25, 1.0]), 40, 0.05
    state = np.array([*(R0.components * [1, -1, -1, -1]), *OMEGA])

    def slope(state):
        """A quaternion's rate and Euler's equations."""
        (w, x, y, z), omega = state[:4], state[4:]
        up = np.array([2 * (x * z - w * y), 2 * (y * z + w * x), w * w + z * z - x * x - y * y])
        turn = [-state[1:4] @ omega, *(w * omega + np.cross([x, y, z], omega))]
        momentum = np.multiply(MOMENTS, omega)
        return np.array(
            [*np.multiply(turn, 0.5), *((np.cross(momentum, omega) + np.cross(up, law)) / MOMENTS)]
        )

    for _ in range(count):
        k1 = slope(state)
        k2 = slope(state + 0.5 * h * k1)
        k3 = slope(state + 0.5 * h * k2)
        k4 = slope(state + h * k3)
        state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        state[:4] /= np.linalg.norm(state[:4])
    rotor, omega = ph.jax.simulate(
        MOMENTS, R0, OMEGA, [count * h], ph.jax.torque.heavy(law), "rk4", steps=count
    )
    assert np.abs(rotor[0] * np.array([1, -1, -1, -1]) - state[:4]).max() < count * EPS
    assert np.abs(omega[0] - state[4:]).max() < 3 * count * EPS


def test_batches_vmap_and_traced_times():
    rng = np.random.default_rng(1)
    cs, omegas = rng.normal(size=(4, 3)), rng.normal(size=(4, 3))

    @jax.jit
    @jax.vmap
    def mapped(c, omega):
        law = ph.jax.torque.heavy(c)
        return ph.jax.simulate(MOMENTS, R0, omega, np.array([0.5, 1.0]), law, "strang", step=STEP)

    batch = ph.jax.simulate(MOMENTS, R0, omegas, [0.5, 1.0], ph.jax.torque.heavy(cs), "strang", step=STEP)
    single = jax.jit(
        lambda c, omega, times: ph.jax.simulate(
            MOMENTS, R0, omega, times, ph.jax.torque.heavy(c), "strang", steps=10
        )
    )
    for a, b in zip(mapped(cs, omegas), batch, strict=True):
        assert np.abs(a - b).max() < 8 * EPS
    for k in range(4):
        for a, b in zip(single(cs[k], omegas[k], np.array([0.5, 1.0])), batch, strict=True):
            assert np.abs(a - b[k]).max() < 20 * EPS


def test_laws_of_a_batch_make_a_batch():
    rotor, omega = ph.jax.simulate(
        MOMENTS, R0, OMEGA, [1.0], ph.jax.torque.damping(np.array([0.1, 0.2, 0.3])), steps=2
    )
    assert rotor.shape == (3, 1, 4)
    assert omega.shape == (3, 1, 3)


def test_functions_of_the_motion():
    c = jnp.array([0.5, 0.25, 1.0])

    def law(t, rotor, omega):
        up = ph.Rotor._from_rows(rotor)
        return jnp.cross((~up)(ph.vector(jnp.array([0.0, 0, 1]))).components, c) - 0.25 * t * omega

    text = ph.jax.torque.formula("-c ∧ (~R e3 R) - k t Ω", c=ph.vector(c), k=0.25)
    for given in (law, jax.tree_util.Partial(law)):
        found = ph.jax.simulate(INERTIA, R0, OMEGA, [1.0], given, "rk4", steps=20)
        for a, b in zip(
            found, ph.jax.simulate(INERTIA, R0, OMEGA, [1.0], text, "rk4", steps=20), strict=True
        ):
            assert np.abs(a - b).max() < 60 * EPS


def test_a_body_under_gravity_turns_about_its_origin():
    body = ph.Body.cylinder(0.1, 0.4, mass=2.0).moved(position=[0, 0, 0.3])
    law = ph.torque.heavy([0, 0, 6.0])
    expected = ph.simulate(body, ph.State(R0, OMEGA), [0.2], law, method="strang", step=0.01)
    found = ph.jax.simulate(body, R0, OMEGA, [0.2], law, "strang", step=0.01)
    assert apart(found, expected) < 20


def test_single_precision():
    with jax.enable_x64(False):
        found = ph.jax.simulate(MOMENTS, R0, OMEGA, [1.0], ATTITUDE["heavy"], "strang", step=STEP)
        assert found[0].dtype == found[1].dtype == np.float32
    inertia = ph.Inertia.from_principal_moments(*MOMENTS)
    expected = ph.simulate(inertia, ph.State(R0, OMEGA), [1.0], ATTITUDE["heavy"], method="strang", step=STEP)
    assert apart(found, expected) < 20 * np.finfo(np.float32).eps / EPS


# --- what is refused


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"method": "dop853"}, "unknown method 'dop853', expected one of strang, .*, rk4"),
        ({"torque": RATE["larmor"]}, "kahan_li8 kicks at fixed attitude, .*; use rk4"),
        (
            {"torque": ATTITUDE["tabulated"], "times": [7.0]},
            "spans -1.0 s to 5.0 s, the motion 0.0 s to 7.0 s",
        ),
        ({"steps": 3}, "give either step, .*, or steps"),
        ({"step": None}, "give either step, .*, or steps"),
        ({"step": 0.0}, "step is 0.0; it must be positive and finite"),
        ({"step": None, "steps": 0}, "steps is 0; it must be a positive integer"),
        ({"times": [1.0, 0.5]}, r"times\[1\] = 0.5; times must be finite and must not decrease"),
        ({"times": [[1.0]]}, "times must be one-dimensional"),
        (
            {"omega_body": [1.0, 2.0]},
            r"the angular velocity needs 3 components in the last axis, got shape \(2,\)",
        ),
        (
            {"rotor": np.ones((2, 4)), "omega_body": np.ones((3, 3))},
            r"the batch shapes \(\) of .* do not broadcast",
        ),
    ],
)
def test_invalid_input_raises(change, message):
    given = {"inertia": MOMENTS, "rotor": R0, "omega_body": OMEGA, "times": [1.0], "step": 0.1, **change}
    with pytest.raises(ValueError, match=message):
        ph.jax.simulate(**given)


@pytest.mark.parametrize(
    ("rotor", "omega", "message"),
    [
        (STATE, [1.0], "the rotor must not be a State; pass state.rotor and state.omega_body"),
        (R0, STATE, "the angular velocity must not be a State"),
        (R0, "fast", "the angular velocity must be real numbers, got 'fast'"),
        (R0, [1j, 0, 0], r"the angular velocity must be real numbers, got \[1j, 0, 0\]"),
        (None, OMEGA, "the rotor must be real numbers, got None"),
    ],
)
def test_arguments_that_are_not_numbers_raise(rotor, omega, message):
    with pytest.raises(TypeError, match=message):
        ph.jax.simulate(MOMENTS, rotor, omega, [1.0], step=0.1)


@pytest.mark.parametrize(
    ("law", "message"),
    [
        (lambda law: law.damping(ph.e1), "g must be real numbers, got a multivector"),
        (lambda law: law.damping(None), "g must be real numbers, got None"),
        (lambda law: law.heavy(ph.e1 ^ ph.e2), r"c must be a vector, .*write B.dual\(\)"),
        (lambda law: law.constant_body(ph.e1), r"N must be a bivector, .*write a.undual\(\)"),
        (lambda law: law.tabulated([0, 1], "up"), "torques must be real numbers, got 'up'"),
    ],
)
def test_laws_name_arguments_of_another_kind(law, message):
    with pytest.raises(TypeError, match=message):
        law(ph.jax.torque)


def test_traced_times_need_a_number_of_steps():
    with pytest.raises(ValueError, match=r"with traced times .* give steps"):
        jax.jit(lambda t: ph.jax.simulate(MOMENTS, R0, OMEGA, t, step=0.1))(np.array([1.0]))


@pytest.mark.parametrize(
    ("torque", "message"),
    [
        (ph.torque.function(lambda t, R, Ω: Ω), "JAX cannot trace a law of polhode.torque.function"),
        (
            ph.torque.reaction_wheels([[0, 0, 1]], [0.01], 1e-3),
            "JAX has no law reaction_wheels; give a function",
        ),
        (3.0, "torque must be a law of polhode.jax.torque, such as heavy"),
    ],
)
def test_invalid_torques_raise(torque, message):
    with pytest.raises(TypeError, match=message):
        ph.jax.simulate(MOMENTS, R0, OMEGA, [1.0], torque, step=0.1)


@pytest.mark.parametrize(
    ("operation", "message"),
    [
        (lambda law: law + 1, r"got int; for a constant torque write constant_body\(N\) or constant_space"),
        (lambda law: law - law, r"polhode.jax.torque.Torque cannot be subtracted; change its parameters"),
        (lambda law: 2 * law, r"polhode.jax.torque.Torque cannot be multiplied by 2; change its param"),
        (lambda law: law + ph.torque.damping(1), r"cannot add a polhode.jax.torque.Torque and a polhode.tor"),
    ],
)
def test_operations_of_laws_name_what_to_write(operation, message):
    with pytest.raises(TypeError, match=message):
        operation(ph.jax.torque.damping(1.0))


def test_formulas_are_checked_at_construction():
    orbit = ph.torque.KeplerOrbit(7e6)
    with pytest.raises(TypeError, match="JAX has no law magnetic with orbit; give a function"):
        ph.jax.torque.magnetic([0, 0, 1], [0, 1, 0], orbit=orbit)
    with pytest.raises(ph.FormulaError, match="a torque must be a bivector"):
        ph.jax.torque.formula("~R e3 R")
    with pytest.raises(ValueError, match="got 'moon'"):
        ph.jax.torque.formula("Ω", frame="moon")


def test_the_extra_is_named():
    code = "import sys; sys.modules['jax'] = None; import polhode as ph; ph.jax"
    done = processes.run([sys.executable, "-c", code])
    assert "polhode.jax needs jax: pip install 'polhode[jax]'" in done.stderr
