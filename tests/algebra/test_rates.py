"""Attitudes from sampled rates and back, accelerations and extrapolation of splines."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import polhode as ph
from polhode import Rotor, e1, e2
from samples import close

MOMENTS = np.array([1.0, 2.0, 3.0])


def motion(n, end=20.0):
    """States of a tumbling body at n times."""
    top = ph.FreeMotion(ph.Inertia.from_principal_moments(*MOMENTS), Rotor.random(rng=1), [0.1, 1, 0.2])
    times = np.linspace(0, end, n)
    return times, top.at(times)


def acceleration(omega):
    """Euler's equations of a free body."""
    w, i = omega.components, MOMENTS
    parts = [(i[k - 2] - i[k - 1]) / i[k] * w[..., k - 2] * w[..., k - 1] for k in range(3)]
    return np.stack(parts, axis=-1)


# --- attitudes from rates


def test_the_error_is_of_fourth_order():
    errors = []
    for n in (81, 161, 321, 641):
        times, state = motion(n)
        found = ph.attitude_from_rates(times, state.omega_body, state.rotor[0])
        errors.append((found - state.rotor).norm().max())
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert np.all(abs(orders - 4) < 0.15)
    assert errors[-1] < 1e-8


def test_uneven_samples_have_the_same_order():
    rng, errors = np.random.default_rng(2), []
    shifts = rng.uniform(-0.3, 0.3, 1281)
    top = ph.FreeMotion(ph.Inertia.from_principal_moments(*MOMENTS), Rotor.identity(), [0.1, 1, 0.2])
    for n in (161, 641):
        times = (np.arange(n) + shifts[:n]) * 20 / n
        state = top.at(times)
        found = ph.attitude_from_rates(times, state.omega_body, state.rotor[0])
        errors.append((found - state.rotor).norm().max())
    assert np.log2(errors[0] / errors[1]) / 2 > 3.7


def test_a_steady_turn_is_exact():
    times, omega = np.array([0.0, 1.0, 1.5, 4.0]), np.array([0.3, -2.0, 0.7])
    found = ph.attitude_from_rates(times, np.tile(omega, (4, 1)))
    assert close(found, Rotor.from_rotation_vector(omega * times[:, None]), 16)


def test_coning_is_corrected():
    """A rate whose direction turns: without the commutator the error is of second order."""
    errors = []
    for n in (101, 201):
        times = np.linspace(0, 10, n)
        # R = exp(−½ e12 t) exp(−½ e31 ε): a spin about a tilted axis has the rate ~S (e12) S − e12.
        S = Rotor.from_plane_angle(e1 ^ e2, times) * Rotor.from_plane_angle(ph.e3 ^ e1, 0.2)
        R = S * Rotor.from_plane_angle(e1 ^ e2, -times)
        omega = (~R)(e1 ^ e2) - (e1 ^ e2)
        errors.append((ph.attitude_from_rates(times, omega, R[0]) - R).norm().max())
    assert abs(np.log2(errors[0] / errors[1]) - 4) < 0.2


@pytest.mark.parametrize("n", [1, 2, 3, 4, 7, 8])
def test_any_number_of_samples(n):
    times = np.arange(n) * 0.1
    rates = np.random.default_rng(n).standard_normal((n, 3))
    found = ph.attitude_from_rates(times, rates, Rotor.random(rng=n))
    assert found.shape == (n,)
    assert found[0] == Rotor.random(rng=n)
    # The turns from sample to sample are those of the same rates without a start.
    plain = ph.attitude_from_rates(times, ph.bivector(rates))
    assert close(Rotor.random(rng=n) * plain, found, 16)
    # About a fixed axis the turn is the integral, which is exact for polynomials that the samples determine.
    poly = np.polynomial.Polynomial([0.5, -2.0, 3.0, 4.0][: min(n, 4)])
    spun = ph.attitude_from_rates(times, poly(times)[:, None] * [0, 0.6, 0.8])
    expected = Rotor.from_rotation_vector(poly.integ()(times)[:, None] * [0, 0.6, 0.8])
    assert close(spun, expected, 32)


def test_batches_of_bodies():
    rng = np.random.default_rng(3)
    rates, start, times = rng.standard_normal((2, 3, 9, 3)), Rotor.random((3,), rng=3), np.linspace(0, 1, 9)
    found = ph.attitude_from_rates(times, rates, start)
    assert found.shape == (2, 3, 9)
    for i in range(2):
        for j in range(3):
            assert close(found[i, j], ph.attitude_from_rates(times, rates[i, j], start[j]), 16)
    assert ph.attitude_from_rates(times, rates[0, 0], start).shape == (3, 9)


def test_wrong_samples_raise():
    rates = np.ones((3, 3))
    with pytest.raises(ValueError, match=r"times must be 3 numbers, one for each rate, got shape \(2,\)"):
        ph.attitude_from_rates([0, 1], rates)
    with pytest.raises(ValueError, match="the time at index 1 is nan"):
        ph.attitude_from_rates([0, np.nan, 2], rates)
    with pytest.raises(ValueError, match="2 at index 1 precedes 1"):
        ph.attitude_from_rates([0, 2, 1], rates)
    with pytest.raises(ValueError, match=r"the rate at index \(1,\) is not finite"):
        ph.attitude_from_rates([0, 1, 2], [[0, 0, 0], [0, np.nan, 0], [0, 0, 0]])
    with pytest.raises(ValueError, match=r"needs rates \(..., n, 3\), n > 0, got shape \(3,\)"):
        ph.attitude_from_rates([0], [1, 2, 3])
    with pytest.raises(ValueError, match=r"start has \(2,\), omega_body \(4,\)"):
        ph.attitude_from_rates([0, 1, 2], np.ones((4, 3, 3)), Rotor.identity(2))
    with pytest.raises(TypeError, match="start must be a Rotor, got list"):
        ph.attitude_from_rates([0, 1, 2], rates, [1, 0, 0, 0])


# --- rates from attitudes


def test_rates_are_those_of_the_motion():
    errors = []
    for n in (161, 321, 641):
        times, state = motion(n)
        signs = np.random.default_rng(n).choice([-1.0, 1.0], (n, 1))
        found = ph.rates_from_attitude(times, Rotor.from_components(state.rotor.components * signs))
        errors.append((found - state.omega_body).norm().max())
    assert np.all(np.log2(np.divide(errors[:-1], errors[1:])) > 2.8)
    assert errors[-1] < 1e-5


def test_rates_need_two_attitudes():
    for R in (Rotor.identity(1), Rotor.identity(), Rotor.identity((2, 2))):
        with pytest.raises(ValueError, match=r"rates need at least 2 attitudes, .*, got \("):
            ph.rates_from_attitude([0], R)
    with pytest.raises(ValueError, match=r"rates need at least 2 attitudes, .*, got \(1,\)"):
        ph.rates_from_attitude([0.0], [Rotor.identity()])
    with pytest.raises(ValueError, match=r"a spline needs .* of shape \(n,\), n >= 2, got shape \(1,\)"):
        ph.RotorSpline([0], Rotor.identity(1))
    with pytest.raises(TypeError, match=r"come first: rates_from_attitude\(times, R\)"):
        ph.rates_from_attitude(Rotor.identity(2), [0, 1])


def test_there_and_back():
    times, state = motion(401)
    rates = ph.rates_from_attitude(times, state.rotor)
    found = ph.attitude_from_rates(times, rates, state.rotor[0])
    # Rates err by h³ at the ends and h⁴ inside, with derivatives of some units.
    assert found.distance(state.rotor).max() < 1e-5


# --- accelerations of splines


def test_accelerations_converge_to_those_of_the_motion():
    errors = []
    for n in (161, 321, 641):
        times, state = motion(n)
        spline = ph.RotorSpline(times, state.rotor)
        t = np.linspace(0, 20, 1001)
        top = ph.FreeMotion(ph.Inertia.from_principal_moments(*MOMENTS), state.rotor[0], [0.1, 1, 0.2])
        errors.append(np.abs(spline.alpha_body(t).components - acceleration(top.at(t).omega_body)).max())
    assert np.all(np.log2(np.divide(errors[:-1], errors[1:])) > 1.7)
    assert errors[-1] < 2e-3


def test_accelerations_are_rates_of_the_rates():
    times, state = motion(41)
    spline, h = ph.RotorSpline(times, state.rotor), 1e-5
    t = np.linspace(0.1, 19.9, 96)  # no knot within h
    slope = (spline.omega_body(t + h) - spline.omega_body(t - h)) / (2 * h)
    # Differences err by h² times third derivatives of some hundreds, and by rounding over h.
    assert (spline.alpha_body(t) - slope).norm().max() < 1e-7
    # Against SciPy's second derivative of the components: α = −2 <~R s''>₂/|s| − Ω (|s|²)'/|s|².
    cubic = CubicSpline(times, spline.rotors.components)
    s, rate, bend = (cubic(t, k) for k in range(3))
    R = Rotor.from_components(s)
    size = np.linalg.norm(s, axis=-1)
    parts = [(~R * (ph.bivector(x[:, 1:]) + x[:, 0])).grade(2) * (-2 / size) for x in (rate, bend)]
    expected = parts[1] - parts[0] * (2 * (s * rate).sum(-1) / size**2)
    assert close(spline.alpha_body(t), expected, 4096)
    assert spline.alpha_body(1.0).shape == ()
    assert spline.alpha_body([[1.0, 2.0]]).shape == (1, 2)


# --- extrapolation


def test_extrapolation_goes_on_at_a_constant_rate():
    times, state = motion(21, 2.0)
    spline = ph.RotorSpline(times, state.rotor, extrapolate=True)
    plain = ph.RotorSpline(times, state.rotor)
    inside = np.linspace(0, 2, 9)
    assert np.all(spline(inside) == plain(inside))
    assert np.all(spline.omega_body(inside) == plain.omega_body(inside))
    for end, t in ((2.0, 3.5), (0.0, -1.0)):
        omega = plain.omega_body(end)
        expected = plain(end) * (-0.5 * (t - end) * omega).exp()
        assert close(spline(t), expected, 4)
        assert spline.omega_body(t) == omega
        assert spline.alpha_body(t) == 0 * omega
    mixed = spline([-1.0, 1.0, 3.5])
    assert mixed[1] == plain(1.0)
    assert close(mixed[0], spline(-1.0), 4)
    with pytest.raises(ValueError, match=r"the time is 3.5; the spline goes from 0 to 2 \(extrapolate=True"):
        plain(3.5)
    with pytest.raises(ValueError, match="the time is inf"):
        spline(np.inf)


def test_splines_take_lists_of_rotors():
    R, S = Rotor.random(2, rng=5)
    assert np.all(ph.RotorSpline([0, 1], [R, S]).rotors == ph.RotorSpline([0, 1], ph.stack([R, S])).rotors)
