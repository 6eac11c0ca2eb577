"""Rigid-body motion under JAX, for ``jit``, ``vmap`` and ``grad``: ``pip install 'polhode[jax]'``.

`free` is the exact free flow, `simulate` takes steps under the laws of `polhode.jax.torque`, and `advance`
takes steps of large ensembles, on a GPU in one kernel. All are functions of arrays with components in the
last axis: rotors over ``(1, e2e3, e3e1, e1e2)`` from body axes to space, angular velocities in body axes over
``(e2e3, e3e1, e1e2)``. Unless ``jax_enable_x64`` is set, JAX computes in single precision, and results are
float32.
"""

from polhode.jax import torque as torque
from polhode.jax._free import free as free
from polhode.jax._kernel import advance as advance
from polhode.jax._simulate import simulate as simulate

__all__ = ["advance", "free", "simulate", "torque"]


def __dir__() -> list[str]:
    return __all__
