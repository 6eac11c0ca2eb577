"""Films: their frames, times and files, and what happens where one cannot be made."""

import json
import os
import re
import shutil
import signal
import sys
import time
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import polhode as ph
import processes
import studios
from command_line import EXAMPLES, POLHODE, SCENE, polhode

pytest.importorskip("PIL")
from PIL import Image

from polhode._figures.film import Plan, frame_times, stroboscopic
from polhode._report.output import is_own

with_ffmpeg = pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="ffmpeg is not installed")


@pytest.fixture
def painted(monkeypatch):
    return studios.paint(monkeypatch)


def motion():
    inertia = ph.Inertia.from_principal_moments(1, 2, 3)
    state = ph.State(ph.Rotor.from_components([4, -2, 1, 2]), [0.25, -0.5, 1.0])
    return ph.simulate(inertia, state, np.linspace(0, 10, 201))


def spun(rate, duration):
    """A body that turns steadily at a rate in rad/s for a duration in s."""
    state = ph.State(ph.Rotor.identity(), [0, 0, rate])
    return ph.simulate(ph.Inertia.from_principal_moments(1, 2, 3), state, [0.0, duration])


def probe(path):
    entries = "stream=width,height,nb_frames,r_frame_rate,codec_name,pix_fmt,duration"
    done = processes.run(
        ["ffprobe", "-v", "error", "-of", "json", "-show_entries", entries, path], check=True
    )
    return json.loads(done.stdout)["streams"][0]


# --- frames


@pytest.mark.parametrize(("seconds", "fps", "count", "step"), [(None, 25.0, 250, 0.04), (5.0, 10.0, 50, 0.2)])
def test_frames_are_equally_spaced_and_true_speed_is_the_default(seconds, fps, count, step):
    times = frame_times(motion(), Plan("gif", fps, (64, 36), seconds))
    # Rounding of multiples of the step, of size 10.
    np.testing.assert_allclose(times, step * np.arange(count), rtol=0, atol=1e-14)


@pytest.mark.parametrize(("duration", "word"), [(0.05, "short"), (101, "long")])
def test_motions_too_long_or_short_for_true_speed_are_refused(duration, word, tmp_path, painted):
    with pytest.raises(
        ValueError, match=rf"lasts {duration} s, too {word} for a film at true speed.*seconds=12"
    ):
        spun(1.0, duration).film(tmp_path / "a.gif")
    spun(0.01, duration).film(tmp_path / "a.gif", seconds=0.4, fps=10, size=(16, 16))
    assert len(painted[0].times) == 4


@with_ffmpeg
def test_an_mp4_has_its_frames(tmp_path, painted):
    fractions = []
    motion().film(tmp_path / "a.mp4", seconds=0.5, fps=20, size=(192, 108), progress=fractions.append)
    assert probe(tmp_path / "a.mp4") == {
        "codec_name": "h264",
        "width": 192,
        "height": 108,
        "pix_fmt": "yuv420p",
        "r_frame_rate": "20/1",
        "duration": "0.500000",
        "nb_frames": "10",
    }
    np.testing.assert_allclose(fractions, np.arange(1, 11) / 10)
    motion().film(tmp_path / "b.mp4", seconds=0.5, fps=20, size=(192, 108))
    assert (tmp_path / "a.mp4").read_bytes() == (tmp_path / "b.mp4").read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.mp4", "b.mp4"]


def test_a_gif_has_its_frames(tmp_path, painted):
    spun(0.1, 10.0).film(tmp_path / "a.gif", seconds=0.5, fps=12, size=(161, 91))
    frames, durations = [], []
    with Image.open(tmp_path / "a.gif") as film:
        assert (film.size, film.n_frames, film.info["loop"]) == ((161, 91), 6, 0)
        for k in range(film.n_frames):
            film.seek(k)
            durations.append(film.info["duration"])
            frames.append(np.asarray(film.convert("RGB"), float))
    # In hundredths of a second a twelfth is 8 or 9, and half a second is 50.
    assert set(durations) == {80, 90}
    assert sum(durations) == 500
    for before, after in pairwise(frames):
        assert np.abs(after - before).mean() > 0.5
    # One palette for all: white stays white.
    for frame in frames:
        assert (frame[:, 90:] == 255).all()


def test_a_frame_has_its_time_and_title(tmp_path, painted):
    moved = spun(0.1, 10.0)
    moved.attributes["title"] = "A body"
    moved.film(tmp_path / "a.gif", seconds=0.4, fps=5, size=(32, 32))
    # First those from which the palette is made, then all.
    captured = [(when, options["note"], options["title"]) for when, options in painted[0].asked[-2:]]
    assert captured == [(0.0, "t = 0.00 s", "A body"), (5.0, "t = 5.00 s", "A body")]
    assert [options["played"] for _, options in painted[0].asked[-2:]] == [0.0, 0.2]


# --- speed


@pytest.mark.parametrize(("rate", "duration"), [(20.0, 10.0), (2e-5, 1e7), (700.0, 13.0)])
@pytest.mark.parametrize("fps", [10.0, 24.0, 25.0])
def test_a_stroboscopic_film_names_the_faithful_speed(rate, duration, fps):
    moved = spun(rate, duration)

    def problem(seconds):
        return stroboscopic(moved, Plan("gif", fps, (64, 36), seconds))

    message = problem(1.0)
    turns = rate * duration / fps / (2 * np.pi)
    assert f"by up to {turns:.3g} turns between frames" in message
    speed = float(re.search(r"faithful at up to (\S+) s of motion per second of film", message)[1])
    seconds = float(re.search(r"seconds=(\S+) or more", message)[1])
    # A quarter turn per frame; both are rounded to three digits, towards safety.
    assert 0.99 * np.pi / 2 < rate * speed / fps <= np.pi / 2
    assert problem(seconds) is None
    assert problem(0.98 * seconds) is not None


def test_a_film_that_cannot_be_faithful():
    message = stroboscopic(spun(1e6, 100.0), Plan("gif", 25.0, (64, 36), 12.0))
    assert message.endswith("film a shorter motion")


def test_a_stroboscopic_film_is_written_with_a_warning(tmp_path, painted):
    with pytest.warns(UserWarning, match="the film is stroboscopic: .* by up to 0.796 turns") as caught:
        spun(10.0, 1.0).film(tmp_path / "a.gif", seconds=2, fps=1, size=(64, 36))
    assert caught[0].filename == __file__
    assert (tmp_path / "a.gif").exists()


# --- refusals


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"path": "a.avi"}, ValueError, r"a film is saved as FILE\.mp4 or FILE\.gif, not 'a\.avi'"),
        ({"seconds": 0}, ValueError, "seconds is 0.0; it must be positive"),
        ({"fps": float("nan")}, ValueError, "fps is nan"),
        ({"fps": 60}, ValueError, "fps is 60; a GIF has at most 50 frames per second"),
        ({"seconds": 0.01}, ValueError, "times fps is 0; a film has 2 to 100000 frames"),
        ({"seconds": 1e9}, ValueError, "a film has 2 to"),
        ({"size": (8, 8)}, ValueError, "size is 8x8; width and height must be from 16 to 7680"),
        (
            {"path": "a.mp4", "size": (321, 180)},
            ValueError,
            "size is 321x180; width and height of an MP4 must be even",
        ),
        ({"size": 640}, ValueError, "size is 640; it must be width and height"),
        ({"view": "up"}, (ValueError, TypeError), "view"),
        ({"path": "none/a.gif"}, OSError, "no such directory: none"),
    ],
)
def test_invalid_films_are_refused(options, error, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    given = {"path": "a.gif", "seconds": 0.2, "size": (64, 36), **options}
    with pytest.raises(error, match=message):
        motion().film(given.pop("path"), **given)
    assert not list(tmp_path.iterdir())


def test_batches_and_motions_of_one_time_are_refused(tmp_path, painted):
    inertia = ph.Inertia.from_principal_moments(1, 2, 3)
    one = ph.simulate(inertia, ph.State(ph.Rotor.identity(), [0, 0, 1.0]), [1.0])
    with pytest.raises(ValueError, match="needs two different output times; this motion has one"):
        one.film(tmp_path / "a.gif")
    batch = ph.simulate(inertia, ph.State(ph.Rotor.identity(), [[0, 0, 1.0]]), [0.0, 1.0])
    with pytest.raises(ValueError, match="film is for one body"):
        batch.film(tmp_path / "a.gif")


def test_without_ffmpeg_the_error_names_it(tmp_path, monkeypatch, painted):
    monkeypatch.setenv("PATH", str(tmp_path))
    (tmp_path / "old.mp4").write_bytes(b"old")
    with pytest.raises(OSError, match=r"needs the program ffmpeg: install it \(Debian: apt install ffmpeg\)"):
        motion().film(tmp_path / "old.mp4")
    assert (tmp_path / "old.mp4").read_bytes() == b"old"
    assert [path.name for path in tmp_path.iterdir()] == ["old.mp4"]


@pytest.mark.parametrize("library", ["playwright", "PIL"])
def test_without_a_library_the_error_names_the_extra(library, tmp_path, monkeypatch, painted):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(ImportError, match=rf"needs {library}: pip install 'polhode\[film\]'"):
        motion().film(tmp_path / "a.gif")
    assert not list(tmp_path.iterdir())


def test_an_old_film_survives_a_failure(tmp_path, monkeypatch, painted):
    """An ffmpeg that fails, and a progress that raises, leave the old file and nothing else."""
    programs = tmp_path / "bin"
    programs.mkdir()
    (programs / "ffmpeg").write_text("#!/bin/sh\nread x\necho 'no room' >&2\nexit 1\n")
    (programs / "ffmpeg").chmod(0o755)
    old = tmp_path / "old.mp4"
    old.write_bytes(b"old")
    with monkeypatch.context() as changed:
        changed.setenv("PATH", f"{programs}{os.pathsep}{os.environ['PATH']}")
        with pytest.raises(OSError, match="ffmpeg failed: no room"):
            motion().film(old, seconds=0.4, size=(64, 36))

    def fails(fraction):
        raise RuntimeError("stop")

    for name in ("old.mp4", "old.gif") if shutil.which("ffmpeg") else ("old.gif",):
        (tmp_path / name).write_bytes(b"old")
        with pytest.raises(RuntimeError, match="stop"):
            motion().film(tmp_path / name, seconds=0.4, size=(64, 36), progress=fails)
        assert (tmp_path / name).read_bytes() == b"old"
    assert {path.name for path in tmp_path.iterdir()} <= {"bin", "old.mp4", "old.gif"}


@pytest.mark.usefixtures("painted")
@pytest.mark.parametrize("name", ["a.gif", pytest.param("a.mp4", marks=with_ffmpeg)])
def test_a_film_is_known_by_its_comment(name, tmp_path):
    """The same film, copied by another program without its comment, is not."""
    own, foreign = tmp_path / name, tmp_path / f"foreign-{name}"
    motion().film(own, seconds=0.4, size=(64, 36))
    assert is_own(own)
    content = own.read_bytes()
    assert content.count(b"Polhode") == 1
    for other in (content.replace(b"Polhode", b"Camera!"), content[:40], content[40:], b"x", b"x Polhode"):
        foreign.write_bytes(other)
        assert not is_own(foreign)


# --- the command


@pytest.mark.parametrize("name", ["a.gif", pytest.param("a.mp4", marks=with_ffmpeg)])
def test_the_command_keeps_films_of_others(name, scene):
    """It refuses them before the scene is run."""
    (scene.parent / name).write_bytes(b"GIF89a of a holiday")
    done = polhode("film", scene.name, "-o", name, cwd=scene.parent)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == (
        f"polhode: error: {name} exists and was not written by polhode: choose another name, or overwrite it "
        "with --force\n"
    )
    assert (scene.parent / name).read_bytes() == b"GIF89a of a holiday"


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["small.toml", "-o", "a.avi"], 2, "a film is saved as FILE.mp4 or FILE.gif, not 'a.avi'"),
        (
            ["small.toml", "-o", "a.gif", "--size", "640"],
            2,
            "expected WIDTHxHEIGHT in pixels, such as 1280x720",
        ),
        (["small.toml", "-o", "a.gif", "--fps", "-1"], 2, "fps is -1.0"),
        (["small.toml"], 2, "required: -o"),
        (["-o", "a.gif"], 2, "required: SCENE.toml"),
        ([str(EXAMPLES / "toutatis-uncertain.toml"), "-o", "a.gif"], 1, "has 100000 bodies"),
    ],
)
def test_the_command_refuses(arguments, code, message, scene):
    done = polhode("film", *arguments, cwd=scene.parent)
    assert done.returncode == code, done.stderr
    assert message in done.stderr
    assert [path.name for path in scene.parent.iterdir()] == ["small.toml"]


@with_ffmpeg
def test_the_command_films(tmp_path):
    """At true speed; the warning is one line, and progress is for terminals."""
    studios.require_browser()
    scene, target = tmp_path / "fast.toml", tmp_path / "a.mp4"
    scene.write_text(SCENE.replace("0.01, 1, 0.01", "0.01, 10, 0.01"))
    done = polhode("film", scene, "-o", target, "--fps", "4", "--size", "96x54", "--view", "-20,35")
    assert (done.returncode, done.stdout) == (0, f"Written\n  {target}\n")
    assert done.stderr.startswith(
        "polhode: warning: the film is stroboscopic: the body turns by up to 0.399 turns"
    )
    assert done.stderr.count("\n") == 1
    found = probe(target)
    assert (found["width"], found["height"], found["nb_frames"], found["duration"]) == (
        96,
        54,
        "4",
        "1.000000",
    )


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="needs /proc")
@pytest.mark.parametrize("name", ["old.gif", pytest.param("old.mp4", marks=with_ffmpeg)])
def test_ctrl_c_leaves_the_old_film(name, scene, tmp_path):
    """An interrupted command removes the file it began, ends its browser and exits with 130."""
    studios.require_browser()
    target = tmp_path / name
    target.write_bytes(b"old")
    command = [POLHODE, "film", scene, "-o", target, "--seconds", "4000", "--size", "64x36", "--force"]
    with processes.start(command, start_new_session=True) as process:
        while len(list(tmp_path.iterdir())) < 3:
            assert process.poll() is None, process.communicate(timeout=30)
            time.sleep(0.05)
        while not any(b"--type=renderer" in command for command in descendants(process.pid).values()):
            assert process.poll() is None, process.communicate(timeout=30)
            time.sleep(0.05)
        begun = descendants(process.pid)
        # As a terminal does: to the whole group.
        _, printed = processes.interrupted(process, lambda: os.killpg(process.pid, signal.SIGINT))
    assert process.returncode == 130, printed
    assert "interrupted; no file was changed" in printed
    assert "Traceback" not in printed
    assert target.read_bytes() == b"old"
    assert sorted(path.name for path in tmp_path.iterdir()) == [name, "small.toml"]
    # The last of them ends a little after the command. One that ended before its command was read has none.
    end = time.monotonic() + 60
    while left := [command for pid, command in begun.items() if command and command_of(pid) == command]:
        assert time.monotonic() < end, left
        time.sleep(0.05)


def command_of(pid):
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return b""


def descendants(pid):
    """The commands of the processes that a process started, directly or not, by their numbers."""
    found = {}
    for listed in Path(f"/proc/{pid}/task").glob("*/children"):
        for child in map(int, listed.read_text().split()):
            found |= {child: command_of(child), **descendants(child)}
    return found
