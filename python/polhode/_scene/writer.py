"""Problem of a simulation, and the scene file that states it."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.multivector import Multivector
from polhode._mechanics.bodies import Body
from polhode._mechanics.problem import Problem
from polhode._mechanics.registry import FORCES, TORQUES, Entry


class UnwritableError(ValueError):
    """A problem that a scene file cannot state."""


def scene_text(problem: Problem) -> str:
    """Return the scene, in TOML, whose body, start and laws are these to the last bit.

    Its output times go from the start to the last one in equal intervals. Principal moments are found
    from the same inertia matrix again, to its rounding, and rise where it is not diagonal. An
    `UnwritableError` for Python functions, linear maps, a law that stands twice, and motions that do not
    go beyond their start.
    """
    laws = problem.torque.laws if problem.torque else ()
    tables = {
        "define": _definitions(law for law in laws if law.name == "formula"),
        "body": _body(problem),
        "initial": _initial(problem),
        "torque": _fields(laws, TORQUES, "torque"),
        "force": _fields(problem.force.laws if problem.force else (), FORCES, "force"),
        "run": _run(problem),
        "method": _method(problem),
    }
    written = [
        "\n".join([f"[{title}]", *(f"{_key(name)} = {_value(x)}" for name, x in table.items())])
        for title, table in tables.items()
        if table
    ]
    return f"# Written by Polhode {_native.__version__}. SI units.\n\n" + "\n\n".join(written) + "\n"


def _body(problem: Problem) -> dict[str, Any]:
    inertia = problem.body.inertia if isinstance(problem.body, Body) else problem.body
    frame, moments = inertia.principal_frame.components, inertia.principal_moments
    own = np.array_equal(frame, [1, 0, 0, 0]) and np.array_equal(np.diag(moments), inertia.matrix)
    fields: dict[str, Any] = {"moments": moments} if own else {"inertia": inertia.matrix}
    if isinstance(problem.body, Body):
        fields |= {"mass": problem.body.mass, "center_of_mass": problem.body.center_of_mass.components}
    return fields


def _initial(problem: Problem) -> dict[str, Any]:
    state = problem.state
    fields: dict[str, Any] = {
        "attitude": {"rotor": state.rotor.components},
        "spin": {"bivector": state.omega_body.components},
    }
    moving = {"position": state.position.components, "velocity": state.velocity.components}
    fields |= {name: components for name, components in moving.items() if components.any()}
    return fields | ({"time": state.time} if state.time else {})


def _run(problem: Problem) -> dict[str, Any]:
    start = float(problem.state.time)
    duration = float(np.max(problem.times, initial=start)) - start
    if duration <= 0:
        raise UnwritableError(
            f"a scene needs an output time after its start at {start:g} s, and this motion has none"
        )
    return {"duration": duration, "samples": max(2, len(problem.times))}


def _method(problem: Problem) -> dict[str, Any]:
    if problem.tolerance is not None and problem.tolerance >= 1:
        raise UnwritableError(f"tolerance must be less than 1 in a scene, got {problem.tolerance}")
    max_step, max_steps, breaks = problem.limits
    if breaks:
        raise UnwritableError("breaks cannot be written to a scene file; use max_step")
    fields = {
        # Without a method, scenes use a closed form if there is one.
        "name": None if problem.method in ("auto", "exact") else problem.method,
        "step": problem.step,
        "rtol": problem.tolerance,
        "max_step": max_step,
        "max_steps": max_steps,
    }
    return {name: value for name, value in fields.items() if value is not None}


# --- laws, as the fields of [torque] and [force]


def _fields(laws: Iterable[Any], entries: Mapping[str, Entry], table: str) -> dict[str, Any]:
    """Return the fields of a table whose laws add up, in their order."""
    fields: dict[str, Any] = {}
    for law in laws:
        is_formula = (table, law.name) == ("torque", "formula")
        name = f"torque_{law.arguments[1]}" if is_formula else law.name
        if name in fields:
            raise UnwritableError(
                f"a scene file has at most one {table} `{name}`, and this motion has two; add them"
            )
        if is_formula:
            fields[name] = law.arguments[0]
        elif name in entries:
            fields[name] = _field(entries[name], law.arguments)
        elif name == "function":
            raise UnwritableError(
                "Python callables cannot be written to a scene file; use a formula, as of ph.torque.formula"
            )
        elif name in ("reaction_wheels", "magnetic_on_orbit"):
            raise UnwritableError(f"{table}.{name} cannot be written to a scene file; keep the motion itself")
        else:
            raise UnwritableError(f"{table}.{name} cannot be written to a scene file; use {table}.formula")
    return fields


def _field(entry: Entry, arguments: tuple[Any, ...]) -> Any:
    """Return the value of a law's field in a scene."""
    values = {
        argument.field: {"rotor": value} if argument.shape == "rotor" else value
        for argument, value in zip(entry.arguments, arguments, strict=False)
    }
    return values.get("", values)


def _definitions(formulas: Iterable[Any]) -> dict[str, Any]:
    """Return the values of names in formulas."""
    defined: dict[str, Any] = {}
    for law in formulas:
        for name, value in law.arguments[2]:
            text = _definition(name, value)
            if defined.setdefault(name, text) != text:
                raise UnwritableError(f"`{name}` has two values in formulas; a scene file has one for all")
    return defined


def _definition(name: str, value: Any) -> float | str:
    """Return a number, or a multivector as a sum of components."""
    if isinstance(value, float):
        return value
    if not isinstance(value, Multivector):
        raise UnwritableError(f"`{name}` is not a multivector; linear maps cannot be written to a scene file")
    names = value.algebra._names(value._mask)
    terms = (f"({float(x)!r}) {name}".strip() for x, name in zip(value.components, names, strict=True))
    # In a formula, e may be a basis vector.
    return " + ".join(terms).replace("e+", "E+").replace("e-", "E-") or "0"


# --- TOML


def _key(name: str) -> str:
    return name if name.isascii() and name.isidentifier() else _value(name)


def _value(value: Any) -> str:
    if isinstance(value, str):
        # TOML has the escapes of JSON and one more.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(name)} = {_value(x)}" for name, x in value.items()) + " }"
    if isinstance(value, int):
        return str(value)
    if np.ndim(value):
        return "[" + ", ".join(map(_value, value)) + "]"
    return repr(float(value))
