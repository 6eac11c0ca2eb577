"""The search for the best fit: least squares from many starts, over arcs that grow."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from polhode._fit.model import Model, Parameters
from polhode._fit.starts import starts
from polhode._support.arrays import Array
from polhode._support.extras import optional

# A wide prior keeps directions finite that the data do not determine: standard deviations of the logarithms
# of the second moments, and of the bias relative to the rates. It is no part of the covariance.
_SHAPE, _BIAS = 10.0, 10.0
# The bias is held closer to 0 on arcs that are too short to determine it.
_BIAS_ON_ARC = 0.1
_FIRST, _GROWTH = 3.0, 2.5  # rad of turn in the first arc; factor from arc to arc
_LEAST = 2  # samples per parameter in the first arc
_KEPT, _WORSE = 3, 4.0  # starts that go on to the next arc, if their cost is less than so many times the best
# Relative change of the sum of squares that ends the search: parameters then move by less than a hundredth of
# their standard deviation, up to 1e5 data.
_ENOUGH = 1e-9


def solve(model: Model, start: Parameters | None) -> list[Parameters]:
    """Return the parameters of fits, best first; a ValueError if no start leads to one."""
    if start is not None:
        candidates = [start]
        ends: list[float] = []
    else:
        candidates, ends = starts(model), _arcs(model)
    for end in ends:
        candidates = _best(model.before(end), candidates, _BIAS_ON_ARC, 60)
    return _best(model, candidates, _BIAS, 100)


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


def _best(model: Model, candidates: Iterable[Parameters], bias: float, calls: int) -> list[Parameters]:
    """Return the solutions from these starts, best first, without those that are much worse or equal."""
    found: list[tuple[float, Parameters]] = []
    reasons: list[ValueError] = []
    for candidate in candidates:
        try:
            cost, solution = _solved(model, candidate, bias, calls)
        except ValueError as error:
            reasons.append(error)
            continue
        if np.isfinite(cost) and not any(_is_same(solution, other) for _, other in found):
            found.append((cost, solution))
    if not found:
        raise ValueError(f"no start leads to a fit: {reasons[0] if reasons else 'the residuals overflow'}")
    found.sort(key=lambda pair: pair[0])
    limit = _WORSE * found[0][0]
    return [solution for cost, solution in found[:_KEPT] if cost <= limit]


def _is_same(a: Parameters, b: Parameters) -> bool:
    return np.allclose(a.moments, b.moments, atol=1e-6) and np.allclose(
        a.omega, b.omega, rtol=1e-6, atol=1e-6 * float(np.abs(b.omega).max())
    )


def _solved(model: Model, base: Parameters, bias: float, calls: int) -> tuple[float, Parameters]:
    """Return the cost and the solution from one start, by Levenberg and Marquardt's method.

    ``"trf"`` without bounds, because the first step of MINPACK's ``"lm"`` is almost unlimited: it leaves the
    start for flat bodies.
    """
    optimize: Any = optional("scipy.optimize", "scipy", "a fit")
    weights = _prior(model, bias)

    def prior(at: Parameters) -> Array:
        values = [at.shape]
        if model.has_bias:
            values.append(at.bias)
        if model.has_offset:
            values.append(np.array([at.offset]))
        return np.concatenate(values) * weights

    def residuals(step: Array) -> Array:
        at = model.moved(base, step)
        return np.concatenate([model.residuals(at), prior(at)])

    columns = [0, 1, *range(model.size - len(weights) + 2, model.size)]

    def jacobian(step: Array) -> Array:
        at = model.moved(base, step)
        turn = step[5:8] if base.rotor is not None else None
        full = model.jacobian(at, turn)
        rows = np.concatenate([full[:, :3] @ at.moments_by_shape(), full[:, 3:]], axis=1)
        pulled = np.zeros((len(weights), model.size))
        pulled[np.arange(len(weights)), columns] = weights
        return np.concatenate([rows, pulled])

    with np.errstate(over="ignore", invalid="ignore"):
        done = optimize.least_squares(
            residuals,
            np.zeros(model.size),
            jacobian,
            method="trf",
            x_scale=model.scale(),
            xtol=1e-9,
            ftol=_ENOUGH,
            gtol=1e-12,
            max_nfev=calls,
        )
    return float(done.cost), model.moved(base, done.x)


def _prior(model: Model, bias: float) -> Array:
    """Return one over the standard deviations of shape (2), bias (3) and offset (1)."""
    weights = [1 / _SHAPE] * 2
    weights += [1 / (bias * model.rate)] * 3 if model.has_bias else []
    if model.has_offset and model.rates is not None:
        weights.append(1 / float(np.ptp(model.rates.times)))
    return np.array(weights)
