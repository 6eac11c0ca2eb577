"""The search for the best fit: least squares from many starts, over arcs that grow."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from polhode._algebra.rotor import Rotor
from polhode._fit.model import Model
from polhode._fit.parameters import Parameters
from polhode._fit.starts import starts
from polhode._support.arrays import Array
from polhode._support.extras import optional

# A wide prior keeps directions finite that the data do not determine: standard deviations of the logarithms
# of the second moments and of the scale, of the bias relative to the rates, and of parameters of the torque
# relative to their sizes. It is not part of the covariance.
_SHAPE, _SCALE, _BIAS, _TORQUE = 10.0, 10.0, 10.0, 100.0
# The bias and the torque are held closer to their starts on arcs that are too short to determine them.
_ON_ARC = 0.01
_FIRST, _GROWTH = 3.0, 2.5  # rad of turn in the first arc; factor from arc to arc
_LEAST = 2  # samples per parameter in the first arc
# Mean square of residuals up to which a start that the caller gives has led to the best fit.
_GOOD = 2.0
_CALLS, _CALLS_ON_ARC = 100, 60
# Of many starts the best go on after a few evaluations.
_MANY, _FEW = 8, 6
_KEPT, _WORSE = 3, 4.0  # starts that go on to the next arc, if their cost is less than so many times the best
# Relative change of the sum of squares that ends the search: parameters then move by less than a hundredth of
# their standard deviation, up to 1e5 data.
_ENOUGH = 1e-9
_ENOUGH_ON_ARC = 1e-4


def solve(model: Model, axes: Rotor, start: Parameters | None) -> list[Parameters]:
    """Return the parameters of fits, best first; a ValueError if no start leads to one.

    `axes` turns axes of the data to principal axes, or to those to start from.
    """
    if start is None:
        return _best(model, _along_arcs(model, starts(model, axes)), 1.0, _CALLS)
    found = _best(model, [start], 1.0, _CALLS_ON_ARC)
    if _is_good(model, found[0]):
        return found
    return _best(model, [*_along_arcs(model, [start]), *found], 1.0, _CALLS)


def refined(model: Model, found: list[Parameters]) -> list[Parameters]:
    """Return the fits from solutions for other standard deviations, best first."""
    return _best(model, found, 1.0, _CALLS)


def _is_good(model: Model, at: Parameters) -> bool:
    """Return whether residuals are of the size of their standard deviations, as far as these are known."""
    return float(np.mean(model.residuals(at) ** 2)) < _GOOD


def _along_arcs(model: Model, candidates: list[Parameters]) -> list[Parameters]:
    """Return the best solutions of arcs that grow."""
    ends = _arcs(model)
    if len(candidates) > _MANY:
        first = model.before(ends[0]) if ends else model
        candidates = _best(first, candidates, _ON_ARC, _FEW, _MANY)
    for end in ends:
        candidates = _best(model.before(end), candidates, _ON_ARC, _CALLS_ON_ARC)
    return candidates


def _arcs(model: Model) -> list[float]:
    """Return the times at which arcs end that are shorter than the data."""
    source = max((x for x in (model.attitudes, model.rates) if x is not None), key=len)
    turn, ends = source.turn(), []
    first = min(_LEAST * model.size, len(source)) - 1
    reach = max(_FIRST, float(turn[first]))
    while reach < turn[-1]:
        ends.append(float(source.times[min(int(np.searchsorted(turn, reach)), len(turn) - 1)]))
        reach *= _GROWTH
    return ends


def _best(
    model: Model, candidates: Iterable[Parameters], looseness: float, calls: int, kept: int = 0
) -> list[Parameters]:
    """Return the solutions from these starts, best first, without those that are much worse or equal."""
    found: list[tuple[float, Parameters]] = []
    reasons: list[ValueError] = []
    for candidate in candidates:
        try:
            cost, solution = _solved(model, candidate, looseness, calls)
        except ValueError as error:
            reasons.append(error)
            continue
        if np.isfinite(cost) and not any(_is_same(solution, other) for _, other in found):
            found.append((cost, solution))
    if not found:
        raise ValueError(f"no start leads to a fit: {reasons[0] if reasons else 'the residuals overflow'}")
    found.sort(key=lambda pair: pair[0])
    if kept:
        return [solution for _, solution in found[:kept]]
    limit = _WORSE * found[0][0]
    return [solution for cost, solution in found[:_KEPT] if cost <= limit]


def _is_same(a: Parameters, b: Parameters) -> bool:
    return (
        np.allclose(a.moments, b.moments, atol=1e-6)
        and np.allclose(a.omega, b.omega, rtol=1e-6, atol=1e-6 * float(np.abs(b.omega).max()))
        and np.allclose(a.torque, b.torque, rtol=1e-4, atol=1e-300)
    )


def _solved(model: Model, base: Parameters, looseness: float, calls: int) -> tuple[float, Parameters]:
    """Return the cost and the solution from one start, by Levenberg and Marquardt's method.

    ``"trf"`` because the first step of MINPACK's ``"lm"`` is almost unlimited: it leaves the start for flat
    bodies.
    """
    optimize: Any = optional("scipy.optimize", "scipy", "a fit")
    columns, weights = _prior(model, base, looseness)
    offsets = _prior_values(model, base)[columns]
    pulled = np.zeros((len(columns), model.size))
    pulled[np.arange(len(columns)), columns] = weights
    # A motion that fails, far from the data, counts as infinitely far from them.
    rows = model.residuals(base).size

    def residuals(step: Array) -> Array:
        try:
            found = model.residuals(model.layout.moved(base, step))
        except ValueError:
            found = np.full(rows, np.inf)
        return np.concatenate([found, (offsets + step[columns]) * weights])

    def jacobian(step: Array) -> Array:
        return np.concatenate([model.jacobian(model.layout.moved(base, step), step), pulled])

    bounds = {}
    if model.laws is not None and np.isfinite(model.laws.least).any():
        lower = np.full(model.size, -np.inf)
        lower[model.layout.places["torque"]] = model.laws.least - base.torque
        bounds = {"bounds": (lower, np.inf)}
    with np.errstate(over="ignore", invalid="ignore"):
        done = optimize.least_squares(
            residuals,
            np.zeros(model.size),
            jacobian,
            method="trf",
            x_scale=model.scale(base),
            xtol=1e-9,
            ftol=_ENOUGH if looseness == 1.0 else _ENOUGH_ON_ARC,
            gtol=1e-12,
            max_nfev=calls,
            **bounds,
        )
    solution = model.layout.moved(base, done.x)
    return float(done.cost), solution.in_order() if model.layout.axes else solution


def _prior(model: Model, base: Parameters, looseness: float) -> tuple[list[int], Array]:
    """Return the places of parameters with a prior, and one over their standard deviations."""
    of = model.layout.places
    deviations = np.full(model.size, np.inf)
    deviations[of["shape"]] = _SHAPE
    deviations[of["scale"]] = _SCALE
    deviations[of["bias"]] = _BIAS * looseness * model.rate
    deviations[of["torque"]] = _TORQUE * looseness * model.torque_sizes(base)
    if model.rates is not None:
        deviations[of["offset"]] = float(np.ptp(model.rates.times))
    columns = np.flatnonzero(np.isfinite(deviations))
    return columns.tolist(), 1 / deviations[columns]


def _prior_values(model: Model, base: Parameters) -> Array:
    """Return the values of the base (k,) whose prior is around 0; the others count from the base."""
    values, of = np.zeros(model.size), model.layout.places
    values[of["shape"]] = base.shape
    if model.layout.bias:
        values[of["bias"]] = base.bias
    if model.layout.offset:
        values[of["offset"]] = base.offset
    return values
