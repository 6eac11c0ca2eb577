"""Things in space drawn from the farthest to the nearest, so that what is in front hides what is behind."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._figures.camera import View
from polhode._support.arrays import Array
from polhode._support.extras import optional

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# More pieces than this are stored as a bitmap in an SVG or PDF.
_MANY = 20_000
_STEPS = 90  # of half a disc's rim
# What is behind a face by less is on it; a triangle with less area in the picture hides nothing; triangles
# that are looked at together.
_HAIR, _SLIVER, _AT_ONCE = 0.01, 1e-9, 500


class Disc:
    """An oriented disc about the origin: the plane and sense of a bivector, and a radius."""

    def __init__(self, first: Array, second: Array, radius: float, colour: str, arrows: int) -> None:
        """`first` and `second` (3,) are unit vectors with first∧second in the sense of the bivector."""
        self.first, self.second = first, second
        self.normal = np.cross(first, second)
        self.radius, self.colour, self.arrows = radius, colour, arrows

    def rim(self, angle: Any) -> Array:
        """Return points (..., 3) of the rim, by their angle from `first` towards `second`."""
        s = np.asarray(angle)[..., np.newaxis]
        points: Array = self.radius * (np.cos(s) * self.first + np.sin(s) * self.second)
        return points


class Painter:
    """Collects faces, lines and at most two transparent discs, and draws them as seen.

    The discs divide space into parts, which are drawn from the farthest to the nearest with the discs
    between; so these are right wherever they pass through bodies and through each other. Within a part the
    faces are drawn in the order of their middle points, and upon them the pieces of lines that none hides.
    """

    def __init__(self, view: View) -> None:
        self.view = view
        self.discs: list[Disc] = []
        self._faces: list[tuple[Array, Array, Array, Array]] = []
        self._lines: list[tuple[Array, Array, Array, Array]] = []
        self._hiding: list[Array] = []

    def faces(self, corners: Array, colours: Array, whole: Array) -> None:
        """Add small triangles (n, 3, 3) of colours (n, 3), and the triangles (m, 3, 3) that they make up."""
        # Their edges have the same colour, so that no seams are seen.
        self._faces.append((corners, colours, colours, np.full(len(corners), 0.7)))
        self._hiding.append(whole)

    def line(self, points: Array, colours: Any, width: float, piece: float) -> None:
        """Add a line through points (n, 3), of one colour (3,) or one per stretch, in pieces so long."""
        starts, ends = points[:-1], points[1:]
        colours = np.broadcast_to(colours, (len(starts), 3))
        counts = np.maximum(np.ceil(np.linalg.norm(ends - starts, axis=1) / piece), 1).astype(int)
        which = np.repeat(np.arange(len(counts)), counts)
        within = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
        share = np.stack([within, within + 1], axis=1) / counts[which, np.newaxis]
        pieces = starts[which, np.newaxis] + share[..., np.newaxis] * (ends - starts)[which, np.newaxis]
        self.segments(pieces, colours[which], width)

    def segments(self, pieces: Array, colours: Any, width: float) -> None:
        """Add short straight lines (n, 2, 3)."""
        corners = pieces[:, [0, 1, 1]]
        colours = np.broadcast_to(colours, (len(corners), 3))
        self._lines.append((corners, colours, colours, np.full(len(corners), width)))

    def arrow(self, start: Array, end: Array, colour: Any, width: float, head: float) -> None:
        """Add an arrow with a flat head that faces us."""
        along = (end - start) / np.linalg.norm(end - start)
        across = np.cross(self.view.toward, along)
        across = across / max(float(np.linalg.norm(across)), 0.2)
        base = end - head * along
        self.line(np.stack([start, base]), colour, width, 0.5 * head)
        wings = np.stack([end, base + 0.36 * head * across, base - 0.36 * head * across])
        own = np.asarray(colour)[np.newaxis]
        self._lines.append((wings[np.newaxis], own, own, np.array([0.3])))

    def draw(self, axes: Axes) -> None:
        """Draw everything; the layers have the z-orders from 10 on."""
        lines = [np.concatenate(column) for column in zip(*self._lines, strict=True)]
        seen = ~self.hidden(lines[0].mean(axis=1))
        parts = [*self._faces, tuple(column[seen] for column in lines)]
        corners, faces, edges, widths = (np.concatenate(column) for column in zip(*parts, strict=True))
        upon = np.arange(len(corners)) >= len(corners) - seen.sum()
        origin = np.arange(len(corners))
        for disc in self.discs:
            corners, origin = _split(corners, origin, disc.normal)
        middles = corners.mean(axis=1)
        # The layer of a thing has a digit per disc: 0 behind it, 2 in front; the disc itself is at 1.
        layers = np.zeros(len(corners), int)
        for k, disc in enumerate(self.discs):
            layers += self._sides(middles, disc) * 3 ** (len(self.discs) - 1 - k)
        order = np.lexsort((self.view.depth(middles), upon[origin], layers))
        flat = self.view.project(corners)[order]
        layers, origin = layers[order], origin[order]
        collection = optional("matplotlib.collections", "plot", "a figure").PolyCollection
        for layer in np.unique(layers):
            chosen = np.flatnonzero(layers == layer)
            rows = origin[chosen]
            drawn = collection(
                flat[chosen],
                facecolors=faces[rows],
                edgecolors=edges[rows],
                linewidths=widths[rows],
                joinstyle="bevel",
                zorder=10 + int(layer),
                snap=False,
            )
            drawn.set_rasterized(len(corners) > _MANY)
            axes.add_collection(drawn, autolim=False)
        self._draw_discs(axes)

    def hidden(self, points: Array) -> Any:
        """Return which points (n, 3) are behind a face, by more than a hair."""
        found = np.zeros(len(points), bool)
        flat = np.column_stack([self.view.project(points), np.ones(len(points))])
        depth = self.view.depth(points)[:, np.newaxis] + _HAIR
        for whole in self._hiding:
            for start in range(0, len(whole), _AT_ONCE):
                found |= _behind(self.view, whole[start : start + _AT_ONCE], flat, depth)
        return found

    def _sides(self, points: Array, disc: Disc) -> Any:
        """Return 2 for points (n, 3) on our side of a disc's plane, 0 for those behind."""
        ours = 1.0 if float(disc.normal @ self.view.toward) >= 0 else -1.0
        return np.where(ours * (points @ disc.normal) >= 0, 2, 0)

    def _draw_discs(self, axes: Axes) -> None:
        if not self.discs:
            return
        first, *others = self.discs
        place = 3 ** len(others)
        self._draw_part(axes, first, 0.0, 2 * np.pi, 10 + place)
        for disc in others:
            line = np.cross(first.normal, disc.normal)
            if np.linalg.norm(line) < 1e-9:
                # In one plane with the first.
                self._draw_part(axes, disc, 0.0, 2 * np.pi, 10 + place + 0.5)
                continue
            start = float(np.arctan2(line @ disc.second, line @ disc.first))
            for begin in (start, start + np.pi):
                middle = disc.rim(begin + np.pi / 2)
                side = int(self._sides(middle[np.newaxis], first)[0])
                self._draw_part(axes, disc, begin, begin + np.pi, 10 + side * place + 1)

    def _draw_part(self, axes: Axes, disc: Disc, begin: float, end: float, zorder: float) -> None:
        """Draw a sector of a disc, its rim and the arrows on it, which tell its sense."""
        rim = self.view.project(disc.rim(np.linspace(begin, end, _STEPS + 1)))
        axes.fill(*rim.T, facecolor=disc.colour, edgecolor="none", alpha=0.2, zorder=zorder)
        axes.plot(*rim.T, color=disc.colour, lw=1.8, zorder=zorder, solid_capstyle="butt")
        size = 0.16
        for angle in 2 * np.pi * (np.arange(disc.arrows) + 0.5) / disc.arrows:
            if (angle - begin) % (2 * np.pi) >= end - begin:
                continue
            tip, back = disc.rim(angle + size), disc.rim(angle - size)
            out = disc.rim(angle - size) / disc.radius * 0.62 * size * disc.radius
            head = self.view.project(np.stack([tip, back + out, disc.rim(angle - 0.4 * size), back - out]))
            axes.fill(*head.T, facecolor=disc.colour, edgecolor=disc.colour, lw=0.4, zorder=zorder + 0.1)


def _behind(view: View, triangles: Array, flat: Array, depth: Array) -> Any:
    """Return which points, (x, y, 1) in the picture (n, 3) at depths (n, 1), are behind triangles (m, 3, 3).

    Each is the sum of the corners with weights that are linear in (x, y); all are positive inside.
    """
    corners = np.concatenate([view.project(triangles), np.ones((len(triangles), 3, 1))], axis=-1)
    drawn = np.abs(np.linalg.det(corners)) > _SLIVER
    weights = np.linalg.inv(corners[drawn])
    inside = np.ones((len(flat), int(drawn.sum())), bool)
    for k in range(3):
        inside &= flat @ weights[:, :, k].T > 0
    planes = np.einsum("mxk,mk->mx", weights, view.depth(triangles[drawn]))
    return (inside & (flat @ planes.T > depth)).any(axis=1)


def _split(corners: Array, origin: Any, normal: Array) -> tuple[Array, Any]:
    """Cut triangles (n, 3, 3) that a plane through the origin passes through; `origin` goes along."""
    heights = corners @ normal
    above = heights > 0
    cut = np.flatnonzero((above.sum(axis=1) % 3 != 0) & (np.ptp(heights, axis=1) > 1e-12))
    if not len(cut):
        return corners, origin
    # The corner that is alone on its side comes first.
    alone = np.argmax(above[cut] == (above[cut].sum(axis=1) == 1)[:, np.newaxis], axis=1)
    turned = (alone[:, np.newaxis] + np.arange(3)) % 3
    rows = np.arange(len(cut))[:, np.newaxis]
    points, h = corners[cut][rows, turned], heights[cut][rows, turned]
    a, b, c = points[:, 0], points[:, 1], points[:, 2]
    ab = a + (h[:, 0] / (h[:, 0] - h[:, 1]))[:, np.newaxis] * (b - a)
    ac = a + (h[:, 0] / (h[:, 0] - h[:, 2]))[:, np.newaxis] * (c - a)
    pieces = [np.stack(three, axis=1) for three in ((a, ab, ac), (ab, b, c), (ab, c, ac))]
    whole = np.delete(np.arange(len(corners)), cut)
    return np.concatenate([corners[whole], *pieces]), np.concatenate([origin[whole], *[origin[cut]] * 3])
