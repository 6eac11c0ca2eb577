"""Names of other libraries on multivectors and rotors, and those of rotors on multivectors."""

from __future__ import annotations

from typing import Any, NoReturn

from polhode._algebra.foreign_tables import MULTIVECTOR, PARTS_OF_ROTORS, ROTOR
from polhode._support.foreign_names import ForeignName, add_names


# A method of rotors, which an even multivector does not have: the error names what converts it.
class NameOfRotors(ForeignName):
    __slots__ = ("__doc__",)

    def __init__(self, name: str) -> None:
        super().__init__(name, f"Rotor.from_multivector(A).{name}")

    def __get__(self, value: Any, kind: type) -> NoReturn:
        signature = (3, 0, 0) if value is None else value.algebra.signature
        if signature == (3, 0, 0):
            remedy = f"; for a rotor write {self.ours}"
        elif signature == (3, 0, 1):
            remedy = "; for a motor write RigidTransform.from_motor(A)"
        else:
            remedy = ""
        raise AttributeError(f"a {kind.__name__} has no attribute {self.name!r}{remedy}")


def add_to(multivector: type, rotor: type) -> None:
    """Give both classes the names of other libraries, and multivectors those of methods of rotors."""
    add_names(multivector, MULTIVECTOR)
    add_names(rotor, ROTOR)
    for name, ours in PARTS_OF_ROTORS.items():
        setattr(rotor, name, ForeignName(name, ours))
    for name, member in list(vars(rotor).items()):
        static = isinstance(member, ForeignName | staticmethod)
        if not (static or name.startswith("_") or name in vars(multivector)):
            setattr(multivector, name, NameOfRotors(name))
