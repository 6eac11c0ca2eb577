"""Start values of a fit: bodies of every regime, and the body that a linear estimate gives."""

from __future__ import annotations

import itertools

import numpy as np

from polhode._fit.model import Model, Parameters, shape_of
from polhode._fit.samples import Samples
from polhode._support.arrays import Array

# Second moments of mass of the bodies that are tried, in any order of the axes.
_BODIES = tuple(itertools.permutations((0.6, 0.3, 0.1)))
_LEAST = 0.02  # of a second moment of the linear estimate, relative to their sum
_STEADY, _FEWEST = 0.4, 3  # rad of turn, and least number, over which the first rates are averaged


def starts(model: Model) -> list[Parameters]:
    """Return the start values: a linear estimate first, then each order of the moments."""
    source = model.rates or model.attitudes
    assert source is not None
    n = max(_FEWEST, int(np.searchsorted(source.turn(), _STEADY)))
    omega = source.rates[:n].mean(axis=0)
    rotor = model.attitudes.values[0] if model.attitudes is not None else None
    bodies = [_linear(source, model.has_bias), *map(np.array, _BODIES)]
    return [Parameters(shape_of(x), omega, rotor, np.zeros(3)) for x in bodies]


def _linear(samples: Samples, has_bias: bool) -> Array:
    """Return second moments of mass from a linear fit of Euler's equations.

    Their integrals ``ω_1(t) = c + p_1 ∫ω_2 ω_3 dt``, ``p_1 = (i2 − i3)/i1``, are linear in c and p_1; a bias
    adds terms in ``∫ω_2 dt``, ``∫ω_3 dt`` and t. The moments are the null vector of the three equations
    ``p_1 i1 = i2 − i3``.
    """
    t, rates = samples.times - samples.times[0], samples.rates
    equations = np.zeros((3, 3))
    for k in range(3):
        a, b = (k + 1) % 3, (k + 2) % 3
        columns = [np.ones_like(t), _integral(t, rates[:, a] * rates[:, b])]
        if has_bias:
            columns += [t, _integral(t, rates[:, a]), _integral(t, rates[:, b])]
        matrix = np.stack(columns, axis=1)
        scale = np.linalg.norm(matrix, axis=0)
        scale[scale == 0] = 1.0
        found = np.linalg.lstsq(matrix / scale, rates[:, k], rcond=1e-9)[0] / scale
        equations[k, [k, a, b]] = np.clip(found[1], -0.99, 0.99), -1, 1
    moments = np.linalg.svd(equations)[2][-1]
    moments = moments / moments.sum() * 2 if moments.sum() else np.full(3, 2 / 3)
    fractions = np.clip(np.nan_to_num(1 - moments, nan=1 / 3), _LEAST, 1.0)
    return np.asarray(fractions / fractions.sum())


def _integral(t: Array, values: Array) -> Array:
    return np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(t))])
