"""Algebras of any signature: products against an oracle, geometry in the usual ones, errors."""

import pickle
from functools import cache
from itertools import product as pairs

import numpy as np
import pytest

import polhode as ph
from blades import KEEP, LARGE, SIGNATURES, basis, full, numbers, places, product, sizes, squares, terms

EPS = 2.0**-52
NAMES = [*KEEP, "commutator"]
every = pytest.mark.parametrize("signature", SIGNATURES, ids=str)
PGA, CGA, SPACETIME = ph.algebra(3, 0, 1), ph.algebra(4, 1), ph.algebra(1, 3)

table_of = cache(terms)


def expected(name, signature, a, b):
    table = table_of(signature)
    if name == "commutator":
        return 0.5 * (product("geometric_product", table, a, b) - product("geometric_product", table, b, a))
    return product(name, table, a, b)


def sparse(A, grades, data):
    """The value of some grades of full components."""
    masked = np.zeros_like(data)
    masked[..., places(A.dimension, grades)] = data[..., places(A.dimension, grades)]
    parts = [A.multivector(data).grade(k) for k in grades]
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return total, masked


# --- products


@every
@pytest.mark.parametrize("name", NAMES)
def test_products_equal_the_oracle(signature, name):
    A = ph.algebra(*signature)
    a, b = numbers((3, 1, A.size), 1), numbers((2, A.size), 2)
    got = getattr(A.multivector(a), name)(A.multivector(b))
    assert got.shape == (3, 2)
    assert np.array_equal(full(got), expected(name, signature, a, b))


@pytest.mark.parametrize("signature", LARGE, ids=str)
@pytest.mark.parametrize("grades", [((1,), (2,)), ((1, 3), (0, 2)), ((4,), (4,))], ids=str)
def test_sparse_products_of_many_generators_equal_the_oracle(signature, grades):
    A = ph.algebra(*signature)
    operands = [sparse(A, g, numbers((A.size,), seed)) for seed, g in enumerate(grades)]
    (a, row), (b, column) = operands
    metric = squares(signature)
    assert np.array_equal(full(a * b), by_bits(metric, row, column))


def by_bits(metric, row, column):
    """The geometric product by bits, each sign counted from swaps: faster for hundreds of blades."""
    n = len(metric)
    blades = [sum(1 << g - 1 for g in blade) for blade in basis(n)]
    place = {bits: k for k, bits in enumerate(blades)}
    result = np.zeros(2**n)
    for (i, a), (j, b) in pairs(enumerate(blades), repeat=2):
        if row[i] and column[j]:
            swaps = sum((a >> k + 1).bit_count() for k in range(n) if b >> k & 1)
            sign = (-1) ** swaps * int(np.prod([metric[k] for k in range(n) if a & b & 1 << k]))
            result[place[a ^ b]] += sign * row[i] * column[j]
    return result


@pytest.mark.parametrize("signature", LARGE, ids=str)
def test_full_products_of_eight_generators(signature):
    A = ph.algebra(*signature)
    a, b = numbers((A.size,), 3), numbers((A.size,), 4)
    assert np.array_equal(full(A.multivector(a) * A.multivector(b)), by_bits(squares(signature), a, b))


@every
def test_single_values_and_batches_and_single_precision_agree(signature):
    A = ph.algebra(*signature)
    a, b = numbers((7, A.size), 5), numbers((7, A.size), 6)
    batch = A.multivector(a) * A.multivector(b)
    small = A.multivector(a.astype(np.float32)) * A.multivector(b.astype(np.float32))
    assert small.dtype == np.float32
    for i in range(7):
        assert A.multivector(a[i]) * A.multivector(b[i]) == batch[i]
    assert np.all(small == batch)  # whole numbers below 2²⁴


@every
@pytest.mark.parametrize("kind", ["exact", "jax"])
def test_all_coefficients_give_equal_results(signature, kind):
    A = ph.algebra(*signature)
    a, b = numbers((2, A.size), 7), numbers((A.size,), 8)
    if kind == "exact":
        x, y = (A.multivector(data, dtype=object) for data in (a, b))
    else:
        jnp = pytest.importorskip("jax.numpy")  # 32 bits: whole numbers below 2²⁴ are exact
        x, y = (A.multivector(jnp.asarray(data, dtype="float32")) for data in (a, b))
    for name in NAMES:
        got = getattr(x, name)(y)
        want = getattr(A.multivector(a), name)(A.multivector(b))
        assert got.grades == want.grades
        assert np.array_equal(np.asarray(got.components, dtype=float), want.components)


@every
def test_involutions_and_complements(signature):
    A = ph.algebra(*signature)
    M, N = A.multivector(numbers((4, A.size), 9)), A.multivector(numbers((4, A.size), 10))
    assert np.all(~(M * N) == ~N * ~M)
    assert np.all((M * N).grade_involution() == M.grade_involution() * N.grade_involution())
    assert np.all(M.clifford_conjugate() == ~M.grade_involution())
    for E in A.blades.values():
        assert E.wedge(E.right_complement()) == A.I
        assert E.left_complement().wedge(E) == A.I
    assert np.all(M.right_complement().left_complement() == M)
    assert np.all(M.vee(N).right_complement() == M.right_complement().wedge(N.right_complement()))
    assert np.all(M.vee(A.I) == M)


@every
def test_dual_needs_an_invertible_pseudoscalar(signature):
    A = ph.algebra(*signature)
    M = A.multivector(numbers((2, A.size), 11))
    if signature[2]:
        for name in ("dual", "undual"):
            with pytest.raises(TypeError, match=r"I has no inverse in Cl\(.*right_complement"):
                getattr(M, name)()
    else:
        assert np.all(M.dual().undual() == M)
        assert np.all(M.dual() * A.I == M)


@every
def test_inverse(signature):
    A = ph.algebra(*signature)
    data = numbers((5, A.size), 12) / 9
    data[:, 0] += 3 * A.size**0.5  # far from singular
    M = A.multivector(data)
    inverse = M.inverse()
    for one in (M * inverse, inverse * M):
        assert np.abs(full(one - 1)).max() <= 64 * A.size * EPS
    exact = A.multivector(data.round(), dtype=object)
    assert np.all(exact * exact.inverse() == 1)


@every
def test_the_basis_and_its_names(signature):
    A = ph.algebra(*signature)
    n = sum(signature)
    assert A.dimension == n
    assert A.size == 2**n
    assert A.signature == signature
    metric = squares(signature)
    assert [v * v == s for v, s in zip(A.basis_vectors, metric, strict=True)] == [True] * n
    names = ["∧".join(f"e{g}" for g in blade) for blade in basis(n)]
    names[0] = "1"
    if n > 1:
        names[-1] = "I"
    assert list(A.blades) == names
    assert [repr(E) for E in A.blades.values()] == names
    total = A.scalar(1)
    for v in A.basis_vectors:
        total = total * v
    assert total == A.I
    for k, size in enumerate(sizes(n)):
        assert A.k_vector(k, np.ones(size)).grades == (k,)


# --- algebras as objects


def test_the_algebra_of_space_is_that_of_the_package():
    A = ph.algebra(3)
    assert A is ph.e1.algebra
    assert A is ph.algebra(3, 0, 0)
    assert A.basis_vectors[0] == ph.e1
    assert A.I == ph.I
    assert np.all(A.multivector(np.arange(8.0)) == ph.multivector(np.arange(8.0)))
    assert A.blades["e3∧e1"] == ph.e3 ^ ph.e1
    assert isinstance(A.bivector([0.0, 0, 0.1]).exp(), ph.Rotor)


@every
def test_the_same_signature_is_the_same_object_also_pickled(signature):
    A = ph.algebra(*signature)
    assert ph.algebra(*signature) is A
    for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
        assert pickle.loads(pickle.dumps(A, protocol)) is A
        M = pickle.loads(pickle.dumps(A.multivector(numbers((2, A.size), 13)), protocol))
        assert M.algebra is A
        assert np.all(A.multivector(numbers((2, A.size), 13)) == M)


def test_repr():
    assert [repr(A) for A in (ph.algebra(3), CGA, PGA, ph.algebra(0, 2))] == [
        "Cl(3)",
        "Cl(4,1)",
        "Cl(3,0,1)",
        "Cl(0,2)",
    ]
    e1, e2, e3, e4 = PGA.basis_vectors
    assert repr(2 * e1 * e4 - e2 * e3) == "2 e1∧e4 - e2∧e3"
    assert repr(1 + e1 * e2 * e3 * e4) == "1 + I"


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ((-1,), ValueError, "counts >= 0, got -1, 0, 0"),
        ((1, -2, 0), ValueError, "got 1, -2, 0"),
        ((True,), ValueError, "got True"),
        ((9,), ValueError, "8"),
        ((4, 4, 1), ValueError, "8"),
        ((10**30,), ValueError, "at most 8"),
        ((1.5,), TypeError, "whole numbers.*got 1.5"),
        (("3",), TypeError, "whole numbers.*got '3'"),
        ((None,), TypeError, "whole numbers.*got None"),
    ],
)
def test_invalid_signatures_raise(arguments, error, message):
    with pytest.raises(error, match=message):
        ph.algebra(*arguments)


def test_algebras_do_not_mix():
    a, b = PGA.basis_vectors[0], CGA.basis_vectors[0]
    for operate in (
        lambda: a * b,
        lambda: a + b,
        lambda: a - b,
        lambda: a.wedge(b),
        lambda: a | b,
        lambda: a.vee(b),
        lambda: a / b,
        lambda: a.is_close(b),
        lambda: ph.stack([a, b]),
        lambda: ph.concatenate([a[None], b[None]]),
        lambda: a.join(b),
        lambda: a.project(b),
        lambda: a.dot(b, out=np.zeros(1)),
    ):
        with pytest.raises(TypeError, match=r"different algebras, Cl\(3,0,1\) and Cl\(4,1\)"):
            operate()
    assert a != b
    with pytest.raises(TypeError, match="different algebras"):
        ph.e1 * a
    with pytest.raises(TypeError, match="different algebras"):
        ph.Rotor.identity()(a)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: PGA.vector([1, 2, 3]), r"vector needs 4 components .* got shape \(3,\)"),
        (lambda: PGA.bivector(np.ones((2, 3))), r"bivector needs 6 .* got shape \(2, 3\)"),
        (lambda: CGA.multivector(np.ones(16)), r"multivector needs 32"),
        (lambda: CGA.k_vector(3, np.ones(5)), r"3-vector needs 10"),
        (lambda: CGA.k_vector(6, np.ones(5)), r"Cl\(4,1\) has grades 0 to 5, got 6"),
        (lambda: CGA.k_vector(-1, np.ones(5)), r"got -1"),
        (lambda: CGA.scalar(1.0).grade(6), r"Cl\(4,1\) has grades 0 to 5, got 6"),
        (lambda: ph.algebra(1).bivector([1.0]), r"Cl\(1\) has grades 0 to 1; it has no bivector"),
        (lambda: ph.algebra(0).vector([]), r"Cl\(0\) has grades 0 to 0; it has no vector"),
    ],
)
def test_wrong_components_are_errors(make, message):
    with pytest.raises(ValueError, match=message):
        make()
