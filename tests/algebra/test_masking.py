"""`errors="mask"`: rows without a value are NaN, and the others have the bits of a batch without them."""

import numpy as np
import pytest

import polhode as ph
from polhode import Rotor, e1, e2, e3

NAN = float("nan")
BAD, SECOND = 2, 5  # the rows that have no value


def batch(k, seed=1, bad=0.0, count=8):
    rows = np.random.default_rng(seed).standard_normal((count, k))
    rows[[BAD, SECOND]] = bad
    return rows


def multivectors(bad, seed=2):
    rows = batch(8, seed)
    rows[[BAD, SECOND]] = np.asarray(bad, float)
    return ph.multivector(rows)


def matrices():
    m = Rotor.random(8, rng=3).to_matrix()
    m[BAD], m[SECOND] = np.eye(3) * [1, 1, -1], NAN
    return m


SINGULAR = [1.0, 1, 0, 0, 0, 0, 0, 0]
A = ph.algebra(3, 0, 1)


def motors():
    rows = A.bivector(batch(6)).exp().dense()
    rows[[BAD, SECOND]] = A.I.dense()
    return A.multivector(rows).grade(0, 2, 4)


# A function of rows and keywords, and 8 rows of which two are bad.
CASES = {
    "inverse": (lambda x, **k: x.inverse(**k), multivectors(SINGULAR)),
    "inverse of float32": (lambda x, **k: x.inverse(**k), multivectors(SINGULAR).astype(np.float32)),
    "log": (lambda x, **k: x.log(**k), multivectors(SINGULAR)),
    "log of motors": (lambda x, **k: x.log(**k), motors()),
    "exp": (lambda x, **k: x.exp(**k), multivectors([1e4, 0, 0, 0, 0, 0, 0, 0])),
    "exp of bivectors": (lambda x, **k: x.exp(**k), ph.bivector(batch(3, bad=np.inf))),
    "sqrt": (lambda x, **k: x.sqrt(**k), multivectors([0, 1, 0, 0, 0, 1, 0, 0])),
    "normalized": (lambda x, **k: x.normalized(**k), ph.vector(batch(3))),
    "tan": (lambda x, **k: x.tan(**k), multivectors(np.pi / 4 * np.array(SINGULAR))),
    "tanh": (lambda x, **k: x.tanh(**k), multivectors(np.pi / 4 * np.eye(8)[[4, 7]].sum(axis=0))),
    "from_components": (Rotor.from_components, batch(4)),
    "from_plane_angle": (lambda x, **k: Rotor.from_plane_angle(ph.bivector(x), 0.5, **k), batch(3)),
    "from_plane_angle of arrays": (lambda x, **k: Rotor.from_plane_angle(x, 0.5, **k), batch(3)),
    "from_vectors": (lambda x, **k: Rotor.from_vectors(x, [0, 0, 1], **k), batch(3)),
    "from_matrix": (Rotor.from_matrix, matrices()),
    "nearest": (lambda x, **k: Rotor.from_matrix(x, nearest=True, **k), batch(9).reshape(8, 3, 3)),
    "from_quaternion": (lambda x, **k: Rotor.from_quaternion(x, order="wxyz", **k), batch(4)),
    "from_rotation_vector": (Rotor.from_rotation_vector, batch(3, bad=NAN)),
    "from_axis_angle": (lambda x, **k: Rotor.from_axis_angle(x, 30, degrees=True, **k), batch(3)),
    "from_mrp": (Rotor.from_mrp, batch(3, bad=np.inf)),
    "from_multivector": (
        lambda x, **k: Rotor.from_multivector(x, tolerance=0.2, **k),
        (1 * Rotor.random(8, rng=4)) * np.where(np.isin(np.arange(8), [BAD, SECOND]), 2.0, 1.1),
    ),
    "from_euler": (lambda x, **k: Rotor.from_euler("xyz", x, **k), batch(3, bad=NAN)),
}


@pytest.mark.parametrize("name", CASES)
def test_bad_rows_are_nan_and_the_others_have_the_same_bits(name):
    function, rows = CASES[name]
    bad = np.isin(np.arange(8), [BAD, SECOND])
    with pytest.raises(ValueError, match=r"index \(2,\)"):
        function(rows)
    found, good = function(rows, errors="mask"), function(rows[~bad])
    assert type(found) is type(good)
    assert found.grades == good.grades
    assert found.dtype == good.dtype
    assert found.shape == (8,)
    np.testing.assert_array_equal(found.is_finite(), ~bad)
    assert np.isnan(found.components[bad]).all()
    np.testing.assert_array_equal(found.components[~bad], good.components)
    same = function(rows[~bad], errors="mask")
    np.testing.assert_array_equal(same.components, good.components)


@pytest.mark.parametrize("name", ["inverse", "from_components", "from_matrix", "from_euler"])
def test_single_bad_values_and_batches_of_them(name):
    function, rows = CASES[name]
    one = function(rows[BAD], errors="mask")
    assert one.shape == ()
    assert one.is_finite() is np.False_
    good = function(rows[0], errors="mask")
    assert good == function(rows[0])
    several = function(rows[[BAD, BAD, SECOND]], errors="mask")
    assert several.shape == (3,)
    assert not several.is_finite().any()
    assert several.grades == good.grades


def test_operands_broadcast():
    planes = ph.bivector([[1.0, 0, 0], [0, 0, 0]])
    found = Rotor.from_plane_angle(planes[:, None], np.array([0.5, NAN, 1.0]), errors="mask")
    np.testing.assert_array_equal(found.is_finite(), [[True, False, True], [False, False, False]])
    assert found[0, 2] == Rotor.from_plane_angle(planes[0], 1.0)


def test_blades_and_alignments():
    planes = np.stack([[1.0, 2, 3], [0, 0, 0], [NAN, 0, 0]])
    factors = ph.bivector(planes).factor(errors="mask")
    assert len(factors) == 2
    for one in factors:
        np.testing.assert_array_equal(one.is_finite(), [True, False, False])
    assert (factors[0][0] * factors[1][0]).is_close(ph.bivector(planes[0]))
    a = np.random.default_rng(5).standard_normal((3, 4, 3))
    R = Rotor.random(rng=6)
    b = R(ph.vector(a)).components
    a[1] = np.outer([1, 2, 3, 4], [1.0, 0, 0])
    b[1] = a[1]
    found = ph.align(a, b, np.ones(4), errors="mask")
    assert isinstance(found, ph.Alignment)
    np.testing.assert_array_equal(found.rotor.is_finite(), [True, False, True])
    np.testing.assert_array_equal(np.isfinite(found.residual), [True, False, True])
    np.testing.assert_array_equal(np.isfinite(found.covariance).all(axis=(-2, -1)), [True, False, True])
    assert found.rotor[2] == ph.align(a[[0, 2]], b[[0, 2]], np.ones(4)).rotor[1]


def test_masked_rotors_can_be_used():
    R = Rotor.from_quaternion([[1, 0, 0, 0], [0, 0, 0, 0]], order="wxyz", errors="mask")
    good = R.is_finite()
    assert R[good].shape == (1,)
    turned = R(e1)
    assert turned[0] == e1
    assert not turned[1].is_finite()
    np.testing.assert_array_equal(R.log(errors="mask").is_finite(), good)
    np.testing.assert_array_equal(R.sqrt(errors="mask").is_finite(), good)
    np.testing.assert_array_equal((~R).is_finite(), good)
    assert e3.is_finite() is np.True_


def test_many_bad_rows():
    rows = np.random.default_rng(7).standard_normal((3000, 4))
    bad = np.random.default_rng(8).random(3000) < 0.1
    rows[bad] = 0
    found = Rotor.from_components(rows, errors="mask")
    np.testing.assert_array_equal(found.is_finite(), ~bad)
    np.testing.assert_array_equal(found[~bad].components, Rotor.from_components(rows[~bad]).components)


def test_other_errors_are_raised():
    with pytest.raises(ValueError, match='errors must be "raise" or "mask", got \'coerce\''):
        e1.inverse(errors="coerce")
    with pytest.raises(ValueError, match="needs 4 components"):
        Rotor.from_components(np.ones((5, 3)), errors="mask")
    with pytest.raises(ValueError, match="order must be"):
        Rotor.from_quaternion(np.ones((5, 4)), order="zyx", errors="mask")
    with pytest.raises(TypeError, match=r"needs NumPy floats, got ndarray of object; convert"):
        Rotor.from_components(np.array([[1, 2, 3, 4]], dtype=object), errors="mask")
    with pytest.raises(ValueError, match="broadcast"):
        Rotor.from_vectors(np.ones((2, 3)), np.ones((3, 3)), errors="mask")
    with pytest.raises(TypeError, match="must be a vector"):
        Rotor.from_vectors(e1 ^ e2, np.ones((3, 3)), errors="mask")


def test_is_finite_of_other_coefficients():
    jnp = pytest.importorskip("jax.numpy")
    sympy = pytest.importorskip("sympy")
    assert list(np.asarray(ph.vector(jnp.asarray([[1.0, 2, 3], [NAN, 0, 0]])).is_finite())) == [True, False]
    assert (sympy.Symbol("x") * e1).is_finite()
    assert not (sympy.nan * e1).is_finite()
