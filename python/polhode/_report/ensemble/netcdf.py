"""NetCDF file of an ensemble, written block by block."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from polhode._mechanics.trajectory import Trajectory
from polhode._report.ensemble.collect import EnsembleRecords
from polhode._report.ensemble.layout import LABELS, Variable, failures, flags
from polhode._report.ensemble.reduced import ReducedBlock, ReducedRecords
from polhode._report.ensemble.reduced_layout import bytes_of_body, layout_of
from polhode._report.netcdf import of_fixed_size
from polhode._scene.scene import Scene
from polhode._support.extras import optional


def bytes_of_file(scene: Scene) -> int:
    """Return the approximate size in bytes of the file of a scene's ensemble."""
    assert scene.ensemble is not None
    if scene.ensemble.keep:
        return scene.ensemble.number * bytes_of_body(scene) + 8 * 20 * len(scene.times)
    numbers = 4 + 3 + (scene.kind != "free") + 6 * (scene.force is not None)
    return scene.ensemble.number * 8 * (numbers * len(scene.times) + 30)


class _Disk(io.FileIO):
    """A file for HDF5 in which writing never fails: it keeps the first error of the system.

    HDF5 crashes the process after a write that failed, as on a full disk.
    """

    error: OSError | None = None

    def write(self, data: Any) -> int:
        """Write all of the data; nothing after an error."""
        rest = memoryview(data)
        try:
            while rest and self.error is None:
                rest = rest[super().write(rest) :]
        except OSError as error:
            self.error = error
        return len(data)

    def truncate(self, size: int | None = None) -> int:
        """Set the size of the file; not after an error."""
        try:
            return self.tell() if self.error is not None else super().truncate(size)
        except OSError as error:
            self.error = error
            return self.tell()

    @contextlib.contextmanager
    def raising(self) -> Iterator[None]:
        """Raise the error of the system at the end of the block, instead of any that HDF5 makes of it."""
        try:
            yield
        finally:
            if self.error is not None:
                raise self.error


class EnsembleFile:
    """A netCDF file with a dimension `body` that grows; its layout is `EnsembleLayout`."""

    def __init__(self, path: Path, scene: Scene) -> None:
        assert scene.ensemble is not None
        self._layout, self._number = layout_of(scene), scene.ensemble.number
        hdf = optional("h5py", "io", "a netCDF file")
        self._text = hdf.string_dtype()
        self._disk = _Disk(path, "w+")
        # netCDF needs the order of creation.
        self._hdf = hdf.File(self._disk, "w", track_order=True)
        self._file = optional("h5netcdf", "io", "a netCDF file").File(self._hdf, "w")
        # The variables of bodies as HDF5 datasets: h5netcdf looks each one up again at every use.
        self._datasets: dict[str, Any] = {}
        self._block = scene.block
        self._methods: list[str] = []
        with self._disk.raising():
            self._begin(len(scene.times))

    def close(self) -> None:
        """Close the file; an OSError if it is not written, as on a full disk."""
        with self._disk.raising():
            self._file.close()
            self._hdf.close()
            self._disk.close()

    def _begin(self, times: int) -> None:
        """Write dimensions, coordinates and attributes."""
        sizes = {name: len(labels) for name, labels in LABELS.items()}
        self._file.dimensions = {"time": times, **sizes, "body": None}
        for name, labels in LABELS.items():
            variable = self._file.create_variable(name, (name,), self._text)
            variable[:] = np.array(list(labels), dtype=object)
        for shared in self._layout.shared():
            self._write(shared)
        self._file.attrs.update(of_fixed_size(self._layout.attributes()))

    def _write(self, given: Variable) -> None:
        """Write a variable of fixed size."""
        for dim, size in zip(given.dims, np.shape(given.values), strict=True):
            if dim not in self._file.dimensions:
                self._file.dimensions[dim] = size
        variable = self._file.create_variable(given.name, given.dims, np.asarray(given.values).dtype)
        variable[...] = given.values
        variable.attrs.update(given.labels)

    def add(self, rows: slice, trajectory: Trajectory | ReducedBlock) -> None:
        """Write the next bodies; an OSError if this is not possible, as on a full disk."""
        numbers = np.arange(rows.start, rows.stop)
        with self._disk.raising():
            self._grow(rows, Variable("body", (), numbers, "1", "number of the body"))
            self._grow(rows, Variable("method", (), self._codes(trajectory), "1", "method"))
            for variable in self._layout.of_bodies(rows, trajectory):
                self._grow(rows, variable)

    def _codes(self, trajectory: Trajectory | ReducedBlock) -> Any:
        """Return the number of each body's method in the list of all so far."""
        names, which = np.unique(np.asarray(trajectory.certificate.method, str), return_inverse=True)
        self._methods += sorted({*names.tolist()} - {*self._methods})
        codes = np.array([self._methods.index(name) for name in names.tolist()], np.int8)
        return np.broadcast_to(codes[which], len(trajectory))

    def _grow(self, rows: slice, given: Variable) -> None:
        """Write some bodies' rows of a variable; earlier rows of a new variable are NaN."""
        if given.name not in self._datasets:
            self._create(given)
        dataset = self._datasets[given.name]
        dataset.resize(rows.stop, 0)
        dataset[rows] = given.values

    def _create(self, given: Variable) -> None:
        """Create a variable with a row for each body; its chunks are the blocks, which are written whole."""
        dtype = given.values.dtype
        fill = {"fillvalue": np.nan} if dtype.kind == "f" else {}
        chunks = (self._block, *given.values.shape[1:])
        variable = self._file.create_variable(given.name, ("body", *given.dims), dtype, chunks=chunks, **fill)
        variable.attrs.update(given.labels)
        self._datasets[given.name] = self._hdf[given.name]

    def end(self, records: EnsembleRecords | ReducedRecords) -> None:
        """Write failures and the names of methods, after the last body or an interrupt."""
        with self._disk.raising():
            self._end(records)

    def _end(self, records: EnsembleRecords | ReducedRecords) -> None:
        self._file.resize_dimension("body", records.complete)
        if isinstance(records, ReducedRecords):
            for quantiles in records.variables():
                self._write(quantiles)
        self._file.variables["method"].attrs.update(flags(self._methods))
        if records.failures:
            self._file.dimensions["failure"] = len(records.failures)
            numbers, (name, texts, description) = failures(
                [(failure.index[0], failure.message) for failure in records.failures]
            )
            self._write(numbers)
            messages = self._file.create_variable(name, ("failure",), self._text)
            messages[:] = np.array(texts, dtype=object)
            messages.attrs["long_name"] = description
        self._file.attrs["bodies_complete"] = records.complete
