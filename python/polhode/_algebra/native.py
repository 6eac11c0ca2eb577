"""Types of two halves: operators and storage in Rust, everything else in Python."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

_OF_THE_BODY = {"__dict__", "__module__", "__qualname__", "__slots__", "__weakref__", "__static_attributes__"}


def joins(native: type) -> Callable[[type], Any]:
    """Move the methods of a class body to the native type, which takes the place of the class.

    So values made in Rust, at the speed of Rust, have all the methods; a subclass could not be made there.
    """

    def join(half: type) -> type:
        for name, member in vars(half).items():
            if name not in _OF_THE_BODY and not name.startswith("__firstlineno"):
                setattr(native, name, member)
        return native

    return join
