"""Time on a page: slider, number field, keys and the clock."""

import numpy as np
import pytest

from polhode._viewer import document as _document
from viewer_page import VIEWER


def test_page_opens_paused_at_the_start(opened, follow):
    page = opened("t-handle")
    assert page.data("time") == 0
    expected = follow("t-handle").scene.state.omega_body.components
    np.testing.assert_allclose(page.data("omega-body"), expected, rtol=0, atol=1e-12)
    assert page.page.get_by_role("button", name="Play").is_visible()


def test_number_field_seeks(opened):
    page = opened("t-handle")
    field = page.page.get_by_label("Time, s")
    field.fill("3.25")
    field.press("Enter")
    assert page.data("time") == 3.25
    assert page.page.get_by_role("slider", name="Time").input_value() == "3.25"


@pytest.mark.slow
@pytest.mark.parametrize(("name", "last"), [("gyroscope", None), ("magnetic", 5)])
def test_number_field_shows_the_current_time(name, last, opened):
    """Entries that are not a time, or lie beyond the known motion, are replaced."""
    page = opened(name)
    field = page.page.get_by_label("Time, s")
    # Twice, because the second entry does not change the time.
    for entry in ("1e300", "1e300", "", "2", "", "1e300"):
        field.fill(entry)
        field.press("Enter")
        page.drawn()
        # With 15 digits.
        assert float(field.input_value()) == pytest.approx(page.data("time"), rel=1e-14)
        assert page.data("time") < 1e16
        assert last is None or page.data("time") == (
            2 if entry in ("2", "") and page.data("time") == 2 else last
        )


def test_empty_field_shows_its_number_again(opened):
    page = opened("gyroscope")
    field = page.page.locator("#rate-number")
    before = field.input_value()
    field.fill("")
    field.press("Enter")
    page.drawn()
    assert field.input_value() == before


def test_slider_covers_the_motion(opened):
    page = opened("t-handle")
    slider = page.page.get_by_role("slider", name="Time", exact=True)
    assert (slider.get_attribute("min"), slider.get_attribute("max")) == ("0", "12")
    slider.fill("7.5")
    assert page.data("time") == 7.5
    box = slider.bounding_box()
    page.page.mouse.click(box["x"] + box["width"] / 3, box["y"] + box["height"] / 2)
    # A third of twelve seconds, up to half the width of the handle.
    assert abs(page.data("time") - 4) < 0.5


def test_exact_motions_continue_after_their_end(opened):
    page = opened("t-handle")
    page.seek(1e6)
    assert page.data("time") == 1e6
    page = opened("magnetic")
    page.seek(1e6)
    assert page.data("time") == 5
    page.seek(-1)
    assert page.data("time") == 0


def test_space_plays_and_arrows_step(opened):
    page = opened("t-handle")
    page.page.keyboard.press("Space")
    page.until("model.time.value > 0")
    assert page.page.get_by_role("button", name="Pause").is_visible()
    page.page.keyboard.press("Space")
    stopped = page.data("time")
    page.drawn()
    assert page.data("time") == stopped
    page.page.keyboard.press("ArrowRight")
    one = page.data("time") - stopped
    assert one > 0
    page.page.keyboard.press("Shift+ArrowRight")
    assert page.data("time") - stopped == pytest.approx(11 * one, rel=1e-9)
    for _ in range(11):
        page.page.keyboard.press("ArrowLeft")
    assert page.data("time") == pytest.approx(stopped, rel=1e-9)
    page.page.keyboard.press("Home")
    assert page.data("time") == 0


def test_arrows_step_wherever_the_focus_is(opened):
    """Also on the picture, which other keys turn."""
    page = opened("t-handle")
    canvas = page.page.locator(".stage canvas").first
    canvas.focus()
    before = view(page)
    page.page.keyboard.press("ArrowRight")
    assert page.data("time") > 0
    page.page.keyboard.press("ArrowLeft")
    assert page.data("time") == pytest.approx(0, abs=1e-12)
    page.seek(3.0)
    page.page.keyboard.press("Home")
    assert page.data("time") == 0
    np.testing.assert_array_equal(view(page), before)


@pytest.mark.parametrize("focus", ["#play", ".stage canvas"])
def test_keys_turn_the_picture(focus, opened):
    page = opened("t-handle")
    page.page.locator(focus).first.focus()
    for one, other in ("jl", "ik", "+-"):
        before = view(page)
        page.page.keyboard.press(one)
        page.drawn()
        turned = view(page)
        assert np.abs(turned - before).max() > 1e-2
        page.page.keyboard.press(other)
        page.drawn()
        np.testing.assert_allclose(view(page), before, rtol=0, atol=1e-9)
    assert page.data("time") == 0


def view(page):
    """Return the place of the camera."""
    return np.array(
        page.page.locator(".stage canvas").first.get_attribute("data-camera").split(), dtype=float
    )


# The time scale to be seen, from the scene or the summary of its motion, and in how many seconds it plays.
SLOW = {
    # A precession about L of 304 days, of 400.
    "earth": (304.4 * 86_400, 4, 16),
    # A precession of 7 s while the wheel makes 100 turns a second.
    "gyroscope": (13.0, 5, 60),
    "t-handle": (12.0, 5, 90),
    "gravity-gradient": (86_400.0, 10, 60),
    "toutatis": (60 * 86_400.0, 10, 90),
}


@pytest.mark.parametrize("name", SLOW)
def test_default_speed_shows_what_is_slow(name, opened, follow):
    followed = follow(name)
    files = {} if followed.mesh is None else {"files": _document.of_scene(followed.scene)["files"]}
    page = opened({"format": 1, "scene": followed.text, **files})
    slow, least, most = SLOW[name]
    speed = page.page.evaluate(f"async () => (await {VIEWER}.ready).speed.value")
    assert least < slow / speed < most


def test_speed_can_be_typed(opened):
    page = opened("t-handle")
    field = page.page.get_by_label("Speed, seconds of motion per second")
    for entry, speed, shown, unit in (
        ("0.37", 0.37, "0.37", "×"),
        ("-2", -2, "-2", "×"),
        ("1e300", 1e15, "31700000", "yr/s"),
    ):
        field.fill(entry)
        field.press("Enter")
        page.until("model.speed.value === speed", speed=speed)
        page.drawn()
        assert page.page.locator("#speed").input_value() == shown
        assert page.page.locator(".speed .unit").inner_text() == unit
    page.page.get_by_role("button", name="Slower").click()
    page.until("model.speed.value === 5e14")


@pytest.mark.slow
def test_playback_has_the_shown_speed(saved, new_page):
    path = saved("t-handle")
    page = new_page()
    # A clock that only the test advances.
    page.page.clock.install()
    page.open(path)
    page.page.get_by_role("button", name="Faster").click()
    speed = float(page.page.locator("#speed").input_value())
    page.page.get_by_role("button", name="Play").click()
    page.until("model.time.value > 0")
    page.page.clock.pause_at(page.page.evaluate("Date.now() + 1000"))
    before = page.data("time")
    page.page.clock.run_for(1000)
    # Up to the first frame and the last one.
    assert page.data("time") - before == pytest.approx(speed, abs=2 * speed / 60)


def test_ready_page_has_its_picture(new_page, saved):
    """On a busy machine, frames come late, and so does what is created after the first one."""
    path = saved("t-handle")
    page = new_page()
    page.page.add_init_script(
        """const [later, soon] = [setTimeout, requestAnimationFrame];
        window.setTimeout = (act, wait) => later(act, wait > 20 ? wait + 500 : wait);
        window.requestAnimationFrame = (act) => later(() => soon(act), 500);"""
    )
    page.open(path)
    assert "canvas#" in page.page.evaluate(CONTROLS)


@pytest.mark.parametrize("name", ["t-handle", "magnetic"])
def test_tab_reaches_all_controls(name, opened):
    page = opened(name)
    page.drawn()
    page.page.bring_to_front()
    page.page.evaluate("document.activeElement.blur()")
    controls = page.page.evaluate(CONTROLS)
    reached = []
    for _ in controls:
        page.page.evaluate(f"window.left = {FOCUSED_ELEMENT}")
        page.page.keyboard.press("Tab")
        # On a busy machine, the focus moves after the key event has been answered.
        page.until(f"![window.left, document.body].includes({FOCUSED_ELEMENT})")
        reached.append(page.page.evaluate(FOCUSED))
    assert [control for control, _ in reached] == controls
    assert [control for control, marked in reached if not marked] == []


# The focused element, through shadow roots.
FOCUSED_ELEMENT = """(() => {
    let element = document.activeElement;
    while (element.shadowRoot?.activeElement) element = element.shadowRoot.activeElement;
    return element;
})()"""
# Its tag and id, and whether the focus is visible.
FOCUSED = f"""() => {{
    const element = {FOCUSED_ELEMENT};
    const {{ outlineStyle, outlineWidth, boxShadow }} = getComputedStyle(element);
    const marked = (outlineStyle !== "none" && outlineWidth !== "0px") || boxShadow !== "none";
    return [`${{element.localName}}#${{element.id}}`, marked];
}}"""
CONTROLS = """() => {
    const root = document.querySelector("polhode-viewer").shadowRoot;
    const wanted = "button, input, select, textarea, summary, a[href], [tabindex]";
    return [...root.querySelectorAll(wanted)]
        .filter((control) => !control.disabled && control.checkVisibility() && control.tabIndex >= 0)
        .map((control) => `${control.localName}#${control.id}`);
}"""
