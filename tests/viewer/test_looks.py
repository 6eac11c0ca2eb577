"""Appearance of a page: pictures, themes, small screens, and the time per frame."""

import numpy as np
import pytest

from pictures import colours, near, picture
from polhode._viewer import document as _document
from viewer_page import VIEWER
from viewer_scenes import ROOT, TUMBLING


@pytest.mark.parametrize(
    "name",
    [
        *("t-handle", "nutating-top", "toutatis-uncertain"),
        *(pytest.param(name, marks=pytest.mark.slow) for name in ("symmetric", "gravity-gradient")),
    ],
)
def test_pictures_show_the_motion(name, opened):
    page = opened(name, color_scheme="light")
    first = picture(page)
    light = colours("LIGHT")
    # Most pixels are background; the discs of Ω and L have rims in their own colours.
    assert 0.3 * first[..., 0].size < near(first, light["background"]) < 0.98 * first[..., 0].size
    assert near(first, light["omega"], 40) > 100
    assert near(first, light["momentum"], 40) > 100
    page.seek(0.37 * page.page.evaluate(f"async () => (await {VIEWER}.ready).about.value.duration"))
    assert np.abs(picture(page) - first).max() > 50


def test_same_state_looks_the_same(opened):
    page = opened("t-handle")
    page.seek(1.0)
    first = picture(page)
    page.seek(2.0)
    other = picture(page)
    page.seek(1.0)
    again = picture(page)
    # Labels may move by a pixel; another state differs in far more pixels.
    changed = (np.abs(again - first).max(axis=-1) > 32).mean()
    assert changed < 0.002
    assert (np.abs(other - first).max(axis=-1) > 32).mean() > 10 * max(changed, 0.001)


ALONE = {
    **dict.fromkeys(("bodyFrame", "spaceFrame", "omega", "momentum", "polhode", "trace", "labels"), False),
    "body": True,
}


@pytest.mark.slow
@pytest.mark.parametrize("still", ["reduce", "no-preference"])
@pytest.mark.parametrize("chosen", [True, False], ids=["chosen", "given"])
def test_body_stands_still_for_its_camera(still, chosen, opened, follow):
    """The camera turns with the body from the first frame on, even while the motion is paused."""
    view = {"time": 1.0, "playing": False, "shown": ALONE}
    document = _document.of_scene(follow("t-handle").scene)
    camera = {} if chosen else {"camera": "with the body"}
    page = opened({**document, "view": view | camera}, reduced_motion=still)
    if chosen:
        from_aside = picture(page)
        page.page.keyboard.press("6")
        settle(page)
        assert differ(from_aside, picture(page)) > 0.01
    first = picture(page)
    for time in (2.37, 5.0):
        page.seek(time)
        # The body makes many turns between these times.
        assert differ(first, picture(page)) < 1e-4


def differ(one, other):
    """Return the fraction of pixels that differ."""
    return (np.abs(one - other).max(axis=-1) > 32).mean()


def settle(page):
    """Wait until no more frames are drawn: cameras move smoothly."""
    stage = page.page.locator("polhode-viewer .stage")
    drawn = None
    while drawn != (drawn := stage.get_attribute("data-drawn")):
        page.page.wait_for_timeout(300)


@pytest.mark.parametrize("theme", ["LIGHT", "DARK"])
def test_themes_follow_the_system(theme, opened):
    page = opened("t-handle", color_scheme=theme.lower())
    pixels = picture(page)
    assert near(pixels, colours(theme)["background"], 3) > 0.3 * pixels[..., 0].size
    assert near(pixels, colours(theme)["omega"]) > 100


def test_theme_can_be_chosen(opened):
    page = opened("t-handle", color_scheme="light")
    page.page.locator("#panel-view summary").click()
    page.page.get_by_label("Colours").select_option("dark")
    pixels = picture(page)
    assert near(pixels, colours("DARK")["background"], 3) > 0.3 * pixels[..., 0].size


@pytest.mark.parametrize("shown", ["t-handle", {"format": 1, "page": "algebra"}], ids=["motion", "algebra"])
def test_phone_needs_no_sideways_scrolling(shown, opened):
    page = opened(shown, viewport={"width": 360, "height": 740}, is_mobile=True, has_touch=True)
    page.drawn()
    wide = page.page.evaluate(
        f"""() => [document.documentElement, ...{VIEWER}.shadowRoot.querySelectorAll("*")]
            .filter((element) => element.clientWidth > 200 && element.scrollWidth > element.clientWidth + 1)
            // Clipped content cannot be scrolled to.
            .filter((element) => !["hidden", "clip"].includes(getComputedStyle(element).overflowX))
            .map((element) => `${{element.localName}}.${{element.className}}`)"""
    )
    assert wide == []
    outside = page.page.evaluate(
        f"""() => [...{VIEWER}.shadowRoot.querySelectorAll("button, input, select")]
            .filter((control) => control.checkVisibility() && control.getBoundingClientRect().right > 361)
            .map((control) => control.id)"""
    )
    assert outside == []
    if shown == "t-handle":
        # Time and what plays are on one line, the rest on a second one.
        low, high = (page.page.locator(f"#{name}").bounding_box()["y"] for name in ("faster", "restart"))
        assert low == pytest.approx(high, abs=1)


@pytest.mark.parametrize("size", [(1280, 800), (360, 740)], ids=["wide", "narrow"])
def test_document_does_not_scroll(size, opened):
    """The app scrolls within itself, also where labels for screen readers stand far below."""
    page = opened("t-handle", viewport=dict(zip(("width", "height"), size, strict=True)))
    page.page.evaluate(f"{VIEWER}.shadowRoot.querySelectorAll('details').forEach(one => one.open = true)")
    page.drawn()
    page.page.evaluate("window.scrollTo(0, 1e5)")
    assert page.page.evaluate("[scrollY, document.documentElement.scrollHeight]") == [0, size[1]]


def test_styles_of_the_playback_bar_stay_there(opened):
    """Lines of formulas have the same class as its lines, and no space between a formula and its value."""
    page = opened({"format": 1, "page": "algebra", "lines": "a = e1\nb = 2 a"})
    style = page.page.locator("li.line").first.evaluate(
        "line => { const { rowGap, alignItems, flexWrap } = getComputedStyle(line);"
        " return [rowGap, alignItems, flexWrap]; }"
    )
    assert style == ["normal", "normal", "nowrap"]


def test_stroboscopic_picture_has_a_warning(opened):
    """At 60 frames per second, 100 turns per second are visible at up to a tenth of the true speed."""
    page = opened("gyroscope")
    note = page.page.get_by_text("Stroboscopic")
    for speed, playing, shown in (
        (1, True, True),
        (0.1, True, False),
        (0.2, True, True),
        (0.2, False, False),
    ):
        page.page.evaluate(
            f"async view => (await {VIEWER}.ready).look(view)", {"speed": speed, "playing": playing}
        )
        page.drawn()
        assert note.is_visible() is shown
        if shown:
            assert "up to 0.1×" in note.inner_text()


@pytest.mark.slow
def test_time_per_frame_of_a_long_trace(opened, record_property):
    """The time per frame with ten thousand points of a path is reported, not asserted."""
    scene = TUMBLING + '[run]\nduration = "10 min"\nsamples = 10001\n'
    page = opened({"format": 1, "scene": scene, "view": {"speed": 20, "playing": True}})
    stage = page.page.locator("polhode-viewer .stage")
    # The paths are computed in parts, one millisecond of a frame.
    page.until(f"{VIEWER}.shadowRoot.querySelector('.stage').dataset.points >= 10_000")
    took, points = float(stage.get_attribute("data-frame-ms")), int(stage.get_attribute("data-points"))
    record_property(f"JavaScript of a frame with {points} points of paths", f"{took:.2f} ms")


WATCH = """
    window.drawn = [];
    const { fillText } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.fillText = function (text, ...more) {
        window.drawn.push(text);
        return fillText.call(this, text, ...more);
    };
"""


@pytest.mark.parametrize(
    ("shown", "drawn"),
    [("momentum", {"L"}), ("omega", {"Ω"}), ("omega momentum", {"L", "Ω"}), ("", {"L", "Ω"})],
)
def test_arrows_stand_for_the_bivectors_that_are_shown(shown, drawn, saved, new_page):
    view = {"shown": {name: name in shown.split() for name in ("omega", "momentum")} | {"axial": True}}
    path = saved({"format": 1, "scene": (ROOT / "examples/feynman-plate.toml").read_text(), "view": view})
    page = new_page()
    page.page.add_init_script(WATCH)
    page.open(path)
    page.drawn()
    assert set(page.page.evaluate("window.drawn")) & {"L", "Ω"} == drawn


@pytest.mark.parametrize("known", [True, False])
def test_ratios_of_moments_have_no_units(known, opened):
    mass = "mass = 2\n" if known else ""
    scene = f"[body]\nmoments = [1, 2, 2.5]\n{mass}[initial]\nspin = {{ vector = [1, 2, 3] }}\n"
    page = opened({"format": 1, "scene": scene + "[run]\nduration = 1\n"})
    page.page.locator("#panel-motion").evaluate("panel => panel.open = true")
    page.page.locator(".facts").wait_for()
    text = page.page.locator(".panels").inner_text()
    units = [unit for unit in ("kg m²/s", "J", "kg m²\n") if unit in text]
    assert units == (["kg m²/s", "J", "kg m²\n"] if known else [])


@pytest.mark.parametrize("shown", ["motion", "algebra"])
def test_the_pages_are_in_a_landmark(shown, opened):
    """The panel of a tab has a label, which is content: it is inside the landmark itself."""
    page = opened({"format": 1, "page": shown})
    around = page.page.evaluate(
        f"""() => [...{VIEWER}.shadowRoot.querySelectorAll("main")].map((one) => one.firstElementChild.id)"""
    )
    assert around == ["page"]


def test_many_values_of_the_algebra_page_have_colours_of_their_own(opened):
    """Those of the lesson on mirrors are seven."""
    lines = "\n".join(f"{name} = {k + 1} e1 + e2" for k, name in enumerate("abcdfgh"))
    page = opened({"format": 1, "page": "algebra", "lines": lines})
    names = page.page.locator("li.line pre").evaluate_all(
        "all => all.map(one => getComputedStyle(one.querySelector('[style]')).color)"
    )
    assert len(set(names)) == 7
