"""Positions and orientations of MJCF elements."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from polhode._algebra.rotor import Rotor
from polhode._mechanics.robots.document import Node

Place = tuple[Rotor, list[float]]

_COUNTS = {"quat": 4, "axisangle": 4, "euler": 3, "xyaxes": 6, "zaxis": 3}


@dataclass(frozen=True)
class Compiler:
    """The settings of <compiler> that affect inertias."""

    degrees: bool
    euler_sequence: str
    inertia_from_geom: str
    # First and last.
    groups: tuple[float, float]
    total_mass: float


def place_of(node: Node, compiler: Compiler, attributes: dict[str, str] | None = None) -> Place:
    """Return rotor and position of an element in its parent; `attributes` replace those of the element."""
    own = node if attributes is None else with_attributes(node, attributes)
    return _rotor(own, compiler), own.numbers("pos", 3) or [0.0] * 3


def with_attributes(node: Node, attributes: dict[str, str]) -> Node:
    """Return an element at the same place with other attributes."""
    return Node(node.tag, attributes, node.source, node.line, node.column)


def _rotor(node: Node, compiler: Compiler) -> Rotor:
    given = [name for name in _COUNTS if name in node.attributes]
    if len(given) > 1:
        raise node.error(f"<{node.tag}> has several orientations, {' and '.join(given)}; keep one")
    if not given:
        return Rotor.identity()
    (name,) = given
    values = np.array(node.numbers(name, _COUNTS[name]))
    unit = math.radians(1) if compiler.degrees else 1.0
    if name == "quat":
        return Rotor.from_quaternion(_unit(node, name, values), order="wxyz")
    if name == "axisangle":
        return Rotor.from_rotation_vector(_unit(node, name, values[:3]) * (values[3] * unit))
    if name == "euler":
        return _euler(compiler.euler_sequence, (values * unit).tolist())
    if name == "xyaxes":
        x = _unit(node, name, values[:3])
        y = _unit(node, name, values[3:] - x * (x @ values[3:]))
        return Rotor.from_matrix(np.column_stack([x, y, np.cross(x, y)]))
    return to_axis(_unit(node, name, values))


def _unit(node: Node, name: str, values: np.ndarray) -> np.ndarray:
    length = float(np.linalg.norm(values))
    if not length > 1e-10:
        raise node.error(f"attribute {name!r} of <{node.tag}> has a vector of length 0, or parallel axes")
    return values / length


def _euler(sequence: str, angles: list[float]) -> Rotor:
    """Return a product of turns; unlike in SciPy, lower-case axes turn with the body and others are fixed."""
    rotor = Rotor.identity()
    for axis, angle in zip(sequence, angles, strict=True):
        turn = Rotor.from_euler(axis.lower(), angle)
        rotor = rotor * turn if axis.islower() else turn * rotor
    return rotor


def to_axis(axis: np.ndarray) -> Rotor:
    """Return the shortest rotation of e3 to a unit vector; for -e3 about e1, as in MuJoCo."""
    x, y, z = axis.tolist()
    sine = math.hypot(x, y)
    if sine < 1e-14:
        return Rotor.identity() if z > 0 else Rotor.from_rotation_vector([math.pi, 0.0, 0.0])
    angle = math.atan2(sine, z)
    return Rotor.from_rotation_vector([-y / sine * angle, x / sine * angle, 0.0])
