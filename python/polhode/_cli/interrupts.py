"""Handling of the signals SIGINT, as of Ctrl-C, and SIGTERM, as of ``kill``."""

import _thread
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

from polhode import _start

# The handlers that are replaced; another program that runs the command may have its own.
_REPLACED: dict[int, tuple[Any, ...]] = {
    signal.SIGTERM: (signal.SIG_DFL,),
    signal.SIGINT: (signal.SIG_IGN, signal.default_int_handler, _start.stop),
}
# Seconds after which a signal that came during an import is sent again.
_RETRY_DELAY = 0.02

# The signals that came in each block that delays them, from the outermost.
_delayed: list[list[int]] = []


@contextmanager
def interruptible(received: list[int]) -> Iterator[None]:
    """Let both signals raise a KeyboardInterrupt, so that the command removes its unfinished files.

    Ctrl-C does so even in a command that was started to ignore it, as a background job of a script: ``kill
    -INT`` always stops a long run and keeps the complete bodies. The list gets the numbers of the signals.
    """
    imports, retries = _imports(sys._getframe()), dict[int, threading.Timer]()

    def interrupt(number: int, frame: FrameType | None) -> None:
        retries.pop(number, None)
        if _delayed:
            _delayed[-1].append(number)
            return
        if _imports(frame) > imports:
            # An import may lose the exception, or leave a library that crashes when the program ends.
            retries[number] = threading.Timer(_RETRY_DELAY, _send, [number])
            retries[number].daemon = True
            retries[number].start()
            return
        received.append(number)
        raise KeyboardInterrupt

    # Python handles signals in the main thread only.
    is_main = threading.current_thread() is threading.main_thread()
    before = {number: signal.getsignal(number) for number in _REPLACED if is_main}
    before = {number: old for number, old in before.items() if old in _REPLACED[number]}
    try:
        for number in before:
            signal.signal(number, interrupt)
        yield
        for number in list(retries):
            interrupt(number, None)
    finally:
        for timer in retries.values():
            timer.cancel()
        for number, old in before.items():
            signal.signal(number, old)


@contextmanager
def uninterruptible() -> Iterator[None]:
    """Delay both signals to the end of the block, in a block that is `interruptible`."""
    waiting: list[int] = []
    _delayed.append(waiting)
    try:
        yield
    finally:
        _delayed.pop()
        if waiting:
            signal.raise_signal(signal.SIGTERM if signal.SIGTERM in waiting else waiting[0])


def _send(number: int) -> None:
    """Send a signal to the main thread, which wakes it where the system can."""
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.main_thread().ident or 0, number)
    else:
        _thread.interrupt_main(signal.Signals(number))


def _imports(frame: FrameType | None) -> int:
    """Return the number of frames of imports in a stack."""
    count = 0
    while frame is not None:
        count += frame.f_code.co_filename.startswith("<frozen importlib")
        frame = frame.f_back
    return count
