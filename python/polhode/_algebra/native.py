"""Attaches Python methods to the native types, which have storage and operators."""

from __future__ import annotations

from collections.abc import Callable
from types import FunctionType
from typing import Any

_IMPLICIT = {"__dict__", "__module__", "__qualname__", "__slots__", "__weakref__", "__static_attributes__"}


def joins(native: type) -> Callable[[type], Any]:
    """Attach the members of a class body to the native type, and return that instead of the class.

    Values created in Rust then have all methods; Rust cannot create values of a Python subclass.
    """

    def join(half: type) -> type:
        for name, member in vars(half).items():
            if name not in _IMPLICIT and not name.startswith("__firstlineno"):
                _named(member, name, half)
                setattr(native, name, member)
        return native

    return join


def _named(member: Any, name: str, half: type) -> None:
    """Give a function of a module the name of the method, for help and for pickles of bound methods."""
    if not isinstance(member, FunctionType) or name.startswith("_"):
        return
    if "." not in member.__qualname__ and member.__name__ not in vars(half):  # an alias keeps its own
        member.__name__, member.__qualname__ = name, f"{half.__name__}.{name}"
