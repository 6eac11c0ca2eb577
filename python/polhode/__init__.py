"""Polhode: geometric algebra of 3-d space, rotors and the motion of rigid bodies."""

from polhode._multivector import I as I
from polhode._multivector import Multivector as Multivector
from polhode._multivector import bivector as bivector
from polhode._multivector import cross as cross
from polhode._multivector import e1 as e1
from polhode._multivector import e2 as e2
from polhode._multivector import e3 as e3
from polhode._multivector import from_pauli as from_pauli
from polhode._multivector import multivector as multivector
from polhode._multivector import scalar as scalar
from polhode._multivector import to_pauli as to_pauli
from polhode._multivector import trivector as trivector
from polhode._multivector import vector as vector
from polhode._native import __version__ as __version__
from polhode._rotor import Rotor as Rotor
