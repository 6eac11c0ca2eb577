"""Factors of blades, reciprocal frames and the nearest rotation to a matrix."""

import functools
import operator
from fractions import Fraction

import jax.numpy as jnp
import numpy as np
import pytest
import sympy
from scipy.spatial.transform import Rotation

import polhode as ph
from polhode import I, e1, e2, e3
from values import EPS

SIGNATURES = [(2,), (3,), (5,), (1, 3), (3, 0, 1), (2, 2), (0, 3), (1, 0, 2)]


def wedge(vectors):
    return functools.reduce(operator.xor, vectors)


# --- factors


@pytest.mark.parametrize("signature", SIGNATURES)
def test_the_product_of_the_factors_is_the_blade(signature):
    A = ph.algebra(*signature)
    rng = np.random.default_rng(60)
    for k in range(1, A.dimension + 1):
        for size in (1.0, 1e-150, 1e150):
            rows = rng.normal(size=(k, 4, A.dimension))
            rows[0] *= size
            B = wedge([A.vector(row) for row in rows])
            factors = B.factor()
            assert len(factors) == k
            assert all(a.grades == (1,) and a.shape == (4,) for a in factors)
            # Rounding of k products and of the decomposition, beside the lengths of the given vectors.
            bound = 100 * EPS * np.prod([np.linalg.norm(row, axis=-1) for row in rows], axis=0)
            for found in (wedge(factors), functools.reduce(operator.mul, factors).grade(k)):
                assert np.all(np.abs((found - B).components).max(axis=-1) <= bound)
            for i, a in enumerate(factors):
                assert i == 0 or np.allclose(np.linalg.norm(a.components, axis=-1), 1, atol=16 * EPS)
                for b in factors[:i]:
                    length = np.linalg.norm(b.components, axis=-1)
                    assert np.all(np.abs((a | b).components[..., 0]) <= 100 * EPS * length)


def test_factors_of_basis_blades_are_basis_vectors():
    assert (3 * (e1 ^ e2)).factor() == (3 * e1, e2)
    assert (e3 ^ e1).factor() == (e3, e1)
    assert (-2 * I).factor() == (-2 * e1, e2, e3)
    assert (-e2).factor() == (-e2,)
    for signature in SIGNATURES:
        A = ph.algebra(*signature)
        for name, blade in A.blades.items():
            if name != "1":
                assert functools.reduce(operator.mul, blade.factor()) == blade


def test_the_first_factors_are_projections_of_the_basis():
    B = ph.bivector([[1.0, 2, 3], [-5, 1, 2], [1, 4, -2]])
    axes = [(e1, e2), (e2, e3), (e3, e1)]  # of the largest component of each
    for row, (x, y) in zip(B, axes, strict=True):
        a, b = row.factor()
        # The projections of both axes on the plane, the second one perpendicular to the first.
        first = x.project(row)
        second = y.project(row) - y.project(row).project(first)
        assert (a.normalized() ^ first).norm() <= 8 * EPS
        assert b.is_close(second.normalized(), atol=8 * EPS)


@pytest.mark.parametrize("signature", [(3,), (1, 3), (3, 0, 1)])
def test_blades_of_a_batch_are_factored_by_themselves(signature):
    A = ph.algebra(*signature)
    e, rng = A.basis_vectors, np.random.default_rng(61)
    blades = [e[0] ^ e[1], A.vector(rng.normal(size=A.dimension)) ^ A.vector(rng.normal(size=A.dimension))]
    for together, *alone in zip(ph.stack(blades).factor(), *(B.factor() for B in blades), strict=True):
        assert together.is_close(ph.stack(alone), atol=4 * EPS).all()


def test_single_precision_and_values_of_one_grade():
    B = ph.bivector(np.float32([0.1, 0.2, 0.3]))
    a, b = B.factor()
    assert a.dtype == b.dtype == np.float32
    assert (a ^ b).is_close(B, rtol=1e-6)
    assert len((2 * e1 * e2).factor()) == 2  # its scalar is 0


def test_errors_of_factors():
    A = ph.algebra(4)
    for value in (1 + e1, ph.scalar(2.0), ph.Rotor.from_plane_angle(e1 ^ e2, 1)):
        with pytest.raises(ValueError, match="needs a blade of one grade >= 1"):
            value.factor()
    with pytest.raises(ValueError, match="is zero or not finite"):
        (0 * e1).factor()
    with pytest.raises(ValueError, match=r"at index \(1,\) is not a blade"):
        ph.stack([A.blades["e12"], A.blades["e12"] + 1e-3 * A.blades["e34"]]).factor()
    with pytest.raises(TypeError, match=r"needs NumPy floats.*astype\(float\)"):
        (Fraction(1, 3) * e1).factor()


# --- reciprocal frames


@pytest.mark.parametrize("signature", SIGNATURES)
def test_reciprocal_vectors(signature):
    A = ph.algebra(*signature)
    rng = np.random.default_rng(61)
    regular = A.dimension - A.signature[2]
    for k in range(1, regular + 1):
        frame = [A.vector(row) for row in rng.normal(size=(k, 5, A.dimension))]
        reciprocal = ph.reciprocal_frame(frame)
        size = max(np.abs(b.components).max() for b in reciprocal)
        for i, b in enumerate(reciprocal):
            assert np.all(b.reject(wedge(frame)).is_close(0, atol=1e-11 * size))
            for j, a in enumerate(frame):
                # Near a null direction the reciprocal vectors are large.
                assert np.allclose((a | b).components[..., 0], i == j, rtol=0, atol=1e-13 * max(size, 1) ** 2)


def test_reciprocal_frames_of_other_coefficients():
    assert ph.reciprocal_frame([e1, e1 + e2, e1 + e2 + e3]) == (e1 - e2, e2 - e3, e3)
    assert ph.reciprocal_frame(ph.vector(np.eye(3))) == (e1, e2, e3)
    assert ph.reciprocal_frame([Fraction(1, 3) * e1])[0] == 3 * e1
    x = sympy.Symbol("x", positive=True)
    first, second = ph.reciprocal_frame([e1, x * e1 + e2])
    assert first.map(sympy.simplify) == e1 - x * e2
    assert second.map(sympy.simplify) == e2
    assert ph.reciprocal_frame([ph.vector(jnp.array([2.0, 0, 0]))])[0]["e1"] == 0.5
    # The lattice of a crystal in metres.
    cell = [3e-10 * e1, 4e-10 * e2, 5e-10 * e3 + 1e-10 * e1]
    assert (ph.reciprocal_frame(cell)[2] | cell[2]).is_close(1, rtol=8 * EPS)


def test_vectors_at_a_small_angle_are_a_frame():
    narrow = [e1, e1 + 1e-9 * e2]
    first, second = ph.reciprocal_frame(narrow)
    assert second.is_close(1e9 * e2, rtol=8 * EPS)
    assert (first | narrow[1]).is_close(0, atol=8 * EPS)


def test_errors_of_reciprocal_frames():
    with pytest.raises(ValueError, match="linearly dependent"):
        ph.reciprocal_frame([0 * e1])
    with pytest.raises(ValueError, match="linearly dependent"):
        ph.reciprocal_frame([e1, e2, e1 + 2 * e2])
    with pytest.raises(ValueError, match=r"vectors at index \(1,\) are linearly dependent"):
        ph.reciprocal_frame([e1, ph.vector([[0.0, 1, 0], [1, 0, 0]])])
    with pytest.raises(ValueError, match="at most 3"):
        ph.reciprocal_frame([e1, e2, e3, e1])
    with pytest.raises(ValueError, match="at least one"):
        ph.reciprocal_frame([])
    with pytest.raises(TypeError, match="item 1 is list; wrap arrays"):
        ph.reciprocal_frame([e1, [0, 1, 0]])
    with pytest.raises(TypeError, match="item 0 is e1∧e2"):
        ph.reciprocal_frame([e1 ^ e2])
    null = ph.algebra(1, 1).vector([1, 1])
    with pytest.raises(ValueError, match="no inverse"):
        ph.reciprocal_frame([null])


# --- the nearest rotation


def test_the_nearest_rotation():
    rng = np.random.default_rng(62)
    R = ph.Rotor.random(50, rng=rng)
    noisy = R.to_matrix() + 0.2 * rng.normal(size=(50, 3, 3))
    found = ph.Rotor.from_matrix(noisy, nearest=True)
    # SciPy minimises the same sum over the rows: Q = argmin Σ |M e_k − Q e_k|².
    for M, Q in zip(noisy, found, strict=True):
        peer, _ = Rotation.align_vectors(M.T, np.eye(3))
        assert np.allclose(Q.to_matrix(), peer.as_matrix(), rtol=0, atol=1e-12)
    distance = np.sum((noisy - found.to_matrix()) ** 2, axis=(-2, -1))
    for turn in ph.Rotor.random(20, rng=rng) ** 0.05:
        assert np.all(distance <= np.sum((noisy - (turn * found).to_matrix()) ** 2, axis=(-2, -1)))


def test_the_nearest_rotation_to_a_rotation_is_itself():
    R = ph.Rotor.random(20, rng=1)
    for scale in (1.0, 1e-200, 1e200):
        assert np.all(ph.Rotor.from_matrix(scale * R.to_matrix(), nearest=True).distance(R) < 16 * EPS)
    # A reflection flips its smallest axis.
    assert ph.Rotor.from_matrix(np.diag([3.0, 2, -1]), nearest=True) == 1
    single = ph.Rotor.from_matrix(R.to_matrix().astype(np.float32), nearest=True)
    assert single.dtype == np.float32
    with pytest.raises(ValueError, match="rotation"):
        ph.Rotor.from_matrix(np.diag([3.0, 2, 1]))


def test_errors_of_the_nearest_rotation():
    for rows, words in (
        (np.diag([1.0, 0, 0]), "is not unique: it is a matrix of singular values"),
        (np.diag([1.0, 1, -1]), "is not unique: it is a reflection of singular values"),
        (np.zeros((3, 3)), "is not unique"),
        (np.full((3, 3), np.nan), "NaN or infinite"),
    ):
        with pytest.raises(ValueError, match=words):
            ph.Rotor.from_matrix(rows, nearest=True)
        with pytest.raises(ValueError, match=r"at index \(1,\)"):
            ph.Rotor.from_matrix([np.eye(3), rows], nearest=True)
    with pytest.raises(TypeError, match="needs NumPy floats"):
        ph.Rotor.from_matrix(np.eye(3, dtype=object) * Fraction(1, 3), nearest=True)
