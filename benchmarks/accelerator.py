"""Body-steps per second of the kernel in `polhode.jax`: `python benchmarks/accelerator.py`.

One kernel takes many steps of a large ensemble. Operations are counted in the program of a step before
compilation: each sum, product, quotient, root, comparison and selection counts as one. The maker's peak
performance counts a fused multiply-add as two; a step without fused operations can reach half of it. Free
bodies are also stepped by MJX and by a kernel in Warp, where these are installed. Without a GPU nothing is
measured.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from time import perf_counter
from typing import Any

import numpy as np

import accelerator_peers
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
MOMENTS = [2.0, 2.4, 2.9]


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


def bodies_of(count: int, dtype: str) -> tuple[Any, Any]:
    """Return unit rotors and angular velocities."""
    rng = np.random.default_rng(0)
    rotors, omegas = (rng.normal(size=(count, n)) for n in (4, 3))
    rotors /= np.linalg.norm(rotors, axis=1, keepdims=True)
    return rotors.astype(dtype), omegas.astype(dtype)


def measured(method: str, dtype: str, heavy: bool, bodies: int, steps: int) -> float:
    """Return body-steps per second of the kernel."""
    import jax

    moments = np.random.default_rng(1).uniform(2, 3, size=(bodies, 3)).astype(dtype)
    law = ph.jax.torque.heavy(np.array([0, 0, 1], dtype)) if heavy else None
    given = jax.device_put((moments, *bodies_of(bodies, dtype)))

    @jax.jit
    def moved(*given: Any) -> Any:
        return ph.jax.advance(*given, 0.01 * steps, law, method, steps=steps)

    return bodies * steps / shortest(lambda: jax.block_until_ready(moved(*given)))


def shortest(run: Callable[[], Any]) -> float:
    """Return the shortest time of several runs in s, after one that compiles."""
    run()
    best = np.inf
    for _ in range(ROUNDS):
        begin = perf_counter()
        run()
        best = min(best, perf_counter() - begin)
    return best


def of_peer(name: str, dtype: str, bodies: int, steps: int) -> str:
    """Return the rate of a peer on free bodies of equal moments, and its difference from the kernel."""
    rotors, omegas = bodies_of(bodies, dtype)
    run, read = getattr(accelerator_peers, name)(MOMENTS, rotors, omegas, 0.01, steps)
    rate = bodies * steps / shortest(run)
    own = ph.jax.advance(np.array(MOMENTS, dtype), rotors, omegas, 0.01 * steps, None, "rk4", steps=steps)
    apart = max(float(np.abs(np.asarray(a) - np.asarray(b)).max()) for a, b in zip(read(), own, strict=True))
    return f"{rate:.3g} body-steps/s; its states differ from the kernel's by up to {apart:.1g}"


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
    for name in ("warp", "mjx"):
        for dtype in ("float64", "float32"):
            try:
                # MJX writes its data to memory in each step.
                fewer = max(1, arguments.steps // (20 if name == "mjx" else 1))
                found = of_peer(name, dtype, arguments.bodies, fewer)
            except ImportError as missing:
                found = f"not measured: {missing}"
            print(f"{name}, rk4, free, {dtype}: {found}")


if __name__ == "__main__":
    main()
