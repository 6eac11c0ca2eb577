"""SPICE frame and clock kernels, evaluated by SPICE at known epochs against known vectors."""

import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, START
from spice_kernels import CLOCK_ERROR, EPOCH, LEAPSECONDS

spice = pytest.importorskip("spiceypy")
Vector = ph.io.FrameVector


@pytest.fixture
def furnish(tmp_path):
    """Return a function that writes a kernel with a writer of ours and loads it."""

    def load(write, name, *arguments, **options):
        write(tmp_path / name, *arguments, **options)
        spice.furnsh(str(tmp_path / name))
        return str(tmp_path / name)

    yield load
    spice.kclear()


def two_vectors(primary, secondary, name="CURLEW_NOMINAL", number=1400001):
    return ph.io.TwoVectorFrame(name, number, "EARTH", "J2000", primary, secondary)


def test_a_frame_of_constant_vectors(furnish):
    """-Z along (0, 3, 4) and Y near e1: Y is e1 itself, perpendicular to it."""
    frame = two_vectors(Vector.fixed("-Z", [0, 3, 4], "J2000"), Vector.fixed("Y", [2, 3, 4], "J2000"))
    furnish(ph.io.write_fk, "a.tf", [frame])
    # Columns are the axes of the frame in J2000; x = y × z.
    expected = np.array([[0, 1, 0], [0.8, 0, -0.6], [-0.6, 0, -0.8]])
    np.testing.assert_allclose(spice.pxform("CURLEW_NOMINAL", "J2000", 8e8), expected, atol=1e-15)
    assert spice.namfrm("CURLEW_NOMINAL") == 1400001
    assert spice.frinfo(1400001) == (399, 5, 1400001)


@pytest.fixture
def orbit(tmp_path):
    """An SPK in which -999 moves on the line (7000, 100 t, 0) km past the Earth, in J2000."""
    path = str(tmp_path / "a.bsp")
    handle = spice.spkopn(path, "test", 0)
    start, step, n = 8.2e8, 10.0, 5
    states = [[7000, 100 * step * k, 0, 0, 100, 0] for k in range(n)]
    spice.spkw08(handle, -999, 399, "J2000", start, start + step * (n - 1), "line", 1, n, states, start, step)
    spice.spkcls(handle)
    spice.furnsh(path)
    return start


@pytest.mark.parametrize("t", [0.0, 12.5, 40.0])
def test_a_nadir_frame_of_position_and_velocity(t, orbit, furnish):
    """Z points to the Earth, X as far as it can along the velocity (0, 100, 0) km/s."""
    frame = two_vectors(Vector.position("Z", -999, "EARTH"), Vector.velocity("X", "EARTH", -999, "J2000"))
    furnish(ph.io.write_fk, "a.tf", [frame])
    position = np.array([7000, 100 * t, 0])
    z = -position / np.linalg.norm(position)
    x = np.array([-position[1], position[0], 0]) / np.linalg.norm(position)
    y = np.array([0, 0, -1])  # z × x
    # Seconds of 8.2e8 are known to 1.2e-7, in which the direction turns by 100/7000 rad/s of that.
    found = spice.pxform("CURLEW_NOMINAL", "J2000", orbit + t)
    np.testing.assert_allclose(found, np.stack([x, y, z], axis=1), atol=2e-9)


def test_a_vector_of_a_frame_that_turns(orbit, furnish):
    """A constant vector may be constant in another frame of the kernel."""
    nadir = two_vectors(Vector.position("Z", -999, 399), Vector.velocity("X", 399, -999, "J2000"))
    axes = (
        Vector.fixed("X", [0, 0, 1], "CURLEW_NOMINAL"),
        Vector.fixed("Z", [0, 0, 1], "J2000"),
    )
    furnish(ph.io.write_fk, "a.tf", [nadir, two_vectors(*axes, "CURLEW_TURNED", 1400002)])
    found = spice.pxform("CURLEW_TURNED", "J2000", orbit)
    np.testing.assert_allclose(found, [[-1, 0, 0], [0, -1, 0], [0, 0, 1]], atol=2e-9)


def test_the_clock_counts_seconds_of_tt(furnish, tmp_path):
    (tmp_path / "a.tls").write_text(LEAPSECONDS)
    spice.furnsh(str(tmp_path / "a.tls"))
    # The leap second of 2017 lies between: 1 d + 1 s. TAI is 36 s, GPS 17 s ahead of UTC before it.
    before = {"UTC": "2016-12-31T12:00:00", "TAI": "2016-12-31T12:00:36", "GPS": "2016-12-31T12:00:17"}
    before["TT"] = "2016-12-31T12:01:08.184"
    for number, (system, epoch) in enumerate(before.items(), 901):
        furnish(ph.io.write_sclk, f"{number}.tsc", clock=-number, epoch=epoch, time_system=system)
        for utc, seconds in (("2016-12-31T12:00:01", 1), ("2017-01-01T12:00:00", 86401)):
            # UTC, TDB and TT differ by up to 2 ms, which SPICE knows to rounding.
            ticks = spice.sce2c(-number, spice.str2et(utc))
            assert ticks == pytest.approx(65536 * seconds, abs=65536 * CLOCK_ERROR)
        assert spice.sct2e(-number, 0) == pytest.approx(spice.str2et(before["UTC"]), abs=CLOCK_ERROR)
        assert spice.scdecd(-number, 65536 * 5 + 7) == "1/0000000005:00007"


def test_a_ck_with_frames_and_clock_of_ours(furnish, tmp_path):
    """The body turns about its nominal frame as in a file of NAIF's."""
    (tmp_path / "a.tls").write_text(LEAPSECONDS)
    body = ph.io.CkFrame("CURLEW_BODY", -999000, clock=-999, center=-999)
    ph.io.write_fk(tmp_path / "a.tf", [body])
    ph.io.write_sclk(tmp_path / "a.tsc", clock=-999, epoch="2025-12-31T23:59:00")
    kernels = [str(tmp_path / name) for name in ("a.tls", "a.tsc", "a.tf")]
    times = np.linspace(0, 10, 41)
    motion = ph.simulate(ASYMMETRIC, START, times)
    names = {"epoch": EPOCH, "body_frame": "CURLEW_BODY", "reference_frame": "J2000"}
    ph.io.write_ck(motion, tmp_path / "a.bc", kernels=kernels, **names)
    for kernel in (*kernels, str(tmp_path / "a.bc")):
        spice.furnsh(kernel)
    et = spice.str2et(EPOCH)
    for k in (0, 40):
        found = spice.pxform("CURLEW_BODY", "J2000", et + times[k])
        # The clock error turns the body by less than 1.5 rad/s of it.
        np.testing.assert_allclose(found, motion.rotor[k].to_matrix(), atol=1.5 * CLOCK_ERROR)
    spice.kclear()
    again = ph.io.read_ck(tmp_path / "a.bc", kernels=kernels)
    assert again.attributes["body_frame"] == "CURLEW_BODY"


E1 = Vector.fixed("X", [1, 0, 0], "J2000")
E2 = Vector.fixed("Y", [0, 1, 0], "J2000")


@pytest.mark.parametrize(
    ("make", "expected"),
    [
        (
            lambda p: Vector.fixed("W", [1, 0, 0], "J2000"),
            "axis must be one of X, -X, Y, -Y, Z, -Z, got 'W'",
        ),
        (
            lambda p: Vector.fixed("X", [0, 0, 0], "J2000"),
            "a constant vector must have a direction",
        ),
        (lambda p: Vector.fixed("X", [0, 1], "J2000"), "the vector"),
        (
            lambda p: Vector.position("X", "EARTH", "SUN", aberration="S"),
            "aberration must be one of NONE, LT",
        ),
        (
            lambda p: Vector.position("X", "Ünder", "SUN"),
            "a name of SPICE must be 1 to 36 characters of ASCII",
        ),
        (
            lambda p: two_vectors(E1, Vector.fixed("-X", [0, 1, 0], "J2000")),
            "must differ, got X and -X",
        ),
        (lambda p: two_vectors(E1, E2, "curlew"), "the name of a frame must be 1 to 26 of A-Z"),
        (lambda p: two_vectors(E1, E2, "A" * 27), "the name of a frame must be 1 to 26 of A-Z"),
        (lambda p: two_vectors(E1, E2, number=0), "the number of frame 'CURLEW_NOMINAL' must not be 0"),
        (lambda p: two_vectors(E1, E2, number=1.5), "must be an integer of 32 bits, got 1.5"),
        (lambda p: ph.io.CkFrame("A", -9000, 9, -9), "the number of a clock must be negative, got 9"),
        (lambda p: ph.io.write_fk(p, []), "a frame kernel needs one frame or more"),
        (lambda p: ph.io.write_fk(p, [two_vectors(E1, E2)] * 2), "two frames have the name 'CURLEW_NOMINAL'"),
        (
            lambda p: ph.io.write_fk(p, [two_vectors(E1, E2, "A"), two_vectors(E1, E2, "B")]),
            "two frames have the number 1400001",
        ),
        (lambda p: ph.io.write_sclk(p, clock=-9, epoch="today"), "an epoch must be"),
        (lambda p: ph.io.write_sclk(p, clock=9, epoch=EPOCH), "the number of a clock must be negative"),
        (
            lambda p: ph.io.write_sclk(p, clock=-9, epoch=EPOCH, time_system="TDB"),
            "time_system of a clock must be one of UTC, TT, TAI, GPS, got 'TDB'",
        ),
    ],
)
def test_errors(make, expected, tmp_path):
    with pytest.raises(ValueError) as error:
        make(tmp_path / "a.tf")
    assert expected in str(error.value)
    assert not list(tmp_path.iterdir())
