"""Build examples/t-handle.stl: a hub, two arms and a stem that touch at flat faces. Run it from anywhere.

Lengths in millimetres. The arms lie along e1, the stem along −e2. Each solid is a closed shell of its
own; shells that touch without overlapping add up.
"""

import math
import os
from pathlib import Path

Point = tuple[float, float, float]
Triangle = tuple[Point, Point, Point]

HUB = 24.0  # side of the cube
RADIUS = 8.0  # of arms and stem
ARM = 48.0
STEM = 62.0
CORNERS = 16


def prism(profile: list[tuple[float, float]], start: float, end: float, axis: int) -> list[Triangle]:
    """Extrude a profile, which runs counterclockwise seen from the positive end of the axis."""
    first, second = (axis + 1) % 3, (axis + 2) % 3

    def point(corner: tuple[float, float], height: float) -> Point:
        p = [0.0, 0.0, 0.0]
        p[first], p[second], p[axis] = corner[0], corner[1], height
        return (p[0], p[1], p[2])

    bottom, top = [[point(c, height) for c in profile] for height in (start, end)]
    triangles = []
    for i in range(len(profile)):
        j = (i + 1) % len(profile)
        triangles += [(bottom[i], bottom[j], top[j]), (bottom[i], top[j], top[i])]
    for i in range(1, len(profile) - 1):
        triangles += [(top[0], top[i], top[i + 1]), (bottom[0], bottom[i + 1], bottom[i])]
    return triangles


def circle(radius: float) -> list[tuple[float, float]]:
    """Return a regular polygon inscribed in a circle."""
    angles = [2 * math.pi * k / CORNERS for k in range(CORNERS)]
    return [(radius * math.cos(a), radius * math.sin(a)) for a in angles]


def t_handle() -> list[Triangle]:
    """Return the triangles, seen counterclockwise from outside."""
    h = HUB / 2
    square = [(h, h), (-h, h), (-h, -h), (h, -h)]
    return (
        prism(square, -h, h, axis=2)
        + prism(circle(RADIUS), h, h + ARM, axis=0)
        + prism(circle(RADIUS), -h - ARM, -h, axis=0)
        + prism(circle(RADIUS), -h - STEM, -h, axis=1)
    )


def text_stl(triangles: list[Triangle]) -> str:
    """Return a text STL file; its normals are left to the readers, as many writers do."""
    lines = ["solid t-handle"]
    for triangle in triangles:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x:.7g} {y:.7g} {z:.7g}" for x, y, z in triangle]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid t-handle", ""])


if __name__ == "__main__":
    target = Path(__file__).with_name("t-handle.stl")
    temporary = target.with_suffix(".part")
    temporary.write_text(text_stl(t_handle()))
    os.replace(temporary, target)
    print(f"{target.name}: {len(t_handle())} triangles")
