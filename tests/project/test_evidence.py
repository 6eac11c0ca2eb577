"""What the page of evidence claims holds, and a claim that does not hold is marked."""

import dataclasses

import numpy as np
import pytest

import faults
import peer_tests
import references
import rounding
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
def test_scipys_tests_pass_or_differ_for_a_reason():
    suites = peer_tests.outcomes()
    assert sum(suite.passed for suite in suites) > 600
    assert [test for suite in suites for test in suite.failed] == []


def test_bad_rows_stand_out():
    page = Page("a < b")
    page.table(["case", "error"], [["good", "1"], ["bad", "2"]], [False, True])
    text = page.html().decode()
    assert "a &lt; b" in text
    assert "<tr><td>good</td>" in text
    assert '<tr class="bad"><td>bad</td>' in text
