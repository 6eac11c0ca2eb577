"""Locks of ranges of a folder's work, held by processes."""

from __future__ import annotations

import contextlib
import json
import os
import socket
import tempfile
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path


class LockedError(OSError):
    """Another process works on a part of the range."""


@dataclass(frozen=True)
class Lock:
    """A range first..end and the process that holds it: its machine, number and start."""

    first: int
    end: int
    host: str
    pid: int
    started: str

    @staticmethod
    def own(first: int, end: int) -> Lock:
        """Return the lock of this process."""
        return Lock(first, end, socket.gethostname(), os.getpid(), _start_of(os.getpid()) or "")

    @property
    def is_stale(self) -> bool:
        """Whether the process ran on this machine and has ended."""
        if self.host != socket.gethostname():
            return False
        if started := _start_of(self.pid):
            return self.started not in ("", started)
        return not _lives(self.pid)


def held(folder: Path) -> Iterator[tuple[Path, Lock]]:
    """Yield the lock files of a folder whose processes may live, in order; remove those of dead ones."""
    for path in sorted(folder.glob("*.lock")):
        try:
            lock = Lock(**json.loads(path.read_text()))
        except FileNotFoundError:
            continue
        except (ValueError, TypeError) as error:
            raise LockedError(f"{path} is not a lock of polhode ({error}): delete it") from None
        if lock.is_stale:
            path.unlink(missing_ok=True)
        else:
            yield path, lock


@contextlib.contextmanager
def locked(folder: Path, first: int, end: int, what: str) -> Iterator[None]:
    """Hold a range of the work in a folder during the block.

    A lock file appears complete, by a rename, before others are looked at. So of two processes that start at
    the same time at least one sees the other; both may then be refused.

    Raises
    ------
    LockedError
        If another process holds a part of the range; the message names it as the user of `what`.
    """
    folder.mkdir(parents=True, exist_ok=True)
    handle, part = tempfile.mkstemp(prefix=f"{first}-{end}.", dir=folder)
    try:
        with open(handle, "w") as file:
            json.dump(asdict(Lock.own(first, end)), file)
    except OSError:
        os.unlink(part)
        raise
    own = folder / f"{Path(part).name}.lock"
    os.rename(part, own)
    try:
        for path, lock in held(folder):
            if path.name != own.name and first < lock.end and lock.first < end:
                raise LockedError(
                    f"{what} is in use by process {lock.pid} on {lock.host}, which computes bodies "
                    f"{lock.first}:{lock.end}: wait for it, or delete {path} if it has ended"
                )
        yield
    finally:
        own.unlink(missing_ok=True)


def _start_of(pid: int) -> str | None:
    """Return boot and start time of a process; later ones of its number have others. None if unknown.

    Only Linux reports them. A process that has ended but was not waited for counts as ended.
    """
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        boot = Path("/proc/sys/kernel/random/boot_id").read_text().strip()
    except OSError:
        return None
    return "ended" if fields[0] in "ZX" else f"{boot} {fields[19]}"


def _lives(pid: int) -> bool:
    if os.name == "nt":
        return True  # a signal of 0 would end the process
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True
