"""Torque laws for `polhode.jax.simulate`, by the names of `polhode.torque` and with the same meaning.

Their arguments may be traced, and of any batch that goes with that of the bodies: ``jax.grad`` differentiates
by them. A law of `polhode.torque` itself serves too where its parameters are just numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from polhode import torque as native
from polhode._algebra.multivector import Multivector
from polhode._support.arrays import as_floats
from polhode.jax import _laws
from polhode.jax._components import Four, Three, normalized, split
from polhode.jax._formula_law import Formula, value_of
from polhode.jax._laws import Torque
from polhode.jax._library import jax, jnp
from polhode.jax._orbit import GravityGradient
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
    "tabulated",
    "torsion_spring",
    "viscous_damping",
]


def heavy(c: Any) -> Torque:
    """Uniform gravity on a body held at the origin of its axes, ``γ∧c``; c (..., 3) in N m."""
    return Torque((_laws.Heavy(_three(c, "c")),))


def gravity_gradient(n: Any, eccentricity: Any = 0.0, mean_anomaly: Any = 0.0) -> Torque:
    """Return the gradient of a planet's field on a Kepler orbit; n in rad/s, the anomaly in rad."""
    return Torque((GravityGradient(_array(n), _array(eccentricity), _array(mean_anomaly)),))


def magnetic(dipole: Any, field: Any) -> Torque:
    """Return the torque on a dipole (..., 3) of the body in a field (..., 3) that is constant in space."""
    return Torque((_laws.Magnetic(_three(dipole, "the dipole"), _three(field, "the field")),))


def larmor(b: Any) -> Torque:
    """Return the torque whose axial vector in space is ``L x b``, b (..., 3) in rad/s."""
    return Torque((_laws.Larmor(_three(b, "b")),))


def damping(g: Any) -> Torque:
    """Return the torque ``−g I(Ω_B)``, g in 1/s."""
    return Torque((_laws.Damping(_array(g)),))


def viscous_damping(d: Any) -> Torque:
    """Return the torque ``−d Ω_B``, d in N m s: a number, or (..., 3) along the body axes."""
    return Torque((_laws.ViscousDamping(_gains(d), None),))


def quadratic_damping(k: Any) -> Torque:
    """Return the torque ``−k |Ω_B| Ω_B``, k in N m s²."""
    return Torque((_laws.QuadraticDamping(_array(k)),))


def torsion_spring(k: Any, rest: Any = None) -> Torque:
    """Return the torque ``−k Θ`` with ``R = rest exp(−½Θ)``, ``|Θ| <= π``; k in N m per rad."""
    return Torque((_laws.TorsionSpring(_array(k), _rotor(rest)),))


def pd_control(kp: Any, kd: Any, target: Any = None) -> Torque:
    """Return the torque ``−kp Θ − kd Ω_B``; gains as for `viscous_damping`, the target a rotor."""
    damped = isinstance(kd, jax.core.Tracer) or bool(np.any(np.asarray(kd) != 0))
    return Torque((_laws.Control(_gains(kp), _gains(kd), _rotor(target), None, damped),))


def gyrostat(h: Any) -> Torque:
    """Return a wheel in the body with the constant momentum h (..., 3) relative to it, in kg m²/s."""
    return Torque((_laws.Wheel(_three(h, "h")),))


def constant_body(N: Any) -> Torque:
    """Return a torque (..., 3) constant in body axes, in N m."""
    return Torque((_laws.ConstantBody(_three(N, "N")),))


def constant_space(N: Any) -> Torque:
    """Return a torque (..., 3) constant in space, in N m."""
    return Torque((_laws.ConstantSpace(_three(N, "N")),))


def tabulated(times: Any, torques: Any, frame: str = "body", kind: str = "linear") -> Torque:
    """Return torques (n, 3) at n times, interpolated; the times are numbers, the torques may be traced.

    As in `polhode.torque.tabulated`; beyond its times the torque is NaN. Steps end on its times where
    `simulate` knows all times beforehand.
    """
    when, rows = as_floats(times, "times"), _array(torques)
    # It says what is wrong with times, frame and kind.
    native.tabulated(when, np.zeros((*rows.shape[:-1], 3)), frame, kind)
    slopes = spline_slopes(when, rows) if kind == "cubic" and when.size > 2 else None
    return Torque((Table(rows, slopes, tuple(when.tolist()), frame),))


def formula(text: str, /, *, frame: str = "body", **values: Any) -> Torque:
    """Return the torque that a formula gives, of the names that `polhode.torque.formula` explains.

    The values are multivectors, rotors and numbers, which may hold traced arrays, but no linear maps.
    """
    if frame not in ("body", "space"):
        raise ValueError(f"frame is {frame!r}, expected 'body' or 'space'")
    given = {name: value_of(value, name) for name, value in values.items()}
    return Torque((Formula(given, None, text, frame).checked(),))


def function(f: Callable[[Any, Any, Any], Any]) -> Torque:
    """Return the torque that a function in ``jax.numpy`` gives: ``f(t, rotor, omega_body)``.

    It is called with the time in s, the rotor's components (..., 4) from body axes to space and those of the
    angular velocity (..., 3) in body axes, and returns the torque (..., 3) in body axes. What it closes over
    may be traced.
    """
    if not callable(f):
        raise TypeError(f"a function of t, rotor and omega_body is needed, got {type(f).__name__}")
    if isinstance(f, jax.tree_util.Partial):
        return Torque((_laws.Function(partial=f, frame=None, f=None),))
    return Torque((_laws.Function(partial=None, frame=None, f=f),))


def of(torque: Any) -> Torque:
    """Return a torque for JAX from one, from None, from a law of `polhode.torque` or from a function."""
    if torque is None:
        return Torque(())
    if isinstance(torque, Torque):
        return torque
    if isinstance(torque, native.Torque):
        return sum((_of_native(law) for law in torque.laws), Torque(()))
    if callable(torque) and getattr(torque, "__module__", None) != __name__:
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
    made: Torque = globals()[law.name](*law.arguments)
    return made


def _array(value: Any) -> Any:
    data = value._data if isinstance(value, Multivector) else value
    array = jnp.asarray(data)
    return array if jnp.issubdtype(array.dtype, jnp.floating) else array.astype(jnp.result_type(float))


def _three(value: Any, name: str) -> Three:
    array = _array(value)
    if array.shape[-1:] != (3,):
        raise ValueError(f"{name} needs 3 components in the last axis, got shape {array.shape}")
    return split(array)


def _gains(value: Any) -> Three:
    array = _array(value)
    return split(array) if array.shape[-1:] == (3,) else (array,) * 3


def _rotor(value: Any) -> Four:
    if value is None:
        return split(_array([1.0, 0.0, 0.0, 0.0]))
    array = _array(value)
    if array.shape[-1:] != (4,):
        raise ValueError(f"a rotor needs 4 components in the last axis, got shape {array.shape}")
    return normalized(split(array))
