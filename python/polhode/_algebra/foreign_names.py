"""Names of other libraries: attributes that do not exist, with errors that name ours."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, NoReturn, TypeVar

from polhode._algebra.foreign_tables import MULTIVECTOR, PARTS_OF_ROTORS, ROTOR

T = TypeVar("T")


class ForeignName:
    """A name that a class does not have: an AttributeError, also for `hasattr`, that says what to write."""

    __slots__ = ("name", "ours")

    def __init__(self, name: str, ours: str) -> None:
        self.name, self.ours = name, ours

    def __get__(self, value: object, kind: type) -> NoReturn:
        article = "an" if kind.__name__[0] in "AEIOU" else "a"
        raise AttributeError(f"{article} {kind.__name__} has no attribute {self.name!r}; write {self.ours}")


class NameOfRotors(ForeignName):
    """A method of rotors, which an even multivector does not have: the error names what converts it."""

    __slots__ = ()

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
    """Give a class names of other libraries, which ``dir`` of its values does not list."""

    def named(kind: type[T]) -> type[T]:
        _add(kind, names)
        setattr(kind, "__dir__", listed)  # noqa: B010, a type checker knows the original
        return kind

    return named


def _add(kind: type, names: Mapping[str, str]) -> None:
    for name, ours in names.items():
        if not hasattr(kind, name):
            setattr(kind, name, ForeignName(name, ours))


def listed(value: object) -> Iterable[str]:
    """Return the names for ``dir(value)``, without those of other libraries."""
    kinds = type(value).__mro__
    names = {name: member for kind in reversed(kinds) for name, member in vars(kind).items()}
    own = {name for name, member in names.items() if not isinstance(member, ForeignName)}
    return sorted(own | getattr(value, "__dict__", {}).keys())
