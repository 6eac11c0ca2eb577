"""The three figures of the handout, computed with the algebra."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from polhode._algebra.constructors import I, e1, e2, e3
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._figures.camera import View, frame_picture
from polhode._figures.palette import AXES, BLACK, BLUE, FAINT, GREEN, MOMENTUM, OMEGA, ORANGE, WEIGHT
from polhode._figures.style import NEW, Figure, Sheet, drawing, halo, plotting
from polhode._mechanics.bodies import Body
from polhode._support.arrays import Array


class _Picture:
    """View of points (n, 3) of space in the axes of a figure."""

    def __init__(self, figure: Figure, azimuth: float, elevation: float) -> None:
        self.axes, self.view = figure.add_subplot(), View(azimuth, elevation)

    def line(self, points: Array, **style: Any) -> None:
        """Draw a line."""
        self.axes.plot(*self.view.project(points).T, **style)

    def fill(self, points: Array, **style: Any) -> None:
        """Draw a polygon."""
        self.axes.fill(*self.view.project(points).T, **style)

    def arrow(
        self, start: Array, end: Array, colour: str, width: float = 1.7, zorder: int = 6, head: float = 13
    ) -> None:
        """Draw an arrow that ends exactly at its points."""
        style = {"arrowstyle": "-|>", "color": colour, "lw": width, "shrinkA": 0, "shrinkB": 0}
        flat = self.view.project(np.stack([start, end]))
        arrow = {**style, "mutation_scale": head}
        self.axes.annotate("", xy=flat[1], xytext=flat[0], arrowprops=arrow, zorder=zorder)

    def heads(self, curve: Array, places: Sequence[int], colour: str, zorder: int) -> None:
        """Draw arrowheads that sit on a curve at the points with these numbers, along the curve."""
        head = plotting("matplotlib.path").Path([[-0.5, -0.32], [0.5, 0.0], [-0.5, 0.32], [-0.5, -0.32]])
        flat = self.view.project(curve)
        for k in places:
            x, y = flat[k + 1] - flat[k - 1]
            turned = plotting("matplotlib.transforms").Affine2D().rotate(np.arctan2(y, x))
            marker = head.transformed(turned)
            self.axes.plot(*flat[k], marker=marker, ms=9.5, color=colour, mec="none", zorder=zorder)

    def write(self, place: Array, text: str, colour: str, offset: tuple[float, float] = (0, 0)) -> None:
        """Write a text at a point, moved by an offset in points."""
        x, y = self.view.project(place)
        self.axes.annotate(
            text, (x, y), xytext=offset, textcoords="offset points", color=colour,
            fontsize="large", ha="center", va="center", zorder=50, path_effects=[halo(2.4)],
        )  # fmt: skip

    def frame(self, points: Array, margin: float) -> None:
        """Set the limits around points."""
        frame_picture(self.axes, self.view.project(points), margin)


@drawing(5.2, 4.8, r"The bivector $a\wedge b$, swept along $c$: the trivector $a\wedge b\wedge c$")
def swept_trivector(figure: Figure, a: Multivector, b: Multivector, c: Multivector) -> str:
    """Figure 1: the trivector that the bivector a∧b sweeps out along the vector c."""
    picture = _Picture(figure, -28, 20)
    corners = np.stack([x.components for x in (a, b, c)])
    _draw_parallelepiped(picture, corners)
    middle = 0.5 * (corners[0] + corners[1])
    _draw_turn(picture, middle, 0.2 * corners[0], 0.2 * corners[1], ORANGE)
    picture.write(middle, r"$a\wedge b$", ORANGE)
    for vec, colour, name, offset in (
        (corners[0], BLACK, "$a$", (2, -11)),
        (corners[1], BLACK, "$b$", (-9, -6)),
        (corners[2], BLUE, "$c$", (9, 2)),
    ):
        picture.arrow(np.zeros(3), vec, colour)
        picture.write(0.55 * vec, name, colour, offset)
    picture.frame(np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)]) @ corners, 0.2)
    swept = float(-((a ^ b ^ c) | I))
    sense = "right" if swept > 0 else "left"
    return (
        rf"$a$ = {_text(a)}, $b$ = {_text(b)}, $c$ = {_text(c)}: $a\wedge b$ = {_text(a ^ b)}, and swept "
        rf"along $c$ $a\wedge b\wedge c$ = {_text(swept * I)}, the volume with its sense, {sense}-handed "
        "(handout eq. 1.2 and 1.3)."
    )


@drawing(5.2, 4.8, r"A vector turned in the plane $B$: $a' = R a \tilde{R}$")
def turned_vector(figure: Figure, a: Multivector, B: Multivector, angle: float) -> str:
    """Figure 2: the vector a turned by an angle in rad in the plane and sense of the bivector B."""
    R = Rotor.from_plane_angle(B, angle)
    plane = B.normalized()
    picture = _Picture(figure, 20, 24)
    turned, within, across = R(a), a.project(plane), a.reject(plane)
    rim = _rim(plane, 1.25 * float(within.norm()))
    _draw_plane(picture, rim)
    partial = Rotor.from_plane_angle(B, angle * np.linspace(0, 1, 61))
    powers = partial(within).components
    _draw_sector(picture, 0.45 * powers)
    for start in (within, R(within)):
        ends = np.stack([start.components, (start + across).components])
        picture.line(ends, color=FAINT, lw=1.0, ls=(0, (3, 2)), zorder=4)
    picture.line(powers + across.components, color=ORANGE, lw=1.0, ls=(0, (1, 1.5)), zorder=4)
    for value, colour, name, width, offset in (
        (within, FAINT, r"$a_\parallel$", 1.2, (-3, -13)),
        (R(within), FAINT, r"$a'_\parallel$", 1.2, (8, -9)),
        (across, GREEN, r"$a_\perp = a'_\perp$", 1.4, (-6, 8)),
        (a, BLUE, "$a$", 1.9, (-10, 4)),
        (turned, ORANGE, r"$a' = R a \tilde{R}$", 1.9, (16, 9)),
    ):
        picture.arrow(np.zeros(3), value.components, colour, width)
        picture.write(value.components, name, WEIGHT if colour == FAINT else colour, offset)
    picture.write(0.58 * powers[len(powers) // 2], r"$\theta$", BLACK)
    picture.frame(np.stack([*rim, a.components, turned.components, across.components]), 0.22)
    return (
        rf"$B$ = {_text(plane)} with $B^2$ = {_text(plane | plane)}, $\theta$ = {np.degrees(angle):.4g}°, "
        rf"$R$ = {_text(R)}. $a$ = {_text(a)} goes to $a'$ = {_text(turned)}: the part "
        r"$a_\parallel = (a\cdot B)\,B^{-1}$ in the plane turns by $\theta$ in its sense, "
        r"$a_\perp = (a\wedge B)\,B^{-1}$ does not change (handout eq. 2.4)."
    )


@drawing(5.2, 4.8, "The inertia tensor takes the plane of rotation $B$ to $I(B)$")
def inertia_of_plane(figure: Figure, body: Body, lengths: Sequence[float], B: Multivector) -> str:
    """Figure 3: the inertia map of a box takes the plane of rotation B to I(B), in general another plane."""
    L = body.inertia(B)
    picture = _Picture(figure, 32, 20)
    half = np.asarray(lengths) / float(np.linalg.norm(lengths))
    _draw_box(picture, half)
    for k, axis in enumerate(np.eye(3)):
        _arrow_from_box(picture, 1.55 * axis, half, AXES[k], 1.7)
        picture.write(1.67 * axis, f"$e_{k + 1}$", AXES[k])
    largest = float(body.inertia.principal_moments.max())
    for value, most, colour, name, offset in (
        (B, float(B.norm()), OMEGA, "$B$", (-13, 0)),
        (L, largest * float(B.norm()), MOMENTUM, "$I(B)$", (18, 0)),
    ):
        rim = _rim(value, 1.45 * float(np.sqrt(float(value.norm()) / most)))
        _draw_disc_through_box(picture, rim, half, colour)
        _arrow_from_box(picture, 1.2 * value.dual().normalized().components, half, colour, 1.3)
        across = picture.view.project(rim)[:, 0] * np.sign(offset[0])
        picture.write(rim[int(np.argmax(across))], name, colour, offset)
    frame_picture(picture.axes, np.array([[-1.75, -1.55], [1.75, 1.75]]), 0.0)
    cosine = float(-(B | L)) / float(B.norm() * L.norm())
    meet = np.degrees(np.arccos(cosine))
    i = ", ".join(f"{x:.4g}" for x in body.inertia.principal_moments)
    return (
        f"A box with the moments {i} kg m²: $B$ = {_text(B)} rad/s goes to $I(B)$ = {_text(L)} kg m²/s, each "
        f"component by its own moment (handout eq. 4.18 and 4.24). The planes meet at {meet:.4g}°. "
        f"Areas are proportional to $|B|$ and $|I(B)|$; the thin arrows are their duals."
    )


def handout_figure(number: int, sheet: Sheet = NEW) -> Figure:
    """Return figure 1, 2 or 3 of the handout, with example values."""
    if number == 1:
        return swept_trivector.on(
            sheet, 0.15 * e1 + 1.5 * e2, -1.2 * e1 + 0.15 * e2, -0.1 * e1 + 0.4 * e2 + 1.05 * e3
        )
    if number == 2:
        B = (e1 ^ e2) + 0.12 * (e2 ^ e3)
        return turned_vector.on(sheet, 1.0 * e1 - 0.35 * e2 + 0.75 * e3, B, np.radians(75))
    lengths = [0.6, 0.9, 1.8]
    body = Body.box(lengths, mass=12)
    return inertia_of_plane.on(sheet, body, lengths, 0.3 * (e2 ^ e3) + 0.25 * (e3 ^ e1) + 0.8 * (e1 ^ e2))


# --- parts of the pictures


def _text(value: Multivector) -> str:
    """Return a value with few digits; its blades are mathematics, without a line break before them."""
    text = repr(value.map(np.vectorize(lambda x: float(f"{x:.4g}"))))
    text = re.sub(r"\b(e\d(∧e\d)*|I)\b", lambda blade: f"${blade[0]}$", text)
    text = re.sub(r"e(\d)", r"e_\1", text).replace("∧", r"\wedge ")
    return text.replace("-", "−").replace(" $", "\u00a0$")


def _draw_parallelepiped(picture: _Picture, edges: Array) -> None:
    """Draw the solid of three edges (3, 3) with its swept face at four places; edges behind are dashed."""
    a, b, c = edges
    base = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) @ edges[:2]
    for share, strength in ((1.0, 0.10), (2 / 3, 0.07), (1 / 3, 0.07), (0.0, 0.30)):
        face = base + share * c
        picture.fill(face, facecolor=ORANGE, edgecolor="none", alpha=strength, zorder=2)
        if 0 < share < 1:
            picture.fill(face, facecolor="none", edgecolor=ORANGE, lw=0.5, alpha=0.5, zorder=2)
    hand = np.sign(np.linalg.det(edges))
    # For each edge vector, whether the face at its end, and not that at its start, is towards us.
    at_end = [hand * np.cross(*others) @ picture.view.toward > 0 for others in ((b, c), (c, a), (a, b))]
    for k in range(3):
        first, second = (k + 1) % 3, (k + 2) % 3
        for i, j in np.ndindex(2, 2):
            start = i * edges[first] + j * edges[second]
            hidden = i != at_end[first] and j != at_end[second]
            style: dict[str, Any] = {"lw": 0.8, "ls": (0, (3, 2)), "alpha": 0.6} if hidden else {"lw": 1.1}
            ends = np.stack([start, start + edges[k]])
            picture.line(ends, color=BLACK, zorder=3, solid_capstyle="round", **style)


def _draw_turn(picture: _Picture, center: Array, first: Array, second: Array, colour: str) -> None:
    """Draw the sense of a bivector: an arrow about a point from `first` towards `second`."""
    s = np.linspace(0.35, 2 * np.pi - 0.35, 90)[:, np.newaxis]
    turn = center + 1.35 * (np.cos(s) * first + np.sin(s) * second)
    picture.line(turn, color=colour, lw=1.5, zorder=5)
    picture.arrow(turn[-8], turn[-1], colour, 1.5, zorder=5, head=12)


def _rim(plane: Multivector, radius: float) -> Array:
    """Return points (361, 3) of a circle about the origin, in the plane and sense of a bivector."""
    turn = Rotor.from_vectors(e3, plane.dual() / plane.norm())
    s = np.linspace(0, 2 * np.pi, 361)[:, np.newaxis]
    rim: Array = radius * (np.cos(s) * turn(e1).components + np.sin(s) * turn(e2).components)
    return rim


# --- a box about the origin with half-lengths (3,), and arrows and discs from its centre. A ray that leaves
# the box through a face towards us is in front of it (z-orders from 4 on), others are behind it.


def _draw_box(picture: _Picture, half: Array) -> None:
    """Draw the three faces towards us."""
    sides = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    for k, shade in enumerate(("#B9C2CF", "#838B95", "#C4CCDB")):
        corners = np.empty((4, 3))
        corners[:, k] = np.copysign(half[k], picture.view.toward[k])
        others = [(k + 1) % 3, (k + 2) % 3]
        corners[:, others] = sides * half[others]
        picture.fill(corners, facecolor=shade, edgecolor=BLACK, lw=0.9, zorder=3)


def _leaving(view: View, points: Array, half: Array) -> tuple[Array, Any]:
    """Return where rays to points (n, 3) leave the box, and whether through a face towards us."""
    shares = np.abs(points) / half
    face = shares.argmax(axis=1)
    rows = np.arange(len(points))
    return points / shares[rows, face, np.newaxis], points[rows, face] * view.toward[face] > 0


def _arrow_from_box(picture: _Picture, tip: Array, half: Array, colour: str, width: float) -> None:
    (start,), (ours,) = _leaving(picture.view, tip[np.newaxis], half)
    picture.arrow(start, tip, colour, width, zorder=6 if ours else 1)


def _draw_disc_through_box(picture: _Picture, rim: Array, half: Array, colour: str) -> None:
    """Draw an oriented disc from its rim: one half behind the box, one in front, without what is inside."""
    inner, ours = _leaving(picture.view, rim[:-1], half)
    start = int(np.flatnonzero(ours & ~np.roll(ours, 1))[0])
    for first, zorder, inside, heads in ((start, 4, inner, (70, 150)), (start + 180, 1, 0 * inner, (90,))):
        chosen = (first + np.arange(181)) % 360
        outer = rim[chosen]
        outline = np.concatenate([outer, inside[chosen][::-1]])
        picture.fill(outline, facecolor=colour, edgecolor="none", alpha=0.2, zorder=zorder)
        picture.line(outer, color=colour, lw=1.8, zorder=zorder + 1)
        picture.heads(outer, heads, colour, zorder + 1)


def _draw_plane(picture: _Picture, rim: Array) -> None:
    """Draw an oriented disc from its rim."""
    picture.fill(rim, facecolor="#EEF1F5", edgecolor=FAINT, lw=1.0, zorder=0)
    picture.heads(rim, (40, 160, 280), FAINT, 1)
    flat = picture.view.project(rim)
    lowest = int(np.argmin(flat[:, 1] - 0.6 * flat[:, 0]))
    picture.write(rim[lowest], "$B$", WEIGHT, (9, -9))


def _draw_sector(picture: _Picture, points: Array) -> None:
    """Draw the angle between the first and the last of points (n, 3) about the origin."""
    sector = np.stack([*points, np.zeros(3)])
    picture.fill(sector, facecolor=ORANGE, edgecolor="none", alpha=0.18, zorder=2)
    picture.line(points, color=BLACK, lw=1.1, zorder=3)
    picture.arrow(points[-6], points[-1], BLACK, 1.1, zorder=3, head=10)
