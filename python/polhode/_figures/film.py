"""Figures and films of the scene of a motion, captured from the viewer."""

from __future__ import annotations

import io
import shutil
import subprocess
import warnings
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from polhode._figures.camera import angles_of
from polhode._figures.style import Figure, drawing, plotting, require_times, time_unit
from polhode._mechanics.trajectory import Trajectory
from polhode._support.arrays import Array, as_count, as_float
from polhode._support.extras import optional
from polhode._support.files import check_target, form_of, unfinished, write_atomically
from polhode._viewer.capture import studio

# Size of the picture in a figure, in pixels.
_SIZE = (1920, 1080)

_CAPTION = (
    r"Arrows: body axes $f_k = R e_k \tilde{R}$; dashed: space axes $e_k$. Discs: $\Omega$ and $L$ in space, "
    r"in their planes and senses, with areas proportional to $|\Omega|$ and $|L|$. Lines: the path of a body "
    r"axis in space (pink) and of $\Omega$ in the body (ochre); they fade with time."
)

_SIZES = {"mp4": (1280, 720), "gif": (640, 360)}
_SMALLEST, _LARGEST, _MOST = 16, 7680, 100_000
# The longest motion, in s, that is filmed at true speed by default.
_LONGEST = 100.0
# Largest turn between two frames, in rad; beyond it the body appears to turn at another rate.
_QUARTER = np.pi / 2
# Programs show a frame of a GIF that lasts less than 1/50 s for longer.
_GIF_FPS = 50.0
# Number of frames from which the palette of a GIF is made.
_SAMPLED = 6

# Comment in a film, by which `polhode._report.output.is_own` knows it.
_COMMENT = "Polhode"

Progress = Callable[[float], object]


@drawing(7, 4.75, "The body, $\\Omega$ and $L$")
def scene_figure(figure: Figure, trajectory: Trajectory, view: Any = None, time: float | None = None) -> str:
    """Draw the scene at a time in s, the last one if none is given, as the viewer draws it."""
    when = _checked_time(trajectory, time)
    with studio(trajectory, np.array([when]), _SIZE, angles_of(view), "a figure of kind 'scene'") as taken:
        picture = taken.capture(when)
    axes = figure.add_subplot()
    axes.imshow(plotting("matplotlib.image").imread(io.BytesIO(picture), format="png"))
    axes.set_axis_off()
    seconds, unit = time_unit(trajectory.time)
    axes.text(0.01, 0.97, f"$t$ = {when / seconds:.4g} {unit}", transform=axes.transAxes, va="top")
    held = trajectory._origin is not None and trajectory._origin.held
    return _CAPTION + " $mg$: the weight at the centre of mass." * held


def _checked_time(trajectory: Trajectory, time: float | None) -> float:
    """Return the time, the last one for None; a ValueError outside of those of the motion."""
    first, last = float(trajectory.time.min()), float(trajectory.time.max())
    when = last if time is None else as_float(time, "time")
    if not first <= when <= last:
        raise ValueError(f"time is {when:.6g} s; the motion goes from {first:.6g} s to {last:.6g} s")
    return when


class Plan(NamedTuple):
    """Form, frames per second, size in pixels and length in s of a film; None for true speed."""

    form: str
    fps: float
    size: tuple[int, int]
    seconds: float | None


def write(
    trajectory: Trajectory,
    path: Path,
    seconds: float | None = None,
    fps: float = 25.0,
    size: tuple[int, int] | None = None,
    view: Any = None,
    progress: Progress | None = None,
) -> None:
    """Write a film; see `Trajectory.film`."""
    plan = planned(path, seconds, fps, size, view)
    require_times(trajectory)
    times = frame_times(trajectory, plan)
    if (problem := stroboscopic(trajectory, plan)) is not None:
        # To the caller of `Trajectory.film`.
        warnings.warn(problem, stacklevel=3)
    title, (per_unit, unit) = trajectory.attributes.get("title", ""), time_unit(trajectory.time)
    decimals = 2 if np.ptp(trajectory.time) / per_unit < 100 else 1
    with unfinished(path) as target, studio(trajectory, times, plan.size, angles_of(view), "a film") as taken:

        def frame(k: int) -> bytes:
            note = f"t = {times[k] / per_unit:.{decimals}f} {unit}"
            return taken.capture(float(times[k]), played=k / plan.fps, title=title, note=note)

        def frames() -> Iterator[bytes]:
            for k in range(len(times)):
                yield frame(k)
                if progress is not None:
                    progress((k + 1) / len(times))

        if plan.form == "mp4":
            _save_mp4(target, frames(), plan.fps)
        else:
            sampled = np.unique(np.linspace(0, len(times) - 1, _SAMPLED).round().astype(int))
            # The times of a GIF are in hundredths of a second, Pillow's in thousandths.
            ends = 10 * np.rint(100 * np.arange(len(times) + 1) / plan.fps).astype(int)
            _save_gif(target, [frame(int(k)) for k in sampled], frames(), np.diff(ends).tolist())
        write_atomically({path: target})


def planned(path: Path, seconds: float | None, fps: float, size: Any, view: Any) -> Plan:
    """Return the plan of a film, after all checks that do not need its motion."""
    form = form_of(path, "a film")
    rate = _positive(fps, "fps")
    if form == "gif" and rate > _GIF_FPS:
        raise ValueError(f"fps is {rate:g}; a GIF has at most {_GIF_FPS:g} frames per second")
    pixels = _checked_size(_SIZES[form] if size is None else size, form)
    plan = Plan(form, rate, pixels, None if seconds is None else _positive(seconds, "seconds"))
    if plan.seconds is not None:
        _checked_count(plan.seconds, plan.fps)
    angles_of(view)
    check_target(path)
    optional("playwright", "film", "a film")
    if form == "mp4":
        ffmpeg()
    else:
        optional("PIL", "film", "a GIF")
    return plan


def frame_times(trajectory: Trajectory, plan: Plan) -> Array:
    """Return the time of the motion, in s, that each frame shows: equally spaced from the first one on."""
    first, span = float(trajectory.time[0]), float(np.ptp(trajectory.time))
    if not span > 0:
        raise ValueError("a film needs two different output times; this motion has one")
    if plan.seconds is None and not 2 / plan.fps <= span <= _LONGEST:
        raise ValueError(
            f"the motion lasts {span:.6g} s, too {'long' if span > 1 else 'short'} for a film at true speed: "
            "choose how long the film lasts, such as seconds=12 (--seconds 12)"
        )
    seconds = span if plan.seconds is None else plan.seconds
    times = first + np.arange(_checked_count(seconds, plan.fps)) * (span / seconds / plan.fps)
    # By rounding the last one may be beyond the end.
    return np.asarray(np.minimum(times, first + span))


def stroboscopic(trajectory: Trajectory, plan: Plan) -> str | None:
    """Return a warning if the body turns too far between frames to show how it turns; else None."""
    span = float(np.ptp(trajectory.time))
    rate = float(np.max(trajectory.omega_body.norm()))
    turn = rate * span / (span if plan.seconds is None else plan.seconds) / plan.fps
    if not turn > _QUARTER:
        return None
    # Rounded to three digits, to the side on which the film is faithful.
    speed = _rounded(_QUARTER * plan.fps / rate, np.floor)
    needed = _rounded(rate * span / _QUARTER / plan.fps, np.ceil)
    remedy = "film a shorter motion"
    if needed * plan.fps <= _MOST:
        remedy = f"seconds={needed:g} or more (--seconds {needed:g})"
    return (
        f"the film is stroboscopic: the body turns by up to {turn / (2 * np.pi):.3g} turns between frames, "
        "and beyond a quarter turn it appears to turn at another rate. The film is faithful at up to "
        f"{speed:g} s of motion per second of film: {remedy}"
    )


def ffmpeg() -> str:
    """Return the path of the program; an OSError with what to install."""
    if (program := shutil.which("ffmpeg")) is None:
        raise OSError(
            "an MP4 film needs the program ffmpeg: install it (Debian: apt install ffmpeg), or write a .gif"
        )
    return program


def _rounded(x: float, way: Any) -> float:
    """Return a positive number with three digits, rounded up or down."""
    unit = 10.0 ** (np.floor(np.log10(x)) - 2)
    return float(way(x / unit) * unit)


def _positive(value: float, name: str) -> float:
    number = as_float(value, name)
    if not (number > 0 and np.isfinite(number)):
        raise ValueError(f"{name} is {number}; it must be positive and finite")
    return number


def _checked_count(seconds: float, fps: float) -> int:
    count = round(seconds * fps)
    if not 2 <= count <= _MOST:
        raise ValueError(f"seconds times fps is {count}; a film has 2 to {_MOST} frames")
    return count


def _checked_size(size: Any, form: str) -> tuple[int, int]:
    if not isinstance(size, tuple | list) or len(size) != 2:
        raise ValueError(f"size is {size!r}; it must be width and height in pixels, such as (1280, 720)")
    width, height = (as_count(x, "size") for x in size)
    if min(width, height) < _SMALLEST or max(width, height) > _LARGEST:
        raise ValueError(
            f"size is {width}x{height}; width and height must be from {_SMALLEST} to {_LARGEST} pixels"
        )
    if form == "mp4" and (width % 2 or height % 2):
        raise ValueError(f"size is {width}x{height}; width and height of an MP4 must be even")
    return width, height


def _save_mp4(target: Path, frames: Iterator[bytes], fps: float) -> None:
    """Pass the frames to ffmpeg, which runs in its own session: only this function ends it, not a Ctrl-C."""
    given = ["-f", "image2pipe", "-c:v", "png", "-framerate", f"{fps:.9g}", "-i", "-"]
    coded = ["-an", "-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p", "-movflags", "+faststart"]
    same = ["-fflags", "+bitexact", "-flags:v", "+bitexact", "-metadata", f"comment={_COMMENT}"]
    process = subprocess.Popen(
        [ffmpeg(), "-y", "-loglevel", "error", *given, *coded, *same, "-f", "mp4", str(target)],
        stdin=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
    )
    assert process.stdin is not None
    try:
        with suppress(BrokenPipeError):  # it reports why it stopped
            for frame in frames:
                process.stdin.write(frame)
        _, complaint = process.communicate()
    except BaseException:
        process.kill()
        process.communicate()
        raise
    if process.returncode:
        words = complaint.decode(errors="replace").strip().splitlines() or ["it gave no reason"]
        raise OSError(f"ffmpeg failed: {words[-1]}")


def _save_gif(target: Path, sampled: list[bytes], frames: Iterator[bytes], durations: list[int]) -> None:
    """Write a GIF of one palette, that of the sampled frames, so that colours do not flicker."""
    image = optional("PIL.Image", "film", "a GIF")

    def opened(frame: bytes) -> Any:
        return image.open(io.BytesIO(frame)).convert("RGB")

    sheet = np.concatenate([np.asarray(opened(frame)) for frame in sampled])
    colours = image.fromarray(sheet).quantize(255, dither=image.Dither.NONE).getpalette()
    palette = image.new("P", (1, 1))
    # White stays white.
    palette.putpalette([255, 255, 255, *colours[: 3 * 255]])
    pictures = (opened(frame).quantize(palette=palette, dither=image.Dither.NONE) for frame in frames)
    next(pictures).save(
        target,
        format="GIF",
        save_all=True,
        append_images=pictures,
        duration=durations,
        loop=0,
        comment=_COMMENT,
    )
