"""Atomic writing of files, and the suffixes of output files."""

from __future__ import annotations

import contextlib
import os
import stat
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

from polhode._support.memory import require


def contents(path: str | os.PathLike[str], copies: int = 1) -> bytes:
    """Return the content of a file; a MemoryError first if so many copies would not fit into memory.

    An OSError for a device or a named pipe, which may never end.
    """
    if is_endless(path):
        raise OSError("not a regular file")
    return Path(loadable(path, copies)).read_bytes()


def is_endless(path: str | os.PathLike[str]) -> bool:
    """Whether a path is a device or a named pipe, which may wait forever; a shell's ``<(command)`` is not."""
    try:
        mode = os.stat(os.fspath(path)).st_mode
    except (OSError, ValueError):
        return False  # reading reports it
    if stat.S_ISFIFO(mode):
        return not os.path.realpath(path).startswith(("/dev/", "/proc/"))
    return stat.S_ISCHR(mode)


def loadable(path: str | os.PathLike[str], copies: int = 1) -> str:
    """Return the path as text; a MemoryError if so many copies of the file would not fit into memory."""
    name = os.fsdecode(path)
    with contextlib.suppress(OSError):  # reading reports it
        require(copies * os.path.getsize(path), f"the contents of {name}", "split the file")
    return name


class UnreadableError(Exception):
    """A file given to the command cannot be read or shown; the message gives the reason."""


def unreadable(error: Exception) -> UnreadableError:
    """Return the error of the command for a file that cannot be read: ``FILE: error: reason``.

    The message of the given error begins with ``FILE: ``, and may have this form already.
    """
    words = words_of(error)
    file, colon, reason = words.partition(": ")
    if ": error: " in words or not colon:
        return UnreadableError(words)
    return UnreadableError(f"{file}: error: {reason}")


def printable_stem(path: str | os.PathLike[str]) -> str:
    """Return the name of a file without its suffix as text that can be printed and written.

    Bytes that are not UTF-8 become �.
    """
    return os.fsencode(Path(path).stem).decode(errors="replace")


def words_of(error: Exception) -> str:
    """Return the message of an error; of one of the system its file and reason, without the number."""
    if isinstance(error, OSError) and error.strerror:
        file = "" if error.filename is None else f"{os.fsdecode(error.filename)}: "
        return f"{file}{error.strerror.lower()}"
    return str(error)


def write_atomically(contents: Mapping[Path, bytes | Path]) -> None:
    """Write files atomically: each path holds either its old content or all of the new.

    A content is bytes, or a file that `unfinished` yielded for this path. All contents are written to
    temporary files in the same directories and flushed to disk; then each is renamed in one step. If writing
    fails, no file has changed and the temporary files are removed; the error, an OSError, names the path. A
    symbolic link stays, and the file that it names is written.
    """
    with contextlib.ExitStack() as stack:
        ready = {
            target: stack.enter_context(_temporary(target, content)) for target, content in contents.items()
        }
        for target, temporary in ready.items():
            with naming(target):
                os.replace(temporary, _named(target))


@contextlib.contextmanager
def unfinished(target: Path) -> Iterator[Path]:
    """Yield a temporary file beside the target, to be filled; removed at the end if it still exists."""
    check_target(target)
    with naming(target):
        file = _named(target)
        handle, path = tempfile.mkstemp(prefix=f".{file.name}.", suffix=".part", dir=file.parent)
        os.close(handle)
    try:
        yield Path(path)
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(path)


# Suffixes of output files.
_FORMS = {
    "a motion": ("nc", "csv", "parquet"),
    "a page": ("html", "htm"),
    "a figure": ("svg", "pdf", "png"),
    "a film": ("mp4", "gif"),
    "a fit": ("json",),
}


def form_of(path: str | os.PathLike[str], what: str) -> str:
    """Return the suffix of a path in lower case; a ValueError if this output cannot have it."""
    forms = _FORMS[what]
    form = Path(path).suffix.lower().removeprefix(".")
    if form not in forms:
        *others, last = (f"FILE.{x}" for x in forms)
        names = f"{', '.join(others)} or {last}" if others else last
        raise ValueError(f"{what} is saved as {names}, not {os.fspath(path)!r}")
    return form


def _named(target: Path) -> Path:
    """Return the file that a path names, which may be a symbolic link to it."""
    return Path(os.path.realpath(target)) if target.is_symlink() else target


def check_target(target: Path) -> None:
    """Raise an OSError that names the path if a file cannot be written there."""
    with naming(target):
        target = _named(target)
        if target.parent.exists() and not target.parent.is_dir():
            raise OSError(f"{target.parent} is not a directory")
        if not target.parent.is_dir():
            raise OSError(f"no such directory: {target.parent}; create it first")
        if target.exists() and not target.is_file():
            raise OSError("it exists and is not a regular file")
        if not os.access(target.parent, os.W_OK):
            raise OSError(f"no permission to write in {target.parent}")


@contextlib.contextmanager
def _temporary(target: Path, content: bytes | Path) -> Iterator[str]:
    """Yield a temporary file beside the target with the content; removed at the end if it still exists."""
    with contextlib.ExitStack() as stack:
        path = content if isinstance(content, Path) else stack.enter_context(unfinished(target))
        with naming(target), path.open("r+b") as file:
            if isinstance(content, bytes):
                file.write(content)
            file.flush()
            os.fsync(file.fileno())
            os.chmod(path, _mode(target))
        yield str(path)


@contextlib.contextmanager
def naming(target: Path) -> Iterator[None]:
    """Let an OSError in the block say that this file cannot be written, and why."""
    try:
        yield
    except OSError as error:
        raise OSError(f"cannot write {target}: {error.strerror or error}") from error


def _mode(target: Path) -> int:
    """Return the permissions of the replaced file, or those of a new file."""
    if target.exists():
        return target.stat().st_mode & 0o7777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
