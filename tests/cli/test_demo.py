"""The commands `polhode demo` and `polhode examples`."""

import re
import sys
import tomllib

import numpy as np
import pytest

import polhode as ph
from command_line import EXAMPLES, ROOT, polhode
from polhode._cli import main
from polhode._cli.examples import examples
from polhode._support.file_kinds import EXAMPLES as FOLDER

# --- demo

FIGURES = {"t-handle-motion.png", "t-handle-polhode.png"}


def names(folder):
    return {path.name for path in folder.iterdir()}


def test_the_demo_writes_its_page_and_figures(bundle, tmp_path, capsys):
    pytest.importorskip("matplotlib")
    assert main.main(["demo", "-o", str(tmp_path)]) == 0
    assert names(tmp_path) == {"t-handle.html", *FIGURES}
    for name in FIGURES:
        assert (tmp_path / name).read_bytes().startswith(b"\x89PNG")
    page = (tmp_path / "t-handle.html").read_text()
    assert "<polhode-viewer titled>" in page
    assert "<title>T-handle in free flight" in page
    printed = capsys.readouterr().out
    assert printed.startswith("T-handle in free flight\n\nBody\n")
    written = [tmp_path / name for name in ("t-handle.html", *sorted(FIGURES))]
    assert printed.endswith("\nWritten\n" + "".join(f"  {path}\n" for path in written))


def test_the_sketch_has_the_flips(bundle, tmp_path, capsys):
    """The stem's angular velocity is near its largest value or its negative, and changes sign 9 times."""
    assert main.main(["demo", "-o", str(tmp_path)]) == 0
    printed = capsys.readouterr().out
    rows = [line.partition("|")[2].ljust(72) for line in printed.splitlines() if re.match(r".{10} \|", line)]
    assert len(rows) == 9
    assert {len(row) for row in rows} == {72}
    signs = [1 if top == "*" else -1 for top, bottom in zip(rows[0], rows[-1], strict=True) if top != bottom]
    assert np.count_nonzero(np.diff(signs)) == 9
    assert "9 in this run" in printed


def test_the_demo_needs_numpy_only(bundle, tmp_path, monkeypatch, capsys):
    for name in ("matplotlib", "matplotlib.figure", "scipy", "xarray", "rich"):
        monkeypatch.setitem(sys.modules, name, None)
    assert main.main(["demo", "-o", str(tmp_path)]) == 0
    assert names(tmp_path) == {"t-handle.html"}
    assert "No figures: a figure needs matplotlib: pip install 'polhode[plot]'." in capsys.readouterr().out


def test_the_demo_without_the_viewer(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("polhode._viewer.html._BUNDLE", tmp_path / "absent.js")
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    assert main.main(["demo", "-o", str(tmp_path)]) == 0
    printed = capsys.readouterr().out
    assert "No page: " in printed
    assert "make viewer" in printed
    assert "Written" not in printed
    assert names(tmp_path) == set()


def test_the_demo_creates_its_folder_and_overwrites_its_own_files(bundle, tmp_path):
    folder = tmp_path / "new" / "demo"
    assert main.main(["demo", "-o", str(folder)]) == 0
    written = names(folder)
    assert "t-handle.html" in written
    assert main.main(["demo", "-o", str(folder)]) == 0
    assert names(folder) == written


@pytest.mark.parametrize("name", ["t-handle.html", *sorted(FIGURES)])
def test_the_demo_keeps_files_of_others(name, bundle, tmp_path, capsys):
    pytest.importorskip("matplotlib")
    (tmp_path / name).write_text("mine")
    assert main.main(["demo", "-o", str(tmp_path)]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert f"{tmp_path / name} exists and was not written by polhode" in captured.err
    assert "overwrite it with --force" in captured.err
    assert names(tmp_path) == {name}
    assert (tmp_path / name).read_text() == "mine"
    assert main.main(["demo", "-o", str(tmp_path), "--force"]) == 0
    assert (tmp_path / name).read_bytes() != b"mine"


# --- examples


def test_examples_are_listed_with_their_titles():
    done = polhode("examples")
    assert (done.returncode, done.stderr) == (0, "")
    listed = dict(line.split(maxsplit=1) for line in done.stdout.splitlines())
    titles = {path.stem: tomllib.loads(path.read_text())["title"] for path in EXAMPLES.glob("*.toml")}
    assert titles.items() <= listed.items()
    assert set(listed) - set(titles) == {path.stem for path in EXAMPLES.glob("lessons/*.md")}
    assert listed["book-thrown-three-ways"] == "Lesson: A book thrown three ways"


def test_a_lesson_is_copied(tmp_path):
    done = polhode("examples", "book-thrown-three-ways.md", "-o", tmp_path)
    copied = tmp_path / "book-thrown-three-ways.md"
    assert done.stdout == f"Written\n  {copied}\nTry `polhode view {copied}`.\n"
    assert copied.read_bytes() == (EXAMPLES / "lessons" / copied.name).read_bytes()


def test_examples_are_copied_with_their_meshes(tmp_path):
    done = polhode("examples", *examples(), cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert names(tmp_path) == {path.name for path in EXAMPLES.iterdir() if path.suffix in (".toml", ".stl")}
    for path in tmp_path.iterdir():
        assert path.read_bytes() == (EXAMPLES / path.name).read_bytes()
    for path in tmp_path.glob("*.toml"):
        assert ph.Scene.read(path).title


def test_a_copy_runs(tmp_path):
    done = polhode("examples", "t-handle.toml", "-o", tmp_path)
    assert done.stdout == (
        f"Written\n  {tmp_path}/t-handle.toml\n  {tmp_path}/t-handle.stl\n"
        f"Try `polhode run {tmp_path}/t-handle.toml` or `polhode view {tmp_path}/t-handle.toml`.\n"
    )
    assert polhode("run", "t-handle.toml", cwd=tmp_path).returncode == 0


def test_no_file_is_replaced(tmp_path):
    """If one exists, none is copied."""
    (tmp_path / "t-handle.stl").write_text("mine")
    done = polhode("examples", "earth", "t-handle", cwd=tmp_path)
    assert done.returncode == 1
    assert done.stderr == ("polhode: error: t-handle.stl exists; move it, or choose another folder with -o\n")
    assert names(tmp_path) == {"t-handle.stl"}
    assert (tmp_path / "t-handle.stl").read_text() == "mine"
    # A broken link is not replaced either.
    (tmp_path / "earth.toml").symlink_to("nowhere")
    assert polhode("examples", "earth", cwd=tmp_path).returncode == 1
    assert names(tmp_path) == {"t-handle.stl", "earth.toml"}


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["t-handel"], 2, "unknown example 't-handel'; did you mean t-handle?"),
        (["scenes/earth"], 2, "unknown example 'scenes/earth'"),
        (["zzz"], 2, "unknown example 'zzz'; `polhode examples` lists them"),
    ],
)
def test_examples_that_cannot_be_copied(arguments, code, message, tmp_path):
    done = polhode("examples", *arguments, cwd=tmp_path)
    assert done.returncode == code
    assert message in done.stderr
    assert names(tmp_path) == set()


def test_a_folder_is_created_or_is_an_error(tmp_path):
    assert polhode("examples", "earth", "-o", "a/b", cwd=tmp_path).returncode == 0
    assert names(tmp_path / "a" / "b") == {"earth.toml"}
    (tmp_path / "file").write_text("mine")
    for command in (("examples", "earth"), ("demo",)):
        done = polhode(*command, "-o", "file", cwd=tmp_path)
        assert done.returncode == 1
        assert done.stderr == "polhode: error: file is not a folder; choose another one with -o\n"


def test_examples_that_are_missing(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("polhode._cli.examples.EXAMPLES", tmp_path)
    assert main.main(["examples"]) == 1
    assert f"{tmp_path} has no examples" in capsys.readouterr().err


def test_wheels_and_source_distributions_hold_the_examples():
    """Each example file but the script matches a pattern of packed files."""
    assert FOLDER.resolve() == EXAMPLES
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["maturin"]["include"]
    patterns = [entry["path"] for entry in settings if entry["format"] == ["wheel", "sdist"]]
    assert len(patterns) == len(settings)
    folders = (FOLDER, FOLDER / "lessons")
    packed = {path.name for pattern in patterns for path in ROOT.glob(pattern) if path.parent in folders}
    files = {path.name for pattern in ("*.*", "lessons/*") for path in EXAMPLES.glob(pattern)}
    assert files - packed == {"make_t_handle.py"}
