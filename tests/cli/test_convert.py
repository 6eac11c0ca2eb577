"""`polhode convert` among netCDF, CSV, Parquet and AEM."""

import functools
import itertools

import numpy as np
import pytest

import polhode as ph
from command_line import SCENE, polhode
from motions import ASYMMETRIC, START

MOTION = ph.simulate(ASYMMETRIC, START, np.linspace(0, 1, 5), ph.torque.heavy([0.3, 0, 2]))
AEM = ["--epoch", "2026-01-01T00:00:00", "--reference-frame", "EME2000"]
FORMS = ("nc", "csv", "parquet", "aem")


@pytest.fixture
def convert(command):
    """Return a function that runs the subcommand in this process, in a folder of its own."""
    return functools.partial(command, "convert")


@pytest.mark.parametrize(("a", "b"), [*itertools.product(FORMS, FORMS)])
def test_every_format_to_every_other(a, b, convert, tmp_path):
    if a == "aem":
        ph.io.write_aem(MOTION, f"a.{a}", epoch="2026-01-01T00:00:00", reference_frame="EME2000")
    else:
        MOTION.save(f"a.{a}")
    done = convert(f"a.{a}", f"b.{b}", *(AEM if b == "aem" and a != "aem" else []))
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == f"Written\n  b.{b}\n"
    found = ph.io.read(f"b.{b}")
    assert found.time.tolist() == MOTION.time.tolist()
    assert np.array_equal(found.rotor.components, MOTION.rotor.components)
    np.testing.assert_allclose(found.omega_body.components, MOTION.omega_body.components, rtol=4e-16)
    # A file of ours is replaced without --force.
    assert convert(f"a.{a}", f"b.{b}", *(AEM if b == "aem" and a != "aem" else [])).returncode == 0


@pytest.mark.parametrize("form", ["nc", "csv", "parquet"])
def test_speeds_of_wheels_are_converted(form, convert, tmp_path):
    wheels = ph.torque.reaction_wheels(axes=[[0, 0, 1.0], [0, 1, 0]], inertias=0.1, speeds=[3.0, -1.0])
    motion = ph.simulate(ASYMMETRIC, START, [0, 1, 2], wheels)
    motion.save("a.nc")
    assert np.array_equal(ph.Trajectory.read("a.nc").wheel_speed, motion.wheel_speed)
    assert convert("a.nc", f"b.{form}").returncode == 0
    assert np.array_equal(ph.io.read(f"b.{form}").wheel_speed, motion.wheel_speed)


def test_a_table_of_attitudes_is_not_taken_for_one_of_ours(convert, tmp_path):
    """It has the columns that a converted AEM has; other programs read both alike."""
    MOTION.save("a.nc")
    assert convert("a.nc", "a.aem", *AEM).returncode == 0
    assert convert("a.aem", "b.csv").returncode == 0
    text = (tmp_path / "b.csv").read_text()
    assert text.startswith('"time",attitude_w,attitude_x,attitude_y,attitude_z')
    columns = pytest.importorskip("pandas").read_csv("b.csv").columns
    assert list(columns) == text.partition("\n")[0].replace('"', "").split(",")
    (tmp_path / "b.csv").write_text(text.replace('"', ""))
    done = convert("a.aem", "b.csv")
    assert done.returncode == 1
    assert "b.csv exists and was not written by polhode" in done.stderr
    assert convert("b.csv", "c.nc").returncode == 0


def test_the_command_reads_what_the_command_wrote(tmp_path, scene):
    """As programs of their own: they import no more than they need."""
    assert polhode("run", scene, "-o", "a.nc", "--no-figures", cwd=tmp_path).returncode == 0
    steps = [*itertools.pairwise(["a.nc", "b.aem", "c.csv", "d.nc"]), ("a.nc", "e.glb")]
    for source, target in steps:
        done = polhode("convert", source, target, *(AEM if target == "b.aem" else []), cwd=tmp_path)
        assert (done.returncode, done.stderr) == (0, "")
        assert done.stdout == f"Written\n  {target}\n"
    done = polhode("convert", "d.nc", "f.glb", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert "the shape of the body is not known; give --scene=FILE.toml" in done.stderr


def test_netcdf_keeps_the_certificate(convert):
    MOTION.save("a.nc")
    assert convert("a.nc", "b.nc").returncode == 0
    assert ph.Trajectory.read("b.nc").certificate == MOTION.certificate


def test_what_is_missing_is_asked_for_by_option(convert, tmp_path):
    MOTION.save("a.nc")
    done = convert("a.nc", "b.aem")
    assert done.returncode == 2
    assert "the epoch of time 0 is not known; give --epoch='YYYY-MM-DDThh:mm:ss'" in done.stderr
    assert not (tmp_path / "b.aem").exists()
    ph.io.write_aem(MOTION, "c.aem", epoch="2026-01-01T00:00:00", reference_frame="EME2000", version="1.0")
    text = (tmp_path / "c.aem").read_text().replace("QUATERNION_TYPE = LAST\n", "")
    (tmp_path / "c.aem").write_text(text)
    done = convert("c.aem", "c.csv")
    assert done.returncode == 3
    assert "the segment has no QUATERNION_TYPE; give --quaternion-type='FIRST' or" in done.stderr
    assert convert("c.aem", "c.csv", "--quaternion-type", "LAST").returncode == 0


@pytest.mark.parametrize(
    ("arguments", "code", "expected"),
    [
        (("a.txt", "b.nc"), 2, "files that can be read end in .aem, .bc, .csv, .nc, .parquet or .zarr"),
        (("a.nc", "b.txt"), 2, "files that can be written end in"),
        (("a.toml", "b.nc"), 2, "a .toml file has no motion, got 'a.toml'; a body is written as .urdf"),
        (("a.nc", "b.csv", "--epoch", "2026-01-01T00:00:00"), 2, "--epoch does not apply from .nc to .csv"),
        (
            ("a.nc", "b.aem", "--epoch", "soon", "--reference-frame", "A"),
            2,
            "--epoch: an epoch must be YYYY-MM-DD",
        ),
        (("none.csv", "b.nc"), 3, "none.csv: error: no such file"),
        (("none.nc", "b.csv"), 3, "none.nc: error: no such file"),
        (("none.zarr", "b.csv"), 3, "none.zarr: error: no such store"),
        (("none.urdf", "b.xml"), 3, "none.urdf: error: no such file"),
        (("none.stl", "b.urdf", "--mass", "1"), 3, "none.stl: error: no such file"),
        (("bad.obj", "b.urdf"), 2, "a mesh needs --density in kg/m³ or --mass in kg, and not both"),
        (("bad.obj", "b.urdf", "--mass", "1"), 3, "bad.obj: error: the mesh has no triangles"),
        (("bad.obj", "b.stl"), 3, "bad.obj: error: the mesh has no triangles"),
        (("a.nc", "bad.csv/b.csv"), 1, "bad.csv is not a directory"),
        (("bad.csv", "b.nc"), 3, "bad.csv:1:1: error: column 'q' is not known"),
        (("mine.zarr", "b.csv"), 3, "mine.zarr: error: a file, and a Zarr store is a folder"),
        (("a.nc", "b.glb", "--scene", "a.toml"), 1, "a.toml gives no mesh, solid or mass; add one to its"),
        (("a.nc", "foreign.csv"), 1, "foreign.csv exists and was not written by polhode"),
        (("a.nc", "none/b.csv"), 1, "no such directory"),
    ],
)
def test_wrong_uses(arguments, code, expected, convert, tmp_path):
    MOTION.save("a.nc")
    (tmp_path / "bad.csv").write_text("time,q\n0,1\n")
    (tmp_path / "bad.obj").write_text("v 0 0 0\n")
    (tmp_path / "foreign.csv").write_text("mine")
    (tmp_path / "mine.zarr").write_text("mine")
    (tmp_path / "a.toml").write_text(SCENE)
    done = convert(*arguments)
    assert done.returncode == code
    assert expected in done.stderr
    assert (tmp_path / "foreign.csv").read_text() == "mine"
    assert convert("a.nc", "foreign.csv", "--force").returncode == 0


def test_a_body_of_an_ensemble_becomes_a_motion(convert, command, tmp_path):
    """As the error of `polhode view` for a file of many bodies says."""
    (tmp_path / "many.toml").write_text(SCENE + "[ensemble]\nnumber = 3\nattitude = 'uniform'\n")
    assert command("run", "many.toml", "-o", "many.nc", "--no-figures", "--quiet").returncode == 0
    done = command("view", "many.nc", "--no-browser")
    remedy = done.stderr.partition("polhode convert ")[2].split()
    assert convert(*remedy).returncode == 0
    motion, member = ph.Trajectory.read("one.nc"), ph.io.read("many.nc", body=0)
    assert np.array_equal(motion.rotor.components, member.rotor.components)
    assert np.array_equal(motion.energy, member.energy)
    assert not motion.position.components.any()


def test_a_scene_gives_a_table_its_inertia(convert, tmp_path):
    MOTION.save("a.csv")
    (tmp_path / "a.toml").write_text(SCENE.replace("[initial]", "mass = 6\n[initial]"))
    assert convert("a.csv", "a.glb", "--scene", "a.toml").returncode == 0
    motion = ph.io.read("a.csv").trajectory(ph.Inertia.from_principal_moments(1, 2, 3))
    ph.io.write_gltf(motion, "b.glb", mass=6)
    assert (tmp_path / "a.glb").read_bytes() == (tmp_path / "b.glb").read_bytes()


def test_a_scene_makes_a_table_a_motion(convert, tmp_path):
    """The netCDF file has the inertia of the scene's body, so that it can be shown."""
    MOTION.save("a.csv")
    (tmp_path / "a.toml").write_text(SCENE)
    assert convert("a.csv", "a.nc", "--scene", "a.toml").returncode == 0
    motion = ph.Trajectory.read("a.nc")
    assert np.array_equal(motion.rotor.components, MOTION.rotor.components)
    np.testing.assert_allclose(motion.inertia.matrix, np.diag([1, 2, 3]), atol=1e-15)
    done = convert("a.nc", "b.nc", "--scene", "a.toml")
    assert (done.returncode, "a.nc has the inertia of its body; leave out --scene" in done.stderr) == (
        2,
        True,
    )
    (tmp_path / "other.toml").write_text(SCENE.replace("[1, 2, 3]", "[2, 2, 3]"))
    done = convert("a.csv", "b.nc", "--scene", "other.toml")
    assert done.returncode == 3
    assert "a.csv: error: the angular momentum differs from that of the body of other.toml by" in done.stderr
    assert not (tmp_path / "b.nc").exists()


def test_a_renamed_file_is_recognised(convert, tmp_path):
    MOTION.save("a.nc")
    (tmp_path / "a.nc").rename(tmp_path / "a.dat")
    assert convert("a.dat", "a.csv").returncode == 0
    assert np.array_equal(ph.io.read("a.csv").rotor.components, MOTION.rotor.components)
