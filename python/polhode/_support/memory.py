"""Free memory, checked before a large result is computed."""

from __future__ import annotations

import math
from collections.abc import Iterator

from polhode import _native

# Paths are texts here: to import pathlib would take as long as the rest of polhode.
_PROC = "/proc"
_CGROUP = "/sys/fs/cgroup"
_SMALL = 1 << 26  # bytes; asking the system takes longer than computing a result of this size


def available() -> int | None:
    """Return the number of free bytes; None where the system does not report it.

    The minimum of the memory that Linux reports as available and of what the control groups' limits leave;
    cached files count as free.
    """
    return min([*_of_machine(), *_of_groups()], default=None)


def require(bytes_wanted: int, what: str, remedy: str = "ask for fewer at a time") -> None:
    """Raise a MemoryError if there are fewer free bytes; ``what`` is its subject, in the plural."""
    if bytes_wanted < _SMALL:
        return
    free = available()
    if free is not None and bytes_wanted > free:
        raise MemoryError(f"{what} take {size(bytes_wanted)}; {size(free)} are free: {remedy}")


def require_array(shape: tuple[int, ...], what: str, itemsize: int = 8) -> None:
    """Raise a MemoryError if an array of numbers of this shape would not fit into memory."""
    bytes_wanted = itemsize * math.prod(shape)
    if bytes_wanted >= _SMALL:
        require(bytes_wanted, f"{what} of shape {shape}")


def size(count: int) -> str:
    """Return a number of bytes with three digits and a decimal unit."""
    number = float(count)
    for unit in ("bytes", "kB", "MB", "GB", "TB", "PB"):
        if number < 999.5:
            return f"{number:.3g} {unit}"
        number /= 1000
    return f"{number:.3g} EB"


def _of_machine() -> Iterator[int]:
    for line in _lines(f"{_PROC}/meminfo"):
        if line.startswith("MemAvailable:"):
            yield 1024 * int(line.split()[1])


def _of_groups() -> Iterator[int]:
    """Yield the free memory of the control group of this process and of its ancestors.

    The file names a group by its path from the root of the hierarchy. In a container that root may not be
    visible and the group itself is mounted, so paths that do not exist are skipped.
    """
    for line in _lines(f"{_PROC}/self/cgroup"):
        controllers, path = line.split(":", 2)[1:]
        inner = path.strip()
        if not controllers:
            for root in (_CGROUP, f"{_CGROUP}/unified"):
                yield from _left(root, inner, ("memory.max", "memory.current", "inactive_file"))
        elif "memory" in controllers.split(","):
            names = ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file")
            yield from _left(f"{_CGROUP}/memory", inner, names)


def _left(root: str, inner: str, names: tuple[str, str, str]) -> Iterator[int]:
    limit_name, usage_name, cache_name = names
    folders = [part for part in inner.split("/") if part]
    for depth in range(len(folders), -1, -1):
        group = "/".join([root, *folders[:depth]])
        limits, usages = _lines(f"{group}/{limit_name}"), _lines(f"{group}/{usage_name}")
        # "max" means no limit.
        if limits and usages and limits[0].strip().isdecimal():
            entries = (line.split() for line in _lines(f"{group}/memory.stat"))
            cache = sum(int(entry[1]) for entry in entries if entry and entry[0] == cache_name)
            yield max(0, int(limits[0]) - int(usages[0]) + cache)


def _lines(path: str) -> list[str]:
    try:
        with open(path) as file:
            return file.read().splitlines()
    except OSError:
        return []


_native.register("require_memory", require)
