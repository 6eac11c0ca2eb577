"""Reference motion of free and heavy tops by Taylor series in extended precision.

It uses none of the libraries that it judges. On x86 the numbers have 64 bits, so that rounding is 2000 times
smaller than that of the integrators; where NumPy's `longdouble` is a double, it is as accurate as they are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

STEP, TERMS = 0.5, 44
SECONDS = 2.5e-3  # approximate run time for a unit of time

# The state is ω, γ, R and a constant 1: all its rates are sums of products of two of these.
OMEGA, GAMMA, ROTOR, ONE = (0, 1, 2), (3, 4, 5), (6, 7, 8, 9), 10
Terms = dict[tuple[int, int, int], float]


@dataclass(frozen=True)
class Top:
    """A body held at the origin, or free where c = 0: V = c·γ, γ = ~R e3 R.

    `omega` (body axes) and `rotor` (1, e2e3, e3e1, e1e2; any norm) are the values at time 0.
    """

    name: str
    moments: tuple[float, float, float]
    c: tuple[float, float, float]
    omega: tuple[float, float, float]
    rotor: tuple[float, float, float, float]


def rotors(tops: Sequence[Top], times: Sequence[float]) -> Any:
    """Return rotors (time, top, 4), continuous in time, at rising multiples of the step."""
    products = sorted({key[1:] for top in tops for key in _rates(top)})
    left, right = np.array(products).T
    sums = np.array([[[_rates(top).get((k, *p), 0.0) for p in products] for k in range(11)] for top in tops])
    sums = sums.astype(np.longdouble)
    state = np.array([_start(top) for top in tops])
    found, now = [], 0
    for time in times:
        until = round(time / STEP)
        if until * STEP != time or until < now:
            raise ValueError(f"time {time} is no rising multiple of {STEP}")
        for _ in range(now, until):
            state = _step(state, left, right, sums)
        found.append(state[:, ROTOR] / np.sqrt((state[:, ROTOR] ** 2).sum(axis=-1, keepdims=True)))
        now = until
    return np.array(found)


def _step(state: Any, left: Any, right: Any, sums: Any) -> Any:
    """One step of the series x(h) = Σ x_k h^k: (k+1) x_(k+1) = Σ_j x_j x_(k−j), summed as the law says.

    Factors are kept per product, the right ones from last to first, so that the sums are of two slices.
    """
    power = np.longdouble(STEP)
    a = np.empty((len(state), len(left), TERMS), dtype=np.longdouble)
    b = np.empty_like(a)
    term, total = state, state.copy()
    for k in range(TERMS):
        a[:, :, k], b[:, :, TERMS - 1 - k] = term[:, left], term[:, right]
        products = np.vecdot(a[:, :, : k + 1], b[:, :, TERMS - 1 - k :])
        term = np.vecdot(sums, products[:, np.newaxis]) * (power / (k + 1))
        total += term
    # The truncation error is smaller than the last term.
    if not np.abs(term).max() < np.finfo(np.longdouble).eps:
        raise ValueError(f"the series' last term is {np.abs(term).max():.1e}: take a smaller step")
    return total


def _rates(top: Top) -> Terms:
    """Return the factors of the products in the rates, by (rate, left, right).

    With axial vectors, R = s + b: ``i1 ω1' = (i2 − i3) ω2 ω3 + (γ x c)1``, ``γ' = γ x ω`` and, from
    ``R' = −½ R Ω``, ``s' = ½ b·ω``, ``b' = ½ (b x ω − s ω)``.
    """
    s, *b = ROTOR
    i, c = [np.longdouble(x) for x in top.moments], [np.longdouble(x) for x in top.c]
    terms: Terms = {}
    for k, m, n in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        terms |= {
            (OMEGA[k], OMEGA[m], OMEGA[n]): (i[m] - i[n]) / i[k],
            (OMEGA[k], ONE, GAMMA[m]): c[n] / i[k],
            (OMEGA[k], ONE, GAMMA[n]): -c[m] / i[k],
            (GAMMA[k], GAMMA[m], OMEGA[n]): 1.0,
            (GAMMA[k], GAMMA[n], OMEGA[m]): -1.0,
            (s, b[k], OMEGA[k]): 0.5,
            (b[k], b[m], OMEGA[n]): 0.5,
            (b[k], b[n], OMEGA[m]): -0.5,
            (b[k], s, OMEGA[k]): -0.5,
        }
    return terms


def _start(top: Top) -> Any:
    """Return the state at time 0; γ is the third row of the rotor's matrix."""
    rotor = np.array(top.rotor, dtype=np.longdouble)
    rotor /= np.sqrt((rotor**2).sum())
    w, x, y, z = rotor * [1, -1, -1, -1]
    gamma = [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]
    return np.array([*top.omega, *gamma, *rotor, 1], dtype=np.longdouble)
