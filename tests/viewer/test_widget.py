"""The widget: values set by Python are sent to the page, and the reverse."""

import json
import re
import sys

import numpy as np
import pytest

import polhode as ph
from command_line import EXAMPLES, ROOT
from comms import Comm
from polhode._viewer import document as _document

anywidget = pytest.importorskip("anywidget")

INERTIA = ph.Inertia.from_principal_moments(1, 2, 3)
START = ph.State(ph.Rotor.identity(), [0.01, 1, 0.01])


@pytest.fixture
def line(bundle, monkeypatch):
    """The connection of a widget to its page."""
    monkeypatch.setattr("comm.create_comm", Comm)
    return lambda viewer: viewer.comm


def test_the_page_gets_the_document_and_the_bundle(line, bundle):
    viewer = ph.view(EXAMPLES / "toutatis.toml")
    given = line(viewer).opened["state"]
    assert given["document"] == _document.document(EXAMPLES / "toutatis.toml")
    assert given["scene"] == (EXAMPLES / "toutatis.toml").read_text()
    assert re.search(r"export default|as default", given["_esm"])
    for name in ("time", "playing", "speed", "camera", "theme", "state", "problem"):
        assert given[name] is None
    assert given["shown"] == {}


def test_values_set_by_python_reach_the_page(line):
    viewer = ph.view(INERTIA, START)
    values = {
        "time": 1.25,
        "playing": True,
        "speed": 0.5,
        "camera": "along L",
        "theme": "dark",
        "shown": {"polhode": True},
        "scene": viewer.scene.replace("1.0, 2.0, 3.0", "2.0, 3.0, 4.0"),
    }
    for name, value in values.items():
        setattr(viewer, name, value)
    assert line(viewer).received == values
    viewer.time = 3
    assert line(viewer).received["time"] == 3


def test_messages_of_the_page_reach_python(line):
    viewer = ph.view(INERTIA, START)
    heard = []
    viewer.observe(lambda change: heard.append((change["name"], change["new"])), ["time", "scene", "problem"])
    page = line(viewer)
    page.sends(time=0.1, playing=True, camera="along e1", shown={"body": False}, speed=2)
    assert (viewer.time, viewer.playing, viewer.camera, viewer.speed) == (0.1, True, "along e1", 2)
    assert viewer.shown == {"body": False}
    page.sends(scene="new", problem="scene.toml:1:1: error")
    page.sends(problem=None)
    assert heard == [
        ("time", 0.1),
        ("scene", "new"),
        ("problem", "scene.toml:1:1: error"),
        ("problem", None),
    ]
    # Its values are not sent back, except for the echo that the protocol requires.
    assert all(message["method"] == "echo_update" for message in page.sent)


def test_the_state_of_the_page_is_a_state(line):
    viewer = ph.view(INERTIA, START)
    state = ph.FreeMotion(INERTIA, START.rotor, START.omega_body).at(0.7)
    line(viewer).sends(
        time=0.7,
        state={
            "time": 0.7,
            "rotor": state.rotor.components.tolist(),
            "omega_body": state.omega_body.components.tolist(),
            "position": [1, 2, 3],
            "velocity": [0, 0, 1e-300],
        },
    )
    assert viewer.state.rotor == state.rotor
    assert viewer.state.omega_body == state.omega_body
    assert viewer.state.position == ph.vector([1.0, 2, 3])
    assert viewer.state.velocity.components[2] == 1e-300
    assert viewer.state.time == 0.7
    line(viewer).sends(state=None)
    assert viewer.state is None


def agree(state, expected, tolerance=0.0):
    for name in ("rotor", "omega_body", "position", "velocity"):
        values = getattr(state, name).components, getattr(expected, name).components
        np.testing.assert_allclose(*values, rtol=0, atol=tolerance, err_msg=name)


def test_the_state_is_that_of_the_time_that_was_set(line):
    """The page answers between cells; within a cell the state is computed here."""
    motion = ph.FreeMotion(INERTIA, START.rotor, START.omega_body)
    viewer = ph.view(INERTIA, START, duration=2)
    assert viewer.state is None
    page = line(viewer)
    at_start = {"time": 0.0, "rotor": [1, 0, 0, 0], "omega_body": [0.01, 1, 0.01]}
    page.sends(time=0.0, state={**at_start, "position": [0, 0, 0], "velocity": [0, 0, 0]})
    agree(viewer.state, START)
    # A closed form is known before its start and after its end.
    for time in (0.7, 1.9, 12.5, -3.0):
        viewer.time = time
        agree(viewer.state, motion.at(time), 1e-15)
    viewer.scene = viewer.scene.replace("1.0, 2.0, 3.0", "1.0, 2.0, 2.5")
    other = ph.FreeMotion(ph.Inertia.from_principal_moments(1, 2, 2.5), START.rotor, START.omega_body)
    agree(viewer.state, other.at(-3.0), 1e-15)
    # A report of another time is not taken for the state of this one.
    page.sends(camera="along e1")
    agree(viewer.state, other.at(-3.0), 1e-15)
    viewer.scene = viewer.scene.replace("duration", "durration")
    with pytest.raises(ph.SceneError, match="unknown field `durration`"):
        viewer.state  # noqa: B018
    # A reloaded page asks for all values but the state, which it knows.
    page.sent.clear()
    viewer.send_state()
    assert page.received["state"] is None
    viewer.show(INERTIA, START)
    assert viewer.state is None


@pytest.mark.usefixtures("line")
def test_the_state_of_a_motion_in_steps():
    motion = ph.simulate(INERTIA, START, [0.0, 0.5, 1.0], ph.torque.viscous_damping(0.1))
    viewer = motion.view()
    assert "recorded" in viewer.document
    # Rows are at most 0.2 rad apart, and interpolated.
    for time, expected, bound in (
        (0.5, 0.5, 1e-15),
        (0.7, 0.7, 0.2**2 / 8),
        (9.0, 1.0, 1e-15),
        (-1.0, 0.0, 0),
    ):
        viewer.time = time
        agree(viewer.state, motion.at(expected), bound)
    viewer.scene = viewer.scene.replace("0.1, 0.1, 0.1", "0.2, 0.2, 0.2")
    viewer.time = 9.0
    stepped = viewer.run()
    agree(viewer.state, stepped.at(1.0))
    viewer.time = 0.25
    agree(viewer.state, stepped.at(0.25))


@pytest.mark.usefixtures("line")
def test_the_state_of_a_recording():
    viewer = ph.view(INERTIA, START, lambda t, R, W: -0.1 * W, duration=1)
    viewer.time = 0.0
    agree(viewer.state, START, 1e-15)


@pytest.mark.usefixtures("line")
def test_invalid_values_are_refused():
    import traitlets

    viewer = ph.view(INERTIA, START)
    for name, value in (
        ("camera", "from afar"),
        ("theme", "pink"),
        ("time", "soon"),
        ("time", float("nan")),
        ("speed", float("inf")),
        ("shown", {"body": "no"}),
        ("shown", {"bodies": True}),
        ("problem", "none"),
        ("state", START),
    ):
        with pytest.raises(traitlets.TraitError):
            setattr(viewer, name, value)


@pytest.mark.usefixtures("line")
def test_the_scene_of_the_page_runs_here():
    viewer = ph.view(EXAMPLES / "t-handle.toml")
    before = viewer.run()
    assert before.certificate.method == "exact"
    assert (before.rotor == ph.Scene.read(EXAMPLES / "t-handle.toml").run().rotor).all()
    viewer.scene = viewer.scene.replace("5 rev/s", "2 rev/s")
    edited = viewer.run()
    assert edited.omega_body[0].components[1] == pytest.approx(4 * np.pi, rel=1e-15)
    assert edited.attributes["scene"] == viewer.scene
    viewer.scene = viewer.scene.replace("duration", "durration")
    with pytest.raises(ph.SceneError, match=r"^t-handle.toml:\d+:1: error: unknown field `durration`"):
        viewer.run()


@pytest.mark.usefixtures("line")
def test_a_recording_cannot_be_run():
    viewer = ph.view(INERTIA, START, lambda t, R, W: -0.1 * W, duration=1)
    assert viewer.scene is None
    with pytest.raises(ValueError, match="is a recording without a scene"):
        viewer.run()


def shown_in(text):
    return json.loads(re.search(r'<script type="application/json">(.*?)</script>', text)[1])


@pytest.mark.usefixtures("line")
def test_a_saved_page_shows_the_state_of_the_widget(tmp_path):
    trajectory = ph.simulate(INERTIA, START, [0, 1], ph.torque.viscous_damping(0.1))
    viewer = trajectory.view()
    assert shown_in(viewer.html()) == {**viewer.document, "view": {}}
    viewer.time, viewer.playing, viewer.camera = 0.0, False, "along L"
    viewer.save(tmp_path / "a.html")
    shown = shown_in((tmp_path / "a.html").read_text())
    assert shown["view"] == {"time": 0.0, "playing": False, "camera": "along L"}
    assert "recorded" in shown
    # With another scene there is no recording.
    viewer.scene = viewer.scene.replace("0.1", "0.2")
    shown = shown_in(viewer.html())
    assert shown["scene"] == viewer.scene
    assert "recorded" not in shown


def test_another_motion_is_shown_from_its_start(line):
    viewer = ph.view(INERTIA, START)
    viewer.time, viewer.camera = 3, "along e1"
    page = line(viewer)
    page.sent.clear()
    viewer.show(EXAMPLES / "toutatis.toml")
    # In one message, so that the page never has half of it.
    (message,) = page.sent
    assert message["state"]["document"] == viewer.document
    assert message["state"]["scene"] == viewer.scene
    assert message["state"]["time"] is None
    assert viewer.camera == "along e1"


@pytest.mark.usefixtures("line")
def test_motions_have_the_method_view():
    scene = ph.Scene.read(EXAMPLES / "toutatis.toml")
    top = ph.LagrangeTop(ph.Inertia.from_principal_moments(1, 1, 0.5), START.rotor, [1, 2, 3], [0, 0, 2])
    free = ph.FreeMotion(INERTIA, START.rotor, START.omega_body)
    for viewer in (scene.view(), scene.run().view(), free.view(duration=3), top.view(), top.view(duration=2)):
        assert isinstance(viewer, anywidget.AnyWidget)
        assert viewer.scene == viewer.document["scene"]
    assert "duration = 3.0" in free.view(duration=3).scene
    with pytest.raises(ValueError, match="one body"):
        ph.FreeMotion(INERTIA, START.rotor, np.ones((2, 3))).view()


def test_the_names_are_those_of_the_page(line):
    from polhode._viewer import widget as _widget

    text = (ROOT / "viewer/src/document.ts").read_text()
    cameras = re.search(r"CAMERAS = \[(.*?)\]", text, flags=re.DOTALL)[1]
    assert tuple(re.findall(r'"(.*?)"', cameras)) == _widget.CAMERAS
    themes = re.search(r"theme: (.*?);", text)[1]
    assert tuple(re.findall(r'"(\w+)"', themes)) == _widget.THEMES
    view = re.search(r"interface ViewState {(.*?)\n}", text, flags=re.DOTALL)[1]
    assert tuple(re.findall(r"^  (\w+):", view, flags=re.MULTILINE)) == _widget._VIEW
    drawn = re.search(r"interface Shown {(.*?)\n}", text, flags=re.DOTALL)[1]
    listed = re.search(r"Visibility by name: (.*?)\.", _widget.Viewer.__doc__, flags=re.DOTALL)[1]
    names = re.findall(r"^  (\w+):", drawn, flags=re.MULTILINE)
    assert re.split(r",\s+", listed) == names == list(_widget.DRAWN)
    # What the page sends is synchronised, and no other trait is.
    widget = (ROOT / "viewer/src/widget.ts").read_text()
    sent = re.search(r"function reported\(.*?return {(.*?)\n  };", widget, flags=re.DOTALL)[1]
    names = re.findall(r"^    (\w+):", sent, flags=re.MULTILINE)
    synced = {name for name, trait in _widget.Viewer.class_own_traits().items() if trait.metadata.get("sync")}
    assert set(names) | {"document"} == synced


def test_without_anywidget_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "anywidget", None)
    monkeypatch.delitem(sys.modules, "polhode._viewer.widget", raising=False)
    with pytest.raises(ImportError, match=r"needs anywidget: pip install 'polhode\[notebook\]'"):
        ph.view(INERTIA, START)
