"""exp, log, sqrt: against 60 digits, as inverses of each other, near-singular and extreme values."""

import math

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import polhode as ph
from naive import GRADE_SETS, eight_of, magnitude, ph_value
from polhode import I, e1, e2
from samples import EPS, close, e12, grade_sets, real, same


def mp_matrix(M):
    p = ph.to_pauli(M)
    return mpmath.matrix([[mpmath.mpc(complex(p[i, j])) for j in range(2)] for i in range(2)])


def mp_exp(M):
    """exp M as eight numbers, by the Pauli matrices with 60 digits."""
    with mpmath.workdps(60):
        p = mpmath.expm(mp_matrix(M))
        re, im = (lambda z: z.real), (lambda z: z.imag)
        half = mpmath.mpf(1) / 2
        return [
            half * re(p[0, 0] + p[1, 1]),
            half * re(p[0, 1] + p[1, 0]),
            half * im(p[1, 0] - p[0, 1]),
            half * re(p[0, 0] - p[1, 1]),
            half * im(p[0, 1] + p[1, 0]),
            half * re(p[0, 1] - p[1, 0]),
            half * im(p[0, 0] - p[1, 1]),
            half * im(p[0, 0] + p[1, 1]),
        ]


def distance(M, reference):
    """|M − reference| for a multiprecision reference."""
    with mpmath.workdps(60):
        return mpmath.sqrt(
            sum((mpmath.mpf(float(x)) - y) ** 2 for x, y in zip(eight_of(M), reference, strict=True))
        )


def size_of(reference):
    return mpmath.sqrt(sum(y * y for y in reference))


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("grades", GRADE_SETS)
def test_exp_against_mpmath(grades, seed):
    rng = np.random.default_rng(seed)
    M = ph_value(rng.uniform(-1, 1, 8) * 10.0 ** rng.uniform(-3, 0.7), grades)
    exact = mp_exp(M)
    # Rounding w = V² moves its root by eps |V|²/(2√|w|), or √eps |V| at worst where w vanishes; on exp it
    # acts like a change of M by a few eps |M|, magnified by |exp|'s condition, at most |M| e^|M|. Two
    # dozen operations: 32 eps (1 + |M|)² e^|M|.
    size = float(magnitude(M))
    assert distance(M.exp(), exact) <= 32 * EPS * (1 + size) ** 2 * np.exp(size)


@pytest.mark.parametrize("size", [10.0**k for k in range(-300, 4, 3)])
def test_exp_of_a_bivector_against_mpmath(size):
    B = ph.bivector(size * np.array([0.48, -0.6, 0.64]))
    with mpmath.workdps(400):
        x = [mpmath.mpf(float(c)) for c in B.components]
        angle = mpmath.sqrt(sum(c * c for c in x))
        exact = [mpmath.cos(angle), *(c * mpmath.sin(angle) / angle for c in x)]
        errors = [abs(mpmath.mpf(float(c)) - y) for c, y in zip(B.exp().components, exact, strict=True)]
    # The angle's rounding (squares, sum, root: 2 eps/2) moves the point along the circle by eps·angle; the
    # functions, quotient and product round four times more.
    assert max(errors) <= 2 * EPS * (float(angle) + 2)
    # Small bivectors keep their relative accuracy.
    if size < 1:
        assert all(error <= 4 * EPS * abs(y) for error, y in zip(errors, exact, strict=True))


@pytest.mark.parametrize("exponent", range(-300, 301, 20))
def test_exp_of_a_bivector_of_any_norm_is_a_unit_rotor(exponent):
    R = ph.bivector(10.0**exponent * np.array([0.48, -0.6, 0.64])).exp()
    assert isinstance(R, ph.Rotor)
    assert abs(magnitude(R) - 1) <= 4 * EPS


def test_powers_of_numbers():
    assert same(math.e**e12, e12.exp())
    assert isinstance(math.e ** (0.3 * e12), ph.Rotor)
    assert close(2**e1, 1.25 + 0.75 * e1, 4)  # cosh and sinh of log 2
    assert same(np.float64(2.0) ** e1, 2**e1)
    bivectors = ph.bivector([[0.0, 0.0, 0.5], [1.0, 2.0, 3.0]])
    assert same(math.e**bivectors, bivectors.exp())
    for base in (0, -1.0, math.nan):
        with pytest.raises(ValueError, match=f"must be > 0, got {base}"):
            _ = base**e12
    with pytest.raises(TypeError):
        _ = "2" ** e12


def test_exp_of_special_values():
    assert ph.scalar(0.0).exp() == 1
    assert (0 * e12).exp() == 1
    assert isinstance((0 * e12).exp(), ph.Rotor)
    assert close(ph.scalar(1.0).exp(), np.e, 2, 3)
    assert close(e1.exp(), np.cosh(1) + np.sinh(1) * e1, 4, 3)
    assert close((np.pi * I).exp(), -1, 4)
    # A null bivector + vector: the series ends.
    assert same((e1 + e1 * e2).exp(), 1 + e1 + e1 * e2)
    # Commuting parts.
    assert close(
        (2 + 3 * I + 0.5 * e12).exp(), ph.scalar(2.0).exp() * (3 * I).exp() * (0.5 * e12).exp(), 16, 8
    )


def test_exp_at_the_ends_of_the_range():
    with pytest.raises(ValueError, match="beyond the range"):
        ph.scalar(710.0).exp()
    with pytest.raises(ValueError, match=r"at index \(1,\).*beyond the range"):
        ph.vector([[1.0, 0, 0], [0, 1000.0, 0]]).exp()
    assert ph.scalar(-800.0).exp() == 0
    # λ± = 0 and −1600: ½(1 + e1), though cosh 800 alone is beyond the range.
    assert close((-800 + 800 * e1).exp(), (1 + e1) / 2, 4)
    # A large angle does not give a large result.
    assert close((1e160 * e12 + I).exp(), (1e160 * e12).exp() * I.exp(), 16)


@given(st.lists(real, min_size=8, max_size=8).map(np.array), grade_sets, st.sampled_from([1e-12, 1e-4, 0.1]))
def test_log_undoes_exp_for_small_values(eight, grades, scale):
    M = ph_value(eight * scale, grades)
    size = float(magnitude(M))
    if size >= 2:
        return
    # Inside the principal strip (|M| < π). exp rounds by 32 eps (1 + |M|)² e^|M| as above, log's
    # condition is at most |exp(−M)|·cond(V), and its own rounding is of the same size.
    assert close(M.exp().log(), M, 64 * (1 + size) ** 2 * np.exp(2 * size))


def eigenvalues(M):
    zeta = M.grade(0).components[0] + 1j * M.grade(3).components[0]
    a, b = M.grade(1).components, M.grade(2).components
    root = np.sqrt(complex(a @ a - b @ b, 2 * a @ b))
    return zeta + root, zeta - root


regular = st.builds(ph_value, st.lists(real, min_size=8, max_size=8).map(np.array), grade_sets).filter(
    lambda M: min(map(abs, eigenvalues(M))) > 1e-2 * magnitude(M) > 0
)


def condition(M):
    """|M||M⁻¹|: with the Clifford conjugate, |M⁻¹| = |M|/|λ+ λ−|."""
    plus, minus = eigenvalues(M)
    return magnitude(M) ** 2 / abs(plus * minus)


# Rounding ζ² − w leaves eps |M|² beside |λ+ λ−|: a relative error of the condition times eps in what is
# divided by it. Complex products and quotients of a dozen operations each: 16.


@given(regular)
def test_inverse_of_regular_values(M):
    inverse = M.inverse()
    assert close(M * inverse, 1, 16 * condition(M))
    assert close(inverse * M, 1, 16 * condition(M))


@given(regular)
def test_exp_undoes_log(M):
    log = M.log()
    # exp magnifies the rounding of its argument, eps |log M|.
    assert close(log.exp(), M, 16 * condition(M) * (1 + magnitude(log)), magnitude(M))


@given(regular)
def test_logarithms_of_values_that_are_not_even_are_principal(M):
    if any(M.grade(k).components.any() for k in (1, 3)):
        for value in eigenvalues(M.log()):
            assert abs(value.imag) <= np.pi * (1 + 16 * EPS * condition(M))


def test_the_principal_logarithm_near_the_negative_axis():
    # λ± = −1 ± iδ (nearly), on both sides of the cut: their logarithms have the imaginary parts ±(π − δ).
    for delta in (0.4, 0.49, 0.51, 0.6):
        M = -1 + delta * e12 + 1e-12 * e1
        assert max(abs(value.imag) for value in eigenvalues(M.log())) <= np.pi * (1 + 16 * EPS)


@given(regular)
def test_sqrt_squares_to_the_value(M):
    try:
        root = M.sqrt()
    except ValueError:
        # Only where the two roots cancel: λ± on opposite sides of the cut.
        plus, minus = eigenvalues(M)
        assert abs(np.sqrt(plus) + np.sqrt(minus)) ** 2 <= 1e-14 * magnitude(M)
        return
    # Some fifty operations, in terms as large as |√M|².
    assert close(root * root, M, 64, magnitude(root) ** 2)


@pytest.mark.parametrize("scale", [1e-300, 1e-160, 1.0, 1e160, 1e300])
@pytest.mark.parametrize("grades", GRADE_SETS)
def test_log_and_sqrt_at_any_scale(grades, scale):
    M = ph_value(scale * np.array([3.0, 1, -0.5, 0.25, 0.5, -1, 0.75, 2]), grades)
    root = M.sqrt()
    assert close(root / np.sqrt(scale) * (root / np.sqrt(scale)), M / scale, 64, 16)
    # log M is as large as ln scale, and its rounding is magnified by that.
    assert close(M.log().exp() / scale, M / scale, 64 * (4 + abs(np.log(scale))), 16)


def test_log_and_sqrt_at_the_end_of_the_range():
    big = 1.7e308 * (1 + e12)
    # log = ln(1.7e308 √2) + π/4 e12.
    assert close(big.log(), np.log(1.7e308) + np.log(2) / 2 + np.pi / 4 * e12, 4, 710)
    root = big.sqrt() / 2.0**512
    assert close(root * root, 1.7e308 / 2.0**1023 / 2 * (1 + e12), 16, 2)


def test_log_and_sqrt_of_special_values():
    assert same(ph.scalar(1.0).log(), 0)
    assert same(ph.scalar(-1.0).log(), np.pi * e12)
    assert close(ph.scalar(-1.0).sqrt(), e12, 2)
    assert close(ph.scalar(4.0).sqrt(), 2, 2, 2)
    assert close((-4 * e12).sqrt(), np.sqrt(2) * (1 - e12), 4, 2)
    assert close(e1.log().exp(), e1, 8)
    assert close(I.log().exp(), I, 8)
    assert same(ph.scalar(0.0).sqrt(), 0)
    assert close((1 + e1).sqrt(), (1 + e1) / np.sqrt(2), 4, 2)  # singular, but has a root


@pytest.mark.parametrize("A", [1 + e1, e1 + e1 * e2, 0 * e1, ph.scalar(0.0), e12 + I], ids=repr)
def test_singular_values_have_no_logarithm(A):
    with pytest.raises(ValueError, match="no logarithm"):
        A.log()


def test_null_values_have_no_square_root():
    with pytest.raises(ValueError, match="no square root"):
        (e1 + e1 * e2).sqrt()
    with pytest.raises(ValueError, match=r"at index \(1,\): no square root"):
        ((e1 + e1 * e2) + np.array([5.0, 0.0])).sqrt()


@pytest.mark.parametrize("delta", [10.0**-k for k in range(2, 15, 2)])
def test_inverse_near_singular_is_accurate_to_its_condition(delta):
    M = 1 + (1 - delta) * e1
    # (1 + c e1)⁻¹ = (1 − c e1)/(1 − c²).
    c = 1 - delta
    exact = (1 - c * e1) / ((1 - c) * (1 + c))
    assert close(M.inverse(), exact, 8 / delta, magnitude(exact))
