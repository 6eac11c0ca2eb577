"""Fits under torques: derivatives, parameters of laws, the scale of the moments, coverage, errors."""

import numpy as np
import pytest

import polhode as ph
from coverage_of_fits import check_coverage
from polhode._fit.free_flow import FreeFlow
from polhode._fit.laws import laws_of
from polhode._fit.parameters import Layout, Parameters
from polhode._fit.torqued_flow import TorquedFlow

pytest.importorskip("scipy")

BODY = ph.Inertia.from_principal_moments(1, 2, 2.6)
OMEGA = ph.bivector([0.3, 4.0, 0.9])
START = ph.Rotor.from_rotation_vector([0.3, -0.8, 0.5])
TIMES = np.linspace(0, 6, 80)
SIGMA = 0.02
DAMPING = ph.torque.viscous_damping([0.1, 0.2, 0.3])


def measured(torque, rng, kind="rates", times=TIMES, body=BODY):
    """Noisy data of the motion under a torque, as arguments of `fit`."""
    motion = ph.simulate(body, ph.State(START, OMEGA), times, torque, rtol=1e-12)
    if kind == "attitude":
        turns = ph.Rotor.from_rotation_vector(SIGMA * rng.normal(size=(len(times), 3)))
        return {"attitude": (times, turns * motion.rotor), "sigma_attitude": SIGMA}
    noise = SIGMA * rng.normal(size=(len(times), 3))
    return {"rates": (times, motion.omega_body.components + noise), "sigma_rates": SIGMA}


def flow(torque, free, layout):
    return TorquedFlow(layout, laws_of(torque, free), 0.0)


def test_differences_without_a_torque_are_the_exact_derivatives():
    """Errors are up to 1e-6 of the largest derivative by a parameter; see `TorquedFlow`."""
    layout = Layout(True, True, True, axes=True)
    frame = ph.Rotor.from_rotation_vector([0.5, 0.2, -0.7])
    at = Parameters(np.array([0.4, -0.3]), OMEGA.components, START, np.zeros(3), axes=frame)
    exact = FreeFlow(layout).derivatives(at, TIMES[::2], TIMES)
    found = flow(ph.torque.constant_body([0, 0, 0]), (), layout).derivatives(at, TIMES[::2], TIMES)
    for a, b in zip(exact, found, strict=True):
        # Columns of zeros, of rates by the attitude, differ by the error of the integration over the step.
        assert (np.abs(a - b).max(axis=(0, 1)) < 1e-6 * np.abs(a).max(axis=(0, 1)) + 1e-7).all()


def test_derivatives_of_a_damped_ball():
    """``ω = ω(0) exp(−g t)``: the derivative by g is ``−t ω``, by the scale 0."""
    layout = Layout(False, False, False, scale=True, torque=1)
    at = Parameters(np.zeros(2), OMEGA.components, None, np.zeros(3), torque=np.array([0.1]))
    _, rates, _ = flow(ph.torque.damping(0.1), ("damping",), layout).derivatives(at, np.empty(0), TIMES)
    wanted = -TIMES[:, None] * OMEGA.components * np.exp(-0.1 * TIMES)[:, None]
    assert np.abs(rates[..., layout.places["torque"].start] - wanted).max() < 1e-6 * np.abs(wanted).max()
    assert np.abs(rates[..., layout.places["scale"].start]).max() < 1e-6


@pytest.mark.slow
def test_derivatives_agree_with_forward_mode_of_jax():
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        times, d = TIMES[:15], np.array([0.1, 0.2, 0.3])

        def rates(d):
            law = ph.jax.torque.viscous_damping(d)
            return ph.jax.simulate(BODY, START, OMEGA, times, law, "rk4", step=0.005)[1]

        wanted = np.asarray(jax.jacfwd(rates)(d))
    layout = Layout(False, False, False, torque=3)
    moments = np.array([1, 2, 2.6])
    fractions = moments.sum() / 2 - moments
    shape = np.log(fractions[:2] / fractions[2])
    at = Parameters(shape, OMEGA.components, None, np.zeros(3), scale=np.log(2.6), torque=d)
    _, found, _ = flow(DAMPING, ("viscous_damping",), layout).derivatives(at, np.empty(0), times)
    # Steps of 0.005 s at 5 rad/s: (0.025)⁴ = 4e-7 is the error of the classical method.
    assert np.abs(found[..., layout.places["torque"]] - wanted).max() < 2e-6 * np.abs(wanted).max()


NEAR = (ph.Inertia.from_principal_moments(1, 1.8, 2.5), [0.3, 4, 1])


@pytest.mark.parametrize("start", [NEAR, pytest.param(None, marks=pytest.mark.slow)])
def test_damping_of_a_gyroscope_record(start):
    rng = np.random.default_rng(1)
    fit = ph.fit(
        **measured(DAMPING, rng),
        torque=ph.torque.viscous_damping([0.05, 0.06, 0.07]),
        free=["viscous_damping"],
        start=start,
    )
    truth = [1 / 2.6, 2 / 2.6, *OMEGA.components, 0.1 / 2.6, 0.2 / 2.6, 0.3 / 2.6, 0, 0, 0]
    assert fit.names[5:8] == tuple(f"viscous_damping.d_{k}" for k in (1, 2, 3))
    assert fit.units[5] == "N m s / (kg m²)"
    # Eleven parameters: each beyond 4.5 standard deviations with probability 7e-6.
    assert (np.abs(fit.values - truth) < 4.5 * fit.stderr).all()
    assert (fit.stderr[5:8] < 0.1 * fit.values[5:8]).all()
    assert fit.undetermined[0].startswith("overall scale of the moments: viscous_damping.d_1,")
    assert len(fit.undetermined) == 2
    # The result continues the motion.
    again = ph.simulate(fit.inertia, fit.state, TIMES, fit.torque).omega_body.components
    exact = ph.simulate(BODY, ph.State(START, OMEGA), TIMES, DAMPING).omega_body.components
    assert np.abs(again - exact).max() < 3 * SIGMA
    assert "viscous_damping.d_1" in fit.summary()
    assert "viscous_damping" in fit.to_dict()["torque"]
    if start is not None:
        pytest.importorskip("matplotlib")
        assert len(fit.plot().axes) == 1


def test_a_known_torque_determines_the_scale():
    """A constant torque N in the body: only ``I/N`` is observable, so that N known gives kg m²."""
    known = ph.torque.constant_body([0.4, 0.5, -0.6])
    data = measured(known, np.random.default_rng(2))
    start = (ph.Inertia.from_principal_moments(1.3, 2.2, 3), OMEGA)
    fit = ph.fit(**data, torque=known, start=start)
    assert fit.names[5] == "i3"
    assert fit.units[5] == "kg m²"
    assert abs(fit.values[5] - 2.6) < 4 * fit.stderr[5] < 0.4
    assert np.abs(fit.inertia.principal_moments - [1, 2, 2.6]).max() < 4 * fit.stderr[5]
    assert not any("scale" in text for text in fit.undetermined)
    # Free, the torque scales with the moments.
    fit = ph.fit(**data, torque=known, free=["constant_body"], start=start)
    assert "i3" not in fit.names
    assert "constant_body.N_1" in fit.undetermined[0]
    found = fit.values[[name.startswith("constant_body") for name in fit.names]]
    np.testing.assert_allclose(found * 2.6, [0.4, 0.5, -0.6], atol=0.1)


def test_two_scales_that_only_their_ratio_determines():
    """A formula with the square of its amplitude: singular values find what the rule of powers misses."""
    law = ph.torque.formula("-k k Ω_B", k=0.4)
    data = measured(law, np.random.default_rng(3))
    fit = ph.fit(**data, torque=law, free=["formula.k"], start=(BODY, OMEGA))
    (found,) = [x for x in fit.undetermined if "no information" in x or "uncertain" in x]
    assert found.startswith("a combination of ")
    assert "formula.k" in found
    assert "i3" in found


def test_attitude_under_weight():
    """Rates of a body under its weight show the vertical, but not the turn about it."""
    law = ph.torque.heavy([0.1, 0.2, -3])
    fit = ph.fit(
        **measured(law, np.random.default_rng(4)), torque=law, free=["heavy"], start=(BODY, OMEGA, START)
    )
    up, true = ((~x)(ph.vector([0, 0, 1])) for x in (fit.rotor, START))
    assert (up - true).norm() < 0.05
    (found,) = [x for x in fit.undetermined if "no information" in x]
    assert found == "attitude_3: no information"


SCALINGS = [
    (ph.torque.viscous_damping(0.1), ["viscous_damping"], [1]),
    (ph.torque.viscous_damping(0.1), [], None),
    (ph.torque.damping(0.1) + ph.torque.larmor([0, 0, 1]), ["larmor.b"], [0, 0, 0]),
    (
        ph.torque.damping(0.1) + ph.torque.viscous_damping([1, 2, 3]),
        ["damping", "viscous_damping"],
        [0, 1, 1, 1],
    ),
    (ph.torque.gravity_gradient(0.1), [], []),
    (ph.torque.pd_control(1, [2, 3, 4]), ["pd_control.kd"], None),
    (ph.torque.pd_control(1, [2, 3, 4]), ["pd_control"], [1, 1, 1, 1]),
    (ph.torque.constant_space([0, 0, 1]) + ph.torque.constant_space([1, 0, 0]), ["constant_space[1]"], None),
]


@pytest.mark.parametrize(("torque", "free", "powers"), SCALINGS)
def test_how_laws_scale_with_the_moments(torque, free, powers):
    found = laws_of(torque, free).scaling(0.0)
    assert (None if found is None else found.tolist()) == powers


def test_a_parameter_at_its_bound():
    """A body that is driven asks for a negative damping, which the law does not have."""
    driven = measured(ph.torque.formula("k Ω_B", k=0.01), np.random.default_rng(5))
    nothing = ph.torque.viscous_damping(0.0)
    fit = ph.fit(**driven, torque=nothing, free=["viscous_damping"], start=(BODY, OMEGA))
    k = fit.names.index("viscous_damping.d")
    assert 0 <= fit.values[k] < 0.01 * fit.stderr[k]
    assert fit.undetermined[-1].startswith("viscous_damping.d: at its bound 0")


def check(draws):
    law = ph.torque.viscous_damping([0.1, 0.2, 0.3]) + ph.torque.constant_body([0.4, 0.5, -0.6])
    truth = np.array([1 / 2.6, 2 / 2.6, *OMEGA.components, 2.6, 0.1, 0.2, 0.3, 0, 0, 0])
    rng = np.random.default_rng(18)
    options = {"torque": law, "free": ["viscous_damping"], "start": (BODY, OMEGA)}
    check_coverage(lambda: ph.fit(**measured(law, rng), **options), lambda fit: fit.values - truth, draws)


def test_intervals_under_a_torque_cover_the_truth():
    check(4)


@pytest.mark.slow
def test_intervals_under_a_torque_cover_the_truth_of_200_draws():
    check(200)


RATES = (TIMES, np.tile([0.1, 0.2, 0.3], (80, 1)))


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"free": ["damping"]}, ValueError, "give the torque with start values"),
        ({"torque": DAMPING, "free": "viscous_damping"}, TypeError, "must be a sequence of names"),
        (
            {"torque": DAMPING, "free": ["drag"]},
            ValueError,
            "'drag', which is not among .*: viscous_damping.d",
        ),
        ({"torque": DAMPING, "free": ["viscous_damping", "viscous_damping.d"]}, ValueError, "named twice"),
        ({"torque": ph.torque.damping([0.1, 0.2])}, ValueError, r"single body, got batch shape \(2,\)"),
        (
            {"torque": ph.torque.gravity(ph.Body.sphere(1, mass=1)), "free": ["gravity"]},
            ValueError,
            r"give ph.torque.heavy\(c\)",
        ),
        (
            {"torque": ph.torque.function(lambda t, R, w: -w), "free": ["function"]},
            ValueError,
            "none of its laws can be fitted",
        ),
    ],
)
def test_bad_torques(options, error, message):
    with pytest.raises(error, match=message):
        ph.fit(rates=RATES, sigma_rates=SIGMA, **options)
