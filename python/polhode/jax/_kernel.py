"""Many steps of many bodies in one Pallas kernel, which keeps their states in registers.

`simulate` writes the state of a batch to memory after each step and reads it back for the next. The kernel
contains the loop over time: each block of bodies is read once, stays in registers over all steps, and is
written once. The steps are those of `simulate`.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from polhode._support.extras import optional
from polhode.jax._arguments import Start
from polhode.jax._components import joined, normalized, split
from polhode.jax._formula_law import Formula
from polhode.jax._fused import fused
from polhode.jax._laws import Function, Gyrostat, Torque
from polhode.jax._library import Array, jax, jnp, lax
from polhode.jax._simulate import prepared, simulate_principal
from polhode.jax._steppers import stepper, table_of
from polhode.jax._table import Table

# One body per thread of four warps: the state and the slopes of a step fill the registers of a thread.
BLOCK = 128


def advance(
    inertia: Any,
    rotor: Any,
    omega_body: Any,
    time: Any,
    torque: Any = None,
    method: str = "strang",
    *,
    steps: int,
    kernel: bool | None = None,
    start_time: Any = 0.0,
) -> tuple[Array, Array]:
    """Return rotors (..., 4) and angular velocities (..., 3) at a time, after equal steps.

    The result of `simulate` for one time, for large ensembles: on a GPU, one kernel keeps each body in
    registers over all steps. Derivatives are those of `simulate`.

    Parameters
    ----------
    inertia, rotor, omega_body, torque, method
        As for `polhode.jax.simulate`. The kernel does not support tables, formulas and functions.
    time
        The time of the result in s, one for all bodies; it may be before the start.
    steps
        Number of steps, at least 1.
    kernel
        Whether to use the kernel; without a GPU it runs in the interpreter of Pallas, for tests. None
        selects it on a GPU for the laws that it supports.
    start_time
        The time of the initial states in s, one for all bodies.
    """
    if not isinstance(steps, int) or steps < 1:
        raise ValueError(f"steps is {steps!r}; it must be a positive integer")
    given, force = prepared(inertia, rotor, omega_body, torque, method)
    fits = not any(isinstance(law, Function | Table | Formula) for law in force.laws)
    if kernel and not fits:
        raise ValueError(
            "the kernel does not support torques by tables, formulas and functions; use simulate"
        )
    if kernel is None:
        kernel = fits and jax.default_backend() == "gpu"
    span = jnp.stack([jnp.asarray(t, given.rotor.dtype) for t in (start_time, time)])
    if kernel:
        return given.in_body_axes(*_advanced(method, steps, given, force, span))
    return given.in_body_axes(*_compiled_scan(method, steps, given, force, span))


def _scanned(method: str, steps: int, given: Start, torque: Torque, span: Array) -> tuple[Array, Array]:
    counts = np.array([steps])
    found = simulate_principal(given, torque, span[1:], counts, span[0], method=method, most=steps, even=True)
    return found[0][..., 1, :], found[1][..., 1, :]


_compiled_scan = jax.jit(_scanned, static_argnums=(0, 1))


@partial(jax.custom_jvp, nondiff_argnums=(0, 1))
@partial(jax.jit, static_argnums=(0, 1))
def _advanced(method: str, steps: int, given: Start, torque: Torque, span: Array) -> tuple[Array, Array]:
    dtype = given.rotor.dtype
    inputs = split(given.moments), normalized(split(given.rotor)), split(given.omega), torque
    leaves, tree = jax.tree.flatten(jax.tree.map(lambda x: jnp.asarray(x, dtype), inputs))
    batch = jnp.broadcast_shapes(*(x.shape for x in leaves))
    rows = [jnp.broadcast_to(x, batch).reshape(-1) for x in leaves]
    count = rows[0].size
    padded = -(-count // BLOCK) * BLOCK
    # Copies of the last body fill the last block.
    rows = [jnp.pad(x, (0, padded - count), mode="edge") for x in rows]
    table = jnp.array(table_of(method), dtype)
    found = _call(partial(_walk, method, steps, tree), rows, span, table)
    rotors, omegas = (
        joined(tuple(x[:count].reshape(batch) for x in part)) for part in (found[:4], found[4:])
    )
    return rotors, omegas


@_advanced.defjvp
def _advanced_jvp(method: str, steps: int, primals: tuple[Any, ...], tangents: tuple[Any, ...]) -> Any:
    _, change = jax.jvp(partial(_compiled_scan, method, steps), primals, tangents)
    return _advanced(method, steps, *primals), change


def _walk(
    method: str, steps: int, tree: Any, leaves: list[Array], begin: Array, end: Array, table: Array
) -> tuple[Array, ...]:
    moments, rotor, omega, torque = jax.tree.unflatten(tree, leaves)
    moves = stepper(method, Gyrostat.of(moments, torque.wheel()), torque, table)
    point = moves.start(rotor, omega, begin)
    fixed = moves.fixed(point)

    def one(i: Array, point: Any) -> Any:
        share = (i + 1).astype(end.dtype) * (1 / steps)
        after = jnp.where(i + 1 == steps, end, begin + (end - begin) * share)
        return moves.step(fixed, point, after - point.time)._replace(time=after)

    point = lax.fori_loop(0, steps, fused(one) if _fuses() else one, point)
    return (*moves.rotor(point), *moves.omega(point))


def _call(walk: Any, rows: list[Array], span: Array, table: Array) -> list[Array]:
    """Run a walk over the blocks, one program of the grid for each."""
    pallas = optional("jax.experimental.pallas", "jax", "the kernel of polhode.jax")

    # Coefficients of the stages, start time and end time; GPUs need a length that is a power of two.
    numbers = jnp.concatenate([table, span])
    length = 1 << (numbers.size - 1).bit_length()
    numbers = jnp.pad(numbers, (0, length - numbers.size))

    def kernel(shared: Any, *refs: Any) -> None:
        ins, outs = refs[: len(rows)], refs[len(rows) :]
        found = walk([ref[...] for ref in ins], shared[table.size], shared[table.size + 1], shared)
        for out, x in zip(outs, found, strict=True):
            out[...] = x

    block = pallas.BlockSpec((BLOCK,), lambda i: (i,))
    one = pallas.BlockSpec((length,), lambda i: (0,))
    result = jax.ShapeDtypeStruct(rows[0].shape, rows[0].dtype)
    call = pallas.pallas_call(
        kernel,
        out_shape=[result] * 7,
        grid=(rows[0].size // BLOCK,),
        in_specs=[one] + [block] * len(rows),
        out_specs=[block] * 7,
        **_target(),
    )
    found: list[Array] = call(numbers, *rows)
    return found


def _fuses() -> bool:
    """Whether the kernel may use instructions of NVIDIA's GPUs; the interpreter and AMD's have others."""
    return jax.default_backend() == "gpu" and "rocm" not in jax.devices()[0].client.platform_version


def _target() -> dict[str, Any]:
    """Return the options for Triton on a GPU, one body per thread; for the interpreter elsewhere."""
    if jax.default_backend() != "gpu":
        return {"interpret": True}
    triton = optional("jax.experimental.pallas.triton", "jax", "the kernel of polhode.jax")
    return {"compiler_params": triton.CompilerParams(num_warps=BLOCK // 32)}
