"""Scenes: body, start, torques and output times from a TOML file."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from polhode import _native
from polhode import force as forces
from polhode._algebra.rotor import Rotor
from polhode._mechanics.arguments import check_progress, checked_threads
from polhode._mechanics.bodies import Body
from polhode._mechanics.ensemble import Results, require, warn_of
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.state import State
from polhode._mechanics.trajectory import Trajectory
from polhode._scene.ensemble import EnsembleSpec
from polhode._scene.table import TableReader
from polhode._support.arrays import Array, as_count, frozen, hands_out_copies
from polhode._support.blocks import Report, in_blocks
from polhode._support.calls import created_by
from polhode._support.file_kinds import EXAMPLES
from polhode._support.files import is_endless, printable_stem
from polhode._support.foreign_names import ListsOwnNames, with_foreign_names
from polhode.force import Force
from polhode.torque import Torque

if TYPE_CHECKING:
    import xarray

    from polhode import _outputs

DRIFT_BOUND = 1e-8

# Bytes of results in a block of bodies; number of blocks, so that an interrupted run keeps most of its
# bodies; and least number of bodies in a block, so that lanes and threads are busy.
_BLOCK, _BLOCKS, _FEW = 32 << 20, 64, 512
# Most bodies in a block of reduced outputs, which have no states at the output times.
_REDUCED = 1 << 17


SceneError = _native.SceneError
SceneError.__doc__ = """All errors in a scene file, with their lines, columns and source lines; a ValueError.

Examples
--------
>>> text = '''
... body.moments = [1, 2, 3]
... initial.spin = { vector = [0, 1, "2 m/s"] }
... run.duration = "10 s"
... '''
>>> with open("spin.toml", "w") as file:
...     _ = file.write(text)
>>> try:
...     ph.Scene.read("spin.toml")
... except ph.SceneError as error:
...     print(str(error).splitlines()[0])  # the next ones show the place
spin.toml:3:34: error: expected an angular rate such as `5 rev/s`, found a speed (`2 m/s`)
"""


class SceneNotFoundError(SceneError, FileNotFoundError):
    """A scene file that does not exist."""


@with_foreign_names({**dict.fromkeys(("load", "open", "from_file"), "Scene.read(path)"), "simulate": "run()"})
@created_by("ph.Scene.read(path)")
@hands_out_copies("shift", "times")
@dataclass(frozen=True, eq=False)
class Scene(metaclass=ListsOwnNames):
    """A scene file in SI units, ready to run; see `Scene.read`.

    `dataclasses.replace` accepts `path`, `times` and `ensemble`; the other attributes follow from the file.

    Attributes
    ----------
    path, text, title, caption
        The file, its content, its title and its caption; None without them.
    body
        The body; with gravity in axes whose origin is the fixed point.
    has_mass
        False if the file gives an inertia only; the body then has 1 kg, which does not affect the motion.
    solid
        Kind and sizes in m of the solid in the file, named as there; None without.
    shift
        Origin of the file's axes in those of the body, (3,), in m: 0 without a pivot.
    state
        The state at the start.
    torque
        The torque, gravity first and then as in the file; None without.
    formulas
        For each law of `torque` its formula as in the file, or None.
    force
        The force on the centre of mass; None without.
    times
        Output times in s.
    method, step, rtol, atol, max_step, max_steps
        As for `polhode.simulate`; step and tolerances may be None.
    drift_bound
        Largest relative drift of a conserved quantity that counts as success.
    ensemble
        The table `[ensemble]`; None without.

    Examples
    --------
    A box that is thrown about its middle axis:

    >>> text = '''
    ... [body]
    ... solid = "box"
    ... lengths = ["20 cm", "12 cm", "4 cm"]
    ... mass = "1 kg"
    ...
    ... [initial]
    ... spin = { vector = ["0.01 rev/s", "2 rev/s", 0] }
    ...
    ... [run]
    ... duration = "3 s"
    ... samples = 301
    ... '''
    >>> with open("box.toml", "w") as file:
    ...     _ = file.write(text)
    >>> scene = ph.Scene.read("box.toml")
    >>> scene.kind, len(scene.times)
    ('free', 301)
    >>> motion = scene.run()
    >>> print(f"{motion.omega_body['e31'].min() / (2 * np.pi):.2f} rev/s")  # it turns over
    -2.00 rev/s
    """

    path: Path
    times: Array
    ensemble: EnsembleSpec | None
    _core: _native.Scene = field(repr=False)
    text: str = field(init=False, repr=False)
    title: str | None = field(init=False)
    caption: str | None = field(init=False)
    body: Body = field(init=False)
    has_mass: bool = field(init=False)
    solid: dict[str, Any] | None = field(init=False)
    shift: Array = field(init=False)
    state: State = field(init=False)
    torque: Torque | None = field(init=False)
    formulas: tuple[str | None, ...] = field(init=False)
    force: Force | None = field(init=False)
    method: str = field(init=False)
    step: float | None = field(init=False)
    rtol: float | None = field(init=False)
    atol: float | None = field(init=False)
    max_step: float | None = field(init=False)
    max_steps: float | None = field(init=False)
    drift_bound: float = field(init=False)

    @staticmethod
    def read(path: str | os.PathLike[str]) -> Scene:
        """Read a scene file, and the mesh and the table of bodies that it names.

        Raises
        ------
        SceneError
            A ValueError that reports every error in the file with its line, column and source line.
        FileNotFoundError
            If there is no such file; it is a SceneError too.

        Examples
        --------
        >>> text = '''
        ... body = { solid = "sphere", radius = "10 cm", mass = "5 kg" }
        ... initial.spin = { plane = "e1e2", rate = "1 rev/s" }
        ... run.duration = "10 s"
        ... '''
        >>> with open("ball.toml", "w") as file:
        ...     _ = file.write(text)
        >>> scene = ph.Scene.read("ball.toml")
        >>> scene.body.inertia  # 2/5 m r²
        Inertia(principal moments 0.02, 0.02, 0.02 kg m²)
        >>> scene.state.omega_body / (2 * np.pi)
        e1∧e2
        """
        if is_endless(path):
            raise SceneError(f"{os.fsdecode(path)}: error: not a regular file; give the path of a scene file")
        table = TableReader()
        try:
            core = _native.Scene.read(os.fspath(path), table.read)
        except SceneError as error:
            if os.path.lexists(path):
                raise
            raise SceneNotFoundError(f"{error}{_found_instead(os.fsdecode(path))}") from None
        return Scene(Path(path), core.fields()["times"], EnsembleSpec._of(core, table.sha256), core)

    def __post_init__(self) -> None:
        given = self._core.fields()
        rotor, center = Rotor._from_rows(given["rotor"]), (given["position"], given["velocity"])
        given |= {
            "body": Body._of(given["body"]),
            "shift": frozen(given["shift"]),
            "state": State(rotor, given["omega_body"], *center, time=given["time"]),
            "torque": Torque(tuple(given["laws"])) if given["laws"] else None,
            "formulas": tuple(given["formulas"]),
            "force": _sum_of(given["forces"]),
            "drift_bound": given["drift_bound"] or DRIFT_BOUND,
            "times": frozen(np.asarray(self.times, float)),
        }
        # `dataclasses.replace` rejects the fields that the file alone determines.
        for name in (*(own.name for own in fields(self) if not own.init), "times"):
            self.__dict__[name] = given[name]

    def surface(self) -> tuple[Array, Array] | None:
        """Return the surface of the mesh or the solid in the file, as the page draws it.

        Vertices (n, 3) in body axes in m, and triangles (m, 3), counter-clockwise seen from outside. A round
        solid has 64 faces about its axis, with vertices on the solid; a rod and a disc are given a thickness.
        None for a body known by its moments.

        Examples
        --------
        >>> text = '''
        ... body = { solid = "sphere", radius = "10 cm", mass = "5 kg" }
        ... initial.spin = { plane = "e1e2", rate = "1 rad/s" }
        ... run = { duration = "2 s", samples = 3 }
        ... '''
        >>> with open("ball.toml", "w") as file:
        ...     _ = file.write(text)
        >>> vertices, triangles = ph.Scene.read("ball.toml").surface()
        >>> float(np.linalg.norm(vertices, axis=1).max().round(9))
        0.1
        """
        surface = self._core.surface(os.fspath(self.path))
        return None if surface is None else (surface[0], np.array(surface[1], int))

    @property
    def result_bytes(self) -> int:
        """Bytes of the states of all bodies at all times: rotors, Ω, L and energies."""
        numbers = 4 + 3 + 3 + 1
        return (1 if self.ensemble is None else self.ensemble.number) * len(self.times) * numbers * 8

    @property
    def elapsed(self) -> Array:
        """Output times since the start, in s."""
        return self.times - self.state.time

    @property
    def held(self) -> bool:
        """Whether the body is held at a fixed point, the origin of its axes."""
        return self.torque is not None and self.torque.holds

    @property
    def name(self) -> str:
        """The title, or the name of the file if there is none."""
        return self.title or printable_stem(self.path)

    def alone(self) -> Scene:
        """Return the scene of the nominal body, without the ensemble.

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
        >>> ph.Scene.read("spins.toml").alone().run().shape
        ()
        """
        return replace(self, ensemble=None)

    @property
    def kind(self) -> str:
        """The kind of motion, by the torques: free, heavy, gyrostat, damped, satellite or torqued."""
        return self._core.kind

    @overload
    def run(
        self,
        progress: Callable[[int, float], object] | None = ...,
        threads: int | None = ...,
        *,
        store: None = ...,
    ) -> Trajectory: ...

    @overload
    def run(
        self,
        progress: Callable[[int, float], object] | None = ...,
        threads: int | None = ...,
        *,
        store: str | os.PathLike[str],
        resume: bool = ...,
        bodies: tuple[int, int] | None = ...,
        cluster: str | None = ...,
    ) -> xarray.Dataset: ...

    def run(
        self,
        progress: Callable[[int, float], object] | None = None,
        threads: int | None = None,
        *,
        store: str | os.PathLike[str] | None = None,
        resume: bool = False,
        bodies: tuple[int, int] | None = None,
        cluster: str | None = None,
    ) -> Trajectory | xarray.Dataset:
        """Return the motion at the output times, or those of all bodies of an ensemble, a batch (number,).

        With `store` the motions of an ensemble are written to a Zarr store in blocks of `block` bodies, so
        that they need not fit into memory. A block is checksummed and marked done when it is complete: an
        interrupted run keeps all complete blocks. The bytes of the store do not depend on threads,
        interruptions and the order of the blocks.

        Parameters
        ----------
        progress, threads
            As for `polhode.simulate`.
        store
            Path of the store, by convention ``*.zarr``.
        resume
            Continue a store: skip the blocks whose checksums are right, and compute missing and corrupt
            ones. Without a store, begin one.
        bodies
            ``(first, end)``: compute the blocks that begin in this range only, in a new store or in one that
            others fill too. Processes with disjoint ranges can fill a store at the same time.
        cluster
            A Dask cluster that computes the blocks as its tasks, each with `threads` threads, 1 by default:
            ``"local"`` or ``"local:N"`` starts N processes on this machine (a script then needs
            ``if __name__ == "__main__"``); else the address of a scheduler or the path of its
            ``scheduler.json``. All workers need the same version of polhode, and the files of scene and
            store at the same paths. None for the threads of this process.

        Returns
        -------
        Trajectory, or with `store` an `xarray.Dataset` that reads the store when its values are used.

        Raises
        ------
        ValueError
            As for `polhode.simulate`; for a store without an ensemble, with bodies out of range, or with
            another scene, seed or version of polhode; without one for an ensemble with `keep`, see `reduce`.
        OSError
            If the store exists and `resume` is false, if another process computes the same bodies, or if a
            block cannot be written, such as to a full disk, or the cluster is lost; complete blocks are kept.
        ImportError
            Without the libraries of a store, ``pip install 'polhode[zarr]'``, or of a cluster,
            ``pip install 'polhode[cluster]'``.

        Examples
        --------
        >>> text = '''
        ... body = { solid = "sphere", radius = "10 cm", mass = "5 kg" }
        ... initial.spin = { plane = "e1e2", rate = "1 rad/s" }
        ... torque.damping = "0.5 /s"
        ... run = { duration = "2 s", samples = 3 }
        ... '''
        >>> with open("ball.toml", "w") as file:
        ...     _ = file.write(text)
        >>> motion = ph.Scene.read("ball.toml").run()
        >>> motion.omega_body["e12"].round(4)  # exp(-t/2)
        array([1.    , 0.6065, 0.3679])
        """
        if store is not None:
            return self._run_into(store, resume, bodies, cluster, progress, threads)
        if resume or bodies is not None or cluster is not None:
            raise ValueError("resume, bodies and cluster need a store")
        if self.ensemble is not None and self.ensemble.keep:
            raise ValueError(
                f"the scene keeps {', '.join(self.ensemble.keep)} of its motions: use reduce() or "
                "run(store=…), or run_blocks() for the motions"
            )
        if self.ensemble is not None:
            return self._drawn(slice(0, self.ensemble.number), progress, threads)
        check_progress(progress)
        motion = self._core.simulate(self.times, progress)
        # The path stays valid if the working directory changes.
        origin = replace(self, path=self.path.absolute())
        return self._labelled(Trajectory._of(motion, Inertia(self._core.inertia()), (), origin))

    def _labelled(self, trajectory: Trajectory) -> Trajectory:
        warn_of(trajectory.certificate)
        trajectory.attributes.update({"title": self.name, "scene": self.text})
        return trajectory

    if TYPE_CHECKING:
        view = _outputs.view_of
        reduce = _outputs.reduce
        _run_into = _outputs.run_into

    def run_blocks(
        self,
        block: int | None = None,
        progress: Callable[[int, float], object] | None = None,
        threads: int | None = None,
    ) -> Iterator[tuple[slice, Trajectory]]:
        """Yield the motions of an ensemble's bodies in blocks: a slice of bodies, and their trajectory.

        All bodies together need not fit into memory. Bits are those of ``run()[rows]`` for any block.

        Parameters
        ----------
        block
            Number of bodies in a block; None for about 32 MB of results, or a 64th of all.
        progress
            Called regularly with 1 and the completed fraction of all bodies.

        Raises
        ------
        ValueError
            Without an ensemble; else as for `polhode.simulate`.

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
        >>> for rows, motion in ph.Scene.read("spins.toml").run_blocks(40):
        ...     print(rows, motion.shape)
        slice(0, 40, None) (40,)
        slice(40, 80, None) (40,)
        slice(80, 100, None) (20,)
        """
        if self.ensemble is None:
            raise ValueError("this scene has no table [ensemble]; use run")
        if block is not None and as_count(block, "block") < 1:
            raise ValueError(f"block must be at least 1, got {block}")
        number, size = self.ensemble.number, block or self.block_of_motions
        for rows, report in in_blocks(slice(0, number), size, progress):
            trajectory = self._drawn(rows, report, threads)
            if report is not None:
                report(1, 1.0)
            yield rows, trajectory

    @property
    def block(self) -> int:
        """Default number of bodies in a block of an ensemble."""
        number = 1 if self.ensemble is None else self.ensemble.number
        if self.ensemble is not None and self.ensemble.keep:
            return min(_REDUCED, max(_FEW, -(-number // _BLOCKS)))
        return self.block_of_motions

    @property
    def block_of_motions(self) -> int:
        """Default number of bodies whose motions are in memory at a time."""
        number = 1 if self.ensemble is None else self.ensemble.number
        fits = max(1, _BLOCK * number // self.result_bytes)
        return min(fits, max(_FEW, -(-number // _BLOCKS)))

    def _drawn(self, rows: slice, progress: Report | None, threads: int | None) -> Trajectory:
        """Return the motions of some bodies of the ensemble."""
        check_progress(progress)
        count = rows.stop - rows.start
        require(count, len(self.times), self.force is not None)
        found, inertias, centers = self._core.simulate_many(
            rows.start, count, self.times, checked_threads(threads), progress
        )
        shared = np.array([Inertia(inertia) for inertia in inertias], object)
        results = Results(
            (count,),
            shared if len(shared) > 1 else shared.reshape(()),
            np.array(self.state.time),
            centers[:, :3],
            centers[:, 3:],
            self.times,
            self.method,
        )
        return self._labelled(results.trajectory(*found))


def _sum_of(calls: list[tuple[str, tuple[Any, ...]]]) -> Force | None:
    """Return the sum of forces, each given as name and arguments of a function of `polhode.force`."""
    laws: list[Force] = [getattr(forces, name)(*arguments) for name, arguments in calls]
    return sum(laws[1:], laws[0]) if laws else None


def _found_instead(path: str) -> str:
    """Return the end of an error for a missing file: a scene or an example of its name, if there is one."""
    if os.path.isfile(named := f"{path}.toml"):
        return f"; use {named}"
    example = Path(path).name.removesuffix(".toml")
    if os.path.isfile(EXAMPLES / f"{example}.toml"):
        return f"; `polhode examples {example}` copies the example of this name"
    return ""
