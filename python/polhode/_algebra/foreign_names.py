"""Names of other libraries: attributes that do not exist, with errors that name ours."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, NoReturn, TypeVar

from polhode._algebra.foreign_tables import MULTIVECTOR, PARTS_OF_ROTORS, ROTOR

T = TypeVar("T")


# A name that a class does not have: an AttributeError, also for `hasattr`, that says what to write. It has
# `__set__` and a `__doc__` of its own so that `help` lists such names after the methods, with what to write.
class ForeignName:
    __slots__ = ("__doc__", "name", "ours")

    def __init__(self, name: str, ours: str) -> None:
        self.name, self.ours = name, ours
        self.__doc__ = f"A name in other libraries; here write {ours}." if ours else "Of rotors only."

    def __get__(self, value: object, kind: type) -> NoReturn:
        article = "an" if kind.__name__[0] in "AEIOU" else "a"
        raise AttributeError(f"{article} {kind.__name__} has no attribute {self.name!r}; write {self.ours}")

    def __set__(self, value: object, _: object) -> NoReturn:
        self.__get__(value, type(value))


# A method of rotors, which an even multivector does not have: the error names what converts it.
class NameOfRotors(ForeignName):
    __slots__ = ("__doc__",)

    def __get__(self, value: Any, kind: type) -> NoReturn:
        signature = (3, 0, 0) if value is None else value.algebra.signature
        if signature == (3, 0, 0):
            remedy = f"; for a rotor write Rotor.from_multivector(A).{self.name}"
        elif signature == (3, 0, 1):
            remedy = "; for a motor write RigidTransform.from_motor(A)"
        else:
            remedy = ""
        raise AttributeError(f"a {kind.__name__} has no attribute {self.name!r}{remedy}")


def add_to(multivector: type, rotor: type) -> None:
    """Give both classes the names of other libraries, and multivectors those of methods of rotors."""
    _add(multivector, MULTIVECTOR)
    _add(rotor, ROTOR)
    for name, ours in PARTS_OF_ROTORS.items():
        setattr(rotor, name, ForeignName(name, ours))
    for name, member in list(vars(rotor).items()):
        static = isinstance(member, ForeignName | staticmethod)
        if not (static or name.startswith("_") or name in vars(multivector)):
            setattr(multivector, name, NameOfRotors(name, ""))


def with_foreign_names(names: Mapping[str, str]) -> Callable[[type[T]], type[T]]:
    """Give a class names of other libraries, which ``dir`` of its values does not list.

    With the metaclass `ListsOwnNames`, ``dir`` and `help` of the class do not list them either.
    """

    def named(kind: type[T]) -> type[T]:
        _add(kind, names)
        setattr(kind, "__dir__", listed)  # noqa: B010, a type checker knows the original
        return kind

    return named


class ListsOwnNames(type):
    """A class whose ``dir`` leaves out the names of other libraries.

    Completion in the REPL of Python and in IPython also lists the names of the class of a value.
    """

    def __dir__(cls) -> Iterable[str]:
        members = _members(cls)
        return [name for name in super().__dir__() if not isinstance(members.get(name), ForeignName)]


def _add(kind: type, names: Mapping[str, str]) -> None:
    for name, ours in names.items():
        if not hasattr(kind, name):
            setattr(kind, name, ForeignName(name, ours))


def listed(value: object) -> Iterable[str]:
    """Return the names for ``dir(value)``, without those of other libraries."""
    own = {name for name, member in _members(type(value)).items() if not isinstance(member, ForeignName)}
    return sorted(own | getattr(value, "__dict__", {}).keys())


def _members(kind: type) -> dict[str, Any]:
    return {name: member for one in reversed(kind.__mro__) for name, member in vars(one).items()}
