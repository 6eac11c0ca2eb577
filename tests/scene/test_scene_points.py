"""Grids, lists and tables of bodies in scenes, and correlated variations."""

import itertools
import json
import sys

import numpy as np
import pytest

import polhode as ph
from command_line import polhode
from polhode._viewer.document import of_scene, scene_of

BASE = """
[define]
k = 0.1
[body]
moments = [3, 2, 1]
mass = 2
[initial]
spin = { vector = [0, 0.2, 1] }
[torque]
viscous_damping = 0.1
torque_body = "-k e12"
[force]
drag = 0.5
[run]
duration = 2
samples = 5
"""
GRID = """
[ensemble]
grid.torque.viscous_damping = ["0.1 N m s/rad", 0.2]
grid.initial.spin.vector = [[0, 0.2, 1], ["1 deg/s", 0, 1], [1, 2, 3]]
"""


@pytest.fixture
def read(tmp_path):
    def write(text):
        (tmp_path / "a.toml").write_text(text)
        return ph.Scene.read(tmp_path / "a.toml")

    return write


def test_the_bodies_of_a_grid_move_as_in_scenes_of_their_own(read):
    motion = read(BASE + GRID).run()
    given = read(BASE + GRID).ensemble.given()
    rows = itertools.product((0.1, 0.2), ([0, 0.2, 1], [np.pi / 180, 0, 1], [1, 2, 3]))
    for body, (damping, spin) in enumerate(rows):
        assert given["torque.viscous_damping"][body] == damping
        np.testing.assert_array_equal(given["initial.spin.vector"][body], spin)
        text = BASE.replace("viscous_damping = 0.1", f"viscous_damping = {damping!r}")
        text = text.replace("[0, 0.2, 1]", str([float(x) for x in spin]))
        # In an ensemble of one, since adaptive steps of one body alone are chosen by other rules.
        own = read(text + "[ensemble]\nnumber = 1\nspin = { uniform = 0 }\n").run()
        np.testing.assert_array_equal(motion[body].rotor._data, own[0].rotor._data)
        np.testing.assert_array_equal(motion[body].omega_body._data, own[0].omega_body._data)


def test_masses_forces_and_defined_values_vary(read):
    lists = "[ensemble]\nlist = { body.mass = [1, 2], force.drag = [0.25, 1], define.k = [0, 0.3] }\n"
    text = BASE.replace("[torque]", "velocity = [1, 0, 0]\n[torque]")
    motion = read(text + lists).run()
    # x' = v exp(−k t/m): to the tolerance of adaptive steps, 1e-10, with a margin.
    for body, rate in enumerate((0.25, 0.5)):
        expected = np.exp(-rate * motion.time)
        np.testing.assert_allclose(motion[body].velocity._data[:, 0], expected, rtol=1e-8)
    for body, (mass, drag, k) in enumerate(((1, 0.25, 0), (2, 1, 0.3))):
        own = text.replace("mass = 2", f"mass = {mass}").replace("drag = 0.5", f"drag = {drag}")
        own = own.replace("k = 0.1", f"k = {k}") + "[ensemble]\nnumber = 1\nspin = { uniform = 0 }\n"
        np.testing.assert_array_equal(motion[body].omega_body._data, read(own).run()[0].omega_body._data)


def test_an_ensemble_lists_what_its_points_vary(read):
    spec = read(BASE + GRID + "number = 12\ntorque.viscous_damping = { relative = 0.1 }\n").ensemble
    assert (spec.number, spec.points) == (12, 6)
    assert dict(spec.varied) == {
        "torque.viscous_damping": "grid, 2 values; relative, 0.1",
        "initial.spin.vector": "grid, 3 values",
    }
    np.testing.assert_array_equal(spec.given(5, 2)["initial.spin.vector"], [[1, 2, 3], [0, 0.2, 1]])
    state, _, _ = spec.draw()
    np.testing.assert_array_equal(state.omega_body._data[:6], state.omega_body._data[6:])
    name, (damping, *_) = next(law for law in spec.laws() if isinstance(law, tuple))
    assert name == "viscous_damping"
    assert len({*damping[:, 0]}) == 12
    texts = read(BASE + "[ensemble]\ngrid.initial.spin = ['e12', 'k e12']\n").ensemble.given()
    assert texts == {"initial.spin": ["e12", "k e12"]}
    with pytest.raises(ValueError, match=r"range 3\.\.13 is out of bounds for 12 bodies"):
        spec.given(3, 10)


def test_blocks_and_threads_have_the_same_bits(read):
    scene = read(BASE + GRID + "number = 12\nspin = { normal = 0.1 }\n")
    whole = scene.run(threads=1)
    for rows, block in scene.run_blocks(5, threads=2):
        np.testing.assert_array_equal(block.rotor._data, whole.rotor._data[rows])


HEADER = "initial.spin.vector[1],torque.viscous_damping,initial.attitude\n"


def test_csv_and_parquet_tables_agree(read, tmp_path):
    pytest.importorskip("pyarrow.parquet")
    import pyarrow as pa
    import pyarrow.parquet as pq

    spins = np.random.default_rng(3).normal(size=5)
    texts = ["0.1 N m s/rad", "1", "2", "3e-1", "0.2"]
    attitudes = ["exp(-0.1 e12)", "exp(0 e12)", "1 + 0 e12", "exp(k e12)", "exp(0.2 e23)"]
    rows = [f'{float(spin)!r},{text},"{at}"' for spin, text, at in zip(spins, texts, attitudes, strict=True)]
    (tmp_path / "b.csv").write_text(HEADER + "\n".join(rows))
    columns = dict(zip(HEADER.strip().split(","), (spins, texts, attitudes), strict=True))
    pq.write_table(pa.table(columns), tmp_path / "b.parquet")
    csv, parquet = (read(BASE + f"[ensemble]\ntable = '{name}'\n") for name in ("b.csv", "b.parquet"))
    np.testing.assert_array_equal(csv.ensemble.given()["initial.spin.vector[1]"], spins)
    np.testing.assert_array_equal(csv.run().rotor._data, parquet.run().rotor._data)
    assert csv.ensemble.table_sha256 != parquet.ensemble.table_sha256


def test_errors_of_tables_name_the_file_and_the_row(read, tmp_path, monkeypatch):
    for name, content, message in (
        (
            "b.csv",
            b"torque.viscous_damping\n1\n1 m\n",
            r"b\.csv, line 3, column `torque.viscous_damping`: expected",
        ),
        ("b.csv", b'body.moments\n"[9, 1, 1]"\n', r"b\.csv, line 2: .*moments"),
        ("b.csv", b"torque.damping\n1\n", r"the scene has no `torque\.damping`"),
        ("b.csv", b"force.drag\n1\n\n2\n", r"b\.csv, line 3, column `force\.drag`: the cell is empty"),
        ("b.csv", b",force.drag\n0,1\n", r"b\.csv, line 1: column 1 has no name; .*`index=False`"),
        ("b.csv", b"drag\n1\n", r"`drag` is not the path of a scene value; did you mean `force\.drag`\?"),
        ("b.csv", b"force.drag\ninf\n", r"b\.csv, line 2, column `force\.drag`: `inf` is not a finite"),
        ("b.csv", b"\xff\n1\n", r"b\.csv: not UTF-8"),
        ("b.parquet", b"no", r"b\.parquet: not a table of numbers and strings"),
        ("b.txt", b"", r"b\.txt: expected a table in a file \.csv or \.parquet"),
    ):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(ph.SceneError, match=message):
            read(BASE + f"[ensemble]\ntable = '{name}'\n")
    with pytest.raises(ph.SceneError, match=r"none\.csv: no such file"):
        read(BASE + "[ensemble]\ntable = 'none.csv'\n")
    for module in ("pyarrow", "pyarrow.parquet", "pyarrow.csv"):
        monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(ph.SceneError, match=r"pip install 'polhode\[parquet\]'"):
        read(BASE + "[ensemble]\ntable = 'b.parquet'\n")


def test_empty_cells_of_parquet_are_errors(read, tmp_path):
    pa, pq = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    empty = r"b\.parquet, row 1 \(from 0\), column `force\.drag`: the cell is empty"
    for column, message in (
        ([1.0, None], empty),  # the last row alone would be a blank line at the end
        ([1.0, None, 2.0], empty),
        (["1", None], empty),
        (["1", ""], empty),
        (["1", "None"], r"b\.parquet, row 1 \(from 0\), column `force\.drag`: "),
        ([1.0, float("nan")], r"row 1 \(from 0\), column `force\.drag`: `nan` is not a finite number"),
        ([1.0, float("-inf")], r"row 1 \(from 0\), column `force\.drag`: `-inf` is not a finite number"),
    ):
        pq.write_table(pa.table({"force.drag": column}), tmp_path / "b.parquet")
        with pytest.raises(ph.SceneError, match=message):
            read(BASE + "[ensemble]\ntable = 'b.parquet'\n")
    for name in ("__index_level_0__", "index"):
        pq.write_table(pa.table({"force.drag": [1.0], name: [3]}), tmp_path / "b.parquet")
        with pytest.raises(ph.SceneError, match=rf"b\.parquet: `{name}` is not .*`index=False`"):
            read(BASE + "[ensemble]\ntable = 'b.parquet'\n")


def test_a_drawn_body_moves_as_in_the_ensemble(read):
    text = BASE.replace("drag = 0.5", "") + "[ensemble]\nnumber = 10\nspin = { normal = 0.1 }\n"
    scenes = (
        "moments = { relative = 0.1 }\ntorque.viscous_damping = { relative = 0.3 }\n",
        "list.define.k = [0.1, 0.2, 0.3, 0.4, 0.5]\n",
        "list.define.k = ['0.1 e1', '0.2 e1', '0.3 e2', '0.4 e3', 'e1']\n",
    )
    for varied in scenes:
        own = text
        if "e1" in varied:
            own = text.replace("k = 0.1", "k = 'e1'").replace("-k e12", "-0.1 k e123")
        scene = read(own + varied)
        whole = scene.run()
        for rows in (slice(7, 8), slice(2, 9)):
            state, inertias, torque = scene.ensemble.draw(rows.start, rows.stop - rows.start)
            motion = ph.simulate(inertias, state, scene.times, torque)
            # Both runs meet the default tolerance, 1e-10, of the values.
            for name in ("rotor", "omega_body"):
                found, expected = (getattr(one, name)._data for one in (motion, whole[rows]))
                np.testing.assert_allclose(found, expected, rtol=0, atol=4e-10)


def test_a_document_of_the_viewer_has_the_table(read, tmp_path):
    (tmp_path / "b.csv").write_text("force.drag\n1\n2\n")
    scene = read(BASE + "[ensemble]\ntable = 'b.csv'\n")
    shown = scene_of(of_scene(scene))
    np.testing.assert_array_equal(shown.ensemble.given()["force.drag"], [1, 2])
    assert shown.ensemble.table_sha256 == scene.ensemble.table_sha256


def test_the_command_reports_points(tmp_path):
    (tmp_path / "a.toml").write_text(BASE + GRID)
    done = polhode("run", tmp_path / "a.toml", "--json")
    assert done.returncode == 0, done.stderr
    ensemble = json.loads(done.stdout)["ensemble"]
    assert (ensemble["number"], ensemble["points"]) == (6, 6)
    assert ensemble["varied"]["initial.spin.vector"] == "grid, 3 values"
    (tmp_path / "a.toml").write_text(BASE + GRID.replace("0.2]", "-0.2]"))
    done = polhode("check", tmp_path / "a.toml")
    assert done.returncode != 0
    assert "must not be negative" in done.stderr + done.stdout


@pytest.mark.parametrize(("variation", "drawn"), [("", False), ("spin = { normal = 0.1 }\n", True)])
def test_the_summary_names_the_seed_of_random_variations(tmp_path, variation, drawn):
    (tmp_path / "a.toml").write_text(BASE + GRID + variation)
    done = polhode("run", tmp_path / "a.toml")
    assert "6 at 6 points" in done.stdout
    assert ("drawn from seed" in done.stdout) is drawn


def test_files_have_the_given_values(read, tmp_path):
    pytest.importorskip("h5netcdf")
    xr = pytest.importorskip("xarray")
    pytest.importorskip("zarr")
    moments = "grid.body.moments = [[3, 2, 1], [4, 3, 2]]\n"
    scene = read(BASE + GRID + moments)
    done = polhode("run", tmp_path / "a.toml", "--no-figures", "-o", tmp_path / "a.nc")
    assert done.returncode == 0, done.stderr
    scene.run(store=tmp_path / "a.zarr").close()
    given = scene.ensemble.given()
    with (
        xr.open_dataset(tmp_path / "a.nc") as file,
        xr.open_zarr(tmp_path / "a.zarr", chunks=None) as store,
    ):
        for data in (file, store):
            np.testing.assert_array_equal(data.point, np.arange(12))
            np.testing.assert_array_equal(data.torque_viscous_damping, given["torque.viscous_damping"])
            np.testing.assert_array_equal(data.initial_spin_vector, given["initial.spin.vector"])
            assert data.initial_spin_vector.dims == ("body", "axis")
            assert data.initial_spin_vector.attrs["units"] == "rad/s"
            np.testing.assert_array_equal(data.body_moments, given["body.moments"])
            diagonal = np.diagonal(data.inertia, axis1=1, axis2=2)
            # Moments are found from the matrix again, to its rounding.
            np.testing.assert_allclose(np.sort(diagonal), np.sort(given["body.moments"]), rtol=1e-15)


def test_a_store_refuses_another_table(read, tmp_path):
    pytest.importorskip("zarr")
    pytest.importorskip("xarray")
    (tmp_path / "b.csv").write_text("force.drag\n1\n2\n")
    text = BASE + "[ensemble]\ntable = 'b.csv'\n"
    read(text).run(store=tmp_path / "a.zarr").close()
    read(text).run(store=tmp_path / "a.zarr", resume=True).close()
    (tmp_path / "b.csv").write_text("force.drag\n1\n3\n")
    with pytest.raises(ValueError, match="was begun with another table of bodies"):
        read(text).run(store=tmp_path / "a.zarr", resume=True)


def test_correlated_variations_have_their_covariance(read):
    matrix = np.array([[4e-4, 1e-4, 0, 2e-4], [1e-4, 1e-4, 0, 0], [0, 0, 0, 0], [2e-4, 0, 0, 4e-4]])
    joint = f"covariance = {{ of = ['spin', 'torque.viscous_damping'], matrix = {matrix.tolist()} }}\n"
    text = BASE.replace("viscous_damping = 0.1", "viscous_damping = 10")
    spec = read(text + "[ensemble]\nnumber = 20000\nseed = 2\n" + joint).ensemble
    assert spec.varied["spin"] == "correlated normal, (0.02, 0.01, 0) rad/s"
    state, _, _ = spec.draw()
    _, (damping, *_) = next(law for law in spec.laws() if isinstance(law, tuple))
    found = np.cov(np.column_stack([state.omega_body._data, damping[:, 0]]), rowvar=False)
    # Five standard errors of a sample covariance: √((C_ii C_jj + C_ij²)/n).
    variance = np.diag(matrix)
    bound = 5 * np.sqrt((np.outer(variance, variance) + matrix**2) / 20000)
    assert (np.abs(found - matrix) <= bound).all()
    with pytest.raises(ph.SceneError, match="not positive semidefinite"):
        read(BASE + "[ensemble]\nnumber = 2\n" + joint.replace("0.0002", "0.002"))
