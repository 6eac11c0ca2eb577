"""Writes files to begin with for the targets in Rust to fuzz/corpus/NAME: python fuzz/python/seeds.py."""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]

_CORNERS = ((0, 0, 0), (60, 0, 0), (0, 60, 0), (0, 0, 60))
_FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))


def formulas() -> list[str]:
    """Return the equations of the handout and the examples of formulas in scenes."""
    text = (ROOT / "tests/support/handout_equations.py").read_text("utf-8")
    return re.findall(r'Equation\("[^"]*", "([^"]*)"', text)


def scenes() -> Iterator[bytes]:
    """Yield the scenes of the examples and of the guide."""
    for path in sorted((ROOT / "examples").glob("*.toml")):
        yield path.read_bytes()
    guide = (ROOT / "docs/scenes.md").read_text("utf-8")
    blocks = re.findall(r"```toml\n(.*?)```", guide, re.DOTALL)
    yield from (block.encode() for block in [*blocks, "\n".join(blocks)])


def meshes() -> Iterator[bytes]:
    """Yield a tetrahedron in each format, after the byte that chooses the format."""
    facets = "".join(
        "facet normal 0 0 0 outer loop "
        + " ".join("vertex {} {} {}".format(*_CORNERS[i]) for i in face)
        + " endloop endfacet\n"
        for face in _FACES
    )
    yield b"\0" + f"solid part\n{facets}endsolid part\n".encode()
    records = (struct.pack("<12fH", 0, 0, 0, *(x for i in face for x in _CORNERS[i]), 0) for face in _FACES)
    yield b"\0" + bytes(80) + struct.pack("<I", len(_FACES)) + b"".join(records)
    lines = [
        *("v {} {} {}".format(*x) for x in _CORNERS),
        *(f"f {a + 1} {b + 1}/1 -{4 - c}" for a, b, c in _FACES),
    ]
    yield b"\1" + "\n".join(lines).encode()
    head = "ply\nformat {} 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    head += "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    rows = [*("{} {} {}".format(*x) for x in _CORNERS), *("3 {} {} {}".format(*x) for x in _FACES)]
    yield b"\2" + (head.format("ascii") + "\n".join(rows) + "\n").encode()
    for name, order in (("little", "<"), ("big", ">")):
        data = b"".join(struct.pack(f"{order}3f", *x) for x in _CORNERS)
        data += b"".join(struct.pack(f"{order}B3i", 3, *x) for x in _FACES)
        yield b"\2" + head.format(f"binary_{name}_endian").encode() + data


def corpora() -> dict[str, list[bytes]]:
    """Return the files of each target; `products` needs none."""
    texts = [text.encode() for text in formulas()]
    return {
        "parse": [b"\0" + text for text in texts],
        "run": [bytes(9) + text for text in texts],
        "scene": list(scenes()),
        "mesh": list(meshes()),
    }


if __name__ == "__main__":
    for name, contents in corpora().items():
        folder = ROOT / "fuzz/corpus" / name
        folder.mkdir(parents=True, exist_ok=True)
        for k, content in enumerate(contents):
            (folder / f"seed-{k}").write_bytes(content)
