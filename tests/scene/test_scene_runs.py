"""Runs of ensembles: blocks, files, summaries, failures and interrupts."""

import dataclasses
import json
import os
import re
import signal
import time

import numpy as np
import pytest

import polhode as ph
import processes
from command_line import POLHODE, SCENE, polhode, summary_of
from polhode._cli import ensemble as _ensemble_run
from polhode._report.ensemble.collect import LEVELS, EnsembleRecords, first_above, quantiles
from polhode._support import memory

FREE = (
    SCENE
    + """
[ensemble]
number = 700
seed = 5
attitude = { normal = "2 deg" }
spin = { normal = 0.01 }
moments = { relative = 0.01 }
"""
)
LAWS = "[torque]\nviscous_damping = 0.2\nmagnetic = { dipole = [1, 0, 0], field = [0, 1, 2] }\n"
TORQUED = FREE.replace("[run]", LAWS + "[run]") + (
    "torque.viscous_damping = { relative = 0.3 }\ntorque.magnetic.dipole = { normal = 0.1 }\n"
    '[method]\nname = "rk4"\nstep = 0.01\n'
)
# Steps of 0.1 s are too long for k |Ω| h/i > 2.8, so that ω grows without bounds: a k above 62, one in 29.
FAILING = """\
[body]
moments = [2, 2, 2]
[initial]
spin = { vector = [0.9, 0, 0] }
[torque]
quadratic_damping = 10
[ensemble]
number = 600
seed = 1
torque.quadratic_damping = { relative = 1 }
[run]
duration = "2 s"
samples = 5
method = "rk4"
step = "0.1 s"
"""


@pytest.fixture
def write(tmp_path):
    def write(text, name="a.toml"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


def opened(path):
    xarray = pytest.importorskip("xarray")
    with xarray.open_dataset(path, engine="h5netcdf") as data:
        return data.load()


def same(a, b):
    for name in ("rotor", "omega_body", "momentum_space", "position", "velocity"):
        np.testing.assert_array_equal(getattr(a, name).components, getattr(b, name).components)
    np.testing.assert_array_equal(a.energy, b.energy)
    np.testing.assert_array_equal(a.certificate.norm_drift, b.certificate.norm_drift)


# --- from Python


@pytest.mark.parametrize("text", [FREE, TORQUED], ids=["free", "torqued"])
def test_results_do_not_depend_on_blocks_and_threads(text, write):
    scene = ph.Scene.read(write(text))
    whole = scene.run(threads=1)
    assert whole.shape == (700,)
    assert whole.attributes["title"] == "Small"
    for block, threads in ((1, 1), (300, 2), (10**6, 2)):
        ends = []
        # The first and the last block stand for all.
        for rows, motion in scene.run_blocks(block, threads=threads):
            if rows.start in (0, 300) or rows.stop == 700:
                same(motion, whole[rows])
            ends.append(rows.stop)
        assert ends == [min(k, 700) for k in range(block, 700 + block, block)]


def test_bodies_of_an_ensemble_move_as_alone(write):
    scene = ph.Scene.read(write(TORQUED))
    state, inertias, torque = scene.ensemble.draw(37, 1)
    start = ph.State(state.rotor[0], state.omega_body[0])
    alone = ph.simulate(inertias[0], start, scene.times, torque, method="rk4", step=0.01)
    whole = scene.run().rotor.components[37]
    np.testing.assert_allclose(whole, alone.rotor.components, rtol=0, atol=1e-14)


def test_forces_move_bodies_whose_moments_differ(write):
    text = FREE.replace("moments = [1, 2, 3]", "moments = [1, 2, 3]\nmass = 2")
    text = text.replace("[run]", '[force]\nconstant = [0, 0, "-1 N"]\n[run]').replace("700", "20")
    motion = ph.Scene.read(write(text)).run()
    assert len(motion.inertia) == 20
    np.testing.assert_allclose(motion.position.components[:, -1, 2], -0.25, rtol=1e-12)


@pytest.mark.slow
def test_motion_with_an_off_centre_thrust_is_torqued(write, tmp_path):
    text = FREE.replace("moments = [1, 2, 3]", "moments = [1, 2, 3]\nmass = 2").replace("700", "20")
    path = write(text.replace("[run]", "[force]\nthrust = { force = [0, 0, 1], at = [0.1, 0, 0] }\n[run]"))
    motion = summary_of(path, "-o", tmp_path / "out.nc")["motion"]
    assert (motion["kind"], motion["regimes"]) == ("torqued", {})
    data = opened(tmp_path / "out.nc")
    assert data.energy.dims == ("body", "time")
    assert "momentum_space" not in data
    assert data.position.dims == ("body", "time", "axis")
    alone = write(path.read_text().partition("[ensemble]")[0], "one.toml")
    assert summary_of(alone)["motion"]["kind"] == "torqued"


def test_runs_have_the_bits_of_simulate(write):
    """The core's problem of a scene is that of `simulate` with the same body, laws, thrust and tolerances."""
    text = SCENE.replace("moments = [1, 2, 3]", "moments = [1, 2, 3]\nmass = 2\ncenter_of_mass = [0, 0, 0.1]")
    acting = "[torque]\ndamping = 0.1\n[force]\nthrust = { force = [0, 0, 1], at = [0.1, 0, 0] }\n"
    scene = ph.Scene.read(write(text + acting + "[method]\nrtol = 1e-9\natol = 1e-12\n"))
    found = scene.run()
    expected = ph.simulate(
        scene.body, scene.state, scene.times, scene.torque, scene.force, rtol=scene.rtol, atol=scene.atol
    )
    same(found, expected)
    assert found.certificate == expected.certificate


def test_times_alone_can_be_replaced(write):
    scene = ph.Scene.read(write(SCENE))
    assert dataclasses.replace(scene, times=[0.0, 3.0]).run().time.tolist() == [0.0, 3.0]
    with pytest.raises(ValueError, match="method"):
        dataclasses.replace(scene, method="rk4")


def test_only_ensembles_have_blocks(write):
    scene = ph.Scene.read(write(SCENE))
    with pytest.raises(ValueError, match="has no table"):
        next(scene.run_blocks())
    scene = ph.Scene.read(write(FREE))
    with pytest.raises(ValueError, match="block must be at least 1, got 0"):
        next(scene.run_blocks(0))
    assert scene.alone().run().shape == ()


def test_progress_counts_all_bodies(write):
    fractions = []
    for _ in ph.Scene.read(write(TORQUED)).run_blocks(100, lambda _, fraction: fractions.append(fraction), 1):
        pass
    assert fractions == sorted(fractions)
    assert {k / 7 for k in range(1, 8)} <= {*fractions}


# --- the file


@pytest.mark.parametrize("text", [FREE, TORQUED], ids=["free", "torqued"])
def test_the_file_holds_the_results_of_run(text, write, tmp_path):
    path, output = write(text), tmp_path / "out.nc"
    result = summary_of(path, "-o", output, "--threads", "2")
    figures = [tmp_path / f"out-{name}.png" for name in ("ensemble", "directions")]
    assert result["files"] == [str(p) for p in (output, *figures)]
    assert sorted(tmp_path.iterdir()) == sorted([path, output, *figures])
    for figure in figures:
        assert figure.read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
    data, scene = opened(output), ph.Scene.read(path)
    motion = scene.run()
    free = text is FREE
    np.testing.assert_array_equal(data.attitude.values, motion.rotor.to_quaternion(order="wxyz"))
    np.testing.assert_array_equal(data.omega_body.values, motion.omega_body.components)
    np.testing.assert_array_equal(data.time.values, scene.times)
    np.testing.assert_array_equal(data.energy.values, motion.energy[:, 0] if free else motion.energy)
    assert data.energy.dims == (("body",) if free else ("body", "time"))
    if free:
        np.testing.assert_array_equal(data.momentum_space.values, motion.momentum_space.components[:, 0])
    np.testing.assert_array_equal(data.body.values, np.arange(700))
    matrices = [inertia.matrix for inertia in motion.inertia]
    np.testing.assert_array_equal(data.inertia.values, matrices)
    np.testing.assert_array_equal(data.rotor_norm_drift.values, motion.certificate.norm_drift)
    np.testing.assert_array_equal(data.steps.values, motion.certificate.steps)
    assert data.method.attrs["flag_meanings"] == ("exact" if free else "rk4")
    assert not data.method.values.any()
    assert not data.failed.values.any()
    assert np.isnan(data.failure_time.values).all()
    units = {name: data[name].attrs["units"] for name in ("attitude", "omega_body", "time", "inertia")}
    assert units == {"attitude": "1", "omega_body": "rad/s", "time": "s", "inertia": "kg m^2"}
    wanted = {"seed": 5, "number": 700, "bodies_complete": 700, "title": "Small", "scene": text}
    assert {name: data.attrs[name] for name in wanted} == wanted
    assert "spin: normal, 0.01 rad/s" in data.attrs["varied"]
    if not free:
        (_, gains), (_, (dipoles, fields)) = scene.ensemble.laws()
        np.testing.assert_array_equal(data.viscous_damping.values, gains[0])
        np.testing.assert_array_equal(data.magnetic_dipole.values, dipoles)
        np.testing.assert_array_equal(data.magnetic_field.values, fields)


def test_constant_velocity_is_written_once(write, tmp_path):
    moving = 'vector = [0.01, 1, 0.01] }\nvelocity = [0, "1 m/s", 0]'
    path = write(FREE.replace("700", "20").replace("vector = [0.01, 1, 0.01] }", moving))
    summary_of(path, "-o", tmp_path / "out.nc")
    data = opened(tmp_path / "out.nc")
    assert data.velocity.dims == ("body", "axis")
    np.testing.assert_array_equal(data.velocity.values, np.broadcast_to([0.0, 1, 0], (20, 3)))


@pytest.mark.slow
def test_results_do_not_depend_on_threads_which_are_checked(write, tmp_path):
    path = write(TORQUED)
    results = [
        summary_of(path, "-o", tmp_path / f"{n}.nc", "--threads", str(n)) | {"files": None} for n in (1, 2)
    ]
    assert results[0] == results[1]
    first, second = (opened(tmp_path / f"{n}.nc") for n in (1, 2))
    assert first.identical(second)
    for number in ("0", "-1", "two", "1.5"):
        done = polhode("run", path, "--threads", number)
        assert done.returncode == 2
        assert f"number of threads must be an integer of at least 1, got '{number}'" in done.stderr
    assert summary_of(write(SCENE, "one.toml"), "--threads", "2")["run"]["drift_within_bound"]


# --- the summary


def test_the_summary_has_quantiles(write):
    path = write(FREE)
    result = summary_of(path)
    scene = ph.Scene.read(path)
    motion, nominal = scene.run(), scene.alone().run()
    sections = "title scene ensemble body torques forces motion conserved run failures files"
    assert set(result) == set(sections.split())
    assert result["ensemble"]["levels"] == [0.05, 0.25, 0.5, 0.75, 0.95]
    assert (result["ensemble"]["number"], result["ensemble"]["seed"]) == (700, 5)
    described = result["motion"]
    assert described["kind"] == "free"
    assert sum(described["regimes"].values()) == 700
    turns = (motion.rotor * ~nominal.rotor).components
    angles = 2 * np.arccos(np.minimum(np.abs(turns[..., 0]), 1))
    for entry in described["from_nominal"]:
        k = int(np.argmin(np.abs(scene.times - entry["time"])))
        np.testing.assert_allclose(entry["quantiles"], np.quantile(angles[:, k], LEVELS), rtol=1e-5)
    assert [entry["time"] for entry in described["from_nominal"]] == [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]
    rates = motion.omega_body.norm()
    # Kept in single precision.
    np.testing.assert_allclose(described["rate"]["end"], np.quantile(rates[:, -1], LEVELS), rtol=1e-7)
    free = ph.FreeMotion(motion.inertia, motion.rotor[:, 0], motion.omega_body[:, 0]).describe()
    np.testing.assert_allclose(described["period"], np.quantile(free["period"], LEVELS), rtol=1e-12)
    np.testing.assert_allclose(
        described["energy"]["start"], np.quantile(motion.energy[:, 0], LEVELS), rtol=1e-12
    )
    drift = motion.certificate.drift["energy"]
    assert result["conserved"]["energy"] == {
        "bodies": 700, "worst": float(drift.max()), "body": int(drift.argmax())
    }  # fmt: skip
    assert result["run"]["methods"] == {"exact": 700}
    assert result["failures"] == {"count": 0, "first": []}


def test_the_progress_bar_shows_bodies_and_rates(write):
    pytest.importorskip("rich")
    pty = pytest.importorskip("pty")
    master, slave = pty.openpty()
    environment = {**os.environ, "TERM": "xterm", "COLUMNS": "120"}
    path = write(TORQUED)
    command = [POLHODE, "run", path]
    with processes.start(command, stdout=processes.DEVNULL, stderr=slave, env=environment) as process:
        os.close(slave)
        shown = b""
        while part := read_terminal(master):
            shown += part
        process.wait()
    os.close(master)
    assert process.returncode == 0
    assert b"700 of 700 bodies" in shown
    assert re.search(rb"[\d.e+]+ bodies/s, [\d.e+]+ body-steps/s", shown)


def read_terminal(master):
    """The next output; empty when the other end is closed, which Linux reports as an error."""
    try:
        return os.read(master, 4096)
    except OSError:
        return b""


def test_the_summary_as_text(write):
    done = polhode("run", write(TORQUED))
    assert (done.returncode, done.stderr) == (0, "")
    for words in (
        "Ensemble",
        "Body",
        "Torques and forces",
        "Motion",
        "Over the bodies",
        "Conserved",
        "Run",
        "No file was",
    ):
        assert f"\n{words}" in done.stdout
    assert "700, drawn from seed 5" in done.stdout
    assert "torque.viscous_damping" in done.stdout
    assert max(map(len, done.stdout.splitlines())) <= 110


def test_a_horizon_is_where_the_quantile_passes_the_angle(write):
    # About one axis: each body is off by its own rate times the time, and the 95 % quantile passes 10° once.
    text = SCENE.replace("[0.01, 1, 0.01]", "[0, 1, 0]").replace('duration = "1 s"', 'duration = "20 s"')
    text = (
        text.replace("[1, 2, 3]", "[1, 1, 2]")
        + "[ensemble]\nnumber = 2000\nspin = { normal = [0, 0.05, 0] }\n"
    )
    path = write(text)
    state, _, _ = ph.Scene.read(path).ensemble.draw()
    off = np.quantile(np.abs(state.omega_body.components[:, 1] - 1), 0.95)
    for entry in summary_of(path)["motion"]["horizons"]:
        expected = entry["angle"] / off
        assert entry["time"] == (pytest.approx(expected, rel=1e-5) if expected < 20 else None)


def test_failed_bodies_are_reported_and_the_others_continue(write, tmp_path):
    path = write(FAILING)
    done = polhode("run", path, "-o", tmp_path / "out.nc", "--json")
    assert done.returncode == 0, done.stderr
    result = json.loads(done.stdout)
    motion = ph.Scene.read(path).run()
    failed = [failure.index[0] for failure in motion.failures]
    assert 5 < len(failed) < 40
    assert result["failures"]["count"] == len(failed)
    assert result["failures"]["first"] == [
        {"body": failure.index[0], "time": failure.time, "message": failure.message}
        for failure in motion.failures[:5]
    ]
    data = opened(tmp_path / "out.nc")
    np.testing.assert_array_equal(np.flatnonzero(data.failed.values), failed)
    np.testing.assert_array_equal(data.failure_body.values, failed)
    assert data.failure_message.values.tolist() == [failure.message for failure in motion.failures]
    np.testing.assert_array_equal(data.omega_body.values, motion.omega_body.components)
    lost = motion.failures[0]
    page = polhode("run", path).stdout
    assert f"{len(failed)} of 600 bodies failed before the end" in page
    assert f"body {failed[0]}, after {lost.time:.6g} s: {lost.message}" in page
    assert f"and {len(failed) - 5} more" in page


# --- interrupts and limits


def test_ctrl_c_keeps_the_complete_bodies(write, tmp_path):
    text = TORQUED.replace("700", "200_000").replace("samples = 11", "samples = 101")
    path, output = write(text.replace("step = 0.01", "step = 0.0005")), tmp_path / "out.nc"
    with processes.start([POLHODE, "run", path, "-o", output]) as process:
        while not any(part.stat().st_size > 1 << 20 for part in tmp_path.glob(".out.nc.*.part")):
            assert process.poll() is None
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        printed, errors = process.communicate()
    assert process.returncode == 130
    assert printed == ""
    assert sorted(tmp_path.iterdir()) == sorted([path, output])
    data = opened(output)
    complete = data.sizes["body"]
    assert 0 < complete < 200_000
    assert (data.attrs["bodies_complete"], data.attrs["number"]) == (complete, 200_000)
    assert f"{complete} of 200000" in errors
    assert "Traceback" not in errors
    scene = ph.Scene.read(path)
    for body in (0, complete - 1):
        state, inertias, _ = scene.ensemble.draw(body, 1)
        np.testing.assert_allclose(
            data.omega_body.values[body, 0], state.omega_body.components[0], rtol=0, atol=1e-15
        )
        np.testing.assert_array_equal(data.inertia.values[body], inertias[0].matrix)
    assert np.isfinite(data.attitude.values).all()


@pytest.mark.slow
def test_a_run_interrupted_early_leaves_no_file(write, tmp_path):
    # The first block takes minutes.
    text = (
        TORQUED.replace("700", "100_000").replace('"1 s"', '"1000 s"').replace("step = 0.01", "step = 0.0001")
    )
    path = write(text.replace("samples = 11", "samples = 101"))
    with processes.start([POLHODE, "run", path, "-o", tmp_path / "out.nc"]) as process:
        while not any(tmp_path.glob(".out.nc.*.part")):
            assert process.poll() is None
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate()
    assert process.returncode == 130, errors
    assert "interrupted; no file was changed" in errors
    assert list(tmp_path.iterdir()) == [path]


def test_runs_larger_than_memory_are_refused(write):
    path = write(FREE.replace("700", "100_000_000").replace("samples = 11", "samples = 100_000"))
    done = polhode("run", path)
    assert done.returncode == 1
    assert "the 100000000 bodies of this scene at 100000 times take 120 TB; " in done.stderr
    assert "take fewer bodies or fewer times" in done.stderr


def test_runs_larger_than_the_disk_are_refused(write, tmp_path, monkeypatch):
    scene = ph.Scene.read(write(FREE.replace("700", "1_000_000")))
    monkeypatch.setattr(memory, "available", lambda: None)
    monkeypatch.setattr("shutil.disk_usage", lambda _: type("Usage", (), {"free": 10**6}))
    with pytest.raises(OSError, match=r"out\.nc needs .* MB; its disk has 1 MB free"):
        _ensemble_run.require_room(scene, [tmp_path / "out.nc"])


# --- parts


def test_quantiles_ignore_nan():
    values = np.array([[1.0, np.nan], [2.0, np.nan], [np.nan, np.nan], [4.0, np.nan]])
    found = quantiles(values)
    np.testing.assert_array_equal(found[:, 0], np.quantile([1.0, 2, 4], LEVELS))
    assert np.isnan(found[:, 1]).all()


def test_first_above_lies_between_the_samples():
    times = np.array([0.0, 1, 2, 4])
    assert first_above(times, np.array([0.0, 1, 3, 3]), 2.0) == 1.5
    assert first_above(times, np.array([5.0, 1, 3, 3]), 2.0) == 0.0
    assert first_above(times, np.array([0.0, 1, 2, 2]), 2.0) is None


@pytest.mark.slow
def test_densities_have_the_mean_1():
    pytest.importorskip("matplotlib")
    from polhode._figures.ensemble import _density, _unit_vectors

    latitude = np.linspace(-np.pi / 2, np.pi / 2, 362)
    latitude = 0.5 * (latitude[1:] + latitude[:-1])
    grid = np.meshgrid(np.linspace(-np.pi, np.pi, 720, endpoint=False), latitude)
    rng = np.random.default_rng(3)
    bundle = rng.normal(size=(500, 3)) * 0.1 + [0, 0, 1]
    bundle /= np.linalg.norm(bundle, axis=1, keepdims=True)
    density = _density(bundle, _unit_vectors(*grid))
    mean = np.average(density.mean(axis=1), weights=np.cos(latitude))
    # The midpoint rule on the meridians, h = 0.5°, is off by h²/24σ² for a kernel at the pole, σ = 4°.
    assert mean == pytest.approx(1, rel=(0.5 / 4) ** 2 / 24)
    assert density[-1].mean() > 10
    assert density[0].mean() < 1e-6


def test_the_axis_of_figures(write):
    text = SCENE.replace("moments = [1, 2, 3]", "moments = [1, 2, 3]\nmass = 2\ncenter_of_mass = [0, 0, 0.5]")
    ensemble = "[ensemble]\nnumber = 5\nspin = { normal = 0.1 }\n"
    scene = ph.Scene.read(write(text.replace("[run]", "[gravity]\nacceleration = 9.81\n[run]") + ensemble))
    records = EnsembleRecords(scene, scene.alone().run())
    np.testing.assert_array_equal(records.axis, [0, 0, 1])
    assert records.tilt_name == "the vertical"
    scene = ph.Scene.read(write(SCENE + ensemble))
    records = EnsembleRecords(scene, scene.alone().run())
    np.testing.assert_allclose(records.axis, [0, 1, 0], atol=1e-15)
    assert (records.axis_name, records.tilt_name) == ("principal axis 2", "L")
