"""glTF 2.0 animations of a body (.glb and .gltf)."""

from __future__ import annotations

import base64
import json
import os
import struct
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from polhode import _native
from polhode._io.history import AttitudeHistory
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.trajectory import Trajectory
from polhode._support.arrays import Array
from polhode._support.calls import explains_calls
from polhode._support.files import write_atomically

# Constants of glTF: component types, and targets of buffer views.
_FLOAT, _UINT = 5126, 5125
_VERTICES, _INDICES = 34962, 34963
# glTF has +Y up: space is turned so that its e3 is up.
_UP = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]
_MATERIAL = {"pbrMetallicRoughness": {"baseColorFactor": [0.55, 0.6, 0.7, 1.0], "metallicFactor": 0.1}}
# Corners of a cube of side 2, and its faces, counter-clockwise seen from outside.
_CORNERS = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
_FACES = [
    *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]),
    *([2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
]


@explains_calls
def write_gltf(
    motion: Trajectory | AttitudeHistory,
    path: str | os.PathLike[str],
    *,
    surface: tuple[Any, Any] | None = None,
    mass: float | None = None,
) -> None:
    """Write an animation of one body as glTF 2.0, atomically: FILE.glb (binary) or FILE.gltf (text).

    The node ``body`` carries the mesh and two tracks, its rotation and its translation, at the output times,
    from the first one on; it is a child of the node ``space``, which turns e3 up. Numbers are stored as
    float32, as glTF requires.

    Parameters
    ----------
    surface
        Vertices (n, 3) in m and triangles (m, 3), counter-clockwise seen from outside, in body axes through
        the point whose position the motion has: the centre of mass, or the fixed point. `Scene.surface`,
        `read_mesh` and `solid_surface` return such surfaces. By default a box with the same principal
        moments as the body, in its principal axes.
    mass
        Mass of the box in kg. By default, the longest side of the box is 1 m.

    Raises
    ------
    ValueError
        For a batch, fewer than two output times, another suffix, and a motion with neither inertia nor
        surface.
    OSError
        If the file cannot be written; an older file stays.

    Warns
    -----
    UserWarning
        If the body turns by more than half a turn between output times, so that the animation shows another
        motion.

    Examples
    --------
    A tumbling cylinder, for Blender or a browser:

    >>> body = ph.Body.cylinder(0.1, 0.5, mass=1)
    >>> start = ph.State(ph.Rotor.identity(), [1, 0, 2])
    >>> motion = ph.simulate(body, start, np.linspace(0, 5, 51))
    >>> shape = ph.io.solid_surface("cylinder", 0.1, 0.5)
    >>> ph.io.write_gltf(motion, "cylinder.glb", surface=shape)
    >>> with open("cylinder.glb", "rb") as file:
    ...     file.read(4)
    b'glTF'
    """
    form = Path(path).suffix.lower()
    if form not in (".glb", ".gltf"):
        raise ValueError(f"an animation is saved as FILE.glb or FILE.gltf, not {os.fspath(path)!r}")
    history = AttitudeHistory.of(motion)
    if len(history) < 2:
        raise ValueError(f"an animation needs two output times or more, got {len(history)}")
    vertices, triangles = _box(history.inertia, mass) if surface is None else _checked(surface)
    tree, binary = _tree(history, vertices, triangles)
    write_atomically({Path(path): _glb(tree, binary) if form == ".glb" else _text(tree, binary)})


def _tree(history: AttitudeHistory, vertices: Array, triangles: Any) -> tuple[dict[str, Any], bytes]:
    """Return the JSON of a file, and its buffer."""
    times = _times(history)
    _warn_of_fast_turns(history)
    buffer = _Buffer()
    mesh = _mesh(buffer, vertices, triangles)
    tracks = _tracks(history)
    animation = _animation(buffer, times, tracks)
    title = history.attributes.get("title")
    tree: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": f"Polhode {_native.__version__}"},
        "scene": 0,
        "scenes": [{"nodes": [0], **({"name": str(title)} if title else {})}],
        "nodes": [
            {"name": "space", "rotation": _UP, "children": [1]},
            {"name": "body", "mesh": 0, **{path: rows[0].tolist() for path, rows in tracks.items()}},
        ],
        "meshes": [mesh],
        "materials": [_MATERIAL],
        "animations": [animation],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.content)}],
    }
    return tree, bytes(buffer.content)


class _Buffer:
    """The binary content of a file, with the views and accessors that describe it."""

    def __init__(self) -> None:
        self.content = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def add(self, numbers: Any, kind: str, target: int | None = None, bounds: bool = False) -> int:
        """Add numbers, and return their accessor; all have 4 bytes, so every view is aligned."""
        rows = numbers.reshape(len(numbers), -1)
        view = {"buffer": 0, "byteOffset": len(self.content), "byteLength": numbers.nbytes}
        self.views.append(view if target is None else {**view, "target": target})
        self.content += numbers.tobytes()
        component = _UINT if numbers.dtype.kind == "u" else _FLOAT
        facts = {
            "bufferView": len(self.views) - 1,
            "componentType": component,
            "count": len(rows),
            "type": kind,
        }
        if bounds:
            facts |= {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        self.accessors.append(facts)
        return len(self.accessors) - 1


def _times(history: AttitudeHistory) -> Any:
    """Return the output times from the first one on, as float32."""
    times = (history.time - history.time[0]).astype("<f4")
    if (np.diff(times) <= 0).any():
        raise ValueError("output times are too close for the 32-bit floats of glTF; give fewer of them")
    return times


def _tracks(history: AttitudeHistory) -> dict[str, Array]:
    """Return what moves the node of the body: its rotations, as xyzw, and its translations."""
    still = np.zeros((len(history), 3))
    positions = still if history.position is None else history.position.components
    quaternions = np.asarray(history.rotor.normalized().to_quaternion(order="xyzw"))
    return {"rotation": quaternions, "translation": np.asarray(positions)}


def _mesh(buffer: _Buffer, vertices: Array, triangles: Any) -> dict[str, Any]:
    corners = buffer.add(vertices.astype("<f4"), "VEC3", _VERTICES, bounds=True)
    indices = buffer.add(np.ascontiguousarray(triangles, "<u4").ravel(), "SCALAR", _INDICES)
    return {"primitives": [{"attributes": {"POSITION": corners}, "indices": indices, "material": 0}]}


def _animation(buffer: _Buffer, times: Any, tracks: dict[str, Array]) -> dict[str, Any]:
    when = buffer.add(times, "SCALAR", bounds=True)
    outputs = [buffer.add(rows.astype("<f4"), f"VEC{rows.shape[-1]}") for rows in tracks.values()]
    return {
        "name": "motion",
        "samplers": [{"input": when, "output": k, "interpolation": "LINEAR"} for k in outputs],
        "channels": [{"sampler": k, "target": {"node": 1, "path": path}} for k, path in enumerate(tracks)],
    }


def _warn_of_fast_turns(history: AttitudeHistory) -> None:
    """Warn of steps with more than half a turn, which a viewer shows as the shorter turn the other way."""
    if history.omega_body is None:
        return
    rates = np.asarray(history.omega_body.norm())
    turns = np.maximum(rates[1:], rates[:-1]) * np.diff(history.time)
    if (turns > np.pi).any():
        k = int(np.argmax(turns))
        warnings.warn(
            f"the body turns by {np.degrees(turns[k]):.0f}° between output times {k} and {k + 1}, and an "
            "animation shows the shorter turn; give more output times",
            stacklevel=4,
        )


def _box(inertia: Inertia | None, mass: float | None) -> tuple[Array, Any]:
    """Return the surface of a box with the moments of a body: ``I1 = m (b² + c²)/12``, and so on."""
    if inertia is None:
        raise ValueError("the shape of the body is not known; give surface=(vertices, triangles)")
    moments = np.asarray(inertia.principal_moments)
    squares = np.maximum(moments.sum() - 2 * moments, 0.0)  # of the sides, times m/6
    sides = np.sqrt(squares * (6 / mass if mass else 1.0 / squares.max()))
    sides = np.maximum(sides, 1e-3 * sides.max())  # a rod or a plate stays visible
    return np.asarray(inertia.principal_frame.to_matrix() @ (_CORNERS * sides / 2).T).T, np.array(_FACES)


def _checked(surface: tuple[Any, Any]) -> tuple[Array, Any]:
    if not isinstance(surface, tuple | list) or len(surface) != 2:
        raise TypeError(f"surface must be (vertices, triangles), got {type(surface).__name__}")
    vertices, triangles = (np.asarray(x) for x in surface)
    if vertices.ndim != 2 or vertices.shape[1:] != (3,) or not np.isfinite(vertices.astype(float)).all():
        raise ValueError(f"vertices must be finite numbers of shape (n, 3), got shape {vertices.shape}")
    if (
        triangles.ndim != 2
        or triangles.shape[1:] != (3,)
        or triangles.dtype.kind not in "iu"
        or not len(triangles)
    ):
        raise ValueError(
            f"triangles must be integers of shape (m, 3), got {triangles.dtype} {triangles.shape}"
        )
    if triangles.min() < 0 or triangles.max() >= len(vertices):
        raise ValueError(f"triangles must be numbers of the {len(vertices)} vertices, from 0")
    return vertices.astype(float), triangles


def _glb(tree: dict[str, Any], binary: bytes) -> bytes:
    text = _json(tree)
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = b"".join(
        struct.pack("<I4s", len(content), kind) + content
        for kind, content in ((b"JSON", text), (b"BIN\0", binary))
    )
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _text(tree: dict[str, Any], binary: bytes) -> bytes:
    data = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    return _json({**tree, "buffers": [{**tree["buffers"][0], "uri": data}]}) + b"\n"


def _json(tree: dict[str, Any]) -> bytes:
    return json.dumps(tree, separators=(",", ":"), allow_nan=False).encode()
