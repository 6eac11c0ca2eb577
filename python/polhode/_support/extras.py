"""Optional libraries, imported when they are used."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Iterable
from types import ModuleType
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from rich.progress import Progress

T = TypeVar("T")
_pytrees: set[type] = set()


def optional(module: str, extra: str, what: str) -> ModuleType:
    """Return the module; where it is missing, an ImportError names the extra to install."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        library = module.partition(".")[0]
        raise ImportError(f"{what} needs {library}: pip install 'polhode[{extra}]'") from error


def progress_bar(done: str) -> Progress | None:
    """Return a progress bar on standard error, with text `done` after it; None without a terminal or rich."""
    if sys.stderr is None or not sys.stderr.isatty():
        return None
    try:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn
    except ImportError:
        return None
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn(done), TimeRemainingColumn())
    return Progress(*columns, console=Console(stderr=True), transient=True)


def register_pytree(
    cls: type[T],
    flatten: Callable[[T], tuple[Iterable[Any], Any]],
    unflatten: Callable[[Any, Iterable[Any]], T],
) -> None:
    """Register the class as a pytree of JAX, so that it passes through jit, grad and vmap.

    Does nothing until JAX is imported, nor the second time.

    `flatten` returns the arrays of a value and a hashable rest; `unflatten` takes the rest and the leaves.
    JAX passes leaves of its own (None, axis numbers, ``object()``): `unflatten` must take them unchecked.
    """
    jax = sys.modules.get("jax")
    if jax is None or cls in _pytrees or not hasattr(jax, "tree_util"):
        return
    _pytrees.add(cls)
    jax.tree_util.register_pytree_node(cls, flatten, unflatten)
