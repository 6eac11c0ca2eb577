"""Fits of sensors whose axes are not the principal axes of the body."""

from pathlib import Path

import numpy as np
import pytest

import polhode as ph
from polhode._fit.parameters import Parameters

pytest.importorskip("scipy")

ROOT = Path(__file__).parents[2]
MOUNT = ph.Rotor.from_rotation_vector([0.4, -0.3, 0.2])  # from axes of the data to principal axes
SIGMA = 0.02
START = ph.Rotor.from_rotation_vector([0.3, -0.8, 0.5])


def inertia(moments, mount=MOUNT):
    """On the axes of the data."""
    turned = mount.to_matrix()
    matrix = turned.T @ np.diag(moments) @ turned
    return ph.Inertia.from_matrix(0.5 * (matrix + matrix.T))


def rates(body, omega, rng, times, bias=(0.03, -0.05, 0.02)):
    exact = ph.FreeMotion(body, START, omega).at(times).omega_body.components
    return times, exact + bias + SIGMA * rng.normal(size=(len(times), 3))


TIMES = np.linspace(0, 12, 240)
BODY = inertia((1, 2, 2.6))
OMEGA = [1.5, 3.0, 1.0]


def check(fit, body):
    """Moments and directions of the axes are within 4.5 standard deviations."""
    moments = body.principal_moments / body.principal_moments.max()
    assert (np.abs(fit.values[:2] - moments[:2]) < 4.5 * fit.stderr[:2]).all()
    k = fit.names.index("axes_1")
    off = (fit.sensor_axes * ~MOUNT).to_rotation_vector()
    assert (np.abs(off) < 4.5 * fit.stderr[k : k + 3]).all()
    # The axes are found, and the inertia has them.
    assert fit.stderr[k : k + 3].max() < 0.1
    relative = fit.inertia.matrix - body.matrix / body.principal_moments.max()
    assert np.abs(relative).max() < 0.05


def test_rates_alone_determine_the_axes():
    """Euler's equations on other axes contain the whole inertia up to its scale, five numbers."""
    data = rates(BODY, OMEGA, np.random.default_rng(1), TIMES)
    near = inertia((1.2, 2, 2.5), ph.Rotor.from_rotation_vector([0.2, -0.4, 0.3]))
    fit = ph.fit(rates=data, sigma_rates=SIGMA, sensor_axes="fit", start=(near, OMEGA))
    check(fit, BODY)
    assert fit.names[5:8] == ("axes_1", "axes_2", "axes_3")
    assert fit.undetermined[0].startswith("overall scale")
    assert len(fit.undetermined) == 2
    assert "rotation vector" in fit.summary()
    # State and inertia are on the axes of the data.
    motion = ph.FreeMotion(fit.inertia, ph.Rotor.identity(), fit.omega_body)
    off = motion.at(TIMES).omega_body.components + fit.bias.components - data[1]
    assert abs(np.sqrt(np.mean(off**2)) / fit.noise["rates"] - 1) < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_the_search_finds_any_axes(seed):
    rng = np.random.default_rng(seed)
    body = inertia((1, 1.8, 2.4), ph.Rotor.random(rng=rng))
    fit = ph.fit(rates=rates(body, OMEGA, rng, TIMES), sigma_rates=SIGMA, sensor_axes="fit")
    assert abs(fit.chi2_reduced - 1) < 6 * np.sqrt(2 / fit.dof)
    assert np.abs(fit.inertia.matrix - body.matrix / 2.4).max() < 0.1


def test_given_axes():
    data = rates(BODY, OMEGA, np.random.default_rng(2), TIMES)
    fit = ph.fit(rates=data, sigma_rates=SIGMA, sensor_axes=MOUNT, start=(BODY, OMEGA))
    assert fit.sensor_axes is None
    assert "axes_1" not in fit.names
    assert (np.abs(fit.values[2:5] - OMEGA) < 4.5 * fit.stderr[2:5]).all()
    np.testing.assert_allclose(fit.inertia.matrix, BODY.matrix / 2.6, atol=0.02)
    # As if the data had been turned before.
    turned = (data[0], data[1] @ MOUNT.to_matrix().T)
    plain = ph.fit(rates=turned, sigma_rates=SIGMA)
    np.testing.assert_allclose(plain.values[:2], fit.values[:2], atol=1e-3 * fit.stderr[0])
    np.testing.assert_allclose(plain.covariance[:2, :2], fit.covariance[:2, :2], rtol=1e-3)


def test_a_symmetric_body_leaves_the_turn_about_its_axis():
    body = inertia((1, 1, 1.7))
    data = rates(body, OMEGA, np.random.default_rng(3), TIMES)
    fit = ph.fit(rates=data, sigma_rates=SIGMA, sensor_axes="fit", start=(inertia((1, 1.1, 1.7)), OMEGA))
    k = fit.names.index("axes_3")
    assert fit.stderr[k] > 0.5
    assert any("axes_3" in text for text in fit.undetermined)
    assert any("symmetric about axis 3" in text for text in fit.undetermined)


def test_equivalent_axes():
    """All 24 numberings and directions of the axes are one body, of which the same is chosen."""
    at = Parameters(np.array([0.4, -0.3]), np.array(OMEGA), START, np.zeros(3), axes=MOUNT)
    found = at.in_order()
    assert (np.diff(found.moments) > 0).all()
    np.testing.assert_allclose(found.inertia.matrix, at.inertia.matrix, atol=1e-15)
    for turn in ([np.pi, 0, 0], [0, np.pi / 2, 0], [2 * np.pi / 3 / 3**0.5] * 3):
        quarter = ph.Rotor.from_rotation_vector(turn)
        order = np.abs(quarter.to_matrix()) @ [0, 1, 2]
        fractions = at.fractions[order.round().astype(int)]
        other = Parameters(
            np.log(fractions[:2] / fractions[2]), at.omega, START, np.zeros(3), axes=quarter * MOUNT
        )
        np.testing.assert_allclose(other.inertia.matrix, at.inertia.matrix, atol=1e-15)
        same = other.in_order()
        np.testing.assert_allclose(same.shape, found.shape, atol=1e-14)
        assert (same.axes * ~found.axes).to_rotation_vector() == pytest.approx([0, 0, 0], abs=1e-14)


def t_handle(rng):
    """A T-handle with a phone: 100 Hz for 10 s, its gyroscope rotated, biased, late and in steps of 1/1024.

    Markers of a camera give the attitude at 60 Hz, with noise of 2 mrad.
    """
    moments = np.sort(ph.Scene.read(ROOT / "examples/t-handle.toml").body.inertia.principal_moments)
    body = inertia(moments)
    # 6 rad/s about the middle axis, with a wobble.
    spin = (~MOUNT)(ph.bivector([0.1, 6.0, 0.2]))
    motion = ph.FreeMotion(body, START, spin)
    t, seen = np.arange(0, 10, 0.01), np.arange(0, 10, 1 / 60)
    bias, late = np.array([0.03, -0.05, 0.02]), 0.137
    omega = motion.at(t).omega_body.components + bias + 0.01 * rng.normal(size=(1000, 3))
    turns = ph.Rotor.from_rotation_vector(0.002 * rng.normal(size=(600, 3)))
    data = {
        "rates": (t + late, np.round(omega * 1024) / 1024),
        # A step adds the variance of a uniform distribution.
        "sigma_rates": np.sqrt(0.01**2 + 1 / 1024**2 / 12),
        "attitude": (seen, turns * motion.at(seen).rotor),
        "sigma_attitude": 0.002,
    }
    return data, moments / moments.max(), spin.components, bias, late


def test_a_recorded_t_handle():
    data, ratios, spin, bias, late = t_handle(np.random.default_rng(10))
    near = inertia(ratios * [0.99, 1, 1.01], ph.Rotor.from_rotation_vector([0.38, -0.32, 0.2]))
    start = (near, spin + 0.01)
    fit = ph.fit(**data, sensor_axes="fit", clock_offset=True, start=start)
    check_t_handle(fit, ratios, spin, bias, late)


def check_t_handle(fit, ratios, spin, bias, late):
    off = fit.values - [*ratios[:2], *spin, *np.zeros(6), *bias, -late]
    off[5:8] = (fit.rotor * ~START).to_rotation_vector()
    off[8:11] = (fit.sensor_axes * ~MOUNT).to_rotation_vector()
    # Squared errors in the metric of the covariance have mean k and variance 2k: five standard deviations.
    k = len(off)
    assert off @ np.linalg.solve(fit.covariance, off) < k + 5 * np.sqrt(2 * k)
    assert (np.abs(off) < 4.5 * fit.stderr).all()
    # Accuracy: ratios to 1e-3, axes to 1 mrad, clock to 1 ms.
    assert fit.stderr[:2].max() < 1e-3
    assert fit.stderr[8:11].max() < 2e-3
    assert fit.stderr[-1] < 1e-3
    assert abs(fit.chi2_reduced - 1) < 5 * np.sqrt(2 / fit.dof)
    assert [text.partition(":")[0] for text in fit.undetermined] == ["overall scale of the moments"]


@pytest.mark.slow
def test_a_recorded_t_handle_without_a_start():
    data, *truth = t_handle(np.random.default_rng(11))
    check_t_handle(ph.fit(**data, sensor_axes="fit", clock_offset=True), *truth)


def test_bad_axes():
    data = rates(BODY, OMEGA, np.random.default_rng(1), TIMES)
    with pytest.raises(TypeError, match="'principal', 'fit' or a single Rotor, got 'free'"):
        ph.fit(rates=data, sensor_axes="free")
    with pytest.raises(ValueError, match="does not have the principal axes of sensor_axes"):
        ph.fit(rates=data, sensor_axes=START, start=(BODY, OMEGA))
    with pytest.raises(TypeError, match="or a triple"):
        ph.fit(rates=data, start=(BODY, OMEGA, [1, 0, 0, 0]))
