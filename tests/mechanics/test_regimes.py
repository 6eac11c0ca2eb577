"""Descriptions of free motions: regime, flips, periods and rates of known bodies."""

import json

import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, EPS, R0, REFERENCE, moments


def test_flips_of_the_t_handle():
    """(1, 2, 3), ω = (ε, 1, ε) flips every 19.5529 s at ε = 0.01 and 27.5308 s at 0.001."""
    for epsilon, flip in ((0.01, 19.5529), (0.001, 27.5308)):
        found = ph.describe_free(ASYMMETRIC, [epsilon, 1.0, epsilon])
        assert found["flip_time"] == pytest.approx(flip, abs=5e-5)
        assert found["period"] == 2 * found["flip_time"]
        assert found["regime"] == "short-axis mode"
        assert found["axis"] == 3
    flip = ph.describe_free(ASYMMETRIC, [0.01, 1.0, 0.01])["flip_time"]
    state = ph.State(ph.Rotor.identity(), [0.01, 1.0, 0.01])
    motion = ph.simulate(ASYMMETRIC, state, [0.0, flip, 2 * flip])
    spin = motion.omega_body.components[:, 1]
    np.testing.assert_allclose(spin, [1.0, -1.0, 1.0], rtol=0, atol=1e-9)


def test_eulers_period_of_the_earth():
    """(C − A)/C = 0.00327379 makes 304.5 sidereal days."""
    H = 0.00327379
    found = ph.describe_free(moments(1 - H, 1 - H, 1), 2 * np.pi * ph.bivector([1e-6, 0, 1]))
    assert found["regime"].startswith("symmetric top")
    # A number near 1 − H has lost log10(1/H) digits of H.
    assert found["period"] == pytest.approx((1 - H) / H, rel=4 * EPS / H)
    assert found["period"] == pytest.approx(304.5, abs=0.05)


def test_feynmans_plate():
    """A plate wobbles twice as fast as it spins: 2.000025 times at 0.01 rad."""
    plate = ph.Body.disc(0.1, mass=0.2)
    found = ph.describe_free(plate.inertia, [0.01, 0, 1.0])
    assert found["precession_rate"] == pytest.approx(np.sqrt(4 + 1e-4), rel=8 * EPS)
    assert found["precession_rate"] == pytest.approx(2.000025, abs=1e-9)


def test_toutatis():
    """Ratios (3.09, 3.22, 1), ω = (20.7, 31.3, 98.0)°/day: 5.396 and 7.350 days, long-axis mode."""
    found = ph.describe_free(moments(3.09, 3.22, 1), np.radians([20.7, 31.3, 98.0]))
    assert found["regime"] == "long-axis mode"
    assert found["axis"] == 3
    assert found["period"] == pytest.approx(5.39630673652676, rel=32 * EPS)
    assert found["precession_period"] == pytest.approx(7.34971262077109, rel=32 * EPS)


def test_descriptions_equal_those_of_the_reference_file():
    seen = 0
    for case in json.loads(REFERENCE.read_text())["free_top"]:
        info = case.get("info", {})
        if "period" not in info or "near_sep" in case["name"]:
            continue
        i, w = ([float(x) for x in case[key]] for key in ("inertia", "omega0"))
        found = ph.describe_free(moments(*i), w)
        # Decimal inputs are rounded: where 1 − k is small, 1/(1 − k) amplifies this.
        tolerance = 32 * EPS / min(1.0, float(info["one_minus_k"]))
        assert found["period"] == pytest.approx(float(info["period"]), rel=tolerance), case["name"]
        assert found["modulus"] == pytest.approx(float(info["k"]), rel=1e3 * tolerance), case["name"]
        rate = float(info["mean_precession_rate"])
        assert found["precession_rate"] == pytest.approx(rate, rel=tolerance), case["name"]
        assert found["regime"] == {"SAM": "short-axis mode", "LAM": "long-axis mode"}[info["kind"]]
        seen += 1
    assert seen >= 8


@pytest.mark.parametrize(
    ("i", "omega", "regime", "axis"),
    [
        ((1, 2, 3), [0, 0, 0], "at rest", None),
        ((1, 2, 3), [0, 2, 0], "steady rotation about a fixed axis", 2),
        ((2, 2, 2), [1, 2, 3], "steady rotation about a fixed axis", None),
        ((1, 1, 2), [1, 2, 0], "steady rotation about a fixed axis", None),
        ((1, 2, 2.25), [0.375, 0.5, 0.5], "separatrix", None),
        ((2, 1, 2), [1, 0.5, 0.25], "symmetric top, regular precession", 2),
    ],
)
def test_special_motions_are_named(i, omega, regime, axis):
    found = ph.describe_free(moments(*i), omega)
    assert found["regime"] == regime
    if axis:
        assert found["axis"] == axis
    assert found["flip_time"] is None
    assert found["energy"] == pytest.approx(0.5 * np.dot(i, np.square(omega)), rel=4 * EPS)
    assert found["angular_momentum"] == pytest.approx(np.linalg.norm(np.multiply(i, omega)), rel=4 * EPS)


WOBBLES = {
    "short axis": ((1, 2, 3), (0.25, -0.5, 1.0)),
    "long axis": ((2, 3, 1.5), (-0.25, 0.125, -1.5)),
    "near the separatrix": ((1, 2, 3), (2**-20, 1.0, 2**-20)),
    "needle": ((1, 1000, 1000.5), (2.0, 0.5, 0.25)),
    "plate": ((1, 1, 2), (0.5, -0.25, 1.0)),
    "rod-like": ((2, 2, 1), (0.5, -0.25, 1.0)),
    "nearly a sphere": ((1, 1 + 2**-33, 1 + 2**-32), (0.5, -0.25, 1.0)),
    "tiny wobble": ((1, 2, 3), (2**-30, 2**-31, 1.0)),
    "tiny wobble, long axis": ((1, 2, 2.5), (1.0, 2**-30, 2**-31)),
}


@pytest.mark.parametrize(("i", "omega"), WOBBLES.values(), ids=WOBBLES.keys())
def test_wobble_and_phase(i, omega):
    """The angle from L to the encircled axis is sampled; the phase is seen after a period."""
    body = moments(*i)
    motion = ph.FreeMotion(body, R0, omega)
    found = motion.describe()
    c, sign = found["axis"] - 1, 1 if i[found["axis"] - 1] == max(i) else -1
    n = 4096
    m = body(motion.polhode(n + 1)).components
    a, b = np.delete(m, c, axis=1).T
    angle = np.arctan2(np.hypot(a, b), np.abs(m[:, c]))
    # Near the separatrix the motion is too quick for the samples.
    least, most = found["wobble_min"], found["wobble_max"]
    assert least * (1 - 8 * EPS) <= angle.min()
    assert angle.max() <= most * (1 + 8 * EPS)
    near = 0.05 if "near" in found["regime"] or found["modulus"] > 0.999 else 1e-4
    assert angle.min() == pytest.approx(least, rel=near)
    assert angle.max() == pytest.approx(most, rel=near)
    # R(T) = −exp(−½ L/|L| φ) R(0). The period is rounded, and the body turns meanwhile.
    T, phase = found["period"], found["phase_per_period"]
    L = R0(body(ph.bivector(omega)))
    after = -(-0.5 * phase * L / L.norm()).exp() * R0
    spin = np.linalg.norm(omega)
    assert (after - motion.at(T).rotor).norm() <= 64 * EPS * (1 + T * spin)
    dynamic = 2 * found["energy"] * T / found["angular_momentum"]
    area = found["solid_angle"]
    assert phase - dynamic == pytest.approx(sign * (2 * np.pi - area), abs=64 * EPS * (1 + abs(dynamic)))
    # The solid angle is ∫ (1 − cos θ) dψ = ∫ tan(θ/2) sin θ dψ, by the trapezoidal rule over a period.
    t = np.arange(n) * (T / n)
    w = motion.at(t).omega_body.components
    x, y, z = np.roll(np.array(i) * w, -c - 1, axis=1).T
    u, v, s = np.roll(w, -c - 1, axis=1).T
    moved = np.roll(i, -c - 1)
    dx, dy = (moved[1] - moved[2]) * v * s, (moved[2] - moved[0]) * s * u
    g = found["angular_momentum"]
    rate = (x * dy - y * dx) / (g * (g + np.abs(z)))
    tolerance = 1e-3 if found["modulus"] > 0.999 else 1e-12
    assert abs(rate.sum()) * T / n == pytest.approx(area, rel=tolerance)


def test_small_wobbles():
    """A steady rotation has the period of small wobbles; Feynman's plate wobbles twice per turn."""
    for i, omega, wobble in (
        ((1, 2, 2.5), (0, 0, -2.0), np.pi / np.sqrt(1.5 * 0.5 / 2)),
        ((1, 2, 2.5), (0.5, 0, 0), 4 * np.pi / np.sqrt(1.5 * 1 / 5)),
        ((1, 1, 2), (0, 0, 1.0), 2 * np.pi),
    ):
        found = ph.describe_free(moments(*i), omega)
        assert found["wobble_period"] == pytest.approx(wobble, rel=4 * EPS)
        assert found["wobble_min"] == found["wobble_max"] == 0
        wobbling = ph.describe_free(moments(*i), np.where(omega, omega, 1e-9))
        # To the square of the wobble.
        assert wobbling["period"] == pytest.approx(wobble, rel=1e-15)
        assert wobbling["wobble_period"] is None
    for i, omega in (((1, 2, 3), (0, 1, 0)), ((2, 2, 2), (1, 2, 3)), ((1, 1, 2), (3, 4, 0))):
        assert ph.describe_free(moments(*i), omega)["wobble_period"] is None
    assert ph.describe_free(moments(1, 2, 3), [0, 0, 0])["wobble_max"] is None


def test_a_small_solid_angle_keeps_its_digits():
    """A circle of the small radius θ about the axis of a plate or rod: ``2π (1 − cos θ)``, 1e-26 of 2π."""
    for i in ((1, 1, 2), (2, 2, 1)):
        for small in (1e-13, 1e-3, 1.0, 1e9):
            found = ph.describe_free(moments(*i), [small, 0, 1])
            theta = np.arctan2(i[0] * small, i[2])
            assert found["wobble_min"] == pytest.approx(theta, rel=4 * EPS)
            assert found["wobble_max"] == pytest.approx(theta, rel=4 * EPS)
            area = 4 * np.pi * np.sin(theta / 2) ** 2
            assert found["solid_angle"] == pytest.approx(area, rel=8 * EPS)


def test_the_separatrix_wobbles_up_to_a_right_angle():
    found = ph.describe_free(moments(1, 2, 2.25), [0.375, 0.5, 0.5])
    assert found["wobble_max"] == np.pi / 2
    assert found["solid_angle"] is None
    assert found["phase_per_period"] is None


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("turned", [False, True])
def test_the_rates_of_a_symmetric_top_about_any_axis(axis, turned):
    """R(t) = exp(−½Ω_l t) R(0) exp(−½Ω_r t) (4.35); angles up to 8 and a diagonalised matrix round."""
    i = np.array([2.0, 2.0, 2.0])
    i[axis] = 1.0
    inertia = moments(*i)
    if turned:
        F = ph.Rotor.from_components([4, 1, 2, -2])
        inertia = ph.Inertia.from_matrix(F.to_matrix() @ np.diag(i) @ F.to_matrix().T)
    try:
        top = ph.SymmetricTop(inertia, R0, [0.5, -0.25, 1.0])
    except ValueError:
        pytest.skip("the moments of the turned matrix differ by rounding")
    t = np.linspace(-4, 4, 9)
    expected = (-0.5 * top.omega_l * t).exp() * R0 * (-0.5 * top.omega_r * t).exp()
    assert top.at(t).rotor.is_close(expected, rtol=0, atol=40 * EPS).all()
    assert top.omega_r.norm() > 0.05


def test_a_sphere_turns_with_the_left_rate_alone():
    top = ph.SymmetricTop(moments(2, 2, 2), R0, [0.5, -0.25, 1.0])
    assert top.omega_r.norm() == 0
    assert top.omega_l.is_close(R0(ph.bivector([0.5, -0.25, 1.0])), rtol=4 * EPS)


def test_symmetric_top_takes_any_times_and_axes():
    top = ph.SymmetricTop(moments(2, 1, 2), R0, [0.5, -0.25, 1.0])
    assert top.at(0.0).rotor.is_close(R0, rtol=4 * EPS)
    grid = top.at(np.arange(6.0).reshape(2, 3))
    assert grid.rotor.shape == grid.omega_body.shape == (2, 3)
    assert grid.rotor[1, 2].is_close(top.at(5).rotor, rtol=4 * EPS)
    with pytest.raises(ValueError, match=r"1, 2, 3 kg m² all differ.*use"):
        ph.SymmetricTop(ASYMMETRIC, R0, [0, 0, 1])
    with pytest.raises(ValueError, match="finite"):
        top.at(np.nan)
