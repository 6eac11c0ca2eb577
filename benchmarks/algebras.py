"""Full products and versors in other signatures: the projective Cl(3,0,1) and the conformal Cl(4,1).

The bits of a blade's index are its generators, in the order p of square 1, q of −1, r of 0. Products of basis
vectors show the order and signs of the blades in each library.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import polhode as ph
from contest import Pace, Row

Signature = tuple[int, int, int]

SIGNATURES: dict[Signature, str] = {(3, 0, 1): "5.8 ns", (4, 1, 0): "26.5 ns"}
IN_CACHE = 2**15  # components: three such arrays fit in the L2 cache of a core


def rows(rng: np.random.Generator, _: Pace) -> Iterator[Row]:
    """Yield rows of products and versors, one and many, for each signature."""
    for signature, goal in SIGNATURES.items():
        yield product(rng, signature)
        yield versor(rng, signature)
        yield versors(rng, signature)
        yield products(rng, signature, goal)
    yield normalized(rng)


def sign(a: int, b: int, squares: list[int]) -> int:
    """Return the sign of the product of two blades, 0 if a null generator is in both."""
    swaps = sum((a >> shift).bit_count() for shift in range(1, len(squares)) if b >> (shift - 1) & 1)
    common = [square for bit, square in enumerate(squares) if a & b & 1 << bit]
    return (-1) ** swaps * int(np.prod(common))


def table(signature: Signature) -> Any:
    """Return numbers (d, d): entry (i, j) is the sign of blade i times blade i^j, which is ± blade j."""
    p, q, r = signature
    squares = [1] * p + [-1] * q + [0] * r
    blades = range(2 ** len(squares))
    return np.array([[sign(i, i ^ j, squares) for j in blades] for i in blades], dtype=float)


def by_hand(a: Any, b: Any, signs: Any) -> Any:
    """The product blade by blade, over rows: ``c_j = Σ_i ± a_i b_(i^j)``."""
    blades = np.arange(len(signs))
    c = np.zeros_like(b)
    for i in blades:
        c += a[:, i, np.newaxis] * signs[i] * b[:, i ^ blades]
    return c


class Blades:
    """Order and signs of a library's components, found from products of its basis vectors."""

    def __init__(self, vectors: list[Any], one: Any, components: Callable[[Any], Any]) -> None:
        size = 2 ** len(vectors)
        self.place, self.sign = np.empty(size, dtype=int), np.empty(size)
        for blade in range(size):
            value = one
            for bit, vector in enumerate(vectors):
                value = value * vector if blade >> bit & 1 else value
            parts = np.asarray(components(value))
            (self.place[blade],) = np.flatnonzero(parts)
            self.sign[blade] = parts[self.place[blade]]

    def to_theirs(self, by_bits: Any) -> Any:
        """Components (..., d) in the library's order."""
        theirs = np.empty_like(by_bits)
        theirs[..., self.place] = by_bits * self.sign
        return theirs

    def to_bits(self, theirs: Any) -> Any:
        """Undo `to_theirs`."""
        return np.asarray(theirs)[..., self.place] * self.sign


def title(signature: Signature) -> str:
    """Return ``Cl(4,1)`` or ``Cl(3,0,1)``."""
    return f"Cl({','.join(map(str, signature if signature[2] else signature[:2]))})"


def product(rng: np.random.Generator, signature: Signature) -> Row:
    """``a*b`` of two full multivectors."""
    row = Row(f"a*b in {title(signature)}, one", unit="us")
    signs = table(signature)
    a, b = rng.standard_normal((2, len(signs)))
    row.expected = by_hand(a[np.newaxis], b[np.newaxis], signs)[0]
    with row.planned():
        names, read = _ours(signature, a, b)
        row.enter("polhode", "a * b", names, read)
    for library, build in (("clifford", _clifford), ("kingdon", _kingdon), ("galaga", _galaga)):
        with row.peer(library):
            names, read = build(signature, a, b)
            row.enter(library, "a * b", names, read)
    with row.peer("gasparse"):
        names, read = _gasparse(signature, a, b)
        row.enter("gasparse", "a * b", names, read)
    return row


def versor(rng: np.random.Generator, signature: Signature) -> Row:
    """``V X ~V`` of a versor with ``V ~V = 1``, a product of two vectors, and a full multivector."""
    row = Row(f"V X ~V in {title(signature)}, one", unit="us")
    v, x, row.expected = (part[0] for part in _versors(rng, signature, 1))
    with row.planned():
        names, read = _ours(signature, v, x)
        row.enter("polhode", "a(b)", names, read)
    programs = {"clifford": _clifford, "kingdon": _kingdon, "galaga": _galaga, "gasparse": _gasparse}
    for library, build in programs.items():
        with row.peer(library):
            names, read = build(signature, v, x)
            row.enter(library, "a * b * ~a", names, read)
    return row


def versors(rng: np.random.Generator, signature: Signature) -> Row:
    """``V X ~V`` of many even versors and trivectors, as of motors and points, that fit in the cache."""
    count = IN_CACHE // 2 ** sum(signature)
    row = Row(f"V X ~V in {title(signature)}, {count} even V, trivectors X", count=count)
    v, x, row.expected = _versors(rng, signature, count, grade=3)
    for library, build, program in (("polhode", _ours, "a(b)"), ("kingdon", _kingdon, "a.sw(b)")):
        with row.peer(library):
            names, read = build(signature, v, x)
            names = {"a": names["a"].grade(0, 2, 4), "b": names["b"].grade(3)}
            row.enter(library, program, names, read)
    return row


def normalized(rng: np.random.Generator) -> Row:
    """Many motors divided by their norms, in the cache."""
    count, signature = IN_CACHE // 16, (3, 0, 1)
    row = Row(f"V.normalized() in {title(signature)}, {count} motors", count=count)
    row.expected, x, _ = _versors(rng, signature, count)
    for library, build in (("polhode", _ours), ("kingdon", _kingdon)):
        with row.peer(library):
            names, read = build(signature, 2 * row.expected, x)
            row.enter(library, "a.normalized()", {"a": names["a"].grade(0, 2, 4)}, read)
    return row


def _versors(rng: np.random.Generator, signature: Signature, count: int, grade: int | None = None) -> Any:
    """Return products V of two vectors with ``V ~V = 1``, values X of a grade or of all, and ``V X ~V``."""
    signs = table(signature)
    x = rng.standard_normal((count, len(signs)))
    sides = np.zeros((2, *x.shape))
    for side in sides:  # unit vectors of the generators of square 1, with a part of a null one
        parts = rng.standard_normal((count, 3))
        side[:, [1, 2, 4]] = parts / np.linalg.norm(parts, axis=-1, keepdims=True)
        side[:, 8] = rng.standard_normal(count) if signature[2] else 0.0
    v = by_hand(*sides, signs)
    grades = np.array([i.bit_count() for i in range(len(signs))])
    if grade is not None:
        x[:, grades != grade] = 0.0
    reverse = np.where(grades % 4 < 2, v, -v)
    return v, x, by_hand(by_hand(v, x, signs), reverse, signs)


def products(rng: np.random.Generator, signature: Signature, goal: str) -> Row:
    """``a*b`` of many full multivectors that fit in the cache."""
    signs = table(signature)
    count = IN_CACHE // len(signs)
    row = Row(f"a*b in {title(signature)}, {count} in cache", goal=goal, count=count)
    a, b = rng.standard_normal((2, count, len(signs)))
    row.expected = by_hand(a, b, signs)
    with row.planned():
        names, read = _ours(signature, a, b)
        row.enter("polhode", "a * b", names, read)
    with row.peer("kingdon"):
        names, read = _kingdon(signature, a, b)
        row.enter("kingdon", "a * b", names, read)
    with row.peer("gasparse"):
        names, read = _gasparse(signature, a, b)
        row.enter("gasparse", "a * b", names, read)
    with row.peer("numba"):
        import loops

        names = {"f": loops.product_by_table, "new": np.empty_like, "a": a, "b": b, "signs": signs}
        row.enter("numba", "f(a, b, signs, new(a))", names, lambda c: c)
    row.enter("NumPy", "f(a, b, signs)", {"f": by_hand, "a": a, "b": b, "signs": signs}, lambda c: c)
    with row.peer("JAX"):
        import jax

        jax.config.update("jax_enable_x64", True)
        order = np.arange(len(signs))[:, np.newaxis] ^ np.arange(len(signs))
        names = {
            "f": jax.jit(lambda a, b: jax.numpy.einsum("ni,ij,nij->nj", a, signs, b[:, order])),
            "a": jax.numpy.asarray(a),
            "b": jax.numpy.asarray(b),
        }
        row.enter("JAX", "f(a, b).block_until_ready()", names, np.asarray)
    return row


Built = tuple[dict[str, Any], Callable[[Any], Any]]


def _ours(signature: Signature, a: Any, b: Any) -> Built:
    algebra = ph.algebra(*signature)
    zero = algebra.multivector(np.zeros(a.shape[-1]))
    blades = Blades(list(algebra.basis_vectors), algebra.scalar(1.0), lambda x: (x + zero).components)
    names = {x: algebra.multivector(blades.to_theirs(v)) for x, v in (("a", a), ("b", b))}
    return names, lambda c: blades.to_bits((c + zero).components)


def _clifford(signature: Signature, a: Any, b: Any) -> Built:
    from clifford import Cl

    p, q, r = signature
    layout, _ = Cl(p, q, r)
    # clifford puts the null generators first.
    vectors = [layout.blades_of_grade(1)[(k + r) % (p + q + r)] for k in range(p + q + r)]
    blades = Blades(vectors, layout.scalar, lambda x: x.value)
    names = {x: layout.MultiVector(blades.to_theirs(v)) for x, v in (("a", a), ("b", b))}
    return names, lambda c: blades.to_bits(c.value)


def _kingdon(signature: Signature, a: Any, b: Any) -> Built:
    from kingdon import Algebra

    p, q, r = signature
    algebra = Algebra(p, q, r)
    # kingdon puts the null generators first.
    n = p + q + r
    found = [algebra.blades[algebra.bin2canon[1 << (k + r) % n]] for k in range(n)]
    order = list(algebra.canon2bin.values())

    def full(x: Any) -> Any:
        held = dict(x.items())
        shape = np.shape(next(iter(held.values())))
        return np.stack([np.broadcast_to(held.get(key, 0.0), shape) for key in order], axis=-1)

    blades = Blades(found, algebra.blades.e, full)
    names = {}
    for x, v in (("a", a), ("b", b)):
        values = np.moveaxis(blades.to_theirs(v), -1, 0)
        names[x] = algebra.multivector(values.tolist() if values.ndim == 1 else np.ascontiguousarray(values))
    return names, lambda c: blades.to_bits(full(c))


def _galaga(signature: Signature, a: Any, b: Any) -> Built:
    from galaga import Algebra, Multivector

    p, q, r = signature
    algebra = Algebra((1,) * p + (-1,) * q + (0,) * r)
    names = {x: Multivector(algebra, np.array(v)) for x, v in (("a", a), ("b", b))}
    return names, lambda c: c.data  # its blades are by bits


def _gasparse(signature: Signature, a: Any, b: Any) -> Built:
    from gasparse import GA

    p, q, r = signature
    algebra = GA(*signature)
    grades = list(range(p + q + r + 1))
    # Its blades are by bits too.
    names = {x: algebra.mvarray(v.tolist(), grades=grades) for x, v in (("a", a), ("b", b))}
    return names, lambda c: c.tolist()[0]
