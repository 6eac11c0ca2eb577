"""Figures for journals: widths, captions, the caller's style, and what is left out."""

import re

import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, START, moments
from polhode._figures.handout import handout_figure
from polhode._figures.style import Sheet, width_of, wrapped

matplotlib = pytest.importorskip("matplotlib")


TIMES = np.linspace(0, 10, 51)
FREE = ph.simulate(ASYMMETRIC, START, TIMES)
DAMPED = ph.simulate(ASYMMETRIC, START, TIMES, ph.torque.viscous_damping(0.1))


def sizes_of(figure):
    figure.canvas.draw()
    return {round(text.get_fontsize(), 6) for text in figure.findobj(matplotlib.text.Text) if text.get_text()}


@pytest.mark.parametrize("kind", ["motion", "polhode", "herpolhode", "drift", "phase"])
@pytest.mark.parametrize(
    ("width", "inches"), [("85mm", 85 / 25.4), ("18cm", 18 / 2.54), ("3.4 in", 3.4), (5, 5)]
)
def test_a_figure_has_the_width_of_a_journal(kind, width, inches):
    """No letter is smaller than 7 points, up to the caption at 0.9 times the size, nor outside the figure."""
    figure = FREE.plot(kind, width=width)
    assert figure.get_figwidth() == pytest.approx(inches)
    assert min(size for size in sizes_of(figure)) >= 0.7 * 7  # a subscript is 0.7 times as high
    for text in (figure._suptitle, figure._supxlabel):
        box = text.get_window_extent()
        assert box.x0 >= 0
        assert box.x1 <= figure.bbox.x1


@pytest.mark.parametrize(
    "width", ["85", "85 furlongs", "mm", "", "1e400mm", "nan", -3, float("nan"), "2mm", [3]]
)
def test_a_wrong_width_is_an_error(width):
    with pytest.raises(ValueError, match=r"^width"):
        FREE.plot(width=width)


def test_a_caption_is_optional():
    assert FREE.plot("polhode").get_supxlabel()
    assert FREE.plot("polhode", caption=False).get_supxlabel() == ""
    assert handout_figure(2, Sheet(caption=False)).get_supxlabel() == ""


def test_settings_of_the_caller_are_kept():
    """A size that the caller sets wins over ours; others are ours, whatever the width."""
    with matplotlib.rc_context({"font.size": 13.0, "axes.linewidth": 2.5}):
        figure = FREE.plot("polhode", width="85mm")
        assert figure._supxlabel.get_fontsize() == pytest.approx(0.9 * 13)
        assert FREE.plot().axes[0].spines["left"].get_linewidth() == 2.5
    figure = FREE.plot("polhode")
    assert figure._supxlabel.get_fontsize() == pytest.approx(0.9 * 9)
    with matplotlib.rc_context({"font.family": "serif"}):
        assert FREE.plot().axes[0].xaxis.label.get_fontfamily() == ["serif"]


def test_conserved_quantities_have_no_flat_panel():
    """They are in the caption; those that vary have a panel."""
    assert len(FREE.plot().axes) == 2
    caption = FREE.plot().get_supxlabel().replace("\n", " ")
    assert re.search(r"Conserved, relative: energy to \de-\d\d, \|L\| to \de-\d\d", caption)
    *_, sizes = DAMPED.plot().axes
    np.testing.assert_allclose(sizes.lines[0].get_ydata() * DAMPED.energy.max(), DAMPED.energy, rtol=1e-12)
    for motion in (FREE, DAMPED, ph.simulate(moments(1, 1, 2), START, TIMES)):
        for axes in motion.plot("drift").axes:
            assert any(np.ptp(line.get_ydata()) > 0 for line in axes.lines)


def test_the_title_names_motion_and_kind():
    motion = ph.simulate(ASYMMETRIC, START, TIMES)
    motion.attributes["title"] = "A $5 body"
    assert motion.plot("polhode").get_suptitle() == r"A \$5 body: polhode"
    assert FREE.plot("polhode").get_suptitle() == "Polhode"


def test_arrowheads_sit_on_the_rim():
    """Each head of figure 2 is at a point of the rim of the disc, on the tangent there."""
    (axes,) = handout_figure(2).axes
    (rim, *_) = [patch.get_xy()[:361] for patch in axes.patches if len(patch.get_xy()) >= 361]
    heads = [line for line in axes.lines if isinstance(line.get_marker(), matplotlib.path.Path)]
    assert len(heads) == 3
    for head in heads:
        place = head.get_xydata()[0]
        k = int(np.argmin(np.linalg.norm(rim - place, axis=1)))
        np.testing.assert_allclose(rim[k], place, atol=1e-12)
        tangent = rim[k + 1] - rim[k - 1]
        pointed = head.get_marker().vertices[1]  # the tip, from the middle of the head
        assert float(tangent @ pointed) == pytest.approx(np.linalg.norm(tangent) * np.linalg.norm(pointed))


def test_formulas_stay_whole_in_wrapped_texts():
    text = r"before $\Omega_B = \Sigma\,\omega_k\,I e_k$ and after the formula, " * 6
    lines = wrapped(text, 2.0, 9.0).split("\n")
    assert len(lines) > 4
    assert all(line.count("$") % 2 == 0 for line in lines)
    assert " ".join(lines).count(r"$\Omega_B = \Sigma\,\omega_k\,I e_k$") == 6


def test_numbers_stay_with_their_units_in_wrapped_texts():
    parts = ["$E$ = 0.1162 J", "about the axis, 15 kg m²/s", "moments 0.0001755, 0.0002354 kg m²", "in 18 s"]
    whole = ["= 0.1162 J", "15 kg m²/s", "0.0002354 kg m²", "18 s"]
    for width in np.linspace(1.0, 4.0, 25):
        lines = wrapped(", ".join(parts * 4), width, 9.0).split("\n")
        assert [sum(line.count(text) for line in lines) for text in whole] == [4] * 4, width


def test_widths_in_several_units():
    assert width_of("85mm") == width_of("8.5 cm") == pytest.approx(3.3464567)
    assert width_of(None) is None
    assert width_of(" 3.5in ") == width_of(3.5) == 3.5
