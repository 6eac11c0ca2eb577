"""CCSDS attitude ephemeris messages (AEM) in keyword-value notation: writing."""

from __future__ import annotations

import datetime
import os
from pathlib import Path
from typing import Any

import numpy as np

from polhode import _native
from polhode._io.epochs import TIME_SYSTEMS, later, parse_epoch
from polhode._io.history import AttitudeHistory
from polhode._mechanics.trajectory import Trajectory
from polhode._support.calls import explains_calls
from polhode._support.files import write_atomically

# Comment by which `polhode._report.output.is_own` knows a file of ours.
_OWN = "COMMENT Written by polhode"


@explains_calls
def write_aem(
    motion: Trajectory | AttitudeHistory,
    path: str | os.PathLike[str],
    *,
    epoch: str | datetime.date | np.datetime64 | None = None,
    time_system: str | None = None,
    reference_frame: str | None = None,
    body_frame: str | None = None,
    version: str = "2.0",
    angular_velocity: bool | None = None,
    originator: str = "UNKNOWN",
    object_name: str | None = None,
    object_id: str | None = None,
    center_name: str | None = None,
    interpolation: tuple[str, int] | None = None,
) -> None:
    """Write the attitudes of one body as a CCSDS AEM file (KVN), atomically.

    REF_FRAME_A is the frame of space and REF_FRAME_B that of the body; quaternions go from A to B, with the
    scalar last, and angular velocities have components in B, in deg/s. Numbers have all their digits.

    Parameters
    ----------
    epoch
        Epoch of time 0 in the time system, ``YYYY-MM-DDThh:mm:ss.d`` or a datetime; by default
        ``motion.attributes["epoch"]``.
    time_system
        ``"UTC"``, ``"TAI"``, ``"TT"``, ``"TDB"``, ``"GPS"``, ``"TCB"`` or ``"TCG"``; by default the
        attribute, else ``"UTC"``. In UTC leap seconds are counted.
    reference_frame, body_frame
        Names of the frames of space, such as ``"EME2000"``, and of the body; by default the attributes, and
        ``"SC_BODY_1"`` for the body.
    version
        ``"2.0"`` (CCSDS 504.0-B-2) or ``"1.0"`` (504.0-B-1), which has no angular velocities of this kind.
    angular_velocity
        Whether to write QUATERNION/ANGVEL; by default if the motion has angular velocities and version 2.0 is
        written.
    originator, object_name, object_id, center_name
        By default the attributes, else ``"UNKNOWN"``, the value of the standard; without a centre the keyword
        is left out.
    interpolation
        Method and degree that a reader should use, such as ``("LAGRANGE", 7)``.

    Raises
    ------
    ValueError
        For a batch, and if the epoch or the reference frame is not known.
    OSError
        If the file cannot be written; an older file stays.

    Examples
    --------
    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> motion = ph.simulate(ball, ph.State(ph.Rotor.identity(), [0, 0, np.pi / 180]), [0, 60])
    >>> ph.io.write_aem(motion, "ball.aem", epoch="2026-01-01T00:00:00", reference_frame="EME2000")
    >>> with open("ball.aem") as file:
    ...     lines = file.read().splitlines()
    >>> for line in lines:
    ...     if line.startswith(("REF_FRAME", "STOP_TIME")):
    ...         print(line)
    REF_FRAME_A = EME2000
    REF_FRAME_B = SC_BODY_1
    STOP_TIME = 2026-01-01T00:01:00
    """
    text = aem(
        motion,
        epoch=epoch,
        time_system=time_system,
        reference_frame=reference_frame,
        body_frame=body_frame,
        version=version,
        angular_velocity=angular_velocity,
        originator=originator,
        object_name=object_name,
        object_id=object_id,
        center_name=center_name,
        interpolation=interpolation,
    )
    write_atomically({Path(path): text.encode()})


def aem(motion: Trajectory | AttitudeHistory, **options: Any) -> str:
    """Return the content of an AEM file; the options are those of `write_aem`."""
    history = AttitudeHistory.of(motion)
    if not len(history):
        raise ValueError("the motion has no output times; an AEM needs one or more")
    version = options.get("version") or "2.0"
    if version not in ("1.0", "2.0"):
        raise ValueError(f"version must be '1.0' or '2.0', got {version!r}")
    rates = options.get("angular_velocity")
    if rates is None:
        rates = history.omega_body is not None and version == "2.0"
    if rates and history.omega_body is None:
        raise ValueError("the motion has no angular velocity; give angular_velocity=False")
    if rates and version == "1.0":
        raise ValueError("version 1.0 of the AEM has no QUATERNION/ANGVEL; give version='2.0'")
    system = _known(history, options, "time_system") or "UTC"
    if system not in TIME_SYSTEMS:
        raise ValueError(f"time_system must be one of {', '.join(TIME_SYSTEMS)}, got {system!r}")
    epoch = options.get("epoch")
    if epoch is None:
        epoch = history.attributes.get("epoch")
    if epoch is None:
        raise ValueError("the epoch of time 0 is not known; give epoch='YYYY-MM-DDThh:mm:ss' for START_TIME")
    frame = _known(history, options, "reference_frame")
    if frame is None:
        raise ValueError(
            "the frame of space is not known; give reference_frame='EME2000' or another REF_FRAME_A"
        )
    origin = parse_epoch(epoch, system)
    stamps = [str(later(origin, t, system)) for t in history.time.tolist()]
    quaternion = history.rotor.to_quaternion(order="xyzw")
    columns = [np.asarray(quaternion)]
    if rates and history.omega_body is not None:
        columns.append(np.degrees(history.omega_body.components))
    rows = np.concatenate(columns, axis=1).tolist()
    lines = [
        *_header(version, options.get("originator") or "UNKNOWN"),
        "META_START",
        *_metadata(
            history, options, version, system, frame, stamps, "QUATERNION/ANGVEL" if rates else "QUATERNION"
        ),
        "META_STOP",
        "",
        "DATA_START",
        *(f"{stamp} {' '.join(map(repr, row))}" for stamp, row in zip(stamps, rows, strict=True)),
        "DATA_STOP",
    ]
    return "\n".join(lines) + "\n"


def _known(history: AttitudeHistory, options: dict[str, Any], name: str) -> str | None:
    """Return an option as one line of text, else the attribute of the motion, else None."""
    value = options.get(name)
    if value is None:
        value = history.attributes.get(name)
    if value is None:
        return None
    text = str(value).strip()
    if not text or not text.isprintable():
        raise ValueError(f"{name} must be one line of text, got {value!r}")
    return text


def _header(version: str, originator: str) -> list[str]:
    now = datetime.datetime.now(datetime.UTC).replace(tzinfo=None).isoformat(timespec="seconds")
    return [
        f"CCSDS_AEM_VERS = {version}",
        f"{_OWN} {_native.__version__}",
        f"CREATION_DATE = {now}",
        f"ORIGINATOR = {originator}",
        "",
    ]


def _metadata(
    history: AttitudeHistory,
    options: dict[str, Any],
    version: str,
    system: str,
    frame: str,
    stamps: list[str],
    kind: str,
) -> list[str]:
    body = _known(history, options, "body_frame") or "SC_BODY_1"
    if body == frame:
        raise ValueError(f"reference_frame and body_frame must differ, got {body!r} for both")
    pairs: dict[str, Any] = {
        "OBJECT_NAME": _known(history, options, "object_name") or "UNKNOWN",
        "OBJECT_ID": _known(history, options, "object_id") or "UNKNOWN",
        "CENTER_NAME": _known(history, options, "center_name"),
        "REF_FRAME_A": frame,
        "REF_FRAME_B": body,
        "ATTITUDE_DIR": "A2B" if version == "1.0" else None,
        "TIME_SYSTEM": system,
        "START_TIME": stamps[0],
        "STOP_TIME": stamps[-1],
        "ATTITUDE_TYPE": kind,
        "QUATERNION_TYPE": "LAST" if version == "1.0" else None,
        "ANGVEL_FRAME": "REF_FRAME_B" if kind.endswith("ANGVEL") else None,
    }
    method, degree = options.get("interpolation") or (None, None)
    if method is None and options.get("interpolation") is None:
        method, degree = (_known(history, options, f"interpolation_{x}") for x in ("method", "degree"))
    pairs |= {"INTERPOLATION_METHOD": method, "INTERPOLATION_DEGREE": degree}
    return [f"{key} = {value}" for key, value in pairs.items() if value is not None]
