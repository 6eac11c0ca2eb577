"""`FreeMotion`: torque-free motion, exact at any time, its curves, invariants and derivatives."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _native
from polhode._algebra.coefficients import as_coefficients
from polhode._algebra.constructors import bivector
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.bodies import Inertia, objects_of
from polhode._mechanics.state import State, angular_velocity
from polhode._support.arrays import (
    Array,
    Shape,
    as_count,
    as_float,
    as_floats,
    batch_index,
    frozen,
    hands_out_copies,
)
from polhode._support.memory import require

if TYPE_CHECKING:
    from polhode import _outputs

_STATE = 7 * 8  # bytes
_DERIVATIVES = 2 * 64 * 8  # bytes, of the core's arrays and their copies
_BODY = 800  # upper bound of the bytes of a motion in a batch
_EQUAL = 8 * float(np.finfo(float).eps)  # relative difference of moments that count as equal
_MANY = 64  # number of bodies that fills the SIMD lanes


class FreeMotion:
    """Torque-free motion of any body, or of a batch of bodies, exact at any time.

    Jacobi's solution: the rotor is four theta series and one uniform turn about L, the angular velocity
    three elliptic functions. Their phases are reduced in double-double arithmetic, so the error stays at
    rounding level up to t = 1e12, also near the separatrix. The rotor is continuous in time on the double
    cover. Moments that differ are never treated as equal, nor small rates as zero: thin bodies and spins
    close to an axis are resolved. For a matrix that is not diagonal, rounding of the moments and axes adds
    a turn of about ``ε |ω| t``.

    Parameters
    ----------
    inertia
        An `Inertia` in kg m², or a nested sequence or array of them.
    rotor
        From body axes to space axes at time 0.
    omega_body
        Angular velocity in body axes at time 0, a bivector or an array (..., 3), in rad/s.

    Batch shapes broadcast to `shape`; ``m[i]`` indexes the batch as in NumPy. The bodies of a batch are
    computed in SIMD lanes, in any regimes.

    Raises
    ------
    ValueError
        If a moment is zero or a number is not finite; the message has the batch index.
    """

    _core: _native.FreeMotion
    _inertia: Any  # an Inertia, or an array of them of the batch's shape

    def __init__(self, inertia: Any, rotor: Rotor, omega_body: Any) -> None:
        core = None
        if isinstance(inertia, Inertia):
            core = _native.FreeMotion.single(inertia._core, rotor, omega_body)
        self._core, self._inertia = (core, inertia) if core else _batch(inertia, rotor, omega_body)

    @property
    def shape(self) -> Shape:
        """Shape of the batch of bodies; ``()`` for one."""
        return self._core.shape

    def __getitem__(self, index: Any) -> FreeMotion:
        parts, _, _ = batch_index(index, self.shape)
        numbers = np.arange(int(np.prod(self.shape))).reshape(self.shape)
        return self._picked(numbers[parts], self._core.starts())

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError("a single motion has no length; only batches have")
        return self.shape[0]

    def __iter__(self) -> Iterator[FreeMotion]:
        numbers = np.arange(len(self) * int(np.prod(self.shape[1:])))
        starts = self._core.starts()
        return (self._picked(rows, starts) for rows in numbers.reshape(self.shape))

    def _picked(self, rows: Any, starts: tuple[Array, Array]) -> FreeMotion:
        rotors, omegas = starts
        inertia = self._inertia if isinstance(self._inertia, Inertia) else self._inertia.ravel()[rows]
        return type(self)(inertia, Rotor._from_rows(rotors[rows]), bivector(omegas[rows]))

    def __reduce__(self) -> tuple[Any, ...]:
        rotors, omegas = self._core.starts()
        rotor = Rotor._from_rows(rotors.reshape(*self.shape, 4))
        return type(self), (self._inertia, rotor, bivector(omegas.reshape(*self.shape, 3)))

    def __repr__(self) -> str:
        if self.shape:
            return f"{type(self).__name__}(batch {self.shape})"
        return f"{type(self).__name__}({self.describe()['regime']}, {self._inertia!r})"

    def at(self, t: Any) -> State:
        """Return the states of all bodies at all times t in s, of batch shape ``m.shape + t.shape``.

        Each has the same bits as a single motion at a single time. A ValueError for times that are not
        finite, or so large that the phase is lost to rounding (1e17 turns); a MemoryError if the states
        would not fit into memory.
        """
        state, times = self._core.once(t), t
        if state is None:
            times = as_floats(t, "time")
            shape = self.shape + times.shape
            require(_STATE * math.prod(shape), f"states of batch shape {shape}")
            rotors, omegas = self._core.at(np.ravel(times))
            state = Rotor._from_rows(rotors.reshape(*shape, 4)), _bivectors(omegas, shape)
        return State._at_origin(*state, times)

    def at_each(self, t: Any) -> State:
        """Return the state of each body at its own time or times t in s.

        Times broadcast with the batch of bodies, to the batch shape of the state: bodies (N,) and times (N,)
        give (N,), one time for each body; times (T, N), or bodies (N, 1) and times (N, T), give T for each.
        Each state has the same bits as a single motion at a single time. Errors as in `at`, and a ValueError
        if the shapes do not broadcast.
        """
        times = as_floats(t, "time")
        try:
            shape = np.broadcast_shapes(self.shape, times.shape)
        except ValueError:
            raise ValueError(
                f"times of shape {times.shape} do not broadcast with bodies of batch shape {self.shape}; "
                "`at` evaluates every body at all times"
            ) from None
        order, each = _order(self.shape, shape)
        # The times, and a copy of the states where they are reordered.
        size = 8 + _STATE * (1 if order == tuple(range(len(shape))) else 2)
        require(size * math.prod(shape), f"states of batch shape {shape}")
        self._check_each(times, shape)
        computed = np.broadcast_to(times, shape).transpose(order)
        rotors, omegas = self._core.at_each(computed.ravel(), each)
        back = (*np.argsort(order), len(order))
        rows = np.ascontiguousarray(rotors.reshape(*computed.shape, 4).transpose(back))
        rates = np.ascontiguousarray(omegas.reshape(*computed.shape, 3).transpose(back))
        return State._at_origin(Rotor._from_rows(rows), _bivectors(rates, shape), times)

    def _check_each(self, times: Array, shape: Shape) -> None:
        """Raise a ValueError unless the times are finite and within the horizons of their bodies."""
        if not math.prod(shape) or np.abs(times).max() <= self._core.horizon:
            return
        for index in np.argwhere(~np.isfinite(times)):
            raise ValueError(f"time {times[tuple(index)]} at index {_index(index)} is not finite")
        horizons = np.broadcast_to(self._core.horizons().reshape(self.shape), shape)
        for index in np.argwhere(np.abs(times) > horizons):
            own = index[len(shape) - len(self.shape) :]
            body = _index(np.minimum(own, np.array(self.shape) - 1))
            time, horizon = np.broadcast_to(times, shape)[tuple(index)], horizons[tuple(index)]
            raise ValueError(
                f"at index {_index(index)}: time {time:g} s of body {body} is beyond {horizon:.1e} s, "
                "where the phase of the rotation is lost to rounding; use times closer to 0"
            )

    def describe(self) -> dict[str, Any]:
        """Return the regime, periods and invariants of the motion.

        - ``regime``, a name; ``axis``, the principal axis (1, 2, 3) that the polhode encircles; ``modulus``
          k of the elliptic functions; ``energy`` in J; ``angular_momentum``, its magnitude in kg m²/s.
        - ``period`` T of the angular velocity in the body, and ``flip_time``, half of it, after which the
          spin about the middle axis is reversed (short- and long-axis mode), in s.
        - ``precession_rate``, the mean rate about L in rad/s, and ``precession_period``, 2π over it, in s.
        - ``phase_per_period``, the rate times T: the angle φ by which the attitude is turned about L after a
          period. With the rotor, which counts turns to 4π, ``R(T) = −exp(−½ L/|L| φ) R(0)``.
        - ``solid_angle`` A in sr that L sweeps in the body round the encircled axis in a period (Montgomery's
          geometric phase): ``φ = 2ET/|L| ± (2π − A)``, + if that axis has the largest moment, else −.
        - ``wobble_min``, ``wobble_max``: the extremes of the angle between L and the encircled axis, in rad.
        - ``wobble_period`` in s of a small wobble, if the rotation is steady about a stable axis.

        Values that a regime does not define are None. For a batch all are arrays of its shape, with NaN for
        None.
        """
        found = self._core.describe()
        if not self.shape:
            return found
        return {name: np.asarray(column).reshape(self.shape) for name, column in found.items()}

    def polhode(self, n: int) -> Multivector:
        """Return n angular velocities in body axes along one period, bivectors (..., n).

        They are equally spaced in time from the start; the last equals the first, so the curve is closed. For
        a steady rotation all are equal. On the separatrix the curve is open: it runs from one end of the
        middle axis to the other, up to a relative distance of 4e-9.
        """
        return _bivectors(self._core.polhode(_count(n)), (*self.shape, n))

    def herpolhode(self, n: int, periods: float = 1.0) -> Multivector:
        """Return n angular velocities in space axes over a number of periods, bivectors (..., n).

        Their tips lie in the invariable plane, ``Ω_S·L = −2E``; in general the curve is not closed.
        """
        length = as_float(periods, "periods")
        if not (length > 0 and np.isfinite(length)):
            raise ValueError(f"periods is {length}; it must be positive and finite")
        return _bivectors(self._core.herpolhode(_count(n), length), (*self.shape, n))

    if TYPE_CHECKING:
        view = _outputs.view_of

    def derivatives(self, t: Any) -> FlowDerivatives:
        """Return the derivatives of the state at time t by the start and the body.

        They are in closed form: the cost does not grow with t and the error is rounding. A ValueError as in
        `at`, and where the derivatives of an unstable rotation overflow.

        `polhode.jax.free` is the same function for JAX.
        """
        times = as_floats(t, "time")
        shape = self.shape + times.shape
        require(_DERIVATIVES * math.prod(shape), f"derivatives of batch shape {shape}")
        found = self._core.derivatives(np.ravel(times))
        sizes = ((4, 3), (4, 3), (4, 3), (4,), (3, 3), (3, 3), (3,))
        return FlowDerivatives(
            *(frozen(x.reshape(shape + size)) for x, size in zip(found, sizes, strict=True))
        )


@hands_out_copies()
@dataclass(frozen=True, eq=False)
class FlowDerivatives:
    """Derivatives of the state of a free motion at time t, for a batch of times and bodies of shape (...).

    Rows are components: of the rotor ``(1, e2e3, e3e1, e1e2)``, of the angular velocity in body axes
    ``(e2e3, e3e1, e1e2)``. Columns are components of the variable.

    Attributes
    ----------
    d_rotor_d_attitude
        (..., 4, 3), by a rotation of the start by a small bivector ε in space axes, ``exp(−½ε) R(0)``,
        which leaves the angular velocity in the body unchanged.
    d_rotor_d_omega, d_omega_d_omega
        (..., 4, 3) in s and (..., 3, 3), by the angular velocity in body axes at the start.
    d_rotor_d_moments, d_omega_d_moments
        (..., 4, 3) and (..., 3, 3), by the principal moments in kg m², with fixed principal axes and a fixed
        initial angular velocity.
    d_rotor_dt, d_omega_dt
        (..., 4) and (..., 3), by time: ``−½ R Ω_B`` and Euler's equations.
    """

    d_rotor_d_attitude: Array
    d_rotor_d_omega: Array
    d_rotor_d_moments: Array
    d_rotor_dt: Array
    d_omega_d_omega: Array
    d_omega_d_moments: Array
    d_omega_dt: Array


class SymmetricTop(FreeMotion):
    """Torque-free motion of one body with two equal moments, by handout eq. (4.35).

    ``R(t) = exp(−½Ω_l t) R(0) exp(−½Ω_r t)``, ``Ω_l = L/i1``, ``Ω_r = ((i1 − i3)/i1) ω3 I e3`` for
    the symmetry axis e3, or another. A ValueError if all three moments differ. The rates are rounded, so
    the error grows with the angle turned. Moments with a relative difference d <= 1.8e-15 count as equal,
    with an error of ``d |ω| t``. `FreeMotion` has neither error. `omega_l` and `omega_r` are the two rates.
    """

    def __init__(self, inertia: Inertia, rotor: Rotor, omega_body: Any) -> None:
        super().__init__(inertia, rotor, omega_body)
        if self.shape:
            raise ValueError(f"SymmetricTop takes one body, got batch shape {self.shape}; use FreeMotion")
        self.at(0.0)

    @property
    def omega_l(self) -> Multivector:
        """The constant ``Ω_l = L/i1`` of handout eq. (4.33), a bivector in rad/s, in space axes.

        The left rate of the rotor, ``R' = −½Ω_l R − ½R Ω_r`` (4.34): the precession about L.
        """
        rotors, omegas = self._core.starts()
        momentum: Multivector = Rotor._from_rows(rotors[0])(self._inertia(bivector(omegas[0])))
        return momentum / self._moments[1]

    @property
    def omega_r(self) -> Multivector:
        """The constant ``Ω_r = ((i1 − i3)/i1) ω3 I e3`` of eq. (4.33), a bivector in rad/s, in body axes.

        The right rate of the rotor: the body's rotation about its symmetry axis, e3 or another, relative to
        the precession, ``Ω_S = Ω_l + R Ω_r ~R`` (4.31). It is 0 if all moments are equal.
        """
        k, i1, i3 = self._moments
        axis = self._inertia.principal_frame.to_matrix()[:, k]
        spin = self._core.starts()[1][0] @ axis
        return bivector((i1 - i3) / i1 * spin * axis)

    @property
    def _moments(self) -> tuple[int, float, float]:
        """The number (from 0) of the symmetry axis, i1 and i3, chosen as in the core."""
        i = self._inertia.principal_moments.tolist()
        pairs = {k: (i[k - 2], i[k - 1]) for k in range(3)}
        k = next(k for k, (a, b) in pairs.items() if abs(a - b) <= _EQUAL * max(a, b))
        return k, i[k - 2], i[k]

    def at(self, t: Any) -> State:
        """Return the state at time t in s; an array of times gives a state of that batch shape."""
        times = as_floats(t, "time")
        rotor, omega = (row[0] for row in self._core.starts())
        rotors, omegas = _native.symmetric_top(self._inertia._core, rotor, omega, np.ravel(times))
        rotors = rotors.reshape(*times.shape, 4)
        return State._at_origin(Rotor._from_rows(rotors), _bivectors(omegas, times.shape), times)


def describe_free(inertia: Inertia, omega_body: Any) -> dict[str, Any]:
    """Return the regime, periods and invariants of a free motion, as `FreeMotion.describe`."""
    return FreeMotion(inertia, Rotor.identity(), omega_body).describe()


def _batch(inertia: Any, rotor: Any, omega_body: Any) -> tuple[_native.FreeMotion, Any]:
    """Return the motions and inertias of arguments that may be batches."""
    inertias = objects_of(inertia, (Inertia,), "inertia must be an Inertia", "; see Body.inertia")
    if not isinstance(rotor, Rotor):
        raise TypeError(
            f"rotor must be a Rotor, got {type(rotor).__name__}; see Rotor.from_quaternion, from_matrix"
        )
    turns = as_coefficients(rotor._data, "the rotor", float)
    rates = angular_velocity(omega_body)._data
    shapes = inertias.shape, turns.shape[:-1], rates.shape[:-1]
    try:
        shape = np.broadcast_shapes(*shapes)
    except ValueError:
        raise ValueError(
            f"the batch shapes {shapes[0]} of the inertia, {shapes[1]} of the rotor and {shapes[2]} of the "
            "angular velocity do not broadcast together"
        ) from None
    require(_BODY * math.prod(shape), f"the motions of a batch of shape {shape}")
    one = not inertias.shape
    if not one:
        inertias = np.broadcast_to(inertias, shape)
    cores = list(map(operator.attrgetter("_core"), inertias.ravel()))
    turns, rates = (np.broadcast_to(x, (*shape, x.shape[-1])) for x in (turns, rates))
    core = _native.FreeMotion.batch(cores, np.ascontiguousarray(turns), np.ascontiguousarray(rates))
    return core, inertias[()] if one else inertias


def _order(bodies: Shape, shape: Shape) -> tuple[Shape, int]:
    """Return the order of axes in which the states are computed, and the number of times per body.

    The core computes bodies in SIMD lanes: each body should come with all of its times, and the bodies should
    repeat only if there are many.
    """
    own = (1,) * (len(shape) - len(bodies)) + bodies
    axes = [k for k, length in enumerate(own) if length != 1]
    if not axes:
        return tuple(range(len(shape))), math.prod(shape)
    first, end = axes[0], axes[-1] + 1
    are_together = math.prod(shape[first:end]) == math.prod(bodies)
    if are_together and (math.prod(bodies) >= _MANY or math.prod(shape[:first]) == 1):
        return tuple(range(len(shape))), math.prod(shape[end:])
    times = [k for k, length in enumerate(own) if length == 1]
    return (*axes, *times), math.prod(shape[k] for k in times)


def _index(index: Any) -> Shape:
    return tuple(int(k) for k in index)


def _bivectors(numbers: Array, shape: Shape) -> Multivector:
    return bivector(numbers.reshape(*shape, 3), copy=False)


def _count(n: Any) -> int:
    count = as_count(n, "n")
    if count < 2:
        raise ValueError(f"n is {count}; a curve needs at least 2 points")
    return count
