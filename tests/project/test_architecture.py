"""The rooms know each other in one direction only, and the guides name what exists."""

import ast
import re
import tomllib
from pathlib import Path

import pytest

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


def module_name(path: Path) -> str:
    """`_arrays`, `_generic.exact`; a package has the name of its directory."""
    parts = path.relative_to(PACKAGE).with_suffix("").parts
    return ".".join(part for part in parts if part != "__init__" or len(parts) == 1)


def module_imports(path: Path, modules: set[str]) -> set[str]:
    """Return the modules of the package that are imported along with this one."""
    found = set()
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("polhode"):
            for name in node.names:
                dotted = f"{node.module}.{name.name}".removeprefix("polhode.")
                found.add(dotted if dotted in modules else node.module.removeprefix("polhode."))
    return found


def test_python_modules_form_no_circle():
    paths = {module_name(path): path for path in PACKAGE.rglob("*.py")}
    graph = {name: module_imports(path, set(paths)) for name, path in paths.items()}
    assert "_generic.exact" in graph["_generic.coefficients"]
    done: set[str] = set()

    def visit(name: str, path: tuple[str, ...]) -> None:
        assert name not in path, " -> ".join((*path, name))
        if name not in done:
            for other in graph.get(name, set()):
                visit(other, (*path, name))
            done.add(name)

    for name in graph:
        visit(name, ())


def test_the_package_does_not_use_the_strategies_for_tests():
    used = {
        path.name for path in PACKAGE.rglob("*.py") if "strategies" in module_imports(path, {"strategies"})
    }
    assert not used


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


def test_architecture_is_short():
    assert len((ROOT / "ARCHITECTURE.md").read_text().splitlines()) <= 100
