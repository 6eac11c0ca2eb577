"""Small screens: titles that are not cut off, controls that a finger hits, playback in two rows."""

from itertools import pairwise

import pytest

from viewer_page import VIEWER
from viewer_scenes import RUN, TUMBLING

# The title of an example, and as long as they are.
TITLE = "Dual-spin satellite, middle axis held by a wheel"
PHONE = {"viewport": {"width": 390, "height": 844}, "is_mobile": True, "has_touch": True}
TABLET = {"viewport": {"width": 768, "height": 1024}, "is_mobile": True, "has_touch": True}

# Controls that are smaller than a size, WCAG 2.2 target size; underlined phrases in texts are exempt.
SMALL = f"""(least) => [...{VIEWER}.shadowRoot.querySelectorAll("button, input, select, summary")]
    .filter((control) => control.checkVisibility() && !control.matches(".hidden"))
    .map((control) => (control.type === "checkbox" ? control.closest("label") : control))
    .map((control) => [control.id || control.textContent, control.getBoundingClientRect()])
    .filter(([, {{ width, height }}]) => width < least || height < least)
    .map(([name, {{ width, height }}]) => [name, width, height])"""
# The middles of what is in the playback bar, by rows.
ROWS = f"""() => [...{VIEWER}.shadowRoot.querySelector(".playback .line").children]
    .map((part) => part.getBoundingClientRect())
    .map(({{ top, bottom }}) => (top + bottom) / 2)"""


def scene(duration):
    return {"format": 1, "scene": f'title = "{TITLE}"\n{TUMBLING}{RUN.replace("5 s", duration)}'}


@pytest.mark.parametrize("size", [PHONE, TABLET], ids=["phone", "tablet"])
def test_titles_are_not_cut_off(size, opened):
    page = opened(scene("5 s"), **size)
    title = page.page.get_by_role("heading", name=TITLE)
    cut = title.evaluate(
        "({ scrollWidth, clientWidth, scrollHeight, clientHeight }) => "
        "[scrollWidth - clientWidth, scrollHeight - clientHeight]"
    )
    # Letters hang a pixel or two below their line.
    assert max(cut) <= 2


def test_controls_are_large_enough_for_fingers(opened):
    page = opened(scene("5 s"), **PHONE)
    page.page.evaluate(
        f"() => {VIEWER}.shadowRoot.querySelectorAll('details').forEach((one) => (one.open = true))"
    )
    page.drawn()
    assert page.page.evaluate(SMALL, 24) == []
    page.page.locator("#scenes").click()
    assert page.page.evaluate(SMALL, 24) == []
    # The main ones have the size of a finger.
    assert page.page.locator("#play").bounding_box()["height"] >= 44


@pytest.mark.parametrize("duration", ["5 s", "60 d", "30 yr"])
def test_playback_has_two_rows_on_phones(duration, opened):
    page = opened(scene(duration), **PHONE)
    middles = sorted(page.page.evaluate(ROWS))
    rows = 1 + sum(after - before > 12 for before, after in pairwise(middles))
    assert rows == 2


@pytest.mark.parametrize("size", [(736, 608), (1100, 608), (360, 608)], ids=str)
def test_compact_pages_show_picture_and_caption_at_once(size, opened):
    """Those in guides: the caption is above the playback bar without scrolling, and the title is whole."""
    width, height = size
    page = opened("t-handle", viewport={"width": width, "height": 1000})
    page.page.evaluate(
        f"""height => {{
            {VIEWER}.style.height = `${{height}}px`;
            {VIEWER}.toggleAttribute("compact", true);
        }}""",
        height,
    )
    if page.page.locator("#strip-toggle").get_attribute("aria-expanded") == "true":
        page.page.locator("#strip-toggle").click()
    page.drawn()
    caption = page.page.locator(".caption").bounding_box()
    bar = page.page.locator(".playback").bounding_box()
    assert bar["y"] + bar["height"] <= height
    # Two lines of caption; a phone may have a third below.
    assert caption["y"] + min(caption["height"], 60) <= bar["y"]
    title = page.page.get_by_role("heading", name="T-handle")
    assert title.bounding_box()["width"] > 180
    assert page.page.locator(".stage").bounding_box()["height"] >= 192
