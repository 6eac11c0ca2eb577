"""The pages built by `make docs`, opened from disk."""

import pytest

from missing import left_out
from viewer_scenes import ROOT

PAGES = ROOT / "build/docs"


VIEWERS = {"index": 1, "live/free": 3, "live/tops": 3, "live/satellites": 3, "handout/angular-velocity": 1}


@pytest.mark.parametrize("name", VIEWERS)
def test_guides_contain_viewers(name, new_page):
    path = PAGES / f"{name}.html"
    if not (PAGES / "_static/polhode-viewer.js").exists():
        left_out("build/docs is missing, or has no viewer: make docs")
    page = new_page()
    page.page.goto(path.as_uri())
    viewers = page.page.locator("polhode-viewer")
    assert viewers.count() == VIEWERS[name]
    for viewer in viewers.all():
        viewer.and_(page.page.locator("[data-state=ready]")).wait_for()
        assert viewer.get_attribute("data-time") == "0"


def test_viewers_have_the_colours_chosen_for_the_page(new_page):
    if not (PAGES / "_static/polhode-viewer.js").exists():
        left_out("build/docs is missing, or has no viewer: make docs")
    page = new_page(color_scheme="light")
    page.page.goto((PAGES / "index.html").as_uri())
    page.settled()
    surface = "element => getComputedStyle(element).getPropertyValue('--background')"
    light = page.viewer.evaluate(surface)
    page.page.evaluate("() => void (document.body.dataset.theme = 'dark')")
    page.drawn()
    assert page.viewer.evaluate(surface) != light
    page.page.evaluate("() => void (document.body.dataset.theme = 'auto')")
    page.drawn()
    assert page.viewer.evaluate(surface) == light


def test_every_guide_has_a_page():
    if not (PAGES / "index.html").exists():
        left_out("build/docs is missing: make docs")
    docs = ROOT / "docs"
    for guide in docs.rglob("*.md"):
        assert (PAGES / guide.relative_to(docs).with_suffix(".html")).exists()


def test_the_reference_lists_no_names_of_other_libraries():
    path = PAGES / "reference/rotations.html"
    if not path.exists():
        left_out("build/docs is missing: make docs")
    text = path.read_text()
    assert 'id="polhode.Rotor.to_quaternion"' in text
    assert 'id="polhode.Rotor.as_quat"' not in text
