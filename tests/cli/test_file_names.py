"""Suffixes of output files: others are refused before the run."""

import re

import pytest

import polhode as ph
from command_line import polhode
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
