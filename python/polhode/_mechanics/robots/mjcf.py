"""Bodies of MJCF files, the models of MuJoCo."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from itertools import count
from pathlib import Path

import numpy as np

from polhode._mechanics.bodies import Body
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.robots.document import Node, read
from polhode._mechanics.robots.geoms import Defaults, geom_body
from polhode._mechanics.robots.link import Inertial, Link, link_of
from polhode._mechanics.robots.orientation import Compiler, Place, place_of
from polhode._mechanics.robots.urdf import required_number

# Attributes of <compiler> with which MuJoCo changes the masses and inertias of some bodies.
_CHANGED_MASSES = ("boundmass", "boundinertia")

# Elements that MuJoCo expands to bodies or geoms.
_EXPANDED = ("attach", "composite", "flexcomp", "replicate")


def links(root: Node) -> list[Link]:
    """Return the bodies of an MJCF document, without the world."""
    _include(root, Path(root.source.name).parent, {os.path.abspath(root.source.name)})
    model = _Model(_compiler(root), Defaults.of(root))
    numbers = count(1)
    found: list[Link] = []
    for world in root.all("worldbody"):
        found += [
            Link(node.tag, node, errors=[node.message(_unsupported(node))])
            for node in _inside(world)
            if node.tag in _EXPANDED
        ]
        found += model.bodies(world, world.attributes.get("childclass", "main"), numbers)
    _set_total_mass(found, model.compiler.total_mass)
    return found


def _set_total_mass(links: list[Link], total: float) -> None:
    """Scale the bodies to a total mass, if this is positive."""
    bodies = [link.body for link in links if link.body is not None]
    if total > 0 and bodies:
        factor = total / sum(body.mass for body in bodies)
        for link in links:
            if (body := link.body) is not None:
                try:
                    with np.errstate(over="ignore", invalid="ignore"):
                        scaled = Inertia.from_matrix(factor * body.inertia.matrix)
                    link.body = Body(factor * body.mass, scaled, body.center_of_mass)
                except ValueError as error:
                    link.body = None
                    link.errors.append(link.node.message(f"scaled to settotalmass={total:g}: {error}"))


def _include(node: Node, folder: Path, known: set[str]) -> None:
    """Replace each <include> by the content of its file, whose path is relative to the main file."""
    children: list[Node] = []
    for child in node.children:
        if child.tag != "include":
            _include(child, folder, known)
            children.append(child)
            continue
        if not child.attributes.get("file"):
            raise child.error("<include> needs the attribute 'file' with the path of a file")
        path = folder / child.attributes["file"]
        # Path.is_file raises for a name that is too long.
        if not os.path.isfile(path):
            raise child.error(
                f"no such file: {str(path)!r}; paths in <include> are relative to the main file"
            )
        if os.path.abspath(path) in known:
            raise child.error(f"{str(path)!r} is included twice; MuJoCo reads a file once")
        known.add(os.path.abspath(path))
        inner = read(path)
        _include(inner, folder, known)
        children += inner.children
    node.children = children


def _compiler(root: Node) -> Compiler:
    settings: dict[str, str] = {}
    for node in root.all("compiler"):
        settings |= node.attributes
        for name in _CHANGED_MASSES:
            if (node.numbers(name, 1) or [0.0])[0] > 0:
                raise node.error(
                    f"attribute {name!r} of <compiler> is not supported; write the masses it gives"
                )
        if node.attributes.get("coordinate", "local") != "local":
            raise node.error('coordinate="global" is not supported; MuJoCo 2.3.3 and older save it as local')
        _choice(node, "angle", ("degree", "radian"))
        _choice(node, "inertiafromgeom", ("auto", "true", "false"))
        sequence = node.attributes.get("eulerseq", "xyz")
        if len(sequence) != 3 or not set(sequence) <= set("xyzXYZ"):
            raise node.error(f"eulerseq must be three of x, y, z, X, Y, Z, got {sequence!r}")
        node.numbers("inertiagrouprange", 2)
        node.numbers("settotalmass", 1)
    first, last = map(float, settings.get("inertiagrouprange", "0 5").split())
    return Compiler(
        settings.get("angle", "degree") == "degree",
        settings.get("eulerseq", "xyz"),
        settings.get("inertiafromgeom", "auto"),
        (first, last),
        float(settings.get("settotalmass", "0")),
    )


def _choice(node: Node, name: str, values: tuple[str, ...]) -> None:
    if (value := node.attributes.get(name, values[0])) not in values:
        raise node.error(f"{name} must be one of {', '.join(values)}, got {value!r}")


@dataclass(frozen=True)
class _Model:
    """Settings and defaults of a document."""

    compiler: Compiler
    defaults: Defaults

    def bodies(self, parent: Node, inherited: str, numbers: Iterator[int]) -> Iterator[Link]:
        """Yield the bodies in a body or frame, in the order of MuJoCo's numbers: parents first."""
        for node in parent.children:
            own = node.attributes.get("childclass", inherited)
            if node.tag == "body":
                number = next(numbers)
                name = node.attributes.get("name") or f"body {number}"
                yield link_of(name, node, partial(self._body, node, own))
                yield from self.bodies(node, own, numbers)
            elif node.tag == "frame":
                yield from self.bodies(node, own, numbers)

    def _body(self, node: Node, own: str) -> Inertial | Body | None:
        inertial = node.only("inertial")
        given = inertial is not None and self.compiler.inertia_from_geom != "true"
        for inner in _inside(node):
            if inner.tag in _EXPANDED:
                raise inner.error(_unsupported(inner))
        if given and inertial is not None:
            return self._inertial(inertial)
        if self.compiler.inertia_from_geom == "false":
            return None
        return self._sum(node, own, [])

    def _sum(self, parent: Node, inherited: str, places: list[Place]) -> Body | None:
        """Return the body of all geoms in a body or frame, placed in the body's axes; None without mass."""
        total: Body | None = None
        for node in parent.children:
            found: Body | None = None
            if node.tag == "geom":
                found = geom_body(node, self.compiler, self.defaults.of_geom(node, inherited))
                for rotor, position in places if found else []:
                    found = found.moved(rotor, position) if found else None
            elif node.tag == "frame":
                own = node.attributes.get("childclass", inherited)
                found = self._sum(node, own, [place_of(node, self.compiler), *places])
            if found is not None:
                total = found if total is None else total + found
        return total

    def _inertial(self, node: Node) -> Inertial:
        mass = required_number(node, "mass")
        diagonal, full = node.numbers("diaginertia", 3), node.numbers("fullinertia", 6)
        if node.numbers("pos", 3) is None:
            raise node.error("<inertial> needs the attribute 'pos'")
        if (diagonal is None) == (full is None):
            raise node.error("<inertial> needs exactly one of the attributes 'diaginertia' and 'fullinertia'")
        rotor, position = place_of(node, self.compiler)
        if full is not None and not np.array_equal(rotor.components, [1, 0, 0, 0]):
            raise node.error(
                "fullinertia is in axes of the body: leave out the orientation, or use diaginertia"
            )
        words = node.attributes["diaginertia" if full is None else "fullinertia"].split()
        entries = [*(diagonal or []), 0.0, 0.0, 0.0] if full is None else full
        texts = [*words, "0", "0", "0"] if full is None else words
        return Inertial(node, node, mass, entries, position, rotor, texts, full is not None)


def _inside(node: Node) -> Iterator[Node]:
    """Yield the children of a body, and those of its frames."""
    for child in node.children:
        yield child
        if child.tag == "frame":
            yield from _inside(child)


def _unsupported(node: Node) -> str:
    return f"<{node.tag}> is not supported; save the compiled model with MuJoCo (mj_saveLastXML) first"
