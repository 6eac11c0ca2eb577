"""Error estimates of adaptive steps that stops cut short: at outputs, knots of tables and sharp changes."""

import numpy as np
import pytest

import polhode as ph

ONE = ph.Rotor.identity()
INERTIA = ph.Inertia.from_principal_moments(1, 1.3, 1.7)


def distance(found, exact):
    """The largest difference of two motions, as the tolerance counts it."""
    turned = np.linalg.norm(found.rotor.components - exact.rotor.components, axis=-1).max()
    spun = np.linalg.norm(found.omega_body.components - exact.omega_body.components, axis=-1).max()
    return max(turned, spun / np.linalg.norm(exact.omega_body.components, axis=-1).max())


# Inertia, rate, amplitude, k, d, duration and tolerance of smoothed square waves. Their estimates were up to
# a thousand times too small: sweeps shared the steps after the start and those between stops around a jump.
SQUARE_WAVES = [
    ((1.082, 1.767, 1.771), (1.27, -0.5, 0.5), (0.93, -1.02, 0.25), 2.73, 0.01005, 1.07, 5.42e-5),
    ((1.218, 1.237, 1.649), (-1.61, -2.65, -0.06), (-0.86, 1.09, 0.09), 1.01, 0.00691, 2.279, 3.11e-4),
    ((1.006, 1.55, 1.582), (-0.31, -0.17, 0.95), (-0.73, -0.76, 1.62), 2.83, 0.00213, 2.766, 3.28e-7),
    ((1.216, 1.354, 1.954), (-0.05, -2.35, -0.68), (1.57, 1.5, -1.65), 2.9, 0.00136, 1.733, 1.43e-7),
    ((1.154, 1.155, 1.66), (0.91, -0.52, 0.12), (-0.39, -0.66, -0.61), 1.2, 0.0497, 0.049, 1.38e-5),
]


@pytest.mark.parametrize("case", SQUARE_WAVES)
def test_estimates_of_sharp_smooth_laws_are_not_far_below_the_error(case):
    inertia, rate, amplitude, k, d, duration, rtol = case
    law = ph.torque.formula("sin(k t)/norm(sin(k t) + d e1) A", k=k, d=d, A=ph.bivector(amplitude))
    problem = ph.Inertia.from_principal_moments(*inertia), ph.State(ONE, rate), [duration], law
    found, exact = (ph.simulate(*problem, method="dop853", rtol=x) for x in (rtol, 1e-12))
    assert distance(found, exact) <= min(rtol, 3 * found.certificate.error_estimate)


@pytest.mark.parametrize("frame", ["body", "space"])
@pytest.mark.parametrize("kind", ["linear", "cubic", "previous"])
@pytest.mark.parametrize("rows", [12, 60, 200])
def test_estimates_with_dense_tables_are_not_far_below_the_error(rows, kind, frame):
    """Most steps go from knot to knot, in which the error estimates of steps are small by far."""
    rng = np.random.default_rng(rows)
    for duration in (1.0, 10.0):
        table = np.linspace(-1, duration + 1, rows), rng.normal(size=(rows, 3))
        law = ph.torque.tabulated(*table, frame=frame, kind=kind)
        problem = INERTIA, ph.State(ONE, 0.3 * rng.normal(size=3)), [duration / 2, duration], law
        exact = ph.simulate(*problem, method="dop853", rtol=1e-12)
        for rtol in (1e-8, 1e-5):
            found = ph.simulate(*problem, method="dop853", rtol=rtol)
            estimate = 3 * found.certificate.error_estimate + exact.certificate.error_estimate
            assert distance(found, exact) <= min(rtol, estimate)


def test_the_estimate_with_dense_outputs_is_not_far_below_the_error():
    """Outputs cut most steps of both sweeps, which share these errors."""
    law = ph.torque.formula("exp(sin(k t)) A", frame="space", k=9.28, A=ph.bivector([-2.08, -0.14, 10.2]))
    rotor = ph.Rotor.from_quaternion([-0.49, -0.265, -0.643, 0.525], order="wxyz")
    problem = INERTIA, ph.State(rotor, [1.01, -0.256, 0.286]), np.linspace(0, 11.68, 1001), law
    exact = ph.simulate(*problem, method="dop853", rtol=1e-11)
    for rtol in (1e-8, 1e-7, 1e-6, 6.58e-6, 1e-5, 1e-4):
        found = ph.simulate(*problem, method="dop853", rtol=rtol)
        assert distance(found, exact) <= 5 * found.certificate.error_estimate
