"""Type hints: mypy accepts the code of README and guides, and infers the types of results."""

import re
import sys
from pathlib import Path

import pytest

import polhode as ph
import processes

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
# Each section of these pages is a program of its own.
BY_SECTION = ("translations.md",)


def programs(page):
    """Return the Python code of a page as files with its line numbers: all other lines are empty."""
    lines, fenced, part = page.read_text().splitlines(), False, 0
    found = {0: [""] * len(lines)}
    for number, line in enumerate(lines):
        if not fenced and line.startswith("## ") and page.name in BY_SECTION:
            part += 1
            found[part] = [""] * len(lines)
        if line.startswith("```"):
            fenced = line == "```python"
        elif fenced:
            found[part][number] = line
    return {f"{page.stem}__{part}.py": "\n".join(code) for part, code in found.items() if any(code)}


def mypy(folder, files):
    """Return what mypy finds in files of these names and contents."""
    pytest.importorskip("mypy")
    for name, code in files.items():
        (folder / name).write_text(code + "\n")
    options = ["--config-file=", "--check-untyped-defs", "--strict-equality", "--ignore-missing-imports"]
    # Errors of the package itself are those of `make lint`.
    options += ["--follow-imports=silent", "--hide-error-context", "--no-error-summary"]
    package = Path(ph.__file__).parent.parent
    done = processes.run(
        [sys.executable, "-m", "mypy", *options, f"--cache-dir={ROOT / '.mypy_cache/guides'}", *files],
        cwd=folder,
        env={"MYPYPATH": str(package), "PATH": ""},
        timeout=600,
    )
    assert done.returncode in (0, 1), done.stderr
    return done.stdout.splitlines()


def test_the_code_of_the_guides_is_accepted(tmp_path):
    files = {name: code for page in PAGES for name, code in programs(page).items()}
    assert {"README__0.py", "motion__0.py", "rotations__0.py"} <= set(files)
    # The line numbers are those of the page.
    found = [re.sub(r"^(\w+)__\d+\.py:", r"\1.md:", line) for line in mypy(tmp_path, files)]
    assert found == []


KNOWN = """
from collections.abc import Iterator
from typing import Any, assert_type

import numpy as np
from numpy.typing import NDArray

import polhode as ph
from polhode import e1, e2

R, S = ph.Rotor.identity(), ph.Rotor.random(10)
assert_type(R * S, ph.Rotor)
assert_type(R / S, ph.Rotor)
assert_type(R.geometric_product(S), ph.Rotor)
assert_type(~R * S, ph.Rotor)
assert_type(R.inverse() * S**2, ph.Rotor)
assert_type(R * S * R, ph.Rotor)
assert_type(ph.Rotor.from_axis_angle([0, 0, 1], 0.3) * R, ph.Rotor)
assert_type(ph.Rotor.from_multivector(R + 0.1 * S), ph.Rotor)
assert_type(R.canonical() * S.continuous(), ph.Rotor)
assert_type(R.to_davenport([e1, e2, e1], "i"), Any)
assert_type(ph.mean([R, R], weights=[1, 2]), ph.Rotor)
assert_type(ph.align([e1, e2], [e2, e1]).rotor, ph.Rotor)
assert_type(ph.slerp(R, R, 0.5) * R, ph.Rotor)
R *= R
assert_type(R, ph.Rotor)
assert_type(R * e1, ph.Multivector)
assert_type(R(e1), ph.Multivector)
assert_type((e1 * e1)(e1), ph.Multivector)
assert_type(e1[0], ph.Multivector)
assert_type(e1.grade(1, 3), ph.Multivector)
assert_type(R.subs("x", 1), ph.Rotor)
assert_type(R(S), ph.Rotor)
assert_type(S[1:], ph.Rotor)
assert_type(S.reshape(2, 5), ph.Rotor)
assert_type(iter(S), Iterator[ph.Rotor])
assert_type(ph.stack([R, R * R]), ph.Rotor)
assert_type(ph.stack([e1, e2]), ph.Multivector)
assert_type(R.components, NDArray[Any])
assert_type(ph.State(R, [0.1, 0, 20.0]).omega_body, ph.Multivector)
ph.State(rotor=R, omega_body=e1 ^ e2, position=np.zeros(3), velocity=0)
"""


def test_types_of_results_are_known(tmp_path):
    assert mypy(tmp_path, {"known.py": KNOWN}) == []


def test_wrong_arguments_are_still_reported(tmp_path):
    code = "import polhode as ph\nph.State(1, [0, 0, 1])\nph.State(ph.Rotor.identity(), e1=2)"
    assert {line.split(": ")[0] for line in mypy(tmp_path, {"wrong.py": code})} == {
        "wrong.py:2",
        "wrong.py:3",
    }


OPERANDS = """
from fractions import Fraction
from typing import assert_type

import numpy as np

import polhode as ph
from polhode import e1, e2

R, T, x = ph.Rotor.identity(), ph.RigidTransform(), np.ones(3)
for value in (2 * e1, 2j * e1, Fraction(1, 3) * e1, np.float64(2) * e1, e1 * x, e1 / x, e1 - 1, R + x):
    assert_type(value, ph.Multivector)
assert_type(e1.wedge(x, out=np.ones((3, 3))), ph.Multivector)
assert_type(T * T, ph.RigidTransform)
law, push = ph.torque.damping(1), ph.force.drag(1)
for torque in (2 * law, -law, law / 2, law - law, 0 + law):
    assert_type(torque, ph.torque.Torque)
for force in (2 * push - e1, e1 - push, e1 + push, push + x):
    assert_type(force, ph.force.Force)
assert_type(push.at(ph.Body.sphere(1, mass=1), ph.State(R, x)), ph.Multivector)
"""

WRONG_OPERANDS = """
import polhode as ph
from polhode import e1, e2

R, T, law = ph.Rotor.identity(), ph.RigidTransform(), ph.torque.damping(1)
e1 - [0, 0, 1]
[0, 0, 1] ^ e1
e1.wedge((0, 0, 1))
e1 * "x"
e1 / None
R * T
T * R
T @ T
T * e1
law * "x"
law + e1
e1 + law
"""


def test_operands_that_raise_are_reported(tmp_path):
    found = mypy(tmp_path, {"operands.py": OPERANDS, "wrong.py": WRONG_OPERANDS})
    lines = {line.split(": ")[0] for line in found if ": error: " in line}
    first = WRONG_OPERANDS[: WRONG_OPERANDS.index("e1 - [")].count("\n") + 1
    assert lines == {f"wrong.py:{k}" for k in range(first, WRONG_OPERANDS.count("\n") + 1)}


def test_a_star_import_has_everything_but_helpers(tmp_path):
    code = "from polhode import *\nState(Rotor.identity(), e1 ^ e2)\nAny\nTYPE_CHECKING"
    found = mypy(tmp_path, {"star.py": code})
    # Beside each error there may be notes.
    assert {line.split(" ")[0] for line in found} == {"star.py:3:", "star.py:4:"}
    assert {"State", "simulate", "Rotor", "e1", "I", "torque"} <= set(ph.__all__)
    assert all(hasattr(ph, name) for name in ph.__all__)
    public = {name for name in dir(ph) if not name.startswith("_")}
    # JAX and Hypothesis are optional; IPython calls its function by name.
    assert set(ph.__all__) == public - {"jax", "strategies", "load_ipython_extension"}
