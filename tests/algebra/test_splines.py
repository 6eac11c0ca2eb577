"""Splines of rotors: interpolation, smoothness and accuracy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline

import polhode as ph
from polhode import e1, e2, e3
from samples import EPS, close

lengths = st.integers(2, 40)
seeds = st.integers(0, 2**32 - 1)


def random_walk(n, seed, step=0.5):
    """Rotors whose neighbours are about `step` radians apart, with signs at random, at uneven times."""
    rng = np.random.default_rng(seed)
    turns = ph.Rotor.from_rotation_vector(step * rng.standard_normal((n, 3)))
    path = [turns[0]]
    for turn in turns[1:]:
        path.append(turn * path[-1])
    components = np.array([R.components for R in path]) * rng.choice([-1.0, 1.0], (n, 1))
    return np.cumsum(rng.uniform(0.5, 1, n)) - 3, ph.Rotor.from_components(components)


@given(lengths, seeds)
def test_the_spline_passes_through_the_rotors(n, seed):
    times, rotors = random_walk(n, seed)
    spline = ph.RotorSpline(times, rotors)
    assert np.all(spline(times).distance(rotors) <= 16 * EPS)
    assert close(spline.rotors, spline(times), 8)
    # It begins on the sheet of the first rotor and stays on it.
    assert close(spline(times[0]), rotors[0], 8)
    neighbours = (~spline.rotors[1:]).scalar_product(spline.rotors[:-1])
    assert np.all(neighbours.components >= 0)
    fine = spline(np.linspace(times[0], times[-1], 40 * n))
    assert np.all((fine[1:] - fine[:-1]).norm() < 0.5)


@given(lengths, seeds)
def test_it_is_the_cubic_spline_of_the_components_on_the_sphere(n, seed):
    """Against SciPy's spline, whose first two derivatives are continuous, also after division by the norm."""
    times, rotors = random_walk(n, seed)
    spline = ph.RotorSpline(times, rotors)
    cubic = CubicSpline(times, spline.rotors.components)
    t = np.linspace(times[0], times[-1], 5 * n)
    s, rate = cubic(t), cubic(t, 1)
    # The error of slopes is some dozens of roundings of chords over steps, which are 0.5 or more.
    assert close(spline(t), ph.Rotor.from_components(s), 64)
    even = [ph.scalar(c[:, 0]) + ph.bivector(c[:, 1:]) for c in (s, rate)]
    # R' is s'/|s| up to a part along R, and Ω_B = −2 ~R R' (handout eq. 4.13).
    expected = -2 * (~even[0] * even[1]).grade(2) / even[0].norm_squared()
    assert close(spline.omega_body(t), expected, 256, 1 + expected.norm())


def test_omega_is_the_rate_of_the_rotor():
    times, rotors = random_walk(8, 1)
    spline = ph.RotorSpline(times, rotors)
    t, h = np.linspace(times[0] + 0.01, times[-1] - 0.01, 50), 1e-6
    rate = (spline(t + h) - spline(t - h)) / (2 * h)
    # R' = −½ R Ω_B (handout eq. 4.13); differences err by h² and by rounding over h.
    assert close(-0.5 * spline(t) * spline.omega_body(t), rate, 1, 1e-8 / EPS)


@given(lengths, seeds)
def test_the_spline_is_equivariant(n, seed):
    times, rotors = random_walk(n, seed)
    Q, S = ph.Rotor.random(2, seed)
    t = np.linspace(times[0], times[-1], 30)
    turned = ph.RotorSpline(times, Q * rotors * S)(t)
    plain = ph.RotorSpline(times, rotors)(t)
    assert close(turned, Q * plain * S, 512)
    backwards = ph.RotorSpline(-times[::-1], rotors[::-1])(-t)
    assert np.all(backwards.distance(plain) <= 512 * EPS)


def motion(n):
    """The tumbling of a body: rotors and rates at n times."""
    top = ph.FreeMotion(ph.Inertia.from_principal_moments(1, 2, 3), ph.Rotor.identity(), [0.1, 1, 0.2])
    return top, np.linspace(0, 20, n)


def test_the_spline_converges_to_the_motion():
    errors = []
    for n in (41, 81, 161):
        top, times = motion(n)
        spline = ph.RotorSpline(times, top.at(times).rotor)
        t = np.linspace(0, 20, 1001)
        state = top.at(t)
        rate_error = (spline.omega_body(t) - state.omega_body).norm().max()
        errors.append((spline(t).distance(state.rotor).max(), rate_error))
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    # Fourth order in the rotor and third in the rate, at the ends, too; a little less before the limit.
    assert np.all(orders[:, 0] > 3.5)
    assert np.all(orders[:, 1] > 2.6)
    assert errors[-1][0] < 1e-5


@pytest.mark.parametrize(("step", "bound"), [(10, 2e-5), (30, 3e-3), (90, 0.7)])
def test_a_steady_turn_is_approximated(step, bound):
    k = np.arange(9.0)
    spline = ph.RotorSpline(k, ph.Rotor.from_euler("z", k[:, None] * step, degrees=True))
    t = np.linspace(0, 8, 200)
    exact = ph.Rotor.from_euler("z", t[:, None] * step, degrees=True)
    # The error falls with the fourth power of the step: 3⁴ = 81 from row to row, in degrees.
    assert np.degrees(spline(t).distance(exact).max()) < bound
    assert close(spline(t)(e3), e3, 16)


def test_two_and_three_rotors():
    a, b = ph.Rotor.identity(), ph.Rotor.from_plane_angle(e1 ^ e2, 1.0)
    pair = ph.Rotor.from_components([a.components, b.components])
    half = ph.RotorSpline([0, 2], pair)(1)
    assert close(half, ph.slerp(a, b, 0.5), 8)
    three = ph.Rotor.from_components([a.components, b.components, (b * b).components])
    spline = ph.RotorSpline([0, 1, 2], three)
    # Even about the middle one.
    assert close(spline(0.4).reverse() * b, b.reverse() * spline(1.6), 16)


def test_half_turns_keep_the_given_signs():
    rotors = ph.Rotor.from_components([[1, 0, 0, 0], [0, 0, 0, 1], [-1, 0, 0, 0]])
    spline = ph.RotorSpline([0, 1, 2], rotors)
    assert np.all(spline.rotors == rotors)


def test_shapes_and_text():
    spline = ph.RotorSpline([0, 1, 3], ph.Rotor.identity(3))
    assert spline(0.5).shape == ()
    assert spline([[0, 1], [2, 3]]).shape == (2, 2)
    assert spline.omega_body([[0, 1], [2, 3]]).shape == (2, 2)
    assert np.all(spline.omega_body([0, 0.3, 3]) == 0)
    assert np.all(spline([0, 0.3, 3]) == 1)
    assert spline([]).shape == (0,)
    spline.times[:] = 7
    assert spline.times.tolist() == [0, 1, 3]
    assert repr(spline) == "RotorSpline(3 rotors, times 0 to 3)"


def test_invalid_times_and_rotors_raise():
    three = ph.Rotor.identity(3)
    for bad in (ph.Rotor.identity(), ph.Rotor.identity(1), ph.Rotor.identity((2, 2)), e1, None):
        with pytest.raises(ValueError, match=r"rotors of shape \(n,\), n >= 2"):
            ph.RotorSpline([0, 1], bad)
    for bad in ([0, 1], [[0, 1, 2]], [0, 1, np.nan], 3):
        with pytest.raises(ValueError, match=r"times must be (3 numbers|finite, but .* index 2 is nan)"):
            ph.RotorSpline(bad, three)
    with pytest.raises(ValueError, match="2 at index 1 precedes 2"):
        ph.RotorSpline([0, 2, 2], three)
    to_and_fro = ph.Rotor.from_euler("z", [[180], [-90], [0], [90], [0]], degrees=True)
    with pytest.raises(ValueError, match="from 7 to 14 a smooth path would swing far"):
        ph.RotorSpline([0, 2, 3, 7, 14], to_and_fro)
    # The same path, backwards.
    with pytest.raises(ValueError, match="from 0 to 7 a smooth path would swing far"):
        ph.RotorSpline([0, 7, 11, 12, 14], to_and_fro[::-1])
    spline = ph.RotorSpline([0, 1, 2], three)
    with pytest.raises(ValueError, match=r"the time at index \(1,\) is 2\.1; the spline goes from 0 to 2"):
        spline([1, 2.1])
    with pytest.raises(ValueError, match="the time is -1; the spline goes from 0 to 2"):
        spline(-1)
    with pytest.raises(ValueError, match="the time is nan"):
        spline.omega_body(np.nan)
    with pytest.raises(TypeError, match="real numbers"):
        spline("1")
