"""Complex coefficients: products, functions, norms, printing and storage."""

import copy
import json
import pickle
from fractions import Fraction

import numpy as np
import pytest
import sympy
from scipy.linalg import expm

import polhode as ph
from polhode import I, e1, e2, e3
from samples import EPS, SHAPES, same

SIGNATURES = [(3, 0, 0), (1, 0, 0), (2, 0, 0), (1, 3, 0), (3, 0, 1), (4, 1, 0)]
PRODUCTS = (
    *("geometric_product", "wedge", "dot", "commutator", "left_contraction", "right_contraction"),
    *("scalar_product", "vee"),
)


def whole(algebra, shape=(), seed=1):
    return algebra.multivector(
        np.random.default_rng(seed).integers(-4, 5, (*shape, algebra.size)).astype(float)
    )


def pair(algebra, shape=(), seed=1):
    """Return real values X, Y and the complex value X + iY; of whole numbers, so that products are exact."""
    X, Y = whole(algebra, shape, seed), whole(algebra, shape, seed + 1)
    return X, Y, X + 1j * Y


def regular(algebra, shape=(), seed=1):
    """A complex value near 1, which has an inverse."""
    rng = np.random.default_rng(seed)
    c = rng.uniform(-0.5, 0.5, (2, *shape, algebra.size)) / algebra.size
    return algebra.multivector(c[0] + 1j * c[1]) + 1


def matrices(M):
    """The matrices of ``X ↦ M X`` over all components: a peer for functions of M."""
    basis = M.algebra.multivector(np.eye(M.algebra.size))
    return np.stack([(M * e).dense() for e in basis], axis=-1)


# --- construction


def test_constructors_take_complex_numbers():
    for given in ([1 + 2j, 0, 1j], np.array([1 + 2j, 0, 1j])):
        a = ph.vector(given)
        assert a.dtype == np.complex128
        assert a.grades == (1,)
        assert same(a, e1 + 2j * e1 + 1j * e3)
    single = ph.vector(np.array([1 + 2j, 0, 1j], dtype=np.complex64))
    assert single.dtype == np.complex64
    assert (2 * single).dtype == (2j * single).dtype == (single / 3).dtype == np.complex64
    assert (single * single).dtype == single.dual().dtype == single.inverse().dtype == np.complex64
    assert (single * e1).dtype == np.complex128
    assert ph.vector(np.ones(3, np.float32)).astype(np.complex64).dtype == np.complex64
    assert (1j * ph.vector(np.ones(3, np.float32))).dtype == np.complex64
    assert ph.vector([1, 2, 3], dtype=complex).dtype == np.complex128
    assert ph.scalar(1j) == 1j
    assert ph.trivector([1j, 2]).shape == (2,)
    view = np.array([1j, 2, 3])
    assert ph.vector(view, copy=False)["e1"] == 1j
    assert ph.vector(view).components.flags.writeable


@pytest.mark.parametrize("scale", [2j, np.complex128(2j), np.array(2j), np.complex64(2j)])
def test_complex_numbers_multiply_from_both_sides(scale):
    assert same(scale * e1, ph.vector([2j, 0, 0]))
    assert same(e1 * scale, scale * e1)
    assert same((e1 + scale).components, [2j, 1, 0, 0])
    assert same(scale - e1, -(e1 - scale))
    assert same(e1 / scale, -0.5j * e1)
    assert same(1 / (scale * e1), -0.5j * e1)
    assert same(np.array([1j, 2j]) * e1, ph.vector([[1j, 0, 0], [2j, 0, 0]]))


# --- products are bilinear over complex numbers


@pytest.mark.parametrize("signature", SIGNATURES)
@pytest.mark.parametrize("name", PRODUCTS)
@pytest.mark.parametrize("shape", SHAPES)
def test_products(signature, name, shape):
    A = ph.algebra(*signature)
    (X, Y, M), (P, Q, N) = pair(A, shape), pair(A, seed=5)

    def product(left, right):
        return getattr(left, name)(right)

    found = product(M, N)
    assert same(found.real, product(X, P) - product(Y, Q))
    assert same(found.imag, product(X, Q) + product(Y, P))
    assert same(product(M, P), product(X, P) + 1j * product(Y, P))
    assert found.shape == shape


@pytest.mark.parametrize("signature", SIGNATURES)
def test_linear_operations_act_on_both_parts(signature):
    A = ph.algebra(*signature)
    X, Y, M = pair(A, (2, 3))
    for f in (
        *(lambda m: ~m, lambda m: -m, lambda m: m.grade_involution(), lambda m: m.clifford_conjugate()),
        *(lambda m: m.grade(0, 1), lambda m: m[1, ::2], lambda m: m.reshape(6), lambda m: m.sum(axis=0)),
        *(lambda m: m.right_complement(), lambda m: m.left_complement(), lambda m: m.mean(0)),
        *(lambda m: ph.stack([m, m]), lambda m: ph.concatenate([m, 2 * m])),
    ):
        assert same(f(M), f(X) + 1j * f(Y))
    if not signature[2]:
        assert same(M.dual(), X.dual() + 1j * Y.dual())
        assert same(M.dual().undual(), M)
    assert same(M.dense(), X.dense() + 1j * Y.dense())
    assert same(M["e1"], X["e1"] + 1j * Y["e1"])
    assert same(np.asarray(M.grade(1)), M.grade(1).components)


@pytest.mark.parametrize(
    ("use", "ours"),
    [
        *((f, "~R") for f in (lambda R: R.conj(), np.conj, np.conjugate)),
        (lambda R: R.real, r'R\["1"\]'),
        (lambda R: R.imag, r"grade\(2\), or .*"),
    ],
)
def test_rotors_have_no_parts_which_quaternions_name_alike(use, ours):
    with pytest.raises(AttributeError, match=rf"; write {ours}$"):
        use(ph.Rotor.random(rng=1))


def test_conjugates_and_parts():
    a = ph.vector([1 + 2j, 3, -1j]) + (2 - 1j) * I
    assert same(a.conj(), a.real - 1j * a.imag)
    assert same(np.conj(a), a.conj())
    assert a.real.dtype == a.imag.dtype == np.float64
    # The reverse does not conjugate; both together are the adjoint of the matrices.
    assert same((~a)["e1"], 1 + 2j)
    assert same(~a.conj(), (~a).conj())
    assert same(e1.conj(), e1)
    assert same(e1.real, e1)
    assert same(e1.imag, 0)
    assert e1.imag.grades == (1,)
    x, t = sympy.Symbol("x"), sympy.Symbol("t", real=True)
    b = ph.vector([x, t + sympy.I, 0])
    assert same(b.conj(), ph.vector([sympy.conjugate(x), t - sympy.I, 0]))
    assert same(b.imag, ph.vector([sympy.im(x), 1, 0]))
    third = ph.vector([Fraction(1, 3), 0, 1])
    assert same(third.conj(), third)
    assert same(third.imag, 0)
    jnp = pytest.importorskip("jax.numpy")
    traced = ph.vector(jnp.ones(3))
    assert same(traced.real.components, 1)
    assert same(traced.imag.components, 0)


# --- functions


@pytest.mark.parametrize("signature", SIGNATURES)
@pytest.mark.parametrize("shape", SHAPES)
def test_inverses(signature, shape):
    M = regular(ph.algebra(*signature), shape)
    for inverse in (M.inverse(), M**-1, 1 / M):
        # |M - 1| < 1, a few dozen roundings of a product over the whole basis.
        assert np.all((M * inverse).is_close(1, rtol=1024 * EPS))
        assert np.all((inverse * M).is_close(1, rtol=1024 * EPS))
    assert np.all((M / M).is_close(1, rtol=1024 * EPS))


def test_inverses_of_complex_vectors():
    a = ph.vector([1, 2j, 0])
    assert same(a * a, -3)
    assert (a.inverse() + a / 3).norm() <= 4 * EPS
    # 1 + i e1e2 and the isotropic e1 + i e2 are zero divisors.
    for singular in (e1 + 1j * e2, 1 + 1j * (e1 ^ e2), ph.vector([0j, 0, 0])):
        with pytest.raises(ValueError, match="no inverse"):
            singular.inverse()
    with pytest.raises(ValueError, match=r"\(1,\).*no inverse"):
        ph.vector([[1, 2j, 0], [1, 1j, 0]]).inverse()


@pytest.mark.parametrize("signature", SIGNATURES)
@pytest.mark.parametrize("size", [1e-9, 0.3, 1.0, 8.0])
def test_exponentials_agree_with_those_of_matrices(signature, size):
    A = ph.algebra(*signature)
    rng = np.random.default_rng(3)
    c = rng.standard_normal((2, 4, A.size))
    M = A.multivector(c[0] + 1j * c[1])
    M = M * (size / abs(matrices(M)).sum(axis=-1).max(axis=-1))
    for part in (M, M.grade(1), M.grade(0, 2) if A.dimension > 1 else M):
        for found, exact in zip(part.exp(), expm(matrices(part)), strict=True):
            # Both square up to five times, which multiplies rounding by up to e^size of conditioning.
            bound = 512 * EPS * np.exp(size)
            assert np.max(abs(found.dense() - exact[:, 0])) <= bound


def test_exponentials_of_complex_planes_are_not_rotors():
    B = (0.3 + 0.4j) * (e1 ^ e2)
    V = B.exp()
    assert type(V) is ph.Multivector
    z = 0.3 + 0.4j
    assert abs(V["1"] - np.cos(z)) <= 4 * EPS
    assert abs(V["e12"] - np.sin(z)) <= 4 * EPS
    # A versor: it acts, by a rotation by a complex angle.
    assert V(e1).is_close(np.cos(2 * z) * e1 - np.sin(2 * z) * e2, rtol=32 * EPS)
    assert same(e3, V(e3).map(np.real)) or V(e3).is_close(e3, rtol=32 * EPS)
    null = (1j * e1 + e2) ^ e3
    assert null.exp().is_close(1 + null, rtol=4 * EPS)


def test_series_of_complex_values():
    M = 0.5 * regular(ph.algebra(3), (2,))
    plus, minus = (1j * M).exp(), (-1j * M).exp()
    assert np.all(M.cos().is_close((plus + minus) / 2, rtol=64 * EPS))
    assert np.all(M.sin().is_close((plus - minus) / 2j, rtol=64 * EPS))
    assert np.all(M.tan().is_close(M.sin() / M.cos(), rtol=64 * EPS))
    assert np.all(M.cosh().is_close((M.exp() + (-M).exp()) / 2, rtol=64 * EPS))
    assert np.all(M.tanh().is_close(M.sinh() / M.cosh(), rtol=64 * EPS))
    assert M.astype(np.complex64).sin().dtype == np.complex64
    s = ph.scalar(0.3 + 0.4j)
    assert abs(complex(s.sin()) - np.sin(0.3 + 0.4j)) <= 4 * EPS
    B = 1j * (e1 ^ e2)
    assert same(B.outer_exp(), 1 + B)


def test_functions_without_complex_values_say_so():
    a = ph.vector([1j, 2, 0]) + 1
    for name in ("log", "sqrt"):
        with pytest.raises(TypeError, match=f"{name} of complex coefficients is not available.*real"):
            getattr(a, name)()
    for call in (lambda: (1j * e1).join(e2), lambda: (1j * e1).factor()):
        with pytest.raises(TypeError, match="needs NumPy floats, got"):
            call()


def test_projections():
    B = ph.bivector([1j, 2, 0])
    X = ph.vector([1 + 1j, 2, 3])
    parallel = X.project(B)
    assert (parallel + X.reject(B)).is_close(X, rtol=16 * EPS)
    assert np.max(abs(parallel.wedge(B).components)) <= 32 * EPS
    assert X.reflect(e1).is_close(-e1 * X * e1, rtol=8 * EPS)
    frame = [e1 + 1j * e3, e2 + e1]
    for i, up in enumerate(ph.reciprocal_frame(frame)):
        for j, b in enumerate(frame):
            assert abs(complex(up.scalar_product(b)) - (i == j)) <= 16 * EPS


# --- norms and comparison


@pytest.mark.parametrize("signature", SIGNATURES)
def test_norms_are_those_of_magnitudes(signature):
    A = ph.algebra(*signature)
    M = pair(A, (5,))[2]
    hermitian = (~M.conj()).scalar_product(M)
    assert same(hermitian.imag, 0)
    assert same(M.norm_squared(), hermitian.real["1"])
    assert M.norm_squared().dtype == np.float64
    # Magnitudes, squares and their sum: a dozen roundings of the sum of squares, then half as many.
    size = np.sum(abs(M.dense()) ** 2, axis=-1)
    assert np.all(abs(M.norm() ** 2 - abs(M.norm_squared())) <= 32 * EPS * size)
    assert same(abs(M), M.norm())


def test_infinities_follow_ieee_as_floats_do():
    a = ph.vector([complex(np.inf, 0), 0, 0])
    assert np.isinf((2j * a)["e1"]) or np.isnan((2j * a)["e1"])
    assert not np.isfinite((a * e1)["1"])
    for f in ("exp", "inverse", "cos"):
        with pytest.raises(ValueError, match="NaN or infinite"):
            getattr(a, f)()
    with pytest.raises(ValueError, match="beyond the range"):
        ph.vector([1000, 1j, 0]).exp()


def test_norms_of_large_and_small_values():
    a = ph.vector([3e200j, 4e200, 0])
    assert abs(a.norm() / 5e200 - 1) <= 4 * EPS
    assert a.normalized().is_close(ph.vector([0.6j, 0.8, 0]), rtol=4 * EPS)
    assert ph.vector([3e-200j, 4e-200, 0]).norm() == pytest.approx(5e-200, rel=4 * EPS)
    assert same((1j * e1).norm(), 1)
    with pytest.raises(ValueError, match="no direction"):
        ph.vector([0j, 0, 0]).normalized()


def test_equality():
    a = ph.vector([1 + 2j, 0, 1j])
    assert a == ph.vector([1 + 2j, 0, 1j])
    assert a != a.conj()
    assert a.astype(complex) == a
    assert (e1 + 0j) == e1
    assert e1 != 1j * e1
    assert a.is_close(a * (1 + 1e-12j))
    assert not a.is_close(a * (1 + 1e-6j))
    assert (1e-12j * e1).is_close(0, atol=1e-11)
    assert ph.scalar(1j) == 1j != ph.scalar(1)
    with pytest.raises(TypeError, match="belong to different"):
        a + ph.algebra(2).scalar(1j)


# --- conversion, printing, storage


def test_conversions_to_numbers():
    s = ph.scalar(1 + 2j)
    assert complex(s) == 1 + 2j
    assert complex(ph.scalar(2)) == 2
    with pytest.raises(TypeError, match=r"is complex; use complex\(value\)"):
        float(s)
    with pytest.raises(TypeError, match="only a single scalar converts to complex"):
        complex(e1)
    for dtype in (float, np.float32, object):
        with pytest.raises(TypeError, match=r"must be real, got complex128; take \.real"):
            s.astype(dtype)
    assert ph.vector([sympy.I, Fraction(1, 2), 0]).astype(complex) == 1j * e1 + 0.5 * e2


@pytest.mark.parametrize(
    ("value", "text", "latex"),
    [
        (ph.vector([1 + 2j, 0, 0]), "(1+2j) e1", r"$\left(1+2 i\right) e_{1}$"),
        (ph.vector([1j, -2j, 3 + 0j]), "1j e1 - 2j e2 + 3 e3", "$1 i e_{1} - 2 i e_{2} + 3 e_{3}$"),
        ((-1 - 0.5j) * I, "(-1-0.5j) I", r"$\left(-1-0.5 i\right) I$"),
        (ph.scalar(0j), "0", "$0$"),
        (ph.vector([-1 + 0j, 0, 0]), "-e1", "$-e_{1}$"),
        (ph.scalar(1e-5 + 1e20j), "(1e-05+1e+20j)", r"$\left(10^{-5}+10^{20} i\right)$"),
        (ph.vector([complex(np.nan, 1), 0, 0]), "(nan+1j) e1", None),
    ],
)
def test_printing(value, text, latex):
    assert repr(value) == str(value) == text
    if latex is not None:
        assert value._repr_latex_() == latex


def test_formats_and_batches():
    a = ph.vector([1 + 2j, 0, -1 / 3])
    assert f"{a:.3f}" == "(1.000+2.000j) e1 - 0.333 e3"
    with np.printoptions(precision=3):
        assert str(ph.vector([1j / 3, 0, 0])) == "0.333j e1"
    assert repr(ph.vector([[1j, 0, 0], [1, 0, 0]])) == "Multivector of shape (2,):\n[1j e1,\n e1]"


@pytest.mark.parametrize("dtype", [np.complex128, np.complex64])
@pytest.mark.parametrize("shape", SHAPES)
def test_storage(dtype, shape):
    for signature in ((3, 0, 0), (3, 0, 1)):
        M = pair(ph.algebra(*signature), shape)[2].astype(dtype) / 3
        for again in (
            pickle.loads(pickle.dumps(M)),
            copy.deepcopy(M),
            ph.from_dict(json.loads(json.dumps(ph.to_dict(M)))),
        ):
            assert same(again, M)
            assert again.dtype == dtype
            assert again.algebra is M.algebra
    fields = ph.to_dict(ph.scalar(1j))
    assert fields["components"] == [[0.0, 1.0]]
    with pytest.raises(ValueError, match=r"pairs \[re, im\]"):
        ph.from_dict({**fields, "components": [1, 2, 3]})


# --- beside other coefficients, rotors, matrices, formulas


def test_exact_and_foreign_coefficients_do_not_mix_with_complex_numbers():
    third = Fraction(1, 3) * e1
    for mix in (lambda: third * 1j, lambda: 1j * third, lambda: third + 1j * e1):
        with pytest.raises(TypeError, match=r"exact coefficients .* and complex numbers do not mix"):
            mix()
    jnp = pytest.importorskip("jax.numpy")
    with pytest.raises(TypeError, match="jax arrays and complex numbers do not mix"):
        1j * ph.vector(jnp.ones(3))


def test_rotors_are_real():
    R = ph.Rotor.random(rng=1)
    a = ph.vector([1 + 2j, 0, 1j])
    assert R(a).is_close(R(a.real) + 1j * R(a.imag), rtol=8 * EPS)
    assert type(1j * R) is type(R * 1j) is ph.Multivector
    assert (R * (1j * R)).is_close(1j * (R * R), rtol=8 * EPS)
    B = ph.bivector([1j, 0, 1])
    for call in (
        lambda: ph.Rotor.from_components([1j, 0, 0, 0]),
        lambda: ph.Rotor.from_plane_angle(B, 0.1),
        lambda: ph.Rotor.from_plane_angle(e1 ^ e2, 0.1j),
        lambda: ph.Rotor.from_vectors(a, e1),
        lambda: ph.Rotor.from_rotation_vector(a),
        lambda: ph.Rotor.from_multivector(1 + 0.1 * B),
        lambda: ph.Rotor.from_matrix(1j * np.eye(3)),
        lambda: R.astype(complex),
        lambda: R**0.5j,
        lambda: ph.LinearMap.from_function(lambda v: 1j * v),
        lambda: ph.State(R, B),
        lambda: ph.RigidTransform(R, a),
        lambda: ph.RigidTransform(R, [1j, 0, 0]).apply(a),
        lambda: ph.left_jacobian(a),
        lambda: ph.Rotor.from_axis_angle(a, 1.0),
        lambda: ph.Rotor.from_mrp(a),
        lambda: ph.align(ph.stack([a, e1]), ph.stack([e1, e2])),
        lambda: ph.formula("a·a").grad("a")(a=a),
        lambda: ph.torque.constant_body(B),
    ):
        with pytest.raises(TypeError, match=r"real"):
            call()


def test_pauli_matrices_need_real_coefficients():
    X, Y = whole(ph.algebra(3)), whole(ph.algebra(3), seed=2)
    assert same(ph.from_pauli(ph.to_pauli(X)), X)
    with pytest.raises(TypeError, match=r"real, got complex128; take \.real or \.imag"):
        ph.to_pauli(X + 1j * Y)
    with pytest.raises(TypeError, match="real"):
        ph.to_pauli(1j)
    # The adjoint matrix belongs to the reverse.
    assert same(ph.to_pauli(~X), np.conj(np.swapaxes(ph.to_pauli(X), -1, -2)))


def test_cross_products_and_axial_vectors():
    a, b = ph.vector([1j, 2, 0]), ph.vector([1, 1j, 3])
    assert same(ph.cross(a, b).components, np.cross(a.components, b.components))
    assert same(ph.axial(ph.from_axial(a)), a)


@pytest.mark.parametrize(
    "text",
    ["a b", "a∧b + a·b", "~(a b) / 2", "exp(B) a", "⟨a b c⟩", "a⁻¹ b", "F(a)∧b", "a×B", "dual(a)", "a²"],
)
@pytest.mark.parametrize("shape", SHAPES)
def test_formulas_agree_with_methods(text, shape):
    rng = np.random.default_rng(7)
    a, b, c = (ph.vector(rng.standard_normal((*shape, 3)) + 1j * rng.standard_normal(3)) for _ in range(3))
    B, F = 1j * (a ^ b), ph.LinearMap.from_matrix(rng.standard_normal((3, 3)))
    expected = {
        "a b": lambda: a * b,
        "a∧b + a·b": lambda: a * b,
        "~(a b) / 2": lambda: b * a / 2,
        "exp(B) a": lambda: B.exp() * a,
        "⟨a b c⟩": lambda: (a * b * c).grade(0),
        "a⁻¹ b": lambda: a.inverse() * b,
        "F(a)∧b": lambda: F(a) ^ b,
        "a×B": lambda: a.commutator(B),
        "dual(a)": lambda: a.dual(),
        "a²": lambda: a * a,
    }[text]()
    found = ph.evaluate(text, a=a, b=b, c=c, B=B, F=F)
    assert np.all(found.is_close(expected, rtol=1e-13, atol=1e-13))


def test_formulas_take_complex_numbers_and_equations():
    z = 0.5 + 2j
    assert ph.evaluate("z a", z=z, a=e1) == z * e1
    assert same(ph.evaluate("z a", z=np.array([1j, 2]), a=e1), np.array([1j, 2]) * e1)
    a = ph.vector([1j, 2, 0])
    assert ph.evaluate("a a = a²", a=a)
    assert not ph.evaluate("a a = 1", a=a)
    assert ph.evaluate("norm(a)", a=a) == a.norm()
    for text in ("sqrt(a b)", "log(a b)"):
        with pytest.raises(ValueError, match="complex coefficients"):
            ph.evaluate(text, a=a, b=e1 + e2)
