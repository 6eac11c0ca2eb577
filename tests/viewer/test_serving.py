"""`polhode view` in a browser: the page makes no requests to other servers."""

import re

import pytest

import processes
from command_line import EXAMPLES, POLHODE


@pytest.fixture
def served():
    """The address of a server for the T-handle."""
    command = [POLHODE, "view", EXAMPLES / "t-handle.toml", "--no-browser"]
    with processes.start(command, stderr=None) as process:
        yield re.search(r"http://127\.0\.0\.1:\d+/[\w-]+/", process.stdout.readline())[0]


def test_served_page(served, pages, follow):
    page = pages()
    page.page.context.set_offline(False)
    page.page.goto(served)
    page.settled()
    page.compare(follow("t-handle"))
    # The policy of the server allows the worker.
    page.until("model.solver.proved && model.solver.available")
    assert {address.removeprefix(served) for address in page.requests} == {"", "viewer.js", "document.json"}
    assert page.complaints == []
    page.page.context.close()


def test_served_page_keeps_its_address_to_itself_and_saves_itself(served, pages, tmp_path):
    """The address has the token of the server, and works on this machine alone."""
    page = pages()
    page.page.context.set_offline(False)
    page.page.goto(served)
    page.settled()
    page.page.locator("#share").click()
    page.page.locator("#copy-address").click()
    page.page.locator(".said.failed", has_text="works on this machine alone").wait_for()
    with page.page.expect_download() as saved:
        page.page.locator("#save-page").click()
    saved.value.save_as(tmp_path / "saved.html")
    page.page.context.close()
    other = pages()
    other.open(tmp_path / "saved.html")
    assert other.requests == []
    assert other.complaints == []
    other.page.context.close()
