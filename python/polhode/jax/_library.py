"""Import of JAX, an optional library."""

from __future__ import annotations

from typing import Any

from polhode._algebra.coefficients import register_pytrees
from polhode._support.extras import optional

Array = Any

jax: Any = optional("jax", "jax", "polhode.jax")
jnp: Any = optional("jax.numpy", "jax", "polhode.jax")
lax: Any = jax.lax

register_pytrees()
