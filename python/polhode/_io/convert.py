"""Reading and writing files by their suffix, as ``polhode convert`` does."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from polhode._io import aem, aem_writing, gltf, members, spice, tables
from polhode._io.history import AttitudeHistory, FileError
from polhode._mechanics.trajectory import Trajectory
from polhode._report import netcdf_reading
from polhode._support.calls import explains_calls
from polhode._support.file_kinds import suffix_of

_READERS: dict[str, Callable[..., AttitudeHistory]] = {
    "aem": aem.read_aem,
    "bc": spice.read_ck,
    "csv": tables.read_csv,
    "nc": members.read_netcdf,
    "parquet": tables.read_parquet,
    "zarr": members.read_zarr,
}
READ, WRITTEN = tuple(_READERS), ("aem", "bc", "csv", "glb", "gltf", "nc", "parquet")
# Options of the formats, by what is done and the suffix.
OPTIONS: dict[tuple[str, str], tuple[str, ...]] = {
    ("read", "aem"): ("segment", "epoch", "body_frame", "quaternion_type", "attitude_dir", "angvel_frame"),
    ("read", "bc"): ("kernels", "segment", "epoch", "time_system"),
    **{("read", form): ("body",) for form in ("csv", "nc", "parquet", "zarr")},
    ("write", "aem"): (
        *("epoch", "time_system", "reference_frame", "body_frame", "version", "originator"),
        *("object_name", "object_id", "center_name"),
    ),
    ("write", "bc"): ("kernels", "epoch", "time_system", "reference_frame", "body_frame"),
    **{("write", form): ("surface", "mass") for form in ("glb", "gltf")},
    **{("write", form): () for form in ("csv", "nc", "parquet")},
}


def form_of(path: str | os.PathLike[str], forms: tuple[str, ...], done: str) -> str:
    """Return the suffix of a path in lower case; a ValueError if it is not among the forms."""
    form = Path(path).suffix.lower().removeprefix(".")
    if form not in forms:
        *others, last = (f".{x}" for x in forms)
        raise ValueError(
            f"files that can be {done} end in {', '.join(others)} or {last}, got {os.fspath(path)!r}"
        )
    return form


def form_to_read(path: str | os.PathLike[str]) -> str:
    """Return the form of a file of a motion: its suffix, or if that is not known, that of its first bytes."""
    form = suffix_of(path).removeprefix(".")
    return form if form in READ else form_of(path, READ, "read")


@explains_calls
def read(path: str | os.PathLike[str], **options: Any) -> AttitudeHistory:
    """Read the attitudes of one body from a file, in the form of its suffix.

    The suffixes are ``.aem``, ``.bc`` (SPICE CK), ``.csv``, ``.nc``, ``.parquet`` and ``.zarr``. A file whose
    suffix is not known is recognised by its first bytes, except CSV. Options are those of `read_aem`,
    `read_ck`, `read_csv`, `read_netcdf`, `read_parquet` and `read_zarr`.

    Examples
    --------
    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> motion = ph.simulate(ball, ph.State(ph.Rotor.identity(), [0, 0, 1]), [0, 1, 2])
    >>> ph.io.write(motion, "ball.csv")
    >>> ph.io.read("ball.csv")
    AttitudeHistory(3 times, t = 0 … 2 s, rotor, omega_body, momentum_space, position, velocity, energy)
    """
    form = form_to_read(path)
    return _READERS[form](path, **_with_kernels(options) if form == "bc" else options)


@explains_calls
def write(motion: Trajectory | AttitudeHistory, path: str | os.PathLike[str], **options: Any) -> None:
    """Write the motion of one body to a file, atomically, in the form of its suffix.

    The suffixes are ``.aem``, ``.bc`` (SPICE CK), ``.csv``, ``.glb``, ``.gltf``, ``.nc`` and ``.parquet``.
    Options are those of `write_aem`, `write_ck` and `write_gltf`; tables have none. A CSV file has no
    attributes.

    Examples
    --------
    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> motion = ph.simulate(ball, ph.State(ph.Rotor.identity(), [0, 0, 1]), [0, 1, 2])
    >>> ph.io.write(motion, "ball.csv")
    >>> ph.io.write(motion, "ball.aem", epoch="2026-01-01T00:00:00", reference_frame="EME2000")
    >>> bool((ph.io.read("ball.csv").rotor == motion.rotor).all())
    True
    """
    form = form_of(path, WRITTEN, "written")
    if form == "aem":
        aem_writing.write_aem(motion, path, **options)
    elif form == "bc":
        spice.write_ck(motion, path, **_with_kernels(options))
    elif form in ("glb", "gltf"):
        gltf.write_gltf(motion, path, **options)
    elif options:
        raise TypeError(f"a .{form} file has no option {next(iter(options))!r}")
    else:
        tables.write_table(motion, path, form)


def _with_kernels(options: dict[str, Any]) -> dict[str, Any]:
    if not options.get("kernels"):
        raise ValueError(
            "a CK needs the leapseconds, clock and frame kernels of its spacecraft; give kernels=[FILE, ...]"
        )
    return options


def load(path: str | os.PathLike[str], **options: Any) -> Trajectory | AttitudeHistory:
    """Return the motion in a file: a trajectory with all that it has, if the file has one, else a history."""
    if not options and form_to_read(path) == "nc":
        history = members.read_netcdf(path)
        try:
            return netcdf_reading.read(path)
        except ValueError:
            return history
    return read(path, **options)


__all__ = ["READ", "WRITTEN", "FileError", "form_of", "form_to_read", "load", "read", "write"]
