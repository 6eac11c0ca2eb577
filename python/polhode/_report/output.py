"""Files of motions by suffix; whether a file was written by polhode."""

from __future__ import annotations

import json
from pathlib import Path

from polhode._mechanics.trajectory import Trajectory
from polhode._report import netcdf, netcdf_labels, table
from polhode._support.extras import optional

# Bytes at the start of a file that name the program.
_HEAD = 4096


def encoded(trajectory: Trajectory, form: str) -> bytes:
    """Return the content of a file with this suffix, a form of "a motion"."""
    match form:
        case "csv":
            return table.csv(trajectory)
        case "parquet":
            return table.parquet(trajectory)
        case _:
            return netcdf.netcdf(trajectory)


def require_libraries(form: str) -> None:
    """Raise an ImportError if libraries for files with this suffix are missing."""
    if form == "parquet":
        table.require_parquet()
    elif form == "nc":
        netcdf.require_libraries()


def require_own(path: Path) -> None:
    """Raise a FileExistsError if there is a file that polhode did not write."""
    if path.exists() and not is_own(path):
        raise FileExistsError(
            f"{path} exists and was not written by polhode: choose another name, or overwrite it with --force"
        )


def is_own(path: Path) -> bool:
    """Whether polhode wrote a file, by its content; an empty file counts as such.

    NetCDF and Parquet files have the attribute `source`, fits this key, CSV files the header, figures, films
    and pages the program's name. Libraries of the form must be installed.
    """
    with path.open("rb") as file:
        head = file.read(_HEAD)
    if not head:
        return True
    match path.suffix.lower():
        case ".nc":
            return _source_of_netcdf(path).startswith("polhode ")
        case ".parquet":
            return _source_of_parquet(path).startswith("polhode ")
        case ".bc":
            return head.startswith(b"DAF/CK ") and head[16:76].startswith(b"polhode ")
        case ".csv":
            return table.is_own_header(head.splitlines()[0].decode(errors="replace"))
        case ".aem":
            return head.startswith(b"CCSDS_AEM_VERS") and b"\nCOMMENT Written by polhode " in head
        case ".glb" | ".gltf":
            return b'"generator":"Polhode ' in head
        case ".urdf" | ".xml":
            return b"\n<!-- Written by polhode " in head
        case ".stl":
            return head.startswith(b"Written by polhode ")
        case ".png":
            return head.startswith(b"\x89PNG") and b"tEXtSoftware\0Polhode" in head
        case ".svg":
            return b"<cc:Agent>\n      <dc:title>Polhode</dc:title>" in head
        case ".pdf":
            # Matplotlib writes the facts of a document at the end of the file.
            return head.startswith(b"%PDF") and b"/Creator (Polhode)" in path.read_bytes()
        case ".gif":
            # A comment block: its label, the length of the text, the text and the end.
            return head.startswith(b"GIF8") and b"\x21\xfe\x07Polhode\0" in head
        case ".mp4":
            return _comment_of_mp4(path).endswith(b"Polhode")
        case ".json":
            return head.startswith(b'{\n  "source": "polhode ')
        case ".html" | ".htm":
            return b'<meta name="generator" content="Polhode">' in head
        case _:
            return False


def _source_of_netcdf(path: Path) -> str:
    try:
        with optional("h5py", "io", "a netCDF file").File(path, "r") as file:
            return str(netcdf_labels.attribute(file.attrs.get("source", "")))
    except (OSError, RuntimeError, KeyError, TypeError, ValueError):
        return ""  # The library raises any of these for other files.


def _source_of_parquet(path: Path) -> str:
    try:
        schema = optional("pyarrow.parquet", "parquet", "a Parquet file").read_schema(path)
        return str(json.loads(schema.metadata[b"PANDAS_ATTRS"])["source"])
    except (OSError, KeyError, TypeError, ValueError):
        return ""


def _comment_of_mp4(path: Path) -> bytes:
    """Return the comment of an MP4 with its header, or nothing.

    The file is a sequence of boxes of a length and a name, some of which hold others. The comment is in
    the boxes below.
    """
    with path.open("rb") as file:
        end = path.stat().st_size
        for name in (b"moov", b"udta", b"meta", b"ilst", b"\xa9cmt", b"data"):
            while True:
                start = file.tell()
                head = file.read(8)
                size = int.from_bytes(head[:4], "big")
                if len(head) < 8 or size < 8 or start + size > end:
                    return b""
                if head[4:] == name:
                    break
                file.seek(start + size)
            end = start + size
            if name == b"meta":
                file.read(4)  # version and flags precede its boxes
        return file.read(min(end - file.tell(), _HEAD))
