"""Motions saved as CSV and Parquet, from Python and by the command."""

import csv

import numpy as np
import pytest

import polhode as ph
from command_line import EXAMPLES, SCENE, polhode
from motions import ASYMMETRIC, START

TIMES = np.linspace(0, 1, 7)
ALONE = ph.simulate(ASYMMETRIC, START, TIMES, ph.torque.heavy([0.3, 0, 2]))
MANY = ph.simulate(ASYMMETRIC, ph.State(ph.Rotor.random((2, 3), rng=1), [0.25, -0.5, 1.0]), TIMES)
MOTIONS = pytest.mark.parametrize("motion", [ALONE, MANY], ids=["alone", "batch"])
FAILED = ph.simulate(
    ASYMMETRIC,
    ph.State(ph.Rotor.identity((2,)), [[0, 0, 1.0], [0, 0, 1e150]]),
    TIMES,
    ph.torque.heavy([0.3, 0, 2]),
    method="rk4",
    step=0.01,
)


def rows_of(path):
    with path.open(newline="") as file:
        header, *rows = csv.reader(file)
    return header, np.array(rows, float)


@MOTIONS
def test_csv_reads_back_to_the_same_bits(motion, tmp_path):
    """By the csv module alone; the columns are those of the data frame."""
    motion.save(tmp_path / "a.csv")
    header, rows = rows_of(tmp_path / "a.csv")
    many = int(bool(motion.shape))
    assert header[: 2 + many] == ["body", "time", "attitude_w"][1 - many :]
    count = int(np.prod(motion.shape))
    np.testing.assert_array_equal(rows[:, many], np.tile(TIMES, count))
    if many:
        np.testing.assert_array_equal(rows[:, 0], np.repeat(np.arange(count), len(TIMES)))
    column = header.index("omega_body_x")
    omega = motion.omega_body.components.reshape(-1, 3)
    np.testing.assert_array_equal(rows[:, column : column + 3], omega)
    np.testing.assert_array_equal(rows[:, -1], motion.energy.ravel())
    assert len(rows[0]) == len(header)


@MOTIONS
def test_csv_is_read_by_pandas(motion, tmp_path):
    pd = pytest.importorskip("pandas")
    motion.save(tmp_path / "a.csv")
    index = ["body", "time"] if motion.shape else "time"
    found = pd.read_csv(tmp_path / "a.csv", index_col=index)
    # Before version 3.1 pandas rounded the last bits of numbers by default.
    pd.testing.assert_frame_equal(found, motion.to_dataframe(), rtol=1e-14, atol=1e-15)


@MOTIONS
def test_parquet_keeps_values_index_and_units(motion, tmp_path):
    pd = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    motion.save(tmp_path / "A.PARQUET")
    found, expected = pd.read_parquet(tmp_path / "A.PARQUET"), motion.to_dataframe()
    pd.testing.assert_frame_equal(found, expected, check_exact=True)
    assert found.attrs == expected.attrs
    assert found.attrs["units"]["energy"] == "J"


def test_attributes_of_the_user_are_kept_in_parquet(tmp_path):
    pd = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    motion = ph.simulate(ASYMMETRIC, START, TIMES)
    motion.attributes.update(run=np.int64(3), gains=np.ones(2), units="mine")
    motion.save(tmp_path / "a.parquet")
    found = pd.read_parquet(tmp_path / "a.parquet").attrs
    assert (found["run"], found["gains"], found["units"]["energy"]) == (3, [1.0, 1.0], "J")
    motion.attributes["body"] = ASYMMETRIC
    with pytest.raises(TypeError, match=r"attributes\['body'\] of the motion is Inertia; .* convert it"):
        motion.save(tmp_path / "b.parquet")
    assert not (tmp_path / "b.parquet").exists()


def test_failed_bodies_are_nan_in_csv(tmp_path):
    FAILED.save(tmp_path / "a.csv")
    header, rows = rows_of(tmp_path / "a.csv")
    energy = rows[:, header.index("energy")]
    assert np.isfinite(energy[: len(TIMES)]).all()
    assert np.isnan(energy[-1])


def test_a_motion_without_times_is_a_header(tmp_path):
    ph.simulate(ASYMMETRIC, START, []).save(tmp_path / "a.csv")
    header, rows = rows_of(tmp_path / "a.csv")
    assert header[0] == "time"
    assert rows.size == 0


def test_csv_needs_numpy_only(tmp_path, monkeypatch):
    import sys

    for module in ("pandas", "xarray", "pyarrow"):
        monkeypatch.setitem(sys.modules, module, None)
    ALONE.save(tmp_path / "a.csv")
    assert (tmp_path / "a.csv").stat().st_size > 1000


@pytest.mark.parametrize("name", ["a.csv", "a.parquet"])
def test_an_older_file_is_replaced_whole_or_not_at_all(name, tmp_path, monkeypatch):
    import os

    for needed in ("pandas", "pyarrow")[: 2 * name.endswith("parquet")]:
        pytest.importorskip(needed)
    (tmp_path / name).write_text("older")

    def refuse(*_):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as broken:
        broken.setattr(os, "replace", refuse)
        with pytest.raises(OSError, match=rf"cannot write .*{name}: No space left"):
            ALONE.save(tmp_path / name)
    assert (tmp_path / name).read_text() == "older"
    assert [path.name for path in tmp_path.iterdir()] == [name]
    ALONE.save(tmp_path / name)
    assert (tmp_path / name).stat().st_size > 1000


# --- the command


@pytest.mark.parametrize("form", ["csv", "parquet"])
def test_the_command_writes_tables(form, scene, tmp_path):
    pytest.importorskip("matplotlib")
    for needed in ("pandas", "pyarrow")[: 2 * (form == "parquet")]:
        pytest.importorskip(needed)
    done = polhode("run", scene, "-o", tmp_path / f"out.{form}")
    assert (done.returncode, done.stderr) == (0, "")
    assert f"Written\n  {tmp_path / 'out'}.{form}\n  {tmp_path / 'out-motion.png'}\n" in done.stdout
    ph.Scene.read(scene).run().save(tmp_path / f"own.{form}")
    assert (tmp_path / f"out.{form}").read_bytes() == (tmp_path / f"own.{form}").read_bytes()


@pytest.mark.parametrize("form", ["csv", "parquet"])
def test_an_ensemble_is_written_as_netcdf_only(form, scene, tmp_path):
    scene.write_text(SCENE + '[ensemble]\nnumber = 3\nattitude = "uniform"\n')
    done = polhode("run", scene, "-o", f"out.{form}", cwd=tmp_path)
    assert done.returncode == 1
    assert done.stdout == ""
    assert "has an ensemble of 3 bodies, which is written as netCDF or" in done.stderr
    assert "use -o out.nc or -o out.zarr" in done.stderr
    assert list(tmp_path.iterdir()) == [scene]


def test_the_units_of_a_scene_do_not_change_the_table(tmp_path):
    """The Earth's period is in days in its scene; tables are in SI."""
    motion = ph.Scene.read(EXAMPLES / "earth.toml").run()
    motion.save(tmp_path / "a.csv")
    header, rows = rows_of(tmp_path / "a.csv")
    np.testing.assert_array_equal(rows[:, 0], motion.time)
    assert np.linalg.norm(rows[0, 5:8]) == pytest.approx(7.292e-5, rel=1e-3)
    assert header[5] == "omega_body_x"
