"""Operators of single values of any algebra give the bits and the errors of those over batches."""

import copy
import operator
import re
import sys

import numpy as np
import pytest

import polhode as ph
from blades import SIGNATURES

ALGEBRAS = [ph.algebra(*signature) for signature in SIGNATURES if sum(signature)] + [
    ph.pga(2),
    ph.pga(3),
    ph.cga(3),
]
every = pytest.mark.parametrize("A", ALGEBRAS, ids=str)
EXTREMES = [0.0, -0.0, 5e-324, -1e-300, 1e-8, 1.0, -3.0, 1e150, -1e300, np.inf, np.nan]

PAIRS = {
    "product": operator.mul,
    "sum": operator.add,
    "difference": operator.sub,
    "wedge": operator.xor,
    "dot": operator.or_,
    "vee": operator.and_,
    "commutator": ph.Multivector.commutator,
    "contraction": ph.Multivector.left_contraction,
    "scalar": ph.Multivector.scalar_product,
}
ALONE = {
    "negative": operator.neg,
    "reverse": operator.invert,
    "double": lambda a: 2 * a,
    "scaled": lambda a: a * -0.3,
    "quotient": lambda a: a / 3,
    "more": lambda a: a + 1,
    "less": lambda a: a - 0.5,
    "from": lambda a: 1 - a,
    "grade 0": lambda a: a.grade(0),
    "last grade": lambda a: a.grade(a.algebra.dimension),
    "wedge with a number": lambda a: 3 ^ a,
}
FUNCTIONS = ["exp", "log", "sqrt", "inverse"]


def values(A, rng, rows=6):
    """Batches of full components, of some grades, and of extreme numbers."""
    n = A.dimension
    yield A.multivector(rng.normal(size=(rows, A.size)))
    for grades in sorted({(0,), (n // 2,), tuple(range(0, n + 1, 2)), (0, n)}):
        yield A.multivector(rng.normal(size=(rows, A.size))).grade(*grades)
    yield A.multivector(rng.choice(EXTREMES, size=(rows, A.size)))


def same(single, batch, i):
    """Whether a single value is a value of a batch, with its grades, signs of zeros included."""
    row = batch[i]
    assert type(single) is type(row)
    assert single.grades == row.grades
    a, b = np.asarray(single.components), np.asarray(row.components)
    np.testing.assert_array_equal(a, b)
    known = ~np.isnan(a)
    np.testing.assert_array_equal(np.signbit(a[known]), np.signbit(b[known]))
    assert single._is_one or not single._data.flags.writeable


@every
@pytest.mark.parametrize("name", PAIRS)
def test_pairs(A, name):
    rng = np.random.default_rng(1)
    rights = list(values(A, rng))
    for a in values(A, rng):
        for b in rights:
            batch = PAIRS[name](a, b)
            for i in range(len(a)):
                same(PAIRS[name](a[i], b[i]), batch, i)


@every
@pytest.mark.parametrize("name", ALONE)
def test_one_operand(A, name):
    for a in values(A, np.random.default_rng(2)):
        batch = ALONE[name](a)
        for i in range(len(a)):
            same(ALONE[name](a[i]), batch, i)


@every
@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions(A, name):
    for a in values(A, np.random.default_rng(3)):
        batch = getattr(a, name)(errors="mask")
        for i, ok in enumerate(batch.is_finite()):
            if ok:
                same(getattr(a[i], name)(), batch, i)
            else:
                with pytest.raises(ValueError, match=" ") as of_batch:
                    getattr(a[i : i + 1], name)()
                text = str(of_batch.value).replace("at index (0,): ", "").replace(" at index (0,)", "")
                with pytest.raises(ValueError, match=re.escape(text)):
                    getattr(a[i], name)()


@every
def test_norms(A):
    """Sums of squares in another order differ by roundings of each."""
    rng = np.random.default_rng(6)
    for a in [*values(A, rng), A.multivector(rng.normal(size=(6, A.size)) * 1e200)]:
        close = {"rtol": 2 * A.size * 2.0**-52, "atol": 0}
        norms, units = a.norm(), a.normalized(errors="mask")
        known = np.isfinite(norms) & units.is_finite()
        # Where squares cancel, so do digits.
        known &= norms > 1e-3 * np.abs(a.components).max(axis=-1)
        for i, single in enumerate(a):
            assert np.isfinite(single.norm()) == np.isfinite(norms[i])
            if known[i]:
                np.testing.assert_allclose(single.norm(), norms[i], **close)
                assert single.normalized().is_close(units[i])
            elif not units[i].is_finite():
                with pytest.raises(ValueError, match=re.escape("has no direction")):
                    single.normalized()


@every
def test_equality(A):
    for a in values(A, np.random.default_rng(4)):
        b = a.grade(0, A.dimension)
        for x in (a, copy.copy(a), b, a + 0, 1.0):
            batch = a == x
            for i in range(len(a)):
                assert (a[i] == (x if isinstance(x, float) else x[i])) is bool(batch[i])


@every
def test_versors_act(A):
    rng = np.random.default_rng(5)
    vectors = [a for a in A.basis_vectors if a.norm_squared()]
    x = A.multivector(rng.normal(size=(4, A.size)))
    for count in range(len(vectors) + 1):
        weights = rng.uniform(0.5, 2, size=(4, max(count, 1)))
        V = A.scalar(weights[:, 0])
        for k, a in enumerate(vectors[:count]):
            V = V * (a * weights[:, k] + (vectors[0] * 0.3 if a is not vectors[0] else 0))
        for part in (x, x.grade(1), x.grade(A.dimension)):
            batch = V(part)
            for i in range(4):
                same(V[i](part[i]), batch, i)
                assert (V[i] >> part[i]) == batch[i]


@every
def test_values_that_are_not_versors(A):
    x = A.basis_vectors[0]
    bad = [A.scalar(0.0), A.scalar(1.0) + A.basis_vectors[-1], A.scalar(np.nan), A.scalar(np.inf)]
    for V in bad:
        with pytest.raises(TypeError, match="versor"):
            V(x)
    with pytest.raises(TypeError, match="acts on multivectors, got list"):
        A.scalar(1.0)([1, 2])


@every
def test_errors(A):
    a = A.multivector(np.arange(1.0, A.size + 1))
    other = ph.algebra(2, 1, 1)
    with pytest.raises(TypeError, match="different algebras"):
        a * other.basis_vectors[0] if A is not other else a * ph.e1
    with pytest.raises(TypeError, match="different algebras"):
        a + (other.basis_vectors[0] if A is not other else ph.e1)
    with pytest.raises(ZeroDivisionError, match="division of a multivector by zero"):
        a / 0
    with pytest.raises(ValueError, match=f"has grades 0 to {A.dimension}, got {A.dimension + 1}"):
        a.grade(A.dimension + 1)
    for wrong in (-1, 70_000):
        with pytest.raises(ValueError, match="has grades"):
            a.grade(wrong)
    with pytest.raises(TypeError, match="unsupported operand"):
        a + "x"


def test_operands_keep_counts_of_references():
    """No operator keeps or loses a reference to an algebra or to an array."""
    A = ph.pga(3)
    M = (0.2 * A.multivector(np.arange(16.0)).grade(2)).exp()
    x = A.basis_vectors[1]
    held = [A, M, x, M._data, x._data]
    before = [sys.getrefcount(value) for value in held]
    for _ in range(300):
        M * x, M + x, -M, ~M, M.grade(2), M(x), M.exp(), x == M, 2 * x
    assert max(abs(sys.getrefcount(v) - b) for v, b in zip(held, before, strict=True)) < 5


def test_motors_of_single_precision_act():
    """Rounding leaves M ~M a number to half of the digits of the type of M."""
    A, rng = ph.pga(3), np.random.default_rng(7)
    points = A.point(rng.normal(size=(500, 3)))
    M = (0.3 * (points & A.point(rng.normal(size=(500, 3))))).exp()
    M32, P32 = M.astype(np.float32), points.astype(np.float32)
    # Each factor is rounded, V ~V twice, and so is the result: 6 roundings of no more than |V| |X| |V|.
    sizes = [np.abs(value.components).sum(axis=-1, keepdims=True) for value in (M, points)]
    bound = 6 * np.finfo(np.float32).eps * sizes[0] ** 2 * sizes[1]
    for k in (slice(None), 3):
        found = M32[k](P32[k])
        assert found.dtype == np.float32
        assert np.all(np.abs(found.components - M(points)[k].components) <= bound[k])
    with pytest.raises(TypeError, match=r"V ~V must be a number other than 0 at index \(0,\)"):
        (M32 + np.float32(0.01) * A.I)(P32)


@pytest.mark.parametrize("dtype", [float, np.float32])
@pytest.mark.parametrize("A", [ph.algebra(3), ph.pga(3), ph.cga(3)], ids=str)
def test_versors_of_any_size_act(A, dtype):
    """The square of V over- or underflows; a factor that is a power of two rounds nothing."""
    limits, rng = np.finfo(dtype), np.random.default_rng(9)
    a, b = A.random((2, 4), grades=1, rng=rng).astype(dtype)
    X = A.random((4,), rng=rng).astype(dtype)
    for factor in 2.0 ** np.array([0.9 * limits.minexp, 0.9 * limits.maxexp]):
        for V in (a * b, a):
            for k in (slice(None), 1):
                moved = (factor.astype(dtype) * V[k])(X[k])
                assert moved.dtype == dtype
                assert np.all(moved.is_close(V[k](X[k]), rtol=1e3 * limits.eps, atol=1e3 * limits.eps))


@every
@pytest.mark.parametrize("dtype", [float, np.float32])
def test_parts_of_grades(A, dtype):
    """Each set of grades takes and fills just the components of the blades of these grades."""
    rng = np.random.default_rng(8)
    full = rng.normal(size=(3, A.size)).astype(dtype)
    a = A.multivector(full)
    grade_of = np.array([int(A._grade_of[i]) for i in range(A.size)])
    for held in {(0,), (A.dimension,), tuple(range(A.dimension + 1)), (0, A.dimension)}:
        for wanted in {(A.dimension // 2,), (0, A.dimension), tuple(range(A.dimension + 1))}:
            part = a.grade(*held).grade(*wanted)
            expected = np.where(np.isin(grade_of, held) & np.isin(grade_of, wanted), full, 0)
            assert part.dtype == dtype
            np.testing.assert_array_equal(part.components, expected[:, np.isin(grade_of, wanted)])
