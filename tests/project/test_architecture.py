"""Crates, folders and files depend on each other in one direction, and the guides name what exists."""

import ast
import re
import tomllib
from pathlib import Path

import pytest

from circles import circles
from python_imports import import_graph
from rust_paths import uses_of_files
from typescript_imports import imports

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "python" / "polhode"

# Which crates of ours each crate may use.
ARROWS = {
    "polhode-ga": set(),
    "polhode-rigid": {"polhode-ga"},
    "polhode-py": {"polhode-ga", "polhode-rigid"},
    "polhode-wasm": {"polhode-ga", "polhode-rigid"},
}


def test_crates_know_each_other_in_one_direction():
    found = {}
    for manifest in sorted((ROOT / "crates").glob("*/Cargo.toml")):
        crate = tomllib.loads(manifest.read_text())
        sections = [
            crate.get(name, {}) for name in ("dependencies", "dev-dependencies", "build-dependencies")
        ]
        found[crate["package"]["name"]] = {
            name for section in sections for name in section if name.startswith("polhode-")
        }
    assert found == ARROWS


def test_the_algebra_depends_on_nothing():
    crate = tomllib.loads((ROOT / "crates/ga/Cargo.toml").read_text())
    assert "dependencies" not in crate


def test_a_panic_of_the_core_unwinds():
    """It reaches Python as an exception; the core of the browser may abort."""
    profiles = tomllib.loads((ROOT / "Cargo.toml").read_text())["profile"]
    assert not any("panic" in settings for name, settings in profiles.items() if name != "viewer")


# The folders of the package from the lowest up: each imports only those before it. The public modules of laws
# belong to mechanics.
FOLDERS = (
    *("_start", "_support", "_generic", "_algebra", "_formula", "_mechanics"),
    *("jax", "_scene", "_report", "_io", "io", "_viewer", "_figures", "_fit", "_outputs", "_cli", "__main__"),
)


def by_folder(graph: dict[str, set[str]], depth: int, separator: str) -> dict[str, set[str]]:
    """Return the folders that each folder uses, from the files that each file uses."""
    found: dict[str, set[str]] = {}
    for name, others in graph.items():
        folder = name.split(separator)[depth]
        found.setdefault(folder, set()).update({o.split(separator)[depth] for o in others} - {folder})
    return found


def test_python_files_form_no_circle():
    """Imports inside functions count; only a package and what is in it may import each other."""
    graph = import_graph(PACKAGE)
    assert "polhode._algebra.rotor" in graph["polhode._algebra.interpolation"]
    assert "polhode._viewer.server" in graph["polhode._cli.main"]
    assert circles(graph) == []


def test_python_folders_import_downwards():
    def placed(name: str) -> str:
        return re.sub(r"^polhode\.(event|force|torque)$", r"polhode._mechanics.\1", name)

    graph = {
        placed(name): {placed(other) for other in others - {"polhode"}}
        for name, others in import_graph(PACKAGE).items()
        if "." in name
    }
    folders = by_folder(graph, 1, ".")
    assert set(FOLDERS) | {"strategies"} == set(folders) - {"_native"}
    for folder, others in folders.items():
        allowed = FOLDERS if folder == "strategies" else FOLDERS[: FOLDERS.index(folder)]
        assert others - {"_native"} <= set(allowed), folder


@pytest.mark.parametrize("crate", ["ga", "rigid", "py", "wasm"])
def test_rust_files_form_no_circle(crate):
    graph = uses_of_files(ROOT / "crates" / crate / "src")
    assert len(graph) > 3
    assert circles(graph) == []


def test_the_binding_imports_no_python_module():
    """Python registers the objects that the binding needs; the binding imports NumPy only."""
    sources = [path.read_text() for path in (ROOT / "crates/py/src").rglob("*.rs")]
    imported = {name for text in sources for name in re.findall(r"\bimport\([^)]*?\"([\w.]+)\"", text)}
    assert imported == {"numpy"}


def test_viewer_files_and_folders_form_no_circle():
    graph = imports(ROOT / "viewer/src")
    assert circles(graph) == []
    folders = by_folder(graph, 0, "/")
    assert circles(folders) == []
    assert "panels" not in folders["vary"]


def test_circles_are_found():
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"b"}, "d": {"a"}}) == [["b", "c"]]


def test_importing_needs_numpy_only():
    allowed = {"numpy", "polhode", "__future__"}
    import sys

    for path in PACKAGE.rglob("*.py"):
        for node in ast.parse(path.read_text()).body:
            names = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                names = [node.module or ""]
            for name in names:
                top = name.split(".")[0]
                assert top in allowed or top in sys.stdlib_module_names, f"{path.name} imports {name}"


@pytest.mark.parametrize("guide", ["ARCHITECTURE.md", "README.md", "CONVENTIONS.md", "CONTRIBUTING.md"])
def test_paths_named_in_the_guides_exist(guide):
    text = (ROOT / guide).read_text()
    named = re.findall(r"`((?:crates|python|viewer|tests|examples|benchmarks|docs|\.ci)/[\w./-]*)`", text)
    linked = re.findall(r"\]\((?!https?:)([^)#]+)\)", text)
    missing = [path for path in named + linked if not (ROOT / path).exists()]
    assert not missing
    assert guide != "ARCHITECTURE.md" or len(named) > 10


def test_architecture_is_one_page():
    assert len((ROOT / "ARCHITECTURE.md").read_text().splitlines()) <= 100


def test_few_modules_lie_directly_in_the_package():
    assert len(list(PACKAGE.glob("*.py"))) + len(list(PACKAGE.glob("*.pyi"))) <= 12
