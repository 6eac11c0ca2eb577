"""The viewer's page in a browser that has no network, and what it shows."""

from pathlib import Path

import numpy as np

# Chromium draws WebGL in software where there is no graphics card.
CHROMIUM = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")

# What can be read off the element.
SHOWN = ("rotor", "omega_body", "omega_space", "momentum_space", "energy")

VIEWER = "document.querySelector('polhode-viewer')"
# Whether all is in place: the picture, or what stands there instead, comes later than the panels.
IN_PLACE = f"""(() => {{
    const root = {VIEWER}?.shadowRoot;
    if (!root || !["ready", "problem"].includes({VIEWER}.dataset.state)) return false;
    const picture = root.querySelector(".stage");
    if (!picture) return root.querySelector(".app, .notice[role=alert]") !== null;
    return picture.querySelector("canvas") !== null || root.querySelector(".missing") !== null;
}})()"""
# The state of the page; null until the core is there.
READY = f"Promise.race([{VIEWER}.ready, null])"


class ViewerPage:
    """A page with one viewer. What it asked of the network and what it complained of must stay empty.

    Attributes
    ----------
    page, viewer
        Playwright's page, and the locator of the element.
    requests
        Addresses that were asked for, but for files, data and blobs.
    complaints
        Errors and warnings of the page, but for those that begin with one of `allowed`.
    """

    def __init__(self, page):
        self.page, self.viewer = page, page.locator("polhode-viewer")
        self.requests, self.complaints, self.allowed = [], [], ()
        page.on("request", self._requested)
        page.on("console", self._told)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))

    def _requested(self, request):
        if not request.url.startswith(("file:", "data:", "blob:")):
            self.requests.append(request.url)

    def _told(self, message):
        # What the driver of the graphics card tells of its speed is not the page's.
        ours = "GL Driver Message" not in message.text and not message.text.startswith(tuple(self.allowed))
        if message.type in ("error", "warning") and ours:
            self.complaints.append(message.text)

    def open(self, path):
        """Open a file and wait until its motion is there, or what is wrong with it."""
        self.page.goto(Path(path).as_uri())
        self.settled()

    def settled(self):
        """Wait until the core is there, the document was read and the picture is in its place."""
        self.until(IN_PLACE)

    def until(self, condition, **given):
        """Wait for a condition in JavaScript, of `model` and of names that are given, for a minute at most.

        Not by `wait_for_function`: that evaluates text in the page, which the page's policy forbids.
        """
        held = self.page.evaluate(
            f"""async given => {{
                const {{ {", ".join(given)} }} = given;
                for (const start = performance.now(); performance.now() < start + 60_000; ) {{
                    const model = {VIEWER}?.ready && (await {READY});
                    if ({condition}) return true;
                    await new Promise((done) => setTimeout(done, 10));
                }}
                return false;
            }}""",
            given,
        )
        assert held, f"in vain: {condition}"

    def data(self, name):
        """Return what the element says of a quantity, `time` or `omega-body`, as numbers."""
        numbers = np.array(self.viewer.get_attribute(f"data-{name}").split(), dtype=float)
        return numbers.item() if numbers.size == 1 else numbers

    def seek(self, time):
        """Go to a time, with all its digits."""
        self.page.evaluate(f"async time => (await {VIEWER}.ready).seek(time)", time)

    def state(self):
        """Return all quantities of the time shown, by the names of `node_core.PARTS`."""
        return {name: self.data(name.replace("_", "-")) for name in ("time", *SHOWN)}

    def compare(self, followed, tolerance=1e-12):
        """Seek output times of a motion, and hold what is shown to a part of the size of each quantity."""
        times, expected = followed.outputs()
        for k, time in enumerate(times):
            self.seek(time)
            shown = self.state()
            assert shown["time"] == time
            for name in SHOWN:
                atol = tolerance * followed.scale(name)
                np.testing.assert_allclose(shown[name], expected[name][k], rtol=0, atol=atol, err_msg=name)

    def show(self, document):
        """Give the element another document, and wait for its motion, or for what is wrong with it."""
        self.page.evaluate(
            f"""async given => {{
                const model = await {VIEWER}.ready;
                window.before = model.motion.value;
                model.problem.value = null;
                {VIEWER}.document = given;
            }}""",
            document,
        )
        self.until("model.motion.value !== window.before || model.problem.value !== null")

    def scene(self):
        """Return the text of the scene that is shown."""
        return self.page.evaluate(f"async () => (await {VIEWER}.ready).scene.value")

    def drawn(self):
        """Wait until what the page shows is on the screen: for two frames."""
        self.page.evaluate(
            "() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
        )
