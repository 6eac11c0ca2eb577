"""The scenes in the documentation are scenes."""

import os
import re
import shutil
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import polhode as ph
import processes
import studios
from command_line import polhode
from polhode._cli import main
from viewers import needs_bundle

ROOT = Path(__file__).parents[2]
SCENES = re.findall(r"```toml\n(.*?)```", (ROOT / "docs/scenes.md").read_text(), flags=re.DOTALL)


@pytest.mark.parametrize("text", SCENES, ids=lambda text: text.splitlines()[1][:20])
def test_scenes_run(text, tmp_path):
    shutil.copy(ROOT / "examples/t-handle.stl", tmp_path)
    path = tmp_path / "scene.toml"
    path.write_text(text)
    scene = ph.Scene.read(path)
    if scene.ensemble is not None:
        state, _, _ = scene.ensemble.draw(count=3)
        assert state.rotor.shape == (3,)
    trajectory = replace(scene, ensemble=None).run()
    assert trajectory.certificate.worst < 1e-10


HANDOUT = sorted((ROOT / "docs/handout").glob("*.md"))
THEORY = sorted((ROOT / "docs/theory").glob("[!i]*.md"))
PAGES = [
    "start",
    *(f"handout/{page.stem}" for page in HANDOUT),
    *(f"theory/{page.stem}" for page in THEORY),
    "gallery",
    "howto",
    "signs",
    "algebra",
    "motors",
    "pga",
    "cga",
    "formulas",
    "motion",
    pytest.param("fitting", marks=pytest.mark.slow),
    pytest.param("jax", marks=pytest.mark.slow),
    "scenes",
    pytest.param("viewer", marks=needs_bundle),
]
# The pages of a day each use several extras.
DAYS = ["roboticist", "attitude-engineer", "geometric-algebraist"]
EXTRAS = ("jax", "sympy", "anywidget", "matplotlib", "pandas", "pyarrow", "scipy", "xarray")


@pytest.mark.parametrize("name", [*PAGES, *DAYS])
def test_the_pages_run_and_print_their_comments(name, tmp_path):
    for needed in EXTRAS if name in DAYS else EXTRAS[:3]:
        pytest.importorskip(needed)
    # Pages read the examples, as `polhode examples` copies them, and write their files here.
    shutil.copytree(ROOT / "examples", tmp_path, dirs_exist_ok=True)
    blocks = blocks_of(ROOT / f"docs/{name}.md")
    code = "\n".join(text for language, text in blocks if language == "python")
    environment = {**os.environ, "MPLBACKEND": "agg"}
    done = processes.run([sys.executable, "-W", "error", "-c", code], cwd=tmp_path, env=environment)
    assert done.returncode == 0, done.stderr
    expected = []
    for language, text in blocks:
        if language == "python":
            expected += re.findall(r"^print\(.*\)  # (.*)$", text, flags=re.MULTILINE)
        elif language == "text":
            expected += text.splitlines()
    assert done.stdout.splitlines() == expected


def test_the_shell_answers_as_the_page_says():
    text = "".join(text for language, text in blocks_of(ROOT / "docs/formulas.md") if language == "console")
    commands = [part.split("\n", 1) for part in text.removeprefix("$ ").split("\n$ ")]
    assert len(commands) == 4
    environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
    for command, answer in commands:
        done = processes.run(["bash", "-c", command], env=environment)
        assert (done.returncode, done.stderr) == (0, "")
        # Residuals of rounding differ between machines.
        got, expected = (re.sub(r"residual \S+", "residual …", x.strip()) for x in (done.stdout, answer))
        assert got == expected


@pytest.mark.parametrize(("page", "count"), [("viewer", 3), ("start", 4)])
def test_the_commands_of_a_page_are_commands(page, count):
    text = "".join(text for language, text in blocks_of(ROOT / f"docs/{page}.md") if language == "console")
    commands = re.findall(r"^\$ polhode ((?!--version).*)$", text, flags=re.MULTILINE)
    assert len(commands) == count
    for command in commands:
        options = main._parser().parse_args(command.split())
        assert callable(options.command)


@pytest.mark.slow
def test_the_page_of_figures_runs(tmp_path):
    pytest.importorskip("matplotlib")
    studios.require_browser()
    shutil.copytree(ROOT / "examples", tmp_path, dirs_exist_ok=True)
    blocks = blocks_of(ROOT / "docs/figures.md")
    asked = (
        "".join(text for language, text in blocks if language == "console").removeprefix("$ ").split("\n$ ")
    )
    assert len(asked) == 5
    for command, answer in (part.split("\n", 1) for part in asked):
        done = polhode(*command.split()[1:], cwd=tmp_path)
        assert (done.returncode, done.stderr) == (0, "")
        assert done.stdout.strip() == answer.strip()
    (code,) = (text for language, text in blocks if language == "python")
    done = processes.run([sys.executable, "-W", "error", "-c", code], cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    expected = re.findall(r"^ *print\(.*\)  # (.*)$", code, flags=re.MULTILINE)
    assert [line.strip() for line in done.stdout.splitlines()] == expected
    written = {"polhode.svg", "scene.pdf", "turned.svg", "plate.gif", "locus.pdf", "column.pdf"}
    examples = {path.name for path in (ROOT / "examples").iterdir()}
    assert {path.name for path in tmp_path.iterdir()} == examples | written


def blocks_of(page):
    return re.findall(r"```(\w+)\n(.*?)```", page.read_text(), flags=re.DOTALL)


def test_there_are_scenes():
    assert len(SCENES) == 11


@pytest.mark.parametrize(
    "solid", ["box", "ellipsoid", "sphere", "hollow_sphere", "cylinder", "capsule", "cone"]
)
def test_solids_are_documented(solid):
    assert f'"{solid}"' in (ROOT / "docs/scenes.md").read_text()
