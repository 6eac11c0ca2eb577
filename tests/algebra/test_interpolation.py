"""Slerp and the mean attitude."""

import numpy as np
import pytest

import polhode as ph
from polhode import e1, e2, e3

EPS = np.finfo(float).eps


def test_slerp_turns_at_a_constant_rate():
    start = ph.Rotor.random(rng=1)
    end = ph.Rotor.from_plane_angle(e1 ^ e2, 2.0) * start
    for t in (-0.5, 0.0, 0.25, 1.0, 2.0):
        expected = ph.Rotor.from_plane_angle(e1 ^ e2, 2.0 * t) * start
        # The angle is known to a few roundings, and turns by t times as much.
        assert (ph.slerp(start, end, t) - expected).norm() <= 8 * EPS * (1 + abs(t))


def test_slerp_takes_the_shorter_way_for_any_signs():
    rotors = ph.Rotor.random(50, rng=2)
    a, b = rotors[:25], rotors[25:]
    half = ph.slerp(a, b, 0.5)
    for sign_a in (1, -1):
        for sign_b in (1, -1):
            turned = ph.slerp(a if sign_a > 0 else -a, b if sign_b > 0 else -b, 0.5)
            assert (turned(e1) - half(e1)).norm().max() <= 32 * EPS
    # The middle is equally far from both, at most a quarter turn.
    for other in (a, b):
        angle = (~half * other).plane_angle()[1]
        assert np.minimum(angle, 2 * np.pi - angle).max() <= np.pi / 2 + 8 * EPS


def test_slerp_broadcasts():
    start, end = ph.Rotor.identity(), ph.Rotor.from_plane_angle(e2 ^ e3, 1.0)
    path = ph.slerp(start, end, np.linspace(0, 1, 5))
    assert path.shape == (5,)
    assert path[0] == start
    assert path[4].is_close(end, rtol=4 * EPS)
    with pytest.raises(TypeError, match="slerp needs rotors"):
        ph.slerp(start, e1, 0.5)


def test_the_mean_ignores_signs_and_finds_the_middle():
    middle = ph.Rotor.random(rng=3)
    middle = middle if middle.components[0] >= 0 else -middle
    turns = [
        ph.Rotor.from_plane_angle(plane, angle)
        for plane in (e1 ^ e2, e2 ^ e3, e3 ^ e1)
        for angle in (0.3, -0.3)
    ]
    rotors = ph.Rotor.from_components(
        [(turn * middle).components * (-1) ** k for k, turn in enumerate(turns)]
    )
    assert (ph.mean(rotors) - middle).norm() <= 16 * EPS


def test_weights_pull_the_mean():
    a, b = ph.Rotor.identity(), ph.Rotor.from_plane_angle(e1 ^ e2, 1.0)
    pair = ph.Rotor.from_components([a.components, b.components])
    assert (ph.mean(pair) - ph.slerp(a, b, 0.5)).norm() <= 16 * EPS
    assert (ph.mean(pair, [0, 2]) - b).norm() <= 16 * EPS
    assert ph.mean(pair, [1, 3])(e1).dot(b(e1)).components > ph.mean(pair)(e1).dot(b(e1)).components


@pytest.mark.parametrize("size", [5e-324, 1e-310, 1e-200, 1e307])
def test_weights_of_any_size_give_the_same_mean(size):
    R = ph.Rotor.from_axis_angle(e3, [[10, 30, 40], [10, 30, -50]], degrees=True)
    w = np.array([1, 2, 1])
    assert (ph.mean(R, w * size, axis=1).distance(ph.mean(R, w, axis=1)) <= 8 * EPS).all()


def test_rotors_without_a_unique_mean_raise():
    half_turns = ph.Rotor.from_components(np.eye(4))
    with pytest.raises(ValueError, match="no mean"):
        ph.mean(half_turns)
    with pytest.raises(ValueError, match="weights"):
        ph.mean(half_turns, [1, -1, 1, 1])
    with pytest.raises(ValueError, match="at least one"):
        ph.mean(half_turns[:0])


def test_means_along_axes_are_those_of_rows():
    R, w = ph.Rotor.random((3, 4, 5), rng=10), np.random.default_rng(10).uniform(0, 1, (3, 4, 5))
    for weights in (None, w):
        of_rows = ph.mean(R, weights, axis=-1)
        assert of_rows.shape == (3, 4)
        for i in range(3):
            for j in range(4):
                alone = ph.mean(R[i, j], None if weights is None else w[i, j])
                # The error of eigenvectors is the rounding over the gap, here some hundredths.
                assert of_rows[i, j].is_close(alone, atol=512 * EPS)
        two = ph.mean(R, weights, axis=(0, 2))
        assert two.shape == (4,)
        expected = ph.mean(R[:, 1].reshape(15), None if weights is None else w[:, 1].reshape(15))
        assert two[1].is_close(expected, atol=512 * EPS)
    everything = ph.mean(R, w[0, 0])
    assert everything.is_close(ph.mean(R.reshape(60), np.tile(w[0, 0], 12)), atol=512 * EPS)
    single = ph.mean(R.astype(np.float32), axis=0)
    assert single.dtype == np.float32
    assert single.distance(ph.mean(R, axis=0)).max() < 1e-5


def test_means_over_no_axes_are_the_rotors():
    R = ph.Rotor.random((3, 4), rng=11)
    assert ph.mean(R, axis=()).distance(R).max() <= 8 * EPS
    assert ph.mean(R[0, 0]).distance(R[0, 0]) <= 8 * EPS


def test_means_of_lists_and_wrong_axes():
    a, b = ph.Rotor.random(2, rng=11)
    assert ph.mean([a, b]) == ph.mean(ph.stack([a, b]))
    R = ph.Rotor.random((3, 4), rng=11)
    for bad in (2, -3, (0, 0), (0, -2)):
        with pytest.raises(ValueError, match="does not name different axes of 2 batch axes"):
            ph.mean(R, axis=bad)
    with pytest.raises(ValueError, match=r"that broadcast to \(3, 4\), got shape \(3,\)"):
        ph.mean(R, [1, 2, 3])
    half_turns = ph.Rotor.from_components(np.stack([R.components[0], np.eye(4)]))
    with pytest.raises(ValueError, match=r"at index 1: .*no mean|at index \(1,\): .*no mean"):
        ph.mean(half_turns, axis=1)


def half_turns(count, seed):
    """Rotors, and turns by π in any planes."""
    planes = np.random.default_rng(seed).standard_normal((count, 3))
    return ph.Rotor.random(count, rng=seed), ph.Rotor.from_components(np.insert(planes, 0, 0.0, axis=-1))


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_slerp_over_half_a_turn_keeps_the_sign(dtype):
    start, half = (R.astype(dtype) for R in half_turns(20000, 5))
    quarter = half**0.5
    middle = ph.slerp(start, start * half, 0.5)
    assert middle.dtype == dtype
    # The angle of a half turn is known to some roundings, the middle to half of them.
    assert np.all(middle.distance(start * quarter) <= 32 * np.finfo(dtype).eps)
    back = ph.slerp(start, -(start * half), 0.5)
    assert np.all(back.distance(start * ~quarter) <= 32 * np.finfo(dtype).eps)
    # Beyond half a turn, by more than rounding, the other way is shorter.
    beyond = ph.Rotor.from_plane_angle(e1 ^ e2, np.pi + 1e-6)
    assert ph.slerp(start[0], start[0] * beyond, 0.5).distance(start[0]) <= np.pi / 2


def test_splines_over_half_turns_keep_the_signs():
    start, half = half_turns(2000, 6)
    for k in range(0, 2000, 20):
        spline = ph.RotorSpline(
            [0, 1], ph.Rotor.from_components([start[k].components, (start * half)[k].components])
        )
        assert spline(0.5).distance(start[k] * half[k] ** 0.5) <= 32 * EPS


def foreign(name):
    module = pytest.importorskip(name)
    return module.asarray


@pytest.mark.parametrize("name", ["jax.numpy", "array_api_strict"])
def test_means_keep_the_array_type(name):
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        asarray = foreign(name)
        rotors, w = ph.Rotor.random(30, rng=7), np.random.default_rng(7).uniform(0, 1, 30)
        theirs = ph.Rotor.from_components(asarray(rotors.components))
        for weights in (None, w):
            mean = ph.mean(theirs, None if weights is None else asarray(weights))
            assert type(mean.components) is type(asarray(w))
            # The error of eigenvectors is the rounding over the gap, here a tenth of the largest eigenvalue.
            assert np.allclose(np.asarray(mean.components), ph.mean(rotors, weights).components, 0, 64 * EPS)
            rows = ph.mean(
                theirs.reshape(5, 6), weights if weights is None else asarray(w.reshape(5, 6)), axis=1
            )
            expected = ph.mean(rotors.reshape(5, 6), weights if weights is None else w.reshape(5, 6), axis=1)
            assert np.allclose(np.asarray(rows.components), expected.components, 0, 512 * EPS)
        assert type(ph.mean(rotors, asarray(w)).components) is type(asarray(w))
        with pytest.raises(ValueError, match="no mean"):
            ph.mean(ph.Rotor.from_components(asarray(np.eye(4))))
        with pytest.raises(ValueError, match="weights must be finite numbers"):
            ph.mean(theirs, asarray(-w))
        half = ph.Rotor.from_components(asarray([0.0, 1.0, 0.0, 0.0]))
        assert np.all(
            np.asarray(ph.slerp(theirs, theirs * half, 0.5).distance(theirs * half**0.5)) <= 32 * EPS
        )
        with pytest.raises(TypeError, match="a spline needs NumPy floats"):
            ph.RotorSpline(np.arange(30.0), theirs)


def test_derivatives_of_the_mean():
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        rows = jax.numpy.asarray(ph.Rotor.random(6, rng=8).components)

        @jax.jit
        def mean(rows):
            return ph.mean(ph.Rotor.from_components(rows)).components

        expected = ph.mean(ph.Rotor.from_components(np.asarray(rows))).components
        assert np.allclose(mean(rows), expected, 0, 64 * EPS)
        direction = jax.numpy.asarray(np.random.default_rng(9).standard_normal((6, 4)))

        def along(s):
            return mean(rows + s * direction)

        h = 1e-4  # central differences err by h² and by ε/h, or ε/h²
        rate = jax.jacfwd(along)
        first, second = jax.jit(rate)(0.0), jax.jit(jax.jacfwd(rate))(0.0)
        assert np.allclose(first, (along(h) - along(-h)) / (2 * h), 0, 1e-5 * (1 + abs(first).max()))
        assert np.allclose(
            second, (along(h) - 2 * along(0.0) + along(-h)) / h**2, 0, 1e-4 * (1 + abs(second).max())
        )
        # Where the smaller eigenvalues agree, a library's derivatives of eigenvectors are NaN.
        same = jax.numpy.broadcast_to(rows[0], (3, 4))
        assert np.all(np.isfinite(jax.jit(jax.jacfwd(mean))(same)))


def test_means_of_exact_rotors_raise():
    from fractions import Fraction

    R = ph.Rotor.from_components(np.array([[Fraction(3, 5), Fraction(4, 5), 0, 0]], dtype=object))
    with pytest.raises(TypeError, match=r"convert exact numbers with \.astype\(float\)"):
        ph.mean(R)
    assert ph.mean(R.astype(float)).is_close(R.astype(float), rtol=4 * EPS)
