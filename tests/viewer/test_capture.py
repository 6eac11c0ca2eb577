"""Pictures captured from the viewer: of exact times, in exact sizes, from given directions."""

import asyncio
import io
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import polhode as ph
import studios
from polhode._viewer import capture
from viewer_page import SHOWN

pytest.importorskip("playwright")
Image = pytest.importorskip("PIL.Image")

TIMES = np.array([0.0, 1.2345678901234567, 3.3])
SIZE = (322, 182)


@pytest.fixture(autouse=True, scope="module")
def _browser():
    studios.require_browser()


def motion(torque=None, times=(0, 5, 11)):
    inertia = ph.Inertia.from_principal_moments(1, 2, 3)
    state = ph.State(ph.Rotor.from_components([4, -2, 1, 2]), [0.25, -0.5, 1.0])
    return ph.simulate(inertia, state, np.linspace(*times), torque)


def opened(moved, view=None, times=TIMES):
    return capture.studio(moved, times, SIZE, view, "a test")


@pytest.fixture(scope="module")
def exact():
    """One studio with a motion in closed form, for several tests."""
    with opened(motion()) as studio:
        yield studio


def pixels(png):
    with Image.open(io.BytesIO(png)) as picture:
        assert (picture.format, picture.size) == ("PNG", SIZE)
        return np.asarray(picture.convert("RGB")).astype(int)


def shown(studio):
    """The state that the element reports."""
    data = studio._call(studio.page.evaluate, "() => ({...document.querySelector('polhode-viewer').dataset})")
    return {name: np.array(data[camel(name)].split(), float) for name in ("time", *SHOWN)}


def camel(name):
    first, *others = name.split("_")
    return first + "".join(map(str.capitalize, others))


@pytest.mark.parametrize(
    "torque",
    [None, lambda t, R, W: -0.1 * W, ph.torque.formula("-0.2 Ω + 0.1 e1∧e2")],
    ids=["exact", "recorded", "stepped"],
)
def test_the_state_is_that_of_the_motion_at_the_time(torque):
    moved = motion(torque)
    with opened(moved) as studio:
        for time in TIMES:
            studio.capture(float(time))
            found, state = shown(studio), moved.at(time)
            assert found["time"] == time
            # An exact motion the page computes with other instructions; it interpolates a stepped one at its
            # rows. Both differ by a few units in the last place.
            atol = 1e-14
            np.testing.assert_allclose(found["rotor"], state.rotor.components, rtol=0, atol=atol)
            np.testing.assert_allclose(found["omega_body"], state.omega_body.components, rtol=0, atol=atol)


def test_a_time_has_one_picture(exact):
    """It does not depend on what was captured before; other times and directions have other pictures."""
    first, other = (exact.capture(float(time)) for time in TIMES[1:])
    assert exact.capture(float(TIMES[1])) == first
    turned = exact.capture(float(TIMES[1]), view=(100.0, 10.0))
    for picture in (other, turned):
        assert np.abs(pixels(picture) - pixels(first)).max() > 50


@pytest.mark.slow
def test_a_view_from_a_direction():
    """Seen along e3, the arrows e1 and e2 are in the plane of the picture, where the azimuth puts them."""
    still = ph.simulate(
        ph.Inertia.from_principal_moments(1, 2, 3), ph.State(ph.Rotor.identity(), [0, 0, 0]), [0.0, 1.0]
    )
    expected = (((0, 1), (1, 0)), ((-1, 0), (0, 1)))
    with opened(still, (0.0, 90.0), np.zeros(1)) as studio:
        images = [pixels(studio.capture(0.0)), pixels(studio.capture(0.0, view=(90.0, 90.0)))]
    for image, (blue_at, orange_at) in zip(images, expected, strict=True):
        warmth = image[..., 0] - image[..., 2]  # e1 is blue, e2 orange, all else nearly grey
        for seen, (right, down) in ((-warmth > 60, blue_at), (warmth > 60, orange_at)):
            rows, columns = np.nonzero(seen)
            place = np.array([columns.mean() - SIZE[0] / 2, rows.mean() - SIZE[1] / 2])
            assert place @ (right, down) > 0.9 * np.linalg.norm(place) > 5


def test_the_paper_is_white_and_texts_are_at_its_edges(exact):
    plain = pixels(exact.capture(0.0))
    written = pixels(exact.capture(0.0, title="Title", note="t = 0 s"))
    assert (plain[[0, 0, -1, -1], [0, -1, 0, -1]] == 255).all()
    rows = np.nonzero((plain != written).any(axis=(1, 2)))[0]
    assert rows.min() < 30
    assert rows.max() > SIZE[1] - 30
    assert not ((rows > 40) & (rows < SIZE[1] - 40)).any()


@pytest.mark.slow
def test_times_outside_of_the_motion_are_refused():
    unknown = pytest.raises(OSError, match="the motion is not known at t = 9 s")
    with opened(motion(lambda t, R, W: -0.1 * W)) as studio, unknown:
        studio.capture(9.0)


@pytest.mark.slow
def test_it_runs_inside_an_event_loop():
    """As in a notebook, where Playwright refuses to run. In a thread: ours may have a loop already."""

    async def cell():
        with opened(motion()) as studio:
            return studio.capture(0.0)

    with ThreadPoolExecutor(1) as thread:
        assert thread.submit(lambda: asyncio.run(cell())).result().startswith(b"\x89PNG")


def test_figures_have_the_picture():
    figure = motion().plot("scene", time=1.0, view=(20, 30))
    picture = figure.axes[0].get_images()[0].get_array()
    assert picture.shape[:2] == (1080, 1920)
    # The background, the body and its discs.
    assert 0.5 < (picture[..., :3] == 1).all(axis=-1).mean() < 0.95


def test_without_a_browser_the_error_names_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(capture, "_CHOICES", ({"executable_path": str(tmp_path / "none")},))
    with (
        pytest.raises(
            OSError, match=r"a test needs a browser: install Chromium or Chrome .*apt install chromium"
        ),
        opened(motion()),
    ):
        pass


def test_a_browser_that_does_not_start_is_named(tmp_path, monkeypatch):
    broken = tmp_path / "chromium"
    broken.write_text("#!/bin/sh\nexit 3\n")
    broken.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(capture, "_CHOICES", ())
    with (
        pytest.raises(OSError, match=f"a test needs a browser, and {broken} did not start: "),
        opened(motion()),
    ):
        pass


def test_without_playwright_the_error_names_the_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "playwright.sync_api", None)
    with (
        pytest.raises(ImportError, match=r"a test needs playwright: pip install 'polhode\[film\]'"),
        opened(motion()),
    ):
        pass
