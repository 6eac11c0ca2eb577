"""Counts in messages."""

from __future__ import annotations


def counted(number: int, one: str, many: str | None = None) -> str:
    """Return a number with its noun, whose plural is `many` or ends in s."""
    return f"{number} {one if number == 1 else many or f'{one}s'}"
