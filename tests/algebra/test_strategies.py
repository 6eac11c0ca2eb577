"""The Hypothesis strategies: types, coverage of special cases, shrinking to simple values."""

import sys

import numpy as np
import pytest
from hypothesis import find, given, settings
from hypothesis import strategies as st
from hypothesis.errors import NoSuchExample

import polhode as ph
import processes
from polhode import e1, e2, e3
from polhode import strategies as ga

CGA = ph.algebra(4, 1)
QUICK = settings(max_examples=2000, derandomize=True, database=None)


def least(strategy, condition):
    """The smallest example of a condition."""
    return find(strategy, condition, settings=QUICK)


# --- types


@given(ga.vectors(), ga.bivectors(), ga.trivectors(), ga.scalars())
def test_values_of_one_grade(a, B, T, s):
    assert [M.grades for M in (a, B, T, s)] == [(1,), (2,), (3,), (0,)]
    assert all(
        M.shape == () and M.dtype == np.float64 and np.isfinite(M.components).all() for M in (a, B, T, s)
    )


@given(ga.multivectors(), ga.multivectors((2, 0)), ga.multivectors(algebra=CGA, shape=(2, 1)))
def test_multivectors(M, even, C):
    assert set(M.grades) <= {0, 1, 2, 3}
    assert even.grades == (0, 2)
    assert C.algebra is CGA
    assert C.shape == (2, 1)


@given(st.data())
def test_batch_shapes(data):
    shape = data.draw(ga.batch_shapes())
    assert len(shape) <= 2
    assert data.draw(ga.vectors(shape=shape)).shape == shape
    assert data.draw(ga.rotors(shape=shape)).shape == shape
    assert data.draw(ga.vectors(shape=3)).shape == (3,)
    assert len(data.draw(ga.vectors(shape=ga.batch_shapes())).shape) <= 2


@given(ga.vectors(floats=ga.components(10)), ga.vectors(floats=st.floats(1, 2)), ga.components(1))
def test_components_have_bounds(a, b, unit):
    assert unit in (-1, 0, 1)
    size = np.abs(a.components)
    assert np.all((size == 0) | ((size >= 0.1) & (size <= 10)))
    assert np.all((b.components >= 1) & (b.components <= 2))


@given(ga.rotors(), ga.rotors(near_singular=True), ga.vectors())
def test_rotors_are_rotors(R, S, a):
    assert isinstance(R, ph.Rotor)
    assert abs(np.linalg.norm(R.components) - 1) <= 4e-16
    # Two products of four terms: 12 roundings.
    assert abs((S * R)(a).norm() - a.norm()) <= 24 * 2**-53 * a.norm()
    angle = S.plane_angle()[1]
    assert min(abs(angle - k) for k in (0, np.pi, 2 * np.pi)) <= 0.1 + 1e-15


# --- coverage


@pytest.mark.parametrize("grades", [(0,), (1,), (0, 2), (0, 1, 2, 3)])
def test_all_grades_occur(grades):
    assert least(ga.multivectors(), lambda M: M.grades == grades).grades == grades


@pytest.mark.parametrize("angle", [0.0, np.pi, 2 * np.pi])
@pytest.mark.parametrize("distance", [0.0, pytest.param(1e-12, marks=pytest.mark.slow)])
def test_rotors_near_singular_angles_occur(angle, distance):
    def near(R):
        return 0 < abs(R.plane_angle()[1] - angle) <= distance or (
            distance == 0 and R.plane_angle()[1] == angle
        )

    least(ga.rotors(), near)


@pytest.mark.slow
def test_empty_batches_occur():
    assert least(ga.vectors(shape=ga.batch_shapes()), lambda a: 0 in a.shape).shape == (0,)
    with pytest.raises(NoSuchExample):
        least(ga.vectors(shape=ga.batch_shapes(min_side=1)), lambda a: 0 in a.shape)


# --- simple counterexamples


@pytest.mark.slow
def test_shrinking():
    assert least(ga.vectors(), lambda a: True) == 0 * e1
    assert least(ga.vectors(), lambda a: a.dot(e2) != 0) == e2
    assert least(ga.multivectors((1, 2)), lambda M: (M * M).grade(3) != 0).norm_squared() == 2
    assert least(ga.rotors(), lambda R: True) == 1
    turned = least(ga.rotors(), lambda R: R(e1) != e1)
    assert np.count_nonzero(np.abs(turned.components) > 1e-9) <= 2
    assert least(ga.vectors(shape=ga.batch_shapes()), lambda a: len(a.shape) == 1 and len(a) > 0).shape == (
        1,
    )


# --- errors


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ga.multivectors((4,)), r"Cl\(3\) has grades 0 to 3, got \[4\]"),
        (lambda: ga.multivectors(()), r"grades 0 to 3, got \[\]"),
        (lambda: ga.trivectors(ph.algebra(2)), r"Cl\(2\) has grades 0 to 2, got \[3\]"),
        (lambda: ga.components(0.5), "must be finite and >= 1, got 0.5"),
        (lambda: ga.components(float("inf")), "must be finite"),
        (lambda: ga.components(float("nan")), "must be finite"),
    ],
)
def test_invalid_arguments_raise(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_the_package_does_not_import_hypothesis():
    code = (
        "import sys, polhode; assert 'hypothesis' not in sys.modules and not hasattr(polhode, 'strategies')"
    )
    processes.run([sys.executable, "-c", code], check=True)


def test_a_missing_hypothesis_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "hypothesis.strategies", None)
    monkeypatch.delitem(sys.modules, "polhode.strategies")
    with pytest.raises(
        ImportError, match=r"polhode.strategies needs hypothesis: pip install 'polhode\[hypothesis\]'"
    ):
        import polhode.strategies  # noqa: F401


def test_rotations_in_e12_leave_e3_unchanged():
    @given(ga.angles())
    def law(angle):
        R = ph.Rotor.from_plane_angle(e1 ^ e2, angle)
        assert (R(e3) - e3).norm() <= 4e-16

    law()
