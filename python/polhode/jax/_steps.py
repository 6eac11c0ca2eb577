"""Equal steps between given times, as in `crates/rigid/src/run/sweep.rs`."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from polhode._support.arrays import as_float, check_line, output_times
from polhode.jax._laws import Torque
from polhode.jax._library import Array, jax
from polhode.jax._table import Table

# Each step has its time and length in memory, 16 bytes.
_MOST_STEPS = 1e8


class Way(NamedTuple):
    """Successive target times from the start on, and the number of equal steps to each.

    `most` is the largest of these numbers; `even` is true if all are equal. `places` are the indices of the
    output times among the start (0) and the targets (from 1).
    """

    targets: Array
    counts: Array
    most: int
    even: bool
    places: tuple[int, ...]


def ways(
    times: Any, step: float | None, steps: int | None, torque: Torque, start: Any
) -> tuple[Any, list[tuple[Way, bool]]]:
    """Return the start time and the ways to all times, each with True if it goes back in time.

    Traced times, or a traced start, give one way forwards.
    """
    if (step is None) == (steps is None):
        raise ValueError("give either step, the longest step in s, or steps, their number between two times")
    if steps is not None and (not isinstance(steps, int) or steps < 1):
        raise ValueError(f"steps is {steps!r}; it must be a positive integer")
    tables = [law for law in torque.laws if isinstance(law, Table)]
    if isinstance(times, jax.core.Tracer) or isinstance(start, jax.core.Tracer):
        if steps is None:
            raise ValueError("with traced times the number of steps is unknown; give steps instead of step")
        when = jax.numpy.asarray(times)
        check_line(when.shape, times)
        counts = np.full(when.shape, steps)
        return start, [(Way(when, counts, steps, True, tuple(range(1, when.size + 1))), False)]
    when, begin = output_times(times), as_float(start, "start_time")
    _check(when, tables, begin)
    length = None if step is None else as_float(step, "step")
    if length is not None and not 0 < length < np.inf:
        raise ValueError(f"step is {length}; it must be positive and finite")
    breaks = np.unique([t for law in tables for t in law.times])
    back, forth = when[when < begin][::-1], when[when >= begin]
    found = [(_way(begin, forth, breaks, length, steps), False)]
    if back.size:
        found = [(_way(begin, back, breaks, length, steps), True), *found[: forth.size]]
    return begin, found


def _way(begin: float, when: Any, breaks: Any, step: float | None, steps: int | None) -> Way:
    """Add the times at which a law is not smooth."""
    targets: list[float] = []
    places = []
    at = begin
    for time in when.tolist():
        if time != at:
            between = breaks[(min(at, time) < breaks) & (breaks < max(at, time))].tolist()
            targets += [*(between if time > at else between[::-1]), time]
            at = time
        places.append(len(targets))
    counts = np.full(len(targets), steps or 1)
    if step is not None:
        spans = np.abs(np.diff(targets, prepend=begin))
        wanted = np.maximum(np.ceil(spans / step), 1.0)
        if wanted.sum() > _MOST_STEPS:
            raise ValueError(
                f"the run would take {wanted.sum():.1e} steps of {step:.3e} s, more than {_MOST_STEPS:.0e}; "
                "shorten it or ask for a longer step"
            )
        counts = wanted.astype(np.int64)
    even = bool((counts == counts[:1]).all())
    return Way(np.array(targets), counts, int(counts.max(initial=0)), even, tuple(places))


def _check(when: Any, tables: list[Table], start: float) -> None:
    if not np.isfinite(start):
        raise ValueError(f"start_time is {start}; it must be finite")
    for index, time in enumerate(when.tolist()):
        if not np.isfinite(time) or (index and time < when[index - 1]):
            raise ValueError(f"times[{index}] = {time}; times must be finite and must not decrease")
    first, last = when.min(initial=start), when.max(initial=start)
    for law in tables:
        rounding = 4 * np.finfo(float).eps * max(abs(law.times[0]), abs(law.times[-1]))
        if first < law.times[0] - rounding or last > law.times[-1] + rounding:
            raise ValueError(
                f"the table of torques spans {law.times[0]} s to {law.times[-1]} s, the motion {first} s to "
                f"{last} s; add rows for all times of the simulation"
            )
