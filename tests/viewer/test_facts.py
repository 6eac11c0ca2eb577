"""The panel of the motion: what happens in a sentence, and the numbers behind “Details”."""

import math

import pytest

from viewer_page import VIEWER
from viewer_scenes import HELD, RUN, TUMBLING

SENTENCE = "#panel-motion .happens"
FACTS = "#panel-motion .facts"
WIDE, NARROW = ({"viewport": {"width": width, "height": 800}} for width in (1280, 390))

# Half the period 4K/λ of Ω for moments 1, 2, 3 and rates 0.01, 1, 0.01: Landau & Lifshitz,
# Mechanics, section 37.
# Next to the separatrix K is log(4/k') but for terms of the order k'² = 2e-4.
SMALL, LARGE = 4.001 - 2.0004, 3 * 2.0004 - 4.001
FLIP = 2 * math.log(4 / math.sqrt(1 - LARGE / SMALL)) / math.sqrt(SMALL / 6)


def sentence(opened, scene):
    page = opened({"format": 1, "scene": scene + RUN})
    return page.page.locator(SENTENCE).inner_text()


def body(moments, *spin):
    return f"[body]\nmoments = {moments}\n[initial]\nspin = {{ vector = {list(spin)} }}\n"


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        (body([1, 2, 3], 0.01, 1, 0.01), f"It turns over again and again, every {FLIP:.3g}\u00a0s"),
        (TUMBLING, "It tumbles"),
        (body([2, 2, 1], 0.2, 0, 3), "It wobbles steadily: its axis circles the axis of L, once in"),
        (HELD, "its path has cusps"),
        pytest.param(
            body([1, 2, 3], 0, 0, 1),
            "It turns about one axis, which stays where it is.",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            TUMBLING + "[torque]\ngyrostat = [0.5, 1, 0]\n", "so L is constant", marks=pytest.mark.slow
        ),
        pytest.param(
            TUMBLING + "[torque]\ngravity_gradient = { rate = 0.5 }\n",
            "A torque acts on the body (gravity gradient), so L changes.",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_motion_is_described_in_words(scene, words, opened):
    assert words in sentence(opened, scene)


def test_numbers_of_laws_have_names_and_units(opened):
    law = (
        "[torque]\ngravity_gradient = { rate = 0.5, eccentricity = 0.1 }\nviscous_damping = [0.1, 0.2, 0.3]\n"
    )
    for body, unit in ((TUMBLING, ""), (TUMBLING.replace("[body]", '[body]\nmass = "1 kg"'), " N m s")):
        page = opened({"format": 1, "scene": body + law + RUN}, **WIDE)
        facts = page.page.locator(FACTS).inner_text().replace("\xa0", " ").splitlines()
        assert "n = 0.5 rad/s, eccentricity = 0.1, mean anomaly = 0 rad" in facts
        assert f"d = (0.1, 0.2, 0.3){unit}" in facts


def test_details_are_folded_on_narrow_screens_and_remembered(opened, new_page, tmp_path):
    """A page remembers whether they were open, where the browser lets it."""
    wide = opened({"format": 1, "scene": TUMBLING + RUN}, **WIDE)
    wide.page.locator(FACTS).wait_for()
    narrow = opened({"format": 1, "scene": TUMBLING + RUN}, **NARROW)
    narrow.page.locator(SENTENCE).wait_for()
    assert narrow.page.locator(FACTS).count() == 0
    narrow.page.locator("#panel-motion .details summary").click()
    narrow.page.locator(FACTS).wait_for()
    narrow.page.reload()
    narrow.settled()
    narrow.page.locator(FACTS).wait_for()


def test_screen_readers_hear_the_sentence(opened):
    page = opened({"format": 1, "scene": TUMBLING + RUN})
    said = page.page.evaluate(
        f"[...{VIEWER}.shadowRoot.querySelectorAll('p.hidden[aria-live]')].map((p) => p.textContent)"
    )
    assert page.page.locator(SENTENCE).inner_text() in said
