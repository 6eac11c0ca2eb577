"""Figures of every kind: their curves read back from matplotlib, their files, and errors."""

import functools
import io
import pickle
import sys
import warnings
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest

import polhode as ph
import studios
from command_line import EXAMPLES, polhode

pytest.importorskip("matplotlib")
from matplotlib.backends.backend_agg import FigureCanvasAgg

from polhode._cli.main import main
from polhode._figures import handout as _handout
from polhode._figures import phase_portrait, spheres
from polhode._figures import tilt as _tilt
from polhode._figures.camera import View
from polhode._figures.handout import handout_figure, inertia_of_plane, swept_trivector, turned_vector
from polhode._figures.palette import HERPOLHODE, MOMENTUM, OMEGA, POLHODE, TRACE
from polhode._figures.registry import KINDS
from polhode._figures.style import encoded
from polhode._mechanics.smooth import samples

R0 = ph.Rotor.from_components([4, -2, 1, 2])
FITTING = {
    "t-handle": {"motion", "polhode", "herpolhode", "drift", "phase", "scene"},
    "symmetric-top": {"motion", "polhode", "herpolhode", "drift", "phase", "scene"},
    "toutatis": {"motion", "polhode", "herpolhode", "drift", "phase", "scene"},
    "dual-spin": {"motion", "polhode", "drift", "phase", "scene"},
    "nutating-top": {"motion", "locus", "drift", "phase", "scene"},
    "kovalevskaya": {"motion", "locus", "drift", "phase", "scene"},
    "gravity-gradient": {"motion", "drift", "phase", "scene"},
    "detumbling": {"motion", "drift", "phase", "scene"},
}


def free(i=(1, 2, 3), omega=(0.25, -0.5, 1.0), times=None):
    times = np.linspace(0, 10, 201) if times is None else times
    return ph.simulate(ph.Inertia.from_principal_moments(*i), ph.State(R0, list(omega)), times)


def top(omega=(0.25, -0.5, 6.0), times=None):
    inertia, law = ph.Inertia.from_principal_moments(1, 1, 0.5), ph.torque.heavy([0, 0, 2])
    return ph.simulate(
        inertia, ph.State(R0, list(omega)), np.linspace(0, 10, 401) if times is None else times, law
    )


@pytest.fixture(autouse=True)
def painted(monkeypatch):
    """Figures of kind "scene" without a browser: tests/viewer/test_capture.py has them with one."""
    return studios.paint(monkeypatch)


@functools.cache
def motion_of(name):
    return ph.Scene.read(EXAMPLES / f"{name}.toml").run()


def drawn(figure):
    """The figure, drawn as a PNG; any warning is an error."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure.savefig(io.BytesIO(), format="png", dpi=50)
    return figure


def of_colour(axes, colour):
    return [np.array(line.get_data()).T for line in axes.lines if line.get_color() == colour]


# --- all kinds


USUAL = ("t-handle", "kovalevskaya", "dual-spin")  # free, a top, and a wheel


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name in USUAL else pytest.mark.slow) for name in FITTING]
)
def test_kinds_that_fit_are_drawn_and_others_are_refused(name):
    for kind in KINDS:
        if kind in FITTING[name]:
            drawn(motion_of(name).plot(kind))
        else:
            with pytest.raises(ValueError, match=f"kind '{kind}' is for"):
                motion_of(name).plot(kind)


def texts_of(figure):
    """All visible texts, without those of ticks outside of the limits."""
    found = [figure._suptitle, figure._supxlabel]
    for axes in figure.axes:
        found += [axes.title, axes._left_title, *axes.texts]
        found += axes.get_legend().get_texts() if axes.get_legend() else []
        for axis in (axes.xaxis, axes.yaxis) if axes.axison else ():
            low, high = sorted(axis.get_view_interval())
            ticks = axis.get_major_ticks()
            found += [axis.label, *(tick.label1 for tick in ticks if low <= tick.get_loc() <= high)]
    return [text for text in found if text.get_visible() and text.get_text()]


@pytest.mark.parametrize(
    "name",
    [
        *("t-handle", "nutating-top"),
        *(pytest.param(x, marks=pytest.mark.slow) for x in ("symmetric-top", "kovalevskaya", "dual-spin")),
    ],
)
def test_no_two_texts_overlap(name):
    for kind in sorted(FITTING[name]):
        figure = motion_of(name).plot(kind)
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        renderer = canvas.get_renderer()
        boxes = [(text.get_text(), text.get_window_extent(renderer)) for text in texts_of(figure)]
        assert len(boxes) > (2 if kind == "scene" else 4)
        for k, (text, box) in enumerate(boxes):
            for other, another in boxes[:k]:
                across = min(box.x1, another.x1) - max(box.x0, another.x0)
                up = min(box.y1, another.y1) - max(box.y0, another.y0)
                # Boxes have margins around the letters.
                assert min(across, up) < 3, (kind, text, other)


def test_invalid_arguments_are_refused():
    motion = free()
    with pytest.raises(
        ValueError, match="unknown kind of figure 'poolhode', expected one of motion, polhode"
    ):
        motion.plot("poolhode")
    with pytest.raises(ValueError, match=r"view is for the kinds polhode, .*, scene, not for 'motion'"):
        motion.plot("motion", view=(1, 2))
    with pytest.raises(ValueError, match="time is for the kind 'scene', not for 'drift'"):
        motion.plot("drift", time=1.0)
    with pytest.raises(ValueError, match=r"view is \(1, 2, 3\); it must be azimuth and elevation"):
        motion.plot("polhode", view=(1, 2, 3))
    with pytest.raises(ValueError, match="time is 11 s; the motion goes from 0 s to 10 s"):
        motion.plot("scene", time=11.0)
    with pytest.raises(ValueError, match="view is for the phase portraits of bodies without torque"):
        top().plot("phase", view=(1, 2))


def test_too_few_times_are_refused():
    for kind in KINDS:
        with pytest.raises(ValueError, match="no output times"):
            free(times=[]).plot(kind)
    for kind in ("herpolhode", "phase"):
        with pytest.raises(ValueError, match=f"kind '{kind}' .* needs 2 output times .*; this motion has 1"):
            free(times=[1.0]).plot(kind)
    with pytest.raises(ValueError, match=r"kind 'locus' .* needs 2 output times"):
        top(times=[1.0]).plot("locus")
    for kind in ("motion", "polhode", "drift", "scene"):
        drawn(free(times=[1.0]).plot(kind))


def test_batches_are_refused_and_their_bodies_are_drawn():
    batch = ph.simulate(
        ph.Inertia.from_principal_moments(1, 2, 3),
        ph.State(R0, [[0.25, -0.5, 1.0], [1, 0.1, 0.1]]),
        np.linspace(0, 5, 50),
    )
    for kind in KINDS:
        with pytest.raises(ValueError, match=r"plot is for one body, got a batch of shape \(2,\)"):
            batch.plot(kind)
    for kind in ("polhode", "herpolhode", "phase", "scene"):
        drawn(batch[0].plot(kind))
    with pytest.raises(ValueError, match="picked from a batch or unpickled: simulate the body alone"):
        pickle.loads(pickle.dumps(top())).plot("locus")


@pytest.mark.parametrize(("weight", "spin"), [(2.0, 8.0), (-2.0, 0.0)], ids=["sleeping", "hanging"])
@pytest.mark.filterwarnings("error")
def test_a_top_that_stands_still_has_a_portrait(weight, spin):
    inertia = ph.Inertia.from_principal_moments(1, 1, 0.5)
    state = ph.State(ph.Rotor.identity(), [0, 0, spin])
    motion = ph.simulate(inertia, state, np.linspace(0, 10, 11), ph.torque.heavy([0, 0, weight]))
    figure = motion.plot("phase")
    dot = figure.axes[0].lines[-1].get_xydata()
    np.testing.assert_array_equal(dot, [[0.0 if weight > 0 else 180.0, 0.0]])
    assert "stands still" in " ".join(figure.get_supxlabel().split())


def test_bodies_at_rest_are_drawn():
    motion = free(omega=(0, 0, 0))
    for kind in ("motion", "polhode", "herpolhode", "drift", "phase", "scene"):
        drawn(motion.plot(kind))


@pytest.mark.parametrize("i", [(1, 1, 2), (2, 2, 1), (1, 2, 2), (2, 2, 2)])
def test_symmetric_bodies_and_spheres_are_drawn(i):
    for kind in ("polhode", "herpolhode", "phase", "scene"):
        drawn(free(i).plot(kind))


def test_a_long_title_is_wrapped():
    motion = free()
    motion.attributes["title"] = "A $5 body " * 20
    for kind in set(KINDS) - {"locus"}:
        figure = drawn(motion.plot(kind))
        box = figure._suptitle.get_window_extent()
        assert box.x0 >= 0
        assert box.x1 <= figure.bbox.x1
        assert figure.get_suptitle().count(r"\$5") == 20


VIEWS = [(35, 22), (-120, 5), (200, -40), (0, 0), (0, 90), (77, -90)]


@pytest.mark.parametrize("view", VIEWS)
def test_the_part_behind_is_dashed_in_every_view(view):
    """Each point of the polhode is solid if its normal is towards the viewer, else dashed."""
    motion = free((1, 2, 3), (1, 0.5, -0.25))
    look = View(*view)
    dashed, solid = (
        line for line in motion.plot("polhode", view=view).axes[0].lines if is_path(line, POLHODE)
    )
    assert dashed.is_dashed()
    assert not solid.is_dashed()
    omega = motion.omega_body.components
    flat, ours = look.project(omega), (omega * [1, 2, 3]) @ look.toward > 0
    for line, chosen in ((solid, ours), (dashed, ~ours)):
        drawn_here = np.array(line.get_data()).T
        drawn_here = drawn_here[~np.isnan(drawn_here[:, 0])]
        missing = [p for p in flat[chosen] if np.abs(drawn_here - p).max(axis=1).min() > 1e-12]
        assert not missing
        # Besides, only the points on the outline.
        assert len(drawn_here) - chosen.sum() <= np.count_nonzero(np.diff(ours))


@pytest.mark.parametrize("view", VIEWS)
def test_all_views_are_drawn(view):
    for kind in ("polhode", "phase", "scene"):
        drawn(free().plot(kind, view=view))
    for kind in ("locus", "scene"):
        drawn(top().plot(kind, view=view))


def is_path(line, colour):
    return line.get_color() == colour and len(line.get_xdata()) > 1


# --- herpolhode


def test_the_herpolhode_is_in_its_plane_between_its_circles():
    motion = free((1, 2, 3), (0.6, 0.2, 0.9), np.linspace(0, 60, 2001))
    (curve, *_), momentum = of_colour(motion.plot("herpolhode").axes[0], HERPOLHODE), motion.momentum_space[0]
    direction = momentum / float(momentum.norm())
    omega = samples(motion).rotor(samples(motion).omega_body)
    # |ω|² is the sum of the squares of the part in the plane and of its distance, 2E/|L|.
    distance = 2 * motion.energy[0] / float(momentum.norm())
    np.testing.assert_allclose(-(omega | direction).components[..., 0], distance, rtol=1e-12)
    radii = np.hypot(*curve.T)
    np.testing.assert_allclose(radii**2 + distance**2, np.asarray(omega.norm()) ** 2, rtol=1e-11)
    circles = [np.hypot(*c.T) for c in of_colour(motion.plot("herpolhode").axes[0], "#222222")]
    (least, largest) = (float(c.mean()) for c in circles)
    for circle in circles:
        np.testing.assert_allclose(circle, circle.mean(), rtol=1e-12)
    # The curve of the core over a period, at points other than those of the figure.
    around = ph.FreeMotion(motion.inertia, R0, motion.omega_body[0]).herpolhode(1000)
    own = np.sqrt(np.asarray(around.norm()) ** 2 - distance**2)
    # Extremes fall between samples: a miss of half a step is quadratic in 2π/4096.
    assert least == pytest.approx(own.min(), rel=1e-4)
    assert largest == pytest.approx(own.max(), rel=1e-4)
    assert radii.min() >= least * (1 - 1e-5)
    assert radii.max() <= largest * (1 + 1e-5)
    assert radii.min() < least * 1.01
    assert radii.max() > largest * 0.99


def test_the_herpolhode_turns_in_the_sense_of_L():
    """ω of a prolate top goes around L in the sense of L; g1, g2 is right-handed about L."""
    motion = free((2, 2, 1), (0.3, 0, 1.0), np.linspace(0, 1, 50))
    (curve, *_) = of_colour(motion.plot("herpolhode").axes[0], HERPOLHODE)
    angle = np.unwrap(np.arctan2(*curve.T[::-1]))
    rate = motion.certificate.conserved["angular_momentum"] / 2
    np.testing.assert_allclose(np.diff(angle), rate * np.diff(samples(motion).time), rtol=1e-9)


# --- tops


def test_the_locus_stays_between_the_bounds_of_its_tilt():
    motion = top()
    about = ph.LagrangeTop(motion.inertia, R0, motion.omega_body[0], [0, 0, 2]).describe()
    axes = motion.plot("locus").axes[0]
    view = View()
    path = samples(motion).rotor(ph.e3).components
    tilt = np.arccos(path[:, 2])
    assert tilt.min() >= about["tilt_min"] - 1e-9
    assert tilt.max() <= about["tilt_max"] + 1e-9
    halves = of_colour(axes, TRACE)
    points = np.concatenate([half[~np.isnan(half[:, 0])] for half in halves[:2]])
    for point in view.project(path[::20]):
        assert np.abs(points - point).max(axis=1).min() < 1e-12
    # The black circles are the bounds of the tilt.
    fronts = [line for line in of_colour(axes, "#222222") if len(line) > 100][1::2]
    assert len(fronts) == 2
    for angle, front in zip((about["tilt_min"], about["tilt_max"]), fronts, strict=True):
        seen = front[~np.isnan(front[:, 0])]
        # A parallel is an ellipse around cos θ times the pole, of width sin θ.
        center = view.project(np.array([0, 0, np.cos(angle)]))
        relative = (seen - center) / [1, np.sin(np.radians(22))]
        # The points on the outline are on chords of 1°.
        np.testing.assert_allclose(np.hypot(*relative.T), np.sin(angle), rtol=1e-4)


def test_the_tops_portrait_is_its_curve_of_energy():
    motion = top()
    about = ph.LagrangeTop(motion.inertia, R0, motion.omega_body[0], [0, 0, 2]).describe()
    axes = motion.plot("phase").axes[0]
    (curve, *_) = of_colour(axes, TRACE)
    theta, rate = np.radians(curve).T
    # The rate is the derivative of the tilt: half a step's curvature, (0.0125 s)² θ'''/6, is below 1e-2.
    time = samples(motion).time
    np.testing.assert_allclose(np.gradient(theta, time)[2:-2], rate[2:-2], atol=2e-2)
    # The energy of these tilts and rates is that of the motion.
    energy = _tilt._energy(motion, np.array([0, 0, 2.0]), about, theta, rate)
    np.testing.assert_allclose(energy, motion.energy[0], rtol=1e-10)
    bounds = sorted(float(line[0, 0]) for line in of_colour(axes, "#222222") if len(line) == 2)[1:]
    np.testing.assert_allclose(bounds, np.degrees([about["tilt_min"], about["tilt_max"]]))


def test_the_portrait_of_a_satellite_has_its_amplitude():
    axes = motion_of("gravity-gradient").plot("phase").axes[0]
    (curve, *_) = of_colour(axes, TRACE)
    assert np.abs(curve[:, 0]).max() == pytest.approx(20, abs=0.01)
    assert curve[0, 0] == pytest.approx(20)


# --- phase portraits of free bodies


def test_families_are_motions_of_one_momentum_and_energy():
    moments = np.array([1.0, 2.0, 3.0])
    family, divides = phase_portrait._without_wheel(moments)
    assert len(family) == 16
    for curve in family:
        np.testing.assert_allclose(np.linalg.norm(curve, axis=1), 1, rtol=1e-12)
        energy = 0.5 * (curve**2 / moments).sum(axis=1)
        np.testing.assert_allclose(energy, energy[0], rtol=1e-12)
        np.testing.assert_allclose(curve[0], curve[-1], atol=1e-12)
    for circle in divides:
        np.testing.assert_allclose(np.linalg.norm(circle, axis=1), 1, rtol=1e-12)
        np.testing.assert_allclose((circle**2 / moments).sum(axis=1), 1 / moments[1], rtol=1e-12)


def test_the_map_and_the_sphere_show_the_motion():
    motion = free((1, 2, 3), (1, 0.5, -0.25))
    sphere, flat = motion.plot("phase").axes
    momentum = motion.inertia(motion.omega_body).components
    direction = momentum / np.linalg.norm(momentum, axis=1, keepdims=True)
    (curve, *_) = of_colour(flat, POLHODE)
    # It goes around the first axis, which is in the middle; the third is at the top.
    np.testing.assert_allclose(
        np.radians(curve[:, 0]), np.arctan2(direction[:, 1], direction[:, 0]), atol=1e-12
    )
    np.testing.assert_allclose(curve[:, 1], direction[:, 2], atol=1e-12)
    back, front = of_colour(sphere, POLHODE)[:2]
    seen = ~np.isnan(front[:, 0])
    assert seen.sum() + (~np.isnan(back[:, 0])).sum() >= len(curve)
    assert np.hypot(*front[seen].T).max() <= 1 + 1e-12


def test_a_wheels_family_has_equal_energies():
    moments, h = np.array([60.0, 80.0, 100.0]), np.array([0, 0.4, 0.1])
    chosen = spheres.Frame(2, 0, 1, -1.0)
    for curve in phase_portrait._with_wheel(moments, h, chosen)[0]:
        energy = 0.5 * ((curve - h) ** 2 / moments).sum(axis=1)
        np.testing.assert_allclose(np.linalg.norm(curve, axis=1), 1, rtol=1e-12)
        # Straight lines between cells of 1.5°.
        np.testing.assert_allclose(energy, energy.mean(), rtol=5e-3)


# --- drift


def test_drifts_are_the_data():
    motion = motion_of("nutating-top")
    sizes, *panels, rotor = motion.plot("drift").axes
    assert [text.get_text().split(" / ")[0] for text in sizes.get_legend().get_texts()] == ["|L|"]
    changing = {name: values for name, values in motion.drifts().items() if values.any()}
    for axes, (name, values) in zip(panels, changing.items(), strict=True):
        power = float(axes.get_ylabel().removeprefix("$10^{").removesuffix("}$"))
        np.testing.assert_allclose(axes.lines[1].get_ydata() * 10**power, values, rtol=1e-12)
        assert f"{motion.certificate.conserved[name]:.6g}" in axes.get_title("left")
    assert rotor.get_xlabel() == "time, s"


# --- the scene


def test_a_scene_shows_the_picture_of_its_time(painted):
    motion = free()
    figure = drawn(motion.plot("scene", time=3.7))
    assert painted[-1].times == [3.7]
    assert painted[-1].size == (1920, 1080)
    assert [time for time, _ in painted[-1].asked] == [3.7]
    (axes,) = figure.axes
    (shown,) = axes.get_images()
    assert shown.get_array().shape == (1080, 1920, 3)
    assert [text.get_text() for text in axes.texts] == ["$t$ = 3.7 s"]
    drawn(motion.plot("scene"))
    assert painted[-1].times == [10.0]


@pytest.mark.parametrize(("motion", "weight"), [(free, False), (top, True)])
def test_the_caption_of_a_scene_explains_what_is_drawn(motion, weight):
    caption = motion().plot("scene").get_supxlabel()
    assert r"$f_k = R e_k \tilde{R}$" in caption
    assert ("$mg$: the weight" in caption) == weight


def test_a_scene_without_playwright_names_the_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "playwright", None)
    with pytest.raises(ImportError, match=r"kind 'scene' needs playwright: pip install 'polhode\[film\]'"):
        free().plot("scene")


# --- the handout


def handout_points(axes):
    return {text.get_text(): np.array(text.xy) for text in axes.texts if hasattr(text, "xy")}


def test_figure_2_shows_the_turned_vector():
    a, B, angle = ph.e1 + 0.5 * ph.e3, (ph.e1 ^ ph.e2) + 0.3 * (ph.e2 ^ ph.e3), 1.2
    figure = drawn(turned_vector(a, B, angle))
    R = (-0.5 * angle * B.normalized()).exp()
    at = handout_points(figure.axes[0])
    view = View(20, 24)
    turned = R * a * ~R
    np.testing.assert_allclose(at["$a$"], view.project(a.components), atol=1e-12)
    np.testing.assert_allclose(
        at[r"$a' = R a \tilde{R}$"], view.project(turned.grade(1).components), atol=1e-12
    )
    inside = (a | B) * B.inverse()
    np.testing.assert_allclose(at[r"$a_\parallel$"], view.project(inside.grade(1).components), atol=1e-12)
    np.testing.assert_allclose(
        at[r"$a_\perp = a'_\perp$"], view.project((a - inside).grade(1).components), atol=1e-12
    )


def test_figure_1_states_the_trivector():
    a, b, c = ph.e1 + 0.1 * ph.e2, 1.5 * ph.e2, 0.2 * ph.e1 + 2 * ph.e3
    figure = drawn(swept_trivector(a, b, c))
    assert r"$a\wedge b\wedge c$ = 3 $I$" in figure.get_supxlabel().replace("\n", " ").replace("\u00a0", " ")
    assert "right-handed" in figure.get_supxlabel().replace("\n", " ").replace("\u00a0", " ")
    assert "= −3 $I$" in drawn(swept_trivector(b, a, c)).get_supxlabel().replace("\n", " ").replace(
        "\u00a0", " "
    )
    corners = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)]) @ np.stack(
        [x.components for x in (a, b, c)]
    )
    edges = [line.get_data() for line in figure.axes[0].lines if len(line.get_xdata()) == 2]
    assert len(edges) == 12
    flat = View(-28, 20).project(corners)
    for edge in edges:
        for point in np.array(edge).T:
            assert np.abs(flat - point).max(axis=1).min() < 1e-12


def test_figure_1_hides_the_three_edges_of_the_farthest_corner():
    figure = handout_figure(1)
    dashed = [line for line in figure.axes[0].lines if line.is_dashed()]
    assert len(dashed) == 3
    ends = [tuple(np.round(point, 9)) for line in dashed for point in np.array(line.get_data()).T]
    common = {end for end in ends if ends.count(end) == 3}
    assert len(common) == 1
    a, b = -1.2 * ph.e1 + 0.15 * ph.e2, 0.15 * ph.e1 + 1.5 * ph.e2
    farthest = View(-28, 20).project((a + b).components)
    np.testing.assert_allclose(next(iter(common)), farthest, atol=1e-8)


def test_figure_3_shows_B_and_its_momentum():
    lengths = [0.6, 0.9, 1.8]
    body = ph.Body.box(lengths, mass=12)
    B = 0.3 * (ph.e2 ^ ph.e3) + 0.8 * (ph.e1 ^ ph.e2)
    figure = drawn(inertia_of_plane(body, lengths, B))
    L = body.inertia(B)
    cosine = np.dot(B.components, L.components) / np.linalg.norm(B.components) / np.linalg.norm(L.components)
    caption = figure.get_supxlabel().replace("\n", " ").replace("\u00a0", " ")
    assert f"The planes meet at {np.degrees(np.arccos(cosine)):.4g}°" in caption
    view = View(32, 20)
    for colour, value in ((OMEGA, B), (MOMENTUM, L)):
        rim = np.concatenate([line for line in of_colour(figure.axes[0], colour) if len(line) > 50])
        n = (value / value.norm()).dual().components
        across = rim @ view.basis
        points = across - np.outer(across @ n / (view.toward @ n), view.toward)
        np.testing.assert_allclose(np.linalg.norm(points, axis=1), np.linalg.norm(points[0]), rtol=1e-9)


def test_figure_3_hides_lines_behind_or_inside_the_box():
    """Rays through the box show which points of a disc it hides."""
    view, half = View(32, 20), np.array([0.3, 0.2, 0.8])
    rim = _handout._rim(0.3 * (ph.e2 ^ ph.e3) + 0.8 * (ph.e1 ^ ph.e2), 1.4)
    inner, ours = _handout._leaving(view, rim, half)
    shares = np.abs(inner) / half
    np.testing.assert_allclose(shares.max(axis=1), 1, rtol=1e-12)
    assert 170 < ours.sum() < 190
    steps = np.linspace(0, 3, 3001)[1:, np.newaxis]
    for share in (1.02, 1.3):
        for point, front in zip(share * inner[::10], ours[::10], strict=True):
            on_ray = point + steps * view.toward
            hidden = (np.abs(on_ray) < half).all(axis=1).any()
            # A point in front is never hidden. One behind is drawn before the box and never hides it.
            assert not (front and hidden)
            before = point - steps * view.toward
            assert front or not (np.abs(before) < half).all(axis=1).any()


# --- files and the command


@pytest.mark.slow
def test_files_have_their_format_and_are_reproducible():
    figures = [lambda: free().plot("scene"), lambda: handout_figure(2), lambda: free().plot("phase")]
    for pixels, make in zip((1, 0, 0), figures, strict=True):
        svg, pdf, png = (encoded(make(), form) for form in ("svg", "pdf", "png"))
        root = ElementTree.fromstring(svg)
        assert root.tag == "{http://www.w3.org/2000/svg}svg"
        assert len(root.findall(".//{http://www.w3.org/2000/svg}image")) == pixels
        assert pdf.startswith(b"%PDF")
        assert b"/Type3" not in pdf.replace(b" ", b"")
        assert b"CreationDate" not in pdf
        assert png.startswith(b"\x89PNG")
        for form, content in (("svg", svg), ("pdf", pdf), ("png", png)):
            assert encoded(make(), form) == content


def test_the_command_draws_figures(scene, tmp_path):
    for what, name in (("polhode", "p.svg"), ("drift", "d.pdf"), ("motion", "m.png")):
        done = polhode("figure", what, scene, "-o", tmp_path / name)
        assert (done.returncode, done.stderr) == (0, "")
        assert done.stdout == f"Written\n  {tmp_path / name}\n"
        assert (tmp_path / name).stat().st_size > 5000
    done = polhode("figure", "2", "-o", tmp_path / "2.svg")
    assert done.returncode == 0
    ElementTree.parse(tmp_path / "2.svg")
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "2.svg",
        "d.pdf",
        "m.png",
        "p.svg",
        "small.toml",
    ]


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["polhode", "-o", "a.svg"], 2, "figure polhode needs a scene"),
        (["1", "small.toml", "-o", "a.svg"], 2, "it does not take a scene"),
        (["polhode", "small.toml"], 2, "required: -o"),
        (["polhode", "small.toml", "-o", "a.jpg"], 2, "FILE.svg, FILE.pdf or FILE.png, not 'a.jpg'"),
        (["polhode", "small.toml", "-o", "a.svg", "--view", "up"], 2, "such as 35,22, got 'up'"),
        (["pohlode", "small.toml", "-o", "a.svg"], 2, "invalid choice: 'pohlode'"),
        (["locus", "small.toml", "-o", "a.svg"], 1, "kind 'locus' is for a body held at a fixed point"),
        # Before the scene is read and run.
        (["drift", "none.toml", "-o", "a.svg", "--view", "1,2"], 2, "not for 'drift'"),
        (["drift", "none.toml", "-o", "a.svg", "--width", "big"], 2, "width is 'big'; it must be a length"),
        (["scene", "none.toml", "-o", "a.svg", "--view", "nan,2"], 2, "view is (nan, 2.0); it must be"),
        (["scene", "small.toml", "-o", "a.svg", "--view", "-30,-20", "--time", "-1"], 1, "time is -1 s"),
        (["polhode", "none.toml", "-o", "a.svg"], 3, "none.toml"),
        (["polhode", "small.toml", "-o", "none/a.svg"], 1, "no such directory: none"),
    ],
)
def test_the_command_refuses(arguments, code, message, scene):
    done = polhode("figure", *arguments, cwd=scene.parent)
    assert done.returncode == code, done.stderr
    assert message in done.stderr
    assert [path.name for path in scene.parent.iterdir()] == ["small.toml"]


@pytest.mark.parametrize("form", ["svg", "pdf", "png"])
def test_the_command_keeps_figures_of_others(form, tmp_path, capsys):
    path = tmp_path / f"a.{form}"
    path.write_bytes({"svg": b"<svg/>", "pdf": b"%PDF-1.4", "png": b"\x89PNG\r\n\x1a\n"}[form])
    before = path.read_bytes()
    assert main(["figure", "3", "-o", str(path)]) == 1
    assert f"{path} exists and was not written by polhode" in capsys.readouterr().err
    assert path.read_bytes() == before
    assert main(["figure", "3", "-o", str(path), "--force"]) == 0
    # Now it is polhode's.
    assert main(["figure", "3", "-o", str(path)]) == 0


def test_ensembles_are_refused(tmp_path):
    done = polhode("figure", "polhode", EXAMPLES / "toutatis-uncertain.toml", "-o", tmp_path / "a.svg")
    assert done.returncode == 1
    assert "has 100000 bodies, and this command draws one: remove its table [ensemble]" in done.stderr
    assert not list(Path(tmp_path).iterdir())
