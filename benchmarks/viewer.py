"""Measure the page: `python benchmarks/viewer.py [SCENE ...] [--sliders NAME ...] [--frames]`.

For every example and preset: the longest task of the main thread while each slider is dragged, and the
JavaScript of a frame while the motion plays. Times are CPU times of the thread, from traces of Chromium, so
that other programs on the machine count little; wall times stand beside them.
"""

from __future__ import annotations

import argparse
import json
import shutil
import tempfile
from collections import defaultdict
from pathlib import Path
from typing import Any

from playwright.sync_api import CDPSession, Page, sync_playwright

from polhode._scene.scene import Scene
from polhode._viewer.document import of_scene
from polhode._viewer.html import page as page_of

ROOT = Path(__file__).parent.parent
SCENES = {
    path.stem: path
    for folder in ("examples", "viewer/src/presets")
    for path in sorted((ROOT / folder).glob("*.toml"))
}
CHROMIUM = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")
CATEGORIES = "toplevel,devtools.timeline,blink.user_timing"
ELEMENT = "document.querySelector('polhode-viewer')"
IDLE = f"""async () => {{
    const root = {ELEMENT}.shadowRoot;
    const model = await {ELEMENT}.ready;
    for (const start = performance.now(); performance.now() < start + 20_000; ) {{
        await new Promise((done) => setTimeout(done, 50));
        const complete = root.querySelector(".stage")?.dataset.complete !== "false";
        if (!model.solving.value && complete && !model.motion.value?.awaitsBodies) return;
    }}
}}"""
# All sliders of the controls, those of torques among them.
OPEN = f"""async () => {{
    const root = {ELEMENT}.shadowRoot;
    const next = () => new Promise((done) => setTimeout(done, 100));
    for (const one of root.querySelectorAll("details")) one.open = true;
    await next();
    return [...root.querySelectorAll("input[type=range]")].map((one) => one.id);
}}"""
# Positions along a slider and back.
STEPS = 24


def main() -> None:
    """Measure and print a row for each scene."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=f"some of {', '.join(SCENES)}")
    parser.add_argument("--sliders", nargs="+", metavar="NAME", help="ids of sliders; by default all")
    parser.add_argument("--frames", action="store_true", help="measure frames only")
    options = parser.parse_args()
    path = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    with sync_playwright() as driver, tempfile.TemporaryDirectory() as folder:
        browser = driver.chromium.launch(executable_path=path, args=list(CHROMIUM), chromium_sandbox=False)
        print(f"{'scene':22}{'frame, ms':>10}{'worst':>8}   longest task by slider, ms of CPU (and of time)")
        for name in options.scenes or SCENES:
            target = Path(folder, f"{name}.html")
            target.write_text(page_of(of_scene(Scene.read(SCENES[name]))))
            page = browser.new_page(viewport={"width": 1280, "height": 800})
            page.goto(target.as_uri())
            page.locator("polhode-viewer .stage canvas").first.wait_for(timeout=60_000)
            page.evaluate(IDLE)
            session = page.context.new_cdp_session(page)
            frame = frames(page, session)
            tasks = {} if options.frames else sliders(page, session, options.sliders)
            worst = max((cpu for cpu, _ in tasks.values()), default=0.0)
            listed = sorted(tasks.items(), key=lambda item: -item[1][0])[:5]
            text = ", ".join(f"{slider} {cpu:.0f} ({wall:.0f})" for slider, (cpu, wall) in listed)
            print(f"{name:22}{frame:10.2f}{worst:8.0f}   {text}", flush=True)
            page.close()
        browser.close()


def frames(page: Page, session: CDPSession) -> float:
    """Return the CPU time in ms of the callbacks of a frame while the motion plays, all pictures together."""
    page.evaluate(f"async () => void ((await {ELEMENT}.ready).playing.value = true)")
    page.wait_for_timeout(1500)
    before = _drawn(page)
    with Trace(session) as trace:
        page.wait_for_timeout(2000)
    count = _drawn(page) - before
    page.evaluate(f"async () => void ((await {ELEMENT}.ready).playing.value = false)")
    took = [event["tdur"] / 1000 for event in trace.events if event["name"] == "FireAnimationFrame"]
    return sum(took) / count if count else float("nan")


def _drawn(page: Page) -> int:
    return int(page.locator("polhode-viewer .stage").first.get_attribute("data-drawn") or 0)


def sliders(page: Page, session: CDPSession, chosen: list[str] | None) -> dict[str, tuple[float, float]]:
    """Return the longest task while each slider is dragged: CPU time and time in ms."""
    names = [name for name in page.evaluate(OPEN) if not chosen or name in chosen]
    longest = {}
    for name in names:
        slider = page.locator(f"polhode-viewer #{name}")
        slider.scroll_into_view_if_needed()
        place = slider.bounding_box()
        assert place is not None
        left, width, middle = place["x"], place["width"], place["y"] + place["height"] / 2
        at = slider.evaluate("one => (one.valueAsNumber - one.min) / (one.max - one.min)")
        with Trace(session) as trace:
            page.mouse.move(left + 8 + at * (width - 16), middle)
            page.mouse.down()
            for step in [*range(STEPS), *reversed(range(STEPS))]:
                page.mouse.move(left + width * (0.05 + 0.9 * step / STEPS), middle)
                page.wait_for_timeout(40)
            page.mouse.up()
            page.evaluate(IDLE)
        tasks = [event for event in trace.events if event["name"].endswith("RunTask")]
        worst = max(tasks, key=lambda event: event.get("tdur", 0), default={})
        longest[name] = (worst.get("tdur", 0) / 1000, worst.get("dur", 0) / 1000)
        if name != "time":
            page.evaluate(f"async () => (await {ELEMENT}.ready).reset()")
            page.evaluate(IDLE)
    return longest


class Trace:
    """A trace of the main thread; `events` are those of the page after the block."""

    def __init__(self, session: CDPSession) -> None:
        self.session = session
        self.events: list[dict[str, Any]] = []

    def __enter__(self) -> Trace:
        """Begin."""
        settings = {"includedCategories": CATEGORIES.split(","), "recordMode": "recordAsMuchAsPossible"}
        self.session.send("Tracing.start", {"transferMode": "ReturnAsStream", "traceConfig": settings})
        return self

    def __exit__(self, *_: object) -> None:
        """End, and keep the events of the renderer's main thread."""
        found: list[dict[str, Any]] = []
        self.session.once("Tracing.tracingComplete", lambda event: found.append(event))
        self.session.send("Tracing.end")
        while not found:
            self.session.send("Runtime.evaluate", {"expression": "0"})
        text = ""
        while not (part := self.session.send("IO.read", {"handle": found[0]["stream"]})).get("eof"):
            text += part["data"]
        text += part.get("data", "")
        events = json.loads(text)["traceEvents"]
        named = defaultdict(list)
        for event in events:
            if event["name"] == "thread_name":
                named[event["args"]["name"]].append((event["pid"], event["tid"]))
        mains = set(named["CrRendererMain"])
        # The page is the renderer in which frames fired or most happened.
        by_thread = defaultdict(list)
        for event in events:
            if (event["pid"], event["tid"]) in mains and event.get("ph") == "X":
                by_thread[event["pid"], event["tid"]].append(event)
        self.events = max(by_thread.values(), key=len, default=[])


if __name__ == "__main__":
    main()
