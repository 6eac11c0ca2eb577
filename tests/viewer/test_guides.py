"""The pages built by `make docs`, opened from disk."""

import pytest

from missing import left_out
from viewer_scenes import ROOT

PAGES = ROOT / "build/docs"


@pytest.mark.parametrize("name", ["index", "live/free", "live/tops", "live/satellites"])
def test_guides_contain_viewers(name, new_page):
    path = PAGES / f"{name}.html"
    if not (PAGES / "_static/polhode-viewer.js").exists():
        left_out("build/docs is missing, or has no viewer: make docs")
    page = new_page()
    page.page.goto(path.as_uri())
    viewers = page.page.locator("polhode-viewer")
    assert viewers.count() == (1 if name == "index" else 3)
    for viewer in viewers.all():
        viewer.and_(page.page.locator("[data-state=ready]")).wait_for()
        assert viewer.get_attribute("data-time") == "0"


def test_every_guide_has_a_page():
    if not (PAGES / "index.html").exists():
        left_out("build/docs is missing: make docs")
    for guide in (ROOT / "docs").glob("*.md"):
        assert (PAGES / guide.with_suffix(".html").name).exists()
