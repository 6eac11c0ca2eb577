"""Sharing: the address that holds what a page shows, pictures, and pages that save themselves."""

import io
import json
import re
from urllib.parse import unquote

import numpy as np
import pytest

from polhode._viewer import html
from viewer_page import VIEWER
from viewer_scenes import RUN, TUMBLING, followed_text

SCENE = {"format": 1, "scene": TUMBLING + RUN, "name": "tumbling.toml"}
MODEL = f"await {VIEWER}.ready"


def fields(page):
    """Return the fields of the address by name."""
    fragment = page.page.evaluate("location.hash.slice(1)")
    return dict(field.split("=", 1) for field in unquote(fragment).split("&") if field)


def written(shown, **expected):
    """Wait until the address has these fields, and return all of them."""
    texts = [f"{name}={value}" for name, value in expected.items()]
    shown.until("fields.every(field => location.hash.slice(1).split('&').includes(field))", fields=texts)
    return fields(shown)


def look(page, **view):
    page.page.evaluate(f"async view => ({MODEL}).look(view)", view)


def view(page):
    return page.page.evaluate(
        f"""async () => {{
            const {{ time, speed, playing, camera, pose, theme, shown, page, scene, lines }} = {MODEL};
            const signals = {{ time, speed, playing, camera, pose, theme, shown, page, scene, lines }};
            return Object.fromEntries(Object.entries(signals).map(([name, {{ value }}]) => [name, value]));
        }}"""
    )


def again(page, new_page):
    """Open the address of a page in a browser that has not seen it."""
    other = new_page()
    other.page.goto(page.page.url)
    other.settled()
    return other


def share(page, button):
    page.page.locator("#share").click()
    page.page.locator(button).click()


def test_address_restores_what_is_shown(opened, new_page):
    page = opened(SCENE)
    assert fields(page) == {}
    page.page.evaluate(f"async () => ({MODEL}).change('[body]\\nmoments = [1, 2, 2.5]\\n')")
    page.until("!model.solving.value")
    shown = {"omega": False, "poinsot": True}
    look(page, time=1.25, speed=0.3, camera="along L", theme="dark", shown=shown)
    page.drawn()
    page.page.locator(".stage canvas").first.focus()
    page.page.keyboard.press("l")
    expected = {"t": "1.25", "camera": "along+L", "theme": "dark", "show": "poinsot", "hide": "omega"}
    page.until("location.hash.includes('view=')")
    found = written(page, **expected)
    assert "scene" not in found  # it is in the page itself
    other = again(page, new_page)
    before, after = view(page), view(other)
    np.testing.assert_allclose(after.pop("pose"), before.pop("pose"), rtol=1e-4)
    assert after == before
    assert "2.5" in after["scene"]
    np.testing.assert_allclose(other.data("rotor"), page.data("rotor"), rtol=0, atol=0)


def test_address_is_written_seldom_and_not_while_the_time_runs(opened):
    page = opened(SCENE, reduced_motion="no-preference")
    page.page.evaluate("""() => {
        window.writes = 0;
        const { replaceState, pushState } = History.prototype;
        History.prototype.replaceState = function (...given) {
            window.writes += 1;
            return replaceState.apply(this, given);
        };
        History.prototype.pushState = () => { window.writes = NaN; };
    }""")
    assert page.page.evaluate("history.length") == 2
    page.until("model.playing.value && model.time.value > 1")
    assert fields(page) == {}
    # Many changes, one after the other, are written once.
    page.page.evaluate(
        f"""async () => {{
            const model = {MODEL};
            model.look({{ playing: true, speed: 0.01 }});
            for (let k = 0; k < 20; k++) model.toggle("omega");
            model.toggle("omega");
        }}"""
    )
    written(page, play="1", hide="omega")
    writes = page.page.evaluate("window.writes")
    assert writes == 1
    time = page.data("time")
    page.until("model.time.value > time + 0.02", time=time)
    assert page.page.evaluate("window.writes") == writes
    look(page, playing=False)
    found = written(page, play="0")
    assert float(found["t"]) == page.data("time")
    assert page.page.evaluate("history.length") == 2


def test_address_names_scenes_of_the_viewer(opened, new_page):
    page = opened({"format": 1})
    page.page.locator("#scenes").click()
    page.page.locator("[data-scene='racket.toml']").click()
    assert "text" not in written(page, scene="racket")
    page.page.evaluate(f"async () => ({MODEL}).change('[initial]\\nspin = {{ vector = [1, 2, 3] }}\\n')")
    page.until("!model.solving.value && location.hash.includes('text=')")
    other = again(page, new_page)
    assert other.scene() == page.scene()
    # Reset returns to the preset.
    other.page.evaluate(f"async () => ({MODEL}).reset()")
    other.until("!model.solving.value")
    assert "1, 2, 3" not in other.scene()


def test_address_holds_a_dropped_scene(opened, new_page):
    page = opened({"format": 1})
    text = TUMBLING.replace("[1, 2, 3]", "[1, 2, 2.75]") + RUN
    page.page.locator("#file").set_input_files(
        {"name": "mine.toml", "mimeType": "text/plain", "buffer": text.encode()}
    )
    page.until("location.hash.includes('document=')")
    assert again(page, new_page).scene() == text


def test_address_holds_the_step_of_a_lesson(opened, new_page):
    page = opened({"format": 1})
    page.page.locator('[data-lesson="why-l-stays-and-omega-wanders"]').click()
    page.page.locator("#lesson-next").click()
    written(page, lesson="why-l-stays-and-omega-wanders", step="2")
    page.until("!model.solving.value")
    look(page, time=0.75, shown={"labels": False})
    written(page, step="2", t="0.75")
    other = again(page, new_page)
    other.until("model.time.value === 0.75")
    assert other.page.locator(".lesson").get_attribute("data-step") == "2"
    assert view(other) == view(page)


def test_address_holds_the_algebra_page(opened, new_page):
    page = opened({"format": 1, "page": "algebra"})
    page.page.locator("#figure").select_option("projection")
    written(page, page="algebra", figure="projection")
    page.page.get_by_label("Line 1", exact=True).fill("a = 2 e1 + 1 e2 + 1.2 e3")
    page.until("location.hash.includes('lines=')")
    other = again(page, new_page)
    assert view(other)["lines"] == view(page)["lines"]
    assert other.page.locator("#tab-algebra").get_attribute("aria-selected") == "true"


@pytest.mark.parametrize(
    ("fragment", "message"),
    [
        ("v=1&t=soon", "t: `soon` is not a number"),
        ("v=1&scene=nowhere", "scene: there is no scene `nowhere` in this page"),
        ("v=1&lesson=nowhere", "lesson: there is no lesson `nowhere` in this page"),
        ("v=1&camera=above", "camera: `above` is not one of oblique, along e1"),
        ("v=1&show=body,tail", "show: `tail` is not one of body, bodyFrame"),
        ("v=1&view=1,2", "view: `1,2` must be two angles in degrees and a nearness above 0"),
        ("v=1&text=AAAA", "text is damaged: the address may have been cut off"),
        ("v=1&step=0", "step: `0` is not a whole number from 1 on"),
        ("v=1&colour=red", "unknown field `colour`"),
        ("v=1&t", "`t` is not of the form `name=value`"),
        ("v=1&figure=%E0", "figure: `%E0` is damaged"),
        ("v=2&t=1", "its format is `v=2`, this page reads `v=1`"),
        ("nonsense", "it must begin with `v=1`, got `nonsense`"),
    ],
)
def test_malformed_address_is_reported_and_the_page_shown(fragment, message, new_page, saved):
    path = saved(SCENE)
    page = new_page()
    page.page.goto(f"{path.as_uri()}#{fragment}")
    page.settled()
    alert = page.page.get_by_role("alert").inner_text()
    assert f"the part of the address after # was ignored: {message}" in alert
    assert page.scene() == SCENE["scene"]
    assert page.data("time") == 0


def test_changed_scene_wins_over_an_older_address(opened, new_page, tmp_path):
    page = opened(SCENE)
    page.page.evaluate(f"async () => ({MODEL}).change('[body]\\nmoments = [1, 2, 2.5]\\n')")
    page.until("location.hash.includes('text=')")
    path = next(tmp_path.glob("*.html"))
    text = SCENE["scene"].replace("[1, 2, 3]", "[1, 2, 2.9]")
    path.write_text(html.page({**SCENE, "scene": text}))
    other = again(page, new_page)
    assert other.scene() == text
    assert "another version of the scene" in other.page.get_by_role("alert").inner_text()


def test_another_address_is_shown_at_once(opened):
    page = opened(SCENE)
    page.page.evaluate("location.hash = 'v=1&t=2.5&play=0&camera=along+e3'")
    page.until("model.time.value === 2.5 && model.camera.value === 'along e3'")
    page.page.evaluate("location.hash = 'v=1&t=later'")
    page.until("model.problem.value !== null")
    assert page.data("time") == 2.5


def test_address_is_copied_and_confirmed(opened):
    page = opened(SCENE)
    page.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    share(page, "#copy-address")
    page.page.locator(".said", has_text="Address copied").wait_for()
    assert page.page.locator(".said").get_attribute("aria-live") == "polite"
    copied = page.page.evaluate("navigator.clipboard.readText()")
    assert re.fullmatch(r"file://.*\.html#v=1&t=0&speed=.*", copied)


def test_address_is_shown_where_the_clipboard_is_not_available(opened):
    page = opened(SCENE)
    page.page.evaluate("Object.defineProperty(navigator, 'clipboard', { value: undefined })")
    share(page, "#copy-address")
    page.page.locator(".said.failed", has_text="The clipboard is not available").wait_for()
    assert "#v=1&t=0" in page.page.locator("#address").input_value()


def test_scene_that_is_too_large_for_an_address_is_reported(opened):
    noise = np.random.default_rng(1).integers(33, 126, 40_000, dtype=np.uint8).tobytes().decode()
    text = TUMBLING + RUN + f"# {noise}\n"
    page = opened({"format": 1})
    page.page.locator("#file").set_input_files(
        {"name": "large.toml", "mimeType": "text/plain", "buffer": text.encode()}
    )
    page.until("model.scene.value?.includes('# ')")
    share(page, "#copy-address")
    page.page.locator(".said.failed", has_text="too large for an address").wait_for()


def test_picture_is_saved_at_twice_its_size_with_its_texts(opened, tmp_path):
    image = pytest.importorskip("PIL.Image")
    page = opened({**SCENE, "caption": "A body tumbles. " * 20})
    box = page.page.locator(".seen").bounding_box()
    with page.page.expect_download() as saved:
        share(page, "#save-picture")
    assert saved.value.suggested_filename == "tumbling.png"
    saved.value.save_as(tmp_path / "picture.png")
    picture = image.open(io.BytesIO((tmp_path / "picture.png").read_bytes()))
    assert picture.width == 2 * round(box["width"])
    # A title of one line above, and the lines of the caption below.
    assert picture.height > 2 * (box["height"] + 100)
    assert len(picture.convert("RGB").getcolors(1 << 24)) > 100
    page.page.locator(".said", has_text="Picture saved as tumbling.png").wait_for()
    # The page looks as before.
    assert page.page.locator(".stage canvas").first.evaluate("one => one.width") == round(box["width"])


def test_page_saves_itself(opened, new_page, tmp_path):
    page = opened(SCENE)
    page.page.evaluate(f"async () => ({MODEL}).change('[body]\\nmoments = [1, 2, 2.5]\\n')")
    page.until("!model.solving.value")
    look(page, time=2.0, camera="along e1", shown={"momentum": False})
    with page.page.expect_download() as saved:
        share(page, "#save-page")
    saved.value.save_as(tmp_path / "saved.html")
    other = new_page()
    other.open(tmp_path / "saved.html")
    assert view(other) == view(page)
    other.compare(followed_text(page.scene(), tmp_path / "saved.toml"))
    # Once more, from the saved page: the same script under the same policy.
    with other.page.expect_download() as saved:
        share(other, "#save-page")
    saved.value.save_as(tmp_path / "again.html")
    first, second = ((tmp_path / name).read_text() for name in ("saved.html", "again.html"))
    head = re.compile(r"<head>.*?</head>", re.DOTALL)
    assert head.search(first)[0] == head.search(second)[0]
    data = re.search(r'<script type="application/json">(.*?)</script>', second)[1]
    assert json.loads(data)["scene"] == page.scene()


def test_saved_page_is_that_of_python(opened, tmp_path):
    """Both fill the same template with the same script; only the document differs."""
    page = opened(SCENE)
    with page.page.expect_download() as saved:
        share(page, "#save-page")
    saved.value.save_as(tmp_path / "saved.html")

    def frame(text):
        title = re.sub("<title>.*</title>", "", text)
        return re.sub('<script type="application/json">.*?</script>', "", title)

    assert frame((tmp_path / "saved.html").read_text()) == frame(html.page(SCENE))


def test_saved_page_of_a_lesson_opens_at_its_step(opened, new_page, tmp_path):
    page = opened({"format": 1})
    page.page.locator('[data-lesson="why-l-stays-and-omega-wanders"]').click()
    page.page.locator("#lesson-next").click()
    page.until("!model.solving.value && model.motion.value")
    look(page, time=0.5)
    with page.page.expect_download() as saved:
        share(page, "#save-page")
    saved.value.save_as(tmp_path / "saved.html")
    other = new_page()
    other.open(tmp_path / "saved.html")
    other.until("model.time.value === 0.5")
    assert other.page.locator(".lesson").get_attribute("data-step") == "2"


def test_several_viewers_leave_the_address_alone(saved, new_page):
    path = saved(SCENE)
    path.write_text(
        path.read_text().replace("</polhode-viewer>", "</polhode-viewer><polhode-viewer></polhode-viewer>", 1)
    )
    page = new_page()
    page.page.goto(path.as_uri() + "#v=1&t=2")
    page.until("model?.motion.value")
    viewer = page.page.locator("polhode-viewer").first
    viewer.locator("#share").click()
    assert viewer.locator("#save-page").is_visible()
    assert viewer.locator("#copy-address").count() == 0
    assert viewer.get_attribute("data-time") == "0"
