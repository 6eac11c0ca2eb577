"""Fixtures of the viewer. Tests without their requirements are skipped with the reason; in CI they fail."""

import shutil

import pytest

import processes
from missing import left_out
from node_core import node_core
from polhode._viewer import document as _document
from polhode._viewer import html
from studios import require_browser
from viewer_page import CHROMIUM, ViewerPage
from viewer_scenes import ROOT, followed


def pytest_terminal_summary(terminalreporter):
    """Report measured values."""
    for report in terminalreporter.getreports("passed"):
        for name, value in report.user_properties:
            terminalreporter.line(f"{name}: {value}")


@pytest.fixture(scope="package")
def node():
    """The path of Node, with the packages of the viewer."""
    found = shutil.which("node")
    version = processes.run([found, "--version"], check=True).stdout if found else "v0"
    if int(version.strip().lstrip("v").split(".")[0]) < 20:
        left_out("Node >= 20 was not found")
    if not (ROOT / "viewer/node_modules").exists():
        left_out("viewer/node_modules is missing: make viewer")
    return found


@pytest.fixture(scope="package")
def core(node):
    """The core under Node."""
    with node_core(node) as core:
        yield core


@pytest.fixture(scope="package")
def follow(tmp_path_factory):
    """A scene by its name, run by Python."""
    folder = tmp_path_factory.mktemp("scenes")
    return lambda name: followed(name, folder)


@pytest.fixture(scope="package")
def browser():
    """Chromium, one for all tests. Its driver must end with this directory: it holds an event loop."""
    path = require_browser()
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=path, args=list(CHROMIUM), chromium_sandbox=False)
        yield browser
        browser.close()


@pytest.fixture(scope="package")
def pages(browser):
    """Opens a page without a network, in a profile of its own; all are closed with the browser.

    It asks for reduced motion, so that a page stays at its start until it is set to play.
    """

    def opened(**options):
        context = browser.new_context(
            **{"viewport": {"width": 1280, "height": 800}, "reduced_motion": "reduce", **options}
        )
        context.set_offline(True)
        return ViewerPage(context.new_page())

    return opened


@pytest.fixture
def new_page(pages):
    """Opens pages, none of which may make a request or log an error."""
    opened = []

    def new(**options):
        opened.append(pages(**options))
        return opened[-1]

    yield new
    for page in opened:
        page.page.context.close()
    for page in opened:
        assert page.requests == []
        assert page.complaints == []


@pytest.fixture
def saved(follow, tmp_path):
    """Saves the page of a document, or of a scene by its name; returns its path."""

    def saved(given):
        document = given if isinstance(given, dict) else _document.of_scene(follow(given).scene)
        path = tmp_path / f"{len(list(tmp_path.glob('*.html')))}.html"
        path.write_text(html.page(document))
        return path

    return saved


@pytest.fixture
def opened(new_page, saved):
    """Opens the page of a document, or of a scene by its name, from disk."""

    def opened(given, **options):
        page = new_page(**options)
        page.open(saved(given))
        return page

    return opened
