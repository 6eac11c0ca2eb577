"""CCSDS attitude ephemeris messages (AEM) in keyword-value notation: reading.

CCSDS 504.0-B-1 (version 1.0 of the message) and 504.0-B-2 (version 2.0). The quaternion from frame A to
frame B is that of the active rotation from the basis vectors of A to those of B (504.0-B-2, annex F2). With A
the frame of space and B that of the body, it is the Hamilton quaternion of our rotor.
"""

from __future__ import annotations

import datetime
import math
import os
import re
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from polhode._algebra.constructors import bivector
from polhode._algebra.rotor import Rotor
from polhode._io.epochs import TIME_SYSTEMS, Epoch, GivenEpoch, elapsed, parse_epoch
from polhode._io.history import AttitudeHistory, FileError, continuous, require_file
from polhode._mechanics.robots.document import Source
from polhode._support.arrays import Array
from polhode._support.calls import explains_calls
from polhode._support.files import contents

# Numbers in a line of data after the epoch.
_NUMBERS = {"QUATERNION": 4, "QUATERNION/ANGVEL": 7}
# Relative error of a norm that the five digits of a file may have; above it the numbers are not a quaternion.
_NORM = 1e-3
# A norm within rounding of 1 is left as it is, so that what `write_aem` wrote is read to the same bits.
_ROUNDING = 8 * np.finfo(float).eps

# Keywords of the metadata that are kept as attributes.
_KEPT = {
    "OBJECT_NAME": "object_name",
    "OBJECT_ID": "object_id",
    "CENTER_NAME": "center_name",
    "INTERPOLATION_METHOD": "interpolation_method",
    "INTERPOLATION_DEGREE": "interpolation_degree",
}


@dataclass
class _Place:
    """A word of the file and its place."""

    source: Source
    text: str
    line: int
    column: int

    def error(self, words: str) -> FileError:
        return FileError(self.source.error(self.line, self.column, words))


@dataclass
class _Segment:
    """A block of metadata, and the lines of its data."""

    start: _Place
    values: dict[str, _Place] = field(default_factory=dict)
    lines: list[_Place] = field(default_factory=list)
    complete: bool = False


@explains_calls
def read_aem(
    path: str | os.PathLike[str],
    *,
    segment: int | None = None,
    epoch: str | datetime.date | np.datetime64 | None = None,
    body_frame: str | None = None,
    quaternion_type: str | None = None,
    attitude_dir: str | None = None,
    angvel_frame: str | None = None,
) -> AttitudeHistory:
    """Read attitudes from a CCSDS AEM file (KVN), with angular velocities if it has them.

    The attitude types QUATERNION and QUATERNION/ANGVEL of the versions 1.0 and 2.0 are read. Order, direction
    and frames are those that the file states. Version 2.0 fixes order (scalar last) and direction (from
    REF_FRAME_A to REF_FRAME_B); version 1.0 needs the keywords QUATERNION_TYPE and ATTITUDE_DIR. A keyword
    that is missing must be given as an argument; one that contradicts the file is an error.

    Parameters
    ----------
    segment
        Number of the segment from 1, for a file with several.
    epoch
        Epoch of time 0, as text or a datetime, in the time system of the file; by default START_TIME.
    body_frame
        Which of REF_FRAME_A and REF_FRAME_B is that of the body, by name. By default the one that the
        standard names so: ``SC_BODY``, ``SC_BODY_1``, ...
    quaternion_type
        ``"FIRST"`` or ``"LAST"``: the place of the scalar QC, for a file without QUATERNION_TYPE.
    attitude_dir
        ``"A2B"`` or ``"B2A"``, for a file without ATTITUDE_DIR.
    angvel_frame
        Frame of the components of angular velocities, by name, ``"REF_FRAME_A"`` or ``"REF_FRAME_B"``, for a
        file without ANGVEL_FRAME.

    Returns
    -------
    AttitudeHistory
        Times are SI seconds since the epoch, leap seconds included. Quaternions are normalized, and their
        signs are chosen so that the rotor is continuous. Attributes are the epoch, the time system, the
        frames, the names of object and centre, and the interpolation.

    Raises
    ------
    ValueError
        With file, line and column: if the file is not an AEM, has another attitude type, lacks a keyword, or
        has a time outside of START_TIME to STOP_TIME.
    FileNotFoundError
        If there is no such file.

    Examples
    --------
    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> motion = ph.simulate(ball, ph.State(ph.Rotor.identity(), [0, 0, 1]), [0, 60, 120])
    >>> ph.io.write_aem(motion, "ball.aem", epoch="2026-01-01T00:00:00", reference_frame="EME2000")
    >>> history = ph.io.read_aem("ball.aem")
    >>> history.time, history.attributes["epoch"], history.attributes["reference_frame"]
    (array([  0.,  60., 120.]), '2026-01-01T00:00:00', 'EME2000')
    >>> history.omega_body["e12"].round(9)
    array([1., 1., 1.])
    """
    name = os.fsdecode(path)
    require_file(path)
    try:
        text = contents(path, copies=4).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise FileError(
            f"{name}: error: not text in UTF-8 from byte {error.start} on; save the file as UTF-8"
        ) from None
    source = Source(name, text.splitlines())
    header, segments = _parsed(source)
    chosen = _chosen(header, segments, segment)
    given = {
        "QUATERNION_TYPE": ("quaternion_type", quaternion_type, ("FIRST", "LAST")),
        "ATTITUDE_DIR": ("attitude_dir", attitude_dir, ("A2B", "B2A")),
    }
    by_version = header.text.startswith("2.")
    fixed = {"QUATERNION_TYPE": "LAST", "ATTITUDE_DIR": "A2B"} if by_version else {}
    words = {key: _word(chosen, key, *rest, fixed.get(key)) for key, rest in given.items()}
    system, times, origin = _times(chosen, epoch)
    numbers = _numbers(chosen)
    body_is_b, frames = _frames(chosen, body_frame)
    quaternions = numbers[:, :4]
    if words["QUATERNION_TYPE"] == "LAST":
        quaternions = np.roll(quaternions, 1, axis=1)
    # Ours turns the basis vectors of space to those of the body.
    if (words["ATTITUDE_DIR"] == "A2B") != body_is_b:
        quaternions = quaternions * [1.0, -1.0, -1.0, -1.0]
    rotor = Rotor.from_quaternion(continuous(_unit(quaternions, chosen)), order="wxyz")
    omega = None
    if numbers.shape[1] == 7:
        if words["ATTITUDE_DIR"] == "B2A":
            kind = chosen.values["ATTITUDE_TYPE"]
            raise kind.error(
                f"{kind.text} is defined for ATTITUDE_DIR A2B only, because B2A leaves its sign open"
            )
        # The angular velocity is that of B relative to A.
        rates = bivector(np.radians(numbers[:, 4:]) * (1.0 if body_is_b else -1.0))
        omega = rates if _in_body(chosen, angvel_frame, body_is_b) else (~rotor)(rates)
    attributes: dict[str, Any] = {"epoch": str(origin), "time_system": system, **frames}
    for key, attribute in _KEPT.items():
        if key in chosen.values:
            attributes[attribute] = chosen.values[key].text
    return AttitudeHistory(times, rotor, omega, attributes=attributes)


# --- structure


def _parsed(source: Source) -> tuple[_Place, list[_Segment]]:
    """Return the version and the segments of a file."""
    version: _Place | None = None
    segments: list[_Segment] = []
    inside = "header"
    for number, line in enumerate(source.lines, 1):
        words = line.strip()
        column = len(line) - len(line.lstrip())
        place = _Place(source, words, number, column)
        if not words or re.match(r"COMMENT(\s|$)", words):
            continue
        if version is None:
            key, value = _pair(place)
            if key != "CCSDS_AEM_VERS":
                raise place.error(f"an AEM begins with CCSDS_AEM_VERS, got {key!r}")
            if not re.fullmatch(r"[12]\.\d+", value.text):
                raise value.error(f"versions 1.0 and 2.0 of the AEM are supported, got {value.text!r}")
            version = value
        elif words == "META_START":
            if inside not in ("header", "between"):
                raise place.error("META_START inside a block; end it with META_STOP or DATA_STOP first")
            segments.append(_Segment(place))
            inside = "metadata"
        elif words == "META_STOP" and inside == "metadata":
            inside = "before data"
        elif words == "DATA_START" and inside == "before data":
            inside = "data"
        elif words == "DATA_STOP" and inside == "data":
            segments[-1].complete = True
            inside = "between"
        elif inside == "data":
            segments[-1].lines.append(place)
        elif inside == "metadata":
            key, value = _pair(place)
            if key in segments[-1].values:
                raise place.error(f"{key} is already in line {segments[-1].values[key].line}; keep one")
            segments[-1].values[key] = value
        elif inside == "header" and "=" in words:
            continue
        else:
            expected = {"before data": "DATA_START", "between": "META_START"}.get(inside, "META_START")
            raise place.error(f"expected {expected}, got {words[:40]!r}")
    if version is None:
        raise FileError(f"{source.name}: error: the file is empty; an AEM begins with CCSDS_AEM_VERS")
    if not segments:
        raise version.error("the file has no META_START, so it has no attitudes")
    if not segments[-1].complete:
        end = {"metadata": "META_STOP", "before data": "DATA_START"}.get(inside, "DATA_STOP")
        raise segments[-1].start.error(f"the segment has no {end}; the file may be cut off")
    return version, segments


def _pair(place: _Place) -> tuple[str, _Place]:
    key, sign, value = place.text.partition("=")
    if not sign or not re.fullmatch(r"[A-Z][A-Z0-9_]*", key.strip()):
        remedy = ""
        if place.text.startswith("<"):
            remedy = "; an AEM in XML is not read, export it as KVN, which has such lines"
        raise place.error(f"expected KEYWORD = value, got {place.text[:40]!r}{remedy}")
    skipped = len(value) - len(value.lstrip())
    column = place.column + len(key) + 1 + (skipped if value.strip() else 0)
    return key.strip(), _Place(place.source, value.strip(), place.line, column)


def _chosen(header: _Place, segments: list[_Segment], number: int | None) -> _Segment:
    count = len(segments)
    if number is None:
        if count > 1:
            raise segments[1].start.error(
                f"the file has {count} segments, between which attitudes must not be "
                f"interpolated; choose one with segment=1 to segment={count}"
            )
        return segments[0]
    if not 1 <= number <= count:
        raise header.error(f"segment must be from 1 to {count}, the number of segments, got {number}")
    return segments[number - 1]


# --- values


def _required(segment: _Segment, key: str, remedy: str = "add it to the file") -> _Place:
    if key not in segment.values or not segment.values[key].text:
        place = segment.values.get(key, segment.start)
        raise place.error(f"the segment has no {key}; {remedy}")
    return segment.values[key]


def _word(
    segment: _Segment, key: str, name: str, given: str | None, words: tuple[str, ...], fixed: str | None
) -> str:
    """Return a word from the file, from an argument, or as the version of the standard fixes it."""
    choice = " or ".join(f"{name}={word!r}" for word in words)
    if given is not None and given.upper() not in words:
        raise ValueError(f"{name} must be {' or '.join(map(repr, words))}, got {given!r}")
    if key not in segment.values:
        if fixed is not None and given is not None and given.upper() != fixed:
            raise ValueError(f"{name} is {fixed!r} in version 2.0 of the AEM, got {given!r}; leave it out")
        if given is None and fixed is None:
            raise segment.start.error(f"the segment has no {key}; give {choice}")
        return (given or fixed or "").upper()
    place = segment.values[key]
    stated = place.text.upper()
    if stated not in words:
        raise place.error(f"{key} must be {' or '.join(words)}, got {place.text!r}")
    if given is not None and given.upper() != stated:
        raise place.error(f"{key} is {stated}, but {name}={given!r} was given; leave it out")
    return stated


def _times(segment: _Segment, given: GivenEpoch | None) -> tuple[str, Array, Epoch]:
    """Return the time system, the times in s and the epoch of time 0."""
    system = _required(segment, "TIME_SYSTEM")
    if system.text not in TIME_SYSTEMS:
        raise system.error(f"TIME_SYSTEM must be one of {', '.join(TIME_SYSTEMS)}, got {system.text!r}")
    start = _epoch(_required(segment, "START_TIME"), system.text)
    stop = _epoch(segment.values["STOP_TIME"], system.text) if "STOP_TIME" in segment.values else None
    origin = start if given is None else parse_epoch(given, system.text)
    times: list[float] = []
    for line in segment.lines:
        word = line.text.split(maxsplit=1)[0]
        epoch = _epoch(_Place(line.source, word, line.line, line.column), system.text)
        times.append(elapsed(origin, epoch, system.text))
        if epoch < start or (stop is not None and epoch > stop):
            key, side = ("START_TIME", "before") if epoch < start else ("STOP_TIME", "after")
            place = segment.values[key]
            raise line.error(
                f"{word} is {side} the segment's {key}, {place.text} in line {place.line}; correct one of "
                "them, or remove the row"
            )
        if len(times) > 1 and times[-1] <= times[-2]:
            before = segment.lines[len(times) - 2]
            raise line.error(
                f"times must increase, got {word} after {before.text.split(maxsplit=1)[0]} in line "
                f"{before.line}; correct one of them, or remove the row"
            )
    return system.text, np.array(times), origin


def _epoch(place: _Place, system: str) -> Epoch:
    try:
        return parse_epoch(place.text, system)
    except ValueError as error:
        raise place.error(str(error)) from None


def _numbers(segment: _Segment) -> Array:
    """Return the numbers of the data, (n, 4) or (n, 7)."""
    kind = _required(segment, "ATTITUDE_TYPE")
    count = _NUMBERS.get(kind.text.upper())
    if count is None:
        raise kind.error(
            f"ATTITUDE_TYPE must be {' or '.join(_NUMBERS)} to be read, got {kind.text!r}; export "
            "the attitudes as quaternions"
        )
    rows = []
    for line in segment.lines:
        words = [(found.start(), found[0]) for found in re.finditer(r"\S+", line.text)][1:]
        if len(words) != count:
            raise line.error(
                f"a line of {kind.text} has an epoch and {count} numbers, got {len(words)} numbers"
            )
        rows.append([_number(line, column, word) for column, word in words])
    if not rows:
        raise segment.start.error("the segment has no line of data")
    return np.array(rows)


def _number(line: _Place, column: int, word: str) -> float:
    try:
        value = float(word) if word.isascii() and "_" not in word else math.nan
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise _Place(line.source, word, line.line, line.column + column).error(f"{word!r} is not a number")
    return value


def _frames(segment: _Segment, given: str | None) -> tuple[bool, dict[str, str]]:
    """Return whether REF_FRAME_B is that of the body, and the names of both frames."""
    a, b = (_required(segment, f"REF_FRAME_{x}") for x in "AB")
    if a.text == b.text:
        raise b.error(f"REF_FRAME_A and REF_FRAME_B are both {b.text}")
    if given is not None:
        if given not in (a.text, b.text):
            raise b.error(
                f"body_frame must be {a.text!r} or {b.text!r}, the frames of the file, got {given!r}"
            )
        body_is_b = given == b.text
    else:
        named = [re.fullmatch(r"SC_BODY(_\w+)?", x.text) is not None for x in (a, b)]
        if named[0] == named[1]:
            raise b.error(
                "REF_FRAME_A and REF_FRAME_B do not show which frame is that of the body; give "
                f"body_frame={a.text!r} or body_frame={b.text!r}"
            )
        body_is_b = named[1]
    space, body = (a.text, b.text) if body_is_b else (b.text, a.text)
    return body_is_b, {"reference_frame": space, "body_frame": body}


def _in_body(segment: _Segment, given: str | None, body_is_b: bool) -> bool:
    """Return whether the angular velocity has components in body axes."""
    a, b = (segment.values[f"REF_FRAME_{x}"].text for x in "AB")
    names = {a: False, "REF_FRAME_A": False, b: True, "REF_FRAME_B": True}
    choice = f"angvel_frame={a!r} or angvel_frame={b!r}"
    stated = segment.values.get("ANGVEL_FRAME")
    if stated is None and given is None:
        raise segment.start.error(f"the segment has no ANGVEL_FRAME; give {choice}")
    if given is not None and given not in names:
        raise ValueError(
            f"angvel_frame must be REF_FRAME_A or REF_FRAME_B or their names, got {given!r}; give {choice}"
        )
    if stated is None:
        return names[given or ""] == body_is_b
    found = {**names, **{name.upper(): x for name, x in names.items()}}.get(stated.text.upper())
    if found is None:
        raise stated.error(f"ANGVEL_FRAME must be {a} or {b}, got {stated.text!r}")
    if given is not None and names[given] != found:
        raise stated.error(
            f"ANGVEL_FRAME is {stated.text}, but angvel_frame={given!r} was given; leave it out"
        )
    return found == body_is_b


def _unit(quaternions: Array, segment: _Segment) -> Array:
    """Return normalized quaternions; those within rounding of norm 1 as they are."""
    with np.errstate(over="ignore"):  # an infinite norm is rejected below
        norms = np.linalg.norm(quaternions, axis=1)
    if len(wrong := np.flatnonzero(np.abs(norms - 1) > _NORM)):
        k = int(wrong[0])
        raise segment.lines[k].error(f"the quaternion must have norm 1, got {norms[k]:.6g}")
    exact = np.abs(norms - 1) <= _ROUNDING
    return quaternions / np.where(exact, 1.0, norms)[:, np.newaxis]
