"""A viewer page in a browser without a network."""

from pathlib import Path

import numpy as np

# Chromium draws WebGL in software where there is no graphics card.
CHROMIUM = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")

# Quantities in the `data-…` attributes of the element.
SHOWN = ("rotor", "omega_body", "omega_space", "momentum_space", "energy")

VIEWER = "document.querySelector('polhode-viewer')"
# Whether the page is complete: the picture, or the message in its place, comes later than the panels.
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
    """A page with one viewer, which must make no requests and log no warnings.

    Attributes
    ----------
    page, viewer
        Playwright's page, and the locator of the element.
    requests
        Requested addresses, except files, data and blobs.
    complaints
        Errors and warnings of the page, except those that begin with one of `allowed`.
    """

    def __init__(self, page):
        self.page, self.viewer = page, page.locator("polhode-viewer")
        self.requests, self.complaints, self.allowed = [], [], ()
        page.on("request", self._requested)
        page.on("console", self._logged)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))

    def _requested(self, request):
        if not request.url.startswith(("file:", "data:", "blob:")):
            self.requests.append(request.url)

    def _logged(self, message):
        # Performance warnings of the graphics driver are not the page's.
        ours = "GL Driver Message" not in message.text and not message.text.startswith(tuple(self.allowed))
        if message.type in ("error", "warning") and ours:
            self.complaints.append(message.text)

    def open(self, path):
        """Open a file and wait for its motion or its error."""
        self.page.goto(Path(path).as_uri())
        self.settled()

    def settled(self):
        """Wait until the core is loaded, the document is read and the picture is in place."""
        self.until(IN_PLACE)

    def until(self, condition, **given):
        """Wait at most a minute for a JavaScript condition on `model` and the given names.

        `wait_for_function` evaluates text in the page, which the policy of the page forbids.
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
        assert held, f"condition not met within a minute: {condition}"

    def data(self, name):
        """Return a `data-…` attribute of the element, such as `omega-body`, as numbers."""
        numbers = np.array(self.viewer.get_attribute(f"data-{name}").split(), dtype=float)
        return numbers.item() if numbers.size == 1 else numbers

    def seek(self, time):
        """Go to a time, without rounding."""
        self.page.evaluate(f"async time => (await {VIEWER}.ready).seek(time)", time)

    def state(self):
        """Return the current state by the names of `node_core.PARTS`."""
        return {name: self.data(name.replace("_", "-")) for name in ("time", *SHOWN)}

    def compare(self, followed, tolerance=1e-12):
        """Compare the page with a motion at output times, relative to the size of each quantity."""
        self.until("!model.solving.value")
        times, expected = followed.outputs()
        for k, time in enumerate(times):
            self.seek(time)
            shown = self.state()
            assert shown["time"] == time
            for name in SHOWN:
                atol = tolerance * followed.scale(name)
                np.testing.assert_allclose(shown[name], expected[name][k], rtol=0, atol=atol, err_msg=name)

    def show(self, document):
        """Give the element another document, and wait for its motion or its error."""
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
        """Return the text of the current scene."""
        return self.page.evaluate(f"async () => (await {VIEWER}.ready).scene.value")

    def drawn(self):
        """Wait for two frames, after which changes are on the screen, and for the paths."""
        self.page.evaluate(
            "() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
        )
        self.until(f"{VIEWER}.shadowRoot.querySelector('.stage')?.dataset.complete !== 'false'")
