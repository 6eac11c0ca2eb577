"""The scenes in the documentation are scenes."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import polhode as ph

ROOT = Path(__file__).parent.parent
SCENES = re.findall(r"```toml\n(.*?)```", (ROOT / "docs/scenes.md").read_text(), flags=re.DOTALL)


@pytest.mark.parametrize("text", SCENES, ids=lambda text: text.splitlines()[1][:20])
def test_scenes_run(text, tmp_path):
    (tmp_path / "examples").mkdir()
    shutil.copy(ROOT / "examples/t-handle.stl", tmp_path / "examples")
    path = tmp_path / "scene.toml"
    path.write_text(text)
    trajectory = ph.Scene.read(path).run()
    assert trajectory.certificate.worst < 1e-10


def test_the_algebra_page_runs_and_prints_what_it_says():
    for needed in ("jax", "sympy"):
        pytest.importorskip(needed)
    page = (ROOT / "docs/algebra.md").read_text()
    code = "\n".join(re.findall(r"```python\n(.*?)```", page, flags=re.DOTALL))
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == re.findall(r"^print\(.*\)  # (.*)$", code, flags=re.MULTILINE)


def test_there_are_scenes():
    assert len(SCENES) == 4


@pytest.mark.parametrize(
    "solid", ["box", "ellipsoid", "sphere", "hollow_sphere", "cylinder", "capsule", "cone"]
)
def test_solids_are_documented(solid):
    assert f'"{solid}"' in (ROOT / "docs/scenes.md").read_text()
