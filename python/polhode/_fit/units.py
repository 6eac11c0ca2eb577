"""Units of measured times and rates, whose sizes are those of the core."""

from __future__ import annotations

from polhode._native import Line

PERIODS = ("s", "min", "h", "d", "day")
# For errors.
PERIODS_IN_WORDS = f"{', '.join(PERIODS[:-1])} or {PERIODS[-1]}"
TIMES = ("ns", "us", "ms", *PERIODS)
RATES = ("rad/s", "mrad/s", "deg/s", "deg/h", "deg/day", "arcsec/s", "rev/s", "rpm")


def si(unit: str) -> float:
    """Return the size of a unit in SI units."""
    return float(Line(f"x = 1 {unit}", 0, True, set()).text.strip(" ()"))
