"""Hands on the body: what they change is exact, goes on from the present time, and can be undone."""

import re

import numpy as np
import pytest

import polhode as ph
from polhode._viewer import document
from viewer_page import VIEWER
from viewer_scenes import RUN, SCENES, TUMBLING, followed_text

# Rounding of a few products, sums and roots of numbers of size 1; states from closed forms have about 1e-14.
ROUNDING = 1e-12

BOX = """\
[body]
solid = "box"
lengths = ["10 cm", "5 cm", "2 cm"]
mass = "1 kg"
[initial]
spin = { vector = ["0.1 rev/s", "2 rev/s", "0.2 rev/s"] }
[run]
duration = "4 s"
samples = 401
"""
TIME = 1.5


def slow(value):
    """A further variant, for the slow tests."""
    return pytest.param(value, marks=pytest.mark.slow)


def scene_of(name):
    return SCENES.get(name, BOX)


@pytest.fixture
def hands(opened):
    """Opens a page with a scene at a time within its motion, with the energy ellipsoid beside."""

    def opened_at(scene=BOX, **view):
        page = opened(
            {"format": 1, "scene": scene, "view": {"shown": {"energy": True}, "time": TIME, **view}}
        )
        page.drawn()
        return page

    return opened_at


def settle(page):
    page.drawn()
    page.until("!model.solving.value")
    page.drawn()


def press(page, grip, *keys):
    """Move a grip by keys, one after the other."""
    page.page.locator(f"#{grip}").focus()
    for key in keys:
        page.page.keyboard.press(key)
        settle(page)


def drag(page, selector, across, up, steps=6):
    """Drag the middle of an element by some pixels."""
    page.page.locator(selector).scroll_into_view_if_needed()
    box = page.page.locator(selector).bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.page.mouse.move(x, y)
    page.page.mouse.down()
    for k in range(1, steps + 1):
        page.page.mouse.move(x + across * k / steps, y - up * k / steps)
    page.page.mouse.up()
    settle(page)


def direction(canvas):
    """Return the direction of the camera; its distance follows the size of the picture."""
    place = np.array(canvas.get_attribute("data-camera").split(), dtype=float)
    return place / np.linalg.norm(place)


def assert_same(a, b, scale=None, tolerance=ROUNDING):
    scale = np.linalg.norm(b) if scale is None else scale
    np.testing.assert_allclose(a, b, rtol=0, atol=tolerance * scale)


def assert_follows(page, tmp_path):
    """Assert that the page shows the motion that Python gives for its scene, from the change on."""
    followed = followed_text(page.scene(), tmp_path / "changed.toml")
    assert followed.motion.time[0] == TIME
    page.compare(followed)


@pytest.mark.parametrize("name", ["box", "full inertia", "gyrostat", "lagrange", "gravity gradient"])
def test_impulse_equals_that_of_python(name, core, tmp_path):
    """L changes by r∧J, and Ω by the inverse inertia of that in the body."""
    text = scene_of(name)
    at, impulse = [0.3, -0.2, 0.5], [0.1, 0.4, -0.2]
    found = core.ask("pushed", scene=text, time=TIME, at=at, impulse=impulse)
    row = np.array(found["row"])
    added = ph.vector(at) ^ ph.vector(impulse)
    assert_same(found["momentum"], added.components)
    # About the fixed point if there is one, as L is.
    inertia = followed_text(text, tmp_path / "scene.toml").motion.inertia
    rotor, before = ph.Rotor.from_components(row[1:5]), ph.bivector(row[5:8])
    after = before + inertia.inverse((~rotor)(added))
    assert_same(found["omega"], after.components)
    kinetic = [0.5 * omega.components @ inertia(omega).components for omega in (before, after)]
    assert found["energy"] == pytest.approx(kinetic[1] - kinetic[0], abs=ROUNDING * max(kinetic))


@pytest.mark.parametrize("name", ["damping", *(slow(name) for name in ("box", "lagrange"))])
def test_push_by_keys(name, hands, tmp_path):
    """The attitude stays, L changes as reported, and the motion goes on from the instant of the push."""
    page = hands(scene_of(name))
    before = page.state()
    page.page.locator("#push").click()
    page.drawn()
    press(page, "grip-push", "ArrowUp", "ArrowUp", "Shift+ArrowRight", "Alt+ArrowLeft")
    predicted = page.page.locator("#hands-report").inner_text()
    press(page, "grip-push", "Enter")
    after = page.state()
    assert after["time"] == TIME
    assert_same(after["rotor"], before["rotor"])
    change = np.linalg.norm(after["momentum_space"] - before["momentum_space"])
    reported = page.page.locator("#hands-report").inner_text()
    share = 100 * change / np.linalg.norm(before["momentum_space"])
    assert share > 1
    for text in (predicted, reported):
        # Three digits.
        assert float(re.search(r"([\d.]+) %", text)[1]) == pytest.approx(share, rel=5e-3)
    assert_follows(page, tmp_path)


def test_push_by_the_pointer(hands, tmp_path):
    """Where the pointer presses on the body it draws an arrow; beside the body it turns the camera."""
    page = hands()
    page.page.locator("#push").click()
    canvas = page.page.locator(".stage canvas").first
    camera, before = direction(canvas), page.state()
    drag(page, ".stage", 60, 90)
    after = page.state()
    assert direction(canvas) == pytest.approx(camera, rel=1e-12)
    assert_same(after["rotor"], before["rotor"])
    assert np.linalg.norm(after["momentum_space"] - before["momentum_space"]) > 0
    assert_follows(page, tmp_path)
    scene, box = page.scene(), page.page.locator(".stage").bounding_box()
    page.page.mouse.move(box["x"] + 20, box["y"] + 80)
    page.page.mouse.down()
    page.page.mouse.move(box["x"] + 80, box["y"] + 100)
    page.page.mouse.up()
    settle(page)
    assert direction(canvas) != pytest.approx(camera, rel=1e-3)
    assert page.scene() == scene


def test_push_by_touch(opened):
    """A finger draws the arrow, and the page does not scroll."""
    phone = {"viewport": {"width": 390, "height": 844}, "is_mobile": True, "has_touch": True}
    page = opened({"format": 1, "scene": BOX}, **phone)
    page.page.locator("#push").tap()
    page.drawn()
    scene, box = page.scene(), page.page.locator(".stage").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    screen = page.page.context.new_cdp_session(page.page)
    for k in range(6):
        points = [{"x": x + 5 * k, "y": y - 9 * k}]
        kind = "touchMove" if k else "touchStart"
        screen.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
    screen.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    settle(page)
    assert page.scene() != scene
    assert page.page.locator("#hands-report").inner_text().startswith("Push: L changes by")


# By now a force has moved it, from rest.
FALLING = SCENES["thrown"].replace("position = [0, 0, 1]\nvelocity = [1, 0, 2]\n", "")


@pytest.mark.parametrize("scene", [slow(SCENES["thrown"]), FALLING], ids=["thrown", "falling"])
def test_push_moves_a_body_that_flies(scene, hands, tmp_path):
    """The centre of mass gains J/m where it has a path of its own; its place stays."""
    page = hands(scene)
    rows = f"async () => Array.from((await {VIEWER}.ready).row.value)"
    before = np.array(page.page.evaluate(rows))
    page.page.locator("#push").click()
    page.drawn()
    press(page, "grip-push", "ArrowUp", "Enter")
    after = np.array(page.page.evaluate(rows))
    assert_same(after[18:21], before[18:21])
    gained, added = after[21:24] - before[21:24], after[14:17] - before[14:17]
    assert np.linalg.norm(gained) > 0
    # r∧J contains J, so that its axial vector is across J.
    assert gained @ added == pytest.approx(0, abs=1e-9 * np.linalg.norm(gained) * np.linalg.norm(added))
    assert_follows(page, tmp_path)


@pytest.mark.parametrize("by", [slow("keys"), "pointer"])
def test_omega_moves_over_the_energy_ellipsoid(by, hands, tmp_path):
    page = hands()
    before = page.state()
    grip = page.page.locator("#grip-energy")
    label = grip.get_attribute("aria-label")
    if by == "keys":
        press(page, "grip-energy", "ArrowUp", "ArrowRight", "Shift+ArrowRight")
    else:
        drag(page, "#grip-energy", 30, 40)
    after = page.state()
    assert grip.get_attribute("aria-label") != label
    assert after["time"] == TIME
    assert_same(after["rotor"], before["rotor"])
    assert after["energy"] == pytest.approx(before["energy"], rel=ROUNDING)
    assert np.linalg.norm(after["omega_body"] - before["omega_body"]) > 0.01
    assert page.page.locator("#hands-report").inner_text().endswith("E stays")
    assert_follows(page, tmp_path)


KEPT = {"omega": "omega_body", "momentum": "momentum_space"}


@pytest.mark.parametrize("grip", ["momentum", *(slow(grip) for grip in ("omega", "attitude"))])
def test_handles_aim_the_bivectors_and_the_attitude(grip, hands, tmp_path):
    page = hands()
    assert page.page.locator(f"#grip-{grip}").is_hidden()
    before = page.state()
    page.page.locator("#aim").click()
    page.drawn()
    drag(page, f"#grip-{grip}", 20, 30)
    press(page, f"grip-{grip}", "ArrowLeft", "Shift+ArrowDown")
    after = page.state()
    if grip == "attitude":
        assert np.linalg.norm(after["rotor"] - before["rotor"]) > 0.01
        assert_same(after["omega_body"], before["omega_body"])
    else:
        kept = KEPT[grip]
        assert_same(after["rotor"], before["rotor"])
        assert np.linalg.norm(after[kept]) == pytest.approx(np.linalg.norm(before[kept]), rel=ROUNDING)
        assert np.linalg.norm(after[kept] - before[kept]) > 0.01 * np.linalg.norm(before[kept])
    assert_follows(page, tmp_path)


def test_a_drag_lets_the_motion_play_on(hands):
    page = hands()
    page.page.evaluate(f"async () => (await {VIEWER}.ready).look({{ playing: true, speed: 1e-3 }})")
    drag(page, "#grip-energy", 10, 10)
    assert page.page.evaluate(f"async () => (await {VIEWER}.ready).playing.value") is True
    press(page, "grip-energy", "ArrowUp")
    assert page.page.evaluate(f"async () => (await {VIEWER}.ready).playing.value") is False


def test_changes_are_undone_and_redone(hands):
    """A drag is one step; a hand, a slider and the editor are three. The sliders follow."""
    page = hands()
    rate = page.page.locator("#rate-number").input_value()
    scenes = [page.scene()]
    drag(page, "#grip-energy", 30, 40)
    scenes.append(page.scene())
    drag(page, "#rate", 40, 0)
    scenes.append(page.scene())
    page.page.locator("#panel-text summary").click()
    area = page.page.get_by_label("Scene, in TOML")
    area.fill(area.input_value().replace("5 cm", "6 cm"))
    page.page.get_by_role("button", name="Apply").click()
    settle(page)
    scenes.append(page.scene())
    assert len(set(scenes)) == 4
    page.page.locator("h1").click()
    for k in (2, 1):
        page.page.keyboard.press("Control+z")
        page.until("model.scene.value === scene && !model.solving.value", scene=scenes[k])
    undo, redo = (page.page.get_by_role("button", name=name) for name in ("Undo", "Redo"))
    undo.click()
    page.until("model.scene.value === scene && !model.solving.value", scene=scenes[0])
    assert undo.is_disabled()
    assert page.page.locator("#rate-number").input_value() == rate
    page.page.keyboard.press("Control+Shift+z")
    page.until("model.scene.value === scene && !model.solving.value", scene=scenes[1])
    redo.click()
    page.until("model.scene.value === scene && !model.solving.value", scene=scenes[2])
    # A slider goes on from there, and nothing is left to redo.
    page.page.locator("#rate").press("ArrowRight")
    settle(page)
    assert redo.is_disabled()
    assert "1.5" in page.scene()
    # Text fields undo what is typed themselves.
    area.press("Control+z")
    assert page.scene() not in scenes


def test_history_is_bounded(core):
    calls = [["clear", "0"]]
    for k in range(1, 151):
        calls += [["begin"], ["record", str(k)], ["record", f"{k} again"]]
    calls += [["back"]] * 101 + [["forth"]]
    shown = core.ask("history", calls=calls)
    assert shown[-103] == ["150 again", True, False]
    # A hundred steps back from the last one, and no further.
    assert shown[-3] == shown[-2] == ["50 again", False, True]
    assert shown[-1] == ["51 again", True, True]


def test_a_scene_set_by_python_can_be_undone(hands):
    page = hands()
    replace = f"async scene => (await {VIEWER}.ready).replace(scene)"
    page.page.evaluate(replace, BOX.replace("5 cm", "6 cm"))
    page.page.keyboard.press("Control+z")
    page.until("model.scene.value === scene && !model.solving.value", scene=BOX)
    assert page.data("time") == TIME


def test_tools_are_reached_by_keys(hands):
    """A key chooses a tool and its first handle, Esc puts it away."""
    focused = f"{VIEWER}.shadowRoot.activeElement?.id"
    page = hands()
    page.page.locator("h1").click()
    for key, tool, grip in (("u", "push", "grip-push"), ("a", "aim", "grip-omega")):
        page.page.keyboard.press(key)
        page.until(f"{focused} === grip", grip=grip)
        page.page.keyboard.press("Escape")
        page.until(f"{focused} === tool", tool=tool)
        page.drawn()
        assert page.page.locator(f"#{grip}").is_hidden()


def test_another_scene_has_a_history_of_its_own(hands):
    page = hands()
    press(page, "grip-energy", "ArrowUp")
    assert page.page.locator("#undo").is_enabled()
    page.show({"format": 1, "scene": TUMBLING + RUN})
    assert page.page.locator("#undo").is_disabled()


@pytest.mark.parametrize("name", ["full inertia", slow("lagrange")])
def test_ghost_starts_a_tenth_of_a_degree_away(name, hands, tmp_path):
    text = scene_of(name)
    page = hands(text)
    page.page.locator("#ghost").click()
    page.until(f"/[1-9]/.test({VIEWER}.shadowRoot.querySelector('#apart')?.textContent ?? '')")
    shown = float(page.page.locator("#apart").inner_text().split("°")[0])
    motion = followed_text(text, tmp_path / "scene.toml").motion
    omega = motion.omega_body[0].components
    # Towards the principal axis that is farthest from Ω.
    size = np.linalg.norm(omega)
    _, axes = np.linalg.eigh(motion.inertia.matrix)
    near = np.abs(axes.T @ omega)
    angles = []
    for k in np.flatnonzero(near < near.min() + 1e-9 * size):
        for sign in (1, -1):
            towards = sign * (axes[:, k] - omega * (axes[:, k] @ omega) / size**2)
            tilt = np.radians(0.1)
            other = np.cos(tilt) * omega + np.sin(tilt) * size * towards / np.linalg.norm(towards)
            spin = f"spin = {{ bivector = {other.tolist()} }}"
            ghost = followed_text(re.sub(r"spin = .*", spin, text), tmp_path / "ghost.toml").motion
            apart = (~motion.at(TIME).rotor * ghost.at(TIME).rotor).components
            angles.append(np.degrees(2 * np.arctan2(np.linalg.norm(apart[1:]), abs(apart[0]))))
    # Two digits; the sense of a principal axis is a matter of convention.
    assert min(abs(np.array(angles) - shown)) < 0.006
    page.page.locator("#ghost").click()
    assert page.page.locator("#apart").count() == 0


def test_what_has_no_scene_cannot_be_changed(opened):
    page = opened(document.of_trajectory(_python_torque()))
    for name in ("undo", "redo", "push", "aim", "ghost"):
        assert page.page.locator(f"#{name}").is_disabled()
    page.page.keyboard.press("u")
    assert page.page.locator("#grip-push").is_hidden()


def _python_torque():
    body = ph.Inertia.from_principal_moments(1, 2, 3)
    start = ph.State(ph.Rotor.identity(), [0.3, 1, 0.2])
    return ph.simulate(body, start, np.linspace(0, 2, 21), lambda t, R, W: -0.1 * W)


def test_help_lists_the_keys(hands):
    page = hands()
    page.page.locator("#help").click()
    text = page.page.get_by_role("dialog").inner_text()
    for word in ("undo", "push", "ghost", "new start"):
        assert word in text
