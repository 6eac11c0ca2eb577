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
