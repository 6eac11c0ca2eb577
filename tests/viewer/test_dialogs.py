"""Dialogs of the page: they hold the focus while they are open, and give it back."""

import pytest

from viewer_page import VIEWER
from viewer_scenes import RUN, TUMBLING

FOCUSED = f"() => {VIEWER}.shadowRoot.activeElement?.id"


def by_escape(page):
    page.page.keyboard.press("Escape")


def by_its_button(page):
    page.page.locator("dialog[open]").get_by_role("button", name="Close").click()


def beside_it(page):
    page.page.mouse.click(3, 3)


@pytest.mark.parametrize("close", [by_escape, by_its_button, beside_it])
def test_dialogs_return_the_focus(close, opened):
    page = opened({"format": 1, "scene": TUMBLING + RUN})
    for name, title in (("scenes", "Scenes"), ("share", "Share"), ("help", "Keys")):
        page.page.locator(f"#{name}").press("Enter")
        dialog = page.page.get_by_role("dialog", name=title)
        assert dialog.is_visible()
        # The first control, or the one that is wanted most.
        assert dialog.locator(f"#{page.page.evaluate(FOCUSED)}").count() == 1
        close(page)
        assert page.page.locator("dialog[open]").count() == 0
        assert page.page.evaluate(FOCUSED) == name
