"""Error estimates of random motions against references of extended precision."""

import re

import numpy as np
import pytest

import polhode as ph
from extended_precision import Case, final_states
from motions import moments

# Bound of the error: ten times the larger one of tolerance and estimate.
MARGIN = 10
TOLERANCES = [None, 1e-3, 1e-6, 1e-9, 1e-12]
COUNT = 12


def drawn(rng, size, count=3):
    """Normal numbers in eighths, so that double and extended precision start alike."""
    return tuple((np.round(rng.normal(size=count) * size * 8) / 8).tolist())


def body(rng):
    a, b = np.sort(rng.uniform(1, 2, 2))
    return tuple((np.round([a * 64, b * 64, rng.uniform(b - a + 0.1, a + b - 0.05) * 64]) / 64).tolist())


def attitude(rng):
    rotor = drawn(rng, 1, 4)
    return rotor if any(rotor) else (1, 0, 0, 0)


def top(rng):
    """Mostly chaotic motions."""
    return {"heavy": drawn(rng, 2)}, rng.uniform(5, 100)


def wheel_in_a_field(rng):
    """The motion amplifies rounding up to 1e10 times."""
    return {"wheel": drawn(rng, 2), "larmor": drawn(rng, 2)}, rng.uniform(5, 60)


def mixed(rng):
    laws = {"heavy": drawn(rng, 1), "constant_body": drawn(rng, 0.3)}
    return laws | {"larmor": drawn(rng, 1), "wheel": drawn(rng, 0.5)}, rng.uniform(5, 60)


def regular(rng):
    return {"heavy": drawn(rng, 0.1), "damping": rng.choice([0, 0.05, 0.2])}, rng.uniform(5, 60)


def driven(rng):
    return {"constant_space": drawn(rng, 0.5), "viscous": rng.uniform(0.1, 1)}, rng.uniform(5, 60)


def stiff(rng):
    return {"heavy": drawn(rng, 1), "viscous": rng.uniform(20, 100)}, rng.uniform(1, 5)


def at_rest(rng):
    laws = {"heavy": (0, 0, -2) if rng.random() < 0.5 else drawn(rng, 1), "omega": (0, 0, 0)}
    return laws | {"viscous": rng.choice([0, 0.1])}, rng.uniform(5, 30)


def hanging(rng):
    """Close to its stable equilibrium, by less than rounding or slightly more."""
    omega = tuple(rng.choice([0, 1e-14, 1e-9]) * x for x in drawn(rng, 1))
    return {"heavy": (0, 0, -2), "omega": omega, "rotor": (1, 0, 0, 0)}, rng.uniform(5, 30)


KINDS = [top, wheel_in_a_field, mixed, regular, driven, stiff, at_rest, hanging]


def draw(kind, rng):
    laws, duration = kind(rng)
    return Case(**({"moments": body(rng), "omega": drawn(rng, 2), "rotor": attitude(rng)} | laws)), duration


def law_of(case):
    """The torque laws of the reference."""
    torque = ph.torque
    makers = {
        "heavy": torque.heavy,
        "wheel": torque.gyrostat,
        "larmor": torque.larmor,
        "constant_body": torque.constant_body,
        "constant_space": torque.constant_space,
        "damping": torque.damping,
        "viscous": torque.viscous_damping,
    }
    laws = [maker(getattr(case, name)) for name, maker in makers.items() if np.any(getattr(case, name))]
    return sum(laws[1:], laws[0]) if laws else None


def rate_scale(case, omega):
    """The scale of errors of the angular velocity: the largest known rate, or the swing rate."""
    torque = sum(np.linalg.norm(getattr(case, name)) for name in ("heavy", "constant_body", "constant_space"))
    wheel = 1e-4 * np.linalg.norm(case.wheel) / min(case.moments)
    return max(np.linalg.norm(omega), np.linalg.norm(case.omega), np.sqrt(torque / max(case.moments)), wheel)


def answered(*problem, **how):
    """The motion, or None if the tolerance is not reached."""
    try:
        return ph.simulate(*problem, **how)
    except ValueError as refusal:
        if "not reached" not in str(refusal):
            raise
        return None


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_errors_stay_below_their_estimates(kind):
    rng = np.random.default_rng([KINDS.index(kind), 7])
    cases, durations = zip(*(draw(kind, rng) for _ in range(COUNT)), strict=True)
    rotors, omegas = final_states(cases, durations)
    wrong, answers = [], 0
    for i, (case, duration) in enumerate(zip(cases, durations, strict=True)):
        start = ph.State(
            ph.Rotor.from_components(np.array(case.rotor, float)), [float(x) for x in case.omega]
        )
        for rtol in TOLERANCES:
            found = answered(moments(*case.moments), start, [duration], law_of(case), rtol=rtol)
            if found is None:
                continue
            answers += 1
            estimate = found.certificate.error_estimate
            if estimate is None:
                continue
            assert estimate <= (rtol or 1e-6)
            turned = np.abs(found.rotor.components[-1] - rotors[i]).max()
            omega = found.omega_body.components[-1]
            spun = np.abs(omega - omegas[i]).max() / rate_scale(case, omega)
            error = float(max(turned, spun))
            if not error <= MARGIN * max(estimate, rtol or 1e-10):
                wrong.append((i, rtol, error, estimate))
    assert not wrong
    assert answers > COUNT


# --- motions that magnify rounding

ONE = ph.Rotor.identity()
ASYMMETRIC = moments(1, 2, 2.5)


def test_a_motion_dominated_by_rounding_is_rejected():
    law = ph.torque.gyrostat([4.5, 0, 2]) + ph.torque.larmor([3, -2, -2])
    with pytest.raises(ValueError, match=r"rtol = 1.0e-6 was not reached"):
        ph.simulate(ASYMMETRIC, ph.State(ONE, [1, -1, 5]), [50.0], law, rtol=1e-6)
    many = ph.simulate(ASYMMETRIC, ph.State(ONE, [[1, -1, 5], [0, 0, 0.1]]), [50.0], law, rtol=1e-6)
    assert [failure.index for failure in many.failures] == [(0,)]


def test_the_error_of_a_tolerance_below_rounding_names_one_that_is_reached():
    problem = ASYMMETRIC, ph.State(ONE, [1.0, 0.7, 0.4]), [10.0], ph.torque.heavy([0.3, 0.2, 1.5])
    with pytest.raises(ValueError, match="because the motion amplifies rounding") as refused:
        ph.simulate(*problem, rtol=1e-14)
    least = float(re.search("use rtol >= (.*) or", str(refused.value))[1])
    assert least < 1e-12
    assert ph.simulate(*problem, rtol=least).certificate.error_estimate <= least


@pytest.mark.parametrize("max_step", [0.1, 0.2])
def test_steps_shorter_than_the_tolerance_needs_have_an_estimate(max_step):
    """A smaller tolerance does not shorten them, so the sum of the errors of all steps is the estimate."""
    problem = ASYMMETRIC, ph.State(ONE, [1.0, 0.7, 0.4]), [10.0], ph.torque.heavy([0.3, 0.2, 1.5])
    exact = ph.simulate(*problem, rtol=1e-12).rotor.components
    found = ph.simulate(*problem, method="dop853", rtol=1e-3, max_step=max_step)
    error = np.abs(found.rotor.components - exact).max()
    assert 1e-13 < error <= found.certificate.error_estimate <= 1e-3


@pytest.mark.parametrize("heavy", [[0.3, 0.2, 1.0], [-0.5, 2, 1.5]])
def test_the_error_of_a_chaotic_motion_names_a_time_that_is_reached(heavy):
    state, law = ph.State(ONE, [0.1, 0.5, 0.3]), ph.torque.heavy(heavy)
    times = np.linspace(0, 1000, 401)
    with pytest.raises(ValueError, match="still differ completely") as refused:
        ph.simulate(ASYMMETRIC, state, times, law)
    until = float(re.search("agree up to t = (.*) s; ", str(refused.value))[1])
    assert 10 < until < 1000
    assert ph.simulate(ASYMMETRIC, state, times[times <= until], law).certificate.error_estimate <= 1e-6


def test_chaotic_motion_is_rejected_or_reported():
    """The default call reported an error of 3e-5 as 7e-11."""
    state, law = ph.State(ONE, [3, 2, -1]), ph.torque.heavy([-0.5, 2, 1.5])
    with pytest.raises(ValueError, match=r"amplifies rounding"):
        ph.simulate(ASYMMETRIC, state, [100.0], law)
    rotors, _ = final_states([Case((1, 2, 2.5), (3, 2, -1), heavy=(-0.5, 2, 1.5))], [100.0])
    found = ph.simulate(ASYMMETRIC, state, [100.0], law, rtol=1e-3)
    error = np.abs(found.rotor.components[-1] - rotors[0]).max()
    assert 1e-6 < error < MARGIN * found.certificate.error_estimate
    assert found.certificate.error_estimate <= 1e-3


@pytest.mark.parametrize("method", ["auto", "dop853"])
def test_a_steady_torque_is_summed_without_drift(method):
    """ω3 = ω0 + (N/i3) t, over 250,000 rad: with equal rounding in every step the error was 9e-9."""
    N, duration = 0.7, 1000.0
    body = moments(1, 1, 1e-2)
    state = ph.State(ONE, [0, 0, 0.25])
    how = {"rtol": 1e-6} if method == "dop853" else {}
    law = ph.torque.constant_body([0, 0, N * 1e-2])
    found = ph.simulate(body, state, [duration], law, method=method, **how)
    acceleration = np.longdouble(N * 1e-2) / np.longdouble(1e-2)
    omega = np.longdouble(0.25) + acceleration * np.longdouble(duration)
    # The sum itself is rounded once, the kicks by the products that they are.
    assert abs(found.omega_body.components[-1, 2] / omega - 1) < 4 * np.finfo(float).eps
    angle = np.longdouble(0.25) * duration + acceleration * np.longdouble(duration) ** 2 / 2
    error = abs(found.rotor.components[-1, 0] - np.cos(angle / 2))
    assert error < found.certificate.error_estimate


# --- bodies at rest

RESTING = {
    "a pendulum": (ph.torque.heavy([0, 0, -2]), [0, 0, 0]),
    "a pendulum by a formula": (ph.torque.formula("-(~R e3 R)∧(-2 e3)"), [0, 0, 0]),
    "a pendulum that trembles": (ph.torque.heavy([0, 0, -2]), [1e-14, 0, 0]),
    "a compass": (ph.torque.magnetic([0, 0, 1], [0, 0, 1]), [0, 0, 0]),
    "a spring": (ph.torque.torsion_spring(2.0), [0, 0, 0]),
    "a damped pendulum": (ph.torque.heavy([0, 0, -2]) + ph.torque.viscous_damping(0.1), [0, 0, 0]),
}


@pytest.mark.parametrize("name", RESTING)
def test_a_body_rests_in_its_equilibrium(name):
    law, omega = RESTING[name]
    start = ph.State(ONE, omega)
    batch = ph.State(ONE, [omega, omega])
    for found in (ph.simulate(BODY, start, [10.0], law), ph.simulate(BODY, batch, [10.0], law)):
        assert np.max(found.certificate.error_estimate) < 1e-10
        # The swing of a rate of 1e-14 rad/s, and rounding.
        assert np.abs(found.rotor.components[..., 1:]).max() < 2e-14


BODY = moments(1, 1.5, 2)


def test_a_tilted_hanging_body_rests_to_rounding():
    """After a rounded rotation its torque is a rounding error of gravity's."""
    hanging = ph.Rotor.from_vectors(ph.vector([1, 2, -2]), -ph.e3)
    found = ph.simulate(BODY, ph.State(hanging, [0, 0, 0]), [10.0], ph.torque.heavy([1, 2, -2]))
    assert found.certificate.error_estimate < 1e-10
    assert np.abs(found.rotor.components[-1] - hanging.components).max() < 1e-14


# --- laws that depend on time


def push(law, how, duration=60.0):
    body = moments(1, 1, 1)
    return ph.simulate(body, ph.State(ONE, [0, 0, 0]), [duration], law, **how).omega_body.components[-1, 2]


@pytest.mark.parametrize("how", [{}, {"rtol": 1e-6}, {"method": "kahan_li8"}], ids=str)
@pytest.mark.parametrize(("at", "width"), [(37.3, 0.1), (11.123, 0.03), (50.7, 0.01)])
def test_a_short_pulse_is_resolved(at, width, how):
    """A Gaussian of the impulse 0.4 N m s, on a body at rest."""
    height = 0.4 / (width * np.sqrt(np.pi))
    # Errors are relative to the rate at which the largest torque makes the body swing.
    scale = np.sqrt(height)
    formula = ph.torque.formula("A exp(-((t-T)/s)²) e1e2", A=height, T=at, s=width)
    assert push(formula, how) == pytest.approx(0.4, abs=how.get("rtol", 1e-10) * scale)
    if "method" not in how:
        law = ph.torque.function(
            lambda t, R, omega: ph.bivector([0, 0, height * np.exp(-(((t - at) / width) ** 2))])
        )
        assert push(law, how) == pytest.approx(0.4, abs=how.get("rtol", 1e-10) * scale)


@pytest.mark.parametrize("how", [{"max_step": 2e-3}, {"breaks": [20.0, 20.002]}], ids=str)
def test_a_shorter_pulse_needs_max_step_or_breaks(how):
    """A millisecond in a minute is too short for sampling."""
    width = 3e-4
    law = ph.torque.formula("A exp(-((t-T)/s)²) e1e2", A=0.4 / (width * np.sqrt(np.pi)), T=20.001, s=width)
    assert push(law, how) == pytest.approx(0.4, rel=1e-9)


@pytest.mark.parametrize("many", [False, True])
def test_a_fixed_step_too_long_for_its_law_is_reported(many):
    omega = [[1, 2, 3], [1, 2, 3]] if many else [1, 2, 3]
    state, law = ph.State(ONE, omega), ph.torque.formula("sin(100 t) e1e2")
    with pytest.warns(RuntimeWarning, match=r"`sin\(100 t\) e1e2` changes too fast for step = 0.1 s") as seen:
        found = ph.simulate(BODY, state, [10.0], law, method="rk4", step=0.1)
    assert len(found.certificate.warnings) == 1
    assert seen[0].filename == __file__  # the line that called, not one of the package
    # A sixteenth of a turn of the sine in a step is followed.
    assert not ph.simulate(BODY, state, [10.0], law, method="rk4", step=0.004).certificate.warnings


# --- runs that would not end


def test_a_run_predicted_to_be_too_long_is_rejected():
    state, law = ph.State(ONE, [1e100, 2e100, 1]), ph.torque.larmor([1, 2, 3])
    with pytest.raises(ValueError, match=r"the run would take .* steps .* more than max_steps = 1e8"):
        ph.simulate(BODY, state, [10.0], law, method="dop853")


def test_max_steps_is_enforced():
    state, law = ph.State(ONE, [1, 2, 3]), ph.torque.larmor([1, 2, 3])
    with pytest.raises(ValueError, match="max_steps = 1e3"):
        ph.simulate(BODY, state, [1000.0], law, max_steps=1000)
    for how, match in (
        ({"max_steps": 0}, "max_steps is 0"),
        ({"max_step": -1}, "max_step is -1"),
        ({"breaks": [1.0, np.nan]}, "breaks"),
        ({"breaks": 1.0}, "breaks must be one-dimensional"),
    ):
        with pytest.raises(ValueError, match=match):
            ph.simulate(BODY, state, [1.0], law, **how)


@pytest.mark.parametrize("many", [False, True])
def test_stiff_damping_uses_the_midpoint_rule(many):
    """With d/i ≫ 1/s gravity and damping balance: ω = N/d."""
    d = 1e5
    law = ph.torque.heavy([0, 1, 0]) + ph.torque.viscous_damping(d)
    omega = [[1, 2, 3], [3, 2, 1]] if many else [1, 2, 3]
    found = ph.simulate(BODY, ph.State(ONE, omega), [10.0], law)
    assert found.certificate.method == "midpoint"
    gamma = ph.vector([0, 0, 1])
    weight = (~found.rotor)(gamma).wedge(ph.vector([0, 1, 0])).components[..., -1, :]
    # The correction is of the relative size (N i/d²).
    np.testing.assert_allclose(found.omega_body.components[..., -1, :], weight / d, rtol=0, atol=1e-12)


@pytest.mark.parametrize("method", ["rk4", "dop853", "kahan_li8", "midpoint"])
@pytest.mark.parametrize("batch", [(), (20,)])
def test_steps_in_which_the_body_turns_too_far_are_reported(method, batch):
    """A rate of 1 rad/s: 1.9 and 2.1 rad a step."""
    state, law = ph.State(ONE, np.broadcast_to([1e-3, 1, 1e-3], (*batch, 3))), ph.torque.heavy([0, 0, 1e-6])
    for step, is_reported in ((1.9, False), (2.1, True), (5.0, False)):
        if is_reported:
            with pytest.warns(RuntimeWarning, match=r"step = 2\.1 s the body turns by more than 2 rad"):
                motion = ph.simulate(BODY, state, [4 * step], law, method=method, step=step)
        else:
            # Steps end at the output times.
            motion = ph.simulate(BODY, state, np.arange(1, 5) * min(step, 1.9), law, method=method, step=step)
        assert len(motion.certificate.warnings) == is_reported


def test_the_turns_of_a_symmetric_body_are_exact():
    """Its steps may be as long as the torque allows, but not those of another method."""
    body = ph.Inertia.from_principal_moments(2, 2, 3)
    state, law = ph.State(ONE, [0.01, 0, 100]), ph.torque.gravity_gradient(1e-3)
    motion = ph.simulate(body, state, [100.0], law, method="rkn6", step=1.0)
    assert motion.certificate.warnings == ()
    with pytest.warns(RuntimeWarning, match="turns by more than 2 rad"):
        ph.simulate(body, state, [1.0], law, method="rk4", step=0.025)


# A regular motion of a top with a wheel.
WHEEL = Case((1, 2, 3), (0.125, 0.25, 0.375), heavy=(0.125, 0, 0.25), wheel=(0.25, 0.5, 2))
WHEEL_START = moments(1, 2, 3), ph.State(ONE, WHEEL.omega)


@pytest.mark.parametrize("method", ["kahan_li8", "yoshida6"])
def test_many_steps_with_a_wheel_round_without_a_bias(method):
    """The turn about the axis of the wheel is the same number in every step: its rounding must not add up."""
    step = 100 / 32000
    motion = ph.simulate(*WHEEL_START, [100.0], law_of(WHEEL), method=method, step=step)
    # The random rounding of some 300 thousand turns and kicks.
    assert motion.certificate.drift["vertical_angular_momentum"] <= 1000 * np.finfo(float).eps


@pytest.mark.parametrize(("method", "duration"), [("auto", 1000), ("yoshida6", 200)])
def test_the_estimate_counts_the_rounding_with_a_wheel(method, duration):
    [rotor], [omega] = final_states([WHEEL], [duration])
    found = ph.simulate(*WHEEL_START, [float(duration)], law_of(WHEEL), method=method)
    turned = np.abs(found.rotor.components[-1] - rotor).max()
    spun = np.abs(found.omega_body.components[-1] - omega).max() / rate_scale(WHEEL, omega)
    assert max(turned, spun) <= 3 * found.certificate.error_estimate


@pytest.mark.parametrize("method", ["midpoint", "strang", "dmv"])
def test_estimates_of_order_two_are_not_below_the_error(method):
    """Sweeps of order 2 with steps of 1 to 1.3 differ by less than the error of the finer one."""
    rng = np.random.default_rng(8)
    for _ in range(6):
        inertia = ph.Inertia.from_principal_moments(*body(rng))
        state = ph.State(ph.Rotor.from_components(attitude(rng)), drawn(rng, 1))
        law = ph.torque.heavy(drawn(rng, 1))
        found = ph.simulate(inertia, state, [2.0], law, method=method, rtol=1e-5)
        exact = ph.simulate(inertia, state, [2.0], law, rtol=1e-12)
        error = np.abs(found.rotor.components - exact.rotor.components).max()
        assert error <= found.certificate.error_estimate
