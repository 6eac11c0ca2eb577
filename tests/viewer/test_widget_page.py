"""The widget connected to its page: both have the same values."""

import json

import numpy as np
import pytest

import polhode as ph
from comms import Comm
from polhode._viewer import html as _html
from viewer_page import VIEWER

pytest.importorskip("anywidget")

INERTIA = ph.Inertia.from_principal_moments(1, 2, 3)
START = ph.State(ph.Rotor.identity(), [0.01, 1, 0.01])

# As in anywidget: the module is loaded from a text, the model keeps values and reports changes.
PAGE = """<!doctype html>
<meta charset="utf-8">
<link rel="icon" href="data:,">
<div id="cell" style="width: 900px"></div>
<script type="application/json" id="bundle">{bundle}</script>
<script type="application/json" id="values">{values}</script>
<script type="module">
const text = (id) => JSON.parse(document.getElementById(id).textContent);
const values = text("values");
const heard = new Map();
const equal = (a, b) => JSON.stringify(a) === JSON.stringify(b);
const changed = (name) => heard.get(name)?.forEach((hear) => hear());
const unsaved = new Set();
window.sent = [];
const model = {{
  get: (name) => values[name],
  set(name, value) {{
    if (equal(values[name], value)) return;
    values[name] = value;
    unsaved.add(name);
    changed(`change:${{name}}`);
  }},
  on(name, hear) {{ heard.set(name, [...(heard.get(name) ?? []), hear]); }},
  off(name, hear) {{ heard.set(name, heard.get(name).filter((other) => other !== hear)); }},
  save_changes() {{
    if (unsaved.size) sent.push(Object.fromEntries([...unsaved].map((name) => [name, values[name]])));
    unsaved.clear();
  }},
}};
window.hears = (state) => {{
  const names = Object.keys(state).filter((name) => !equal(values[name], state[name]));
  Object.assign(values, state);
  names.forEach((name) => changed(`change:${{name}}`));
}};
window.listeners = () => [...heard.values()].flat().length;
const url = URL.createObjectURL(new Blob([text("bundle")], {{ type: "text/javascript" }}));
const {{ default: widget }} = await import(url);
window.end = await widget.render({{ model, el: document.getElementById("cell") }});
</script>
"""


class Notebook:
    """A widget and the page that shows it; messages wait until they are passed on."""

    def __init__(self, viewer, page, path):
        self.viewer, self.page, self.line = viewer, page, viewer.comm
        values = {name: x for name, x in self.line.opened["state"].items() if not name.startswith("_")}
        data = {"bundle": _html.bundle_path().read_text(), "values": values}
        escaped = {name: json.dumps(x).replace("<", "\\u003c") for name, x in data.items()}
        path.write_text(PAGE.format(**escaped))
        page.open(path)
        self.quiet()

    def ask(self, script, argument=None):
        """Return the value of a function of the page's model."""
        call = f"async x => ({script})(await {VIEWER}.ready, x)"
        return self.page.page.evaluate(call, argument)

    def pass_on(self):
        """Pass on the waiting messages."""
        sent, self.line.sent = self.line.sent, []
        for message in sent:
            if message["method"] == "update":
                self.page.page.evaluate("state => hears(state)", message["state"])
        for state in self.page.page.evaluate("() => sent.splice(0)"):
            self.line.sends(**state)

    def quiet(self):
        """Pass on messages until there are none for longer than the interval of the page."""
        silent = 0
        while silent < 4:
            waiting = self.page.page.evaluate("() => sent.length") or self.line.sent
            self.pass_on()
            silent = 0 if waiting else silent + 1
            self.page.page.wait_for_timeout(60)

    def agree(self):
        """Assert that no message is waiting and both sides are equal."""
        self.quiet()
        for name in ("scene", "problem", "time", "playing", "speed", "camera", "theme", "shown"):
            assert getattr(self.viewer, name) == self.ask(f"model => model.{name}.value"), name


@pytest.fixture
def shown(browser, new_page, monkeypatch, tmp_path):
    """Shows a widget in a page."""
    monkeypatch.setattr("comm.create_comm", Comm)
    return lambda *given, **named: Notebook(ph.view(*given, **named), new_page(), tmp_path / "notebook.html")


def test_values_set_by_python_reach_the_page(shown):
    notebook = shown(INERTIA, START, duration=60)
    viewer = notebook.viewer
    notebook.agree()
    assert viewer.playing is False
    assert viewer.camera == "oblique"
    viewer.time, viewer.speed, viewer.theme = 12.345678901234567, 0.25, "dark"
    viewer.camera, viewer.shown = "along L", {"poinsot": True}
    notebook.agree()
    assert viewer.time == 12.345678901234567
    assert viewer.shown["poinsot"]
    assert viewer.shown["body"]
    free = ph.FreeMotion(INERTIA, START.rotor, START.omega_body).at(viewer.time)
    # The same closed form, compiled twice.
    assert (viewer.state.rotor - free.rotor).norm() < 1e-14
    assert (viewer.state.omega_body - free.omega_body).norm() < 1e-14


def test_changes_in_the_page_reach_python(shown):
    notebook = shown(INERTIA, START, duration=60)
    viewer = notebook.viewer
    before = viewer.shown["polhode"]
    notebook.ask("model => { model.seek(1.5); model.look({ camera: 'along e3' }); model.toggle('polhode'); }")
    notebook.agree()
    assert (viewer.time, viewer.camera, viewer.shown["polhode"]) == (1.5, "along e3", not before)
    notebook.ask("(model, change) => model.change(change)", "[body]\nmoments = [1.0, 2.0, 2.5]")
    # Also in a notebook the scene is solved in a worker.
    assert notebook.ask("model => model.solver.proved && model.solver.available")
    notebook.agree()
    assert viewer.run().inertia.principal_moments.tolist() == [1, 2, 2.5]
    assert viewer.time == 1.5


def test_a_scene_set_by_python_is_not_replaced_while_it_is_solved(shown):
    """The page reports nothing until the scene that Python has set is solved."""
    notebook = shown(INERTIA, START, duration=60)
    viewer = notebook.viewer
    slow = viewer.scene + '[torque]\nquadratic_damping = 0.1\n[method]\nname = "rk4"\nstep = "200 us"\n'
    # The page itself toggles: the scene may be solved before another call reaches the page.
    notebook.ask(
        """model => {
            const toggle = () => model.toggle('polhode');
            model.solving.subscribe((solving) => solving && queueMicrotask(toggle));
        }"""
    )
    before = viewer.shown["polhode"]
    viewer.scene = slow
    notebook.pass_on()
    notebook.page.until("model.shown.value.polhode !== before", before=before)
    notebook.quiet()
    assert viewer.scene == slow
    notebook.page.until("!model.solving.value")
    notebook.agree()
    assert viewer.scene == slow


def test_the_state_is_the_same_before_and_after_the_page_answers(shown):
    notebook = shown(INERTIA, START, duration=60)
    viewer = notebook.viewer
    viewer.time = 0.7
    here = viewer.state
    notebook.agree()
    reported = viewer.state
    assert reported is not here
    assert viewer.state is reported
    for name in ("rotor", "omega_body"):
        values = getattr(here, name).components, getattr(reported, name).components
        np.testing.assert_allclose(*values, rtol=0, atol=1e-15)


def test_a_playing_motion_is_reported_at_intervals_and_when_it_stops(shown):
    notebook = shown(INERTIA, START, duration=60)
    notebook.viewer.playing = True
    notebook.pass_on()
    spent, calls = notebook.page.page.evaluate(
        f"""async () => {{
            const model = await {VIEWER}.ready;
            const start = performance.now();
            await new Promise((done) => setTimeout(done, 1000));
            model.playing.value = false;
            return [performance.now() - start, sent.length];
        }}"""
    )
    # At most every 100 ms, and once at the end.
    assert 1 <= calls <= spent / 100 + 2
    notebook.agree()
    assert notebook.viewer.playing is False
    assert notebook.viewer.time > 0


def test_a_scene_set_by_python_keeps_the_time(shown):
    notebook = shown(INERTIA, START, duration=60)
    viewer = notebook.viewer
    first = viewer.scene
    viewer.time, viewer.speed = 3, 0.3
    notebook.agree()
    viewer.scene = first.replace("3.0]", "2.5]")
    notebook.agree()
    assert (viewer.time, viewer.speed) == (3, 0.3)
    assert notebook.ask("model => model.about.value.body.moments") == [1, 2, 2.5]
    # An invalid scene is not accepted.
    for wrong in ("this is none", first.replace("3.0]", "30.0]")):
        viewer.scene = wrong
        notebook.agree()
        assert viewer.scene == first.replace("3.0]", "2.5]")
        assert "motion.toml:" in viewer.problem
    viewer.scene = first
    notebook.agree()
    assert viewer.problem is None
    assert notebook.ask("model => model.about.value.body.moments") == [1, 2, 3]


def test_another_motion_is_shown(shown):
    notebook = shown(INERTIA, START, duration=60)
    viewer = notebook.viewer
    viewer.time = 3
    notebook.agree()
    viewer.show(INERTIA, START, lambda t, R, W: -0.1 * W, duration=2)
    notebook.agree()
    assert viewer.scene is None
    assert viewer.time == 0
    assert notebook.ask("model => model.about.value.method") == "recorded"
    np.testing.assert_array_equal(viewer.state.omega_body.components, START.omega_body.components)


def test_a_cell_that_is_scrolled_away_is_restored(shown):
    notebook = shown(INERTIA, START, duration=60)
    viewer, page = notebook.viewer, notebook.page.page
    listeners = page.evaluate("() => listeners()")
    notebook.ask("(model, change) => model.change(change)", "[body]\nmoments = [1.0, 2.0, 2.5]")
    viewer.time = 2
    notebook.agree()
    page.evaluate("() => { window.cell = document.getElementById('cell'); cell.remove(); }")
    page.wait_for_timeout(50)
    assert page.evaluate("() => listeners()") == 0
    viewer.time, viewer.camera = 4, "along e1"
    notebook.pass_on()
    page.evaluate("() => document.body.append(cell)")
    notebook.page.settled()
    notebook.agree()
    assert (viewer.time, viewer.camera) == (4, "along e1")
    assert viewer.scene is not None
    assert "2.5]" in viewer.scene
    # A moved element continues, and is subscribed once.
    page.evaluate("() => document.body.append(document.createElement('p'), cell)")
    notebook.agree()
    assert page.evaluate("() => listeners()") == listeners
    page.evaluate("() => end()")
    assert page.evaluate("() => [listeners(), cell.children.length]") == [0, 0]
