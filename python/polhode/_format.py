"""Values as text, the way they stand on paper: ``2 e1 + 3 e2∧e3``."""

from __future__ import annotations

from polhode._arrays import Array

BLADES = ("", "e1", "e2", "e3", "e2∧e3", "e3∧e1", "e1∧e2", "I")

_DIGITS = 8
_SHOWN = 6


def one_value(components: Array, indices: list[int]) -> str:
    """Return one value as a sum of its nonzero terms, to 8 significant digits."""
    text = ""
    for x, index in zip(components, indices, strict=True):
        if x == 0:
            continue
        size = f"{abs(x):.{_DIGITS}g}"
        blade = BLADES[index]
        term = blade if blade and size == "1" else f"{size} {blade}".rstrip()
        negative = x < 0
        if text:
            text += f" - {term}" if negative else f" + {term}"
        else:
            text = f"-{term}" if negative else term
    return text or "0"


def value(name: str, data: Array, indices: list[int]) -> str:
    """Return the ``repr``: the value itself, or the first and last values of a batch."""
    batch = data.shape[:-1]
    if not batch:
        return one_value(data, indices)
    flat = data.reshape(-1, data.shape[-1])
    texts = [one_value(row, indices) for row in (flat if len(flat) <= _SHOWN else flat[: _SHOWN - 1])]
    if len(flat) > _SHOWN:
        texts += ["…", one_value(flat[-1], indices)]
    lines = ",\n ".join(texts)
    return f"{name} of shape {batch}:\n[{lines}]"
