"""The same tasks as loops over rows, compiled by numba for all cores; results go to `out`."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit, prange

_FLAGS = {"parallel": True, "fastmath": True}


@njit(**_FLAGS)
def product(a: Any, b: Any, out: Any) -> Any:
    """Full products, as a complex scalar and a complex vector: see `formulas.product`."""
    for n in prange(len(out)):
        z0, z1 = complex(a[n, 0], a[n, 7]), complex(a[n, 1], a[n, 4])
        z2, z3 = complex(a[n, 2], a[n, 5]), complex(a[n, 3], a[n, 6])
        w0, w1 = complex(b[n, 0], b[n, 7]), complex(b[n, 1], b[n, 4])
        w2, w3 = complex(b[n, 2], b[n, 5]), complex(b[n, 3], b[n, 6])
        c0 = z0 * w0 + z1 * w1 + z2 * w2 + z3 * w3
        c1 = z0 * w1 + z1 * w0 + 1j * (z2 * w3 - z3 * w2)
        c2 = z0 * w2 + z2 * w0 + 1j * (z3 * w1 - z1 * w3)
        c3 = z0 * w3 + z3 * w0 + 1j * (z1 * w2 - z2 * w1)
        out[n, 0], out[n, 7] = c0.real, c0.imag
        out[n, 1], out[n, 4] = c1.real, c1.imag
        out[n, 2], out[n, 5] = c2.real, c2.imag
        out[n, 3], out[n, 6] = c3.real, c3.imag
    return out


@njit(**_FLAGS)
def wedge(a: Any, b: Any, out: Any) -> Any:
    """``a∧b`` of vectors."""
    for n in prange(len(out)):
        out[n, 0] = a[n, 1] * b[n, 2] - a[n, 2] * b[n, 1]
        out[n, 1] = a[n, 2] * b[n, 0] - a[n, 0] * b[n, 2]
        out[n, 2] = a[n, 0] * b[n, 1] - a[n, 1] * b[n, 0]
    return out


@njit(**_FLAGS)
def composition(S: Any, R: Any, out: Any) -> Any:
    """``S R`` of rotors."""
    for n in prange(len(out)):
        s, a1, a2, a3 = S[n, 0], S[n, 1], S[n, 2], S[n, 3]
        r, b1, b2, b3 = R[n, 0], R[n, 1], R[n, 2], R[n, 3]
        out[n, 0] = s * r - a1 * b1 - a2 * b2 - a3 * b3
        out[n, 1] = s * b1 + r * a1 - (a2 * b3 - a3 * b2)
        out[n, 2] = s * b2 + r * a2 - (a3 * b1 - a1 * b3)
        out[n, 3] = s * b3 + r * a3 - (a1 * b2 - a2 * b1)
    return out


@njit(**_FLAGS)
def turn(R: Any, v: Any, out: Any) -> Any:
    """``R v ~R``, one rotor for each vector."""
    for n in prange(len(out)):
        s, x, y, z = R[n, 0], -R[n, 1], -R[n, 2], -R[n, 3]
        v1, v2, v3 = v[n, 0], v[n, 1], v[n, 2]
        t1, t2, t3 = 2 * (y * v3 - z * v2), 2 * (z * v1 - x * v3), 2 * (x * v2 - y * v1)
        out[n, 0] = v1 + s * t1 + y * t3 - z * t2
        out[n, 1] = v2 + s * t2 + z * t1 - x * t3
        out[n, 2] = v3 + s * t3 + x * t2 - y * t1
    return out


@njit(**_FLAGS)
def turn_by_matrix(M: Any, v: Any, out: Any) -> Any:
    """One rotation of many vectors."""
    for n in prange(len(out)):
        v1, v2, v3 = v[n, 0], v[n, 1], v[n, 2]
        for k in range(3):
            out[n, k] = M[k, 0] * v1 + M[k, 1] * v2 + M[k, 2] * v3
    return out


@njit(**_FLAGS)
def exponential(B: Any, out: Any) -> Any:
    """``exp(B)`` of bivectors, not zero."""
    for n in prange(len(out)):
        size = np.sqrt(B[n, 0] ** 2 + B[n, 1] ** 2 + B[n, 2] ** 2)
        factor = np.sin(size) / size
        out[n, 0] = np.cos(size)
        for k in range(3):
            out[n, 1 + k] = B[n, k] * factor
    return out


@njit(**_FLAGS)
def logarithm(R: Any, out: Any) -> Any:
    """``log(R)`` of rotors, not ±1."""
    for n in prange(len(out)):
        size = np.sqrt(R[n, 1] ** 2 + R[n, 2] ** 2 + R[n, 3] ** 2)
        factor = np.arctan2(size, R[n, 0]) / size
        for k in range(3):
            out[n, k] = R[n, 1 + k] * factor
    return out


@njit(**_FLAGS)
def turn_and_contract(R: Any, v: Any, a: Any, b: Any, c: Any, out: Any) -> Any:
    """``R v ~R + (a∧b)·c``."""
    for n in prange(len(out)):
        s, x, y, z = R[n, 0], -R[n, 1], -R[n, 2], -R[n, 3]
        v1, v2, v3 = v[n, 0], v[n, 1], v[n, 2]
        t1, t2, t3 = 2 * (y * v3 - z * v2), 2 * (z * v1 - x * v3), 2 * (x * v2 - y * v1)
        bc = b[n, 0] * c[n, 0] + b[n, 1] * c[n, 1] + b[n, 2] * c[n, 2]
        ac = a[n, 0] * c[n, 0] + a[n, 1] * c[n, 1] + a[n, 2] * c[n, 2]
        out[n, 0] = v1 + s * t1 + y * t3 - z * t2 + a[n, 0] * bc - b[n, 0] * ac
        out[n, 1] = v2 + s * t2 + z * t1 - x * t3 + a[n, 1] * bc - b[n, 1] * ac
        out[n, 2] = v3 + s * t3 + x * t2 - y * t1 + a[n, 2] * bc - b[n, 2] * ac
    return out


@njit(fastmath=True)
def product_by_table(a: Any, b: Any, signs: Any, out: Any) -> Any:
    """Full products in any signature, blades by bits: ``c_j = Σ_i ± a_i b_(i^j)``; on one core."""
    for n in range(len(out)):
        out[n] = 0
        for i in range(signs.shape[0]):
            for j in range(signs.shape[0]):
                out[n, j] += signs[i, j] * a[n, i] * b[n, i ^ j]
    return out
