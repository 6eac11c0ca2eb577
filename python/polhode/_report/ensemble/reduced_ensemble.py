"""Reduced outputs of an ensemble in memory: `Scene.reduce`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _native
from polhode._mechanics.arguments import check_progress, checked_threads
from polhode._mechanics.result import Failure
from polhode._report.ensemble.layout import LABELS, Variable
from polhode._report.ensemble.reduced import Reduction, blocks_of, over_bodies
from polhode._report.ensemble.reduced_layout import bytes_of_body, layout_of
from polhode._scene.scene import Scene
from polhode._support import memory
from polhode._support.arrays import Array, frozen
from polhode._support.calls import created_by
from polhode._support.extras import optional

if TYPE_CHECKING:
    import xarray

# Copies of the arrays while they are collected.
_COPIES = 2


@created_by("Scene.reduce")
@dataclass(frozen=True, eq=False)
class ReducedEnsemble(Mapping[str, Array]):
    """Reduced outputs of the bodies of an ensemble: arrays by name, as the variables of its netCDF file.

    Made by `Scene.reduce`. Arrays of bodies have the shape (number, ...); quantiles over the bodies have
    (5, n) for n output times.

    Attributes
    ----------
    time
        Output times in s, (n,).
    failures
        The bodies whose motion could not be computed to the end.
    attributes
        Title, text of the scene, seed and conventions, as in files.

    Examples
    --------
    >>> text = '''
    ... body.moments = [1, 2, 3]
    ... initial.spin = { vector = [0, 0, 1] }
    ... ensemble = { number = 100, spin = { normal = 0.3 } }
    ... run = { duration = 10, samples = 11 }
    ... '''
    >>> with open("spins.toml", "w") as file:
    ...     _ = file.write(text)
    >>> found = ph.Scene.read("spins.toml").reduce(["last", "extrema"])
    >>> found["last_attitude"].shape  # a quaternion for each body
    (100, 4)
    >>> bool((found["rate_min"] <= found["rate_max"]).all())
    True
    """

    time: Array
    failures: tuple[Failure, ...]
    attributes: dict[str, Any]
    _variables: dict[str, Variable] = field(repr=False)

    def __getitem__(self, name: str) -> Array:
        values: Array = self._variables[name].values
        return values

    def __iter__(self) -> Iterator[str]:
        return iter(self._variables)

    def __len__(self) -> int:
        return len(self._variables)

    def __repr__(self) -> str:
        shapes = ", ".join(f"{name} {x.shape}" for name, x in self.items())
        return f"ReducedEnsemble({shapes})"

    def to_xarray(self) -> xarray.Dataset:
        """Return an `xarray.Dataset` with labelled dimensions, units and conventions.

        Raises
        ------
        ImportError
            Without xarray: ``pip install 'polhode[io]'``.

        Examples
        --------
        >>> text = '''
        ... body.moments = [1, 2, 3]
        ... initial.spin = { vector = [0, 0, 1] }
        ... ensemble = { number = 100, spin = { normal = 0.3 } }
        ... run = { duration = 10, samples = 11 }
        ... '''
        >>> with open("spins.toml", "w") as file:
        ...     _ = file.write(text)
        >>> found = ph.Scene.read("spins.toml").reduce(["last"])
        >>> found.to_xarray()["last_attitude"].dims
        ('body', 'quaternion')
        """
        xr = optional("xarray", "io", "labelled data")
        data = {name: (x.dims, np.array(x.values), x.labels) for name, x in self._variables.items()}
        used = {dim for dims, *_ in data.values() for dim in dims}
        labels = {name: list(text) for name, text in LABELS.items() if name in used}
        dataset: xarray.Dataset = xr.Dataset(data, labels, self.attributes).set_coords(
            [name for name in ("time", "level", "body") if name in data]
        )
        return dataset


ReducedEnsemble.__module__ = "polhode"


def reduce(
    self: Scene,
    keep: Sequence[str] | None = None,
    progress: Callable[[int, float], object] | None = None,
    threads: int | None = None,
) -> ReducedEnsemble:
    """Return reduced outputs of the bodies of an ensemble; see `Scene.reduce`."""
    scene = _keeping(self, keep)
    assert scene.ensemble is not None
    check_progress(progress)
    number, wanted = scene.ensemble.number, scene.ensemble.number * bytes_of_body(scene)
    memory.require(_COPIES * wanted, f"reduced outputs of {number} bodies", "keep less, or use a store")
    layout, reduction = layout_of(scene), Reduction(scene)
    counts = _native.BinCounts(len(scene.times))
    arrays: dict[str, Array] = {}
    variables: dict[str, Variable] = {
        "body": Variable("body", ("body",), np.arange(number), "1", "number of the body")
    }
    failures: list[Failure] = []
    for rows, block in blocks_of(reduction, progress, checked_threads(threads)):
        for one in layout.of_bodies(rows, block):
            if one.name not in arrays:
                arrays[one.name] = np.empty((number, *one.values.shape[1:]), one.values.dtype)
                variables[one.name] = replace(one, dims=("body", *one.dims), values=arrays[one.name])
            arrays[one.name][rows] = one.values
        if block.counts is not None:
            counts.merge(block.counts)
        failures += [replace(x, index=(rows.start + x.index[0],)) for x in block.failures]
    shared = [*layout.shared(), *(over_bodies(reduction, counts) if reduction.counting else ())]
    variables |= {one.name: one for one in shared}
    for one in variables.values():
        frozen(np.asarray(one.values))
    return ReducedEnsemble(scene.times, tuple(failures), layout.attributes(), variables)


def _keeping(scene: Scene, keep: Sequence[str] | None) -> Scene:
    """Return the scene with what its ensemble keeps; a ValueError if that is nothing or does not fit."""
    if scene.ensemble is None:
        raise ValueError("this scene has no table [ensemble]; use run")
    known = _native.kept_words()
    if keep is None:
        if not scene.ensemble.keep:
            raise ValueError(f"give keep, some of {', '.join(known)}, here or in the table [ensemble]")
        return scene
    if isinstance(keep, str) or not keep:
        raise ValueError(f"keep must be a sequence of {', '.join(known)}, got {keep!r}")
    for word in keep:
        if word not in known:
            raise ValueError(f"unknown output {word!r} in keep, expected {', '.join(known)}")
    return replace(scene, ensemble=replace(scene.ensemble, keep=tuple(x for x in known if x in keep)))
