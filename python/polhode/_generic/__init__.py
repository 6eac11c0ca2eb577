"""The algebra over arrays of any coefficients: exact, symbolic, traced, or on another device.

The compiled core computes with float64. Here the same formulas walk over NumPy arrays of Python objects
(`exact`) and over the arrays of any library that follows the array API (`numeric`): JAX, torch, CuPy, Dask.
"""
