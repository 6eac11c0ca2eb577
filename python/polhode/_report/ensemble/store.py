"""Zarr store of an ensemble, written in blocks of bodies that are checksummed and then marked done."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
import tempfile
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from polhode import _native
from polhode._mechanics.arguments import METHODS
from polhode._mechanics.trajectory import Trajectory
from polhode._report.ensemble.arrays import (
    META,
    chunk_of,
    metadata_of,
    new_array,
    new_group,
    write_chunk,
    write_labels,
    zarr,
)
from polhode._report.ensemble.layout import LABELS, Variable, failures, flags
from polhode._report.ensemble.reduced import ReducedBlock
from polhode._report.ensemble.reduced_layout import layout_of
from polhode._scene.scene import Scene
from polhode._support.arrays import Array
from polhode._support.checksums import checksum, digests, seal, sealed
from polhode._support.locks import Lock, held, locked

# Folder of the store for what is not data; it is an empty Zarr group, so that readers do not stumble on it.
OWN = ".polhode"
_GROUP = {"zarr_format": 3, "node_type": "group"}
# Names of the codes -1, 0, 1, ... of methods: they must not depend on the order of blocks.
_METHODS = ["none", *METHODS[1:]]
# What must agree to continue a store, in words.
_IDENTITY = {
    "version": "version of polhode",
    "scene": "scene",
    "seed": "seed",
    "number": "number of bodies",
    "times": "output times",
    "body": "body, such as its mesh",
    "table": "table of bodies",
    "block": "size of a block",
    "keep": "list of what to keep",
}


class StoreError(ValueError):
    """A store cannot be used for a run."""


class OtherRunError(StoreError):
    """A store was begun by another run."""


def _not_a_store(path: Path, error: Exception) -> str:
    """Return why a path could not be opened as a store."""
    if not path.is_dir():
        return "is a file, and the store of an ensemble is a folder FILE.zarr"
    if isinstance(error, FileNotFoundError):
        return f"is not a store of an ensemble that polhode wrote: it has no file {OWN}/run.json"
    if isinstance(error, OSError):
        return f"cannot be read: {(error.strerror or str(error)).lower()}"
    return f"is not a store of an ensemble that polhode wrote: {error}"


class EnsembleStore:
    """The Zarr store of an ensemble at a path; see `create` and `open`.

    Arrays have the layout of `EnsembleLayout`, with chunks of `block` bodies. A block is written to a folder
    of its own; then its files are renamed into their arrays; last its mark, which has the checksums of the
    files and of the metadata of the arrays. Bytes do not depend on the order of blocks, so a block may be
    written again at any time.
    """

    def __init__(self, path: Path, identity: dict[str, Any]) -> None:
        self.path, self.identity = path, identity
        self.number, self.block = int(identity["number"]), int(identity["block"])
        self.blocks = -(-self.number // self.block)
        self.drift_bound = float(identity["drift_bound"])
        # The checksums of the metadata that this process has written or found right, by array.
        self._described: dict[str, str] = {}

    @staticmethod
    def exists(path: Path) -> bool:
        """Whether there is a store at a path."""
        return (path / OWN / "run.json").is_file()

    @staticmethod
    def open(path: Path) -> EnsembleStore:
        """Return the store at a path.

        Raises
        ------
        StoreError, FileNotFoundError
            If there is none.
        """
        if not path.exists():
            raise FileNotFoundError(f"{path}: no such store")
        try:
            return EnsembleStore(path, sealed(path / OWN / "run.json"))
        except (OSError, ValueError, KeyError) as error:
            raise StoreError(f"{path}: {_not_a_store(path, error)}") from None

    @staticmethod
    def create(path: Path, scene: Scene) -> EnsembleStore:
        """Return a new store without bodies; one that another process creates meanwhile is as good."""
        zarr()
        target = path.parent.resolve() / path.name
        with tempfile.TemporaryDirectory(
            prefix=f".{path.name}.", suffix=".part", dir=target.parent
        ) as folder:
            part = Path(folder) / "store"
            _write_shared(part, scene)
            for name in ("blocks", "locks", "parts"):
                (part / OWN / name).mkdir(parents=True)
            (part / OWN / META).write_text(json.dumps(_GROUP | {"attributes": {}}))
            identity = identity_of(scene)
            seal(part / OWN / "run.json", identity | {"files": digests(part, _files(part, own=False))})
            store = EnsembleStore(part, identity)
            store.consolidate()
            try:
                os.rename(part, target)
            except OSError:
                if not EnsembleStore.exists(path):
                    raise
        store = EnsembleStore.open(path)
        store.require(scene)
        return store

    def require(self, scene: Scene) -> None:
        """Raise an OtherRunError if another scene, or another version, has begun the store."""
        for name, value in identity_of(scene).items():
            if name in _IDENTITY and self.identity.get(name) != value:
                shown = name in ("version", "seed", "number", "block")
                values = f": {self.identity.get(name)}, here {value}" if shown else ""
                raise OtherRunError(
                    f"{self.path} was begun with another {_IDENTITY[name]}{values}; "
                    "continue it as it was begun, or choose another store"
                )

    def rows(self, index: int) -> slice:
        """Return the bodies of a block."""
        return slice(index * self.block, min((index + 1) * self.block, self.number))

    def blocks_of(self, bodies: tuple[int, int] | None) -> range:
        """Return the blocks that begin in a range of bodies, so that disjoint ranges have disjoint blocks."""
        first, end = bodies or (0, self.number)
        return range(-(-first // self.block), -(-end // self.block))

    @contextlib.contextmanager
    def locked(self, blocks: range) -> Iterator[None]:
        """Hold blocks during a run; see `polhode._support.locks.locked`."""
        folder, ends = self.path / OWN / "locks", (blocks.start * self.block, blocks.stop * self.block)
        with locked(folder, ends[0], min(ends[1], self.number), str(self.path)):
            if len(list(held(folder))) == 1:
                for part in (self.path / OWN / "parts").iterdir():
                    shutil.rmtree(part, ignore_errors=True)  # of processes that were killed
            yield

    def users(self) -> list[Lock]:
        """Return the locks of the processes that compute bodies."""
        return [lock for _, lock in held(self.path / OWN / "locks")]

    # --- blocks

    def state(self, index: int) -> str:
        """Return whether a block is done, missing, or corrupt: a file does not have its checksum."""
        mark = self._mark(index)
        if not mark.exists():
            return "missing"
        try:
            found = sealed(mark)
            right = digests(self.path, found["files"]) == found["files"]
        except (OSError, ValueError, KeyError, TypeError):
            return "corrupt"
        return "done" if right else "corrupt"

    def marks(self, blocks: Iterable[int] | None = None) -> Iterator[dict[str, Any]]:
        """Yield the contents of the marks of blocks, in order: bodies, failures, methods, drifts."""
        for index in range(self.blocks) if blocks is None else blocks:
            with contextlib.suppress(OSError, ValueError):
                yield sealed(self._mark(index))

    def write(self, index: int, scene: Scene, trajectory: Trajectory | ReducedBlock) -> None:
        """Write a block and mark it done."""
        rows = self.rows(index)
        method = Variable("method", (), _codes(trajectory), "1", "method", flags(_METHODS, -1))
        variables = (method, *layout_of(scene).of_bodies(rows, trajectory))
        with self._part() as part:
            found = {
                chunk_of(variable, index): write_chunk(f"{part}/{variable.name}", self.block, variable.values)
                for variable in variables
            }
            new = [variable for variable in variables if variable.name not in self._described]
            for variable in new:
                self._describe(part, variable)
            for chunk in list(found):
                name = chunk.partition("/")[0]
                os.replace(f"{part}/{name}", f"{self.path}/{chunk}")
                found[f"{name}/{META}"] = self._described[name]
            if isinstance(trajectory, ReducedBlock) and trajectory.counts is not None:
                counts = self.counts_of(index)
                trajectory.write_counts(part / counts.name)
                found[counts.relative_to(self.path).as_posix()] = digests(part, [counts.name])[counts.name]
                counts.parent.mkdir(exist_ok=True)
                os.replace(part / counts.name, counts)
            self._publish_mark(part, index, {"files": found, **_outcome(rows, trajectory)})
        if new:  # others are the same in all blocks
            self.consolidate()

    def _describe(self, part: Path, variable: Variable) -> None:
        """Write the metadata of the array of a variable, unless they are right."""
        folder, content = self.path / variable.name, metadata_of(variable, self.number, self.block)
        folder.mkdir(exist_ok=True)
        if not (folder / META).exists() or (folder / META).read_bytes() != content:
            (part / META).write_bytes(content)
            os.replace(part / META, folder / META)
        self._described[variable.name] = checksum([content])

    def counts_of(self, index: int) -> Path:
        """Return the file of the counts of a block, from which the quantiles over all bodies follow."""
        return self.path / OWN / "counts" / self._mark(index).stem

    def finish(self, shared: Callable[[], Iterable[Variable]] = tuple) -> bool:
        """Write the failures and the number of complete bodies if all blocks are done; return whether so.

        `shared` yields variables that follow from all blocks.
        """
        marks = list(self.marks())
        if len(marks) < self.blocks:
            return False
        found = [(body, message) for mark in marks for body, _, message in mark["failures"]]
        with self._part() as part:
            with new_group(part) as group:
                if found:
                    numbers, (name, texts, description) = failures(found)
                    shape = numbers.values.shape
                    new_array(group, numbers, shape, shape, ("failure",))[:] = numbers.values
                    write_labels(group, name, texts, "failure", {"long_name": description})
                for over in shared():
                    new_array(group, over, over.values.shape, over.values.shape, over.dims)[...] = over.values
            self._publish(part, _files(part))
        self.consolidate({"bodies_complete": self.number})
        return True

    @property
    def shares(self) -> bool:
        """Whether the variables that all bodies share have their checksums."""
        files = self.identity["files"]
        return bool(digests(self.path, files) == files)

    def mend(self, scene: Scene) -> None:
        """Write variables that all bodies share again if their files are corrupt."""
        if not self.shares:
            with self._part() as part:
                _write_shared(part, scene)
                self._publish(part, list(self.identity["files"]))
            self.consolidate()

    def consolidate(self, more: dict[str, Any] | None = None) -> None:
        """Write the metadata of all arrays into that of the store, if they or its attributes changed.

        Processes that add an array at the same time may miss that of the other until the last block is done.
        """
        path = self.path / META
        arrays = {}
        for file in sorted(self.path.glob(f"*/{META}")):
            with contextlib.suppress(ValueError):  # damaged: its blocks are written again
                arrays[file.parent.name] = json.loads(file.read_bytes())
        arrays.pop(OWN, None)
        inline = {"kind": "inline", "must_understand": False, "metadata": arrays}
        attributes = self.identity["attributes"] | (more or {})
        text = json.dumps(_GROUP | {"attributes": attributes, "consolidated_metadata": inline})
        if not path.exists() or path.read_bytes() != text.encode():
            with self._part() as part:
                (part / META).write_text(text)
                os.replace(part / META, path)

    def _mark(self, index: int) -> Path:
        return self.path / OWN / "blocks" / f"{index:0{len(str(self.blocks - 1))}d}.json"

    def _publish_mark(self, part: Path, index: int, content: dict[str, Any]) -> None:
        seal(part / "mark.json", content)
        os.replace(part / "mark.json", self._mark(index))

    @contextlib.contextmanager
    def _part(self) -> Iterator[Path]:
        """Yield a new folder on the disk of the store, removed at the end."""
        with tempfile.TemporaryDirectory(dir=self.path / OWN / "parts", ignore_cleanup_errors=True) as folder:
            yield Path(folder)

    def _publish(self, part: Path, files: list[str]) -> None:
        """Rename files of a folder to those of the store."""
        for name in files:
            target = self.path / name
            target.parent.mkdir(parents=True, exist_ok=True)
            os.replace(part / name, target)


def identity_of(scene: Scene) -> dict[str, Any]:
    """Return what determines the content of a scene's store, and its attributes."""
    ensemble = scene.ensemble
    assert ensemble is not None
    body = hashlib.sha256(np.ascontiguousarray(scene.body.inertia.matrix).tobytes())
    body.update(np.array([scene.body.mass, *scene.shift]).tobytes())
    attributes = layout_of(scene).attributes()
    table = {} if ensemble.table_sha256 is None else {"table": ensemble.table_sha256}
    return {
        **table,
        "version": _native.__version__,
        "scene": scene.text,
        "seed": ensemble.seed,
        "number": ensemble.number,
        "times": hashlib.sha256(np.ascontiguousarray(scene.times).tobytes()).hexdigest(),
        "body": body.hexdigest(),
        "block": scene.block,
        "keep": list(ensemble.keep),
        "drift_bound": scene.drift_bound,
        "attributes": attributes | {"seed": ensemble.seed},
    }


def _write_shared(part: Path, scene: Scene) -> None:
    """Write the variables that all bodies share, labels and numbers of bodies included."""
    assert scene.ensemble is not None
    numbers = np.arange(scene.ensemble.number)
    body = Variable("body", ("body",), numbers, "1", "number of the body")
    with new_group(part) as group:
        for name, labels in LABELS.items():
            write_labels(group, name, list(labels), name, {})
        for shared in (body, *layout_of(scene).shared()):
            values = np.asarray(shared.values)
            new_array(group, shared, values.shape, values.shape, shared.dims)[...] = values


def _codes(trajectory: Trajectory | ReducedBlock) -> Array:
    """Return the code of each body's method; -1 for failed ones."""
    names, which = np.unique(np.asarray(trajectory.certificate.method, str), return_inverse=True)
    codes = np.array([_METHODS.index(name) - 1 for name in names], np.int8)
    return np.where(trajectory.ok, codes[which], np.int8(-1))


def _outcome(rows: slice, trajectory: Trajectory | ReducedBlock) -> dict[str, Any]:
    """Return the outcome of a block: failures, number of bodies by method, and largest drifts."""
    proof = trajectory.certificate
    codes, counts = np.unique(_codes(trajectory), return_counts=True)
    methods = {_METHODS[code + 1]: int(count) for code, count in zip(codes, counts, strict=True)}
    drifts = {"rotor_norm": proof.norm_drift}
    drifts |= {name: np.where(np.isnan(proof.conserved[name]), np.nan, x) for name, x in proof.drift.items()}
    worst = {}
    for name, drift in drifts.items():
        if np.isfinite(drift).any():
            body = int(np.nanargmax(drift))
            worst[name] = [float(drift[body]), rows.start + body]
    return {
        "bodies": [rows.start, rows.stop],
        "failures": [[rows.start + f.index[0], f.time, f.message] for f in trajectory.failures],
        "methods": dict(sorted(methods.items())),
        "worst": worst,
    }


def _files(folder: Path, own: bool = True) -> list[str]:
    """Return the files of the arrays in a folder, relative to it."""
    files = (path for path in sorted(folder.rglob("*")) if path.is_file() and path.parent != folder)
    names = [path.relative_to(folder).as_posix() for path in files]
    return [name for name in names if own or not name.startswith(f"{OWN}/")]
