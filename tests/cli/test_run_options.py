"""Options of `polhode run` and `check`: files that exist, no figures, quiet, and standard input."""

import io
import json
import shutil
import sys
import tempfile
from pathlib import Path

import pytest

import polhode as ph
from command_line import EXAMPLES, SCENE, polhode
from polhode._cli import main

ENSEMBLE = SCENE + '[ensemble]\nnumber = 3\nattitude = "uniform"\n'


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def require(form):
    for needed in {"nc": ["h5netcdf", "xarray"], "parquet": ["pandas", "pyarrow"]}.get(form, []):
        pytest.importorskip(needed)


def run(*arguments):
    return main.main(["run", *map(str, arguments)])


# --- files that exist


@pytest.mark.parametrize("form", ["nc", "csv", "parquet"])
def test_own_files_are_overwritten(form, scene, tmp_path, capsys):
    require(form)
    # Figures take a second.
    figures = ["--no-figures"] * (form != "csv")
    if not figures:
        pytest.importorskip("matplotlib")
    output = tmp_path / f"out.{form}"
    assert run(scene, "-o", output, *figures) == 0
    before = {path: path.stat().st_ino for path in tmp_path.glob("out*")}
    assert len(before) == (1 if figures else 3)
    assert run(scene, "-o", output, *figures) == 0
    assert capsys.readouterr().err == ""
    # Each is a new file, renamed.
    assert all(path.stat().st_ino != inode for path, inode in before.items())


def test_a_file_of_save_and_of_an_ensemble_is_own(scene, tmp_path, capsys):
    require("nc")
    ph.Scene.read(scene).run().save(tmp_path / "out.nc")
    scene.write_text(ENSEMBLE)
    for _ in range(2):
        assert run(scene, "-o", tmp_path / "out.nc", "--no-figures") == 0
    scene.write_text(SCENE)
    assert run(scene, "-o", tmp_path / "out.nc", "--no-figures") == 0
    assert capsys.readouterr().err == ""


FOREIGN = {
    "out.nc": b"\x89HDF\r\n\x1a\n" + bytes(100),
    "text.nc": b"notes",
    "out.csv": b"time,price\n1,2\n",
    "binary.csv": bytes(range(256)),
    "lines.csv": b"\n\n",
    "out.parquet": b"PAR1" + bytes(50) + b"PAR1",
    "out-motion.png": b"\x89PNG\r\n\x1a\n" + bytes(100),
    "out.html": b"<!doctype html><title>My page</title>",
}


@pytest.mark.usefixtures("bundle")
@pytest.mark.parametrize("name", FOREIGN)
def test_a_file_of_others_is_kept(name, scene, tmp_path, capsys):
    form = name.partition(".")[2]
    require(form)
    (tmp_path / name).write_bytes(FOREIGN[name])
    before = names(tmp_path)
    if form == "html":
        arguments = ["--html", tmp_path / name]
    elif form == "png":
        pytest.importorskip("matplotlib")
        arguments = ["-o", tmp_path / "out.csv"]
    else:
        arguments = ["-o", tmp_path / name, "--no-figures"]
    assert run(scene, *arguments) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err == (
        f"polhode: error: {tmp_path / name} exists and was not written by polhode: choose another name, or "
        "overwrite it with --force\n"
    )
    assert names(tmp_path) == before
    assert (tmp_path / name).read_bytes() == FOREIGN[name]
    assert run(scene, *arguments, "--force") == 0
    assert (tmp_path / name).read_bytes() != FOREIGN[name]
    # Now it is polhode's.
    assert run(scene, *arguments) == 0


def test_foreign_data_files_are_kept(scene, tmp_path, capsys):
    """Files in the same format, by other programs."""
    pd = pytest.importorskip("pandas")
    require("parquet")
    pd.DataFrame({"a": [1.0]}).to_parquet(tmp_path / "a.parquet")
    xr = pytest.importorskip("xarray")
    require("nc")
    xr.Dataset({"a": [1.0]}, attrs={"source": "buoys"}).to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    for name in ("a.parquet", "a.nc"):
        assert run(scene, "-o", tmp_path / name, "--no-figures") == 1
        assert f"{name} exists and was not written by polhode" in capsys.readouterr().err


def test_an_empty_file_is_overwritten(scene, tmp_path):
    (tmp_path / "out.csv").touch()
    assert run(scene, "-o", tmp_path / "out.csv", "--no-figures") == 0
    assert (tmp_path / "out.csv").stat().st_size > 1000


def test_force_does_not_replace_a_folder(scene, tmp_path, capsys):
    (tmp_path / "out.csv").mkdir()
    assert run(scene, "-o", tmp_path / "out.csv", "--force", "--no-figures") == 1
    assert "not a regular file" in capsys.readouterr().err


# --- no figures, quiet


@pytest.mark.parametrize("text", [SCENE, ENSEMBLE], ids=["one", "ensemble"])
def test_no_figures_needs_no_matplotlib(text, scene, tmp_path, monkeypatch, capsys):
    require("nc")
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    scene.write_text(text)
    assert run(scene, "-o", tmp_path / "a.nc", "--no-figures") == 0
    assert names(tmp_path) == ["a.nc", "small.toml"]
    assert capsys.readouterr().out.endswith(f"\nWritten\n  {tmp_path / 'a.nc'}\n")


@pytest.mark.parametrize("text", [SCENE, ENSEMBLE], ids=["one", "ensemble"])
def test_a_quiet_run_prints_nothing(text, scene, tmp_path, capsys):
    require("nc")
    scene.write_text(text)
    assert run(scene, "-o", tmp_path / "a.nc", "--no-figures", "--quiet") == 0
    assert capsys.readouterr() == ("", "")
    assert (tmp_path / "a.nc").exists()


def test_a_quiet_check_prints_errors_only(scene, tmp_path, capsys):
    assert main.main(["check", "--quiet", str(scene)]) == 0
    assert capsys.readouterr() == ("", "")
    bad = tmp_path / "bad.toml"
    bad.write_text(SCENE.replace("duration", "durration"))
    assert main.main(["check", "--quiet", str(scene), str(bad)]) == 3
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "durration" in captured.err


def test_a_quiet_run_reports_drift_by_its_exit_code(scene, capsys):
    scene.write_text(SCENE + 'step = "0.1 s"\nmethod = "strang"\ndrift_bound = 1e-30\n')
    assert run(scene, "--quiet") == 4
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("command", ["run", "check"])
def test_quiet_and_json_exclude_each_other(command, scene, capsys):
    with pytest.raises(SystemExit) as stop:
        main.main([command, str(scene), "--quiet", "--json"])
    assert stop.value.code == 2
    assert "not allowed with" in capsys.readouterr().err


# --- a scene on standard input


def test_a_scene_on_standard_input_runs_as_its_file(scene, tmp_path):
    own = json.loads(polhode("run", scene, "--json").stdout)
    done = polhode("run", "-", "-o", "out.csv", "--no-figures", "--json", input=SCENE, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    found = json.loads(done.stdout)
    assert found["scene"] == "<stdin>"
    assert {**found, "scene": own["scene"], "files": []} == own
    ph.Scene.read(scene).run().save(tmp_path / "own.csv")
    assert (tmp_path / "out.csv").read_bytes() == (tmp_path / "own.csv").read_bytes()
    checked = polhode("check", "-", scene, input=SCENE, cwd=tmp_path)
    assert checked.returncode == 0
    assert checked.stdout.startswith("-: ok, ")


def test_a_figure_of_standard_input_is_that_of_its_file(scene, tmp_path):
    pytest.importorskip("matplotlib")
    for name, given in (("a.svg", scene), ("b.svg", "-")):
        done = polhode("figure", "polhode", given, "-o", name, input=SCENE, cwd=tmp_path)
        assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


@pytest.mark.parametrize("command", ["run", "check", "film -o a.gif", "figure -o a.svg motion"])
def test_errors_in_standard_input_have_a_place(command, tmp_path):
    done = polhode(*command.split(), "-", input=SCENE.replace("duration", "durration"), cwd=tmp_path)
    assert done.returncode == 3
    assert done.stdout == ""
    assert "<stdin>:7:1: error: unknown field `durration`" in done.stderr
    assert str(Path(tempfile.gettempdir())) not in done.stderr


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "<stdin>: error: the file is empty"),
        (b'title = "caf\xe9"\n', "<stdin>: error: not UTF-8 text from byte 12 on\n"),
        (b"#" * 20_000_000, "<stdin>: error: larger than 10 MB"),
    ],
    ids=["empty", "latin", "huge"],
)
def test_standard_input_that_is_not_a_scene(content, message, monkeypatch, capsys):
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(content)))
    assert run("-") == 3
    assert capsys.readouterr().err.startswith(message)


def test_a_mesh_is_relative_to_the_current_folder(tmp_path):
    text = (EXAMPLES / "t-handle.toml").read_text().replace("samples = 6001", "samples = 21")
    below = tmp_path / "below"
    below.mkdir()
    shutil.copy(EXAMPLES / "t-handle.stl", tmp_path)
    here = polhode("check", "-", input=text, cwd=tmp_path)
    assert (here.returncode, here.stderr) == (0, "")
    above = polhode("check", "-", input=text.replace('"t-handle.stl"', '"../t-handle.stl"'), cwd=below)
    assert above.stdout == here.stdout
    absent = polhode("check", "-", input=text, cwd=below)
    assert absent.returncode == 3
    assert absent.stderr.startswith("<stdin>:")
    assert "error: t-handle.stl: cannot be read" in absent.stderr


@pytest.mark.usefixtures("bundle")
def test_the_page_of_standard_input_has_the_mesh(tmp_path, monkeypatch):
    text = (EXAMPLES / "t-handle.toml").read_text().replace("samples = 6001", "samples = 21")
    shutil.copy(EXAMPLES / "t-handle.stl", tmp_path)
    monkeypatch.chdir(tmp_path)
    pages = []
    for scene in ("-", "t-handle.toml"):
        (tmp_path / "t-handle.toml").write_text(text)
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(text.encode())))
        assert run(scene, "--html", "a.html", "--quiet") == 0
        pages.append((tmp_path / "a.html").read_text())
    assert '"t-handle.stl": ' in pages[0]
    # Its < is escaped as JSON in a page.
    assert pages[0].replace("\\u003cstdin>", "t-handle.toml") == pages[1]


def test_a_closed_standard_input_is_an_error(monkeypatch, capsys):
    monkeypatch.setattr(sys, "stdin", None)
    assert run("-") == 1
    assert capsys.readouterr().err == (
        "polhode: error: standard input is closed; give the path of a scene file\n"
    )


def test_counts_of_one_are_singular(tmp_path, command):
    pytest.importorskip("zarr")
    one = '[ensemble]\nnumber = 1\nattitude = "uniform"\n\n[run]'
    (tmp_path / "one.toml").write_text(SCENE.replace("[run]", one))
    assert ", 1 body, " in command("check", "one.toml").stdout
    done = command("run", "one.toml", "-o", "one.zarr")
    assert done.stdout.startswith("one.zarr: 1 of 1 body, 1 of 1 block\n")
    done = command("run", "--status", "one.zarr")
    assert "  done     1 block, bodies 0:1\n  missing  0 blocks\n" in done.stdout
    assert ": 1 of 1 body\n" in command("run", "one.toml", "--no-figures").stdout
