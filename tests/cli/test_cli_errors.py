"""Errors of the command: places in scenes, exit codes, and files left behind."""

import errno
import json
import os
import re
import signal
import sys
import time

import pytest

import polhode as ph
import processes
from command_line import SCENE, polhode
from viewers import needs_bundle

# Runs for hours.
ENDLESS = SCENE.replace('"1 s"', '"1e6 s"').replace("samples = 11", 'step = "1 ms"\nmethod = "kahan_li8"')


# --- bad scenes: exact places

BAD = {
    "near miss": (
        SCENE.replace("duration", "durration"),
        "7:1: error: unknown field `durration`, expected `duration`\n"
        '  |\n7 | durration = "1 s"\n  | ^^^^^^^^^\n',
    ),
    "wrong type": (
        SCENE.replace("samples = 11", 'samples = "11"'),
        '8:11: error: expected a whole number, found a string\n  |\n8 | samples = "11"\n  |           ^^^^\n',
    ),
    "wrong unit": (
        SCENE.replace('"1 s"', '"1 kg"'),
        "7:12: error: ",
    ),
    "no such unit": (SCENE.replace('"1 s"', '"1 parsnip"'), "7:12: error: "),
    "impossible body": (
        SCENE.replace("[1, 2, 3]", "[1, 1, 3]"),
        "3:11: error: no body has the principal moments 1.0, 1.0, 3.0: i3 = 3.0 exceeds",
    ),
    "missing mesh": (
        SCENE.replace("moments = [1, 2, 3]", 'mesh = "absent.stl"\nmass = 1'),
        "3:8: error: ",
    ),
    "no gravity without mass": (
        SCENE.replace("[run]", "[gravity]\nacceleration = 9.81\n[run]"),
        "2:1: error: gravity acts on the mass, add the field `mass`",
    ),
    "negative duration": (SCENE.replace('"1 s"', "-1"), "7:12: error: must be more than 0, found -1"),
    "one sample": (SCENE.replace("11", "1"), "8:11: error: must be from 2 to 10000000, found 1"),
    "unknown method": (
        SCENE + 'method = "euler"\n',
        "9:10: error: unknown method `euler`, expected one of `auto`",
    ),
    "a thin rod": (
        SCENE.replace("moments = [1, 2, 3]", 'solid = "rod"\nlength = 1\nmass = 1'),
        "3:9: error: principal moments",
    ),
    "no TOML": (SCENE.replace("= 11", "11"), "8:9: error: "),
    "not finite": (SCENE.replace("0.01, 1", "nan, 1"), "5:20: error: `nan` is not a finite number"),
}


@pytest.mark.parametrize("name", BAD)
@pytest.mark.parametrize("command", ["run", pytest.param("check", marks=pytest.mark.slow)])
def test_bad_scenes_have_a_place(name, command, tmp_path):
    text, expected = BAD[name]
    (tmp_path / "bad.toml").write_text(text)
    done = polhode(command, "bad.toml", cwd=tmp_path)
    assert done.returncode == 3
    assert f"bad.toml:{expected}" in done.stderr
    assert "^" in done.stderr
    assert done.stdout == ""


@pytest.mark.parametrize(
    ("name", "content", "parts"),
    [
        ("latin.toml", b'title = "caf\xe9"\n', ["latin.toml:1:13", "UTF-8"]),
        ("utf16.toml", "[run]\n".encode("utf-16-le"), ["utf16.toml:1:2: error: byte 1 is zero"]),
        ("empty.toml", b"", ["empty.toml: error: the file is empty", "[body], [initial] and [run]"]),
        ("noise.toml", bytes(range(256)), ["noise.toml:2:118: error: not UTF-8"]),
        ("huge.toml", b"#" * 10_000_001, ["huge.toml: error: larger than 10 MB"]),
    ],
)
def test_files_that_are_not_scenes(name, content, parts, tmp_path):
    (tmp_path / name).write_bytes(content)
    done = polhode("run", name, cwd=tmp_path)
    assert done.returncode == 3
    for part in parts:
        assert part in done.stderr


def test_paths_that_are_not_files(tmp_path):
    absent = polhode("run", "absent.toml", cwd=tmp_path)
    assert absent.returncode == 3
    assert absent.stderr == "absent.toml: error: no such file\n"
    folder = polhode("run", tmp_path)
    assert folder.returncode == 3
    assert "is a directory" in folder.stderr


def test_errors_of_the_system_name_the_file_and_the_reason(command, scene, tmp_path, monkeypatch):
    (tmp_path / "a.csv").write_text("mine")

    def denied(*_, **__):
        raise PermissionError(errno.EACCES, "Permission denied", "a.csv")

    monkeypatch.setattr("polhode._report.output.is_own", denied)
    done = command("run", str(scene), "-o", "a.csv", "--no-figures")
    assert (done.returncode, done.stderr) == (1, "polhode: error: a.csv: permission denied\n")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
@pytest.mark.parametrize(
    "arguments", [["check"], ["run"], ["view", "--no-browser"], ["fit"], ["eval", "-f"]], ids=lambda x: x[0]
)
def test_a_named_pipe_is_refused(arguments, tmp_path, command):
    """Opening it would wait for a writer, and Ctrl-C would not end that."""
    os.mkfifo(tmp_path / "pipe")
    done = command(*arguments, "pipe")
    assert done.returncode == 3
    assert "pipe: error: not a regular file" in done.stderr


@pytest.mark.skipif(not os.path.exists("/dev/zero"), reason="needs devices")
def test_a_device_is_not_read_without_end(command):
    done = command("fit", "/dev/zero")
    assert (done.returncode, done.stderr) == (3, "/dev/zero: error: not a regular file\n")


@pytest.mark.skipif(os.name != "posix", reason="needs a shell")
def test_standard_error_may_be_closed(scene):
    """As in some schedulers of jobs; errors must not go to standard output."""
    closed = ("sh", "-c", 'exec "$@" 2>&-', "sh")
    done = polhode("run", scene, "--json", through=closed)
    assert (done.returncode, json.loads(done.stdout)["title"]) == (0, "Small")
    done = polhode("run", "absent.toml", through=closed)
    assert (done.returncode, done.stdout, done.stderr) == (3, "", "")


def test_files_that_must_not_be_read(command, tmp_path, monkeypatch):
    """The system of a superuser may read them."""
    (tmp_path / "a.nc").write_bytes(b"\x89HDF")
    monkeypatch.setattr("os.access", lambda path, mode: mode != os.R_OK)
    done = command("convert", "a.nc", "b.aem")
    assert (done.returncode, done.stderr) == (3, "a.nc: error: no permission to read it\n")


def test_a_missing_mesh_is_named(tmp_path):
    (tmp_path / "bad.toml").write_text(BAD["missing mesh"][0])
    done = polhode("run", "bad.toml", cwd=tmp_path)
    assert "absent.stl: cannot be read" in done.stderr


def test_all_errors_are_reported_at_once(tmp_path):
    text = SCENE.replace("duration", "durration").replace("spin", "spinn").replace("= 11", "= 1")
    (tmp_path / "bad.toml").write_text(text)
    done = polhode("run", "bad.toml", cwd=tmp_path)
    assert done.returncode == 3
    places = [line.split(": error:")[0] for line in done.stderr.splitlines() if ": error:" in line]
    assert {"bad.toml:5:1", "bad.toml:7:1", "bad.toml:8:11"} <= set(places)
    lines = [int(place.split(":")[1]) for place in places]
    assert lines == sorted(lines)


OTHERS = {
    "a.nc": (b"\x89HDF\r\n", "a motion in netCDF: `polhode view a.nc` shows it"),
    "motion": (b"\x89HDF\r\n", "a motion in netCDF: `polhode view motion` shows it"),
    "a.csv": (b"t,wx\n", "a table of a motion: `polhode convert a.csv FILE` converts it"),
    "a.obj": (b"v 1 2 3\n", "a mesh: `polhode check a.obj` checks it"),
    "a.png": (b"\x89PNG\r\n", "a picture, which is written, not read"),
    "a.md": (b"---\n", "a lesson: `polhode view a.md` shows it"),
    "a.tab": (b" 1 2.5 -3e1\n4 5 6\n", "a table of numbers: meshes are STL, OBJ or PLY files"),
}


@pytest.mark.parametrize("name", OTHERS)
def test_a_file_that_is_not_a_scene_is_named(name, tmp_path, command):
    content, kind = OTHERS[name]
    (tmp_path / name).write_bytes(content)
    commands = [("run", name), ("figure", "motion", name, "-o", "z.png"), ("film", name, "-o", "z.gif")]
    if name != "a.obj":
        commands.append(("check", name))
    for asked in commands:
        done = command(*asked)
        assert done.returncode == 3
        assert done.stderr.startswith(f"{name}: error: not a scene but {kind}")
        assert done.stdout == ""


def test_a_scene_may_have_any_name(tmp_path, command):
    (tmp_path / "small").write_text(SCENE)
    assert command("check", "small").returncode == 0


# --- usage


def test_options_may_stand_between_arguments(tmp_path, command):
    (tmp_path / "a.toml").write_text(SCENE)
    (tmp_path / "b.toml").write_text(SCENE)
    done = command("check", "a.toml", "--mass", "2", "b.toml")
    assert (done.returncode, done.stdout.count(": ok, ")) == (0, 2)
    done = command("eval", "--let", "a=2", "a", "--json", "a a")
    assert [one["repr"] for one in json.loads(done.stdout)] == ["2", "4"]
    done = command("figure", "polhode", "-o", "a.jpg", "a.toml")
    assert (done.returncode, "not 'a.jpg'" in done.stderr) == (2, True)
    done = command("figure", "polhode", "--view", "1,2", "absent.toml", "-o", "a.svg")
    assert done.stderr == "absent.toml: error: no such file\n"
    for arguments in (("run", "a.toml", "--quiet", "b.toml"), ("figure", "1", "-o", "a.svg", "a", "b")):
        done = command(*arguments)
        assert (done.returncode, done.stdout) == (2, "")
        assert "unrecognized arguments: b" in done.stderr


@pytest.mark.parametrize(
    ("first", "remedy"),
    [
        ("a.toml", "'a.toml' is not a command; try `polhode run a.toml`"),
        ("a.nc", "'a.nc' is not a command; try `polhode view a.nc`"),
        ("chekc", "'chekc' is not a command; did you mean `polhode check`?"),
        ("zzz", "invalid choice: 'zzz' (choose from"),
        ("--rum", "the following arguments are required: COMMAND"),
    ],
)
def test_a_first_argument_that_is_not_a_command(first, remedy, command):
    done = command(first)
    assert (done.returncode, done.stdout) == (2, "")
    assert remedy in done.stderr


# --- runs that fail


def test_a_drift_past_the_bound_is_4(tmp_path):
    (tmp_path / "a.toml").write_text(SCENE + 'step = "0.1 s"\nmethod = "strang"\ndrift_bound = 1e-30\n')
    done = polhode("run", "a.toml", "-o", "a.nc", cwd=tmp_path)
    assert done.returncode == 4
    assert "FAILED" in done.stdout
    assert "1e-30" in done.stdout
    assert (tmp_path / "a.nc").exists()
    result = polhode("run", "a.toml", "--json", cwd=tmp_path)
    assert result.returncode == 4
    assert json.loads(result.stdout)["run"]["drift_within_bound"] is False


def test_an_unreachable_tolerance_is_1(tmp_path):
    text = SCENE.replace("[run]", "[gravity]\nacceleration = 9.81\n[run]").replace(
        "[1, 2, 3]", "[1, 2, 3]\nmass = 1\ncenter_of_mass = [0.1, 0.2, 0.3]"
    )
    (tmp_path / "a.toml").write_text(text + "rtol = 1e-18\n")
    done = polhode("run", "a.toml", "-o", "a.nc", cwd=tmp_path)
    assert done.returncode == 1
    assert done.stderr.startswith("polhode: error: rtol = 1.0e-18 was not reached")
    assert not (tmp_path / "a.nc").exists()


def test_too_many_steps_are_refused_at_once(tmp_path):
    (tmp_path / "a.toml").write_text(SCENE + 'step = "1e-15 s"\nmethod = "strang"\n')
    done = polhode("run", "a.toml", cwd=tmp_path)
    assert done.returncode == 1
    assert "longer step" in done.stderr


@pytest.mark.parametrize(
    ("output", "parts"),
    [
        ("nowhere/out.nc", ["nowhere/out.nc", "no such directory: nowhere"]),
        ("folder.nc", ["folder.nc", "not a regular file"]),
        ("full.nc", ["full.nc", "not a regular file"]),
    ],
)
def test_outputs_that_cannot_be_written(output, parts, scene, tmp_path):
    (tmp_path / "folder.nc").mkdir()
    (tmp_path / "full.nc").symlink_to("/dev/full")
    before = sorted(tmp_path.iterdir())
    done = polhode("run", scene, "-o", output, cwd=tmp_path)
    assert done.returncode == 1
    assert done.stderr.startswith("polhode: error: cannot write ")
    for part in parts:
        assert part in done.stderr
    assert sorted(tmp_path.iterdir()) == before
    assert scene.read_text() == SCENE


@pytest.mark.parametrize("output", ["out.txt", "/dev/full", "small.toml", ".nc", ""])
def test_an_output_with_another_suffix_is_a_usage_error(output, scene, tmp_path):
    before = sorted(tmp_path.iterdir())
    done = polhode("run", scene, "-o", output, cwd=tmp_path)
    assert done.returncode == 2
    assert f"a motion is saved as FILE.nc, FILE.csv or FILE.parquet, not '{output}'" in done.stderr
    assert sorted(tmp_path.iterdir()) == before


def test_figures_that_cannot_be_written_are_found_before_the_run(scene, tmp_path):
    (tmp_path / "a-motion.png").mkdir()
    done = polhode("run", scene, "-o", "a.nc", cwd=tmp_path)
    assert done.returncode == 1
    assert "a-motion.png: it exists and is not a regular file" in done.stderr
    assert done.stdout == ""


@pytest.mark.parametrize("spin", ["[1e160, 1e160, 1e10]", "[1e300, 1, 1]"])
def test_overflow_is_refused_without_output(spin, tmp_path):
    (tmp_path / "a.toml").write_text(re.sub(r"vector = \[.*?\]", f"vector = {spin}", SCENE))
    done = polhode("run", "a.toml", "--json", cwd=tmp_path)
    assert done.returncode == 1
    assert done.stdout == ""
    assert "must be finite" in done.stderr


def test_a_path_that_is_not_utf_8(tmp_path):
    done = polhode("check", os.fsencode(tmp_path) + b"/\xff.toml")
    assert done.returncode == 3
    assert "error:" in done.stderr


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_directory_without_permission(scene, tmp_path):
    (tmp_path / "locked").mkdir(mode=0o500)
    done = polhode("run", scene, "-o", tmp_path / "locked" / "out.nc")
    assert done.returncode == 1
    assert "permission" in done.stderr


# Limits the size of files to the first argument, as on a full disk, and runs a program.
LIMITED = """
import os, resource, signal, sys
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
size = int(sys.argv[1])
resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
os.execv(sys.argv[2], sys.argv[2:])
"""


# 4 kB stop the data (about 18 kB), 32 kB stop the figures.
@pytest.mark.parametrize(("size", "name"), [(4096, "out.nc"), (32768, "out-motion.png")])
def test_a_full_disk_leaves_the_older_files(size, name, scene, tmp_path):
    older = {}
    for file in ("out.nc", "out-motion.png", "out-polhode.png"):
        (tmp_path / file).write_bytes(f"older {file}".encode())
        older[file] = (tmp_path / file).read_bytes()
    done = polhode(
        *("run", scene, "--force", "-o", tmp_path / "out.nc"),
        through=[sys.executable, "-c", LIMITED, str(size)],
    )
    assert done.returncode == 1
    assert f"cannot write {tmp_path / name}" in done.stderr
    assert "too large" in done.stderr.lower()
    # A run writes its files all or none: data of one run beside figures of another would mislead.
    assert {file: (tmp_path / file).read_bytes() for file in older} == older
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted([*older, "small.toml"])


# 8 kB stop the first variables of the file, 200 kB a block.
@pytest.mark.parametrize("size", [8192, 200_000])
def test_a_full_disk_ends_the_run_of_an_ensemble(size, scene, tmp_path):
    """HDF5 crashes after a write that failed."""
    scene.write_text(SCENE + '[ensemble]\nnumber = 2000\nattitude = "uniform"\n')
    done = polhode(
        *("run", scene, "--no-figures", "-o", "out.nc"),
        through=[sys.executable, "-c", LIMITED, str(size)],
        cwd=tmp_path,
    )
    assert (done.returncode, done.stderr) == (1, "polhode: error: cannot write out.nc: File too large\n")
    assert list(tmp_path.iterdir()) == [scene]


def test_a_symbolic_link_stays(scene, tmp_path):
    """A file is written where the link points to."""
    (tmp_path / "disk").mkdir()
    for name, there in (("link.csv", "disk/old.csv"), ("new.csv", "disk/new.csv")):
        (tmp_path / name).symlink_to(there)
    (tmp_path / "disk" / "old.csv").write_text("t\n")
    for name in ("link.csv", "new.csv"):
        done = polhode("run", scene, "--no-figures", "--force", "-o", name, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        assert (tmp_path / name).is_symlink()
        assert len(ph.io.read(tmp_path / name)) == 11
    assert sorted(x.name for x in (tmp_path / "disk").iterdir()) == ["new.csv", "old.csv"]


@pytest.mark.parametrize(
    "command",
    [
        ("eval",),
        ("run", "long.toml"),
        pytest.param(("view", "small.toml", "--no-browser"), marks=needs_bundle),
    ],
    ids=lambda command: command[0],
)
def test_ctrl_c_ends_a_background_job_of_a_script(command, scene):
    """Such a job starts with the signal ignored; the shell execs the command."""
    (scene.parent / "long.toml").write_text(ENDLESS)
    program = "from polhode._cli.main import main; print('go', flush=True); raise SystemExit(main())"
    through = ["bash", "-c", 'trap "" INT; exec "$@"', "bash", sys.executable, "-c", program]
    with processes.start([*through, *command], cwd=scene.parent, stdin=processes.PIPE) as process:
        assert process.stdout.readline() == "go\n"
        time.sleep(1.0)
        assert process.poll() is None
        process.send_signal(signal.SIGINT)
        assert process.wait() == 130


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_interrupted_run_leaves_no_file(number, code, tmp_path):
    (tmp_path / "long.toml").write_text(ENDLESS)
    (tmp_path / "out.nc").write_bytes(b"older")
    program = "from polhode._cli.main import main; print('go', flush=True); raise SystemExit(main())"
    command = [sys.executable, "-c", program, "run", "long.toml", "--force", "-o", "out.nc"]
    with processes.start(command, cwd=tmp_path) as process:
        assert process.stdout.readline() == "go\n"
        time.sleep(1.0)
        assert process.poll() is None
        process.send_signal(number)
        output, errors = process.communicate()
    assert process.returncode == code, errors
    assert "interrupted" in errors
    assert "Traceback" not in errors
    assert output == ""
    assert (tmp_path / "out.nc").read_bytes() == b"older"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["long.toml", "out.nc"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_during_an_import_interrupt_after_it(number, tmp_path):
    """An interrupted import may be swallowed, as by NumPy, or crash at the end of the program."""
    (tmp_path / "slow.py").write_text(f"import signal\nsignal.raise_signal({int(number)})\ncomplete = True\n")
    program = """
import time
from polhode._cli.interrupts import interruptible

received = []
try:
    with interruptible(received):
        import slow
        time.sleep(60)
except KeyboardInterrupt:
    print(slow.complete, *received)
"""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])}
    # The signal wakes the program, long before it would end.
    done = processes.run([sys.executable, "-c", program], env=environment, timeout=50)
    assert (done.stdout, done.stderr) == (f"True {int(number)}\n", "")


def test_signals_in_a_block_that_delays_them_come_at_its_end():
    """That to terminate has precedence; neither is lost where the block fails."""
    program = """
import signal
from polhode._cli.interrupts import interruptible, uninterruptible
signal.signal(signal.SIGTERM, signal.SIG_DFL)
received = []
try:
    with interruptible(received), uninterruptible():
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGTERM)
        print(*received)
        raise OSError("the disk is full")
except KeyboardInterrupt:
    print(*received)
"""
    done = processes.run([sys.executable, "-c", program])
    assert (done.stdout, done.stderr) == (f"\n{int(signal.SIGTERM)}\n", "")


def test_a_signal_is_handled_where_the_program_runs_in_an_import(tmp_path):
    (tmp_path / "inner.py").write_text("""
import signal
from polhode._cli.interrupts import interruptible
received = []
try:
    with interruptible(received):
        signal.raise_signal(signal.SIGINT)
        received.append("no interrupt")
except KeyboardInterrupt:
    print(*received)
""")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])}
    done = processes.run([sys.executable, "-c", "import inner"], env=environment)
    assert (done.stdout, done.stderr) == (f"{int(signal.SIGINT)}\n", "")


@pytest.mark.skipif(os.name == "nt", reason="Windows has no signal for another process")
def test_ctrl_c_while_the_command_starts(tmp_path):
    """It comes while NumPy is imported, of which a traceback would tell nothing."""
    (tmp_path / "numpy").mkdir()
    (tmp_path / "numpy" / "__init__.py").write_text(
        "import os, signal, time\nos.kill(os.getpid(), signal.SIGINT)\ntime.sleep(60)\n"
    )
    paths = [str(tmp_path), os.path.dirname(os.path.dirname(ph.__file__))]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
    done = processes.run([sys.executable, "-m", "polhode", "list"], env=environment)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "")
