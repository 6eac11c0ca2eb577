"""Bodies of MJCF geoms, with the attributes of default classes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from polhode._algebra.rotor import Rotor
from polhode._mechanics.bodies import Body
from polhode._mechanics.robots.document import Node
from polhode._mechanics.robots.orientation import Compiler, place_of, to_axis, with_attributes

# MuJoCo's density in kg/m³ where a geom has neither mass nor density.
_DENSITY = 1000.0

# Number of sizes of the solids; one less if `fromto` gives the length.
_SIZES = {"sphere": 1, "capsule": 2, "cylinder": 2, "ellipsoid": 3, "box": 3}
_FLAT = ("plane", "hfield")

_ORIENTATIONS = ("quat", "axisangle", "euler", "xyaxes", "zaxis")


@dataclass(frozen=True)
class Defaults:
    """The attributes of <geom> in each default class."""

    classes: dict[str, dict[str, str]]

    @staticmethod
    def of(root: Node) -> Defaults:
        """Return the default classes of a document; each inherits from the class around it."""
        classes: dict[str, dict[str, str]] = {"main": {}}

        def add(node: Node, name: str, inherited: dict[str, str]) -> None:
            own = dict(inherited)
            for geom in node.all("geom"):
                own = _merged(own, geom.attributes)
            classes[name] = own
            for inner in node.all("default"):
                if not (inner_name := inner.attributes.get("class")):
                    raise inner.error("<default> in another one needs the attribute 'class'")
                add(inner, inner_name, own)

        for node in root.all("default"):
            name = node.attributes.get("class", "main")
            add(node, name, classes.get(name, {}))
        return Defaults(classes)

    def of_geom(self, node: Node, inherited: str) -> dict[str, str]:
        """Return the attributes of a geom with those of its class, or of the class that it inherits."""
        name = node.attributes.get("class", inherited)
        if name not in self.classes:
            raise node.error(f"no default class {name!r}; the file has {', '.join(self.classes)}")
        return _merged(self.classes[name], node.attributes)


def _merged(older: dict[str, str], newer: dict[str, str]) -> dict[str, str]:
    """Return attributes with newer ones; an orientation replaces any other."""
    kept = dict(older)
    if any(name in newer for name in _ORIENTATIONS):
        kept = {name: value for name, value in older.items() if name not in _ORIENTATIONS}
    return kept | newer


def geom_body(node: Node, compiler: Compiler, attributes: dict[str, str]) -> Body | None:
    """Return the body of a geom in the axes of its parent; None if it has no mass."""
    geom = with_attributes(node, attributes)
    kind = attributes.get("type", "sphere")
    (group,) = geom.numbers("group", 1) or [0.0]
    amount = _amount(geom)
    first, last = compiler.groups
    if not first <= group <= last or kind in _FLAT or 0.0 in amount.values():
        return None
    if kind not in _SIZES or "mesh" in attributes:
        what = "of a mesh" if kind == "mesh" or "mesh" in attributes else f"of type {kind!r}"
        raise geom.error(f"inertia of a geom {what} is not supported; give the body an <inertial>")
    if attributes.get("shellinertia", "false") == "true":
        raise geom.error('shellinertia="true" is not supported; give the body an <inertial>')
    sizes, rotor, position = _measures(geom, kind, compiler)
    try:
        return _solid(kind, sizes, amount).moved(rotor, position)
    except ValueError as error:
        raise geom.error(str(error)) from None


def _amount(geom: Node) -> dict[str, float]:
    """Return the mass or the density of a geom; the mass precedes, as in MuJoCo."""
    if (mass := geom.numbers("mass", 1)) is not None:
        return {"mass": mass[0]}
    density = geom.numbers("density", 1)
    return {"density": _DENSITY if density is None else density[0]}


def _measures(geom: Node, kind: str, compiler: Compiler) -> tuple[list[float], Rotor, list[float]]:
    """Return the sizes of a geom as in MJCF, its attitude and its position."""
    sizes, ends = geom.numbers("size", (1, 2, 3)) or [], geom.numbers("fromto", 6)
    if ends is None:
        rotor, position = place_of(geom, compiler)
    else:
        start, end = np.array(ends[:3]), np.array(ends[3:])
        length = float(np.linalg.norm(end - start))
        if kind == "sphere" or not length > 1e-10:
            raise geom.error(f"fromto needs two different points, and not a sphere: got a {kind}")
        rotor, position = to_axis((start - end) / length), (0.5 * (start + end)).tolist()
        sizes = [*sizes[:1] * (_SIZES[kind] - 1), length / 2]
    if len(sizes) < _SIZES[kind]:
        raise geom.error(f"a {kind} needs {_SIZES[kind]} numbers in 'size', or one with 'fromto'")
    return sizes, rotor, position


def _solid(kind: str, sizes: list[float], amount: dict[str, float]) -> Body:
    """Return a solid with the sizes of MJCF, which are halves."""
    if kind == "sphere":
        return Body.sphere(sizes[0], **amount)
    if kind == "ellipsoid":
        return Body.ellipsoid(sizes[:3], **amount)
    if kind == "box":
        return Body.box([2 * x for x in sizes[:3]], **amount)
    solid = Body.cylinder if kind == "cylinder" else Body.capsule
    return solid(sizes[0], 2 * sizes[1], **amount)
