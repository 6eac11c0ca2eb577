"""Curves under the pointer are named and marked, in both pictures; frames reuse what they draw with."""

import numpy as np
import pytest

from pictures import colours, near, picture
from viewer_page import VIEWER
from viewer_scenes import RUN, TUMBLING

SCENE = {"format": 1, "scene": TUMBLING + RUN, "name": "tumbling.toml"}
MODEL = f"await {VIEWER}.ready"

# Moves the pointer along rows of a picture until the text beside it begins with a name.
SWEEP = f"""async ([selector, name]) => {{
    const host = {VIEWER}.shadowRoot.querySelector(selector);
    const {{ left, top, width, height }} = host.getBoundingClientRect();
    const tip = host.querySelector(".curve-tip");
    for (const part of [0.5, 0.42, 0.58, 0.35, 0.65]) {{
        for (let x = 20; x < width - 20; x += 4) {{
            const at = {{ clientX: left + x, clientY: top + part * height, pointerType: "mouse" }};
            host.dispatchEvent(new PointerEvent("pointermove", at));
            await new Promise((done) => requestAnimationFrame(done));
            if (!tip.hidden && tip.textContent.startsWith(name)) return tip.textContent;
        }}
    }}
    return null;
}}"""
LEAVE = (
    f"selector => {VIEWER}.shadowRoot.querySelector(selector).dispatchEvent(new PointerEvent('pointerleave'))"
)


def pointed(page):
    return page.page.evaluate(f"async () => ({MODEL}).pointed.value?.curve ?? null")


@pytest.mark.parametrize(
    ("host", "shown", "name", "curve"),
    [
        (".energy", {}, "Polhode: the path of Ω in the body", "polhode"),
        (".energy", {}, "Separatrix", "separatrix"),
        (".energy", {}, "Path of Ω for the same energy", "neighbours"),
        (".stage", {"herpolhode": True, "trace": False, "polhode": False}, "Herpolhode", "herpolhode"),
        (".stage", {"trace": True, "polhode": False}, "The path of an axis of the body", "trace"),
    ],
)
def test_curve_under_the_pointer_is_named(host, shown, name, curve, opened):
    page = opened({**SCENE, "view": {"shown": {"energy": True, "body": False, **shown}}})
    page.page.locator(".energy canvas").first.wait_for(state="attached")
    page.drawn()
    assert page.page.evaluate(SWEEP, [host, name]).startswith(name)
    assert pointed(page) == curve
    page.page.evaluate(LEAVE, host)
    assert pointed(page) is None
    assert page.page.locator(f"{host} .curve-tip").is_hidden()


def test_path_in_space_appears_while_that_in_the_body_is_pointed_at(opened):
    """With the views of the first page, which draws no path in space."""
    hidden = {"energy": True, "trace": False, "polhode": False, "herpolhode": False}
    page = opened({**SCENE, "view": {"shown": hidden}})
    page.drawn()
    points = page.page.locator(".stage")
    assert points.get_attribute("data-points") == "0"
    page.page.evaluate(f"async () => void (({MODEL}).pointed.value = {{ curve: 'polhode' }})")
    page.until(f"Number({VIEWER}.shadowRoot.querySelector('.stage').dataset.points) > 100")
    page.page.evaluate(f"async () => void (({MODEL}).pointed.value = null)")
    page.drawn()
    assert points.get_attribute("data-points") == "0"


def test_cloud_under_the_pointer_says_what_it_is(opened):
    many = TUMBLING + RUN + '[ensemble]\nnumber = 200\nattitude = "uniform"\n'
    page = opened({"format": 1, "scene": many, "name": "many.toml", "view": {"shown": {"body": False}}})
    page.until("!model.motion.value.awaitsBodies")
    page.drawn()
    said = page.page.evaluate(SWEEP, [".stage", "200 bodies, with attitude uniform"])
    assert said is not None
    assert pointed(page) == "cloud"


COUNT = """() => {
    window.made = 0;
    const { createBuffer } = WebGL2RenderingContext.prototype;
    WebGL2RenderingContext.prototype.createBuffer = function () {
        window.made += 1;
        return createBuffer.call(this);
    };
}"""


@pytest.mark.parametrize("torque", ["", "[torque]\nquadratic_damping = 0.05\n"], ids=["exact", "stepped"])
def test_frames_make_no_buffers(torque, opened):
    """While a motion plays, what moves is written into the buffers that are there."""
    shown = {"omega": True, "momentum": True, "axial": True, "poinsot": True, "energy": True}
    scene = TUMBLING + torque + RUN.replace("5 s", "50 s")
    page = opened({"format": 1, "scene": scene, "view": {"speed": 0.001, "shown": shown}})
    page.drawn()
    page.page.evaluate(COUNT)
    page.page.evaluate(f"async () => void (({MODEL}).playing.value = true)")
    time = page.data("time")
    page.until("model.time.value > time + 0.0003", time=time)
    page.drawn()
    assert page.page.evaluate("window.made") == 0


def test_paths_of_damped_motions_begin_at_the_start(opened):
    """Before it ω was many times as large, and its path went across the whole picture."""
    scene = TUMBLING + '[torque]\ndamping = "0.3 /s"\n' + RUN
    shown = {"labels": False, "omega": False, "momentum": False, "torque": False, "trace": False}
    page = opened({"format": 1, "scene": scene, "view": {"shown": shown}}, color_scheme="light")
    page.seek(1)
    pixels = picture(page)
    # The legend is below, and the buttons.
    height, width, _ = pixels.shape
    edges = pixels[8 : int(0.7 * height), np.r_[: width // 8, width - width // 8 : width]]
    assert near(edges, colours("LIGHT")["background"]) == edges.shape[0] * edges.shape[1]


def test_long_work_is_done_in_parts(opened):
    """While a slider moves, no call in the page computes more than 65 states: those of a figure."""
    scene = TUMBLING + "[torque]\nquadratic_damping = 0.05\n" + RUN
    page = opened({"format": 1, "scene": scene})
    page.drawn()
    page.page.evaluate(
        f"""async () => {{
            const model = {MODEL};
            window.first = model.motion.value;
            window.most = 0;
            const kind = Object.getPrototypeOf(model.motion.value);
            const {{ states }} = kind;
            kind.states = function (times) {{
                window.most = Math.max(window.most, times.length);
                return states.call(this, times);
            }};
            {VIEWER}.shadowRoot.querySelector("#panel-start").open = true;
        }}"""
    )
    slider = page.page.locator("#rate")
    slider.focus()
    for _ in range(3):
        slider.press("ArrowRight")
    page.until("model.motion.value !== window.first && !model.solving.value")
    page.drawn()
    assert 25 <= page.page.evaluate("window.most") <= 65
