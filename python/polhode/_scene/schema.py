"""The JSON Schema of scene files, for editors: fields, choices and units."""

from __future__ import annotations

from itertools import combinations
from typing import Any

from polhode._mechanics.arguments import METHODS
from polhode._mechanics.registry import FORCES, FRAMES, TORQUES, Argument, Entry
from polhode._native import kept_words

Schema = dict[str, Any]

# Fields that may be given instead of others: a period for a rate.
_PERIODS = {"rate": "period"}
_SIZES = {
    "box": ("lengths",),
    "ellipsoid": ("semi_axes",),
    "sphere": ("radius",),
    "hollow_sphere": ("outer_radius", "inner_radius"),
    "cylinder": ("radius", "height"),
    "cone": ("radius", "height"),
    "rod": ("length",),
    "disc": ("radius",),
    "torus": ("major_radius", "minor_radius"),
    "capsule": ("radius", "height"),
}
_FORMULA: Schema = {"type": "string"}


def scene_schema() -> Schema:
    """Return the JSON Schema (draft 7) of scene files.

    Laws, their arguments and units are those of the core's registry. Units and formulas in strings are not
    checked by the schema; ``polhode check`` checks them.
    """
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "Polhode scene",
        "definitions": _DEFINITIONS,
        **_table(
            {
                "title": {"type": "string", "description": "name of the scene"},
                "caption": {"type": "string", "description": "what the motion shows, in words"},
                "body": _body(),
                "initial": _initial(),
                "define": {
                    "type": "object",
                    "description": "names and functions for formulas",
                    "additionalProperties": {"type": ["number", "string"]},
                },
                "gravity": _table(
                    {"acceleration": _quantity("m/s^2"), "pivot": _vector("m")},
                    "uniform gravity on a body held at a pivot",
                    required=("acceleration",),
                ),
                "torque": _laws(
                    TORQUES, "torque laws, which add up", dict.fromkeys(_TORQUE_FORMULAS, _FORMULA)
                ),
                "force": _laws(FORCES, "forces on the centre of mass, which add up", {}),
                "run": _run(),
                "method": _table({"name": {"enum": list(METHODS)}, **_steps()}, "integration method"),
                "ensemble": _ensemble(),
                **dict.fromkeys(_TORQUE_FORMULAS, _FORMULA),
            },
            required=("body", "initial", "run"),
        ),
    }


_TORQUE_FORMULAS = ("torque_body", "torque_space")


# --- tables


def _body() -> Schema:
    amounts = {"density": _quantity("kg/m^3"), "mass": _quantity("kg")}
    placed = {"mass": _quantity("kg"), "center_of_mass": _vector("m")}
    sizes = {
        name: _three("m") if name in ("lengths", "semi_axes") else _quantity("m")
        for names in _SIZES.values()
        for name in names
    }
    solids = [
        _table(
            {"solid": {"const": kind}, **{name: sizes[name] for name in names}, **amounts},
            required=("solid", *names),
        )
        for kind, names in _SIZES.items()
    ]
    mesh = {"mesh": {"type": "string", "description": "path of a closed mesh: STL, OBJ or PLY"}}
    mesh |= {"length_unit": {"type": "string", "description": "unit of the coordinates, default m"}}
    return {
        "description": "the body: mesh, solid, moments or inertia",
        "anyOf": [
            _table({**mesh, **amounts}, required=("mesh",)),
            *solids,
            _table({"moments": _three("kg m^2"), **placed}, required=("moments",)),
            _table({"inertia": _list(_three("kg m^2"), 3), **placed}, required=("inertia",)),
        ],
    }


def _initial() -> Schema:
    frame = {"frame": {"enum": list(FRAMES)}}
    spins = [
        _table({"plane": _plane(), "rate": _quantity("rad/s"), **frame}, required=("plane", "rate")),
        _table({"vector": _three("rad/s"), **frame}, required=("vector",)),
        _table({"bivector": _three("rad/s"), **frame}, required=("bivector",)),
        _table({"formula": _FORMULA, **frame}, required=("formula",)),
    ]
    return _table(
        {
            "attitude": {
                **_attitude(),
                "description": "rotation from body axes to space axes, default identity",
            },
            "spin": {"anyOf": [_FORMULA, *spins], "description": "angular velocity"},
            "position": _vector("m"),
            "velocity": _vector("m/s"),
            "time": _quantity("s", "time of the start, default 0"),
        },
        "the state at the start",
        required=("spin",),
    )


def _attitude() -> Schema:
    order = {"order": {"enum": ["wxyz", "xyzw"]}}
    return {
        "anyOf": [
            _FORMULA,
            _table({"plane": _plane(), "angle": _quantity("rad")}, required=("plane", "angle")),
            _table({"rotor": _list({"type": "number"}, 4)}, required=("rotor",)),
            _table({"quaternion": _list({"type": "number"}, 4), **order}, required=("quaternion", "order")),
            _table({"rotation_vector": _three("rad")}, required=("rotation_vector",)),
        ]
    }


def _run() -> Schema:
    return _table(
        {
            "duration": _quantity("s"),
            "samples": {"type": "integer", "description": "number of output times, default 1001"},
            "interval": _quantity("s", "spacing of the output times"),
            "first": _quantity("s", "first output time after 0"),
            "drift_bound": {"type": "number", "description": "largest accepted relative drift, default 1e-8"},
            "method": {"enum": list(METHODS)},
            **{name: x for name, x in _steps().items() if name in ("step", "rtol")},
        },
        "duration and output times",
        required=("duration",),
    )


def _steps() -> dict[str, Schema]:
    return {
        "step": _quantity("s", "fixed step"),
        "rtol": {"type": "number", "description": "relative tolerance"},
        "atol": {"type": "number", "description": "absolute tolerance"},
        "max_step": _quantity("s", "longest step"),
        "max_steps": {"type": "number", "description": "maximum number of steps, default 1e8"},
    }


def _ensemble() -> Schema:
    covariance = _table(
        {
            "of": {"type": "array", "items": {"type": "string"}, "minItems": 1},
            "matrix": {"type": "array", "items": {"type": "array", "items": {"type": "number"}}},
        },
        "normal variations with a covariance matrix, in SI units",
        required=("of", "matrix"),
    )
    return {
        "type": "object",
        "description": "bodies that differ from the body of the scene",
        "properties": {
            "number": {"type": "integer", "minimum": 1, "description": "number of bodies"},
            "seed": {"type": "integer", "minimum": 0, "description": "random seed, default 0"},
            "keep": {
                "type": "array",
                "items": {"enum": kept_words()},
                "minItems": 1,
                "description": "what is kept of the motions, instead of them",
            },
            "covariance": {"anyOf": [covariance, {"type": "array", "items": covariance}]},
            "grid": _points("values of the scene, each combined with each; the last varies fastest"),
            "list": _points("values of the scene, one for each body"),
            "table": {"type": "string", "description": "path of a table of bodies: CSV or Parquet"},
        },
        "allOf": [{"not": {"required": list(pair)}} for pair in combinations(("grid", "list", "table"), 2)],
    }


def _points(text: str) -> Schema:
    """Return the schema of lists and ranges at the paths of scene values."""
    tables = ("body", "initial", "define", "gravity", "torque", "force")
    return {
        "type": "object",
        "description": text,
        "minProperties": 1,
        "propertyNames": {"pattern": f"^({'|'.join(tables)})([.].+)?$"},
        "additionalProperties": {"$ref": "#/definitions/points"},
    }


# Lists at the fields of a table of the scene, or in tables in it.
_DEFINITIONS: Schema = {
    "points": {
        "anyOf": [
            {"type": "array", "minItems": 1},
            {
                "type": "object",
                "properties": {
                    "from": {"type": ["number", "string"]},
                    "to": {"type": ["number", "string"]},
                    "number": {"type": "integer", "minimum": 2},
                    "spacing": {"enum": ["linear", "log"]},
                },
                "required": ["from", "to", "number"],
                "additionalProperties": False,
            },
            {
                "type": "object",
                "minProperties": 1,
                "not": {"anyOf": [{"required": ["from"]}, {"required": ["to"]}]},
                "additionalProperties": {"$ref": "#/definitions/points"},
            },
        ]
    }
}


# --- laws


def _laws(entries: dict[str, Entry], text: str, more: dict[str, Schema]) -> Schema:
    return _table({**{name: _law(entry) for name, entry in entries.items()}, **more}, text)


def _law(entry: Entry) -> Schema:
    """Return the schema of a law: its value, or a table of its arguments."""
    text = f"{entry.label}: {entry.formula}" if entry.formula else entry.label
    if [x.field for x in entry.arguments] == [""]:
        return {**_argument(entry.arguments[0]), "title": text}
    fields = {x.field: _argument(x) for x in entry.arguments}
    required = []
    for x in entry.arguments:
        period = _PERIODS.get(x.field)
        if period is not None:
            fields[period] = _quantity("s")
        elif x.default is None:
            required.append(x.field)
    return {**_table(fields, required=tuple(required)), "title": text}


def _argument(argument: Argument) -> Schema:
    match argument.shape:
        case "scalar":
            return _quantity(argument.unit)
        case "vector" | "bivector":
            return _vector(argument.unit)
        case "gains":
            return {
                "anyOf": [_quantity(argument.unit), _three(argument.unit)],
                "description": _unit(argument.unit),
            }
        case "rotor":
            return _attitude()
        case "numbers":
            return {"type": "array", "items": _quantity(argument.unit)}
        case "bivectors":
            return {"type": "array", "items": _vector(argument.unit)}
        case "word":
            return {"enum": list(argument.words)}
    raise ValueError(f"no schema for arguments of shape {argument.shape!r}")


# --- values


def _table(properties: dict[str, Schema], text: str = "", required: tuple[str, ...] = ()) -> Schema:
    schema: Schema = {"type": "object", "properties": properties, "additionalProperties": False}
    if text:
        schema["description"] = text
    if required:
        schema["required"] = list(required)
    return schema


def _unit(unit: str, text: str = "") -> str:
    words = "a number" if unit == "1" else f'a number in {unit}, or text with a unit such as "1 {unit}"'
    return f"{text}: {words}" if text else words


def _quantity(unit: str, text: str = "") -> Schema:
    return {"type": ["number", "string"], "description": _unit(unit, text)}


def _list(items: Schema, count: int) -> Schema:
    return {"type": "array", "items": items, "minItems": count, "maxItems": count}


def _three(unit: str) -> Schema:
    return _list(_quantity(unit), 3)


def _vector(unit: str) -> Schema:
    """Return the schema of a vector or bivector: three quantities, or a formula."""
    return {"anyOf": [_FORMULA, _three(unit)], "description": f"three components ({unit}), or a formula"}


def _plane() -> Schema:
    return {
        "anyOf": [_FORMULA, _list({"type": "number"}, 3)],
        "description": "a bivector: a formula, or components",
    }
