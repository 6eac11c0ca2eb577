"""Attaches Python methods to the native types, which have storage and operators."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

_IMPLICIT = {"__dict__", "__module__", "__qualname__", "__slots__", "__weakref__", "__static_attributes__"}


def joins(native: type) -> Callable[[type], Any]:
    """Attach the members of a class body to the native type, and return that instead of the class.

    Values created in Rust then have all methods; Rust cannot create values of a Python subclass.
    """

    def join(half: type) -> type:
        for name, member in vars(half).items():
            if name not in _IMPLICIT and not name.startswith("__firstlineno"):
                setattr(native, name, member)
        return native

    return join
