"""The signals that end the command: that of Ctrl-C, and that to terminate, as of ``kill``."""

import _thread
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

from polhode import _start

# The handlers that are replaced; another program that runs the command may have its own.
_REPLACED: dict[int, tuple[Any, ...]] = {
    signal.SIGINT: (signal.SIG_IGN, signal.default_int_handler, _start.stop),
    signal.SIGTERM: (signal.SIG_DFL,),
}
# Seconds after which a signal is handled that came during an import.
_LATER = 0.02


@contextmanager
def interruptible(received: list[int]) -> Iterator[None]:
    """Let both signals raise a KeyboardInterrupt, so that the command removes its unfinished files.

    Ctrl-C does so even in a command that was started to ignore it, as a background job of a script: ``kill
    -INT`` always stops a long run and keeps the complete bodies. The list gets the numbers of the signals.
    """

    def interrupt(number: int, frame: FrameType | None) -> None:
        if _is_importing(frame):
            # An import may lose the exception, or leave a library that crashes when the program ends.
            later = threading.Timer(_LATER, _thread.interrupt_main, [number])
            later.daemon = True
            later.start()
            return
        received.append(number)
        raise KeyboardInterrupt

    with _handled(interrupt, lambda number, old: old in _REPLACED[number]):
        yield


@contextmanager
def uninterruptible() -> Iterator[None]:
    """Delay both signals to the end of the block."""
    waiting: list[int] = []
    # A handler of another language is None.
    with _handled(lambda number, _: waiting.append(number), lambda _, old: old is not None):
        yield
    if waiting:
        signal.raise_signal(waiting[0])


@contextmanager
def _handled(
    handler: Callable[[int, FrameType | None], None], replaces: Callable[[int, Any], bool]
) -> Iterator[None]:
    """Handle both signals by a function where it replaces the number's handler."""
    # Python handles signals in the main thread only.
    is_main = threading.current_thread() is threading.main_thread()
    before = {number: signal.getsignal(number) for number in _REPLACED} if is_main else {}
    before = {number: old for number, old in before.items() if replaces(number, old)}
    for number in before:
        signal.signal(number, handler)
    try:
        yield
    finally:
        for number, old in before.items():
            signal.signal(number, old)


def _is_importing(frame: FrameType | None) -> bool:
    while frame is not None:
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            return True
        frame = frame.f_back
    return False
