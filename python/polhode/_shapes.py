"""The surface of a body, for drawing."""

from __future__ import annotations

import tomllib
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from polhode import _native
from polhode._arrays import Array
from polhode._bodies import Body
from polhode._kinds import weight
from polhode._surface_files import Mesh, read_surface
from polhode._values import vector

if TYPE_CHECKING:
    from polhode._trajectory import Trajectory

# Sides of what is round.
_SIDES = 48


class Surface(NamedTuple):
    """Vertices (n, 3) in body axes, from the point about which the body is drawn, and triangles (m, 3)."""

    vertices: Array
    faces: Any
    told: str


def surface_of(trajectory: Trajectory) -> Surface:
    """Return the surface that the scene says, about the centre of mass, or the fixed point of a held body.

    Where the motion tells moments alone, that of a simple body with the same ratios of them.
    """
    setting = trajectory._setting
    table = {} if setting is None or setting.text is None else tomllib.loads(setting.text)["body"]
    if "mesh" in table:
        assert setting is not None
        assert setting.path is not None
        vertices, faces = read_surface(setting.path.parent / table["mesh"])
        scale = _unit(table.get("length_unit", 1.0))
        own = Body.from_mesh(setting.path.parent / table["mesh"], mass=1.0, scale=scale).center_of_mass
        mesh, told = (scale * vertices, faces), "the mesh"
    elif "solid" in table:
        name = str(table["solid"])
        sizes = {key: _lengths(value) for key, value in table.items() if key in _SIZES}
        mesh, told = _SOLIDS[name](**sizes), f"the {name.replace('_', ' ')}"
        own = vector([0, 0, 0.25 * sizes["height"] if name == "cone" else 0.0])
    else:
        return _alike(trajectory)
    assert setting is not None
    assert setting.body is not None
    about = setting.body.center_of_mass if setting.held else vector([0, 0, 0])
    return Surface(mesh[0] + (about - own).components, mesh[1], told)


def _alike(trajectory: Trajectory) -> Surface:
    """Return a cone on its tip for a symmetric top, a box for any other body, with its ratios of moments."""
    moments = trajectory.inertia.principal_moments
    frame = trajectory.inertia.principal_frame.to_matrix()
    setting = trajectory._setting
    c = weight(setting.torque) if setting is not None and setting.held else np.zeros(3)
    along = np.abs(c @ frame)
    k = int(np.argmax(along))
    others = moments[[j for j in range(3) if j != k]]
    if along[k] > 0.999999 * np.linalg.norm(c) > 0 and np.ptp(others) <= 1e-9 * others.max():
        # A cone of height h and radius r has i3/i1 = 2 r²/(4 h² + r²) about its tip.
        height = float(np.sqrt(max(2 * others[0] / moments[k] - 1, 0.02))) / 2
        vertices, faces = _cone(radius=1.0, height=height)
        axis = c / np.linalg.norm(c)
        first = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
        first /= np.linalg.norm(first)
        turn = np.stack([first, np.cross(axis, first), axis], axis=1)
        # The tip, which is up, is to be the fixed point, and the base away from it along the axis.
        vertices = (vertices * [1, -1, -1] + [0, 0, height]) @ turn.T
        return Surface(vertices, faces, "a cone with its ratio of moments about the fixed point")
    squares = np.maximum(moments.sum() - 2 * moments, 0.0)
    lengths = np.maximum(np.sqrt(squares / squares.max()), 0.02)
    vertices, faces = box(lengths)
    about = " about the fixed point" if setting is not None and setting.held else ""
    return Surface(vertices @ frame.T, faces, f"a box with its ratios of moments{about}")


def _unit(value: Any) -> float:
    """Return the metres in a unit of length by its name, or in a length."""
    return _length(f"1 {value}" if isinstance(value, str) and value[:1].isalpha() else value)


def _lengths(value: Any) -> Any:
    return np.array([_length(x) for x in value]) if isinstance(value, list) else _length(value)


def _length(value: Any) -> float:
    """Return a length of a scene in m; the core has checked it."""
    if not isinstance(value, str):
        return float(value)
    found = _native.quantities(value, set())
    return found[0][2] if found else float(value)


# --- solids, centred on the origin with their axis along e3; the cone stands on e1∧e2


def box(lengths: Array) -> Mesh:
    vertices = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * lengths / 2
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return vertices, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def _ellipsoid(semi_axes: Array) -> Mesh:
    vertices, faces = _sphere(1.0)
    return vertices * semi_axes, faces


def _sphere(radius: float) -> Mesh:
    s = np.linspace(0, np.pi, _SIDES // 2 + 1)
    return _revolved(radius * np.sin(s), -radius * np.cos(s))


def _hollow_sphere(outer_radius: float, inner_radius: float) -> Mesh:
    return _sphere(outer_radius)


def _cylinder(radius: float, height: float) -> Mesh:
    return _revolved(
        *_profile([(0, -height / 2), (radius, -height / 2), (radius, height / 2), (0, height / 2)])
    )


def _cone(radius: float, height: float) -> Mesh:
    return _revolved(*_profile([(0, 0), (radius, 0), (0, height)]))


def _disc(radius: float) -> Mesh:
    return _cylinder(radius, radius / 40)


def _capsule(radius: float, height: float) -> Mesh:
    s = np.linspace(0, np.pi / 2, _SIDES // 4 + 1)
    side = _profile([(radius, -height / 2), (radius, height / 2)])
    r = np.concatenate([radius * np.sin(s), side[0][1:-1], radius * np.cos(s)])
    z = np.concatenate([-height / 2 - radius * np.cos(s), side[1][1:-1], height / 2 + radius * np.sin(s)])
    return _revolved(r, z)


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
    "cone": _cone,
    "disc": _disc,
    "torus": _torus,
    "capsule": _capsule,
}
_SIZES = (
    "lengths",
    "semi_axes",
    "radius",
    "outer_radius",
    "inner_radius",
    "height",
    "major_radius",
    "minor_radius",
)
