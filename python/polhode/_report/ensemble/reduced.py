"""Motions of an ensemble reduced to a few numbers of each body, block by block."""

from __future__ import annotations

import functools
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from polhode import _native
from polhode._mechanics.ensemble import Results, warn_of
from polhode._mechanics.result import Certificate, Failure
from polhode._mechanics.trajectory import Trajectory
from polhode._report.ensemble.collect import (
    ENDS,
    LEVELS,
    NORM,
    PERIODS,
    SERIES,
    tilt_reference,
    watched_axis,
    worst_of,
)
from polhode._report.ensemble.layout import Variable
from polhode._scene.scene import Scene
from polhode._support.arrays import Array
from polhode._support.blocks import Report, in_blocks

# What needs the motion of the nominal body.
_COMPARED = {"extrema", "quantiles", "events"}
# Bytes of a body in a block: its columns and its part of the certificate.
_BYTES = 400
# Bytes of the counts of a column over some powers of 2, of the figures, and of states in memory at a time.
_COUNTS, _FIGURES, _PASSING = 48 << 10, 100 << 20, 128 << 20


@dataclass(frozen=True, eq=False)
class ReducedBlock:
    """Some bodies of an ensemble: numbers of each by name, how they were computed, and their counts.

    Columns: `rotor` (n, 4), `omega_body`, `position`, `velocity` (n, 3) at the last time; `rows` (n, 13), see
    `reduce.rs`; `regime`, a code, and periods of free bodies.
    """

    columns: dict[str, Array]
    certificate: Certificate
    failures: tuple[Failure, ...]
    counts: _native.BinCounts | None
    # What tilt is, in words.
    tilt: str = "tilt"

    def __len__(self) -> int:
        return len(self.columns["rotor"])

    @property
    def ok(self) -> Any:
        """Which bodies did not fail, (n,)."""
        mask = np.ones(len(self), bool)
        mask[[failure.index[0] for failure in self.failures]] = False
        return mask

    def write_counts(self, path: Path) -> None:
        """Write the counts, which there must be: column, bin and count of each filled bin."""
        assert self.counts is not None
        path.write_bytes(np.stack([x.astype("<i4") for x in self.counts.filled()]).tobytes())

    @staticmethod
    def add_counts(path: Path, counts: _native.BinCounts) -> None:
        """Add the counts in a file."""
        columns, bins, numbers = np.frombuffer(path.read_bytes(), "<i4").astype(np.int32).reshape(3, -1)
        counts.add_filled(columns.astype(np.uint32), bins, numbers.astype(np.uint32))


class Reduction:
    """How the motions of a scene's bodies are reduced: what they are compared with, and what is computed.

    That is what the scene keeps; with `nominal`, the motion of the scene's own body, also what the summary
    reports.
    """

    def __init__(self, scene: Scene, nominal: Trajectory | None = None) -> None:
        assert scene.ensemble is not None
        keep = {*scene.ensemble.keep}
        counting = nominal is not None or "quantiles" in keep
        described = nominal is not None or not keep.isdisjoint({"regime", "periods"})
        for word in ("regime", "periods"):
            if word in scene.ensemble.keep and scene.kind != "free":
                raise ValueError(
                    f"{word!r} in keep needs a body without torques; this motion is {scene.kind}"
                )
        self.scene, self.counting = scene, counting
        self._described = described and scene.kind == "free"
        self._watched: tuple[Array, Any, Array] | None = None
        # What tilt is, in words.
        self.tilt = "tilt"
        if counting or not _COMPARED.isdisjoint(keep):
            nominal = nominal_motion(scene) if nominal is None else nominal
            axis, axis_name = watched_axis(scene, nominal)
            upright, origin = tilt_reference(scene, nominal)
            self.tilt = f"tilt of {axis_name} from {origin}"
            self._watched = (
                np.ascontiguousarray(nominal.rotor._data),
                axis.tolist(),
                np.ascontiguousarray(np.zeros((0, 3)) if upright is None else upright),
            )

    def block(self, rows: slice, progress: Report | None, threads: int | None) -> ReducedBlock:
        """Return some bodies, of which a few at a time have all their states in memory."""
        scene = self.scene
        counts = _native.BinCounts(len(scene.times)) if self.counting else None
        found, size = [], scene.block_of_motions
        for some, report in in_blocks(rows, size, progress):
            found.append(self._few(some, counts, report, threads))
            if report is not None:
                report(1, 1.0)
        columns = {name: np.concatenate([part[0][name] for part in found]) for name in found[0][0]}
        failures = [
            Failure((first * size + failure.index[0],), failure.time, failure.message)
            for first, part in enumerate(found)
            for failure in part[2]
        ]
        certificate = _joined([part[1] for part in found], [len(part[0]["rotor"]) for part in found])
        warn_of(certificate)
        return ReducedBlock(columns, certificate, tuple(failures), counts, self.tilt)

    def _few(
        self, rows: slice, counts: _native.BinCounts | None, progress: Report | None, threads: int | None
    ) -> tuple[dict[str, Array], Certificate, tuple[Failure, ...]]:
        scene, n = self.scene, rows.stop - rows.start
        columns = scene._core.reduce_many(
            rows.start, n, scene.times, self._watched, self._described, counts, threads, progress
        )
        summary, centers = columns.pop("summary"), columns.pop("centers")
        if "position" not in columns:
            # Without forces, a straight line.
            columns["position"] = centers[:, :3] + centers[:, 3:] * scene.elapsed[-1]
            columns["velocity"] = np.where(np.isfinite(columns["rotor"][:, :1]), centers[:, 3:], np.nan)
        none = np.zeros(0)
        results = Results((n,), none, none, none, none, scene.times, scene.method)
        return columns, results._certificate(summary), results._failures(summary)


@functools.lru_cache(maxsize=4)
def reduction_of(scene: Scene) -> Reduction:
    """Return the reduction of a scene to what it keeps; of the last scenes the same one."""
    return Reduction(scene)


def nominal_motion(scene: Scene) -> Trajectory:
    """Return the motion of the nominal body."""
    try:
        return scene.alone().run()
    except ValueError as error:
        raise ValueError(f"the nominal body failed: {error}") from error


def _joined(parts: list[Certificate], sizes: list[int]) -> Certificate:
    """Return the certificate of all bodies of some parts."""
    if len(parts) == 1:
        return parts[0]

    def column(each: list[Any]) -> Array:
        return np.concatenate([np.broadcast_to(x, size) for x, size in zip(each, sizes, strict=True)])

    def columns(each: list[dict[str, Array]]) -> dict[str, Array]:
        names = dict.fromkeys(name for one in each for name in one)
        return {name: column([one.get(name, np.nan) for one in each]) for name in names}

    methods = [part.method for part in parts]
    same = all(isinstance(method, str) and method == methods[0] for method in methods)
    numbers = ("step", "steps", "evaluations", "error_estimate", "norm_drift")
    return Certificate(
        method=methods[0] if same else column(methods),
        conserved=columns([part.conserved for part in parts]),
        drift=columns([part.drift for part in parts]),
        warnings=tuple(dict.fromkeys(text for part in parts for text in part.warnings)),
        **{name: column([getattr(part, name) for part in parts]) for name in numbers},
    )


class ReducedRecords:
    """What the summary reports of an ensemble whose motions are not kept; as `EnsembleRecords`.

    Quantiles follow from counts in bins, so they have a relative error of up to `resolution`.
    """

    resolution = _native.BinCounts.width

    def __init__(self, scene: Scene, nominal: Trajectory) -> None:
        assert scene.ensemble is not None
        self.scene, self.nominal = scene, nominal
        self.axis, self.axis_name = watched_axis(scene, nominal)
        self.tilt_name = tilt_reference(scene, nominal)[1]
        self.complete, self.total_steps = 0, 0
        self.error_estimate: float | None = None
        self.regimes: Counter[str] = Counter()
        self.methods: Counter[str] = Counter()
        self.failures: list[Failure] = []
        self._reduction = Reduction(scene, nominal)
        self._counts = _native.BinCounts(len(scene.times))
        self._worst: dict[str, dict[str, Any]] = {}
        self._names = _native.regimes()

    @staticmethod
    def bytes_wanted(scene: Scene) -> int:
        """Return the memory of a run in bytes: the current block, and the counts of all bodies."""
        return _FIGURES + _PASSING + _BYTES * scene.block + 2 * len(SERIES) * len(scene.times) * _COUNTS

    def blocks(self, progress: Report | None, threads: int | None) -> Iterator[tuple[slice, ReducedBlock]]:
        """Yield the bodies in blocks, for `add`."""
        return blocks_of(self._reduction, progress, threads)

    def add(self, rows: slice, block: ReducedBlock) -> None:
        """Record the next bodies."""
        assert block.counts is not None
        self._counts.merge(block.counts)
        proof = block.certificate
        self.methods.update(_counted(np.broadcast_to(proof.method, len(block))[block.ok]))
        if "regime" in block.columns:
            codes, counts = np.unique(block.columns["regime"], return_counts=True)
            pairs = zip(codes.tolist(), counts.tolist(), strict=True)
            self.regimes.update({self._names[code]: count for code, count in pairs if code >= 0})
        self.total_steps += int(proof.steps.sum())
        estimates = proof.error_estimate[~np.isnan(proof.error_estimate)]
        if estimates.size:
            self.error_estimate = max(float(estimates.max()), self.error_estimate or 0.0)
        for name, drift in {**proof.drift, NORM: proof.norm_drift}.items():
            if name != NORM:
                drift = np.where(np.isnan(proof.conserved[name]), np.nan, drift)
            self._record_drift(name, worst_of(drift), rows.start)
        self.failures += [
            Failure((rows.start + failure.index[0],), failure.time, failure.message)
            for failure in block.failures
        ]
        self.complete = rows.stop

    def _record_drift(self, name: str, found: dict[str, Any], first: int) -> None:
        known = self._worst.setdefault(name, {"bodies": 0, "worst": None, "body": None})
        known["bodies"] += found["bodies"]
        if found["bodies"] and (known["worst"] is None or found["worst"] > known["worst"]):
            known |= {"worst": found["worst"], "body": first + found["body"]}

    def worst(self) -> dict[str, dict[str, Any]]:
        """Return the largest drift of each quantity, and of the norm of the rotor, with its body."""
        return self._worst or {NORM: {"bodies": 0, "worst": None, "body": None}}

    def quantiles(self, name: str, k: int | None = None) -> Array:
        """Return the quantiles (5, ...) at `LEVELS` of a series, at one or all times, or of a number."""
        found = self._found(self.complete)[name]
        return found if k is None else found[:, k]

    @functools.lru_cache(maxsize=1)  # noqa: B019, one for each run
    def _found(self, complete: int) -> dict[str, Array]:
        return _quantiles(self._counts, len(self.scene.times))

    def variables(self) -> Iterator[Variable]:
        """Yield the variables over all bodies of the file, those that the scene keeps."""
        assert self.scene.ensemble is not None
        if "quantiles" in self.scene.ensemble.keep:
            yield from over_bodies(self._reduction, self._counts)


def blocks_of(
    reduction: Reduction, progress: Report | None, threads: int | None
) -> Iterator[tuple[slice, ReducedBlock]]:
    """Yield all bodies of an ensemble in blocks."""
    scene = reduction.scene
    assert scene.ensemble is not None
    for rows, report in in_blocks(slice(0, scene.ensemble.number), scene.block, progress):
        yield rows, reduction.block(rows, report, threads)


def over_bodies(reduction: Reduction, counts: _native.BinCounts) -> Iterator[Variable]:
    """Yield the quantiles over the bodies of counts."""
    found = _quantiles(counts, len(reduction.scene.times))
    note = {"relative_resolution": ReducedRecords.resolution}
    texts = {
        "from_nominal": ("rad", "angle between the attitude and that of the nominal body"),
        "tilt": ("rad", reduction.tilt),
        "rate": ("rad/s", "angular velocity |Omega|"),
    }
    for name, (units, text) in texts.items():
        label = f"quantiles over the bodies: {text}"
        yield Variable(f"{name}_quantiles", ("level", "time"), found[name], units, label, note)


def _quantiles(counts: _native.BinCounts, n: int) -> dict[str, Array]:
    """Return the quantiles (5, ...) of all that is counted, by name."""
    series, periods = (rows.T for rows in counts.quantiles(list(LEVELS)))
    found = {name: series[:, k * n : (k + 1) * n] for k, name in enumerate(SERIES)}
    ends = [f"{name}_{end}" for name in ENDS for end in ("start", "end")]
    found |= {name: series[:, len(SERIES) * n + k] for k, name in enumerate(ends)}
    return found | {name: periods[:, k] for k, name in enumerate(PERIODS)}


def _counted(names: Array) -> dict[str, int]:
    found, counts = np.unique(names.astype(str), return_counts=True)
    return dict(zip(found.tolist(), counts.tolist(), strict=True))
