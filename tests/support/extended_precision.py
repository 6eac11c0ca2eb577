"""Reference motions in extended precision: adaptive Taylor series.

NumPy's `longdouble` has 64 bits on x86, which makes rounding 2000 times smaller than that of a double.
Nothing here is Polhode's own: the equations are those of the quaternion and of Euler, in components.
"""

from collections import defaultdict
from dataclasses import dataclass

import numpy as np

LONG = np.longdouble
# Terms of a series; the step is that at which the last of them falls below rounding.
TERMS = 28
# The state: ω; R = s + b; e3, Larmor's b and a torque, fixed in space, seen from the body; and a constant 1.
# The rates of all of them are sums of products of two.
OMEGA, S, TURN, UP, FIELD, PUSH, ONE = (0, 1, 2), 3, (4, 5, 6), (7, 8, 9), (10, 11, 12), (13, 14, 15), 16
CYCLES = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


@dataclass(frozen=True)
class Case:
    """A rigid body and its torques; vectors in body axes unless named otherwise, constants in SI units."""

    moments: tuple
    omega: tuple
    rotor: tuple = (1, 0, 0, 0)  # of any norm
    heavy: tuple = (0, 0, 0)
    wheel: tuple = (0, 0, 0)
    larmor: tuple = (0, 0, 0)  # in space
    constant_body: tuple = (0, 0, 0)
    constant_space: tuple = (0, 0, 0)
    damping: float = 0  # −g I(Ω)
    viscous: float = 0  # −d Ω


def final_states(cases, durations):
    """Return rotors (case, 4) and body angular velocities (case, 3) after these durations (case,)."""
    tables = [_rates(case) for case in cases]
    products = sorted({key[1:] for table in tables for key in table})
    left, right = np.array(products).T
    sums = np.array([[[table.get((k, *p), 0) for p in products] for k in range(17)] for table in tables])
    state = np.array([_start(case) for case in cases])
    left_over = np.array(durations, dtype=LONG)
    while (left_over > 0).any():
        going = np.flatnonzero(left_over > 0)
        series = _series(state[going], left, right, sums[going])
        # The last two terms, for every other one may vanish by symmetry.
        last = [
            (np.finfo(LONG).eps / np.maximum(np.abs(series[:, k]).max(axis=1), 1e-300)) ** (LONG(1) / k)
            for k in (TERMS - 1, TERMS)
        ]
        h = np.minimum(left_over[going], 0.8 * np.minimum(*last))
        total = series[:, TERMS]
        for k in range(TERMS - 1, -1, -1):
            total = series[:, k] + h[:, np.newaxis] * total
        total[:, S : S + 4] /= np.sqrt((total[:, S : S + 4] ** 2).sum(axis=1, keepdims=True))
        state[going] = total
        left_over[going] -= h
    return state[:, S : S + 4], state[:, OMEGA]


def _series(state, left, right, sums):
    """Coefficients (case, power, 17) of x(h) = Σ x_k h^k, from (k+1) x_(k+1) = Σ of Σ_j x_j x_(k−j)."""
    series = np.empty((len(state), TERMS + 1, 17), dtype=LONG)
    series[:, 0] = state
    # Factors are kept per product, the right ones from last to first, so that the sums are of two slices.
    a = np.empty((len(state), len(left), TERMS), dtype=LONG)
    b = np.empty_like(a)
    for k in range(TERMS):
        a[:, :, k], b[:, :, TERMS - 1 - k] = series[:, k, left], series[:, k, right]
        of_products = np.vecdot(a[:, :, : k + 1], b[:, :, TERMS - 1 - k :])
        series[:, k + 1] = np.vecdot(sums, of_products[:, np.newaxis]) / (k + 1)
    return series


def _rates(case):
    """Of what products, with which factors, the rates are: (rate, left, right) to factor.

    With axial vectors, m = Iω + h and u for each vector fixed in space:
    ``I ω' = m x ω + e3 x c + m x b + N``, ``u' = u x ω`` and, from ``R' = −½ R Ω``,
    ``s' = ½ b·ω``, ``b' = ½ (b x ω − s ω)``.
    """
    terms = defaultdict(LONG)
    i, h, c = ([LONG(x) for x in v] for v in (case.moments, case.wheel, case.heavy))
    for k, m, n in CYCLES:
        for first, second, sign in ((m, n, 1), (n, m, -1)):
            terms[OMEGA[k], OMEGA[first], OMEGA[second]] += sign * i[first] / i[k]
            terms[OMEGA[k], ONE, OMEGA[second]] += sign * h[first] / i[k]
            terms[OMEGA[k], OMEGA[first], FIELD[second]] += sign * i[first] / i[k]
            terms[OMEGA[k], ONE, FIELD[second]] += sign * h[first] / i[k]
            terms[OMEGA[k], ONE, UP[first]] += sign * c[second] / i[k]
            terms[TURN[k], TURN[first], OMEGA[second]] += LONG(sign) / 2
            for fixed in (UP, FIELD, PUSH):
                terms[fixed[k], fixed[first], OMEGA[second]] += LONG(sign)
        terms[OMEGA[k], ONE, ONE] += LONG(case.constant_body[k]) / i[k]
        terms[OMEGA[k], ONE, PUSH[k]] += 1 / i[k]
        terms[OMEGA[k], ONE, OMEGA[k]] -= LONG(case.damping) + LONG(case.viscous) / i[k]
        terms[S, TURN[k], OMEGA[k]] += LONG(1) / 2
        terms[TURN[k], S, OMEGA[k]] -= LONG(1) / 2
    return dict(terms)


def _start(case):
    rotor = np.array(case.rotor, dtype=LONG)
    rotor /= np.sqrt((rotor**2).sum())
    seen = [_in_body(rotor, np.array(v, dtype=LONG)) for v in ((0, 0, 1), case.larmor, case.constant_space)]
    return np.array([*case.omega, *rotor, *np.concatenate(seen), 1], dtype=LONG)


def _in_body(rotor, v):
    """~R v R, with R = s + b in axial components."""
    s, b = rotor[0], rotor[1:]
    t = 2 * np.cross(b, v)
    return v + s * t + np.cross(b, t)
