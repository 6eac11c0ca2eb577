"""What the page of evidence claims holds, and a claim that does not hold is marked."""

import dataclasses
from xml.etree import ElementTree

import numpy as np
import pytest

import faults
import peer_tests
import references
import rounding
import throughput
from missing import left_out
from page import Page


def test_no_estimate_is_smaller_than_the_error():
    rows = list(references.outcomes())
    assert len(rows) > 80
    assert all(row.is_honest for row in rows)
    exact = rows[0]
    assert not dataclasses.replace(exact, rotor=1e-10).is_honest


def test_exp_and_log_are_within_two_ulp():
    for errors in rounding.measured(np.random.default_rng(2), 300):
        assert errors.ulps.max() < 2


def test_damaged_input_is_read_or_refused():
    for count in faults.damaged_inputs(seed=2, count=25):
        assert not count.faults, count.kind
        assert count.read + count.refused == count.tried == 25


def test_an_error_without_documentation_is_a_fault():
    count = faults._tried("zero", 3, lambda: 1 / 0)
    assert len(count.faults) == 3
    assert count.read == count.refused == 0


@pytest.mark.slow
@pytest.mark.parametrize(("peer", "passed"), [(peer_tests.SCIPY, 600), (peer_tests.CLIFFORD, 350)])
def test_tests_of_other_libraries_pass_or_differ_for_a_reason(peer, passed):
    pytest.importorskip(peer.package)
    suites = peer_tests.outcomes(peer)
    assert sum(suite.passed for suite in suites) > passed
    assert [test for suite in suites for test in suite.failed] == []
    unused = [
        start
        for start in peer.by_design
        if not any(test.startswith(start) for suite in suites for test in suite.by_design)
    ]
    assert unused == []


@pytest.mark.slow
def test_the_tests_of_numpy_quaternion_pass_or_differ_for_a_reason():
    pytest.importorskip("quaternion")
    try:
        peer_tests.QUATERNION.folder()
    except ConnectionError as error:
        left_out(str(error))
    (ran, *_) = peer_tests.outcomes(peer_tests.QUATERNION)
    assert ran.passed > 75
    assert ran.failed == []
    assert "an order of quaternions" in ran.missing.values()


def test_a_test_without_a_reason_fails():
    report = """<testsuite>
      <testcase classname="a.test_x" name="test_good"/>
      <testcase classname="a.test_x" name="test_bad"><failure message="1 != 2"/></testcase>
      <testcase classname="a.test_x" name="test_other"><failure message="3 != 4"/></testcase>
      <testcase classname="a.test_x" name="test_far">
        <skipped message="Skipped: not in Polhode: parity"/></testcase>
      <testcase classname="a.test_x" name="test_slow"><skipped message="expected failure"/></testcase>
    </testsuite>"""
    suite = peer_tests._suite("test_x", list(ElementTree.fromstring(report)), {"test_oth": "another sign"})
    assert suite == peer_tests.Suite(
        "test_x", 1, 1, {"test_other": "another sign"}, {"test_far": "parity"}, ["test_bad"]
    )


def test_reports_become_tables_and_lists():
    page = Page("a")
    page.markdown(
        "## One\n\nSome text.\n\n| x | y |\n| --- | --: |\n| `x < y` | 2 |\n\n### Two\n- first\n- second"
    )
    text = page.html().decode()
    assert "<h2>One</h2><p>Some text.</p><table>" in text
    assert "<tr><td><code>x &lt; y</code></td><td>2</td></tr>" in text
    assert "<h3>Two</h3><ul><li>first</li><li>second</li></ul>" in text


def test_throughput_is_plotted_for_each_operation():
    rows = [
        {"section": "Batches", "what": "a*b", "traffic": 24, "seconds": {"polhode": 1e-9, "NumPy": 4e-9}},
        {"section": "Motion", "what": "top", "traffic": 0, "seconds": {"polhode": 1e-3}},
    ]
    (axes,) = throughput.plot(rows, 1e10).axes
    assert [label.get_text() for label in axes.get_yticklabels()] == ["a*b"]
    ours = next(line for line in axes.lines if line.get_label() == "polhode")
    assert ours.get_xdata() == pytest.approx([1e9])


def test_bad_rows_stand_out():
    page = Page("a < b")
    page.table(["case", "error"], [["good", "1"], ["bad", "2"]], [False, True])
    text = page.html().decode()
    assert "a &lt; b" in text
    assert "<tr><td>good</td>" in text
    assert '<tr class="bad"><td>bad</td>' in text
