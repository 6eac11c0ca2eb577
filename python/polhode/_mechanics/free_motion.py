"""The free top, exact at any time: states, what its invariants tell, its curves, and derivatives."""

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
from polhode._mechanics.bodies import Inertia
from polhode._mechanics.state import State, angular_velocity
from polhode._support.arrays import Array, Shape, as_float, as_floats, frozen, hands_out_copies
from polhode._support.memory import require

if TYPE_CHECKING:
    from polhode import _outputs

_STATE = 7 * 8  # bytes
_DERIVATIVES = 2 * 64 * 8  # bytes, as they are found and as they are told
_BODY = 800  # bytes of a motion in a batch, at most
_MANY = 64  # bodies that fill the lanes


class FreeMotion:
    """The torque-free motion of any body, exact at any time; or of a batch of bodies.

    Jacobi's solution: the rotor is four theta series and one uniform turn about L, the angular velocity
    three elliptic functions. Their phases are reduced in twice the precision, so that the error is rounding
    at t = 1e12 as at t = 1, near the separatrix as far from it. The rotor is continuous in time on the
    double cover. No two moments count as equal that are not, and no rate as zero: needles and spins beside an
    axis may be as thin and as small as floats are. Moments and axes of a matrix that is not diagonal are
    rounded before, which is a turn of about ``ε |ω| t``.

    Parameters
    ----------
    inertia
        An `Inertia` in kg m², or a nested sequence or array of them.
    rotor
        From body axes to space axes at time 0.
    omega_body
        Angular velocity in body axes at time 0, a bivector or an array (..., 3), in rad/s.

    Batch shapes broadcast together, to `shape`. ``m[i]`` is one motion, or fewer. Bodies of a batch are
    computed side by side, whatever their regimes are.

    Raises
    ------
    ValueError
        If a moment is zero or a number is not finite; with the batch index.
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
        numbers = np.arange(int(np.prod(self.shape))).reshape(self.shape)
        try:
            picked = numbers[index]
        except IndexError as error:
            raise IndexError(f"{error} (batch shape {self.shape})") from None
        return self._picked(picked, self._core.starts())

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
            return f"FreeMotion(batch {self.shape})"
        return f"FreeMotion({self.describe()['regime']}, {self._inertia!r})"

    def at(self, t: Any) -> State:
        """Return the state at time t in s; all at all times, of batch shape ``m.shape + t.shape``.

        Each is the same to the last bit as that of one motion at one time. A ValueError for times that are
        not finite, or so late that the phase is no longer known (1e17 turns); a MemoryError for more states
        than there is memory for.
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
        """Return the state of each body at its own time t in s, or at its own times.

        Times broadcast with the batch of bodies, to the batch shape of the state: bodies (N,) and times (N,)
        give (N,), one time for each body; times (T, N), or bodies (N, 1) and times (N, T), T for each. Each
        state is the same to the last bit as that of one motion at one time. Errors as in `at`, and a
        ValueError for times whose shape does not fit the bodies.
        """
        times = as_floats(t, "time")
        try:
            shape = np.broadcast_shapes(self.shape, times.shape)
        except ValueError:
            raise ValueError(
                f"times of shape {times.shape} do not broadcast with bodies of batch shape {self.shape}; "
                "`at` takes all times for each body"
            ) from None
        order, each = _order(self.shape, shape)
        # The times, and the states once more where they are put into another order.
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
        """Times must be finite and within the horizon of their bodies."""
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
                f"at index {_index(index)}: time {time:g} s of body {body} lies beyond {horizon:.1e} s, "
                "where the phase of its rotation is no longer known to rounding; take times nearer to 0"
            )

    def describe(self) -> dict[str, Any]:
        """Say what the invariants tell.

        - ``regime``, in words; ``axis``, the principal axis (1, 2, 3) that the polhode encircles; ``modulus``
          k of the elliptic functions; ``energy`` in J; ``angular_momentum``, its size in kg m²/s.
        - ``period`` T of the angular velocity in the body, and ``flip_time``, half of it, after which the
          spin about the middle axis is reversed (short- and long-axis mode), in s.
        - ``precession_rate``, the mean rate about L in rad/s, and ``precession_period``, 2π over it, in s.
        - ``phase_per_period``, the rate times T: the angle φ by which the attitude is turned about L after a
          period. With the rotor, which counts turns to 4π, ``R(T) = −exp(−½ L/|L| φ) R(0)``.
        - ``solid_angle`` A in sr that L sweeps in the body round the encircled axis in a period (Montgomery's
          geometric phase): ``φ = 2ET/|L| ± (2π − A)``, + if that axis has the largest moment, else −.
        - ``wobble_min``, ``wobble_max``: the extremes of the angle between L and the encircled axis, in rad.
        - ``wobble_period`` in s of a small wobble, where the rotation is steady about an axis and stable.

        What has no meaning in a regime is None. For a batch all are arrays of its shape, NaN for None.
        """
        told = self._core.describe()
        if not self.shape:
            return told
        return {name: np.asarray(column).reshape(self.shape) for name, column in told.items()}

    def polhode(self, n: int) -> Multivector:
        """Return n angular velocities in body axes along one period, bivectors (..., n).

        They follow each other in equal times from the start on, and the last is the first, so that the curve
        is closed. A steady rotation stays at its point. The separatrix is not closed: its curve goes from one
        end of the middle axis to the other, up to 4e-9 of the way.
        """
        return _bivectors(self._core.polhode(_count(n)), (*self.shape, n))

    def herpolhode(self, n: int, periods: float = 1.0) -> Multivector:
        """Return n angular velocities in space axes over so many periods, bivectors (..., n).

        Their tips lie in the invariable plane, ``Ω_S·L = −2E``; the curve is closed only by chance.
        """
        length = as_float(periods, "periods")
        if not (length > 0 and np.isfinite(length)):
            raise ValueError(f"periods is {length}; it must be positive and finite")
        return _bivectors(self._core.herpolhode(_count(n), length), (*self.shape, n))

    if TYPE_CHECKING:
        view = _outputs.view_of

    def derivatives(self, t: Any) -> FlowDerivatives:
        """Return how the state at time t changes with the start and the body, exact at any time.

        In closed form, so that the cost does not grow with t and the error is rounding. A ValueError as in
        `at`, and where an unstable rotation has carried a change beyond floating point.

        `polhode.jax.free` is the same as a function for JAX.
        """
        times = as_floats(t, "time")
        shape = self.shape + times.shape
        require(_DERIVATIVES * math.prod(shape), f"derivatives of batch shape {shape}")
        found = self._core.derivatives(np.ravel(times))
        sizes = ((4, 3), (4, 3), (4, 3), (4,), (3, 3), (3, 3), (3,))
        return FlowDerivatives(
            *(frozen(x.reshape(shape + size)) for x, size in zip(found, sizes, strict=True))
        )


@hands_out_copies(
    "d_rotor_d_attitude",
    "d_rotor_d_omega",
    "d_rotor_d_moments",
    "d_rotor_dt",
    "d_omega_d_omega",
    "d_omega_d_moments",
    "d_omega_dt",
)
@dataclass(frozen=True, eq=False)
class FlowDerivatives:
    """Derivatives of the state of a free motion at time t, for a batch of times and bodies of shape (...).

    Rows are components: of the rotor ``(1, e2e3, e3e1, e1e2)``, of the angular velocity in body axes
    ``(e2e3, e3e1, e1e2)``. Columns are components of what is changed at the start.

    Attributes
    ----------
    d_rotor_d_attitude
        (..., 4, 3), by a turn of the start by a small bivector ε in space axes, ``exp(−½ε) R(0)``. The
        angular velocity in the body does not change with it.
    d_rotor_d_omega, d_omega_d_omega
        (..., 4, 3) in s and (..., 3, 3), by the angular velocity in body axes at the start.
    d_rotor_d_moments, d_omega_d_moments
        (..., 4, 3) and (..., 3, 3), by the principal moments in kg m², about principal axes that stay where
        they are in the body, and at the same angular velocity at the start.
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
    """The free top with two equal moments, by handout eq. (4.35); a single one.

    ``R(t) = exp(−½Ω_l t) R(0) exp(−½Ω_r t)``, ``Ω_l = L/i1``, ``Ω_r = ((i1 − i3)/i1) ω3 I e3`` with the
    symmetry axis e3 of the body, or whichever it is. A ValueError if all three moments differ. The rates are
    rounded, so the error grows with the angle turned. Moments that differ by a part d <= 1.8e-15 of them
    count as equal, with an error of ``d |ω| t``. `FreeMotion` has neither error.
    """

    def __init__(self, inertia: Inertia, rotor: Rotor, omega_body: Any) -> None:
        super().__init__(inertia, rotor, omega_body)
        if self.shape:
            raise ValueError(f"a SymmetricTop is a single one, got batch shape {self.shape}; use FreeMotion")
        self.at(0.0)

    def at(self, t: Any) -> State:
        """Return the state at time t in s; an array of times gives a state of that batch shape."""
        times = as_floats(t, "time")
        rotor, omega = (row[0] for row in self._core.starts())
        rotors, omegas = _native.symmetric_top(self._inertia._core, rotor, omega, np.ravel(times))
        rotors = rotors.reshape(*times.shape, 4)
        return State._at_origin(Rotor._from_rows(rotors), _bivectors(omegas, times.shape), times)


def describe_free(inertia: Inertia, omega_body: Any) -> dict[str, Any]:
    """Say what the invariants of a free motion tell, as `FreeMotion.describe`."""
    return FreeMotion(inertia, Rotor.identity(), omega_body).describe()


def _batch(inertia: Any, rotor: Any, omega_body: Any) -> tuple[_native.FreeMotion, Any]:
    """Return motions and inertias from what may be batches."""
    inertias = _inertias(inertia)
    if not isinstance(rotor, Rotor):
        raise TypeError(f"rotor must be a Rotor, got {type(rotor).__name__}; see Rotor.from_components")
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


def _inertias(values: Any) -> Any:
    """Return an array of objects, all of them inertias."""
    array: Any = np.empty((), dtype=object)
    if isinstance(values, Inertia):
        array[()] = values
    elif isinstance(values, list | tuple) and set(map(type, values)) == {Inertia}:
        # So as not to look for sequences in each.
        array = np.fromiter(values, object, len(values))
    elif isinstance(values, list | tuple | np.ndarray):
        array = np.array(values, dtype=object)
    else:
        raise TypeError(f"inertia must be an Inertia, got {type(values).__name__}; see Body.inertia")
    if not set(map(type, array.ravel())) <= {Inertia}:
        for index, value in np.ndenumerate(array):
            if not isinstance(value, Inertia):
                raise TypeError(f"at index {index}: inertia must be an Inertia, got {type(value).__name__}")
    return array


def _order(bodies: Shape, shape: Shape) -> tuple[Shape, int]:
    """Return the order of the axes of the states in which they are computed, and the times of a body in turn.

    Bodies stand side by side in the core: they are to follow each other with all times that each has in turn,
    and from the first one again only if they are many.
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
    try:
        count = operator.index(n)
    except TypeError:
        raise TypeError(f"n must be a whole number, got {type(n).__name__}") from None
    if count < 2:
        raise ValueError(f"n is {count}; a curve has at least 2 points")
    return count
