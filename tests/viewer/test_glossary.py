"""The glossary: one file for docs and viewer, and definitions on hover, focus and tap."""

import re

import pytest

from handout_equations import EQUATIONS
from viewer_page import VIEWER
from viewer_scenes import ROOT

TEXT = (ROOT / "docs/glossary.md").read_text(encoding="utf-8")
TERMS = re.findall(r"^## (.+)$", TEXT, re.MULTILINE)

# Terms whose definitions the viewer must have.
WANTED = {
    *("polhode", "herpolhode", "invariable plane", "energy ellipsoid", "bivector", "rotor", "regime"),
    *("separatrix", "nutation", "precession", "tumbling", "long-axis mode", "short-axis mode"),
    "principal moments",
}


def test_terms_are_sorted_and_short():
    assert sorted(TERMS, key=str.lower) == TERMS
    assert {term.lower() for term in TERMS} >= WANTED
    for section in TEXT.split("\n## ")[1:]:
        words = re.sub(r"<!--.*?-->", "", section).split()
        assert len(words) < 60, section


def test_numbers_are_those_of_equations():
    known = {number for one in EQUATIONS for number in re.findall(r"\d\.\d+", one.number)}
    named = set(re.findall(r"\b[1-4]\.\d+\b", TEXT))
    assert named <= known
    assert len(named) > 8


def definition(page):
    found = page.page.locator(".definition")
    return found.inner_text().lower() if found.count() else None


def test_definitions_open_on_hover_focus_and_press(opened):
    page = opened("toutatis")
    term = page.page.locator(".caption .defined").first
    assert definition(page) is None
    term.hover()
    page.page.locator(".definition").wait_for()
    assert definition(page).startswith("tumbling")
    # The pointer may move to it, and Escape closes it.
    page.page.locator(".definition").hover()
    page.page.wait_for_timeout(400)
    assert definition(page) is not None
    page.page.keyboard.press("Escape")
    page.drawn()
    assert definition(page) is None
    page.page.mouse.move(5, 5)
    page.page.locator("#method").click()
    page.page.locator("#play").focus()
    term.focus()
    for shown in (False, True):
        page.page.keyboard.press("Enter")
        page.drawn()
        # The focus has opened it.
        assert (definition(page) is not None) is shown
    assert page.data("time") == 0
    page.page.keyboard.press("Tab")
    page.drawn()
    assert definition(page) is None or not definition(page).startswith("tumbling")


def test_definitions_open_on_tap(opened):
    page = opened("toutatis", viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True)
    term = page.page.locator(".caption .defined").first
    term.tap()
    page.drawn()
    assert definition(page).startswith("tumbling")
    box = page.page.locator(".definition").bounding_box()
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= 390
    term.tap()
    page.drawn()
    assert definition(page) is None
    term.tap()
    page.drawn()
    assert definition(page) is not None
    page.page.locator("h1").tap()
    page.drawn()
    assert definition(page) is None


@pytest.mark.parametrize("name", ["t-handle", "gyroscope"])
def test_terms_are_described_to_screen_readers(name, opened):
    page = opened(name)
    page.page.evaluate(f"{VIEWER}.shadowRoot.querySelectorAll('details').forEach(one => one.open = true)")
    page.drawn()
    lacking = page.page.evaluate(
        f"""() => {{
            const root = {VIEWER}.shadowRoot;
            const text = (one) => root.getElementById(one.getAttribute("aria-describedby"))?.textContent;
            return [...root.querySelectorAll("[data-term]")]
                .map((one) => (one.matches("label") ? one.querySelector("input") : one))
                .filter((one) => !text(one))
                .map((one) => one.outerHTML);
        }}"""
    )
    assert lacking == []
    assert page.page.locator(".defined").count() > 8


def test_lessons_have_definitions_outside_links(opened):
    text = (
        "---\ntitle: T\nscene: t-handle\n---\n## S\n"
        "The polhode, and [the herpolhode](<#do:show = herpolhode>).\n\n- [ ] a polhode\n- [x] a rotor\n"
    )
    page = opened({"format": 1, "lesson": {"text": text, "name": "t.md"}})
    found = page.page.locator(".prose .defined")
    found.first.wait_for()
    assert found.all_inner_texts() == ["polhode"]
