"""Polhodes and herpolhodes: closed, on their quadrics, in the invariable plane."""

import numpy as np
import pytest

import polhode as ph
from motions import EPS, R0, moments

TUMBLING = {
    "short axis": (moments(1, 2, 3), [0.25, -0.5, 1.0]),
    "long axis": (moments(1, 2, 3), [1.0, 0.5, -0.25]),
    "near the separatrix": (moments(1, 2, 3), [1e-9, 1.0, 1e-9]),
    "symmetric": (moments(1, 1, 2), [0.5, -0.25, 1.0]),
    "turned": (ph.Inertia.from_matrix([[2, 0.3, 0.1], [0.3, 3, -0.2], [0.1, -0.2, 3.5]]), [0.25, -0.5, 1.0]),
}
STEADY = [((1, 2, 3), [0, 0, -2.0]), ((2, 2, 2), [1.0, 2, 3]), ((1, 2, 3), [0, 0, 0])]


@pytest.mark.parametrize(("inertia", "omega"), TUMBLING.values(), ids=TUMBLING.keys())
def test_the_polhode_is_closed_and_conserves(inertia, omega):
    motion = ph.FreeMotion(inertia, R0, omega)
    facts, curve = motion.describe(), motion.polhode(65)
    assert curve.shape == (65,)
    assert curve[0] == curve[64]
    times = np.arange(65) * (facts["period"] / 64)
    # A time is rounded, and the spin changes by as much as it turns in it.
    exact = motion.at(times[:-1]).omega_body
    assert np.abs((curve[:64] - exact).norm()).max() <= 1e2 * EPS * (1 + facts["period"])
    momentum = inertia(curve)
    # |a·b| is −a·b of bivectors.
    np.testing.assert_allclose(-curve.dot(momentum)._data[..., 0], 2 * facts["energy"], rtol=64 * EPS)
    np.testing.assert_allclose(momentum.norm(), facts["angular_momentum"], rtol=64 * EPS)
    # Half way round the spin about the middle axis is turned over.
    if facts["flip_time"] is not None:
        F = inertia.principal_frame
        middle = (~F)(curve).components[:, 1]
        np.testing.assert_allclose(middle[:33], -middle[32:], atol=1e-6)


@pytest.mark.parametrize(("inertia", "omega"), TUMBLING.values(), ids=TUMBLING.keys())
def test_the_herpolhode_lies_in_the_invariable_plane(inertia, omega):
    """Poinsot: ``Ω_S·L = −2E``."""
    motion = ph.FreeMotion(inertia, R0, omega)
    facts, curve = motion.describe(), motion.herpolhode(101, 3.5)
    L = R0(inertia(ph.bivector(omega)))
    np.testing.assert_allclose(curve.dot(L)._data[..., 0], -2 * facts["energy"], rtol=64 * EPS)
    state = motion.at(3.5 * facts["period"])
    assert (curve[100] - state.rotor(state.omega_body)).norm() <= 1e2 * EPS * (1 + facts["period"])
    # After a period it is turned about L, by the phase.
    turn = (-0.5 * facts["phase_per_period"] * L / L.norm()).exp()
    later = motion.herpolhode(2)
    turned = turn * later[0] * ~turn
    assert (turned - later[1]).norm() <= 1e2 * EPS * (1 + facts["period"])


@pytest.mark.parametrize(("i", "omega"), STEADY)
def test_steady_curves_are_points(i, omega):
    motion = ph.FreeMotion(moments(*i), R0, omega)
    polhode, herpolhode = motion.polhode(3), motion.herpolhode(4, 2)
    np.testing.assert_array_equal(polhode.components, [omega] * 3)
    np.testing.assert_allclose(herpolhode.components, [R0(ph.bivector(omega)).components] * 4, atol=8 * EPS)


def test_the_separatrix_goes_from_pole_to_pole():
    motion = ph.FreeMotion(moments(1, 2, 2.25), R0, [0.375, 0.5, 0.5])
    curve = motion.polhode(41).components
    end = np.sqrt(2 * 0.6015625 / 2)
    np.testing.assert_allclose(curve[[0, -1], 1], [-end, end], rtol=8 * EPS)
    assert np.abs(curve[[0, -1]][:, [0, 2]]).max() <= 2 * np.exp(-20) * np.abs(curve).max()
    assert (np.diff(curve[:, 1]) >= -EPS).all()
    L = motion.describe()["angular_momentum"]
    np.testing.assert_allclose(motion.herpolhode(41).norm()[[0, -1]], L / 2, rtol=1e-12)


def test_bad_curves_are_refused():
    motion = ph.FreeMotion(moments(1, 2, 3), R0, [0.25, -0.5, 1.0])
    with pytest.raises(ValueError, match="n is 1"):
        motion.polhode(1)
    with pytest.raises(TypeError, match="whole number"):
        motion.polhode(2.5)
    for periods in (-1.0, 0.0, np.inf, np.nan):
        with pytest.raises(ValueError, match=rf"periods is {periods}; it must be positive and finite"):
            motion.herpolhode(5, periods)
    with pytest.raises(ValueError, match="beyond"):
        motion.herpolhode(5, 1e20)
