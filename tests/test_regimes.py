"""What a free motion is: its regime, flips, periods and rates, for bodies that are known."""

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


def test_the_reference_file_describes_alike():
    if not REFERENCE.exists():
        pytest.skip("the reference file is not here")
    seen = 0
    for case in json.loads(REFERENCE.read_text())["free_top"]:
        info = case.get("info", {})
        if "period" not in info or "near_sep" in case["name"]:
            continue
        i, w = ([float(x) for x in case[key]] for key in ("inertia", "omega0"))
        found = ph.describe_free(moments(*i), w)
        # Decimal inputs are rounded: where 1 − k is small the period feels it by 1/(1 − k).
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
