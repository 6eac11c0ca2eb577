"""Torque laws for `polhode.jax.simulate`, with the names and arguments of `polhode.torque`.

Arguments may be traced, and may be batches that broadcast with the bodies; ``jax.grad`` differentiates with
respect to them. Laws of `polhode.torque` are accepted too; their parameters are constants.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from typing import Any, ParamSpec

import numpy as np

from polhode import torque as native
from polhode._algebra.constructors import bivector, vector
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.laws import one_of
from polhode._mechanics.registry import FRAMES, TORQUES
from polhode._support.arrays import as_floats
from polhode.jax import _laws as laws
from polhode.jax._arguments import as_array, rows
from polhode.jax._components import Four, Three, joined, normalized, split
from polhode.jax._formula_law import Formula, value_of
from polhode.jax._laws import Torque, kernel
from polhode.jax._library import jax
from polhode.jax._orbit import tide
from polhode.jax._table import Table, spline_slopes

__all__ = [
    "Torque",
    "constant_body",
    "constant_space",
    "damping",
    "formula",
    "function",
    "gravity_gradient",
    "gyrostat",
    "heavy",
    "larmor",
    "magnetic",
    "pd_control",
    "quadratic_damping",
    "radiation_pressure",
    "tabulated",
    "torsion_spring",
    "viscous_damping",
]


P = ParamSpec("P")


def __dir__() -> list[str]:
    return __all__


def _law(
    constructor: Callable[P, native.Torque], kernel: Callable[..., Any] | None = None
) -> Callable[P, Torque]:
    """Return a constructor of `polhode.torque` for JAX arrays, which may be traced.

    Without a kernel the law is evaluated by its formula in the registry.
    """
    signature, entry = inspect.signature(constructor), TORQUES[constructor.__name__]

    @functools.wraps(constructor)
    def law(*args: P.args, **kwargs: P.kwargs) -> Torque:
        bound = signature.bind(*args, **kwargs)
        bound.apply_defaults()
        # Arguments that the registry does not have, such as an orbit, select laws that JAX does not have.
        for name in [*bound.arguments][len(entry.arguments) :]:
            if bound.arguments[name] is not None:
                raise TypeError(
                    f"JAX has no law {constructor.__name__} with {name}; give a function of t, rotor and "
                    "omega_body in jax.numpy"
                )
        given = zip(entry.arguments, bound.arguments.values(), strict=False)
        values = {x.name: _CONVERSIONS[x.shape](value, x.name) for x, value in given}
        if kernel is not None:
            return Torque((kernel(*values.values()),))
        named = {x.name: _named(values[x.name], x.shape) for x in entry.arguments}
        return Torque((Formula(named, None, entry.formula, "body"),))

    law.__module__ = __name__
    return law


def _named(value: Any, shape: str) -> Multivector:
    """Return an argument as a value of a formula."""
    if shape == "scalar":
        return value_of(value, shape)
    make: dict[str, Callable[[Any], Multivector]] = {"vector": vector, "bivector": bivector}
    return make.get(shape, Rotor._from_rows)(joined(value))


def _control(kp: Three, kd: Three, target: Four) -> laws.Kernel:
    damped = any(isinstance(x, jax.core.Tracer) or bool(np.any(np.asarray(x) != 0)) for x in kd)
    f = laws.control if damped else laws.undamped_control
    return kernel(f, "gains", "gains", "rotor", rate=damped)(kp, kd, target)


def tabulated(times: Any, torques: Any, frame: str = "body", kind: str = "linear") -> Torque:
    """Return a torque interpolated in a table, as `polhode.torque.tabulated`.

    The times (n,) are constants, the torques (n, 3) may be traced. Outside the times the torque is NaN. Steps
    end at the times unless the output times are traced; then a step across a jump of ``kind="previous"``
    takes the torque of its middle.
    """
    when, table = as_floats(times, "times"), rows(torques, 3, "torques", grade=2)
    # Raises for wrong times, frame and kind.
    native.tabulated(when, np.zeros((*table.shape[:-1], 3)), frame, kind)
    slopes = spline_slopes(when, table) if kind == "cubic" and when.size > 2 else None
    return Torque((Table(table, slopes, tuple(when.tolist()), frame, held=kind == "previous"),))


def formula(text: str, /, *, frame: str = "body", **values: Any) -> Torque:
    """Return the torque of a formula, with the names of `polhode.torque.formula` but ``x``, ``v`` and ``m``.

    Values are multivectors, rotors and numbers, which may be traced; linear maps are not supported.
    """
    given = {name: value_of(value, name) for name, value in values.items()}
    return Torque((Formula(given, None, text, one_of(FRAMES, frame, "frame")).checked(),))


def function(f: Callable[[Any, Any, Any], Any]) -> Torque:
    """Return the torque of a function in ``jax.numpy``: ``f(t, rotor, omega_body)``.

    It is called with the time in s, the rotor's components (..., 4) from body axes to space and those of the
    angular velocity (..., 3) in body axes, and returns the torque (..., 3) in body axes. Values that it
    closes over may be traced.
    """
    if not callable(f) or isinstance(f, Multivector):
        raise TypeError(f"expected a function of t, rotor and omega_body, got {type(f).__name__}")
    if isinstance(f, jax.tree_util.Partial):
        return Torque((laws.Function(partial=f, frame=None, f=None),))
    return Torque((laws.Function(partial=None, frame=None, f=f),))


def of(torque: Any) -> Torque:
    """Return a torque for JAX from a torque of this module or of `polhode.torque`, a function or None."""
    if torque is None:
        return Torque(())
    if isinstance(torque, Torque):
        return torque
    if isinstance(torque, native.Torque):
        return sum((_of_native(law) for law in torque.laws), Torque(()))
    own = getattr(torque, "__module__", None) == __name__
    if callable(torque) and not own and not isinstance(torque, Multivector):
        return function(torque)
    raise TypeError(
        f"torque must be a law of polhode.jax.torque, such as heavy(c), got {type(torque).__name__}"
    )


def _of_native(law: Any) -> Torque:
    if law.name == "function":
        raise TypeError("JAX cannot trace a law of polhode.torque.function; give a function in jax.numpy")
    if law.name == "formula":
        text, frame, values = law.arguments
        return formula(text, frame=frame, **dict(values))
    if law.name == "gravity":
        return heavy(law.weight_moments().reshape(*law.shape, 3))
    if law.name not in __all__:
        raise TypeError(f"JAX has no law {law.name}; give a function of t, rotor and omega_body in jax.numpy")
    torque: Torque = globals()[law.name](*law.arguments)
    return torque


def _gains(value: Any, name: str) -> Three:
    array = as_array(value, name)
    return split(array) if array.shape[-1:] == (3,) else (array,) * 3


def _rotor(value: Any, name: str) -> Four:
    if value is None:
        return split(as_array([1.0, 0.0, 0.0, 0.0], name))
    array = as_array(value, name)
    if array.shape[-1:] != (4,):
        raise ValueError(
            f"{name} needs the 4 components of a rotor in the last axis, got shape {array.shape}"
        )
    return normalized(split(array))


_CONVERSIONS: dict[str, Callable[[Any, str], Any]] = {
    "scalar": as_array,
    "vector": lambda value, name: split(rows(value, 3, name, grade=1)),
    "bivector": lambda value, name: split(rows(value, 3, name, grade=2)),
    "gains": _gains,
    "rotor": _rotor,
}

constant_body = _law(native.constant_body, kernel(laws.fixed_in_body, "body"))
constant_space = _law(native.constant_space, kernel(laws.fixed_in_space, "space"))
damping = _law(native.damping, kernel(laws.damped_momentum, "scalar"))
gravity_gradient = _law(native.gravity_gradient, kernel(tide, "scalar", "scalar", "scalar"))
gyrostat = _law(native.gyrostat, kernel(laws.wheel, "body"))
heavy = _law(native.heavy, kernel(laws.weight, "body"))
larmor = _law(native.larmor, kernel(laws.precession, "space", rate=True))
magnetic = _law(native.magnetic, kernel(laws.dipole, "body", "space"))
pd_control = _law(native.pd_control, _control)
quadratic_damping = _law(native.quadratic_damping, kernel(laws.quadratic, "scalar", rate=True))
radiation_pressure = _law(native.radiation_pressure)
torsion_spring = _law(native.torsion_spring, kernel(laws.stiffness, "scalar", "rotor"))
viscous_damping = _law(native.viscous_damping, kernel(laws.viscous, "gains", rate=True))
