"""Polhode: geometric algebra of 3-d space, rotors and the motion of rigid bodies.

>>> import numpy as np
>>> import polhode as ph
>>> R = ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, np.pi / 2)  # a quarter turn from e1 to e2
>>> print(f"{R(ph.e1):.1f}", R.to_quaternion(order="wxyz").round(3))
0.0 e1 + 1.0 e2 [0.707 0.    0.    0.707]
>>> body = ph.Inertia.from_principal_moments(1, 2, 3)  # kg m²
>>> start = ph.State(R, [0.1, 1.0, 0.1])  # rad/s, in body axes
>>> ph.simulate(body, start, np.linspace(0, 10, 101))
Trajectory(101 times, t = 0 … 10 s, exact)

What there is, by task:

- values: `vector`, `bivector`, `multivector`, `e1`, `e2`, `e3`, `I`, `stack`, with the methods of
  `Multivector`;
- rotations: `Rotor`, from and to quaternions, matrices and Euler angles; `slerp`, `RotorSpline`, `mean`,
  `align`, `attitude_from_rates`; with translations `RigidTransform`;
- other algebras: `algebra`, `pga`, `cga`, `LinearMap`; formulas as on paper: `evaluate`, `formula`;
- bodies: `Body`, `Inertia`, `State`, `read_urdf`;
- motion: `simulate`, `FreeMotion`, `LagrangeTop`, `Stepper`, with the laws of `torque` and `force` and the
  events of `event`; the same under JAX: `jax`; moments and spin from data: `fit`;
- files: `Scene`, `Trajectory.read`, `io`; pictures: `view`, `Trajectory.plot`, `Trajectory.film`.

Units are SI and angles radians. Components are the last axis of an array, and batches broadcast. Bivectors,
such as angular velocities, have the components ``(e2e3, e3e1, e1e2)``, which equal those of the axial vector.
A rotor acts as ``R(x) = R x ~R``, ``S * R`` turns by R first, and the rotor of a state takes body axes to
space axes. Put ``^`` (wedge) and ``|`` (dot) in brackets: Python binds them looser than ``+`` and ``*``.

Guides: https://github.com/polhode/polhode/tree/main/docs; the command is ``polhode --help``.
"""

import importlib
from typing import TYPE_CHECKING, Any

from polhode import _start as _start  # first, for Ctrl-C during the imports below

# isort: split

from polhode._algebra.algebra import Algebra, algebra
from polhode._algebra.constructors import (
    I,
    axial,
    bivector,
    cross,
    e1,
    e2,
    e3,
    from_axial,
    from_pauli,
    multivector,
    scalar,
    split,
    to_pauli,
    trivector,
    vector,
)
from polhode._algebra.grades import concatenate, stack
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._native import __version__ as __version__

if TYPE_CHECKING:
    from polhode import event, force, io, torque
    from polhode import jax as jax
    from polhode._algebra.cga import CGA, cga
    from polhode._algebra.estimation import Alignment, align, mean
    from polhode._algebra.frames import reciprocal_frame
    from polhode._algebra.interpolation import RotorSpline, slerp
    from polhode._algebra.jacobians import left_jacobian, right_jacobian
    from polhode._algebra.linear_map import LinearMap
    from polhode._algebra.pga import PGA, pga
    from polhode._algebra.rates import attitude_from_rates, rates_from_attitude
    from polhode._algebra.screws import Screw, adjoint_matrix, screw_parameters
    from polhode._algebra.serialize import from_dict, to_dict
    from polhode._algebra.spherical import direction, longitude_latitude
    from polhode._algebra.transform import RigidTransform
    from polhode._fit.fit import fit
    from polhode._fit.periods import omega_from_periods
    from polhode._fit.result import Fit
    from polhode._formula.agreement import Agreement
    from polhode._formula.errors import FormulaError
    from polhode._formula.formula import Formula, evaluate, formula
    from polhode._mechanics.bodies import Body
    from polhode._mechanics.closed_forms import DampedTop, LagrangeTop, LarmorSphere
    from polhode._mechanics.free_motion import FlowDerivatives, FreeMotion, SymmetricTop, describe_free
    from polhode._mechanics.inertia import Inertia
    from polhode._mechanics.result import Certificate, Crossings, Failure
    from polhode._mechanics.robots.read import read_mjcf, read_sdf, read_urdf
    from polhode._mechanics.simulate import simulate, simulate_blocks
    from polhode._mechanics.state import State
    from polhode._mechanics.statistics import Moments
    from polhode._mechanics.stepper import Stepper
    from polhode._mechanics.trajectory import Trajectory
    from polhode._native import SceneError
    from polhode._report.ensemble.reduced_ensemble import ReducedEnsemble
    from polhode._scene.scene import Scene
    from polhode._viewer.notebook import view

# Without `jax`, which needs JAX to be installed.
# fmt: off
__all__ = [
    "CGA", "PGA", "Agreement", "Algebra", "Alignment", "Body", "Certificate", "Crossings", "DampedTop",
    "Failure", "Fit", "FlowDerivatives", "Formula", "FormulaError", "FreeMotion", "I", "Inertia",
    "LagrangeTop", "LarmorSphere", "LinearMap", "Moments", "Multivector", "ReducedEnsemble", "RigidTransform",
    "Rotor", "RotorSpline", "Scene", "SceneError", "Screw", "State", "Stepper", "SymmetricTop", "Trajectory",
    "adjoint_matrix", "algebra", "align", "attitude_from_rates", "axial", "bivector", "cga", "concatenate",
    "cross", "describe_free", "direction", "e1", "e2", "e3", "evaluate", "event", "fit", "force", "formula",
    "from_axial", "from_dict", "from_pauli", "io", "left_jacobian", "longitude_latitude", "mean",
    "multivector", "omega_from_periods", "pga", "rates_from_attitude", "read_mjcf", "read_sdf", "read_urdf",
    "reciprocal_frame", "right_jacobian", "scalar", "screw_parameters", "simulate", "simulate_blocks",
    "slerp", "split", "stack", "to_dict", "to_pauli", "torque", "trivector", "vector", "view",
]
# fmt: on

# Imported on first access, so that `import polhode` stays fast.
_LATER = {
    name: module
    for module, names in {
        "_algebra.cga": "CGA cga",
        "_algebra.estimation": "Alignment align mean",
        "_algebra.frames": "reciprocal_frame",
        "_algebra.interpolation": "RotorSpline slerp",
        "_algebra.jacobians": "left_jacobian right_jacobian",
        "_algebra.linear_map": "LinearMap",
        "_algebra.pga": "PGA pga",
        "_algebra.rates": "attitude_from_rates rates_from_attitude",
        "_algebra.screws": "Screw adjoint_matrix screw_parameters",
        "_algebra.serialize": "from_dict to_dict",
        "_algebra.spherical": "direction longitude_latitude",
        "_algebra.transform": "RigidTransform",
        "_fit.fit": "fit",
        "_fit.periods": "omega_from_periods",
        "_fit.result": "Fit",
        "_formula.agreement": "Agreement",
        "_formula.errors": "FormulaError",
        "_formula.formula": "Formula evaluate formula",
        "_mechanics.bodies": "Body",
        "_mechanics.free_motion": "FlowDerivatives describe_free",
        "_mechanics.inertia": "Inertia",
        "_mechanics.result": "Certificate Crossings Failure",
        "_mechanics.robots.read": "read_mjcf read_sdf read_urdf",
        "_mechanics.state": "State",
        "_mechanics.statistics": "Moments",
        "_mechanics.stepper": "Stepper",
        "_report.ensemble.reduced_ensemble": "ReducedEnsemble",
        "_scene.scene": "SceneError",
        "_outputs": "DampedTop FreeMotion LagrangeTop LarmorSphere Scene SymmetricTop Trajectory"
        " simulate simulate_blocks view",
    }.items()
    for name in names.split()
}
_MODULES = ("event", "force", "io", "jax", "torque")


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return importlib.import_module(f"polhode.{name}")
    if name not in _LATER:
        from polhode._support.package_names import missing

        raise missing(name)
    value = getattr(importlib.import_module(f"polhode.{_LATER[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*__all__, "__version__", "jax"})


def load_ipython_extension(shell: Any) -> None:
    """Add ``%ga`` and ``%%ga``, formulas in notebooks: ``%load_ext polhode`` calls this."""
    from polhode._formula.shell.ipython import load

    load(shell)
