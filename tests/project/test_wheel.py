"""The wheel, in an environment with NumPy alone and no other program; the source distribution."""

import os
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import numpy as np
import pytest

import processes
from command_line import EXAMPLES, ROOT
from viewers import needs_bundle

try:
    import fcntl
except ImportError:  # on Windows
    fcntl = None

MATURIN = Path(sys.executable).with_name("maturin")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(900),
    needs_bundle,
    pytest.mark.skipif(not MATURIN.exists(), reason="maturin is not installed"),
    pytest.mark.skipif(
        not (ROOT / ".venv/.built").exists(), reason="not built by make setup, so it takes minutes"
    ),
]


def packed(folder, *arguments):
    """The path of what maturin makes; the extension is compiled already."""
    # maturin moves files between fixed places, which other workers of the tests must not do at the same time.
    with (ROOT / "target/packing").open("w") as lock:
        if fcntl is not None:
            fcntl.flock(lock, fcntl.LOCK_EX)
        done = processes.run([MATURIN, *arguments, "--out", folder], cwd=ROOT, timeout=600)
    assert done.returncode == 0, done.stderr
    (path,) = folder.iterdir()
    return path


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    return packed(tmp_path_factory.mktemp("wheel"), "build", "--release", "--locked")


@pytest.fixture(scope="module")
def bare(wheel, tmp_path_factory):
    """Where the programs of an environment are that has the wheel and NumPy."""
    folder = tmp_path_factory.mktemp("bare")
    made = processes.run([sys.executable, "-m", "venv", "--without-pip", folder])
    assert made.returncode == 0, made.stderr
    (packages,) = folder.glob("lib/python*/site-packages")
    numpy = Path(np.__file__).parent
    for path in (numpy, numpy.with_name("numpy.libs")):
        if path.exists():
            (packages / path.name).symlink_to(path)
    pip = [sys.executable, "-m", "pip", "--python", folder / "bin/python"]
    done = processes.run([*pip, "install", "-q", "--no-deps", "--no-index", wheel])
    assert done.returncode == 0, done.stderr
    return folder / "bin"


def run(program, *arguments, cwd):
    """A program of the bare environment, with nothing else on its path."""
    return processes.run([program, *arguments], cwd=cwd, env={"PATH": str(program.parent), "HOME": str(cwd)})


def test_the_wheel_has_all_and_runs_on_any_python(wheel):
    assert "-cp311-abi3-" in wheel.name
    names = set(zipfile.ZipFile(wheel).namelist())
    files = {path.name for path in EXAMPLES.iterdir() if path.suffix in (".toml", ".stl")}
    assert {f"polhode/_examples/{name}" for name in files} <= names
    assert {
        "polhode/_viewer/viewer.js",
        "polhode/_viewer/viewer.licenses.md",
        "polhode/_viewer/page.html",
        "polhode/py.typed",
        "polhode/_native.pyi",
    } <= names
    licences = {name.rpartition("/")[2] for name in names if ".dist-info/licenses/" in name}
    assert licences == {"LICENSE-MIT", "LICENSE-APACHE", "LICENSE-THIRD-PARTY.md"}
    assert not [name for name in names if name.endswith((".pyc", ".map")) or "/tests/" in name]


def test_the_demo_in_a_bare_environment(bare, tmp_path):
    done = run(bare / "polhode", "demo", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert "9 in this run" in done.stdout
    assert "pip install 'polhode[plot]'" in done.stdout
    assert [path.name for path in tmp_path.iterdir()] == ["t-handle.html"]
    assert (tmp_path / "t-handle.html").stat().st_size > 1_000_000


def test_examples_in_a_bare_environment(bare, tmp_path):
    assert "t-handle " in run(bare / "polhode", "examples", cwd=tmp_path).stdout
    assert run(bare / "polhode", "examples", "t-handle", "earth", cwd=tmp_path).returncode == 0
    done = run(bare / "polhode", "run", "t-handle.toml", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")


def test_the_package_in_a_bare_environment(bare, tmp_path):
    code = "import polhode as ph; print(ph.__file__); print(ph.Rotor.identity())"
    done = run(bare / "python", "-W", "error", "-c", code, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith(str(bare.parent))


def test_the_source_distribution_can_be_built(tmp_path):
    """Cargo accepts its workspace, from which the crates that Python does not need are left out."""
    path = packed(tmp_path / "out", "sdist")
    with tarfile.open(path) as archive:
        archive.extractall(tmp_path, filter="data")
    (folder,) = (tmp_path / name for name in os.listdir(tmp_path) if name != "out")
    for name in (
        "_viewer/viewer.js",
        "_viewer/viewer.licenses.md",
        "_examples/t-handle.toml",
        "_examples/t-handle.stl",
        "py.typed",
    ):
        assert (folder / "python/polhode" / name).is_file(), name
    metadata = ["cargo", "metadata", "--offline", "--format-version", "1", "--manifest-path"]
    done = processes.run([*metadata, folder / "crates/py/Cargo.toml"])
    assert done.returncode == 0, done.stderr
    # Of the lock file nothing but crates that are not here was taken.
    kept, locked = (
        {(crate["name"], crate["version"]) for crate in tomllib.loads(path.read_text())["package"]}
        for path in (folder / "Cargo.lock", ROOT / "Cargo.lock")
    )
    assert kept <= locked
    assert len(kept) > 20
