"""The three figures of the handout, computed with the algebra."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._algebra.constructors import I, e1, e2, e3
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._figures.camera import View, frame_picture
from polhode._figures.style import (
    _AXES,
    _BLACK,
    _BLUE,
    _GREEN,
    _ORANGE,
    FAINT,
    MOMENTUM,
    OMEGA,
    WEIGHT,
    entitle,
    explain,
    in_our_look,
    new_figure,
)
from polhode._mechanics.bodies import Body
from polhode._support.arrays import Array
from polhode._support.extras import optional

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@in_our_look
def swept_trivector(a: Multivector, b: Multivector, c: Multivector) -> Figure:
    """Figure 1: the trivector that the bivector a∧b sweeps out along the vector c."""
    figure, axes = _picture("The bivector a∧b, swept along c: the trivector a∧b∧c")
    view = View(-28, 20)
    corners = np.stack([x.components for x in (a, b, c)])
    _draw_parallelepiped(axes, view, corners)
    _draw_turn(axes, view, 0.5 * (corners[0] + corners[1]), 0.2 * corners[0], 0.2 * corners[1], _ORANGE)
    middle = 0.5 * (corners[0] + corners[1])
    _write(axes, view, middle, "a∧b", _ORANGE)
    for vec, colour, name, offset in (
        (corners[0], _BLACK, "a", (2, -11)),
        (corners[1], _BLACK, "b", (-9, -6)),
        (corners[2], _BLUE, "c", (9, 2)),
    ):
        _arrow(axes, view, np.zeros(3), vec, colour)
        _write(axes, view, 0.55 * vec, name, colour, offset)
    volume = a ^ b ^ c
    swept = float(-(volume | I))
    every = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)]) @ corners
    frame_picture(axes, view.project(every), 0.2)
    sense = "right" if swept > 0 else "left"
    explain(
        figure,
        f"a = {_text(a)}, b = {_text(b)}, c = {_text(c)}: a∧b = {_text(a ^ b)}, and swept along c "
        f"a∧b∧c = {swept:.4g} I, the volume with its sense, {sense}-handed (handout eq. 1.2 and 1.3).",
    )
    return figure


@in_our_look
def turned_vector(a: Multivector, B: Multivector, angle: float) -> Figure:
    """Figure 2: the vector a turned by an angle in rad in the plane and sense of the bivector B."""
    R = Rotor.from_plane_angle(B, angle)
    plane = B.normalized()
    figure, axes = _picture("A vector turned in the plane B: a' = R a ~R")
    view = View(20, 24)
    turned, within, across = R(a), a.project(plane), a.reject(plane)
    _draw_plane(axes, view, plane, 1.25 * float(within.norm()))
    partial = Rotor.from_plane_angle(B, angle * np.linspace(0, 1, 61))
    powers = partial(within).components
    _draw_sector(axes, view, 0.45 * powers)
    for start in (within, R(within)):
        ends = view.project(np.stack([start.components, (start + across).components]))
        axes.plot(*ends.T, color=FAINT, lw=1.0, ls=(0, (3, 2)), zorder=4)
    tips = powers + across.components
    axes.plot(*view.project(tips).T, color=_ORANGE, lw=1.0, ls=(0, (1, 1.5)), zorder=4)
    zero = np.zeros(3)
    for value, colour, name, width, offset in (
        (within, FAINT, "a∥", 1.2, (-3, -13)),
        (R(within), FAINT, "a'∥", 1.2, (8, -9)),
        (across, _GREEN, "a⊥ = a'⊥", 1.4, (-6, 8)),
        (a, _BLUE, "a", 1.9, (-10, 4)),
        (turned, _ORANGE, "a' = R a ~R", 1.9, (9, 3)),
    ):
        tip = np.asarray(value.components)
        _arrow(axes, view, zero, tip, colour, width)
        _write(axes, view, tip, name, WEIGHT if colour == FAINT else colour, offset)
    _write(axes, view, 0.58 * powers[len(powers) // 2], "θ", _BLACK)
    tips_of = np.stack([a.components, turned.components, across.components])
    rim = _rim(plane, 1.25 * float(within.norm()))
    frame_picture(axes, view.project(np.concatenate([rim, tips_of])), 0.22)
    explain(
        figure,
        f"B = {_text(plane)} with B² = {_text(plane | plane)}, θ = {np.degrees(angle):.4g}°, "
        f"R = {_text(R)}. a = {_text(a)} goes to a' = {_text(turned)}: the part a∥ = (a·B) B⁻¹ in the plane "
        f"turns by θ in its sense, a⊥ = (a∧B) B⁻¹ does not change (handout eq. 2.4).",
    )
    return figure


@in_our_look
def inertia_of_plane(body: Body, lengths: Any, B: Multivector) -> Figure:
    """Figure 3: the inertia map of a box takes the plane of rotation B to I(B), in general another plane."""
    L = body.inertia(B)
    figure, axes = _picture("The inertia tensor takes the plane of rotation B to I(B)")
    view = View(32, 20)
    half = np.asarray(lengths) / float(np.linalg.norm(lengths))
    _draw_box(axes, view, half)
    for k in range(3):
        _arrow_from_box(axes, view, 1.55 * np.eye(3)[k], half, _AXES[k], 1.7)
        _write(axes, view, 1.67 * np.eye(3)[k], f"e{'₁₂₃'[k]}", _AXES[k])
    largest = float(body.inertia.principal_moments.max())
    for value, most, colour, name, offset in (
        (B, float(B.norm()), OMEGA, "B", (-13, 0)),
        (L, largest * float(B.norm()), MOMENTUM, "I(B)", (18, 0)),
    ):
        rim = _rim(value, 1.45 * float(np.sqrt(float(value.norm()) / most)))
        _draw_disc_through_box(axes, view, rim, half, colour)
        _arrow_from_box(axes, view, 1.2 * value.dual().normalized().components, half, colour, 1.3)
        across = view.project(rim)[:, 0] * np.sign(offset[0])
        _write(axes, view, rim[int(np.argmax(across))], name, colour, offset)
    frame_picture(axes, np.array([[-1.75, -1.55], [1.75, 1.75]]), 0.0)
    cosine = float(-(B | L)) / float(B.norm() * L.norm())
    meet = np.degrees(np.arccos(cosine))
    i = ", ".join(f"{x:.4g}" for x in body.inertia.principal_moments)
    explain(
        figure,
        f"A box with the moments {i} kg m²: B = {_text(B)} rad/s goes to I(B) = {_text(L)} kg m²/s, each "
        f"component by its own moment (handout eq. 4.18 and 4.24). The planes meet at {meet:.4g}°. "
        f"Areas are proportional to |B| and |I(B)|; the thin arrows are their duals.",
    )
    return figure


def handout_figure(number: int) -> Figure:
    """Return figure 1, 2 or 3 of the handout, with example values."""
    if number == 1:
        return swept_trivector(0.15 * e1 + 1.5 * e2, -1.2 * e1 + 0.15 * e2, -0.1 * e1 + 0.4 * e2 + 1.05 * e3)
    if number == 2:
        B = (e1 ^ e2) + 0.12 * (e2 ^ e3)
        return turned_vector(1.0 * e1 - 0.35 * e2 + 0.75 * e3, B, np.radians(75))
    lengths = [0.6, 0.9, 1.8]
    body = Body.box(lengths, mass=12)
    return inertia_of_plane(body, lengths, 0.3 * (e2 ^ e3) + 0.25 * (e3 ^ e1) + 0.8 * (e1 ^ e2))


# --- parts of the pictures


def _picture(title: str) -> tuple[Figure, Axes]:
    figure = new_figure(5.2, 4.8)
    entitle(figure, title)
    return figure, figure.add_subplot()


def _text(value: Multivector) -> str:
    """Return a value with few digits, subscripts, and no line break before a blade."""
    text = repr(value.map(np.vectorize(lambda x: float(f"{x:.4g}"))))
    for k in "123":
        text = text.replace(f"e{k}", f"e{'₁₂₃'[int(k) - 1]}")
    return text.replace("-", "−").replace(" e", "\u00a0e")


def _arrow(
    axes: Axes, view: View, start: Array, end: Array, colour: str, width: float = 1.7, zorder: int = 6
) -> None:
    flat = view.project(np.stack([start, end]))
    arrow = _arrowprops(colour, width, 13)
    axes.annotate("", xy=flat[1], xytext=flat[0], arrowprops=arrow, zorder=zorder)


def _write(
    axes: Axes, view: View, place: Array, text: str, colour: str, offset: tuple[float, float] = (0, 0)
) -> None:
    halo = optional("matplotlib.patheffects", "plot", "a figure").withStroke(
        linewidth=2.4, foreground="white"
    )
    x, y = view.project(place)
    axes.annotate(
        text, (x, y), xytext=offset, textcoords="offset points", color=colour, fontsize=11,
        ha="center", va="center", zorder=50, path_effects=[halo],
    )  # fmt: skip


def _draw_parallelepiped(axes: Axes, view: View, edges: Array) -> None:
    """Draw the solid of three edges (3, 3) with its swept face at four places; edges behind are dashed."""
    a, b, c = edges
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    base = square @ edges[:2]
    for share, strength in ((1.0, 0.10), (2 / 3, 0.07), (1 / 3, 0.07), (0.0, 0.30)):
        flat = view.project(base + share * c)
        axes.fill(*flat.T, facecolor=_ORANGE, edgecolor="none", alpha=strength, zorder=2)
        if 0 < share < 1:
            axes.fill(*flat.T, facecolor="none", edgecolor=_ORANGE, lw=0.5, alpha=0.5, zorder=2)
    hand = np.sign(np.linalg.det(edges))
    # For each edge vector, whether the face at its end, and not that at its start, is towards us.
    at_end = [float(hand * np.cross(*others) @ view.toward) > 0 for others in ((b, c), (c, a), (a, b))]
    for k in range(3):
        first, second = (k + 1) % 3, (k + 2) % 3
        for i in (0, 1):
            for j in (0, 1):
                start = i * edges[first] + j * edges[second]
                hidden = (bool(i) != at_end[first]) and (bool(j) != at_end[second])
                style: dict[str, Any] = (
                    {"lw": 0.8, "ls": (0, (3, 2)), "alpha": 0.6} if hidden else {"lw": 1.1}
                )
                ends = view.project(np.stack([start, start + edges[k]]))
                axes.plot(*ends.T, color=_BLACK, zorder=3, solid_capstyle="round", **style)


def _arrowprops(colour: str, width: float, head: float) -> dict[str, Any]:
    """Return the properties of an arrow that ends exactly at its points."""
    return {
        "arrowstyle": "-|>",
        "color": colour,
        "lw": width,
        "shrinkA": 0,
        "shrinkB": 0,
        "mutation_scale": head,
    }


def _draw_turn(axes: Axes, view: View, center: Array, first: Array, second: Array, colour: str) -> None:
    """Draw the sense of a bivector: an arrow about a point from `first` towards `second`."""
    s = np.linspace(0.35, 2 * np.pi - 0.35, 90)[:, np.newaxis]
    flat = view.project(center + 1.35 * (np.cos(s) * first + np.sin(s) * second))
    axes.plot(*flat.T, color=colour, lw=1.5, zorder=5)
    arrow = _arrowprops(colour, 1.5, 12)
    axes.annotate("", xy=flat[-1], xytext=flat[-8], arrowprops=arrow, zorder=5)


def _rim(plane: Multivector, radius: float) -> Array:
    """Return points (361, 3) of a circle about the origin, in the plane and sense of a bivector."""
    turn = Rotor.from_vectors(e3, plane.dual() / plane.norm())
    s = np.linspace(0, 2 * np.pi, 361)[:, np.newaxis]
    rim: Array = radius * (np.cos(s) * turn(e1).components + np.sin(s) * turn(e2).components)
    return rim


# --- a box about the origin with half-lengths (3,), and arrows and discs from its centre. A ray that leaves
# the box through a face towards us is in front of it (z-orders from 4 on), others are behind it.


def _draw_box(axes: Axes, view: View, half: Array) -> None:
    """Draw the three faces towards us."""
    sides = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    for k, shade in enumerate(("#B9C2CF", "#838B95", "#C4CCDB")):
        corners = np.empty((4, 3))
        corners[:, k] = np.copysign(half[k], view.toward[k])
        others = [(k + 1) % 3, (k + 2) % 3]
        corners[:, others] = sides * half[others]
        axes.fill(*view.project(corners).T, facecolor=shade, edgecolor=_BLACK, lw=0.9, zorder=3)


def _leaving(view: View, points: Array, half: Array) -> tuple[Array, Any]:
    """Return where rays to points (n, 3) leave the box, and whether through a face towards us."""
    shares = np.abs(points) / half
    face = shares.argmax(axis=1)
    rows = np.arange(len(points))
    return points / shares[rows, face, np.newaxis], points[rows, face] * view.toward[face] > 0


def _arrow_from_box(axes: Axes, view: View, tip: Array, half: Array, colour: str, width: float) -> None:
    (start,), (ours,) = _leaving(view, tip[np.newaxis], half)
    _arrow(axes, view, start, tip, colour, width, zorder=6 if ours else 1)


def _draw_disc_through_box(axes: Axes, view: View, rim: Array, half: Array, colour: str) -> None:
    """Draw an oriented disc from its rim: one half behind the box, one in front, without what is inside."""
    inner, ours = _leaving(view, rim[:-1], half)
    start = int(np.flatnonzero(ours & ~np.roll(ours, 1))[0])
    arrow = _arrowprops(colour, 1.8, 16)
    for first, zorder, inside in ((start, 4, inner), (start + 180, 1, 0 * inner)):
        chosen = (first + np.arange(181)) % 360
        outer = view.project(rim[chosen])
        outline = np.concatenate([outer, view.project(inside[chosen])[::-1]])
        axes.fill(*outline.T, facecolor=colour, edgecolor="none", alpha=0.2, zorder=zorder)
        axes.plot(*outer.T, color=colour, lw=1.8, zorder=zorder + 1)
        for k in (70, 150) if zorder == 4 else (90,):
            axes.annotate("", xy=outer[k + 4], xytext=outer[k], arrowprops=arrow, zorder=zorder + 1)


def _draw_plane(axes: Axes, view: View, plane: Multivector, radius: float) -> None:
    rim = _rim(plane, radius)
    flat = view.project(rim)
    axes.fill(*flat.T, facecolor="#EEF1F5", edgecolor=FAINT, lw=1.0, zorder=0)
    arrow = _arrowprops(FAINT, 1.2, 15)
    for k in (40, 160, 280):
        axes.annotate("", xy=flat[k + 6], xytext=flat[k], arrowprops=arrow, zorder=1)
    lowest = int(np.argmin(flat[:, 1] - 0.6 * flat[:, 0]))
    _write(axes, view, rim[lowest], "B", WEIGHT, (9, -9))


def _draw_sector(axes: Axes, view: View, points: Array) -> None:
    """Draw the angle between the first and the last of points (n, 3) about the origin."""
    flat = view.project(points)
    axes.fill(*np.concatenate([flat, [[0, 0]]]).T, facecolor=_ORANGE, edgecolor="none", alpha=0.18, zorder=2)
    axes.plot(*flat.T, color=_BLACK, lw=1.1, zorder=3)
    arrow = _arrowprops(_BLACK, 1.1, 10)
    axes.annotate("", xy=flat[-1], xytext=flat[-6], arrowprops=arrow, zorder=3)
