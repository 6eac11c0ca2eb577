"""Libraries that are imported when they are used."""

from __future__ import annotations

import importlib
import sys
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress


def optional(module: str, extra: str, what: str) -> ModuleType:
    """Return the module; where it is missing, an ImportError that says which extra to install."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        library = module.partition(".")[0]
        raise ImportError(f"{what} needs {library}: pip install 'polhode[{extra}]'") from error


def progress_bar(done: str) -> Progress | None:
    """Return a bar on standard error with this text of a task behind it; None without a terminal or rich."""
    if not sys.stderr.isatty():
        return None
    try:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn
    except ImportError:
        return None
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn(done), TimeRemainingColumn())
    return Progress(*columns, console=Console(stderr=True), transient=True)
