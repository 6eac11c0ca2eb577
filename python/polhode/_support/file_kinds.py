"""Files given in place of a scene or a CSV file: what they are, and the command that takes them."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from polhode._native import SceneError
from polhode._support.files import UnreadableError

# The example scenes of the package.
EXAMPLES = Path(__file__).parents[1] / "_examples"

_PICTURE = "a picture, which is written, not read"
_MESH = "a mesh: `polhode check {0}` checks it, and a scene names it as mesh in its table [body]"
_ROBOT = "a robot file: `polhode check {0}` checks it"
_TABLE = (
    "a table of a motion: `polhode convert {0} FILE` converts it; `polhode fit` fits a body to measurements"
)
_NUMBERS = "a table of numbers: meshes are STL, OBJ or PLY files, and `polhode fit` takes CSV files"
_PAGE = "a page: open it in a browser"
_SCENE = "a scene: `polhode run {0}` computes its motion; as --torque it gives the torques of a fit"
_KINDS = {
    ".nc": "a motion in netCDF: `polhode view {0}` shows it, `polhode convert {0} FILE` converts it",
    ".zarr": "a store: `polhode run --status {0}` verifies it, `polhode convert {0} FILE.nc --body N` reads "
    "a body of it",
    **dict.fromkeys((".csv", ".parquet", ".aem", ".bc"), _TABLE),
    **dict.fromkeys((".stl", ".obj", ".ply"), _MESH),
    **dict.fromkeys((".urdf", ".sdf", ".xml", ".mjcf", ".world", ".xacro"), _ROBOT),
    **dict.fromkeys((".png", ".svg", ".pdf", ".gif", ".mp4"), _PICTURE),
    **dict.fromkeys((".glb", ".gltf"), "an animation, which is written, not read"),
    **dict.fromkeys((".html", ".htm"), _PAGE),
    ".md": "a lesson: `polhode view {0}` shows it",
}
# Motions that are converted to CSV, and the arguments of the command.
_MOTIONS = {
    **dict.fromkeys((".nc", ".parquet", ".aem"), "{0} FILE.csv"),
    ".bc": "{0} FILE.csv --kernel FILE …",
    ".zarr": "{0} FILE.csv --body N",
}
# Number of first bytes by which a file is recognised; those of files with other names.
_HEAD = 200
_HEADS = {
    b"\x89HDF": ".nc",
    b"PAR1": ".parquet",
    b"CCSDS_AEM": ".aem",
    b"DAF/CK": ".bc",
    b"\x89PNG": ".png",
    b"GIF8": ".gif",
    b"%PDF": ".pdf",
    b"glTF": ".glb",
}


def separator_of(header: str) -> str:
    """Return the separator of a CSV file by its first line: commas, or else semicolons or tabs."""
    return next((x for x in ",;\t" if x in header), ",")


def is_comment(line: str) -> bool:
    """Whether a line of a CSV file is empty or begins with #; such lines are skipped."""
    return not line.strip() or line.lstrip().startswith("#")


def names_in_comment(before: Sequence[str], first: str, separator: str) -> str:
    """Return what to do if the names of the columns stand in a comment above the first row; else ""."""
    found = [k for k, line in enumerate(before, 1) if line.count(separator) == first.count(separator) > 0]
    return f"; remove the # before the names in line {found[-1]}" if found else ""


def suffix_of(path: str | os.PathLike[str]) -> str:
    """Return the suffix of a file in lower case; if it is not known, that of files with its first bytes."""
    suffix = Path(path).suffix.lower()
    known = suffix == ".toml" or suffix in _KINDS or not os.path.isfile(path)
    return suffix if known else _suffix_by_content(path) or suffix


def require_scene(path: str | os.PathLike[str]) -> None:
    """Raise a SceneError that says what an existing file is if it is not a scene."""
    name, suffix = os.fsdecode(path), Path(path).suffix.lower()
    if suffix == ".toml" or not os.path.exists(path):
        return
    kind = _KINDS.get(suffix) or (_kind_by_content(path) if os.path.isfile(path) else None)
    if kind is not None:
        raise SceneError(f"{name}: error: not a scene but {kind.format(name)}")


def require_csv(path: str | os.PathLike[str]) -> None:
    """Raise an UnreadableError that says what an existing file is if it is not a CSV file."""
    name, suffix = os.fsdecode(path), Path(path).suffix.lower()
    if suffix == ".csv" or not os.path.exists(path):
        return
    renamed = ""
    if suffix not in _KINDS and os.path.isfile(path) and (own := _suffix_by_content(path)):
        renamed, suffix = os.fsdecode(Path(path).with_suffix(own)), own
    if suffix in _MOTIONS:
        command = f"`polhode convert {_MOTIONS[suffix].format(renamed or name)}`"
        remedy = f"rename it to {renamed}, then {command}" if renamed else f"write one with {command}"
        raise UnreadableError(f"{name}: error: not a CSV file; {remedy}")
    kind = _SCENE if suffix == ".toml" else _KINDS.get(suffix)
    if kind is not None:
        raise UnreadableError(f"{name}: error: not a CSV file but {kind.format(name)}")


def _suffix_by_content(path: str | os.PathLike[str]) -> str | None:
    """Return the suffix that files with such first bytes have."""
    head = _head(path)
    return next((suffix for start, suffix in _HEADS.items() if head.startswith(start)), None)


def _kind_by_content(path: str | os.PathLike[str]) -> str | None:
    if suffix := _suffix_by_content(path):
        return _KINDS[suffix]
    head = _head(path)
    first = head.lstrip().partition(b"\n")[0].replace(b",", b" ").replace(b";", b" ").split()
    if first and all(_is_number(x) for x in first):
        return _NUMBERS
    return None


def _head(path: str | os.PathLike[str]) -> bytes:
    """Return the first bytes of a file; none if they cannot be read, which its reader reports."""
    try:
        with open(path, "rb") as file:
            return file.read(_HEAD)
    except OSError:
        return b""


def _is_number(text: bytes) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
