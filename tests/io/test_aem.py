"""CCSDS attitude ephemeris messages: known vectors, an independent reader, round trips, errors."""

import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, START

TIMES = np.linspace(0, 3, 7)
MOTION = ph.simulate(ASYMMETRIC, START, TIMES)
FRAMES = {"epoch": "2026-01-01T00:00:00", "reference_frame": "EME2000"}
EPOCHS = ["2026-01-01T00:00:00", "2026-001T00:00:01.5"]


def message(rows, *, version="2.0", kind="QUATERNION", a="EME2000", b="SC_BODY_1", more=(), system="UTC"):
    """An AEM, written here as text; `rows` are the numbers at the epochs above."""
    lines = [
        f"CCSDS_AEM_VERS = {version}",
        "COMMENT of the header",
        "CREATION_DATE = 2026-01-01T00:00:00",
        "ORIGINATOR = NOBODY",
        "",
        "META_START",
        "COMMENT of the metadata",
        "OBJECT_NAME = CURLEW",
        "OBJECT_ID = 2026-001A",
        f"REF_FRAME_A = {a}",
        f"REF_FRAME_B = {b}",
        f"TIME_SYSTEM = {system}",
        f"START_TIME = {EPOCHS[0]}",
        f"STOP_TIME = {EPOCHS[-1]}",
        f"ATTITUDE_TYPE = {kind}",
        *more,
        "META_STOP",
        "DATA_START",
        *(f"{epoch} {' '.join(map(str, row))}" for epoch, row in zip(EPOCHS, rows, strict=False)),
        "DATA_STOP",
    ]
    return "\n".join(lines) + "\n"


@pytest.fixture
def reads(tmp_path):
    def read(text, **options):
        path = tmp_path / "a.aem"
        path.write_text(text)
        return ph.io.read_aem(path, **options)

    return read


# Frame B is frame A turned by +90 degrees about z (CCSDS 504.0-B-2, annex F2.2): Q1 Q2 Q3 QC from A to B.
QUARTER = [0, 0, 0.5**0.5, 0.5**0.5]


def test_example_of_the_standard(reads):
    """The x axis of B has coordinates (0, 1, 0) in A; a vector (1, 0, 0) in A is (0, -1, 0) in B."""
    rotor = reads(message([QUARTER])).rotor[0]
    assert rotor(ph.e1).is_close(ph.e2, atol=1e-15)
    assert (~rotor)(ph.e1).is_close(-ph.e2, atol=1e-15)


def test_spin_example_of_the_standard(reads):
    """Annex F5.4: the quaternion at the reference epoch, and the z axis of the body in A."""
    history = reads(message([[0.0805, 0.0334, 0.9204, 0.3812]]))
    # The standard prints four digits.
    np.testing.assert_allclose(history.rotor[0](ph.e3).components, [0.1736, 0, 0.9848], atol=2e-4)


@pytest.mark.parametrize("order", ["FIRST", "LAST"])
@pytest.mark.parametrize("direction", ["A2B", "B2A"])
@pytest.mark.parametrize("body_is_b", [True, False])
def test_orders_and_directions_of_version_1(order, direction, body_is_b, reads):
    """All eight describe the body turned by a quarter turn about z."""
    # The body turned: from space to body by +90 degrees. A2B with the body as B, or B2A with it as A.
    sign = 1.0 if (direction == "A2B") == body_is_b else -1.0
    vector, scalar = [0, 0, sign * 0.5**0.5], [0.5**0.5]
    numbers = scalar + vector if order == "FIRST" else vector + scalar
    frames = {"a": "EME2000", "b": "SC_BODY_1"} if body_is_b else {"a": "SC_BODY_1", "b": "EME2000"}
    stated = (f"QUATERNION_TYPE = {order}", f"ATTITUDE_DIR = {direction}")
    history = reads(message([numbers], version="1.0", more=stated, **frames))
    assert history.rotor[0](ph.e1).is_close(ph.e2, atol=1e-15)
    assert history.attributes["reference_frame"] == "EME2000"
    given = {"quaternion_type": order, "attitude_dir": direction}
    again = reads(message([numbers], version="1.0", **frames), **given)
    assert np.array_equal(again.rotor.components, history.rotor.components)


@pytest.mark.parametrize(
    ("frame", "a", "b", "expected"),
    [
        ("REF_FRAME_B", "EME2000", "SC_BODY_1", [1, 2, 3]),
        ("SC_BODY_1", "EME2000", "SC_BODY_1", [1, 2, 3]),
        # Space components (1, 2, 3); the body's axes are (e2, -e1, e3) of space.
        ("EME2000", "EME2000", "SC_BODY_1", [2, -1, 3]),
        # B is space, and (1, 2, 3) in body axes the angular velocity of space relative to the body.
        ("REF_FRAME_A", "SC_BODY_1", "EME2000", [-1, -2, -3]),
    ],
)
def test_angular_velocities_are_in_degrees_in_the_stated_frame(frame, a, b, expected, reads):
    more = (f"ANGVEL_FRAME = {frame}",)
    history = reads(message([[*QUARTER, 1, 2, 3]], kind="QUATERNION/ANGVEL", a=a, b=b, more=more))
    # Products of numbers below 4 with a rotor known to rounding.
    np.testing.assert_allclose(history.omega_body.components[0], np.radians(expected), atol=1e-16, rtol=1e-15)


def test_times_count_leap_seconds_in_utc_only(reads):
    text = message([QUARTER, QUARTER]).replace("2026-01-01", "2016-12-31").replace("2026-001", "2017-001")
    assert reads(text).time.tolist() == [0, 86402.5]
    assert reads(text.replace("= UTC", "= TAI")).time.tolist() == [0, 86401.5]
    assert reads(text, epoch="2016-12-31T23:59:60").time.tolist() == [-86400, 2.5]


def test_quaternions_are_normalized_and_continuous(reads):
    history = reads(message([[0, 0, 0.6001, 0.8], [0, 0, -0.6, -0.8]]))
    np.testing.assert_allclose(history.rotor.norm(), 1, rtol=1e-15)
    assert history.rotor.components[1, 0] == pytest.approx(0.8)


def test_what_is_written_is_read_to_the_same_bits(tmp_path):
    """Quaternions, times; angular velocities go through degrees, two roundings."""
    ph.io.write_aem(MOTION, tmp_path / "a.aem", **FRAMES, interpolation=("LAGRANGE", 7), object_name="CURLEW")
    history = ph.io.read_aem(tmp_path / "a.aem")
    assert history.time.tolist() == TIMES.tolist()
    assert np.array_equal(history.rotor.components, MOTION.rotor.components)
    np.testing.assert_allclose(history.omega_body.components, MOTION.omega_body.components, rtol=4e-16)
    assert history.attributes == {
        "epoch": "2026-01-01T00:00:00",
        "time_system": "UTC",
        "reference_frame": "EME2000",
        "body_frame": "SC_BODY_1",
        "object_name": "CURLEW",
        "object_id": "UNKNOWN",
        "interpolation_method": "LAGRANGE",
        "interpolation_degree": "7",
    }
    # The attributes are enough to write it again.
    ph.io.write_aem(history, tmp_path / "b.aem")
    again = ph.io.read_aem(tmp_path / "b.aem")
    assert again.attributes == history.attributes
    assert np.array_equal(again.rotor.components, history.rotor.components)


def test_version_1_states_order_and_direction(tmp_path):
    ph.io.write_aem(MOTION, tmp_path / "a.aem", **FRAMES, version="1.0")
    text = (tmp_path / "a.aem").read_text()
    assert "QUATERNION_TYPE = LAST" in text
    assert "ATTITUDE_DIR = A2B" in text
    history = ph.io.read_aem(tmp_path / "a.aem")
    assert history.omega_body is None
    assert np.array_equal(history.rotor.components, MOTION.rotor.components)


def test_another_reader_finds_the_same_numbers(tmp_path):
    """ccsds-ndm-py parses the message with the checks of CCSDS 504.0-B-2."""
    reader = pytest.importorskip("ccsds_ndm")
    ph.io.write_aem(MOTION, tmp_path / "a.aem", **FRAMES)
    message = reader.Aem.from_file(str(tmp_path / "a.aem"))
    message.validate()
    (segment,) = message.segments
    assert (segment.metadata.ref_frame_a, segment.metadata.ref_frame_b) == ("EME2000", "SC_BODY_1")
    states = segment.data.attitude_states
    values = np.array([state.values for state in states])
    np.testing.assert_array_equal(values[:, :4], MOTION.rotor.to_quaternion(order="xyzw"))
    np.testing.assert_allclose(np.radians(values[:, 4:]), MOTION.omega_body.components, rtol=4e-16)
    assert [state.epoch for state in states][:2] == ["2026-01-01T00:00:00", "2026-01-01T00:00:00.5"]


def test_a_history_becomes_a_trajectory_of_a_body(tmp_path):
    ph.io.write_aem(MOTION, tmp_path / "a.aem", **FRAMES)
    found = ph.io.read_aem(tmp_path / "a.aem").trajectory(ASYMMETRIC)
    # Sums of three products of numbers known to two roundings.
    scale = np.abs(MOTION.momentum_space.components).max()
    np.testing.assert_allclose(
        found.momentum_space.components, MOTION.momentum_space.components, atol=2e-15 * scale
    )
    np.testing.assert_allclose(found.energy, MOTION.energy, rtol=2e-15)
    found.save(tmp_path / "a.csv")


@pytest.mark.parametrize(
    ("text", "options", "expected"),
    [
        ("OEM = 1", {}, "a.aem:1:1: error: an AEM begins with CCSDS_AEM_VERS, got 'OEM'"),
        ("", {}, "a.aem: error: the file is empty"),
        (message([QUARTER], version="3.0"), {}, "a.aem:1:18: error: versions 1.0 and 2.0"),
        (message([QUARTER], version="1.0"), {}, "QUATERNION_TYPE; give quaternion_type='FIRST' or"),
        (
            message([QUARTER], version="1.0"),
            {"quaternion_type": "LAST"},
            "a.aem:6:1: error: the segment has no ATTITUDE_DIR; give attitude_dir='A2B' or attitude_dir=",
        ),
        (message([QUARTER]), {"quaternion_type": "FIRST"}, "quaternion_type is 'LAST' in version 2.0"),
        (
            message([QUARTER], more=("QUATERNION_TYPE = LAST",)),
            {"quaternion_type": "FIRST"},
            "a.aem:16:19: error: QUATERNION_TYPE is LAST, but quaternion_type='FIRST' was given",
        ),
        (
            message([QUARTER], b="INSTRUMENT_A"),
            {},
            "a.aem:11:15: error: REF_FRAME_A and REF_FRAME_B do not show which frame is that of the body; "
            "give body_frame='EME2000' or body_frame='INSTRUMENT_A'",
        ),
        (
            message([QUARTER]).replace("REF_FRAME_A = EME2000\n", ""),
            {},
            "a.aem:6:1: error: the segment has no R",
        ),
        (message([QUARTER], kind="SPIN"), {}, "a.aem:15:17: error: ATTITUDE_TYPE must be QUATERNION or"),
        (
            message([[*QUARTER, 1, 2, 3]], kind="QUATERNION/ANGVEL"),
            {},
            "no ANGVEL_FRAME; give angvel_frame='EME2000' or angvel_frame='SC_BODY_1'",
        ),
        (message([[0, 0, 1, 1]]), {}, "a.aem:18:1: error: the quaternion must have norm 1, got 1.41421"),
        (message([[0, 0, 1e308, 1e308]]), {}, "a.aem:18:1: error: the quaternion must have norm 1, got inf"),
        (message([[0, 0, "one", 1]]), {}, "a.aem:18:25: error: 'one' is not a number"),
        (
            message([[0, 0, 1]]),
            {},
            "a.aem:18:1: error: a line of QUATERNION has an epoch and 4 numbers, got 3",
        ),
        (message([QUARTER], system="SCLK"), {}, "a.aem:12:15: error: TIME_SYSTEM must be one of UTC"),
        (
            message([QUARTER]).replace("2026-01-01T00:00:00 ", "2026-02-30T00:00:00 "),
            {},
            "18:1: error: '2026-02",
        ),
        (
            message([QUARTER, QUARTER]).replace("\n2026-001T00:00:01.5", "\n2026-01-01T00:00:00.0"),
            {},
            "19:1: error: times must increase, got 2026-01-01T00:00:00.0 after 2026-01-01T00:00:00 in line "
            "18; correct one of them, or remove the row",
        ),
        (
            message([QUARTER]).replace("START_TIME = 2026-01-01", "START_TIME = 2026-01-02"),
            {},
            "18:1: error: 2026-01-01T00:00:00 is before the segment's START_TIME, 2026-01-02T00:00:00",
        ),
        (
            message([QUARTER, QUARTER]).replace("001T00:00:01.5\nATT", "001T00:00:01\nATT"),
            {},
            "19:1: error: 2026-001T00:00:01.5 is after the segment's STOP_TIME, 2026-001T00:00:01 in line 14",
        ),
        (
            message([QUARTER]).replace("STOP_TIME = 2026-001T00:00:01.5", "STOP_TIME = never"),
            {},
            "14:13: error: an epoch must be YYYY-MM-DDThh:mm:ss",
        ),
        (message([QUARTER]).replace("DATA_STOP", ""), {}, "has no DATA_STOP; the file may be cut off"),
        (
            message([QUARTER]) + message([QUARTER]).partition("\n\n")[2],
            {},
            "choose one with segment=1 to segment=2",
        ),
    ],
)
def test_errors_have_their_place(text, options, expected, reads):
    with pytest.raises(ValueError) as caught:
        reads(text, **options)
    assert expected in str(caught.value)


def test_a_segment_is_chosen(reads):
    first, second = message([QUARTER]), message([[0, 0, 0, 1]])
    text = first + second[second.index("META_START") :]
    assert reads(text, segment=2).rotor[0](ph.e1).is_close(ph.e1)
    with pytest.raises(ValueError, match="segment must be from 1 to 2"):
        reads(text, segment=3)


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ({"reference_frame": "EME2000"}, "the epoch of time 0 is not known; give epoch="),
        ({"epoch": "2026-01-01T00:00:00"}, "the frame of space is not known; give reference_frame="),
        ({**FRAMES, "epoch": "yesterday"}, "an epoch must be YYYY-MM-DD"),
        ({**FRAMES, "time_system": "BST"}, "time_system must be one of UTC"),
        (
            {**FRAMES, "version": "1.0", "angular_velocity": True},
            "version 1.0 of the AEM has no QUATERNION/ANGVEL",
        ),
        ({**FRAMES, "object_name": "A\nB"}, "object_name must be one line of text"),
        ({**FRAMES, "body_frame": "EME2000"}, "must differ"),
    ],
)
def test_what_is_missing_is_asked_for_and_the_old_file_stays(options, expected, tmp_path):
    path = tmp_path / "a.aem"
    path.write_text("old")
    with pytest.raises(ValueError, match=expected):
        ph.io.write_aem(MOTION, path, **options)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_batch_is_refused(tmp_path):
    many = ph.simulate(ASYMMETRIC, ph.State(ph.Rotor.random((2,), rng=1), [0.25, -0.5, 1.0]), TIMES)
    with pytest.raises(ValueError, match="pick one of them"):
        ph.io.write_aem(many, tmp_path / "a.aem", **FRAMES)
