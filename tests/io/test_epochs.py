"""Epochs: calendars, leap seconds, and seconds between them."""

import datetime

import numpy as np
import pytest

from polhode._io.epochs import elapsed, later, parse_epoch


@pytest.mark.parametrize(
    "seconds", [0.0, 0.1, 0.30000000000000004, 1e-9, 86399.999999999, -0.25, 1e9 / 3, 12345.678]
)
@pytest.mark.parametrize("system", ["UTC", "TAI"])
@pytest.mark.parametrize("start", ["1999-12-31T23:59:59.123456789", "2016-12-31T12:00:00"])
def test_seconds_come_back_to_the_same_bits(seconds, system, start):
    """Also through text; 18 decimals hold every float of these sizes but the smallest."""
    epoch = parse_epoch(start, system)
    assert elapsed(epoch, parse_epoch(str(later(epoch, seconds, system)), system), system) == seconds


def test_uniform_seconds_are_those_of_datetime():
    start, end = "1987-03-04T05:06:07", "2031-12-30T23:59:58"
    expected = (datetime.datetime.fromisoformat(end) - datetime.datetime.fromisoformat(start)).total_seconds()
    assert elapsed(parse_epoch(start, "TT"), parse_epoch(end, "TT"), "TT") == expected


@pytest.mark.parametrize(
    ("start", "end", "leaps"),
    [("1972-01-01", "2017-01-01", 27), ("2005-12-31", "2006-01-01", 1), ("2000-01-01", "2005-01-01", 0)],
)
def test_leap_seconds_are_counted_in_utc(start, end, leaps):
    """TAI - UTC was 10 s in 1972 and is 37 s from 2017 on (IERS Bulletin C)."""
    both = [f"{start}T00:00:00", f"{end}T00:00:00"]
    utc, tai = (elapsed(*(parse_epoch(x, system) for x in both), system) for system in ("UTC", "TAI"))
    assert utc - tai == leaps


def test_a_leap_second_is_written_as_60():
    before = parse_epoch("2016-12-31T23:59:59", "UTC")
    written = [str(later(before, t, "UTC")) for t in (0.5, 1, 1.5, 2)]
    assert written == [
        "2016-12-31T23:59:59.5",
        "2016-12-31T23:59:60",
        "2016-12-31T23:59:60.5",
        "2017-01-01T00:00:00",
    ]
    assert elapsed(before, parse_epoch("2016-12-31T23:59:60.5", "UTC"), "UTC") == 1.5


DAY = datetime.datetime(2026, 1, 2)


@pytest.mark.parametrize(
    "given",
    [
        DAY,
        DAY.date(),
        DAY.replace(tzinfo=datetime.UTC),
        DAY.replace(hour=5, tzinfo=datetime.timezone(datetime.timedelta(hours=5))),
        np.datetime64("2026-01-02"),
        np.datetime64("2026-01-02T00:00"),
        np.datetime64("2026-01-02T00:00:00.000000000"),
        np.array("2026-01-02", dtype="datetime64[D]"),
    ],
    ids=str,
)
def test_datetimes_are_epochs(given):
    assert parse_epoch(given, "UTC") == parse_epoch("2026-01-02T00:00:00", "UTC")


def test_a_time_zone_belongs_to_utc():
    with pytest.raises(ValueError, match="has a time zone, which belongs to UTC, not to TT"):
        parse_epoch(DAY.replace(tzinfo=datetime.UTC), "TT")
    with pytest.raises(ValueError, match=r"the epoch 0001-01-01T00:00:00.05:00 is outside of the calendar"):
        parse_epoch(datetime.datetime(1, 1, 1, tzinfo=datetime.timezone(datetime.timedelta(hours=5))), "UTC")
    with pytest.raises(ValueError, match="an epoch must be YYYY-MM-DD"):
        parse_epoch(np.datetime64("NaT"), "UTC")
    with pytest.raises(TypeError, match=r"a string such as .* or a datetime, got int"):
        parse_epoch(2026, "UTC")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("2026-1-1T00:00:00", "must be YYYY-MM-DDThh:mm:ss"),
        ("2026-02-29T00:00:00", "is not a date"),
        ("2025-366T00:00:00", "is not a date"),
        ("2025-000T00:00:00", "is not a date"),
        ("2026-01-01T24:00:00", "is not a time of that day"),
        ("2026-01-01T23:59:60", "is not a time of that day in UTC"),
        ("1971-12-31T00:00:00", "UTC before 1972"),
    ],
)
def test_epochs_that_do_not_exist(text, expected):
    with pytest.raises(ValueError, match=expected):
        parse_epoch(text, "UTC")
