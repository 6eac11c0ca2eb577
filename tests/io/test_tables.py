"""CSV, Parquet and netCDF files read back, and errors of tables."""

import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, START

TIMES = np.linspace(0, 1, 7)
WHEELS = ph.torque.reaction_wheels(axes=[[0, 0, 1.0]], inertias=[0.1], speeds=[3.0])
MOTION = ph.simulate(ASYMMETRIC, START, TIMES)
MANY = ph.simulate(ASYMMETRIC, ph.State(ph.Rotor.random((2, 3), rng=1), [0.25, -0.5, 1.0]), TIMES)
QUANTITIES = ("omega_body", "momentum_space", "position", "velocity")
READERS = {"csv": ph.io.read_csv, "parquet": ph.io.read_parquet, "nc": ph.io.read_netcdf}
FORMS = pytest.mark.parametrize("form", READERS)


def assert_same(found, expected):
    assert found.time.tolist() == expected.time.tolist()
    for name in ("rotor", *QUANTITIES):
        assert np.array_equal(getattr(found, name).components, getattr(expected, name).components), name
    assert np.array_equal(found.energy, expected.energy)


@FORMS
def test_saved_motions_are_read_to_the_same_bits(form, tmp_path):
    MOTION.save(tmp_path / f"a.{form}")
    history = READERS[form](tmp_path / f"a.{form}")
    assert_same(history, MOTION)
    assert history.wheel_speed is None
    assert_same(ph.io.read(tmp_path / f"a.{form}"), MOTION)
    assert_same(history.trajectory(ASYMMETRIC), MOTION)


@FORMS
def test_histories_are_written_without_what_is_not_known(form, tmp_path):
    history = ph.io.AttitudeHistory(TIMES, MOTION.rotor, position=MOTION.position, attributes={"epoch": "x"})
    ph.io.write(history, tmp_path / f"a.{form}")
    found = READERS[form](tmp_path / f"a.{form}")
    assert found.omega_body is None
    assert found.energy is None
    assert np.array_equal(found.rotor.components, MOTION.rotor.components)
    assert np.array_equal(found.position.components, MOTION.position.components)
    assert found.attributes == ({} if form == "csv" else {"epoch": "x"})


@FORMS
def test_wheels_are_kept(form, tmp_path):
    motion = ph.simulate(ASYMMETRIC, START, TIMES, WHEELS)
    motion.save(tmp_path / f"a.{form}")
    history = READERS[form](tmp_path / f"a.{form}")
    assert np.array_equal(history.wheel_speed, motion.wheel_speed)
    ph.io.write(history, tmp_path / f"b.{form}")
    assert np.array_equal(READERS[form](tmp_path / f"b.{form}").wheel_speed, motion.wheel_speed)


@pytest.mark.parametrize("form", ["csv", "parquet"])
def test_a_body_of_a_batch_is_chosen(form, tmp_path):
    path = tmp_path / f"a.{form}"
    MANY.save(path)
    with pytest.raises(ValueError, match="holds a batch of bodies; choose one by its number, as in body=0"):
        READERS[form](path)
    with pytest.raises(ValueError, match="no body 6; it has 0 to 5"):
        READERS[form](path, body=6)
    assert_same(READERS[form](path, body=4), MANY[1, 1])


def test_columns_are_found_by_name(tmp_path):
    (tmp_path / "a.csv").write_text(
        "attitude_z, time, attitude_x, attitude_w, attitude_y\n0,1,0,1,0\n1,2,0,0,0\n"
    )
    history = ph.io.read_csv(tmp_path / "a.csv")
    assert history.time.tolist() == [1, 2]
    np.testing.assert_array_equal(history.rotor.to_quaternion(order="wxyz"), [[1, 0, 0, 0], [0, 0, 0, 1]])


HEADER = "time,attitude_w,attitude_x,attitude_y,attitude_z"


@pytest.mark.parametrize("separator", [";", "\t"])
def test_columns_may_be_separated_by_semicolons_or_tabs(separator, tmp_path):
    path = tmp_path / "a.csv"
    text = f"{HEADER}\n0,1,0,0,0\n1,0,0,0,1\n"
    path.write_text(text.replace(",", separator))
    assert ph.io.read_csv(path).rotor.to_quaternion(order="wxyz").tolist() == [[1, 0, 0, 0], [0, 0, 0, 1]]
    path.write_text(f"{text}2,1,0,x,0\n".replace(",", separator))
    with pytest.raises(ph.io.FileError, match=r"a\.csv:4:7: error: 'x' is not a finite number"):
        ph.io.read_csv(path)


def test_comments_and_empty_lines_are_skipped(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(
        f"# made by a program\n\n  \n{HEADER}\n0,1,0,0,0\n# half a turn, about e3\n1,0,0,0,1\n#\n"
    )
    assert ph.io.read_csv(path).rotor.to_quaternion(order="wxyz").tolist() == [[1, 0, 0, 0], [0, 0, 0, 1]]


def test_the_number_of_a_body_is_a_whole_number(tmp_path):
    """It was compared with the bodies of the file, which then seemed damaged or without that body."""
    state = ph.State(ph.Rotor.identity((2,)), [0.0, 0.0, 1.0])
    motion = ph.simulate(ph.Inertia.from_principal_moments(1, 2, 3), state, [0.0, 1.0])
    for form in ("csv", "nc"):
        pytest.importorskip("h5netcdf")
        motion.save(tmp_path / f"a.{form}")
        with pytest.raises(TypeError, match="body must be a whole number, got str"):
            ph.io.read(tmp_path / f"a.{form}", body="0")
        assert ph.io.read(tmp_path / f"a.{form}", body=np.int64(1)).time.tolist() == [0, 1]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "a.csv: error: the file is empty"),
        ("time,q0,q1,q2,q3\n", "a.csv:1:1: error: column 'q0' is not known"),
        ("time\n1\n", "the file has no column 'attitude_w'"),
        (f"{HEADER}\n0,1,0,0\n", "a.csv:2:1: error: expected 5 numbers as in line 1, got 4"),
        (f"{HEADER}\n0,1,0,x,0\n", "a.csv:2:7: error: 'x' is not a finite number"),
        (f"{HEADER}\n0,1,0,,0\n", "a.csv:2:7: error: the field is empty; correct it or remove the row"),
        (f"{HEADER}\n0,1,0,0,0\nnan,1,0,0,0\n", "a.csv:3:1: error: times must be finite, got nan\n"),
        (f"{HEADER}\n0,1,0,nan,0\n", "a.csv:2:3: error: attitude must be unit quaternions, got norm nan\n"),
        (f"{HEADER}\n0,2,0,0,0\n", "a.csv:2:3: error: attitude must be unit quaternions, got norm 2\n"),
        (f"{HEADER}\n0,1,0,0,0\n\n10,0,0,0,0\n", "a.csv:4:4: error: attitude must be unit quaternions, got"),
        (f"{HEADER}\n1,1,0,0,0\n0,1,0,0,0\n", "a.csv:3:1: error: times must increase, got 0.0 s after 1.0 s"),
        (f"{HEADER},omega_body_x\n0,1,0,0,0,1\n", "the columns of omega_body must be"),
        (f"{HEADER},time\n0,1,0,0,0,1\n", "column 'time' appears more than once"),
        (f"# note\n\n{HEADER},x\n", "a.csv:3:1: error: column 'x' is not known"),
        (
            f"# {HEADER}\n0,1,0,0,0\n",
            "a.csv:2:1: error: expected the names of the columns, got numbers; remove",
        ),
        (f",{HEADER}\n0,0,1,0,0,0\n", "a.csv:1:1: error: the first column has no name; write a data frame"),
        ("# nothing\n", "a.csv: error: the file is empty"),
        # Lines end as in any text; other separators of lines are in a field.
        (f"{HEADER}\r0,1,0,0,0\r0,1,0,0,0\r", "a.csv:3:1: error: times must increase"),
        (
            f"{HEADER}\n0,1,0,0,0\n1,1,0,0,\x850\f0\n",
            "a.csv:3:9: error: '\\x850\\x0c0' is not a finite number",
        ),
        (
            HEADER + "," + 150_000 * "x",
            "a.csv:1:1: error: not a row of numbers: field larger than field limit",
        ),
    ],
)
def test_errors_of_tables_have_their_place(text, expected, tmp_path):
    (tmp_path / "a.csv").write_text(text, "utf-8", newline="")
    with pytest.raises(ph.io.FileError) as caught:
        ph.io.read_csv(tmp_path / "a.csv")
    assert expected in str(caught.value)


def test_errors_of_a_body_in_a_batch_have_their_place(tmp_path):
    (tmp_path / "a.csv").write_text(f"body,{HEADER}\n0,0,1,0,0,0\n1,0,1,0,0,0\n0,1,1,0,0,0\n1,1,0,0,0,0\n")
    with pytest.raises(ph.io.FileError, match=r"a\.csv:5:5: error: attitude must be unit quaternions"):
        ph.io.read_csv(tmp_path / "a.csv", body=1)


@pytest.mark.parametrize(
    ("encoding", "expected"),
    [
        ("utf-16", "a.csv: error: not UTF-8 text from byte 0 on; save the table as CSV in UTF-8"),
        ("utf-16-le", "a.csv: error: byte 1 is zero, not text; save the table as CSV in UTF-8"),
    ],
)
def test_tables_are_utf_8(encoding, expected, tmp_path):
    (tmp_path / "a.csv").write_text(f"{HEADER}\n0,1,0,0,0\n", encoding)
    with pytest.raises(ph.io.FileError) as caught:
        ph.io.read_csv(tmp_path / "a.csv")
    assert expected in str(caught.value)


@pytest.mark.parametrize("form", ["csv", "parquet", "nc", "aem"])
def test_missing_and_foreign_files(form, tmp_path):
    with pytest.raises(FileNotFoundError, match="no such file"):
        ph.io.read(tmp_path / f"a.{form}")
    (tmp_path / f"b.{form}").write_bytes(b"\xff\xfe\0garbage")
    with pytest.raises((ValueError, OSError), match=f"b.{form}"):
        ph.io.read(tmp_path / f"b.{form}")


@pytest.mark.parametrize("stated", [b"1e999", b"[1]", b"{"])
def test_attributes_of_parquet_files_are_an_object(stated, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    MOTION.save(tmp_path / "a.parquet")
    table = parquet.read_table(tmp_path / "a.parquet")
    parquet.write_table(table.replace_schema_metadata({"PANDAS_ATTRS": stated}), tmp_path / "a.parquet")
    with pytest.raises(ph.io.FileError, match=r"a\.parquet: error: cannot be read as a Parquet file"):
        ph.io.read(tmp_path / "a.parquet")


def test_other_suffixes_are_refused(tmp_path):
    with pytest.raises(
        ValueError, match=r"files that can be read end in \.aem, \.bc, \.csv, \.nc, \.parquet or \.zarr"
    ):
        ph.io.read(tmp_path / "a.txt")
    with pytest.raises(TypeError, match=r"a \.csv file has no option 'epoch'"):
        ph.io.write(MOTION, tmp_path / "a.csv", epoch="2026-01-01T00:00:00")


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ({"time": [0.0, 0.0]}, "times must increase"),
        ({"time": [0.0]}, "rotor must have shape"),
        ({"time": [[0.0]]}, r"time must have shape \(n,\), got \(1, 1\)"),
        ({"time": [0.0, np.nan]}, "times must be finite, got nan at row 1"),
        (
            {"omega_body": ph.bivector([[0, 0, 0.0], [0, np.inf, 0]])},
            "omega_body must be finite, got inf at row 1",
        ),
        ({"omega_body": ph.vector([[1, 2, 3.0]] * 2)}, "omega_body must be bivectors"),
        ({"rotor": 1}, "rotor must be a Rotor"),
        ({"energy": np.zeros((1, 2))}, r"energy must have shape \(n,\) for n = 2, got \(1, 2\)"),
        ({"wheel_speed": np.zeros((1, 2))}, r"wheel_speed must have shape \(n, k\) for n = 2, got \(1, 2\)"),
    ],
)
def test_histories_check_their_values(arguments, expected):
    with pytest.raises((TypeError, ValueError), match=expected):
        ph.io.AttitudeHistory(**{"time": [0.0, 1.0], "rotor": ph.Rotor.identity((2,)), **arguments})
