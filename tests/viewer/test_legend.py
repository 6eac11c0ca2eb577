"""The legend of the picture: what it names, emphasizes and hides."""

import numpy as np
import pytest

from pictures import colours, near, picture
from viewer_page import VIEWER
from viewer_scenes import HELD, RUN, TUMBLING

LAYERS = "entries => entries.map((entry) => entry.dataset.layer)"


def layers(page):
    page.drawn()
    return page.page.locator(".key [data-layer]").evaluate_all(LAYERS)


def test_legend_names_what_is_shown(opened):
    page = opened({"format": 1, "scene": TUMBLING + RUN})
    shown = ["omega", "momentum", "bodyFrame", "spaceFrame", "trace", "polhode"]
    assert layers(page) == shown
    page.page.evaluate(
        f"async () => (await {VIEWER}.ready).look({{ shown: {{ omega: false, poinsot: true }} }})"
    )
    assert layers(page) == [*shown[1:], "poinsot"]
    # A torque, a fixed point and fields have entries where there are any.
    page.show({"format": 1, "scene": HELD + RUN})
    assert {"torque", "gravity"} < set(layers(page))
    magnetic = "[torque]\nmagnetic = { dipole = [0.2, 0, 0.1], field = [0, 1, 2] }\n"
    page.show({"format": 1, "scene": TUMBLING + magnetic + RUN})
    assert layers(page)[-1] == "sources"
    assert "field B, dipole m" in page.page.locator(".key").inner_text()


def test_swatches_have_the_colours_of_the_palette(opened):
    page = opened({"format": 1, "scene": TUMBLING + RUN}, color_scheme="light")
    for layer in ("omega", "momentum"):
        swatch = page.page.locator(f".key [data-layer={layer}] .look")
        colour = swatch.evaluate("swatch => getComputedStyle(swatch).borderTopColor")
        assert colour == f"rgb({', '.join(map(str, colours('LIGHT')[layer]))})"


@pytest.mark.parametrize("by", ["hover", "focus"])
def test_an_entry_emphasizes_its_thing(by, opened):
    page = opened(
        {"format": 1, "scene": TUMBLING + RUN, "view": {"shown": {"labels": False}}}, color_scheme="light"
    )
    entry = page.page.locator(".key [data-layer=momentum]")
    colour = colours("LIGHT")
    before = picture(page)
    if by == "hover":
        entry.hover()
    else:
        # From the entry before it.
        page.page.locator(".key [data-layer=omega]").focus()
        page.page.keyboard.press("Tab")
    assert page.page.evaluate(f"async () => (await {VIEWER}.ready).pointed.value.layer") == "momentum"
    after = picture(page)
    assert near(after, colour["momentum"], 40) > 1.3 * near(before, colour["momentum"], 40)
    assert near(after, colour["omega"], 40) < 0.5 * near(before, colour["omega"], 40)
    page.page.mouse.move(5, 5)
    page.page.locator("#play").focus()
    again = picture(page)
    assert (np.abs(again - before).max(axis=-1) > 32).mean() < 0.002


def test_an_entry_hides_its_thing_and_shows_it_again(opened):
    page = opened({"format": 1, "scene": TUMBLING + RUN})
    entry = page.page.locator(".key [data-layer=trace]")
    for pressed in ("false", "true"):
        entry.click()
        page.drawn()
        assert entry.get_attribute("aria-pressed") == pressed
        shown = page.page.evaluate(f"async () => (await {VIEWER}.ready).shown.value.trace")
        assert str(shown).lower() == pressed


def test_legend_is_folded_on_small_pages(opened):
    page = opened({"format": 1, "scene": TUMBLING + RUN}, viewport={"width": 390, "height": 844})
    assert layers(page) == []
    page.page.get_by_role("button", name="Legend").click()
    assert "omega" in layers(page)
    inside = page.page.evaluate(
        f"""() => [...{VIEWER}.shadowRoot.querySelectorAll(".key button")]
            .every((entry) => entry.getBoundingClientRect().right <= 390)"""
    )
    assert inside
