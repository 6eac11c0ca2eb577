"""Pictures of a motion, taken from the viewer in a headless browser."""

from __future__ import annotations

import base64
import shutil
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any, TypeVar

from polhode._mechanics.trajectory import Trajectory
from polhode._support.arrays import Array
from polhode._support.extras import optional
from polhode._viewer.document import of_trajectory
from polhode._viewer.html import page

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserType, Page

T = TypeVar("T")

# Names of Chromium in distributions, and of related browsers.
_PROGRAMS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "msedge")
# Other places: the folder of Playwright, and those of Chrome and Edge.
_CHOICES: tuple[Any, ...] = ({}, {"channel": "chrome"}, {"channel": "msedge"})
# WebGL in software: the same pixels on every machine, and no graphics card is needed.
_SOFTWARE = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")
# Text has its usual size in a picture of this height; it grows more slowly than the picture.
_HEIGHT, _GROWTH = 540.0, 0.75

_CAPTURE = "([time, options]) => document.querySelector('polhode-viewer').capture(time, options)"


class Studio:
    """A page in a headless browser that shows one motion; see `studio`."""

    def __init__(
        self, page: Page, size: tuple[int, int], view: tuple[float, float] | None, call: Callable[..., Any]
    ) -> None:
        self.page, self._call = page, call
        width, height = size
        scale = (height / _HEIGHT) ** _GROWTH
        self._options = {"width": width, "height": height, "scale": scale}
        if view is not None:
            self._options["view"] = view

    def capture(self, time: float, **options: Any) -> bytes:
        """Return a PNG of the motion at a time in s; for the options see `capture` in `element.tsx`."""
        text = self._call(self.page.evaluate, _CAPTURE, [time, {**self._options, **options}])
        return base64.b64decode(text)


@contextmanager
def studio(
    trajectory: Trajectory, times: Array, size: tuple[int, int], view: tuple[float, float] | None, what: str
) -> Iterator[Studio]:
    """Open the viewer on a motion, for pictures at these times (n,) in s; the browser ends with the block.

    `size` is in pixels, `view` azimuth and elevation in degrees or None for those of the viewer. Errors name
    `what` needs the browser: an ImportError without Playwright, an OSError without a browser or the bundle.
    """
    playwright = optional("playwright.sync_api", "film", what)
    text = page(of_trajectory(trajectory, times=times), bare=True)
    # In a separate thread: Playwright does not run in one with an event loop, such as a notebook's.
    with ThreadPoolExecutor(1) as thread:

        def call(function: Callable[..., T], *arguments: Any, **named: Any) -> T:
            try:
                return thread.submit(function, *arguments, **named).result()
            except playwright.Error as error:
                raise OSError(f"{what}: the browser failed: {_first_line(error)}") from error

        # It is ended also if Ctrl-C comes while it starts.
        started: list[Any] = []
        try:
            call(lambda: started.append(playwright.sync_playwright().start()))
            call(lambda: started.append(_launch(started[0].chromium, playwright.Error, what)))
            opened = call(started[1].new_page)
            call(opened.set_content, text)
            yield Studio(opened, size, view, call)
        finally:
            thread.submit(_end, started, playwright.Error).result()


def _launch(chromium: BrowserType, error: type[Exception], what: str) -> Browser:
    """Return a browser of this machine, or that of Playwright."""
    paths = [path for name in _PROGRAMS if (path := shutil.which(name)) is not None]
    failures = []
    for chosen in (*({"executable_path": path} for path in paths), *_CHOICES):
        try:
            return chromium.launch(
                args=list(_SOFTWARE), chromium_sandbox=False, handle_sigint=False, **chosen
            )
        except error as failure:
            failures.append(_first_line(failure))
    if paths:
        raise OSError(f"{what} needs a browser, and {paths[0]} did not start: {failures[0]}")
    raise OSError(
        f"{what} needs a browser: install Chromium or Chrome (Debian: apt install chromium; elsewhere: "
        "python -m playwright install chromium)"
    )


def _end(started: list[Any], error: type[Exception]) -> None:
    """End the browser and the driver, of which a Ctrl-C may have left neither."""
    for one, end in reversed(list(zip(started, ("stop", "close"), strict=False))):
        with suppress(error):
            getattr(one, end)()


def _first_line(error: Exception) -> str:
    return str(error).strip().partition("\n")[0]
