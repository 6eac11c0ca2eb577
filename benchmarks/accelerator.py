"""Body-steps per second of the kernel in `polhode.jax`: `python benchmarks/accelerator.py`.

One kernel takes many steps of a large ensemble. Operations are counted in the program of a step before
compilation: each sum, product, quotient, root, comparison and selection counts as one. The maker's peak
performance counts a fused multiply-add as two; a step without fused operations can reach half of it.
Without a GPU nothing is measured.
"""

from __future__ import annotations

import argparse
from time import perf_counter
from typing import Any

import numpy as np

import polhode as ph

# Teraflops of the vector units in double and single precision, from NVIDIA's data sheets of the SXM boards.
PEAKS = {
    "H100": {"float64": 34.0, "float32": 67.0},
    "H200": {"float64": 34.0, "float32": 67.0},
    "A100": {"float64": 9.7, "float32": 19.5},
}
# Moves of data, which are not operations.
_MOVES = {"broadcast_in_dim", "convert_element_type", "copy", "reshape", "squeeze", "stop_gradient", "split"}
METHODS = ("rk4", "strang", "kahan_li8")
BODIES, STEPS, ROUNDS = 1 << 20, 1000, 3


def operations(jaxpr: Any) -> int:
    """Count the operations of a program on scalars; those in a loop once for each iteration."""
    total = 0
    for equation in jaxpr.eqns:
        inner = [x for x in equation.params.values() if hasattr(x, "eqns") or hasattr(x, "jaxpr")]
        times = equation.params.get("length", 1)
        if inner:
            total += times * sum(operations(getattr(x, "jaxpr", x)) for x in inner)
        elif equation.primitive.name not in _MOVES:
            total += 1
    return total


def of_a_step(method: str, heavy: bool) -> int:
    """Count the operations of a step of one body: those that a second step adds to the program."""
    import jax

    law = ph.jax.torque.heavy([0.0, 0.0, 1.0]) if heavy else None

    def moved(omega: Any, steps: int) -> Any:
        return ph.jax.advance([1.0, 2.0, 3.0], [1.0, 0, 0, 0], omega, 1.0, law, method, steps=steps)

    one, two = (operations(jax.make_jaxpr(moved, static_argnums=1)(np.ones(3), n)) for n in (1, 2))
    return two - one


def measured(method: str, dtype: str, heavy: bool, bodies: int, steps: int) -> float:
    """Return body-steps per second, the best of several runs."""
    import jax

    rng = np.random.default_rng(0)
    moments = rng.uniform(2, 3, size=(bodies, 3)).astype(dtype)
    rotors, omegas = (rng.normal(size=(bodies, n)).astype(dtype) for n in (4, 3))
    law = ph.jax.torque.heavy(np.array([0, 0, 1], dtype)) if heavy else None
    given = [jax.device_put(x) for x in (moments, rotors, omegas)]

    @jax.jit
    def moved(*given: Any) -> Any:
        return ph.jax.advance(*given, 0.01 * steps, law, method, steps=steps)

    jax.block_until_ready(moved(*given))
    best = np.inf
    for _ in range(ROUNDS):
        begin = perf_counter()
        jax.block_until_ready(moved(*given))
        best = min(best, perf_counter() - begin)
    return bodies * steps / best


def main() -> None:
    """Measure and print the results."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--bodies", type=int, default=BODIES)
    parser.add_argument("--steps", type=int, default=STEPS)
    arguments = parser.parse_args()

    import jax

    jax.config.update("jax_enable_x64", True)
    counts = {(method, heavy): of_a_step(method, heavy) for method in METHODS for heavy in (False, True)}
    for (method, heavy), count in counts.items():
        print(f"{method}, {'heavy' if heavy else 'free'}: {count} operations in a step")
    if jax.default_backend() != "gpu":
        print(f"no GPU found: JAX runs on {jax.default_backend()}; nothing was measured")
        return
    device = jax.devices()[0].device_kind
    peak = next((known for name, known in PEAKS.items() if name in device), None)
    print(f"{device}, {arguments.bodies} bodies, {arguments.steps} steps")
    for (method, heavy), count in counts.items():
        for dtype in ("float64", "float32"):
            rate = measured(method, dtype, heavy, arguments.bodies, arguments.steps)
            share = "unknown" if peak is None else f"{rate * count / (1e12 * peak[dtype]):.0%}"
            law = "heavy" if heavy else "free"
            print(f"{method}, {law}, {dtype}: {rate:.3g} body-steps/s, {share} of the peak of the device")


if __name__ == "__main__":
    main()
