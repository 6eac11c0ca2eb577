"""``polhode check``: scenes, meshes and robot files, without running anything."""

from __future__ import annotations

import argparse
import json
import math
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._cli import common
from polhode._cli.common import add_amount, add_command, positive, read_scene
from polhode._native import SceneError
from polhode._support.counts import counted

if TYPE_CHECKING:
    from polhode._mechanics.bodies import Body
    from polhode._mechanics.robots.link import Link
    from polhode._scene.scene import Scene
    from polhode._support.arrays import Array

_MESHES = (".stl", ".obj", ".ply")
_ROBOTS = (".urdf", ".sdf", ".xml", ".mjcf", ".world", ".xacro")

# Meshes longer than this, in m, if their unit is not km, or thinner than this, in kg/m³, are questioned. A
# balloon satellite, counted as full, has 0.005 kg/m³.
_LONGEST, _THINNEST = 100.0, 1e-3
# An angle in a scene that is a bare number, and so in radians.
_ANGLE = re.compile(r"\bangle\s*=\s*([+-]?[0-9][0-9_]*(?:\.[0-9_]+)?(?:[eE][+-]?[0-9]+)?)")


@dataclass
class Finding:
    """What is known of a file: facts for JSON, lines, and messages for standard error."""

    facts: dict[str, Any]
    lines: list[str] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)


def add(commands: Any) -> None:
    """Add the command."""
    check = add_command(
        commands,
        "check",
        run,
        help="check scenes, meshes and robot files without running them",
        description="Check scenes and their meshes, meshes (STL, OBJ, PLY), and the inertias of robot files "
        "(URDF, SDF, MJCF). Warnings point out values that are possible but unlikely.",
    )
    check.add_argument(
        "files", metavar="FILE", nargs="+", help="a scene (- is standard input), a mesh or a robot file"
    )
    check.add_argument(
        "--mass", metavar="KG", type=_mass, help="mass in kg of each of the meshes, to check their density"
    )
    add_amount(check, "the findings as JSON")


def _mass(text: str) -> float:
    return positive(text, "mass must be a positive number of kg")


def run(options: argparse.Namespace) -> int:
    """Check files; return the exit code."""
    facts: list[dict[str, Any]] = []
    for path in options.files:
        suffix = Path(path).suffix.lower()
        if suffix in _MESHES:
            finding = _mesh(path, options.mass)
        else:
            finding = _robot(path) if suffix in _ROBOTS else _scene(path)
        if finding.warnings:
            finding.facts["warnings"] = finding.warnings
        facts.append(finding.facts)
        if not options.json:
            for line in () if options.quiet else finding.lines:
                print(line)
            for message in (*finding.errors, *finding.warnings):
                print(message, file=sys.stderr)
    if options.json:
        print(json.dumps(facts, indent=2))
    return common.OK if all(one["ok"] for one in facts) else common.BAD_INPUT


# --- scenes


def _scene(path: str) -> Finding:
    from polhode._report.ensemble.netcdf import bytes_of_file
    from polhode._support.memory import size

    try:
        scene = read_scene(path)
    except SceneError as error:
        return Finding({"scene": path, "ok": False, "errors": str(error)}, errors=[str(error)])
    # The mass of a body to which the scene gives none is 1 kg, and has no meaning.
    body = repr(scene.body) if scene.has_mass else f"{scene.body.inertia!r} without a mass"
    facts: dict[str, Any] = {"scene": path, "ok": True, "body": body}
    words = f"{path}: ok, {body}, {counted(len(scene.times), 'output time')}"
    if scene.ensemble is not None:
        wanted = bytes_of_file(scene) if scene.ensemble.keep else scene.result_bytes
        facts |= {"bodies": scene.ensemble.number, "bytes": wanted}
        words += f", {counted(scene.ensemble.number, 'body')}, {size(wanted)} of results"
    return Finding(facts, [words], warnings=[*_doubts_of_angles(scene), *_doubts_of_scene(scene)])


def _doubts_of_angles(scene: Scene) -> Iterator[str]:
    """Yield the angles without a unit that exceed a turn; they are probably in degrees."""
    from polhode._mechanics.robots.document import Source

    lines = scene.text.split("\n")
    for number, line in enumerate(lines, 1):
        for angle in _ANGLE.finditer(line):
            if "#" not in line[: angle.start()] and abs(float(angle[1])) > 2 * math.pi:
                words = f'{angle[1]} rad is more than a turn; for degrees write "{angle[1]} deg"'
                yield Source(str(scene.path), lines).error(number, angle.start(1), words, "warning")


def _doubts_of_scene(scene: Scene) -> Iterator[str]:
    """Yield what is improbable about the mesh of a scene, at the key `mesh`."""
    from polhode._mechanics.robots.document import Source

    # A scene on standard input has no file from which its surface could be read again.
    surface = scene.surface() if scene.solid is None and scene.path.exists() else None
    if surface is None:
        return
    vertices, triangles = surface
    density = scene.body.mass / _volume(vertices, triangles)
    unit = _key("length_unit").search(scene.text)
    remedy = f"; check the key length_unit, which is now {unit[2] if unit else 'the metre'}"
    mesh = _key("mesh").search(scene.text)
    line, column = 1, 0
    if mesh:
        line = scene.text.count("\n", 0, mesh.start(1)) + 1
        column = mesh.start(1) - (scene.text.rfind("\n", 0, mesh.start(1)) + 1)
    source = Source(str(scene.path), scene.text.split("\n"))
    longest = math.inf if unit and unit[2].strip('"') == "km" else _LONGEST  # as asteroids
    for words in _doubts(np.ptp(vertices, axis=0), density, longest):
        yield source.error(line, column, words + remedy, "warning")


def _key(name: str) -> re.Pattern[str]:
    """Return the pattern of a key of TOML and its value, outside comments and strings."""
    return re.compile(rf"""^[^#"'\n]*?\b({name})\s*=\s*("[^"\n]*"|[^\s,}}#]*)""", re.MULTILINE)


def _volume(vertices: Array, triangles: Array) -> float:
    """Return the volume in a closed mesh, as a sum of tetrahedra."""
    a, b, c = np.moveaxis((vertices - vertices.mean(axis=0))[triangles], 1, 0)
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6


# --- meshes


def _mesh(path: str, mass: float | None) -> Finding:
    from polhode._mechanics.bodies import Body

    try:
        body = Body.from_mesh(path, density=1)
    except (ValueError, OSError) as error:
        message = f"{path}: error: {str(error).removeprefix(f'{path}: ')}"
        return Finding({"mesh": path, "ok": False, "errors": message}, errors=[message])
    volume, lengths = body.mass, _box(body)
    sides = " x ".join(f"{x:.3g}" for x in lengths)
    facts = {"mesh": path, "ok": True, "volume": volume, "box": lengths.tolist()}
    words = f"{path}: ok, {volume:.6g} m³, with the inertia of a box of {sides} m, if its unit is the metre"
    remedy = '; if its unit is mm, write length_unit = "mm" in the scene, or from_mesh(…, scale=0.001)'
    doubts = _doubts(lengths, None if mass is None else mass / volume)
    return Finding(facts, [words], warnings=[f"{path}: warning: {doubt}{remedy}" for doubt in doubts])


def _box(body: Body) -> Array:
    """Return the sides of the box with the principal moments of a body: ``∫x_k² dm = m l_k²/12``."""
    moments = body.inertia.principal_moments
    squares = 12 / body.mass * (0.5 * moments.sum() - moments)
    return np.asarray(np.sqrt(np.maximum(squares, 0)), float)


def _doubts(lengths: Array, density: float | None, longest: float = _LONGEST) -> Iterator[str]:
    """Yield what is improbable about the lengths (3,) of a mesh in m and its density in kg/m³."""
    from polhode._mechanics.robots.slips import OSMIUM

    if max(lengths) > longest:
        yield f"mesh is {' x '.join(f'{x:.3g}' for x in lengths)} m, longer than {longest:g} m"
    if density is not None and density > OSMIUM:
        yield f"mesh has {density:.3g} kg/m³, more than osmium ({OSMIUM:g} kg/m³)"
    if density is not None and density < _THINNEST:
        yield f"mesh has {density:.3g} kg/m³, less than air at 50 km ({_THINNEST:g} kg/m³)"


# --- robot files


def _robot(path: str) -> Finding:
    from polhode._mechanics.robots.document import DocumentError
    from polhode._mechanics.robots.read import read_links

    try:
        form, links = read_links(path)
    except (DocumentError, FileNotFoundError) as error:
        message = str(error) if isinstance(error, DocumentError) else f"{path}: error: no such file"
        return Finding({"robot": path, "ok": False, "errors": message}, errors=[message])
    facts = {
        "robot": path,
        "format": form,
        "ok": not any(link.errors for link in links),
        "links": [_facts(link) for link in links],
    }
    lines = [_line(path, link) for link in links] or [f"{path}: ok, no links"]
    return Finding(
        facts,
        lines,
        [error for link in links for error in link.errors],
        [warning for link in links for warning in link.warnings],
    )


def _line(path: str, link: Link) -> str:
    if link.errors:
        return f"{path}: {link.name}: error, see line {link.node.line}"
    return f"{path}: {link.name}: ok, {link.note or repr(link.body)}"


def _facts(link: Link) -> dict[str, Any]:
    body = None if link.body is None else repr(link.body)
    return {
        "name": link.name,
        "line": link.node.line,
        "ok": not link.errors,
        "body": body,
        "errors": link.errors,
        "warnings": link.warnings,
    }
