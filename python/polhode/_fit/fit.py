"""`fit`: the body, its motion and the bias of a sensor from measured attitudes and rates."""

from __future__ import annotations

from typing import Any

import numpy as np

from polhode._algebra.constructors import bivector
from polhode._fit.information import information
from polhode._fit.model import Model, Parameters, shape_of
from polhode._fit.result import Fit
from polhode._fit.samples import attitudes_of, rates_of
from polhode._fit.solve import solve
from polhode._mechanics.bodies import Inertia
from polhode._mechanics.state import angular_velocity
from polhode._support.extras import optional


def fit(
    *,
    attitude: Any = None,
    rates: Any = None,
    sigma_attitude: Any = None,
    sigma_rates: Any = None,
    bias: bool = True,
    clock_offset: bool = False,
    start: Any = None,
) -> Fit:
    """Fit a freely rotating body to measured attitudes, body rates, or both.

    Least squares by Levenberg and Marquardt's method in a trust region (`scipy.optimize.least_squares`,
    ``"trf"``) with the exact derivatives of `FreeMotion.derivatives`. Unknown are two ratios of the
    principal moments, the initial state, the bias of the gyroscope and the offset of its clock. Second
    moments of mass stay positive, so that a real body has the moments. The search starts from each order of
    the moments and from a linear fit of Euler's equations, on a short arc that grows to all of the data.

    Parameters
    ----------
    attitude
        A pair ``(times, rotors)``: times (n,) in s that increase, and Rotors (n,) from body axes to space
        axes, n >= 3. The axes of the data are principal axes of the body.
    rates
        A pair ``(times, omega_body)``: angular velocities in body axes in rad/s, bivectors (m,) or an array
        (m, 3), m >= 3; as those of a gyroscope.
    sigma_attitude
        Standard deviation of an attitude in rad, of each component of a small rotation vector in space axes:
        a number, three for the axes, or rows (n,) or (n, 3).
    sigma_rates
        Standard deviation of a rate in rad/s, in the same forms. Without it (and for attitudes alone, without
        `sigma_attitude`), the noise is estimated from the residuals. Data of both kinds need both.
    bias
        Whether the rates have an unknown constant bias.
    clock_offset
        Whether to fit the time to add to the times of the rates; needs attitudes, too.
    start
        A pair ``(inertia, omega_body)`` at the first time to start from, instead of the search; the inertia
        is diagonal.

    Returns
    -------
    Fit
        Moments relative to the largest, state, bias, covariance, residuals, and what the data do not
        determine. Of rates alone the attitude is not determined, and `rotor` is None.

    Raises
    ------
    ValueError
        For data that are not finite, too few, or in wrong shapes, and if no start leads to a fit.
    ImportError
        Without SciPy: ``pip install 'polhode[scipy]'``.
    """
    optional("scipy.optimize", "scipy", "a fit")
    attitudes = attitudes_of(attitude, sigma_attitude)
    measured = rates_of(rates, sigma_rates)
    data = {name: x for name, x in (("attitude", attitudes), ("rates", measured)) if x is not None}
    if not data:
        raise ValueError("fit needs data: give attitude=(times, rotors), rates=(times, omega_body), or both")
    if len(data) == 2 and not all(x.is_known for x in data.values()):
        raise ValueError("attitudes and rates together need sigma_attitude and sigma_rates, to weigh them")
    if clock_offset and len(data) < 2:
        raise ValueError(
            "clock_offset needs attitudes and rates: free motion does not depend on the time of its start, "
            "so that the offset of one clock cannot be found"
        )
    first = min(float(x.times[0]) for x in data.values())
    model = Model(attitudes, measured, first, bool(bias) and measured is not None, bool(clock_offset))
    dof = 3 * sum(map(len, data.values())) - model.size
    if dof <= 0:
        raise ValueError(
            f"{dof + model.size} measured components cannot determine {model.size} parameters; give more data"
        )
    found, *others = solve(model, None if start is None else _start(start, model))
    sums = float((model.residuals(found) ** 2).sum())
    is_known = all(x.is_known for x in data.values())
    variance = 1.0 if is_known else sums / dof
    facts = information(model, found, variance, others)
    differences = dict(zip(data, model.differences(found), strict=True))
    return Fit(
        inertia=Inertia.from_principal_moments(*(found.moments / found.moments.max()).tolist()),
        omega_body=bivector(found.omega),
        rotor=found.rotor,
        time=first,
        bias=bivector(found.bias) if model.has_bias else None,
        clock_offset=found.offset if model.has_offset else None,
        names=facts.names,
        values=facts.values,
        covariance=facts.covariance,
        times={name: x.times for name, x in data.items()},
        residuals={name: differences[name] / x.sigma / np.sqrt(variance) for name, x in data.items()},
        noise={name: float(np.sqrt(np.mean(d**2))) for name, d in differences.items()},
        chi2_reduced=sums / dof if is_known else None,
        dof=dof,
        undetermined=facts.undetermined,
    )


def _start(start: Any, model: Model) -> Parameters:
    """Return the parameters of a start that the caller gives."""
    if not isinstance(start, tuple | list) or len(start) != 2 or not isinstance(start[0], Inertia):
        raise TypeError("start must be a pair (Inertia, omega_body)")
    inertia, omega = start
    matrix, rate = inertia.matrix, angular_velocity(omega).components
    if matrix.shape != (3, 3) or rate.shape != (3,):
        raise ValueError(f"start needs one body, got omega_body of shape {rate.shape}")
    moments = matrix.diagonal()
    if np.abs(matrix - np.diag(moments)).max() > 1e-12 * moments.max():
        raise ValueError("the inertia of start must be diagonal: axes of the data are principal axes")
    fractions = np.maximum(moments.sum() / 2 - moments, 1e-9 * moments.sum())
    rotor = None if model.attitudes is None else model.attitudes.values[0]
    return Parameters(shape_of(fractions), rate, rotor, np.zeros(3))
