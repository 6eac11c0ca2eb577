"""Counts of faults: damaged files and texts, and runs that are killed while they write.

Damaged input must be read, where the damage leaves it valid, or end in an error of the kinds that the
documentation names; anything else is a fault of ours. A killed run must leave the file that was there
before, or the whole new one.
"""

from __future__ import annotations

import random
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

import machine
import polhode as ph

EXAMPLES = machine.ROOT / "examples"
# SceneError, FormulaError and FileError are of these kinds.
EXPECTED = (ValueError, TypeError, OSError, MemoryError)
TOKENS = [
    "nan",
    "inf",
    "-1",
    "1e400",
    "0",
    "1e-320",
    "[",
    "]",
    '"',
    "=",
    "\x00",
    "é",
    "∧",
    "~",
    "(",
    ")",
    "R",
    "e1",
    "\n",
]
FORMULAS = [
    "R v ~R + (a∧b)·c",
    "e^(-B θ/2) v e^(B θ/2)",
    "½(a B − B a) = a·B",
    "-I (a∧b)",
    "⟨R v ~R⟩₁",
]
VALUES = {
    "R": ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, 0.3),
    "B": ph.e1 ^ ph.e2,
    "θ": 0.3,
    "v": ph.e1,
    "a": ph.e1 + ph.e3,
    "b": ph.e2,
    "c": ph.e3,
}


@dataclass
class Count:
    """How many damaged inputs of a kind were read and refused, and the errors that no documentation names."""

    kind: str
    tried: int = 0
    read: int = 0
    refused: int = 0
    faults: list[str] = field(default_factory=list)


def damaged_inputs(seed: int, count: int) -> Iterator[Count]:
    """Yield the counts of `count` damaged inputs of each kind."""
    rng = random.Random(seed)
    with TemporaryDirectory() as folder:
        place = Path(folder)
        scenes = [path.read_text() for path in sorted(EXAMPLES.glob("*.toml"))]
        yield _tried("formulas", count, lambda: _formula(_damaged_text(rng, rng.choice(FORMULAS))))
        yield _tried(
            "scenes",
            count,
            lambda: _through(place / "a.toml", _damaged_text(rng, rng.choice(scenes)), ph.Scene.read),
        )
        for kind, name, build, read in _files(place):
            whole = build(place / name).read_bytes()
            read(place / name)
            target = place / f"damaged-{name}"
            attempt = partial(_read_damaged, rng, target, whole, read)
            yield _tried(kind, count, attempt)


def _read_damaged(rng: random.Random, path: Path, whole: bytes, read: Callable[[Path], Any]) -> Any:
    return _through(path, _damaged_bytes(rng, whole), read)


def _files(place: Path) -> Iterator[tuple[str, str, Callable[[Path], Path], Callable[[Path], Any]]]:
    """Yield kinds of files: how one is written, and how it is read."""
    inertia = ph.Inertia.from_principal_moments(1.0, 2.0, 2.5)
    start = ph.State(ph.Rotor.identity(), [0.01, 1.0, 0.01])
    motion = ph.simulate(inertia, start, np.linspace(0.0, 10.0, 41))

    def saved(path: Path) -> Path:
        motion.save(path)
        return path

    def table(path: Path) -> Path:
        ph.io.write_aem(motion, path, epoch="2026-01-01T00:00:00", reference_frame="EME2000")
        return path

    def mesh(path: Path) -> Path:
        path.write_bytes((EXAMPLES / "t-handle.stl").read_bytes())
        return path

    def robot(path: Path) -> Path:
        ph.io.write_urdf(ph.Body.box([1.0, 2.0, 3.0], mass=2.0), path)
        return path

    yield "meshes (STL)", "mesh.stl", mesh, lambda path: ph.Body.from_mesh(path, density=1000.0)
    yield "robots (URDF)", "robot.urdf", robot, ph.read_urdf
    yield "attitude histories (AEM)", "attitude.aem", table, ph.io.read_aem
    yield "motions (CSV)", "motion.csv", saved, ph.io.read_csv
    yield "motions (netCDF)", "motion.nc", saved, ph.io.read_netcdf


def _tried(kind: str, count: int, attempt: Callable[[], object]) -> Count:
    result = Count(kind)
    for _ in range(count):
        result.tried += 1
        try:
            attempt()
            result.read += 1
        except EXPECTED:
            result.refused += 1
        except BaseException as error:  # a panic of Rust is not an Exception
            if isinstance(error, KeyboardInterrupt):
                raise
            result.faults.append(f"{type(error).__name__}: {error}")
    return result


def _formula(text: str) -> object:
    return ph.evaluate(text, **VALUES)


def _through(path: Path, content: str | bytes, read: Callable[[Path], Any]) -> Any:
    path.write_bytes(content.encode("utf-8", "surrogatepass") if isinstance(content, str) else content)
    return read(path)


def _damaged_text(rng: random.Random, text: str) -> str:
    """Replace, insert or remove a few characters, words or lines."""
    for _ in range(rng.randint(1, 4)):
        at = rng.randrange(len(text) + 1)
        length = rng.choice([0, 0, 1, 1, 2, 5, 20])
        text = text[:at] + rng.choice(["", *TOKENS]) + text[at + length :]
    return text


def _damaged_bytes(rng: random.Random, whole: bytes) -> bytes:
    """Flip bits, cut the end, or repeat a part."""
    data = bytearray(whole)
    way = rng.random()
    if way < 0.2:
        return bytes(data[: rng.randrange(len(data))])
    if way < 0.3:
        at = rng.randrange(len(data))
        return bytes(data[:at] + data[at : at + 64] + data[at:])
    for _ in range(rng.randint(1, 8)):
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return bytes(data)


@dataclass
class Kills:
    """Runs killed at random moments over an older file: which file was found afterwards."""

    tried: int = 0
    old: int = 0
    new: int = 0
    partial: int = 0


def killed_runs(seed: int, count: int) -> Kills:
    """Kill `polhode run` while it computes and writes, `count` times."""
    rng, result = random.Random(seed), Kills()
    command = [sys.executable, "-m", "polhode", "run", str(EXAMPLES / "toutatis.toml"), "--quiet", "-o"]
    with TemporaryDirectory() as folder:
        target = Path(folder, "motion.nc")
        begun = time.monotonic()
        subprocess.run([*command, str(target)], check=True, capture_output=True, timeout=300)
        took, old = time.monotonic() - begun, target.read_bytes()
        for _ in range(count):
            with subprocess.Popen([*command, str(target), "--force"], stderr=subprocess.DEVNULL) as process:
                time.sleep(rng.uniform(0.3, 1.0) * took)
                process.kill()
            result.tried += 1
            found = target.read_bytes()
            try:
                ph.io.read_netcdf(target)
            except EXPECTED:
                result.partial += 1
            else:
                result.old += found == old
                result.new += found != old
    return result
