"""Figures on the caller's axes: `Trajectory.plot(ax=...)`."""

import contextlib
import io
import types

import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, R0, START, moments

pytest.importorskip("matplotlib")
from matplotlib import rcParams
from matplotlib.figure import Figure

TIMES = np.linspace(0, 10, 51)
FREE = ph.simulate(ASYMMETRIC, START, TIMES)
TOP = ph.simulate(moments(1, 1, 0.5), ph.State(R0, [0.25, -0.5, 6.0]), TIMES, ph.torque.heavy([0, 0, 2]))
PUSHED = ph.simulate(ASYMMETRIC, START, TIMES, ph.torque.constant_body([0.1, 0, 0]))

ONE_PANEL = {
    "polhode": (FREE, "polhode"),
    "herpolhode": (FREE, "herpolhode"),
    "locus": (TOP, "locus"),
    "phase of a top": (TOP, "phase"),
    "phase of a pushed body": (PUSHED, "phase"),
}
PANELS = [(FREE, "motion"), (TOP, "motion"), (FREE, "drift"), (FREE, "phase")]


@pytest.mark.parametrize("name", ONE_PANEL)
def test_a_figure_is_drawn_on_given_axes(name):
    """The same curves as in a figure of its own; the other axes, title and caption stay the caller's."""
    motion, kind = ONE_PANEL[name]
    figure = Figure()
    left, right = figure.subplots(1, 2)
    size = rcParams["font.size"]
    assert motion.plot(kind, ax=right) is figure
    assert rcParams["font.size"] == size
    assert figure.axes == [left, right]
    assert not left.lines
    assert (figure.get_suptitle(), right.get_title()) == ("", "")
    (own,) = motion.plot(kind).axes
    assert len(right.lines) == len(own.lines) > 0
    for drawn, expected in zip(right.lines, own.lines, strict=True):
        np.testing.assert_array_equal(drawn.get_data(), expected.get_data())
    assert (right.get_xlabel(), right.get_ylabel()) == (own.get_xlabel(), own.get_ylabel())
    figure.savefig(io.BytesIO(), format="png", dpi=40)


def test_the_scene_is_drawn_on_given_axes(monkeypatch):
    """The picture, without a browser."""
    pytest.importorskip("playwright")
    from polhode._figures import film

    picture = io.BytesIO()
    Figure(figsize=(1, 1)).savefig(picture, format="png", dpi=16)

    @contextlib.contextmanager
    def studio(*_):
        yield types.SimpleNamespace(capture=lambda _: picture.getvalue())

    monkeypatch.setattr(film, "studio", studio)
    axes = Figure().subplots()
    FREE.plot("scene", ax=axes)
    (image,) = axes.images
    assert image.get_array().shape[:2] == (16, 16)


def test_several_motions_share_axes():
    axes = Figure().subplots()
    PUSHED.plot("phase", ax=axes)
    first = len(axes.lines)
    PUSHED.plot("phase", ax=axes)
    assert len(axes.lines) == 2 * first


def test_axes_of_pyplot():
    plt = pytest.importorskip("matplotlib.pyplot")
    figure, axes = plt.subplots()
    try:
        assert FREE.plot("herpolhode", ax=axes) is figure
    finally:
        plt.close(figure)


@pytest.mark.parametrize(("motion", "kind"), PANELS)
def test_kinds_with_several_panels_are_refused(motion, kind):
    axes = Figure().subplots()
    with pytest.raises(ValueError, match=rf"kind '{kind}' of this motion has several panels .* without ax"):
        motion.plot(kind, ax=axes)
    assert not axes.lines


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda figure: figure, TypeError, "ax must be axes of matplotlib, got Figure"),
        (lambda figure: figure.subplots(1, 2), TypeError, "got ndarray"),
        (lambda figure: figure.add_subplot(projection="3d"), ValueError, "projection '3d'"),
        (lambda figure: figure.add_subplot(projection="polar"), ValueError, "projection 'polar'"),
    ],
)
def test_other_objects_than_plane_axes_are_refused(make, error, message):
    with pytest.raises(error, match=message):
        FREE.plot("polhode", ax=make(Figure()))
