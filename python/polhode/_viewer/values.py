"""Documents of values: formulas for those of 3-d space, shapes for those of `pga` and `cga`."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from polhode._algebra.algebra import algebra
from polhode._algebra.cga import CGA, cga
from polhode._algebra.multivector import Multivector
from polhode._algebra.pga import PGA, pga
from polhode._algebra.rotor import Rotor
from polhode._algebra.screws import screw_parameters
from polhode._algebra.transform import RigidTransform
from polhode._support.arrays import is_float

Shape = dict[str, Any]
# What a value is, and what is drawn of it.
_Reader = Callable[[Any, Multivector], tuple[str, list[Shape]]]

# The page draws more only slowly, and lists of formulas that are longer cannot be read.
_MOST_SHAPES, _MOST_LINES = 1000, 24
_NAME = re.compile(r"[^\W\d]\w*'*")
_TOLERANCE = 1e-9


def of_values(x: Any) -> dict[str, Any]:
    """Return the document of values, of a list of values, or of values by name.

    Values of 3-d space become formulas, which can be changed in the page. Those of `polhode.pga` and
    `polhode.cga` become points, lines, planes, spheres, circles and screws. Elements of a batch are drawn
    together.
    """
    lines: list[str] = []
    given: list[dict[str, Any]] = []
    named = list(_named(x))
    if not named:
        raise ValueError("no values to show: give one, a list of them, or a dict of them by name")
    for name, value in named:
        if isinstance(value, Multivector) and value.algebra is algebra(3):
            lines += _formulas(name, value)
        else:
            given.append(_given(name or f"({len(given) + 1})", value))
    shown: dict[str, Any] = {"format": 1, "page": "algebra", "lines": "\n".join(lines)}
    return {**shown, "values": given} if given else shown


def _named(x: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(x, Mapping):
        for name, value in x.items():
            if not isinstance(name, str) or not _NAME.fullmatch(name):
                raise ValueError(f"{name!r} is not a name: use a letter, then letters and digits")
            yield name, value
    else:
        yield from (("", value) for value in (x if isinstance(x, Sequence) else [x]))


# --- 3-d space


def _formulas(name: str, value: Multivector) -> list[str]:
    """Return the lines of a value; the elements of a batch are named a1, a2 and so on."""
    if not is_float(value._data):
        value = value.map(float if value._data.dtype == object else np.asarray)
    if value.shape == ():
        return [_line(name, value)]
    if math.prod(value.shape) > _MOST_LINES:
        raise ValueError(
            f"{name or 'the batch'} has shape {value.shape}: at most {_MOST_LINES} values of Cl(3) are shown"
        )
    elements = value.reshape(-1)
    return [_line(name and f"{name}{k + 1}", elements[k]) for k in range(elements.shape[0])]


def _line(name: str, value: Multivector) -> str:
    text = f"exp({value.log():.6g})" if isinstance(value, Rotor) else f"{value:.6g}"
    return f"{name} = {text}" if name else text


# --- projective and conformal geometry


def _given(name: str, value: Any) -> dict[str, Any]:
    if isinstance(value, RigidTransform):
        value = pga(3).motor(value)
    if not isinstance(value, Multivector):
        raise TypeError(f"cannot show {name}, of type {type(value).__name__}, among values")
    if value.algebra is not pga(3) and value.algebra is not cga(3):
        raise TypeError(
            f"cannot show {name}, a value of {value.algebra}: the page draws values of Cl(3), ph.pga(3) and "
            "ph.cga(3)"
        )
    if (size := math.prod(value.shape)) > _MOST_SHAPES:
        raise ValueError(f"{name} has shape {value.shape}: at most {_MOST_SHAPES} values are shown")
    found = [_shapes(value[index]) for index in np.ndindex(value.shape)]
    kinds = sorted({kind for kind, _ in found})
    kind = " or ".join(kinds) if value.shape == () else f"{size} × {' or '.join(kinds)}"
    text = f"{value:.4g}" if value.shape == () else f"shape {value.shape}"
    return {"name": name, "kind": kind, "text": text, "shapes": [shape for _, all in found for shape in all]}


def _shapes(X: Multivector) -> tuple[str, list[Shape]]:
    """Return what a single value is, and what is drawn of it."""
    space = X.algebra
    if not np.isfinite(X.components).all():
        raise ValueError(f"cannot show the value {X!r}, which is not finite")
    X = _without_rounding(X)
    if isinstance(space, PGA):
        return _PROJECTIVE.get(X.grades, _motor)(space, X)
    return _CONFORMAL.get(X.grades, _other)(space, X)


def _without_rounding(X: Multivector) -> Multivector:
    """Return the grades that are more than rounding errors of the largest component."""
    least = _TOLERANCE * float(np.max(np.abs(X.components), initial=0.0))
    held = [k for k in X.grades if np.max(np.abs(X.grade(k).components)) > least]
    return X.grade(*(held or X.grades[:1]))


def _other(space: Any, X: Multivector) -> tuple[str, list[Shape]]:
    return "multivector", []


def _numbers(x: Any) -> list[float]:
    return [float(v) for v in (x.components if isinstance(x, Multivector) else x)]


def _plane(space: Any, X: Multivector) -> tuple[str, list[Shape]]:
    normal, distance = space.normal_and_distance(X)
    return "plane", [{"kind": "plane", "at": _numbers(normal * distance), "normal": _numbers(normal)}]


def _line_through(space: Any, X: Multivector) -> tuple[str, list[Shape]]:
    at, along = space.point_and_direction(X)
    return "line", [{"kind": "line", "at": _numbers(at), "along": _numbers(along)}]


def _point(space: Any, X: Multivector) -> tuple[str, list[Shape]]:
    return "point", [{"kind": "point", "at": _numbers(space.down(X))}]


def _projective_plane(space: PGA, X: Multivector) -> tuple[str, list[Shape]]:
    return ("plane at infinity", []) if X.norm() == 0 else _plane(space, X)


def _projective_line(space: PGA, X: Multivector) -> tuple[str, list[Shape]]:
    square = float(X.norm())
    if square == 0:
        return "line at infinity", []
    if abs((X ^ X)["I"]) > _TOLERANCE * square**2:
        return "bivector", []
    return _line_through(space, X)


def _projective_point(space: PGA, X: Multivector) -> tuple[str, list[Shape]]:
    weight, *along = (X["e123"], X["e032"], X["e013"], X["e021"])
    if weight != 0:
        return _point(space, X)
    size = math.hypot(*along)
    return "direction", [{"kind": "direction", "along": [x / size for x in along]}] if size else []


def _motor(space: Any, M: Multivector) -> tuple[str, list[Shape]]:
    """A motor as a rotation about an axis and a translation along it."""
    if any(k % 2 for k in M.grades):
        return "multivector", []
    try:
        axis, point, angle, distance = screw_parameters(M)
    except ValueError:
        return "multivector", []
    if angle == 0 and distance == 0:
        return "motor", []
    turn = {"angle": float(angle), "shift": float(distance)}
    return "motor", [{"kind": "screw", "at": _numbers(point), "along": _numbers(axis), **turn}]


def _conformal_vector(space: CGA, X: Multivector) -> tuple[str, list[Shape]]:
    """A point, or the dual of a sphere or a plane."""
    if abs(float(X.norm_squared())) > _TOLERANCE * float(X.components @ X.components):
        kind, shapes = _round_or_flat("sphere", _plane)(space, X.dual())
        return f"dual {kind}", shapes
    return ("point at infinity", []) if (X | space.einf) == 0 else _point(space, X)


def _point_pair(space: CGA, X: Multivector) -> tuple[str, list[Shape]]:
    if (X ^ space.einf).is_close(0):
        return "flat point", []
    if space.squared_radius(X) < 0:
        return "imaginary point pair", []
    return "point pair", [{"kind": "point", "at": _numbers(at)} for at in space.points(X)]


def _round_or_flat(name: str, flat: _Reader) -> _Reader:
    """Return the reader of a grade whose values are circles or lines, or spheres or planes."""

    def shapes(space: CGA, X: Multivector) -> tuple[str, list[Shape]]:
        carrier = X ^ space.einf
        if carrier.is_close(0, atol=_TOLERANCE * float(np.max(np.abs(X.components)))):
            return flat(space, X)
        if space.squared_radius(X) < 0:
            return f"imaginary {name}", []
        shape = {"kind": name, "at": _numbers(space.center(X)), "radius": float(space.radius(X))}
        if name == "circle":
            shape["normal"] = _numbers(space.normal_and_distance(carrier)[0])
        return name, [shape]

    return shapes


_PROJECTIVE: dict[tuple[int, ...], _Reader] = {
    (1,): _projective_plane,
    (2,): _projective_line,
    (3,): _projective_point,
}
_CONFORMAL: dict[tuple[int, ...], _Reader] = {
    (1,): _conformal_vector,
    (2,): _point_pair,
    (3,): _round_or_flat("circle", _line_through),
    (4,): _round_or_flat("sphere", _plane),
}
