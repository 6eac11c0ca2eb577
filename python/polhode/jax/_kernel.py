"""Many bodies over many steps in one kernel, which keeps their states on the chip.

A program of `simulate` writes the state of a batch to memory after each step and reads it back for the next.
Here a Pallas kernel has the loop over time within: each block of bodies is read once, stays in registers over
all steps, and is written once. The steps are those of `simulate`, line for line, on components of one block.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from polhode._support.extras import optional
from polhode.jax._arguments import Start
from polhode.jax._components import joined, normalized, split
from polhode.jax._formula_law import Formula
from polhode.jax._laws import Function, Torque
from polhode.jax._library import jax, jnp, lax
from polhode.jax._phase import Gyrostat
from polhode.jax._simulate import compiled, prepared, stepper, table_of
from polhode.jax._table import Table

Array = Any

# A body to each thread of four warps: the state and the slopes of a step fill a thread's registers.
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
    """Return rotors (..., 4) and angular velocities (..., 3) after so many equal steps to a time.

    What `simulate` gives for this one time, for large ensembles: where JAX runs on a GPU, in one kernel that
    keeps each body on the chip over all steps. There, too, it is differentiated: the value comes from the
    kernel, the derivatives from the steps of `simulate`.

    Parameters
    ----------
    inertia, rotor, omega_body, torque, method
        As for `polhode.jax.simulate`. In a kernel the parameters of the torque are numbers for each body or
        for all: no tables, formulas and functions.
    time
        In s, of either sign; one for all bodies.
    steps
        Their number, 1 at least.
    kernel
        Whether to use the kernel; True elsewhere than on a GPU runs it in Pallas' interpreter, for tests.
        None: on a GPU, for the laws that it has.
    start_time
        When the bodies are there, in s; one for all of them.
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
    return given.in_body_axes(*_scanned(method, steps, given, force, span))


def _scanned(method: str, steps: int, given: Start, torque: Torque, span: Array) -> tuple[Array, Array]:
    """The same by a loop of whole batches."""
    counts = np.array([steps])
    found = compiled(given, torque, span[1:], counts, span[0], method=method, most=steps, even=True)
    return found[0][..., 1, :], found[1][..., 1, :]


@partial(jax.custom_jvp, nondiff_argnums=(0, 1))
@partial(jax.jit, static_argnums=(0, 1))
def _advanced(method: str, steps: int, given: Start, torque: Torque, span: Array) -> tuple[Array, Array]:
    """By the kernel."""
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
    _, change = jax.jvp(partial(_scanned, method, steps), primals, tangents)
    return _advanced(method, steps, *primals), change


def _walk(
    method: str, steps: int, tree: Any, leaves: list[Array], begin: Array, end: Array, table: Array
) -> tuple[Array, ...]:
    """All steps of a block of bodies."""
    moments, rotor, omega, torque = jax.tree.unflatten(tree, leaves)
    moves = stepper(method, Gyrostat(moments, torque.wheel()), torque, table)
    point = moves.start(rotor, omega, begin)
    fixed = moves.fixed(point)

    def one(i: Array, point: Any) -> Any:
        share = (i + 1).astype(end.dtype) / steps
        after = jnp.where(i + 1 == steps, end, begin + (end - begin) * share)
        return moves.step(fixed, point, after - point.time)._replace(time=after)

    point = lax.fori_loop(0, steps, one, point)
    return (*point.rotor, *moves.omega(point))


def _call(walk: Any, rows: list[Array], span: Array, table: Array) -> list[Array]:
    """Run it over the blocks, a program of the grid for each."""
    pallas = optional("jax.experimental.pallas", "jax", "the kernel of polhode.jax")

    # The times of the start and the end, and what a method needs in its stages; of a length that is a power
    # of two, as GPUs have it.
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


def _target() -> dict[str, Any]:
    """On a GPU through Triton, a body to each thread; elsewhere in the interpreter."""
    if jax.default_backend() != "gpu":
        return {"interpret": True}
    triton = optional("jax.experimental.pallas.triton", "jax", "the kernel of polhode.jax")
    return {"compiler_params": triton.CompilerParams(num_warps=BLOCK // 32)}
