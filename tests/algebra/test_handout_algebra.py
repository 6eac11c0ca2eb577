"""Section 1 of the handout, the algebra: each numbered equation."""

from itertools import permutations, product

import numpy as np
import pytest

import polhode as ph
from handout import B1, B2, B3, BASIS, B, M, N, a, b, c, e12, e23, e31, same
from polhode import I, e1, e2, e3


def epsilon(i, j, k):
    """ε_ijk for indices from 0."""
    return (i - j) * (j - k) * (k - i) // 2


def test_eq_1_4_basis_of_eight_elements_graded_1_3_3_1():
    elements = [ph.scalar(1.0), e1, e2, e3, e23, e31, e12, e1 * e2 * e3]
    table = np.array(
        [sum((m.grade(k) for k in range(4)), ph.multivector([0.0] * 8)).components for m in elements]
    )
    assert np.array_equal(table, np.eye(8))
    assert [len(ph.multivector([1.0] * 8).grade(k).components) for k in range(4)] == [1, 3, 3, 1]


def test_eq_1_1_bivector_times_vector_is_the_volume():
    assert same(e1.wedge(e2) * e3, e1 * e2 * e3)


def test_eq_1_2_wedge_is_associative():
    assert same(a.wedge(b).wedge(c), a.wedge(b.wedge(c)))


def test_eq_1_3_wedge_of_vectors_is_antisymmetric():
    assert same(a.wedge(b).wedge(c), -b.wedge(a).wedge(c))
    assert same(a.wedge(b).wedge(c), c.wedge(a).wedge(b))


def test_eq_1_5_basis_bivectors_square_to_minus_one():
    for plane in (e12, e23, e31):
        assert plane * plane == -1


def test_eq_1_6_unit_bivector_turns_vectors_in_its_plane():
    assert e1 * e1.wedge(e2) == e2
    assert e2 * e1.wedge(e2) == -e1


def test_eq_1_7_vector_splits_into_parallel_and_perpendicular():
    plane = e12 * 3
    parallel, perpendicular = a.project(plane), a.reject(plane)
    assert same(parallel + perpendicular, a)
    assert same(parallel.wedge(plane), 0)
    assert same(perpendicular.dot(plane), 0)


def test_eq_1_8_parallel_part_times_the_plane_is_a_vector():
    parallel = 3 * e1 + 4 * e2
    b_in_plane = 8 * e1 - 6 * e2  # perpendicular to it
    plane = parallel.wedge(b_in_plane)
    assert parallel * plane == 25 * b_in_plane
    assert (parallel * plane).grade(3) == 0


def test_eq_1_9_perpendicular_part_times_the_plane_is_a_trivector():
    parallel, b_in_plane, perpendicular = 3 * e1 + 4 * e2, 8 * e1 - 6 * e2, 5 * e3
    plane = parallel.wedge(b_in_plane)
    assert perpendicular * plane == perpendicular.wedge(parallel).wedge(b_in_plane)
    assert (perpendicular * plane).grade(1) == 0


def test_eq_1_10_vector_times_bivector_is_dot_plus_wedge():
    assert same(a * B, a.dot(B) + a.wedge(B))
    assert a.dot(B).grades == (1,)
    assert a.wedge(B).grades == (3,)


@pytest.mark.parametrize(("r", "s"), list(product(range(4), repeat=2)))
def test_eq_1_10_dot_is_the_lowest_grade_wedge_the_highest(r, s):
    full = M.grade(r) * N.grade(s)
    assert same(M.grade(r).dot(N.grade(s)), full.grade(abs(r - s)))
    assert same(M.grade(r).wedge(N.grade(s)), full.grade(r + s) if r + s <= 3 else 0)


def test_eq_1_11_dot_with_a_bivector_is_antisymmetric():
    assert same(a.dot(B), -B.dot(a))


def test_eq_1_12_wedge_with_a_bivector_is_symmetric():
    assert same(a.wedge(B), B.wedge(a))


def test_eq_1_13_dot_and_wedge_from_products():
    assert same(a.dot(B), (a * B - B * a) / 2)
    assert same(a.wedge(B), (a * B + B * a) / 2)


def test_eq_1_14_product_of_two_planes():
    assert e1.wedge(e2) * e2.wedge(e3) == e1 * e3


def test_eq_1_15_planes_do_not_commute():
    assert e2.wedge(e3) * e1.wedge(e2) == -(e1 * e3)


def test_eq_1_16_basis_bivectors_are_the_dual_basis():
    assert [list(p.grade(2).components) for p in (B1, B2, B3)] == [[1, 0, 0], [0, 1, 0], [0, 0, 1]]


def test_eq_1_17_commutators_of_the_basis_bivectors():
    planes = (B1, B2, B3)
    for i, j in product(range(3), repeat=2):
        expected = sum((-2 * epsilon(i, j, k) * planes[k] for k in range(3)), ph.scalar(0.0))
        assert planes[i] * planes[j] - planes[j] * planes[i] == expected
        assert 2 * planes[i].commutator(planes[j]) == expected


def test_quaternion_units_are_minus_the_basis_bivectors():
    i, j, k = -B1, -B2, -B3
    for unit in (i, j, k):
        assert unit * unit == -1
    assert i * j == k
    assert j * k == i
    assert k * i == j
    assert i * j * k == -1


def test_basis_bivectors_themselves_multiply_the_other_way():
    assert B1 * B2 == -B3
    assert B1 * B2 * B3 == 1


def test_quaternion_and_its_rotor():
    # A unit quaternion with exact components: (1 + 1 + 1 + 1)/4 = 1.
    w, i, j, k = 0.5, -0.5, 0.5, 0.5
    expected = w - i * B1 - j * B2 - k * B3
    assert ph.Rotor.from_quaternion([w, i, j, k], order="wxyz") == expected
    assert ph.Rotor.from_quaternion([i, j, k, w], order="xyzw") == expected


def test_quaternion_product_is_the_rotor_product():
    # Hamilton's rule, written out; 1/2 and signs keep it exact.
    p, q = np.array([0.5, 0.5, -0.5, 0.5]), np.array([0.5, -0.5, -0.5, -0.5])
    w, v, t, u = p[0], p[1:], q[0], q[1:]
    pq = [w * t - v @ u, *(w * u + t * v + np.cross(v, u))]
    rotors = [ph.Rotor.from_quaternion(value, order="wxyz") for value in (p, q, pq)]
    assert rotors[0] * rotors[1] == rotors[2]


def test_eq_1_18_and_1_22_pseudoscalar():
    assert e1 * e2 * e3 == I
    assert I * I == -1


def test_eq_1_18_right_handed_frames_have_volume_plus_I():
    for i, j, k in permutations(range(3)):
        assert BASIS[i] * BASIS[j] * BASIS[k] == epsilon(i, j, k) * I


def test_eq_1_19_vector_times_pseudoscalar_is_the_perpendicular_plane():
    assert e1 * I == e23
    assert I * e1 == e23


def test_eq_1_20_duality():
    assert e12 == I * e3
    assert e23 == I * e1
    assert e31 == I * e2


def test_dual_and_undual_have_the_signs_of_the_axial_vector():
    for plane, axis in zip((B1, B2, B3), BASIS, strict=True):
        assert plane.dual() == axis
        assert axis.undual() == plane
        assert axis.dual() == -plane
    assert same(M.dual(), M * -I)
    assert same(M.undual(), M * I)
    assert same(a.wedge(b).dual(), ph.cross(a, b))


def test_eq_1_21_pseudoscalar_commutes_and_product_is_the_dot():
    assert same(a * I, I * a)
    assert same(a * I, a.dot(I))


def test_pseudoscalar_commutes_with_everything():
    assert same(M * I, I * M)


def test_in_two_dimensions_the_pseudoscalar_anticommutes_with_vectors():
    in_plane = a.project(e12)
    assert same(in_plane * e12, -(e12 * in_plane))


def test_eq_1_23_pseudoscalar_times_plane():
    assert I * e1.wedge(e2) == -e3


def test_eq_1_24_cross_product():
    assert same(ph.cross(a, b), -I * a.wedge(b))
    assert np.array_equal(ph.cross(a, b).components, np.cross(a.components, b.components))


def test_eq_1_25_reverse_of_a_plane():
    assert ~e12 == -e12
    assert ~(e1 * e2) == e2 * e1


def test_eq_1_26_reverse_of_the_pseudoscalar():
    assert ~I == -I
    assert ~(e1 * e2 * e3) == e3 * e2 * e1


def test_eq_1_27_and_1_28_reverse_of_a_general_element():
    parts = [M.grade(k) for k in range(4)]
    assert same(M, parts[0] + parts[1] + parts[2] + parts[3])
    assert same(~M, parts[0] + parts[1] - parts[2] - parts[3])
    assert same(~(M * N), ~N * ~M)


def test_eq_1_29_pauli_algebra_of_the_basis():
    for i, j in product(range(3), repeat=2):
        expected = sum((epsilon(i, j, k) * (I * BASIS[k]) for k in range(3)), ph.scalar(float(i == j)))
        assert BASIS[i] * BASIS[j] == expected


def test_eq_1_29_pauli_matrices_represent_the_algebra():
    sigma = [np.array(m) for m in ([[0, 1], [1, 0]], [[0, -1j], [1j, 0]], [[1, 0], [0, -1]])]
    for vector, matrix in zip(BASIS, sigma, strict=True):
        assert np.array_equal(ph.to_pauli(vector), matrix)
    assert np.array_equal(ph.to_pauli(I), 1j * np.eye(2))
    assert np.array_equal(ph.to_pauli(M * N), ph.to_pauli(M) @ ph.to_pauli(N))


def test_eq_1_29_pauli_matrices_are_faithful():
    assert same(ph.from_pauli(ph.to_pauli(M)), M)
