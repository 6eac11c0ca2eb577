"""Links of URDF files."""

from __future__ import annotations

from functools import partial

from polhode._algebra.rotor import Rotor
from polhode._mechanics.robots.document import Node
from polhode._mechanics.robots.link import Inertial, Link, doubts_of_angles, link_of, name_of

ENTRIES = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


def links(root: Node) -> list[Link]:
    """Return the links of a URDF document."""
    for node in root.everything():
        if node.tag.startswith("xacro:"):
            raise node.error(f"<{node.tag}> is not URDF; expand the file with xacro first")
    return [link_of(name_of(node), node, partial(_inertial, node)) for node in root.all("link")]


def _inertial(link: Node) -> Inertial | None:
    inertial = link.only("inertial")
    if inertial is None:
        return None
    origin, mass, inertia = inertial.only("origin"), inertial.required("mass"), inertial.required("inertia")
    center, angles = [0.0] * 3, [0.0] * 3
    doubts: tuple[str, ...] = ()
    if origin is not None:
        center, angles = origin.numbers("xyz", 3) or center, origin.numbers("rpy", 3) or angles
        doubts = doubts_of_angles(origin, "rpy", angles)
    entries = [required_number(inertia, name) for name in ENTRIES]
    texts = [inertia.attributes[name].strip() for name in ENTRIES]
    # Roll, pitch and yaw about axes of the link, in this order.
    rotor = Rotor.from_euler("xyz", angles)
    amount = required_number(mass, "value")
    return Inertial(inertia, mass, amount, entries, center, rotor, texts, doubts=doubts)


def required_number(node: Node, attribute: str) -> float:
    """Return the number in an attribute, which is required."""
    found = node.numbers(attribute, 1)
    if found is None:
        raise node.error(f"<{node.tag}> needs the attribute {attribute!r}")
    return found[0]
