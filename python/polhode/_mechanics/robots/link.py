"""Links of a robot file: their inertial elements, bodies and messages."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from polhode._algebra.rotor import Rotor
from polhode._mechanics.bodies import Body
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.robots import slips
from polhode._mechanics.robots.document import DocumentError, Node
from polhode._support.arrays import Array

NO_INERTIAL = "no inertial element"
MASSLESS = "massless"


@dataclass(frozen=True)
class Inertial:
    """An inertial element: mass (kg), and inertia (kg m²) about the centre of mass in axes of its own.

    `center` (m) and `rotor` place these axes in those of the link. `entries` are the inertia's xx, yy, zz,
    xy, xz and yz as in the file. `node` and `mass_node` are the elements of the inertia and of the mass;
    `doubts` are warnings about others, with their places.
    """

    node: Node
    mass_node: Node
    mass: float
    entries: list[float]
    center: list[float]
    rotor: Rotor
    texts: list[str]
    in_rows: bool = False
    doubts: tuple[str, ...] = ()

    @property
    def matrix(self) -> Array:
        """The inertia matrix (3, 3) in the inertial element's own axes."""
        return matrix_of(self.entries)

    @property
    def massless(self) -> bool:
        """Whether mass and inertia are 0, as for links that are only frames."""
        return self.mass == 0 and not any(self.entries)

    def body(self) -> Body:
        """Return the body in the axes of the link; an error if no body has this mass and inertia."""
        if not self.mass > 0:
            raise self.mass_node.error(f"mass must be more than 0, got {self.mass:g} kg")
        try:
            inertia = Inertia.from_matrix(self.matrix)
        except ValueError:
            raise self.node.error(slips.explain(self.case())) from None
        try:
            return Body(self.mass, inertia).moved(self.rotor, self.center)
        except ValueError as error:
            raise self.node.error(str(error)) from None

    def case(self) -> slips.Case:
        """Return the inertia as a case for the search for slips."""
        turn = self.rotor.to_matrix()
        center = np.asarray(turn).T @ self.center
        return slips.Case(self.matrix, self.mass, center, self.texts, self.in_rows)


def matrix_of(entries: list[float]) -> Array:
    """Return the symmetric matrix with the entries xx, yy, zz, xy, xz, yz."""
    xx, yy, zz, xy, xz, yz = entries
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


@dataclass
class Link:
    """A link by name: its body, or why it has none."""

    name: str
    node: Node
    body: Body | None = None
    note: str = ""
    errors: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)


def link_of(name: str, node: Node, make: Callable[[], Inertial | Body | None]) -> Link:
    """Return the link whose inertial element, or whose body, a function reads."""
    link = Link(name, node)
    try:
        found = make()
        if found is None:
            link.note = NO_INERTIAL
        elif isinstance(found, Body):
            link.body = found
        elif found.massless:
            link.note = MASSLESS
        else:
            link.body = found.body()
            link.warnings = [
                *found.doubts,
                *(found.node.message(w, "warning") for w in slips.doubts(found.case())),
            ]
    except DocumentError as error:
        link.errors.append(str(error))
    return link


def doubts_of_angles(node: Node, what: str, angles: list[float]) -> tuple[str, ...]:
    """Return the warning of an element with an angle in rad beyond a turn, which is probably in degrees."""
    wrong = [angle for angle in angles if abs(angle) > 2 * math.pi]
    if not wrong:
        return ()
    words = f"{what} has {wrong[0]:g} rad, more than a turn; if it is in degrees, convert it to radians"
    return (node.message(words, "warning"),)


def name_of(node: Node) -> str:
    """Return the name of an element; an error without one."""
    name = node.attributes.get("name", "")
    if not name:
        raise node.error(f"<{node.tag}> needs the attribute 'name'")
    return name
