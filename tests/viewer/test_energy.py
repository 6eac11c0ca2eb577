"""The energy ellipsoid beside the picture: its curves are polhodes, and both pictures have one clock."""

import numpy as np
import pytest

import polhode as ph
from viewer_page import VIEWER
from viewer_scenes import RUN, TUMBLING

MODEL = f"async () => {{ const model = await {VIEWER}.ready; return %s; }}"
# Rounding of the formulas of a curve: sums and roots of a few numbers of size 1.
ROUNDING = 1e-13


def curves_of(core, moments, through=()):
    found = core.ask("polhodes", moments=list(moments), through=[list(u) for u in through])
    return {name: [curve if curve is None else np.array(curve) for curve in found[name]] for name in found}


@pytest.mark.parametrize("moments", [(1, 2, 3), (3, 1, 2), (0.9, 2.5, 2.6), (2, 2, 3), (1, 2, 2), (2, 2, 2)])
def test_curves_have_one_energy_and_one_momentum(moments, core):
    moments = np.array(moments, dtype=float)
    found = curves_of(core, moments)
    small, middle, large = np.sort(moments)
    distinct = len({small, middle, large})
    # Around the two ends of each axis but the middle one; around one axis of a symmetric top; none of a ball.
    assert len(found["neighbours"]) == {3: 12, 2: 6, 1: 0}[distinct]
    assert len(found["separatrix"]) == (2 if distinct == 3 else 0)
    for curve in found["neighbours"] + found["separatrix"]:
        assert np.abs((curve**2).sum(axis=1) - 1).max() < ROUNDING
        level = curve**2 @ moments
        assert np.ptp(level) < ROUNDING * large
    for curve in found["separatrix"]:
        assert curve[0] ** 2 @ moments == pytest.approx(middle, rel=ROUNDING)
        # Through both ends of the middle axis.
        assert np.abs(curve[:, moments == middle]).max() == 1


def test_polhode_of_a_motion_lies_on_its_curve(core):
    """In the coordinates ω_k √(i_k/2T) of the page, for motions around the first and the third axis."""
    moments = np.array([1.0, 2.0, 3.0])
    for start in ([2.0, 0.4, 0.3], [-2.0, 0.4, 0.3], [0.3, 0.2, 1.5], [0.3, 0.5, -1.5]):
        motion = ph.FreeMotion(ph.Inertia.from_principal_moments(*moments), ph.Rotor.identity(), start)
        omega = motion.at(np.linspace(0, 20, 400)).omega_body.components
        u = omega * np.sqrt(moments / (moments @ np.square(start)))
        (curve,) = curves_of(core, moments, [u[0]])["through"]
        gaps = np.linalg.norm(u[:, None] - curve[None], axis=2).min(axis=1)
        # Half the longest gap between the 128 points of a curve of length at most 2π√3, and a sagitta.
        assert gaps.max() < np.pi * 3**0.5 / 128 + 1e-3


def test_axes_have_no_curve(core):
    assert curves_of(core, (1, 2, 3), np.eye(3))["through"][0::2] == [None, None]
    assert curves_of(core, (2, 2, 2), [[0.6, 0, 0.8]])["through"] == [None]


def test_the_first_page_shows_both_pictures(opened):
    page = opened({"format": 1})
    energy = page.page.locator(".energy")
    energy.locator("canvas").first.wait_for(state="attached")
    assert "separatrix" in page.page.locator(".legend").inner_text()
    # The pointer over one picture marks the tip of Ω in both.
    assert page.page.evaluate(MODEL % "model.marked.value") is False
    energy.hover()
    assert page.page.evaluate(MODEL % "model.marked.value") is True
    page.page.locator("h1").hover()
    assert page.page.evaluate(MODEL % "model.marked.value") is False
    # A frame for each time.
    before = int(energy.get_attribute("data-drawn"))
    page.seek(1.0)
    page.drawn()
    assert int(energy.get_attribute("data-drawn")) > before


@pytest.mark.parametrize(
    ("scene", "beside"), [("asymmetric", True), ("symmetric", True), ("lagrange", False), ("damping", False)]
)
def test_free_bodies_have_an_energy_ellipsoid(scene, beside, opened, follow):
    page = opened({"format": 1, "scene": follow(scene).text, "view": {"shown": {"energy": True}}})
    assert (page.page.locator(".energy").count() == 1) is beside


def test_energy_ellipsoid_follows_the_scene(opened):
    page = opened({"format": 1, "scene": TUMBLING + RUN, "view": {"shown": {"energy": True}}})
    assert page.page.locator(".legend .dashed").count() == 1
    page.page.evaluate(f"""async () => (await {VIEWER}.ready).change("body.moments = [2, 2, 3]")""")
    assert page.page.locator(".legend .dashed").count() == 0
    page.page.locator("#panel-view summary").click()
    page.page.get_by_label("Energy ellipsoid in body axes").uncheck()
    page.page.locator(".energy").wait_for(state="detached")
