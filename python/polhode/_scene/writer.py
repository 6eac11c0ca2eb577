"""Problem of a simulation, and the scene file that states it."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.multivector import Multivector
from polhode._mechanics.bodies import Body, Inertia
from polhode._mechanics.state import State
from polhode._support.arrays import Array
from polhode.force import Force
from polhode.torque import Torque


class UnwritableError(ValueError):
    """A problem that a scene file cannot state."""


@dataclass(frozen=True, eq=False)
class Problem:
    """The arguments of `polhode.simulate` for one body.

    Attributes
    ----------
    body
        A `Body`, or the `Inertia` that rules its motion.
    state
        The single state at the start.
    torque, force
        Torque and force; None without.
    times
        Output times in s, (n,).
    method, step, tolerance
        As for `polhode.simulate`; the larger one of rtol and atol.
    limits
        `max_step`, `max_steps` and `breaks`.
    """

    body: Body | Inertia
    state: State
    torque: Torque | None
    force: Force | None
    times: Array
    method: str = "auto"
    step: float | None = None
    tolerance: float | None = None
    limits: tuple[float | None, float | None, list[float]] = (None, None, [])

    @property
    def held(self) -> bool:
        """Whether the body is held at a fixed point, the origin of its axes."""
        return self.torque is not None and self.torque.holds

    def scene(self) -> str:
        """Return the scene in TOML; body, start and laws are exact to the last bit.

        Its output times go from the start to the last one in equal intervals. Principal moments follow from
        the inertia matrix, to rounding, and are in ascending order if it is not diagonal.

        Raises
        ------
        UnwritableError
            For Python functions, linear maps, a law that occurs twice, and motions without a time after the
            start.
        """
        laws = self.torque.laws if self.torque else ()
        tables = {
            "define": _definitions(law for law in laws if law.name == "formula"),
            "body": self._body(),
            "initial": self._initial(),
            "torque": _fields(laws, _TORQUES, "torque"),
            "force": _fields(self.force.laws if self.force else (), _FORCES, "force"),
            "run": self._run(),
            "method": self._method(),
        }
        written = [
            "\n".join([f"[{title}]", *(f"{_key(name)} = {_value(x)}" for name, x in table.items())])
            for title, table in tables.items()
            if table
        ]
        return f"# Written by Polhode {_native.__version__}. SI units.\n\n" + "\n\n".join(written) + "\n"

    def _body(self) -> dict[str, Any]:
        inertia = self.body.inertia if isinstance(self.body, Body) else self.body
        frame, moments = inertia.principal_frame.components, inertia.principal_moments
        own = np.array_equal(frame, [1, 0, 0, 0]) and np.array_equal(np.diag(moments), inertia.matrix)
        fields: dict[str, Any] = {"moments": moments} if own else {"inertia": inertia.matrix}
        if isinstance(self.body, Body):
            fields |= {"mass": self.body.mass, "center_of_mass": self.body.center_of_mass.components}
        return fields

    def _initial(self) -> dict[str, Any]:
        fields: dict[str, Any] = {
            "attitude": {"rotor": self.state.rotor.components},
            "spin": {"bivector": self.state.omega_body.components},
        }
        for name in ("position", "velocity"):
            components = getattr(self.state, name).components
            if components.any():
                fields[name] = components
        if self.state.time:
            fields["time"] = self.state.time
        return fields

    def _run(self) -> dict[str, Any]:
        start = float(self.state.time)
        duration = float(np.max(self.times, initial=start)) - start
        if duration <= 0:
            raise UnwritableError(
                f"a scene needs an output time after its start at {start:g} s, and this motion has none"
            )
        return {"duration": duration, "samples": max(2, len(self.times))}

    def _method(self) -> dict[str, Any]:
        fields: dict[str, Any] = {}
        # Without a method, scenes use a closed form if there is one.
        if self.method not in ("auto", "exact"):
            fields["name"] = self.method
        if self.step is not None:
            fields["step"] = self.step
        if self.tolerance is not None:
            if self.tolerance >= 1:
                raise UnwritableError(f"tolerance must be less than 1 in a scene, got {self.tolerance}")
            fields["rtol"] = self.tolerance
        max_step, max_steps, breaks = self.limits
        if breaks:
            raise UnwritableError("breaks cannot be written to a scene file; use max_step")
        given = {"max_step": max_step, "max_steps": max_steps}
        fields |= {name: value for name, value in given.items() if value is not None}
        return fields


# --- laws, as the fields of [torque] and [force]


def _gradient(n: float, eccentricity: float, mean_anomaly: float) -> dict[str, float]:
    return {"rate": n, "eccentricity": eccentricity, "mean_anomaly": mean_anomaly}


def _tabulated(times: Any, torques: Any, frame: str, kind: str) -> dict[str, Any]:
    return {"times": times, "torques": torques, "frame": frame, "kind": kind}


def _thrust(F: Any, at: Any = None) -> dict[str, Any]:
    return {"force": F} if at is None else {"force": F, "at": at}


def _rotor(components: Any) -> dict[str, Any]:
    return {"rotor": components}


# The value of a law's field, from the law's arguments.
_Field = Callable[..., Any]

_TORQUES: dict[str, _Field] = {
    **dict.fromkeys(
        (
            "heavy",
            "larmor",
            "damping",
            "viscous_damping",
            "quadratic_damping",
            "gyrostat",
            "constant_body",
            "constant_space",
        ),
        lambda argument: argument,
    ),
    "gravity_gradient": _gradient,
    "magnetic": lambda dipole, field: {"dipole": dipole, "field": field},
    "torsion_spring": lambda k, rest: {"stiffness": k, "rest": _rotor(rest)},
    "pd_control": lambda kp, kd, target: {"kp": kp, "kd": kd, "target": _rotor(target)},
    "tabulated": _tabulated,
    "formula": lambda text, frame, values: text,
}

_FORCES: dict[str, _Field] = {
    **dict.fromkeys(("constant", "drag", "quadratic_drag", "central"), lambda argument: argument),
    "thrust": _thrust,
    "spring": lambda k, anchor: {"stiffness": k, "anchor": anchor},
}


def _fields(laws: Iterable[Any], known: dict[str, _Field], what: str) -> dict[str, Any]:
    """Return the fields of laws in [torque] or [force]."""
    fields: dict[str, Any] = {}
    for law in laws:
        if law.name not in known:
            raise UnwritableError(f"{what}.{law.name} cannot be written to a scene file; use {what}.formula")
        name = f"torque_{law.arguments[1]}" if (what, law.name) == ("torque", "formula") else law.name
        if name in fields:
            raise UnwritableError(
                f"a scene file has at most one {what} `{name}`, and this motion has two; add them"
            )
        fields[name] = known[law.name](*law.arguments)
    return fields


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
