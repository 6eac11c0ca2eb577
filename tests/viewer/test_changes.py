"""Controls change the scene of a page, and its motion equals that of Python for the changed scene."""

import tomllib
from pathlib import Path

import pytest

import polhode as ph
from polhode._viewer import document
from viewer_page import VIEWER
from viewer_scenes import FILES, PRESETS, followed_text

BOX = """\
title = "Box"
[body]
solid = "box"
lengths = ["10 cm", "5 cm", "2 cm"]
mass = "1 kg"
[initial]
spin = { vector = ["0.1 rev/s", "2 rev/s", 0] }
[run]
duration = "4 s"
samples = 401
"""


@pytest.fixture
def box(opened):
    """A page with a rotating box and open panels."""
    page = opened({"format": 1, "scene": BOX, "name": "box.toml"})
    for panel in ("start", "body", "laws"):
        details = page.page.locator(f"#panel-{panel}")
        if details.get_attribute("open") is None:
            details.locator("summary").click()
    return page


def type_in(page, field, text):
    page.page.locator(f"#{field}-number").fill(text)
    page.page.locator(f"#{field}-number").press("Enter")


def choose_law(page, law):
    page.page.get_by_label("Torques", exact=True).select_option("here")
    page.page.locator(f"#law-{law}").check()


CHANGES = {
    "a side, typed": lambda page: type_in(page, "size-lengths-0", "30"),
    "a side, by keys": lambda page: page.page.locator("#size-lengths-1").press("ArrowRight"),
    "the mass": lambda page: type_in(page, "mass", "2.5"),
    "the rate, typed": lambda page: type_in(page, "rate", "3"),
    "the rate, by keys": lambda page: page.page.locator("#rate").press("PageDown"),
    "the off-axis angle": lambda page: type_in(page, "off", "1"),
    "the attitude": lambda page: type_in(page, "tilt", "40"),
    "the duration": lambda page: type_in(page, "duration", "7"),
    "another form": lambda page: page.page.get_by_label("Form").select_option("cone"),
    "damping": lambda page: choose_law(page, "viscous_damping"),
    "a constant torque": lambda page: choose_law(page, "constant_body"),
}


@pytest.mark.parametrize(
    "change",
    [name if k % 2 else pytest.param(name, marks=pytest.mark.slow) for k, name in enumerate(CHANGES)],
)
def test_motion_equals_that_of_the_changed_scene(change, box, tmp_path):
    CHANGES[change](box)
    box.until("model.scene.value !== before", before=BOX)
    assert box.viewer.get_attribute("data-state") == "ready"
    followed = followed_text(box.scene(), tmp_path / "changed.toml")
    assert box.viewer.get_attribute("data-method") == followed.motion.certificate.method
    box.compare(followed)


def test_typed_numbers_are_in_the_scene(box, tmp_path):
    type_in(box, "size-lengths-0", "30")
    type_in(box, "mass", "2.5")
    box.until("model.about.value.body.mass === 2.5")
    path = tmp_path / "changed.toml"
    path.write_text(box.scene())
    body = ph.Scene.read(path).body
    expected = ph.Body.box([0.3, 0.05, 0.02], mass=2.5)
    assert body.mass == 2.5
    assert body.inertia.principal_moments == pytest.approx(expected.inertia.principal_moments, rel=1e-12)


def test_angles_end_where_their_range_does(box):
    """An angle off an axis beyond 90 degrees is one from another axis."""
    for name, entry, taken in (("off", "500", "90"), ("off", "-1", "0"), ("tilt", "500", "180")):
        type_in(box, name, entry)
        box.drawn()
        assert box.page.locator(f"#{name}-number").input_value() == taken
    # An azimuth is one of many that differ by turns.
    type_in(box, "turn", "500")
    box.drawn()
    assert box.page.locator("#turn-number").input_value() == "500"


def test_changes_keep_the_time(box):
    box.seek(1.5)
    box.page.locator("#rate").press("ArrowRight")
    box.until("model.scene.value !== before", before=BOX)
    assert box.data("time") == 1.5


def test_scene_text_can_be_edited(box, tmp_path):
    box.page.locator("#panel-text summary").click()
    area = box.page.get_by_label("Scene, in TOML")
    area.fill(area.input_value().replace("5 cm", "6 cm"))
    box.page.get_by_role("button", name="Apply").click()
    box.compare(followed_text(BOX.replace("5 cm", "6 cm"), tmp_path / "box.toml"))
    box.page.get_by_role("button", name="Reset").click()
    box.compare(followed_text(BOX, tmp_path / "box.toml"))


def test_local_files_can_be_opened(box, follow):
    followed = follow("t-handle")
    box.page.locator("#file").set_input_files([followed.path, followed.mesh])
    box.page.get_by_role("heading", name="T-handle in free flight").wait_for()
    # The name of the window follows.
    box.until("document.title === 'T-handle in free flight'")
    box.compare(followed)


@pytest.mark.slow
def test_presets_can_be_opened(opened):
    page = opened("asymmetric")
    entries = page.page.locator("[data-scene]")
    names = entries.evaluate_all("entries => entries.map((entry) => entry.dataset.scene)")
    # All examples are among the scenes, each once; what is not an example has a file of its own.
    files = FILES | PRESETS
    assert len(files) == len(FILES) + len(PRESETS)
    assert sorted(names) == sorted(f"{stem}.toml" for stem in files)
    for name in names:
        page.page.locator("#scenes").click()
        page.page.locator(f"[data-scene='{name}']").click()
        path = files[Path(name).stem]
        page.until("model.scene.value === text", text=path.read_text())
        page.page.locator("dialog.gallery").wait_for(state="hidden")
        assert page.viewer.get_attribute("data-state") == "ready"
        caption = tomllib.loads(path.read_text())["caption"]
        shown = page.page.locator(".caption").inner_text()
        assert shown.startswith(" ".join(caption.split()))
        if name == "sleeping.toml":
            assert page.viewer.get_attribute("data-regime") == "sleeping, nearly upright"


def test_list_of_scenes_says_what_each_shows(opened):
    """With a title and the first sentence of its caption, in groups; the open one is marked."""
    page = opened({"format": 1})
    page.page.locator("#scenes").click()
    entry = page.page.locator("[data-scene='t-handle.toml']")
    assert entry.get_attribute("aria-current") == "true"
    assert entry.locator("strong").inner_text() == "T-handle in free flight"
    assert entry.locator(".note").inner_text().startswith("A T-handle spun about its stem")
    about = page.page.locator("[data-scene] .note").all_inner_texts()
    assert all(text.endswith((".", "?")) and 20 < len(text) < 240 for text in about)
    assert page.page.locator(".gallery h3").count() >= 3
    page.page.keyboard.press("Escape")
    page.page.locator("dialog.gallery").wait_for(state="hidden")
    assert page.page.evaluate(f"{VIEWER}.shadowRoot.activeElement.id") == "scenes"


def test_recorded_motions_are_shown_at_their_times(opened, follow):
    followed = follow("magnetic")
    page = opened(document.of_trajectory(followed.motion))
    page.compare(followed)


def test_small_parameters_fit_into_their_fields(box):
    """A law shows its formula, with the letters of its parameters; small numbers are powers of ten."""
    box.page.locator("#laws").select_option("here")
    box.page.locator("#law-viscous_damping").check()
    assert "T = -d(Ω)" in box.page.locator("#panel-laws").inner_text()
    type_in(box, "viscous-damping-value", "0.00001234")
    box.until("model.scene.value.includes('0.00001234') || model.scene.value.includes('1.234e-5')")
    field = box.page.locator("#viscous-damping-value-number")
    assert field.input_value() == "1.234e-5"
    assert field.evaluate("field => field.scrollWidth <= field.clientWidth")
