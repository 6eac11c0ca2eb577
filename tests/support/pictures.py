"""Pictures of a viewer page as pixels, and the colours in them."""

import io

import numpy as np
import pytest

from viewer_scenes import ROOT

PALETTE = (ROOT / "viewer/src/palette.ts").read_text()


def colours(theme):
    """Return the colours of Ω, L and the background of a theme, `LIGHT` or `DARK`, as RGB."""
    text = PALETTE.partition(f"export const {theme}")[2]

    def named(name):
        code = text.partition(f'{name}: "#')[2][:6]
        return np.array([int(code[k : k + 2], 16) for k in (0, 2, 4)])

    return {name: named(name) for name in ("omega", "momentum", "background")}


def picture(page):
    """Return the picture with its labels as pixels (height, width, 3)."""
    image = pytest.importorskip("PIL.Image")
    page.drawn()
    shot = page.page.locator("polhode-viewer .picture").screenshot(animations="disabled")
    return np.asarray(image.open(io.BytesIO(shot)).convert("RGB")).astype(int)


def near(pixels, colour, distance=12):
    """Return how many pixels have a colour, up to antialiasing."""
    return int((np.abs(pixels - colour).max(axis=-1) <= distance).sum())
