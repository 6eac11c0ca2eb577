"""Poinsot's construction: its plane is drawn horizontal, with the point of contact towards the eye."""

import numpy as np
import pytest

from viewer_page import VIEWER
from viewer_scenes import HELD, RUN, TUMBLING

SHOWN = {"shown": {"poinsot": True, "herpolhode": True}, "playing": False}
# Rounding of a few products of unit quaternions.
ROUNDING = 1e-12


def turned(page, axial):
    """Return an axial vector of space as the picture shows it, with its third component up."""
    canvas = page.page.locator(".stage canvas[data-upright]")
    x, y, z, w = map(float, canvas.get_attribute("data-upright").split())
    pure = np.array([x, y, z])
    return axial + 2 * np.cross(pure, np.cross(pure, axial) + w * axial)


def camera(page):
    canvas = page.page.locator(".stage canvas[data-upright]")
    return np.array(canvas.get_attribute("data-camera").split(), dtype=float)


def look(page, view):
    page.page.evaluate(f"async view => (await {VIEWER}.ready).look(view)", view)
    page.drawn()


@pytest.mark.parametrize("time", [0, 2.6])
def test_plane_is_horizontal_and_its_contact_towards_the_eye(time, opened):
    page = opened({"format": 1, "scene": TUMBLING + RUN, "view": SHOWN | {"time": time}})
    page.drawn()
    momentum, omega = page.data("momentum-space"), page.data("omega-space")
    up = turned(page, momentum / np.linalg.norm(momentum))
    np.testing.assert_allclose(up, [0, 0, 1], rtol=0, atol=ROUNDING)
    eye = camera(page)
    contact = turned(page, omega)
    across = [vector[:2] / np.linalg.norm(vector[:2]) for vector in (contact, eye)]
    # The camera keeps a distance of 1e-6 from the pole of its sphere, and rounds.
    np.testing.assert_allclose(*across, rtol=0, atol=1e-6)
    # From above, and not so steeply that the ellipsoid would look flat.
    assert 0.3 < eye[2] / np.linalg.norm(eye) < 0.8


def test_other_views_are_in_space(opened):
    page = opened({"format": 1, "scene": TUMBLING + RUN, "view": SHOWN})
    e3 = np.array([0.0, 0.0, 1.0])
    page.drawn()
    assert not np.allclose(turned(page, e3), e3)
    for view in (
        {"camera": "along e1"},
        {"camera": "oblique", "shown": {"poinsot": False}},
        {"shown": {"poinsot": True}, "camera": "along L"},
    ):
        look(page, view)
        np.testing.assert_allclose(turned(page, e3), e3, rtol=0, atol=ROUNDING)
    look(page, {"camera": "oblique"})
    assert not np.allclose(turned(page, e3), e3)


def test_plane_stays_horizontal_for_another_scene(opened):
    """While a slider moves, the user's view of the plane is kept."""
    page = opened({"format": 1, "scene": TUMBLING + RUN, "view": SHOWN})
    page.drawn()
    page.page.locator(".stage canvas[data-upright]").press("j")
    page.drawn()
    before = camera(page)
    page.page.evaluate(f"async () => (await {VIEWER}.ready).change('initial.spin.vector = [1, -0.2, 0.4]')")
    page.until("!model.solving.value")
    page.drawn()
    momentum = page.data("momentum-space")
    np.testing.assert_allclose(
        turned(page, momentum / np.linalg.norm(momentum)), [0, 0, 1], rtol=0, atol=ROUNDING
    )
    np.testing.assert_allclose(camera(page), before, rtol=0, atol=1e-9)


def test_tops_stand_upright(opened):
    """Under a torque L moves, so that no plane is at rest: e3 stays the vertical."""
    page = opened({"format": 1, "scene": HELD + RUN, "view": SHOWN})
    page.drawn()
    e3 = np.array([0.0, 0.0, 1.0])
    np.testing.assert_allclose(turned(page, e3), e3, rtol=0, atol=ROUNDING)


def test_captured_views_are_in_space(opened):
    """The azimuth and elevation that a figure asks for are in space, whatever the camera of the page."""
    page = opened({"format": 1, "scene": TUMBLING + RUN, "view": SHOWN})
    capture = f"""async (view) => {{
        (await {VIEWER}.ready).look(view);
        return {VIEWER}.capture(0, {{ width: 200, height: 150, scale: 1, view: [20, 30] }});
    }}"""
    pictures = [page.page.evaluate(capture, {"camera": camera}) for camera in ("oblique", "along e1")]
    assert pictures[0] == pictures[1]
