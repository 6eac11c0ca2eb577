"""The formula ``R v ~R + (a∧b)·c``, compared with separate calls and with other compilers.

kingdon compiles its operators to NumPy, or with numba to loops on all cores. Components are its first axis:
it reads contiguous arrays.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import formulas
import machine
import peers
import polhode as ph
from batches import by_jax, by_numpy
from contest import OUR_CALLS, OUR_CALLS_INTO, Pace, Row

TEXT = "R v ~R + (a∧b)·c"
CALL = "f(R=R, v=v, a=a, b=b, c=c)"


def rows(rng: np.random.Generator, pace: Pace) -> Iterator[Row]:
    """Yield the batch, on all cores and on one, the single value, and the time to compile."""
    yield batch(rng, pace.batch)
    if machine.PINS:
        yield batch(rng, pace.batch, one_core=True)
    yield single(rng)
    yield compilation(rng)


def batch(rng: np.random.Generator, n: int, one_core: bool = False) -> Row:
    """A batch larger than the caches."""
    title, goal = (f"{TEXT}, one core", "6 ns") if one_core else (TEXT, "")
    row = Row(title, goal=goal, count=n, traffic=8 * 19, one_core=one_core)
    values = _values(rng, (n,))
    arrays = [value.components for value in values.values()]
    _ours(row, values)
    names = {"f": one_by_one, "x": list(values.values()), "room": np.empty((3, n, 3))}
    row.enter(OUR_CALLS_INTO, "f(*x, room)", names, lambda x: x)
    with row.peer("kingdon"):
        row.enter("kingdon", "f(*x)", {"f": kingdon_compiled(), "x": _kingdon(values)}, _vectors_of_kingdon)
    with row.peer("kingdon, numba"):
        from numba import njit

        names = {"f": kingdon_compiled(wrapper=njit(parallel=True, fastmath=True)), "x": _kingdon(values)}
        row.enter("kingdon, numba", "f(*x)", names, _vectors_of_kingdon)
    with row.peer("numba"):
        import loops

        names = {"f": loops.turn_and_contract, "new": np.empty_like, "x": arrays}
        row.enter("numba", "f(*x, new(x[1]))", names, lambda x: x)
    by_numpy(row, formulas.turn_and_contract, *arrays)
    by_jax(row, formulas.turn_and_contract, *arrays)
    return row


def single(rng: np.random.Generator) -> Row:
    """One value."""
    row = Row(f"{TEXT}, one value")
    values = _values(rng, ())
    _ours(row, values)
    with row.peer("kingdon"):
        row.enter("kingdon", "f(*x)", {"f": kingdon_compiled(), "x": _kingdon(values)}, _vectors_of_kingdon)
    arrays = [np.array(value.components) for value in values.values()]
    by_numpy(row, formulas.turn_and_contract, *arrays)
    return row


def compilation(rng: np.random.Generator) -> Row:
    """Compilation from text, or from a Python function, and the first value."""
    row = Row(f"{TEXT}, compiled and called once", unit="us")
    values = _values(rng, ())
    arrays = [np.array(value.components) for value in values.values()]
    with row.planned():
        names = {"formula": ph.formula, "text": TEXT, **values}
        row.enter("polhode", "formula(text)(R=R, v=v, a=a, b=b, c=c)", names, lambda x: x.components)
    with row.peer("kingdon"):
        names = {"new": kingdon_compiled, "x": _kingdon(values)}
        row.enter("kingdon", "new()(*x)", names, _vectors_of_kingdon)
    with row.peer("numba"):
        from numba import njit

        import loops

        rowed = [x[np.newaxis] for x in arrays]
        # The Python function inside the compiled one; the function itself if compilation is disabled.
        plain = getattr(loops.turn_and_contract, "py_func", loops.turn_and_contract)
        names = {"njit": njit, "f": plain, "x": rowed, "new": np.empty_like}
        row.enter("numba", "njit(f)(*x, new(x[1]))", names, lambda x: x[0])
    with row.peer("JAX"):
        import jax

        jax.config.update("jax_enable_x64", True)
        names = {"jit": jax.jit, "f": formulas.turn_and_contract, "np": jax.numpy, "x": arrays}
        row.enter("JAX", "jit(lambda *x: f(np, *x))(*x).block_until_ready()", names, np.asarray)
    return row


def one_by_one(R: Any, v: Any, a: Any, b: Any, c: Any, room: Any) -> Any:
    """Evaluate the formula by separate calls into existing arrays."""
    turned, plane, contracted = room
    R.apply(v, out=turned)
    a.wedge(b, out=plane).dot(c, out=contracted)
    return np.add(turned, contracted, out=turned)


def kingdon_compiled(**options: Any) -> Any:
    """Return the formula as kingdon compiles it, for a rotor and four vectors."""
    algebra = peers.kingdon_algebra()
    symbols = algebra.codegen_symbolcls
    names = [algebra.bireflection(name="R", symbolcls=symbols)]
    names += [algebra.vector(name=name, symbolcls=symbols) for name in "vabc"]

    def turn_and_contract(R: Any, v: Any, a: Any, b: Any, c: Any) -> Any:  # kingdon needs a named function
        return (R >> v) + ((a ^ b) | c)

    return algebra.compile(turn_and_contract, *names, **options)


def _values(rng: np.random.Generator, shape: tuple[int, ...]) -> dict[str, Any]:
    """Return a rotor and four vectors, or batches of them."""
    vectors = rng.standard_normal((4, *shape, 3))
    return {"R": ph.Rotor.random(shape, rng), **dict(zip("vabc", map(ph.vector, vectors), strict=True))}


def _ours(row: Row, values: dict[str, Any]) -> None:
    """Add the formula and the separate calls."""
    with row.planned():
        row.enter("polhode", CALL, {"f": ph.formula(TEXT), **values}, lambda x: x.components)
    row.enter(OUR_CALLS, "R(v) + a.wedge(b).dot(c)", values, lambda x: x.components)


def _kingdon(values: dict[str, Any]) -> list[Any]:
    """Return the same values in kingdon."""
    R, *vectors = (value.components for value in values.values())
    return [
        peers.kingdon(peers.even(R), "bireflection"),
        *(peers.kingdon(peers.odd(v), "vector") for v in vectors),
    ]


def _vectors_of_kingdon(value: Any) -> Any:
    return peers.of_kingdon(value)[..., 1:4]
