"""Fits of free bodies to synthetic attitudes and rates: coverage, every regime, errors."""

import itertools
import json
import re
from pathlib import Path

import numpy as np
import pytest

import polhode as ph
from coverage_of_fits import check_coverage
from polhode._fit.model import Model
from polhode._fit.parameters import Layout, Parameters
from polhode._fit.samples import attitudes_of, rates_of

pytest.importorskip("scipy")

ROOT = Path(__file__).parents[2]
BODY = ph.Inertia.from_principal_moments(1, 2, 2.6)
OMEGA = ph.bivector([0.3, 4.0, 0.9])
START = ph.Rotor.from_rotation_vector([0.3, -0.8, 0.5])
BIAS = np.array([0.03, -0.05, 0.02])
TIMES = np.linspace(100.0, 106.0, 120)
SIGMA = 0.02
OFFSET = 0.013


def motion(inertia=BODY, omega=OMEGA):
    return ph.FreeMotion(inertia, START, omega)


def measured(kind, rng, times=TIMES, free=None, bias=BIAS, sigma=SIGMA):
    """Noisy data, as arguments of `fit`."""
    free, t = motion() if free is None else free, times - times[0]
    data = {}
    if kind in ("attitude", "both"):
        turns = ph.Rotor.from_rotation_vector(sigma * rng.normal(size=(len(t), 3)))
        data |= {"attitude": (times, turns * free.at(t).rotor), "sigma_attitude": sigma}
    if kind in ("rates", "both"):
        late = OFFSET if kind == "both" else 0.0
        exact = free.at(t + late).omega_body.components
        noise = sigma * rng.normal(size=(len(t), 3))
        data |= {"rates": (times, exact + bias + noise), "sigma_rates": sigma}
        data |= {"clock_offset": kind == "both"}
    return data


def truth(kind):
    """Values of the parameters in the order of `Fit.names`."""
    values = [1 / 2.6, 2 / 2.6, *OMEGA.components]
    if kind != "rates":
        values += [0.0] * 3
    if kind != "attitude":
        values += list(BIAS)
    return np.array(values + [OFFSET] * (kind == "both"))


def errors(fit, kind):
    """Values minus true values; an attitude by its small turn."""
    off = fit.values - truth(kind)
    if fit.rotor is not None:
        off[5:8] = (fit.rotor * ~START).to_rotation_vector()
    return off


def check(kind, draws, start):
    rng = np.random.default_rng(18)
    check_coverage(lambda: ph.fit(**measured(kind, rng), start=start), lambda fit: errors(fit, kind), draws)


@pytest.mark.parametrize("kind", ["rates", "attitude", "both"])
def test_intervals_cover_the_truth(kind):
    check(kind, 25, (BODY, OMEGA))


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["rates", "attitude", "both"])
def test_intervals_cover_the_truth_of_200_searches(kind):
    check(kind, 200, None)


@pytest.mark.parametrize("order", list(itertools.permutations((1, 2, 2.6))))
def test_the_search_finds_each_order_of_the_moments(order):
    body = ph.Inertia.from_principal_moments(*order)
    data = measured("rates", np.random.default_rng(3), free=motion(body))
    fit = ph.fit(**data)
    off = fit.inertia.principal_moments - np.array(order) / 2.6
    # 6 standard deviations of the less certain ratio.
    assert np.abs(off).max() < 6 * fit.stderr[:2].max() < 0.2
    # The mean of squared residuals has the variance 2/dof.
    assert abs(fit.chi2_reduced - 1) < 6 * np.sqrt(2 / fit.dof)


def test_a_recorded_t_handle():
    """100 Hz for 10 s with a biased gyroscope, as of a phone: ratios within 4 standard deviations."""
    scene = ph.Scene.read(ROOT / "examples/t-handle.toml")
    moments = scene.body.inertia.principal_moments
    body = ph.Inertia.from_principal_moments(*moments)
    times = np.arange(0, 10, 0.01)
    spin = np.array([0.1, 0.1, 0.1])
    spin[np.argsort(moments)[1]] = 6.0
    free = ph.FreeMotion(body, START, spin)
    data = measured("rates", np.random.default_rng(7), times, free)
    fit = ph.fit(**data)
    true = [*(x for x in moments / moments.max() if x < 1), *spin, *BIAS]
    assert (np.abs(fit.values - true) < 4 * fit.stderr).all()
    assert fit.stderr[:2].max() < 1e-3
    assert (fit.interval(0.99999)[:, 0] < true).all()
    assert fit.rotor is None
    assert fit.state.time == 0


@pytest.mark.parametrize("axes", [False, True])
@pytest.mark.parametrize("kind", ["rates", "attitude", "both"])
def test_derivatives_are_exact(kind, axes):
    """Against central differences of step h: h² of the third derivative and 1e-16/h of rounding."""
    data = measured(kind, np.random.default_rng(1))
    attitudes = attitudes_of(data.get("attitude"), SIGMA)
    layout = Layout(kind != "rates", kind != "attitude", kind == "both", axes)
    model = Model(attitudes, rates_of(data.get("rates"), SIGMA), TIMES[0], layout)
    rotor = None if kind == "rates" else START
    frame = ph.Rotor.from_rotation_vector([0.5, 0.2, -0.7]) if axes else ph.Rotor.identity()
    base = Parameters(np.array([0.4, -0.3]), OMEGA.components, rotor, np.zeros(3), axes=frame)
    step = np.random.default_rng(2).normal(size=model.size) * 0.1
    exact = model.jacobian(layout.moved(base, step), step)
    h = 1e-5
    for k, row in enumerate(np.eye(model.size) * h):
        ahead, behind = (model.residuals(layout.moved(base, step + s * row)) for s in (1, -1))
        column = (ahead - behind) / (2 * h)
        # Frequencies of up to 10 over 6 s: h² times the third derivative is less than 1e-6 of the first.
        assert np.abs(column - exact[:, k]).max() < 2e-6 * np.abs(exact[:, k]).max()


def test_estimated_noise_is_that_of_the_data():
    data = measured("rates", np.random.default_rng(5))
    del data["sigma_rates"]
    fit, known = ph.fit(**data), ph.fit(**data, sigma_rates=SIGMA)
    assert fit.chi2_reduced is None
    # The mean square of 3·120 components has the relative standard deviation √(2/360).
    assert abs(fit.noise["rates"] / SIGMA - 1) < 4 * 0.5 * np.sqrt(2 / 360)
    # Equal weights give equal estimates, up to the relative change of the sum of squares that ends a search.
    assert (np.abs(fit.values - known.values) < 0.01 * known.stderr).all()
    scale = np.sqrt(known.chi2_reduced)
    np.testing.assert_allclose(fit.stderr, scale * known.stderr, rtol=0.01)
    # Student's quantiles are wider.
    widths = [np.diff(x.interval(), axis=1)[:, 0] / x.stderr for x in (fit, known)]
    assert (widths[0] > widths[1]).all()


@pytest.mark.parametrize("noise", [1e-4, 1e-6, 1e-8])
def test_intervals_of_a_flat_body_cover_the_truth_at_any_noise(noise):
    """The second moment across the plane is 0, whose logarithm a prior pulls if the noise is not known."""
    flat, rng = ph.Inertia.from_principal_moments(1, 2, 3), np.random.default_rng(41)
    rates = ph.FreeMotion(flat, START, [0.1, 1, 0.1]).at(np.linspace(0, 20, 101)).omega_body.components
    errors = []
    for _ in range(6):
        found = ph.fit(
            rates=(np.linspace(0, 20, 101), rates + noise * rng.normal(size=rates.shape)), bias=False
        )
        assert found.noise["rates"] == pytest.approx(noise, rel=0.2)
        ratios = np.array([found.values[found.names.index(name)] for name in ("i1/i3", "i2/i3")])
        deviations = [found.stderr[found.names.index(name)] for name in ("i1/i3", "i2/i3")]
        errors.append((ratios - [1 / 3, 2 / 3]) / deviations)
    # Of 12 normal numbers, of which those of a fit depend on each other, in standard deviations.
    assert np.sqrt(np.mean(np.square(errors))) < 2


def test_exact_data_give_the_body_to_rounding():
    free, t = motion(), TIMES - 100
    fit = ph.fit(rates=(TIMES, free.at(t).omega_body), bias=False)
    np.testing.assert_allclose(fit.inertia.principal_moments, [1 / 2.6, 2 / 2.6, 1], atol=1e-8)
    assert fit.bias is None
    again = ph.simulate(fit.inertia, fit.state, TIMES[1:])
    assert (again.omega_body - free.at(t[1:]).omega_body).norm().max() < 1e-7


class TestUndetermined:
    """The statements follow from the singular values: the same motion, longer or less steady, has none."""

    def statements(self, moments, omega, span, **options):
        free = motion(ph.Inertia.from_principal_moments(*moments), ph.bivector(omega))
        times = np.linspace(0, span, 200)
        return ph.fit(**measured("rates", np.random.default_rng(4), times, free), **options)

    def test_scale_and_attitude_always(self):
        fit = self.statements((1, 2, 2.6), (2, 3, 1), 10)
        assert [x.partition(":")[0] for x in fit.undetermined] == [
            "overall scale of the moments",
            "attitude",
        ]

    def test_a_short_arc(self):
        fit = self.statements((1, 2, 2.6), (2, 3, 1), 0.05)
        assert any("short arc" in x for x in fit.undetermined)
        assert any(x.startswith("i1/i3: its standard deviation") for x in fit.undetermined)
        assert fit.stderr[:2].max() > 0.5

    def test_a_symmetric_body(self):
        fit = self.statements((1, 1, 1.7), (2, 1, 4), 10)
        (found,) = [x for x in fit.undetermined if x.startswith("whether i1 and i2 differ")]
        assert "symmetric about axis 3" in found

    def test_a_steady_rotation(self):
        fit = self.statements((1, 2, 2.6), (0, 0, 5), 10, start=(BODY, [0, 0, 5.0]))
        assert fit.stderr[:2].max() > 0.5
        assert any("omega_3, bias_3" in x for x in fit.undetermined)
        assert any("steady rotations" in x for x in fit.undetermined)
        # The rates themselves are fitted.
        assert abs(fit.omega_body.components[2] + fit.bias.components[2] - 5.02) < 4 * SIGMA / np.sqrt(200)


def test_other_bodies_that_fit_are_reported():
    """A steady rotation with noise: many bodies fit it, up to a chi-square of 25 above the best."""
    times = np.linspace(0, 10, 200)
    free = motion(BODY, ph.bivector([0, 0, 5.0]))
    found = [
        text
        for seed in range(3)
        for text in ph.fit(**measured("rates", np.random.default_rng(seed), times, free)).undetermined
    ]
    assert any(text.startswith("which body: moments ") for text in found)
    assert sum("steady rotations" in text for text in found) == 3


def test_a_fit_is_shown_and_written():
    fit = ph.fit(**measured("both", np.random.default_rng(9)), start=(BODY, OMEGA))
    text = fit.summary()
    assert text.startswith("i1/i3                 0.38")
    assert "clock_offset" in text
    assert "overall scale of the moments" in text
    assert fit.misfit is None
    lines = {line[:21].strip(): line[22:] for line in text.splitlines()}
    assert re.fullmatch(r"± 0\.0\d+ rad", lines["attitude_1"])
    shown = lines["attitude"].removeprefix("quaternion wxyz ").removesuffix(" from body to space axes")
    assert ph.Rotor.from_quaternion([float(x) for x in shown.split(",")], order="wxyz").distance(START) < 0.1
    assert fit._repr_html_().startswith("<table>")
    assert repr(fit).startswith("Fit(")
    assert json.loads(json.dumps(fit.to_dict()))["names"] == list(fit.names)
    fit.covariance[:] = 0
    assert (fit.stderr > 0).all()
    assert {name: x.shape for name, x in fit.residuals.items()} == {"attitude": (120, 3), "rates": (120, 3)}


INVERSE, CONFUSED, TILTED = "inverse attitudes", "other order", "tilted sensor"


@pytest.mark.parametrize("is_known", [True, False])
@pytest.mark.parametrize("mistake", [INVERSE, CONFUSED, TILTED])
def test_a_body_that_does_not_fit_is_reported(mistake, is_known):
    kind = "rates" if mistake == TILTED else "attitude"
    data = measured(kind, np.random.default_rng(5), np.linspace(0, 3, 300), sigma=0.002)
    times, values = data[kind]
    match mistake:
        case "inverse attitudes":
            values = ~values
        case "other order":
            values = ph.Rotor.from_quaternion(values.to_quaternion(order="wxyz"), order="xyzw")
        case _:
            values = values @ ph.Rotor.from_rotation_vector([0.9, -0.6, 0.5]).to_matrix()
    sigma = data[f"sigma_{kind}"] if is_known else None
    with pytest.warns(RuntimeWarning, match="^the body does not fit these data .*: check the unit") as caught:
        fit = ph.fit(**{kind: (times, values), f"sigma_{kind}": sigma})
    assert caught[0].filename == __file__
    assert fit.misfit == fit.to_dict()["misfit"] == str(caught[0].message)
    assert fit.misfit in fit.summary()
    assert ("reduced chi-square" in fit.misfit) == is_known
    assert ("axes of the rates" in fit.misfit) == (kind == "rates")


@pytest.mark.parametrize("noise", [1e-9, 0.002, 0.3])
@pytest.mark.parametrize("kind", ["rates", "attitude"])
def test_noise_of_unknown_size_is_no_misfit(kind, noise):
    for seed in range(3):
        data = measured(kind, np.random.default_rng(seed), np.linspace(0, 3, 300), sigma=noise)
        assert ph.fit(**{kind: data[kind]}, start=(BODY, OMEGA)).misfit is None


def test_a_sigma_that_is_too_large_is_reported():
    data = measured("rates", np.random.default_rng(3))
    good = ph.fit(**data, start=(BODY, OMEGA))
    loose = ph.fit(**data | {"sigma_rates": 10 * SIGMA}, start=(BODY, OMEGA))
    assert "sigma is much larger" in loose.summary()
    assert "sigma is" not in good.summary()


def test_residuals_are_drawn():
    matplotlib = pytest.importorskip("matplotlib.figure")
    both = ph.fit(**measured("both", np.random.default_rng(9)), start=(BODY, OMEGA))
    assert len(both.plot().axes) == 2
    axes = matplotlib.Figure().add_subplot()
    with pytest.raises(ValueError, match="two panels"):
        both.plot(ax=axes)
    rates = ph.fit(**measured("rates", np.random.default_rng(9)), start=(BODY, OMEGA))
    assert rates.plot(ax=axes) is axes.figure
    np.testing.assert_array_equal(axes.lines[1].get_ydata(), rates.residuals["rates"][:, 0])


RATES = (TIMES, np.tile([0.1, 0.2, 0.3], (120, 1)))


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({}, ValueError, "fit needs data"),
        ({"rates": RATES[1]}, TypeError, r"rates must be a pair \(times, omega_body\), got ndarray"),
        ({"rates": (TIMES, RATES[1][:-1])}, ValueError, "times must be 119 numbers"),
        ({"rates": (TIMES[::-1], RATES[1])}, ValueError, "times must increase"),
        ({"rates": (TIMES[:2], RATES[1][:2])}, ValueError, r"n >= 3, got shape \(2, 3\)"),
        ({"rates": (TIMES, np.full((120, 3), np.nan))}, ValueError, r"got \[nan, nan, nan\] at index \(0,\)"),
        ({"rates": RATES, "sigma_rates": -1}, ValueError, "sigma_rates must be positive and finite, got -1"),
        ({"rates": RATES, "sigma_rates": [1, 2]}, ValueError, r"got shape \(2,\)"),
        ({"rates": RATES, "clock_offset": True}, ValueError, "clock_offset needs attitudes and rates"),
        ({"attitude": RATES}, TypeError, "attitude needs Rotors at the times, got ndarray"),
        ({"rates": RATES, "start": BODY}, TypeError, "start must be a pair"),
        (
            {"rates": RATES, "attitude": (TIMES, ph.Rotor.identity((120,)))},
            ValueError,
            "need sigma_attitude and sigma_rates",
        ),
    ],
)
def test_bad_data(options, error, message):
    with pytest.raises(error, match=message):
        ph.fit(**options)


def test_a_level_out_of_range():
    fit = ph.fit(**measured("rates", np.random.default_rng(9)), start=(BODY, OMEGA))
    with pytest.raises(ValueError, match="level must be between 0 and 1, got 95"):
        fit.interval(95)


@pytest.mark.parametrize("rate", [[0, 0, 5], [3, 0, 0]])
@pytest.mark.parametrize("bias", [True, False])
def test_steady_rates_without_noise_are_reported(rate, bias):
    times = np.arange(100) * 0.1
    fit = ph.fit(rates=(times, np.tile(np.array(rate, float), (100, 1))), bias=bias)
    assert np.isfinite(fit.covariance).all()
    assert (fit.stderr[:2] > 0.5).all()
    assert any("steady rotations determine little" in x for x in fit.undetermined)
    if bias:  # the sum of rate and bias alone is determined
        assert any("bias_3: no information" in x for x in fit.undetermined)


def test_steady_attitudes_without_noise_are_reported():
    times = np.arange(100) * 0.1
    rotors = ph.Rotor.from_rotation_vector(np.outer(times, [0, 0, 0.5]))
    fit = ph.fit(attitude=(times, rotors))
    assert (fit.stderr[:2] > 0.5).all()
    assert any("steady rotations determine little" in x for x in fit.undetermined)


@pytest.mark.parametrize("sigma", [None, 0.01])
def test_a_body_at_rest_cannot_be_fitted(sigma):
    times = np.arange(100) * 0.1
    with pytest.raises(ValueError, match="the body is at rest in all data"):
        ph.fit(rates=(times, np.zeros((100, 3))), sigma_rates=sigma)
    with pytest.raises(ValueError, match="the body is at rest in all data"):
        ph.fit(attitude=(times, ph.Rotor.from_rotation_vector(np.zeros((100, 3)))), sigma_attitude=sigma)
