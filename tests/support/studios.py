"""A studio that paints frames without a browser, and what a real one needs."""

import io
import shutil
import sys
from contextlib import contextmanager
from types import ModuleType

from missing import left_out
from viewers import BUNDLE

CHROMIUM = ("chromium", "chromium-browser", "google-chrome")


def require_browser():
    """Return the path of a browser that can show the viewer; skip the test if something is missing."""
    if not (BUNDLE.is_file() and BUNDLE.stat().st_size):
        left_out("the viewer was not built: make viewer")
    try:
        import playwright  # noqa: F401
    except ImportError:
        left_out("playwright was not found")
    path = next(filter(None, map(shutil.which, CHROMIUM)), None)
    if path is None:
        left_out("Chromium was not found")
    return path


class Painted:
    """A studio with frames of one colour, which depends on the time; `asked` has the requests."""

    def __init__(self, times, size):
        self.times, self.size, self.asked = times, size, []

    def capture(self, time, **options):
        from PIL import Image

        self.asked.append((time, options))
        shade = int(255 * (time - self.times[0]) / max(self.times[-1] - self.times[0], 1e-9))
        buffer = io.BytesIO()
        picture = Image.new("RGB", self.size, "white")
        picture.paste((shade, 0, 0), (0, 0, self.size[0] // 2, self.size[1]))
        picture.save(buffer, format="PNG")
        return buffer.getvalue()


def paint(monkeypatch):
    """Replace the studio of figures and films, also without Playwright; return the list of those opened."""
    from polhode._figures import film

    opened = []

    @contextmanager
    def studio(trajectory, times, size, view, what):
        opened.append(Painted(times, size))
        yield opened[-1]

    monkeypatch.setitem(sys.modules, "playwright", ModuleType("playwright"))
    monkeypatch.setattr(film, "studio", studio)
    return opened
