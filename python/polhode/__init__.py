"""Polhode: geometric algebra of 3-d space, rotors and the motion of rigid bodies."""

import importlib
from typing import TYPE_CHECKING, Any

from polhode._algebra.algebra import Algebra as Algebra
from polhode._algebra.algebra import algebra as algebra
from polhode._algebra.constructors import I as I
from polhode._algebra.constructors import axial as axial
from polhode._algebra.constructors import bivector as bivector
from polhode._algebra.constructors import cross as cross
from polhode._algebra.constructors import e1 as e1
from polhode._algebra.constructors import e2 as e2
from polhode._algebra.constructors import e3 as e3
from polhode._algebra.constructors import from_axial as from_axial
from polhode._algebra.constructors import from_pauli as from_pauli
from polhode._algebra.constructors import multivector as multivector
from polhode._algebra.constructors import scalar as scalar
from polhode._algebra.constructors import split as split
from polhode._algebra.constructors import to_pauli as to_pauli
from polhode._algebra.constructors import trivector as trivector
from polhode._algebra.constructors import vector as vector
from polhode._algebra.grades import concatenate as concatenate
from polhode._algebra.grades import stack as stack
from polhode._algebra.multivector import Multivector as Multivector
from polhode._algebra.rotor import Rotor as Rotor
from polhode._native import SceneError as SceneError
from polhode._native import __version__ as __version__

if TYPE_CHECKING:
    from polhode import event as event
    from polhode import force as force
    from polhode import jax as jax
    from polhode import torque as torque
    from polhode._algebra.interpolation import RotorSpline as RotorSpline
    from polhode._algebra.interpolation import mean as mean
    from polhode._algebra.interpolation import slerp as slerp
    from polhode._algebra.linear_map import LinearMap as LinearMap
    from polhode._algebra.serialize import from_dict as from_dict
    from polhode._algebra.serialize import to_dict as to_dict
    from polhode._algebra.transform import RigidTransform as RigidTransform
    from polhode._formula.agreement import Agreement as Agreement
    from polhode._formula.errors import FormulaError as FormulaError
    from polhode._formula.formula import Formula as Formula
    from polhode._formula.formula import evaluate as evaluate
    from polhode._formula.formula import formula as formula
    from polhode._mechanics.bodies import Body as Body
    from polhode._mechanics.bodies import Inertia as Inertia
    from polhode._mechanics.closed_forms import DampedTop as DampedTop
    from polhode._mechanics.closed_forms import LagrangeTop as LagrangeTop
    from polhode._mechanics.closed_forms import LarmorSphere as LarmorSphere
    from polhode._mechanics.free_motion import FlowDerivatives as FlowDerivatives
    from polhode._mechanics.free_motion import FreeMotion as FreeMotion
    from polhode._mechanics.free_motion import SymmetricTop as SymmetricTop
    from polhode._mechanics.free_motion import describe_free as describe_free
    from polhode._mechanics.result import Certificate as Certificate
    from polhode._mechanics.result import Crossings as Crossings
    from polhode._mechanics.result import Failure as Failure
    from polhode._mechanics.simulate import simulate as simulate
    from polhode._mechanics.simulate import simulate_blocks as simulate_blocks
    from polhode._mechanics.state import State as State
    from polhode._mechanics.statistics import Moments as Moments
    from polhode._mechanics.stepper import Stepper as Stepper
    from polhode._mechanics.trajectory import Trajectory as Trajectory
    from polhode._scene.scene import Scene as Scene
    from polhode._viewer.notebook import view as view

# Without `jax`, which needs JAX to be installed.
# fmt: off
__all__ = [
    "Agreement", "Algebra", "Body", "Certificate", "Crossings", "DampedTop", "Failure", "FlowDerivatives",
    "Formula", "FormulaError", "FreeMotion", "I", "Inertia", "LagrangeTop", "LarmorSphere", "LinearMap",
    "Moments", "Multivector", "RigidTransform", "Rotor", "RotorSpline", "Scene", "SceneError", "State",
    "Stepper", "SymmetricTop", "Trajectory", "algebra", "axial", "bivector", "concatenate", "cross",
    "describe_free", "e1", "e2", "e3", "evaluate", "event", "force", "formula", "from_axial", "from_dict",
    "from_pauli", "mean", "multivector", "scalar", "simulate", "simulate_blocks", "slerp", "split",
    "stack", "to_dict", "to_pauli", "torque", "trivector", "vector", "view",
]
# fmt: on

# Imported on first access, so that `import polhode` stays fast.
_LATER = {
    name: module
    for module, names in {
        "_algebra.interpolation": "RotorSpline mean slerp",
        "_algebra.linear_map": "LinearMap",
        "_algebra.serialize": "from_dict to_dict",
        "_algebra.transform": "RigidTransform",
        "_formula.agreement": "Agreement",
        "_formula.errors": "FormulaError",
        "_formula.formula": "Formula evaluate formula",
        "_mechanics.bodies": "Body Inertia",
        "_mechanics.free_motion": "FlowDerivatives describe_free",
        "_mechanics.result": "Certificate Crossings Failure",
        "_mechanics.state": "State",
        "_mechanics.statistics": "Moments",
        "_mechanics.stepper": "Stepper",
        "_outputs": "DampedTop FreeMotion LagrangeTop LarmorSphere Scene SymmetricTop Trajectory"
        " simulate simulate_blocks view",
    }.items()
    for name in names.split()
}
_MODULES = ("event", "force", "jax", "torque")


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return importlib.import_module(f"polhode.{name}")
    if name not in _LATER:
        raise AttributeError(f"module 'polhode' has no attribute {name!r}")
    value = getattr(importlib.import_module(f"polhode.{_LATER[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_LATER, *_MODULES} - {"Any", "TYPE_CHECKING", "importlib"})


def load_ipython_extension(shell: Any) -> None:
    """Add ``%ga`` and ``%%ga``, formulas in notebooks: ``%load_ext polhode`` calls this."""
    from polhode._formula.shell.ipython import load

    load(shell)
