"""Rounded versors of any algebra: logarithms and roots against fifty digits."""

import mpmath
import numpy as np
import pytest

import polhode as ph

EPS = {np.float64: 2.0**-52, np.float32: 2.0**-23}
DEGENERATE = [(2, 0, 1), (3, 0, 1), (1, 3, 1), (4, 0, 1), (2, 0, 2), (5, 0, 1)]
REGULAR = [(4, 0, 0), (2, 2, 0), (3, 1, 0), (1, 2, 0), (4, 1, 0), (1, 3, 0), (6, 0, 0)]


def bivectors(A, count, seed, size=1.0):
    """Bivectors of random directions."""
    n = A.dimension
    return A.bivector(size * np.random.default_rng(seed).standard_normal((count, n * (n - 1) // 2)))


def size(M):
    """The Euclidean norm of the components."""
    return np.linalg.norm(M.components, axis=-1)


def exp_to_fifty_digits(A, b):
    """``exp B``: the series of B/2¹⁶, squared."""
    with mpmath.workdps(50):
        B = A.bivector([mpmath.mpf(float(x)) / 2**16 for x in b])
        term = total = A.scalar(mpmath.mpf(1)) + 0 * B
        for k in range(1, 12):  # (2⁻¹² )¹²/12! < 1e-50
            term = term * B / mpmath.mpf(k)
            total = total + term
        for _ in range(16):
            total = total * total
        return total.astype(float)


@pytest.mark.parametrize("signature", DEGENERATE)
def test_parts_of_a_motor_that_cancel_are_rounding(signature):
    A = ph.algebra(*signature)
    for far in (1.0, 1e2, 1e4):  # boosts are below 100, so their rounding is below √ε
        B = bivectors(A, 500, 1, 0.5)
        null = A.vector(np.eye(A.dimension)[-1])
        # A bivector that contains the null generator: a translation.
        away = A.vector(far * np.random.default_rng(3).standard_normal((500, A.dimension))).wedge(null)
        M = B.exp() * away.exp() * (0.1 * bivectors(A, 500, 2)).exp()
        one = ~M * M
        # Sums of 2ⁿ products of components of M.
        bound = A.size * EPS[np.float64] * size(M) ** 2
        assert np.all(size(one.log()) <= bound)
        assert np.all(size(one.sqrt() - 1) <= bound)


def test_null_parts_below_rounding_are_ignored():
    P = ph.algebra(3, 0, 1)
    assert (1 + 1e-17 * P.I).log() == 0
    assert (1 + 1e-17 * P.I).sqrt() == 1
    turn = P.bivector([0.3, 0.1, 0, -0.2, 0, 0])
    noisy = turn.exp() + 1e-17 * P.I
    assert size(noisy.log() - turn) <= 4 * EPS[np.float64]
    for wrong in (1e-6, 0.1, 1e3):
        with pytest.raises(ValueError, match="not an even versor"):
            (1 + wrong * P.I).log()


@pytest.mark.parametrize("name", ["log", "sqrt"])
def test_the_invalid_row_of_a_batch_is_named(name):
    P = ph.algebra(3, 0, 1)
    M = bivectors(P, 60, 4).exp()
    rows = np.array(M.components).reshape(3, 20, -1)
    rows[1, 7, -1] += 0.5
    bad = M._of(rows, M._mask, P)
    with pytest.raises(ValueError, match=r"at index \(1, 7\): not an even versor"):
        getattr(bad, name)()


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("signature", REGULAR + DEGENERATE)
def test_logarithms_of_rounded_versors(signature, dtype):
    A = ph.algebra(*signature)
    n = A.dimension
    for b in np.random.default_rng(5).standard_normal((6, n * (n - 1) // 2)):
        B = A.bivector((b / np.linalg.norm(b)).astype(dtype))
        M = exp_to_fifty_digits(A, B.components).astype(dtype)
        log, root = M.log(), M.sqrt()
        assert log.dtype == root.dtype == dtype
        # The logarithm magnifies the rounding of components by at most |M|; angles are below 1.
        assert size(log - B) <= 16 * EPS[dtype] * size(M) ** 2
        assert size(root * root - M) <= 16 * EPS[dtype] * size(M) ** 2


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("signature", [(2, 2, 0), (3, 1, 0), (1, 2, 0), (1, 3, 0), (4, 1, 0)])
def test_large_versors_have_logarithms(signature, dtype):
    A = ph.algebra(*signature)
    S = bivectors(A, 4000, 6, 0.9).exp()
    M = S * bivectors(A, 4000, 7, 0.7).exp() * ~S
    norms = size(M)
    largest = 80 if A.dimension < 5 or dtype is np.float64 else 10  # five generators lose more digits
    M = 3 * M[(norms > largest / 4) & (norms < largest)].astype(dtype)
    assert len(M) > 200
    lengths = size(M) / 3
    # The errors of M~M and of the norm that divides M are ε|R|², those of a bivector near null ones, which is
    # larger than its rotor, ε|B|²; 32 roundings of sums of products.
    log = M.log()
    error = size(log.exp() - M) / size(M)
    rounding = 32 * EPS[dtype] * (lengths**2 + size(log) ** 2)
    assert np.all(error <= 4096 * EPS[dtype] * (1 + size(log)) + rounding)


def test_single_precision_spans_subspaces():
    A = ph.algebra(5)
    a, b, c = (A.vector(v) for v in np.random.default_rng(8).standard_normal((3, 100, 5)).astype(np.float32))
    meet = (a ^ b).meet(b ^ c)
    assert meet.dtype == np.float32
    along = abs((meet | b.normalized()).components[..., 0])
    assert np.all(abs(along - 1) <= 64 * EPS[np.float32])


def test_small_null_parts_are_not_singular():
    A = ph.algebra(1, 1, 1)
    boost = A.bivector([16.0, 0, 0]).exp()
    noisy = boost + 1e-17 * A.bivector([0.0, 1, -1])
    assert size(noisy.inverse() - ~boost) <= 1e-15 * size(boost) ** 3


def test_the_sign_of_the_meet():
    A = ph.algebra(3)
    e1, e2, e3 = A.basis_vectors
    assert (-A.I).meet(e1) == e1  # A contains B: both keep their signs
    assert (-A.I).join(e1) == -A.I
    assert e1.meet(-A.I) == e1
    assert (-A.I).vee(e1) == -e1
    assert (e1 ^ e2).meet(-e3) == 1  # nothing in common
    assert (e1 ^ e2).join(-e3) == -A.I
    rng = np.random.default_rng(9)
    for n, k, m in [(3, 2, 2), (4, 3, 3), (4, 2, 3), (5, 3, 4)]:  # neither contains the other, I spanned
        B = ph.algebra(n)
        a, b = (B.scalar(np.ones(50)) for _ in range(2))
        for _ in range(k):
            a = a ^ B.vector(rng.standard_normal((50, n)))
        for _ in range(m):
            b = b ^ B.vector(rng.standard_normal((50, n)))
        vee = a.vee(b)
        assert np.all(size(a.meet(b) - vee / vee.norm()) <= 1e-11)
        assert np.all(size(a.join(b) - B.I) <= 1e-11)


@pytest.mark.parametrize("shift", [[1, 2, -1], [100.0, -30.0, 7.1], [1e5, 3e4, -2e5]])
def test_the_inverse_of_a_translation_holds_on_both_sides(shift):
    """A correction by the residual, which is rounding, would spoil ``T⁻¹ T``."""
    T = ph.cga(3).translator(ph.vector(shift))
    rounding = EPS[np.float64] * size(T) ** 2  # of the number ~T T
    assert size(T.inverse() * T - 1) <= rounding
    assert size(T * T.inverse() - 1) <= rounding


def test_versors_whose_squares_underflow_keep_their_digits():
    V = (ph.e1 + 2 * ph.e2) * (ph.e3 - ph.e1)
    whole = (V >> ph.e1).components
    for exponent in (-140, -150, -158, -160, -161, 120, 150):
        moved = (10.0**exponent * V) >> ph.e1
        assert np.abs(moved.components - whole).max() <= 4 * EPS[np.float64]
