"""Rounding errors of exp and log over all sizes, against 60 digits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mpmath
import numpy as np

import polhode as ph

ULP = 2.0**-52
DIGITS = 60


@dataclass(frozen=True)
class Errors:
    """Errors in ulp, relative to the size of the result, at sizes of bivectors or angles of rotors."""

    name: str
    about: str
    sizes: Any
    ulps: Any


def measured(rng: np.random.Generator, count: int) -> list[Errors]:
    """Measure exp of bivectors and log of rotors; single values have the same bits as batches."""
    return [_exp(rng, count), _log(rng, count)]


def _bivectors(rng: np.random.Generator, count: int) -> Any:
    """Bivectors in random planes: half near multiples of π/2, a tenth from 1e-300 on, the rest from 1e-8."""
    sizes = 10.0 ** rng.uniform(np.where(rng.random(count) < 0.2, -300, -8), 6)
    near = 0.5 * np.pi * rng.integers(1, 9, count) * (1 + 10.0 ** rng.uniform(-16, -2, count))
    sizes = np.where(rng.random(count) < 0.5, sizes, near)
    planes = rng.normal(size=(count, 3))
    return planes / np.linalg.norm(planes, axis=-1, keepdims=True) * sizes[:, np.newaxis]


def _exp(rng: np.random.Generator, count: int) -> Errors:
    given = _bivectors(rng, count)
    found = ph.bivector(given).exp().components
    sizes, ulps = np.empty(count), np.empty(count)
    with mpmath.workdps(DIGITS + 20):
        for k, (b, r) in enumerate(zip(given.tolist(), found.tolist(), strict=True)):
            size = mpmath.sqrt(sum(mpmath.mpf(x) ** 2 for x in b))
            part = mpmath.sin(size) / size
            true = [mpmath.cos(size), *(part * mpmath.mpf(x) for x in b)]
            sizes[k] = float(size)
            ulps[k] = _distance(r, true) / ULP
    return Errors("exp(B)", "|exp(B) − true|, of a unit rotor, against |B|", sizes, ulps)


def _log(rng: np.random.Generator, count: int) -> Errors:
    given = _bivectors(rng, count)
    rotors = ph.bivector(given).exp()
    found = rotors.log().components
    sizes, ulps = np.empty(count), np.empty(count)
    with mpmath.workdps(DIGITS + 20):
        for k, (r, b) in enumerate(zip(rotors.components.tolist(), found.tolist(), strict=True)):
            scalar, plane = mpmath.mpf(r[0]), [mpmath.mpf(x) for x in r[1:]]
            size = mpmath.sqrt(sum(x * x for x in plane))
            angle = mpmath.atan2(size, scalar)
            true = [angle * x / size for x in plane] if size else [mpmath.mpf(0)] * 3
            sizes[k] = float(angle)
            ulps[k] = _distance(b, true) / angle / ULP if angle else 0.0
    return Errors("log(R)", "|log R − true|/|log R|, against |log R|", sizes, ulps)


def _distance(found: list[float], true: list[Any]) -> Any:
    return mpmath.sqrt(sum((mpmath.mpf(x) - y) ** 2 for x, y in zip(found, true, strict=True)))
