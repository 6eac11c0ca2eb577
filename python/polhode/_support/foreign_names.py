"""Names of other libraries: attributes that do not exist, with errors that name ours."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, NoReturn, TypeVar

T = TypeVar("T")


# A name that a class does not have: an AttributeError, also for `hasattr`, that says what to write. It has
# `__set__` and a `__doc__` of its own so that `help` lists such names after the methods, with what to write.
class ForeignName:
    __slots__ = ("__doc__", "name", "ours")

    def __init__(self, name: str, ours: str) -> None:
        self.name, self.ours = name, ours
        self.__doc__ = f"A name in other libraries; here write {ours}."

    def __get__(self, value: object, kind: type) -> NoReturn:
        article = "an" if kind.__name__[0] in "AEIOU" else "a"
        raise AttributeError(f"{article} {kind.__name__} has no attribute {self.name!r}; write {self.ours}")

    def __set__(self, value: object, _: object) -> NoReturn:
        self.__get__(value, type(value))


def with_foreign_names(names: Mapping[str, str]) -> Callable[[type[T]], type[T]]:
    """Give a class names of other libraries, which ``dir`` of its values does not list.

    With the metaclass `ListsOwnNames`, ``dir`` and `help` of the class do not list them either.
    """

    def named(kind: type[T]) -> type[T]:
        add_names(kind, names)
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


def add_names(kind: type, names: Mapping[str, str]) -> None:
    """Give a class those of the names that it does not have."""
    for name, ours in names.items():
        if not hasattr(kind, name):
            setattr(kind, name, ForeignName(name, ours))


def listed(value: object) -> Iterable[str]:
    """Return the names for ``dir(value)``, without those of other libraries."""
    own = {name for name, member in _members(type(value)).items() if not isinstance(member, ForeignName)}
    return sorted(own | getattr(value, "__dict__", {}).keys())


def _members(kind: type) -> dict[str, Any]:
    return {name: member for one in reversed(kind.__mro__) for name, member in vars(one).items()}
