"""Links of SDF files."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial

from polhode._algebra.rotor import Rotor
from polhode._mechanics.robots.document import Node
from polhode._mechanics.robots.link import Inertial, Link, doubts_of_angles, link_of, name_of
from polhode._mechanics.robots.urdf import ENTRIES


def links(root: Node) -> list[Link]:
    """Return the links of all models of an SDF document.

    Names of nested models precede those of their links, with ``::`` between, as SDF writes them; so do the
    names of models if there are several.
    """
    places = [root, *root.all("world")]
    models = [model for place in places for model in place.all("model")]
    found = [_include(node) for place in places for node in place.all("include")]
    for model in models:
        found += _links(model, f"{name_of(model)}::" if len(models) > 1 else "")
    return found


def _links(model: Node, prefix: str) -> Iterator[Link]:
    for node in model.all("link"):
        yield link_of(prefix + name_of(node), node, partial(_inertial, node))
    for inner in model.all("model"):
        yield from _links(inner, f"{prefix}{name_of(inner)}::")
    for node in model.all("include"):
        yield _include(node)


def _include(node: Node) -> Link:
    uri = node.first("uri")
    name = "" if uri is None else uri.text.strip()
    message = node.message(f"<include> of {name!r} is not supported; expand the file with gz sdf -p first")
    return Link(name, node, errors=[message])


def _inertial(link: Node) -> Inertial | None:
    inertial = link.only("inertial")
    if inertial is None:
        return None
    if inertial.attributes.get("auto", "false").strip() in ("true", "1"):
        raise inertial.error(
            'auto="true", an inertia from collisions, is not supported; give mass and inertia'
        )
    center, rotor, doubts = _pose(inertial.only("pose"))
    mass, inertia = inertial.required("mass"), inertial.required("inertia")
    for name in ENTRIES[:3]:
        inertia.required(name)
    found = [inertia.only(name) for name in ENTRIES]
    entries = [_number(node) if node else 0.0 for node in found]
    texts = [node.text.strip() if node else "" for node in found]
    return Inertial(inertia, mass, _number(mass), entries, center, rotor, texts, doubts=doubts)


def _number(node: Node) -> float:
    (value,) = node.numbers(None, 1) or [math.nan]
    return value


def _pose(node: Node | None) -> tuple[list[float], Rotor, tuple[str, ...]]:
    """Return position, attitude and doubts of a pose element; roll, pitch and yaw are about fixed axes."""
    if node is None or not node.text.strip():
        return [0.0] * 3, Rotor.identity(), ()
    if node.attributes.get("relative_to"):
        raise node.error(
            "attribute 'relative_to' of an inertial <pose> is not supported; express it in the link"
        )
    form = node.attributes.get("rotation_format", "euler_rpy")
    if form not in ("euler_rpy", "quat_xyzw"):
        raise node.error(f"rotation_format must be 'euler_rpy' or 'quat_xyzw', got {form!r}")
    values = node.numbers(None, 6 if form == "euler_rpy" else 7) or []
    center, rest = values[:3], values[3:]
    if form == "quat_xyzw":
        return center, unit_quaternion(node, rest, "xyzw"), ()
    degrees = node.attributes.get("degrees", "false").strip() in ("true", "1")
    doubts = () if degrees else doubts_of_angles(node, "the pose", rest)
    return center, Rotor.from_euler("xyz", rest, degrees=degrees), doubts


def unit_quaternion(node: Node, components: list[float], order: str) -> Rotor:
    """Return the rotor of a quaternion of any length but 0."""
    length = math.hypot(*components)
    if not length > 0:
        raise node.error("quaternion must not be 0")
    scaled = [x / length for x in components]
    return Rotor.from_quaternion(scaled, order="xyzw" if order == "xyzw" else "wxyz")
