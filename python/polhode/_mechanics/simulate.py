"""`simulate` and `simulate_blocks`: motions at given times from bodies, states, torques and forces."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from polhode import _native
from polhode._mechanics.arguments import (
    about_fixed_point,
    as_force,
    check_progress,
    checked_events,
    checked_threads,
    ensemble_of,
    step_limits,
)
from polhode._mechanics.ensemble import warn_of
from polhode._mechanics.problem import Problem
from polhode._mechanics.state import State
from polhode._mechanics.trajectory import BYTES_OF_POINT, Trajectory
from polhode._support.arrays import as_count
from polhode._support.blocks import in_blocks
from polhode._support.calls import explains_calls
from polhode._support.memory import require_array
from polhode.event import Event
from polhode.torque import Torque

# Default size of the results of a block, in bytes.
_BLOCK = 32 << 20


@explains_calls
def simulate(
    body: Any,
    state: State,
    times: Any,
    torque: Torque | Callable[..., Any] | None = None,
    force: Any = None,
    method: str = "auto",
    rtol: float | None = None,
    atol: float | None = None,
    step: float | None = None,
    *,
    max_step: float | None = None,
    max_steps: float | None = None,
    breaks: Any = (),
    events: Event | Sequence[Event] = (),
    threads: int | None = None,
    progress: Callable[[int, float], object] | None = None,
) -> Trajectory:
    """Return the motion of a body at given times: in closed form if there is one, else by integration.

    Bodies, states and parameters of torques and forces may be batches, whose shapes broadcast. Each body
    moves as it would alone, and a body that fails does not stop the others: see ``trajectory.failures``.

    Parameters
    ----------
    body
        A `Body` or its `Inertia` in kg m², or a nested sequence or array of them, (...). `ph.torque.gravity`
        fixes a body at its pivot, `ph.torque.heavy` at the origin of its axes; an inertia is then about the
        fixed point, whose position and velocity are those of the state.
    state
        The state at the start time ``state.time``; its values may be batches, (...).
    times
        Output times in s, (n,), not decreasing, on the same clock as ``state.time`` and the t of laws, such
        as ``np.linspace(0, 60, 601)``, or ``[60.0]`` for one. Times before the start are reached by
        integrating backwards.
    torque
        A law of `polhode.torque`, a sum of them, or a function as for `polhode.torque.function`; None for
        free motion. Parameters of laws may be batches, (...).
    force
        Force on the centre of mass: a law of `polhode.force`, a sum of them, a vector or (..., 3) in N for a
        constant force in space, or a function as for `polhode.force.function`. Requires a `Body`. Parameters
        of forces may be batches, (...).
    method
        ``"auto"``: ``"exact"`` where the motion has a closed form and no `step` is given (free bodies,
        symmetric ones under `heavy` along their axis, damping alone, spheres under `larmor`; constant forces,
        drag and springs); for torques that depend on attitude and time, symmetric splittings, which conserve
        energy in long runs: ``rkn6`` for symmetric bodies and ``kahan_li8`` for others; for torques that
        depend on the angular velocity, and for other forces, ``dop853``, an adaptive Runge–Kutta method of
        order 8 on the group of rotors. Or one of these by name, or ``strang`` (order 2), ``yoshida4``,
        ``yoshida6``, ``kahan_li6``, ``rk4``, ``midpoint``, ``dmv``. A batch without a `step` is ``exact``
        where possible, else ``dop853`` with steps of its own for each body. Where the laws are stiff, as
        under strong damping, ``"auto"`` uses ``midpoint``.
    rtol, atol
        Without a `step`, the steps are refined until the estimated error at output times and events is less
        than the larger of the two: in the rotor; in the angular velocity, relative to its maximum or, if
        larger, to the rate √(N/i) of the swing of the largest moment i under the torque N; and likewise for
        the centre of mass under forces. The estimate includes the measured amplification of rounding by the
        motion. A result whose estimate exceeds the tolerance is an error. By default the tolerance is 1e-10,
        or up to 1e-6 where rounding allows no less; the certificate has the estimate.
    step
        A fixed step in s, shortened slightly so that steps end at the output times. The error is then not
        estimated; a law that changes too fast for it, or a body that turns by more than 2 rad in a step,
        raises a `RuntimeWarning`.
    max_step
        The longest step in s. Laws that depend on time are sampled at 4096 times first, and steps are
        shortened where they change; a pulse shorter than 1/4096 of the run needs `max_step` or `breaks`.
    max_steps
        Maximum number of steps of a pass; 1e8 by default, 1e10 with a `step`. A run predicted to exceed it
        is an error.
    breaks
        Times in s, (k,), at which steps end: where a law jumps, or before and after a short pulse.
    events
        Events of `polhode.event` to detect, one or several; see ``trajectory.events``. Not for a batch.
    threads
        Number of threads for a batch; None for ``POLHODE_NUM_THREADS``, or all cores. The results have the
        same bits for any number.
    progress
        Called repeatedly with the number of the pass (from 1) and the fraction of it done. Ctrl-C stops the
        run.

    Raises
    ------
    ValueError
        For invalid input, a tolerance that was not reached, or too many steps; in a batch, for input that is
        invalid for all bodies.
    MemoryError
        If the results of a batch would not fit into memory; raised before anything is computed.

    Examples
    --------
    A T-handle, spun about its middle axis, turns over again and again:

    >>> handle = ph.Inertia.from_principal_moments(1.755e-4, 2.354e-4, 3.930e-4)
    >>> start = ph.State(ph.Rotor.identity(), [0.3, 10 * np.pi, 0.3])  # 5 rev/s about e2
    >>> flips = ph.event.spin(ph.e3 ^ ph.e1)
    >>> motion = ph.simulate(handle, start, np.linspace(0, 3, 301), events=flips)
    >>> np.diff(motion.events[0].time).round(3)
    array([0.9, 0.9])

    A fast top, a disc on a pivot 5 cm below it, precesses at about ``m g l/L3``:

    >>> top = ph.Body.disc(0.1, mass=1).moved(position=[0, 0, 0.05])
    >>> tilted = ph.State(ph.Rotor.from_plane_angle(ph.e2 ^ ph.e3, 0.5), [0, 0, 500])
    >>> motion = ph.simulate(top, tilted, np.linspace(0, 1, 101), ph.torque.gravity(top))
    >>> motion.certificate.method
    'exact'
    >>> x, y, _ = motion.rotor(ph.e3).components.T
    >>> turn = np.unwrap(np.arctan2(y, x))
    >>> print(f"{turn[-1] - turn[0]:.2f}, {9.81 * 0.05 / (0.005 * 500):.2f} rad/s")
    0.20, 0.20 rad/s
    """
    limits = step_limits(max_step, max_steps, breaks)
    bodies, law = about_fixed_point(body, torque)
    ensemble = ensemble_of(bodies, state, times, law, force, method, rtol, atol, step, limits)
    check_progress(progress)
    wanted = checked_events(events)
    count = checked_threads(threads)
    if ensemble.shape:
        if wanted:
            raise ValueError(
                f"events are not supported for batches, got batch shape {ensemble.shape}; "
                "simulate the bodies one by one"
            )
        return ensemble.run(count, progress)
    require_array(ensemble.times.shape, "states at times", BYTES_OF_POINT)
    inertia = ensemble.inertias[()]
    motion = _native.simulate(
        inertia._core,
        float(ensemble.start_times),
        ensemble.rotors,
        ensemble.omegas,
        list(ensemble.laws),
        np.concatenate([ensemble.positions, ensemble.velocities]),
        float(ensemble.masses),
        list(ensemble.forces),
        ensemble.times,
        ensemble.method,
        ensemble.step,
        ensemble.rtol,
        ensemble.limits,
        [event.law for event in wanted],
        progress,
    )
    problem = Problem(
        bodies[()],
        state,
        law,
        None if force is None else as_force(force),
        ensemble.times,
        ensemble.method,
        ensemble.step,
        ensemble.rtol,
        ensemble.limits,
    )
    names = [event.name for event in wanted]
    trajectory = Trajectory._of(motion, inertia, names, problem, ensemble.wheels)
    warn_of(trajectory.certificate)
    return trajectory


@explains_calls
def simulate_blocks(
    body: Any,
    state: State,
    times: Any,
    torque: Torque | Callable[..., Any] | None = None,
    force: Any = None,
    method: str = "auto",
    rtol: float | None = None,
    atol: float | None = None,
    step: float | None = None,
    *,
    max_step: float | None = None,
    max_steps: float | None = None,
    breaks: Any = (),
    block: int | None = None,
    threads: int | None = None,
    progress: Callable[[int, float], object] | None = None,
) -> Iterator[tuple[slice, Trajectory]]:
    """Yield the motions of a batch in blocks, so that they need not fit into memory together.

    Each block is a slice of the first batch axis and the `Trajectory` of these bodies, with the same bits as
    ``simulate(…)[slice]``. Reduce each block in the loop, for example to `Moments`.

    The other parameters and the errors are those of `simulate`. Invalid arguments are reported by the call,
    other errors with the first block.

    Parameters
    ----------
    block
        Number of rows of the first axis in a block; None for about 32 MB of results.
    progress
        Called repeatedly with 1 and the fraction of all blocks done. Ctrl-C stops the run.

    Examples
    --------
    The mean rate of 1000 damped balls, which start at rates from 0 to 1.998 rad/s:

    >>> spins = np.arange(1000)[:, np.newaxis] * [0, 0, 0.002]
    >>> starts = ph.State(ph.Rotor.identity(), spins)
    >>> rates = ph.Moments()
    >>> ball = ph.Body.sphere(1, mass=1)
    >>> law = ph.torque.damping(0.5)
    >>> for rows, motion in ph.simulate_blocks(ball, starts, [0, 1], law, block=256):
    ...     _ = rates.add(motion.omega_body.norm())
    >>> rates.mean.round(3)  # 0.999 and 0.999 exp(-0.5)
    array([0.999, 0.606])
    """
    limits = step_limits(max_step, max_steps, breaks)
    bodies, law = about_fixed_point(body, torque)
    ensemble = ensemble_of(bodies, state, times, law, force, method, rtol, atol, step, limits)
    check_progress(progress)
    if not ensemble.shape:
        raise ValueError("simulate_blocks needs a batch of bodies, got one body; use simulate")
    if block is not None and as_count(block, "block") < 1:
        raise ValueError(f"block must be at least 1, got {block}")
    count, length = checked_threads(threads), ensemble.shape[0]
    size = block or max(1, _BLOCK * length // max(ensemble.bytes, 1))
    blocks = in_blocks(slice(0, length), size, progress)
    return ((rows, ensemble.block(rows).run(count, report)) for rows, report in blocks)
