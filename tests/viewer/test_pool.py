"""Workers share the bodies of an ensemble: the same bits for any number of them, even where some fail."""

import re
from itertools import pairwise

import pytest

from viewer_page import VIEWER
from viewer_scenes import RUN, TUMBLING

DAMPED = TUMBLING + "[torque]\nquadratic_damping = 0.1\n" + RUN
TIME = 1.3


def ensemble(number):
    return f'{DAMPED}[ensemble]\nnumber = {number}\nattitude = "uniform"\nspin = {{ relative = 0.1 }}\n'


@pytest.fixture(scope="module")
def alone(core):
    """The bodies from one core."""
    return core.ask("bodies", scene=ensemble(40), time=TIME, count=40)


def pooled(core, **options):
    return core.ask("pooled", scene=ensemble(40), time=TIME, count=40, **options)


@pytest.mark.parametrize("processors", [1, 2, 3, 20])
def test_bits_are_the_same_for_any_number_of_workers(processors, core, alone):
    found = pooled(core, processors=processors)
    assert found["bodies"] == alone
    assert found["problem"] == found["failure"] == ""
    # At most eight, all of which work; those that were started have ended.
    first, *others = found["workers"]
    assert len(others) == min(processors, 8) - 1
    assert all(worker["pieces"] > 0 for worker in found["workers"])
    assert not first["ended"]
    assert all(worker["ended"] for worker in others)
    assert all(before < after for before, after in pairwise(found["parts"]))
    assert found["parts"][-1] == 1


@pytest.mark.parametrize("failing", [[1], [1, 2], [2]])
def test_work_of_failed_workers_is_done_by_others(failing, core, alone):
    found = pooled(core, processors=3, failing=failing)
    assert found["bodies"] == alone
    assert found["failure"] == f"worker {failing[0]} failed"
    assert all(found["workers"][number]["pieces"] == 1 for number in failing)


def test_without_workers_the_reason_is_kept(core):
    found = pooled(core, processors=3, failing=[0])
    assert found["bodies"] == []
    assert found["problem"] == "worker 0 failed"


# The torque of bodies that turn faster than 1.1 rad/s is infinite.
FAILING = ensemble(40).replace(
    "quadratic_damping = 0.1", 'torque_body = "-exp(1e+5 * (-Ω_B·Ω_B - 1.21)) Ω_B"'
)


def test_bodies_that_fail_are_named(core):
    """The others are computed."""
    found = core.ask("pooled", scene=FAILING, time=TIME, count=40, processors=3)
    unknown = [body for body, scalar in enumerate(found["bodies"][::4]) if scalar is None]
    assert 3 < len(unknown) < 37
    assert found["problem"].startswith(f"body {unknown[0]}: ")
    assert found["bodies"] == core.ask("bodies", scene=FAILING, time=TIME, count=40)


COUNTED = """
window.workers = { started: 0, ended: 0 };
window.Worker = class extends Worker {
    constructor(...given) {
        super(...given);
        window.workers.started += 1;
    }
    terminate() {
        super.terminate();
        window.workers.ended += 1;
    }
};
Object.defineProperty(navigator, "hardwareConcurrency", { get: () => %d });
// The clock by which a page limits the time of its workers is an hour ahead: a loaded machine fails no test.
const { now } = Date;
Date.now = () => now() + 3_600_000;
"""


def bodies(page):
    page.until("!model.solving.value && !model.motion.value.awaitsBodies")
    rotors = f"async time => Array.from((await {VIEWER}.ready).motion.value.bodies(time))"
    return page.page.evaluate(rotors, TIME)


def test_pages_with_any_number_of_processors_have_the_same_bits(new_page, saved):
    path = saved({"format": 1, "scene": ensemble(400)})
    found = []
    for processors in (1, 3):
        page = new_page()
        page.page.add_init_script(COUNTED % processors)
        page.open(path)
        found.append(bodies(page))
        assert page.page.evaluate("window.workers") == {"started": processors, "ended": processors - 1}
    assert found[0] == found[1]
    assert len(found[0]) == 4 * 400


def test_page_says_which_bodies_are_not_drawn(opened):
    page = opened({"format": 1, "scene": FAILING})
    page.until("!model.motion.value.awaitsBodies")
    page.drawn()
    said = page.page.locator(".stage [role=status]").inner_text()
    assert re.fullmatch(r"\d+ of 40 bodies are not drawn; “Details” says why\.", said)
    page.page.locator("#panel-motion").evaluate("panel => panel.open = true")
    facts = page.page.locator("#panel-motion .facts").text_content()
    assert re.search(r"Not drawnbody \d+: at t = 0 s: `exp", facts)


def test_workers_end_with_their_scene(new_page, saved):
    """A newer scene ends those that compute bodies of the last one."""
    page = new_page()
    page.page.add_init_script(COUNTED % 3)
    page.open(saved({"format": 1, "scene": ensemble(1000).replace("5 s", "5000 s")}))
    page.until("window.workers.started === 3")
    assert "being computed" in page.page.locator(".stage [role=status]").inner_text()
    page.page.evaluate(f"async scene => void (await {VIEWER}.ready).open(scene)", TUMBLING + RUN)
    page.until("model.motion.value.about.ensemble === null")
    workers = page.page.evaluate("window.workers")
    assert workers == {"started": 4, "ended": 3}
