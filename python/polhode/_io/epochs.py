"""Calendar epochs, and seconds between them in UTC and in uniform time systems."""

from __future__ import annotations

import datetime
import re
from bisect import bisect_right
from dataclasses import dataclass
from decimal import Decimal, localcontext
from typing import Any, TypeAlias

import numpy as np

# Days that begin after a leap second, 1 July and 1 January of these years (IERS Bulletin C).
_JULY = (1972, 1981, 1982, 1983, 1985, 1992, 1993, 1994, 1997, 2012, 2015)
_JANUARY = (*range(1973, 1981), 1988, 1990, 1991, 1996, 1999, 2006, 2009, 2017)
_LEAPS = sorted(
    datetime.date(year, month, 1).toordinal()
    for month, years in ((7, _JULY), (1, _JANUARY))
    for year in years
)
_FIRST_UTC = datetime.date(1972, 1, 1).toordinal()
# Time systems whose seconds are counted without leap seconds.
_UNIFORM = ("GPS", "TAI", "TCB", "TCG", "TDB", "TT")
TIME_SYSTEMS = ("UTC", *_UNIFORM)
_PATTERN = re.compile(
    r"(\d{4})-(?:(\d{2})-(\d{2})|(\d{3}))T(\d{2}):(\d{2}):(\d{2}(?:\.\d*)?)Z?", flags=re.ASCII
)
# Seconds have at most this many decimals.
_DECIMALS = Decimal(1).scaleb(-18)


# How users write an epoch.
GivenEpoch: TypeAlias = str | datetime.date | np.datetime64


@dataclass(frozen=True, order=True)
class Epoch:
    """A day, as a proleptic ordinal, and the seconds since it began."""

    day: int
    seconds: Decimal

    def __str__(self) -> str:
        whole = int(self.seconds)
        minutes = min(whole // 60, 1439)  # a leap second is 23:59:60
        fraction = f"{self.seconds - 60 * minutes:f}"
        fraction = fraction.rstrip("0").rstrip(".") if "." in fraction else fraction
        first, point, rest = fraction.partition(".")
        date = datetime.date.fromordinal(self.day).isoformat()
        return f"{date}T{minutes // 60:02d}:{minutes % 60:02d}:{first.zfill(2)}{point}{rest}"


def parse_epoch(given: GivenEpoch, system: str) -> Epoch:
    """Return the epoch of ``YYYY-MM-DDThh:mm:ss.d`` or ``YYYY-DDDThh:mm:ss.d``, or of a date or datetime.

    One without a time zone is a time of the system, not a local one.

    Raises
    ------
    ValueError
        For another format, a day or time that does not exist in the time system, and UTC before 1972.
    """
    text = _text_of(given, system)
    found = _PATTERN.fullmatch(text)
    if found is None:
        raise ValueError(f"an epoch must be YYYY-MM-DDThh:mm:ss or YYYY-DDDThh:mm:ss, got {text!r}")
    year, month, number, in_year, hour, minute, seconds = found.groups()
    try:
        if in_year is None:
            day = datetime.date(int(year), int(month), int(number)).toordinal()
        else:
            day = datetime.date(int(year), 1, 1).toordinal() + int(in_year) - 1
            if int(in_year) < 1 or datetime.date.fromordinal(day).year != int(year):
                raise ValueError(f"day {in_year} is out of range")
    except (ValueError, OverflowError) as error:
        raise ValueError(f"{text!r} is not a date: {error}") from None
    if system == "UTC" and day < _FIRST_UTC:
        raise ValueError(f"UTC before 1972 had no leap seconds and is not supported, got {text!r}")
    second, minutes = Decimal(seconds), 60 * int(hour) + int(minute)
    leap = system == "UTC" and minutes == 1439 and day + 1 in _LEAPS
    if int(hour) > 23 or int(minute) > 59 or second >= 60 + leap:
        raise ValueError(f"{text!r} is not a time of that day in {system}")
    return Epoch(day, 60 * minutes + second)


def _text_of(given: Any, system: str) -> str:
    if isinstance(given, np.ndarray) and given.ndim == 0:
        given = given[()]
    if isinstance(given, str):
        return given
    if isinstance(given, np.datetime64):
        is_coarse = np.datetime_data(given.dtype)[0] in ("Y", "M", "W", "D", "h", "m")
        return str(given.astype("datetime64[s]") if is_coarse else given)
    if not isinstance(given, datetime.date):
        raise TypeError(
            "an epoch must be a string such as '2026-01-01T00:00:00' or a datetime, "
            f"got {type(given).__name__}"
        )
    if not isinstance(given, datetime.datetime):
        return f"{given.isoformat()}T00:00:00"
    if given.tzinfo is None:
        return given.isoformat()
    if system != "UTC":
        raise ValueError(
            f"the epoch {given.isoformat()} has a time zone, which belongs to UTC, not to {system}; "
            f"give the time in {system}, without a zone"
        )
    try:
        return given.astimezone(datetime.UTC).replace(tzinfo=None).isoformat()
    except OverflowError:
        raise ValueError(f"the epoch {given.isoformat()} is outside of the calendar of UTC") from None


def elapsed(start: Epoch, end: Epoch, system: str) -> float:
    """Return the SI seconds from one epoch to another, exact before rounding to a float."""
    with localcontext(prec=60):
        return float(_count(end, system) - _count(start, system))


def later(start: Epoch, seconds: float, system: str) -> Epoch:
    """Return the epoch some SI seconds after another, to 18 decimals; `elapsed` inverts it."""
    last = datetime.date.max.toordinal()
    if not 1 <= start.day + seconds / 86400 < last:
        raise ValueError(f"{seconds:g} s after {start} is outside of the calendar, years 1 to 9999")
    with localcontext(prec=60):
        count = (_count(start, system) + Decimal(repr(seconds))).quantize(_DECIMALS)
        day = int(count // 86400)
        while _begin(day, system) > count:
            day -= 1
        while _begin(day + 1, system) <= count:
            day += 1
        return Epoch(day, (count - _begin(day, system)).normalize())


def _count(epoch: Epoch, system: str) -> Decimal:
    return _begin(epoch.day, system) + epoch.seconds


def _begin(day: int, system: str) -> Decimal:
    """Return the seconds counted until a day begins."""
    return Decimal(86400 * day + (bisect_right(_LEAPS, day) if system == "UTC" else 0))
