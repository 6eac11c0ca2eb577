"""Figures: made without warnings, labelled with units, and the polhode where it belongs."""

import io
import warnings

import numpy as np
import pytest

import polhode as ph

pytest.importorskip("matplotlib")
from polhode._plot import motion_figure
from polhode._spheres import _View, axis_figure, polhode_figure

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


def test_a_motion_of_no_times_is_drawn_or_refused():
    motion = free((1, 2, 3), times=[])
    for draw in (motion_figure, polhode_figure):
        try:
            drawn(draw(motion))
        except ValueError as error:
            assert "time" in str(error)  # noqa: PT017


def test_axes_are_labelled_with_units():
    motion = free((1, 2, 3))
    motion.attributes["title"] = "A title"
    figure = motion.plot()
    rates, attitude, drift = figure.axes
    assert "rad/s" in rates.get_ylabel()
    assert "rotor" in attitude.get_ylabel()
    assert "relative" in drift.get_ylabel()
    assert drift.get_xlabel() == "time, s"
    assert figure.get_suptitle() == "A title"
    assert [t.get_text() for t in rates.get_legend().get_texts()] == ["e2∧e3", "e3∧e1", "e1∧e2"]
    assert [t.get_text() for t in attitude.get_legend().get_texts()] == ["1", "e2∧e3", "e3∧e1", "e1∧e2"]


@pytest.mark.parametrize(
    ("span", "unit", "last"),
    [(10.0, "s", 10.0), (6000.0, "min", 100.0), (86400.0, "h", 24.0), (8.64e5, "d", 10.0)],
)
def test_long_times_have_longer_units(span, unit, last):
    motion = free((1, 2, 3), omega=(0, 0, 1e-4), times=[0, span])
    rates, _, drift = motion.plot().axes
    assert drift.get_xlabel() == f"time, {unit}"
    assert rates.lines[0].get_xdata()[-1] == pytest.approx(last)


def test_the_lines_are_the_data():
    motion = free((1, 2, 3))
    rates, attitude, _ = motion.plot().axes
    for k, line in enumerate(rates.lines):
        np.testing.assert_array_equal(line.get_xdata(), TIMES)
        np.testing.assert_array_equal(line.get_ydata(), motion.omega_body.components[:, k])
    for k, line in enumerate(attitude.lines):
        np.testing.assert_array_equal(line.get_ydata(), motion.rotor.components[:, k])


def orange(axes):
    """The two halves of the polhode, behind and in front, merged: (n, 2)."""
    back, front = (
        np.array(line.get_data()).T
        for line in axes.lines
        if line.get_color() == "#D55E00" and len(line.get_xdata()) > 1
    )
    return np.where(np.isnan(front), back, front), ~np.isnan(front[:, 0])


@pytest.mark.parametrize("name", ["asymmetric", "long axis", "symmetric", "turned axes"])
def test_the_drawn_polhode_is_on_the_ellipsoid(name):
    """The picture is ω about the principal axes, whose Σ i_k ω_k² is 2E; the outline encloses it."""
    motion = FREE[name]()
    axes = polhode_figure(motion).axes[0]
    flat, front = orange(axes)
    F, i = motion.inertia.principal_frame, motion.inertia.principal_moments
    omega = (~F)(motion.omega_body).components
    np.testing.assert_allclose(omega**2 @ i, 2 * motion.energy, rtol=1e-9)
    view = _View()
    np.testing.assert_allclose(flat, view.project(omega), rtol=0, atol=1e-12)
    # From the picture's plane and the side it is drawn on, the point of the ellipsoid comes back.
    a = view.toward**2 @ i
    for point, facing, w in zip(flat, front, omega, strict=True):
        base = point @ view.basis
        b, c = view.toward * base @ i, base**2 @ i - 2 * motion.energy[0]
        root = np.sqrt(max(b * b - a * c, 0.0))
        depth = (-b + root if facing else -b - root) / a
        np.testing.assert_allclose(base + depth * view.toward, w, rtol=0, atol=1e-5)


def test_what_is_behind_is_drawn_behind():
    """The point of a sphere towards us is in front, its opposite behind, the ends of the split meet."""
    view = _View()
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
    visible = (np.cos(s) > 0)[:, 0]
    np.testing.assert_array_equal(~np.isnan(front[:, 0]), visible)
    hidden = ~np.isnan(back[:, 0])
    assert hidden[~visible].all()
    # One point of the visible side at either end, so that the halves meet.
    assert (hidden & visible).sum() == 2
    alphas = [line.get_alpha() for line in axes.lines]
    assert alphas[0] < alphas[1]


def test_the_outline_is_that_of_the_ellipsoid():
    """Its points are those of the surface farthest out in each direction of the picture."""
    view, semi_axes = _View(), np.array([1.0, 2.0, 3.0])
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
    flat, front = orange(axes)
    path = motion.rotor.to_matrix()[:, :, 2]
    np.testing.assert_allclose(flat, _View().project(path), rtol=0, atol=1e-12)
    np.testing.assert_array_equal(front, path @ _View().toward >= 0)


@pytest.mark.parametrize(("rate", "label"), [(10.0, "attitude rotor"), (1000.0, "of principal axis 3")])
def test_a_fast_spinner_shows_its_axis(rate, label):
    """Sixteen turns are drawn as the rotor, sixteen hundred as the axis that they go about."""
    inertia = ph.Inertia.from_principal_moments(1, 1, 2)
    state = ph.State(ph.Rotor.from_plane_angle(ph.e2 ^ ph.e3, 0.3), [0.0, 0.01 * rate, rate])
    figure = ph.simulate(inertia, state, np.linspace(0, 10, 400)).plot()
    axes = figure.axes[1]
    assert label in axes.get_ylabel()
    drawn = np.stack([line.get_ydata() for line in axes.get_lines()])
    assert np.abs(np.linalg.norm(drawn, axis=0) - 1).max() < 1e-12
