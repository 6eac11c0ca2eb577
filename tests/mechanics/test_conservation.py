"""Conserved quantities of long motions: norm, momentum, energy, and integrals of solvable tops."""

import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, EPS, METHODS, SLOPES, START, SYMMETRIC, moments, random_walk

LONG = 100_000


# For a free body rkn6 is the exact solution, slowly.
STEPPING = [method for method in METHODS if method != "rkn6"]
# The classical method conserves nothing by construction.
KEEPING = [method for method in METHODS if method != "rk4"]


@pytest.mark.parametrize("method", [method for method in STEPPING if method in SYMMETRIC])
def test_free_motion_conserves_to_rounding(method):
    """|R|, L in size and direction; energy without drift: its error late is that early on."""
    h = 0.02
    motion = ph.simulate(ASYMMETRIC, START, np.linspace(0, LONG * h, 1001), method=method, step=h)
    assert motion.certificate.steps == LONG
    assert np.abs(motion.rotor.norm() - 1).max() <= 2 * EPS
    L = motion.momentum_space
    size = START.omega_body.components * [1, 2, 3]
    # A few ulps for the result; the 1e5 steps add nothing, because each restores it.
    assert np.abs(L.norm() / np.linalg.norm(size) - 1).max() <= 4 * EPS
    drift = np.abs(motion.energy / motion.energy[0] - 1)
    early, late = drift[:100].max(), drift[-100:].max()
    assert late <= 1.5 * early + random_walk(LONG, method)
    assert motion.certificate.drift["energy"] >= drift.max() - 2 * EPS
    assert motion.certificate.drift["angular_momentum"] <= 4 * EPS


@pytest.mark.parametrize("method", [method for method in STEPPING if method in KEEPING])
def test_free_motion_keeps_the_direction_of_L(method):
    h = 0.02
    motion = ph.simulate(ASYMMETRIC, START, np.linspace(0, LONG * h, 1001), method=method, step=h)
    L = motion.momentum_space
    # Each step restores it to first order; what is left is a random walk of the rounding of that.
    assert (L - L[0]).norm().max() <= L[0].norm() * EPS * np.sqrt(LONG)


@pytest.mark.parametrize("method", ["midpoint", "dmv", "rkn6"])
def test_methods_that_conserve_the_energy_of_a_free_body(method):
    """To rounding, in steps that turn it by half a radian."""
    motion = ph.simulate(ASYMMETRIC, START, np.linspace(0, 4000, 101), method=method, step=0.4)
    assert np.abs(motion.energy / motion.energy[0] - 1).max() <= random_walk(10_000, method)


@pytest.mark.parametrize("i", [(2, 2, 1), (1, 1, 1.75), (2, 2, 0.5)])
@pytest.mark.parametrize("method", ["strang", "kahan_li8"])
def test_the_spin_of_a_symmetric_top_does_not_drift(i, method):
    """ω3 and the energy are constant; their rounding adds up at random and not in one direction."""
    h = 1 / 128
    motion = ph.simulate(moments(*i), START, np.linspace(0, LONG * h, 101), method=method, step=h)
    bound = random_walk(LONG, method)
    assert np.abs(motion.omega_body.components[:, 2] - 1.0).max() <= bound
    assert np.abs(motion.energy / motion.energy[0] - 1).max() <= bound


def heavy_run(i, c, omega, method="kahan_li8", h=0.02, steps=20_000):
    state = ph.State(ph.Rotor.from_components([4, 1, -2, 1]), omega)
    times = np.linspace(0, steps * h, 1001)
    return ph.simulate(moments(*i), state, times, ph.torque.heavy(c), method=method, step=h)


def test_the_classical_method_conserves_by_its_order_alone():
    """Energy and L change by the fourth or the fifth power of the step."""

    def drift(h):
        motion = ph.simulate(ASYMMETRIC, START, [50.0], method="rk4", step=h)
        return np.array(list(motion.certificate.drift.values()))

    slopes = np.log2(drift(1 / 8) / drift(1 / 16))
    assert ((slopes > 3.7) & (slopes < 5.5)).all()


@pytest.mark.parametrize("method", KEEPING)
def test_heavy_tops_conserve_energy_and_vertical_momentum(method):
    """L_z to the rounding of a random walk, energy without drift."""
    motion = heavy_run((1, 1, 0.5), [0, 0, 2], [0.25, -0.5, 6.0], method)
    Lz = motion.momentum_space.components[:, 2]
    L = motion.momentum_space.norm().max()
    assert np.abs(Lz - Lz[0]).max() <= L * random_walk(20_000, method)
    drift = np.abs(motion.energy - motion.energy[0]) / motion.energy[0]
    if method in SYMMETRIC:
        assert drift[-100:].max() <= 1.5 * drift[:100].max() + random_walk(20_000, method)
    assert np.abs(motion.rotor.norm() - 1).max() <= 2 * EPS
    gravity = motion.rotor.to_matrix()[:, 2, 2] * 2
    kinetic = 0.5 * (motion.omega_body.components**2 @ [1, 1, 0.5])
    np.testing.assert_allclose(kinetic + gravity, motion.energy, rtol=8 * EPS)


def test_the_spin_of_lagranges_top_is_constant():
    motion = heavy_run((1, 1, 0.5), [0, 0, 2], [0.25, -0.5, 6.0])
    spin = motion.omega_body.components[:, 2]
    assert np.abs(spin / 6.0 - 1).max() <= random_walk(20_000)


def test_kovalevskayas_integral():
    """i = (2, 2, 1), c on e1: K = (ω1² − ω2² − (c1/i3)γ1)² + (2ω1ω2 − (c1/i3)γ2)²."""
    motion = heavy_run((2, 2, 1), [1, 0, 0], [0.5, -0.25, 1.5])
    w = motion.omega_body.components
    gamma = motion.rotor.to_matrix()[:, 2]
    K = (w[:, 0] ** 2 - w[:, 1] ** 2 - gamma[:, 0]) ** 2 + (2 * w[:, 0] * w[:, 1] - gamma[:, 1]) ** 2
    assert K[0] == pytest.approx(0.76604467975206611, rel=8 * EPS)
    # Squares of ω up to 2 with two roundings each, and one more square.
    assert np.abs(K - K[0]).max() <= 16 * random_walk(20_000)


def test_goryachev_chaplygin_integral():
    """i = (4, 4, 1), c on e1, L_z = 0: ω3(ω1² + ω2²) − (c1/i3)γ3 ω1."""
    R = ph.Rotor.from_components([4, 1, -2, 1])
    gamma = R.to_matrix()[2]
    omega = np.array([0.5, -0.25, 0.0])
    omega[2] = -4 * (gamma[0] * omega[0] + gamma[1] * omega[1]) / gamma[2]
    motion = ph.simulate(
        moments(4, 4, 1), ph.State(R, omega), np.linspace(0, 100, 501), ph.torque.heavy([1, 0, 0]), step=0.02
    )
    assert np.abs(motion.momentum_space.components[:, 2]).max() <= 10 * random_walk(5000)
    w, g = motion.omega_body.components, motion.rotor.to_matrix()[:, 2]
    F = w[:, 2] * (w[:, 0] ** 2 + w[:, 1] ** 2) - g[:, 2] * w[:, 0]
    scale = np.abs(w).max() ** 3
    assert np.abs(F - F[0]).max() <= 16 * scale * random_walk(5000)


def test_jacobis_integral_of_a_satellite():
    """½ω·Iω − n L·N + (3/2) n² u·I(u), N = e3, u = cos(nt) e1 + sin(nt) e2."""
    i, n, h = np.array([1, 2, 2.5]), 1.0, 0.02
    state = SLOPES["gravity gradient"][1]
    times = np.linspace(0, LONG / 5 * h, 501)
    motion = ph.simulate(moments(*i), state, times, ph.torque.gravity_gradient(n), step=h)
    w = motion.omega_body.components
    u = np.stack([np.cos(n * times), np.sin(n * times), np.zeros(501)], axis=1)
    in_body = np.einsum("nij,ni->nj", motion.rotor.to_matrix(), u)
    jacobi = 0.5 * w**2 @ i - n * motion.momentum_space.components[:, 2] + 1.5 * n**2 * in_body**2 @ i
    assert jacobi[0] == pytest.approx(0.50053320521094026, rel=8 * EPS)
    assert np.abs(jacobi - jacobi[0]).max() <= 8 * random_walk(LONG / 5)
    assert motion.certificate.drift.keys() == {"jacobi_integral"}
    assert motion.certificate.conserved["jacobi_integral"] == pytest.approx(jacobi[0], rel=8 * EPS)
