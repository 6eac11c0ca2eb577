"""Values of forces at a state, from their formulas."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.constructors import as_vectors, vector
from polhode._algebra.multivector import Multivector
from polhode._formula.formula import evaluate
from polhode._mechanics.bodies import Body
from polhode._mechanics.registry import FORCES
from polhode._mechanics.state import State


def names_of_motion(body: Body, state: State, t: float) -> dict[str, Any]:
    """Return the values of the names that the motion defines in the formula of a force."""
    rotor, omega, inertia = state.rotor, state.omega_body, body.inertia
    in_space, momentum = rotor(omega), inertia(omega)
    names = {"x": state.position, "v": state.velocity, "m": body.mass, "R": rotor, "t": t, "I": inertia}
    names |= {"Ω_B": omega, "Omega_B": omega, "Ω_S": in_space, "Omega_S": in_space}
    return names | {"L": rotor(momentum), "L_B": momentum}


def value_of(law: _native.Force, motion: dict[str, Any]) -> Multivector:
    """Return the force of a law at a state, a vector in space, given the names of the motion."""
    if law.name == "function":
        f, omega_body = law.arguments
        names = ("t", "x", "v", "R", "Ω_B") if omega_body else ("t", "x", "v", "R")
        found = f(*(motion[name] for name in names))
        components = as_vectors(found, "the force that the function returned")
        if components.shape != (3,):
            raise ValueError(
                f"the force that the function returned must be a single vector, got shape {components.shape}"
            )
        return _finite(vector(components), law)
    if law.name == "formula":
        text, values = law.arguments
        return _finite(evaluate(text, {**motion, **dict(values)}), law)
    entry = FORCES[law.name]
    named = {x.name: _argument(value) for x, value in zip(entry.arguments, law.arguments, strict=False)}
    return _finite(evaluate(entry.formula, {**motion, **named}).grade(1), law)


def _argument(value: float | tuple[float, ...]) -> Any:
    return vector(value) if isinstance(value, tuple) else value


def _finite(force: Multivector, law: _native.Force) -> Multivector:
    if not np.isfinite(force._data).all():
        raise ValueError(f"the force {law.name} at this state is {force}; it must be finite")
    return force
