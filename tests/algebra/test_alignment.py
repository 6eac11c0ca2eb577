"""`align` against SciPy, perturbations, and directions that do not determine a rotation."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import polhode as ph
from polhode import Rotor, e1, e2, e3
from samples import EPS


def noisy(n, noise, seed=1, shape=()):
    """Vectors, a rotor, and the turned vectors with errors."""
    rng = np.random.default_rng(seed)
    a, R = rng.standard_normal((*shape, n, 3)), Rotor.random(shape, rng=rng)
    b = R[..., None](ph.vector(a)).components if shape else R(ph.vector(a)).components
    return a, R, b + noise * rng.standard_normal(b.shape)


def test_the_rotation_is_found():
    a, R, b = noisy(10, 0.0)
    found = ph.align(a, b)
    # The covariance of unit errors is about a tenth, so that errors of EPS of the vectors give less of R.
    assert found.rotor.distance(R) <= 16 * EPS
    assert found.residual <= 64 * EPS
    assert found.rotor.components[0] >= 0
    rotor, residual, covariance = ph.align(ph.vector(a), ph.vector(b))
    assert (rotor, residual) == (found.rotor, found.residual)
    assert covariance.shape == (3, 3)
    assert ph.align([e1, e2], [e2, -e1]).rotor.is_close(Rotor.from_axis_angle(e3, np.pi / 2), atol=4 * EPS)


@pytest.mark.parametrize("noise", [0.0, 0.01, 1.0])
@pytest.mark.parametrize("weighted", [False, True])
def test_scipy_agrees(noise, weighted):
    a, _, b = noisy(20, noise, seed=2)
    w = np.random.default_rng(2).uniform(0, 2, 20) if weighted else None
    found = ph.align(a, b, w)
    # SciPy takes the target first, and loses half the digits of a small residual.
    peer, residual, sensitivity = Rotation.align_vectors(b, a, w, return_sensitivity=True)
    assert found.rotor.distance(Rotor.from_scipy(peer)) <= 64 * EPS
    assert abs(found.residual - residual) <= 1e-6 if noise == 0 else 1e-12
    expected = sensitivity / (1 if w is None else w.mean())
    np.testing.assert_allclose(found.covariance, expected, rtol=0, atol=256 * EPS)


def test_the_residual_is_least():
    a, _, b = noisy(7, 0.3, seed=3)
    w = np.random.default_rng(3).uniform(0, 1, 7)
    found = ph.align(a, b, w)

    def cost(R):
        return (w * ((b - R(ph.vector(a)).components) ** 2).sum(axis=-1)).sum()

    assert abs(np.sqrt(cost(found.rotor)) - found.residual) <= 8 * EPS * found.residual
    h = 1e-4
    second = np.linalg.inv(found.covariance)
    for v in np.eye(3):
        more, less = (cost(Rotor.from_rotation_vector(s * h * v) * found.rotor) for s in (1, -1))
        # Half the cost has the slope 0 and the inverse covariance as curvature; third ones are some 10.
        assert abs(more - less) / (4 * h) <= 100 * h**2
        assert abs((more + less - 2 * cost(found.rotor)) / (2 * h * h) - v @ second @ v) <= 1e-4


def test_the_covariance_is_that_of_repeated_measurements():
    sigma, trials = 1e-3, 20_000
    a, R, b = noisy(4, 0.0, seed=4)
    rng = np.random.default_rng(4)
    measured = b + sigma * rng.standard_normal((trials, 4, 3))
    found = ph.align(a, measured, np.full(4, sigma**-2))
    errors = (found.rotor * ~R).to_rotation_vector()
    # The standard error of a variance is √(2/n) of it, here 1 %; five of them.
    expected = found.covariance[0]
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    assert np.abs((np.cov(errors.T) - expected) / scale).max() <= 5 * np.sqrt(2 / trials)


def test_batches_and_weights_broadcast():
    a, R, b = noisy(6, 0.0, seed=5, shape=(3, 2))
    found = ph.align(a, b)
    assert found.rotor.shape == (3, 2)
    assert found.residual.shape == (3, 2)
    assert found.covariance.shape == (3, 2, 3, 3)
    assert found.rotor.distance(R).max() <= 64 * EPS
    alone = ph.align(a[1, 1], b[1, 1], np.ones(6))
    np.testing.assert_allclose(alone.covariance, found.covariance[1, 1], rtol=64 * EPS)
    many = ph.align(a[0, 0], np.stack([b[0, 0]] * 4))
    assert many.rotor.distance(R[0, 0]).max() <= 64 * EPS
    # A weight of zero leaves a vector out.
    wrong = b.copy()
    wrong[..., 0, :] = 7
    assert ph.align(a, wrong, [0, 1, 1, 1, 1, 1]).rotor.distance(R).max() <= 64 * EPS


@pytest.mark.parametrize("angle", [1e-2, 1e-4, 1e-6])
def test_directions_that_are_almost_collinear(angle):
    frame, R = Rotor.random(2, rng=6)
    a = frame(ph.vector([[0, 0, 1], [np.sin(angle), 0, np.cos(angle)]]))
    found = ph.align(a, R(a))
    # The turn about them is as sharp as the rounding of the vectors over their angle.
    assert found.rotor.distance(R) <= 16 * EPS / angle
    # The variance of that turn, for two vectors of variance 1, is 2/angle², to rounding over angle².
    assert abs(np.linalg.eigvalsh(found.covariance)[-1] * angle**2 / 2 - 1) <= angle**2 + 32 * EPS / angle**2


def test_what_does_not_determine_a_rotation_raises():
    with pytest.raises(ValueError, match=r"all parallel.*use Rotor.from_vectors"):
        ph.align([e1], [e2])
    line = np.outer([1, -2, 3], [1.0, 2.0, 2.0])
    with pytest.raises(ValueError, match="all parallel"):
        ph.align(line, Rotor.random(rng=7)(ph.vector(line)))
    with pytest.raises(ValueError, match="all parallel"):
        ph.align(np.zeros((3, 3)), np.eye(3))
    with pytest.raises(ValueError, match="mirror image"):
        ph.align(np.eye(3), -np.eye(3))
    with pytest.raises(ValueError, match=r"at index \(1,\): the directions"):
        ph.align(np.stack([np.eye(3), np.ones((3, 3))]), np.eye(3))
    # A mirror image of unequal extent still has a best rotation.
    assert ph.align(np.diag([3.0, 2.0, 1.0]), np.diag([3.0, 2.0, -1.0])).rotor.is_close(1, atol=8 * EPS)


def test_wrong_vectors_and_weights_raise():
    with pytest.raises(ValueError, match=r"a needs vectors .* got shape \(3,\)"):
        ph.align([1, 2, 3], [1, 2, 3])
    for n in (1, 2):
        with pytest.raises(
            ValueError, match=rf"equal numbers of vectors .* got shapes \({n}, 3\) and \(3, 3\)"
        ):
            ph.align(np.eye(3)[:n], np.eye(3))
    with pytest.raises(ValueError, match=r"do not broadcast: .* are \(2, 4, 3\) and \(3, 4, 3\)"):
        ph.align(np.ones((2, 4, 3)), np.ones((3, 4, 3)))
    with pytest.raises(ValueError, match="a vector is not finite"):
        ph.align(np.eye(3), np.diag([1, np.nan, 1]))
    batch = np.broadcast_to(np.eye(3), (4, 3, 3)).copy()
    batch[3, 0, 2] = np.inf
    with pytest.raises(ValueError, match=r"at index \(3, 0\): a vector is not finite"):
        ph.align(np.eye(3), batch)
    with pytest.raises(ValueError, match=r"weights must be finite numbers >= 0.* got \[ *1. -1. *1.\]"):
        ph.align(np.eye(3), np.eye(3), [1.0, -1.0, 1.0])
    with pytest.raises(TypeError, match="a must be a vector"):
        ph.align(ph.stack([e1 ^ e2, e2 ^ e3]), np.eye(3)[:2])


def test_jax_differentiates_the_rotation():
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        a, _, b = noisy(5, 0.1, seed=8)

        def vector(b):
            return ph.align(a, b).rotor.to_rotation_vector()

        both = jax.jit(lambda b: (vector(b), jax.jacfwd(vector)(b)))
        value, found = both(jax.numpy.asarray(b))
        np.testing.assert_allclose(value, vector(b), rtol=0, atol=64 * EPS)
        h = 1e-5
        for k in range(3):
            step = np.zeros((5, 3))
            step[2, k] = h
            slope = (vector(b + step) - vector(b - step)) / (2 * h)
            # Central differences err by h² times third derivatives of some units, and by rounding over h.
            np.testing.assert_allclose(found[:, 2, k], slope, rtol=0, atol=1e-9)


# --- one exact pair


def test_an_infinite_weight_aligns_exactly():
    a, _, b = noisy(6, 0.2, seed=9)
    w = np.array([1.0, 2.0, np.inf, 1.0, 0.5, 0.0])
    found = ph.align(a, b, w)
    unit = [v / np.linalg.norm(v) for v in (found.rotor(ph.vector(a[2])).components, b[2])]
    np.testing.assert_allclose(*unit, rtol=0, atol=8 * EPS)
    peer, _ = Rotation.align_vectors(b, a, w)
    # SciPy finds the angle from squares of the differences, which lose up to half the digits.
    assert found.rotor.distance(Rotor.from_scipy(peer)) <= 1e-7
    others = np.where(np.isinf(w), 0.0, w)

    def cost(angle):
        off = b - (Rotor.from_axis_angle(b[2], angle) * found.rotor)(ph.vector(a)).components
        return (others * (off**2).sum(axis=-1)).sum()

    assert abs(np.sqrt(cost(0.0)) - found.residual) <= 16 * EPS
    h = 1e-4
    slope, curvature = cost(h) - cost(-h), (cost(h) - 2 * cost(0.0) + cost(-h)) / (2 * h * h)
    assert abs(slope) / (4 * h) <= 100 * h**2
    n = unit[1]
    np.testing.assert_allclose(found.covariance, np.outer(n, n) / curvature, rtol=0, atol=1e-6)


def test_a_large_weight_is_almost_infinite():
    a, _, b = noisy(5, 0.2, seed=10, shape=(30,))
    exact = ph.align(a, b, [np.inf, 1, 1, 2, 1])
    assert exact.rotor.shape == (30,)
    large = ph.align(a, b, [1e8, 1, 1, 2, 1])
    # The large weight yields by 1e-8, times the size of the others beside the slopes at the minimum.
    assert exact.rotor.distance(large.rotor).max() <= 1e-6
    np.testing.assert_allclose(exact.covariance, large.covariance, rtol=0, atol=1e-6)
    assert ph.align(a[3], b[3], [np.inf, 1, 1, 2, 1]).rotor.distance(exact.rotor[3]) <= 16 * EPS


def test_rows_of_a_batch_count_by_themselves():
    a, _, b = noisy(4, 0.1, seed=11)
    w = [np.inf, 1, 1, 1]
    sizes = np.array([1.0, 1e-9])[:, None, None]
    for weights in (None, w):
        small, alone = ph.align(sizes * a, sizes * b, weights), ph.align(a, b, weights)
        assert small.rotor.distance(alone.rotor).max() <= 64 * EPS
        np.testing.assert_allclose(small.residual, [alone.residual, 1e-9 * alone.residual], rtol=64 * EPS)
        # The turn follows from directions; a tiny row is not parallel for the size of another.
        tiny = np.array([1.0, 1e-20])[:, None, None]
        for pair in ((tiny * a, b), (a, tiny * b)) if weights else ():
            assert ph.align(*pair, weights).rotor.distance(alone.rotor).max() <= 64 * EPS
        # A single alignment has a number, not an array, as its residual.
        assert isinstance(alone.residual, float)


def test_opposite_directions_and_two_pairs():
    rotor, residual, _ = ph.align([e1, e2], [-e1, e3], [np.inf, 1])
    assert rotor(e1).is_close(-e1, atol=4 * EPS)
    assert rotor(e2).is_close(e3, atol=4 * EPS)
    assert residual <= 4 * EPS
    # The second pair decides the angle only.
    rotor = ph.align([e1, e1 + e2], [e2, e2 + 3 * e3], [np.inf, 1]).rotor
    assert rotor(e2).is_close(e3, atol=4 * EPS)


def test_wrong_infinite_weights_raise():
    a, b = np.eye(3), np.eye(3)
    with pytest.raises(ValueError, match="one of each row must be"):
        ph.align(a, b, [np.inf, np.inf, 1])
    with pytest.raises(
        ValueError, match=r"at index \(1,\): if weights are infinite, one of each row must be"
    ):
        ph.align(np.stack([a, a]), b, [[np.inf, 1, 1], [1, 1, 1]])
    with pytest.raises(ValueError, match="all parallel"):
        ph.align([e1, 2 * e1], [e2, e2], [np.inf, 1])
    with pytest.raises(ValueError, match="all parallel"):
        ph.align([e1, e2], [e2, e1], [np.inf, 0])
    with pytest.raises(ValueError, match="is 0 and has no direction"):
        ph.align([0 * e1, e2], [e2, e1], [np.inf, 1])
    with pytest.raises(ValueError, match="weights must be finite"):
        ph.align(a, b, [np.inf, -1, 1])


@pytest.mark.parametrize("a_power", [-560, 0, 530])
@pytest.mark.parametrize("b_power", [-560, 0, 530])
@pytest.mark.parametrize("weight_power", [-1000, 0, 1000])
def test_an_infinite_weight_beside_vectors_and_weights_of_any_size(a_power, b_power, weight_power):
    a, _, b = noisy(4, 1e-3)
    w = np.array([np.inf, 1.0, 2.0, 0.5])
    plain = ph.align(a, b, w)
    fit = ph.align(np.ldexp(a, a_power), np.ldexp(b, b_power), np.ldexp(w, weight_power))
    assert fit.rotor.distance(plain.rotor) <= 8 * EPS
    if a_power == b_power:
        expected = np.ldexp(plain.residual, a_power + weight_power // 2)
        np.testing.assert_allclose(fit.residual, expected, rtol=1e-10)
    with np.errstate(over="ignore"):
        expected = np.ldexp(plain.covariance, -(a_power + b_power + weight_power))
    np.testing.assert_allclose(fit.covariance, expected, rtol=1e-12, atol=1e-320)
