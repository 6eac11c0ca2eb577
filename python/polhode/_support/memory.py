"""How much memory a process may still have, asked before a large result is computed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

_PROC = Path("/proc")
_CGROUP = Path("/sys/fs/cgroup")
_SMALL = 1 << 26  # bytes; to ask the system takes longer than to compute so many


def available() -> int | None:
    """Return the bytes that may still be had, None where the system does not tell.

    The least of what Linux says is available and of what the limits of the control groups leave. Pages of
    files that it would give up are free.
    """
    return min([*_of_machine(), *_of_groups()], default=None)


def require(bytes_wanted: int, what: str, remedy: str = "ask for fewer at a time") -> None:
    """Raise a MemoryError if so many bytes are not to be had; ``what`` is its subject, in the plural."""
    if bytes_wanted < _SMALL:
        return
    free = available()
    if free is not None and bytes_wanted > free:
        raise MemoryError(f"{what} take {size(bytes_wanted)}; {size(free)} are free: {remedy}")


def size(count: int) -> str:
    """Bytes as people say them: three digits and a decimal unit."""
    number = float(count)
    for unit in ("bytes", "kB", "MB", "GB", "TB", "PB"):
        if number < 999.5:
            return f"{number:.3g} {unit}"
        number /= 1000
    return f"{number:.3g} EB"


def _of_machine() -> Iterator[int]:
    for line in _lines(_PROC / "meminfo"):
        if line.startswith("MemAvailable:"):
            yield 1024 * int(line.split()[1])


def _of_groups() -> Iterator[int]:
    """What is left in the group of this process and in those around it.

    The file names a group by its path from the root of the hierarchy; in a container that root may be out of
    sight and the mounted one is the group, so that a path that is not there is passed over.
    """
    for line in _lines(_PROC / "self" / "cgroup"):
        controllers, path = line.split(":", 2)[1:]
        inner = Path(path.strip().lstrip("/"))
        if not controllers:
            for root in (_CGROUP, _CGROUP / "unified"):
                yield from _left(root, inner, ("memory.max", "memory.current", "inactive_file"))
        elif "memory" in controllers.split(","):
            names = ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file")
            yield from _left(_CGROUP / "memory", inner, names)


def _left(root: Path, inner: Path, names: tuple[str, str, str]) -> Iterator[int]:
    limit_name, usage_name, cache_name = names
    for group in (root / inner, *(root / parent for parent in inner.parents)):
        limits, usages = _lines(group / limit_name), _lines(group / usage_name)
        # "max" is no limit.
        if limits and usages and limits[0].strip().isdecimal():
            entries = (line.split() for line in _lines(group / "memory.stat"))
            cache = sum(int(entry[1]) for entry in entries if entry and entry[0] == cache_name)
            yield max(0, int(limits[0]) - int(usages[0]) + cache)


def _lines(path: Path) -> list[str]:
    """Lines of a file; none where there is no such file."""
    try:
        return path.read_text().splitlines()
    except OSError:
        return []
