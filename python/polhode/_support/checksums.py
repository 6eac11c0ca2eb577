"""Checksums of files, and JSON files that contain their own."""

from __future__ import annotations

import hashlib
import json
import zlib
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

# Bytes that are read or written at a time: they fit into the cache of a core.
PIECE = 1 << 18


def checksum(pieces: Iterable[Any]) -> str:
    """Return the checksum of bytes, given in pieces: their number and CRC-32, which finds accidental damage.

    A cryptographic digest takes as long as the computation of exact motions.
    """
    code, size = 0, 0
    for piece in pieces:
        code, size = zlib.crc32(piece, code), size + memoryview(piece).nbytes
    return f"{size}-{code:08x}"


def digests(folder: Path, files: Iterable[str]) -> dict[str, str]:
    """Return the checksum of each file; of a missing one "missing"."""
    return {name: _digest(folder / name) for name in files}


def _digest(path: Path) -> str:
    try:
        return checksum(_pieces(path))
    except FileNotFoundError:
        return "missing"


def _pieces(path: Path) -> Iterator[memoryview]:
    """Yield the content of a file, each time in the same memory."""
    buffer = memoryview(bytearray(PIECE))
    with path.open("rb", buffering=0) as file:
        while count := file.readinto(buffer):
            yield buffer[:count]


def seal(path: Path, content: dict[str, Any]) -> None:
    """Write a JSON file with the checksum of its content; see `sealed`."""
    text = json.dumps(content)
    path.write_text(f"{text}\n{_seal_of(text)}\n", encoding="utf-8")


def sealed(path: Path) -> dict[str, Any]:
    """Return the content of a file that `seal` wrote; a ValueError if it is damaged."""
    text, _, found = path.read_text(encoding="utf-8").partition("\n")
    if _seal_of(text) != found.strip():
        raise ValueError(f"{path} is damaged")
    return dict(json.loads(text))


def _seal_of(text: str) -> str:
    return hashlib.blake2b(text.encode(), digest_size=16).hexdigest()
