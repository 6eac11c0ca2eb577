"""The algebra over arrays of any coefficients: exact, symbolic, traced, or on another device.

The compiled core computes with float64. Here the same formulas serve NumPy arrays of Python objects (`exact`)
and the arrays of any library that follows the array API (`numeric`): JAX, torch, CuPy, Dask.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from polhode._generic import algebras as algebras
    from polhode._generic import coefficients as coefficients
    from polhode._generic import functions as functions
    from polhode._generic import jacobians as jacobians
    from polhode._generic import layout as layout
    from polhode._generic import motors as motors
    from polhode._generic import numeric as numeric
    from polhode._generic import products as products
    from polhode._generic import rotors as rotors


def __getattr__(name: str) -> Any:
    """Import a module of this package when it is first used: computing with floats needs none of them."""
    if name.startswith("_"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return importlib.import_module(f"{__name__}.{name}")
