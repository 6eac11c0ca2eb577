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
