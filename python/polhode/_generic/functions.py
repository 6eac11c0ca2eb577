"""Functions and norms of G3 over arrays of any coefficients.

Data are arrays (..., K) of the components of the grades in a mask (see `layout`); a function returns the data
and the mask of its value, the same grades as the compiled core. Where there is no value, a ValueError gives
the batch index; while values are unknown (traced by JAX, in a Dask graph) the result is NaN or infinite.
"""

from __future__ import annotations

import functools
import math

import numpy as np

from polhode._generic import g3_exact, g3_smooth
from polhode._generic.coefficients import Coefficients
from polhode._generic.compiled import compiled
from polhode._generic.exact import by_rows
from polhode._generic.layout import ALL, eight, grades_of, indices, of_eight
from polhode._generic.numeric import Array, Numeric, components, require_in_range, squares


def _function(name: str, d: Coefficients, data: Array, mask: int) -> tuple[Array, int]:
    result = grades_of(name, mask)
    if not isinstance(d, Numeric):
        full = of_eight(d, eight(d, data, mask), ALL)
        return by_rows(getattr(g3_exact, name), full, indices(result)), result
    with np.errstate(all="ignore"):  # NumPy, also beneath other libraries; non-finite results raise below
        m = eight(d, data, mask)
        d.require_finite(m)
        values = of_eight(d, getattr(g3_smooth, name)(d, m, mask), result)
        require_in_range(d, values)
    return values, result


# Logarithms and roots of even values are even, ``log(−1) = π e1∧e2``, ``√(−1) = e1∧e2``; others principal.
inverse = compiled(functools.partial(_function, "inverse"))
exp = compiled(functools.partial(_function, "exp"))
log = compiled(functools.partial(_function, "log"))
sqrt = compiled(functools.partial(_function, "sqrt"))


# --- norms


@compiled
def norm_squared(d: Coefficients, data: Array) -> Array:
    """``⟨A ~A⟩``, the sum of the squared components."""
    return squares(d, components(data))


@compiled
def norm(d: Coefficients, data: Array) -> Array:
    """``√⟨A ~A⟩``; its derivative at 0, where it has none, is 0."""
    if isinstance(d, Numeric):
        with np.errstate(all="ignore"):
            return d.length(components(data))
    return d.sqrt(norm_squared(d, data))


@compiled
def normalized(d: Coefficients, data: Array) -> Array:
    """``A/|A|``; a ValueError where A is zero or not finite."""
    if not isinstance(d, Numeric):
        return by_rows(g3_exact.unit, data)
    with np.errstate(all="ignore"):
        parts = components(data)
        size = d.length(parts)
        d.require((size > 0) & (size < math.inf), "the multivector has no direction")
        return d.stack(d.direction(parts, [math.nan] * len(parts)))
