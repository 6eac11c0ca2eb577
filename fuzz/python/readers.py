"""Fuzz targets of the readers in Python: any file is read, or rejected by an error that names it."""

from __future__ import annotations

import functools
import tempfile
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

import fields
import polhode as ph
from polhode._fit.table import read_tables
from polhode._mechanics.robots.read import bodies_of
from polhode._support.files import UnreadableError

_EPOCH = "2026-01-01T00:00:00"
_FOLDER = tempfile.TemporaryDirectory()


@dataclass(frozen=True)
class Target:
    """Readers of one kind of file, and a source of files to begin with, which may use a folder."""

    suffix: str
    readers: tuple[Callable[[Path], Any], ...]
    seeds: Callable[[Path], Iterator[bytes]]

    def corpus(self) -> list[bytes]:
        """Return the files to begin with."""
        with tempfile.TemporaryDirectory() as folder:
            return list(self.seeds(Path(folder)))

    def check(self, content: bytes) -> None:
        """Read a file with this content; an AssertionError for an exception that is not documented."""
        path = Path(_FOLDER.name) / f"part.{self.suffix}"
        path.write_bytes(content)
        for read in self.readers:
            check(read, path)


@dataclass(frozen=True)
class Fields(Target):
    """A sound file, of which the content chooses the seed and the parts to replace."""

    write: Callable[[bytes, Path, bytes], None] = fields.netcdf

    @functools.cached_property
    def files(self) -> list[bytes]:
        """The sound files."""
        return super().corpus()

    def corpus(self) -> list[bytes]:
        """Return some single changes."""
        return [bytes([k % 2, k, 3 * k, 5 * k]) for k in range(40)]

    def check(self, content: bytes) -> None:
        """As for other targets."""
        path = Path(_FOLDER.name) / f"fields.{self.suffix}"
        if content:
            self.write(content[1:], path, self.files[content[0] % len(self.files)])
            for read in self.readers:
                check(read, path)


class Store(Target):
    """A folder, of which one file at a time is replaced: its name, a line feed, and its content.

    After a minus sign the folder is without the checksums that would reject most changes.
    """

    @functools.cached_property
    def files(self) -> dict[bytes, bytes]:
        """The files of the store."""
        return dict(seed.split(b"\n", 1) for seed in super().corpus())

    def corpus(self) -> list[bytes]:
        """Return the files with and without checksums of the others."""
        files = [name + b"\n" + content for name, content in self.files.items()]
        return [*files, *(b"-" + content for content in files)]

    def check(self, content: bytes) -> None:
        """As for other targets."""
        name, _, new = content.removeprefix(b"-").partition(b"\n")
        if name not in self.files:
            return
        with tempfile.TemporaryDirectory(suffix=f".{self.suffix}") as folder:
            for other, own in (self.files | {name: new}).items():
                if content.startswith(b"-") and other.startswith(b".polhode"):
                    continue
                path = Path(folder, other.decode())
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(own)
            for read in self.readers:
                check(read, Path(folder))


def check(read: Callable[[Path], Any], path: Path) -> None:
    """Read a path; an AssertionError for an exception that is not documented."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            read(path)
        except (ValueError, OSError, MemoryError, UnreadableError) as error:
            # Subclasses of ValueError from libraries, such as UnicodeDecodeError, do not name the file.
            own = type(error).__module__.split(".")[0] in ("polhode", "builtins")
            if not own or isinstance(error, UnicodeError) or path.name not in str(error):
                raise AssertionError(f"{type(error).__name__} without the file: {error}") from error


# --- files to begin with


def _motions(suffix: str) -> Callable[[Path], Iterator[bytes]]:
    """Return a source of files of a motion and of a batch."""

    def seeds(folder: Path) -> Iterator[bytes]:
        inertia, path = ph.Inertia.from_principal_moments(1, 2, 3), folder / f"motion.{suffix}"
        for omega, events in (
            ([0.1, 2, 0.3], [ph.event.plane(ph.e1, ph.e1)]),
            ([[0.1, 2, 0.3], [0, 0, 1]], ()),
        ):
            start = ph.State(ph.Rotor.identity(), omega)
            motion = ph.simulate(inertia, start, np.linspace(0, 3, 3), events=events)
            if suffix != "aem":
                motion.save(path)
                yield path.read_bytes()
            elif not motion.shape:
                for version in ("1.0", "2.0"):
                    ph.io.write_aem(motion, path, epoch=_EPOCH, reference_frame="EME2000", version=version)
                    yield path.read_bytes()

    return seeds


_LEAPSECONDS = r"""KPL/LSK
\begindata
DELTET/DELTA_T_A = 32.184
DELTET/K         = 1.657D-3
DELTET/EB        = 1.671D-2
DELTET/M         = ( 6.239996D0  1.99096871D-7 )
DELTET/DELTA_AT  = ( 37, @2017-JAN-1 )
\begintext
"""
_SDF = """<sdf version="1.9"><model name="m"><link name="arm"><inertial>
<pose degrees="true">1 2 3 90 0 0</pose>
<mass>4</mass><inertia><ixx>1</ixx><iyy>2</iyy><izz>3</izz><ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia>
</inertial></link></model></sdf>"""
_MJCF = """<mujoco><compiler angle="radian" eulerseq="XYZ" inertiagrouprange="0 3" settotalmass="2"/>
<default><geom density="500"/><default class="a"><geom type="box" size="1 2 3"/></default></default>
<worldbody><body childclass="a"><geom euler="0 0 1" pos="1 0 0"/><frame axisangle="0 0 1 2">
<geom class="main" type="capsule" size=".1" fromto="0 0 0 0 0 1" mass="2"/></frame>
<body><inertial pos="0 0 0" mass="1" fullinertia="1 1 1 0 0 0"/></body></body></worldbody></mujoco>"""


def _robots(folder: Path) -> Iterator[bytes]:
    bodies = {"wheel": ph.Body.disc(0.5, mass=2), "axle": ph.Body.cylinder(0.05, 1, mass=3)}
    for write in (ph.io.write_urdf, ph.io.write_mjcf):
        write(bodies, folder / "robot.xml")
        yield (folder / "robot.xml").read_bytes()
    yield from (_SDF.encode(), _MJCF.encode())


def _measured(_: Path) -> Iterator[bytes]:
    yield b"t,wx,wy,wz\n0,1,2,3\n1,1,2,3\n2,1,2,3\n3,1,2,3\n"
    yield b'"t";"qw";"qx";"qy";"qz"\n# note\n0;1;0;0;0\n1;1;0;0;0\n2;1;0;0;0\n'


_SCENE = """body.moments = [1, 2, 3]
initial.spin = { vector = [0, 0, 1] }
torque.damping = 0.1
run = { duration = 1, samples = 3 }
"""


def _read_bodies(path: Path) -> Any:
    scene = path.with_name("scene.toml")
    scene.write_text(f'{_SCENE}ensemble.table = "{path.name}"\n')
    return ph.Scene.read(scene)


def _bodies(suffix: str) -> Callable[[Path], Iterator[bytes]]:
    def seeds(folder: Path) -> Iterator[bytes]:
        frame = pd.DataFrame({"torque.damping": [0.1, 0.2], "initial.spin.vector[0]": ["1", "2 rev/s"]})
        path = folder / f"bodies.{suffix}"
        frame.to_csv(path, index=False) if suffix == "csv" else frame.to_parquet(path, index=False)
        yield path.read_bytes()

    return seeds


def _store(folder: Path) -> Iterator[bytes]:
    scene, store = folder / "scene.toml", folder / "store.zarr"
    scene.write_text(_SCENE + 'ensemble = { number = 2, attitude = "uniform" }\n')
    ph.Scene.read(scene).run(store=store)
    for path in sorted(store.rglob("*")):
        if path.is_file():
            yield path.relative_to(store).as_posix().encode() + b"\n" + path.read_bytes()


@functools.cache
def _kernels() -> list[str]:
    """Return the paths of leapseconds, clock and frames of a spacecraft."""
    paths = [f"{_FOLDER.name}/spacecraft.{suffix}" for suffix in ("tls", "tsc", "tf")]
    Path(paths[0]).write_text(_LEAPSECONDS)
    ph.io.write_sclk(paths[1], clock=-999, epoch=_EPOCH)
    ph.io.write_fk(paths[2], [ph.io.CkFrame("BODY", number=-999000, clock=-999, center=-999)])
    return paths


def _read_ck(path: Path) -> Any:
    return ph.io.read_ck(path, kernels=_kernels())


def _ck(folder: Path) -> Iterator[bytes]:
    inertia, path = ph.Inertia.from_principal_moments(1, 2, 3), folder / "motion.bc"
    motion = ph.simulate(inertia, ph.State(ph.Rotor.identity(), [0.1, 2, 0.3]), [0, 1, 2])
    frames = {"reference_frame": "J2000", "body_frame": "BODY"}
    ph.io.write_ck(motion, path, kernels=_kernels(), epoch=_EPOCH, **frames)
    yield path.read_bytes()


def _read_aem_as_stated(path: Path) -> Any:
    return ph.io.read_aem(path, segment=1, epoch=_EPOCH, quaternion_type="LAST", attitude_dir="A2B")


def _of_body(read: Callable[..., Any]) -> tuple[Callable[[Path], Any], ...]:
    return read, lambda path: read(path, body=1)


TARGETS = {
    "aem": Target("aem", (ph.io.read_aem, _read_aem_as_stated), _motions("aem")),
    "ck": Target("bc", (_read_ck,), _ck),
    "robots": Target("xml", (bodies_of,), _robots),
    "csv": Target("csv", _of_body(ph.io.read_csv), _motions("csv")),
    "parquet": Target("parquet", _of_body(ph.io.read_parquet), _motions("parquet")),
    "netcdf": Target("nc", (*_of_body(ph.io.read_netcdf), ph.Trajectory.read), _motions("nc")),
    "parquet-fields": Fields("parquet", _of_body(ph.io.read_parquet), _motions("parquet"), fields.parquet),
    "netcdf-fields": Fields(
        "nc", (*_of_body(ph.io.read_netcdf), ph.Trajectory.read), _motions("nc"), fields.netcdf
    ),
    "zarr": Store("zarr", _of_body(ph.io.read_zarr), _store),
    "measured": Target("csv", (lambda path: read_tables(path, None),), _measured),
    "bodies-csv": Target("csv", (_read_bodies,), _bodies("csv")),
    "bodies-parquet": Target("parquet", (_read_bodies,), _bodies("parquet")),
}
