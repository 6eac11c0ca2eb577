"""Polhode: geometric algebra of 3-d space, rotors and the motion of rigid bodies."""

from polhode import torque as torque
from polhode._bodies import Body as Body
from polhode._bodies import Inertia as Inertia
from polhode._motion import Certificate as Certificate
from polhode._motion import State as State
from polhode._motion import SymmetricTop as SymmetricTop
from polhode._motion import Trajectory as Trajectory
from polhode._motion import describe_free as describe_free
from polhode._motion import simulate as simulate
from polhode._multivector import Multivector as Multivector
from polhode._multivector import scalar as scalar
from polhode._native import SceneError as SceneError
from polhode._native import __version__ as __version__
from polhode._rotor import Rotor as Rotor
from polhode._scene import Scene as Scene
from polhode._values import I as I
from polhode._values import bivector as bivector
from polhode._values import cross as cross
from polhode._values import e1 as e1
from polhode._values import e2 as e2
from polhode._values import e3 as e3
from polhode._values import from_pauli as from_pauli
from polhode._values import multivector as multivector
from polhode._values import to_pauli as to_pauli
from polhode._values import trivector as trivector
from polhode._values import vector as vector
