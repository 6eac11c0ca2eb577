"""The command: examples, files, help, and output."""

import json
import os

import numpy as np
import pytest

import polhode as ph
import processes
from command_line import EXAMPLES, POLHODE, SCENE, polhode, summary_of

# --- the examples


def half_period(i, omega):
    """2K/λ of a free top about its middle axis, short-axis mode, with K by the arithmetic-geometric mean."""
    (a, b, c), (wa, wb, wc) = i, omega
    p = a * (c - a) * wa**2 + b * (c - b) * wb**2
    q = b * (b - a) * wb**2 + c * (c - a) * wc**2
    complement = (c - a) * (c * (c - b) * wc**2 - a * (b - a) * wa**2) / ((c - b) * q)
    assert p > 0
    assert 0 < complement < 1
    x, y = 1.0, np.sqrt(complement)
    while abs(x - y) > 1e-15:
        x, y = (x + y) / 2, np.sqrt(x * y)
    return np.pi / x / np.sqrt((c - b) * q / (a * b * c))


def test_the_t_handle_flips_at_half_the_period():
    result = summary_of(EXAMPLES / "t-handle.toml")
    motion, body = result["motion"], result["body"]
    spin = np.array(body["principal_axes"]) @ (2 * np.pi * np.array([0.005, 5, 0.005]))
    flip = half_period(body["principal_moments"], spin)
    assert motion["regime"] == "short-axis mode"
    # Near the separatrix 1 − k² = 5e-6 magnifies the rounding of the moments' digits.
    assert motion["flip_time"] == pytest.approx(flip, rel=1e-9)
    assert motion["reversals"]["count"] == 9
    # Crossings are found by straight lines between outputs 2 ms apart.
    assert motion["reversals"]["mean_interval"] == pytest.approx(flip, rel=1e-5)


def test_the_symmetric_top_agrees_with_the_closed_form():
    closed = summary_of(EXAMPLES / "symmetric-top.toml")["motion"]["closed_form"]
    assert closed["largest_rotor_difference"] < 1e-11
    # Angular velocities of 19 rad/s.
    assert closed["largest_omega_difference"] < 2e-10


def test_toutatis_has_the_published_periods():
    """Hudson & Ostro 1995: 5.41 and 7.35 days."""
    result = summary_of(EXAMPLES / "toutatis.toml")
    motion = result["motion"]
    assert motion["regime"] == "long-axis mode"
    assert motion["axis"] == 3
    assert motion["period"] / 86400 == pytest.approx(5.41, rel=0.01)
    assert motion["precession_period"] / 86400 == pytest.approx(7.35, rel=0.01)
    assert result["body"]["mass"] is None
    assert result["body"]["moment_ratios"] == pytest.approx([1, 3.09, 3.22])


def test_the_gyroscope_precesses_by_the_fast_top_formula():
    motion = summary_of(EXAMPLES / "gyroscope.toml")["motion"]
    mgl, i3, spin = 0.5 * 9.81 * 0.04, 0.5 * 0.05**2 / 2, 2 * np.pi * 100
    assert motion["mgl"] == pytest.approx(mgl, rel=1e-12)
    assert motion["fast_top_precession_rate"] == pytest.approx(mgl / (i3 * spin), rel=1e-12)
    assert motion["precession_rate"] == pytest.approx(mgl / (i3 * spin), rel=0.005)
    assert motion["tilt_min"] == pytest.approx(np.radians(30), abs=1e-9)


# --- files


@pytest.mark.parametrize("gravity", [False, True], ids=["free", "heavy"])
def test_the_files(gravity, tmp_path):
    xarray = pytest.importorskip("xarray")
    path, output = tmp_path / "a.toml", tmp_path / "out.nc"
    text = SCENE.replace("[run]", "[gravity]\nacceleration = 9.81\n[run]") if gravity else SCENE
    path.write_text(
        text.replace("moments = [1, 2, 3]", "moments = [1, 2, 3]\nmass = 2\ncenter_of_mass = [0, 0, 0.5]")
    )
    result = summary_of(path, "-o", output)
    second = "axis" if gravity else "polhode"
    expected = [output, tmp_path / "out-motion.png", tmp_path / f"out-{second}.png"]
    assert result["files"] == [str(p) for p in expected]
    assert sorted(tmp_path.iterdir()) == sorted([path, *expected])
    for figure in expected[1:]:
        assert figure.read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
        assert figure.read_bytes().endswith(b"IEND\xaeB`\x82")

    data = xarray.open_dataset(output, engine="h5netcdf")
    assert dict(data.sizes) == {"time": 11, "quaternion": 4, "axis": 3, "inertia_column": 3}
    dims_and_units = {name: (v.dims, v.attrs["units"]) for name, v in data.data_vars.items()}
    assert dims_and_units == {
        "attitude": (("time", "quaternion"), "1"),
        "omega_body": (("time", "axis"), "rad/s"),
        "momentum_space": (("time", "axis"), "kg m^2/s"),
        "position": (("time", "axis"), "m"),
        "velocity": (("time", "axis"), "m/s"),
        "energy": (("time",), "J"),
        "inertia": (("axis", "inertia_column"), "kg m^2"),
    }
    assert data.quaternion.values.tolist() == ["w", "x", "y", "z"]
    assert "Omega_space R" in data.attrs["conventions"]
    assert data.attrs["Conventions"] == "CF-1.11"
    assert data.attrs["history"] == f"written by polhode {ph.__version__}"
    assert data.attrs["source"] == f"polhode {ph.__version__}"
    assert data.attrs["scene"] == path.read_text()
    assert data.attrs["title"] == result["title"] == "Small"
    assert data.attrs["method"] == result["run"]["method"]

    np.testing.assert_allclose(data.time.values, np.linspace(0, 1, 11), rtol=1e-15)
    # A few ulps: the closed form goes through elliptic functions and back.
    np.testing.assert_allclose(data.omega_body.values[0], [0.01, 1, 0.01], rtol=0, atol=1e-15)
    np.testing.assert_allclose(data.attitude.values[0], [1, 0, 0, 0], rtol=0, atol=1e-15)
    conserved = {name: entry["value"] for name, entry in result["conserved"].items()}
    assert json.loads(data.attrs["conserved"]) == conserved
    np.testing.assert_allclose(data.energy.values, conserved["energy"], rtol=1e-9)
    # The columns fit together: L = R I(Ω_B) ~R with the quaternion turned into a rotor.
    R = ph.Rotor.from_quaternion(data.attitude.values, order="wxyz")
    L = R(ph.Inertia.from_matrix(data.inertia.values)(ph.bivector(data.omega_body.values)))
    np.testing.assert_allclose(L.components, data.momentum_space.values, rtol=0, atol=1e-14 * L.norm().max())
    again = ph.Scene.read(path).run()
    np.testing.assert_array_equal(again.omega_body.components, data.omega_body.values)
    data.close()


def test_json_is_one_document_and_nothing_else(scene):
    done = polhode("run", scene, "--json")
    assert done.stderr == ""
    result = json.loads(done.stdout)
    assert result["scene"] == str(scene)
    assert result["files"] == []
    assert result["run"]["drift_within_bound"] is True
    assert result["run"]["duration"] == 1.0
    # Neither NaN nor Infinity, which JSON does not have.
    json.loads(done.stdout, parse_constant=pytest.fail)


def test_scenes_run_from_any_directory_and_path(tmp_path):
    """The mesh is found next to its scene; the path has spaces and non-ASCII letters."""
    folder = tmp_path / "Ωmega und mehr" / "twó"
    folder.mkdir(parents=True)
    scene = folder / "kreisel – 1.toml"
    scene.write_text((EXAMPLES / "t-handle.toml").read_text().replace("samples = 6001", "samples = 21"))
    (folder / "t-handle.stl").write_bytes((EXAMPLES / "t-handle.stl").read_bytes())
    relative = scene.relative_to(tmp_path)
    done = polhode("run", relative, "-o", "Ωmega und mehr/out put.nc", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert (folder.parent / "out put.nc").exists()
    assert (folder.parent / "out put-polhode.png").exists()
    assert polhode("check", scene, cwd="/").returncode == 0


def test_an_older_file_is_replaced_and_keeps_its_mode(scene, tmp_path):
    output = tmp_path / "out.nc"
    output.write_bytes(b"old")
    output.chmod(0o640)
    assert polhode("run", scene, "-o", output, "--force").returncode == 0
    assert output.read_bytes().startswith(b"\x89HDF")
    assert output.stat().st_mode & 0o777 == 0o640


# --- help, versions, usage


def test_help_and_version():
    done = polhode("--help")
    assert done.returncode == 0
    for word in ("run", "check", "Exit codes", "130"):
        assert word in done.stdout
    assert "FILE.nc" in polhode("run", "--help").stdout
    assert polhode("--version").stdout == f"polhode {ph.__version__}\n"


@pytest.mark.parametrize("arguments", [[], ["run"], ["check"], ["walk"], ["run", "a.toml", "--fast"]])
def test_wrong_usage_is_2(arguments):
    done = polhode(*arguments)
    assert done.returncode == 2
    assert "usage: polhode" in done.stderr
    assert done.stdout == ""


# --- check


def test_check_reports_good_and_bad_scenes(scene, tmp_path):
    bad = tmp_path / "bad.toml"
    bad.write_text(SCENE.replace("duration", "durration"))
    done = polhode("check", scene)
    assert (done.returncode, done.stderr) == (0, "")
    assert f"{scene}: ok" in done.stdout
    both = polhode("check", scene, bad)
    assert both.returncode == 3
    assert f"{scene}: ok" in both.stdout
    assert "durration" in both.stderr
    findings = polhode("check", "--json", bad, scene)
    assert findings.returncode == 3
    first, second = json.loads(findings.stdout)
    assert (first["ok"], second["ok"]) == (False, True)
    assert "durration" in first["errors"]


# --- standard output


def test_a_closed_pipe_is_not_an_error(scene):
    """As `polhode run … | head -1`, with the pipe closed before the first word."""
    read, write = os.pipe()
    os.close(read)
    with os.fdopen(write, "wb") as stdout:
        done = polhode("run", scene, stdout=stdout)
    assert done.returncode in (0, 1)
    assert done.stderr == ""


def test_output_piped_to_head():
    command = f'"{POLHODE}" run "{EXAMPLES / "symmetric-top.toml"}" | head -1'
    done = processes.run(command, shell=True)
    assert done.stdout == "Free symmetric top\n"
    assert done.stderr == ""


def test_output_that_cannot_be_printed_is_an_error(scene):
    with open("/dev/full", "wb") as stdout:
        done = polhode("run", scene, stdout=stdout)
    assert done.returncode == 1
    assert "error: no space left" in done.stderr


@pytest.mark.parametrize("encoding", ["ascii", "cp1252"])
def test_the_summary_prints_in_any_encoding(encoding, scene):
    """Missing characters do not make the command fail."""
    done = polhode("run", scene, encoding=encoding, env={"PYTHONIOENCODING": encoding})
    assert done.returncode == 0, done.stderr
    assert "short-axis mode" in done.stdout
