"""Projections, reflections, axial vectors and distances between attitudes."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import polhode as ph
from polhode import I, e1, e2, e3
from samples import EPS, SHAPES, angles, bivectors, close, directions, rotors, same, values, vectors

unit_vectors = st.builds(ph.vector, directions)
unit_planes = st.builds(ph.bivector, directions)


# --- parts


@given(values, unit_planes)
def test_the_parts_add_up(X, plane):
    parallel, perpendicular = ph.split(X, plane)
    assert same(parallel, X.project(plane))
    assert same(perpendicular, X.reject(plane))
    # One difference and one sum.
    assert close(parallel + perpendicular, X, 2, X.norm())


@given(vectors, unit_planes)
def test_a_vector_splits_along_and_across_a_plane(a, plane):
    # Handout eq. 1.7: a∥ lies in the plane, a⊥ is perpendicular to it.
    parallel, perpendicular = ph.split(a, plane)
    assert close(parallel.wedge(plane), 0, 16, a.norm())
    assert close(perpendicular.dot(plane), 0, 16, a.norm())


def test_split_over_batches():
    planes = ph.bivector(np.eye(3))
    parallel, perpendicular = ph.split(e1 + 2 * e2 + 3 * e3, planes)
    assert same(parallel, ph.vector([[0, 2, 3], [1, 0, 3], [1, 2, 0]]))
    assert same(perpendicular, ph.vector(np.diag([1.0, 2, 3])))
    with pytest.raises(TypeError, match="wrap arrays"):
        ph.split([1, 2, 3], planes)
    with pytest.raises(TypeError, match="one grade"):
        ph.split(e1, 1 + e1)


# --- reflections


@given(vectors, unit_vectors)
def test_reflection_reverses_the_normal_and_keeps_the_plane(a, n):
    reflected = a.reflect(n)
    assert close(reflected, -n * a * n.inverse(), 32, a.norm())
    parallel, perpendicular = ph.split(a, n)
    assert close(reflected, perpendicular - parallel, 16, a.norm())
    assert reflected.grades == (1,)


@given(values, unit_vectors)
def test_reflection_of_any_multivector(X, n):
    assert close(X.reflect(n), n * X.grade_involution() * n.inverse(), 32, X.norm())
    assert close(X.reflect(n).reflect(n), X, 32, X.norm())
    assert X.reflect(n).grades == X.grades
    assert close(X.reflect(-3e200 * n), X.reflect(n), 16, X.norm())


@given(values, values, unit_vectors)
def test_reflections_respect_the_wedge(A, B, n):
    assert close(A.wedge(B).reflect(n), A.reflect(n).wedge(B.reflect(n)), 64, A.norm() * B.norm())


@given(values, unit_vectors, unit_vectors)
def test_two_reflections_turn_by_twice_the_angle(X, m, n):
    R = ph.Rotor.from_components((n * m).components)
    assert close(X.reflect(m).reflect(n), R(X), 64, X.norm())


def test_reflections_of_basis_elements():
    assert same((e1 + e2 + e3).reflect(2 * e3), e1 + e2 - e3)
    assert same(I.reflect(e1), -I)
    assert same((e1 ^ e2).reflect(e3), e1 ^ e2)
    assert same((e1 ^ e2).reflect(e1), e2 ^ e1)
    # The plane e1∧e2 as a mirror.
    assert same((e1 + 2 * e3).reflect((e1 ^ e2).dual()), e1 - 2 * e3)
    assert e1.reflect(ph.vector(np.eye(3))).shape == (3,)
    with pytest.raises(TypeError, match=r"a vector; for a plane B use B\.dual\(\); got e1∧e2"):
        e1.reflect(e1 ^ e2)
    with pytest.raises(ValueError, match=r"index \(1,\)"):
        e1.reflect(ph.vector([[1, 0, 0], [0, 0, 0]]))


def test_reflections_with_other_coefficients_and_algebras():
    n, a = (ph.vector([Fraction(x, 7) for x in c]) for c in ([1, 2, 2], [3, 0, -1]))
    assert a.reflect(n).dtype == object
    assert same(a.reflect(n), a - 2 * a.dot(n) / n.norm_squared() * n)
    assert same(a.wedge(e1).reflect(n).reflect(n), a.wedge(e1))
    spacetime = ph.algebra(1, 3)
    t, x, _, _ = spacetime.basis_vectors
    assert same((2 * t + x).reflect(t), x - 2 * t)
    assert same((2 * t + x).reflect(x), 2 * t - x)
    with pytest.raises(ValueError, match="inverse"):
        x.reflect(t + x)


# --- axial vectors


@given(bivectors)
def test_axial_vectors_are_duals(B):
    assert same(ph.axial(B), B.dual())
    assert same(ph.from_axial(ph.axial(B)), B)


@given(vectors, vectors)
def test_planes_of_axial_vectors(a, b):
    assert same(ph.from_axial(a), I * a)
    assert same(ph.axial(a.wedge(b)), ph.cross(a, b))


@pytest.mark.parametrize("shape", SHAPES)
def test_axial_vectors_of_arrays(shape):
    array = np.random.default_rng(1).standard_normal((*shape, 3))
    assert same(ph.axial(array), ph.vector(array))
    assert same(ph.from_axial(array), ph.bivector(array))
    assert ph.axial(array).grades == (1,)
    assert ph.from_axial(array).grades == (2,)
    exact = ph.vector([Fraction(1, 3)] * 3)
    assert ph.from_axial(exact).dtype == object
    assert same(ph.axial(ph.from_axial(exact)), exact)
    with pytest.raises(TypeError, match="the plane must be a bivector"):
        ph.axial(e1)
    with pytest.raises(TypeError, match="the axial vector must be a vector"):
        ph.from_axial(I)
    with pytest.raises(ValueError, match="3 components"):
        ph.axial([1, 2])


# --- distances


def exact_distance(R, S):
    """The angle between the attitudes of these components, to 60 digits."""
    with mpmath.workdps(60):
        r, s = ([mpmath.mpf(float(x)) for x in X.components] for X in (R, S))
        dot = sum(x * y for x, y in zip(r, s, strict=True))
        # |r|²|s|² − (r·s)² as a sum of squares of the minors.
        minors = sum((r[i] * s[j] - r[j] * s[i]) ** 2 for i in range(4) for j in range(i))
        return 2 * mpmath.atan2(mpmath.sqrt(minors), abs(dot))


@given(rotors, directions, angles)
def test_distances_are_accurate_near_0_and_pi(R, plane, angle):
    S = R * ph.Rotor.from_plane_angle(ph.bivector(plane), angle)
    found, exact = R.distance(S), exact_distance(R, S)
    # Near 0 the difference S ∓ R is exact; the error is at most the rounding of the norms.
    assert abs(found - exact) <= 8 * EPS * (exact + EPS)
    assert isinstance(found, float)
    assert 0 <= found <= np.pi


@given(rotors, rotors, rotors)
def test_distance_is_an_invariant_metric(Q, R, S):
    assert R.distance(R) == 0
    assert R.distance(-R) == 0
    assert abs(R.distance(S) - S.distance(R)) <= 16 * EPS
    assert R.distance(S) == R.distance(-S) == (-R).distance(S)
    assert Q.distance(S) <= Q.distance(R) + R.distance(S) + 32 * EPS
    assert abs((Q * R).distance(Q * S) - R.distance(S)) <= 64 * EPS


def test_distances_of_other_arrays_have_derivatives():
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        v = jax.numpy.asarray([[0.1, 0.2, 0.3], [0.0, 0.0, 6.0]])

        def distance(x):
            return ph.Rotor.from_rotation_vector(x).distance(ph.Rotor.identity())

        found = jax.jit(jax.vmap(distance))(v)
        assert np.all(abs(found - np.array([np.sqrt(0.14), 2 * np.pi - 6])) <= 16 * EPS)
        assert np.all(abs(jax.grad(distance)(v[0]) - v[0] / np.sqrt(0.14)) <= 16 * EPS)
        assert np.all(jax.grad(distance)(np.zeros(3)) == 0)
        R, S = ph.Rotor.from_rotation_vector(v), ph.Rotor.random(2, 1)
        native = ph.Rotor.from_rotation_vector(np.array(v)).distance(S)
        assert np.all(abs(R.distance(S) - native) <= 16 * EPS)


def test_distances_over_batches():
    R, S = ph.Rotor.random((3, 1), 1), ph.Rotor.random((2,), 2)
    apart = R.distance(S)
    assert apart.shape == (3, 2)
    assert apart[2, 1] == R[2, 0].distance(S[1])
    theirs = (~R[0, 0] * S[0]).to_scipy().magnitude()
    assert abs(apart[0, 0] - theirs) <= 16 * EPS * np.pi
    single = R.astype(np.float32)
    # Rounding of four components, each to half of 2⁻²³.
    assert np.all(single.distance(R) <= 4 * 2.0**-23)
    assert single.distance(R).dtype == np.float64
    with pytest.raises(TypeError, match="distance needs another rotor, got float"):
        R.distance(1.0)
