"""A film of the scene of a motion."""

from __future__ import annotations

import shutil
import subprocess
import warnings
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from polhode._figures.camera import view_of
from polhode._figures.stage import Stage
from polhode._figures.style import in_our_look, require_times, time_unit, title_of
from polhode._support.arrays import Array, as_count, as_float
from polhode._support.extras import optional
from polhode._support.files import check_target, form_of, unfinished, write_atomically

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from polhode._mechanics.trajectory import Trajectory

_SIZES = {"mp4": (1280, 720), "gif": (640, 360)}
_SMALLEST, _LARGEST, _MOST = 16, 7680, 100_000
# A body that turns further than this from one picture to the next, in rad, seems to turn otherwise.
_QUARTER = np.pi / 2
# The trace goes back this share of the film.
_TAIL = 0.35
# Pixels in an inch, by which type and lines are measured, at a height; smaller films have larger type for it.
_HEIGHT, _DPI, _SMALLER = 600.0, 115.0, 0.75

Progress = Callable[[float], object]


def write(
    trajectory: Trajectory,
    path: Path,
    seconds: float = 12.0,
    fps: float = 25.0,
    size: tuple[int, int] | None = None,
    view: Any = None,
    progress: Progress | None = None,
) -> None:
    """Write a film, whole or not at all; see `Trajectory.film`."""
    plan = planned(path, seconds, fps, size, view)
    require_times(trajectory)
    if len(trajectory.time) < 2:
        raise ValueError("a film needs a motion of 2 output times or more; this one has 1")
    if (problem := stroboscopic(trajectory, plan)) is not None:
        # To whoever called `Trajectory.film`.
        warnings.warn(problem, stacklevel=3)
    # Before a file is begun: matplotlib makes another error of a Ctrl-C while it is imported.
    optional("matplotlib.figure", "plot", "a film")
    save = _save_mp4 if plan.form == "mp4" else _save_gif
    with unfinished(path) as target:
        save(target, _pictures(trajectory, plan.pictures, plan.size, view, progress), plan.fps, plan.size)
        write_atomically({path: target})


class Plan(NamedTuple):
    """What a film is to be: its form, pictures in a second and in all, width and height in pixels."""

    form: str
    fps: float
    pictures: int
    size: tuple[int, int]


def planned(path: Path, seconds: float, fps: float, size: Any, view: Any) -> Plan:
    """Return what a film is to be; all that needs no motion is refused here, as by `Trajectory.film`."""
    form = form_of(path, "a film")
    plan = Plan(
        form,
        as_float(fps, "fps"),
        _count(seconds, fps),
        _checked_size(_SIZES[form] if size is None else size, form),
    )
    view_of(view)
    check_target(path)
    if form == "mp4":
        ffmpeg()
    else:
        optional("PIL", "plot", "a GIF")
    return plan


def stroboscopic(trajectory: Trajectory, plan: Plan) -> str | None:
    """Return what to say of a film whose pictures are too far apart to show how the body turns; else None."""
    span = float(np.ptp(trajectory.time))
    rate = float(np.max(trajectory.omega_body.norm()))
    turn = rate * span / (plan.pictures - 1)
    if not turn > _QUARTER:
        return None
    # Rounded to three digits, to the side on which the film is faithful.
    speed = _rounded(_QUARTER * plan.fps / rate, np.floor)
    needed = _rounded(np.ceil(1 + rate * span / _QUARTER) / plan.fps, np.ceil)
    remedy = f"seconds={needed:g} or more" if needed * plan.fps <= _MOST else "film a shorter motion"
    return (
        f"the film is stroboscopic: the body turns by up to {turn / (2 * np.pi):.3g} turns from one picture "
        "to the next, and beyond a quarter turn it seems to turn otherwise. It is faithful at up to "
        f"{speed:g} s of motion in a second of film: {remedy}"
    )


def _rounded(x: float, way: Any) -> float:
    """Return a positive number with three digits, rounded up or down."""
    unit = 10.0 ** (np.floor(np.log10(x)) - 2)
    return float(way(x / unit) * unit)


def ffmpeg() -> str:
    """Return the path of the program; an OSError that says what to install."""
    program = shutil.which("ffmpeg")
    if program is None:
        raise OSError(
            "an MP4 film needs the program ffmpeg: install it (Debian: apt install ffmpeg), or write a .gif"
        )
    return program


def _checked_size(size: Any, form: str) -> tuple[int, int]:
    if not isinstance(size, tuple | list) or len(size) != 2:
        raise ValueError(f"size is {size!r}; it must be width and height in pixels, such as (1280, 720)")
    width, height = (as_count(x, "size") for x in size)
    if min(width, height) < _SMALLEST or max(width, height) > _LARGEST:
        raise ValueError(
            f"size is {width}x{height}; width and height must be from {_SMALLEST} to {_LARGEST} pixels"
        )
    if form == "mp4" and (width % 2 or height % 2):
        raise ValueError(f"size is {width}x{height}; of an MP4 width and height must be even")
    return width, height


def _count(seconds: float, fps: float) -> int:
    """Return how many pictures there are, at least two: the first and the last moment."""
    for name, value in (("seconds", as_float(seconds, "seconds")), ("fps", as_float(fps, "fps"))):
        if not (value > 0 and np.isfinite(value)):
            raise ValueError(f"{name} is {value}; it must be positive and finite")
    count = round(seconds * fps)
    if not 2 <= count <= _MOST:
        raise ValueError(f"seconds times fps is {count}; a film has 2 to {_MOST} pictures")
    return count


def _pictures(
    trajectory: Trajectory, count: int, size: tuple[int, int], view: Any, progress: Progress | None
) -> Iterator[Array]:
    """Yield the pictures (height, width, 3) of 8 bits, one after the other."""
    stage = Stage(trajectory, view)
    first, last = float(trajectory.time[0]), float(trajectory.time[-1])
    for k in range(count):
        time = first + (last - first) * k / (count - 1)
        yield _picture(stage, time, _TAIL * (last - first), size)
        if progress is not None:
            progress((k + 1) / count)


def _picture(stage: Stage, time: float, tail: float, size: tuple[int, int]) -> Array:
    canvas = optional("matplotlib.backends.backend_agg", "plot", "a film").FigureCanvasAgg(
        frame(stage, time, tail, size)
    )
    canvas.draw()
    picture: Array = np.asarray(canvas.buffer_rgba())[..., :3]
    return picture


@in_our_look
def frame(stage: Stage, time: float, tail: float, size: tuple[int, int]) -> Figure:
    """Return the figure of a moment, as large in pixels as the film."""
    dpi = _DPI * (size[1] / _HEIGHT) ** _SMALLER
    figure: Figure = optional("matplotlib.figure", "plot", "a film").Figure(
        figsize=(size[0] / dpi, size[1] / dpi), dpi=dpi
    )
    axes = figure.add_axes((0.0, 0.0, 1.0, 0.94))
    stage.draw(axes, time, tail)
    seconds, unit = time_unit(stage.trajectory.time)
    decimals = 2 if np.ptp(stage.trajectory.time) / seconds < 100 else 1
    figure.text(0.02, 0.05, f"t = {time / seconds:.{decimals}f} {unit}", fontsize=11)
    figure.text(
        0.5, 0.985, title_of(stage.trajectory, ""), fontsize=12, ha="center", va="top", parse_math=False
    )
    return figure


def _save_mp4(target: Path, pictures: Iterator[Array], fps: float, size: tuple[int, int]) -> None:
    """Hand the pictures to ffmpeg, which hears nothing of a Ctrl-C: it is ended with the film."""
    options = [
        "-f",
        "rawvideo",
        "-pix_fmt",
        "rgb24",
        "-s",
        f"{size[0]}x{size[1]}",
        "-r",
        f"{fps:.9g}",
        "-i",
        "-",
    ]
    coded = ["-an", "-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p", "-movflags", "+faststart"]
    same = ["-fflags", "+bitexact", "-flags:v", "+bitexact"]
    process = subprocess.Popen(
        [ffmpeg(), "-y", "-loglevel", "error", *options, *coded, *same, "-f", "mp4", str(target)],
        stdin=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
    )
    assert process.stdin is not None
    try:
        with suppress(BrokenPipeError):  # it says itself why it stopped
            for picture in pictures:
                process.stdin.write(picture.tobytes())
        _, complaint = process.communicate()
    except BaseException:
        process.kill()
        process.communicate()
        raise
    if process.returncode:
        words = complaint.decode(errors="replace").strip().splitlines() or ["it said nothing"]
        raise OSError(f"ffmpeg failed: {words[-1]}")


def _save_gif(target: Path, pictures: Iterator[Array], fps: float, size: tuple[int, int]) -> None:
    image = optional("PIL.Image", "plot", "a GIF")
    frames = (image.fromarray(picture).quantize(256, dither=image.Dither.NONE) for picture in pictures)
    # The times of a GIF are in hundredths of a second.
    duration = max(10 * round(100 / fps), 20)
    next(frames).save(
        target, format="GIF", save_all=True, append_images=frames, duration=duration, loop=0, optimize=False
    )
