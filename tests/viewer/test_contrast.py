"""Contrast of text: at least 4.5 on what it stands on, WCAG 2.2 level AA, in both themes."""

import pytest

from viewer_page import VIEWER
from viewer_scenes import HELD, RUN

LEAST = 4.5
THEMES = ("light", "dark")

# Relative luminance and contrast as WCAG defines them, of colours as browsers compute them.
CONTRAST = """
    const channels = (colour) => {
        const numbers = colour.match(/[-\\d.e]+/g).map(Number);
        if (colour.startsWith("color(")) return numbers;
        return [...numbers.slice(0, 3).map((x) => x / 255), numbers[3] ?? 1];
    };
    const luminance = (colour) => {
        const linear = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
        const [r, g, b] = channels(colour).map(linear);
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const contrast = (one, other) => {
        const [a, b] = [luminance(one), luminance(other)];
        return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    };
"""

# Text of the page whose contrast is too low, with its colours.
TEXTS = f"""(least) => {{
    {CONTRAST}
    const root = {VIEWER}.shadowRoot;
    const opaque = (colour) => (channels(colour)[3] ?? 1) === 1;
    const ground = (element) => {{
        for (let at = element; at; at = at.parentElement ?? at.getRootNode().host) {{
            const {{ backgroundColor }} = getComputedStyle(at);
            if (opaque(backgroundColor)) return backgroundColor;
        }}
        return "rgb(255, 255, 255)";
    }};
    const poor = [];
    let count = 0;
    for (const element of root.querySelectorAll("*")) {{
        const written = [...element.childNodes].some((node) => node.nodeType === 3 && node.data.trim());
        if (!(written || element.matches("input[type=number]")) || !element.checkVisibility()) continue;
        if (element.closest("style, .hidden, :disabled, option")) continue;
        if (getComputedStyle(element).opacity === "0") continue;
        const [text, on] = [getComputedStyle(element).color, ground(element)];
        // The editor's own text is transparent: a highlighted copy lies over it.
        if (!opaque(text)) continue;
        count += 1;
        const found = contrast(text, on);
        if (found < least) poor.push([element.textContent.slice(0, 30), text, on, found]);
    }}
    return [count, poor];
}}"""

# Keeps what is written on canvases: the colours of the letters and of their halo, the background.
WATCH = """
    window.written = new Map();
    const write = CanvasRenderingContext2D.prototype.fillText;
    CanvasRenderingContext2D.prototype.fillText = function (text, ...rest) {
        written.set(text, [this.fillStyle, this.strokeStyle]);
        return write.call(this, text, ...rest);
    };
"""
LABELS = f"""() => {{
    {CONTRAST}
    const hex = (colour) => `rgb(${{[1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16))}})`;
    return [...written].map(([text, [letters, halo]]) => [text, letters, contrast(hex(letters), hex(halo))]);
}}"""


def texts(page):
    """Return the number of texts, and those whose contrast is too low."""
    page.page.evaluate(
        f"() => {VIEWER}.shadowRoot.querySelectorAll('details').forEach((one) => (one.open = true))"
    )
    page.drawn()
    return page.page.evaluate(TEXTS, LEAST)


@pytest.mark.parametrize("theme", THEMES)
def test_text_of_the_motion_page(theme, opened):
    count, poor = texts(opened({"format": 1, "scene": HELD + RUN}, color_scheme=theme))
    assert count > 60
    assert poor == []


@pytest.mark.parametrize("theme", THEMES)
def test_text_of_the_algebra_page(theme, opened):
    """Names have the colours of the drawing; equations hold or fail, and lines have mistakes."""
    lines = "a = e1 + 2 e2\nb = 3 e3\nB = a ∧ b\nR = exp(-1/2 B)\nc = R a ~R\na = a\na ∧ a = 1\n5 +\n# end"
    count, poor = texts(opened({"format": 1, "page": "algebra", "lines": lines}, color_scheme=theme))
    assert count > 20
    assert poor == []


@pytest.mark.parametrize("theme", THEMES)
@pytest.mark.parametrize("shown", ["motion", "algebra"])
def test_labels_of_the_picture(shown, theme, new_page, saved):
    view = {"theme": theme, "shown": {"axial": True, "poinsot": True, "herpolhode": True}}
    path = saved({"format": 1, "scene": HELD + RUN, "page": shown, "view": view})
    page = new_page(color_scheme=theme)
    page.page.add_init_script(WATCH)
    page.open(path)
    page.drawn()
    labels = page.page.evaluate(LABELS)
    assert len(labels) > 3
    assert [label for label in labels if label[2] < LEAST] == []
