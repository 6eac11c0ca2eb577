"""A release: one version, one address, and files that the hosts and registries can read."""

import importlib.util
import json
import re
import shutil
import tomllib
from pathlib import Path

import pytest
import yaml

import processes
from missing import left_out
from viewers import needs_bundle

ROOT = Path(__file__).parents[2]
CARGO = tomllib.loads((ROOT / "Cargo.toml").read_text())
PYTHON = tomllib.loads((ROOT / "pyproject.toml").read_text())
SHARED = CARGO["workspace"]["package"]
VERSION, ADDRESS = SHARED["version"], SHARED["repository"]
CRATES = ("polhode-ga", "polhode-rigid")
LICENCES = {"LICENSE-MIT", "LICENSE-APACHE"}
NOTICES = "LICENSE-THIRD-PARTY.md"
WORKFLOWS = sorted((ROOT / ".github/workflows").iterdir())

# Files in the root and in these folders may contain the address.
FOLDERS = (".ci", ".github", "conda", "crates", "docs", "examples", "python", "viewer/src")
TEXTS = [
    path
    for folder in (ROOT.glob("*"), (ROOT / "viewer").glob("*"), *((ROOT / x).rglob("*") for x in FOLDERS))
    for path in folder
    if path.is_file()
    and path.suffix in {".cff", ".json", ".md", ".py", ".pyi", ".rs", ".toml", ".ts", ".tsx", ".yaml", ".yml"}
]


def crate(name):
    return tomllib.loads((ROOT / f"crates/{name}/Cargo.toml").read_text())


def parsed(path):
    return yaml.safe_load((ROOT / path).read_text())


def program(name):
    """The path of a program, for a test that needs it."""
    return shutil.which(name) or left_out(f"{name} is not installed")


# --- versions


def test_all_packages_have_one_version():
    lock = json.loads((ROOT / "viewer/package-lock.json").read_text())
    stated = {
        "crates": {package["version"] for package in CARGO["workspace"]["dependencies"].values()},
        "viewer": {json.loads((ROOT / "viewer/package.json").read_text())["version"]},
        "its lock file": {lock["version"], lock["packages"][""]["version"]},
        "citation": {parsed("CITATION.cff")["version"]},
        "conda": {parsed("conda/recipe.yaml")["context"]["version"]},
    }
    assert [name for name, versions in stated.items() if versions != {VERSION}] == []
    for name in ("ga", "rigid", "py", "wasm"):
        assert crate(name)["package"]["version"] == {"workspace": True}
    assert PYTHON["project"]["dynamic"] == ["version"]


def test_the_changelog_has_the_version_and_its_date():
    text = (ROOT / "CHANGELOG.md").read_text()
    first, newest, *_ = re.findall(r"^## (.*)$", text, flags=re.MULTILINE)
    assert first == "Unreleased"
    assert newest == f"{VERSION} ({parsed('CITATION.cff')['date-released']})"


def test_supported_versions_are_stated_alike():
    series = VERSION.rpartition(".")[0]
    policy = (ROOT / "docs/policy.md").read_text()
    (row,) = re.findall(rf"^\| {re.escape(series)} \|.*", policy, flags=re.MULTILINE)
    pythons = re.findall(r"Python :: (3\.\d+)", "\n".join(PYTHON["project"]["classifiers"]))
    assert f"{pythons[0]} to {pythons[-1]}" in row
    assert PYTHON["project"]["requires-python"] == f">={pythons[0]}"
    assert pythons == [f"3.{minor}" for minor in range(int(pythons[0][2:]), int(pythons[-1][2:]) + 1)]
    assert f"abi3-py{pythons[0].replace('.', '')}" in crate("py")["dependencies"]["pyo3"]["features"]
    (numpy,) = PYTHON["project"]["dependencies"]
    assert numpy.replace("numpy>=", "≥ ") in row
    assert f"≥ {SHARED['rust-version']}" in row
    recipe = parsed("conda/recipe.yaml")
    assert recipe["context"]["python_min"] == pythons[0]
    assert numpy.replace(">", " >") in recipe["requirements"]["run"]


# --- addresses


def test_there_is_one_address():
    assert re.fullmatch(r"https://github\.com/[\w-]+/[\w-]+", ADDRESS)
    owner = ADDRESS.rsplit("/", 1)[0]
    found = {path for path in TEXTS if ADDRESS in path.read_text()}
    others = {
        path.relative_to(ROOT).as_posix(): rest
        for path in TEXTS
        if (rest := re.findall(rf"{owner}(?!/{ADDRESS.rsplit('/', 1)[1]}\b).*", path.read_text()))
    }
    assert others == {}
    needed = ("pyproject.toml", "CITATION.cff", "viewer/package.json", "conda/recipe.yaml", "CONTRIBUTING.md")
    assert found.issuperset(ROOT / name for name in needed)
    assert all(url.startswith(ADDRESS) for url in PYTHON["project"]["urls"].values())


# --- files for the hosts


@pytest.mark.parametrize(
    "path",
    [
        *(path.relative_to(ROOT).as_posix() for path in (ROOT / ".github").rglob("*.yml")),
        *(".pre-commit-config.yaml", ".readthedocs.yaml", "CITATION.cff", "conda/recipe.yaml"),
    ],
)
def test_yaml_can_be_read(path):
    assert isinstance(parsed(path), dict)


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.name)
def test_workflows_are_limited(path):
    """Jobs have a time limit, and rights by name only; those that publish wait for a person."""
    workflow = yaml.safe_load(path.read_text())
    assert workflow["permissions"] == {"contents": "read"}
    for name, job in workflow["jobs"].items():
        assert "timeout-minutes" in job, name
        rights = job.get("permissions", {})
        assert rights.get("contents", "read") == "read", name
        publishes = any("publish" in str(step) for step in job["steps"])
        assert (job.get("environment") == "release") == publishes, name


def test_workflows_use_one_version_of_each_action():
    used = {}
    for path in WORKFLOWS:
        for name, version in re.findall(r"uses: ([\w/-]+)@(\S+)", path.read_text()):
            used.setdefault(name, set()).add(version)
    assert len(used) > 5
    assert [name for name, versions in used.items() if len(versions) > 1] == []


def test_targets_that_hosts_make_exist():
    makefile = (ROOT / "Makefile").read_text()
    commands = "\n".join(path.read_text() for path in (*WORKFLOWS, ROOT / ".readthedocs.yaml"))
    targets = set(" ".join(re.findall(r"(?:- |run: )make (.*)$", commands, flags=re.MULTILINE)).split())
    assert targets == {"docs", "wheel", "package-check"}
    for name in targets:
        assert re.search(rf"^{name}:", makefile, flags=re.MULTILINE)


def test_hooks_run_the_programs_of_the_project():
    """Their versions are those of constraints.txt and package-lock.json: nothing else states one."""
    (hooks,) = (
        repo["hooks"] for repo in parsed(".pre-commit-config.yaml")["repos"] if repo["repo"] == "local"
    )
    assert {hook["id"] for hook in hooks} == {"ruff-check", "ruff-format", "rustfmt", "prettier"}
    assert all(hook["language"] == "system" for hook in hooks)


def test_texts_end_with_one_newline():
    """As the hook `end-of-file-fixer` leaves them."""
    wrong = [path for path in TEXTS if (text := path.read_text()) and not re.search(r"[^\n]\n\Z", text)]
    assert wrong == []


# --- packages


@pytest.mark.parametrize("name", CRATES)
def test_a_crate_has_all_that_a_registry_shows(name):
    folder = ROOT / "crates" / name.removeprefix("polhode-")
    package = crate(folder.name)["package"]
    assert "publish" not in package
    for field in ("authors", "repository", "homepage", "license", "rust-version"):
        assert package[field] == {"workspace": True}
    assert len(package["keywords"]) == 5
    assert all(len(word) <= 20 for word in package["keywords"])
    listing = [program("cargo"), "package", "--list", "--locked", "--offline", "--allow-dirty", "-p", name]
    listed = processes.run(listing, cwd=ROOT)
    assert listed.returncode == 0, listed.stderr
    files = listed.stdout.splitlines()
    assert {"Cargo.toml", "README.md", "src/lib.rs", *LICENCES} <= {*files}
    assert [file for file in files if file.startswith("tests/")] == []
    assert any(file.startswith("examples/") for file in files)
    for licence in LICENCES:
        assert (folder / licence).read_text() == (ROOT / licence).read_text()


def test_the_notices_are_those_of_the_crates_that_are_compiled():
    program("cargo")
    spec = importlib.util.spec_from_file_location("notices", ROOT / ".ci/notices.py")
    notices = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(notices)
    current = notices.notices()
    assert "## pyo3 v" in current
    assert "## toml_edit v" in current
    assert "## proc-macro2 v" not in current
    assert (ROOT / NOTICES).read_text() == current, "run python .ci/notices.py"


def test_every_package_has_the_licences():
    assert {*PYTHON["project"]["license-files"]} == {NOTICES, *LICENCES}
    assert {*parsed("conda/recipe.yaml")["about"]["license_file"]} == {NOTICES, *LICENCES}


def test_only_the_core_is_published():
    for name in ("py", "wasm"):
        assert crate(name)["package"]["publish"] == {"workspace": True}
    assert SHARED["publish"] is False


@needs_bundle
def test_the_npm_package_is_the_bundle():
    done = processes.run([program("npm"), "pack", "--dry-run", "--json"], cwd=ROOT / "viewer")
    assert done.returncode == 0, done.stderr
    (package,) = json.loads(done.stdout[done.stdout.index("[\n") :])
    files = {file["path"] for file in package["files"]}
    assert files == {"package.json", "README.md", "viewer.js", "viewer.licenses.md", NOTICES, *LICENCES}
    assert "dependencies" not in json.loads((ROOT / "viewer/package.json").read_text())
