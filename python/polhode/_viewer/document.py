"""Documents for the viewer: scenes and motions.

Their format is `PageDocument` in `viewer/src/document.ts`.
"""

from __future__ import annotations

import contextlib
import json
import os
import re
import tempfile
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from polhode._algebra.multivector import Multivector
from polhode._algebra.transform import RigidTransform
from polhode._mechanics.arguments import about_fixed_point, as_force, as_torque
from polhode._mechanics.bodies import Body
from polhode._mechanics.closed_form import ClosedForm
from polhode._mechanics.closed_forms import DampedTop, LagrangeTop, LarmorSphere
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.laws import finite
from polhode._mechanics.problem import Problem
from polhode._mechanics.simulate import simulate
from polhode._mechanics.state import State
from polhode._mechanics.sums import Sum
from polhode._mechanics.trajectory import Trajectory
from polhode._native import SceneError
from polhode._report.netcdf_reading import read
from polhode._scene.scene import Scene
from polhode._scene.writer import UnwritableError, scene_text
from polhode._support.arrays import Array, as_float
from polhode._support.file_kinds import suffix_of
from polhode._support.packing import packed, unpacked
from polhode._viewer.recording import recorded
from polhode._viewer.values import of_values
from polhode.torque import Torque, damping, heavy, larmor

Document = dict[str, Any]

# Default duration: turns at the initial rate, or s for a body at rest.
_TURNS, _REST = 20, 10.0
_SAMPLES = 1001


def document(
    x: Any,
    state: State | None = None,
    torque: Any = None,
    force: Any = None,
    *,
    duration: float | None = None,
) -> Document:
    """Return the document of what `polhode.view` shows, with its arguments and errors.

    The page solves scenes itself. An exact motion is given as a scene alone; a stepped one as a scene with
    its states at up to 20,000 times, so that the page need not integrate it before something is changed. A
    motion that no scene can describe, such as one under a Python function, is given by its states alone.
    """
    if isinstance(x, (Body, Inertia)):
        if state is None:
            raise TypeError("a body needs a state to be shown: give state")
        if not isinstance(state, State):
            raise TypeError(f"state must be a State, got {type(state).__name__}")
        law, push = as_torque(torque), None if force is None else as_force(force)
        _refuse_batch(state, law, push)
        bodies, law = about_fixed_point(x, law)
        return _of_problem(_problem(bodies[()], state, law, push, duration))
    _refuse(x, state=state, torque=torque, force=force)
    if isinstance(x, ClosedForm):
        return _of_problem(_solved(x, duration))
    _refuse(x, duration=duration)
    if isinstance(x, Scene):
        return of_scene(x)
    if isinstance(x, Trajectory):
        return of_trajectory(x)
    if isinstance(x, (str, os.PathLike)):
        return of_file(Path(x))
    if isinstance(x, (Multivector, RigidTransform, Mapping, list, tuple)):
        return of_values(x)
    raise TypeError(
        f"cannot show a value of type {type(x).__name__}: give a Scene, a Trajectory, a closed-form motion, "
        "the path of a scene, lesson or netCDF file, a Body and its State, or values of the algebra"
    )


def _refuse(x: Any, **given: Any) -> None:
    """Raise a TypeError for arguments that the shown value already has."""
    if extra := [name for name, value in given.items() if value is not None]:
        what = repr(str(x)) if isinstance(x, (str, os.PathLike)) else f"a {type(x).__name__}"
        raise TypeError(f"{' and '.join(extra)} cannot be given for {what}, which has its own")


def of_scene(scene: Scene) -> Document:
    """Return the document of a scene."""
    return of_text(scene.text, scene.path)


def of_text(text: str, path: Path) -> Document:
    """Return the document of a scene's text, with its mesh and its table of bodies if they can be read.

    The page reports what is wrong with the scene.
    """
    shown: Document = {"format": 1, "scene": text, "name": path.name}
    tables, files = _parsed(text), {}
    for table, field in (("body", "mesh"), ("ensemble", "table")):
        fields = tables.get(table)
        name = fields.get(field) if isinstance(fields, dict) else None
        if isinstance(name, str) and name:
            # A ValueError: the name is not a valid file name.
            with contextlib.suppress(OSError, ValueError):
                files[name] = packed((path.parent / name).read_bytes())
    return {**shown, "files": files} if files else shown


def _parsed(text: str) -> dict[str, Any]:
    """Return the tables of a scene; none if it is not TOML."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return {}


def of_file(path: Path) -> Document:
    """Return the document of a scene, a netCDF file or a lesson; a `SceneError` for an invalid scene."""
    if (suffix := suffix_of(path)) == ".nc":
        return of_trajectory(read(path), path)
    if suffix == ".md":
        return of_lesson(path)
    return of_scene(Scene.read(path))


def of_lesson(path: Path) -> Document:
    """Return the document of a lesson, with the scene and mesh files that it names.

    The page checks the lesson. An OSError if it cannot be read, a ValueError if it is not UTF-8.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        found = error.object[error.start]
        message = f"{path}: not UTF-8 text: byte {error.start} is {found:#04x}; save it as UTF-8"
        raise ValueError(message) from None
    scenes = re.findall(r"^```toml *\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    files: dict[str, bytes] = {}
    for name in re.findall(r"^scene: *[\"']?(.+?\.toml)[\"']? *$", text, re.MULTILINE):
        with contextlib.suppress(OSError, ValueError):
            files[name] = (path.parent / name).read_bytes()
            scenes.append(files[name].decode(errors="replace"))
    for scene in scenes:
        body = _parsed(scene).get("body")
        mesh = body.get("mesh") if isinstance(body, dict) else None
        if isinstance(mesh, str) and mesh:
            with contextlib.suppress(OSError, ValueError):
                files[mesh] = (path.parent / mesh).read_bytes()
    contents = {name: packed(content) for name, content in files.items()}
    return {"format": 1, "lesson": {"text": text, "name": path.name}, "files": contents}


def of_trajectory(
    trajectory: Trajectory, path: Path = Path("motion.nc"), times: Array | None = None
) -> Document:
    """Return the document of one body's motion, read from a path; its mesh is beside that file.

    At `times` (n,), in s, the page shows the states of `Trajectory.at`, if there are any.
    """
    trajectory._require_one("the viewer")
    shown, origin = _live(trajectory, path)
    if "scene" in shown and trajectory.certificate.method == "exact":
        return shown
    return {**shown, "recorded": recorded(trajectory, origin, "files" in shown, times)}


def _live(trajectory: Trajectory, path: Path) -> tuple[Document, Scene | Problem | None]:
    """Return a document with the scene of a motion, if it has one, and the problem that was solved."""
    origin, text = trajectory._origin, trajectory.attributes.get("scene")
    if isinstance(origin, Scene):
        return of_scene(origin), origin
    with contextlib.suppress(UnwritableError, SceneError):
        if origin is not None:
            # An event may have ended it before the last output time.
            return _of_scene_text(replace(origin, times=trajectory.time)), origin
        if isinstance(text, str):
            shown = of_text(text, path)
            return shown, scene_of(shown)
    return {"format": 1, "name": path.name}, origin


def _of_scene_text(problem: Problem) -> Document:
    """Return the document of a problem; an UnwritableError if no scene can describe it."""
    return {"format": 1, "scene": scene_text(problem), "name": "motion.toml"}


def scene_of(shown: Document) -> Scene:
    """Return the scene of a document, with the mesh of the document.

    A `SceneError` refers to places in the document's own file.
    """
    name = shown.get("name") or "scene.toml"
    # Files with an absolute path are read from there.
    files = {file: content for file, content in shown.get("files", {}).items() if not os.path.isabs(file)}
    # A mesh may be in a parent folder of its scene: `../meshes/top.stl`.
    above = max((Path(file).parts.count("..") for file in files), default=0)
    with tempfile.TemporaryDirectory() as top:
        path = Path(top, *("below",) * above, Path(name).name)
        contents = {path: shown["scene"].encode()}
        contents |= {Path(os.path.normpath(path.parent / file)): unpacked(x) for file, x in files.items()}
        for target, content in contents.items():
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)
        try:
            return replace(Scene.read(path), path=Path(name))
        except SceneError as error:
            raise SceneError(str(error).replace(f"{path.parent}{os.sep}", "")) from None


def title_of(shown: Document) -> str:
    """Return the title of a page with this document."""
    if "lesson" in shown:
        found = re.search(r"^title: *[\"']?(.+?)[\"']? *$", shown["lesson"]["text"], re.MULTILINE)
        return found[1] if found else Path(shown["lesson"]["name"]).stem
    if "recorded" in shown:
        title = json.loads(shown["recorded"]["about"])["title"]
    else:
        title = _parsed(shown.get("scene", "")).get("title")
    return title if isinstance(title, str) else Path(shown.get("name") or "Polhode").stem


# --- motions given as problems


def _problem(body: Body | Inertia, state: State, torque: Torque | None, force: Any, duration: Any) -> Problem:
    if duration is None:
        rate = float(state.omega_body.norm()) if not state.omega_body.shape else 0.0
        duration = 2 * np.pi * _TURNS / rate if rate else _REST
    seconds = finite(as_float(duration, "duration"), "duration")
    if seconds <= 0:
        raise ValueError(f"duration is {seconds}; it must be positive")
    start = float(state.time) if not np.ndim(state.time) else 0.0
    return Problem(body, state, torque, force, start + np.linspace(0.0, seconds, _SAMPLES))


def _of_problem(problem: Problem) -> Document:
    """Return the document of a problem; if no scene can describe it, it is solved here."""
    _refuse_batch(problem.state, problem.torque, problem.force)
    try:
        return _of_scene_text(problem)
    except UnwritableError:
        motion = simulate(problem.body, problem.state, problem.times, problem.torque, problem.force)
        return of_trajectory(motion)


def _refuse_batch(state: State, *laws: Sum | None) -> None:
    if state.shape or any(law.shape for law in laws if law is not None):
        raise ValueError("the viewer shows one body, this is a batch: pick one body")


def _solved(motion: ClosedForm, duration: float | None) -> Problem:
    """Return what a motion in closed form is the answer to."""
    if motion.shape:
        raise ValueError(f"the viewer shows one body, this is a batch of shape {motion.shape}: pick one body")
    inertia, rotor, omega_body, *arguments = motion._arguments()
    laws = {LagrangeTop: heavy, DampedTop: damping, LarmorSphere: larmor}
    law = laws[type(motion)](*arguments) if arguments else None
    return _problem(inertia, State(rotor, omega_body), law, None, duration)
