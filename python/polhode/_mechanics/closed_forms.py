"""Closed-form motions with torque: `LagrangeTop`, `DampedTop`, `LarmorSphere`."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.constructors import as_vectors, is_zero
from polhode._algebra.rotor import Rotor
from polhode._mechanics.closed_form import ClosedForm, given
from polhode._mechanics.parameters import check_finite
from polhode._support.arrays import Array, as_floats
from polhode._support.calls import explains_calls_of


@explains_calls_of
class LagrangeTop(ClosedForm):
    """The heavy symmetric top, exact at any time (Klein & Sommerfeld; Whittaker §72).

    The body is fixed at the origin of its axes under gravity along −e3: ``V = c·γ``, ``γ = ~R e3 R``, the
    torque of `ph.torque.heavy`. Two principal moments are equal and ``c`` is along the axis of symmetry,
    which may be any principal axis. Both Cayley–Klein parameters of the rotor are theta functions times
    uniform phases, reduced in double-double arithmetic: the error stays at rounding level at any time up to t
    = 1e12, also near the separatrix. The rotor is continuous in time on the double cover.

    Any tilt from the vertical is resolved, down to the smallest float; near the unstable upright, a tilt θ
    and its rate have a relative error of about ``ln(8/θ)`` roundings. Transverse moments with a relative
    difference d <= 1.8e-15 count as equal, and ``c`` may be off the axis by an angle d <= 1.4e-14. This
    neglects an angle of about ``d ω t``, ω the largest rate, which grows as an unstable top falls; `simulate`
    reports it as the error estimate.

    Batch shapes broadcast to `shape`; ``m[i]`` indexes the batch as in NumPy. The tops of a batch are
    computed in SIMD lanes, in any regimes.

    Parameters
    ----------
    inertia
        About the fixed point, in body axes: an `Inertia` in kg m², or a nested sequence or array of them.
    rotor
        At time 0, from body axes to space.
    omega_body
        At time 0, a bivector or an array (..., 3), in rad/s.
    c
        ``m g (centre of mass)`` in body axes, a vector or an array (..., 3), in N m.

    Raises
    ------
    ValueError
        If all moments differ, one is zero, or ``c`` is off the axis; if a number is not finite; if the
        solution does not reproduce the start or conserve the energy. The message has the batch index.

    Examples
    --------
    A fast gyroscope precesses at about ``c/L3``:

    >>> tilted = ph.Rotor.from_plane_angle(ph.e2 ^ ph.e3, 1.0)
    >>> body = ph.Inertia.from_principal_moments(2, 2, 1)
    >>> facts = ph.LagrangeTop(body, tilted, [0, 0, 200], [0, 0, 3]).describe()
    >>> round(facts["precession_rate"], 4), 3 / 200
    (0.015, 0.015)

    It stays upright above the spin ``2 √(c i1)/i3``, here √24:

    >>> upright = ph.LagrangeTop(body, ph.Rotor.identity(), [0, 0, 5], [0, 0, 3]).describe()
    >>> round(upright["critical_spin"]**2, 9), upright["sleeps"]
    (24.0, True)
    """

    _core: _native.LagrangeTop

    def __init__(self, inertia: Any, rotor: Rotor, omega_body: Any, c: Any) -> None:
        remedy = "Body.inertia_about(pivot)"
        arguments, self._inertia = given(inertia, rotor, omega_body, _vectors(c, "c"), "c", remedy)
        self._core = _native.LagrangeTop(*arguments)

    def describe(self) -> dict[str, Any]:
        """Return the regime, periods and invariants of the motion.

        The axis is the axis of symmetry, towards the centre of mass. ``regime``; ``tilt_min``, ``tilt_max``,
        its angles from the vertical in rad; ``nutation_period`` in s; ``precession_rate`` and
        ``spin_rate``, the mean rates of φ about e3 and of ψ about the axis in rad/s, ``precession_period``;
        ``modulus`` of the elliptic functions; ``energy`` in J, ``axial_momentum`` L3 and
        ``vertical_momentum`` Lz in kg m²/s; ``critical_spin = 2 √(|c| i1)/i3`` in rad/s and ``sleeps``,
        whether a top with this spin is stable upright. A period is None where the motion does not repeat.
        For a batch all are arrays of its shape, with NaN for None.

        Examples
        --------
        >>> tilted = ph.Rotor.from_plane_angle(ph.e2 ^ ph.e3, 1.0)
        >>> body = ph.Inertia.from_principal_moments(2, 2, 1)
        >>> facts = ph.LagrangeTop(body, tilted, [0, 0, 20], [0, 0, 3]).describe()
        >>> facts["regime"]
        'nutating with cusps'
        >>> round(facts["tilt_min"], 3), round(facts["tilt_max"], 3)  # let go at 1 rad
        (1.0, 1.026)
        """
        return self._columns(self._core.describe())


@explains_calls_of
class DampedTop(ClosedForm):
    """Any body with the torque ``N = −g L``, exact at any time.

    The motion is that of the free body at time ``τ = (1 − e^(−gt))/g``, with its angular velocity times
    ``e^(−gt)``; g is in 1/s, of either sign, a number or an array (...). τ is computed in double-double
    arithmetic. Batch shapes broadcast as in `LagrangeTop`. A ValueError if a principal moment is zero or a
    number is not finite; the message has the batch index.

    Examples
    --------
    The angular momentum decays as ``exp(−g t)``:

    >>> book = ph.Inertia.from_principal_moments(1, 2, 3)
    >>> top = ph.DampedTop(book, ph.Rotor.identity(), [0, 0, 1], g=0.5)
    >>> top.at(2.0).omega_body.components.round(4)  # exp(-1)
    array([0.    , 0.    , 0.3679])

    Until it rests, the body turns by ``ω/g``, here 2 rad:

    >>> round(float(np.linalg.norm(top.at(100.0).rotor.to_rotation_vector())), 9)
    2.0
    """

    def __init__(self, inertia: Any, rotor: Rotor, omega_body: Any, g: Any) -> None:
        damping = as_floats(g, "g")[..., np.newaxis]
        arguments, self._inertia = given(inertia, rotor, omega_body, damping, "g")
        self._core = _native.damped_tops(*arguments)


@explains_calls_of
class LarmorSphere(ClosedForm):
    """A sphere with the axial torque ``N = L x b``, exact at any time: a spin in a uniform field.

    ``b``, a vector or an array (..., 3) in rad/s, is fixed in space:
    ``R(t) = exp(½ I b t) exp(−½ I (ω + b) t) R(0)`` with the angular velocity ω in space at time 0. Both
    phases are reduced in double-double arithmetic, so the error does not grow with time. Moments with a
    relative difference d <= 1.8e-15 count as equal; this neglects an angle of about ``d |ω| t``, which
    `simulate` reports as the error estimate. Batch shapes broadcast as in `LagrangeTop`. A ValueError if the
    moments differ by more or a number is not finite; the message has the batch index.

    Examples
    --------
    In a field of 1 T the spin of a proton precesses 42.577 million times a second, backwards:

    >>> ball = ph.Inertia.from_principal_moments(1, 1, 1)
    >>> field = [0, 0, 2.6752218708e8]  # γ B in rad/s
    >>> proton = ph.LarmorSphere(ball, ph.Rotor.identity(), [1, 0, 0], field)
    >>> x, y, _ = proton.at(1e-9).omega_space.components
    >>> print(f"{np.arctan2(y, x) / (2 * np.pi) * 1e3:.3f} MHz")
    -42.577 MHz
    """

    def __init__(self, inertia: Any, rotor: Rotor, omega_body: Any, b: Any) -> None:
        arguments, self._inertia = given(inertia, rotor, omega_body, _vectors(b, "b"), "b")
        self._core = _native.larmor_spheres(*arguments)


def _vectors(value: Any, name: str) -> Array:
    """Return finite components (..., 3) from vectors or an array, or from 0."""
    if is_zero(value):
        return np.zeros(3)
    components = as_vectors(value, name)
    check_finite(components, name)
    return components
