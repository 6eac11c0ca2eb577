"""Suffixes of output files: others are refused before the run. Names that are not text."""

import os
import re
import sys

import pytest

import polhode as ph
from command_line import SCENE, polhode
from motions import ASYMMETRIC, START

MOTION = ph.simulate(ASYMMETRIC, START, [0.0, 1.0])

WRITERS = {
    "motion": (MOTION.save, r"a motion is saved as FILE\.nc, FILE\.csv or FILE\.parquet"),
    "page": (lambda path: MOTION.view().save(path), r"a page is saved as FILE\.html or FILE\.htm"),
    "film": (MOTION.film, r"a film is saved as FILE\.mp4 or FILE\.gif"),
}


@pytest.mark.parametrize("name", ["a.txt", "t.json", "noext", "a.h5", "a.nc4", "a.csv.gz", "a.xlsx", ".csv"])
@pytest.mark.parametrize("kind", WRITERS)
def test_an_unknown_suffix_is_refused(kind, name, bundle, tmp_path):
    if kind == "page":
        pytest.importorskip("anywidget")
    write, message = WRITERS[kind]
    with pytest.raises(ValueError, match=rf"{message}, not '.*{re.escape(name)}'"):
        write(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run", "small.toml", "-o"], "a motion is saved as FILE.nc, FILE.csv or FILE.parquet"),
        (["run", "small.toml", "--html"], "a page is saved as FILE.html or FILE.htm"),
        (["figure", "motion", "small.toml", "-o"], "a figure is saved as FILE.svg, FILE.pdf or FILE.png"),
        (["film", "small.toml", "-o"], "a film is saved as FILE.mp4 or FILE.gif"),
    ],
)
def test_the_command_reports_a_usage_error(arguments, message, scene):
    done = polhode(*arguments, "a.txt", cwd=scene.parent)
    assert done.returncode == 2
    assert f"{message}, not 'a.txt'" in done.stderr
    assert list(scene.parent.iterdir()) == [scene]


def test_suffixes_may_be_in_upper_case(tmp_path):
    pytest.importorskip("h5netcdf")
    MOTION.save(tmp_path / "A.NC")
    assert ph.Trajectory.read(tmp_path / "A.NC").time.tolist() == [0.0, 1.0]


@pytest.mark.skipif(sys.platform != "linux", reason="file names are text on other systems")
def test_names_need_not_be_utf_8(command, bundle):
    """A name without a title is that of the file, which figures, files and pages cannot hold."""
    pytest.importorskip("matplotlib")
    pytest.importorskip("h5netcdf")
    name, scene = os.fsdecode(b"caf\xe9"), SCENE.replace('title = "Small"\n', "")
    with open(f"{name}.toml", "w") as file:
        file.write(scene)
    with open(f"{name}-1.toml", "w") as file:
        file.write('ensemble = { number = 2, attitude = "uniform" }\n' + scene)
    with open(f"{name}-2.toml", "w") as file:
        file.write(scene.replace("moments = [1, 2, 3]", 'solid = "sphere"\nradius = 1\nmass = 1'))
    for arguments in (
        ("run", f"{name}.toml", "-o", f"{name}.nc", "--html", f"{name}.html"),
        ("run", f"{name}-1.toml", "-o", f"{name}-1.nc"),
        ("figure", "polhode", f"{name}.toml", "-o", f"{name}.svg"),
        ("convert", f"{name}.nc", f"{name}.csv"),
        ("convert", f"{name}-2.toml", f"{name}.urdf"),
    ):
        done = command(*arguments)
        assert (done.returncode, done.stderr) == (0, "")
    assert ph.Trajectory.read(f"{name}.nc").attributes["title"] == "caf\ufffd"


def test_a_name_that_is_too_long(command):
    for arguments in (("run",), ("check",), ("figure", "motion", "-o", "a.svg"), ("film", "-o", "a.gif")):
        done = command(*arguments, f"{300 * 'x'}.toml")
        assert done.returncode == 3
        assert re.match(r"x{300}\.toml: error: cannot be read: ", done.stderr)
