"""The benchmarks measure the same work, and say what they could not measure."""

import json
import os
import sys
import threading

import numpy as np
import pytest

import algebras
import batches
import compiled
import machine
import report
import single
from contest import OURS, Pace, Row

TINY = Pace(span=1e-5, rounds=1, batch=2 * batches.OBJECTS, limit=0.1)


@pytest.mark.parametrize("topic", [single, batches, compiled, algebras], ids=lambda topic: topic.__name__)
def test_all_that_is_installed_agrees(topic, monkeypatch):
    # JAX starts threads, and from then on warns of every fork.
    monkeypatch.setitem(sys.modules, "jax", None)
    for row in topic.rows(np.random.default_rng(1), TINY):
        known = ("not installed", "not available")
        unexplained = [note for note in row.notes.values() if not note.startswith(known)]
        assert not unexplained, row.what
        assert OURS in row.entries or OURS in row.notes


def outcomes():
    row = Row("2 + 2", goal="1 ns", traffic=24)
    row.enter(OURS, "x + x", {"x": 2.0}, lambda x: x)
    row.enter("NumPy", "2 * x", {"x": 2.0}, lambda x: x)
    with row.peer("clifford"):
        row.enter("clifford", "x * x * x", {"x": 2.0}, lambda x: x)
    with row.peer("kingdon"):
        raise ModuleNotFoundError("No module named 'kingdon'")
    return row


def test_wrong_and_missing_peers_are_notes():
    row = outcomes()
    assert set(row.entries) == {OURS, "NumPy"}
    assert row.notes == {
        "clifford": "ValueError: disagrees by 1.0e+00 of the largest",
        "kingdon": "not installed (No module named 'kingdon')",
    }


def test_we_may_not_disagree():
    row = Row("3", expected=np.array(3.0))
    with pytest.raises(ValueError, match="disagrees"):
        row.enter(OURS, "4", {}, lambda x: x)


def test_measuring_gives_seconds_per_result():
    row = outcomes()
    row.measure(TINY)
    row.release()
    assert set(row.seconds) == {OURS, "NumPy"}
    assert all(0 < seconds < 1 for seconds in row.seconds.values())
    assert row.entries["NumPy"].names == {}


def test_the_table_keeps_its_layout():
    row = outcomes()
    row.seconds = {OURS: 4e-9, "NumPy": 123.4e-9}
    assert report.section("Sums", [row], bandwidth=24e9) == (
        "## Sums\n"
        "\n"
        "|       | unit | polhode | NumPy | memory | peer/ours | goal |\n"
        "| ----- | ---: | ------: | ----: | -----: | --------: | ---: |\n"
        "| 2 + 2 |   ns |    4.00 |   123 |   1.00 |     30.9× | 1 ns |\n"
        "\n"
        "- clifford: ValueError: disagrees by 1.0e+00 of the largest (2 + 2)\n"
        "- kingdon: not installed (No module named 'kingdon') (2 + 2)\n"
    )


def test_the_data_are_json():
    row = outcomes()
    row.seconds = {OURS: 4e-9}
    found = json.loads(report.data({"commit": "abc"}, {"Sums": [row]}))
    assert found["commit"] == "abc"
    assert found["rows"][0]["seconds"] == {OURS: 4e-9}
    assert found["rows"][0]["expressions"] == {OURS: "x + x", "NumPy": "2 * x"}


@pytest.mark.skipif(not machine.PINS, reason="threads cannot be pinned here")
def test_on_one_core_all_threads_are():
    allowed, seen, go = os.sched_getaffinity(0), [], threading.Event()

    def wait():
        go.wait(60)
        seen.append(os.sched_getaffinity(0))

    before = threading.Thread(target=wait)
    before.start()
    with machine.on_one_core():
        seen.append(os.sched_getaffinity(0))
        go.set()
        before.join()
    assert seen == [{min(allowed)}] * 2
    assert os.sched_getaffinity(0) == allowed


def test_the_machine_is_described():
    described = machine.describe()
    assert all(described.values())
    assert {"date", "commit", "processor", "cores", "memory", "system", "Python"} <= described.keys()
    assert machine.versions()["numpy"] == np.__version__
