"""Reduced outputs of ensembles: `keep` in `[ensemble]`, and `Scene.reduce`."""

import json
from dataclasses import replace

import numpy as np
import pytest

import polhode as ph
from command_line import SCENE, polhode
from polhode import _native
from polhode._report.ensemble.collect import watched_axis
from stores import content, status

WORDS = ("last", "extrema", "regime", "periods", "quantiles", "events")
BODIES = """
[ensemble]
number = 1500
seed = 5
attitude = "uniform"
spin = { direction = "uniform", relative = 0.3 }
moments = { relative = 0.05 }
velocity = { normal = [1, "2 m/s", 0] }
"""
FREE = SCENE.replace('duration = "1 s"\nsamples = 11', 'duration = "20 s"\nsamples = 41') + BODIES
TORQUED = FREE.replace("[run]", "[torque]\nmagnetic = { dipole = [1, 0, 0], field = [0, 1, 2] }\n[run]")
# Levels of quantiles, and the relative width of their bins.
LEVELS, WIDTH = (0.05, 0.25, 0.5, 0.75, 0.95), 1 / 1024


def read(folder, text, keep=None):
    """The scene of a text, which keeps these words."""
    path = folder / "a.toml"
    path.write_text(text if keep is None else f"{text}keep = {json.dumps(keep)}\n")
    return ph.Scene.read(path)


@pytest.fixture(scope="module")
def free(tmp_path_factory):
    """A scene of free bodies, their motions and all reduced outputs."""
    scene = read(tmp_path_factory.mktemp("free"), FREE)
    return scene, scene.run(), scene.reduce(WORDS)


@pytest.fixture(scope="module")
def torqued(tmp_path_factory):
    scene = read(tmp_path_factory.mktemp("torqued"), TORQUED)
    return scene, scene.run(), scene.reduce([word for word in WORDS if word not in ("regime", "periods")])


def angles(a, b):
    """Angles between vectors (..., 3)."""
    return np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1))


def series(scene, motions):
    """From the definitions in the guide: angle from the nominal attitude, tilt and rate, (bodies, times)."""
    nominal = scene.alone().run()
    turns = (motions.rotor * ~nominal.rotor).to_quaternion(order="wxyz")
    axis = motions.rotor(ph.vector(watched_axis(scene, nominal)[0])).components
    return {
        "from_nominal": 2 * np.arccos(np.clip(np.abs(turns[..., 0]), 0, 1)),
        "tilt": angles(axis, motions.momentum_space.components),
        "rate": np.linalg.norm(motions.omega_body.components, axis=-1),
        "energy": motions.energy,
    }


@pytest.mark.parametrize("kind", ["free", "torqued"])
def test_last_states_are_those_of_the_motions(kind, request):
    _, motions, reduced = request.getfixturevalue(kind)
    expected = motions.rotor.to_quaternion(order="wxyz")[:, -1]
    np.testing.assert_array_equal(reduced["last_attitude"], expected)
    np.testing.assert_array_equal(reduced["last_omega_body"], motions.omega_body.components[:, -1])
    np.testing.assert_array_equal(reduced["last_position"], motions.position.components[:, -1])
    np.testing.assert_array_equal(reduced["last_velocity"], motions.velocity.components[:, -1])


@pytest.mark.parametrize("kind", ["free", "torqued"])
def test_extrema_are_those_of_the_samples(kind, request):
    scene, motions, reduced = request.getfixturevalue(kind)
    expected = series(scene, motions)
    assert ("energy_min" in reduced) == (kind == "torqued")
    for name, values in expected.items():
        if f"{name}_min" in reduced:
            # Single precision; the arc cosine of the test loses half of the digits near 0.
            look = {"rtol": 2e-7, "atol": 1e-7}
            np.testing.assert_allclose(reduced[f"{name}_min"], values.min(axis=1), **look)
            np.testing.assert_allclose(reduced[f"{name}_max"], values.max(axis=1), **look)


def test_regimes_and_periods_are_those_of_free_motions(free):
    scene, _, reduced = free
    state, inertias, _ = scene.ensemble.draw()
    described = ph.FreeMotion(np.array(inertias, object), state.rotor, state.omega_body).describe()
    for name in ("period", "precession_period"):
        np.testing.assert_array_equal(reduced[name], np.abs(described[name]))
    names = np.array(_native.regimes())
    assert (names[reduced["regime"]] == described["regime"]).all()
    assert len(set(reduced["regime"].tolist())) == 2


@pytest.mark.parametrize("kind", ["free", "torqued"])
def test_quantiles_are_those_of_the_bodies_to_the_width_of_a_bin(kind, request):
    scene, motions, reduced = request.getfixturevalue(kind)
    expected = series(scene, motions)
    assert reduced["level"].tolist() == list(LEVELS)
    for name in ("from_nominal", "tilt", "rate"):
        low, high = (np.quantile(expected[name], LEVELS, axis=0, method=m) for m in ("lower", "higher"))
        found = reduced[f"{name}_quantiles"]
        assert (found >= low * (1 - WIDTH) - 1e-7).all()
        assert (found <= high * (1 + WIDTH) + 1e-7).all()


def test_events_are_found_between_samples(free):
    scene, motions, reduced = free
    values = series(scene, motions)
    cosines = np.cos(values["tilt"])
    turned = np.signbit(cosines[:, 1:]) != np.signbit(cosines[:, :-1])
    np.testing.assert_array_equal(reduced["flips"], turned.sum(axis=1))
    assert 0 < np.count_nonzero(reduced["flips"]) < len(motions)
    for body in np.flatnonzero(reduced["flips"])[:50]:
        places = np.flatnonzero(turned[body])
        for name, k in (("first_flip", places[0]), ("last_flip", places[-1])):
            assert scene.times[k] <= reduced[name][body] <= scene.times[k + 1]
    assert np.isnan(reduced["first_flip"][reduced["flips"] == 0]).all()
    for name, bound in (("beyond_10_degrees", np.radians(10)), ("beyond_90_degrees", np.radians(90))):
        above = values["from_nominal"] > bound
        found = reduced[name]
        np.testing.assert_array_equal(np.isnan(found), ~above.any(axis=1))
        first = above.argmax(axis=1)
        known = above.any(axis=1)
        assert (found[known] <= scene.times[first[known]]).all()
        assert (found[known] >= scene.times[np.maximum(first[known] - 1, 0)]).all()


def test_bits_do_not_depend_on_blocks_and_threads(free, monkeypatch):
    from polhode._scene import scene as module

    scene, _, reduced = free
    for block, at_once, threads in ((512, 1 << 18, 1), (700, 1 << 30, 3)):
        monkeypatch.setattr(module, "_BLOCK", at_once)
        monkeypatch.setattr(module, "_REDUCED", block)
        again = scene.reduce(WORDS, threads=threads)
        assert set(again) == set(reduced)
        for name, values in reduced.items():
            assert values.tobytes() == again[name].tobytes(), name


def test_failed_bodies_have_no_last_state(tmp_path):
    # Too few steps for fast bodies.
    scene = read(tmp_path, TORQUED + "[method]\nmax_steps = 300\n")
    reduced, motions = scene.reduce(["last"]), scene.run()
    failed = np.array([failure.index[0] for failure in motions.failures])
    assert 0 < len(failed) < len(motions)
    assert [(x.index, x.time, x.message) for x in reduced.failures] == [
        (x.index, x.time, x.message) for x in motions.failures
    ]
    np.testing.assert_array_equal(np.flatnonzero(reduced["failed"]), failed)
    for name in ("last_attitude", "last_omega_body"):
        np.testing.assert_array_equal(np.flatnonzero(np.isnan(reduced[name]).all(axis=1)), failed)


def test_wrong_words_are_reported(tmp_path):
    scene = read(tmp_path, TORQUED)
    with pytest.raises(ValueError, match="unknown output 'first' in keep, expected last, extrema"):
        scene.reduce(["first"])
    with pytest.raises(ValueError, match="'periods' in keep needs a body without torques"):
        scene.reduce(["periods"])
    with pytest.raises(ValueError, match="give keep, some of last"):
        scene.reduce()
    with pytest.raises(ValueError, match="keep must be a sequence"):
        scene.reduce("last")
    with pytest.raises(ValueError, match="no table"):
        scene.alone().reduce(["last"])
    with pytest.raises(ph.SceneError, match=r"`regime` needs a body without torques"):
        read(tmp_path, TORQUED, ["regime"])
    kept = read(tmp_path, FREE, ["last"])
    with pytest.raises(ValueError, match=r"keeps last of its motions: use reduce\(\)"):
        kept.run()
    # Its motions can still be had, block by block.
    rows, motions = next(kept.run_blocks(10))
    assert rows == slice(0, 10)
    np.testing.assert_array_equal(
        kept.reduce()["last_omega_body"][rows], motions.omega_body.components[:, -1]
    )


@pytest.mark.parametrize("kind", ["free", "torqued"])
def test_the_tilt_is_described_as_in_the_summary(kind, request):
    pytest.importorskip("xarray")
    scene, _, reduced = request.getfixturevalue(kind)
    motion = json.loads(polhode("run", scene.path, "--json").stdout)["motion"]
    tilt = f"tilt of {motion['axis']} from {motion['tilt_from']}"
    data = reduced.to_xarray()
    for name in ("tilt_min", "tilt_max", "tilt_quantiles", "flips"):
        assert tilt in data[name].attrs["long_name"]


def test_a_dataset_has_units(free):
    pytest.importorskip("xarray")
    data = free[2].to_xarray()
    assert data.last_attitude.dims == ("body", "quaternion")
    assert data.rate_quantiles.dims == ("level", "time")
    assert data.level.values.tolist() == list(LEVELS)
    assert callable(data.quantile)  # not shadowed
    assert data.rate_max.attrs["units"] == "rad/s"
    assert data.rate_quantiles.attrs["relative_resolution"] == WIDTH
    assert data.attrs["keep"] == " ".join(WORDS)


# --- files


@pytest.mark.parametrize("text", [FREE, TORQUED], ids=["free", "torqued"])
def test_files_and_stores_have_the_reduced_outputs(text, tmp_path):
    xr = pytest.importorskip("xarray")
    pytest.importorskip("zarr")
    keep = [word for word in WORDS if text is FREE or word not in ("regime", "periods")]
    scene = read(tmp_path, text, keep)
    expected = scene.reduce()
    done = polhode("run", scene.path, "--no-figures", "--json", "-o", tmp_path / "a.nc")
    assert done.returncode == 0, done.stderr
    result = json.loads(done.stdout)
    assert result["ensemble"]["keep"] == keep
    with (
        scene.run(store=tmp_path / "a.zarr") as store,
        xr.open_dataset(tmp_path / "a.nc") as file,
    ):
        assert set(store.variables) == set(file.variables)
        for name, values in expected.items():
            for found in (store[name], file[name]):
                np.testing.assert_array_equal(found.values, values, err_msg=name)
                assert found.attrs.get("long_name") == file[name].attrs.get("long_name")
        assert store.attrs["keep"] == file.attrs["keep"] == " ".join(keep)
        assert "attitude" not in file
        last = [entry["quantiles"] for entry in result["motion"]["from_nominal"]][-1]
        np.testing.assert_array_equal(last, file.from_nominal_quantiles[:, -1])


def test_points_and_given_numbers_are_written_as_in_whole_files(tmp_path):
    xr = pytest.importorskip("xarray")
    pytest.importorskip("zarr")
    torque = '[torque]\nviscous_damping = "1e-5 N m s/rad"\n[run]'
    grid = """
[ensemble]
number = 8
moments = { relative = 0.05 }
grid.torque.viscous_damping = ["1e-5 N m s/rad", 2e-5]
grid.body.mass = [2, 3]
"""
    text = SCENE.replace("[run]", torque) + grid
    scene, whole = read(tmp_path, text, ["last"]), read(tmp_path, text).run(store=tmp_path / "b.zarr")
    assert polhode("run", read(tmp_path, text, ["last"]).path, "-o", tmp_path / "a.nc").returncode == 0
    with (
        whole,
        scene.run(store=tmp_path / "a.zarr") as store,
        xr.open_dataset(tmp_path / "a.nc") as file,
    ):
        found = scene.reduce()
        for data in (store, file, found.to_xarray()):
            assert data.point.values.tolist() == [0, 1, 2, 3] * 2
            for name in ("point", "torque_viscous_damping", "body_mass"):
                assert data[name].attrs == whole[name].attrs
                np.testing.assert_array_equal(data[name], whole[name])
            # Drawn.
            assert "inertia" in whole
            assert "inertia" not in data


def test_a_resumed_store_in_ranges_is_the_serial_one(tmp_path):
    pytest.importorskip("zarr")
    scene = read(tmp_path, FREE, WORDS)
    scene.run(store=tmp_path / "a.zarr", threads=1).close()
    store = tmp_path / "b.zarr"
    scene.run(store=store, bodies=(600, 1500)).close()
    assert status(store)["bodies_complete"] < 1500
    scene.run(store=store, resume=True).close()
    serial = content(tmp_path / "a.zarr")
    assert content(store) == serial
    # Counts are checked as all other files of a block.
    (store / ".polhode/counts/1").write_bytes(b"")
    assert status(store)["corrupt"] == 1
    scene.run(store=store, resume=True).close()
    assert content(store) == serial
    other = replace(scene, ensemble=replace(scene.ensemble, keep=("last",)))
    with pytest.raises(ValueError, match="another list of what to keep"):
        other.run(store=store, resume=True)


def test_the_summary_is_that_of_the_motions_to_the_width_of_a_bin(tmp_path):
    results = []
    for keep in (None, ["last"]):
        scene = read(tmp_path, FREE, keep)
        done = polhode("run", scene.path, "--json")
        assert done.returncode == 0, done.stderr
        results.append(json.loads(done.stdout))
    whole, reduced = results
    assert reduced["motion"]["regimes"] == whole["motion"]["regimes"]
    assert reduced["conserved"] == whole["conserved"]
    for name in ("methods", "steps", "error_estimate", "rotor_norm_drift", "drift_within_bound"):
        assert reduced["run"][name] == whole["run"][name]

    def numbers(result):
        motion = result["motion"]
        found = [motion[name] for name in ("period", "precession_period")]
        found += [motion[name][end] for name in ("tilt", "rate", "energy") for end in ("start", "end")]
        return np.array(found)

    # Neighbours at a quantile of 1500 bodies are closer together than a bin in most cases.
    np.testing.assert_allclose(numbers(reduced), numbers(whole), rtol=3 * WIDTH)
    printed = polhode("run", tmp_path / "a.toml").stdout
    assert "kept                  last\n" in printed
    assert "quantiles below have a relative error of up to 0.001" in printed


def test_the_figure_of_the_spread_is_drawn(tmp_path):
    pytest.importorskip("matplotlib")
    pytest.importorskip("h5netcdf")
    scene = read(tmp_path, FREE, ["extrema"])
    done = polhode("run", scene.path, "-o", tmp_path / "a.nc", "--quiet")
    assert done.returncode == 0, done.stderr
    assert {path.name for path in tmp_path.iterdir()} == {"a.toml", "a.nc", "a-ensemble.png"}


def test_check_reports_the_size_of_reduced_outputs(tmp_path):
    scene = read(tmp_path, FREE, ["regime"])
    found = json.loads(polhode("check", scene.path, "--json").stdout)[0]
    # Number, method, failure and regime of each body, and a few variables over time.
    assert 1500 * 11 <= found["bytes"] < 1500 * 20
