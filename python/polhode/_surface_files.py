"""The triangles of a mesh file, for drawing; the core has read and checked the file before."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from polhode._arrays import Array

Mesh = tuple[Array, Any]  # vertices (n, 3), faces (m, 3) of whole numbers


def read_surface(path: Path) -> Mesh:
    """Return vertices (n, 3) and triangles (m, 3) of a file that `Body.from_mesh` accepts."""
    content = path.read_bytes()
    if content.startswith(b"ply"):
        return _ply(content)
    start = content.lstrip()[:5].lower()
    if start == b"solid" and b"\0" not in content:
        return _text_stl(content)
    return _obj(content) if b"\0" not in content else _binary_stl(content)


def _binary_stl(content: bytes) -> Mesh:
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    corners = np.frombuffer(content, record, offset=84)["corners"]
    return _welded(corners.reshape(-1, 3).astype(float))


def _text_stl(content: bytes) -> Mesh:
    lines = (line.split() for line in content.splitlines())
    rows = [line[1:4] for line in lines if line and line[0].lower() == b"vertex"]
    return _welded(np.array(rows, float))


def _welded(corners: Array) -> Mesh:
    """Corners (3m, 3) at equal coordinates are one vertex."""
    vertices, faces = np.unique(corners, axis=0, return_inverse=True)
    return vertices, faces.reshape(-1, 3)


def _obj(content: bytes) -> Mesh:
    vertices: list[list[float]] = []
    faces: list[tuple[int, ...]] = []
    for line in content.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ").splitlines():
        match line.partition(b"#")[0].split():
            case [b"v", x, y, z, *_]:
                vertices.append([float(x), float(y), float(z)])
            case [b"f", *corners]:
                numbers = [int(corner.partition(b"/")[0]) for corner in corners]
                faces += _fan([k - 1 if k > 0 else len(vertices) + k for k in numbers])
    return np.array(vertices), np.array(faces)


def _fan(corners: Any) -> list[tuple[int, ...]]:
    """Return the triangles of a polygon."""
    return [(corners[0], corners[k], corners[k + 1]) for k in range(1, len(corners) - 1)]


# --- PLY

_TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}


class _Numbers:
    """The numbers after the header of a PLY, one by one."""

    def __init__(self, form: str, content: bytes) -> None:
        self.order = {"binary_little_endian": "<", "binary_big_endian": ">"}.get(form)
        self.words = content.split() if self.order is None else []
        self.content, self.at = content, 0

    def next(self, kind: str, count: int = 1) -> Any:
        if self.order is None:
            self.at += count
            return [float(word) for word in self.words[self.at - count : self.at]]
        type_ = np.dtype(self.order + _TYPES[kind])
        self.at += count * type_.itemsize
        return np.frombuffer(self.content, type_, count, self.at - count * type_.itemsize).tolist()


def _ply(content: bytes) -> Mesh:
    end = content.index(b"\n", content.index(b"end_header")) + 1
    header = [line.split() for line in content[:end].decode("ascii", "replace").splitlines()]
    form = next(words[1] for words in header if words[:1] == ["format"])
    numbers = _Numbers(form, content[end:])
    elements: list[tuple[str, int, list[list[str]]]] = []
    for words in header:
        if words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            elements[-1][2].append(words[1:])
    vertices: list[list[float]] = []
    faces: list[tuple[int, ...]] = []
    for element, rows, properties in elements:
        for _ in range(rows):
            row: dict[str, Any] = {}
            for kind, *rest, name in properties:
                if kind == "list":
                    row[name] = numbers.next(rest[1], int(numbers.next(rest[0])[0]))
                else:
                    row[name] = numbers.next(kind)[0]
            if element == "vertex":
                vertices.append([row["x"], row["y"], row["z"]])
            elif element == "face":
                corners = row["vertex_indices"] if "vertex_indices" in row else row["vertex_index"]
                faces += _fan([int(k) for k in corners])
    return np.array(vertices), np.array(faces)
