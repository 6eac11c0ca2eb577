"""Rows of the tables: check that libraries agree on a task, then time them in turns."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field, replace
from timeit import Timer
from typing import Any

import numpy as np

OURS = "polhode"
OUR_CALLS, OUR_CALLS_INTO = "calls", "calls, out="  # our separate calls, in rows for a whole formula
Read = Callable[[Any], Any]


@dataclass(frozen=True)
class Pace:
    """Duration of the measurements: the best of `rounds` runs of at least `span` seconds; rows in a batch.

    Sections with long runs skip those that would take more than `limit` seconds of CPU time.
    """

    span: float
    rounds: int
    batch: int
    limit: float


FULL = Pace(span=0.1, rounds=7, batch=1_000_000, limit=8.0)
QUICK = Pace(span=0.01, rounds=2, batch=100_000, limit=0.5)


@contextmanager
def noted(notes: dict[str, str], name: str) -> Iterator[None]:
    """Record an exception in the block as a note under that name."""
    try:
        yield
    except ImportError as error:
        notes[name] = f"not installed ({error})"
    except Exception as error:
        notes[name] = f"{type(error).__name__}: {error}".splitlines()[0]


@dataclass(frozen=True)
class Entry:
    """The expression that a library runs, the names in it, and the number of its results."""

    code: str
    names: dict[str, Any]
    count: int


@dataclass
class Row:
    """One task, with an entry for every library that can do it.

    The first entry is the reference. The others must give the same numbers to `tolerance` times the largest
    one, in our conventions: `read` converts the result. A library without an entry has a note.

    Attributes
    ----------
    what, goal
        Title of the row, and the target.
    count
        Number of results; times are per result.
    unit
        ``"ns"``, ``"us"`` or ``"ms"``.
    traffic
        Bytes per result that memory must move, inputs and outputs; 0 where memory is not a limit.
    one_core
        Whether all libraries run on one core.
    """

    what: str
    goal: str = ""
    count: int = 1
    unit: str = "ns"
    traffic: int = 0
    tolerance: float = 1e-12
    one_core: bool = False
    entries: dict[str, Entry] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)
    notes: dict[str, str] = field(default_factory=dict)
    expected: Any = None

    def enter(
        self, library: str, code: str, names: dict[str, Any], read: Read, count: int | None = None
    ) -> None:
        """Add a library: `read` converts the value of `code`, evaluated with `names`, to (count, ...).

        `count` is smaller than that of the row for a library that gets only the first values.
        """
        result = np.asarray(read(eval(code, dict(names))))
        if self.expected is None:
            self.expected = result
        expected = self.expected if count is None else self.expected[:count]
        size = np.abs(expected).max(initial=1e-300)
        if result.shape != expected.shape:
            raise ValueError(f"gives shape {result.shape}, not {expected.shape}")
        if not (off := np.abs(result - expected).max(initial=0.0) / size) <= self.tolerance:
            raise ValueError(f"disagrees by {off:.1e} of the largest")
        number = self.count if count is None else min(count, self.count)
        self.entries[library] = Entry(code, names, number)

    def peer(self, library: str) -> AbstractContextManager[None]:
        """Return a context for the set-up and entry of another library: a failure becomes a note."""
        return noted(self.notes, library)

    @contextmanager
    def planned(self) -> Iterator[None]:
        """Record a feature that this version lacks as a note."""
        try:
            yield
        except (AttributeError, TypeError) as error:
            self.notes[OURS] = f"not available ({error})"

    def measure(self, pace: Pace) -> None:
        """Time all entries in turns, so that disturbances affect all of them; keep the best time of each."""
        timers = {
            library: Timer(entry.code, globals=dict(entry.names)) for library, entry in self.entries.items()
        }
        numbers = {library: _enough(timer, pace.span) for library, timer in timers.items()}
        for _ in range(pace.rounds):
            for library, timer in timers.items():
                each = timer.timeit(numbers[library]) / (numbers[library] * self.entries[library].count)
                self.seconds[library] = min(each, self.seconds.get(library, np.inf))

    def release(self) -> None:
        """Release the values, which may be large; keep expressions and times."""
        self.expected = None
        self.entries = {name: replace(entry, names={}) for name, entry in self.entries.items()}

    def ahead(self) -> float | None:
        """Return the time of the fastest other library divided by ours."""
        ours = (OURS, OUR_CALLS, OUR_CALLS_INTO)
        peers = [seconds for library, seconds in self.seconds.items() if library not in ours]
        return min(peers) / self.seconds[OURS] if peers and OURS in self.seconds else None


def _enough(timer: Timer, span: float) -> int:
    """Return the number of runs that takes `span` seconds."""
    number = 1
    while (taken := timer.timeit(number)) < span / 2:
        number = max(2 * number, min(100 * number, round(number * span / max(taken, 1e-9))))
    return number
