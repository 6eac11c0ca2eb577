"""Checksums of files, and JSON files that contain their own."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any


def digests(folder: Path, files: Iterable[str]) -> dict[str, str]:
    """Return the checksum of each file; of a missing one "missing"."""
    return {name: _digest(folder / name) for name in files}


def _digest(path: Path) -> str:
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, lambda: hashlib.blake2b(digest_size=16)).hexdigest()
    except FileNotFoundError:
        return "missing"


def seal(path: Path, content: dict[str, Any]) -> None:
    """Write a JSON file with the checksum of its content; see `sealed`."""
    text = json.dumps(content)
    checksum = hashlib.blake2b(text.encode(), digest_size=16).hexdigest()
    path.write_text(f"{text}\n{checksum}\n", encoding="utf-8")


def sealed(path: Path) -> dict[str, Any]:
    """Return the content of a file that `seal` wrote; a ValueError if it is damaged."""
    text, _, checksum = path.read_text(encoding="utf-8").partition("\n")
    if hashlib.blake2b(text.encode(), digest_size=16).hexdigest() != checksum.strip():
        raise ValueError(f"{path} is damaged")
    return dict(json.loads(text))
