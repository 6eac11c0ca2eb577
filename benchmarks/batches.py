"""Batches: time per value, compared with the limit set by memory bandwidth.

Rows without `out=` allocate a new result each time, and new pages cost more than the arithmetic. Libraries
with one object per value get smaller batches.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

import formulas
import peers
import polhode as ph
from contest import Pace, Row
from peers import even, of_clifford, of_kingdon, of_pauli, of_quaternion, rotor_of

FEW = 16
OBJECTS = 2_000  # batch size for libraries with one object per value


def rows(rng: np.random.Generator, pace: Pace) -> Iterator[Row]:
    """Yield all rows of batches."""
    n = pace.batch
    yield product(rng, n)
    yield product_into(rng, n)
    yield wedge(rng, n)
    yield wedge_into(rng, n)
    yield composition(rng, n)
    yield turn(rng, n)
    yield turn_into(rng, n)
    yield turn_all(rng, n)
    yield exponential(rng, n)
    yield logarithm(rng, n)


def few_rows(rng: np.random.Generator, pace: Pace) -> Iterator[Row]:
    """Yield rows of batches of few values, of which most time is that of the call; `pace` does not matter."""
    for row in (product, wedge, composition, turn, turn_all, exponential, logarithm):
        yield replace(row(rng, FEW), goal="", traffic=0)


def product(rng: np.random.Generator, n: int) -> Row:
    """``a*b`` of full multivectors."""
    row = Row("a*b, multivectors", count=n, traffic=8 * 24)
    a, b = ph.multivector(rng.standard_normal((2, n, 8)))
    left, right = a.components, b.components
    row.enter("polhode", "a * b", {"a": a, "b": b}, lambda c: c.components)
    few = slice(OBJECTS)
    with row.peer("clifford"):
        names = {"a": peers.clifford(left[few]), "b": peers.clifford(right[few])}
        row.enter("clifford", "a * b", names, of_clifford, OBJECTS)
    with row.peer("kingdon"):
        row.enter("kingdon", "a * b", {"a": peers.kingdon(left), "b": peers.kingdon(right)}, of_kingdon)
    with row.peer("gasparse"):
        names = {"a": peers.gasparse(left[few]), "b": peers.gasparse(right[few])}
        row.enter("gasparse", "a * b", names, peers.of_gasparse, OBJECTS)
    with row.peer("numba"):
        import loops

        names = {"f": loops.product, "new": np.empty_like, "a": left, "b": right}
        row.enter("numba", "f(a, b, new(a))", names, lambda c: c)
    names = {"f": formulas.product_in_blocks, "new": np.empty_like, "a": left, "b": right}
    row.enter("NumPy", "f(a, b, new(a))", names, lambda c: c)
    by_jax(row, formulas.product, left, right)
    row.enter("Pauli", "A @ B", {"A": ph.to_pauli(a), "B": ph.to_pauli(b)}, of_pauli)
    return row


def product_into(rng: np.random.Generator, n: int) -> Row:
    """``a*b`` into an existing array."""
    row = Row("a*b, multivectors, out=", goal="2.5 ns", count=n, traffic=8 * 24)
    a, b = ph.multivector(rng.standard_normal((2, n, 8)))
    left, right, out = a.components, b.components, np.empty((n, 8))
    with row.planned():
        names = {"a": a, "b": b, "out": out}
        row.enter("polhode", "a.geometric_product(b, out=out)", names, lambda _: out)
    with row.peer("numba"):
        import loops

        names = {"f": loops.product, "a": left, "b": right, "out": np.empty((n, 8))}
        row.enter("numba", "f(a, b, out)", names, lambda c: c)
    names = {"f": formulas.product_in_blocks, "a": left, "b": right, "out": np.empty((n, 8))}
    row.enter("NumPy", "f(a, b, out)", names, lambda c: c)
    A, B = ph.to_pauli(a), ph.to_pauli(b)
    names = {"matmul": np.matmul, "A": A, "B": B, "out": np.empty_like(A)}
    row.enter("Pauli", "matmul(A, B, out=out)", names, of_pauli)
    return row


def wedge(rng: np.random.Generator, n: int) -> Row:
    """``a∧b`` of vectors."""
    row = Row("a∧b, vectors", count=n, traffic=8 * 9)
    left, right = rng.standard_normal((2, n, 3))
    a, b = ph.vector(left), ph.vector(right)
    row.enter("polhode", "a.wedge(b)", {"a": a, "b": b}, lambda c: c.components)
    with row.peer("kingdon"):
        names = {x: peers.kingdon(peers.odd(v), "vector") for x, v in (("a", left), ("b", right))}
        row.enter("kingdon", "a ^ b", names, lambda c: of_kingdon(c)[:, 4:7])
    with row.peer("numba"):
        import loops

        names = {"f": loops.wedge, "new": np.empty_like, "a": left, "b": right}
        row.enter("numba", "f(a, b, new(a))", names, lambda c: c)
    row.enter("NumPy", "cross(a, b)", {"cross": np.cross, "a": left, "b": right}, lambda c: c)
    by_jax(row, lambda xp, a, b: xp.cross(a, b), left, right)
    return row


def wedge_into(rng: np.random.Generator, n: int) -> Row:
    """``a∧b`` into an existing array."""
    row = Row("a∧b, vectors, out=", count=n, traffic=8 * 9)
    left, right = rng.standard_normal((2, n, 3))
    out = np.empty((n, 3))
    with row.planned():
        names = {"a": ph.vector(left), "b": ph.vector(right), "out": out}
        row.enter("polhode", "a.wedge(b, out=out)", names, lambda _: out)
    with row.peer("numba"):
        import loops

        names = {"f": loops.wedge, "a": left, "b": right, "out": np.empty((n, 3))}
        row.enter("numba", "f(a, b, out)", names, lambda c: c)
    return row


def composition(rng: np.random.Generator, n: int) -> Row:
    """``S*R`` of rotors."""
    row = Row("S*R, rotors", goal="80 % of memory", count=n, traffic=8 * 12)
    S, R = ph.Rotor.random((2, n), rng)
    s, r = S.components, R.components
    row.enter("polhode", "S * R", {"S": S, "R": R}, lambda x: x.components)
    with row.peer("clifford"):
        names = {"S": peers.clifford(even(s[:OBJECTS])), "R": peers.clifford(even(r[:OBJECTS]))}
        row.enter("clifford", "S * R", names, lambda x: rotor_of(of_clifford(x)), OBJECTS)
    with row.peer("kingdon"):
        names = {"S": peers.kingdon(even(s), "bireflection"), "R": peers.kingdon(even(r), "bireflection")}
        row.enter("kingdon", "S * R", names, lambda x: rotor_of(of_kingdon(x)))
    with row.peer("SciPy"):
        names = {"S": S.to_scipy(), "R": R.to_scipy()}
        row.enter("SciPy", "S * R", names, lambda x: peers.of_scipy(x, S * R))
    with row.peer("numpy-quaternion"):
        names = {"S": peers.quaternion(S), "R": peers.quaternion(R)}
        row.enter("numpy-quaternion", "S * R", names, of_quaternion)
    with row.peer("numba"):
        import loops

        names = {"f": loops.composition, "new": np.empty_like, "S": s, "R": r}
        row.enter("numba", "f(S, R, new(S))", names, lambda x: x)
    by_numpy(row, formulas.composition, s, r)
    by_jax(row, formulas.composition, s, r)
    names = {"S": ph.to_pauli(S), "R": ph.to_pauli(R)}
    row.enter("Pauli", "S @ R", names, lambda m: rotor_of(of_pauli(m)))
    return row


def turn(rng: np.random.Generator, n: int) -> Row:
    """``R v ~R``, a rotor for each vector."""
    row = Row("R v ~R, a rotor for each", goal="80 % of memory", count=n, traffic=8 * 10)
    R, v = ph.Rotor.random(n, rng), ph.vector(rng.standard_normal((n, 3)))
    four, points = R.components, v.components
    row.enter("polhode", "R(v)", {"R": R, "v": v}, lambda x: x.components)
    with row.peer("clifford"):
        names = {"R": peers.clifford(even(four[:OBJECTS])), "v": peers.clifford(peers.odd(points[:OBJECTS]))}
        row.enter("clifford", "R * v * ~R", names, lambda x: of_clifford(x)[:, 1:4], OBJECTS)
    with row.peer("kingdon"):
        names = {
            "R": peers.kingdon(even(four), "bireflection"),
            "v": peers.kingdon(peers.odd(points), "vector"),
        }
        row.enter("kingdon", "R >> v", names, lambda x: of_kingdon(x)[:, 1:4])
    with row.peer("SciPy"):
        row.enter("SciPy", "R.apply(v)", {"R": R.to_scipy(), "v": np.array(points)}, lambda x: x)
    with row.peer("numpy-quaternion"):
        names = {"R": peers.quaternion(R), "v": peers.pure_quaternion(points)}
        row.enter("numpy-quaternion", "R * v * R.conj()", names, lambda x: -of_quaternion(x)[:, 1:])
    with row.peer("numba"):
        import loops

        names = {"f": loops.turn, "new": np.empty_like, "R": four, "v": points}
        row.enter("numba", "f(R, v, new(v))", names, lambda x: x)
    by_numpy(row, formulas.turn, four, points)
    by_jax(row, formulas.turn, four, points)
    names = {"U": ph.to_pauli(R), "V": ph.to_pauli(v)}
    row.enter("Pauli", "U @ V @ U.conj().swapaxes(1, 2)", names, lambda m: of_pauli(m)[:, 1:4])
    return row


def turn_into(rng: np.random.Generator, n: int) -> Row:
    """``R v ~R`` into an existing array."""
    row = Row("R v ~R, a rotor for each, out=", goal="80 % of memory", count=n, traffic=8 * 10)
    R, v, out = ph.Rotor.random(n, rng), ph.vector(rng.standard_normal((n, 3))), np.empty((n, 3))
    with row.planned():
        row.enter("polhode", "R.apply(v, out=out)", {"R": R, "v": v, "out": out}, lambda _: out)
    with row.peer("numba"):
        import loops

        names = {"f": loops.turn, "R": R.components, "v": v.components, "out": np.empty((n, 3))}
        row.enter("numba", "f(R, v, out)", names, lambda x: x)
    return row


def turn_all(rng: np.random.Generator, n: int) -> Row:
    """``R v ~R``, one rotor for all vectors."""
    row = Row("R v ~R, one rotor", goal="80 % of memory", count=n, traffic=8 * 6)
    R, v = ph.Rotor.random(rng=rng), ph.vector(rng.standard_normal((n, 3)))
    points, M = np.array(v.components), R.to_matrix()
    row.enter("polhode", "R(v)", {"R": R, "v": v}, lambda x: x.components)
    with row.peer("kingdon"):
        names = {
            "R": peers.kingdon(even(R.components), "bireflection"),
            "v": peers.kingdon(peers.odd(points), "vector"),
        }
        row.enter("kingdon", "R >> v", names, lambda x: of_kingdon(x)[:, 1:4])
    with row.peer("SciPy"):
        row.enter("SciPy", "R.apply(v)", {"R": R.to_scipy(), "v": points}, lambda x: x)
    with row.peer("numpy-quaternion"):
        from quaternion import rotate_vectors

        names = {"rotate_vectors": rotate_vectors, "R": peers.quaternion(R), "v": points}
        row.enter("numpy-quaternion", "rotate_vectors(R, v)", names, lambda x: x)
    with row.peer("numba"):
        import loops

        names = {"f": loops.turn_by_matrix, "new": np.empty_like, "M": M, "v": points}
        row.enter("numba", "f(M, v, new(v))", names, lambda x: x)
    row.enter("NumPy", "v @ M.T", {"M": M, "v": points}, lambda x: x)
    by_jax(row, lambda xp, M, v: v @ M.T, M, points)
    names = {"U": ph.to_pauli(R), "V": ph.to_pauli(v)}
    row.enter("Pauli", "U @ V @ U.conj().T", names, lambda m: of_pauli(m)[:, 1:4])
    return row


def exponential(rng: np.random.Generator, n: int) -> Row:
    """``exp(B)`` of bivectors."""
    row = Row("exp(B), bivectors", goal="2.5 ns", count=n, traffic=8 * 7)
    B = ph.bivector(rng.standard_normal((n, 3)))
    b = B.components
    row.enter("polhode", "B.exp()", {"B": B}, lambda x: x.components)
    with row.peer("SciPy"):
        from scipy.spatial.transform import Rotation

        names = {"new": Rotation.from_rotvec, "v": -2 * b}
        row.enter("SciPy", "new(v)", names, lambda x: peers.of_scipy(x, B.exp()))
    with row.peer("numpy-quaternion"):
        names = {"exp": np.exp, "B": peers.pure_quaternion(-b)}
        row.enter("numpy-quaternion", "exp(B)", names, of_quaternion)
    with row.peer("numba"):
        import loops

        names = {"f": loops.exponential, "new": np.empty, "shape": (n, 4), "B": b}
        row.enter("numba", "f(B, new(shape))", names, lambda x: x)
    by_numpy(row, formulas.exponential, b)
    by_jax(row, formulas.exponential, b)
    with row.peer("Pauli"):
        from scipy.linalg import expm

        names = {"B": ph.to_pauli(B[:OBJECTS]), "expm": expm}
        row.enter("Pauli", "expm(B)", names, lambda m: rotor_of(of_pauli(m)), OBJECTS)
    return row


def logarithm(rng: np.random.Generator, n: int) -> Row:
    """``log(R)`` of rotors of less than half a turn."""
    row = Row("log(R), rotors", goal="2.5 ns", count=n, traffic=8 * 7)
    R = ph.bivector(rng.uniform(-0.8, 0.8, (n, 3))).exp()
    r = R.components
    row.enter("polhode", "R.log()", {"R": R}, lambda x: x.components)
    with row.peer("SciPy"):
        row.enter("SciPy", "R.as_rotvec()", {"R": R.to_scipy()}, lambda v: -v / 2)
    with row.peer("numpy-quaternion"):
        names = {"log": np.log, "R": peers.quaternion(R)}
        row.enter("numpy-quaternion", "log(R)", names, lambda x: of_quaternion(x)[:, 1:])
    with row.peer("numba"):
        import loops

        names = {"f": loops.logarithm, "new": np.empty, "shape": (n, 3), "R": r}
        row.enter("numba", "f(R, new(shape))", names, lambda x: x)
    by_numpy(row, formulas.logarithm, r)
    by_jax(row, formulas.logarithm, r)
    return row


def by_numpy(row: Row, function: Any, *arrays: Any) -> None:
    """Add explicit formulas in NumPy."""
    names = {"f": function, "np": np, "x": arrays}
    row.enter("NumPy", "f(np, *x)", names, lambda x: x)


def by_jax(row: Row, function: Any, *arrays: Any) -> None:
    """Add the same formulas compiled by JAX for the CPU, in double precision."""
    with row.peer("JAX"):
        import jax

        jax.config.update("jax_enable_x64", True)
        cpu = jax.devices("cpu")[0]
        names = {
            "f": jax.jit(lambda *x: function(jax.numpy, *x)),
            "x": [jax.device_put(array, cpu) for array in arrays],
        }
        row.enter("JAX", "f(*x).block_until_ready()", names, np.asarray)
