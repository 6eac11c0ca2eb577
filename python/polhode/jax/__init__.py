"""Motion for JAX."""

from polhode.jax import torque as torque
from polhode.jax._simulate import simulate as simulate
from polhode.jax._free import free as free
from polhode.jax._kernel import advance as advance
