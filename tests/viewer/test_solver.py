"""Scenes of a page are solved in a worker: the page answers meanwhile, and only the newest scene counts."""

import numpy as np
import pytest

from viewer_page import VIEWER
from viewer_scenes import RUN, TUMBLING, followed_text

DAMPED = TUMBLING + "[torque]\nquadratic_damping = 0.1\n" + RUN
# Far more steps than a page computes within its time limit.
SLOW = DAMPED.replace('"5 s"', '"9 d"') + '[method]\nname = "rk4"\nstep = "1 ms"\n'
ENSEMBLE = DAMPED + '[ensemble]\nnumber = 20\nattitude = "uniform"\n'

# Whether a worker has solved a scene of the page.
PROVED = "model.solver.proved && model.solver.available"


def ask(page, scene):
    """Open a scene without waiting for its motion."""
    page.page.evaluate(f"async scene => void (await {VIEWER}.ready).open(scene)", scene)


def test_page_answers_while_a_scene_is_solved(opened):
    """The last picture stays, with a mark that it is old; time and view still change."""
    page = opened("asymmetric")
    page.until(PROVED)
    before = page.state()
    ask(page, SLOW)
    assert page.viewer.get_attribute("data-state") == "solving"
    assert "old" in page.page.locator(".seen").get_attribute("class").split()
    note = page.page.get_by_text("This picture is old")
    assert note.is_visible()
    page.seek(2.0)
    assert page.data("time") == 2.0
    np.testing.assert_allclose(page.data("momentum-space"), before["momentum_space"], rtol=1e-12)
    assert page.viewer.get_attribute("data-state") == "solving"
    ask(page, TUMBLING + RUN)
    page.until("!model.solving.value")
    assert not note.is_visible()
    assert page.page.locator(".seen.old").count() == 0


def test_newest_scene_replaces_those_that_are_still_solved(opened, tmp_path):
    page = opened("asymmetric")
    for scene in (SLOW, DAMPED, SLOW + "# again\n", DAMPED.replace("0.1", "0.2")):
        ask(page, scene)
    page.until("!model.solving.value")
    followed = followed_text(DAMPED.replace("0.1", "0.2"), tmp_path / "newest.toml")
    assert page.scene() == followed.text
    page.compare(followed)
    assert page.viewer.get_attribute("data-state") == "ready"


def test_slider_gives_up_what_is_old(opened):
    """A slider whose first change takes long is followed by its last one."""
    page = opened({"format": 1, "scene": DAMPED})
    change = f"async tables => void (await {VIEWER}.ready).change(tables)"
    page.page.evaluate(change, "run.duration = '9 d'\n[method]\nname = 'rk4'\nstep = '1 ms'\n")
    assert page.viewer.get_attribute("data-state") == "solving"
    for number in (0.2, 0.3, 0.4):
        page.page.evaluate(change, f"[torque]\nquadratic_damping = {number}\n")
    page.until("!model.solving.value")
    assert "quadratic_damping = 0.4" in page.scene()
    assert page.page.get_by_role("alert").count() == 0


def test_error_of_an_older_scene_is_not_shown(opened):
    page = opened("asymmetric")
    for scene in ("[body", TUMBLING + RUN):
        ask(page, scene)
    page.until("!model.solving.value")
    assert page.page.get_by_role("alert").count() == 0
    ask(page, "[body")
    page.until("model.problem.value !== null")
    assert "asymmetric.toml:1:6: error" in page.page.get_by_role("alert").inner_text()


def test_bodies_of_an_ensemble_come_from_the_worker(opened):
    page = opened({"format": 1, "scene": ENSEMBLE, "name": "many.toml"})
    page.until("!model.motion.value.awaitsBodies")
    rotors = page.page.evaluate(
        f"async () => Array.from((await {VIEWER}.ready).motion.value.bodies(0), Number)"
    )
    norms = np.linalg.norm(np.reshape(rotors, (20, 4)), axis=1)
    np.testing.assert_allclose(norms, 1, rtol=0, atol=1e-12)


FORBIDDEN = {
    "missing": "delete window.Worker",
    "refused": "window.Worker = class { constructor() { throw new DOMException('', 'SecurityError'); } }",
    # As Chromium does where the policy of a page forbids workers.
    "failing": """window.Worker = class extends EventTarget {
        postMessage() { setTimeout(() => this.dispatchEvent(new ErrorEvent('error'))); }
        terminate() {}
    }""",
}


@pytest.mark.parametrize("how", FORBIDDEN)
def test_page_without_workers_solves_its_scenes_itself(how, new_page, saved, follow):
    path = saved("torsion spring")
    page = new_page()
    page.page.add_init_script(FORBIDDEN[how])
    page.open(path)
    page.compare(follow("torsion spring"))
    assert not page.page.evaluate(f"async () => (await {VIEWER}.ready).solver.available")
    ask(page, "[body")
    page.until("model.problem.value !== null")


def test_cloud_stays_while_a_slider_moves(opened):
    """That of the motion before, until the bodies of the new one are known: no message takes its place."""
    page = opened({"format": 1, "scene": ENSEMBLE, "name": "many.toml"})
    page.until("!model.motion.value.awaitsBodies")
    page.drawn()
    page.page.evaluate(
        f"""() => {{
            window.said = new Set();
            const stage = {VIEWER}.shadowRoot.querySelector(".stage");
            new MutationObserver(() => window.said.add(stage.textContent)).observe(stage, {{
                childList: true, characterData: true, subtree: true,
            }});
        }}"""
    )
    for number in (0.2, 0.3, 0.4):
        page.page.evaluate(
            f"async tables => (await {VIEWER}.ready).change(tables)",
            f"[torque]\nquadratic_damping = {number}\n",
        )
        page.drawn()
    page.until("!model.solving.value && !model.motion.value.awaitsBodies")
    page.drawn()
    assert not any("being computed" in text for text in page.page.evaluate("[...window.said]"))
