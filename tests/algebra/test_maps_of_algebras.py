"""Linear maps of any algebra: sums, products, outermorphisms, adjoints in the metric, SVD, polar form."""

import pickle
from math import comb

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.linalg import polar as scipy_polar

import polhode as ph
from polhode import e1, e2, e3
from samples import EPS, SHAPES, close, same

SIGNATURES = [
    (1, 0, 0),
    (2, 0, 0),
    (1, 1, 0),
    (0, 3, 0),
    (2, 1, 0),
    (4, 0, 0),
    (1, 3, 0),
    (3, 0, 1),
    (4, 1, 0),
]
EUCLIDEAN = [(2, 0, 0), (3, 0, 0), (4, 0, 0), (5, 0, 0)]
SPACETIME = ph.algebra(1, 3)
RNG = np.random.default_rng(5)


def whole_map(algebra, shape=(), grade=1, seed=1):
    size = comb(algebra.dimension, grade)
    matrix = np.random.default_rng(seed).integers(-3, 4, (*shape, size, size))
    return ph.LinearMap.from_matrix(matrix, grade, algebra=algebra)


def whole_value(algebra, shape=(), seed=2):
    return algebra.multivector(
        np.random.default_rng(seed).integers(-3, 4, (*shape, algebra.size)).astype(float)
    )


# --- outermorphisms, exact for whole numbers


@pytest.mark.parametrize("signature", SIGNATURES)
@pytest.mark.parametrize("shape", SHAPES)
def test_outermorphisms_respect_the_wedge(signature, shape):
    A = ph.algebra(*signature)
    F, X, Y = whole_map(A, shape), whole_value(A), whole_value(A, shape, seed=3)
    assert F.algebra is A
    assert same(F(X.wedge(Y)), F(X).wedge(F(Y)))
    assert same(F(X + Y), F(X) + F(Y))
    assert same(F(A.I), F.determinant * A.I)
    # LU rounds a determinant of at most 3ⁿ n! = 29,160 by a few dozen EPS of it.
    assert np.all(abs(F.determinant - np.linalg.det(F.matrix)) <= 64 * EPS * 29_160)
    assert F(X).shape == shape


@pytest.mark.parametrize("signature", [*SIGNATURES, (3, 0, 0)])
def test_the_outermorphism_matrix_acts_on_all_components(signature):
    A = ph.algebra(*signature)
    F, G, X = whole_map(A), whole_map(A, (2,), seed=4), whole_value(A)
    assert F.outermorphism_matrix.shape == (A.size, A.size)
    assert same(F.outermorphism_matrix @ X.dense(), F(X).dense())
    assert same((F @ G).outermorphism_matrix, F.outermorphism_matrix @ G.outermorphism_matrix)
    if A.dimension > 1:
        planes = A._indices(0b100)
        assert same(F.bivector_matrix, F.outermorphism_matrix[np.ix_(planes, planes)])


@pytest.mark.parametrize("signature", [(0, 3, 0), (2, 1, 0), (4, 0, 0), (1, 3, 0), (4, 1, 0)])
def test_the_adjoint_moves_to_the_other_factor_in_any_metric(signature):
    A = ph.algebra(*signature)
    F, X, Y = whole_map(A), whole_value(A), whole_value(A, seed=3)
    assert same((~F(X)).scalar_product(Y), (~X).scalar_product(F.adjoint()(Y)))
    assert same(F.adjoint().adjoint().matrix, F.matrix)
    assert same(F.symmetric_part().adjoint().matrix, F.symmetric_part().matrix)
    assert same((F.symmetric_part() + F.antisymmetric_part()).matrix, F.matrix)
    B = whole_map(A, grade=2)
    P, Q = X.grade(2), Y.grade(2)
    assert same((~B(P)).scalar_product(Q), (~P).scalar_product(B.adjoint()(Q)))
    # The antisymmetric part is a ↦ a·Ω, Ω = ½ Σ e^k∧A(e_k).
    antisymmetric = F.antisymmetric_part()
    frame = ph.reciprocal_frame(A.basis_vectors)
    omega = sum(up.wedge(antisymmetric(e)) for up, e in zip(frame, A.basis_vectors, strict=True)) / 2
    a = X.grade(1)
    assert same(a.dot(omega), antisymmetric(a))


def test_a_degenerate_metric_has_no_adjoint():
    F = whole_map(ph.algebra(3, 0, 1))
    for call in (F.adjoint, F.symmetric_part, F.antisymmetric_part):
        with pytest.raises(ValueError, match=r"Cl\(3,0,1\) has no adjoint.*degenerate.*transposed"):
            call()


@pytest.mark.parametrize("signature", [(2, 0, 0), (1, 3, 0), (3, 0, 1), (4, 1, 0)])
@pytest.mark.parametrize("shape", SHAPES)
def test_inverses(signature, shape):
    A = ph.algebra(*signature)
    n = A.dimension
    # Near the identity, so that the condition is at most 3.
    F = ph.LinearMap.from_matrix(np.eye(n) + RNG.uniform(-0.5, 0.5, (*shape, n, n)) / n, algebra=A)
    one = ph.LinearMap.identity(shape, algebra=A)
    assert np.all((F @ F.inverse()).is_close(one, rtol=64 * EPS))
    X = whole_value(A)
    assert np.all((F.inverse()(F(X)) - X).dense() <= 1024 * EPS * 3**n)
    with pytest.raises(ValueError, match="no inverse"):
        (0 * F).inverse()


# --- boosts, versors and motors


def test_a_boost_preserves_the_metric():
    t, x, *_ = SPACETIME.basis_vectors
    boost = (0.4 * (t ^ x)).exp()
    L = ph.LinearMap.from_function(boost, algebra=SPACETIME)
    # A boost by the rapidity 0.8 (either sign): cosh and sinh in the first two rows.
    assert np.allclose(abs(L.matrix[:2, :2]), [[np.cosh(0.8), np.sinh(0.8)], [np.sinh(0.8), np.cosh(0.8)]])
    one = ph.LinearMap.identity(algebra=SPACETIME)
    # Products of entries up to cosh 0.8 = 1.34.
    assert (L.adjoint() @ L).is_close(one, rtol=64 * EPS)
    assert L.inverse().is_close(L.adjoint(), rtol=64 * EPS)
    assert abs(L.trace() - 2 * (1 + np.cosh(0.8))) <= 32 * EPS
    assert abs(L.determinant - 1) <= 32 * EPS
    F = SPACETIME.multivector(RNG.standard_normal(16)).grade(2)
    assert (L(F) - boost(F)).components == pytest.approx(0, abs=256 * EPS)


def test_the_adjoint_representation_of_a_motor_is_a_map_of_bivectors():
    A = ph.algebra(3, 0, 1)
    B, X = A.bivector(RNG.standard_normal(6)), A.bivector(RNG.standard_normal(6))
    # exp of the map X ↦ X×B·2 is the action of exp(−B): the matrix exponential as a peer.
    bracket = ph.LinearMap.from_function(lambda Y: 2 * Y.commutator(B), grade=2, algebra=A)
    action = ph.LinearMap.from_function((-B).exp(), grade=2, algebra=A)
    assert bracket.matrix.shape == (6, 6)
    # The exponent has a size below 10, its exponential below e¹⁰ only by the bound; 1e-11 leaves 3 digits.
    assert np.allclose(expm(bracket.matrix), action.matrix, rtol=0, atol=1e-11)
    assert action(X).is_close((-B).exp()(X), rtol=1e-11)
    assert abs(action.determinant - 1) <= 1e-11


def test_functions_of_another_algebra():
    with pytest.raises(TypeError, match=r"the image must be a value of Cl\(1,3\), got Cl\(3\)"):
        ph.LinearMap.from_function(lambda a: e1, algebra=SPACETIME)
    with pytest.raises(TypeError, match="the image must be of grade 1"):
        ph.LinearMap.from_function(lambda a: a * SPACETIME.I, algebra=SPACETIME)
    with pytest.raises(ValueError, match="not linear"):
        ph.LinearMap.from_function(lambda a: a * a.norm_squared(), algebra=SPACETIME)
    with pytest.raises(TypeError, match=r"acts on values of Cl\(1,3\), got one of Cl\(3\)"):
        whole_map(SPACETIME)(e1)
    with pytest.raises(TypeError, match=r"acts on values of 3-d space, got one of Cl\(1,3\)"):
        whole_map(ph.algebra(3))(SPACETIME.basis_vectors[0])


# --- sums, multiples, products


@pytest.mark.parametrize("signature", [(3, 0, 0), (1, 3, 0)])
@pytest.mark.parametrize("grade", [1, 2])
def test_sums_and_multiples_of_maps(signature, grade):
    A = ph.algebra(*signature)
    F, G = whole_map(A, (2, 1), grade), whole_map(A, (3,), grade, seed=7)
    X = whole_value(A).grade(grade)
    assert same((F + G)(X), F(X) + G(X))
    assert same((F - G)(X), F(X) - G(X))
    assert same((2 * F)(X), 2 * F(X))
    assert same((F * 2.5)(X), 2.5 * F(X))
    assert same((F / 2)(X), F(X) / 2)
    assert same((-F)(X), -F(X))
    assert same((+F).matrix, F.matrix)
    scales = np.array([[1.0], [-2.0]])
    for scaled in (scales * F, F * scales):
        assert scaled.shape == (2, 1)
        assert same(scaled(X), scales * F(X))
    assert same((np.float64(3) * F).matrix, 3 * F.matrix)
    assert same((F @ G)(X), F(G(X)))
    assert same((F @ G).matrix, (F * G).matrix)
    assert same((F @ G).trace(), (G @ F).trace())


def test_the_outermorphism_of_a_sum_is_not_the_sum():
    F = ph.LinearMap.identity()
    assert same((F + F)(e1 ^ e2), 4 * (e1 ^ e2))
    assert same(F(e1 ^ e2) + F(e1 ^ e2), 2 * (e1 ^ e2))


def test_a_map_of_vectors_times_one_of_bivectors():
    F, J = whole_map(ph.algebra(3)), ph.Inertia.from_principal_moments(1, 2, 3)
    for turned in (F * J, F @ J):
        assert turned.grade == 2
        assert same(turned(e1 ^ e2), F(J(e1 ^ e2)))
    assert type(J + J) is type(2 * J) is ph.LinearMap
    assert same((J + J)(e2 ^ e3), 2 * J(e2 ^ e3))
    assert J.trace() == 6
    assert J.algebra is ph.algebra(3)
    R, S = J.polar()
    assert same(R.canonical().components, [1, 0, 0, 0])
    assert same(S.matrix, J.matrix)
    assert same(J.svd()[1], [3, 2, 1])
    with pytest.raises(TypeError, match=r"from_principal_moments\(1, 1, 1\)"):
        ph.Inertia.identity()
    for operate in (lambda: F + J, lambda: F - J):
        with pytest.raises(TypeError, match="no sum; add their bivector_matrix"):
            operate()


def test_operands_that_maps_do_not_take():
    F = whole_map(ph.algebra(3))
    for other in (e1, "2", None, True, [1, 2], 1j):
        with pytest.raises(TypeError):
            F * other
        with pytest.raises(TypeError):
            other * F
        with pytest.raises(TypeError):
            F + other
        with pytest.raises(TypeError):
            F @ other
    with pytest.raises(TypeError, match=r"different algebras, Cl\(3\) and Cl\(1,3\)"):
        F + whole_map(SPACETIME)
    with pytest.raises(TypeError, match="different algebras"):
        F @ whole_map(SPACETIME)
    with pytest.raises(TypeError, match="different algebras"):
        F.is_close(whole_map(SPACETIME))
    with pytest.raises(ZeroDivisionError, match=r"linear map by zero at index \(1,\)"):
        F / np.array([1.0, 0.0])


# --- singular values and the polar form


@pytest.mark.parametrize("signature", EUCLIDEAN)
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("grade", [1, 2])
def test_singular_values(signature, shape, grade):
    A = ph.algebra(*signature)
    size = comb(A.dimension, grade)
    F = ph.LinearMap.from_matrix(RNG.standard_normal((*shape, size, size)), grade, algebra=A)
    u, s, v = F.svd()
    assert u.shape == v.shape == s.shape == (*shape, size)
    one = F if not shape else ph.LinearMap.from_matrix(F.matrix[..., None, :, :], grade, algebra=A)
    # LAPACK's bound is a modest multiple of EPS times the norm.
    alone = np.linalg.svd(F.matrix, compute_uv=False)
    assert np.all(abs(s - alone) <= 64 * EPS * alone[..., :1])
    assert np.all(np.diff(s) <= 0)
    assert close(one(v), u * s, 64, np.linalg.norm(F.matrix))
    for frame in (u, v):
        gram = np.asarray(frame) @ np.swapaxes(np.asarray(frame), -1, -2)
        assert np.all(abs(gram - np.eye(size)) <= 64 * EPS)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("grade", [1, 2])
def test_the_polar_form(shape, grade):
    m = RNG.standard_normal((*shape, 3, 3))
    m *= np.sign(np.linalg.det(m))[..., None, None]
    F = ph.LinearMap.from_matrix(m, grade)
    R, S = F.polar()
    assert isinstance(R, ph.Rotor)
    assert R.shape == S.shape == shape
    assert S.grade == grade
    turn = ph.LinearMap.from_function(R, grade)
    size = np.linalg.norm(m)
    assert np.all((turn @ S).is_close(F, rtol=64 * EPS))
    assert same(S.adjoint().matrix, S.matrix)
    sizes = S.eigenplanes()[1] if grade == 2 else S.eigenvectors()[1]
    assert np.all(sizes >= -64 * EPS * size)
    for index in np.ndindex(shape):
        u, p = scipy_polar(m[index])
        # Both are within the condition of the smallest singular values, here below 1e3, of the exact ones.
        assert np.allclose(R[index].to_matrix(), u, rtol=0, atol=1e-12)
        assert np.allclose(S.matrix[index], p, rtol=0, atol=1e-12 * size)


def test_polar_forms_of_rotations_stretches_and_singular_maps():
    turn = ph.Rotor.from_plane_angle(e1 ^ e2, 0.3)
    R, S = ph.LinearMap.from_function(turn).polar()
    assert R.distance(turn) <= 8 * EPS
    assert S.is_close(ph.LinearMap.identity(), rtol=16 * EPS)
    R, S = ph.LinearMap.from_matrix(np.diag([3.0, 1.0, 2.0])).polar()
    assert R.angle <= 8 * EPS
    # A projection turned: the sign of the third axis is chosen so that R is a rotation.
    flat = ph.LinearMap.from_function(lambda a: turn(a.project(e1 ^ e2)))
    R, S = flat.polar()
    assert R.distance(turn) <= 16 * EPS
    assert S(e3).norm() <= 16 * EPS
    for near in (1e-5, 1e-10, 1e-17, -1e-17):
        R, S = ph.LinearMap.from_matrix(turn.to_matrix() @ np.diag([1.0, 1.0, near])).polar()
        assert R.distance(turn) <= 16 * EPS
    R, S = ph.LinearMap.from_matrix(np.zeros((3, 3))).polar()
    assert same(S.matrix, 0)


def test_maps_that_change_orientation_have_no_polar_form():
    m = np.array([np.eye(3), np.diag([1.0, 1.0, -2.0])])
    with pytest.raises(ValueError, match=r"map at index \(1,\) changes orientation.* -2; .*of -F"):
        ph.LinearMap.from_matrix(m).polar()
    R, S = (-ph.LinearMap.from_matrix(m[1])).polar()
    assert close(R(S(e3)), 2 * e3, 16, 2)
    with pytest.raises(ValueError, match=r"3-d space, got one of Cl\(4\)"):
        whole_map(ph.algebra(4)).polar()


# --- eigenvalues


@pytest.mark.parametrize("signature", [(2, 0, 0), (4, 0, 0), (5, 0, 0)])
def test_eigenvectors_and_planes_of_euclidean_algebras(signature):
    A = ph.algebra(*signature)
    F = whole_map(A, (2,)).symmetric_part()
    axes, factors = F.eigenvectors()
    each = ph.LinearMap.from_matrix(F.matrix[:, None], algebra=A)
    size = np.linalg.norm(F.matrix)
    assert np.all(np.diff(factors) >= 0)
    assert close(each(axes), axes * factors, 64, size)
    whole = axes[..., 0]
    for k in range(1, A.dimension):
        whole = whole.wedge(axes[..., k])
    assert close(whole, A.I, 64)
    planes, products = F.eigenplanes()
    assert planes.shape == products.shape == (2, comb(A.dimension, 2))
    assert np.all(np.diff(products) >= 0)
    assert close(each(planes), planes * products, 256, size**2)
    of_bivectors = ph.LinearMap.from_matrix(F.bivector_matrix, grade=2, algebra=A)
    assert np.all(abs(of_bivectors.eigenplanes()[1] - products) <= 256 * EPS * size**2)


def test_indefinite_metrics_have_no_eigenvectors_and_singular_values():
    F = ph.LinearMap.identity(algebra=SPACETIME)
    for name, remedy in [("eigenvectors", "eig"), ("eigenplanes", "eig"), ("svd", "svd")]:
        with pytest.raises(
            ValueError, match=rf"{name} needs a Euclidean metric.*Cl\(1,3\).*linalg\.{remedy}"
        ):
            getattr(F, name)()


# --- values


def test_maps_of_algebras_compare_print_and_are_stored():
    F = whole_map(SPACETIME, (2,))
    assert np.all(pickle.loads(pickle.dumps(F)) == F)
    assert pickle.loads(pickle.dumps(F)).algebra is SPACETIME
    assert repr(F).startswith("LinearMap of vectors of Cl(1,3), shape (2,), matrix\n")
    assert r"\begin{pmatrix}" in F._repr_latex_()
    # The same matrix, but another metric, grade or size.
    assert ph.LinearMap.identity() != ph.LinearMap.identity(algebra=ph.algebra(2, 1))
    assert ph.LinearMap.identity() != ph.LinearMap.identity(grade=2)
    assert ph.LinearMap.identity() != ph.LinearMap.identity(algebra=SPACETIME)
    assert same(ph.LinearMap.identity() != F, True)
    assert (ph.LinearMap.identity() != F).shape == (2,)
    assert F.is_close(F).all()
    assert ph.LinearMap.identity(3).shape == (3,)


def test_complex_values_are_mapped_linearly():
    F, J = whole_map(ph.algebra(3)), ph.LinearMap.from_matrix(np.diag([1.0, 2, 3]), grade=2)
    X, Y = whole_value(ph.algebra(3)), whole_value(ph.algebra(3), seed=3)
    assert same(F(X + 1j * Y), F(X) + 1j * F(Y))
    assert same(J((1 + 2j) * (e1 ^ e2)), (3 + 6j) * (e1 ^ e2))


def test_invalid_maps_of_algebras_raise():
    with pytest.raises(ValueError, match=r"of vectors of Cl\(1,3\) must have shape \(\.\.\., 4, 4\), got"):
        ph.LinearMap.from_matrix(np.eye(3), algebra=SPACETIME)
    with pytest.raises(ValueError, match=r"of bivectors of Cl\(1,3\) must have shape \(\.\.\., 6, 6\)"):
        ph.LinearMap.from_matrix(np.eye(4), 2, algebra=SPACETIME)
    with pytest.raises(TypeError, match=r"one of ph\.algebra\(p, q, r\), got int"):
        ph.LinearMap.identity(algebra=4)
    with pytest.raises(ValueError, match=r"Cl\(1\) has no bivectors"):
        ph.LinearMap.identity(grade=2, algebra=ph.algebra(1))
    with pytest.raises(TypeError, match="no outermorphism"):
        _ = ph.LinearMap.identity(grade=2).outermorphism_matrix


def test_formulas_call_maps_of_3d_space_only():
    a = SPACETIME.basis_vectors[0]
    F, planar = whole_map(SPACETIME), ph.LinearMap.identity(algebra=ph.algebra(2, 1))
    with pytest.raises(TypeError, match=r"F is a linear map of Cl\(1,3\); formulas call those of 3-d space"):
        ph.evaluate("F(a)", F=F, a=a)
    for values in ({"F": planar, "a": e1}, {"a": e1, "F": planar}, {"F": F, "a": e1}):
        with pytest.raises(TypeError):
            ph.evaluate("F(a)", values)
        with pytest.raises(TypeError):
            ph.evaluate("F(a)", **values)
    with pytest.raises(TypeError, match=r"linear map of Cl\(2,1\)"):
        ph.torque.formula("F(Ω)", F=planar)
    assert ph.evaluate("F(a)", F=ph.LinearMap.identity(), a=e1) == e1
