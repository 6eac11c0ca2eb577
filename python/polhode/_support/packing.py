"""Bytes as text for JSON: gzip in base64, unpacked by the page in `viewer/src/packed.ts`."""

from __future__ import annotations

import base64
import gzip


def packed(content: bytes) -> str:
    """Return the text of the bytes; equal bytes give equal text."""
    return base64.b64encode(gzip.compress(content, mtime=0)).decode("ascii")


def unpacked(text: str) -> bytes:
    """Return the bytes of a text from `packed`."""
    return gzip.decompress(base64.b64decode(text))
