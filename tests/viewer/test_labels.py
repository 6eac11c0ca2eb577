"""Labels of the picture: on plates that do not overlap, and that keep their places while the motion plays."""

import json

import numpy as np
import pytest

from viewer_page import VIEWER

# Everything at once, which crowds the labels.
ALL = {"shown": {"axial": True, "omega": True, "momentum": True, "poinsot": True, "herpolhode": True}}
PLATES = f"{VIEWER}.shadowRoot.querySelector('.stage canvas[data-plates]').dataset.plates"
# The boxes of the legend's entries in the picture.
LEGEND = f"""() => {{
    const root = {VIEWER}.shadowRoot;
    const stage = root.querySelector(".stage").getBoundingClientRect();
    return [...root.querySelectorAll(".key .entry")].map((entry) => {{
        const {{ left, top, right, bottom }} = entry.getBoundingClientRect();
        return [left - stage.left, top - stage.top, right - stage.left, bottom - stage.top];
    }});
}}"""
# Plates of successive frames of a motion that plays slowly, whatever the time that a frame takes here.
PLAY = f"""async ([count, step]) => {{
    const model = await {VIEWER}.ready;
    const stage = {VIEWER}.shadowRoot.querySelector(".stage");
    model.look({{ playing: true, speed: 0 }});
    const found = [];
    for (let k = 0; k < count; k++) {{
        const {{ drawn }} = stage.dataset;
        model.time.value += step;
        while (stage.dataset.drawn === drawn) await new Promise(requestAnimationFrame);
        found.push({PLATES});
    }}
    return found;
}}"""


def plates(text):
    """Return the plates by their labels: left, top, right, bottom in CSS pixels."""
    return {name: np.array(box) for name, *box in json.loads(text)}


def overlaps(found):
    boxes = list(found.values())
    return sum(
        bool((a[:2] < b[2:]).all() and (b[:2] < a[2:]).all())
        for k, a in enumerate(boxes)
        for b in boxes[k + 1 :]
    )


@pytest.mark.parametrize(
    ("name", "width"),
    [
        ("gyroscope", 390),
        *(pytest.param(name, 1280, marks=pytest.mark.slow) for name in ("t-handle", "nutating-top")),
    ],
)
def test_plates_do_not_overlap(name, width, opened):
    page = opened(name, viewport={"width": width, "height": 800})
    page.page.evaluate(f"async view => (await {VIEWER}.ready).look(view)", ALL)
    duration = page.page.evaluate(f"async () => (await {VIEWER}.ready).about.value.duration")
    for part in (0, 0.1, 0.23, 0.41, 0.77):
        page.seek(part * duration)
        page.drawn()
        found = plates(page.page.evaluate(PLATES))
        assert len(found) >= 5
        assert overlaps(found) == 0
        assert all(box.min() >= 0 for box in found.values())


@pytest.mark.parametrize(
    ("size", "compact"), [((736, 544), True), ((1280, 800), False), ((390, 844), False)], ids=str
)
def test_labels_keep_clear_of_the_legend(size, compact, opened):
    """At its start the T-handle has L at the bottom of its picture, where the legend is."""
    page = opened("t-handle", viewport=dict(zip(("width", "height"), size, strict=True)))
    page.page.evaluate(f"compact => {VIEWER}.toggleAttribute('compact', compact)", compact)
    toggle = page.page.locator("#legend-toggle")
    if toggle.get_attribute("aria-expanded") == "false":
        toggle.click()
    page.drawn()
    entries = page.page.evaluate(LEGEND)
    assert len(entries) == 7
    found = plates(page.page.evaluate(PLATES))
    assert len(found) >= 6
    for entry in entries:
        assert [name for name, box in found.items() if overlaps({"": np.array(entry), name: box})] == []


def test_labels_do_not_jump_while_the_motion_plays(opened):
    """A label goes from place to place in steps that the eye follows, and no plate ever covers another."""
    page = opened("nutating-top", reduced_motion="no-preference", viewport={"width": 560, "height": 640})
    page.page.evaluate(f"async view => (await {VIEWER}.ready).look(view)", ALL)
    page.drawn()
    before, jumps, seen = {}, 0, 0
    for text in page.page.evaluate(PLAY, [60, 1 / 240]):
        found = plates(text)
        assert overlaps(found) == 0
        for name in found.keys() & before.keys():
            seen += 1
            # The height of a line of letters; the top moves by at most 14 px from frame to frame.
            jumps += np.abs(found[name][:2] - before[name][:2]).max() > 21
        before = found
    assert seen > 300
    # Labels whose ways cross change places at once, lest one covers the other; here 13 of 540 do,
    # where names such as "transverse axis" are long.
    assert jumps <= seen / 30
