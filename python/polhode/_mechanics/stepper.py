"""`Stepper`: bodies stepped in a loop, under torques that the caller holds over each step."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from polhode import _native
from polhode._algebra.constructors import as_bivectors, bivector, vector
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.arguments import about_fixed_point, ensemble_of
from polhode._mechanics.ensemble import check_state
from polhode._mechanics.foreign_tables import STEPPER
from polhode._mechanics.laws import one_of
from polhode._mechanics.parameters import check_finite
from polhode._mechanics.registry import FRAMES
from polhode._mechanics.state import State
from polhode._mechanics.sums import Sum
from polhode._support.arrays import Array, Shape, as_float, as_floats
from polhode._support.calls import explains_calls_of
from polhode._support.foreign_names import ListsOwnNames, with_foreign_names

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from polhode.torque import Torque

METHODS = tuple(_native.methods())
_NO_TORQUE = np.zeros((0, 3))


@with_foreign_names(STEPPER)
@explains_calls_of
class Stepper(metaclass=ListsOwnNames):
    """A body, or a batch of bodies side by side, stepped in a loop: for controllers and learning.

    Each call of `step` holds a torque over a time dt, as a computer that controls a satellite does. With a
    torque table of ``kind="previous"`` and the same method and step, `simulate` gives the same motion to
    rounding. The bodies of a batch have one time; none depends on the others::

        satellite = ph.Stepper(body, state, ph.torque.magnetic(dipole, field))
        while satellite.time < 600:
            satellite.step(0.1, torque=controller(satellite.state))

    Parameters
    ----------
    body, state, torque, force
        As for `simulate`: the shapes of batches broadcast, `torque` and `force` act besides the held torque.
    method
        ``"auto"``, which is ``"rk4"``, the fastest, of order 4; or any other method of `simulate` except
        ``"exact"``.
    step
        The longest step of the method, in s: a longer dt consists of equal shorter steps. By default each dt
        is one step, with an error of some (ω·dt)⁵/100 rad for ``"rk4"``. A step in which a body turns by
        more than 1 rad is an error.

    Attributes
    ----------
    state
        The `State` now.
    time
        The time in s now; it begins at ``state.time``.
    shape
        Shape of the batch; ``()`` for one body.

    Raises
    ------
    ValueError
        For invalid input, for bodies with different times, and in `step` for a body that turns too far.
        Then no state has changed.

    Examples
    --------
    A controller brakes a body that spins at 1 rad/s with a torque of −2 Ω:

    >>> ball = ph.Inertia.from_principal_moments(4, 4, 4)
    >>> satellite = ph.Stepper(ball, ph.State(ph.Rotor.identity(), [0, 0, 1]))
    >>> while satellite.time < 2:
    ...     _ = satellite.step(0.125, torque=-2 * satellite.state.omega_body)
    >>> satellite
    Stepper(t = 2 s)
    >>> satellite.state.omega_body.components.round(4)  # (1 − 0.125 · 2/4)^16
    array([0.    , 0.    , 0.3561])
    """

    __slots__ = ("_core", "_still", "shape")

    shape: Shape

    def __init__(
        self,
        body: Any,
        state: State,
        torque: Torque | Callable[..., Any] | None = None,
        force: Any = None,
        method: str = "auto",
        step: float | None = None,
    ) -> None:
        if method not in ("auto", *METHODS):
            raise ValueError(f"unknown method {method!r}, expected one of auto, {', '.join(METHODS)}")
        longest = math.inf if step is None else as_float(step, "step")
        if not longest > 0:
            raise ValueError(f"step must be positive, got {step}")
        bodies, law = about_fixed_point(body, torque)
        setup = ensemble_of(bodies, state, [0.0], law, force, method, None, None, step, (None, None, []))
        if not math.prod(setup.shape):
            raise ValueError(f"a stepper needs at least one body, got batch shape {setup.shape}")
        self.shape = setup.shape
        self._core = _native.Stepper(
            setup.shape,
            (setup.inertias.ravel().tolist(), setup.inertias.shape),
            _common_time(setup.start_times),
            setup.rotors,
            setup.omegas,
            list(setup.laws),
            _centers(setup.positions, setup.velocities),
            setup.masses,
            list(setup.forces),
            "rk4" if method == "auto" else method,
            longest,
        )
        self._rest()

    @property
    def time(self) -> float:
        """The time in s now."""
        return self._core.time

    @property
    def state(self) -> State:
        """The state now, of the batch shape."""
        rotors, omegas = self._core.spins()
        still = self._still
        if still is None:
            positions, velocities = self._core.centers()
            still = (vector(positions, copy=False), vector(velocities, copy=False))
        return State._of(Rotor._from_rows(rotors), bivector(omegas, copy=False), *still, self._core.time)

    def step(
        self,
        dt: float,
        torque: Multivector | ArrayLike | None = None,
        frame: Literal["body", "space"] = "body",
        wheel_torque: ArrayLike | None = None,
    ) -> State:
        """Step by dt and return the state.

        Parameters
        ----------
        dt
            Length in s; negative for back in time.
        torque
            Torque in N m held over dt, a bivector or its components (..., 3), for all bodies or for each. It
            acts besides the laws of the stepper. None for no torque.
        frame
            Axes of its components, with which it turns: ``"body"`` or ``"space"``.
        wheel_torque
            Torques commanded from now on to the motors of `polhode.torque.reaction_wheels`, instead of those
            of the law: (..., k) in N m, for all bodies or for each. None keeps the previous command.

        Examples
        --------
        >>> ball = ph.Inertia.from_principal_moments(4, 4, 4)
        >>> satellite = ph.Stepper(ball, ph.State(ph.Rotor.identity(), [0, 0, 0]))
        >>> satellite.step(0.5, torque=[0, 0, 2]).omega_body.components.round(12)  # N dt/i
        array([0.  , 0.  , 0.25])
        """
        core, seconds, in_space = self._core, _seconds(dt), one_of(FRAMES, frame, "frame") == "space"
        if wheel_torque is not None:
            core.command(self._commands(wheel_torque))
        spin = core.step_once(seconds, torque, in_space)
        if spin is None or self._still is None:
            if spin is None:
                core.step(seconds, _NO_TORQUE if torque is None else self._rows(torque), in_space)
            return self.state
        return State._of(*spin, *self._still, core.time)

    @property
    def wheel_speed(self) -> Array:
        """Speeds of the reaction wheels relative to their bodies now, (..., k) in rad/s."""
        return self._core.wheel_speeds()

    def reset(self, state: State) -> None:
        """Set the state of all bodies, and with it the time; reaction wheels follow their law again.

        Examples
        --------
        >>> ball = ph.Inertia.from_principal_moments(4, 4, 4)
        >>> start = ph.State(ph.Rotor.identity(), [0, 0, 1])
        >>> satellite = ph.Stepper(ball, start)
        >>> _ = satellite.step(0.5)
        >>> satellite.reset(start)
        >>> satellite.time
        0.0
        """
        check_state(state)
        shape = state.shape
        if np.broadcast_shapes(shape, self.shape) != self.shape:
            raise ValueError(f"the state has batch shape {shape}, but the stepper {self.shape}")
        self._core.reset(
            _common_time(np.asarray(state.time)),
            np.ascontiguousarray(state.rotor._data, float),
            state.omega_body._data,
            _centers(state.position._data, state.velocity._data),
        )
        self._rest()

    def __repr__(self) -> str:
        bodies = f"bodies {self.shape}, " if self.shape else ""
        return f"Stepper({bodies}t = {self.time:.6g} s)"

    def _rest(self) -> None:
        """Note positions that do not change."""
        self._still = None
        if not self._core.moves:
            positions, velocities = self._core.centers()
            self._still = (vector(positions), vector(velocities))

    def _commands(self, torques: Any) -> Array:
        """Return a row of commands for all bodies, or one for each."""
        count, rows = self._core.wheels, as_floats(torques, "wheel_torque")
        if not count:
            raise ValueError("the stepper has no wheels to command; give it a law ph.torque.reaction_wheels")
        check_finite(np.atleast_1d(rows), "wheel_torque")
        shape = (count,) if rows.ndim < 2 else (*self.shape, count)
        try:
            return np.ascontiguousarray(np.broadcast_to(rows, shape))
        except ValueError:
            wanted = dict.fromkeys((str((*self.shape, count)), str((count,))))
            raise ValueError(
                f"wheel_torque must be of shape {' or '.join(wanted)}, got {rows.shape}"
            ) from None

    def _rows(self, torque: Any) -> Array:
        if isinstance(torque, Sum) or (callable(torque) and not isinstance(torque, Multivector)):
            raise TypeError(
                "step takes the numbers of a torque held over dt; give a law or a function to "
                "Stepper(body, state, torque)"
            )
        rows = as_bivectors(torque, "the torque")
        if rows.shape == (3,):
            return rows
        try:
            return np.ascontiguousarray(np.broadcast_to(rows, (*self.shape, 3)))
        except ValueError:
            raise ValueError(
                f"the torque has batch shape {rows.shape[:-1]}, but the stepper {self.shape}"
            ) from None


def _seconds(dt: Any) -> float:
    seconds = dt if type(dt) is float else as_float(dt, "dt")
    if not math.isfinite(seconds):
        raise ValueError(f"dt must be finite, got {seconds}")
    return seconds


def _common_time(times: Array) -> Array:
    if not (times == times.flat[0]).all():
        raise ValueError(
            f"the bodies of a stepper have one time, got {times.min()} s to {times.max()} s; "
            "use a stepper for each"
        )
    return np.asarray(times.flat[0], float)


def _centers(positions: Array, velocities: Array) -> Array:
    return np.ascontiguousarray(np.concatenate(np.broadcast_arrays(positions, velocities), axis=-1))
