"""SPICE text kernels: frames (FK), given by two vectors or by a CK, and spacecraft clocks (SCLK).

They are written without SPICE. Frames and their numbers are arguments; none has a default.
"""

from __future__ import annotations

import datetime
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from polhode import _native
from polhode._io.epochs import elapsed, parse_epoch
from polhode._support.arrays import as_components
from polhode._support.calls import explains_calls
from polhode._support.files import write_atomically

_AXES = ("X", "-X", "Y", "-Y", "Z", "-Z")
_ABERRATIONS = (
    "NONE",
    *(f"{way}{light}{star}" for way in ("", "X") for light in ("LT", "CN") for star in ("", "+S")),
)
# J2000, 2000-01-01T12:00:00 TT, in the time systems whose distance from TT is a constant or known in UTC.
_J2000 = {
    "UTC": "2000-01-01T11:58:55.816",
    "TT": "2000-01-01T12:00:00",
    "TAI": "2000-01-01T11:59:27.816",
    "GPS": "2000-01-01T11:59:08.816",
}
# A clock of ours counts ticks of 1/65536 s, and 2^32 s in all.
_TICKS, _SECONDS = 65536, 4294967296


@dataclass(frozen=True)
class FrameVector:
    """A direction of space along an axis of a `TwoVectorFrame`; see `position`, `velocity` and `fixed`.

    Attributes
    ----------
    axis
        ``"X"``, ``"-X"``, ``"Y"``, ``"-Y"``, ``"Z"`` or ``"-Z"``.
    entries
        What the kernel says of the direction, by the ends of its keywords.

    Examples
    --------
    >>> to_earth = ph.io.FrameVector.position("Z", -999, "EARTH")
    >>> to_earth.axis, to_earth.entries[0]
    ('Z', ('VECTOR_DEF', "'OBSERVER_TARGET_POSITION'"))
    """

    axis: str
    entries: tuple[tuple[str, str], ...]

    def __post_init__(self) -> None:
        if self.axis not in _AXES:
            raise ValueError(f"axis must be one of {', '.join(_AXES)}, got {self.axis!r}")

    @staticmethod
    def position(
        axis: str, observer: str | int, target: str | int, *, aberration: str = "NONE"
    ) -> FrameVector:
        """Return the direction from an observer to a target, names or numbers of SPICE.

        `aberration` is the correction, as in SPICE: ``"NONE"``, ``"LT"``, ``"CN+S"`` and so on.

        Examples
        --------
        >>> ph.io.FrameVector.position("Z", -999, "EARTH").axis
        'Z'
        """
        return FrameVector(axis, _seen("POSITION", observer, target, aberration))

    @staticmethod
    def velocity(
        axis: str, observer: str | int, target: str | int, frame: str, *, aberration: str = "NONE"
    ) -> FrameVector:
        """Return the direction of the velocity of a target relative to an observer, in a frame of SPICE.

        Examples
        --------
        >>> ph.io.FrameVector.velocity("X", "EARTH", -999, "J2000").axis
        'X'
        """
        seen = _seen("VELOCITY", observer, target, aberration)
        return FrameVector(axis, (*seen, ("FRAME", _quoted(frame))))

    @staticmethod
    def fixed(axis: str, vector: object, frame: str) -> FrameVector:
        """Return the direction of a vector (3,) that is constant in a frame of SPICE, such as ``"J2000"``.

        Examples
        --------
        >>> ph.io.FrameVector.fixed("-Y", [0, 0, 1], "J2000").axis
        '-Y'
        """
        numbers = as_components(vector, 3, "the vector")
        if not numbers.any():
            raise ValueError("a constant vector must have a direction, got 0, 0, 0")
        spec = f"( {', '.join(repr(float(x)) for x in numbers)} )"
        return FrameVector(
            axis,
            (
                ("VECTOR_DEF", "'CONSTANT'"),
                ("FRAME", _quoted(frame)),
                ("SPEC", "'RECTANGULAR'"),
                ("VECTOR", spec),
            ),
        )


def _seen(what: str, observer: str | int, target: str | int, aberration: str) -> tuple[tuple[str, str], ...]:
    if aberration not in _ABERRATIONS:
        raise ValueError(f"aberration must be one of {', '.join(_ABERRATIONS)}, got {aberration!r}")
    return (
        ("VECTOR_DEF", f"'OBSERVER_TARGET_{what}'"),
        ("OBSERVER", _quoted(observer)),
        ("TARGET", _quoted(target)),
        ("ABCORR", _quoted(aberration)),
    )


@dataclass(frozen=True)
class TwoVectorFrame:
    """A frame of SPICE that follows two directions, such as the nominal attitude of a spacecraft.

    The axis of `primary` lies along its direction. That of `secondary` lies as close to its own as it can:
    perpendicular to the first axis, in the plane of both directions.

    Attributes
    ----------
    name, number
        Name of up to 26 characters, and a number that no other frame has; NAIF keeps 1400000 to 2000000 for
        such frames of users.
    center
        Name or number of the body at its origin, which counts for light time.
    relative_to
        The frame of space in which SPICE evaluates it, such as ``"J2000"``.
    primary, secondary
        The directions, along different axes.

    Examples
    --------
    Z points from the satellite to the Earth, X along its velocity as far as it can:

    >>> nominal = ph.io.TwoVectorFrame(
    ...     "CURLEW_NOMINAL",
    ...     number=1400999,
    ...     center=-999,
    ...     relative_to="J2000",
    ...     primary=ph.io.FrameVector.position("Z", -999, "EARTH"),
    ...     secondary=ph.io.FrameVector.velocity("X", "EARTH", -999, frame="J2000"),
    ... )
    >>> ph.io.write_fk("curlew.tf", [nominal])
    >>> nominal.primary.axis, nominal.secondary.axis
    ('Z', 'X')
    """

    name: str
    number: int
    center: str | int
    relative_to: str
    primary: FrameVector
    secondary: FrameVector

    def __post_init__(self) -> None:
        _check(self.name, self.number)
        if self.primary.axis[-1] == self.secondary.axis[-1]:
            raise ValueError(
                f"the axes of frame {self.name!r} must differ, got {self.primary.axis} and "
                f"{self.secondary.axis}"
            )

    def _entries(self) -> list[tuple[str, str]]:
        start = f"FRAME_{self.number}_"
        entries = [
            ("CLASS", "5"),
            ("CLASS_ID", str(self.number)),
            ("CENTER", _quoted(self.center)),
            ("RELATIVE", _quoted(self.relative_to)),
            ("DEF_STYLE", "'PARAMETERIZED'"),
            ("FAMILY", "'TWO-VECTOR'"),
        ]
        for order, given in (("PRI", self.primary), ("SEC", self.secondary)):
            entries.append((f"{order}_AXIS", _quoted(given.axis)))
            entries += [(f"{order}_{key}", value) for key, value in given.entries]
        return [(start + key, value) for key, value in entries]


@dataclass(frozen=True)
class CkFrame:
    """The frame of a body whose attitude is in a CK, which `write_ck` needs.

    Attributes
    ----------
    name, number
        Name of up to 26 characters, and the negative number of frame and instrument; by custom that of the
        spacecraft times 1000, less a small number.
    clock
        Number of the spacecraft clock, negative, as of `write_sclk`.
    center
        Number of the spacecraft.

    Examples
    --------
    >>> own = ph.io.CkFrame("CURLEW_BODY", number=-999000, clock=-999, center=-999)
    >>> ph.io.write_fk("curlew.tf", [own])
    >>> own.number // own.center  # by custom
    1000
    """

    name: str
    number: int
    clock: int
    center: int

    def __post_init__(self) -> None:
        _check(self.name, self.number)
        _check_clock(self.clock)
        _check_number("the number of the center", self.center)

    def _entries(self) -> list[tuple[str, str]]:
        start = f"FRAME_{self.number}_"
        entries = [("CLASS", "3"), ("CLASS_ID", str(self.number)), ("CENTER", str(self.center))]
        of_ck = [("SCLK", str(self.clock)), ("SPK", str(self.center))]
        return [
            *((start + key, value) for key, value in entries),
            *((f"CK_{self.number}_{key}", value) for key, value in of_ck),
        ]


@explains_calls
def write_fk(path: str | os.PathLike[str], frames: Sequence[TwoVectorFrame | CkFrame]) -> None:
    """Write a SPICE frame kernel, atomically.

    Raises
    ------
    ValueError
        If there is no frame, or a name or a number occurs twice.
    OSError
        If the file cannot be written; an older file stays.

    Examples
    --------
    >>> own = ph.io.CkFrame("CURLEW_BODY", number=-999000, clock=-999, center=-999)
    >>> ph.io.write_fk("curlew.tf", [own])
    >>> with open("curlew.tf") as file:
    ...     print(*(line.strip() for line in file if "CLASS" in line), sep="; ")
    FRAME_-999000_CLASS    = 3; FRAME_-999000_CLASS_ID = -999000
    """
    if not frames:
        raise ValueError("a frame kernel needs one frame or more")
    for what in ("name", "number"):
        values = [getattr(frame, what) for frame in frames]
        if twice := [x for x in values if values.count(x) > 1]:
            raise ValueError(f"two frames have the {what} {twice[0]!r}; frames need different ones")
    blocks = [
        [
            (f"FRAME_{frame.name}", str(frame.number)),
            (f"FRAME_{frame.number}_NAME", _quoted(frame.name)),
            *frame._entries(),
        ]
        for frame in frames
    ]
    _write(path, "FK", blocks)


@explains_calls
def write_sclk(
    path: str | os.PathLike[str],
    *,
    clock: int,
    epoch: str | datetime.date | np.datetime64,
    time_system: str = "UTC",
) -> None:
    """Write the SPICE clock kernel of a clock that runs with TT, atomically.

    The clock has seconds and ticks of 1/65536 s, reads 0 at the epoch, and runs for 136 years. It serves
    simulated motions; for a real spacecraft take the kernel of its mission.

    Parameters
    ----------
    clock
        Its number, negative: by custom that of the spacecraft.
    epoch, time_system
        When the clock reads 0, as text or a datetime, not later than the first attitude, in ``"UTC"``,
        ``"TT"``, ``"TAI"`` or ``"GPS"``.

    Raises
    ------
    ValueError
        For a number that is not negative, an epoch that does not exist, and other time systems.
    OSError
        If the file cannot be written; an older file stays.

    Examples
    --------
    The epoch is 9496.5 days and 69.184 s after J2000, as TT is 69.184 s ahead of UTC:

    >>> ph.io.write_sclk("curlew.tsc", clock=-999, epoch="2026-01-01T00:00:00")
    >>> with open("curlew.tsc") as file:
    ...     print(*(line.strip() for line in file if "COEFFICIENTS" in line))
    SCLK01_COEFFICIENTS_999  = ( 0.0 820497669.184 1.0 )
    """
    _check_clock(clock)
    if time_system not in _J2000:
        raise ValueError(f"time_system of a clock must be one of {', '.join(_J2000)}, got {time_system!r}")
    start = parse_epoch(epoch, time_system)
    since_j2000 = elapsed(parse_epoch(_J2000[time_system], time_system), start, time_system)
    entries = {
        "SCLK_DATA_TYPE": "( 1 )",
        "SCLK01_TIME_SYSTEM": "( 2 )",  # the parallel time is TT
        "SCLK01_N_FIELDS": "( 2 )",
        "SCLK01_MODULI": f"( {_SECONDS} {_TICKS} )",
        "SCLK01_OFFSETS": "( 0 0 )",
        "SCLK01_OUTPUT_DELIM": "( 2 )",
        "SCLK_PARTITION_START": "( 0.0 )",
        "SCLK_PARTITION_END": f"( {float(_SECONDS * _TICKS - 1)!r} )",
        "SCLK01_COEFFICIENTS": f"( 0.0 {since_j2000!r} 1.0 )",
    }
    named = [(f"{key}_{-clock}", value) for key, value in entries.items()]
    _write(path, "SCLK", [[("SCLK_KERNEL_ID", f"( @{str(start)[:10]} )"), *named]])


def _write(path: str | os.PathLike[str], kind: str, blocks: list[list[tuple[str, str]]]) -> None:
    lines = [f"KPL/{kind}", "", f"Written by polhode {_native.__version__}"]
    for block in blocks:
        width = max(len(key) for key, _ in block)
        lines += ["", r"\begindata", "", *(f"   {key:<{width}} = {value}" for key, value in block)]
        lines += ["", r"\begintext"]
    write_atomically({Path(path): "\n".join([*lines, ""]).encode("ascii")})


def _check(name: str, number: int) -> None:
    if not re.fullmatch(r"[A-Z][A-Z0-9_-]{0,25}", name):
        raise ValueError(
            f"the name of a frame must be 1 to 26 of A-Z, 0-9, _ and -, from a letter on, got {name!r}"
        )
    _check_number(f"the number of frame {name!r}", number)
    if number == 0:
        raise ValueError(f"the number of frame {name!r} must not be 0")


def _check_clock(clock: int) -> None:
    _check_number("the number of the clock", clock)
    if clock >= 0:
        raise ValueError(f"the number of a clock must be negative, got {clock}")


def _check_number(what: str, number: int) -> None:
    if not isinstance(number, int | np.integer) or isinstance(number, bool) or abs(number) >= 2**31:
        raise ValueError(f"{what} must be an integer of 32 bits, got {number!r}")


def _quoted(name: str | int) -> str:
    """Return a name in quotes, or a number."""
    if isinstance(name, int | np.integer) and not isinstance(name, bool):
        return str(name)
    if not isinstance(name, str) or not re.fullmatch(r"[ -~]{1,36}", name) or not name.strip():
        raise ValueError(f"a name of SPICE must be 1 to 36 characters of ASCII, got {name!r}")
    return "'" + name.replace("'", "''") + "'"
