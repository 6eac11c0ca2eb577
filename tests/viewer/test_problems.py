"""Error messages of a page."""

import pytest

import polhode as ph
from viewer_scenes import RUN, TUMBLING

WRONG = (TUMBLING + RUN).replace("duration", "durration")


def message_of(page):
    """Return the alert of the page."""
    alert = page.page.get_by_role("alert")
    alert.wait_for()
    return alert.inner_text()


def message_of_python(text, path):
    path.write_text(text)
    with pytest.raises(ph.SceneError) as error:
        ph.Scene.read(path)
    return str(error.value).replace(str(path), path.name)


def test_scene_error_has_its_place(opened, tmp_path):
    page = opened({"format": 1, "scene": WRONG, "name": "wrong.toml"})
    expected = message_of_python(WRONG, tmp_path / "wrong.toml")
    assert "wrong.toml:6:1: error" in expected
    assert "^^^^" in expected
    assert expected in message_of(page)
    assert page.viewer.get_attribute("data-state") == "problem"
    # Once, also beside the editor, which names it as its description.
    page.page.locator("#panel-text").evaluate("panel => panel.open = true")
    area = page.page.get_by_label("Scene, in TOML")
    assert page.page.get_by_text("wrong.toml:6:1: error").count() == 1
    assert area.get_attribute("aria-invalid") == "true"
    assert area.get_attribute("aria-describedby") == "problem"


def test_wrong_file_keeps_the_motion_and_right_file_ends_the_message(opened, tmp_path):
    page = opened("asymmetric")
    page.seek(2.0)
    before = page.state()
    # Written before the page opens the file, because a browser refuses a file that changes while it is read.
    expected = message_of_python(WRONG, tmp_path / "wrong.toml")
    page.page.locator("#file").set_input_files(tmp_path / "wrong.toml")
    assert expected in message_of(page)
    after = page.state()
    assert all((before[name] == after[name]).all() for name in ("rotor", "omega_body"))
    (tmp_path / "right.toml").write_text(TUMBLING + RUN)
    page.page.locator("#file").set_input_files(tmp_path / "right.toml")
    page.page.get_by_role("alert").wait_for(state="detached")
    assert page.viewer.get_attribute("data-state") == "ready"


def drop(page, **given):
    """Drop files, whose names have `__` for a dot, and wait for two frames."""
    page.page.evaluate(
        """given => {
            const files = new DataTransfer();
            for (const [name, text] of Object.entries(given))
                files.items.add(new File([text], name.replace("__", ".")));
            const place = document.querySelector("polhode-viewer").shadowRoot.querySelector(".app");
            const options = { dataTransfer: files, bubbles: true, cancelable: true };
            place.dispatchEvent(new DragEvent("drop", options));
        }""",
        given,
    )
    page.drawn()


def test_files_can_be_dropped(opened):
    page = opened("asymmetric")
    drop(page, dropped__toml=WRONG)
    assert "dropped.toml:6:1: error" in message_of(page)


def test_file_errors_name_the_file(opened):
    """The message replaces that of the previous error."""
    page = opened("asymmetric")
    drop(page, wrong__toml=WRONG)
    assert "wrong.toml:6:1: error" in message_of(page)
    right = TUMBLING + RUN
    for given, message in (
        ({"notes__txt": "a"}, "notes.txt: the page opens scenes (.toml), documents (.json) and meshes"),
        ({"run__nc": "a"}, "`polhode view` shows netCDF files"),
        ({"part__stl": "solid"}, "part.stl: wrong.toml does not refer to this file"),
        ({"a__json": "{"}, "a.json is not JSON"),
        ({"b__json": "null"}, "b.json is not a viewer document"),
        ({"b__json": "{}"}, "b.json is not a viewer document"),
        ({"c__json": '{"format": 7}'}, "c.json: this page reads documents of format 1, not 7"),
        ({"d__toml": right, "e__toml": right}, "d.toml, e.toml: the page shows one scene at a time"),
    ):
        drop(page, **given)
        page.until("model.problem.value.includes(message)", message=message)
        assert message in message_of(page)
        assert "wrong.toml:6" not in message_of(page)
    drop(page, right__toml=right)
    page.page.get_by_role("alert").wait_for(state="detached")


def test_file_error_can_be_closed(opened):
    page = opened("asymmetric")
    page.seek(2.0)
    drop(page, notes__txt="a")
    assert "notes.txt" in message_of(page)
    page.page.get_by_role("button", name="Close").click()
    page.page.get_by_role("alert").wait_for(state="detached")
    assert page.data("time") == 2.0


def test_mesh_that_does_not_fix_its_scene(opened):
    page = opened("asymmetric")
    scene = (TUMBLING + RUN).replace("moments = [1, 2, 3]", 'mesh = "a.stl"\ndensity = 1')
    drop(page, meshed__toml=scene)
    assert "a.stl" in message_of(page)
    drop(page, a__stl="solid")
    page.until("model.problem.value.startsWith('a.stl: was added')")
    expected = "a.stl: was added to meshed.toml, which is still invalid:\nmeshed.toml:2:8: error"
    assert expected in message_of(page)


@pytest.mark.parametrize(
    ("document", "message"),
    [
        ({"format": 2, "scene": TUMBLING + RUN}, "format 1, not 2"),
        (
            {
                "format": 1,
                "scene": TUMBLING.replace("moments = [1, 2, 3]", 'mesh = "a.stl"\ndensity = 1') + RUN,
            },
            "a.stl",
        ),
        ({"format": 1, "scene": "[body", "name": "half.toml"}, "half.toml:1:6: error"),
    ],
    ids=["format", "mesh", "toml"],
)
def test_invalid_documents_are_errors(document, message, opened):
    assert message in message_of(opened(document))


def test_text_that_is_not_a_document(new_page, saved):
    path = saved("asymmetric")
    head, _, tail = path.read_text().partition('{"format"')
    path.write_text(head + '{"formt' + tail)
    page = new_page()
    page.open(path)
    assert "not JSON" in message_of(page)


@pytest.mark.slow
def test_motion_that_takes_too_long_is_an_error(opened):
    slow = (
        TUMBLING
        + '[torque]\nquadratic_damping = 0.1\n[run]\nduration = "9 d"\n[method]\nname = "rk4"\nstep = "1 ms"'
    )
    page = opened({"format": 1, "scene": slow})
    assert "takes too long" in message_of(page)


def test_without_webgl_values_are_shown(new_page, saved, follow):
    path = saved("t-handle")
    page = new_page()
    page.page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    page.open(path)
    assert page.page.get_by_text("WebGL 2 is missing or switched off").is_visible()
    page.compare(follow("t-handle"))
    page.page.keyboard.press("Space")
    page.until("model.time.value !== time", time=page.data("time"))


def test_lost_graphics_context_is_restored(opened, follow):
    page = opened("t-handle")
    page.allowed = ("THREE.WebGLRenderer: Context",)
    page.page.evaluate(
        """() => {
            const canvas = document.querySelector("polhode-viewer").shadowRoot.querySelector("canvas");
            window.loss = canvas.getContext("webgl2").getExtension("WEBGL_lose_context");
            window.loss.loseContext();
        }"""
    )
    message = page.page.get_by_role("status").get_by_text("graphics context was lost")
    message.wait_for()
    page.compare(follow("t-handle"))
    page.page.evaluate("window.loss.restoreContext()")
    message.wait_for(state="hidden")
