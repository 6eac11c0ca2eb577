"""The chart of ω under the time line: its values, its marks, and the time that it sets."""

import re

import numpy as np
import pytest

import polhode as ph
from polhode._viewer import document as _document
from viewer_page import VIEWER
from viewer_scenes import RUN, TUMBLING

FLIPPING = TUMBLING.replace("[0.3, 1, 0.2]", "[0.01, 1, 0.01]") + RUN.replace("5 s", "60 s")


def charted(page):
    """Wait for the chart, and return its curves (columns, 3) as shares of its height."""
    page.until(f"{VIEWER}.shadowRoot.querySelector('.plot[data-complete=true] path')")
    page.page.wait_for_timeout(200)
    paths = [page.page.locator(f".plot path.axis-{k}").get_attribute("d") for k in (1, 2, 3)]
    return [np.array(re.findall(r"[ML]([\d.]+) ([\d.]+)", path), dtype=float) for path in paths]


def test_curves_are_those_of_the_motion(opened):
    page = opened({"format": 1, "scene": FLIPPING})
    curves = charted(page)
    start = [0.01, 1, 0.01]
    motion = ph.FreeMotion(ph.Inertia.from_principal_moments(1, 2, 3), ph.Rotor.identity(), start)
    columns = len(curves[0])
    times = 60 * curves[0][:, 0] / columns
    omega = motion.at(times).omega_body.components
    low, high = min(omega.min(), 0), omega.max()
    for k, curve in enumerate(curves):
        expected = 6 + 88 * (1 - (omega[:, k] - low) / (high - low))
        # Two decimals, and the range of the page is that of its own samples, with the same times.
        np.testing.assert_allclose(curve[:, 1], expected, rtol=0, atol=0.011)


def test_flips_are_marked(opened):
    page = opened({"format": 1, "scene": FLIPPING})
    charted(page)
    marks = page.page.locator(".plot .flip")
    start = [0.01, 1, 0.01]
    motion = ph.FreeMotion(ph.Inertia.from_principal_moments(1, 2, 3), ph.Rotor.identity(), start)
    times = np.linspace(0, 60, 60_001)
    middle = motion.at(times).omega_body.components[:, 1]
    crossings = times[1:][middle[1:] * middle[:-1] < 0]
    assert marks.count() == len(crossings) > 2
    places = [float(mark.evaluate("mark => mark.style.left").rstrip("%")) for mark in marks.all()]
    # By a straight line between columns, at least 100, of the curve near zero.
    np.testing.assert_allclose(np.array(places) * 0.6, crossings, rtol=0, atol=0.05)
    assert "flips" in page.page.locator(".plot svg").get_attribute("aria-label")


@pytest.mark.parametrize("scene", ["toutatis", "symmetric", "lagrange"])
def test_motions_without_flips_have_no_marks(scene, opened, follow):
    """Toutatis spins about its long axis: only its small rate about the middle axis changes sign."""
    page = opened({"format": 1, "scene": follow(scene).text})
    charted(page)
    assert page.page.locator(".plot .happening").count() == 0


def test_axes_are_named_by_their_moments(opened):
    page = opened({"format": 1, "scene": TUMBLING.replace("1, 2, 3", "3, 1, 2") + RUN})
    charted(page)
    names = page.page.locator(".strip li[class^=axis-]")
    assert [name.get_attribute("class") for name in names.all()] == ["axis-2", "axis-3", "axis-1"]
    assert [re.sub(r" .*", "", name) for name in names.all_inner_texts()] == ["smallest", "middle", "largest"]
    page.page.evaluate(f"""async () => (await {VIEWER}.ready).change("body.moments = [2, 2, 3]")""")
    page.drawn()
    assert page.page.locator(".strip .axis-3 .name").inner_text() == "symmetry axis"
    assert page.page.locator(".strip .axis-1 .name").inner_text() == "transverse axis"


def band_heights(page):
    """Wait for the bands of the chart, and return the heights (columns,) of that of the first axis."""
    page.until(f"{VIEWER}.shadowRoot.querySelector('.plot path.band')")
    above, below = charted(page)[0][:, 1].reshape(2, -1)
    return below[::-1] - above


@pytest.mark.parametrize("turns", [11, 89])
def test_many_turns_are_drawn_as_bands(turns, opened):
    """
    Each column holds many turns of ω in the body, and shows their whole range. Samples at steps of the
    golden ratio alone would have few phases where a column holds 89 turns: 89 times the ratio is 55.005.
    """
    page = opened({"format": 1, "scene": TUMBLING + RUN})
    columns = len(charted(page)[0])
    # About the symmetry axis ω turns in the body at 10 rad/s.
    scene = TUMBLING.replace("[0.3, 1, 0.2]", "[0.3, 0.0, 20]").replace("1, 2, 3", "2, 2, 3")
    seconds = turns * columns * 2 * np.pi / 10
    page = opened({"format": 1, "scene": scene + RUN.replace("5 s", f"{seconds} s")})
    heights = band_heights(page)
    # In 1 % of columns none of 24 random samples of a sine is in the upper twelfth of its range.
    assert (heights > 0.85 * heights.max()).mean() > 0.95


def test_pointer_seeks_and_shares_the_focus_of_the_slider(opened):
    page = opened("t-handle")
    charted(page)
    box = page.page.locator(".plot").bounding_box()
    page.page.mouse.click(box["x"] + box["width"] / 3, box["y"] + 20)
    assert page.data("time") == pytest.approx(4, abs=12 / box["width"])
    page.page.mouse.down()
    page.page.mouse.move(box["x"] + box["width"] / 2, box["y"] + 20)
    assert page.data("time") == pytest.approx(6, abs=12 / box["width"])
    page.page.mouse.move(box["x"] + 2 * box["width"], box["y"] + 20)
    assert page.data("time") == 12
    page.page.mouse.up()
    assert page.page.evaluate(f"{VIEWER}.shadowRoot.activeElement.id") == "time"
    page.page.keyboard.press("ArrowLeft")
    assert page.data("time") < 12
    assert page.page.locator(".plot .playhead").count() == 1


def test_pointer_shows_values(opened, follow):
    page = opened({"format": 1, "scene": FLIPPING})
    charted(page)
    box = page.page.locator(".plot").bounding_box()
    page.page.mouse.move(box["x"] + box["width"] / 2, box["y"] + 20)
    page.drawn()
    time = float(page.page.locator(".strip ul").get_attribute("data-time"))
    assert time == pytest.approx(30, abs=60 / box["width"])
    assert page.data("time") == 0
    motion = ph.FreeMotion(ph.Inertia.from_principal_moments(1, 2, 3), ph.Rotor.identity(), [0.01, 1, 0.01])
    shown = page.page.locator(".strip li .digits").all_inner_texts()[:3]
    values = [float(text.replace("−", "-").replace("\xa0×\xa010", "e").translate(RAISED)) for text in shown]
    np.testing.assert_allclose(values, motion.at(time).omega_body.components, rtol=6e-3, atol=1e-12)


RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")


def test_small_pages_fold_the_chart(opened):
    page = opened("t-handle", viewport={"width": 390, "height": 844})
    assert page.page.locator(".plot").count() == 0
    toggle = page.page.locator("#strip-toggle")
    assert toggle.get_attribute("aria-expanded") == "false"
    toggle.click()
    charted(page)
    assert page.page.evaluate("[scrollY, document.documentElement.scrollWidth]") == [0, 390]


def test_events_of_a_recorded_motion_are_marked(opened):
    body = ph.Inertia.from_principal_moments(1, 2, 3)
    start = ph.State(ph.Rotor.identity(), [0.3, 1, 0.2])
    event = ph.event.plane([1, 0, 0], [0, 0, 1])
    motion = ph.simulate(body, start, np.linspace(0, 10, 101), lambda t, R, W: -0.1 * W, events=[event])
    (crossings,) = motion.events
    assert len(crossings) > 0
    page = opened(_document.document(motion))
    charted(page)
    places = [
        float(mark.evaluate("mark => mark.style.left").rstrip("%"))
        for mark in page.page.locator(".plot .happening").all()
    ]
    np.testing.assert_allclose(places, 10 * crossings.time, rtol=1e-5)
