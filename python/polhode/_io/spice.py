"""SPICE pointing kernels (CK) of type 3: attitudes at times of a spacecraft clock.

A CK holds the C-matrix from a reference frame to that of the instrument, as the SPICE quaternion w, x, y, z
of this matrix: the conjugate of our Hamilton quaternion from body to space. Its angular velocities have
components in the reference frame.
"""

from __future__ import annotations

import contextlib
import datetime
import os
import struct
import tempfile
import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.constructors import bivector
from polhode._algebra.rotor import Rotor
from polhode._io.epochs import GivenEpoch, parse_epoch
from polhode._io.history import AttitudeHistory, FileError, continuous, require_file
from polhode._mechanics.trajectory import Trajectory
from polhode._support.arrays import Array
from polhode._support.calls import explains_calls
from polhode._support.extras import optional
from polhode._support.files import check_target, write_atomically

_Paths = Sequence[str | os.PathLike[str]]

# Class of frames whose attitude is in a CK, and the number of such records.
_CK_CLASS, _TYPE = 3, 3
# Bytes of a record, the numbers of doubles and integers that describe a segment, and the most
# segments that a record describes.
_RECORD, _SUMMARY, _MOST = 1024, (2, 6), 25
# Names of time systems in epochs of SPICE.
_SYSTEMS = {"UTC": "UTC", "TT": "TDT", "TDB": "TDB"}
# What to give for a frame that a motion does not have.
_HINTS = {
    "reference_frame": "reference_frame='J2000'",
    "body_frame": "body_frame= the name of a frame of class 3 in the frame kernel",
}


@explains_calls
def write_ck(
    motion: Trajectory | AttitudeHistory,
    path: str | os.PathLike[str],
    *,
    kernels: _Paths,
    body_frame: str | None = None,
    reference_frame: str | None = None,
    epoch: str | datetime.date | np.datetime64 | None = None,
    time_system: str | None = None,
) -> None:
    r"""Write the attitudes of one body as a SPICE CK of type 3, atomically.

    The file has one segment with one interpolation interval, and angular velocities if the motion has them.
    Times of a CK are ticks of the spacecraft clock in 64-bit floats, and SPICE counts seconds since J2000, so
    that times are known to about 1e-7 s.

    Parameters
    ----------
    kernels
        Paths of the leapseconds kernel, the clock kernel (SCLK) and the frame kernel (FK) of the spacecraft.
        They are loaded for this call only.
    body_frame
        Name of the frame of the body in the frame kernel, a frame of class 3.
    reference_frame
        Name of the frame of space, such as ``"J2000"``.
    epoch, time_system
        Epoch of time 0, as text or a datetime, in ``"UTC"``, ``"TT"`` or ``"TDB"``; times are SI seconds from
        it on. These four are by default the attributes of the motion, UTC for the time system.

    Raises
    ------
    ValueError
        For a batch; if epoch or frames are not known; with the message of SPICE, if kernels do not fit.
    ImportError
        Without spiceypy: ``pip install 'polhode[spice]'``.

    Examples
    --------
    The leapseconds kernel is ``naif0012.tls`` of NAIF; here its last entry is enough:

    >>> leapseconds = r'''KPL/LSK
    ... \begindata
    ... DELTET/DELTA_T_A = 32.184
    ... DELTET/K         = 1.657D-3
    ... DELTET/EB        = 1.671D-2
    ... DELTET/M         = ( 6.239996 1.99096871D-7 )
    ... DELTET/DELTA_AT  = ( 37, @2017-JAN-1 )
    ... \begintext
    ... '''
    >>> with open("leapseconds.tls", "w") as file:
    ...     _ = file.write(leapseconds)

    Clock and frame of a simulated spacecraft, and its attitudes:

    >>> ph.io.write_sclk("curlew.tsc", clock=-999, epoch="2026-01-01T00:00:00")
    >>> own = ph.io.CkFrame("CURLEW_BODY", number=-999000, clock=-999, center=-999)
    >>> ph.io.write_fk("curlew.tf", [own])
    >>> kernels = ["leapseconds.tls", "curlew.tsc", "curlew.tf"]
    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> motion = ph.simulate(ball, ph.State(ph.Rotor.identity(), [0, 0, 0.1]), [0, 10, 20])
    >>> names = {"body_frame": "CURLEW_BODY", "reference_frame": "J2000"}
    >>> epoch = "2026-01-01T00:00:00"
    >>> ph.io.write_ck(motion, "curlew.bc", kernels=kernels, epoch=epoch, **names)
    >>> ph.io.read_ck("curlew.bc", kernels=kernels).attributes["body_frame"]
    'CURLEW_BODY'
    """
    history = AttitudeHistory.of(motion)
    check_target(Path(path))
    if not len(history):
        raise ValueError("the motion has no output times; a CK needs one or more")
    epoch = history.attributes.get("epoch") if epoch is None else epoch
    if epoch is None:
        raise ValueError("epoch is not known; give epoch='YYYY-MM-DDThh:mm:ss'")
    reference_frame = _known(history, "reference_frame", reference_frame)
    body_frame = _known(history, "body_frame", body_frame)
    system = str(time_system or history.attributes.get("time_system", "UTC"))
    with _loaded(kernels) as spice, tempfile.TemporaryDirectory() as folder:
        number = _instrument(spice, body_frame)
        _require_frame(spice, reference_frame, "reference_frame")
        start = _of_epoch(spice, epoch, system)
        clock = spice.ckmeta(number, "SCLK")
        start_tt = spice.unitim(start, "ET", "TDT")
        ticks = _ticks(spice, clock, [spice.unitim(start_tt + t, "TDT", "ET") for t in history.time.tolist()])
        if (np.diff(ticks) <= 0).any():
            k = int(np.argmax(np.diff(ticks) <= 0))
            raise ValueError(f"output times {k} and {k + 1} are the same for the clock; give fewer of them")
        temporary = Path(folder) / "a.bc"
        _write_segment(spice, temporary, history, number, reference_frame, ticks)
        write_atomically({Path(path): temporary.read_bytes()})


def _known(history: AttitudeHistory, name: str, given: str | None) -> str:
    """Return a frame as given, by default that of the history."""
    known = given or history.attributes.get(name)
    if known is None:
        raise ValueError(f"{name} is not known; give {_HINTS[name]}")
    return str(known)


def _write_segment(
    spice: Any, path: Path, history: AttitudeHistory, number: int, frame: str, ticks: Array
) -> None:
    """Write a CK with one segment: the attitudes of an instrument in a frame, at ticks of its clock."""
    quaternions = np.asarray((~history.rotor).to_quaternion(order="wxyz"))
    rates = np.zeros((len(history), 3))
    if history.omega_body is not None:
        rates = np.asarray(history.rotor(history.omega_body).components)
    handle = spice.ckopn(str(path), f"polhode {_native.__version__}", 0)
    try:
        spice.ckw03(
            handle,
            ticks[0],
            ticks[-1],
            number,
            frame,
            history.omega_body is not None,
            str(history.attributes.get("object_name", "polhode"))[:40],
            len(ticks),
            ticks,
            quaternions,
            rates,
            1,
            ticks[:1],
        )
    finally:
        spice.ckcls(handle)


@explains_calls
def read_ck(
    path: str | os.PathLike[str],
    *,
    kernels: _Paths,
    segment: int | None = None,
    epoch: str | datetime.date | np.datetime64 | None = None,
    time_system: str | None = None,
) -> AttitudeHistory:
    r"""Read the records of a segment of a SPICE CK of type 3.

    Parameters
    ----------
    kernels
        Paths of the leapseconds kernel, the clock kernel and the frame kernel, as for `write_ck`.
    segment
        Number of the segment from 1, for a file with several.
    epoch, time_system
        Epoch of time 0, as text or a datetime, in ``"UTC"`` by default; without it, that of the first record
        in TDB, to 1e-9 s.

    Returns
    -------
    AttitudeHistory
        With the names of both frames as attributes. Times are known to about 1e-7 s. A warning reports
        several interpolation intervals, since the history does not keep the gaps between them.

    Raises
    ------
    ValueError
        If the file is not a CK of type 3, and with the message of SPICE if the kernels do not fit.
    FileNotFoundError, ImportError
        As for `write_ck`.

    Examples
    --------
    A kernel as `write_ck` writes it, read back:

    >>> leapseconds = r'''KPL/LSK
    ... \begindata
    ... DELTET/DELTA_T_A = 32.184
    ... DELTET/K         = 1.657D-3
    ... DELTET/EB        = 1.671D-2
    ... DELTET/M         = ( 6.239996 1.99096871D-7 )
    ... DELTET/DELTA_AT  = ( 37, @2017-JAN-1 )
    ... \begintext
    ... '''
    >>> with open("leapseconds.tls", "w") as file:
    ...     _ = file.write(leapseconds)
    >>> ph.io.write_sclk("curlew.tsc", clock=-999, epoch="2026-01-01T00:00:00")
    >>> own = ph.io.CkFrame("CURLEW_BODY", number=-999000, clock=-999, center=-999)
    >>> ph.io.write_fk("curlew.tf", [own])
    >>> kernels = ["leapseconds.tls", "curlew.tsc", "curlew.tf"]
    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> motion = ph.simulate(ball, ph.State(ph.Rotor.identity(), [0, 0, 0.1]), [0, 10, 20])
    >>> names = {"body_frame": "CURLEW_BODY", "reference_frame": "J2000"}
    >>> epoch = "2026-01-01T00:00:00"
    >>> ph.io.write_ck(motion, "curlew.bc", kernels=kernels, epoch=epoch, **names)
    >>> history = ph.io.read_ck("curlew.bc", kernels=kernels, epoch=epoch)
    >>> history.time.round(6)
    array([ 0., 10., 20.])
    >>> history.omega_body["e12"].round(9)
    array([0.1, 0.1, 0.1])
    """
    name = os.fsdecode(path)
    require_file(path)
    content = Path(path).read_bytes()
    if not content.startswith(b"DAF/CK "):
        raise FileError(f"{name}: error: not a binary SPICE CK, which begins with DAF/CK")
    if not _is_sound(content):
        raise FileError(
            f"{name}: error: the records that list the segments are not those of a CK; the file is damaged"
        )
    with _loaded(kernels, name) as spice:
        handle = spice.dafopr(name)
        try:
            descriptor = _descriptor(spice, handle, name, segment)
            facts = spice.dafus(descriptor, 2, 6)[1]
            number, reference, rated = int(facts[0]), int(facts[1]), bool(facts[3])
            count = int(spice.cknr03(handle, descriptor))
            # A record has a quaternion at least.
            if not 0 < count <= os.path.getsize(path) // 32:
                raise FileError(f"{name}: error: the segment has {count} records; the file may be damaged")
            records = np.array([spice.ckgr03(handle, descriptor, k + 1) for k in range(count)])
            # The last numbers of a segment are those of its intervals and of its records.
            intervals = int(spice.dafgda(handle, int(facts[5]) - 1, int(facts[5]))[0])
        finally:
            spice.dafcls(handle)
        clock = spice.ckmeta(number, "SCLK")
        seconds = [spice.sct2e(clock, ticks) for ticks in records[:, 0]]
        system = time_system or ("UTC" if epoch is not None else "TDB")
        if epoch is None:
            epoch = str(spice.timout(seconds[0], "YYYY-MM-DDTHR:MN:SC.######### ::TDB"))
        start = spice.unitim(_of_epoch(spice, epoch, system), "ET", "TDT")
        times = np.array([spice.unitim(x, "ET", "TDT") - start for x in seconds])
        space, body = str(spice.frmnam(reference)), _frame_name(spice, number, name)
    if not (np.isfinite(records).all() and (np.abs(records[:, 1:5]) <= 2).all()):
        raise FileError(
            f"{name}: error: the segment has numbers that are not those of attitudes; it is damaged"
        )
    if intervals > 1:
        warnings.warn(
            f"{name}: the segment has {intervals} interpolation intervals; SPICE has no attitudes between "
            "them, but the history does not keep these gaps",
            stacklevel=3,
        )
    stated = epoch if isinstance(epoch, str) else str(parse_epoch(epoch, system))
    attributes = {"epoch": stated, "time_system": system, "reference_frame": space, "body_frame": body}
    try:
        quaternions = continuous(records[:, 1:5] * [1.0, -1.0, -1.0, -1.0])
        rotor = Rotor.from_quaternion(quaternions, order="wxyz")
        omega = (~rotor)(bivector(np.ascontiguousarray(records[:, 5:8]))) if rated else None
        return AttitudeHistory(times, rotor, omega, attributes=attributes)
    except ValueError as error:
        raise FileError(f"{name}: error: the segment is damaged: {error}") from None


def _is_sound(content: bytes) -> bool:
    """Whether the lists of segments are those of a CK; SPICE leaves its memory where they are not."""
    order = ">" if content[88:96] == b"BIG-IEEE" else "<"
    if len(content) < _RECORD or struct.unpack_from(f"{order}2i", content, 8) != _SUMMARY:
        return False
    record = float(struct.unpack_from(f"{order}i", content, 76)[0])
    known: set[float] = set()
    while record:
        if record in known or not record.is_integer() or not 1 <= record <= len(content) // _RECORD:
            return False
        known.add(record)
        record, _, count = struct.unpack_from(f"{order}3d", content, _RECORD * (int(record) - 1))
        if not (count.is_integer() and 0 <= count <= _MOST):
            return False
    return True


@contextlib.contextmanager
def _loaded(kernels: _Paths, source: str | None = None) -> Iterator[Any]:
    """Yield spiceypy with kernels loaded; its errors become a ValueError, a FileError if a file is read."""
    spice = optional("spiceypy", "spice", "a SPICE kernel")
    if isinstance(kernels, str | os.PathLike):
        raise TypeError("kernels must be a list of paths, got one path; give [path]")
    paths = [os.fsdecode(path) for path in kernels]
    with contextlib.ExitStack() as stack:
        for path in paths:
            if not os.path.isfile(path):
                raise FileNotFoundError(f"{path}: no such kernel")
        for path in paths:
            try:
                spice.furnsh(path)
            except spice.SpiceyError as error:
                raise FileError(f"{path}: error: {_words(spice, error)}") from None
            stack.callback(spice.unload, path)
        try:
            yield spice
        except spice.SpiceyError as error:
            words = (
                f"{_words(spice, error)}; kernels must have leapseconds, clock and frames of the spacecraft, "
                f"got {', '.join(paths)}"
            )
            raise (FileError(f"{source}: error: {words}") if source else ValueError(words)) from None


def _words(spice: Any, error: Any) -> str:
    """Return the message of an error of SPICE, which is forgotten."""
    spice.reset()
    return f"SPICE: {' '.join(str(getattr(error, 'long', '') or error.short).split())}"


def _of_epoch(spice: Any, epoch: GivenEpoch, system: str) -> float:
    if system not in _SYSTEMS:
        raise ValueError(f"time_system of a CK must be UTC, TT or TDB, got {system!r}")
    text = str(parse_epoch(epoch, system)).replace("T", " ")
    return float(spice.str2et(f"{text} {_SYSTEMS[system]}"))


def _ticks(spice: Any, clock: int, seconds: list[float]) -> Array:
    """Return the ticks of a clock at times in s of TDB since J2000."""
    try:
        return np.array([spice.sce2c(clock, x) for x in seconds])
    except spice.SpiceyError as error:
        if error.short != "SPICE(VALUEOUTOFRANGE)":
            raise
        first, last = (spice.timout(x, "YYYY-MM-DDTHR:MN:SC ::UTC") for x in (seconds[0], seconds[-1]))
        raise ValueError(
            f"the clock {clock} of the kernels does not cover {first} to {last} UTC; "
            "give another epoch= or clock kernel"
        ) from None


def _require_frame(spice: Any, frame: str, name: str) -> int:
    """Return the code of a frame."""
    code = int(spice.namfrm(frame))
    if code == 0:
        remedy = f"give the frame kernel, or another {name}="
        if frame.strip().upper() == "EME2000":
            remedy = f"SPICE calls it 'J2000': give {name}='J2000'"
        raise ValueError(f"the kernels have no frame {frame!r}; {remedy}")
    return code


def _instrument(spice: Any, frame: str) -> int:
    """Return the number of the instrument whose attitude is that of a frame."""
    code = _require_frame(spice, frame, "body_frame")
    _, kind, number = spice.frinfo(code)
    if kind != _CK_CLASS:
        raise ValueError(f"body_frame must be a frame of class 3 for a CK, got {frame!r} of class {kind}")
    return int(number)


def _frame_name(spice: Any, number: int, name: str) -> str:
    try:
        return str(spice.ccifrm(_CK_CLASS, number)[1])
    except spice.NotFoundError:
        raise FileError(
            f"{name}: error: no frame of class 3 for instrument {number}; give the frame kernel"
        ) from None


def _descriptor(spice: Any, handle: int, name: str, chosen: int | None) -> Any:
    """Return the descriptor of a segment of type 3."""
    found = []
    spice.dafbfs(handle)
    while spice.daffna():
        found.append(spice.dafgs(5).copy())
    if not found:
        raise FileError(f"{name}: error: the file has no segment")
    if chosen is None and len(found) > 1:
        raise FileError(
            f"{name}: error: the file has {len(found)} segments; choose one with segment=1 and so on"
        )
    if chosen is not None and not 1 <= chosen <= len(found):
        raise FileError(f"{name}: error: segment must be from 1 to {len(found)}, got {chosen}")
    descriptor = found[(chosen or 1) - 1]
    kind = int(spice.dafus(descriptor, 2, 6)[1][2])
    if kind != _TYPE:
        raise FileError(
            f"{name}: error: segments of type {_TYPE} are read, got type {kind}; sample the segment "
            "with SPICE's pxform(body, space, time), and pass the matrices to Rotor.from_matrix"
        )
    return descriptor
