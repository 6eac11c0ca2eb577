"""The benchmarks measure the same work, and report what they could not measure."""

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
import truth
import work_precision
from contest import OURS, Pace, Row
from integrators import Setting
from work_precision import FREE, KOVALEVSKAYA, LAGRANGE, Mark, Panel

TINY = Pace(span=1e-5, rounds=1, batch=2 * batches.OBJECTS, limit=0.1)


@pytest.mark.parametrize("topic", [single, batches, compiled, algebras], ids=lambda topic: topic.__name__)
def test_installed_libraries_agree(topic, monkeypatch):
    # JAX starts threads, and from then on warns of every fork.
    monkeypatch.setitem(sys.modules, "jax", None)
    for row in topic.rows(np.random.default_rng(1), TINY):
        known = ("not installed", "not available")
        unexplained = [note for note in row.notes.values() if not note.startswith(known)]
        assert not unexplained, row.what
        assert OURS in row.entries or OURS in row.notes


EXTENDED = np.finfo(np.longdouble).eps


@pytest.mark.parametrize(
    ("top", "name"), [(FREE, "dzhanibekov_001"), (LAGRANGE, "lagrange_loop"), (KOVALEVSKAYA, "kovalevskaya")]
)
def test_the_truth_is_that_of_the_reference(top, name):
    cases = json.loads(work_precision.REFERENCES.read_text())
    (case,) = (case for kind in ("free_top", "torqued") for case in cases[kind] if case["name"] == name)
    near = [result for result in case["results"] if float(result["t"]) <= 100]
    found = truth.rotors([top], [float(result["t"]) for result in near])
    for rotors, result in zip(found, near, strict=True):
        expected = np.array([np.longdouble(x) for x in result["R"]])
        # Rounding of 200 steps, which the flips of the free top magnify 1/0.01 times.
        assert np.abs(rotors[0] - expected).max() < 200 * 100 * EXTENDED


def test_the_reference_rejects_a_step_that_is_too_long():
    fast = truth.Top("fast", (1, 2, 3), (0, 0, 0), (30, 20, 10), (1, 0, 0, 0))
    with pytest.raises(ValueError, match="take a smaller step"):
        truth.rotors([fast], [1.0])
    with pytest.raises(ValueError, match="no rising multiple"):
        truth.rotors([FREE], [0.7])


@pytest.mark.filterwarnings("ignore:with step = .* the body turns")
@pytest.mark.parametrize("top", work_precision.TOPS, ids=lambda top: top.name)
def test_all_integrators_move_the_same_top(top, monkeypatch):
    monkeypatch.setitem(sys.modules, "jax", None)
    (panel,) = work_precision.panels(TINY, (top,), (1.0,))
    assert all(note.startswith("not installed") for note in panel.notes.values()), panel.notes
    # Steps of 0.1 are off by some 0.02 at most; wrong axes, signs or a wrong torque by 1.
    assert all(mark.error < 0.1 for mark in panel.marks if not mark.setting.endswith(("0.4", "0.2")))
    for tool in {mark.tool for mark in panel.marks}:
        assert min(mark.error for mark in panel.marks if mark.tool == tool) < 1e-9, tool


def test_slow_settings_are_left_out_of_longer_runs(monkeypatch):
    still = truth.Top("still", (1, 1, 1), (0, 0, 0), (0, 0, 0), (1, 0, 0, 0))

    def tool(top, notes):
        yield Setting("tool", "slow", lambda time: (np.array([-1.0, 0, 0, 0]), 1))
        yield Setting("tool", "awaited", lambda time: (np.array([1.0, 0, 0, 0]), 1), patience=np.inf)
        yield Setting("tool", "broken", lambda time: 1 / 0)

    monkeypatch.setattr(work_precision, "TOOLS", {"tool": tool})
    near, far = work_precision.panels(Pace(1e-5, 2, 1, limit=1e-12), (still,), (1.0, 2.0))
    assert [(mark.setting, mark.error) for mark in near.marks] == [("slow", 0), ("awaited", 0)]
    assert near.notes == {"tool broken": "ZeroDivisionError: division by zero"}
    assert [mark.setting for mark in far.marks] == ["awaited"]
    assert far.notes == {"more than 1e-12 s a run": "tool slow"}


def compared():
    marks = [
        Mark(OURS, "auto", 2e-16, 1e-4, 0),
        Mark(OURS, "strang, h = 0.1", 1e-3, 1e-5, 1000),
        Mark("SciPy", "DOP853, 1e-06", 1e-4, 2e-2, 61),
    ]
    return Panel(FREE, 100.0, marks, {"MuJoCo": "not installed"})


def test_the_table_of_work_and_precision_keeps_its_layout():
    assert work_precision.section([compared()]).partition("### ")[2] == (
        "Free top, t = 100\n"
        "\n"
        "| tool    |         setting |   error | CPU ms | steps |\n"
        "| ------- | --------------: | ------: | -----: | ----: |\n"
        "| polhode |            auto | 2.0e-16 |  0.100 |     – |\n"
        "| polhode | strang, h = 0.1 | 1.0e-03 | 0.0100 |  1000 |\n"
        "| SciPy   |   DOP853, 1e-06 | 1.0e-04 |   20.0 |    61 |\n"
        "\n"
        "- CPU time of DOP853 / ours at the same error or better: 200× (1e-06; auto); goal 100×\n"
        "- MuJoCo: not installed\n"
    )


def test_work_and_precision_are_drawn_and_written():
    pytest.importorskip("matplotlib")
    panels = [compared(), Panel(LAGRANGE, 1e4)]
    assert work_precision.plot(panels).startswith(b"\x89PNG")
    (first, second) = json.loads(json.dumps(work_precision.data(panels)))
    assert first["top"]["name"] == "Free top"
    assert first["marks"][2]["seconds"] == 2e-2
    assert second["marks"] == []


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


def test_results_that_disagree_raise():
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


@pytest.mark.parametrize(("ours", "mark"), [(4e-9, "behind 0.500×"), (1e-9, "2.00×")])
def test_the_table_marks_rows_behind_another_library(ours, mark):
    row = Row("2 + 2", seconds={OURS: ours, "NumPy": 2e-9})
    assert report.ratio(row) == mark


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
