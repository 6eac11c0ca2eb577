"""Zarr stores of ensembles: the layout of the netCDF file, resumed runs, and faults."""

import contextlib
import itertools
import json
import os
import random
import signal
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import polhode as ph
import processes
from command_line import POLHODE, SCENE, polhode
from stores import NUMBER, TEXT, content, status

pytest.importorskip("zarr")
xr = pytest.importorskip("xarray")


@pytest.fixture(scope="module")
def scene(folder):
    return ph.Scene.read(folder / "a.toml")


def test_a_store_has_the_layout_of_the_netcdf_file(scene, folder, serial):
    assert polhode("run", folder / "a.toml", "--no-figures", "-o", folder / "a.nc").returncode == 0
    with xr.open_dataset(folder / "a.nc") as file, xr.open_zarr(folder / "serial.zarr", chunks=None) as store:
        assert set(store.variables) == set(file.variables)
        for name in file.variables:
            got, expected = store[name], file[name]
            assert got.dims == expected.dims
            units = ("units", "long_name", "axis")
            assert {k: got.attrs.get(k) for k in units} == {k: expected.attrs.get(k) for k in units}
            if name != "method":  # codes: the file lists the methods that occur
                np.testing.assert_array_equal(got.values, expected.values)
        assert store.attrs == {name: getattr(x, "item", lambda x=x: x)() for name, x in file.attrs.items()}
        methods = store.method.attrs["flag_meanings"].split()
        assert {methods[code + 1] for code in store.method.values} == {file.method.attrs["flag_meanings"]}
        # Chunks are blocks.
        assert store.attitude.encoding["chunks"] == (scene.block, 11, 4)


def test_run_returns_the_motions_of_all_bodies(scene, folder):
    reports = []
    with scene.run(lambda *x: reports.append(x), store=folder / "b.zarr") as data:
        whole = scene.run()
        np.testing.assert_array_equal(data.attitude, whole.rotor.to_quaternion(order="wxyz"))
        np.testing.assert_array_equal(data.omega_body, whole.omega_body.components)
        np.testing.assert_array_equal(data.inertia, [inertia.matrix for inertia in whole.inertia])
        for name, arguments in scene.ensemble.laws():
            own = [key for key in data.data_vars if str(key).partition("_")[0] == name]
            for key, values in zip(own, arguments, strict=True):
                np.testing.assert_array_equal(data[key], values)
        assert data.attrs["bodies_complete"] == NUMBER
    assert reports[-1] == (1, 1.0)
    assert [x for _, x in reports] == sorted(x for _, x in reports)


def test_ranges_filled_by_processes_at_once_are_the_serial_store(folder, serial):
    """As the tasks of a Slurm array; the bounds lie inside blocks."""
    store, bounds = folder / "ranges.zarr", [0, 700, 1300, NUMBER]
    pieces = list(itertools.pairwise(bounds))[::-1]
    command = [POLHODE, "run", folder / "a.toml", "-o", store, "--threads", "1"]
    with contextlib.ExitStack() as stack:
        tasks = [
            stack.enter_context(processes.start([*command, "--bodies", f"{first}:{end}"]))
            for first, end in pieces
        ]
        for task in tasks:
            output, errors = task.communicate()
            assert task.returncode == 0, errors
            assert output.startswith(f"{store}: ")
    assert content(store) == serial
    assert status(store)["running"] == []


def test_failed_bodies_are_listed_whatever_the_order(tmp_path):
    # Too few steps for fast bodies.
    (tmp_path / "a.toml").write_text(TEXT + "[method]\nmax_steps = 15\n")
    scene = ph.Scene.read(tmp_path / "a.toml")
    whole = scene.run()
    failed = [failure.index[0] for failure in whole.failures]
    assert 0 < len(failed) < NUMBER
    stores = {"forth": [None], "back": [(1024, NUMBER), (0, 1024)]}
    for name, ranges in stores.items():
        for bodies in ranges:
            scene.run(store=tmp_path / name, bodies=bodies).close()
    assert content(tmp_path / "forth") == content(tmp_path / "back")
    with xr.open_zarr(tmp_path / "forth", chunks=None) as data:
        assert data.failure_body.values.tolist() == failed
        assert data.failure_message.values.tolist() == [failure.message for failure in whole.failures]
        np.testing.assert_array_equal(np.flatnonzero(data.failed), failed)
        assert (data.method.values[failed] == -1).all()


# --- what --resume does


@pytest.mark.parametrize(
    "damaged",
    [
        "attitude/c.1.0.0",
        ".polhode/blocks/1.json",
        "omega_body/zarr.json",
        "time/c.0",
        "body/zarr.json",
        "zarr.json",
    ],
)
@pytest.mark.parametrize("how", ["flipped", "cut", "removed"])
def test_what_is_damaged_is_found_and_written_again(damaged, how, scene, folder, serial, tmp_path):
    store = tmp_path / "a.zarr"
    for name, data in serial.items():
        (store / name).parent.mkdir(parents=True, exist_ok=True)
        (store / name).write_bytes(data)
    (store / ".polhode" / "parts").mkdir()
    path, data = store / damaged, serial[damaged]
    middle = len(data) // 2
    flipped = data[:middle] + bytes([data[middle] ^ 1]) + data[middle + 1 :]
    if how == "removed":
        path.unlink()
    else:
        path.write_bytes({"flipped": flipped, "cut": data[:middle]}[how])
    scene.run(store=store, resume=True).close()
    assert content(store) == serial


def test_only_what_is_not_done_is_computed(scene, folder, serial, monkeypatch, tmp_path):
    store = tmp_path / "a.zarr"
    scene.run(store=store, bodies=(512, 1536)).close()
    assert status(store)["bodies"] == {
        "done": [[512, 1536]],
        "missing": [[0, 512], [1536, NUMBER]],
        "corrupt": [],
    }
    chunk = store / "energy" / "c.1.0"
    chunk.write_bytes(bytes(len(chunk.read_bytes())))
    assert status(store)["bodies"] == {
        "done": [[1024, 1536]],
        "missing": [[0, 512], [1536, NUMBER]],
        "corrupt": [[512, 1024]],
    }
    computed, drawn = [], ph.Scene._drawn

    def counted(self, rows, *rest):
        computed.append((rows.start, rows.stop))
        return drawn(self, rows, *rest)

    monkeypatch.setattr(ph.Scene, "_drawn", counted)
    scene.run(store=store, resume=True).close()
    assert computed == [(0, 512), (512, 1024), (1536, NUMBER)]
    scene.run(store=store, resume=True).close()
    assert len(computed) == 3
    assert content(store) == serial


def test_an_unfinished_store_can_be_read(scene, tmp_path):
    with scene.run(store=tmp_path / "a.zarr", bodies=(512, 1024)) as data:
        assert np.isfinite(data.energy[512:1024]).all()
        assert np.isnan(data.energy[:512]).all()
        assert "bodies_complete" not in data.attrs


# --- what is refused


def test_another_scene_is_refused(scene, folder, serial, tmp_path):
    store = folder / "serial.zarr"
    for old, new, what in (
        ("seed = 5", "seed = 6", "scene"),
        ("moments = [1, 2, 3]", "moments = [1, 2, 2.9]", "scene"),
    ):
        (tmp_path / "b.toml").write_text(TEXT.replace(old, new))
        done = polhode("run", tmp_path / "b.toml", "-o", store, "--resume")
        assert done.returncode == 1
        assert f"{store} was begun with another {what}" in done.stderr
    for option in (("--bodies", "0:1"), ("--resume",)):
        done = polhode("run", tmp_path / "b.toml", "-o", store, "--force", *option)
        assert done.returncode == 1
        assert f"--force does not replace a store with {option[0]}: delete {store} first" in done.stderr
    with pytest.raises(ValueError, match="was begun with another output times"):
        replace(scene, times=scene.times * 2).run(store=store, resume=True)
    assert content(store) == serial


def test_another_version_is_refused(scene, folder, serial, monkeypatch):
    monkeypatch.setattr("polhode._native.__version__", "9.9.9")
    with pytest.raises(ValueError, match=r"another version of polhode: 0\.\d+\.\d+, here 9\.9\.9; continue"):
        scene.run(store=folder / "serial.zarr", resume=True)


def test_an_existing_store_is_refused_without_resume(folder, serial):
    store = folder / "serial.zarr"
    done = polhode("run", folder / "a.toml", "-o", store)
    assert done.returncode == 1
    assert "exists: continue it with resume (--resume)" in done.stderr
    assert content(store) == serial


def test_force_replaces_a_store_and_no_other_folder(folder, serial, tmp_path):
    (tmp_path / "a.toml").write_text(TEXT)
    (tmp_path / "b.toml").write_text(TEXT.replace("seed = 5", "seed = 6"))
    store = tmp_path / "a.zarr"
    assert polhode("run", tmp_path / "b.toml", "-o", store, "--bodies", "0:1").returncode == 0
    assert polhode("run", tmp_path / "a.toml", "-o", store, "--force").returncode == 0
    assert content(store) == serial
    (tmp_path / "other.zarr").mkdir()
    (tmp_path / "other.zarr" / "precious").write_text("")
    done = polhode("run", tmp_path / "a.toml", "-o", tmp_path / "other.zarr", "--force")
    assert done.returncode == 1
    assert "exists and is not a store of polhode" in done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.toml", "a.zarr", "b.toml", "other.zarr"]


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (("a.toml", "-o", "a.nc", "--resume"), 2, "--resume needs a store: -o FILE.zarr"),
        (("a.toml", "-o", "a.zarr", "--bodies", "5:5"), 2, "expected A:B, such as 0:5000, with A below B"),
        (
            ("a.toml", "-o", "a.zarr", "--bodies", "5:2001"),
            1,
            "range 5:2001 of bodies is out of bounds for 2000",
        ),
        (("a.toml", "-o", "a.csv"), 1, "written as netCDF or, of any size, as a Zarr store; use -o a.nc or"),
        (("one.toml", "-o", "a.zarr"), 1, "this scene has no table [ensemble]"),
        (("--status", "a.zarr"), 3, "a.zarr: error: no such store"),
        (("--status", "."), 3, ".: error: is not a store of an ensemble that polhode wrote: it has no"),
        (("--status", "a.toml"), 3, "a.toml: error: is a file, and the store of an ensemble is a folder"),
        (("--status", "a.zarr", "a.toml"), 2, "--status takes a store and no scene: leave out a.toml"),
        (("--status", "a.zarr", "-o", "b.zarr", "--resume"), 2, "leave out --output, --resume"),
        (("--status", "a.zarr", "--no-figures"), 2, "--status computes nothing: leave out --no-figures"),
        ((), 2, "the following arguments are required: SCENE.toml"),
    ],
)
def test_wrong_usage(arguments, code, message, tmp_path):
    (tmp_path / "a.toml").write_text(TEXT)
    (tmp_path / "one.toml").write_text(SCENE)
    done = polhode("run", *arguments, cwd=tmp_path)
    assert done.returncode == code
    assert message in done.stderr
    assert "Errno" not in done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.toml", "one.toml"]


def test_resume_and_bodies_need_a_store(scene):
    with pytest.raises(ValueError, match="resume, bodies and cluster need a store"):
        scene.run(resume=True)


# --- two runs on one store

# Holds a store as a run does, until its input ends.
HOLD = """
import sys
from pathlib import Path
from polhode._report.ensemble.store import EnsembleStore
with EnsembleStore.open(Path(sys.argv[1])).locked(range(1, 3)):
    print("held", flush=True)
    sys.stdin.read()
"""


def test_two_runs_on_the_same_bodies_are_refused(folder, serial):
    store = folder / "serial.zarr"
    with processes.start([sys.executable, "-c", HOLD, store], stdin=processes.PIPE) as other:
        assert other.stdout.readline() == "held\n"
        done = polhode("run", folder / "a.toml", "-o", store, "--resume")
        assert done.returncode == 1
        assert f"{store} is in use by process {other.pid} on " in done.stderr
        assert "which computes bodies 512:1536" in done.stderr
        (user,) = status(store)["running"]
        assert (user["bodies"], user["process"]) == ([512, 1536], other.pid)
        # Blocks that the other does not compute are free.
        assert polhode("run", folder / "a.toml", "-o", store, "--bodies", "0:512").returncode == 0
        other.kill()
        other.wait()
        # The lock of a dead process is stale.
        assert list((store / ".polhode" / "locks").iterdir())
        assert polhode("run", folder / "a.toml", "-o", store, "--resume").returncode == 0
    assert not list((store / ".polhode" / "locks").iterdir())
    assert content(store) == serial


@pytest.mark.parametrize(("host", "refused"), [("elsewhere", True), (os.uname().nodename, False)])
def test_a_process_on_another_machine_may_live(host, refused, scene, folder, serial):
    """On this one, a process of the same number that started at another time is another process."""
    lock = {"first": 0, "end": 10, "host": host, "pid": os.getpid(), "started": "another boot 1"}
    path = folder / "serial.zarr" / ".polhode" / "locks" / "0-10.x.lock"
    path.write_text(json.dumps(lock))
    try:
        if refused:
            with pytest.raises(
                OSError, match=f"process {os.getpid()} on elsewhere.* or delete .*0-10.x.lock"
            ):
                scene.run(store=folder / "serial.zarr", resume=True)
        else:
            scene.run(store=folder / "serial.zarr", resume=True).close()
            assert not path.exists()
    finally:
        path.unlink(missing_ok=True)


# --- runs that end early

# Limits the size of files to the first argument, as on a full disk, and runs a program.
LIMITED = """
import os, resource, signal, sys
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
size = int(sys.argv[1])
resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
os.execv(sys.argv[2], sys.argv[2:])
"""


# The largest chunk, attitudes, has 180 kB; a lock has more than 50 bytes.
@pytest.mark.parametrize("size", ["100000", "50"])
def test_a_full_disk_keeps_the_complete_blocks(size, folder, serial, tmp_path):
    store = tmp_path / "a.zarr"
    assert polhode("run", folder / "a.toml", "-o", store, "--bodies", "0:1000").returncode == 0
    before = content(store)
    through = [sys.executable, "-c", LIMITED, size]
    done = polhode("run", folder / "a.toml", "-o", store, "--resume", through=through)
    assert done.returncode == 1
    assert f"polhode: error: cannot write {store}: File too large" in done.stderr
    assert "a.zarr has 1024 of 2000 bodies; continue with resume (--resume)" in done.stderr
    assert content(store) == before
    assert not list((store / ".polhode" / "parts").iterdir())
    assert not list((store / ".polhode" / "locks").iterdir())
    assert polhode("run", folder / "a.toml", "-o", store, "--resume").returncode == 0
    assert content(store) == serial


def test_a_store_that_cannot_be_begun(folder, tmp_path):
    through = [sys.executable, "-c", LIMITED, "100"]
    done = polhode("run", folder / "a.toml", "-o", tmp_path / "a.zarr", through=through)
    assert done.returncode == 1
    assert f"cannot write {tmp_path / 'a.zarr'}: File too large" in done.stderr
    assert list(tmp_path.iterdir()) == []


# Runs the command with a pause after each block, so that signals come at any stage.
SLOWLY = """
import sys, time
from polhode._cli.main import main
from polhode._report.ensemble import fill
compute = fill.compute_block
def slow(*arguments):
    print("block", flush=True)
    time.sleep(0.05)
    compute(*arguments)
fill.compute_block = slow
raise SystemExit(main())
"""


def slowly(folder, store):
    return [sys.executable, "-c", SLOWLY, "run", folder / "a.toml", "-o", store, "--resume", "--threads", "1"]


def test_ctrl_c_keeps_the_complete_blocks(folder, serial, tmp_path):
    store = tmp_path / "a.zarr"
    with processes.start(slowly(folder, store)) as process:
        for _ in range(3):
            assert process.stdout.readline() == "block\n"
        _, errors = processes.interrupted(process, lambda: process.send_signal(signal.SIGINT))
    assert process.returncode == 130
    assert f"interrupted; {store} has " in errors
    assert "Traceback" not in errors
    found = status(store)
    assert found["done"] >= 2
    assert (found["corrupt"], found["running"]) == (0, [])
    assert not list((store / ".polhode" / "parts").iterdir())
    assert polhode("run", folder / "a.toml", "-o", store, "--resume").returncode == 0
    assert content(store) == serial


def kill_once(folder, store, delay):
    """Kill a run after it began a block, `delay` seconds later; return whether it was still running."""
    with processes.start(slowly(folder, store)) as process:
        if process.stdout.readline() != "block\n":
            return False  # all blocks were done
        time.sleep(delay)
        alive = process.poll() is None
        process.kill()
    return alive


@pytest.mark.parametrize("seed", [1, *(pytest.param(n, marks=pytest.mark.slow) for n in range(2, 21))])
def test_a_killed_run_is_resumed(seed, folder, serial, tmp_path):
    store, chance = tmp_path / "a.zarr", random.Random(seed)
    for _ in range(3):
        done = status(store)["done"] if store.exists() else 0
        kill_once(folder, store, chance.uniform(0.0, 0.3))
        found = status(store)
        # A kill loses the block in flight only: what was done stays done, and no chunk is half written.
        assert found["done"] >= done
        assert found["corrupt"] == 0
        assert found["running"] == []
    assert polhode("run", folder / "a.toml", "-o", store, "--resume").returncode == 0
    assert content(store) == serial
    assert not list((store / ".polhode" / "parts").iterdir())
    assert sorted(path.name for path in Path(tmp_path).iterdir()) == ["a.zarr"]
