"""Start values of a fit: bodies of every regime, and the body that a linear estimate gives."""

from __future__ import annotations

import itertools

import numpy as np

from polhode._algebra.rotor import Rotor
from polhode._fit.model import Model
from polhode._fit.parameters import Parameters, shape_of
from polhode._fit.samples import Samples
from polhode._support.arrays import Array

# Second moments of mass of the bodies that are tried, in any order of the axes.
_BODIES = tuple(itertools.permutations((0.6, 0.3, 0.1)))
_LEAST = 0.02  # of a second moment of the linear estimate, relative to their sum
_STEADY, _FEWEST = 0.4, 3  # rad of turn, and least number, over which the first rates are averaged
# Axes that are tried: with the orders of the moments, none is farther away than about 45 degrees.
_AXES = ((0.0, 0.0, 0.0), *(tuple(row) for row in (np.pi / 4 * np.eye(3)).tolist()))
# Attitudes that are tried without measured ones: each axis of the body upwards and downwards.
_UPRIGHT = (
    *((0.0, 0.0, 0.0), (np.pi, 0.0, 0.0)),
    *((s * np.pi / 2, 0.0, 0.0) for s in (1, -1)),
    *((0.0, s * np.pi / 2, 0.0) for s in (1, -1)),
)
# Largest moments that are tried, relative to that of a body which the torque turns within a radian of its
# rotation.
_SCALES = (1.0, 10.0, 100.0)


def starts(model: Model, axes: Rotor) -> list[Parameters]:
    """Return the start values: a linear estimate first, then each order of the moments."""
    source, layout = model.source, model.layout
    n = max(_FEWEST, int(np.searchsorted(source.turn(), _STEADY)))
    omega = source.rates[:n].mean(axis=0)
    turns = _AXES if layout.axes else _AXES[:1]
    frames = [Rotor.from_rotation_vector(x) * axes for x in turns]
    rotors: list[Rotor | None] = [None]
    if model.attitudes is not None:
        rotors = [model.attitudes.values[0]]
    elif layout.attitude:
        rotors = [Rotor.from_rotation_vector(x) for x in _UPRIGHT]
    torque = np.empty(0) if model.laws is None else model.laws.values
    found = []
    for frame, rotor in itertools.product(frames, rotors):
        linear = _linear(source, model.rates is not None and layout.bias, frame)
        for body, scale in itertools.product([linear, *map(np.array, _BODIES)], _scales(model, rotor)):
            found.append(Parameters(shape_of(body), omega, rotor, np.zeros(3), 0.0, frame, scale, torque))
    return found


def _scales(model: Model, rotor: Rotor | None) -> list[float]:
    """Return logarithms of the largest moments that are tried."""
    if not model.layout.scale or model.laws is None:
        return [0.0]
    size = model.laws.strength(model.start, rotor, model.source.rates)
    return [float(np.log(size / model.rate**2 * x)) for x in _SCALES]


def _linear(samples: Samples, has_bias: bool, axes: Rotor) -> Array:
    """Return second moments of mass from a linear fit of Euler's equations on these principal axes.

    Their integrals ``ω_1(t) = c + p_1 ∫ω_2 ω_3 dt``, ``p_1 = (i2 − i3)/i1``, are linear in c and p_1; a bias
    adds terms in ``∫ω_2 dt``, ``∫ω_3 dt`` and t. The moments are the null vector of the three equations
    ``p_1 i1 = i2 − i3``.
    """
    t, rates = samples.times - samples.times[0], samples.rates @ axes.to_matrix().T
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
