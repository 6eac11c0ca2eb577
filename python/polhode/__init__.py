"""Polhode: geometric algebra of 3-d space, rotors and the motion of rigid bodies."""

import importlib
from typing import TYPE_CHECKING, Any

from polhode._algebra import Algebra as Algebra
from polhode._algebra import algebra as algebra
from polhode._multivector import Multivector as Multivector
from polhode._native import SceneError as SceneError
from polhode._native import __version__ as __version__
from polhode._parts import concatenate as concatenate
from polhode._parts import stack as stack
from polhode._rotor import Rotor as Rotor
from polhode._values import I as I
from polhode._values import bivector as bivector
from polhode._values import cross as cross
from polhode._values import e1 as e1
from polhode._values import e2 as e2
from polhode._values import e3 as e3
from polhode._values import from_pauli as from_pauli
from polhode._values import multivector as multivector
from polhode._values import scalar as scalar
from polhode._values import to_pauli as to_pauli
from polhode._values import trivector as trivector
from polhode._values import vector as vector

if TYPE_CHECKING:
    from polhode import event as event
    from polhode import force as force
    from polhode import jax as jax
    from polhode import torque as torque
    from polhode._agreement import Agreement as Agreement
    from polhode._bodies import Body as Body
    from polhode._bodies import Inertia as Inertia
    from polhode._certificate import Certificate as Certificate
    from polhode._certificate import Crossings as Crossings
    from polhode._certificate import Failure as Failure
    from polhode._closed_forms import DampedTop as DampedTop
    from polhode._closed_forms import LagrangeTop as LagrangeTop
    from polhode._closed_forms import LarmorSphere as LarmorSphere
    from polhode._formula import Formula as Formula
    from polhode._formula import evaluate as evaluate
    from polhode._formula import formula as formula
    from polhode._formula_error import FormulaError as FormulaError
    from polhode._free_motion import FlowDerivatives as FlowDerivatives
    from polhode._free_motion import FreeMotion as FreeMotion
    from polhode._free_motion import SymmetricTop as SymmetricTop
    from polhode._free_motion import describe_free as describe_free
    from polhode._geometry import axial as axial
    from polhode._geometry import from_axial as from_axial
    from polhode._geometry import split as split
    from polhode._interchange import from_dict as from_dict
    from polhode._interchange import to_dict as to_dict
    from polhode._interpolation import RotorSpline as RotorSpline
    from polhode._interpolation import mean as mean
    from polhode._interpolation import slerp as slerp
    from polhode._linear import LinearMap as LinearMap
    from polhode._moments import Moments as Moments
    from polhode._notebook import view as view
    from polhode._scene import Scene as Scene
    from polhode._simulate import simulate as simulate
    from polhode._simulate import simulate_blocks as simulate_blocks
    from polhode._state import State as State
    from polhode._trajectory import Trajectory as Trajectory

# Without `jax`, which needs JAX.
__all__ = [
    "Agreement",
    "Algebra",
    "Body",
    "Certificate",
    "Crossings",
    "DampedTop",
    "Failure",
    "FlowDerivatives",
    "Formula",
    "FormulaError",
    "FreeMotion",
    "I",
    "Inertia",
    "LagrangeTop",
    "LarmorSphere",
    "LinearMap",
    "Moments",
    "Multivector",
    "Rotor",
    "RotorSpline",
    "Scene",
    "SceneError",
    "State",
    "SymmetricTop",
    "Trajectory",
    "algebra",
    "axial",
    "bivector",
    "concatenate",
    "cross",
    "describe_free",
    "e1",
    "e2",
    "e3",
    "evaluate",
    "event",
    "force",
    "formula",
    "from_axial",
    "from_dict",
    "from_pauli",
    "mean",
    "multivector",
    "scalar",
    "simulate",
    "simulate_blocks",
    "slerp",
    "split",
    "stack",
    "to_dict",
    "to_pauli",
    "torque",
    "trivector",
    "vector",
    "view",
]

# Imported when they are first asked for: those who only multiply need not wait for mechanics.
_LATER = {
    "Agreement": "_agreement",
    "Body": "_bodies",
    "Inertia": "_bodies",
    "DampedTop": "_closed_forms",
    "LagrangeTop": "_closed_forms",
    "LarmorSphere": "_closed_forms",
    "Formula": "_formula",
    "evaluate": "_formula",
    "formula": "_formula",
    "FormulaError": "_formula_error",
    "FlowDerivatives": "_free_motion",
    "FreeMotion": "_free_motion",
    "SymmetricTop": "_free_motion",
    "describe_free": "_free_motion",
    "axial": "_geometry",
    "from_axial": "_geometry",
    "split": "_geometry",
    "from_dict": "_interchange",
    "to_dict": "_interchange",
    "RotorSpline": "_interpolation",
    "mean": "_interpolation",
    "slerp": "_interpolation",
    "LinearMap": "_linear",
    "Certificate": "_certificate",
    "Crossings": "_certificate",
    "Failure": "_certificate",
    "Trajectory": "_trajectory",
    "Moments": "_moments",
    "view": "_notebook",
    "simulate": "_simulate",
    "simulate_blocks": "_simulate",
    "Scene": "_scene",
    "State": "_state",
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
    from polhode._magic import load

    load(shell)
