"""Programs started by tests, with a time limit and the default action for Ctrl-C."""

import contextlib
import signal
import subprocess
import threading
from subprocess import DEVNULL, PIPE

__all__ = ["DEVNULL", "PIPE", "interrupted", "limited", "run", "start"]

# Time limit in s: the slowest program takes 20 s on an idle machine.
LIMIT = 180.0

# A background job of a shell ignores Ctrl-C, and so do its children. With a handler here, programs
# that are started have the default action.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


def run(command, **options):
    """Return the finished process, with its output as text unless `options` differ."""
    captured = {"stdout": PIPE, "stderr": PIPE, "encoding": "utf-8", "timeout": LIMIT, "check": False}
    return subprocess.run(command, **captured | options)


@contextlib.contextmanager
def start(command, limit=LIMIT, **options):
    """Start a program; kill it at the end of the block or after a time limit."""
    captured = {"stdout": PIPE, "stderr": PIPE, "encoding": "utf-8"}
    with subprocess.Popen(command, **captured | options) as process, limited(process, limit):
        try:
            yield process
        finally:
            process.kill()  # no effect on a process that has ended


@contextlib.contextmanager
def limited(process, seconds=LIMIT):
    """Kill a process if the block takes too long."""
    timer = threading.Timer(seconds, process.kill)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def interrupted(process, press):
    """Return the output of a process that ends by Ctrl-C, which `press` sends.

    Python drops an interrupt during a destructor, so it is sent again.
    """
    for _ in range(4):
        press()
        with contextlib.suppress(subprocess.TimeoutExpired):
            return process.communicate(timeout=30)
    raise AssertionError("Ctrl-C did not end the program")
