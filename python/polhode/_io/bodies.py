"""Bodies of scenes, meshes and robot files, converted to robot files and meshes."""

from __future__ import annotations

import os
from pathlib import Path

from polhode._io import meshes, robots
from polhode._mechanics.bodies import Body
from polhode._mechanics.robots.read import bodies_of
from polhode._scene.scene import Scene
from polhode._support.files import printable_stem

_MESHES = ("stl", "obj", "ply")
_ROBOTS = ("urdf", "xml", "sdf")
READ, WRITTEN = ("toml", *_MESHES, *_ROBOTS), ("urdf", "xml", "stl")


def options_of(source: str, target: str) -> tuple[str, ...]:
    """Return the options of a conversion between suffixes; a ValueError if there is no such conversion."""
    if source in _ROBOTS and target == "stl":
        raise ValueError(
            f"a .{source} file has inertias, and no mesh for a .stl file; give the mesh or a scene"
        )
    if source not in _MESHES:
        return ()
    return ("scale",) if target == "stl" else ("density", "mass", "scale")


def convert(
    source: str | os.PathLike[str],
    target: str | os.PathLike[str],
    scene: Scene | None = None,
    density: float | None = None,
    mass: float | None = None,
    scale: float = 1.0,
) -> list[str]:
    """Write the bodies of a file to another, as `polhode convert` does, and return lines that describe it.

    `scene` is that of the source, if this is one. Bodies are called as in a robot file; that of a scene or a
    mesh as the file.
    """
    source, target = Path(source), Path(target)
    form = target.suffix.lower().removeprefix(".")
    if form == "stl":
        applied = meshes.write_stl(scene or source, target, scale=scale)
        x, y, z = applied.inverse().translation.components.tolist()
        w, i, j, k = (applied.rotor.to_quaternion(order="wxyz") + 0.0).tolist()  # without -0.0
        return [
            f"  moved by -({x!r}, {y!r}, {z!r}) m, the centre of mass,",
            f"  then turned by the quaternion wxyz ({w!r}, {i!r}, {j!r}, {k!r})",
        ]
    bodies = _bodies(source, scene, density, mass, scale)
    write = robots.write_urdf if form == "urdf" else robots.write_mjcf
    write(bodies, target, name=printable_stem(source))
    return [f"  {name}: {body!r}" for name, body in bodies.items()]


def _bodies(
    source: Path, scene: Scene | None, density: float | None, mass: float | None, scale: float
) -> dict[str, Body]:
    if scene is not None:
        if not scene.has_mass:
            raise ValueError(
                f"{source} gives no mass, which a robot file needs; add mass to its table [body]"
            )
        return {printable_stem(source): scene.body}
    form = source.suffix.lower().removeprefix(".")
    if form in _MESHES:
        if (density is None) == (mass is None):
            raise ValueError("a mesh needs density= in kg/m³ or mass= in kg, and not both")
        return {printable_stem(source): Body.from_mesh(source, density=density, mass=mass, scale=scale)}
    return bodies_of(source)
