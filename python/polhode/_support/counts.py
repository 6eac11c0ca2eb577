"""Counts in messages."""

from __future__ import annotations


def counted(number: int, one: str) -> str:
    """Return a number with its noun, whose plural ends in s, as of rows, or in ies, as of bodies."""
    if number == 1:
        return f"1 {one}"
    return f"{number} {one[:-1]}ies" if one.endswith("y") else f"{number} {one}s"
