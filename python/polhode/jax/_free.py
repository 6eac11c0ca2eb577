"""The exact free flow: values and derivatives from the compiled core, or from theta series in JAX.

A callback computes all bodies of a batch at once in the compiled core. Its derivatives are closed forms too
(`FreeMotion.derivatives`), from which the rule below forms the tangents.

**With respect to the rotor.** ``R(t) = R(0) U(t)``, where U depends on moments, rates and time only. So a
tangent of the start, without its part along ``R(0)``, which normalization removes, is multiplied by
``U = ~R(0) R(t)``.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from polhode import _native
from polhode.jax import _theta
from polhode.jax._arguments import Start, start
from polhode.jax._components import compose, joined, reverse, split
from polhode.jax._library import Array, jax, jnp

METHODS = ("native", "jax")


def free(
    inertia: Any, rotor: Any, omega_body: Any, t: Any, *, method: str | None = None
) -> tuple[Array, Array]:
    """Return rotors (..., 4) and angular velocities (..., 3) of free bodies at times t, exact at any time.

    The flow of `polhode.FreeMotion`, for ``jit``, ``vmap`` and ``grad``; all bodies at all times, of batch
    shape ``bodies + t.shape``. First derivatives with respect to moments, rotor, angular velocity and time
    are closed forms, accurate for any t, also at equal moments, in steady rotation and at rest.

    Parameters
    ----------
    inertia, rotor, omega_body
        As for `polhode.jax.simulate`. The derivative with respect to the rotor has no part along the
        rotor.
    t
        Times in s, of any shape.
    method
        ``"native"`` calls the compiled core, whose error stays at rounding up to t = 1e12, always in double
        precision. ``"jax"`` is the same series in JAX, for devices other than the CPU: in double precision
        its error is about 1e-15 and grows by about 3e-16 per radian; its derivatives are those of its
        operations, NaN in steady rotation and at equal moments. None selects ``"native"`` on the CPU.

    The result is NaN for moments that are not positive, starts that are not finite, and times beyond 1e17
    turns.
    """
    if method not in (None, *METHODS):
        raise ValueError(f"unknown method {method!r}, expected one of {', '.join(METHODS)}")
    if method is None:
        method = "native" if jax.default_backend() == "cpu" else "jax"
    given = start(inertia, rotor, omega_body)
    given.batch()  # or an error
    rotors: Array
    omegas: Array
    rotors, omegas = _states(given, jnp.asarray(t, given.rotor.dtype), method=method)
    return rotors, omegas


@partial(jax.jit, static_argnames="method")
def _states(given: Start, times: Array, *, method: str) -> tuple[Array, Array]:
    """Compiled, because JAX takes milliseconds to start a callback outside `jit`."""
    batch = given.batch()
    bodies = [jnp.broadcast_to(x, (*batch, x.shape[-1])) for x in (given.moments, given.rotor, given.omega)]
    flow: Any = _flow if method == "native" else _theta.flow
    rotors, omegas = flow(*bodies, jnp.broadcast_to(times.ravel(), (*batch, times.size)))
    shape = batch + times.shape
    return given.in_body_axes(rotors.reshape(*shape, 4), omegas.reshape(*shape, 3))


@jax.custom_jvp
def _flow(moments: Array, rotor: Array, omega: Array, times: Array) -> tuple[Array, Array]:
    """Rotors (..., m, 4) and angular velocities (..., m, 3) of bodies (...), each at its times (..., m)."""
    rows = _called("free_flow", 7, moments, rotor, omega, times)
    return rows[..., :4], rows[..., 4:]


@_flow.defjvp
def _flow_jvp(primals: tuple[Array, ...], tangents: tuple[Array, ...]) -> tuple[Any, Any]:
    moments, rotor, omega, times = primals
    d_moments, d_rotor, d_omega, d_times = tangents
    rotors, omegas = _flow(*primals)
    rows = _derivatives(moments, rotor, omega, times)
    sizes = [(4, 3), (4, 3), (4,), (3, 3), (3, 3), (3,)]
    ends = np.cumsum([int(np.prod(size)) for size in sizes])[:-1]
    parts = [
        part.reshape(*part.shape[:-1], *size)
        for part, size in zip(jnp.split(rows, ends, axis=-1), sizes, strict=True)
    ]

    def linear(by_rate: Array, by_moment: Array, by_t: Array) -> Array:
        total = jnp.einsum("...mij,...j->...mi", by_rate, d_omega)
        total = total + jnp.einsum("...mij,...j->...mi", by_moment, d_moments)
        return total + by_t * d_times[..., None]

    carried = carried_along(rotor, d_rotor, rotors)
    return (rotors, omegas), (
        linear(*parts[:3]) + carried,
        linear(*parts[3:]),
    )


def carried_along(rotor: Array, tangent: Array, rotors: Array) -> Array:
    """Return the tangents (..., m, 4) of rotors from the tangent (..., 4) of their start."""
    r, d = split(rotor), split(tangent)
    square = sum(x * x for x in r)
    along = sum(x * y for x, y in zip(r, d, strict=True)) / square
    across = tuple(y - x * along for x, y in zip(r, d, strict=True))
    turn = compose(across, reverse(r))
    wide = tuple((x / square)[..., None] for x in turn)
    return joined(compose(wide, split(rotors)))


@jax.custom_jvp
def _derivatives(moments: Array, rotor: Array, omega: Array, times: Array) -> Array:
    return _called("free_flow_derivatives", 49, moments, rotor, omega, times)


@_derivatives.defjvp
def _second_derivatives(primals: tuple[Array, ...], tangents: tuple[Array, ...]) -> tuple[Any, Any]:
    raise NotImplementedError(
        'second derivatives of the free flow: take polhode.jax.free(..., method="jax"), or simulate'
    )


def _called(name: str, size: int, *bodies: Array) -> Array:
    """Call the compiled core, which computes in double precision."""
    dtype, shape = bodies[-1].dtype, (*bodies[-1].shape, size)
    result = jax.ShapeDtypeStruct(shape, dtype)
    return jax.pure_callback(partial(_rows, name, size), result, *bodies, vmap_method="broadcast_all")


def _rows(name: str, size: int, *bodies: Any) -> Any:
    """Return rows (..., m, size) from arrays (..., k) whose batches are the same."""
    dtype, shape = bodies[-1].dtype, bodies[-1].shape
    wide = [np.asarray(x, np.float64) for x in bodies]
    count = int(np.prod(shape[:-1], dtype=int))
    flat = [np.ascontiguousarray(x.reshape(count, x.shape[-1])) for x in wide]
    found = getattr(_native, name)(*flat)
    return found.reshape(*shape, size).astype(dtype)
