"""SciPy's own tests of rotations, run on Polhode through `scipy_adapter`."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from xml.etree import ElementTree

FOLDER = Path(__file__).parent
PACKAGE = "scipy.spatial.transform.tests"

# Tests of what Polhode does otherwise on purpose, by the start of their names.
BY_DESIGN = {
    "test_cython_backend_selection": "looks at the implementation",
    "test_from_matrix_non_positive_determinant": "nearest=True takes any matrix; without it ours refuses too",
    "test_mean_axis[numpy-1]": "names the same axis twice; ours refuses",
    "test_align_vectors_invalid_input": "weights of two dimensions; ours are weights of batches",
    "test_align_vectors_parallel": "parallel directions leave the turn open; ours refuses",
    "test_align_vectors_mixed_dtypes": "compares the sign of a quaternion that the problem leaves open",
    "test_as_davenport_degenerate[numpy-False]": "expects a warning; ours documents the choice of the angle",
    "test_from_dual_quat": "a dual quaternion of zeros is the identity for SciPy; ours refuses",
    "test_mean_invalid_weights": "weights of another shape; ours broadcast",
    "test_copy_flag": "a matrix that shares memory with its transform; ours never does",
    "test_spline_2_rotations": "another spline: ours is one of the rotors' components",
    "test_spline_properties": "another spline: ours is one of the rotors' components",
}


@dataclass(frozen=True)
class Suite:
    """The outcome of a file of tests: passed, skipped by SciPy, different by design with reasons, failed."""

    name: str
    passed: int
    skipped: int
    by_design: Mapping[str, str]
    failed: list[str]


def outcomes() -> list[Suite]:
    """Run the tests and return the outcome of each file."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder, "report.xml")
        options = ["-p", "scipy_plugin", "-p", "no:cacheprovider", "-p", "no:xdist", "-W", "ignore"]
        command = [
            sys.executable,
            "-m",
            "pytest",
            "-q",
            *options,
            f"--junitxml={report}",
            "--pyargs",
            PACKAGE,
        ]
        done = subprocess.run(
            command,
            cwd=folder,
            env={**os.environ, "PYTHONPATH": str(FOLDER)},
            capture_output=True,
            text=True,
            timeout=900,
            check=False,
        )
        if not report.is_file():
            raise RuntimeError(f"SciPy's tests did not run: {done.stdout[-2000:]}{done.stderr[-2000:]}")
        cases = list(ElementTree.parse(report).iter("testcase"))
    files = sorted({_file(case) for case in cases})
    return [_suite(name, [case for case in cases if _file(case) == name]) for name in files]


def title() -> str:
    """The package of the tests with its version."""
    return f"{PACKAGE}, SciPy {version('scipy')}"


def _file(case: ElementTree.Element) -> str:
    return case.get("classname", "").rpartition(".")[2]


def _suite(name: str, cases: list[ElementTree.Element]) -> Suite:
    bad = {
        case.get("name", "")
        for case in cases
        if case.find("failure") is not None or case.find("error") is not None
    }
    skipped = sum(case.find("skipped") is not None for case in cases)
    reasons = {
        test: reason for test in sorted(bad) for start, reason in BY_DESIGN.items() if test.startswith(start)
    }
    return Suite(name, len(cases) - len(bad) - skipped, skipped, reasons, sorted(bad - reasons.keys()))
