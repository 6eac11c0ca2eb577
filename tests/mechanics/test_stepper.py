"""`Stepper` against `simulate` with the torque held, of one body and of batches."""

import numpy as np
import pytest

import polhode as ph
from motions import EPS, R0

BODY = ph.Inertia.from_principal_moments(1.0, 2.0, 2.5)
OBLIQUE = ph.Inertia.from_matrix([[2.0, 0.1, 0.2], [0.1, 3.0, -0.3], [0.2, -0.3, 2.5]])
START = ph.State(R0, [0.3, -0.5, 1.0])
METHODS = ["rk4", "dop853", "strang", "kahan_li8", "midpoint"]


def torques(n, seed=1):
    return np.random.default_rng(seed).standard_normal((n, 3))


def chained(body, state, rows, dt, method, law=None, held=ph.torque.constant_body, step=None):
    """The states after each step, by one run of `simulate` for each torque."""
    states = []
    for row in rows:
        acting = held(ph.bivector(row))
        state = ph.simulate(
            body,
            state,
            [state.time + dt],
            acting if law is None else law + acting,
            method=method,
            # A little longer, since the difference of two times may be a rounding more than dt.
            step=(step or dt) * (1 + 1e-9),
        ).final
        states.append(state)
    return states


def difference(a, b):
    return max(float(np.max((a.rotor - b.rotor).norm())), float(np.max((a.omega_body - b.omega_body).norm())))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("body", [BODY, OBLIQUE], ids=["principal", "oblique"])
def test_steps_are_those_of_simulate(body, method):
    stepper = ph.Stepper(body, START, method=method)
    rows = torques(20)
    for row, expected in zip(rows, chained(body, START, rows, 0.1, method), strict=True):
        found = stepper.step(0.1, torque=row)
        # Each of twenty steps rounds by a few ulps.
        assert difference(found, expected) <= 100 * EPS
        assert found.time == stepper.time == pytest.approx(expected.time, abs=4 * EPS)
        assert found == stepper.state


def test_torques_in_space():
    stepper, rows = ph.Stepper(OBLIQUE, START), torques(10)
    for row, expected in zip(
        rows, chained(OBLIQUE, START, rows, 0.1, "rk4", held=ph.torque.constant_space), strict=True
    ):
        assert difference(stepper.step(0.1, ph.bivector(row), frame="space"), expected) <= 64 * EPS


def test_laws_act_besides():
    law = ph.torque.gravity_gradient(0.3) + ph.torque.damping(0.1)
    stepper, rows = ph.Stepper(BODY, START, law), torques(10)
    for row, expected in zip(rows, chained(BODY, START, rows, 0.1, "rk4", law), strict=True):
        assert difference(stepper.step(0.1, row), expected) <= 64 * EPS


def test_long_steps_are_divided():
    stepper, rows = ph.Stepper(BODY, START, step=0.03), torques(5)
    for row, expected in zip(rows, chained(BODY, START, rows, 0.1, "rk4", step=0.03), strict=True):
        assert difference(stepper.step(0.1, row), expected) <= 64 * EPS


LAWS = {
    "free": None,
    "gradient": ph.torque.gravity_gradient(0.3),
    "formula": ph.torque.formula("-0.2 Ω_B"),
    "function": ph.torque.function(lambda t, R, omega: -0.1 * omega),
}


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
@pytest.mark.parametrize("count", [1, 2, 7, 8, 9, 17])
def test_bodies_of_a_batch_do_not_depend_on_each_other(count, law):
    rng = np.random.default_rng(4)
    bodies = [ph.Inertia.from_principal_moments(*(1 + 0.2 * rng.random(3))) for _ in range(count)]
    state = ph.State(ph.Rotor.random(count, rng=3), rng.standard_normal((count, 3)))
    batch = ph.Stepper(bodies, state, law)
    single = [ph.Stepper(body, one, law) for body, one in zip(bodies, state, strict=True)]
    for k in range(5):
        held = torques(count, seed=k)
        found = batch.step(0.05, held)
        assert found.shape == (count,)
        for i, stepper in enumerate(single):
            # Products and sums are fused in lanes.
            assert difference(found[i], stepper.step(0.05, held[i])) <= 32 * EPS


def test_batches_share_bits_with_their_parts():
    state = ph.State(ph.Rotor.random((3, 4), rng=3), torques(12).reshape(3, 4, 3))
    whole, part = ph.Stepper(BODY, state), ph.Stepper(BODY, state[1])
    for _ in range(3):
        assert whole.step(0.1, [0.1, 0.2, 0.3])[1] == part.step(0.1, [0.1, 0.2, 0.3])


def test_centres_of_mass_move():
    body = ph.Body(2.0, BODY)
    state = ph.State(R0, [0.1, 0.2, 0.3], position=[1, 2, 3], velocity=[4, 5, 6], time=7.0)
    steppers = {
        "uniform": (ph.Stepper(body, state), [0, 0, 0]),
        "constant": (ph.Stepper(body, state, force=[0, 0, -4.0]), [0, 0, -2.0]),
    }
    for stepper, acceleration in steppers.values():
        for _ in range(4):
            found = stepper.step(0.25)
        expected = np.array([5, 7, 9]) + 0.5 * np.array(acceleration)
        np.testing.assert_allclose(found.position.components, expected, rtol=0, atol=32 * EPS)
        assert found.time == 8.0
    force = ph.force.drag(0.3)
    dragged = ph.Stepper(body, state, force=force).step(0.1)
    expected = ph.simulate(body, state, [7.1], force=force, method="rk4", step=0.1).final
    np.testing.assert_allclose(
        dragged.position.components, expected.position.components, rtol=0, atol=16 * EPS
    )


def test_reset_sets_state_and_time():
    stepper = ph.Stepper(BODY, START)
    first = stepper.step(0.1, [1, 0, 0])
    stepper.step(0.1)
    stepper.reset(START)
    assert stepper.time == 0.0
    assert stepper.state == START
    assert stepper.step(0.1, [1, 0, 0]) == first
    later = ph.State(R0, [0, 0, 1], position=[1, 0, 0], velocity=[1, 0, 0], time=5)
    stepper.reset(later)
    assert stepper.step(0.5).position.components[0] == 1.5
    assert str(stepper) == "Stepper(t = 5.5 s)"
    with pytest.raises(ValueError, match=r"batch shape \(2,\), but the stepper \(\)"):
        stepper.reset(ph.State(ph.Rotor.identity(2), [0, 0, 1]))
    with pytest.raises(TypeError, match="State"):
        stepper.reset(START.rotor)


def test_steps_back_return():
    stepper = ph.Stepper(BODY, START)
    stepper.step(0.01)
    # Of order 4: two errors of ω⁵h⁵/100 or so.
    assert difference(stepper.step(-0.01), ph.State(R0, START.omega_body)) <= 1e-11


def test_convergence_of_order_4():
    def error(dt):
        stepper = ph.Stepper(BODY, START)
        for _ in range(round(1 / dt)):
            stepper.step(dt)
        return difference(stepper.state, ph.FreeMotion(BODY, START.rotor, START.omega_body).at(1.0))

    assert error(0.1) / error(0.05) == pytest.approx(16, rel=0.25)


def test_the_time_of_many_steps_is_their_product():
    """A sum of rounded tenths would miss 100 s by more than 1e-12."""
    stepper = ph.Stepper(BODY, START, step=0.1)
    for _ in range(1000):
        stepper.step(0.1)
    assert stepper.time == 100.0


# --- errors


def test_steps_that_turn_too_far_are_errors():
    stepper = ph.Stepper(BODY, START)
    before = stepper.state
    with pytest.raises(ValueError, match=r"turns by 5\.79 rad in a step of 5 s.*step="):
        stepper.step(5.0)
    assert stepper.state == before
    assert ph.Stepper(BODY, START, step=0.01).step(5.0).time == 5.0
    spins = ph.State(ph.Rotor.identity(10), [[0, 0, 1.0]] * 9 + [[0, 0, 30.0]])
    with pytest.raises(ValueError, match=r"at index \(9,\): .*turns by 3\.00 rad"):
        ph.Stepper(BODY, spins).step(0.1)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"method": "exact"}, "unknown method 'exact', expected one of auto, "),
        ({"method": "euler"}, "unknown method 'euler'"),
        ({"step": 0.0}, "step must be positive, got 0.0"),
        ({"method": "strang", "torque": ph.torque.viscous_damping(1.0)}, "strang does not support torques"),
        ({"state": ph.State(ph.Rotor.identity(2), [0, 0, 1], time=[0, 1])}, "one time, got 0.0 s to 1.0 s"),
        ({"state": ph.State(ph.Rotor.identity(0), np.zeros((0, 3)))}, "at least one body"),
    ],
)
def test_bad_arguments(arguments, message):
    with pytest.raises(ValueError, match=message):
        ph.Stepper(**({"body": BODY, "state": START} | arguments))


def test_bad_steps():
    stepper = ph.Stepper(BODY, START)
    with pytest.raises(ValueError, match="dt must be finite, got nan"):
        stepper.step(np.nan)
    with pytest.raises(ValueError, match="frame must be 'body' or 'space', got"):
        stepper.step(0.1, [0, 0, 1], frame="world")
    with pytest.raises(ValueError, match=r"torque has batch shape \(2,\), but the stepper \(\)"):
        stepper.step(0.1, np.zeros((2, 3)))
    with pytest.raises(TypeError, match="bivector"):
        stepper.step(0.1, ph.e1)
    for law in (ph.torque.damping(0.1), lambda t, rotor, omega_body: -omega_body):
        with pytest.raises(TypeError, match=r"give a law or a function to Stepper\(body, state, torque\)"):
            stepper.step(0.1, law)
    with pytest.raises(ValueError, match=r"the torque is \[0\.0, NaN, 1\.0\]; it must be finite"):
        stepper.step(0.1, [0, np.nan, 1])
    two = ph.Stepper(BODY, ph.State(ph.Rotor.random(2, rng=1), [0, 0, 1]))
    with pytest.raises(ValueError, match=r"at index \(1,\): the torque is \[inf, 0\.0, 0\.0\]"):
        two.step(0.1, [[0, 0, 0], [np.inf, 0, 0]])
    assert stepper.time == two.time == 0


def test_exceptions_of_functions_are_raised():
    def law(t, R, omega):
        raise RuntimeError("no torque today")

    stepper = ph.Stepper(BODY, START, law)
    with pytest.raises(RuntimeError, match="no torque today"):
        stepper.step(0.1)
    assert stepper.state == START
