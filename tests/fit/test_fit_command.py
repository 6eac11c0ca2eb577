"""``polhode fit``: data from CSV files, units, columns, errors with their places."""

import io
import json
from pathlib import Path

import numpy as np
import pytest

import polhode as ph
from polhode._cli import main
from polhode._fit import units
from polhode._fit.table import read_tables

pytest.importorskip("scipy")

BODY = ph.Inertia.from_principal_moments(1, 2, 2.6)
FREE = ph.FreeMotion(BODY, ph.Rotor.identity(), [0.3, 4.0, 0.9])
RATIOS = np.array([1, 2, 2.6]) / 2.6
TIMES = np.arange(0, 300)  # in hundredths of a second


def table(path, header, *columns):
    rows = np.column_stack(columns)
    path.write_text("\n".join([header, *(",".join(map(repr, row.tolist())) for row in rows)]) + "\n")
    return str(path)


@pytest.fixture
def rates(tmp_path):
    noise = np.random.default_rng(0).normal(size=(300, 3)) * 0.5
    omega = np.degrees(FREE.at(TIMES * 0.01).omega_body.components) + noise + [1, 0, 0]
    return table(tmp_path / "gyro.csv", "t,wx,wy,wz", TIMES * 10.0, omega)


UNITS = ["--time-unit", "ms", "--rate-unit", "deg/s"]


def test_rates_in_degrees_and_milliseconds(rates, capsys):
    assert main.main(["fit", rates, *UNITS, "--sigma", "0.5", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    errors = dict(zip(found["names"], found["stderr"], strict=True))
    off = np.abs(np.array(found["moments"]) - RATIOS)[:2]
    assert (off < 4 * np.array([errors["i1/i3"], errors["i2/i3"]])).all()
    assert abs(found["bias"][0] - np.radians(1)) < 4 * errors["bias_1"]
    # The mean of squared residuals has the variance 2/dof.
    assert abs(found["chi2_reduced"] - 1) < 5 * np.sqrt(2 / found["dof"])


def test_summary_and_files(rates, tmp_path, capsys):
    pytest.importorskip("matplotlib")
    out, figure = str(tmp_path / "fit.json"), str(tmp_path / "fit.svg")
    assert main.main(["fit", rates, *UNITS, "-o", out, "--plot", figure]) == 0
    text = capsys.readouterr().out
    assert text.startswith("i1/i3")
    assert "sigma                 estimated" in text
    assert text.endswith(f"Written\n  {out}\n  {figure}\n")
    assert json.loads((tmp_path / "fit.json").read_text())["chi2_reduced"] is None
    assert (tmp_path / "fit.svg").read_text().startswith("<?xml")


@pytest.mark.parametrize("form", ["json", "svg", "pdf", "png"])
def test_files_of_others_are_kept(form, rates, tmp_path, capsys):
    pytest.importorskip("matplotlib")
    path = tmp_path / f"mine.{form}"
    path.write_text("{}")
    option = "-o" if form == "json" else "--plot"
    arguments = ["fit", rates, *UNITS, "--quiet", option, str(path)]
    assert main.main(arguments) == 1
    assert f"{path} exists and was not written by polhode" in capsys.readouterr().err
    assert path.read_text() == "{}"
    assert main.main([*arguments, "--force"]) == 0
    assert main.main(arguments) == 0  # its own file is overwritten
    assert path.stat().st_size > 1000


def test_periods_keep_files_of_others(tmp_path, capsys):
    path = tmp_path / "mine.json"
    path.write_text("{}")
    arguments = ["fit", "--periods", "263 h", "27.38 h", "--moments", "0.61", "0.965", "1", "-o", str(path)]
    assert main.main(arguments) == 1
    assert "overwrite it with --force" in capsys.readouterr().err
    assert main.main([*arguments, "--force"]) == main.main(arguments) == 0
    assert json.loads(path.read_text())["source"].startswith("polhode ")


def test_a_body_that_does_not_fit_is_reported(tmp_path, capsys):
    """Quaternions from space axes to body axes, as of another convention."""
    q = (~FREE.at(TIMES * 0.01).rotor).to_quaternion(order="wxyz")
    path = table(tmp_path / "q.csv", "t,qw,qx,qy,qz", TIMES * 0.01, q)
    assert main.main(["fit", path, "--time-unit", "s"]) == 0
    captured = capsys.readouterr()
    assert "\nmisfit                the body does not fit these data (rms of attitude" in captured.out
    assert captured.err.startswith("polhode: warning: the body does not fit these data (rms of attitude")
    assert "their direction (from body to space axes)" in captured.err


@pytest.mark.parametrize("order", ["wxyz", "xyzw"])
def test_quaternions(order, tmp_path, capsys):
    q = FREE.at(TIMES * 0.01).rotor.to_quaternion(order=order)
    path = table(tmp_path / "q.csv", "time, a, b, c, d", TIMES * 0.01, q)
    options = ["--time-unit", "s", "--columns", "time,a,b,c,d", "--order", order, "--quiet"]
    assert main.main(["fit", path, *options, "-o", str(tmp_path / "fit.json")]) == 0
    assert capsys.readouterr().out == ""
    found = json.loads((tmp_path / "fit.json").read_text())
    np.testing.assert_allclose(found["moments"], RATIOS, atol=1e-6)
    np.testing.assert_allclose(found["attitude_wxyz"], [1, 0, 0, 0], atol=1e-6)
    assert found["bias"] is None


@pytest.fixture
def both(tmp_path):
    """Rates at 100 Hz that are 0.05 s late, and a quaternion at every third time."""
    rng = np.random.default_rng(1)
    t, every = TIMES * 0.01, TIMES % 3 == 0
    omega = FREE.at(t - 0.05).omega_body.components + 0.01 * rng.normal(size=(300, 3))
    turns = ph.Rotor.from_rotation_vector(0.002 * rng.normal(size=(300, 3)))
    q = (turns * FREE.at(t).rotor).to_quaternion(order="wxyz")
    lines = ["t,wx,wy,wz,qw,qx,qy,qz"]
    for k, time in enumerate(t.tolist()):
        cells = [time, *omega[k].tolist(), *(q[k].tolist() if every[k] else [])]
        lines.append(",".join(map(repr, cells)) + ",,,," * (not every[k]))
    path = tmp_path / "both.csv"
    path.write_text("\n".join(lines) + "\n")
    return str(path)


SIGMAS = ["--time-unit", "s", "--rate-unit", "rad/s", "--sigma", "0.01", "--sigma-attitude", "0.002"]


def test_rates_and_quaternions_in_one_file(both, capsys):
    assert main.main(["fit", both, *SIGMAS, "--clock-offset", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    # Ten parameters within 4.5 standard deviations: each is left with probability 7e-6.
    errors = dict(zip(found["names"], found["stderr"], strict=True))
    assert (np.abs(np.array(found["moments"]) - RATIOS)[:2] < 4.5 * np.array(found["stderr"][:2])).all()
    assert abs(found["clock_offset"] + 0.05) < 4.5 * errors["clock_offset"] < 0.005
    # 300 rates and 100 quaternions of three components each, 12 parameters.
    assert found["dof"] == 3 * 400 - 12
    assert abs(found["chi2_reduced"] - 1) < 5 * np.sqrt(2 / found["dof"])


def test_errors_of_both_kinds(both, rates, tmp_path, capsys):
    lines = (tmp_path / "both.csv").read_text().split("\n")
    lines[2] = lines[2].replace(",,,,", ",1,,,")
    (tmp_path / "both.csv").write_text("\n".join(lines))
    assert main.main(["fit", both, *SIGMAS]) == 3
    assert (
        f"both.csv:3:{len(lines[2].rstrip(',')) + 2}: error: the field is empty; remove"
        in capsys.readouterr().err
    )
    for options, message in (
        (SIGMAS[:-2], "need --sigma, of the rates, and --sigma-attitude"),
        ([*SIGMAS, "--free", "damping"], "give them with --torque SCENE.toml"),
    ):
        lines[2] = lines[1]
        (tmp_path / "both.csv").write_text("\n".join([lines[0], *lines[3:]]))
        with pytest.raises(SystemExit):
            main.main(["fit", both, *options])
        assert message in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main.main(["fit", rates, *UNITS, "--clock-offset"])
    assert "--clock-offset needs a file with rates and attitudes" in capsys.readouterr().err


SCENE = """
[body]
moments = ["1 kg m²", "2 kg m²", "2.6 kg m²"]

[initial]
spin = { vector = ["0.3 rad/s", "4 rad/s", "0.9 rad/s"] }

[torque]
viscous_damping = ["0.05 N m s", "0.1 N m s", "0.08 N m s"]

[run]
duration = "3 s"
"""


def test_torques_of_a_scene(tmp_path, capsys):
    damped = ph.simulate(
        BODY,
        ph.State(ph.Rotor.identity(), ph.bivector([0.3, 4.0, 0.9])),
        TIMES * 0.01,
        ph.torque.viscous_damping([0.3, 0.5, 0.4]),
    )
    noise = 0.005 * np.random.default_rng(2).normal(size=(300, 3))
    path = table(tmp_path / "damped.csv", "t,wx,wy,wz", TIMES * 0.01, damped.omega_body.components + noise)
    (tmp_path / "damped.toml").write_text(SCENE)
    options = ["--torque", str(tmp_path / "damped.toml"), "--free", "viscous_damping", "--no-bias", "--json"]
    assert main.main(["fit", path, "--time-unit", "s", "--rate-unit", "rad/s", *options]) == 0
    found = json.loads(capsys.readouterr().out)
    k = found["names"].index("viscous_damping.d_1")
    values, errors = (np.array(found[x])[k : k + 3] for x in ("values", "stderr"))
    assert (np.abs(values - np.array([0.3, 0.5, 0.4]) / 2.6) < 4.5 * errors).all()
    assert found["units"][k] == "N m s / (kg m²)"


def test_quaternions_by_names(tmp_path, capsys):
    q = FREE.at(TIMES * 0.01).rotor.to_quaternion(order="wxyz")
    path = table(tmp_path / "q.csv", "qx,qy,qz,qw,t", q[:, 1:], q[:, 0], TIMES * 0.01)
    assert main.main(["fit", path, "--time-unit", "s", "--json"]) == 0
    np.testing.assert_allclose(json.loads(capsys.readouterr().out)["moments"], RATIOS, atol=1e-6)


@pytest.mark.parametrize("separator", [";", "\t"])
def test_quoted_names_and_other_separators(separator, rates, tmp_path, capsys):
    """As programs on phones and spreadsheets write them."""
    names = '"Time (s)","Gyroscope, x","Gyroscope y (rad/s)","Gyroscope z (rad/s)"'
    text = Path(rates).read_text()
    (tmp_path / "a.csv").write_text(text.replace(",", separator))
    (tmp_path / "b.csv").write_text(text.replace("t,wx,wy,wz", names))
    given = ["--columns", "Time (s),x,Gyroscope y (rad/s),Gyroscope z (rad/s)"]
    assert main.main(["fit", str(tmp_path / "b.csv"), *UNITS, *given]) == 3
    assert "no column 'x' among Time (s), Gyroscope, x, Gyroscope y" in capsys.readouterr().err
    found = read_tables(tmp_path / "a.csv", None)["rates"]
    same = read_tables(
        tmp_path / "b.csv", ("Time (s)", "Gyroscope, x", *names.replace('"', "").split(",")[3:])
    )
    plain = read_tables(Path(rates), None)["rates"]
    for table in (found, same["rates"]):
        np.testing.assert_array_equal(table.times, plain.times)
        np.testing.assert_array_equal(table.values, plain.values)


def test_all_fields_may_be_quoted_and_lines_end_as_on_any_system(rates, tmp_path):
    text = Path(rates).read_text()
    quoted = "\n".join(f'"{line}"'.replace(",", '","') for line in text.splitlines())
    plain = read_tables(Path(rates), None)["rates"]
    for k, other in enumerate(
        (quoted, text.replace("\n", "\r\n"), text.replace("\n", "\r"), f"\ufeff{quoted}")
    ):
        (tmp_path / f"{k}.csv").write_text(other, "utf-8", newline="")
        found = read_tables(tmp_path / f"{k}.csv", None)["rates"]
        np.testing.assert_array_equal(found.times, plain.times)
        np.testing.assert_array_equal(found.values, plain.values)


LINES = "t,wx,wy,wz\n0,1,2,3\n1,1,2,3\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (LINES + "2, 1,x2,3\n", ":4:6: error: 'x2' is not a finite number"),
        (LINES + "2,1,2,  nan\n", ":4:9: error: 'nan' is not a finite number"),
        (LINES + "2,1,2,1_0\n", ":4:7: error: '1_0' is not a finite number; remove the row"),
        (150_000 * "t" + "\n", ":1:1: error: not names of columns: field larger than field limit"),
        (LINES + "# a comment\n\n2,1,2\n", ":6:1: error: 3 fields, but 4 columns are named"),
        (LINES + "2,,2,3\n", ":4:3: error: the field is empty; remove the row"),
        (
            LINES.replace(",", ";") + "2;1,5;2;3\n",
            ":4:3: error: '1,5' is not a finite number; write a decimal",
        ),
        (LINES + "1,1,2,3\n", ":4:1: error: times must increase, but 1 follows 1; remove samples"),
        (LINES + "0.5,1,2,3\n", ":4:1: error: times must increase, but 0.5 follows 1; sort the rows by time"),
        ("0,1,2,3\n1,1,2,3\n", ":1:1: error: the first line has numbers; it must have the names"),
        ("t,wx,wy\n0,1,2\n", ":1:1: error: the columns t, wx, wy have neither rates t,wx,wy,wz nor"),
        ("t,wx,wx,wy,wz\n", ":1:1: error: 2 columns are named 'wx'"),
        ("\n\n", ": error: the file is empty"),
        ("t,wx,wy,wz\n", ":1:1: error: the file ends after 0 rows of rates; a fit needs at least 3"),
        (LINES, ":3:1: error: the file ends after 2 rows of rates; a fit needs at least 3"),
        (
            f"# {LINES}",
            ":2:1: error: the first line has numbers; it must have the names of the columns; remove the",
        ),
        ("t,qw,qx,qy,qz\n0,1,0,0,0\n1, 0,0,0,0\n", ":3:4: error: the quaternion must have norm 1, got 0;"),
        ("t,qw,qx,qy,qz\n0,1,0,0,0\n1,0.6,0.8,0.3,0\n", ":3:3: error: the quaternion must have norm 1"),
        ("t wx wy wz\n0 1 2 3\n", ":1:1: error: the columns are separated by spaces; separate names"),
        (
            LINES + "2026-01-01T00:00:02,1,2,3\n",
            ":4:1: error: '2026-01-01T00:00:02' is not a finite number; write times as numbers",
        ),
        ("t,wx,wy,wz\n0,1,2,3\n", ":2:1: error: the file ends after 1 row of rates"),
        (LINES + "5\n", ":4:1: error: 1 field, but 4 columns are named"),
    ],
)
def test_errors_have_places(text, message, tmp_path, capsys):
    path = tmp_path / "bad.csv"
    path.write_text(text)
    assert main.main(["fit", str(path), *UNITS]) == 3
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith(f"{path}{message}")


def test_missing_names_and_bytes(rates, tmp_path, capsys):
    assert main.main(["fit", rates, *UNITS, "--columns", "t,x,y,z"]) == 3
    assert "gyro.csv:1:1: error: there is no column 'x' among t, wx, wy, wz;" in capsys.readouterr().err
    (tmp_path / "b.csv").write_bytes(b"t,wx\xff")
    assert main.main(["fit", str(tmp_path / "b.csv"), *UNITS]) == 3
    assert "not UTF-8 text from byte 4 on" in capsys.readouterr().err
    assert main.main(["fit", str(tmp_path / "absent.csv"), *UNITS]) == 3
    assert "absent.csv: error: no such file or directory" in capsys.readouterr().err
    assert main.main(["fit", f"{300 * 'x'}.csv", *UNITS]) == 3
    assert "x.csv: error: file name too long" in capsys.readouterr().err


def test_options_that_do_not_apply_are_refused(rates, tmp_path, capsys):
    (tmp_path / "scene.toml").write_text(SCENE.replace("viscous_damping", "# viscous_damping"))
    q = FREE.at(TIMES * 0.01).rotor.to_quaternion(order="wxyz")
    attitudes = table(tmp_path / "q.csv", "t,qw,qx,qy,qz", TIMES * 0.01, q)
    seconds = ["--time-unit", "s"]
    for arguments, message in (
        ([rates, *UNITS, "--sigma-attitude", "0.1"], "--sigma-attitude needs a file with attitudes"),
        ([rates, *UNITS, "--order", "xyzw"], "--order needs a file with attitudes"),
        ([rates, *UNITS, "--torque", str(tmp_path / "scene.toml")], "--torque needs a scene with torques"),
        ([attitudes, *seconds, "--rate-unit", "rpm"], "--rate-unit needs a file with rates"),
        ([attitudes, *seconds, "--no-bias"], "--no-bias needs a file with rates"),
        ([attitudes, *seconds, "--clock-offset"], "--clock-offset needs a file with rates and attitudes"),
        ([attitudes, *seconds, "--order", "xyzw"], "--order needs --columns"),
        ([attitudes, *seconds, "--sigma", "1", "--sigma-attitude", "1"], "give one of them"),
    ):
        with pytest.raises(SystemExit) as stop:
            main.main(["fit", *arguments])
        assert stop.value.code == 2
        assert message in capsys.readouterr().err


def test_standard_input_and_long_units(rates, monkeypatch, capsys):
    """Rates in degrees a day and times in days of a body that turns in as many days as seconds before."""
    text = Path(rates).read_text()
    rows = [[float(x) for x in line.split(",")] for line in text.splitlines()[1:]]
    slow = "\n".join(["t,wx,wy,wz", *(",".join(map(repr, [t / 1000, *w])) for t, *w in rows)])
    found = []
    for content, own in ((text, UNITS), (slow, ["--time-unit", "d", "--rate-unit", "deg/day"])):
        monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(content.encode())))
        assert main.main(["fit", "-", *own, "--sigma", "0.5", "--json"]) == 0
        found.append(json.loads(capsys.readouterr().out))
    day = 86400
    np.testing.assert_allclose(found[1]["moments"], found[0]["moments"], rtol=1e-5)
    np.testing.assert_allclose(np.array(found[1]["omega_body"]) * day, found[0]["omega_body"], rtol=1e-4)
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(b"t,wx\n")))
    assert main.main(["fit", "-", *UNITS]) == 3
    assert capsys.readouterr().err.startswith("<stdin>:1:1: error: the columns t, wx have neither")


@pytest.fixture
def motion(tmp_path, monkeypatch):
    """The motion as `Trajectory.save` writes it, and its parts as `ph.io.write` does."""
    monkeypatch.chdir(tmp_path)
    times = TIMES * 0.01
    ph.simulate(BODY, ph.State(ph.Rotor.identity(), [0.3, 4.0, 0.9]), times).save("motion.csv")
    rotor, omega = (getattr(ph.io.read_csv("motion.csv"), name) for name in ("rotor", "omega_body"))
    ph.io.write(ph.io.AttitudeHistory(times, rotor), "attitudes.csv")
    ph.io.write(ph.io.AttitudeHistory(times, rotor, omega), "both.csv")
    lines = Path("both.csv").read_text().splitlines()
    own = [0, *range(5, 8)]
    rows = [",".join(line.split(",")[k] for k in own) for line in lines]
    Path("rates.csv").write_text("\n".join(rows) + "\n")


OF_RATES = ["--columns", "time,omega_body_x,omega_body_y,omega_body_z"]
OF_ATTITUDES = ["--columns", "time,attitude_w,attitude_x,attitude_y,attitude_z"]


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("attitudes.csv", []),
        ("rates.csv", ["--time-unit", "s"]),
        ("both.csv", ["--sigma", "1e-6", "--sigma-attitude", "1e-6"]),
        ("motion.csv", ["--sigma", "1e-6", "--sigma-attitude", "1e-6"]),
        ("motion.csv", OF_RATES),
        ("motion.csv", OF_ATTITUDES),
    ],
)
@pytest.mark.usefixtures("motion")
def test_tables_that_polhode_wrote(name, options, capsys):
    """Their names state the units."""
    assert main.main(["fit", name, *options, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    np.testing.assert_allclose(found["moments"], RATIOS, atol=1e-6)
    np.testing.assert_allclose(found["omega_body"], [0.3, 4.0, 0.9], atol=1e-6)


@pytest.mark.usefixtures("motion")
def test_a_motion_has_rates_and_attitudes(capsys):
    with pytest.raises(SystemExit):
        main.main(["fit", "motion.csv"])
    assert f"name the columns of one of them, as {' '.join(OF_RATES)}" in capsys.readouterr().err


def test_other_units_under_such_names_need_columns(rates, tmp_path, capsys):
    path = tmp_path / "named.csv"
    path.write_text(Path(rates).read_text().replace("t,wx,wy,wz", OF_RATES[1]))
    with pytest.raises(SystemExit):
        main.main(["fit", str(path), *UNITS])
    assert "--time-unit is ms, but columns with these names are in s: leave it out" in capsys.readouterr().err
    found = []
    for arguments in ([str(path), *OF_RATES], [rates]):
        assert main.main(["fit", *arguments, *UNITS, "--json"]) == 0
        found.append(json.loads(capsys.readouterr().out)["moments"])
    assert found[0] == found[1]


def test_files_that_are_not_csv_are_named(tmp_path, capsys):
    batch = ph.State(ph.Rotor.identity(), ph.bivector([[0.3, 4, 0.9], [0, 1, 2]]))
    ph.simulate(BODY, batch, [0.0, 1.0, 2.0]).save(tmp_path / "batch.csv")
    (tmp_path / "m.nc").write_bytes(b"\x89HDF")
    (tmp_path / "m.dat").write_bytes(b"PAR1")
    (tmp_path / "s.toml").write_text("[body]\n")
    (tmp_path / "s.png").write_bytes(b"\x89PNG")
    for name, message in (
        ("batch.csv", ":1:1: error: the table has a batch of bodies; write one of them to a file of its own"),
        ("m.nc", f": error: not a CSV file; write one with `polhode convert {tmp_path / 'm.nc'} FILE.csv`"),
        (
            "m.dat",
            f": error: not a CSV file; rename it to {tmp_path / 'm.parquet'}, "
            f"then `polhode convert {tmp_path / 'm.parquet'} FILE.csv`",
        ),
        ("s.toml", ": error: not a CSV file but a scene: `polhode run"),
        ("s.png", ": error: not a CSV file but a picture"),
    ):
        assert main.main(["fit", str(tmp_path / name)]) == 3
        assert capsys.readouterr().err.startswith(f"{tmp_path / name}{message}")


def test_units_are_those_of_the_core():
    """Each as a definition of the formula language reads it, with the size that the SI brochure gives."""
    deg, day = np.pi / 180, 86400
    times = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1, "min": 60, "h": 3600, "d": day, "day": day}
    rates = {"rad/s": 1, "mrad/s": 1e-3, "deg/s": deg, "deg/h": deg / 3600, "deg/day": deg / day}
    rates |= {"arcsec/s": deg / 3600, "rev/s": 360 * deg, "rpm": 6 * deg}
    assert (tuple(times), tuple(rates)) == (units.TIMES, units.RATES)
    sizes = times | rates
    np.testing.assert_allclose([units.si(unit) for unit in sizes], list(sizes.values()), rtol=4e-16)


def test_a_fit_of_nothing_names_both_kinds_of_data(capsys):
    with pytest.raises(SystemExit):
        main.main(["fit"])
    assert "required: FILE.csv, or --periods ROTATION PRECESSION" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--time-unit", "s"], "rates need their unit: --rate-unit rad/s"),
        (["--rate-unit", "rpm"], "times need their unit: --time-unit ns, us"),
        ([*UNITS, "--columns", "t,wx"], "expected 4 names (time and rates), 5"),
        ([*UNITS[:2], "--columns", "t,wx,wy,wz,w"], "needs its order: --order wxyz"),
        ([*OF_ATTITUDES, "--order", "xyzw"], "--order is xyzw, but the names of --columns state wxyz"),
        ([*UNITS, "--columns", "t,wx,wy,wx"], "each column has one meaning, but 'wx' is named twice"),
        ([*UNITS, "--sigma", "0"], "expected a positive number, got '0'"),
        ([*UNITS, "-o", "fit.csv"], "a fit is saved as FILE.json, not 'fit.csv'"),
    ],
)
def test_wrong_usage(options, message, rates, capsys):
    with pytest.raises(SystemExit) as stop:
        main.main(["fit", rates, *options])
    assert stop.value.code == 2
    assert message in capsys.readouterr().err
