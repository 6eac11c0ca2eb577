"""Explicit formulas without a geometric algebra library; ``xp`` is NumPy or JAX.

Components are over ``1, e1, e2, e3, e2e3, e3e1, e1e2, I``; rotors ``(s, b)`` have quaternions ``(s, −b)``.
"""

from __future__ import annotations

from typing import Any

import numpy as np

_PAIRS = ((0, 7), (1, 4), (2, 5), (3, 6))  # 1 and I, e1 and I e1, ...


def product(xp: Any, a: Any, b: Any) -> Any:
    """Full products.

    I commutes with everything, so ``α + a + I b + I β`` is a complex scalar and a complex vector:
    ``(z0 + z)(w0 + w) = z0 w0 + z·w + z0 w + w0 z + I z x w``.
    """
    z0, z = a[..., 0] + 1j * a[..., 7], a[..., 1:4] + 1j * a[..., 4:7]
    w0, w = b[..., 0] + 1j * b[..., 7], b[..., 1:4] + 1j * b[..., 4:7]
    scalar = z0 * w0 + (z * w).sum(axis=-1)
    vector = z0[..., None] * w + w0[..., None] * z + 1j * xp.cross(z, w)
    parts = [scalar.real[..., None], vector.real, vector.imag, scalar.imag[..., None]]
    return xp.concatenate(parts, axis=-1)


def product_in_blocks(a: Any, b: Any, out: Any, block: int = 8192) -> Any:
    """Full products, the fastest way found in NumPy: blocks that fit in the cache, components first."""
    for start in range(0, len(out), block):
        rows = slice(start, start + block)
        A, B, C = np.ascontiguousarray(a[rows].T), np.ascontiguousarray(b[rows].T), out[rows]
        z0, z1, z2, z3 = (A[k] + 1j * A[m] for k, m in _PAIRS)
        w0, w1, w2, w3 = (B[k] + 1j * B[m] for k, m in _PAIRS)
        c = (
            z0 * w0 + z1 * w1 + z2 * w2 + z3 * w3,
            z0 * w1 + z1 * w0 + 1j * (z2 * w3 - z3 * w2),
            z0 * w2 + z2 * w0 + 1j * (z3 * w1 - z1 * w3),
            z0 * w3 + z3 * w0 + 1j * (z1 * w2 - z2 * w1),
        )
        for (k, m), part in zip(_PAIRS, c, strict=True):
            C[:, k], C[:, m] = part.real, part.imag
    return out


def composition(xp: Any, S: Any, R: Any) -> Any:
    """``S R`` of rotors: ``(s + I a)(r + I b) = s r − a·b + I (s b + r a − a x b)``."""
    s, a, r, b = S[..., :1], S[..., 1:], R[..., :1], R[..., 1:]
    scalar = s * r - (a * b).sum(axis=-1, keepdims=True)
    return xp.concatenate([scalar, s * b + r * a - xp.cross(a, b)], axis=-1)


def turn(xp: Any, R: Any, v: Any) -> Any:
    """``R v ~R`` with ``R = s − I u``: ``v + 2s u x v + 2u x (u x v)``."""
    s, u = R[..., :1], -R[..., 1:]
    t = 2 * xp.cross(u, v)
    return v + s * t + xp.cross(u, t)


def exponential(xp: Any, B: Any) -> Any:
    """``exp(B) = cos β + B sin β / β``, β = |B|, not zero."""
    size = xp.sqrt((B * B).sum(axis=-1, keepdims=True))
    return xp.concatenate([xp.cos(size), B * (xp.sin(size) / size)], axis=-1)


def logarithm(xp: Any, R: Any) -> Any:
    """``log(R) = B/|B| atan2(|B|, s)`` of ``R = s + B``, B not zero."""
    s, B = R[..., :1], R[..., 1:]
    size = xp.sqrt((B * B).sum(axis=-1, keepdims=True))
    return B * (xp.arctan2(size, s) / size)


def turn_and_contract(xp: Any, R: Any, v: Any, a: Any, b: Any, c: Any) -> Any:
    """``R v ~R + (a∧b)·c`` with ``(a∧b)·c = a (b·c) − b (a·c)``."""
    bc, ac = (b * c).sum(axis=-1, keepdims=True), (a * c).sum(axis=-1, keepdims=True)
    return turn(xp, R, v) + a * bc - b * ac
