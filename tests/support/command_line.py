"""Runs of the command as a program, and a small scene."""

import json
import os
import sys
from pathlib import Path

import processes

POLHODE = Path(sys.executable).with_name("polhode")
ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"

SCENE = """\
title = "Small"
[body]
moments = [1, 2, 3]
[initial]
spin = { vector = [0.01, 1, 0.01] }
[run]
duration = "1 s"
samples = 11
"""


def polhode(*arguments, cwd=None, through=(), **options):
    """The finished process, started by `through` if given; it must not print a traceback."""
    # Buffered output, as in a shell.
    environment = {**os.environ, **options.pop("env", {})}
    environment.pop("PYTHONUNBUFFERED", None)
    done = processes.run([*through, POLHODE, *arguments], cwd=cwd, env=environment, **options)
    assert "Traceback" not in done.stderr, done.stderr
    assert "Exception ignored" not in done.stderr, done.stderr
    return done


def summary_of(path, *arguments):
    done = polhode("run", path, "--json", *arguments)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)
