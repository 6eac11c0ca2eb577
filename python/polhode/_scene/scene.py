"""Scenes: a body, how it starts and how long it runs, from a TOML file."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _native
from polhode import force as forces
from polhode._algebra.rotor import Rotor
from polhode._mechanics.bodies import Body
from polhode._mechanics.simulate import simulate
from polhode._mechanics.state import State
from polhode._mechanics.trajectory import Trajectory
from polhode._scene.ensemble import EnsembleSpec, torque_of
from polhode._support.arrays import Array, frozen, hands_out_copies
from polhode.force import Force
from polhode.torque import Torque

if TYPE_CHECKING:
    from polhode import _outputs

DRIFT_BOUND = 1e-8

# Bytes of results in a block of bodies. So many blocks that a run which is stopped keeps most of what it
# did, but none so small that its lanes and threads are idle.
_BLOCK, _BLOCKS, _FEW = 32 << 20, 64, 512


class SceneNotFoundError(_native.SceneError, FileNotFoundError):
    """A scene file that does not exist."""


@hands_out_copies("shift", "times")
@dataclass(frozen=True, eq=False)
class Scene:
    """What a scene file says, in SI units, ready to run. Made by `Scene.read`.

    Attributes
    ----------
    path, text, title
        The file, its content, and its title or None.
    body
        The body; under gravity in axes whose origin is the fixed point.
    tells_mass
        False where the file gives an inertia alone; the body then has 1 kg, which the motion ignores.
    solid
        The kind of the solid that the file says and its sizes in m, as the fields of a scene; None without.
    shift
        Where the origin of the file's axes is in those of the body, (3,), in m: not 0 for a pivot alone.
    state
        The state at the start, which has the time that the file says, or 0.
    torque
        What turns the body, gravity first and then as in the file; None where nothing does.
    formulas
        For each law of `torque` its formula as the file has it, or None.
    force
        What moves the centre of mass; None where nothing does.
    times
        Output times in s.
    method, step, rtol, atol, max_step, max_steps
        As for `polhode.simulate`; step and tolerances may be None.
    drift_bound
        Largest relative drift of a conserved quantity that counts as success.
    ensemble
        How many bodies there are, and in what they differ from this one; None where there is but one.
    """

    path: Path
    text: str
    title: str | None
    body: Body
    tells_mass: bool
    solid: dict[str, Any] | None
    shift: Array
    state: State
    torque: Torque | None
    formulas: tuple[str | None, ...]
    force: Force | None
    times: Array
    method: str
    step: float | None
    rtol: float | None
    atol: float | None
    max_step: float | None
    max_steps: float | None
    drift_bound: float
    ensemble: EnsembleSpec | None

    @staticmethod
    def read(path: str | os.PathLike[str]) -> Scene:
        """Read a scene file, and the mesh that it names.

        Raises
        ------
        SceneError
            A ValueError whose text gives file, line and column of everything that is wrong, with the line.
        FileNotFoundError
            If there is no such file; it is a SceneError too.
        """
        try:
            fields = _native.read_scene(os.fspath(path))
        except _native.SceneError as error:
            if os.path.lexists(path):
                raise
            raise SceneNotFoundError(str(error)) from None
        return Scene(
            path=Path(path),
            text=fields["text"],
            title=fields["title"],
            body=Body._of(fields["body"]),
            tells_mass=fields["tells_mass"],
            solid=fields["solid"],
            shift=frozen(fields["shift"]),
            state=State(
                Rotor._from_rows(fields["rotor"]),
                fields["omega_body"],
                fields["position"],
                fields["velocity"],
                time=fields["time"],
            ),
            torque=Torque(tuple(fields["laws"])) if fields["laws"] else None,
            formulas=tuple(fields["formulas"]),
            force=_sum_of(fields["forces"]),
            times=frozen(fields["times"]),
            method=fields["method"],
            step=fields["step"],
            rtol=fields["rtol"],
            atol=fields["atol"],
            max_step=fields["max_step"],
            max_steps=fields["max_steps"],
            drift_bound=DRIFT_BOUND if fields["drift_bound"] is None else fields["drift_bound"],
            ensemble=None if fields["ensemble"] is None else EnsembleSpec._of(fields["ensemble"]),
        )

    def surface(self) -> tuple[Array, Array] | None:
        """Return the mesh that the file names: vertices (n, 3) in body axes in m, and triangles (m, 3).

        None where it names none.
        """
        mesh = _native.scene_mesh(os.fspath(self.path))
        return None if mesh is None else (mesh[0], np.array(mesh[1], int))

    @property
    def result_bytes(self) -> int:
        """The memory that the states of all bodies at all times take: rotors, Ω, L and energies."""
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
        return self.title or self.path.stem

    def alone(self) -> Scene:
        """Return the scene of the one body from which those of an ensemble differ."""
        return replace(self, ensemble=None)

    def run(
        self, progress: Callable[[int, float], object] | None = None, threads: int | None = None
    ) -> Trajectory:
        """Return the motion at the output times, or those of all bodies of an ensemble, a batch (number,).

        Errors, `progress` and `threads` as for `polhode.simulate`.
        """
        if self.ensemble is None:
            # Moments in a file may be those about the fixed point, without a centre of mass.
            body = self.body.inertia_about(0) if self.held else self.body
            return self._moved(body, self.state, self.torque, progress, threads)
        return self._drawn(slice(0, self.ensemble.number), progress, threads)

    if TYPE_CHECKING:
        view = _outputs.view_of

    def run_blocks(
        self,
        block: int | None = None,
        progress: Callable[[int, float], object] | None = None,
        threads: int | None = None,
    ) -> Iterator[tuple[slice, Trajectory]]:
        """Yield the motions of an ensemble's bodies in blocks, drawn as they come: which bodies, and theirs.

        So all together need not fit into memory. The same bits as in ``run()[rows]``, for any block.

        Parameters
        ----------
        block
            How many bodies at a time; None for as many as have some 32 MB of results, or a 64th of all.
        progress
            Called now and then with 1 and the fraction of all bodies that is done.

        Raises
        ------
        ValueError
            Without an ensemble; else as for `polhode.simulate`.
        """
        if self.ensemble is None:
            raise ValueError("this scene is one body, without a table [ensemble]; use run")
        if block is not None and block < 1:
            raise ValueError(f"block is {block}; it must be 1 or more")
        number, size = self.ensemble.number, block or self.block
        for start in range(0, number, size):
            rows = slice(start, min(start + size, number))

            def of_all(one: int, fraction: float, rows: slice = rows) -> None:
                if progress is not None:
                    progress(one, (rows.start + fraction * (rows.stop - rows.start)) / number)

            trajectory = self._drawn(rows, of_all if progress else None, threads)
            of_all(1, 1.0)
            yield rows, trajectory

    @property
    def block(self) -> int:
        """How many bodies of an ensemble are run at a time, if nobody says it."""
        number = 1 if self.ensemble is None else self.ensemble.number
        fits = max(1, _BLOCK * number // self.result_bytes)
        return min(fits, max(_FEW, -(-number // _BLOCKS)))

    def _drawn(
        self, rows: slice, progress: Callable[[int, float], object] | None, threads: int | None
    ) -> Trajectory:
        """Return the motions of some bodies of the ensemble."""
        assert self.ensemble is not None
        state, inertias, laws = self.ensemble.draw(rows.start, rows.stop - rows.start)
        bodies: list[Any] = list(inertias)
        if self.force is not None:
            mass, center = self.body.mass, self.body.center_of_mass
            bodies = [Body(mass, inertia, center) for inertia in inertias]
        body = bodies[0] if len(bodies) == 1 else bodies
        return self._moved(body, state, torque_of(laws), progress, threads)

    def _moved(
        self,
        body: Any,
        state: State,
        torque: Torque | None,
        progress: Callable[[int, float], object] | None,
        threads: int | None,
    ) -> Trajectory:
        trajectory = simulate(
            body,
            state,
            self.times,
            torque,
            self.force,
            method=self.method,
            step=self.step,
            rtol=self.rtol,
            atol=self.atol,
            max_step=self.max_step,
            max_steps=self.max_steps,
            threads=threads,
            progress=progress,
        )
        trajectory.attributes.update({"title": self.name, "scene": self.text})
        if trajectory.shape:
            return trajectory
        # Wherever the program goes afterwards.
        return replace(trajectory, _origin=replace(self, path=self.path.absolute()))


def _sum_of(calls: list[tuple[str, tuple[Any, ...]]]) -> Force | None:
    """Return the sum of forces, each the name and the arguments of a function of `polhode.force`."""
    made: list[Force] = [getattr(forces, name)(*arguments) for name, arguments in calls]
    return sum(made[1:], made[0]) if made else None
