"""Section 2 of the handout, rotations: each numbered equation."""

import numpy as np
import pytest

import polhode as ph
from handout import EPS, M, N, a, b, close, e12, same
from naive import magnitude
from polhode import e1, e2, e3

ANGLES = [0.0, 1e-9, 0.3, np.pi / 2, 2.5, np.pi, 4.0, 2 * np.pi, -1.7, 9.0]


def rotor(plane, angle):
    """e^(−Bθ/2) by the exponential."""
    return (plane * (-angle / 2)).grade(2).exp()


@pytest.mark.parametrize("angle", ANGLES)
def test_eq_2_1_rotation_in_a_plane_three_ways(angle):
    in_plane = a.project(e12)
    one_sided = (e12.grade(2) * -angle).exp()
    half = rotor(e12, angle)
    size = magnitude(in_plane)
    assert close(one_sided * in_plane, in_plane * ~one_sided, size)
    assert close(one_sided * in_plane, half * in_plane * ~half, size)
    u, v, _ = in_plane.components.T
    turned = np.stack(
        [u * np.cos(angle) - v * np.sin(angle), u * np.sin(angle) + v * np.cos(angle), 0 * u], axis=-1
    )
    assert close(half * in_plane * ~half, ph.vector(turned), size)


@pytest.mark.parametrize("angle", ANGLES)
def test_eq_2_2_the_plane_commutes_with_its_normal(angle):
    one_sided = (e12.grade(2) * -angle).exp()
    assert same(one_sided * e3, e3 * one_sided)


@pytest.mark.parametrize("angle", ANGLES)
def test_eq_2_3_only_the_two_sided_form_keeps_the_normal(angle):
    half = rotor(e12, angle)
    assert close(half * e3 * ~half, e3)
    one_sided = half * half
    # |e^(−Bθ) e3 − e3| = |e^(−Bθ) − 1| = 2 |sin θ/2|.
    moved = magnitude(one_sided * e3 - e3)
    assert abs(moved - 2 * abs(np.sin(angle / 2))) <= 16 * EPS


def rodrigues(axis, angle, v):
    """The axis–angle (Rodrigues) formula, right-handed about a unit axis."""
    along = np.sum(axis * v, axis=-1, keepdims=True) * axis
    return along + (v - along) * np.cos(angle) + np.cross(axis, v) * np.sin(angle)


@pytest.mark.parametrize("angle", ANGLES)
def test_eq_2_4_rotor_turns_by_the_angle_in_the_sense_of_the_plane(angle):
    plane = ph.bivector([2.0, -1.0, 2.0]) / 3
    assert close(plane * plane, -1)
    R = rotor(plane, angle)
    expected = ph.vector(rodrigues(plane.dual().components, angle, a.components))
    assert close(R * a * ~R, expected, magnitude(a))
    assert close(R(a), expected, magnitude(a))
    assert close(ph.Rotor.from_plane_angle(5 * plane, angle), R)


def test_eq_2_4_sense_quarter_turn_in_e12_takes_e1_to_e2():
    R = rotor(e1.wedge(e2), np.pi / 2)
    assert close(R(e1), e2)
    assert close(R(e2), -e1)


def test_eq_2_5_rotors_are_unit_and_even():
    R = ph.Rotor.random((50,), 9)
    assert R.grades == (0, 2)
    assert close(R * ~R, 1)
    assert close(~R * R, 1)
    assert R.components.shape == (50, 4)  # four numbers, one constraint


def test_eq_2_5_bivectors_give_all_three_degrees_of_freedom():
    R = ph.Rotor.random((50,), 10)
    assert close(R.log().exp(), R)
    assert R.log().grades == (2,)


def test_eq_2_6_bivectors_turn_by_the_same_formula():
    R = ph.Rotor.random((50,), 11)
    size = magnitude(a) * magnitude(b)
    assert close(R * a.wedge(b) * ~R, R(a).wedge(R(b)), size, 32)
    assert close(R(a.wedge(b)), R(a).wedge(R(b)), size, 32)


def test_eq_2_6_every_multivector_turns_by_the_same_formula():
    R = ph.Rotor.random((50,), 12)
    assert close(R(M * N), R(M) * R(N), magnitude(M) * magnitude(N), 64)
    assert close(R(M), R * M * ~R, magnitude(M))
