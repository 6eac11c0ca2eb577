"""Check of the heaps of an HDF5 file, which hold its texts of variable size."""

from __future__ import annotations

import mmap
import os
import struct

_SIGNATURE, _VERSION = b"GCOL", b"\1\0\0\0"
# Bytes of the header of a heap, and of the header of an object in it: number, references, reserved, size.
_HEAD, _OBJECT = 16, struct.Struct("<HHIQ")
_LEAST = 4096  # bytes of a heap
# Larger files are not searched for heaps, which takes a second in so many bytes.
_LARGEST = 1 << 29


def require_sound_heaps(path: str | os.PathLike[str]) -> None:
    """Raise an OSError for a damaged heap in which HDF5 would search without end.

    HDF5 goes from one object to the next by its size. It stays at an object with the number and the size 0.
    """
    size = os.path.getsize(path)
    if not 0 < size <= _LARGEST:
        return
    with open(path, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
        at = content.find(_SIGNATURE)
        while at >= 0:
            _require_end(content, at)
            at = content.find(_SIGNATURE, at + 1)


def _require_end(content: mmap.mmap, start: int) -> None:
    """Raise an OSError unless the objects of a heap end."""
    head = content[start : start + _HEAD]
    length = int.from_bytes(head[8:], "little")
    if head[4:8] != _VERSION or length < _LEAST or start + length > len(content):
        return  # not a heap, or one that HDF5 rejects
    at, end = start + _HEAD, start + length
    while at + _OBJECT.size <= end:
        number, _, _, size = _OBJECT.unpack_from(content, at)
        step = _OBJECT.size + -(-size // 8) * 8 if number else size
        if not step:
            raise OSError(f"the heap of texts is damaged at byte {at}")
        at += step
