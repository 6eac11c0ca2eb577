"""Exact free motion against 40-digit references, integration and symmetries."""

import itertools
import json

import numpy as np
import pytest

import polhode as ph
from motions import EPS, REFERENCE

# Moments, body angular velocity, rotor (not normalised), time; then rotor and angular velocity at that
# time to 17 digits, from two independent computations of 40 digits. Inputs are exact in binary.
STATES = {
    "short axis": (
        (1, 2, 3), (0.25, -0.5, 1), (4, -2, 1, 2), 100.0,
        (-0.5689013652823799, 0.04932891658575123, -0.6489054854610942, 0.5028315478436312),
        (0.5543582317102606, -0.0720204896892067, 1.0400020911941998),
    ),
    "long axis, unsorted, backwards": (
        (2, 3, 1), (-0.25, 0.125, -1.5), (-1, 3, 2, 1), 100.0,
        (0.003405198025580956, -0.9284455967283075, 0.18053438924196574, -0.32462980892588084),
        (0.12094956364601608, 0.17771344261088629, -1.515873082765783),
    ),
    "1 - k = 1e-12": (
        (1, 2, 2.25), (0.375, 0.5, 0.5000000000009095), (1, 0, 0, 0), 100.0,
        (0.4444496053479648, -0.27360460588121965, -0.7907019833617825, -0.31999287719317143),
        (-0.047303209599782195, 0.7719899713752101, 0.06307094614025302),
    ),
    "nearly a sphere": (
        (1, 1.0000000001164153, 1.0000000002328306), (0.5, -0.25, 1), (4, -2, 1, 2), 100.0,
        (0.6819108565656078, -0.35556500746230496, 0.6160697078712616, -0.17037964728719365),
        (0.5000000029103829, -0.2499999883584678, 1.0000000014551915),
    ),
    "needle": (
        (1, 1000, 1000.5), (2, 0.5, 0.25), (4, -2, 1, 2), 100.0,
        (-0.6576496279418405, 0.25644062631215075, -0.3280943722762135, -0.6277652864927051),
        (2.003618770931741, 0.47014692354538584, 0.30237876189269186),
    ),
    "a thousand million seconds": (
        (1, 2, 3), (0.25, -0.5, 1), (4, -2, 1, 2), 1000000000.0,
        (0.2979651321850726, -0.4704826974953505, -0.3988898489584956, 0.728525702880344),
        (0.048772583071188653, -0.5568852980107879, 0.9899290824531213),
    ),
}  # fmt: skip


def numbers(texts):
    return np.array([float(x) for x in texts])


def motion_of(moments, omega, rotor=(1.0, 0.0, 0.0, 0.0)):
    inertia = ph.Inertia.from_principal_moments(*moments)
    return ph.FreeMotion(inertia, ph.Rotor.from_components(rotor), ph.bivector(omega))


def errors(motion, times, rotors, omegas):
    state = motion.at(times)
    size = max(np.abs(omegas).max(), 1e-300)
    return np.abs(state.rotor.components - rotors).max(), np.abs(
        state.omega_body.components - omegas
    ).max() / size


def reference_cases():
    cases = json.loads(REFERENCE.read_text())["free_top"]
    return [pytest.param(case, id=case["name"]) for case in cases]


@pytest.mark.parametrize("case", reference_cases())
def test_reference_motions(case):
    """Error 5e-15, near the separatrix too; decimal inputs add their rounding, which grows with time."""
    motion = motion_of(numbers(case["inertia"]), numbers(case["omega0"]), numbers(case["R0"]))
    for result in case["results"]:
        t = float(result["t"])
        # 0.01 is not a binary number: off by 1e-18, it shifts the flips of this case by 1e-18/0.01 each.
        inputs = 1e-17 * t * 0.1 if "001" in case["name"] else 0.0
        rotor, omega = errors(motion, t, numbers(result["R"]), numbers(result["omega"]))
        assert rotor <= 5e-15 + 10 * inputs
        assert omega <= 5e-15 + 10 * inputs


@pytest.mark.parametrize("case", reference_cases())
def test_reference_periods(case):
    """Period, modulus and mean precession to 8 roundings."""
    info = case.get("info", {})
    if "period" not in info:
        pytest.skip("no periods for this kind of motion")
    facts = motion_of(numbers(case["inertia"]), numbers(case["omega0"])).describe()
    decimal = 1e-13 if "001" in case["name"] else 0.0
    assert facts["period"] == pytest.approx(float(info["period"]), rel=8 * EPS + decimal)
    assert facts["precession_rate"] == pytest.approx(
        float(info["mean_precession_rate"]), rel=8 * EPS + decimal
    )
    assert facts["modulus"] == pytest.approx(float(info["k"]), rel=8 * EPS + decimal)


def bodies():
    """Return moments and angular velocities of every regime, in every order of the axes, of either sign."""
    kinds = {
        "short axis": ((1, 2, 3), (0.25, -0.5, 1.0)),
        "long axis": ((1, 2, 3), (1.0, 0.5, -0.25)),
        "near separatrix": ((1, 2, 3), (2**-20, 1.0, 2**-20)),
        "separatrix": ((1, 2, 2.25), (0.375, 0.5, 0.5)),
        "needle": ((1, 1000, 1000.5), (2.0, 0.5, 0.25)),
        "needle about its short axis": ((1, 1000, 1000.5), (2**-10, 0.5, 2.0)),
        "plate": ((1, 1, 2), (0.5, -0.25, 1.0)),
        "rod-like": ((2, 2, 1), (0.5, -0.25, 1.0)),
        "nearly a plate": ((1, 1 + 2**-33, 2), (0.5, -0.25, 1.0)),
        "nearly a sphere": ((1, 1 + 2**-33, 1 + 2**-32), (0.5, -0.25, 1.0)),
        "sphere": ((2, 2, 2), (0.5, -0.25, 1.0)),
        "middle axis": ((1, 2, 3), (0.0, 1.0, 0.0)),
        "tiny wobble": ((1, 2, 3), (2**-30, 2**-31, 1.0)),
    }
    for name, (moments, omega) in kinds.items():
        for order in itertools.permutations(range(3)):
            for signs in ((1, 1, 1), (-1, 1, -1), (1, -1, -1)):
                turned = [omega[k] * signs[k] for k in order]
                yield pytest.param([moments[k] for k in order], turned, id=f"{name} {order} {signs}")


@pytest.mark.parametrize(("moments", "omega"), list(bodies()))
def test_agrees_with_steps(moments, omega):
    """Steps of order 8 to t = 6, forwards and backwards: their error there is below 1e-12."""
    inertia = ph.Inertia.from_principal_moments(*moments)
    state = ph.State(ph.Rotor.from_components([4, -2, 1, 2]), ph.bivector(omega))
    times = np.array([-6.0, -0.7, 0.0, 1.3, 6.0])
    exact = ph.FreeMotion(inertia, state.rotor, state.omega_body).at(times)
    steps = ph.simulate(inertia, state, times, method="kahan_li8", step=1 / 128)
    assert np.abs(exact.rotor.components - steps.rotor.components).max() <= 1e-12
    assert np.abs(exact.omega_body.components - steps.omega_body.components).max() <= 1e-12


@pytest.mark.parametrize(("moments", "omega"), list(bodies()))
def test_energy_and_momentum_stay(moments, omega):
    """L in space and E at any time: errors are a few roundings, weighted by the moments."""
    motion = motion_of(moments, omega, (4, -2, 1, 2))
    times = np.concatenate([[0.0], np.geomspace(1e-3, 1e12, 60), -np.geomspace(1e-3, 1e12, 60)])
    state = motion.at(times)
    inertia = ph.Inertia.from_principal_moments(*moments)
    momentum = state.rotor(inertia(state.omega_body)).components
    energy = (np.array(moments) * state.omega_body.components**2).sum(axis=1)
    size = np.linalg.norm(momentum[0])
    assert np.abs(momentum - momentum[0]).max() <= 64 * EPS * size
    # An error δω costs the energy m·δω, which is less than |m||δω|.
    spin = np.linalg.norm(omega)
    assert np.abs(energy - energy[0]).max() <= 64 * EPS * size * spin


@pytest.mark.parametrize(("moments", "omega"), list(bodies()))
def test_rotor_is_continuous_and_its_rate_is_the_spin(moments, omega):
    """R' = −½ R Ω_B by central differences of order 4, across several periods."""
    motion = motion_of(moments, omega, (4, -2, 1, 2))
    t, h = np.linspace(0.0, 40.0, 801), 2.0**-9
    at = {k: motion.at(t + k * h).rotor.components for k in (-2, -1, 1, 2)}
    slope = (8 * (at[1] - at[-1]) - (at[2] - at[-2])) / (12 * h)
    state = motion.at(t)
    expected = (-0.5 * state.rotor * state.omega_body).components
    # Truncation h⁴ |R⁽⁵⁾|/30 with rates up to 4, rounding of each state over h.
    assert np.abs(slope - expected).max() <= h**4 * 4.0**5 / 30 + 32 * EPS / h


def test_long_times_repeat_whole_periods():
    """A body whose period is exactly 2π n/… is the same at t and at t plus many periods."""
    # Symmetric, i1 = 1, i3 = 2: |L| and Ω_r are known, and at(t) must follow the product of exponentials.
    inertia = ph.Inertia.from_principal_moments(1, 1, 2)
    rotor, omega = ph.Rotor.identity(), ph.bivector([0.75, 0.0, 0.5])
    # L = (0.75, 0, 1), |Ω_l| = 1.25 exactly, Ω_r = −0.5 e1e2: a common period of 8π in the rotor.
    period = 16 * np.pi
    free = ph.FreeMotion(inertia, rotor, omega)
    for n in (1, 1000, 10**6):
        # n·period as a float is off by up to half an ulp, and turns the body by that times 1.25.
        t = n * period
        assert (free.at(t).rotor - rotor).norm() <= 4 * EPS * t + 4 * EPS


@pytest.mark.parametrize("exponent", [-150, -60, 0, 60, 150])
def test_scaling_by_powers_of_two_is_exact(exponent):
    """Powers of two in moments and rates scale out exactly, at both ends of the range of floats."""
    unit = 2.0**exponent
    plain = motion_of((1, 2, 3), (0.25, -0.5, 1)).at(7.0)
    heavy = motion_of((unit, 2 * unit, 3 * unit), (0.25, -0.5, 1)).at(7.0)
    fast = motion_of((1, 2, 3), (0.25 * unit, -0.5 * unit, unit)).at(7.0 / unit)
    assert heavy.rotor == plain.rotor
    assert heavy.omega_body == plain.omega_body
    assert fast.rotor == plain.rotor
    assert fast.omega_body == plain.omega_body * unit


def test_principal_axes_may_lie_anywhere():
    """Rotating the body axes rotates the description only."""
    turn = ph.Rotor.random(rng=5)
    plain = motion_of((1, 2, 3), (0.25, -0.5, 1), (4, -2, 1, 2))
    matrix = turn.to_matrix() @ np.diag([1.0, 2.0, 3.0]) @ turn.to_matrix().T
    rotor = ph.Rotor.from_components([4, -2, 1, 2]) * ~turn
    inertia = ph.Inertia.from_matrix(0.5 * (matrix + matrix.T))
    turned = ph.FreeMotion(inertia, rotor, turn(ph.bivector([0.25, -0.5, 1])))
    for t in (0.0, 3.0, 50.0):
        # The matrix's moments are off by a few ulps, which adds up along the phase.
        assert (turned.at(t).rotor * turn - plain.at(t).rotor).norm() <= 64 * EPS * (1 + t)


@pytest.mark.parametrize(("moments", "omega", "regime"), [
    ((1, 2, 3), (0, 0, 0), "at rest"),
    ((1, 2, 3), (0, 0, -2), "steady rotation about a fixed axis"),
    ((2, 2, 2), (1, 2, 3), "steady rotation about a fixed axis"),
    ((1, 1, 2), (3, 4, 0), "steady rotation about a fixed axis"),
    ((1, 2, 2.25), (0.375, 0.5, 0.5), "separatrix"),
    ((1, 2, 2.25), (0.375, 0.5, 0.51), "short-axis mode"),
    ((1, 2, 2.25), (0.375, 0.5, 0.49), "long-axis mode"),
    ((2, 2, 1), (1, 0, 5), "symmetric top, regular precession"),
])  # fmt: skip
def test_regime_names(moments, omega, regime):
    assert motion_of(moments, omega).describe()["regime"] == regime


def test_the_spin_tends_to_the_middle_axis_on_the_separatrix():
    motion = motion_of((1, 2, 2.25), (0.375, 0.5, 0.5))
    for t in (200.0, -200.0):
        omega = motion.at(t).omega_body.components
        # All energy in the middle axis: ω = G/i2 there, and sech(λt) elsewhere.
        assert abs(omega[1]) == pytest.approx(np.sqrt(2 * 0.6015625 / 2), rel=8 * EPS)
        assert np.abs(omega[[0, 2]]).max() < 1e-15


@pytest.mark.parametrize("tiny", [1e-13, 1e-16, 1e-20, 1e-60, 1e-140])
@pytest.mark.parametrize("pattern", [(1, 0, 0), (0, 0, 1), (1, 0, 1)])
def test_any_disturbance_causes_flips(tiny, pattern):
    """Half a period away the spin has reversed, at any distance from the separatrix."""
    motion = motion_of((1, 2, 3), [p * tiny + m for p, m in zip(pattern, (0, 1, 0), strict=True)])
    period = motion.describe()["period"]
    # K = ln(4/k') to the accuracy of k'², and k' is proportional to the disturbance: λ is 1/√3.
    assert period == pytest.approx(4 * np.sqrt(3) * np.log(4 / tiny), rel=0.02)
    assert motion.at(period / 2).omega_body.components[1] == pytest.approx(-1, abs=1e-12)
    assert motion.at(period).omega_body.components == pytest.approx([pattern[0] * tiny, 1, pattern[2] * tiny])


def test_the_phase_is_known_up_to_the_horizon():
    motion = motion_of((1, 1, 1.5), (0.1, 1, 0.2))
    # |L| is an integral of the motion at 1e16 as at 0; at 1e30 the phase is lost.
    assert np.isfinite(motion.at(1e16).rotor.components).all()
    for t in (1e30, -1e300):
        with pytest.raises(ValueError, match=r"times\[0\] = .* is beyond"):
            motion.at(t)
        with pytest.raises(ValueError, match="is beyond"):
            ph.simulate(
                ph.Inertia.from_principal_moments(1, 1, 1.5),
                ph.State(ph.Rotor.identity(), [0.1, 1, 0.2]),
                [t],
            )


def test_rates_beyond_floating_point_are_refused():
    state = ph.State(ph.Rotor.identity(), [1e308, 1e308, 1e307])
    with pytest.raises(ValueError, match="energy of the rotation"):
        ph.simulate(ph.Inertia.from_principal_moments(1, 2, 2.5), state, [0.0, 1.0])


def test_batches_of_times():
    motion = motion_of((1, 2, 3), (0.25, -0.5, 1))
    times = np.arange(6.0).reshape(2, 3)
    batch = motion.at(times)
    assert batch.rotor.shape == (2, 3)
    for index in np.ndindex(2, 3):
        assert batch.rotor[index] == motion.at(times[index]).rotor
        assert batch.omega_body[index] == motion.at(times[index]).omega_body
    assert motion.at(np.zeros(0)).rotor.shape == (0,)
    # More states than between two checks for Ctrl-C, over all threads.
    many = np.linspace(-1e6, 1e6, 600_000)
    batch = motion.at(many)
    for index in (0, 1, 299_999, 524_287, 524_288, 599_999):
        assert batch.rotor[index] == motion.at(many[index]).rotor
        assert batch.omega_body[index] == motion.at(many[index]).omega_body


def test_bad_input_is_refused():
    inertia = ph.Inertia.from_principal_moments(1, 2, 3)
    with pytest.raises(ValueError, match="time NaN at index 1"):
        motion_of((1, 2, 3), (1, 1, 1)).at([0.0, np.nan])
    with pytest.raises(ValueError, match="must be finite"):
        ph.FreeMotion(inertia, ph.Rotor.identity(), ph.bivector([np.inf, 0, 0]))
    with pytest.raises(TypeError, match="Rotor"):
        ph.FreeMotion(inertia, [1, 0, 0, 0], ph.bivector([1, 0, 0]))
    with pytest.raises(TypeError, match="Inertia"):
        ph.FreeMotion(ph.Body.sphere(1.0, mass=1.0), ph.Rotor.identity(), ph.bivector([1, 0, 0]))
    with pytest.raises(ValueError, match="component"):
        ph.FreeMotion(inertia, ph.Rotor.identity(), [1, 0])
    with pytest.raises(TypeError, match="bivector"):
        ph.FreeMotion(inertia, ph.Rotor.identity(), ph.e1)


@pytest.mark.parametrize("case", STATES.values(), ids=STATES.keys())
def test_known_states(case):
    moments, omega, rotor, t, rotor_then, omega_then = case
    found_rotor, found_omega = errors(motion_of(moments, omega, rotor), t, rotor_then, omega_then)
    assert found_rotor <= 5e-15
    assert found_omega <= 5e-15


@pytest.mark.parametrize("thin", [1e-280, 1e-290, 1e-307, 5e-324])
def test_the_thinnest_needle_is_a_symmetric_top(thin):
    """Against eq. (4.35), without invariants of degree 4; times to 3 with rates to 2 add 6 roundings."""
    times = np.array([-3.0, 0.3, 1.0, 3.0])
    for moments, omega in (
        ((1, 1, thin), (1, 0.5, 0.25)),
        ((1, thin, 1), (0, 2, 0.001)),
        ((thin, 1, 1), (1, 1, 0)),
    ):
        inertia, start = ph.Inertia.from_principal_moments(*moments), ph.Rotor.from_components([4, -2, 1, 2])
        found = ph.FreeMotion(inertia, start, omega).at(times)
        expected = ph.SymmetricTop(inertia, start, omega).at(times)
        assert np.abs(found.rotor.components - expected.rotor.components).max() <= 16 * EPS
        assert np.abs(found.omega_body.components - expected.omega_body.components).max() <= 32 * EPS


@pytest.mark.parametrize("tiny", [5e-324, 1e-310, 1e-200, 1e-150])
def test_the_least_spin_beside_the_middle_axis_flips_it(tiny):
    """At (1, 2, 3), from ω = (δ, 1, 0): k' = δ, λ² = 1/3, a flip takes 2K/λ with K = ln(4/δ)."""
    motion, rate = motion_of((1, 2, 3), (tiny, 1.0, 0.0)), np.sqrt(1 / 3)
    half = (np.log(4) - np.log(tiny)) / rate
    assert motion.describe()["flip_time"] == pytest.approx(2 * half, rel=4 * EPS)
    spin = motion.at(half + np.array([-50.0, -1.0, 0.0, 1.0, 50.0]) / rate).omega_body.components[:, 1]
    assert np.abs(spin + np.tanh([-50.0, -1.0, 0.0, 1.0, 50.0])).max() <= 2 * EPS * rate * half
