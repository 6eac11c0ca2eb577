"""Eigenvectors of largest eigenvalues, over floating-point arrays and with derivatives."""

from __future__ import annotations

from typing import Any

from polhode._generic.numeric import Numeric

Array = Any

# The derivatives of x after k steps of Newton from a constant solution are right up to the order 2^k − 1.
_NEWTON_STEPS = 2


def largest(d: Numeric, matrix: Array, message: str) -> Array:
    """Return the unit eigenvector (n,) of the matrix (n, n); a ValueError where two eigenvalues are largest.

    A library's own derivatives of eigenvectors ask that all eigenvalues differ. Here Newton's method for
    ``K v = λ v, vᵀv = 1`` starts from a solution that counts as constant, and asks it of the largest only.
    """
    xp = d.xp
    values, vectors = xp.linalg.eigh(d.constant(matrix))
    n = int(values.shape[0])
    d.require(values[-1] - values[-2] > 2 * n * d.eps * values[-1], message)
    v, value = vectors[:, -1], values[-1]
    identity = xp.eye(n, dtype=matrix.dtype, **d.placed)
    zero = xp.reshape(value * 0.0, (1, 1))
    for _ in range(_NEWTON_STEPS):
        image = xp.sum(matrix * v[None, :], axis=1)
        column = xp.reshape(v, (n, 1))
        upper = xp.concat([matrix - value * identity, -column], axis=1)
        lower = xp.concat([xp.reshape(v, (1, n)), zero], axis=1)
        error = xp.concat([value * v - image, xp.reshape(0.5 * (1.0 - xp.sum(v * v)), (1,))])
        step = xp.linalg.solve(xp.concat([upper, lower], axis=0), xp.reshape(error, (n + 1, 1)))[:, 0]
        v, value = v + step[:n], value + step[n]
    return v
