"""Ctrl-C while the command ``polhode`` starts: exit code 130 without a traceback."""

import os
import signal
import sys

_INTERRUPTED = 130


def _is_command() -> bool:
    """Whether this process runs the command, as ``polhode`` or as ``python -m polhode``."""
    program = os.path.basename(sys.argv[0]) if getattr(sys, "argv", None) else ""
    return program in ("polhode", "polhode.exe") or sys.orig_argv[1:3] == ["-m", "polhode"]


def stop(*_: object) -> None:
    """Handle Ctrl-C while nothing has been written yet."""
    os._exit(_INTERRUPTED)


# `main` sets the handler that lets a run keep its complete bodies.
if _is_command() and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    signal.signal(signal.SIGINT, stop)
