"""Films of scenes: their pictures, their files, and what happens where one cannot be made."""

import json
import os
import re
import shutil
import signal
import time
from itertools import pairwise

import numpy as np
import pytest

import polhode as ph
import processes
from command_line import EXAMPLES, POLHODE, SCENE, polhode

pytest.importorskip("matplotlib")
from PIL import Image

from polhode._figures.camera import View
from polhode._figures.film import Plan, frame, stroboscopic
from polhode._figures.stage import Stage
from polhode._figures.style import OMEGA

with_ffmpeg = pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="ffmpeg is not installed")


def motion():
    inertia = ph.Inertia.from_principal_moments(1, 2, 3)
    state = ph.State(ph.Rotor.from_components([4, -2, 1, 2]), [0.25, -0.5, 1.0])
    return ph.simulate(inertia, state, np.linspace(0, 10, 201))


def probed(path):
    shown = "stream=width,height,nb_frames,r_frame_rate,codec_name,pix_fmt"
    told = processes.run(["ffprobe", "-v", "error", "-of", "json", "-show_entries", shown, path], check=True)
    return json.loads(told.stdout)["streams"][0]


@with_ffmpeg
def test_an_mp4_has_its_pictures(tmp_path):
    fractions = []
    motion().film(tmp_path / "a.mp4", seconds=0.5, fps=20, size=(192, 108), progress=fractions.append)
    assert probed(tmp_path / "a.mp4") == {
        "codec_name": "h264",
        "width": 192,
        "height": 108,
        "pix_fmt": "yuv420p",
        "r_frame_rate": "20/1",
        "nb_frames": "10",
    }
    np.testing.assert_allclose(fractions, np.arange(1, 11) / 10)
    motion().film(tmp_path / "b.mp4", seconds=0.5, fps=20, size=(192, 108))
    assert (tmp_path / "a.mp4").read_bytes() == (tmp_path / "b.mp4").read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.mp4", "b.mp4"]


def test_a_gif_has_its_pictures(tmp_path):
    motion().film(tmp_path / "a.gif", seconds=0.8, fps=12.5, size=(161, 91))
    with Image.open(tmp_path / "a.gif") as film:
        assert (film.size, film.n_frames, film.info["duration"]) == ((161, 91), 10, 80)
        assert film.info["loop"] == 0
        pictures = []
        for k in range(film.n_frames):
            film.seek(k)
            pictures.append(np.asarray(film.convert("RGB"), float))
    # The body turns by more than a radian from one to the next: no two are alike.
    for before, after in pairwise(pictures):
        assert np.abs(after - before).mean() > 0.5
    # All are on white paper, with something drawn.
    for picture in pictures:
        assert (picture[45, :5] == 255).all()
        assert (picture < 250).any()


def test_a_picture_shows_its_moment():
    """The rim of Ω, pulled back into the plane across the axis of its moment, is a circle."""
    moved = motion()
    stage, view = Stage(moved, (50, 30)), View(50, 30)
    for when in (0.0, 3.3, 10.0):
        figure = frame(stage, when, 2.0, (320, 180))
        assert any(text.get_text() == f"t = {when:.2f} s" for text in figure.texts)
        np.testing.assert_allclose(figure.get_size_inches() * figure.dpi, (320, 180))
        rims = [
            np.array(line.get_data()).T
            for line in figure.axes[0].lines
            if line.get_color() == OMEGA and len(line.get_xdata()) > 50
        ]
        state = moved.at(when)
        omega = state.rotor(state.omega_body)
        n = (omega / omega.norm()).dual().components
        across = np.concatenate(rims) @ view.basis
        points = across - np.outer(across @ n / (view.toward @ n), view.toward)
        radii = np.linalg.norm(points, axis=1)
        np.testing.assert_allclose(radii, radii[0], rtol=1e-9)


def test_the_trace_is_the_path_up_to_now():
    stage = Stage(motion())
    lengths = np.linalg.norm(stage.path, axis=1)
    np.testing.assert_allclose(lengths, np.linalg.norm(stage.traced), rtol=1e-12)
    state = stage.trajectory.at(stage.path_times)
    np.testing.assert_allclose(state.rotor(ph.vector(stage.traced)).components, stage.path, atol=1e-12)


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"path": "a.avi"}, ValueError, r"a film is saved as FILE\.mp4 or FILE\.gif, not 'a\.avi'"),
        ({"seconds": 0}, ValueError, "seconds is 0.0; it must be positive"),
        ({"fps": float("nan")}, ValueError, "fps is nan"),
        ({"seconds": 0.01}, ValueError, "times fps is 0; a film has 2 to 100000 pictures"),
        ({"seconds": 1e9}, ValueError, "a film has 2 to"),
        ({"size": (8, 8)}, ValueError, "size is 8x8; width and height must be from 16 to 7680"),
        (
            {"path": "a.mp4", "size": (321, 180)},
            ValueError,
            "size is 321x180; of an MP4 width and height must be even",
        ),
        ({"size": 640}, ValueError, "size is 640; it must be width and height"),
        ({"view": "up"}, (ValueError, TypeError), "view"),
        ({"path": "none/a.gif"}, OSError, "there is no directory none"),
    ],
)
def test_films_that_cannot_be_are_refused(options, error, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    given = {"path": "a.gif", "seconds": 0.2, "size": (64, 36), **options}
    with pytest.raises(error, match=message):
        motion().film(given.pop("path"), **given)
    assert not list(tmp_path.iterdir())


def spun(rate, duration):
    """A body that turns evenly, in rad/s, for so many s."""
    state = ph.State(ph.Rotor.identity(), [0, 0, rate])
    return ph.simulate(ph.Inertia.from_principal_moments(1, 2, 3), state, [0.0, duration])


@pytest.mark.parametrize(("rate", "duration"), [(20.0, 10.0), (2e-5, 1e7), (700.0, 13.0)])
@pytest.mark.parametrize("fps", [10.0, 24.0, 25.0])
def test_a_stroboscopic_film_says_how_slow_it_must_be(rate, duration, fps):
    moved = spun(rate, duration)

    def problem(seconds):
        return stroboscopic(moved, Plan("gif", fps, round(seconds * fps), (64, 36)))

    told = problem(1.0)
    turns = rate * duration / (round(fps) - 1) / (2 * np.pi)
    assert f"by up to {turns:.3g} turns from one picture to the next" in told
    speed = float(re.search(r"faithful at up to (\S+) s of motion in a second of film", told)[1])
    seconds = float(re.search(r"seconds=(\S+) or more", told)[1])
    # A quarter turn in a picture; both are rounded to three digits, to the safe side.
    assert 0.99 * np.pi / 2 < rate * speed / fps <= np.pi / 2
    assert problem(seconds) is None
    assert problem(0.98 * seconds) is not None


def test_a_film_that_no_number_of_pictures_makes_faithful():
    told = stroboscopic(spun(1e6, 100.0), Plan("gif", 25.0, 300, (64, 36)))
    assert told.endswith("film a shorter motion")


def test_a_stroboscopic_film_is_made_with_a_warning(tmp_path):
    with pytest.warns(
        UserWarning, match="the film is stroboscopic: the body turns by up to 1.59 turns"
    ) as told:
        spun(10.0, 1.0).film(tmp_path / "a.gif", seconds=2, fps=1, size=(64, 36))
    assert told[0].filename == __file__
    assert (tmp_path / "a.gif").exists()
    path = tmp_path / "fast.toml"
    path.write_text(SCENE.replace("0.01, 1, 0.01", "0.01, 10, 0.01"))
    done = polhode("film", path, "-o", tmp_path / "b.gif", "--seconds", "2", "--fps", "1", "--size", "64x36")
    assert (done.returncode, done.stdout) == (0, f"Written\n  {tmp_path / 'b.gif'}\n")
    assert done.stderr.startswith(
        "polhode: warning: the film is stroboscopic: the body turns by up to 1.6 turns"
    )
    assert done.stderr.count("\n") == 1


def test_batches_and_motions_of_one_time_are_refused(tmp_path):
    inertia = ph.Inertia.from_principal_moments(1, 2, 3)
    one = ph.simulate(inertia, ph.State(ph.Rotor.identity(), [0, 0, 1.0]), [1.0])
    with pytest.raises(ValueError, match="2 output times or more; this one has 1"):
        one.film(tmp_path / "a.gif")
    batch = ph.simulate(inertia, ph.State(ph.Rotor.identity(), [[0, 0, 1.0]]), [0.0, 1.0])
    with pytest.raises(ValueError, match="film is for one body"):
        batch.film(tmp_path / "a.gif")


def test_without_ffmpeg_it_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    (tmp_path / "old.mp4").write_bytes(b"old")
    with pytest.raises(OSError, match=r"needs the program ffmpeg: install it \(Debian: apt install ffmpeg\)"):
        motion().film(tmp_path / "old.mp4")
    assert (tmp_path / "old.mp4").read_bytes() == b"old"
    assert [path.name for path in tmp_path.iterdir()] == ["old.mp4"]


def test_an_old_film_survives_a_failure(tmp_path, monkeypatch):
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


def test_the_command_films(scene, tmp_path):
    target = tmp_path / "a.gif"
    done = polhode("film", scene, "-o", target, "--seconds", "0.2", "--fps", "10", "--size", "64x36")
    # Progress is for terminals alone.
    assert (done.returncode, done.stderr, done.stdout) == (0, "", f"Written\n  {target}\n")
    with Image.open(target) as film:
        assert (film.size, film.n_frames) == ((64, 36), 2)


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["small.toml", "-o", "a.avi"], 2, "a film is saved as FILE.mp4 or FILE.gif, not 'a.avi'"),
        (["small.toml", "-o", "a.gif", "--size", "640"], 2, "expected WIDTHxHEIGHT in pixels, as 1280x720"),
        (["small.toml", "-o", "a.gif", "--fps", "-1"], 1, "fps is -1.0"),
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


@pytest.mark.parametrize("name", ["old.gif", pytest.param("old.mp4", marks=with_ffmpeg)])
def test_ctrl_c_leaves_the_old_film(name, scene, tmp_path):
    """Stopped in the middle, the command removes what it began and ends with 130."""
    target = tmp_path / name
    target.write_bytes(b"old")
    command = [POLHODE, "film", scene, "-o", target, "--seconds", "4000", "--size", "64x36"]
    with processes.start(command, start_new_session=True) as process:
        while len(list(tmp_path.iterdir())) < 3:
            assert process.poll() is None
            time.sleep(0.05)
        time.sleep(0.3)
        # As a terminal does: to the whole group.
        _, told = processes.interrupted(process, lambda: os.killpg(process.pid, signal.SIGINT))
    assert process.returncode == 130, told
    assert "interrupted; no file was changed" in told
    assert "Traceback" not in told
    assert target.read_bytes() == b"old"
    assert sorted(path.name for path in tmp_path.iterdir()) == [name, "small.toml"]
