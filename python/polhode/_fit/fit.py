"""`fit`: the body, its motion, torques and sensors from measured attitudes and rates."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np

from polhode._algebra.constructors import bivector
from polhode._algebra.rotor import Rotor
from polhode._fit.information import information
from polhode._fit.laws import Laws, laws_of
from polhode._fit.misfit import misfit
from polhode._fit.model import Model
from polhode._fit.parameters import Layout, Parameters, shape_of
from polhode._fit.result import Fit
from polhode._fit.samples import Samples, attitudes_of, rates_of
from polhode._fit.solve import refined, solve
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.state import angular_velocity
from polhode._support.arrays import Array
from polhode._support.calls import explains_calls
from polhode._support.extras import optional
from polhode.torque import Torque

# The noise of residuals is found to this factor, in at most so many fits.
_CLOSE, _ROUNDS = 2.0, 10


@explains_calls
def fit(
    *,
    attitude: Any = None,
    rates: Any = None,
    sigma_attitude: Any = None,
    sigma_rates: Any = None,
    bias: bool = True,
    clock_offset: bool = False,
    sensor_axes: Rotor | Literal["principal", "fit"] = "principal",
    torque: Torque | None = None,
    free: Sequence[str] = (),
    start: Any = None,
) -> Fit:
    """Fit a rotating body to measured attitudes, body rates, or both.

    Least squares by Levenberg and Marquardt's method in a trust region (`scipy.optimize.least_squares`,
    ``"trf"``). Unknown are two ratios of the principal moments, the initial state, the bias of the gyroscope,
    the offset of its clock, the directions of the principal axes and parameters of torque laws. Second
    moments of mass stay positive, so that a real body has the moments. The search starts from each order of
    the moments and from a linear fit of Euler's equations, on a short arc that grows to all of the data.

    Derivatives of free motion are exact, from `FreeMotion.derivatives`. Those of motion under a torque are
    central differences of `simulate` at a tolerance of 1e-12; steps follow from the change of the motion, so
    that errors are less than 1e-6 of the largest derivative.

    Parameters
    ----------
    attitude
        A pair ``(times, rotors)``: times (n,) in s that increase, and Rotors (n,) from body axes to space
        axes, n >= 3.
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
    sensor_axes
        The axes of the data, which are those of the body in `attitude` and `rates`. ``"principal"``: the
        principal axes. ``"fit"``: unknown. Or a Rotor that turns components in axes of the data to those in
        principal axes: ``x_principal = sensor_axes(x_data)``.
    torque
        A law of `polhode.torque` or a sum of them, on the axes of the data; None for free motion. The time of
        laws is that of the data.
    free
        Names of the parameters of the torque to be fitted, which start from their values in `torque`:
        ``"viscous_damping"`` for all of a law, ``"pd_control.kp"`` for one, ``"formula.k"`` for a value of a
        formula; ``"constant_body[1]"`` for the second of two equal laws. Gains that are equal along the three
        axes are one parameter.
    start
        A pair ``(inertia, omega_body)`` at the first time to start from, instead of the search, or a triple
        with the attitude, a Rotor. The inertia is on the axes of the data.

    Returns
    -------
    Fit
        Moments relative to the largest (in kg m² where a torque determines them), state, bias, covariance,
        residuals, and what the data do not determine. If there are only rates and the torque does not depend
        on the attitude, the attitude is undetermined, and `rotor` is None.

    Warns
    -----
    RuntimeWarning
        If the body does not fit: a reduced chi-square above 10, or without standard deviations residuals that
        are as large as the motion, or large and correlated from sample to sample; `Fit.misfit` has the text.

    Raises
    ------
    ValueError
        For data that are not finite, too few, or in wrong shapes, for those of a body at rest without a
        torque, for names that the torque does not have, and if no start leads to a fit.
    ImportError
        Without SciPy: ``pip install 'polhode[scipy]'``.

    Examples
    --------
    The ratios of the moments of a tumbling body from its rates, without noise:

    >>> inertia = ph.Inertia.from_principal_moments(1, 2, 2.5)
    >>> times = np.linspace(0, 5, 51)
    >>> rates = ph.FreeMotion(inertia, ph.Rotor.identity(), [0.5, 2, 0.5]).at(times).omega_body
    >>> found = ph.fit(rates=(times, rates), sigma_rates=1e-3)
    >>> found.inertia.principal_moments.round(4)  # relative to the largest
    array([0.4, 0.8, 1. ])
    >>> found.undetermined[0]
    'overall scale of the moments: free motion depends on their ratios only'
    """
    optional("scipy.optimize", "scipy", "a fit")
    attitudes = attitudes_of(attitude, sigma_attitude)
    measured = rates_of(rates, sigma_rates)
    data = {name: x for name, x in (("attitude", attitudes), ("rates", measured)) if x is not None}
    _check_data(data, clock_offset)
    first = min(float(x.times[0]) for x in data.values())
    laws = laws_of(torque, free)
    scaling = laws.scaling(first)
    layout = Layout(
        attitude=attitudes is not None or laws.depends_on_attitude(first),
        bias=bool(bias) and measured is not None,
        offset=bool(clock_offset),
        axes=isinstance(sensor_axes, str) and sensor_axes == "fit",
        scale=scaling is None,
        torque=laws.size,
    )
    if not laws.torque.laws and not any(x.rates.any() for x in data.values()):
        raise ValueError(
            "the body is at rest in all data: without a rotation or a torque nothing of it can be found; "
            "measure it while it turns"
        )
    model = Model(attitudes, measured, first, layout, laws if laws.torque.laws else None)
    dof = 3 * sum(map(len, data.values())) - model.size
    if dof <= 0:
        raise ValueError(
            f"{dof + model.size} measured components cannot determine {model.size} parameters; give more data"
        )
    axes = _axes(sensor_axes)
    fits = solve(model, axes, None if start is None else _start(start, model, axes, laws))
    is_known = all(x.is_known for x in data.values())
    if not is_known:
        model, fits = _reweighted(model, fits, dof)
    result = _result(model, fits, dof, is_known, scaling)
    if result.misfit is not None:
        warnings.warn(result.misfit, RuntimeWarning, stacklevel=3)
    return result


def _check_data(data: Mapping[str, Samples], clock_offset: bool) -> None:
    """Raise a ValueError unless the data, attitudes or rates or both, are sufficient."""
    if not data:
        raise ValueError("fit needs data: give attitude=(times, rotors), rates=(times, omega_body), or both")
    if len(data) == 2 and not all(x.is_known for x in data.values()):
        raise ValueError("attitudes and rates together need sigma_attitude and sigma_rates, to weigh them")
    if clock_offset and len(data) < 2:
        raise ValueError(
            "clock_offset needs attitudes and rates: free motion does not depend on the time of its start, "
            "so that the offset of one clock cannot be found"
        )


def _result(model: Model, fits: list[Parameters], dof: int, is_known: bool, scaling: Array | None) -> Fit:
    """Return the best fit with its uncertainties; the `fits` are sorted, best first."""
    found, *others = fits
    layout, laws = model.layout, model.laws
    samples = {"attitude": model.attitudes, "rates": model.rates}
    data = {name: x for name, x in samples.items() if x is not None}
    reduced = _reduced(model, found, dof)
    variance = 1.0 if is_known else max(reduced, _least_variance(model))
    facts = information(model, found, variance, others, scaling)
    differences = dict(zip(data, model.differences(found), strict=True))
    noise = {name: float(np.sqrt(np.mean(d**2))) for name, d in differences.items()}
    return Fit(
        inertia=found.inertia,
        omega_body=bivector(found.omega),
        rotor=found.rotor,
        time=model.start,
        sensor_axes=found.axes if layout.axes else None,
        torque=None if laws is None else laws.with_values(found.torque),
        bias=bivector(found.bias) if layout.bias else None,
        clock_offset=found.offset if layout.offset else None,
        names=facts.names,
        units=facts.units,
        values=facts.values,
        covariance=facts.covariance,
        times={name: x.times for name, x in data.items()},
        residuals={name: differences[name] / x.sigma / np.sqrt(variance) for name, x in data.items()},
        noise=noise,
        chi2_reduced=reduced if is_known else None,
        dof=dof,
        undetermined=facts.undetermined,
        misfit=misfit(data, differences, noise, reduced if is_known else None),
    )


def _reweighted(model: Model, found: list[Parameters], dof: int) -> tuple[Model, list[Parameters]]:
    """Return the model with the noise of the residuals, and the fits to it.

    The noise that was assumed before may be much larger; the prior would then pull the parameters by more
    than their standard deviations.
    """
    for _ in range(_ROUNDS):
        noise = float(np.sqrt(max(_reduced(model, found[0], dof), _least_variance(model))))
        if 1 / _CLOSE <= noise <= _CLOSE:
            break
        model = model.with_noise(noise)
        found = refined(model, found)
    return model, found


def _reduced(model: Model, found: Parameters, dof: int) -> float:
    """Return the sum of squares of the residuals, in standard deviations, per degree of freedom."""
    return float((model.residuals(found) ** 2).sum()) / dof


def _least_variance(model: Model) -> float:
    """Return the least variance of residuals in standard deviations; that of data without noise."""
    return max((x.least / float(x.sigma.min())) ** 2 for x in model.samples)


def _axes(given: Any) -> Rotor:
    """Return the rotor from axes of the data to principal axes, or to start from."""
    if isinstance(given, str) and given in ("principal", "fit"):
        return Rotor.identity()
    if not isinstance(given, Rotor) or given.shape:
        raise TypeError(f"sensor_axes must be 'principal', 'fit' or a single Rotor, got {given!r}")
    return given.astype(float)


def _start(start: Any, model: Model, axes: Rotor, laws: Laws) -> Parameters:
    """Return the parameters of a start that the caller gives."""
    if (
        not isinstance(start, tuple | list)
        or len(start) not in (2, 3)
        or not isinstance(start[0], Inertia)
        or not (len(start) == 2 or isinstance(start[2], Rotor))
    ):
        raise TypeError("start must be a pair (Inertia, omega_body) or a triple (Inertia, omega_body, Rotor)")
    inertia, rate = start[0], angular_velocity(start[1]).components
    if inertia.matrix.shape != (3, 3) or rate.shape != (3,):
        raise ValueError(f"start needs one body, got omega_body of shape {rate.shape}")
    if model.layout.axes:
        axes = ~inertia.principal_frame
    turned = axes.to_matrix()
    matrix = turned @ inertia.matrix @ turned.T
    moments = matrix.diagonal()
    if np.abs(matrix - np.diag(moments)).max() > 1e-12 * moments.max():
        raise ValueError(
            "the inertia of start must be diagonal: axes of the data are principal axes"
            if axes == Rotor.identity()
            else "the inertia of start does not have the principal axes of sensor_axes"
        )
    fractions = np.maximum(moments.sum() / 2 - moments, 1e-9 * moments.sum())
    rotor = start[2] if len(start) == 3 else None
    if rotor is None and model.layout.attitude:
        rotor = Rotor.identity() if model.attitudes is None else model.attitudes.values[0]
    scale = float(np.log(moments.max())) if model.layout.scale else 0.0
    return Parameters(
        shape_of(fractions),
        rate,
        rotor if model.layout.attitude else None,
        np.zeros(3),
        axes=axes,
        scale=scale,
        torque=laws.values,
    )
