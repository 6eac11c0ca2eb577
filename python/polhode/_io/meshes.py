"""Triangle meshes: surfaces of solids and files, and STL files in principal axes."""

from __future__ import annotations

import os
import struct
from pathlib import Path
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.transform import RigidTransform
from polhode._mechanics.bodies import Body
from polhode._scene.scene import Scene
from polhode._support.arrays import Array, as_float, as_floats
from polhode._support.calls import explains_calls
from polhode._support.files import loadable, write_atomically

_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


@explains_calls
def read_mesh(path: str | os.PathLike[str], *, scale: float = 1.0) -> tuple[Array, Array]:
    """Return the triangle mesh in a file (STL, OBJ or PLY), for `write_gltf`.

    Parameters
    ----------
    scale
        Unit of the file in m, such as 0.001 for millimetres.

    Returns
    -------
    vertices, triangles
        Positions (n, 3) in m, and numbers of vertices (m, 3), counter-clockwise seen from outside.

    Raises
    ------
    FileNotFoundError, ValueError
        As `polhode.Body.from_mesh`: the mesh must enclose a body.

    Examples
    --------
    >>> text = '''v 0 0 0
    ... v 30 0 0
    ... v 0 20 0
    ... v 0 0 10
    ... f 1 3 2
    ... f 1 2 4
    ... f 1 4 3
    ... f 2 3 4
    ... '''
    >>> with open("tetrahedron.obj", "w") as file:
    ...     _ = file.write(text)
    >>> vertices, triangles = ph.io.read_mesh("tetrahedron.obj", scale=0.001)  # mm
    >>> vertices.max(axis=0), triangles.shape
    (array([0.03, 0.02, 0.01]), (4, 3))
    """
    if not os.path.lexists(path):
        raise FileNotFoundError(f"{os.fspath(path)}: no such file")
    vertices, triangles = _native.read_mesh(loadable(path), as_float(scale, "the scale"))
    return vertices, np.array(triangles, int)


@explains_calls
def solid_surface(kind: str, *sizes: Any) -> tuple[Array, Array]:
    """Return the surface of a solid as a triangle mesh, as the page draws it, for `write_gltf`.

    Vertices lie on the solid; a round one has 64 faces about its axis, so that its volume is too small by
    less than 1 %. A rod and a disc are given a thickness of 3 % of the length and of the diameter.

    Parameters
    ----------
    kind
        Name of a constructor of `polhode.Body`, from ``"box"`` to ``"capsule"``.
    sizes
        Its sizes in m, as ``"cylinder", 0.1, 0.5`` or ``"box", [1, 2, 3]``.

    Returns
    -------
    vertices, triangles
        As `read_mesh`, in the axes of the solid: a cone has its base, not its centre of mass, at the origin.

    Raises
    ------
    ValueError
        For another kind, another number of sizes, and sizes that no such solid has.

    Examples
    --------
    >>> vertices, triangles = ph.io.solid_surface("box", [1, 2, 3])
    >>> vertices.max(axis=0), len(triangles)
    (array([0.5, 1. , 1.5]), 12)
    """
    lengths = np.concatenate([np.ravel(as_floats(x, f"the sizes of a {kind}")) for x in sizes or ([],)])
    vertices, triangles = _native.solid_surface(kind, lengths.tolist())
    return vertices, np.array(triangles, int)


@explains_calls
def write_stl(
    mesh: str | os.PathLike[str] | Scene, path: str | os.PathLike[str], *, scale: float = 1.0
) -> RigidTransform:
    """Write a mesh as binary STL in its principal axes about its centre of mass, in m, atomically.

    The uniform body in the written mesh has its centre of mass at 0, and its inertia matrix is diagonal, with
    the moments in the order of `Inertia.principal_moments`. Where moments are equal, the axes are one choice
    of many. Numbers are stored as float32, as STL requires.

    Parameters
    ----------
    mesh
        The path of a mesh (STL, OBJ or PLY), or a scene with a mesh or a solid.
    scale
        Unit of the mesh file in m. A scene states its own.

    Returns
    -------
    RigidTransform
        The displacement T that was applied: ``T.apply(x)`` is the written position of the point x, in m, of
        the mesh, or of the body axes of the scene. ``T.rotor`` turns the axes of the mesh into the principal
        ones.

    Raises
    ------
    ValueError
        For a mesh that encloses no body, a scene with neither mesh nor solid, another suffix, and triangles
        too small for float32.
    FileNotFoundError, OSError
        If there is no such mesh; if the file cannot be written, and an older file stays.

    Examples
    --------
    The written tetrahedron has its centre of mass at the origin and principal axes for its axes:

    >>> text = '''v 0 0 0
    ... v 3 0 0
    ... v 0 2 0
    ... v 0 0 1
    ... f 1 3 2
    ... f 1 2 4
    ... f 1 4 3
    ... f 2 3 4
    ... '''
    >>> with open("tetrahedron.obj", "w") as file:
    ...     _ = file.write(text)
    >>> moved = ph.io.write_stl("tetrahedron.obj", "tetrahedron.stl")
    >>> body = ph.Body.from_mesh("tetrahedron.stl", density=1)
    >>> round(body.mass, 6), bool(body.center_of_mass.norm() < 1e-6)
    (1.0, True)
    >>> axes = body.inertia.matrix
    >>> bool(np.allclose(axes, np.diag(body.inertia.principal_moments), atol=1e-6))
    True
    """
    if Path(path).suffix.lower() != ".stl":
        raise ValueError(f"a mesh is saved as FILE.stl, not {os.fspath(path)!r}")
    if isinstance(mesh, Scene):
        surface, body = mesh.surface(), mesh.body
        if surface is None:
            raise ValueError(f"{mesh.name} has neither a mesh nor a solid, so its shape is not known")
    else:
        surface, body = read_mesh(mesh, scale=scale), Body.from_mesh(mesh, density=1.0, scale=scale)
    to_axes = ~body.inertia.principal_frame
    applied = RigidTransform(to_axes, -to_axes(body.center_of_mass))
    vertices, triangles = surface
    write_atomically({Path(path): _binary(np.asarray(applied.apply(vertices)), triangles)})
    return applied


def _binary(vertices: Array, triangles: Array) -> bytes:
    """Return the content of a binary STL file."""
    corners = vertices[triangles].astype("<f4")
    edges = np.diff(corners.astype(float), axis=1)
    normals = np.cross(edges[:, 0], edges[:, 1])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    if not np.isfinite(corners).all() or not (lengths > 0).all():
        k = int(np.argmax(~((lengths[:, 0] > 0) & np.isfinite(corners).all(axis=(1, 2)))))
        raise ValueError(f"triangle {k} cannot be written in the 32-bit floats of STL; simplify the mesh")
    facets = np.zeros(len(triangles), _FACET)
    facets["normal"], facets["corners"] = normals / lengths, corners
    # The header has 80 bytes; it must not begin with "solid", by which text is known.
    header = f"Written by polhode {_native.__version__}, in metres, in principal axes".encode()
    return header.ljust(80) + struct.pack("<I", len(facets)) + facets.tobytes()
