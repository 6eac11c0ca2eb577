"""Covariance of the parameters of a fit, and a statement of those that the data do not determine."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from polhode._fit.model import Model
from polhode._fit.parameters import Parameters
from polhode._support.arrays import Array

# A direction counts as not determined if it is uncertain by more than half of the size of its parameters.
_UNSURE = 0.5
_PART = 0.35  # least component of a direction, relative to the largest, of parameters that are named
_EQUAL = 2.0  # standard deviations within which moments count as equal
# Other bodies are reported up to this increase of chi-square (5 standard deviations) if a ratio differs by so
# much. Noise alone fits a small wobble of some frequency or other, with a decrease of about 2 ln n.
_RIVAL, _APART = 25.0, 0.02
_AT_BOUND = 0.01  # standard deviations from a bound
_FLAT = 1e-12  # least determinant of the derivatives of two ratios by the shape
_AXES = ("1", "2", "3")

SCALE = "overall scale of the moments: {} on their ratios only"
RELATIVE = "overall scale of the moments: {} are relative to the largest"
ATTITUDE = "attitude: angular velocities in the body do not contain it"


@dataclass(frozen=True, eq=False)
class Information:
    """Names, units, values and covariance of the parameters, and what the data do not determine."""

    names: tuple[str, ...]
    units: tuple[str, ...]
    values: Array
    covariance: Array
    undetermined: tuple[str, ...]


def information(
    model: Model, at: Parameters, variance: float, others: list[Parameters], scaling: Array | None
) -> Information:
    """Return the information of residuals of this variance at the best fit; `others` fit worse.

    `scaling` has the powers of `Laws.scaling`.
    """
    top = int(np.argmax(at.moments))
    rest = [k for k in range(3) if k != top]
    jacobian = model.jacobian(at) / np.sqrt(variance)
    of = model.layout.places
    jacobian[:, of["shape"]] = _by_ratios(jacobian[:, of["shape"]], at, rest, top)
    jacobian[:, of["scale"]] /= float(np.exp(at.scale))
    names, units, values, scale = _parameters(model, at, rest, top, scaling)
    _, singular, rows = np.linalg.svd(jacobian * scale, full_matrices=False)
    least = float(singular[0]) * model.flow.precision * len(scale) or 1.0
    spread = 1 / np.maximum(singular, least)
    root = scale[:, np.newaxis] * rows.T * spread
    covariance = root @ root.T
    unsure = [
        *_large_errors(names, np.sqrt(np.diag(covariance)[:2])),
        *_directions(names, rows, spread, singular <= least),
        *_rivals(model, at, variance, others),
    ]
    if unsure:
        unsure.append(_arc(model, at))
    statements = [
        *_always(model, scaling),
        *unsure,
        *_symmetries(at.ratios, covariance, rest),
        *_bounds(model, at, np.sqrt(np.diag(covariance))[of["torque"]]),
    ]
    return Information(tuple(names), tuple(units), values, covariance, tuple(statements))


def _parameters(
    model: Model, at: Parameters, rest: list[int], top: int, scaling: Array | None
) -> tuple[list[str], list[str], Array, Array]:
    """Return names, units, values and sizes of the parameters, in the order of the columns."""
    of, laws, largest = model.layout.places, model.laws, float(np.exp(at.scale))
    values, scale = np.zeros(model.size), np.ones(model.size)
    sizes = model.torque_sizes(at)
    given: dict[str, tuple[Any, Any, list[str], str]] = {
        "shape": (at.ratios[rest], 1.0, [f"i{k + 1}/i{top + 1}" for k in rest], ""),
        "omega": (at.omega, model.rate, [f"omega_{k}" for k in _AXES], "rad/s"),
        "attitude": (0.0, 1.0, [f"attitude_{k}" for k in _AXES], "rad"),
        "axes": (0.0, 1.0, [f"axes_{k}" for k in _AXES], "rad"),
        "scale": (largest, largest, [f"i{top + 1}"], "kg m²"),
        "torque": (at.torque, sizes, [] if laws is None else laws.names, ""),
        "bias": (at.bias, model.rate, [f"bias_{k}" for k in _AXES], "rad/s"),
        "offset": (at.offset, 1 / model.rate, ["clock_offset"], "s"),
    }
    names: list[str] = []
    units: list[str] = []
    for name, (value, size, own, unit) in given.items():
        if of[name].stop > of[name].start:
            values[of[name]], scale[of[name]] = value, size
            names, units = names + own, units + [unit] * len(own)
    if laws is not None:
        units[of["torque"]] = laws.units(scaling)
    return names, units, values, scale


def _by_ratios(by_shape: Array, at: Parameters, rest: list[int], top: int) -> Array:
    """Return derivatives (n, 2) by the two ratios from those by the shape."""
    by, ratios = at.moments_by_shape(), at.ratios
    slopes = (by[rest] - np.outer(ratios[rest], by[top])) / at.moments[top]
    # Singular for a flat body or a needle, whose shape is at the edge of those of bodies.
    if abs(np.linalg.det(slopes)) < _FLAT:
        return np.asarray(by_shape @ np.linalg.pinv(slopes))
    return np.asarray(by_shape @ np.linalg.inv(slopes))


def _always(model: Model, scaling: Array | None) -> list[str]:
    """Return what no data of this kind determine."""
    found = []
    if model.laws is None:
        found.append(SCALE.format("free motion depends"))
    elif not model.layout.scale:
        relative = [] if scaling is None else [x for x, p in zip(model.laws.names, scaling, strict=True) if p]
        found.append(RELATIVE.format(", ".join(relative)) if relative else SCALE.format("the motion depends"))
    return found if model.layout.attitude else [*found, ATTITUDE]


def _large_errors(names: list[str], errors: Array) -> Iterator[str]:
    """Yield a statement for each of the first parameters with a large standard deviation."""
    for name, error in zip(names, errors, strict=False):
        if error > _UNSURE:
            yield f"{name}: its standard deviation is {error:.2g}"


def _directions(names: list[str], rows: Array, spread: Array, none: Any) -> Iterator[str]:
    """Yield a statement for each singular direction that is uncertain, in units of the parameters' sizes."""
    for row, size, is_free in zip(rows, spread, none, strict=True):
        if size <= _UNSURE and not is_free:
            continue
        parts = np.abs(row)
        named = [name for name, x in zip(names, parts, strict=True) if x >= _PART * parts.max()]
        which = named[0] if len(named) == 1 else f"a combination of {', '.join(named)}"
        yield f"{which}: " + ("no information" if is_free else f"uncertain by {100 * size:.2g} %")


def _rivals(model: Model, at: Parameters, variance: float, others: list[Parameters]) -> Iterator[str]:
    """Yield a statement for each other body that fits almost as well."""
    best = float((model.residuals(at) ** 2).sum())
    known = [at.ratios]
    for other in others:
        moments = other.ratios
        worse = (float((model.residuals(other) ** 2).sum()) - best) / variance
        if worse < _RIVAL and all(np.abs(moments - x).max() > _APART for x in known):
            known.append(moments)
            text = ", ".join(f"{x:.3g}" for x in moments)
            yield f"which body: moments {text} fit almost as well, with a chi-square larger by {worse:.2g}"


def _arc(model: Model, at: Parameters) -> str:
    """Return how much of the motion the data cover."""
    source, none = model.source, np.empty(0)
    rates = model.flow.states(at, none, source.times - model.start)[1]
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


def _bounds(model: Model, at: Parameters, errors: Array) -> Iterator[str]:
    """Yield a statement for each parameter at its bound, where the linearised covariance does not hold."""
    if model.laws is None:
        return
    for name, value, least, error in zip(model.laws.names, at.torque, model.laws.least, errors, strict=True):
        if value - least <= _AT_BOUND * error:
            yield f"{name}: at its bound {least:g}, where its standard deviation does not hold"
