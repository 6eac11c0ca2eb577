"""Pictures on the pages of the handout; the build of the guides draws each with Polhode."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

import polhode as ph
from polhode import I, e1, e2, e3
from polhode._figures.camera import View
from polhode._figures.handout import handout_figure
from polhode._figures.palette import AXES, BLACK, BLUE, FAINT, GREEN, MOMENTUM, OMEGA, ORANGE, OTHERS
from polhode._figures.style import Sheet, dress

EXAMPLES = Path(__file__).parents[2] / "examples"
PLAIN = Sheet(caption=False)


class Space:
    """An orthographic picture of space; values are vectors and bivectors."""

    def __init__(self, size, azimuth=25.0, elevation=22.0):
        self.figure = Figure(figsize=size, layout="constrained")
        self.axes = self.figure.add_subplot()
        self.axes.set_aspect("equal")
        self.axes.set_axis_off()
        self.view = View(azimuth, elevation)

    def line(self, points, **style):
        self.axes.plot(*self.view.project(points).T, **style)

    def fill(self, points, colour, alpha):
        self.axes.fill(*self.view.project(points).T, facecolor=colour, edgecolor="none", alpha=alpha)

    def arrow(self, vector, colour, name="", start=None, offset=(8, 4), width=1.8):
        begin = np.zeros(3) if start is None else start.components
        flat = self.view.project(np.stack([begin, begin + vector.components]))
        self.axes.annotate("", xy=flat[1], xytext=flat[0], arrowprops=arrow(colour, width), zorder=6)
        self.axes.plot(*flat.T, lw=0)  # for the limits of the axes, which arrows do not extend
        if name:
            self.write(begin + vector.components, name, colour, offset)

    def write(self, point, text, colour=BLACK, offset=(0, 0)):
        self.axes.annotate(
            text,
            self.view.project(point),
            xytext=offset,
            textcoords="offset points",
            color=colour,
            fontsize=11,
            ha="center",
            va="center",
            zorder=50,
            path_effects=[withStroke(linewidth=2.5, foreground="white")],
        )

    def disc(self, plane, radius, colour, name="", toward=(1, 0), offset=(0, 0)):
        """Draw an oriented disc in the plane of a bivector; its name is where the rim reaches farthest."""
        first = e3.project(plane) if abs(float(plane.dual().dot(e3))) < 0.99 * float(plane.norm()) else e1
        first = first.normalized()
        second = first.dot(plane / plane.norm())
        s = np.linspace(0, 2 * np.pi, 181)[:, np.newaxis]
        rim = radius * (np.cos(s) * first.components + np.sin(s) * second.components)
        self.fill(rim, colour, 0.16)
        self.line(rim, color=colour, lw=1.4)
        flat = self.view.project(rim)
        for k in (30, 90, 150):
            self.axes.annotate("", xy=flat[k + 1], xytext=flat[k - 1], arrowprops=arrow(colour, 1.4))
        if name:
            self.write(rim[np.argmax(flat @ toward)], name, colour, offset)


def arrow(colour, width):
    """Return the look of an arrow that ends exactly at its points."""
    ends = {"shrinkA": 0, "shrinkB": 0, "mutation_scale": 13}
    return {"arrowstyle": "-|>", "color": colour, "lw": width, **ends}


def untitled(figure):
    """Return a figure without its title, which the page has."""
    figure.suptitle("")
    return figure


def volume():
    return untitled(handout_figure(1, PLAIN))


def turned_vector():
    return untitled(handout_figure(2, PLAIN))


def inertia_map():
    return untitled(handout_figure(3, PLAIN))


def vector_and_plane():
    """A vector above a plane: its part in the plane is turned by B, its part across sweeps B along."""
    space = Space((5.2, 3.3), azimuth=-62, elevation=24)
    B, a = 1.0 * (e1 ^ e2), 1.1 * e1 + 0.35 * e2 + 0.95 * e3
    space.disc(B, 1.55, FAINT, "$B$", (1, -0.4), (10, -6))
    inside, across, turned = a.project(B), a.reject(B), a.dot(B)
    corners = np.stack([inside.components, a.components])
    space.line(corners, color=FAINT, lw=1.0, ls=(0, (3, 2)))
    space.line(np.stack([across.components, a.components]), color=FAINT, lw=1.0, ls=(0, (3, 2)))
    angle = np.linspace(0, np.pi / 2, 40)[:, np.newaxis]
    arc = np.cos(angle) * inside.components + np.sin(angle) * turned.components
    space.line(0.35 * arc, color=BLACK, lw=1.0)
    space.arrow(inside, BLUE, r"$a_\parallel$", offset=(10, -9))
    space.arrow(across, GREEN, r"$a_\perp$", offset=(-12, 2))
    space.arrow(a, BLACK, "$a$", offset=(6, 7))
    space.arrow(turned, ORANGE, r"$a\cdot B=a_\parallel B$", offset=(6, 11))
    return space.figure


def three_planes():
    """The basis bivectors as oriented discs, with the vectors to which they are dual."""
    space = Space((5.2, 4.2), azimuth=38, elevation=26)
    space.disc(e2 ^ e3, 1.0, AXES[0], "$B_1=e_2e_3$", (-0.4, 1), (-30, 8))
    space.disc(e3 ^ e1, 1.0, AXES[1], "$B_2=e_3e_1$", (0.4, 1), (30, 8))
    space.disc(e1 ^ e2, 1.0, AXES[2], "$B_3=e_1e_2$", (0, -1), (0, -10))
    for axis, name, colour in zip((e1, e2, e3), ("$e_1$", "$e_2$", "$e_3$"), AXES, strict=True):
        space.arrow(1.35 * axis, colour, name, offset=(0, 10))
    return space.figure


def duality():
    """Two vectors, the plane that they span, and their cross product."""
    space = Space((5.0, 3.6), azimuth=-55, elevation=22)
    a, b = 1.5 * e1 + 0.1 * e2, 0.5 * e1 + 1.2 * e2
    corners = np.stack([(0 * a).components, a.components, (a + b).components, b.components])
    space.fill(corners, ORANGE, 0.2)
    space.line(np.concatenate([corners, corners[:1]]), color=ORANGE, lw=0.9)
    middle = 0.5 * (a + b)
    s = np.linspace(0.2, 5.6, 60)[:, np.newaxis]
    turn = middle.components + 0.28 * (np.cos(s) * e1.components + np.sin(s) * e2.components)
    space.line(turn, color=ORANGE, lw=1.3)
    space.arrow(ph.vector(turn[-1] - turn[-4]), ORANGE, start=ph.vector(turn[-4]), width=1.3)
    space.write(middle.components, r"$a\wedge b$", ORANGE)
    space.arrow(a, BLACK, "$a$", offset=(4, -9))
    space.arrow(b, BLACK, "$b$", offset=(9, 6))
    space.arrow(ph.cross(a, b), BLUE, r"$a\times b=-I\,a\wedge b$", offset=(2, 9))
    return space.figure


def product_table():
    """The products of all pairs of basis elements, coloured by grade, dark where the sign is −."""
    basis = [ph.scalar(1.0), e1, e2, e3, e2 * e3, e3 * e1, e1 * e2, I]
    names = ["1", "e_1", "e_2", "e_3", "e_2e_3", "e_3e_1", "e_1e_2", "I"]
    pale = ["#F7F1DC", *3 * ["#DCEAF5"], *3 * ["#FBE4D4"], "#DAF0E6"]
    dark = ["#E4D39A", *3 * ["#9CC4E0"], *3 * ["#F0B590"], "#93D1B6"]
    figure = Figure(figsize=(5.6, 4.0), layout="constrained")
    axes = figure.add_subplot()
    axes.set_axis_off()
    for row, left in enumerate(basis):
        for column, right in enumerate(basis):
            found = (left * right).dense()
            (place,) = np.flatnonzero(found)
            colours, sign = (dark, "−") if found[place] < 0 else (pale, "")
            square = np.add([column, row], [[0, 0], [1, 0], [1, 1], [0, 1]])
            axes.fill(*square.T, facecolor=colours[place], edgecolor="white", lw=1.0)
            name = f"{sign}${names[place]}$"
            axes.text(column + 0.5, row + 0.5, name, ha="center", va="center", fontsize=9)
    for k, name in enumerate(names):
        axes.text(k + 0.5, -0.45, f"${name}$", ha="center", va="center", fontsize=9)
        axes.text(-0.6, k + 0.5, f"${name}$", ha="center", va="center", fontsize=9)
    axes.set(xlim=(-1.2, 8.05), ylim=(8.05, -1.0))
    return figure


def equal_areas():
    """An orbit with sectors of equal times."""
    orbit = ph.torque.KeplerOrbit(1.0, eccentricity=0.6, mu=1.0)
    figure = Figure(figsize=(5.2, 3.4), layout="constrained")
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    axes.set_axis_off()
    path = np.stack([orbit.position(t).components for t in np.linspace(0, orbit.period, 400)])
    axes.plot(*path[:, :2].T, color=BLACK, lw=1.3)
    for k in range(12):
        times = np.linspace(k, k + 1, 30) * orbit.period / 12
        rim = np.stack([orbit.position(t).components for t in times])[:, :2]
        axes.fill(*np.concatenate([[[0, 0]], rim]).T, color=OMEGA if k % 2 else MOMENTUM, alpha=0.28, lw=0)
    axes.plot(0, 0, "o", color=ORANGE, ms=9)
    x, v = path[60][:2], (path[61] - path[59])[:2]
    for start, step, name in ((np.zeros(2), x, "$x$"), (x, 12 * v, "$p$")):
        axes.annotate("", start + step, start, arrowprops=arrow(BLACK, 1.6))
        axes.text(*(start + 0.55 * step + [0.03, 0.07]), name, fontsize=12)
    return figure


def double_cover():
    """A steady spin: the frame is back after one turn, the rotor after two."""
    turns = np.linspace(0, 2, 401)
    R = (-np.pi * turns * (e1 ^ e2)).exp()
    figure = Figure(figsize=(5.6, 3.0), layout="constrained")
    axes = figure.add_subplot(xlabel="turns of the body")
    axes.plot(turns, R(e1).components[..., 0], color=OTHERS, lw=1.6, label="$f_1\\cdot e_1$")
    axes.plot(turns, R.components[..., 0], color=BLUE, lw=1.8, label="scalar part of $R$")
    axes.plot(turns, R.components[..., -1], color=ORANGE, lw=1.8, label="$e_1e_2$ part of $R$")
    axes.set_xticks([0, 0.5, 1, 1.5, 2])
    axes.set_yticks([-1, 0, 1])
    dress(axes)
    figure.legend(loc="outside upper center", ncols=3, frameon=False)
    return figure


def polhode():
    return untitled(ph.Scene.read(EXAMPLES / "t-handle.toml").run().plot("polhode", caption=False))


def cones():
    """A free symmetric top: L at rest, the axis of the body and ω on cones about it."""
    space = Space((5.0, 4.0), azimuth=-60, elevation=16)
    body = ph.Inertia.from_principal_moments(1, 1, 1.8)
    top = ph.SymmetricTop(body, ph.Rotor.identity(), [1.0, 0, 0.9])
    tilt = ph.Rotor.from_vectors(top.omega_l.dual().normalized(), e3)  # L upright
    turn = 2 * np.pi / float(top.omega_l.norm())
    states = top.at(np.linspace(0, turn, 181))
    axis, spin = (tilt(values).components for values in (states.rotor(e3), states.omega_space.dual()))
    side = int(np.argmax(space.view.project(axis)[:, 0]))
    for path, colour, name in ((axis, BLUE, "$f_3$"), (spin, OMEGA, r"$\omega$")):
        space.line(path, color=colour, lw=1.5)
        space.fill(np.concatenate([path, path[:1]]), colour, 0.08)
        for k in range(0, 180, 15):
            space.line(np.stack([np.zeros(3), path[k]]), color=colour, lw=0.4, alpha=0.5)
        space.arrow(ph.vector(path[side]), colour, name, offset=(9, 5))
    space.arrow(1.75 * e3, MOMENTUM, "$L$", offset=(9, 2))
    return space.figure


def growth():
    """Three spins, each a thousandth of a radian off its axis: the angle between axis and ω over time."""
    body = ph.Body.box([0.24, 0.16, 0.04], mass=1).inertia
    figure = Figure(figsize=(5.6, 3.1), layout="constrained")
    axes = figure.add_subplot(xlabel="time in turns", ylabel="angle to the axis in rad")
    times = np.linspace(0, 4, 801)
    for k, name in enumerate(("longest side", "middle side", "shortest side")):
        spin = np.full(3, 1e-3)
        spin[k] = 1.0
        free = ph.FreeMotion(body, ph.Rotor.identity(), 2 * np.pi * spin)
        omega = free.at(times).omega_body.components
        off = np.arctan2(np.linalg.norm(np.delete(omega, k, axis=-1), axis=-1), omega[:, k])
        axes.semilogy(times, off, color=AXES[k], lw=1.6, label=f"about the {name}")
    dress(axes)
    figure.legend(loc="outside upper center", ncols=3, frameon=False, fontsize=8)
    return figure


def nutation():
    return untitled(ph.Scene.read(EXAMPLES / "nutating-top.toml").run().plot("locus", caption=False))


def start():
    """The motion of the first page: angular velocity and attitude over time."""
    return untitled(ph.Scene.read(EXAMPLES / "t-handle.toml").run().plot("motion", caption=False))
