"""Linear maps: outermorphisms, adjoints, inverses, eigenvalues; inertia as a linear map."""

import copy
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import polhode as ph
from polhode import I, e1, e2, e3
from samples import EPS, SHAPES, close, rotors, same, values, vectors, whole

whole_matrices = st.lists(whole, min_size=9, max_size=9).map(lambda m: np.array(m).reshape(3, 3))
maps = st.builds(ph.LinearMap.from_matrix, whole_matrices)
symmetric = whole_matrices.map(lambda m: m + m.T)


def random_map(shape=(), seed=1, grade=1):
    return ph.LinearMap.from_matrix(np.random.default_rng(seed).standard_normal((*shape, 3, 3)), grade)


def random_value(shape=(), seed=2):
    return ph.multivector(np.random.default_rng(seed).standard_normal((*shape, 8)))


# --- action


@given(maps, values, values)
def test_a_map_respects_the_wedge(F, A, B):
    # Whole numbers: exact.
    assert same(F(A.wedge(B)), F(A).wedge(F(B)))
    assert same(F(A + B), F(A) + F(B))
    assert F(A).grades == A.grades


@given(maps)
def test_scalars_stay_and_volumes_scale(F):
    assert same(F(ph.scalar(3.0)), 3)
    assert same(F(I), F.determinant * I)
    # LU of a matrix of entries up to 9: a few dozen roundings of products up to 9³.
    assert abs(F.determinant - np.linalg.det(F.matrix)) <= 64 * EPS * 9**3


@given(maps)
def test_columns_are_images(F):
    for k, e in enumerate((e1, e2, e3)):
        assert same(F(e), ph.vector(F.matrix[:, k]))
        assert same(F(e.undual()), ph.bivector(F.bivector_matrix[:, k]))


@given(maps, values, values)
def test_the_adjoint_moves_to_the_other_factor(F, A, B):
    assert same((~F(A)).scalar_product(B), (~A).scalar_product(F.adjoint()(B)))
    assert same(F.adjoint().adjoint().matrix, F.matrix)


@given(maps, maps, values)
def test_products_apply_the_right_map_first(F, G, A):
    assert same((F * G)(A), F(G(A)))
    assert (F * G).determinant == F.determinant * G.determinant
    assert same((F * G).adjoint().matrix, (G.adjoint() * F.adjoint()).matrix)


@given(maps, values)
def test_cofactors_give_the_inverse_times_the_determinant(F, A):
    # F I adj(F)(I⁻¹ A) = det F · A, whole for any F, singular ones too.
    assert same(F(F.adjoint()(A.dual()).undual()), F.determinant * A)


@pytest.mark.parametrize("shape", SHAPES)
def test_the_inverse(shape):
    F, X = random_map(shape), random_value(shape)
    inverse = F.inverse()
    sizes = np.linalg.svd(F.matrix, compute_uv=False)
    # The error of an inverse is its condition; on bivectors and I it enters up to three factors.
    bound = 64 * EPS * (sizes[..., 0] / sizes[..., 2]) ** 3
    size = X.norm()
    assert np.all((inverse(F(X)) - X).norm() <= bound * size)
    assert np.all((F(inverse(X)) - X).norm() <= bound * size)
    through_adjoint = F.adjoint()(X.dual()).undual() / F.determinant
    assert np.all((inverse(X) - through_adjoint).norm() <= bound * size * (1 + 1 / sizes[..., 2] ** 3))
    assert inverse.shape == shape


@pytest.mark.parametrize("tilt", [1e-3, 1e-7, 1e-12])
def test_nearly_singular_maps_are_inverted_to_their_condition(tilt):
    F = ph.LinearMap.from_matrix([[1, 1, 0], [1, 1 + tilt, 0], [0, 0, 1]])
    assert (F.inverse()(F(e1)) - e1).norm() <= 32 * EPS / tilt


def test_singular_maps_have_no_inverse():
    m = np.array([np.eye(3), np.diag([1.0, 0, 1])])
    with pytest.raises(ValueError, match=r"the map at index \(1,\) has no inverse: its singular values"):
        ph.LinearMap.from_matrix(m).inverse()
    with pytest.raises(ValueError, match="the map has no inverse"):
        ph.LinearMap.from_function(lambda a: a.project(e1 ^ e2)).inverse()
    with pytest.raises(ValueError, match="no inverse"):
        ph.LinearMap.from_matrix(np.zeros((3, 3))).inverse()
    # The size of a map does not make it singular, and that of a singular one does not hide it.
    for size in (1e-30, 1e30):
        assert same(ph.LinearMap.from_matrix(size * np.eye(3)).inverse().matrix, np.eye(3) / size)
        with pytest.raises(ValueError, match="no inverse"):
            ph.LinearMap.from_matrix(size * np.array([[1, 2, 3], [4, 5, 6], [7, 8, 9]])).inverse()


@pytest.mark.parametrize("of_map", SHAPES)
@pytest.mark.parametrize("of_value", SHAPES)
@pytest.mark.parametrize("grade", [0, 1, 2, 3])
def test_batches_broadcast(of_map, of_value, grade):
    F, X = random_map(of_map), random_value(of_value).grade(grade)
    assert F.shape == of_map
    image = F(X)
    assert image.shape == np.broadcast_shapes(of_map, of_value)
    assert image.grades == (grade,)
    matrices = np.broadcast_to(F.matrix, (*image.shape, 3, 3))
    given_values = np.broadcast_to(X.components, (*image.shape, X.components.shape[-1]))
    for index in np.ndindex(image.shape):
        one = ph.LinearMap.from_matrix(matrices[index])
        value = ph.multivector(np.zeros(8)).grade(grade) + type_of(grade)(given_values[index])
        assert close(image[index], one(value), 16, 64)
    assert random_map(of_map).determinant.shape == of_map


def type_of(grade):
    return [lambda c: ph.scalar(c[0]), ph.vector, ph.bivector, lambda c: ph.trivector(c[0])][grade]


def test_sums_and_products_follow_ieee():
    F = ph.LinearMap.from_matrix(1e200 * np.eye(3))
    assert same(F(1e200 * e1 + 0 * e2).components[0], np.inf)
    assert F.determinant == np.inf
    assert np.isnan(F(ph.vector([np.nan, 0, 0])).components).any()
    assert same(F(ph.scalar(np.inf)), ph.scalar(np.inf))


def test_determinants_of_columns_of_very_different_sizes():
    sizes = 2.0 ** np.array([[700, 700, -700], [-700, -700, 700], [-1000, 1000, 10], [0, 0, 0]])
    sizes[3, 0] = 0.0
    matrices = random_map().matrix * sizes[:, np.newaxis, :]
    expected = random_map().determinant * np.array([2.0**700, 2.0**-700, 2.0**10, 0.0])
    np.testing.assert_array_equal(ph.LinearMap.from_matrix(matrices).determinant, expected)


def test_coefficients_become_floats_and_other_algebras_raise():
    F = random_map()
    for dtype in (object, np.float32):
        image = F((2 * e1 + I).astype(dtype))
        assert image.dtype == np.float64
        assert same(image, F(2 * e1 + I))
    with pytest.raises(TypeError, match="of 3-d space"):
        F(ph.algebra(1, 3).basis_vectors[0])


# --- from functions


@given(rotors, values)
def test_a_rotor_is_a_linear_map(R, A):
    F = ph.LinearMap.from_function(R)
    # Images of unit vectors to 16 roundings; products of three of them to 64.
    assert close(F(A), R(A), 64, 9 * np.sqrt(8))
    assert abs(F.determinant - 1) <= 64 * EPS
    assert F.inverse().is_close(F.adjoint(), rtol=64 * EPS)
    assert np.all(abs(F.bivector_matrix - F.matrix) <= 64 * EPS)


def test_a_batch_of_rotors_is_a_batch_of_maps():
    R = ph.Rotor.random((2, 3), 1)
    F = ph.LinearMap.from_function(R)
    assert F.shape == (2, 3)
    assert np.all(abs(F.matrix - R.to_matrix()) <= 8 * EPS)


def test_functions_of_bivectors():
    S = ph.LinearMap.from_function(lambda B: B.commutator(e1 ^ e2), grade=2)
    assert S.grade == 2
    assert same(S(e2 ^ e3), (e2 ^ e3).commutator(e1 ^ e2))
    with pytest.raises(TypeError, match="of bivectors must be a bivector"):
        S(e1)


def test_nonlinear_functions_raise():
    with pytest.raises(ValueError, match="not linear"):
        ph.LinearMap.from_function(lambda a: a * a.norm())
    with pytest.raises(ValueError, match="not linear"):
        ph.LinearMap.from_function(lambda a: a + e1)
    with pytest.raises(TypeError, match="the image must be a vector"):
        ph.LinearMap.from_function(lambda a: a * I)
    with pytest.raises(TypeError, match="the image must be a vector"):
        ph.LinearMap.from_function(lambda a: a.components)
    # At any size of the function, beside which rounding and a square count alike.
    R = ph.Rotor.random(rng=3)
    for size in (1e-12, 1e12):
        F = ph.LinearMap.from_function(lambda a, k=size: k * R(a))
        np.testing.assert_allclose(F.matrix / size, R.to_matrix(), rtol=0, atol=8 * EPS)
        with pytest.raises(ValueError, match="not linear"):
            ph.LinearMap.from_function(lambda a, k=size: k * (a.norm() * a + R(a)))


# --- parts, eigenvectors, eigenplanes


@given(maps, vectors)
def test_parts(F, a):
    S, A = F.symmetric_part(), F.antisymmetric_part()
    assert same(S(a) + A(a), F(a))
    assert same(S.adjoint().matrix, S.matrix)
    assert same(A.adjoint().matrix, -A.matrix)
    # a·B = A(a) for B = ½ Σ e_k∧A(e_k): of e_k∧A(e_k) each plane comes twice.
    B = sum((e.wedge(A(e)) for e in (e1, e2, e3)), start=ph.bivector(np.zeros(3))) / 2
    assert same(a.dot(B), A(a))


@given(symmetric)
def test_eigenvectors_of_symmetric_maps(m):
    F = ph.LinearMap.from_matrix(m)
    axes, factors = F.eigenvectors()
    size = np.linalg.norm(m)
    assert np.all(np.diff(factors) >= 0)
    # LAPACK's error bound is a modest multiple of EPS times the norm.
    assert close(F(axes), axes * factors, 64, size)
    assert close(axes[0].wedge(axes[1]).wedge(axes[2]), I, 32)
    assert np.all(abs(axes.norm() - 1) <= 16 * EPS)


@given(symmetric)
def test_eigenplanes_of_symmetric_maps(m):
    F = ph.LinearMap.from_matrix(m)
    planes, factors = F.eigenplanes()
    assert planes.grades == (2,)
    assert np.all(np.diff(factors) >= 0)
    assert close(F(planes), planes * factors, 128, np.linalg.norm(m) ** 2)
    of_bivectors = ph.LinearMap.from_matrix(F.bivector_matrix, grade=2)
    _, again = of_bivectors.eigenplanes()
    assert np.all(abs(again - factors) <= 128 * EPS * np.linalg.norm(m) ** 2)


def test_equal_and_zero_eigenvalues():
    axes, factors = ph.LinearMap.from_matrix(2 * np.eye(3)).eigenvectors()
    assert same(factors, 2)
    assert close(axes[0].wedge(axes[1]).wedge(axes[2]), I, 8)
    _, factors = ph.LinearMap.from_function(lambda a: a.project(e1 ^ e2)).eigenplanes()
    assert np.all(abs(factors - [0, 0, 1]) <= 8 * EPS)


def test_eigenvectors_over_batches():
    m = np.random.default_rng(3).standard_normal((4, 2, 3, 3))
    F = ph.LinearMap.from_matrix(m).symmetric_part()
    for axes, factors in (F.eigenvectors(), F.eigenplanes()):
        assert axes.shape == factors.shape == (4, 2, 3)
    one = ph.LinearMap.from_matrix(F.matrix[3, 1])
    assert same(F.eigenvectors()[0][3, 1], one.eigenvectors()[0])
    assert same(F.eigenplanes()[1][3, 1], one.eigenplanes()[1])


def test_eigenvectors_of_asymmetric_maps_raise():
    m = np.array([np.eye(3), [[0, -1, 0], [1, 0, 0], [0, 0, 1]]])
    with pytest.raises(ValueError, match=r"the map at index \(1,\) is not symmetric.*plane_angle"):
        ph.LinearMap.from_matrix(m).eigenvectors()
    with pytest.raises(ValueError, match="see eigenplanes"):
        ph.LinearMap.from_matrix(np.eye(3), grade=2).eigenvectors()


# --- inertia


def test_inertia_is_a_linear_map_of_bivectors():
    J = ph.Inertia.from_matrix([[3, 0.2, 0.1], [0.2, 4, 0.3], [0.1, 0.3, 5]])
    assert isinstance(J, ph.LinearMap)
    assert (J.grade, J.shape) == (2, ())
    assert same(J.bivector_matrix, J.matrix)
    assert np.isclose(J.determinant, np.prod(J.principal_moments), rtol=64 * EPS, atol=0)
    other = J.adjoint()
    assert other == J
    assert J != 2
    assert J.symmetric_part().is_close(J, rtol=0)
    B = ph.bivector([1.0, -2.0, 3.0])
    assert close(J.inverse()(B), J.inverse(B), 16)
    assert close((J.inverse() * J)(B), B, 64, 4)
    with pytest.raises(TypeError, match="plane of rotation"):
        J(e1)


def test_principal_planes_and_moments():
    J = ph.Inertia.from_matrix([[3, 0.2, 0.1], [0.2, 4, 0.3], [0.1, 0.3, 5]])
    planes, moments = J.eigenplanes()
    assert same(moments, J.principal_moments)
    assert close(J(planes), planes * moments, 32, 5)
    assert close(J.principal_frame(e1 ^ e2), planes[2], 4)
    inverse_planes, inverses = J.inverse().eigenplanes()
    assert np.all(abs(inverses[::-1] * moments - 1) <= 32 * EPS)
    assert np.all(abs(abs(inverse_planes[::-1].scalar_product(planes).components) - 1) <= 64 * EPS)
    # In the order the moments were given in.
    planes, moments = ph.Inertia.from_principal_moments(3, 1, 2.5).eigenplanes()
    assert same(planes, ph.bivector(np.eye(3)))
    assert same(moments, [3, 1, 2.5])


def test_the_symmetric_top_by_its_formula():
    i1, i3 = 2.0, 3.0
    J = ph.Inertia.from_function(lambda B: i1 * B + (i3 - i1) * (B ^ e3) * e3)  # handout eq. 4.25
    assert ph.Inertia.from_principal_moments(i1, i1, i3) == J
    with pytest.raises(ValueError, match="symmetric"):
        ph.Inertia.from_function(lambda B: B.commutator(e1 ^ e2))


@given(rotors)
def test_a_turned_body_has_the_turned_map(R):
    body = ph.Body.box([1, 2, 3], mass=12)
    F = ph.LinearMap.from_function(R)
    turned = F * body.inertia * F.inverse()
    assert turned.grade == 2
    size = np.linalg.norm(body.inertia.matrix)
    assert turned.is_close(body.moved(R).inertia, rtol=0, atol=256 * EPS * size)


def test_a_rod_cannot_be_inverted():
    rod = ph.Body.rod(2, mass=3).inertia
    with pytest.raises(ValueError, match="moment"):
        rod.inverse()
    assert close(rod(e2 ^ e3), e2 ^ e3, 4)


# --- values


def test_maps_compare_copy_and_are_immutable():
    F = random_map((2,))
    one = ph.LinearMap.from_matrix(F.matrix[0])
    assert np.array_equal(one == F, [True, False])
    assert np.array_equal(one != F, [False, True])
    assert ph.LinearMap.from_matrix(np.eye(3)) != ph.LinearMap.from_matrix(np.eye(3), grade=2)
    assert F != 3
    for same_map in (copy.deepcopy(F), pickle.loads(pickle.dumps(F))):
        assert np.all(same_map == F)
    with pytest.raises(AttributeError):
        F.matrix = 0
    before = F.matrix
    F.matrix[0] = 7
    assert np.array_equal(F.matrix, before)
    m = np.eye(3)
    G = ph.LinearMap.from_matrix(m)
    m[0] = 7
    assert same(G.matrix, np.eye(3))
    assert np.all(F.is_close(ph.LinearMap.from_matrix(F.matrix * (1 + 1e-12))))
    assert not np.any(F.is_close(ph.LinearMap.from_matrix(F.matrix * (1 + 1e-6))))
    with pytest.raises(TypeError, match="needs another map"):
        F.is_close(e1)
    assert repr(G) == "LinearMap of vectors, matrix\n" + repr(np.eye(3))
    assert "of bivectors, shape (2,)" in repr(random_map((2,), grade=2))


def test_invalid_maps_raise():
    with pytest.raises(ValueError, match=r"shape \(\.\.\., 3, 3\), got \(3,\)"):
        ph.LinearMap.from_matrix([1, 2, 3])
    with pytest.raises(ValueError, match=r"entry \(1, 2, 0\) .* got nan"):
        ph.LinearMap.from_matrix([np.eye(3), [[1, 0, 0], [0, 1, 0], [np.nan, 0, 1]]])
    with pytest.raises(ValueError, match="got grade 3"):
        ph.LinearMap.from_matrix(np.eye(3), grade=3)
    with pytest.raises(ValueError, match="got grade 0"):
        ph.LinearMap.from_function(lambda a: a, grade=0)
    with pytest.raises(TypeError, match="real numbers"):
        ph.LinearMap.from_matrix(1j * np.eye(3))
    with pytest.raises(TypeError, match="from_matrix or"):
        ph.LinearMap(np.eye(3))
    with pytest.raises(TypeError, match=r"wrap arrays with ph\.vector"):
        ph.LinearMap.from_matrix(np.eye(3))([1, 2, 3])
