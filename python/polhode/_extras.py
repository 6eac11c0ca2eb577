"""Libraries that are imported when they are used."""

from __future__ import annotations

import importlib
from types import ModuleType


def optional(module: str, extra: str, what: str) -> ModuleType:
    """Return the module; where it is missing, an ImportError that says which extra to install."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        library = module.partition(".")[0]
        raise ImportError(f"{what} needs {library}: pip install 'polhode[{extra}]'") from error
