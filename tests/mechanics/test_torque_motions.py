"""Motions under torques that depend on the attitude, against SciPy at tight tolerances."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import polhode as ph
from motions import EPS, R0, START, moments

I = np.array([1, 2, 2.5])  # noqa: E741
BODY = moments(*I)
REST = ph.Rotor.from_components([1, 0.2, 0.3, -0.1])


def matrix(c):
    """Rotation matrix of rotor components: the quaternion (s, −x, −y, −z)."""
    w, x, y, z = c[0], -c[1], -c[2], -c[3]
    return np.array(
        [
            [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ]
    )


def rates(torque):
    """R' = −½ R Ω and Euler's equations with an axial torque(t, A, ω, rotor) in body axes, A the matrix."""

    def f(t, y):
        (s, b), w = (y[0], y[1:4]), y[4:]
        # The product of s + Ib and Iω is −b·ω + I(sω − b x ω).
        r = -0.5 * np.concatenate([[-b @ w], s * w - np.cross(b, w)])
        N = torque(t, matrix(y[:4]), w, y[:4])
        return np.concatenate([r, (N - np.cross(w, I * w)) / I])

    return f


def kepler(M, e):
    E = M
    for _ in range(50):
        E = E - (E - e * np.sin(E) - M) / (1 - e * np.cos(E))
    return E


def on_an_orbit(n, e, M0):
    def torque(t, A, w, r):
        E = kepler(n * t + M0, e)
        u = A.T @ np.array([np.cos(E) - e, np.sqrt(1 - e * e) * np.sin(E), 0]) / (1 - e * np.cos(E))
        return 3 * n**2 / (1 - e * np.cos(E)) ** 3 * np.cross(u, I * u)

    return torque


def spring(k, rest):
    back = rest * [1, -1, -1, -1]

    def torque(t, A, w, r):
        s, b = back[0], back[1:]
        q = np.concatenate([[s * r[0] - b @ r[1:]], s * r[1:] + r[0] * b - np.cross(b, r[1:])])
        q = q if q[0] >= 0 else -q
        size = np.linalg.norm(q[1:])
        return 2 * k * np.arctan2(size, q[0]) * q[1:] / size

    return torque


CUBIC = np.array([[0.3, 0, 0.1], [0, 0.5, 0], [-0.2, 0.1, 0.4], [0.1, 0, 0]])

CASES = {
    "magnetic": (
        ph.torque.magnetic([0.3, -0.7, 0.2], [0.2, -0.4, 1.1]),
        lambda t, A, w, r: np.cross([0.3, -0.7, 0.2], A.T @ [0.2, -0.4, 1.1]),
    ),
    "torsion spring": (ph.torque.torsion_spring(1.5, REST), spring(1.5, REST.components)),
    "eccentric orbit": (ph.torque.gravity_gradient(0.7, 0.3, 0.2), on_an_orbit(0.7, 0.3, 0.2)),
    "formula of t": (
        ph.torque.formula("cos(3t) e1e2 + sin(t) I(~R e1 R I)"),
        lambda t, A, w, r: np.cos(3 * t) * np.array([0, 0, 1]) + np.sin(t) * I * A[0],
    ),
    "parabola": (
        ph.torque.tabulated([-10, 2, 20], CUBIC[:3], kind="cubic"),
        lambda t, A, w, r: np.array(
            [np.polyval(np.polyfit([-10, 2, 20], CUBIC[:3, k], 2), t) for k in range(3)]
        ),
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_motions_agree_with_dop853(name):
    law, torque = CASES[name]
    t = np.linspace(0, 8, 9)
    y0 = np.concatenate([R0.components, START.omega_body.components])
    exact = solve_ivp(rates(torque), (0, 8), y0, "DOP853", t, rtol=3e-14, atol=1e-15).y.T
    motion = ph.simulate(BODY, START, t, law, rtol=1e-11)
    # DOP853 at its tightest errs by some 1e-12 in these few turns.
    np.testing.assert_allclose(motion.rotor.components, exact[:, :4], rtol=0, atol=2e-11)
    np.testing.assert_allclose(motion.omega_body.components, exact[:, 4:], rtol=0, atol=4e-11)


@pytest.mark.parametrize(
    ("law", "names"),
    [
        (ph.torque.magnetic([0.3, -0.7, 0.2], [0.2, -0.4, 1.1]), {"energy", "axial_angular_momentum"}),
        (
            ph.torque.magnetic([0.3, -0.7, 0.2], [0, 0, -2]) + ph.torque.heavy([0.5, 0.25, 1.0]),
            {"energy", "vertical_angular_momentum"},
        ),
        (ph.torque.torsion_spring(1.5, REST), {"energy"}),
        (ph.torque.gravity_gradient(0.7, 0.0, 0.2), {"jacobi_integral"}),
        (ph.torque.gravity_gradient(0.7, 0.1, 0.2), set()),
        (ph.torque.formula("(~R e3 R) ∧ e1"), set()),
    ],
)
def test_conserved_quantities_stay_constant(law, names):
    """Roundings of 10,000 steps of 51 turns add up at random: √(51e4) of half an ulp, four times."""
    motion = ph.simulate(BODY, START, np.linspace(0, 200, 101), law, step=0.02)
    assert motion.certificate.drift.keys() == names
    for name, drift in motion.certificate.drift.items():
        assert drift <= 2 * EPS * np.sqrt(51e4), name


@pytest.mark.parametrize("c", [[1, 0, 0], [0.6, -0.8, 0]])
def test_integrals_of_special_tops_are_monitored(c):
    start = ph.State(ph.Rotor.from_components([4, 1, -2, 1]), [0.5, -0.25, 1.5])
    times = np.linspace(0, 100, 11)
    motion = ph.simulate(moments(2, 2, 1), start, times, ph.torque.heavy(c), step=0.02)
    assert motion.certificate.drift["kovalevskaya_integral"] <= 4 * EPS * np.sqrt(51 * 5000)
    if c[1] == 0:
        assert motion.certificate.conserved["kovalevskaya_integral"] == pytest.approx(
            0.76604467975206611, rel=8 * EPS
        )
    motion = ph.simulate(moments(4, 4, 1), start, times, ph.torque.heavy(c), step=0.02)
    assert motion.certificate.drift.keys() == {"energy", "vertical_angular_momentum"}
    motion = ph.simulate(moments(1, 1, 0.5), start, times, ph.torque.heavy([0, 0, 2]), step=0.02)
    assert motion.certificate.drift["spin_angular_momentum"] <= 4 * EPS * np.sqrt(51 * 5000)


@pytest.mark.filterwarnings("ignore:with step = .* the body turns by more than")
@pytest.mark.parametrize("method", ["strang", "kahan_li6", "kahan_li8"])
@pytest.mark.parametrize("end", [1.0, 0.7, 10.1, 1e6 / 3])
def test_a_table_may_end_where_the_motion_does(method, end):
    """The rounding of the last stage's time does not leave the table."""
    law = ph.torque.tabulated([0, 0.4 * end, end], np.outer([1, 2, 1], [0.1, 0, 0.2]) / end)
    for steps in (1, 3, 7, 10, 29, 100):
        motion = ph.simulate(BODY, ph.State(R0, [0, 0, 0]), [end], law, method=method, step=end / steps)
        assert np.isfinite(motion.rotor.components).all()
    with pytest.raises(ValueError, match="table of torques spans 0 s to"):
        ph.simulate(BODY, START, [1.01 * end], law, method=method, step=end / 7)
