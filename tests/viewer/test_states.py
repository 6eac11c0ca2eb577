"""The states shown by a page equal those of Python."""

import numpy as np
import pytest

from command_line import polhode
from polhode._viewer import document
from polhode._viewer import html as _html
from viewer_scenes import FILES, PRESETS, SCENES

EVERY = [*FILES, *PRESETS, *SCENES]


@pytest.fixture(scope="module")
def shared(pages, tmp_path_factory, follow):
    """One page for all scenes."""
    page = pages()
    path = tmp_path_factory.mktemp("page") / "page.html"
    path.write_text(_html.page(document.of_scene(follow("asymmetric").scene)))
    page.open(path)
    yield page
    assert page.requests == []
    assert page.complaints == []


@pytest.mark.parametrize(
    "name",
    [name if k % 3 == 0 else pytest.param(name, marks=pytest.mark.slow) for k, name in enumerate(EVERY)],
)
def test_scenes_have_the_states_of_python(name, shared, follow):
    followed = follow(name)
    shared.show(document.of_scene(followed.scene))
    assert shared.viewer.get_attribute("data-method") == followed.motion.certificate.method
    shared.compare(followed)


@pytest.mark.parametrize(
    ("name", "momentum", "energy"),
    [
        ("t-handle", True, True),
        ("lagrange", False, True),
        ("viscous damping", False, False),
        ("gyrostat", True, True),
    ],
)
def test_drift_is_shown_for_conserved_quantities(name, momentum, energy, shared, follow):
    followed = follow(name)
    shared.show(document.of_scene(followed.scene))
    shared.seek(0.3 * followed.motion.time[-1])
    shared.drawn()
    values = dict(zip(("|L|", "E"), shared.page.locator(".readout.pair dd").all_inner_texts(), strict=True))
    for quantity, conserved in (("|L|", momentum), ("E", energy)):
        assert ("drift" in values[quantity]) is conserved
        assert ("since the start" in values[quantity]) is not conserved
    kept = {"angular_momentum": momentum, "energy": energy}
    assert {name for name, yes in kept.items() if yes} <= set(followed.motion.certificate.conserved)


def written_page(followed, page, folder):
    """Open the page that `polhode run --html` writes for a scene."""
    path = folder / "written.html"
    done = polhode("run", followed.path, "--html", path)
    assert (done.returncode, done.stderr) == (0, "")
    # Without a recorded motion a page contains little but the viewer.
    assert path.stat().st_size < 1.5e6 or "recorded" in path.read_text()
    page.open(path)
    return page


@pytest.mark.parametrize("name", ["t-handle", "nutating-top", "gravity-gradient", "dual-spin"])
def test_pages_written_by_run(name, new_page, follow, tmp_path):
    followed = follow(name)
    written_page(followed, new_page(), tmp_path).compare(followed)


@pytest.mark.slow
def test_long_run_is_thinned(new_page, follow, tmp_path):
    """Rows are at most 0.2 rad apart, and interpolation between them is off by at most 0.2²/8."""
    followed = follow("detumbling")
    page = written_page(followed, new_page(), tmp_path)
    page.compare(followed, 0.2**2 / 8)
    page.seek(followed.motion.time[-1])
    np.testing.assert_allclose(page.data("rotor"), followed.motion.rotor[-1].components, rtol=0, atol=1e-12)
