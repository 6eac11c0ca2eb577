"""The command ``polhode convert``."""

from __future__ import annotations

import argparse
import re
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._cli import common
from polhode._cli.common import add_command, add_force, check_written, positive, whole_number
from polhode._support.files import UnreadableError, unreadable

if TYPE_CHECKING:
    from polhode._io.history import AttitudeHistory
    from polhode._mechanics.inertia import Inertia
    from polhode._mechanics.trajectory import Trajectory

# Largest relative difference of L in a table from R I(Ω) ~R; numbers in files may have few digits.
_OFF = 1e-3
# Options that a reader takes, and those of the written file; each is given to the format that has it.
_READING = (
    "kernels",
    "segment",
    "body",
    "epoch",
    "body_frame",
    "quaternion_type",
    "attitude_dir",
    "angvel_frame",
)
_OF_BODIES = ("density", "mass", "scale")
_WRITING = (
    *("epoch", "time_system", "reference_frame", "body_frame", "version", "originator"),
    *("object_name", "object_id", "center_name"),
)


def add(commands: Any) -> None:
    """Add the command to those of `polhode`."""
    convert = add_command(
        commands,
        "convert",
        _convert,
        help="convert files of motions and bodies",
        description="Convert the motion of one body from file A to file B: netCDF (.nc), CSV, Parquet, "
        "CCSDS AEM (.aem) or SPICE CK (.bc), by their suffixes; A may also be the Zarr store of an ensemble "
        "(.zarr), B a glTF animation (.glb, .gltf). Quaternion order, direction and frames that a file does "
        "not state must be given; they are never guessed. Or convert bodies: A is a scene (.toml), a mesh "
        "(.stl, .obj, .ply) or a robot file (.urdf, .sdf, MJCF as .xml), B a robot file (.urdf, .xml) with "
        "masses, centres of mass and inertias, or a mesh in principal axes (.stl).",
    )
    convert.add_argument("source", metavar="A", help="the file to read")
    convert.add_argument("target", metavar="B", help="the file to write")
    words = {
        "epoch": ("ISO", "epoch of time 0, such as 2026-01-01T00:00:00"),
        "time-system": (
            "NAME",
            "time system of the epoch: UTC, TAI, TT, TDB, GPS, TCB or TCG, default UTC",
        ),
        "reference-frame": ("NAME", "frame of space in a written AEM or CK, such as EME2000"),
        "body-frame": ("NAME", "name of the body's frame in an AEM or a written CK"),
        "object-name": ("NAME", "OBJECT_NAME of a written AEM"),
        "object-id": ("ID", "OBJECT_ID of a written AEM"),
        "center-name": ("NAME", "CENTER_NAME of a written AEM"),
        "originator": ("NAME", "ORIGINATOR of a written AEM"),
        "angvel-frame": ("NAME", "frame of angular velocities, for an AEM without ANGVEL_FRAME"),
    }
    for name, (metavar, text) in words.items():
        convert.add_argument(f"--{name}", metavar=metavar, help=text)
    text = "version of a written AEM: 2.0 (default) or 1.0"
    convert.add_argument("--aem-version", dest="version", choices=("1.0", "2.0"), help=text)
    text = "place of the scalar, for an AEM without QUATERNION_TYPE"
    convert.add_argument("--quaternion-type", choices=("FIRST", "LAST"), help=text)
    text = "direction of the attitude, for an AEM without ATTITUDE_DIR"
    convert.add_argument("--attitude-dir", choices=("A2B", "B2A"), help=text)
    number = whole_number("number of the segment", 1, float("inf"))
    convert.add_argument("--segment", metavar="N", type=number, help="segment of an AEM, from 1")
    number = whole_number("number of the body", 0, float("inf"))
    convert.add_argument("--body", metavar="N", type=number, help="body of a batch or an ensemble, from 0")
    text = "kernel for a CK: leapseconds, clock and frames, each with its own --kernel"
    convert.add_argument("--kernel", dest="kernels", metavar="FILE", action="append", help=text)
    text = "scene of the body in a table: its inertia for a netCDF file that polhode view shows; its mesh, "
    text += "solid or mass for a glTF animation"
    convert.add_argument("--scene", metavar="SCENE.toml", help=text)
    for name, text in {
        "density": "density in kg/m³ of the body in a mesh",
        "mass": "mass in kg of the body in a mesh",
        "scale": "unit of a mesh file in m, such as 0.001 for millimetres, default 1",
    }.items():
        amount = partial(positive, wanted=f"{name} must be a positive number")
        convert.add_argument(f"--{name}", metavar="X", type=amount, help=text)
    add_force(convert)


def _convert(options: argparse.Namespace) -> int:
    from polhode._io import bodies

    if Path(options.target).suffix.lower().removeprefix(".") in bodies.WRITTEN:
        return _convert_bodies(options)
    return _convert_motion(options)


def _convert_motion(options: argparse.Namespace) -> int:
    from polhode._io import bodies
    from polhode._io.convert import OPTIONS, WRITTEN, form_of, form_to_read, load, write
    from polhode._io.history import FileError

    try:
        of_target = form_of(options.target, (*WRITTEN, *bodies.WRITTEN), "written")
        if (form := Path(options.source).suffix.lower().removeprefix(".")) in bodies.READ:
            raise ValueError(
                f"a .{form} file has no motion, got {options.source!r}; a body is written as .urdf, .xml or "
                ".stl, and polhode run computes the motion of a scene"
            )
        of_source = form_to_read(options.source)
    except ValueError as error:
        options.parser.error(str(error))
    takes = {"read": OPTIONS["read", of_source], "write": OPTIONS["write", of_target]}
    applying = {*takes["read"], *takes["write"]} - {*_OF_BODIES}  # the mass of a box is that of the scene
    given = _given(options, applying, f"from .{of_source} to .{of_target}")
    shape: dict[str, Any] = {}
    body: Inertia | None = None
    if options.scene is not None:
        if "surface" in takes["write"]:
            shape = _shape(options.scene)
        elif of_target == "nc":
            body = _inertia_of_motion(options.scene)
        else:
            options.parser.error(f"--scene does not apply from .{of_source} to .{of_target}")
    target = _target(options)
    try:
        motion = load(options.source, **{name: x for name, x in given.items() if name in takes["read"]})
    except (FileError, OSError) as error:
        raise _unreadable(error) from None
    except ValueError as error:
        raise _refused(options, error) from None
    inertia = shape.pop("inertia", None)
    try:
        motion = _of_body(options, motion, body) if body else _completed(motion, inertia, of_target)
        write(motion, target, **shape, **{name: x for name, x in given.items() if name in takes["write"]})
    except (FileError, FileNotFoundError) as error:  # of a kernel
        raise _unreadable(error) from None
    except ValueError as error:
        raise _refused(options, error) from None
    print(f"Written\n  {target}")
    return common.OK


def _of_body(
    options: argparse.Namespace, motion: AttitudeHistory | Trajectory, inertia: Inertia
) -> Trajectory:
    """Return the motion of a body with the inertia of a scene, for a table that has none."""
    from polhode._io.history import AttitudeHistory

    if not isinstance(motion, AttitudeHistory) or motion.inertia is not None:
        options.parser.error(f"{options.source} has the inertia of its body; leave out --scene")
    if motion.wheel_speed is not None:
        raise UnreadableError(f"{options.source}: error: has wheel speeds, which a motion with --scene lacks")
    found = motion.trajectory(inertia)
    wanted = found.rotor(inertia(found.omega_body))
    size, off = (np.max(np.abs(x.components), initial=0.0) for x in (wanted, found.momentum_space - wanted))
    if off > _OFF * size:
        raise UnreadableError(
            f"{options.source}: error: the angular momentum differs from that of the body of {options.scene} "
            f"by {off:.3g} kg m²/s; give the scene of this body"
        )
    return found


def _inertia_of_motion(name: str) -> Inertia:
    """Return the inertia that determines the motion of a scene: about the fixed point of a held body."""
    from polhode._mechanics.inertia import Inertia

    return Inertia(common.read_scene(name)._core.inertia())


def _completed(
    history: AttitudeHistory | Trajectory, inertia: Inertia | None, form: str
) -> AttitudeHistory | Trajectory:
    """Return a history with the inertia of a scene if it has none; for netCDF a motion that can be shown.

    A body of an ensemble has all quantities; its file omits the position if that is always the origin.
    """
    from polhode._io.history import AttitudeHistory

    if not isinstance(history, AttitudeHistory):
        return history
    if history.inertia is None and inertia is not None:
        history = replace(history, inertia=inertia)
    known = history.inertia, history.omega_body, history.momentum_space, history.energy
    if form == "nc" and history.wheel_speed is None and all(x is not None for x in known):
        assert history.inertia is not None
        return history.trajectory(history.inertia)
    return history


def _convert_bodies(options: argparse.Namespace) -> int:
    from polhode._io import bodies
    from polhode._io.convert import form_of
    from polhode._mechanics.robots.document import DocumentError

    of_target = Path(options.target).suffix.lower().removeprefix(".")
    try:
        of_source = form_of(options.source, bodies.READ, f"converted to .{of_target}")
        takes = bodies.options_of(of_source, of_target)
    except ValueError as error:
        options.parser.error(str(error))
    if options.scene is not None:
        options.parser.error(f"--scene does not apply from .{of_source} to .{of_target}")
    given = _given(options, {*takes}, f"from .{of_source} to .{of_target}")
    target = _target(options)
    scene = common.read_scene(options.source) if of_source == "toml" else None
    try:
        lines = bodies.convert(options.source, target, scene, **given)
    except (DocumentError, FileNotFoundError, IsADirectoryError) as error:
        raise _unreadable(error) from None
    except ValueError as error:
        place, colon, words = str(error).partition(f"{options.source}: ")
        if colon and not place:  # a mesh that encloses no body
            raise UnreadableError(f"{options.source}: error: {words}") from None
        raise _refused(options, error) from None
    print("\n".join(["Written", f"  {target}", *lines]))
    return common.OK


def _refused(options: argparse.Namespace, error: ValueError) -> ValueError:
    """Return the error of a conversion; one that names an option is wrong usage, and ends the command."""
    message = _with_flags(str(error))
    if message != str(error):
        options.parser.error(message)
    if options.epoch is not None and repr(options.epoch) in message:
        options.parser.error(f"argument --epoch: {message}")
    return error


def _unreadable(error: Exception) -> UnreadableError:
    """Return the error of a file that cannot be read, with the options of the command."""
    return UnreadableError(_with_flags(str(unreadable(error))))


def _given(options: argparse.Namespace, takes: set[str], where: str) -> dict[str, Any]:
    """Return the options that were given; an error for one that does not apply."""
    names = {*_READING, *_WRITING, *_OF_BODIES}
    given = {name: x for name in sorted(names) if (x := getattr(options, name)) is not None}
    for name in given:
        if name not in takes:
            options.parser.error(f"{_flag(name)} does not apply {where}")
    return given


def _target(options: argparse.Namespace) -> Path:
    """Return the file to write, which may be written."""
    target = Path(options.target)
    check_written([target], options.force)
    return target


def _shape(name: str) -> dict[str, Any]:
    """Return the surface of a scene's body about the point of a motion's position, or mass and inertia."""
    scene = common.read_scene(name)
    found = scene.surface() if name != "-" else None
    if found is not None:
        vertices, triangles = found
        if not scene.held:
            vertices = vertices - np.asarray(scene.body.center_of_mass.components)
        return {"surface": (vertices, triangles)}
    if scene.has_mass:
        return {"mass": scene.body.mass, "inertia": scene.body.inertia}
    raise ValueError(f"{name} gives no mesh, solid or mass; add one to its table [body]")


def _with_flags(message: str) -> str:
    """Return a message with the options of the command for the arguments of Python."""
    message = message.replace("surface=(vertices, triangles)", "--scene=FILE.toml")
    message = message.replace("kernels=[FILE, ...]", "--kernel FILE for each")
    names = "|".join({*_READING, *_WRITING, *_OF_BODIES})
    return re.sub(rf"\b({names})=( ?)", lambda x: _flag(x[1]) + (x[2] or "="), message)


def _flag(name: str) -> str:
    """Return the option of the command for an argument of Python."""
    return {"version": "--aem-version", "kernels": "--kernel"}.get(name, f"--{name.replace('_', '-')}")
