"""A clone of the project has all that its tests need, and they end."""

import ast
import re
import signal
import sys
from pathlib import Path

import pytest

import processes

ROOT = Path(__file__).parents[2]

SKIPPED = {"node_modules", "_viewer", "target", "corpus", "artifacts", "__pycache__"}
FOLDERS = ("crates", "python", "tests", "viewer", "docs", "examples", "benchmarks", "evidence", "fuzz", ".ci")
TEXTS = [
    path
    for folder in (ROOT.glob("*"), *((ROOT / name).rglob("*") for name in FOLDERS))
    for path in folder
    if path.is_file() and not SKIPPED.intersection(path.parts)
]


def outside(path: Path, text: str) -> list[str]:
    """Return the paths in a file of the project that lead out of it, or nowhere."""
    found = []
    crate = next((folder for folder in path.parents if (folder / "Cargo.toml").exists()), ROOT)
    for line in text.splitlines():
        for named in re.findall(r"(?<![\w.`])/?((?:\.\./)+[\w./-]+)", line):
            base = crate if "CARGO_MANIFEST_DIR" in line else path.parent
            target = (base / named).resolve()
            if not target.exists() or not target.is_relative_to(ROOT):
                found.append(named)
        for ups in re.findall(r"__file__\)(?:\.resolve\(\))?\.parents\[(\d+)\]", line):
            if int(ups) >= len(path.relative_to(ROOT).parts):
                found.append(line.strip())
        for chain in re.findall(r"__file__\)(?:\.resolve\(\))?((?:\.parent)+)\b", line):
            if chain.count(".parent") > len(path.relative_to(ROOT).parts):
                found.append(line.strip())
    return found


# Paths that exist only in tests.
MADE_UP = {
    "tests/cli/test_run_options.py",
    "tests/project/test_clone.py",
    "tests/viewer/test_document.py",
    "tests/viewer/test_view.py",
}


def test_nothing_refers_to_a_folder_outside():
    assert len(TEXTS) > 300
    found = {}
    for path in TEXTS:
        name = path.relative_to(ROOT).as_posix()
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue  # a picture or a mesh
        if name not in MADE_UP and (paths := outside(path, text)):
            found[name] = paths
    assert found == {}


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("tests/test_x.py", 'DATA = Path(__file__).parents[2] / "data"'),
        ("tests/test_x.py", "HERE = Path(__file__).parent.parent.parent"),
        ("tests/test_x.py", 'open("../../data/mesh.obj")'),
        ("crates/rigid/tests/x.rs", 'Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data").join(file)'),
        ("crates/rigid/tests/x.rs", 'include_str!("../../../../data/mesh.obj")'),
        ("viewer/src/x.ts", 'import mesh from "../../../meshes/top.stl?raw";'),
    ],
)
def test_paths_that_lead_outside_are_found(name, line):
    assert outside(ROOT / name, line)


def test_programs_started_by_tests_have_a_time_limit():
    """They are started by tests/support/processes.py alone, which sets it."""
    banned = {"subprocess", "multiprocessing"}
    users = set()
    for path in (ROOT / "tests").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            names = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                names = [node.module or ""]
            elif isinstance(node, ast.Attribute):
                names = ["subprocess"] if node.attr in ("system", "popen", "posix_spawn", "fork") else []
            if banned.intersection(name.split(".")[0] for name in names):
                users.add(path.name)
    assert users == {"processes.py"}


def test_ctrl_c_reaches_programs_also_from_a_background_job():
    child = "import signal; print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)"
    parent = f"import sys, processes; print(processes.run([sys.executable, '-c', {child!r}]).stdout, end='')"
    ignoring = ["bash", "-c", 'trap "" INT; exec "$@"', "bash", sys.executable, "-c", parent]
    assert processes.run(ignoring, cwd=ROOT / "tests/support").stdout == "True\n"


def test_a_program_that_hangs_is_ended():
    with processes.start([sys.executable, "-c", "input()"], limit=0.5, stdin=processes.PIPE) as process:
        assert process.stdout.read() == ""  # which waits until it has ended
        assert process.wait() == -signal.SIGKILL
