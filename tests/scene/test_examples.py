"""Example scenes: each runs and has the number it demonstrates."""

import re

import numpy as np
import pytest

import polhode as ph
from command_line import EXAMPLES, polhode, summary_of

SCENES = sorted(path.stem for path in EXAMPLES.glob("*.toml"))
SIDEREAL_DAY = 86164.0905


def period_of_pendulum(amplitude):
    """The period relative to small swings, by the arithmetic-geometric mean."""
    x, y = 1.0, np.cos(amplitude / 2)
    while abs(x - y) > 1e-15:
        x, y = (x + y) / 2, np.sqrt(x * y)
    return 1 / x


def test_there_are_examples():
    assert len(SCENES) == 12


def with_fewer_bodies(path, folder):
    """The scene with the first 500 bodies of its ensemble."""
    fewer = folder / path.name
    text, count = re.subn(r"(?m)^number = .*$", "number = 500", path.read_text())
    assert count == 1
    fewer.write_text(text)
    return fewer


@pytest.mark.parametrize("name", SCENES)
def test_examples_are_valid_and_print_a_summary(name, tmp_path):
    path = EXAMPLES / f"{name}.toml"
    assert polhode("check", path).returncode == 0
    if "[ensemble]" in path.read_text():
        path = with_fewer_bodies(path, tmp_path)
    done = polhode("run", path)
    assert done.returncode == 0
    assert done.stderr == ""
    for section in ("Body", "Motion", "Conserved", "Run", "No file was written"):
        assert f"\n{section}" in done.stdout
    assert (EXAMPLES / f"{name}.toml").read_text().startswith("# ")
    caption = ph.Scene.read(EXAMPLES / f"{name}.toml").caption
    assert caption.endswith((".", "?"))
    assert "\n" not in caption


def test_the_nutating_top_draws_loops():
    result = summary_of(EXAMPLES / "nutating-top.toml")
    motion = result["motion"]
    assert (motion["kind"], motion["regime"]) == ("lagrange", "nutating with loops")
    # With moments (3, 3, 1), c = 19.62 N m: the bounds are zeros of u'² = (1 − u²)(α − βu) − (b − au)².
    u, a = 0.5, 15 / 3
    w = np.array([0.0, -1.2, 15.0])
    up = np.array([0.0, np.sin(np.pi / 3), np.cos(np.pi / 3)])
    b = (np.array([3, 3, 1]) * w) @ up / 3
    beta = 2 * 19.62 / 3
    alpha = w[0] ** 2 + w[1] ** 2 + beta * u
    roots = np.sort(np.roots([beta, -(alpha + a * a), 2 * a * b - beta, alpha - b * b]))
    tilts = np.arccos(roots[:2])[::-1]
    np.testing.assert_allclose([motion["tilt_min"], motion["tilt_max"]], tilts, rtol=1e-9)
    assert set(result["conserved"]) == {
        "energy",
        "vertical_angular_momentum",
        "spin_angular_momentum",
    }
    assert result["torques"][0]["law"] == "heavy"


def test_the_satellite_swings_as_a_pendulum():
    result = summary_of(EXAMPLES / "gravity-gradient.toml")
    motion = result["motion"]
    assert motion["regime"] == "librating about the vertical"
    small = 5677 / np.sqrt(3 * (1150 - 50) / 1200)
    assert motion["small_libration_period"] == pytest.approx(small, rel=1e-12)
    # θ'' = −3/2 n² (b − a)/c sin 2θ: a pendulum at twice the angle. Crossings lie between samples 30 s apart.
    exact = small * period_of_pendulum(2 * np.radians(20))
    assert motion["libration_period"] == pytest.approx(exact, rel=2e-5)
    assert motion["from_vertical"][1] == pytest.approx(np.radians(20), abs=1e-9)
    assert motion["from_normal"][1] < 1e-9
    assert result["conserved"]["jacobi_integral"]["drift"] < 1e-12


def test_kovalevskayas_integral_is_conserved():
    result = summary_of(EXAMPLES / "kovalevskaya.toml")
    assert result["motion"]["regime"] == "Kovalevskaya's top about a fixed point"
    # (ω1² − ω2² − c1 γ1/i3)² + (2 ω1 ω2 − c1 γ2/i3)² about the axes of the file, γ = (−sin 40°, 0, cos 40°).
    gamma = np.array([-np.sin(np.radians(40)), 0.0])
    k = (1 - 4 - 3 * gamma[0]) ** 2 + (4 - 3 * gamma[1]) ** 2
    integral = result["conserved"]["kovalevskaya_integral"]
    assert integral["value"] == pytest.approx(k, rel=1e-12)
    assert integral["drift"] < 1e-11


def test_the_wheel_holds_the_middle_axis(tmp_path):
    motion = summary_of(EXAMPLES / "dual-spin.toml")["motion"]
    assert motion["kind"] == "gyrostat"
    assert motion["from_wheel"][1] < np.radians(15)
    # Without the wheel L comes to the opposite end of the middle axis.
    text = (EXAMPLES / "dual-spin.toml").read_text().replace("25 N m s", "0.001 N m s")
    (tmp_path / "a.toml").write_text(text)
    assert summary_of(tmp_path / "a.toml")["motion"]["from_wheel"][1] > np.radians(150)


def test_feynmans_plate_wobbles_twice_per_turn():
    motion = summary_of(EXAMPLES / "feynman-plate.toml")["motion"]
    # i3/i1 over the cosine of the angle from the axis to L, tan = 0.01 i1/i3.
    assert motion["wobbles_per_turn"] == pytest.approx(2 * np.hypot(1, 0.005), rel=1e-12)
    assert motion["wobbles_per_turn"] == pytest.approx(2.000025, abs=1e-9)
    assert "2.000025 per turn" in polhode("run", EXAMPLES / "feynman-plate.toml").stdout


def test_the_earth_has_eulers_period():
    motion = summary_of(EXAMPLES / "earth.toml")["motion"]
    day = SIDEREAL_DAY / np.cos(np.radians(0.3 / 3600))
    assert motion["period"] / day == pytest.approx(1 / 0.00327379 - 1, rel=1e-9)
    assert motion["period"] / SIDEREAL_DAY == pytest.approx(304.5, abs=0.05)


def test_coils_reduce_the_spin():
    result = summary_of(EXAMPLES / "detumbling.toml")
    rate = result["motion"]["changes"]["rate"]
    assert rate["start"] == pytest.approx(np.radians(np.sqrt(77)), rel=1e-12)
    assert rate["end"] < 0.1 * rate["start"]
    (law,) = result["torques"]
    assert law["formula"] == "-k (Ω_B·b(R, 2*n*t)) ∧ b(R, 2*n*t)"
    assert result["conserved"] == {}


def test_toutatis_is_predictable_for_months(tmp_path):
    result = summary_of(with_fewer_bodies(EXAMPLES / "toutatis-uncertain.toml", tmp_path))
    motion = result["motion"]
    assert motion["regimes"] == {"long-axis mode": 500}
    # About the periods of Hudson & Ostro 1995, each spread by less than the 0.03 d of Zhao & Ji.
    for name, days in (("period", 5.41), ("precession_period", 7.35)):
        low, *_, high = np.array(motion[name]) / 86400
        assert (low + high) / 2 == pytest.approx(days, rel=0.01)
        assert 0.01 < (high - low) / 3.29 < 0.03
    within_10, within_90 = (entry["time"] / 86400 for entry in motion["horizons"])
    assert 10 < within_10 < 100 < within_90 < 1000
    # At the end its phase about L is lost.
    assert np.degrees(motion["from_nominal"][-1]["quantiles"][2]) > 90
