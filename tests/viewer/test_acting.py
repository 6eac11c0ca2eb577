"""What acts on the body: the torque and the vectors of the laws, as the page gets them from the core."""

import base64

import numpy as np
import pytest

import polhode as ph
from viewer_page import VIEWER
from viewer_scenes import FILES, RUN, TUMBLING

ACTING = f"""async (time) => {{
    const model = await {VIEWER}.ready;
    const motion = model.motion.value;
    return motion.acting(motion.states([time]));
}}"""


def test_torque_is_that_of_python(opened):
    """−d Ω in space, to rounding of the rotations between body and space."""
    page = opened({"format": 1, "scene": TUMBLING + "[torque]\nviscous_damping = [0.1, 0.2, 0.3]\n" + RUN})
    page.seek(2.0)
    state, found = page.state(), page.page.evaluate(ACTING, 2.0)
    rotor = ph.Rotor.from_components(state["rotor"])
    expected = rotor(ph.bivector(-np.array([0.1, 0.2, 0.3]) * state["omega_body"])).components
    np.testing.assert_allclose(found["torque"], expected, rtol=0, atol=1e-14)
    assert found["sources"] == found["thrusts"] == []


def test_directions_follow_the_orbit(opened):
    page = opened({"format": 1, "scene": FILES["gravity-gradient"].read_text()})
    quarter = 5677 / 4
    (planet,) = page.page.evaluate(ACTING, quarter)["sources"]
    assert (planet["kind"], planet["in_space"], planet["unit"]) == ("planet", True, "")
    np.testing.assert_allclose(planet["along"], [0, -1, 0], rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("table", "kinds"),
    [
        ("[torque]\ngyrostat = [0, 1, 0]\n", ["wheel"]),
        ("[torque]\nmagnetic = { dipole = [1, 0, 0], field = [0, 1, 2] }\n", ["field", "dipole"]),
        ("[torque]\nradiation_pressure = { area = 1, offset = [0.1, 0, 0], sun = [0, 2, 0] }\n", ["sun"]),
        ("[torque]\nlarmor = [0, 0, 1]\n", ["field"]),
        ('[torque]\ntorque_body = "0.1 e1e2"\n', []),
    ],
)
def test_pictures_show_what_the_laws_depend_on(table, kinds, opened):
    page = opened({"format": 1, "scene": TUMBLING + table + RUN})
    page.drawn()
    found = page.page.evaluate(ACTING, 0)
    assert [source["kind"] for source in found["sources"]] == kinds
    entry = page.page.locator(".key [data-layer=sources]")
    assert entry.count() == (1 if kinds else 0)
    # A wheel has no torque on the body with it, whose L is constant.
    assert page.page.locator(".key [data-layer=torque]").count() == (0 if kinds == ["wheel"] else 1)
    if kinds:
        before = pixels(page)
        entry.click()
        page.drawn()
        assert pixels(page) != before


def test_thrusts_act_at_their_points(opened):
    scene = TUMBLING.replace("[body]", "[body]\nmass = 2")
    thrust = "[force]\nthrust = { force = [0.1, 0, 0.2], at = [0.5, 0.8, 0] }\n"
    page = opened({"format": 1, "scene": scene + thrust + RUN})
    found = page.page.evaluate(ACTING, 0)
    assert found["thrusts"] == [{"along": [0.1, 0, 0.2], "at": [0.5, 0.8, 0]}]
    # (x − c) ∧ F at the start, where body and space axes agree.
    np.testing.assert_allclose(found["torque"], np.cross([0.5, 0.8, 0], [0.1, 0, 0.2]), rtol=0, atol=1e-15)
    assert "thrust F" in page.page.locator(".key").inner_text()


def pixels(page):
    return base64.b64encode(page.page.locator("polhode-viewer .stage").screenshot(animations="disabled"))
