"""The surface of a body as it is painted: shaded faces, creases and outline."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode._algebra.rotor import Rotor
from polhode._figures.painter import Painter
from polhode._figures.style import _AXES, BODY, WEIGHT
from polhode._support.arrays import Array

# The largest face that is drawn in one piece, and the pieces of edges, in a picture of a body of size 1.
_FACE, _EDGE = 0.25, 0.04
# A surface of more faces than this is fine enough already.
_FINE = 20_000
# An edge between two faces is drawn where they meet at more than this angle, in rad.
_CREASE = np.radians(25)
_LIGHT = np.array([-0.35, 0.45, 0.82]) / np.linalg.norm([-0.35, 0.45, 0.82])  # right, up and towards us


class Solid:
    """A closed surface in body axes: vertices (n, 3), and triangles (m, 3) whose normals point out.

    `tints` (m,) are the numbers of their colours, as in `Surface`; all plain if left out.
    """

    def __init__(self, vertices: Array, faces: Any, tints: Any = None) -> None:
        self.colours = _tint()[np.zeros(len(faces), int) if tints is None else tints]
        self.corners = vertices[faces]
        a, b, c = (self.corners[:, k] for k in range(3))
        normals = np.cross(b - a, c - a)
        self.normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
        self._small, self._part_of = _cut(self.corners)
        # Each edge has a face on either side.
        sides = faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
        _, at, number = np.unique(np.sort(sides, axis=1), axis=0, return_index=True, return_inverse=True)
        self._edges = vertices[sides[at]]
        order = np.argsort(number, kind="stable")
        first = np.searchsorted(number[order], np.arange(len(at)))
        last = np.searchsorted(number[order], np.arange(len(at)), side="right") - 1
        self._beside = np.stack([order[first] // 3, order[last] // 3], axis=1)
        cosines = (self.normals[self._beside[:, 0]] * self.normals[self._beside[:, 1]]).sum(axis=1)
        self._creases = cosines < np.cos(_CREASE)

    def paint(self, painter: Painter, rotor: Rotor) -> None:
        """Add the body, turned by the rotor, to what is painted."""
        turn = rotor.to_matrix().T
        view = painter.view
        normals = self.normals @ turn
        ours = view.depth(normals) > 0
        light = _LIGHT @ np.stack([*view.basis, view.toward])
        shades = 0.62 + 0.43 * np.maximum(normals @ light, 0.0)
        shown = np.flatnonzero(ours[self._part_of])
        shaded = np.clip(self.colours * shades[:, np.newaxis], 0, 1)
        painter.faces(self._small[shown] @ turn, shaded[self._part_of[shown]], self.corners[ours] @ turn)
        a, b = ours[self._beside].T
        seen = (a != b) | (self._creases & (a | b))
        painter.segments(_pieces(self._edges[seen] @ turn), 0.38 * rgb(BODY), 0.7)


def rgb(colour: str) -> Array:
    """Return red, green and blue from 0 to 1 of a colour such as ``#0072B2``."""
    return np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)]) / 255


def _tint() -> Array:
    """Return the colours (5, 3) of faces: plain, of the other quadrants, and of the sides across axes."""
    mixed = [(BODY, 0.0), (WEIGHT, 0.3), *((axis, 0.18) for axis in _AXES)]
    return np.stack([rgb(BODY) + part * (rgb(colour) - rgb(BODY)) for colour, part in mixed])


def _pieces(edges: Array) -> Array:
    """Cut straight lines (n, 2, 3) into short ones."""
    along = edges[:, 1] - edges[:, 0]
    counts = np.maximum(np.ceil(np.linalg.norm(along, axis=1) / _EDGE), 1).astype(int)
    which = np.repeat(np.arange(len(counts)), counts)
    within = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
    share = np.stack([within, within + 1], axis=1) / counts[which, np.newaxis]
    pieces: Array = edges[which, :1] + share[..., np.newaxis] * along[which, np.newaxis]
    return pieces


def _cut(corners: Array) -> tuple[Array, Any]:
    """Cut triangles (n, 3, 3) into small ones, and tell of each which it is part of."""
    if len(corners) > _FINE:
        return corners, np.arange(len(corners))
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    counts = np.maximum(np.ceil(longest / _FACE), 1).astype(int)
    pieces, which = [], []
    for n in np.unique(counts):
        rows = np.flatnonzero(counts == n)
        for weights in _weights(int(n)):
            pieces.append(np.einsum("kc,ncx->nkx", weights, corners[rows]))
            which.append(rows)
    return np.concatenate(pieces), np.concatenate(which)


def _weights(n: int) -> list[Array]:
    """Return the corners of the n² parts of a triangle, as weights (3, 3) of its own corners."""
    parts = []
    for i in range(n):
        for j in range(n - i):
            parts.append([[i, j], [i + 1, j], [i, j + 1]])
            if i + j < n - 1:
                parts.append([[i + 1, j], [i + 1, j + 1], [i, j + 1]])
    shares = np.array(parts) / n
    return list(np.concatenate([1 - shares.sum(axis=2, keepdims=True), shares], axis=2))
