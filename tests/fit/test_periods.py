"""Angular velocities from the rotation and precession periods of light curves."""

import json

import numpy as np
import pytest

import polhode as ph
from polhode._cli import main

DAY = 86400.0
TOUTATIS = (3.09, 3.22, 1)


def motion(moments, omega):
    return ph.FreeMotion(ph.Inertia.from_principal_moments(*moments), ph.Rotor.identity(), omega)


def test_published_periods_of_toutatis_give_its_published_spin():
    """Hudson & Ostro (1995): 5.41 d and 7.35 d; ratios and spin as in examples/toutatis.toml."""
    omega = ph.omega_from_periods(TOUTATIS, 5.41 * DAY, 7.35 * DAY, mode="long")
    found = motion(TOUTATIS, omega).describe()
    assert found["period"] == pytest.approx(5.41 * DAY, rel=1e-12)
    assert found["precession_period"] == pytest.approx(7.35 * DAY, rel=1e-9)
    published = motion(TOUTATIS, np.radians([20.7, 31.3, 98.0]) / DAY).describe()
    # The periods have three digits, the spin 0.1 deg/day in 20: 0.5 %.
    for name in ("energy", "angular_momentum", "wobble_max"):
        assert found[name] == pytest.approx(published[name], rel=5e-3)


@pytest.mark.parametrize("mode", ["long", "short"])
def test_periods_of_random_bodies(mode):
    """The motion is found again from its periods: equal energy and momentum."""
    rng = np.random.default_rng(2)
    fractions = rng.uniform(0.2, 1, (40, 3))
    moments = fractions.sum(axis=1, keepdims=True) - fractions
    omega = rng.normal(size=(40, 3))
    bodies = np.array([ph.Inertia.from_principal_moments(*row) for row in moments], dtype=object)
    true = ph.FreeMotion(bodies, ph.Rotor.identity(), omega).describe()
    count = 0
    for k in np.flatnonzero(true["regime"] == f"{mode}-axis mode"):
        periods = true["period"][k], true["precession_period"][k]
        found = motion(moments[k], ph.omega_from_periods(moments[k], *periods, mode=mode)).describe()
        # An error of 1e-15 of the wobble, over the slope of the ratio, which is small for a small wobble.
        assert found["energy"] == pytest.approx(true["energy"][k], rel=1e-8)
        assert found["angular_momentum"] == pytest.approx(true["angular_momentum"][k], rel=1e-8)
        count += 1
    assert count > 5


def test_a_family_of_moment_ratios():
    """Bodies of all ratios: those with a result have the periods, the others cannot have them."""
    x, y = np.meshgrid(np.linspace(1.5, 5, 15), np.linspace(1.5, 5, 15))
    moments = np.stack([x, y, np.ones_like(x)], axis=-1)
    moments = moments[np.abs(x - y) < 0.9]
    omega = ph.omega_from_periods(moments, 5.41, 7.35, mode="long")
    inside = np.isfinite(omega.components).all(axis=1)
    assert 0 < inside.sum() < len(moments)
    for row, rate in zip(moments[inside], omega[inside].components, strict=True):
        found = motion(row, rate).describe()
        assert found["period"] / found["precession_period"] == pytest.approx(5.41 / 7.35, rel=1e-6)
    # A small wobble has the shortest period relative to that of the precession; the others exceed it.
    for row in moments[~inside]:
        small = motion(row, [1e-6, 1e-6, 1.0]).describe()
        assert small["period"] / small["precession_period"] > 5.41 / 7.35


def test_a_symmetric_body_by_its_formulas():
    """Handout (4.33): precession |L|/i1, rotation ((i1 − i3)/i1) ω3 in the body."""
    omega = ph.omega_from_periods((2, 2, 1), 15, 12, mode="long").components
    assert 2 * np.pi / abs(0.5 * omega[2]) == pytest.approx(15, rel=1e-9)
    momentum = np.linalg.norm(omega * [2, 2, 1])
    assert 2 * np.pi / (momentum / 2) == pytest.approx(12, rel=1e-9)


def test_bad_periods():
    with pytest.raises(ValueError, match="rotation_period must be positive and finite, got 0"):
        ph.omega_from_periods(TOUTATIS, 0, 1, mode="long")
    with pytest.raises(ValueError, match="mode must be 'long' or 'short', got 'middle'"):
        ph.omega_from_periods(TOUTATIS, 1, 1, mode="middle")
    with pytest.raises(ValueError, match=r"moments at index \(1,\): .* 1.0, 1.0, 3.0"):
        ph.omega_from_periods([TOUTATIS, (1, 1, 3)], 1, 1, mode="long")
    with pytest.raises(ValueError, match="moments needs 3 components"):
        ph.omega_from_periods([1, 2], 1, 1, mode="long")
    assert ph.omega_from_periods(np.empty((0, 3)), 1, 1, mode="long").shape == (0,)


def test_published_periods_of_apophis_give_its_published_energy():
    """Pravec et al., Icarus 233, 48 (2014): precession 27.38 h, rotation 263 h, short-axis mode.

    Its moments relative to the largest are 0.61 and 0.965, its energy relative to that of the rotation about
    the axis of the largest moment 1.024 with an error of 0.013 (3 sigma).
    """
    from polhode._fit.light_curve import rotations

    found = {
        (x.mode, x.rotation_period > x.precession_period): x
        for x in rotations([0.61, 0.965, 1], 263 * 3600.0, 27.38 * 3600.0)
    }
    short = found["short", True]
    assert short.energy_ratio == pytest.approx(1.024, abs=0.0005)
    # The same periods belong to a motion about the long axis, with a larger energy.
    assert found["long", True].energy_ratio == pytest.approx(1.043, abs=0.0005)
    assert not found["short", False].is_possible
    assert not found["long", False].is_possible


def test_the_command_reports_the_modes_of_toutatis(capsys, tmp_path):
    out = tmp_path / "toutatis.json"
    periods = ["fit", "--periods", "5.41 d", "7.35d"]
    assert main.main([*periods, "--moments", "3.09", "3.22", "1", "-o", str(out)]) == 0
    text = capsys.readouterr().out
    assert text.startswith("rotation 467424 s, precession 635040 s, long-axis mode\n  omega ")
    assert "rotation 467424 s, precession 635040 s, short-axis mode\n  not possible\n" in text
    assert "mode: 2 rotations have these periods" in text
    found = json.loads(out.read_text())["rotations"][0]
    omega = ph.omega_from_periods(TOUTATIS, 5.41 * DAY, 7.35 * DAY, mode="long")
    np.testing.assert_allclose(found["omega_body"], omega.components, rtol=1e-12)
    assert found["wobble"] == pytest.approx(np.radians([50.54, 51.21]), abs=1e-4)


def test_the_command_reports_the_bodies_of_two_periods(capsys):
    """A rotation period below that of the precession excludes the short-axis mode of any body."""
    assert main.main(["fit", "--periods", "5.41 d", "7.35 d", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    long, short = found["rotations"][:2]
    assert long["is_possible"]
    assert not short["is_possible"]
    (low, high), _ = long["ranges"]
    # The shape model of Toutatis, 1/3.22, is one of them, within the step of 0.04.
    assert low - 0.02 <= 1 / 3.22 <= high + 0.02
    assert any(text.startswith("moments: two periods leave a family") for text in found["undetermined"])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--periods", "5.41", "7.35 d"], "a unit s, min, h, d or day, got '5.41'"),
        (["--periods", "-1 d", "7.35 d"], "expected a period such as"),
        (["a.csv", "--periods", "1 d", "7 d"], "--periods takes neither a file of data nor --plot"),
        (["--moments", "1", "2", "3"], "--moments needs --periods"),
        (["--periods", "5.41d", "7 x"], "a unit s, min, h, d or day, got '7 x'"),
    ],
)
def test_wrong_usage_of_periods(options, message, capsys):
    with pytest.raises(SystemExit) as stop:
        main.main(["fit", *options])
    assert stop.value.code == 2
    assert message in capsys.readouterr().err


def test_a_ball_has_no_precession(capsys):
    omega = ph.omega_from_periods([[1, 1, 1], TOUTATIS], 5.41 * DAY, 7.35 * DAY, mode="long").components
    assert np.isnan(omega[0]).all()
    assert np.isfinite(omega[1]).all()
    assert main.main(["fit", "--periods", "5 d", "7 d", "--moments", "2", "2", "2"]) == 0
    found = capsys.readouterr()
    assert found.err == ""
    assert found.out.count("not possible") == 4
    assert "a ball rotates steadily, without precession" in found.out
