"""Lagrange's heavy top: reference states, conservation at any time, limits, description."""

import json

import numpy as np
import pytest

import polhode as ph
from motions import EPS, REFERENCE, moments

CASES = {
    c["name"]: c for c in json.loads(REFERENCE.read_text())["torqued"] if c["name"].startswith("lagrange")
}
TOP = moments(1, 1, 0.5)


def rotor(*components):
    return ph.Rotor.from_components(components)


# Moments, c, rotor and angular velocity.
KINDS = {
    "loops": ((1, 1, 0.5), (0, 0, 1), (2, 1, 0, 0), (0, 0.5, 6)),
    "waves": ((1, 1, 0.5), (0, 0, 2), (4, 2, 1, 0), (0.25, -0.5, 6)),
    "cusps": ((1, 1, 0.5), (0, 0, 1), (2, 1, 0, 0), (0, 0, 6)),
    "slow": ((1, 1, 0.25), (0, 0, 1), (4, 1, 1, 0), (0.5, 0.25, 1)),
    "oblate": ((1, 1, 1.75), (0, 0, 3), (2, 1, 0.5, 0.25), (-0.5, 1, 0.25)),
    "hung": ((1, 1, 0.5), (0, 0, -1), (2, 1, 0.5, 0.25), (0.25, -0.5, 3)),
    "about e1": ((0.5, 1, 1), (1, 0, 0), (2, 1, 0.5, 0.25), (3, 0.25, -0.5)),
    "about -e2": ((1, 0.5, 1), (0, -1, 0), (2, 1, 0.5, 0.25), (-0.5, 3, 0.25)),
    "sphere": ((1, 1, 1), (1, -1, 0.5), (2, 1, 0.5, 0.25), (-0.5, 3, 0.25)),
    "upright in passing": ((1, 1, 0.5), (0, 0, 1), (1, 0, 0, 0), (0.5, 0.25, 3)),
    "hanging in passing": ((1, 1, 0.5), (0, 0, 1), (0, 1, 0.5, 0), (0.5, 0.25, 3)),
    "pendulum": ((1, 1, 0.5), (0, 0, 1), (2, 1, 0.5, 0), (0, 0, 0)),
    "whirl": ((1, 1, 0.5), (0, 0, 1), (1, 0, 0, 0), (2.5, 0.5, 0)),
    "near the separatrix": ((1, 1, 0.5), (0, 0, 1), (1, 2**-12, 0, 0), (0, 2**-13, 1)),
    "tiny tilt": ((1, 1, 0.5), (0, 0, 1), (1, 2**-30, 0, 0), (2**-31, 0, 6)),
    "weightless": ((1, 1, 0.5), (0, 0, 0), (2, 1, 0.5, 0.25), (0.25, -0.5, 1)),
    "almost weightless": ((1, 1, 0.5), (0, 0, 2**-60), (2, 1, 0.5, 0.25), (0.25, -0.5, 1)),
    "sleeping": ((1, 1, 0.5), (0, 0, 1), (2, 0, 0, 1), (0, 0, 6)),
    "hanging": ((1, 1, 0.5), (0, 0, 1), (0, 2, 1, 0), (0, 0, 6)),
}  # fmt: skip
kinds = pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS.keys())


def top_of(i, c, r, w):
    return ph.LagrangeTop(moments(*i), rotor(*r), w, c)


@pytest.mark.parametrize("case", CASES.values(), ids=CASES.keys())
def test_reference(case):
    i, w, r, c = ([float(x) for x in case[key]] for key in ("inertia", "omega0", "R0", "c"))
    states = top_of(i, c, r, w).at([float(x["t"]) for x in case["results"]])
    for k, result in enumerate(case["results"]):
        r, w = np.array(result["R"], float), np.array(result["omega"], float)
        assert np.abs(states.rotor.components[k] - r).max() <= 4 * EPS
        assert np.abs(states.omega_body.components[k] - w).max() <= 4 * EPS * np.linalg.norm(w)


@pytest.mark.parametrize("case", CASES.values(), ids=CASES.keys())
def test_description_of_reference(case):
    i, w, r, c = ([float(x) for x in case[key]] for key in ("inertia", "omega0", "R0", "c"))
    found, info = top_of(i, c, r, w).describe(), {k: float(x) for k, x in case["info"].items()}
    for key, name in {
        "tilt_min": "theta_min",
        "tilt_max": "theta_max",
        "nutation_period": "nutation_period",
        "energy": "energy",
        "axial_momentum": "L3",
        "vertical_momentum": "Lz",
    }.items():
        assert found[key] == pytest.approx(info[name], rel=8 * EPS)
    assert found["modulus"] ** 2 == pytest.approx(info["k2"], rel=8 * EPS)
    turned = found["precession_rate"] * found["nutation_period"]
    assert turned == pytest.approx(info["phi_per_nutation"], rel=16 * EPS)
    assert found["precession_period"] == pytest.approx(2 * np.pi / abs(found["precession_rate"]), rel=4 * EPS)


@kinds
def test_agrees_with_steps(kind):
    """Steps of order 8 to t = 6 either way, with a tolerance of 1e-11."""
    i, c, r, w = kind
    times = np.array([-6.0, -0.7, 0.0, 1.3, 6.0])
    exact = top_of(*kind).at(times)
    steps = ph.simulate(
        moments(*i), ph.State(rotor(*r), w), times, ph.torque.heavy(c), method="kahan_li8", rtol=1e-11
    )
    assert np.abs(exact.rotor.components - steps.rotor.components).max() <= 1e-10
    assert np.abs(exact.omega_body.components - steps.omega_body.components).max() <= 1e-10


@kinds
def test_integrals_stay(kind):
    """Energy, L3 and Lz up to t = 1e12: they depend on rotor and rates, which err by a few roundings."""
    i, c, _, _ = kind
    times = np.concatenate([[0.0], np.geomspace(1e-3, 1e12, 60), -np.geomspace(1e-3, 1e12, 60)])
    state = top_of(*kind).at(times)
    assert np.abs(np.linalg.norm(state.rotor.components, axis=-1) - 1).max() <= 4 * EPS
    inertia, omega = moments(*i), state.omega_body.components
    momentum = inertia(state.omega_body)
    gamma = (~state.rotor)(ph.e3).components
    potential = gamma @ np.array(c, float)
    kinetic = 0.5 * (omega * momentum.components).sum(axis=-1)
    vertical = state.rotor(momentum).components[:, 2]
    size = np.abs(momentum.components).max()
    assert np.abs(vertical - vertical[0]).max() <= 32 * EPS * size
    energy = kinetic + potential
    assert np.abs(energy - energy[0]).max() <= 32 * EPS * (kinetic.max() + np.linalg.norm(c))
    if any(c):
        axial = momentum.components @ np.array(c, float) / np.linalg.norm(c)
        assert np.abs(axial - axial[0]).max() <= 8 * EPS * size


@kinds
def test_rotor_is_continuous_and_its_rate_is_the_spin(kind):
    """R' = −½ R Ω_B by central differences of order 4; rates up to ω = 6 in the rotor's fifth derivative."""
    top = top_of(*kind)
    t, h = np.linspace(-20.0, 20.0, 801), 2.0**-9
    at = {k: top.at(t + k * h).rotor.components for k in (-2, -1, 1, 2)}
    slope = (8 * (at[1] - at[-1]) - (at[2] - at[-2])) / (12 * h)
    state = top.at(t)
    expected = (-0.5 * state.rotor * state.omega_body).components
    assert np.abs(slope - expected).max() <= h**4 * 4.0**5 / 30 + 32 * EPS / h


@pytest.mark.parametrize(("r", "w", "regime"), [
    ((1, 0, 0, 0), (0, 0, 0), "upright, unstable"),
    ((1, 0, 0, 2), (0, 0, 3), "upright, unstable"),
    ((1, 0, 0, 2), (0, 0, 4), "sleeping, upright"),
    ((1, 0, 0, 2), (0, 0, -5), "sleeping, upright"),
    ((0, 1, 2, 0), (0, 0, 3), "hanging"),
    ((2, 1, 0, 0), (0, 0, 6), "nutating with cusps"),
    ((2, 1, 0, 0), (0, 0.125, 6), "nutating with loops"),
    ((2, 1, 0, 0), (0, -0.125, 6), "nutating with waves"),
    ((2, 1, 0, 0), (0, 0, 0), "pendulum, swinging"),
    ((1, 0, 0, 0), (1, 0, 0), "pendulum, circulating"),
    ((0, 1, 0, 0), (2, 0, 0), "separatrix"),
])  # fmt: skip
def test_regime_names(r, w, regime):
    assert top_of((1, 1, 0.5), (0, 0, 1), r, w).describe()["regime"] == regime
    assert top_of((1, 1, 0.5), (0, 0, 0), r, (0, 0, 0)).describe()["regime"] == "at rest"


def test_the_precession_has_the_sign_of_its_momentum_at_the_bounds():
    """It is ``(Lz - L3 u)/(i1 (1 - u²))`` at the height u = cos θ: loops have both signs, waves have one."""
    rng = np.random.default_rng(1)
    seen = set()
    for _ in range(200):
        i1, i3, c = rng.uniform([1, 0.5, 0.2], [3, 2, 5])
        omega = rng.normal(size=3) * 10 ** rng.uniform(-1, 0.7, 3)
        found = top_of((i1, i1, min(i3, 2 * i1)), (0, 0, c), rng.normal(size=4), omega).describe()
        least, most = (
            found["vertical_momentum"] - found["axial_momentum"] * np.cos(found[name])
            for name in ("tilt_min", "tilt_max")
        )
        if found["regime"].startswith("nutating"):
            assert found["regime"] == f"nutating with {'loops' if least * most < 0 else 'waves'}"
            seen.add(found["regime"])
        assert found["critical_spin"] == pytest.approx(2 * np.sqrt(c * i1) / min(i3, 2 * i1), rel=8 * EPS)
    assert seen == {"nutating with loops", "nutating with waves"}


def test_regular_precession():
    """With u = 3/5 and rate ν, c = L3 ν − i1 ν² u: the axis precesses steadily at ν."""
    r, rate = rotor(2, 1, 0, 0), 0.5
    spin = (1 + rate**2 * 0.6) / rate / 0.5
    omega = ((~r)(ph.e3) * rate).components + np.array([0, 0, spin - 0.6 * rate])
    top = ph.LagrangeTop(TOP, r, omega, [0, 0, 1])
    found = top.describe()
    assert found["regime"] == "regular precession"
    assert found["nutation_period"] is None
    assert found["precession_rate"] == pytest.approx(rate, rel=8 * EPS)
    assert found["tilt_min"] == pytest.approx(np.arccos(0.6), rel=8 * EPS)
    assert found["spin_rate"] == pytest.approx(spin - 0.6 * rate, rel=8 * EPS)
    for t in (1.0, 1000.0):
        turned = ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, rate * t)(r(ph.e3))
        # The rates given are rounded, and so is the angle in floating point.
        assert (top.at(t).rotor(ph.e3) - turned).norm() <= 8 * EPS * (1 + t)


def test_a_fast_gyroscope_precesses_at_c_over_momentum():
    found = top_of((1, 1, 0.5), (0, 0, 1), (2, 1, 0, 0), (0, 0, 2000)).describe()
    # c/L3 = 1e-3, next term (c/L3)² i1 u/c of it.
    assert found["precession_rate"] == pytest.approx(1e-3, rel=2e-6)
    assert found["nutation_period"] == pytest.approx(2 * np.pi / 1000, rel=2e-6)


def test_the_separatrix_is_homoclinic():
    """Hanging pendulum started at the critical rate: it approaches the upright, sin ½θ = 1/cosh λt."""
    top = top_of((1, 1, 0.5), (0, 0, 1), (0, 1, 0, 0), (2, 0, 0))
    for t in (-500.0, -40.0, -3.0, 0.0, 1.0, 5.0, 40.0, 1e9):
        state = top.at(t)
        _, x, y, _ = state.rotor.components
        assert np.hypot(x, y) == pytest.approx(1 / np.cosh(min(abs(t), 700)), rel=16 * EPS, abs=1e-150)
        assert state.omega_body.components[0] == pytest.approx(
            2 / np.cosh(min(abs(t), 700)), rel=16 * EPS, abs=1e-150
        )


@pytest.mark.parametrize(("spin", "stable"), [(3.9, False), (4.1, True), (-4.1, True)])
def test_sleeping(spin, stable):
    """2 √(c i1)/i3 = 4 here: below it a disturbance of 1e-6 grows, above it stays small."""
    top = top_of((1, 1, 0.5), (0, 0, 1), (1, 5e-7, 0, 0), (0, 0, spin))
    found = top.describe()
    assert found["critical_spin"] == 4.0
    assert found["sleeps"] is stable
    assert (found["tilt_max"] < 1e-4) is stable
    assert (found["regime"] == "sleeping, nearly upright") is stable
    asleep = top_of((1, 1, 0.5), (0, 0, 1), (1, 0, 0, 0), (0, 0, spin))
    assert asleep.at(1e6).rotor(ph.e3) == ph.e3
    assert asleep.describe()["sleeps"] is stable


@pytest.mark.parametrize(("turn", "w", "regime"), [
    (0.05, (0, 0, 4.5), "sleeping, nearly upright"),
    (0.05, (0, 0.01, 4.5), "sleeping, nearly upright"),
    # Too slow to stay near the upright, and too far from it: it nutates as any other top.
    (0.05, (0, 0, 3.9), "nutating with cusps"),
    (0.25, (0, 0, 40.0), "nutating with cusps"),
])  # fmt: skip
def test_a_top_pushed_from_the_upright_sleeps(turn, w, regime):
    r = ph.Rotor.from_plane_angle(ph.e2 ^ ph.e3, turn)
    found = ph.LagrangeTop(TOP, r, w, [0, 0, 1]).describe()
    assert found["regime"] == regime
    # The height of the centre of mass, as a part of that of the upright.
    nearly = bool(np.cos(found["tilt_max"]) >= 0.98)
    assert (nearly and found["sleeps"]) is (regime == "sleeping, nearly upright")
    # Without weight no top sleeps.
    assert "sleeping" not in ph.LagrangeTop(TOP, r, w, [0, 0, 0]).describe()["regime"]


def test_it_repeats_after_a_nutation():
    top = top_of(*KINDS["slow"])
    found = top.describe()
    period = found["nutation_period"]

    def tilt(t):
        return np.arccos(top.at(t).rotor(ph.e3).components[..., 2])

    assert tilt(3 * period) == pytest.approx(tilt(0.0), rel=64 * EPS)
    many = tilt(np.linspace(0, period, 20001))
    assert many.min() == pytest.approx(found["tilt_min"], abs=1e-6)
    assert many.max() == pytest.approx(found["tilt_max"], abs=1e-6)
    turned = top.at(period).rotor * ~top.at(0.0).rotor
    angle = ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, found["precession_rate"] * period)
    axis = top.at(0.0).rotor(ph.e3)
    assert (turned(axis) - angle(axis)).norm() <= 64 * EPS


def test_axes_may_lie_anywhere():
    """Rotating the body axes rotates the description only."""
    turn = ph.Rotor.random(rng=5)
    matrix = turn.to_matrix() @ np.diag([1.0, 1.0, 0.5]) @ turn.to_matrix().T
    r, w, c = rotor(2, 1, 0.5, 0), ph.bivector([0.25, -0.5, 6]), ph.vector([0, 0, 2])
    plain = ph.LagrangeTop(TOP, r, w, c)
    turned = ph.LagrangeTop(ph.Inertia.from_matrix(0.5 * (matrix + matrix.T)), r * ~turn, turn(w), turn(c))
    for t in (0.0, 3.0, 50.0):
        # The matrix's moments are off by a few ulps, which adds up along the phase.
        assert (turned.at(t).rotor * turn - plain.at(t).rotor).norm() <= 64 * EPS * (1 + 6 * t)


TILTS = [5e-324, 1e-300, 1e-160, 1e-60, 1e-40, 1e-30, 1e-21, 1e-12, 1e-8]


@pytest.mark.parametrize("tilt", TILTS)
@pytest.mark.parametrize("spin", [0.0, 3.0, 8.0])
def test_beside_the_vertical(tilt, spin):
    """Without spin the tilt is δ cos t hanging, and δ cosh t upright."""
    times = [0.0, 1.0, 2.0, 5.0]
    for r in ((0, 1, 0, tilt), (1, tilt, 0, 0)):
        motion = ph.simulate(TOP, ph.State(rotor(*r), [0, 0, spin]), times, ph.torque.heavy([0, 0, 1]))
        assert motion.certificate.method == "exact"
        assert motion.certificate.worst <= 8 * EPS
        across = np.hypot(*motion.omega_body.components[:, :2].T)
        # γ turns with the tilt of twice the component, and c γ is the rate's change: no faster than λ = 1.
        assert (across <= 2 * max(tilt, 1e-303) * np.cosh(5.0)).all()
        if tilt > 1e-300 and spin == 0:
            s, x, y, z = motion.rotor.components.T
            small, growth = (np.hypot(x, y), np.cosh) if r[0] else (np.hypot(s, z), np.cos)
            # To first order in the tilt, and to the rounding of a period.
            expected = tilt * np.abs(growth(times))
            assert np.abs(small - expected).max() <= (tilt**2 * 1e3 + 1e3 * EPS) * expected.max()


def test_an_upright_top_falls_after_the_logarithm_of_its_tilt():
    """Without spin sin ½θ = sech(λt − K) with K = ln(4/k'), k' the sine of half the tilt."""
    for tilt in TILTS[1:-1]:
        fall = np.log(4 / tilt)
        state = top_of((1, 1, 0.5), (0, 0, 1), (1, tilt, 0, 0), (0, 0, 0)).at(
            fall + np.array([-1.0, 0.0, 1.0])
        )
        _, x, y, _ = state.rotor.components.T
        # K in floating point has so many roundings.
        assert np.abs(np.hypot(x, y) - 1 / np.cosh([-1.0, 0.0, 1.0])).max() <= 2 * EPS * fall + tilt


def test_batches_of_times():
    top = top_of(*KINDS["slow"])
    times = np.arange(6.0).reshape(2, 3)
    batch = top.at(times)
    assert batch.rotor.shape == (2, 3)
    for index in np.ndindex(2, 3):
        assert batch.rotor[index] == top.at(times[index]).rotor
        assert batch.omega_body[index] == top.at(times[index]).omega_body
    assert top.at(np.zeros(0)).rotor.shape == (0,)


def test_bad_input_is_refused():
    identity, w = ph.Rotor.identity(), [0, 0, 1]
    with pytest.raises(ValueError, match=r"1, 2, 2\.5 kg m² all differ"):
        ph.LagrangeTop(moments(1, 2, 2.5), identity, w, [0, 0, 1])
    with pytest.raises(ValueError, match="is not along the axis of symmetry"):
        ph.LagrangeTop(TOP, identity, w, [0.1, 0, 1])
    with pytest.raises(ValueError, match="include a zero"):
        ph.LagrangeTop(moments(1, 1, 0), identity, w, [0, 0, 1])
    with pytest.raises(ValueError, match="angular velocity"):
        ph.LagrangeTop(TOP, identity, [0, np.nan, 1], [0, 0, 1])
    with pytest.raises(ValueError, match="c "):
        ph.LagrangeTop(TOP, identity, w, [0, 0, np.inf])
    with pytest.raises(TypeError, match="Inertia"):
        ph.LagrangeTop(ph.Body.sphere(1.0, mass=1.0), identity, w, [0, 0, 1])
    top = top_of(*KINDS["slow"])
    with pytest.raises(ValueError, match="time NaN at index 1"):
        top.at([0.0, np.nan])
    with pytest.raises(ValueError, match=r"times\[0\] = .* is beyond"):
        top.at(1e30)
