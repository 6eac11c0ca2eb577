"""Covariance of the parameters of a fit, and a statement of those that the data do not determine."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from polhode._fit.model import Model, Parameters
from polhode._support.arrays import Array

# A direction counts as not determined if it is uncertain by more than half of the size of its parameters.
_UNSURE = 0.5
_PART = 0.35  # least component of a direction, relative to the largest, of parameters that are named
_EQUAL = 2.0  # standard deviations within which moments count as equal
# Other bodies are reported up to this increase of chi-square (5 standard deviations) if a ratio differs by so
# much. Noise alone fits a small wobble of some frequency or other, with a decrease of about 2 ln n.
_RIVAL, _APART = 25.0, 0.02
_AXES = ("1", "2", "3")

SCALE = "overall scale of the moments: free motion depends on their ratios only"
ATTITUDE = "attitude: angular velocities in the body do not contain it"


@dataclass(frozen=True, eq=False)
class Information:
    """Names, values and covariance of the parameters, and what the data do not determine."""

    names: tuple[str, ...]
    values: Array
    covariance: Array
    undetermined: tuple[str, ...]


def information(model: Model, at: Parameters, variance: float, others: list[Parameters]) -> Information:
    """Return the information of residuals of this variance at the best fit; `others` fit worse."""
    top = int(np.argmax(at.moments))
    ratios = at.moments / at.moments[top]
    rest = [k for k in range(3) if k != top]
    jacobian = model.jacobian(at)
    jacobian[:, :3] *= at.moments[top]
    jacobian = np.delete(jacobian, top, axis=1) / np.sqrt(variance)
    names = [f"i{k + 1}/i{top + 1}" for k in rest] + [f"omega_{k}" for k in _AXES]
    values = [*ratios[rest], *at.omega]
    rate = model.rate
    sizes = [1.0] * 2 + [rate] * 3
    if at.rotor is not None:
        names, values, sizes = names + [f"attitude_{k}" for k in _AXES], values + [0.0] * 3, sizes + [1.0] * 3
    if model.has_bias:
        names, values, sizes = names + [f"bias_{k}" for k in _AXES], [*values, *at.bias], sizes + [rate] * 3
    if model.has_offset:
        names, values, sizes = [*names, "clock_offset"], [*values, at.offset], [*sizes, 1 / rate]
    scale = np.array(sizes)
    _, singular, rows = np.linalg.svd(jacobian * scale, full_matrices=False)
    least = float(singular[0]) * np.finfo(float).eps * len(scale) or 1.0
    spread = 1 / np.maximum(singular, least)
    root = scale[:, np.newaxis] * rows.T * spread
    covariance = root @ root.T
    statements = [SCALE] + ([ATTITUDE] if at.rotor is None else [])
    errors = np.sqrt(np.diag(covariance)[:2])
    unsure = [
        f"{name}: its standard deviation is {error:.2g}"
        for name, error in zip(names, errors, strict=False)
        if error > _UNSURE
    ]
    unsure += _directions(names, rows, spread, singular <= least)
    unsure += _rivals(model, at, variance, others)
    if unsure:
        unsure.append(_arc(model, at))
    statements += unsure + list(_symmetries(ratios, covariance, rest))
    return Information(tuple(names), np.array(values), covariance, tuple(statements))


def _directions(names: list[str], rows: Array, spread: Array, none: Any) -> Iterator[str]:
    """Yield a statement for each singular direction that is uncertain, in units of the parameters' sizes."""
    for row, size, is_free in zip(rows, spread, none, strict=True):
        if size <= _UNSURE:
            continue
        parts = np.abs(row)
        named = [name for name, x in zip(names, parts, strict=True) if x >= _PART * parts.max()]
        which = named[0] if len(named) == 1 else f"a combination of {', '.join(named)}"
        yield f"{which}: " + ("no information" if is_free else f"uncertain by {100 * size:.2g} %")


def _rivals(model: Model, at: Parameters, variance: float, others: list[Parameters]) -> Iterator[str]:
    """Yield a statement for each other body that fits almost as well."""
    best = float((model.residuals(at) ** 2).sum())
    known = [at.moments / at.moments.max()]
    for other in others:
        moments = other.moments / other.moments.max()
        worse = (float((model.residuals(other) ** 2).sum()) - best) / variance
        if worse < _RIVAL and all(np.abs(moments - x).max() > _APART for x in known):
            known.append(moments)
            text = ", ".join(f"{x:.3g}" for x in moments)
            yield f"which body: moments {text} fit almost as well, with a chi-square larger by {worse:.2g}"


def _arc(model: Model, at: Parameters) -> str:
    """Return how much of the motion the data cover."""
    source = model.rates or model.attitudes
    assert source is not None
    rates = model.motion(at).at(source.times - model.start).omega_body.components
    change = np.sqrt(np.mean((rates - rates.mean(axis=0)) ** 2) / (np.mean(rates**2) or 1.0))
    return (
        f"the data cover {source.turn()[-1] / (2 * np.pi):.2g} turns, in which the angular velocity in the "
        f"body varies by {100 * change:.2g} %: short arcs and steady rotations determine little"
    )


def _symmetries(ratios: Array, covariance: Array, others: list[int]) -> Iterator[str]:
    """Yield a statement for each two moments that agree within their uncertainty."""
    for axis in range(3):
        a, b = (k for k in range(3) if k != axis)
        row = np.zeros(2)
        for sign, k in ((1, a), (-1, b)):
            if k in others:
                row[others.index(k)] += sign
        deviation = float(np.sqrt(row @ covariance[:2, :2] @ row))
        if abs(ratios[a] - ratios[b]) <= _EQUAL * deviation and deviation <= _UNSURE:
            yield (
                f"whether i{a + 1} and i{b + 1} differ: they agree within {_EQUAL:g} standard deviations; of "
                f"a body symmetric about axis {axis + 1}, no data determine the directions of the other axes"
            )
