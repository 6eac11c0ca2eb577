"""`FreeMotion`: torque-free motion, exact at any time, its curves, invariants and derivatives."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.constructors import bivector
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.closed_form import ClosedForm, bivectors, given
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.state import State
from polhode._support.arrays import Array, as_count, as_float, as_floats, frozen, hands_out_copies
from polhode._support.calls import explains_calls_of
from polhode._support.memory import require

_DERIVATIVES = 2 * 64 * 8  # bytes, of the core's arrays and their copies
_CURVE = 3 * 3 * 8  # bytes of a point, with the copies of the core
_EQUAL = 8 * float(np.finfo(float).eps)  # relative difference of moments that count as equal


@explains_calls_of
class FreeMotion(ClosedForm):
    """Torque-free motion of any body, or of a batch of bodies, exact at any time.

    Jacobi's solution: the rotor is four theta series and one uniform turn about L, the angular velocity
    three elliptic functions. Their phases are reduced in double-double arithmetic, so the error stays at
    rounding level up to t = 1e12, also near the separatrix. The rotor is continuous in time on the double
    cover. Moments that differ are never treated as equal, nor small rates as zero: thin bodies and spins
    close to an axis are resolved. For a matrix that is not diagonal, rounding of the moments and axes adds
    a turn of about ``ε |ω| t``.

    Batch shapes broadcast to `shape`; ``m[i]`` indexes the batch as in NumPy. The bodies of a batch are
    computed in SIMD lanes, in any regimes.

    Parameters
    ----------
    inertia
        An `Inertia` in kg m², or a nested sequence or array of them.
    rotor
        From body axes to space axes at time 0.
    omega_body
        Angular velocity in body axes at time 0, a bivector or an array (..., 3), in rad/s.

    Raises
    ------
    ValueError
        If a moment is zero or a number is not finite; the message has the batch index.

    Examples
    --------
    A plate that is thrown with a small wobble wobbles twice for each turn (Feynman's plate):

    >>> inertia = ph.Inertia.from_principal_moments(1, 1, 2)
    >>> plate = ph.FreeMotion(inertia, ph.Rotor.identity(), [0.01, 0, 1])
    >>> facts = plate.describe()
    >>> facts["regime"]
    'symmetric top, regular precession'
    >>> round(facts["precession_rate"] * facts["period"] / (2 * np.pi), 3)
    2.0
    """

    _core: _native.FreeMotion

    def __init__(self, inertia: Any, rotor: Rotor, omega_body: Any) -> None:
        core = None
        if isinstance(inertia, Inertia):
            core = _native.FreeMotion.single(inertia._core, rotor, omega_body)
        if core is None:
            arguments, inertia = given(inertia, rotor, omega_body)
            core = _native.FreeMotion.batch(*arguments)
        self._core, self._inertia = core, inertia

    def __repr__(self) -> str:
        if self.shape:
            return f"{type(self).__name__}(batch {self.shape})"
        return f"{type(self).__name__}({self.describe()['regime']}, {self._inertia!r})"

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

        Examples
        --------
        >>> handle = ph.Inertia.from_principal_moments(1.755e-4, 2.354e-4, 3.930e-4)
        >>> facts = ph.FreeMotion(handle, ph.Rotor.identity(), [0.3, 10 * np.pi, 0.3]).describe()
        >>> facts["regime"], facts["axis"]
        ('short-axis mode', 3)
        >>> round(facts["flip_time"], 3)
        0.9
        """
        return self._columns(self._core.describe())

    def polhode(self, n: int) -> Multivector:
        """Return n angular velocities in body axes along one period, bivectors (..., n).

        They are equally spaced in time from the start; the last equals the first, so the curve is closed. For
        a steady rotation all are equal. On the separatrix the curve is open: it runs from one end of the
        middle axis to the other, up to a relative distance of 4e-9.

        Examples
        --------
        >>> book = ph.Inertia.from_principal_moments(1, 2, 3)
        >>> curve = ph.FreeMotion(book, ph.Rotor.identity(), [1, 0.2, 0.1]).polhode(100)
        >>> i, w = [1, 2, 3], curve.components
        >>> bool(np.allclose((i * w**2).sum(axis=1), 1.11))  # on the ellipsoid of the energy
        True
        """
        return bivectors(self._core.polhode(self._counted(n)), (*self.shape, n))

    def herpolhode(self, n: int, periods: float = 1.0) -> Multivector:
        """Return n angular velocities in space axes over a number of periods, bivectors (..., n).

        Their tips lie in the invariable plane, ``Ω_S·L = −2E``; in general the curve is not closed.

        Examples
        --------
        The component along the angular momentum is constant: the tips lie in a plane.

        >>> inertia = ph.Inertia.from_principal_moments(1, 2, 3)
        >>> start = np.array([1, 0.2, 0.1])
        >>> curve = ph.FreeMotion(inertia, ph.Rotor.identity(), start).herpolhode(100, periods=3)
        >>> heights = curve.components @ (start * [1, 2, 3])
        >>> bool(np.allclose(heights, 1.11))  # twice the energy
        True
        """
        length = as_float(periods, "periods")
        if not (length > 0 and np.isfinite(length)):
            raise ValueError(f"periods is {length}; it must be positive and finite")
        return bivectors(self._core.herpolhode(self._counted(n), length), (*self.shape, n))

    def _counted(self, n: int) -> int:
        count = _count(n)
        shape = (*self.shape, count)
        require(_CURVE * math.prod(shape), f"curves of batch shape {shape}")
        return count

    def derivatives(self, t: Any) -> FlowDerivatives:
        """Return the derivatives of the state at time t with respect to the start and the body.

        They are in closed form: the cost does not grow with t and the error is rounding. A ValueError as in
        `at`, and where the derivatives of an unstable rotation overflow.

        `polhode.jax.free` is the same function for JAX.

        Examples
        --------
        >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
        >>> motion = ph.FreeMotion(ball, ph.Rotor.identity(), [0, 0, np.pi])
        >>> motion.derivatives([0.0, 1.0]).d_rotor_d_omega.shape
        (2, 4, 3)
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
        (..., 4, 3), with respect to a small rotation of the start, a bivector ε in space axes,
        ``exp(−½ε) R(0)``, which leaves the angular velocity in the body unchanged.
    d_rotor_d_omega, d_omega_d_omega
        (..., 4, 3) in s and (..., 3, 3), with respect to the initial angular velocity in body axes.
    d_rotor_d_moments, d_omega_d_moments
        (..., 4, 3) and (..., 3, 3), with respect to the principal moments in kg m², with fixed principal
        axes and a fixed initial angular velocity.
    d_rotor_dt, d_omega_dt
        (..., 4) and (..., 3), with respect to time: ``−½ R Ω_B`` and Euler's equations.

    Examples
    --------
    A steady rotation has the rotor ``exp(−½ ω t e1e2)``, here with ``ω t = π``:

    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> motion = ph.FreeMotion(ball, ph.Rotor.identity(), [0, 0, np.pi])
    >>> change = motion.derivatives(1.0)
    >>> change.d_rotor_d_omega.shape
    (4, 3)
    >>> round(float(change.d_rotor_d_omega[0, 2]), 12)  # of the scalar part cos(½ ω t) by ω
    -0.5
    """

    d_rotor_d_attitude: Array
    d_rotor_d_omega: Array
    d_rotor_d_moments: Array
    d_rotor_dt: Array
    d_omega_d_omega: Array
    d_omega_d_moments: Array
    d_omega_dt: Array


@explains_calls_of
class SymmetricTop(FreeMotion):
    """Torque-free motion of one body with two equal moments, by handout eq. (4.35).

    ``R(t) = exp(−½Ω_l t) R(0) exp(−½Ω_r t)``, ``Ω_l = L/i1``, ``Ω_r = ((i1 − i3)/i1) ω3 I e3`` for
    the symmetry axis e3, or another. A ValueError if all three moments differ. The rates are rounded, so
    the error grows with the angle turned. Moments with a relative difference d <= 1.8e-15 count as equal,
    with an error of ``d |ω| t``. `FreeMotion` has neither error. `omega_l` and `omega_r` are the two rates.

    Examples
    --------
    A long body precesses about the momentum and turns about its axis relative to this precession:

    >>> body = ph.Inertia.from_principal_moments(2, 2, 1)
    >>> top = ph.SymmetricTop(body, ph.Rotor.identity(), [1, 0, 3])
    >>> top.omega_l.components  # L/i1, in space
    array([1. , 0. , 1.5])
    >>> top.omega_r.components  # (i1 − i3)/i1 ω3, in the body
    array([0. , 0. , 1.5])
    >>> round(float(top.at(100.0).omega_body["e12"]), 9)  # the spin about the axis is constant
    3.0
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
        """Return the state at time t in s; an array of times gives a state of that batch shape.

        Examples
        --------
        >>> body = ph.Inertia.from_principal_moments(2, 2, 1)
        >>> top = ph.SymmetricTop(body, ph.Rotor.identity(), [1, 0, 3])
        >>> top.at([0.0, 1.0, 2.0]).shape
        (3,)
        """
        times = as_floats(t, "time")
        rotor, omega = (row[0] for row in self._core.starts())
        rotors, omegas = _native.symmetric_top(self._inertia._core, rotor, omega, np.ravel(times))
        rotors = rotors.reshape(*times.shape, 4)
        return State._at_origin(Rotor._from_rows(rotors), bivectors(omegas, times.shape), times)


def describe_free(inertia: Inertia, omega_body: Any) -> dict[str, Any]:
    """Return the regime, periods and invariants of a free motion, as `FreeMotion.describe`.

    Examples
    --------
    A plate with moments 1, 1, 2 wobbles in space twice for each turn:

    >>> facts = ph.describe_free(ph.Inertia.from_principal_moments(1, 1, 2), [0.01, 0, 1])
    >>> round(facts["period"], 3), round(facts["precession_period"], 3)
    (6.283, 3.142)
    """
    return FreeMotion(inertia, Rotor.identity(), omega_body).describe()


def _count(n: Any) -> int:
    count = as_count(n, "n")
    if count < 2:
        raise ValueError(f"n is {count}; a curve needs at least 2 points")
    return count
