"""NetCDF file of an ensemble, written block by block."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from polhode._mechanics.trajectory import Trajectory
from polhode._report.ensemble.collect import EnsembleRecords
from polhode._report.ensemble.layout import LABELS, EnsembleLayout, Variable, failures, flags
from polhode._scene.scene import Scene
from polhode._support.extras import optional

# Bytes of a chunk, the unit of reading and writing.
_CHUNK = 1 << 20


def bytes_of_file(scene: Scene) -> int:
    """Return the approximate size in bytes of the file of a scene's ensemble."""
    assert scene.ensemble is not None
    numbers = 4 + 3 + (scene.kind != "free") + 6 * (scene.force is not None)
    return scene.ensemble.number * 8 * (numbers * len(scene.times) + 30)


class EnsembleFile:
    """A netCDF file with a dimension `body` that grows; its layout is `EnsembleLayout`."""

    def __init__(self, path: Path, scene: Scene) -> None:
        assert scene.ensemble is not None
        self._layout, self._number = EnsembleLayout(scene), scene.ensemble.number
        self._file = optional("h5netcdf", "io", "a netCDF file").File(path, "w")
        self._text = optional("h5py", "io", "a netCDF file").string_dtype()
        self._methods: list[str] = []
        self._begin(len(scene.times))

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _begin(self, times: int) -> None:
        """Write dimensions, coordinates and attributes."""
        sizes = {name: len(labels) for name, labels in LABELS.items()}
        self._file.dimensions = {"time": times, **sizes, "body": None}
        for name, labels in LABELS.items():
            variable = self._file.create_variable(name, (name,), self._text)
            variable[:] = np.array(list(labels), dtype=object)
        for shared in self._layout.shared():
            self._write(shared)
        self._file.attrs.update(self._layout.attributes())

    def _write(self, given: Variable) -> None:
        """Write a variable of fixed size."""
        variable = self._file.create_variable(given.name, given.dims, np.asarray(given.values).dtype)
        variable[...] = given.values
        variable.attrs.update(given.labels)

    def add(self, rows: slice, trajectory: Trajectory) -> None:
        """Write the next bodies."""
        self._file.resize_dimension("body", rows.stop)
        numbers = np.arange(rows.start, rows.stop)
        self._grow(rows, Variable("body", (), numbers, "1", "number of the body"))
        self._grow(rows, Variable("method", (), self._codes(trajectory), "1", "method"))
        for variable in self._layout.of_bodies(rows, trajectory):
            self._grow(rows, variable)

    def _codes(self, trajectory: Trajectory) -> Any:
        """Return the number of each body's method in the list of all so far."""
        names = np.broadcast_to(trajectory.certificate.method, len(trajectory)).tolist()
        self._methods += sorted({*names} - {*self._methods})
        return np.array([self._methods.index(name) for name in names], np.int8)

    def _grow(self, rows: slice, given: Variable) -> None:
        """Write some bodies' rows of a variable; earlier rows of a new variable are NaN."""
        variable = self._file.variables.get(given.name)
        if variable is None:
            dtype = given.values.dtype
            shape = [self._file.dimensions[dim].size for dim in given.dims]
            size = int(np.prod(shape, initial=dtype.itemsize))
            chunk = max(1, min(_CHUNK // max(size, 1), self._number))
            fill = {"fillvalue": np.nan} if dtype.kind == "f" else {}
            variable = self._file.create_variable(
                given.name, ("body", *given.dims), dtype, chunks=(chunk, *shape), **fill
            )
            variable.attrs.update(given.labels)
        variable[rows] = given.values

    def end(self, records: EnsembleRecords) -> None:
        """Write failures and the names of methods, after the last body or an interrupt."""
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
