"""Values as text, the way they stand on paper: ``2 e1 + 3 e2∧e3``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

_DIGITS = 8
_SHOWN = 6


def one_value(components: Any, blades: Sequence[str]) -> str:
    """Return one value as a sum of its nonzero terms, floats to 8 significant digits."""
    text = ""
    for x, blade in zip(components, blades, strict=True):
        if _is_zero(x):
            continue
        negative, size = _sign_and_size(x)
        term = blade if blade and size == "1" else f"{size} {blade}".rstrip()
        if text:
            text += f" - {term}" if negative else f" + {term}"
        else:
            text = f"-{term}" if negative else term
    return text or "0"


def _is_zero(x: Any) -> bool:
    return bool(x == 0)


def _sign_and_size(x: Any) -> tuple[bool, str]:
    """Return whether a minus stands before it, and what follows; a sum is bracketed."""
    if isinstance(x, float | np.floating):
        return bool(x < 0), f"{abs(x):.{_DIGITS}g}"
    text = str(x)
    if " " in text:
        return False, f"({text})"
    return text.startswith("-"), text.removeprefix("-")


def value(name: str, data: Any, blades: Sequence[str]) -> str:
    """Return the ``repr``: the value itself, or the first and last values of a batch."""
    batch = tuple(data.shape[:-1])
    try:
        array = np.asarray(data).reshape(data.shape)
    except Exception:  # traced or lazy arrays have no numbers to show; each library has its own error
        basis = ", ".join(blade or "1" for blade in blades)
        return f"{name} of shape {batch} over ({basis}):\n{data!r}"
    if not batch:
        return one_value(array, blades)
    flat = array.reshape(-1, array.shape[-1])
    texts = [one_value(row, blades) for row in (flat if len(flat) <= _SHOWN else flat[: _SHOWN - 1])]
    if len(flat) > _SHOWN:
        texts += ["…", one_value(flat[-1], blades)]
    lines = ",\n ".join(texts)
    return f"{name} of shape {batch}:\n[{lines}]"
