"""Bytes as text for JSON: gzip in base64, which the page unpacks (`viewer/src/packed.ts`)."""

from __future__ import annotations

import base64
import gzip


def packed(content: bytes) -> str:
    """Return the text; the same for the same bytes."""
    return base64.b64encode(gzip.compress(content, mtime=0)).decode("ascii")


def unpacked(text: str) -> bytes:
    """Return the bytes that `packed` was given."""
    return gzip.decompress(base64.b64decode(text))
