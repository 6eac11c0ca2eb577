"""Files of motions whose numbers mean something else: units, packing, order, missing values."""

import numpy as np
import pytest

import polhode as ph
from command_line import SCENE
from motions import ASYMMETRIC, START

pytest.importorskip("zarr")
xr = pytest.importorskip("xarray")
h5py = pytest.importorskip("h5py")

MOTION = ph.simulate(ASYMMETRIC, START, [0, 1, 2])  # three times: a transposed quantity has the same shape


def _unit(name, unit):
    return lambda data: data.assign({name: data[name].assign_attrs(units=unit)})


def _value(name, place, value):
    def change(data):
        data[name].values[place] = value
        return data

    return change


CHANGES = {
    "rates in degrees": (
        _unit("omega_body", "deg/s"),
        "'omega_body' has the unit 'deg/s'; convert .* 'rad/s'",
    ),
    "positions in km": (_unit("position", "km"), "'position' has the unit 'km'"),
    "scalar last": (
        lambda data: data.isel(quaternion=[1, 2, 3, 0]),
        "'quaternion' has the order x, y, z, w; reorder the components to w, x, y, z",
    ),
    "axes reversed": (lambda data: data.isel(axis=[2, 1, 0]), "'axis' has the order z, y, x"),
    "axes first": (
        lambda data: data.transpose("axis", "quaternion", "inertia_column", "time"),
        "has the dimensions .*, time; transpose it to time, ",
    ),
}


@pytest.mark.parametrize("form", ["nc", "zarr"])
@pytest.mark.parametrize("name", CHANGES)
@pytest.mark.filterwarnings("ignore::UserWarning")  # texts in Zarr v3
def test_numbers_that_mean_something_else(name, form, tmp_path):
    change, message = CHANGES[name]
    data, path = change(MOTION.to_xarray()), tmp_path / f"a.{form}"
    if form == "nc":
        data.to_netcdf(path, engine="h5netcdf")
        with pytest.raises(ValueError, match=message):
            ph.Trajectory.read(path)
    else:
        data.to_zarr(path, zarr_format=2)
    with pytest.raises(ph.io.FileError, match=rf"a\.{form}: error: .*{message}"):
        ph.io.read(path)


def test_times_in_another_unit(tmp_path):
    for unit in ("ms", "seconds since 2000-01-01"):
        MOTION.save(tmp_path / "a.nc")
        with h5py.File(tmp_path / "a.nc", "r+") as file:
            file["time"].attrs["units"] = unit
        with pytest.raises(ph.io.FileError, match=f"'time' has the unit '{unit}'; convert its values to 's'"):
            ph.io.read(tmp_path / "a.nc")


@pytest.mark.parametrize(
    ("packed", "message"),
    [
        (
            {"dtype": "i4", "scale_factor": 1e-6, "_FillValue": -1},
            "'energy' is packed with scale_factor 1e-06",
        ),
        ({"_FillValue": -999.0}, r"'energy' has the missing value -999.0 at index 1; remove such rows"),
    ],
)
def test_packed_and_missing_values(packed, message, tmp_path):
    data = _value("energy", 1, np.nan)(MOTION.to_xarray())
    data.to_netcdf(tmp_path / "a.nc", engine="h5netcdf", encoding={"energy": packed})
    for read in (ph.io.read, ph.Trajectory.read):
        with pytest.raises(ValueError, match=message):
            read(tmp_path / "a.nc")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (_value("attitude", (1, 0), np.nan), "nan at row 1"),
        (_value("attitude", slice(None), 1.0), "attitude must be unit quaternions, got norm 2 at row 0"),
        (_value("energy", 2, np.inf), "energy must be finite, got inf at row 2"),
        (lambda data: data.isel(time=[0, 2, 1]), "times must increase, got 1.0 s after 2.0 s at row 2"),
    ],
)
def test_states_that_are_not_those_of_a_motion(change, message, tmp_path):
    change(MOTION.to_xarray()).to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    for read in (ph.io.read, ph.Trajectory.read):
        with pytest.raises(ValueError, match=message):
            read(tmp_path / "a.nc")


def test_whole_numbers_and_other_byte_orders_are_read(tmp_path):
    data = MOTION.to_xarray().assign_coords(time=("time", np.array([0, 1, 2], ">i2"), {"units": "s"}))
    data["attitude"] = data.attitude.astype(">f8")
    data.to_netcdf(tmp_path / "a.nc", engine="h5netcdf", unlimited_dims=["time"])
    found = ph.Trajectory.read(tmp_path / "a.nc")
    assert found.time.dtype == float
    assert np.array_equal(found.rotor.components, MOTION.rotor.components)


def test_units_of_a_parquet_file(tmp_path):
    pytest.importorskip("pyarrow")
    frame = MOTION.to_dataframe()
    frame.attrs["units"]["omega_body_y"] = "deg/s"
    frame.to_parquet(tmp_path / "a.parquet")
    with pytest.raises(
        ph.io.FileError, match="column 'omega_body_y' has the unit 'deg/s'; convert its values"
    ):
        ph.io.read(tmp_path / "a.parquet")


def test_heaps_in_which_hdf5_would_search_without_end(tmp_path):
    """An object of a heap has the size 0: HDF5 would not go on to the next."""
    path = tmp_path / "a.nc"
    MOTION.save(path)
    content = bytearray(path.read_bytes())
    at = content.find(b"GCOL") + 16
    content[at : at + 16] = bytes(16)
    path.write_bytes(content)
    for read in (ph.io.read, ph.Trajectory.read):
        with pytest.raises((ph.io.FileError, OSError), match=f"the heap of texts is damaged at byte {at}"):
            read(path)


def test_labels_of_a_store_that_state_too_many_texts(tmp_path):
    """Zarr would make room for four billion texts."""
    path = tmp_path / "a.zarr"
    (tmp_path / "a.toml").write_text(SCENE + '[ensemble]\nnumber = 2\nattitude = "uniform"\n')
    ph.Scene.read(tmp_path / "a.toml").run(store=path)
    chunk = path / "axis" / "c.0"
    assert chunk.read_bytes()[:4] == b"\3\0\0\0"
    chunk.write_bytes(b"\xff" * 4 + chunk.read_bytes()[4:])
    with pytest.raises(ph.io.FileError, match=r"'axis' is damaged: it has 3 texts, but states 4294967295"):
        ph.io.read(path, body=1)
    (path / ".polhode" / "run.json").write_text("{")
    with pytest.raises(ph.io.FileError, match=r"a\.zarr: error: is not a store of an ensemble"):
        ph.io.read(path, body=1)
