"""Reading of one body of many: from netCDF files of batches and ensembles, and from Zarr stores."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from polhode._io.history import AttitudeHistory, FileError, checked_body
from polhode._io.tables import of_parts
from polhode._report import netcdf, netcdf_reading
from polhode._report.ensemble.arrays import zarr
from polhode._report.ensemble.store import EnsembleStore
from polhode._report.hdf5_heaps import require_sound_heaps
from polhode._report.netcdf_labels import LABELS, LabelError, attribute, require_order
from polhode._report.table import ALONG_TIME
from polhode._support.arrays import Array
from polhode._support.calls import explains_calls
from polhode._support.counts import counted
from polhode._support.extras import optional

# Attributes that describe the file, not the body.
_OF_FILE = ("batch_shape", "bodies_complete", "number", "varied")


@explains_calls
def read_netcdf(path: str | os.PathLike[str], *, body: int | None = None) -> AttitudeHistory:
    """Read the attitudes of one body from a netCDF file that Polhode wrote.

    The file is that of a trajectory, a batch, an ensemble or a history. Of many bodies only the chosen one is
    read. Quantities that the file has once for a body, because they are constant, are repeated at all times;
    position and velocity at the start, of an ensemble without forces, become those of uniform motion.

    Parameters
    ----------
    body
        Number of the body, from 0, for the file of a batch or an ensemble.

    Raises
    ------
    ValueError
        If the file holds many bodies and `body` is not one of them, or was not written by Polhode; if it
        states other units or another order of components, or has missing or packed values.
    ImportError
        Without the libraries: ``pip install 'polhode[io]'``.

    Warns
    -----
    UserWarning
        If the body failed; its attitudes before that are read.

    Examples
    --------
    One of three balls:

    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> starts = ph.State(ph.Rotor.identity(), [[0, 0, 1], [0, 0, 2], [0, 0, 3]])
    >>> ph.simulate(ball, starts, [0, 1, 2]).save("balls.nc")
    >>> ph.io.read_netcdf("balls.nc", body=1).omega_body["e12"]
    array([2., 2., 2.])
    """
    name, body = os.fsdecode(path), checked_body(body)
    library = optional("h5py", "io", "a netCDF file")
    if os.path.isfile(path) and os.access(path, os.R_OK):
        try:
            require_sound_heaps(path)
            with library.File(path, "r") as file:
                if "body" in file:
                    require_order(file)
                    attributes = {x: attribute(y) for x, y in file.attrs.items()}
                    return _member(name, file, attributes, body)
        except FileError:
            raise
        except LabelError as error:
            raise FileError(f"{name}: error: {error}") from None
        except netcdf_reading.DAMAGED as error:
            raise FileError(f"{name}: error: cannot be read as a netCDF file: {error}") from None
    try:
        fields, attributes = netcdf_reading.content(path)
    except LabelError as error:
        raise FileError(str(error).replace(f"{name}: ", f"{name}: error: ", 1)) from None
    if body is not None:
        raise FileError(f"{name}: error: the file holds one body; leave out body={body}")
    return _single(name, fields, attributes)


@explains_calls
def read_zarr(path: str | os.PathLike[str], *, body: int | None = None) -> AttitudeHistory:
    """Read the attitudes of one body from the Zarr store of an ensemble, which need not be complete.

    As `read_netcdf`, which describes `body`. The checksums of the body's block are verified. Stores that
    xarray wrote from `Trajectory.to_xarray` are read, too.

    Raises
    ------
    ValueError
        If there is no such body, its block is missing or corrupt, or there are no attitudes.
    FileNotFoundError
        If there is no such store.
    ImportError
        Without the libraries: ``pip install 'polhode[zarr]'``.

    Examples
    --------
    >>> text = '''
    ... body.moments = [1, 2, 3]
    ... initial.spin = { vector = [0, 0, 1] }
    ... ensemble = { number = 3, attitude = "uniform" }
    ... run = { duration = 10, samples = 6 }
    ... '''
    >>> with open("turned.toml", "w") as file:
    ...     _ = file.write(text)
    >>> data = ph.Scene.read("turned.toml").run(store="turned.zarr")
    >>> history = ph.io.read_zarr("turned.zarr", body=2)
    >>> history.time
    array([ 0.,  2.,  4.,  6.,  8., 10.])
    >>> history.omega_body["e12"].round(9)
    array([1., 1., 1., 1., 1., 1.])
    """
    name, body = os.fsdecode(path), checked_body(body)
    if not os.path.lexists(path):
        raise FileNotFoundError(f"{name}: no such store")
    if not os.path.isdir(path):
        raise FileError(f"{name}: error: a file, and a Zarr store is a folder")
    library = zarr()
    if EnsembleStore.exists(Path(path)) and body is not None:
        _require_done(_opened(Path(path)), body)
    try:
        group = library.open_group(name, mode="r")
        _require_short_texts(Path(path), group)
        require_order(group)
        if "body" in group:
            return _member(name, group, dict(group.attrs), body)
        known = ("time", "wheel_speed", *netcdf.MOTION)
        fields = {x: netcdf_reading.values(x, group[x]) for x in known if x in group}
        attributes = dict(group.attrs)
    except FileError:
        raise
    except LabelError as error:
        raise FileError(f"{name}: error: {error}") from None
    except netcdf_reading.DAMAGED as error:
        raise FileError(f"{name}: error: cannot be read as a Zarr store: {error}") from None
    if body is not None:
        raise FileError(f"{name}: error: the store holds one body; leave out body={body}")
    return _single(name, fields, attributes)


def _require_short_texts(path: Path, group: Any) -> None:
    """Raise a ValueError for labels whose chunk states more texts than there are.

    Zarr makes room for as many texts of variable size as the first four bytes state.
    """
    for name, wanted in LABELS.items():
        variable: Any = group.get(name, None)
        if getattr(variable, "shape", None) != (len(wanted),) or variable.dtype.kind not in "OT":
            continue
        for file in (path / name).rglob("[!.]*"):
            if not file.is_file() or file.name == "zarr.json" or variable.compressors:
                continue
            with file.open("rb") as content:
                count = int.from_bytes(content.read(4), "little")
            if count != len(wanted):
                raise ValueError(f"{name!r} is damaged: it has {len(wanted)} texts, but states {count}")


def _single(name: str, fields: Mapping[str, Any], attributes: Mapping[str, Any]) -> AttitudeHistory:
    """Return the history in a file of one body."""
    if missing := [x for x in ("time", "attitude") if x not in fields]:
        raise FileError(f"{name}: error: not a motion that polhode wrote: {missing[0]!r} is missing")
    parts = {x: fields[x] for x in ALONG_TIME if x in fields}
    kept = netcdf_reading.of_user(dict(attributes))
    try:
        wheels, inertia = fields.get("wheel_speed"), fields.get("inertia")
        return of_parts(np.asarray(fields["time"], float), parts, wheels, kept, inertia)
    except (TypeError, ValueError) as error:
        raise FileError(f"{name}: error: not a motion that polhode wrote: {error}") from None


def _opened(path: Path) -> EnsembleStore:
    try:
        return EnsembleStore.open(path)
    except ValueError as error:
        raise FileError(str(error).replace(f"{path}: ", f"{path}: error: ", 1)) from None


def _require_done(store: EnsembleStore, body: int) -> None:
    _require_body(str(store.path), body, store.number)
    index = body // store.block
    if (state := store.state(index)) != "done":
        rows = store.rows(index)
        raise FileError(
            f"{store.path}: error: the block of body {body} is {state}, as bodies {rows.start} to "
            f"{rows.stop - 1}; compute it with polhode run --resume"
        )


def _require_body(name: str, body: int | None, count: int) -> int:
    if body is None:
        raise FileError(
            f"{name}: error: the file holds {counted(count, 'body')}; choose one by its number, as in body=0"
        )
    if not 0 <= body < count:
        raise FileError(f"{name}: error: body must be from 0 to {count - 1}, got {body}")
    return body


def _member(name: str, arrays: Any, attributes: Mapping[str, Any], body: int | None) -> AttitudeHistory:
    """Return the history of a body from the arrays of a file, whose first axis is that of the bodies."""
    if "attitude" not in arrays and "keep" in attributes:
        raise FileError(
            f"{name}: error: no attitudes of bodies: it has reduced outputs only "
            f"(keep: {attributes['keep']}); run its scene without keep in [ensemble]"
        )
    for needed in ("time", "attitude"):
        if needed not in arrays:
            raise FileError(f"{name}: error: no attitudes of bodies: {needed!r} is missing")
    # A group has no shape.
    body = _require_body(name, body, getattr(arrays["attitude"], "shape", (0,))[0])
    time = np.asarray(netcdf_reading.values("time", arrays["time"]), float)
    known = [x for x in (*ALONG_TIME, "wheel_speed") if x in arrays]
    parts = {x: np.asarray(netcdf_reading.values(x, arrays[x], body), float) for x in known}
    inertia = _inertia(arrays, body)
    wheels = parts.pop("wheel_speed", None)
    parts = _along(time, parts)
    count = _complete(name, time, parts["attitude"], body)
    kept = {x: y for x, y in netcdf_reading.of_user(dict(attributes)).items() if x not in _OF_FILE}
    parts = {x: y[:count] for x, y in parts.items()}
    wheels = None if wheels is None else wheels[:count]
    try:
        return of_parts(time[:count], parts, wheels, {**kept, "body": body}, inertia)
    except (TypeError, ValueError) as error:
        raise FileError(f"{name}: error: not bodies that polhode wrote: {error}") from None


def _along(time: Array, parts: dict[str, Array]) -> dict[str, Array]:
    """Return the quantities at all times; some are in the file once for each body."""
    found = {}
    for name, values in parts.items():
        if values.shape != netcdf_reading.shape_of(name):
            found[name] = values
        else:
            found[name] = np.repeat(values[np.newaxis], len(time), axis=0)
            if name == "position":
                found[name] += np.multiply.outer(time - time[0], parts["velocity"])
    netcdf_reading.require_shapes(time, found)
    return found


def _inertia(arrays: Any, body: int) -> Array | None:
    """Return the inertia matrix of a body; the file has one for each or one for all."""
    if "inertia" not in arrays:
        return None
    each = len(getattr(arrays["inertia"], "shape", ())) == 3
    return np.asarray(netcdf_reading.values("inertia", arrays["inertia"], body if each else None), float)


def _complete(name: str, time: Array, attitudes: Array, body: int) -> int:
    """Return the number of times before a body failed, with a warning if it did."""
    finite = np.isfinite(attitudes).all(axis=-1)
    count = len(time) if finite.all() else int(np.argmin(finite))
    if not count:
        raise FileError(f"{name}: error: body {body} has no attitudes: it failed, or was not computed")
    if count < len(time):
        warnings.warn(
            f"{name}: body {body} failed after {time[count - 1]:g} s; later times are left out", stacklevel=4
        )
    return count
