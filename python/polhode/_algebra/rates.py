"""Attitudes from sampled angular velocities, and angular velocities from sampled attitudes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from polhode._algebra.constructors import as_bivectors, bivector
from polhode._algebra.grades import stack
from polhode._algebra.interpolation import RotorSpline, increasing_times, spline_slopes
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._support.arrays import Array, at_index, first_index
from polhode._support.calls import explains_calls


@explains_calls
def attitude_from_rates(times: Any, omega_body: Any, start: Rotor | None = None) -> Rotor:
    """Return the rotors of a body whose angular velocity was sampled: the attitude from a gyroscope.

    Solves ``R' = −½ R Ω_B`` (handout eq. 4.13). Between samples Ω_B follows their cubic spline, and each step
    is the exponential of Magnus' series to fourth order (Iserles & Nørsett, Phil. Trans. R. Soc. A 357
    (1999)): ``exp(−½∫Ω dt + h²/24 Ω_k×Ω_{k+1})``, whose second term is the coning correction. The error is of
    order h⁴ in the steps h, which may differ; a steady turn is exact.

    Parameters
    ----------
    times
        Array (n,) in s, increasing.
    omega_body
        Angular velocities in body axes at these times in rad/s: bivectors (..., n), or an array (..., n, 3).
        Rates at an instant, not increments over a step.
    start
        Attitudes (...) at ``times[0]``; by default the identity. Batch shapes broadcast.

    Returns
    -------
    Rotors (..., n), continuous from `start` on.

    Examples
    --------
    A gyroscope reads 0.5 rad/s about e3 for 2 s:

    >>> times = np.linspace(0, 2, 5)
    >>> R = ph.attitude_from_rates(times, np.tile([0, 0, 0.5], (5, 1)))
    >>> R.angle.round(6)
    array([0.  , 0.25, 0.5 , 0.75, 1.  ])
    """
    rates = as_bivectors(omega_body, "omega_body")
    if rates.ndim < 2 or not rates.shape[-2]:
        raise ValueError(f"omega_body needs rates (..., n, 3), n > 0, got shape {rates.shape}")
    finite = np.isfinite(rates).all(axis=-1)
    if not finite.all():
        raise ValueError(f"the rate{at_index(first_index(~finite))} is not finite; remove this sample")
    if start is None:
        start = Rotor.identity()
    if not isinstance(start, Rotor):
        raise TypeError(f"start must be a Rotor, got {type(start).__name__}")
    count = rates.shape[-2]
    knots = increasing_times(times, count, "rate")
    try:
        shape = np.broadcast_shapes(start.shape, rates.shape[:-2])
    except ValueError:
        raise ValueError(
            f"batch shapes do not broadcast: start has {start.shape}, omega_body {rates.shape[:-2]}"
        ) from None
    turned = np.empty((*rates.shape[:-2], count, 4))
    turned[..., 0, :] = [1, 0, 0, 0]
    if count > 1:
        turned[..., 1:, :] = _running(_steps(knots, rates).components)
    begin = np.broadcast_to(start.astype(float).components, (*shape, 4))[..., np.newaxis, :]
    result: Rotor = Rotor.from_components(begin) * Rotor.from_components(turned)
    return result


def _steps(t: Array, rates: Array) -> Rotor:
    """Return the turns (..., n − 1) from each time to the next."""
    h = np.diff(t)
    rows = np.moveaxis(rates, -2, 0)
    slopes = spline_slopes(t, rows.reshape(len(t), -1)).reshape(rows.shape)
    bends = np.moveaxis(slopes[:-1] - slopes[1:], 0, -2)
    before, after = bivector(rates[..., :-1, :]), bivector(rates[..., 1:, :])
    # The integral of the cubic of these end values and slopes.
    turn = (before + after) * (h / 2) + bivector(bends) * h * (h / 12)
    steps: Rotor = (turn * -0.5 + (before * h).commutator(after * h) / 24).exp()
    return steps


def _running(steps: Array) -> Array:
    """Return the products of the first 1, 2, …, n rotors, from left to right, of components (..., n, 4).

    Products of pairs, whose running products are every second result.
    """
    count = steps.shape[-2]
    if count == 1:
        return steps
    even, odd = Rotor.from_components(steps[..., 0::2, :]), Rotor.from_components(steps[..., 1::2, :])
    pairs = _running((even[..., : count // 2] * odd).components)
    result = np.empty_like(steps)
    result[..., 0, :] = steps[..., 0, :]
    result[..., 1::2, :] = pairs
    rest = Rotor.from_components(pairs[..., : (count - 1) // 2, :]) * even[..., 1:]
    result[..., 2::2, :] = rest.components
    return result


@explains_calls
def rates_from_attitude(times: Any, R: Rotor | Sequence[Rotor]) -> Multivector:
    """Return the angular velocities in body axes at sampled attitudes: the rates of their `RotorSpline`.

    Parameters
    ----------
    times
        Array (n,) in s, increasing, n >= 2.
    R
        Rotors (n,) at these times, of any signs: neighbours are joined the short way.

    Returns
    -------
    Bivectors (n,) in rad/s, with an error of third order in the steps. Splines have rates at other times, and
    accelerations.

    Examples
    --------
    >>> times = np.linspace(0, 2, 41)
    >>> R = ph.Rotor.from_axis_angle(ph.e3, 0.5 * times)
    >>> ph.rates_from_attitude(times, R)["e12"][:3].round(4)
    array([0.5, 0.5, 0.5])
    """
    if isinstance(times, Rotor):
        raise TypeError("the times of attitudes come first: rates_from_attitude(times, R)")
    if not isinstance(R, Multivector) and isinstance(R, list | tuple) and R:
        R = stack(R)
    if isinstance(R, Rotor) and (len(R.shape) != 1 or R.shape[0] < 2):
        raise ValueError(
            f"rates need at least 2 attitudes, as rotors (n,) at increasing times, got {R.shape}"
        )
    spline = RotorSpline(times, R)
    return spline.omega_body(spline.times)
