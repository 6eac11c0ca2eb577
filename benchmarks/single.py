"""Single values, as at the prompt: the time is that of the call, not of the arithmetic."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import peers
import polhode as ph
from contest import Pace, Row
from peers import (
    even,
    odd,
    of_clifford,
    of_galaga,
    of_gasparse,
    of_kingdon,
    of_pauli,
    of_quaternion,
    rotor_of,
)


def rows(rng: np.random.Generator, _: Pace) -> Iterator[Row]:
    """Yield all rows of single values."""
    for build in (product, turn, composition, exponential, logarithm):
        yield build(rng)


def product(rng: np.random.Generator) -> Row:
    """``a*b`` of two full multivectors."""
    row = Row("a*b, two multivectors", goal="60 ns")
    a, b = ph.multivector(rng.standard_normal((2, 8)))
    left, right = np.array(a.components), np.array(b.components)
    row.enter("polhode", "a * b", {"a": a, "b": b}, peers.eight_of)
    for library, value, read in (
        ("clifford", peers.clifford, of_clifford),
        ("kingdon", peers.kingdon, of_kingdon),
        ("galaga", peers.galaga, of_galaga),
        ("gasparse", peers.gasparse, of_gasparse),
    ):
        with row.peer(library):
            row.enter(library, "a * b", {"a": value(left), "b": value(right)}, read)
    names = {"a": left, "b": right, "table": peers.table().reshape(8, 64)}
    row.enter("NumPy", "b @ (a @ table).reshape(8, 8)", names, lambda c: c)
    row.enter("Pauli", "A @ B", {"A": ph.to_pauli(a), "B": ph.to_pauli(b)}, of_pauli)
    return row


def turn(rng: np.random.Generator) -> Row:
    """``R(v)``, one vector."""
    row = Row("R(v), one vector", goal="80 ns")
    R, v = ph.Rotor.random(rng=rng), ph.vector(rng.standard_normal(3))
    four, point = even(R.components), np.array(v.components)
    row.enter("polhode", "R(v)", {"R": R, "v": v}, lambda x: x.components)
    with row.peer("clifford"):
        names = {"R": peers.clifford(four), "v": peers.clifford(odd(point))}
        row.enter("clifford", "R * v * ~R", names, lambda x: of_clifford(x)[1:4])
    with row.peer("kingdon"):
        names = {"R": peers.kingdon(four, "bireflection"), "v": peers.kingdon(odd(point), "vector")}
        row.enter("kingdon", "R >> v", names, lambda x: of_kingdon(x)[1:4])
    with row.peer("galaga"):
        from galaga import sandwich

        names = {"R": peers.galaga(four), "v": peers.galaga(odd(point)), "sandwich": sandwich}
        row.enter("galaga", "sandwich(R, v)", names, lambda x: of_galaga(x)[1:4])
    with row.peer("SciPy"):
        row.enter("SciPy", "R.apply(v)", {"R": R.to_scipy(), "v": point}, lambda x: x)
    with row.peer("numpy-quaternion"):
        names = {"R": peers.quaternion(R), "v": peers.pure_quaternion(point)}
        row.enter("numpy-quaternion", "R * v * R.conj()", names, lambda x: x.vec)
    row.enter("NumPy", "M @ v", {"M": R.to_matrix(), "v": point}, lambda x: x)
    names = {"U": ph.to_pauli(R), "V": ph.to_pauli(v)}
    row.enter("Pauli", "U @ V @ U.conj().T", names, lambda m: of_pauli(m)[1:4])
    return row


def composition(rng: np.random.Generator) -> Row:
    """``S*R`` of two rotors."""
    row = Row("S*R, two rotors")
    S, R = ph.Rotor.random(2, rng)
    s, r = even(S.components), even(R.components)
    row.enter("polhode", "S * R", {"S": S, "R": R}, lambda x: x.components)
    with row.peer("clifford"):
        names = {"S": peers.clifford(s), "R": peers.clifford(r)}
        row.enter("clifford", "S * R", names, lambda x: rotor_of(of_clifford(x)))
    with row.peer("kingdon"):
        names = {"S": peers.kingdon(s, "bireflection"), "R": peers.kingdon(r, "bireflection")}
        row.enter("kingdon", "S * R", names, lambda x: rotor_of(of_kingdon(x)))
    with row.peer("galaga"):
        names = {"S": peers.galaga(s), "R": peers.galaga(r)}
        row.enter("galaga", "S * R", names, lambda x: rotor_of(of_galaga(x)))
    with row.peer("SciPy"):
        names = {"S": S.to_scipy(), "R": R.to_scipy()}
        row.enter("SciPy", "S * R", names, lambda x: peers.of_scipy(x, S * R))
    with row.peer("numpy-quaternion"):
        names = {"S": peers.quaternion(S), "R": peers.quaternion(R)}
        row.enter("numpy-quaternion", "S * R", names, of_quaternion)
    names = {"S": ph.to_pauli(S), "R": ph.to_pauli(R)}
    row.enter("Pauli", "S @ R", names, lambda m: rotor_of(of_pauli(m)))
    return row


def exponential(rng: np.random.Generator) -> Row:
    """``exp(B)``, a rotor from a bivector."""
    row = Row("exp(B), one bivector")
    B = ph.bivector(rng.standard_normal(3))
    eight = even([0, *B.components])
    row.enter("polhode", "B.exp()", {"B": B}, lambda x: x.components)
    with row.peer("clifford"):
        row.enter("clifford", "B.exp()", {"B": peers.clifford(eight)}, lambda x: rotor_of(of_clifford(x)))
    with row.peer("kingdon"):
        names = {"B": peers.kingdon(eight, "bivector")}
        row.enter("kingdon", "B.exp()", names, lambda x: rotor_of(of_kingdon(x)))
    with row.peer("galaga"):
        from galaga import exp

        names = {"B": peers.galaga(eight), "exp": exp}
        row.enter("galaga", "exp(B)", names, lambda x: rotor_of(of_galaga(x)))
    with row.peer("SciPy"):
        from scipy.spatial.transform import Rotation

        names = {"new": Rotation.from_rotvec, "v": -2 * B.components}
        row.enter("SciPy", "new(v)", names, lambda x: peers.of_scipy(x, B.exp()))
    with row.peer("numpy-quaternion"):
        row.enter("numpy-quaternion", "B.exp()", {"B": peers.pure_quaternion(-B.components)}, of_quaternion)
    with row.peer("Pauli"):
        from scipy.linalg import expm

        row.enter("Pauli", "expm(B)", {"B": ph.to_pauli(B), "expm": expm}, lambda m: rotor_of(of_pauli(m)))
    return row


def logarithm(rng: np.random.Generator) -> Row:
    """``log(R)``, a bivector from a rotor."""
    row = Row("log(R), one rotor")
    # Less than half a turn, where libraries with one logarithm for R and −R agree with ours.
    R = ph.bivector(rng.uniform(-0.8, 0.8, 3)).exp()
    row.enter("polhode", "R.log()", {"R": R}, lambda x: x.components)
    with row.peer("galaga"):
        from galaga import log

        names = {"R": peers.galaga(even(R.components)), "log": log}
        row.enter("galaga", "log(R)", names, lambda x: rotor_of(of_galaga(x))[1:])
    with row.peer("SciPy"):
        row.enter("SciPy", "R.as_rotvec()", {"R": R.to_scipy()}, lambda v: -v / 2)
    with row.peer("numpy-quaternion"):
        names = {"R": peers.quaternion(R)}
        row.enter("numpy-quaternion", "R.log()", names, lambda x: of_quaternion(x)[1:])
    with row.peer("Pauli"):
        from scipy.linalg import logm

        names = {"R": ph.to_pauli(R), "logm": logm}
        row.enter("Pauli", "logm(R)", names, lambda m: rotor_of(of_pauli(m))[1:])
    return row
