"""The surface of a body, for drawing."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from polhode._algebra.constructors import e3, vector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.bodies import Body
from polhode._report.describe import weight
from polhode._scene.scene import Scene
from polhode._support.arrays import Array

if TYPE_CHECKING:
    from polhode._mechanics.trajectory import Trajectory

Mesh = tuple[Array, Any]  # vertices (n, 3), faces (m, 3) of whole numbers

# Sides of what is round.
_SIDES = 48
# Distances from its axis and heights of a spinning top.
_TOP = (
    (0, 0),
    (0.025, 0.03),
    (0.1, 0.24),
    (0.3, 0.54),
    (0.54, 0.78),
    (0.66, 0.96),
    (0.64, 1.1),
    (0.46, 1.22),
    (0.16, 1.3),
    (0.055, 1.38),
    (0.05, 1.6),
    (0, 1.63),
)


class Surface(NamedTuple):
    """Vertices (n, 3) in body axes, from the point about which the body is drawn, and triangles (m, 3).

    `tints` (m,) tell faces apart so that one sees how the body turns: 0 plain, 1 the other quadrants of what
    is round, 2 to 4 the sides of a box across its axes. `center` (3,) is the centre of mass.
    """

    vertices: Array
    faces: Any
    tints: Any
    center: Array
    told: str


def surface_of(trajectory: Trajectory) -> Surface:
    """Return the surface that the scene says, about the centre of mass, or the fixed point of a held body.

    Where the motion tells moments alone, that of a simple body, as large as one likes.
    """
    scene = trajectory._origin
    if not isinstance(scene, Scene):
        return _made_up(trajectory)
    own = scene.body.center_of_mass.components
    center, shift = (own, scene.shift) if scene.held else (np.zeros(3), scene.shift - own)
    if (mesh := scene.surface()) is not None:
        vertices, faces = mesh
        return Surface(vertices - scene.shift + shift, faces, np.zeros(len(faces), int), center, "the mesh")
    if scene.solid is None:
        return _made_up(trajectory)
    sizes = dict(scene.solid)
    kind = sizes.pop("kind")
    vertices, faces = _SOLIDS[kind](**sizes)
    tints = (_sides if kind == "box" else _quadrants)(vertices, faces)
    return Surface(vertices + shift, faces, tints, center, f"the {kind.replace('_', ' ')}")


def _made_up(trajectory: Trajectory) -> Surface:
    """Return a box, or a ball, with the ratios of moments; of a held body a top, or the box at the weight."""
    setting = trajectory._origin
    arm = np.zeros(3)
    if setting is not None and setting.held:
        known = setting.body.center_of_mass.components if isinstance(setting.body, Body) else np.zeros(3)
        arm = known if known.any() else weight(setting.torque)
    moments, frame = trajectory.inertia.principal_moments, trajectory.inertia.principal_frame.to_matrix()
    length = float(np.linalg.norm(arm))
    k = int(np.argmax(np.abs(arm @ frame)))
    others = np.delete(moments, k)
    if length and abs(arm @ frame[:, k]) > 0.999 * length and np.ptp(others) <= 1e-6 * others.max():
        vertices, faces = _spinning_top()
        turn = Rotor.from_vectors(e3, vector(arm / length)).to_matrix()
        return Surface(
            length * vertices @ turn.T, faces, _quadrants(vertices, faces), arm, "drawn as a spinning top"
        )
    squares = np.maximum(moments.sum() - 2 * moments, 0.0)
    lengths = np.maximum(np.sqrt(squares / squares.max()), 0.02)
    ball = bool(lengths.min() > 0.95)
    vertices, faces = _ellipsoid(lengths / 2) if ball else box(lengths)
    tints = (_quadrants if ball else _sides)(vertices, faces)
    size = 0.6 * length / float(np.linalg.norm(vertices, axis=1).max()) if length else 1.0
    told = f"drawn as a {'ball' if ball else 'box'} with its ratios of moments"
    return Surface(size * vertices @ frame.T + arm, faces, tints, arm, told)


def _sides(vertices: Array, faces: Any) -> Any:
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return 2 + np.abs(np.cross(b - a, c - a)).argmax(axis=1)


def _quadrants(vertices: Array, faces: Any) -> Any:
    x, y, _ = vertices[faces].mean(axis=1).T
    return np.where(x * y > 0, 1, 0)


# --- solids, centred on the origin with their axis along e3; the cone stands on e1∧e2


def box(lengths: Any) -> Mesh:
    vertices = (
        np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * np.asarray(lengths) / 2
    )
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return vertices, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def _ellipsoid(semi_axes: Any) -> Mesh:
    vertices, faces = _sphere(1.0)
    return vertices * np.asarray(semi_axes), faces


def _sphere(radius: float) -> Mesh:
    s = np.linspace(0, np.pi, _SIDES // 2 + 1)
    return _revolved(radius * np.sin(s), -radius * np.cos(s))


def _hollow_sphere(outer_radius: float, inner_radius: float) -> Mesh:
    return _sphere(outer_radius)


def _cylinder(radius: float, height: float) -> Mesh:
    return _revolved(
        *_profile([(0, -height / 2), (radius, -height / 2), (radius, height / 2), (0, height / 2)])
    )


def _rod(length: float) -> Mesh:
    return _cylinder(0.03 * length, length)


def cone(radius: float, height: float) -> Mesh:
    return _revolved(*_profile([(0, 0), (radius, 0), (0, height)]))


def _disc(radius: float) -> Mesh:
    return _cylinder(radius, radius / 40)


def _capsule(radius: float, height: float) -> Mesh:
    s = np.linspace(0, np.pi / 2, _SIDES // 4 + 1)
    side = _profile([(radius, -height / 2), (radius, height / 2)])
    r = np.concatenate([radius * np.sin(s), side[0][1:-1], radius * np.cos(s)])
    z = np.concatenate([-height / 2 - radius * np.cos(s), side[1][1:-1], height / 2 + radius * np.sin(s)])
    return _revolved(r, z)


def _spinning_top() -> Mesh:
    """Return a top with its tip at the origin and its centre of mass at height 1 on e3."""
    points = np.array([_TOP[0], *_TOP, _TOP[-1]])
    before, start, end, after = (points[k : len(points) - 3 + k, np.newaxis] for k in range(4))
    t = np.linspace(0, 1, 4, endpoint=False)[:, np.newaxis]
    # Catmull's and Rom's curve through the points.
    curve = start + 0.5 * t * (
        end
        - before
        + t * (2 * before - 5 * start + 4 * end - after + t * (3 * (start - end) + after - before))
    )
    r, z = np.concatenate([curve.reshape(-1, 2), points[-1:]]).T
    return _revolved(np.maximum(r, 0.0), z)


def _torus(major_radius: float, minor_radius: float) -> Mesh:
    s, t = np.meshgrid(*(np.linspace(0, 2 * np.pi, n, endpoint=False) for n in (_SIDES, 24)), indexing="ij")
    r = major_radius + minor_radius * np.cos(t)
    vertices = np.stack([r * np.cos(s), r * np.sin(s), minor_radius * np.sin(t)], axis=-1).reshape(-1, 3)
    numbers = np.arange(_SIDES * 24).reshape(_SIDES, 24)
    return vertices, _quads(np.pad(numbers, ((0, 1), (0, 1)), mode="wrap"))


def _profile(corners: list[tuple[float, float]]) -> tuple[Array, Array]:
    """Return the distances and heights of points along straight lines, close enough for what is drawn."""
    points = np.array(corners, float)
    size = np.abs(points).max()
    parts = [points[:1]]
    for a, b in pairwise(points):
        n = int(np.ceil(np.linalg.norm(b - a) / (0.25 * size)))
        parts.append(a + (b - a) * np.linspace(0, 1, n + 1)[1:, np.newaxis])
    r, z = np.concatenate(parts).T
    return r, z


def _revolved(r: Array, z: Array) -> Mesh:
    """Return the surface of a profile (n,) turned about e3; it goes from the lower end on the axis up."""
    s = np.linspace(0, 2 * np.pi, _SIDES, endpoint=False)[:, np.newaxis]
    ring = np.stack(
        [r[1:-1] * np.cos(s), r[1:-1] * np.sin(s), np.broadcast_to(z[1:-1], (_SIDES, len(r) - 2))]
    )
    vertices = np.concatenate([ring.reshape(3, -1).T, [[0, 0, z[0]], [0, 0, z[-1]]]])
    numbers = np.arange(_SIDES * (len(r) - 2)).reshape(_SIDES, -1)
    numbers = np.concatenate([numbers, numbers[:1]])
    low, high = len(vertices) - 2, len(vertices) - 1
    caps = [(low, numbers[k + 1, 0], numbers[k, 0]) for k in range(_SIDES)]
    caps += [(high, numbers[k, -1], numbers[k + 1, -1]) for k in range(_SIDES)]
    return vertices, np.concatenate([_quads(numbers), np.array(caps)])


def _quads(numbers: Any) -> Any:
    """Return the triangles of a grid of vertices (n, m), whose first index goes to the right from outside."""
    a, b, c, d = numbers[:-1, :-1], numbers[1:, :-1], numbers[1:, 1:], numbers[:-1, 1:]
    triangles = np.stack([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)])
    return triangles.reshape(-1, 3)


_SOLIDS: dict[str, Any] = {
    "box": box,
    "ellipsoid": _ellipsoid,
    "sphere": _sphere,
    "hollow_sphere": _hollow_sphere,
    "cylinder": _cylinder,
    "rod": _rod,
    "cone": cone,
    "disc": _disc,
    "torus": _torus,
    "capsule": _capsule,
}
