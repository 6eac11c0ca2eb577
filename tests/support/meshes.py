"""Meshes of solids and writers of mesh files."""

import struct

import numpy as np


def surface_of_revolution(profile, n):
    """Triangles (k, 3, 3) of a profile (m, 2) of (radius, height), from bottom to top, turned about e3."""
    angles = 2 * np.pi * np.arange(n) / n
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    rings = np.array([np.column_stack([r * circle, np.full(n, z)]) for r, z in profile])
    lower, upper = rings[:-1].reshape(-1, 3), rings[1:].reshape(-1, 3)
    lower_next, upper_next = (np.roll(x, -1, axis=1).reshape(-1, 3) for x in (rings[:-1], rings[1:]))
    triangles = np.concatenate(
        [np.stack([lower, lower_next, upper_next], axis=1), np.stack([lower, upper_next, upper], axis=1)]
    )
    a, b, c = triangles.transpose(1, 0, 2)
    # At a pole one of the two has no area.
    return triangles[(a != b).any(axis=1) & (b != c).any(axis=1) & (c != a).any(axis=1)]


def arc(n, radius, start, end, center=(0.0, 0.0)):
    """Points of a circle in the (radius, height) plane; the poles exactly on the axis."""
    s = np.linspace(start, end, n + 1)
    points = np.stack([center[0] + radius * np.cos(s), center[1] + radius * np.sin(s)], axis=1)
    points[np.abs(points[:, 0]) < 1e-12 * radius, 0] = 0.0
    return points


def sphere_profile(n, radius=1.0):
    return arc(n, radius, -np.pi / 2, np.pi / 2)


def torus_profile(n, major, minor):
    closed = arc(n, minor, -np.pi, np.pi, (major, 0.0))
    closed[-1] = closed[0]
    return closed


def capsule_profile(n, radius, height):
    lower, upper = arc(n // 2, radius, -np.pi / 2, 0.0), arc(n // 2, radius, 0.0, np.pi / 2)
    shift = np.array([0.0, height / 2])
    return np.concatenate([lower - shift, upper + shift])


def cube(lengths=(1.0, 1.0, 1.0)):
    """The 12 triangles of a box, counterclockwise seen from outside."""
    corners = np.array([[x, y, z] for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)]) * lengths
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return corners[[t for a, b, c, d in quads for t in ([a, b, c], [a, c, d])]]


def write_obj(path, triangles):
    vertices, index = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (index.reshape(-1, 3) + 1).tolist()]
    path.write_text("\n".join(lines) + "\n")
    return path


def write_binary_stl(path, triangles):
    records = np.zeros(
        len(triangles), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]
    )
    records["corners"] = triangles
    path.write_bytes(b"test".ljust(80) + struct.pack("<I", len(triangles)) + records.tobytes())
    return path


def write_ascii_stl(path, triangles):
    lines = ["solid test"]
    for triangle in triangles.tolist():
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x!r} {y!r} {z!r}" for x, y, z in triangle]
        lines += ["endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid test"]) + "\n")
    return path


def write_ply(path, triangles):
    vertices, index = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    faces = index.reshape(-1, 3).tolist()
    header = f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\nproperty double x\nproperty double y\n"
    header += (
        f"property double z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    rows = [f"{x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()] + [f"3 {a} {b} {c}" for a, b, c in faces]
    path.write_text(header + "\n".join(rows) + "\n")
    return path
