"""SPICE CK files of type 3, verified with SPICE itself."""

import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, START
from polhode._cli.main import main
from spice_kernels import CLOCK_ERROR, EPOCH, LEAPSECONDS

spice = pytest.importorskip("spiceypy")

# Ticks of 1/65536 s since 2025-12-31T23:00 or so.
CLOCK = r"""KPL/SCLK
\begindata
SCLK_KERNEL_ID            = ( @2026-01-01 )
SCLK_DATA_TYPE_999        = ( 1 )
SCLK01_TIME_SYSTEM_999    = ( 1 )
SCLK01_N_FIELDS_999       = ( 2 )
SCLK01_MODULI_999         = ( 4294967296 65536 )
SCLK01_OFFSETS_999        = ( 0 0 )
SCLK01_OUTPUT_DELIM_999   = ( 2 )
SCLK_PARTITION_START_999  = ( 0.0 )
SCLK_PARTITION_END_999    = ( 2.8147497671065D+14 )
SCLK01_COEFFICIENTS_999   = ( 0.0  8.204E8  1.0 )
\begintext
"""
FRAMES = r"""KPL/FK
\begindata
FRAME_CURLEW_BODY        = -999000
FRAME_-999000_NAME       = 'CURLEW_BODY'
FRAME_-999000_CLASS      = 3
FRAME_-999000_CLASS_ID   = -999000
FRAME_-999000_CENTER     = -999
CK_-999000_SCLK          = -999
CK_-999000_SPK           = -999
\begintext
"""
NAMES = {"epoch": EPOCH, "body_frame": "CURLEW_BODY", "reference_frame": "J2000"}
TIMES = np.linspace(0, 10, 41)
MOTION = ph.simulate(ASYMMETRIC, START, TIMES)


@pytest.fixture
def kernels(tmp_path):
    paths = []
    for name, text in {"a.tls": LEAPSECONDS, "a.tsc": CLOCK, "a.tf": FRAMES}.items():
        (tmp_path / name).write_text(text)
        paths.append(str(tmp_path / name))
    yield paths
    assert spice.ktotal("ALL") == 0
    spice.kclear()


def test_spice_finds_the_attitudes(kernels, tmp_path):
    """ckgpav returns the matrix from J2000 to the body and the angular velocity in J2000."""
    path = str(tmp_path / "a.bc")
    ph.io.write_ck(MOTION, path, kernels=kernels, **NAMES)
    start = MOTION.rotor[0]
    for kernel in (*kernels, path):
        spice.furnsh(kernel)
    try:
        et = spice.str2et(EPOCH)
        # The clock error turns the body by less than 1.5 rad/s of it.
        for k in (0, 7, 40):
            ticks = spice.sce2c(-999, et + TIMES[k])
            matrix, rates, _ = spice.ckgpav(-999000, ticks, 0, "J2000")
            np.testing.assert_allclose(matrix, (~MOTION.rotor[k]).to_matrix(), atol=1.5 * CLOCK_ERROR)
            np.testing.assert_allclose(rates, MOTION.omega_space[k].components, atol=3 * CLOCK_ERROR)
        to_space = spice.pxform("CURLEW_BODY", "J2000", et)
        np.testing.assert_allclose(to_space @ [1, 0, 0], start(ph.e1).components, atol=1.5 * CLOCK_ERROR)
    finally:
        spice.kclear()


def test_a_known_turn(kernels, tmp_path):
    """A body that turns about z by +0.1 rad/s: its x axis has longitude 0.1 t, between records, too."""
    rotor = ph.Rotor.from_axis_angle(ph.e3, 0.1 * TIMES)
    omega = ph.bivector(np.tile([0, 0, 0.1], (len(TIMES), 1)))
    history = ph.io.AttitudeHistory(TIMES, rotor, omega)
    path = str(tmp_path / "a.bc")
    ph.io.write_ck(history, path, kernels=kernels, **NAMES)
    for kernel in (*kernels, path):
        spice.furnsh(kernel)
    try:
        et = spice.str2et(EPOCH)
        for t in (0.0, 1.0, 4.321):
            axis = spice.pxform("CURLEW_BODY", "J2000", et + t) @ [1, 0, 0]
            np.testing.assert_allclose(axis, [np.cos(0.1 * t), np.sin(0.1 * t), 0], atol=0.1 * CLOCK_ERROR)
    finally:
        spice.kclear()


def write_by_spice(path, kernels, times, begins):
    """Write a quarter turn about z of the frame by spiceypy alone, in intervals that begin at these times."""
    for kernel in kernels:
        spice.furnsh(kernel)
    # Rows of the C-matrix are the axes of the body in J2000: x of the body is y of J2000.
    quaternion = spice.m2q(np.array([[0, 1.0, 0], [-1, 0, 0], [0, 0, 1]]))
    ticks, starts = ([spice.sce2c(-999, spice.str2et(EPOCH) + t) for t in given] for given in (times, begins))
    n, rates = len(times), [[0, 0.5, 0]] * len(times)
    handle = spice.ckopn(path, "test", 0)
    span = ticks[0], ticks[-1]
    attitudes = n, ticks, [quaternion] * n, rates
    spice.ckw03(handle, *span, -999000, "J2000", True, "x", *attitudes, len(starts), starts)
    spice.ckcls(handle)
    spice.kclear()


def test_what_spice_writes_is_read(kernels, tmp_path):
    path = str(tmp_path / "a.bc")
    write_by_spice(path, kernels, [0, 1], [0])
    history = ph.io.read_ck(path, kernels=kernels, epoch=EPOCH)
    np.testing.assert_allclose(history.time, [0, 1], atol=CLOCK_ERROR)
    assert history.rotor[0](ph.e1).is_close(ph.e2, atol=1e-15)
    # y of J2000 is x of the body.
    np.testing.assert_allclose(history.omega_body.components, [[0.5, 0, 0]] * 2, atol=1e-15)
    assert history.attributes["body_frame"] == "CURLEW_BODY"


def test_gaps_between_intervals_are_reported(kernels, tmp_path):
    path = str(tmp_path / "a.bc")
    write_by_spice(path, kernels, [0, 1, 60, 61], [0, 60])
    with pytest.warns(UserWarning, match=r"a\.bc: the segment has 2 interpolation intervals") as caught:
        history = ph.io.read_ck(path, kernels=kernels, epoch=EPOCH)
    np.testing.assert_allclose(history.time, [0, 1, 60, 61], atol=CLOCK_ERROR)
    assert caught[0].filename == __file__


def test_what_is_written_is_read(kernels, tmp_path):
    ph.io.write_ck(MOTION, tmp_path / "a.bc", kernels=kernels, **NAMES)
    history = ph.io.read_ck(tmp_path / "a.bc", kernels=kernels)
    # The epoch of the first record is known to 1e-9 s, in TDB: 69.184 s after UTC, but for 2 ms.
    assert history.attributes["epoch"].startswith("2026-01-01T00:01:09.18")
    assert history.attributes["time_system"] == "TDB"
    np.testing.assert_allclose(history.time, TIMES, atol=CLOCK_ERROR)
    # A quaternion of SPICE is normalized, and angular velocities are turned to space and back.
    assert history.rotor.is_close(MOTION.rotor, atol=1e-15).all()
    np.testing.assert_allclose(history.omega_body.components, MOTION.omega_body.components, atol=3e-15)
    without = ph.io.AttitudeHistory(TIMES, MOTION.rotor)
    ph.io.write_ck(without, tmp_path / "b.bc", kernels=kernels, **NAMES)
    assert ph.io.read_ck(tmp_path / "b.bc", kernels=kernels).omega_body is None


def test_the_command(kernels, tmp_path, capsys):
    given = [x for path in kernels for x in ("--kernel", path)]
    MOTION.save(tmp_path / "a.nc")
    a, b, c = (str(tmp_path / name) for name in ("a.nc", "b.bc", "c.csv"))
    names = ["--epoch", EPOCH, "--body-frame", "CURLEW_BODY", "--reference-frame", "J2000"]
    with pytest.raises(SystemExit, match="2"):
        main(["convert", a, b, *names])
    assert "clock and frame kernels of its spacecraft; give --kernel FILE for each" in capsys.readouterr().err
    assert main(["convert", a, b, "--kernel", "none.tls", *names]) == 3
    assert capsys.readouterr().err == "none.tls: error: no such kernel\n"
    assert main(["convert", a, b, *given, *names]) == 0
    assert main(["convert", a, b, *given, *names]) == 0  # a file of ours is replaced
    assert main(["convert", b, c, *given, "--epoch", EPOCH]) == 0
    np.testing.assert_allclose(ph.io.read(c).time, TIMES, atol=CLOCK_ERROR)


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ({"epoch": None}, "epoch is not known; give epoch="),
        ({"body_frame": None}, "body_frame is not known; give body_frame="),
        ({"body_frame": "NOBODY"}, "the kernels have no frame 'NOBODY'"),
        ({"body_frame": "IAU_EARTH"}, "must be a frame of class 3 for a CK, got 'IAU_EARTH' of class 2"),
        ({"reference_frame": "EME2000"}, "SPICE calls it 'J2000': give reference_frame='J2000'"),
        ({"reference_frame": "NOWHERE"}, "no frame 'NOWHERE'; .* or another reference_frame="),
        (
            {"epoch": "2025-01-01T00:00:00"},
            "clock -999 of the kernels does not cover 2025-01-01T00:00:00 to 2025-01-01T00:00:10 UTC",
        ),
        ({"epoch": "yesterday"}, "an epoch must be"),
        ({"time_system": "GPS"}, "time_system of a CK must be UTC, TT or TDB"),
    ],
)
def test_what_is_missing_is_asked_for(options, expected, kernels, tmp_path):
    with pytest.raises(ValueError, match=expected):
        ph.io.write_ck(MOTION, tmp_path / "a.bc", kernels=kernels, **{**NAMES, **options})
    assert not (tmp_path / "a.bc").exists()


def test_kernels_that_do_not_fit(kernels, tmp_path):
    ph.io.write_ck(MOTION, tmp_path / "a.bc", kernels=kernels, **NAMES)
    with pytest.raises(ph.io.FileError, match=r"a.bc: error: SPICE: .*kernels must have leapseconds.*, got "):
        ph.io.read_ck(tmp_path / "a.bc", kernels=kernels[2:])
    (tmp_path / "damaged.tls").write_text("KPL/LSK\n\\begindata\nDELTET/K = ( x )\n")
    with pytest.raises(ph.io.FileError, match=r"damaged.tls: error: SPICE: .*on line 3"):
        ph.io.read_ck(tmp_path / "a.bc", kernels=[str(tmp_path / "damaged.tls"), *kernels[1:]])
    with pytest.raises(ValueError, match="no frame of class 3 for instrument -999000"):
        ph.io.read_ck(tmp_path / "a.bc", kernels=kernels[:2])
    with pytest.raises(FileNotFoundError, match="no such kernel"):
        ph.io.read_ck(tmp_path / "a.bc", kernels=["none.tls"])
    with pytest.raises(TypeError, match="kernels must be a list"):
        ph.io.read_ck(tmp_path / "a.bc", kernels=kernels[0])
    with pytest.raises(ValueError, match="not a binary SPICE CK"):
        ph.io.read_ck(kernels[0], kernels=kernels)
    with pytest.raises(ValueError, match="segment must be from 1 to 1, got 2"):
        ph.io.read_ck(tmp_path / "a.bc", kernels=kernels, segment=2)


# The segment begins at the third record. For each time it has seven numbers and the ticks; then follow
# the start and the number of intervals, and the number of times.
SEGMENT = 3 * 1024
COUNT = SEGMENT + 8 * (8 * len(TIMES) + 2)


@pytest.mark.parametrize(
    ("at", "number", "expected"),
    [
        # The numbers of doubles and integers that describe a segment: SPICE writes as many to memory.
        (8, np.int32(100), "the records that list the segments are not those of a CK"),
        (12, np.int32(60), "the records that list the segments are not those of a CK"),
        # The first of these records, the next one, and its number of segments.
        (76, np.int32(5000), "the records that list the segments are not those of a CK"),
        (1024, 2.0, "the records that list the segments are not those of a CK"),
        (1024 + 16, 1e5, "the records that list the segments are not those of a CK"),
        (COUNT, 1e9, "the segment has 1000000000 records"),
        (COUNT, 0.0, "the segment has 0 records"),
        (SEGMENT, 1e300, "numbers that are not those of attitudes"),
        (SEGMENT, np.zeros(4), "the segment is damaged: .* not a rotor"),
    ],
)
def test_damaged_files(at, number, expected, kernels, tmp_path):
    path = tmp_path / "a.bc"
    ph.io.write_ck(MOTION, path, kernels=kernels, **NAMES)
    content, damage = path.read_bytes(), np.asarray(number).tobytes()
    path.write_bytes(content[:at] + damage + content[at + len(damage) :])
    with pytest.raises(ph.io.FileError, match=rf"a\.bc: error: .*{expected}"):
        ph.io.read_ck(path, kernels=kernels)
