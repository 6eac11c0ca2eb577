"""Tests of other libraries, run on Polhode through adapters.

A plugin of pytest puts Polhode behind the names of the other library before its tests are imported. SciPy and
clifford install their tests; those of numpy-quaternion are in its source distribution, which pip downloads.
"""

from __future__ import annotations

import ast
import os
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from xml.etree import ElementTree

FOLDER = Path(__file__).parent
DOWNLOADS = FOLDER.parent / "build" / "peers"
# How an adapter begins the reason to skip a test that needs what Polhode does not have.
MISSING = "not in Polhode: "


@dataclass(frozen=True)
class Peer:
    """Another library: its package, the place of its tests, and what is known of them.

    `by_design` are tests of what Polhode does otherwise on purpose, by the start of their names, or of
    file::name; `left_out` are files of tests of what it does not have. Both have reasons.
    """

    package: str
    layer: str
    plugin: str
    tests: str
    by_design: Mapping[str, str]
    left_out: Mapping[str, str] = field(default_factory=dict)
    downloaded: bool = False

    @property
    def title(self) -> str:
        """The library and its version."""
        return f"{self.package} {version(self.package)}"

    def folder(self) -> Path:
        """The folder of the tests, downloaded if need be."""
        if self.downloaded:
            return _downloaded(self.package) / self.tests
        found = find_spec(self.tests)
        if found is None or found.origin is None:
            raise RuntimeError(f"{self.title} is installed without its tests, {self.tests}")
        return Path(found.origin).parent


SCIPY = Peer(
    "scipy",
    "Rotation, Slerp, RotationSpline and RigidTransform are replaced by a layer over Polhode that translates "
    "names.",
    "scipy_plugin",
    "scipy.spatial.transform.tests",
    {
        "test_cython_backend_selection": "looks at the implementation",
        "test_from_matrix_non_positive_determinant": "nearest=True takes any matrix",
        "test_mean_axis[numpy-1]": "names the same axis twice; ours refuses",
        "test_align_vectors_invalid_input": "weights of two dimensions; ours are weights of batches",
        "test_align_vectors_parallel": "parallel directions leave the turn open; ours refuses",
        "test_align_vectors_mixed_dtypes": "compares the sign of a quaternion that the problem leaves open",
        "test_as_davenport_degenerate[numpy-False]": "expects a warning; ours documents its choice",
        "test_from_dual_quat": "a dual quaternion of zeros is the identity for SciPy; ours refuses",
        "test_mean_invalid_weights": "weights of another shape; ours broadcast",
        "test_copy_flag": "a matrix that shares memory with its transform; ours never does",
        "test_spline_2_rotations": "another spline: ours is one of the rotors' components",
        "test_spline_properties": "another spline: ours is one of the rotors' components",
    },
)

CLIFFORD = Peer(
    "clifford",
    "Names, the order of coefficients and arrays are clifford's; every product, sum, involution, dual, "
    "inverse and function of its values and layouts is computed by Polhode.",
    "clifford_plugin",
    "clifford.test",
    {
        "test_pow_0": "whole numbers as coefficients; ours are floats",
        "test_mv_str": "whole numbers as coefficients; ours are floats",
        "test_binary_op_preserves_dtype": "whole numbers as coefficients; ours are floats",
        "test_unary_op_preserves_dtype": "whole numbers as coefficients; ours are floats",
        "test_categorization": "0/0 is NaN for clifford; ours refuses",
        "test_from_points_construction[flat]": "expected to fail; ours refuses to divide by zero",
    },
    {
        "test_algebra_initialisation.py": "times the construction of tables",
        "test_aliases.py": "imports modules",
        "test_bit_helpers.py": "functions of bits",
        "test_dg3c.py": "an algebra of 10 generators; ours have at most 8",
        "test_function_cache.py": "a cache of compiled code",
        "test_g3c_CUDA.py": "kernels of CUDA",
        "test_g3c_tools.py": "functions of arrays of coefficients, compiled by Numba",
        "test_io.py": "a file format",
        "test_layout_helpers.py": "orders of basis blades",
        "test_numba_extensions.py": "values in code compiled by Numba",
        "test_parser.py": "a syntax of texts",
    },
)

QUATERNION = Peer(
    "numpy-quaternion",
    "The type quaternion and the functions of the module are replaced by a layer over Polhode. An array of "
    "quaternions is an array of objects there, because Polhode has batches instead of a data type of NumPy.",
    "quaternion_plugin",
    "tests",
    {
        "test_cumulative_functions": "a function of NumPy for arrays of numbers; ours are batches",
        "test_numpy_save_and_load": "a data type of NumPy; ours are batches",
        "test_setitem_quat": "assignment into an array of a data type of NumPy; ours are batches",
        "test_ufunc_existence[copysign]": "a function of NumPy for arrays of numbers; ours are batches",
        "test_ufunc_existence[is": "a function of NumPy for arrays of numbers; ours are batches",
        "test_quaternion_log_exp": "log(−1) lies in any plane: theirs takes x, ours e1∧e2, which is −z",
        "test_quaternion_power": "0 and negative numbers to the power of a quaternion; ours refuses",
        "test_quaternion_sqrt": "the root of numbers below 1e-154 is 0 there; ours is exact",
    },
    {"test_calculus.py": "splines, derivatives and integrals of any functions"},
    downloaded=True,
)

PEERS = (SCIPY, CLIFFORD, QUATERNION)


@dataclass(frozen=True)
class Suite:
    """The outcome of a file of tests.

    Tests that passed, that the library itself skips or expects to fail, that differ by design and that need
    what Polhode does not have (both with reasons), and that failed.
    """

    name: str
    passed: int
    skipped: int
    by_design: Mapping[str, str]
    missing: Mapping[str, str]
    failed: list[str]


def outcomes(peer: Peer) -> list[Suite]:
    """Run the tests of a library and return the outcome of each file."""
    folder = peer.folder()
    with tempfile.TemporaryDirectory() as place:
        report = Path(place, "report.xml")
        plugins = [word for name in (peer.plugin, "no:cacheprovider", "no:xdist") for word in ("-p", name)]
        target = [str(folder)] if peer.downloaded else ["--pyargs", peer.tests]
        command = [sys.executable, "-m", "pytest", "-q", "-W", "ignore", *plugins, f"--junitxml={report}"]
        done = subprocess.run(
            [
                *command,
                "-c",
                os.devnull,
                f"--rootdir={place}",
                *(f"--ignore={folder / name}" for name in peer.left_out),
                *target,
            ],
            cwd=place,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(_paths())},
            capture_output=True,
            text=True,
            timeout=900,
            check=False,
        )
        if not report.is_file():
            raise RuntimeError(
                f"the tests of {peer.title} did not run: {done.stdout[-2000:]}{done.stderr[-2000:]}"
            )
        cases = list(ElementTree.parse(report).iter("testcase"))
    files = sorted({_file(case) for case in cases})
    ran = [_suite(name, [case for case in cases if _file(case) == name], peer.by_design) for name in files]
    return [*ran, *(_left_out(folder / name, reason) for name, reason in peer.left_out.items())]


def _paths() -> list[str]:
    given = os.environ.get("PYTHONPATH")
    return [str(FOLDER), *([given] if given else [])]


def _downloaded(package: str) -> Path:
    """Return the folder of a source distribution, of the version that is installed."""
    name = f"{package.replace('-', '_')}-{version(package)}"
    folder = DOWNLOADS / name
    if not folder.is_dir():
        DOWNLOADS.mkdir(parents=True, exist_ok=True)
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--no-binary", package]
        asked = f"{package}=={version(package)}"
        if subprocess.run([*command, "--dest", str(DOWNLOADS), asked], check=False).returncode:
            raise ConnectionError(f"pip cannot download the source distribution of {asked}")
        with tarfile.open(DOWNLOADS / f"{name}.tar.gz") as archive:
            archive.extractall(DOWNLOADS, filter="data")
    return folder


def _file(case: ElementTree.Element) -> str:
    words = case.get("classname", "").split(".")
    return next((word for word in words if word.startswith("test_")), words[-1])


def _suite(name: str, cases: list[ElementTree.Element], by_design: Mapping[str, str]) -> Suite:
    bad, missing, skipped = set(), {}, 0
    for case in cases:
        test, skip = case.get("name", ""), case.find("skipped")
        if case.find("failure") is not None or case.find("error") is not None:
            bad.add(test)
        elif skip is not None:
            _, found, reason = (skip.get("message") or "").partition(MISSING)
            if found:
                missing[test] = reason
            else:
                skipped += 1
    reasons = {
        test: reason
        for test in sorted(bad)
        for start, reason in by_design.items()
        if test.startswith(start) or f"{name}::{test}".startswith(start)
    }
    passed = len(cases) - sum(
        case.find(tag) is not None for case in cases for tag in ("failure", "error", "skipped")
    )
    return Suite(name, passed, skipped, reasons, missing, sorted(bad - reasons.keys()))


def _left_out(path: Path, reason: str) -> Suite:
    """Return the outcome of a file that is not run: its test functions are counted, not their parameters."""
    tests = [node.name for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.FunctionDef)]
    return Suite(path.stem, 0, 0, {}, {name: reason for name in tests if name.startswith("test")}, [])
