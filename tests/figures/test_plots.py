"""Plots: no warnings, units on all axes, and curves at their right places."""

import io
import warnings

import numpy as np
import pytest

import polhode as ph

pytest.importorskip("matplotlib")
from polhode._figures.camera import View
from polhode._figures.over_time import motion_figure
from polhode._figures.palette import PLANES, POLHODE, TRACE
from polhode._figures.spheres import axis_figure, polhode_figure

R0 = ph.Rotor.from_components([4, -2, 1, 2])
TIMES = np.linspace(0, 10, 201)


def free(i, omega=(0.25, -0.5, 1.0), times=TIMES):
    return ph.simulate(ph.Inertia.from_principal_moments(*i), ph.State(R0, list(omega)), times)


def heavy():
    inertia, law = ph.Inertia.from_principal_moments(1, 1, 0.5), ph.torque.heavy([0, 0, 2])
    return ph.simulate(inertia, ph.State(R0, [0.25, -0.5, 6.0]), TIMES, law)


FREE = {
    "asymmetric": lambda: free((1, 2, 3)),
    "long axis": lambda: free((1, 2, 3), (1, 0.5, -0.25)),
    "symmetric": lambda: free((1, 1, 2)),
    "prolate": lambda: free((2, 2, 1)),
    "sphere": lambda: free((2, 2, 2)),
    "steady": lambda: free((1, 2, 3), (0, 1, 0)),
    "separatrix": lambda: free((1, 2, 2.25), (0.375, 0.5, 0.5)),
    "turned axes": lambda: ph.simulate(
        ph.Body.box([1, 2, 3], mass=1).moved(R0), ph.State(R0, [0.25, -0.5, 1.0]), TIMES
    ),
    "one time": lambda: free((1, 2, 3), times=[1.0]),
}


def drawn(figure):
    """The figure as PNG bytes; any warning is an error."""
    buffer = io.BytesIO()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure.savefig(buffer, format="png", dpi=60)
    assert buffer.getvalue().startswith(b"\x89PNG")
    return buffer.getvalue()


@pytest.mark.parametrize("name", FREE)
def test_free_motions_are_drawn(name):
    motion = FREE[name]()
    drawn(motion.plot())
    drawn(polhode_figure(motion))


def test_heavy_tops_are_drawn():
    motion = heavy()
    drawn(motion.plot())
    drawn(axis_figure(motion, np.array([0.0, 0.0, 2.0]), "the axis"))


def test_a_body_at_rest_is_drawn():
    motion = free((1, 2, 3), (0, 0, 0))
    drawn(motion.plot())
    drawn(polhode_figure(motion))


def test_a_motion_without_times_is_refused():
    motion = free((1, 2, 3), times=[])
    for draw in (motion_figure, polhode_figure):
        with pytest.raises(ValueError, match="no output times"):
            draw(motion)


def test_axes_are_labelled_with_units():
    motion = free((1, 2, 3))
    motion.attributes["title"] = "A title"
    figure = motion.plot()
    rates, attitude = figure.axes
    assert "rad/s" in rates.get_ylabel()
    assert "rotor" in attitude.get_ylabel()
    assert attitude.get_xlabel() == "time, s"
    assert figure.get_suptitle() == "A title: angular velocity and attitude"
    assert [t.get_text() for t in rates.get_legend().get_texts()] == list(PLANES)
    assert [t.get_text() for t in attitude.get_legend().get_texts()] == ["1", *PLANES]


@pytest.mark.parametrize(
    ("span", "unit", "last"),
    [(10.0, "s", 10.0), (6000.0, "min", 100.0), (86400.0, "h", 24.0), (8.64e5, "d", 10.0)],
)
def test_long_times_have_longer_units(span, unit, last):
    motion = free((1, 2, 3), omega=(0, 0, 1e-4), times=[0, span])
    rates, attitude = motion.plot().axes
    assert attitude.get_xlabel() == f"time, {unit}"
    assert rates.lines[0].get_xdata()[-1] == pytest.approx(last)


def test_the_lines_are_the_data():
    motion = free((1, 2, 3))
    rates, attitude = motion.plot().axes
    for k, line in enumerate(rates.lines):
        np.testing.assert_array_equal(line.get_xdata(), TIMES)
        np.testing.assert_array_equal(line.get_ydata(), motion.omega_body.components[:, k])
    for k, line in enumerate(attitude.lines):
        np.testing.assert_array_equal(line.get_ydata(), motion.rotor.components[:, k])


def halves(axes, colour):
    """The parts of a path behind and in front, (n, 2) each; points on the outline are in both."""
    back, front = (
        np.array(line.get_data()).T
        for line in axes.lines
        if line.get_color() == colour and len(line.get_xdata()) > 1
    )
    return back, front


def is_on(points, back, front):
    """For each of the points (n, 2), whether it is drawn behind, and whether in front."""
    found = [
        (np.abs(half[~np.isnan(half[:, 0])] - points[:, np.newaxis]).max(axis=2) < 1e-12).any(axis=1)
        for half in (back, front)
    ]
    assert (found[0] | found[1]).all()
    return found


@pytest.mark.parametrize("name", ["asymmetric", "long axis", "symmetric", "turned axes"])
def test_the_drawn_polhode_is_on_the_ellipsoid(name):
    """The curve is ω about the principal axes, with Σ i_k ω_k² = 2E, and inside the outline."""
    motion = FREE[name]()
    axes = polhode_figure(motion).axes[0]
    back, front = halves(axes, POLHODE)
    F, i = motion.inertia.principal_frame, motion.inertia.principal_moments
    omega = (~F)(motion.omega_body).components
    np.testing.assert_allclose(omega**2 @ i, 2 * motion.energy, rtol=1e-9)
    view = View()
    behind, ahead = is_on(view.project(omega), back, front)
    # A point of the image and its side determine the point of the ellipsoid.
    a = view.toward**2 @ i
    for point, facing, hidden, w in zip(view.project(omega), ahead, behind, omega, strict=True):
        assert facing != hidden
        base = point @ view.basis
        b, c = view.toward * base @ i, base**2 @ i - 2 * motion.energy[0]
        root = np.sqrt(max(b * b - a * c, 0.0))
        depth = (-b + root if facing else -b - root) / a
        np.testing.assert_allclose(base + depth * view.toward, w, rtol=0, atol=1e-5)


def test_points_behind_are_drawn_as_hidden():
    """The point of a sphere towards the viewer is in front, its opposite behind; both parts meet."""
    view = View()
    assert np.linalg.norm(view.toward) == pytest.approx(1)
    np.testing.assert_allclose(view.basis @ view.toward, 0, atol=1e-15)
    np.testing.assert_allclose(view.project(view.toward[np.newaxis]), 0, atol=1e-15)
    from matplotlib.figure import Figure

    axes = Figure().add_subplot()
    side = view.basis[0]
    s = np.radians(np.arange(1.0, 361.0, 2.0))[:, np.newaxis]
    circle = np.cos(s) * view.toward + np.sin(s) * side
    view.curve(axes, circle, circle, color="k")
    back, front = (np.array(line.get_data()).T for line in axes.lines)
    behind, ahead = ~np.isnan(back[:, 0]), ~np.isnan(front[:, 0])
    # The parts meet on the outline, at two points on the chords that cross it.
    both = behind & ahead
    assert both.sum() == 2
    np.testing.assert_allclose(np.abs(back[both, 0]), np.cos(np.radians(1)), rtol=1e-12)
    np.testing.assert_array_equal(ahead[~both], np.cos(s)[:, 0] > 0)
    np.testing.assert_array_equal(behind[~both], np.cos(s)[:, 0] < 0)
    dashed, solid = axes.lines
    assert dashed.get_alpha() < solid.get_alpha()
    assert dashed.is_dashed()
    assert not solid.is_dashed()


def test_the_silhouette_encloses_the_ellipsoid():
    """Its points are the farthest ones of the surface in each direction of the image."""
    view, semi_axes = View(), np.array([1.0, 2.0, 3.0])
    outline = view.silhouette(semi_axes)
    u = np.random.default_rng(0).normal(size=(20_000, 3))
    surface = view.project(semi_axes * u / np.linalg.norm(u, axis=1, keepdims=True))
    for angle in np.linspace(0, 2 * np.pi, 9):
        direction = np.array([np.cos(angle), np.sin(angle)])
        # The support of an ellipsoid is |S d|; 361 points miss it by half a degree squared at most.
        support = np.linalg.norm(semi_axes * (direction @ view.basis))
        assert (outline @ direction).max() == pytest.approx(support, rel=5e-5)
        assert (surface @ direction).max() <= support * (1 + 1e-12)


def test_the_path_of_the_axis_is_the_turned_axis():
    motion = heavy()
    axes = axis_figure(motion, np.array([0.0, 0.0, 2.0]), "the axis").axes[0]
    path = motion.rotor.to_matrix()[:, :, 2]
    behind, ahead = is_on(View().project(path), *halves(axes, TRACE))
    np.testing.assert_array_equal(ahead, path @ View().toward >= 0)
    np.testing.assert_array_equal(behind, path @ View().toward < 0)


@pytest.mark.parametrize(("rate", "label"), [(10.0, "attitude rotor"), (1000.0, "of principal axis 3")])
def test_a_fast_spinner_shows_its_axis(rate, label):
    """Sixteen turns are drawn as the rotor, sixteen hundred as the spin axis."""
    inertia = ph.Inertia.from_principal_moments(1, 1, 2)
    state = ph.State(ph.Rotor.from_plane_angle(ph.e2 ^ ph.e3, 0.3), [0.0, 0.01 * rate, rate])
    figure = ph.simulate(inertia, state, np.linspace(0, 10, 400)).plot()
    axes = figure.axes[1]
    assert label in axes.get_ylabel()
    drawn = np.stack([line.get_ydata() for line in axes.get_lines()])
    assert np.abs(np.linalg.norm(drawn, axis=0) - 1).max() < 1e-12
