"""Blocks of a long run, and how far the whole run is."""

from __future__ import annotations

from collections.abc import Callable, Iterator

# A function that is called with the number of the pass and its completed fraction.
Report = Callable[[int, float], object]


def in_blocks(rows: slice, size: int, progress: Report | None) -> Iterator[tuple[slice, Report | None]]:
    """Yield the blocks of at most `size` rows, each with the function that takes the progress within it."""
    whole = rows.stop - rows.start
    for first in range(rows.start, rows.stop, size):
        block = slice(first, min(first + size, rows.stop))
        yield block, part_of(progress, first - rows.start, block.stop - first, whole)


def part_of(progress: Report | None, done: int, count: int, whole: int) -> Report | None:
    """Return the progress within `count` items of a whole, of which `done` come before; None without."""
    if progress is None:
        return None

    def report(number: int, fraction: float) -> None:
        progress(number, (done + fraction * count) / whole)

    return report
