"""Values as JAX pytrees, so that they pass through jit, grad and vmap."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from typing import Any, TypeVar

T = TypeVar("T")
_registered: set[type] = set()


def register(
    cls: type[T],
    flatten: Callable[[T], tuple[Iterable[Any], Any]],
    unflatten: Callable[[Any, Iterable[Any]], T],
) -> None:
    """Make the class known to JAX, once, and only if JAX has been imported.

    `flatten` returns the arrays of a value and a hashable rest; `unflatten` takes the rest and the leaves.
    JAX passes leaves of its own (None, axis numbers, ``object()``): `unflatten` must take them unchecked.
    """
    jax = sys.modules.get("jax")
    if jax is None or cls in _registered or not hasattr(jax, "tree_util"):
        return
    _registered.add(cls)
    jax.tree_util.register_pytree_node(cls, flatten, unflatten)
