"""Running moments equal those of all numbers, for any blocks."""

import numpy as np
import pytest

import polhode as ph
from motions import EPS

VALUES = np.random.default_rng(3).normal(size=(1000, 4, 3)) + 100.0


def moments_of(blocks, axis=0):
    moments = ph.Moments(axis)
    for block in blocks:
        moments.add(block)
    return moments


@pytest.mark.parametrize("cuts", [[], [1], [1, 2, 3], [500], [0, 10, 10, 999]])
def test_results_are_independent_of_blocks(cuts):
    moments = moments_of(np.split(VALUES, cuts))
    assert np.all(moments.count == 1000)
    assert not moments.missing.any()
    # A sum of a thousand numbers, in one order or another.
    np.testing.assert_allclose(moments.mean, VALUES.mean(axis=0), rtol=32 * EPS)
    np.testing.assert_allclose(moments.variance, VALUES.var(axis=0), rtol=1e-12)
    np.testing.assert_allclose(moments.std, VALUES.std(axis=0), rtol=1e-12)
    assert np.array_equal(moments.minimum, VALUES.min(axis=0))
    assert np.array_equal(moments.maximum, VALUES.max(axis=0))


def test_two_are_merged():
    both = moments_of([VALUES[:300]]) + moments_of([VALUES[300:]])
    together = moments_of([VALUES[:300], VALUES[300:]])
    assert np.array_equal(both.mean, together.mean)
    assert np.array_equal(both.variance, together.variance)
    assert np.array_equal((both + ph.Moments()).mean, both.mean)
    assert np.array_equal((ph.Moments() + both).count, both.count)


def test_digits_survive_a_large_mean():
    """Of 1e9 + (0, 1, 2) the sum of squares keeps no digit of the variance 2/3; Chan's formulas do."""
    moments = moments_of([[1e9], [1e9 + 1], [1e9 + 2]])
    assert moments.variance == pytest.approx(2 / 3, rel=1e-6)


def test_nan_is_counted_apart():
    values = VALUES[:, 0, 0].copy()
    values[::10] = np.nan
    moments = moments_of(np.split(values, [5, 6, 7, 500]))
    assert moments.count == 900
    assert moments.missing == 100
    assert moments.mean == pytest.approx(np.nanmean(values), rel=1e-14)
    assert moments.variance == pytest.approx(np.nanvar(values), rel=1e-12)
    assert moments.minimum == np.nanmin(values)
    nothing = ph.Moments().add([np.nan, np.nan])
    assert nothing.missing == 2
    for result in (nothing.mean, nothing.variance, nothing.minimum, nothing.maximum):
        assert np.isnan(result)
    assert (nothing + moments).mean == moments.mean
    assert (moments + nothing).variance == moments.variance


def test_other_axes_and_multivectors():
    over_times = ph.Moments(axis=1).add(VALUES)
    np.testing.assert_allclose(over_times.mean, VALUES.mean(axis=1), rtol=8 * EPS)
    assert np.array_equal(over_times.minimum, VALUES.min(axis=1))
    assert np.array_equal(over_times.maximum, VALUES.max(axis=1))
    assert np.array_equal(ph.Moments().add(ph.vector(VALUES)).mean, ph.Moments().add(VALUES).mean)


def test_infinite_values_do_not_warn():
    moments = moments_of([[1.0, np.inf], [2.0]])
    assert moments.mean == np.inf
    assert np.isnan(moments.variance)


def test_incompatible_shapes_are_rejected():
    moments = ph.Moments()
    assert repr(moments) == "Moments(empty)"
    with pytest.raises(ValueError, match="add"):
        _ = moments.mean
    with pytest.raises(ValueError, match="axis 0"):
        moments.add(1.0)
    moments.add(np.zeros((5, 3)))
    assert repr(moments) == "Moments(of 5, shape (3,), 0 missing)"
    with pytest.raises(ValueError, match=r"\(4,\).*\(3,\)"):
        moments.add(np.zeros((5, 4)))
    with pytest.raises(TypeError):
        moments.add("text")
    for name in ("count", "missing", "mean", "variance", "std", "minimum", "maximum"):
        getattr(moments, name)[0] = 7
    assert [moments.count[0], moments.mean[0], moments.std[0], moments.maximum[0]] == [5, 0, 0, 0]


def test_means_far_apart_do_not_overflow():
    found = ph.Moments().add([1e308]).add([1.5e308]).add([-1.7e308])
    assert abs(found.mean / (0.8e308 / 3) - 1) <= 1e-14
    assert ph.Moments().add([1e308]).add([np.inf]).mean == np.inf
    assert ph.Moments().add([np.nan]).add([np.inf]).mean == np.inf
    assert np.isnan(ph.Moments().add([-np.inf]).add([np.inf]).mean)
