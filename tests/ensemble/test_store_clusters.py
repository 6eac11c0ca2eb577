"""Stores filled by Dask clusters of processes, which are killed."""

import contextlib
import json
import pickle
import random
import signal
import socket
import sys
import threading
import time
from types import SimpleNamespace

import pytest

import polhode as ph
import processes
from command_line import POLHODE, polhode
from polhode._report.ensemble.cluster import _task
from polhode._report.ensemble.store import StoreError
from stores import TEXT, content, status

pytest.importorskip("zarr")
pytest.importorskip("xarray")
distributed = pytest.importorskip("distributed")


# A worker that takes its time for each block. Arguments: its name, its version of polhode and the
# file to which it appends its name when it begins a block, before those of dask.
WORKER = """
import sys, time
from polhode import _native
from polhode._report.ensemble import cluster
from distributed.cli.dask_worker import main
name, version, blocks, *options = sys.argv[1:]
_native.__version__ = version or _native.__version__
compute = cluster.compute_block
def slow(*arguments):
    with open(blocks, "a") as file:
        file.write(name + "\\n")
    time.sleep(0.2)
    compute(*arguments)
cluster.compute_block = slow
main(options)
"""


@contextlib.contextmanager
def scheduler(folder):
    """A scheduler, and the path of its file."""
    file = folder / "scheduler.json"
    file.unlink(missing_ok=True)  # of a scheduler that was killed
    module = ["-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard"]
    command = [sys.executable, *module, "--scheduler-file", file]
    with processes.start(command, stdout=processes.DEVNULL, stderr=processes.DEVNULL) as process:
        until(lambda: is_json(file))
        yield process, file


def is_json(file):
    """Whether the file is there and has been written to its end."""
    try:
        return bool(json.loads(file.read_text()))
    except (FileNotFoundError, ValueError):
        return False


@contextlib.contextmanager
def workers(folder, file, *names, version=""):
    """Workers with one thread each, without a nanny that starts them again.

    All are connected at the start of the block: one that starts faster than the others could compute
    all blocks before they ask for one.
    """
    options = ["--scheduler-file", file, "--nthreads", "1", "--no-nanny", "--no-dashboard"]
    options += ["--local-directory", folder / "dask"]
    quiet = {"stdout": processes.DEVNULL, "stderr": processes.DEVNULL}
    with contextlib.ExitStack() as stack:
        found = []
        for name in names:
            command = [sys.executable, "-c", WORKER, name, version, folder / "blocks", *options]
            found.append(stack.enter_context(processes.start(command, **quiet)))
        with distributed.Client(scheduler_file=file, set_as_default=False) as client:
            client.wait_for_workers(len(names), timeout=60)
        yield found


def begun(folder):
    """The workers of the blocks that have been begun."""
    with contextlib.suppress(FileNotFoundError):
        return (folder / "blocks").read_text().split()
    return []


def run(folder, store, cluster):
    """The command that fills a store."""
    scene = folder / "a.toml"
    return processes.start([POLHODE, "run", scene, "-o", store, "--resume", "--cluster", cluster])


def until(happens, seconds=60.0):
    end = time.monotonic() + seconds
    while not happens():
        assert time.monotonic() < end, "it did not happen"
        time.sleep(0.02)


def resumed(folder, store):
    """Resume a store without a cluster, and return its content."""
    done = polhode("run", folder / "a.toml", "-o", store, "--resume")
    assert done.returncode == 0, done.stderr
    return content(store)


def test_local_processes_fill_a_store_with_the_same_bits(folder, serial, tmp_path):
    """Also while the usual port of Dask is in use."""
    with socket.socket() as other:
        with contextlib.suppress(OSError):
            other.bind(("127.0.0.1", 8787))
            other.listen()
        done = polhode("run", folder / "a.toml", "-o", tmp_path / "a.zarr", "--cluster", "local:2")
    assert (done.returncode, done.stderr) == (0, "")
    assert content(tmp_path / "a.zarr") == serial
    assert status(tmp_path / "a.zarr")["running"] == []


def test_the_blocks_of_a_killed_worker_are_computed_by_others(folder, serial, tmp_path):
    store = tmp_path / "a.zarr"
    with (
        scheduler(tmp_path) as (_, file),
        workers(tmp_path, file, "first", "second") as (first, _),
        run(folder, store, file) as client,
    ):
        until(lambda: "first" in begun(tmp_path))
        first.kill()
        output, errors = client.communicate(timeout=120)
    assert client.returncode == 0, errors
    assert "2000 of 2000 bodies" in output
    assert content(store) == serial


@pytest.mark.slow
def test_a_worker_of_another_version_is_refused(folder, serial, tmp_path):
    store = tmp_path / "a.zarr"
    with (
        scheduler(tmp_path) as (_, file),
        workers(tmp_path, file, "other", version="9.9.9"),
        run(folder, store, file) as client,
    ):
        _, errors = client.communicate(timeout=120)
    assert client.returncode == 1
    assert "polhode: error: worker tcp://127.0.0.1:" in errors
    assert "was begun with another version of polhode: " in errors
    assert ", here 9.9.9; continue it as it was begun" in errors
    assert status(store)["missing"] == 4
    assert resumed(folder, store) == serial


def test_a_cluster_needs_a_scene_file(tmp_path):
    done = polhode("run", "-", "-o", "a.zarr", "--cluster", "local:1", cwd=tmp_path, input=TEXT)
    assert done.returncode == 1
    assert "workers of a cluster read the scene from its file, and " in done.stderr
    assert not list(tmp_path.iterdir())


def test_the_error_of_a_worker_without_the_scene_can_be_sent(serial, folder, tmp_path, monkeypatch):
    """Dask pickles an error with its context."""
    monkeypatch.setattr(distributed, "get_worker", lambda: SimpleNamespace(address="tcp://far:1"))
    with pytest.raises(StoreError, match=r"worker tcp://far:1: .*none.toml: error: no such file") as caught:
        _task(str(folder / "serial.zarr"), str(tmp_path / "none.toml"), [0.0, 1.0], 0, 1)
    assert caught.value.__context__ is None
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)


@pytest.mark.parametrize(
    ("cluster", "message"),
    [
        ("local:0", "got 'local:0'"),
        ("local:many", "got 'local:many'"),
        ("nowhere.json", "no cluster at nowhere.json: no such file"),
        (
            "{folder}/a.toml.json",
            "a.toml.json: not the file of a scheduler; `dask scheduler --scheduler-file",
        ),
        ("tcp:/nonsense", "no cluster at tcp:/nonsense: "),
        ("host:port", "no cluster at host:port: not an address such as tcp://10.0.0.1:8786"),
    ],
)
def test_addresses_of_no_cluster(cluster, message, folder, tmp_path):
    cluster = cluster.format(folder=tmp_path)
    (tmp_path / "a.toml.json").write_text('{"port": 8786}')
    done = polhode("run", folder / "a.toml", "-o", tmp_path / "a.zarr", "--cluster", cluster)
    assert done.returncode == 1
    assert message in done.stderr
    assert (tmp_path / "a.zarr").exists() == cluster.startswith(("tcp", "host"))


def test_a_server_of_another_protocol_is_not_a_cluster(folder, tmp_path):
    """Such as the port of the dashboard: the first bytes of its answer are read as the size of a message."""
    with contextlib.ExitStack() as opened:
        server = opened.enter_context(socket.create_server(("127.0.0.1", 0)))

        def answer():
            with contextlib.suppress(OSError):
                while True:
                    client = opened.enter_context(server.accept()[0])
                    client.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n")

        threading.Thread(target=answer, daemon=True).start()
        address = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        done = polhode("run", folder / "a.toml", "-o", tmp_path / "a.zarr", "--cluster", address)
    assert done.returncode == 1
    assert f"no cluster at {address}: a program answers there, but it is not a scheduler" in done.stderr


@pytest.mark.slow
def test_a_killed_cluster_resumes_reduced_outputs(tmp_path):
    """All programs are killed; the quantiles of the resumed store are those of all blocks."""
    (tmp_path / "a.toml").write_text(f'{TEXT}keep = ["last", "extrema", "quantiles"]\n')
    ph.Scene.read(tmp_path / "a.toml").run(store=tmp_path / "serial.zarr", threads=1).close()
    serial, store = content(tmp_path / "serial.zarr"), tmp_path / "a.zarr"
    with (
        scheduler(tmp_path) as (process, file),
        workers(tmp_path, file, "first", "second") as (first, second),
        run(tmp_path, store, file) as client,
    ):
        until(lambda: len(begun(tmp_path)) >= 3)  # two workers have computed at least one block
        for program in (process, first, second, client):
            program.kill()
            program.wait()
    found = status(store)
    assert (found["corrupt"], found["running"]) == (0, [])
    assert found["done"] > 0
    with (
        scheduler(tmp_path) as (_, file),
        workers(tmp_path, file, "third"),
        run(tmp_path, store, file) as client,
    ):
        _, errors = client.communicate(timeout=120)
    assert client.returncode == 0, errors
    assert content(store) == serial


CHANCES = [pytest.param(seed, marks=pytest.mark.slow) for seed in range(5)]


@pytest.mark.parametrize("seed", CHANCES)
@pytest.mark.parametrize("who", ["scheduler", "client", "all"])
def test_a_killed_cluster_loses_the_blocks_in_flight_only(who, seed, folder, serial, tmp_path):
    store, chance = tmp_path / "a.zarr", random.Random(seed)
    with (
        scheduler(tmp_path) as (process, file),
        workers(tmp_path, file, "first", "second") as (first, second),
        run(folder, store, file) as client,
    ):
        until(lambda: begun(tmp_path))
        time.sleep(chance.uniform(0.0, 0.6))
        killed = {"scheduler": [process], "client": [client], "all": [process, first, second, client]}[who]
        for program in killed:
            program.kill()
        _, errors = client.communicate(timeout=120)
        if who == "scheduler" and client.returncode:
            assert client.returncode == 1
            assert "polhode: error: " in errors
            assert "continue with resume (--resume)" in errors
        # The workers may still compute a block whose client has ended.
        for program in (first, second):
            program.kill()
            program.wait()
        found = status(store)
        assert (found["corrupt"], found["running"]) == (0, [])
        assert resumed(folder, store) == serial


@pytest.mark.slow
def test_ctrl_c_ends_a_local_cluster(folder, serial, tmp_path):
    store = tmp_path / "a.zarr"
    with run(folder, store, "local:2") as client:
        until(
            lambda: (store / ".polhode" / "locks").exists() and any((store / ".polhode" / "locks").iterdir())
        )
        time.sleep(2.0)  # the workers start
        if client.poll() is None:
            client.send_signal(signal.SIGINT)
        _, errors = client.communicate(timeout=120)
    # A signal while Python exits ends it with the signal, which a shell shows as 130 too.
    assert client.returncode in (0, 130, -signal.SIGINT), errors
    assert status(store)["running"] == []
    assert resumed(folder, store) == serial
