"""What a page tells of a motion is what Python computes."""

import pytest

from command_line import polhode
from polhode import _document, _html
from viewer_scenes import FILES, PRESETS, SCENES

EVERY = [*FILES, *PRESETS, *SCENES]


@pytest.fixture(scope="module")
def shared(_pages, tmp_path_factory, follow):
    """One page, which is shown one scene after the other."""
    page = _pages()
    path = tmp_path_factory.mktemp("page") / "page.html"
    path.write_text(_html.page(_document.of_scene(follow("asymmetric").scene)))
    page.open(path)
    yield page
    assert page.requests == []
    assert page.complaints == []


@pytest.mark.parametrize("name", EVERY)
def test_scenes_are_followed_as_by_python(name, shared, follow):
    followed = follow(name)
    shared.show(_document.of_scene(followed.scene))
    assert shared.viewer.get_attribute("data-method") == followed.motion.certificate.method
    shared.compare(followed)


@pytest.mark.parametrize("name", ["t-handle", "nutating-top", "gravity-gradient", "dual-spin", "detumbling"])
def test_pages_that_run_writes(name, new_page, follow, tmp_path):
    followed = follow(name)
    path = tmp_path / f"{name}.html"
    done = polhode("run", followed.path, "--html", path)
    assert (done.returncode, done.stderr) == (0, "")
    page = new_page()
    page.open(path)
    page.compare(followed)
