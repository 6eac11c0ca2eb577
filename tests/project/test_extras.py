"""Functions that need an optional library name the extra that installs it."""

import sys
from pathlib import Path

import numpy as np
import pytest

import polhode as ph
from polhode._cli import main

EXAMPLE = Path(__file__).parents[2] / "examples/toutatis.toml"
CK = {"epoch": "2026-01-01T00:00:00", "body_frame": "A", "reference_frame": "J2000"}


@pytest.fixture
def trajectory():
    state = ph.State(ph.Rotor.identity(), [0.1, 1, 0.2])
    return ph.simulate(ph.Inertia.from_principal_moments(1, 2, 3), state, np.linspace(0, 1, 5))


@pytest.mark.parametrize(
    ("module", "extra", "use"),
    [
        ("xarray", "io", lambda t, path: t.to_xarray()),
        ("h5netcdf", "io", lambda t, path: t.save(path / "a.nc")),
        ("pyarrow.parquet", "parquet", lambda t, path: t.save(path / "a.parquet")),
        ("pandas", "parquet", lambda t, path: t.save(path / "a.parquet")),
        ("pandas", "pandas", lambda t, path: t.to_dataframe()),
        ("spiceypy", "spice", lambda t, path: ph.io.write_ck(t, path / "a.bc", kernels=[], **CK)),
        ("matplotlib.figure", "plot", lambda t, path: t.plot()),
        ("scipy.spatial.transform", "scipy", lambda t, path: t.rotor.to_scipy()),
        ("scipy.optimize", "scipy", lambda t, path: ph.fit(rates=(t.time, t.omega_body))),
    ],
)
def test_the_extra_is_named(module, extra, use, trajectory, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, module, None)
    library = module.partition(".")[0]
    with pytest.raises(ImportError, match=rf"needs {library}: pip install 'polhode\[{extra}\]'"):
        use(trajectory, tmp_path)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("module", ["xarray", "zarr"])
def test_the_extra_of_stores_is_named(module, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, module, None)
    scene = ph.Scene.read(EXAMPLE.with_name("toutatis-uncertain.toml"))
    with pytest.raises(ImportError, match=rf"a Zarr store needs {module}: pip install 'polhode\[zarr\]'"):
        scene.run(store=tmp_path / "a.zarr")
    assert not list(tmp_path.iterdir())


def test_the_extra_of_clusters_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    scene = ph.Scene.read(EXAMPLE.with_name("toutatis-uncertain.toml"))
    expected = r"a run on a cluster needs distributed: pip install 'polhode\[cluster\]'"
    with pytest.raises(ImportError, match=expected):
        scene.run(store=tmp_path / "a.zarr", cluster="local")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("module", ["xarray", "h5netcdf", "matplotlib"])
def test_the_command_names_the_extra_before_the_run(module, tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, module, None)
    assert main.main(["run", str(EXAMPLE), "-o", str(tmp_path / "a.nc")]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "pip install 'polhode[" in captured.err
    assert not list(tmp_path.iterdir())


def test_completion_names_the_extra(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "shtab", None)
    assert main.main(["--print-completion", "bash"]) == 1
    expected = "polhode: error: completion in a shell needs shtab: pip install 'polhode[completion]'\n"
    assert capsys.readouterr() == ("", expected)
