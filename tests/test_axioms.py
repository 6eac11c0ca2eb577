"""The laws of the algebra and of rotors, over all kinds of values, batch shapes and near-singular samples.

Whole components make the polynomial laws exact. Where rounding enters, the allowance is a count of
roundings times EPS times the size of what is summed; the count is stated where it is used.
"""

import mpmath
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import polhode as ph
from naive import GRADE_SETS, eight_of, magnitude, ph_value
from polhode import I, e1, e2, e3

EPS = 2.0**-52
SHAPES = [(), (1,), (3, 1, 2)]
e12 = e1.wedge(e2)

whole = st.integers(-9, 9).map(float)
wholes8 = st.lists(whole, min_size=8, max_size=8).map(np.array)
wholes3 = st.lists(whole, min_size=3, max_size=3).map(np.array)
grade_sets = st.sampled_from(GRADE_SETS)
values = st.builds(ph_value, wholes8, grade_sets)
vectors = st.builds(ph.vector, wholes3)
bivectors = st.builds(ph.bivector, wholes3)

real = st.floats(-10, 10, allow_subnormal=False)
angles = st.one_of(
    st.floats(-7, 7),
    # Near 0, π and 2π, from both sides, at every distance.
    st.builds(
        lambda around, sign, exponent: around + sign * 10.0**exponent,
        st.sampled_from([0.0, np.pi, 2 * np.pi, -np.pi]),
        st.sampled_from([-1, 0, 1]),
        st.integers(-18, -1),
    ),
)


def unit(numbers):
    return numbers / np.linalg.norm(numbers)


directions = (
    st.lists(st.one_of(whole, st.floats(-1, 1), st.just(1e-17)), min_size=3, max_size=3)
    .map(np.array)
    .filter(lambda v: np.linalg.norm(v) > 1e-3)
    .map(unit)
)
rotors = st.builds(lambda n, angle: ph.Rotor.from_plane_angle(ph.bivector(n), angle), directions, angles)


def same(left, right):
    return bool(np.all(left == right))


def close(left, right, count, size=1.0):
    return bool(np.all(magnitude(left - right) <= count * EPS * size))


# --- the algebra: exact


@given(values, values, values)
def test_products_are_associative(A, B, C):
    assert same((A * B) * C, A * (B * C))
    assert same(A.wedge(B).wedge(C), A.wedge(B.wedge(C)))


@given(values, values, values, whole)
def test_products_are_linear(A, B, C, s):
    for multiply in (
        lambda X, Y: X * Y,
        lambda X, Y: X.wedge(Y),
        lambda X, Y: X.dot(Y),
        lambda X, Y: X.commutator(Y),
        lambda X, Y: X.left_contraction(Y),
        lambda X, Y: X.right_contraction(Y),
        lambda X, Y: X.scalar_product(Y),
    ):
        assert same(multiply(A, B + s * C), multiply(A, B) + s * multiply(A, C))
        assert same(multiply(B + s * C, A), multiply(B, A) + s * multiply(C, A))


@given(values, values, values)
def test_contractions(A, B, C):
    # (A∧B)⌋C = A⌋(B⌋C), A⌋(B⌊C) = (A⌋B)⌊C, and the mirror image by reversion.
    assert same(A.wedge(B).left_contraction(C), A.left_contraction(B.left_contraction(C)))
    assert same(
        A.left_contraction(B.right_contraction(C)),
        A.left_contraction(B).right_contraction(C),
    )
    assert same(~A.left_contraction(B), (~B).right_contraction(~A))


@given(values, values, values)
def test_contraction_is_adjoint_to_the_wedge(A, B, C):
    # ⟨(A∧B) C⟩ = ⟨A (B⌋C)⟩.
    assert same(A.wedge(B).scalar_product(C), A.scalar_product(B.left_contraction(C)))


@given(vectors, values, values)
def test_contraction_with_a_vector_is_a_derivation(a, B, C):
    left = a.left_contraction(B.wedge(C))
    assert same(left, a.left_contraction(B).wedge(C) + B.grade_involution().wedge(a.left_contraction(C)))
    whole_product = a.left_contraction(B * C)
    assert same(whole_product, a.left_contraction(B) * C + B.grade_involution() * a.left_contraction(C))


@given(vectors, values)
def test_vector_times_anything_is_contraction_plus_wedge(a, B):
    assert same(a * B, a.left_contraction(B) + a.wedge(B))
    assert same(B * a, B.right_contraction(a) + B.wedge(a))


@given(values, values)
def test_involutions_of_products(A, B):
    assert same(~(A * B), ~B * ~A)
    assert same((A * B).grade_involution(), A.grade_involution() * B.grade_involution())
    assert same((A * B).clifford_conjugate(), B.clifford_conjugate() * A.clifford_conjugate())
    assert same((~A).grade_involution(), A.clifford_conjugate())
    assert same(~~A, A)


@given(values, values, values)
def test_commutator_is_a_derivation_and_obeys_jacobi(A, B, C):
    # Twice each commutator, so that halves stay whole.
    def bracket(X, Y):
        return 2 * X.commutator(Y)

    assert same(bracket(A, B), A * B - B * A)
    assert same(bracket(A, B * C), bracket(A, B) * C + B * bracket(A, C))
    jacobi = bracket(A, bracket(B, C)) + bracket(B, bracket(C, A)) + bracket(C, bracket(A, B))
    assert same(jacobi, 0)


@given(bivectors, values)
def test_commutator_with_a_bivector_keeps_grades(B, A):
    for k in A.grades:
        part = B.commutator(A.grade(k))
        assert same(part, part.grade(k))


@given(values)
def test_norm_is_positive_and_the_scalar_part(A):
    assert same(A.scalar_product(~A), A.norm_squared())
    assert A.norm_squared() >= 0


@given(vectors, values)
def test_norm_of_a_product_with_a_vector(a, B):
    assert (a * B).norm_squared() == a.norm_squared() * B.norm_squared()


@given(values, bivectors, whole)
def test_norm_of_a_product_with_a_multiple_of_a_rotor(A, B, s):
    R = s + B
    assert (R * A).norm_squared() == R.norm_squared() * A.norm_squared()


@given(vectors, vectors, vectors)
def test_dual_of_a_wedge_is_the_cross_product(a, b, c):
    assert same(a.wedge(b).dual(), ph.cross(a, b))
    # a x (b x c) = b (a·c) − c (a·b); a·(b x c) I = a∧b∧c.
    assert same(ph.cross(a, ph.cross(b, c)), b * a.dot(c) - c * a.dot(b))
    assert same(a.dot(ph.cross(b, c)) * I, a.wedge(b).wedge(c))


@given(values, values)
def test_duality_exchanges_wedge_and_contraction(A, B):
    assert same(A.wedge(B).dual(), A.left_contraction(B.dual()))
    assert same(A.left_contraction(B).undual(), A.wedge(B.undual()))


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("grades", GRADE_SETS)
def test_grades_hold_what_the_full_computation_gives(grades, shape):
    rng = np.random.default_rng(1)
    eight = rng.integers(-9, 10, (*shape, 8)).astype(float)
    A = ph_value(eight, grades)
    full = ph.multivector(eight_of(A))
    B = ph.multivector(rng.integers(-9, 10, (*shape, 8)).astype(float))
    for s in GRADE_SETS:
        part = ph_value(eight_of(B), s)
        assert same(A * part, full * ph.multivector(eight_of(part)))
    small, small_full = A / 16, full / 16
    assert close(small.exp(), small_full.exp(), 32, np.exp(magnitude(small)))


# --- exp, log, sqrt


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
    """|M − reference| where the reference has many digits."""
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
def test_exp_of_a_bivector_is_a_unit_rotor_at_any_size(exponent):
    R = ph.bivector(10.0**exponent * np.array([0.48, -0.6, 0.64])).exp()
    assert isinstance(R, ph.Rotor)
    assert abs(magnitude(R) - 1) <= 4 * EPS


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
    # A large angle is no large result.
    assert close((1e160 * e12 + I).exp(), (1e160 * e12).exp() * I.exp(), 16)


@given(st.lists(real, min_size=8, max_size=8).map(np.array), grade_sets, st.sampled_from([1e-12, 1e-4, 0.1]))
def test_log_undoes_exp_for_small_values(eight, grades, scale):
    M = ph_value(eight * scale, grades)
    size = float(magnitude(M))
    if size >= 2:
        return
    # Inside the principal strip (|M| < π). exp rounds by 32 eps (1 + |M|)² e^|M| as above, log's
    # condition is at most |exp(−M)|·cond(V), and its own roundings are as many again.
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


# --- rotors


def random_rotors(shape, seed=1):
    """Attitudes over the whole double cover."""
    return ph.Rotor.random(shape, seed)


def random_values(grades, shape, seed=2):
    return ph_value(np.random.default_rng(seed).standard_normal((*shape, 8)), grades)


PAIRS_OF_SHAPES = [
    ((), ()),
    ((1,), ()),
    ((), (1,)),
    ((3, 1, 2), ()),
    ((3, 1, 2), (4, 1)),
    ((3, 1, 2), (3, 1, 2)),
]


@pytest.mark.parametrize("shape", SHAPES)
def test_rotors_are_unit(shape):
    for R in (
        random_rotors(shape),
        ph.Rotor.identity(shape),
        ph.Rotor.from_rotation_vector(np.random.default_rng(3).standard_normal((*shape, 3))),
        ph.Rotor.from_components(1e200 * np.random.default_rng(4).standard_normal((*shape, 4))),
        random_rotors(shape) * random_rotors(shape, 5),
    ):
        assert R.shape == shape
        assert isinstance(R, ph.Rotor)
        assert R.grades == (0, 2)
        assert np.all(abs(magnitude(R) - 1) <= 6 * EPS)
        assert close(R * ~R, 1, 8)
        assert same(R.inverse(), ~R)


def test_a_long_product_of_rotors_drifts_by_its_roundings():
    R, step, count = (
        ph.Rotor.identity(),
        ph.Rotor.from_plane_angle(ph.bivector([1.0, 2.0, -2.0]), 0.1),
        10_000,
    )
    for _ in range(count):
        R = R * step
    # Each product of unit rotors sums four terms, and the step's own norm is off by at most 2 eps: 4 eps.
    assert abs(magnitude(R) - 1) <= 4 * count * EPS
    exact = ph.Rotor.from_plane_angle(ph.bivector([1.0, 2.0, -2.0]), 0.1 * count)
    assert close(R, exact, 4 * count)
    # What acts on others acts as a unit rotor all the same.
    assert abs(magnitude(R(e1)) - 1) <= 16 * EPS


@pytest.mark.parametrize(("left", "right"), PAIRS_OF_SHAPES)
@pytest.mark.parametrize("grades", GRADE_SETS)
def test_rotor_acts_on_any_grade_as_R_X_reverse_R(grades, left, right):
    R, X = random_rotors(left), random_values(grades, right)
    turned = R(X)
    assert turned.grades == X.grades
    assert turned.shape == np.broadcast_shapes(left, right)
    # Two products of four terms a component either way: 16 roundings each.
    assert close(turned, R * X * ~R, 32, magnitude(X).max(initial=0))
    assert same(R.apply(X), turned)


@pytest.mark.parametrize(("left", "right"), PAIRS_OF_SHAPES)
def test_composition_turns_by_the_right_one_first(left, right):
    S, R, X = random_rotors(left), random_rotors(right, 6), random_values((0, 1, 2, 3), ())
    SR = S * R
    assert isinstance(SR, ph.Rotor)
    assert SR.shape == np.broadcast_shapes(left, right)
    assert close(SR(X), S(R(X)), 64, magnitude(X))


@pytest.mark.parametrize("shape", SHAPES)
def test_matrices_are_a_homomorphism(shape):
    S, R, x = random_rotors(shape), random_rotors(shape, 7), random_values((1,), shape)
    assert S.to_matrix().shape == (*shape, 3, 3)
    product = S.to_matrix() @ R.to_matrix()
    assert np.all(abs((S * R).to_matrix() - product) <= 32 * EPS)
    turned = np.einsum("...ij,...j->...i", R.to_matrix(), x.components)
    assert np.all(abs(R(x).components - turned) <= 32 * EPS * magnitude(x)[..., None])
    assert np.all(abs((~R).to_matrix() - R.to_matrix().swapaxes(-1, -2)) <= 8 * EPS)


@pytest.mark.parametrize("shape", SHAPES)
def test_conversions_return_to_the_rotor(shape):
    R = random_rotors(shape, 8)
    positive = ph.Rotor.from_components(R.components * np.sign(R.components[..., :1]))
    for back in (
        ph.Rotor.from_quaternion(R.to_quaternion(order="wxyz"), order="wxyz"),
        ph.Rotor.from_quaternion(R.to_quaternion(order="xyzw"), order="xyzw"),
        ph.Rotor.from_components(R.components),
        ph.Rotor.from_plane_angle(*R.plane_angle()),
        R.log().exp(),
    ):
        assert back.shape == shape
        assert close(back, R, 16)
    for back in (
        ph.Rotor.from_matrix(R.to_matrix()),
        ph.Rotor.from_rotation_vector(R.to_rotation_vector()),
    ):
        assert back.shape == shape
        assert close(back, positive, 32)


@pytest.mark.parametrize("shape", SHAPES)
def test_scipy_agrees(shape):
    R, x = random_rotors(shape, 9), random_values((1,), (), 10)
    flat = ph.Rotor.from_components(R.components.reshape(-1, 4))
    scipys = flat.to_scipy()
    assert np.all(abs(scipys.as_matrix() - flat.to_matrix()) <= 16 * EPS)
    turned = scipys.apply(np.array(x.components))  # SciPy takes no read-only arrays
    assert np.all(abs(turned - flat(x).components) <= 32 * EPS * magnitude(x))
    assert np.all(abs(scipys.as_rotvec() - flat.to_rotation_vector()) <= 32 * EPS * np.pi)
    assert close(ph.Rotor.from_scipy(scipys), flat, 4)
    first, second = flat[0], ph.Rotor.random((), 11)
    composed = (second.to_scipy() * first.to_scipy()).as_matrix()
    assert np.all(abs((second * first).to_matrix() - composed) <= 32 * EPS)


# A quarter turn about z takes x to y: the sense, not just the round trip.
QUARTER = np.sqrt(0.5)
QUARTER_TURNS = {
    "plane and angle": lambda: ph.Rotor.from_plane_angle(e12, np.pi / 2),
    "exp": lambda: (-np.pi / 4 * e12).exp(),
    "wxyz": lambda: ph.Rotor.from_quaternion([QUARTER, 0, 0, QUARTER], order="wxyz"),
    "xyzw": lambda: ph.Rotor.from_quaternion([0, 0, QUARTER, QUARTER], order="xyzw"),
    "components": lambda: ph.Rotor.from_components([QUARTER, 0, 0, -QUARTER]),
    "matrix": lambda: ph.Rotor.from_matrix([[0, -1, 0], [1, 0, 0], [0, 0, 1]]),
    "vectors": lambda: ph.Rotor.from_vectors(3 * e1, 0.1 * e2),
    "rotation vector": lambda: ph.Rotor.from_rotation_vector([0, 0, np.pi / 2]),
    "rotation vector as a vector": lambda: ph.Rotor.from_rotation_vector(np.pi / 2 * e3),
    "scipy": lambda: ph.Rotor.from_scipy(Rotation.from_euler("z", 90, degrees=True)),
    "half of a half turn": lambda: ph.Rotor.from_plane_angle(e12, np.pi).sqrt(),
    "power": lambda: ph.Rotor.from_plane_angle(e12, np.pi / 6) ** 3,
}


@pytest.mark.parametrize("name", QUARTER_TURNS)
def test_a_quarter_turn_about_z_takes_x_to_y(name):
    R = QUARTER_TURNS[name]()
    assert close(R(e1), e2, 8)
    assert close(R(e2), -e1, 8)
    assert close(R(e3), e3, 8)
    assert np.all(abs(R.to_matrix() - [[0, -1, 0], [1, 0, 0], [0, 0, 1]]) <= 8 * EPS)
    assert np.all(abs(R.to_rotation_vector() - [0, 0, np.pi / 2]) <= 8 * EPS)
    assert np.all(abs(R.to_quaternion(order="wxyz") - [QUARTER, 0, 0, QUARTER]) <= 8 * EPS)
    assert np.all(abs(R.to_quaternion(order="xyzw") - [0, 0, QUARTER, QUARTER]) <= 8 * EPS)
    assert np.all(abs(R.to_scipy().apply([1, 0, 0]) - [0, 1, 0]) <= 8 * EPS)
    plane, angle = R.plane_angle()
    assert close(plane, e12, 8)
    assert abs(angle - np.pi / 2) <= 8 * EPS


def test_turns_about_the_other_axes_and_their_order():
    about_x = ph.Rotor.from_quaternion([QUARTER, QUARTER, 0, 0], order="wxyz")
    about_y = ph.Rotor.from_quaternion([QUARTER, 0, QUARTER, 0], order="wxyz")
    assert close(about_x(e2), e3, 8)
    assert close(about_y(e3), e1, 8)
    # First about x, then about y: e2 -> e3 -> e1.
    assert close((about_y * about_x)(e2), e1, 16)
    assert close((about_x * about_y)(e2), e3, 16)


@pytest.mark.parametrize("order", ["wzyx", "WXYZ", "", None, 4, ("w", "x", "y", "z"), "hamilton"])
def test_bad_quaternion_orders_are_errors(order):
    with pytest.raises(ValueError, match="order must be"):
        ph.Rotor.from_quaternion([1, 0, 0, 0], order=order)
    with pytest.raises(ValueError, match="order must be"):
        ph.Rotor.identity().to_quaternion(order=order)


def test_the_quaternion_order_must_be_said():
    with pytest.raises(TypeError, match="order"):
        ph.Rotor.from_quaternion([1, 0, 0, 0])
    with pytest.raises(TypeError, match="order"):
        ph.Rotor.identity().to_quaternion()


# --- rotors at the ends: near 0, π, 2π


@given(directions, angles)
@example(np.array([0.0, 0.0, 1.0]), 2 * np.pi)
@example(np.array([1.0, 0.0, 0.0]), np.pi)
def test_plane_and_angle_over_the_double_cover(n, angle):
    R = ph.Rotor.from_plane_angle(ph.bivector(n), angle)
    # Sine, cosine and three products: the half-angle's rounding is eps/2 · |θ|/2.
    assert close(R, np.cos(angle / 2) - np.sin(angle / 2) * ph.bivector(n), 4)
    plane, theta = R.plane_angle()
    assert 0 <= theta <= 2 * np.pi
    assert abs(magnitude(plane) - 1) <= 4 * EPS
    assert close(ph.Rotor.from_plane_angle(plane, theta), R, 8)
    if 1e-15 < angle < 2 * np.pi - 1e-14:
        # sin(θ/2) is what holds the plane; its rounding relative to it.
        assert abs(theta - angle) <= 8 * EPS
        assert close(plane, ph.bivector(n), 16)


@given(directions, angles)
def test_log_over_the_double_cover(n, angle):
    R = ph.Rotor.from_plane_angle(ph.bivector(n), angle)
    B = R.log()
    assert B.grades == (2,)
    assert magnitude(B) <= np.pi * (1 + 2 * EPS)
    assert close(B.exp(), R, 16)
    if abs(angle) < 2 * np.pi - 1e-12:
        assert close(B, -angle / 2 * ph.bivector(n), 16, np.pi)


def test_log_of_one_and_minus_one():
    one = ph.Rotor.identity()
    assert one.log() == 0
    assert (-one).log() == np.pi * e12
    assert close((-one).log().exp(), -one, 4)
    plane, angle = one.plane_angle()
    assert plane == e12
    assert angle == 0
    plane, angle = (-one).plane_angle()
    assert plane == e12
    assert angle == 2 * np.pi
    assert isinstance(-one, ph.Rotor)


@pytest.mark.parametrize("exponent", [*range(-320, -1, 20), -8, -4, -2])
def test_tiny_turns_keep_their_relative_accuracy(exponent):
    v = 10.0**exponent * np.array([0.6, 0.0, -0.8])
    R = ph.Rotor.from_rotation_vector(v)
    # Halving a subnormal rounds it to the spacing 5e-324.
    allowed = 8 * EPS * np.abs(v) + 4 * 5e-324
    assert np.all(abs(R.to_rotation_vector() - v) <= allowed)
    assert np.all(abs(R.log().components + v / 2) <= allowed)


@given(directions, st.floats(0, 2 * np.pi))
def test_rotation_vectors(n, angle):
    R = ph.Rotor.from_rotation_vector(angle * n)
    assert close(R, ph.Rotor.from_plane_angle(ph.bivector(n), angle), 16)
    back = R.to_rotation_vector()
    assert np.linalg.norm(back) <= np.pi * (1 + 2 * EPS)
    # The shorter way round: the angle, or 2π less about the same axis.
    shorter = angle if angle <= np.pi else angle - 2 * np.pi
    either = [
        np.linalg.norm(back - s * shorter * n) for s in ((1, -1) if abs(angle - np.pi) < 1e-14 else (1,))
    ]
    assert min(either) <= 32 * EPS * np.pi


@given(directions, angles)
def test_from_matrix_also_near_half_turns(n, angle):
    R = ph.Rotor.from_plane_angle(ph.bivector(n), angle)
    back = ph.Rotor.from_matrix(R.to_matrix())
    assert back.components[0] >= 0
    assert min(magnitude(back - R), magnitude(back + R)) <= 16 * EPS
    assert np.all(abs(back.to_matrix() - R.to_matrix()) <= 32 * EPS)


@pytest.mark.parametrize("diagonal", [(1, -1, -1), (-1, 1, -1), (-1, -1, 1), (1, 1, 1)])
def test_from_matrix_of_exact_half_turns(diagonal):
    R = ph.Rotor.from_matrix(np.diag(diagonal))
    assert np.array_equal(R.to_matrix(), np.diag(diagonal))


def test_from_matrix_takes_the_nearest_rotation():
    R, noise = random_rotors((20,), 12), np.random.default_rng(13).uniform(-1, 1, (20, 3, 3))
    m = R.to_matrix() + 1e-5 * noise
    u, _, vt = np.linalg.svd(m)  # the orthogonal polar factor
    assert np.all(abs(ph.Rotor.from_matrix(m).to_matrix() - u @ vt) <= 32 * EPS)


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        (-np.eye(3), "determinant −1"),
        (np.diag([1.0, 1.0, -1.0]), "determinant −1"),
        (1.001 * np.eye(3), "not a rotation matrix"),
        (np.zeros((3, 3)), "not a rotation matrix"),
        (np.full((3, 3), np.nan), "NaN or infinite"),
        (np.full((3, 3), 1e200), "not a rotation matrix"),
    ],
)
def test_from_matrix_refuses_what_is_no_rotation(bad, message):
    with pytest.raises(ValueError, match=message):
        ph.Rotor.from_matrix(bad)
    batch = np.broadcast_to(np.eye(3), (2, 2, 3, 3)).copy()
    batch[1, 0] = bad
    with pytest.raises(ValueError, match=rf"at index \(1, 0\): .*{message}"):
        ph.Rotor.from_matrix(batch)


@pytest.mark.parametrize("shape", [(3,), (9,), (2, 2), (3, 4), (4, 3), ()])
def test_from_matrix_refuses_other_shapes(shape):
    with pytest.raises(ValueError, match=r"shape \(\.\.\., 3, 3\)"):
        ph.Rotor.from_matrix(np.ones(shape))


@given(directions, directions, st.floats(1e-3, 1e3))
def test_from_vectors(a, b, length):
    R = ph.Rotor.from_vectors(ph.vector(a), ph.vector(length * b))
    assert close(R(ph.vector(a)), ph.vector(b), 16)
    # The short way, in the plane of both: the normal stays.
    assert R.components[0] >= -4 * EPS
    normal = np.cross(a, b)
    if np.linalg.norm(normal) > 1e-3:
        assert close(R(ph.vector(normal)), ph.vector(normal), 32)


@given(directions, directions, st.integers(-17, -1))
def test_from_vectors_nearly_opposite(a, other, exponent):
    # b is −a, moved a little towards another direction.
    b = unit(-a + 10.0**exponent * other)
    R = ph.Rotor.from_vectors(ph.vector(a), ph.vector(b))
    assert abs(magnitude(R) - 1) <= 4 * EPS
    assert close(R(ph.vector(a)), ph.vector(b), 16)


@given(directions)
def test_from_vectors_exactly_opposite_and_equal(a):
    R = ph.Rotor.from_vectors(ph.vector(a), ph.vector(-a))
    assert close(R(ph.vector(a)), ph.vector(-a), 16)
    assert close(ph.Rotor.from_vectors(ph.vector(a), ph.vector(a)), 1, 4)


@pytest.mark.parametrize("scale", [5e-324, 1e-310, 1e-200, 1e200, 1e308])
def test_constructors_ignore_size_at_the_ends_of_the_range(scale):
    assert close(ph.Rotor.from_vectors(scale * e1, scale * e2), ph.Rotor.from_vectors(e1, e2), 4)
    assert close(
        ph.Rotor.from_plane_angle(ph.bivector([0, 0, scale]), 1.0), ph.Rotor.from_plane_angle(e12, 1.0), 4
    )
    assert close(ph.Rotor.from_components([scale, 0, 0, -scale]), (1 - e12) / np.sqrt(2), 4)
    assert close(ph.Rotor.from_quaternion([scale, 0, 0, scale], order="wxyz"), (1 - e12) / np.sqrt(2), 4)


@pytest.mark.parametrize("bad", [0.0, np.nan, np.inf])
def test_constructors_refuse_what_has_no_direction(bad):
    four, three = np.ones((2, 4)), np.ones((2, 3))
    four[1], three[1] = bad, bad
    ones = ph.vector(np.ones((2, 3)))
    for make in (
        lambda: ph.Rotor.from_components(four),
        lambda: ph.Rotor.from_quaternion(four, order="xyzw"),
        lambda: ph.Rotor.from_plane_angle(ph.bivector(three), 1.0),
        lambda: ph.Rotor.from_vectors(ph.vector(three), ones),
        lambda: ph.Rotor.from_vectors(ones, ph.vector(three)),
    ):
        with pytest.raises(ValueError, match=r"at index \(1,\): "):
            make()


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_angles_must_be_finite(bad):
    for make in (
        lambda: ph.Rotor.from_plane_angle(e12, np.array([1.0, bad])),
        lambda: ph.Rotor.from_rotation_vector([[1.0, 0, 0], [0, bad, 0]]),
    ):
        with pytest.raises(ValueError, match=r"at index \(1,\): a component is NaN or infinite"):
            make()


@pytest.mark.parametrize("make", [
    lambda: ph.Rotor.from_plane_angle(e3, 1.0),
    lambda: ph.Rotor.from_plane_angle(1 + e1 * e2, 1.0),
    lambda: ph.Rotor.from_plane_angle([0, 0, 1], 1.0),
    lambda: ph.Rotor.from_plane_angle(e12, "1"),
    lambda: ph.Rotor.from_vectors(e12, e1),
    lambda: ph.Rotor.from_vectors(e1, [1, 0, 0]),
    lambda: ph.Rotor.from_rotation_vector(e12),
    lambda: ph.Rotor.from_components([1j, 0, 0, 0]),
    lambda: ph.Rotor.from_matrix([["a"] * 3] * 3),
    lambda: ph.Rotor.identity()([1, 0, 0]) and None,
    lambda: ph.Rotor.identity()("x"),
    lambda: ph.Rotor.identity() ** "2",
])  # fmt: skip
def test_wrong_kinds_are_type_errors(make):
    with pytest.raises(TypeError):
        make()


@pytest.mark.parametrize(("left", "right"), PAIRS_OF_SHAPES)
def test_constructors_broadcast(left, right):
    batch = np.broadcast_shapes(left, right)
    rng = np.random.default_rng(14)
    a, b, angle = rng.standard_normal((*left, 3)), rng.standard_normal((*right, 3)), rng.uniform(-6, 6, right)
    from_vectors = ph.Rotor.from_vectors(ph.vector(a), ph.vector(b))
    from_plane = ph.Rotor.from_plane_angle(ph.bivector(a), angle)
    assert from_vectors.shape == from_plane.shape == batch
    a_all, b_all = np.broadcast_to(a, (*batch, 3)), np.broadcast_to(b, (*batch, 3))
    angle_all = np.broadcast_to(angle, batch)
    for index in np.ndindex(*batch):
        one = ph.Rotor.from_vectors(ph.vector(a_all[index]), ph.vector(b_all[index]))
        assert from_vectors[index] == one
        assert from_plane[index] == ph.Rotor.from_plane_angle(ph.bivector(a_all[index]), angle_all[index])


# --- powers and kinds


@given(rotors, st.floats(-3, 3), st.floats(-3, 3))
def test_powers_of_rotors(R, s, t):
    # A power is exp of a multiple of log R, at most 6π: its rounding moves the rotor by 6π · 4 eps.
    assert close(R**s * R**t, R ** (s + t), 128)
    assert isinstance(R**s, ph.Rotor)


@given(rotors)
def test_special_powers_of_rotors(R):
    assert same(R**0, 1)
    assert close(R**1, R, 16)
    assert close(R**-1, ~R, 16)
    assert close(R**2, R * R, 32)
    assert close(R.sqrt() * R.sqrt(), R, 32)
    assert close(R**0.5, R.sqrt(), 4)


def test_powers_over_batches():
    R = random_rotors((3, 1, 2), 15)
    assert (R ** np.linspace(0, 1, 4)[:, None]).shape == (3, 4, 2)
    assert (random_rotors((), 16) ** np.arange(5)).shape == (5,)
    one = ph.Rotor.identity((3,))
    assert same(one**2, one)


def test_what_stays_a_rotor_and_what_does_not():
    R, S = random_rotors((), 17), random_rotors((), 18)
    for value in (R * S, ~R, -R, R.inverse(), R**2, R.sqrt(), R.normalized(), R.grade_involution(), R / S):
        assert isinstance(value, ph.Rotor)
    for value in (2 * R, R * 2, R + S, R - S, R / 2, R * e1, R.log(), R.dual(), R.grade(2), R.exp(), R(e1)):
        assert type(value) is ph.Multivector
    assert isinstance(R(S), ph.Rotor)


def test_random_rotors_are_uniform_and_repeatable():
    R = ph.Rotor.random((20_000,), 19)
    assert same(R, ph.Rotor.random(20_000, np.random.default_rng(19)))
    # Uniform on the sphere S³: components have mean 0, variance 1/4, and the mean of 20000 a deviation
    # of 0.5/√20000 = 0.0035; five of those.
    assert np.all(abs(R.components.mean(axis=0)) < 5 * 0.0035)
    covariance = R.components.T @ R.components / 20_000
    assert np.all(abs(covariance - np.eye(4) / 4) < 5 * 0.0035)
    # Rotated vectors cover the sphere: mean 0, variance 1/3 in each direction.
    assert np.all(abs(R(e1).components.mean(axis=0)) < 5 * 0.0041)
