"""One body of an ensemble or a batch, from netCDF files and Zarr stores, against xarray."""

import re

import numpy as np
import pytest

import polhode as ph
from command_line import SCENE
from motions import ASYMMETRIC, START
from polhode._cli.main import main

pytest.importorskip("zarr")
xr = pytest.importorskip("xarray")

# Several blocks: the first has 512 bodies.
ENSEMBLE = """
[ensemble]
number = 1000
seed = 5
attitude = "uniform"
moments = { relative = 0.05 }
velocity = { normal = [1, "2 m/s", 0] }
"""
HELD = "[gravity]\nacceleration = 9.81\n[ensemble]\nnumber = 3\nspin = { relative = 0.1 }\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A free ensemble as a.nc and a.zarr, and a heavy top in b.nc."""
    path = tmp_path_factory.mktemp("members")
    (path / "a.toml").write_text(SCENE + ENSEMBLE)
    body = "moments = [1, 2, 3]\nmass = 1\ncenter_of_mass = [0, 0, 0.5]"
    (path / "b.toml").write_text(SCENE.replace("moments = [1, 2, 3]", body) + HELD)
    for source, target in (("a.toml", "a.nc"), ("a.toml", "a.zarr"), ("b.toml", "b.nc")):
        assert main(["run", str(path / source), "-o", str(path / target), "--no-figures", "--quiet"]) == 0
    return path


@pytest.fixture(scope="module")
def data(folder):
    with xr.open_dataset(folder / "a.nc", engine="h5netcdf") as found:
        return found.load()


@pytest.mark.parametrize("name", ["a.nc", "a.zarr"])
@pytest.mark.parametrize("body", [0, 999])
def test_a_body_of_an_ensemble(name, body, folder, data):
    found = ph.io.read(folder / name, body=body)
    one = data.sel(body=body)  # by its label
    assert found.time.tolist() == one.time.values.tolist()
    wxyz = one.attitude.sel(quaternion=["w", "x", "y", "z"])
    assert np.array_equal(found.rotor.to_quaternion(order="wxyz"), wxyz)
    assert np.array_equal(found.omega_body.components, one.omega_body)
    # Constant momentum and energy are in the file once; free bodies move uniformly.
    assert (found.momentum_space.components == one.momentum_space.values).all()
    assert (found.energy == float(one.energy)).all()
    times = one.time.values[:, np.newaxis]
    assert np.array_equal(found.velocity.components, np.broadcast_to(one.velocity, (len(times), 3)))
    assert np.array_equal(found.position.components, one.position.values + times * one.velocity.values)
    np.testing.assert_allclose(found.inertia.matrix, one.inertia, rtol=0, atol=1e-15)
    spun = found.rotor(found.inertia(found.omega_body))
    np.testing.assert_allclose(spun.components, found.momentum_space.components, rtol=0, atol=1e-13)
    assert (found.attributes["title"], found.attributes["body"]) == ("Small", body)


def test_momenta_that_are_not_in_the_file_are_none(folder):
    found = ph.io.read_netcdf(folder / "b.nc", body=2)
    assert found.momentum_space is None
    assert np.ptp(found.energy) < 1e-9 * abs(found.energy[0])


@pytest.mark.parametrize("name", ["a.nc", "a.zarr"])
@pytest.mark.parametrize("form", ["csv", "nc", "parquet", "aem", "glb"])
def test_the_command_converts_one_body(name, form, folder, tmp_path, capsys):
    target = str(tmp_path / f"b.{form}")
    of_form = {"aem": ["--epoch", "2026-01-01T00:00:00", "--reference-frame", "EME2000"]}
    assert main(["convert", str(folder / name), target, "--body", "7", *of_form.get(form, [])]) == 0
    if form != "glb":  # an animation draws the box with the body's moments
        expected = ph.io.read(folder / name, body=7)
        assert np.array_equal(ph.io.read(target).rotor.components, expected.rotor.components)
    assert main(["convert", str(folder / name), target, *of_form.get(form, [])]) == 3
    assert "the file holds 1000 bodies; choose one by its number, as in --body=0" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["k.nc", "k.zarr"])
def test_reduced_outputs_have_no_attitudes(name, tmp_path, capsys):
    (tmp_path / "k.toml").write_text(
        SCENE + '[ensemble]\nnumber = 4\nspin = { relative = 0.1 }\nkeep = ["last"]\n'
    )
    files = [str(tmp_path / x) for x in ("k.toml", name, "x.csv")]
    assert main(["run", files[0], "-o", files[1], "--no-figures", "--quiet"]) == 0
    assert main(["convert", *files[1:], "--body", "3"]) == 3
    expected = r"reduced outputs only \(keep: last\); run its scene without keep in \[ensemble\]"
    assert re.search(expected, capsys.readouterr().err)


def test_a_body_of_a_batch(tmp_path):
    starts = ph.State(ph.Rotor.identity(), [[0.1, 1, 0], [0, 1, 0.2]])
    batch = ph.simulate(ASYMMETRIC, starts, np.linspace(0, 1, 5), ph.torque.heavy([0.3, 0, 2]))
    batch.save(tmp_path / "a.nc")
    found = ph.io.read(tmp_path / "a.nc", body=1)
    assert np.array_equal(found.rotor.components, batch.rotor[1].components)
    assert np.array_equal(found.momentum_space.components, batch.momentum_space[1].components)
    assert found.energy.tolist() == batch.energy[1].tolist()
    assert "batch_shape" not in found.attributes
    ph.io.write(found, tmp_path / "b.nc")  # its attributes fit in a file
    again = ph.io.read(tmp_path / "b.nc")
    assert (again.attributes["body"], again.inertia) == (1, ASYMMETRIC)


def test_stores_that_xarray_wrote(data, tmp_path):
    """Of one motion, of an ensemble without checksums, and of another kind."""
    options = {"zarr_format": 3, "consolidated": False}
    names = ["quaternion", "axis", "inertia_column"]  # texts warn in Zarr v3
    one = ph.simulate(ASYMMETRIC, START, np.linspace(0, 1, 5))
    one.to_xarray().drop_vars(names).to_zarr(tmp_path / "one.zarr", **options)
    found = ph.io.read(tmp_path / "one.zarr")
    assert np.array_equal(found.rotor.components, one.rotor.components)
    assert found.inertia == ASYMMETRIC
    with pytest.raises(ph.io.FileError, match="the store holds one body; leave out body=0"):
        ph.io.read(tmp_path / "one.zarr", body=0)
    few = data.isel(body=slice(3, 5)).drop_vars(names).drop_encoding()
    few.to_zarr(tmp_path / "few.zarr", **options)
    wxyz = ph.io.read(tmp_path / "few.zarr", body=1).rotor.to_quaternion(order="wxyz")
    assert np.array_equal(wxyz, data.attitude[4])
    xr.Dataset({"x": ("n", [1.0])}).to_zarr(tmp_path / "x.zarr", **options)
    with pytest.raises(ph.io.FileError, match="not a motion that polhode wrote: 'time' is missing"):
        ph.io.read(tmp_path / "x.zarr")


def test_a_failed_body_ends_early(data, tmp_path):
    few = data.isel(body=slice(0, 3)).copy(deep=True)
    few.attitude[1, 4:], few.attitude[2] = np.nan, np.nan
    few.to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    with pytest.warns(UserWarning, match=r"body 1 failed after 0.3 s; later times are left out"):
        assert len(ph.io.read(tmp_path / "a.nc", body=1)) == 4
    with pytest.raises(ph.io.FileError, match="body 2 has no attitudes"):
        ph.io.read(tmp_path / "a.nc", body=2)


def test_blocks_that_are_not_done(folder, tmp_path):
    store = str(tmp_path / "a.zarr")
    assert main(
        ["run", str(folder / "a.toml"), "-o", store, "--no-figures", "--quiet", "--bodies", "0:1"]
    ) in (0, 1)
    assert len(ph.io.read(store, body=511)) == 11
    with pytest.raises(
        ph.io.FileError, match="the block of body 512 is missing, as bodies 512 to 999; compute"
    ):
        ph.io.read(store, body=512)
    chunk = tmp_path / "a.zarr/attitude/c.0.0.0"
    chunk.write_bytes(b"x" + chunk.read_bytes()[1:])
    with pytest.raises(ph.io.FileError, match="the block of body 0 is corrupt"):
        ph.io.read(store, body=0)


def test_errors(folder, tmp_path):
    for name in ("a.nc", "a.zarr"):
        with pytest.raises(ph.io.FileError, match="body must be from 0 to 999, got 1000"):
            ph.io.read(folder / name, body=1000)
    ph.simulate(ASYMMETRIC, START, [0, 1]).save(tmp_path / "one.nc")
    with pytest.raises(ph.io.FileError, match="the file holds one body; leave out body=0"):
        ph.io.read(tmp_path / "one.nc", body=0)
    with pytest.raises(FileNotFoundError, match=r"none.zarr: no such store"):
        ph.io.read(tmp_path / "none.zarr", body=0)
    (tmp_path / "empty.zarr").mkdir()
    with pytest.raises(ph.io.FileError, match="cannot be read as a Zarr store"):
        ph.io.read(tmp_path / "empty.zarr", body=0)
    xr.Dataset({"x": ("body", [1.0])}).to_netcdf(tmp_path / "x.nc", engine="h5netcdf")
    xr.Dataset({"x": ("body", [1.0])}, {"body": [0]}).to_netcdf(tmp_path / "y.nc", engine="h5netcdf")
    for name in ("x.nc", "y.nc"):
        with pytest.raises(ph.io.FileError, match="'time' is missing"):
            ph.io.read(tmp_path / name, body=0)
    (tmp_path / "z.nc").write_bytes(b"\x89HDF\r\n\x1a\nmore")
    with pytest.raises(ph.io.FileError, match="cannot be read as a netCDF file"):
        ph.io.read(tmp_path / "z.nc", body=0)


# The declaration of a variable whose values are not in the file.
GIANT = {"shape": (1 << 40, 2, 4), "chunks": True, "dtype": "f8"}


@pytest.mark.parametrize("many", [False, True])
@pytest.mark.parametrize(
    ("name", "change", "expected"),
    [
        ("time", {"data": np.zeros((2, 2))}, r"time must have shape \(n,\), got \(2, 2\)"),
        ("time", {"data": 0.0}, "time must have shape|cannot be read"),
        ("attitude", {"data": np.ones((2, 2, 3))}, r"attitude must have shape|got norm"),
        ("energy", {"data": np.zeros((2, 5))}, r"energy must have shape \(2,\), a row for each time"),
        (
            "attitude",
            {"data": np.zeros((2, 2, 4), complex)},
            "'attitude' must hold real numbers, got the type",
        ),
        ("attitude", GIANT, "values of 'attitude' take|values are missing|got norm 0"),
        ("time", GIANT, "values of 'time' take|values are missing"),
        ("time", GIANT | {"shape": (1 << 24,)}, "'time' has the shape .* its values are missing"),
        ("omega_body", {}, "'omega_body' is not a variable"),
    ],
)
def test_variables_that_are_not_those_of_a_motion(many, name, change, expected, tmp_path):
    """Of any other shape, type, or so large that only its declaration is in the file."""
    h5py = pytest.importorskip("h5py")
    omega = [[0, 0, 1.0], [0, 0, 2.0]] if many else [0, 0, 1.0]
    path = tmp_path / "a.nc"
    ph.simulate(ASYMMETRIC, ph.State(ph.Rotor.identity(), omega), [0, 1]).save(path)
    with h5py.File(path, "r+") as file:
        del file[name]
        file.create_dataset(name, **change) if change else file.create_group(name)
    readers = [lambda: ph.io.read(path, body=1 if many else None)]
    if not many:
        readers.append(lambda: ph.Trajectory.read(path))
    for read in readers:
        with pytest.raises((ValueError, OSError), match=expected) as caught:
            read()
        assert str(path) in str(caught.value)


@pytest.mark.parametrize("drift", ["1e999", '{"rotor_norm": "x"}', "[]"])
def test_attributes_that_are_not_those_of_a_motion(drift, tmp_path):
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "a.nc"
    ph.simulate(ASYMMETRIC, START, [0, 1]).save(path)
    with h5py.File(path, "r+") as file:
        file.attrs["drift"], file.attrs["title"] = drift, [1.0, 2.0]
    with pytest.raises(ValueError, match="the attribute 'drift' must be numbers by name"):
        ph.Trajectory.read(path)
    assert len(ph.io.read(path)) == 2


def test_events_that_are_not_those_of_a_motion(tmp_path):
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "a.nc"
    crossing = ph.event.plane(ph.e1, ph.e1)
    ph.simulate(ASYMMETRIC, START, np.linspace(0, 9, 3), events=[crossing]).save(path)
    with h5py.File(path, "r+") as file:
        del file["event_time"]
        file["event_time"] = 1.0
    with pytest.raises(ValueError, match=r"a\.nc: is not a motion that polhode wrote"):
        ph.Trajectory.read(path)
