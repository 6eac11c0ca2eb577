"""Attributes and dimensions of netCDF files by the CF conventions, and older files."""

from dataclasses import replace

import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, START

xarray = pytest.importorskip("xarray")

MOTION = ph.simulate(ASYMMETRIC, START, np.linspace(0, 1, 5))


def test_global_attributes_and_dimensions():
    data = MOTION.to_xarray()
    assert data.attrs["Conventions"] == "CF-1.11"
    assert data.attrs["title"] == "Motion of a rigid body"
    assert data.attrs["history"] == f"written by polhode {ph.__version__}"
    assert data.inertia.dims == ("axis", "inertia_column")
    assert all(name.isidentifier() and not name.endswith("_") for name in data.dims)
    # Every variable has what CF asks for, and a dimension has a coordinate.
    for name, variable in data.data_vars.items():
        assert {"units", "long_name"} <= set(variable.attrs), name
    assert set(data.dims) == set(data.coords)


def test_texts_have_a_fixed_size(tmp_path):
    """HDF5 2.0.0 searches a damaged heap of strings of variable size without end; readers get str."""
    h5py = pytest.importorskip("h5py")
    title = "Kreisel, ω = 1 s⁻¹"
    titled = replace(MOTION, attributes={"title": title, "unit": "s", "empty": ""})
    titled.save(tmp_path / "a.nc")
    with h5py.File(tmp_path / "a.nc") as file:
        texts = [h5py.check_string_dtype(file.attrs.get_id(name).dtype) for name in file.attrs]
        assert all(text.length for text in texts if text)
        assert sum(text is not None for text in texts) > 6
    for attributes in (
        ph.Trajectory.read(tmp_path / "a.nc").attributes,
        xarray.open_dataset(tmp_path / "a.nc").attrs,
    ):
        assert [attributes[name] for name in ("title", "unit", "empty")] == [title, "s", ""]


MOMENTUM = "kg m^2/s"


@pytest.mark.parametrize(
    ("moments", "law", "units"),
    [
        ([1, 2, 3], None, {"energy": "J", "angular_momentum": MOMENTUM}),
        (
            [2, 2, 1],
            ph.torque.heavy([1, 0, 0]),
            {
                "energy": "J",
                "vertical_angular_momentum": MOMENTUM,
                "kovalevskaya_integral": "rad^4/s^4",
            },
        ),
        (
            [2, 2, 1],
            ph.torque.heavy([0, 0, 1]),
            {"energy": "J", "vertical_angular_momentum": MOMENTUM, "spin_angular_momentum": MOMENTUM},
        ),
        ([1, 2, 3], ph.torque.gravity_gradient(0.1), {"jacobi_integral": "J"}),
    ],
)
def test_conserved_quantities_at_the_start_have_units(moments, law, units):
    starts = ph.State(ph.Rotor.identity(), [[0.1, 1, 0], [0, 1, 0.2]])
    laws = () if law is None else (law,)
    data = ph.simulate(ph.Inertia.from_principal_moments(*moments), starts, [0, 0.1], *laws).to_xarray()
    found = {str(name): x.units for name, x in data.data_vars.items() if str(name).endswith("_start")}
    assert found == {f"{name}_start": unit for name, unit in units.items()}


def test_angular_momentum_from_the_labelled_inertia():
    """``L = I Ω`` by the names of the dimensions."""
    data = MOTION.to_xarray()
    found = data.inertia.dot(data.omega_body.rename(axis="inertia_column"), dim="inertia_column")
    np.testing.assert_allclose(found.T, MOTION.momentum_body.components, rtol=1e-14, atol=1e-15)


@pytest.mark.parametrize("given", [{}, {"title": "Curlew", "history": "2026-01-01 by hand"}])
def test_attributes_come_back_without_what_the_file_adds(given, tmp_path):
    MOTION.attributes.clear()
    MOTION.attributes.update(given)
    try:
        MOTION.save(tmp_path / "a.nc")
        assert ph.Trajectory.read(tmp_path / "a.nc").attributes == given
        assert ph.io.read(tmp_path / "a.nc").attributes == given
    finally:
        MOTION.attributes.clear()


def test_the_same_motion_is_the_same_file(tmp_path):
    for name in ("a.nc", "b.nc"):
        MOTION.save(tmp_path / name)
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()


def test_older_files_are_read(tmp_path):
    """They had a dimension axis_ and no attributes of CF."""
    data = MOTION.to_xarray().rename(inertia_column="axis_")
    for name in ("Conventions", "title", "history"):
        del data.attrs[name]
    data.to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    found = ph.Trajectory.read(tmp_path / "a.nc")
    assert found.inertia == MOTION.inertia
    assert np.array_equal(found.rotor.components, MOTION.rotor.components)
    assert found.attributes == {}
