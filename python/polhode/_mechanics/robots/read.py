"""`read_urdf`, `read_mjcf` and `read_sdf`: the bodies of robot files."""

from __future__ import annotations

import os
from collections.abc import Callable

from polhode._mechanics.bodies import Body
from polhode._mechanics.robots import document, mjcf, sdf, urdf
from polhode._mechanics.robots.document import DocumentError, Node
from polhode._mechanics.robots.link import Link

_Links = Callable[[Node], list[Link]]

# By root element: the format and its reader.
FORMATS: dict[str, tuple[str, _Links]] = {
    "robot": ("URDF", urdf.links),
    "mujoco": ("MJCF", mjcf.links),
    "sdf": ("SDF", sdf.links),
}


def read_urdf(path: str | os.PathLike[str]) -> dict[str, Body]:
    """Return the bodies of the links in a URDF file, by name.

    Body axes are those of the link. The centre of mass and the inertia about it are turned from the frame of
    the inertial element into them. Meshes, joints and everything else are ignored.

    Links without an inertial element, and those with zero mass and inertia, are left out: both are frames.

    Returns
    -------
    dict
        A `Body` (kg, m, kg m²) for each name of a link, in the order of the file.

    Raises
    ------
    ValueError
        If the file is not URDF, or has a mass or an inertia that no body has. The message lists all mistakes
        with file, line, and the probable slip; ``polhode check FILE`` prints them for each link.
    FileNotFoundError
        If there is no such file.

    Examples
    --------
    >>> ph.io.write_urdf({"wheel": ph.Body.disc(1, mass=4)}, "wheel.urdf")
    >>> ph.read_urdf("wheel.urdf")["wheel"].inertia
    Inertia(principal moments 1, 1, 2 kg m²)
    """
    return bodies_of(path, "robot")


def read_mjcf(path: str | os.PathLike[str]) -> dict[str, Body]:
    """Return the bodies in an MJCF file, a model of MuJoCo, by name, in the axes of the MJCF body.

    The element `inertial` may have any orientation (``quat``, ``axisangle``, ``euler``, ``xyaxes`` or
    ``zaxis``). Without it the inertia is the sum over the geoms that are spheres, capsules, cylinders,
    ellipsoids or boxes, with their mass or density, default classes and frames. The settings `angle`,
    `eulerseq`, `inertiafromgeom`, `inertiagrouprange` and `settotalmass` of `compiler` apply, and included
    files are read.

    An unnamed body is called ``"body N"``, with its number in MuJoCo. Bodies with neither an inertial element
    nor a geom with mass are left out.

    Not supported, and an error where it determines an inertia: geoms that are meshes, ``shellinertia``,
    ``attach``, ``replicate``, ``composite`` and ``flexcomp``; ``boundmass``, ``boundinertia`` and global
    coordinates. `balanceinertia` is ignored: an impossible inertia is an error.

    Returns and errors are those of `read_urdf`.

    Examples
    --------
    The inertia of a body without the element `inertial` is that of its geoms, here ``2/5 m r²``:

    >>> geom = '<geom type="sphere" size="0.5" mass="10"/>'
    >>> with open("ball.xml", "w") as file:
    ...     _ = file.write(f'<mujoco><worldbody><body name="ball">{geom}</body></worldbody></mujoco>')
    >>> ph.read_mjcf("ball.xml")["ball"].inertia
    Inertia(principal moments 1, 1, 1 kg m²)
    """
    return bodies_of(path, "mujoco")


def read_sdf(path: str | os.PathLike[str]) -> dict[str, Body]:
    """Return the bodies of the links in an SDF file, by name, in the axes of the link.

    A link of a nested model is called ``"model::link"``; so are all links if there are several models.
    Links without an inertial element are left out, though SDF gives them 1 kg.

    Not supported, and an error: ``include``, ``auto="true"`` (an inertia from collisions) and
    ``relative_to`` of an inertial pose. Mass and moments have no defaults here.

    Returns and errors are those of `read_urdf`.

    Examples
    --------
    >>> moments = "<ixx>1</ixx><iyy>2</iyy><izz>3</izz><ixy>0</ixy><ixz>0</ixz><iyz>0</iyz>"
    >>> inertial = f"<inertial><mass>4</mass><inertia>{moments}</inertia></inertial>"
    >>> link = f'<link name="arm">{inertial}</link>'
    >>> with open("arm.sdf", "w") as file:
    ...     _ = file.write(f'<sdf version="1.9"><model name="robot">{link}</model></sdf>')
    >>> ph.read_sdf("arm.sdf")["arm"].inertia
    Inertia(principal moments 1, 2, 3 kg m²)
    """
    return bodies_of(path, "sdf")


def read_links(path: str | os.PathLike[str], root_tag: str | None = None) -> tuple[str, list[Link]]:
    """Return the format of a robot file, and its links with their mistakes; `root_tag` fixes the format."""
    root = document.read(path)
    if root.tag not in FORMATS or root_tag not in (None, root.tag):
        expected = [root_tag] if root_tag else list(FORMATS)
        elements = " or ".join(f"<{tag}> ({FORMATS[tag][0]})" for tag in expected)
        remedy = f"; use read_{FORMATS[root.tag][0].lower()}" if root.tag in FORMATS else ""
        raise root.error(f"the root element must be {elements}, got <{root.tag}>{remedy}")
    name, links_of = FORMATS[root.tag]
    links = links_of(root)
    known: dict[str, int] = {}
    for link in links:
        if link.name in known:
            link.errors.append(
                link.node.message(f"{link.name!r} is already the name of line {known[link.name]}")
            )
        known.setdefault(link.name, link.node.line)
    return name, links


def bodies_of(path: str | os.PathLike[str], root_tag: str | None = None) -> dict[str, Body]:
    """Return the bodies of a robot file by name; `root_tag` fixes the format."""
    _, links = read_links(path, root_tag)
    errors = [error for link in links for error in link.errors]
    if errors:
        raise DocumentError("\n".join(errors))
    return {link.name: link.body for link in links if link.body is not None}
